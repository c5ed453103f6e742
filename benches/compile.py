"""Cost of compiling: wall time, CPU time, and the memory of the largest compiler process.

Compiles the wheel, and new programs in empty folders that use the crate, each from scratch, with its
dependencies. Each processor time is compared with a yardstick that any machine has: a release build of nalgebra
alone, compiled twice before the others (the smaller is taken) and once after them. For unoptimised programs the
yardstick is such a build of nalgebra, and the program is run: 100 exact motions, and 20 with friction. With --recipe
two release programs with a survey are compiled and run in turn: as cargo makes them, and with one unit for this
crate (docs/rust.md). Needs cargo, and maturin for the wheel; ten minutes.
usage: python benches/compile.py [--debug | --recipe]
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
use spincyl::{Body, Slip, roll, steady};

fn main() -> Result<(), spincyl::Error> {
    let body = Body::tube(6.0, 0.8)?;
    let start = steady::state(&body, 1.4)?.kicked(0.05);
    let times: Vec<f64> = (0..=200).map(|i| 0.1 * f64::from(i)).collect();
    for _ in 0..100 {
        assert!(roll(&body, &start, &times)?.error < 1e-9);
    }
    let ask = Ask::on(Friction::coulomb(0.2)).with_pose().with_force();
    for _ in 0..20 {
        let thrown = Start::from(start).with_slip(Slip::new(0.3, -0.5));
        assert!(roll_with(&body, thrown, &times, &ask, || true)?.unwrap().error < 1e-6);
    }
    Ok(())
}
"""

#: The profile that docs/rust.md recommends for release builds.
RECIPE = "\n[profile.release.package.spincyl]\nopt-level = 2\ncodegen-units = 1\n"
SURVEY = """
use spincyl::contact::Friction;
use spincyl::ensemble::{BodyColumns, Job, MotionOutput, MotionStarts, roll};
use spincyl::motion::{Ask, Start, roll_with};
use spincyl::{Body, Slip, steady};
use std::time::Instant;

const COUNT: usize = 16_384;

fn main() -> Result<(), spincyl::Error> {
    let (mut bodies, mut states): ([Vec<f64>; 5], [Vec<f64>; 4]) = Default::default();
    for i in 0..COUNT {
        let body = Body::solid(0.5 + 2.5 * (i as f64 + 0.5) / COUNT as f64)?;
        let low = body.theta_balance().max(body.theta_limit());
        let share = 0.1 + 0.8 * ((i * 40_503 % 65_536) as f64 + 0.5) / 65_536.0;
        let y = steady::state(&body, low + (core::f64::consts::FRAC_PI_2 - low) * share)?.kicked(0.05);
        let numbers = [body.ell(), body.i1(), body.i3(), body.fillet(), body.theta_end()];
        bodies.iter_mut().zip(numbers).for_each(|(column, x)| column.push(x));
        states.iter_mut().zip(<[f64; 4]>::from(y)).for_each(|(column, x)| column.push(x));
    }
    let [ell, i1, i3, fillet, theta_end] = &bodies;
    let columns = BodyColumns::new(ell, i1, i3).with_fillet(fillet).with_theta_end(theta_end);
    let starts = MotionStarts::new(columns, states.each_ref().map(|x| x.as_slice()));
    let (mut error, mut method, mut status) = (vec![0.0; COUNT], vec![0; COUNT], vec![0; COUNT]);
    let mut least = [f64::INFINITY; 3];
    for _ in 0..5 {
        let began = Instant::now();
        let job = Job::new(&[20.0]).with_ask(Ask::default().with_beyond());
        roll(&starts, &job, MotionOutput::new(&mut error, &mut method, &mut status), 1, |_| true)?;
        least[0] = least[0].min(began.elapsed().as_secs_f64());
        let began = Instant::now();
        let pipe = Body::tube(6.0, 0.8)?;
        let start = steady::state(&pipe, 1.4)?.kicked(0.05);
        let times: Vec<f64> = (0..=200).map(|i| 0.1 * f64::from(i)).collect();
        for _ in 0..2000 {
            assert!(spincyl::roll(&pipe, &start, &times)?.error < 1e-9);
        }
        least[1] = least[1].min(began.elapsed().as_secs_f64());
        let began = Instant::now();
        let ask = Ask::on(Friction::coulomb(0.2)).with_restitution(0.3);
        for _ in 0..200 {
            let thrown = Start::from(start).with_slip(Slip::new(0.3, -0.5));
            assert!(roll_with(&pipe, thrown, &times, &ask, || true)?.unwrap().error < 1e-6);
        }
        least[2] = least[2].min(began.elapsed().as_secs_f64());
    }
    println!("{} {} {}", least[0], least[1], least[2]);
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


def compared_with_recipe():
    """Print what a release program costs and how fast it is, with and without the recipe, run in turn."""
    yard = min(yardstick(["--release"])[1] for _ in range(2))
    with tempfile.TemporaryDirectory() as folder:
        ways = {"release, as cargo makes it": "", "release, one unit for this crate": RECIPE}
        apps = {}
        for k, (name, profile) in enumerate(ways.items()):
            apps[name] = app = program(Path(folder) / str(k), ["--path", str(ROOT)])
            (app / "src/main.rs").write_text(SURVEY)
            with (app / "Cargo.toml").open("a") as manifest:
                manifest.write(profile)
            told(name, took(["cargo", "build", "--quiet", "--release"], cwd=app, env=clean()), yard)
        least = dict.fromkeys(apps, [float("inf")] * 3)
        for _ in range(3):
            for name, app in apps.items():
                out = subprocess.run([app / "target/release/app"], capture_output=True, text=True, check=True)
                least[name] = [
                    min(old, float(new)) for old, new in zip(least[name], out.stdout.split(), strict=True)
                ]
        plain, better = least.values()
        for what, old, new in zip(("a survey", "single motions", "with hops"), plain, better, strict=True):
            print(
                f"{what}: {old:.3f} s as cargo makes it, {new:.3f} s with the recipe: {old / new:.2f} times as fast"
            )


def program(folder, added):
    """An empty program with the given dependencies, added by `cargo add`."""
    app = Path(folder) / "app"
    app.parent.mkdir(exist_ok=True)
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
    parser.add_argument("--recipe", action="store_true", help="only two release programs that are run")
    asked = parser.parse_args()
    if asked.recipe:
        return compared_with_recipe()
    if asked.debug:
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
