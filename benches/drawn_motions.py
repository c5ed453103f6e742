"""Random scenes with one motion each, for random_scenes.py: body, initial state, times, and how it moves.

Every function gets a generator and the number of the scene and returns a `Drawn`.
"""

from typing import Any, NamedTuple

import numpy as np
from aloft import drawn as aloft
from draws import log_uniform, uniform
from invariants import reach
from kinds.stones import drawn as stone

import spincyl as sc

LAWS = {
    name: law
    for name in sc.loss.__all__
    if isinstance(law := getattr(sc.loss, name), type) and sc.loss.Law in law.__bases__
}
DRY = ("DryContour", "RollingResistance", "Drilling")
AIR = ("AirLinear", "AirQuadratic", "AirFilm", "BoundaryLayer")
OF_STONES = ("RollingResistance", "Drilling", "AirLinear", "AirQuadratic")
BOUNCES = (0.0, 0.0, 0.3, 0.5, 0.9, 1.0)


class Drawn(NamedTuple):
    """A scene: the arguments of `roll`."""

    body: Any
    state: Any
    times: np.ndarray
    how: dict[str, Any]

    def call(self):
        """The Python call that computes the motion."""
        given = "".join(f", {name}={value!r}" for name, value in self.how.items())
        state = " ".join(repr(self.state).split())
        t = f"np.linspace(0, {float(self.times[-1])}, {len(self.times)})"
        return f"sc.roll({self.body!r}, {state}, {t}{given})"


def times(until, count=101):
    return np.linspace(0.0, until, count)


def bounce(rng):
    """A coefficient of restitution; 0 and 1 are frequent."""
    return float(rng.choice(BOUNCES)) if rng.random() < 0.8 else float(rng.uniform(0.0, 1.0))


def law(rng, name, low=1e-4, high=0.1):
    return LAWS[name](log_uniform(rng, low, high))


def laws(rng, names, most=2):
    """The sum of one law or of several."""
    chosen = rng.choice(list(names), int(rng.integers(1, most + 1)), replace=False)
    first, *rest = (law(rng, str(name)) for name in chosen)
    return sum(rest, start=first)


def dry(rng):
    """A law of friction; a third has a higher static coefficient."""
    mu = max(uniform(rng, 0.02, 1.0), 0.02)
    return sc.Coulomb(mu, **({"static": mu * float(rng.uniform(1.0, 2.0))} if rng.random() < 0.3 else {}))


def contact(rng):
    """Any contact."""
    kind = rng.random()
    if kind < 0.6:
        return dry(rng)
    if kind < 0.75:
        return sc.Viscous(log_uniform(rng, 1e-3, 3.0))
    return "rolling" if kind < 0.9 else "smooth"


def two_rims(rng):
    """A cylinder or a tube with two rims, a quarter of them rounded."""
    ell = max(uniform(rng, 0.1, 3.0), 0.1)
    bore = 0.0 if rng.random() < 0.5 else float(rng.uniform(0.0, 0.95))
    fillet = {"fillet": float(rng.uniform(0.0, min(ell, 1 - bore, 0.9)))} if rng.random() < 0.25 else {}
    return sc.Body.tube(ell, bore=bore, **fillet)


def ball(rng, ell=0.7):
    """A ball whose centre of mass may be off its centre."""
    i1 = float(rng.uniform(0.25, 0.6))
    i3 = min(float(rng.uniform(0.25, 0.6)), 1.9 * i1)
    return sc.Body.ball(uniform(rng, -ell, ell) if rng.random() < 0.8 else 0.0, i1, i3)


def any_body(rng, index):
    return aloft(index, int(rng.integers(2**31)))[1] if rng.random() < 0.7 else ball(rng)


def tilted(rng, body):
    """An inclination up to which the body stands on the rim or ball to which theta refers."""
    most = reach(body)
    if most < 0.2:
        return most * float(rng.uniform(0.1, 0.9))
    return float(min(max(uniform(rng, 0.05, most - 0.05), 0.05), most - 0.02))


# The kinds.


def hops(rng, index, name=None):
    """A body on a rim or in the air, slipping or not, that may hop; with one loss law."""
    _, body, state, table = aloft(index, int(rng.integers(2**31)))
    how = {"contact": table, "restitution": bounce(rng)}
    if name is not None:
        how["losses"] = law(rng, name)
    return Drawn(body, state, times(20.0), how)


def far_ball(rng, _):
    """A round end whose centre of mass may be outside the ball, thrown up."""
    ell = float(rng.uniform(0.5, 3.0)) if rng.random() < 0.8 else -float(rng.uniform(0.1, 0.95))
    i1 = log_uniform(rng, 0.2, 3.0)
    body = sc.Body(ell, i1, i1 * float(rng.uniform(0.2, 1.9)), fillet=1.0)
    state = sc.dropped(
        body, abs(uniform(rng, 0.0, 2.0)), float(rng.uniform(0.05, 3.0)), w1=rng.normal(), w2=3 * rng.normal(),
        w3=rng.normal(), velocity=tuple(rng.normal(size=3)),
    )  # fmt: skip
    return Drawn(body, state, times(10.0), {"contact": dry(rng), "restitution": bounce(rng)})


def in_air(rng, index):
    """A short body near its side, or any body, that is lifted off and falls in air."""
    how = {"contact": dry(rng), "restitution": bounce(rng)}
    if rng.random() < 0.6:
        body = two_rims(rng)
        theta = float(rng.uniform(0.8, np.pi / 2))
        state = sc.State(theta, *rng.normal(size=3) * (1.0, 1.5, 2.0), slip=tuple(rng.normal(size=2)))
    else:
        _, body, state, _ = aloft(index, int(rng.integers(2**31)))
    how["losses"] = law(rng, str(rng.choice(AIR[:3])), 1e-3, 0.2)
    if rng.random() < 0.3:
        how["losses"] += law(rng, "ViscousContour", 1e-4, 0.01)
    return Drawn(body, state, times(20.0), how)


def lying(rng, _):
    """A body on both rims, which slides, pivots, rolls, or rises."""
    body, how = two_rims(rng), {"contact": contact(rng), "restitution": bounce(rng)}
    w1, w3 = (uniform(rng, -2.0, 2.0) * float(rng.choice([0.0, 1.0, 1.0, 3.0])) for _ in range(2))
    slip = (uniform(rng, -2, 2) * rng.integers(2), uniform(rng, -2, 2) * rng.integers(2))
    rubs = not isinstance(how["contact"], str)
    state = sc.State(np.pi / 2, w1, 0.0, w3, slip=tuple(map(float, slip)) if rubs else None)
    if rng.random() < 0.4:
        how["losses"] = laws(rng, LAWS)
    return Drawn(body, state, times(10.0), how)


def patch(rng, index):
    """A body on a patch of contact, drilling, slipping, or both from rest."""
    body = any_body(rng, index)
    radius = log_uniform(rng, 1e-4, 0.1) if rng.random() < 0.9 else float(rng.choice([1e-9, 0.5]))
    theta, slip = tilted(rng, body), rng.normal(size=2)
    w = rng.normal(size=3) * rng.choice([0.0, 1.0, 1.0, 4.0], 3)
    if rng.random() < 0.3:
        slip = slip * 0.0
    if rng.random() < 0.2:  # without drilling
        w[2] = -w[0] * np.sin(theta) / np.cos(theta)
    how = {"contact": sc.Coulomb(max(uniform(rng, 0.05, 0.8), 0.05), patch=radius)}
    if rng.random() < 0.5:
        how["losses"] = laws(rng, [x for x in LAWS if x != "Drilling"])
    return Drawn(body, sc.State(theta, *w, slip=tuple(slip)), times(10.0), how)


def stones(rng, index):
    """A stone with losses; a third start with w along the vertical."""
    body, state, table, more = stone(rng)
    how = {"contact": table, "losses": laws(rng, OF_STONES)} | more
    if rng.random() < 0.3:
        spin = uniform(rng, -2.0, 2.0)
        n = np.asarray(state.vertical)
        state = sc.EllipsoidState(n, spin * n, state.slip)
    return Drawn(body, state, times(6.0), how)


def let_go(rng, index):
    """A tilted body that is let go at rest under friction and a dry law."""
    body, how = any_body(rng, index), {"contact": sc.Coulomb(float(rng.uniform(0.02, 0.4)))}
    if rng.random() < 0.3:
        how["contact"] = dry(rng)
    how["losses"] = laws(rng, DRY)
    if rng.random() < 0.5:
        how["restitution"] = bounce(rng)
    return Drawn(body, sc.State(tilted(rng, body), 0.0, 0.0, 0.0), times(5.0), how)


def least(rng):
    """A number that is zero, almost zero, or not."""
    return float(rng.choice([0.0, 1e-300, -1e-300, 1e-17, 1e-12, -1e-8, 1.0]))


EDGES = ("flat", "no drilling", "no spin", "upright w", "decimals", "almost", "poles")


def exact(rng, index):
    """A start on an exact edge, where a rounding decides or a number vanishes."""
    edge = EDGES[index % len(EDGES)]
    body, how = any_body(rng, index // len(EDGES)), {"contact": dry(rng)}
    theta, (w1, w2, w3) = tilted(rng, body), map(float, rng.normal(size=3))
    slip = tuple(map(float, rng.normal(size=2))) if rng.random() < 0.5 else (0.0, 0.0)
    air = {}
    if edge == "flat":  # exactly on its side, turning
        body, theta = two_rims(rng), np.pi / 2
        how["restitution"] = bounce(rng)
        w1, w3 = w1 * int(rng.integers(2)), w3 * int(rng.integers(2))
        if rng.random() < 0.5:
            height, lift = float(rng.choice([0.0, 0.5])), float(rng.choice([0.0, -1.0, rng.normal()]))
            air = {"height": height, "lift": lift}
    elif edge == "no drilling":
        w3 = -w1 * float(np.tan(theta))
    elif edge == "no spin":
        w3 = w1 / float(np.tan(theta))
    elif edge == "upright w":
        w1, w2, w3 = w1 * float(np.sin(theta)), 0.0, w1 * float(np.cos(theta))
    elif edge == "decimals":
        theta = max(round(theta, 1), 0.1)
        w1, w2, w3 = (round(x, 1) for x in (w1, w2, w3))
        slip = tuple(round(x, 1) for x in slip)
    elif edge == "almost":
        w1, w2, w3 = (x * least(rng) for x in (w1, w2, w3))
        slip = tuple(x * least(rng) for x in slip)
    else:  # next to a face, or a ball next to its pole
        theta = float(rng.choice([1e-8, 1e-6, 1e-4]))
        if rng.random() < 0.5:
            body = ball(rng)
            theta = theta if rng.random() < 0.5 else float(np.pi - theta)
        w1, w2 = w1 * theta, w2 * float(rng.choice([0.0, theta, 1.0]))
    if rng.random() < 0.6:
        how["losses"] = laws(rng, DRY)
    if rng.random() < 0.5:
        how.setdefault("restitution", bounce(rng))
    return Drawn(body, sc.State(theta, w1, w2, w3, slip=slip, **air), times(8.0), how)


def tosses(rng, _):
    """A coin, thin or thick, that is tossed in any direction and comes to rest."""
    coin = sc.Body.solid(float(rng.choice([0.0854, 0.25, rng.uniform(0.05, 0.6)])))
    lean, w = float(np.arccos(rng.uniform(-1, 1))), rng.normal(0, 2.0, 3)
    start = sc.dropped(coin, abs(uniform(rng, 0.0, 5.0)), lean, w1=w[0], w2=w[1], w3=w[2])
    rubs = law(rng, "DryContour", 1e-2, 0.2)
    rubs = rubs + law(rng, "RollingResistance", 1e-3, 0.1) if rng.random() < 0.7 else rubs
    how = {"contact": sc.Coulomb(float(rng.uniform(0.1, 0.8))), "losses": rubs, "restitution": bounce(rng)}
    return Drawn(coin, start, times(60.0), how)


MOTIONS = {
    "hops": hops,
    **{f"hops, {name}": (lambda rng, index, name=name: hops(rng, index, name)) for name in LAWS},
    "far balls": far_ball,
    "air": in_air,
    "lying": lying,
    "patches": patch,
    "stones": stones,
    "let go": let_go,
    "exact edges": exact,
    "tosses": tosses,
}
