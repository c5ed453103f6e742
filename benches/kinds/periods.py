"""True over claimed error of periods and precessions, of sc.swing and sc.sweep.roll, against 113 bits.

Needs the dependency group `peers`; 10,000 motions take half an hour on one core. Bodies of all kinds (tubes, disks, any moments, rounded rims, rims rounded to nearly a ball, balls), rolling
and smooth; starts that are random, steady, next to steady, next to an unstable steady state, or upright to
1e-8 at either pole. The truth is the time between the turning points by Newton's and Euler's equations in
Taylor series (heyoka), from the exact doubles. A ratio is the true error over the claimed one: `error` of the
swing for its period, `error` of the sweep for both. Where there is no period (a face lands, an unstable state
stays) both must return an infinite one.
"""

import functools
import math

import heyoka as hy
import numpy as np
from axes import rates_and_force
from draws import log_uniform
from judge import blocks

import spincyl as sc

DEFAULTS, FEW, HONEST = {"count": 10_000, "seed": 1, "show": 10}, "--count 500", 1.0
KINDS = ("any", "steady", "next to steady", "saddle", "upright", "upside down")
FLAT = 1e-10
LONGEST = 3000.0


@functools.cache
def integrator(contact):
    """heyoka's equations with phi, which stop at a turning point and where the axis is vertical."""
    theta, w1, w2, w3, phi = hy.make_vars("theta", "w1", "w2", "w3", "phi")
    s, c = hy.sin(theta), hy.cos(theta)
    rates, _ = rates_and_force(contact, [hy.par[i] for i in range(4)], s, c, [w1, w2, w3], hy.expression)
    equations = [(theta, -w2), (w1, rates[0]), (w2, rates[1]), (w3, rates[2]), (phi, w1 / s)]
    number = hy.real128
    any_way, down = hy.event_direction.any, hy.event_direction.negative
    margins = [(w2, any_way), (theta - hy.par[4], down), (hy.par[5] - theta, down)]
    events = [hy.t_event(of, direction=way, fp_type=number) for of, way in margins]
    first = np.array([number(1.0)] * 5, dtype=number)
    pars = np.array([number(1.0)] * 6, dtype=number)
    return hy.taylor_adaptive(
        equations, first, pars=pars, t_events=events, fp_type=number, tol=number("1e-33")
    )


def half(body, start, contact):
    """Time and precession to the next turning point; infinite and NaN where the axis becomes vertical; None
    if it takes too long."""
    ta, number = integrator(contact), hy.real128
    ta.reset_cooldowns()
    ta.time = number(0.0)
    flat = number(FLAT) if body[3] < 1 else number(0.0)
    for i, x in enumerate([*body, flat, number("3.14159265358979323846264338327950288") - flat]):
        ta.pars[i] = number(x)
    for i, x in enumerate([*start, 0.0]):
        ta.state[i] = number(x)
    while True:
        outcome = ta.propagate_until(number(LONGEST), max_steps=20_000)[0]
        index = -int(outcome) - 1
        if not 0 <= index < 3:
            return None
        if index > 0:
            return math.inf, math.nan
        if ta.time > 0:
            return ta.time, ta.state[4]


def truth(body, start, contact):
    """Period and precession of a motion, from separate motions to both turning points, so that an error of
    one that lingers at a saddle does not spoil the other; infinite and NaN where the axis becomes vertical;
    None if it takes too long."""
    found = [half(body, start, contact)]
    if start[2] != 0.0:
        found.append(half(body, (start[0], *(-x for x in start[1:])), contact))
    if None in found:
        return None
    time, turn = (
        sum(x) for x in zip(*[(t, s * x) for (t, x), s in zip(found, (1, -1), strict=False)], strict=True)
    )
    return 2 * time, 2 * turn


def draw_body(rng, ball):
    """ell, I1, I3 and fillet."""
    kind = rng.random()
    if ball:
        ell, i1 = float(rng.uniform(-0.6, 0.6)), float(rng.uniform(0.3, 1.0))
        i3 = float(rng.uniform(0.2, 1.6)) * i1
        return (ell, i1, i3, 1.0) if kind < 0.7 else (abs(ell), i1, i3, 1.0 - log_uniform(rng, 1e-12, 1e-2))
    ell = 0.0 if kind < 0.15 else log_uniform(rng, 1e-3, 30.0) if kind < 0.3 else float(rng.uniform(0.0, 3.0))
    i3 = float(rng.uniform(0.5, 1.0))
    i1 = i3 / 2 + ell * ell / 3
    if rng.random() < 0.3:
        i1 = float(rng.uniform(0.1, 3.0))
        i3 = i1 * float(rng.uniform(0.1, 2.0))
    fillet = 0.0 if rng.random() < 0.5 else float(rng.uniform(0.0, 1.0))
    return ell, i1, i3, fillet


def draw(rng):
    """The kind, a body, a start (theta, w1, w2, w3) and a contact."""
    while True:
        kind = str(rng.choice(KINDS))
        contact = "rolling" if rng.random() < 0.7 else "smooth"
        turned = kind in KINDS[4:]
        body = draw_body(rng, (turned and rng.random() < 0.8) or rng.random() < 0.1)
        of = sc.Body(*body[:3], fillet=body[3])
        theta = (
            log_uniform(rng, 1e-8, 1e-1)
            if turned
            else float(rng.uniform(0.05, 2.5 if body[3] == 1 else 1.55))
        )
        n = float(rng.normal() * rng.choice([0.3, 1.0, 4.0]))
        w1 = float(rng.normal() * rng.choice([0.3, 1.0, 4.0]))
        w2 = float(rng.normal() * 0.4)
        if turned:
            w1, w2 = w1 * theta, w2 * theta
            if kind == KINDS[5]:
                theta = math.pi - theta
        if kind in KINDS[1:4] or (turned and rng.random() < 0.5):
            # a steady state with a rate that is near the one drawn
            if theta > math.pi / 2 and body[3] < 1:
                continue
            s = of.circular(theta, w1 / math.sin(theta))
            w1, w2, n = float(s.w1), 0.0, float(s.w3)
            if not math.isfinite(n) or abs(n) > 100:
                continue
            if kind != "steady" and rng.random() < 0.9:
                w2 = log_uniform(rng, 1e-13, 1e-2) * (math.sin(theta) if turned else 1.0)
            unstable = not of.nutation(s, contact) > 0
            if contact == "rolling" and unstable != (kind == "saddle") and not turned:
                continue
        return kind, body, (theta, w1, w2, n), contact


def enter(tally, kind, name, found, true, claim, line, constant):
    """Adds the period and the precession by one route to the tally; `constant`: the inclination does not
    change."""
    period, row = found[0], f"{kind}, {name}"
    if math.isinf(period) or math.isinf(float(true[0])):
        if math.isinf(period) != math.isinf(float(true[0])) and not constant:
            tally.count(row, "other kind", f"period {period}, true {float(true[0])!r}: {line}")
        return
    tally.count(row, "vague", n=not claim <= 1e-6 * period)
    for what, x, y in zip(("period", "turn"), found, true, strict=True):
        off = abs(float(hy.real128(x) - y))
        # the swing does not claim an error of its precession
        aside = ", aside" if (name, what) == ("swing", "turn") else ""
        tally.add(f"{kind}, {name}, {what}{aside}", off, claim, line)
        tally.add(f"all, {name}, {what}, aside", off, claim)


def judge(given, tally):
    rng, want = np.random.default_rng(given.seed), ("period", "precession_per_period")
    for _ in blocks(given):
        kind, body, start, contact = draw(rng)
        of, state = sc.Body(*body[:3], fillet=body[3]), sc.State(*start)
        shape = "sc.Body({!r}, {!r}, {!r}, fillet={!r})".format(*body)
        line = " ".join(f"sc.swing({shape}, {state!r}, {contact!r})".split()).replace("sc.sc.", "sc.")
        tally.count(kind, "motions")
        many = sc.sweep.roll(of, state, 0.1, want=want, contact=contact, beyond=True)
        try:
            found = sc.swing(of, state, contact)
        except ValueError:
            tally.count(kind, "refused")
            continue
        true = truth(body, start, contact)
        if true is None:
            tally.count(kind, "without a truth")
            continue
        constant, one = found.theta_max == found.theta_min, [found.period, found.precession_per_period]
        enter(tally, kind, "swing", one, true, found.error, line, constant)
        several, claim = [float(many[name]) for name in want], float(many["error"])
        enter(tally, kind, "sweep", several, true, claim, line, constant)
