"""Drawn shapes of stones: pieces of the unit ball, turned on a lathe and stretched to an ellipsoid.

The origin is the centre of mass. A stone with an edge is cut by the plane of the edge, at the height

    z = -a3^2 cos(theta_end)/hypot(a sin(theta_end), a3 cos(theta_end))

above the centre, where a is a1 or a2, whichever gives the larger z, so that everything that touches the
table is drawn. A needle lies on the plane along the longer axis, and a stripe in its colours surrounds the
hull. A whole stone has a band round its longer side and a dot beside the band, which show any rotation.

As for other bodies, the corners lie on the true surface. The drawn unit ball lies at most 6e-4 inside the
true one, and a drawn stone at most that share of the height of its centre above the table.
"""

import math

import numpy as np

from spincyl._ellipsoid import Ellipsoid
from spincyl._input.numbers import Floats
from spincyl.studio.surface import (
    BLUE,
    IVORY,
    ORANGE,
    SHADE,
    Part,
    Profile,
    Stretch,
    arc,
    joined,
    lathe,
    strip,
)

_QUARTER = 32  # pieces of a quarter of a circle
_LIFT = 0.004  # height of the marks above the surface of the unit ball
_BAND, _DOT = 0.07, 0.2  # half the width of the band and the radius of the dot, in radians on the unit ball
# ends of the stripe on the hull, as shares of the arc from the lowest point to the edge
_STRIPE = (0.84, 0.95)
_LONG, _WIDE = 0.88, 0.34  # half length and half width of the needle, as shares of the plane's semi-axes


def height(stone: Ellipsoid) -> float:
    """The height at which the unit ball is cut, from -1 to 1; 1 for a whole stone."""
    end = float(stone.theta_end)
    if not end < math.pi:
        return 1.0
    a1, a2, a3 = np.asarray(stone.semi_axes).tolist()
    sin, cos = math.sin(end), math.cos(end)
    across = max(a1, a2) if cos > 0 else min(a1, a2)
    return float(-a3 * cos / math.hypot(across * sin, a3 * cos))


def profiles_of_stone(stone: Ellipsoid) -> list[Profile]:
    """The surface of a stone without its marks."""
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
    """The marks that are turned on a lathe: band and dot of a whole stone."""
    if height(stone) < 1:
        return []
    first, second = _names_and_colours(upper)
    beside = _stretch(stone, 1 - _longer_axis(stone))
    zones = ((*first, -_BAND, _BAND, 4), (*second, np.pi / 2 - _DOT, np.pi / 2, 8))
    return [
        Profile(name, colour, *_lifted(*arc((0.0, 0.0), 1.0, low, high, count)), beside)
        for name, colour, low, high, count in zones
    ]


def marks_of_stone(stone: Ellipsoid, upper: str) -> list[Part]:
    """The two marks, in the colours of the letters O and X."""
    cut = height(stone)
    if cut == 1:
        return [lathe(profile) for profile in turned_marks(stone, upper)]
    # columns: along the longer axis, across it, up
    turn = (
        np.eye(3)
        if _longer_axis(stone) == 0
        else np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    )
    found = []
    for (name, colour), end in zip(_names_and_colours(upper), (1, -1), strict=True):
        pieces = [
            (places @ turn, normals @ turn, i)
            for places, normals, i in (_needle(cut, end), _stripe_of_hull(cut, end))
        ]
        found.append(_stretch(stone)(joined(name, colour, pieces)))
    return found


def _needle(cut: float, end: int) -> tuple[Floats, Floats, np.ndarray]:
    """One half of the needle that lies on the plane at which a stone with an edge is cut."""
    long, wide = end * math.sqrt(1 - cut * cut) * np.array([_LONG, _WIDE])
    corners = np.array([[long, 0.0, cut + _LIFT], [0.0, wide, cut + _LIFT], [0.0, -wide, cut + _LIFT]])
    return corners, np.tile([0.0, 0.0, 1.0], (3, 1)), np.array([[0, 1, 2]])


def _stripe_of_hull(cut: float, end: int) -> tuple[Floats, Floats, np.ndarray]:
    """One half of the stripe round the hull of a stone, below its edge."""
    up = -np.pi / 2 + np.linspace(*_STRIPE, 3)[:, np.newaxis] * math.acos(-cut)
    angle = np.linspace(-np.pi / 2, np.pi / 2, _QUARTER + 9)
    around = [end * np.cos(up) * np.cos(angle), end * np.cos(up) * np.sin(angle), np.sin(up)]
    normals = np.stack(np.broadcast_arrays(*around), -1)
    return strip((1 + _LIFT) * normals, normals)


def reach_of_stone(stone: Ellipsoid) -> float:
    """Largest distance of the stone's surface from its centre of mass."""
    return max(float(np.linalg.norm(lathe(p).vertices, axis=1).max()) for p in profiles_of_stone(stone))


def _names_and_colours(
    upper: str,
) -> tuple[tuple[str, tuple[float, float, float]], tuple[str, tuple[float, float, float]]]:
    """Name and colour of the first mark, and of the second."""
    blue, orange = ("O", BLUE), ("X", ORANGE)
    return (blue, orange) if upper == "O" else (orange, blue)


def _longer_axis(stone: Ellipsoid) -> int:
    """Index of the longer of the first two axes."""
    return int(np.argmax(np.asarray(stone.semi_axes)[:2]))


def _stretch(stone: Ellipsoid, about: int = 2) -> Stretch:
    a, b, c = np.asarray(stone.semi_axes).tolist()
    x, y, z = (-np.asarray(stone.offset)).tolist()
    return Stretch((a, b, c), (x, y, z), about)


def _lifted(
    corners: list[tuple[float, float]], normals: list[tuple[float, float]]
) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    return [((1 + _LIFT) * x, (1 + _LIFT) * z) for x, z in corners], normals
