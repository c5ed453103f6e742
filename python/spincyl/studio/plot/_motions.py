"""Figures of motions: inclination, path and contact force, and long-exposure photographs."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._contact import Coulomb, Viscous, contact_in_words
from spincyl._input.numbers import Floats, in_range, instance_of, number, optional_library
from spincyl._loss import losses_in_words
from spincyl._motion import Motion
from spincyl._phases import has_friction
from spincyl._scale import unit_of_output as unit_of
from spincyl._told import end_in_words
from spincyl.studio.aloft import FLIES, ON_FACE, SLIPS, aloft, goes_up, strikes
from spincyl.studio.exposure import exposure as photograph
from spincyl.studio.exposure import frame
from spincyl.studio.plot import _aloft
from spincyl.studio.plot._style import BLACK, BLUE, GREEN, ORANGE, RED, new_axes, own_ticks, sized
from spincyl.studio.poses import pace, span

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from spincyl._scale import Scale


@sized
def motion(m: "Motion", axes: "Sequence[Axes] | None" = None) -> "list[Axes]":
    """Draw a motion on three axes: inclination, path of the contact point on the table, and contact force.

    Parameters
    ----------
    m : Motion
        Motion of a body or a stone. Its pose and contact force are computed if it does not contain them. A
        motion that was computed with `step` or `tol` is drawn at its own times. Any other motion is computed
        again at times that resolve its nutation and precession, from the first time (the initial state, if
        `t` was a number) to the last. If 100,000 times are not enough, dots replace the curves.
    axes : sequence of three matplotlib Axes, optional
        Axes to draw on. Default: three new ones side by side.

    Returns
    -------
    list of Axes
        The three axes.

    Raises
    ------
    TypeError
        If `m` is not a Motion, or `axes` are not three Axes.
    ValueError
        If there is no curve to draw: the motion has no duration, or was computed with `step` or `tol` at
        fewer than two times.

    Notes
    -----
    Natural units are used. For a measured body the units are seconds, newtons (the weight if the mass is
    unknown), and millimetres (metres if R is at least 0.1 m). The time after the end of a motion is grey.

    - With a law of friction, the path is red, and the background over time is shaded, while the body slips.
    - With `restitution`, the height of the lowest point is drawn together with the inclination. Impacts are
      marked, and the times in the air and on both rims are tinted, too.
    - For a body that rolls straight at constant inclination, the distance of its centre from the first
      position is drawn instead of the inclination.
    - For a stone, the spin about the vertical is drawn together with the inclination; for one that leaves the
      table, the height of its lowest point. If a stone stays on the table and within 60 degrees of upright,
      the envelopes of both rockings are drawn: the largest angles between its longer and its shorter axis and
      the horizontal. The unit of length is the largest semi-axis.

    Examples
    --------
    >>> import spincyl as sc
    >>> body = sc.Body.solid(2.5)
    >>> axes = sc.plot.motion(sc.roll(body, body.steady(1.3).kicked(0.05), 20.0))
    >>> [ax.get_title() for ax in axes[1:]]
    ['on the table, from dot to square', 'contact force']
    """
    instance_of("m", m, Motion)
    asked, scale, (m, close) = m, m.scale, _with_close_times(m.natural)
    up = goes_up(m)
    t, (x, y), centre, normal, friction = (
        _in_plot_units(scale, name, values)
        for name, values in (
            ("t", m.t),
            ("contact_point", m.contact_point.T),
            ("centre", m.centre),
            ("normal", m.normal),
            ("friction", m.friction),
        )
    )
    if axes is None:
        plt: Any = optional_library("matplotlib.pyplot", "plot")
        _, axes = plt.subplots(1, 3, figsize=(16, 4.8), layout="constrained")
        own_ticks(*axes)
    tilt, path, force = axes
    thick: dict[str, Any] = {"lw": 1.8} if close else {"ls": "", "marker": ".", "ms": 1}
    thin = thick | {"lw": 1.4} if close else thick
    below: dict[str, Any] = {
        "loc": "upper center",
        "bbox_to_anchor": (0.5, -0.17),
        "ncols": 2,
        "markerscale": 1 if close else 8,
    }
    jumps, stands = (_aloft.breaks(m), m.phase == ON_FACE) if up else np.zeros((2, m.t.size), bool)
    x, y = np.where(stands, centre.T[:2], (x, y))
    far = _straight_distance(m)
    if far is None:
        tilt.plot(*_aloft.parted(jumps, t, np.degrees(m.theta)), color=BLUE, **thick)
        tilt.set_ylabel(r"inclination  $\theta$ (degrees)")
    else:
        tilt.plot(t, _in_plot_units(scale, "centre", far), color=BLUE, **thick)
        tilt.set_ylabel(f"distance of the centre ({_unit_label('centre', scale)})")
    how = {"rolling": "rolling", "smooth": "smooth table"}.get(contact_in_words(m.contact)) or _law(m)
    if m.losses is not None:
        how = f"{how}, {losses_in_words(m.losses, scale)}"
    if not m._nods:
        if not up:
            _spin(tilt, m, t, scale, thick)
        if not up and float(m.theta.max()) < np.pi / 3:
            _rockings(tilt, m, t, below)
        tilt.set_title(how)
    else:
        fillet = rf", $\rho = {m.body.fillet:.4g}$" if m.body.fillet else ""
        tilt.set_title(rf"{how}, $\ell = {m.body.ell:.4g}${fillet}")
    if up:
        units = _aloft.PlotUnits(
            float(_in_plot_units(scale, "t", 1.0)),
            float(_in_plot_units(scale, "centre", 1.0)),
            _unit_label("centre", scale),
        )
        _aloft.height_and_legend(tilt, m, t, units, thin)
        tilt.yaxis.label.set_color(BLUE)
    # at least one radian high, so that a constant theta does not show rounding
    low, high = tilt.get_ylim()
    if high - low < 1e-3 and far is None:
        tilt.set_ylim(low - 0.5, high + 0.5)

    if has_friction(m.contact) or up:
        slips = np.isin(m.phase, SLIPS)
        rolls = ~slips & (m.phase != FLIES)
        for mask, colour, label in ((slips, RED, "contact slips"), (rolls, BLUE, "contact rolls")):
            if mask.any():
                # include the next point, so that there is no gap between two colours
                mask = (mask | np.append(False, mask[:-1])) & ~jumps
                path.plot(*np.where(mask, [x, y], np.nan), color=colour, label=label, **thin)
    else:
        path.plot(x, y, color=BLUE, label="contact point", **thin)
    path.plot(centre[:, 0], centre[:, 1], color=ORANGE, label="centre, from above", **thin)
    if up and strikes(m):
        where = _in_plot_units(scale, "contact_point", _aloft.strikes(m))
        path.plot(*where, "x", color=BLACK, ms=6, label="impact")
    path.plot(x[0], y[0], "o", color=BLACK, ms=6)
    path.plot(x[-1], y[-1], "s", color=BLACK, ms=6)
    path.plot(*centre[-1, :2], "P", color=ORANGE, ms=7)
    path.set_aspect("equal", adjustable="datalim")
    path.set_xlabel(rf"$x$ ({_unit_label('centre', scale)})")
    path.set_ylabel(rf"$y$ ({_unit_label('centre', scale)})")
    path.set_title("on the table, from dot to square")
    path.legend(**below)

    force.plot(t, normal, color=BLUE, label=r"normal force $N$", **thick)
    dashed = thick | {"ls": "--"} if close else thick
    name = "friction" if has_friction(m.contact) else "friction demand"
    force.plot(t, friction, color=ORANGE, label=name, **dashed)
    if up and (on_both := (m.phase > FLIES) & (m.phase != ON_FACE)).any():
        other = np.where(on_both, _in_plot_units(scale, "normal", m.normal_other), np.nan)
        dotted = thick | {"ls": ":"} if close else thick
        force.plot(t, other, color=BLACK, label="$N$, other rim", **dotted)
    if up:
        _aloft.shades((tilt, force), m, float(_in_plot_units(scale, "t", 1.0)))
    elif has_friction(m.contact):
        _shade_the_slip((tilt, force), m, float(_in_plot_units(scale, "t", 1.0)))
    force.axhline(float(_in_plot_units(scale, "normal", 1.0)), color="#888888", lw=0.8, ls=":")
    if float(np.max(m.normal)) > 20:
        force.set_yscale("log")
    else:
        force.set_ylim(bottom=min(0.0, float(np.min(normal))))
    force.set_ylabel(f"force ({_unit_label('normal', scale)})")
    force.set_title("contact force")
    force.legend(**below)
    for ax in (tilt, force):
        ax.set_xlabel(rf"time  $t$ ({_unit_label('t', scale)})")
        _mark_the_end(ax, asked)
    return [tilt, path, force]


def _spin(ax: "Axes", m: Any, t: Any, scale: "Scale | None", style: dict[str, Any]) -> None:
    """Draw the spin of a stone on a second vertical axis, beside the inclination."""
    right = ax.twinx()
    right.plot(t, _in_plot_units(scale, "w", m.spin), color=ORANGE, **style)
    right.axhline(0.0, color="#888888", lw=0.8, ls=":")
    right.set_ylabel(f"spin about the vertical ({_unit_label('w', scale)})", color=ORANGE)
    ax.yaxis.label.set_color(BLUE)


def _rockings(ax: "Axes", m: Any, t: Any, legend: dict[str, Any]) -> None:
    """Draw the envelopes of both rockings: the maxima of the angle of each axis from the horizontal."""
    ax.lines[0].set_alpha(0.25)
    tilts = np.abs(90 - np.degrees(m.inclinations))
    longer = int(np.argmax(np.asarray(m.body.semi_axes)[:2]))
    for axis, name, colour in ((longer, "end to end", BLUE), (1 - longer, "side to side", GREEN)):
        x = tilts[:, axis]
        most = 1 + np.flatnonzero((x[1:-1] >= x[:-2]) & (x[1:-1] > x[2:]))
        ax.plot(t[most], x[most], color=colour, lw=1.8, label=f"rocking {name}")
    ax.legend(**legend)


def _straight_distance(m: "Motion") -> "Floats | None":
    """Distance of the centre of a body that rolls straight at constant inclination; None for others."""
    if not m._nods or np.ptp(m.theta) > 1e-6 or np.ptp(m.phi) > 1e-6:
        return None
    plan = m.centre[:, :2] - m.centre[0, :2]
    away = np.hypot(*plan.T)
    if away.max() < 1e-6:
        return None
    # along the initial direction
    first = plan[np.argmax(away > 1e-3 * away.max())]
    found: Floats = plan @ (first / np.hypot(*first))
    return found


_MOST = 100_000


def _with_close_times(m: "Motion") -> "tuple[Motion, bool]":
    """The motion with all drawn outputs, and whether its times are close enough for curves."""
    asked = m._asked
    if has_friction(m.contact) or m.losses is not None:
        asked = asked._replace(tol=None)  # the default tolerance, unlike a given one, does not fix the times
    if asked.step is not None or asked.tol is not None:
        if m.t.size < 2:
            many = f"{m.t.size} time{'' if m.t.size == 1 else 's'}"
            raise ValueError(
                f"m: expected at least two times, not {many}; give roll more times, t=np.linspace(0, 20, 999)"
            )
        return m.wanting("pose", "force"), True
    first, last = span(m)
    m = m.wanting("pose", "force")
    period = pace(m)
    share = np.linspace(0, 1, int(min(1001 + 40 * abs(last - first) / period, _MOST)))
    up = aloft(m, first, last) if goes_up(m) else None
    if up is not None:  # both sides of each kink
        share = np.union1d(share, (up.edges - first) / (last - first))
    if not m._nods:  # integrated again for other times
        return m.at(first + share * (last - first)), True
    while share.size < _MOST:
        there = m.at(first + share * (last - first))
        theta, phi = there.theta, there.phi
        if up is not None:
            theta, phi, _ = up.from_first(there.t, theta, phi, there.psi).T
        turns = np.maximum(np.abs(np.diff(theta)) / 0.02, np.abs(np.diff(phi)) / 0.1)
        apart = np.diff(share)
        turns[apart[: turns.size] <= 1e-12] = 0
        if turns.max(initial=0) <= 1:
            return there, True
        # as many parts at once as the turns in each interval ask for: each round computes the motion again
        parts = np.ones(apart.size, dtype=int)
        parts[: turns.size] = np.where(turns > 1, np.clip(np.ceil(1.5 * turns), 2, 256), 1)
        within = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
        share = np.append(np.repeat(share[:-1], parts) + np.repeat(apart / parts, parts) * within, 1.0)
    # times that are out of step with any nutation, so that the dots show its whole range
    share = (np.arange(_MOST) + np.arange(_MOST) * 0.618034 % 1) / _MOST
    return m.at(first + share * (last - first)), False


def _in_plot_units(scale: "Scale | None", name: str, values: Any) -> Any:
    """Convert an output of a motion to the units of the plot."""
    factor, _ = _unit(name, scale)
    return values if factor is None else values * factor


def _unit(name: str, scale: "Scale | None") -> tuple[float | None, str]:
    """Factor and unit of an output in a plot; lengths of small bodies are in millimetres."""
    factor, said = unit_of(name, scale)
    small = factor is not None and said == "m" and factor < 0.1
    return (1e3 * factor, "mm") if factor is not None and small else (factor, said)


def _unit_label(name: str, scale: "Scale | None") -> str:
    """The unit of an output, for a label."""
    said = _unit(name, scale)[1]
    known = {"sqrt(R/g)": r"$\sqrt{R/g}$", "sqrt(g/R)": r"$\sqrt{g/R}$", "R": "$R$", "M g": "$Mg$"}
    return known.get(said, said)


def _law(m: "Motion") -> str:
    """The contact with the table as text, for the title of a figure."""
    if isinstance(m.contact, Viscous):
        return rf"viscous, $c = {m.contact.c:.4g}$"
    mu, static, _ = m.contact._numbers if isinstance(m.contact, Coulomb) else (0.0, 0.0, 0.0)
    return rf"$\mu = {mu:.4g}$" + ("" if static == mu else rf", $\mu_s = {static:.4g}$")


def _shade_the_slip(axes: "Sequence[Axes]", m: "Motion", second: float) -> None:
    """Tint the times at which the body slips; `second` is the unit of time of the axes."""
    ends = [phase.time for phase in m.phases[1:]] + [float(m.t[-1])]
    for phase, end in zip(m.phases, ends, strict=True):
        if phase.kind == "slipping":
            for ax in axes:
                begin = max(phase.time, float(m.t[0]))
                ax.axvspan(begin * second, end * second, color=RED, alpha=0.1, lw=0, zorder=0)


def _mark_the_end(ax: "Axes", m: "Motion") -> None:
    """Shade the time after the end of the motion, with a note on how it ended."""
    if m.event is None:
        return
    end, last = m.event.time, m._asked.times[-1]
    ax.axvspan(end, last, color="#DDDDDD", lw=0, zorder=0)
    ax.axvline(end, color="#888888", lw=1)
    unit = "" if m.scale is None else " s"
    ax.set_title(f"{ax.get_title()}\nended: it {end_in_words(m)}, $t = {end:.4g}${unit}")


@sized
def exposure(
    m: "Motion",
    seconds: float | None = None,
    *,
    ax: "Axes | None" = None,
    gamma: float = 0.8,
    **how: Any,
) -> "Axes":
    """Draw the long-exposure photograph of a motion from above, as the eye sees the motion.

    Parameters
    ----------
    m : Motion
        Motion of a single body.
    seconds : float, optional
        Duration of the exposure, as in `spincyl.exposure`.
    ax : matplotlib Axes, optional
        Axes to draw on. Default: new axes.
    gamma : float
        Exponent of the brightness, 0.01 to 100; a smaller value shows faint parts better.
    **how
        `scale`, `upper`, `size`, `samples` and `width`, as in `spincyl.exposure`.

    Returns
    -------
    Axes
        Axes in units of R; for a measured body in millimetres (metres if R is at least 0.1 m). The origin is
        the middle of the path of the centre.

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid, as in `spincyl.exposure`; the message names it.

    Examples
    --------
    >>> import spincyl as sc
    >>> coin = sc.Body.solid(0.05)
    >>> sc.plot.exposure(sc.roll(coin, coin.steady(0.3), 5.0), samples=1e5).get_xlabel()
    '$x$ ($R$)'
    """
    instance_of("m", m, Motion)
    gamma = in_range("gamma", gamma, 0.01, 100.0)
    width = how.pop("width", None)
    width = None if width is None else number("width", width)
    half = (frame(m, seconds, how.get("scale")) if width is None else width) / 2
    light = photograph(m, seconds, width=2 * half, **how)
    ax = new_axes(ax)
    brightest = np.percentile(light[light > 0], 99.7) if light.any() else 1.0
    half *= float(_in_plot_units(m.scale, "centre", 1.0)) / (1.0 if m.scale is None else m.scale.radius)
    ax.imshow(
        np.clip(light / brightest, 0, 1) ** gamma,
        cmap="gray",
        vmin=0,
        vmax=1,
        extent=(-half, half, -half, half),
    )
    ax.set_xlabel(f"$x$ ({_unit_label('centre', m.scale)})")
    ax.set_ylabel(f"$y$ ({_unit_label('centre', m.scale)})")
    return ax
