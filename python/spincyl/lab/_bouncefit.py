"""Times of bounces as sums of flights: a fit with scatter of the clicks and of the restitution."""

import math
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spincyl._input.numbers import Floats
from spincyl.lab._report import student

Numbers: TypeAlias = NDArray[np.int64]

_TREND = 3.0  #: Standard errors beyond which a coefficient is not zero.
_JITTERS = np.geomspace(1e-4, 1.5e-3, 6)  #: Scatter of the times of clicks in seconds, if it is not known.
_EACH = np.concatenate([[0.0], np.geomspace(0.002, 0.1, 10)])  #: Relative scatter of the restitution.
#: Prior probability that the restitution does not scatter, with and without a known error of the clicks.
_STEADY, _STEADY_UNKNOWN = 0.95, 0.05
_ROUNDS = 4  #: Linearisations.
_RARE = 1e-3  #: Probability below which a pair of scatters is left out.


def logarithms(at: Floats, n: Numbers) -> tuple[Floats, Floats]:
    """Numbers of the intervals, and logarithms; a gap with missed bounces counts by its first interval."""
    gap, y = np.diff(n), np.log(np.diff(at))
    start, first, e = n[:-1].astype(np.float64), y, 1.0
    for _ in range(20 if (gap > 1).any() else 0):
        first = y - np.log([sum(e**s for s in range(m)) for m in gap])
        e = math.exp(slope_of(start, first))
    return start, first


def slope_of(x: Floats, y: Floats) -> float:
    """Slope of the straight line that fits points best; 0 for a single point."""
    off = x - x.mean()
    return float(off @ y / (off @ off)) if x.size > 1 else 0.0


class FlightLine(NamedTuple):
    """Logarithms of the intervals as a polynomial of the number of the bounce."""

    beta: Floats
    covariance: Floats
    each: float  #: relative scatter of the restitution of a bounce
    jitter: float  #: scatter of the times of clicks
    sure: float  #: standard errors beyond which a coefficient is not zero

    def at(self, n: float) -> tuple[float, float]:
        """The logarithm of the interval after bounce n, and its standard error."""
        row = float(n) ** np.arange(self.beta.size)
        return float(row @ self.beta), math.sqrt(max(float(row @ self.covariance @ row), 0.0))


def fitted(at: Floats, n: Numbers, degree: int, error: float) -> FlightLine:
    """Fit the polynomial to times of clicks, more than unknowns, by generalised least squares.

    A time is that of the first impact plus the flights before it, so that it belongs to two intervals; a
    restitution that deviates at one bounce changes all later flights. The result is a mean over both
    scatters, weighted by restricted likelihood and prior probability.
    """
    known, last = math.isfinite(error), int(n[-1] - n[0])
    # only sums of the flights between two clicks that were heard are known
    number_ = n[0] + np.arange(last, dtype=np.float64)
    x = number_[:, np.newaxis] ** np.arange(degree + 1)
    before = np.tri(last + 1, last, -1)[n - n[0]]
    start, y = logarithms(at, n)
    beta = np.zeros(degree + 1)
    beta[1] = slope_of(start, y)
    beta[0] = y.mean() - beta[1] * start.mean()
    begin = float(at[0])
    jitters = np.array([error]) if known else _JITTERS
    steady = _STEADY if known else _STEADY_UNKNOWN
    prior = np.log(np.r_[steady, np.full(_EACH.size - 1, (1 - steady) / (_EACH.size - 1))])
    v = np.eye(at.size)
    for k in range(_ROUNDS):
        flights = before * np.exp(x @ beta)
        jacobian = np.column_stack([np.ones(at.size), flights @ x])
        scattered = flights @ np.tri(last)[:, 1:]
        walk = scattered @ scattered.T
        off = at - begin - flights.sum(axis=1)
        if k == _ROUNDS - 1:
            break
        step, _ = _least_squares(jacobian, v, off)
        begin, beta = begin + step[0], beta + step[1:]
        weight = _weights(jacobian, walk, off, jitters, prior)
        a, b = np.unravel_index(weight.argmax(), weight.shape)
        v = jitters[a] ** 2 * np.eye(at.size) + _EACH[b] ** 2 * walk
    weight = _weights(jacobian, walk, off, jitters, prior)
    weight[weight < _RARE * weight.max()] = 0
    weight /= weight.sum()
    pairs = np.argwhere(weight)
    found = [
        _least_squares(jacobian, jitters[a] ** 2 * np.eye(at.size) + _EACH[b] ** 2 * walk, off)
        for a, b in pairs
    ]
    share = weight[pairs[:, 0], pairs[:, 1]]
    steps = np.array([one[0] for one in found])
    mean = share @ steps
    covariance = np.tensordot(share, np.array([one[1] for one in found]), 1)
    covariance += (share[:, np.newaxis] * (steps - mean)).T @ (steps - mean)
    free = max(at.size - degree - 2, 1)
    sure = _TREND if known else student(_TREND, free) / student(1.0, free)
    each = math.sqrt(float(weight.sum(axis=0) @ _EACH**2))
    jitter = math.sqrt(float(weight.sum(axis=1) @ jitters**2))
    return FlightLine(beta + mean[1:], covariance[1:, 1:], each, jitter, sure)


def _least_squares(jacobian: Floats, v: Floats, off: Floats) -> tuple[Floats, Floats]:
    """Steps of the unknowns by generalised least squares, and their covariance."""
    size = np.sqrt(np.diag(v))
    lower = np.linalg.cholesky(v / np.outer(size, size))
    both = np.linalg.solve(lower, np.column_stack([jacobian, off]) / size[:, np.newaxis])
    q, r = np.linalg.qr(both[:, :-1])
    inverse = np.linalg.inv(r)
    return inverse @ (q.T @ both[:, -1]), inverse @ inverse.T


def _weights(jacobian: Floats, walk: Floats, off: Floats, jitters: Floats, prior: Floats) -> Floats:
    """Probabilities of the pairs of both scatters, by restricted likelihood: (jitters, each)."""
    across = np.linalg.qr(jacobian, mode="complete")[0][:, jacobian.shape[1] :]
    size, modes = np.linalg.eigh(across.T @ walk @ across)
    square = (modes.T @ (across.T @ off)) ** 2
    variance = jitters[:, np.newaxis, np.newaxis] ** 2 + _EACH[:, np.newaxis] ** 2 * np.maximum(size, 0.0)
    log = prior - 0.5 * (np.log(variance) + square / variance).sum(axis=-1)
    weight = np.exp(log - log.max())
    found: Floats = weight / weight.sum()
    return found
