"""Writes stones.json, stones_losing.json and stones_steady.csv: ellipsoids of any inertia that roll and slip, the reference of their tests.

    python tests/reference/stones.py [name ...]     motions whose names begin so, and "steady"; or all

It needs gmpy2 and mpmath, and fifteen minutes for all of them on one core.

Every motion is made from the two formulations of stone_forms.py, `table` in the laboratory with multipliers, and `body`.
They share the order of the phases and how slip begins, phases.py. A row is a checkpoint of a motion:

    kind                what is there
    t                   the time
    n1 n2 n3 w1 w2 w3   the vertical and the angular velocity, in the axes of the body
    ux uy               the slip velocity of the body's point that touches, in the laboratory
    heat                that of friction so far
    q0 q1 q2 q3         the quaternion, scalar first, that turns body into laboratory; stone_forms.py says which is first
    x y                 where the stone touches; the centre of mass begins above the origin
    fx fy normal        the contact force, in the laboratory

What is there:

    sample    nothing                                   slips     rolling ends in slip: |friction| = static N
    rolls     slip ends in rolling                      lift-off  no normal force         (these two end the motion)
    passes    slip goes through 0 and on                face      n3 falls to cos(theta_end): the edge lands
    end       the last time

The force of a row is that of rolling where u = 0; where u passes 0 it has no value (null). `static` null is a contact that
rolls whatever it takes, up to N = 0. `mu` of a viscous film is c: the force is c N u against the slip.

The steady table has the eigenvalues of small rocking of a stone that spins upright, n = up e3, w = spin n: the rates
of (w1, w2, n1, n2) of `table` are differenced there, w3 and |n| being kept, at 500 digits. `body` and another
difference are compared with it.

Inputs are exact doubles, hexadecimal in the steady table; results are decimal, to 25 digits, or 60 of what is steady.
`agreement` is the largest difference of both formulations, over 1 or the number if that is more; `strayed` how far at
most the constraints (quadric, height, slip, lengths) and the energy of `table` have strayed in the rows.
"""

import itertools
import math
import pathlib
import sys

import gmpy2
from gmpy2 import mpfr
from mpmath import mp
from phases import follow
from series import precise
from stone_forms import Body, Table
from tables import compared, decimal, followed, renew_json

HERE = pathlib.Path(__file__).parent
DIGITS, STEADY_DIGITS = 40, 500
COLUMNS = [
    *("kind", "t", "n1", "n2", "n3", "w1", "w2", "w3", "ux", "uy", "heat"),
    *("q0", "q1", "q2", "q3", "x", "y", "fx", "fy", "normal"),
]


class Scene:
    """A stone, a law of friction, a start and times."""

    def __init__(
        self,
        name,
        stone,
        law,
        n,
        w,
        end,
        mu=0.0,
        static=None,
        u=(0, 0),
        theta_end=None,
        samples=6,
        g=1.0,
        losses=None,
        held=False,
    ):
        self.name, self.law, self.g, self.theta_end = name, law, float(g), theta_end
        axes, inertia, offset = stone
        self.axes, self.offset = [float(x) for x in axes], [float(x) for x in offset]
        self.inertia = [[float(x) for x in row] for row in inertia]
        self.n, self.w, self.u = ([float(x) for x in v] for v in (n, w, u))
        self.mu, self.smooth = float(mu), law in ("viscous", "smooth")
        self.static = math.inf if law == "rolling" else self.mu if static is None else float(static)
        self.losses, self.held = {name: float(x) for name, x in (losses or {}).items()}, held
        self.sign = 1 if sum(a * b for a, b in zip(self.n, self.w, strict=True)) > 0 else -1
        self.samples = [float(end * k / samples) for k in range(1, samples + 1)]

    def inputs(self):
        static = self.static if math.isfinite(self.static) else None
        names = ("name", "law", "axes", "inertia", "offset", "g", "mu", "theta_end", "n", "w", "u")
        lossy = {"losses": self.losses} if self.losses else {}
        return {name: getattr(self, name) for name in names} | {"static": static} | lossy


def stone(axes, moments, products=(0, 0, 0), offset=(0, 0, 0)):
    """Semi-axes, the tensor with I11, I22, I33 and I12, I13, I23, and the offset."""
    (i1, i2, i3), (i12, i13, i23) = moments, products
    return axes, [[i1, i12, i13], [i12, i2, i23], [i13, i23, i3]], offset


SMALL = stone((1, 0.3, 0.2), (0.02, 0.2, 0.21), (-0.012, 0, 0), (0, 0, -0.07))
KANE = stone((1, 0.15, 0.1), (0.005, 0.04, 0.0425), (-0.0005, 0, 0), (0, 0, -0.05))
EGG = stone((0.75, 0.75, 1), (0.25, 0.25, 0.2), offset=(0, 0, -0.05))
ODD = stone((1, 0.8, 0.6), (0.2, 0.26, 0.3), (0.02, -0.03, 0.015), (0.1, -0.05, -0.12))
THIN = stone((1, 0.06, 0.04), (0.004, 0.2, 0.201), (0.02, 0.003, -0.001), (0.01, 0.002, -0.01))
FLAT = stone((1, 0.9, 0.1), (0.16, 0.2, 0.35), (0.01, 0.002, -0.003), (0.02, -0.01, -0.01))
ROUND = stone((1, 0.999, 1.001), (0.4, 0.401, 0.399), (0.001, 0, 0), (0.001, 0.002, -0.001))
TOP = stone((1, 1, 1), (0.39, 0.39, 0.4), offset=(0, 0, -0.2))


def spinning(rate, x=0.0, y=0.0):
    """An upright stone whose vertical leaves axis 3 by small x, y, and w along the vertical."""
    z = math.sqrt(1 - x * x - y * y)
    return (x, y, z), (rate * x, rate * y, rate * z)


def scenes():
    tilt = math.radians(0.5)  # about both horizontal axes of the body
    # fmt: off
    yield Scene("small stone pushed at -0.6", SMALL, "rolling", *spinning(-0.6, 0.02, 0.01), 24)
    yield Scene("small stone pushed at 0.6", SMALL, "rolling", *spinning(0.6, 0.02, 0.01), 8)
    yield Scene("small stone rocks from rest", SMALL, "rolling", (0.05, 0.08, 0.99), (0, 0, 0), 6)
    rate = 5 / math.sqrt(981 / 20)  # 5 rad/s in units of a semi-axis of 20 cm
    kane = (-math.sin(tilt) * math.cos(tilt), math.sin(tilt))
    yield Scene("Kane and Levinson's stone slows to turn back", KANE, "rolling", *spinning(-rate, *kane), 17.5)
    yield Scene("Kane and Levinson's stone goes on", KANE, "rolling", *spinning(rate, *kane), 3)
    yield Scene("odd stone rolls", ODD, "rolling", (0.3, -0.2, 0.9), (0.2, 0.1, 0.5), 20)
    yield Scene("odd stone tumbles", ODD, "rolling", (0.3, -0.2, 0.9), (1.2, 0.9, -0.4), 10)
    yield Scene("thin stone", THIN, "rolling", (0.02, 0.1, 1), (0.05, 0.1, 0.6), 4)
    yield Scene("flat stone", FLAT, "rolling", (0.05, -0.03, 1), (0.3, 0.2, -0.8), 20)
    yield Scene("nearly round stone", ROUND, "rolling", (0.5, -0.6, -0.7), (0.4, -0.7, 0.5), 20)
    yield Scene("egg falls from its blunt end", EGG, "rolling", *spinning(1.0, 0.01), 20)
    yield Scene("egg rolls on its side", EGG, "rolling", (0.9, 0.3, 0.1), (0.5, 0.4, 0.8), 20)
    yield Scene("ball with a low centre", TOP, "rolling", (0.8, 0, 0.6), (0.3, -0.4, 1.1), 20)
    yield Scene("odd stone upside down", ODD, "rolling", (0, 0, -1), (0.1, -0.2, 0.7), 10)
    yield Scene("odd stone leaps as it rolls", ODD, "rolling", (0.3, -0.2, 0.9), (4, 1.5, 0.5), 0.36)
    yield Scene("half a stone rolls to its edge", SMALL, "rolling", (0.3, 0.1, 0.9), (0.1, 1.2, -0.4), 1.2, theta_end=1.2)
    yield Scene("small stone on a smooth table", SMALL, "smooth", *spinning(-0.6, 0.1, 0.05), 20, u=(0.1, 0))
    yield Scene("odd stone on a smooth table", ODD, "smooth", (0.3, -0.2, 0.9), (0.8, 0.4, -0.4), 20, u=(0.3, -0.2))
    yield Scene("odd stone leaps on a smooth table", ODD, "smooth", (0.3, -0.2, 0.9), (4, 1.5, 0.5), 0.36)
    yield Scene("egg that lies leaps", EGG, "coulomb", (1, 0, 0.02), (12, 0, 0.2), 8, mu=0.1, u=(0.02, 0.01), samples=8)
    yield Scene("egg that lies rises", EGG, "coulomb", (1, 0, -0.02), (5, 0, -0.1), 20, mu=0.1, u=(0.02, 0.01))
    yield Scene("nearly round stone thrown", ROUND, "coulomb", (0.5, -0.6, -0.7), (1, 0.3, 2), 6, mu=0.2, u=(0.7, 0.4))
    yield Scene("odd stone comes to roll", ODD, "coulomb", (0.1, -0.05, 1), (0.1, 0.2, -0.3), 1.2, mu=0.3, u=(0.3, -0.1))
    yield Scene("odd stone thrown", ODD, "coulomb", (0.3, -0.2, 0.9), (0.5, 1, -2), 0.9, mu=0.3, u=(1, -0.5))
    yield Scene("flat stone thrown", FLAT, "coulomb", (0.05, -0.03, 1), (0.2, 0.1, -3), 6, mu=0.2, u=(0.7, 0.3))
    yield Scene("small stone slips as it rocks", SMALL, "coulomb", (0.05, 0.1, 0.99), (0.5, 0, -0.3), 2, mu=0.2)
    yield Scene("small stone with static friction", SMALL, "coulomb", (0.05, 0.1, 0.99), (0.5, 0, -0.3), 1, mu=0.15, static=0.2)
    yield Scene("odd stone leaps as it slips", ODD, "coulomb", (0.3, -0.2, 0.9), (4, 1.5, 0.5), 0.48, mu=0.3, u=(0.5, 0.5))
    yield Scene("half a stone slips to its edge", SMALL, "coulomb", (0.3, 0.1, 0.9), (0.1, 1.2, -0.4), 1.2, mu=0.1, u=(0.8, 0.3), theta_end=0.9)
    yield Scene("egg in a viscous film", EGG, "viscous", (1, 0, 0.05), (6, 0, 0.3), 20, mu=0.3, u=(0.1, 0))
    yield Scene("odd stone in a viscous film", ODD, "viscous", (0.3, -0.2, 0.9), (0.5, 0.7, -1), 10, mu=0.5, u=(0.5, -0.2))
    # fmt: on


def losing():
    """Motions with losses, whose rows have one number more, the energy that the losses have taken."""
    both, every = (
        {"drilling": 0.02, "rolling": 0.01},
        {"air": 0.01, "air2": 0.02, "rolling": 0.01, "drilling": 0.02},
    )
    # fmt: off
    yield Scene("small stone in air", SMALL, "rolling", *spinning(-0.6, 0.02, 0.01), 12, losses={"air": 2e-3})
    yield Scene("odd stone in fast air", ODD, "rolling", (0.3, -0.2, 0.9), (0.6, 0.4, -0.5), 8, losses={"air2": 0.05})
    yield Scene("odd stone with resistance", ODD, "rolling", (0.3, -0.2, 0.9), (0.2, 0.1, 0.5), 5, losses={"rolling": 0.02})
    yield Scene("odd stone that drills", ODD, "rolling", (0.3, -0.2, 0.9), (0.2, 0.1, 0.9), 4, losses={"drilling": 0.05})
    yield Scene("odd stone with every loss", ODD, "rolling", (0.3, -0.2, 0.9), (0.2, 0.1, 0.9), 4, losses=every)
    yield Scene("small stone whose drilling is held", SMALL, "rolling", (0.05, 0.08, 0.99), (0, 0, 0), 2, losses={"air": 1e-3, "drilling": 0.05}, held=True)
    yield Scene("odd stone with losses on a smooth table", ODD, "smooth", (0.3, -0.2, 0.9), (0.8, 0.4, -0.4), 4, u=(0.3, -0.2), losses=every)
    yield Scene("odd stone thrown with losses", ODD, "coulomb", (0.3, -0.2, 0.9), (0.5, 1, -2), 0.9, mu=0.3, u=(1, -0.5), losses=every)
    yield Scene("small stone slips with losses", SMALL, "coulomb", (0.05, 0.1, 0.99), (0.5, 0, -0.3), 1, mu=0.2, losses=both)
    yield Scene("odd stone thrown whose drilling is held", ODD, "coulomb", (0, 0.6, 0.8), (0.5, 0, 0), 0.25, mu=0.2, u=(1, -0.5), losses={"rolling": 0.02, "drilling": 0.2}, held=True)
    yield Scene("odd stone in a film with losses", ODD, "viscous", (0.3, -0.2, 0.9), (0.5, 0.7, -1), 4, mu=0.5, u=(0.5, -0.2), losses=every)
    # fmt: on


def motion(scene):
    one, other = followed(scene, (Table, Body), follow)
    agreement = max(compared(other, one))
    rows = [[kind, *(None if gmpy2.is_nan(x) else decimal(x, 1e-33) for x in v)] for kind, v in one.rows]
    made = {"agreement": float(f"{float(agreement):.1e}"), "strayed": float(f"{float(one.strayed):.1e}")}
    return scene.inputs() | made | {"rows": rows}


# Small rocking about steady spin.


def upright():
    """Name, stone, g, whether axis 3 points up, and spins."""
    centimetres = stone((20, 3, 2), (2, 16, 17), (-0.2, 0, 0), (0, 0, -1))
    untwisted = stone((1, 0.3, 0.2), (0.02, 0.2, 0.21), offset=(0, 0, -0.07))
    yield "Kane and Levinson's stone in cm", centimetres, 981, 1, (0, -5, 5, -1, 1, -40, 40, 1000)
    yield "Kane and Levinson's stone", KANE, 1, 1, (-0.7, 0.7)
    yield "small stone", SMALL, 1, 1, (0, -0.6, 0.6, -0.01, 0.01, -3, 3, 100)
    yield "small stone upside down", SMALL, 1, -1, (0, -0.6, 0.6, 8)
    yield "untwisted stone", untwisted, 1, 1, (0, 0.6, -0.6, 5)
    yield (
        "twisted stone without offset",
        stone((1, 0.5, 0.4), (0.1, 0.2, 0.25), (0.03, 0, 0)),
        1,
        1,
        (0, 0.5, -2),
    )
    yield (
        "twisted stone on its end",
        stone((0.5, 0.4, 1), (0.2, 0.25, 0.1), (0.03, 0, 0)),
        1,
        1,
        (0, 1, 6, -6),
    )
    yield (
        "stone with a round end and twist",
        stone((0.5, 0.5, 0.4), (0.1, 0.2, 0.25), (0.03, 0, 0)),
        1,
        1,
        (0, 1, -1),
    )
    yield "egg on its blunt end", EGG, 1, 1, (0, 1, 4, -4)
    yield "egg on its pointed end", EGG, 1, -1, (1, 4, 50)
    yield "ball with a low centre", TOP, 1, 1, (0, 1)
    yield "ball with a high centre", TOP, 1, -1, (0, 1, 10)
    yield "ball", stone((1, 1, 1), (0.4, 0.4, 0.4)), 1, 1, (0, 2)


def rocking(make, scene, up, spin, step):
    """The eigenvalues, by differences."""
    model = make(scene)
    model.watching = True
    phase = model.phase("roll")
    columns = []
    for k in range(4):
        change = []
        for side in (1, -1):
            at = [mpfr(0), mpfr(0), mpfr(0), mpfr(0)]
            at[k] = side * step
            n = [at[2], at[3], up * gmpy2.sqrt(1 - at[2] ** 2 - at[3] ** 2)]
            phase.tape.expand(model.start(n, [at[0], at[1], up * mpfr(spin)]), 1)
            change.append([x.c[1] for x in (*phase.seen["w"][:2], *phase.seen["n"][:2])])
        columns.append([(a - b) / (2 * step) for a, b in zip(*change, strict=True)])
    rows = [[mp.mpf(f"{columns[k][i]:.490e}") for k in range(4)] for i in range(4)]
    values, _ = mp.eig(mp.matrix(rows))
    values = [
        mp.mpc(*(mp.mpf(0) if abs(x) < mp.mpf("1e-70") else x for x in (v.real, v.imag))) for v in values
    ]
    return sorted(values, key=lambda v: (round(v.real, 40), round(v.imag, 40)))


def steady():
    precise(STEADY_DIGITS)
    mp.dps = STEADY_DIGITS
    inputs = "a1,a2,a3,i11,i12,i13,i22,i23,i33,d1,d2,d3,g,up,spin"
    yield f"name,{inputs},{','.join(f'real{k},imag{k}' for k in range(1, 5))},agreement"
    for name, body, g, up, spins in upright():
        axes, i, offset = body
        tensor = (*i[0], i[1][1], i[1][2], i[2][2])
        scene = Scene(name, body, "rolling", (0, 0, up), (0, 0, 0), 1, g=g)
        for spin in spins:
            values = rocking(Table, scene, up, spin, mpfr("1e-160"))
            others = rocking(Body, scene, up, spin, mpfr("1e-150"))
            away = min(
                max(abs(a - b) / max(1, abs(a)) for a, b in zip(values, p, strict=True))
                for p in itertools.permutations(others)
            )
            print(
                f"{name} at {spin}: {', '.join(mp.nstr(v, 9) for v in values)}; {mp.nstr(away, 2)}",
                flush=True,
            )
            numbers = [mp.nstr(x, 60, min_fixed=1, max_fixed=0) for v in values for x in (v.real, v.imag)]
            given = [float(x).hex() for x in (*axes, *tensor, *offset, g, up, spin)]
            yield ",".join([name, *given, *numbers, mp.nstr(away, 2)])


def main():
    names = sys.argv[1:]
    precise(DIGITS)
    renew_json(HERE / "stones.json", scenes(), motion, "motions", columns=COLUMNS)
    renew_json(HERE / "stones_losing.json", losing(), motion, "motions", columns=[*COLUMNS, "lost"])
    if not names or "steady" in names:
        (HERE / "stones_steady.csv").write_text("\n".join(steady()) + "\n")


if __name__ == "__main__":
    main()
