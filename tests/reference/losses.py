"""Writes losses.json: motions that losses slow down, the reference of their tests.

    python tests/reference/losses.py [name ...]      those whose names begin so; or all

It needs gmpy2, and five minutes for all of them on one core.

Every motion is made from the two formulations of losses_forms.py, `vectors` in the laboratory and `momenta`, which share
the series of series.py, the laws of the losses, and the order of the phases.

A row is a checkpoint: what is there, the time, the state (theta, w1, w2, w3), the slip along the lean and
across, the work lost to the couples, the heat of the slip, and (phi, psi, x, y), which start at 0. What is
there:

    sample    nothing                             crosses   psi' = 0, and psi' goes on with the other sign
    rolls     slip ends in rolling                stops     psi' = 0, and dry friction holds it there
    slips     |F| = mu N in rolling               holds     w.z = 0, and drilling friction holds it there
    end       the last time                       goes on   what was held is let go
    side      the axis is horizontal              face      the axis is vertical: the face lands

A motion goes on beyond "stops" if `beyond`, else it ends there, and in any case with its last row.
The viscous laws make psi' die so fast at the face that the equations are stiff there: the face is reached
by extrapolation in theta from a few inclinations below 1e-3.

Slip runs in the variable tau, dt = |u| dtau, down to |u| = 1e-14, from where one linear step is left.

Inputs are exact doubles; results are decimal, to 25 digits. `agreement` is the largest difference of both
formulations in all numbers of a motion, over 1 or the number if that is more.
"""

import math
import pathlib
from itertools import pairwise

import extrapolation
import gmpy2
from gmpy2 import mpfr
from losses_forms import LAWS, Momenta, Vectors
from phases import Record, first_event, sampled, step_size
from series import precise
from tables import compared, decimal, followed, renew_json
from torus import rounded, tube

HERE = pathlib.Path(__file__).parent
DIGITS = 40
LEAST = mpfr("1e-14")
NAMES = ("t", "theta", "w1", "w2", "w3", "u_h", "u_2", "work", "heat", "phi", "psi", "x", "y")


# What happens next.


def at_the_face(rows):
    """The numbers of a row at theta = 0, by Neville's polynomial through those near it."""
    columns = list(zip(*rows, strict=True))
    return [extrapolation.to_zero(columns[1], list(column)) for column in columns]


def unwound(rows):
    """Angles without jumps, from row to row near the face."""
    whole = 2 * gmpy2.const_pi()
    for one, other in pairwise(rows):
        for i in (9, 10):
            other[i] += whole * gmpy2.rint((one[i] - other[i]) / whole)
    return rows


def follow(model):
    """The checkpoints of a scene."""
    scene, out, near_face = model.scene, Record(model), []
    samples = [mpfr(t) for t in scene.samples]
    y = model.start()
    kind = {"rolling": "roll", "smooth": "smooth", "coulomb": "slip"}[scene.contact]
    signs = (1, 1)
    there = model.at(kind, signs, y)
    signs = tuple(1 if node.c[0] > 0 else -1 for node in (there.psi, there.drill))
    faces = list(model.faces)

    while True:
        phase = model.phase(kind, signs)
        tape = phase.tape
        tape.expand(y, model.order)
        out.steps += 1
        h = step_size(phase, model.order, model.tolerance)
        assert phase.normal.c[0] > 0 and out.steps < 5000, scene.name
        events = []
        if signs[0] and (model.losses["dry"] or model.losses["layer"]):
            events.append(("psi", Margin(phase.psi, signs[0])))
        if signs[1] and model.losses["drilling"]:
            events.append(("drill", Margin(phase.drill, signs[1])))
        if model.rolls(kind) and model.mu:
            events.append(("slips", phase.demand))
        if phase.hold is not None:
            events.append(("hold", phase.hold))
        if scene.body[0] > 0:
            events.append(("side", phase.up))
        if scene.face:
            events.append(("near", Margin(phase.lean, level=gmpy2.sin(faces[0]))))
        place, name = first_event(events, h)
        h = h if name is None else place
        sampled(out, samples, tape.states[0], h, phase.size is not None)
        if not samples:
            return out
        y = [node.at(h) for node in tape.states]
        if name:
            if name == "near":
                near_face.append([y[0], *model.read(y)])
                faces.pop(0)
                if not faces:
                    out.rows.append(("face", at_the_face(unwound(near_face))))
                    return out
            elif name == "hold":
                way = 1 if phase.push.at(h) > 0 else -1
                signs = (way, signs[1]) if kind == "held rim" else (signs[0], -way)
                kind = "roll"
                out.add("goes on", y[0], y)
            elif name in ("psi", "drill"):
                which = ("psi", "drill").index(name)
                other, rest = (
                    tuple(k * sign if i == which else sign for i, sign in enumerate(signs)) for k in (-1, 0)
                )
                goes_on = getattr(model.at(kind, other, y), name).c[1] * other[which] > 0
                out.add("crosses" if goes_on else ("stops", "holds")[which], y[0], y)
                if goes_on:
                    signs = other
                elif which or scene.beyond:
                    kind, signs = ("held rim", "held drill")[which], rest
                else:
                    return out
            else:
                out.add(name, y[0], y)
                return out
        elif kind == "slip":
            there = model.at(kind, signs, y)
            size, growth = there.size.c[0], there.size.c[1]
            if size < LEAST:
                assert growth < 0, scene.name
                tape = there.tape
                y = [node.c[0] - node.c[1] * (size / growth) for node in tape.states]
                kind, y = "roll", model.turn(y, "roll")
                out.add("rolls", y[0], y)
                there = model.at(kind, signs, y)
                assert there.demand.c[0] > 0, scene.name


class Margin:
    """A series times a sign, over a level."""

    def __init__(self, node, sign=1, level=0):
        self.node, self.sign, self.level = node, sign, level

    def at(self, h):
        return self.sign * self.node.at(h) - self.level


# The scenes.


class Scene:
    """A body (ell, i1, i3, fillet), losses, a contact, a start (theta, w1, w2, w3, u_h, u_2) and times."""

    def __init__(
        self, name, body, losses, start, end, contact="rolling", mu=0.0, samples=6, face=False, beyond=False
    ):
        self.name, self.losses, self.contact = name, losses, contact
        self.face, self.beyond = face, beyond
        self.body = [float(x) for x in body]
        self.mu = float(mu)
        self.start = [float(x) for x in (*start, 0.0, 0.0)[:6]]
        self.end = float(end)
        self.samples = sorted({float(end * k / samples) for k in range(1, samples + 1)})


def steady(body, theta, w1=0.0, w2=0.0, w3=0.0):
    """The steady state with the centre at rest, and what is added to it."""
    ell, i1, i3, fillet = body
    s, c = math.sin(theta), math.cos(theta)
    radius, depth = 1 - fillet + fillet * s, ell + fillet * c
    n = (1 - fillet) * c - ell * s
    spin = s * math.sqrt(n * radius / (s * (i3 * n + (i1 - i3) * c * radius)))
    return theta, spin + w1, w2, depth / radius * spin + w3


def scenes():
    coin, paper, solid = tube(0.0, 0.0), tube(6.0, 0.8), tube(2.5, 0.0)
    disk = tube(0.0128 / 0.0751, 0.0)  # Euler's disk with a sharp rim
    low, edge = rounded(0.0128 / 0.0751, 0.05), tube(0.3, 0.0)

    yield Scene("coin, viscous contour", coin, {"viscous": 2e-3}, steady(coin, 0.3, w2=0.1), 6)
    yield Scene(
        "tube on its side, rolling resistance", paper, {"rolling": 0.01}, steady(paper, 1.35, w2=0.1), 12
    )
    yield Scene("cylinder on its side, drilling", solid, {"drilling": 0.02}, steady(solid, 1.2, w2=-0.1), 10)
    yield Scene("tube on its side, linear air", paper, {"air": 0.05}, steady(paper, 1.3, w2=0.05, w3=0.1), 12)
    yield Scene("cylinder on its end, quadratic air", solid, {"air2": 0.02}, steady(solid, 0.15, w2=0.2), 10)
    yield Scene("Euler's disk, air film", disk, {"film": 1e-4}, steady(disk, 0.2, w2=0.05), 8)
    yield Scene("Euler's disk, boundary layer", disk, {"layer": 5e-4}, steady(disk, 0.3, w2=0.1), 8)
    yield Scene("Euler's disk whirrs until it stops", disk, {"dry": 5e-3}, steady(disk, 0.3), 40, samples=20)
    yield Scene("coin at a thousandth stops", coin, {"dry": 1e-4}, steady(coin, 1e-3), 1, samples=32)
    low_start = steady(coin, 1.5e-3)
    yield Scene("coin at a thousandth, viscous", coin, {"viscous": 1e-6}, low_start, 0.4, samples=8)
    yield Scene("coin near the table, layer", coin, {"layer": 1e-6}, steady(coin, 4e-3), 0.4, samples=8)
    added = {"dry": 2e-3, "rolling": 1e-3}
    yield Scene("cylinder goes down through the ridge", solid, added, steady(solid, 0.3), 16)
    start = steady(edge, 0.5, w1=0.05, w2=0.1)
    yield Scene("disk on a smooth table", edge, {"dry": 0.01, "air": 5e-3}, start, 8, contact="smooth")
    smooth = {"rolling": 5e-3, "drilling": 5e-3}
    start = steady(solid, 1.2, w1=0.1, w2=-0.1)
    yield Scene("cylinder on a smooth table", solid, smooth, start, 8, contact="smooth")
    slipping = (*steady(paper, 1.3, w1=0.05), 0.4, -0.5)
    yield Scene(
        "tube from slip to roll", paper, {"dry": 2e-3, "air": 1e-3}, slipping, 6, contact="coulomb", mu=0.3
    )
    slipping = (*steady(disk, 0.6, w2=0.1), -0.3, 0.8)
    every = {"rolling": 5e-3, "drilling": 2e-3, "film": 2e-3}
    yield Scene("Euler's disk from slip to roll", disk, every, slipping, 5, contact="coulomb", mu=0.4)
    start = steady(low, 0.3, w2=0.1)
    yield Scene("rounded disk, dry and viscous", low, {"dry": 2e-3, "viscous": 2e-3}, start, 10)
    start = steady(low, 0.2, w2=0.02)
    yield Scene("rounded disk stops", low, {"dry": 0.01, "film": 1e-4}, start, 40, samples=20)
    yield Scene(
        "disk whirrs to its face", disk, {"viscous": 5e-3}, steady(disk, 0.2), 40, samples=40, face=True
    )
    yield Scene("Euler's disk slips at last", disk, {"dry": 0.02}, steady(disk, 0.3), 40, mu=0.35, samples=20)
    both = {"drilling": 0.01, "air2": 5e-3}
    yield Scene("cylinder lies down", solid, both, steady(solid, 1.3, w2=-0.6), 1, samples=8)
    every = dict(zip(LAWS, (2e-3, 1e-3, 1.5e-3, 1e-3, 2e-3, 1e-3, 5e-4, 3e-3), strict=True))
    yield Scene("cylinder with every loss", solid, every, steady(solid, 1.25, w2=-0.1), 8)
    wide = {"dry": 0.05}
    yield Scene(
        "disk stops and falls flat", disk, wide, steady(disk, 0.3), 9, samples=64, face=True, beyond=True
    )
    start = (1.2, -0.41, -0.2, -0.05)
    yield Scene("contact stops and goes on", disk, {"dry": 0.1}, start, 3.5, samples=7, beyond=True)
    start = (0.45, 0.3, 0.3, -0.5)
    yield Scene("drilling is held and goes on", tube(1.0, 0.0), {"drilling": 0.1}, start, 3.25)
    nodding = (0.7, 0.3, 0.3, 1.0)
    yield Scene("contact that turns back twice", tube(1.0, 0.0), {"dry": 5e-3, "viscous": 2e-3}, nodding, 3)


# The table.


def written(scene):
    """A motion as it stands in the file."""
    one, other = followed(scene, (Vectors, Momenta), follow)
    agreement = float(max(compared(one, other, angles=(9, 10))))
    return {
        "name": scene.name,
        "body": scene.body,
        "losses": [scene.losses.get(name, 0.0) for name in LAWS],
        "contact": scene.contact,
        "mu": scene.mu or None,
        "beyond": scene.beyond,
        "start": scene.start,
        "agreement": agreement,
        "rows": [[kind, *(decimal(x, 1e-35) for x in row)] for kind, row in other.rows],
    }


def main():
    precise(DIGITS)
    renew_json(HERE / "losses.json", scenes(), written, "motions", laws=LAWS, columns=["kind", *NAMES])


if __name__ == "__main__":
    main()
