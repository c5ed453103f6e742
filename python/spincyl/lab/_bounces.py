"""Bounces of a ball from the times of their sounds: coefficient of restitution and height of the drop.

Between two bounces the ball flies for T = 2 v/g, up to the height h = g T^2/8, and each bounce multiplies the
speed v by e, so that T_(n+1) = e T_n (Bernstein 1977, Am. J. Phys. 45, 41; Stensgaard and Laegsgaard 2001,
Am. J. Phys. 69, 301).
"""

import math
import warnings
from typing import NamedTuple

import numpy as np

from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import Floats, Reals, number, reals, refuse_bad_value, si
from spincyl._scale import Scale
from spincyl.lab._bouncefit import FlightLine, Numbers, fitted, logarithms, slope_of
from spincyl.lab._clicks import clicks
from spincyl.lab._report import section, variables, with_error

_LEAST = 4  #: Clicks, from which two parameters and their error follow.
_MOST = 1000  #: Clicks; more are no bounces.
_NEAR = 0.12  #: A click is that of a bounce if it is off by less than this share of the interval.
_SKIPPED = 2  #: Bounces in a row that may be missed.
_NEIGHBOURS = 5  #: The first three bounces are sought among this many clicks after each.
_RATIOS = (0.1, 1.0)  #: Of intervals.
_SHORTEST = 2e-3  #: Seconds; bounces are not followed below this interval.
_ODD = 0.01  #: Relative deviation of the first or last interval that is never odd, and scatter that is none.
_RECORDED = 2e-4  #: Standard error of the time of a click in a recording, in seconds.
_MISSED = 2.0  #: What a missed bounce weighs; one more that is heard weighs 3 to 5 where the ratio is steady.
#: Share of clicks that may be left out, or missed, without a warning, and height of a drop in metres.
_LOST, _HIGHEST = 1 / 3, 100.0


@compared_by_value
class Bounces(NamedTuple):
    """Coefficient of restitution and heights from the sounds of bounces; returned by `fit_bounces`.

    Method: ``report()``.

    Attributes
    ----------
    restitution : float
        Coefficient of restitution: ratio of the intervals of successive bounces, on average.
    restitution_err : float
        Standard error of `restitution`.
    height : float
        Height of the drop, in metres, if the first click in `t` is the first impact. The height assumes that
        this impact had the same restitution as the others, or followed their trend.
    height_err : float
        Standard error of `height`.
    rebound : float
        Height after the first impact, in metres, without any assumption on its restitution.
    rebound_err : float
        Standard error of `rebound`.
    fall : float
        Height of the drop from the time of the fall, in metres; NaN without `released`.
    fall_err : float
        Standard error of `fall`.
    first : float
        Coefficient of restitution of the first impact alone, from the time of the fall; NaN without
        `released`.
    first_err : float
        Standard error of `first`.
    trend : float
        Change of the coefficient from one impact to the next.
    trend_err : float
        Standard error of `trend`.
    t : ndarray, (n,)
        Times of the clicks that are bounces, in seconds.
    bounce : ndarray, (n,)
        Number of the bounce at each time in `t`, from 0; a number is skipped where a click was missed.
    missed : ndarray
        Times of bounces that were not heard, between the first and the last click.
    extra : ndarray
        Times of clicks that are no bounces.
    gravity : float
        Acceleration of gravity, in m/s^2.
    """

    restitution: float
    restitution_err: float
    height: float
    height_err: float
    rebound: float
    rebound_err: float
    fall: float
    fall_err: float
    first: float
    first_err: float
    trend: float
    trend_err: float
    t: Floats
    bounce: Numbers
    missed: Floats
    extra: Floats
    gravity: float

    def report(self) -> str:
        """Return a report in lmfit's style: the bounces, and the coefficient and heights with errors."""
        rows = [("# bounces", f"{self.t.size}, from {self.t[0]:.4g} to {self.t[-1]:.4g} s")]
        for name, times in (("missed", self.missed), ("no bounces", self.extra)):
            if times.size:
                rows.append(
                    (name, ", ".join(f"{x:.4g}" for x in times[:8]) + " s" + ", ..." * (times.size > 8))
                )
        told = [
            ("restitution", self.restitution, self.restitution_err, ""),
            ("height after the first impact, in m", self.rebound, self.rebound_err, ""),
            ("height of the drop, in m", self.height, self.height_err, "(extrapolated)"),
        ]
        if math.isfinite(self.fall):
            told += [
                ("height of the drop, in m", self.fall, self.fall_err, "(from the fall)"),
                ("restitution of the first impact", self.first, self.first_err, "(from the fall)"),
            ]
        told.append(("change of restitution per bounce", self.trend, self.trend_err, ""))
        return "\n".join(section("Bounces", rows) + variables(told))

    def __repr__(self) -> str:
        heard = f"{self.t.size} bounces"
        for count, what in ((self.missed.size, "missed"), (self.extra.size, "no bounces")):
            heard += f", {count} {what}" if count else ""
        e = with_error(self.restitution, self.restitution_err)
        return (
            f"<Bounces: restitution {e}, dropped from {with_error(self.height, self.height_err)} m; {heard}>"
        )

    def _repr_html_(self) -> str:
        from spincyl.studio.cards import framed

        e, height = (
            with_error(self.restitution, self.restitution_err),
            with_error(self.height, self.height_err),
        )
        rows = [("restitution", e), ("height of the drop", f"{height} m"), ("bounces", str(self.t.size))]
        return framed("Bounces", rows, "")


def fit_bounces(
    t: Reals,
    sound: Reals | None = None,
    *,
    error: float | None = None,
    released: float | None = None,
    gravity: float = Scale.gravity,
) -> Bounces:
    """Fit the coefficient of restitution and the height of a drop to the times of the bounces of a ball.

    Parameters
    ----------
    t : array_like, 1-D
        Times of the clicks in seconds, in any order; NaN if missing. With `sound`, times of its samples.
    sound : array_like, 1-D, optional
        A recording, as `read_sound` returns it: ``fit_bounces(*read_sound(path))``. A click is where the
        sound rises threefold within milliseconds.
    error : float, optional
        Standard error of the time of a click in seconds. Default: 0.2 ms in a recording; in a list
        of times it is estimated, between 0.1 and
        1.5 ms, together with the scatter of the restitution, which it cannot always tell apart.
    released : float, optional
        Time at which the ball was released at rest. The fall itself then gives the height and the restitution
        of the first impact.
    gravity : float
        Acceleration of gravity, in m/s^2.

    Returns
    -------
    Bounces
        ``.report()`` summarises the fit. `roll` takes ``restitution``, and `dropped` the ``height``.

    Raises
    ------
    ValueError
        If there are fewer than four bounces (three, if `error` is given) whose intervals shrink by a common
        ratio. If the recording is silent, or has fewer than 2000 samples a second.
    TypeError
        If an argument is not real numbers; the message names it.

    Warns
    -----
    UserWarning
        If the ratio of the intervals changes along the bounces, as it does for a ball that air slows down.
        If more than a third of the clicks are no bounces, or more than a third of the bounces are missed.
        If the height of the drop exceeds 100 m.

    Notes
    -----
    The intervals of successive bounces give the restitution, and together with gravity the height after each
    bounce. The sound of the first impact does not tell how far the ball had fallen: `height` extrapolates the
    intervals to one before the first impact, and usually is a little too small, since faster impacts lose
    more. Neither the radius of the ball nor its spin matters; the air and a table that gives way do.

    Clicks that do not fit are left out, and missed ones are counted: of all rows of clicks that are off by
    less than 12 % of their intervals, with at most two missed ones in a row, the likeliest is taken. The
    times are fitted by generalised least squares as sums of flights. Two sources of scatter, the times of the
    clicks and the restitution of each bounce, are averaged over, weighted by restricted likelihood (Patterson
    and Thompson 1971, Biometrika 58, 545) and by a prior: a constant restitution has the probability 0.95
    with `error`, and 0.6 without; else it scatters by 0.2 to 10 %. Without `error` the times scatter by 0.1
    to 1.5 ms; give `error` for clicks that are worse, as from a film.

    Examples
    --------
    >>> import spincyl as sc
    >>> heard = sc.data.fit_bounces([0.452, 1.231, 1.932, 2.562, 3.130, 3.640, 4.100])
    >>> heard
    <Bounces: restitution 0.89990 +- 0.00093, dropped from 0.9184 +- 0.0047 m; 7 bounces>
    """
    times = clicks(t, sound) if sound is not None else _click_times(t)
    g = number("gravity", si("gravity", gravity, "metre/second**2"))
    refuse_bad_value("gravity", g, lambda x: ~((x > 0) & (x < np.inf)), "expected a positive number")
    one = _RECORDED if sound is not None else math.nan
    if error is not None:
        one = number("error", si("error", error, "second"))
        refuse_bad_value("error", one, lambda x: ~((x > 0) & (x < 1)), "expected a positive time below 1 s")
    least = _LEAST if error is None else _LEAST - 1
    what = "clicks" if sound is None else "clicks in the recording"
    if not least <= times.size <= _MOST:
        raise ValueError(f"t: expected {least} to {_MOST} {what}, not {times.size}")
    found = _without_strangers(times, _best_row(times), one)
    if len(found) < least:
        raise ValueError(
            f"t: no {least} of the {times.size} {what} have intervals that shrink by a common ratio"
        )
    at = np.array([times[k] for _, k in found])
    number_ = np.array([n for n, _ in found])
    line = fitted(at, number_, 1, one)
    bent = fitted(at, number_, 2, one) if at.size > _LEAST else None
    e = math.exp(line.beta[1])
    if not e < 1:
        raise ValueError(f"t: each interval is {e:.4g} times the one before: expected less than 1")
    e_err = e * math.sqrt(line.covariance[1, 1])
    trend, trend_err = math.nan, math.nan
    if bent is not None:
        trend, trend_err = 2 * e * bent.beta[2], 2 * e * math.sqrt(bent.covariance[2, 2])
    bends = bent is not None and abs(trend) > bent.sure * trend_err
    shape = bent if bent is not None and bends else line
    before, before_err = shape.at(-1.0)
    after, after_err = shape.at(0.0)
    before_err = math.hypot(before_err, shape.each)  # the first impact has a scatter of its own
    height, rebound = (g * math.exp(2 * x) / 8 for x in (before, after))
    fall = _fall(released, at[0], after, (after_err, one if math.isfinite(one) else line.jitter), g)
    extra, missed = np.setdiff1d(times, at), []
    for n in np.setdiff1d(np.arange(number_[-1]), number_):
        heard = int(np.searchsorted(number_, n)) - 1
        lasts = sum(math.exp(shape.at(float(j))[0]) for j in range(number_[heard], n))
        missed.append(float(at[heard]) + lasts)
    result = Bounces(
        e,
        e_err,
        height,
        2 * height * before_err,
        rebound,
        2 * rebound * after_err,
        *fall,
        trend,
        trend_err,
        at,
        number_,
        np.array(missed),
        extra,
        g,
    )
    for doubt in _doubts(result, bool(bends), shape):
        warnings.warn(doubt, UserWarning, stacklevel=2)
    return result


def _doubts(found: Bounces, bends: bool, shape: FlightLine) -> list[str]:
    """Texts of warnings: too high a drop, a ratio of intervals that changes, many wrong or missed clicks."""
    high = found.height > _HIGHEST
    said = [f"t: such bounces follow a drop from {found.height:.3g} m; are these milliseconds?"] * high
    if bends:
        last = float(found.bounce[-1])
        ends = [math.exp(shape.at(x)[0] - shape.at(x - 1)[0]) for x in (0.0, last - 1)]
        told = f"t: the ratio of the intervals changes, from {ends[0]:.4g} at the first impact"
        told += f" to {ends[1]:.4g} at the end"
        said.append(f"{told}; the restitution depends on the speed, or the air slows the ball")
    if found.extra.size > _LOST * (found.extra.size + found.t.size):
        said.append(f"t: {found.extra.size} of {found.extra.size + found.t.size} clicks are no bounces")
    if found.missed.size > _LOST * (found.bounce[-1] + 1):
        said.append(f"t: {found.missed.size} of {found.bounce[-1] + 1} bounces were not heard")
    return said


def _click_times(t: Reals) -> Floats:
    times = np.asarray(reals("t", t), np.float64)
    if times.ndim != 1:
        raise ValueError(f"t: expected a list of times, not shape {times.shape}")
    if np.isinf(times).any():
        raise ValueError("t: expected finite times, or NaN for missing ones")
    return np.unique(times[np.isfinite(times)])


def _fall(
    released: float | None, first: float, after: float, errors: tuple[float, float], g: float
) -> tuple[float, float, float, float]:
    """Height of the drop from the time of the fall, and the restitution of the first impact, with errors."""
    if released is None:
        return (math.nan,) * 4
    begun = number("released", si("released", released, "second"))
    lasts = first - begun
    if not 0 < lasts < 100:
        raise ValueError(
            f"released = {begun!r}: expected a time up to 100 s before the first bounce, at {first:.6g} s"
        )
    # both ends of the fall are clicks, or known as well as these
    share = math.sqrt(2) * errors[1] / lasts
    e = math.exp(after) / (2 * lasts)
    return g * lasts**2 / 2, g * lasts**2 * share, e, e * math.hypot(share, errors[0])


def _best_row(times: Floats) -> list[tuple[int, int]]:
    """The likeliest bounces: pairs of the number of a bounce and the index of its click."""
    best: list[tuple[int, int]] = []
    least = 0.0
    for i in range(times.size):
        for j in range(i + 1, min(i + _NEIGHBOURS, times.size)):
            for k in range(j + 1, min(j + _NEIGHBOURS, times.size)):
                one, two = times[j] - times[i], times[k] - times[j]
                if not _RATIOS[0] * one < two < _RATIOS[1] * one:
                    continue
                row = _followed(times, [(0, i), (1, j), (2, k)], 1)
                row = _followed(times, row, -1)
                doubt = _doubt(times, row)
                if not best or doubt < least:
                    best, least = row, doubt
    return best


def _doubt(times: Floats, row: list[tuple[int, int]]) -> float:
    """How unlikely a row of bounces is: less for many bounces with a steady ratio, more for missed ones."""
    n = np.array([n for n, _ in row])
    x, y = logarithms(times[[k for _, k in row]], n)
    off = y - y.mean() - slope_of(x, y) * (x - x.mean())
    free = y.size - 2
    scatter = math.sqrt(float(off @ off) / free) if free else 0.0
    return free * math.log(scatter + _ODD) + _MISSED * float(n[-1] - n[0] + 1 - n.size)


def _without_strangers(times: Floats, row: list[tuple[int, int]], error: float) -> list[tuple[int, int]]:
    """A row of bounces without its first or last click if this does not fit the others, such as a knock."""
    for end in (0, -1):
        rest = row[1:] if end == 0 else row[:-1]
        if len(rest) < _LEAST + 1 or abs(row[end][0] - rest[end][0]) > 1:
            continue
        n = np.array([n for n, _ in rest])
        line = fitted(times[[k for _, k in rest]], n, 1, error)
        expected, err = line.at(n[0] - 1.0 if end == 0 else float(n[-1]))
        off = math.log(abs(times[row[end][1]] - times[rest[end][1]])) - expected
        both = math.sqrt(2) * line.jitter / math.exp(expected)
        if abs(off) > line.sure * math.hypot(err, max(line.each, 2 * _ODD), both):
            row = rest
    return [(n - row[0][0], k) for n, k in row]


def _followed(times: Floats, row: list[tuple[int, int]], way: int) -> list[tuple[int, int]]:
    """Extend a row of bounces by the clicks after it (`way` is 1) or before it (`way` is -1)."""
    row = list(row)
    skipped = 0
    while skipped <= _SKIPPED:
        near = row[-4:] if way > 0 else row[:4]  # the restitution may change slowly
        middle, y = logarithms(times[[k for _, k in near]], np.array([n for n, _ in near]))
        ratio = slope_of(middle, y)
        last, index = row[-1] if way > 0 else row[0]
        end, place = (
            (y[-1] - ratio * middle[-1], times[index])
            if way > 0
            else (y[0] - ratio * middle[0], times[index])
        )
        steps = [math.exp(end + ratio * (last + way * s - (way < 0))) for s in range(skipped + 1)]
        if not _SHORTEST < steps[-1] < 1e3:
            break
        expected = place + way * sum(steps)
        k = int(np.argmin(np.abs(times - expected)))
        beyond = k > row[-1][1] if way > 0 else k < row[0][1]
        if beyond and abs(times[k] - expected) < _NEAR * steps[-1]:
            found = (last + way * (skipped + 1), k)
            row = [*row, found] if way > 0 else [found, *row]
            skipped = 0
        else:
            skipped += 1
    return row
