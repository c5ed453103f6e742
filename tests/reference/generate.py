"""Writes steady.csv: high-precision steady states and stability, the reference of the Rust tests.

    python tests/reference/generate.py

Computed with mpmath at 60 digits on the exact values of the doubles theta, ell and bore: the rate from Eq. 15
of Jackson et al. with tangents, kappa from the linearised three-dimensional model of newton_euler.py. Numbers
are written as exact hexadecimal doubles; the rate as a sum of two.
"""

import math
import pathlib

import numpy as np
from mpmath import mp, mpf
from newton_euler import kappa

mp.dps = 60
HALF_PI = math.pi / 2


def shape(ell, bore):
    """ell, I1, I3 of a tube."""
    i3 = (1 + mpf(bore) ** 2) / 2
    return mpf(ell), i3 / 2 + mpf(ell) ** 2 / 3, i3


def ulps(x, n):
    for _ in range(abs(n)):
        x = math.nextafter(x, math.inf if n > 0 else -math.inf)
    return x


def points():
    """(row of hard-cases.md, theta, ell, bore)."""
    rng = np.random.default_rng(20190101)
    for k in (0, 1, -1, 4, -4):
        ell = ulps(math.sqrt(0.75), k)
        theta0 = math.atan2(1, ell)
        for e in (6, 8, 10, 12, 14):
            for sign in (1, -1):
                yield "N1" if e < 10 else "N2", theta0 + sign * 10.0**-e, ell, 0.0
    for theta in (5e-324, 1e-300, 1e-8):
        for ell in (1e-8, 1e-3, 1.0, 1e3, 1e8, 1e50, 1e150):
            yield "N4", theta, ell, 0.0
    for k in (0, -1, -2):
        for ell in (1e-8, 1e8):
            yield "N7", ulps(HALF_PI, k), ell, 0.0
    for _ in range(300):
        yield "map", rng.uniform(1e-3, HALF_PI), rng.uniform(0, 3), rng.choice([0.0, rng.uniform(0, 1), 1.0])
    for _ in range(300):
        ell = 10.0 ** rng.uniform(-8, 8)
        yield "whole map", 10.0 ** rng.uniform(-12, 0.19), ell, rng.choice([0.0, rng.uniform(0, 1)])
    for _ in range(150):
        ell, bore = 10.0 ** rng.uniform(-2, 2), rng.choice([0.0, rng.uniform(0, 1)])
        _, i1, i3 = shape(ell, bore)
        edge = math.atan2(1, ell) if rng.random() < 0.5 else float(mp.atan2(i1 / i3, mpf(ell)))
        yield "edge", edge * (1 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-14, -2)), ell, bore


def main():
    path = pathlib.Path(__file__).with_name("steady.csv")
    lines = ["row,theta,ell,bore,rate,rate_rest,kappa_c,rolling,smooth"]
    for row, theta, ell, bore in points():
        theta, ell, bore = min(float(theta), HALF_PI), float(ell), float(bore)
        mp.dps = 400 if row == "N4" else 90
        body = shape(ell, bore)
        x, a = mpf(theta), body[1] / body[2]
        tan = mp.tan(x)
        square = (1 - body[0] * tan) / ((a - body[0] * tan) * mp.sin(x))
        if square <= 0:
            continue
        rate = mp.sqrt(square)
        slope = (1 + tan**2) * body[0] * (1 / (a - body[0] * tan) - 1 / (1 - body[0] * tan)) - 1 / tan
        w1 = rate / mp.sqrt(body[2]) * mp.sin(x)
        y = [x, w1, mpf(0), body[0] * w1]
        stable = (
            [float("nan")] * 2 if row == "N4" else [float(kappa(body, y, k)) for k in ("rolling", "smooth")]
        )
        high = float(rate)
        numbers = [theta, ell, bore, high, float(rate - mpf(high)), float(abs(slope * x) / 2), *stable]
        lines.append(",".join([row, *(n.hex() for n in numbers)]))
    path.write_text("\n".join(lines) + "\n")
    print(f"{len(lines) - 1} states in {path.name}")


if __name__ == "__main__":
    main()
