"""Every inclination of a rate: counts against exact arithmetic, residuals against the rate.

    python benches/inverse.py [--points 1e6] [--exact 1e5]

Random solid cylinders and rates, a third of the exact ones at and within a few last bits of a fold or of rate
1. Counts are checked by Sturm's theorem in rational arithmetic on the exact doubles; the residual is
|rate(theta) - rate| / rate in ulp of 2^-53 over 1 + kappa_c. Where kappa_c exceeds 2^45 no double theta gives
the rate to one digit: there the exact root is checked to lie within 3 ulp of theta, by signs in 260-bit
arithmetic.
"""

import argparse
import multiprocessing
import os
import pathlib
import sys
import time

import gmpy2
import numpy as np

import spincyl as sc

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests"))
from test_reference import planted, sturm_count


def wrong_counts(task):
    seed, size = task
    ell, rate = planted(np.random.default_rng(seed), size)
    counts = sc.Body.solid(ell).count(rate)
    wrong = [
        (float(e), float(r)) for e, r, c in zip(ell, rate, counts, strict=True) if c != sturm_count(e, r)
    ]
    return wrong, np.bincount(counts.astype(int), minlength=4)


def brackets(ell, rate, theta):
    """Whether the quartic changes sign within 3 ulp of theta."""
    e, w = gmpy2.mpfr(float(ell)), gmpy2.mpfr(float(rate)) ** 2
    a = gmpy2.mpfr(1) / 2 + 2 * e * e / 3

    def quartic(x):
        t = gmpy2.tan(x / 2)
        return (((t + 2 * (e - a * w)) * t - 4 * e * w) * t + 2 * (e + a * w)) * t - 1

    x, gap = gmpy2.mpfr(float(theta)), 3 * np.spacing(theta)
    return quartic(x - gap) * quartic(x + gap) <= 0


def residuals(task):
    seed, size = task
    rng = np.random.default_rng(seed)
    ell = np.where(rng.random(size) < 0.5, rng.uniform(0, 3, size), 10 ** rng.uniform(-8, 8, size))
    rate = np.where(rng.random(size) < 0.5, rng.uniform(0, 4, size), 10 ** rng.uniform(-8, 8, size))
    theta = sc.Body.solid(ell).inclinations(rate)
    family = sc.Body.solid(ell[:, None])
    back = family.rate(theta)
    n = np.cos(theta) - ell[:, None] * np.sin(theta)
    with np.errstate(all="ignore"):
        kappa_c = (
            theta
            / 2
            * np.abs(
                family.excess * ell[:, None] / (n * (n + family.excess * np.cos(theta))) + 1 / np.tan(theta)
            )
        )
        residual = np.abs(back / rate[:, None] - 1) * 2.0**53 / (1 + kappa_c)
    gmpy2.set_context(gmpy2.context(precision=260))
    ill = kappa_c > 2.0**45
    residual[ill] = np.nan
    missed = sum(not brackets(ell[i], rate[i], theta[i, j]) for i, j in np.argwhere(ill))
    lost = np.isnan(back) != np.isnan(theta)
    unsorted = (np.diff(np.nan_to_num(theta, nan=9.0), axis=-1) < 0).any(axis=-1)
    counts = lost.sum(), unsorted.sum(), np.isfinite(theta).sum(), ill.sum(), missed
    return np.nanmax(residual), *(int(x) for x in counts)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--points", type=float, default=1e6)
    parser.add_argument("--exact", type=float, default=1e4)
    args = parser.parse_args()
    start, size = time.time(), 2_000
    with multiprocessing.get_context("spawn").Pool(os.cpu_count()) as pool:
        checked = pool.map(
            wrong_counts, [(seed, size) for seed in range(int(args.exact) // size)], chunksize=1
        )
        wrong = [w for part, _ in checked for w in part]
        print(
            f"{size * len(checked)} exact checks: {len(wrong)} wrong counts {wrong[:5]}; "
            f"with 0, 1, 2, 3 roots: {sum(c for _, c in checked)} ({time.time() - start:.0f} s)"
        )
        start, size = time.time(), 100_000
        parts = pool.map(
            residuals, [(seed, size) for seed in range(max(1, int(args.points) // size))], chunksize=1
        )
    worst, lost, unsorted, roots, ill, missed = (np.array(x) for x in zip(*parts, strict=True))
    print(
        f"{size * len(parts)} rates, {roots.sum()} inclinations: worst residual {worst.max():.2f} ulp, "
        f"{lost.sum()} without a rate, {unsorted.sum()} out of order, {missed.sum()} of {ill.sum()} ill-conditioned "
        f"ones further than 3 ulp from the root ({time.time() - start:.0f} s)"
    )


if __name__ == "__main__":
    main()
