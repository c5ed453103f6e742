"""Claimed errors of slipping motions: true over claimed, of `sc.roll` and of `sc.sweep.roll`.

Needs gmpy2, xarray and a C compiler; 2,000 motions take half an hour on one core. Motions of all kinds: tubes launched from pi/2, disks, cans, rounded bodies and balls, planar and spatial,
with Coulomb friction, also with a static coefficient that is larger, and with viscous friction; to t = 3 ..
50. Each is computed by `sc.roll` with tol = 1e-8, 1e-10, 1e-12 and the default, with poses at every other
motion, and by `sc.sweep.roll`.

All rows have the same truth: the reduced equations of tests/reference/slip_forms.py, which share nothing with
the library, in Taylor series of long doubles of order 20, whose steps err by 1e-20, in the variable tau
during a slip. slip_tape.py computes the series. The first `--check` truths are computed again with 40 digits;
the largest difference is printed.

The claim `error` covers theta, w1, w2, w3 at all times and the time and the state of the event; `pose_error`
covers phi, psi and the contact point. The slip, the heat and the times of the phases are compared with
`error`, which does not cover them. A ratio up to 10 is honest. A motion whose kinds of phases or end are not
the true ones counts as "other" if its claim is finite; an infinite claim claims nothing.
"""

import math
import time

import gmpy2
import numpy as np
import slip
from gmpy2 import mpfr
from judge import blocks
from phases import follow
from series import Tape, precise
from slip_forms import Reduced
from slip_model import Model
from slip_tape import Few, LongTape

import spincyl as sc
from kinds.phases import ENDINGS

DEFAULTS, FEW = {"count": 2000, "seed": 13, "show": 3}, "--count 100"
TOLERANCES = (1e-8, 1e-10, 1e-12, None)
BLOCK = 20
DIGITS = 28
KEPT = ("final", "end", "slip_time", "dissipated", "phases", "rolling_time", "rolling_theta", "rolling_w3")


class Quick(Few, Reduced):
    """The reduced equations, in long doubles."""

    cut, last, tiny = 0.6, 30, mpfr("1e-22")

    def equations(self, kind):
        self.tape = Tape if kind == "onset" else LongTape
        return super().equations(kind)

    def begun(self, y):
        """The state after the series by which a slip begins, if nothing has landed by then."""
        if y[4] <= 0 or (self.scene.side and gmpy2.cos(y[4]) <= 0):
            raise Jumps
        return y


class Truth:
    """The true motion, as doubles."""

    def __init__(self, scene, found):
        rows = [(kind, np.array([float(x) for x in row])) for kind, row in found.rows]
        self.scene = scene
        self.samples = [row for kind, row in rows if kind in ("sample", "end")]
        self.kind, self.last = rows[-1]
        self.begins = [
            (row[0], kind == "rolls") for kind, row in rows if kind in ("rolls", "passes", "slips")
        ]

    @property
    def ending(self):
        return ENDINGS[self.kind]


class Leaps(ArithmeticError):
    """The body does not press on the table at the start."""


class Jumps(ArithmeticError):
    """Something lands within the series by which a slip begins, in which landings are not detected."""


def exact(scene):
    precise(DIGITS)
    if Model(scene.body, scene.mu, scene.static).parts(scene.start[:4])[10] <= 0:
        raise Leaps
    return Truth(scene, follow(Quick(scene)))


def checked(scene):
    """The truth with 40 digits."""
    precise(slip.DIGITS)
    return Truth(scene, follow(Reduced(scene)))


# The draws.


def drawn(rng, kind, end):
    """A random scene."""
    if kind == "launched":
        body = slip.tube(rng.uniform(1.5, 9), rng.uniform(0, 0.95))
        w1 = rng.uniform(1, 5)
        w3 = rng.uniform(1.02, 2.0) * body[0] / (body[2] * w1)
        v_2 = -body[1] / body[0] * w1 * rng.choice([0.0, 0.5, 1.0])
        start = slip.moved(body, (slip.HALF_PI, w1, 0.0, w3), 0.0, v_2)
    elif kind == "hoop":
        body = slip.tube(0.0, rng.uniform(0, 1))
        v, spin = rng.uniform(0.5, 4), rng.uniform(-1, 6)
        start = (slip.HALF_PI, 0.0, 0.0, -spin, 0.0, v + spin)
    elif kind == "planar":
        body = slip.tube(rng.uniform(0.3, 12), rng.uniform(0, 1))
        balance = math.atan2(1.0, body[0])
        theta = balance * (1 + rng.choice([-1, 1]) * 10 ** rng.uniform(-2, -0.3))
        start = (theta, 0.0, rng.normal() * 0.2, 0.0, rng.normal() * rng.choice([0.0, 0.5]), 0.0)
    else:
        if kind == "disk":
            body = slip.tube(rng.uniform(0, 0.25), rng.choice([0.0, rng.uniform(0, 1)]))
        elif kind == "can":
            body = slip.tube(rng.uniform(0.3, 3), rng.choice([0.0, rng.uniform(0, 1)]))
        else:
            i1 = rng.uniform(0.3, 1.2)
            i3 = rng.uniform(0.4, 1.5) * i1
            rounded = kind == "rounded"
            ell = rng.uniform(0, 1.5) if rounded else rng.uniform(-0.5, 0.4)
            body = (ell, i1, i3, rng.uniform(0.05, 0.8) if rounded else 1.0)
        theta = rng.uniform(0.2, 1.45)
        w1, w2, w3 = rng.normal(size=3) * 10 ** rng.uniform(-0.5, 0.4)
        u = rng.normal(size=2) * 10 ** rng.uniform(-1.5, 0.5) * (rng.random() > 0.15)
        start = (theta, w1, 0.3 * w2, w3, *u)
    viscous = rng.random() < 0.2
    mu = 10 ** rng.uniform(-1.3, -0.1)
    static = mu * rng.uniform(1.02, 1.5) if rng.random() < 0.25 else mu
    law = "viscous" if viscous else "coulomb"
    scene = slip.Scene(
        kind, body, mu, start, end, law=law, static=mu if viscous else static, samples=int(rng.integers(1, 5))
    )
    scene.samples[-1] = scene.end
    return scene


def options(add):
    add("--check", type=int, default=10, help="truths that are computed again with 40 digits")


KINDS = ("launched", "launched", "hoop", "planar", "disk", "disk", "can", "can", "rounded", "ball")


def on_edge(scene):
    """The name of a separate row for hoops on edge, which are unstable where they slow down."""
    return ", hoop on edge" if scene.name == "hoop" else ""


def contact(scene):
    return sc.Viscous(scene.mu) if scene.law == "viscous" else sc.Coulomb(scene.mu, static=scene.static)


def line(scene, tol=None):
    """The Python call that computes the motion."""
    ell, i1, i3, fillet = scene.body
    round_rim = f", fillet={fillet!r}" if fillet else ""
    theta, w1, w2, w3, *u = scene.start
    start = f"sc.State({theta!r}, {w1!r}, {w2!r}, {w3!r}, slip=({u[0]!r}, {u[1]!r}))"
    said = "" if tol is None else f", tol={tol!r}"
    times = f"{scene.samples!r}, t0=0.0"
    of = f"sc.Body({ell!r}, {i1!r}, {i3!r}{round_rim})"
    return f"sc.roll({of}, {start}, {times}, contact={contact(scene)!r}{said})"


# The comparison.


def enter(tally, truth, tol, pose):
    """Adds one motion by sc.roll to the tally."""
    scene = truth.scene
    name = ("default" if tol is None else f"{tol:g}") + on_edge(scene)
    body = sc.Body(*scene.body[:3], fillet=scene.body[3])
    theta, w1, w2, w3, *u = scene.start
    state = sc.State(theta, w1, w2, w3, slip=tuple(u))
    want = "pose" if pose else ()
    said = line(scene, tol)
    try:
        m = sc.roll(body, state, scene.samples, t0=0.0, contact=contact(scene), tol=tol, want=want)
    except ValueError as e:
        tally.count(name, "refused", f"{e}: {said}")
        return None
    # the first phase follows from the start, also where u = 0 there
    kinds = [phase.kind == "rolling" for phase in m.phases][1:]
    if m.status != truth.ending or kinds != [rolls for _, rolls in truth.begins]:
        if math.isinf(m.error):
            tally.count(name, "other phases or end, but inf is claimed")
        else:
            tally.count(
                name,
                "other phases or end",
                f"{m.error:.2g} claimed, {m.message}; true: {truth.begins}, "
                f"{truth.kind} at {truth.last[0]!r}: {said}",
            )
        return m
    rows = np.array(truth.samples).reshape(-1, 12)[: m.t.size]
    if len(rows) != len(truth.samples) or m.t.size != len(truth.samples):
        tally.count(name, "other number of times", said)
        return m

    def apart(a, b):
        return float(np.max(np.abs(np.asarray(a) - b), initial=0.0))

    states = apart(m.y.T, rows[:, 1:5])
    tally.add(f"{name}: states", states, m.error, said)
    tally.add(f"{name}, aside: slip", apart(m.slip, rows[:, 5:7]), m.error, said)
    tally.add(f"{name}, aside: heat", apart(m.dissipated, rows[:, 7]), m.error, said)
    times = apart([phase.time for phase in m.phases][1:], [t for t, _ in truth.begins])
    tally.add(f"{name}, aside: times of phases", times, m.error, said)
    if m.event:
        e = m.event.state
        tally.add(f"{name}: time of the event", abs(m.event.time - truth.last[0]), m.error, said)
        tally.add(
            f"{name}: state of the event", apart((e.theta, e.w1, e.w2, e.w3), truth.last[1:5]), m.error, said
        )
    if pose and m.t.size:
        angles = apart(np.column_stack([m.phi, m.psi]), rows[:, 8:10])
        place = apart(m.contact_point, rows[:, 10:12])
        tally.add(f"{name}: angles", angles, m.pose_error, said)
        tally.add(f"{name}: contact point", place, m.pose_error, said)
    return m


def swept(scenes, tol, threads=1):
    """The motions by one sweep, as columns by name."""
    ell, i1, i3, fillet = np.array([s.body for s in scenes]).T
    theta, w1, w2, w3, u_h, u_2 = np.array([s.start for s in scenes]).T
    mu, static = np.array([(s.mu, s.static) for s in scenes]).T
    table = sc.Viscous(mu) if scenes[0].law == "viscous" else sc.Coulomb(mu, static=static)
    bodies, states = sc.Body(ell, i1, i3, fillet=fillet), sc.State(theta, w1, w2, w3, slip=(u_h, u_2))
    found = sc.sweep.roll(bodies, states, scenes[0].end, contact=table, tol=tol, want=KEPT, threads=threads)
    return {key: np.atleast_1d(value.values) for key, value in found.items()}


def sweep(tally, truths, singles, tol):
    """Compares sweeps with the truth, with `sc.roll`, and with other sweeps bit for bit."""
    name = f"sweep {tol:g}"
    for law in ("coulomb", "viscous"):
        known = [(t, m) for t, m in zip(truths, singles, strict=True) if t.scene.law == law]
        if not known:
            continue
        scenes = [t.scene for t, _ in known]
        found = swept(scenes, tol)
        same_bits(tally, name, scenes, tol, found)
        for i, (truth, m) in enumerate(known):
            one = {key: value[i] for key, value in found.items()}
            said, name = f"tol={tol!r}: {line(truth.scene)}", f"sweep {tol:g}{on_edge(truth.scene)}"
            if m is None:
                if one["status"] not in (sc.sweep.Status.INVALID, sc.sweep.Status.PAINLEVE):
                    tally.count(name, "answers where roll refuses", said)
                continue
            error = float(one["error"])
            final = np.array([one[k] for k in ("theta", "w1", "w2", "w3")])
            if one["status"] != truth.ending or (one["phases"] != len(truth.begins) + 1):
                if math.isinf(error):
                    tally.count(name, "other phases or end, but inf is claimed")
                else:
                    text = f"{error:.2g} claimed; status {one['status']}, {one['phases']:g} phases: {said}"
                    tally.count(name, "other phases or end", text)
            else:
                tally.add(f"{name}: final", float(np.abs(final - truth.last[1:5]).max()), error, said)
                tally.add(f"{name}: end", abs(float(one["end"]) - truth.last[0]), error, said)
                tally.add(f"{name}, aside: heat", abs(float(one["dissipated"]) - truth.last[7]), error, said)
            if one["status"] != m.status or one["phases"] != len(m.phases):
                finite = math.isfinite(error) and math.isfinite(m.error)
                word = f"not as sc.roll{', both claims finite' if finite else ''}"
                tally.count(name, word, said if finite else None)
                continue
            s = m.event.state if m.event else None
            there = (s.theta, s.w1, s.w2, s.w3) if s else m.y[:, -1]
            apart = float(np.abs(final - np.array(there)).max())
            tally.add(f"{name}: from sc.roll, of both claims", apart, error + m.error, said)


def same_bits(tally, name, scenes, tol, found):
    """Checks that the bits do not depend on threads, order and neighbours."""

    def compare(what, other, places):
        tally.count(name, f"compared bit for bit, {what}")
        for key, value in found.items():
            if value[places].tobytes() != other[key].tobytes():
                bad = [
                    i
                    for i, a, b in zip(places, value[places], other[key], strict=True)
                    if a.tobytes() != b.tobytes()
                ]
                tally.count(name, f"other bits, {what}", f"{key}: {line(scenes[bad[0]])}")
                return

    n = len(scenes)
    for threads in (2, 3):
        compare(f"{threads} threads", swept(scenes, tol, threads), np.arange(n))
    order = np.random.default_rng(n).permutation(n)
    compare("in another order", swept([scenes[i] for i in order], tol), order)
    for i in (0, n - 1):
        compare("alone", swept([scenes[i]], tol), np.array([i]))


def same(truth, other):
    """Largest difference of two truths."""
    if other.kind != truth.kind or len(other.begins) != len(truth.begins):
        raise ArithmeticError(f"two truths: {line(truth.scene)}")
    rows = [*zip(truth.samples, other.samples, strict=True), (truth.last, other.last)]
    return max(float(np.abs(a - b)[:8].max()) for a, b in rows)


def judge(given, tally):
    rng = np.random.default_rng(given.seed)
    within, left, spent = 0.0, given.check, 0.0
    for block, count in blocks(given, BLOCK):
        end = float(np.round(10 ** rng.uniform(math.log10(3), math.log10(50)), 3))
        truths, singles = [], []
        for i in range(count):
            scene = drawn(rng, str(rng.choice(KINDS)), end)
            begun = time.perf_counter()
            try:
                truth = exact(scene)
            except (ArithmeticError, AssertionError, ValueError) as e:
                tally.count("without a truth", type(e).__name__)
                continue
            finally:
                spent += time.perf_counter() - begun
            if left > 0:
                left -= 1
                within = max(within, same(truth, checked(scene)))
            tally.count("truths", f"{'viscous' if scene.law == 'viscous' else 'Coulomb'}, {truth.kind}")
            pose = (block * BLOCK + i) % 2 == 1
            found = [enter(tally, truth, tol, pose) for tol in TOLERANCES]
            truths.append(truth)
            singles.append(found[-1])
        for tol in (1e-8, 1e-10, 1e-12):
            sweep(tally, truths, singles, tol)
    tally.note(
        f"{spent:.0f} s for the truths; the first {given.check} differ by at most {within:.1e} from those of 40 digits"
    )
