"""Launches of the paper's tube until slipping ends: spincyl beside heyoka, numba and SciPy, in one run.

    python benches/peers/slip.py [--count 10000] [--quick]

All of them solve the same equations (docs: Coulomb friction at the rim) in the same variables, which were
chosen to make heyoka fast: the state is g = ell sin - cos, Z = ell cos + sin, w1, w2, w3, u_h, u_2 and t,
which needs 28 products of series and no sine; the independent variable is sigma, dt = |u|/(|u| + 3) dsigma,
in which |u| decays exponentially towards the end, so that the end is a simple root and no step comes near
the singularity. In t itself an integrator can jump over it. Events: a small |u|, and then one linear step
to u = 0; N0 = 0, lift-off; cos theta = 0, the other end lands. The heat comes from the energy.

Errors are the worst of t, theta, w1, w2, w3 and heat where u = 0 for the first time, against heyoka in 80-bit
arithmetic, which is tested against heyoka at 113 bits. A launch may pass close to u = 0 and slip on for
another round: of 400 launches 5 come closer than 1e-6, 2 closer than 1e-10 and one (number 5562) as near as
1e-15, which doubles cannot tell from u = 0. If its first end is taken to be there, the error is 1 or more,
although the rolling that follows later is the same; a column counts errors above 1e-3, the column before leaves
them out. Times are least CPU times of one thread.
"""

import argparse
import math
import sys
import time

import numpy as np
from clock import has
from heyoka_jobs import refilled
from scene import SLOW, TUBE, launches

import spincyl as sc

ELL, I1, I3 = TUBE.values()
FOREVER = 3000.0
#: the sentences above the table
ROWS = """\
Each row is a program with one tolerance, with the CPU time on one thread to compute a launch until the tube rolls or,
where the row says so, to t = 200. heyoka integrates by Taylor's method, DOP853 is a Runge-Kutta method. The error of a
launch is the largest error of the six numbers at the end of the slip (time, inclination, w1, w2, w3 and heat, in natural
units). Launches that nearly end in another way have errors above 1e-3, and are counted separately."""


def least(run, rounds=5, seconds=6.0):
    """Least CPU time of this thread in a call, and its last result."""
    times, until = [], time.perf_counter() + seconds
    while len(times) < 2 or (len(times) < rounds and time.perf_counter() < until):
        start = time.process_time()
        result = run()
        times.append(time.process_time() - start)
    return min(times), result


def first_states(state, slip):
    """(n, 8): g, Z, w1, w2, w3, u_h, u_2, t at the start."""
    s, zero = np.sin(state[:, 0]), np.zeros(state.shape[0])
    c = np.where(state[:, 0] == np.pi / 2, 0.0, np.cos(state[:, 0]))
    return np.stack([ELL * s - c, ELL * c + s, *state[:, 1:].T, *slip.T, zero], axis=1)


def energy(g, z, w1, w2, w3, uh, u2):
    vh, v2 = uh + z * w2, u2 - ELL * w1 + w3
    return (vh * vh + v2 * v2 + g * g * w2 * w2 + I1 * (w1 * w1 + w2 * w2) + I3 * w3 * w3) / 2 + z


def finish(first, last, mu):
    """t, theta, w1, w2, w3, heat (n, 6) where u = 0, by a linear step from the last state (n, 8)."""
    g, z, w1, w2, w3, uh, u2, t = last.T
    s, c = (ELL * g + z) / (1 + ELL * ELL), (ELL * z - g) / (1 + ELL * ELL)
    om, r = w1 / s, np.hypot(uh, u2)
    j, p, q = I3 * w3 - I1 * c * om, uh / r, u2 / r
    b = g - mu * z * p
    n = (I1 - I1 * z * w2 * w2 + g * w1 * j) / (I1 + g * b)
    d1, d2, d3 = -(w2 * j + ELL * mu * n * q) / I1, (w1 * j - n * b) / I1, mu * n * q / I3
    dh = om * (u2 - ELL * w1 + w3) - g * w2 * w2 - z * d2 - mu * n * p
    da = -om * (uh + z * w2) - mu * n * q + ELL * d1 - d3
    dt = -r / (p * dh + q * da)
    heat = energy(*first.T[:7]) - energy(*last.T[:7]) + mu * n * r * dt / 2
    return np.stack(
        [t + dt, np.arctan2(s, c) - w2 * dt, w1 + d1 * dt, w2 + d2 * dt, w3 + d3 * dt, heat], axis=1
    )


def system(hy, wide=False):
    """Equations, and the expressions that vanish at |u| = par[1], at lift-off and where the other end
    lands."""
    mu, small = hy.par[0], hy.par[1]
    g, z, w1, w2, w3, uh, u2, t = hy.make_vars("g", "z", "w1", "w2", "w3", "uh", "u2", "t")
    i1, i3 = (hy.par[2], hy.par[3]) if wide else (I1, I3)

    def over(x, y):
        return x / y if wide else (1 / y) * x

    s, c = over(ELL * g + z, 1 + ELL * ELL), over(ELL * z - g, 1 + ELL * ELL)
    om = w1 / s
    floor = 0.0 if wide else 1e-60  # heyoka misses a few of the ends, after which 0/0 would follow
    j, zw, r = i3 * w3 - i1 * (c * om), z * w2, hy.sqrt(uh * uh + u2 * u2 + floor)
    turn = w1 * j
    br, lift = g * r - mu * (z * uh), i1 - i1 * (zw * w2) + g * turn
    dt = r / (r + SLOW)
    push = dt * (lift / (i1 * r + g * br))
    f = mu * push
    fh, f2, w, o = f * uh, f * u2, dt * w2, om * dt
    gw = g * w
    d1, d2, d3 = -over(w * j + ELL * f2, i1), over(dt * turn - push * br, i1), over(f2, i3)
    equations = [
        (g, -z * w),
        (z, gw),
        (w1, d1),
        (w2, d2),
        (w3, d3),
        (uh, o * (u2 - ELL * w1 + w3) - gw * w2 - z * d2 - fh),
        (u2, -o * (uh + zw) - f2 + ELL * d1 - d3),
        (t, dt),
    ]
    return equations, (r - small, lift, c + 1e-9)  # c is 0 at the start


def reference(first, mu, bits=64, small=1e-17):
    """Last states (n, 8), in 80-bit arithmetic or with `bits` bits."""
    import heyoka as hy

    kind = np.longdouble if bits == 64 else hy.real

    def wide(x):
        return kind(float(x)) if bits == 64 else hy.real(float(x), bits)

    equations, (stop, *_) = system(hy, wide=True)
    ta = hy.taylor_adaptive(
        equations,
        np.array([wide(1)] * 8),
        pars=np.array([wide(1)] * 4),
        fp_type=kind,
        tol=wide(1e-19 if bits == 64 else 1e-30),
        compact_mode=bits != 64,
        t_events=[hy.t_event(stop, fp_type=kind)],
    )
    last = np.empty(first.shape)
    for i in range(mu.size):
        ta.reset_cooldowns()
        ta.time = wide(0)
        for k in range(8):
            ta.state[k] = wide(first[i, k])
        for k, x in enumerate((mu[i], small, I1, I3)):
            ta.pars[k] = wide(x)
        ta.propagate_until(wide(FOREVER))
        last[i] = [float(x) for x in ta.state]
    return last


def cause(code, state, small):
    """The event of an outcome of heyoka; 0 also where it missed the end and stays at u = 0."""
    return -code - 1 if -100 < code < 0 else 0 if math.hypot(state[5], state[6]) < small else -1


class Lanes:
    """heyoka's batch integrator with terminal events."""

    def __init__(self, tol, small, lanes):
        import heyoka as hy

        equations, zeros = system(hy)
        self.small, self.lanes = small, lanes
        self.ta = hy.taylor_adaptive_batch(
            equations,
            np.ones((8, lanes)),
            pars=np.ones((2, lanes)),
            tol=tol,
            fast_math=True,
            t_events=[hy.t_event_batch(x) for x in zeros],
        )

    def __call__(self, first, mu):
        from heyoka import taylor_outcome

        n, state, broken = mu.size, self.ta.state, int(taylor_outcome.err_nf_state)
        last, kind, steps = np.full((n, 8), np.nan), np.full(n, -1), 0

        def ended(code, at):  # an event; all other codes are below -2^32
            return -100 < code < 0 or at >= FOREVER or code == broken

        pars = np.stack([mu, np.full(n, self.small)])
        for i, code, _, k, steps in refilled(self.ta, self.lanes, first, pars, FOREVER, ended):  # noqa: B007
            last[i], kind[i] = state[:, k], cause(code, state[:, k], self.small)
        return last, kind, steps * self.lanes / n


class Alone:
    """heyoka's scalar integrator with the same events."""

    def __init__(self, tol, small):
        import heyoka as hy

        equations, zeros = system(hy)
        self.small = small
        self.ta = hy.taylor_adaptive(
            equations,
            np.ones(8),
            pars=np.ones(2),
            tol=tol,
            fast_math=True,
            compact_mode=False,
            t_events=[hy.t_event(x) for x in zeros],
        )

    def __call__(self, first, mu):
        ta, last, kind, steps = self.ta, np.empty(first.shape), np.full(mu.size, -1), 0
        ta.pars[1] = self.small
        for i in range(mu.size):
            ta.time, ta.state[:], ta.pars[0] = 0.0, first[i], mu[i]
            ta.reset_cooldowns()
            code, _, _, taken, *_ = ta.propagate_until(FOREVER)
            last[i], steps = ta.state, steps + taken
            kind[i] = cause(int(code), ta.state, self.small)
        return last, kind, steps / mu.size


class Compiled:
    """numba's integrator, of slip_numba.py."""

    def __init__(self, tol, small):
        from slip_numba import LANES, sweep

        self.how, self.run, self.lanes = (tol, small), sweep, LANES

    def __call__(self, first, mu):
        last, kind = np.full(first.shape, np.nan), np.full(mu.size, -1)
        steps = self.run(first, mu, *self.how, last, kind)
        return last, kind, steps * self.lanes / mu.size


class Scipy:
    """solve_ivp with DOP853, one launch at a time, on Python's floats, which are faster here than arrays.

    rtol = atol, but the absolute tolerance of u is 1e-4 of it: else |u| never gets below the tolerance."""

    def __init__(self, tol, small):
        self.tol, self.small = tol, small

    def __call__(self, first, mu):
        from scipy.integrate import solve_ivp

        def rate(_, y, m):
            g, z, w1, w2, w3, uh, u2, _ = y.tolist()
            s, c = (ELL * g + z) / (1 + ELL * ELL), (ELL * z - g) / (1 + ELL * ELL)
            om, zw, r = w1 / s, z * w2, math.sqrt(uh * uh + u2 * u2)
            j = I3 * w3 - I1 * c * om
            turn, br, dt = w1 * j, g * r - m * z * uh, r / (r + SLOW)
            push = dt * (I1 - I1 * zw * w2 + g * turn) / (I1 * r + g * br)
            fh, f2, o, gw = m * push * uh, m * push * u2, om * dt, g * w2 * dt
            d1, d2, d3 = -(dt * w2 * j + ELL * f2) / I1, (dt * turn - push * br) / I1, f2 / I3
            along = o * (u2 - ELL * w1 + w3) - gw * w2 - z * d2 - fh
            return -zw * dt, gw, d1, d2, d3, along, -o * (uh + zw) - f2 + ELL * d1 - d3, dt

        def stopped(_, y, m):
            return math.hypot(y[5], y[6]) - self.small

        def lifted(_, y, m):
            s, c = (ELL * y[0] + y[1]) / (1 + ELL * ELL), (ELL * y[1] - y[0]) / (1 + ELL * ELL)
            return I1 - I1 * y[1] * y[3] ** 2 + y[0] * y[2] * (I3 * y[4] - I1 * c * y[2] / s)

        def landed(_, y, m):
            return ELL * y[1] - y[0] + 1e-9

        for event in (stopped, lifted, landed):
            event.terminal, event.direction = True, -1
        last, kind, steps = np.empty(first.shape), np.full(mu.size, -1), 0
        atol = self.tol * np.array([1, 1, 1, 1, 1, 1e-4, 1e-4, 1])
        rtol = max(self.tol, 2.3e-14)
        for i in range(mu.size):
            found = solve_ivp(
                rate,
                (0, FOREVER),
                first[i],
                "DOP853",
                events=(stopped, lifted, landed),
                rtol=rtol,
                atol=atol,
                args=(mu[i],),
            )
            last[i], steps = found.y[:, -1], steps + found.t.size - 1
            kind[i] = next((k for k in range(3) if found.t_events[k].size), -1)
        return last, kind, steps / mu.size


class Spincyl:
    """spincyl's sweep until the tube rolls (or, with `whole`, to t = 200), with an error claimed for every
    launch.

    The others stop where slip first ends, even if it goes on in another direction, and claim no error. Errors
    are those of launches with two phases, slipping and rolling.
    """

    def __init__(self, tol, whole=False, errors=True):
        self.body = sc.Body.tube(ELL, 0.8)
        self.how = {"tol": tol, "stop_at": None if whole else "rolling", "errors": errors}

    def __call__(self, state, slip, mu):
        found = sc.sweep.roll(
            self.body,
            sc.State(*state.T, slip=tuple(slip.T)),
            200.0,
            contact=sc.Coulomb(mu),
            want=(
                "slip_time",
                "dissipated",
                "rolling_theta",
                "rolling_w1",
                "rolling_w2",
                "rolling_w3",
                "phases",
            ),
            threads=1,
            **self.how,
        )
        names = ("slip_time", "rolling_theta", "rolling_w1", "rolling_w2", "rolling_w3", "dissipated")
        ends = np.stack([np.asarray(found[x].to_numpy(), dtype=float) for x in names], axis=1)
        return ends, found["phases"].to_numpy() == 2, found["error"].to_numpy()


def spincyl_one(body, state, slip, mu, until):
    """spincyl's single motion: t, theta, w1, w2, w3 of the first change of phase, and the motion."""
    start = sc.State(*map(float, state), slip=tuple(map(float, slip)))
    motion = sc.roll(body, start, [0.0, until], contact=sc.Coulomb(float(mu)))
    phase = motion.phases[1]
    names = ("theta", "w1", "w2", "w3")
    return [phase.time, *(float(getattr(phase.state, x)) for x in names)], motion


def row(name, setting, us, ends, truth, kind=None):
    off = np.abs(ends - truth)
    worst = off.max(axis=1)
    wrong = int((~(worst < 1e-3)).sum())
    good = worst[worst < 1e-3]
    biggest = good.max() if good.size else math.nan
    others = 0 if kind is None else int((kind != 0).sum())
    print(
        f"| {name} | {setting} | {us:.4g} | {np.quantile(worst, 0.5):.1e} | "
        f"{np.quantile(worst, 0.99):.1e} | {biggest:.1e} | {wrong} of {worst.size} | {others} |",
        flush=True,
    )


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--quick", action="store_true", help="fewer settings")
    args = parser.parse_args()
    if not has("heyoka"):
        sys.exit("the reference of all errors needs heyoka: pip install heyoka")
    state, slip, mu = launches(args.count)
    first = first_states(state, slip)
    tested = np.arange(0, args.count, max(1, args.count // 400)) + min(12, args.count // 800)
    few = tested[:: max(1, tested.size // 20)]
    truth = finish(first[tested], reference(first[tested], mu[tested]), mu[tested])
    wider = finish(first[few], reference(first[few], mu[few], bits=113, small=1e-20), mu[few])
    at = np.searchsorted(tested, few)
    print(
        f"The errors are measured against {tested.size} launches computed in 80 bits. The {few.size} of them that were"
        f" also computed in 113 bits differ from the computation in 80 bits by at most {np.abs(truth[at] - wider).max():.1e}."
    )
    print(ROWS)
    print(
        "\n| program | tolerance | time per launch (µs) | median error | 99 % of the errors are below | largest"
        " error below 1e-3 | number of launches with an error above 1e-3 | number of launches with a wrong ending |"
    )
    print("| --- " * 8 + "|")

    tols = (1e-7, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13)
    for name, settings, how in (
        ("spincyl, until it rolls", tols, {}),
        ("spincyl without errors, until it rolls", tols, {"errors": False}),
        ("spincyl, to t = 200", (1e-11,), {"whole": True}),
    ):
        for tol in settings:
            job = Spincyl(tol, **how)
            seconds, (ends, plain, _) = least(lambda job=job: job(state, slip, mu))
            kept = plain[tested]
            row(name, f"{tol:g}", seconds / mu.size * 1e6, ends[tested][kept], truth[kept])
    body = sc.Body.tube(ELL, 0.8)
    start = time.process_time()
    ends = np.array([spincyl_one(body, state[i], slip[i], mu[i], 200.0)[0] for i in tested])
    us = (time.process_time() - start) / tested.size * 1e6
    row("spincyl, 1 motion at a time, to t = 200", "default", us, ends, truth[:, :5])
    settings = ((1e-9, 1e-8), (1e-10, 1e-9), (1e-11, 1e-11), (1e-12, 1e-12), (1e-13, 1e-12), (1e-15, 1e-13))
    for lanes in (8, 4):
        for tol, small in settings if not args.quick else settings[1:4]:
            job = Lanes(tol, small, lanes)
            seconds, (last, kind, _) = least(lambda job=job: job(first, mu))
            ends = finish(first, last, mu)[tested]
            row(
                f"heyoka, {lanes} motions at a time",
                f"{tol:g}",
                seconds / mu.size * 1e6,
                ends,
                truth,
                kind,
            )
    for tol, small in settings[1:4:2]:
        job = Alone(tol, small)
        seconds, (last, kind, _) = least(lambda job=job: job(first[tested], mu[tested]))
        ends = finish(first[tested], last, mu[tested])
        row("heyoka, 1 motion at a time", f"{tol:g}", seconds / tested.size * 1e6, ends, truth, kind)
    if has("numba"):
        for tol in (1e-7, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13) if not args.quick else (1e-9, 1e-11):
            job = Compiled(tol, 1e-12)
            job(first[:64], mu[:64])
            seconds, (last, kind, _) = least(lambda job=job: job(first, mu))
            ends = finish(first, last, mu)[tested]
            row("numba DOP853, 32 motions at a time", f"{tol:g}", seconds / mu.size * 1e6, ends, truth, kind)
    if has("scipy"):
        for tol in (1e-8, 1e-10, 1e-12, 1e-13) if not args.quick else (1e-10,):
            start = time.process_time()
            last, kind, _ = Scipy(tol, max(1e-12, tol / 1000))(first[few], mu[few])
            us = (time.process_time() - start) / few.size * 1e6
            row("SciPy DOP853", f"{tol:g}", us, finish(first[few], last, mu[few]), wider, kind)


if __name__ == "__main__":
    main()
