"""Compares many motions at once, `sc.sweep.roll`, with each of them alone, `sc.roll`, on random scenes.

    python benches/many.py --count 100000                    an hour and a half on one core
    python benches/many.py --seed N --family N               one family again
    python benches/many.py --grazing --count 5000 --seed 5   starts that only just meet an end or just miss it

The scenes are those of tests/scenes.py: every contact, law, rim, end and kind of start. Kinds of ends must be
equal, and times, states and periods must agree within the sum of both claims. Motions that violate this are
printed with their calls. `make long` runs this with a fresh seed, which is printed. Rows are of contacts and
of laws: a motion with three laws counts in three of them.

Grazing starts: the straight line between two random starts of one body is halved until a place is found where
the kind of the end changes. The starts lie on both sides of this place, at 1e-7 to 1e-2 of the length of the
line, but never as near as the sum of both claims, within which either end is right. Half the bodies have a
theta_end of their own.
"""

import argparse
import collections
import itertools
import pathlib
import sys
import time
import warnings

import numpy as np
from limit import Late, limit

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests"))
import scenes

import spincyl as sc

LONGEST = 60  # CPU seconds after which a family counts as hanging
FAMILY, GRAZING = 20, 40
#: for every contact: each law alone, none, and several
LAWS = ([], *([k] for k in range(8)), [0, 3], [2, 4], [0, 1, 2, 3, 4, 5])
NAMES = [law.__name__ for law in scenes.LAWS]
COLUMNS = (
    "motions",
    "differ",
    "beyond 2",
    "beyond 10",
    "vague, sweep",
    "vague, roll",
    "bounded",
    "refused",
    "invalid",
    "late",
    "periods",
    "period, 2",
    "period, 10",
)


def told(scene, starts):
    """The status of the motions of a scene from these starts."""
    body, state, how = scene._replace(starts=starts).asked(slice(None))
    t = float(scene.times[-1])
    return sc.sweep.roll(body, state, t, want="end", tol=scene.tol, threads=1, **how)["status"].to_numpy()


def grazing(rng, contact, laws, count):
    """A scene of starts that graze an end, the names of the ends on both sides, and the distances from the
    change; perhaps fewer than `count`."""
    many = 2 * count
    scene = scenes.draw(rng, many, contact, laws)
    ends = np.where(rng.random(many) < 0.5, np.pi / 2, rng.uniform(0.3, 1.5, many))
    ends = np.where(scene.bodies[:, 3] == 1.0, np.pi, ends)
    ends = np.where((scene.bodies[:, 0] == 0.0) & (ends == np.pi / 2), np.pi, ends)
    near = ends - scenes.log_uniform(rng, 1e-5, 0.3, many)
    scene = scene._replace(theta_end=ends, times=np.array([scenes.log_uniform(rng, 0.3, 10)]))
    if contact == "coulomb" and rng.random() < 0.5:
        scene = scene._replace(table=scene.table[:, :1] * np.array([1.0, 1.3]))
    both = []
    for _ in range(2):
        starts = scenes.draw_starts(rng, scene.bodies)
        theta = np.where(rng.random(many) < 0.5, near, starts[:, 0])
        starts[:, 0] = np.where(ends < 3, np.minimum(theta, near), theta)
        both.append(starts)
    way = both[1] - both[0]
    low, high = np.zeros(many), np.ones(many)
    first, last = told(scene, both[0]), told(scene, both[1])
    for _ in range(40):
        middle = (low + high) / 2
        found = told(scene, both[0] + middle[:, None] * way)
        low, high = np.where(found == first, middle, low), np.where(found == first, high, middle)
        last = np.where(found == first, last, found)
    some = np.flatnonzero((first != last) & (first != 5) & (last != 5))[: count // 2]
    far = scenes.log_uniform(rng, max(1e-7, 1e3 * scene.tol), 1e-2, some.size)
    sides = np.clip(np.concatenate([low[some] - far, high[some] + far]), 0, 1)
    twice = np.concatenate([some, some])
    scene = scene._replace(
        bodies=scene.bodies[twice],
        starts=both[0][twice] + sides[:, None] * way[twice],
        table=scene.table[twice],
        losses={k: x[twice] for k, x in scene.losses.items()},
        theta_end=ends[twice],
    )
    kinds = [
        f"{sc.sweep.Status(a).name} or {sc.sweep.Status(b).name}" for a, b in zip(first, last, strict=True)
    ]
    return scene, [kinds[i] for i in twice], np.concatenate([far, far]) * np.abs(way[twice]).max(axis=1)


def random(seed, count, contact):
    """Random scenes, each with its number, without the names of their ends."""
    for family in range(count // FAMILY):
        scene = scenes.draw(np.random.default_rng([seed, family]), FAMILY)
        if contact in (None, scene.contact):
            yield family, lambda scene=scene: (scene, itertools.repeat(""), itertools.repeat(np.inf))


def grazes(seed, count, contact):
    """Scenes of starts that graze an end."""
    each = [(c, laws) for c in scenes.CONTACTS if contact in (None, c) for laws in LAWS]
    for family in range(max(1, count // GRAZING)):
        which, rng = each[family % len(each)], np.random.default_rng([seed, family])
        yield family, lambda which=which, rng=rng: grazing(rng, *which, GRAZING)


def count_in(row, apart, doubt):
    """Adds a motion to a row; returns whether it is wrong."""
    claims = sum(apart.claims)
    differs = apart.kind and not doubt < 100 * claims
    refused = apart.status[1] < 0
    row["motions"] += 1
    row["differ"] += differs
    row["beyond 2"] += apart.ratio > 2
    row["beyond 10"] += apart.ratio > 10
    row["vague, sweep"] += not apart.claims[0] <= 1e-6 and apart.status[0] not in (5, 6, 8)
    row["vague, roll"] += not apart.claims[1] <= 1e-6 and not refused
    row["bounded"] += apart.status[0] == 8
    row["refused"] += refused and apart.status[0] not in (5, 6)
    row["invalid"] += apart.status[0] in (5, 6)
    return differs or apart.ratio > 2


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=None, help="default: a fresh one")
    parser.add_argument("--family", type=int, default=None, help="only this one")
    parser.add_argument("--contact", default=None, help="only this one")
    parser.add_argument("--grazing", action="store_true", help="starts that graze an end")
    parser.add_argument("--show", type=int, default=30)
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    seed = given.seed if given.seed is not None else int(np.random.SeedSequence().entropy % 2**32)
    print(f"seed {seed}", flush=True)
    rows, shown, begun, slow = collections.defaultdict(collections.Counter), 0, time.perf_counter(), []
    ends = collections.Counter()
    for family, drawn in (grazes if given.grazing else random)(seed, given.count, given.contact):
        if given.family not in (None, family):
            continue
        since = time.process_time()
        try:
            with limit(LONGEST):
                scene, kinds, doubts = drawn()
                of = [scene.contact, *(NAMES[k] for k in scene.losses or []), "all"]
                of += [] if scene.losses else ["no law"]
                for i, (apart, kind, doubt) in enumerate(
                    zip(scenes.compare(scene), kinds, doubts, strict=False)
                ):
                    ends[kind] += 1
                    wrong = [count_in(rows[name], apart, doubt) for name in of]
                    if wrong[0] and shown < given.show:
                        shown += 1
                        claims = "{:.1e} + {:.1e}".format(*apart.claims)
                        says = f"status {apart.status}, {apart.ratio:.3g} of {claims} claimed"
                        print(
                            f"! family {family}, motion {i}: {says}: tol={scene.tol:g} {kind}\n    {apart.call}",
                            flush=True,
                        )
                if not given.grazing:
                    for i, (ratio, call) in enumerate(scenes.compare_periods(scene)):
                        rows["all"]["periods"] += 1
                        rows["all"]["period, 2"] += not ratio <= 2
                        rows["all"]["period, 10"] += not ratio <= 10
                        if not ratio <= 2 and shown < given.show:
                            shown += 1
                            says = f"{ratio:.3g} of both claims"
                            print(f"! family {family}, period {i}: {says}\n    {call}", flush=True)
        except KeyboardInterrupt:
            print("! interrupted: what follows is of the motions before", flush=True)
            break
        except Late:
            rows["all"]["late"] += 1
            print(f"! family {family} takes more than {LONGEST} s", flush=True)
        slow.append((time.process_time() - since, family))
    if given.grazing:
        print("\n".join(f"{n:8d} {kind}" for kind, n in ends.most_common()))
    print(f"{'of':20}" + "".join(f"{name:>13}" for name in COLUMNS))
    for name in [*scenes.CONTACTS, "no law", *NAMES, "all"]:
        if name in rows:
            print(f"{name:20}" + "".join(f"{rows[name][column]:13d}" for column in COLUMNS))
    slowest = ", ".join(f"{seconds:.1f} s (family {family})" for seconds, family in sorted(slow)[-5:])
    print(f"{time.perf_counter() - begun:.0f} s; the slowest: {slowest}")


if __name__ == "__main__":
    main()
