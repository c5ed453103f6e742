"""True over claimed error of states, of each kind of event and of poses, against 113 bits.

Needs the dependency group `peers`; 10,000 motions take an hour on one core. Bodies and starts of all kinds:
tubes, coins, general moments, bodies that could not be built (moments 1e-6 to 1e6, ell to 1000); at rest,
almost at rest, steady, moving, nearly flat; theta beyond pi/2; numbers of one decimal; with and without mu;
forward and backward; rolling and smooth. Each motion is computed by `sc.roll` without `want`, by `sc.roll`
with pose and force, and by `sc.sweep.roll`; some also with `tol=` or `step=`. The truth is Newton's and
Euler's equations in Taylor series (truth.py) from the exact doubles.

The claims are `Motion.error`, `Motion.pose_error`, or `error` of the sweep. They cover all times of a motion
and, if it ends, the time of the event and the state there. A motion with another end than the true one is
counted separately, as "unclear" if half an ulp of the inputs makes its end true.
"""

import math

import answers
import draws
import numpy as np
import truth
from judge import blocks

DEFAULTS, FEW, HONEST = {"count": 10_000, "seed": 1, "show": 3}, "--count 500", 1.0
BLOCK = 25
#: a truth that needs more Taylor steps between two times takes too long, and is left out
STEPS = 3000


def options(add):
    add("--longest", type=float, default=10.0, help="latest time")


def ways(rng, t):
    """`want` and options of `sc.roll` for one start."""
    hows = [((), {}), (("pose", "force"), {})]
    if rng.random() < 0.3:
        hows.append(((), {"tol": draws.log_uniform(rng, 1e-12, 1e-2)}))
    if rng.random() < 0.1:
        hows.append(((), {"step": math.copysign(draws.log_uniform(rng, 1e-4, 1e-2), t)}))
    return hows


def enter(tally, start, times, beyond, answer, true, poses, how):
    """Adds the ratios of one result to the tally."""
    found = answers.apart(answer.path, true, poses)
    name = f"{answer.route} by {answer.by}"
    said, is_ = (answers.KINDS[k] for k in (answer.path.kind, true.kind))
    more = "".join(f", {k}={v!r}" for k, v in how.items())
    line = f"{start.line(times)[:-1]}, t0=0.0, beyond={beyond}{more})"
    if found.kind:
        half_ulps = answers.noise(start, times, true, beyond)
        word = "unclear" if answer.path.kind in half_ulps.kinds else "another end"
        tally.count(
            name, word, f"{line}  # {is_} at {float(true.time)!r}, not {said} at {answer.path.time!r}"
        )
        return
    tally.add(f"{name}: states", found.states, answer.error, line)
    if true.kind != truth.DONE and (true.time != 0 or found.time != 0):  # an end at the start has no error
        tally.add(f"{name}: {is_} time", found.time, answer.error, line)
        tally.add(f"{name}: {is_} state", found.end, answer.error, line)
    if poses is not None:
        tally.add(f"{name}: poses", found.poses, answer.pose_error, line)


def judge(given, tally):
    rng = np.random.default_rng(given.seed)
    for _, count in blocks(given, BLOCK):
        scene = draws.scene(rng, given.longest)
        if rng.random() < 0.15:
            scene["t"] = -scene["t"]
        starts = [draws.any_start(rng, scene) for _ in range(count)]
        t, beyond = scene["t"], scene["beyond"]
        true = truth.paths(starts, [t / 3, t], pose=True, beyond=beyond, steps=STEPS)
        tally.count("motions", "without a truth", n=true.count(None))
        routes = answers.routes(starts, t, beyond, lambda t=t: ways(rng, t), sweep=not beyond)
        for i, times, answer, poses, how in routes:
            if true[i] is None:
                continue
            if isinstance(answer, Exception) or answer.path.kind > truth.SLIP:
                tally.count("motions", "refused", n=not how)  # a step too large is rightly refused
                continue
            if len(times) == 1 and len(true[i].rows) < 2 and true[i].kind == truth.DONE:
                continue
            known = true[i] if len(times) == 2 else true[i]._replace(rows=true[i].rows[1:])
            enter(tally, starts[i], times, beyond, answer, known, poses, how)
