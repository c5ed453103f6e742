"""Cost of each layer of `src` when the wheel is compiled: lines, LLVM lines, seconds, and machine code.

Compiles the crate twice, as for the wheel: once up to the LLVM code of the generic code before anything is inlined,
and once to the end with the timings of LLVM. A function counts for the layer where it is defined, wherever it is
inlined. The seconds are LLVM's for each function; those of rustc itself are not by layer. Three minutes.
usage: python benches/layers.py
"""

import argparse
import json
import os
import re
import subprocess
import tempfile
from collections import Counter
from pathlib import Path

import compile as builds

ROOT = Path(__file__).parents[1]
LAYERS = sorted(p.name for p in (ROOT / "src").iterdir() if p.is_dir())
#: Functions of other crates, compiled with this one since they are generic.
OTHER = "others'"


def layer(name):
    """The layer whose path comes first in the name of a function, as compilers write names."""
    found = re.search(r"7spincyl(?:\d+lib)?\d+(" + "|".join(LAYERS) + r")(?=\d|E)", name)
    return found[1] if found else OTHER


def lines():
    """Lines of code by layer, without comments and empty lines."""
    found = Counter()
    for name in LAYERS:
        for path in (ROOT / "src" / name).rglob("*.rs"):
            text = [line.strip() for line in path.read_text("utf-8").splitlines()]
            found[name] += sum(bool(line) and not line.startswith("//") for line in text)
    return found


def compiled(target, *flags):
    """Compile the crate of the wheel with additional flags; returns the folder of outputs."""
    words = [
        "cargo",
        "rustc",
        "--quiet",
        "--release",
        "--lib",
        "--features",
        "python",
        "--crate-type",
        "cdylib",
    ]
    # -Z says where LLVM spends its time; the compiler is the same
    env = builds.clean(CARGO_TARGET_DIR=str(target), RUSTC_BOOTSTRAP="1", PYO3_BUILD_EXTENSION_MODULE="1")
    subprocess.run([*words, "--", *builds.NO_NOALIAS.split(), *flags], cwd=ROOT, env=env, check=True)
    return target / "release"


def llvm_lines(path):
    """LLVM lines by layer."""
    found, now = Counter(), None
    with open(path, encoding="utf-8", errors="replace") as text:
        for line in text:
            if line.startswith("define "):
                now = layer(line.partition("@")[2].partition("(")[0])
            if now:
                found[now] += 1
            if line.startswith("}"):
                now = None
    return found


def seconds(path):
    """Seconds of LLVM by layer: optimising each function, and writing its machine code."""
    found = Counter()
    for event in json.loads(path.read_text("utf-8", errors="replace"))["traceEvents"]:
        if event.get("name") in ("OptFunction", "CodeGen Function", "CodeGenFunction"):
            found[layer(event["args"]["detail"])] += event["dur"] / 1e6
    return found


def machine_code(path):
    """Bytes of machine code by layer."""
    said = subprocess.run(
        ["nm", "-S", "--defined-only", path], capture_output=True, text=True, check=True
    ).stdout
    found = Counter()
    for line in said.splitlines():
        words = line.split()
        if len(words) == 4 and words[2] in "tT":
            found[layer(words[3])] += int(words[1], 16)
    return found


def main():
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    with tempfile.TemporaryDirectory() as folder:
        out = compiled(Path(folder), "--emit=llvm-ir", "-C", "no-prepopulate-passes")
        (ir,) = (out / "deps").glob("spincyl*.ll")
        generic = llvm_lines(ir)
        ir.unlink()
        os.utime(ROOT / "src" / "lib.rs")
        out = compiled(Path(folder), "-Z", "llvm-time-trace", "-C", "strip=none")
        traces = [*ROOT.glob("*.llvm_timings.json"), *out.rglob("*.llvm_timings.json")]
        spent = sum((seconds(path) for path in traces), Counter())
        for path in traces:
            path.unlink()
        code = machine_code(out / "libspincyl.so")
    written = lines()
    print(f"{'layer':10}{'lines of code':>15}{'LLVM lines':>14}{'seconds of LLVM':>18}{'MB of code':>13}")
    for name in [*LAYERS, OTHER]:
        print(f"{name:10}{written[name]:15,}{generic[name]:14,}{spent[name]:18.1f}{code[name] / 1e6:13.2f}")
    sums = [sum(x.values()) for x in (written, generic, spent, code)]
    print(f"{'all':10}{sums[0]:15,}{sums[1]:14,}{sums[2]:18.1f}{sums[3] / 1e6:13.2f}")


if __name__ == "__main__":
    main()
