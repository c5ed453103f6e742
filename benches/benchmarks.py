"""Writes the section on motion of docs/benchmarks.md, and its figures; `make bench` runs it.

python benches/benchmarks.py [--seconds 150] [--steps 1e8] [--draw]

With `--draw` nothing is written into the page, and the figure of times is drawn from the numbers that it has.
"""

import argparse
import pathlib
import re

import matplotlib
import numpy as np
import report

import spincyl as sc
from spincyl.studio.plot._style import BLUE, ORANGE, saved

matplotlib.use("agg")
import matplotlib.pyplot as plt

ROOT = pathlib.Path(__file__).parents[1]
#: the sentence above the table of the long run
LONG = """\
Each row is a number of steps, with the errors of two long motions computed by RK4 in steps of 1e-3 sqrt(R/g): a cylinder with ell = 2.5 R whose steady state is kicked by 0.01 sqrt(g/R), and one with ell = 1 R, kicked by 0.3 sqrt(g/R).
The error of the phase is the time by which the nutation of the computed motion is ahead of the exact one."""
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
    """The largest error of the energy so far, and the time by which the motion is ahead, a panel for each motion."""
    figure, axes = plt.subplots(1, 2, figsize=(12.8, 7.2), layout="constrained", sharey=True)
    for ax, words, (n, energy, phase, _) in zip(
        axes, ("it nods a little", "it nods widely"), curves.values(), strict=True
    ):
        # from the first step at which there is any error of the energy
        most = np.maximum.accumulate(energy)
        for values, colour in ((np.where(most > 0, most, np.nan), ORANGE), (phase, BLUE)):
            ax.loglog(n, values, color=colour, lw=3)
        ax.set_title(words, size=19, pad=12)
        ax.tick_params(labelsize=16)
        ax.spines[["top", "right"]].set_visible(False)
        ax.annotate(_said(phase[-1]), (n[-1], phase[-1]), (-6, 10), **_beside(BLUE))
        ax.annotate(_said(most[-1]), (n[-1], most[-1]), (-6, 10), **_beside(ORANGE))
    middle = {"size": 18, "ha": "left"}
    axes[0].text(150, 3e-11, "time by which\nit is ahead ($\\sqrt{R/g}$)", color=BLUE, **middle)
    axes[0].text(150, 8e-16, "energy (relative)", color=ORANGE, **middle)
    ticks = 10.0 ** np.arange(3, np.log10(n[-1]) + 1e-9)
    for ax in axes:
        ax.set(xticks=ticks, xlim=(100, 3 * n[-1]), ylim=(3e-17, 1e-4))
    axes[0].set_ylabel("error", size=18)
    figure.supxlabel("steps of RK4, each of $10^{-3}\\,\\sqrt{R/g}$", size=18)
    figure.suptitle("The error of the energy says little about that of the motion", size=23)
    saved(figure, path, dpi=150)
    plt.close(figure)


def _said(number):
    return f"{number:.1e}".replace("e-0", "e-")


def _beside(colour):
    return {"textcoords": "offset points", "ha": "right", "size": 18, "color": colour}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=150.0)
    parser.add_argument("--steps", type=float, default=1e8)
    parser.add_argument("--draw", action="store_true")
    args = parser.parse_args()
    path = ROOT / "docs" / "benchmarks.md"
    if args.draw:
        rows = report.read(path.read_text("utf-8"))
    else:
        rows = report.measure(args.seconds, reference=str(ROOT / "tests" / "reference" / "motion.csv"))
    report.figure(rows, ROOT / "docs" / "figures" / "speed_against_error.png")
    curves = long_run(int(args.steps))
    draw(curves, ROOT / "docs" / "figures" / "long_run.png")
    if args.draw:
        return
    text = report.table(rows)
    told = (
        f"{name}: relative error of the energy | {name}: error of the phase (sqrt(R/g))" for name in curves
    )
    lines = [LONG, "", "| number of steps | " + " | ".join(told) + " |"]
    lines.append("| --- |" + " --- | --- |" * len(curves))
    for k in range(3, int(np.log10(args.steps)) + 1):
        cells = []
        for n, energy, phase, _ in curves.values():
            i = np.abs(n - 10**k).argmin()
            cells.append(f"{energy[i]:.1e} | {phase[i]:.1e}".replace("0.0e+00", "0"))
        lines.append(f"| 1e{k} | " + " | ".join(cells) + " |")
    section = BEGIN + "\n" + text + "\n" + "\n".join(lines) + "\n\n" + END
    path.write_text(
        re.sub(re.escape(BEGIN) + ".*" + re.escape(END), lambda _: section, path.read_text(), flags=re.S)
    )
    print(section)


if __name__ == "__main__":
    main()
