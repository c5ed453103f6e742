"""Times by a stopwatch from one or several first inclinations: outliers, robust means, their errors."""

import math
import re
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from spincyl._input.numbers import Floats, number, radians, reals, refuse_bad_value, si
from spincyl.lab._report import student

_LONGEST = 1e9  #: Seconds.
_FREEDOM = 4  #: With fewer degrees of freedom the scatter does not show which time is an outlier.
#: An outlier is beyond this many robust standard deviations from the median, and beyond these for one degree
#: of freedom more. One of 200 sets of 5 to 40 normal times has such a time.
_OUTLIER, _OUTLIER_OF_FEW = 4.0, 30.0
#: Least scatter that decides on an outlier, and on what is clipped, as shares of the median: watches have
#: tenths of a second.
_STEADY, _ROUNDED = 0.02, 0.005
#: Trial values of both parts of the scatter, in units of the median deviation.
_PARTS = np.append(0.0, np.geomspace(0.1, 20.0, 24))
#: Share of times that are taken to be anywhere up to the longest time when the parts are compared.
_ANYWHERE = 0.05
#: A stated error does not hold if the scatter is more likely by this much, in logarithms of the likelihood.
_UNLIKELY = 3.0
#: A larger ratio of the times from one inclination causes a warning.
_MIXED_RATIO = 3.0
#: Times that are farther than this from the mean count as if they were at this distance (Huber 1964, Ann.
#: Math. Statist. 35, 73), in robust standard deviations. One time of twelve then moves the mean by at most
#: 1.5/12 of a robust standard deviation, less than the error of the mean.
_CLIP = 1.5
#: A number of degrees in the name of a column, in English, German or French; and units of the times.
_IN_DEGREES = re.compile(
    r"((?:(?<!\S)[-+])?(?<![\d.])(?:\d+\.?\d*|\.\d+))\s*(?:[°º](?!C)|(?:deg|degrees?|degr[ée]s?|grad)\b)",
    re.I,
)
_TIMES = {"s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "min": 60.0}


class WildTime(NamedTuple):
    """A time that is left out since it is far from the others; in `StopFit.wild`.

    Attributes
    ----------
    where : str
        Place of the time in the argument, such as "seconds[3, 1]".
    name : str
        Name of the row, such as that of a student; "" if rows have no names.
    theta : float
        First inclination, in radians.
    seconds : float
        The time in seconds.
    deviations : float
        Its distance from the median of the times from the same inclination, in robust standard deviations.
    """

    where: str
    name: str
    theta: float
    seconds: float
    deviations: float

    def told(self) -> str:
        """Text with the place, the value, the name and the first inclination of the time."""
        start = f"from {math.degrees(self.theta):.4g} degrees"
        return f"{self.where} = {self.seconds:.4g} ({f'{self.name}, ' if self.name else ''}{start})"


class Timed(NamedTuple):
    """Measured times, grouped by first inclination, with the robust mean of each group."""

    theta: Floats  #: (k,) first inclinations, ascending
    theta_err: Floats  #: (k,)
    seconds: Floats  #: (n,) all measured times
    group: Any  #: (n,) number of the inclination of each time
    mean: Floats  #: (k,)
    mean_err: Floats  #: (k,)
    wild: tuple[WildTime, ...]
    mixed: str  #: a doubt about the units of times; empty if there is none


class _Trials(NamedTuple):
    """Times with their inclinations, places and names, without missing ones."""

    theta: Floats
    theta_err: Floats
    seconds: Floats
    where: list[str]
    names: list[str]


def timed(from_: Any, seconds: Any, error: float | None, from_err: Any, names: Sequence[str] | None) -> Timed:
    """Group times by first inclination; errors name the argument at fault."""
    trials = _of_table(from_, seconds, from_err, names) if hasattr(from_, "keys") else None
    trials = trials or _of_arrays(from_, seconds, from_err, names)
    if not trials.seconds.size:
        raise ValueError("seconds: expected at least one time")
    theta, group = np.unique(trials.theta, return_inverse=True)
    wide = trials.theta_err >= trials.theta
    refuse_bad_value("from_err", trials.theta_err, lambda _: wide, "expected at least 0, less than from_")
    theta_err = np.array([trials.theta_err[group == k].max() for k in range(theta.size)])
    middle = np.array([np.median(trials.seconds[group == k]) for k in range(theta.size)])
    one = _stated(error, middle, theta)
    off = trials.seconds - middle[group]
    freedom = off.size - theta.size
    kept = np.ones(off.size, bool)
    scatter, known = _scatter(off, middle, group, one)
    far = np.abs(off) / np.maximum(scatter, _STEADY * middle)[group]
    if freedom >= _FREEDOM:
        kept = far <= _OUTLIER + _OUTLIER_OF_FEW / freedom
        kept |= (np.bincount(group, kept) == 0)[group]  # which of two times is wild is not known
    wild = tuple(
        WildTime(
            trials.where[k],
            trials.names[k],
            float(trials.theta[k]),
            float(trials.seconds[k]),
            float(far[k]),
        )
        for k in sorted(np.flatnonzero(~kept).tolist(), key=lambda k: -far[k])
    )
    if wild:  # the others alone
        seconds, own = trials.seconds[kept], group[kept]
        middle = np.array([np.median(seconds[own == k]) for k in range(theta.size)])
        scatter, known = _scatter(seconds - middle[own], middle, own, one)
    reach = _CLIP if freedom >= _FREEDOM else math.inf
    mean, mean_err = _robust_means(trials.seconds[kept], group[kept], scatter, reach, known)
    doubt = "" if wild else _doubt_of_units(trials.seconds, group)
    return Timed(theta, theta_err, trials.seconds, group, mean, mean_err, wild, doubt)


def _doubt_of_units(times: Floats, group: Any) -> str:
    """Why the times from one inclination may not all be in seconds; empty if they may."""
    for k in range(group.max() + 1):
        own = times[group == k]
        if own.max() > _MIXED_RATIO * own.min():
            ends = f"{own.min():.4g} to {own.max():.4g} s"
            return f"from the same inclination, the times range from {ends}: are all in seconds?"
    return ""


def about_wild(wild: tuple[WildTime, ...]) -> str:
    """A warning that names the times that are left out; empty if there are none."""
    if not wild:
        return ""
    named = ", ".join(f"{one.told()}: {one.deviations:.0f}" for one in wild[:3])
    more = f", and {len(wild) - 3} more" if len(wild) > 3 else ""
    return (
        f"{named} standard deviations of the other times from their median{more};"
        f" {'they are' if len(wild) > 1 else 'it is'} left out;"
        " was the stopwatch stopped late, or is the time in another unit?"
    )


def _stated(error: float | None, middle: Floats, theta: Floats) -> float:
    """The stated standard error of a time in seconds; NaN if there is none."""
    if error is None:
        return math.nan
    k = int(np.argmin(middle))
    told = f"the median of {middle[k]:.4g} s of the times from {math.degrees(theta[k]):.4g} degrees"
    one = number("error", si("error", error, "second"))
    expected = f"expected a positive time, less than {told}"
    refuse_bad_value("error", one, lambda x: ~((x > 0) & (x < middle[k])), expected)
    return one


def _scatter(off: Floats, middle: Floats, group: Any, error: float) -> tuple[Floats, bool]:
    """Standard deviation of a time from each inclination, and whether it is absolute.

    Its square has a constant part, as of the reaction, and a part that is proportional to the square of the
    time, as of the release. It is the mean over both parts, weighted by the likelihood of all times. Without
    a stated error the whole is then scaled to the median deviation; with one, the error is used, or a larger
    scatter if the times contradict the error.
    """
    # each median makes one residual small: leave out the least of each inclination
    order = np.lexsort((np.abs(off), group))
    rest = order[np.append(False, np.diff(group[order]) == 0)]
    least = _ROUNDED * middle
    if not rest.size:
        return (least, False) if math.isnan(error) else (np.full(middle.size, error), True)
    own, away = group[rest], off[rest]
    size = max(float(np.median(np.abs(away))), float(least.min()))
    longest = float((middle[own] + away).max()) / size

    def likelihood(variance: Any) -> Any:
        normal = np.exp(-0.5 * (away / size) ** 2 / variance) / np.sqrt(2 * math.pi * variance)
        return np.log((1 - _ANYWHERE) * normal + _ANYWHERE / longest).sum(axis=-1)

    constant, share = (x.reshape(-1, 1) for x in np.meshgrid(_PARTS[1:] ** 2, _PARTS**2))
    variance = np.fmax(constant + share * (middle / middle.max()) ** 2, (error / size) ** 2)
    likely = likelihood(variance[:, own])
    if likely.max() - likelihood(np.full(own.size, (error / size) ** 2)) < _UNLIKELY:
        return np.full(middle.size, error), True
    weight = np.exp(likely - likely.max())
    shape = np.sqrt(weight @ variance / weight.sum())
    if not math.isnan(error):  # it may exceed the scatter of short times: no scale is common to all
        return size * shape, True
    return np.maximum(1.4826 * np.median(np.abs(away) / shape[own]) * shape, least), False


def _robust_means(
    times: Floats, group: Any, scatter: Floats, reach: float, known: bool
) -> tuple[Floats, Floats]:
    """Mean and standard error of the times of each group; times far from the mean are clipped."""
    many = scatter.size
    count = np.bincount(group, minlength=many)
    mean = np.bincount(group, times, many) / count
    for _ in range(50):
        off = (times - mean[group]) / scatter[group]
        clipped = np.clip(off, -reach, reach)
        step = scatter * np.bincount(group, clipped, many) / count
        mean = mean + step
        if np.abs(step / mean).max() < 1e-13:
            break
    if known:
        return mean, scatter / np.sqrt(count)
    free = times.size - many
    share = max(float(np.mean(clipped == off)), 0.5)
    wide = math.sqrt(float(clipped @ clipped) / free) / share if free else 0.0
    if not (wide * scatter > 1e-15 * mean).any():
        what = "equal times have" if free else "a single time has"
        raise ValueError(
            f"seconds: {what} no scatter; give the standard error of a time in seconds, such as error=0.2"
        )
    return mean, wide * student(1.0, free) * scatter / np.sqrt(count)


def _of_table(table: Any, seconds: Any, from_err: Any, names: Sequence[str] | None) -> _Trials:
    """Trials of a table that has a column of times for each inclination, whose name is the inclination."""
    if seconds is not None:
        raise TypeError("seconds: leave it out if from_ is a table, which has the times")
    texts: dict[str, Any] = getattr(table, "texts", {})
    if names is None and texts:
        names = next(iter(texts.values()))
    columns = [name for name in table if name not in texts]
    if not columns:
        raise ValueError("from_: expected at least one column of times, called by its inclination: '20deg'")
    pairs = [_angle_of_column(name, getattr(table, "units", {}).get(name, "")) for name in columns]
    errors = np.broadcast_to(_angle_errors(from_err, (len(columns),)), len(columns))
    trials = []
    for name, (angle, second), err in zip(columns, pairs, errors, strict=True):
        times = second * np.atleast_1d(_seconds(f"from_[{name!r}]", table[name]))
        where = [f"from_[{name!r}][{k}]" for k in range(times.size)]
        trials.append(_trials(np.full(times.size, angle), np.full(times.size, err), times, where, names))
    return _Trials(
        np.concatenate([one.theta for one in trials]),
        np.concatenate([one.theta_err for one in trials]),
        np.concatenate([one.seconds for one in trials]),
        [x for one in trials for x in one.where],
        [x for one in trials for x in one.names],
    )


def _angle_of_column(name: object, unit: str) -> tuple[float, float]:
    """The inclination in the name of a column, in radians, and the unit of its times in seconds."""
    second = _TIMES.get(unit.lower())
    text = (str(name) if second else f"{name}{unit}").replace(",", ".")
    angles = {found[1] for found in _IN_DEGREES.finditer(text)}
    try:
        given = f"{angles.pop()}deg" if len(angles) == 1 else text
        found = float(_inclination(f"from_: the column {name!r}", radians("from_", given)))
        return found, second or 1.0
    except (TypeError, ValueError):
        many = "two inclinations" if angles else "an inclination with its unit"
        told = f"from_: the column {text!r} is {'' if angles else 'not '}called by {many}; expected one"
        raise ValueError(
            f"{told}, as in '20deg', or leave it out, or give from_ and seconds as arrays"
        ) from None


def _of_arrays(from_: Any, seconds: Any, from_err: Any, names: Sequence[str] | None) -> _Trials:
    """Trials with one inclination for all times, for each column of times, or for each time."""
    if seconds is None:
        raise TypeError("seconds: expected the measured times; leave it out only if from_ is a table")
    times = _seconds("seconds", seconds)
    theta = np.asarray(radians("from_", _each("from_", from_)), np.float64)
    errors = _angle_errors(from_err, theta.shape)
    if times.ndim > 2 or theta.ndim > 1:
        shapes = f"shapes {theta.shape} and {times.shape}"
        raise ValueError(
            f"from_, seconds: expected a list of angles, and a list or a table of times, not {shapes}"
        )
    if theta.ndim and times.shape[-1:] != theta.shape:
        told = f"{theta.size} inclinations, and times of shape {times.shape}"
        raise ValueError(
            f"seconds: expected a column for each inclination, or a time for each; there are {told}"
        )
    where = [
        "seconds" + ("[" + ", ".join(map(str, at)) + "]" if at else "") for at in np.ndindex(times.shape)
    ]
    if names is not None and times.ndim == 2:
        names = np.repeat(np.asarray(_checked_names(names, times.shape[0]), object), times.shape[1]).tolist()
    wide = [np.broadcast_to(x, times.shape).reshape(-1) for x in (theta, errors)]
    flat = times.reshape(-1)
    _inclination("from_", np.where(np.isnan(flat), 1.0, wide[0]) if theta.ndim else theta)
    return _trials(wide[0], wide[1], flat, where, names)


def _trials(
    theta: Floats, theta_err: Floats, times: Floats, where: list[str], names: Sequence[str] | None
) -> _Trials:
    """Make trials from arrays of equal length, without missing times."""
    named = _checked_names(names, times.size) if names is not None else [""] * times.size
    for k in np.flatnonzero((times <= 0) | (times > _LONGEST)).tolist()[:1]:
        who = f" ({named[k]})" if named[k] else ""
        told = f"{where[k]} = {float(times[k])!r}{who}"
        raise ValueError(f"{told}: expected more than 0, at most {_LONGEST:g}")
    seen = np.isfinite(times)
    kept = np.flatnonzero(seen).tolist()
    return _Trials(
        theta[seen], theta_err[seen], times[seen], [where[k] for k in kept], [named[k] for k in kept]
    )


def _checked_names(names: Sequence[str], many: int) -> list[str]:
    if isinstance(names, str) or not hasattr(names, "__len__") or np.ndim(np.asarray(names, object)) != 1:
        raise TypeError(f"names: expected a list of names, one for each row, not {type(names).__name__}")
    if len(names) != many:
        raise ValueError(f"names: expected {many} names, one for each row of times, not {len(names)}")
    return [str(name) for name in names]


def _each(name: str, given: Any) -> Any:
    """A value, or a list of values, each of which may be a text with a unit."""
    if isinstance(given, list | tuple):
        return [radians(f"{name}[{k}]", x) for k, x in enumerate(given)]
    return given


def _seconds(name: str, given: Any) -> Floats:
    """Times in seconds, NaN where a list has None."""
    if isinstance(given, list | tuple):
        rows = [np.size(row) for row in given if isinstance(row, list | tuple)]
        if rows and len(set(rows)) > 1:
            raise ValueError(
                f"{name}: expected rows of equal length, with NaN for missing times; lists of any lengths for"
                " each inclination go into from_={'20deg': [...], '45deg': [...]}"
            )
        given = [[_gap(x) for x in row] if isinstance(row, list | tuple) else _gap(row) for row in given]
    return np.asarray(reals(name, si(name, given, "second")), np.float64)


def _gap(x: Any) -> Any:
    return math.nan if x is None else x


def _inclination(name: str, theta: Any) -> Any:
    refuse_bad_value(name, theta, lambda x: ~(x > 0), "expected a positive angle (radians)")
    return theta


def _angle_errors(from_err: Any, shape: tuple[int, ...]) -> Floats:
    """Standard errors of the inclinations."""
    errors = np.asarray(radians("from_err", _each("from_err", from_err)), np.float64)
    if errors.shape not in ((), shape):
        raise ValueError(f"from_err: expected a number or shape {shape}, not {errors.shape}")
    refuse_bad_value("from_err", errors, lambda x: ~(x >= 0), "expected at least 0, less than from_")
    return errors
