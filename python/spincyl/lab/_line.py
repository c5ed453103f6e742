"""Power law of the time left until a body stops: a straight line in a log-log diagram.

This is the usual first analysis in the literature. The exponent is biased unless the inclination is small: by
0.01 to 0.03 from 0.3 rad on, which is many times the error from the scatter. The line suggests which laws to
try, but cannot decide between them.
"""

from typing import NamedTuple

import numpy as np

from spincyl._input.numbers import Floats


class Line(NamedTuple):
    """Power law of the time that is left until the body stops, fitted in a log-log diagram.

    The fit is quick, but its exponent is biased.

    Attributes
    ----------
    exponent : float
        Exponent of the power law for theta, or for the precession if theta was not measured.
    exponent_err : float
        Standard error of `exponent` from the scatter about the line; the bias is not included.
    stops_at : float
        Stopping time for which the points are closest to a straight line.
    factor : float
        Theta, or the precession, one unit of time before the end.
    """

    exponent: float
    exponent_err: float
    stops_at: float
    factor: float


def line(t: Floats, y: Floats) -> Line | None:
    """Fit a power law of the time left to positive values, and the stopping time that makes it straightest.

    None if the best stopping time is not within 100 times the duration of the data after the last time.
    """
    log_y, last, span = np.log(y), float(t[-1]), float(t[-1] - t[0])

    def off(after: float) -> tuple[float, Floats, Floats]:
        table = np.column_stack([np.ones_like(t), np.log(last + after - t)])
        found = np.linalg.lstsq(table, log_y, rcond=None)[0]
        rest = log_y - table @ found
        return float(rest @ rest), found, rest

    after = span * np.geomspace(1e-6, 1e2, 161)
    worth = np.array([off(a)[0] for a in after])
    k = int(worth.argmin())
    if k in (0, after.size - 1):
        return None
    low, high = np.log(after[k - 1]), np.log(after[k + 1])
    golden = (np.sqrt(5) - 1) / 2
    for _ in range(60):
        a, b = high - golden * (high - low), low + golden * (high - low)
        low, high = (low, b) if off(float(np.exp(a)))[0] < off(float(np.exp(b)))[0] else (a, high)
    best = float(np.exp((low + high) / 2))
    squares, (factor, exponent), _ = off(best)
    left = last + best - t
    table = np.column_stack([np.ones_like(t), np.log(left), exponent / left])
    spread = squares / max(t.size - 3, 1)
    covariance = spread * np.linalg.pinv(table.T @ table)
    return Line(float(exponent), float(np.sqrt(covariance[1, 1])), last + best, float(np.exp(factor)))
