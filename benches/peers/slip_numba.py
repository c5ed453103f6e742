"""numba's part of the launches: Dormand and Prince's eighth-order method compiled for the machine.

Many motions run side by side, each with its own step; a lane that is done takes the next launch. Equations
and variables are those of slip.py.
"""

import math

import numba as nb
import numpy as np
from scene import SLOW, TUBE
from scipy.integrate._ivp import dop853_coefficients as table

LANES = 32
ELL, I1, I3 = TUBE.values()
NEAR = 1e-4  # below this |u| the error of u is relative to |u|


@nb.njit(fastmath=True, error_model="numpy")
def rate(y, k, mu, lift):
    """The equations of slip.py in all lanes, and I1 + g^2 times N0."""
    for m in range(LANES):
        g, z, w1, w2, w3, uh, u2 = y[0, m], y[1, m], y[2, m], y[3, m], y[4, m], y[5, m], y[6, m]
        s, c = (ELL * g + z) * (1 / (1 + ELL * ELL)), (ELL * z - g) * (1 / (1 + ELL * ELL))
        om = w1 / s
        j, zw, r = I3 * w3 - I1 * (c * om), z * w2, math.sqrt(uh * uh + u2 * u2)
        turn = w1 * j
        t, br, n = r / (r + SLOW), g * r - mu[m] * (z * uh), I1 - I1 * (zw * w2) + g * turn
        push = t * n / (I1 * r + g * br)
        f = mu[m] * push
        fh, f2 = f * uh, f * u2
        d1, d2, d3 = -(1 / I1) * (t * w2 * j + ELL * f2), (1 / I1) * (t * turn - push * br), (1 / I3) * f2
        o, gw = om * t, g * w2 * t
        k[0, m], k[1, m], k[2, m], k[3, m], k[4, m] = -zw * t, gw, d1, d2, d3
        k[5, m] = o * (u2 - ELL * w1 + w3) - gw * w2 - z * d2 - fh
        k[6, m] = -o * (uh + zw) - f2 + ELL * d1 - d3
        k[7, m] = t
        lift[m] = n


def source():
    """The twelve stages and the two error estimates, written out."""

    def sum_of(weights):
        return " + ".join(f"{float(w)!r} * k[{j}, i, m]" for j, w in enumerate(weights[:12]) if w != 0)

    def all_of(variables, *body):
        return [
            f"    for i in range({variables}):",
            "        for m in range(LANES):",
            *("            " + x for x in body),
        ]

    lines = ["def step(y, k, h, mu, between, after, error, lift):"]
    for stage in range(1, 12):
        lines += all_of("8", f"between[i, m] = y[i, m] + h[m] * ({sum_of(table.A[stage, :stage])})")
        lines += [f"    rate(between, k[{stage}], mu, lift)"]
    lines += all_of("8", f"after[i, m] = y[i, m] + h[m] * ({sum_of(table.B)})")
    lines += ["    for m in range(LANES):", "        error[0, m] = error[1, m] = 0.0"]
    lines += [f"        error[2, m] = 1 / min(1.0, math.hypot(y[5, m], y[6, m]) / {NEAR} + 1e-300)"]
    for variables, weight in (("5", "1.0"), ("5, 7", "error[2, m]")):
        lines += all_of(
            variables,
            f"error[0, m] = max(error[0, m], {weight} * abs({sum_of(table.E5)}))",
            f"error[1, m] = max(error[1, m], {weight} * abs({sum_of(table.E3)}))",
        )
    lines += ["    for m in range(LANES):", "        five, three = error[0, m], error[1, m]"]
    lines += [
        "        error[0, m] = h[m] * five * five / math.sqrt(five * five + 0.01 * three * three + 1e-300)"
    ]
    return "\n".join(lines)


space = {"rate": rate, "math": math, "LANES": LANES}
exec(source(), space)
step = nb.njit(fastmath=True, error_model="numpy")(space["step"])


@nb.njit(fastmath={"contract", "reassoc", "arcp", "nsz"}, error_model="numpy")
def sweep(first, friction, tol, small, out, kind):
    """Fills out (n, 8) and kind (n,) with the state and the cause of each end; returns the steps of a lane.

    Ends are tested after each step: the first |u| below `small` is close enough, and lift-off and the landing
    of the other end are reported at most a step late.
    """
    n, todo, left, steps = first.shape[0], 0, LANES, 0
    k, error = np.zeros((12, 8, LANES)), np.zeros((3, LANES))
    y, between, after = np.zeros((8, LANES)), np.zeros((8, LANES)), np.zeros((8, LANES))
    h, mu, lift, lane = np.zeros(LANES), np.zeros(LANES), np.zeros(LANES), np.zeros(LANES, np.int64)
    for m in range(LANES):
        y[:, m], mu[m], h[m], lane[m] = first[todo % n], friction[todo % n], 0.05, todo % n
        todo += 1
    rate(y, k[0], mu, lift)
    while left > 0:
        step(y, k, h, mu, between, after, error, lift)
        steps += 1
        for m in range(LANES):
            e = error[0, m] / tol
            if e < 1:
                for i in range(8):
                    y[i, m] = after[i, m]
            h[m] *= min(4.0, max(0.2, 0.9 * max(e, 1e-10) ** -0.125)) if e < 1e30 else 0.2
        rate(y, k[0], mu, lift)
        for m in range(LANES):
            why = -1
            if lift[m] < 0:
                why = 1
            elif ELL * y[1, m] - y[0, m] < 0:
                why = 2
            elif y[5, m] * y[5, m] + y[6, m] * y[6, m] < small * small:
                why = 0
            if why >= 0 and lane[m] >= 0:
                out[lane[m]], kind[lane[m]] = y[:, m], why
                if todo < n:
                    y[:, m], mu[m], h[m], lane[m] = first[todo], friction[todo], 0.05, todo
                    todo += 1
                else:
                    y[:, m], h[m], lane[m] = first[0], 1e-3, -1
                    left -= 1
                rate(y, k[0], mu, lift)
    return steps
