"""Random scenes of every kind, and what must hold for each of them, whatever it is: 0 should be wrong.

    python benches/random_scenes.py                             200 scenes of each kind: five minutes
    python benches/random_scenes.py --count 5000 --jobs 2       the figures of docs/hard-cases.md: an hour
    python benches/random_scenes.py --kinds air "let go"        some kinds
    python benches/random_scenes.py --only "let go:17"          one scene: its call, its faults, its cost
    python benches/random_scenes.py --reference 24              some scenes beside the models of tests/reference

Kinds: bodies that hop, without and with each loss; balls whose centre of mass is far outside; flights in air; bodies that
lie on both rims; patches of contact; stones with losses; tilted bodies let go at rest; exact edges (theta = pi/2, no
drilling, no spin, w along the vertical, numbers of one decimal, 1e-300, poles); tossed coins; bodies of random parts;
films from above with noise, jittered times, lost frames and aliasing rates; spin-downs fitted by the law that made them.

Each motion is computed by `roll` with its default tolerance, by `roll` within 1e-10 and by `sweep.roll`. `invariants.py`
has the checks, and prints what each name means with --checks. A scene takes at most `--limit` seconds of the processor
and is then counted as given up. A scene depends on the seed, its kind and its index only, so that any process may do it.
"""

import argparse
import collections
import concurrent.futures
import re
import signal
import sys
import time
import warnings
import zlib

import numpy as np
import xarray  # noqa: F401  # the first sweep would take its time
from drawn_answers import ANSWERS
from drawn_motions import MOTIONS
from invariants import CHECKS, Found, judged
from limit import Late, limit

KINDS = (*MOTIONS, *ANSWERS)
BLOCK = 20
#: Messages of a documented refusal name an argument first.
NAMED = re.compile(r"[a-z_][\w.\[\]]*(, [a-z_][\w.]*)*( = |: )")


def generator(seed, kind, index):
    return np.random.default_rng([seed, zlib.crc32(kind.encode()), index])


def word_of(error):
    """A refusal without its numbers."""
    told = re.sub(r"[-+]?\d+\.?\d*(e[-+]?\d+)?", "#", str(error).split("\n")[0])
    return re.sub(r"\w+\(.*?\)", "...", told)[:110]


def one(seed, kind, index, most=60.0, loud=False):
    """The faults of one scene, its refusal, and what it cost."""
    rng, found, refused = generator(seed, kind, index), Found(), ""
    since = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            with limit(most):
                if kind in MOTIONS:
                    drawn = MOTIONS[kind](rng, index)
                    if loud:
                        print(drawn.call())
                    m = judged(*drawn, found)
                    if loud:
                        print(m)
                else:
                    ANSWERS[kind](rng, index, found)
        except Late:
            found.note("given up")
        except ValueError as error:
            refused = word_of(error)
            if not NAMED.match(str(error)):
                found.wrong("raises", repr(error))
        except Exception as error:
            if loud:
                raise
            found.wrong("raises", repr(error))
    seconds = time.process_time() - since
    return index, found.faults, found.notes, refused, found.ending, found.evaluations, seconds


def block(job):
    seed, kind, first, last, most = job
    return kind, [one(seed, kind, index, most) for index in range(first, last)]


def died(job):
    """The scenes of a block whose process died, each in a process of its own."""
    seed, kind, first, last, most = job
    rows = []
    for index in range(first, last):
        with concurrent.futures.ProcessPoolExecutor(1) as alone:
            try:
                rows += alone.submit(block, (seed, kind, index, index + 1, most)).result()[1]
            except concurrent.futures.process.BrokenProcessPool:
                rows.append((index, {"raises": "the process died"}, {}, "", "", 0, 0.0))
    return kind, rows


def computed(jobs, processes):
    """The rows of all blocks, as they are done; a block whose process dies is done again, one scene at a time."""
    left = list(jobs)
    while left:
        with concurrent.futures.ProcessPoolExecutor(processes) as pool:
            broken = []
            while left and not broken:
                # few at a time, so that a process that dies spoils few
                now, left = left[: 2 * processes], left[2 * processes :]
                running = {pool.submit(block, job): job for job in now}
                for done in concurrent.futures.as_completed(running):
                    try:
                        yield done.result()
                    except concurrent.futures.process.BrokenProcessPool:
                        broken.append(running[done])
        for job in broken:
            yield died(job)


def table(rows, show):
    """The rows of every kind as a table of Markdown, then examples, refusals and the slowest."""
    used = [name for name in CHECKS if any(name in row[1] for of in rows.values() for row in of)]
    heads = ["kind", "scenes", "wrong", *used, "refused", "given up", "no claim", "ms", "slowest"]
    print("| " + " | ".join(heads) + " |\n| --- |" + " --- |" * (len(heads) - 1))
    total, refusals = collections.Counter(), collections.Counter()
    for kind, of in rows.items():
        counts = [sum(name in row[1] for row in of) for name in used]
        wrong = sum(bool(row[1]) for row in of)
        refused = [row[3] for row in of if row[3]]
        refusals.update((kind, word) for word in refused)
        seconds = np.array([row[6] for row in of])
        slow = of[int(seconds.argmax())]
        given_up, vague = (sum(word in row[2] for row in of) for word in ("given up", "no claim"))
        total.update(scenes=len(of), wrong=wrong, refused=len(refused), **{"given up": given_up})
        cells = [kind, len(of), wrong, *counts, len(refused), given_up, vague]
        cells += [f"{1e3 * np.median(seconds):.0f}", f"{seconds.max():.1f} s (:{slow[0]})"]
        print("| " + " | ".join(map(str, cells)) + " |")
    print(", ".join(f"{n} {word}" for word, n in total.items()))
    print("\nThe first faults, each with the scene that --only repeats:")
    for kind, of in rows.items():
        shown = collections.Counter()
        for row in of:
            for name, text in row[1].items():
                shown[name] += 1
                if shown[name] <= show:
                    print(f"  {kind}:{row[0]}  {name}: {text[:300]}")
    print("\nRefused:")
    for (kind, word), n in sorted(refusals.items(), key=lambda x: -x[1]):
        print(f"  {n:5d}  {kind}: {word}")
    print("\nEndings:")
    for kind, of in rows.items():
        ends = collections.Counter(row[4] for row in of if row[4])
        if ends:
            print(f"  {kind}: " + ", ".join(f"{n} {word}" for word, n in ends.most_common()))
    return total["wrong"]


def main():
    shape = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=shape)
    parser.add_argument("--count", type=int, default=200, help="scenes of each kind")
    parser.add_argument("--first", type=int, default=0, help="index of the first scene")
    parser.add_argument("--seed", type=int, default=64)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS, metavar="KIND")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds of the processor for one scene")
    parser.add_argument("--show", type=int, default=3, help="faults of each kind to show")
    parser.add_argument("--only", metavar="KIND:INDEX", help="one scene")
    parser.add_argument("--reference", type=int, metavar="COUNT", help="scenes beside the models")
    parser.add_argument("--checks", action="store_true", help="say what the checks are")
    given = parser.parse_args()
    if given.checks:
        print("\n".join(f"{name:12} {text}" for name, text in CHECKS.items()))
        return
    if given.only:
        kind, index = given.only.rsplit(":", 1)
        _, faults, notes, refused, _, evaluations, seconds = one(
            given.seed, kind, int(index), given.limit, loud=True
        )
        print("\n".join(f"{name}: {text}" for name, text in faults.items()) or "nothing is wrong")
        print(f"{notes or ''} {refused} {evaluations} evaluations, {seconds:.2f} s of the processor")
        sys.exit(bool(faults))
    if given.reference:
        from beside_models import compared

        sys.exit(compared(given.seed, given.reference) > 0)
    print(f"seed {given.seed}, {given.count} scenes of each kind from {given.first}", flush=True)
    last = given.first + given.count
    jobs = [
        (given.seed, kind, k, min(k + BLOCK, last), given.limit)
        for kind in given.kinds
        for k in range(given.first, last, BLOCK)
    ]
    rows = {kind: [] for kind in given.kinds}
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        for kind, some in computed(jobs, given.jobs):
            rows[kind] += some
            if len(rows[kind]) == given.count:
                wrong = sum(bool(row[1]) for row in rows[kind])
                print(f"{kind}: {wrong} of {given.count} are wrong", file=sys.stderr, flush=True)
    except KeyboardInterrupt:
        print("interrupted: what follows is of the scenes before")
    for of in rows.values():
        of.sort(key=lambda row: row[0])
    sys.exit(table({kind: of for kind, of in rows.items() if of}, given.show) > 0)


if __name__ == "__main__":
    main()
