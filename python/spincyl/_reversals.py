"""The times at which the spin of a stone reverses, found on its solution between the times of a motion."""

from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._input.numbers import Floats

if TYPE_CHECKING:
    from spincyl._ellipsoid_motion import EllipsoidMotion

# a reversal is what `src/motions/stone/turns.rs` counts in sweeps: these are its `COUNTS` and `NONE`
_COUNTS, _NONE = 0.1, 1e-12
# between two spots the spin changes by less than this share of the initial spin, except in an impact
_CHANGE, _HALVINGS = 0.03, 6
_PARTS = np.linspace(0.0, 1.0, 129)


def _spin(m: "EllipsoidMotion", t: Floats) -> Floats:
    at: Any = m.at(t)
    found: Floats = at.spin
    return found


def reversal_times(m: "EllipsoidMotion") -> Floats:
    """Times at which the spin of a motion reverses, in ascending order; motion and times in natural units."""
    begin, end = m._asked.t0, m.known_until
    found: list[float] = []
    spin = float(m.start.spin)
    if begin == end or abs(spin) <= _NONE * max(1.0, float(np.abs(m.start.w).max())):
        return np.array(found)
    t = np.linspace(begin, end, m.nfev // 12 + 2)
    spins = _spin(m, t)
    for _ in range(_HALVINGS):
        wide = np.flatnonzero(np.abs(np.diff(spins)) > _CHANGE * abs(spin))
        if not wide.size:
            break
        t = np.insert(t, wide + 1, 0.5 * (t[wide] + t[wide + 1]))
        spins = _spin(m, t)
    side, crossed, enough = np.sign(spin), 0, _COUNTS * abs(spin)
    for k in range(1, spins.size):
        if side * spins[k - 1] >= 0 > side * spins[k]:
            crossed = k
        if side * spins[k] <= -enough:
            found.append(_zero(m, t[crossed - 1], t[crossed], side))
            side = -side
    return np.array(found)


def _zero(m: "EllipsoidMotion", before: float, after: float, side: float) -> float:
    """Last time between two times at which the spin is zero, to rounding; `side` is its sign before."""
    while True:
        t = np.unique(before + (after - before) * _PARTS)[:: 1 if after > before else -1]
        if t.size < 3:
            return float(after)
        last = int(np.flatnonzero(side * _spin(m, t) >= 0)[-1])
        if last + 1 == t.size:
            return float(after)
        if before == t[last] and after == t[last + 1]:
            return float(after)
        before, after = t[last], t[last + 1]
