"""Writes stone_hops.json: stones that are dropped, fly, strike and bounce, slip, roll and lift off.

    python tests/reference/stone_hops.py [name ...]     those whose names begin so; or all

It needs gmpy2, and minutes for all of them on one core.

Every motion is made from two formulations, `table` and `body` of stone_hop_forms.py, whose contact is that of
stone_forms.py. The order of the phases is that of flights.py and phases.py.

A row is a checkpoint: what is there, the time, the vertical and the angular velocity in the axes of the body, the
velocity of the lowest material point along x, y and z of the laboratory, its height, the heat of the slip, the energy
lost in impacts, the quaternion (scalar first) that turns body into laboratory, and the place below the lowest point;
the centre of mass begins above the origin, and stone_forms.py says how the body is turned there. What is there:

    sample    nothing                            slides   the contact begins in slip
    lift-off  the contact has no normal force    rolls    slip ends in rolling, or the contact begins so
    lands     the stone is down: before it       slips    |F| = mu N in rolling
    impact    the same, after it                 passes   slip goes through 0 and on, in another direction
    rests     infinitely many bounces are over   end      the last time

`impacts` has the time of every impact down to bounces of 1e-7, with what the contact does there (slips, sticks,
slips on, smooth), the impulses along x, y and z of the laboratory, and the energy lost. Only the first few have rows,
and only these have their impulses. Infinitely many bounces are followed as in flights.py.

Inputs are exact doubles; M = g = 1, the largest semi-axis is 1, n of a start is divided by its length. Results are
decimal, to 25 digits. `agreement` is the largest difference of both formulations in all numbers of a motion, over 1 or
the number if that is more; `strayed` how far at most n.n, the height in contact and the energy have strayed.
"""

import math
import pathlib

import stones
from flights import SLOWEST, follow
from gmpy2 import mpfr
from series import precise
from stone_hop_forms import Body, Table
from stones import EGG, ODD, SMALL, stone
from tables import compared, decimal, followed, renew_json

HERE = pathlib.Path(__file__).parent
DIGITS = 50
COLUMNS = [
    *("kind", "t", "n1", "n2", "n3", "w1", "w2", "w3", "ux", "uy", "uz", "height", "heat", "lost"),
    *("q0", "q1", "q2", "q3", "x", "y"),
]
TOLD = ["t", "kind", "px", "py", "pz", "lost"]
LIFT = COLUMNS.index("uz") - 2
SLOWEST |= {"Table": mpfr("1e-16"), "Body": mpfr("1e-18")}


class Scene(stones.Scene):
    """A stone, a law of contact, a restitution, a start and times.

    `height` is None where it begins in contact. `rows` is how many impacts of each sequence have rows.
    """

    def __init__(self, name, stone, law, e, n, w, end, height=None, lift=0.0, rows=2, samples=5, **more):
        super().__init__(name, stone, law, n, w, end, samples=samples, **more)
        self.restitution, self.rows, self.aloft = float(e), rows, height is not None
        self.height, self.lift = float(height or 0), float(lift)

    def inputs(self):
        names = ("name", "law", "axes", "inertia", "offset", "mu", "restitution", "n", "w", "u")
        static = self.static if math.isfinite(self.static) else None
        aloft = [self.height, self.lift] if self.aloft else None
        return {name: getattr(self, name) for name in names} | {"static": static, "aloft": aloft}


SKEW = stone((1, 0.8, 0.6), (0.2, 0.3, 0.35), (0.01, 0.02, -0.015), (0.03, -0.02, -0.1))
BALL = stone((1, 1, 1), (0.4, 0.4, 0.4))


def leaning(pitch, roll):
    """The vertical of a stone that is turned about axis 2, then about axis 1."""
    return (-math.sin(pitch), math.cos(pitch) * math.sin(roll), math.cos(pitch) * math.cos(roll))


def scenes():
    lean = (0.36, 0.48, 0.8)
    pushed = {"height": 0.4, "lift": 0.2, "u": (0.5, -0.3)}
    # fmt: off
    yield Scene("skew stone slips through", SKEW, "coulomb", 0.6, lean, (0.4, -0.3, 0.5), 4, mu=0.2, **pushed)
    yield Scene("skew stone sticks", SKEW, "coulomb", 0.6, lean, (0.4, -0.3, 0.5), 3, mu=0.6, **pushed)
    yield Scene("rattleback dropped", SMALL, "coulomb", 0.3, leaning(0.15, 0.1), (0, 0, 0), 1.5, 0.1, mu=0.4, rows=4)
    yield Scene("egg dropped tilted", EGG, "coulomb", 0.4, (0, 0.71735609, 0.69670671), (0.4, 0.3, 0.9), 3, 0.5, mu=0.3, u=(0.5, 0.2))
    yield Scene("odd stone without restitution", ODD, "coulomb", 0, (0.3, -0.2, 0.9), (0.8, 0.4, -0.6), 3, 0.3, mu=0.3, u=(0.3, -0.2))
    yield Scene("odd stone bounces on a smooth table", ODD, "smooth", 1, (0.3, -0.2, 0.9), (0.8, 0.4, -0.6), 4, 0.3, u=(0.3, -0.2), rows=3)
    yield Scene("skew stone lands on a rolling table", SKEW, "rolling", 0.5, lean, (0.3, -0.2, 0.4), 2, 0.3, u=(0.1, 0.05))
    yield Scene("odd stone leaps as it slips", ODD, "coulomb", 0.5, (0.3, -0.2, 0.9), (4, 1.5, 0.5), 2.4, mu=0.3, u=(0.5, 0.5))
    yield Scene("odd stone leaps as it rolls", ODD, "rolling", 0.3, (0.449, 0.141, -0.882), (2.848, 0.762, -0.223), 2)
    yield Scene("skew stone thrown with a large spin", SKEW, "coulomb", 0.5, (0.2, 0.1, 1), (1, 2, 12), 3, 0.2, lift=0.3, mu=0.3, u=(1, 0.4))
    yield Scene("rattleback with static friction", SMALL, "coulomb", 0.3, leaning(0.15, 0.1), (0.3, 0.2, -0.6), 1, 0.1, mu=0.3, static=0.6)
    yield Scene("skew stone on a viscous film", SKEW, "viscous", 0.3, lean, (0.4, -0.3, 0.5), 2, mu=0.5, **pushed)
    yield Scene("ball with spin", BALL, "coulomb", 0.8, (0, 0, 1), (0, -6, 1), 12, 0.5, lift=0.5, mu=0.25, u=(-2, 0.5))
    yield Scene("rattleback hops and rocks", SMALL, "coulomb", 0.5, (0.05, 0.1, 0.99), (0.5, 0, -0.3), 1, 0, lift=0.2, mu=0.2)
    # fmt: on


def made(scene):
    one, other = followed(scene, (Table, Body), lambda model: follow(model, lift=LIFT))
    agreement = max(compared(one, other))
    assert len(one.impacts) == len(other.impacts)
    for a, b in zip(one.impacts, other.impacts, strict=True):
        assert a[2] == b[2], (a, b)
        pairs = zip([a[0], *a[3:]], [b[0], *b[3:]], strict=True)
        agreement = max(agreement, *(abs(x - y) / max(1, abs(y)) for x, y in pairs))
    kinds = [f"{kind} {float(t):.4f}" for t, _, kind, *_ in other.impacts[:6]]
    print(
        f"    {', '.join(kinds)} of {len(other.impacts)}; with the impacts {float(agreement):.1e}", flush=True
    )
    strayed = max(one.strayed, other.strayed)
    told = [
        [decimal(t, 1e-30), kind, *(decimal(x, 1e-30) for x in more)] for t, _, kind, *more in other.impacts
    ]
    return scene.inputs() | {
        "agreement": float(f"{float(agreement):.1e}"),
        "strayed": float(f"{float(strayed):.1e}"),
        "rows": [[kind, *(decimal(x, 1e-30) for x in row)] for kind, row in other.rows],
        "impacts": told,
    }


def main():
    precise(DIGITS)
    renew_json(HERE / "stone_hops.json", scenes(), made, "motions", columns=COLUMNS, told=TOLD)


if __name__ == "__main__":
    main()
