"""Planted errors: how many of them the Rust tests catch, and which survive.

Draws places in the physics of `src` at random, plants one error in each (a sign, a comparison, a product for a quotient, a
condition), and builds a copy of the crate once with all of them, each switched off. Every test is run once to see which
places it reaches. Then each error is switched on alone, and the tests that reach it are run, the quickest first, until one
fails. Prints those that no test catches, and how many no test reaches. Survivors may be caught by the Python tests,
or be harmless: a first guess of an iteration, say. Needs `pip install --group mutants`; a quarter of an hour.
usage: python benches/mutants.py [--count 200] [--seed 1] [--folder target/mutants]
"""

import argparse
import json
import os
import random
import re
import shutil
import subprocess
import sys
import time
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import tree_sitter
import tree_sitter_rust

ROOT = Path(__file__).parents[1]
ROOMS = sorted(p.name for p in (ROOT / "src").iterdir() if p.is_dir() and p.name != "python")
PARSER = tree_sitter.Parser(tree_sitter.Language(tree_sitter_rust.language()))
OPPOSITE = {
    "+": "-", "-": "+", "*": "/", "/": "*", "<": ">=", ">=": "<", ">": "<=", "<=": ">",
    "==": "!=", "!=": "==", "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=",
}  # fmt: skip
#: What is computed while compiling, and what is read only there.
FIXED = (
    "const_item",
    "static_item",
    "array_type",
    "attribute_item",
    "macro_invocation",
    "macro_definition",
    "match_pattern",
    "enum_variant",
)
SWITCH = """
//! Which planted error is switched on.
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
static CHOSEN: OnceLock<(i64, Option<std::ffi::OsString>)> = OnceLock::new();
static REACHED: [AtomicBool; COUNT] = [const { AtomicBool::new(false) }; COUNT];
/// Whether the error of this number is switched on.
#[inline(never)]
pub fn on(k: usize) -> bool {
    let (chosen, log) = CHOSEN.get_or_init(|| {
        let number = std::env::var("SPINCYL_MUTANT").ok().and_then(|x| x.parse().ok()).unwrap_or(-1);
        (number, std::env::var_os("SPINCYL_REACHED"))
    });
    if let Some(log) = log && !REACHED[k].swap(true, Ordering::Relaxed) {
        use std::io::Write;
        let mut file = std::fs::OpenOptions::new().append(true).create(true).open(log).unwrap();
        file.write_all(format!("{k}\\n").as_bytes()).unwrap();
    }
    *chosen == k as i64
}
"""


def places(path):
    """(first byte, last byte, planted text, what was changed) of every error that could be planted in a file."""
    source = path.read_bytes()

    def text(node):
        return source[node.start_byte : node.end_byte].decode()

    def visit(node):
        if node.type in FIXED or (node.type == "function_item" and "const fn" in text(node)[:80]):
            return
        if node.type == "mod_item" and "test" in text(node)[:40]:
            return
        if node.type in ("binary_expression", "compound_assignment_expr"):
            sign = text(node.child_by_field_name("operator"))
            sides = text(node.child_by_field_name("left")), text(node.child_by_field_name("right"))
            if sign in OPPOSITE and "let " not in text(node):
                yield node, f"{sides[0]} {OPPOSITE[sign]} {sides[1]}", f"{sign} becomes {OPPOSITE[sign]}"
        elif node.type == "unary_expression" and text(node)[0] in "-!":
            if node.children[1].type not in ("integer_literal", "float_literal"):
                yield node, text(node.children[1]), f"{text(node)[0]} is left out"
        elif node.type == "call_expression":
            what, given = node.child_by_field_name("function"), node.child_by_field_name("arguments")
            if what.type == "field_expression":
                of, name = text(what.child_by_field_name("value")), text(what.child_by_field_name("field"))
                args = [text(x) for x in given.named_children]
                if name == "select_lt" and len(args) == 3:
                    yield (
                        node,
                        f"{of}.select_lt({args[0]}, {args[2]}, {args[1]})",
                        "the choices are exchanged",
                    )
                elif name in ("sin", "cos") and not args:
                    other = "cos" if name == "sin" else "sin"
                    yield node, f"{of}.{other}()", f"{name} becomes {other}"
        for child in node.children:
            yield from visit(child)

    return [
        (n.start_byte, n.end_byte, planted, what)
        for n, planted, what in visit(PARSER.parse(source).root_node)
    ]


def drawn(folder, count, seed):
    """Random places, none of them inside another."""
    files = sorted(p for room in ROOMS for p in (folder / "src" / room).rglob("*.rs") if "test" not in p.stem)
    every = [(p, *place) for p in files for place in places(p)]
    random.Random(seed).shuffle(every)
    taken = defaultdict(list)
    for path, first, last, planted, what in every:
        # a comment inside would reach to the end of the one line that is written
        apart = all(last <= a or first >= b for a, b, *_ in taken[path])
        if count and apart and "//" not in planted:
            taken[path].append((first, last, planted, what))
            count -= 1
    print(f"{len(every)} places in {len(files)} files", flush=True)
    return taken


def plant(folder, taken):
    """Writes the errors into the copy; (file, line, what) of each by its number."""
    told = []
    for path in sorted(taken):
        source, parts, end = path.read_bytes(), [], 0
        for first, last, planted, what in sorted(taken[path]):
            line = source[:first].count(b"\n") + 1
            as_it_was = source[first:last].decode()
            code = f"(if crate::mutant::on({len(told)}) {{ {planted} }} else {{ {as_it_was} }})"
            told.append((str(path.relative_to(folder)), line, what, " ".join(as_it_was.split())))
            parts += [source[end:first], code.replace("\n", " ").encode()]
            end = last
        path.write_bytes(b"".join([*parts, source[end:]]))
    return told


def refused(output):
    """(file, line) of each error of the compiler."""
    found = set()
    for line in output.splitlines():
        message = json.loads(line).get("message", {}) if line.startswith("{") else {}
        if isinstance(message, dict) and message.get("level") == "error":
            # where a macro of the crate is used, the place of the macro does not help
            found |= {(s["file_name"], s["line_start"]) for s in message["spans"]}
    return found


ENVIRONMENT = os.environ | {
    "CARGO_INCREMENTAL": "0",
    "SPINCYL_COMPILED_LANES": "one",
    "RUSTFLAGS": "-C llvm-args=-enable-noalias-to-md-conversion=false --cap-lints allow",
}


def built(folder, taken):
    """Plants and compiles until the compiler refuses none; what was planted, and the programs of the tests."""
    clean = {path: path.read_bytes() for path in taken}
    root = folder / "src" / "lib.rs"
    root.write_text(root.read_text().replace("\nmod ", "\n#[allow(missing_docs)]\npub mod mutant;\nmod ", 1))
    words = ["cargo", "test", "--no-run", "--lib", "--test", "laws", "--message-format", "json"]
    while True:
        for path, source in clean.items():
            path.write_bytes(source)
        told = plant(folder, taken)
        (folder / "src" / "mutant.rs").write_text(SWITCH.replace("COUNT", str(len(told))))
        done = subprocess.run(words, cwd=folder, env=ENVIRONMENT, capture_output=True, text=True)
        if not done.returncode:
            lines = [json.loads(x) for x in done.stdout.splitlines() if x.startswith("{")]
            return told, [x["executable"] for x in lines if x.get("executable")]
        wrong = refused(done.stdout)
        before = sum(map(len, taken.values()))
        for path in taken:
            name, source = str(path.relative_to(folder)), clean[path]
            taken[path] = [
                p for p in taken[path]
                if not any(
                    f == name and source[: p[0]].count(b"\n") + 1 <= line <= source[: p[1]].count(b"\n") + 1
                    for f, line in wrong
                )
            ]  # fmt: skip
        left = sum(map(len, taken.values()))
        print(f"the compiler refuses {before - left}", flush=True)
        if left == before:
            sys.exit(done.stderr[-3000:] + "\n".join(map(str, wrong)))


def ran(words, number, log=None, limit=None, cwd=None):
    """Whether a command fails with an error switched on, and its seconds."""
    more = {"SPINCYL_MUTANT": str(number)} | ({"SPINCYL_REACHED": str(log)} if log else {})
    began = time.perf_counter()
    try:
        done = subprocess.run(
            words,
            env=ENVIRONMENT | more,
            cwd=cwd,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            timeout=limit,
        )
        return done.returncode != 0, time.perf_counter() - began
    except subprocess.TimeoutExpired:
        return True, time.perf_counter() - began


def reached(programs, folder):
    """{number: [(seconds, program, test), ...]} of the tests that reach each error, the quickest first."""
    by = defaultdict(list)

    def one(job):
        k, program, test = job
        log = folder / f"reached-{k}"
        failed, seconds = ran([program, "--exact", test], -1, log, cwd=folder)
        if failed:
            print(f"fails as it is: {test}", flush=True)
            return
        for number in map(int, log.read_text().split()) if log.exists() else ():
            by[number].append((seconds, program, test))

    jobs = []
    for program in programs:
        said = subprocess.run(
            [program, "--list"], capture_output=True, text=True, check=True, cwd=folder
        ).stdout
        jobs += [(len(jobs) + i, program, t) for i, t in enumerate(re.findall(r"^(\S+): test$", said, re.M))]
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        list(threads.map(one, jobs))
    return {number: sorted(tests) for number, tests in by.items()}


def caught(number, tests, folder):
    """The tests among which one fails, or None."""
    first = 0
    for size in (6, 30, len(tests)):
        for program in sorted({p for _, p, _ in tests[first : first + size]}):
            these = [t for t in tests[first : first + size] if t[1] == program]
            limit = 30 + 20 * sum(t[0] for t in these)
            if ran([program, "--exact", *(t[2] for t in these)], number, limit=limit, cwd=folder)[0]:
                return [t[2] for t in these]
        first += size
    return None


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, default=ROOT / "target" / "mutants")
    asked = parser.parse_args()
    folder = asked.folder.resolve()
    shutil.rmtree(folder, ignore_errors=True)
    named = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout
    for name in named.split("\0")[:-1]:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    told, programs = built(folder, drawn(folder, asked.count, asked.seed))
    print(f"{len(told)} planted", flush=True)
    by = reached(programs, folder)
    alive = []

    def one(number):
        if number in by and caught(number, by[number], folder):
            return
        alive.append(number)
        file, line, what, was = told[number]
        tests = f"{len(by[number])} tests reach it" if number in by else "no test reaches it"
        print(f"lives: {file}:{line}: {what} in `{was}` ({tests}) [{number}]", flush=True)

    with ThreadPoolExecutor(os.cpu_count()) as threads:
        list(threads.map(one, range(len(told))))
    out = sum(number not in by for number in alive)
    print(
        f"{len(told)} planted, {len(told) - len(alive)} caught, {len(alive)} live, {out} of them not reached"
    )


if __name__ == "__main__":
    main()
