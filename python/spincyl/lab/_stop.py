"""A coefficient of loss from a stopwatch: the time in which a spinning body stops."""

import math
import textwrap
import warnings
from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any, Literal, NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._drift import Drift, drift
from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import Floats, Reals
from spincyl._loss import marked_as_si
from spincyl._single import one_body
from spincyl.lab._lossfit import APART, CENTRE, Refused
from spincyl.lab._report import WIDE, section, variables
from spincyl.lab._spindown import centres, known_law, known_laws
from spincyl.lab._times import Timed, WildTime, about_wild, timed
from spincyl.lab._typical import far_from_typical

_UNIT = 1e-9  #: Coefficient so small that the law holds at all inclinations of the drift.
_ENDS = ("face lands", "lies down")  #: Ends at which the body is seen to stop.
_FEWEST_TURNS = 5.0  #: With fewer turns before the end the drift is not slow.


@compared_by_value
class FittedStop(NamedTuple):
    """Coefficient of a loss for one law and one kind of drift; returned by `fit_stop`.

    Attributes
    ----------
    centre : str
        Kind of drift (see `spincyl.drift`): "rest" or "rolling".
    law : loss.Loss
        The law with this coefficient.
    coefficient : float
        Coefficient in natural units, as in the law.
    coefficient_err : float
        Standard error of `coefficient`; larger if the law misses the times by more than their errors.
    by_times : float
        Part of the standard error that is due to the times.
    by_angle : float
        Part of the standard error that is due to the first inclinations.
    drift : Drift
        Drift from the (largest) first inclination to the end, with this coefficient.
    misses : ndarray, (k,)
        Measured mean times minus those of the law, in seconds, for each first inclination; 0 for a
        single inclination.
    chi2 : float
        Sum of the squares of `misses` in units of their errors, of the times and the inclinations together.
    daic : float
        Difference between `chi2` and that of the best law, which is the difference of Akaike's criterion.
    coefficient_si, coefficient_err_si : float
        Coefficient and standard error in the unit of `from_si`.
    """

    centre: str
    law: Any
    coefficient: float
    coefficient_err: float
    by_times: float
    by_angle: float
    drift: Drift
    misses: Floats
    chi2: float
    daic: float

    @property
    def coefficient_si(self) -> float:
        """The coefficient in the unit of `from_si`; ValueError if it needs a mass that is unknown."""
        return float(self.law.in_si(self.drift.body))

    @property
    def coefficient_err_si(self) -> float:
        """Standard error of `coefficient_si`, in the same unit."""
        return self.coefficient_si * self.coefficient_err / self.coefficient

    @property
    def _printed(self) -> tuple[float, float, str]:
        """The coefficient, its error and their unit, as `from_si` reads them."""
        factor, unit = self.law._printed(self.drift.body.scale)
        return factor * self.coefficient, factor * self.coefficient_err, unit

    def __repr__(self) -> str:
        value, error, unit = self._printed
        return f"<{type(self.law).__name__} {CENTRE[self.centre]}: {value:.4g} +- {error:.2g}{unit}>"


@compared_by_value
class StopFit(NamedTuple):
    """Measured times until a body stops, and the coefficients of loss; returned by `fit_stop`.

    Methods: ``of(centre, law)``, ``table()`` and ``report()``.

    Attributes
    ----------
    body : Body
        The measured body.
    name : str
        Name of the law, or of the laws, separated by commas.
    theta : float or ndarray, (k,)
        First inclination in radians; for several ones an array, ascending.
    theta_err : float or ndarray, (k,)
        Standard error of `theta`.
    seconds : ndarray, (n,)
        Measured times in seconds, without missing ones.
    stops_at : float or ndarray, (k,)
        Mean of the times from each inclination, in seconds, without `wild` ones.
    stops_at_err : float or ndarray, (k,)
        Standard error of the mean.
    fits : tuple of FittedStop
        One fit for each law and each kind of drift. With several inclinations or laws the best comes first.
    refused : tuple of Refused
        Laws and kinds of drift that could not be fitted, with the reason.
    wild : tuple of WildTime
        Times that are left out since they are far from the others: each has ``where``, ``name`` (of the row),
        ``theta``, ``seconds`` and ``deviations``.
    best : FittedStop
        The fit with the least chi2, ``fits[0]``.
    told_apart : bool
        Whether every other fit is at least twenty times less likely than the best.
    """

    body: Body
    name: str
    theta: float | Floats
    theta_err: float | Floats
    seconds: Floats
    stops_at: float | Floats
    stops_at_err: float | Floats
    fits: tuple[FittedStop, ...]
    refused: tuple[Refused, ...]
    wild: tuple[WildTime, ...] = ()

    @property
    def best(self) -> FittedStop:
        """The fit with the least chi2; the first one, if there is a single inclination."""
        return self.fits[0]

    @property
    def told_apart(self) -> bool:
        """Whether every other fit is at least twenty times less likely: its AIC is larger by more than 6."""
        return len(self.fits) < 2 or self.fits[1].daic > APART

    def of(self, centre: str, law: Any = None) -> FittedStop:
        """Return the fit for the drift "rest" or "rolling": that of a law, given by its class, or the best.

        Raises KeyError with the reason if there is none.
        """
        name = None if law is None else known_law("law", law).__name__
        for found in self.fits:
            if found.centre == centre and name in (None, type(found.law).__name__):
                return found
        laws = [no for no in self.refused if no.centre == centre and name in (None, no.name)]
        why = next((f": {no.why}" for no in laws), "")
        raise KeyError(f"centre: {centre!r} was not fitted{f' with {name}' if name else ''}{why}")

    @property
    def _likely(self) -> tuple[FittedStop, ...]:
        """The best fit and all that are not told apart from it."""
        return tuple(found for found in self.fits if found.daic <= APART)

    @property
    def _many(self) -> int:
        """Number of first inclinations."""
        return int(np.size(self.theta))

    def _about(self) -> list[tuple[str, str]]:
        """Rows of the report on the measurement: body, laws, inclinations, mean times, times left out."""
        rows = [("body", repr(self.body)), ("law" if "," not in self.name else "laws", self.name)]
        told = zip(*map(np.atleast_1d, self[2:4]), *map(np.atleast_1d, self[5:7]), strict=True)
        for theta, theta_err, mean, err in told:
            angle = f"{math.degrees(theta):.4g} +/- {math.degrees(theta_err):.2g} degrees"
            time = f"{mean:.4g} +/- {err:.2g} s"
            rows += (
                [("starts at", angle), ("stops after", time)]
                if self._many == 1
                else [("from", f"{angle}: stops after {time}")]
            )
        rows.append(("# times", str(self.seconds.size)))
        return rows + [("left out", one.told()) for one in self.wild]

    def table(self) -> str:
        """Return a table of the fits: coefficients, and mean measured times minus those of each law."""
        many = self._many > 1
        head = ["law", "centre", "coefficient"]
        rows = [head + (["misses by (s)", "chi2", "dAIC"] if many else [])]
        for found in self.fits:
            value, error, unit = found._printed
            row = [type(found.law).__name__, found.centre, f"{value:.4g} +- {error:.1g}{unit}"]
            if many:
                near = "best" if found is self.best else "not told apart" if found.daic <= APART else ""
                off = " ".join(f"{x:+.2f}" for x in found.misses)
                row += [off, f"{found.chi2:.3g}", f"{found.daic:.1f} {near}".rstrip()]
            rows.append(row)
        wide = [max(map(len, column)) for column in zip(*rows, strict=True)]
        lines = ["  ".join(x.ljust(w) for x, w in zip(row, wide, strict=True)).rstrip() for row in rows]
        if many:
            start = ", ".join(f"{math.degrees(x):.4g}\N{DEGREE SIGN}" for x in np.atleast_1d(self.theta))
            lines.append(f"misses by: mean times from {start} minus those of the law")
        elif len({type(found.law) for found in self.fits}) > 1:
            lines.append("one inclination cannot show which law holds")
        return "\n".join(lines + self._not_fitted())

    def _not_fitted(self) -> list[str]:
        """Lines that say why laws or kinds of drift were not fitted."""
        lines, several = [], "," in self.name
        for why, same in groupby(self.refused, key=lambda no: (no.name, no.why)):
            kept = " or ".join(no.centre for no in same)
            name = f"{why[0]}, {kept}" if several else kept
            lines += textwrap.wrap(f"{name}: not fitted: {why[1]}", WIDE - 4, subsequent_indent="  ")
        return lines

    def report(self) -> str:
        """Return a report in lmfit's style: times, coefficients, and both parts of their errors.

        The table of the laws follows if there are several inclinations or laws.
        """
        told, whole = [], self._many > 1 or "," in self.name
        for found in self._likely:
            value, error, unit = found._printed
            law = f"{type(found.law).__name__} " if "," in self.name else ""
            name = f"{law}{found.law._parameter} {CENTRE[found.centre]}" + (unit and f", in{unit}")
            times, angle = (100 * part / found.coefficient for part in (found.by_times, found.by_angle))
            told.append((name, value, error, f"(times {times:.2g}%, angle {angle:.2g}%)"))
        lines = section("Stopwatch", self._about()) + variables(told)
        if whole:
            return "\n".join([*lines, "[[Laws]]", *("    " + line for line in self.table().splitlines())])
        return "\n".join(lines + ["    " + line for line in self._not_fitted()])

    def __repr__(self) -> str:
        likely = self._likely
        apart = "" if self._many == 1 or self.told_apart else ", not told apart"
        told = "; ".join(repr(found)[1:-1] for found in likely[:3])
        more = f"; and {len(likely) - 3} more" if len(likely) > 3 else ""
        return f"<StopFit: {told}{more}{apart}; {self.seconds.size} times>"

    def _repr_html_(self) -> str:
        from spincyl.studio.cards import drawing, framed

        several = "," in self.name
        for_law = {id(one): f"{type(one.law).__name__}, " if several else "" for one in self.fits}
        rows = self._about() + [
            (f"{for_law[id(one)]}{CENTRE[one.centre]}", repr(one)[1:-1].split(": ")[1]) for one in self.fits
        ]
        rows += [(f"{no.name}, {no.centre}", f"not fitted: {no.why}") for no in self.refused]
        return framed("StopFit", rows, drawing(self.body, float(np.max(self.theta)), "θ"))


def fit_stop(
    body: Body,
    law: Any,
    from_: float | Reals | Mapping[str, Reals],
    seconds: Reals | None = None,
    *,
    error: float | None = None,
    from_err: float | Reals = 0.0,
    centre: Literal["rest", "rolling"] | None = None,
    names: Sequence[str] | None = None,
) -> StopFit:
    """Fit the coefficient of a loss to the time in which a spinning coin stops, measured with a stopwatch.

    Parameters
    ----------
    body : Body
        Single measured body.
    law : class of `spincyl.loss`, list of classes, or None
        For instance ``sc.loss.DryContour``. None fits all eight laws. Times from one inclination cannot show
        which law holds; times from several inclinations can, and the best law comes first.
    from_ : float, array_like or table
        Inclination at which the stopwatch is started, in radians, or a text such as "20deg". For several
        inclinations a list: one for each column of `seconds`, or one for each time. Or a table, as
        `read_table` returns it, or a dict, with a column of times for each inclination. The columns are
        called "20deg", "20°", "20 Grad" or "20 (deg)", also among other words and with a unit of the times,
        as in "Zeit bei 20° (ms)"; a column of text has the names of the rows.
    seconds : array_like, optional
        Measured times from the start of the stopwatch until the body stops, in seconds; NaN or None if
        missing. A list of times, or a table with a row for each student and a column for each inclination. To
        be left out if `from_` is a table.
    error : float, optional
        Standard error of each time in seconds, such as 0.2 for a watch started by hand. Default: the error is
        estimated from the scatter of the times, which needs at least two different times from an inclination.
        The scatter then has a constant part and a part proportional to the time.
    from_err : float or array_like
        Standard error of `from_`, in radians or as a text such as "2deg"; one, or one for each inclination.
        The error of an inclination is assumed to be the same in all trials, like the error of a mark, so that
        more trials do not reduce it.
    centre : {"rest", "rolling"}, optional
        Kind of drift: with the centre held at rest by slip, or of a body that rolls all the time. Times from
        one inclination cannot distinguish them. Default: both.
    names : sequence of str, optional
        Names of the rows of `seconds`, such as those of students. They are used in messages.

    Returns
    -------
    StopFit
        ``.report()`` summarises the fit; `drift` and `roll` take ``.of("rest").law`` or ``.best.law``.

    Raises
    ------
    ValueError
        If times are not positive. If `error` is missing and there is only one time from each inclination, or
        all times are equal. If the body never stops under the law, or stops within its first turn. If there
        is no steady state at the first inclination. If the size of the body is unknown. If a column of a
        table is not called by an inclination.
    TypeError
        If an argument is not a body, a law or a number; the message names it.

    Warns
    -----
    DriftWarning
        Warnings of the best drift are passed on.
    UserWarning
        If the body turns less than five times. If a time is left out since it is far from the others; the
        message names it. If the longest time from an inclination is three times the shortest or more. If the
        coefficient of every likely law is far from all values in `spincyl.loss.typical`, for example because
        minutes were given for seconds.

    Notes
    -----
    The duration of a drift is inversely proportional to the coefficient, so the times give the coefficient.
    Errors are propagated to first order. The part from the inclination follows from drifts that begin at both
    ends of its error interval. An error from the scatter of only a few times is widened by Student's t, so
    that the error interval contains the true coefficient in two of three cases. The drift is of first order
    in the loss; to see how accurate this is, compute the motion with `roll` and the law.

    With five or more times a robust mean is used: times that are farther than 1.5 robust standard deviations
    from it count as if they were at this distance (Huber 1964), and those that are much farther, 6.7 standard
    deviations of twelve times, are left out (`StopFit.wild`). The robust standard deviation is 1.48 times the
    median deviation from the median.

    Examples
    --------
    >>> import spincyl as sc
    >>> coin = sc.measured(outer_diameter="25.75mm", length="2.2mm", mass="8.5g")
    >>> times = [4.1, 4.4, 4.2, 4.5, 4.3]
    >>> found = sc.data.fit_stop(coin, sc.loss.DryContour, "45deg", times, from_err="2deg", centre="rest")
    >>> found.of("rest")
    <DryContour with the centre at rest: 0.03874 +- 0.0028 mm>
    """
    one_body(body)
    if body.scale is None:
        raise ValueError(
            "body: the size of the body is unknown; make the body with sc.measured, or give it a scale"
        )
    kinds, alone = _laws(law)
    data = timed(from_, seconds, error, from_err, names)
    turns = min(data.mean * body.hertz(data.theta))
    if turns < 1:
        told = f"the body would stop within {turns:.2g} of a turn, too fast for a drift"
        raise ValueError(f"seconds = {data.mean.min():.6g}: {told}; are the times in seconds?")
    found, refused = [], []
    for kind in kinds:
        for one in centres(centre):
            with warnings.catch_warnings(record=True, action="always") as said:
                try:
                    found.append((_fitted_drift(body, kind, one, data), said))
                except ValueError as e:
                    refused.append((Refused(kind.__name__, one, str(e)), e))
    if not found:
        raise refused[0][1]
    if data.theta.size > 1:
        found.sort(key=lambda pair: pair[0].chi2)
    fits = [one._replace(daic=one.chi2 - found[0][0].chi2) for one, _ in found]
    far = [far_from_typical(one.law, body.scale) for one in fits if one.daic <= APART]
    known = [why for why in far if why is not None]
    doubts: list[tuple[Any, Any]] = [(why, UserWarning) for why in known[:1] if all(known)]
    # not once for each centre; of several laws only the best may warn
    own = [one for _, said in (found if alone and data.theta.size == 1 else found[:1]) for one in said]
    doubts += [(kept.message, kept.category) for kept in {one.category: one for one in own}.values()]
    if turns < _FEWEST_TURNS:
        doubts.append((f"{_FEW.format(turns)}: are the times in seconds?", UserWarning))
    doubts += [(one, UserWarning) for one in (about_wild(data.wild), data.mixed) if one]
    for message, category in doubts:
        warnings.warn(message, category, stacklevel=2)
    shown = (data.theta, data.theta_err, data.seconds, data.mean, data.mean_err)
    if data.theta.size == 1:
        shown = tuple(x if k == 2 else float(x[0]) for k, x in enumerate(shown))  # type: ignore[assignment]
    name = ", ".join(kind.__name__ for kind in kinds)
    return StopFit(body, name, *shown, tuple(fits), tuple(no for no, _ in refused), data.wild)


_FEW = "the body turns only {:.2g} times before it stops, too few for a slow drift"


def _laws(law: Any) -> tuple[list[Any], bool]:
    """The classes of the laws, and whether a single class was given."""
    if law is None:
        return known_laws(), False
    if not isinstance(law, list | tuple):
        return [known_law("law", law)], True
    if not law or len(set(map(id, law))) < len(law):
        raise ValueError("law: expected at least one law, and each law only once")
    return [known_law("law", one) for one in law], False


def _fitted_drift(body: Body, kind: Any, centre: str, data: Timed) -> FittedStop:
    """Fit the coefficient of one law and kind of drift to the mean times from all first inclinations."""
    second = body.scale.seconds(1.0)  # type: ignore[union-attr]
    lasts = np.empty((2, data.theta.size))
    for k, (theta, err) in enumerate(zip(data.theta.tolist(), data.theta_err.tolist(), strict=True)):
        lasts[:, k] = _duration(body.natural, kind, centre, theta, err)
    scaled = np.log(data.mean / second) - np.log(_UNIT * lasts[0])  # minus the logarithm of the coefficient
    by = np.stack([data.mean_err / data.mean, lasts[1] / lasts[0]])
    weight = 1 / (by**2).sum(axis=0)
    weight /= weight.sum()
    inverse = float(weight @ scaled)
    coefficient = math.exp(-inverse)
    off = scaled - inverse
    chi2 = float((off**2 / (by**2).sum(axis=0)).sum()) if off.size > 1 else 0.0
    wide = math.sqrt(max(chi2 / max(off.size - 1, 1), 1.0))
    by_times, by_angle = (wide * coefficient * math.sqrt(float(weight**2 @ part**2)) for part in by)
    misses = data.mean * -np.expm1(-off) if off.size > 1 else np.zeros(1)
    law = marked_as_si(kind(coefficient), body)
    found = drift(body, float(data.theta[-1]), law, centre)
    error = math.hypot(by_times, by_angle)
    return FittedStop(centre, law, coefficient, error, by_times, by_angle, found, misses, chi2, 0.0)


def _duration(plain: Body, kind: Any, centre: str, theta: float, theta_err: float) -> tuple[float, float]:
    """Duration of a drift with the coefficient `_UNIT`, and its change by the error of the inclination."""
    name = kind.__name__
    try:
        one = drift(plain, theta, kind(_UNIT), centre)
    except ValueError as e:
        raise ValueError(f"from_: {e}") from None
    if math.isinf(one.stops_at):
        never = f"with {name}, starting at {math.degrees(theta):.4g} degrees, this body never stops"
        raise ValueError(f"law: {never}, so that no time determines the coefficient")
    if one.ended not in _ENDS:
        at = f"at {math.degrees(one.ends_at_theta):.3g} degrees, where the body still moves"
        raise ValueError(f"law: the drift with {name} ends ({one.ended}) {at}; a stopwatch cannot time it")
    if not theta_err:
        return float(one.stops_at), 0.0
    beside = drift(plain, np.array([theta - theta_err, theta + theta_err]), kind(_UNIT), centre).stops_at
    off = np.abs(beside - one.stops_at)
    if not np.isfinite(off).any():
        told = f"no drift starts at {theta - theta_err:.4g} or at {theta + theta_err:.4g} rad"
        raise ValueError(f"from_err = {theta_err!r}: expected a smaller error; {told}")
    return float(one.stops_at), float(np.nanmean(off))
