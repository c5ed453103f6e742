"""Friction of a patch: random scenes, alone and at once, and the times of a tippe top and of a coin.

    python benches/patches.py [--count 10000] [--seed 52]     five minutes

Prints the number of each ending, alone and at once, the motions that differ by more than both estimated errors, the
slowest motions, and the errors raised; then the times of a tippe top that turns over and of a 2-euro coin that whirrs to its face.
The command fails if a motion alone and at once end in different ways.
"""

import argparse
import contextlib
import sys
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

import spincyl as sc
from spincyl.sweep import Status

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
import scenes

FAMILY = 20
#: A motion slower than this is named, in seconds of the processor.
SLOW = 1.0


def named(status):
    return "refused" if status < 0 else Status(status).name


def random_scenes(count, seed):
    ends, apart, slow, wrong = Counter(), [], [], 0
    for family in range(count // FAMILY):
        scene = scenes.draw(np.random.default_rng([seed, family]), FAMILY, "patch")
        for found in scenes.compare(scene):
            ends[tuple(map(named, found.status))] += 1
            wrong += found.kind
            if found.kind or found.ratio > 1:
                apart.append(found)
        for i in range(FAMILY):
            since = time.process_time()
            with contextlib.suppress(ValueError):
                scenes.alone(scene, i)
            spent = time.process_time() - since
            if spent > SLOW:
                slow.append((spent, scene.call(i)))
    print(f"{sum(ends.values())} motions: ends alone and at once")
    for pair, many in ends.most_common():
        print(f"  {many:6d}  {' / '.join(pair)}")
    print(f"{len(apart)} differ by more than both estimated errors, {wrong} of them in their endings")
    for found in sorted(apart, key=lambda x: -x.ratio)[:5]:
        print(f"  {found.ratio:.1f} of {found.claims}: {found.call}")
    print(f"{len(slow)} take more than {SLOW:g} s of the processor")
    for spent, call in sorted(slow, reverse=True)[:5]:
        print(f"  {spent:.1f} s: {call}")
    return wrong


def best(count, *given, **how):
    """A motion, and the least milliseconds of `count` runs."""
    least = np.inf
    for _ in range(count):
        since = time.perf_counter()
        m = sc.roll(*given, **how)
        least = min(least, time.perf_counter() - since)
    return m, 1e3 * least


def showcases():
    top = sc.Body.ball(-0.2, 0.40, 0.42)
    spun = top.with_centre_velocity(sc.State(0.1, 0.0, 0.0, 7.0), 0.0, 0.0)
    for tol in (1e-8, 1e-10, 1e-12):
        m, ms = best(20, top, spun, 39.0, contact=sc.Coulomb(0.3, patch=0.02), tol=tol)
        print(f"a tippe top to {m.theta[-1]:.2f} rad, tol {tol:g}: {ms:.2f} ms, claim {m.error:.1e}")
    coin = sc.Body.solid(2.2 / 25.75)
    for arm in (3e-3, 1e-3):
        how = {"contact": sc.Coulomb(0.3, patch=0.4 / 25.75), "losses": sc.loss.RollingResistance(arm)}
        m, ms = best(5, coin, coin.steady(0.5), 2000.0, tol=1e-10, **how)
        print(
            f"a coin to its face, arm {arm:g}: {m.event.time:.6f}, {len(m.phases)} phase, {ms:.0f} ms, claim {m.error:.1e}"
        )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=52)
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    showcases()
    sys.exit(random_scenes(given.count, given.seed) > 0)
