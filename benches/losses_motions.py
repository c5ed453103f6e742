"""Every reference motion with losses: errors, estimated error and time, compared with SciPy's DOP853.

    python benches/losses_motions.py [name ...]      motions whose names begin like this; default: all

States, work lost, and the time and the state of the end are compared with 25 digits
(tests/reference/losses.json); errors are divided by the number if it is above 1. The ratio is the largest
true error of states and of the end, not divided, over `Motion.error`, which covers both. The work has a
column of its own, since the estimate does not cover it.

DOP853 solves the same equations in plain Python (losses_scipy.py) at the same times, and finds the first end
of a smooth piece: the contact stops, slip ends, drilling is held. The table has the cheapest of its
tolerances 1e-6 to 2.5e-14 with an error no larger than that of the library; if there is none, it has the most
accurate one, with a star at the microseconds. The last piece of a viscous whirr to the face is left out, as
it is stiff for an explicit method.
"""

import pathlib
import sys

import losses_scipy
import numpy as np
from timing import best

import spincyl as sc

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests"))
from test_losses_reference import ENDINGS, MOTIONS, ON_THE_WAY, STATE, body_of, losses_of, off

ROUNDS = 7
TOLERANCES = [*(10.0**-k for k in range(6, 14)), 2.5e-14]  # rtol cannot be less
HEADS = (
    "motion", "states", "work", "time of the end", "state there", "claimed", "true/claimed", "us",
    "evaluations",
    "DOP853: error", "us", "evaluations",
)  # fmt: skip


def asked(case):
    """A function that computes the motion at the samples of the table and on to its end."""
    theta, w1, w2, w3, *slip = case.start
    slips = case.contact == "coulomb"
    body, losses = body_of(case), losses_of(case)
    start = sc.State(theta, w1, w2, w3, slip=tuple(slip) if slips else None)
    how = {"contact": sc.Coulomb(case.mu) if slips else case.contact, "beyond": case.beyond}
    if case.contact == "rolling" and case.mu:
        how["mu"] = case.mu
    times = [float(row.t) for row in case.rows if row.kind in ON_THE_WAY]
    if case.rows[-1].kind != "end":
        times.append(float(case.rows[-1].t) + 1)
    return lambda: sc.roll(body, start, times, t0=0.0, losses=losses, **how)


def last(case):
    """The row of the end, if the library reports one."""
    return next((row for row in case.rows if row.kind in ENDINGS), None)


def errors(case, m):
    """Errors of states, work, time and state of the end, scaled; and the largest that the estimate covers, not
    scaled."""
    samples = [row for row in case.rows if row.kind in ON_THE_WAY][: m.t.size]
    plain, scaled = off(np.column_stack([m.theta, m.w]), samples, STATE)
    work = off(m.work_lost[:, None], samples, ["work"])[1].max(initial=0.0)
    found, most = [scaled.max(initial=0.0), work, np.nan, np.nan], plain.max(initial=0.0)
    row, phases = last(case), [r for r in case.rows if r.kind == "rolls"]
    if row is not None:
        late, s = abs(m.event.time - float(row.t)), m.event.state
        plain, scaled = off([[s.theta, s.w1, s.w2, s.w3]], [row], STATE)
        found[2:] = late / max(1, float(row.t)), scaled.max()
        most = max(most, late, plain.max())
    elif phases:
        found[2] = abs(m.phases[1].time - float(phases[0].t))
    return found, most


def beside(case, aim):
    """Error, microseconds and evaluations of DOP853, and whether its error is at most `aim`."""
    rows, crosses, end = [], 0, None
    for row in case.rows:
        if row.kind in ON_THE_WAY:
            rows.append(row)
        elif row.kind == "crosses":
            crosses += 1
        else:
            end = row
            break
    times = [float(row.t) for row in rows]
    until = times[-1] if end is None or end.kind == "face" else float(end.t) + 0.3
    model = losses_scipy.Lossy(case.body, case.losses, case.contact, case.mu, most=30_000)
    names = (*STATE, "u_h", "u_2", "work")
    tried = []
    for tol in TOLERANCES:
        try:
            found, spent = best(
                lambda tol=tol: model.solve(case.start, times, tol, None, crosses, until), 1, per=1e6
            )
        except losses_scipy.Dear:
            continue  # its steps become too short near the end of the slip
        error = off(found.y.T, rows, names)[1].max(initial=0.0)
        if end is not None and end.kind != "face":
            name, t, y = found.end
            if name != end.kind:
                raise ArithmeticError(f"{case.name}: DOP853 ends with {name}, not {end.kind}")
            error = max(error, abs(t - float(end.t)) / max(1, float(end.t)))
            error = max(error, off([y[:4]], [end], STATE)[1].max())
        tried.append((error, spent, found.evaluations, tol))
        if error <= aim:
            break
    error, spent, evaluations, tol = min(tried)
    spent = min(spent, best(lambda: model.solve(case.start, times, tol, None, crosses, until), 3, per=1e6)[1])
    return error, spent, evaluations, error <= aim


def main():
    print("| " + " | ".join(HEADS) + " |")
    print("| --- " * len(HEADS) + "|")
    ratios, faster, fewer, works = {}, [], [], []
    for case in MOTIONS:
        if sys.argv[1:] and not any(case.name.startswith(name) for name in sys.argv[1:]):
            continue
        m, spent = best(asked(case), ROUNDS, per=1e6)
        found, most = errors(case, m)
        ratios[case.name] = most / m.error
        works.append(found[1])
        error, other, evaluations, reached = beside(case, np.nanmax(found))
        if case.rows[-1].kind != "face" or case.beyond:
            faster.append(other / spent)
            fewer.append(evaluations / m.nfev)
        told = [f"{x:.1e}" if np.isfinite(x) else "" for x in found] + [
            f"{m.error:.1e}",
            f"{most / m.error:.2g}",
        ]
        told += [
            f"{spent:.0f}",
            f"{m.nfev}",
            f"{error:.1e}",
            f"{other:.0f}{'' if reached else '*'}",
            f"{evaluations}",
        ]
        print(f"| {case.name} | " + " | ".join(told) + " |", flush=True)
    print()
    worst = sorted(ratios, key=ratios.get)[-3:]
    print("worst true/claimed: " + ", ".join(f"{ratios[name]:.2g} ({name})" for name in reversed(worst)))
    print(f"worst work: {max(works):.1e}")
    print(
        f"DOP853 takes {min(faster):.0f} to {max(faster):.0f} times as long (median {np.median(faster):.0f}), "
        f"with {min(fewer):.2f} to {max(fewer):.2f} times the evaluations (median {np.median(fewer):.2f})"
    )


if __name__ == "__main__":
    main()
