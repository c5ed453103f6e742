"""Times of single calls from Python: one rate beside one sine, one motion to t = 20 beside integrators, and
sweeps."""

import subprocess
import sys

import heyoka_jobs
import numpy as np
import scipy_jobs
from clock import alternate, compared, has, table
from scene import T, ensemble, errors, points

import spincyl as sc

MANY = 200
#: the sentences above the second and the third table
FIRST_HEAD = (
    "The next table has the CPU time of the import of spincyl, and of the first and second call of two functions,"
    " in a new Python process:"
)
SCALING_HEAD = (
    "The next table shows how the time of a sweep depends on its size, for rates at scattered points"
    " (`sc.sweep.points`) and for motions to t = 20 (`sc.sweep.roll`), on one and on two threads."
)


def repeated(run, n=MANY):
    """A job that calls `run` n times, long enough for the clock."""

    def many():
        for _ in range(n - 1):
            run()
        return run()

    return many


def measure(quick):
    body = sc.Body.solid(2.5)
    begin = body.steady(1.3).kicked(0.05)
    times, ell = np.array([0.0, T]), np.array([2.5])
    start = np.array([[float(getattr(begin, name)) for name in ("theta", "w1", "w2", "w3")]])
    truth = heyoka_jobs.reference(ell, start)
    jobs = {
        ("`np.sin(x)`, a sine in NumPy", ""): lambda: np.sin(1.3),
        ("`body.rate(theta)`, a rate", ""): lambda: body.rate(1.3),
        ("spincyl, one motion", "exact solution"): lambda: sc.roll(body, begin, times),
        ("spincyl, one motion with poses and contact forces", "exact solution"): lambda: sc.roll(
            body, begin, times, want=("pose", "force")
        ),
        ("spincyl RK4, one motion", "step 0.02"): lambda: sc.roll(body, begin, times, step=0.02),
    }
    for tol in (1e-6, 1e-10, 1e-12, 1e-15):
        jobs["heyoka, one motion", f"tolerance {tol:g}"] = heyoka_jobs.alone(ell, start, tol)
    if has("scipy"):
        for tol in (1e-6, 1e-9, 1e-12):
            jobs["SciPy DOP853, one motion", f"tolerance {tol:g}"] = scipy_jobs.finals(ell, start, tol)
    counts = {who: 5 if who[0].startswith("SciPy") else MANY for who in jobs}
    least, found = alternate(
        {who: repeated(run, counts[who]) for who, run in jobs.items()}, 3 if quick else 20, 1.0
    )
    rows, shown = [], {}
    for (who, setting), seconds in least.items():
        us = seconds / counts[who, setting] * 1e6
        told, off = found[who, setting], None
        if hasattr(told, "y"):
            told = np.array([[told.y[i][-1] for i in range(4)]])
        if isinstance(told, np.ndarray):
            off = errors(told, truth)[0]
            shown.setdefault(who, []).append((setting, us, max(off, 1e-16)))
        rows.append((who, setting, us, off))
    text = table(
        (
            "call from Python",
            "tolerance, step of RK4 in sqrt(R/g), or method",
            "time of one call (µs)",
            "error of the state at t = 20 (natural units)",
        ),
        rows,
    )
    sine, rate = (
        next(us for who, _, us, _ in rows if who.startswith(name)) for name in ("`np.sin", "`body.rate")
    )
    text += f"\n`body.rate(theta)` takes {rate / sine:.1f} times as long as `np.sin(x)`.\n\n"
    text += FIRST_HEAD + "\n\n"
    text += table(("call in a new process", "CPU time (s)"), first_calls()) + "\n"
    text += SCALING_HEAD + "\n\n"
    text += table(
        (
            "computation",
            "number of points or motions",
            "time per point or motion on 1 thread (ns)",
            "time per point or motion on 2 threads (ns)",
            "time on 1 thread over time on 2 threads",
        ),
        scaling(quick),
    )
    best = compared("a single motion", shown, (1e-6, 1e-10, 1e-12), "µs")
    return {"text": text, "best": best}


FIRST = """
import time
began = time.process_time()
import spincyl as sc
body = sc.Body.solid(2.5)
at = [time.process_time()]
for job in (sc.roll, sc.roll, sc.sweep.roll, sc.sweep.roll):
    job(body, body.steady(1.3).kicked(0.05), 20.0)
    at.append(time.process_time())
print(*(after - before for before, after in zip([began, *at], at)))
"""


def first_calls():
    """Rows (what, CPU seconds) of a fresh process: the import, and the first and second call of each kind."""
    runs = [subprocess.run([sys.executable, "-c", FIRST], capture_output=True, check=True) for _ in range(3)]
    least = np.min([[float(x) for x in run.stdout.split()] for run in runs], axis=0)
    names = [f"{n} call of `sc.{name}`" for name in ("roll", "sweep.roll") for n in ("first", "second")]
    return [
        (name, f"{seconds:.3g}") for name, seconds in zip(["`import spincyl`", *names], least, strict=True)
    ]


def scaling(quick):
    """Rows (job, number, ns each on one thread, on two, their ratio)."""
    rows = []
    for count in (10**4, 10**6) if quick else (10**4, 10**5, 10**6, 10**7):
        at, of = (np.resize(x, count) for x in points(10**6))
        flat = {"rate": np.zeros(count)}
        jobs = {n: lambda n=n, a=at, o=of, f=flat: sc.sweep.points(a, o, out=f, threads=n) for n in (1, 2)}
        ns = [seconds / count * 1e9 for seconds in alternate(jobs, 5)[0].values()]
        rows.append(("rates at scattered points", f"{count:,}", *ns, ns[0] / ns[1]))
    for count in (2**14,) if quick else (2**14, 2**17, 2**20):
        ell, start = ensemble(0.05, count)
        body, state = sc.Body.solid(ell), sc.State(*start.T)
        jobs = {
            n: lambda n=n, b=body, y=state: sc.sweep.roll(b, y, T, beyond=True, threads=n) for n in (1, 2)
        }
        ns = [seconds / count * 1e9 for seconds in alternate(jobs, 5)[0].values()]
        rows.append(("motions", f"{count:,}", *ns, ns[0] / ns[1]))
    return rows


if __name__ == "__main__":
    print(measure(quick="--quick" in sys.argv)["text"])
