"""Writes face.json: motions of a body on its face, and to it and from it, the reference of their tests.

    python tests/reference/face.py [name ...]       those whose names begin so; or all

It needs gmpy2 and mpmath, and half an hour for those of the table on one core.

Every motion is made from two formulations, `Vectors` of face_vectors.py and `Closed` of face_closed.py; they share the
law of the pressure, the steps of gauss.py and the order of the phases. The first has sums over the face and Newton's
and Euler's equations in the laboratory, in time; the other one closed means, logarithms of the rates, and of a rim the
reduced or Lagrange's equations.

A row is a checkpoint: what is there, the time, theta, w1, w2, w3, the slip along the lean and across of the told point
of the rim, the height of the lowest point, the heat of friction and landings, the work of the losses, phi, psi, the
place of the centre (all 0 at the start), and the friction along the lean and across (nan but on the face). On the face
the lean has the direction that it had at the start, or when it landed. What is there:

    sample    nothing                          topples   it leaves the face, over a point of the rim
    pushed    a flat landing, and off again    rolls, slips, passes   of one rim, as in slip.py
    face      a flat landing, and it stays     rocks     a planar landing: the other point carries on
    border    only a part of the ring presses, or again all of it
    straight  the turning has ended            stands    a planar landing that stays
    rests     the end of the motion            rocked    infinitely many landings are over
    end       the last time

Inputs are exact doubles; results are decimal, to 25 digits, or to 18 where `digits` says so: then the first formulation
adds with 64 bits. `agreement` is the largest difference of both formulations in all numbers of a motion, over 1 or the
number if that is more. Four scenes take longer, and the table does not have them yet: those of which a part of the
ring presses ("part", "more and more", "spin keeps"), and "disc".
"""

import pathlib
from types import SimpleNamespace

import gmpy2
from face_closed import Closed
from face_vectors import Vectors
from gmpy2 import mpfr
from lying_forms import LAWS
from mpmath import mp
from series import precise
from tables import moved, renew_json

HERE = pathlib.Path(__file__).parent
DIGITS = 50
NAMES = "t theta w1 w2 w3 u_h u_2 height heat work phi psi x y f_h f_2".split()
SETTLED = mpfr("1e-13")  # a rate of landing below which the rest of a rocking is summed
STILL = mpfr("1e-14")  # the same of bounces


class Now:
    """A state."""

    def __init__(self, **fields):
        self.__dict__.update(fields)

    def at(self, **fields):
        return Now(**{**self.__dict__, **fields})


class Scene:
    """A body (ell, I1, I3, fillet), its contact, and a start told from the rim (theta, w1, w2, w3, u_h, u_2) with phi = 0."""

    def __init__(self, name, body, mu, start, times, **more):
        self.name, self.body, self.mu = name, [float(x) for x in body], float(mu)
        self.law, self.face = more.get("law", "coulomb"), more.get("face", "ring")
        self.losses, self.restitution = more.get("losses", {}), float(more.get("restitution", 0))
        self.height, self.lift = float(more.get("height", 0)), float(more.get("lift", 0))
        self.static = float(more.get("static", mu))
        ell, i1, i3, rho = self.body
        self.carried = mpfr(1) - mpfr(rho), mpfr(ell) + mpfr(rho), mpfr(i1), mpfr(i3)
        self.start = [float(x) for x in start]
        self.samples = [float(t) for t in times]
        self.to_rest, self.digits = more.get("to_rest", True), more.get("digits", 25)
        self.brief = mpfr("0.02")


def told(model, now, aloft=False):
    """The numbers of a row."""
    if now.theta or now.w2 or now.rim:
        slip = [now.w1, now.w2, now.w3, now.u_h, now.u_2]
        force = [mpfr("nan")] * 2
    else:
        h = gmpy2.cos(now.phi), gmpy2.sin(now.phi)

        def turned(v):
            return v[0] * h[0] + v[1] * h[1], v[1] * h[0] - v[0] * h[1]

        along, across = turned(now.velocity)
        slip = [mpfr(0), mpfr(0), now.w, along, across - model.a * now.w]
        force = [mpfr("nan")] * 2 if aloft else turned(model.friction(now))
    return [now.t, now.theta, *slip, now.height, now.heat, now.work, now.phi, now.psi, *now.place, *force]


def follow(model):
    """The rows of a scene."""
    scene, rows = model.scene, []
    theta, w1, w2, w3, u_h, u_2 = map(mpfr, scene.start)
    zero, a = mpfr(0), model.a
    now = Now(
        t=zero,
        place=[zero, zero],
        velocity=[u_h, u_2 + a * w3],
        w=w3,
        phi=zero,
        psi=zero,
        heat=zero,
        work=zero,
        theta=theta,
        w1=w1,
        w2=w2,
        w3=w3,
        u_h=u_h,
        u_2=u_2,
        height=mpfr(scene.height),
        rim=False,
    )
    times, rate = list(scene.samples), -mpfr(scene.lift)
    kind = "rim" if theta or w2 else "air" if scene.height or scene.lift else "face"
    lam = model.mu * model.z / a
    rocked = []

    def add(name, at, aloft=False):
        if name == "sample":
            times.pop(0)
            if not times and not scene.to_rest:
                name = "end"
        rows.append((name, told(model, at, aloft)))

    while True:
        if kind == "air":
            # falls with `rate`
            height = now.height
            left = -rate + gmpy2.sqrt(rate * rate + 2 * height)
            while times and mpfr(times[0]) < now.t + left:
                d = mpfr(times[0]) - now.t
                add(
                    "sample",
                    now.at(
                        t=now.t + d,
                        place=[p + v * d for p, v in zip(now.place, now.velocity, strict=True)],
                        psi=now.psi + now.w * d,
                        height=height - rate * d - d * d / 2,
                    ),
                    aloft=True,
                )
            rate += left
            now = now.at(
                t=now.t + left,
                place=[p + v * left for p, v in zip(now.place, now.velocity, strict=True)],
                psi=now.psi + now.w * left,
                height=zero,
            )
            e = mpfr(scene.restitution)
            last = rate * e < STILL
            impulse = rate * (1 + e) / (1 - e) if last else rate * (1 + e)
            over = 2 * e * rate / (1 - e) if last else 0
            for what, at in model.slide(now, impulse=impulse):
                if what not in ("pushed", "rests"):
                    continue
                now = at
            rate, lost = rate * e, rate * rate * (1 - (0 if last else e * e)) / 2
            now = now.at(heat=now.heat + lost, t=now.t + over)
            if last:
                kind = "face"
                add("face", now)
            elif rate > scene.brief:
                rows.append(("pushed", told(model, now, True)))
            rate = -rate
        elif kind == "face":
            v, s = gmpy2.hypot(*now.velocity), a * abs(now.w)
            if lam > 1 and v > s * mpfr("1.2") and scene.law == "coulomb":
                for what, at in model.topple(now, times):
                    add(what, at)
                return rows
            for what, at in model.slide(now, list(times)):
                add(what, at)
                now = at
            return rows
        else:
            for what, at in model.rim(now, list(times)):
                now = at
                if what in ("passes", "rolls", "slips") and rocked:
                    continue
                if what != "lands":
                    add(what, now)
            if not times and not scene.to_rest:
                return rows
            fall = now.w2
            what, now = model.land(now)
            if what == "stands":
                add(what, now)
                kind = "face"
                continue
            if fall > scene.brief:
                add(what, now)
            rocked.append((fall, [now.t, *now.place, now.heat, *now.velocity]))
            earlier = rocked[-3] if len(rocked) > 2 else None
            if fall < SETTLED and earlier is not None:
                ratio = fall / earlier[0]
                t, x, y, heat, vx, _vy = (
                    p + (p - q) * ratio / (1 - ratio) for p, q in zip(rocked[-1][1], earlier[1], strict=True)
                )
                vx = zero if abs(vx) < 1e-11 else vx
                now = now.at(t=t, place=[x, y], heat=heat, velocity=[vx, zero], theta=zero, w2=zero, u_h=zero)
                add("rocked", now)
                kind = "face"


def record(model):
    rows = follow(model)
    return SimpleNamespace(rows=rows, steps=model.steps, strayed=getattr(model, "strayed", 0))


def moving(body, v, w, x=0.0):
    """A start on the face with this velocity of the centre."""
    return [0, 0, 0, w, v[0], v[1] - (1 - body[3]) * w]


def solid(height):
    return (height, 0.25 + height**2 / 3, 0.5, 0.0)


def tube(height):
    return (height, 0.41 + height**2 / 3, 0.82, 0.0)


def scenes():
    can, tall, pillar = tube(0.75), tube(2.0), solid(2.0)
    few = {"digits": 18}
    yield Scene("tube slides and spins to rest", can, 0.25, moving(can, (1.5, 0), 1), [2, 4, 6, 7.4], **few)
    low = tube(0.5)
    yield Scene("tube turns clockwise, aslant", low, 0.3, moving(low, (-0.2, 0.35), -0.9), [1, 2, 3], **few)
    rounded = (0.6, 0.37, 0.48, 0.15)
    yield Scene("solid with a fillet", rounded, 0.2, moving(rounded, (1, 0.5), 2), [1, 3, 6], **few)
    block = solid(0.8)
    yield Scene("solid on its ring", block, 0.25, moving(block, (1.5, 0), 1), [1, 3, 6], **few)
    yield Scene("part of the ring presses", tall, 0.45, moving(tall, (1.5, 0), 1), [1, 2, 3], **few)
    glass = tube(1.4)
    yield Scene("more and more of the ring presses", glass, 0.5, moving(glass, (2, 0.5), 1), [1, 2, 4], **few)
    yield Scene(
        "topples as it slides", pillar, 0.7, moving(pillar, (3, 0), 1.5), [0.2, 0.4, 0.6, 0.8], to_rest=False
    )
    narrow = (1.8, 0.41 + 4 / 3, 0.82, 0.2)
    yield Scene("spin keeps it down", narrow, 0.48, moving(narrow, (0.4, 0), 1), [0.5, 1, 1.5], **few)
    yield Scene("pillar rocks to rest", pillar, 0.9, (0.1, 0, 0, 0, 0, 0), [1, 2, 3, 4, 5])
    yield Scene("pillar rocks as it slips", pillar, 0.3, (0.15, 0, 0, 0, 0, 0), [1, 2, 3])
    flat = solid(0.4)
    yield Scene("planar landing that stays and slides", flat, 0.3, (0.2, 0, 0, 0, 0.5, 0), [0.3, 0.8, 1.2])
    dropped = {"height": 0.08, "restitution": 0.5, **few}
    yield Scene("dropped flat, bounces", can, 0.25, moving(can, (1.5, 0), 1), [0.2, 0.7, 3, 5], **dropped)
    tossed = {"height": 0.3, "lift": 0.5, "restitution": 0.3, **few}
    coin = solid(0.1)
    yield Scene("coin tossed flat", coin, 0.2, moving(coin, (0.5, -0.6), 3), [0.5, 1.5, 2.2, 4], **tossed)
    still = {"height": 0.2, "lift": -0.1, "restitution": 0.0}
    yield Scene("thrown down flat, stays", can, 0.25, moving(can, (0, 0.9), -0.5), [0.3, 1, 2], **still)
    puck = tube(0.6)
    yield Scene(
        "drilling ends the turning first",
        puck,
        0.2,
        moving(puck, (1.2, 0), 0.4),
        [0.5, 2, 4],
        losses={"drilling": 0.15},
    )
    yield Scene("linear air", can, 0.25, moving(can, (1.2, 0.4), 1.5), [1, 3, 5], losses={"air": 0.05}, **few)
    yield Scene("viscous", tall, 0.2, moving(tall, (1, 0), 2), [1, 2, 3, 4, 5], law="viscous", to_rest=False)
    lap = solid(0.3)
    yield Scene("disc", lap, 0.3, moving(lap, (0.4, 0), 1), [0.5, 1, 1.4], face="disc")
    yield Scene(
        "disc only spins, with drilling",
        lap,
        0.3,
        moving(lap, (0, 0), 2),
        [1, 2],
        face="disc",
        losses={"drilling": 0.1},
    )
    yield Scene("pillar kicked falls back", pillar, 0.9, (0, 0, -0.2, 0, 0, 0), [0.5, 1.5, 3, 5])
    yield Scene(
        "pillar kicked goes over", pillar, 0.9, (0, 0, -0.3, 0, 0, 0), [0.5, 1, 1.5, 2], to_rest=False
    )


def made(scene):
    keys = "name law face body mu static losses restitution start height lift"
    return moved(scene, (Vectors, Closed), record, NAMES, keys, LAWS)


def main():
    precise(DIGITS)
    mp.dps = DIGITS + 10
    renew_json(HERE / "face.json", scenes(), made, "motions", columns=["kind", *NAMES], laws=LAWS)


if __name__ == "__main__":
    main()
