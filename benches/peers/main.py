"""spincyl beside NumPy, numba, SciPy and heyoka, whichever are installed, in one run: speed, error and ratios.

    python benches/peers/main.py [--also PYTHON ...] [--docs]

`--also`: other interpreters whose numba takes part (one with Intel's SVML: numba 0.61.2 and intel-cmplr-lib-rt).
`--docs`: rewrites the section on sweeps of docs/benchmarks.md, and its figure. Times are minima; ensembles run on one
thread, at t = 20; errors are those of a sixty-fourth of the motions, against heyoka in 80-bit arithmetic.
"""

import argparse
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
import heyoka_jobs
from map import error as map_error
from map import numpy_rows
from scene import T, axes, best, coefficients, ensemble, errors, points

import spincyl as sc

ROOT = pathlib.Path(__file__).parents[2]
BEGIN, END = "<!-- written by benches/peers/main.py -->\n", "<!-- end of peers -->\n"
EVERY = 64
KICKS = {0.05: "near-steady, kick 0.05", 0.4: "wide, kick 0.4", 0.8: "very wide, kick 0.8"}


def has(name):
    return importlib.util.find_spec(name) is not None


def numba_lines(also):
    """What numba says in each interpreter, by its SVML."""
    found = []
    for python in ([sys.executable] if has("numba") else []) + also:
        script = pathlib.Path(__file__).with_name("numba_jobs.py")
        library = pathlib.Path(python).parents[1] / "lib"
        path = f"{library}:{os.environ.get('LD_LIBRARY_PATH', '')}"
        said = subprocess.run(
            [python, script],
            capture_output=True,
            text=True,
            check=True,
            env=os.environ | {"LD_LIBRARY_PATH": path},
        )
        found += [json.loads(line) for line in said.stdout.splitlines()]
    return found


def map_rows(numba):
    """Rows (job, contestant, threads, ns, error) of the map, the points and the answers without a map."""
    theta, ell = axes()
    at, of = points()
    flat, out = {"rate": np.empty(at.size)}, np.empty((theta.size, ell.size))
    result = sc.sweep.portrait(theta, ell, want=["rate"])
    single = sc.sweep.portrait(theta, ell, want=["rate"], dtype="float32")
    jobs = {
        ("grid", "fill with a constant"): lambda n: out.fill(1.0),
        ("grid", "NumPy in place"): lambda n: numpy_rows(theta, ell, out, 0, theta.size),
        ("grid", "spincyl"): lambda n: sc.sweep.portrait(theta, ell, want=["rate"], out=result, threads=n),
        ("grid", "spincyl, float32"): lambda n: sc.sweep.portrait(
            theta, ell, want=["rate"], out=single, dtype="float32", threads=n
        ),
        ("no map", "areas of the regions"): lambda n: sc.sweep.survey(theta, ell, threads=n),
        ("no map", "extrema of the rate"): lambda n: sc.sweep.survey(theta, ell, want="rate", threads=n),
        ("points", "read two, write one"): lambda n: np.add(at, of, out=flat["rate"]),
        ("points", "spincyl"): lambda n: sc.sweep.points(at, of, out=flat, threads=n),
    }
    rows = []
    for (job, name), run in jobs.items():
        for n in (1, 2) if name.startswith(("spincyl", "ext")) else (1,):
            rows.append((job, name, n, best(lambda: run(n)) / out.size * 1e9))  # noqa: B023
    for x in numba:
        if x["job"] in ("grid", "scattered"):
            job = {"grid": "grid", "scattered": "points"}[x["job"]]
            rows.append((job, f"numba {x['version']}, {x['svml']}", x["threads"], x["ns"]))
    told = map_error(result["rate"].to_numpy(), theta, ell)
    return rows, told


def spincyl_curve(ell, start, tolerances, **how):
    """(tolerance, microseconds a motion, final states, claimed, method) for each."""
    body, state = sc.Body.solid(ell if not np.all(ell == ell[0]) else ell[0]), sc.State(*start.T)
    for tol in tolerances:
        job = {"tol": tol} | how

        def run(job=job):
            return sc.sweep.roll(body, state, T, beyond=True, threads=job.pop("threads", 1), **job)

        seconds, found = best(lambda run=run: run(dict(job))), run(dict(job))  # noqa: B023
        states = np.stack([found[k].to_numpy() for k in ("theta", "w1", "w2", "w3")], axis=1)
        yield (
            tol,
            seconds / start.shape[0] * 1e6,
            states,
            found["error"].to_numpy(),
            found["method"].to_numpy(),
        )


def scipy_points(ell, start, tolerances, count=16):
    from scipy.integrate import solve_ivp

    some = np.arange(0, ell.size, EVERY)[:count]
    of = coefficients(ell)

    def rate(t, y, k):
        theta, w1, w2, w3 = y
        s, c = np.sin(theta), np.cos(theta)
        ct = c / s
        turn = ct * (k[4] * w3 - k[3] * w1) + k[5] * w3 - k[4] * w1
        return (
            -w2,
            w2 * (ct * w1 + k[0] * w1 - k[1] * w3),
            w1 * turn + k[6] * c - k[4] * s,
            -w2 * (k[2] * w1 + k[0] * w3),
        )

    for tol in tolerances:

        def run(tol=tol):
            return [
                solve_ivp(rate, (0, T), start[i], "DOP853", rtol=tol, atol=tol, args=(of[:, i],)).y[:, -1]
                for i in some
            ]

        yield tol, best(run, rounds=2) / some.size * 1e6, np.array(run())


def motion_rows(numba):
    """Curves {kick: {contestant: [(setting, us, max, 99 %)]}}, and tables of methods."""
    curves, shares = {}, []
    for kick, name in KICKS.items():
        ell, start = ensemble(kick)
        some = slice(None, None, EVERY)
        truth = heyoka_jobs.reference(np, ell[some], start[some])
        found = curves.setdefault(kick, {})
        kept = found.setdefault("spincyl", [])
        for tol, us, states, claimed, method in spincyl_curve(
            ell, start, (1e-3, 1e-5, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13)
        ):
            kept.append((tol, us, *errors(states[some], truth)))
            off = np.abs(states[some] - truth).max(axis=1)
            if tol in (1e-6, 1e-10, 1e-13):
                share = np.bincount(method, minlength=5) / method.size
                shares.append(
                    (
                        name,
                        tol,
                        share[1],
                        share[2],
                        share[3],
                        np.quantile(off, 0.99),
                        off.max(),
                        np.quantile(claimed, 0.99),
                        claimed.max(),
                        (off / claimed[some]).max(),
                    )
                )
        for step in (0.1, 0.02, 0.01):
            (_, us, states, *_rest), *_ = spincyl_curve(ell, start, (1e-10,), step=step)
            found.setdefault("spincyl RK4", []).append((step, us, *errors(states[some], truth)))
        for tol, us, states in heyoka_jobs.curve(
            np, ell[::8], start[::8], (1e-4, 1e-6, 1e-8, 3e-10, 1e-12, 1e-13, 1e-15)
        ):
            found.setdefault("heyoka", []).append((tol, us, *errors(states[:: EVERY // 8], truth)))
        if has("scipy"):
            for tol, us, states in scipy_points(ell, start, (1e-6, 1e-9, 1e-12)):
                found.setdefault("SciPy DOP853", []).append((tol, us, *errors(states, truth[: len(states)])))
        for x in numba:
            if x["job"] == "rk4" and x["kick"] == kick and x["svml"] == numba[0]["svml"]:
                states = np.load(x["states"])
                found.setdefault("numba RK4", []).append((x["h"], x["us"], *errors(states[some], truth)))
    ell, start = ensemble(0.05, one_body=True)
    truth = heyoka_jobs.reference(np, ell[::EVERY], start[::EVERY])
    for tol, us, states, *_ in spincyl_curve(ell, start, (1e-6, 1e-10)):
        curves.setdefault("one", {}).setdefault("spincyl", []).append(
            (tol, us, *errors(states[::EVERY], truth))
        )
    for tol, us, states in heyoka_jobs.curve(np, ell[::8], start[::8], (1e-6, 3e-10)):
        curves["one"].setdefault("heyoka", []).append((tol, us, *errors(states[:: EVERY // 8], truth)))
    return curves, shares


def cost_at(points, error):
    """Microseconds of the cheapest setting whose largest error is at most `error`."""
    fit = [us for _, us, worst, _ in points if worst <= error]
    return min(fit) if fit else float("nan")


def scaling():
    """Nanoseconds a point or motion, by their number, and by threads."""
    rows = []
    for count in (10**4, 10**5, 10**6, 10**7, 10**8):
        at, of = np.resize(points(10**6)[0], count), np.resize(points(10**6)[1], count)
        flat = {"rate": np.zeros(count)}
        ns = [
            best(lambda: sc.sweep.points(at, of, out=flat, threads=n), rounds=5) / count * 1e9  # noqa: B023
            for n in (1, 2)
        ]
        rows.append(("scattered points", count, *ns))
    for count in (2**14, 2**17, 2**20):
        ell, start = ensemble(0.05, count)
        body, state = sc.Body.solid(ell), sc.State(*start.T)
        ns = [
            best(lambda: sc.sweep.roll(body, state, T, beyond=True, threads=n), rounds=4) / count * 1e9  # noqa: B023
            for n in (1, 2)
        ]
        rows.append(("motions", count, *ns))
    return rows


def calls():
    """Single calls from Python: one exact motion, one rate, one sine; microseconds."""
    body = sc.Body.solid(2.5)
    state = body.steady(1.3).kicked(0.05)
    times = np.array([0.0, 20.0])

    def many(run, n):
        return best(lambda: [run() for _ in range(n)]) / n * 1e6

    return {
        "one exact motion to t = 20": many(lambda: sc.roll(body, state, times), 200),
        "body.rate(theta)": many(lambda: body.rate(1.3), 2000),
        "np.sin(x)": many(lambda: np.sin(1.3), 2000),
    }


def figure(curves, path):
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    kicks = [0.05, 0.4]
    drawn, panels = plt.subplots(1, 2, figsize=(13, 5.4), layout="constrained", sharey=True)
    looks = {
        "spincyl": ("#0072b2", "o-"),
        "spincyl RK4": ("#56b4e9", "s--"),
        "heyoka": ("#d55e00", "^-"),
        "numba RK4": ("#009e73", "v--"),
        "SciPy DOP853": ("#777777", "d-"),
    }
    for ax, kick in zip(panels, kicks, strict=True):
        for name, rows in curves[kick].items():
            colour, style = looks[name]
            x, y = zip(*[(max(worst, 1e-16), us) for _, us, worst, _ in rows if worst < 1], strict=True)
            ax.loglog(x, y, style, color=colour, label=name, markersize=6)
        ax.set_title(KICKS[kick], fontsize=14)
        ax.set_xlabel("largest error of a final state, t = 20", fontsize=13)
        ax.invert_xaxis()
        ax.grid(alpha=0.3)
    panels[0].set_ylabel("microseconds a motion, one thread", fontsize=13)
    panels[0].legend(fontsize=12, loc="center right", bbox_to_anchor=(1.0, 0.58))
    drawn.savefig(path, dpi=110)
    plt.close(drawn)


def tables(maps, told, curves, shares, sizes, single):
    """The section of the docs."""
    lines = ["| job | contestant | threads | ns a point |", "| --- | --- | --- | --- |"]
    lines += [f"| {job} | {name} | {n} | {ns:.3g} |" for job, name, n, ns in maps]
    lines += [
        "",
        f"Error of spincyl's map: {told[0]:.2f} at most, {told[1]:.2f} for 99 % (ulp over 1 + kappa_c).",
        "",
    ]
    lines += [
        "| ensemble | contestant | setting | us a motion | error max | error 99 % |",
        "| --- " * 6 + "|",
    ]
    for kick, found in curves.items():
        name = KICKS.get(kick, "one body, kick 0.05")
        for who, rows in found.items():
            lines += [f"| {name} | {who} | {s:g} | {us:.3g} | {a:.1e} | {b:.1e} |" for s, us, a, b in rows]
    lines += ["", "| ensemble | error at most | spincyl us | heyoka us | ratio |", "| --- " * 5 + "|"]
    for kick in (*KICKS, "one"):
        for error in (1e-6, 1e-10, 1e-12):
            mine, other = (cost_at(curves[kick][who], error) for who in ("spincyl", "heyoka"))
            if mine == mine and other == other:
                name = KICKS.get(kick, "one body, kick 0.05")
                lines.append(f"| {name} | {error:g} | {mine:.3g} | {other:.3g} | {other / mine:.0f} |")
    head = "| ensemble | tol | in lanes | alone | RK4 | true error 99 % | max | claimed 99 % | max | true/claimed, worst |"
    lines += ["", head, "| --- " * 10 + "|"]
    lines += [
        f"| {n} | {tol:g} | {a:.4f} | {b:.4f} | {c:.4f} | " + " | ".join(f"{x:.1e}" for x in rest) + " |"
        for n, tol, a, b, c, *rest in shares
    ]
    lines += ["", "| job | number | ns each, 1 thread | 2 threads | ratio |", "| --- " * 5 + "|"]
    lines += [f"| {job} | {n:.3g} | {a:.3g} | {b:.3g} | {a / b:.2f} |" for job, n, a, b in sizes]
    lines += ["", "| one call from Python | us |", "| --- | --- |"]
    lines += [f"| {name} | {us:.3g} |" for name, us in single.items()]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--also", nargs="*", default=[], metavar="PYTHON")
    parser.add_argument("--docs", action="store_true")
    args = parser.parse_args()
    if not has("heyoka"):
        sys.exit("the reference of all errors needs heyoka: pip install heyoka")
    numba = numba_lines(args.also)
    maps, told = map_rows(numba)
    curves, shares = motion_rows(numba)
    text = tables(maps, told, curves, shares, scaling(), calls())
    print(text)
    if args.docs:
        figure(curves, ROOT / "docs" / "figures" / "peers.png")
        path = ROOT / "docs" / "benchmarks.md"
        section = BEGIN + "\n" + text + "\n" + END
        path.write_text(
            re.sub(re.escape(BEGIN) + ".*" + re.escape(END), lambda _: section, path.read_text(), flags=re.S)
        )


if __name__ == "__main__":
    main()
