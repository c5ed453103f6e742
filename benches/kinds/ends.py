"""Motions that end, by the sweep and one by one: kinds and times of ends, methods, true and claimed errors.

Random starts as in peers/endings.py, to t = 20: `--count` of them by `sweep.roll` at 1e-10 and by `sc.roll`,
and `--truth` of them by heyoka in 80-bit arithmetic (0: none). Then `--hard` starts of every hard set (0:
none) by all three. A wrong kind is a kind of end that differs from that by the other method. Errors are those
of the time of the end or of the state there, whichever is larger, or of the state at t = 20, in natural
units; true ones are against heyoka, and those below 1e-14 count as none. Times of the sweep are compared with
those one by one. Microseconds are CPU time of one thread.
"""

import os
import pathlib
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np

sys.path.insert(1, str(pathlib.Path(__file__).parents[1] / "peers"))
from clock import has
from endings import T, draw, heyoka_alone, press, table_of

import spincyl as sc

DEFAULTS, FEW, HONEST = {"count": 1_000_000, "seed": 5}, "--count 20000 --truth 200 --hard 200", 2.0
NOTHING = 1e-14
TOL = 1e-10


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


def measured(tally, name, ell, start, truths):
    """Adds one set of starts to the tally."""
    found, seconds = swept(ell, start)
    told, claimed = table_of(found), found["error"].to_numpy()
    alone, spent = one_by_one(ell, start)
    same = told[:, 0] == alone[:, 0]
    us = [1e6 * x / ell.size for x in (seconds, spent)]
    tally.note("{}: {:.3g} us by the sweep, {:.3g} us one by one".format(name, *us))
    tally.count(name, "motions", n=ell.size)
    tally.count(name, "wrong kinds, one by one", n=int((~same).sum()))
    for word, of, codes in (
        ("answered by", sc.sweep.Answer, found["method"].to_numpy()),
        ("ends by", sc.sweep.Status, found["status"].to_numpy()),
    ):
        for code, n in enumerate(np.bincount(codes)):
            tally.count(f"{name}, {word}", of(code).name.lower() if n else "", n=int(n))
    for i in np.flatnonzero(same & (told[:, 0] > 0)):
        tally.add(f"{name}: times, aside", abs(told[i, 1] - alone[i, 1]), claimed[i])
    if not truths:
        return
    some = np.linspace(0, ell.size - 1, min(truths, ell.size)).astype(int)
    # heyoka detects zeros of N, and a body that lifts off at once has none
    some = some[press(ell[some], start[some]) > 0]
    truth = heyoka_alone(ell[some], start[some], 1e-18, wide=True)()
    right = told[some, 0] == truth[:, 0]
    tally.count(name, "judged by heyoka", n=some.size)
    tally.count(name, "wrong kinds, heyoka", n=int((~right).sum()))
    off = np.abs(told[some, 1:] - truth[:, 1:]).max(axis=1)
    for i, k in zip(some[right], np.flatnonzero(right), strict=True):
        tally.add(
            f"{name}: error", off[k], claimed[i], f"sc.Body.solid({ell[i]!r}), sc.State(*{start[i].tolist()})"
        )


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
            ell, start = (x.copy() for x in draw(n, seed))
            change(ell, start, np.random.default_rng(seed))
            return ell, start

        return make

    def resting(ell, start, _):
        start[:, 2] = 0

    def almost(ell, start, random):
        start[:, 2] = powers(random, -12, -2, n)

    def scaled(factor):
        def change(ell, start, _):
            start[:, 1:] *= factor

        return change

    def flat(ell, start, random):
        ell[:] = random.uniform(1e-3, 0.1, n)

    def upright(ell, start, random):
        start[:, 0] = np.abs(powers(random, -3, -1, n))
        start[:, 1:] *= 0.1

    def lying(ell, start, random):
        start[:, 0] = np.pi / 2 - np.abs(powers(random, -9, np.log10(0.3), n))

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


def options(add):
    add("--truth", type=int, default=2000, help="how many of a set are judged by heyoka")
    add("--hard", type=int, default=1500, help="how many starts of each hard set")
    add("--set", nargs="*", choices=list(hard(1)), metavar="NAME", help=", ".join(hard(1)))


def judge(given, tally):
    if given.truth and not has("heyoka"):
        sys.exit("true errors need heyoka: pip install heyoka, or --truth 0")
    if given.count and not given.set:
        measured(tally, "random", *draw(given.count, given.seed), given.truth)
    for name, make in hard(given.hard).items() if given.hard else ():
        if not given.set or name in given.set:
            measured(tally, name, *make(), given.truth)
