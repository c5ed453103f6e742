"""Drawn shapes of bodies: triangles of the surface and of the two marks, O and X, in units of R.

The axes are those of `Motion.orientation`: the origin is the centre of mass, the third axis is the axis of
symmetry, and initially the first axis points to the top of the rim. The upper end is at z = ell + fillet.
The page, the photograph, the glTF file and the scenes for engines share this geometry; the page turns the
profiles itself, so that only profiles are stored.

A quarter of a fillet is drawn with 32 flat pieces whose corners lie on the circle and have its normals. The
profile lies at most (1 - cos(pi/128)) fillet = 3.0e-4 fillet inside the true one, and with 128 sides the
surface another 3.0e-4 of its radius.
"""

import math
from functools import singledispatch
from typing import Any, Literal, NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._ellipsoid import Ellipsoid
from spincyl._input.numbers import Floats, one_of
from spincyl.studio import parts_shape, stone_shape
from spincyl.studio.surface import (
    BLUE,
    IVORY,
    ORANGE,
    SHADE,
    Part,
    Profile,
    arc,
    joined,
    lathe,
    rotations,
    strip,
)

Letter = Literal["O", "X"]
#: "cylinder": a cylinder or tube, sharp or rounded. "balls": two balls, one on the other. "ball": one ball.
Kind = Literal["cylinder", "capsule", "balls", "ball", "stone"]

#: Below this aspect ratio the marks are on the faces, since the wall has no room for them.
_DISK = 0.4
_QUARTER = 32  # pieces of a quarter of a circle
_ROD = 0.06  # radius of the rod between two balls
# radius of a ball's stem, and largest distance of the stem's end from the ball's centre
_STEM, _LONGEST = 0.15, 2.5
_LIFT = 0.006  # height of the marks above the surface

__all__ = [
    "BLUE", "IVORY", "ORANGE", "SHADE", "Kind", "Letter", "Part", "Profile", "kind", "landing", "lathe",
    "marks", "parts", "profiles", "reach", "rotations", "size", "skin", "steepest", "tensor",
]  # fmt: skip


@singledispatch
def kind(body: Any) -> Kind:
    """The kind of shape to draw; for a general body a guess from the inclination at which it lands."""
    if body.fillet < 1:
        return "cylinder"
    if not np.isnan(body.bore):
        return "capsule" if body.ell > 0 else "ball"
    return "balls" if body.ell > 0 and abs(body.theta_end - np.pi / 2) < 1e-9 else "ball"


@kind.register
def _(stone: Ellipsoid) -> Kind:
    return "stone"


def landing(body: Body) -> float:
    """The inclination at which something other than the lower rim lands."""
    if not np.isnan(body.theta_end):
        return float(body.theta_end)
    return np.pi / 2 if body.ell > 0 and kind(body) != "ball" else np.pi


def steepest(body: Body) -> float:
    """The largest inclination of steady states: that of landing, but at most pi/2 with a sharp rim."""
    return min(landing(body), np.pi / 2) if body.fillet == 0 else landing(body)


@singledispatch
def reach(body: Any) -> float:
    """Largest distance of the body's surface from its centre of mass."""
    return max(math.hypot(r, z) for profile in profiles(body) for r, z in profile.corners)


@singledispatch
def size(body: Any) -> float:
    """Radius of the sphere about the centre of a body that a camera has to show."""
    return reach(body) if body._parts or body.rims is not None else math.hypot(1.0, float(body.ell))


for _function in (reach, size):
    _function.register(Ellipsoid, stone_shape.reach_of_stone)


@singledispatch
def tensor(body: Any) -> Floats:
    """(3, 3) tensor of inertia about the centre of mass, along the body's axes."""
    return np.diag([body.i1, body.i1, body.i3]).astype(np.float64)


@tensor.register
def _(stone: Ellipsoid) -> Floats:
    return np.asarray(stone.inertia, np.float64)


class Skin(NamedTuple):
    """The round surface of a body: a wall between two equal fillets."""

    middle: float  #: height of the wall's middle above the centre of mass
    wall: float  #: half the length of the wall
    fillet: float
    rim: float  #: radius of the circles along which the centres of the fillets run
    bore: float

    @property
    def half(self) -> float:
        """Half of the body's length."""
        return self.wall + self.fillet


def skin(body: Body) -> Skin:
    """The surface with which a body is drawn; it is symmetric top to bottom except for balls with a stem.

    A general body is drawn solid, and as long above its centre as below. If it can lean beyond pi/2 although
    its centre is above its rim, an upper end would reach into the table, and only the lower end is drawn.
    """
    ell, fillet = float(body.ell), float(body.fillet)
    lower = kind(body) == "ball" or (fillet > 0 and np.isnan(body.bore) and landing(body) > np.pi / 2 + 1e-9)
    return Skin(-ell if lower else 0.0, 0.0 if lower else ell, fillet, 1.0 - fillet, _drawn_bore(body))


@singledispatch
def profiles(body: Any) -> list[Profile]:
    """The surface of a body without its marks.

    A body of unknown bore is drawn solid, a tube with a wall of at least 0.02 R.
    """
    if body._parts or body.rims is not None:
        return parts_shape.profiles_of_parts(body)
    ell, bore = float(body.ell), _drawn_bore(body)
    if body.fillet > 0:
        return _rounded(body)
    surface = [Profile("wall", IVORY, [(1.0, -ell), (1.0, ell)])] if ell else []
    surface += [
        Profile("faces", SHADE, [(1.0, ell), (bore, ell)]),
        Profile("lower face", SHADE, [(bore, -ell), (1.0, -ell)]),
    ]
    if ell and bore:
        surface.append(Profile("bore", SHADE, [(bore, ell), (bore, -ell)]))
    return surface


profiles.register(Ellipsoid, stone_shape.profiles_of_stone)


def _rounded(body: Body) -> list[Profile]:
    """The surface of a body with a fillet."""
    middle, wall, fillet, rim, bore = skin(body)
    if kind(body) == "ball":
        return _ball(body)
    if kind(body) == "balls":
        # each ball ends in a point where the rod begins, or where the balls intersect
        end = math.acos(_ROD) if wall > 1 else math.asin(min(1.0, wall))
        lower = arc((0.0, -wall), 1.0, -np.pi / 2, end, 2 * _QUARTER)
        upper = [[(x, -z) for x, z in reversed(pairs)] for pairs in lower]
        balls = [Profile("lower ball", IVORY, *lower), Profile("upper ball", IVORY, upper[0], upper[1])]
        rod = [lower[0][-1], upper[0][0]]
        return [balls[0], Profile("rod", SHADE, rod), balls[1]] if wall > 1 else balls
    below = arc((rim, middle - wall), fillet, -np.pi / 2, 0.0, _QUARTER)
    above = arc((rim, middle + wall), fillet, 0.0, np.pi / 2, _QUARTER)
    joint = 0 if wall else 1  # without a wall the two fillets share a corner
    corners, normals = (a + b[joint:] for a, b in zip(below, above, strict=True))
    surface = [Profile("wall", IVORY, corners, normals)]
    (_, low), (_, high) = surface[0].corners[0], surface[0].corners[-1]
    if rim - bore > 1e-6:
        surface += [
            Profile("faces", SHADE, [(rim, high), (bore, high)]),
            Profile("lower face", SHADE, [(bore, low), (rim, low)]),
        ]
    if bore:
        surface.append(Profile("bore", SHADE, [(bore, high), (bore, low)]))
    return surface


def _ball(body: Body) -> list[Profile]:
    """A ball, and the part on which it lands: a stem with a round end, or a plate if the stem is too long.

    A stem that would not reach out of the ball, for landings beyond 149 degrees, is left out.
    """
    middle, land = skin(body).middle, landing(body)
    c, s = math.cos(land), math.sin(land)
    far = (1 - _STEM) / max(-c, 1e-9)  # from the centre of the ball to that of the stem's round end
    root = (_STEM, middle + math.sin(math.acos(_STEM)))
    if middle + far <= root[1]:
        whole = arc((0.0, middle), 1.0, -np.pi / 2, np.pi / 2, 2 * _QUARTER)
        return [Profile("ball", IVORY, *whole)]
    corners, normals = arc((0.0, middle), 1.0, -np.pi / 2, math.acos(_STEM), 2 * _QUARTER)
    ball = Profile("ball", IVORY, [*corners[:-1], root], normals)
    if far <= _LONGEST:
        corners, normals = arc((0.0, middle + far), _STEM, 0.0, np.pi / 2, _QUARTER)
        return [ball, Profile("stem", SHADE, [root, *corners], [(1.0, 0.0), *normals])]
    near, distant = 1.4, 1.5
    wide = (1 + (near if c >= 0 else distant) * c) / s
    plate = [(_STEM, near), (wide, near), (wide, distant), (0.0, distant)]
    return [ball, Profile("stem", SHADE, [root, *((r, middle + z) for r, z in plate)])]


def marks(body: Body | Ellipsoid, upper: Letter = "O") -> list[Part]:
    """The two marks of a body; `upper` is the symbol on the upper end, or a stone's first colour."""
    one_of("upper", upper, ("O", "X"))
    found: list[Part] = _marks(body, upper)
    return found


@singledispatch
def _marks(body: Any, upper: Letter) -> list[Part]:
    if body._parts or body.rims is not None:
        return parts_shape.marks_of_parts(body, upper)
    lower: Letter = "X" if upper == "O" else "O"
    return [_mark(body, upper, 1), _mark(body, lower, -1)]


_marks.register(Ellipsoid, stone_shape.marks_of_stone)


def parts(body: Body | Ellipsoid, upper: Letter = "O") -> list[Part]:
    """The surface of a body and its two marks, in parts of one colour each."""
    return [*map(lathe, profiles(body)), *marks(body, upper)]


def _drawn_bore(body: Body) -> float:
    bore = min(float(body.bore), 0.98)
    return bore if bore > 0 else 0.0


def _mark(body: Body, letter: Letter, end: int) -> Part:
    """A letter near the rim of the upper (end = 1) or lower (-1) end: on the wall or on a disk's face.

    On the wall it continues round the fillet to a latitude of about 45 degrees; on two balls its middle is on
    the equator, where O and X are at pi/2. Its strokes have the same width on curved surfaces as on the wall.
    """
    middle, wall, fillet, rim, bore = skin(body)
    bend = fillet * np.pi / 4
    high, wide = min(1.0, 0.8 * (wall + bend)), min(0.6, 0.85 * (rim - bore))
    on_wall = wall + bend >= _DISK or high > wide
    size = high if on_wall else wide
    pieces = []
    for u, v in _glyph(letter, 4 if fillet else 1):
        u, v = size * u, size * v
        if on_wall:
            # distance from the middle along the profile, and the straight part of it
            along = max(wall - 0.56 * size + min(0.56 * size, bend), 0.56 * size) + v
            straight = np.full(v.shape, wall) if kind(body) == "balls" else np.minimum(along, wall)
            angle = (along - straight) / fillet if fillet else np.zeros(v.shape)
            out, up = np.cos(angle), end * np.sin(angle) + 0.0
            radius = rim + fillet * out
            azimuth = u / radius
            ray = np.stack([np.cos(azimuth), np.sin(azimuth)], -1)
            direction = np.concatenate([out[..., np.newaxis] * ray, up[..., np.newaxis]], -1)
            height = middle + end * straight + (fillet + _LIFT) * up
            place = np.concatenate(
                [(radius + _LIFT * out)[..., np.newaxis] * ray, height[..., np.newaxis]], -1
            )
        else:
            across = rim - 0.56 * size
            place = np.stack([across + v, u, np.full(u.shape, middle + end * (wall + fillet + _LIFT))], -1)
            direction = np.broadcast_to([0.0, 0.0, float(end)], place.shape)
        # seen from outside, the letters on the two ends run in opposite senses
        turned = (end > 0) == on_wall
        # without a fillet, normals are not reversed: the page of a sharp body stays the same to the last
        # digit
        pieces.append(
            strip(place[::-1] if turned else place, direction[::-1] if turned and fillet else direction)
        )
    return joined(letter, BLUE if letter == "O" else ORANGE, pieces)


def _glyph(letter: Letter, strips: int) -> list[tuple[Floats, Floats]]:
    """Rows of points (strips + 1, n) that cover a letter of height 1 once: coordinates across and along."""
    stroke = 0.2
    if letter == "O":
        angle = np.linspace(0, 2 * np.pi, 49)
        radius = np.linspace(0.5 - stroke, 0.5, strips + 1)[:, np.newaxis]
        return [(radius * np.cos(angle), radius * np.sin(angle))]
    # a bar, and two halves of the other bar that leave out the crossing
    half, side = 0.5 * np.sqrt(2) - 0.5 * stroke, np.linspace(0.5, -0.5, strips + 1)[:, np.newaxis] * stroke
    bars = []
    for turn, start, stop in ((1, -half, half), (-1, 0.5 * stroke, half), (-1, -half, -0.5 * stroke)):
        along = np.linspace(start, stop, 9 + 4 * strips)
        bars.append(((along - turn * side) / np.sqrt(2), (turn * along + side) / np.sqrt(2)))
    return bars
