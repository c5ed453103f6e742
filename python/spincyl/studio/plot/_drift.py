"""A slow drift: inclination and precession rate against time, until the body stops."""

from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._drift import Drift
from spincyl._input.numbers import instance_of, optional_library
from spincyl._loss import losses_in_words
from spincyl.studio.plot._style import BLUE, ORANGE, new_axes, sized

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MANY = 401


@sized
def drift(found: Drift, ax: "Axes | None" = None) -> "Axes":
    """Draw the inclination (left axis) and the precession (right axis) of a drift against time.

    Parameters
    ----------
    found : Drift
        Single drift, from `spincyl.drift`. It is drawn in natural units; for a measured body in seconds and
        turns per second.
    ax : matplotlib Axes, optional
        Axes to draw on. Default: new axes. A second vertical axis is added for the precession.

    Returns
    -------
    Axes
        The axes of the inclination.

    Raises
    ------
    TypeError
        If `found` is not a Drift, or `ax` not an Axes.
    ValueError
        If `found` has several drifts.

    Examples
    --------
    >>> import spincyl as sc
    >>> coin = sc.Body.solid(0.1)
    >>> found = sc.drift(coin, 0.3, sc.loss.DryContour(1e-3))
    >>> sc.plot.drift(found).get_xlabel()[:4]
    'time'
    """
    if instance_of("found", found, Drift)._shape:
        raise ValueError(f"found: expected a single drift, not a family of shape {found._shape}")
    first, last = float(np.asarray(found.start.theta)), float(found.ends_at_theta)
    # equal steps of inclination; inclinations where the loss law is no longer valid are left out
    low = float(found._columns["eps"][0])
    tilt = np.linspace(first, last, _MANY)[:-1]
    tilt = tilt[(tilt >= low) | (tilt == first)]
    t = np.asarray(found.time(tilt))
    measured = found.body.scale is not None
    rate = np.asarray(found.precession(t)) / (2 * np.pi if measured else 1.0)
    ax = new_axes(ax)
    fast = ax.twinx()
    if np.isfinite(found.stops_at):
        t, tilt = np.append(t, found.stops_at), np.append(tilt, last)
    ax.plot(t, np.degrees(tilt), color=BLUE, lw=2)
    fast.plot(t[: rate.size], rate, "--", color=ORANGE, lw=2)
    if rate.max() > 10 * rate.min() > 0:
        fast.set_yscale("log")
        plain: Any = optional_library("matplotlib.ticker", "plot").ScalarFormatter()
        few: Any = optional_library("matplotlib.ticker", "plot").LogFormatter(minor_thresholds=(2, 0.5))
        fast.yaxis.set_major_formatter(plain)
        fast.yaxis.set_minor_formatter(few)
    ax.set_xlabel("time (s)" if measured else r"time  $t$ ($\sqrt{R/g}$)")
    ax.set_ylabel(r"inclination  $\theta$ (degrees)", color=BLUE)
    unit = "turns per second" if measured else r"$\sqrt{g/R}$"
    fast.set_ylabel(rf"precession  $\varphi'$ ({unit})", color=ORANGE)
    kept = "its centre at rest" if found.centre == "rest" else "it rolls"
    ax.set_title(f"{losses_in_words(found.losses, found.body.scale)}, {kept}; {found.ended}")
    return ax
