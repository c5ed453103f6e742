"""Every reference motion with friction: error, estimated error and time; DOP853 of SciPy on its first slip.

    python benches/slip_motions.py

States and times of events against 25 digits (tests/reference/slip_motion.csv), divided by the number if it is
above 1. DOP853 solves the reduced equations in time up to the first end of a slip that begins at the start,
with rtol = atol = 1e-12, and covers the last 1e-8 of the speed by one linear step.
"""

import pathlib
import sys
import time

import numpy as np
from scipy.integrate import solve_ivp

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests"))
from test_slip_reference import ENDINGS, MOTIONS, PHASES, STATE, off, rolled, sampled

LEAST = 1e-8


def rates(_, y, ell, i1, i3, rho, mu):
    """The reduced equations of Coulomb friction."""
    theta, w1, w2, w3, u_h, u_2 = y
    s, c = np.sin(theta), np.cos(theta)
    radius, depth = 1 - rho + rho * s, ell + rho * c
    lever, slope = ell * s - (1 - rho) * c, ell * c + (1 - rho) * s
    height, turn, speed = slope + rho, w1 / s, np.hypot(u_h, u_2)
    pull = i3 * w1 * w3 - i1 * c * turn * w1
    free = i1 * (1 - slope * w2**2) + lever * pull
    normal = free / (i1 + lever**2 - mu * u_h / speed * lever * height)
    across, along = -mu * normal * u_h / speed, -mu * normal * u_2 / speed
    d1 = (w2 * (i1 * c * turn - i3 * w3) + depth * along) / i1
    d2, d3 = (pull - lever * normal - height * across) / i1, -radius * along / i3
    v_h, v_2 = u_h + height * w2, u_2 - depth * w1 + radius * w3
    d_h = across + turn * v_2 - lever * w2**2 - height * d2
    return [
        -w2,
        d1,
        d2,
        d3,
        d_h,
        along - turn * v_h + depth * d1 - radius * d3 + rho * w2 * (s * w1 + c * w3),
    ]


def beside(rows):
    """Error of the time of the first event, milliseconds and evaluations of DOP853; None where it does not apply."""
    x = rows[0]
    first = next((row for row in rows if row.kind in (*PHASES, "lift-off")), None)
    if x.law != "coulomb" or x.mu == 0 or x.u_h0 == x.u_20 == 0 or first is None:
        return None
    body = tuple(float(getattr(x, name)) for name in ("ell", "i1", "i3", "fillet", "mu"))

    def stops(_, y, *_body):
        return np.hypot(y[4], y[5]) - LEAST

    def lifts(_, y, ell, i1, i3, rho, _mu):
        s, c = np.sin(y[0]), np.cos(y[0])
        pull = i3 * y[1] * y[3] - i1 * c / s * y[1] ** 2
        return i1 * (1 - (ell * c + (1 - rho) * s) * y[2] ** 2) + (ell * s - (1 - rho) * c) * pull

    stops.terminal = lifts.terminal = True
    lifts.direction = -1
    start = [float(getattr(x, name + "0")) for name in STATE]
    began = time.perf_counter()
    found = solve_ivp(
        rates,
        (0, float(first.t) + 1),
        start,
        "DOP853",
        events=(stops, lifts),
        args=body,
        rtol=1e-12,
        atol=1e-12,
    )
    spent, y, end = time.perf_counter() - began, found.y[:, -1], found.t[-1]
    if found.t_events[0].size:
        change = rates(end, y, *body)
        speed = np.hypot(y[4], y[5])
        end -= speed**2 / (y[4] * change[4] + y[5] * change[5])
    return abs(end - float(first.t)), 1e3 * spent, found.nfev


def main():
    print("| motion | states | times | claimed | us | evaluations | DOP853: time | ms | evaluations |")
    print("| --- " * 9 + "|")
    for name, rows in MOTIONS.items():
        times = []
        for _ in range(5):
            began = time.perf_counter()
            m = rolled(rows)
            times.append(time.perf_counter() - began)
        states = off(np.column_stack([m.theta, m.w, m.slip]), sampled(rows), STATE)[1].max(initial=0.0)
        changes = [row for row in rows if row.kind in PHASES]
        late = [abs(p.time - float(r.t)) / max(1, r.t) for p, r in zip(m.phases[1:], changes, strict=True)]
        if rows[-1].kind in ENDINGS:
            late.append(abs(m.event.time - float(rows[-1].t)) / max(1, rows[-1].t))
        told = f"{states:.1e} | {float(max(late, default=0)):.1e} | {m.error:.1e} | {1e6 * min(times):.0f} | {m.nfev}"
        other = beside(rows)
        told += " | | | |" if other is None else " | {:.1e} | {:.1f} | {} |".format(*other)
        print(f"| {name} | {told}", flush=True)


if __name__ == "__main__":
    main()
