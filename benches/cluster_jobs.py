"""The two jobs of cluster.py, the two workers, and the tables."""

import time
from contextlib import contextmanager

import dask
import dask.array as da
import numpy as np

import spincyl as sc

T = 20.0
LINES = []


def kicked(number):
    """Solid cylinders with w2 = 0.05 added to a steady state at theta = 1.3."""
    ell = 0.9 + 2.1 * ((number * 0.6180339887498949) % 1)
    s, tangent, a = np.sin(1.3), np.tan(1.3), 0.5 + 2 * ell * ell / 3
    w1 = np.sqrt(2 * (1 - ell * tangent) / ((a - ell * tangent) * s)) * s
    return sc.Body.solid(ell), sc.State(1.3, w1, 0.05, ell * w1)


def any_start(number):
    """Solid cylinders with inclinations and angular velocities spread evenly."""
    roots = (0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101, 0.46140190073893)
    u, v, a, b, c = ((number * root) % 1 for root in roots)
    return sc.Body.solid(0.1 + 2.9 * u), sc.State(0.1 + 1.4 * v, 3 * a - 1.5, 3 * b - 1.5, 3 * c - 1.5)


JOBS = {"kicked steady states": kicked, "any initial states": any_start}


def rolled(start, number, **how):
    return sc.sweep.roll(*start(number), T, want=("final", "end"), **how)


def lazy(start, count, size):
    return rolled(start, da.arange(float(count), chunks=size))


def counted(found):
    """The number of motions for each kind of end, which is all that a worker returns."""
    return da.bincount(found["status"].data, minlength=7)


def wall(run):
    began = time.perf_counter()
    result = run()
    return time.perf_counter() - began, result


def say(line):
    LINES.append(line)
    print(line, flush=True)


def row(*cells):
    say("| " + " | ".join(f"{x:.3g}" if isinstance(x, float) else str(x) for x in cells) + " |")


def head(title, *cells):
    say(f"\n{title}\n")
    row(*cells)
    say("|" + " --- |" * len(cells))


#: Settings that keep freed memory for the next block; dask's workers return it to the system by default.
KEPT = {
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 2**30,
    "distributed.nanny.pre-spawn-environ.MALLOC_MMAP_THRESHOLD_": 2**28,
}


@contextmanager
def workers():
    """Two processes of one thread each, and a client in the process of the scheduler."""
    from distributed import Client, LocalCluster

    kw = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": ":0", "silence_logs": 50}
    with dask.config.set(KEPT), LocalCluster(**kw) as cluster, Client(cluster) as client:
        yield cluster, client
