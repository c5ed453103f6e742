"""Every property of the Rust tests with cases that nobody has drawn before.

    python3 tests/fresh.py --runs 10        prints the seed of each run; one that fails ends it, with its seed

Builds the tests once, optimised. `PROPTEST_RNG_SEED=N cargo test --release` draws the cases of seed N again.
"""

import argparse
import json
import os
import secrets
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
#: The files that have properties.
FILES = sorted(
    path.relative_to(ROOT / "tests").parts[0].removesuffix(".rs")
    for path in (ROOT / "tests").rglob("*.rs")
    if "proptest!" in path.read_text("utf-8") and path.parent.name != "common"
)


def built():
    """The tests as programs."""
    words = ["cargo", "test", "--quiet", "--release", "--no-run", "--message-format=json"]
    for name in dict.fromkeys(FILES):
        words += ["--test", name]
    lines = subprocess.run(words, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    return [found["executable"] for found in map(json.loads, lines) if found.get("executable")]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--seed", type=int, default=None, help="of the first run; a fresh one by default")
    given = parser.parse_args()
    programs = built()
    for run in range(given.runs):
        seed = given.seed + run if given.seed is not None else secrets.randbits(63)
        since = time.perf_counter()
        for program in programs:
            env = os.environ | {"PROPTEST_RNG_SEED": str(seed), "CARGO_MANIFEST_DIR": str(ROOT)}
            made = subprocess.run([program, "--quiet"], cwd=ROOT, env=env, capture_output=True, text=True)
            if made.returncode:
                sys.exit(f"{made.stdout}\n{Path(program).name} fails: PROPTEST_RNG_SEED={seed}")
        print(f"run {run + 1}: seed {seed}, {time.perf_counter() - since:.1f} s", flush=True)


if __name__ == "__main__":
    main()
