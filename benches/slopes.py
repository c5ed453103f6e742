"""Random bodies on random slopes to t = 50: what is followed, its energy, and what takes long.

    python benches/slopes.py                   500 starts, each with three restitutions
    python benches/slopes.py --count 3334      10,000 motions, the figures of docs/hard-cases.md
    python benches/slopes.py --only 17 0.5     one of them, with its phases
    python benches/slopes.py --odd 7           500 odd starts near a face, by this seed, to t = 10
    python benches/slopes.py --speed           a slope beside a level table, and sweeps beside motions one by one

Cylinders, tubes, coins, rounded bodies, balls and tippe tops on a rim, slipping or not, at rest, on their side, on their
face, or let fall, on slopes of 0 to 60 degrees in all directions; Coulomb friction from 0.05 to 1, half of them with rolling resistance
and air. Without a restitution every motion that the model ends is followed; with 0 and 0.5 those that reach the last
time or rest. The odd starts are on a face, beside it or a little above: velocities of 0, 1e-300 and so on, slopes and
heights at which friction and weight just hold a body, all laws of contact; they tell of motions that crawl or are not a
number. Prints those whose energy, with all that has been taken, differs from that at the start by more than 1e-12
and ten times the estimated error, and all that are not followed, by their reason.
"""

import argparse
import time
import warnings
from collections import Counter
from functools import partial

import numpy as np

import spincyl as sc

UNTIL = 50.0
TIMES = np.linspace(0.0, UNTIL, 9)
ENDS = (sc.Ending.SIDE, sc.Ending.FACE, sc.Ending.LIFT_OFF, sc.Ending.DONE, sc.Ending.STOPS)


def body_of(u, rng):
    kind = rng.integers(6)
    if kind == 0:
        return "coin", sc.Body.solid(u(0.02, 0.3))
    if kind == 1:
        return "cylinder", sc.Body.solid(u(0.3, 3.0))
    if kind == 2:
        return "tube", sc.Body.tube(u(0.1, 6.0), bore=u(0.0, 1.0))
    if kind == 3:
        radius = u(0.05, 0.3)
        return "rounded", sc.Body.solid(u(radius, 2.0), fillet=radius)
    moment = u(0.3, 0.5)
    if kind == 4:
        return "ball", sc.Body.ball(0.0, moment, moment)
    return "top", sc.Body.ball(u(-0.4, 0.4), moment * u(0.8, 1.2), moment)


def drawn(number, seed=0):
    """The kind, the body, the state, the table and the laws of a motion."""
    rng = np.random.default_rng([seed, number])

    def u(low, high):
        return float(rng.uniform(low, high))

    kind, body = body_of(u, rng)
    w = rng.uniform(-1.5, 1.5, 3) * [1, 1, 2]
    table = sc.Table(u(0.0, np.radians(60)), phi0=u(-np.pi, np.pi))
    how = {"contact": sc.Coulomb(u(0.05, 1.0)), "table": table}
    if rng.random() < 0.5:
        how["losses"] = sc.loss.RollingResistance(u(0.0, 0.05)) + sc.loss.AirLinear(u(0.0, 0.02))
    start, slip = rng.integers(6), tuple(rng.uniform(-1, 1, 2))
    if start == 0:
        state = sc.dropped(body, u(0.0, 2.0), u(0.05, 3.0), w1=w[0], w2=w[1], w3=w[2])
    elif start == 1 and kind in ("coin", "cylinder", "tube", "rounded"):
        state = sc.State(np.pi / 2, float(w[0]), 0.0, float(w[2]), slip=slip)
    elif start == 5 and kind not in ("ball", "top"):
        state = sc.spun(body, float(w[2]) * rng.integers(2), slip if rng.random() < 0.7 else (0.0, 0.0))
    elif start == 2:
        state = sc.State(u(0.05, 1.5), 0.0, 0.0, 0.0)
    else:
        state = sc.State(u(0.05, 1.5), *map(float, w), slip=slip if start == 3 else (0.0, 0.0))
    return kind, body, state, how


ODD_TIMES = np.linspace(0.0, 10.0, 6)
ODD_SPEEDS = [0, 1e-300, 1e-160, 1e-30, 1e-16, 1e-13, 1e-8, 0.1, 0.5, 1, -1e-300, -1e-12, -0.3]
ODD_SLOPES = [1e-300, 1e-16, 1e-8, 0.1, 0.3, 0.7, 1.2, -0.4, 1.57]
ODD_SLOPES += [np.arctan(0.3), np.nextafter(np.arctan(0.3), 1), np.arctan(0.5)]
ODD_BODIES = {
    "coin": sc.Body.solid(0.1),
    "pillar": sc.Body.solid(2.0),
    "tall pillar": sc.Body.solid(6.0),
    "tube": sc.Body.tube(0.5, 0.8),
    "rounded": sc.Body.solid(1.0, fillet=0.1),
    "cone": sc.Body.frustum(0.7, 1.0, 2.0),
}


def odd(number, seed):
    """A motion at thresholds that are exactly met; None for a state that no body can have."""
    rng = np.random.default_rng([seed, number])

    def one(*of):
        return of[rng.integers(len(of))]

    def speed():
        return float(one(*ODD_SPEEDS))

    kind = one(*ODD_BODIES)
    body, mu = ODD_BODIES[kind], one(0.3, 0.5, 0.0, 1e-8, 1.0)
    rubs = [sc.Coulomb(mu), sc.Coulomb(mu, static=1.2 * mu), sc.Coulomb(mu, face="disc")]
    laws = sc.loss.AirLinear(0.02), sc.loss.RollingResistance(0.03), sc.loss.AirQuadratic(0.1)
    how = {
        "contact": one(*rubs, sc.Viscous(0.3), "rolling", "smooth"),
        "losses": one(None, None, *laws),
        "restitution": one(None, 0.0, 0.5),
        "table": sc.Table(float(one(*ODD_SLOPES)), phi0=one(0.0, np.pi, 0.7, 1e-300, -np.pi / 2)),
    }
    theta, start = one(0.0, 0.0, np.pi, 1e-300, 1e-13, 1e-11, 1e-6), rng.integers(4)
    try:
        if start == 0:
            state = sc.spun(body, speed(), (speed(), speed()))
        elif start == 3 and how["restitution"] is not None:
            height = one(0.0, 1e-300, 1e-10, 0.2)
            state = sc.State(theta, 0.0, 0.0, speed(), height=height, lift=speed())
        else:
            turns = speed() if start == 2 else 0.0
            state = sc.State(theta, turns, speed(), speed(), slip=(speed(), speed()))
    except ValueError:
        return None
    return kind, body, state, how


def followed(number, restitution):
    """The motion, its time, and by how much its energy is off beyond its claim; None for a refusal."""
    kind, body, state, how = drawn(number)
    if restitution is None and state.height is not None:
        return kind, None, 0.0, 0.0
    return kind, *rolled(body, state, TIMES, {**how, "restitution": restitution})


def rolled(body, state, times, how):
    """The same of a start, without its kind."""
    restitution, since = how["restitution"], time.process_time()
    try:
        m = sc.roll(body, state, times, **how)
    except ValueError as e:
        return str(e).split(":")[0], time.process_time() - since, 0.0
    lasts = time.process_time() - since
    if m.t.size == 0:
        return m, lasts, 0.0
    lost = m.energy + m.dissipated
    for name in ("work_lost", "lost_in_impacts"):
        lost = lost + (getattr(m, name) if name == "work_lost" and m.losses is not None else 0.0)
    if restitution is not None:
        lost = lost + m.lost_in_impacts
    fastest = max(1.0, float(np.abs(m.w).max()))
    claim = 1e-12 * fastest**2 + 10 * fastest * (m.error + m.pose_error)
    return m, lasts, float(np.abs(lost - lost[0]).max()) - claim


def follows_odd(count, seed):
    """Follows odd starts, and prints those that take long, are not a number or are off."""
    ends = Counter()
    for number in range(count):
        found = odd(number, seed)
        if found is None:
            continue
        kind, body, state, how = found
        m, lasts, beyond = rolled(body, state, ODD_TIMES, how)
        if isinstance(m, str):
            ends[f"refused: {m.split(' =')[0]}"] += 1
            continue
        ends[m.status.name if m._limit is None else f"{m.status.name}, {m._limit[0]}"] += 1
        for told, bad in (
            (f"{lasts:.2f} s", lasts > 0.5),
            (f"off by {beyond:.1g}", not beyond <= 0),
            ("not a number", np.isnan(m.theta).any() or np.isnan(m.w).any()),
        ):
            if bad:
                print(f"{number}, {kind}: {told}, {m.status.name}", state, how, sep="\n    ", flush=True)
    print(dict(ends))


def fastest(repeats, call, *of, **how):
    """The least time of the processor that a call takes, in us."""
    times = []
    for _ in range(repeats):
        since = time.process_time()
        call(*of, **how)
        times.append(time.process_time() - since)
    return 1e6 * min(times)


SWEPT = {
    "rolls": {},
    "slips": {"contact": sc.Coulomb(0.05)},
    "slips, then rolls": {"contact": sc.Coulomb(0.3)},
    "on a film": {"contact": sc.Viscous(0.3)},
    "hops": {"contact": sc.Coulomb(0.3), "restitution": 0.4},
    "with rolling resistance": {"contact": sc.Coulomb(0.6), "losses": sc.loss.RollingResistance(0.01)},
}


def tells_speed(count):
    """Prints what a slope costs beside a level table, and each motion of a sweep beside one alone."""
    body, state, slope = sc.Body.solid(0.1), sc.State(1.2, 0.5, 0.0, 1.5), sc.Table(0.1, phi0=0.4)
    for want in ((), ("pose",)):
        level, tilted = (
            fastest(40, sc.roll, body, state, 20.0, tol=1e-12, table=on, want=want) for on in (None, slope)
        )
        print(f"rolls, want={want}: level {level:.0f} us, slope {tilted:.0f} us, {tilted / level:.2f}")
    rng = np.random.default_rng(1)
    low, high = [0.3, -1, -0.5, -3, -1, -1, 0.02, -3], [1.5, 1, 0.5, 3, 1, 1, 0.5, 3]
    starts = rng.uniform(low, high, (count, 8))
    for name, how in SWEPT.items():
        given, alone = {"tol": 1e-12} | how, []
        rows = np.where((name == "rolls") & np.isin(range(8), (4, 5)), 0.0, starts)
        for x in [*rows[: count // 4], rows.T]:
            start, table = sc.State(*x[:4], slip=tuple(x[4:6])), sc.Table(x[6], phi0=x[7])
            roll = sc.roll if x.ndim == 1 else partial(sc.sweep.roll, threads=1)
            alone.append(fastest(2, roll, body, start, 10.0, table=table, **given))
        each, mean = alone.pop() / count, np.mean(alone)
        print(f"{name}: alone {mean:.0f} us, in a sweep {each:.0f} us, {mean / each:.1f} times as fast")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--only", nargs=2, metavar=("NUMBER", "RESTITUTION"))
    parser.add_argument("--odd", type=int, metavar="SEED")
    parser.add_argument("--speed", action="store_true")
    asked = parser.parse_args()
    warnings.simplefilter("ignore")
    if asked.speed:
        tells_speed(asked.count)
        return
    if asked.odd is not None:
        follows_odd(asked.count, asked.odd)
        return
    if asked.only:
        number, e = int(asked.only[0]), None if asked.only[1] == "None" else float(asked.only[1])
        print(*drawn(number), sep="\n")
        kind, m, lasts, off = followed(number, e)
        print(f"{lasts:.3f} s, off {off:.2g}", m, *getattr(m, "phases", ()), sep="\n")
        return
    for e in (None, 0.0, 0.5):
        ends, kept, off, slow = Counter(), 0, [], []
        for number in range(asked.count):
            kind, m, lasts, beyond = followed(number, e)
            if m is None:
                continue
            kept += 1
            why = m if isinstance(m, str) else m.status.name if m._limit is None else m._limit[0]
            good = not isinstance(m, str) and m.status in (ENDS if e is None else ENDS[3:])
            ends["followed" if good else f"{kind}: {why}"] += 1
            if not good:
                print("not followed:", number, e, kind, why)
            if beyond > 0:
                off.append((number, beyond))
            if lasts > 0.5:
                slow.append((number, round(lasts, 2)))
        share = ends["followed"] / max(kept, 1)
        print(
            f"restitution {e}: {100 * share:.2f} % of {kept} followed; {len(off)} off, {len(slow)} above 0.5 s"
        )
        print("   ", dict(ends), "off:", off[:8], "slow:", slow[:8])


if __name__ == "__main__":
    main()
