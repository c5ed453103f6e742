"""A hard-boiled egg that is spun fast on its side rises until it rolls on its end."""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import spincyl as sc

Floats = NDArray[np.float64]


def lying(turns: float) -> sc.EllipsoidState:
    """Initial state: axis five degrees from level, so many turns a second."""
    lean = np.radians(85)
    up = np.array([-np.sin(lean), 0.0, np.cos(lean)])
    spin = 2 * np.pi * turns * second
    # the lowest point is not below the centre, and runs round
    contact = -squares * up / np.sqrt(squares @ up**2)
    return sc.EllipsoidState(
        up, spin * up, slip=(0.0, spin * float(np.cross(up, contact)[1]))
    )


def jellett(motion: sc.EllipsoidMotion) -> Floats:
    """Jellett's number over its first value: L.(C - P), contact P to centre C.

    No force at the contact can change it. In a ball it is a constant, in an egg that
    spins fast nearly one.
    """
    towards = squares * motion.vertical / np.sqrt(motion.vertical**2 @ squares)[:, None]
    number = ((motion.w @ np.asarray(body.inertia)) * towards).sum(axis=1)
    beside: Floats = number / number[0]
    return beside


def standing() -> float:
    """Spin of the standing egg over that of the lying one, for one Jellett's number.

    Lying, its centre of mass is at the height b, standing at 1: b I1 spin = I3 spin.
    """
    i1, _, i3 = np.diag(body.inertia)
    return float(np.sqrt(squares[0]) * i1 / i3)


def least() -> float:
    """Least turns a second to stand: (I1 - I3 standing^2) spin^2 = 2 (1 - b)."""
    i1, _, i3 = np.diag(body.inertia)
    return float(
        np.sqrt(2 * (1 - np.sqrt(squares[0])) / (i1 - i3 * standing() ** 2))
        / (2 * np.pi * second)
    )


# 57 mm long, 44 mm wide, 60 g
scale = sc.Scale(radius=0.0285, mass=0.06)
body = sc.Ellipsoid.egg(0.022, 0.0285).in_metres(0.06)
second, squares = float(scale.seconds(1.0)), np.asarray(body.semi_axes) ** 2
table = sc.Coulomb(0.1)
TURNS = 18.0  # a second
start = lying(TURNS)
t = np.linspace(0.0, 3.0, 3001)


def picture() -> None:
    """Draw inclination, Jellett's number (nearly constant) and lost energy."""
    motion = sc.roll(body, start, t, contact=table)
    first = motion.energy[0]
    _, (left, right) = plt.subplots(1, 2, figsize=(9.6, 5.4))
    left.plot(motion.t, np.degrees(motion.theta))
    right.plot(motion.t, motion.spin / motion.spin[0], label="spin")
    right.plot(motion.t, jellett(motion), label="Jellett's number")
    right.plot(motion.t, motion.energy / first, label="energy")
    right.plot(
        motion.t,
        (motion.energy + motion.dissipated) / first,
        "k--",
        lw=1,
        label="energy and heat",
    )
    for ax in (left, right):
        ax.axvspan(
            0,
            motion.phases[-1].time,
            color="#B2182B",
            alpha=0.12,
            lw=0,
            label="it slips",
        )
        ax.set(xlabel="time (s)", xlim=(0, t[-1]))
    left.set(
        ylabel="inclination of its axis (degrees)", ylim=(0, 90), title="it stands up"
    )
    right.set(
        ylabel="over that of the start",
        ylim=(0.84, 1.06),
        title="what it keeps and loses",
    )
    left.legend()
    right.legend(handles=right.lines, loc="center right", bbox_to_anchor=(1.0, 0.42))


if __name__ == "__main__":
    motion = sc.roll(body, start, t, contact=table)
    rolls, energy = motion.phases[-1], motion.energy + motion.dissipated
    lean = np.degrees(motion.theta[motion.t > rolls.time])
    print(f"Spun {TURNS:g} times a second on its side,", end=" ")
    print(f"it slips for {rolls.time:.3f} s and rises.")
    low, high = lean.min(), lean.max()
    print(f"Then it rolls on its end, {low:.1f} to {high:.1f} degrees from upright.")
    print(
        f"Jellett's number has grown by {100 * (jellett(motion)[-1] - 1):.2f} per cent."
    )
    faster = motion.spin[-1] / motion.spin[0]
    print(f"It spins {faster:.3f} times as fast;", end=" ")
    print(f"a constant number would give {standing():.3f}.")
    first, heat = 1e3 * motion.energy[0], 1e3 * motion.dissipated[-1]
    print(f"Of {first:.1f} mJ it has lost {heat:.1f} mJ as heat,")
    print(f"and the sum of both is constant: {np.ptp(energy) < 1e-9 * energy[0]}")
    print(f"Below {least():.1f} turns a second it would not have the energy to stand.")
    for turns in (10.0, 13.0, 16.0, 22.0):
        other = sc.roll(body, lying(turns), t, contact=table)
        lean = np.degrees(other.theta[other.t > 2.5])
        rolls = other.phases[-1]
        print(f"Spun {turns:g} times, it rolls from {rolls.time:.3f} s on,", end=" ")
        print(f"at {lean.mean():.1f} degrees.")
