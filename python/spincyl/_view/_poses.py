"""Poses of a motion for a machine that only interpolates: few knots, and a cubic between them.

Angles and places run smoothly even when a body whirls, so that a steady spin needs two knots and a nutation
four a period. Every interval is halved until its cubic meets the motion within the tolerance.
"""

import numpy as np

from spincyl._array import Floats
from spincyl._motion import Motion, swing

_MOST = 200_000


def span(m: Motion) -> tuple[float, float]:
    """First and last time that there is to show."""
    times = m._asked["times"]
    first = m._asked["t0"] if times.size == 1 else float(times[0])
    if m.event is not None and not m._asked["beyond"]:
        # just before the event, where the state is still one of the model
        return first, m.event.time - 1e-9 * (m.event.time - m._asked["t0"])
    return first, float(m.t[-1])


def knots(m: Motion, tolerance: float = 2e-3) -> Floats:
    """Times, places and slopes from which a page draws the motion.

    Parameters
    ----------
    m : Motion
    tolerance : float
        Largest error of an angle (radians) or of the centre (R) at the places looked at.

    Returns
    -------
    ndarray, shape (n, 11)
        t; theta, phi, psi, x and y of the centre; the slopes of these five. Ascending times.

    Raises
    ------
    ValueError
        If the motion is too long for a page, about 30,000 nutations or 200,000 knots.
    """
    first, last = sorted(span(m))
    if not last > first:
        raise ValueError(f"the motion has no duration to show: it starts at {first:.6g} ({m.message})")
    period = swing(m.body, m.start, m.contact).period
    count = 4 if not np.isfinite(period) else 3 * (last - first) / period
    if count > _MOST / 2:
        raise ValueError(f"{count / 3:.0f} nutations are too many to show: roll over a shorter time")
    found = _poses(m, np.linspace(first, last, max(4, int(count)) + 1))
    open_ = np.ones(len(found) - 1, bool)
    smallest = 1e-7 * (last - first)
    while open_.any():
        left, right = found[:-1][open_], found[1:][open_]
        middle = _poses(m, (left[:, 0] + right[:, 0]) / 2)
        missed = (np.abs(_cubic(left, right, middle[:, 0]) - middle[:, 1:6]) > tolerance).any(axis=1)
        missed &= right[:, 0] - left[:, 0] > smallest
        if len(found) + missed.sum() > _MOST:
            raise ValueError(f"more than {_MOST} poses are needed: roll over a shorter time")
        at = np.flatnonzero(open_)[missed] + 1
        found = np.insert(found, at, middle[missed], axis=0)
        still = np.zeros(len(open_), bool)
        still[at - 1] = True
        open_ = np.insert(still, at, True)
    # and coarser where more than one interval makes a cubic
    while len(found) > 2:
        dropped = np.arange(1, len(found) - 1, 2)
        left, gone, right = found[dropped - 1], found[dropped], found[dropped + 1]
        fits = (np.abs(_cubic(left, right, gone[:, 0]) - gone[:, 1:6]) < tolerance / 4).all(axis=1)
        if not fits.any():
            break
        found = np.delete(found, dropped[fits], axis=0)
    return found


def _poses(m: Motion, t: Floats) -> Floats:
    """Rows of `knots` at ascending times."""
    first, last = sorted(span(m))
    # to the width of a difference quotient that rounding leaves nine digits
    h = 1e-6 * (last - first)
    around = np.clip(t[:, np.newaxis] + [-h, 0.0, h], first, last)
    times, back = np.unique(around, return_inverse=True)
    backward = m._asked["times"][-1] < m._asked["t0"]
    there = m.wanting("pose", t=times[::-1] if backward else times)
    table = np.column_stack([there.theta, there.phi, there.psi, there.centre[:, :2]])
    y = (table[::-1] if backward else table)[back.reshape(around.shape)]
    slopes = (y[:, 2] - y[:, 0]) / (around[:, 2] - around[:, 0])[:, np.newaxis]
    return np.column_stack([t, y[:, 1], slopes])


def _cubic(left: Floats, right: Floats, t: Floats) -> Floats:
    """The five numbers at t between two knots: the page's interpolation."""
    h = (right[:, 0] - left[:, 0])[:, np.newaxis]
    s = (t[:, np.newaxis] - left[:, :1]) / h
    y0, y1, d0, d1 = left[:, 1:6], right[:, 1:6], h * left[:, 6:], h * right[:, 6:]
    cubic: Floats = y0 + s * (d0 + s * (3 * (y1 - y0) - 2 * d0 - d1 + s * (2 * (y0 - y1) + d0 + d1)))
    return cubic
