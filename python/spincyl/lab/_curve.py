"""The drift under a loss law as a curve to fit: smooth in the coefficients and in time.

Every law is linear in its coefficient, so the drift with coefficients `lam * k` is that with `k` and a clock
that runs `lam` times as fast. With the centre at rest one drift of unit coefficient therefore serves all
coefficients and starts. For rolling, the path also depends on where the centre was at rest: at the first
time or before, since a measurement seldom begins at the moment of release.
"""

import math
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from spincyl._body import Body
from spincyl._drift import drift
from spincyl._input.numbers import Floats
from spincyl._loss import marked_as_si
from spincyl.loss import ViscousContour
from spincyl.studio.shape import steepest

#: Total coefficient of tabulated drifts: so small that each law holds at all inclinations of the points.
_TABLE_COEFFICIENT = 1e-9
#: Distance from the end of the clock, as a share of it, at which the tangent replaces the curve.
_TANGENT_SHARE = 1e-6


class Curve:
    """The drift of a body under one law or a sum, as a function of coefficients and first inclination.

    `ends` are the least and the greatest first inclination. The tabulated drift starts at the greatest if the
    drift goes `down`, to smaller inclinations, and else at the least. For rolling, one more number may follow
    the coefficients: the inclination at which the centre was at rest, as a share of the way from the first
    inclination to the end where the tabulated drift starts.
    """

    def __init__(
        self, body: Body, laws: Sequence[Any], centre: str, ends: tuple[float, float], down: bool
    ) -> None:
        self.body, self.laws, self.centre, self.ends = body, laws, centre, ends
        self.top, self.down = ends[1] if down else ends[0], down
        self._known: dict[tuple[float, ...], Any] = {}

    def law(self, coefficients: Sequence[float] | Floats) -> Any:
        """The law, or sum of laws, with these coefficients."""
        shares = coefficients[: len(self.laws)]
        made = [marked_as_si(law(float(k))) for law, k in zip(self.laws, shares, strict=True)]
        total = made[0]
        for more in made[1:]:
            total = total + more
        return total

    def drift(self, coefficients: Sequence[float] | Floats, theta: float) -> Any:
        """The drift that starts at the inclination `theta`, with its warnings."""
        law, rested = self.law(coefficients), self.rested(coefficients, theta)
        start: Any = theta
        if rested != theta:
            earlier = drift(self.body, rested, law, centre=self.centre)
            start = earlier.state(earlier.time(theta))
        return drift(self.body, start, law, centre=self.centre)

    def rested(self, coefficients: Sequence[float] | Floats, theta: float) -> float:
        """Inclination at which the centre was at rest, for a drift that is at `theta` at the first time."""
        share = float(coefficients[-1]) if len(coefficients) > len(self.laws) else 0.0
        return theta + share * (self.ends[1 if self.down else 0] - theta)

    def quietly(self, coefficients: Sequence[float] | Floats, theta: float) -> Any:
        """The result of `drift` without warnings, for trials of a fit."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return self.drift(coefficients, theta)

    def times(self, coefficients: Sequence[float] | Floats, theta: Floats) -> Floats:
        """Times at which a drift from `top` (if rolling, from the first inclination) passes inclinations."""
        begin = self.top
        if self.centre != "rest":
            begin = float(theta.max() if self.down else theta.min())
        drift, pace, _ = self._on_the_clock(coefficients, begin)
        found: Floats = np.asarray(drift.time(theta)) / pace
        return found

    def stops_at(self, coefficients: Sequence[float] | Floats, theta: float) -> float:
        """Time from `theta` to the end of the drift; infinite if it never ends."""
        drift, pace, begun = self._on_the_clock(coefficients, theta)
        return (float(drift.stops_at) - begun) / pace

    def __call__(
        self, names: Sequence[str], time: Floats, coefficients: Sequence[float] | Floats, theta: float
    ) -> Floats:
        """Rows of the outputs `names`, "theta" or "precession", at times since the drift passed `theta`."""
        drift, pace, begun = self._on_the_clock(coefficients, theta)
        clock = begun + pace * time
        return np.stack([_continued(getattr(drift, name), clock, float(drift.stops_at)) for name in names])

    def _on_the_clock(self, coefficients: Sequence[float] | Floats, theta: float) -> tuple[Any, float, float]:
        """A tabulated drift, the factor from time to its clock, and the reading of its clock at `theta`."""
        if self.centre == "rest":  # a fit may exceed its bounds slightly
            theta = min(max(float(theta), self.ends[0]), self.ends[1])
        total = float(sum(coefficients[: len(self.laws)]))
        shares = [float(k) / total for k in coefficients[: len(self.laws)]]
        top = self.top if self.centre == "rest" else self.rested(coefficients, theta)
        key = (top, *shares)
        if key not in self._known:
            if len(self._known) > 8:
                self._known.clear()
            self._known[key] = self.quietly([_TABLE_COEFFICIENT * share for share in shares], top)
        drift = self._known[key]
        return drift, total / _TABLE_COEFFICIENT, 0.0 if top == theta else float(drift.time(theta))


def _continued(shown: Any, clock: Floats, stop: float) -> Floats:
    """Values of a drift at times, continued by tangents beyond its beginning and end."""
    last = (1 - _TANGENT_SHARE) * stop
    inside = np.clip(clock, 0.0, last)
    found = np.array(shown(inside), np.float64)
    step = _TANGENT_SHARE * (stop if np.isfinite(stop) else float(np.abs(clock).max()) + 1.0)
    for outside, end, side in ((clock < 0, 0.0, step), (clock > last, last, -step)):
        if outside.any():
            there, beside = shown(np.array([end, end + side]))
            found[outside] += (beside - there) / side * (clock - inside)[outside]
    return found


def branches(body: Body, centre: str) -> list[Floats]:
    """Ranges of inclination that a single drift can pass through, as arrays of inclinations in radians.

    The ranges end at the forbidden band; with the centre at rest also at extremes of the energy, for rolling
    also where stability is lost.
    """
    most = steepest(body)
    wide = np.linspace(0.0, most, math.ceil(4000 * most / (np.pi / 2)) + 1)[1:]
    theta = np.unique(np.r_[np.geomspace(1e-5, min(0.1, most), 400), wide])
    steady = body.steady(theta)
    allowed = np.isfinite(steady.precession) & (steady.precession > 0)
    if centre == "rest":
        energy = body.energy(steady)
        mark = np.sign(np.gradient(energy, theta))
        # one-sided differences next to points without an energy
        for slope in (np.r_[np.diff(energy), np.nan], np.r_[np.nan, np.diff(energy)]):
            mark = np.where(np.isnan(mark), np.sign(slope), mark)
        mark = np.nan_to_num(np.where(allowed, mark, 0)).astype(int)
    else:
        mark = np.where(allowed & (body.stability(theta) > 0), 1, 0)
    pieces = np.split(np.arange(theta.size), np.flatnonzero(np.diff(mark)) + 1)
    return [theta[piece] for piece in pieces if mark[piece[0]] != 0 and piece.size >= 8]


def goes_down(body: Body, centre: str, theta: float) -> bool:
    """Whether a drift from `theta`, which is inside a branch, goes to smaller inclinations."""
    if centre == "rest":  # towards smaller energy
        low, high = (body.energy(body.steady(theta * (1 + sign * 1e-5))) for sign in (-1, 1))
        return bool(low < high)
    return (
        float(drift(body.natural, theta, ViscousContour(_TABLE_COEFFICIENT), centre=centre).ends_at_theta)
        < theta
    )
