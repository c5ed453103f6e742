"""A tube that spins almost on its side shows about six still symbols."""

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

body = sc.Body.tube(6.0, bore=0.8)
start = body.steady(np.radians(85)).kicked(0.05)
t = np.linspace(0.0, 20.0, 2001)


def picture() -> None:
    """Draw two photographs of the pushed tube from above: a moment, and one turn."""
    turn = 2 * np.pi / float(start.precession)
    _, (left, right) = plt.subplots(1, 2, figsize=(9.6, 5.4), facecolor="black")
    for ax, share, title in (
        (left, 0.02, "a fiftieth of a turn: one sharp O"),
        (right, 1.0, "one turn: about six sharp O's"),
    ):
        moved = sc.roll(body, start, share * turn)
        how = {"size": 800, "samples": 2e7, "gamma": 0.6, "width": 13.0}
        sc.plot.exposure(moved, ax=ax, **how)
        ax.set_title(title, color="white")
        ax.set_axis_off()
    # the tube itself, which the photographs leave dark, as it lies at the first moment
    across, along = (-6.0, 6.0, 6.0, -6.0, -6.0), (-1.0, -1.0, 1.0, 1.0, -1.0)
    left.plot(across, along, "--", color="0.6", lw=1.5)
    for x, y, words in ((0.0, 0.0, "the tube"), (4.6, -1.8, "its X, smeared")):
        left.text(x, y, words, color="0.8", ha="center", va="center")


if __name__ == "__main__":
    motion = sc.roll(body, start, t, want="pose")
    shown = abs(motion.psi[-1] / motion.phi[-1])
    low, high = np.degrees([motion.theta.min(), motion.theta.max()])
    turns, steady = motion.phi[-1] / (2 * np.pi), start.contact_radius
    print(f"In {turns:.2f} turns it nods between {low:.2f} and {high:.2f} degrees.")
    print(f"A symbol passes {shown:.3f} times a turn;", end=" ")
    print(f"in the steady state {steady:.3f} times.")
