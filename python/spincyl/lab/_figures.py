"""Figures of measured data: measured and computed steady states, and a spin-down with fitted drifts."""

import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._input.numbers import instance_of, optional_library
from spincyl.lab._compare import Comparison
from spincyl.lab._lossfit import LossFit
from spincyl.lab._report import with_error
from spincyl.studio.plot._style import (
    BLACK,
    BLUE,
    GREEN,
    HERTZ,
    ORANGE,
    PURPLE,
    SKY,
    new_axes,
    own_ticks,
    sized,
)
from spincyl.studio.shape import steepest

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_NATURAL = {"t": r"$\sqrt{R/g}$", "precession": r"$\sqrt{g/R}$"}
_SECONDS = {"t": "s", "precession": "rad/s"}
_MOST_LAWS = 4  # number of laws that are drawn


@sized
def comparison(found: Comparison, ax: "Axes | None" = None) -> "Axes":
    """Draw measured steady states with error bars, and those of the body as built and as fitted.

    Parameters
    ----------
    found : Comparison
        Result of `spincyl.data.compare`.
    ax : matplotlib Axes, optional
        Axes to draw on. Default: new axes.

    Returns
    -------
    Axes
        Axes of the inclination in degrees against the reduced rate, or against turns per second if these
        were measured.

    Raises
    ------
    TypeError
        If `found` is not a Comparison, or `ax` not an Axes.
    """
    instance_of("found", found, Comparison)
    ax, ratio = new_axes(ax), with_error(found.ratio, found.ratio_err, r"\pm")
    curves = (
        (found.body, BLUE, "-", f"$I_1/I_3 = {found.expected:.4g}$, as built"),
        (found.fitted, ORANGE, "--", f"$I_1/I_3 = {ratio}$, fitted"),
    )[: 1 if np.isnan(found.ratio) else 2]
    most, unit = steepest(found.body), 1.0 if np.isnan(found.unit) else found.unit
    wide = np.linspace(0, most, 4001)[1:]
    for body, colour, line, label in curves:
        balance = float(body.theta_balance)  # NaN for a ball
        theta = np.sort(np.append(wide, balance)) if balance < most else wide
        ax.plot(unit * body.rate(theta), np.degrees(theta), line, color=colour, lw=2, label=label)
    bars: dict[str, Any] = {"fmt": "o", "color": BLACK, "ms": 4, "lw": 1.2, "capsize": 2, "label": "measured"}
    degrees = np.degrees(found.theta), np.degrees(found.theta_err)
    top = 180 if degrees[0].max() > 90 else 90
    ax.errorbar(unit * found.rate, degrees[0], xerr=unit * found.rate_err, yerr=degrees[1], **bars)
    ax.set(xlim=(0, 1.25 * unit * float(found.rate.max())), ylim=(0, top), yticks=range(0, top + 1, 15))
    ax.set_xlabel(HERTZ if unit != 1 else r"reduced rotation rate  $\widetilde\Omega$")
    ax.set_ylabel(r"inclination  $\theta$ (degrees)")
    fillet = rf", $\rho = {found.body.fillet:.4g}$" if found.body.fillet else ""
    ax.set_title(rf"$\ell = {found.body.ell:.4g}${fillet}, $\chi^2$ per degree of freedom {found.chi2:.2g}")
    ax.legend(loc="center right")
    return ax


@sized
def losses(found: LossFit, axes: "Sequence[Axes] | None" = None) -> "list[Axes]":
    """Draw a fitted spin-down: the data with fits, the residuals of the best fit, and a log-log diagram.

    The fits of the four best laws are drawn. The log-log diagram shows the data against the time that is
    left until the body stops. If both inclination and precession were measured, the curves show the
    inclination, and the residuals of both are drawn.

    Parameters
    ----------
    found : LossFit
        Result of `spincyl.data.fit_losses`.
    axes : sequence of three matplotlib Axes, optional
        Axes to draw on. Default: three new ones side by side.

    Returns
    -------
    list of Axes
        The three axes.

    Raises
    ------
    TypeError
        If `found` is not a LossFit, or `axes` are not three Axes.
    """
    instance_of("found", found, LossFit)
    if axes is None:
        plt: Any = optional_library("matplotlib.pyplot", "plot")
        _, axes = plt.subplots(1, 3, figsize=(16, 4.8), layout="constrained")
        own_ticks(*axes)
    data, rest, logs = axes
    unit = _NATURAL if found.body.scale is None else _SECONDS
    time = f"time  $t$ ({unit['t']})"
    measured: dict[str, tuple[Any, Any]] = {}
    if found.theta is not None:
        measured["theta"] = found.theta, found.theta_err
    if found.precession is not None:
        measured["precession"] = found.precession, found.precession_err
    name, (values, errors) = next(iter(measured.items()))
    drawn = (
        r"inclination  $\theta$ (rad)"
        if name == "theta"
        else rf"precession  $\varphi'$ ({unit['precession']})"
    )

    t_err = found.t_err if found.t_err.any() else None
    bars: dict[str, Any] = {"fmt": "o", "ms": 3, "lw": 1}
    data.errorbar(
        found.t, values, xerr=t_err, yerr=errors, color=BLACK, label="measured", alpha=0.5, zorder=1, **bars
    )
    styles = ((BLUE, "-"), (ORANGE, "--"), (GREEN, "-."), (PURPLE, ":"))
    for fit, (colour, line) in zip(found.fits[:_MOST_LAWS], styles, strict=False):
        last = min(float(found.t[-1]), fit.stops_at)
        clock = np.linspace(0.0, last - float(found.t[0]), 601)[:-1]
        with warnings.catch_warnings():
            # drifts beyond their end warn; they are drawn for comparison only
            warnings.simplefilter("ignore")
            shown = getattr(fit.drift, name)(clock)
        label = f"{fit.name}, {fit.centre}" if found.centre == "either" else fit.name
        label += f", $\\Delta$AIC {fit.daic:.3g}" if fit.daic else ""
        data.plot(found.t[0] + clock, shown, line, color=colour, lw=2, label=label)
    data.set_xlabel(time)
    data.set_ylabel(drawn)
    data.set_title("measured and fitted")
    data.legend(fontsize="x-small")
    if name == "theta":
        data.set_ylim(bottom=0.0)

    marks = (BLUE, "o"), (SKY, "s")
    for (which, (_, err)), (colour, mark) in zip(measured.items(), marks, strict=False):
        off = found.best.residual[which] / err
        label = {"theta": r"$\theta$", "precession": r"$\varphi'$"}[which]
        rest.plot(found.t, off, mark, color=colour, ms=3, label=label)
    rest.axhline(0.0, color="#888888", lw=0.8)
    rest.set_xlabel(time)
    rest.set_ylabel("measured less fitted (standard errors)")
    rest.set_title(rf"residuals of {found.best.name}, $\chi^2$ {found.best.chi2:.2g}")
    if len(measured) > 1:
        rest.legend()

    logs.set_ylabel(drawn)
    _draw_log_log(found, logs, values, unit["t"])
    return [data, rest, logs]


def _draw_log_log(found: LossFit, ax: "Axes", values: Any, unit: str) -> None:
    """Draw the log-log line against the time left until it reaches zero; without a line, only the data."""
    ticker: Any = optional_library("matplotlib.ticker", "plot")
    ax.set_xscale("log")
    ax.set_yscale("log")
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(ticker.NullFormatter())
    ax.set_xlabel(f"time left by the line ({unit})")
    if found.line is None:
        ax.set_title("log-log line: none")
        left = found.t[-1] - found.t[:-1]
        ax.plot(left[left > 0], values[:-1][left > 0], "o", color=BLACK, ms=3, alpha=0.5)
        ax.set_xlabel(f"time before the last point ({unit})")
        return
    left = found.line.stops_at - found.t
    ax.plot(left, values, "o", color=BLACK, ms=3, alpha=0.5)
    ends = np.array([left.min(), left.max()])
    label = rf"exponent ${found.line.exponent:.3f} \pm {found.line.exponent_err:.3f}$"
    ax.plot(ends, found.line.factor * ends**found.line.exponent, color=ORANGE, lw=2, label=label)
    ax.set_title("log-log line: a quick look only, biased")
    ax.legend()
