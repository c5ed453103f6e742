"""Starts of thrown bodies: throws and presses, single and in arrays, in natural units and SI."""

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
    with pytest.raises(
        ValueError, match=r"ell = 0\.0: expected ell > 0, for a body that can lie on two rims"
    ):
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
        sc.launch_number(1.0, sc.State(np.pi / 2, 1.0, 0.0, 1.0))
    for theta, w2 in ((1.5, 0.0), (np.pi / 2, 0.1)):
        with pytest.raises(ValueError, match="^state = State.*: expected a body on its side"):
            sc.launch_number(PIPE, sc.State(theta, 1.0, w2, 1.0))
    several = sc.launch_number(PIPE, sc.State([1.5, np.pi / 2], 1.0, 0.0, 1.0))
    assert np.isnan(several).tolist() == [True, False]
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


# Flicks given by their rates.

PVC = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm")


def test_a_flick_by_its_rates_has_them_its_launch_number_and_the_recoil():
    start = sc.flicked(PVC, hertz=17, launch=1.3)
    assert PVC.scale.turns(start.w1) == pytest.approx(17) and start.w2 == 0 and start.theta == np.pi / 2
    assert sc.launch_number(PVC, start) == pytest.approx(1.3)
    assert PVC.centre_velocity(start)[1] == pytest.approx(-PVC.i1 / PVC.ell * start.w1)
    spin = PVC.scale.turns(start.w3)
    assert sc.flicked(PVC, hertz="17Hz", spin_hertz=spin).w3 == pytest.approx(start.w3)
    assert sc.flicked(PVC.natural, w1=start.w1, launch=1.3).slip == pytest.approx(start.slip)
    assert sc.flicked(PVC.natural, hertz=17, launch=1.3, scale=PVC.scale) == start
    moving = sc.flicked(PVC, hertz=17, launch=1.3, centre="-50cm/s")
    assert PVC.centre_velocity(moving)[1] * PVC.scale.metres_per_second(1.0) == pytest.approx(-0.5)
    many = sc.flicked(PVC, hertz=np.array([[10.0], [17.0]]), launch=[1.2, 1.3])
    assert many.w3.shape == (2, 2) and many.w3[1, 1] == pytest.approx(start.w3)


def test_a_finger_that_leaves_at_the_same_rates_has_flicked():
    pressed = sc.pressed(PVC.natural, 9.0, 0.8)
    flicked = sc.flicked(PVC.natural, w1=pressed.w1, launch=sc.launch_number(PVC, pressed))
    assert flicked.w3 == pytest.approx(pressed.w3) and flicked.slip == pytest.approx(pressed.slip)


@pytest.mark.parametrize(
    ("how", "error", "why"),
    [
        ({"hertz": 17}, TypeError, "^hertz, w1, launch, spin_hertz: give exactly one"),
        (
            {"hertz": 17, "w1": 3.0, "launch": 1.3},
            TypeError,
            "^hertz, w1, launch, spin_hertz: give exactly one",
        ),
        (
            {"w1": 3.0, "launch": 1.3, "spin_hertz": 3.0},
            TypeError,
            "^hertz, w1, launch, spin_hertz: give exactly one",
        ),
        ({"w1": 0.0, "launch": 1.3}, ValueError, "^launch: needs a w1 or hertz other than 0"),
        ({"hertz": "17mm", "launch": 1.3}, ValueError, "^hertz: '17mm': expected a frequency"),
        ({"w1": "x", "launch": 1.3}, TypeError, "^w1: expected real numbers"),
    ],
)
def test_a_flick_that_is_none_is_refused_by_name(how, error, why):
    with pytest.raises(error, match=why):
        sc.flicked(PVC, **how)


def test_a_flick_needs_two_rims_and_hertz_a_size():
    with pytest.raises(ValueError, match=r"^ell = 0.0: expected a body with two rims"):
        sc.flicked(sc.Body.solid(0.0), w1=1.0, launch=1.3)
    with pytest.raises(ValueError, match="^hertz: needs a measured body"):
        sc.flicked(PVC.natural, hertz=1.0, launch=1.3)
    with pytest.raises(ValueError, match="^spin_hertz: needs a measured body"):
        sc.flicked(PVC.natural, w1=1.0, spin_hertz=1.3)


def test_many_flicks_settle_lie_down_or_lift_off_as_each_does():
    words = {sc.Ending.DONE: "SETTLES", sc.Ending.SIDE: "LIES_DOWN", sc.Ending.LIFT_OFF: "LIFTS_OFF"}
    rates, numbers, table = [8.0, 17.0, 25.0], [0.9, 1.3, 1.8, 2.9], sc.Coulomb(0.3)
    found = sc.sweep.flicks(PVC, 5.0, hertz=rates, launch=numbers, contact=table)
    assert found["outcome"].dims == ("hertz", "launch") and found["hertz"].attrs["units"] == "Hz"
    seen = set()
    for hertz in rates:
        for launch in numbers:
            m = sc.roll(PVC, sc.flicked(PVC, hertz=hertz, launch=launch), 5.0, contact=table)
            one = found.sel(hertz=hertz, launch=launch)
            assert sc.sweep.Outcome(int(one["outcome"])).name == words[m.status], (hertz, launch)
            seen.add(words[m.status])
            if m.status == sc.Ending.DONE:
                assert float(one["rolling_time"]) == pytest.approx(m.phases[-1].time, rel=1e-6)
    assert seen == set(words.values())
    natural = sc.sweep.flicks(PVC.natural, 200.0, w1=[1.0], launch=1.2, contact=table, want="final")
    assert natural["outcome"].dims == ("precession",) and "theta" in natural
    with pytest.raises(TypeError, match="^contact: expected a Coulomb"):
        sc.sweep.flicks(PVC, 5.0, hertz=rates, launch=numbers, contact="rolling")


def test_flicks_by_turns_about_both_axes_are_those_of_their_launch_numbers():
    rates, spins, table = [8.0, 17.0], [6.0, 20.0], sc.Coulomb(0.3)
    found = sc.sweep.flicks(PVC, 5.0, hertz=rates, spin_hertz=spins, contact=table)
    assert found["outcome"].dims == ("hertz", "spin_hertz") and found["spin_hertz"].attrs["units"] == "Hz"
    for hertz in rates:
        for spin in spins:
            start = sc.flicked(PVC, hertz=hertz, spin_hertz=spin)
            launch = float(sc.launch_number(PVC, start))
            one = sc.sweep.flicks(PVC, 5.0, hertz=hertz, launch=launch, contact=table)
            assert int(one["outcome"]) == int(found["outcome"].sel(hertz=hertz, spin_hertz=spin))
    with pytest.raises(TypeError, match="^hertz, w1, launch, spin_hertz: give exactly one"):
        sc.sweep.flicks(PVC, 5.0, hertz=rates, launch=1.2, spin_hertz=spins, contact=table)
