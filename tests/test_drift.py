"""Slow drifts from Python: closed forms, shapes, refusals, warnings."""

import re
import warnings

import numpy as np
import pytest

import spincyl as sc

DISK = sc.Body.solid(0.0)
COIN = sc.Body.solid(0.085)
TALL = sc.Body.solid(2.5)
VISCOUS = sc.loss.ViscousContour(1e-3)


def test_the_two_drifts_part_above_the_ridge():
    dry = sc.loss.DryContour(2e-3)
    ridge = TALL.ridge()[0]
    rest, rolls = (sc.drift(TALL, 0.3, dry, centre=centre) for centre in ("rest", "rolling"))
    assert rest.ended == "balanced" and rest.stops_at == np.inf
    assert rolls.ended == "face lands" and rolls.time(ridge) < rolls.time(0.239) < 42
    assert rest.theta(10.0) > 0.3 > rolls.theta(10.0)
    y = rolls.state(20.0)
    assert TALL.acceleration(y) == pytest.approx(0, abs=1e-12)
    v = TALL.centre_velocity(y)[1]
    assert rolls.friction_coefficient(20.0) == pytest.approx(abs(v) * y.precession, rel=1e-9)


def test_arrays_of_bodies_starts_and_coefficients_broadcast_and_are_those_of_each():
    ell = np.array([0.05, 0.2, 2.5])[:, None]
    theta = np.array([0.05, 0.1])
    c = np.array([1e-3, 2e-3])
    for centre in ("rest", "rolling"):
        d = sc.drift(sc.Body.solid(ell), theta, sc.loss.ViscousContour(c), centre=centre)
        assert d.stops_at.shape == d.ended.shape == d.ends_at_theta.shape == (3, 2)
        assert d.stable_until.shape == (3, 2)
        t = np.linspace(0.0, 0.4, 5)[:, None, None] * d.stops_at
        assert d.theta(t).shape == (5, 3, 2)
        for i in range(3):
            for j in range(2):
                one = sc.drift(
                    sc.Body.solid(float(ell[i, 0])),
                    float(theta[j]),
                    sc.loss.ViscousContour(float(c[j])),
                    centre,
                )
                assert one.stops_at == d.stops_at[i, j] and one.ended == d.ended[i, j]
                assert one.theta(float(t[3, i, j])) == d.theta(t)[3, i, j]
                assert one.stable_until == d.stable_until[i, j]


def test_the_answers_do_not_depend_on_the_number_of_threads():
    theta = np.linspace(0.01, 1.5, 5001)
    found = [sc.drift(COIN, theta, VISCOUS, threads=n) for n in (1, 3)]
    assert np.array_equal(found[0].stops_at, found[1].stops_at, equal_nan=True)
    assert np.array_equal(found[0].ended, found[1].ended)


def test_in_arrays_what_is_no_drift_is_nan_and_says_so():
    theta = np.array([0.2, 0.5, np.nan, -1.0, 1.2])
    d = sc.drift(TALL, theta, VISCOUS)
    assert list(np.isnan(d.stops_at)) == [False, True, True, True, False]
    assert list(d.ended) == ["face lands", "no drift", "no drift", "no drift", "lies down"]
    assert np.isnan(d.theta(1.0)[1:4]).all() and np.isnan(d.stable_until[1:4]).all()
    none = sc.drift(TALL, np.empty(0), VISCOUS)
    assert none.stops_at.shape == none.theta(1.0).shape == (0,)
    rolling = sc.drift(TALL, np.array([0.2, 0.36]), VISCOUS, centre="rolling")
    assert list(np.isnan(rolling.stops_at)) == [False, True]


def test_a_single_question_without_an_answer_is_an_error_with_its_name():
    d = sc.drift(DISK, 0.3, VISCOUS)
    for theta in (0.31, -0.1, float("nan")):
        with pytest.raises(
            ValueError, match=r"^theta = .* expected .*, the inclinations of this body with these losses"
        ):
            d.time(theta)
    with pytest.raises(
        ValueError,
        match=r"^theta = 0.31: expected 0 to 0.3, the inclinations of this body with these losses$",
    ):
        d.time(0.31)
    up = sc.drift(TALL, 1.45, VISCOUS)
    low, high = sorted((1.45, up.ends_at_theta))
    with pytest.raises(
        ValueError, match=f"^theta = 0.2: expected {low:.6g} to {high:.6g}, the inclinations of this body"
    ):
        up.time(0.2)
    for t in (-1.0, 1.001 * d.stops_at, float("nan")):
        with pytest.raises(ValueError, match=r"^t = .*: expected 0 <= t <= stops_at"):
            d.theta(t)
    assert np.isnan(d.time(np.array([0.31, 0.2]))).tolist() == [True, False]
    assert d.theta(d.stops_at) == 0.0 and d.time(0.0) == pytest.approx(d.stops_at, rel=1e-13)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: sc.drift(TALL, 0.5, VISCOUS), "theta = 0.5 is forbidden"),
        (lambda: sc.drift(TALL, 2.0, VISCOUS), "theta = 2.0: expected"),
        (lambda: sc.drift(TALL, 0.36, VISCOUS, centre="rolling"), "kappa = -"),
        (lambda: sc.drift(TALL, sc.State(1.0, 0.3, 0.0, 0.1), VISCOUS, centre="rolling"), "theta'' = "),
        (lambda: sc.drift(TALL, TALL.steady(0.2).kicked(0.1), VISCOUS, centre="rolling"), "w2 = -0.1"),
        (
            lambda: sc.drift(TALL, TALL.circular(1.2, 3.0), VISCOUS),
            r"whose centre is at rest, or give centre='rolling'",
        ),
        (lambda: sc.drift(TALL, 0.2, VISCOUS, centre="slipping"), "centre = 'slipping'"),
    ],
)
def test_what_makes_no_drift_is_refused_by_name(call, message):
    with pytest.raises(ValueError, match="^(state = .*)?" + message.replace("(", r"\(")):
        call()


def test_what_is_no_body_and_no_loss_is_refused_by_name():
    with pytest.raises(TypeError, match="^body: "):
        sc.drift(3.0, 0.2, VISCOUS)
    with pytest.raises(TypeError, match="^losses: "):
        sc.drift(COIN, 0.2, 1e-3)
    with pytest.raises(TypeError, match="^theta: "):
        sc.drift(COIN, "flat", VISCOUS)
    with pytest.raises(ValueError, match="slips"):
        sc.drift(COIN, COIN.with_centre_velocity(COIN.steady(0.2), 0.0, 1.0), VISCOUS, centre="rolling")


def test_dry_contour_friction_warns_where_it_has_no_meaning():
    with pytest.warns(sc.DriftWarning, match="theta = eps"):
        sc.drift(COIN, 0.005, sc.loss.DryContour(1e-2))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        d = sc.drift(COIN, 0.3, sc.loss.DryContour(1e-3))
        assert d.theta(0.5 * d.stops_at) > 1e-3 and d.theta(d.stops_at) == 0.0
    with pytest.warns(sc.DriftWarning, match="is evaluated there"):
        d.time(5e-4)


def test_a_film_of_air_warns_of_what_stands_too_high_for_one():
    """Euler's disk of Moffatt, Nature 404, 833 (2000): below 0.005 rad, from viscosity and density of air."""
    disk = sc.measured(outer_diameter=0.075, length=0.0128, mass=0.4)
    film = sc.loss.AirFilm.from_si(scale=disk)
    below = ((1.5e-5) ** 0.5 * (0.0375 / (4 * 9.80665)) ** 0.25 / 0.0375) ** (4 / 3)
    assert below == pytest.approx(0.005, rel=0.05)
    for theta in (1.01 * below, np.array([0.003, 0.3])):
        with pytest.warns(sc.DriftWarning, match=r"fills the gap below theta = 0\.0048 only") as found:
            sc.drift(disk, theta, film + sc.loss.DryContour.from_si(1e-5, scale=disk))
        assert found[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sc.drift(disk, 0.99 * below, film)
        sc.drift(disk.natural, 0.3, film)  # without a size
        sc.drift(disk, 0.3, sc.loss.BoundaryLayer.from_si(0.3, scale=disk))


def test_tiny_numbers_are_answered():
    d = sc.drift(COIN, 1e-300, sc.loss.RollingResistance(1e-3))
    assert d.stops_at == pytest.approx(3 * (COIN.i1 * 1e-300) ** 0.5 / 1e-3 * _slope(COIN), rel=1e-6)
    slow = sc.drift(COIN, 0.2, sc.loss.ViscousContour(1e-300))
    assert slow.stops_at == pytest.approx(sc.drift(COIN, 0.2, VISCOUS).stops_at * 1e297, rel=1e-12)


def _slope(body):
    return (1.5 + body.i3 * body.ell**2 / (2 * body.i1)) / 1.5


def test_stable_until_is_when_kappa_of_rolling_vanishes():
    d = sc.drift(TALL, 0.3, sc.loss.Drilling(1e-3))
    assert 0 < d.stable_until < d.stops_at < np.inf
    assert TALL.stability(d.theta(d.stable_until)) == pytest.approx(0, abs=1e-9)
    assert sc.drift(TALL, 1.2, VISCOUS).stable_until == np.inf
    assert sc.drift(TALL, 0.36, VISCOUS).stable_until == 0.0


def test_a_drift_says_what_it_is_of_and_how_it_ends():
    one = sc.drift(COIN, 0.3, VISCOUS)
    assert repr(COIN) in repr(one) and repr(VISCOUS) in repr(one)
    assert repr(one).endswith(f"face lands at theta = 0, t = {one.stops_at:.6g}>")
    coin = sc.measured(outer_diameter=75.1e-3, length=12.8e-3)
    law = sc.loss.DryContour.from_si("0.1mm", scale=coin)
    assert re.search(r"t = 2\.\d+ s>$", repr(sc.drift(coin, 0.3, law)))
    assert repr(sc.drift(COIN, [0.2, 0.3], VISCOUS)).endswith("shape (2,)>")
