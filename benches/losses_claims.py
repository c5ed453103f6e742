"""Claimed errors of motions with losses, and whether energy, work and heat sum to a constant.

    python benches/losses_claims.py --seconds 300       one core; needs gmpy2 and a C compiler

Random bodies (disks, cans, tubes, rounded ones, balls), states (steady, nodding, any), one to three laws of
1e-5 to 1e-1, contacts "rolling" (also with a coefficient of friction), "smooth" and Coulomb, to t = 1 ..
60. `sc.roll` computes each with the default tolerance and with tol = 1e-8 and 1e-11.

The truth is computed by losses_truth.py, which shares nothing with the library. Where it takes too long (a
viscous law next to the table is stiff), only the sum of energy, work and heat is checked.

Ratios of true to claimed errors are those of the states at all times and of the time and the state of the
end; a ratio up to 10 is honest. The error of the work is compared with the same claim, which does not cover
it. A motion that takes more than 6 s, raises, ends otherwise than the truth, claims too little or claims more
than 1e-4 is printed with its call.
"""

import argparse
import functools
import math
import operator
import time
import warnings

import losses_truth
import numpy as np
from judge import Tally
from limit import Late, limit

import spincyl as sc

LAWS = sc.loss.Law.__subclasses__()  # in the order of the core
TOLERANCES = (None, 1e-8, 1e-11)
ENDS = {"stops": "STOPS", "side": "SIDE", "slips": "SLIP", "end": "DONE"}
VAGUE, LONGEST, STEPS = 1e-4, 6, 1500


class Case:
    """A random motion."""

    def __init__(self, rng):
        self.kind = str(rng.choice(["disk", "disk", "can", "tube", "rounded", "ball"]))
        body = {
            "disk": lambda: sc.Body.solid(rng.choice([0, 0.05, 0.17, 0.4])),
            "can": lambda: sc.Body.solid(rng.uniform(0.5, 3)),
            "tube": lambda: sc.Body.tube(rng.uniform(0, 7), bore=rng.uniform(0, 1)),
            "rounded": lambda: sc.Body.solid(rng.uniform(0.2, 2), fillet=rng.uniform(0.01, 0.19)),
            "ball": lambda: sc.Body.ball(-0.3, 0.45, 0.42),
        }[self.kind]()
        theta, way = rng.uniform(0.02, 1.5), rng.random()
        state = sc.State(theta, *rng.normal(size=3) * rng.choice([0.1, 1, 3]))
        if way < 0.6:
            state = body.steady(theta)
        if way < 0.4:
            state = state.kicked(rng.normal() * 0.05)
        self.coefficients = [0.0] * len(LAWS)
        for k in rng.choice(6 if self.kind == "ball" else 8, rng.integers(1, 4), replace=False):
            self.coefficients[k] = float(10 ** rng.uniform(-5, -1))
        self.contact = str(rng.choice(["rolling", "rolling", "smooth", "coulomb"]))
        self.mu = float(rng.uniform(0.05, 0.6)) if self.contact == "coulomb" or rng.random() < 0.2 else 0.0
        if self.contact == "smooth":
            self.mu = 0.0
        if self.contact == "coulomb" and rng.random() < 0.5:
            state = body.with_centre_velocity(state, *rng.normal(size=2))
        if self.contact == "coulomb" and state.slip is None:
            state = sc.State(theta, *[float(x) for x in (state.w1, state.w2, state.w3)], slip=(0.1, -0.2))
        slip = (0.0, 0.0) if state.slip is None else state.slip
        self.start = [float(x) for x in (theta, state.w1, state.w2, state.w3, *slip)]
        self.body = [float(x) for x in (body.ell, body.i1, body.i3, body.fillet)]
        if not np.all(np.isfinite(self.start)):
            raise ValueError("no such state")
        self.times = np.linspace(0, float(np.round(10 ** rng.uniform(0, 1.78), 2)), 12)[1:]

    @property
    def losses(self):
        made = (law(k) for law, k in zip(LAWS, self.coefficients, strict=True) if k)
        return functools.reduce(operator.add, made)

    @property
    def how(self):
        """The settings of sc.roll."""
        how = {
            "losses": self.losses,
            "contact": sc.Coulomb(self.mu) if self.contact == "coulomb" else self.contact,
        }
        return how | ({"mu": self.mu} if self.contact == "rolling" and self.mu else {})

    def rolled(self, tol, times=None):
        ell, i1, i3, fillet = self.body
        slip = tuple(self.start[4:]) if self.contact == "coulomb" else None
        self.shape, self.state = sc.Body(ell, i1, i3, fillet=fillet), sc.State(*self.start[:4], slip=slip)
        return sc.roll(
            self.shape, self.state, self.times if times is None else times, t0=0.0, tol=tol, **self.how
        )

    def call(self, tol):
        settings = ", ".join(f"{name}={value!r}" for name, value in self.how.items())
        times = f"np.linspace(0, {float(self.times[-1])!r}, 12)[1:], t0=0.0"
        state = " ".join(repr(self.state).split())
        return f"sc.roll({self.shape!r}, {state}, {times}, {settings}, tol={tol!r})"

    def truth(self, until=math.inf):
        """The rows to the first end or to a time; None if the truth takes too long."""
        times = self.times if until > self.times[-1] else [*self.times[self.times < until], until]
        how = {"contact": self.contact, "mu": self.mu, "most": STEPS}
        try:
            return losses_truth.exact(self.body, self.coefficients, self.start, times, **how)
        except (ArithmeticError, AssertionError, ValueError):
            return None


def enter(tally, case, tol, truth):
    """Adds one motion to the tally."""
    name = ("default" if tol is None else f"{tol:g}") + (
        ", ball" if case.kind == "ball" else f", {case.contact}"
    )
    try:
        with limit(LONGEST):
            m = case.rolled(tol)
    except (ValueError, Late) as e:
        tally.count(f"{name}: {'late' if isinstance(e, Late) else 'raises'}", f"{e}: {case.call(tol)}")
        return
    call = case.call(tol)
    if not m.error <= VAGUE:
        tally.count(f"{name}: claims more than {VAGUE:g}", f"{m.error:.2g}: {call}")
    if m.t.size:
        total = m.energy + m.work_lost + (m.dissipated if case.contact == "coulomb" else 0.0)
        start = float(case.shape.energy(case.state, "smooth" if case.contact == "smooth" else "rolling"))
        off = float(np.abs(total - start).max()) / max(1, abs(start))
        tally.add(f"{name}: energy, aside", off, max(m.error, 1e-13), call)
    # the truth ends at the face, and tests for lift-off only at the ends of its steps
    lands = m.status in (sc.Ending.FACE, sc.Ending.LIFT_OFF)
    if m.event and m.event.time > 0 and (truth is None or lands):
        before = 0.98 * m.event.time
        truth = case.truth(before)
        if truth and not np.all(np.isfinite(truth[-1][1])):
            truth = None
        if truth and truth[-1][0] == "end":
            there = case.rolled(tol, [before])
            if there.t.size:
                apart = float(np.abs(there.y[:, 0] - truth[-1][1][1:5]).max())
                tally.add(f"{name}: states before the end", apart, there.error, call)
            else:
                tally.count(f"{name}: no state at 0.98 of the time of its end", call)
            truth = [*truth[:-1], ("before", truth[-1][1])]
    if truth is None or (m.event and m.event.time == 0):
        tally.count(f"{name}: without a truth")
        return
    samples = np.array([row for kind, row in truth if kind in ("sample", "end")]).reshape(-1, 13)
    kind, last = truth[-1]
    whole = kind == "end" or kind in ENDS
    if case.contact == "coulomb" and kind == "slips":  # the truth ends where the body slips again
        whole = False
    if case.coefficients[-1] and kind == "stops":  # the series of the layer end where psi' = 0
        whole = False
    n = len(samples)
    if m.t.size < n or (whole and (m.t.size != n or m.status.name != ENDS[kind])):
        if math.isfinite(m.error):
            tally.count(f"{name}: another end", f"{m.message}; true: {kind} at {last[0]!r}: {call}")
        else:
            tally.count(f"{name}: another end, but inf is claimed")
        return
    tally.add(f"{name}: states", float(np.abs(m.y.T[:n] - samples[:, 1:5]).max(initial=0)), m.error, call)
    tally.add(
        f"{name}: work, aside", float(np.abs(m.work_lost[:n] - samples[:, 7]).max(initial=0)), m.error, call
    )
    if whole and m.event:
        s = m.event.state
        there = np.array([m.event.time, *map(float, (s.theta, s.w1, s.w2, s.w3))])
        tally.add(f"{name}: time of the end", float(abs(there[0] - last[0])), m.error, call)
        tally.add(f"{name}: state of the end", float(np.abs(there[1:] - last[1:5]).max()), m.error, call)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=300)
    parser.add_argument("--seed", type=int, default=14)
    parser.add_argument("--show", type=int, default=3, help="of each violation")
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    rng, tally, begun, n = (
        np.random.default_rng(given.seed),
        Tally(given.show, nothing=1e-15),
        time.perf_counter(),
        0,
    )
    while time.perf_counter() - begun < given.seconds:
        try:
            case = Case(rng)
        except ValueError:
            continue
        n += 1
        truth = case.truth()
        for tol in TOLERANCES:
            enter(tally, case, tol, truth)
    print(f"{n} motions in {time.perf_counter() - begun:.0f} s, seed {given.seed}")
    tally.print()


if __name__ == "__main__":
    main()
