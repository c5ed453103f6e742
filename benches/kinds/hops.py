"""True over claimed error of motions with flights, impacts and lying bodies.

    python benches/claims.py --of hops --count 5000             against the same motion with tol=1e-14
    python benches/claims.py --of hops --precise 40             against 50 digits, of 40 random drops (needs gmpy2)

The bodies, states and contacts are those of aloft.py, of which three in four start in the air here; the restitution is 0
to 1, in one of eight exactly 1. One in four has losses, of which half act in the air. The tolerance is 1e-11 to 1e-6.

Claims are `Motion.error` and `Motion.pose_error`. States are compared as seen from the same rim, poses by the centre of
mass. A motion whose truth claims more than a tenth of the claim that is judged, or ends otherwise, is counted separately; so
is one without steps, which is alike at every tolerance: only `--precise` judges its claim.
"""

import math
import sys
import time
from pathlib import Path

import aloft
import numpy as np
from judge import blocks

import spincyl as sc

DEFAULTS, FEW, HONEST = {"count": 5000, "seed": 1, "show": 5}, "--count 500", 2.0
TRUTH = 1e-14
FLIGHTS = Path(__file__).parents[2] / "tests" / "reference"


def options(add):
    add("--longest", type=float, default=10.0, help="latest time")
    add("--precise", type=int, default=0, help="number of drops to compare with 50 digits instead")
    add("--only", type=int, help="number of the one motion to judge")


def scene(seed, number, longest):
    """Body, state, times and options of the motion with this number."""
    _, body, state, table = aloft.drawn(number)
    rng = np.random.default_rng([seed, number])
    if rng.random() < 0.75:
        at = {"height": rng.uniform(0.0, 2.0), "lift": rng.normal()}
        slip = tuple(rng.normal(size=2)) if state.slip is None else state.slip
        state = sc.State(state.theta, state.w1, state.w2, state.w3, slip=slip, **at)
    restitution = 1.0 if rng.random() < 0.125 else rng.uniform()
    how = {"contact": table, "restitution": restitution}
    if rng.random() < 0.25:
        laws = (sc.loss.AirLinear, sc.loss.AirQuadratic, sc.loss.Drilling, sc.loss.RollingResistance)
        how["losses"] = laws[rng.integers(4)](10 ** rng.uniform(-4, -1))
    tol = 10 ** rng.uniform(-11, -6)
    return body, state, np.linspace(0.0, longest, 11), how, tol


def apart(a, b, k):
    """The largest difference of two states at time k, as seen from the same rim."""
    one, other = ([float(m.theta[k]), *map(float, m.w[k])] for m in (a, b))
    there = [math.pi - other[0], other[1], -other[2], -other[3]]
    return min(max(abs(x - y) for x, y in zip(one, to, strict=True)) for to in (other, there))


def judge_one(given, tally, number):
    body, state, times, how, tol = scene(given.seed, number, given.longest)
    line = f"motion {number}, tol={tol:.1e}, {body!r}, {state!r}, {how}"
    since = time.process_time()
    try:
        true, found = (sc.roll(body, state, times, tol=x, want="pose", **how) for x in (TRUTH, tol))
    except ValueError as error:
        tally.count("motions", "refused: " + str(error).split(":")[0])
        return
    tally.took(time.process_time() - since, line)
    kinds = "with losses" if "losses" in how else "e = 1" if how["restitution"] == 1.0 else "e < 1"
    if found.status != true.status:
        tally.count("motions", f"another end, claim {'in' if np.isinf(found.error) else ''}finite", line)
        return
    if np.isinf(found.error):
        tally.count("motions", "without a claim")
        return
    both = range(min(len(found.t), len(true.t)))
    off = max((apart(found, true, k) for k in both), default=0.0)
    if true.error > 0.1 * max(found.error, off):
        tally.count("motions", "the truth claims more than a tenth" if off else "alike at every tolerance")
        return
    tally.add(f"{kinds}: states", off, found.error, line)
    moved = max((float(np.abs(found.centre[k] - true.centre[k]).max()) for k in both), default=0.0)
    if true.pose_error <= 0.1 * max(found.pose_error, moved):
        tally.add(f"{kinds}: centre", moved, found.pose_error, line)


def judge(given, tally):
    if given.precise:
        against_digits(given, tally)
        return
    if given.only is not None:
        judge_one(given, tally, given.only)
        return
    for number, _ in blocks(given):
        judge_one(given, tally, number)


def against_digits(given, tally):
    """Compares random drops with the closed formulation of tests/reference in 50 digits."""
    sys.path.insert(0, str(FLIGHTS))
    import flight_closed
    import flights
    from series import precise

    rng = np.random.default_rng([given.seed, 50])
    for number in range(given.precise):
        body = flights.tube(rng.uniform(0.3, 3.0), rng.uniform())
        start = (rng.uniform(0.3, 1.3), *rng.normal(size=5))
        mu, e, height, end = rng.uniform(0.1, 0.6), rng.uniform(0.2, 0.9), rng.uniform(0.1, 1.0), 3.0
        precise(flights.DIGITS)
        made = flights.Scene(f"drop {number}", body, mu, e, start, end, height)
        rows = [
            row for kind, row in flights.follow(flight_closed.Closed(made)).rows if kind in ("sample", "end")
        ]
        of, state = (
            sc.Body(*made.body[:3], fillet=made.body[3]),
            sc.State(*start[:4], slip=start[4:], height=height),
        )
        times = [float(row[0]) for row in rows]
        for tol in (None, 1e-12, 1e-10, 1e-8):
            how = {} if tol is None else {"tol": tol}
            found = sc.roll(of, state, times, contact=sc.Coulomb(mu), restitution=e, t0=0.0, **how)
            off = 0.0
            for k, row in enumerate(rows[: len(found.t)]):
                y = [float(found.theta[k]), *map(float, found.w[k])]
                there = [math.pi - y[0], y[1], -y[2], -y[3]]
                off = max(
                    off,
                    min(max(abs(x - float(r)) for x, r in zip(z, row[1:5], strict=True)) for z in (y, there)),
                )
            line = f"drop {number}, {made.body}, {start}, mu={mu}, e={e}, height={height}"
            tally.add(f"50 digits, tol={tol}: states", off, found.error, line)
