"""The angles, axes and points of the equations, drawn on an inclined body."""

from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._input.numbers import Floats
from spincyl.studio.plot._style import BLACK, BLUE, GREEN, ORANGE, PURPLE, new_axes, sized

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ELL, _THETA, _PHI, _PSI = 1.7, np.radians(52), np.radians(38), np.radians(68)
_AZIMUTH, _ELEVATION = np.radians(-67), np.radians(27)  # direction of view
_GREY = "#8A8A8A"


@sized
def frame(*, ax: "Axes | None" = None) -> "Axes":
    """Draw an inclined body with its angles, axes and points, as a key to the equations.

    The angles are theta, phi and psi, the axes e1, e2 and e3. The points are the contact point P, the top O
    of the upper rim, and the top X of the lower rim.

    Parameters
    ----------
    ax : matplotlib Axes, optional
        Axes to draw on. Default: new axes.

    Returns
    -------
    Axes
        Axes with a parallel projection of the body, in units of R.

    Examples
    --------
    >>> import spincyl as sc
    >>> sc.plot.frame().axison
    False
    """
    ax = new_axes(ax)
    lean, across = _horizontal(_PHI), _horizontal(_PHI + np.pi / 2)
    up = np.array([0.0, 0.0, 1.0])
    e1 = np.cos(_THETA) * lean + np.sin(_THETA) * up
    e2 = across
    e3 = np.cos(_THETA) * up - np.sin(_THETA) * lean
    centre = (_ELL * np.cos(_THETA) + np.sin(_THETA)) * up
    top, low = centre + _ELL * e3, centre - _ELL * e3
    contact = low - e1

    _table(ax, float(np.linalg.norm(contact)))
    _cylinder(ax, top, low, e1, e2)

    # phi, on the table
    x = 2.6 * _horizontal(0.0)
    _line(ax, 0 * up, x, color=_GREY, ls="--", lw=1.2)
    _line(ax, 0 * up, 3 * contact, color=_GREY, ls="--", lw=1.2)
    _write_word(ax, x, "$x$", (10, -3), _GREY)
    _arc(ax, 0 * up, _horizontal(0.0), across=_horizontal(np.pi / 2), radius=2.0, to=_PHI, name=r"$\varphi$")
    # theta, between the vertical and the axis
    _line(ax, 0 * up, centre, color=_GREY, ls="--", lw=1.2)
    _arrow(ax, centre, centre + 2.3 * up, BLACK, "$z$", (0, 9))
    _arc(ax, centre, up, across=-lean, radius=1.3, to=_THETA, name=r"$\theta$")
    # psi, on the upper end: from e1 to a line painted on the body
    painted = np.cos(_PSI) * e1 + np.sin(_PSI) * e2
    _line(ax, top, top + e1, color=_GREY, ls="--", lw=1.2)
    _line(ax, top, top + painted, color=PURPLE, lw=2)
    _arc(ax, top, e1, across=e2, radius=0.5, to=_PSI, name=r"$\psi$", colour=PURPLE)

    axes: tuple[tuple[Floats, float, str, tuple[float, float]], ...] = (
        (e1, 1.75, "1", (9, 6)),
        (e2, 1.6, "2", (-11, 1)),
        (e3, 2.9, "3", (-9, 8)),
    )
    for axis, length, name, off in axes:
        _arrow(ax, centre, centre + length * axis, BLUE, rf"$\mathbf{{e}}_{name}$", off)
    _arrow(ax, contact, contact + 1.1 * e2, GREEN, r"$\psi'\,\mathbf{e}_2$", (-3, 13))
    points: tuple[tuple[Floats, str, str, tuple[float, float]], ...] = (
        (top + e1, "$O$", ORANGE, (2, 15)),
        (low + e1, "$X$", ORANGE, (16, 3)),
        (centre, "$C$", BLACK, (-10, -9)),
    )
    for place, name, colour, off in points:
        ax.plot(*_projected(place), "o", color=colour, ms=7, zorder=6)
        _write_word(ax, place, name, off, colour)
    ax.plot(*_projected(contact), "o", color=ORANGE, ms=7, zorder=6)
    thin: dict[str, Any] = {"arrowstyle": "-", "color": ORANGE, "lw": 0.8, "shrinkB": 5}
    how: dict[str, Any] = {"textcoords": "offset points", "ha": "right", "color": ORANGE, "arrowprops": thin}
    ax.annotate("contact point $P$", _projected_point(contact), (-45, -48), zorder=7, **how)
    ax.set_aspect("equal")
    ax.axis("off")
    return ax


def _horizontal(angle: float) -> Floats:
    """The horizontal direction at this angle from x."""
    return np.array([np.cos(angle), np.sin(angle), 0.0])


def _view() -> Floats:
    """Unit vector from the body towards the eye."""
    view: Floats = np.cos(_ELEVATION) * _horizontal(_AZIMUTH) + np.array([0.0, 0.0, np.sin(_ELEVATION)])
    return view


def _projected(places: Floats) -> Floats:
    """Projection of points (..., 3) to picture coordinates: right and up."""
    right = _horizontal(_AZIMUTH + np.pi / 2)
    found: Floats = np.array([places @ right, places @ np.cross(_view(), right)])
    return found


def _projected_point(place: Floats) -> tuple[float, float]:
    """Projection of one point."""
    right, above = _projected(place).tolist()
    return right, above


def _line(ax: "Axes", start: Floats, end: Floats, **style: Any) -> None:
    ax.plot(*_projected(np.array([start, end])), **style)


def _write_word(ax: "Axes", at: Floats, word: str, off: tuple[float, float], colour: str) -> None:
    how: dict[str, Any] = {"color": colour, "ha": "center", "va": "center", "zorder": 7, "fontsize": "large"}
    ax.annotate(word, _projected_point(at), off, textcoords="offset points", **how)


def _arrow(ax: "Axes", start: Floats, end: Floats, colour: str, word: str, off: tuple[float, float]) -> None:
    style: dict[str, Any] = {"arrowstyle": "-|>", "color": colour, "lw": 2, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", _projected_point(end), _projected_point(start), arrowprops=style, zorder=5)
    ax.plot(*_projected(end), alpha=0)  # an invisible point, so that the limits of the axes include the arrow
    _write_word(ax, end, word, off, colour)


def _arc(
    ax: "Axes",
    centre: Floats,
    along: Floats,
    *,
    across: Floats,
    radius: float,
    to: float,
    name: str,
    colour: str = BLACK,
) -> None:
    """Draw an angle: an arc with an arrow in the positive direction, and its name outside near the middle."""
    angle = np.linspace(0, to, 60)[:, np.newaxis]
    place = centre + radius * (np.cos(angle) * along + np.sin(angle) * across)
    ax.plot(*_projected(place), color=colour, lw=1.8, zorder=4)
    style: dict[str, Any] = {"arrowstyle": "-|>", "color": colour, "lw": 1.8, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", _projected_point(place[-1]), _projected_point(place[-5]), arrowprops=style, zorder=4)
    middle = np.cos(0.4 * to) * along + np.sin(0.4 * to) * across
    _write_word(ax, centre + (radius + 0.22) * middle, name, (0, 0), colour)


def _table(ax: "Axes", radius: float) -> None:
    """Draw the table, and the circle of the contact point on it."""
    corners = np.array([[3.0, -2.2], [3.0, 2.6], [-2.6, 2.6], [-2.6, -2.2]])
    ax.fill(*_projected(np.column_stack([corners, np.zeros(4)])), color="#F3F0EA", lw=0, zorder=0)
    angle = np.linspace(0, 2 * np.pi, 200)
    circle = radius * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    ax.plot(*_projected(circle), color=GREEN, lw=1.2, ls=":", zorder=1)


def _cylinder(ax: "Axes", top: Floats, low: Floats, e1: Floats, e2: Floats) -> None:
    """Draw the outline of the cylinder; the hidden part of the lower rim is dashed."""
    angle = np.linspace(0, 2 * np.pi, 721)[:, np.newaxis]
    out = np.cos(angle) * e1 + np.sin(angle) * e2
    front = out @ _view() > 0
    edges = out[np.flatnonzero(front[1:] != front[:-1])]
    # the visible half of the lower rim, in order round it
    start = int(np.flatnonzero(front[1:] & ~front[:-1])[0]) + 1
    order = np.roll(np.arange(720), -start)
    near, far = order[front[order]], order[~front[order]]
    lit = low + out[near]
    body = np.concatenate([lit, top + out[near[::-1]]])
    ax.fill(*_projected(body), color="#DCE9F3", alpha=0.75, lw=0, zorder=2)
    ax.fill(*_projected(top + out[:720]), color="#EEF5FA", alpha=0.85, lw=0, zorder=2)
    ax.plot(*_projected(top + out), color=BLACK, lw=1.8, zorder=3)
    ax.plot(*_projected(lit), color=BLACK, lw=1.8, zorder=3)
    ax.plot(*_projected(low + out[far]), color=BLACK, lw=1, ls="--", zorder=3)
    for edge in edges:
        _line(ax, low + edge, top + edge, color=BLACK, lw=1.8, zorder=3)
