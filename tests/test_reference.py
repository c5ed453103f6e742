"""Comparison with 60 digits, and with an independently linearised model (rows N of docs/hard-cases.md)."""

import math
import pathlib
import sys
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp, mpf

import spincyl as sc

REFERENCE = pathlib.Path(__file__).with_name("reference")
sys.path.insert(0, str(REFERENCE))
import newton_euler  # noqa: E402

ULP = 2.0**-53
CONTACTS = ("rolling", "smooth")


def exact_kappa(body, theta, contact):
    """kappa to 40 digits, of the state with the centre at rest, at the inclination `theta` as a double."""
    with mp.workdps(60):
        ell, i3 = mpf(body.ell), (1 + mpf(body.bore) ** 2) / 2
        i1 = i3 / 2 + ell**2 / 3
        s, c = mp.sin(theta), mp.cos(theta)
        w1 = mp.sqrt((c - ell * s) * s / (i1 * c - i3 * ell * s))
        return newton_euler.kappa((ell, i1, i3), [mpf(theta), w1, mpf(0), ell * w1], contact)


@pytest.mark.parametrize("contact", CONTACTS)
def test_n12_a_millionth_from_a_boundary_the_label_is_that_of_the_linear_dynamics(contact):
    checked = 0
    for bore in (0.0, 0.6, 1.0):
        for ell in (0.2, 0.5, 0.8, 0.9, 0.93, 1.2, 2.5, 6.0):
            body = sc.Body.tube(ell, bore)
            for boundary in body.boundaries(contact)[~np.isnan(body.boundaries(contact))]:
                for offset in (-1e-6, -1e-7, 1e-7, 1e-6):
                    theta = boundary * (1 + offset)
                    if theta > np.pi / 2 or np.isnan(body.rate(theta)):
                        continue
                    exact = exact_kappa(body, theta, contact)
                    assert bool(body.stable(theta, contact)) == (exact > 0), (ell, bore, theta)
                    assert abs(body.stability(theta, contact) - exact) < 1e-3 * abs(exact)
                    checked += 1
    assert checked > 60


@pytest.mark.parametrize(
    ("ell", "theta", "contact"),
    [
        (2.5, 1.3, "rolling"), (2.5, 0.37, "rolling"), (2.5, 0.34, "smooth"), (0.375, 1.5, "rolling"),
        (0.375, 1.5, "smooth"), (0.9, 1.1, "smooth"), (0.9, 1.1, "rolling"),
    ],
)  # fmt: skip
def test_n12_a_kick_of_1e_8_nutates_or_grows_as_kappa_says(ell, theta, contact):
    """Integrates the independent three-dimensional model with RK4 at 30 digits."""
    body = sc.Body.solid(ell)
    kappa = float(body.stability(theta, contact))
    with mp.workdps(30):
        state = [mpf(x) for x in (theta, body.steady(theta).w1, 0, body.steady(theta).w3)]
        # in doubles the state is steady to 1e-16 only: refine its rate, so that only the kick disturbs it
        e, i3 = mpf(ell), mpf(1) / 2
        i1 = i3 / 2 + e**2 / 3
        s, c = mp.sin(state[0]), mp.cos(state[0])
        state[1] = mp.sqrt((c - e * s) * s / (i1 * c - i3 * e * s))
        state[3] = e * state[1]
        y, kick = list(state), mpf(10) ** -8
        y[2] -= kick
        time = 2.0 / math.sqrt(abs(kappa))
        steps = 60
        h = mpf(time) / steps

        def f(x):
            return newton_euler.derivative((e, i1, i3), x, contact)

        for _ in range(steps):
            k1 = f(y)
            k2 = f([a + h / 2 * b for a, b in zip(y, k1, strict=True)])
            k3 = f([a + h / 2 * b for a, b in zip(y, k2, strict=True)])
            k4 = f([a + h * b for a, b in zip(y, k3, strict=True)])
            y = [a + h / 6 * (p + 2 * q + 2 * r + t) for a, p, q, r, t in zip(y, k1, k2, k3, k4, strict=True)]
        moved = float((y[0] - state[0]) / kick)
    w = math.sqrt(abs(kappa))
    expected = math.sin(2.0) / w if kappa > 0 else math.sinh(2.0) / w
    assert moved == pytest.approx(expected, rel=0.01)


def sturm_count(ell, rate):
    """Roots of the quartic in (0, 1) by Sturm's theorem, in exact rational arithmetic."""
    ell, w = Fraction(ell), Fraction(rate) ** 2
    a = Fraction(1, 2) + Fraction(2, 3) * ell**2
    p = [Fraction(1), 2 * (ell - a * w), -4 * ell * w, 2 * (ell + a * w), Fraction(-1)]
    while sum(p) == 0:  # a root at t = 1, on the side, does not count: divide it out
        p = [sum(p[: k + 1]) for k in range(len(p) - 1)]
    chain = [p, [c * (len(p) - 1 - k) for k, c in enumerate(p[:-1])]]
    while True:
        dividend, divisor = list(chain[-2]), chain[-1]
        while len(dividend) >= len(divisor):
            factor = dividend[0] / divisor[0]
            dividend = [x - factor * (divisor[k] if k < len(divisor) else 0) for k, x in enumerate(dividend)][
                1:
            ]
        while dividend and dividend[0] == 0:
            dividend = dividend[1:]
        if not dividend:
            break
        chain.append([-x for x in dividend])

    def changes(values):
        signs = [v > 0 for v in values if v != 0]
        return sum(x != y for x, y in pairwise(signs))

    return changes([q[-1] for q in chain]) - changes([sum(q) for q in chain])


def planted(rng, n):
    """Random bodies and rates, and rates at and next to the folds of random bodies."""
    ell = np.where(rng.random(n) < 0.7, rng.uniform(0, 3, n), 10 ** rng.uniform(-3, 3, n))
    rate = np.where(rng.random(n) < 0.7, rng.uniform(0, 4, n), 10 ** rng.uniform(-3, 3, n))
    body = sc.Body.solid(ell)
    fold = body.rate(np.nanmax(np.where(np.isnan(body.folds()), -1, body.folds()), axis=-1))
    offset = rng.choice([0, 1, -1, 2, -2, 1e3, -1e3, 1e6, -1e6], n) * 2.0**-52
    rate = np.where((rng.random(n) < 0.3) & np.isfinite(fold), fold * (1 + offset), rate)
    return ell, np.where(rng.random(n) < 0.05, 1 + rng.integers(-2, 3, n) * 2.0**-53, rate)


def test_n11_the_count_is_that_of_sturms_theorem():
    ell, rate = planted(np.random.default_rng(7), 3000)
    counts = sc.Body.solid(ell).count(rate)
    wrong = [(e, r, c) for e, r, c in zip(ell, rate, counts, strict=True) if c != sturm_count(e, r)]
    assert not wrong
    assert set(counts) == {0, 1, 2, 3}


def test_n11_inclinations_have_the_rate_that_was_asked_for():
    rng = np.random.default_rng(8)
    ell, rate = rng.uniform(0, 3, 20_000), rng.uniform(0.01, 4, 20_000)
    body = sc.Body.solid(ell)
    thetas = body.inclinations(rate)
    assert (np.diff(np.nan_to_num(thetas, nan=9.0), axis=-1) >= 0).all()
    family = sc.Body.solid(ell[:, None])
    back, n = family.rate(thetas), np.cos(thetas) - ell[:, None] * np.sin(thetas)
    m = n + family.excess * np.cos(thetas)
    kappa_c = thetas / 2 * np.abs(family.excess * ell[:, None] / (n * m) + 1 / np.tan(thetas))
    residual = np.abs(back / rate[:, None] - 1) / ULP / (1 + kappa_c)
    assert np.nanmax(residual) <= 8
    assert np.array_equal(np.isnan(back), np.isnan(thetas))
