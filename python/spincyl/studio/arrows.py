"""Arrows of the vectors of a motion, and the instantaneous axis, as the page draws them.

The points of the axis have velocities along it, or zero: it passes through C + w x v/w^2, and through the
contact point P while the body rolls. The line P-C-O runs from P through the centre of mass C to the point
opposite to P. If the centre is at rest, the two lines coincide, and O, the top of the upper rim, is at rest.
"""

from typing import Any, NamedTuple

import numpy as np

from spincyl._input.numbers import Floats
from spincyl._motion import Motion
from spincyl.studio.aloft import ON_FACE, goes_up, pressed
from spincyl.studio.look import Camera
from spincyl.studio.painted import Painted, Piece, painted, whole
from spincyl.studio.poses import seen, span
from spincyl.studio.shape import Profile, lathe, rotations, tensor

_NEAR = 1e-4  # time step of a difference, over the time in which the body turns by one radian
_SAMPLES = 600
_LETTERS = {"omega": "ω", "momentum": "L", "velocity": "v", "normal": "N", "friction": "F"}
_POINTS = ("P", "C", "O")


def _solid(*corners: tuple[float, float]) -> Piece:
    return whole(lathe(Profile("", (0.0, 0.0, 0.0), list(corners)), 24))


def _arrow(d: float) -> Piece:
    """An arrow of length 1 along the third axis, or its halo, which is larger by d."""
    shaft, head = 0.016 + d, 0.045 + 1.7 * d
    return _solid((0, -d), (shaft, -d), (shaft, 0.86 - d), (head, 0.86 - d), (0, 1 + 3 * d))


_ARROW, _HALO = _arrow(0.0), _arrow(0.011)
_ROD = _solid((0, 0), (1, 0), (1, 1), (0, 1))
_BEAD = _solid((0, -1), (0.7, -0.7), (1, 0), (0.7, 0.7), (0, 1))


class Vectors(NamedTuple):
    """Vectors and points in the laboratory at the same times, (n, 3) each."""

    of: dict[str, Floats]
    contact: Floats
    centre: Floats

    def at(self, k: int) -> "Vectors":
        """The vectors and points at time number k."""
        return Vectors({name: x[k] for name, x in self.of.items()}, self.contact[k], self.centre[k])


def vectors(m: Motion, t: Floats, drawn: tuple[str, ...]) -> Vectors:
    """The vectors at the times `t` that are drawn as arrows or that define the instantaneous axis."""
    first, last = sorted(span(m))
    t = np.clip(t, first, last)
    (w,) = seen(m, t, "w")
    h = _NEAR / (1 + np.linalg.norm(w, axis=-1))
    around = np.clip(np.stack([t - h, t, t + h]), first, last)
    centre, orientation = seen(m, around, "centre", "orientation")
    contact = np.zeros_like(centre[1])
    contact[:, :2] = seen(m, t, "contact_point")[0]
    long = (around[2] - around[0])[:, np.newaxis]
    turned = rotations(orientation)
    turning = (turned[2] - turned[0]) / long[..., np.newaxis] @ np.swapaxes(turned[1], -1, -2)
    omega = np.stack([turning[:, i, j] - turning[:, j, i] for i, j in ((2, 1), (0, 2), (1, 0))], -1) / 2
    momentum = np.einsum("nij,jk,nlk,nl->ni", turned[1], tensor(m.body), turned[1], omega)
    found = {"omega": omega, "momentum": momentum, "velocity": (centre[2] - centre[0]) / long}
    up = goes_up(m)
    if up and (stands := seen(m, t, "phase")[0] == ON_FACE).any():
        (force,) = seen(m, t, "contact_force")
        contact[stands] = pressed(centre[1], force)[stands]
    if "force" in drawn:
        (force,) = seen(m, t, "contact_force")
        if up and m._nods and m._impacts is not None:  # the arrow stands on one rim
            force = force - np.nan_to_num(seen(m, t, "contact_force_other", "contact_force")[0])
        found |= {"normal": force * [0, 0, 1], "friction": force * [1, 1, 0]}
    return Vectors(found, contact, centre[1])


def usual(m: Motion, drawn: tuple[str, ...]) -> dict[str, float]:
    """Magnitude that an arrow of the usual length stands for: the largest; for forces the median of N."""
    first, last = sorted(span(m))
    of = vectors(m, np.linspace(first, last, _SAMPLES), drawn).of
    sizes = {name: np.linalg.norm(x, axis=-1) for name, x in of.items()}
    most = {name: max(float(size.max()), 1e-9) for name, size in sizes.items()}
    return most | dict.fromkeys(("normal", "friction"), max(1e-9, float(np.median(sizes.get("normal", 1.0)))))


class Tip(NamedTuple):
    """The letter of a vector, the name of its colour, and the tip and root of its arrow in the picture."""

    letter: str
    name: str
    at: Floats
    root: Floats


def drawings(
    now: Vectors, drawn: tuple[str, ...], sizes: dict[str, float], half: float, camera: Camera, colours: Any
) -> tuple[list[Painted], list[Tip]]:
    """Rods and arrows at one time as triangles, and their letters."""
    found: list[Painted] = []
    tips: list[Tip] = []
    if "axis" in drawn:
        for piece, name, root, way, wide, long in _rods(now, half):
            found.append(_set(piece, colours[name], root, way, wide=wide, long=long, camera=camera))
        places = camera(np.stack([now.contact, now.centre, 2 * now.centre - now.contact]))
        tips += [Tip(letter, "ink", at, at) for letter, at in zip(_POINTS, places, strict=True)]
    for name, letter in _LETTERS.items():
        size = float(np.linalg.norm(now.of.get(name, 0.0)))
        force = name in ("normal", "friction")
        if ("force" if force else name) not in drawn or not size > (1e-3 if force else 1e-9) * sizes[name]:
            continue
        share = size / sizes[name]
        long = (
            min(1.1, 0.55 * share) * half if force else (0.8 if name == "momentum" else 0.64) * half * share
        )
        wide = 0.5 * np.sqrt(half * long) if force else (0.85 if name == "momentum" else 1.3) * long
        root, way = now.contact if force else now.centre, now.of[name] / size
        found.append(_set(_HALO, colours["paper"], root, way, wide=wide, long=long, camera=camera, back=True))
        found.append(_set(_ARROW, colours[name], root, way, wide=wide, long=long, camera=camera))
        tips.append(Tip(letter, name, camera(root + long * way), camera(root)))
    return found, tips


def _rods(now: Vectors, half: float) -> list[tuple[Piece, str, Floats, Floats, float, float]]:
    """Shape, colour, root, direction, width and length of the line P-C-O, its three beads, and the axis."""
    way, omega = now.centre - now.contact, now.of["omega"]
    long, square, thick = float(np.linalg.norm(way)), float(omega @ omega), 0.006 * half
    line = way / long
    found = [(_ROD, "ink", now.contact, line, thick, 2 * long)]
    found += [(_BEAD, "ink", now.contact + k * way, line, 2.4 * thick, 2.4 * thick) for k in range(3)]
    if square > 1e-18:
        on = now.centre + np.cross(omega, now.of["velocity"]) / square
        turns = omega * np.copysign(1 / np.sqrt(square), omega @ way)
        root = on + ((now.contact - on) @ turns - 0.35 * long) * turns
        found.append((_ROD, "omega", root, turns, 0.6 * thick, 2.7 * long))
    return found


def _set(
    piece: Piece,
    colour: Any,
    root: Floats,
    way: Floats,
    *,
    wide: float,
    long: float,
    camera: Camera,
    back: bool = False,
) -> Painted:
    """A piece of length 1 along the third axis, scaled, turned into a direction and moved to its root."""
    across = np.cross([0.0, 0.0, 1.0] if abs(way[2]) < 0.9 else [1.0, 0.0, 0.0], way)
    across /= np.linalg.norm(across)
    axes = np.column_stack([across, np.cross(way, across), way])
    sized = piece._replace(colour=tuple(colour), corners=piece.corners * [wide, wide, long])
    return painted(sized, axes, root, camera, back=back)
