"""Rounds that alternate the contestants, so that other work on the machine affects all of them; and
tables."""

import importlib.util
import time


def has(name):
    return importlib.util.find_spec(name) is not None


def alternate(jobs, rounds=7, seconds=2.5, clock=time.perf_counter):
    """Least seconds of every job (name: callable), and what each returned; all warm up once.

    A job that has taken `seconds` by itself and ran twice drops out of the later rounds.
    """
    found = {name: run() for name, run in jobs.items()}
    least, spent, count = dict.fromkeys(jobs, float("inf")), dict.fromkeys(jobs, 0.0), dict.fromkeys(jobs, 0)
    for _ in range(rounds):
        for name, run in jobs.items():
            if spent[name] > seconds and count[name] >= 2:
                continue
            start = clock()
            run()
            took = clock() - start
            least[name], spent[name], count[name] = (
                min(least[name], took),
                spent[name] + took,
                count[name] + 1,
            )
    return least, found


def said(x):
    """A cell of a table."""
    if x is None or x != x:
        return ""
    if isinstance(x, float):
        if x == 0 or 1e3 <= abs(x) < 1e5:
            return f"{x:.0f}"
        return f"{x:.3g}" if 1e-3 <= abs(x) < 1e3 else f"{x:.1e}".replace(".0e", "e")
    return str(x)


def table(head, rows):
    """Markdown."""
    lines = [" | ".join(head), " | ".join(["---"] * len(head)), *(" | ".join(map(said, row)) for row in rows)]
    return "".join(f"| {line} |\n" for line in lines)


def cheapest(points, error, mine):
    """(cost, contestant) of the cheapest setting of spincyl, or of the peers, whose error is at most this."""
    fit = [
        (cost, name)
        for name, rows in points.items()
        for _, cost, off in rows
        if name.startswith("spincyl") == mine and off == off and off <= error
    ]
    return min(fit, default=(float("nan"), "none"))


def compared(job, points, errors, unit):
    """Rows (job, error at most, spincyl, the cheapest peer, its name, ratio) where both reach the error."""
    rows = []
    for error in errors:
        here, there = cheapest(points, error, True), cheapest(points, error, False)
        if here[0] == here[0] and there[0] == there[0]:
            rows.append(
                (
                    job,
                    error,
                    f"{said(here[0])} {unit}",
                    f"{said(there[0])} {unit}",
                    there[1],
                    there[0] / here[0],
                )
            )
    return rows
