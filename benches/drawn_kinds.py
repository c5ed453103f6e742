"""Random motions of every kind with dry friction, for slowest.py and beside.py: alone, and at once.

A kind is launches on a rim, hops, short bodies in the air near their side, a patch of contact, stones, dropped
balls, tossed coins, billiard balls or tippe tops. Motion k of a kind has a loss law, or none, and a coefficient
of restitution of 0 or 0.5, in turn.
"""

from dataclasses import fields, replace

import numpy as np
from drawn_motions import LAWS, OF_STONES, Drawn, ball, hops, in_air, law, patch, times, tosses
from draws import log_uniform
from kinds.stones import start, stone

import spincyl as sc

BOUNCES = (0.0, 0.5)
FLAT_FACE = ("AirFilm", "BoundaryLayer")  # laws of the air below a face, which a ball has not
SHORT, LONG = 10.0, 60.0


def launch(rng, k):
    body = sc.Body.tube(log_uniform(rng, 0.1, 6.3), bore=float(rng.choice([0, 0.3, 0.8, 0.95])))
    w, slip = rng.uniform(-3, 3, 3) * [1, 1, 2], rng.uniform(-2, 2, 2)
    return Drawn(body, sc.State(float(rng.uniform(0.05, 1.55)), *w, slip=tuple(slip)), times(LONG, 2), {})


def hop(rng, k):
    scene = hops(rng, k)
    lifted = replace(scene.state, height=float(rng.uniform(0.0, 2.0)), lift=float(rng.normal()))
    return scene._replace(state=lifted)


def short(rng, k):
    """A body that stands on the table, so that all of a set can be computed at once."""
    scene = in_air(rng, k)
    return scene._replace(state=replace(scene.state, height=None, lift=None))


def dropped_ball(rng, k):
    body, w = ball(rng), rng.normal(size=3)
    lean, height = float(rng.uniform(0.1, np.pi - 0.1)), float(rng.uniform(0.0, 2.0))
    velocity = tuple(map(float, rng.normal(size=3)))
    state = sc.dropped(body, height, lean, w1=w[0], w2=w[1], w3=w[2], velocity=velocity)
    return Drawn(body, state, times(LONG, 2), {})


def billiard(rng, k):
    w, slip = 3 * rng.normal(size=3), 2 * rng.normal(size=2)
    body = sc.Body.ball(0.0, 0.4, 0.4)
    return Drawn(body, sc.State(float(rng.uniform(0.1, 3.0)), *w, slip=tuple(slip)), times(LONG, 2), {})


def top(rng, k):
    body = sc.Body.ball(-float(rng.uniform(0.05, 0.3)), 16 / 27, 14 / 27)
    spun = sc.State(float(rng.uniform(0.02, 0.4)), 0.0, 0.0, float(rng.uniform(3.0, 15.0)))
    return Drawn(body, body.with_centre_velocity(spun, 0.0, 0.0), times(LONG, 2), {})


def thrown_stone(rng, k):
    body, (n, w) = stone(rng), start(rng)
    return Drawn(body, sc.EllipsoidState(n, np.clip(w, -10, 10), rng.normal(size=2)), times(SHORT, 2), {})


KINDS = {
    "launches": launch,
    "hops": hop,
    "air": short,
    "patches": patch,
    "stones": thrown_stone,
    "balls": dropped_ball,
    "coins": tosses,
    "billiard balls": billiard,
    "tops": top,
}


def laws_of(kind, body):
    """The names of the loss laws that a body of this kind may have."""
    if kind == "stones":
        return OF_STONES
    without = (FLAT_FACE if body.fillet == 1 else ()) + (("Drilling",) if kind == "patches" else ())
    return [name for name in LAWS if name not in without]


def drawn(kind, k, seed, turn=None):
    """Motion k of a kind, and the words for its loss law and its restitution; `turn` 0 and 1: without a law."""
    turn = k if turn is None else turn
    rng = np.random.default_rng([seed, list(KINDS).index(kind), k])
    body, state, _, _ = KINDS[kind](rng, k)
    how = {"contact": sc.Coulomb(log_uniform(rng, 0.02, 1.0))}
    if kind == "patches":
        how["contact"] = sc.Coulomb(how["contact"].mu, patch=log_uniform(rng, 1e-4, 0.1))
    if kind not in ("stones", "patches"):  # they end where they leave the table
        how["restitution"] = BOUNCES[turn % 2]
    names = [None, *laws_of(kind, body)]
    name = names[turn // 2 % len(names)]
    if name is not None:
        how["losses"] = law(rng, name)
    until = SHORT if kind == "stones" else LONG
    bounce = f"e = {how['restitution']:g}" if "restitution" in how else "no impact"
    return Drawn(body, state, np.array([0.0, until]), how), name or "no loss", bounce


def at_once(scenes):
    """Body, state and settings of motions with the same law and restitution, as arrays."""
    bodies, states = [x.body for x in scenes], [x.state for x in scenes]

    def columns(of, *names):
        return {name: np.array([getattr(x, name) for x in of], float) for name in names}

    how = dict(scenes[0].how)
    air = {} if states[0].height is None else columns(states, "height", "lift")
    slip = np.array([(0.0, 0.0) if x.slip is None else x.slip for x in states], float).T
    if "contact" in how:
        how["contact"] = sc.Coulomb(**columns([x.how["contact"] for x in scenes], "mu", "patch"))
    if "losses" in how:
        sort = type(how["losses"])
        how["losses"] = sort(**columns([x.how["losses"] for x in scenes], fields(sort)[0].name))
    if isinstance(bodies[0], sc.Ellipsoid):
        stones = sc.Ellipsoid(**columns(bodies, "semi_axes", "inertia", "offset", "theta_end"))
        return stones, sc.EllipsoidState(**columns(states, "vertical", "w"), slip=slip.T), how
    body = sc.Body(**columns(bodies, "ell", "i1", "i3", "fillet", "theta_end"))
    slips = {"slip": tuple(slip)} if "contact" in how else {}
    return body, sc.State(**columns(states, "theta", "w1", "w2", "w3"), **slips, **air), how
