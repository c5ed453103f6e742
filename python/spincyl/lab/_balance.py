"""Fit of measured points to the curve of steady states, by orthogonal distance regression.

```text
theta''(theta, rate / factor; I1/I3) = 0
```
The body is as built, with a sharp or rounded rim, or a ball. The implicit curve allows for errors of both
variables, for forbidden bands and for folds (Boggs and Donaldson 1989, odrpack). The torque is linear in
I1/I3, also beyond the range of real bodies. A factor known with some error adds the residual
(factor - 1)/error.
"""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._input.numbers import Floats, optional_library
from spincyl.lab._report import student

_LEAST_SCATTER = 1e-10  # smallest scatter, in units of the errors: exact points scatter by rounding
# two variables whose effects on the points are correlated more than this cannot be told apart
_INDISTINGUISHABLE = 0.9995


class Fit(NamedTuple):
    """The result of a fit: values of the variables, and their covariance if the given errors are true."""

    names: tuple[str, ...]  #: varied variables, of "ratio" and "factor"
    values: Floats
    covariance: Floats
    squares: float  #: sum of squares over the errors, including the point for the factor
    freedom: int
    success: bool
    fixed: dict[str, float]  #: values of variables that were not varied

    @property
    def chi2(self) -> float:
        """Sum of the squared residuals in units of their errors, per degree of freedom."""
        return self.squares / self.freedom

    @property
    def correlation(self) -> float:
        """Correlation of the two variables; NaN if only one was varied."""
        if len(self.names) < 2:
            return math.nan
        return float(self.covariance[0, 1] / math.sqrt(self.covariance[0, 0] * self.covariance[1, 1]))

    def told(self, known: bool) -> tuple[float, float, float, float]:
        """Fitted ratio, its error, common factor, its error, from the scatter unless errors are `known`."""
        errors = np.sqrt(np.diag(self.covariance) * (1.0 if known else max(self.chi2, _LEAST_SCATTER**2)))
        found = {name: (value, 0.0) for name, value in self.fixed.items()}
        pairs = zip(self.values.tolist(), errors.tolist(), strict=True)
        found |= dict(zip(self.names, pairs, strict=True))
        return *found["ratio"], *found["factor"]


def with_ratio(body: Body, ratio: float) -> Body:
    """The body with another I1, so that I1/I3 is `ratio`; I3, rim, theta_end and size stay the same."""
    return replace(body, i1=ratio * float(body.i3), bore=math.nan)


class Balance:
    """Measured inclinations and rates with their errors, and fits of steady states to them."""

    def __init__(self, body: Body, theta: Floats, rate: Floats, theta_err: Floats, rate_err: Floats) -> None:
        self.odrpack = optional_library("odrpack", "lab")
        i3 = float(body.i3)
        self.i3 = i3
        self.own = {"ratio": float(body.i1) / i3, "factor": 1.0}
        self.sigma = np.stack([theta_err, rate_err])
        self.places = np.stack([theta, rate]) / self.sigma
        self.bodies = [with_ratio(body, ratio) for ratio in (1.0, 2.0)]
        # Change of the torque by one error of theta and of the rate: odrpack enforces the curve by a penalty,
        # and converges if both terms are of the same order.
        own = self.own["ratio"], 1.0
        sides = (
            self.off(self.places + d, *own) - self.off(self.places - d, *own)
            for d in np.eye(2)[..., np.newaxis]
        )
        self.size = np.hypot(*sides) / 2 + 1e-300
        # first guess of the factor, from points where the body as built has a rate
        shares = rate / np.asarray(body.rate(theta))
        shares = shares[np.isfinite(shares)]
        self.guess = float(np.median(shares)) if shares.size else 1.0

    def off(self, place: Floats, ratio: float, factor: float) -> Floats:
        """Unbalanced torque, theta'' times the moment of inertia, at points in units of their errors."""
        inclination, rate = place * self.sigma
        # an inclination beyond the pole is the same state as one with theta - 2 pi
        inclination = np.where(np.abs(inclination) > np.pi, inclination - 2 * np.pi, inclination)
        precession = rate / factor / np.sqrt(self.i3)
        state = self._resting(inclination, precession)
        one, two = (
            _core.acceleration(*state, *trial._numbers) * _core.inertia(*state, *trial._numbers)
            for trial in self.bodies
        )
        found: Floats = one + (ratio - 1) * (two - one)
        return found

    def _resting(self, theta: Floats, precession: Floats) -> tuple[Floats, Floats, float, Floats]:
        """theta, w1, w2 and w3 of rolling with the centre at rest, whether or not such a state is steady."""
        body, w1 = self.bodies[0]._numbers, precession * np.sin(theta)
        # for rolling contact the velocity of the centre along e2 is linear in w1 and w3
        by_w1, by_w3 = (
            _core.centre_across(theta, one, 0.0, 1.0 - one, 0.0, 0.0, *body) for one in (1.0, 0.0)
        )
        return theta, w1, 0.0, -w1 * by_w1 / by_w3

    def tells(self, names: tuple[str, ...]) -> bool:
        """Whether the points determine each of the named variables, and can distinguish two of them."""
        if self.places.shape[1] < len(names) + 2 - (len(names) < 2):
            return False
        changes = self._changes(names, self.own)
        lengths = [float(np.linalg.norm(change)) for change in changes]
        if not min(lengths) > 1:
            return False
        return (
            len(names) < 2
            or abs(float(changes[0] @ changes[1])) < _INDISTINGUISHABLE * lengths[0] * lengths[1]
        )

    def _changes(self, names: tuple[str, ...], there: dict[str, float]) -> list[Floats]:
        """Shifts of the points, in units of their errors, per relative change of each variable."""
        found = []
        for name in names:
            step = 1e-4 * self.own[name]
            low, high = (
                self.off(self.places, **(there | {name: there[name] + side * step})) for side in (-1, 1)
            )
            found.append((high - low) / (2 * step * self.size) * self.own[name])
        return found

    def fit(self, names: tuple[str, ...], common: float = math.inf) -> Fit:
        """Fit the named variables; `common` is the standard error of the factor, expected to be 1."""
        begin = np.array([self.guess if name == "factor" else self.own[name] for name in names])
        if math.isfinite(common):
            begin[names.index("factor")] = 1.0
        fixed = {name: value for name, value in self.own.items() if name not in names}
        places, prior = self.places, math.isfinite(common)
        if prior:  # one more point, on its own line through the origin
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
            # for points without scatter odrpack's penalty hides the rank: take the linearised covariance
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


def doubts_of_ratio(
    found: Fit, alone: Fit, both: Fit | None, own: float, known: bool, *, fitted: bool
) -> str:
    """Text of a warning if no I1/I3 explains the points, or a common factor of the rates does; else ""."""
    one, one_err = alone.told(known)[2:]
    off = f"{abs(one - 1):.1%} too {'large' if one > 1 else 'small'}"
    if one > 1.5 or one < 0.7:
        off = f"{one:.3g} times those of the body as built"
    if found.chi2 > 10:
        hint = "give turns per second as hertz="
        if alone.success and alone.squares < 0.1 * found.squares:
            hint = f"rates {off} would explain them with the ratio as built: {hint}"
        return f"chi2 = {found.chi2:.3g}: no inertia ratio explains these points within their errors; {hint}"
    if fitted:
        return ""
    if both is not None and both.success:
        ratio, _, factor, factor_err = both.told(known)
        if abs(factor - 1) > _equivalent_standard_errors(4.0, both.freedom, known) * factor_err:
            return (
                f"all rates look {abs(factor - 1):.1%} too {'large' if factor > 1 else 'small'}"
                f" ({factor:.4f} +- {factor_err:.1g}, with I1/I3 = {ratio:.4g}): are radius and frame rate"
                " right? common=inf fits this factor of the rates as well"
            )
    ratio, ratio_err, *_ = found.told(known)
    as_well = alone.squares <= found.squares + 4 * (1.0 if known else found.chi2)
    if abs(ratio - own) > _equivalent_standard_errors(3.0, found.freedom, known) * ratio_err and as_well:
        return (
            f"I1/I3 = {ratio:.4g} is {abs(ratio - own) / ratio_err:.1f} errors from {own:.4g}, as built, but"
            f" rates {off} in all points ({one:.4f} +- {one_err:.1g}) explain them as well: are radius and"
            " frame rate right? common=0.03 allows for an error of three per cent"
        )
    return ""


def _equivalent_standard_errors(errors: float, freedom: int, known: bool) -> float:
    """Number of standard errors as unlikely as `errors` normal ones: larger if few points estimate them."""
    return errors if known else student(errors, freedom)
