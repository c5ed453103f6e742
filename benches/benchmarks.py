"""Writes the section on motion of docs/benchmarks.md, and its figures; `make bench` runs it.

python benches/benchmarks.py [--seconds 150] [--steps 1e8]
"""

import argparse
import pathlib
import re

import matplotlib
import numpy as np
import report

import spincyl as sc
from spincyl.studio.plot._style import BLUE, ORANGE

matplotlib.use("agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).parents[1]
BEGIN, END = "<!-- written by benches/benchmarks.py -->\n", "<!-- end -->\n"


def long_run(steps):
    """Energy and phase error of RK4 against the number of steps of 1e-3: near a steady state, and a wide nutation."""
    curves = {}
    n = np.unique(np.geomspace(100, steps, 60).astype(np.int64))
    for name, ell, theta, kick in (
        ("ell = 2.5, kick 0.01", 2.5, 1.3, 0.01),
        ("ell = 1, kick 0.3", 1.0, 0.5, 0.3),
    ):
        body = sc.Body.solid(ell)
        start = body.steady(theta).kicked(kick)
        m = sc.roll(body, start, n * 1e-3, t0=0.0, step=1e-3)
        exact = sc.roll(body, start, n * 1e-3, t0=0.0)
        energy = np.abs(m.energy / body.energy(start) - 1)
        # time by which the motion is ahead, from the difference along the derivative
        h = 1e-6
        ahead = sc.roll(body, start, n * 1e-3 + h, t0=0.0)
        rate = (ahead.y - exact.y) / h
        phase = np.abs(((m.y - exact.y) * rate).sum(axis=0) / (rate**2).sum(axis=0))
        curves[name] = n, energy, phase, exact.error
    return curves


def draw(curves, path):
    figure, axes = plt.subplots(1, 2, figsize=(13, 5), layout="constrained")
    for (name, (n, energy, phase, _)), colour in zip(curves.items(), (BLUE, ORANGE), strict=True):
        axes[0].loglog(n, np.maximum(energy, 1e-17), ".-", color=colour, label=name)
        axes[1].loglog(n, phase, ".-", color=colour, label=name)
    for ax, title in zip(axes, ("relative energy error", r"phase error ($\sqrt{R/g}$)"), strict=True):
        ax.set_xlabel("RK4 steps of $10^{-3}$", fontsize=13)
        ax.set_title(title, fontsize=13)
        ax.grid(alpha=0.3)
        ax.legend(fontsize=11)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=150.0)
    parser.add_argument("--steps", type=float, default=1e8)
    args = parser.parse_args()
    rows = report.measure(args.seconds, reference=str(ROOT / "tests" / "reference" / "motion.csv"))
    text = report.table(rows)
    report.figure(rows, ROOT / "docs" / "figures" / "speed_against_error.png")
    curves = long_run(int(args.steps))
    draw(curves, ROOT / "docs" / "figures" / "long_run.png")
    told = (f"{name}: relative error of the energy | time by which the motion is ahead" for name in curves)
    lines = ["| number of steps of 1e-3 | " + " | ".join(told) + " |"]
    lines.append("| --- |" + " --- | --- |" * len(curves))
    for k in range(3, int(np.log10(args.steps)) + 1):
        cells = []
        for n, energy, phase, _ in curves.values():
            i = np.abs(n - 10**k).argmin()
            cells.append(f"{energy[i]:.1e} | {phase[i]:.1e}")
        lines.append(f"| 1e{k} | " + " | ".join(cells) + " |")
    path = ROOT / "docs" / "benchmarks.md"
    section = BEGIN + "\n" + text + "\n" + "\n".join(lines) + "\n\n" + END
    path.write_text(
        re.sub(re.escape(BEGIN) + ".*" + re.escape(END), lambda _: section, path.read_text(), flags=re.S)
    )
    print(section)


if __name__ == "__main__":
    main()
