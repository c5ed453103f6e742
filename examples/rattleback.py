"""A rattleback spun clockwise soon turns back, and spun the other way much later."""

from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import spincyl as sc

Floats = NDArray[np.float64]


class Law(NamedTuple):
    """The rocking that grows at a spin, from the linear equations, in SI."""

    axis: int  # of the stone, which it tilts
    growth: float  # per second
    hertz: float


def law(spin: float) -> Law:
    """The mode that grows at a spin: the slow one tilts axis 2, the fast one axis 1."""
    rocking = body.rocking(spin * second)
    mode = int(np.argmax(rocking.growth))
    return Law(
        1 - mode,
        rocking.growth[mode] / second,
        rocking.frequency[mode] / (2 * np.pi * second),
    )


def spun(spin: float) -> sc.EllipsoidState:
    """Initial state: spinning, tilted by a fiftieth of a degree about both axes."""
    push = np.radians(0.02)
    return body.spinning(spin * second, pitch=push, roll=push)


def swings(motion: sc.EllipsoidMotion, axis: int) -> tuple[Floats, Floats]:
    """Times at which an axis is farthest from level, and its angles in degrees."""
    angle = np.abs(90 - np.degrees(motion.inclinations[:, axis]))
    most = 1 + np.flatnonzero((angle[1:-1] >= angle[:-2]) & (angle[1:-1] > angle[2:]))
    return motion.t[most], angle[most]


def grows(motion: sc.EllipsoidMotion, axis: int) -> float:
    """Growth rate of an axis's swings, from 0.3 s until 0.1 % of the spin is lost."""
    times, angle = swings(motion, axis)
    early = (times > 0.3) & (
        times < motion.t[np.argmax(np.abs(motion.spin) < 0.999 * SPIN)]
    )
    return float(np.polyfit(times[early], np.log(angle[early]), 1)[0])


# the lower half of a uniform ellipsoid, 14 cm long, whose axes of inertia are turned
# by two degrees
scale = sc.Scale(radius=0.07)
body = sc.Ellipsoid.rattleback(
    semi_axes=(0.07, 0.014, 0.012), twist=np.radians(2)
).in_metres()
second = float(scale.seconds(1.0))
SPIN = 5.0  # radians per second
start = spun(-SPIN)
t = np.linspace(0.0, 20.0, 8001)
WAYS = (("clockwise", -SPIN, "#0072B2"), ("counterclockwise", SPIN, "#D55E00"))
ROCKING = ("end to end", "side to side")


def picture() -> None:
    """Draw the spin for both directions, and the rocking with its growth rate."""
    _, (left, right) = plt.subplots(1, 2, figsize=(9.6, 5.4))
    for way, spin, colour in WAYS:
        motion, rocking = sc.roll(body, spun(spin), t), law(spin)
        left.plot(motion.t, motion.spin, color=colour)
        left.text(0.2, 1.08 * spin, f"spun {way}", color=colour, va="center")
        times, angle = swings(motion, rocking.axis)
        right.semilogy(times, angle, color=colour)
        right.text(
            *((4.4, 0.35), (12.0, 46.0))[rocking.axis],
            ROCKING[rocking.axis],
            color=colour,
        )
        # through the swing of a fifth of a degree, with the slope of the eigenvalue
        first = int(np.argmax(angle > 0.2))
        size = np.array([0.01, 80.0])
        right.plot(
            times[first] + np.log(size / angle[first]) / rocking.growth,
            size,
            "k--",
            lw=1,
        )
    right.plot([], [], "k--", lw=1, label="by the eigenvalue")
    left.axhline(0, color="0.5", lw=0.8)
    left.set(
        xlabel="time (s)", ylabel="spin (rad/s)", ylim=(-6, 6), title="it turns back"
    )
    right.set(
        xlabel="time (s)",
        ylabel="swing of its rocking (degrees)",
        title="because its rocking grows",
    )
    right.set(xlim=left.get_xlim(), ylim=(0.015, 300))
    for ax in (left, right):
        ax.set_xticks(range(0, 21, 5))
    right.legend(loc="upper right")


if __name__ == "__main__":
    for way, spin, _ in WAYS:
        motion, rocking = sc.roll(body, spun(spin), t), law(spin)
        times, angle = swings(motion, rocking.axis)
        turns = motion.t[np.argmax(motion.spin * spin < 0)]
        growth, most = grows(motion, rocking.axis), angle.max()
        fastest = np.abs(motion.spin[motion.t > turns]).max()
        print(f"Spun {way}, it rocks from {ROCKING[rocking.axis]}", end=" ")
        print(f"{rocking.hertz:.2f} times a second.")
        print(f"  The eigenvalue: {rocking.growth:.3f} per second,", end=" ")
        print(f"the motion: {growth:.3f}.")
        print(
            f"  It turns back after {turns:.2f} s, when it rocks by {most:.1f} degrees,"
        )
        print(f"  and then spins at {fastest:.4f} rad/s the other way.")
    # at rest, and tilted
    for pitch, roll, name in ((1, 0, "end"), (0, 5, "side")):
        state = body.spinning(0.0, pitch=np.radians(pitch), roll=np.radians(roll))
        spin = sc.roll(body, state, t[t < 2]).spin.mean()
        way = "counterclockwise" if spin > 0 else "clockwise"
        print(f"Pressed down at the {name} and released, it begins to spin {way}.")
