"""Job B: 65,536 motions that go on, near a steady state and far from it, to t = 20 on one thread."""

import sys
import time

import heyoka_jobs
import numpy as np
import scipy_jobs
from clock import alternate, compared, has, table
from scene import T, coefficients, ensemble, errors

import spincyl as sc

EVERY = 64
KICKS = {
    0.05: "small nutation, kick 0.05",
    0.4: "wide nutation, kick 0.4",
    0.8: "very wide nutation, kick 0.8",
}
#: the sentence above the second table
SHARES = """\
Each row is a set of motions and a tolerance of `spincyl`, with its true and its estimated errors in natural units. All motions start from steady states with a kick, in sqrt(g/R), added to theta';
"one body" means that all cylinders of the set are alike."""
TOLERANCES = (1e-3, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13)


def of_spincyl(ell, start, **how):
    body, state = sc.Body.solid(ell if np.ptp(ell) else ell[0]), sc.State(*start.T)
    return lambda: sc.sweep.roll(body, state, T, beyond=True, threads=1, **how)


def of_numba(ell, start, step):
    import numba as nb
    from numba_jobs import rk4

    k, found = coefficients(ell), np.empty_like(start)

    def run():
        nb.set_num_threads(1)
        rk4(k, start, step, round(T / step), found)
        return found

    return run


def states_of(found):
    """Final states (n, 4) from the result of any contestant."""
    if isinstance(found, np.ndarray):
        return found
    return np.stack([found[name].to_numpy() for name in ("theta", "w1", "w2", "w3")], axis=1)


def contestants(ell, start, few):
    """{(name, setting): (job, number of its motions, slice of those with a truth)}."""
    n, part, some = ell.size, slice(None, None, 8), slice(0, None, EVERY)
    jobs = {
        ("spincyl", tol): (of_spincyl(ell, start, tol=tol), n, some)
        for tol in (TOLERANCES[::2] if few else TOLERANCES)
    }
    jobs |= {
        ("heyoka, 8 motions at a time", tol): (
            heyoka_jobs.eight(ell[part], start[part], tol),
            n // 8,
            slice(0, None, EVERY // 8),
        )
        for tol in ((1e-6, 1e-10) if few else (1e-4, 1e-6, 1e-8, 3e-10, 1e-12, 1e-13, 1e-15))
    }
    if not few:
        jobs |= {("spincyl RK4", h): (of_spincyl(ell, start, step=h), n, some) for h in (0.02, 0.01)}
    if has("numba"):
        steps = (0.02,) if few else (0.1, 0.05, 0.02, 0.01, 0.005)
        jobs |= {("numba RK4", h): (of_numba(ell, start, h), n, some) for h in steps}
    if has("scipy"):
        y, shape = start[some][:16], ell[some][:16]
        for tol in (1e-9,) if few else (1e-6, 1e-9, 1e-12):
            jobs["SciPy DOP853", tol] = scipy_jobs.finals(shape, y, tol), 16, slice(0, 16)
    return jobs


def told(name, tol, found, off):
    """A row with the true and the estimated errors."""
    claimed = found["error"].to_numpy()
    ratio = (off / claimed[::EVERY]).max()
    return (
        name,
        tol,
        float(np.quantile(off, 0.99)),
        float(off.max()),
        float(np.quantile(claimed, 0.99)),
        float(claimed.max()),
        float(ratio),
    )


def measure(quick):
    count = 4096 if quick else 65_536
    points, rows, shares, best = {}, [], [], []
    for kick, name in [*KICKS.items(), (None, "one body, kick 0.05")]:
        ell, start = ensemble(kick or 0.05, count, one_body=kick is None)
        truth = heyoka_jobs.reference(ell[::EVERY], start[::EVERY])
        jobs = contestants(ell, start, few=kick is None or quick)
        least, found = alternate(
            {who: job[0] for who, job in jobs.items()}, 2 if quick else 5, 1.5, time.process_time
        )
        for (who, setting), (_, n, some) in jobs.items():
            states = states_of(found[who, setting])[some]
            us = least[who, setting] / n * 1e6
            worst, most = errors(states, truth[: len(states)])
            points.setdefault(name, {}).setdefault(who, []).append((setting, us, worst))
            rows.append((name, who, setting, us, worst, most))
            if who == "spincyl":
                off = np.abs(states - truth).max(axis=1)
                shares.append(told(name, setting, found[who, setting], off))
        best += compared(name, points[name], (1e-6, 1e-10, 1e-12), "µs")
    text = table(
        (
            "set of motions (kick of theta' in sqrt(g/R))",
            "program (heyoka: Taylor's method; RK4, DOP853: Runge-Kutta)",
            "tolerance, or step of RK4 in sqrt(R/g)",
            "time per motion (µs)",
            "largest error of the final state (natural units)",
            "99 % of these errors are below",
        ),
        rows,
    )
    text += (
        "\n"
        + SHARES
        + "\n\n"
        + table(
            (
                "set of motions (kick of theta' in sqrt(g/R))",
                "tolerance",
                "99 % of the true errors are below",
                "largest true error",
                "99 % of the estimated errors are below",
                "largest estimated error",
                "largest ratio of true to estimated error",
            ),
            shares,
        )
    )
    return {"text": text, "best": best}


if __name__ == "__main__":
    print(measure(quick="--quick" in sys.argv)["text"])
