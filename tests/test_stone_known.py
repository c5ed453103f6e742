"""Reliability of a stone's motion: until when it is known, reversals of the spin, certain ends."""

import warnings

import numpy as np
import pytest

import spincyl as sc

STONE = sc.Ellipsoid((1.0, 0.3, 0.2), [[0.02, -0.012, 0], [-0.012, 0.2, 0], [0, 0, 0.21]], (0, 0, -0.07))
TOLERANCES = (None, 1e-13, 1e-12, 1e-10, 1e-8, 1e-6)


def turned(t, spin):
    """Number of reversals of a densely sampled spin, and the time of the zero before the first."""
    side, count, first, zero, enough = np.sign(spin[0]), 0, np.nan, np.nan, 0.1 * abs(spin[0])
    for i in range(1, len(spin)):
        if spin[i] * spin[i - 1] < 0:
            zero = t[i - 1] + (t[i] - t[i - 1]) * spin[i - 1] / (spin[i - 1] - spin[i])
        if spin[i] * side < -enough:
            side, count = -side, count + 1
            first = zero if count == 1 else first
    return count, first


def test_a_rattleback_says_until_when_it_is_known_and_reversals_are_counted_up_to_there():
    stone = sc.Ellipsoid.rattleback((0.06, 0.012, 0.01), twist=np.radians(3)).in_metres(0.02)
    start = stone.spinning(-8.0 * stone.scale.seconds(1.0), pitch=0.01, roll=0.01)
    t = np.linspace(0, 40, 8001)
    with pytest.warns(sc.ErrorWarning, match=r"known to 1 % up to t = 2[5-9].* s \(known_until\)"):
        m = sc.roll(stone, start, t)
    assert 25 < m.known_until < 30 < m.t[-1] and "known to 1 % up to" in m.message
    assert m.natural.known_until == pytest.approx(m.known_until / stone.scale.seconds(1.0))
    # with other steps the errors differ, but the motion agrees up to that time
    with pytest.warns(sc.ErrorWarning):
        other = sc.roll(stone, start, t, tol=3e-14)
    upto = t <= min(m.known_until, other.known_until)
    off = np.abs(m.w - other.w).max(axis=1)
    fastest = np.abs(m.w).max()
    assert off[upto].max() < 0.01 * fastest < off.max()
    with pytest.warns(sc.ErrorWarning, match="1 of 1 motions are known only up to known_until"):
        many = sc.sweep.roll(stone, start, 40.0, tol=1e-14)
    until = float(many["known_until"])
    assert until == pytest.approx(m.known_until, rel=0.02) and many["known_until"].attrs["units"] == "s"
    upto = t <= until
    count, first = turned(t[upto], m.spin[upto])
    assert int(many["reversals"]) == count < turned(t, m.spin)[0]
    assert float(many["first_reversal"]) == pytest.approx(first, abs=1e-3)
    # a motion known to its end says so without a warning
    m = sc.roll(stone, start, np.linspace(0, 10, 11))
    assert m.known_until == 10.0 and "known" not in m.message
    assert float(sc.sweep.roll(stone, start, 10.0)["known_until"]) == pytest.approx(10.0, rel=1e-15)


def test_one_time_says_until_when_a_motion_is_known_as_well_as_many():
    start = STONE.spinning(-0.6, pitch=0.02, roll=0.01)
    with pytest.warns(sc.ErrorWarning):
        found = [sc.roll(STONE, start, t, tol=1e-6).known_until for t in (80.0, np.linspace(0, 80, 5))]
    assert found[0] == found[1] and 5 < found[0] < 80


# nearly round, with a spin much smaller than its rolling: several reversals in one step
TENSOR = [
    [0.060410842259208786, -0.004176755897106626, -0.009631850526063718],
    [-0.004176755897106626, 0.051255188810675055, 0.0025221405612223147],
    [-0.009631850526063718, 0.0025221405612223147, 0.03480822565765198],
]
ROUND = sc.Ellipsoid((1.0, 1.0, 0.31818744707015156), TENSOR, (0, 0, -0.0449374795613149))


@pytest.mark.filterwarnings("ignore::spincyl.ErrorWarning")
@pytest.mark.parametrize("contact", [sc.Coulomb(0.002), sc.Viscous(0.01), "rolling", "smooth"])
@pytest.mark.parametrize("spin", [0.0010374416535278248, -0.002, 0.01])
def test_reversals_within_a_step_are_counted_with_every_tolerance(contact, spin):
    n = np.array([0.0016516208221265094, 1.0570057798276084e-05, 0])
    n[2] = np.sqrt(1 - n @ n)
    last, w, slip = 12.0, spin * n + [0.3, 0.2, 0.0], None
    if not isinstance(contact, str):
        last, w, slip = 1.45, spin * n, (0.43308105149101156, 0.570248598143808)
    state = sc.EllipsoidState(n, w, slip)
    m = sc.roll(ROUND, state, np.linspace(0, last, 4001), contact=contact)
    for tol in (1e-6, 1e-8, 1e-10, 1e-12):
        many = sc.sweep.roll(ROUND, state, last, contact=contact, tol=tol)
        upto = m.t <= float(many["known_until"])
        count, first = turned(m.t[upto], m.spin[upto])
        assert int(many["reversals"]) == count, tol
        assert upto.all() or float(many["error"]) > 0.1 * abs(m.spin[0])
        if count:
            assert float(many["first_reversal"]) == pytest.approx(first, abs=1e-4), tol


def extremum(follow, what, low, high):
    """The maximum of a quantity between two times by repeated refinement, and its time."""
    for _ in range(8):
        t = np.linspace(low, high, 33)
        values = what(follow(t))
        i = int(np.argmax(values))
        assert 0 < i < 32
        low, high = t[i - 1], t[i + 1]
    return float(values[i]), float(t[i])


# the needed friction has a narrow maximum, and later a larger one
NARROW = [
    [0.020357275801981576, -0.00010164565821605652, 0.0],
    [-0.00010164565821605652, 0.01583751637654831, 0.0],
    [0.0, 0.0, 0.005852307280194783],
]
VERTICAL = np.array([0.11110744873798939, -0.166507800364546, 0.9797603213300156])
FALLING = sc.EllipsoidState(VERTICAL, [0.008118250558719448, -0.012166169403531957, 0.07158781761612863])


def narrow():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # part of the mass is outside the ellipsoid
        return sc.Ellipsoid(
            [0.042861278498571374, 0.031730260746448816, 1.0], NARROW, offset=[0.0, 0.0, -0.14179249980869124]
        )


def grazed(end):
    """A stone, its start, its ending and time, and a limiting value at which the end just occurs."""
    if end == "mu":
        stone, state = narrow(), FALLING
        most, when = extremum(
            lambda t: sc.roll(stone, state, t, t0=0.0, want="force"),
            lambda m: m.friction_coefficient,
            1.9,
            1.92,
        )
        return lambda limit: (stone, state, {"mu": limit}), most, when
    state = sc.EllipsoidState((0, 0.1, np.sqrt(0.99)), (0.1, 0.2, 0.3))
    most, when = extremum(lambda t: sc.roll(STONE, state, t, t0=0.0), lambda m: m.theta, 0.02, 0.3)
    return (
        lambda limit: (sc.Ellipsoid(STONE.semi_axes, STONE.inertia, STONE.offset, limit), state, {}),
        most,
        when,
    )


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("end", ["mu", "edge"])
def test_an_end_that_is_met_for_a_moment_is_met_with_every_tolerance_or_has_no_claim(end):
    of, most, when = grazed(end)
    for by in (1e-4, 1e-6, 1e-8, 1e-10, -1e-10, -1e-8, -1e-6, -1e-4):
        stone, state, more = of(most * (1 - by))
        sure = 0
        for tol in TOLERANCES:
            m = sc.roll(stone, state, when + 0.05, tol=tol, **more)
            many = sc.sweep.roll(stone, state, when + 0.05, tol=tol or 1e-14, want="end", **more)
            assert int(many["status"]) == m.status and float(many["error"]) == m.error
            if m.error == np.inf:
                assert m.known_until <= when + 1e-3
                continue
            sure += 1
            assert (m.status != sc.Ending.DONE) == (by > 0), (by, tol)
            if by > 0:
                assert abs(m.event.time - when) < 1.0 * by**0.5 + m.error
        assert sure >= {10: 0, 8: 2, 6: 3, 4: 5}[round(-np.log10(abs(by)))], by
