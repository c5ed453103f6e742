"""Which loss a measured spin-down is explained by: drifts are fitted, and laws compared by AIC."""

import math
import warnings
from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

import numpy as np

from spincyl._array import Floats, Reals, extra
from spincyl._body import Body
from spincyl.data._curve import Curve
from spincyl.data._line import line
from spincyl.data._lossfit import FittedLoss, LossFit, called, in_si
from spincyl.data._spindown import SpinDown, asked, measured

_CORRELATED = 0.999  #: two coefficients more than this are one


def fit_losses(
    t: Reals,
    theta: Reals | None = None,
    precession: Reals | None = None,
    *,
    body: Body,
    laws: Sequence[Any] | None = None,
    centre: Literal["rest", "rolling"] = "rest",
    t_err: Reals | None = None,
    theta_err: Reals | None = None,
    precession_err: Reals | None = None,
    start: float | None = None,
) -> LossFit:
    """Which laws of loss explain a measured spin-down, with which coefficients and stopping times.

    Parameters
    ----------
    t : array_like, 1-D
        Times that do not fall, in sqrt(R/g); of a measured body in seconds.
    theta : array_like, optional
        Inclinations in radians.
    precession : array_like, optional
        Precession phi' in sqrt(g/R); of a measured body in rad/s, 2 pi times the turns in a second. Give
        `theta`, `precession` or both; what was not measured at a time is NaN.
    body : Body
        A single one. Of a measured one all times and precessions, given and found, are in seconds and rad/s;
        coefficients have no unit.
    laws : sequence, optional
        Classes of `spincyl.loss`; a tuple or list of two stands for their sum. Default: all eight.
    centre : {"rest", "rolling"}
        Which drift: the centre held at rest, or rolling from the first time on, at which the centre rests.
    t_err : array_like, optional
        Standard errors of the times. Default: none, all scatter is that of `theta` and `precession`.
    theta_err, precession_err : array_like, optional
        Standard errors. Default: every value errs by the same share of itself, which the scatter about the
        best law gives.
    start : float, optional
        About where it starts, in radians: for a precession alone that several inclinations could have.

    Returns
    -------
    LossFit

    Raises
    ------
    ValueError
        For fewer than five points and for shapes that differ; for values that are not positive, that do not
        drift, drift against the loss, or lie in the forbidden band; for a sum of two laws that the points
        cannot tell apart.
    TypeError
        For anything but a body, laws and real numbers.
    ImportError
        Without spincyl[lab].

    Warns
    -----
    UserWarning
        If chi2 exceeds 10 for every law; if the precession is a quarter and more off that of steady states at
        the same inclinations, as in other units; and what the fitted drift warns of.

    Notes
    -----
    The drift itself is fitted by orthogonal distance regression (Boggs and Donaldson 1989, odrpack), not the
    line in a log-log diagram, whose exponent is biased beyond its error. Laws that cannot be told apart are
    no error: the table says so. From the precession alone a coefficient depends on `centre` by 5 to 10 per
    cent.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> disk = sc.Body.solid(0.17)
    >>> true = sc.drift(disk, 0.3, sc.loss.DryContour(1e-3))
    >>> t = np.linspace(0.0, 0.95 * true.stops_at, 100)
    >>> found = sc.data.fit_losses(t, true.theta(t), body=disk)
    >>> found.best.name, round(found.best.coefficient, 9)
    ('DryContour', 0.001)
    """
    odrpack = extra("odrpack", "lab")
    sums = asked(laws, centre)
    data = measured(
        body, t, theta, precession, t_err, theta_err, precession_err, centre, start, max(map(len, sums))
    )
    units = "natural units" if body.scale is None else "seconds and rad/s"
    factor = data.off_by(body)
    if not 0.8 < factor < 1.25:
        told = f"the precession is {factor:.3g} times that of steady states at these inclinations"
        asks = f"are times and precession in {units}, and is its size right?"
        warnings.warn(f"{told}; {asks}", UserWarning, stacklevel=2)
    curves = [Curve(body.natural, s, centre, data.ends, data.down) for s in sums]
    found = [_fitted(odrpack, data, curve, None) for curve in curves]
    if data.estimated:
        # all laws with the same errors, so that their AIC can be compared
        best = min(found, key=lambda f: f.chi2 + 2 * len(f.beta))
        shown = best.curve(data.names, data.t - data.t[0], best.beta[:-1], best.beta[-1])
        data = data.weighed(shown, len(best.beta))
        found = [_fitted(odrpack, data, f.curve, f.beta) for f in found]
    for one in found:
        _refuse_degenerate(data, one)
    aic = [_aic(data, f) for f in found]
    order = np.argsort(aic, kind="stable")
    fits = [_told(data, found[k], aic[k], aic[k] - min(aic)) for k in order]
    best = found[order[0]]  # which is the one that may warn
    fits[0] = fits[0]._replace(drift=best.curve.drift(best.beta[:-1], float(best.beta[-1])))
    if fits[0].chi2 > 10:
        warnings.warn(
            f"chi2 = {fits[0].chi2:.3g}: no law explains these points within their errors;"
            f" are times and precession in {units}?",
            UserWarning,
            stacklevel=2,
        )
    first = data.values[0]
    seen = np.isfinite(first)
    columns = dict(zip(data.names, zip(data.values, data.errors, strict=True), strict=True))
    (theta_, theta_err_), (precession_, precession_err_) = (
        columns.get(n, (None, None)) for n in ("theta", "precession")
    )
    fit = LossFit(
        body=body.natural,
        centre=centre,
        t=data.t,
        theta=theta_,
        precession=precession_,
        t_err=data.t_err,
        theta_err=theta_err_,
        precession_err=precession_err_,
        estimated=data.estimated,
        fits=tuple(fits),
        line=line(data.t[seen], first[seen]) if data.down else None,
    )
    return fit if body.scale is None else in_si(fit, body, body.scale.seconds(1.0))


class _Raw(NamedTuple):
    """A fit by odrpack: coefficients and first inclination, and their covariance in units of the errors."""

    curve: Curve
    beta: Floats
    covariance: Floats
    chi2: float  # the sum


def _fitted(odrpack: Any, data: SpinDown, curve: Curve, begin: Floats | None) -> _Raw:
    """The fit of one law, from coefficients and an inclination to begin with, or from a guess."""
    if begin is None:
        begin = _guess(odrpack, data, curve)
    low, high = curve.ends
    begin = np.r_[begin[:-1], np.clip(begin[-1], low, high)]
    time, exact = data.t - data.t[0], not data.t_err.any()
    weights = np.where(np.isfinite(data.values), data.errors**-2.0, 0.0)
    found = odrpack.odr_fit(
        lambda x, beta: curve(data.names, x, beta[:-1] * begin[:-1], beta[-1] * begin[-1]).squeeze(),
        time,
        np.where(np.isfinite(data.values), data.values, 1.0).squeeze(),
        np.ones_like(begin),
        weight_x=None if exact else data.t_err**-2.0,
        weight_y=weights.squeeze(),
        bounds=(
            np.r_[np.full(begin.size - 1, 1e-9), low / begin[-1]],
            np.r_[np.full(begin.size - 1, 1e9), high / begin[-1]],
        ),
        task="OLS" if exact else "explicit-ODR",
        diff_scheme="central",
        maxit=100,
    )
    covariance = np.asarray(found.cov_beta) * np.outer(begin, begin)
    return _Raw(curve, np.asarray(found.beta) * begin, covariance, float(found.sum_square))


def _guess(odrpack: Any, data: SpinDown, curve: Curve) -> Floats:
    """Coefficients and first inclination: the times are linear in those of the drift of unit coefficient."""
    if len(curve.laws) > 1:
        alone = [
            _fitted(odrpack, data, Curve(curve.body, [law], curve.centre, data.ends, data.down), None)
            for law in curve.laws
        ]
        theta = float(np.mean([one.beta[-1] for one in alone]))
        mixed = [
            np.array([(1 - share) * alone[0].beta[0], share * alone[1].beta[0], theta])
            for share in (0.1, 0.3, 0.5, 0.7, 0.9)
        ]
        return min(mixed, key=lambda beta: _squares(data, curve, beta))
    near = np.isfinite(data.near)
    inclinations, t = data.near[near], data.t[near]
    clock, less, more = curve.times([1.0], inclinations * np.array([[1.0], [0.999], [1.001]]))
    steep = np.abs(more - less) / 0.002
    seen = np.isfinite(clock) & (steep > 0)
    if seen.sum() < 2:
        raise ValueError(f"theta: a drift of {curve.laws[0].__name__} does not pass these inclinations")
    slope, begun = np.polyfit(clock[seen], t[seen], 1, w=1 / steep[seen])
    coefficient = 1 / slope if slope > 0 else np.ptp(clock[seen]) / np.ptp(t[seen])
    first = float(inclinations[0])
    if slope > 0 and curve.centre == "rest":
        shown = curve(["theta"], np.array([data.t[0] - begun]), [coefficient], curve.top)
        first = float(shown[0, 0])
    return np.array([coefficient, first])


def _squares(data: SpinDown, curve: Curve, beta: Floats) -> float:
    off = curve(data.names, data.t - data.t[0], beta[:-1], beta[-1]) - data.values
    return float(np.nansum((off / data.errors) ** 2))


def _refuse_degenerate(data: SpinDown, found: _Raw) -> None:
    """Refuses, by their names, two laws that the points cannot tell apart."""
    if len(found.beta) < 3:
        return
    names = [law.__name__ for law in found.curve.laws]
    errors = np.sqrt(np.diag(_covariance(data, found)))[:2]
    why = ""
    for name, k, error, other in zip(names, found.beta, errors, names[::-1], strict=False):
        if not 0 < error <= k:
            share = "no share" if error == 0 else f"the coefficient {k:.2g} +- {error:.2g}"
            why = f"beside {other}, {name} has {share}"
    if not why:
        correlation = found.covariance[0, 1] / math.sqrt(found.covariance[0, 0] * found.covariance[1, 1])
        if not abs(correlation) <= _CORRELATED:
            why = f"their coefficients are correlated by {correlation:.5f}"
    if why:
        told = f"these points cannot tell {names[0]} from {names[1]}"
        raise ValueError(f"laws: {told}: {why}; fit them one by one")


def _covariance(data: SpinDown, found: _Raw) -> Floats:
    """The covariance of coefficients and inclination; where errors are from the scatter, about this law."""
    return found.covariance * (found.chi2 / max(data.numbers - len(found.beta), 1) if data.estimated else 1.0)


def _aic(data: SpinDown, found: _Raw) -> float:
    squares = found.chi2
    if len(data.estimated) == len(data.names) and not data.t_err.any():
        squares = data.numbers * math.log(found.chi2 / data.numbers + 1e-300)
    return squares + 2 * len(found.beta)


def _told(data: SpinDown, found: _Raw, aic: float, daic: float) -> FittedLoss:
    """What a fit says, with the stopping time and its error."""
    curve, beta = found.curve, found.beta
    chi2 = found.chi2 / max(data.numbers - len(beta), 1)
    covariance = _covariance(data, found)
    errors = np.sqrt(np.diag(covariance))
    left = curve.stops_at(beta[:-1], beta[-1])
    # an inclination at the end of its branch has no error
    with np.errstate(divide="ignore", invalid="ignore"):
        stop_err, correlation = math.nan, covariance[0, 1] / (errors[0] * errors[1])
    if math.isfinite(left) and (errors > 0).all():
        gradient = np.array([_slope(curve, beta, k, errors[k]) for k in range(len(beta))])
        stop_err = math.sqrt(max(float(gradient @ covariance @ gradient), 0.0))
        if len(beta) == 2:
            both = errors[0] * stop_err
            correlation = float(covariance[0] @ gradient) / both if both > 0 else math.nan
    shown = curve(data.names, data.t - data.t[0], beta[:-1], beta[-1])
    return FittedLoss(
        name=called(curve.laws),
        law=curve.law(beta[:-1]),
        coefficients=beta[:-1],
        coefficient_errs=errors[:-1],
        theta=float(beta[-1]),
        theta_err=float(errors[-1]),
        stops_at=float(data.t[0]) + left,
        stops_at_err=stop_err,
        correlation=float(correlation),
        residual=dict(zip(data.names, data.values - shown, strict=True)),
        chi2=chi2,
        aic=aic,
        daic=daic,
        drift=curve.quietly(beta[:-1], float(beta[-1])),
    )


def _slope(curve: Curve, beta: Floats, k: int, error: float) -> float:
    """How the stopping time changes with a parameter."""
    low, high = curve.ends if k == len(beta) - 1 else (0.5 * beta[k], 2 * beta[k])
    step = max(min(0.1 * error, 0.01 * beta[k]), 1e-7 * beta[k])  # exact data have no errors
    places = np.clip([beta[k] - step, beta[k] + step], low, high)
    times = []
    for place in places:
        there = beta.copy()
        there[k] = place
        times.append(curve.stops_at(there[:-1], there[-1]))
    return float((times[1] - times[0]) / (places[1] - places[0]))
