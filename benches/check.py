#!/usr/bin/env python3
"""Cost of `make test`: processor time and peak memory of each command, by target.

Clones the last commit into a temporary folder and makes the targets of `make test` there, one after the other. This
program stands in for the shell that make starts, so that every line of a recipe is measured and none is changed.
The times are compared with the yardstick of compile.py, a release build of nalgebra alone. A quarter of an hour.
usage: python benches/check.py [TARGET ...] [--of FOLDER]
"""

import argparse
import contextlib
import ctypes
import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import compile as builds

ROOT = Path(__file__).parents[1]
TARGETS = [".venv/.built", ".venv/.tested", "browser", "lint", "rust", "python", "pages", "docs"]
LOG = "SPINCYL_CHECK_LOG"
SUBREAPER = 36  # PR_SET_CHILD_SUBREAPER in <linux/prctl.h>


def line(words):
    """Runs one line of a recipe with bash and appends what it took to the log; its exit code.

    Processes that outlive their parent, such as those of a browser, become children of this one, so that their time is
    counted too.
    """
    if ctypes.CDLL(None).prctl(SUBREAPER, 1, 0, 0, 0):
        raise OSError("no kernel that hands orphans over: times of browsers would be lost")
    code = subprocess.run(["bash", *words]).returncode
    with contextlib.suppress(ChildProcessError):
        while True:
            os.wait()
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    took = {"line": words[-1], "busy": used.ru_utime + used.ru_stime, "memory": used.ru_maxrss / 1e6}
    with open(os.environ[LOG], "a", encoding="utf-8") as log:
        log.write(json.dumps(took) + "\n")
    return code


def short(text):
    """The line of a recipe, without folders and minor options, in at most 90 characters."""
    for plain in (".venv/bin/", "nice -n 10 ", "--quiet "):
        text = text.replace(plain, "")
    text = " ".join(text.split())
    return text if len(text) < 90 else f"{text[:87]}..."


def made(target, clone, log, yard):
    """Make one target and print the cost of each line that takes half a second or more; their processor time."""
    log.write_text("")
    subprocess.run(
        ["make", "--no-print-directory", target, f"SHELL={Path(__file__).resolve()}"],
        cwd=clone, env=builds.clean(**{LOG: str(log)}), check=True, stdout=sys.stderr,
    )  # fmt: skip
    lines = [took for took in map(json.loads, log.read_text().splitlines()) if took["busy"] > 0.5]
    all_busy = sum(took["busy"] for took in lines)
    print(f"{target:92} {all_busy:6.1f} s = {all_busy / yard:5.2f} yardsticks")
    for took in lines:
        print(f"  {short(took['line']):90} {took['busy']:6.1f} s, {took['memory']:5.2f} GB", flush=True)
    return all_busy


def main():
    if sys.argv[1:2] == ["-o"]:  # as make's shell
        sys.exit(line(sys.argv[1:]))
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("targets", nargs="*", default=TARGETS)
    parser.add_argument(
        "--of", type=Path, default=ROOT, help="another repository, or another state of this one"
    )
    asked = parser.parse_args()
    yard = min(builds.yardstick()[1] for _ in range(2))
    print(f"the yardstick, nalgebra alone in release: {yard:.1f} s of processor", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        clone = Path(folder) / "clone"
        subprocess.run(
            ["git", "clone", "--quiet", "--depth", "1", f"file://{asked.of.resolve()}", clone], check=True
        )
        subprocess.run(["cargo", "fetch", "--quiet"], cwd=clone, check=True)
        all_busy = sum(made(target, clone, Path(folder) / "log", yard) for target in asked.targets)
    print(f"{'all':92} {all_busy:6.1f} s = {all_busy / yard:5.2f} yardsticks")


if __name__ == "__main__":
    main()
