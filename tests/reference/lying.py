"""Writes lying.json: motions of a body that lies on both rims, or comes to, the reference of their tests.

    python tests/reference/lying.py [name ...]      those whose names begin so; or all

It needs gmpy2, and twelve minutes for all of them on one core.

Every motion is made from two formulations, `vectors` and `reduced` of lying_forms.py, whose one rim is that
of slip_forms.py. They share the laws, the series of series.py and the order of the phases, below and in
phases.py. Landings have no restitution.

A row is a checkpoint: what is there, the time, the state (theta, w1, w2, w3), the slip along the lean and
across of the rim from which it is told, and of the other one while both are down, the heat of the slip and
the landings, the work of the losses, and (phi, psi, x, y), which start at 0. What is there:

    sample    nothing                           lies      the other rim lands, and both stay
    pivots    one rim sticks, the other slips   rocks     it lands, and the first one leaves
    slides    both rims slip                    rocked    infinitely many landings are over: both are down
    straight  both stick: it rolls straight     rises     one end leaves the table
    holds w1, holds w3                          dry friction holds what it has stopped
    crosses   w1 or w3 goes through 0 and on    goes on   what was held is let go
    rests     dry friction has stopped what rolled straight: the end of the motion
    rolls, slips, passes                        of one rim, as in slip.py
    end       the last time

Inputs are exact doubles; results are decimal, to 25 digits. `agreement` is the largest difference of both
formulations in all numbers of a motion, over 1 or the number if that is more.
"""

import math
import pathlib
import time

import gmpy2
from flight_vectors import first_fall
from gmpy2 import mpfr
from lying_forms import LAWS, ZERO
from lying_phases import RATES, TINY, TOLD, Both
from lying_reduced import Reduced
from lying_vectors import Vectors
from phases import Record, departure, first_event, onset, sampled, slipping, step_size
from series import precise
from slip import moved
from tables import compared, decimal, renew_json
from torus import tube

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
    "other_h",
    "other_2",
    "heat",
    "work",
    "phi",
    "psi",
    "x",
    "y",
)
CLATTER = mpfr("1e-13")  # below it the rest of a rocking is summed

# What happens next.


def follow(model, loud=False):
    """The checkpoints of a scene."""
    scene, out = model.scene, Record(model, loud)
    samples = [mpfr(t) for t in scene.samples]
    both = Both(model, out)
    y = model.start()
    # how a gap to a border, from which the body comes, begins: with this power of the time
    own, kind, origin = 0, "steep", None
    if scene.lies:
        y, kind = model.lie(y), "both"
    elif not scene.smooth:
        kind, y = slipping(model, y, out) if y[0] == 0 and y[1] == 0 else ("slip", y)
    rocked, last = [], None

    def alone(y, order):
        """The told circle carries on alone."""
        nonlocal own, origin
        y, own, origin, model.o = model.rise(y), order, model.o, None
        return y

    while True:
        if kind == "both":
            now, signs, y = both.enter(y)
            if now == "one":
                if signs == 1:  # the circle that carries on
                    y = model.other(y)
                y, kind = alone(y, 2), "slip"
                if gmpy2.hypot(*y[:2]) <= TINY:
                    kind, y = slipping(model, y, out)
                if y[3] > 0:
                    out.add("rises", y[3], y)
                continue
            name = {"LL": "slides", "SL": "pivots", "LS": "pivots", "SS": scene.rolls}[now]
            # a landing, or what dry friction does, has had its row
            if last not in (None, *TOLD) or (last == "lies" and now != "LL"):
                out.add(name, y[6], y)
            last = name
            if now == "SS" and model.dry[1] and not signs[1]:
                out.add("rests", y[6], y)
                return out
            both.sense = None
            what, y = both.follow(now, signs, y, samples)
            if what is None:
                return out
            if what == "turned":
                y = [ZERO] * 4 + y[4:]
            elif what == "lets go":
                rim = 0 if now == "SL" else 1
                out.add("slides", y[6], y)
                begins = both.lets_go if model.static == model.mu else both.departs
                y, last = begins(y, rim, signs), "lies"
            elif what in RATES:
                which = RATES.index(what)
                y = model.at_rest(y, which)
                stopped = tuple(0 if k == which else x for k, x in enumerate(signs))
                there = model.there(now, stopped, y)
                if now == "SS":
                    out.add("rests", y[6], y)
                    return out
                if there.holds[which].c[0] < 0:
                    both.sense = which, -signs[which]
                    last = "crosses"
                    out.add(last, y[6], y)
                else:
                    last = "held"
                    out.add(f"holds {scene.rates[which]}", y[6], y)
            elif what in (0, 1):
                last = "goes on"
                out.add(last, y[6], y)
            elif what in ("rises", "sinks"):
                if what == "sinks":
                    y = model.other(y)
                carrying = now if what == "rises" else now[::-1]
                y = alone(y, 3)
                kind = "roll" if carrying[0] == "S" else "slip"
                if scene.smooth:
                    kind = "steep"
                if kind == "roll":
                    y = [ZERO, ZERO, *y[2:]]
                out.add("rises", y[3], y)
            continue
        phase = model.phase(kind)
        tape, lean = phase.tape, model.lean(y)
        tape.expand(y, model.order)
        out.steps += 1
        h = step_size(phase, model.order, model.tolerance)
        place, name = first_event(model.events(phase, kind), h)
        # the own place at a border is left behind by its order
        for o, gap in phase.gaps.items():
            begun = own if o == origin else 0
            side = first_fall(gap.c[begun:], h if place is None else place, begun)
            if side is not None:
                place, name = side, o
        h, own = h if name is None else place, 0
        sampled(out, samples, tape.states[3], h, kind == "slip")
        if not samples:
            return out
        y = [node.at(h) for node in tape.states]
        if isinstance(name, int):
            if origin != name:
                rocked = []
            origin, model.o = name, name
            if model.border.smooth:
                y = model.other(y)
                own, origin, model.o = 1, model.o, None
                if kind == "roll":
                    kind, y = slipping(model, [ZERO, ZERO, *y[2:]], out)
                assert model.at(kind, y).normal.c[0] > 0
                out.add("joint", y[3], y)
                continue
            y, what = model.land(y)
            if what == "lies":
                kind, last, rocked = "both", "lies", []
                out.add("lies", y[6], y)
                continue
            fall, own, origin, model.o = model.falling(y), 1, model.o, None
            if fall > scene.brief:
                out.add("rocks", y[3], y)
            rocked.append((fall, y))
            earlier = rocked[-3] if len(rocked) > 2 else None
            if not scene.smooth:
                kind, y = slipping(model, y, out) if y[0] == 0 and y[1] == 0 else ("slip", y)
            if fall < CLATTER and earlier is not None:
                ratio = fall / earlier[0]
                more = [(a - b) * ratio / (1 - ratio) for a, b in zip(y, earlier[1], strict=True)]
                model.o = origin
                y = model.lie(model.settled([a + b for a, b in zip(y, more, strict=True)]))
                kind, last, rocked = "both", "lies", []
                out.add("rocked", y[6], y)
        elif name == "slips":
            y = [ZERO, ZERO, *y[2:]]
            out.add(name, y[3], y)
            y = (
                onset(model, y, out)
                if model.static == model.mu
                else model.directed(y, departure(model, y), model.tiny)
            )
            kind = "slip"
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
                out.add("rolls" if kind == "roll" else "passes", y[3], [ZERO, ZERO, *y[2:]])


# The scenes.


class Scene:
    """A body, its contact and losses, a start (theta, w1, w2, w3, u_h, u_2) and times; it lies at pi/2."""

    rolls, rates, circle, apex = "straight", ("w1", "w3"), 0, None

    def __init__(
        self, name, body, mu, start, end, law="coulomb", static=None, losses=None, samples=5, brief=0.0
    ):
        self.name, self.law, self.losses = name, law, losses or {}
        self.body = [float(x) for x in body]
        self.mu = float(mu)
        self.static = self.mu if static is None else float(static)
        self.start = [float(x) for x in start]
        self.end, self.brief = float(end), brief
        self.samples = sorted({float(end * k / samples) for k in range(1, samples + 1)})
        self.smooth = law == "viscous" or self.mu == 0
        self.lies = self.start[0] == math.pi / 2 and self.start[2] == 0
        self.other = 1 if self.lies else None
        ell, _, _, rho = map(mpfr, self.body)
        self.circles = [(1 - rho, side * ell, rho) for side in (1, -1)]

    def told(self):
        """The body, for the table."""
        return {"body": self.body}

    def shown(self, model, row):
        """Told from the rim that carries."""
        pi = gmpy2.const_pi()
        theta, w1, w2, w3, *slips, heat, work, phi, psi, x, y = row
        if model.k:
            theta, w2, w3, psi, slips = pi - theta, -w2, -w3, -psi, [-u for u in slips]
        return [theta, w1, w2, w3, *slips, heat, work, phi + pi * model.changes, psi, x, y]


HALF_PI = math.pi / 2


def scenes():
    paper, solid, short = tube(6.0, 0.8), tube(1.0, 0.0), tube(0.3, 0.0)

    def launched(w1, x):
        w3 = x * 6.0 / (paper[2] * w1)
        return moved(paper, (HALF_PI, w1, 0.0, w3), 0.0, -paper[1] / 6 * w1)

    yield Scene("cylinder thrown sideways", solid, 0.3, (HALF_PI, 0, 0, 0.5, 0, 2), 5)
    yield Scene("tube flicked at 0.5", paper, 0.3, launched(1.5, 0.5), 20)
    yield Scene("tube pivots and lets go", paper, 0.3, launched(1.5, 0.9), 36, samples=8)
    yield Scene("tube pivots, static friction", paper, 0.3, launched(1.5, 0.9), 36, static=0.35)
    yield Scene("tube flicked at 0.9 rises", paper, 0.3, launched(3.0, 0.9), 34)
    yield Scene("tube flicked fast at 0.5", paper, 0.3, launched(3.0, 0.5), 45)
    yield Scene("tube rises and lands twice", paper, 0.3, launched(1.5, 1.2), 25)
    yield Scene("cylinder rocks to rest", short, 1.0, (1.4, 0, 0, 0, 0, 0), 20, brief=0.2)
    slim, long, disk = tube(0.45, 0.0), tube(2.5, 0.0), tube(0.4, 0.6)
    yield Scene("short cylinder pivots", slim, 0.1, (HALF_PI, 1.2, 0, 0.4, 0.5, -0.3), 13.5)
    yield Scene(
        "short cylinder, static friction", slim, 0.1, (HALF_PI, 0.8, 0, -0.3, 0.4, 0.6), 14, static=0.14
    )
    start = (1.3, 0.3, 0.1, 0.2, 0.2, -0.3)
    yield Scene("cylinder falls and lies", long, 0.3, start, 6)
    yield Scene("disk rocks as it slips", disk, 0.2, (1.3, 0.5, -0.2, 0.3, 0.4, -0.3), 2.5, brief=0.02)
    spins = (HALF_PI, 1.5, 0, 0.4, 0.1, 1.2)
    both = {"rolling": 0.02, "drilling": 0.03}
    yield Scene("rolling resistance and drilling", solid, 0.3, spins, 25, losses=both)
    turns = (HALF_PI, 0.3, 0, 0.5, 2.0, 1.0)
    slides = (HALF_PI, 0.4, 0, 0.6, 0.8, -0.5)
    yield Scene("dry contour and air", solid, 0.2, slides, 30, losses={"dry": 0.02, "air": 0.05})
    yield Scene("dry contour stops a slide's spin", slim, 0.15, turns, 25, losses={"dry": 0.12})
    yield Scene("drilling stops the turn of a slide", solid, 0.1, turns, 25, losses={"drilling": 0.1})
    yield Scene("rolling resistance stops a slide's spin", solid, 0.1, turns, 25, losses={"rolling": 0.15})
    every = {"viscous": 0.03, "air2": 0.02, "air": 0.01}
    yield Scene("viscous contour and quadratic air", long, 0.15, slides, 20, losses=every)
    yield Scene("cylinder on a smooth table", solid, 0, spins, 6, losses={"air": 0.03, "drilling": 0.02})
    yield Scene("cylinder on a film", solid, 0.4, slides, 12, law="viscous")


# The table.


def made(scene):
    found = []
    for make in (Vectors, Reduced):
        begun = time.time()
        model = make(scene)
        found.append(follow(model))
        print(
            f"{scene.name}: {make.__name__}, {found[-1].steps} steps, {time.time() - begun:.0f} s", flush=True
        )
    one, other = found
    print(f"    constraints kept to {float(one.strayed):.1e}")
    agreement = max(compared(one, other, angles=(11, 12)))
    return {
        "name": scene.name,
        "law": scene.law,
        **scene.told(),
        "mu": scene.mu,
        "static": scene.static,
        "losses": [scene.losses.get(name, 0.0) for name in LAWS],
        "start": scene.start,
        "agreement": float(f"{float(agreement):.1e}"),
        "rows": [
            [kind, *("nan" if gmpy2.is_nan(x) else decimal(x, 1e-28) for x in row)]
            for kind, row in other.rows
        ],
    }


def main():
    precise(DIGITS)
    renew_json(HERE / "lying.json", scenes(), made, "motions", columns=["kind", *NAMES], laws=LAWS)


if __name__ == "__main__":
    main()
