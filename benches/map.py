"""Map of the rate: spincyl and the best broadcast formula in NumPy, in one run, with the error of each.

    python benches/map.py [--side 4000] [--rounds 15]

Both write side x side doubles into arrays that were touched before. NumPy's formula is Eq. 15 of the paper with
one-dimensional tan and sin, evaluated in place over a few rows at a time, so that its temporaries stay in cache.
Times are the minimum over rounds that alternate the contestants; errors are those of a sample, in ulp of
2^-53 over 1 + kappa_c, against 260-bit arithmetic.
"""

import argparse
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from accuracy import errors

import spincyl as sc


def numpy_rows(theta, ell, out, first, last, rows=8):
    tan, sin, a = np.tan(theta), np.sin(theta), 0.5 + (2 / 3) * ell * ell
    lever, top = np.empty((rows, ell.size)), np.empty((rows, ell.size))
    with np.errstate(all="ignore"):
        for i in range(first, last, rows):
            j = min(i + rows, last)
            x, y, o = lever[: j - i], top[: j - i], out[i:j]
            np.multiply(tan[i:j, None], ell, out=x)
            np.subtract(1.0, x, out=y)
            np.subtract(a, x, out=x)
            np.multiply(x, sin[i:j, None], out=x)
            np.divide(y, x, out=y)
            np.sqrt(y, out=o)


def error(rate, theta, ell, samples=20_000):
    """Largest and 99th percentile of error/(1 + kappa_c) of a sample of the map."""
    rng = np.random.default_rng(1)
    i, j = rng.integers(0, theta.size, samples), rng.integers(0, ell.size, samples)
    found, _ = errors(theta[i], ell[j], np.zeros(samples), rate[i, j], sc.Body.solid(ell[j]).region(theta[i]))
    return found.max(), np.percentile(found, 99)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--side", type=int, default=4000)
    parser.add_argument("--rounds", type=int, default=15)
    args = parser.parse_args()
    theta, ell = np.linspace(1e-3, np.pi / 2 - 1e-3, args.side), np.linspace(0.05, 3.0, args.side)
    array, half = np.zeros((args.side, args.side)), args.side // 2
    result = sc.sweep.portrait(theta, ell, want=["rate"])
    everything = sc.sweep.portrait(theta, ell)
    single = sc.sweep.portrait(theta, ell, want=["rate"], dtype="float32")
    pool = ThreadPoolExecutor(2)
    contestants = {
        "fill with a constant, 1 thread": lambda: array.fill(1.5),
        "NumPy, 1 thread": lambda: numpy_rows(theta, ell, array, 0, args.side),
        "NumPy, 2 threads": lambda: list(
            pool.map(lambda r: numpy_rows(theta, ell, array, *r), ((0, half), (half, args.side)))
        ),
        "spincyl, 1 thread": lambda: sc.sweep.portrait(theta, ell, want=["rate"], out=result, threads=1),
        "spincyl, 2 threads": lambda: sc.sweep.portrait(theta, ell, want=["rate"], out=result, threads=2),
        "spincyl in float32, 1 thread": lambda: sc.sweep.portrait(
            theta, ell, want=["rate"], out=single, dtype="float32", threads=1
        ),
        "spincyl in float32, 2 threads": lambda: sc.sweep.portrait(
            theta, ell, want=["rate"], out=single, dtype="float32", threads=2
        ),
        "spincyl, all four quantities, 2 threads": lambda: sc.sweep.portrait(
            theta, ell, out=everything, threads=2
        ),
    }
    best = dict.fromkeys(contestants, np.inf)
    for _ in range(args.rounds):
        for name, run in contestants.items():
            start = time.perf_counter()
            run()
            best[name] = min(best[name], time.perf_counter() - start)
    contestants["NumPy, 1 thread"]()
    errors = {"NumPy": error(array, theta, ell), "spincyl": error(result["rate"].values, theta, ell)}
    points = args.side**2
    for name, seconds in best.items():
        worst = errors.get(name.split(",")[0])
        tail = f"   error max {worst[0]:8.2f}, 99 % {worst[1]:6.2f} ulp" if worst else ""
        print(
            f"{name:<42} {seconds / points * 1e9:7.3f} ns a point, {points / seconds / 1e6:8.1f} million points/s{tail}"
        )
    for threads in ("1 thread", "2 threads"):
        print(
            f"spincyl over NumPy, {threads}: {best[f'NumPy, {threads}'] / best[f'spincyl, {threads}']:.2f} times as fast"
        )
    off = np.nanmax(np.abs(single["rate"].values / result["rate"].values - 1)) * 2**24
    print(f"float32 off the doubles by at most {off:.4f} ulp of 2^-24 in {points} points")


if __name__ == "__main__":
    main()
