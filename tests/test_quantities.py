"""Quantities of pint's in place of numbers."""

import math

import numpy as np
import pytest
from test_measured import PVC, START, TUBE

import spincyl as sc


@pytest.fixture(scope="module")
def unit():
    pint = pytest.importorskip("pint")
    return pint.UnitRegistry()


def test_quantities_are_understood(unit):
    mm = unit.millimetre
    tube = sc.measured(
        outer_diameter=15.875 * mm,
        inner_diameter=0.5 * unit.inch,
        length=9.525 * unit.cm,
        mass=20 * unit.gram,
    )
    assert tube.critical_hertz == pytest.approx(TUBE.critical_hertz, rel=1e-14)
    assert tube.scale.mass == pytest.approx(20e-3) and "mass=0.02" in repr(tube)
    assert sc.Scale(8 * mm, 20 * unit.gram, 981 * unit.cm / unit.s**2) == sc.Scale(8e-3, 20e-3, 9.81)
    assert TUBE.hertz(85 * unit.degree) == pytest.approx(TUBE.hertz(math.radians(85)))
    m = sc.roll(TUBE, START, np.linspace(0, 500, 3) * unit.millisecond, step=0.1 * unit.ms)
    assert m.t.tolist() == [0.0, 0.25, 0.5] and "step 0.0001 s" in m.message
    assert m.at(100 * unit.ms).t.tolist() == [0.1] and m.wanting("pose", t=0.2 * unit.s).t.tolist() == [0.2]
    assert sc.thrown(TUBE, 3.6 * unit.km / unit.hour, 60 * unit.rpm) == sc.thrown(TUBE, 1.0, 2 * math.pi)
    assert sc.pressed(TUBE, 100 * unit.newton * unit.millisecond, 45 * unit.degree) == sc.pressed(
        TUBE, 0.1, math.pi / 4
    )
    assert sc.loss.DryContour.from_si(20 * unit.micrometre, scale=TUBE).eps == pytest.approx(
        sc.loss.DryContour.from_si(2e-5, scale=TUBE).eps
    )


@pytest.mark.parametrize(
    "turns", ["7.29 hertz", "7.29 / second", "437.4 rpm", "45.8044 radian/second", "2624.4 degree/s"]
)
def test_turns_a_second_are_the_same_in_every_unit(unit, turns):
    assert TUBE.inclinations(hertz=unit(turns))[1] == pytest.approx(
        TUBE.inclinations(hertz=7.29)[1], rel=1e-6
    )


def test_a_spin_down_may_be_given_as_quantities(unit):
    disk = sc.measured(outer_diameter=75.1 * unit.millimetre, length=12.8 * unit.millimetre)
    true = sc.drift(disk, 0.3, sc.loss.DryContour.from_si(37.55e-6, scale=disk))
    t, law = np.linspace(0.0, 0.9 * true.stops_at, 30), [sc.loss.DryContour]
    turns = true.precession(t) / (2 * np.pi)
    found = sc.data.fit_losses(
        1e3 * t * unit.ms, precession=turns * unit.hertz, t_err=0.1 * unit.ms, body=disk, laws=law
    )
    assert found.best.coefficient == pytest.approx(1e-3, rel=1e-6) and found.t_err[0] == pytest.approx(1e-4)
    with pytest.raises(TypeError, match="^t: expected a number or a quantity in second, not met"):
        sc.data.fit_losses(t * unit.metre, precession=turns * unit.hertz, body=disk, laws=law)


def test_quantities_of_another_dimension_are_refused_by_name(unit):
    metre, second = unit.metre, unit.second
    for name, wrong in (
        ("outer_diameter", lambda: sc.measured(outer_diameter=1 * second, length=1.0)),
        ("length", lambda: sc.measured(outer_diameter=1.0, length=1 * unit.kg)),
        ("mass", lambda: sc.measured(**PVC, mass=1 * unit.newton)),
        ("gravity", lambda: sc.measured(**PVC, gravity=1 * metre)),
        ("radius", lambda: sc.Scale(1 * unit.kg)),
        ("t", lambda: sc.roll(TUBE, START, 1 * metre)),
        ("t", lambda: sc.roll(TUBE, START, [1 * second, 2 * second])),
        ("step", lambda: sc.roll(TUBE, START, 1.0, step=1 * metre)),
        ("hertz", lambda: TUBE.inclinations(hertz=1 * metre)),
        ("velocity", lambda: sc.thrown(TUBE, 1 * second, 1.0)),
        ("theta", lambda: TUBE.steady(1 * metre)),
        ("rate", lambda: TUBE.inclinations(rate=1 * unit.hertz)),
        ("t", lambda: sc.roll(TUBE.natural, START, 1 * second)),
        ("thetadot", lambda: TUBE.steady(1.4).kicked(1 * unit.radian / second)),
    ):
        with pytest.raises(TypeError, match=f"^{name}: expected "):
            wrong()
