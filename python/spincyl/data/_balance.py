"""Measured points about the curve of steady states: orthogonal distance regression of the implicit curve.

```text
theta''(theta, rate / factor; I1/I3) = 0
```
of the body as it was built, its rim sharp or rounded, or a ball. Both errors count, and forbidden bands and
folds do no harm (Boggs and Donaldson 1989, odrpack). The torque is linear in the ratio, also beyond those of
real bodies. A factor that is known to some error is one more point of the fit, (factor - 1)/error.
"""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._input.numbers import Floats, extra
from spincyl._state import State

_ROUNDED = 1e-10  # of the errors that points may have: those of exact ones, which are rounded
_ALIKE = 0.9995  # two variables that change all points alike to this correlation are one


class Fit(NamedTuple):
    """What a fit gave: the variables in order, their covariance in units of the errors given."""

    names: tuple[str, ...]  #: of "ratio" and "factor"
    values: Floats
    covariance: Floats
    squares: float  #: sum over the errors, what is known of the factor included
    freedom: int
    success: bool
    fixed: dict[str, float]  #: those that were not varied

    @property
    def chi2(self) -> float:
        """Per degree of freedom."""
        return self.squares / self.freedom

    @property
    def correlation(self) -> float:
        """Of the two variables; NaN if only one was varied."""
        if len(self.names) < 2:
            return math.nan
        return float(self.covariance[0, 1] / math.sqrt(self.covariance[0, 0] * self.covariance[1, 1]))

    def told(self, known: bool) -> tuple[float, float, float, float]:
        """Ratio, its error, factor, its error: from the scatter if those of the points are not known."""
        errors = np.sqrt(np.diag(self.covariance) * (1.0 if known else max(self.chi2, _ROUNDED**2)))
        found = {name: (value, 0.0) for name, value in self.fixed.items()}
        pairs = zip(self.values.tolist(), errors.tolist(), strict=True)
        found |= dict(zip(self.names, pairs, strict=True))
        return *found["ratio"], *found["factor"]


def with_ratio(body: Body, ratio: float) -> Body:
    """The same body with this I1/I3, its axial moment, rim, end and size kept."""
    return replace(body, i1=ratio * float(body.i3), bore=math.nan)


class Balance:
    """Measured inclinations and rates with their errors, and the torque left where the centre rests."""

    def __init__(self, body: Body, theta: Floats, rate: Floats, theta_err: Floats, rate_err: Floats) -> None:
        self.odrpack = extra("odrpack", "lab")
        i3 = float(body.i3)
        self.i3 = i3
        self.own = {"ratio": float(body.i1) / i3, "factor": 1.0}
        self.sigma = np.stack([theta_err, rate_err])
        self.places = np.stack([theta, rate]) / self.sigma
        self.bodies = [with_ratio(body, ratio) for ratio in (1.0, 2.0)]
        # how much an error of theta and of the rate change it: odrpack enforces the curve by a penalty, and
        # converges where both are of one size
        own = self.own["ratio"], 1.0
        sides = (
            self.off(self.places + d, *own) - self.off(self.places - d, *own)
            for d in np.eye(2)[..., np.newaxis]
        )
        self.size = np.hypot(*sides) / 2 + 1e-300
        # a first guess of the factor, where the body as built has a rate
        shares = rate / np.asarray(body.rate(theta))
        shares = shares[np.isfinite(shares)]
        self.guess = float(np.median(shares)) if shares.size else 1.0

    def off(self, place: Floats, ratio: float, factor: float) -> Floats:
        """Torque left at places in units of their errors: theta'' times the inertia of tilting."""
        inclination, rate = place * self.sigma
        # a trial may be beyond the pole, where a state is known by its other angle
        inclination = np.where(np.abs(inclination) > np.pi, inclination - 2 * np.pi, inclination)
        precession = rate / factor / np.sqrt(self.i3)
        state = self._resting(inclination, precession)
        one, two = (
            trial.acceleration(state) * _core.inertia(*state._numbers, *trial._numbers)
            for trial in self.bodies
        )
        found: Floats = one + (ratio - 1) * (two - one)
        return found

    def _resting(self, theta: Floats, precession: Floats) -> State:
        """The rolling state whose centre rests, steady or not: the same whatever the moments are."""
        body, w1 = self.bodies[0], precession * np.sin(theta)
        # with the centre at rest, the point that touches the table moves with w1 and with w3
        by_w1, by_w3 = (
            body.with_centre_velocity(State(theta, one, 0.0, 1.0 - one), 0.0, 0.0).slip for one in (1.0, 0.0)
        )
        assert by_w1 is not None and by_w3 is not None
        return State(theta, w1, 0.0 * w1, -w1 * by_w1[1] / by_w3[1])

    def tells(self, names: tuple[str, ...]) -> bool:
        """Whether the points say something of each of these, and tell two of them apart."""
        if self.places.shape[1] < len(names) + 2 - (len(names) < 2):
            return False
        changes = self._changes(names, self.own)
        lengths = [float(np.linalg.norm(change)) for change in changes]
        if not min(lengths) > 1:
            return False
        return len(names) < 2 or abs(float(changes[0] @ changes[1])) < _ALIKE * lengths[0] * lengths[1]

    def _changes(self, names: tuple[str, ...], there: dict[str, float]) -> list[Floats]:
        """By how many errors the points are off if one of these grows by its own size."""
        found = []
        for name in names:
            step = 1e-4 * self.own[name]
            low, high = (
                self.off(self.places, **(there | {name: there[name] + side * step})) for side in (-1, 1)
            )
            found.append((high - low) / (2 * step * self.size) * self.own[name])
        return found

    def fit(self, names: tuple[str, ...], common: float = math.inf) -> Fit:
        """The values that explain the points best; `common` is what the factor may differ from 1 by."""
        begin = np.array([self.guess if name == "factor" else self.own[name] for name in names])
        if math.isfinite(common):
            begin[names.index("factor")] = 1.0
        fixed = {name: value for name, value in self.own.items() if name not in names}
        places, prior = self.places, math.isfinite(common)
        if prior:  # one more point, at the origin of its own line
            places = np.column_stack([places, np.zeros(2)])

        def left(place: Floats, beta: Floats) -> Floats:
            now = fixed | dict(zip(names, beta.tolist(), strict=True))
            points = self.off(place[:, :-1] if prior else place, **now) / self.size
            return np.append(points, place[0, -1] - (now["factor"] - 1) / common) if prior else points

        found = self.odrpack.odr_fit(
            left,
            places,
            np.zeros(places.shape[1]),
            begin,
            task="implicit-ODR",
            diff_scheme="central",
            maxit=200,
        )
        values = np.asarray(found.beta, np.float64)
        covariance = np.asarray(found.cov_beta, np.float64)
        if not (np.diag(covariance) > 0).all():
            # about points without scatter the penalty is so steep that odrpack sees no rank: to first order
            there = fixed | dict(zip(names, values.tolist(), strict=True))
            table = np.stack(self._changes(names, there), -1) / [self.own[name] for name in names]
            if prior:
                table = np.vstack([table, [(name == "factor") / common for name in names]])
            covariance = np.asarray(np.linalg.pinv(table.T @ table), np.float64)
        return Fit(
            names,
            values,
            covariance,
            squares=float(found.sum_square_delta),
            freedom=places.shape[1] - len(names),
            success=found.info % 10 in (1, 2, 3) and bool(np.isfinite(values).all()),
            fixed=fixed,
        )
