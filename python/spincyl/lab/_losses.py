"""Fits of drifts to a measured spin-down, and comparison of loss laws by AIC."""

import math
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Literal, NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._input.numbers import Floats, Reals, optional_library, reals, turns_per_second
from spincyl._input.progress import Progress, reporting_progress
from spincyl._single import one_body
from spincyl.lab._curve import Curve
from spincyl.lab._line import line
from spincyl.lab._lossfit import APART, FittedLoss, LossFit, Refused, called, in_si
from spincyl.lab._spindown import Several, SpinDown, asked, centres, measured
from spincyl.lab._typical import far_from_typical

_FIRST_REST_SHARE = 0.02  #: First guess of the share in `Curve` that gives where the centre was at rest.
_CORRELATED = 0.999  #: Two coefficients with a higher correlation cannot be told apart.


def fit_losses(
    t: Reals,
    theta: Reals | None = None,
    precession: Reals | None = None,
    *,
    body: Body,
    hertz: Reals | None = None,
    laws: Sequence[Any] | None = None,
    centre: Literal["rest", "rolling"] | None = None,
    t_err: Reals | None = None,
    theta_err: Reals | None = None,
    precession_err: Reals | None = None,
    hertz_err: Reals | None = None,
    start: float | None = None,
    progress: Progress | bool | None = None,
) -> LossFit:
    """Fit loss laws to a measured spin-down, and rank the laws.

    A spin-down is the inclination or the precession of a spinning body at several times while it slows down.

    Parameters
    ----------
    t : array_like, 1-D
        Times in ascending order, in sqrt(R/g); for a measured body in seconds. A time may be repeated.
    theta : array_like, optional
        Inclinations at these times, in radians. Use NaN for missing values.
    precession : array_like, optional
        Precession phi' at these times, in sqrt(g/R); for a measured body in rad/s. Give `theta`, or
        `precession` (or `hertz`), or both. Use NaN for missing values.
    body : Body
        Single body. For a measured body all times are in seconds and precessions in rad/s, in the arguments
        and in the result. Coefficients are in natural units; `coefficients_si` gives them in SI.
    hertz : array_like, optional
        Precession in turns per second, instead of `precession`, for a measured body.
    laws : sequence, optional
        Laws to fit: classes of `spincyl.loss`. A tuple or list of two classes means the sum of two laws.
        Default: all eight classes.
    centre : {"rest", "rolling"}, optional
        Kind of drift (see `spincyl.drift`): with the centre held at rest, or rolling, after the centre was at
        rest at the first time or before. Default: both, so that each law is fitted twice.
    t_err : array_like, optional
        Standard errors of the times. Default: times are exact.
    theta_err, precession_err or hertz_err : array_like, optional
        Standard errors of the values. Default: the same relative error for all values, estimated from the
        scatter about the best law.
    start : float, optional
        Approximate inclination at the first time, in radians. Needed if only the precession is given, and
        steady states at several inclinations have this precession.
    progress : callable or bool, optional
        Function that is called after each fit with the finished share, 0 to 1. Default: if tqdm is installed,
        a bar on a terminal or in a notebook when the work takes more than two seconds. True: a bar at once;
        False: none.

    Returns
    -------
    LossFit
        The fitted laws in the order of Akaike's information criterion (AIC), the best first; ``.report()``
        and ``.table()`` summarise them.

    Raises
    ------
    ValueError
        If there are fewer than five points, or shapes differ. If values are not positive, do not change with
        time, change as if the body gained energy, or are in the forbidden band. If no law can be fitted; for
        instance if the points cannot distinguish the two laws of a sum.
    TypeError
        If an argument is not a body, a law or real numbers; the message names it.
    ImportError
        If odrpack is missing: install spincyl[lab].

    Warns
    -----
    UserWarning
        If chi2 exceeds 10 for every law; the message names the points that contribute most. If the precession
        differs by a quarter or more from the precession of steady states at the same inclinations, for
        example because of wrong units. If the coefficient of every likely law is more than 10 times outside
        its range in `spincyl.loss.typical`, for example because milliseconds were given for seconds. Warnings
        of the fitted drift are passed on.

    Notes
    -----
    The drift itself is fitted, by orthogonal distance regression (Boggs and Donaldson 1989, odrpack). A line
    in a log-log diagram is not used for this, since the bias of its exponent is larger than its error. If the
    data cannot distinguish some laws, the table says so. A law that is impossible for the body, such as a
    film of air below a ball, is listed with the reason (`LossFit.refused`). If only the precession is given,
    a coefficient depends on `centre`. If points scatter by more than their given errors, errors and
    differences of AIC are scaled accordingly (QAIC; Burnham and Anderson 2002).

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
    odrpack = optional_library("odrpack", "lab")
    if hertz is not None or hertz_err is not None:
        if precession is not None or precession_err is not None:
            raise TypeError("precession, hertz: give only one of them, and the error of the same name")
        if one_body(body).scale is None:
            raise ValueError("hertz: needs a measured body; for any other body give precession=")
        precession, precession_err = (
            None if x is None else 2 * np.pi * reals(name, turns_per_second(name, x))
            for name, x in (("hertz", hertz), ("hertz_err", hertz_err))
        )
    spindown = partial(
        measured,
        body,
        t,
        theta,
        precession,
        t_err=t_err,
        theta_err=theta_err,
        precession_err=precession_err,
        start=start,
    )
    with reporting_progress(progress, "fit") as told:
        found, refused = _fit_every_law(odrpack, body, spindown, centres(centre), asked(laws), told)
    whole = []
    for raw in found:
        try:
            _refuse_degenerate(raw)
            whole.append(raw)
        except ValueError as e:
            refused.append((called(raw.curve.laws), raw.curve.centre, e))
    if not whole:
        raise refused[0][2]
    whole.sort(key=_aic)
    best, data = whole[0], whole[0].data
    spread = best.spread
    fits = [_fitted_loss(f, _aic(f), (_aic(f) - _aic(best)) / spread) for f in whole]
    # only the best drift may issue warnings
    fits[0] = fits[0]._replace(drift=best.curve.drift(best.beta[:-1], float(best.beta[-1])))
    said = _doubts_of_laws(body, best, fits)
    for doubt in said:
        warnings.warn(doubt, UserWarning, stacklevel=2)
    first = data.values[0]
    seen = np.isfinite(first)
    known = dict(zip(data.names, zip(data.values, data.errors, strict=True), strict=True))
    (theta_, theta_err_), (precession_, precession_err_) = (
        known.get(n, (None, None)) for n in ("theta", "precession")
    )
    fit = LossFit(
        body=body.natural,
        centre=centre or "either",
        t=data.t,
        theta=theta_,
        precession=precession_,
        t_err=data.t_err,
        theta_err=theta_err_,
        precession_err=precession_err_,
        estimated=data.estimated,
        fits=tuple(fits),
        line=line(data.t[seen], first[seen]) if data.down else None,
        refused=tuple(Refused(name, one, str(why)) for name, one, why in refused),
    )
    return fit if body.scale is None else in_si(fit, body, body.scale.seconds(1.0))


class _RawFit(NamedTuple):
    """Result of a fit by odrpack: parameters, and their covariance if the given errors are true."""

    data: SpinDown
    curve: Curve
    beta: Floats
    covariance: Floats
    chi2: float  # sum of squares, not per degree of freedom

    @property
    def freedom(self) -> int:
        return max(self.data.numbers - len(self.beta), 1)

    @property
    def spread(self) -> float:
        """Factor by which the variance of the points exceeds that of their given errors; at least 1."""
        return 1.0 if self.data.estimated else max(self.chi2 / self.freedom, 1.0)


def _fit_every_law(
    odrpack: Any,
    body: Body,
    spindown: Callable[..., SpinDown],
    kept: Any,
    sums: Any,
    told: Progress | None,
) -> tuple[list[_RawFit], list[tuple[str, Any, Exception]]]:
    """The fits of all laws that can be fitted, and the other laws with the reasons."""
    found: list[_RawFit] = []
    refused: list[tuple[str, Any, Exception]] = []
    count, rounds = len(kept) * len(sums), 2  # the second with errors that the first has estimated
    for one in kept:
        try:
            data = spindown(centre=one, laws=max(map(len, sums)))
        except Several:
            raise
        except ValueError as e:
            refused += [(called(law), one, e) for law in sums]
            continue
        rounds = 2 if data.estimated else 1
        for law in sums:
            curve = Curve(body.natural, law, one, data.ends, data.down)
            try:
                found.append(_fitted_curve(odrpack, data, curve, None))
            except ValueError as e:
                refused.append((called(law), one, e))
            if told:
                told((len(found) + len(refused)) / (count * rounds))
    if found and found[0].data.estimated:
        # fit all laws with the same errors, so that their AIC can be compared
        best = min(found, key=lambda f: f.chi2 + 2 * len(f.beta))
        shown = best.curve(best.data.names, best.data.clock, best.beta[:-1], best.beta[-1])
        errors = best.data.weighed(shown, len(best.beta)).errors
        for k, f in enumerate(found, 1):
            found[k - 1] = _fitted_curve(odrpack, f.data._replace(errors=errors), f.curve, f.beta)
            if told:
                told((1 + k / len(found)) / 2)
    return found, refused


def _doubts_of_laws(body: Body, best: _RawFit, fits: list[FittedLoss]) -> list[str]:
    """Warnings about the best fit: inconsistent units, or points that no law explains."""
    said, data, fit = [], best.data, fits[0]
    units = "natural units" if body.scale is None else "seconds and rad/s"
    factor = data.off_by(body)
    if not 0.8 < factor < 1.25:
        told = f"the precession is {factor:.3g} times that of steady states at these inclinations"
        said.append(f"{told}; are times and precession in {units}, and is the size of the body right?")
    if fit.chi2 > 10:
        off = np.stack([fit.residual[name] for name in data.names]) / data.errors
        share = np.nansum(off**2, axis=0)
        share /= share.sum()
        second, unit = (1.0, "") if body.scale is None else (body.scale.seconds(1.0), " s")
        heavy = [k for k in np.argsort(-share, kind="stable")[:3] if share[k] > 0.1]
        weigh = ", ".join(f"t = {data.t[k] * second:.4g}{unit} ({100 * share[k]:.0f} %)" for k in heavy)
        weigh = f"most of chi2 is due to {weigh}" if weigh else "it is not due to a few points"
        asks = f"do all points belong to the spin-down, and are times and precession in {units}?"
        told = f"chi2 = {fit.chi2:.3g}: no law explains these points within their errors"
        said.append(f"{told}; {weigh}: {asks}")
    # None for laws without typical coefficients, "" for a law with a usual one, which may be the right law
    far = [far_from_typical(one.law, body.scale) for one in fits if one.daic <= APART]
    known = [why for why in far if why is not None]
    return said + (known[:1] if all(known) else [])


def _fitted_curve(odrpack: Any, data: SpinDown, curve: Curve, begin: Floats | None) -> _RawFit:
    """Fit one law, or a sum, starting at the parameters `begin`, or at a guess if they are None."""
    at: Floats = _first_guess(odrpack, data, curve) if begin is None else begin.copy()
    many = len(curve.laws)
    if curve.centre == "rolling" and at.size == many + 1:
        at = np.insert(at, -1, _FIRST_REST_SHARE)
    at[-1] = np.clip(at[-1], *curve.ends)
    if at.size > many + 1:
        at[-2] = np.clip(at[-2], _FIRST_REST_SHARE, 0.9)
    exact = not data.t_err.any()
    weights = np.where(np.isfinite(data.values), data.errors**-2.0, 0.0)

    def fit(at: Floats, fixed: np.ndarray | None) -> Any:
        least, most = np.full(at.size, 1e-9), np.full(at.size, 1e9)
        least[-1], most[-1] = np.array(curve.ends) / at[-1]
        if at.size > many + 1:
            least[-2], most[-2] = 0.0, max(0.95 / at[-2], 1.0)
        return odrpack.odr_fit(
            lambda x, beta: curve(data.names, x, beta[:-1] * at[:-1], beta[-1] * at[-1]).squeeze(),
            data.clock,
            np.where(np.isfinite(data.values), data.values, 1.0).squeeze(),
            np.ones_like(at),
            weight_x=None if exact else data.t_err**-2.0,
            weight_y=weights.squeeze(),
            bounds=(np.minimum(least, 1.0), np.maximum(most, 1.0)),
            fix_beta=fixed,
            task="OLS" if exact else "explicit-ODR",
            diff_scheme="central",
            maxit=100,
        )

    found = fit(at, None)
    if at.size > many + 1 and not (np.diag(np.asarray(found.cov_beta)) > 0).all():
        # the inclination of rest is at a bound: fix it there, so that the other parameters have errors
        at = np.asarray(at * np.asarray(found.beta), np.float64)
        at[-2] = max(at[-2], 1e-12)
        found = fit(at, np.arange(at.size) == at.size - 2)
    covariance = np.asarray(found.cov_beta) * np.outer(at, at)
    return _RawFit(data, curve, np.asarray(found.beta) * at, covariance, float(found.sum_square))


def _first_guess(odrpack: Any, data: SpinDown, curve: Curve) -> Floats:
    """Guess coefficients and first inclination, by comparing the times with those of a tabulated drift."""
    if len(curve.laws) > 1:
        alone = [
            _fitted_curve(odrpack, data, Curve(curve.body, [law], curve.centre, data.ends, data.down), None)
            for law in curve.laws
        ]
        theta = float(np.mean([one.beta[-1] for one in alone]))
        mixed = [
            np.r_[(1 - share) * alone[0].beta[0], share * alone[1].beta[0], alone[0].beta[1:-1], theta]
            for share in (0.1, 0.3, 0.5, 0.7, 0.9)
        ]
        return min(mixed, key=lambda beta: _sum_of_squares(data, curve, beta))
    near = np.isfinite(data.near)
    inclinations, t = data.near[near], data.clock[near]  # a guess must not depend on the origin of time
    clock, less, more = curve.times([1.0], inclinations * np.array([[1.0], [0.999], [1.001]]))
    steep = np.abs(more - less) / 0.002
    seen = np.isfinite(clock) & (steep > 0)
    if not seen.any() or not np.ptp(clock[seen]) * np.ptp(t[seen]) > 0:
        raise ValueError(
            f"theta: a drift under {curve.laws[0].__name__} does not pass through these inclinations"
        )
    slope, begun = np.polyfit(clock[seen], t[seen], 1, w=1 / steep[seen])
    coefficient = 1 / slope if slope > 0 else np.ptp(clock[seen]) / np.ptp(t[seen])
    first = float(inclinations[0])
    if slope > 0 and curve.centre == "rest":
        shown = curve(["theta"], np.array([-begun]), [coefficient], curve.top)
        first = float(shown[0, 0])
    return np.array([coefficient, first])


def _sum_of_squares(data: SpinDown, curve: Curve, beta: Floats) -> float:
    off = curve(data.names, data.clock, beta[:-1], beta[-1]) - data.values
    return float(np.nansum((off / data.errors) ** 2))


def _refuse_degenerate(found: _RawFit) -> None:
    """Refuse a law that no coefficient fits, or two laws that the points cannot tell apart."""
    errors = np.sqrt(np.diag(_covariance(found)))[: len(found.curve.laws)]
    if len(errors) < 2:
        if not (np.isfinite(found.beta).all() and 0 < errors[0] < 100 * found.beta[0]):
            raise ValueError(f"laws: no coefficient of {called(found.curve.laws)} explains these points")
        return
    names = [law.__name__ for law in found.curve.laws]
    why = ""
    for name, k, error, other in zip(names, found.beta, errors, names[::-1], strict=False):
        if not 0 < error <= k:
            share = "a coefficient of 0" if error == 0 else f"the coefficient {k:.2g} +- {error:.2g}"
            why = f"together with {other}, {name} has {share}"
    if not why:
        correlation = found.covariance[0, 1] / math.sqrt(found.covariance[0, 0] * found.covariance[1, 1])
        if not abs(correlation) <= _CORRELATED:
            why = f"the correlation of their coefficients is {correlation:.5f}"
    if why:
        told = f"these points cannot distinguish {names[0]} from {names[1]}"
        raise ValueError(f"laws: {told}, since {why}; fit them one by one")


def _covariance(found: _RawFit) -> Floats:
    """The covariance of the parameters; estimated errors follow from the scatter about this law.

    If points scatter by more than their given errors, the covariance is enlarged accordingly.
    """
    return found.covariance * (found.chi2 / found.freedom if found.data.estimated else found.spread)


def _aic(found: _RawFit) -> float:
    data, squares = found.data, found.chi2
    if len(data.estimated) == len(data.names) and not data.t_err.any():
        squares = data.numbers * math.log(found.chi2 / data.numbers + 1e-300)
    return squares + 2 * len(found.beta)


def _fitted_loss(found: _RawFit, aic: float, daic: float) -> FittedLoss:
    """The result of a fit, with the stopping time and its error."""
    data, curve, beta = found.data, found.curve, found.beta
    chi2 = found.chi2 / found.freedom
    covariance = _covariance(found)
    errors, many = np.sqrt(np.diag(covariance)), len(curve.laws)
    left = curve.stops_at(beta[:-1], beta[-1])
    # an inclination at the end of its branch has zero variance
    with np.errstate(divide="ignore", invalid="ignore"):
        other = 1 if many > 1 else -1
        stop_err, correlation = math.nan, covariance[0, other] / (errors[0] * errors[other])
    if math.isfinite(left) and errors[-1] > 0:
        gradient = np.array([_slope_of_stop(curve, beta, k, errors[k]) for k in range(len(beta))])
        stop_err = math.sqrt(max(float(gradient @ covariance @ gradient), 0.0))
        if many == 1:
            both = errors[0] * stop_err
            correlation = float(covariance[0] @ gradient) / both if both > 0 else math.nan
    shown = curve(data.names, data.clock, beta[:-1], beta[-1])
    return FittedLoss(
        name=called(curve.laws),
        centre=curve.centre,
        law=curve.law(beta[:-1]),
        coefficients=beta[:many],
        coefficient_errs=errors[:many],
        theta=float(beta[-1]),
        theta_err=float(errors[-1]),
        rested=curve.rested(beta[:-1], float(beta[-1])) if curve.centre == "rolling" else math.nan,
        stops_at=float(data.t[0]) + left,
        stops_at_err=stop_err,
        correlation=float(correlation),
        residual=dict(zip(data.names, data.values - shown, strict=True)),
        chi2=chi2,
        aic=aic,
        daic=daic,
        drift=curve.quietly(beta[:-1], float(beta[-1])),
    )


def _slope_of_stop(curve: Curve, beta: Floats, k: int, error: float) -> float:
    """Derivative of the stopping time with respect to parameter number `k`, whose error is `error`."""
    size = beta[k]
    low, high = curve.ends if k == len(beta) - 1 else (0.5 * size, 2 * size)
    if len(curve.laws) <= k < len(beta) - 1:
        low, high, size = 0.0, 0.95, _FIRST_REST_SHARE
    step = max(min(0.1 * error, 0.01 * size), 1e-7 * size)  # exact data have zero errors
    places = np.clip([beta[k] - step, beta[k] + step], low, high)
    times = []
    for place in places:
        there = beta.copy()
        there[k] = place
        times.append(curve.stops_at(there[:-1], there[-1]))
    return float((times[1] - times[0]) / (places[1] - places[0]))
