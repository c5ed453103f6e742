"""Random bodies to rest on a face, on their side, or to t = 200: what is followed, its energy, and what takes long.

    python benches/faces.py                          500 starts, each with three coefficients: a minute
    python benches/faces.py --count 20000            the figures of docs/hard-cases.md, half an hour
    python benches/faces.py --only 17 0.3            one of them, with its phases
    python benches/faces.py --coins 4000             the shares of thick coins that come to rest on their side
    python benches/faces.py --limit 5                gives up after 5 seconds of one motion

Coins, cylinders, tubes, pucks (with a pressure on the whole face), and the bodies of several circles of
benches/profiles.py, on a rim, slipping or not, or let fall; Coulomb friction from 0.05 to 1, restitution 0, 0.3 and
0.9, to t = 200. One start in five is exactly flat on a face, flat in the air, or at rest. A motion is followed if it
reaches the last time or rests. Prints those whose energy differs from that at the start by more than 1e-12 and four times
the estimated error, where motions end, rows for docs/hard-cases.md, and all that are not followed, by their reason.
"""

import argparse
import multiprocessing
import signal
import time
import warnings
from collections import Counter, defaultdict

import numpy as np
import profiles

import spincyl as sc

BOUNCES = (0.0, 0.3, 0.9)
UNTIL = 200.0
TIMES = np.linspace(0.0, UNTIL, 9)
FOLLOWED = (sc.Ending.DONE, sc.Ending.STOPS)
OUTCOMES = ("heads", "tails", "side", "edge", "moving", "not followed")
#: rates below which a body is at rest
STILL = 1e-9
#: phases of a body on its side
ON_SIDE = ("lying", "pivoting", "rolling on its side", "rolling round its apex")
#: what ends the turning of a tossed coin that rolls on its rim
DIES = sc.loss.DryContour(0.01)
#: published measurement of the share of tossed coins that came to rest on their side, by thickness over radius
MEASURED = {0.707: 0.132, 1.154: 0.410}


def coin(u):
    return sc.Body.solid(u(0.02, 0.3))


def cylinder(u):
    return sc.Body.solid(u(0.3, 3.0))


def tube(u):
    return sc.Body.tube(u(0.1, 3.0), bore=u(0.0, 1.0))


def puck(u):
    return sc.Body.solid(u(0.1, 1.0))


def fillet(u):
    radius = u(0.02, 0.3)
    return sc.Body.solid(u(radius, 2.0), fillet=radius)


TWO_RIMS = (coin, cylinder, tube, puck, fillet)
FLAT = (*TWO_RIMS, profiles.cup, profiles.bottle, profiles.wheel, profiles.rounded)
KINDS = (*FLAT, profiles.five, profiles.cone, profiles.cap, profiles.dumb_bell)


#: exact starts
EXACT = (
    "flat on a face",
    "flat in the air",
    "at rest on a rim",
    "kicked up off a face",
    "at rest in the air",
)


def drawn(number, seed=0):
    """A kind, a body of it, a state, the law of friction, and the sort of the start."""
    rng = np.random.default_rng([seed, number])

    def u(low, high):
        return float(rng.uniform(low, high))

    exact = number % 5 == 0
    kinds = FLAT if exact else KINDS
    kind = kinds[rng.integers(len(kinds))]
    body = kind(u)
    mu = sc.Coulomb(u(0.05, 1.0), face="disc" if kind is puck else "ring")
    w = rng.uniform(-1.5, 1.5, 3) * [1, 1, 2]
    velocity = rng.normal(size=3)
    end = float(rng.choice([0.0, np.pi]))
    height, lean = u(0.0, 2.0), u(0.05, 1.5 if kind in TWO_RIMS else 3.0)
    if not exact:
        if rng.random() < 0.5:
            state = sc.dropped(
                body, height, u(0.05, 3.09), w1=w[0], w2=w[1], w3=w[2], velocity=tuple(velocity)
            )
            return kind, body, state, mu, "in the air"
        slips = rng.random() < 0.5
        slip = tuple(rng.uniform(-1, 1, 2)) if slips else (0.0, 0.0)
        state = sc.State(lean, *map(float, w), slip=slip)
        return kind, body, state, mu, "slips on a rim" if slips else "rolls on a rim"
    what = rng.integers(5)
    if what == 0:
        state = sc.spun(body, float(w[2]), velocity=(float(velocity[0]), float(velocity[1])), theta=end)
    elif what == 1:
        state = sc.dropped(body, height, end, w3=float(w[2]), velocity=tuple(velocity))
    elif what == 2:
        state = sc.State(lean, 0.0, 0.0, 0.0, slip=(0.0, 0.0))
    elif what == 3:
        state = sc.State(0.0, 0.0, -u(0.0, 1.0), 0.0, slip=(0.0, 0.0))
    else:
        state = sc.dropped(body, height, u(0.05, 3.0))
    return kind, body, state, mu, EXACT[what]


def outcome(motion):
    """Where a body is at the end of its motion."""
    if motion.status not in FOLLOWED:
        return "not followed"
    if motion.status == sc.Ending.DONE and np.abs(motion.w[-1]).max() > STILL:
        return "moving"
    phase = motion.phases[-1].kind
    if phase == "on its face":
        return "heads" if motion.axis_up[-1] > 0 else "tails"
    if phase in ON_SIDE:
        return "side"
    return "edge"


def late(*_):
    raise TimeoutError


def followed(number, restitution, limit=0.0):
    _, body, state, table, _ = drawn(number)
    since = time.process_time()
    signal.signal(signal.SIGVTALRM, late)
    signal.setitimer(signal.ITIMER_VIRTUAL, limit)
    try:
        with warnings.catch_warnings(action="ignore"):
            motion = sc.roll(body, state, TIMES, contact=table, restitution=restitution)
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
    return motion, time.process_time() - since


def one(job):
    """Kind and start, outcome, why it is not followed, seconds, evaluations, and whether the energy is off."""
    number, restitution, limit = job
    kind, _, _, _, start = drawn(number)
    kind = f"{kind.__name__}, {start}"
    try:
        motion, seconds = followed(number, restitution, limit)
    except TimeoutError:
        return number, restitution, kind, "not followed", f"over {limit} s", limit, 0, 0.0
    except ValueError as error:
        return number, restitution, kind, "not followed", "refused: " + str(error)[:90], 0.0, 0, 0.0
    what = outcome(motion)
    why = "" if what != "not followed" else motion.status.name + ": " + motion.message.split(": ")[0][:90]
    total = profiles.energies(motion)
    allowed = 1e-12 * max(1.0, float(total[0])) if len(total) else 0.0
    if len(total):
        allowed += 4 * motion.error * max(1.0, float(np.abs(motion.w).max()))
    off = float(np.ptp(total)) / allowed if len(total) and np.isfinite(allowed) else 0.0
    return number, restitution, kind, what, why, seconds, motion.nfev, off


def show(number, restitution):
    _, body, state, table, start = drawn(number)
    print(body, state, table, start, sep="\n")
    motion, seconds = followed(number, restitution)
    print(f"{seconds:.3f} s, {motion.nfev} evaluations, {motion.message}")
    print(*motion.phases[:40], sep="\n")
    total = profiles.energies(motion)
    print("energy", total - total[0], "error", motion.error)


def tossed(job):
    """How a coin of this thickness over radius lies after one toss: on a face, on its side, or neither."""
    number, thickness, restitution, mu, limit = job
    rng = np.random.default_rng([7, number])
    body = sc.Body.solid(thickness / 2)
    theta, w = float(np.arccos(rng.uniform(-1, 1))), 2.0 * rng.normal(size=3)
    velocity = (*(0.5 * rng.normal(size=2)), 0.0)
    state = sc.dropped(body, 10.0, theta, w1=w[0], w2=w[1], w3=w[2], velocity=velocity)
    signal.signal(signal.SIGVTALRM, late)
    signal.setitimer(signal.ITIMER_VIRTUAL, limit)
    try:
        with warnings.catch_warnings(action="ignore"):
            motion = sc.roll(
                body, state, [0.0, UNTIL], contact=sc.Coulomb(mu), restitution=restitution, losses=DIES
            )
    except (TimeoutError, ValueError):
        return "not followed"
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
    if motion.status not in FOLLOWED:
        return "not followed"
    phase = motion.phases[-1].kind
    if phase == "on its face":
        return "face"
    return "side" if phase in ON_SIDE else "neither"


def coins(count, jobs, limit):
    """Shares of solid cylinders on their side, tossed from 10 R with any orientation and normal rates of 2 sqrt(g/R)."""
    print(
        "| thickness over radius | restitution | friction | on its side | published measurement | on neither | lost |"
    )
    print("| --- | --- | --- | --- | --- | --- | --- |")
    with multiprocessing.Pool(jobs) as pool:
        for restitution in (0.0, 0.3, 0.5):
            for mu in (0.2, 0.5):
                for thickness, known in MEASURED.items():
                    each = [(number, thickness, restitution, mu, limit) for number in range(count)]
                    found = Counter(pool.imap_unordered(tossed, each, chunksize=5))
                    lies = found["side"] + found["face"]
                    share = found["side"] / lies
                    error = np.sqrt(share * (1 - share) / lies)
                    print(
                        f"| {thickness} | {restitution} | {mu} | {share:.3f} ± {error:.3f} | {known} "
                        f"| {found['neither']} | {found['not followed']} |",
                        flush=True,
                    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", nargs=2, metavar=("NUMBER", "RESTITUTION"))
    parser.add_argument("--coins", type=int)
    parser.add_argument("--limit", type=float, default=0.0, metavar="SECONDS")
    asked = parser.parse_args()
    if asked.only:
        show(int(asked.only[0]), float(asked.only[1]))
        return
    if asked.coins:
        coins(asked.coins, asked.jobs, asked.limit)
        return
    jobs = [(number, e, asked.limit) for number in range(asked.count) for e in BOUNCES]
    found, lost, rows = defaultdict(Counter), defaultdict(list), []
    with multiprocessing.Pool(asked.jobs) as pool:
        for row in pool.imap_unordered(one, jobs, chunksize=20):
            rows.append(row)
            number, e, kind, what, why, _, _, off = row
            found[e][what] += 1
            if why:
                lost[why].append((number, e, kind))
            if off > 1:
                print(f"energy: {number} {e} {kind}, {off:.1f} of what is allowed", flush=True)
    print("\n| restitution | " + " | ".join(OUTCOMES) + " |\n" + "| --- " * (len(OUTCOMES) + 1) + "|")
    for e in BOUNCES:
        shares = (f"{100 * found[e][what] / asked.count:.2f} %" for what in OUTCOMES)
        print(f"| {e} | " + " | ".join(shares) + " |")
    shares = [100 * (1 - found[e]["not followed"] / asked.count) for e in BOUNCES]
    faces = sum(row[4].startswith("FACE") for row in rows)
    off = sum(row[7] > 1 for row in rows)
    slowest = max(rows, key=lambda row: row[5])
    most = max(row[6] for row in rows)
    print(
        f"\n| E18 | {asked.count} random starts of bodies with faces and several circles, on a rim, in the air, flat "
        "and at rest, with Coulomb(0.05 to 1) and restitution 0, 0.3 and 0.9, to t = 200 | to rest or to the last "
        "time, or an error with its reason; none ends where a face lands; energy constant | "
        f"{', '.join(f'{share:.2f}' for share in shares)} % are followed; {faces} end where a face lands; the "
        f"energy of {off} of {len(rows)} is off; the slowest takes {slowest[5]:.2f} s and the largest number of "
        f"evaluations is {most:.1e} | `python benches/faces.py --count {asked.count}` |"
    )
    for row in sorted(rows, key=lambda row: -row[5])[:5]:
        print(f"slow: {row[0]} {row[1]} {row[2]}, {row[5]:.3f} s, {row[6]} evaluations, {row[3]}")
    for why, all_of in sorted(lost.items(), key=lambda item: -len(item[1])):
        print(f"not followed: {len(all_of)} {why}")
        for number, e, kind in sorted(all_of):
            print(f"    {number} {e} {kind}")


if __name__ == "__main__":
    main()
