"""The figures of a lecture, as files."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._body import Body
from spincyl._contact import Contact, Coulomb, Viscous
from spincyl._input.files import path_of
from spincyl._input.numbers import flag, one_of, optional_library
from spincyl._input.progress import Progress, reporting_progress
from spincyl._roll import roll
from spincyl._state import State
from spincyl._swing import swing
from spincyl._throw import pressed
from spincyl.studio.plot._frame import frame
from spincyl.studio.plot._maps import branches, energy, pieces, portrait
from spincyl.studio.plot._motions import exposure, motion
from spincyl.studio.plot._style import BLACK, BLUE, GREEN, ORANGE, STABLE, UNSTABLE, saved, sized, title

if TYPE_CHECKING:
    from spincyl._motion import Motion
    from spincyl.studio.shape import Letter

SUFFIXES = (".png", ".pdf", ".svg")

_COUNT = 19


@sized
def figures(
    folder: str | Path,
    *,
    suffix: str = ".png",
    slides: bool = False,
    progress: Progress | bool | None = None,
) -> list[Path]:
    """Write figures for a lecture as files: the predictions of Jackson et al. (fig4 to fig8), and others.

    Parameters
    ----------
    folder : str or Path
        Folder for the files; it is created if necessary, and existing figures are replaced.
    suffix : {".png", ".pdf", ".svg"}
        Format of the files.
    slides : bool
        If true, all figures have the shape 16:9 (PNG: 1920 x 1080 pixels). If false, each figure has a shape
        that suits it.
    progress : callable or bool, optional
        Function that is called after each figure with the finished share, 0 to 1. Default: if tqdm is
        installed, a bar on a terminal or in a notebook when the work takes more than two seconds. True: a bar
        at once; False: none.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid; the message names it.
    OSError
        If a file cannot be written.
    ImportError
        Without spincyl[plot].

    Notes
    -----
    fig4 to fig8 show the steady states of Jackson et al., Am. J. Phys. 87, 85 (2019), with their stability
    on a smooth table, as in the paper, and for rolling.
    """
    folder, slides = path_of("folder", folder), flag("slides", slides)
    one_of("suffix", suffix, SUFFIXES)
    optional_library("matplotlib.pyplot", "plot")
    folder = Path(folder)
    with reporting_progress(progress, "figures") as told:
        folder.mkdir(parents=True, exist_ok=True)
        return _written(folder, suffix, slides, told)


def _written(folder: Path, suffix: str, slides: bool, progress: Progress | None) -> list[Path]:
    """Draw the figures, write them to files in a folder, and return the paths."""
    plt: Any = optional_library("matplotlib.pyplot", "plot")
    critical = float(Body.critical_aspect())
    contacts: tuple[Contact, Contact] = ("smooth", "rolling")
    pairs: dict[str, tuple[float, ...]] = {
        "fig4_cylinder": (2.5,),
        "fig5_short_cylinders": (1.5, 1.0),
        "fig6_critical": (critical,),
        "fig7_disks": (0.75, 0.375),
    }
    written = []

    def save(name: str, figure: Any) -> None:
        saved(figure, folder / f"{name}{suffix}", slide=slides)
        plt.close(figure)
        written.append(folder / f"{name}{suffix}")
        if progress:
            progress(len(written) / _COUNT)

    save("frame", frame().figure)
    for name, ells in pairs.items():
        figure, axes = plt.subplots(
            len(ells), 2, figsize=(13, 5.6 * len(ells)), layout="constrained", squeeze=False
        )
        for row, ell in zip(axes, ells, strict=True):
            for ax, contact in zip(row, contacts, strict=True):
                branches([ell], contact=contact, ax=ax)
                ax.set_title(rf"$\ell = {ell:.4g}$, {title(contact, 0.0)}")
        save(name, figure)
    figure, axes = plt.subplots(1, 2, figsize=(13, 5.8), layout="constrained")
    for ax, contact in zip(axes, contacts, strict=True):
        portrait(contact=contact, ax=ax, ell_max=2.0)
    save("fig8_map", figure)
    figure, axes = plt.subplots(1, 2, figsize=(13, 5.8), layout="constrained")
    _tubes(axes)
    save("tubes", figure)
    figure, ax = plt.subplots(figsize=(9, 6.4), layout="constrained")
    portrait(ax=ax, ell_max=2.0).set_title("where friction keeps up what a smooth table lets fall")
    save("disagreement", figure)
    figure, ax = plt.subplots(figsize=(9.5, 6.4), layout="constrained")
    energy(ax=ax, ell_max=3.0)
    save("energy", figure)
    figure, axes = plt.subplots(2, 2, figsize=(11, 10.6), layout="constrained")
    for ax, (title_, m, upper) in zip(axes.flat, _exposed(), strict=True):
        exposure(m, upper=upper, ax=ax).set_title(title_)
    save("exposure", figure)
    for name, moves in _motions().items():
        figure, axes = plt.subplots(len(moves), 3, figsize=(16, 4.6 * len(moves)), layout="constrained")
        for row, m in zip(np.atleast_2d(axes), moves, strict=True):
            motion(m, row)
        save(name, figure)
    figure, ax = plt.subplots(figsize=(12.8, 7.2), layout="constrained")
    _tippe_top(ax)
    save("tippe_top", figure)
    return written


def _motions() -> "dict[str, list[Motion]]":
    """The motions that are drawn as figures, by the name of the figure."""
    cylinder, can, coin, disk = (Body.solid(ell) for ell in (2.5, 1.0, 0.17, 0.375))
    rocking = State(0.3, 1e-3, 0.0, 0.0)
    # unstable on a smooth table, stable when rolling
    standing = disk.steady(np.radians(80)).kicked(-0.01)
    return {
        "nutation": [roll(cylinder, cylinder.steady(1.3).kicked(0.05), 20.0)],
        "friction_holds": [roll(disk, standing, 20.0), roll(disk, standing, 20.0, contact="smooth")],
        "whirr": [roll(coin, coin.steady(0.2).kicked(0.1), 6.0)],
        "rocking_can": [roll(can, rocking, swing(can, rocking).period)],
        **_slipping(),
    }


def _slipping() -> "dict[str, list[Motion]]":
    """Motions with friction: a pressed tube, a flicked coin, a hoop, Euler's disk."""
    pipe, hoop = Body.tube(6.0, 0.8), Body.tube(0.0, 0.97)
    flicked = pressed(pipe, 8.67, np.radians(60), finger=0.3)
    # nearly upright, with the velocity and backspin of the page about slip
    thrown = hoop.with_centre_velocity(State(1.5, 0.0, 0.0, -3.0), 0.0, 1.43)
    coin = Body.from_metres(outer_diameter=0.02426, length=0.00175)
    upright = coin.with_centre_velocity(State(np.pi / 2, 0.663, 0.0, 0.0), 0.663 * float(coin.i1) / 0.9, 0.0)
    euler = Body.from_metres(outer_diameter=0.0751, length=0.0128, fillet=0.002)
    held = State(1.2, 2 * np.sin(1.2), 0.0, 2 * np.cos(1.2))  # rotates about the vertical as a whole
    turned = euler.with_centre_velocity(held, 0.0, 0.0)
    return {
        "flick": [roll(pipe, flicked, 60.0, contact=Coulomb(0.3))],
        "flicked_coin": [roll(coin, upright, 20.0, contact=Coulomb(0.2))],
        "disk_slips": [roll(euler, turned, 25.0, contact=Coulomb(0.2))],
        "hoop_comes_back": [roll(hoop, thrown, 16.0, contact=Coulomb(0.4))],
    }


def _tippe_top(ax: Any) -> None:
    """Draw the inclination of a tippe top on a wet table and on a dry one, and the top as it leans."""
    top = Body.ball(-0.2, 16 / 27, 14 / 27)
    spun = top.with_centre_velocity(State(0.1, 0.0, 0.0, 7.04), 0.0, 0.0)
    t = np.linspace(0.0, 100.0, 2001)
    wet, dry = (roll(top, spun, t, contact=table).theta for table in (Viscous(0.3), Coulomb(0.3)))
    for theta, colour in ((wet, BLUE), (dry, ORANGE)):
        ax.plot(t, np.degrees(theta), color=colour, lw=2.4)
    for at, beside in (
        (10.0, (0, 52)),
        (33.0, (-56, 30)),
        (45.0, (-60, 22)),
        (58.0, (-60, 36)),
        (97.0, (0, -64)),
    ):
        _leaning(ax, at, float(np.interp(at, t, wet)), beside)
    _leaning(ax, 97.0, float(np.interp(97.0, t, dry)), (0, 52))
    ax.text(2, 53, "dot: its centre of mass", size=16)
    ax.text(60, 88, "wet table: it slips,\nand turns over", color=BLUE, size=20)
    ax.text(52, 12, "dry table: it soon rolls,\nand stays down", color=ORANGE, size=20)
    ax.set(xlim=(0, 103), ylim=(-4, 184), yticks=range(0, 181, 45))
    ax.set_title("A tippe top turns over only while it slips", size=24, pad=14)
    ax.set_xlabel(r"time  $t$ ($\sqrt{R/g}$)", size=20)
    ax.set_ylabel(r"inclination  $\theta$ (degrees)", size=20)
    ax.tick_params(labelsize=18)
    ax.spines[["top", "right"]].set_visible(False)


def _leaning(ax: Any, t: float, theta: float, beside: tuple[float, float]) -> None:
    """Draw the top of `_tippe_top` beside a point of a curve: a ball with a stem and its centre of mass."""
    from matplotlib.offsetbox import AnnotationBbox, DrawingArea
    from matplotlib.patches import Circle, Polygon

    radius, size = 26.0, 96.0
    across, along = np.array([np.cos(theta), -np.sin(theta)]), np.array([np.sin(theta), np.cos(theta)])
    middle = np.full(2, size / 2)
    corners = [(-0.13, 0.8), (0.13, 0.8), (0.13, 1.5), (-0.13, 1.5)]
    picture = DrawingArea(size, size)
    picture.add_artist(Polygon([middle + radius * (x * across + z * along) for x, z in corners], fc=BLACK))
    picture.add_artist(Circle((size / 2, size / 2), radius, fc="#F0EEE8", ec=BLACK, lw=1.8))
    right, up = middle - 0.2 * radius * along
    picture.add_artist(Circle((right, up), 3.6, fc=BLACK))
    at = t, np.degrees(theta)
    ax.plot(*at, "o", mfc="white", mec=BLACK, mew=2, ms=9)
    ax.add_artist(AnnotationBbox(picture, at, beside, boxcoords="offset points", frameon=False))


def _exposed() -> "list[tuple[str, Motion, Letter]]":
    """The motions to photograph, and the symbol on the upper end of each."""
    pipe, coin = Body.tube(6.0, 0.8), Body.solid(0.05)

    def turns(body: Body, degrees: float, count: int) -> "Motion":
        state = body.steady(np.radians(degrees))
        return roll(body, state, count * 2 * np.pi / state.precession)

    return [
        ("pressed on the end with the O: one turn at 89.5°", turns(pipe, 89.5, 1), "O"),
        ("pressed on the end with the X: one turn at 89.5°", turns(pipe, 89.5, 1), "X"),
        ("not quite whole: five turns at 87°", turns(pipe, 87.0, 5), "O"),
        ("a coin: three turns at 15°", turns(coin, 15.0, 3), "O"),
    ]


def _tubes(axes: Any) -> None:
    """Draw branches of the solid cylinder and of tubes, and the critical aspect ratio."""
    colours = [BLUE, GREEN, ORANGE]
    for bore, colour in zip((0.0, 0.8, 1.0), colours, strict=True):
        body = Body.tube(6.0, bore)
        label = rf"bore {bore:g}"
        for stable, theta, rate in pieces(body, "rolling", 3.0):
            axes[0].plot(rate, np.degrees(theta), "-" if stable else "--", color=colour, lw=2.4, label=label)
            label = "_"
        axes[0].axhline(np.degrees(body.theta_limit), color=colour, lw=1, ls=":")
    axes[0].set(xlim=(0, 3), ylim=(0, 90), yticks=range(0, 91, 15))
    axes[0].set_xlabel(r"reduced rotation rate  $\widetilde\Omega$")
    axes[0].set_ylabel(r"inclination  $\theta$ (degrees)")
    axes[0].set_title(r"tubes of $\ell = 6$, rolling (dotted: $\theta_\infty$)")
    axes[0].legend()
    bores = np.linspace(0, 1, 200)
    critical = Body.critical_aspect(bores)
    axes[1].plot(bores, critical, color=BLACK, lw=2.4)
    axes[1].fill_between(bores, critical, 1.5, color=STABLE)
    axes[1].fill_between(bores, 0.6, critical, color=UNSTABLE)
    axes[1].text(0.3, 1.25, r"cylinder: $I_1 > I_3$,  $\theta_\infty > \theta_0$")
    axes[1].text(0.42, 0.75, r"disk: $I_1 < I_3$,  $\theta_\infty < \theta_0$")
    axes[1].set(xlim=(0, 1), ylim=(0.6, 1.5))
    axes[1].set_xlabel(r"bore  $q = R_\mathrm{inner}/R$")
    axes[1].set_ylabel(r"aspect ratio  $\ell$")
    axes[1].set_title(r"critical shape  $\ell = \frac{\sqrt{3}}{2}\sqrt{1+q^2}$")
