"""Random bodies on random slopes to t = 50: what is followed, its energy, and what takes long.

    python benches/slopes.py                   500 starts, each with three restitutions
    python benches/slopes.py --count 3334      10,000 motions, the figures of docs/hard-cases.md
    python benches/slopes.py --only 17 0.5     one of them, with its phases

Cylinders, tubes, coins, rounded bodies, balls and tippe tops on a rim, slipping or not, at rest, on their side, on their
face, or let fall, on slopes of 0 to 60 degrees in all directions; Coulomb friction from 0.05 to 1, half of them with rolling resistance
and air. Without a restitution every motion that the model ends is followed; with 0 and 0.5 those that reach the last
time or rest. Prints those whose energy, with all that has been taken, differs from that at the start by more than 1e-12
and ten times the estimated error, and all that are not followed, by their reason.
"""

import argparse
import time
import warnings
from collections import Counter

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


def followed(number, restitution):
    """The motion, its time, and by how much its energy is off beyond its claim; None for a refusal."""
    kind, body, state, how = drawn(number)
    if restitution is None and state.height is not None:
        return kind, None, 0.0, 0.0
    since = time.process_time()
    try:
        m = sc.roll(body, state, TIMES, restitution=restitution, **how)
    except ValueError as e:
        return kind, str(e).split(":")[0], time.process_time() - since, 0.0
    lasts = time.process_time() - since
    if m.t.size == 0:
        return kind, m, lasts, 0.0
    lost = m.energy + m.dissipated
    for name in ("work_lost", "lost_in_impacts"):
        lost = lost + (getattr(m, name) if name == "work_lost" and m.losses is not None else 0.0)
    if restitution is not None:
        lost = lost + m.lost_in_impacts
    fastest = max(1.0, float(np.abs(m.w).max()))
    claim = 1e-12 * fastest**2 + 10 * fastest * (m.error + m.pose_error)
    return kind, m, lasts, float(np.abs(lost - lost[0]).max()) - claim


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--only", nargs=2, metavar=("NUMBER", "RESTITUTION"))
    asked = parser.parse_args()
    warnings.simplefilter("ignore")
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
