"""A can that falls nearly flat rises again, turned by an angle that hardly varies."""

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

body = sc.Body.solid(1.0)
start = sc.State(0.3, 1e-3, 0.0, 0.0)
t = np.linspace(0.0, 5.0, 2001)


def picture() -> None:
    """Draw the direction of its lean, from above, as it falls and rises again."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 5.4))
    for w1 in (1e-1, 1e-2, start.w1):
        motion = sc.roll(
            body, sc.State(start.theta, w1, 0.0, 0.0), t, want=("pose", "force")
        )
        lean = np.degrees(motion.theta)
        left.plot(
            lean * np.cos(motion.phi),
            lean * np.sin(motion.phi),
            label=rf"$\omega_1 = {w1:g}$ at first",
        )
        right.semilogy(motion.t, motion.normal)
    left.set(xlabel="lean along x (degrees)", ylabel="lean along y (degrees)")
    left.set(
        aspect="equal", adjustable="datalim", title="which way it leans, from above"
    )
    figure.legend(loc="outside lower center", ncols=3)
    right.set(
        xlabel=r"time ($\sqrt{R/g}$)",
        ylabel="normal force (weights)",
        title="what the table bears",
    )


if __name__ == "__main__":
    limit = np.pi * np.sqrt((body.i1 + body.ell**2 + 1) / (body.i1 + body.ell**2))
    for w1 in (1e-2, start.w1, 1e-4):
        swing = sc.swing(body, sc.State(start.theta, w1, 0.0, 0.0))
        flat, turned = np.degrees([swing.theta_min, swing.precession_per_period])
        print(f"w1 = {w1:g}: within {flat:.4f} degrees of flat its lean turns", end=" ")
        print(f"by {turned:.2f} degrees.")
    print(f"The limit for w1 = 0 is {np.degrees(limit):.2f} degrees.")
