"""Compares the standard error of a fitted inertia ratio with the spread of many repetitions.

Simulated measurements of both branches, with errors of 0.01 rad and 2 % that are given to `compare`. Prints,
for each body, mean and spread of (fitted - true) / error, which should be 0 and 1, and chi2 per degree of
freedom, which should be 1.

usage: python benches/fit.py [--repeat 200]
"""

import argparse

import numpy as np

import spincyl as sc


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeat", type=int, default=200)
    repeat = parser.parse_args().repeat
    rng = np.random.default_rng(1)
    for body in (sc.Body.solid(2.5), sc.Body.solid(0.375), sc.Body.tube(6.0, 0.8), sc.Body.solid(0.0)):
        low, high = sorted([float(body.theta_balance), float(body.theta_limit)])
        pulls, chi2 = [], []
        for _ in range(repeat):
            theta = rng.uniform(0.08, 0.8 * low, 6)
            if high < 1.4:
                theta = np.r_[theta, rng.uniform(high + 0.1, 1.5, 10)]
            rate = body.rate(theta)
            errors = {"theta_err": 0.01, "rate_err": 0.02 * rate}
            seen = rng.normal(theta, 0.01).clip(1e-3, np.pi / 2), rng.normal(rate, 0.02 * rate)
            found = sc.data.compare(body, *seen, **errors)
            pulls.append((found.ratio - found.expected) / found.ratio_err)
            chi2.append(found.chi2)
        print(f"{body!r:28} mean {np.mean(pulls):+.2f}, spread {np.std(pulls):.2f}, chi2 {np.mean(chi2):.2f}")


if __name__ == "__main__":
    main()
