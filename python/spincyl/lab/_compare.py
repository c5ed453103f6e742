"""Comparison of measured inclinations and rates with the steady states of a body."""

import math
import re
import warnings
from typing import TYPE_CHECKING, NamedTuple, overload

import numpy as np

from spincyl._body import Body
from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import Floats, Reals, number, optional_library, reals, turns_per_second
from spincyl._measured import sized_body
from spincyl._motion import Motion
from spincyl._single import one_body
from spincyl._upward import function_of_method
from spincyl.lab._balance import Balance, doubts_of_ratio, with_ratio
from spincyl.lab._beside import FilmComparison, beside
from spincyl.lab._filmed import Filmed
from spincyl.lab._points import LEAST, points
from spincyl.lab._report import counted, section, variables, with_error, written

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@compared_by_value
class Comparison(NamedTuple):
    """Measured inclinations and rates compared with the steady states of a body; returned by `compare`.

    Methods: ``report()`` and ``plot()``.

    Attributes
    ----------
    body : Body
        The body as built.
    theta : ndarray, (n,)
        Measured inclinations, radians, without missing points.
    rate : ndarray, (n,)
        Measured reduced rates.
    theta_err : ndarray, (n,)
        Standard errors of `theta`.
    rate_err : ndarray, (n,)
        Standard errors of `rate`.
    residual : ndarray, (n,)
        Measured rate minus the rate of the steady state at the measured inclination; NaN in the forbidden
        band.
    ratio : float
        The inertia ratio I1/I3 that fits best; NaN if there are only one or two points.
    ratio_err : float
        Standard error of `ratio`.
    expected : float
        Inertia ratio of `body`, the body as built.
    chi2 : float
        Sum of the squared deviations in units of their errors, per degree of freedom. For one or two points,
        the mean of the squares of `away`.
    factor : float
        Common factor of all measured rates, fitted if `common` was given.
    factor_err : float
        Standard error of `factor`; 0 if the factor was not fitted.
    correlation : float
        Correlation of ratio and factor; NaN if the factor was not fitted.
    common : float
        Standard error of the factor before the fit, as given.
    alone : float
        Common factor of the rates that fits best if the ratio is `expected`.
    alone_err : float
        Standard error of `alone`.
    alone_chi2 : float
        `chi2` of the fit that gives `alone`.
    unit : float
        Turns per second at the reduced rate 1; NaN unless `hertz` was given.
    away : ndarray, (n,)
        Distance of each point from the steady states of the body as built, in units of the errors of the
        point, to first order.
    hertz, hertz_err : ndarray, (n,)
        Measured turns per second and standard errors; NaN unless `hertz` was given.
    fitted : Body
        The body with the fitted ratio.
    """

    body: Body
    theta: Floats
    rate: Floats
    theta_err: Floats
    rate_err: Floats
    residual: Floats
    ratio: float
    ratio_err: float
    expected: float
    chi2: float
    factor: float = 1.0
    factor_err: float = 0.0
    correlation: float = math.nan
    common: float = 0.0
    alone: float = math.nan
    alone_err: float = math.nan
    alone_chi2: float = math.nan
    unit: float = math.nan
    away: Floats = np.empty(0)

    @property
    def _verdict(self) -> str:
        """Text that says whether the points agree with the body as built."""
        most = float(self.away.max())
        words = ("agrees with", "doubtful beside", "disagrees with")[(most > 2.0) + (most > 3.0)]
        return f"{most:.1f} errors from a steady state: {words} the body as built"

    @property
    def hertz(self) -> Floats:
        """(n,) measured turns per second; NaN unless `hertz` was given."""
        return self.rate * self.unit

    @property
    def hertz_err(self) -> Floats:
        """(n,) standard errors of `hertz`."""
        return self.rate_err * self.unit

    def __repr__(self) -> str:
        if math.isnan(self.ratio):
            return (
                f"<Comparison: {counted(len(self.theta))} point{'s'[: len(self.theta) - 1]}, {self._verdict}>"
            )
        return (
            f"<Comparison: I1/I3 = {with_error(self.ratio, self.ratio_err)}, built {self.expected:.4g};"
            f" {len(self.theta)} points, chi2 {self.chi2:.3g}>"
        )

    def _repr_html_(self) -> str:
        from spincyl.studio.cards import drawing, framed, span_in_words

        rows = [
            ("body", repr(self.body)),
            ("points", f"{len(self.theta)}, θ from {span_in_words(self.theta)}{self._rates()}"),
            ("I₁/I₃ that fits", with_error(self.ratio, self.ratio_err, "±")),
            ("I₁/I₃ as built", f"{self.expected:.6g}"),
            ("χ² per degree of freedom", f"{self.chi2:.3g}"),
        ]
        if math.isnan(self.ratio):
            rows[2:] = [("as built", self._verdict)]
        middle = self.theta[np.argsort(self.theta)[len(self.theta) // 2]]
        return framed("Comparison", rows, drawing(self.body, middle, "θ"))

    def _rates(self) -> str:
        """Text with the range of the turns per second, or "" if reduced rates were given."""
        low, high = self.hertz.min(), self.hertz.max()
        return "" if math.isnan(self.unit) else f", {low:.4g} to {high:.4g} turns a second"

    @property
    def fitted(self) -> Body:
        """The body with the fitted ratio, or with 1/2, the limit for real bodies, if the ratio is smaller.

        The body as built if there are only one or two points.
        """
        if math.isnan(self.ratio):
            return self.body
        return with_ratio(self.body, max(self.ratio, 0.5))

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """Draw the points with error bars, and the steady states of the body as built and as fitted."""
        shown = self if self.factor == 1 else self._replace(rate=self.rate / self.factor)
        drawn: Axes = function_of_method("Comparison.plot")(shown, ax)
        if self.factor != 1:
            drawn.set_xlabel(rf"{drawn.get_xlabel()}, measured over {self.factor:.4g}")
        return drawn

    def report(self) -> str:
        """Return the fitted values with their errors and correlation, as a report in lmfit's style."""
        if math.isnan(self.ratio):
            return "\n".join(section("Comparison", self._about_points()))
        varied = 1 + (self.factor_err > 0)
        rows = [
            ("body", repr(self.body)),
            ("# data points", str(len(self.theta)) + self._rates()),
            ("# variables", str(varied)),
            ("reduced chi-square", written(self.chi2)),
        ]
        away = (self.ratio - self.expected) / self.ratio_err if self.ratio_err > 0 else 0.0
        built = f"(built = {self.expected:.6g}, {abs(away):.1f} errors away)"
        note = "(fixed)"
        if self.factor_err > 0:
            known = "free" if math.isinf(self.common) else f"1 +/- {self.common:.3g} before"
            note = f"({known})"
        found = variables(
            [
                ("I1/I3", self.ratio, self.ratio_err, built),
                ("factor of the rates", self.factor, self.factor_err, note),
            ]
        )
        lines = section("Comparison", rows) + found
        if math.isfinite(self.correlation):
            lines += section("Correlations", [("C(I1/I3, factor)", f"{self.correlation:+.4f}")])
        if math.isfinite(self.alone):
            told = f"{self.alone:.4f} +/- {self.alone_err:.2g}, reduced chi-square {self.alone_chi2:.3g}"
            lines += section("As built, with a factor of the rates alone", [("factor", told)])
        return "\n".join(lines)

    def _about_points(self) -> list[tuple[str, str]]:
        """Rows of the report for one or two points: each with its distance from the nearest steady state."""
        rows = [("body", repr(self.body))]
        for theta, theta_err, rate, rate_err, away in zip(
            *(np.degrees(self.theta), np.degrees(self.theta_err), self.rate, self.rate_err, self.away),
            strict=True,
        ):
            seen = f"{with_error(theta, theta_err)} degrees at the rate {with_error(rate, rate_err)}"
            steady = np.degrees(np.atleast_1d(self.body.inclinations(rate=rate)))
            near = steady[np.isfinite(steady)]
            told = (
                f"steady at {near[np.abs(near - theta).argmin()]:.4g} degrees"
                if near.size
                else "never steady"
            )
            rows.append(("measured", f"{seen}, {told}: {away:.1f} errors"))
        return [*rows, ("verdict", self._verdict)]


@overload
def compare(body: Motion, theta: Filmed) -> FilmComparison: ...
@overload
def compare(
    body: Body,
    theta: Reals,
    rate: Reals | None = None,
    *,
    hertz: Reals | None = None,
    theta_err: Reals | None = None,
    rate_err: Reals | None = None,
    hertz_err: Reals | None = None,
    common: float = 0.0,
) -> Comparison: ...
def compare(
    body: Body | Motion,
    theta: Reals | Filmed,
    rate: Reals | None = None,
    *,
    hertz: Reals | None = None,
    theta_err: Reals | None = None,
    rate_err: Reals | None = None,
    hertz_err: Reals | None = None,
    common: float = 0.0,
) -> Comparison | FilmComparison:
    """Compare measured inclinations and rates with a body's steady states, and fit its inertia ratio.

    A motion is compared with a whole film: ``compare(motion, film)``.

    Parameters
    ----------
    body : Body or Motion
        Single body with the aspect ratio and the moments of inertia as built. Or the motion of a body of
        revolution on a level table, to compare with a film; both have the same time 0.
    theta : array_like, 1-D or a number, or Filmed
        For a motion: the film, as `from_above` returns it, and no further arguments. For a body: Measured
        inclinations in radians, up to pi/2, or larger for balls and other bodies that have steady states
        beyond pi/2. One or two points, such as a single film, need their errors: they are compared with the
        body as built, and no ratio is fitted.
    rate : array_like, 1-D or a number
        Measured reduced rates: turns per second divided by `body.critical_hertz`.
    hertz : array_like, 1-D
        Turns per second instead of `rate`, for a measured body or one from `Body.from_metres`.
    theta_err, rate_err or hertz_err : array_like, optional
        Standard errors of the inclinations and of the rates; give both or none. Default: the points are
        weighted for errors of one degree and two per cent, and the error of the ratio follows from their
        scatter.
    common : float
        Relative standard error that all rates have in common, for example from the radius or the frame rate
        of the film; 0.03 means three per cent. A common factor of the rates is then fitted as well, and the
        error of the ratio includes its uncertainty. Use inf if the factor is unknown. Default: 0, no factor.

    Returns
    -------
    Comparison, or FilmComparison for a film
        ``.report()`` summarises the result.

    Raises
    ------
    ValueError
        If there are fewer than three different points without errors, shapes differ, or rates or errors are
        not positive. If the fit fails. If the points do not determine the ratio, or do not distinguish it
        from a common factor. If a film and a motion have fewer than three frames in common, or the film has
        no errors.
    TypeError
        If an argument is not a body or real numbers; the message names it.
    ImportError
        If odrpack is missing: install spincyl[lab].

    Warns
    -----
    UserWarning
        If chi2 exceeds 10. If all rates seem to be wrong by a common factor. If the fitted ratio is more than
        three errors from the ratio as built, but a common factor of the rates fits the points equally well.

    Notes
    -----
    The fit is an orthogonal distance regression (Boggs and Donaldson 1989) by odrpack, which takes account of
    the errors of both variables. The curve has the implicit equation theta'' = 0, so it may have forbidden
    bands and folds. Points with NaN as theta or rate are left out.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> body = sc.Body.solid(2.5)
    >>> theta = np.radians([5.0, 10.0, 15.0, 70.0, 80.0])
    >>> found = sc.data.compare(body, theta, body.rate(theta))
    >>> round(found.ratio, 6), round(body.i1 / body.i3, 6)
    (4.666667, 4.666667)

    A single film:

    >>> sc.data.compare(body, 1.4, 1.02 * body.rate(1.4), theta_err=0.01, rate_err=0.02)
    <Comparison: one point, 0.9 errors from a steady state: agrees with the body as built>
    """
    if isinstance(body, Motion) or isinstance(theta, Filmed):
        more = {"rate": rate, "hertz": hertz, "theta_err": theta_err, "rate_err": rate_err}
        if not isinstance(common, float | int) or common != 0:
            more["common"] = common
        return _film_beside(body, theta, more | {"hertz_err": hertz_err})
    one_body(body)
    optional_library("odrpack", "lab")
    rate, rate_err, unit = _reduced(body, rate, rate_err, hertz, hertz_err)
    common = number("common", common)
    if not common >= 0 or 0 < common < 1e-6:
        raise ValueError(f"common = {common!r}: expected 0, inf, or at least 1e-6, such as 0.03")
    try:
        x = points(theta, rate, theta_err, rate_err, body)
    except (TypeError, ValueError) as e:
        said = str(e) if hertz is None else re.sub(r"\brate(?=\b|_err)", "hertz", str(e))
        raise type(e)(said) from None
    known = theta_err is not None
    own = float(body.i1) / float(body.i3)
    curve = Balance(body, *x.values())
    away = np.abs(curve.off(curve.places, own, 1.0)) / curve.size
    if x["theta"].size < LEAST:
        if common > 0:
            raise ValueError(
                f"common = {common!r}: expected 0 for fewer than three points, which determine no factor"
            )
        residual = x["rate"] - body.rate(x["theta"])
        alone_chi2 = float(np.mean(away**2))
        seen = x["theta"], x["rate"], x["theta_err"], x["rate_err"], residual
        return Comparison(body, *seen, math.nan, math.nan, own, alone_chi2, unit=unit, away=away)
    if not curve.tells(("ratio",)):
        raise ValueError(
            "theta and rate: these points do not determine I1/I3; measure at inclinations farther from 90"
            " degrees"
        )
    found = curve.fit(("ratio",))
    alone = curve.fit(("factor",))
    both = curve.fit(("ratio", "factor")) if curve.tells(("ratio", "factor")) else None
    if common > 0:
        if math.isinf(common) and both is None:
            raise ValueError(
                "common = inf: these points cannot separate a factor of the rates from I1/I3; give the"
                " standard error of the factor"
            )
        free = both if both is not None and math.isinf(common) else curve.fit(("ratio", "factor"), common)
        if not known and not math.isinf(common) and free.chi2 > 0:
            # the fit takes its errors from the scatter, but that of the factor is given
            free = curve.fit(("ratio", "factor"), common / math.sqrt(free.chi2))
        found = free
    ratio, ratio_err, factor, factor_err = found.told(known)
    # a real body has I3 <= 2 I1; measurement errors may bring the ratio slightly below 1/2
    if not found.success or not ratio + 5 * ratio_err >= 0.5:
        raise ValueError(
            f"theta and rate: no real body has the fitted I1/I3, {ratio:.3g}; are the rates turns per second?"
            " Give them as hertz="
        )
    said = doubts_of_ratio(found, alone, both, own, known, fitted=common > 0)
    if said:
        warnings.warn(said, UserWarning, stacklevel=2)
    _, _, one, one_err = alone.told(known)
    return Comparison(
        body=body,
        theta=x["theta"],
        rate=x["rate"],
        theta_err=x["theta_err"],
        rate_err=x["rate_err"],
        residual=x["rate"] - body.rate(x["theta"]),
        ratio=ratio,
        ratio_err=ratio_err,
        expected=own,
        chi2=found.chi2,
        factor=factor,
        factor_err=factor_err,
        correlation=found.correlation,
        common=common,
        alone=one,
        alone_err=one_err,
        alone_chi2=alone.chi2,
        unit=unit,
        away=away,
    )


def _reduced(
    body: Body, rate: Reals | None, rate_err: Reals | None, hertz: Reals | None, hertz_err: Reals | None
) -> tuple[Reals, Reals | None, float]:
    """Reduced rates, their errors, and turns per second at the reduced rate 1; NaN if `rate` was given."""
    if (rate is None) == (hertz is None):
        raise TypeError("rate, hertz: give exactly one of them")
    if hertz is None:
        if hertz_err is not None:
            raise TypeError("hertz_err: use it only with hertz=; for reduced rates give rate_err=")
        return rate, rate_err, math.nan
    if rate_err is not None:
        raise TypeError("rate_err: use it only with rate=; for hertz= give hertz_err=")
    found, scale = sized_body("body", body, None)
    unit = float(scale.hertz(found, 1.0))
    given = (("hertz", hertz), ("hertz_err", hertz_err))
    turns, errors = (
        None if x is None else reals(name, turns_per_second(name, x)) / unit for name, x in given
    )
    return turns, errors, unit


def _film_beside(body: object, theta: object, more: dict[str, object]) -> FilmComparison:
    """Compare a motion with a film; TypeError if any other argument was given."""
    if not isinstance(body, Motion):
        raise TypeError(f"body: expected a Motion to compare with the film, not {type(body).__name__}")
    if not isinstance(theta, Filmed):
        known = f"expected a film from from_above to compare with the motion, not {type(theta).__name__}"
        raise TypeError(f"theta: {known}")
    for name, value in more.items():
        if value is not None:
            raise TypeError(f"{name}: leave it out if a film is compared with a motion")
    return beside(body, theta)
