"""Build and pack the cores of the live page, with a record of the sources that they were built from.

core.lzma has what every page needs; core.friction.lzma also has friction and losses. The code of a page has
to be short, so each is built from a copy of the sources in which few functions have to be inlined, and split.

    python web/build.py            builds both if rustup has the target, else says how to install it
    python web/build.py FOLDER     writes them there, for a comparison; the committed ones stay
"""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

sys.path.append(str(Path(__file__).parent))
sys.path.append(str(Path(__file__).parents[1] / "python/spincyl/studio/pages"))
from compressed import compressed
from split import Split

HOME = Path(__file__).parents[1]
COMMITTED = HOME / "python/spincyl/studio/pages/cores"
CORES = {"core.lzma": "--no-default-features", "core.friction.lzma": "--all-features"}
RECORD = COMMITTED / "core.json"
TARGET = "wasm32-unknown-unknown"
MISSING = f"the live page keeps its committed cores: `rustup target add {TARGET}` to build it"
#: What a build reads.
READ = [
    "Cargo.*",
    "build.rs",
    "README.md",
    "docs/rust.md",
    "src/**/*.rs",
    "web/Cargo.toml",
    "web/src/*.rs",
    "examples/*.rs",
    "benches/*.rs",
    "benches/Cargo.toml",
]
#: What the library inlines everywhere for its speed, a page inlines where the compiler finds that it pays;
#: except for stones, whose motion takes a page longest.
INLINED = "inline(always)", "inline"
STONES = HOME / "src/laws/stone", HOME / "src/motions/stone"
#: A loop has its variables as they are written, since variables made for addressing compress worse.
FLAGS = [
    *("-C", "target-feature=+simd128"),
    *("-C", "link-arg=--compress-relocations"),
    *("-C", "llvm-args=--disable-lsr"),
]


def sources():
    """A digest of everything that the cores are built from: sources, dependencies, profiles."""
    cargo = tomllib.loads((HOME / "Cargo.toml").read_text(encoding="utf-8"))
    profiles = {name: cargo["profile"][name] for name in ("release", "web")}
    needed = {name: what for name, what in cargo["dependencies"].items() if name not in ("pyo3", "numpy")}
    found = hashlib.sha256(json.dumps([needed, profiles], sort_keys=True).encode())
    files = [*(HOME / "src").rglob("*.rs"), *(HOME / "web").rglob("*.rs"), HOME / "web/Cargo.toml"]
    for path in sorted(path for path in files if not path.is_relative_to(HOME / "src/python")):
        # a checkout may have other line endings
        text = path.read_bytes().replace(b"\r\n", b"\n")
        found.update(f"\n{path.relative_to(HOME).as_posix()} {len(text)}\n".encode() + text)
    return found.hexdigest()


def said(*words):
    """The output of a command."""
    return subprocess.run(words, cwd=HOME, capture_output=True, text=True, check=True).stdout.strip()


def can():
    """Whether the target is installed."""
    return Path(said("rustc", "--print", "target-libdir", "--target", TARGET)).is_dir()


def copied():
    """A copy of what a build reads, in which only functions of stones have to be inlined."""
    copy = HOME / "target/short"
    shutil.rmtree(copy, ignore_errors=True)
    for path in (path for pattern in READ for path in HOME.glob(pattern)):
        to = copy / path.relative_to(HOME)
        to.parent.mkdir(parents=True, exist_ok=True)
        text = path.read_text(encoding="utf-8")
        to.write_text(text if path.parent in STONES else text.replace(*INLINED), encoding="utf-8")
    return copy


def built(features, copy):
    """The module."""
    cargo = os.environ.get("CARGO_HOME") or Path.home() / ".cargo"
    flags = [*FLAGS, f"--remap-path-prefix={cargo}=cargo"]
    environment = os.environ | {
        "CARGO_ENCODED_RUSTFLAGS": "\x1f".join(flags),
        "CARGO_TARGET_DIR": str(HOME / "target"),
    }
    environment.pop("RUSTFLAGS", None)
    wanted = ["--quiet", "--profile", "web", "--package", "spincyl-web", "--target", TARGET, features]
    subprocess.run(["cargo", "build", *wanted], cwd=copy, env=environment, check=True)
    return (HOME / "target" / TARGET / "web/spincyl_web.wasm").read_bytes()


def crates():
    """The versions of the crates in the module."""
    words = [
        "--package",
        "spincyl-web",
        "--edges",
        "normal,no-proc-macro",
        "--target",
        TARGET,
        "--prefix",
        "none",
    ]
    lines = said("cargo", "tree", *words).splitlines()
    foreign = [line for line in lines if "spincyl" not in line and "proc-macro" not in line]
    return sorted({" ".join(line.split()[:2]) for line in foreign})


def main(to=None):
    """Build and pack the cores; write the record of the committed ones."""
    folder = Path(to) if to else COMMITTED
    if to:
        folder.mkdir(parents=True, exist_ok=True)
        for name in CORES:
            (folder / name).unlink(missing_ok=True)
    if not can():
        print(MISSING)
        checking = os.environ.get("CI", "").lower() not in ("", "0", "false", "no")
        return 1 if checking and not to else 0
    made = {"sources": sources(), "rustc": said("rustc", "--version"), "crates": crates()}
    copy = copied()
    for name, features in CORES.items():
        core = built(features, copy)
        packed = compressed(Split(core).data())
        (folder / name).write_bytes(packed)
        made[name] = hashlib.sha256(core).hexdigest()
        print(f"{name}: {len(core)} bytes, packed {len(packed)}")
    if not to:
        RECORD.write_text(json.dumps(made, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:]))
