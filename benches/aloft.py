"""Random motions with flights, impacts and lying bodies: their endings, energies, times and estimated errors.

    python benches/aloft.py                          500 starts, each with three coefficients: a minute
    python benches/aloft.py --count 20000            half an hour
    python benches/aloft.py --scene 17 0.3           one of them, also with a larger tolerance
    python benches/aloft.py --hops                   the cost of a hop: a flight, its landing and the impact

Tubes, cylinders, coins, disks, hoops, balls, rounded cylinders and bodies of any moments, standing on a rim or in the
air, slipping or not, with Coulomb(0.05 to 1), to t = 50. Every motion is computed twice, the second time with
a larger tolerance, and the difference is compared with the two estimated errors.
"""

import argparse
import collections
import multiprocessing
import time
import warnings

import numpy as np

import spincyl as sc

KINDS = ("tube", "cylinder", "coin", "disk", "hoop", "ball", "rounded", "any moments")
UNTIL = 50.0
WIDER = 1e-12
#: endings of motions that are determined; the others are errors
SOUND = (sc.Ending.FACE, sc.Ending.STOPS)


def drawn(number, seed=51):
    """Kind, body, initial state and contact of the motion with this number."""
    rng = np.random.default_rng([seed, number])
    kind = KINDS[number % len(KINDS)]
    if kind == "tube":
        body = sc.Body.tube(rng.uniform(0.1, 6.0), bore=rng.uniform())
    elif kind == "cylinder":
        body = sc.Body.solid(rng.uniform(0.1, 3.0))
    elif kind == "coin":
        body = sc.Body.solid(rng.uniform(0.02, 0.2))
    elif kind in ("disk", "hoop"):
        body = sc.Body.tube(0.0, bore=float(kind == "hoop"))
    elif kind == "ball":
        i1 = rng.uniform(0.25, 0.6)
        body = sc.Body.ball(rng.uniform(-0.3, 0.3), i1, min(rng.uniform(0.3, 0.6), 1.9 * i1))
    elif kind == "rounded":
        fillet = rng.uniform(0.01, 0.4)
        body = sc.Body.solid(rng.uniform(fillet, 2.0), fillet=fillet)
    else:
        i1 = 10 ** rng.uniform(-1.0, 0.5)
        body = sc.Body(rng.uniform(0.1, 2.0), i1, i1 * rng.uniform(0.2, 1.9))
    theta = rng.uniform(0.1, np.pi - 0.1 if body.ell == 0 else 1.5)
    air = {"height": rng.uniform(0.0, 2.0), "lift": rng.normal()} if rng.random() < 0.2 else {}
    slip = tuple(rng.normal(size=2)) if rng.random() < 0.7 else None
    state = sc.State(theta, *rng.normal(size=3), slip=slip, **air)
    return kind, body, state, sc.Coulomb(rng.uniform(0.05, 1.0))


def followed(number, restitution, **how):
    """The motion with this number, and its processor seconds."""
    _, body, state, table = drawn(number)
    since = time.process_time()
    t = np.linspace(0.0, UNTIL, 26)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        motion = sc.roll(body, state, t, contact=table, restitution=restitution, **how)
    return motion, time.process_time() - since


def told(motion, k):
    """A state in numbers that do not depend on the rim to which it refers, since a body on both rims has two."""
    theta, (w1, w2, w3) = motion.theta[k], motion.w[k]
    if abs(theta - np.pi / 2) < 1e-9:
        w2, w3 = abs(w2), abs(w3)
    return np.array([np.sin(theta), w1, w2, w3, motion.height[k]])


def one(job):
    """Kind, end, seconds, error of the energy, estimated error, and difference of two runs over their estimated errors."""
    number, restitution = job
    kind, *_ = drawn(number)
    try:
        motion, seconds = followed(number, restitution)
        again, _ = followed(number, restitution, tol=WIDER)
    except ValueError as error:
        return number, restitution, kind, "refused: " + str(error).split(":")[0], 0.0, 0.0, 0.0, 0.0
    end = "at the end it " + KINDS_OF_PHASES[motion.phases[-1].kind]
    if motion.event is not None:
        end = motion.status.name
    energy = motion.energy + motion.dissipated + motion.lost_in_impacts
    off = float(np.ptp(energy)) / max(1.0, float(energy[0])) if len(energy) else 0.0
    both = min(len(motion.t), len(again.t))
    apart, claims = 0.0, motion.error + again.error
    if both and np.isfinite(claims):
        apart = max(float(np.abs(told(motion, k) - told(again, k)).max()) for k in (both // 2, both - 1))
    return number, restitution, kind, end, seconds, off, motion.error, apart / max(claims, 1e-300)


KINDS_OF_PHASES = {
    "rolling": "rolls",
    "slipping": "slips",
    "flying": "flies",
    "lying": "lies and slips",
    "pivoting": "lies and pivots",
    "rolling on its side": "rolls on its side",
}


def scene(number, restitution):
    """Show a motion and its second run."""
    kind, body, state, table = drawn(number)
    print(kind, body, state, table, sep="\n")
    for tol in (None, WIDER):
        motion, seconds = followed(number, restitution, **({} if tol is None else {"tol": tol}))
        kinds = collections.Counter(phase.kind for phase in motion.phases)
        print(f"{seconds:.3f} s, {motion.message}\n  {dict(kinds)}, {len(motion.impacts)} impacts")
        if len(motion.t):
            last = float(motion.theta[-1]), *map(float, motion.w[-1]), float(motion.height[-1])
            print(f"  at t = {motion.t[-1]}: {last}, claim {motion.error:.1e}")


def hops():
    """Print the processor seconds of hops whose slip turns in the impact, and of other hops."""
    tube, ball = sc.Body.tube(6.0, bore=0.8), sc.Body.ball(0.0, 0.4, 0.4)
    print("| hops | each | impacts | estimated error |\n| --- | --- | --- | --- |")
    for name, body, table in (
        ("a ball, friction", ball, sc.Coulomb(0.3)),
        ("the tube, no friction", tube, sc.Coulomb(0.0)),
        ("the tube, friction", tube, sc.Coulomb(0.3)),
    ):
        least = np.inf
        state = sc.State(1.2, 0.5, 0.3, 2.0, slip=(0.4, -0.7), height=1.0)
        for _ in range(20):
            since = time.process_time()
            for _ in range(20):
                m = sc.roll(body, state, 100.0, contact=table, restitution=0.98)
            least = min(least, (time.process_time() - since) / 20)
        count = len(m.impacts)
        print(f"| {name} | {1e6 * least / count:.1f} us | {count} | {m.error:.0e} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--scene", nargs=2, type=float, metavar=("NUMBER", "RESTITUTION"))
    parser.add_argument("--hops", action="store_true")
    given = parser.parse_args()
    if given.hops:
        hops()
        return
    if given.scene:
        scene(int(given.scene[0]), given.scene[1])
        return
    values = (0.0, 0.3, 0.9)
    jobs = [(given.first + k, e) for k in range(given.count) for e in values]
    with multiprocessing.Pool() as pool:
        found = pool.map(one, jobs, chunksize=16)
    ends = collections.Counter((end, e) for _, e, _, end, *_ in found)
    print("| how it ends | " + " | ".join(f"e = {e}" for e in values) + " |")
    print("| --- |" + " --- |" * len(values))
    for end in sorted({end for end, _ in ends}, key=lambda end: -sum(ends[end, e] for e in values)):
        print(f"| {end} | " + " | ".join(str(ends[end, e]) for e in values) + " |")
    good = {e: 0 for e in values}
    for (end, e), many in ends.items():
        good[e] += many if end.startswith("at the end") or end in [x.name for x in SOUND] else 0
    print(
        "| computed to the end | " + " | ".join(f"{100 * good[e] / given.count:.2f} %" for e in values) + " |"
    )
    for e in values:
        here = [x for x in found if x[1] == e]
        seconds, off, claim, ratio = (np.array([x[i] for x in here]) for i in (4, 5, 6, 7))
        print(
            f"e = {e}: {1e3 * seconds.mean():.2f} ms each, at most {seconds.max():.2f} s; energy within "
            f"{off.max():.0e}; estimated errors: median {np.median(claim):.0e}, above 1e-9 {100 * (claim > 1e-9).mean():.1f} %, "
            f"none {100 * np.isinf(claim).mean():.1f} %; beyond both {(ratio > 1).sum()}, "
            f"beyond ten times both {(ratio > 10).sum()}"
        )
        worst = sorted(here, key=lambda x: -x[7])[:5]
        print("  farthest beyond: " + ", ".join(f"{x[0]} ({x[2]}, {x[7]:.1g})" for x in worst))
        print(
            "  energy: "
            + ", ".join(f"{x[0]} ({x[2]}, {x[5]:.0e})" for x in sorted(here, key=lambda x: -x[5])[:3])
        )
    odd = [x for x in found if not x[3].startswith("at the end") and x[3] not in [y.name for y in SOUND]]
    print("not followed, by body:", dict(collections.Counter(x[2] for x in odd).most_common()))


if __name__ == "__main__":
    main()
