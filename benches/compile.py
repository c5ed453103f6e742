"""Cost of compiling: wall time, CPU time, and the memory of the largest compiler process.

Compiles the wheel, and new programs in empty folders that use the crate, each from nothing, with its
dependencies. Each time of the processor stands beside a yardstick that any machine has: a release build of nalgebra
alone, compiled twice before the others (the smaller is taken) and once after them. Needs cargo, and maturin for the
wheel; ten minutes.
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
YARDSTICK = ["nalgebra@=0.35.0", "--no-default-features", "--features", "std"]
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


def took(words, **how):
    """Runs a command; gives its wall time, its CPU time, and the gigabytes of the largest process in it."""
    began = time.perf_counter()
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL, **how)
    _, code, used = os.wait4(process.pid, 0)
    if code:
        raise RuntimeError(f"{' '.join(words)} ended with {code}")
    seconds, busy = time.perf_counter() - began, used.ru_utime + used.ru_stime
    return seconds, busy, used.ru_maxrss / 1e6


def told(name, times, yard):
    """Prints what a command took, its CPU time also in units of the yardstick's."""
    seconds, busy, memory = times
    print(
        f"{name:46} {seconds:5.0f} s, {busy:5.0f} s of processor = {busy / yard:5.2f} yardsticks, {memory:5.2f} GB",
        flush=True,
    )


def built(added, how, more):
    """What a program that uses something took to build."""
    with tempfile.TemporaryDirectory() as folder:
        return took(["cargo", "build", "--quiet", *how], cwd=program(folder, added), env=clean(**more))


def yardstick():
    """A release build of nalgebra alone, of one version and with one set of features."""
    return built(YARDSTICK, ["--release"], {})


def program(folder, added):
    """An empty program with what `cargo add` is told to add."""
    app = Path(folder) / "app"
    for words in (
        ["init", "--quiet", "--vcs", "none", str(app)],
        ["add", "--quiet", "--manifest-path", str(app / "Cargo.toml"), *added],
        ["fetch", "--quiet", "--manifest-path", str(app / "Cargo.toml")],
    ):
        subprocess.run(["cargo", *words], env=clean(), check=True)
    return app


def main():
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    yards = [yardstick() for _ in range(2)]
    yard = min(busy for _, busy, _ in yards)
    told("the yardstick: nalgebra alone, in release", yards[0], yard)
    with tempfile.TemporaryDirectory() as folder:
        words = [sys.executable, "-m", "maturin", "build", "--quiet", "--release", "--out", folder]
        told("the wheel", took(words, cwd=ROOT, env=clean(CARGO_TARGET_DIR=f"{folder}/target")), yard)
        (wheel,) = Path(folder).glob("*.whl")
        print(f"{'':46} {wheel.stat().st_size / 1e6:.1f} MB")
    for name, (added, how, more) in WAYS.items():
        told(name, built([*added, "--path", str(ROOT)], how, more), yard)
    told("the yardstick again", yardstick(), yard)


if __name__ == "__main__":
    main()
