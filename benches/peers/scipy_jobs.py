"""SciPy's part: solve_ivp with DOP853, one motion at a time, on Python's floats."""

import math

import numpy as np
from scene import T, coefficients


def rates(_, y, k):
    theta, w1, w2, w3 = y.tolist()
    s, c = math.sin(theta), math.cos(theta)
    ct = c / s
    turn = ct * (k[4] * w3 - k[3] * w1) + k[5] * w3 - k[4] * w1
    return (
        -w2,
        w2 * (ct * w1 + k[0] * w1 - k[1] * w3),
        w1 * turn + k[6] * c - k[4] * s,
        -w2 * (k[2] * w1 + k[0] * w3),
    )


def finals(ell, start, tol):
    """A job that computes the final states at t = 20."""
    from scipy.integrate import solve_ivp

    of = coefficients(ell).T.tolist()

    def run():
        return np.array(
            [
                solve_ivp(rates, (0, T), y, "DOP853", rtol=tol, atol=tol, args=(k,)).y[:, -1]
                for y, k in zip(start, of, strict=True)
            ]
        )

    return run


def ends(ell, start, tol):
    """A job that computes kind, time and last state (n, 6) of motions that end."""
    from scipy.integrate import solve_ivp

    of = np.concatenate([coefficients(ell), ell[None]]).T.tolist()

    def normal(t, y, k):
        s, c = math.sin(y[0]), math.cos(y[0])
        return 1 + (k[7] * s - c) * rates(t, y, k)[2] - (k[7] * c + s) * y[2] ** 2

    def side(_, y, k):
        return y[0] - math.pi / 2

    def face(_, y, k):
        return y[0] - 1e-8

    for event in (normal, side, face):
        event.terminal = True

    def run():
        found = np.empty((ell.size, 6))
        for i, (y, k) in enumerate(zip(start, of, strict=True)):
            told = solve_ivp(
                rates, (0, T), y, "DOP853", rtol=tol, atol=tol, args=(k,), events=(normal, side, face)
            )
            kind = next((code for code, t in zip((3, 2, 1), told.t_events, strict=True) if t.size), 0)
            found[i] = kind, told.t[-1], *told.y[:, -1]
        return found

    return run
