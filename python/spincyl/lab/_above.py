"""A film from above: the line between a tube's ends turns, and its length gives the inclination.

```text
direction(t) = 2 pi hertz t + const,    sin theta = line / length of the tube
```
"""

import math
import warnings
from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any

import numpy as np

from spincyl._input.numbers import Floats, number, si, whole
from spincyl._measured import sized_body
from spincyl._scale import Scale
from spincyl.lab._alias import Reading, Readings, read
from spincyl.lab._columns import METRES, SECONDS, Camera, Columns, columns_of, picked
from spincyl.lab._filmed import Filmed
from spincyl.lab._report import counted
from spincyl.lab._tracker import read_tracker

_ALSO = {"t": ("time", "Time")}  # other names of a column
# times the tube's length: a longer line raises an error, since noise does not explain it
_LONGEST_LINE = 1.05
# times the tube's length: a shorter line raises an error, since a unit is probably wrong
_SHORTEST_LINE = 0.0105
_FARTHEST = 1e12  # metres or seconds: larger numbers raise an error
_LARGEST_WANDER = 0.3  # radians: a direction that deviates more from uniform rotation causes a warning


def from_above(
    tracks: Mapping[str, Any] | str | PathLike[str],
    tube: Any,
    *,
    scale: Scale | None = None,
    ends: Sequence[str] | None = None,
    ruler: float = 0.0,
    mark_err: float | str | None = None,
    window: int = 5,
    encoding: str | None = None,
) -> Filmed:
    """Measure the rate and inclination of a tube whose two ends were tracked in a film from straight above.

    The result has the steady rate and inclination, and the inclination, the precession and the centre in each
    frame.

    Parameters
    ----------
    tracks : mapping or path
        Tracks by name, as `read_tracker` returns them, or the path of a file for `read_tracker`. The track
        of each end has the columns t, x and y, in seconds and metres. Units in brackets, such as "x (cm)",
        are converted. Rows without a position are left out.
    tube : Body
        Single body of a known size: a measured body, a body from `Body.from_metres`, or any other body
        together with `scale`.
    scale : Scale, optional
        Size of `tube`, for a body without a size of its own.
    ends : two names, optional
        Names of the tracks of the two ends. Default: O and X, or the only two tracks.
    ruler : float
        Relative standard error of the film's scale of length; 0.01 means one per cent. Near 90 degrees this
        error limits the accuracy of the inclination.
    mark_err : float or str, optional
        Standard error of each coordinate of a mark, in metres, or with a unit as in "0.3mm". It determines
        the errors of single frames. Default: estimated from the scatter of the marks.
    window : int
        Number of neighbouring frames, at least 3, whose directions give the precession in a frame. More
        frames give a smaller error, but average over faster changes.
    encoding : str, optional
        Encoding of the file, as in `read_table`.

    Returns
    -------
    Filmed
        ``.report()`` summarises the measurement, ``.plot()`` draws it; `compare` takes ``theta``, ``rate``
        and their errors, or the whole film for comparison with a motion.

    Raises
    ------
    ValueError
        If the body is shorter than wide.
        If there are fewer than three frames, a track or column is missing, or an end has two positions at one
        time. If the line between the ends is much longer or very much shorter than the tube. If the tube
        turns by about half a turn from frame to frame, and the inclination does not decide in which sense. If
        the size of the tube is unknown.
    TypeError
        If an argument is of the wrong type; the message names it.
    OSError
        If the file cannot be read.

    Warns
    -----
    UserWarning
        If the line between the ends is a little longer than the tube; the inclination is then near 90 degrees
        but not known exactly. If the line does not turn evenly. If the inclination is more than four of its
        errors from every steady state at the slowest rate that the frames may show; the message names faster
        rates that look the same and are steady. If several rates are possible (`Filmed.aliases`).

    Notes
    -----
    The rate is the slope of the direction of the line over time, by least squares. Its error follows from the
    scatter, and is larger if the errors of neighbouring frames are correlated. The inclination follows from
    the median length of the line. If the tube turns by more than half a turn from frame to frame, it looks
    like a slow rotation, often backwards: at 30 frames a second 20 turns a second look like 10. Of the rates
    that look the same (up to two and a half turns from frame to frame, and 10 m/s at the ends of the tube),
    the slowest is taken if the measured inclination is steady there. If it is not, and is steady at just one
    faster rate, this rate is taken, with a warning. Uneven times of the frames also exclude rates. The
    inclination can decide only as well as its error is known: give `ruler`.

    The camera is taken to be far away. At a distance D from the table, a mark at the height z seems to be
    farther from the middle of the picture by the factor 1 / (1 - z / D), which is not corrected.

    Examples
    --------
    >>> import spincyl as sc
    >>> inch = 25.4e-3
    >>> tube = sc.Body.from_metres(outer_diameter=0.625 * inch, inner_diameter=0.5 * inch, length=3.75 * inch)
    >>> sc.data.from_above(sc.data.example("tube_from_above"), tube)
    <Filmed: 7.2936 +- 0.0018 turns a second, 82.98 +- 0.30 degrees, steady at 83.4; 32 frames>
    """
    body, scale = sized_body("tube", tube, scale)
    window = whole("window", window, 3, 1001)
    if mark_err is not None:
        mark_err = number("mark_err", si("mark_err", mark_err, "metre"))
        if not 0 < mark_err < math.inf:
            raise ValueError(f"mark_err = {mark_err!r}: expected a positive number, in metres")
    ruler = number("ruler", ruler)
    if not 0 <= ruler < 0.5:
        raise ValueError(f"ruler = {ruler!r}: expected at least 0 and less than 0.5; 0.01 means one per cent")
    if isinstance(tracks, str | PathLike):
        tracks = read_tracker(tracks, encoding=encoding)
    if not isinstance(tracks, Mapping):
        raise TypeError(f"tracks: expected a dict of tracks, or a path, not {type(tracks).__name__}")
    tall = float(scale.metres(2.0 * (body.ell + body.fillet)))
    wide = float(scale.metres(2.0))
    if tall < wide:
        raise ValueError(
            f"tube: from_above is for tubes, whose axis is the line between two marks at the ends,"
            f" not for a body that is {tall / wide:.2g} times as long as wide"
        )
    names = _ends(tracks, ends)
    first, second = (_positions(tracks, name) for name in names)
    t, marks, unseen = _both_ends(first, second)
    between = marks[:, 0] - marks[:, 1]
    line = np.abs(between)
    share, share_err = _sine_of_inclination(line / tall, ruler)
    one = float(scale.hertz(body, 1.0))
    # a line that is longer than the tube only says that the inclination is near 90 degrees
    sine, sine_err = min(share, 1.0), max(share_err, share - 1)
    films = read(t, _unwrapped(t, between), body, one=one, line=share * tall, sine=sine, sine_err=sine_err)
    told = _warning_of_aliases(films, t, math.degrees(math.asin(min(share, 1.0))))
    slope, inclinations = films.taken.slope, films.taken.inclinations
    hertz, hertz_err = abs(slope) / (2 * math.pi), films.taken.slope_err / (2 * math.pi)
    # near 90 degrees the sine hardly changes, so errors are not small beside the distance from 90 degrees
    low, high = (math.asin(min(max(share + k * share_err, 0.0), 1.0)) for k in (-1, 1))
    theta = math.asin(share) if share <= 1 else math.nan
    found = Filmed(
        body=body,
        scale=scale,
        t=t,
        direction=films.taken.direction,
        line=line,
        hertz=hertz,
        hertz_err=hertz_err,
        rate=hertz / one,
        rate_err=hertz_err / one,
        theta=theta,
        theta_err=(high - low) / 2 if share <= 1 else math.nan,
        inclinations=inclinations,
        unseen=unseen,
        aliases=np.array([other.hertz for other in films.possible if other is not films.taken]),
        marks=np.stack([marks.real, marks.imag], axis=-1),
        mark_err=math.nan if mark_err is None else mark_err,
        ruler=ruler,
        window=window,
        camera=_camera(tracks, names[0]),
    )
    told = _warning_of_uneven_turning(films.taken) or told
    if told:
        warnings.warn(told, UserWarning, stacklevel=2)
    return found


def _warning_of_uneven_turning(taken: Reading) -> str:
    """Text of a warning if the line between the ends of the tube turns unevenly; else ""."""
    if taken.scatter <= _LARGEST_WANDER:
        return ""
    return (
        f"the line deviates from uniform rotation by {taken.scatter:.2g} rad: the tube is not steady, or the"
        " two marks were exchanged"
    )


def _warning_of_aliases(films: Readings, t: Floats, degrees: float) -> str:
    """Text of a warning if the inclination is not steady at the slowest rate, or other rates are possible.

    Raises ValueError if the tube turns by almost half a turn from frame to frame, so that two rates are close
    together, and the inclination does not decide which is right.
    """
    slow, taken, others = films.slowest, films.taken, [x for x in films.possible if x is not films.slowest]
    most = abs(slow.slope) * float(np.median(np.diff(t)))
    sure = len(films.possible) == 1 and films.possible[0] is taken
    if most > 0.9 * math.pi and not sure:
        raise ValueError(
            f"tracks: the tube turns by {most / (2 * math.pi):.2g} of a turn from frame to frame, so that"
            " the sense of rotation is not clear; film with more frames per second"
        )
    rates = " or ".join(f"{other.hertz:.5g}" for other in others)
    alike = f"{rates} turns a second look the same at {films.fps:.4g} frames a second, and are steady"
    if len(others) < len(films.possible):  # the slowest is possible
        return f"also {alike}: film with more frames per second" if others else ""
    near = slow.inclinations
    told = "never steady"
    if near.size:
        steady = math.degrees(near[np.abs(np.sin(near) - math.sin(math.radians(degrees))).argmin()])
        told = f"steady at {steady:.3g} degrees, {slow.off:.2g} standard errors away"
    told = f"the tube was seen at {degrees:.4g} degrees, but at {slow.hertz:.4g} turns a second it is {told}"
    if taken is not slow:
        return f"{told}; {alike}: the faster rate is taken"
    if others:
        return f"{told}; {alike}: film with more frames per second"
    return f"{told}: is t in seconds, are radius and scale of length right, or does ruler= lack their error?"


def _ends(tracks: Mapping[str, Any], ends: Sequence[str] | None) -> tuple[str, str]:
    """The names of the two tracks of the tube's ends."""
    known = ", ".join(map(repr, tracks)) or "none"
    if ends is None:
        found = ["O", "X"] if {"O", "X"} <= tracks.keys() else list(tracks)
        if len(found) != 2:
            many = f"{counted(len(found))} ({known})" if found else "none"
            raise ValueError(f"tracks: expected two tracks, not {many}; name them, as in ends=('O', 'X')")
    else:
        try:
            found = list(ends)
        except TypeError:
            raise TypeError(f"ends: expected two names, not {type(ends).__name__}") from None
        texts = not isinstance(ends, str) and all(isinstance(name, str) for name in found)
        if not texts or len(found) != 2 or found[0] == found[1]:
            raise ValueError(f"ends = {ends!r}: expected the names of two tracks, as in ends=('O', 'X')")
        for name in found:
            if name not in tracks:
                raise ValueError(f"ends: no track is called {name!r}; expected two of {known}")
    return found[0], found[1]


def _positions(tracks: Mapping[str, Any], name: str) -> tuple[Floats, Floats]:
    """Times in seconds and positions x + iy in metres of a track."""
    told = f"tracks[{name!r}]"
    columns = columns_of(told, tracks[name])
    found: list[Floats] = []
    for wanted, units in (("t", SECONDS), ("x", METRES), ("y", METRES)):
        one = picked(told, columns, (wanted, wanted.upper(), *_ALSO.get(wanted, ())), units)
        if np.any(np.abs(one.values[np.isfinite(one.values)]) > _FARTHEST):
            raise ValueError(f"{told}: expected numbers up to {_FARTHEST:g} in the column {one.key}")
        if found and one.values.shape != found[0].shape:
            raise ValueError(f"{told}: expected columns of equal length; {one.key} has {one.values.shape}")
        found.append(one.in_si)
    return found[0], found[1] + 1j * found[2]


def _camera(tracks: Mapping[str, Any], name: str) -> Camera | None:
    """Axes and scale of a Tracker project, in pixels per metre; None if the tracks are from a table."""
    columns = tracks[name]
    if not isinstance(columns, Columns) or columns.camera is None:
        return None
    return columns.camera._replace(scale=columns.camera.scale / METRES[columns.units["x"]])


def _both_ends(first: tuple[Floats, Floats], second: tuple[Floats, Floats]) -> tuple[Floats, Any, int]:
    """Ascending times, positions x + iy of both ends, (n, 2), and number of rows in which one is missing."""
    (t, one), (s, two) = (_in_order_of_time(*track) for track in (first, second))
    # two files of one film have the same times to the written digits
    fine = 1e-6 + 1e-3 * (float(np.median(np.diff(t))) if t.size > 1 else 0.0)
    _, rows, others = np.intersect1d(np.round(t / fine), np.round(s / fine), return_indices=True)
    t, marks = t[rows], np.column_stack([one[rows], two[others]])
    seen = np.isfinite(marks).all(axis=1)
    t, marks = t[seen], marks[seen]
    unseen = max(len(one), len(two)) - t.size
    if t.size < 3:
        rest = f"; in {unseen} rows an end was not found" if unseen else ""
        many = counted(t.size)
        raise ValueError(f"tracks: expected at least three frames with both ends, not {many}{rest}")
    if (marks[:, 0] == marks[:, 1]).any():
        raise ValueError("tracks: both ends are at the same place; are these two tracks of the same mark?")
    return t, marks, unseen


def _in_order_of_time(t: Floats, place: Floats) -> tuple[Floats, Floats]:
    """A track in order of time, without rows that have no time or repeat an earlier row."""
    known = np.isfinite(t)
    t, place = t[known], place[known]
    order = np.argsort(t, kind="stable")
    t, place = t[order], place[order]
    same = np.flatnonzero(np.diff(t) == 0)
    differ = np.isfinite(place[same]) & np.isfinite(place[same + 1]) & (place[same] != place[same + 1])
    if differ.any():
        at = t[same[differ][0]]
        raise ValueError(f"tracks: two positions at t = {at:.6g}; does the table contain two films?")
    # of two rows with the same time, keep the one with a position
    lost = np.append(same[~np.isfinite(place[same])], same[np.isfinite(place[same])] + 1).astype(int)
    return np.delete(t, lost), np.delete(place, lost)


def _sine_of_inclination(shares: Floats, ruler: float) -> tuple[float, float]:
    """The sine of the inclination, as the median of line over length of the tube; and its standard error."""
    share = float(np.median(shares))
    scatter = 1.4826 * float(np.median(np.abs(shares - share)))
    error = math.hypot(1.2533 * scatter / math.sqrt(shares.size), ruler * share)
    if share > max(_LONGEST_LINE, 1 + 4 * ruler):
        units = {1 / factor: unit for unit, factor in METRES.items() if unit and factor != 1.0}
        near = min(units, key=lambda k: abs(math.log(share / k)))
        hint = "; is the scale of length right?"
        if 0.5 < share / near <= _LONGEST_LINE:
            hint = f"; are x and y in {units[near]}?"
        elif share > 100:
            hint = "; are x and y in pixels? Set the scale of length in Tracker"
        raise ValueError(f"tracks: the line between the ends is {share:.4g} times as long as the tube{hint}")
    if share < _SHORTEST_LINE:
        raise ValueError(
            f"tracks: the line between the ends is only {share:.2g} times as long as the tube; is the size of"
            " the tube in metres?"
        )
    if share > 1:
        warnings.warn(
            f"the line between the ends is {100 * (share - 1):.2g} % longer than the tube: the inclination is"
            " near 90 degrees but not known exactly; film from the side as well",
            UserWarning,
            stacklevel=3,
        )
    return share, error


def _unwrapped(t: Floats, between: Floats) -> Floats:
    """Directions of the line between the ends, in radians, unwrapped for the slowest possible rotation."""
    gaps, steps = np.diff(t), between[1:] * between[:-1].conj()
    close = gaps < 1.5 * np.median(gaps)
    # the mean of directions, not of angles, which jump where the tube makes half a turn between two frames
    step = float(np.angle(np.sum(steps[close] / np.abs(steps[close]))))
    slope = step / float(np.median(gaps[close]))
    direction = np.empty_like(t)
    direction[0] = np.angle(between[0])
    for k, gap in enumerate(gaps):
        expected = direction[k] + slope * gap
        off = np.angle(between[k + 1] * np.exp(-1j * expected))
        direction[k + 1] = expected + off
        if gap > 3 * np.median(gaps):  # refit the slope to the points before the gap
            slope = float(np.polyfit(t[: k + 1], direction[: k + 1], 1)[0]) if k > 3 else slope
    return direction
