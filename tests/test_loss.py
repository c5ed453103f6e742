"""Loss laws: arithmetic, power, refusals, and SI units."""

import copy
import math
import pickle

import dask.array as da
import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from loss_rows import ROWS, rates

import spincyl as sc
from spincyl import _core
from spincyl.loss import (
    AirFilm,
    AirLinear,
    AirQuadratic,
    BoundaryLayer,
    Drilling,
    DryContour,
    Loss,
    RollingResistance,
    Sum,
    ViscousContour,
)

LAWS = {law: row.coefficient for law, row in ROWS.items()}
COIN, PIPE, ROUNDED = sc.Body.solid(0.0), sc.Body.tube(6.0, bore=0.8), sc.Body.solid(1.5, fillet=0.3)
EULER = sc.Scale(radius=0.0375, mass=0.44)
WHIRR = COIN.steady(0.1)
# Away from rest, where the couple of a dry law is not unique.
STATE = sc.State(0.7, 1.1, -0.4, 0.6)
ALL = sum(law(10.0**-k) for k, law in enumerate(LAWS))

laws = pytest.mark.parametrize(("law", "name"), LAWS.items(), ids=lambda x: getattr(x, "__name__", x))


# Arithmetic.


@laws
def test_a_law_is_shown_as_it_is_typed(law, name):
    assert repr(law(5e-3)) == f"{law.__name__}(0.005)"
    assert repr(law([0.1, 0.2])) == f"{law.__name__}([0.1, 0.2])"
    assert eval(repr(law(1 / 3))) == law(1 / 3)
    assert getattr(law(**{name: 0.25}), name) == 0.25 == law(0.25).coefficient


def test_laws_that_are_added_are_shown_in_that_order():
    both = AirFilm(1e-7) + DryContour(2e-3)
    assert repr(both) == "AirFilm(1e-07) + DryContour(0.002)" and eval(repr(both)) == both
    assert repr(Sum([both])) == repr(both)


@laws
def test_a_law_is_compared_by_its_value(law, name):
    assert law(0.1) == law(0.1) and hash(law(0.1)) == hash(law(0.1))
    assert law(0.1) != law(0.2) and law(0.1) != 0.1
    assert law([0.1, 0.2]) == law(np.array([0.1, 0.2])) != law([0.1, 0.3])
    others = [other(0.1) for other in LAWS if other is not law]
    assert law(0.1) not in others and len({law(0.1), *others}) == len(LAWS)


def test_the_order_of_addition_does_not_matter():
    a, b, c = DryContour(0.1), AirFilm(0.2), Drilling(0.3)
    assert a + b == b + a and hash(a + b) == hash(b + a)
    assert (a + b) + c == a + (b + c) == sum([c, b, a]) == Sum([c, a, b])
    assert [type(x) for x in ((a + b) + c).laws] == [DryContour, AirFilm, Drilling], "flat"
    assert a + b != a + c and a + b != a


def test_a_law_added_to_itself_is_a_law_of_twice_the_coefficient():
    twice = DryContour(0.1) + DryContour(0.2)
    assert type(twice) is DryContour and twice.eps == 0.1 + 0.2
    more = (DryContour(0.1) + AirFilm(1.0)) + DryContour(0.1)
    assert more == AirFilm(1.0) + DryContour(0.2) and len(more.laws) == 2
    assert Sum([DryContour(0.1)]) == DryContour(0.1), "a sum of one law is that law"
    assert sum([DryContour(0.1)]) == DryContour(0.1)


@pytest.mark.parametrize("loss", [DryContour(0.1), BoundaryLayer([0.1, 0.2]), ALL], ids=repr)
def test_a_loss_survives_pickling_and_copying(loss):
    for again in (pickle.loads(pickle.dumps(loss)), copy.copy(loss), copy.deepcopy(loss)):
        assert again == loss and type(again) is type(loss) and repr(again) == repr(loss)


@laws
def test_a_law_does_not_change(law, name):
    with pytest.raises(AttributeError):
        setattr(law(0.1), name, 0.2)
    with pytest.raises(AttributeError):
        (law(0.1) + ALL)._laws = ()


def test_names_and_exponents_are_those_of_the_core():
    told = [(row["parameter"], row["exponent"]) for row in _core.loss_laws()]
    assert told == [(row.coefficient, row.exponent) for row in ROWS.values()]
    for place, (law, row) in enumerate(ROWS.items()):
        assert law(0.1).exponent == row.exponent
        assert law(0.1)._coefficients == [0.1 if k == place else 0.0 for k in range(len(LAWS))]
    assert ALL._coefficients == [10.0**-k for k in range(len(LAWS))]


# Refusals.


@laws
@pytest.mark.parametrize("value", [0.0, -0.0, -1e-3, math.nan, math.inf, [0.1, -1e-3, 0.2], [math.nan]])
def test_a_coefficient_that_is_not_positive_is_refused_by_name(law, name, value):
    first = next(x for x in np.atleast_1d(value) if not 0 < x < np.inf)
    with pytest.raises(ValueError, match=rf"^{name} = {float(first)!r}: expected a positive number"):
        law(value)
    with pytest.raises(ValueError, match=rf"^{name} = 2000000.0: expected at most 1e\+06"):
        law(2e6)


@pytest.mark.parametrize(
    ("make", "error", "match"),
    [
        (lambda: DryContour("0.1"), TypeError, "^eps: expected real numbers"),
        (lambda: AirFilm(None), TypeError, "^viscosity: expected real numbers"),
        (lambda: BoundaryLayer(1j), TypeError, "^k: expected real numbers"),
        (lambda: Sum([]), ValueError, "^laws: expected at least one"),
        (
            lambda: Sum([DryContour(0.1), 0.2]),
            TypeError,
            "^laws: expected losses from sc.loss, not float 0.2",
        ),
        (lambda: DryContour(0.1) + 1, TypeError, "unsupported operand"),
        (lambda: 1 + DryContour(0.1), TypeError, "unsupported operand"),
        (lambda: np.ones(2) + DryContour(0.1), TypeError, "NumPy arrays"),
        (lambda: DryContour(6e5) + DryContour(6e5), ValueError, "^eps = 1200000.0: expected at most"),
        (lambda: DryContour(0.1).power(1.0, STATE), TypeError, "^body: expected a Body"),
        (lambda: DryContour(0.1).power(COIN, 1.0), TypeError, "^state: expected a State"),
        (lambda: DryContour(0.1).couple(COIN, STATE, "1"), TypeError, "^normal: expected real numbers"),
        (lambda: DryContour.from_si(-1e-3, scale=EULER), ValueError, "^eps = -0.001: expected a positive"),
        (lambda: DryContour.from_si(1e-3, scale=0.1), TypeError, "^scale: expected a Scale, not float"),
        (lambda: AirFilm.from_si(0.0, scale=EULER), ValueError, "^viscosity = 0.0: expected a positive"),
        (lambda: BoundaryLayer.from_si(0.1, scale=EULER, density=-1), ValueError, "^density = -1.0"),
        (lambda: BoundaryLayer.from_si(math.nan, scale=EULER), ValueError, "^C = nan"),
    ],
)
def test_what_is_no_loss_is_refused(make, error, match):
    with pytest.raises(error, match=match):
        make()


# Power.


def power(law, y, n=1.0):
    """The power of a law for sharp rims, by the table of the tests."""
    return law.coefficient * ROWS[type(law)].power(rates(y, n))


@laws
def test_a_law_takes_the_power_of_its_table(law, name):
    found = law(0.03).power(PIPE, STATE, 1.7)
    assert found == pytest.approx(power(law(0.03), STATE, 1.7), rel=1e-14) and found > 0
    dry = law in (DryContour, RollingResistance, Drilling)
    assert law(0.03).power(PIPE, STATE) == pytest.approx(found / (1.7 if dry else 1.0), rel=1e-14)


# Include zero, but no numbers whose squares underflow.
speeds = st.integers(-20_000, 20_000).map(lambda k: k / 1000)


@settings(max_examples=30)
@given(theta=st.floats(0.01, 1.57), w=st.tuples(speeds, speeds, speeds), normal=st.floats(0, 10))
@pytest.mark.parametrize("body", [PIPE, ROUNDED, COIN], ids=["tube", "rounded", "coin"])
@laws
def test_the_couple_takes_the_power(law, name, body, theta, w, normal):
    state = sc.State(theta, *w)
    m = law(0.02).couple(body, state, normal)
    lost = law(0.02).power(body, state, normal)
    terms = np.abs(m * w).max()
    assert lost >= 0 and abs(m @ w + lost) <= 4e-14 * max(terms, lost) / np.sin(theta) + 1e-300


def test_powers_and_couples_add():
    each = [law(10.0**-k) for k, law in enumerate(LAWS)]
    assert ALL.power(PIPE, STATE, 1.3) == pytest.approx(sum(x.power(PIPE, STATE, 1.3) for x in each))
    assert ALL.couple(PIPE, STATE, 1.3) == pytest.approx(sum(x.couple(PIPE, STATE, 1.3) for x in each))


def test_a_contour_law_of_a_rounded_rim_sees_the_smaller_circle():
    radius = 1 - 0.3 + 0.3 * np.sin(STATE.theta)
    spin = abs(STATE.spin)
    assert DryContour(0.1).power(ROUNDED, STATE) == pytest.approx(0.1 * radius * spin, rel=1e-14)
    assert ViscousContour(0.1).power(ROUNDED, STATE) == pytest.approx(0.1 * (radius * spin) ** 2, rel=1e-14)
    assert BoundaryLayer(0.1).power(ROUNDED, STATE) == pytest.approx(0.1 * spin**2.5, rel=1e-14)


def test_nothing_is_lost_where_nothing_moves():
    rest = sc.State(0.4, 0.0, 0.0, 0.0)
    assert ALL.power(PIPE, rest) == 0 and np.all(ALL.couple(PIPE, rest) == 0)


def test_arrays_of_bodies_states_coefficients_and_forces_broadcast():
    theta, eps = np.linspace(0.1, 1.0, 5), np.array([[1e-3], [2e-3]])
    family, states = sc.Body.solid(np.linspace(0.1, 0.3, 5)), sc.State(theta, 1.0, 0.2, 0.4)
    law = DryContour(eps) + AirLinear(1e-4)
    lost, m = law.power(family, states), law.couple(family, states, np.ones((3, 1, 1)))
    assert lost.shape == (2, 5) and m.shape == (3, 2, 5, 3)
    one = DryContour(2e-3) + AirLinear(1e-4)
    body, state = sc.Body.solid(family.ell[3]), sc.State(theta[3], 1.0, 0.2, 0.4)
    assert lost[1, 3] == one.power(body, state) and np.array_equal(m[2, 1, 3], one.couple(body, state))
    w = np.stack(np.broadcast_arrays(1.0, 0.2, 0.4))
    assert np.allclose(-(m[0] @ w), lost, rtol=1e-12)


def test_arrays_keep_their_kind():
    theta = np.linspace(0.1, 1.0, 4)
    labelled = sc.State(xr.DataArray(theta, dims="tilt"), 1.0, 0.0, 0.3)
    m = DryContour(0.1).couple(PIPE, labelled)
    assert m.dims == ("tilt", "axis") and m.shape == (4, 3)
    assert type(DryContour(pd.Series(theta)).power(PIPE, STATE)) is pd.Series
    lazy = DryContour(da.from_array(theta))
    assert "lazy" in repr(lazy) and isinstance(lazy.power(PIPE, STATE), da.Array)
    assert np.array_equal(lazy.power(PIPE, STATE).compute(), DryContour(theta).power(PIPE, STATE))
    assert np.isnan(DryContour(da.from_array(-theta)).power(PIPE, STATE)).all().compute()
    assert type(DryContour(0.1).power(PIPE, STATE)) is np.float64


def test_a_body_of_a_family_that_is_none_loses_nothing_that_is_known():
    found = ALL.power(sc.Body(np.array([1.0, -1.0]), 0.3, 0.4), STATE)
    assert np.isnan(found).tolist() == [False, True]


# SI units.


def test_moffatts_film_under_eulers_disk():
    film = AirFilm.from_si(scale=EULER)
    assert film.viscosity == pytest.approx(1.8e-5 * 0.0375**1.5 / (0.44 * 9.80665**0.5), rel=1e-14)
    assert film.viscosity == pytest.approx(9.5e-8, rel=0.002)
    # Moffatt's hundred seconds from 0.1 rad: 2 I1 theta^3/(pi mu)
    seconds = EULER.seconds(2 * 0.25 * 0.1**3 / (np.pi * film.viscosity))
    assert seconds == pytest.approx(100, rel=0.05) and EULER.seconds(1.0) == pytest.approx(0.062, rel=0.01)
    assert AirFilm.from_si(3.6e-5, scale=EULER).viscosity == pytest.approx(2 * film.viscosity)


def test_coefficients_from_metres_seconds_and_joules():
    m, g, r = EULER.mass, EULER.gravity, EULER.radius
    for law in (DryContour, RollingResistance, Drilling):
        assert law.from_si(0.75e-3, scale=EULER) == law(0.75e-3 / r)
    for law in (ViscousContour, AirLinear):
        assert law.from_si(1e-6, scale=EULER).coefficient == pytest.approx(
            1e-6 / (m * r * np.sqrt(g * r)), rel=1e-14
        )
    assert AirQuadratic.from_si(1e-6, scale=EULER).b2 == pytest.approx(1e-6 / (m * r**2), rel=1e-14)
    k = 0.1 * np.sqrt(1.2 * 1.8e-5) * r**2.25 / (m * g**0.25)
    assert BoundaryLayer.from_si(0.1, scale=EULER).k == pytest.approx(k, rel=1e-14)
    assert np.allclose(DryContour.from_si([1e-3, 2e-3], scale=EULER).eps, np.array([1e-3, 2e-3]) / r)


@laws
def test_a_power_in_watts_is_that_of_the_law_in_si_units(law, name):
    """A coefficient of 1 in SI gives the power of speeds in SI."""
    small = sc.Scale(radius=2.0, mass=3.0, gravity=5.0)
    seconds, joules = small.seconds(1.0), small.joules(1.0)
    natural = law.from_si(0.1, scale=small)
    watts = natural.power(COIN, STATE) * joules / seconds
    # of a boundary layer `from_si` takes a number C, and k is C sqrt(density viscosity) R^4
    coefficient = 0.1 * (np.sqrt(1.2 * 1.8e-5) * 2.0**4 if law is BoundaryLayer else 1.0)
    expected = coefficient * ROWS[law].power(rates(STATE, 3.0 * 5.0, seconds, radius=2.0))
    assert watts == pytest.approx(expected, rel=1e-13)


def test_a_whirring_coin_loses_what_the_page_says():
    assert isinstance(ALL, Loss) and WHIRR.precession == pytest.approx((0.25 * np.sin(0.1)) ** -0.5)
    turns = WHIRR.precession
    assert DryContour(1e-3).power(COIN, WHIRR) == pytest.approx(1e-3 * turns * np.cos(0.1), rel=1e-14)


def test_a_law_of_air_asks_for_the_mass_of_the_body():
    with pytest.warns(UserWarning, match="depends on the mass of the body"):
        sc.loss.AirFilm.from_si(scale=sc.Scale(radius=0.01))
    assert sc.loss.DryContour.from_si(2e-5, scale=sc.Scale(radius=0.01)).eps == pytest.approx(2e-3)


@pytest.mark.parametrize("law", [DryContour, RollingResistance, Drilling])
def test_an_arm_in_millimetres_is_warned_of(law):
    with pytest.warns(UserWarning, match="exceeds half the radius"):
        law.from_si(0.06, scale=EULER)
    law.from_si("0.06mm", scale=EULER)
