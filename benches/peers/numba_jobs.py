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
def rate(s, c, w1, w2, w3, k0, k1, k2, p3, p4, p5, p6):
    ct = c / s
    turn = ct * (p4 * w3 - p3 * w1) + (p5 * w3 - p4 * w1)
    return (
        -c * w2,
        s * w2,
        w2 * (ct * w1 + (k0 * w1 - k1 * w3)),
        w1 * turn + (p6 * c - p4 * s),
        -w2 * (k2 * w1 + k0 * w3),
    )


@nb.njit(parallel=True, fastmath=True, error_model="numpy")
def rk4(k, start, h, steps, out):
    q = h / 2
    for b in nb.prange(start.shape[0] // LANES):
        y, p = np.empty((5, LANES)), np.ascontiguousarray(k[:, b * LANES : (b + 1) * LANES])
        for j in range(LANES):
            x = start[b * LANES + j]
            y[0, j], y[1, j], y[2, j], y[3, j], y[4, j] = np.sin(x[0]), np.cos(x[0]), x[1], x[2], x[3]
        for _ in range(steps):
            for j in range(LANES):
                k0, k1, k2, p3, p4, p5, p6 = p[0, j], p[1, j], p[2, j], p[3, j], p[4, j], p[5, j], p[6, j]
                s, c, u, v, w = y[0, j], y[1, j], y[2, j], y[3, j], y[4, j]
                a0, a1, a2, a3, a4 = rate(s, c, u, v, w, k0, k1, k2, p3, p4, p5, p6)
                b0, b1, b2, b3, b4 = rate(
                    s + q * a0, c + q * a1, u + q * a2, v + q * a3, w + q * a4, k0, k1, k2, p3, p4, p5, p6
                )
                c0, c1, c2, c3, c4 = rate(
                    s + q * b0, c + q * b1, u + q * b2, v + q * b3, w + q * b4, k0, k1, k2, p3, p4, p5, p6
                )
                d0, d1, d2, d3, d4 = rate(
                    s + h * c0, c + h * c1, u + h * c2, v + h * c3, w + h * c4, k0, k1, k2, p3, p4, p5, p6
                )
                y[0, j] = s + h / 6 * (a0 + 2 * (b0 + c0) + d0)
                y[1, j] = c + h / 6 * (a1 + 2 * (b1 + c1) + d1)
                y[2, j] = u + h / 6 * (a2 + 2 * (b2 + c2) + d2)
                y[3, j] = v + h / 6 * (a3 + 2 * (b3 + c3) + d3)
                y[4, j] = w + h / 6 * (a4 + 2 * (b4 + c4) + d4)
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
