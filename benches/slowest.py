"""The slowest of random motions, and the causes of their times.

    python benches/slowest.py                  three kinds of 3000 motions, a minute
    python benches/slowest.py --count 100000   half an hour

Launches slip on dry friction and land without a bounce; the second kind also loses energy by one law or two,
and the third one rolls with losses. Tubes with ell from 0.1 to 6.3, mu from 0.01 to 1, coefficients from 1e-4
to 0.1, each motion alone, to t = 200 with a tolerance of 1e-8. Most of them end early, so that the median is
small.
"""

import argparse
import time
import warnings
from collections import Counter

import numpy as np

import spincyl as sc

LAWS = sc.loss.Law.__subclasses__()
KINDS = ("launch", "launch with losses", "rolling with losses")
RESTLESS = 100  # phases of a motion that slips again in every nod
FLAT = 1e-3


def drawn(rng, kind):
    """A body, a state, and the options of the motion."""
    body = sc.Body.tube(10 ** rng.uniform(-1, 0.8), bore=rng.choice([0, 0.3, 0.8, 0.95]))
    theta, w, slip = rng.uniform(0.05, 1.55), rng.uniform(-3, 3, 3) * [1, 1, 2], rng.uniform(-2, 2, 2)
    how = {"tol": 1e-8}
    if kind != KINDS[2]:
        how |= {"contact": sc.Coulomb(10 ** rng.uniform(-2, 0)), "restitution": 0.0}
    if kind != KINDS[0]:
        some = rng.choice(len(LAWS), size=rng.integers(1, 3), replace=False)
        how["losses"] = sum(LAWS[i](10 ** rng.uniform(-4, -1)) for i in some)
    slips = kind != KINDS[2] and rng.random() < 0.6
    return body, sc.State(theta, *w, slip=tuple(slip)) if slips else sc.State(theta, *w), how


def followed(body, state, how):
    """CPU seconds of a motion, and their cause."""
    since, found, refused = time.process_time(), None, None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = sc.roll(body, state, [0.0, 200.0], **how)
    except ValueError as error:
        refused = str(error)
    seconds = time.process_time() - since
    if refused is not None:
        return seconds, "refused: " + refused.split(":")[-1][:50].strip()
    if found.status == sc.Ending.BOUNDED:
        return seconds, "given up"
    if "contact" in how and len(found.phases) >= RESTLESS:
        return seconds, "slips again in every nod"
    low = min(found.theta[-1:].tolist() + ([found.event.state.theta] if found.event else []), default=1.0)
    return seconds, "all but flat" if low < FLAT else "goes on" if found.event is None else "ends"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=3000, help="of each kind")
    parser.add_argument("--seed", type=int, default=28)
    given = parser.parse_args()
    print("kind | median, ms | mean | 99 % | 99.9 % | slowest | above 0.1 s | above 1 s")
    worst = []
    for number, kind in enumerate(KINDS):
        rng = np.random.default_rng([given.seed, number])
        made = [(*followed(*drawn(rng, kind)), kind, k) for k in range(given.count)]
        ms = 1e3 * np.array([one[0] for one in made])
        late = np.quantile(ms, [0.5, 0.99, 0.999])
        print(
            f"{kind} | {late[0]:.3f} | {ms.mean():.2f} | {late[1]:.1f} | {late[2]:.0f} | {ms.max():.0f} | "
            f"{(ms > 100).sum()} | {(ms > 1000).sum()}",
            flush=True,
        )
        slow = sorted(made, reverse=True)[: max(given.count // 100, 1)]
        share = sum(one[0] for one in slow) / (1e-3 * ms.sum())
        causes = ", ".join(f"{n} {why}" for why, n in Counter(one[1] for one in slow).most_common())
        print(f"    the slowest hundredth takes {100 * share:.0f} % of the time: {causes}", flush=True)
        worst += slow[:20]
    print("\nthe twenty slowest | number of its kind | ms | why")
    for seconds, why, kind, k in sorted(worst, reverse=True)[:20]:
        print(f"{kind} | {k} | {1e3 * seconds:.0f} | {why}")


if __name__ == "__main__":
    main()
