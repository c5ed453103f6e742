"""Too little memory is a MemoryError at whatever place it runs out, and the process lives."""

import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif(
    not sys.platform.startswith("linux"), reason="limits and reads memory by Linux"
)

HEAD = """
import gc, resource, sys, numpy as np, spincyl as sc

def size():
    return next(int(x.split()[1]) for x in open("/proc/self/status") if x.startswith("VmSize")) * 1024

def tried(job, most, looks=24):
    "How often there was too little memory, with `most` bytes to spare at last and the rest of these looks less."
    refused = 0
    for i in range(looks):
        gc.collect()
        resource.setrlimit(resource.RLIMIT_AS, (size() + int(most * (i + 1) / looks), resource.RLIM_INFINITY))
        try:
            job()
        except MemoryError:
            refused += 1
        finally:
            resource.setrlimit(resource.RLIMIT_AS, (resource.RLIM_INFINITY,) * 2)
    return refused

body = sc.Body.solid(2.5)
state = body.steady(1.3).kicked(0.05)
"""


def survives(job, most):
    """Runs a job with less and less too little memory in a process of its own, which must not die."""
    code = f"{HEAD}{job}\njob()\nrefused = tried(job, {most})\njob()\nassert 3 < refused < 24, refused"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert found.returncode == 0, (found.returncode, found.stderr[-500:])


@pytest.mark.parametrize(
    ("count", "how"),
    [(60_000, "want='contact'"), (100_000, "want=('pose', 'contact')"), (100_000, "tol=1e-6, want='pose'")],
)
def test_a8_a_motion_at_more_times_than_memory_holds_is_a_memory_error(count, how):
    survives(f"t = np.linspace(0, 5, {count})\ndef job(): sc.roll(body, state, t, {how})", 320 * count)
