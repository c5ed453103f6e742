"""Writes slope_face.json: motions of a body on its face on a tilted table, the reference of their tests.

    python tests/reference/slope_face.py [name ...]       those whose names begin so; or all

It needs gmpy2, numpy and mpmath. One scene takes longer, and the table does not have it yet: "spun in place, topples as
it runs away", which leaves the face at a fold of the law of the pressure.

Every motion is made from two formulations, `Vectors` of slope_face_vectors.py and `Closed` of slope_face_closed.py; they
share the law of the pressure, the steps of gauss.py and the order of events. The first has sums over the face and
Newton's and Euler's equations in the full gravity, in time; the other one closed means, or closed solutions, in units
in which the table is level and pulls.

The slope is in radians, x points downhill; g is the full gravity. A start is told from the rim's point -(cos phi, sin phi)
(theta, w1, w2, w3, and the slip along the lean and across), which is at `place`. A row is a checkpoint: the time, theta,
w1, w2, w3, the slip of the told point along the lean and across, the heat of friction, the work of the losses, phi, psi,
the place of the told point, and the friction along the lean and across (nan but on the face). What is there:

    sample    nothing                  topples   it leaves the face, over a point of the rim that slips
    rests     the end of the motion    tips      the same of one that does not slip
    end       the last time            border    only a part of the ring presses, or again all of it

Inputs are exact doubles; results are decimal, to 25 digits, or to 18 where `digits` says so: then sums over the face have
64 bits. `agreement` is the largest difference of both formulations in all numbers of a motion, over 1 or the number if
that is more.
"""

import pathlib
from types import SimpleNamespace

import gmpy2
from face import Now, solid, tube
from gmpy2 import mpfr
from lying_forms import LAWS
from mpmath import mp
from series import precise
from slope_face_closed import Closed
from slope_face_vectors import Vectors
from tables import moved, renew_json

HERE = pathlib.Path(__file__).parent
DIGITS = 50
NAMES = "t theta w1 w2 w3 u_h u_2 heat work phi psi x y f_h f_2".split()
ZERO, NAN = mpfr(0), mpfr("nan")


class Scene:
    """A body (ell, I1, I3, fillet), its contact, and a start: the spin, and the velocity of the centre or the slip."""

    def __init__(self, name, body, slope, mu, w, samples, **more):
        self.name, self.body, self.mu, self.slope = name, [float(x) for x in body], float(mu), float(slope)
        self.law, self.face = more.get("law", "coulomb"), more.get("face", "ring")
        self.losses, self.phi = more.get("losses", {}), float(more.get("phi", 0))
        self.place = [float(x) for x in more.get("place", (0, 0))]
        ell, i1, i3, rho = self.body
        a = 1 - rho
        self.carried = mpfr(1) - mpfr(rho), mpfr(ell) + mpfr(rho), mpfr(i1), mpfr(i3)
        # the velocity of the centre, to doubles
        v = complex(*more.get("v", (0, 0))) * complex(mp.expj(-self.phi))
        self.start = [0.0, 0.0, 0.0, float(w), v.real, v.imag - a * w]
        self.samples = [float(t) for t in samples]
        self.fold = more.get("fold", False)
        self.to_rest, self.digits = more.get("to_rest", True), more.get("digits", 18)


def pointing(angle):
    return gmpy2.cos(angle), gmpy2.sin(angle)


def told(model, now):
    """The numbers of a row."""
    h, s, c = pointing(now.phi), gmpy2.sin(now.theta), gmpy2.cos(now.theta)
    if now.rim:
        rates, force = [now.w1, now.w2, now.w3, now.u_h, now.u_2], (NAN, NAN)
    else:

        def turned(v):
            return v[0] * h[0] + v[1] * h[1], v[1] * h[0] - v[0] * h[1]

        along, across = turned(now.velocity)
        rates, force = [ZERO, ZERO, now.w, along, across - model.a * now.w], turned(model.friction(now))
    out = model.a * c - (model.z - model.rho) * s
    contact = [p - out * q for p, q in zip(now.place, h, strict=True)]
    return [now.t, now.theta, *rates, now.heat, now.work, now.phi, now.psi, *contact, *force]


def begun(model):
    """The start."""
    scene, phi = model.scene, mpfr(model.scene.phi)
    _, _, _, w, u_h, u_2 = map(mpfr, scene.start)
    h, across = pointing(phi), u_2 + model.a * w
    return Now(
        t=ZERO, theta=ZERO, w1=ZERO, w2=ZERO, w3=w, w=w, u_h=ZERO, u_2=ZERO, heat=ZERO, work=ZERO, phi=phi,
        psi=ZERO, rim=False, place=[mpfr(p) + model.a * q for p, q in zip(scene.place, h, strict=True)],
        velocity=[u_h * h[0] - across * h[1], u_h * h[1] + across * h[0]],
    )  # fmt: skip


def over(now, phi, **more):
    """The same with the lean to another side."""
    return now.at(phi=phi, psi=now.psi + now.phi - phi, w3=now.w, rim=True, **more)


def follow(model):
    """The rows of a scene."""
    scene, now, rows = model.scene, begun(model), []
    times, pi = list(map(mpfr, scene.samples)), gmpy2.const_pi()
    v, tall = gmpy2.hypot(*now.velocity), model.z / model.a

    def add(name, at):
        last = name == "sample" and not (times or scene.to_rest or scene.fold)
        rows.append(("end" if last else name, told(model, at)))

    pull = gmpy2.tan(mpfr(scene.slope))
    lets_go = not v and not now.w and model.mu < pull and model.mu * tall < 1
    if scene.law == "smooth" or (scene.law == "coulomb" and lets_go):
        for at in straight(now, times, scene):
            times.pop(0)
            add("sample", at)
        return rows
    if scene.law == "coulomb" and not v and not now.w:
        # from rest: whether the point over which it tips slips is found by the accelerations as it begins
        assert tall * pull > 1
        sticks = holds(model, pull)
        now = over(now, pi)
        add("tips" if sticks else "topples", now)
        found = model.tipping(now, sticks, times)
    elif scene.law == "coulomb" and model.mu * tall > 1 and v > 1.2 * model.a * abs(now.w):
        if now.w:
            found = in_space(model, now, times)
        else:
            now = over(now, pi, u_h=-now.velocity[0])
            add("topples", now)
            found = model.tipping(now, False, times)
    else:
        for name, at in model.slide(now, times):
            if name == "topples":
                now = over(at, pi, u_h=-at.velocity[0])
                add(name, now)
                for what, there in model.tipping(now, False, times):
                    add(what, there)
                return rows
            add(name, at)
        if scene.fold:
            at = model.fold(at)
            v, edge = gmpy2.hypot(*at.velocity), model.a * abs(at.w)
            out = gmpy2.mpc(*at.velocity) * gmpy2.exp(gmpy2.mpc(0, gmpy2.asin(model.a * at.w / v)))
            slip = -gmpy2.sqrt(v * v - edge * edge)
            add("topples", over(at, gmpy2.atan2(out.imag, out.real) + pi, u_h=slip))
        return rows
    for what, at in found:
        add(what, at)
    return rows


def holds(model, pull):
    """Whether the lower point of a body that begins to tip does not slip."""
    a, z = model.a, model.z
    bend = (z * pull - a) / (model.i1 + a * a + z * z)
    return pull - z * bend <= model.mu * (1 + a * bend)


def straight(now, times, scene):
    """It falls downhill and turns on, without friction; or slides down from rest."""
    downhill, level = gmpy2.sin(mpfr(scene.slope)), gmpy2.cos(mpfr(scene.slope))
    drag = mpfr(scene.mu) * level
    pull = downhill - drag
    for t in list(times):
        (x, y), (vx, vy), way = now.place, now.velocity, pull * t * t / 2
        yield now.at(
            t=t, place=[x + vx * t + way, y + vy * t], velocity=[vx + pull * t, vy], heat=drag * way,
            psi=now.psi + now.w * t,
        )  # fmt: skip


def in_space(model, now, times):
    """Topples as it turns, made with the units of the level table by both formulations."""
    slow = gmpy2.sqrt(gmpy2.cos(mpfr(model.scene.slope)))

    def scaled(at, f):
        rates = {name: getattr(at, name) * f for name in ("w", "w1", "w2", "w3", "u_h", "u_2")}
        return at.at(t=at.t / f, velocity=[x * f for x in at.velocity], heat=at.heat * f * f, **rates)

    for name, at in model.topple(scaled(now, 1 / slow), [t * slow for t in times]):
        if name == "sample":
            times.pop(0)
        yield name, scaled(at, slow)


def record(model):
    rows = follow(model)
    return SimpleNamespace(rows=rows, steps=model.steps, strayed=getattr(model, "strayed", 0))


def scenes():
    coin, can, tall, pillar = solid(0.1), tube(0.75), tube(2.0), solid(2.0)
    yield Scene("coin spun in place", coin, 0.1, 0.3, 3, [1, 3, 5])
    yield Scene("tube thrown across with spin", can, 0.12, 0.25, 1, [2, 4, 6], v=(0, 1.2), phi=0.6)
    up = {"v": (-1, 0.3), "phi": -1.0, "place": (0.5, -0.2)}
    yield Scene("tube thrown uphill turns clockwise", can, 0.15, 0.3, -1.5, [1, 2, 4], **up)
    rounded = (0.6, 0.37, 0.48, 0.25)
    steep = {"v": (0.2, -0.3), "phi": 2.0, "to_rest": False}
    yield Scene("solid with a fillet slides for good", rounded, 0.3, 0.15, 2, [1, 2, 4, 6], **steep)
    block = solid(0.8)
    yield Scene("block thrown across", block, 0.2, 0.4, 0, [1, 2, 3], v=(0.2, 1), digits=25)
    yield Scene(
        "block thrown uphill slides for good",
        block,
        0.4,
        0.3,
        0,
        [1, 2, 4],
        v=(-1, 0.5),
        to_rest=False,
        digits=25,
    )
    yield Scene("part of the ring presses", tall, 0.1, 0.45, 1, [1, 2, 3], v=(0.3, 1.2), to_rest=False)
    yield Scene("linear air", can, 0.12, 0.25, 2, [1, 3, 5], v=(0.3, 0.4), losses={"air": 0.05})
    film = {"law": "viscous", "to_rest": False, "digits": 25}
    yield Scene("viscous", tall, 0.2, 0.3, 2, [1, 3, 6, 12], v=(0.5, 0.6), phi=0.4, **film)
    yield Scene("viscous, topples", tall, 0.6, 0.3, 0, [2, 4, 6, 7], v=(0.25, 0), **film)
    yield Scene("let go on a steep slope", can, 0.4, 0.3, 0, [1, 3], phi=0.5, to_rest=False, digits=25)
    yield Scene(
        "smooth", can, 0.3, 0, 2, [1, 3], v=(-0.4, 0.2), phi=0.5, law="smooth", to_rest=False, digits=25
    )
    yield Scene("disc spun in place", solid(0.3), 0.08, 0.3, 2, [1, 2], face="disc")
    planar = {"to_rest": False, "digits": 25}
    yield Scene("topples as it slides down", pillar, 0.2, 0.7, 0, [0.2, 0.5, 0.8], v=(2, 0), **planar)
    yield Scene(
        "topples as it slides across with spin",
        pillar,
        0.2,
        0.7,
        1.5,
        [0.2, 0.4, 0.6, 0.8],
        v=(0, 3),
        **planar,
    )
    spun = {"fold": True, "to_rest": False}
    yield Scene("spun in place, topples as it runs away", tall, 0.4, 0.6, 2, [0.5, 1, 1.5, 2, 2.1], **spun)
    yield Scene("tips over from rest", tall, 0.6, 0.9, 0, [0.5, 1, 2], phi=0.3, place=(0.5, 0.1), **planar)
    yield Scene("tips over from rest and slips", tall, 0.7, 0.52, 0, [0.5, 1, 2], **planar)


def made(scene):
    keys = "name law face slope phi place body mu start digits losses"
    return moved(scene, (Vectors, Closed), record, NAMES, keys, LAWS)


def main():
    precise(DIGITS)
    mp.dps = DIGITS + 10
    renew_json(HERE / "slope_face.json", scenes(), made, "motions", columns=["kind", *NAMES], laws=LAWS)


if __name__ == "__main__":
    main()
