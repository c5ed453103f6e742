"""A measured body speaks hertz, millimetres, newtons and seconds: what is given in them comes back in them."""

import warnings

import numpy as np
import pytest
from loss_rows import ROWS

import spincyl as sc

INCH = 25.4e-3
MEASURES = {"outer_diameter": 0.625 * INCH, "inner_diameter": 0.5 * INCH, "length": 3.75 * INCH}
TUBE = sc.measured(**MEASURES, mass=0.02)
THETA = np.radians([5.0, 7.0, 73.0, 77.0, 82.0])
HERTZ = TUBE.hertz(THETA) * (1 + 0.01 * np.array([1, -1, 0.5, -0.5, 0.2]))


@pytest.mark.parametrize("body", [TUBE, sc.Body.from_metres(**MEASURES)], ids=["measured", "from metres"])
def test_a_comparison_of_turns_a_second_is_that_of_the_reduced_rates(body):
    err = {"theta_err": 0.01}
    one = sc.data.compare(body, THETA, hertz=HERTZ, hertz_err=0.02 * HERTZ, **err)
    rate = HERTZ / TUBE.critical_hertz
    two = sc.data.compare(body, THETA, rate, rate_err=0.02 * rate, **err)
    assert (one.ratio, one.ratio_err, one.chi2) == pytest.approx(
        (two.ratio, two.ratio_err, two.chi2), rel=1e-9
    )
    np.testing.assert_allclose(one.hertz, HERTZ, rtol=1e-14)
    np.testing.assert_allclose(one.hertz_err, 0.02 * HERTZ, rtol=1e-14)
    assert np.isnan(two.hertz).all()
    assert "turns a second" in one.report() and "turns a second" not in two.report()
    assert "turns a second" in one._repr_html_()


@pytest.mark.parametrize(
    ("given", "error", "told"),
    [
        ({}, TypeError, "^rate, hertz: give exactly one of them"),
        ({"rate": HERTZ, "hertz": HERTZ}, TypeError, "^rate, hertz: give exactly one of them"),
        ({"hertz": HERTZ, "theta_err": 0.1, "rate_err": 0.1}, TypeError, "^rate_err: .* give hertz_err="),
        ({"rate": HERTZ, "theta_err": 0.1, "hertz_err": 0.1}, TypeError, "^hertz_err: .* give rate_err="),
        ({"hertz": HERTZ, "hertz_err": 0.1}, ValueError, "^theta_err and hertz_err: give both or none"),
        ({"hertz": -HERTZ}, ValueError, "^hertz: expected positive numbers"),
        ({"hertz": HERTZ[:3]}, ValueError, "^theta and hertz: expected equal shapes"),
        ({"hertz": "fast"}, TypeError, "^hertz: expected real numbers"),
        (
            {"body": sc.Body.solid(6.0), "hertz": HERTZ},
            ValueError,
            "^body: the size of the body is unknown; make the body with sc.measured",
        ),
    ],
)
def test_what_is_no_comparison_in_hertz_is_refused_by_name(given, error, told):
    with pytest.raises(error, match=told):
        sc.data.compare(**{"body": TUBE, "theta": THETA} | given)


def test_turns_a_second_that_were_taken_for_reduced_rates_are_asked_for_by_their_name():
    with pytest.warns(UserWarning, match="give turns per second as hertz="):
        sc.data.compare(TUBE, THETA, HERTZ)


def curves(ax):
    """The curves of branches: their abscissas and ordinates."""
    return [line.get_xydata() for line in ax.lines if line.get_marker() == "None"]


def test_branches_in_hertz_are_those_in_reduced_rates_times_the_critical_rate():
    plt = pytest.importorskip("matplotlib.pyplot")
    wide = sc.measured(outer_diameter="30mm", length="40mm")
    for bodies in (TUBE, [TUBE], [TUBE, wide]):
        fast, plain = (
            sc.plot.branches(bodies, hertz=True),
            sc.plot.branches(bodies, ax=plt.figure().subplots()),
        )
        ones = [body.critical_hertz for body in (bodies if isinstance(bodies, list) else [bodies])]
        assert fast.get_xlabel() == "turns per second"
        assert fast.get_xlim()[1] == pytest.approx(3 * max(ones))
        inside = [xy[xy[:, 0] < 3 * min(ones)] for xy in curves(fast)]
        both = np.concatenate(inside)
        for one, body in zip(ones, bodies if isinstance(bodies, list) else [bodies], strict=True):
            own = np.abs(body.rate(np.radians(both[:, 1])) * one / both[:, 0] - 1) < 1e-9
            assert own.sum() > 500
        assert len(fast.texts) == len(plain.texts)
        plt.close("all")


def test_the_marks_of_branches_in_hertz_are_at_their_turns_a_second():
    plt = pytest.importorskip("matplotlib.pyplot")
    ax = sc.plot.branches(TUBE, hertz=True, rate_max=20)
    spots = {text.get_text(): text.xy for text in ax.texts if len(text.get_text()) == 1}
    assert spots["B"] == pytest.approx((TUBE.critical_hertz, 90.0)) and spots["C"][0] == 20
    ridge = sc.plot.landmarks(TUBE)[-1]
    assert ridge.letter == "G" and spots["G"][0] == pytest.approx(TUBE.hertz(ridge.theta))
    plt.close("all")


def test_the_picture_of_a_comparison_in_hertz_is_in_hertz():
    plt = pytest.importorskip("matplotlib.pyplot")
    ax = sc.data.compare(TUBE, THETA, hertz=HERTZ).plot()
    assert ax.get_xlabel() == "turns per second"
    (bars,) = ax.containers
    np.testing.assert_allclose(bars.lines[0].get_xdata(), HERTZ, rtol=1e-14)
    with pytest.raises(ValueError, match="^ells: the size of the body is unknown"):
        sc.plot.branches([2.5], hertz=True)
    plt.close("all")


LAWS = {law.__name__: row.printed for law, row in ROWS.items()}


@pytest.mark.parametrize("name", LAWS)
def test_a_coefficient_is_printed_with_the_unit_in_which_it_is_given_back(name):
    disk = sc.measured(outer_diameter="75.1mm", length="12.8mm", mass=1.0)
    kind = getattr(sc.loss, name)
    with warnings.catch_warnings(action="error"):  # a mass of one kilogram is a mass
        law = kind.from_si(LAWS[name], scale=disk)
        assert str(law) == f"{name}({LAWS[name]})"
    assert kind.from_si(LAWS[name].replace(" ", ""), scale=disk) == law
    both = kind(1e-3) + sc.loss.DryContour.from_si("1mm", scale=disk)
    assert "DryContour" in str(both) and (str(both) == f"{name}(0.001) + DryContour(1 mm)") == (
        name != "DryContour"
    )
    assert str(kind(0.25)) == f"{name}(0.25)" and repr(kind(0.25)) == f"{name}(0.25)"


def test_a_fitted_coefficient_and_its_error_are_there_in_si():
    disk = sc.measured(outer_diameter="75.1mm", length="12.8mm", mass=0.44)
    true = sc.loss.ViscousContour.from_si("1.5e-6 N m s", scale=disk)
    drift = sc.drift(disk, 0.3, true)
    t = np.linspace(0.0, 0.95 * drift.stops_at, 40)
    theta = drift.theta(t) * np.random.default_rng(1).normal(1, 0.01, 40)
    found = sc.data.fit_losses(
        t, theta, body=disk, laws=[sc.loss.ViscousContour, sc.loss.DryContour], centre="rest"
    )
    (si,), (err,) = found.best.coefficients_si, found.best.coefficient_errs_si
    assert abs(si - 1.5e-6) < 4 * err and err / si == pytest.approx(
        found.best.coefficient_err / found.best.coefficient
    )
    assert f"{si:.4g} +- {err:.1g} N m s" in found.table() and "mm" in found.table()
    assert "(N m s)" in found.report() and " N m s" in repr(found) and " N m s" in found._repr_html_()
    bare = sc.data.fit_losses(
        t / disk.scale.seconds(1.0), theta, body=disk.natural, laws=[sc.loss.ViscousContour], centre="rest"
    )
    assert "N m s" not in bare.table()
    with pytest.raises(TypeError, match="scale"):
        bare.best.coefficients_si


def test_a_spin_down_in_turns_a_second_is_that_in_radians_a_second():
    disk = sc.measured(outer_diameter="75.1mm", length="12.8mm", mass=0.44)
    drift = sc.drift(disk, 0.3, sc.loss.ViscousContour.from_si("1.5e-6 N m s", scale=disk))
    t = np.linspace(0.0, 0.9 * drift.stops_at, 30)
    hertz = disk.scale.turns(drift.precession(t) * disk.scale.seconds(1.0))
    how = {"body": disk, "laws": [sc.loss.ViscousContour], "centre": "rest"}
    one = sc.data.fit_losses(t, hertz=hertz, hertz_err=0.1, **how)
    two = sc.data.fit_losses(t, precession=2 * np.pi * hertz, precession_err=2 * np.pi * 0.1, **how)
    assert one == two and one.best.coefficients_si == pytest.approx(1.5e-6, rel=1e-6)
    for more, error, told in (
        ({"precession": hertz, "hertz": hertz}, TypeError, "^precession, hertz: give only one of them"),
        ({"precession": hertz, "hertz_err": 0.1}, TypeError, "^precession, hertz: give only one of them"),
        ({"hertz": hertz, "body": disk.natural}, ValueError, "^hertz: needs a measured body"),
        ({"hertz": "fast"}, TypeError, "^hertz: "),
    ):
        with pytest.raises(error, match=told):
            sc.data.fit_losses(t, **how | more)
