"""The soft shadow of a body on the table: overlapping shadows from several points of a round lamp.

The triangles that face a point of the lamp are bounded by edges to triangles that do not: these edges cast
the outline of the shadow.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from spincyl._input.numbers import Floats
from spincyl.studio.shape import Part

#: Darkness of the full shadow; number of points of the lamp, and a larger one for a body high above the
#: table, where the shadows from a few points would be visible one by one.
DARK = 0.24
LAMPS, MANY = 12, 32


def lamps(count: int) -> Floats:
    """Horizontal displacement of the shadow per unit of height, for each point of the lamp."""
    far = 0.15 * np.sqrt((np.arange(count) + 0.5) / count)
    return np.array([(0.36 + x * math.cos(2.4 * k), 0.4 + x * math.sin(2.4 * k)) for k, x in enumerate(far)])


def layer(count: int) -> float:
    """Darkness of the shadow that each point of the lamp casts."""
    return float(1 - (1 - DARK) ** (1 / count))


class Caster(NamedTuple):
    """A surface that casts a shadow."""

    vertices: Floats  #: (n, 3)
    triangles: np.ndarray  #: (m, 3) indices of vertices
    mates: np.ndarray  #: (m, 3) the triangle across each edge; m if there is none


def caster(parts: list[Part]) -> Caster:
    """The combined surface of several parts."""
    seamless = [_seamless(part) for part in parts]
    before = np.cumsum([0, *(len(vertices) for vertices, _ in seamless)])
    triangles = np.concatenate([part + n for (_, part), n in zip(seamless, before, strict=False)])
    begin, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    runs, back = begin * before[-1] + end, end * before[-1] + begin
    order = np.argsort(runs)
    found = order[np.searchsorted(runs, back, sorter=order) % runs.size]
    mates = np.where(runs[found] == back, found // 3, len(triangles))
    return Caster(np.concatenate([vertices for vertices, _ in seamless]), triangles, mates.reshape(-1, 3))


def _seamless(part: Part) -> tuple[Floats, np.ndarray]:
    """Vertices and triangles of a part, without two vertices at one place and triangles without area."""
    _, kept, one = np.unique(np.round(part.vertices, 9) + 0.0, axis=0, return_index=True, return_inverse=True)
    triangles = one.reshape(-1)[part.triangles]
    triangles = triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]
    edges = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    if len(np.unique(edges, axis=0)) < len(edges):  # the surface touches itself
        return part.vertices, part.triangles
    return part.vertices[kept], triangles


def shadows(of: Caster, rotation: Floats, centre: Floats, lamp: Floats) -> list[list[Floats]]:
    """The closed outlines (n, 3) of the shadow on the table, for each point of the lamp."""
    places = of.vertices @ rotation.T + centre
    corners = places[of.triangles]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    edges = np.stack([of.triangles, np.roll(of.triangles, -1, axis=1)], axis=2)
    found = []
    for far in lamp:
        sees = np.append(flat @ np.array([*-far, 1.0]) > 0, False)
        rims = _closed_lines(edges[sees[:-1, np.newaxis] & ~sees[of.mates]])
        fallen = np.column_stack([places[:, :2] + places[:, 2:] * far, np.zeros(len(places))])
        found.append([fallen[rim] for rim in rims])
    return found


def _closed_lines(edges: np.ndarray) -> list[np.ndarray]:
    """Closed lines assembled from directed edges (n, 2)."""
    begin, end = edges.T
    # at each corner as many edges end as begin: in the order of their corners they follow each other
    after = np.empty(len(edges), np.intp)
    after[np.argsort(end, kind="stable")] = np.argsort(begin, kind="stable")
    following, lines = after.tolist(), []
    left = dict.fromkeys(range(len(edges)))
    while left:
        line = [left.popitem()[0]]
        while (at := following[line[-1]]) in left:
            del left[at]
            line.append(at)
        lines.append(begin[line])
    return lines


def outline(lines: list[Floats]) -> Any:
    """A path along closed lines (n, 2), for filling; overlapping lines darken only once."""
    from matplotlib.path import Path as Outline

    corners = np.concatenate([np.concatenate([line, line[:1]]) for line in lines])
    kinds = np.full(len(corners), Outline.LINETO, np.uint8)
    ends = np.cumsum([len(line) + 1 for line in lines])
    kinds[[0, *ends[:-1]]], kinds[ends - 1] = Outline.MOVETO, Outline.CLOSEPOLY
    return Outline(corners, kinds)
