"""Figures of a film from above: inclination, precession and centre against time, beside a motion."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._input.numbers import optional_library
from spincyl.lab._beside import FilmComparison
from spincyl.lab._filmed import Filmed
from spincyl.studio.plot._style import BLACK, BLUE, ORANGE, own_ticks, sized

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_TIME = "time  $t$ (s)"


@sized
def film(found: Filmed | FilmComparison, axes: "Sequence[Axes] | None" = None) -> "list[Axes]":
    """Draw a film frame by frame: inclination, precession and centre against time, with error bars.

    Parameters
    ----------
    found : Filmed or FilmComparison
        Result of `spincyl.data.from_above`, or of `spincyl.data.compare` for a film and a motion, whose
        values are then drawn as lines.
    axes : sequence of three matplotlib Axes, optional
        Axes to draw on. Default: three new ones side by side.

    Returns
    -------
    list of Axes
        The three axes: inclination in degrees, precession in rad/s, and x and y of the centre in mm. The
        bars are standard errors.

    Raises
    ------
    TypeError
        If `found` is neither a Filmed nor a FilmComparison, or `axes` are not three Axes.
    """
    if not isinstance(found, Filmed | FilmComparison):
        raise TypeError(f"found: expected a Filmed or a FilmComparison, not {type(found).__name__}")
    seen = found if isinstance(found, Filmed) else found.film
    if axes is None:
        plt: Any = optional_library("matplotlib.pyplot", "plot")
        _, axes = plt.subplots(1, 3, figsize=(16, 4.8), layout="constrained")
        own_ticks(*axes)
    first, second, third = axes
    rows = (
        (first, "theta", np.degrees(1.0), BLACK, "measured"),
        (second, "precession", 1.0, BLACK, "measured"),
        (third, "x", 1e3, BLUE, "x"),
        (third, "y", 1e3, ORANGE, "y"),
    )
    frames, errors = seen.frames, seen.errors
    chi2 = {} if isinstance(found, Filmed) else found.chi2
    for ax, name, factor, colour, label in rows:
        bars: dict[str, Any] = {"fmt": "o", "ms": 3, "lw": 1, "color": colour, "alpha": 0.6}
        ax.errorbar(seen.t, factor * frames[name], yerr=factor * errors[name], label=label, **bars)
        if isinstance(found, FilmComparison):
            line = ORANGE if colour == BLACK else colour
            told = "computed" if colour == BLACK else f"{name}, computed"
            ax.plot(seen.t, factor * found.computed[name], color=line, lw=2, label=told, zorder=3)
        ax.legend(fontsize="x-small")
        ax.set_xlabel(_TIME)
    first.set_ylabel(r"inclination  $\theta$ (degrees)")
    second.set_ylabel(r"precession  $\varphi'$ (rad/s)")
    third.set_ylabel("centre (mm)")
    for ax, name in ((first, "theta"), (second, "precession"), (third, "centre")):
        if name in chi2:
            ax.set_title(rf"$\chi^2$ {chi2[name]:.3g}")
    return [first, second, third]
