"""Periods of nutations and their claims, single and many: 113-bit motions, and the theory of a top."""

import math
from pathlib import Path

import numpy as np
import pytest

import spincyl as sc

ROWS = [
    line.split(",")
    for line in (Path(__file__).parent / "reference" / "periods.csv").read_text().splitlines()[1:]
]
WANT = ("period", "precession_per_period")


def motion(row):
    """Kind, contact, body, state, and the true period and precession."""
    kind, contact, *numbers = row
    x = [float.fromhex(number) for number in numbers]
    return kind, contact, sc.Body(*x[:3], fillet=x[3]), sc.State(*x[4:8]), x[8:]


@pytest.mark.parametrize("kind", sorted({row[0] for row in ROWS}))
def test_a_period_is_as_good_as_its_claim_and_near_a_pole_all_digits_are_right(kind):
    rows = [row for row in ROWS if row[0] == kind]
    assert len(rows) == 10
    for row in rows:
        _, contact, body, state, (period, phi) = motion(row)
        found = sc.swing(body, state, contact)
        assert abs(found.period - period) <= 2 * found.error, row
        if kind != "saddle":
            assert found.error <= 1e-11 * period and abs(found.period / period - 1) <= 1e-12, row
        many = sc.sweep.roll(body, state, 0.1, want=WANT, contact=contact, beyond=True)
        claim = float(many["error"])
        assert abs(float(many["period"]) - period) <= 2 * claim, row
        assert abs(float(many["precession_per_period"]) - phi) <= 2 * claim, row


BALL = sc.Body(-0.1091342966683389, 0.7491982311998557, 0.45654036042742985, fillet=1.0)


def linear(body, spin, down):
    """Both precession rates of a ball nearly upright on a pole, by the linear theory of the sleeping top.

    With zeta the lean as a complex number, J zeta'' = i (I3 + h) n zeta' + ell zeta, h the height of the
    centre and J = I1 + h^2; upside down, ell and the spin have the other sign.
    """
    ell, n = (-body.ell, -spin) if down else (body.ell, spin)
    h = 1 + ell
    j = body.i1 + h * h
    middle = (body.i3 + h) * n / (2 * j)
    return middle, math.sqrt(middle * middle - ell / j)


@pytest.mark.parametrize("down", [False, True])
@pytest.mark.parametrize("theta", [1e-8, 1e-7, 1e-6, 1e-5])
def test_a_ball_that_spins_all_but_upright_nods_as_a_sleeping_top_does(theta, down):
    middle, root = linear(BALL, -1.948, down)
    theta = math.pi - theta if down else theta
    s = math.sin(theta)
    for share in (0.0, 1e-9, 1e-3, 0.5, 0.999):
        # two circular motions with rates middle +- root; the amplitude of the slower is `share` of the other
        rate = ((middle - root) + share * (middle + root)) / (1 + share)
        start = sc.State(theta, rate * s, 0.0, -1.948)
        found = sc.swing(BALL, start)
        near = 10 * s * s
        assert abs(found.period / (math.pi / root) - 1) <= near + 1e-13
        assert found.error <= 1e-11
        turn = (middle - root) * math.pi / root
        assert abs(found.precession_per_period - turn) <= 20 * near + 1e-11
        many = sc.sweep.roll(BALL, start, 1.0, want=WANT)
        assert abs(float(many["period"]) - found.period) <= 2 * (float(many["error"]) + found.error)


def test_the_period_of_a_steady_state_is_that_of_its_nutation_at_any_inclination():
    middle, root = linear(BALL, -1.948, False)
    for theta in np.geomspace(1e-8, 1.0, 17):
        state = BALL.circular(theta, middle - root)
        found = sc.swing(BALL, state)
        assert abs(found.period * BALL.nutation(state, "rolling") / (2 * math.pi) - 1) <= 1e-13
