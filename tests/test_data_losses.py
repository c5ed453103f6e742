"""Measured spin-downs: drifts are fitted, and loss laws are told apart where the data allow."""

import warnings
from functools import cache

import numpy as np
import pytest
from scenes import LAWS

import spincyl as sc
from spincyl.lab import _curve, _line, _typical

EULER = sc.Body.from_metres(outer_diameter=0.0751, length=0.0128)
COIN = sc.Body.solid(0.0)
CYLINDER = sc.Body.solid(2.5)
ALL = list(LAWS)
named = pytest.mark.parametrize("law", ALL, ids=lambda law: law.__name__)


def spun(law, body=EULER, start=0.3, points=100, share=0.95, noise=0.01, seed=1, centre="rest"):
    """Times, inclinations and rates with relative noise, and the true drift."""
    rng = np.random.default_rng(seed)
    drift = sc.drift(body, start, law, centre=centre)
    stop = drift.stops_at if np.isfinite(drift.stops_at) else float(drift.time(start / 10))
    t = np.linspace(0.0, share * stop, points)
    theta, precession = (
        f(t) * (1 + noise * rng.normal(size=points)) for f in (drift.theta, drift.precession)
    )
    return t, theta, precession, drift


@named
@pytest.mark.parametrize("given", ["theta", "precession"])
def test_exact_points_give_the_coefficient_and_the_stopping_time(law, given):
    t, theta, precession, true = spun(law(1e-4), points=60, noise=0.0)
    found = sc.data.fit_losses(
        t, **{given: theta if given == "theta" else precession}, body=EULER, laws=[law]
    )
    assert found.best.coefficient == pytest.approx(1e-4, rel=1e-7)
    assert found.best.theta == pytest.approx(0.3, rel=1e-7)
    assert found.best.stops_at == pytest.approx(float(true.stops_at), rel=1e-7)
    assert found.best.law == law(found.best.coefficient)


@cache
def noisy(law):
    """Times, noisy inclinations, and the fit of every law to them."""
    t, theta, _, _ = spun(law(1e-4))
    return t, theta, sc.data.fit_losses(t, theta, body=EULER, centre="rest")


SOME = (sc.loss.DryContour, sc.loss.AirFilm)


@pytest.mark.parametrize(
    "law", [law if law in SOME else pytest.param(law, marks=pytest.mark.long) for law in ALL]
)
def test_a_law_is_known_for_what_it_is_through_noise(law):
    _, theta, found = noisy(law)
    assert found.best.name == law.__name__ and found.told_apart
    assert len(found.fits) == len(LAWS) and found.fits[1].daic > 30
    assert found.best.coefficient == pytest.approx(1e-4, abs=4 * found.best.coefficient_err)
    assert found.best.coefficient_err < 1e-6
    assert found.best.chi2 == pytest.approx(1.0, abs=0.02)
    assert found.theta_err == pytest.approx(0.01 * theta, rel=0.3)


long = [pytest.param(how, marks=pytest.mark.long) for how in ("known", "estimated", "precession", "both")]


@pytest.mark.parametrize("how", ["times too", *long])
def test_the_errors_are_those_of_many_repetitions(how):
    law, pulls, stops = sc.loss.ViscousContour, [], []
    for seed in range(80):
        t, theta, precession, true = spun(law(1e-3), points=60, seed=seed)
        more = {}
        if how == "known":
            more["theta_err"] = 0.01 * true.theta(t)
        if how == "times too":
            wrong = 3e-3 * t[-1]
            t = t + wrong * np.random.default_rng(seed + 1000).normal(size=t.size)
            more = {"t_err": wrong, "theta_err": 0.01 * true.theta(t.clip(0.0))}
        given = {"precession": precession} if how == "precession" else {"theta": theta}
        given |= {"precession": precession} if how == "both" else {}
        found = sc.data.fit_losses(t, **given, body=EULER, laws=[law], centre="rest", **more).best
        pulls.append((found.coefficient - 1e-3) / found.coefficient_err)
        stops.append((found.stops_at - true.stops_at) / found.stops_at_err)
    # 80 standard normal numbers: standard errors are 0.08 for the spread and 0.11 for the mean
    for numbers in (pulls, stops):
        assert 0.75 < np.std(numbers) < 1.3 and abs(np.mean(numbers)) < 0.5


def test_errors_that_are_given_count_and_those_that_are_not_come_from_the_scatter():
    t, theta, _, true = spun(sc.loss.DryContour(1e-3), noise=1e-4)
    given = sc.data.fit_losses(t, theta, body=EULER, laws=ALL[:1], theta_err=0.01 * true.theta(t))
    found = sc.data.fit_losses(t, theta, body=EULER, laws=ALL[:1])
    assert given.estimated == () and found.estimated == ("theta",)
    assert given.best.chi2 < 1e-3 and found.best.chi2 == pytest.approx(1.0, abs=0.01)
    assert found.best.coefficient_err == pytest.approx(
        given.best.coefficient_err * np.sqrt(given.best.chi2), rel=0.1
    )
    assert "errors of theta from its scatter" in found.table() and "scatter" not in given.table()


def test_what_was_not_measured_at_a_time_is_left_out():
    t, theta, precession, _ = spun(sc.loss.DryContour(1e-3), points=80, noise=0.0)
    theta[::2], precession[1::2] = np.nan, np.nan
    theta[7] = t[9] = np.nan
    found = sc.data.fit_losses(t, theta, precession, body=EULER, laws=ALL[:1])
    assert found.best.coefficient == pytest.approx(1e-3, rel=1e-7)
    assert len(found.t) == 78 and np.isnan(found.best.residual["theta"]).sum() == 40
    assert np.nanmax(np.abs(found.best.residual["precession"])) < 1e-6


def test_scaling_the_clock_scales_the_coefficient():
    t, theta, _, _ = spun(sc.loss.AirFilm(1e-3))
    one, two = (sc.data.fit_losses(k * t + k, theta, body=EULER, laws=[sc.loss.AirFilm]).best for k in (1, 2))
    assert two.coefficient == pytest.approx(one.coefficient / 2, rel=1e-5)
    assert two.coefficient_err == pytest.approx(one.coefficient_err / 2, rel=1e-3)
    assert two.stops_at == pytest.approx(2 * one.stops_at, rel=1e-6)
    assert two.chi2 == pytest.approx(one.chi2) and two.correlation == pytest.approx(one.correlation, rel=1e-3)


def test_two_laws_that_add_are_found_beside_each_other():
    laws = sc.loss.DryContour, sc.loss.RollingResistance
    t, theta, _, _ = spun(laws[0](1e-3) + laws[1](4e-3), points=160, share=0.97)
    found = sc.data.fit_losses(t, theta, body=EULER, laws=[*laws, list(laws)])
    assert found.best is found.of(laws) and found.best.name == "DryContour + RollingResistance"
    for k, true in enumerate((1e-3, 4e-3)):
        assert found.best.coefficients[k] == pytest.approx(true, abs=4 * found.best.coefficient_errs[k])
        assert found.best.coefficient_errs[k] < 0.02 * true
    assert -0.999 < found.best.correlation < -0.5
    assert found.of(laws[0]).daic > 100
    with pytest.raises(KeyError):
        found.of(sc.loss.AirFilm)
    with pytest.raises(ValueError, match="unpack"):
        found.best.coefficient


def test_a_sum_of_laws_that_cannot_be_told_apart_is_refused_by_name():
    t, theta, _, _ = spun(sc.loss.DryContour(1e-3), points=12, share=0.2)
    for second in (sc.loss.ViscousContour, sc.loss.BoundaryLayer):
        said = f"cannot distinguish DryContour from {second.__name__}"
        with pytest.raises(ValueError, match=said):
            sc.data.fit_losses(t, theta, body=EULER, laws=[(sc.loss.DryContour, second)])


def test_coefficients_that_only_their_sum_is_known_of_are_refused_however_exact_the_points():
    laws = sc.loss.DryContour, sc.loss.ViscousContour
    t, theta, _, _ = spun(laws[0](1e-3) + laws[1](1e-4), points=60, share=0.2, noise=1e-8)
    with pytest.raises(
        ValueError, match=r"cannot distinguish .*, since the correlation of their coefficients is -0\.999"
    ):
        sc.data.fit_losses(t, theta, body=EULER, laws=[laws])


def test_single_laws_that_are_not_told_apart_are_no_error_but_said():
    t, theta, _, _ = spun(sc.loss.DryContour(1e-3), points=12, share=0.2)
    found = sc.data.fit_losses(t, theta, body=EULER)
    assert not found.told_apart and "not told apart from others" in repr(found)
    rows = found.table().splitlines()
    assert rows[1].endswith("best") and rows[2].endswith("not told apart")
    told = noisy(sc.loss.DryContour)[2]
    assert told.told_apart and "not told apart" not in told.table() + repr(told)
    assert [f.daic for f in told.fits] == sorted(f.daic for f in told.fits) and told.fits[0].daic == 0


def test_a_cylinder_on_its_side_drifts_up_and_is_fitted_there():
    law = sc.loss.DryContour
    t, theta, precession, true = spun(law(1e-3), CYLINDER, 1.2, noise=1e-3)
    assert true.theta(t[-1]) > 1.2
    by_theta = sc.data.fit_losses(t, theta, body=CYLINDER, laws=[law])
    by_precession = sc.data.fit_losses(t, precession=precession, body=CYLINDER, laws=[law], start=1.2)
    for found in (by_theta, by_precession):
        assert found.best.coefficient == pytest.approx(1e-3, abs=4 * found.best.coefficient_err)
        assert found.best.coefficient_err < 5e-5 and found.line is None
        assert found.best.stops_at == pytest.approx(float(true.stops_at), abs=4 * found.best.stops_at_err)


def test_rolling_drifts_are_fitted_with_rolling():
    law = sc.loss.DryContour
    t, theta, _, _ = spun(law(1e-3), centre="rolling", points=80)
    found = sc.data.fit_losses(t, theta, body=EULER, laws=[law], centre="rolling").best
    assert found.coefficient == pytest.approx(1e-3, abs=4 * found.coefficient_err)
    # the other drift fits too, with another coefficient
    other = sc.data.fit_losses(t, theta, body=EULER, laws=[law], centre="rest").best
    assert abs(other.coefficient - 1e-3) > 4 * other.coefficient_err


def test_rates_that_several_inclinations_could_have_need_a_start():
    # on its side, or on its end above the ridge: on both branches the precession falls to 1
    law, can = sc.loss.DryContour, sc.Body.solid(0.9)
    t, _, precession, _ = spun(law(1e-3), can, 1.2, noise=0.0)
    with pytest.raises(
        ValueError,
        match=r"precession: the drift may start at 0\.\d+ or 1\.2 rad; give theta=, or the right one",
    ):
        sc.data.fit_losses(t, precession=precession, body=can, laws=[law])
    found = sc.data.fit_losses(t, precession=precession, body=can, laws=[law], start=1.0, centre="rest").best
    assert found.theta == pytest.approx(1.2, rel=1e-6) and found.coefficient == pytest.approx(1e-3, rel=1e-6)


def test_the_log_log_line_is_biased_by_more_than_it_claims():
    t, theta, precession, _ = spun(sc.loss.ViscousContour(1e-3))
    line = sc.data.fit_losses(t, theta, body=EULER, laws=[sc.loss.ViscousContour]).line
    assert -0.03 < line.exponent - 1 / 2 < -3 * line.exponent_err < 0
    line = sc.data.fit_losses(t, precession=precession, body=EULER, laws=[sc.loss.ViscousContour]).line
    assert 0.005 < line.exponent + 1 / 4 < 0.03
    # for an exact power the line has the true exponent and stopping time
    power = _line.line(t, 0.3 * (100 - t) ** (2 / 3))
    assert power.exponent == pytest.approx(2 / 3, abs=1e-6) and power.stops_at == pytest.approx(100, abs=1e-3)
    assert power.factor == pytest.approx(0.3, rel=1e-5)
    assert _line.line(t, np.exp(-t)) is None


def test_the_error_of_the_line_is_its_scatter_on_a_true_power():
    rng, t = np.random.default_rng(7), np.linspace(0, 90, 100)
    lines = [_line.line(t, (100 - t) ** 0.5 * (1 + 0.01 * rng.normal(size=100))) for _ in range(60)]
    pulls = [(line.exponent - 0.5) / line.exponent_err for line in lines]
    assert 0.75 < np.std(pulls) < 1.3 and abs(np.mean(pulls)) < 0.5


def test_what_cannot_be_a_spin_down_is_refused_by_name():
    t, theta, precession, _ = spun(sc.loss.DryContour(1e-3), points=40, noise=0.0)
    rng = np.random.default_rng(5)
    inside = 0.5 * float(CYLINDER.theta_balance + CYLINDER.theta_limit)
    for given, said in (
        ({"theta": None}, "theta, precession: give at least one"),
        ({"t": t[:4], "theta": theta[:4]}, "t: expected at least 5 points"),
        ({"t": 0 * t}, "t: expected at least 5 points"),
        ({"theta": theta[:5]}, r"theta: expected the shape of t, \(40,\)"),
        ({"t": t[:, None]}, r"t: expected shape \(n,\)"),
        ({"t": t[::-1]}, "t: expected times in ascending order"),
        ({"theta": theta[::-1]}, "theta: rises, but .* drifts to smaller inclinations"),
        ({"theta": None, "precession": 1e-3 * precession}, "precession: no drift of this body has"),
        (
            {"theta": rng.uniform(0.1, 0.3, 40)},
            "theta: expected values that rise or fall with t; their rank correlation",
        ),
        ({"theta": -theta}, r"^theta\[0\] = -0\.\d+: expected a positive number, or NaN if it is missing$"),
        ({"theta": np.degrees(theta)}, "theta: expected inclinations .* radians"),
        ({"precession": 0 * precession}, r"^precession\[0\] = 0: expected a positive number"),
        ({"theta_err": 0.0}, "theta_err: expected positive"),
        ({"theta_err": [0.1, 0.2]}, "theta_err: expected a number"),
        ({"t_err": np.nan}, "t_err: expected positive"),
        ({"precession_err": 0.1}, "precession_err: give precession as well"),
        ({"centre": "slipping"}, "centre = 'slipping'"),
        ({"start": 0.0}, "start = 0.0"),
        ({"laws": []}, "laws: expected at least one"),
        ({"laws": ALL[:1] * 2}, "each law only once"),
        ({"laws": [tuple(ALL[:3])]}, "laws: expected one law, or a sum"),
        ({"laws": [(ALL[0], ALL[0])]}, "laws: expected one law, or a sum"),
        ({"body": sc.Body.solid([1.0, 2.0])}, "body: expected a single"),
        ({"body": CYLINDER, "theta": theta + inside - 0.25}, "theta: .* forbidden band"),
    ):
        with pytest.raises(ValueError, match=said):
            sc.data.fit_losses(**({"t": t, "theta": theta, "body": EULER, "laws": ALL[:1]} | given))
    for given, said in (
        ({"body": 2.5}, "body"),
        ({"theta": "steep"}, "theta"),
        ({"laws": "DryContour"}, "laws"),
        ({"laws": [sc.loss.DryContour(1e-3)]}, "laws: expected a class of sc.loss"),
    ):
        with pytest.raises(TypeError, match=said):
            sc.data.fit_losses(**({"t": t, "theta": theta, "body": EULER} | given))


def test_noise_below_zero_near_the_end_is_refused_with_its_row_and_left_out_as_nan():
    t, theta, _, _ = spun(sc.loss.DryContour(1e-3), share=0.9)
    theta[93] = -0.0012
    said = r"^theta\[93\] = -0.0012: expected a positive number.* near the end\? Leave out the last points"
    with pytest.raises(ValueError, match=said):
        sc.data.fit_losses(t, theta, body=EULER, laws=ALL[:1])
    theta[93] = np.nan
    assert len(sc.data.fit_losses(t, theta, body=EULER, laws=ALL[:1]).t) == 99


def test_milliseconds_that_were_given_for_seconds_are_warned_of_by_the_typical_coefficients():
    disk = sc.measured(outer_diameter="75mm", length="12.7mm", mass="440g")
    t, theta, _, _ = spun(sc.loss.DryContour.from_si("0.01mm", scale=disk), disk)
    laws = [sc.loss.AirLinear, sc.loss.DryContour]
    right = sc.data.fit_losses(t, theta, body=disk, laws=laws).best
    said = (
        r"^eps = 1e-05 mm is far from the typical 0.003 to 0.1 mm of DryContour .* are the times in seconds"
    )
    with pytest.warns(UserWarning, match=said) as caught:
        wrong = sc.data.fit_losses(1e3 * t, theta, body=disk, laws=laws).best
    assert len(caught) == 1 and caught[0].filename == __file__
    assert wrong.coefficient == pytest.approx(right.coefficient / 1e3, rel=1e-6)
    # no typical coefficients are known for this law, or without the size of the body
    sc.data.fit_losses(1e3 * t, theta, body=disk, laws=laws[:1])
    sc.data.fit_losses(1e3 * t, theta, body=disk.natural, laws=laws)


def test_a_small_second_loss_is_no_reason_to_doubt_the_unit_of_the_times():
    disk = sc.measured(outer_diameter="75mm", length="12.7mm", mass="440g")
    film = sc.loss.AirFilm.from_si(1.8e-5, scale=disk)
    far, near = (sc.loss.DryContour.from_si(x, scale=disk) for x in ("1e-5mm", "0.01mm"))
    assert _typical.far_from_typical(far + film, disk.scale) == ""
    assert _typical.far_from_typical(near, disk.scale) == ""
    assert "eps = 1e-05 mm" in _typical.far_from_typical(far, disk.scale)


def test_a_spin_down_that_no_law_explains_is_warned_of():
    t, theta, _, _ = spun(sc.loss.DryContour(1e-3), points=40)
    theta = theta * (1 + 0.3 * np.sin(20 * t / t[-1]))
    with pytest.warns(UserWarning, match="no law explains"):
        found = sc.data.fit_losses(t, theta, body=EULER, theta_err=0.01 * theta)
    assert found.best.chi2 > 10
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sc.data.fit_losses(t, theta, body=EULER, laws=ALL[:1])


def test_points_after_the_stop_do_not_break_the_fit():
    # an error of the clock larger than the time left
    t, theta, _, true = spun(sc.loss.DryContour(1e-3), share=0.999, points=60)
    t = t.copy()
    t[-1] = 1.01 * float(true.stops_at)
    found = sc.data.fit_losses(t, theta, body=EULER, laws=ALL[:1], t_err=0.005 * t[-1]).best
    assert found.coefficient == pytest.approx(1e-3, rel=0.02)
    assert found.stops_at == pytest.approx(float(true.stops_at), rel=0.02)


def test_the_plot_shows_data_residuals_and_the_line_that_is_biased():
    import matplotlib.pyplot as plt

    t, theta, precession, _ = spun(sc.loss.DryContour(1e-3), points=50)
    found = sc.data.fit_losses(t, theta, precession, body=EULER, centre="rest", t_err=0.1)
    data, rest, logs = found.plot()
    assert data.containers[0].has_xerr and data.containers[0].has_yerr
    words = [text.get_text() for text in data.get_legend().get_texts()]
    assert "DryContour" in words and "measured" in words and sum("AIC" in word for word in words) == 3
    assert "DryContour" in rest.get_title() and len(rest.get_legend().get_texts()) == 2
    assert "quick look only, biased" in logs.get_title()
    assert f"{found.line.exponent:.3f}" in logs.get_legend().get_texts()[0].get_text()
    _, axes = plt.subplots(1, 3)
    assert found.plot(axes) == list(axes)
    t, theta, precession, _ = spun(sc.loss.AirLinear(1e-3), points=50)
    never = sc.data.fit_losses(t, precession=precession, body=EULER, laws=[sc.loss.AirLinear])
    drawn = never.plot()
    assert "precession" in drawn[0].get_ylabel() and np.isinf(never.best.stops_at)
    assert "never" in never.table()
    plt.close("all")


def test_a_fit_shows_itself_with_all_its_laws():
    found = noisy(sc.loss.DryContour)[2]
    assert repr(found).startswith("<LossFit: DryContour: 9.99") and repr(found.best).startswith(
        "<DryContour: "
    )
    card = found._repr_html_()
    assert card.count("ΔAIC") == len(LAWS) and "best" in card and "<svg" in card


def test_the_fitted_curve_goes_on_before_its_start_and_beyond_its_stop():
    # a trial with its stop before the last point must be drawn back to the point
    curve = _curve.Curve(EULER, [sc.loss.DryContour], "rest", (0.01, 0.3), True)
    stop = curve.stops_at([1e-3], 0.3)
    assert stop == pytest.approx(float(sc.drift(EULER, 0.3, sc.loss.DryContour(1e-3)).stops_at), rel=1e-9)
    assert curve.stops_at([1e-3], np.nextafter(0.3, 1.0)) == stop, "an end is met but for rounding"
    before, begin, last, beyond = curve(["theta"], stop * np.array([-0.1, 0.0, 1.0, 1.1]), [1e-3], 0.3)[0]
    drift = sc.drift(EULER, 0.3, sc.loss.DryContour(1e-3))
    assert begin == pytest.approx(0.3, rel=1e-9) and abs(last) < 1e-4 and beyond < -1.0
    tangent = (begin - float(drift.theta(1e-4 * stop))) / 1e-4
    assert before - begin == pytest.approx(0.1 * tangent, rel=1e-3)


def test_a_fit_does_not_depend_on_the_origin_of_time():
    """Stopwatch readings of the time that is left, at three inclinations; all but one lie beyond a law's drift."""
    coin = sc.measured(outer_diameter="25.75mm", length="2.2mm", mass="8.5g")
    left = np.array([1.84, 1.78, 1.77, 1.72, 0.99, 0.85, 0.40, 0.38, 0.33, 0.31])
    theta = np.radians([30, 30, 30, 30, 20, 20, 10, 10, 10, 10.0])
    laws = [sc.loss.DryContour, sc.loss.Drilling]
    fits = [sc.data.fit_losses(shift - left, theta, body=coin, laws=laws) for shift in (0.0, 5.0, -1.84, 1e4)]
    for shift, found in zip((0.0, 5.0, -1.84, 1e4), fits, strict=True):
        assert [(x.name, x.centre) for x in found.fits] == [(x.name, x.centre) for x in fits[0].fits]
        assert [x[:2] for x in found.refused] == [("Drilling", "rolling")]
        for one, first in zip(found.fits, fits[0].fits, strict=True):
            assert one.coefficient == pytest.approx(first.coefficient, rel=1e-6)
            assert one.stops_at - shift == pytest.approx(first.stops_at, abs=1e-6)
