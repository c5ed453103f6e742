"""Long-exposure photograph from above.

The brightness of a point of the picture is the share of the time during which it shows ink. The two marks, O
and X, glow, and the body only hides what lies behind it. A mark that stops whenever it is uppermost, like the
mark on the upper end while the centre is at rest, leaves an image; a mark that moves fast leaves a blur.
"""

import math

import numpy as np

from spincyl._input.numbers import Floats, made, number, si, whole
from spincyl._motion import Motion
from spincyl._scale import Scale, scale_of
from spincyl._studio.poses import seen, span
from spincyl._studio.shape import Letter, Part, kind, marks, reach, rotations

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

    return light(
        motion, marks(motion.body, upper), (first, last), None, width / metre / size, (size, size), samples
    )


def light(
    m: Motion,
    ink: list[Part],
    open_: tuple[float, float],
    middle: Floats | None,
    pixel: float,
    shape: tuple[int, int],
    samples: float,
) -> Floats:
    """The picture (rows, columns) of these marks while the shutter is open, with the light of `exposure`.

    Times and lengths are natural. Default of `middle`: the middle of the path of the centre.
    """
    first, last = open_
    area = sum(_area(part) for part in ink)
    # The motion is smooth, and a mark at rest is seen often: use more times than points, in sets of points.
    places = max(16, int(np.sqrt(samples) / 8))
    times = max(_SETS, int(samples / places))
    place, normal = _sampled(ink, places * _SETS)
    # a random time in each interval: equal steps could be in step with the precession
    steps = (np.arange(times) + np.random.default_rng(0).random(times)) / times
    centre, orientation = seen(m, first + (last - first) * steps, "centre", "orientation")
    plan = centre[:, :2]
    middle = (plan.min(axis=0) + plan.max(axis=0)) / 2 if middle is None else middle
    rows, columns = shape
    rotation = rotations(orientation)
    upper_ball = [0.0, 0.0, float(m.body.ell)] if kind(m.body) == "balls" else None
    image = np.zeros(rows * columns)
    block = _SETS * max(1, 1_000_000 // places)
    for start in range(0, times, block):
        for k in range(_SETS):
            now = slice(start + k, start + block, _SETS)
            turned, spot = rotation[now], slice(k, None, _SETS)
            shown = turned[:, 2] @ normal[spot].T
            up = shown > 0
            if upper_ball:
                # seen from above, the upper ball hides the lower one
                aside = [turned[:, i] @ (place[spot] - upper_ball).T for i in (0, 1)]
                up &= (place[spot, 2] > 0) | (np.hypot(*aside) > 1)
            x, y = (
                (turned[:, axis] @ place[spot].T + (plan[now, axis] - middle[axis])[:, np.newaxis])[up]
                for axis in (0, 1)
            )
            column = np.floor(columns / 2 + x / pixel).astype(np.intp)
            row = np.floor(rows / 2 - y / pixel).astype(np.intp)
            within = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
            spots = (row * columns + column)[within]
            image += np.bincount(spots, weights=shown[up][within], minlength=rows * columns)
    # each point has an equal share of the area of the ink, which is seen foreshortened
    image *= area / (places * times * pixel**2)
    return image.reshape(shape)


def frame(motion: Motion, seconds: float | None = None, scale: Scale | None = None) -> float:
    """Width of a square about the middle of the path of the centre that contains the whole motion.

    In R; for a measured body in metres.
    """
    (centre,) = seen(motion.natural, np.linspace(*_open(motion, seconds, scale), 500), "centre")
    path = math.hypot(*np.ptp(centre[:, :2], axis=0))
    return 2.08 * (reach(motion.body) + path / 2) * (1.0 if motion.scale is None else motion.scale.radius)


def _open(motion: Motion, seconds: float | None, scale: Scale | None) -> tuple[float, float]:
    """The times at which the shutter opens and closes, in natural units."""
    made("motion", motion, Motion)
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
    """Points and their normals, evenly over the marks, as is each of the `_SETS` interleaved sets."""
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
