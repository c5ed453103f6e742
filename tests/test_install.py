"""Installation by users: the wheel without Rust, the crate without Python, the sources with pip and cargo."""

import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import venv
import zipfile

import pytest

import spincyl as sc

ROOT = pathlib.Path(__file__).parents[1]

PYTHON = """
import sys
import numpy as np
import spincyl as sc
pipe = sc.Body.tube(6.0, bore=0.8)
state = pipe.steady(np.radians(85))
print(f"{state.contact_radius:.6f} {pipe.nutation(state.theta):.12f}")
page = sc.view(sc.roll(pipe, state, 20.0)).html
assert page.startswith("<!DOCTYPE html>") and len(page) > 20_000
assert sc.exposure(sc.roll(pipe, state, 5.0)).max() > 0
for what, name in (
    (lambda: sc.plot.branches([2.5]), "plot"),
    (lambda: sc.sweep.portrait([0.5], [1.0]), "sweep"),
    (lambda: sc.data.compare(pipe, [0.1] * 3, [1.0] * 3), "lab"),
):
    try:
        what()
    except ImportError as e:
        assert f"pip install 'spincyl[{name}]'" in str(e), e
    else:
        raise AssertionError(f"{name} is not extra")
"""

RUST = """
use spincyl::{Body, Contact, stability, steady};

fn main() -> Result<(), spincyl::Error> {
    let pipe = Body::tube(6.0, 0.8)?;
    let state = steady::state(&pipe, 85f64.to_radians())?;
    let kappa = stability::at_rest(&pipe, state.theta, Contact::Rolling);
    println!("{:.6} {:.12}", state.contact_radius(), stability::nutation(kappa));
    Ok(())
}
"""


def numbers():
    pipe = sc.Body.tube(6.0, bore=0.8)
    state = pipe.steady(85 * 3.141592653589793 / 180)
    return f"{state.contact_radius:.6f} {pipe.nutation(state.theta):.12f}"


def only(folder, *names):
    """A search path with these programs only."""
    folder.mkdir()
    for name in names:
        found = shutil.which(name)
        if found:
            (folder / name).symlink_to(found)
    return str(folder)


def run(words, **how):
    ran = subprocess.run([str(x) for x in words], capture_output=True, text=True, **how)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    return ran.stdout


def built():
    """The wheel for this machine; SPINCYL_WHEELS=dist tests the one that `make wheel` makes for release."""
    folder = ROOT / os.environ.get("SPINCYL_WHEELS", pathlib.Path(sys.prefix) / "wheels")
    wheels = list(folder.glob(f"spincyl-*{platform.machine()}.whl"))
    assert len(wheels) == 1, f"make builds it: {wheels}"
    return wheels[0]


@pytest.mark.skipif("SPINCYL_WHEELS" not in os.environ, reason="make long: those that make wheel makes")
def test_a_wheel_to_give_away_runs_on_every_linux_since_2014():
    for path in built().parent.glob("*.whl"):
        assert "-cp311-abi3-manylinux_2_17_" in path.name
        with zipfile.ZipFile(path) as wheel:
            core = wheel.read("spincyl/_core.abi3.so")
        needed = {tuple(map(int, v)) for v in re.findall(rb"GLIBC_(\d+)\.(\d+)", core)}
        assert (2, 2) <= max(needed) <= (2, 17), f"{path.name}: {needed}"


def test_the_wheel_works_where_there_is_no_rust(tmp_path):
    path = built()
    assert path.stat().st_size < 5_650_000
    with zipfile.ZipFile(path) as wheel:
        for source in (ROOT / "python" / "spincyl").rglob("*"):
            if source.suffix in {".py", ".pyi", ".html", ".css", ".js", ".gz", ".csv", ".txt", ".wav"}:
                packed = wheel.read(source.relative_to(ROOT / "python").as_posix())
                assert packed == source.read_bytes(), f"{source.name} is newer: make builds it again"
    venv.create(tmp_path / "env", with_pip=False)
    python = tmp_path / "env" / "bin" / "python"
    quiet = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "CARGO", "RUST"))}
    quiet["PATH"] = str(python.parent)
    assert shutil.which("cargo", path=quiet["PATH"]) is None
    # by the pip of this environment, since installing a new pip takes longer than the rest
    install = [
        sys.executable,
        "-m",
        "pip",
        "--python",
        python,
        "install",
        "--no-compile",
        "--only-binary",
        ":all:",
    ]
    run([*install, path], env=quiet, cwd=tmp_path)
    assert run([python, "-c", PYTHON], env=quiet, cwd=tmp_path).strip() == numbers()
    command = tmp_path / "env" / "bin" / "spincyl"
    said = run(
        [command, "roll", "--ell", "2.5", "--theta", "1.3", "--t", "20", "-o", "spin.html"],
        env=quiet,
        cwd=tmp_path,
    )
    assert "the motion in spin.html" in said and (tmp_path / "spin.html").stat().st_size < 60_000


@pytest.fixture(scope="module")
def sdist(tmp_path_factory):
    """The sources as uploaded to a package index."""
    folder = tmp_path_factory.mktemp("sdist")
    run([sys.executable, "-m", "maturin", "sdist", "--out", folder], cwd=ROOT)
    (path,) = folder.glob("spincyl-*.tar.gz")
    return path


def test_the_sources_for_python_are_whole_and_have_nothing_else(sdist):
    assert sdist.stat().st_size < 1_890_000
    with tarfile.open(sdist) as packed:
        names = {member.name.split("/", 1)[1] for member in packed if member.isfile()}
    wrapper = ROOT / "python" / "spincyl"
    kinds = {".py", ".pyi", ".typed", ".html", ".css", ".js", ".gz", ".csv", ".txt", ".wav"}
    needed = {x.relative_to(ROOT).as_posix() for x in wrapper.rglob("*") if x.suffix in kinds}
    needed |= {x.relative_to(ROOT).as_posix() for x in (ROOT / "src").rglob("*.rs")}
    needed |= {"README.md", "LICENSE-APACHE", "LICENSE-MIT", "build.rs", "pyproject.toml", "Cargo.lock"}
    assert needed <= names, needed - names
    assert {name.split("/")[0] for name in names if "/" in name} == {"src", "python", "docs", "examples"}
    assert not [name for name in names if name.endswith((".png", ".so", ".pyc"))]


@pytest.mark.long  # compiles the crate and all its dependencies
def test_the_sources_for_python_build_where_there_is_only_pip_and_cargo(sdist, tmp_path):
    tools = ("cargo", "rustc", "rustup", "cc", "gcc", "ld", "as", "ar", "collect2", "cat", "sh")
    venv.create(tmp_path / "env", with_pip=True)
    python = tmp_path / "env" / "bin" / "python"
    alone = {
        k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "VIRTUAL_ENV", "CARGO_TARGET"))
    }
    alone["PATH"] = f"{python.parent}:{only(tmp_path / 'bin', *tools)}"
    assert not any(shutil.which(name, path=alone["PATH"]) for name in ("maturin", "git", "make"))
    run([python, "-m", "pip", "install", "--quiet", sdist], env=alone, cwd=tmp_path)
    assert run([python, "-c", PYTHON], env=alone, cwd=tmp_path).strip() == numbers()


def test_the_crate_asks_for_no_python():
    tree = run(["cargo", "tree", "--edges", "normal"], cwd=ROOT)
    assert "nalgebra" in tree and "pyo3" not in tree


@pytest.mark.long  # compiles the crate and all its dependencies
def test_a_rust_program_of_ten_lines_works_where_there_is_no_python(tmp_path):
    tools = ("cargo", "rustc", "rustup", "cc", "gcc", "ld", "as", "ar", "collect2", "cat", "sh")
    alone = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "VIRTUAL_ENV"))}
    alone["PATH"] = only(tmp_path / "bin", *tools)
    alone["CARGO_TARGET_DIR"] = str(ROOT / "target" / "alone")  # dependencies are compiled only once
    assert not any(shutil.which(name, path=alone["PATH"]) for name in ("python", "python3"))
    app = tmp_path / "app"
    run(["cargo", "init", "--quiet", "--vcs", "none", app], env=alone)
    run(["cargo", "add", "--quiet", "--path", ROOT], env=alone, cwd=app)
    assert len(RUST.strip().splitlines()) <= 10
    (app / "src" / "main.rs").write_text(RUST)
    assert run(["cargo", "run", "--quiet"], env=alone, cwd=app).strip() == numbers()


def test_the_crate_has_its_sources_and_tests_and_nothing_else():
    listed = run(["cargo", "package", "--list", "--allow-dirty"], cwd=ROOT).split()
    kinds = {name.split("/")[0] for name in listed if "/" in name}
    assert kinds == {"src", "tests", "docs", "examples"}
    own = {"Cargo.toml", "Cargo.toml.orig", "Cargo.lock", ".cargo_vcs_info.json"}
    files = {name for name in listed if "/" not in name} - own
    assert files == {"README.md", "CHANGELOG.md", "LICENSE-APACHE", "LICENSE-MIT", "build.rs"}
    assert not [name for name in listed if name.endswith((".py", ".png", ".html"))]


def test_importing_loads_nothing_that_a_scene_may_not_need():
    code = "import sys, spincyl; print(*sys.modules)"
    loaded = set(run([sys.executable, "-c", code]).split())
    later = {f"spincyl.{x}" for x in ("studio", "lab", "data", "plot", "sweep", "cli")}
    assert not loaded & (later | {"json", "html", "matplotlib", "xarray", "scipy", "odrpack", "mujoco"})


def test_what_is_loaded_later_is_listed_and_typed():
    assert {"view", "exposure", "scene", "data", "plot", "sweep"} <= set(dir(sc)) & set(sc.__all__)
    with pytest.raises(AttributeError, match="no attribute 'vieww'"):
        sc.vieww
