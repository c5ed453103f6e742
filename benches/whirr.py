"""Whirrs to their end: evaluations per turn, and time against error, compared with SciPy's DOP853.

    python benches/whirr.py        a minute; needs gmpy2 and a C compiler

Euler's disk (half its thickness is 0.17 of its radius; sharp, or with a rounded rim) from 0.3 rad until its
contact point stops, by dry friction of the contour; with a visible nutation; and with every other law, to 0.9
of the time at which the face lands or the contact stops (a viscous law is stiff there), or to t = 60 where it
does not stop.

"To the end" are the library's evaluations to the end itself, by default. The turns are those of the contact
point round the rim, psi/(2 pi). `need` compares the evaluations with those of DOP853 on the harmonic
oscillator at the same error, over the radians of the nutation in the same time, sqrt(kappa) next to the table
times phi. "A radian" are evaluations for each radian of psi.

The truth is computed by losses_truth.py. The error is the largest of the four numbers of the state at eight
times and at the end, and of the time of the end, each divided by the number if it is above 1. DOP853 solves
the same equations in plain Python (losses_scipy.py), at the same times; each row has the cheapest of its
tolerances that is as accurate, or the most accurate one (with a star). Where numba is installed, DOP853 is
timed with a compiled right-hand side as well.
"""

import functools
import math

import losses_scipy
import losses_truth
import numpy as np
from scipy.integrate import solve_ivp
from timing import best

import spincyl as sc

HALF = 0.0128 / 0.0751
DISK, ROUNDED = sc.Body.solid(HALF), sc.Body.solid(HALF, fillet=0.05)
TOLERANCES = (None, 1e-12, 1e-10, 1e-8, 1e-6)
OTHERS = [*(10 ** (-k / 2) for k in range(8, 27)), 2.5e-14]  # of DOP853; rtol cannot be less
KINDS = 1 if losses_scipy.numba is None else 2  # DOP853 in Python, and with a compiled right-hand side
LAWS = sc.loss.Law.__subclasses__()  # in the order of the core
CASES = (
    ("Euler's disk, dry 5e-3", DISK, 0.0, (0, 5e-3)),
    ("the same, nodding", DISK, 0.1, (0, 5e-3)),
    ("rounded rim, dry 5e-3", ROUNDED, 0.0, (0, 5e-3)),
    ("dry 1e-3", DISK, 0.0, (0, 1e-3)),
    ("viscous 1e-3", DISK, 0.0, (1, 1e-3)),
    ("rolling resistance 2e-2", DISK, 0.0, (2, 2e-2)),
    ("drilling 5e-3", DISK, 0.0, (3, 5e-3)),
    ("linear air 5e-3", DISK, 0.0, (4, 5e-3)),
    ("quadratic air 5e-3", DISK, 0.0, (5, 5e-3)),
    ("film 1e-5", DISK, 0.0, (6, 1e-5)),
    ("film 1e-5, nodding", DISK, 0.1, (6, 1e-5)),
    ("boundary layer 2e-4", DISK, 0.0, (7, 2e-4)),
)


def off(found, true):
    """The largest error; an error of a number above 1 is divided by the number."""
    return float(np.max(np.abs(found - true) / np.maximum(1, np.abs(true)), initial=0.0))


def oscillator(radians):
    """Errors and evaluations of DOP853 over so many radians of x'' = -x."""
    true, found = np.array([math.cos(radians), -math.sin(radians)]), []
    for tol in OTHERS:
        there = solve_ivp(lambda _, y: (y[1], -y[0]), (0, radians), (1.0, 0.0), "DOP853", rtol=tol, atol=tol)
        found.append((float(np.abs(there.y[:, -1] - true).max()), there.nfev))
    return found


def cheapest(found, error):
    """The least cost of a result that is at least this accurate, or the cost of the best one, with a star."""
    good = [price for other, *price in found if other <= error]
    return (*min(good), "") if good else (*min(found)[1:], "*")


class Whirr:
    """A case, its times and its truth."""

    def __init__(self, body, kick, law):
        self.body, self.losses = body, LAWS[law[0]](law[1])
        start = body.steady(0.3)
        self.state = start.kicked(kick) if kick else start
        self.coefficients = [law[1] if k == law[0] else 0.0 for k in range(8)]
        m = sc.roll(body, self.state, [500.0], t0=0.0, losses=self.losses)
        self.stops = law[0] == 0
        self.until = m.event.time + 1 if self.stops else 0.9 * m.event.time if m.event else 60.0
        last = m.event.time if self.stops else self.until
        self.times = np.append(last * np.arange(1, 8) / 8, self.until)
        shape = [float(x) for x in (body.ell, body.i1, body.i3, body.fillet)]
        self.start = [float(x) for x in (start.theta, self.state.w1, self.state.w2, self.state.w3)]
        self.models = [
            losses_scipy.Lossy(shape, self.coefficients, compiled=how) for how in (False, True)[:KINDS]
        ]
        rows = losses_truth.exact(shape, self.coefficients, self.start, self.times, most=20_000)
        if (rows[-1][0] == "stops") != self.stops:
            raise ArithmeticError(f"the true end is {rows[-1][0]}")
        self.truth = np.array([row[:5] for _, row in rows])
        phi, psi = rows[-1][1][9:11]
        i1, high, rim = float(body.i1), float(body.ell + body.fillet), 1 - float(body.fillet)
        near = (3 * i1 + high**2) / (
            i1 + rim**2 + high**2
        )  # kappa over the square of the rate, next to the table
        self.radians, self.nods = abs(psi), math.sqrt(near) * abs(phi)
        self.whole = sc.roll(body, self.state, [500.0], t0=0.0, losses=self.losses).nfev

    def library(self, tol):
        m = sc.roll(self.body, self.state, self.times, t0=0.0, losses=self.losses, tol=tol)
        rows = np.column_stack([m.t, m.theta, m.w])
        if self.stops:
            s = m.event.state
            there = [m.event.time, *map(float, (s.theta, s.w1, s.w2, s.w3))]
            rows = np.vstack([rows, there])
        return rows, m

    def peer(self, kind, tol):
        found = self.models[kind].solve(self.start, self.times, tol)
        rows = np.column_stack([self.times[: found.y.shape[1]], found.y[:4].T])
        return (np.vstack([rows, [found.end[1], *found.end[2][:4]]]) if self.stops else rows), found


def main():
    heads = (
        "whirr", "turns", "to the end", "tol", "error", "claimed", "ms", "evaluations", "a turn", "a radian",
        "need", "DOP853: ms", "evaluations", "times as long",
        *(("compiled: ms", "times as long") if KINDS > 1 else ()),
    )  # fmt: skip
    print("| " + " | ".join(heads) + " |")
    print("| --- " * len(heads) + "|")
    ratios = [[] for _ in range(KINDS)]
    for name, *case in CASES:
        whirr = Whirr(*case)
        turns, ideal, others = (
            whirr.radians / (2 * math.pi),
            oscillator(whirr.nods),
            [[] for _ in range(KINDS)],
        )
        for kind in range(KINDS):
            for tol in OTHERS:
                (rows, found), spent = best(functools.partial(whirr.peer, kind, tol), 2, per=1e3)
                others[kind].append((off(rows, whirr.truth), found.evaluations, spent))
        for tol in TOLERANCES:
            (rows, m), spent = best(functools.partial(whirr.library, tol), per=1e3)
            error = off(rows, whirr.truth)
            evaluations, other, star = cheapest(others[0], error)
            need = m.nfev / cheapest(ideal, error)[0]
            ratios[0].append(other / spent)
            told = [
                name,
                f"{turns:.1f}",
                f"{whirr.whole}",
                "" if tol is None else f"{tol:g}",
                f"{error:.1e}",
                f"{m.error:.1e}",
            ]
            told += [f"{spent:.2f}", f"{m.nfev}", f"{m.nfev / turns:.0f}", f"{m.nfev / whirr.radians:.1f}"]
            told += [f"{need:.2f}", f"{other:.1f}{star}", f"{evaluations}", f"{other / spent:.0f}"]
            if KINDS > 1:
                compiled = cheapest(others[1], error)[1]
                ratios[1].append(compiled / spent)
                told += [f"{compiled:.1f}", f"{compiled / spent:.0f}"]
            print("| " + " | ".join(told) + " |", flush=True)
    print()
    for name, row in zip(("DOP853", "with its right-hand side compiled"), ratios, strict=False):
        print(f"{name} takes {min(row):.0f} to {max(row):.0f} times as long (median {np.median(row):.0f})")


if __name__ == "__main__":
    main()
