"""Lines, vectors and camera of a view, the same for its page, its films and its stills."""

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from spincyl._input.numbers import Floats, flag, known_words, number

AZIMUTH, _ELEVATION = -1.1, 0.55  # direction of the page's first view
_SPREAD = math.tan(0.3)  # tangent of half the angle of view
_LEAST = 0.03  # angle between a table and the least steep view of it
_FLAT = 1e6  # distance of a camera above the table, over half the height that it shows
#: Factors of slow motion of a page and of a film.
SLOW = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
#: Lines and vectors that can be drawn with the body.
DRAWN = ("path", "omega", "momentum", "velocity", "force", "axis")


class Look(NamedTuple):
    """The settings of a view: additions to the picture, camera and exposure."""

    drawn: tuple[str, ...] | None  #: names in `DRAWN`; None: the path, and on a page with friction the forces
    above: bool  #: whether the camera looks straight down
    follow: bool | None  #: whether the camera follows the body; None: if it moves far
    exposure: float | None  #: turns about the vertical for which the shutter is open


def look(drawn: str | Iterable[str] | None, above: bool, follow: bool | None, exposure: float | None) -> Look:
    """The settings of a view's picture from the arguments of `view`; errors name the argument."""
    drawn = None if drawn is None else known_words("drawn", drawn, DRAWN)
    follow = None if follow is None else flag("follow", follow)
    if exposure is not None:
        exposure = number("exposure", exposure)
        if not exposure >= 0.01:
            raise ValueError(f"exposure = {exposure!r}: expected at least 0.01 turns, or inf for no limit")
    return Look(drawn, flag("above", above), follow, exposure)


class Camera(NamedTuple):
    """A camera: the middle of its view, its distance, and its three directions."""

    at: Floats
    far: float
    high: float
    rows: Floats  #: right, up, back

    @property
    def eye(self) -> Floats:
        """Position of the camera."""
        found: Floats = self.at + self.far * self.rows[2]
        return found

    def __call__(self, places: Floats) -> Floats:
        """Positions of points (..., 3) in the picture, whose half height is 1."""
        x, y, back = np.moveaxis((places - self.at) @ self.rows.T, -1, 0)
        found: Floats = self.far / self.high * np.stack([x, y], -1) / (self.far - back)[..., np.newaxis]
        return found


class Tilt(NamedTuple):
    """The slope of a table in radians, the steepest of its view, and the side of the cameras."""

    slope: float = 0.0
    steepest: float = 0.0
    mirrored: bool = False  #: whether x of the first table points uphill


_LEVEL = Tilt()


def tilts(slopes: list[float]) -> list[Tilt]:
    """The tilts of the tables of a view with these slopes: all cameras are equally far, on one side."""
    return [Tilt(slope, max(map(abs, slopes)), slopes[0] < 0) for slope in slopes]


def camera(at: Floats, reach: float, half: float, aspect: float, above: bool, tilt: Tilt = _LEVEL) -> Camera:
    """The first camera of the page, or one that looks straight down, with x to the right and y upwards.

    The first camera of the page sees a table with a slope as it lies: its directions are turned about y, from
    the room to the table. The camera that looks down (`above`) looks along the normal of the table.
    """
    azimuth, elevation = (-math.pi / 2, math.pi / 2) if above else (AZIMUTH, _ELEVATION)
    slope = tilt.slope
    if not above and tilt.steepest:
        azimuth = -math.pi - azimuth if tilt.mirrored else azimuth
        # above the table
        elevation = max(elevation, _LEAST + math.atan2(-math.cos(azimuth) * math.sin(slope), math.cos(slope)))
        half += _rise(reach, tilt.steepest)
    ce, se = math.cos(elevation), math.sin(elevation)
    ca, sa = math.cos(azimuth), math.sin(azimuth)
    back, right = np.array([ce * ca, ce * sa, se]), np.array([-sa, ca, 0.0])
    high = max(1.08 * reach if above else half, 1.12 * reach / aspect)
    far = _FLAT * high if above else high / _SPREAD
    rows = np.stack([right, np.cross(back, right), back])
    return Camera(at, far, high, rows if above or not slope else rows @ _to_room(slope))


def _to_room(slope: float) -> Floats:
    """The rotation from the axes of a table with this slope to those of the room, with z up."""
    c, s = math.cos(slope), math.sin(slope)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def _rise(reach: float, slope: float) -> float:
    """Increase, on a slope, of the half height that the camera has to show."""
    seen_at = min(_ELEVATION + abs(slope), math.pi / 2)
    return 1.06 * reach * (math.sin(seen_at) - math.sin(_ELEVATION))


def held(reach: float, top: float) -> float:
    """Half of the height that has to fit into the camera's view."""
    return 1.06 * max((0.52 + 0.26) * reach + 0.38 * top, 0.44 * reach + 0.57 * top)


def opened(t: float, turns: float, along: Floats, turned: Floats, *, before: bool) -> tuple[float, float]:
    """Beginning and end of an exposure that lasts for a number of turns after `t`, or before `t`.

    `turned` is the number of turns about the vertical at the times `along`. The exposure stays within
    the motion.
    """
    if before:
        first, last = opened(-t, turns, -along[::-1], -turned[::-1], before=False)
        return -last, -first
    over = np.abs(turned - np.interp(t, along, turned)) - turns
    there = np.flatnonzero((along > t) & (over >= 0))
    if not there.size:
        return t, float(along[-1])
    k = int(there[0])
    began, was = (along[k - 1], over[k - 1]) if k and along[k - 1] > t else (t, -turns)
    return t, float(began + (along[k] - began) * was / (was - over[k]))
