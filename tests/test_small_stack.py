"""Threads with a small stack: no function of the library puts large frames on the stack of its caller."""

import subprocess
import sys

import pytest

#: some systems give 128 KiB; NumPy and Python themselves need about 32
KIB = 80

JOB = """
import sys, threading, numpy as np, spincyl as sc

loss = sc.loss
body, disk, many = sc.Body.solid(2.5), sc.Body.solid(0.1), sc.Body.solid(np.linspace(0.5, 3, 200))
state, slips = sc.State(1.2, 0.3, 0.0, 0.5), sc.State(1.2, 0.3, 0.0, 0.5, slip=(0.3, 0.1))
inertia = [[0.02, -0.012, 0.0], [-0.012, 0.2, 0.0], [0.0, 0.0, 0.21]]
stone = sc.Ellipsoid((1.0, 0.3, 0.2), inertia, offset=(0.0, 0.0, -0.07))
stones = sc.Ellipsoid.rattleback((1.0, 0.15, 0.1), twist=np.radians([0.0, 2.0]))
losses, t = loss.RollingResistance(1e-3) + loss.BoundaryLayer(1e-4), np.linspace(0, 5, 50)
jobs = [
    lambda: sc.sweep.roll(many, state, 20.0, threads=1),
    lambda: sc.sweep.roll(many, state, 20.0, threads=2),
    lambda: sc.sweep.roll(many, state, 5.0, step=1e-2, threads=1),
    lambda: sc.sweep.roll(many, state, 5.0, losses=losses, threads=1),
    lambda: sc.sweep.roll(many, slips, 5.0, contact=sc.Coulomb(0.3), threads=1),
    lambda: sc.sweep.roll(stones, stones.spinning(-0.6, pitch=0.02), 2.0, threads=1),
    lambda: sc.sweep.portrait([0.5, 1.0], np.linspace(0.1, 3, 3000), threads=1),
    lambda: sc.sweep.survey([0.5, 1.0], np.linspace(0.1, 3, 50)),
    lambda: sc.sweep.boundaries(np.linspace(0.1, 3, 50)),
    lambda: sc.drift(many, 0.3, losses, threads=1),
    lambda: sc.drift(many, 0.3, losses, centre="rolling", threads=1),
    lambda: sc.drift(disk, 0.3, losses),
    lambda: sc.swing(body, state).period,
    lambda: sc.roll(body, state, t, want=("pose", "force")),
    lambda: sc.roll(body, slips, t, contact=sc.Coulomb(0.3), want=("pose", "force")),
    lambda: sc.roll(disk, slips, t, contact=sc.Coulomb(0.3), losses=losses, want=("pose", "force")),
    lambda: sc.roll(disk, slips, t, contact=sc.Coulomb(0.3, patch=0.02), want=("pose", "force")),
    lambda: sc.roll(body, slips, t, contact=sc.Viscous(0.3)),
    lambda: sc.roll(stone, stone.spinning(-0.6, pitch=0.02), t, contact=sc.Coulomb(0.3)),
    lambda: body.inclinations(2.0),
]
[job() for job in jobs]  # what is loaded once needs its own frames
threading.stack_size(int(sys.argv[1]) << 10)
done = []
for job in jobs:
    thread = threading.Thread(target=lambda: done.append(job()))
    thread.start()
    thread.join()
    print(len(done), flush=True)
assert len(done) == len(jobs)
"""


def test_every_call_lives_in_a_thread_with_a_small_stack():
    if sys.platform == "win32":
        pytest.skip("the least stack is that of the program")
    found = subprocess.run([sys.executable, "-c", JOB, str(KIB)], capture_output=True, text=True)
    assert found.returncode == 0, f"after {found.stdout.split()[-1:]} calls: {found.stderr[-500:]}"


ROOMY = """
import os, resource, threading, numpy as np, spincyl as sc
from spincyl._input.threads import has_large_stack

body, state = sc.Body.solid(np.linspace(0.5, 3, 500)), sc.State(1.2, 0.3, 0.4, 0.5)
found = lambda: sc.sweep.roll(body, state, 20.0, tol=1e-12, beyond=True).theta.values
said, states = [has_large_stack()], [found()]
thread = threading.Thread(target=lambda: (said.append(has_large_stack()), states.append(found())))
thread.start()
thread.join()
child = os.fork()
if child == 0:
    os._exit(has_large_stack())
said.append(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
resource.setrlimit(resource.RLIMIT_STACK, (256 << 10, resource.getrlimit(resource.RLIMIT_STACK)[1]))
said.append(has_large_stack())
states.append(found())
print(*map(int, said), all((x == states[0]).all() for x in states))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no thread of it counts as roomy")
def test_the_main_thread_alone_works_itself_and_only_with_a_large_stack():
    # the shell sets the size of the stack, whatever the limit of this process
    run = f"ulimit -s 8192; exec {sys.executable} -c '{ROOMY}'"
    found = subprocess.run(["sh", "-c", run], capture_output=True, text=True)
    assert found.stdout.split() == ["1", "0", "0", "0", "True"], found.stderr[-500:]
