"""What a body looks like: triangles of its surface and of the two marks, O and X, in units of R.

The body's axes are those of `Motion.orientation`: the origin is the centre of mass, the third axis is
that of symmetry, and at the start the first points to the top of the rim. The upper end is at
z = ell + fillet. One geometry serves the page, the photograph, the glTF file and the scene for engines; the
page turns the profiles on a lathe of its own, so that sides cost no bytes.

A quarter of a fillet is drawn with 32 flat pieces whose corners lie on it, and with the normals of the
circle: the profile lies inside the true one by (1 - cos(pi/128)) fillet = 3.0e-4 fillet at most, and with 128
sides the surface by another 3.0e-4 of its radius.
"""

import math
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from spincyl._array import Floats, one_of
from spincyl._body import Body

Letter = Literal["O", "X"]
#: "cylinder": a cylinder or a tube, of sharp or rounded edges. "balls": two, one on the other. "ball": one.
Kind = Literal["cylinder", "capsule", "balls", "ball"]

#: Below this aspect ratio the marks are on the faces, since the wall has no room for them.
_DISK = 0.4
_AROUND = 128
_QUARTER = 32  # pieces of a quarter of a circle
_ROD = 0.06  # radius of what holds two balls together
_STEM, _LONGEST = 0.15, 2.5  # radius of the stem of a ball, and how far its end may be from the ball's centre
_LIFT = 0.006  # of the marks above the surface
IVORY, SHADE, BLUE, ORANGE = (0.87, 0.85, 0.80), (0.72, 0.70, 0.66), (0.0, 0.36, 0.65), (0.80, 0.30, 0.0)


class Profile(NamedTuple):
    """A piece of surface in one colour, as the polygon that sweeps it round the axis."""

    name: str
    colour: tuple[float, float, float]
    corners: list[tuple[float, float]]  #: radius and height; outside is on the right of its direction
    normals: list[tuple[float, float]] | None = None  #: the same of the normals; None: those of flat pieces


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
    if profile.normals is not None:
        ring, normal = (
            np.stack([np.column_stack([r * circle, np.full(angle.shape, z)]) for r, z in pairs])
            for pairs in (profile.corners, profile.normals)
        )
        return _joined(profile.name, profile.colour, [_strip(ring, normal)])
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


def kind(body: Body) -> Kind:
    """What a body is drawn as; what is not known of a general body is guessed from where it lands."""
    if body.fillet < 1:
        return "cylinder"
    if not np.isnan(body.bore):
        return "capsule" if body.ell > 0 else "ball"
    return "balls" if body.ell > 0 and abs(body.theta_end - np.pi / 2) < 1e-9 else "ball"


def landing(body: Body) -> float:
    """The inclination at which something else than its lower rim lands."""
    if not np.isnan(body.theta_end):
        return float(body.theta_end)
    return np.pi / 2 if body.ell > 0 and kind(body) != "ball" else np.pi


def reach(body: Body) -> float:
    """How far the body's surface reaches from its centre of mass."""
    return max(math.hypot(r, z) for profile in profiles(body) for r, z in profile.corners)


class Skin(NamedTuple):
    """The round surface of a body: a wall between two fillets, alike above and below its middle."""

    middle: float  #: height of its middle above the centre of mass
    wall: float  #: half its length
    fillet: float
    rim: float  #: radius of the circles round which the fillets run
    bore: float

    @property
    def half(self) -> float:
        """Half of the body's length."""
        return self.wall + self.fillet


def skin(body: Body) -> Skin:
    """The surface of a body that is symmetric top to bottom, as are all but balls with a stem.

    A general body is drawn as long above its centre as below, and solid; where it goes on beyond pi/2
    although its centre is above its rim, the other side must be out of the way, and its lower end alone is
    drawn.
    """
    ell, fillet = float(body.ell), float(body.fillet)
    lower = kind(body) == "ball" or (fillet > 0 and np.isnan(body.bore) and landing(body) > np.pi / 2 + 1e-9)
    return Skin(-ell if lower else 0.0, 0.0 if lower else ell, fillet, 1.0 - fillet, _bore(body))


def profiles(body: Body) -> list[Profile]:
    """The surface of a body but for its marks.

    A body of unknown bore is drawn solid, a tube at least 0.02 R thick.
    """
    ell, bore = float(body.ell), _bore(body)
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


def _rounded(body: Body) -> list[Profile]:
    """The surface of a body with a fillet."""
    middle, wall, fillet, rim, bore = skin(body)
    if kind(body) == "ball":
        return _ball(body)
    if kind(body) == "balls":
        # one ends where the rod begins, in a point, or where they cut each other
        end = math.acos(_ROD) if wall > 1 else math.asin(min(1.0, wall))
        lower = _arc((0.0, -wall), 1.0, -np.pi / 2, end, 2 * _QUARTER)
        upper = [[(x, -z) for x, z in reversed(pairs)] for pairs in lower]
        balls = [Profile("lower ball", IVORY, *lower), Profile("upper ball", IVORY, *upper)]
        rod = [lower[0][-1], upper[0][0]]
        return [balls[0], Profile("rod", SHADE, rod), balls[1]] if wall > 1 else balls
    below = _arc((rim, middle - wall), fillet, -np.pi / 2, 0.0, _QUARTER)
    above = _arc((rim, middle + wall), fillet, 0.0, np.pi / 2, _QUARTER)
    joint = 0 if wall else 1  # without a wall they have a corner in common
    surface = [Profile("wall", IVORY, *(a + b[joint:] for a, b in zip(below, above, strict=True)))]
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
    """One ball, and what lands where the body does: a stem with a round end, or a plate if that is too long.

    A stem that would not reach out of the ball, where the body lands beyond 149 degrees, is left out.
    """
    middle, land = skin(body).middle, landing(body)
    c, s = math.cos(land), math.sin(land)
    far = (1 - _STEM) / max(-c, 1e-9)  # from the centre of the ball to that of the stem's end
    root = (_STEM, middle + math.sin(math.acos(_STEM)))
    if middle + far <= root[1]:
        whole = _arc((0.0, middle), 1.0, -np.pi / 2, np.pi / 2, 2 * _QUARTER)
        return [Profile("ball", IVORY, *whole)]
    corners, normals = _arc((0.0, middle), 1.0, -np.pi / 2, math.acos(_STEM), 2 * _QUARTER)
    ball = Profile("ball", IVORY, [*corners[:-1], root], normals)
    if far <= _LONGEST:
        corners, normals = _arc((0.0, middle + far), _STEM, 0.0, np.pi / 2, _QUARTER)
        return [ball, Profile("stem", SHADE, [root, *corners], [(1.0, 0.0), *normals])]
    near, distant = 1.4, 1.5
    wide = (1 + (near if c >= 0 else distant) * c) / s
    plate = [(_STEM, near), (wide, near), (wide, distant), (0.0, distant)]
    return [ball, Profile("stem", SHADE, [root, *((r, middle + z) for r, z in plate)])]


def _arc(
    centre: tuple[float, float], radius: float, start: float, stop: float, pieces: int
) -> tuple[list[tuple[float, float]], list[tuple[float, float]]]:
    """Corners on a circle and their normals, from one latitude to another."""
    angle = np.linspace(start, stop, pieces + 1)
    across, up = np.cos(angle), np.sin(angle)
    across[np.abs(angle) > np.pi / 2 - 1e-12] = 0.0  # a pole is a point
    up[angle == 0] = 0.0
    normals = list(zip(across.tolist(), up.tolist(), strict=True))
    return [(centre[0] + radius * x, centre[1] + radius * z) for x, z in normals], normals


def marks(body: Body, upper: Letter = "O") -> list[Part]:
    """The two marks; `upper` is the letter on the upper end."""
    one_of("upper", upper, ("O", "X"))
    lower: Letter = "X" if upper == "O" else "O"
    return [_mark(body, upper, 1), _mark(body, lower, -1)]


def parts(body: Body, upper: Letter = "O") -> list[Part]:
    """The surface of a body, its marks last."""
    return [*map(lathe, profiles(body)), *marks(body, upper)]


def _bore(body: Body) -> float:
    bore = min(float(body.bore), 0.98)
    return bore if bore > 0 else 0.0


def _mark(body: Body, letter: Letter, end: int) -> Part:
    """A letter near the rim of the upper (end = 1) or lower (-1) end: on the wall, or a disk's face.

    On the wall it goes round the fillet, to the latitude of 45 degrees or so: on two balls its middle is on
    the equator, where O and X are at pi/2. Its strokes are as wide along a curved surface as on the wall.
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
            # how far from the middle along the profile, and how much of that is straight
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
        # seen from outside, the letters of the two ends run in opposite senses
        turned = (end > 0) == on_wall
        # the page of a sharp body is kept as it is, to the last digit of a normal
        pieces.append(
            _strip(place[::-1] if turned else place, direction[::-1] if turned and fillet else direction)
        )
    return _joined(letter, BLUE if letter == "O" else ORANGE, pieces)


def _glyph(letter: Letter, strips: int) -> list[tuple[Floats, Floats]]:
    """Rows of points (strips + 1, n) that cover a letter of height 1 once: across and along."""
    stroke = 0.2
    if letter == "O":
        angle = np.linspace(0, 2 * np.pi, 49)
        radius = np.linspace(0.5 - stroke, 0.5, strips + 1)[:, np.newaxis]
        return [(radius * np.cos(angle), radius * np.sin(angle))]
    # a bar and two halves that leave the crossing to it
    half, side = 0.5 * np.sqrt(2) - 0.5 * stroke, np.linspace(0.5, -0.5, strips + 1)[:, np.newaxis] * stroke
    bars = []
    for turn, start, stop in ((1, -half, half), (-1, 0.5 * stroke, half), (-1, -half, -0.5 * stroke)):
        along = np.linspace(start, stop, 9 + 4 * strips)
        bars.append(((along - turn * side) / np.sqrt(2), (turn * along + side) / np.sqrt(2)))
    return bars


def _strip(rows: Floats, normals: Floats) -> tuple[Floats, Floats, np.ndarray]:
    """Vertices, normals and triangles between rows of n points each, from below."""
    n = rows.shape[1]
    triangles = np.concatenate(
        [
            np.concatenate([np.stack([i, i + 1, i + n], -1), np.stack([i + 1, i + n + 1, i + n], -1)])
            for i in (k * n + np.arange(n - 1) for k in range(len(rows) - 1))
        ]
    )
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
