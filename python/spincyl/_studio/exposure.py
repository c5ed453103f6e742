"""The photograph from above with the shutter open for a while.

Its brightness is the share of the time during which each place of the picture shows ink. The two marks, O
and X, glow, and the body only hides what lies behind it. A mark that stops whenever it is uppermost, as the
one on the upper end does while the centre rests, leaves an image; one that moves fast leaves a blur.
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
    """The long-exposure photograph of a motion from above.

    Parameters
    ----------
    motion : Motion
        What it lacks of the pose is computed, at times of its own.
    seconds : float, optional
        How long the shutter is open from the motion's first time on, in seconds of `scale`. Default: for
        all of the motion.
    scale : Scale, optional
        Needed by `seconds`; the motion of a measured body has one.
    upper : {"O", "X"}
        The letter on the upper end, which is the one that was pressed when the tube was flicked.
    size : int
        Pixels along each side.
    samples : float
        Number of pairs of a time and a place of the ink. The noise falls as its root.
    width : float, optional
        What the picture shows, in R, of a measured body in metres, about the middle of the centre's path.
        Default: all that the body reaches.

    Returns
    -------
    ndarray, shape (size, size)
        The first row is the far side (largest y), columns run along x. Each pixel: the share of the time
        during which it shows ink, 0 to 1 up to noise (more of it where the
        body rests). Light is added up, not developed:
        `plot.exposure` shows it.

    Raises
    ------
    ValueError
        For `seconds` without a scale or beyond the end of the motion, sizes that make no picture.
    TypeError
        For anything but a motion and numbers.

    Notes
    -----
    The ink of both marks is sampled evenly in place and time. A place shows if its normal points up: that
    is exact for the outside of a convex body. Of two balls, what the upper one hides of the lower does not
    show. The camera is far above.

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
    """The picture (rows, columns) of these marks while the shutter is open; `exposure` tells of its light.

    Times and lengths are natural. The middle of the picture is that of the centre's path by default.
    """
    first, last = open_
    area = sum(_area(part) for part in ink)
    # Motion is smooth and a mark at rest counts often: so more times than places, in several sets of places.
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
    # each place stands for an equal share of the area of the ink, seen foreshortened
    image *= area / (places * times * pixel**2)
    return image.reshape(shape)


def frame(motion: Motion, seconds: float | None = None, scale: Scale | None = None) -> float:
    """Width of a square about the middle of the centre's path that holds the whole motion of the body.

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
            " the shutter is open for all of the motion"
        )
    seconds = number("seconds", si("seconds", seconds, "second"))
    open_, longest = seconds / float(scale.seconds(1.0)), abs(last - first)
    if not 0 < open_ <= longest * (1 + 1e-9):
        most = float(scale.seconds(longest))
        raise ValueError(f"seconds = {seconds!r}: expected more than 0 and at most {most:.6g}, the motion's")
    return first, first + math.copysign(min(open_, longest), last - first)


def _area(part: Part) -> float:
    corners = part.vertices[part.triangles]
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return float(np.linalg.norm(sides, axis=1).sum() / 2)


def _sampled(ink: list[Part], count: int) -> tuple[Floats, Floats]:
    """Places spread evenly over the marks, and so is each of `_SETS` interleaved sets; their normals."""
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
