"""Run every property of the Rust tests with new random cases.

    python3 tests/fresh.py --runs 10        prints the seed of each run, and finally the failures

Builds the tests once, optimised. `PROPTEST_RNG_SEED=N cargo test --release --test laws` draws the cases of seed N again.
"""

import argparse
import json
import os
import re
import secrets
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
LAWS = ROOT / "tests" / "laws"


def built():
    """The tests as an executable."""
    words = ["cargo", "test", "--quiet", "--release", "--no-run", "--message-format=json", "--test", "laws"]
    lines = subprocess.run(words, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    return next(found["executable"] for found in map(json.loads, lines) if found.get("executable"))


def properties():
    """The names of the property tests."""
    for path in sorted(LAWS.rglob("*.rs")):
        module = "::".join(path.relative_to(LAWS).with_suffix("").parts)
        for block in re.findall(r"^proptest! \{\n.*?^\}$", path.read_text("utf-8"), re.M | re.S):
            yield from (f"{module}::{name}" for name in re.findall(r"#\[test\]\n +fn (\w+)\(", block))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--seed", type=int, default=None, help="of the first run; a fresh one by default")
    given = parser.parse_args()
    program, names = built(), list(properties())
    print(len(names), "properties")
    failed = []
    for run in range(given.runs):
        seed = given.seed + run if given.seed is not None else secrets.randbits(63)
        since = time.perf_counter()
        env = os.environ | {"PROPTEST_RNG_SEED": str(seed), "CARGO_MANIFEST_DIR": str(ROOT)}
        made = subprocess.run(
            [program, "--quiet", "--exact", *names], cwd=ROOT, env=env, capture_output=True, text=True
        )
        said = ""
        if made.returncode or f" {len(names)} passed" not in made.stdout:
            failed.append(seed)
            said = f", FAILED\n{made.stdout}"
        print(f"run {run + 1}: seed {seed}, {time.perf_counter() - since:.1f} s{said}", flush=True)
    print(f"{given.runs - len(failed)} of {given.runs} runs passed")
    sys.exit(" ".join(f"PROPTEST_RNG_SEED={seed}" for seed in failed) or None)


if __name__ == "__main__":
    main()
