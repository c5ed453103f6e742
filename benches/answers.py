"""Results of the library in the form of the truth, and their differences from the truth."""

from typing import NamedTuple

import numpy as np
import truth
from draws import Start

import spincyl as sc

KINDS = ("DONE", "FACE", "SIDE", "LIFT_OFF", "SLIP")


class Answer(NamedTuple):
    """The result of one route: a way to call the library."""

    route: str
    by: str  # its method
    path: truth.Path
    error: float  # the estimate of the library
    pose_error: float


class Apart(NamedTuple):
    """Absolute differences of a result from the truth; NaN if there is nothing to compare."""

    kind: bool  # true if they end differently
    states: float
    time: float  # of the end
    end: float  # of the state at the end
    poses: float


def wrapped(turns, rest, angle):
    """The error of an angle that is given as whole turns and a rest."""
    number = type(angle)
    turn = 4 * truth.quarter_turn(number)
    return float(number(float(turns)) * turn + number(float(rest)) - angle)


def apart(found, true, poses=None):
    """The differences of two paths; `poses` has the turns and contact points of the rows of `found`."""
    number = type(true.end[0])
    off = lambda a, b: max(abs(float(number(float(x)) - y)) for x, y in zip(a[:4], b[:4], strict=True))  # noqa: E731
    nan = float("nan")
    count = min(len(found.rows), len(true.rows))
    states = max((off(found.rows[i], true.rows[i]) for i in range(count)), default=nan)
    if found.kind != true.kind:
        return Apart(True, states, nan, nan, nan)
    time = end = nan
    if true.kind != truth.DONE:
        time, end = abs(float(number(float(found.time)) - true.time)), off(found.end, true.end)
    worst = nan
    if poses is not None and count:
        (phi, psi), contact = poses
        worst = 0.0
        for i in range(count):
            y = true.rows[i]
            parts = [wrapped(*phi[i], y[4]), wrapped(*psi[i], y[5])]
            parts += [float(number(float(contact[i][k])) - y[6 + k]) for k in range(2)]
            worst = max(worst, *map(abs, parts))
    return Apart(False, states, time, end, worst)


def rolled(start, times, beyond, want=(), **how):
    """The result of sc.roll and, if `want` has them, its poses; `how`: step= or tol=."""
    m = sc.roll(
        sc.Body(*start[:3]),
        sc.State(*start[3:7]),
        times,
        t0=0.0,
        contact=start.contact,
        mu=start.mu,
        beyond=beyond,
        want=want,
        **how,
    )
    rows = m.y.T
    if m.event is None:
        time, end = times[-1], rows[-1]
    else:
        y = m.event.state
        time, end = m.event.time, np.array([y.theta, y.w1, y.w2, y.w3])
    route = f"roll, {next(iter(how))}" if how else "roll, want" if want else "roll"
    found = truth.Path(int(m.status), time, end, rows)
    return Answer(route, m.method, found, m.error, m.pose_error), (m.turns, m.contact_point) if want else None


def swept(starts, t, beyond):
    """The results of sc.sweep.roll for starts that share contact and mu."""
    columns = np.array([s.numbers for s in starts], dtype=float).T
    d = sc.sweep.roll(
        sc.Body(*columns[:3]),
        sc.State(*columns[3:]),
        t,
        want=("final", "end"),
        contact=starts[0].contact,
        mu=starts[0].mu,
        beyond=beyond,
        threads=1,
    )
    final = np.stack([d[name].values for name in ("theta", "w1", "w2", "w3")], axis=1)
    for i in range(len(starts)):
        kind = int(d["status"].values[i])
        rows = final[i : i + 1] if kind == truth.DONE else final[:0]
        found = truth.Path(kind, float(d["end"].values[i]), final[i], rows)
        by = sc.sweep.Answer(int(d["method"].values[i])).name.lower()
        yield Answer("sweep.roll", by, found, float(d["error"].values[i]), float("nan"))


def routes(starts, t, beyond, ways, sweep=True):
    """(index of the start, times, result or error, poses, options) of every route; `ways` gives `want` and
    the options of `sc.roll` for the next start."""
    both = [t / 3, t]
    for i, start in enumerate(starts):
        for want, how in ways():
            try:
                yield i, both, *rolled(start, both, beyond, want, **how), how
            except ValueError as e:
                yield i, both, e, None, how
    for i, answer in enumerate(swept(starts, t, beyond) if sweep else ()):
        yield i, [t], answer, None, {}


class Noise(NamedTuple):
    """Change of the truth by half an ulp (2^-53) of every input, summed over the inputs; and the kinds of
    ends that occur."""

    kinds: frozenset
    states: float
    time: float
    end: float
    poses: float


#: relative change of an input; its effect is still linear, and far above the rounding of the truth
MOVED = 2.0**-45


def noise(start, times, base, beyond=False, bits=113, moved=MOVED):
    """The noise of a start; `base` is its own truth, with the same number of bits."""
    number = truth.integrator(start.contact, bits, False, True, False).number
    kinds, sums = {base.kind}, np.zeros(4)
    pose = len(base.end) > 4
    for which in (*range(7), 8):
        if which == 8 and not np.isfinite(start.mu):
            continue
        if float(start[which]) == 0:
            continue
        numbers = list(start)
        numbers[which] = number(float(start[which])) * (number(1.0) + number(moved))
        other = truth.path(Start(*numbers), times, bits=bits, pose=pose, beyond=beyond)
        kinds.add(other.kind)
        if other.kind != base.kind:
            continue
        count = min(len(base.rows), len(other.rows))
        rows = [np.abs((other.rows[i] - base.rows[i]).astype(float)) for i in range(count)]
        ends = base.kind != truth.DONE
        sums += [
            max((r[:4].max() for r in rows), default=0.0),
            abs(float(other.time - base.time)) if ends else 0.0,
            np.abs((other.end - base.end)[:4].astype(float)).max() if ends else 0.0,
            max((r[4:].max() for r in rows), default=0.0) if pose else 0.0,
        ]
    return Noise(frozenset(kinds), *(sums * (2.0**-53 / moved)))
