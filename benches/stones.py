"""Random stones from random starts: what is refused and why, how honest the claims are, and how long each takes.

    python benches/stones.py [--count 10000] [--seed 1] [--slowest 5]

Stones are thin, flat, nearly round, twisted, half cut off, or any; starts are at rest, upright, on an edge, fast, about to
lift off, upside down; tables are rough without limit, smooth, dry with a coefficient from 1e-6 to 10, or wet. Each motion is
followed for ten units of time twice: as accurately as doubles allow, and within 1e-10. Both are to agree within both claims,
energy and heat are to sum to a constant, and nothing may be no number.
"""

import argparse
import collections
import time

import numpy as np

import spincyl as sc

TIMES = np.linspace(0, 10, 6)


def tensor(rng, moments, turned):
    """A tensor with these principal moments, turned by a random rotation, or by one about axis 3."""
    angle = rng.uniform(-3, 3)
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]])
    if turned:
        turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    found = turn @ np.diag(moments) @ turn.T
    return (found + found.T) / 2


def stone(rng):
    kind = rng.integers(6)
    if kind == 0:
        axes = np.array([1.0, *10 ** rng.uniform(-3, -1, 2)])  # thin
    elif kind == 1:
        axes = np.array([1.0, rng.uniform(0.3, 1), 10 ** rng.uniform(-3, -1)])  # flat
    elif kind == 2:
        axes = 1 + 10 ** rng.uniform(-12, -1) * rng.uniform(-1, 1, 3)  # nearly round
    else:
        axes = rng.uniform(0.15, 1, 3)
    if kind == 3:
        twist = rng.uniform(-0.2, 0.2)
        return sc.Ellipsoid.rattleback([1.0, *rng.uniform(0.1, 0.5, 2)], twist=twist)
    squares = axes**2 / 5
    moments = np.array([squares[1] + squares[2], squares[0] + squares[2], squares[0] + squares[1]])
    if kind == 5:
        a, b = rng.uniform(0.05, 0.5, 2)
        moments = np.array([a, b, abs(a - b) + rng.uniform(0.01, 0.99) * (a + b - abs(a - b))])
    inertia = tensor(rng, moments, rng.integers(2)) if kind > 1 else np.diag(moments)
    offset = axes * rng.uniform(-0.4, 0.4, 3) * rng.integers(2)
    return sc.Ellipsoid(axes, inertia, offset, rng.choice([np.nan, np.nan, rng.uniform(0.3, 3.1)]))


def start(rng):
    n = rng.normal(size=3)
    kind = rng.integers(6)
    if kind == 0:
        n = np.array([0, 0, rng.choice([-1.0, 1.0])])  # exactly upright or upside down
    elif kind == 1:
        n = np.array([*10 ** rng.uniform(-12, -2, 2), 1.0])
    n /= np.linalg.norm(n)
    size = rng.choice([0.0, 1e-300, 1e-9, 0.3, 1.0, 3.0, 30.0], p=[0.1, 0.05, 0.05, 0.3, 0.3, 0.15, 0.05])
    w = size * rng.normal(size=3)
    if rng.integers(4) == 0:
        w = np.round(w, 1)
    if rng.integers(4) == 0:
        w = n * rng.normal() * 2
    return n, w


def table(rng):
    kind = rng.integers(5)
    if kind == 0:
        return "rolling", {}
    if kind == 1:
        return "smooth", {}
    if kind == 2:
        return "rolling", {"mu": 10 ** rng.uniform(-6, 1)}
    if kind == 3:
        mu = 10 ** rng.uniform(-6, 1)
        return sc.Coulomb(mu, static=mu * rng.choice([1.0, 1.0, 1.5])), {}
    return sc.Viscous(10 ** rng.uniform(-4, 1)), {}


def followed(body, state, contact, more, tol):
    try:
        return sc.roll(body, state, TIMES, contact=contact, tol=tol, **more), None
    except ValueError as e:
        return None, str(e).split("=")[0].split(":")[0].split(" ")[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--slowest", type=int, default=5)
    given = parser.parse_args()
    ends, refused, wrong, slow, shares = collections.Counter(), collections.Counter(), [], [], []
    unclaimed = 0
    for i in range(given.count):
        rng = np.random.default_rng([given.seed, i])
        body, (n, w) = stone(rng), start(rng)
        contact, more = table(rng)
        rubs = not isinstance(contact, str)
        slip = rng.normal(size=2) * rng.choice([0.0, 1e-9, 0.1, 1.0]) if rubs else None
        state = sc.EllipsoidState(n, w, slip)
        since = time.perf_counter()
        m, why = followed(body, state, contact, more, None)
        took = time.perf_counter() - since
        slow.append((took, i))
        rough, other = followed(body, state, contact, more, 1e-10)
        if m is None or rough is None:
            refused[why or other] += 1
            if (m is None) != (rough is None):
                refused["in one run only"] += 1
            continue
        ends[m.status.name] += 1
        if not (np.isfinite(m.vertical).all() and np.isfinite(m.w).all()):
            wrong.append((i, "not finite"))
            continue
        claim = m.error + rough.error
        if not np.isfinite(claim):
            unclaimed += 1
            continue
        both = min(len(m.t), len(rough.t))
        off = max(np.abs(m.y[:, :both] - rough.y[:, :both]).max(initial=0.0), 0.0)
        if m.status != rough.status:
            off = np.inf
        elif m.event is not None:
            off = max(off, abs(m.event.time - rough.event.time))
        shares.append(off / claim)
        if off > 2 * claim:
            wrong.append((i, f"{off / claim:.3g} times both claims of {claim:.1e}"))
        energy = m.energy + (m.dissipated if rubs else 0.0)
        size = 1 + (np.abs(m.w).max(initial=0.0)) ** 2
        loose = np.ptp(energy) if len(energy) else 0.0
        if loose > 1e-11 * size + 10 * m.error * size:
            wrong.append((i, f"energy and heat change by {loose:.1e}, {m.error:.1e} claimed"))
    print("ends:", dict(ends))
    print("refused:", dict(refused))
    print("without a claim, since the two runs part:", unclaimed)
    shares = np.array(shares)
    print(
        f"beyond both claims: {np.mean(shares > 1):.2%}, twice: {(shares > 2).sum()}, worst {shares.max(initial=0):.2f}"
    )
    print(f"median time {1e3 * np.median([t for t, _ in slow]):.2f} ms; slowest:")
    for took, i in sorted(slow, reverse=True)[: given.slowest]:
        print(f"  {took:.3f} s: default_rng([{given.seed}, {i}])")
    for i, why in wrong:
        print(f"WRONG default_rng([{given.seed}, {i}]): {why}")


if __name__ == "__main__":
    main()
