"""Writes rims.json: motions of bodies that touch with several circles, the reference of their tests.

    python tests/reference/rims.py [name ...]       those whose names begin so; or all

It needs gmpy2, and fifteen minutes for all of them on one core.

Every motion is made from two formulations, `vectors` and `reduced` of lying_forms.py, whose one circle is that
of slip_forms.py, as the bodies with two equal rims of lying.py are; they share the laws, the series of
series.py and the order of the phases. Where a border is, too, is found twice: from the heights of both circles
and in closed form. Landings have no restitution.

A body is a row of circles (radius, distance below the centre of mass along the axis, fillet), in the order in
which they carry as theta grows from 0 to pi. theta, w1, w2, w3, phi and psi are told from the body, whichever
circle carries. A row is a checkpoint: what is there, the time, the state (theta, w1, w2, w3), the slip along
the lean and across of the circle from which it is told, and of the other one while two are down, the heat of
the slip and the landings, the work of the losses, (phi, psi, x, y), which start at 0, and the numbers of both
circles, `other` -1 if one is down; x and y are of the place where the told one touches. What is there, beside
the words of lying.py:

    round     both stick: it rolls round its apex, or straight if the radii are equal
    holds turn, holds spin      dry friction holds w.z or w.h, that it has stopped
    joint     one circle passes on to the next without a border

Inputs are exact doubles; results are decimal, to 25 digits. `agreement` is the largest difference of both
formulations in all numbers of a motion, over 1 or the number if that is more.
"""

import math
import pathlib
from itertools import pairwise

from borders import Border
from gmpy2 import mpfr
from lying import DIGITS, NAMES, made
from lying_forms import LAWS
from series import precise
from tables import renew_json
from torus import tube

HERE = pathlib.Path(__file__).parent


def solid(points):
    """Circles and moments of a uniform solid whose generator goes straight through points (radius, height)."""
    m = height = i3 = i1 = 0.0
    node = math.sqrt(0.6) / 2
    for (r, z), (r1, z1) in pairwise(points):
        for at, weight in ((0.5 - node, 5 / 18), (0.5, 8 / 18), (0.5 + node, 5 / 18)):
            q, h, part = r + (r1 - r) * at, z + (z1 - z) * at, weight * (z1 - z)
            m, height = m + part * q**2, height + part * q**2 * h
            i3, i1 = i3 + part * q**4 / 2, i1 + part * (q**4 / 4 + q**2 * h**2)
    middle = height / m
    return [(r, middle - z, 0.0) for r, z in points], i1 / m - middle**2, i3 / m


class Scene:
    """A body (circles, I1, I3), its contact and losses, what is down, a start and times.

    The start is theta, w1, w2, w3, u_h, u_2, told from a circle; with another one it lies at their border, where
    theta is the number next to it. `apex` is the rate along the lean of what rolls round its apex from the start:
    then w1 and w3 are the numbers next to it, too.
    """

    rolls, rates = "round", ("turn", "spin")

    def __init__(
        self, name, body, mu, down, start, end, law="coulomb", static=None, losses=None, samples=4, **more
    ):
        self.name, self.law, self.losses = name, law, losses or {}
        circles, i1, i3 = body
        self.circles = [tuple(float(x) for x in row) for row in circles]
        self.circle, self.other = (*down, None)[:2]
        self.lies, self.apex = self.other is not None, more.get("apex")
        _, depth, fillet = self.circles[self.circle]
        self.body = [depth, float(i1), float(i3), fillet]
        self.mu = float(mu)
        self.static = self.mu if static is None else float(static)
        self.start = [float(x) for x in start]
        self.end, self.brief = float(end), more.get("brief", 0.0)
        self.samples = sorted({float(end * k / samples) for k in range(1, samples + 1)})
        self.smooth = law == "viscous" or self.mu == 0

    def shown(self, model, row):
        """With the circles, and none as -1."""
        return [*row, mpfr(model.k), mpfr(-1 if model.o is None else model.o)]

    def told(self):
        """The body and where it is down, for the table."""
        down = [self.circle, -1 if self.other is None else self.other]
        return {"circles": self.circles, "moments": self.body[1:3], "down": down, "apex": self.apex}


def lying(name, body, mu, down, rates, slip, end, **more):
    """A body on two circles with w1 and w3, and a slip of the told one."""
    s, c = border_of(body, down)
    return Scene(name, body, mu, down, (math.atan2(s, c), rates[0], 0, rates[1], *slip), end, **more)


def rolling(name, body, mu, down, w, end, **more):
    """A body on two circles that do not slip."""
    s, c = border_of(body, down)
    return Scene(name, body, mu, down, (math.atan2(s, c), c * w, 0, -s * w, 0, 0), end, apex=w, **more)


def border_of(body, down):
    border = Border([tuple(map(mpfr, row)) for row in body[0]], min(down))
    return float(border.s), float(border.c)


def scenes():
    cup, cone, short = solid([(0.7, 0), (1, 2)]), solid([(0, 0), (1, 2)]), solid([(0.9, 0), (1, 0.5)])
    bottle = solid([(1, 0), (1, 0.4), (0.5, 3)])
    balls = ([(0, 0.609375, 1), (0, -1.190625, 0.8)], 1.0768616780, 0.3512380952)
    hemisphere = ([(0, -0.375, 1), (1, -0.375, 0)], 83 / 320, 0.4)
    rounded = ([(0.6, 1, 0.2), (0.9, -0.8, 0.1)], 0.5, 0.38)
    reversed_cup = ([(a, -depth, rho) for a, depth, rho in cup[0][::-1]], *cup[1:])
    long = tube(2.5, 0.0)
    equal = ([(1, 2.5, 0), (1, -2.5, 0)], *long[1:3])

    slides, either = (0.3, -0.5), (0, 1)
    yield rolling("cup rolls round its apex", cup, 0.5, either, 1.5, 12)
    yield lying("cup flicked on its side", cup, 0.3, either, (0.8, 0.6), slides, 10)
    back = (-0.3, 0.5)
    yield lying("cup told from its other end", reversed_cup, 0.3, (1, 0), (0.8, -0.6), back, 10)
    yield lying("cup whose narrow end rises", cup, 0.3, either, (1.2, -1.75), (0.2, -2), 3)
    yield rolling("cup that rolls too fast", cup, 1.5, either, 2.8, 1.5)
    yield Scene("cone let go from its rim", cone, 0.5, (1,), (1.7, 0.2, 0, 0.3, 0, 0), 6)
    yield rolling("cone slides off its circle", cone, 0.3, either, 1.22, 5)
    yield Scene("short frustum rocks to rest", short, 0.9, (0,), (1.36, 0, 0, 0, 0, 0), 7, brief=0.02)
    yield Scene("unequal balls spin and lie", balls, 0.3, (0,), (1.3, 0.5, 0, 0.4, 0.2, -0.3), 6, brief=0.02)
    yield lying("rounded frustum pivots", rounded, 0.3, (1, 0), (0.3, 0.25), (0.02, 0.1), 4)
    held = {"rolling": 0.03, "drilling": 0.02}
    yield lying(
        "rolling resistance and drilling stop a cup", cup, 0.3, either, (0.6, 1), (0.1, 0.4), 60, losses=held
    )
    yield rolling(
        "cup rests by rolling resistance in air",
        cup,
        0.5,
        either,
        1.5,
        90,
        losses={"rolling": 0.02, "air": 0.03},
    )
    yield rolling(
        "cup rolls round under viscous contour and quadratic air",
        cup,
        0.5,
        either,
        1.5,
        20,
        losses={"viscous": 0.03, "air2": 0.02},
    )
    yield lying(
        "dry contour and air on a frustum that slides",
        rounded,
        0.2,
        either,
        (0.4, 0.6),
        (0.8, -0.5),
        12,
        losses={"dry": 0.02, "air": 0.05},
    )
    yield Scene("frustum falls on a smooth table", cup, 0, (0,), (1.1, 0.6, 0, 0.4, 0.3, -0.2), 4)
    yield lying("frustum on a film", cup, 0.4, either, (0.5, 0.6), (0.8, -0.5), 8, law="viscous")
    yield lying("cup pivots by static friction", cup, 0.3, (1, 0), (0.3, 0.25), (0, 0), 4, static=0.45)
    yield Scene("bottle goes over its shoulder", bottle, 0.4, (0,), (1.3, 0.2, 0, 0.3, 0, 0), 6)
    yield Scene("hemisphere passes to its edge and back", hemisphere, 1, (0,), (0.8, 0.3, -1.5, 1, 0, 0), 4)
    yield Scene("cylinder falls and lies", equal, 0.3, (0,), (1.3, 0.3, 0.1, 0.2, 0.2, -0.3), 6, samples=5)


def main():
    precise(DIGITS)
    columns = ["kind", *NAMES, "circle", "other"]
    renew_json(HERE / "rims.json", scenes(), made, "motions", columns=columns, laws=LAWS)


if __name__ == "__main__":
    main()
