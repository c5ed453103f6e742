"""A map of flicks: which settle and how long that takes, which lie down, and which lift off or hop first."""

from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._input.numbers import optional_library
from spincyl.studio.plot._style import FORBIDDEN, SMOOTH, UNSTABLE, hatching, new_axes, sized
from spincyl.sweep._flicks import Outcome

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

#: A tube whose last slip is within this share of the time before the end probably slips in every nod.
_LAST_SLIP_SHARE = 0.05
_AXES = {
    "hertz": "turns per second about the vertical, at first",
    "spin_hertz": "turns per second about the axis, at first",
    "precession": r"$\omega_1$ ($\sqrt{g/R}$), at first",
    "launch": r"launch number  $I_3 \omega_1 \omega_3/\ell$",
    "centre": "velocity of the centre, at first",
}
#: Hatching of flicks that hop first: it shows without colours, and over the colours of those that settle.
_HOPS, _INK = "////", "0.3"
#: Upper end of the colours, in medians: few tubes slip much longer than most without slipping to the end.
_MEDIANS_SHOWN = 2.0


@sized
def flicks(found: "xarray.Dataset", ax: "Axes | None" = None) -> "Axes":
    """Draw a map of the outcomes of flicks.

    For tubes that settle on one rim, colours show the time until they roll. Tubes that slip until the last
    time, or in every nutation until shortly before this time, have a colour of their own. If the flicks were
    computed with a `restitution`, the area of the tubes that hop first is hatched.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `spincyl.sweep.flicks` with two dimensions: the first is the horizontal axis, the second the
        vertical axis.
    ax : matplotlib Axes, optional
        Axes to draw on. Default: new axes. A colour bar is added to the figure.

    Returns
    -------
    Axes
        The axes of the map.

    Raises
    ------
    TypeError
        If `found` is not a Dataset, or `ax` not an Axes.
    ValueError
        If `found` is not a result of `sweep.flicks`, or does not have two dimensions with coordinates and at
        least two values each.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> rates, numbers = np.linspace(1.0, 6.0, 4), np.linspace(1.1, 3.0, 3)
    >>> tube = sc.Body.tube(6.0, bore=0.8)
    >>> ends = sc.sweep.flicks(tube, 200.0, w1=rates, launch=numbers, contact=sc.Coulomb(0.3))
    >>> sc.plot.flicks(ends).get_ylabel()[:13]
    'launch number'
    """
    lib: Any = optional_library("xarray", "sweep")
    if not isinstance(found, lib.Dataset):
        raise TypeError(f"found: expected a Dataset of sweep.flicks, not {type(found).__name__}")
    if not {"outcome", "rolling_time"} <= set(found):
        raise ValueError('found: expected a Dataset of sweep.flicks with "outcome" and "rolling_time"')
    axes = found["outcome"].dims
    if len(axes) != 2 or not all(name in found.coords and found.sizes[name] > 1 for name in axes):
        sizes = dict(found["outcome"].sizes)
        raise ValueError(
            f"found: expected two dimensions of at least two values, not {sizes}; use .sel or .isel"
        )
    colormap: Any = optional_library("matplotlib.colors", "plot").ListedColormap
    patch: Any = optional_library("matplotlib.patches", "plot").Patch
    followed = "air_time" in found  # those that hop are followed in the air
    found = found[["outcome", "rolling_time"]].sortby(list(axes)).transpose(*reversed(axes))
    across, up = (found[name].values for name in axes)
    outcome = found["outcome"].values
    ax = new_axes(ax)
    hops_on, hops_down = (outcome == x for x in (Outcome.HOPS_AND_SETTLES, Outcome.HOPS_AND_LIES))
    settles, times = hops_on | (outcome == Outcome.SETTLES), found["rolling_time"].values
    rolls = settles & (times <= (1 - _LAST_SLIP_SHARE) * found.attrs.get("t", np.inf))
    others = {
        "lies down": (FORBIDDEN, hops_down | (outcome == Outcome.LIES_DOWN)),
        "in the air at the end" if followed else "lifts off": (UNSTABLE, outcome == Outcome.LIFTS_OFF),
        "slips up to the end": (SMOOTH, settles & ~rolls),
        "none of these": ("0.35", outcome == Outcome.NONE),
    }
    shown = []
    for words, (colour, where) in others.items():
        if where.any():
            mask = np.ma.masked_where(~where, where.astype(float))
            look = hatching(colour)
            ax.pcolormesh(across, up, mask, cmap=colormap([colour]), rasterized=True)
            ax.pcolor(across, up, mask, cmap=colormap(["none"]), rasterized=True, **look)
            shown.append(patch(facecolor=colour, label=words, **look))
    times = np.where(rolls, times, np.nan)
    if np.isfinite(times).any():
        most = min(float(np.nanmax(times)), _MEDIANS_SHOWN * float(np.nanmedian(times)))
        colours = ax.pcolormesh(across, up, times, cmap="viridis", vmin=0.0, vmax=most, rasterized=True)
        unit = "s" if "radius" in found.attrs else r"$\sqrt{R/g}$"
        beyond = "max" if np.nanmax(times) > most else "neither"
        bar = ax.figure.colorbar(colours, ax=ax, extend=beyond)
        bar.set_label(f"settles, and rolls after ({unit})", labelpad=8)
    ax.set(**{f"{x}label": _AXES.get(str(name), str(name)) for x, name in zip("xy", axes, strict=True)})
    ax.set_title(found.attrs.get("contact", ""))
    hops = hops_on | hops_down
    if hops.any():
        mask = np.ma.masked_where(~hops, hops.astype(float))
        ax.pcolor(across, up, mask, cmap=colormap(["none"]), hatch=_HOPS, ec=_INK, lw=0, rasterized=True)
        shown.append(patch(facecolor="none", edgecolor=_INK, hatch=_HOPS, label="hops before"))
    if shown:
        ax.legend(handles=shown, loc="upper right", framealpha=0.9)
    return ax
