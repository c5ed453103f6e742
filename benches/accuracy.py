"""Error of rate() over random points of the map, against 260-bit arithmetic on the exact doubles.

    python benches/accuracy.py [--points 1e7] [--whole]

Prints the maximum and the 99th percentile of error/(1 + kappa_c) in units of 2^-53, and the number of points
on the wrong side: a rate without a steady state, or the region "forbidden" with one. Points
are uniform on the map that is drawn. With --whole ell is log-uniform from 1e-8 to 1e8, a fifth of it next to
the critical aspect ratio; theta is next to theta0 or thetaInf for a quarter of the points, log-uniform from
5e-324 to 1 for a third, and else uniform. Half of the bodies have a bore. The reference shares no formula
with the library: it is Eq. 15 of the paper with tangents, in MPFR.
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


def exact(theta, ell, bore):
    """The squared rate and, where it is positive, the rate and kappa_c, in 260 bits."""
    x, e, q = (gmpy2.mpfr(float(v)) for v in (theta, ell, bore))
    tan, (sin, cos) = gmpy2.tan(x), gmpy2.sin_cos(x)
    a = gmpy2.mpfr(1) / 2 + 2 * e * e / (3 * (1 + q * q))
    top, bottom = 1 - e * tan, a - e * tan
    square = top / (bottom * sin)
    if square <= 0:
        return square, None, None
    slope = (1 + tan * tan) * e * (1 / bottom - 1 / top) - cos / sin
    return square, gmpy2.sqrt(square), abs(slope * x) / 2


def errors(theta, ell, bore, rate, region):
    """error/(1 + kappa_c) in ulp of every steady state, and the number of points at which library and
    reference disagree whether there is a steady state."""
    gmpy2.set_context(gmpy2.context(precision=260, emin=-(10**6), emax=10**6))
    found, wrong = [], 0
    for t, e, q, r, where in zip(theta, ell, bore, rate.tolist(), region.tolist(), strict=True):
        square, reference, kappa_c = exact(t, e, q)
        if r != r or square <= 0:
            wrong += r == r or where >= sc.Region.UNSTABLE or (square > 0 and where == sc.Region.FORBIDDEN)
            continue
        found.append(float(abs(gmpy2.mpfr(r) - reference) / reference / (1 + kappa_c)) / ULP)
    return np.array(found, np.float32), wrong


def block(task):
    seed, n, whole = task
    theta, ell, bore = draw(np.random.default_rng(seed), n, whole)
    body = sc.Body.tube(ell, bore)
    return errors(theta, ell, bore, body.rate(theta), body.region(theta))


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
    found = np.concatenate([p[0] for p in parts])
    print(
        f"{len(tasks) * size} points, {found.size} steady states, wrong side: {sum(p[1] for p in parts)}; "
        f"error/(1 + kappa_c) in ulp: max {found.max():.3f}, 99 % {np.percentile(found, 99):.3f} "
        f"({time.time() - start:.0f} s)"
    )


if __name__ == "__main__":
    main()
