"""Axes, sizes and colours of the figures; the colours of Okabe and Ito are safe for the colour-blind."""

import inspect
from collections.abc import Callable
from functools import wraps
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import numpy as np
import numpy.typing as npt

from spincyl._contact import Contact
from spincyl._input.files import writing_whole
from spincyl._input.numbers import optional_library

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLUE, ORANGE, GREEN, PURPLE, SKY, BLACK = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#222222"
RED = "#B2182B"  # times of slipping
# Regions of maps differ in lightness L* (CIE 1976) by 6 or more, so that they differ in black and white, too.
FORBIDDEN, UNSTABLE, ROLLING, STABLE = "#949494", "#F2B083", "#EFDD55", "#E3F1FB"
SMOOTH = "#CC96BB"  # stable on a smooth table only
#: Hatching of regions, as on the live page.
HATCHES = {FORBIDDEN: "..", UNSTABLE: "xx", ROLLING: "//", SMOOTH: r"\\", STABLE: ""}
HATCH = "#666666"  # colour of the hatching
HERTZ = "turns per second"
# sizes in figures that this package makes; the user's own axes keep their sizes
SIZES = {
    "font.size": 13.0,
    "axes.titlesize": "medium",
    "axes.labelsize": "medium",
    "xtick.labelsize": 12.0,
    "ytick.labelsize": 12.0,
    "legend.fontsize": "small",
}

_Given = ParamSpec("_Given")
_Drawn = TypeVar("_Drawn")


def sized(draw: Callable[_Given, _Drawn]) -> Callable[_Given, _Drawn]:
    """Decorator of a drawing function: `SIZES` apply while it makes its own axes."""
    given = inspect.signature(draw)
    axes = "ax" if "ax" in given.parameters else "axes"

    @wraps(draw)
    def drawn(*args: _Given.args, **kwargs: _Given.kwargs) -> _Drawn:
        try:
            bound = given.bind(*args, **kwargs).arguments.get(axes)
        except TypeError:  # raised again by the call below, with the name of the function
            return draw(*args, **kwargs)
        if bound is not None:
            _refuse(axes, bound)
            return draw(*args, **kwargs)
        # Restore only these settings: the first figure in a notebook switches others to interactive mode.
        now: Any = optional_library("matplotlib", "plot").rcParams
        before = {key: now[key] for key in SIZES}
        now.update(SIZES)
        try:
            return draw(*args, **kwargs)
        finally:
            now.update(before)

    return drawn


def _refuse(name: str, value: Any) -> None:
    """Raise TypeError unless `value` is a matplotlib Axes, or three of them for the argument `axes`."""
    kind = optional_library("matplotlib.axes", "plot").Axes
    if name == "ax":
        if not isinstance(value, kind):
            raise TypeError(f"{name}: expected an Axes of matplotlib, not {type(value).__name__}")
        return
    try:
        several = list(value)
    except TypeError:
        several = []
    if len(several) != 3 or not all(isinstance(ax, kind) for ax in several):
        raise TypeError(f"{name}: expected three Axes of matplotlib, not {type(value).__name__}")


def new_axes(ax: "Axes | None") -> "Axes":
    """The given axes, or new ones."""
    if ax is None:
        plt: Any = optional_library("matplotlib.pyplot", "plot")
        _, ax = plt.subplots(figsize=(8, 5.6), layout="constrained")
        own_ticks(ax)
    return ax


def own_ticks(*axes: "Axes") -> None:
    """Set the size of tick labels, also for ticks that are made later."""
    for ax in axes:
        ax.tick_params(labelsize=SIZES["xtick.labelsize"])


def saved(figure: "Figure", path: Path, *, slide: bool = False, dpi: float = 150.0) -> None:
    """Save a figure in the format of its suffix; a slide is 16:9 with the same area."""
    if slide:
        width, height = figure.get_size_inches()
        height = 0.75 * float(np.sqrt(width * height))
        figure.set_size_inches(16 / 9 * height, height)
        dpi = 1080.001 / height
    made = BytesIO()  # in memory first: matplotlib hides errors of a full disk while it writes a PDF
    figure.savefig(made, format=path.suffix[1:].lower(), dpi=dpi)
    with writing_whole(path) as part:
        part.write_bytes(made.getvalue())


def title(contact: Contact | None, bore: float, fillet: float = 0.0) -> str:
    table = {
        "smooth": "smooth table (the paper's criterion)",
        "rolling": "rolling without slipping",
        None: "steady states, by both criteria",
    }
    return table[contact] + (f", bore {bore:g}" if bore else "") + (f", fillet {fillet:g}" if fillet else "")


def hatching(colour: str) -> dict[str, Any]:
    """The hatching of regions of a colour, for patches and meshes."""
    return {"hatch": HATCHES.get(colour, ""), "ec": HATCH, "lw": 0.0}


def hatch(ax: "Axes", where: Any, colour: str) -> None:
    """Hatch the points of the last image on these axes, so that regions differ without colours."""
    left, right, low, high = ax.images[-1].get_extent()
    rows, columns = where.shape
    edges = np.linspace(left, right, 2 * columns + 1)[1::2], np.linspace(low, high, 2 * rows + 1)[1::2]
    if HATCHES[colour] and min(rows, columns) > 1:
        drawn = ax.contourf(*edges, where.astype(float), [0.5, 1.5], colors="none", hatches=[HATCHES[colour]])
        drawn.set(edgecolor=HATCH, linewidth=0.0)


def curves(ax: "Axes", ell: npt.NDArray[np.float64], roots: npt.NDArray[np.float64], **style: Any) -> None:
    """Draw up to five inclinations against ell as curves; two that appear or vanish together are joined."""
    many = np.count_nonzero(~np.isnan(roots), axis=1)
    runs = np.split(np.arange(ell.size), np.flatnonzero(np.diff(many)) + 1)
    for run in runs:
        for k in range(many[run[0]]):
            ax.plot(ell[run], np.degrees(roots[run, k]), **style)
            style["label"] = "_"
    for before, after in pairwise(runs):
        more, edge = (before, before[-1]) if many[before[0]] > many[after[0]] else (after, after[0])
        if abs(int(many[before[0]]) - int(many[after[0]])) == 2:
            k = int(np.argmin(np.diff(roots[edge, : many[more[0]]])))
            ax.plot(ell[[edge, edge]], np.degrees(roots[edge, k : k + 2]), **style)
