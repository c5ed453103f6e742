"""Job A: the rate on a grid of 4000 x 4000 points, and at 16 million scattered ones, into given arrays."""

import json
import os
import pathlib
import subprocess
import sys

import numpy as np
from clock import alternate, has, table
from map import error as ulps
from map import numpy_rows
from scene import axes, points

import spincyl as sc


def elsewhere(pythons):
    """The results of numba in other interpreters, which do not take part in the rounds."""
    found = []
    for python in pythons:
        library = pathlib.Path(python).parents[1] / "lib"
        path = f"{library}:{os.environ.get('LD_LIBRARY_PATH', '')}"
        said = subprocess.run(
            [python, pathlib.Path(__file__).with_name("numba_jobs.py")],
            capture_output=True,
            text=True,
            check=True,
            env=os.environ | {"LD_LIBRARY_PATH": path},
        )
        found += [json.loads(line) for line in said.stdout.splitlines()]
    return found


def numpy_points(at, of, out, rows=4096):
    """NumPy's best for scattered points: one sine and one cosine, in place, in pieces that stay in cache."""
    for i in range(0, at.size, rows):
        s, ell, x = np.sin(at[i : i + rows]), of[i : i + rows], out[i : i + rows]
        lever = ell * s
        np.cos(at[i : i + rows], out=x)
        below = (0.5 + 2 / 3 * ell * ell) * x
        below -= lever
        below *= s
        x -= lever
        x /= below
        np.sqrt(x, out=x)


def measure(quick, also=()):
    side = 500 if quick else 4000
    theta, ell = axes(side)
    at, of = points(side * side)
    out, flat = np.empty((side, side)), {"rate": np.empty(at.size)}
    double = sc.sweep.portrait(theta, ell, want=["rate"])
    single = sc.sweep.portrait(theta, ell, want=["rate"], dtype="float32")

    def grid(n, dtype="float64", into=double):
        return lambda: sc.sweep.portrait(theta, ell, want=["rate"], out=into, dtype=dtype, threads=n)

    jobs = {
        ("grid", "no rate: fill with a constant", 1): lambda: out.fill(1.0),
        ("grid", "NumPy in place", 1): lambda: numpy_rows(theta, ell, out, 0, side),
        ("grid", "spincyl", 1): grid(1),
        ("grid", "spincyl", 2): grid(2),
        ("grid", "spincyl, float32", 1): grid(1, "float32", single),
        ("grid", "spincyl, float32", 2): grid(2, "float32", single),
        ("grid, no map stored", "spincyl, areas of the regions", 1): lambda: sc.sweep.survey(
            theta, ell, threads=1
        ),
        ("grid, no map stored", "spincyl, areas of the regions", 2): lambda: sc.sweep.survey(
            theta, ell, threads=2
        ),
        ("grid, no map stored", "spincyl, extrema of the rate", 1): lambda: sc.sweep.survey(
            theta, ell, want="rate", threads=1
        ),
        ("grid, no map stored", "spincyl, extrema of the rate", 2): lambda: sc.sweep.survey(
            theta, ell, want="rate", threads=2
        ),
        ("points", "no rate: add two numbers", 1): lambda: np.add(at, of, out=flat["rate"]),
        ("points", "NumPy in place", 1): lambda: numpy_points(at, of, flat["rate"]),
        ("points", "spincyl", 1): lambda: sc.sweep.points(at, of, out=flat, threads=1),
        ("points", "spincyl", 2): lambda: sc.sweep.points(at, of, out=flat, threads=2),
    }
    rates = {"spincyl": double["rate"].to_numpy()}
    if has("numba"):
        import numba as nb
        import numba_jobs as by_numba

        name, a = f"numba {nb.__version__}, {by_numba.SVML}", 0.5 * (1 + 4 * ell * ell / 3)
        rates[name], other = np.empty((side, side)), np.empty(at.size)

        def compiled(job, n):
            def run():
                nb.set_num_threads(n)
                if job == "grid":
                    by_numba.grid(theta, ell, a, rates[name])
                else:
                    by_numba.scattered(at, of, other)

            return run

        jobs |= {(job, name, n): compiled(job, n) for job in ("grid", "points") for n in (1, 2)}
    with np.errstate(invalid="ignore"):
        least, _ = alternate(jobs, rounds=3 if quick else 9)
        numpy_rows(theta, ell, out, 0, side)
        rates["NumPy in place"] = out
        off = {who: tuple(map(float, ulps(rate, theta, ell))) for who, rate in rates.items()}
    rows = [(*job, seconds / out.size * 1e9) for job, seconds in least.items()]
    for x in elsewhere(also):
        if x["job"] in ("grid", "scattered"):
            job = {"grid": "grid", "scattered": "points"}[x["job"]]
            rows.append((job, f"numba {x['version']}, {x['svml']}", x["threads"], x["ns"]))
    text = table(
        (
            "points at which the rate is computed",
            "program (SVML: Intel's vectorised functions)",
            "number of threads",
            "time per point (ns)",
        ),
        sorted(
            (("scattered points" if job == "points" else job, *more) for job, *more in rows),
            key=lambda r: r[:2],
        ),
    )
    text += "\nErrors of the rates on the grid:\n\n" + table(
        (
            "program (SVML: Intel's vectorised functions)",
            "largest error of the rate over 1 + kappa_c (ulp)",
            "99 % of errors over 1 + kappa_c are below (ulp)",
        ),
        [(w, *e) for w, e in off.items()],
    )
    times = {(job, who, n): ns for job, who, n, ns in rows}
    best = []
    for job in ("grid", "points"):
        for n in (1, 2):
            peers = [(ns, who) for (j, who, k), ns in times.items() if j == job and k == n]
            peers = [x for x in peers if x[1].startswith(("numba", "NumPy"))]
            if peers:
                ns, who = min(peers)
                mine = times[job, "spincyl", n]
                where = "on a grid" if job == "grid" else "at scattered points"
                what = f"rates {where}, {n} thread" + "s" * (n > 1)
                best.append((what, None, f"{mine:.3g} ns", f"{ns:.3g} ns", who, ns / mine))
    return {"text": text, "best": best}


if __name__ == "__main__":
    print(measure(quick="--quick" in sys.argv)["text"])
