"""What it takes to compile a Rust program that uses the crate: seconds by the clock, and the memory of the largest compiler.

A new program in an empty folder, from nothing, dependencies included; ten minutes in all. Needs cargo.
usage: python benches/compile.py
"""

import argparse
import os
import subprocess
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
QUIET = "\n[profile.dev.package.spincyl]\ndebug = false\n"
#: What is asked of cargo: how the crate is added, how the program is built, and what its Cargo.toml says besides.
WAYS = {
    "release": ([], ["--release"], ""),
    "unoptimised": ([], [], ""),
    "the same, the crate without debug information": ([], [], QUIET),
    "the same, without what is many at once": (["--no-default-features"], [], ""),
}


def built(folder, added, how, more):
    """Seconds, and GB of the compiler that took most."""
    cargo = {k: v for k, v in os.environ.items() if k not in ("RUSTFLAGS", "CARGO_TARGET_DIR")}
    app = Path(folder) / "app"
    for words in (
        ["init", "--quiet", "--vcs", "none", str(app)],
        ["add", "--quiet", "--manifest-path", str(app / "Cargo.toml"), *added, "--path", str(ROOT)],
    ):
        subprocess.run(["cargo", *words], env=cargo, check=True)
    with (app / "Cargo.toml").open("a") as file:
        file.write(more)
    began = time.perf_counter()
    process = subprocess.Popen(["cargo", "build", "--quiet", *how], cwd=app, env=cargo)
    # of the process and of all that it waited for
    _, code, used = os.wait4(process.pid, 0)
    if code:
        raise RuntimeError(f"cargo build ended with {code}")
    return time.perf_counter() - began, used.ru_maxrss / 1e6


def main():
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    for name, way in WAYS.items():
        with tempfile.TemporaryDirectory() as folder:
            seconds, memory = built(folder, *way)
        print(f"{name:46} {seconds:5.0f} s, {memory:5.2f} GB", flush=True)


if __name__ == "__main__":
    main()
