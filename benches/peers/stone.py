"""The rattleback of Kane and Levinson for five seconds: spincyl beside SciPy's DOP853 and heyoka, in one run.

    python benches/peers/stone.py [--rounds 7]

The stone (semi-axes 20, 3 and 2 cm, the centre of mass 1 cm above the table, I/M = 2, 16 and 17 cm^2, I12 =
-0.2 cm^2) spins at -5 rad/s, tilted by half a degree about both axes, and reverses its spin. SciPy and heyoka
solve the same equations of rolling for the vertical and the angular velocity; those of SciPy are written for
plain Python numbers, which are faster here than arrays, and those of heyoka are expressions that it compiles,
with the solution of the three linear equations by Cramer's rule. heyoka computes the state at the end; the
time in which its integrator is made does not count.

Errors are the worst number of the vertical and the angular velocity at the end, against heyoka in 80-bit
arithmetic at 1e-18, where that is installed, else against spincyl's own finest steps. Times are least CPU
times of one thread, of rounds that alternate the contestants.
"""

import argparse
import importlib.util
import time

import numpy as np

import spincyl as sc

UNIT = 20.0  # cm
SECOND = (UNIT / 981.0) ** 0.5
AXES = (1.0, 0.15, 0.1)
I11, I22, I33, I12 = (x / UNIT**2 for x in (2.0, 16.0, 17.0, -0.2))
LOW = -1.0 / UNIT  # the centre of mass, from the centre of the ellipsoid
SPIN, PUSH, END = -5.0 * SECOND, np.radians(0.5), 5.0 / SECOND
TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12)


def rates(n1, n2, n3, w1, w2, w3, root):
    """n' and w' of a stone that rolls; `root` takes square roots, of numbers or of expressions."""
    d1, d2, d3 = (a * a for a in AXES)
    e1, e2, e3 = n2 * w3 - n3 * w2, n3 * w1 - n1 * w3, n1 * w2 - n2 * w1
    square = d1 * n1 * n1 + d2 * n2 * n2 + d3 * n3 * n3
    per = 1.0 / root(square)
    turn = (d1 * n1 * e1 + d2 * n2 * e2 + d3 * n3 * e3) / square
    x, y, z = -d1 * n1 * per, -d2 * n2 * per, -d3 * n3 * per - LOW
    p, q, r = (d1 * (n1 * turn - e1) * per, d2 * (n2 * turn - e2) * per, d3 * (n3 * turn - e3) * per)
    # w x (r' + w x r)
    v1, v2, v3 = w2 * z - w3 * y, w3 * x - w1 * z, w1 * y - w2 * x
    p, q, r = p + v1, q + v2, r + v3
    c1, c2, c3 = w2 * r - w3 * q, w3 * p - w1 * r, w1 * q - w2 * p
    l1, l2, l3 = I11 * w1 + I12 * w2, I12 * w1 + I22 * w2, I33 * w3
    f1, f2, f3 = n1 - c1, n2 - c2, n3 - c3
    b1 = l2 * w3 - l3 * w2 + y * f3 - z * f2
    b2 = l3 * w1 - l1 * w3 + z * f1 - x * f3
    b3 = l1 * w2 - l2 * w1 + x * f2 - y * f1
    a11, a22, a33 = I11 + y * y + z * z, I22 + x * x + z * z, I33 + x * x + y * y
    a12, a13, a23 = I12 - x * y, -x * z, -y * z
    k11, k12, k13 = a22 * a33 - a23 * a23, a13 * a23 - a12 * a33, a12 * a23 - a13 * a22
    k22, k23, k33 = a11 * a33 - a13 * a13, a12 * a13 - a11 * a23, a11 * a22 - a12 * a12
    det = 1.0 / (a11 * k11 + a12 * k12 + a13 * k13)
    return (
        e1,
        e2,
        e3,
        (k11 * b1 + k12 * b2 + k13 * b3) * det,
        (k12 * b1 + k22 * b2 + k23 * b3) * det,
        (k13 * b1 + k23 * b2 + k33 * b3) * det,
    )


def stone():
    inertia = [[I11, I12, 0.0], [I12, I22, 0.0], [0.0, 0.0, I33]]
    return sc.Ellipsoid(AXES, inertia, offset=(0.0, 0.0, LOW))


def start():
    at = stone().spinning(SPIN, pitch=PUSH, roll=PUSH)
    return np.array([*at.vertical, *at.w])


def by_spincyl(tol):
    body, at = stone(), stone().spinning(SPIN, pitch=PUSH, roll=PUSH)

    def run():
        m = sc.roll(body, at, END, tol=tol)
        return m.y[:, -1]

    return run


def by_scipy(tol):
    from math import sqrt

    from scipy.integrate import solve_ivp

    def run():
        found = solve_ivp(
            lambda _, y: rates(*y.tolist(), sqrt), (0.0, END), start(), method="DOP853", rtol=tol, atol=tol
        )
        return found.y[:, -1]

    return run


def by_heyoka(tol, wide=False):
    import heyoka as hy

    names = hy.make_vars("n1", "n2", "n3", "w1", "w2", "w3")
    number = np.longdouble if wide else float
    equations = list(zip(names, rates(*names, hy.sqrt), strict=True))
    made = hy.taylor_adaptive(equations, start().astype(number), tol=number(tol), fp_type=number)

    def run():
        made.time = number(0.0)
        made.state[:] = start()
        made.propagate_until(number(END))
        return np.array(made.state, float)

    return run


def least(runs, rounds):
    """The least CPU time of each job, in seconds, by rounds that alternate them."""
    best = dict.fromkeys(runs, np.inf)
    for name, run in runs.items():
        run()
        once = time.process_time()
        run()
        runs[name] = run, max(1, int(0.05 / max(time.process_time() - once, 1e-6)))
    for _ in range(rounds):
        for name, (run, count) in runs.items():
            begin = time.process_time()
            for _ in range(count):
                run()
            best[name] = min(best[name], (time.process_time() - begin) / count)
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7)
    rounds = parser.parse_args().rounds
    peers = {"spincyl": by_spincyl, "scipy": by_scipy, "heyoka": by_heyoka}
    peers = {name: of for name, of in peers.items() if importlib.util.find_spec(name)}
    truth = (
        by_heyoka(1e-18, wide=True)()
        if "heyoka" in peers
        else sc.roll(stone(), stone().spinning(SPIN, pitch=PUSH, roll=PUSH), END).y[:, -1]
    )
    print(f"spin at the end: {truth[:3] @ truth[3:] / SECOND:.6f} rad/s")
    runs = {(name, tol): of(tol) for name, of in peers.items() for tol in TOLERANCES}
    runs["spincyl", None] = by_spincyl(None)
    errors = {of: np.abs(run() - truth).max() for of, run in runs.items()}
    times = least(dict(runs), rounds)
    print(f"{'':10}{'tol':>8}{'error':>10}{'ms':>10}")
    for (name, tol), seconds in times.items():
        said = "finest" if tol is None else f"{tol:.0e}"
        print(f"{name:10}{said:>8}{errors[name, tol]:10.1e}{1e3 * seconds:10.3f}")


if __name__ == "__main__":
    main()
