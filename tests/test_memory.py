"""Too little memory raises MemoryError wherever it runs out; the process survives."""

import os
import subprocess
import sys

import pytest
from few import few

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="limits and reads memory by Linux"
)

HEAD = """
import gc, resource, sys, numpy as np, spincyl as sc

def size():
    return next(int(x.split()[1]) for x in open("/proc/self/status") if x.startswith("VmSize")) * 1024

# the stack grows, too, and Python itself needs some
LEAST = 2 << 20

def tried(job, most, looks=10):
    "How often there was too little memory, with this and `most` bytes to spare at last, and less at the other looks."
    refused = 0
    for i in range(looks):
        gc.collect()
        resource.setrlimit(resource.RLIMIT_AS, (size() + LEAST + int(most * (i + 1) / looks), resource.RLIM_INFINITY))
        try:
            job()
        except MemoryError:
            refused += 1
        finally:
            resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY,) * 2)
    return refused

body = sc.Body.solid(2.5)
state = body.steady(1.3).kicked(0.05)
slips = sc.State(1.3, 0.3, 0.05, 1.0, slip=(0.2, 0.1))
"""


def survives(job, most):
    """Run a job in a process of its own with less and less memory; the process must not die.

    Eight megabytes are always left for small objects.
    """
    code = f"{HEAD}{job}\njob()\ngc.freeze()\nrefused = tried(job, {most} + (8 << 20))\njob()\nassert 1 < refused < 10, refused"
    # malloc keeps no reserves, and returns freed memory at once, so that each attempt has as little
    frugal = {"MALLOC_MMAP_THRESHOLD_": "65536", "MALLOC_TRIM_THRESHOLD_": "65536", "MALLOC_ARENA_MAX": "1"}
    env = {**os.environ, **frugal}
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=env)
    assert found.returncode == 0, (found.returncode, found.stderr[-500:])


@pytest.mark.parametrize(
    ("count", "how"),
    [(60_000, "want='force'"), (100_000, "want=('pose', 'force')"), (100_000, "tol=1e-6, want='pose'")],
)
def test_a8_a_motion_at_more_times_than_memory_holds_is_a_memory_error(count, how):
    survives(f"t = np.linspace(0, 5, {count})\ndef job(): sc.roll(body, state, t, {how})", 320 * count)


@pytest.mark.parametrize(
    ("start", "until"),
    [
        ("sc.dropped(can, 5.0, 1.0, w3=1.0)", 1.0),
        ("sc.State(np.pi / 2, 1.0, 0.0, 2.0, slip=(0.3, 0.4))", 0.02),
        ("sc.State(1.2, 1.0, 0.2, 1.0, slip=(0.3, 0.4))", 0.02),
    ],
    ids=["in the air", "on both rims", "on one rim"],
)
@pytest.mark.parametrize("more", ["", ", losses=sc.loss.Drilling(0.01), want=('pose', 'force')"])
def test_a8_a_motion_with_restitution_at_more_times_than_memory_holds_is_a_memory_error(start, until, more):
    count, how = 100_000, "contact=sc.Coulomb(0.3), restitution=0.5, tol=1e-8"
    job = f"def job(): sc.roll(can, start, t, {how}{more})"
    head = f"can, t = sc.Body.solid(1.5), np.linspace(0, {until}, {count})\nstart = {start}\n"
    survives(head + job, (600 if more else 250) * count)


def test_a8_more_impacts_than_memory_holds_are_a_memory_error():
    ball = "ball = sc.Body.ball(0.0, i1=0.4, i3=0.4)\nstart = sc.dropped(ball, 1e-4, 1.0)\n"
    job = "def job(): sc.roll(ball, start, [0.0, 800.0], contact=sc.Coulomb(0.3), restitution=1.0)"
    survives(ball + job, 24 << 20)


@pytest.mark.parametrize(
    ("job", "most"),
    few(
        [
            ("sc.sweep.portrait(1.3, np.linspace(0.1, 3, 300_000))", 300_000 * 560),
            (
                "sc.sweep.survey([0.5, 1.0], np.linspace(0.1, 3, 20_000), want=('region', 'rate'))",
                20_000 * 500,
            ),
            ("sc.sweep.roll(sc.Body.solid(np.linspace(2.4, 2.6, 50_000)), state, 1.0)", 50_000 * 150),
            (
                "sc.sweep.roll(sc.Body.solid(np.linspace(1, 3, 4000)), slips, 0.02, contact=sc.Coulomb(0.3))",
                64 << 20,
            ),
            (
                "sc.sweep.roll(sc.Body.solid(np.linspace(1, 3, 4000)), state, 0.02, losses=sc.loss.AirLinear(0.01))",
                64 << 20,
            ),
            ("sc.sweep.roll(body, state, np.linspace(0, 5, 200_000), beyond=True, mu=0.01)", 200_000 * 80),
            ("sc.sweep.portrait(np.linspace(0.1, 1.5, 300_000), 2.5)", 300_000 * 40),
            ("sc.sweep.points(np.linspace(0.1, 1.5, 300_000), 2.5)", 300_000 * 25),
            ("sc.sweep.roll(body, state, np.linspace(0, 5, 200_000), step=1e-2)", 200_000 * 80),
        ],
        5,
    ),
)
def test_a8_a_sweep_larger_than_memory_is_a_memory_error(job, most):
    survives(f"def job(): {job}", most)
