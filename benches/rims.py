"""Times for a rounded and for a sharp rim, in one run and on one thread: maps, single motions,
ensembles.

    python benches/rims.py [--fillet 0.1] [--motions 100000]

Times are minima of several runs; their ratio is the result. The bodies are solid and have the same half
length over the outer radius with either rim. The errors are the largest estimated errors of a run; the
maps have at most 2 (1 + kappa_c) ulp with either rim.
"""

import argparse
import time
from functools import partial

import numpy as np
from timing import best

import spincyl as sc


def jobs(fillet, motions):
    """Name, unit, factor from seconds to this unit, the job, and a function that returns its error."""
    theta, ell = np.linspace(0.01, 1.57, 2000), np.linspace(0.2, 3, 1000)
    maps = {
        want: sc.sweep.portrait(theta, ell, fillet=fillet, want=want, threads=1)
        for want in ("rate", "region")
    }
    for want, filled in maps.items():
        again = partial(sc.sweep.portrait, theta, ell, fillet=fillet, want=want, out=filled, threads=1)
        yield f"map, {want}", "ns a point", 1e9 / (theta.size * ell.size), again, None
    body = sc.Body.solid(2.5, fillet=fillet)
    start, times = body.steady(1.3).kicked(0.05), np.linspace(0, 20, 11)

    def some(want=()):
        for _ in range(50):
            found = sc.roll(body, start, times, want=want)
        return found

    yield "a motion", "us", 1e6 / 50, some, lambda found: found.error
    yield "a motion with poses", "us", 1e6 / 50, lambda: some("pose"), lambda found: found.pose_error
    disk = sc.Body.solid(0.173, fillet=min(fillet, 0.053))
    whirr = disk.steady(0.3).kicked(0.3)

    def wide():
        for _ in range(50):
            found = sc.roll(disk, whirr, times, want="pose", beyond=True)
        return found

    yield "a wide one with poses", "us", 1e6 / 50, wide, lambda found: found.pose_error
    bodies = sc.Body.solid(np.linspace(0.9, 3, motions), fillet=fillet)
    states = bodies.steady(1.3).kicked(0.05)
    many = partial(sc.sweep.roll, bodies, states, 20.0, threads=1)
    yield (
        "an ensemble near steady states",
        "us a motion",
        1e6 / motions,
        many,
        lambda all: float(all["error"].max()),
    )
    rng, some_of_them = np.random.default_rng(0), max(motions // 50, 100)
    odd = sc.Body.solid(rng.uniform(0.2, 3, some_of_them), fillet=fillet)
    angle, w1, w2, w3 = (rng.uniform(*ends, some_of_them) for ends in ((0.2, 1.4), (-2, 2), (-1, 1), (-3, 3)))
    starts = sc.State(angle, w1, w2, w3)
    ended = partial(sc.sweep.roll, odd, starts, 20.0, threads=1)
    yield "an ensemble from random starts", "us a motion", 1e6 / some_of_them, ended, None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fillet", type=float, default=0.1)
    parser.add_argument("--motions", type=int, default=100_000)
    args = parser.parse_args()
    print(f"{'':32} {'sharp':>9} {'rounded':>9} {'ratio':>6}   errors claimed")
    for sharp, rounded in zip(jobs(0.0, args.motions), jobs(args.fillet, args.motions), strict=True):
        name, unit, scale, *_ = sharp
        times, errors = [], []
        for *_, job, error in (sharp, rounded):
            job()
            times.append(best(job, clock=time.perf_counter)[1] * scale)
            errors.append("" if error is None else f"{error(job()):.1e}")
        ratio = times[1] / times[0]
        print(f"{name:32} {times[0]:9.3g} {times[1]:9.3g} {ratio:6.2f}   {' '.join(errors)} ({unit})")


if __name__ == "__main__":
    main()
