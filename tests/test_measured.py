"""Measured bodies: SI in and out of the same code."""

import copy
import dataclasses
import inspect
import math
import pathlib
import pickle
import re

import matplotlib as mpl
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

import spincyl as sc

mpl.use("agg")
import matplotlib.pyplot as plt

PVC = {"outer_diameter": 15.875e-3, "inner_diameter": 12.7e-3, "length": 95.25e-3}
TUBE = sc.measured(**PVC, mass=20e-3)
RULED = sc.measured(**PVC)  # measured with a ruler, but not weighed
START = TUBE.steady(1.4).kicked(0.05)
SECONDS = np.linspace(0.0, 0.5, 401)
ALL = ("pose", "force")
NAMES = {"Body": sc.Body, "Scale": sc.Scale, "measured": sc.measured, "nan": math.nan}


@pytest.fixture(scope="module")
def motion():
    return sc.roll(TUBE, START, SECONDS, want=ALL)


@pytest.fixture(scope="module")
def sliding():
    state = sc.State.from_si(1.3, 80.0, 0.0, 300.0, slip=(0.0, 0.5), scale=TUBE)
    return sc.roll(TUBE, state, SECONDS, contact=sc.Coulomb(0.3), want=ALL)


# Motion.


def test_the_numbers_of_a_motion_in_si_are_the_derivatives_of_one_another(motion):
    m, step = motion, motion.t[1]
    middle = slice(1, -1)

    def rate(x):
        return (x[2:] - x[:-2]) / (2 * step)

    sin, cos = np.sin(m.theta), np.cos(m.theta)
    assert rate(m.theta) == pytest.approx(-m.w[middle, 1], abs=1e-3 * np.abs(m.w[:, 1]).max())
    assert rate(m.phi) == pytest.approx((m.w[:, 0] / sin)[middle], rel=1e-3)
    spin = m.w[:, 2] - m.w[:, 0] * cos / sin
    radius = PVC["outer_diameter"] / 2
    assert np.hypot(*rate(m.contact_point).T) == pytest.approx(np.abs(spin * radius)[middle], rel=2e-2)
    fall = (m.centre[2:, 2] - 2 * m.centre[1:-1, 2] + m.centre[:-2, 2]) / step**2
    assert m.normal[middle] == pytest.approx(20e-3 * (9.80665 + fall), rel=2e-3)


def test_the_energy_of_a_measured_body_is_that_of_its_masses(motion):
    m, r, mass = motion, PVC["outer_diameter"] / 2, 20e-3
    square = mass * r**2
    e3 = Rotation.from_quat(m.orientation).as_matrix()[:, :, 2]
    cos, sin = np.cos(m.theta)[:, None], np.sin(m.theta)[:, None]
    e1 = (np.array([0.0, 0.0, 1.0]) - cos * e3) / sin
    turning = m.w[:, :1] * e1 + m.w[:, 1:2] * np.cross(e3, e1) + m.w[:, 2:] * e3
    # the contact point is at rest, so the centre has the velocity w x arm
    velocity = np.cross(turning, m.centre - np.column_stack([m.contact_point, 0 * m.t]))
    kinetic = mass * (velocity**2).sum(1) / 2
    kinetic += square * (TUBE.i1 * (m.w[:, 0] ** 2 + m.w[:, 1] ** 2) + TUBE.i3 * m.w[:, 2] ** 2) / 2
    assert m.energy == pytest.approx(kinetic + mass * 9.80665 * m.centre[:, 2], rel=1e-9)


@pytest.mark.parametrize("kind", ["rolling", "sliding"])
def test_a_motion_in_si_is_the_one_in_natural_units_times_its_scale(kind, motion, sliding):
    m = motion if kind == "rolling" else sliding
    n, scale = m.natural, TUBE.scale
    assert n.scale is None and n.natural is n and n.body == TUBE.natural and m.scale is TUBE.scale
    plain = sc.roll(TUBE.natural, m.start, SECONDS / scale.seconds(1.0), contact=m.contact, want=ALL)
    assert np.array_equal(n.theta, plain.theta) and np.array_equal(n.normal, plain.normal)
    assert np.array_equal(m.t, SECONDS[: m.t.size]) and np.array_equal(m.theta, n.theta)
    assert m.t == pytest.approx(scale.seconds(n.t))
    assert m.w == pytest.approx(n.w / scale.seconds(1.0))
    for name in ("contact_point", "centre"):
        assert getattr(m, name) == pytest.approx(scale.metres(getattr(n, name)))
    for name in ("normal", "friction"):
        assert getattr(m, name) == pytest.approx(20e-3 * 9.80665 * getattr(n, name))
    assert m.energy == pytest.approx(scale.joules(n.energy))
    for name in ("phi", "psi", "orientation", "friction_coefficient"):
        assert np.array_equal(getattr(m, name), getattr(n, name))
    assert np.array_equal(m.states.w1, n.states.w1) and m.start is n.start
    assert m.error >= n.error and m.pose_error == n.pose_error


def test_heat_and_energy_of_a_slip_are_joules_and_phases_begin_at_seconds(sliding):
    m, n = sliding, sliding.natural
    assert [phase.kind for phase in m.phases] == [phase.kind for phase in n.phases] and len(m.phases) > 1
    assert m.phases[1].time == pytest.approx(TUBE.scale.seconds(n.phases[1].time))
    assert m.phases[1].state == n.phases[1].state
    assert f"from t = {m.phases[1].time:.6g} s" in m.message
    assert m.slip[0] == pytest.approx([0.0, 0.5]) and m.phase.dtype == np.uint8
    total = m.energy + m.dissipated
    assert total == pytest.approx(total[0], rel=1e-9) and m.dissipated[-1] > 0


def test_an_event_is_at_seconds_and_the_motion_says_so():
    falls = sc.State(1.0, 0.0, 0.0, 0.0)
    m = sc.roll(TUBE, falls, 1.0)
    plain = sc.roll(TUBE.natural, falls, 100.0)
    assert m.event.time == pytest.approx(TUBE.scale.seconds(plain.event.time))
    assert m.event.state == plain.event.state and f"at t = {m.event.time:.12g} s" in m.message


def test_losses_take_joules():
    law = sc.loss.DryContour.from_si(5e-5, scale=TUBE)
    assert law == sc.loss.DryContour.from_si(5e-5, scale=TUBE.scale)
    m = sc.roll(TUBE, START, SECONDS, losses=law)
    assert m.energy + m.work_lost == pytest.approx(m.energy[0], rel=1e-9) and m.work_lost[-1] > 0
    assert m.work_lost == pytest.approx(TUBE.scale.joules(m.natural.work_lost))


def test_a_wet_table_has_its_unit():
    """mu = c u is a number, so that c is in s/m."""
    wet = sc.Viscous.from_si(2.0, scale=TUBE)
    assert (
        wet
        == sc.Viscous.from_si("2s/m", scale=TUBE.scale)
        == sc.Viscous(2.0 * TUBE.scale.metres_per_second(1.0))
    )
    slides = sc.State.from_si(1.3, 80.0, 0.0, 300.0, slip=(0.0, 0.5), scale=TUBE)
    m = sc.roll(TUBE, slides, SECONDS, contact=wet, want="force")
    assert m.friction_coefficient[0] == pytest.approx(2.0 * 0.5)
    same = sc.sweep.roll(TUBE, slides, SECONDS[-1], contact=wet, want="dissipated").dissipated
    assert float(same) == pytest.approx(m.dissipated[-1])
    stone = sc.Ellipsoid.rattleback((0.20, 0.03, 0.02), twist=0.05).in_metres()
    for bare in (
        lambda: sc.roll(TUBE, slides, SECONDS, contact=sc.Viscous(2.0)),
        lambda: sc.sweep.roll(TUBE, slides, 1.0, contact=sc.Viscous(2.0)),
        lambda: sc.play(TUBE, contact=sc.Viscous(2.0)),
        lambda: setattr(sc.play(TUBE), "contact", sc.Viscous(2.0)),
        lambda: sc.roll(stone, stone.spinning(-5.0), 1.0, contact=sc.Viscous(2.0)),
    ):
        with pytest.raises(ValueError, match=r"contact = Viscous\(2.0\): expected SI for a measured body"):
            bare()
    with pytest.raises(ValueError, match="c: '2m/s': expected a friction over speed"):
        sc.Viscous.from_si("2m/s", scale=TUBE)
    played = sc.play(TUBE, 1.3, kick=0.1, contact=sc.Viscous.from_si(0.1, scale=TUBE))
    assert played.contact.c == pytest.approx(0.1 * TUBE.scale.metres_per_second(1.0)) and played.motion


def test_a_method_of_the_body_and_the_function_are_one(motion):
    same = TUBE.roll(START, SECONDS, want=ALL)
    assert np.array_equal(same.normal, motion.normal) and repr(same) == repr(motion)
    plain = sc.Body.solid(2.5)
    assert plain.roll(plain.steady(1.3), 2.0).t.tolist() == [2.0]


def test_other_times_and_more_of_it_are_in_seconds_too(motion):
    few = sc.roll(TUBE, START, SECONDS)
    there = few.at([0.1, 0.2])
    assert there.t.tolist() == [0.1, 0.2] and there.scale == TUBE.scale
    assert there.theta == pytest.approx(np.interp([0.1, 0.2], motion.t, motion.theta), abs=1e-3)
    assert few.wanting("force").normal == pytest.approx(motion.normal, rel=1e-9) and few.wanting() is few
    assert few.at(0.3).t.tolist() == [0.3]


def test_steps_are_seconds_and_so_is_the_advice():
    second = TUBE.scale.seconds(1.0)
    m = sc.roll(TUBE, START, 0.5, step=1e-4)
    plain = sc.roll(TUBE.natural, START, 0.5 / second, step=1e-4 / second)
    assert np.array_equal(m.theta, plain.theta) and m.rk4.advice == pytest.approx(plain.rk4.advice * second)
    assert "step 0.0001 s" in m.message
    coarse = 2.0 * plain.rk4.advice * second
    with pytest.warns(sc.StepWarning, match=f"^step = {coarse!r}: .*; give step={m.rk4.advice:.2e}"):
        sc.roll(TUBE, START, 0.5, step=coarse)
    with pytest.raises(
        ValueError, match=r"^step = 0\.1 s is too large at t = 0 s, .*: use a step of 0\.00566 s"
    ):
        sc.roll(TUBE, START, 0.5, step=0.1)
    assert sc.roll(TUBE, START, [0.3], t0=0.1).theta == pytest.approx(sc.roll(TUBE, START, 0.2).theta)


def test_a_swing_is_told_in_seconds_and_metres():
    plain, found = sc.swing(TUBE.natural, START), sc.swing(TUBE, START)
    assert found.period == pytest.approx(TUBE.scale.seconds(plain.period)) and plain.scale is None
    assert found.nutation == pytest.approx(plain.nutation / TUBE.scale.seconds(1.0))
    for name in ("drift", "drift_radius"):
        assert getattr(found, name) == pytest.approx(TUBE.scale.metres(getattr(plain, name)))
    assert found.scale == TUBE.scale
    again = sc.roll(TUBE, START, [0.0, found.period])
    assert again.theta[1] == pytest.approx(again.theta[0], abs=1e-9)


@pytest.mark.parametrize("centre", ["rest", "rolling"])
def test_a_drift_is_told_in_seconds(centre):
    disk = sc.measured(outer_diameter=75.1e-3, length=12.8e-3, mass=0.44)
    second, law = disk.scale.seconds(1.0), sc.loss.ViscousContour.from_si(1e-5, scale=disk)
    found, plain = sc.drift(disk, 0.3, law, centre=centre), sc.drift(disk.natural, 0.3, law, centre=centre)
    assert found.stops_at == pytest.approx(second * plain.stops_at)
    t = np.array([0.1, 0.5]) * found.stops_at
    assert found.theta(t) == pytest.approx(plain.theta(t / second)) and found.time(0.2) > 0
    assert found.theta(found.time(0.2)) == pytest.approx(0.2)
    assert found.precession(t) == pytest.approx(plain.precession(t / second) / second)
    assert found.state(t[0]).w1 == pytest.approx(plain.state(t[0] / second).w1)
    assert found.stable_until == pytest.approx(second * plain.stable_until)
    with pytest.raises(ValueError, match=f"^t = 99.0: expected 0 <= t <= stops_at = {found.stops_at!r}"):
        found.theta(99.0)


@pytest.mark.parametrize("radius", [1e-3, 1.0, 1e3, 1e12])
def test_the_error_of_a_motion_covers_slips_and_times_in_si_too(radius):
    body = sc.Body.tube(6.0, bore=0.8)
    state = body.with_centre_velocity(body.steady(1.5), 0.0, 0.05)
    sized, table = dataclasses.replace(body, scale=sc.Scale(radius)), sc.Coulomb(0.3)
    t = np.linspace(0.0, sized.scale.seconds(20.0), 9)
    fine, rough = (sc.roll(sized, state, t, contact=table, tol=tol) for tol in (1e-11, 1e-6))
    claimed = fine.error + rough.error
    assert np.abs(fine.slip - rough.slip).max() <= claimed
    assert abs(fine.phases[1].time - rough.phases[1].time) <= claimed
    many, natural = (
        sc.sweep.roll(of, state, times, contact=table, tol=1e-6)
        for of, times in ((sized, t), (body, np.linspace(0.0, 20.0, 9)))
    )
    alone = sc.roll(body, state, np.linspace(0.0, 20.0, 9), contact=table, tol=1e-6)
    assert float(many["error"] / natural["error"]) == pytest.approx(rough.error / alone.error, rel=0.05)


# An unknown mass.


def test_forces_and_energies_of_a_body_that_was_not_weighed_are_refused_and_nothing_else():
    m = sc.roll(RULED, START, SECONDS, want=ALL)
    for name in ("normal", "friction", "energy"):
        with pytest.raises(AttributeError, match=f"^{name} in [NJ] needs the mass .*natural.{name}"):
            getattr(m, name)
        assert getattr(m.natural, name).size == m.t.size
    assert m.friction_coefficient.size == m.contact_point.shape[0] == SECONDS.size
    for refused in (
        lambda: RULED.scale.joules(1.0),
        lambda: RULED.scale.newtons(1.0),
        lambda: sc.pressed(RULED, 0.1, 0.8),
        lambda: sc.scene(m),
        lambda: sc.loss.AirFilm.from_si(scale=RULED),
    ):
        with pytest.raises(ValueError, match="needs the mass"):
            refused()
    units = m.to_dataframe().attrs["units"]
    assert units["normal"] == "M g" and units["energy"] == "M g R" and units["centre_x"] == "m"


# Tables and figures.


def test_tables_are_in_si_with_units(motion, sliding):
    for m in (motion, sliding):
        frame, data = m.to_dataframe(), m.to_xarray()
        assert np.array_equal(frame.index, m.t) and np.array_equal(frame["normal"], m.normal)
        assert np.array_equal(frame["w3"], m.w[:, 2]) and np.array_equal(frame["energy"], m.energy)
        assert np.array_equal(data["centre"], m.centre) and data["centre"].attrs["units"] == "m"
        assert frame.attrs["units"]["t"] == data["t"].attrs["units"] == "s"
        assert frame.attrs["units"]["normal"] == "N" and data.attrs["mass"] == 20e-3
        assert set(frame.attrs["units"]) == {"t", *frame.columns}
    assert data["slip"].attrs["units"] == "m/s" and data["dissipated"].attrs["units"] == "J"
    assert " s" in data.attrs["phases"]
    natural = motion.natural
    assert natural.to_dataframe().attrs["units"]["normal"] == natural.to_xarray()["normal"].attrs["units"]
    assert natural.to_dataframe().index[-1] == natural.t[-1]


def test_a_picture_is_in_seconds_millimetres_and_newtons(sliding):
    for m in (sliding, sc.roll(TUBE, START, 0.5), sc.roll(RULED, START, 0.5)):
        tilt, path, force = sc.plot.motion(m)
        assert tilt.get_xlabel() == "time  $t$ (s)" and path.get_xlabel() == "$x$ (mm)"
        assert tilt.get_xlim()[1] == pytest.approx(0.5, rel=0.1)
        assert np.abs(path.dataLim.get_points()).max() < 500
        ends = [patch.get_x() + patch.get_width() for patch in (*tilt.patches, *force.patches)]
        assert bool(ends) == (m is sliding) and max(ends, default=0.0) <= 0.5 + 1e-9
        weighed = m.body is TUBE
        assert force.get_ylabel() == ("force (N)" if weighed else "force ($Mg$)")
        level = 20e-3 * 9.80665 if weighed else 1.0
        assert any(np.allclose(line.get_ydata(), level) for line in force.lines)
        plain = sc.plot.motion(m.natural)
        assert plain[0].get_xlabel() == r"time  $t$ ($\sqrt{R/g}$)" and plain[1].get_xlabel() == "$x$ ($R$)"
        plt.close("all")
    falls = sc.roll(TUBE, sc.State(1.0, 0.0, 0.0, 0.0), 1.0)
    assert f"$t = {falls.event.time:.4g}$ s" in sc.plot.motion(falls)[0].get_title()
    plt.close("all")


# Functions with `scale` take it from the body.


def test_everything_that_takes_a_scale_takes_it_from_the_body(tmp_path, motion):
    scale, n = TUBE.scale, motion.natural
    assert sc.view(motion).html == sc.view(n, scale=scale).html == sc.view(n, scale=TUBE).html
    small = {"size": 40, "samples": 2e4}
    own = sc.exposure(motion, 0.1, **small)
    assert np.array_equal(own, sc.exposure(n, 0.1, scale=scale, **small))
    wide = sc.exposure(n, 0.1, scale=scale, width=10.0, **small)
    assert np.allclose(sc.exposure(motion, 0.1, width=10.0 * scale.radius, **small), wide)
    sounds = motion.sound(tmp_path / "a.wav", 0.2), n.sound(tmp_path / "b.wav", 0.2, scale=scale)
    assert sounds[0].read_bytes() == sounds[1].read_bytes()
    assert sc.scene(motion).data == sc.scene(n, scale=scale).data
    assert sc.thrown(TUBE, 1.0, 30.0) == sc.thrown(TUBE.natural, 1.0, 30.0, scale=scale)
    assert sc.pressed(TUBE, 0.1, 0.8) == sc.pressed(TUBE.natural, 0.1, 0.8, scale=scale)
    film = sc.data.example("tube_from_above")
    assert sc.data.from_above(film, TUBE).rate == sc.data.from_above(film, TUBE.natural, scale=scale).rate
    ax = sc.plot.exposure(motion, 0.1, **small)
    assert ax.get_xlabel() == "$x$ (mm)" and ax.get_xlim()[1] < 500 and ax.get_xlim()[1] > 1
    plt.close("all")


def test_a_contradiction_between_a_scale_and_a_measured_body_is_refused(tmp_path, motion):
    other = sc.Scale(0.01, 20e-3)
    message = r"^scale = Scale\(radius=0.01, .*: the measured body has another"
    for refused in (
        lambda: sc.view(motion, scale=other),
        lambda: sc.exposure(motion, 0.1, scale=other),
        lambda: motion.sound(tmp_path / "a.wav", scale=other),
        lambda: sc.scene(motion, scale=other),
        lambda: sc.data.from_above(sc.data.example("tube_from_above"), TUBE, scale=other),
        lambda: sc.thrown(TUBE, 1.0, 1.0, scale=other),
        lambda: sc.pressed(TUBE, 1.0, 1.0, scale=other),
    ):
        with pytest.raises(ValueError, match=message):
            refused()
    same = sc.Scale(PVC["outer_diameter"] / 2, 20e-3)
    assert sc.thrown(TUBE, 1.0, 1.0, scale=same) == sc.thrown(TUBE, 1.0, 1.0)
    for one, two in ((motion, motion.natural), (motion, sc.roll(RULED, START, 0.5))):
        with pytest.raises(ValueError, match="^scale: the bodies have different scales"):
            sc.view(one, two)
    assert sc.view(motion, motion.natural, scale=TUBE.scale).scale == TUBE.scale


def test_a_body_without_a_size_says_how_it_gets_one(motion, tmp_path):
    body = sc.Body.solid(2.5)
    assert body.scale is None and body.natural is body and not hasattr(body, "critical_hertz")
    for what in (lambda: body.critical_hertz, lambda: body.hertz(1.3), lambda: body.inclinations(hertz=7.0)):
        with pytest.raises(AttributeError, match=r"hertz: needs a measured body, as sc.measured\("):
            what()
    with pytest.raises(TypeError, match="^scale: expected a Scale, .* a measured body has its own"):
        motion.natural.sound(tmp_path / "a.wav")
    with pytest.raises(TypeError, match="^scale: expected a Scale, not Body without a scale"):
        sc.loss.DryContour.from_si(1e-5, scale=body)
    with pytest.raises(TypeError, match="^scale: expected a Scale or a measured body, not None"):
        sc.State.from_si(1.0, 1.0, 0.0, 0.0, scale=None)
    with pytest.raises(TypeError, match="^rate, hertz: give exactly one"):
        TUBE.inclinations(1.0, hertz=1.0)
    with pytest.raises(
        TypeError, match="^rate, hertz: give exactly one of them; hertz= needs a measured body"
    ):
        TUBE.inclinations()
    with pytest.raises(TypeError, match="^scale: expected a Scale, not float"):
        dataclasses.replace(body, scale=0.01)


def test_any_body_can_be_given_a_size():
    balls = dataclasses.replace(sc.Body.balls(), scale=sc.Scale(radius=6e-3, mass=14e-3))
    assert balls.critical_hertz == pytest.approx(math.sqrt(9.80665 / 6e-3 / 0.4) / (2 * math.pi))
    assert sc.roll(balls, balls.steady(1.2), 0.1).t[-1] == 0.1
    family = dataclasses.replace(sc.Body.solid([1.0, 2.5]), scale=sc.Scale(0.01))
    assert family.hertz(1.3).shape == family.critical_hertz.shape == (2,)
    with pytest.raises(ValueError, match="^body: expected a single body"):
        sc.roll(family, family.steady(1.3), 1.0)


# States.


def test_a_state_from_si_is_the_natural_one_over_its_units():
    state = sc.State.from_si(1.3, 50.0, -2.0, [300.0, 310.0], slip=(0.1, 0.2), scale=TUBE)
    per = TUBE.scale.seconds(1.0)
    assert (state.w1, state.w2) == (50.0 * per, -2.0 * per)
    assert state.w3 == pytest.approx(np.array([300.0, 310.0]) * per)
    assert TUBE.scale.metres_per_second(state.slip[1]) == pytest.approx(0.2)
    assert sc.State.from_si(1.3, 50.0, 0.0, 1.0, scale=TUBE.scale).slip is None
    with pytest.raises(TypeError, match="^slip: expected a pair"):
        sc.State.from_si(1.3, 50.0, 0.0, 1.0, slip=2.0, scale=TUBE)


# repr, equality, pickle and copies.


@pytest.mark.parametrize(
    "body",
    [TUBE, RULED, sc.measured(outer_diameter=24e-3, length=1.75e-3, mass=7.5e-3, fillet=2e-4, gravity=1.62),
     dataclasses.replace(TUBE, theta_end=1.5)],
    ids=["tube", "not weighed", "coin on the Moon", "with a cap"],
)  # fmt: skip
def test_what_was_measured_is_shown_copied_and_the_same_again(body):
    assert eval(repr(body), NAMES) == body and hash(eval(repr(body), NAMES)) == hash(body)
    for other in (copy.deepcopy(body), pickle.loads(pickle.dumps(body)), dataclasses.replace(body)):
        assert other == body and hash(other) == hash(body) and other.critical_hertz == body.critical_hertz
    assert body != body.natural and body.natural.scale is None and body._repr_html_()


def test_motions_in_si_can_be_copied_and_show_themselves(motion):
    for other in (copy.deepcopy(motion), pickle.loads(pickle.dumps(motion))):
        assert np.array_equal(other.normal, motion.normal) and other.scale == TUBE.scale
        assert np.array_equal(other.natural.normal, motion.natural.normal)
    assert "to 0.5 s" in motion._repr_html_() and repr(motion).startswith("<Motion of measured(outer")
    assert " mm<" in sc.swing(TUBE, START)._repr_html_() and "starts with" in motion._repr_html_()
    assert "6.17777 Hz" in TUBE._repr_html_() and "none" in RULED.scale._repr_html_()


def test_a_text_with_a_unit_beside_a_bare_number_is_refused():
    same = sc.Body.from_metres(outer_diameter="16 mm", inner_diameter=0, length="96mm")
    assert same.ell == sc.Body.from_metres(outer_diameter=16, length=96).ell
    with pytest.raises(
        ValueError, match="^length = 96: expected a text with a unit; .* all lengths, or to none$"
    ):
        sc.Body.from_metres(outer_diameter="16 mm", length=96)


@pytest.mark.parametrize(
    ("text", "like"),
    [
        ("1,5 mm", r": '1\.5 mm'"),
        ("1,5e-3m", r": '1\.5e-3m'"),
        ("-0,5mm", r": '-0\.5mm'"),
        ("1,500 mm", ""),
        ("1,5.2mm", ""),
    ],
)
def test_a_decimal_comma_is_refused_with_the_point_unless_it_may_separate_thousands(text, like):
    with pytest.raises(ValueError, match=f"^length: '{text}': write a decimal point, not a comma{like}$"):
        sc.measured(outer_diameter="16 mm", length=text)


def test_a_wall_is_half_the_difference_of_the_diameters():
    by_wall = sc.measured(outer_diameter="20mm", wall="1.5mm", length="60mm")
    assert by_wall == sc.measured(outer_diameter=0.02, inner_diameter=0.017, length=0.06)
    assert sc.measured(outer_diameter=0.02, wall=0.01, length=0.06).i1 == sc.Body.solid(3.0).i1
    for wrong in (0.0101, -1e-3, float("nan")):
        with pytest.raises(ValueError, match="^wall = "):
            sc.measured(outer_diameter=0.02, wall=wrong, length=0.06)
    for wrong in (math.nan, -0.02, 0.0, math.inf):
        with pytest.raises(ValueError, match=f"^outer_diameter = {wrong}: expected outer_diameter > 0$"):
            sc.measured(outer_diameter=wrong, wall=1.5e-3, length=0.06)
    with pytest.raises(TypeError, match="^inner_diameter, wall: give only one"):
        sc.measured(outer_diameter=0.02, inner_diameter=0.017, wall=1e-3, length=0.06)


def volume(outer_diameter, length, inner_diameter=0.0, fillet=0.0):
    """The volume of a tube with rounded outer edges, by slices across its axis."""
    r, b = outer_diameter / 2, inner_diameter / 2

    def slice_(z):
        deep = max(fillet - z, z - (length - fillet), 0.0)  # beyond the centres of the rounding
        return math.pi * ((r - fillet + math.sqrt(max(fillet**2 - deep**2, 0.0))) ** 2 - b**2)

    return quad(slice_, 0.0, length, points=[fillet, length - fillet], epsabs=0, epsrel=1e-11)[0]


@pytest.mark.parametrize(
    "size",
    [
        {"outer_diameter": 0.022, "length": 0.066},
        {"outer_diameter": 0.0254, "length": 0.003, "inner_diameter": 0.02},
        {"outer_diameter": 0.022, "length": 0.03, "fillet": 0.004},
        {"outer_diameter": 0.022, "length": 0.03, "inner_diameter": 0.01, "fillet": 0.003},
        {"outer_diameter": 0.02, "length": 0.05, "fillet": 0.01},
        {"outer_diameter": 0.02, "length": 0.02, "fillet": 0.01},
    ],
)
def test_the_mass_of_a_tube_is_its_density_times_its_volume(size):
    for given, dense in (("brass", 8500.0), (1234.5, 1234.5), ("7.85 g/cm3", 7850.0), ("Aluminum", 2700.0)):
        body = sc.measured(**size, density=given)
        assert body.scale.mass == pytest.approx(dense * volume(**size), rel=1e-10)
        assert body == sc.measured(**size, mass=body.scale.mass)


@pytest.mark.parametrize(
    ("given", "error", "why"),
    [
        (
            {"density": "wood"},
            ValueError,
            "^density = 'wood': expected 'beech' or 'birch' or .* or 'pine', or",
        ),
        (
            {"density": "walnut"},
            ValueError,
            "^density = 'walnut': expected 'beech' or 'birch' or .* or 'pine', or a number in kg/m",
        ),
        ({"density": "stel"}, ValueError, "^density = 'stel': expected 'steel'"),
        ({"density": "mithril"}, ValueError, "^density = 'mithril': expected one of 'steel', "),
        ({"density": "7.85"}, TypeError, "^density: expected real numbers, or .* '7.85g/cm3'"),
        ({"density": "7.85 kg"}, ValueError, "^density: '7.85 kg': expected a density, .* in kg/m3"),
        ({"density": -7850.0}, ValueError, "^density = -7850"),
        ({"density": 0.0}, ValueError, "^density = 0"),
        ({"density": math.nan}, ValueError, "^density = nan"),
        ({"density": [7850.0]}, TypeError, "^density: expected a number"),
        ({"density": 7850.0, "mass": 0.1}, TypeError, "^mass, density: give only one of them"),
    ],
)
def test_a_density_that_is_none_is_refused_by_its_name(given, error, why):
    with pytest.raises(error, match=why):
        sc.measured(outer_diameter=0.022, length=0.066, **given)


def test_a_body_of_known_volume_has_the_mass_of_its_density():
    egg = sc.Ellipsoid.egg("22mm", "28mm").in_metres(density="oak")
    assert egg.scale.mass == pytest.approx(706 * 4 / 3 * math.pi * 0.022**2 * 0.028, rel=1e-12)
    ball = sc.Body.ball(0.0, 0.4, 0.4).in_metres(radius="28.6mm", density="1.7g/cm3")
    assert ball.scale.mass == pytest.approx(1700 * 4 / 3 * math.pi * 0.0286**3, rel=1e-12)
    rod = sc.Body.solid(3.0).in_metres(radius="5mm", density="steel", gravity=1.62)
    assert rod.scale.mass == pytest.approx(7850 * math.pi * 0.005**3 * 6.0, rel=1e-12)
    half = sc.Ellipsoid.rattleback(("8cm", "2cm", "2cm"), twist=0.1)  # its edge cuts the ellipsoid
    for body in (half, sc.Body(0.5, 0.3, 0.5), sc.Ellipsoid.egg([1.0, 2.0], 3.0)):
        with pytest.raises(ValueError, match="^density: expected a single body whose volume is known"):
            body.in_metres(radius="1cm", density="oak")
    with pytest.raises(TypeError, match="^mass, density: give only one"):
        egg.in_metres(0.1, density="oak")


def test_a_solid_cylinder_by_its_moments_in_kg_m2_precesses_as_the_cylinder_does():
    mass, radius, half = 0.384, 0.033, 0.0594
    i1, i3 = mass * (radius**2 / 4 + half**2 / 3), mass * radius**2 / 2
    known = sc.measured(outer_diameter=2 * radius, length=2 * half, mass=mass)
    other = sc.Body(half / radius, 0.5, 0.9)  # of other moments
    for wrong in (other, sc.Body.tube(half / radius, bore=0.9)):
        body = wrong.in_metres(mass, radius=radius, i1=i1, i3=i3)
        assert body.hertz(1.2) == pytest.approx(known.hertz(1.2), rel=1e-14)
        assert math.isnan(body.bore) and body.scale == known.scale
    texts = f"{1e7 * i1} g cm^2", f"{1e9 * i3} g*mm^2"
    for body in (
        other.in_metres(mass, radius=radius, i1=texts[0], i3=texts[1]),
        sc.Body(half / radius, *texts, scale=sc.Scale(radius, mass)),
        known.in_metres(i1=f"{i1} kg m^2"),
    ):
        assert body.hertz(1.2) == pytest.approx(known.hertz(1.2), rel=1e-14)
    assert other.in_metres(mass, radius=radius, i3=i3).i1 == 0.5
    again = eval(repr(other.in_metres(mass, radius=radius, i3=i3)), {**vars(sc), "nan": math.nan})
    assert again == other.in_metres(mass, radius=radius, i3=i3)


def test_a_tippe_top_and_a_cup_take_their_moments_in_kg_m2():
    top = sc.Body.ball(-0.2, "1.2e-6 kg m^2", 0.4, diameter="30mm", mass="12g")
    assert top == sc.Body.ball(-0.2, 1.2e-6 / 0.012 / 0.015**2, 0.4, diameter="30mm", mass="12g")
    cup = sc.Body.frustum("25mm", "35mm", "90mm", wall=0.0).in_metres(
        "7g", i1="8.5e-6 kg m^2", i3="6.6e-6 kg m^2"
    )
    assert cup.i3 == pytest.approx(6.6e-6 / 0.007 / 0.035**2) and len(cup.circles) == 2
    assert cup.scale.radius == 0.035


@pytest.mark.parametrize(
    ("make", "error", "why"),
    [
        (
            lambda of: of(0.1, i3="3e-5 kg m^2"),
            ValueError,
            r"^i3 = .*<= 2 i1.*; M R\^2 is 1e-05 kg m\^2 for this body",
        ),
        (lambda of: of(0.1, i1=1e-9), ValueError, "^i1 = .*; M R.2 is 1e-05"),
        (
            lambda of: of(0.1, i3="3e-5 kg m^3"),
            ValueError,
            "^i3: '3e-5 kg m.3': expected a moment of inertia, .* kgm2",
        ),
        (lambda of: of(i3=3e-6), TypeError, "^i3 = 3e-06: a moment in kg m.2 needs radius and mass"),
        (lambda of: sc.Body(1.0, "3 kg m^2", 0.5), TypeError, "^i1 = '3 kg m.2': .* needs radius and mass"),
        (
            lambda of: sc.Body.ball(0.1, 0.4, "3 kg m^2", diameter=0.1),
            TypeError,
            "^i3 = .* needs radius and mass",
        ),
        (
            lambda of: sc.Ellipsoid.egg(1.0, 2.0).in_metres(1.0, radius=1.0, i1=0.1),
            TypeError,
            "^i1, i3: only for bodies",
        ),
        (lambda of: of(0.1, I3=3e-6), TypeError, "'I3': expected mass, .*, i1, i3"),
    ],
)
def test_a_moment_in_kg_m2_that_no_body_has_is_refused_by_its_name(make, error, why):
    with pytest.raises(error, match=why):
        make(lambda *mass, **of: sc.Body.solid(1.0).in_metres(*mass, radius=0.01, **of))


def test_moments_in_g_mm2_without_their_unit_warn():
    with pytest.warns(UserWarning, match=r"i1: 4e\+07 M R\^2, .*: is the moment in kg m\^2") as said:
        sc.Body.solid(1.0).in_metres(0.1, radius=0.01, i1=400.0, i3="4000 g mm^2")
    assert len(said) == 1


def test_a_drill_turns_in_rpm():
    egg = sc.Ellipsoid.egg("22mm", "28mm").in_metres(density="oak")
    assert egg.spinning(hertz="1500rpm") == egg.spinning(hertz=25.0)
    tube = sc.measured(outer_diameter="16mm", wall="1mm", length="95mm")
    given = [sc.State.from_si(1.3, w, 0.0, 0.0, scale=tube).w1 for w in ("60rpm", 2 * math.pi)]
    assert given[0] == pytest.approx(given[1], rel=1e-15)


def test_a_wood_at_twelve_percent_moisture_weighs_its_dry_mass_and_its_water():
    from spincyl._input.materials import MATERIALS

    woods = {
        name: float(sort.split("G = ")[1][:4]) for name, (_, sort) in MATERIALS.items() if "G = " in sort
    }
    assert {"beech", "birch", "maple", "oak", "fir"} <= set(woods)
    for name, gravity in woods.items():
        assert "12 % moisture" in MATERIALS[name][1]
        wet = sc.measured(outer_diameter="22mm", length="66mm", density=name).scale.mass
        dry = sc.measured(outer_diameter="22mm", length="66mm", density=1000 * gravity).scale.mass
        assert wet / dry - 1 == pytest.approx(0.12, abs=1e-3)


@pytest.mark.parametrize(
    ("typed", "meant"), [("Beach", "beech"), ("polycarbonat", "polycarbonate"), ("abs", "ABS")]
)
def test_a_material_is_found_in_any_case_and_a_misspelt_one_is_proposed(typed, meant):
    if typed.lower() == meant.lower():
        known = sc.measured(outer_diameter="22mm", length="66mm", density=meant)
        assert sc.measured(outer_diameter="22mm", length="66mm", density=typed) == known
        return
    with pytest.raises(ValueError, match=f"^density = '{typed}': expected .*'{meant}'"):
        sc.measured(outer_diameter="22mm", length="66mm", density=typed)


def test_a_part_of_a_material_has_its_density_and_the_page_lists_each_material():
    from spincyl._input.materials import MATERIALS

    page = (pathlib.Path(__file__).parents[1] / "docs/api.md").read_text("utf-8")
    told = inspect.getdoc(sc.measured)
    for name, (dense, sort) in MATERIALS.items():
        assert f'| "{name}" | {dense:.0f} | {sort} |' in page
        assert f'"{name}"' in re.sub(r"\s+", " ", told)
        assert sc.parts.ball(diameter="1cm", density=name) == sc.parts.ball(diameter="1cm", density=dense)
    with pytest.warns(UserWarning, match="as dense as 7.85 kg"):
        sc.measured(outer_diameter="22mm", length="66mm", density=7.85)  # g/cm^3 for kg/m^3
