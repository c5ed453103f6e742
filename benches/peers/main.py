"""spincyl beside NumPy, numba, SciPy and heyoka, whichever are installed, in one run: speed, error and
ratios.

    python benches/peers/main.py [--docs] [--only JOB ...] [--quick] [--also PYTHON ...] [--narrow]

Jobs: maps (grid and scattered points), motions (ensembles that go on), endings (random starts, most of which
end), launches (with friction), whirrs (with losses), calls (single calls). `--docs` writes the results into
docs/benchmarks.md, README.md and the figure. With `--only` the results of the other jobs are those of their
last run, which target/peers.json keeps, so that `--only` without a name writes everything again and measures
nothing. `--quick`: small jobs, to see that everything works. `--also`: other interpreters whose numba takes
part in the maps (one with Intel's SVML: numba 0.61.2 and intel-cmplr-lib-rt). Times are the least of rounds
that alternate the contestants; those of motions on one thread are its CPU time. `--narrow`: this run is of a
build with lanes of AVX2 alone (`SPINCYL_COMPILED_LANES=one pip wheel .`); its times and ratios are kept in
target/peers-narrow.json and get columns of their own. The peers keep AVX-512.
"""

import argparse
import json
import pathlib
import re
import sys
import time

sys.path.insert(1, str(pathlib.Path(__file__).parents[1]))  # after this folder, for maps.py
import calls
import endings
import maps
import motions
import scripts
from clock import has, table
from figure import draw

ROOT = pathlib.Path(__file__).parents[2]
JOBS = {
    "maps": maps.measure,
    "motions": motions.measure,
    "endings": endings.measure,
    "launches": scripts.launches,
    "whirrs": scripts.whirrs,
    "calls": calls.measure,
}
KEPT, NARROW = ROOT / "target" / "peers.json", ROOT / "target" / "peers-narrow.json"
HEAD = (
    "job",
    "largest error allowed",
    "time in spincyl",
    "time in spincyl without AVX-512",
    "time in the fastest other program",
    "fastest other program",
    "time in that program over time in spincyl",
    "the same ratio without AVX-512",
)
# the rows in the README: the best case, the general one, and slips and losses, whoever is faster
QUOTED = (
    ("small nutation", 1e-6),
    ("small nutation", 1e-12),
    ("very wide", 1e-12),
    ("random initial states", 1e-6),
    ("random initial states", 1e-10),
    ("launches", 1e-8),
    ("coins that whirr", 1e-8),
    ("a single motion", 1e-6),
)


def put(path, name, text):
    """Writes a section between its markers."""
    begin, end = f"<!-- written by benches/peers/main.py: {name} -->\n", f"<!-- end of {name} -->\n"
    old = path.read_text("utf-8")
    if begin not in old:
        sys.exit(f"{path} has no place for {name}: {begin!r}")
    new = begin + "\n" + text.strip() + "\n\n" + end
    path.write_text(
        re.sub(re.escape(begin) + ".*?" + re.escape(end), lambda _: new, old, flags=re.S), "utf-8"
    )


def rows(found):
    """The rows of all jobs, with the time and the ratio of a build with AVX2 alone where that was
    measured."""
    kept = json.loads(NARROW.read_text()) if NARROW.exists() else {}
    narrow = {(row[0], row[1]): row for told in kept.values() for row in told["best"]}
    found = [row for told in found.values() for row in told["best"]]
    worth = {(job, off): (row[2], row[-1]) for (job, off), row in narrow.items()}
    told = [worth.get((row[0], row[1]), ("", "")) for row in found]
    return [
        (job, off, ours, less[0], *peer, ratio, less[1])
        for (job, off, ours, *peer, ratio), less in zip(found, told, strict=True)
    ]


def write(found):
    """Writes the pages and the figure."""
    docs = ROOT / "docs" / "benchmarks.md"
    for name, told in found.items():
        put(docs, name, told["text"])
    best = rows(found)
    put(docs, "ratios", table(HEAD, best))
    quoted = [row for row in best if any(row[0].startswith(job) and row[1] == off for job, off in QUOTED)]
    put(ROOT / "README.md", "ratios", table(HEAD, quoted))
    draw(docs.read_text("utf-8"))


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--docs", action="store_true")
    parser.add_argument("--only", nargs="*", choices=JOBS, metavar="JOB")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--also", nargs="*", default=[], metavar="PYTHON")
    parser.add_argument("--narrow", action="store_true")
    args = parser.parse_args()
    if not has("heyoka"):
        sys.exit("the reference of all errors needs heyoka: pip install heyoka")
    keeper = NARROW if args.narrow else KEPT
    kept = json.loads(keeper.read_text()) if keeper.exists() and args.only is not None else {}
    for name in JOBS if args.only is None else args.only:
        began = time.perf_counter()
        how = {"also": args.also} if name == "maps" else {}
        told = JOBS[name](args.quick, **how)
        if told is None:
            print(f"\n{name}: there is no script that measures them")
            continue
        # in the form in which the next run reads it
        kept[name] = json.loads(json.dumps(told))
        print(f"\n## {name}, measured in {time.perf_counter() - began:.0f} s\n\n{told['text']}", flush=True)
        keeper.parent.mkdir(exist_ok=True)
        keeper.write_text(json.dumps(kept))
    found = {name: kept[name] for name in JOBS if name in kept}
    print("\n" + table(HEAD, rows(found)))
    if args.docs and not args.narrow:
        write(found)


if __name__ == "__main__":
    main()
