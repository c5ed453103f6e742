"""Motions that end, by the sweep and one by one: kinds and times of ends, methods, true and claimed errors.

    python benches/ends.py [--count 1000000] [--truth 2000] [--hard 1500] [--set NAME ...]

Random starts as in benches/peers/endings.py, to t = 20: `--count` of them by `sweep.roll` at 1e-10 and by
`sc.roll`, and `--truth` of them by heyoka in 80-bit arithmetic (0: none). Then `--hard` starts of every hard
set (0: none) by all three. A wrong kind is a kind of end that differs from that by the other method. Errors
are those of the time of the end or of the state there, whichever is larger, or of the state at t = 20, in
natural units; true ones are against heyoka, and `over` counts those above twice the claimed one and 1e-14.
Microseconds are CPU time of one thread.
"""

import argparse
import os
import pathlib
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np

sys.path.insert(1, str(pathlib.Path(__file__).parent / "peers"))
from clock import has, said, table
from endings import T, draw, heyoka_alone, press, table_of

import spincyl as sc

TOL = 1e-10
HEAD = (
    *(
        "starts",
        "motions",
        "us by the sweep",
        "us one by one",
        "who answered",
        "end",
        "wrong kinds, one by one",
    ),
    *("times differ: median", "99 %", "worst", "wrong kinds, heyoka", "error: median", "99 %", "worst"),
    *("claimed: median", "99 %", "worst", "over"),
)


def singly(ell, start):
    """Kind, time and last state (n, 6) by `sc.roll`, and the CPU seconds that it took."""
    found, began = np.empty((ell.size, 6)), time.process_time()
    for i in range(ell.size):
        motion = sc.roll(sc.Body.solid(ell[i]), sc.State(*start[i]), [0.0, T])
        event = motion.event
        if event is None:
            found[i] = 0, T, motion.theta[-1], *motion.w[-1]
        else:
            last = event.state
            found[i] = int(event.ending), event.time, last.theta, last.w1, last.w2, last.w3
    return found, time.process_time() - began


def one_by_one(ell, start, pieces=64):
    """As `singly`, on all cores."""
    parts = [x for x in np.array_split(np.arange(ell.size), pieces) if x.size]
    with ProcessPoolExecutor(os.cpu_count(), mp_context=get_context("spawn")) as pool:
        told = list(pool.map(singly, [ell[x] for x in parts], [start[x] for x in parts]))
    return np.concatenate([found for found, _ in told]), sum(seconds for _, seconds in told)


def swept(ell, start):
    """The result of the sweep, and its CPU seconds: the least of three calls for few motions."""
    body, state, least = sc.Body.solid(ell), sc.State(*start.T), np.inf
    for _ in range(3 if ell.size <= 20_000 else 1):
        began = time.process_time()
        found = sc.sweep.roll(body, state, T, want=("final", "end"), tol=TOL, threads=1)
        least = min(least, time.process_time() - began)
    return found, least


def parts(x):
    """Median, 99th percentile and maximum."""
    return tuple(float(f) for f in (*np.quantile(x, (0.5, 0.99)), x.max())) if x.size else (np.nan,) * 3


def shares(codes, names):
    """The share of each code, with its name."""
    count = np.bincount(codes)
    return ", ".join(f"{names(i).name.lower()} {n / codes.size:.4g}" for i, n in enumerate(count) if n)


def measured(name, ell, start, truths):
    """Prints the row of one set of starts."""
    found, seconds = swept(ell, start)
    told, claimed = table_of(found), found["error"].to_numpy()
    alone, spent = one_by_one(ell, start)
    same = told[:, 0] == alone[:, 0]
    ended = same & (told[:, 0] > 0)
    row = [name, ell.size, seconds / ell.size * 1e6, spent / ell.size * 1e6]
    row += [
        shares(found["method"].to_numpy(), sc.sweep.Answer),
        shares(found["status"].to_numpy(), sc.sweep.Status),
    ]
    row += [int((~same).sum()), *parts(np.abs(told[ended, 1] - alone[ended, 1]))]
    if truths:
        some = np.linspace(0, ell.size - 1, min(truths, ell.size)).astype(int)
        # heyoka detects zeros of N, and a body that lifts off at once has none
        some = some[press(ell[some], start[some]) > 0]
        truth = heyoka_alone(ell[some], start[some], 1e-18, wide=True)()
        right = told[some, 0] == truth[:, 0]
        off = np.abs(told[some, 1:] - truth[:, 1:]).max(axis=1)[right]
        claim = claimed[some][right]
        row += [f"{int((~right).sum())} of {some.size}", *parts(off), *parts(claim)]
        row.append(int((off > np.maximum(2 * claim, 1e-14)).sum()))
    print("| " + " | ".join(map(said, row)) + " |", flush=True)


def powers(random, low, high, n):
    """Log-uniform, of either sign."""
    return 10 ** random.uniform(low, high, n) * random.choice([-1, 1], n)


def grazing(n):
    """Starts scaled so that N just touches 0, and then by 1 +- 1e-2 ... 1e-10."""
    ell, start = draw(max(40, n), seed=17)

    def lifts(scale):
        state = sc.State(start[:, 0], *(scale[:, None] * start[:, 1:]).T)
        found = sc.sweep.roll(sc.Body.solid(ell), state, T, want="normal_min", tol=TOL)
        return found["status"].to_numpy() == sc.sweep.Status.LIFT_OFF, found["normal_min"].to_numpy()

    low, high = np.full(ell.size, 0.2), np.ones(ell.size)
    some = ~lifts(low)[0] & lifts(high)[0]
    ell, start, low, high = ell[some], start[some], low[some], high[some]
    for _ in range(50):
        middle = (low + high) / 2
        up, _ = lifts(middle)
        low, high = np.where(up, low, middle), np.where(up, middle, high)
    # where N only touches zero, and no other end comes first
    some = np.flatnonzero(lifts(low)[1] < 1e-6)[: max(1, n // 18)]
    factors = 1 + np.concatenate([s * 10.0 ** -np.arange(2, 11) for s in (1, -1)])
    scale = (low[some][:, None] * factors).ravel()
    which = np.repeat(some, factors.size)
    return ell[which], np.column_stack([start[which, 0], scale[:, None] * start[which, 1:]])


def hard(n):
    """{name: function that returns ell and starts}."""

    def changed(change, seed):
        def make():
            random = np.random.default_rng(seed)
            ell, start = draw(n, seed)
            ell, start = ell.copy(), start.copy()
            ell = change(ell, start, random)
            return ell, start

        return make

    def resting(ell, start, _):
        start[:, 2] = 0
        return ell

    def almost(ell, start, random):
        start[:, 2] = powers(random, -12, -2, n)
        return ell

    def scaled(factor):
        def change(ell, start, _):
            start[:, 1:] *= factor
            return ell

        return change

    def flat(ell, start, random):
        return random.uniform(1e-3, 0.1, n)

    def upright(ell, start, random):
        start[:, 0] = np.abs(powers(random, -3, -1, n))
        start[:, 1:] *= 0.1
        return ell

    def lying(ell, start, random):
        start[:, 0] = np.pi / 2 - np.abs(powers(random, -9, np.log10(0.3), n))
        return ell

    return {
        "w2 = 0": changed(resting, 11),
        "w2 = 1e-12 to 1e-2": changed(almost, 12),
        "w x 3": changed(scaled(3), 13),
        "w x 0.2": changed(scaled(0.2), 14),
        "flat disks, ell < 0.1": changed(flat, 15),
        "theta0 = 1e-3 to 0.1, slow": changed(upright, 16),
        "pi/2 - theta0 = 1e-9 to 0.3": changed(lying, 18),
        "grazing": lambda: grazing(n),
    }


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=lambda x: int(float(x)), default=1_000_000)
    parser.add_argument("--truth", type=int, default=2000)
    parser.add_argument("--hard", type=int, default=1500)
    parser.add_argument("--set", nargs="*", choices=list(hard(1)), metavar="NAME", help=", ".join(hard(1)))
    args = parser.parse_args()
    if args.truth and not has("heyoka"):
        sys.exit("true errors need heyoka: pip install heyoka, or --truth 0")
    print(table(HEAD, []), end="")
    if args.count and not args.set:
        measured("random", *draw(args.count), args.truth)
    if args.hard:
        for name, make in hard(args.hard).items():
            if not args.set or name in args.set:
                measured(name, *make(), args.truth)


if __name__ == "__main__":
    main()
