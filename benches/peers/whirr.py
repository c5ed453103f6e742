"""Whirrs of Euler's disk to their end: spincyl beside heyoka, in one run.

    python benches/peers/whirr.py [--count 10000] [--quick]

The disk (half its thickness is 0.17 of its radius, a sharp rim) starts at 0.25 to 0.35 rad, some nodding, and loses
energy by dry friction of the contour, eps from 4e-3 to 6e-3, until its contact point stops: 10 to 18 turns.
heyoka solves the same equations in the variables that make it fastest: the state is g = ell sin - cos,
Z = ell cos + sin, cot, w1, w2, w3, so that the equations are polynomials of thirteen products and need neither sine nor
quotient; no compact mode, fast arithmetic, terminal events where psi' or the normal force vanishes.

Errors are the worst of the time of the end, theta, w1, w2, w3 there and the energy lost, against heyoka in 80-bit
arithmetic, which is tested against heyoka at 113 bits. Times are least CPU times of one thread, of rounds that alternate
the contestants.
"""

import argparse
import importlib.util
import sys
import time

import numpy as np

import spincyl as sc

ELL = 0.0128 / 0.0751
I1, I3 = 0.25 + ELL * ELL / 3, 0.5
D, J = I1 * I3 + I1 + I3 * ELL * ELL, I1 + 1 + ELL * ELL
FOREVER = 1000.0


def whirrs(count=10_000):
    """theta, w1, w2, w3 (n, 4) and eps (n,): a lattice that any language can build."""
    i = np.arange(count, dtype=np.int64)
    theta = 0.25 + 0.1 * (i + 0.5) / count
    eps = 4e-3 + 2e-3 * (((i * 49_473) % 65_536) + 0.5) / 65_536
    kick = 0.1 * (((i * 37_345) % 65_536) + 0.5) / 65_536
    steady = sc.Body.solid(ELL).steady(theta)
    return np.stack([theta, steady.w1, np.where(i % 2, kick, 0.0), steady.w3], axis=1), eps


def first_states(state):
    """(n, 6): g, Z, cot, w1, w2, w3."""
    s, c = np.sin(state[:, 0]), np.cos(state[:, 0])
    return np.stack([ELL * s - c, ELL * c + s, c / s, *state[:, 1:].T], axis=1)


def energy(theta, w1, w2, w3):
    s, c = np.sin(theta), np.cos(theta)
    return (
        ((I1 + ELL * ELL) * w1 * w1 + J * w2 * w2 + (I3 + 1) * w3 * w3 - 2 * ELL * w1 * w3) / 2 + s + ELL * c
    )


def finish(state, last, at):
    """t, theta, w1, w2, w3 and the energy that is lost (n, 6), from the last states."""
    _, _, cot, w1, w2, w3 = last.T
    theta = np.arctan(1 / cot)
    lost = energy(*state.T) - energy(theta, w1, w2, w3)
    return np.stack([at, theta, w1, w2, w3, lost], axis=1)


def system(hy, wide=False):
    """Equations, and the expressions that vanish where the contact stops and at lift-off; before, psi' <
    0."""
    g, z, cot, w1, w2, w3 = hy.make_vars("g", "z", "cot", "w1", "w2", "w3")
    eps = hy.par[0]
    ell, i1, i3 = (hy.par[k] for k in (1, 2, 3)) if wide else (ELL, I1, I3)
    d, j = i1 * i3 + i1 + i3 * ell * ell, i1 + 1 + ell * ell
    p, q, r = i3 * ell / d, i3 * (i3 + 1) / d, i1 / d
    turn = cot * w1
    d2 = (turn * (ell * w3 - (i1 + ell * ell) * w1) + w1 * ((i3 + 1) * w3 - ell * w1) - g) / j
    square = w2 * w2
    normal = 1 + g * d2 - z * square
    push = -eps * normal
    along = cot * push
    tilt = w2 * cot
    equations = [
        (g, -z * w2),
        (z, g * w2),
        (cot, w2 + cot * tilt),
        (w1, tilt * w1 + w2 * (p * w1 - q * w3) + ((i3 + 1) * along - ell * push) / d),
        (w2, d2),
        (w3, -w2 * (r * w1 + p * w3) + (ell * along - (i1 + ell * ell) * push) / d),
    ]
    return equations, (turn - w3, normal)


class Heyoka:
    """heyoka's scalar integrator."""

    def __init__(self, tol, bits=0):
        import heyoka as hy

        kind = {0: float, 64: np.longdouble}.get(bits) or (lambda x: hy.real(float(x), bits))
        self.kind = kind
        equations, zeros = system(hy, wide=bits > 0)
        of = {} if bits == 0 else {"fp_type": np.longdouble if bits == 64 else hy.real}
        self.ta = hy.taylor_adaptive(
            equations,
            np.array([kind(1)] * 6),
            pars=np.array([kind(x) for x in (0, ELL, I1, I3)][: 4 if bits else 1]),
            tol=kind(tol),
            fast_math=bits == 0,
            compact_mode=bits > 64,
            t_events=[hy.t_event(x, direction=hy.event_direction.negative, **of) for x in zeros],
            **of,
        )

    def __call__(self, first, eps):
        ta, kind = self.ta, self.kind
        last, at, code, steps = np.empty(first.shape), np.empty(eps.size), np.empty(eps.size, int), 0
        for i in range(eps.size):
            if kind is float:
                ta.time, ta.state[:], ta.pars[0] = 0.0, first[i], eps[i]
            else:
                ta.time, ta.pars[0] = kind(0), kind(eps[i])
                for k in range(6):
                    ta.state[k] = kind(first[i, k])
            ta.reset_cooldowns()
            told, _, _, taken, *_ = ta.propagate_until(kind(FOREVER))
            last[i], at[i], code[i], steps = (
                [float(x) for x in ta.state],
                float(ta.time),
                int(told),
                steps + taken,
            )
        return last, at, code, steps / eps.size


class Spincyl:
    """spincyl's sweep, which follows every whirr twice and claims an error for each."""

    def __init__(self, tol):
        self.tol, self.body = tol, sc.Body.solid(ELL)

    def __call__(self, state, eps):
        kept = ("final", "end", "work_lost")
        found = sc.sweep.roll(
            self.body,
            sc.State(*state.T),
            FOREVER,
            losses=sc.loss.DryContour(eps),
            want=kept,
            tol=self.tol,
            threads=1,
        )
        names = ("end", "theta", "w1", "w2", "w3", "work_lost")
        ends = np.stack([np.asarray(found[x].to_numpy(), dtype=float) for x in names], axis=1)
        return ends, found["error"].to_numpy(), found["status"].to_numpy()


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--quick", action="store_true", help="fewer settings")
    args = parser.parse_args()
    if importlib.util.find_spec("heyoka") is None:
        sys.exit("the reference of all errors needs heyoka: pip install heyoka")
    state, eps = whirrs(args.count)
    first = first_states(state)
    tested = np.arange(0, args.count, max(1, args.count // 400))
    last, at, *_ = Heyoka(1e-19, 64)(first[tested], eps[tested])
    truth = finish(state[tested], last, at)
    few = tested[:: max(1, tested.size // 5)]
    wide, wide_at, *_ = Heyoka(1e-24, 113)(first[few], eps[few])
    off = np.abs(finish(state[few], wide, wide_at) - truth[np.searchsorted(tested, few)]).max()
    print(
        f"The errors are measured against {tested.size} whirrs computed in 80 bits."
        f" The {few.size} of them that were also computed in 113 bits differ from the computation in 80 bits by at most {off:.1e}.\n"
        "Each row is a program with one tolerance, with the CPU time on one thread to compute a whirr of Euler's disk."
        " heyoka integrates by Taylor's method. The error of a whirr is the largest error of its time and its state at the end, in natural units."
    )

    jobs = [("spincyl", tol, Spincyl(tol)) for tol in (1e-8, 1e-9, 1e-10, 1e-11, 1e-12)]
    jobs += [("heyoka, 1 motion at a time", tol, Heyoka(tol)) for tol in (1e-8, 1e-9, 1e-10, 1e-12, 1e-15)]
    if args.quick:
        jobs = [job for job in jobs if job[1] in (1e-8, 1e-10)]
    seconds, found = [np.inf] * len(jobs), [None] * len(jobs)
    for _ in range(3):
        for k, (name, _, job) in enumerate(jobs):
            start = time.process_time()
            found[k] = job(state, eps) if name == "spincyl" else job(first, eps)
            seconds[k] = min(seconds[k], time.process_time() - start)
    print(
        "\n| program | tolerance | time per whirr (µs) | median error | 99 % of the errors are below | largest"
        " error | largest ratio of true to estimated error (`spincyl` only) | number of whirrs with a wrong ending |"
    )
    print("| --- " * 8 + "|")
    for (name, tol, _), spent, told in zip(jobs, seconds, found, strict=True):
        if name == "spincyl":
            ends, claims, status = told
            others = int((status != sc.sweep.Status.STOPS).sum())
            off = np.abs(ends[tested] - truth).max(axis=1)
            over = f"{(off / claims[tested]).max():.2f}"
        else:
            last, at, code, _ = told
            others, over = int((code != -1).sum()), ""
            off = np.abs(finish(state[tested], last[tested], at[tested]) - truth).max(axis=1)
        marks = " | ".join(f"{np.quantile(off, q):.1e}" for q in (0.5, 0.99, 1.0))
        print(f"| {name} | {tol:g} | {spent / eps.size * 1e6:.4g} | {marks} | {over} | {others} |")


if __name__ == "__main__":
    main()
