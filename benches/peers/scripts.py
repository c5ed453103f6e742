"""Launches and whirrs, which other scripts measure: their output, and its tables as points of a comparison."""

import pathlib
import re
import subprocess
import sys

from clock import compared

HERE = pathlib.Path(__file__).parent


def tables(text):
    """Every Markdown table: a list of rows, each a dictionary by its head."""
    found, head = [], None
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if not line.startswith("|"):
            head = None
        elif head is None:
            head = cells
            found.append([])
        elif not set(line) <= set("|- "):
            found[-1].append(dict(zip(head, cells, strict=True)))
    return found


def value(row, *words):
    """The number in the first column whose head begins with, or else contains, one of the words; NaN without one."""
    for fits in (str.startswith, str.__contains__):
        for name, cell in row.items():
            if any(fits(name, word) for word in words):
                number = re.match(r"[-+]?\d[\d.]*(?:[eE][-+]?\d+)?", cell)
                return float(number[0]) if number else float("nan")
    return float("nan")


def contestants(rows):
    """{contestant: [(setting, microseconds, error)]} of a table with the columns program, tolerance, time per ..., largest error ...."""
    found = {}
    for row in rows:
        name, us, off = row.get("program", ""), value(row, "time per"), value(row, "largest error")
        if name and us == us and 0 < off < 1:
            found.setdefault(name, []).append((row.get("tolerance", ""), us, off))
    return found


def measure(script, title, quick, count):
    """Runs a script and reads its tables; None if there is no such script."""
    if not (HERE / script).exists():
        return None
    wanted = ["--count", str(count // 20 if quick else count), "--quick"]
    told = subprocess.run(
        [sys.executable, HERE / script, *wanted], capture_output=True, text=True, check=True
    )
    found = tables(told.stdout)
    points = contestants(found[0]) if found else {}
    bare = {name for name in points if name.startswith("spincyl without errors")}
    errors = (1e-6, 1e-8, 1e-10)
    best = compared(title, {name: points[name] for name in points.keys() - bare}, errors, "µs")
    if bare:
        peers = {name for name in points if not name.startswith("spincyl")}
        best += compared(
            f"{title}, errors=False", {name: points[name] for name in bare | peers}, errors, "µs"
        )
    return {"text": told.stdout.strip() + "\n", "best": best}


def launches(quick):
    return measure("slip.py", "launches of a tube with friction", quick, 3000)


def whirrs(quick):
    told = measure("whirr.py", "coins that whirr", quick, 3000)
    laws = [sys.executable, HERE.parent / "whirr_lanes.py", "--count", "64" if quick else "1024"]
    told["text"] += "\n" + subprocess.run(laws, capture_output=True, text=True, check=True).stdout
    return told
