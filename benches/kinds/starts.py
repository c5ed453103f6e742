"""Wrong results for starts at rest or almost, of sc.roll and sc.sweep.roll, against heyoka.

Needs the dependency group `peers`. Half of the starts do not tilt at all (theta' = 0), the others at 1e-300 to 1e-4 sqrt(g/R); rolling and
smooth, in blocks that share contact, mu, `beyond` and the last time (0.1 to 20 sqrt(R/g)). Each motion is
computed by `sc.roll` without `want`, by `sc.roll` with pose and force, and by `sc.sweep.roll`. The truth is
Newton's and Euler's equations in Taylor series with 64 bits (truth.py); a doubtful result is compared again
with 113 bits, and with the effect of half an ulp of the inputs.

    wrong      another end, or off by more than 10 claimed + 10 noise + 1e-9, in the state at a time, or the
               time or the state of the end
    claim      right, but off by more than 10 claimed + 10 noise + 1e-12
    vague      a claimed error above 1e-6
    unclear    another end, which half an ulp of the inputs would make the true one

The units are rad, sqrt(g/R) and sqrt(R/g).
"""

import time

import answers
import draws
import numpy as np
import truth
from judge import blocks

DEFAULTS, FEW = {"count": 100_000, "seed": 1, "show": 10}, "--count 5000"
BLOCK = 250
WAYS = [((), {}), (("pose", "force"), {})]


def off(found, claimed, floor, half_ulps=None):
    """Whether a difference is more than the claim, the noise and a floor explain."""
    parts = np.array([found.states, found.time, found.end])
    allowed = 10 * claimed + floor + (0.0 if half_ulps is None else 10 * np.array(half_ulps[1:4]))
    return bool((parts > allowed).any())


def unwatched(true, route, beyond):
    """The truth for a sweep beyond the ends: a motion is done if it comes to the last time."""
    if route != "sweep.roll" or not beyond or not len(true.rows):
        return true
    return truth.Path(truth.DONE, None, true.rows[-1], true.rows)


def verdict(start, times, beyond, answer, true):
    """One of right, wrong, claim, vague, unclear; and the differences."""
    numbers = [answer.path.time, *answer.path.end, *answer.path.rows.ravel(), answer.error]
    if np.isnan(np.array(numbers, dtype=float)).any():
        return "wrong", None
    found = answers.apart(answer.path, true)
    if found.kind or off(found, answer.error, 1e-12):
        exact = unwatched(truth.path(start, times, beyond=beyond), answer.route, beyond)
        found = answers.apart(answer.path, exact)
        if found.kind or off(found, answer.error, 1e-12):
            base = truth.path(start, times, bits=64, beyond=beyond)
            half_ulps = answers.noise(start, times, base, beyond, bits=64)
            if found.kind:
                return ("unclear" if answer.path.kind in half_ulps.kinds else "wrong"), found
            if off(found, answer.error, 1e-9, half_ulps):
                return "wrong", found
            if off(found, answer.error, 1e-12, half_ulps):
                return "claim", found
    return ("vague" if not answer.error <= 1e-6 else "right"), found


def enter(tally, start, times, t, beyond, answer, true):
    """Counts one result."""
    word, found, route = "refused", None, answer.route
    if answer.path.kind <= truth.SLIP:
        word, found = verdict(start, times, beyond, answer, true)
    row = f"{route}, theta' {'= 0' if start.w2 == 0 else 'of 1e-300 to 1e-4'}"
    tally.count(row, "asked")
    tally.count(route, f"by {answer.by}")
    if word == "right":
        return
    is_, said = answers.KINDS[true.kind], answers.KINDS[min(answer.path.kind, 4)]
    at = true.time if true.time is None else float(true.time)
    line = f"{answer.by}: {start.line(t)}  # beyond={beyond}; {is_} at {at!r}, not {said} at {float(answer.path.time)!r}"
    if found is not None:
        line += f"; off by {np.nanmax([*found[1:4], 0.0]):.1e}, claimed {answer.error:.1e}"
    tally.count(row, word, line)


def judge(given, tally):
    rng, spent = np.random.default_rng(given.seed), 0.0
    for _, count in blocks(given, BLOCK):
        scene = draws.scene(rng, 20.0)
        starts = [draws.at_rest(rng, scene) for _ in range(count)]
        t, beyond = scene["t"], scene["beyond"]
        clock = time.perf_counter()
        true = truth.paths(starts, [t / 3, t], bits=64, beyond=beyond)
        spent += time.perf_counter() - clock
        for i, times, answer, *_ in answers.routes(starts, t, beyond, lambda: WAYS):
            known = true[i]
            if known is None:
                tally.count("all routes", "without a truth", starts[i].line(t))
                continue
            if isinstance(answer, Exception):
                tally.count("roll", "refused", f"{starts[i].line(t)}  # {answer}")
                continue
            if len(times) == 1:
                known = unwatched(known._replace(rows=known.rows[1:]), answer.route, beyond)
                if beyond and known.kind not in (truth.DONE, truth.FACE):
                    continue  # it ends before the last time by a face that comes after another end
            enter(tally, starts[i], times, t, beyond, answer, known)
    tally.note(f"{spent:.0f} s for the truths")
