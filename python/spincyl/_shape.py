"""What a body looks like: triangles of its surface and of the two marks, O and X, in units of R.

The body's axes are those of `Motion.orientation`: the third is the symmetry axis, the upper end is at
z = ell, and at the start the first points to the top of the rim. One geometry serves the page, the
photograph and the glTF file; the page turns the profiles on a lathe of its own, so that sides cost no bytes.
"""

from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from spincyl._array import Floats
from spincyl._body import Body

Letter = Literal["O", "X"]

#: Below this aspect ratio the marks are on the faces, since the wall has no room for them.
_DISK = 0.4
_AROUND = 128
_LIFT = 0.006  # of the marks above the surface
IVORY, SHADE, BLUE, ORANGE = (0.87, 0.85, 0.80), (0.72, 0.70, 0.66), (0.0, 0.36, 0.65), (0.80, 0.30, 0.0)


class Profile(NamedTuple):
    """A piece of surface in one colour, as the polygon that sweeps it round the axis."""

    name: str
    colour: tuple[float, float, float]
    corners: list[tuple[float, float]]  #: radius and height; outside is on the right of its direction


class Part(NamedTuple):
    """A piece of surface in one colour."""

    name: str
    colour: tuple[float, float, float]
    vertices: Floats  #: (n, 3)
    normals: Floats  #: (n, 3), outward
    triangles: np.ndarray  #: (m, 3) indices, counter-clockwise from outside


def lathe(profile: Profile) -> Part:
    """The surface that a profile sweeps."""
    angle = np.linspace(0, 2 * np.pi, _AROUND + 1)
    circle = np.stack([np.cos(angle), np.sin(angle)], -1)
    pieces = []
    for (r0, z0), (r1, z1) in pairwise(profile.corners):
        length = np.hypot(r1 - r0, z1 - z0)
        if length == 0:
            continue
        out, up = (z1 - z0) / length, (r0 - r1) / length
        ring = np.stack(
            [np.column_stack([r * circle, np.full(angle.shape, z)]) for r, z in ((r0, z0), (r1, z1))]
        )
        normal = np.broadcast_to(np.column_stack([out * circle, np.full(angle.shape, up)]), ring.shape)
        pieces.append(_strip(ring, normal))
    return _joined(profile.name, profile.colour, pieces)


def profiles(body: Body) -> list[Profile]:
    """The surface of a body but for its marks.

    A body of unknown bore is drawn solid, a tube at least 0.02 R thick.
    """
    ell, bore = float(body.ell), _bore(body)
    surface = [Profile("wall", IVORY, [(1.0, -ell), (1.0, ell)])] if ell else []
    surface += [
        Profile("faces", SHADE, [(1.0, ell), (bore, ell)]),
        Profile("lower face", SHADE, [(bore, -ell), (1.0, -ell)]),
    ]
    if ell and bore:
        surface.append(Profile("bore", SHADE, [(bore, ell), (bore, -ell)]))
    return surface


def marks(body: Body, upper: Letter = "O") -> list[Part]:
    """The two marks; `upper` is the letter on the upper end."""
    if upper not in ("O", "X"):
        raise ValueError(f"upper = {upper!r}: expected 'O' or 'X'")
    lower: Letter = "X" if upper == "O" else "O"
    return [_mark(body, upper, 1), _mark(body, lower, -1)]


def parts(body: Body, upper: Letter = "O") -> list[Part]:
    """The surface of a body, its marks last."""
    return [*map(lathe, profiles(body)), *marks(body, upper)]


def _bore(body: Body) -> float:
    bore = min(float(body.bore), 0.98)
    return bore if bore > 0 else 0.0


def _mark(body: Body, letter: Letter, end: int) -> Part:
    """A letter near the rim of the upper (end = 1) or lower (-1) end: on the wall, or a disk's face."""
    ell = float(body.ell)
    wall, face = min(1.0, 0.8 * ell), min(0.6, 0.85 * (1 - _bore(body)))
    on_wall = ell >= _DISK or wall > face
    size = wall if on_wall else face
    pieces = []
    for u, v in _glyph(letter):
        u, v = size * u, size * v
        if on_wall:
            direction = np.stack([np.cos(u), np.sin(u), np.zeros(u.shape)], -1)
            place = (1 + _LIFT) * direction
            place[..., 2] = end * (ell - 0.56 * size + v)
        else:
            middle = 1 - 0.56 * size
            place = np.stack([middle + v, u, np.full(u.shape, end * (ell + _LIFT))], -1)
            direction = np.broadcast_to([0.0, 0.0, float(end)], place.shape)
        # seen from outside, the letters of the two ends run in opposite senses
        pieces.append(_strip(place[::-1] if (end > 0) == on_wall else place, direction))
    return _joined(letter, BLUE if letter == "O" else ORANGE, pieces)


def _glyph(letter: Letter) -> list[tuple[Floats, Floats]]:
    """Strips (2, n) that cover a letter of height 1 once: across and along."""
    stroke = 0.2
    if letter == "O":
        angle = np.linspace(0, 2 * np.pi, 49)
        radius = np.array([[0.5 - stroke], [0.5]])
        return [(radius * np.cos(angle), radius * np.sin(angle))]
    # a bar and two halves that leave the crossing to it
    half, side = 0.5 * np.sqrt(2) - 0.5 * stroke, np.array([[0.5], [-0.5]]) * stroke
    strips = []
    for turn, start, stop in ((1, -half, half), (-1, 0.5 * stroke, half), (-1, -half, -0.5 * stroke)):
        along = np.linspace(start, stop, 13)
        strips.append(((along - turn * side) / np.sqrt(2), (turn * along + side) / np.sqrt(2)))
    return strips


def _strip(rows: Floats, normals: Floats) -> tuple[Floats, Floats, np.ndarray]:
    """Vertices, normals and triangles between two rows of n points each, the first below."""
    n = rows.shape[1]
    i = np.arange(n - 1)
    triangles = np.concatenate([np.stack([i, i + 1, i + n], -1), np.stack([i + 1, i + n + 1, i + n], -1)])
    return rows.reshape(-1, 3), normals.reshape(-1, 3), triangles


def _joined(
    name: str, colour: tuple[float, float, float], pieces: list[tuple[Floats, Floats, np.ndarray]]
) -> Part:
    if not pieces:
        return Part(name, colour, np.empty((0, 3)), np.empty((0, 3)), np.empty((0, 3), np.intp))
    offsets = np.cumsum([0, *(len(vertices) for vertices, _, _ in pieces)])
    triangles = np.concatenate([t + k for (_, _, t), k in zip(pieces, offsets, strict=False)])
    vertices = np.concatenate([v for v, _, _ in pieces])
    corners = vertices[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=-1)
    return Part(name, colour, vertices, np.concatenate([n for _, n, _ in pieces]), triangles[area > 1e-12])


def rotations(q: Floats) -> Floats:
    """Matrices (..., 3, 3) of unit quaternions (..., 4) in the order x, y, z, w."""
    x, y, z, w = np.moveaxis(q, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))
