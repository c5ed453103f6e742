"""A million slow drifts, centre at rest and rolling: time, and error against adaptive quadrature by SciPy and mpmath.

    python benches/drifts.py [--count 1e6] [--threads 2] [--checked 40]

Bodies, starts, laws and coefficients all differ: coins and cylinders near their face, pipes on their side. The times at rest
are checked against mpmath's tanh-sinh quadrature of Eq. 15 with 30 digits, those of rolling against SciPy's DOP853.
"""

import argparse
import time

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp

import spincyl as sc

LAWS = (
    sc.loss.DryContour,
    sc.loss.ViscousContour,
    sc.loss.RollingResistance,
    sc.loss.AirFilm,
    sc.loss.BoundaryLayer,
)


def starts(count, seed=1):
    """Bodies and inclinations: two thirds near the face, the others on their side."""
    r = np.random.default_rng(seed)
    ell = np.where(r.random(count) < 2 / 3, r.uniform(0.01, 0.6, count), r.uniform(2.0, 6.0, count))
    body = sc.Body.tube(ell, r.uniform(0, 1, count))
    flat = r.uniform(0.05, 0.35, count)
    low, high = np.asarray(body.theta_limit), np.pi / 2
    side = low + (high - low) * r.uniform(0.3, 0.9, count)
    return body, np.where(ell < 1, np.minimum(flat, 0.6 * low), side)


def losses(count, law, seed=2):
    return law(10 ** np.random.default_rng(seed).uniform(-4, -2, count))


def one(body, k):
    return sc.Body.tube(float(body.ell[k]), float(body.bore[k]))


def at_rest(body, theta, law, coefficient, end):
    """The time to the end, with 30 digits."""
    with mp.workdps(30):
        bore, ell = mp.mpf(float(body.bore)), mp.mpf(float(body.ell))
        i3 = (1 + bore**2) / 2
        a = mp.mpf(1) / 2 + ell**2 / (3 * i3)

        def energy(x):
            s, c = mp.sin(x), mp.cos(x)
            return (a + ell**2) * s * (c - ell * s) / (2 * (a * c - ell * s)) + ell * c + s

        def slowness(x):
            s, c = mp.sin(x), mp.cos(x)
            rate = mp.sqrt((c - ell * s) / ((a * c - ell * s) * s) / i3)
            spin = abs(ell * s - c) * rate
            power = {
                "DryContour": spin,
                "ViscousContour": spin**2,
                "RollingResistance": s * spin,
                "AirFilm": mp.pi / 4 * spin**2 / s,
                "BoundaryLayer": spin ** mp.mpf(2.5),
            }[law.__name__]
            return mp.diff(energy, x) / power

        return float(
            abs(mp.quad(slowness, [mp.mpf(end), mp.mpf(theta) / 2 + mp.mpf(end) / 2, theta])) / coefficient
        )


def rolling(body, theta, loss, until):
    """The time to an inclination, by DOP853 on (theta, w1, w3) with equations written independently."""
    y = body.steady(theta)
    d = body.i1 * body.i3 + body.i1 + body.i3 * body.ell**2

    def rate(_, x):
        th, w1, w3 = x
        s, c = np.sin(th), np.cos(th)
        ct = c / s
        state = sc.State(th, w1, 0.0, w3)
        m1, _, m3 = np.asarray(loss.couple(body, state)).ravel()
        a1 = ((body.i3 + 1) * m1 + body.ell * m3) / d
        a3 = (body.ell * m1 + (body.i1 + body.ell**2) * m3) / d
        f1 = -ct * w1 - body.i3 * body.ell / d * w1 + body.i3 * (body.i3 + 1) / d * w3
        f3 = (body.i1 * w1 + body.i3 * body.ell * w3) / d
        s1 = (
            -2 * (body.i1 + body.ell**2) * ct * w1
            - 2 * body.ell * w1
            + (body.i3 + 1) * w3
            + body.ell * ct * w3
        )
        s3 = (body.i3 + 1) * w1 + body.ell * ct * w1
        st = (body.i1 + body.ell**2) * w1**2 / s**2 - body.ell * w1 * w3 / s**2 - s - body.ell * c
        lean = -(s1 * a1 + s3 * a3) / (st + s1 * f1 + s3 * f3)
        return [lean, a1 + f1 * lean, a3 + f3 * lean]

    def there(_, x):
        return x[0] - until

    there.terminal = True
    start = [float(y.theta), float(y.w1), float(y.w3)]
    found = solve_ivp(rate, (0, 1e9), start, "DOP853", rtol=3e-14, atol=1e-16, events=there)
    return found.t_events[0][0]


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("--count", type=float, default=1e6)
    ask.add_argument("--threads", type=int, default=2)
    ask.add_argument("--checked", type=int, default=8, help="drifts of each law that are checked")
    given = ask.parse_args()
    count = int(given.count)
    body, theta = starts(count)
    for centre in ("rest", "rolling"):
        for law in LAWS:
            loss = losses(count, law)
            best = np.inf
            for _ in range(3 if centre == "rest" else 1):
                began = time.perf_counter()
                d = sc.drift(body, theta, loss, centre, threads=given.threads)
                best = min(best, time.perf_counter() - began)
            core = stops_only(d, given.threads)
            worst = 0.0
            for k in range(given.checked):
                single, k_loss = one(body, k), law(float(loss.coefficient[k]))
                if centre == "rest":
                    exact = at_rest(
                        single, float(theta[k]), law, k_loss.coefficient, float(d.ends_at_theta[k])
                    )
                    worst = max(worst, abs(d.stops_at[k] / exact - 1))
                elif d.ended[k] != "no drift":
                    goal = 0.5 * (float(theta[k]) + float(d.ends_at_theta[k]))
                    mine = sc.drift(single, float(theta[k]), k_loss, centre).time(goal)
                    worst = max(worst, abs(mine / rolling(single, float(theta[k]), k_loss, goal) - 1))
            ends = dict(zip(*np.unique(d.ended, return_counts=True), strict=True))
            told = ", ".join(f"{name} {n}" for name, n in ends.items())
            print(
                f"{centre:8} {law.__name__:18} {best:6.2f} s all, {core[0]:6.2f} s core ({core[1]:.2f} s of processors)  "
                f"error {worst:.1e}  {told}",
                flush=True,
            )


def stops_only(d, threads):
    """Wall and CPU seconds of the compiled part alone; the CPU time does not depend on other processes."""
    from spincyl import _core

    out = {name: np.empty(d.stops_at.size) for name in ("stops_at", "ends_at_theta")}
    out["ended"] = np.empty(d.stops_at.size, np.uint8)
    began, worked = time.perf_counter(), time.process_time()
    _core.drift_stops(d._columns, d.centre, out, threads)
    return time.perf_counter() - began, time.process_time() - worked


if __name__ == "__main__":
    main()
