"""A tube that spins almost on its side shows about six still symbols."""

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

body = sc.Body.tube(6.0, bore=0.8)
start = body.steady(np.radians(85)).kicked(0.05)
t = np.linspace(0.0, 20.0, 2001)


def picture() -> None:
    """Draw two photographs from above, each of one turn: steady, and pushed."""
    turn = 2 * np.pi / float(start.precession)
    _, (left, right) = plt.subplots(1, 2, figsize=(9.6, 5.4), facecolor="black")
    states = (
        (left, body.steady(start.theta), "the steady state"),
        (right, start, "pushed, it nods"),
    )
    for ax, state, title in states:
        sc.plot.exposure(
            sc.roll(body, state, turn), ax=ax, size=800, samples=2e7, gamma=0.6
        )
        ax.set_title(title, color="white")
        ax.set_axis_off()


if __name__ == "__main__":
    motion = sc.roll(body, start, t, want="pose")
    shown = abs(motion.psi[-1] / motion.phi[-1])
    low, high = np.degrees([motion.theta.min(), motion.theta.max()])
    turns, steady = motion.phi[-1] / (2 * np.pi), start.contact_radius
    print(f"In {turns:.2f} turns it nods between {low:.2f} and {high:.2f} degrees.")
    print(f"A symbol passes {shown:.3f} times a turn;", end=" ")
    print(f"in the steady state {steady:.3f} times.")
