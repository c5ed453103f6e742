"""The result of fitting a spin-down: laws ranked by AIC, their parameters, stopping times and notes."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import Floats
from spincyl._loss import Loss
from spincyl._upward import function_of_method
from spincyl.lab._line import Line
from spincyl.lab._report import section, variables, written

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: A law whose AIC exceeds the least by no more than this cannot be told apart from the best. At this
#: difference it is twenty times less likely, exp(-6/2).
APART = 6.0


@compared_by_value
class FittedLoss(NamedTuple):
    """Fit of one law, or of the sum of two, to a spin-down; one of the results of `fit_losses`.

    Attributes
    ----------
    name : str
        Name of the law, such as "DryContour", or of the sum, such as "DryContour + AirLinear".
    centre : str
        Kind of drift that was fitted, "rest" or "rolling".
    law : loss.Loss
        The law, or the sum, with its fitted coefficients.
    coefficients : ndarray, (1,) or (2,)
        Coefficients of the law, or of the two laws of a sum, in natural units.
    coefficient_errs : ndarray, (1,) or (2,)
        Standard errors of the coefficients.
    theta : float
        Inclination at the first time, in radians.
    theta_err : float
        Standard error of `theta`.
    rested : float
        Only for a rolling drift: inclination in radians at which the centre was at rest, at the first time or
        before.
    stops_at : float
        Time at which the drift ends, on the clock and in the unit of `LossFit.t`; infinite if the drift never
        ends.
    stops_at_err : float
        Standard error of `stops_at`; NaN if the drift never ends.
    correlation : float
        For one law, correlation of the coefficient with `stops_at`, or with `theta` if `stops_at` is
        infinite. For a sum, correlation of the two coefficients.
    residual : dict of ndarray
        Measured minus fitted values; the keys are "theta" and "precession".
    chi2 : float
        Sum of the squared residuals in units of their errors, per degree of freedom.
    aic : float
        Akaike's information criterion (AIC); the smaller, the better the law.
    daic : float
        Difference between `aic` and the `aic` of the best law. If chi2 of the best law exceeds 1, the
        difference is divided by it.
    drift : Drift
        The fitted drift, from the first time on.
    coefficient, coefficient_err : float
        Coefficient of a single law and its standard error; ValueError for a sum.
    coefficients_si, coefficient_errs_si : ndarray, (1,) or (2,)
        Coefficients and standard errors in the units of `from_si`.
    """

    name: str
    centre: str
    law: Any
    coefficients: Floats
    coefficient_errs: Floats
    theta: float
    theta_err: float
    rested: float
    stops_at: float
    stops_at_err: float
    correlation: float
    residual: dict[str, Floats]
    chi2: float
    aic: float
    daic: float
    drift: Any

    @property
    def coefficients_si(self) -> Floats:
        """The coefficients in the units of `from_si`; ValueError if they need a mass that is unknown."""
        return self.coefficients * _units(self)

    @property
    def coefficient_errs_si(self) -> Floats:
        """Standard errors of `coefficients_si`, in the same units."""
        return self.coefficient_errs * _units(self)

    @property
    def coefficient(self) -> float:
        """The coefficient of a single law; ValueError for a sum of two."""
        (found,) = self.coefficients
        return float(found)

    @property
    def coefficient_err(self) -> float:
        """Standard error of `coefficient`."""
        (found,) = self.coefficient_errs
        return float(found)

    def __repr__(self) -> str:
        said = ", ".join(f"{k:.5g} +- {e:.2g}{unit}" for k, e, unit in printed(self))
        rolling = " by rolling" if self.centre == "rolling" else ""
        return f"<{self.name}{rolling}: {said}, {_stops(self)}, chi2 {self.chi2:.3g}, dAIC {self.daic:.1f}>"


@compared_by_value
class Refused(NamedTuple):
    """A law that could not be fitted, and the reason.

    Attributes
    ----------
    name : str
        Name of the law, or of the sum.
    centre : str
        Kind of drift, "rest" or "rolling".
    why : str
        The reason.
    """

    name: str
    centre: str
    why: str


@compared_by_value
class LossFit(NamedTuple):
    """A measured spin-down and the laws fitted to it, the best first; returned by `fit_losses`.

    Methods: ``of(law)``, ``table()``, ``report()`` and ``plot()``.

    Attributes
    ----------
    body : Body
        The body.
    centre : str
        Kinds of drift that were fitted: "rest", "rolling", or "either" if both were fitted.
    t : ndarray, (n,)
        Measured times, without missing points, in sqrt(R/g), for a measured body in seconds.
    theta : ndarray or None, (n,)
        Measured inclinations in radians; NaN where missing.
    precession : ndarray or None, (n,)
        Measured precession in sqrt(g/R), for a measured body in rad/s; NaN where missing.
    t_err : ndarray, (n,)
        Standard errors of the times; zero if they are exact.
    theta_err : ndarray or None, (n,)
        Standard errors of `theta`.
    precession_err : ndarray or None, (n,)
        Standard errors of `precession`.
    estimated : tuple of str
        Names ("theta", "precession") of the values whose errors were estimated from the scatter.
    fits : tuple of FittedLoss
        The fitted laws in the order of their AIC, the best first.
    line : Line or None
        Power law from a log-log diagram, which is a quick, biased estimate; None if no line fits.
    refused : tuple of Refused
        Laws that could not be fitted.
    best : FittedLoss
        The law with the least AIC, ``fits[0]``.
    told_apart : bool
        Whether every other fit is at least twenty times less likely than the best.
    """

    body: Body
    centre: str
    t: Floats
    theta: Floats | None
    precession: Floats | None
    t_err: Floats
    theta_err: Floats | None
    precession_err: Floats | None
    estimated: tuple[str, ...]
    fits: tuple[FittedLoss, ...]
    line: Line | None
    refused: tuple[Refused, ...] = ()

    @property
    def best(self) -> FittedLoss:
        """The law that fits best: the one with the least AIC (Akaike's information criterion)."""
        return self.fits[0]

    @property
    def told_apart(self) -> bool:
        """Whether every other fit is at least twenty times less likely: its AIC is larger by more than 6."""
        return len(self.fits) < 2 or self.fits[1].daic > APART

    def of(self, law: Any, centre: str | None = None) -> FittedLoss:
        """Return the fit of a law, given by its class, or of a sum, given by a tuple or list of two classes.

        `centre` is "rest" or "rolling"; without it the better of the two fits is returned. Raises KeyError if
        the law was not fitted, and TypeError if the argument is not a class of `spincyl.loss`.
        """
        classes = tuple(law) if isinstance(law, tuple | list) else (law,)
        if not classes or not all(isinstance(one, type) and issubclass(one, Loss) for one in classes):
            raise TypeError(f"law: expected a class such as sc.loss.DryContour, not {law!r}")
        for found in self.fits:
            if found.name == called(classes) and centre in (None, found.centre):
                return found
        known = ", ".join(dict.fromkeys(found.name for found in self.fits))
        why = next((f": {no.why}" for no in self.refused if no.name == called(classes)), "")
        raise KeyError(f"law: {called(classes)} was not fitted{why}; expected one of {known}")

    def table(self) -> str:
        """Return a table of the laws in the order of AIC: coefficients, stopping times, chi2 and remarks."""
        either = self.centre == "either"
        head: tuple[str, ...] = ("law", "centre", "coefficient", "stops at", "chi2", "dAIC")
        if self.body.scale is not None:
            head = (*head[:3], "stops at (s)", *head[4:])
        rows = [head]
        for found in self.fits:
            *most, stops, chi2, daic = cells(found)
            rows.append((*most, stops.removesuffix(" s"), chi2, f"{daic} {remark(found)}"))
        rows = [row if either else (row[0], *row[2:]) for row in rows]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        lines = [
            "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
            for row in rows
        ]
        return "\n".join([*lines, *notes(self)])

    def report(self) -> str:
        """Return a report in lmfit's style: the best law with its errors, and the table of all laws."""
        best = self.best
        names = best.name.split(" + ")
        second = "the other" if len(names) > 1 else "stops at" if math.isfinite(best.stops_at) else "theta"
        rows = [
            ("body", repr(self.body)),
            ("law", best.name + ("" if self.told_apart else ", not told apart from others")),
            ("centre", CENTRE[best.centre]),
            ("# data points", str(len(self.t))),
            ("# variables", str(len(names) + 1)),
            ("reduced chi-square", written(best.chi2)),
            ("Akaike info crit", written(best.aic)),
        ]
        told = [
            (name, k, error, unit and f"({unit.strip()})")
            for name, (k, error, unit) in zip(names, printed(best), strict=True)
        ]
        told.append(("theta at the first time", best.theta, best.theta_err, ""))
        unit = "(derived)" if self.body.scale is None else "(seconds, derived)"
        told.append(("stops at", best.stops_at, best.stops_at_err, unit))
        lines = section("Spin-down", rows) + variables(told)
        if math.isfinite(best.correlation):
            lines += section("Correlations", [(f"C({names[0]}, {second})", f"{best.correlation:+.4f}")])
        return "\n".join([*lines, "[[Laws]]", *("    " + line for line in self.table().splitlines())])

    def plot(self, axes: "Sequence[Axes] | None" = None) -> "list[Axes]":
        """Draw the data with the fits, the residuals and the log-log diagram; see `spincyl.plot.losses`."""
        drawn: list[Axes] = function_of_method("LossFit.plot")(self, axes)
        return drawn

    def __repr__(self) -> str:
        best, told = self.best, "" if self.told_apart else ", not told apart from others"
        kept = "rolling" if self.best.centre == "rolling" else "centre at rest"
        return f"<LossFit: {repr(best)[1:-1]}{told}; {len(self.t)} points, {kept}>"

    def _repr_html_(self) -> str:
        from spincyl.studio.cards import drawing, framed

        rows = [("body", repr(self.body))]
        for fit in self.fits:
            name, kept, told, stops, chi2, daic = cells(fit)
            name = f"{name}, {kept}" if self.centre == "either" else name
            stops = "never stops" if stops == "never" else f"stops at {stops}"
            said = f"; {remark(fit)}" if remark(fit) else ""
            rows.append((name, f"{told}; {stops}; χ² {chi2}; ΔAIC {daic}{said}"))
        rows += [("", note) for note in notes(self)]
        return framed("LossFit", rows, drawing(self.body, self.best.theta, "θ"))


def in_si(found: LossFit, body: Body, second: float) -> LossFit:
    """Convert a fit to the units of a measured body, whose natural unit of time lasts `second` seconds."""

    def told(fit: FittedLoss) -> FittedLoss:
        residual = fit.residual | {
            name: fit.residual[name] / second for name in fit.residual if name == "precession"
        }
        drift = replace(fit.drift, body=body, stops_at=fit.drift.stops_at * second)
        return fit._replace(
            stops_at=fit.stops_at * second,
            stops_at_err=fit.stops_at_err * second,
            residual=residual,
            drift=drift,
        )

    line = found.line
    if line is not None:
        # the value one second before the end
        factor = line.factor * second**-line.exponent / (1.0 if found.theta is not None else second)
        line = line._replace(stops_at=line.stops_at * second, factor=factor)
    return found._replace(
        body=body,
        t=found.t * second,
        t_err=found.t_err * second,
        precession=None if found.precession is None else found.precession / second,
        precession_err=None if found.precession_err is None else found.precession_err / second,
        fits=tuple(map(told, found.fits)),
        line=line,
    )


def called(laws: Sequence[Any]) -> str:
    return " + ".join(law.__name__ for law in laws)


def printed(found: FittedLoss) -> list[tuple[float, float, str]]:
    """Each coefficient with its standard error and unit, as printed and as `from_si` reads them."""
    pairs = zip(found.law.laws, found.coefficients.tolist(), found.coefficient_errs.tolist(), strict=True)
    units = [(law._printed(found.drift.body.scale), k, error) for law, k, error in pairs]
    return [(factor * k, factor * error, unit) for (factor, unit), k, error in units]


def _units(found: FittedLoss) -> Floats:
    """Factors that convert the coefficients of a fit to the units of `from_si`."""
    return np.array([law.in_si(found.drift.body) / law.coefficient for law in found.law.laws], np.float64)


def _stops(found: FittedLoss) -> str:
    if math.isinf(found.stops_at):
        return "never stops"
    unit = "" if found.drift.body.scale is None else " s"
    # as many decimals as two digits of the error have
    error = f"{found.stops_at_err:.2g}"
    decimals = max(0, 1 - math.floor(math.log10(float(error)))) if 0 < found.stops_at_err < math.inf else 4
    return f"stops at {found.stops_at:.{decimals}f} +- {error}{unit}"


def cells(found: FittedLoss) -> tuple[str, str, str, str, str, str]:
    """The cells of a row in the table of laws: name, centre, coefficients, stopping time, chi2, dAIC."""
    told = ", ".join(f"{k:.4g} +- {e:.1g}{unit}" for k, e, unit in printed(found))
    stops = _stops(found).removeprefix("stops at ").removesuffix(" stops")
    return found.name, found.centre, told, stops, f"{found.chi2:.3g}", f"{found.daic:.1f}"


def remark(found: FittedLoss) -> str:
    """A note on whether a law is the best, or cannot be told apart from it."""
    if found.daic == 0:
        return "best"
    return "not told apart" if found.daic <= APART else ""


def notes(found: LossFit) -> list[str]:
    """The notes below the table of fitted laws."""
    which = "with the centre at rest, or by rolling" if found.centre == "either" else CENTRE[found.centre]
    said = [f"{len(found.t)} points; drift {which}"]
    said += [f"errors of {name} from its scatter about the best law" for name in found.estimated]
    for no in found.refused:
        name = f"{no.name}, {no.centre}" if found.centre == "either" else no.name
        said.append(f"{name}: not fitted: {no.why}")
    return said


CENTRE = {"rest": "with the centre at rest", "rolling": "by rolling"}
