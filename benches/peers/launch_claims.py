"""Claimed errors of a sweep of launches, against heyoka in 80-bit arithmetic.

    python benches/peers/launch_claims.py [--count 10000]        needs heyoka; some minutes

The launches are those of slip.py that slip once and then roll. An error is the worst of t, theta, w1, w2, w3
and heat where slipping ends, a ratio that error over the claim.
"""

import argparse

import numpy as np
from scene import launches
from slip import Spincyl, finish, first_states, reference

TOLERANCES = (1e-7, 1e-9, 1e-11, 1e-13)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10_000)
    state, slip, mu = launches(parser.parse_args().count)
    first = first_states(state, slip)
    truth = finish(first, reference(first, mu), mu)
    print(
        "| tolerance | launches | error 99 % | claimed 99 % | beyond the claim | beyond twice | beyond ten times | worst ratio |"
    )
    print("| --- " * 8 + "|")
    for tol in TOLERANCES:
        ends, plain, claims = Spincyl(tol)(state, slip, mu)
        errors = np.abs(ends - truth).max(axis=1)[plain]
        ratio = errors / claims[plain]
        over = " | ".join(f"{(ratio > x).sum()}" for x in (1, 2, 10))
        high = " | ".join(f"{np.quantile(x, 0.99):.1e}" for x in (errors, claims[plain]))
        print(f"| {tol:g} | {plain.sum()} | {high} | {over} | {ratio.max():.2g} |", flush=True)


if __name__ == "__main__":
    main()
