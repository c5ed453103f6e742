"""Writes slip_motion.csv: motions with friction at the rim, from slip to roll and back, the reference of its tests.

    python tests/reference/slip.py [name ...]        those whose names begin so, in the place of their old rows; or all

It needs gmpy2, and fifteen minutes for all of them on one core.

Every motion is made from the two formulations of slip_forms.py, `vectors` in the laboratory and `reduced`, which share
nothing but the series of series.py, the law of friction and the order of the phases, phases.py.

A row is a checkpoint of a motion: a time, what is there, the state, the heat so far, the pose and the contact, which
start at 0. What is there:

    sample    nothing
    rolls     slip ends in rolling; the slip is 0
    passes    slip goes through 0 and on, in another direction
    slips     rolling ends in slip
    lift-off  slip ends with no normal force         (these three end the motion)
    side      the axis is horizontal: the other rim lands
    face      the axis is vertical: the face lands
    end       the last time

Inputs are exact doubles, written as hexadecimal; results are decimal, to 25 digits. `agreement` is the largest
difference of both formulations in the numbers of the row, over 1 or the number if that is more.
"""

import math
import pathlib
from itertools import groupby

from phases import follow
from series import precise
from slip_forms import Reduced, Vectors
from tables import compared, decimal, followed, renew
from torus import tube

HERE = pathlib.Path(__file__).parent
DIGITS = 40

# The scenes.


class Scene:
    """A body (ell, i1, i3, fillet), a law of friction, a start (theta, w1, w2, w3, u_h, u_2) and times."""

    def __init__(self, name, body, mu, start, end, law="coulomb", static=None, samples=8, theta_end=None):
        self.name, self.law, self.theta_end = name, law, theta_end
        self.body = [float(x) for x in body]
        self.mu = float(mu)
        self.static = self.mu if static is None else float(static)
        self.start = [float(x) for x in start]
        self.end = float(end)
        self.samples = sorted({float(end * k / samples) for k in range(1, samples + 1)})
        self.smooth = law == "viscous" or self.mu == 0
        self.side = self.body[0] > 0 and self.body[3] < 1


def moved(body, start, along, across):
    """A start whose centre has this velocity."""
    ell, _, _, rho = body
    theta, w1, w2, w3 = start
    s, c = math.sin(theta), math.cos(theta)
    height = rho + ell * c + (1 - rho) * s
    return theta, w1, w2, w3, along - height * w2, across + (ell + rho * c) * w1 - (1 - rho + rho * s) * w3


HALF_PI = math.pi / 2


def scenes():
    paper = tube(6.0, 0.8)
    hoop, disk = tube(0.0, 1.0), tube(0.05, 0.0)

    def launched(w1, x, v_2=None):
        """Of the paper's tube, at pi/2: launch number x; full reaction of the table if v_2 is not given."""
        w3 = x * 6.0 / (paper[2] * w1)
        return moved(paper, (HALF_PI, w1, 0.0, w3), 0.0, -paper[1] / 6 * w1 if v_2 is None else v_2)

    pencil = tube(10.0, 0.0)
    standing = math.atan2(1.0, 10.0)
    can = tube(0.5, 0.0)
    nutating = (0.6, 1.2, 0.4, 0.3, 0.1, -0.2)
    coin = (0.12, 0.2575, 0.4917, 0.05)
    top = (-0.2, 0.39, 0.40, 1.0)

    yield Scene("hoop that comes back", hoop, 0.3, (HALF_PI, 0, 0, -3, 0, 5), 12)
    yield Scene("disk thrown to its side", disk, 0.2, (1.2, 0.4, 0.1, -1, 0.5, 2), 5)
    yield Scene("disk from slip to roll", tube(0.02, 0.0), 0.8, (0.9, 1.1, -0.2, 0.5, -1, 1.5), 6)
    yield Scene("pencil falls", pencil, 0.25, (standing + 0.02, 0, 0, 0, 0, 0), 30)
    yield Scene(
        "pencil with static friction falls", pencil, 0.25, (standing + 0.02, 0, 0, 0, 0, 0), 30, static=0.3
    )
    yield Scene("pencil turning as it falls", pencil, 0.25, (standing + 0.02, 0.05, 0, 0.1, 0, 0), 30)
    yield Scene("rod dragged back", pencil, 0.35, (0.6, 0, -0.3, 0, 0.4, 0), 4)
    yield Scene("cylinder falls on its face", tube(1.0, 0.0), 0.3, (0.5, 0, 0, 0, 0.2, 0), 4)
    yield Scene("cylinder slides rolls and slides", tube(1.0, 0.0), 0.25, (0.5, 1, 0.3, 0.5, 0.1, -0.2), 4)
    yield Scene(
        "cylinder with static friction", tube(1.0, 0.0), 0.25, (0.5, 1, 0.3, 0.5, 0.1, -0.2), 4, static=0.35
    )
    yield Scene("can that rolls twice", can, 0.3, nutating, 4)
    yield Scene("can that slips again and again", can, 0.25, nutating, 10)
    yield Scene("Euler's disk with slip", coin, 0.2, (0.5, 1.2, 0, 0.3, 0.1, -0.6), 8)
    yield Scene("coin on a smooth table", coin, 0, (0.5, 1.2, 0, 0.3, 0.1, -0.6), 10)
    yield Scene("tube rises and lies down", paper, 0.3, launched(1.5, 1.2), 25)
    yield Scene("tube hops", paper, 0.3, launched(3.0, 3.0), 10)
    yield Scene("tube with its centre at rest", paper, 0.3, launched(3.0, 1.3, 0.0), 25)
    yield Scene("tube flicked at 0.3", paper, 0.3, launched(3.0, 1.3), 50)
    yield Scene("tube flicked at 0.15", paper, 0.15, launched(4.0, 1.1), 90)
    yield Scene("tippe top locks into rolling", top, 0.3, moved(top, (0.3, 0.3, 0.1, 3), 0, 0), 4)
    yield Scene("ball that rolls twice", (0.3, 0.5, 0.4, 1.0), 0.2, (1.2, 1, 0.1, 2, 0.3, 1), 6)
    held, rounded, long = (1.8, 1.34, 0.5, 0.0), (1.45, 0.63, 0.21, 0.69), (4.57, 7.23, 0.52, 0.0)
    yield Scene("cylinder slips at a high mu", held, 1.89, (1.21, -0.64, -0.17, -0.02, 0, 0), 2)
    yield Scene("rounded body slips at last", rounded, 1.43, (0.87, 0.002, -0.15, 0.32, 0, 0), 3)
    yield Scene("tube leaps as it slips", long, 1.01, (1.567, 0, 0.97, 0, 0, 0), 1, static=1.28, samples=128)
    yield Scene("tippe top turns over", top, 0.3, moved(top, (0.2, 0.5, 0, 12), 0, 0), 10, law="viscous")


# The table.

HEAD = (
    "name,law,ell,i1,i3,fillet,mu,static,theta0,w10,w20,w30,u_h0,u_20,"
    "kind,t,theta,w1,w2,w3,u_h,u_2,heat,phi,psi,x,y,agreement"
)


def rows_of(scene):
    inputs = [*scene.body, scene.mu, scene.static, *scene.start]
    begin = ",".join([scene.name, scene.law, *(x.hex() for x in inputs)])
    one, other = followed(scene, (Vectors, Reduced), follow)
    for (kind, row), agreement in zip(other.rows, compared(one, other, angles=(8, 9)), strict=True):
        yield ",".join([begin, kind, *(decimal(x, 1e-35) for x in row), f"{float(agreement):.1e}"])


def main():
    precise(DIGITS)
    path = HERE / "slip_motion.csv"
    lines = path.read_text().splitlines()[1:] if path.exists() else []
    known = {name: list(rows) for name, rows in groupby(lines, lambda line: line.split(",", 1)[0])}
    renew(
        path,
        scenes(),
        lambda scene: list(rows_of(scene)),
        known,
        lambda tables: "\n".join([HEAD, *(line for rows in tables for line in rows)]),
    )


if __name__ == "__main__":
    main()
