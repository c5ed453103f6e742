"""Every threshold of docs/thresholds.md, halved and doubled: which of 2,800 motions change, and by how much.

    python3 tests/thresholds.py            about 20 minutes, on one core
    python3 tests/thresholds.py --write    the same, and writes the measured columns of the page
    python3 tests/thresholds.py --only FLAT GRACE
    python3 tests/thresholds.py --scene 177 906

Needs Rust and nothing else. A copy of the crate is made in a temporary folder, in which every threshold of the page
becomes a number that is multiplied by a factor when the program starts. One build then serves all factors. With the
factor 1 the program has to give the same bits as the unchanged crate, which is also built.

The scenes are those of `benches/thresholds.rs`. The result of a scene has the ending of the motion and its time, the
number of phases, the last numbers, and the estimated error. Two results agree if the motions have the same ending, and
their times and numbers differ by no more than the sum of both estimated errors. A motion computed to the last requested
time may have an ending just there. If an estimated error is infinite, any two results agree.

    motions change                      any bit of the result differs
    of the estimated errors             largest difference, in units of the sum of both estimated errors
    by more than the estimated errors   how many differ by more than this sum, and the largest difference
    have another number of phases       how many have more or fewer phases
    have another ending                 how many have another ending
    have no estimated error any more    how many have an infinite estimated error now, and did not before

The command names every scene with another ending or beyond the estimated errors. It fails if there are more of them than
on the page. The last two columns have the numbers of motions that change if the threshold is divided and multiplied by 1000: they
show whether any scene comes near the threshold.
"""

import argparse
import collections
import csv
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "thresholds.md"
#: constants in the files of the page that decide no event, with the reason
LEFT_OUT = ROOT / "tests" / "left_out.csv"
PROGRAM = ROOT / "benches" / "thresholds.rs"
SCENES = 2800
FACTORS = {"halved": 0.5, "doubled": 2.0}
FAR = (1e-3, 1e3)
#: seconds after which a factor of 1000 is given up: a limit of the work, say
LONGEST = 150

TYPES = {"f64", "f32", "u8", "u32", "u64", "usize", "i32"}
CONSTANT = re.compile(r"^( *)((?:pub(?:\([a-z]+\))? )?)const (\w+): (\w+) = ([^;]+);", re.M)
IMPORT = re.compile(r"^ *(?:pub(?:\([a-z]+\))? )?use [^;]*;", re.M)


class Threshold(NamedTuple):
    """A row of the page."""

    name: str
    file: str
    value: str
    told: tuple[str, ...]  # the measured cells


class Result(NamedTuple):
    """How a motion ends."""

    ending: str
    time: float
    phases: int
    error: float
    numbers: tuple[float, ...]

    @classmethod
    def of(cls, line):
        ending, time, phases, error, *numbers = line.split()
        return cls(ending, float(time), int(phases), float(error), tuple(map(float, numbers)))


# The page and the constants of the source.


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def thresholds(page):
    """The rows with seven columns or more: name, file, value, compared with, decides, and what was measured."""
    rows = [cells(line) for line in page.splitlines() if line.startswith("| `")]
    return [Threshold(*(x.strip("`") for x in row[:3]), tuple(row[5:])) for row in rows if len(row) > 5]


def left_out():
    """File and name of each constant that the page leaves out."""
    with LEFT_OUT.open(encoding="utf-8", newline="") as file:
        return [(row["file"], name) for row in csv.DictReader(file) for name in row["constants"].split(", ")]


def constants(text):
    """The numeric constants of a file of source: name to value. Places among the numbers of a type are none."""
    all_of_them = CONSTANT.findall(text)
    return {
        name: value
        for spaces, _, name, kind, value in all_of_them
        if kind in TYPES and not (spaces and kind == "usize")
    }


# The copy of the crate.


def called(text, name):
    """The code with each use of a constant turned into a call; comments and imports are left as they are."""
    kept = [range(*found.span()) for found in IMPORT.finditer(text)]
    kept += [range(*found.span()) for found in re.finditer(r"//[^\n]*|\bfn \w+", text)]

    def call(found):
        return found[0] + ("" if any(found.start() in span for span in kept) else "()")

    return re.sub(rf"\b{name}\b", call, text)


def takes(text, file, name, path):
    """Whether the file `path` imports a constant of `file`."""
    there = Path(file)
    module = there.parent if there.name == "mod.rs" else there.with_suffix("")
    stems = {module.name, module.parent.name} | ({"super"} if Path(path).parent == module else set())
    for statement in IMPORT.findall(text):
        words = re.findall(r"\w+", statement)
        if name in words and stems & set(words):
            return True
    return False


def changed(sources, all_of_them):
    """The sources, from their paths, in which each threshold k is a function of the factor that the program is given."""
    sources = dict(sources)
    for k, (name, file, value, _) in enumerate(all_of_them):
        for path in [path for path in sources if path == file or takes(sources[path], file, name, path)]:
            text = sources[path]
            if path == file:
                spaces, public, _, kind, _ = next(x for x in CONSTANT.findall(text) if x[2] == name)
                number = "" if kind == "f64" else f".round() as {kind}"
                body = f"{{ crate::changed({k}, ({value}) as f64){number} }}"
                new = f"{spaces}{public}fn {name}() -> {kind} {body}"
                text = re.sub(rf"^ *(?:pub(?:\([a-z]+\))? )?const {name}: [^;]*;", new, text, flags=re.M)
            sources[path] = called(text, name)
    return sources


CHANGED = """
/// A threshold, times the factor that the program is given for it.
#[inline]
pub(crate) fn changed(k: usize, value: f64) -> f64 {
    static GIVEN: std::sync::OnceLock<(usize, f64)> = std::sync::OnceLock::new();
    let given = GIVEN.get_or_init(|| {
        let words = std::env::var("SPINCYL_THRESHOLD").unwrap_or_default();
        words.split_once(' ').map_or((usize::MAX, 1.0), |(k, x)| (k.parse().unwrap(), x.parse().unwrap()))
    });
    if k == given.0 { value * given.1 } else { value }
}
"""

MANIFEST = """
[package]
name = "thresholds"
edition = "2024"
[dependencies]
spincyl = { path = "../spincyl", default-features = false }
[profile.dev]
debug = 0
opt-level = 2
codegen-units = 1
overflow-checks = false
debug-assertions = false
[workspace]
"""


def built(folder, sources, more=""):
    """The program on a crate with these sources."""
    crate, program = folder / "spincyl", folder / "program"
    for path, text in sources.items():
        (crate / path).parent.mkdir(parents=True, exist_ok=True)
        (crate / path).write_text(text + (more if path == "src/lib.rs" else ""), "utf-8")
    (crate / "docs").mkdir()
    shutil.copy(ROOT / "docs" / "rust.md", crate / "docs")
    shutil.copy(ROOT / "build.rs", crate)
    manifest = (ROOT / "Cargo.toml").read_text("utf-8")
    manifest = re.sub(r"^(readme|members) = .*\n", "", manifest, flags=re.M)
    (crate / "Cargo.toml").write_text(re.sub(r"\[workspace\]\n", "", manifest), "utf-8")
    (program / "src").mkdir(parents=True)
    (program / "Cargo.toml").write_text(MANIFEST, "utf-8")
    shutil.copy(PROGRAM, program / "src" / "main.rs")
    env = os.environ | {
        "SPINCYL_COMPILED_LANES": "none",
        "RUSTFLAGS": "-C llvm-args=-enable-noalias-to-md-conversion=false --cap-lints allow",
        "CARGO_INCREMENTAL": "0",
        "CARGO_TARGET_DIR": str(ROOT / "target" / "thresholds"),
    }
    subprocess.run(["cargo", "build", "--quiet", "-j1"], cwd=program, env=env, check=True)
    kept = folder / "thresholds"
    shutil.copy(ROOT / "target" / "thresholds" / "debug" / "thresholds", kept)
    return kept


def results(program, scenes, given="", longest=None):
    """The results of all scenes with a factor for one threshold; a word if there are none."""
    env = os.environ | {"SPINCYL_THRESHOLD": given}
    run = [program, "follow"]
    try:
        made = subprocess.run(
            run,
            input=scenes,
            env=env,
            text=True,
            timeout=longest,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
    except subprocess.TimeoutExpired:
        return "too long"
    if made.returncode:
        return "fails"
    return [Result.of(line) for line in made.stdout.splitlines()]


# What has changed.


class Change(NamedTuple):
    """A motion before and after."""

    moves: bool
    off: float  # the largest difference of a time or a number
    ratio: float  # the same in units of the sum of both estimated errors
    otherwise: bool
    phases: bool
    lost: bool


def change(a, b):
    same = repr(a) == repr(b)
    both = a.error + b.error
    known = math.isfinite(both)
    at_the_end = "Done" in (a.ending, b.ending) and abs(a.time - b.time) <= both
    otherwise = known and a.ending != b.ending and not at_the_end
    off = 0.0
    if not same and known and a.ending == b.ending:
        off = max(abs(x - y) for x, y in zip((a.time, *a.numbers), (b.time, *b.numbers), strict=True))
    ratio = off / max(both, 1e-300)
    lost = math.isfinite(a.error) and not math.isfinite(b.error)
    return Change(not same, off, ratio, otherwise, a.phases != b.phases, lost)


def said(changes):
    """A cell of the page."""
    moved = [x for x in changes if x.moves]
    if not moved:
        return "no motion changes"
    beyond, most = [x.off for x in moved if x.ratio > 1], max(x.ratio for x in moved)
    words = ["1 motion changes" if len(moved) == 1 else f"{len(moved)} motions change"]
    if beyond:
        words.append(f"{len(beyond)} by more than the estimated errors, at most by {max(beyond):.0e}")
    elif most:
        words.append(f"at most by {most:.1g} of the estimated errors")
    for count, what in (
        (sum(x.phases for x in moved), "another number of phases"),
        (sum(x.otherwise for x in moved), "another ending"),
        (sum(x.lost for x in moved), "no estimated error any more"),
    ):
        if count:
            words.append(f"{count} {'has' if count == 1 else 'have'} {what}")
    return "; ".join(words)


def allowed(cell):
    """Numbers of motions in a cell: beyond the estimated errors, with another ending, without an estimated error."""
    names = (
        "by more than the estimated errors",
        "ha(?:s|ve) another ending",
        "ha(?:s|ve) no estimated error",
    )
    return [sum(int(x) for x in re.findall(rf"(\d+) {name}", cell)) for name in names]


def written(page, found):
    """The page with the measured cells."""
    lines = page.splitlines()
    for i, line in enumerate(lines):
        row = cells(line)
        if (
            line.startswith("| `")
            and len(row) > 5
            and (key := (row[0].strip("`"), row[1].strip("`"))) in found
        ):
            lines[i] = "| " + " | ".join([*row[:5], *found[key]]) + " |"
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", default=[], help="names of thresholds")
    parser.add_argument("--write", action="store_true", help="write the measured columns of the page")
    parser.add_argument(
        "--scene", nargs="+", type=int, help="show these scenes and their results, and nothing else"
    )
    given = parser.parse_args()
    page = PAGE.read_text("utf-8")
    rows = thresholds(page)
    sources = {str(path.relative_to(ROOT)): path.read_text("utf-8") for path in (ROOT / "src").rglob("*.rs")}
    with tempfile.TemporaryDirectory() as folder:
        before, after = Path(folder) / "before", Path(folder) / "after"
        plain = built(before, sources)
        scenes = subprocess.run(
            [plain, "draw", str(SCENES)], check=True, stdout=subprocess.PIPE, text=True
        ).stdout
        lines = scenes.splitlines()
        base = results(plain, scenes)
        if given.scene:
            for i in given.scene:
                print(i, lines[i], *base[i], sep="\n  ")
            return 0
        program = built(after, changed(sources, rows), CHANGED)
        if results(program, scenes) != base and repr(results(program, scenes)) != repr(base):
            sys.exit("the copy of the crate gives other results than the crate")
        endings = collections.Counter(x.ending for x in base)
        unknown = sum(not math.isfinite(x.error) for x in base)
        print(
            f"{SCENES} scenes, {unknown} without an estimated error:",
            ", ".join(f"{n} {x}" for x, n in endings.most_common()),
        )
        failed = False
        found = {}
        for k, row in enumerate(rows):
            if given.only and row.name not in given.only:
                continue
            new = []
            for name, factor in FACTORS.items():
                then = results(program, scenes, f"{k} {factor!r}")
                if isinstance(then, str):
                    sys.exit(f"{row.name} {name}: {then}")
                changes = [change(a, b) for a, b in zip(base, then, strict=True)]
                new.append(said(changes))
                print(f"{row.name} ({row.file}) {name}: {new[-1]}", flush=True)
                for i, x in enumerate(changes):
                    if x.otherwise or x.ratio > 1 or x.lost:
                        a, b = base[i], then[i]
                        print(
                            f"  scene {i} ({lines[i].split()[0]}): {a.ending} {a.time!r} in {a.phases} phases,",
                            end="",
                        )
                        print(
                            f" {a.error:.1e} -> {b.ending} {b.time!r} in {b.phases}, {b.error:.1e}; {x.ratio:.2g}"
                        )
                told = row.told[len(new) - 1] if len(row.told) >= len(new) else ""
                failed |= any(x > y for x, y in zip(allowed(new[-1]), allowed(told), strict=True))
            far = []
            for factor in FAR:
                then = results(program, scenes, f"{k} {factor!r}", LONGEST)
                some = isinstance(then, list)
                far.append(
                    str(sum(repr(a) != repr(b) for a, b in zip(base, then, strict=True))) if some else then
                )
            new += far
            print(f"  by 1000: {', '.join(far)}", flush=True)
            found[row.name, row.file] = new
            if given.write:
                PAGE.write_text(written(PAGE.read_text("utf-8"), found), "utf-8")
    if failed and not given.write:
        print("more motions than on the page have another ending or lie beyond their estimated errors")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
