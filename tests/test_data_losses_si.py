"""Spin-downs of measured bodies, in seconds: their laws and times, and units that are doubted."""

import warnings

import numpy as np
import pytest
from scenes import LAWS

import spincyl as sc


def dry(eps, body):
    """Dry friction along the contour of a measured body, with the coefficient in R."""
    return sc.loss.DryContour.from_si(eps * body.scale.radius, scale=body)


def test_a_spin_down_in_seconds_gives_the_law_and_its_time_in_seconds():
    disk = sc.measured(outer_diameter=75.1e-3, length=12.8e-3)
    second = disk.scale.seconds(1.0)
    true = sc.drift(disk, 0.3, dry(1e-3, disk))
    t, random = np.linspace(0.0, 0.95 * true.stops_at, 60), np.random.default_rng(2)
    theta = true.theta(t) * (1 + 0.01 * random.normal(size=60))
    precession = true.precession(t) * (1 + 0.01 * random.normal(size=60))
    laws = [sc.loss.DryContour, sc.loss.ViscousContour]
    errors = {"t_err": 1e-4, "theta_err": 0.01 * theta, "precession_err": 0.01 * precession}
    found = sc.data.fit_losses(t, theta, precession, body=disk, laws=laws, **errors)
    natural = {
        "t_err": 1e-4 / second,
        "theta_err": 0.01 * theta,
        "precession_err": 0.01 * precession * second,
    }
    same = sc.data.fit_losses(t / second, theta, precession * second, body=disk.natural, laws=laws, **natural)
    assert found.body == disk and same.body == disk.natural
    assert found.t == pytest.approx(t, rel=1e-15) and found.precession == pytest.approx(precession, rel=1e-15)
    assert abs(found.best.stops_at - true.stops_at) < 4 * found.best.stops_at_err < 0.1 * true.stops_at
    assert abs(found.best.coefficient - 1e-3) < 4 * found.best.coefficient_err
    for one, other in zip(found.fits, same.fits, strict=True):
        assert one.name == other.name
        numbers = other.coefficient, other.chi2, other.aic
        assert (one.coefficient, one.chi2, one.aic) == pytest.approx(numbers, rel=1e-6)
        times = other.stops_at * second, other.stops_at_err * second
        assert (one.stops_at, one.stops_at_err) == pytest.approx(times, rel=1e-6)
        # the residual is the measurement minus the fitted drift
        clock = t - t[0]
        shown = {"theta": one.drift.theta(clock), "precession": one.drift.precession(clock)}
        assert found.theta - shown["theta"] == pytest.approx(one.residual["theta"], abs=1e-9)
        assert found.precession - shown["precession"] == pytest.approx(one.residual["precession"], abs=1e-6)
        assert one.drift.stops_at == pytest.approx(one.stops_at - t[0], rel=1e-9)
    left = found.line.stops_at - t
    assert found.line.factor * left**found.line.exponent == pytest.approx(theta, rel=0.1)
    assert " s" in found.table() and "(seconds, derived)" in found.report()
    plt = pytest.importorskip("matplotlib.pyplot")
    drawn = found.plot()
    assert [axis.get_xlabel() for axis in drawn][:2] == ["time  $t$ (s)"] * 2
    plt.close(drawn[0].figure)


@pytest.mark.parametrize("wrong", ["seconds of a body in natural units", "hertz for rad/s"])
def test_units_that_make_rates_and_inclinations_disagree_are_warned_of_without_any_errors(wrong):
    coin = sc.measured(outer_diameter=24e-3, length=1.75e-3)
    true = sc.drift(coin, 0.45, dry(2e-3, coin))
    t = np.linspace(0.0, 0.9 * true.stops_at, 30)
    precession = true.precession(t) / (2 * np.pi) if wrong.startswith("hertz") else true.precession(t)
    body = coin if wrong.startswith("hertz") else coin.natural
    unit = "seconds and rad/s" if wrong.startswith("hertz") else "natural units"
    with pytest.warns(UserWarning, match=f"^the precession is .* times that of steady states .* in {unit}"):
        sc.data.fit_losses(t, true.theta(t), precession, body=body, laws=[sc.loss.DryContour])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sc.data.fit_losses(t, true.theta(t), true.precession(t), body=coin, laws=[sc.loss.DryContour])


def test_a_spin_down_that_was_heard_is_fitted_in_seconds_and_its_line_is_of_rates():
    disk = sc.measured(outer_diameter=75.1e-3, length=12.8e-3, mass=0.44)
    unit = sc.loss.ViscousContour.from_si(1.0, scale=disk).coefficient
    true = sc.drift(disk, 0.3, sc.loss.ViscousContour.from_si(2e-4 / unit, scale=disk))
    t = np.linspace(1.0, 0.9 * true.stops_at, 40)
    law = [sc.loss.ViscousContour]
    found = sc.data.fit_losses(t, precession=true.precession(t), body=disk, laws=law)
    assert found.best.coefficient == pytest.approx(2e-4, rel=1e-8)
    assert found.best.stops_at == pytest.approx(true.stops_at, rel=1e-8)
    left = found.line.stops_at - t
    assert found.line.factor * left**found.line.exponent == pytest.approx(true.precession(t), rel=0.1)
    with pytest.raises(ValueError, match=r"^precession: no drift .* is precession in rad/s\?"):
        sc.data.fit_losses(t, precession=true.precession(t) / 1000, body=disk, laws=law)


@pytest.mark.parametrize("diameter", [12e-3, 48e-3])
def test_a_diameter_taken_for_a_radius_or_twice_is_warned_of_and_the_fit_goes_on(diameter):
    coin, wrong = (sc.measured(outer_diameter=x, length=1.75e-3) for x in (24e-3, diameter))
    true = sc.drift(coin, 0.45, dry(2e-3, coin))
    t = np.linspace(0.0, 0.9 * true.stops_at, 60)
    random = np.random.default_rng(3)
    theta, precession = (
        x * (1 + 0.005 * random.normal(size=60)) for x in (true.theta(t), true.precession(t))
    )
    with pytest.warns(
        UserWarning, match="^the precession is .* times that of steady .* is the size of the body right"
    ):
        found = sc.data.fit_losses(t, theta, precession, body=wrong, laws=LAWS[:2])
    assert np.isfinite(found.best.stops_at) and found.best.coefficient > 0
