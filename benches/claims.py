"""Figure 2: true over claimed error of states, of each kind of event and of poses, against 113 bits.

    python benches/claims.py --count 10000         needs the dependency group `peers`; an hour on one core

Bodies and starts of all kinds: tubes, coins, general moments, bodies that could not be built (moments 1e-6 to
1e6, ell to 1000); at rest, almost at rest, steady, moving, nearly flat; theta beyond pi/2; numbers of one
decimal; with and without mu; forward and backward; rolling and smooth. Each motion is computed by `sc.roll`
without `want`, by `sc.roll` with pose and force, and by `sc.sweep.roll`; some also with `tol=` or `step=`.
The truth is Newton's and Euler's equations in Taylor series (truth.py) from the exact doubles.

A ratio is the true error over the claimed one: `Motion.error`, `Motion.pose_error`, or `error` of the sweep.
These claims cover all times of a motion and, if it ends, the time of the event and the state there. A ratio
of one is honest, a hundredth is vague. A claim of 0 beside a true error counts as infinite. A motion with
another end than the true one is counted separately, as "unclear" if half an ulp of the inputs makes its end
true.
"""

import argparse
import collections
import math
import time
import warnings

import answers
import draws
import numpy as np
import truth
from judge import Tally

import spincyl as sc

BLOCK = 25
#: a truth that needs more Taylor steps between two times takes too long, and is left out
STEPS = 3000


def asked(rng, scene, starts):
    """(index of the start, times, result or error, poses, options) of every route."""
    t, beyond = scene["t"], scene["beyond"]
    both = [t / 3, t]
    for i, start in enumerate(starts):
        hows = [((), {}), (("pose", "force"), {})]
        if rng.random() < 0.3:
            hows.append(((), {"tol": draws.log_uniform(rng, 1e-12, 1e-2)}))
        if rng.random() < 0.1:
            hows.append(((), {"step": math.copysign(draws.log_uniform(rng, 1e-4, 1e-2), t)}))
        for want, how in hows:
            try:
                yield i, both, *answers.rolled(start, both, beyond, want, **how), how
            except ValueError as e:
                yield i, both, e, None, how
    if not beyond:
        for i, answer in enumerate(answers.swept(starts, t, beyond)):
            yield i, [t], answer, None, {}


def enter(tally, start, times, beyond, answer, true, poses, how):
    """Adds the ratios of one result to the tally."""
    found = answers.apart(answer.path, true, poses)
    name, (said, is_) = (
        f"{answer.route} by {answer.by}",
        (answers.KINDS[k] for k in (answer.path.kind, true.kind)),
    )
    line = (
        f"{start.line(times)[:-1]}, t0=0.0, beyond={beyond}{''.join(f', {k}={v!r}' for k, v in how.items())})"
    )
    if found.kind:
        half_ulps = answers.noise(start, times, true, beyond)
        word = "unclear" if answer.path.kind in half_ulps.kinds else "another end"
        tally.count(
            f"{word}, {name}", f"{line}  # {is_} at {float(true.time)!r}, not {said} at {answer.path.time!r}"
        )
        return
    tally.add(f"{name}: states", found.states, answer.error, line)
    if true.kind != truth.DONE and (true.time != 0 or found.time != 0):  # an end at the start has no error
        tally.add(f"{name}: {is_} time", found.time, answer.error, line)
        tally.add(f"{name}: {is_} state", found.end, answer.error, line)
    if poses is not None:
        tally.add(f"{name}: poses", found.poses, answer.pose_error, line)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--longest", type=float, default=10.0, help="latest time")
    parser.add_argument("--show", type=int, default=3, help="of each that breaks a claim")
    given = parser.parse_args()
    warnings.simplefilter("ignore", sc.StepWarning)
    rng = np.random.default_rng(given.seed)
    tally, counts, clock, done = Tally(given.show, honest=1.0), collections.Counter(), time.perf_counter(), 0
    while done < given.count:
        scene = draws.scene(rng, given.longest)
        if rng.random() < 0.15:
            scene["t"] = -scene["t"]
        starts = [draws.any_start(rng, scene) for _ in range(min(BLOCK, given.count - done))]
        done += len(starts)
        t, beyond = scene["t"], scene["beyond"]
        true = []
        for start in starts:
            try:
                true.append(truth.path(start, [t / 3, t], pose=True, beyond=beyond, steps=STEPS))
            except ArithmeticError:
                counts["without a truth"] += 1
                true.append(None)
        for i, times, answer, poses, how in asked(rng, scene, starts):
            if true[i] is None:
                continue
            if isinstance(answer, Exception) or answer.path.kind > truth.SLIP:
                counts["refused"] += not how  # a step too large is rightly refused
                continue
            if len(times) == 1 and len(true[i].rows) < 2 and true[i].kind == truth.DONE:
                continue
            known = true[i] if len(times) == 2 else true[i]._replace(rows=true[i].rows[1:])
            enter(tally, starts[i], times, beyond, answer, known, poses, how)
    print(f"python benches/claims.py --count {given.count} --seed {given.seed} --longest {given.longest:g}")
    print(", ".join(f"{k} {n}" for k, n in counts.items()) + f"; {time.perf_counter() - clock:.0f} s")
    tally.print()


if __name__ == "__main__":
    main()
