"""Measured bodies: rates, texts with units, and implausible measures."""

import math
import warnings

import numpy as np
import pytest

import spincyl as sc

PVC = {"outer_diameter": 15.875e-3, "inner_diameter": 12.7e-3, "length": 95.25e-3}
TUBE = sc.measured(**PVC, mass=20e-3)
RULED = sc.measured(**PVC)  # measured with a ruler, but not weighed
START = TUBE.steady(1.4).kicked(0.05)


# Rates.


def test_the_critical_rate_of_a_tube_in_hertz_takes_its_measures_and_nothing_else():
    # Jackson et al.: Omega^2 = g/(R I3) with I3 = (1 + bore^2)/2
    r, bore = PVC["outer_diameter"] / 2, PVC["inner_diameter"] / PVC["outer_diameter"]
    expected = math.sqrt(9.80665 / (r * (1 + bore**2) / 2)) / (2 * math.pi)
    assert TUBE.critical_hertz == pytest.approx(expected, rel=1e-14) == RULED.critical_hertz
    assert TUBE.critical_hertz == TUBE.scale.hertz(TUBE, 1.0)


def test_a_tube_turns_faster_on_jupiter_and_slower_if_it_is_larger():
    large = sc.measured(**{name: 4 * x for name, x in PVC.items()})
    assert large.critical_hertz == pytest.approx(TUBE.critical_hertz / 2)
    assert sc.measured(**PVC, gravity=4 * 9.80665).critical_hertz == pytest.approx(2 * TUBE.critical_hertz)


def test_inclinations_are_found_from_hertz_and_have_these():
    theta = TUBE.inclinations(hertz=7.29)
    assert np.array_equal(theta, TUBE.inclinations(rate=7.29 / TUBE.critical_hertz), equal_nan=True)
    assert TUBE.hertz(theta[:2]) == pytest.approx(7.29)
    states = TUBE.states(hertz=7.29)
    assert TUBE.hertz(states)[:2] == pytest.approx(7.29)
    assert TUBE.inclinations(hertz=[5.0, 7.0]).shape == (2, 3)


def test_a_bare_rate_of_a_measured_body_is_none():
    for ask in (TUBE.inclinations, TUBE.states, TUBE.count):
        with pytest.raises(TypeError, match="^rate: for a measured body write hertz=... or rate="):
            ask(9.0)
        for given in ({}, {"rate": 1.0, "hertz": 1.0}):
            with pytest.raises(TypeError, match="^rate, hertz: give exactly one of them"):
                ask(**given)
    assert TUBE.count(rate=1.2) == TUBE.natural.count(1.2) == TUBE.natural.count(rate=1.2) == 2
    assert TUBE.count(hertz=1.2 * TUBE.critical_hertz) == 2


def test_a_text_with_its_unit_is_what_the_command_line_reads():
    told = sc.measured(outer_diameter="15.875mm", inner_diameter="0.5in", length="95.25 mm", mass="20g")
    assert told == TUBE and told.scale == TUBE.scale
    assert TUBE.inclinations(hertz="7.29Hz")[1] == TUBE.inclinations(hertz=7.29)[1]
    assert TUBE.steady("85deg") == TUBE.steady(math.radians(85)) == TUBE.steady("85°")
    assert sc.roll(TUBE, START, "200ms").t[0] == 0.2
    assert sc.pressed(TUBE, "60mNs", "75deg") == sc.pressed(TUBE, 0.06, math.radians(75))
    law = sc.loss.RollingResistance
    assert law.from_si("0.1mm", scale=TUBE) == law.from_si(1e-4, scale=TUBE)
    start = sc.State.from_si("85deg", "17Hz", 0.0, 10.0, slip=("5cm/s", 0.0), scale=TUBE)
    assert start == sc.State.from_si(
        math.radians(85), 2 * math.pi * 17, 0.0, 10.0, slip=(0.05, 0.0), scale=TUBE
    )
    for turning in ("14rad/s", f"{14 / (2 * math.pi)!r}Hz"):
        thrown = sc.thrown(TUBE, "3m/s", turning)
        assert thrown.w3 == pytest.approx(sc.thrown(TUBE, 3.0, 14.0).w3, rel=1e-15)
    assert TUBE.inclinations(hertz="40rad/s") == pytest.approx(
        TUBE.inclinations(hertz=20 / np.pi), nan_ok=True
    )
    sinking = sc.drift(sc.Body.solid(0.17), "17deg", law(1e-3))
    assert sinking.time("10deg") == sinking.time(math.radians(10))
    assert sc.play(TUBE, "85deg").theta == math.radians(85)
    with pytest.raises(TypeError, match="^rate: expected real numbers, not texts; .* in natural units"):
        TUBE.inclinations(rate="40rad/s")
    with pytest.raises(ValueError, match="^length: '3ft': expected a length, without unit or in m, cm"):
        sc.measured(outer_diameter=0.1, length="3ft")
    for bad in ("95", "mm", ""):
        with pytest.raises(TypeError, match="^length: expected real numbers, or a text with a unit"):
            sc.measured(outer_diameter=0.01, length=bad)
    with pytest.raises(TypeError, match="^theta: expected real numbers"):
        TUBE.steady("85")


def test_balls_are_measured_by_the_diameter_of_one_and_the_mass_of_both():
    balls = sc.Body.balls(diameter="25.4mm", mass=0.13)
    assert balls.scale == sc.Scale(12.7e-3, 0.13) and balls.natural == sc.Body.balls()
    assert eval(repr(balls), {"Body": sc.Body, "Scale": sc.Scale, "nan": math.nan}) == balls
    # two touching solid balls, about the line of their centres: I3 = 2/5 M R^2
    rate = math.sqrt(9.80665 / (12.7e-3 * 0.4)) / (2 * math.pi)
    assert balls.critical_hertz == pytest.approx(rate)
    with pytest.warns(UserWarning, match="pair of balls is 50 m long and 25 m wide; 1 mm is 1e-3"):
        sc.Body.balls(diameter=25.0)
    with pytest.warns(UserWarning, match="are these metres and kilograms"):
        sc.Body.balls(diameter=0.0254, mass=130.0)
    with pytest.raises(ValueError, match="^mass = .*: give the diameter of the balls"):
        sc.Body.balls(mass=0.13)
    with pytest.raises(ValueError, match="^diameter = -1.0"):
        sc.Body.balls(diameter=-1.0)


def test_a_coefficient_without_a_unit_is_refused_of_a_measured_body():
    bare, told = sc.loss.RollingResistance(1e-4), sc.loss.RollingResistance.from_si(1e-4, scale=TUBE)
    asked = (
        lambda law: sc.roll(TUBE, START, 0.1, losses=law),
        lambda law: sc.drift(TUBE, 1.4, law),
        lambda law: sc.sweep.roll(TUBE, START, 0.1, losses=law),
        lambda law: sc.play(TUBE, losses=law),
    )
    for ask in asked:
        with pytest.raises(ValueError, match=r"^losses = .*RollingResistance.from_si\(..., scale=body\)"):
            ask(bare)
        ask(told)
        if ask is not asked[-1]:  # the live page supports one law only
            ask(told + sc.loss.DryContour.from_si("0.01mm", scale=TUBE) + told)
            with pytest.raises(ValueError, match="^losses = "):
                ask(told + bare)
    m = sc.roll(TUBE, START, 0.1, losses=told)
    assert m.at([0.05, 0.1]).work_lost[1] > 0
    page = sc.play(TUBE, losses=told)
    page.losses = page.losses  # losses read from a page already have their units
    assert page.motion.work_lost[-1] > 0


def test_a_mass_that_is_missing_is_asked_for_by_what_needs_it():
    with pytest.raises(ValueError, match="^an impulse in SI needs the mass"):
        sc.pressed(RULED, "60mNs", "75deg")
    with pytest.raises(ValueError, match="^the coefficient of this loss law in SI needs the mass"):
        sc.loss.AirFilm.from_si(scale=RULED)


# Invalid arguments.


@pytest.mark.parametrize(
    ("wrong", "error", "message"),
    [
        ({"length": -0.1}, ValueError, "^length = -0.1: expected length >= 0"),
        ({"length": math.nan}, ValueError, "^length = NaN"),
        ({"outer_diameter": 0.0}, ValueError, "^outer_diameter = 0.0: expected outer_diameter > 0"),
        ({"inner_diameter": 0.02}, ValueError, "^inner_diameter = 0.02: expected 0 <= inner_diameter <="),
        ({"inner_diameter": -1e-3}, ValueError, "^inner_diameter = -0.001"),
        ({"fillet": 0.1}, ValueError, "^fillet = 0.1"),
        ({"mass": 0.0}, ValueError, "^mass = 0.0: expected 1e-100 <= mass"),
        ({"mass": -1.0}, ValueError, "^mass = -1.0"),
        ({"mass": math.nan}, ValueError, "^mass = nan: expected kilograms, or no mass="),
        ({"gravity": math.inf}, ValueError, "^gravity = inf"),
        (
            {"outer_diameter": [0.1, 0.2]},
            TypeError,
            r"^outer_diameter: expected a number, not an array of shape",
        ),
        ({"length": "95"}, TypeError, "^length: expected real numbers"),
        ({"mass": "20 stone"}, ValueError, "^mass: .*expected a mass"),
    ],
)
def test_what_is_no_tube_is_refused_by_name(wrong, error, message):
    with pytest.raises(error, match=message):
        sc.measured(**{**PVC, "mass": 0.02, **wrong})


@pytest.mark.parametrize(
    ("unit", "mass", "message"),
    [
        (1e3, None, "95.25 m long and 15.88 m wide"),
        (1e3, 20e-3, "95.25 m long"),
        (1e2, 20e-3, "9.525 m long"),
        (1.0, 20.0, r"2.95e\+06 kg/m\^3"),
        (1.0, 1e-6, r"0.147 kg/m\^3"),
        (1e-3, None, "1.58[78]e-05 m wide"),
    ],
    ids=["mm", "mm and kg", "cm", "g", "mg", "km"],
)
def test_millimetres_and_grams_taken_for_metres_and_kilograms_are_warned_of(unit, mass, message):
    with pytest.warns(UserWarning, match=f"^the tube is .*{message}.*: are these metres and kilograms"):
        sc.measured(**{name: unit * x for name, x in PVC.items()}, mass=mass)


@pytest.mark.parametrize(
    ("outer", "inner", "length", "mass"),
    [
        (0.0751, 0.0, 0.0128, 0.44),  # Euler's disk
        (24.26e-3, 0.0, 1.75e-3, 5.67e-3),  # a quarter dollar
        (0.8, 0.8, 0.0, 0.3),  # a hoop of zero thickness
        (0.066, 0.0658, 0.115, 0.013),  # a can
        (2.0, 1.8, 3.0, 5000.0),  # a concrete pipe
        (5e-3, 0.0, 0.2, 7e-5),  # a rod of foam
    ],
)
def test_real_things_are_not_warned_of(outer, inner, length, mass):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        real = sc.measured(outer_diameter=outer, inner_diameter=inner, length=length, mass=mass)
        assert real.critical_hertz > 0


def test_a_coefficient_that_was_made_for_another_body_is_refused():
    coin = sc.measured(outer_diameter="24mm", length="2mm", mass="7.5g")
    theirs = sc.loss.RollingResistance.from_si("0.02mm", scale=TUBE)
    wet = sc.Viscous.from_si(1.0, scale=TUBE)
    start = coin.steady("30deg")
    for ask in (
        lambda: sc.drift(coin, "30deg", theirs),
        lambda: sc.roll(coin, start, 0.1, losses=theirs),
        lambda: sc.roll(coin, start, 0.1, losses=theirs + theirs),
        lambda: sc.play(coin, "30deg", losses=theirs),
        lambda: sc.sweep.roll(coin, start, 0.1, losses=theirs),
        lambda: sc.roll(coin, start, 0.1, contact=wet),
    ):
        with pytest.raises(
            ValueError, match=r"^(losses|contact) = .* made for another scale, R = 0.0079375 m"
        ):
            ask()
    ours = sc.loss.RollingResistance.from_si("0.02mm", scale=sc.Scale(12e-3))
    with pytest.raises(
        ValueError, match="^laws: RollingResistance.* made for another scale, R = 0.0079375 m"
    ):
        ours + theirs
    assert sc.drift(coin, "30deg", ours).stops_at == pytest.approx(23.31, abs=0.01)
    assert sc.drift(coin.natural, 0.5, theirs).stops_at > 0
