"""A tippe top that spins so fast that it hops turns over all the same."""

from itertools import groupby

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

# 30 mm wide, 10 g; it touches the table with a patch of 0.3 mm
body = sc.Body.ball(-0.2, i1=0.40, i3=0.42)
scale = sc.Scale(radius=0.015, mass=0.01)
table = sc.Coulomb.from_si(0.3, patch="0.3mm", scale=scale)
RESTITUTION = 0.3
TURNS = 43.0  # a second
t = np.linspace(0.0, 75.0, 30001)
# some hops, in seconds
NEAR = 1.5, 1.6


def spun(turns: float) -> sc.State:
    """Initial state: so many turns a second about the almost upright axis."""
    w3 = 2 * np.pi * turns * float(scale.seconds(1.0))
    return body.with_centre_velocity(sc.State(0.1, 0.0, 0.0, w3), 0.0, 0.0)


def turned(turns: float, restitution: float = RESTITUTION) -> sc.Motion:
    """Motion of a top that is spun at so many turns a second."""
    return sc.roll(body, spun(turns), t, contact=table, restitution=restitution)


def hops(motion: sc.Motion) -> int:
    """The number of hops; successive flights, a hop with its bounces, count as one."""
    kinds = (phase.kind for phase in motion.phases)
    return sum(kind == "flying" for kind, _ in groupby(kinds))


def over(motion: sc.Motion) -> float:
    """Seconds until the axis is within 8 degrees of the vertical, upside down."""
    return float(scale.seconds(motion.t[np.argmax(motion.theta > 3.0)]))


def picture() -> None:
    """Draw how far the top has turned over, and the height of its lowest point."""
    fast = turned(TURNS)
    fig = plt.figure()
    grid = fig.add_gridspec(2, 2, height_ratios=(1.2, 1), width_ratios=(1.6, 1))
    above, below = fig.add_subplot(grid[0, :]), fig.add_subplot(grid[1, 0])
    close = fig.add_subplot(grid[1, 1], sharey=below)
    seconds, low = scale.seconds(t), 1000 * scale.metres(fast.height)
    for motion, turns in ((fast, TURNS), (turned(28.0), 28.0)):
        label = f"{turns:g} turns a second"
        above.plot(seconds, np.degrees(motion.theta), label=label)
    flights = [phase.time for phase in fast.phases if phase.kind == "flying"]
    above.axvspan(
        *scale.seconds(np.array([flights[0], flights[-1]])),
        color="#0072B2",
        alpha=0.12,
        lw=0,
        label="the faster one hops",
    )
    above.set(xlim=(0, 2.9), ylabel="inclination (degrees)")
    above.set(ylim=(0, 185), yticks=range(0, 181, 60))
    above.set_title("on the table or off it, a tippe top turns over")
    above.legend(loc="lower right")
    below.axvspan(*NEAR, color="0.8", lw=0)
    for ax, where in ((below, (0.0, 2.9)), (close, NEAR)):
        ax.plot(seconds, low, lw=1 if ax is below else 2)
        ax.set(xlabel="time (s)", xlim=where)
    below.set(ylabel="lowest point (mm)", title="it hops once in every nod")
    close.set(xticks=np.linspace(*NEAR, 3), title="the grey part")


if __name__ == "__main__":
    for turns in (28.0, 37.0, TURNS, 49.0):
        motion = turned(turns)
        print(
            f"{turns:g} turns a second: turned over after {over(motion):.2f} s,",
            end=" ",
        )
        print(f"{hops(motion)} hops", end=" ")
        print(f"of up to {1000 * scale.metres(motion.height.max()):.2f} mm.")
