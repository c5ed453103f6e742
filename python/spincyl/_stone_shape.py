"""What a stone looks like: the ball of radius 1, turned in pieces on a lathe and stretched to an ellipsoid.

The origin is the centre of mass. A stone with an edge is cut by the plane at whose height the edge lands,

    z = -a3^2 cos(theta_end)/hypot(a sin(theta_end), a3 cos(theta_end)),

above the centre, with that of the semi-axes a1 and a2 for which it is highest; so whatever touches the table is
drawn. On the plane lies a needle along the longer axis. A whole stone has a band round its longer side and a dot
beside it, so that any turn of it is seen.
"""

import math

import numpy as np

from spincyl._ellipsoid import Ellipsoid
from spincyl._surface import BLUE, IVORY, ORANGE, SHADE, Part, Profile, Stretch, arc, lathe

_QUARTER = 32  # pieces of a quarter of a circle
_LIFT = 0.004  # of the marks above the surface, of the ball of radius 1
_BAND, _DOT = 0.07, 0.2  # half the width of the band, and the radius of the dot, in radians of that ball
_LONG, _WIDE = 0.88, 0.34  # half of the needle, as shares of the plane's semi-axes


def height(stone: Ellipsoid) -> float:
    """At which height the ball of radius 1 is cut, from -1 to 1: 1 if the stone is whole."""
    end = float(stone.theta_end)
    if not end < math.pi:
        return 1.0
    a1, a2, a3 = np.asarray(stone.axes).tolist()
    sin, cos = math.sin(end), math.cos(end)
    across = max(a1, a2) if cos > 0 else min(a1, a2)
    return -a3 * cos / math.hypot(across * sin, a3 * cos)


def profiles(stone: Ellipsoid) -> list[Profile]:
    """The surface of a stone but for its marks."""
    cut, whole = height(stone), _stretch(stone)
    if cut == 1:
        halves = [arc((0.0, 0.0), 1.0, low, low + np.pi / 2, _QUARTER) for low in (-np.pi / 2, 0.0)]
        names = (("lower half", SHADE), ("upper half", IVORY))
        return [Profile(*name, *half, whole) for name, half in zip(names, halves, strict=True)]
    hull = arc((0.0, 0.0), 1.0, -np.pi / 2, math.asin(cut), 2 * _QUARTER)
    edge = hull[0][-1]
    return [
        Profile("hull", SHADE, *hull, whole),
        Profile("top", IVORY, [edge, (0.0, edge[1])], None, whole),
    ]


def turned_marks(stone: Ellipsoid, upper: str) -> list[Profile]:
    """Marks that a lathe turns: band and dot of a whole stone."""
    if height(stone) < 1:
        return []
    first, second = _inks(upper)
    beside = _stretch(stone, 1 - _long(stone))
    zones = ((*first, -_BAND, _BAND, 4), (*second, np.pi / 2 - _DOT, np.pi / 2, 8))
    return [
        Profile(name, colour, *_lifted(*arc((0.0, 0.0), 1.0, low, high, count)), beside)
        for name, colour, low, high, count in zones
    ]


def marks(stone: Ellipsoid, upper: str) -> list[Part]:
    """The two marks, in the colours of the letters O and X."""
    cut = height(stone)
    if cut == 1:
        return [lathe(profile) for profile in turned_marks(stone, upper)]
    long, (_, _, z) = _long(stone), _stretch(stone).centre
    semi = np.asarray(stone.axes) * math.sqrt(1 - cut * cut)
    found = []
    for (name, colour), end in zip(_inks(upper), (1, -1), strict=True):
        corners = np.zeros((3, 3))
        corners[:, 2] = z + float(np.asarray(stone.axes)[2]) * (cut + _LIFT)
        corners[0, long] = end * _LONG * semi[long]
        # counter-clockwise from above, whichever axis is the longer one
        aside = end * (1 if long == 0 else -1) * _WIDE * semi[1 - long]
        corners[1, 1 - long], corners[2, 1 - long] = aside, -aside
        up = np.tile([0.0, 0.0, 1.0], (3, 1))
        corners -= [*np.asarray(stone.offset)[:2], 0.0]
        found.append(Part(name, colour, corners, up, np.array([[0, 1, 2]])))
    return found


def reach(stone: Ellipsoid) -> float:
    """How far its surface reaches from its centre of mass."""
    return max(float(np.linalg.norm(lathe(p).vertices, axis=1).max()) for p in profiles(stone))


def _inks(upper: str) -> tuple[tuple[str, tuple[float, float, float]], tuple[str, tuple[float, float, float]]]:
    """Name and colour of the first mark, and of the second."""
    blue, orange = ("O", BLUE), ("X", ORANGE)
    return (blue, orange) if upper == "O" else (orange, blue)


def _long(stone: Ellipsoid) -> int:
    """Which of the first two axes, counted from 0, is the longer one."""
    return int(np.argmax(np.asarray(stone.axes)[:2]))


def _stretch(stone: Ellipsoid, about: int = 2) -> Stretch:
    a, b, c = np.asarray(stone.axes).tolist()
    x, y, z = (-np.asarray(stone.offset)).tolist()
    return Stretch((a, b, c), (x, y, z), about)


def _lifted(
    corners: list[tuple[float, float]], normals: list[tuple[float, float]]
) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    return [((1 + _LIFT) * x, (1 + _LIFT) * z) for x, z in corners], normals
