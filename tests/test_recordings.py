"""A recorded spin-down: whatever comes before and after it, its law is determined, or declared uncertain."""

import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from few import few

import spincyl as sc
from spincyl.lab import _curve

sys.path.append(str(Path(__file__).parents[1] / "benches"))
import recordings

DISK = sc.measured(outer_diameter=75.1e-3, length=12.8e-3, mass=0.44)
T, WHIRR = sc.data.read_sound(sc.data.example("whirr"))
HERTZ = 1 / (T[1] - T[0])
TRUE = 2e-4  # coefficient of ViscousContour in the example


def heard(sound):
    found = sc.data.wobble(np.arange(sound.size) / HERTZ, sound)
    rates = {"precession": 2 * np.pi * found.turns, "precession_err": 2 * np.pi * found.turns_err}
    return found, rates


@pytest.mark.parametrize(("lead", "tail"), [(0.3, 0.0), (0.5, 1.0), (1.3, 0.4)])
def test_silence_before_and_after_a_whirr_changes_nothing(lead, tail):
    rng = np.random.default_rng(0)
    quiet = [0.02 * WHIRR.std() * rng.normal(size=int(x * HERTZ)) for x in (lead, tail)]
    found, rates = heard(np.r_[quiet[0], WHIRR, quiet[1]])
    true = sc.drift(DISK.natural, np.radians(20), sc.loss.ViscousContour(TRUE))
    second = DISK.scale.seconds(1.0)
    shown = DISK.scale.turns(true.precession((found.t - lead) / second))
    assert np.abs((found.turns - shown) / found.turns_err).max() < 4, (
        "no value is false, the first one neither"
    )
    fit = sc.data.fit_losses(found.t, **rates, body=DISK, centre="rest")
    assert fit.best.name == "ViscousContour" and fit.told_apart
    assert abs(fit.best.coefficient - TRUE) < 4 * fit.best.coefficient_err


def test_mains_that_hum_louder_than_the_whirr_are_not_taken_for_one():
    rng, clock = np.random.default_rng(1), np.arange(WHIRR.size + int(1.5 * HERTZ)) / HERTZ
    sound = np.r_[0.02 * rng.normal(size=clock.size - WHIRR.size) * WHIRR.std(), WHIRR]
    plain, _ = heard(sound)
    hum = sum(np.cos(2 * np.pi * 60 * k * clock + k) / k for k in range(1, 20))
    found, _ = heard(sound + 2 * WHIRR.std() * hum)
    assert found.turns.max() < 30 and len(found.t) >= len(plain.t) - 1
    assert np.abs(np.interp(found.t, plain.t, plain.turns) / found.turns - 1).max() < 0.01


def test_a_short_buffer_is_said_to_be_too_short_and_not_noise():
    t = np.arange(32_770) / 48_000  # the buffer of phyphox
    noise = np.random.default_rng(0).normal(0, 1e-3, t.size)
    for turns, between in ((20, (2.0, 200.0)), (40, (2.0, 200.0)), (40, (28.0, 60.0))):
        phase = 2 * np.pi * (turns * t + turns * t**2 / 8)
        sound = 0.3 * (1 + 0.6 * np.cos(phase)) * np.sin(2 * np.pi * 5000 * t) + noise
        many = round(phase[-1] / (2 * np.pi))
        with pytest.raises(
            ValueError, match=rf"^sound: too short: ({many - 1}|{many}) turns, at least 32 needed"
        ):
            sc.data.wobble(t, sound, between=between)
    # a longer recording may have too few audible turns
    t = np.arange(5 * 48_000) / 48_000
    loud = np.where((t > 2) & (t < 3), 0.3, 0.0) * (1 + 0.6 * np.cos(2 * np.pi * 28 * t))
    sound = loud * np.sin(2 * np.pi * 5000 * t) + np.random.default_rng(0).normal(0, 1e-3, t.size)
    with pytest.raises(ValueError, match=r"too short: 2\d turns in a row are audible, at least 34 needed"):
        sc.data.wobble(t, sound, between=(15.0, 60.0))


def rolled(law=sc.loss.DryContour, noise=1e-3, share=0.9, seed=2):
    """Rates of a rolling disk, from some time after its centre was at rest."""
    drift = sc.drift(DISK.natural, 0.4, law(1e-3), centre="rolling")
    t = np.linspace(0.08, share, 24) * drift.stops_at
    precession = drift.precession(t) * (1 + noise * np.random.default_rng(seed).normal(size=t.size))
    return t, precession, noise * drift.precession(t)


def test_both_places_of_the_centre_are_in_one_table_and_a_body_that_rolls_is_known_for_it():
    t, precession, errors = rolled()
    laws = [sc.loss.DryContour, sc.loss.ViscousContour]
    given = {"precession": precession, "precession_err": errors, "body": DISK.natural, "laws": laws}
    found = sc.data.fit_losses(t, **given)
    assert {(fit.name, fit.centre) for fit in found.fits} == {
        (law.__name__, centre) for law in laws for centre in ("rest", "rolling")
    }
    assert (found.best.name, found.best.centre, found.centre) == ("DryContour", "rolling", "either")
    assert abs(found.best.coefficient - 1e-3) < 4 * found.best.coefficient_err < 2e-4
    # the centre was at rest before the first time, and the fitted drift continues from there
    assert 0.3 < found.best.theta < found.best.rested < 0.6 and np.isnan(found.of(laws[0], "rest").rested)
    shown = found.best.drift.precession(t - t[0])
    assert precession - shown == pytest.approx(found.best.residual["precession"], abs=1e-6 * precession.max())
    rows = found.table().splitlines()
    assert rows[0].split()[:2] == ["law", "centre"] and rows[1].split()[:2] == ["DryContour", "rolling"]
    assert "rolling" in repr(found) and "DryContour, rolling" in found._repr_html_()
    # the same law with the centre at rest is another row, from which it is told apart
    assert found.told_apart == (found.fits[1].daic > 6)
    with pytest.warns(UserWarning, match="no law explains"):
        alone = sc.data.fit_losses(t, **given, centre="rest")
    with pytest.raises(KeyError, match="DryContour was not fitted"):
        alone.of(laws[0], "rolling")


def test_a_law_that_cannot_be_is_a_row_with_its_reason():
    balls = sc.Body.balls()
    down = sc.drift(balls, np.radians(77), sc.loss.RollingResistance(2e-3))
    t = np.linspace(0.0, 0.4 * down.stops_at, 40)
    theta = down.theta(t) + np.random.default_rng(0).normal(0, 1e-3, t.size)
    laws = [sc.loss.RollingResistance, sc.loss.AirFilm]
    found = sc.data.fit_losses(t, theta, body=balls, laws=laws, centre="rest")
    assert found.best.coefficient == pytest.approx(2e-3, rel=0.05) and len(found.fits) == 1
    assert [(no.name, no.centre) for no in found.refused] == [("AirFilm", "rest")]
    assert "AirFilm: not fitted: fillet = 1.0: expected a body with a flat face" in found.table()
    with pytest.raises(KeyError, match="AirFilm was not fitted: fillet"):
        found.of(sc.loss.AirFilm)
    with pytest.raises(ValueError, match="expected a body with a flat face"):
        sc.data.fit_losses(t, theta, body=balls, laws=laws[1:])


def test_a_false_point_is_named_and_makes_no_law_sure():
    drift = sc.drift(DISK, 0.35, sc.loss.ViscousContour.from_si(5e-6, scale=DISK))
    t = np.linspace(0.1, 0.8, 12) * drift.stops_at
    precession = drift.precession(t)
    errors = 1e-3 * precession
    precession[0] *= 1.1
    with pytest.warns(
        UserWarning, match=rf"no law explains .* most of chi2 is due to t = {t[0]:.4g} s \(\d+ %\)"
    ):
        found = sc.data.fit_losses(t, precession=precession, precession_err=errors, body=DISK, centre="rest")
    clean = sc.data.fit_losses(
        t[1:], precession=precession[1:], precession_err=errors[1:], body=DISK, centre="rest"
    )
    best = clean.best
    assert best.name == "ViscousContour"
    own = found.of(sc.loss.ViscousContour)
    assert abs(own.coefficient - best.coefficient) < 4 * own.coefficient_err, (
        "the error grows with the scatter"
    )


@pytest.mark.parametrize("seed", few([6, 15, 25, 17, 22, 113], 3))
def test_a_made_up_recording_gives_its_law_or_says_that_it_does_not_know(seed):
    kind, said = recordings.verdict(seed, rivals=("DryContour", "AirLinear"))
    assert kind in ("right", "undecided"), said


def test_balls_that_are_measured_beyond_90_degrees_are_fitted():
    top = sc.Body.ball(-0.25, 0.42, 0.4)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pieces = _curve.branches(top, "rest")
    assert max(piece[-1] for piece in pieces) > np.radians(100)
