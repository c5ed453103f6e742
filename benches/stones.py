"""Random stones from random starts: those that are refused, the honesty of the claims, and the time of each
motion.

    python benches/stones.py [--count 10000] [--seed 1] [--slowest 5]
    python benches/stones.py --sweep 20000
    python benches/stones.py --grazes 5000

Stones are thin, flat, nearly round, twisted, half cut off, or any; starts are at rest, upright, on an edge,
fast, about to lift off, upside down; tables are rough without limit, smooth, dry with a coefficient from 1e-6
to 10, or viscous. Each motion is computed for ten units of time twice: as accurately as doubles allow, and
within 1e-10. Both must agree within the sum of their claims, energy and heat must sum to a constant, and
every number must be finite.

`--sweep` compares `sweep.roll` with `roll` at 4,001 times, from which reversals are counted independently; a
count that differs is close if the spin comes within both claims of the spin that counts as a reversal.
`--grazes` chooses mu, the edge or the speed so that the motion reaches an end, or misses it, by 1e-13 to 1e-2
of its margin, and computes it with several tolerances.
"""

import argparse
import collections
import time
import warnings

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


def name_of(contact, more):
    word = contact if isinstance(contact, str) else type(contact).__name__
    return f"{word} with mu" if more else word


def reversals(t, s):
    """The number of reversals of a spin that is given at many times, the zero before the first, and how near
    the spin comes to one more or one less."""
    side, count, first, zero, enough, near = np.sign(s[0]), 0, np.nan, np.nan, 0.1 * abs(s[0]), np.inf
    far = 0.0
    for i in range(1, len(s)):
        if s[i] * s[i - 1] < 0:
            zero = t[i - 1] + (t[i] - t[i - 1]) * s[i - 1] / (s[i - 1] - s[i])
        far = max(far, -s[i] * side)
        if s[i] * side < -enough:
            near = min(near, far - enough) if count else near
            side, count, far = -side, count + 1, 0.0
            first = zero if count == 1 else first
        elif s[i] * side > 0 and far > 0:
            near, far = min(near, enough - far), 0.0
    return count, first, near


def beside(given):
    """Compares `sweep.roll` with `roll`."""
    found = collections.defaultdict(collections.Counter)
    t = np.linspace(0, 10, 4001)
    for i in range(given.sweep):
        rng = np.random.default_rng([given.seed, i])
        body, (n, w) = stone(rng), start(rng)
        contact, more = table(rng)
        rubs = not isinstance(contact, str)
        slip = rng.normal(size=2) * rng.choice([0.0, 1e-9, 0.1, 1.0]) if rubs else None
        state, kind = sc.EllipsoidState(n, w, slip), name_of(contact, more)
        tell, where = found[kind], f"default_rng([{given.seed}, {i}])"
        tell["motions"] += 1
        many = sc.sweep.roll(
            body, state, t[-1], contact=contact, want=("final", "end", "reversals", "first_reversal"), **more
        )
        try:
            one = sc.roll(body, state, t, contact=contact, **more)
        except ValueError:
            tell["refused"] += 1
            if many["status"] not in (5, 6, 8):
                tell["refused by roll only"] += 1
                print(f"{kind}: {where} is refused by roll only")
            continue
        if many["status"] in (5, 6, 8) and many["status"] != one.status:
            tell["refused by the sweep only"] += 1
            print(f"{kind}: {where} is refused by the sweep only, {one.error:.1e} claimed")
            continue
        claim = one.error + float(many["error"])
        if not np.isfinite(claim):
            tell["without a claim"] += 1
        elif int(many["status"]) != one.status:
            tell["ends that differ"] += 1
            print(
                f"{kind}: {where} ends by {one.status.name}, in a sweep by {int(many['status'])}, {claim:.1e} claimed"
            )
        else:
            last = one.states if one.event is None else one.event.state
            mine = np.concatenate([np.atleast_2d(last.vertical)[-1], np.atleast_2d(last.w)[-1]])
            theirs = np.array([float(many[name]) for name in ("n1", "n2", "n3", "w1", "w2", "w3")])
            ended = t[-1] if one.event is None else one.event.time
            for word, off in (
                ("states", np.abs(mine - theirs).max()),
                ("times", abs(ended - float(many["end"]))),
            ):
                tell[f"{word} beyond both claims"] += off > claim
                tell[f"{word} beyond 2"] += off > 2 * claim
                tell[f"{word} beyond 10"] += off > 10 * claim
                if off > 2 * claim:
                    print(f"{kind}: {word} of {where} {off / claim:.3g} times both claims of {claim:.1e}")
        known = min(one.known_until, float(many["known_until"]))
        spin = abs(float(one.spin[0])) if len(one.t) else 0.0
        if len(one.t) < 2 or spin <= 1e-12 * max(1.0, np.abs(w).max()):
            continue
        if known < min(t[-1], float(many["end"])):
            tell["reversals known up to a time"] += 1
        if known < float(many["known_until"]):
            continue
        upto = one.t <= known
        count, first, near = reversals(one.t[upto], one.spin[upto])
        if count != int(many["reversals"]):  # a fast stone passes from side to side between these times
            one = sc.roll(body, state, np.linspace(0, known, 100_001), contact=contact, **more)
            count, first, near = reversals(one.t, one.spin)
        tell["motions that turn back"] += count > 0
        if count != int(many["reversals"]):
            least = 2 * min(claim, 0.05 * abs(one.spin[0])) + 1e-6 * abs(one.spin[0])
            word = (
                "counts that differ, close"
                if near < least or not np.isfinite(claim)
                else "counts that differ"
            )
            tell[word] += 1
            if word == "counts that differ":
                print(
                    f"{kind}: {where} turns back {count} times, in a sweep {int(many['reversals'])}, {claim:.1e} claimed"
                )
        elif count:
            tell["first reversals 1e-3 apart"] += abs(first - float(many["first_reversal"])) > 1e-3
    for kind, tell in sorted(found.items()):
        print(f"{kind}: " + ", ".join(f"{number} {word}" for word, number in tell.items()))


def extremum(follow, what, most):
    """The last local maximum (or minimum) of a number within a motion that exceeds all values before it, and
    its time; None if there is none inside."""
    t = np.linspace(0, 6, 241)
    m = follow(t)
    values = (1 if most else -1) * what(m)
    inner = np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:])) + 1
    inner = [i for i in inner if np.isfinite(values[i]) and values[i] == values[: i + 1].max()]
    if not inner:
        return None
    i = inner[-1]
    low, high = m.t[i - 1], m.t[i + 1]
    for _ in range(5):
        t = np.linspace(low, high, 33)
        m = follow(t)
        values = (1 if most else -1) * what(m)
        i = int(np.argmax(values))
        if len(values) < 33 or not 0 < i < 32:
            return None
        low, high = t[i - 1], t[i + 1]
    return float((1 if most else -1) * values[i]), float(t[i])


def grazing(rng):
    """A stone, a start, contact and options with which an end is just reached or just missed; the kind of
    end, the side, the distance as a share of the margin, and the time."""
    body, (n, w) = stone(rng), start(rng)
    body = sc.Ellipsoid(body.axes, body.inertia, body.offset)
    w = np.clip(w, -3, 3)
    end = rng.choice(["mu", "edge", "lift-off"])
    contact = rng.choice(
        ["rolling", "smooth", "coulomb", "viscous"] if end != "mu" else ["rolling", "coulomb"]
    )
    by, side = 10 ** rng.uniform(-13, -2), rng.choice([-1, 1])
    if contact == "coulomb":
        contact = sc.Coulomb(10 ** rng.uniform(-2, 0))
    elif contact == "viscous":
        contact = sc.Viscous(10 ** rng.uniform(-2, 1))
    rubs = not isinstance(contact, str)
    slip = rng.normal(size=2) if rubs and end != "mu" else None
    told, options = contact, {}
    if end == "mu":
        contact = "rolling"

    def follow(scale=1.0, beyond=not rubs):
        state = sc.EllipsoidState(n, scale * w, slip)
        more = {} if rubs and end != "mu" else {"beyond": beyond}
        return lambda t: sc.roll(body, state, t, t0=0.0, contact=contact, want="force", **more)

    if end == "lift-off":

        def least(scale):
            found = extremum(follow(scale), lambda m: m.normal, False)
            return None if found is None else found[0]

        low, high = 0.3, 3.0
        a, b = least(low), least(high)
        if a is None or b is None or not (a > 0 > b):
            return None
        for _ in range(60):
            middle = 0.5 * (low + high)
            here = least(middle)
            if here is None:
                return None
            low, high = (middle, high) if here > 0 else (low, middle)
        w = w * (low * (1 + side * by))
        when = extremum(follow(), lambda m: m.normal, False)
        when = None if when is None else when[1]
    elif end == "edge":
        found = extremum(follow(), lambda m: m.theta, True)
        if found is None or not 0.05 < found[0] * (1 - by) < 3.1:
            return None
        body, when = sc.Ellipsoid(body.axes, body.inertia, body.offset, found[0] * (1 - side * by)), found[1]
    else:
        found = extremum(follow(), lambda m: np.where(m.normal > 0, m.friction_coefficient, np.nan), True)
        if found is None or not 1e-6 < found[0] < 50:
            return None
        mu, when = found[0] * (1 - side * by), found[1]
        told, options = ("rolling", {"mu": mu}) if isinstance(told, str) else (sc.Coulomb(mu), {})
    return body, sc.EllipsoidState(n, w, slip), told, options, end, side, by, when


def grazes(given):
    found, i, made = collections.defaultdict(collections.Counter), 0, 0
    while made < given.grazes:
        rng = np.random.default_rng([given.seed, 77, i])
        i += 1
        try:
            drawn = grazing(rng)
        except (ValueError, IndexError):
            continue
        if drawn is None:
            continue
        body, state, contact, options, end, side, by, when = drawn
        made += 1
        tell = found[f"{name_of(contact, options)}, {end}"]
        tell["motions"] += 1
        where = f"default_rng([{given.seed}, 77, {i - 1}]) {'beyond' if side > 0 else 'short'} by {by:.0e}"
        runs = []
        for tol in (None, 1e-13, 1e-12, 1e-11, 1e-10, 1e-8, 1e-6):
            try:
                m = sc.roll(body, state, 6.0, contact=contact, tol=tol, **options)
            except ValueError:
                tell["refused"] += 1
                continue
            last = m.states if m.event is None else m.event.state
            numbers = np.concatenate([np.atleast_2d(last.vertical)[-1], np.atleast_2d(last.w)[-1]])
            ended = 6.0 if m.event is None else m.event.time
            runs.append((tol, m.status, ended, numbers, m.error))
            if tol in (1e-12, 1e-8):
                many = sc.sweep.roll(body, state, 6.0, contact=contact, tol=tol, want="end", **options)
                same = int(many["status"]) == m.status and float(many["end"]) == ended
                tell["sweeps unlike roll"] += not (same and float(many["error"]) == m.error)
        if not runs:
            continue
        tell["ends there"] += runs[0][1] != 0 and abs(runs[0][2] - (when or np.inf)) < 0.1
        for a, b in ((runs[0], other) for other in runs[1:]):
            claim = a[4] + b[4]
            tell["pairs"] += 1
            if not np.isfinite(claim):
                tell["pairs without a claim"] += 1
                continue
            off = np.inf if a[1] != b[1] else max(abs(a[2] - b[2]), np.abs(a[3] - b[3]).max())
            tell["beyond both claims"] += off > claim
            tell["beyond 2"] += off > 2 * claim
            tell["beyond 10"] += off > 10 * claim
            if off > 10 * claim:
                ends = f"{a[1].name} at {a[2]:.9g}, with tol {b[0]:g} {b[1].name} at {b[2]:.9g}"
                print(
                    f"{name_of(contact, options)}, {end}: {where}: {ends}, claims {a[4]:.1e} and {b[4]:.1e}"
                )
    for kind, tell in sorted(found.items()):
        print(f"{kind}: " + ", ".join(f"{number} {word}" for word, number in tell.items()))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--slowest", type=int, default=5)
    parser.add_argument("--sweep", type=int, default=0, help="this many motions, sweep.roll beside roll")
    parser.add_argument("--grazes", type=int, default=0, help="this many motions that touch an end")
    given = parser.parse_args()
    # many of these motions, and some moments of inertia, rightly cause warnings
    warnings.simplefilter("ignore", UserWarning)
    warnings.simplefilter("ignore", RuntimeWarning)
    if given.sweep or given.grazes:
        beside(given)
        grazes(given)
        return
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
