"""Random stones from random starts: those that are refused, the honesty of the claims, and the time of each
motion.

    --sweep 20000     compares `sweep.roll` with `roll` instead
    --grazes 5000     starts that only just meet an end or just miss it, instead

Stones are thin, flat, nearly round, twisted, half cut off, or any; starts are at rest, upright, on an edge,
fast, about to lift off, upside down; tables are rough without limit, smooth, dry with a coefficient from 1e-6
to 10, or viscous. Each motion is computed for ten units of time twice: as accurately as doubles allow, and
within 1e-10. Both must agree within the sum of their claims, energy and heat must sum to a constant, and
every number must be finite. A ratio is the difference of two results over both claims.

`--sweep` compares at 4,001 times, from which reversals are counted independently; a count that differs is
close if the spin comes within both claims of the spin that counts as a reversal. `--grazes` chooses mu, the
edge or the speed so that the motion reaches an end, or misses it, by 1e-13 to 1e-2 of its margin, and computes
it with several tolerances.
"""

import time

import numpy as np
from judge import blocks

import spincyl as sc

DEFAULTS, FEW, HONEST = {"count": 10_000, "seed": 1}, "--count 1000", 2.0
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


def drawn(rng):
    """A stone, a start, a contact and options."""
    body, (n, w) = stone(rng), start(rng)
    contact, more = table(rng)
    rubs = not isinstance(contact, str)
    slip = rng.normal(size=2) * rng.choice([0.0, 1e-9, 0.1, 1.0]) if rubs else None
    return body, sc.EllipsoidState(n, w, slip), contact, more


def last_of(m):
    """n and w of the last state of a motion."""
    last = m.states if m.event is None else m.event.state
    return np.concatenate([np.atleast_2d(last.vertical)[-1], np.atleast_2d(last.w)[-1]])


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


def beside(seed, i, tally):
    """Compares `sweep.roll` with `roll`."""
    body, state, contact, more = drawn(np.random.default_rng([seed, i]))
    t, row, where = np.linspace(0, 10, 4001), name_of(contact, more), f"default_rng([{seed}, {i}])"
    tally.count(row, "motions")
    want = ("final", "end", "reversals", "first_reversal")
    many = sc.sweep.roll(body, state, t[-1], contact=contact, want=want, **more)
    status = int(many["status"])
    try:
        one = sc.roll(body, state, t, contact=contact, **more)
    except ValueError:
        tally.count(row, "refused")
        if status not in (5, 6, 8):
            tally.count(row, "refused by roll only", where)
        return
    if status in (5, 6, 8) and status != one.status:
        tally.count(row, "refused by the sweep only", f"{where}, {one.error:.1e} claimed")
        return
    claim = one.error + float(many["error"])
    if not np.isfinite(claim):
        tally.count(row, "without a claim")
    elif status != one.status:
        ends = f"{one.status.name}, in a sweep by {status}, {claim:.1e} claimed"
        tally.count(row, "ends that differ", f"{where} ends by {ends}")
    else:
        theirs = np.array([float(many[name]) for name in ("n1", "n2", "n3", "w1", "w2", "w3")])
        ended = t[-1] if one.event is None else one.event.time
        tally.add(f"{row}: states", np.abs(last_of(one) - theirs).max(), claim, where)
        tally.add(f"{row}: times", abs(ended - float(many["end"])), claim, where)
    known = min(one.known_until, float(many["known_until"]))
    spin, fastest = abs(float(one.spin[0])) if len(one.t) else 0.0, np.abs(state.w).max()
    if len(one.t) < 2 or spin <= 1e-12 * max(1.0, fastest):
        return
    if known < min(t[-1], float(many["end"])):
        tally.count(row, "reversals known up to a time")
    if known < float(many["known_until"]):
        return
    upto = one.t <= known
    count, first, near = reversals(one.t[upto], one.spin[upto])
    theirs = int(many["reversals"])
    if count != theirs:  # a fast stone passes from side to side between these times
        one = sc.roll(body, state, np.linspace(0, known, 100_001), contact=contact, **more)
        count, first, near = reversals(one.t, one.spin)
    tally.count(row, "motions that turn back", n=count > 0)
    if count != theirs:
        least = 2 * min(claim, 0.05 * abs(one.spin[0])) + 1e-6 * abs(one.spin[0])
        close = near < least or not np.isfinite(claim)
        text = f"{where} turns back {count} times, in a sweep {theirs}, {claim:.1e} claimed"
        tally.count(row, f"counts that differ{', close' if close else ''}", None if close else text)
    elif count:
        far = abs(first - float(many["first_reversal"])) > 1e-3
        tally.count(row, "first reversals 1e-3 apart", n=far)


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
    body = sc.Ellipsoid(body.semi_axes, body.inertia, body.offset)
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
        body, when = (
            sc.Ellipsoid(body.semi_axes, body.inertia, body.offset, found[0] * (1 - side * by)),
            found[1],
        )
    else:
        found = extremum(follow(), lambda m: np.where(m.normal > 0, m.friction_coefficient, np.nan), True)
        if found is None or not 1e-6 < found[0] < 50:
            return None
        mu, when = found[0] * (1 - side * by), found[1]
        told, options = ("rolling", {"mu": mu}) if isinstance(told, str) else (sc.Coulomb(mu), {})
    return body, sc.EllipsoidState(n, w, slip), told, options, end, side, by, when


def grazed(seed, i, tally):
    """Compares one motion that grazes an end with itself at other tolerances; whether there is one."""
    try:
        drawn = grazing(np.random.default_rng([seed, 77, i]))
    except (ValueError, IndexError):
        return False
    if drawn is None:
        return False
    body, state, contact, options, end, side, by, when = drawn
    row = f"{name_of(contact, options)}, {end}"
    where = f"default_rng([{seed}, 77, {i}]) {'beyond' if side > 0 else 'short'} by {by:.0e}"
    tally.count(row, "motions")
    runs = []
    for tol in (None, 1e-13, 1e-12, 1e-11, 1e-10, 1e-8, 1e-6):
        try:
            m = sc.roll(body, state, 6.0, contact=contact, tol=tol, **options)
        except ValueError:
            tally.count(row, "refused")
            continue
        ended = 6.0 if m.event is None else m.event.time
        runs.append((tol, m.status, ended, last_of(m), m.error))
        if tol in (1e-12, 1e-8):
            many = sc.sweep.roll(body, state, 6.0, contact=contact, tol=tol, want="end", **options)
            same = int(many["status"]) == m.status and float(many["end"]) == ended
            tally.count(row, "sweeps unlike roll", n=not (same and float(many["error"]) == m.error))
    if runs:
        tally.count(row, "ends there", n=runs[0][1] != 0 and abs(runs[0][2] - (when or np.inf)) < 0.1)
    for a, b in ((runs[0], other) for other in runs[1:]):
        claim = a[4] + b[4]
        tally.count(row, "pairs")
        if not np.isfinite(claim):
            tally.count(row, "pairs without a claim")
            continue
        off = np.inf if a[1] != b[1] else max(abs(a[2] - b[2]), np.abs(a[3] - b[3]).max())
        ends = f"{a[1].name} at {a[2]:.9g}, with tol {b[0]:g} {b[1].name} at {b[2]:.9g}"
        tally.add(row, off, claim, f"{where}: {ends}")
    return True


def twice(seed, i, tally):
    """Compares a motion with itself within 1e-10."""
    body, state, contact, more = drawn(np.random.default_rng([seed, i]))
    where, since = f"default_rng([{seed}, {i}])", time.perf_counter()
    m, why = followed(body, state, contact, more, None)
    tally.took(time.perf_counter() - since, where)
    rough, other = followed(body, state, contact, more, 1e-10)
    if m is None or rough is None:
        tally.count("refused", why or other)
        tally.count("refused", "in one run only", n=(m is None) != (rough is None))
        return
    tally.count("ends", m.status.name)
    if not (np.isfinite(m.vertical).all() and np.isfinite(m.w).all()):
        tally.count("wrong", "not finite", where)
        return
    claim = m.error + rough.error
    if not np.isfinite(claim):
        tally.count("motions", "without a claim, since the two runs part")
        return
    both = min(len(m.t), len(rough.t))
    off = np.abs(m.y[:, :both] - rough.y[:, :both]).max(initial=0.0)
    if m.status != rough.status:
        off = np.inf
    elif m.event is not None:
        off = max(off, abs(m.event.time - rough.event.time))
    tally.add("of both claims", off, claim, where)
    energy = m.energy + (0.0 if isinstance(contact, str) else m.dissipated)
    size = 1 + (np.abs(m.w).max(initial=0.0)) ** 2
    loose = np.ptp(energy) if len(energy) else 0.0
    if loose > 1e-11 * size + 10 * m.error * size:
        tally.count("wrong", "energy and heat change", f"{where}: by {loose:.1e}, {m.error:.1e} claimed")


def options(add):
    add("--sweep", type=int, default=0, help="this many motions, sweep.roll beside roll")
    add("--grazes", type=int, default=0, help="this many motions that touch an end")


def judge(given, tally):
    if not (given.sweep or given.grazes):
        for i, _ in blocks(given):
            twice(given.seed, i, tally)
    for i in range(given.sweep):
        beside(given.seed, i, tally)
    i = made = 0
    while made < given.grazes:
        made += grazed(given.seed, i, tally)
        i += 1
