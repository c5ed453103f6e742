"""Additions to the drawing of a motion that flies, bounces, lies on both rims or stands on its face."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spincyl._input.numbers import Floats, optional_library
from spincyl._phases import Phase
from spincyl.studio.aloft import aloft
from spincyl.studio.plot._style import BLACK, GREEN, ORANGE, RED, SKY
from spincyl.studio.poses import span

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from spincyl._motion import Motion


#: Sine of an inclination below which the whole face strikes the table.
FLAT = 1e-9


class PlotUnits(NamedTuple):
    """Units of time and of length of a plot, and the name of the unit of length."""

    second: float
    metre: float
    said: str


#: Colour, opacity and words for the times of each kind of phase.
_SHADES = {
    "slipping": (RED, 0.10, "slips"),
    "flying": (SKY, 0.28, "in the air"),
    "lying": ("#888888", 0.28, "lies on both rims"),
    "on its face": (GREEN, 0.14, "on its face"),
}


def _shade_of(phase: Phase) -> str:
    """The key of `_SHADES` for a phase; empty if the phase is not shaded."""
    return "" if phase.kind == "rolling" else phase.kind if phase.kind in _SHADES else "lying"


def breaks(m: "Motion") -> np.ndarray:
    """(n,) whether the rim that carries the body has changed since the time before; curves jump there."""
    other = aloft(m.natural, *span(m.natural)).on_other(m.natural.t)
    found: np.ndarray = np.append(False, other[1:] != other[:-1])
    return found


def parted(where: np.ndarray, *curves: Floats) -> list[Floats]:
    """Curves with a gap (NaN) before each point at which `where` is true."""
    at = np.flatnonzero(where)
    return [np.insert(np.asarray(curve, float), at, np.nan) for curve in curves]


def shades(axes: "Sequence[Axes]", m: "Motion", second: float) -> None:
    """Tint the times of slips, flights and rests on both rims; `second` is the unit of time of the axes."""
    ends = [phase.time for phase in m.phases[1:]] + [float(m.t[-1])]
    spans: list[tuple[str, float, float]] = []
    for phase, end in zip(m.phases, ends, strict=True):
        name, begin = _shade_of(phase), max(phase.time, float(m.t[0]))
        if spans and spans[-1][0] == name:
            spans[-1] = (name, spans[-1][1], end)
        elif begin < end:
            spans.append((name, begin, end))
    for name, begin, end in spans:
        for ax in axes if name else ():
            colour, opacity, _ = _SHADES[name]
            ax.axvspan(begin * second, end * second, color=colour, alpha=opacity, lw=0, zorder=0)


def height_and_legend(ax: "Axes", m: "Motion", t: Floats, units: PlotUnits, style: dict[str, Any]) -> None:
    """Draw the height of the lowest point, if it is known, the impacts, and a legend of the tints."""
    patch: Any = optional_library("matplotlib.patches", "plot").Patch
    there = dict.fromkeys(filter(None, map(_shade_of, m.phases)))
    shown = [patch(facecolor=_SHADES[x][0], alpha=_SHADES[x][1], label=_SHADES[x][2]) for x in there]
    shown += [] if m._impacts is None else _height(ax, m, t, units, style)
    ax.legend(handles=shown, loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=2)


def _height(ax: "Axes", m: "Motion", t: Floats, units: PlotUnits, style: dict[str, Any]) -> list[Any]:
    """Draw the height of the lowest point and the impacts; returns what the legend shows of them."""
    second, metre, said = units
    right = ax.twinx()
    high = m.natural.height * metre
    right.plot(t, high, color=ORANGE, **style)
    times = second * np.array([x.time for x in m.impacts])
    (marks,) = right.plot(times, 0 * times, "v", color=BLACK, ms=6, clip_on=False, label="impact", zorder=4)
    right.set_ylim(0, 1.1 * float(high.max()) or 1.0)
    if not high.any():
        right.set_axis_off()  # the body only rolls on its side
    right.set_ylabel(f"height of its lowest point ({said})", color=ORANGE)
    return [marks] if times.size else []


def strikes(m: "Motion") -> Floats:
    """(2, k) positions of the impacts of a motion on the table."""
    there = m.wanting("pose", t=np.unique([x.time for x in m.impacts]))
    flat = m._nods & (np.sin(there.theta)[:, np.newaxis] < FLAT)  # the whole face strikes
    found: Floats = np.where(flat, there.centre[:, :2], there.contact_point).T
    return found
