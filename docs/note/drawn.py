"""The figures of the note."""

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from computed import (
    CYLINDER,
    DISK,
    DISK_SCALE,
    DRY,
    EDGE,
    EULER,
    PIPE_SCALE,
    START,
    flick,
    flicks,
    full,
    numbers,
)

import spincyl as sc

STYLE = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 11,
    "axes.titlesize": 11,
    "legend.fontsize": 9.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "figure.constrained_layout.use": True,
    "svg.hashsalt": "spincyl",
}
ICE, RUBBER, CENTRE, RIM = "#0072B2", "#D55E00", "#D55E00", "#0072B2"


def lettered(axes):
    """Letters for the panels of a figure."""
    for ax, letter in zip(np.ravel(axes), "abc", strict=False):
        ax.set_title(f"({letter})", loc="left", fontweight="bold")


def draw_map():
    """The angles, and the map of the two stabilities."""
    fig, axes = plt.subplots(1, 2, figsize=(7.4, 3.5), width_ratios=(1, 1.2))
    with mpl.rc_context({"font.size": 9}):
        sc.plot.frame(ax=axes[0])
    sc.plot.portrait(ax=axes[1])
    chart = axes[1]
    chart.get_legend().remove()
    for x, y, words in ((2.3, 40, "no steady state"), (2.2, 76, "stable"), (0.55, 22, "stable")):
        chart.text(x, y, words, ha="center")
    chart.annotate(
        "stable only\nwhen rolling",
        (0.62, 77),
        (1.05, 73),
        va="center",
        arrowprops={"arrowstyle": "-", "lw": 0.8},
    )
    chart.annotate(
        "unstable", (0.75, 52.6), (1.0, 63.5), va="center", arrowprops={"arrowstyle": "-", "lw": 0.8}
    )
    chart.text(2.86, 65.5, r"$\theta_\infty$", ha="center")
    chart.text(2.86, 21, r"$\theta_0$", ha="center")
    chart.text(2.3, 9.5, "energy ridge", color="tab:green", ha="center", fontsize=9)
    for ax in axes:
        ax.set_title("")
    lettered(axes)
    return fig


def draw_edge():
    """A disk on its edge, pushed equally on two tables."""
    state = DISK.steady(EDGE).kicked(-0.01)
    fig, axes = plt.subplots(1, 2, figsize=(7.4, 2.7))
    for contact, colour, words in (("smooth", ICE, "smooth table"), ("rolling", RUBBER, "rolling")):
        m = sc.roll(DISK, state, np.linspace(0, 20, 2001), contact=contact)
        seconds, away = DISK_SCALE.seconds(m.t), abs(m.theta - EDGE)
        axes[0].plot(seconds, np.degrees(m.theta), color=colour, label=words)
        if contact == "smooth":
            axes[0].plot(seconds[-1], np.degrees(m.theta[-1]), "o", color=colour, ms=5)
            axes[0].annotate(
                "the other\nrim lands",
                (seconds[-1], 89),
                (seconds[-1] + 0.12, 56),
                arrowprops={"arrowstyle": "-", "color": "0.5"},
            )
        axes[1].semilogy(seconds, np.degrees(away), color=colour)
    t = np.linspace(0, 4.2, 50)
    expected = 0.01 / numbers()["growth_expected"] * np.sinh(numbers()["growth_expected"] * t)
    axes[1].semilogy(
        DISK_SCALE.seconds(t), np.degrees(expected), "k:", label=r"linear, $\sqrt{-\kappa_\mathrm{smooth}}$"
    )
    axes[0].set(xlabel="time (s)", ylabel=r"inclination $\theta$ (degrees)", ylim=(0, 95), xlim=(0, 1.28))
    axes[1].set(xlabel="time (s)", ylabel="away from steady (degrees)", ylim=(0.01, 100), xlim=(0, 1.28))
    axes[0].legend(loc="lower right")
    axes[1].legend(loc="lower right")
    lettered(axes)
    return fig


def draw_flick():
    """One flick: the two speeds, and the path on the table."""
    _, m, v, w, _, (t, average, past) = flick()
    ends = PIPE_SCALE.seconds(m.phases[-1].time)
    fig, (speeds, table) = plt.subplots(2, 1, figsize=(7.4, 4.4), height_ratios=(2.4, 1))
    for values, mean, colour, words in (
        (v, average, CENTRE, "centre, $v$"),
        (w, past, RIM, "rim past the centre, $w$"),
    ):
        speeds.plot(PIPE_SCALE.seconds(m.t), values, color=colour, label=words)
        speeds.plot(PIPE_SCALE.seconds(t), mean, "k--", lw=1)
    speeds.plot([], [], "k--", lw=1, label="Eq. (5)")
    speeds.axvspan(0, ends, color="0.93", lw=0)
    speeds.axhline(0, color="0.6", lw=0.7)
    speeds.text(ends - 0.01, 0.3, "slips", ha="right", color="0.35")
    speeds.text(ends + 0.01, 0.8, "rolls", color="0.35")
    speeds.set(xlim=(0, 1.25), ylim=(-1, 17), xlabel="time (s)", ylabel=r"speed ($\sqrt{gR}$)")
    speeds.legend(loc="upper right")
    slips, contact, centre = m.phase == 1, PIPE_SCALE.metres(m.contact_point), PIPE_SCALE.metres(m.centre)
    table.plot(-contact[slips, 1], contact[slips, 0], color="0.6", lw=0.8, label="contact, slipping")
    table.plot(-contact[~slips, 1], contact[~slips, 0], color="tab:green", lw=1.4, label="contact, rolling")
    table.plot(-centre[:, 1], centre[:, 0], color=CENTRE, lw=2.4, label="centre")
    table.plot(-centre[0, 1], centre[0, 0], "ko", ms=5)
    table.set(aspect="equal", xlabel="along the table (m)", ylabel="across (m)")
    table.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, frameon=False)
    lettered((speeds, table))
    return fig


def draw_flicks():
    """What comes of each flick, on two tables."""
    fig, axes = plt.subplots(1, 2, figsize=(7.4, 3.1), sharey=True)
    for ax, mu in zip(axes, (0.15, 0.3), strict=True):
        rate, number, ends, when, _, _ = flicks(mu, (66, 60))
        shown = np.where(ends == sc.sweep.Status.DONE, PIPE_SCALE.seconds(when), np.nan)
        turns = PIPE_SCALE.turns(rate)
        colours = ax.pcolormesh(turns, number, shown, cmap="viridis", vmin=0, vmax=3.5, rasterized=True)
        for status, colour in ((sc.sweep.Status.SIDE, "0.6"), (sc.sweep.Status.LIFT_OFF, "#F2B083")):
            only = mpl.colors.ListedColormap([colour])
            ax.pcolormesh(turns, number, np.where(ends == status, 1.0, np.nan), cmap=only, rasterized=True)
        ax.text(20, 2.65, "hops", ha="center")
        ax.text(10, 1.5, "lies down", ha="center")
        ax.text(20, 1.35, "settles", ha="center", color="w" if mu > 0.2 else "k")
        ax.set(xlabel=r"$\omega_1$ when the finger lets go (turns/s)")
        ax.text(0.98, 0.98, rf"$\mu = {mu}$", transform=ax.transAxes, ha="right", va="top")
    axes[0].set_ylabel(r"launch number $\Lambda$")
    fig.colorbar(colours, ax=axes, label="slips for (s)", pad=0.02)
    lettered(axes)
    return fig


def draw_drifts():
    """The two drifts of a cylinder and of Euler's disk, with motions of full length beside them."""
    fig, (rates, leans) = plt.subplots(1, 2, figsize=(7.4, 3.6))
    theta = np.geomspace(START, 2e-5, 200)
    for body, line, mark, name in (
        (CYLINDER, "-", "o", r"cylinder, $\ell = 2.5$"),
        (EULER, "--", "s", "Euler's disk"),
    ):
        for centre, table, colour in (("rest", "slips", ICE), ("rolling", "rolling", RUBBER)):
            drift = sc.drift(body, START, DRY, centre=centre)
            t = drift.time(theta)
            rates.loglog(theta, drift.precession(t), line, color=colour, lw=1.3)
            _, left, lean, rate, _ = full(body, table)
            some = lean > 3e-5
            rates.loglog(lean[some][::12], rate[some][::12], mark, color=colour, ms=4, mfc="none")
            if body is CYLINDER:
                leans.loglog(drift.stops_at - t, theta, line, color=colour, lw=1.3)
                leans.loglog(left[some][::12], lean[some][::12], mark, color=colour, ms=4, mfc="none")
        rates.plot([], [], line, marker=mark, color="0.3", mfc="none", ms=4, label=name)
        rates.axhline(
            numbers()[f"rate_{'cylinder' if body is CYLINDER else 'euler'}"], color="0.6", lw=0.7, ls=":"
        )
    rates.plot([], [], color=ICE, label="centre at rest")
    rates.plot([], [], color=RUBBER, label="rolling")
    rates.invert_xaxis()
    leans.invert_xaxis()
    rates.set(xlabel=r"inclination $\theta$ (rad)", ylabel=r"rate $\Omega$ ($\sqrt{g/R}$)", ylim=(0.7, 700))
    leans.set(
        xlabel=r"time left $\tau$ ($\sqrt{R/g}$)", ylabel=r"inclination $\theta$ (rad)", xlim=(3e5, 1e-3)
    )
    leans.text(3e2, 4.5e-4, r"$\tau^{2/3}$", color=ICE)
    leans.text(2.0, 3.3e-3, r"$\tau^{1/2}$", color=RUBBER)
    rates.legend(loc="upper left")
    lettered((rates, leans))
    return fig


FIGURES = {
    "map": draw_map,
    "edge": draw_edge,
    "flick": draw_flick,
    "flicks": draw_flicks,
    "drifts": draw_drifts,
}


def figures(folder):
    """The figures, as files that the text names."""
    folder.mkdir(parents=True, exist_ok=True)
    mpl.use("agg")
    for name, draw in FIGURES.items():
        with mpl.rc_context(STYLE):
            draw().savefig(folder / f"{name}.svg", dpi=300)
        plt.close("all")
