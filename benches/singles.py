"""CPU times and claims of single motions: random scenes to t = 50, by `sc.roll`, as accurately as doubles
allow.

    python benches/singles.py --count 5000      four minutes on one core; --seed N draws the same again

The scenes are those of tests/scenes.py, with one last time. Prints the slowest of them, how many were refused
with which message, and those that claim more than 1e-6; `--calls` adds the calls. Each may take `--longest`
CPU seconds.
"""

import argparse
import collections
import pathlib
import re
import sys
import time
import warnings

import numpy as np
from limit import Late, limit

import spincyl as sc

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests"))
import scenes

FAMILY, SPAN, VAGUE = 20, 50.0, 1e-6


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=None, help="default: a fresh one")
    parser.add_argument("--longest", type=float, default=60.0, help="seconds of the processor for one motion")
    parser.add_argument("--show", type=int, default=20)
    parser.add_argument("--calls", action="store_true", help="the calls of the slowest and the vaguest")
    given = parser.parse_args()
    seed = given.seed if given.seed is not None else int(np.random.SeedSequence().entropy % 2**32)
    print(f"seed {seed}", flush=True)
    warnings.simplefilter("ignore")
    took, refused, vague, lossy = [], collections.Counter(), [], 0
    for family in range(given.count // FAMILY):
        scene = scenes.draw(np.random.default_rng([seed, family]), FAMILY)._replace(times=np.array([SPAN]))
        integrated = bool(scene.losses) or scene.contact in ("coulomb", "viscous")
        for i in range(FAMILY):
            how = f"family {family}, motion {i}"
            lossy += integrated
            said, since = "answered", time.process_time()
            try:
                body, state, asked = scene.asked(i)
                with limit(given.longest):
                    m = sc.roll(body, state, SPAN, **asked)
                if not m.error <= VAGUE:
                    vague.append((m.error, how, integrated, scene.call(i)))
            except Late:
                said = "hangs"
            except ValueError as e:
                words = str(e).split(": ", maxsplit=1)[-1]
                said = re.sub(r"-?\d[\d.e+-]*", "#", words).split(",")[0]
                refused[said] += 1
            took.append((time.process_time() - since, how, said, scene.call(i)))
    took.sort(reverse=True)
    print(f"{len(took)} motions, {lossy} with friction or losses; the slowest, in seconds of the processor:")
    for seconds, how, said, call in took[: given.show]:
        print(f"{seconds:9.3f}  {how}: {said}" + (f"\n    {call}" if given.calls else ""))
    print(f"claims above {VAGUE:g}: {len(vague)}, {sum(v[2] for v in vague)} of them with friction or losses")
    for claim, how, _, call in sorted(vague, reverse=True):
        print(f"{claim:9.1e}  {how}" + (f"\n    {call}" if given.calls else ""))
    print("refused:")
    for words, count in refused.most_common():
        print(f"{count:9d}  {words}")


if __name__ == "__main__":
    main()
