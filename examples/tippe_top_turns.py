"""A tippe top turns over on a wet table, and on a dry one with a patch of contact."""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import spincyl as sc

Floats = NDArray[np.float64]


def jellett(motion: sc.Motion) -> Floats:
    """Jellett's number, L.(C - P), from the contact P to the centre of mass C.

    L.(C - P) = I1 w1 sin(theta) + I3 w3 (ell + cos(theta)): a force at P cannot change
    it, whatever the law of friction. The couple of a patch takes some of it.
    """
    sin, cos = np.sin(motion.theta), np.cos(motion.theta)
    number: Floats = body.i1 * motion.w[:, 0] * sin + body.i3 * motion.w[:, 2] * (
        body.ell + cos
    )
    return number


def kept(motion: sc.Motion, last: int) -> str:
    """Text with Jellett's number at the first time and in row `last`."""
    number = jellett(motion)
    return f"{number[0]:.6f}, then {number[last]:.6f}"


# the top of Leine and Glocker, Eur. J. Mech. A 22, 193 (2003), without its stem:
# 15 mm, 6 g, 180 rad/s
scale = sc.Scale(radius=0.015, mass=0.006, gravity=9.81)
unit = scale.mass * scale.radius**2
body = sc.Body.ball(-0.003 / scale.radius, 8e-7 / unit, 7e-7 / unit)
wet, dry = sc.Viscous(0.3), sc.Coulomb(0.3)
patch = sc.Coulomb.from_si(0.3, patch="0.3mm", scale=scale)
table = wet
spun = sc.State(0.1, 0.0, 0.0, 180 * float(scale.seconds(1.0)))
start = body.with_centre_velocity(spun, 0.0, 0.0)
t = np.linspace(0.0, 400.0, 4001)


def picture() -> None:
    """Draw the inclination on the three tables."""
    for contact, label in (
        (wet, "wet table"),
        (patch, "dry table, a patch of 0.3 mm"),
        (dry, "dry table, a point"),
    ):
        motion = sc.roll(body, start, t, contact=contact)
        plt.plot(scale.seconds(motion.t), np.degrees(motion.theta), lw=1.5, label=label)
    plt.axhline(180, color="0.5", ls="--", lw=1)
    plt.xlim(0, 8)
    plt.yticks(range(0, 181, 45))
    plt.xlabel("time (s)")
    plt.ylabel("inclination of its axis (degrees)")
    plt.title("a tippe top turns over where it slips for long")
    plt.legend(loc="center right")


if __name__ == "__main__":
    for name, contact in (("Wet", wet), ("A patch of 0.3 mm", patch)):
        over = sc.roll(body, start, t, contact=contact)
        level, head = (int(np.argmax(over.theta > lean)) for lean in (np.pi / 2, 3.0))
        print(f"{name}: inclined by 90 degrees after {scale.seconds(t[level]):.2f} s,")
        print(f"by 172 degrees after {scale.seconds(t[head]):.2f} s;", end=" ")
        print(f"Jellett's number: {kept(over, head)}.")
    # Dry friction at a point does not weaken with the slip, so that it stops the rim at
    # once. A top that rolls keeps its energy and two more constants (see tippe_top.py):
    # it needs little friction and stays where it is.
    stuck = sc.roll(body, start, t, contact=dry, want="force")
    rolls = stuck.phases[-1]
    rolling = stuck.t >= rolls.time
    first, most = np.degrees([rolls.state.theta, stuck.theta[rolling].max()])
    needs = stuck.friction_coefficient[rolling].max()
    print(f"A point: rolling from {scale.seconds(rolls.time):.5f} s on,", end=" ")
    print(f"inclined by {first:.2f} degrees,")
    print(f"later by at most {most:.2f} degrees, since rolling needs a coefficient")
    print(f"of friction of at most {needs:.4f}, and mu is {dry.mu:g}.")
    print(f"Jellett's number: {kept(stuck, -1)}.")
