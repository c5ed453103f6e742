"""Random bodies and initial states of all kinds that a user may type, for motions, starts and saddles of claims.py."""

import math
from typing import NamedTuple

import numpy as np


class Start(NamedTuple):
    """Body, state and contact with which a motion starts, in exact doubles or in numbers with more bits."""

    ell: float
    i1: float
    i3: float
    theta: float
    w1: float
    w2: float
    w3: float
    contact: str = "rolling"
    mu: float = math.inf

    @property
    def numbers(self):
        return self[:7]

    def line(self, t):
        """The Python call that computes the motion to `t`."""
        body = "sc.Body({!r}, {!r}, {!r})".format(*map(float, self[:3]))
        state = "sc.State({!r}, {!r}, {!r}, {!r})".format(*map(float, self[3:7]))
        more = f', contact="{self.contact}"' if self.contact != "rolling" else ""
        more += f", mu={float(self.mu)!r}" if math.isfinite(self.mu) else ""
        return f"sc.roll({body}, {state}, {t!r}{more})"


def log_uniform(rng, low, high):
    return float(10.0 ** rng.uniform(math.log10(low), math.log10(high)))


def sign(rng):
    return 1.0 if rng.random() < 0.5 else -1.0


def uniform(rng, low, high, decimal=0.4):
    """A uniform number, which has one decimal, as people type it, with the probability `decimal`."""
    x = float(rng.uniform(low, high))
    return round(x, 1) if rng.random() < decimal else x


def tube(ell, bore=0.0):
    """ell, I1, I3 as doubles."""
    i3 = (1.0 + bore * bore) / 2.0
    return ell, i3 / 2.0 + ell * ell / 3.0, i3


def body(rng, extreme=0.0):
    """ell, I1, I3; with the probability `extreme` of a body that could not be built."""
    if rng.random() < extreme:
        ell = 0.0 if rng.random() < 0.1 else log_uniform(rng, 1e-3, 1e3)
        i1 = log_uniform(rng, 1e-6, 1e6)
        return ell, i1, max(i1 * min(log_uniform(rng, 1e-6, 1e2), 2.0), 1e-6)
    kind = rng.random()
    if kind < 0.4:
        return tube(abs(uniform(rng, 0.1, 3.0)), 0.0 if rng.random() < 0.7 else abs(uniform(rng, 0.0, 1.0)))
    if kind < 0.6:  # a disk, a hoop, or a flat body of any moments
        if rng.random() < 0.7:
            return tube(0.0, 0.0 if rng.random() < 0.6 else 1.0)
        i3 = float(rng.uniform(0.1, 1.0))
        return 0.0, i3 / 2.0, i3
    if kind < 0.9:
        i1 = max(uniform(rng, 0.1, 3.0), 0.1)
        return uniform(rng, 0.0, 3.0), i1, min(max(uniform(rng, 0.1, 3.0), 0.1), 2.0 * i1)
    return tube(log_uniform(rng, 3.0, 100.0))


def tilt(rng):
    """An inclination between 0 and pi/2, in most cases an ordinary one."""
    kind = rng.random()
    if kind < 0.8:
        return min(max(uniform(rng, 0.05, 1.55), 0.05), 1.55)
    if kind < 0.9:
        return log_uniform(rng, 1e-4, 1e-1)
    return float(np.pi / 2 - log_uniform(rng, 1e-6, 1e-1))


def inclination(rng, ell, beyond):
    """An inclination, beyond pi/2 only where no motion ends there."""
    theta = tilt(rng)
    if (ell == 0 or beyond) and rng.random() < 0.4:
        theta = float(np.pi) - theta if rng.random() < 0.7 else round(float(rng.uniform(1.6, 3.1)), 1)
    return theta


def steady(of, theta):
    """w1, w3 of the steady state with the centre at rest, None if there is none."""
    ell, i1, i3 = of
    s, c = math.sin(theta), math.cos(theta)
    square = (c - ell * s) / ((i1 * c - i3 * ell * s) * s)
    if not square > 0:
        return None
    w1 = math.sqrt(square) * s
    return w1, ell * w1


def spins(rng, of, theta):
    """w1, w3: random, zero, small, or those of a steady state with the centre at rest."""
    kind = rng.random()
    if kind < 0.08:
        return 0.0, 0.0
    if kind < 0.18:
        return log_uniform(rng, 1e-5, 1e-1) * sign(rng), log_uniform(rng, 1e-5, 1e-1) * sign(rng)
    if kind < 0.35:
        found = steady(of, theta)
        if found and max(found) < 50:
            return found
    most = float(rng.choice([0.5, 1.5, 4.0]))
    w1, w3 = uniform(rng, -most, most), uniform(rng, -most, most)
    if rng.random() < 0.5 and of[0] < 4:
        w3 += of[0] * w1  # the centre is nearly at rest
    return w1, w3


def almost_none(rng):
    """A derivative of the inclination: exactly zero, or between 1e-300 and 1e-4."""
    return 0.0 if rng.random() < 0.5 else sign(rng) * log_uniform(rng, 1e-300, 1e-4)


def at_rest(rng, scene):
    """A start whose inclination is constant or almost constant; a scene has `contact`, `mu` and `beyond`."""
    of = body(rng)
    theta = inclination(rng, of[0], scene["beyond"])
    w1, w3 = spins(rng, of, theta)
    return Start(*of, theta, w1, almost_none(rng), w3, scene["contact"], scene["mu"])


def any_start(rng, scene):
    """A start of any kind, also of bodies that could not be built."""
    of = body(rng, extreme=0.25)
    theta = inclination(rng, of[0], scene["beyond"])
    w1, w3 = spins(rng, of, theta)
    kind = rng.random()
    if kind < 0.35:
        w2 = almost_none(rng)
    elif kind < 0.8:
        w2 = uniform(rng, -1.0, 1.0)
    else:
        w2 = sign(rng) * log_uniform(rng, 1e-4, 1.0)
    if rng.random() < 0.06:  # fast, and nearly flat
        theta = log_uniform(rng, 1e-4, 1e-2)
        w1, w3 = sign(rng) * log_uniform(rng, 1e-4, 1e-1), uniform(rng, 10.0, 300.0)
    return Start(*of, theta, w1, w2, w3, scene["contact"], scene["mu"])


def friction(rng):
    """A coefficient of friction: infinite, a round number, or log-uniform."""
    kind = rng.random()
    if kind < 0.6:
        return math.inf
    return float(rng.choice([0.05, 0.1, 0.3, 0.5, 1.0])) if kind < 0.8 else log_uniform(rng, 5e-3, 2.0)


def scene(rng, longest):
    """The options that a block of motions shares, and the last time; `beyond`: motions go on beyond an
    end."""
    t = log_uniform(rng, 0.1, longest)
    return {
        "contact": "rolling" if rng.random() < 0.6 else "smooth",
        "mu": friction(rng),
        "beyond": bool(rng.random() < 0.3),
        "t": round(t, 1) if t > 1 and rng.random() < 0.5 else t,
    }
