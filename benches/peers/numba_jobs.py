"""numba's part, in any interpreter that has numba: prints one JSON line a job.

python benches/peers/numba_jobs.py
"""

import json
import sys
import tempfile

import numba as nb
import numpy as np
from scene import T, axes, best, coefficients, ensemble, points

SVML = "SVML" if nb.config.USING_SVML else "no SVML"


@nb.njit(parallel=True, fastmath=True, error_model="numpy")
def grid(theta, ell, a, out):
    for i in nb.prange(theta.size):
        s, t = np.sin(theta[i]), np.tan(theta[i])
        for j in range(ell.size):
            x = ell[j] * t
            out[i, j] = np.sqrt((1 - x) / ((a[j] - x) * s))


@nb.njit(parallel=True, fastmath=True, error_model="numpy")
def scattered(theta, ell, out):
    for i in nb.prange(theta.size):
        s, c = np.sin(theta[i]), np.cos(theta[i])
        lever = ell[i] * s
        out[i] = np.sqrt((c - lever) / ((0.5 * (1 + 4 * ell[i] * ell[i] / 3) * c - lever) * s))


LANES = 64


@nb.njit(inline="always", fastmath=True, error_model="numpy")
def rate(s, c, w1, w2, w3, k, i, j, d):
    ct = c / s
    d[0, j] = -c * w2
    d[1, j] = s * w2
    d[2, j] = w2 * (ct * w1 + (k[0, i] * w1 - k[1, i] * w3))
    d[4, j] = -w2 * (k[2, i] * w1 + k[0, i] * w3)
    turn = ct * (k[4, i] * w3 - k[3, i] * w1) + (k[5, i] * w3 - k[4, i] * w1)
    d[3, j] = w1 * turn + (k[6, i] * c - k[4, i] * s)


@nb.njit(parallel=True, fastmath=True, error_model="numpy")
def rk4(k, start, h, steps, out):
    for b in nb.prange(start.shape[0] // LANES):
        y, t, a, d = (np.empty((5, LANES)) for _ in range(4))
        for j in range(LANES):
            x = start[b * LANES + j]
            y[0, j], y[1, j], y[2, j], y[3, j], y[4, j] = np.sin(x[0]), np.cos(x[0]), x[1], x[2], x[3]
        for _ in range(steps):
            for j in range(LANES):
                rate(y[0, j], y[1, j], y[2, j], y[3, j], y[4, j], k, b * LANES + j, j, d)
                for m in range(5):
                    a[m, j] = y[m, j] + h / 6 * d[m, j]
                    t[m, j] = y[m, j] + h / 2 * d[m, j]
            for stage in range(2):
                ahead = h / 2 if stage == 0 else h
                for j in range(LANES):
                    rate(t[0, j], t[1, j], t[2, j], t[3, j], t[4, j], k, b * LANES + j, j, d)
                    for m in range(5):
                        a[m, j] += h / 3 * d[m, j]
                        t[m, j] = y[m, j] + ahead * d[m, j]
            for j in range(LANES):
                rate(t[0, j], t[1, j], t[2, j], t[3, j], t[4, j], k, b * LANES + j, j, d)
                for m in range(5):
                    y[m, j] = a[m, j] + h / 6 * d[m, j]
        for j in range(LANES):
            o = out[b * LANES + j]
            o[0], o[1], o[2], o[3] = np.arctan2(y[0, j], y[1, j]), y[2, j], y[3, j], y[4, j]


def tell(**told):
    print(json.dumps(told | {"svml": SVML, "version": nb.__version__}), flush=True)


def main():
    theta, ell = axes()
    a, out = 0.5 * (1 + 4 * ell * ell / 3), np.empty((theta.size, ell.size))
    at, of = points()
    flat = np.empty(at.size)
    for threads in (1, 2):
        nb.set_num_threads(threads)
        seconds = best(lambda: grid(theta, ell, a, out))
        tell(job="grid", threads=threads, ns=seconds / out.size * 1e9)
        seconds = best(lambda: scattered(at, of, flat))
        tell(job="scattered", threads=threads, ns=seconds / flat.size * 1e9)
    nb.set_num_threads(1)
    for kick in (0.05, 0.4, 0.8):
        ell, start = ensemble(kick)
        k, found = coefficients(ell), np.empty_like(start)
        for h in (0.1, 0.05, 0.02, 0.01, 0.005):
            seconds = best(lambda: rk4(k, start, h, round(T / h), found), rounds=3)  # noqa: B023
            with tempfile.NamedTemporaryFile(suffix=".npy", delete=False) as file:
                np.save(file, found)
            tell(job="rk4", kick=kick, h=h, us=seconds / ell.size * 1e6, states=file.name)


if __name__ == "__main__":
    sys.exit(main())
