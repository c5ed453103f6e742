"""Surfaces as triangles in the order of drawing, lit as on the page.

A surface is cut by planes across its axis at the ends of all parts. A piece on the far side of a plane cannot
hide anything on the eye's side, so the pieces between two planes are drawn together, the farthest first.
Among these the order is: surfaces seen from inside, the widest first, then surfaces seen from outside, the
narrowest first, each with its marks.
"""

import math
from typing import NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._ellipsoid import Ellipsoid
from spincyl._input.numbers import Floats
from spincyl.studio.look import Camera
from spincyl.studio.shape import Letter, Part, Profile, kind, lathe, marks, profiles

_SUN = np.array([-0.45, -0.5, 0.75]) / math.sqrt(0.45**2 + 0.5**2 + 0.75**2)
_SAME_HEIGHT = 1e-9  # heights closer than this, in R, are one
_LEAST, _MOST = 32, 128  # flat pieces round the axis
_NORMAL_TOLERANCE = 0.01  # how far a normal between two corners may be from the true one
#: Corners (n, 3, 2) in the picture and colours (n, 3, 3) of triangles, in the order of drawing.
Painted = tuple[Floats, Floats]


class Piece(NamedTuple):
    """Triangles of one colour between two heights on the axis."""

    colour: tuple[float, float, float]
    corners: Floats  #: (m, 3, 3)
    normals: Floats  #: (m, 3, 3)
    low: float = 0.0
    high: float = 0.0
    rank: tuple[int, float] = (0, 0.0)  #: order of drawing among those between the same heights


def whole(part: Part) -> Piece:
    """A part as one piece."""
    return Piece(part.colour, part.vertices[part.triangles], part.normals[part.triangles])


def turned(body: Body | Ellipsoid, off: float) -> list[Part]:
    """The surface of a body with few triangles, which lie at most `off` inside the true surface."""
    drawn = profiles(body)
    wide = max(r * _stretched(profile) for profile in drawn for r, _ in profile.corners)
    around = math.pi / math.acos(max(1 - off / wide, 0.0))
    count = 8 * math.ceil(min(max(around, _LEAST), _MOST) / 8)
    return [lathe(_without_flat_corners(profile, off / _stretched(profile)), count) for profile in drawn]


def _stretched(profile: Profile) -> float:
    return 1.0 if profile.stretch is None else max(profile.stretch.axes)


def _without_flat_corners(profile: Profile, off: float) -> Profile:
    """The profile without corners that a straight line between others replaces within `off`."""
    if profile.normals is None:
        return profile
    corners, normals = np.array(profile.corners), np.array(profile.normals)

    def spanned(first: int, last: int) -> bool:
        """Whether a line between two corners is close to all corners between them, in place and normal."""
        line, rows = corners[last] - corners[first], slice(first + 1, last)
        away, long = corners[rows] - corners[first], max(float(np.hypot(*line)), 1e-300)
        share = (away @ line / long**2)[:, np.newaxis]
        bent = normals[first] + share * (normals[last] - normals[first]) - normals[rows]
        aside = np.abs(away[:, 0] * line[1] - away[:, 1] * line[0]) / long
        return bool((aside <= off).all() and (np.abs(bent) <= _NORMAL_TOLERANCE).all())

    kept = [0]
    while (last := kept[-1] + 1) < len(corners):
        while last + 1 < len(corners) and spanned(kept[-1], last + 1):
            last += 1
        kept.append(last)
    few, ways = ([pairs[k] for k in kept] for pairs in (profile.corners, profile.normals))
    return profile._replace(corners=few, normals=ways)


def pieces(body: Body | Ellipsoid, surface: list[Part], upper: Letter) -> list[Piece]:
    """The pieces of the surface of a body, and of its marks."""
    surfaces = [whole(part) for part in surface]
    found = [*surfaces, *map(whole, marks(body, upper))]
    if kind(body) == "stone":  # convex: only its marks have to be last
        return [piece._replace(rank=(0, float(k))) for k, piece in enumerate(found)]
    ends = [end for piece in surfaces for end in (piece.corners[..., 2].min(), piece.corners[..., 2].max())]
    heights = np.unique(np.round(ends, 9))
    return [slab for piece in found for slab in _slabs(piece, heights)]


def _slabs(piece: Piece, heights: Floats) -> list[Piece]:
    """A piece cut at these heights, and into parts that are seen from inside and from outside."""
    for height in heights:
        piece = _cut(piece, float(height))
    corners, normals = piece.corners, piece.normals
    z = corners[..., 2]
    flat = np.ptp(z, axis=1) < _SAME_HEIGHT
    below = np.searchsorted(heights, z.mean(axis=1))
    within = np.append(np.append(-np.inf, heights), np.inf)
    low = np.where(flat, z[:, 0], within[below])
    high = np.where(flat, z[:, 0], within[below + 1])
    inside = (corners[..., :2] * normals[..., :2]).sum(-1).mean(-1) < -_SAME_HEIGHT
    radius = np.hypot(corners[..., 0], corners[..., 1]).max(axis=1)
    found = []
    for key in np.unique(np.column_stack([low, high, inside]), axis=0):
        here = (low == key[0]) & (high == key[1]) & (inside == key[2])
        wide = float(radius[here].max())
        rank = (0, -wide) if key[2] else (1, wide)
        found.append(Piece(piece.colour, corners[here], normals[here], float(key[0]), float(key[1]), rank))
    return found


def _cut(piece: Piece, height: float) -> Piece:
    """The piece with each triangle that crosses a height cut into three triangles there."""
    off = piece.corners[..., 2] - height
    sides = np.where(np.abs(off) < _SAME_HEIGHT, 0, np.sign(off)).astype(int)
    through = (sides.min(axis=1) < 0) & (sides.max(axis=1) > 0)
    if not through.any():
        return piece
    sides = np.where(sides[through] < 0, -1, 1)
    lone = np.argmax(sides == -np.sign(sides.sum(axis=1))[:, np.newaxis], axis=1)
    turn = (lone[:, np.newaxis] + np.arange(3)) % 3
    both = np.concatenate([piece.corners, piece.normals], -1)
    a, b, c = np.moveaxis(np.take_along_axis(both[through], turn[..., np.newaxis], 1), 1, 0)
    z = a[:, 2] - height
    ab, ac = (a + (z / (a[:, 2] - p[:, 2]))[:, np.newaxis] * (p - a) for p in (b, c))
    cut = [np.stack(three, 1) for three in ((a, ab, ac), (ab, b, c), (ab, c, ac))]
    corners, normals = np.split(np.concatenate([both[~through], *cut]), 2, axis=-1)
    return piece._replace(corners=corners, normals=normals)


def ordered(found: list[Piece], height: float) -> list[Piece]:
    """The pieces in the order of drawing for an eye at this height on the axis."""
    return sorted(found, key=lambda x: (-max(x.low - height, height - x.high, 0.0), x.rank))


def painted(
    piece: Piece, rotation: Floats, centre: Floats, camera: Camera, *, over: bool = False, back: bool = False
) -> Painted:
    """The triangles of a piece that face the camera, with their light.

    `over`: the motion has ended, and the colour loses most of its hue. `back`: the triangles that face away,
    without light.
    """
    eye = (camera.eye - centre) @ rotation
    corners = piece.corners
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    facing = (((eye - corners[:, 0]) * flat).sum(axis=-1) > 0) != back
    turned = piece.normals[facing] @ rotation.T
    light = 1.0 if back else 0.52 + 0.16 * turned[..., 2:] + 0.36 * np.maximum(turned @ _SUN, 0.0)[..., None]
    colour = np.array(piece.colour)
    if over:
        colour = 0.06 * colour + 0.94 * (0.42 + 0.3 * colour @ [0.3, 0.59, 0.11])
    lit = np.clip(light * np.broadcast_to(colour, turned.shape), 0.0, 1.0)
    return camera(corners[facing] @ rotation.T + centre), lit
