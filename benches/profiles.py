"""Random bodies of 2 to 5 circles from random starts: what is followed, its energy, and what takes long.

    python benches/profiles.py                    1,000 motions, a minute
    python benches/profiles.py --count 10000      the figures of docs/hard-cases.md, ten minutes
    python benches/profiles.py --only 17          one of them, with its phases

Cups, cones, bottles, dumb-bells, caps, wheels with axles, rounded cups and lathed bodies with five circles;
Coulomb friction from 0.05 to 1, restitution 0, 0.3 or 0.9, to t = 50. One start in five is at rest. A motion is followed if
it reaches the last time, rests, or ends on a face. Prints the others by their endings, the motions whose energy
differs from that at the start by more than 1e-12 and four times the estimated error, and the slowest in seconds
of the processor.
"""

import argparse
import time
import warnings
from collections import Counter

import numpy as np

import spincyl as sc

BOUNCES = (0.0, 0.3, 0.9)
TIMES = np.array([0.0, 25.0, 50.0])
FOLLOWED = (sc.Ending.DONE, sc.Ending.FACE, sc.Ending.STOPS)


def cup(u):
    return sc.Body.frustum(u(0.3, 0.98), 1.0, u(0.3, 2.5))


def cone(u):
    return sc.Body.cone(u(0.4, 2.5))


def bottle(u):
    height = u(0.8, 2.5)
    return sc.Body.lathe([(1.0, 0.0), (1.0, height), (u(0.15, 0.8), height + u(0.3, 1.5))])


def dumb_bell(u):
    return sc.Body.balls(radii=(1.0, u(0.4, 1.0)))


def cap(u):
    solid = sc.assembled([sc.parts.cap(diameter=2.0, height=u(0.2, 1.0), mass=1.0)])
    return sc.Body.profile(solid.circles, solid.i1, solid.i3)


def wheel(u):
    low, rim, high = u(0.3, 1.2), 0.2, u(0.3, 1.2)
    ends = [(u(0.1, 0.6), 0.0), (u(0.1, 0.6), low + rim + high)]
    outline = [
        ends[0],
        (ends[0][0], low),
        (1.0, low + 1e-9),
        (1.0, low + rim),
        (ends[1][0], low + rim + 1e-9),
        ends[1],
    ]
    return sc.Body.lathe(outline)


def rounded(u):
    radius, height, fillet = u(0.4, 0.95), u(0.5, 2.0), u(0.02, 0.2)
    solid = sc.Body.frustum(radius, 1.0, height)
    circles = [(radius - fillet, fillet, fillet), (1.0 - fillet, height - fillet, fillet)]
    return sc.Body.profile(circles, solid.i1, solid.i3, centre=-solid.circles[0][1])


def five(u):
    radii = [u(0.2, 0.6), u(0.7, 0.9), 1.0, u(0.7, 0.9), u(0.2, 0.6)]
    heights = np.cumsum([0.0, u(0.1, 0.3), u(0.3, 0.8), u(0.3, 0.8), u(0.1, 0.3)])
    return sc.Body.lathe(list(zip(radii, heights, strict=True)))


KINDS = (cup, cone, bottle, dumb_bell, cap, wheel, rounded, five)


def drawn(rng):
    """A kind, a body of it, a state and the options of a motion."""

    def u(low, high):
        return float(rng.uniform(low, high))

    kind = KINDS[rng.integers(len(KINDS))]
    w = np.zeros(3) if rng.random() < 0.2 else rng.uniform(-1.5, 1.5, 3) * [1, 1, 2]
    slip = rng.uniform(-1, 1, 2) if rng.random() < 0.4 else np.zeros(2)
    state = sc.State(u(0.1, 3.0), *map(float, w), slip=tuple(map(float, slip)))
    how = {"contact": sc.Coulomb(u(0.05, 1.0)), "restitution": BOUNCES[rng.integers(3)]}
    return kind, kind(u), state, how


def energies(motion):
    """Energy at each time, with all that was taken from it."""
    struck = [sum(hit.lost for hit in motion.impacts if hit.time <= t) for t in motion.t]
    return motion.energy + motion.dissipated + struck


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", type=int)
    asked = parser.parse_args()
    found, slow, off = Counter(), [], 0
    for k in range(asked.count) if asked.only is None else [asked.only]:
        kind, body, state, how = drawn(np.random.default_rng([asked.seed, k]))
        began = time.process_time()
        try:
            with warnings.catch_warnings(action="ignore"):
                motion = sc.roll(body, state, TIMES, **how)
        except ValueError as error:
            found[f"refused: {error}".split(" (")[0][:60]] += 1
            print(k, kind.__name__, str(error)[:100])
            continue
        slow.append((time.process_time() - began, k, kind.__name__, len(motion.phases)))
        if motion.status in FOLLOWED:
            found["followed"] += 1
        else:
            why = motion.message.split(": ")[0]
            found[f"{kind.__name__}: {why}"] += 1
            print(k, kind.__name__, why)
        all_of_it = energies(motion)
        allowed = 1e-12 + 4 * motion.error * np.maximum(1, np.abs(motion.w).max(axis=1))
        if np.any(np.abs(all_of_it - all_of_it[0]) > allowed):
            off += 1
            print(k, kind.__name__, "energy", all_of_it - all_of_it[0], motion.error)
        if asked.only is not None:
            print(motion, *motion.phases, sep="\n")
    for what, count in found.most_common():
        print(f"{count:6d}  {what}")
    print(f"{off} with another energy; slowest:")
    for seconds, k, name, phases in sorted(slow, reverse=True)[:8]:
        print(f"  {seconds:.3f} s  {name} {k}, {phases} phases")


if __name__ == "__main__":
    main()
