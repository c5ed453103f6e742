"""Random stones that are dropped, to t = 20: what is followed, its energy, and what takes long.

    python benches/stone_hops.py                  500 drops, each with the restitutions 0, 0.3 and 0.9
    python benches/stone_hops.py --count 3334     10,000 motions, the figures of docs/hard-cases.md
    python benches/stone_hops.py --patch          the same on patches of contact of radius 1e-4 to 0.05
    python benches/stone_hops.py --only 17 0.3    one of them, with its phases
    python benches/stone_hops.py --errors         true over estimated errors of the same drops within tolerances
    python benches/stone_hops.py --speed          the time of an impact, of a bounce, and of a map beside one without hops

Pebbles, eggs, rattlebacks and stones of any inertia, dropped from up to four of their semi-axes or thrown, turning or
not, with Coulomb friction from 0.05 to 1. A motion is followed that reaches the last time, rest, or the edge of a half
ellipsoid. Prints those whose energy, with all that has been taken, differs from that at the start by more than 1e-12 and
ten times the estimated error, those above half a second, and all that are not followed, by their reason.
"""

import argparse
import time
import warnings
from collections import Counter

import numpy as np

import spincyl as sc

UNTIL = 20.0
TIMES = np.linspace(0.0, UNTIL, 9)


def stone_of(u, rng):
    kind = rng.integers(4)
    if kind == 0:
        return "pebble", sc.Ellipsoid.uniform(rng.uniform(0.25, 1.0, 3))
    if kind == 1:
        return "egg", sc.Ellipsoid.egg(u(0.5, 0.95), 1.0, offset=u(-0.1, 0.1))
    if kind == 2:
        return "rattleback", sc.Ellipsoid.rattleback((1.0, u(0.15, 0.5), u(0.15, 0.4)), twist=u(-0.1, 0.1))
    a, b = rng.uniform(0.1, 0.4, 2)
    c = abs(a - b) + u(0.1, 0.9) * (a + b - abs(a - b))
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    axes = rng.uniform(0.25, 1.0, 3)
    tensor = turn @ np.diag([a, b, c]) @ turn.T
    return "any", sc.Ellipsoid(axes, (tensor + tensor.T) / 2, offset=rng.uniform(-0.2, 0.2, 3) * axes)


def drawn(number, patch=False, seed=0):
    """The kind, the stone, the state and the contact of a motion."""
    rng = np.random.default_rng([seed, number])

    def u(low, high):
        return float(rng.uniform(low, high))

    kind, stone = stone_of(u, rng)
    up = rng.normal(size=3)
    w = rng.normal(size=3) * rng.choice([0.0, 0.3, 1.0, 4.0])
    slip = rng.uniform(-1.0, 1.0, 2) * rng.choice([0.0, 1.0])
    height, lift = u(0.0, 4.0) * rng.choice([0.0, 0.1, 1.0]), u(-1.0, 1.0) * rng.choice([0.0, 1.0])
    state = sc.EllipsoidState(up / np.linalg.norm(up), w, slip=slip, height=height, lift=lift)
    contact = sc.Coulomb(u(0.05, 1.0), patch=10 ** u(-4.0, -1.3) if patch else 0.0)
    return kind, stone, state, contact


def followed(stone, state, contact, restitution):
    """The motion or the reason of a refusal, its time, and by how much its energy is off beyond its claim."""
    since = time.process_time()
    try:
        m = sc.roll(stone, state, TIMES, contact=contact, restitution=restitution)
    except ValueError as e:
        return str(e).split(":")[0], time.process_time() - since, 0.0
    lasts = time.process_time() - since
    if m.t.size == 0:
        return m, lasts, 0.0
    whole = m.energy + m.dissipated + m.lost_in_impacts
    fastest = max(1.0, float(np.abs(m.w).max()))
    claim = 1e-12 * fastest**2 + 10 * fastest * m.error
    return m, lasts, float(np.abs(whole - whole[0]).max()) - claim


def is_followed(m):
    return (
        not isinstance(m, str)
        and m._limit is None
        and m.status in (sc.Ending.DONE, sc.Ending.STOPS, sc.Ending.FACE)
    )


def follows_all(count, patch):
    for restitution in (0.0, 0.3, 0.9):
        ends, total, good, off, slow, costs = Counter(), 0, 0, 0, 0, []
        for number in range(count):
            kind, stone, state, contact = drawn(number, patch)
            m, lasts, beyond = followed(stone, state, contact, restitution)
            total += 1
            costs.append(lasts)
            if isinstance(m, str):
                ends[f"refused: {m}"] += 1
                print(f"{number} {restitution}, {kind}: {m}", flush=True)
                continue
            ends[m.status.name if m._limit is None else f"{m.status.name}, {m._limit[0]}"] += 1
            good += is_followed(m)
            if not is_followed(m):
                print(f"{number} {restitution}, {kind}: {m.status.name}, {m._limit}", flush=True)
            if not beyond <= 0.0:
                off += 1
                print(f"{number} {restitution}, {kind}: energy off by {beyond:.1g}", flush=True)
            if lasts > 0.5:
                slow += 1
                print(f"{number} {restitution}, {kind}: {lasts:.2f} s, {m.status.name}", flush=True)
        share, median = 100 * good / total, 1e3 * np.median(costs)
        print(f"e = {restitution}: {share:.2f} % of {total} followed, {off} off, {slow} above 0.5 s;")
        print(
            f"    median {median:.1f} ms, longest {max(costs):.1f} s, all {sum(costs):.0f} s; {dict(ends)}",
            flush=True,
        )


def tells_errors(count, patch):
    """Print how the true errors of drops within tolerances compare with their estimates."""
    ratios, many = [], 0
    for number in range(count):
        _, stone, state, contact = drawn(number, patch)
        rng = np.random.default_rng([1, number])
        tol, restitution = 10 ** rng.uniform(-11, -6), rng.choice([0.0, 0.3, 0.9])
        how = {"contact": contact, "restitution": restitution}
        try:
            best, rough = (sc.roll(stone, state, TIMES, tol=x, **how) for x in (1e-14, tol))
        except ValueError:
            continue
        last = min(best.t.size, rough.t.size)
        y, z = best.y[:, :last], rough.y[:, :last]
        off = float((np.abs(y - z) / np.maximum(1.0, np.abs(y))).max(initial=0.0))
        many += 1
        if np.isfinite(best.error) and off > 3 * best.error:
            ratios.append(off / rough.error)
    ratios = np.array(ratios)
    print(f"{many} drops, {ratios.size} depend on the tolerance by more than the error of the comparison;")
    print(
        f"    true over estimated error: median {np.median(ratios):.2g}, at most {ratios.max():.2g},", end=" "
    )
    print(f"above 1 in {(ratios > 1).sum()}, above 2 in {(ratios > 2).sum()}")


def fastest(repeats, call, *of, **how):
    """The least time of the processor that a call takes, in us."""
    times = []
    for _ in range(repeats):
        since = time.process_time()
        call(*of, **how)
        times.append(time.process_time() - since)
    return 1e6 * min(times)


def tells_speed():
    """Prints what an impact, a bounce and a sweep of stones cost."""
    skew = sc.Ellipsoid(
        (1, 0.8, 0.6),
        [[0.2, 0.01, 0.02], [0.01, 0.3, -0.015], [0.02, -0.015, 0.35]],
        offset=(0.03, -0.02, -0.1),
    )
    for name, contact in (
        ("a point that slips", sc.Coulomb(0.2)),
        ("a point that sticks", sc.Coulomb(0.6)),
        ("a film", sc.Viscous(0.3)),
        ("a patch of 0.01", sc.Coulomb(0.2, patch=0.01)),
        ("a patch of 1e-4", sc.Coulomb(0.2, patch=1e-4)),
    ):
        costs, hits = [], []
        for until in (0.5, 12.0):
            state = sc.EllipsoidState((0.36, 0.48, 0.8), (0.5, 0.3, 2.0), slip=(0.5, -0.3), height=1.0)
            how = {"contact": contact, "restitution": 0.95}
            costs.append(fastest(15, sc.roll, skew, state, until, **how))
            hits.append(len(sc.roll(skew, state, until, **how).impacts))
        each = (costs[1] - costs[0]) / max(hits[1] - hits[0], 1)
        print(f"{name}: {each:.0f} us for an impact and its flight, both runs, {hits[1]} impacts")
    pitch, roll = np.meshgrid(np.linspace(-0.4, 0.4, 41), np.linspace(-0.4, 0.4, 41), indexing="ij")
    stone = sc.Ellipsoid.rattleback((1.0, 0.3, 0.2), twist=0.05)
    state = stone.spinning(-0.6, pitch=pitch, roll=roll)
    for name, how in (("stays on the table", {}), ("may hop", {"restitution": 0.3})):
        since = time.process_time()
        sc.sweep.roll(stone, state, t=10.0, contact=sc.Coulomb(0.4), **how)
        print(f"a map of 41 x 41 rattlebacks that {name}: {time.process_time() - since:.2f} s")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--patch", action="store_true")
    parser.add_argument("--only", nargs=2)
    parser.add_argument("--errors", action="store_true")
    parser.add_argument("--speed", action="store_true")
    asked = parser.parse_args()
    warnings.simplefilter("ignore")
    if asked.speed:
        tells_speed()
    elif asked.errors:
        tells_errors(asked.count, asked.patch)
    elif asked.only:
        number, restitution = int(asked.only[0]), float(asked.only[1])
        kind, stone, state, contact = drawn(number, asked.patch)
        m, lasts, beyond = followed(stone, state, contact, restitution)
        print(kind, stone, state, contact, f"{lasts:.3f} s, off {beyond:.2g}", m, sep="\n")
        if not isinstance(m, str):
            print(f"error {m.error:.1e}, {len(m.impacts)} impacts, {m.nfev} evaluations")
            for phase in m.phases[-12:]:
                print("   ", phase)
    else:
        follows_all(asked.count, asked.patch)


if __name__ == "__main__":
    main()
