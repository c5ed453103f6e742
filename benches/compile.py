"""Cost of compiling: wall time, CPU time, and the memory of the largest compiler process.

Compiles the wheel, and new programs in empty folders that use the crate, each from scratch, with its
dependencies. Each processor time is compared with a yardstick that any machine has: a release build of nalgebra
alone, compiled twice before the others (the smaller is taken) and once after them. For unoptimised programs the
yardstick is such a build of nalgebra, and the program is run: 100 exact motions, and 20 with friction. Needs cargo,
and maturin for the wheel; ten minutes.
usage: python benches/compile.py [--debug]
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
}
#: The same of programs without optimisation, and the level at which this crate alone is optimised.
DEBUG = {
    "unoptimised": ([], {}, 0),
    "unoptimised, without what is many at once": (["--no-default-features"], {}, 0),
    "unoptimised, with lanes": ([], {"SPINCYL_COMPILED_LANES": "all"}, 0),
    "this crate at level 2, without lanes": ([], {"SPINCYL_COMPILED_LANES": "none"}, 2),
    "the same, without what is many at once": (
        ["--no-default-features"],
        {"SPINCYL_COMPILED_LANES": "none"},
        2,
    ),
    "this crate at level 2, with lanes": ([], {}, 2),
}
PROGRAM = """
use spincyl::contact::Friction;
use spincyl::motion::{Ask, Start, roll_with};
use spincyl::{Body, roll, steady};

fn main() -> Result<(), spincyl::Error> {
    let body = Body::tube(6.0, 0.8)?;
    let start = steady::state(&body, 1.4)?.kicked(0.05);
    let times: Vec<f64> = (0..=200).map(|i| 0.1 * f64::from(i)).collect();
    for _ in 0..100 {
        assert!(roll(&body, &start, &times)?.error < 1e-9);
    }
    let ask = Ask::on(Friction::coulomb(0.2)).with_pose(true).with_force(true);
    for _ in 0..20 {
        let thrown = Start::from(start).with_slip([0.3, -0.5]);
        assert!(roll_with(&body, thrown, &times, &ask, || true)?.unwrap().error < 1e-6);
    }
    Ok(())
}
"""


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
    """Print the cost of a command, its CPU time also in units of the yardstick."""
    seconds, busy, memory = times
    print(
        f"{name:46} {seconds:5.0f} s, {busy:5.0f} s of processor = {busy / yard:5.2f} yardsticks, {memory:5.2f} GB",
        flush=True,
    )


def built(added, how, more):
    """Cost of building a program with given dependencies."""
    with tempfile.TemporaryDirectory() as folder:
        return took(["cargo", "build", "--quiet", *how], cwd=program(folder, added), env=clean(**more))


def yardstick(how):
    """A build of nalgebra alone, of one version and with one set of features."""
    return built(YARDSTICK, how, {})


def debugged(added, more, level):
    """Cost of building an unoptimised program, and of running it."""
    with tempfile.TemporaryDirectory() as folder:
        app = program(folder, [*added, "--path", str(ROOT)])
        (app / "src/main.rs").write_text(PROGRAM)
        if level:
            with (app / "Cargo.toml").open("a") as manifest:
                manifest.write(f"\n[profile.dev.package.spincyl]\nopt-level = {level}\n")
        times = took(["cargo", "build", "--quiet"], cwd=app, env=clean(**more))
        return times, took([str(app / "target/debug/app")])


def all_debugged():
    """Print the costs of unoptimised programs, and of a build of nalgebra alone in their profile."""
    yard = min(yardstick([])[1] for _ in range(2))
    for name, (added, more, level) in DEBUG.items():
        times, ran = debugged(added, more, level)
        told(name, times, yard)
        print(f"{'':46} it runs for {ran[1]:.2f} s of processor", flush=True)


def program(folder, added):
    """An empty program with the given dependencies, added by `cargo add`."""
    app = Path(folder) / "app"
    for words in (
        ["init", "--quiet", "--vcs", "none", str(app)],
        ["add", "--quiet", "--manifest-path", str(app / "Cargo.toml"), *added],
        ["fetch", "--quiet", "--manifest-path", str(app / "Cargo.toml")],
    ):
        subprocess.run(["cargo", *words], env=clean(), check=True)
    return app


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--debug", action="store_true", help="only unoptimised programs")
    if parser.parse_args().debug:
        return all_debugged()
    yards = [yardstick(["--release"]) for _ in range(2)]
    yard = min(busy for _, busy, _ in yards)
    told("the yardstick: nalgebra alone, in release", yards[0], yard)
    with tempfile.TemporaryDirectory() as folder:
        words = [sys.executable, "-m", "maturin", "build", "--quiet", "--release", "--out", folder]
        told("the wheel", took(words, cwd=ROOT, env=clean(CARGO_TARGET_DIR=f"{folder}/target")), yard)
        (wheel,) = Path(folder).glob("*.whl")
        print(f"{'':46} {wheel.stat().st_size / 1e6:.1f} MB")
    for name, (added, how, more) in WAYS.items():
        told(name, built([*added, "--path", str(ROOT)], how, more), yard)
    told("the yardstick again", yardstick(["--release"]), yard)
    return all_debugged()


if __name__ == "__main__":
    main()
