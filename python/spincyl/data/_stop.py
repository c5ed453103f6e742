"""A coefficient of loss from a stopwatch: the times in which a body comes to its end."""

import math
import warnings
from typing import Any, Literal, NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._drift import Drift, drift
from spincyl._input.equality import compared
from spincyl._input.numbers import Floats, Reals, number, radians, reals, refuse, si
from spincyl._loss import sized
from spincyl._single import one_body
from spincyl.data._lossfit import CENTRE, Refused
from spincyl.data._report import section, student, variables
from spincyl.data._spindown import centres, known_law
from spincyl.data._typical import typical

_UNIT = 1e-9  #: So small a coefficient that the law holds at all inclinations of the drift.
_ENDS = ("face lands", "lies down")  #: What is seen to stop; in any other end the body still moves.
_FEW = 5.0  #: Turns before the end, below which the drift is not slow.
_LONGEST = 1e9  #: Seconds.
_FAR = 10.0  #: Times as large as anything typical.
_MIXED = 3.0  #: Largest ratio of times in one unit.


@compared
class FittedStop(NamedTuple):
    """A coefficient of loss by one of the two drifts; from `fit_stop`."""

    centre: str  #: "rest" or "rolling"
    law: Any  #: the law with this coefficient
    coefficient: float  #: in natural units, as the law has it
    coefficient_err: float  #: its standard error
    by_times: float  #: the part of it that is due to the times
    by_angle: float  #: and to the starting angle
    drift: Drift  #: from the starting angle to the mean of the times

    @property
    def coefficient_si(self) -> float:
        """The coefficient in the unit that `from_si` takes; an error says where that needs a mass."""
        return float(self.law.in_si(self.drift.body))

    @property
    def coefficient_err_si(self) -> float:
        """Its standard error in the same unit."""
        return self.coefficient_si * self.coefficient_err / self.coefficient

    @property
    def _printed(self) -> tuple[float, float, str]:
        """The coefficient, its error and their unit, as `from_si` reads them."""
        factor, unit = self.law._printed(self.drift.body.scale)
        return factor * self.coefficient, factor * self.coefficient_err, unit

    def __repr__(self) -> str:
        value, error, unit = self._printed
        return f"<{type(self.law).__name__} {CENTRE[self.centre]}: {value:.4g} +- {error:.2g}{unit}>"


@compared
class StopFit(NamedTuple):
    """Measured times until a body stops, and the coefficient that they give; from `fit_stop`."""

    body: Body
    name: str  #: of the law
    theta: float  #: where it starts, radians
    theta_err: float
    seconds: Floats  #: (n,) measured, without what was not
    stops_at: float  #: their mean
    stops_at_err: float  #: its standard error
    fits: tuple[FittedStop, ...]  #: by the drift with the centre at rest, by the rolling one, or both
    refused: tuple[Refused, ...]  #: the drift that cannot be

    def of(self, centre: str) -> FittedStop:
        """The coefficient with the centre at "rest" or "rolling"; KeyError, with the reason, if none."""
        for found in self.fits:
            if found.centre == centre:
                return found
        why = next((f": {no.why}" for no in self.refused if no.centre == centre), "")
        raise KeyError(f"centre: {centre!r} was not fitted{why}")

    def _about(self) -> list[tuple[str, str]]:
        """What was measured, in words."""
        angle = f"{math.degrees(self.theta):.4g} +/- {math.degrees(self.theta_err):.2g} degrees"
        return [
            ("body", repr(self.body)),
            ("law", self.name),
            ("starts at", angle),
            ("stops after", f"{self.stops_at:.4g} +/- {self.stops_at_err:.2g} s"),
            ("# times", str(self.seconds.size)),
        ]

    def report(self) -> str:
        """The times and the coefficient with its errors and where they come from, as lmfit writes it."""
        told = []
        for found in self.fits:
            value, error, unit = found._printed
            name = f"{found.law._parameter} {CENTRE[found.centre]}" + (unit and f", in{unit}")
            times, angle = (100 * part / found.coefficient for part in (found.by_times, found.by_angle))
            told.append((name, value, error, f"(times {times:.2g}%, angle {angle:.2g}%)"))
        lines = section("Stopwatch", self._about()) + variables(told)
        return "\n".join(lines + [f"    {no.centre}: not fitted: {no.why}" for no in self.refused])

    def __repr__(self) -> str:
        return f"<StopFit: {'; '.join(repr(found)[1:-1] for found in self.fits)}; {self.seconds.size} times>"

    def _repr_html_(self) -> str:
        from spincyl._studio.cards import drawing, framed

        rows = self._about() + [(CENTRE[one.centre], repr(one)[1:-1].split(": ")[1]) for one in self.fits]
        rows += [(no.centre, f"not fitted: {no.why}") for no in self.refused]
        return framed("StopFit", rows, drawing(self.body, self.theta, "θ"))


def fit_stop(
    body: Body,
    law: Any,
    from_: float,
    seconds: Reals,
    *,
    error: float | None = None,
    from_err: float = 0.0,
    centre: Literal["rest", "rolling"] | None = None,
) -> StopFit:
    """The coefficient of a loss from the time in which a spinning coin stops: all it takes is a stopwatch.

    Parameters
    ----------
    body : Body
        A single measured one.
    law : class of `spincyl.loss`
        Such as ``sc.loss.DryContour``: which law it is, a stopwatch cannot tell (`fit_losses` can).
    from_ : float
        Inclination at which the watch is started, in radians, or a text such as "20deg".
    seconds : array_like
        Time or times from there to the end, in seconds; NaN where one was missed.
    error : float, optional
        Standard error of each time in seconds, such as 0.2 of a hand at a watch. Default: the scatter of the
        times gives it, of which there have to be two.
    from_err : float
        Standard error of the starting angle, in radians or as "2deg". It is taken to be the same in all
        tries, as of a mark that is not quite in its place, so that more tries do not make it smaller.
    centre : {"rest", "rolling"}, optional
        Which drift: the centre held at rest, by slip, or the body rolling all the time. A stopwatch cannot
        tell. Default: both.

    Returns
    -------
    StopFit
        ``.report()`` tells it; ``.of("rest").law`` is what `drift` and `roll` take.

    Raises
    ------
    ValueError
        For times that are not positive, a single time or times that are all the same without `error`; for a
        law under which the body never stops, or stops before it has turned once; for a starting angle
        without a steady state; for a body of unknown size.
    TypeError
        Naming what is no body, law or number.

    Warns
    -----
    DriftWarning, UserWarning
        What the fitted drift warns of; if the body turns less than five times, if one time is three times
        another, and if the coefficient is far from all of `spincyl.loss.typical`: as of minutes typed for
        seconds.

    Notes
    -----
    Times of a drift are as one over the coefficient, so that the mean of the times gives it. Errors are
    propagated to first order, that of the angle by the drift from either end of its error. Errors from the
    scatter of few times are widened by Student's t: two of three coefficients lie within them. The drift is
    of first order in the loss; a motion of `roll` with the coefficient tells how far that goes.

    Examples
    --------
    >>> import spincyl as sc
    >>> coin = sc.measured(outer_diameter="25.75mm", length="2.2mm", mass="8.5g")
    >>> times = [6.9, 7.3, 7.0, 7.4, 7.1]
    >>> found = sc.data.fit_stop(coin, sc.loss.DryContour, "20deg", times, from_err="2deg", centre="rest")
    >>> found.of("rest")
    <DryContour with the centre at rest: 0.006845 +- 0.001 mm>
    """
    one_body(body)
    if body.scale is None:
        raise ValueError("body: its size is not known: make it by sc.measured, or give it a scale")
    kind = known_law("law", law)
    theta, theta_err = (
        number(name, radians(name, x)) for name, x in (("from_", from_), ("from_err", from_err))
    )
    refuse("from_", theta, lambda x: ~(x > 0), "expected a positive angle (radians)")
    refuse("from_err", theta_err, lambda x: ~((x >= 0) & (x < theta)), "expected 0 or more, less than from_")
    times, mean, mean_err = _timed(seconds, error)
    turns = mean * float(body.hertz(theta))
    if turns < 1:
        told = f"it would stop within {turns:.2g} of a turn, and no drift is so fast"
        raise ValueError(f"seconds = {mean:.6g}: {told}: are the times in seconds?")
    fits, refused = [], []
    with warnings.catch_warnings(record=True, action="always") as said:
        for one in centres(centre):
            try:
                fits.append(_fitted(body, kind, one, (theta, theta_err), (mean, mean_err)))
            except ValueError as e:
                refused.append((one, e))
    if not fits:
        raise refused[0][1]
    _doubt(fits[0])
    for kept in {one.category: one for one in said}.values():  # not once for each centre
        warnings.warn(kept.message, kept.category, stacklevel=2)
    if turns < _FEW:
        told = (
            f"it turns {turns:.2g} times before it stops, too few for a slow drift: are the times in seconds?"
        )
        warnings.warn(told, UserWarning, stacklevel=2)
    return StopFit(
        body,
        kind.__name__,
        theta,
        theta_err,
        times,
        mean,
        mean_err,
        tuple(fits),
        tuple(Refused(kind.__name__, one, str(why)) for one, why in refused),
    )


def _doubt(found: FittedStop) -> None:
    """Warn of a coefficient that is far from all that are typical of its law."""
    value, _, unit = found._printed
    rows = [row for row in typical() if row.of.split()[0] == type(found.law).__name__]
    if not unit or not rows:
        return
    low, high = min(row.low for row in rows), max(row.high for row in rows)
    if not low / _FAR <= value <= high * _FAR:
        known = " to ".join(dict.fromkeys(f"{x:.2g}" for x in (low, high)))
        told = f"{found.law._parameter} = {value:.2g}{unit} is far from the {known}{unit}"
        asks = "are the times in seconds, or is it another law?"
        warnings.warn(f"{told} of sc.loss.typical: {asks}", UserWarning, stacklevel=3)


def _timed(seconds: Reals, error: float | None) -> tuple[Floats, float, float]:
    """The times, their mean and its standard error."""
    given = np.asarray(reals("seconds", si("seconds", seconds, "second")), np.float64)
    if given.ndim > 1:
        raise ValueError(f"seconds: expected a time or a list of them, not shape {given.shape}")
    refuse(
        "seconds", given, lambda x: (x <= 0) | (x > _LONGEST), f"expected more than 0, at most {_LONGEST:g}"
    )
    times = np.atleast_1d(given)[np.isfinite(np.atleast_1d(given))]
    if not times.size:
        raise ValueError("seconds: expected at least one time")
    mean = float(np.mean(times))
    one = math.nan if error is None else number("error", si("error", error, "second"))
    if error is not None:
        refuse("error", one, lambda x: ~((x > 0) & (x < mean)), "expected a positive time, less than it took")
    elif times.size < 2 or np.ptp(times) == 0:
        what = "one time says" if times.size < 2 else "times that are all the same say"
        raise ValueError(f"seconds: {what} nothing of its error: give it, as in error=0.2")
    if times.max() > _MIXED * times.min():
        told = f"the times go from {times.min():.4g} to {times.max():.4g} s: are all of them in seconds?"
        warnings.warn(told, UserWarning, stacklevel=3)
    scatter = float(np.std(times, ddof=1)) if times.size > 1 else 0.0
    spread = scatter * student(1.0, times.size - 1) if error is None else max(one, scatter)
    return times, mean, spread / math.sqrt(times.size)


def _fitted(
    body: Body, kind: Any, centre: str, angle: tuple[float, float], time: tuple[float, float]
) -> FittedStop:
    """The coefficient by one drift, from the inclination and the mean time with their errors."""
    (theta, theta_err), (mean, mean_err), name = angle, time, kind.__name__
    plain, second = body.natural, body.scale.seconds(1.0)  # type: ignore[union-attr]
    try:
        one = drift(plain, theta, kind(_UNIT), centre)
    except ValueError as e:
        raise ValueError(f"from_: {e}") from None
    if math.isinf(one.stops_at):
        never = f"under {name} this body never stops from {math.degrees(theta):.4g} degrees on"
        raise ValueError(f"law: {never}, so that no time tells its coefficient")
    if one.ended not in _ENDS:
        at = f"at {math.degrees(one.ends_at_theta):.3g} degrees, where the body still moves"
        raise ValueError(f"law: this drift by {name} ends ({one.ended}) {at}; no stopwatch sees it")
    beside = drift(plain, np.array([theta - theta_err, theta + theta_err]), kind(_UNIT), centre).stops_at
    off = np.abs(beside - one.stops_at)
    if theta_err and not np.isfinite(off).any():
        raise ValueError(f"from_err = {theta_err!r}: there is no drift from either end of this error")
    coefficient = _UNIT * one.stops_at / (mean / second)
    by_times = coefficient * mean_err / mean
    by_angle = coefficient * float(np.nanmean(off)) / one.stops_at if theta_err else 0.0
    law = sized(kind(coefficient), body)
    found = drift(body, theta, law, centre)
    return FittedStop(centre, law, coefficient, math.hypot(by_times, by_angle), by_times, by_angle, found)
