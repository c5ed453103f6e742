"""The slowest of random motions of every kind, and the causes of their times.

    python benches/slowest.py                      1,000 motions of each kind, some minutes
    python benches/slowest.py --count 20000        the table of docs/benchmarks.md, hours
    python benches/slowest.py --only coins         one kind; --only coins:17 shows one motion

The first three kinds are the launches of a tube with friction, the same with one loss law or two, and tubes that roll
with losses, to t = 200. The other kinds are those of drawn_kinds.py, with Coulomb friction, each loss law or none, and
a coefficient of restitution of 0 or 0.5 in turn, to t = 60 (stones to 10). The tolerance is 1e-8, for each motion alone
and for a sweep on one thread of those with the same kind, law and restitution; the sweep has one mean. Times are those
of the processor. The last column is the median, over every `--each`-th motion, of the difference between the motion
and another within 1e-12, shortly before the end, in units of the sum of both estimated errors.
"""

import argparse
import time
import warnings
from collections import Counter, defaultdict
from typing import NamedTuple

import numpy as np
from aloft import told
from drawn_kinds import KINDS, at_once, drawn
from drawn_motions import Drawn

import spincyl as sc

TOL, TRUE = 1e-8, 1e-12
LAWS = sc.loss.Law.__subclasses__()
TUBES = ("launch", "launch with losses", "rolling with losses")
RESTLESS = 100  # phases of a motion that slips again in every nod
FLAT = 1e-3
HEADS = (
    "median, ms | mean | 99 % | 99.9 % | slowest | given up | refused | mean in a sweep | error over claim"
)


class Made(NamedTuple):
    """A motion, its processor seconds, and their cause."""

    kind: str
    k: int
    law: str
    bounce: str
    scene: Drawn
    seconds: float
    why: str
    ratio: float  # true over estimated error; NaN if unknown


def tube(rng, kind):
    """A tube, a state, and the options of the motion."""
    body = sc.Body.tube(10 ** rng.uniform(-1, 0.8), bore=rng.choice([0, 0.3, 0.8, 0.95]))
    theta, w, slip = rng.uniform(0.05, 1.55), rng.uniform(-3, 3, 3) * [1, 1, 2], rng.uniform(-2, 2, 2)
    how, name = {}, "no loss"
    if kind != TUBES[2]:
        how |= {"contact": sc.Coulomb(10 ** rng.uniform(-2, 0)), "restitution": 0.0}
    if kind != TUBES[0]:
        some = rng.choice(len(LAWS), size=rng.integers(1, 3), replace=False)
        how["losses"] = sum(LAWS[i](10 ** rng.uniform(-4, -1)) for i in some)
        name = LAWS[some[0]].__name__ if len(some) == 1 else "two laws"
    slips = kind != TUBES[2] and rng.random() < 0.6
    state = sc.State(theta, *w, slip=tuple(slip)) if slips else sc.State(theta, *w)
    return (
        Drawn(body, state, np.array([0.0, 200.0]), how),
        name,
        "e = 0" if "restitution" in how else "no impact",
    )


def followed(scene, tol=TOL, t=None):
    """A motion or None, its processor seconds, and their cause."""
    since, found, refused = time.process_time(), None, ""
    try:
        found = sc.roll(scene.body, scene.state, scene.times if t is None else t, tol=tol, **scene.how)
    except ValueError as error:
        refused = "refused: " + str(error).split(":")[-1][:50].strip()
    seconds = time.process_time() - since
    return found, seconds, refused or cause(found)


def cause(found):
    if found.status == sc.Ending.BOUNDED:
        return "given up"
    if not isinstance(found.contact, str) and len(found.phases) >= RESTLESS:
        return "slips again in every nod"
    low = min(found.theta[-1:].tolist() + ([found.event.state.theta] if found.event else []), default=1.0)
    return "all but flat" if low < FLAT else "goes on" if found.event is None else "ends"


def honest(scene, found):
    """The true over the estimated error a tenth of the motion before its end."""
    end = scene.times[-1] if found.event is None else found.event.time
    some = [followed(scene, tol, [0.0, 0.9 * end])[0] for tol in (TOL, TRUE)]
    if any(m is None or len(m.t) < 2 for m in some):
        return np.nan
    apart = [last(scene, m) for m in some]
    return float(np.abs(apart[0] - apart[1]).max()) / max(sum(m.error for m in some), 1e-300)


def last(scene, m):
    if isinstance(scene.body, sc.Ellipsoid):
        return np.concatenate([m.vertical[-1], m.w[-1]])
    return told(m, -1) if "restitution" in scene.how else np.array([m.theta[-1], *m.w[-1]])


def motions(kind, given):
    """The motions of a kind, one after the other."""
    rng = np.random.default_rng([given.seed, TUBES.index(kind) if kind in TUBES else 0])
    for k in range(given.count):
        scene, law, bounce = tube(rng, kind) if kind in TUBES else drawn(kind, k, given.seed)
        if given.number in (None, k):
            found, seconds, why = followed(scene)
            ratio = honest(scene, found) if found is not None and k % given.each == 0 else np.nan
            yield Made(kind, k, law, bounce, scene, seconds, why, ratio)


def swept(made):
    """{motion: processor seconds} in sweeps of all with the same law and restitution."""
    sets, seconds = defaultdict(list), {}
    for one in made:
        if one.law != "two laws":
            sets[one.kind, one.law, one.bounce].append(one)
    for some in sets.values():
        body, state, how = at_once([one.scene for one in some])
        since = time.process_time()
        sc.sweep.roll(body, state, float(some[0].scene.times[-1]), tol=TOL, threads=1, **how)
        each = (time.process_time() - since) / len(some)
        seconds |= {(one.kind, one.k): each for one in some}
    return seconds


def row(name, made, at_once):
    ms = 1e3 * np.array([one.seconds for one in made])
    middle, late, later = np.quantile(ms, [0.5, 0.99, 0.999])
    up, refused = (sum(one.why.startswith(word) for one in made) for word in ("given up", "refused"))
    many = [1e3 * at_once[one.kind, one.k] for one in made if (one.kind, one.k) in at_once]
    ratios = [one.ratio for one in made if np.isfinite(one.ratio)]
    means = [f"{np.mean(many):.3f}" if many else "", f"{np.median(ratios):.2g}" if ratios else ""]
    numbers = f"{middle:.3f} | {ms.mean():.2f} | {late:.1f} | {later:.0f} | {ms.max():.0f} | {up} | {refused}"
    print(f"{name} | {numbers} | {' | '.join(means)}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1000, help="of each kind")
    parser.add_argument("--seed", type=int, default=28)
    parser.add_argument("--each", type=int, default=19, help="the true error of one motion among so many")
    parser.add_argument("--only", help="KIND or KIND:NUMBER")
    given = parser.parse_args()
    only, _, number = (given.only or "").partition(":")
    given.number = int(number) if number else None
    given.count = max(given.count, (given.number or 0) + 1)
    warnings.simplefilter("ignore")
    sc.sweep.roll(sc.Body.solid([1.0]), sc.State(1.0, 0.5, 0.0, 0.5), 1.0)  # what the first sweep loads
    everything, at_once = [], {}
    print(f"kind | {HEADS}")
    for kind in [kind for kind in (*TUBES, *KINDS) if not only or kind == only]:
        made = list(motions(kind, given))
        if number:
            print(made[0].scene.call(), made[0]._replace(scene=None), sep="\n")
            return
        at_once |= swept(made)
        row(kind, made, at_once)
        slow = sorted(made, key=lambda one: -one.seconds)[: max(given.count // 100, 1)]
        share = sum(one.seconds for one in slow) / sum(one.seconds for one in made)
        causes = ", ".join(f"{n} {why}" for why, n in Counter(one.why for one in slow).most_common())
        print(f"    the slowest hundredth takes {100 * share:.0f} % of the time: {causes}", flush=True)
        everything += made
    for name, of in (("loss law", lambda one: one.law), ("impacts", lambda one: one.bounce)):
        print(f"\n{name}, of the kinds of drawn_kinds.py | {HEADS}")
        sets = defaultdict(list)
        for one in everything:
            if one.kind not in TUBES:
                sets[of(one)].append(one)
        for word, some in sorted(sets.items()):
            row(word, some, at_once)
    print("\nthe twenty slowest | number of its kind | loss law | impacts | ms | why")
    for one in sorted(everything, key=lambda one: -one.seconds)[:20]:
        print(f"{one.kind} | {one.k} | {one.law} | {one.bounce} | {1e3 * one.seconds:.0f} | {one.why}")


if __name__ == "__main__":
    main()
