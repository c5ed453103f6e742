"""Measures the figures in the rows on motion of docs/hard-cases.md, against tests/reference/motion.csv.

python benches/motion.py        needs mpmath; half a minute
"""

import csv
import math
import pathlib
import signal
import subprocess
import sys
import time
import warnings
from itertools import pairwise

import numpy as np
from mpmath import mp, mpf, quad

import spincyl as sc

REFERENCE = pathlib.Path(__file__).parents[1] / "tests" / "reference" / "motion.csv"


def rows(kind):
    with REFERENCE.open() as file:
        for row in csv.reader(file):
            if row[0] == kind:
                x = [float.fromhex(v) for v in row[3:]]
                yield row[1], row[2], sc.Body(*x[:3]), sc.State(*x[3:7]), x[7], np.array(x[8:])


def order():
    can = sc.Body.solid(1.0)
    start = can.steady(0.5).kicked(0.1)
    for contact in ("rolling", "smooth"):
        exact = sc.roll(can, start, 5.0, contact=contact).y
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", sc.StepWarning)
            runs = [sc.roll(can, start, 5.0, contact=contact, step=0.25 / 2**k) for k in range(10)]
        errors = [np.abs(m.y - exact).max() for m in runs]
        orders = [math.log2(a / b) if b > 0 else math.nan for a, b in pairwise(errors)]
        print(f"D1 {contact}: orders {np.round(orders, 3).tolist()}")


def held():
    for ell, theta in ((2.5, 1.3), (1.0, 0.5)):
        body = sc.Body.solid(ell)
        m = sc.roll(body, body.steady(theta), 1e4, step=1e-2)
        print(f"D2 ell = {ell}: theta moved by {m.theta[0] - theta:.1e} in 1e6 steps")
    body = sc.Body.solid(2.5)
    start = body.steady(1.3).kicked(0.05)
    there = sc.roll(body, start, 100.0, step=1e-3)
    back = sc.roll(body, sc.State(*there.y[:, 0]), [100.0, 0.0], step=1e-3)
    off = np.abs(back.y[:, 1] - [start.theta, start.w1, start.w2, start.w3]).max()
    print(f"D13 back after 1e5 steps: off by {off:.1e}")


def rocking():
    for name, _, body, start, period, (low, _, turn, _) in rows("period"):
        limit = math.pi * math.sqrt((body.i1 + body.ell**2 + 1) / (body.i1 + body.ell**2))
        if name.startswith("D6"):
            found = sc.swing(body, start).precession_per_period
            print(f"{name}: limit off by {found / limit - 1:.1e}, reference by {found - turn:.0e} rad")
        if name.startswith("rocking can 1e"):
            for how in ({}, {"tol": 1e-6}, {"tol": 1e-9}, {"tol": 1e-12}, {"step": 1e-4}):
                try:
                    m = sc.roll(body, start, period, want="pose", **how)
                    said = f"{np.degrees(m.phi[0]):.8f} deg, off by {m.phi[0] - turn:.1e} rad"
                except ValueError as e:
                    said = str(e)
                print(f"{name} (theta_min {low:.1e}) {how or 'exact'}: {said}")


def endings():
    mp.dps = 30
    for ell in (0.0, 0.3, 1.0):
        body = sc.Body.solid(ell)
        long, inertia, top = mpf(ell), mpf(body.i1) + 1 + mpf(ell) ** 2, mpf(0.3)

        def speed(v, ell=long, inertia=inertia, top=top):
            mid, half = top - v * v / 2, v * v / 2
            sinc = mp.sin(half) / half if v else mpf(1)
            return 2 / mp.sqrt(2 * sinc * (mp.cos(mid) - ell * mp.sin(mid)) / inertia)

        exact = quad(speed, [0, mp.sqrt(top)])
        for how in ({}, {"step": 1e-3}, {"tol": 1e-13}):
            m = sc.roll(body, sc.State(0.3, 0.0, 0.0, 0.0), 5.0, beyond=True, **how)
            face = m.event.time if m.event.ending is sc.Ending.FACE else math.nan
            print(f"D8 ell = {ell} {how or 'exact'}: {float(mpf(face) - exact):.1e}")
    for name, contact, body, start, t, _ in rows("event"):
        mu = 0.3 if name == "slip" else math.inf
        for how in ({}, {"step": 1e-4}, {"tol": 1e-13}):
            m = sc.roll(body, start, t + 1, contact=contact, mu=mu, **how)
            print(f"D9, D10 {name} {contact} {how or 'exact'}: time off by {m.event.time - t:.1e}")


def exactness():
    worst, share = 0.0, math.inf
    for name, contact, body, start, t, values in rows("state"):
        m = sc.roll(body, start, t, contact=contact, beyond=True, want="pose")
        error = np.abs(m.y[:, 0] - values[:4]).max()
        share = min(share, m.error / error) if error > 0 else share
        worst = max(worst, error if t <= 20 else 0.0)
        print(f"D15, D17 {name} {contact} t = {t:g}: error {error:.1e}, claimed {m.error:.1e}")
        if t >= 1e6:
            print(
                f"D16 {name} {contact} t = {t:g}: phi = {m.phi[0]:.3g}, off by {abs(m.phi[0] - values[4]):.0e} rad"
            )
    periods = [
        abs(sc.swing(body, start, contact).period / t - 1) for _, contact, body, start, t, _ in rows("period")
    ]
    print(
        f"worst to t = 20: {worst:.1e}; claimed at least {share:.1f} times the error; periods to {max(periods):.1e}"
    )


def interrupted():
    for how, times in (("step=1e-6", "1e6"), ("tol=1e-14", "1e6"), ("", "np.linspace(0, 1e6, 20_000_000)")):
        code = f"""
import numpy as np, spincyl as sc, time
body = sc.Body.solid(2.5)
start, t = body.steady(1.3).kicked(0.05), {times}
print("go", flush=True)
try:
    sc.roll(body, start, t, {how})
except KeyboardInterrupt:
    print(time.time(), flush=True)
"""
        delays = []
        for k in range(4):
            with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as child:
                child.stdout.readline()
                time.sleep(0.3 + 0.1 * k)
                sent = time.time()
                child.send_signal(signal.SIGINT)
                delays.append(1e3 * (float(child.stdout.readline()) - sent))
        print(f"Ctrl-C in roll({how or 'exact'}): {min(delays):.0f} to {max(delays):.0f} ms")


if __name__ == "__main__":
    for part in (order, held, rocking, endings, exactness, interrupted):
        part()
