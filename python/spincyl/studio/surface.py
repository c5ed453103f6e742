"""Surfaces as triangles: a profile is turned on a lathe and, for a stone, stretched."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from spincyl._input.numbers import Floats

_AROUND = 128
IVORY, SHADE, BLUE, ORANGE = (0.87, 0.85, 0.80), (0.72, 0.70, 0.66), (0.0, 0.36, 0.65), (0.80, 0.30, 0.0)


class Stretch(NamedTuple):
    """Map from a surface of revolution to that of a stone: scale along its axes, then shift."""

    axes: tuple[float, float, float]
    centre: tuple[float, float, float]
    about: int = 2  #: index of the stone's axis that is the axis of the lathe

    def __call__(self, part: "Part") -> "Part":
        """Return the stretched part."""
        order = np.roll(np.arange(3), self.about - 2)
        places, normals = (
            part.vertices[:, order] * self.axes + self.centre,
            part.normals[:, order] / self.axes,
        )
        size = np.linalg.norm(normals, axis=1, keepdims=True)
        return part._replace(vertices=places, normals=normals / np.maximum(size, 1e-300))


class Profile(NamedTuple):
    """A piece of surface in one colour, as a polygon to turn round the axis."""

    name: str
    colour: tuple[float, float, float]
    #: radius and height; the outside is on the right of the polygon's direction
    corners: list[tuple[float, float]]
    #: radius and height components; None: normals of flat pieces
    normals: list[tuple[float, float]] | None = None
    stretch: Stretch | None = None  #: for a stone


class Part(NamedTuple):
    """A piece of surface in one colour."""

    name: str
    colour: tuple[float, float, float]
    vertices: Floats  #: (n, 3)
    normals: Floats  #: (n, 3), outward
    triangles: np.ndarray  #: (m, 3) indices, counter-clockwise from outside


def lathe(profile: Profile, around: int | None = None) -> Part:
    """The surface that a profile makes when it is turned and, for a stone, stretched."""
    turned = _revolved(profile, around or _AROUND)
    return turned if profile.stretch is None else profile.stretch(turned)


def _revolved(profile: Profile, around: int) -> Part:
    """The surface of revolution of a profile."""
    angle = np.linspace(0, 2 * np.pi, around + 1)
    circle = np.stack([np.cos(angle), np.sin(angle)], -1)
    pieces = []
    if profile.normals is not None:
        ring, normal = (
            np.stack([np.column_stack([r * circle, np.full(angle.shape, z)]) for r, z in pairs])
            for pairs in (profile.corners, profile.normals)
        )
        return joined(profile.name, profile.colour, [strip(ring, normal)])
    for (r0, z0), (r1, z1) in pairwise(profile.corners):
        length = np.hypot(r1 - r0, z1 - z0)
        if length == 0:
            continue
        out, up = (z1 - z0) / length, (r0 - r1) / length
        ring = np.stack(
            [np.column_stack([r * circle, np.full(angle.shape, z)]) for r, z in ((r0, z0), (r1, z1))]
        )
        normal = np.broadcast_to(np.column_stack([out * circle, np.full(angle.shape, up)]), ring.shape)
        pieces.append(strip(ring, normal))
    return joined(profile.name, profile.colour, pieces)


def arc(
    centre: tuple[float, float], radius: float, start: float, stop: float, pieces: int
) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    """Corners on a circle and their normals, from one latitude to another."""
    angle = np.linspace(start, stop, pieces + 1)
    across, up = np.cos(angle), np.sin(angle)
    across[np.abs(angle) > np.pi / 2 - 1e-12] = 0.0  # a pole is exactly on the axis
    up[angle == 0] = 0.0
    normals = list(zip(across.tolist(), up.tolist(), strict=True))
    return [(centre[0] + radius * x, centre[1] + radius * z) for x, z in normals], normals


def strip(rows: Floats, normals: Floats) -> tuple[Floats, Floats, np.ndarray]:
    """Vertices, normals and triangles between rows of n points each, from the lowest row up."""
    n = rows.shape[1]
    triangles = np.concatenate(
        [
            np.concatenate([np.stack([i, i + 1, i + n], -1), np.stack([i + 1, i + n + 1, i + n], -1)])
            for i in (k * n + np.arange(n - 1) for k in range(len(rows) - 1))
        ]
    )
    return rows.reshape(-1, 3), normals.reshape(-1, 3), triangles


def joined(
    name: str, colour: tuple[float, float, float], pieces: list[tuple[Floats, Floats, np.ndarray]]
) -> Part:
    """A part made of pieces, without triangles of zero area."""
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
