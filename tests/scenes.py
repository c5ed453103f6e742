"""Random unusual scenes, to compare many motions at once with each of them alone.

A scene is a family of motions with the same kind of contact, loss laws and times: `sc.sweep.roll` computes
it at once, `sc.roll` one motion after the other. Bodies, coefficients and starts differ within a family.
"""

import math
import warnings
from typing import Any, NamedTuple

import numpy as np

import spincyl as sc
from spincyl.sweep import Status

#: by public names alone, since benches/beside.py draws the same scenes for older builds
LAWS = tuple(x for x in vars(sc.loss).values() if isinstance(x, type) and sc.loss.Law in x.__bases__)
CONTACTS = ("rolling", "mu", "smooth", "coulomb", "viscous")
#: "patch" is drawn only where it is named, so that the other scenes stay what they were
SLIPPING = ("coulomb", "viscous", "patch")
NUMBERS = ("theta", "w1", "w2", "w3")
#: only one of the two computations may reach an end so close to the last time
LATE = 1e-6


def wants_a_face(law):
    """Whether a law is refused for a ball, which has no flat face above the table."""
    try:
        sc.roll(sc.Body.ball(0.0, 0.4, 0.4), sc.State(1.0, 0.0, 0.0, 0.0), 0.0, losses=law(1e-3))
    except ValueError as why:
        return "flat face" in str(why)
    return False


FACES = tuple(k for k, law in enumerate(LAWS) if wants_a_face(law))


class Scene(NamedTuple):
    """A family of motions with one kind of contact."""

    contact: str
    bodies: np.ndarray  # (count, 4): ell, i1, i3, fillet
    starts: np.ndarray  # (count, 6): theta, w1, w2, w3, slip along and across
    table: np.ndarray  # (count, 2): mu or c, static; (count, 3) with the radius of a patch
    losses: dict[int, np.ndarray]  # coefficients by the index of the law
    times: np.ndarray
    tol: float
    how: dict[str, Any]
    theta_end: np.ndarray | None = None  # (count,); None: the default of each body

    def contact_of(self, i):
        """Contact and settings of motion i, or of all of them."""
        if self.contact in ("rolling", "smooth"):
            return {"contact": self.contact}
        if self.contact == "mu":
            return {"mu": float(self.table[0, 0])}
        a, b, *patch = self.table[i].T
        if self.contact == "viscous":
            return {"contact": sc.Viscous(a)}
        return {"contact": sc.Coulomb(a, static=b, **({"patch": patch[0]} if patch else {}))}

    def asked(self, i):
        """Body, state and settings of motion i, or of all of them."""
        how = self.how | self.contact_of(i)
        ends = {} if self.theta_end is None else {"theta_end": self.theta_end[i]}
        body = sc.Body(*self.bodies[i].T[:3], fillet=self.bodies[i].T[3], **ends)
        slips = self.contact in SLIPPING
        state = sc.State(*self.starts[i].T[:4], slip=tuple(self.starts[i].T[4:]) if slips else None)
        if self.losses:
            laws = [LAWS[k](x[i]) for k, x in self.losses.items()]
            how["losses"] = sum(laws[1:], start=laws[0])
        return body, state, how

    def call(self, i):
        """A line of Python that computes motion i."""
        body, state, how = self.asked(i)
        state = " ".join(repr(state).split())
        given = ", ".join(f"{name}={value!r}" for name, value in how.items())
        times = float(self.times[-1]) if self.times.size == 1 else self.times.tolist()
        return f"sc.roll({body!r}, {state}, {times!r}, {given})".replace("sc.sc.", "sc.")


def log_uniform(rng, low, high, count=None):
    return 10.0 ** rng.uniform(math.log10(low), math.log10(high), count)


def typed(rng, x):
    """The numbers, some of them rounded to one decimal as people type them."""
    return np.where(rng.random(np.shape(x)) < 0.3, np.round(x, 1), x)


def draw_bodies(rng, count, faces):
    """Tubes, disks, bodies of any moments, rounded bodies, balls; without balls if `faces`."""
    ell = typed(rng, rng.uniform(0, 3, count))
    ell = np.select(
        [rng.random(count) < 0.2, rng.random(count) < 0.1], [0.0, log_uniform(rng, 1e-3, 1e2, count)], ell
    )
    bore = np.where(rng.random(count) < 0.5, 0.0, typed(rng, rng.uniform(0, 1, count)))
    i3 = (1 + bore**2) / 2
    i1 = i3 / 2 + ell**2 / 3
    free = rng.random(count) < 0.3
    i1 = np.where(free, np.maximum(typed(rng, rng.uniform(0.1, 3, count)), 0.1), i1)
    i3 = np.where(free, i1 * rng.uniform(0.1, 2, count), i3)
    fillet = np.where(rng.random(count) < 0.6, 0.0, typed(rng, rng.uniform(0, 1, count)))
    fillet = np.where(rng.random(count) < 0.05, 1 - log_uniform(rng, 1e-8, 1e-3, count), fillet)
    fillet = np.where(fillet == 1.0, 0.9, fillet)
    balls = (rng.random(count) < 0.15) & ~faces
    fillet = np.where(balls, 1.0, fillet)
    ell = np.where(balls, rng.uniform(-0.5, 0.5, count), ell)
    i1, i3 = (
        np.where(balls, rng.uniform(0.3, 0.5, count), i1),
        np.where(balls, rng.uniform(0.3, 0.5, count), i3),
    )
    return np.stack([ell, i1, i3, fillet], axis=1)


def draw_starts(rng, bodies):
    """States of all kinds: random, steady, kicked, at rest, planar, flat, at an edge, lifted, fast."""
    count = len(bodies)
    theta = typed(rng, rng.uniform(0.05, 1.55, count))
    theta = np.maximum(theta, 0.05)
    theta = np.where(rng.random(count) < 0.12, log_uniform(rng, 1e-8, 1e-1, count), theta)
    ends = np.where(bodies[:, 0] != 0, np.pi / 2, np.pi)
    round_ = bodies[:, 3] == 1.0
    theta = np.where((ends > 2) & (rng.random(count) < 0.3), np.pi - theta, theta)
    edge = rng.random(count)
    theta = np.where((edge < 0.04) & ~round_, np.pi / 2, theta)
    theta = np.where((edge > 0.96) & ~round_, np.pi / 2 - log_uniform(rng, 1e-12, 1e-2, count), theta)
    w1, w3 = (typed(rng, rng.normal(size=count) * rng.choice([0.3, 1, 3], count)) for _ in range(2))
    s, c = np.sin(theta), np.cos(theta)
    with np.errstate(all="ignore"):
        square = (c - bodies[:, 0] * s) / ((bodies[:, 1] * c - bodies[:, 2] * bodies[:, 0] * s) * s)
        steady = np.sqrt(square) * s
    is_steady = (rng.random(count) < 0.25) & np.isfinite(steady) & (steady < 50)
    w1 = np.where(is_steady, steady, w1)
    w3 = np.where(is_steady, bodies[:, 0] * steady, w3)
    w2 = np.where(rng.random(count) < 0.4, 0.0, typed(rng, rng.normal(size=count) * 0.4))
    w2 = np.where(is_steady, rng.choice([0.0, 0.05, 1e-300, 1e-9, -0.3], count), w2)
    kind = rng.random(count)
    planar, rest, fast, lifted = (
        kind < 0.06,
        (kind > 0.06) & (kind < 0.09),
        kind > 0.96,
        abs(kind - 0.5) < 0.02,
    )
    w1, w3 = np.where(planar | rest, 0.0, w1), np.where(planar | rest, 0.0, w3)
    w2 = np.where(rest, 0.0, np.where(lifted, w2 * 10, w2))
    w3 = np.where(fast, w3 * log_uniform(rng, 10, 500, count), w3)
    w1 = np.where(rng.random(count) < 0.02, rng.choice([1e-300, 1e-12, -1e-8], count), w1)
    slip = typed(rng, rng.normal(size=(2, count)) * rng.choice([0.1, 1, 4], count))
    slip = np.where(rng.random((2, count)) < 0.15, 0.0, slip)
    slip = np.where(rng.random(count) < 0.15, 0.0, np.where(rng.random(count) < 0.03, 1e-300, slip))
    return np.stack([theta, w1, w2, w3, *slip], axis=1)


def draw(rng, count, contact=None, laws=None):
    """A scene of `count` motions with this contact and these laws; None: random ones."""
    if contact is None:
        contact = str(rng.choice(CONTACTS))
    if laws is None:
        some = rng.random()
        laws = (
            []
            if some < 0.4
            else rng.choice(
                len(LAWS), len(LAWS) if some > 0.97 else rng.integers(1, 4), replace=False
            ).tolist()
        )
    faces = np.full(count, any(k in FACES for k in laws))
    bodies = draw_bodies(rng, count, faces)
    starts = draw_starts(rng, bodies)
    losses = {}
    for k in sorted(laws):
        size = log_uniform(rng, 1e-6, 0.3, count)
        losses[k] = np.where(rng.random(count) < 0.2, 10.0 ** np.floor(np.log10(size)), size)
    mu = np.maximum(typed(rng, rng.uniform(0, 1.0, count)), 0.01)
    mu = np.where(rng.random(count) < 0.05, rng.choice([0.0, 1e-6], count), mu)
    if contact == "mu":
        mu[:] = rng.choice([0.0, 1e-10, 0.1, 0.3, mu[0], 1.0])
    static = np.where(
        rng.random(count) < 0.7, mu, np.maximum(mu, 1e-9) * rng.choice([1.3, 3.0, np.inf], count)
    )
    end = float(np.round(log_uniform(rng, 0.1, 50), 1))
    times = np.array([end]) if rng.random() < 0.7 else np.linspace(0, end, 5)[1:]
    how: dict[str, Any] = {}
    if contact in ("rolling", "mu", "smooth") and not laws and rng.random() < 0.2:
        how["beyond"] = True
        times = times if rng.random() < 0.7 else -times
    if contact in ("coulomb", "viscous"):
        how |= {"restitution": 0.0} if rng.random() < 0.2 else {}
    tol = float(rng.choice([1e-10, 1e-8, 1e-12]))
    table = np.stack([mu, static, *([draw_patches(rng, count)] if contact == "patch" else [])], axis=1)
    if contact == "patch":
        losses.pop(LAWS.index(sc.loss.Drilling), None)
    return Scene(contact, bodies, starts, table, losses, times, tol, how)


def draw_patches(rng, count):
    """Radii of patches, from those of hard balls to a tenth of the body; some are 0, and some are larger."""
    patch = typed(rng, log_uniform(rng, 1e-5, 0.1, count))
    return np.where(rng.random(count) < 0.1, rng.choice([0.0, 1e-9, 1e-300, 0.5, 0.99], count), patch)


class Alone(NamedTuple):
    """The result of `sc.roll` for a motion."""

    status: int
    end: float
    last: np.ndarray  # the state at the last time or at the end
    states: np.ndarray  # (times, 4), NaN after the end
    error: float


def alone(scene, i):
    """Motion i computed by `sc.roll`; a ValueError if there is none."""
    body, state, how = scene.asked(i)
    exact = not scene.losses and scene.contact in CONTACTS[:3]
    m = sc.roll(body, state, scene.times, t0=0.0, **how | ({} if exact else {"tol": scene.tol}))
    event = m.event
    if how.get("beyond") and event and event.ending != sc.Ending.FACE:
        # the motion continued beyond its first event; a face that landed later has no event of its own
        event = None
        if m.t.size < scene.times.size:
            return Alone(
                int(sc.Ending.FACE),
                math.nan,
                np.full(4, np.nan),
                np.full((scene.times.size, 4), np.nan),
                m.error,
            )
    states = np.full((scene.times.size, 4), np.nan)
    states[: m.t.size] = m.y.T[: scene.times.size]
    last = states[-1] if event is None else np.array([float(getattr(event.state, x)) for x in NUMBERS])
    end = float(scene.times[-1]) if event is None else event.time
    return Alone(0 if event is None else int(event.ending), end, last, states, m.error)


class Apart(NamedTuple):
    """Difference of the two results in units of the sum of their claimed errors; `kind`: the ends differ."""

    kind: bool
    ratio: float
    status: tuple[int, int]
    claims: tuple[float, float]
    call: str


def at_once(scene):
    """The columns of all motions of a scene, computed by `sc.sweep.roll`."""
    body, state, how = scene.asked(slice(None))
    spread = scene.times.size > 1
    t = scene.times if spread else float(scene.times[0])
    kept = ("states" if spread else "final", "end")
    found = sc.sweep.roll(body, state, t, want=kept, tol=scene.tol, threads=1, **how)
    return {name: found[name].to_numpy() for name in found.data_vars}


def states_of(data, i):
    """The states of motion i of the columns: (times, 4), or (4,) if there is one time."""
    return np.stack([data[x][i] for x in NUMBERS], axis=-1)


def compare(scene):
    """Compare every motion of a scene, at once and alone."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        data = at_once(scene)
        for i in range(len(scene.bodies)):
            yield _compared(scene, i, data)


def _compared(scene, i, data):
    status, claim, end = int(data["status"][i]), float(data["error"][i]), float(data["end"][i])
    try:
        one = alone(scene, i)
    except ValueError as e:
        refused = status in (Status.INVALID, Status.PAINLEVE, Status.BOUNDED)
        return Apart(not refused, 0.0, (status, -1), (claim, math.nan), f"{scene.call(i)}  # {e}")
    if status == one.status == Status.BOUNDED:
        return Apart(False, 0.0, (status, one.status), (claim, one.error), scene.call(i))
    both = claim + one.error
    apart = Apart(False, 0.0, (status, one.status), (claim, one.error), scene.call(i))
    if not math.isfinite(both):
        # motions without a finite claim may end in any way
        return apart._replace(kind=status in (Status.INVALID, Status.BOUNDED))
    spread = scene.times.size > 1
    rows = states_of(data, i)
    last = rows[-1] if spread else rows
    if status != one.status:
        near = max(abs(end - one.end), 0.0) <= both + LATE and 0 in apart.status
        return apart._replace(kind=not near, ratio=0.0)
    off = abs(end - one.end) if math.isfinite(one.end) else 0.0
    if spread:
        reached = ~np.isnan(rows[:, 0]) & ~np.isnan(one.states[:, 0])
        off = max(off, np.abs(rows - one.states)[reached].max(initial=0.0))
    if not spread:
        off = max(off, np.nan_to_num(np.abs(last - one.last)).max())
    return apart._replace(ratio=off / max(both, 1e-300) if off > 0 else 0.0)


def compare_periods(scene):
    """Differences of periods at once and alone, in units of both claims, with the call of each motion."""
    if scene.losses or scene.contact not in CONTACTS[:3]:
        return
    body, state, how = scene.asked(slice(None))
    t = float(scene.times[-1])
    found = sc.sweep.roll(body, state, t, want="period", tol=scene.tol, threads=1, **how)
    for i, (period, claim) in enumerate(zip(found["period"].values, found["error"].values, strict=True)):
        body, state, _ = scene.asked(i)
        contact = "smooth" if scene.contact == "smooth" else "rolling"
        call = f"sc.swing({body!r}, {' '.join(repr(state).split())}, {contact!r})".replace("sc.sc.", "sc.")
        try:
            alone = sc.swing(body, state, contact)
        except ValueError:
            continue
        if math.isfinite(period) and math.isfinite(alone.period):
            off, both = abs(period - alone.period), float(claim) + alone.error
            yield (off / both if off else 0.0), call
        elif not math.isnan(period):
            yield (0.0 if period == alone.period else math.inf), call
