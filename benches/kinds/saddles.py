"""Motions that linger at an unstable steady state, against 113 bits or, where that is too few, 240.

Needs the dependency group `peers`. Rolling. A fifth each of five kinds of start, from tubes, coins, general moments and the critical cylinder
(ell = sqrt(3)/2 at theta0, reduced rates around 1.0 and 0.4):

    rest       an unstable steady state, the inclination off by 1e-16 to 1e-5
    kick       an unstable steady state, which tilts at a rate of 1e-16 to 1e-5, either way
    mixed      all four numbers off, and the centre not at rest
    exact      a steady state solved to rounding, nothing added
    manifold   far from a steady state, on a motion that comes to it: found backward from there, then rounded

Each is followed for 2.3 of its periods (at most 200 sqrt(R/g)), beyond ends that are not the face, and
compared at eight times. Noise is the sum over the seven inputs of the change of the truth at that time by
half an ulp (2^-53 relative); allowed is max(1e-12, 10 noise). Where noise is above 1e-9 the truth is computed
with 240 bits. Units: rad, sqrt(g/R).
"""

import math
import time

import answers
import draws
import numpy as np
import truth
from axes import rates_and_force
from draws import Start
from judge import blocks
from timing import best

import spincyl as sc

DEFAULTS, FEW, HONEST = {"count": 200, "seed": 1, "show": 5}, "--count 50", 1.0
KINDS = ("rest", "kick", "mixed", "exact", "manifold")
LATEST = 200.0


def tilting(of, theta, w1, w3):
    """w2' of a state that does not tilt, and w1', w3' per w2."""
    s, c = math.sin(theta), math.cos(theta)
    at_rest, _ = rates_and_force("rolling", of, s, c, [w1, 0.0, w3], float)
    moving, _ = rates_and_force("rolling", of, s, c, [w1, 1.0, w3], float)
    return at_rest[1], moving[0], moving[2]


def growth(of, theta, w1, w3):
    """Growth rate of a departure from a steady state, NaN where it is stable: theta'' = -w2', where w1 and w3
    follow the inclination."""
    h = 1e-6
    _, d1, d3 = tilting(of, theta, w1, w3)

    def along(x):  # theta' = -w2, so that w1 changes by -d1 per theta
        return tilting(of, theta + x, w1 - d1 * x, w3 - d3 * x)[0]

    square = -(along(h) - along(-h)) / (2 * h)
    return math.sqrt(square) if square > 0.0025 else math.nan


def steady(rng, kind):
    """A body, an unstable steady state of it (theta, w1, w3) and its growth rate."""
    while True:
        if kind != "mixed" and rng.random() < 0.1:
            of = draws.tube(math.sqrt(0.75))
            theta = math.atan2(1.0, of[0])
            rate = float(rng.choice([1.0, 0.4])) * (1.0 if rng.random() < 0.5 else rng.uniform(0.9, 1.1))
            w1 = rate * math.sin(theta) / math.sqrt(of[2])
            if w1 * w1 > 1.2:
                continue
            w3 = of[0] * w1
        else:
            of = draws.body(rng)
            theta = draws.uniform(rng, 0.2, 1.4, decimal=0.2)
            found = draws.steady(of, theta)
            if kind == "mixed" or found is None:
                w1 = draws.uniform(rng, -2.0, 2.0, decimal=0.2)
                if abs(w1) < 0.05:
                    continue
                # w2' is linear in w3
                zero, one = (tilting(of, theta, w1, w3)[0] for w3 in (0.0, 1.0))
                w3 = -zero / (one - zero) if one != zero else math.inf
            else:
                w1, w3 = found
        if of[0] > 20 or not max(abs(w1), abs(w3)) < 10:
            continue
        rate = growth(of, theta, w1, w3)
        _, normal, _ = truth.force(Start(*of, theta, w1, 0.0, w3))
        if rate > 0 and normal > 0:
            return of, theta, w1, w3, rate


def solved(of, theta, w1, w3):
    """The double w3 with which |w2'| is least."""
    best = w3
    for _ in range(60):
        near = [best, np.nextafter(best, -9e9), np.nextafter(best, 9e9)]
        residual = [abs(residue(of, theta, w1, x)) for x in near]
        if residual[0] == min(residual):
            break
        best = float(near[residual.index(min(residual))])
    return best


def residue(of, theta, w1, w3):
    number = truth.TYPES[113][0]
    theta, *w = (number(float(x)) for x in (theta, w1, 0.0, w3))
    return rates_and_force("rolling", [number(x) for x in of], np.sin(theta), np.cos(theta), w, number)[0][1]


def arriving(of, theta, w1, w3, rate, rng):
    """A state whose motion comes to the saddle: a motion from the stable side of the saddle, followed
    backward."""
    off = draws.sign(rng) * 1e-7
    # theta' = -w2 = -rate off, and w1, w3 follow the inclination
    _, d1, d3 = tilting(of, theta, w1, w3)
    near = Start(*of, theta + off, w1 - d1 * off, rate * off, w3 - d3 * off)
    long = float(rng.uniform(14.0, 17.5)) / rate
    found = truth.path(near, [-long], beyond=True)
    if found.kind == truth.FACE or not len(found.rows):
        return None
    state = [float(x) for x in found.rows[-1][:4]]
    if abs(state[0] - theta) < 0.02 or not 0.02 < state[0] < 3.1:
        return None
    return Start(*of, *state)


def draw(rng, kind):
    while True:
        of, theta, w1, w3, rate = steady(rng, kind)
        off = draws.sign(rng) * draws.log_uniform(rng, 1e-16, 1e-5)
        if kind == "rest":
            start = Start(*of, theta + off, w1, 0.0, w3)
        elif kind == "kick":
            start = Start(*of, theta, w1, off, w3)
        elif kind == "mixed":
            by = [off * x for x in rng.uniform(-1, 1, 4)]
            start = Start(*of, theta + by[0], w1 + by[1], by[2], w3 + by[3])
        elif kind == "exact":
            start = Start(*of, theta, w1, 0.0, solved(of, theta, w1, w3))
        else:
            start = arriving(of, theta, w1, w3, rate, rng)
            if start is None:
                continue
        t = lasting(start)
        if t is not None:
            return start, t


def lasting(start):
    """2.3 periods, from the turning points of the true motion; less if a face lands; at most LATEST."""
    follow = truth.integrator("rolling", 64, False, False, False)
    follow.begin(start)
    before, turns, t = math.copysign(1.0, start.w2) if start.w2 else 0.0, [], 0.0
    while t < LATEST and len(turns) < 3:
        t += 0.05
        if follow.until(t, 20_000) is not None:
            return 0.95 * float(follow.ta.time)
        now = math.copysign(1.0, follow.ta.state[2])
        if before and now != before:
            turns.append(t)
        before = now
    return min(2.3 * (turns[2] - turns[0]), LATEST) if len(turns) == 3 else LATEST


def noise(start, times, base):
    """The change of each number at each time by half an ulp of every input, summed over the inputs."""
    number, moved = truth.TYPES[113][0], truth.TYPES[113][0](2.0) ** -80
    total = np.zeros(base.rows.shape)
    for which in range(7):
        if start[which] == 0:
            continue
        numbers = list(start)
        numbers[which] = number(numbers[which]) * (number(1.0) + moved)
        other = truth.path(Start(*numbers), times, pose=True, beyond=True)
        total += np.abs(((other.rows - base.rows) / moved).astype(float)) * 2.0**-53
    return total


def eighths(t):
    return [k * (t / 8) for k in range(1, 9)]


def eight_times(start, t):
    """The Python call that computes the motion of a start at the times of `eighths`."""
    return f"{start.line('T')[:-1]}, t0=0.0, beyond=True)".replace("'T'", f"np.arange(1, 9) * {t / 8!r}")


def enter(tally, name, kind, start, t, true, noisy):
    """Adds one result to the tally; `name`: what is wanted."""
    call = eight_times(start, t)
    try:
        answer, poses = answers.rolled(start, eighths(t), True, ("pose",) if name == "poses" else ())
    except ValueError as e:
        tally.count(f"answered, {name}", "refused", f"{call}  # {e}")
        return
    tally.count(f"answered, {name}", answer.by)
    line = f"{kind}, {answer.by}, claimed {answer.error:.1e}: {call}"
    if len(answer.path.rows) < len(true.rows):
        tally.count(f"answered, {name}", "too short", line)
        return
    parts = [
        answers.apart(
            answer.path._replace(rows=answer.path.rows[i : i + 1]),
            true._replace(rows=true.rows[i : i + 1], kind=answer.path.kind),
            poses and ((poses[0][0][i : i + 1], poses[0][1][i : i + 1]), poses[1][i : i + 1]),
        )
        for i in range(len(true.rows))
    ]

    def both(row, off, noisy, claimed):
        allowed = [max(1e-12, 10 * x) for x in noisy[: len(off)].max(axis=1)]
        tally.add(
            f"{row}: over allowed", *max(zip(off, allowed, strict=True), key=lambda x: x[0] / x[1]), line
        )
        tally.add(f"{row}: over claimed", max(off), claimed, line)

    for by in ("", ", exact") if answer.by == "exact" else ("",):
        both(f"{name}{by}", [part.states for part in parts], noisy[:, :4], answer.error)
    if poses is not None:
        both("angles and places", [part.poses for part in parts], noisy[:, 4:], answer.pose_error)


def judge(given, tally):
    rng = np.random.default_rng(given.seed)
    for i, _ in blocks(given):
        kind = KINDS[i % len(KINDS)]
        start, t = draw(rng, kind)
        times = eighths(t)
        true = truth.path(start, times, pose=True, beyond=True)
        noisy = noise(start, times, true)
        if noisy.max() > 1e-9:  # 113 bits are too few
            tally.count("truths", "with 240 bits")
            true = truth.path(start, times, bits=240, pose=True, beyond=True)
        for name in ("states", "poses"):
            enter(tally, name, kind, start, t, true, noisy)
        body, state = sc.Body(*start[:3]), sc.State(*start[3:7])
        took = best(lambda: sc.roll(body, state, t, beyond=True), clock=time.perf_counter)[1]  # noqa: B023
        tally.took(took, start.line(t))
