"""A tube that is flicked too hard hops over the table, and then settles."""

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

body = sc.Body.from_metres(
    outer_diameter=0.015875, inner_diameter=0.0127, length=0.09525
)
scale = sc.Scale(radius=0.015875 / 2, mass=0.0095)
table = sc.Coulomb(0.3)
# share of its speed that an end keeps in an impact without friction
RESTITUTION = 0.5
# in M sqrt(g R): the launch number is 5.0, and 1.1 would be enough
IMPULSE = 15.0
start = sc.pressed(body, IMPULSE, np.radians(80.0), finger=0.3)
t = np.linspace(0.0, 90.0, 18001)


def picture() -> None:
    """Draw the height of both ends of the tube."""
    motion = sc.roll(body, start, t, contact=table, restitution=RESTITUTION)
    seconds = scale.seconds(motion.t)
    low = 1000 * scale.metres(motion.height)
    rises = 2 * body.ell * np.abs(np.cos(motion.theta))
    high = low + 1000 * scale.metres(rises)
    _, (above, below) = plt.subplots(
        2, 1, figsize=(9.6, 5.4), sharex=True, height_ratios=(1.5, 1)
    )
    above.plot(seconds, high, color="#0072B2")
    above.set(ylabel="upper end (mm)", title="how high its two ends are")
    below.plot(seconds, low, color="#D55E00")
    hits = [scale.seconds(impact.time) for impact in motion.impacts]
    below.plot(hits, np.zeros(len(hits)), "|", color="k", ms=12, mew=1)
    below.set(xlabel="time (s)", ylabel="lower end (mm)", xlim=(0, seconds[-1]))


if __name__ == "__main__":
    for bounces in (0.0, RESTITUTION, 0.9):
        motion = sc.roll(body, start, t, contact=table, restitution=bounces)
        last = motion.phases[-1]
        print(f"Restitution {bounces:g}: {len(motion.impacts)} impacts,", end=" ")
        print(f"hops of up to {1000 * scale.metres(motion.height.max()):.1f} mm,")
        lost = scale.joules(motion.lost_in_impacts[-1])
        heat = scale.joules(motion.dissipated[-1])
        print(f"  {1000 * lost:.1f} mJ lost in impacts and {1000 * heat:.1f} to slip;")
        print(f"  {last.kind} after {scale.seconds(last.time):.2f} s.")
