"""Whether many motions at once are what each of them is alone: `sc.sweep.roll` against `sc.roll` on random scenes.

    python benches/many.py --count 100000       an hour and a half on one core; --seed N --family N draws one family again

The scenes are those of tests/scenes.py: every contact, law, rim, end and kind of start. Kinds of ends have to be equal, and
times and states within both claims together. What is not is printed with its call; `make long` runs this with a fresh seed,
and prints it.
"""

import argparse
import collections
import pathlib
import sys
import time

import numpy as np
from limit import Late, limit

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests"))
import scenes

LONGEST = 60  # seconds of the processor of a family, after which it counts as hanging
FAMILY = 20


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=None, help="default: a fresh one")
    parser.add_argument("--family", type=int, default=None, help="only this one")
    parser.add_argument("--contact", default=None, help="only this one")
    parser.add_argument("--show", type=int, default=30)
    given = parser.parse_args()
    seed = given.seed if given.seed is not None else int(np.random.SeedSequence().entropy % 2**32)
    print(f"seed {seed}", flush=True)
    rows, shown, begun, slow = collections.defaultdict(collections.Counter), 0, time.perf_counter(), []
    families = range(given.count // FAMILY) if given.family is None else [given.family]
    for family in families:
        scene = scenes.draw(np.random.default_rng([seed, family]), FAMILY)
        if given.contact not in (None, scene.contact):
            continue
        name = f"{scene.contact}, {len(scene.losses)} laws"
        row, since = rows[name], time.process_time()
        try:
            with limit(LONGEST):
                for i, apart in enumerate(scenes.compare(scene)):
                    row["motions"] += 1
                    row["differ"] += apart.kind
                    row["beyond 2"] += apart.ratio > 2
                    row["beyond 10"] += apart.ratio > 10
                    row["vague, sweep"] += not apart.claims[0] <= 1e-6 and apart.status[0] not in (5, 6, 8)
                    row["vague, roll"] += not apart.claims[1] <= 1e-6 and apart.status[1] >= 0
                    row["bounded"] += apart.status[0] == 8
                    row["invalid"] += apart.status[0] in (5, 6)
                    if (apart.kind or apart.ratio > 2) and shown < given.show:
                        shown += 1
                        claims = "{:.1e} + {:.1e}".format(*apart.claims)
                        told = f"family {family}, motion {i}: status {apart.status}, {apart.ratio:.3g} of {claims} claimed"
                        print(f"! {told}: tol={scene.tol:g}\n    {apart.call}", flush=True)
        except Late:
            row["late"] += 1
            print(f"! family {family} takes more than {LONGEST} s", flush=True)
        slow.append((time.process_time() - since, family))
    names = [
        "motions",
        "differ",
        "beyond 2",
        "beyond 10",
        "vague, sweep",
        "vague, roll",
        "bounded",
        "invalid",
        "late",
    ]
    print(f"{'scene':20}" + "".join(f"{name:>13}" for name in names))
    rows["all"] = sum(rows.values(), collections.Counter())
    for name, row in sorted(rows.items()):
        print(f"{name:20}" + "".join(f"{row[name]:13d}" for name in names))
    told = ", ".join(f"{seconds:.1f} s (family {family})" for seconds, family in sorted(slow)[-5:])
    print(f"{time.perf_counter() - begun:.0f} s; the slowest: {told}")


if __name__ == "__main__":
    main()
