"""Cost of compiling: wall time, CPU time, and the memory of the largest compiler process.

Compiles the wheel, and new programs in empty folders that use the crate, each from nothing, with its
dependencies. Needs cargo, and maturin for the wheel; ten minutes in all.
usage: python benches/compile.py
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parents[1]
NO_NOALIAS = "-C llvm-args=-enable-noalias-to-md-conversion=false"
#: Options of `cargo add`, options of `cargo build`, and additions to the environment.
WAYS = {
    "release": ([], ["--release"], {}),
    "release, without noalias": ([], ["--release"], {"RUSTFLAGS": NO_NOALIAS}),
    "unoptimised": ([], [], {}),
    "unoptimised, with lanes": ([], [], {"SPINCYL_COMPILED_LANES": "all"}),
    "unoptimised, without what is many at once": (["--no-default-features"], [], {}),
}


def clean(**more):
    """The environment without the variables that would change a build, and with `more`."""
    return {
        k: v
        for k, v in os.environ.items()
        if k not in ("RUSTFLAGS", "CARGO_TARGET_DIR", "SPINCYL_COMPILED_LANES")
    } | more


def told(name, words, **how):
    """Runs a command; prints its wall time, its CPU time, and the memory of the largest process in it."""
    began = time.perf_counter()
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, **how)
    _, code, used = os.wait4(process.pid, 0)
    if code:
        raise RuntimeError(f"{' '.join(words)} ended with {code}")
    seconds, busy = time.perf_counter() - began, used.ru_utime + used.ru_stime
    print(
        f"{name:46} {seconds:5.0f} s, {busy:5.0f} s of processor, {used.ru_maxrss / 1e6:5.2f} GB", flush=True
    )


def program(folder, added):
    """An empty program that uses the crate."""
    app = Path(folder) / "app"
    for words in (
        ["init", "--quiet", "--vcs", "none", str(app)],
        ["add", "--quiet", "--manifest-path", str(app / "Cargo.toml"), *added, "--path", str(ROOT)],
        ["fetch", "--quiet", "--manifest-path", str(app / "Cargo.toml")],
    ):
        subprocess.run(["cargo", *words], env=clean(), check=True)
    return app


def main():
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    with tempfile.TemporaryDirectory() as folder:
        words = [sys.executable, "-m", "maturin", "build", "--quiet", "--release", "--out", folder]
        told("the wheel", words, cwd=ROOT, env=clean(CARGO_TARGET_DIR=f"{folder}/target"))
        (wheel,) = Path(folder).glob("*.whl")
        print(f"{'':46} {wheel.stat().st_size / 1e6:.1f} MB")
    for name, (added, how, more) in WAYS.items():
        with tempfile.TemporaryDirectory() as folder:
            app = program(folder, added)
            told(name, ["cargo", "build", "--quiet", *how], cwd=app, env=clean(**more))


if __name__ == "__main__":
    main()
