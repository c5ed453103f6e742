"""Two balls that spin leaning nod about a state no steeper than 66 degrees."""

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

body = sc.Body.balls()
start = body.steady(np.radians(78)).kicked(0.02)
t = np.linspace(0.0, 20.0, 2001)


def picture() -> None:
    """Draw the inclination over the rate, and how the pair nods after a push."""
    scale = sc.Scale(radius=8e-3)
    _, (left, right) = plt.subplots(1, 2, figsize=(9.6, 5.4))
    theta = np.linspace(float(body.theta_limit) + 1e-3, np.pi / 2, 300)
    left.plot(
        scale.turns(body.steady(theta).precession),
        np.degrees(theta),
        label="balls of 16 mm",
    )
    left.axhline(
        np.degrees(float(body.theta_limit)), color="0.5", ls="--", label="never steeper"
    )
    left.set(xlim=(0, 60), xlabel="turns a second", ylabel="inclination (degrees)")
    left.set_title("the faster, the steeper")
    left.legend()
    motion = sc.roll(body, start, t)
    right.plot(scale.seconds(motion.t), np.degrees(motion.theta))
    right.set(
        xlabel="time (s)",
        ylabel="inclination (degrees)",
        title="pushed at 78 degrees, it nods",
    )


if __name__ == "__main__":
    scale = sc.Scale(radius=8e-3)
    lifts = scale.turns(body.steady(np.pi / 2).precession)
    print(f"One of two balls of 16 mm lifts at {lifts:.2f} turns a second.")
    print("The faster it turns, the steeper it stands,", end=" ")
    print(f"up to {np.degrees(body.theta_limit):.2f} degrees.")
    motion = sc.roll(body, start, t, want="pose")
    low, high = np.degrees([motion.theta.min(), motion.theta.max()])
    print(f"Pushed at 78 degrees, it nods between {low:.2f} and {high:.2f} degrees,")
    print(f"and spins {motion.psi[-1] / motion.phi[-1]:.4f} times for each turn.")
