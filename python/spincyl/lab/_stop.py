"""A coefficient of loss from a stopwatch: the time in which a spinning body stops."""

import math
import warnings
from typing import Any, Literal, NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._drift import Drift, drift
from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import Floats, Reals, number, radians, reals, refuse_bad_value, si
from spincyl._loss import marked_as_si
from spincyl._single import one_body
from spincyl.lab._lossfit import CENTRE, Refused
from spincyl.lab._report import section, student, variables
from spincyl.lab._spindown import centres, known_law
from spincyl.lab._typical import far_from_typical

_UNIT = 1e-9  #: Coefficient so small that the law holds at all inclinations of the drift.
_ENDS = ("face lands", "lies down")  #: Ends at which the body is seen to stop.
_FEWEST_TURNS = 5.0  #: With fewer turns before the end the drift is not slow.
_LONGEST = 1e9  #: Seconds.
_MIXED_RATIO = 3.0  #: A larger ratio of the times causes a warning.
_FEWEST_TIMES = 5  #: With fewer times their scatter does not show which of them is an outlier.
#: Robust standard deviations from the median, and the least of these deviations as a share of the median. Of
#: 1000 sets of five normal times one has a time that is farther.
_OUTLIER, _STEADY = 9.0, 0.02


@compared_by_value
class FittedStop(NamedTuple):
    """Coefficient of a loss for one of the two kinds of drift; returned by `fit_stop`.

    Attributes
    ----------
    centre : str
        Kind of drift (see `spincyl.drift`): "rest" or "rolling".
    law : loss.Loss
        The law with this coefficient.
    coefficient : float
        Coefficient in natural units, as in the law.
    coefficient_err : float
        Standard error of `coefficient`.
    by_times : float
        Part of the standard error that is due to the times.
    by_angle : float
        Part of the standard error that is due to the first inclination.
    drift : Drift
        Drift from the first inclination to the end, with this coefficient; it lasts the mean of the times.
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
    """Measured times until a body stops, and the coefficient of loss; returned by `fit_stop`.

    Methods: ``of(centre)`` and ``report()``.

    Attributes
    ----------
    body : Body
        The measured body.
    name : str
        Name of the law.
    theta : float
        First inclination, in radians.
    theta_err : float
        Standard error of `theta`.
    seconds : ndarray, (n,)
        Measured times in seconds, without missing ones.
    stops_at : float
        Mean of the times, in seconds.
    stops_at_err : float
        Standard error of the mean.
    fits : tuple of FittedStop
        One fit for each kind of drift: with the centre at rest, or rolling.
    refused : tuple of Refused
        Kinds of drift that could not be fitted, with the reason.
    """

    body: Body
    name: str
    theta: float
    theta_err: float
    seconds: Floats
    stops_at: float
    stops_at_err: float
    fits: tuple[FittedStop, ...]
    refused: tuple[Refused, ...]

    def of(self, centre: str) -> FittedStop:
        """Return the fit for the drift "rest" or "rolling"; KeyError with the reason if there is none."""
        for found in self.fits:
            if found.centre == centre:
                return found
        why = next((f": {no.why}" for no in self.refused if no.centre == centre), "")
        raise KeyError(f"centre: {centre!r} was not fitted{why}")

    def _about(self) -> list[tuple[str, str]]:
        """The measurement in words."""
        angle = f"{math.degrees(self.theta):.4g} +/- {math.degrees(self.theta_err):.2g} degrees"
        return [
            ("body", repr(self.body)),
            ("law", self.name),
            ("starts at", angle),
            ("stops after", f"{self.stops_at:.4g} +/- {self.stops_at_err:.2g} s"),
            ("# times", str(self.seconds.size)),
        ]

    def report(self) -> str:
        """Return a report in lmfit's style: the times, and the coefficient with the parts of its error."""
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
        from spincyl.studio.cards import drawing, framed

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
    """Fit the coefficient of a loss to the time in which a spinning coin stops, measured with a stopwatch.

    Parameters
    ----------
    body : Body
        Single measured body.
    law : class of `spincyl.loss`
        For instance ``sc.loss.DryContour``. A stopwatch cannot tell which law holds (`fit_losses` can).
    from_ : float
        Inclination at which the stopwatch is started, in radians, or a text such as "20deg".
    seconds : array_like
        Measured times from the start of the stopwatch until the body stops, in seconds; NaN if missing.
    error : float, optional
        Standard error of each time in seconds, such as 0.2 for a watch started by hand. Default: the error is
        estimated from the scatter of the times, which needs at least two different times.
    from_err : float
        Standard error of `from_`, in radians or as a text such as "2deg". The error is assumed to be the same
        in all trials, like the error of a mark, so that more trials do not reduce it.
    centre : {"rest", "rolling"}, optional
        Kind of drift: with the centre held at rest by slip, or of a body that rolls all the time. A stopwatch
        cannot distinguish them. Default: both.

    Returns
    -------
    StopFit
        ``.report()`` summarises the fit; `drift` and `roll` take ``.of("rest").law``.

    Raises
    ------
    ValueError
        If times are not positive. If `error` is missing and there is only one time, or all times are equal.
        If the body never stops under the law, or stops within its first turn. If there is no steady state at
        the first inclination. If the size of the body is unknown.
    TypeError
        If an argument is not a body, a law or a number; the message names it.

    Warns
    -----
    DriftWarning
        Warnings of the fitted drift are passed on.
    UserWarning
        If the body turns less than five times. If one of five or more times is an outlier: more than nine
        standard deviations, estimated by the median deviation, from the median. If the longest time is three
        times the shortest or more. If the coefficient is far from all values in `spincyl.loss.typical`, for
        example because minutes were given for seconds.

    Notes
    -----
    The duration of a drift is inversely proportional to the coefficient, so the mean of the times gives the
    coefficient. Errors are propagated to first order. The part from the inclination follows from drifts that
    begin at both ends of its error interval. An error from the scatter of only a few times is widened by
    Student's t, so that the error interval contains the true coefficient in two of three cases. The drift is
    of first order in the loss; to see how accurate this is, compute the motion with `roll` and the law.

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
    kind = known_law("law", law)
    theta, theta_err = (
        number(name, radians(name, x)) for name, x in (("from_", from_), ("from_err", from_err))
    )
    refuse_bad_value("from_", theta, lambda x: ~(x > 0), "expected a positive angle (radians)")
    refuse_bad_value(
        "from_err", theta_err, lambda x: ~((x >= 0) & (x < theta)), "expected at least 0, less than from_"
    )
    times, mean, mean_err = _mean_of_times(seconds, error)
    turns = mean * float(body.hertz(theta))
    if turns < 1:
        told = f"the body would stop within {turns:.2g} of a turn, too fast for a drift"
        raise ValueError(f"seconds = {mean:.6g}: {told}; are the times in seconds?")
    fits, refused = [], []
    with warnings.catch_warnings(record=True, action="always") as said:
        for one in centres(centre):
            try:
                fits.append(_fitted_drift(body, kind, one, (theta, theta_err), (mean, mean_err)))
            except ValueError as e:
                refused.append((one, e))
    if not fits:
        raise refused[0][1]
    far = far_from_typical(fits[0].law, body.scale)
    if far:
        warnings.warn(far, UserWarning, stacklevel=2)
    for kept in {one.category: one for one in said}.values():  # not once for each centre
        warnings.warn(kept.message, kept.category, stacklevel=2)
    if turns < _FEWEST_TURNS:
        told = (
            f"the body turns only {turns:.2g} times before it stops, too few for a slow drift: are the times"
            " in seconds?"
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


def _mean_of_times(seconds: Reals, error: float | None) -> tuple[Floats, float, float]:
    """The times, their mean and its standard error."""
    given = np.asarray(reals("seconds", si("seconds", seconds, "second")), np.float64)
    if given.ndim > 1:
        raise ValueError(f"seconds: expected a time or a list of them, not shape {given.shape}")
    refuse_bad_value(
        "seconds", given, lambda x: (x <= 0) | (x > _LONGEST), f"expected more than 0, at most {_LONGEST:g}"
    )
    times = np.atleast_1d(given)[np.isfinite(np.atleast_1d(given))]
    if not times.size:
        raise ValueError("seconds: expected at least one time")
    mean = float(np.mean(times))
    one = math.nan if error is None else number("error", si("error", error, "second"))
    if error is not None:
        refuse_bad_value(
            "error", one, lambda x: ~((x > 0) & (x < mean)), "expected a positive time, less than the mean"
        )
    elif times.size < 2 or np.ptp(times) == 0:
        what = "a single time has" if times.size < 2 else "equal times have"
        raise ValueError(
            f"seconds: {what} no scatter; give the standard error of a time in seconds, such as error=0.2"
        )
    told = _warning_of_outliers(given, times) if times.size >= _FEWEST_TIMES else ""
    if not told and times.max() > _MIXED_RATIO * times.min():
        told = f"the times range from {times.min():.4g} to {times.max():.4g} s: are all of them in seconds?"
    if told:
        warnings.warn(told, UserWarning, stacklevel=3)
    scatter = float(np.std(times, ddof=1)) if times.size > 1 else 0.0
    spread = scatter * student(1.0, times.size - 1) if error is None else max(one, scatter)
    return times, mean, spread / math.sqrt(times.size)


def _warning_of_outliers(given: Floats, times: Floats) -> str:
    """A warning that names times far from the median, in units of the median deviation; empty if none is."""
    middle = float(np.median(times))
    scale = max(1.4826 * float(np.median(np.abs(times - middle))), _STEADY * middle)
    far = np.flatnonzero(np.abs(given - middle) > _OUTLIER * scale)  # not a missing time
    if not far.size:
        return ""
    named = ", ".join(f"seconds[{k}] = {given[k]:.4g}" for k in far[:3]) + ", ..." * (far.size > 3)
    away = abs(given[far] - middle).min() / scale
    least = "at least " if far.size > 1 else ""
    return (
        f"{named}: {least}{away:.2g} standard deviations of the other times from their median {middle:.4g} s;"
        " was the stopwatch stopped late, or is the time in another unit? Set it to NaN to leave it out"
    )


def _fitted_drift(
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
        never = f"with {name}, starting at {math.degrees(theta):.4g} degrees, this body never stops"
        raise ValueError(f"law: {never}, so that no time determines the coefficient")
    if one.ended not in _ENDS:
        at = f"at {math.degrees(one.ends_at_theta):.3g} degrees, where the body still moves"
        raise ValueError(f"law: the drift with {name} ends ({one.ended}) {at}; a stopwatch cannot time it")
    beside = drift(plain, np.array([theta - theta_err, theta + theta_err]), kind(_UNIT), centre).stops_at
    off = np.abs(beside - one.stops_at)
    if theta_err and not np.isfinite(off).any():
        raise ValueError(f"from_err = {theta_err!r}: there is no drift from either end of this interval")
    coefficient = _UNIT * one.stops_at / (mean / second)
    by_times = coefficient * mean_err / mean
    by_angle = coefficient * float(np.nanmean(off)) / one.stops_at if theta_err else 0.0
    law = marked_as_si(kind(coefficient), body)
    found = drift(body, theta, law, centre)
    return FittedStop(centre, law, coefficient, math.hypot(by_times, by_angle), by_times, by_angle, found)
