"""A film of a tube from above, as a whole and frame by frame.

```text
sin theta = line / length of the tube,    phi' = slope of the direction,    centre = middle of the two marks
```

The marks have no redundancy, since two marks have four coordinates, and a tube in a plane view as well. The
error of a frame therefore follows from the scatter about a smooth curve: the third divided difference of
four neighbouring frames, with weights of unit norm, has the standard error of a single value.
"""

import math
from collections.abc import Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import Floats
from spincyl._motion import Motion
from spincyl._scale import Scale
from spincyl._upward import function_of_method
from spincyl.lab._columns import Camera, Columns
from spincyl.lab._report import section, variables, with_error
from spincyl.lab._slopes import Slopes, has_gap, slope, slopes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ROWS = 4  # frames of a third difference
_WILD = 4.0  # standard errors from which on a difference is left out, since a mark is wrong


class Scatter(NamedTuple):
    """Standard errors of the measured values in a single frame of a film, in metres."""

    along: float  #: of the length of the line
    across: float  #: of its direction times its length
    centre: float  #: of x and of y of the centre


@compared_by_value
class Filmed(NamedTuple):
    """A tube, measured in a film from above, as a whole and frame by frame; returned by `from_above`.

    Methods: ``report()``, ``plot()`` and ``over(motion)``.

    Attributes
    ----------
    body : Body
        The tube.
    scale : Scale
        Size of the tube.
    t : ndarray, (n,)
        Times of the frames in which both ends were tracked, in seconds, ascending.
    direction : ndarray, (n,)
        Direction of the line from the second end of the tube to the first, as seen from above, in radians,
        unwrapped.
    line : ndarray, (n,)
        Length of the line between both ends in each frame, in metres.
    hertz : float
        Turns per second, positive for both senses of rotation.
    hertz_err : float
        Standard error of `hertz`.
    rate : float
        Reduced rate.
    rate_err : float
        Standard error of `rate`.
    theta : float
        Measured inclination, in radians; NaN if the line is longer than the tube.
    theta_err : float
        Standard error of `theta`.
    inclinations : ndarray, (k,)
        Steady inclinations of the body at the measured rate, ascending.
    unseen : int
        Number of frames in which one of the ends was not tracked.
    aliases : ndarray, (m,)
        Turns per second of other rates that look the same from frame to frame, and for which the measured
        inclination is steady as well; empty if the film is unambiguous.
    marks : ndarray, (n, 2, 2)
        Positions of the first and of the second end in each frame: x and y, in metres.
    mark_err : float
        Standard error of each coordinate of a mark, as given, in metres; NaN if it is estimated.
    ruler : float
        Relative standard error of the film's scale of length, as given.
    window : int
        Number of frames whose directions give the precession in a frame, as given.
    camera : Camera or None
        Axes and scale of the Tracker project, in pixels and metres; None for other tracks.
    predicted : float
        The one of `inclinations` that is nearest to `theta`; NaN if there is none.
    frames : Columns
        Measured values in each frame: t in seconds; theta in radians, NaN if the line is longer than the
        tube; precession in rad/s, positive if the tube turns counterclockwise in the film, NaN beside a gap;
        x and y of the centre of the tube, in metres. The column of the precession contains slopes over
        `window` frames, and `fit_motion` compares them with the same slopes of a motion; np.asarray of the
        column is a plain array, which `fit_motion` compares with the precession at each time.
    errors : dict of ndarray, (n,)
        Standard errors of the columns of `frames`: theta, precession, x and y. Together with `frames` they
        can be passed to `fit_motion`.

    Notes
    -----
    The error of a frame is estimated from the marks of its film. Of four neighbouring frames at the times
    t_i, the third divided difference, with weights w_i = 1/prod(t_i - t_j) divided by their norm, vanishes
    for a parabola and has the standard error of a single value. The root of the mean square of these
    differences, without those beyond four standard errors, is the error s of the length of the line, of its
    direction times the length, and of x and y. Motion that a parabola through four frames does not follow
    counts as scatter: give `mark_err` if the tube nods or circles within a few frames. The errors are then
    sqrt(2) mark_err for the first two, and mark_err/sqrt(2) for x and y.

    The error of theta is half of the change of arcsin(line/length) from line minus error to line plus error.
    The precession is the slope of the parabola that fits the directions in `window` frames best, at the frame
    itself; it is a sum of the directions with weights, and its error is the root of the sum of the squares of
    weight times error. The values in neighbouring frames share directions, and are correlated. `ruler` is
    added to the errors of theta, x and y, although it is the same error in all frames.
    """

    body: Body
    scale: Scale
    t: Floats
    direction: Floats
    line: Floats
    hertz: float
    hertz_err: float
    rate: float
    rate_err: float
    theta: float
    theta_err: float
    inclinations: Floats
    unseen: int
    aliases: Floats
    marks: Floats = np.empty((0, 2, 2))
    mark_err: float = math.nan
    ruler: float = 0.0
    window: int = 5
    camera: Camera | None = None

    @property
    def frames(self) -> Columns:
        """Time, inclination, precession and centre in each frame, with their units."""
        share, _ = self._share
        with np.errstate(invalid="ignore"):
            theta = np.arcsin(share)
        x, y = self.marks.mean(axis=1).T
        rows, weights = slopes(self.t, self.window)
        precession = Slopes.of(slope(self.direction, rows, weights), self.t, self.window)
        columns = {"t (s)": self.t, "theta (rad)": theta, "precession (rad/s)": precession}
        return Columns((columns | {"x (m)": x, "y (m)": y}).items())

    @property
    def errors(self) -> dict[str, Floats]:
        """Standard errors of the inclination, the precession and the centre in each frame."""
        share, share_err = self._share
        low, high = (np.arcsin(np.clip(share + k * share_err, 0.0, 1.0)) for k in (-1, 1))
        scatter = self._scatter
        rows, weights = slopes(self.t, self.window)
        turned = (scatter.across / self.line)[rows]
        places = self.marks.mean(axis=1)
        places = np.hypot(scatter.centre, self.ruler * (places - places.mean(axis=0)))
        found = {"theta": (high - low) / 2, "precession": np.sqrt(np.sum((weights * turned) ** 2, axis=1))}
        return found | {"x": places[:, 0], "y": places[:, 1]}

    @property
    def _share(self) -> tuple[Floats, Floats]:
        """Length of the line over that of the tube, and its standard error, in each frame."""
        tall = float(self.scale.metres(2.0 * (self.body.ell + self.body.fillet)))
        return self.line / tall, np.hypot(self._scatter.along, self.ruler * self.line) / tall

    @property
    def _scatter(self) -> Scatter:
        """Standard errors in a single frame, from the given error of the marks or from their scatter."""
        if math.isfinite(self.mark_err):
            both = math.sqrt(2.0) * self.mark_err
            return Scatter(both, both, both / 2)
        rows, weights = differences(self.t)
        along, turned = (np.sum(weights * of[rows], axis=1) for of in (self.line, self.direction))
        across = turned * self.line[rows].mean(axis=1)
        centre = np.sum(weights[..., np.newaxis] * self.marks.mean(axis=1)[rows], axis=1)
        return Scatter(*map(error_of_scatter, (along, across, centre.ravel())))

    @property
    def predicted(self) -> float:
        """Steady inclination at the measured rate, nearest to the measured inclination, or NaN."""
        if not self.inclinations.size:
            return math.nan
        near = math.pi / 2 if math.isnan(self.theta) else self.theta
        return float(self.inclinations[np.abs(self.inclinations - near).argmin()])

    def report(self) -> str:
        """Return the measured values with their errors, and the steady inclination, in lmfit's style."""
        turns = float(np.ptp(self.direction)) / (2 * math.pi)
        rows = [
            ("body", repr(self.body)),
            ("frames", f"{self.t.size}, and {self.unseen} more in which an end was not found"),
            ("film", f"{turns:.3g} turns in {float(np.ptp(self.t)):.4g} s"),
        ]
        degrees = [math.degrees(x) for x in (self.theta, self.theta_err, self.predicted)]
        told = "(this rate has no steady state)" if math.isnan(degrees[2]) else f"(steady: {degrees[2]:.2f})"
        found = variables(
            [
                ("turns per second", self.hertz, self.hertz_err, ""),
                ("reduced rate", self.rate, self.rate_err, ""),
                ("inclination, degrees", degrees[0], degrees[1], told),
            ]
        )
        return "\n".join(section("Film from above", rows) + found)

    def __repr__(self) -> str:
        theta, theta_err, predicted = map(math.degrees, (self.theta, self.theta_err, self.predicted))
        return (
            f"<Filmed: {with_error(self.hertz, self.hertz_err)} turns a second,"
            f" {with_error(theta, theta_err)} degrees, steady at {predicted:.3g}; {self.t.size} frames>"
        )

    def plot(self, axes: "Sequence[Axes] | None" = None) -> "list[Axes]":
        """Draw inclination, precession and centre against time, with error bars, on three axes."""
        drawn: list[Axes] = function_of_method("Filmed.plot")(self, axes)
        return drawn

    def over(
        self,
        motion: Motion,
        frames: "np.ndarray[Any, Any] | str | PathLike[str] | None" = None,
        *,
        t: float | None = None,
        first: int = 0,
        fps: float | None = None,
        camera: Sequence[float] | None = None,
        ax: "Axes | None" = None,
    ) -> "Axes":
        """Draw the computed tube of a motion on a frame of the film, beside the marks of both ends.

        The circles are the marks of one turn, filled in this frame. The lines are the outline of the computed
        tube in this frame, and the computed paths of its ends during this turn; the crosses are its ends.

        Parameters
        ----------
        motion : Motion
            Motion as for `compare`, which turns and moves it into the film.
        frames : array, path or None
            Picture of the frame, an array of the shape (height, width) or (height, width, 3 or 4); or the
            path of a picture or of a film. Default: an empty frame.
        t : float, optional
            Time in seconds; the nearest frame with both marks is drawn. Default: the first.
        first : int
            Number of the frame in the file that has the time 0, counted from 0; in Tracker the start frame.
        fps : float, optional
            Frames of the file per second of `t`, also if the file is played in slow motion. Default: from the
            times of the marks, if each frame was tracked.
        camera : sequence of four numbers, optional
            Pixel x and y of the origin, from the upper left corner, pixels per metre, and angle of the x axis
            in degrees, counterclockwise. Default: those of a Tracker project.
        ax : matplotlib Axes, optional
            Axes to draw on, in pixels. Default: new axes.

        Returns
        -------
        Axes
            The axes.

        Raises
        ------
        ValueError
            If the camera is not known, or the file has no such frame. If `compare` raises an error.
        TypeError
            If an argument is of the wrong type; the message names it.
        ImportError
            If matplotlib, or for a film ffmpeg, is missing: install spincyl[film].
        OSError
            If a file cannot be read.
        """
        drawn: Axes = function_of_method("Filmed.over")(
            self, motion, frames, t=t, first=first, fps=fps, camera=camera, ax=ax
        )
        return drawn


def differences(t: Floats) -> tuple[Any, Floats]:
    """Indices of four neighbouring frames without a gap, (m, 4), and weights of their third difference."""
    if t.size < _ROWS:
        return np.empty((0, _ROWS), int), np.empty((0, _ROWS))
    rows = np.arange(t.size - _ROWS + 1)[:, np.newaxis] + np.arange(_ROWS)
    rows = rows[~has_gap(t, rows)]
    apart = t[rows][:, :, np.newaxis] - t[rows][:, np.newaxis]
    weights = 1 / np.prod(apart / np.median(np.diff(t)) + np.eye(_ROWS), axis=2)
    return rows, weights / np.linalg.norm(weights, axis=1, keepdims=True)


def error_of_scatter(off: Floats) -> float:
    """Standard error of values from their third differences, without outliers; NaN if there are none."""
    if not off.size:
        return math.nan
    middle = 1.4826 * float(np.median(np.abs(off)))
    near = off[np.abs(off) <= _WILD * middle] if middle > 0 else off
    return math.sqrt(float(np.mean(near**2)))
