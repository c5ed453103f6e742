"""Fit of a motion to a measured one: friction, restitution, losses and initial state, all at once."""

import math
import warnings
from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any, Literal, NamedTuple

import numpy as np

from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import Floats, instance_of, number, one_of, optional_library, si
from spincyl._motion import Motion
from spincyl.lab._report import section, variables, with_error, written
from spincyl.lab._seen import Measured, measured_motion, off_by, outputs_at
from spincyl.lab._vary import Number, in_units_of, numbers_of_motion, with_numbers

#: Shares of the duration that are fitted one after another: late points depend most on the numbers, and
#: mislead a fit from afar. The errors are estimated before each round of the whole.
_SHARES = (0.25, 0.5, 0.75, 1.0, 1.0, 1.0)
_STEP = 1e-4  #: Of the derivatives, in typical sizes of the numbers.
_CORRELATED = 0.995  #: Two numbers with a higher correlation cannot be told apart.
_NONE = 1e-7  #: Share of the largest effect on the points below which a number has none.
_AT_BOUND = 1e-6
_MISFIT, _TAILED = 10.0, 3.0  #: Of chi2, with given errors, and with those of the scatter.
_LOSSES = ("linear", "soft_l1", "huber", "cauchy")


@compared_by_value
class MotionFit(NamedTuple):
    """Result of `fit_motion`: the numbers of a motion that fit a measured motion best.

    Methods: ``correlation(a, b)`` and ``report()``.

    Attributes
    ----------
    motion : Motion
        The fitted motion at the measured times, up to its end.
    names : tuple of str
        Names of the fitted numbers.
    values : dict of float
        Fitted numbers by name, in natural units, for a measured body in SI; coefficients of losses as they
        are printed, in the unit that `from_si` reads.
    errors : dict of float
        Standard errors of the numbers; infinite if the points do not determine a number.
    covariance : ndarray, (k, k)
        Covariance of the numbers in the order of `names`.
    residual : dict of ndarray
        Measured minus fitted outputs by name, in the order of the measured rows.
    chi2 : float
        Sum of the squared residuals in units of their errors, per degree of freedom.
    estimated : tuple of str
        Names of the outputs whose errors were estimated from their scatter.
    undetermined : tuple of str
        Numbers that the points do not determine, with the reason.
    units : dict of str
        Unit of each number; "" for a pure number.
    """

    motion: Motion
    names: tuple[str, ...]
    values: dict[str, float]
    errors: dict[str, float]
    covariance: Floats
    residual: dict[str, Floats]
    chi2: float
    estimated: tuple[str, ...]
    undetermined: tuple[str, ...]
    units: dict[str, str]

    def correlation(self, one: str, other: str) -> float:
        """Correlation of two fitted numbers, given by their names."""
        i, k = (self.names.index(one_of("name", name, self.names)) for name in (one, other))
        both = math.sqrt(self.covariance[i, i] * self.covariance[k, k])
        return float(self.covariance[i, k] / both) if 0 < both < math.inf else math.nan

    def report(self) -> str:
        """Return a report in lmfit's style: the fit, the numbers with errors, and their correlations."""
        count = {name: int(np.isfinite(x).sum()) for name, x in self.residual.items()}
        rows = [
            ("body", repr(self.motion.body)),
            ("# data points", ", ".join(f"{n} of {name}" for name, n in count.items())),
            ("# variables", str(len(self.names))),
            ("reduced chi-square", written(self.chi2)),
        ]
        if self.estimated:
            rows.append(("errors", f"of {', '.join(self.estimated)} from the scatter"))
        told = [(name, self.values[name], self.errors[name], self._note(name)) for name in self.names]
        lines = section("Motion", rows) + variables(told)
        pairs = [
            (a, b, c)
            for i, a in enumerate(self.names)
            for b in self.names[i + 1 :]
            if abs(c := self.correlation(a, b)) > 0.1
        ]
        if pairs:
            lines += section("Correlations", [(f"C({a}, {b})", f"{c:+.3f}") for a, b, c in pairs])
        return "\n".join(
            lines
            + (
                section("Not determined", [("", one) for one in self.undetermined], "")
                if self.undetermined
                else []
            )
        )

    def _note(self, name: str) -> str:
        unit = self.units[name] and f"in {self.units[name]}"
        return unit if math.isfinite(self.errors[name]) else f"{unit} not determined".strip()

    def __repr__(self) -> str:
        told = ", ".join(
            f"{name} {with_error(self.values[name], self.errors[name])} {self.units[name]}".rstrip()
            for name in self.names
        )
        more = f"; {len(self.undetermined)} not determined" if self.undetermined else ""
        return f"<MotionFit: {told}; chi2 {self.chi2:.3g}{more}>"


def fit_motion(
    guess: Motion,
    measured: Mapping[str, Any],
    *,
    free: Iterable[str] | Mapping[str, tuple[float, float] | None],
    errors: Mapping[str, Any] | None = None,
    loss: Literal["linear", "soft_l1", "huber", "cauchy"] = "linear",
) -> MotionFit:
    """Fit friction, restitution, losses and the start of a motion to a measured motion, all at once.

    Parameters
    ----------
    guess : Motion
        A motion of a body of revolution that is roughly the measured one, as `roll` returns it. The fit
        starts with its numbers, and keeps those that are not free.
    measured : table or dict
        Column "t" with the times, and columns of any of these outputs: theta, phi, psi, w, precession, spin,
        hertz (turns per second of the precession), height, contact_point, centre, x, y, z (of the centre).
        Natural units; for a measured body SI, or the units in a table that `read_table` returns, such as "x
        (cm)". NaN if missing. Rows may be in any order.
    free : sequence of str, or dict
        Names of the numbers to fit; in a dict with bounds (low, high), or None: theta, w1, w2, w3, slip_h,
        slip_2, height and lift of the start; "mu" of `Coulomb`, "c" of `Viscous`, "restitution"; the
        coefficient of a loss by the name of its law, such as "DryContour"; x, y and phi0, by which the path
        is moved and turned; and t0, the time of the start.
    errors : dict, optional
        Standard errors of the outputs by name: a number, or one for each row. Default: estimated from the
        scatter about the fit.
    loss : {"linear", "soft_l1", "huber", "cauchy"}
        How residuals count: squared, or less if they are large, as in SciPy's `least_squares`. "soft_l1" is
        for tracks with some wrong marks.

    Returns
    -------
    MotionFit
        ``.report()`` summarises the fit; ``.motion`` is the fitted motion.

    Raises
    ------
    ValueError
        If a column is not an output, a name cannot be varied, or a bound excludes the guess. If there are
        fewer points than free numbers.
    TypeError
        If an argument has a wrong type; the message names it.
    ImportError
        If SciPy is missing: install spincyl[lab].

    Warns
    -----
    UserWarning
        If the points do not determine a number: they do not depend on it, two numbers have almost the same
        effect, its error is larger than itself, or it is at its bound. If chi2 exceeds 10. If the fitted
        motion ends before the last point: after that its last values are compared.

    Notes
    -----
    The engine is `scipy.optimize.least_squares`, a trust-region method with bounds (Branch, Coleman and Li
    1999), with derivatives by differences. Errors follow from the derivatives at the solution, as in lmfit.
    If points scatter by more than their given errors, the errors are enlarged accordingly. Before `t0` the
    body is taken to be held at its start. Impacts make a motion sensitive: begin with a guess whose impacts
    are about those measured.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> hoop = sc.Body.tube(0.0, bore=1.0)
    >>> thrown = sc.State(np.pi / 2, 0.0, 0.0, -3.0, slip=(0.0, 5.0))
    >>> true = sc.roll(hoop, thrown, np.linspace(0, 20, 41), contact=sc.Coulomb(0.25), want="pose")
    >>> guess = sc.roll(hoop, thrown, 20.0, contact=sc.Coulomb(0.2))
    >>> track = {"t": true.t, "y": true.centre[:, 1], "spin": true.states.spin}
    >>> found = sc.data.fit_motion(guess, track, free=["mu", "slip_2"], errors={"y": 0.01, "spin": 0.01})
    >>> round(found.values["mu"], 6), round(found.values["slip_2"], 6)
    (0.25, 5.0)
    """
    instance_of("guess", guess, Motion)
    if getattr(guess.body, "rims", None) is not None or type(guess) is not Motion:
        raise TypeError(
            "guess: expected the motion of a body of revolution with a circular rim, as roll returns it"
        )
    least_squares = optional_library("scipy.optimize", "lab").least_squares
    one_of("loss", loss, _LOSSES)
    numbers = _free(numbers_of_motion(guess), free)
    data = measured_motion(guess, measured, errors)
    many = sum(int(np.isfinite(x).sum()) for x in data.values.values())
    if many <= len(numbers):
        raise ValueError(f"measured: {many} values cannot determine {len(numbers)} numbers; shorten free=")
    fit = _Fit(guess, data, numbers)
    fit.residuals(fit.begin)  # an output that the guess does not have raises its error
    low, high = fit.bounds()
    at = fit.begin
    for k, share in enumerate(_SHARES):
        whole = share == 1 and _SHARES[k - 1] == 1
        how = loss if whole else "soft_l1"
        found = least_squares(
            partial(fit.trial, share=share),
            at,
            bounds=(low, high),
            jac="3-point",
            diff_step=_STEP,
            loss=how,
            max_nfev=100,
        )
        at = np.clip(found.x, low, high)
        if share == 1 and k + 1 < len(_SHARES):
            fit.estimate_errors(at)
    result = fit.result(at, found.jac, loss)
    for doubt in (*result.undetermined, *fit.warnings(at, result)):
        warnings.warn(doubt, UserWarning, stacklevel=2)
    return result


def _free(known: dict[str, Number], free: Any) -> dict[str, Number]:
    """The numbers to fit, with the bounds given in `free`; errors name the argument `free`."""
    pairs = free.items() if isinstance(free, Mapping) else None
    listed = isinstance(free, Mapping | list | tuple | set | frozenset)
    names = [*free] if listed else []
    if not listed or not all(isinstance(name, str) for name in names):
        raise TypeError(f"free: expected a list of names such as ['mu', 'w3'], not {free!r}")
    bounds = dict.fromkeys(names) if pairs is None else dict(pairs)
    if not bounds:
        raise ValueError("free: expected at least one name")
    found = {}
    for name, pair in bounds.items():
        if name not in known:
            raise ValueError(
                f"free: {name!r} cannot be varied in this motion; expected some of {', '.join(known)}"
            )
        one = known[name]
        if pair is not None:
            if not isinstance(pair, tuple | list) or len(pair) != 2:
                raise TypeError(f"free[{name!r}]: expected None or a pair (low, high), not {pair!r}")
            low, high = (number(f"free[{name!r}]", si(f"free[{name!r}]", x, "radian")) for x in pair)
            low, high = max(low / one.factor, one.low), min(high / one.factor, one.high)
            if not low < high or not low <= one.value <= high:
                value = one.value * one.factor
                raise ValueError(
                    f"free[{name!r}] = {pair!r}: expected bounds on both sides of the guess, {value:.6g}"
                )
            one = one._replace(low=low, high=high)
        size = max(abs(one.value), one.size)
        found[name] = one._replace(size=min(size, one.high - one.low))
    return found


class _Fit:
    """The residuals as a function of the free numbers, which are scaled so that all are 1 at the guess."""

    def __init__(self, guess: Motion, data: Measured, numbers: dict[str, Number]) -> None:
        self.guess, self.numbers = guess, numbers
        self.data = data._replace(errors={name: x.copy() for name, x in data.errors.items()})
        self.begin = np.ones(len(numbers))
        self.most = 1e3 * sum(x.size for x in data.values.values()) ** 0.5
        wanted = guess.natural._asked.want | data.wants
        self.source = guess if wanted == guess.natural._asked.want else guess.wanting(*wanted)

    def bounds(self) -> tuple[Floats, Floats]:
        ends = [[1 + (end - x.value) / x.size for end in (x.low, x.high)] for x in self.numbers.values()]
        low, high = np.array(ends).T
        # a guess at its bound begins a little inside
        inside = np.minimum(1e-3, 0.1 * (high - low))
        self.begin = np.clip(self.begin, low + inside, high - inside)
        return low, high

    def natural(self, at: Floats) -> dict[str, float]:
        pairs = zip(self.numbers.items(), at.tolist(), strict=True)
        return {
            name: min(max(x.value + (v - 1) * x.size, x.low), x.high) if v != 1 else x.value
            for (name, x), v in pairs
        }

    def computed(self, at: Floats) -> tuple[Motion, dict[str, Floats]]:
        """The motion at the measured times, and its outputs."""
        values = self.natural(at)
        begin = values.get("t0", self.guess.natural._asked.t0)
        times, rows = np.unique(np.r_[begin, np.maximum(self.data.times, begin)], return_inverse=True)
        placed = with_numbers(self.source, values, times)
        return placed.motion, outputs_at(placed, self.data, rows[1:])

    def residuals(self, at: Floats, share: float = 1.0) -> Floats:
        """Residuals divided by their standard errors, in the first `share` of the duration."""
        off = off_by(self.data, self.computed(at)[1])
        return np.concatenate([(off[n] / self.data.errors[n])[self.seen(n, share)] for n in off])

    def seen(self, name: str, share: float) -> Any:
        """Whether each value of an output was measured and belongs to the first `share` of the duration."""
        t = self.data.t
        early = t <= t[0] + share * (t[-1] - t[0])
        return np.isfinite(self.data.values[name]) & early[:, np.newaxis]

    def trial(self, at: Floats, share: float) -> Floats:
        """The residuals for a trial of the fit; large numbers where the motion cannot be computed."""
        try:
            found = self.residuals(at, share)
        except ValueError:
            found = np.full(sum(int(self.seen(n, share).sum()) for n in self.data.values), np.nan)
        return np.nan_to_num(np.clip(found, -self.most, self.most), nan=self.most)

    def estimate_errors(self, at: Floats) -> None:
        """Set the errors of outputs from their scatter about a fit, without points beyond four deviations."""
        off = off_by(self.data, self.computed(at)[1])
        parts = len(off)
        for name in self.data.estimated:
            rest = np.abs(off[name][np.isfinite(off[name])])
            free = max(rest.size - len(self.numbers) / parts, 1.0)
            near = rest[rest <= 4 * 1.4826 * np.median(rest)] if rest.size > 10 else rest
            scatter = math.sqrt(float(near @ near) / max(near.size - rest.size + free, 1.0))
            least = 1e-9 * float(np.nanmax(np.abs(self.data.values[name]), initial=1e-3))
            self.data.errors[name][:] = max(scatter, least)

    def result(self, at: Floats, jacobian: Floats, loss: str) -> MotionFit:
        motion, shown = self.computed(at)
        off = off_by(self.data, shown)
        rest = np.concatenate([(off[n] / self.data.errors[n])[np.isfinite(off[n])] for n in off])
        free = max(rest.size - at.size, 1)
        chi2 = float(rest @ rest) / free
        typical = chi2 if loss == "linear" else (1.4826 * float(np.median(np.abs(rest)))) ** 2
        whole = len(self.data.estimated) == len(self.data.values)
        size = np.array([x.size * x.factor for x in self.numbers.values()])
        covariance, blind = _inverse(jacobian)
        shared = self.data.correlation()
        if shared is not None:
            # least squares without weights for the correlation: its errors are (J'J)^-1 J'CJ (J'J)^-1
            covariance = covariance @ (jacobian.T @ shared @ jacobian) @ covariance
        covariance = covariance * (typical if whole else max(typical, 1.0)) * np.outer(size, size)
        for k in np.flatnonzero(blind):
            covariance[k, k] = math.inf
        names = tuple(self.numbers)
        values = {n: v * self.numbers[n].factor for n, v in self.natural(at).items()}
        errors = dict(zip(names, np.sqrt(np.diag(covariance)).tolist(), strict=True))
        back = np.argsort(self.data.order)
        residual = {n: (x * self.data.factor[n])[back] for n, x in off.items()}
        residual = {n: x[:, 0] if x.shape[1] == 1 else x for n, x in residual.items()}
        found = MotionFit(
            in_units_of(self.guess, motion),
            names,
            values,
            errors,
            covariance,
            residual,
            chi2,
            self.data.estimated,
            (),
            {n: x.unit for n, x in self.numbers.items()},
        )
        return found._replace(undetermined=tuple(self.undetermined(at, found, jacobian)))

    def undetermined(self, at: Floats, found: MotionFit, jacobian: Floats) -> list[str]:
        """Sentences that say which of the fitted numbers the points do not determine, and why."""
        said = []
        effect = np.linalg.norm(jacobian, axis=0)
        low, high = self.bounds()
        for k, (name, x) in enumerate(self.numbers.items()):
            value, error = found.values[name], found.errors[name]
            if effect[k] <= _NONE * effect.max():
                said.append(f"{name}: not determined, the points do not depend on it")
            elif min(at[k] - low[k], high[k] - at[k]) < _AT_BOUND:
                said.append(f"{name}: at its bound {value:.6g}, so that its error is not known")
            elif x.low >= 0 and abs(value) < error < math.inf:
                said.append(f"{name}: not determined, {value:.2g} +- {error:.2g}")
        free = [n for n in found.names if math.isinf(found.errors[n]) and not any(n + ":" in x for x in said)]
        if free:
            said.append(f"{', '.join(free)}: the points do not determine them, only a combination")
        for i, one in enumerate(found.names):
            for other in found.names[i + 1 :]:
                c = found.correlation(one, other)
                if abs(c) > _CORRELATED:
                    told = f"the points determine only a combination of both (correlation {c:+.4f})"
                    said.append(f"{one}, {other}: {told}")
        return said

    def warnings(self, at: Floats, found: MotionFit) -> list[str]:
        """Sentences that warn about the fit as a whole."""
        said = []
        motion = found.motion.natural
        if motion.t[-1] < self.data.t[-1] and motion.status.name != "STOPS":
            late = int((self.data.t > motion.t[-1]).sum())
            said.append(f"measured: the fitted motion ends ({motion.status}) before {late} of the points")
        if found.chi2 > (_MISFIT if not self.data.estimated else _TAILED):
            why = "scatter" if self.data.estimated else "errors"
            told = f"chi2 = {found.chi2:.3g}: this motion does not explain the points within their {why}"
            said.append(f"{told}; are there wrong marks, or is the guess too far from the motion?")
        return said


def _inverse(jacobian: Floats) -> tuple[Floats, Any]:
    """Inverse of J^T J with the Jacobian J, and which numbers the points do not determine."""
    effect = np.linalg.norm(jacobian, axis=0)
    scale = np.where(effect > _NONE * effect.max(), effect, np.inf)
    _, size, axes = np.linalg.svd(jacobian / scale, full_matrices=False)
    seen = size > _NONE * size[0]
    blind = np.isinf(scale) | ((np.abs(axes[~seen]) > 0.1).any(axis=0) & np.isfinite(scale))
    part = axes[seen].T / size[seen]
    return part @ part.T / np.outer(scale, scale), blind
