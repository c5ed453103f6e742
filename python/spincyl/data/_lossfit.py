"""The result of fitting a spin-down: laws ranked by AIC, their parameters, stopping times and notes."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._input.equality import compared
from spincyl._input.numbers import Floats
from spincyl._loss import Loss
from spincyl._upward import above
from spincyl.data._line import Line
from spincyl.data._report import section, variables, written

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: A law whose AIC exceeds the least by no more than this is not told apart from the best; at this difference
#: it is twenty times less likely, exp(-6/2).
APART = 6.0


@compared
class FittedLoss(NamedTuple):
    """One law, or two that add, as it explains a spin-down best; from `fit_losses`."""

    name: str  #: "DryContour", or "DryContour + AirLinear"
    centre: str  #: "rest" or "rolling": by which drift
    law: Any  #: the law, or the sum, with its fitted coefficients
    coefficients: Floats  #: (1,) or (2,)
    coefficient_errs: Floats  #: standard errors
    theta: float  #: inclination at the first time
    theta_err: float
    rested: float  #: inclination at which the centre rested, of what rolls: at the first time or before
    stops_at: float  #: when the drift ends, on the clock of the measurement; infinite if never
    stops_at_err: float  #: NaN if never
    correlation: float  #: of coefficient and stopping time (inclination, if never), or of two coefficients
    residual: dict[str, Floats]  #: by "theta" and "precession": measured less fitted at the times measured
    chi2: float  #: sum of squares over the errors, per degree of freedom
    aic: float
    daic: float  #: AIC above that of the best law, over chi2 of that if it is more than 1
    drift: Any  #: the fitted drift, from the first time on

    @property
    def coefficients_si(self) -> Floats:
        """The coefficients in the units that `from_si` takes; an error says where that needs a mass."""
        return self.coefficients * _units(self)

    @property
    def coefficient_errs_si(self) -> Floats:
        """Their standard errors in the same units."""
        return self.coefficient_errs * _units(self)

    @property
    def coefficient(self) -> float:
        """The coefficient, of a single law."""
        (found,) = self.coefficients
        return float(found)

    @property
    def coefficient_err(self) -> float:
        """Its standard error."""
        (found,) = self.coefficient_errs
        return float(found)

    def __repr__(self) -> str:
        said = ", ".join(f"{k:.5g} +- {e:.2g}{unit}" for k, e, unit in printed(self))
        rolling = " by rolling" if self.centre == "rolling" else ""
        return f"<{self.name}{rolling}: {said}, {_stops(self)}, chi2 {self.chi2:.3g}, dAIC {self.daic:.1f}>"


@compared
class Refused(NamedTuple):
    """A law that was to be fitted but cannot be, and the reason."""

    name: str
    centre: str
    why: str


@compared
class LossFit(NamedTuple):
    """A spin-down and the laws that may explain it, the best first; from `fit_losses`."""

    body: Body
    centre: str  #: "rest", "rolling" or "either": which drifts were fitted
    t: Floats  #: (n,) measured, without what was not
    theta: Floats | None  #: (n,) NaN where it was not measured
    precession: Floats | None
    t_err: Floats  #: standard errors that points were weighed with; zero where times are exact
    theta_err: Floats | None
    precession_err: Floats | None
    estimated: tuple[str, ...]  #: of "theta" and "precession", those whose errors were found from the scatter
    fits: tuple[FittedLoss, ...]  #: by AIC
    line: Line | None  #: the log-log line, a quick look, biased; None where there is none
    refused: tuple[Refused, ...] = ()  #: laws that cannot be

    @property
    def best(self) -> FittedLoss:
        """The law with the least AIC."""
        return self.fits[0]

    @property
    def told_apart(self) -> bool:
        """Whether any other law, or place of the centre, is twenty times less likely: its AIC larger by 6."""
        return len(self.fits) < 2 or self.fits[1].daic > APART

    def of(self, law: Any, centre: str | None = None) -> FittedLoss:
        """The fit of a law, by its class, or of a sum, by its classes as a tuple or list.

        Of both centres it is the better one, if `centre` does not say which. KeyError for one that was not
        fitted; TypeError for what is no law.
        """
        classes = tuple(law) if isinstance(law, tuple | list) else (law,)
        if not classes or not all(isinstance(one, type) and issubclass(one, Loss) for one in classes):
            raise TypeError(f"law: expected a class such as sc.loss.DryContour, not {law!r}")
        for found in self.fits:
            if found.name == called(classes) and centre in (None, found.centre):
                return found
        known = ", ".join(dict.fromkeys(found.name for found in self.fits))
        why = next((f": {no.why}" for no in self.refused if no.name == called(classes)), "")
        raise KeyError(f"law: {called(classes)} was not fitted{why}; there are {known}")

    def table(self) -> str:
        """Laws by AIC: coefficients and stopping times with errors, chi2, and which are not told apart."""
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
        """The best law with errors and correlation, then all laws, as lmfit writes it."""
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
        """Draw data with fits, residuals, and the log-log line: see `spincyl.plot.losses`."""
        drawn: list[Axes] = above("LossFit.plot")(self, axes)
        return drawn

    def __repr__(self) -> str:
        best, told = self.best, "" if self.told_apart else ", not told apart from others"
        kept = "rolling" if self.best.centre == "rolling" else "centre at rest"
        return f"<LossFit: {repr(best)[1:-1]}{told}; {len(self.t)} points, {kept}>"

    def _repr_html_(self) -> str:
        from spincyl._studio.cards import drawing, framed

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
    """Convert a fit from natural units to those of a measured body with this unit of time in seconds."""

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
    """Coefficients with errors and units as they are printed: `from_si` reads them."""
    pairs = zip(found.law.laws, found.coefficients.tolist(), found.coefficient_errs.tolist(), strict=True)
    units = [(law._printed(found.drift.body.scale), k, error) for law, k, error in pairs]
    return [(factor * k, factor * error, unit) for (factor, unit), k, error in units]


def _units(found: FittedLoss) -> Floats:
    """Of each coefficient the factor to the unit that `from_si` takes."""
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
    """A row of the table: name, centre, coefficients, stopping time, chi2, dAIC."""
    told = ", ".join(f"{k:.4g} +- {e:.1g}{unit}" for k, e, unit in printed(found))
    stops = _stops(found).removeprefix("stops at ").removesuffix(" stops")
    return found.name, found.centre, told, stops, f"{found.chi2:.3g}", f"{found.daic:.1f}"


def remark(found: FittedLoss) -> str:
    """A note on whether a law is the best, or not told apart from it."""
    if found.daic == 0:
        return "best"
    return "not told apart" if found.daic <= APART else ""


def notes(found: LossFit) -> list[str]:
    """Notes below the table."""
    which = "with the centre at rest, or by rolling" if found.centre == "either" else CENTRE[found.centre]
    said = [f"{len(found.t)} points; drift {which}"]
    said += [f"errors of {name} from its scatter about the best law" for name in found.estimated]
    for no in found.refused:
        name = f"{no.name}, {no.centre}" if found.centre == "either" else no.name
        said.append(f"{name}: not fitted: {no.why}")
    return said


CENTRE = {"rest": "with the centre at rest", "rolling": "by rolling"}
