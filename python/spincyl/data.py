"""Measured data: tables that Tracker exports, and how far a body's steady states are from them."""

import math
import warnings
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from spincyl import _core
from spincyl._array import Floats, Reals, extra, is_scalar, reals
from spincyl._body import Body
from spincyl._state import State
from spincyl._tracker import read_tracker

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Comparison", "compare", "read_tracker"]


class Comparison(NamedTuple):
    """Measured inclinations and rates beside a body's steady states; from `compare`."""

    body: Body
    theta: Floats  #: (n,) measured, radians, without what was not measured
    rate: Floats  #: (n,) measured reduced rates
    theta_err: Floats  #: (n,) standard errors
    rate_err: Floats
    residual: Floats  #: (n,) measured rate less that of the body; NaN where it is forbidden
    ratio: float  #: the inertia ratio I1/I3 that fits best
    ratio_err: float  #: its standard error
    expected: float  #: the body's own
    chi2: float  #: sum of squares over the errors, per degree of freedom

    def __repr__(self) -> str:
        return (
            f"<Comparison: I1/I3 = {self.ratio:.6g} +- {self.ratio_err:.2g}, built {self.expected:.6g};"
            f" {len(self.theta)} points, chi2 {self.chi2:.3g}>"
        )

    def _repr_html_(self) -> str:
        from spincyl import _html

        return _html.comparison(self)

    @property
    def fitted(self) -> Body:
        """The body with the fitted ratio, at least the 1/2 of a real one, its axial moment kept."""
        return Body(self.body.ell, max(self.ratio, 0.5) * self.body.i3, self.body.i3)

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """Draw the measurement with its error bars, the body's branches and the fitted ones."""
        from spincyl.plot import comparison

        return comparison(self, ax)


def compare(
    body: Body,
    theta: Reals,
    rate: Reals,
    *,
    theta_err: Reals | None = None,
    rate_err: Reals | None = None,
) -> Comparison:
    """How well a body's steady states explain a measurement, and which inertia ratio explains it best.

    Parameters
    ----------
    body : Body
        What is believed: aspect ratio and moments. A single one.
    theta : array_like, 1-D
        Inclinations in radians.
    rate : array_like, 1-D
        Reduced rates: turns per second over `scale.hertz(body, 1.0)`.
    theta_err, rate_err : array_like, optional
        Standard errors, both or none. Without, points are weighed by a degree and two per cent, and their
        scatter gives the error of the ratio.

    Returns
    -------
    Comparison

    Raises
    ------
    ValueError
        For fewer than three different points, shapes that differ, rates and errors that are not positive, a
        fit that fails, and points that say nothing of the ratio.
    TypeError
        For anything but a body and real numbers.
    ImportError
        Without spincyl[lab].

    Warns
    -----
    UserWarning
        If chi2 exceeds 10.

    Notes
    -----
    Orthogonal distance regression (Boggs and Donaldson 1989) by odrpack: both errors count, and the curve is
    the implicit one on which theta'' vanishes, so that forbidden bands and folds do no harm. Points with an
    empty theta or rate are left out.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> body = sc.Body.solid(2.5)
    >>> theta = np.radians([5.0, 10.0, 15.0, 70.0, 80.0])
    >>> found = sc.data.compare(body, theta, body.rate(theta))
    >>> round(found.ratio, 6), round(body.i1 / body.i3, 6)
    (4.666667, 4.666667)
    """
    if not isinstance(body, Body):
        raise TypeError(f"body: expected a Body, not {type(body).__name__}")
    if not is_scalar(body.ell, body.i1, body.i3):
        raise ValueError("body: expected a single one, not an array of them")
    odrpack = extra("odrpack", "lab")
    x = {name: np.asarray(reals(name, v), np.float64) for name, v in (("theta", theta), ("rate", rate))}
    if x["theta"].ndim != 1 or x["rate"].shape != x["theta"].shape:
        shapes = f"{x['theta'].shape} and {x['rate'].shape}"
        raise ValueError(f"theta and rate: expected one shape (n,), not {shapes}")
    measured = np.isfinite(x["theta"]) & np.isfinite(x["rate"])
    known = theta_err is not None
    if known != (rate_err is not None):
        raise ValueError("theta_err and rate_err: give both or none")
    default = {"theta_err": np.radians(1.0), "rate_err": 0.02 * x["rate"]}
    for name, given in (("theta_err", theta_err), ("rate_err", rate_err)):
        errors = np.asarray(default[name] if given is None else reals(name, given), np.float64)
        if errors.shape not in ((), x["theta"].shape):
            raise ValueError(f"{name}: expected a number or shape {x['theta'].shape}, not {errors.shape}")
        x[name] = np.broadcast_to(errors, x["theta"].shape)
    x = {name: values[measured] for name, values in x.items()}
    if not ((x["theta"] > 0) & (x["theta"] <= np.pi / 2)).all():
        raise ValueError("theta: expected inclinations in (0, pi/2], in radians")
    if not ((x["rate"] >= 1e-6) & (x["rate"] <= 1e6)).all():
        raise ValueError("rate: expected reduced rates from 1e-6 to 1e6")
    for name, of in (("theta_err", 1.0), ("rate_err", x["rate"])):
        if not ((x[name] >= 1e-12 * of) & (x[name] <= 1e3 * of)).all():
            raise ValueError(f"{name}: expected positive numbers, 1e-12 to 1e3 of a radian or of the rate")
    if len(np.unique(np.stack([x["theta"], x["rate"]]), axis=1).T) < 3:
        raise ValueError("theta and rate: expected at least three different points")
    ell, i3 = float(body.ell), float(body.i3)

    sigma = np.stack([x["theta_err"], x["rate_err"]])
    places = np.stack([x["theta"], x["rate"]]) / sigma

    bodies = [Body(ell, ratio * i3, i3) for ratio in (1.0, 2.0)]

    def off(place: Floats, ratio: Floats) -> Floats:
        """Torque left where the centre rests, at places in units of their errors: zero on the curve."""
        inclination, rate = place * sigma
        w1 = rate / np.sqrt(i3) * np.sin(inclination)
        state = State(inclination, w1, 0.0 * w1, ell * w1)
        # theta'' times the inertia of tilting; linear in the ratio, also beyond those of real bodies
        one, two = (
            trial.acceleration(state) * _core.inertia(*state._numbers, *trial._numbers) for trial in bodies
        )
        found: Floats = one + (ratio[0] - 1) * (two - one)
        return found

    own = np.array([float(body.i1) / i3])
    # how much an error of theta and of the rate change it: odrpack enforces the curve by a penalty, and
    # converges where both are of one size
    sides = (off(places + d, own) - off(places - d, own) for d in np.eye(2)[..., np.newaxis])
    size = np.hypot(*sides) / 2 + 1e-300
    step = 1e-4 * own
    told = (off(places, own + step) - off(places, own - step)) / (2 * step * size)
    if not np.linalg.norm(told) * own > 1:
        raise ValueError("theta and rate: these points say nothing of I1/I3, as near 90 degrees")
    found = odrpack.odr_fit(
        lambda place, ratio: off(place, ratio) / size,
        places,
        np.zeros_like(size),
        own,
        task="implicit-ODR",
        diff_scheme="central",
        maxit=200,
    )
    freedom = len(x["theta"]) - 1
    chi2 = float(found.sum_square_delta) / freedom
    ratio = float(found.beta[0])
    error = math.sqrt(float(found.cov_beta[0, 0]) * (1.0 if known else chi2))
    # of a real body, I3 is at most 2 I1; errors may make it look like a little more
    if not found.success or not ratio + 5 * error >= 0.5:
        raise ValueError(f"no real body fits: I1/I3 = {ratio:.3g}; is rate in units of scale.hertz(body, 1)?")
    if chi2 > 10:
        warnings.warn(
            f"chi2 = {chi2:.3g}: no inertia ratio explains these points within their errors;"
            " is rate in units of scale.hertz(body, 1)?",
            UserWarning,
            stacklevel=2,
        )
    return Comparison(
        body=body,
        theta=x["theta"],
        rate=x["rate"],
        theta_err=x["theta_err"],
        rate_err=x["rate_err"],
        residual=x["rate"] - body.rate(x["theta"]),
        ratio=ratio,
        ratio_err=error,
        expected=float(own[0]),
        chi2=chi2,
    )
