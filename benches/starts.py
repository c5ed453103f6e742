"""Figure 1: wrong results for starts at rest or almost, of sc.roll and sc.sweep.roll, against heyoka.

    python benches/starts.py --count 100000        needs the dependency group `peers`; on one core

Half of the starts do not tilt at all (theta' = 0), the others at 1e-300 to 1e-4 sqrt(g/R); rolling and
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

import argparse
import collections
import time

import answers
import draws
import numpy as np
import truth

BLOCK = 250


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


def judge(start, times, beyond, answer, true):
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


def block(rng, count):
    """A scene and its starts, some of which may be refused."""
    scene = draws.scene(rng, 20.0)
    return scene, [draws.at_rest(rng, scene) for _ in range(count)]


def asked(scene, starts):
    """(index of the start, times, result or error) of every route."""
    t, beyond = scene["t"], scene["beyond"]
    both = [t / 3, t]
    for i, start in enumerate(starts):
        for want in ((), ("pose", "force")):
            try:
                yield i, both, answers.rolled(start, both, beyond, want)[0]
            except ValueError as e:
                yield i, both, e
    for i, answer in enumerate(answers.swept(starts, t, beyond)):
        yield i, [t], answer


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--show", type=int, default=10, help="how many lines of each kind")
    given = parser.parse_args()
    rng = np.random.default_rng(given.seed)
    counts, lines = collections.Counter(), collections.defaultdict(list)
    spent = collections.Counter()
    done = 0
    while done < given.count:
        scene, starts = block(rng, min(BLOCK, given.count - done))
        done += len(starts)
        t, beyond = scene["t"], scene["beyond"]
        clock = time.perf_counter()
        true = []
        for start in starts:
            try:
                true.append(truth.path(start, [t / 3, t], bits=64, beyond=beyond))
            except ArithmeticError as e:
                true.append(e)
        spent["truth"] += time.perf_counter() - clock
        clock = time.perf_counter()
        for i, times, answer in asked(scene, starts):
            if isinstance(true[i], Exception):
                counts["no truth"] += 1
                lines["no truth"].append(f"{starts[i].line(t)}  # {true[i]}")
                continue
            if isinstance(answer, Exception):
                counts["refused"] += 1
                lines["refused"].append(f"{starts[i].line(t)}  # {answer}")
                continue
            known = true[i]
            if len(times) == 1:
                known = unwatched(known._replace(rows=known.rows[1:]), answer.route, beyond)
                if beyond and known.kind not in (truth.DONE, truth.FACE):
                    continue  # it ends before the last time by a face that comes after another end
            if answer.path.kind > truth.SLIP:
                verdict, found = "refused", None
            else:
                verdict, found = judge(starts[i], times, beyond, answer, known)
            still = "still" if starts[i].w2 == 0 else "almost"
            counts[answer.route, still, "asked"] += 1
            counts[answer.route, "by", answer.by] += 1
            if verdict != "right":
                counts[answer.route, still, verdict] += 1
                said = f"{answers.KINDS[known.kind]} at {known.time if known.time is None else float(known.time)!r}, not {answers.KINDS[min(answer.path.kind, 4)]} at {float(answer.path.time)!r}"
                worst = (
                    ""
                    if found is None
                    else f"; off by {np.nanmax([*found[1:4], 0.0]):.1e}, claimed {answer.error:.1e}"
                )
                lines[verdict].append(
                    f"{answer.route} by {answer.by}: {starts[i].line(t)}  # beyond={beyond}; {said}{worst}"
                )
        spent["library and judgement"] += time.perf_counter() - clock
    print(f"python benches/starts.py --count {given.count} --seed {given.seed}")
    for route in ("roll", "roll, want", "sweep.roll"):
        by = ", ".join(f"{k[2]} {n}" for k, n in counts.items() if k[:2] == (route, "by"))
        print(f"{route} (answered by {by})")
        for still, name in (("still", "theta' = 0"), ("almost", "theta' of 1e-300 to 1e-4")):
            n = counts[route, still, "asked"]
            rest = ", ".join(
                f"{v} {counts[route, still, v]}" for v in ("wrong", "claim", "vague", "unclear", "refused")
            )
            print(f"  {name}: {n} asked, {rest}")
    print(f"  refused by roll {counts['refused']}, without a truth {counts['no truth']}")
    print(", ".join(f"{name} {seconds:.0f} s" for name, seconds in spent.items()))
    for verdict, those in lines.items():
        print(f"{verdict}: the first {min(given.show, len(those))} of {len(those)}")
        print("\n".join(those[: given.show]))


if __name__ == "__main__":
    main()
