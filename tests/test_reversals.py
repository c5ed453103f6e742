"""Reversals of the spin of a stone: their times, against Newton's and Euler's equations integrated by SciPy."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import spincyl as sc

# a rattleback of 14 cm with an exaggerated twist, which reverses within seconds
STONE = sc.Ellipsoid.rattleback(semi_axes=(0.07, 0.014, 0.012), twist=np.radians(4), mass=0.03)
SECOND, T = STONE.scale.seconds(1.0), 8.0


def start(spin):
    return STONE.spinning(spin * SECOND, pitch=3e-3, roll=3e-3)


def newton_euler(stone, state, t):
    """The spin against time of a stone that rolls, in natural units, by SciPy and in vectors of the stone."""
    squares, moments, offset = stone.semi_axes**2, stone.inertia, stone.offset

    def rates(_, y):
        n, w = np.array(y[:3]), np.array(y[3:])
        turned = np.cross(n, w)  # the vertical is fixed in the laboratory
        size = np.sqrt(n @ (squares * n))
        r = -squares * n / size - offset  # from the centre of mass to the contact point
        r_rate = -squares * turned / size + squares * n * (n @ (squares * turned)) / size**3
        v = np.cross(r, w)  # the contact point rests
        force = np.cross(r_rate, w) + np.cross(w, v) + n  # without the part r x w'
        couple = np.cross(r, force) - np.cross(w, moments @ w)
        whole = moments + (r @ r) * np.eye(3) - np.outer(r, r)
        return [*turned, *np.linalg.solve(whole, couple)]

    def spin(_, y):
        return np.dot(y[:3], y[3:])

    y = [*state.vertical, *state.w]
    found = solve_ivp(rates, (0.0, t), y, method="DOP853", rtol=1e-12, atol=1e-14, events=spin)
    return found.t_events[0]


@pytest.mark.parametrize(("spin", "count"), [(-4.0, 2), (4.0, 1)])
def test_the_spin_reverses_when_newton_and_euler_say(spin, count):
    m = sc.roll(STONE, start(spin), T)
    assert m.known_until == T and m.reversals.shape == (count,)
    zeros = newton_euler(STONE, m.start, T / SECOND) * SECOND
    assert zeros.size > count, "it also rocks through zero and comes back at once, which is no reversal"
    closest = [zeros[np.argmin(abs(zeros - t))] for t in m.reversals]
    np.testing.assert_allclose(m.reversals, closest, rtol=1e-7)
    assert not any(((t + 1e-6 < zeros) & (zeros < t + 0.1)).any() for t in m.reversals), "the last of several"
    before, after = m.at(m.reversals * (1 - 1e-12)).spin, m.at(m.reversals * (1 + 1e-12)).spin
    assert (before * after < 0).all() and np.abs(m.at(m.reversals).spin).max() < 1e-12
    row = sc.sweep.roll(STONE, m.start, T, want=("reversals", "first_reversal"))
    assert int(row.reversals) == count
    assert float(row.first_reversal) == pytest.approx(m.reversals[0], rel=1e-7)


def test_the_reversals_do_not_depend_on_the_times_of_the_motion_nor_on_its_units():
    m = sc.roll(STONE, start(-4.0), T)
    for t in ([0.0, T], np.linspace(0.0, T, 5)):
        assert np.array_equal(sc.roll(STONE, m.start, t).reversals, m.reversals)
    assert np.array_equal(m.natural.reversals * SECOND, m.reversals)
    assert np.array_equal(sc.roll(STONE, m.start, m.reversals[1] * 0.999).reversals, m.reversals[:1])


def test_a_stone_that_is_let_go_without_spin_has_no_direction_to_reverse():
    m = sc.roll(STONE, STONE.spinning(0.0, pitch=0.02), 1.0)
    assert m.reversals.shape == (0,) and abs(m.spin[-1]) > 0.1


def test_an_impact_that_turns_the_spin_round_is_the_time_of_a_reversal():
    egg = sc.Ellipsoid.egg(0.022, 0.0285).in_metres(0.06)
    n = np.array([-0.767, 0.64, -0.037])
    state = sc.EllipsoidState.from_si(n / np.linalg.norm(n), (-39.0, -55.0, -23.0), scale=egg)
    m = sc.roll(egg, egg.dropped(state, 0.02), 0.3, contact=sc.Coulomb(0.6), restitution=0.5)
    hit = m.impacts[0]
    assert hit.before.spin * hit.after.spin < 0
    assert m.reversals[0] == pytest.approx(hit.time, abs=1e-15)
