"""Writes flights.json: motions that leave the table, fly and bounce, the reference of their tests.

    python tests/reference/flights.py [name ...]     those whose names begin so; or all

It needs gmpy2, and two minutes for all of them on one core.

Every motion is made from two formulations, `vectors` and `closed` of flight_forms.py, whose contact is that
of slip_forms.py. They share the laws, the series of series.py and the order of the phases, below and in
phases.py.

A row is a checkpoint: what is there, the time, the state (theta, w1, w2, w3), the velocity of the lowest
point along the lean, across and upwards, its height, the heat of the slip, the energy lost in impacts,
(phi, psi, x, y), which start at 0; x and y are of the place below that point. All is told from the
rim that is or was last down. What is there:

    sample    nothing                            slides   the contact begins in slip
    lift-off  the contact has no normal force    rolls    slip ends in rolling, or the contact begins so
    lands     a rim is down: before the impact   slips    |F| = mu N in rolling
    impact    the same, after it                 passes   slip goes through 0 and on, in another direction
    rests     infinitely many bounces are over   side     the axis is horizontal in contact: the end
    end       the last time

`impacts` has the time of every impact down to bounces of 1e-7, with its rim, what the contact does there
(slips, sticks, slips on, smooth), the impulses along the lean, across and upwards, and the energy lost.
Only the first few have rows, and only these have their impulses. The rim is `first` if it is that from
which the start is told.

Infinitely many bounces: they are followed until they are as slow as 1e-16 in one formulation and 1e-18 in
the other; the next impact has no restitution. What then remains is of second order, but for the time:
`rests` is after the geometric sum of the times that are left.

Inputs are exact doubles; results are decimal, to 25 digits. `agreement` is the largest difference of both
formulations in all numbers of a motion, over 1 or the number if that is more.
"""

import math
import pathlib
import time

import gmpy2
from flight_closed import Closed
from flight_vectors import Vectors
from gmpy2 import mpfr
from phases import Record, departure, first_event, onset, sampled, slipping, step_size
from series import precise
from slip import moved
from tables import compared, decimal, renew_json
from torus import rounded, tube

HERE = pathlib.Path(__file__).parent
DIGITS = 50
NAMES = (
    "t",
    "theta",
    "w1",
    "w2",
    "w3",
    "u_h",
    "u_2",
    "u_n",
    "height",
    "heat",
    "lost",
    "phi",
    "psi",
    "x",
    "y",
)
TOLD = ("t", "rim", "kind", "along", "across", "up", "lost")
SLOWEST = {"Vectors": mpfr("1e-16"), "Closed": mpfr("1e-18")}
BRIEF = mpfr("1e-7")  # slower impacts are not told

# What happens next.


class Flown(Record):
    """The checkpoints, with the impacts."""

    def __init__(self, model, loud=False):
        super().__init__(model, loud)
        self.impacts, self.resting = [], {}

    def add(self, kind, t, y, lean=None):
        super().add(self.resting.get(t, kind) if kind == "sample" else kind, t, y, lean)


def pressed(model, y, out):
    """The phase of a contact that begins, with its state; in flight if nothing presses it down."""
    law = model.scene.law
    if model.gravity(y) <= 0 and law != "rolling":
        return "fly", y
    if law == "rolling":
        kind = "roll" if model.at("roll", y).normal.c[0] > 0 else "fly"
    elif model.scene.smooth:
        kind = "steep"
    elif y[0] == 0 and y[1] == 0:
        kind, y = slipping(model, y, out)
    else:
        kind = "slip"
    return kind, y


def follow(model, loud=False, lift=6):
    """The checkpoints of a scene; `lift` is the place of the normal velocity in what a model tells."""
    scene, out = model.scene, Flown(model, loud)
    samples = [mpfr(t) for t in scene.samples]
    y = model.start()
    e, rows, order, before, told_from = scene.restitution, scene.rows, 0, None, 0
    slowest = SLOWEST[type(model).__name__]
    kind = "fly"
    if not scene.aloft:
        kind, y = pressed(model, y, out)
        order = 2
    elif scene.height == 0:
        order = 1
    while True:
        if kind == "fly":
            y, rim = model.fly(y, order, samples, out)
            if y is None:
                return out
            falls, told_from = -model.read(y)[lift], told_from ^ rim
            told = rows > 0 and falls > BRIEF
            if told:
                out.add("lands", y[3], y)
            # the last one of infinitely many
            last = e > 0 and falls < slowest and model.gravity(y) > 0
            struck = model.impact(y, 0 if last else e)
            if last:
                ratio = falls / before
                assert ratio < 1
                left = 2 * ratio * falls / (model.gravity(y) * (1 - ratio))
                rest = y[3] + left
                samples[:] = sorted([*samples, rest])
                out.resting[rest] = "rests"
            before = falls
            model.lost += struck.lost
            y = struck.y
            if falls > BRIEF:
                impulse = [*struck.impulse, struck.lost] if told else []
                out.impacts.append([y[3], ("first", "other")[told_from], struck.kind, *impulse])
                out.note("impact", *out.impacts[-1])
            if struck.lift > 0:
                y, order = model.aloft(y, struck.lift), 1
                if told:
                    out.add("impact", y[3], y)
                rows -= 1
                continue
            if told and e == 0:
                out.add("impact", y[3], y)
            rows = scene.rows
            kind, y = pressed(model, y, out)
            order = 2
            if last:  # what slides meanwhile slides in impacts
                force = model.at(kind, y).force
                heat = -left * (force[0].c[0] * y[0] + force[1].c[0] * y[1])
                y[2], model.lost = y[2] - heat, model.lost + heat
            if kind != "fly" and not last:
                out.add("rolls" if kind == "roll" else "slides", y[3], y)
            continue
        phase = model.phase(kind)
        tape, lean = phase.tape, model.lean(y)
        tape.expand(y, model.order)
        out.steps += 1
        h = step_size(phase, model.order, model.tolerance)
        place, name = first_event(model.events(phase, kind), h)
        h = h if name is None else place
        sampled(out, samples, tape.states[3], h, kind == "slip")
        if not samples:
            return out
        y = [node.at(h) for node in tape.states]
        if name == "slips" and scene.law != "rolling":
            y = [mpfr(0), mpfr(0), *y[2:]]
            out.add(name, y[3], y)
            rises = model.static == model.mu
            y = onset(model, y, out) if rises else model.directed(y, departure(model, y), model.tiny)
            kind = "slip"
        elif name in ("lift-off", "slips"):
            out.add("lift-off", y[3], y)
            if scene.law == "rolling":
                assert model.gravity(y) < 0, "it would slip"
            kind, order, rows = "fly", 2 if scene.law == "rolling" else 3, scene.rows
        elif name:
            out.add(name, y[3], y, lean if name == "face" else None)
            return out
        elif kind == "slip":
            size = gmpy2.sqrt(y[0] ** 2 + y[1] ** 2)
            if size < model.tiny and size < phase.size.c[0]:
                there = model.at("slip", y)
                growth = there.growth.c[0]
                assert growth < 0
                y[3] += size / -growth
                kind, y = slipping(model, y, out)
                out.add("rolls" if kind == "roll" else "passes", y[3], [mpfr(0), mpfr(0), *y[2:]])


# The scenes.


class Scene:
    """A body (ell, i1, i3, fillet), a law of contact, a restitution, a start and times.

    The start is theta, w1, w2, w3, u_h, u_2, and in the air the height and the velocity upwards. `rows` is
    how many impacts of each sequence have rows.
    """

    def __init__(
        self,
        name,
        body,
        mu,
        e,
        start,
        end,
        height=None,
        lift=0.0,
        law="coulomb",
        static=None,
        samples=5,
        rows=2,
    ):
        self.name, self.law, self.restitution = name, law, float(e)
        self.body = [float(x) for x in body]
        self.mu = float(mu)
        self.static = math.inf if law == "rolling" else self.mu if static is None else float(static)
        self.start = [float(x) for x in start]
        self.aloft = height is not None
        self.height, self.lift = float(height or 0), float(lift)
        self.end, self.rows = float(end), rows
        self.samples = sorted({float(end * k / samples) for k in range(1, samples + 1)})
        self.smooth = law == "viscous" or self.mu == 0
        self.side = self.body[0] > 0 and self.body[3] < 1


HALF_PI = math.pi / 2


def scenes():
    solid, long, can = tube(1.0, 0.0), tube(2.5, 0.0), tube(0.5, 0.0)
    paper, hoop, disk, hollow = tube(6.0, 0.8), tube(0.0, 1.0), tube(0.0, 0.0), tube(0.8, 0.7)
    ball = (0.3, 0.5, 0.4, 1.0)
    launched = moved(paper, (HALF_PI, 3.0, 0.0, 3.0 * 6.0 / (paper[2] * 3.0)), 0.0, -paper[1] / 6 * 3.0)

    yield Scene(
        "cylinder dropped", solid, 0.3, 0.5, (0.6, 0.5, -0.3, 0.8, 0.4, -0.3), 4.25, height=0.5, lift=0.2
    )
    yield Scene(
        "cylinder dropped on its other rim", solid, 0.3, 0.5, (2.2, 0.4, 0.5, -0.6, 0.2, 0.4), 3, height=1.5
    )
    yield Scene("tube hops in slip", paper, 0.3, 0.0, launched, 12)
    yield Scene("tube hops and bounces", paper, 0.3, 0.5, launched, 6)
    yield Scene("disk bounces for ever", disk, 0.25, 1, (0.9, 1.0, 0.3, -0.5, 0.5, 1), 5, height=0.3, rows=4)
    yield Scene("hoop dropped upright spinning", hoop, 0.3, 0.8, (HALF_PI, 0, 0, -3, 0, 2), 12, height=0.4)
    rim = rounded(0.6, 0.2)
    yield Scene("rounded rim dropped", rim, 0.4, 0.3, (0.7, 0.8, 0.2, 0.3, -0.5, 0.6), 4, height=0.8)
    yield Scene("ball off its centre", ball, 0.2, 0.5, (1.2, 1, 0.1, 2, 0.3, 1), 6, height=0.5)
    yield Scene(
        "hollow cylinder, static friction", hollow, 0.2, 0.5, (0.8, 0.3, 0.6, 0.2, 0.1, 0), 4, 0.3, static=0.5
    )
    yield Scene(
        "can on a smooth table", can, 0, 0.8, (0.5, 1.2, 0.3, 0.4, 0.3, -0.6), 4, height=0.2, lift=0.5
    )
    yield Scene(
        "can on a viscous film", can, 0.5, 0.3, (0.5, 1.2, 0.3, 0.4, 0.3, -0.6), 4, 0.2, law="viscous"
    )
    grips = (0.56, 0.1, 0.6, 0.4, 0.06, 0.09)
    yield Scene("can grips a rolling table", tube(0.5, 0.5), 0, 0.5, grips, 4, 0.3, law="rolling")
    turned = (0.65, -0.4, 0.1, -0.5, -0.07, 0.01)
    yield Scene("cylinder grips and rolls at once", solid, 0, 0, turned, 3, 0.3, law="rolling")
    yield Scene("tube slips on after a stop", paper, 0.3, 0.5, (1.39, 0, -0.6, 0.6, -0.06, 0.38), 1, 0.1)
    other = (1.39, 0.4, -0.8, 0.1, 0.61, -0.15)
    yield Scene("cylinder whose slip nearly stops", long, 0.2, 0.5, other, 1, 0.1)
    thick = (1.39, 0, -0.2, 0.2, 0.16, -0.18)
    yield Scene("hollow tube slips on after a stop", tube(4.0, 0.5), 0.3, 0.5, thick, 1, 0.1, rows=3)
    yield Scene(
        "cylinder grazes", solid, 0.3, 0.5, (0.8, 0.4, 2.5, 0.3, 0.3, 0.2), 4, height=0.5945, lift=1.0
    )
    flat = (0.1, 0.02, 0.1, 0.2, 0.1, 0.2)
    yield Scene("coin lands near its face", tube(0.1, 0.0), 0.3, 0.3, flat, 1.2, height=0.5)
    thrown = (1.03, 0.8, -2.7, 0.1, -0.38, -0.64)
    yield Scene("cylinder without restitution", solid, 0.3, 0, thrown, 2.6, height=0.3)
    yield Scene(
        "hollow cylinder, no restitution", hollow, 0.4, 0, (0.8, 0.3, 0.6, 0.2, 0.1, 0), 3, 0.3, static=0.6
    )


# The table.


def made(scene):
    found = []
    for make in (Vectors, Closed):
        begun = time.time()
        model = make(scene)
        found.append(follow(model))
        told = f"{found[-1].steps} steps, {len(found[-1].impacts)} impacts, {time.time() - begun:.0f} s"
        print(f"{scene.name}: {make.__name__}, {told}", flush=True)
    one, other = found
    closed = getattr(model, "worst", mpfr(0))
    print(f"    constraints kept to {float(one.strayed):.1e}, closed first slips to {float(closed):.1e}")
    agreement = max(compared(one, other, angles=(11, 12)))
    assert len(one.impacts) == len(other.impacts)
    for a, b in zip(one.impacts, other.impacts, strict=True):
        assert a[1:3] == b[1:3], (a, b)
        agreement = max(
            [
                agreement,
                *(abs(x - y) / max(1, abs(y)) for x, y in zip(a, b, strict=True) if not isinstance(x, str)),
            ]
        )
    kinds = [f"{kind} {float(t):.4f}" for t, _, kind, *_ in other.impacts[:6]]
    print(f"    {', '.join(kinds)}; with the impacts {float(agreement):.1e}")
    return {
        "name": scene.name,
        "law": scene.law,
        "body": scene.body,
        "mu": scene.mu,
        "static": None if math.isinf(scene.static) else scene.static,
        "restitution": scene.restitution,
        "start": scene.start,
        "aloft": [scene.height, scene.lift] if scene.aloft else None,
        "agreement": float(f"{float(agreement):.1e}"),
        "rows": [[kind, *(decimal(x, 1e-30) for x in row)] for kind, row in other.rows],
        "impacts": [[x if isinstance(x, str) else decimal(x, 1e-30) for x in one] for one in other.impacts],
    }


def main():
    precise(DIGITS)
    columns = {"columns": ["kind", *NAMES], "told": TOLD}
    renew_json(HERE / "flights.json", scenes(), made, "motions", **columns)


if __name__ == "__main__":
    main()
