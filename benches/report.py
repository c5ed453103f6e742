"""Speed and error on this machine: computing time and accuracy of a trajectory for every method.

The error of a final state is its distance from the exact solution (the largest difference of its four
numbers) plus the estimated error of the exact solution. With a file of high-precision motions
(tests/reference/motion.csv), the exact solution is compared with those. `benchmarks.py` writes the result into the docs.

python benches/report.py [--seconds 60] [--figure PATH]
"""

import argparse
import csv
import math
import re
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._input.numbers import Floats
from spincyl._roll import roll
from spincyl._state import State
from spincyl._swing import swing

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_TARGETS = (1e-6, 1e-9, 1e-12)
#: the sentences above the tables
EXACT = """\
Each row is a scene, computed by the exact solution up to the time t. The scenes are a tube near its steady state, a cylinder and Euler's disk that nod, a can that rocks from side to side,
a cylinder of the critical aspect ratio, and a cylinder that slowly leaves an unstable steady state, which is a saddle point (the "slow saddle"). Errors are in natural units."""
EACH = """\
The next table has the time in which each method computes one of these scenes up to the time t with an error of the final state below the allowed error; "-" means that
no step or tolerance of the method reaches this error."""
LISTS = (
    "The lists below have the points of the curves of time against error. Each point has the step or the tolerance,"
    " the time to compute the motion, and the error of the final state."
)
COSTS = (
    "Each row is a set of outputs, with the time that RK4 with a fixed step takes for one step of a rolling cylinder"
    " to compute them, if only the last state or the state after every step is returned:"
)
#: heads of the columns with the times of a method
TIMES = {
    "RK4, fixed step": "time of RK4 with a fixed step",
    "steps within tol": "time of RK4 with steps within a tolerance",
    "SciPy DOP853": "time of SciPy's DOP853",
}


class Scene(NamedTuple):
    """A motion whose computation is measured: body, initial state, and last time in sqrt(R/g)."""

    name: str
    body: Body
    start: State
    t: float


class Point(NamedTuple):
    """Measurement of one method: its step or tolerance, seconds per trajectory, error of the final state."""

    setting: float
    seconds: float
    error: float


@dataclass(frozen=True)
class Row:
    """Measurements of one scene: points for each method, and times and errors of the exact solution."""

    scene: Scene
    curves: dict[str, list[Point]]  #: points of each method, from coarse to fine
    exact_seconds: float  #: exact solution: seconds per state, in a call for 1000 states
    call_seconds: float  #: exact solution: seconds of a call for the final state
    claimed: float  #: estimated error of the exact solution
    true: float | None  #: its true error, if a high-precision motion is known


def scenes() -> list[Scene]:
    """Return the scenes of the report: easy, fast, nearly flat, near an unstable steady state, long."""
    tube, can = Body.tube(6.0, 0.8), Body.solid(1.0)
    disk, critical = Body.solid(0.17043941411451397), Body.solid(math.sqrt(0.75))
    nutating = can.steady(0.5).kicked(0.3)
    # at theta0 of a body with I1 = I3 every rate is a steady state
    turning = critical.circular(critical.theta_balance, 1.5 / math.sqrt(critical.i3)).kicked(0.05)
    return [
        Scene("near-steady tube", tube, tube.steady(math.radians(85)).kicked(0.05), 20.0),
        Scene("nutating cylinder", can, nutating, 20.0),
        Scene("Euler's disk", disk, disk.steady(0.2).kicked(0.02), 20.0),
        Scene("rocking can", can, State(0.3, 1.3e-3, 0.0, 0.0), 2.0),
        Scene("critical aspect", critical, turning, 20.0),
        Scene("slow saddle", can, State(math.pi / 4 - 1e-3, 0.02, 0.0, 0.0), 8.0),
        Scene("nutating cylinder", can, nutating, 1e4),
    ]


def measure(
    seconds: float = 60.0,
    *,
    reference: str | None = None,
) -> list[Row]:
    """Measure the computing time and the error of all methods for all scenes.

    Parameters
    ----------
    seconds : float
        Approximate running time, in seconds.
    reference : str, optional
        Path of a CSV file with high-precision motions. Default: the true error of the exact solution is not
        measured.

    Returns
    -------
    list of Row
        Measurements of each scene.
    """
    known = _references(reference) if reference else {}
    found = [known.get((scene.name, scene.t), (scene, None)) for scene in scenes()]
    budget = seconds / (4 * len(found))
    return [_row(scene, budget, end) for scene, end in found]


def _row(scene: Scene, budget: float, known: Floats | None) -> Row:
    body, start, t = scene.body, scene.start, scene.t

    def final(**how: Any) -> Floats:
        y: Floats = roll(body, start, t, beyond=True, **how).y[:, -1]
        return y

    exact = roll(body, start, t, beyond=True)
    end, claimed = exact.y[:, -1], exact.error
    times = np.linspace(0.0, t, 1001)[1:]
    once = _best(lambda: final(), 0.2 * budget)
    many = _best(lambda: roll(body, start, times, beyond=True), 0.2 * budget)
    true = None if known is None else _distance(end, known)

    def error(y: "ArrayLike") -> float:
        return _distance(np.asarray(y), end) + claimed

    fastest = max(
        float(np.abs(roll(body, start, times, want="pose").w).max()), 2 * np.pi / swing(body, start).period
    )
    largest = 0.3 / max(fastest, _fastest_turn(body, start, times))
    curves = {
        "RK4, fixed step": _curve(
            (largest * 2.0**-k for k in range(14)), lambda h: final(step=h), error, budget
        ),
        "steps within tol": _curve(
            (10.0**-k for k in np.arange(3, 13.6, 0.75)), lambda tol: final(tol=tol), error, budget
        ),
    }
    try:
        from scipy.integrate import solve_ivp
    except ImportError:
        return Row(scene, curves, many / times.size, once, claimed, true)
    rate = _rate(body)

    def dop853(tol: float) -> Floats:
        solved = solve_ivp(
            rate,
            (0.0, t),
            [start.theta, start.w1, start.w2, start.w3],
            method="DOP853",
            rtol=tol,
            atol=tol,
        )
        y: Floats = solved.y[:, -1]
        return y

    curves["SciPy DOP853"] = _curve((10.0**-k for k in np.arange(4, 13.1, 1.0)), dop853, error, budget)
    return Row(scene, curves, many / times.size, once, claimed, true)


def costs(steps: int = 20_000) -> list[tuple[str, float, float]]:
    """Measure the nanoseconds per RK4 step.

    Each row has the name of the outputs, the time if only the last state is returned, and the time if every
    state is returned.
    """
    scene = scenes()[1]
    last = steps * 1e-3
    every = np.arange(steps + 1) * 1e-3
    wants: dict[str, tuple[str, ...]] = {
        "no others": (),
        "poses": ("pose",),
        "contact forces": ("force",),
        "poses and contact forces": ("pose", "force"),
    }
    # take turns, so that other load on the machine affects all of them
    best = {name: [math.inf, math.inf] for name in wants}
    for _ in range(12):
        for name, want in wants.items():
            for i, times in enumerate((last, every)):
                run = partial(roll, scene.body, scene.start, times, t0=0.0, step=1e-3, want=want)
                best[name][i] = min(best[name][i], _best(run, 0.0))
    return [(name, *(1e9 * t / steps for t in best[name])) for name in wants]  # type: ignore[misc]


def _fastest_turn(body: Body, start: State, times: Floats) -> float:
    found = roll(body, start, times, beyond=True)
    return float(np.abs(found.states.precession).max())


def _rate(body: Body) -> Callable[[float, Floats], list[float]]:
    """The equations of motion as a user of SciPy would write them."""
    ell, i1, i3 = float(body.ell), float(body.i1), float(body.i3)
    j, d = i1 + 1 + ell**2, i1 * i3 + i1 + i3 * ell**2

    def rate(_: float, y: Floats) -> list[float]:
        theta, w1, w2, w3 = y.tolist()
        s, c = math.sin(theta), math.cos(theta)
        ct = c / s
        tilt = (
            -(i1 + ell**2) * ct * w1**2 - ell * w1**2 + (i3 + 1) * w1 * w3 + ell * ct * w1 * w3 + c - ell * s
        )
        return [
            -w2,
            w2 * (ct * w1 + i3 * ell / d * w1 - i3 * (i3 + 1) / d * w3),
            tilt / j,
            -w2 * (i1 * w1 + i3 * ell * w3) / d,
        ]

    return rate


def _distance(a: Floats, b: Floats) -> float:
    return float(np.abs(a - b).max())


def _best(run: Callable[[], object], budget: float) -> float:
    """Shortest time of the runs that fit in the budget, at least two."""
    return _best_of(run, budget)[0]


def _best_of(run: Callable[[], Any], budget: float) -> tuple[float, int, Any]:
    """Shortest time of a run, the number of runs, and the result of a run."""
    best, spent, count = math.inf, 0.0, 0
    while True:
        begun = time.perf_counter()
        found = run()
        took = time.perf_counter() - begun
        best, spent, count = min(best, took), spent + took, count + 1
        if count == 1000 or (count >= 2 and spent > budget):
            return best, count, found


def _curve(
    settings: Iterable[float],
    run: Callable[[float], Floats],
    error: Callable[["ArrayLike"], float],
    budget: float,
) -> list[Point]:
    """Points from coarse to fine settings, as long as the next one fits in the budget.

    The shortest time of a point counts, so that brief load on the machine does not end the curve.
    """
    import warnings

    points: list[Point] = []
    spent = 0.0
    for setting in settings:
        if len(points) >= 2 and spent + 4 * points[-1].seconds > budget:
            break
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                took, count, end = _best_of(partial(run, setting), 0.02 * budget)
            except ValueError:  # the step is too large
                continue
        spent += took * count
        points.append(Point(float(setting), took, error(end)))
    return points


def _references(path: str) -> dict[tuple[str, float], tuple[Scene, Floats]]:
    """Rolling motions of the three-dimensional model by scene and time: initial and final state."""
    found = {}
    with open(path, encoding="utf-8", newline="") as file:
        for kind, name, contact, *numbers in csv.reader(file):
            if kind == "state" and contact == "rolling":
                ell, i1, i3, *start, t = (float.fromhex(x) for x in numbers[:8])
                end = np.array([float.fromhex(x) for x in numbers[8:12]])
                name = name.removesuffix(" 1e-3")
                found[name, t] = Scene(name, Body(ell, i1, i3), State(*start), t), end
    return found


def _at(points: list[Point], target: float) -> str:
    """Time of the fastest setting whose error is below the target."""
    good = [p.seconds for p in points if p.error <= target]
    return _time(min(good)) if good else "-"


def _time(seconds: float) -> str:
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def table(rows: list[Row]) -> str:
    """Return Markdown: a table of all scenes, the points of all curves, and the cost of each output."""
    head = [
        "scene",
        "t (sqrt(R/g))",
        "true error of the final state",
        "estimated error",
        "time of one call",
        "time of one more state",
    ]
    lines = [EXACT, "", "| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    for row in rows:
        true = "-" if row.true is None else f"{row.true:.1e}"
        cells = [row.scene.name, f"{row.scene.t:g}", true, f"{row.claimed:.1e}"]
        cells += [_time(row.call_seconds), _time(row.exact_seconds)]
        lines.append("| " + " | ".join(cells) + " |")
    head = ["scene", "t (sqrt(R/g))", "largest error allowed", *(TIMES.get(x, x) for x in rows[0].curves)]
    lines += [
        "",
        EACH,
        "",
    ]
    lines += ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    for row in rows:
        for target in _TARGETS:
            cells = [row.scene.name, f"{row.scene.t:g}", f"{target:g}"]
            cells += [_at(row.curves.get(name, []), target) for name in rows[0].curves]
            lines.append("| " + " | ".join(cells) + " |")
    lines += [
        "",
        LISTS,
        "",
    ]
    for row in rows:
        lines.append(f"{row.scene.name}, t = {row.scene.t:g}")
        lines.append("")
        for name, points in row.curves.items():
            listed = "; ".join(f"{p.setting:.2g}: {_time(p.seconds)}, {p.error:.1e}" for p in points)
            lines.append(f"- {name}: {listed}")
        lines.append("")
    lines += [
        COSTS,
        "",
        "| outputs besides the states | time per step if only the last state is returned (ns)"
        " | time per step if every state is returned (ns) |",
        "| --- | --- | --- |",
    ]
    lines += [f"| {name} | {last:.0f} | {every:.0f} |" for name, last, every in costs()]
    lines.append("")
    return "\n".join(lines)


def read(text: str) -> list[Row]:
    """Return the rows that `table` has written, with the digits that it has."""
    lines = text.splitlines()
    head = next(k for k, line in enumerate(lines) if line.startswith("| scene | t ("))
    cells = [[cell.strip() for cell in line.strip("| ").split(" | ")] for line in lines[head + 2 :]]
    known = {(scene.name, scene.t): scene for scene in scenes()}
    rows = []
    for name, last, true, claimed, call, more, *_ in takewhile(lambda found: len(found) > 1, cells):
        begun = lines.index(f"{name}, t = {last}") + 2
        curves = {}
        for line in takewhile(lambda line: line.startswith("- "), lines[begun:]):
            method, points = line[2:].split(": ", 1)
            found = (re.fullmatch(r"(\S+): (.*), (\S+)", point) for point in points.split("; "))
            curves[method] = [Point(float(x[1]), _seconds(x[2]), float(x[3])) for x in found if x]
        scene = known[name, float(last)]
        worth = None if true == "-" else float(true)
        rows.append(Row(scene, curves, _seconds(more), _seconds(call), float(claimed), worth))
    return rows


def _seconds(time: str) -> float:
    """Inverse of `_time`."""
    number, unit = time.split()
    return float(number) * {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "ns": 1e-9}[unit]


def figure(rows: list[Row], path: Path) -> bool:
    """Draw time against error for the nutating cylinder, a panel for each duration; False without matplotlib."""
    try:
        import matplotlib
    except ImportError:
        return False
    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    from spincyl.studio.plot._style import BLACK, BLUE, GREEN, ORANGE, saved

    # colour, name, and its offset in points from the last point
    style: dict[str, tuple[str, str, tuple[int, int]]] = {
        "RK4, fixed step": (BLUE, "RK4", (10, -16)),
        "steps within tol": (GREEN, "steps within\na tolerance", (12, -16)),
        "SciPy DOP853": (ORANGE, "SciPy DOP853", (10, 2)),
    }
    drawn = [row for row in rows if row.scene.name == "nutating cylinder"] or rows[:1]
    figure, axes = plt.subplots(
        1, len(drawn), figsize=(12.8, 7.2), layout="constrained", squeeze=False, sharex=True, sharey=True
    )
    for ax, row in zip(axes.flat, drawn, strict=True):
        for name, points in row.curves.items():
            colour, words, beside = style[name]
            best = _useful(points)
            ax.loglog([p.error for p in best], [p.seconds for p in best], "o-", color=colour, lw=2.5, ms=6)
            how = {"textcoords": "offset points", "size": 18, "color": colour}
            ax.annotate(words, (best[-1].error, best[-1].seconds), beside, **how)
        worth = row.claimed if row.true is None else max(row.true, 1e-17)
        ax.loglog(worth, row.call_seconds, "*", color=BLACK, ms=24)
        below: dict[str, Any] = {"textcoords": "offset points", "ha": "center", "size": 18}
        ax.annotate("exact solution", (worth, row.call_seconds), (0, -36), **below)
        ax.set_title(f"motion up to $t = {row.scene.t:,.0f}$", size=19, pad=12)
        ax.tick_params(labelsize=16)
        ax.spines[["top", "right"]].set_visible(False)
    axes[0, 0].set(xlim=(10, 1e-20), ylim=(3e-6, 3), xticks=10.0 ** np.arange(0, -16, -5))
    axes[0, 0].set_ylabel("time of a motion (s)", size=18)
    figure.supxlabel("error of the final state (right: more exact)", size=18)
    told = [f"{1e6 * row.call_seconds:.0f} µs up to $t = {row.scene.t:,.0f}$" for row in drawn]
    figure.suptitle(f"The exact solution takes {' and '.join(told)}", size=23)
    saved(figure, path, dpi=150)
    plt.close(figure)
    return True


def _useful(points: list[Point]) -> list[Point]:
    """The points from fast to slow without those that a faster one of the same method beats in error."""
    found: list[Point] = []
    for point in sorted(points, key=lambda p: p.seconds):
        if not found or point.error < 0.95 * found[-1].error:
            found.append(point)
    return found


def main() -> None:
    """Print the report, and draw it if a path is given."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--figure", type=Path)
    args = parser.parse_args()
    rows = measure(args.seconds, reference=str(Path(__file__).parents[1] / "tests/reference/motion.csv"))
    print(table(rows))
    if args.figure:
        figure(rows, args.figure)


if __name__ == "__main__":
    main()
