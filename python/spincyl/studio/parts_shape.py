"""The drawn shape of a body put together from parts: its parts, and two stripes that show the spin."""

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from spincyl._body import Body
from spincyl._input.numbers import Floats
from spincyl.studio.surface import BLUE, IVORY, ORANGE, SHADE, Part, Profile, arc, joined, strip

_QUARTER = 32  # pieces of a quarter of a circle
_WIRE_RADIUS = 0.03  # radius of the wire of a ring, in R
_NARROWEST_CUT = 1e-6  # a ball whose cut is narrower than this share of its radius is whole
# half the width of a stripe, and its height above the surface, as shares of the largest radius
_STRIPE, _LIFT = 0.08, 0.004


def profiles_of_parts(body: Body) -> list[Profile]:
    """The surfaces to draw for a body of parts (a point has none), or for the hull of a body's circles."""
    if not body._parts:
        return [Profile("hull", IVORY, corners, normals) for corners, normals in _hull_of_circles(body)]
    drawn = [(name, _surfaces(form, numbers)) for name, form, numbers in body._parts]
    seen = [(name, surfaces) for name, surfaces in drawn if surfaces]
    return [
        Profile(name, SHADE if i % 2 else IVORY, corners, normals)
        for i, (name, surfaces) in enumerate(seen)
        for corners, normals in surfaces
    ]


_Corners = list[tuple[float, float]]


def _hull_of_circles(body: Body) -> Iterator[tuple[_Corners, _Corners | None]]:
    """The convex hull of a body of several circles from its lower end up: fillets, straight walls, faces."""
    ends = [0.0, *body.borders.tolist(), np.pi]
    rows = body.circles.tolist()
    last = 0.0, rows[0][1] - rows[0][2]
    for (radius, height, fillet), (low, high) in zip(rows, pairwise(ends), strict=True):
        pieces = math.ceil(_QUARTER * (high - low) / (np.pi / 2))
        corners, normals = arc((radius, height), fillet, low - np.pi / 2, high - np.pi / 2, pieces)
        if math.dist(last, corners[0]) > _NARROWEST_CUT:
            yield [last, corners[0]], None
        if fillet > 0:
            yield corners, normals
        last = corners[-1]
    if last[0] > _NARROWEST_CUT:
        yield [last, (0.0, last[1])], None


def _surfaces(form: int, numbers: tuple[float, ...]) -> list[tuple[_Corners, _Corners | None]]:
    """Polygons that give the surfaces of a part when turned round the axis, the outside on their right."""
    if form == 0:
        r, s, b, c, low, high, f = numbers
        if f:
            below, above = (
                arc((r - f, z), f, start, start + np.pi / 2, _QUARTER)
                for z, start in ((low + f, -np.pi / 2), (high - f, 0.0))
            )
            outside = (below[0] + above[0], below[1] + above[1])
            faces: _Corners = [(b, low), (r - f, low)]
            return [
                outside,
                (faces, None),
                ([(s - f, high), (c, high)], None),
                *_wall_of_bore(b, c, low, high),
            ]
        return [([(b, low), (r, low), (s, high), (c, high)], None), *_wall_of_bore(b, c, low, high)]
    if form in (1, 3):
        radius, centre, low, high = numbers if form == 3 else (numbers[0], *numbers[2:])
        start, stop = (math.asin(max(-1.0, min(1.0, (z - centre) / radius))) for z in (low, high))
        corners, normals = arc((0.0, centre), radius, start, stop, 2 * _QUARTER)
        skin: list[tuple[_Corners, _Corners | None]] = [(corners, normals)]
        if form == 3:
            return [*skin, (corners[::-1], [(-x, -z) for x, z in normals[::-1]])]
        cuts: list[_Corners] = [[(0.0, low), corners[0]], [corners[-1], (0.0, high)]]
        return skin + [(cut, None) for cut in cuts if max(r for r, _ in cut) > _NARROWEST_CUT * radius]
    if form == 2:
        r, s, low, high = numbers
        return [([(r, low), (s, high)], None), ([(s, high), (r, low)], None)]
    r, z = numbers
    if not r:
        return []
    angle = np.linspace(-np.pi, np.pi, 2 * _QUARTER)
    around = list(zip(np.cos(angle).tolist(), np.sin(angle).tolist(), strict=True))
    # the wire lies inside its circle
    return [([(r - _WIRE_RADIUS + _WIRE_RADIUS * x, z + _WIRE_RADIUS * up) for x, up in around], around)]


def _wall_of_bore(b: float, c: float, low: float, high: float) -> list[tuple[_Corners, None]]:
    return [([(c, high), (b, low)], None)] if max(b, c) > 0 else []


def striped(surfaces: list[Profile]) -> list[Profile]:
    """The surfaces of the widest part, which has the stripes; a ring only if all parts are rings."""
    broad = [surface for surface in surfaces if surface.name != "ring"] or surfaces
    name = max(broad, key=lambda surface: max(r for r, _ in surface.corners)).name
    return [surface for surface in surfaces if surface.name == name]


def marks_of_parts(body: Body, upper: str) -> list[Part]:
    """Two stripes on opposite sides of the widest part; the first in the colour of `upper`."""
    surfaces = profiles_of_parts(body)
    most = max(r for surface in surfaces for r, _ in surface.corners)
    colours = (BLUE, ORANGE) if upper == "O" else (ORANGE, BLUE)
    return [
        joined(
            letter,
            colour,
            [
                piece
                for surface in striped(surfaces)
                for piece in _stripe_of_polygon(np.array(surface.corners), azimuth, most)
            ],
        )
        for letter, colour, azimuth in zip(("O", "X"), colours, (0.0, np.pi), strict=True)
    ]


def _stripe_of_polygon(
    corners: Floats, azimuth: float, most: float
) -> Iterator[tuple[Floats, Floats, NDArray[np.intp]]]:
    """A stripe along a polygon: the vertices, normals and triangles of each of its pieces."""
    for start, end in pairwise(corners):
        long = np.hypot(*(end - start))
        if long == 0:
            continue
        out, up = (end[1] - start[1]) / long, (start[0] - end[0]) / long
        rows = []
        for r, z in (start, end):
            half = min(_STRIPE * most, 0.5 * r)
            angle = azimuth + np.linspace(-1, 1, 9) * (half / r if r > 0 else 0.0)
            ray = np.column_stack([np.cos(angle), np.sin(angle)])
            rows.append(np.column_stack([(r + _LIFT * most * out) * ray, np.full(9, z + _LIFT * most * up)]))
        normal = np.column_stack([out * ray, np.full(9, up)])
        yield strip(np.stack(rows), np.broadcast_to(normal, (2, *normal.shape)))
