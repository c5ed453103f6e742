"""Long-exposure photograph from above.

The brightness of a point of the picture is the share of the time during which it shows ink. The two marks, O
and X, glow, and the body only hides what lies behind it. A mark that stops whenever it is uppermost, like the
mark on the upper end while the centre is at rest, leaves an image; a mark that moves fast leaves a blur.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from spincyl._input.numbers import Floats, instance_of, number, si, whole
from spincyl._motion import Motion
from spincyl._scale import Scale, scale_of
from spincyl.studio.poses import seen, span
from spincyl.studio.shape import Letter, Part, kind, marks, reach, rotations

_SETS = 128


def exposure(
    motion: Motion,
    seconds: float | None = None,
    *,
    scale: Scale | None = None,
    upper: Letter = "O",
    size: int = 400,
    samples: float = 4e6,
    width: float | None = None,
) -> Floats:
    """Compute the long-exposure photograph of a motion from above.

    Parameters
    ----------
    motion : Motion
        Motion of a single body. Its poses are computed at as many times as the photograph needs.
    seconds : float, optional
        Duration of the exposure from the first time of the motion on, in seconds. Default: the whole motion.
    scale : Scale, optional
        Size of the body, for `seconds`; a measured body has its own scale.
    upper : {"O", "X"}
        Symbol on the upper end. If the tube was flicked, this is the end that the finger pressed.
    size : int
        Number of pixels along each side, at most 20,000.
    samples : float
        Number of samples, 1e3 to 1e9. Each sample is an instant and a point of the ink. The noise is
        inversely proportional to the square root of their number.
    width : float, optional
        Width of the picture in R, for a measured body in metres. The middle of the picture is the middle of
        the path of the centre. Default: wide enough for the whole motion.

    Returns
    -------
    ndarray, shape (size, size)
        Share of the time, 0 to 1, during which each pixel shows ink, with noise. The noise is largest where
        the body rests. The first row has the largest y; x increases along a row. `plot.exposure` draws the
        picture.

    Raises
    ------
    ValueError
        If `seconds` is given for a body without a scale, or is longer than the motion. If a number is out of
        range. The message names the argument.
    TypeError
        If an argument has the wrong type; the message names it.

    Notes
    -----
    The camera is far above the table. The ink of both symbols is sampled evenly in space and time. A point is
    visible if its normal points up, which is exact for the outside of a convex body. If the body is two
    balls, the upper ball also hides parts of the lower ball.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> tube = sc.Body.tube(6, bore=0.8)
    >>> state = tube.steady(np.radians(89.5))
    >>> turn = 2 * np.pi / state.precession
    >>> sc.exposure(sc.roll(tube, state, turn)).shape
    (400, 400)
    """
    first, last = _open(motion, seconds, scale)
    size = whole("size", size, 1, 20_000)
    samples = number("samples", samples)
    if not 1e3 <= samples <= 1e9:
        raise ValueError(f"samples = {samples!r}: expected 1e3 to 1e9")
    width = None if width is None else number("width", width)
    metre = 1.0 if motion.scale is None else motion.scale.radius
    if width is not None and not 1e-6 <= width / metre <= 1e9:
        least, most, unit = 1e-6 * metre, 1e9 * metre, "R" if motion.scale is None else "metres"
        raise ValueError(f"width = {width!r}: expected {least:g} to {most:g}, in {unit}")
    width = frame(motion, seconds, scale) if width is None else width
    motion = motion.natural

    ink = [marks(motion.body, upper)]
    shutter = Shutter(motion, ink, width / metre / size, (size, size), samples)
    found: Floats = shutter.light(min(first, last), max(first, last))[0] / abs(last - first)
    return found


class Shutter:
    """A camera from above with an open shutter; times and lengths are in natural units.

    Each picture starts from the previous one: only light of times at which the shutter is open for one of
    these two pictures, but not for both, is computed. There is a picture for each list of `ink`. Default of
    `middle`: the middle of the path of the centre.
    """

    def __init__(
        self,
        m: Motion,
        ink: list[list[Part]],
        pixel: float,
        shape: tuple[int, int],
        samples: float,
        middle: Floats | None = None,
    ) -> None:
        self._motion, self._pixel, self._shape = m, pixel, shape
        self._middle: Any = middle
        # The motion is smooth, and a mark at rest is seen often: use more times than points, in sets.
        self._places = max(16, int(np.sqrt(samples) / 8))
        self._times = max(_SETS, int(samples / self._places))
        self._marks = [self._points(parts) for parts in ink]
        upper_ball = [[0.0], [0.0], [float(m.body.ell)]] if kind(m.body) == "balls" else None
        self._upper_ball = None if upper_ball is None else np.array(upper_ball)
        self._random, self._count = np.random.default_rng(0), 0
        self._light = np.zeros((len(ink), shape[0] * shape[1]))
        none = np.zeros(0)
        self._lit = _Instants(none, none, none.astype(int), np.zeros((0, 3)), np.zeros((0, 3, 3)))
        self._open = np.inf, -np.inf

    def _points(self, ink: list[Part]) -> tuple[Floats, Floats, float]:
        """Sets of points of ink and their normals, (sets, 3, points), and the area of each point."""
        drawn = _sampled(ink, self._places * _SETS)
        place, normal = (x.reshape(-1, _SETS, 3).transpose(1, 2, 0).copy() for x in drawn)
        return place, normal, sum(map(_area, ink)) / self._places

    def light(self, first: float, last: float) -> Floats:
        """The time for which each pixel shows ink while the shutter is open, (pictures, rows, columns)."""
        kept = max(self._open[0], first), min(self._open[1], last)
        overlap = (kept[1] - kept[0]) / (last - first)
        gone = (self._lit.t < first) | (self._lit.t > last)
        if np.count_nonzero(gone) >= overlap * self._times:  # as quick from the beginning
            self._light[:], gone[:] = 0.0, True
            new = [(first, last)]
        else:
            self._shine(self._lit.at(gone), -1.0)
            new = [(first, kept[0]), (kept[1], last)]
        lit = [self._lit.at(~gone)]
        for begin, end in new:
            if end > begin:
                lit.append(self._instants(begin, end, (end - begin) / (last - first)))
                self._shine(lit[-1], 1.0)
        self._lit = _Instants(*(np.concatenate(x) for x in zip(*lit, strict=True)))
        self._open = first, last
        return self._light.reshape(-1, *self._shape)

    def _instants(self, first: float, last: float, share: float) -> "_Instants":
        """Sample instants between two times, which are the `share` of the time that the shutter is open."""
        many = math.ceil(self._times * share)
        # a random time in each interval: equal steps could be in step with the precession
        t = first + (last - first) * (np.arange(many) + self._random.random(many)) / many
        which = (self._count + np.arange(many)) % _SETS
        self._count += many
        centre, orientation = seen(self._motion, t, "centre", "orientation")
        if self._middle is None:
            self._middle = (centre[:, :2].min(axis=0) + centre[:, :2].max(axis=0)) / 2
        return _Instants(t, np.full(many, (last - first) / many), which, centre, rotations(orientation))

    def _shine(self, lit: "_Instants", sign: float) -> None:
        """Add the light of these instants to the pictures (`sign` 1), or remove it (`sign` -1)."""
        block = max(1, 1_000_000 // self._places)
        for start in range(0, lit.t.size, block):
            now = lit.at(slice(start, start + block))
            for image, (place, normal, area) in zip(self._light, self._marks, strict=True):
                self._add(image, now, place[now.which], normal[now.which], sign * area)

    def _add(self, image: Floats, now: "_Instants", place: Floats, normal: Floats, area: float) -> None:
        rows, columns = self._shape
        shown = (now.rotation[:, 2:] @ normal)[:, 0]
        up = shown > 0
        if self._upper_ball is not None:
            # seen from above, the upper ball hides the lower one
            aside = now.rotation[:, :2] @ (place - self._upper_ball)
            up &= (place[:, 2] > 0) | (np.hypot(aside[:, 0], aside[:, 1]) > 1)
        across = now.rotation[:, :2] @ place + (now.centre[:, :2] - self._middle)[..., np.newaxis]
        x, y = across[:, 0][up], across[:, 1][up]
        column = np.floor(columns / 2 + x / self._pixel).astype(np.intp)
        row = np.floor(rows / 2 - y / self._pixel).astype(np.intp)
        within = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
        # each point has an equal share of the area of the ink, which is seen foreshortened
        value = (shown * (area * now.lasts / self._pixel**2)[:, np.newaxis])[up]
        np.add.at(image, (row * columns + column)[within], value[within])


class _Instants(NamedTuple):
    """Instants at which the pose of the body is sampled, and the poses."""

    t: Floats
    lasts: Floats  #: the time that each stands for
    which: Any  #: number of the set of points that it shows
    centre: Floats  #: (n, 3)
    rotation: Floats  #: (n, 3, 3)

    def at(self, rows: Any) -> "_Instants":
        """The instants with these indices."""
        return _Instants(*(x[rows] for x in self))


def frame(motion: Motion, seconds: float | None = None, scale: Scale | None = None) -> float:
    """Width of a square about the middle of the path of the centre that contains the motion up to `seconds`.

    In R; for a measured body in metres.
    """
    (centre,) = seen(motion.natural, np.linspace(*_open(motion, seconds, scale), 500), "centre")
    path = math.hypot(*np.ptp(centre[:, :2], axis=0))
    return 2.08 * (reach(motion.body) + path / 2) * (1.0 if motion.scale is None else motion.scale.radius)


def _open(motion: Motion, seconds: float | None, scale: Scale | None) -> tuple[float, float]:
    """The times at which the shutter opens and closes, in natural units."""
    instance_of("motion", motion, Motion)
    first, last = span(motion.natural)
    scale = scale_of(scale, motion.body)
    if seconds is None:
        return first, last
    if scale is None:
        raise ValueError(
            f"seconds = {seconds!r}: needs scale=, as in scale=Scale(radius=0.008); without both,"
            " the exposure lasts for the whole motion"
        )
    seconds = number("seconds", si("seconds", seconds, "second"))
    open_, longest = seconds / float(scale.seconds(1.0)), abs(last - first)
    if not 0 < open_ <= longest * (1 + 1e-9):
        most = float(scale.seconds(longest))
        raise ValueError(
            f"seconds = {seconds!r}: expected more than 0 and at most {most:.6g}, the duration of the motion"
        )
    return first, first + math.copysign(min(open_, longest), last - first)


def _area(part: Part) -> float:
    corners = part.vertices[part.triangles]
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return float(np.linalg.norm(sides, axis=1).sum() / 2)


def _sampled(ink: list[Part], count: int) -> tuple[Floats, Floats]:
    """Points spread evenly over the marks, and their normals; so is each of the `_SETS` interleaved sets."""
    corners = np.concatenate([part.vertices[part.triangles] for part in ink])
    normals = np.concatenate([part.normals[part.triangles] for part in ink])
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    along = np.cumsum(np.linalg.norm(sides, axis=1))
    which = np.searchsorted(along, (np.arange(count) + 0.5) / count * along[-1])
    # an additive recurrence with powers of the plastic number fills a square evenly
    u, v = ((0.5 + np.arange(count) * 1.324717957244746**-k) % 1 for k in (1, 2))
    beyond = u + v > 1
    u, v = np.where(beyond, 1 - u, u), np.where(beyond, 1 - v, v)
    share = np.stack([1 - u - v, u, v], -1)[..., np.newaxis]
    return (corners[which] * share).sum(1), (normals[which] * share).sum(1)
