"""What leaves the hand: throws and presses, single and in arrays, in natural units and SI."""

import csv
from pathlib import Path

import numpy as np
import pytest

import spincyl as sc

HOOP, CAN, PIPE = sc.Body.tube(0.0, bore=1.0), sc.Body.solid(1.5), sc.Body.tube(6.0, bore=0.8)
FAMILY = sc.Body.tube(np.array([1.0, 3.0, 6.0]), bore=0.8)


def fields(state):
    return [state.theta, state.w1, state.w2, state.w3, *state.slip]


def test_a_throw_has_the_centres_velocity_and_its_backspin():
    for body in (HOOP, CAN, sc.Body.solid(0.2, fillet=0.05), sc.Body.ball(0.0, 0.4, 0.4)):
        state = sc.thrown(body, 1.5, 4.0)
        assert fields(state) == [np.pi / 2, 0.0, 0.0, -4.0, 0.0, 5.5]
        assert state.slip[1] + state.w3 == 1.5, (
            "what its bottom does beside its turning is the centre's velocity"
        )


def test_a_press_is_that_of_the_three_dimensional_model():
    with (Path(__file__).parent / "reference" / "impulses.csv").open() as file:
        rows = [row[1:] for row in csv.reader(file) if row[0] == "pressed"]
    x = np.array([[float.fromhex(word) for word in row] for row in rows]).T
    assert x.shape == (11, 60)
    most = np.where(x[3] == 1.0, np.pi / 2, np.nan)
    bodies = sc.Body(*x[:3], fillet=x[3], theta_end=most)
    found = sc.pressed(bodies, x[4], x[5], finger=x[6], table=x[7])
    for mine, known in zip((found.w1, found.w3, found.slip[1]), x[8:], strict=True):
        assert np.all(np.abs(mine - known) <= 1e-13 * (1 + np.abs(known)))


def test_an_array_of_throws_and_presses_is_as_many_single_ones():
    j, angle = np.linspace(0.5, 9.0, 4)[:, None], np.array([0.4, 0.8, 1.2])
    many = sc.pressed(FAMILY, j, angle, finger=0.5, table=0.2)
    assert np.shape(many.w1) == (4, 3)
    for i in range(4):
        for k in range(3):
            one = sc.pressed(sc.Body.tube(FAMILY.ell[k], bore=0.8), j[i, 0], angle[k], finger=0.5, table=0.2)
            assert fields(one) == [x[i, k] for x in fields(many)]
    v, spin = np.linspace(-1, 1, 5)[:, None], np.array([0.0, 2.0])
    throws = sc.thrown(CAN, v, spin)
    assert np.array_equal(throws.slip[1], v + spin) and np.array_equal(throws.w3, -(v * 0 + spin))
    assert np.all(throws.theta == np.pi / 2) and throws.w1.shape == (5, 2)


def test_what_is_no_press_or_throw_is_refused_by_name_and_nan_in_an_array():
    with pytest.raises(ValueError, match=r"impulse = -1\.0: expected 0 <= impulse"):
        sc.pressed(PIPE, -1.0, 0.8)
    with pytest.raises(ValueError, match=r"angle = 0\.0: expected 0 < angle <= pi/2"):
        sc.pressed(PIPE, 1.0, 0.0)
    with pytest.raises(ValueError, match=r"table = NaN"):
        sc.pressed(PIPE, 1.0, 0.8, table=np.nan)
    with pytest.raises(ValueError, match=r"finger = -0\.1"):
        sc.pressed(PIPE, 1.0, 0.8, finger=-0.1)
    with pytest.raises(ValueError, match=r"ell = 0\.0: expected ell > 0: a body that can lie on two rims"):
        sc.pressed(HOOP, 1.0, 0.8)
    with pytest.raises(ValueError, match=r"velocity = inf"):
        sc.thrown(HOOP, np.inf, 0.0)
    with pytest.raises(TypeError, match="body: expected a Body, not int"):
        sc.thrown(3, 1.0, 1.0)
    with pytest.raises(TypeError, match="scale: expected a Scale, not float"):
        sc.pressed(PIPE, 1.0, 0.8, scale=0.1)
    with pytest.raises(TypeError, match="backspin: expected real numbers"):
        sc.thrown(HOOP, 1.0, "fast")
    with pytest.raises(TypeError, match="body: expected a Body, not float"):
        sc.launch_number(1.0, sc.State(1.0, 1.0, 0.0, 1.0))
    found = sc.pressed(PIPE, np.array([-1.0, 1.0, np.nan]), 0.8)
    assert all(np.array_equal(np.isnan(x), [True, False, True]) for x in fields(found))


def test_si_is_a_matter_of_scale_only():
    size = sc.Scale(radius=0.015875, mass=0.08)
    speed, turn = np.sqrt(9.80665 * 0.015875), np.sqrt(9.80665 / 0.015875)
    for mine, known in zip(
        (sc.thrown(CAN, 0.5, 40.0, scale=size), sc.pressed(PIPE, 0.1, 0.8, table=0.3, scale=size)),
        (sc.thrown(CAN, 0.5 / speed, 40.0 / turn), sc.pressed(PIPE, 0.1 / (0.08 * speed), 0.8, table=0.3)),
        strict=True,
    ):
        assert fields(mine) == pytest.approx(fields(known), rel=1e-14)


def test_the_end_under_the_finger_rises_where_the_launch_number_says_so():
    j = np.linspace(0.5, 12.0, 40)
    state = sc.pressed(PIPE, j, 0.8)
    x = sc.launch_number(PIPE, state)
    assert np.allclose(x / j**2, x[0] / j[0] ** 2, rtol=1e-13), "it grows with the square of the impulse"
    tilting = PIPE.acceleration(sc.State(state.theta, state.w1, 0.0, state.w3), contact="smooth")
    assert np.array_equal(x > 1, tilting < 0) and 0 < np.mean(x > 1) < 1


def test_lists_and_labelled_arrays_keep_their_kind():
    xarray = pytest.importorskip("xarray")
    j = xarray.DataArray([1.0, 2.0, 4.0], dims="impulse")
    angle = xarray.DataArray([0.5, 0.8], dims="angle")
    found = sc.pressed(PIPE, j, angle)
    assert found.w1.dims == ("impulse", "angle") and found.slip[1].dims == ("impulse", "angle")
    assert np.array_equal(sc.thrown(HOOP, [1, 2], 3).slip[1], [4.0, 5.0])


@pytest.mark.parametrize("name", ["hoop", "disk", "rounded disk", "ball"])
@pytest.mark.parametrize(("v", "w"), [(2.0, 3.0), (1.0, 0.5), (0.0, 2.0), (3.0, -1.0)])
def test_a_hoop_that_is_thrown_slides_until_its_spin_is_used_up(name, v, w):
    body = {
        "hoop": sc.Body.tube(0.0, bore=1.0),
        "disk": sc.Body.solid(0.0),
        "rounded disk": sc.Body(0.0, 0.3, 0.5, fillet=0.3),
        "ball": sc.Body.ball(0.0, 0.4, 0.4),
    }[name]
    mu = 0.3
    start = body.with_centre_velocity(sc.State(np.pi / 2, 0.0, 0.0, -w), 0.0, v)
    assert start.slip[1] == pytest.approx(v + w, abs=1e-15)
    sticks = (v + w) / (mu * (1 + 1 / body.i3))
    m = sc.roll(body, start, [0.0, 0.5 * sticks, sticks, 1.01 * sticks], contact=sc.Coulomb(mu), want="pose")
    assert [phase.kind for phase in m.phases] == ["slipping", "rolling"]
    assert m.phases[1].time == pytest.approx(sticks, rel=1e-13)
    end = (v - body.i3 * w) / (1 + body.i3)
    assert m.phases[1].state.w3 == pytest.approx(end, abs=1e-13)
    distance = v * sticks - mu * sticks**2 / 2
    assert m.centre[2, 1] == pytest.approx(distance, abs=1e-12) and abs(m.centre[2, 0]) < 1e-12
    heat = body.i3 * (v + w) ** 2 / (2 * (1 + body.i3))
    assert m.dissipated[-1] == pytest.approx(heat, rel=1e-12)
    assert m.dissipated[1] == pytest.approx(heat * (1 - 0.5**2), rel=1e-12)
    assert (end < 0) == (w > v / body.i3), "it comes back"


def test_a_great_friction_stops_the_slip_at_once():
    pipe = sc.Body.tube(6.0, bore=0.8)
    start = pipe.with_centre_velocity(pipe.steady(1.5), 0.0, 1e-3)
    ends = [sc.roll(pipe, start, 20.0, contact=sc.Coulomb(mu)).phases[1].time for mu in (0.1, 0.2, 0.4)]
    assert ends[0] / ends[1] == pytest.approx(2, rel=0.02) and ends[1] / ends[2] == pytest.approx(2, rel=0.02)
