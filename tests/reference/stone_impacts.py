"""Writes stone_impacts.csv: single impacts of stones at one point, with any 3 x 3 inverse inertia.

    python tests/reference/stone_impacts.py

It needs gmpy2, and a minute. Every impact is made in the two ways of point_impacts.py, by components and by
directions, which says the laws. A row has

    name, law                  coulomb, viscous (mu is c), smooth or rolling
    e, mu, static              restitution; coefficient of sliding and of static friction, inf on a rolling table
    m11 m12 m22 m13 m23 m33    the velocity of the point that an impulse gives, along two horizontal axes and upwards
    u1 u2 u3                   its velocity before the impact
    kind                       slips, sticks, slips on, smooth
    times                      how often the point is pressed in: 2 where the normal velocity falls below 0 once more
    p1 p2 p3, v1 v2 v3         the impulse, and the velocity after the impact
    lost                       the energy lost
    agreement                  the largest difference of both ways, over 1 or the number if that is more

Inputs are exact doubles, written as hexadecimal; results are decimal, to 25 digits. The matrix is that of a stone in
some pose, rounded to doubles.
"""

import math
import pathlib

import gmpy2
from gmpy2 import mpfr
from point_impacts import components, directions
from series import precise
from stone_forms import along, inverse
from stone_hops import BALL, SKEW
from stones import FLAT, SMALL, stone
from tables import decimal
from vectors import cross, dot, scaled

HERE = pathlib.Path(__file__).parent
DIGITS = 50
HEAD = "name,law,e,mu,static,m11,m12,m22,m13,m23,m33,u1,u2,u3,kind,times,p1,p2,p3,v1,v2,v3,lost,agreement"
LIGHT = stone((1, 0.8, 0.6), (0.05, 0.08, 0.09), (0.004, 0.005, -0.004), (0.03, -0.02, -0.1))


def pose(n):
    """The vertical of length 1, and two horizontal axes: the first of (n2, -n1, 0) or of e1."""
    n = [mpfr(x) for x in n]
    n = scaled(1 / gmpy2.sqrt(dot(n, n)), n)
    first = [n[1], -n[0], mpfr(0)] if n[0] or n[1] else [mpfr(1), mpfr(0), mpfr(0)]
    first = scaled(1 / gmpy2.sqrt(dot(first, first)), first)
    return [first, cross(n, first), n]


def arm(stone, n):
    """From the centre of mass to the lowest point."""
    axes, _, offset = stone
    dn = [mpfr(a) ** 2 * x for a, x in zip(axes, n, strict=True)]
    size = gmpy2.sqrt(dot(n, dn))
    return [-x / size - mpfr(d) for x, d in zip(dn, offset, strict=True)]


def answers(stone, n):
    """Of a unit impulse along each axis, and of a unit couple about the vertical: velocities and drilling, in doubles."""
    frame = pose(n)
    r, free = arm(stone, frame[2]), inverse([[mpfr(x) for x in row] for row in stone[1]])
    turns = [*(cross(r, axis) for axis in frame), frame[2]]
    matrix = [
        [dot(along(free, a), b) + (i == j < 3) for j, b in enumerate(turns)] for i, a in enumerate(turns)
    ]
    return [[float(x) for x in row] for row in matrix]


def cases():
    """Name, stone, vertical, velocity, law, restitution, mu and static friction."""
    lean, down = (0.36, 0.48, 0.8), (0.5, -0.3, -1)
    rattle, aside = (0.3, 0.2, 0.9), (0.7, -1.3, -0.5)
    coulomb = "coulomb"
    yield "skew stone slips", SKEW, lean, down, coulomb, 0.6, 0.2
    yield "skew stone sticks", SKEW, lean, down, coulomb, 0.6, 0.6
    yield "skew stone slips without restitution", SKEW, lean, down, coulomb, 0, 0.2
    yield "skew stone sticks without restitution", SKEW, lean, down, coulomb, 0, 0.6
    yield "skew stone slips elastically", SKEW, lean, (3, 1, -0.5), coulomb, 1, 0.3
    yield "skew stone lands without slip and sticks", SKEW, lean, (0, 0, -1), coulomb, 0.5, 0.4
    yield "skew stone lands without slip and slips on", SKEW, lean, (0, 0, -1), coulomb, 0.5, 0.3
    yield (
        "skew stone lands without slip, with static friction",
        SKEW,
        lean,
        (0, 0, -1),
        coulomb,
        0.5,
        0.3,
        0.4,
    )
    yield "skew stone turns round and slips", SKEW, lean, (0.1, 0.05, -1), coulomb, 0.6, 0.3
    yield "rattleback stops and slips on", SMALL, aside, (-0.3, -0.06, -1), coulomb, 0.3, 0.7
    yield (
        "rattleback stops, static friction holds it",
        SMALL,
        aside,
        (-0.3, -0.06, -1),
        coulomb,
        0.3,
        0.7,
        0.8,
    )
    yield "rattleback stops late and slips on", SMALL, (-0.8, 1.1, -0.8), (-1, -0.1, -1), coulomb, 0.9, 0.7
    yield (
        "rattleback stops and slips on without restitution",
        SMALL,
        aside,
        (-0.3, -0.06, -1),
        coulomb,
        0,
        0.7,
    )
    yield "rattleback grazes", SMALL, rattle, (1, -2, -1e-3), coulomb, 0.3, 0.4
    yield "rattleback falls steeply", SMALL, rattle, (1e-3, -2e-3, -5), coulomb, 0.3, 0.4
    yield "flat stone slips across", FLAT, (0.05, -0.03, 1), (0.3, 0.7, -1), coulomb, 0.8, 0.2
    yield "ball slips", BALL, (0.6, 0, 0.8), (0.3, -0.4, -1), coulomb, 0.8, 0.05
    yield "ball grips", BALL, (0.6, 0, 0.8), (0.3, -0.4, -1), coulomb, 0.8, 0.3
    yield (
        "light stone is pressed in by its friction",
        LIGHT,
        (0.49, 0.87, 0.07),
        (-1, 3, -0.2),
        coulomb,
        0.5,
        0.9,
    )
    yield "light stone is pressed in twice", LIGHT, (-0.16, 0.84, 0.52), (7.91, -1.2, -1), coulomb, 0.5, 0.88
    yield (
        "light stone is pressed in twice again",
        LIGHT,
        (-0.43, -0.75, 0.5),
        (7.27, -3.33, -1),
        coulomb,
        0.8,
        1.12,
    )
    yield "flat stone is pressed in twice", FLAT, (0.54, -0.54, 0.65), (2.96, 0.48, -1), coulomb, 0.8, 1.59
    yield "rattleback is pressed in twice", SMALL, (-0.76, 0.25, 0.6), (7.86, 1.5, -1), coulomb, 0.5, 1.62
    yield "skew stone on a viscous film", SKEW, lean, down, "viscous", 0.6, 0.5
    yield "light stone on a viscous film", LIGHT, (-0.43, -0.75, 0.5), (2, -3, -1), "viscous", 0.5, 3
    yield "rattleback on a viscous film without restitution", SMALL, rattle, (0.4, -0.8, -1), "viscous", 0, 1
    yield "skew stone on a smooth table", SKEW, lean, down, "smooth", 0.6, 0
    yield "skew stone on a rolling table", SKEW, lean, down, "rolling", 0.6, 0, math.inf
    yield "rattleback on a rolling table", SMALL, rattle, (0.1, -0.05, -1), "rolling", 0.3, 0, math.inf
    yield (
        "light stone on a rolling table without restitution",
        LIGHT,
        (0.49, 0.87, 0.07),
        down,
        "rolling",
        0,
        0,
        math.inf,
    )


def row(name, stone, n, u, law, e, mu, static=None):
    matrix = [line[:3] for line in answers(stone, n)[:3]]
    static = mu if static is None else static
    exact = [[mpfr(x) for x in line] for line in matrix]
    how = "coulomb" if law == "smooth" else law
    found = [
        way(exact, [mpfr(x) for x in u], mpfr(e), how, mpfr(mu), mpfr(static))
        for way in (components, directions)
    ]
    one, other = ([*x.impulse, *x.after, x.lost] for x in found)
    assert (found[0].kind, found[0].times) == (found[1].kind, found[1].times)
    apart = max(abs(x - y) / max(1, abs(y)) for x, y in zip(one, other, strict=True))
    print(f"{name}: {found[1].kind}, {found[1].times}, {float(apart):.1e}", flush=True)
    inputs = [e, mu, static, *(matrix[i][j] for i, j in ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))), *u]
    given = [float(x).hex() for x in inputs]
    told = [found[1].kind, str(found[1].times), *(decimal(x, 1e-30) for x in other), f"{float(apart):.1e}"]
    return ",".join([name.replace(",", ""), law, *given, *told])


def main():
    precise(DIGITS)
    (HERE / "stone_impacts.csv").write_text("\n".join([HEAD, *(row(*case) for case in cases())]) + "\n")


if __name__ == "__main__":
    main()
