"""Motions: what they do, what the eye sees of them, and what was measured."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl import _exposure
from spincyl._array import extra
from spincyl.plot._style import BLACK, BLUE, FONT, ORANGE, new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from spincyl._motion import Motion
    from spincyl.data import Comparison


def motion(m: "Motion", axes: "Sequence[Axes] | None" = None) -> "list[Axes]":
    """Draw a motion: inclination and tilting, the contact path on the table, the contact force.

    Parameters
    ----------
    m : Motion
        What it lacks of pose and contact force is computed.
    axes : three matplotlib Axes, optional
        Default: three new ones side by side.

    Returns
    -------
    list of Axes
    """
    if not hasattr(m, "wanting"):
        raise TypeError(f"m: expected a Motion, not {type(m).__name__}")
    if axes is None:
        plt: Any = extra("matplotlib.pyplot", "plot")
        _, axes = plt.subplots(1, 3, figsize=(16, 4.8), layout="constrained")
    tilt, path, force = axes
    m = m.wanting("pose", "contact")
    tilt.plot(m.t, np.degrees(m.theta), color=BLUE, lw=1.8)
    tilt.set_xlabel(r"time  $t$ ($\sqrt{R/g}$)", fontsize=FONT)
    tilt.set_ylabel(r"inclination  $\theta$ (degrees)", fontsize=FONT)
    how = "rolling" if m.contact == "rolling" else "smooth table"
    tilt.set_title(rf"{how}, $\ell = {m.body.ell:.4g}$", fontsize=FONT)
    # so that rounding does not fill the picture where theta is constant
    low, high = tilt.get_ylim()
    if high - low < 1e-3:
        tilt.set_ylim(low - 0.5, high + 0.5)

    x, y = m.contact_point.T
    path.plot(x, y, color=BLUE, lw=1.4, label="contact point")
    path.plot(m.centre[:, 0], m.centre[:, 1], color=ORANGE, lw=1.4, label="centre, from above")
    if m.t.size:
        path.plot(x[0], y[0], "o", color=BLACK, ms=6)
        path.plot(x[-1], y[-1], "s", color=BLACK, ms=6)
        path.plot(*m.centre[-1, :2], "P", color=ORANGE, ms=7)
    path.set_aspect("equal", adjustable="datalim")
    path.set_xlabel(r"$x$ ($R$)", fontsize=FONT)
    path.set_ylabel(r"$y$ ($R$)", fontsize=FONT)
    path.set_title("on the table, from dot to square", fontsize=FONT)
    below: dict[str, Any] = {
        "fontsize": FONT - 2,
        "loc": "upper center",
        "bbox_to_anchor": (0.5, -0.17),
        "ncols": 2,
    }
    path.legend(**below)

    force.plot(m.t, m.normal, color=BLUE, lw=1.8, label=r"normal force $N$")
    force.plot(m.t, m.friction, color=ORANGE, lw=1.8, ls="--", label="friction demand")
    force.axhline(1.0, color="#888888", lw=0.8, ls=":")
    if float(np.max(m.normal, initial=0.0)) > 20:
        force.set_yscale("log")
    else:
        force.set_ylim(bottom=min(0.0, float(np.min(m.normal, initial=0.0))))
    force.set_xlabel(r"time  $t$ ($\sqrt{R/g}$)", fontsize=FONT)
    force.set_ylabel("force ($Mg$)", fontsize=FONT)
    force.set_title(_ending(m), fontsize=FONT)
    force.legend(**below)
    for ax in axes:
        ax.tick_params(labelsize=FONT - 1)
    return [tilt, path, force]


def _ending(m: "Motion") -> str:
    """How it ended, for a title."""
    if m.event is None:
        return "contact force"
    words = m.event.ending.name.lower().replace("_", "-")
    return f"contact force, until {words} at $t = {m.event.time:.5g}$"


def exposure(
    m: "Motion",
    seconds: float | None = None,
    *,
    ax: "Axes | None" = None,
    gamma: float = 0.8,
    **how: Any,
) -> "Axes":
    """Draw what the eye sees: the long-exposure photograph from above, developed.

    Parameters
    ----------
    m : Motion
    seconds : float, optional
        As `spincyl.exposure` takes it, and so are `scale`, `upper`, `size`, `samples` and `width`.
    ax : matplotlib Axes, optional
        Default: a new one.
    gamma : float
        Exponent of the brightness; smaller ones bring out what is faint.

    Returns
    -------
    Axes
        In R about the middle of the centre's path.
    """
    width = how.pop("width", None)
    half = (_exposure.frame(m, seconds, how.get("scale")) if width is None else width) / 2
    light = _exposure.exposure(m, seconds, width=2 * half, **how)
    ax = new_axes(ax)
    brightest = np.percentile(light[light > 0], 99.7) if light.any() else 1.0
    ax.imshow(
        np.clip(light / brightest, 0, 1) ** gamma,
        cmap="gray",
        vmin=0,
        vmax=1,
        extent=(-half, half, -half, half),
    )
    ax.set_xlabel("$x$ ($R$)", fontsize=FONT)
    ax.set_ylabel("$y$ ($R$)", fontsize=FONT)
    return ax


def comparison(found: "Comparison", ax: "Axes | None" = None) -> "Axes":
    """Draw a measurement with its error bars, the body's branches, and those of the fitted inertia ratio.

    Parameters
    ----------
    found : Comparison
        From `spincyl.data.compare`.
    ax : matplotlib Axes, optional
        Default: a new one.

    Returns
    -------
    Axes
    """
    ax = new_axes(ax)
    curves = (
        (found.body, BLUE, "-", f"$I_1/I_3 = {found.expected:.4g}$, as built"),
        (found.fitted, ORANGE, "--", rf"$I_1/I_3 = {found.ratio:.4g} \pm {found.ratio_err:.1g}$, fitted"),
    )
    for body, colour, line, label in curves:
        theta = np.sort(np.append(np.linspace(0, np.pi / 2, 4001)[1:], body.theta_balance))
        ax.plot(body.rate(theta), np.degrees(theta), line, color=colour, lw=2, label=label)
    bars: dict[str, Any] = {"fmt": "o", "color": BLACK, "ms": 4, "lw": 1.2, "capsize": 2, "label": "measured"}
    degrees = np.degrees(found.theta), np.degrees(found.theta_err)
    ax.errorbar(found.rate, degrees[0], xerr=found.rate_err, yerr=degrees[1], **bars)
    ax.set(xlim=(0, 1.25 * float(found.rate.max())), ylim=(0, 90), yticks=range(0, 91, 15))
    ax.set_xlabel(r"reduced rotation rate  $\widetilde\Omega$", fontsize=FONT)
    ax.set_ylabel(r"inclination  $\theta$ (degrees)", fontsize=FONT)
    ax.set_title(
        rf"$\ell = {found.body.ell:.4g}$, $\chi^2$ per degree of freedom {found.chi2:.2g}", fontsize=FONT
    )
    ax.legend(fontsize=FONT - 2, loc="center right")
    return ax
