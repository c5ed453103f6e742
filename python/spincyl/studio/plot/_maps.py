"""Steady states: branches, the theta-ell map, the energy landscape."""

from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from spincyl._body import Body
from spincyl._contact import Contact, code_of
from spincyl._input.numbers import flag, in_range, is_scalar, number, one_of
from spincyl._measured import sized_body
from spincyl._single import one_body
from spincyl._state import State
from spincyl.studio.plot._style import (
    BLACK,
    BLUE,
    FORBIDDEN,
    GREEN,
    HERTZ,
    ORANGE,
    PURPLE,
    ROLLING,
    SKY,
    SMOOTH,
    STABLE,
    UNSTABLE,
    curves,
    hatch,
    hatching,
    new_axes,
    sized,
    title,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_HALF_PI = np.pi / 2


class Landmark(NamedTuple):
    """A point of a branch: its letter, its meaning, theta, and the reduced rate, infinite for C and D."""

    letter: str
    meaning: str
    theta: float
    rate: float


def landmarks(body: Body, contact: Contact = "rolling") -> list[Landmark]:
    """List the points A to G of one body: where its branches begin, turn, change stability and end.

    Parameters
    ----------
    body : Body
        Single body.
    contact : {"rolling", "smooth"}
        Contact whose stability gives the points F.

    Returns
    -------
    list of Landmark
        A: balanced at rest, at theta0; B: on its side, at rate 1; C: limit thetaInf of high rates; D: flat on
        its face; E: folds (extrema of the rate); F: changes of stability; G: ridges (extrema of the energy).
        C and D have an infinite rate. If I1 = I3, points that coincide with theta0 are left out.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid; the message names it.

    Examples
    --------
    >>> import spincyl as sc
    >>> [(x.letter, round(x.rate, 3)) for x in sc.plot.landmarks(sc.Body.solid(2.5))]
    [('A', 0.0), ('B', 1.0), ('C', inf), ('D', inf), ('F', 0.323), ('G', 0.599)]
    """
    one_body(body)
    fixed = [
        Landmark("A", "balanced at rest", float(body.theta_balance), 0.0),
        Landmark("B", "on its side", _HALF_PI, 1.0),
        Landmark("C", "fast limit", float(body.theta_limit), np.inf),
        Landmark("D", "flat, whirring", 0.0, np.inf),
    ]
    turning = (
        ("E", "fold", body.folds()),
        ("F", "stability changes", body.boundaries(contact)),
        ("G", "energy ridge", body.ridge()),
    )
    ends = np.array([body.theta_balance, body.theta_limit, _HALF_PI])
    return fixed + [
        Landmark(letter, meaning, float(x), float(body.rate(x)))
        for letter, meaning, thetas in turning
        for x in thetas
        if x == x and np.abs(x - ends).min() > 1e-6
    ]


@sized
def branches(
    ells: Iterable[float | Body],
    bore: float = 0.0,
    *,
    contact: Contact = "rolling",
    ax: "Axes | None" = None,
    rate_max: float | None = None,
    marks: bool | None = None,
    hertz: bool = False,
) -> "Axes":
    """Draw the inclination of steady states against their reduced rate: solid if stable, dashed if not.

    The letters of a single body: A balanced at rest, B on its side, C the limit of high rates, D flat on its
    face, E a fold, F a change of stability, G a ridge of the energy. Inclinations above 90 degrees,
    which a body with a rounded rim can have, are not drawn; the title says so.

    Parameters
    ----------
    ells : iterable of float or Body
        Aspect ratios of tubes, or bodies; each gives a curve. If there is only one, the regions of stability
        are shaded, and the points A to G are marked (see `landmarks`).
    bore : float
        Inner over outer radius of the tubes, 0 to 1. Bodies in `ells` keep their own bore.
    contact : {"rolling", "smooth"}
        Contact for the stability (see `Body.stability`); "smooth" is the criterion of Jackson et al.
    ax : matplotlib Axes, optional
        Axes to draw on. Default: new axes.
    rate_max : float, optional
        Largest rate on the axes, as a reduced rate, or in turns per second if `hertz` is true. Default: 3, or
        the turns per second at which the fastest body has the reduced rate 3.
    marks : bool, optional
        If true, mark the points A to G. Default: only for a single body.
    hertz : bool
        If true, draw turns per second instead of the reduced rate; the bodies must be measured, or from
        `Body.from_metres`.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid; the message names it.
    """
    bore = in_range("bore", bore, 0.0, 1.0)
    bodies = [x if isinstance(x, Body) else Body.tube(x, bore) for x in _ells(ells)]
    bores = {float(body.bore) for body in bodies if body.bore == body.bore}  # only tubes have one
    code_of(contact)
    units = [
        float(sized_body("ells", x, None)[1].hertz(x, 1.0)) if flag("hertz", hertz) else 1.0 for x in bodies
    ]
    rate_max = 3 * max(units) if rate_max is None else in_range("rate_max", rate_max, 1e-3, 1e3)
    marks = None if marks is None else flag("marks", marks)
    ax = new_axes(ax)
    ax.set(xlim=(0, rate_max), ylim=(0, 90), yticks=range(0, 91, 15))
    colours = [BLUE, ORANGE, GREEN, PURPLE, SKY, BLACK]
    for body, unit, colour in zip(bodies, units, colours * len(bodies), strict=False):
        label = rf"$\ell = {body.ell:.4g}$" + (
            f", bore {body.bore:.4g}" if len(bores) > 1 and body.bore == body.bore else ""
        )
        for stable, theta, rate in pieces(body, contact, rate_max / unit):
            line = ax.plot(
                unit * rate,
                np.degrees(theta),
                "-" if stable else "--",
                color=colour,
                lw=2.4 if stable else 1.8,
            )
            line[0].set_label(label if label else "_")
            label = ""
    if len(bodies) == 1:
        _shade(ax, bodies[0], contact)
    if marks or (marks is None and len(bodies) == 1):
        for body, unit in zip(bodies, units, strict=True):
            _mark(ax, [x._replace(rate=unit * x.rate) for x in landmarks(body, contact)], rate_max)
    reduced = r"reduced rotation rate  $\widetilde\Omega = \Omega\,\sqrt{I_3/(MgR)}$"
    ax.set_xlabel(HERTZ if hertz else reduced)
    ax.set_ylabel(r"inclination  $\theta$ (degrees)")
    told = title(contact, bores.pop() if len(bores) == 1 else 0.0)
    beyond = any(body.theta_end > _HALF_PI + 1e-9 for body in bodies)
    ax.set_title(f"{told}\nup to 90 degrees; the bodies may lean farther" if beyond else told)
    if len(bodies) > 1:
        ax.legend(framealpha=0.9)
    return ax


@sized
def portrait(
    data: Any = None,
    *,
    bore: float = 0.0,
    fillet: float = 0.0,
    contact: Contact | None = None,
    ax: "Axes | None" = None,
    ell_max: float = 3.0,
) -> "Axes":
    """Draw where the steady states with the centre at rest are stable, unstable or forbidden.

    The axes are the aspect ratio ell and the inclination theta.

    Parameters
    ----------
    data : xarray.Dataset, optional
        Result of `spincyl.sweep.portrait` with "region" over theta and ell. Default: computed here.
    bore, fillet : float
        Bore and fillet of all tubes, 0 to 1; only without `data`.
    contact : {"rolling", "smooth"}, optional
        Contact for the stability. Default: both. States that are stable only for rolling then have one
        colour, and states that are stable only on a smooth table have another.
    ax : matplotlib Axes, optional
        Axes to draw on. Default: new axes.
    ell_max : float
        Largest ell on the map, at its right edge: more than the fillet and at most 1000. Only without `data`.

    Returns
    -------
    Axes

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid; the message names it.
    """
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import Patch

    one_of("contact", contact, (None, "rolling", "smooth"))
    if data is None:
        bore, fillet = in_range("bore", bore, 0.0, 1.0), in_range("fillet", fillet, 0.0, 1.0)
        ell_max = in_range("ell_max", ell_max, max(0.01, 1.01 * fillet), 1e3)
        theta, ell = np.linspace(0, _HALF_PI, 701)[1:], np.linspace(fillet, ell_max, 701)
        region = Body.tube(ell, bore, fillet).region(theta[:, np.newaxis])
    else:
        theta, ell, region, bore, fillet = _mapped(data)
    ax = new_axes(ax)
    unstable, rolling, smooth, stable = (
        ("unstable", UNSTABLE),
        ("stable only when rolling", ROLLING),
        ("stable only on a smooth table", SMOOTH),
        ("stable", STABLE),
    )
    kinds = {
        None: {4: unstable, 5: rolling, 6: smooth, 7: stable},
        "smooth": {4: unstable, 5: unstable, 6: stable, 7: stable},
        "rolling": {4: unstable, 5: stable, 6: unstable, 7: stable},
    }[contact]
    named = {1: ("forbidden", FORBIDDEN), **kinds}
    shown = [named[code] for code in named if np.any(region == code)]
    colours = ["white" if code not in named else named[code][1] for code in range(8)]
    ax.imshow(
        region,
        extent=(ell[0], ell[-1], np.degrees(theta[0]), np.degrees(theta[-1])),
        origin="lower",
        aspect="auto",
        interpolation="nearest",
        cmap=ListedColormap(colours),
        norm=BoundaryNorm(np.arange(-0.5, 8.0), 8),
    )
    for colour in dict.fromkeys(colour for _, colour in shown):
        hatch(ax, np.isin(region, [code for code in named if named[code][1] == colour]), colour)
    first, last = max(float(ell[0]), 1e-3), float(ell[-1])
    near = np.geomspace(1e-9, 1e-2, 60)
    fine = Body.critical_aspect(bore, fillet) * (1 + np.concatenate([-near, near]))
    curve = np.sort(np.concatenate([np.linspace(first, last, 3000), fine[(first < fine) & (fine < last)]]))
    family = Body.tube(curve, bore, fillet)
    ax.plot(curve, np.degrees(family.theta_balance), color=BLACK, lw=1.8, label=r"$\theta_0$: balanced")
    ax.plot(
        curve,
        np.degrees(family.theta_limit),
        color=BLACK,
        lw=1.8,
        ls=":",
        label=r"$\theta_\infty$: fast limit",
    )
    curves(ax, curve, family.folds(), color=PURPLE, lw=1.8, ls="-.", label="folds")
    curves(ax, curve, family.ridge(), color=GREEN, lw=1.8, ls="--", label="energy ridge")
    lines, _ = ax.get_legend_handles_labels()
    patches = [Patch(facecolor=c, label=n, **hatching(c)) for n, c in dict.fromkeys(shown)]
    ax.legend(handles=patches + lines, loc="lower left", framealpha=0.92)
    ax.set(xlim=(ell[0], ell[-1]), ylim=(0, 90), yticks=range(0, 91, 15))
    ax.set_xlabel(r"aspect ratio  $\ell$ (half length / radius)")
    ax.set_ylabel(r"inclination  $\theta$ (degrees)")
    ax.set_title(title(contact, bore, fillet))
    return ax


@sized
def energy(*, bore: float = 0.0, ax: "Axes | None" = None, ell_max: float = 3.0) -> "Axes":
    """Draw the energy of the steady states with the centre at rest on the map of theta and ell.

    Parameters
    ----------
    bore : float
        Inner over outer radius of the tubes, 0 to 1.
    ax : matplotlib Axes, optional
        Axes to draw on. Default: new axes.
    ell_max : float
        Largest ell on the map, at its right edge: 0.01 to 1000.

    Returns
    -------
    Axes
        Contours show the energy of a steady state less that of the body balanced at rest, sqrt(1 + ell^2), in
        M g R. On the dashed ridge the energy of the steady states of one body is stationary.

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid; the message names it.
    """
    from matplotlib.colors import LogNorm

    bore, ell_max = in_range("bore", bore, 0.0, 1.0), in_range("ell_max", ell_max, 0.01, 1e3)
    ax = new_axes(ax)
    theta, ell = np.linspace(0, _HALF_PI, 801)[1:], np.linspace(1e-3, ell_max, 1601)
    body = Body.tube(ell, bore)
    level = body.energy(body.steady(theta[:, np.newaxis]))
    excess = level - np.sqrt(1 + ell**2)
    steps = np.array([0.03, 0.1, 0.2, 0.3, 0.5, 1, 2, 3, 5, 10, 20, 30])
    ax.patch.set(facecolor=FORBIDDEN, **hatching(FORBIDDEN))
    shown = np.ma.masked_invalid(np.where(excess > 0, excess, np.nan))
    filled = ax.contourf(ell, np.degrees(theta), shown, steps, cmap="viridis", norm=LogNorm(), extend="both")
    ax.contour(ell, np.degrees(theta), shown, steps, colors="white", linewidths=0.6)
    below = np.ma.masked_invalid(np.where(excess <= 0, excess, np.nan))
    if below.count():
        ax.contourf(ell, np.degrees(theta), below, 5, colors=[STABLE])
    label = "ridge: energy stationary along the branch"
    curves(ax, ell, body.ridge(), color=ORANGE, lw=2.6, ls="--", label=label)
    ax.text(0.04 * ell_max, 5, "less energy than balanced at rest")
    bar = ax.figure.colorbar(filled, ax=ax, ticks=steps)
    bar.ax.set_yticklabels([f"{x:g}" for x in steps])
    bar.set_label(r"energy above balance, $E - \sqrt{1+\ell^2}$  ($MgR$)")
    ax.set(xlim=(0, ell_max), ylim=(0, 90), yticks=range(0, 91, 15))
    ax.set_xlabel(r"aspect ratio  $\ell$ (half length / radius)")
    ax.set_ylabel(r"inclination  $\theta$ (degrees)")
    ax.set_title("energy of the steady states (grey: forbidden)")
    ax.legend(loc="upper right")
    return ax


def _ells(ells: Iterable[float | Body]) -> list[float | Body]:
    """The aspect ratios and bodies to draw; errors name the argument `ells`."""
    try:
        given = [ells] if isinstance(ells, Body) else list(ells)
    except TypeError:
        raise TypeError(f"ells: expected a list of numbers or bodies, not {type(ells).__name__}") from None
    if not given:
        raise ValueError("ells: expected at least one aspect ratio")
    if any(isinstance(x, Body) and not is_scalar(*x._numbers) for x in given):
        raise ValueError("ells: expected single bodies, not a family; give a list of bodies")
    return [x if isinstance(x, Body) else in_range(f"ells[{k}]", x, 0.0, 1e6) for k, x in enumerate(given)]


def _mapped(data: Any) -> tuple[Any, Any, Any, float, float]:
    """Inclinations, aspect ratios, regions, bore and fillet from `sweep.portrait`; else an error."""
    if not hasattr(data, "data_vars"):
        raise TypeError(f"data: expected a Dataset of sweep.portrait, not {type(data).__name__}")
    region = data.get("region")
    if region is None or region.dims != ("theta", "ell") or min(region.shape) < 2:
        found = "there is none" if region is None else f"its axes are {dict(region.sizes)}"
        raise ValueError(f'data: expected the variable "region" for at least two theta and two ell; {found}')
    bore, fillet = (number(f"data[{name!r}]", data.get(name, 0.0)) for name in ("bore", "fillet"))
    return data["theta"].values, data["ell"].values, region.values, bore, fillet


def pieces(
    body: Body, contact: Contact, rate_max: float
) -> list[tuple[bool, npt.NDArray[np.float64], npt.NDArray[np.float64]]]:
    """A branch in pieces of constant stability: (stable, theta, rate)."""
    special = np.concatenate([body.folds(), body.boundaries(contact), [body.theta_balance, body.theta_limit]])
    special = special[~np.isnan(special)]
    near = np.outer(
        special, 1 + np.concatenate([-(10.0 ** np.arange(-13, -2)), 10.0 ** np.arange(-13, -2)])
    ).ravel()
    theta = np.sort(
        np.concatenate([np.linspace(0, _HALF_PI, 6001)[1:], near[(near > 0) & (near < _HALF_PI)]])
    )
    rate = body.rate(theta)
    kind = np.where(np.isnan(rate) | (rate > 1.2 * rate_max), -1, body.stable(theta, contact))
    cuts = np.flatnonzero(np.diff(kind)) + 1
    pieces = []
    for piece in np.split(np.arange(theta.size), cuts):
        if kind[piece[0]] < 0:
            continue
        # include the first point of an adjacent next piece, so that there is no gap
        joined = (
            np.append(piece, piece[-1] + 1)
            if piece[-1] + 1 < theta.size and kind[piece[-1] + 1] >= 0
            else piece
        )
        pieces.append((bool(kind[piece[0]]), theta[joined], rate[joined]))
    if abs(body.theta_limit - body.theta_balance) < 1e-9:
        # at the critical aspect ratio every rate is steady at theta0
        rates = np.linspace(0, 1.2 * rate_max, 2001)[1:]
        w1 = body.angular_rate(rates) * np.sin(body.theta_balance)
        stable = body.stable(State(body.theta_balance, w1, 0.0, body.ell * w1), contact)
        for piece in np.split(np.arange(rates.size), np.flatnonzero(np.diff(stable)) + 1):
            pieces.append((bool(stable[piece[0]]), np.full(piece.size, body.theta_balance), rates[piece]))
    return pieces


def _shade(ax: "Axes", body: Body, contact: Contact) -> None:
    """Shade inclinations by stability: forbidden, unstable, stable."""
    edges = np.concatenate([[0, body.theta_balance, body.theta_limit, _HALF_PI], body.boundaries(contact)])
    edges = np.sort(edges[~np.isnan(edges)])
    for low, high in pairwise(edges):
        middle = 0.5 * (low + high)
        if high - low < 1e-6:
            continue
        stable = bool(body.stable(middle, contact))
        forbidden = np.isnan(body.rate(middle))
        colour, name = (
            (FORBIDDEN, "forbidden")
            if forbidden
            else (STABLE, "stable")
            if stable
            else (UNSTABLE, "unstable")
        )
        ax.axhspan(np.degrees(low), np.degrees(high), fc=colour, zorder=0, **hatching(colour))
        if high - low > np.radians(4.5):
            where = (0.93 * ax.get_xlim()[1], np.degrees(middle))
            ax.text(*where, name, ha="right", va="center", bbox={"fc": colour, "lw": 0, "pad": 1.5})


def _mark(ax: "Axes", points: list[Landmark], rate_max: float) -> None:
    theta0, limit = points[0].theta, points[2].theta
    offsets = {"A": (8, 7), "B": (8, -16), "C": (-16, 7 if limit < theta0 else -16), "D": (-16, 7)}
    offsets |= {"E": (10, 4), "F": (-17, -11), "G": (9, 4)}
    for point in points:
        inside = point.rate <= rate_max
        if not inside and point.letter not in "CD":
            continue
        where = (min(point.rate, rate_max), np.degrees(point.theta))
        ax.plot(*where, "o" if inside else ">", color=BLACK, ms=7, clip_on=False, zorder=5)
        ax.annotate(
            point.letter,
            where,
            offsets[point.letter],
            textcoords="offset points",
            fontweight="bold",
            zorder=6,
        )
