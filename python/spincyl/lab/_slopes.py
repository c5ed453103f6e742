"""The precession in the frames of a film: slopes of a direction over several frames, with their weights.

```text
phi' in frame i = sum over k of weights[i, k] * direction[rows[i, k]]
```

A slope over several frames is not the value at one time: the precession of a body that nods changes within
these frames. To compare the slope with a motion, take the same sum of the phi of the motion. Neighbouring
slopes share directions, so that their errors are correlated.
"""

from typing import Any, NamedTuple, Self

import numpy as np

from spincyl._input.numbers import Floats

_WIDEST = 2.0  # times the usual duration of neighbouring frames: a wider row of frames has a gap
_SAME = 1e-6  # of the time between two frames: times closer than this are one


class Slopes(np.ndarray[Any, np.dtype[np.float64]]):
    """Column of slopes over the frames of a film; it keeps the times of the frames if sliced or rescaled."""

    frames: tuple[Floats, int] | None  #: times of all frames, ascending, and the window

    @classmethod
    def of(cls, values: Floats, t: Floats, window: int) -> Self:
        """Make the column from slopes, the times of all frames in seconds, and the window in frames."""
        found = np.asarray(values).view(cls)
        found.frames = (t, window)
        return found

    def __array_finalize__(self, obj: Any) -> None:
        self.frames = getattr(obj, "frames", None)

    def __reduce__(self) -> Any:
        return _again, (np.asarray(self), self.frames)


def _again(values: Floats, frames: tuple[Floats, int] | None) -> Slopes:
    """Make a column of slopes again when pickle reads it from a file."""
    found = values.view(Slopes)
    found.frames = frames
    return found


class Sloped(NamedTuple):
    """The slopes at measured times, as sums over the frames of a film."""

    t: Floats  #: times of the frames
    rows: Any  #: (n, window): the frames of each slope
    weights: Floats  #: (n, window)

    def of(self, values: Floats) -> Floats:
        """Slopes of other values, which are given at all frames, over the same frames."""
        return slope(values, self.rows, self.weights)

    def correlation(self, kept: Any) -> Floats:
        """Correlation matrix of the errors of the slopes `kept` (a mask), for equally exact directions."""
        whole = np.zeros((len(self.rows), self.t.size))
        np.put_along_axis(whole, self.rows, self.weights, axis=1)
        whole = whole[kept]
        whole /= np.linalg.norm(whole, axis=1, keepdims=True)
        found: Floats = whole @ whole.T
        return found


def slopes_at(column: Any, t: Floats, second: float) -> Sloped | None:
    """The slopes of a column at ascending times, in units of `second`; None if the column is no `Slopes`.

    Raises ValueError if the times are not those of the frames.
    """
    if not isinstance(column, Slopes) or column.frames is None:
        return None
    frames, window = column.frames
    natural = frames / second
    apart = float(np.median(np.diff(natural)))
    near = np.searchsorted((natural[1:] + natural[:-1]) / 2, t)
    if np.abs(natural[near] - t).max() > _SAME * apart:
        # another zero or unit of the times of all frames
        span, whole = float(np.ptp(t)), float(np.ptp(natural))
        same = t.size == natural.size and span > 0
        if not same or np.abs((t - t[0]) / span - (natural - natural[0]) / whole).max() > _SAME / t.size:
            raise ValueError(
                "measured: 'precession' is a slope over several frames of a film, and 't' has other times"
                " than these frames; take both from film.frames, and set the clock by t0"
            )
        natural, near = t, np.arange(t.size)
    rows, weights = slopes(natural, window)
    return Sloped(natural, rows[near], weights[near])


def slopes(t: Floats, window: int) -> tuple[Any, Floats]:
    """Indices of the `window` frames near each frame, and their weights in its slope; NaN at a gap."""
    many = min(window, t.size)
    at = np.arange(t.size)[:, np.newaxis]
    rows = np.clip(at - many // 2, 0, t.size - many) + np.arange(many)
    usual = float(np.median(np.diff(t)))
    powers = ((t[rows] - t[:, np.newaxis]) / usual)[..., np.newaxis] ** np.arange(3)
    weights = np.linalg.pinv(powers)[:, 1] / usual
    weights[has_gap(t, rows)] = np.nan
    return rows, weights


def slope(values: Floats, rows: Any, weights: Floats) -> Floats:
    """Slopes of values at all frames, by the rows and weights of `slopes`."""
    near = values[rows]
    found: Floats = np.sum(weights * (near - near[:, :1]), axis=1)  # differences, since turns add up
    return found


def has_gap(t: Floats, rows: Any) -> Any:
    """Whether the frames of each row span much more time than usual, since frames are missing."""
    usual = (rows.shape[1] - 1) * float(np.median(np.diff(t)))
    return np.ptp(t[rows], axis=1) > _WIDEST * usual
