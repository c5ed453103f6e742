"""The side spin of a billiard ball outlasts its rolling on a small patch of contact."""

from dataclasses import replace
from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import spincyl as sc

Floats = NDArray[np.float64]


class Shot(NamedTuple):
    """Motion of a shot until the ball rests, and the times of its stages, in SI."""

    motion: sc.Motion
    slides: float  # time when the slip is as fast as the rim of the patch, k = 1
    stands: float  # time when the centre stops
    ends: float  # time when the spin ends


def shot(patch: float) -> Shot:
    """Compute the shot with a patch of this radius in metres."""
    contact = sc.Coulomb.from_si(MU, patch=patch, scale=body)
    motion = sc.roll(body, start, t, contact=contact, losses=losses)
    assert motion.event is not None
    last = int(np.argmax(motion.creep < 1)) + 1
    still = speed(motion) < 1e-4
    return Shot(
        motion,
        slides=float(np.interp(-1, -motion.creep[:last], motion.t[:last])),
        # slower than 0.1 mm/s, and the ball may spin on
        stands=float(motion.t[still][0]) if still.any() else motion.event.time,
        # the last phase begins where the patch neither slips nor drills
        ends=motion.phases[-1].time,
    )


def speed(motion: sc.Motion) -> Floats:
    """Speed of the centre in m/s."""
    centre = body.centre_velocity(motion.states)
    found: Floats = scale.metres_per_second(np.hypot(*centre))
    return found


def creep() -> float:
    """The number k: slip over the speed of the rim of the patch, while the ball creeps.

    Rolling resistance needs the force (5/7) (DELTA/R) M g, and a slow slip of the patch
    gives (3 pi/8) k MU M g.
    """
    return 5 / 7 * DELTA / scale.radius / (3 * np.pi / 8 * MU)


def lasts(spin: float, patch: float) -> float:
    """Time in s in which the couple of drilling friction alone stops a spin."""
    couple = 3 * np.pi / 16 * MU * scale.gravity * patch
    return 0.4 * scale.radius**2 * spin / couple


# 57 mm across and 170 g; rolling resistance acts at an arm of DELTA
scale = sc.Scale(radius=0.0286, mass=0.17)
body = replace(sc.Body.ball(0.0, 0.4, 0.4), scale=scale)
MU, DELTA = 0.2, 0.01 * scale.radius
losses = sc.loss.RollingResistance.from_si(DELTA, scale=body)
VELOCITY, SIDE = 2.0, 60.0  # m/s, without roll; rad/s about the vertical
start = replace(sc.thrown(body, VELOCITY, 0.0), w1=SIDE * scale.seconds(1.0))
t = np.linspace(0.0, 36.0, 36001)
SMALL, WIDE = 0.5e-3, 2e-3  # radii of the patch in metres


def picture() -> None:
    """Draw speed and spin while the ball slides, and until the spin ends."""
    _, axes = plt.subplots(2, 2, sharex="col", sharey="row", width_ratios=(1, 2.2))
    for patch, style in ((SMALL, "-"), (WIDE, "--")):
        found = shot(patch)
        time, spins = found.motion.t, found.motion.drilling
        speeds = speed(found.motion)
        for (above, below), until in zip(axes.T, (0.6, 36.0), strict=True):
            shown = time < 1.02 * until
            above.plot(time[shown], speeds[shown], style)
            below.plot(time[shown], spins[shown], style, label=f"{1e3 * patch:g} mm")
    for ax in axes[:, 0]:
        ax.axvspan(0, found.slides, color="#B2182B", alpha=0.12, lw=0)
    for ax in axes[:, 1]:
        ax.axvline(found.stands, color="0.4", ls=":", lw=1.5)
    axes[0, 0].set(ylabel="speed (m/s)", title="it slides")
    axes[0, 1].set(title="it creeps, stands, and spins on")
    axes[1, 0].set(ylabel="spin (rad/s)", ylim=(-2, 63))
    axes[1, 0].set(xlabel="time (s)", xlim=(0, 0.6), xticks=(0, 0.2, 0.4))
    axes[1, 1].set(xlabel="time (s)", xlim=(0, 36))
    axes[0, 1].text(found.stands + 0.6, 1.2, "its centre stands")
    axes[1, 1].legend(title="patch of", loc="upper right")


if __name__ == "__main__":
    for patch in (SMALL, WIDE):
        found = shot(patch)
        motion, spin = found.motion, found.motion.drilling
        first, later, stands, last = np.searchsorted(
            motion.t, (found.slides, found.slides + 1.0, found.stands, found.ends)
        )
        print(f"A patch of {1e3 * patch:g} mm: it slides for {found.slides:.3f} s,")
        print(f"  to {speed(motion)[first]:.2f} m/s and {spin[first]:.1f} rad/s, and")
        print(
            f"  creeps at k = {motion.creep[later]:.4f} (closed form: {creep():.4f})."
        )
        if found.ends > found.stands:
            rest, closed = found.ends - found.stands, lasts(spin[stands], patch)
            print(f"  Its centre stops after {found.stands:.1f} s,", end=" ")
            print(f"but it spins at {spin[stands]:.1f} rad/s")
            print(f"  for another {rest:.1f} s (closed form: {closed:.1f} s).")
        else:
            rolling = speed(motion)[last]
            print(f"  Its spin ends after {found.ends:.1f} s,", end=" ")
            print(f"when it rolls at {rolling:.1f} m/s,")
            print(f"  and its centre stops after {found.stands:.1f} s.")
