"""Error of rate() over random points of the map, against 200-bit arithmetic on the exact doubles.

    python benches/accuracy.py [--points 1e7] [--whole]

Prints the maximum and the 99th percentile of error/(1 + kappa_c) in units of 2^-53, and how many points
had a steady state on one side only. --whole draws ell log-uniformly from 1e-8 to 1e8 and theta log-uniformly
from 5e-324 to pi/2 half of the time, next to theta0 or thetaInf a quarter; otherwise both uniformly
on the map that is drawn, and a bore. The reference shares no formula with the library: it is Eq. 15 of
the paper with tangents, in MPFR.
"""

import argparse
import multiprocessing
import os
import time

import gmpy2
import numpy as np

import spincyl as sc

ULP = 2.0**-53


def draw(rng, n, whole):
    if not whole:
        return (
            rng.uniform(1e-3, np.pi / 2, n),
            rng.uniform(0.01, 3.0, n),
            rng.uniform(0, 1, n) * (rng.random(n) < 0.5),
        )
    ell = 10.0 ** rng.uniform(-8, 8, n)
    near = rng.random(n)
    bore = rng.uniform(0, 1, n) * (rng.random(n) < 0.5)
    near_critical = rng.random(n) < 0.2
    ell = np.where(
        near_critical,
        sc.Body.critical_aspect(bore) * (1 + rng.choice([-1, 1], n) * 10.0 ** rng.uniform(-16, -1, n)),
        ell,
    )
    body = sc.Body.tube(ell, bore)
    special = np.where(rng.random(n) < 0.5, body.theta_balance, body.theta_limit)
    theta = np.where(
        near < 0.25,
        special * (1 + rng.choice([-1, 1], n) * 10.0 ** rng.uniform(-15, -1, n)),
        np.where(near < 0.6, np.exp2(rng.uniform(-1074, 0, n)), rng.uniform(0, np.pi / 2, n)),
    )
    theta = np.where(rng.random(n) < 0.05, np.pi / 2 * (1 - rng.integers(0, 9, n) * ULP), theta)
    return np.clip(theta, 5e-324, np.pi / 2), ell, bore


def block(task):
    seed, n, whole = task
    rng = np.random.default_rng(seed)
    theta, ell, bore = draw(rng, n, whole)
    body = sc.Body.tube(ell, bore)
    rate, region = body.rate(theta), body.region(theta)
    gmpy2.set_context(gmpy2.context(precision=260, emin=-(10**6), emax=10**6))
    mpfr = gmpy2.mpfr
    errors, wrong = [], 0
    for t, e, q, r, where in zip(
        theta.tolist(), ell.tolist(), bore.tolist(), rate.tolist(), region.tolist(), strict=True
    ):
        x, e, q = mpfr(t), mpfr(e), mpfr(q)
        tan, (sin, cos) = gmpy2.tan(x), gmpy2.sin_cos(x)
        wall = 1 + q * q
        a = mpfr(1) / 2 + 2 * e * e / (3 * wall)
        top, bottom = 1 - e * tan, a - e * tan
        square = top / (bottom * sin)
        if (square > 0) != (r == r):
            wrong += where != sc.Region.UNDETERMINED
            continue
        if r != r:
            wrong += where not in (sc.Region.FORBIDDEN, sc.Region.UNDETERMINED)
            continue
        exact = gmpy2.sqrt(square)
        sec2 = 1 + tan * tan
        slope = (-e * sec2 / top + e * sec2 / bottom - cos / sin) / 2
        kappa = abs(slope * x)
        errors.append(float(abs(mpfr(r) - exact) / exact / (1 + kappa)) / ULP)
    return np.array(errors, np.float32), wrong


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--points", type=float, default=1e6)
    parser.add_argument("--whole", action="store_true")
    args = parser.parse_args()
    size = 100_000
    tasks = [(seed, size, args.whole) for seed in range(max(1, int(args.points) // size))]
    start = time.time()
    with multiprocessing.get_context("spawn").Pool(os.cpu_count()) as pool:
        parts = pool.map(block, tasks, chunksize=1)
    errors = np.concatenate([p[0] for p in parts])
    print(
        f"{len(tasks) * size} points, {errors.size} steady states, wrong side: {sum(p[1] for p in parts)}; "
        f"error/(1 + kappa_c) in ulp: max {errors.max():.3f}, 99 % {np.percentile(errors, 99):.3f} "
        f"({time.time() - start:.0f} s)"
    )


if __name__ == "__main__":
    main()
