"""Euler's disk nods about an inclination of 17 degrees while its contact point runs round the rounded rim, faster than its face turns."""

import numpy as np

import spincyl as sc

body = sc.Body.from_metres(outer_diameter=0.0751, length=0.0128, fillet=0.002)
start = body.steady(0.3).kicked(0.05)
t = np.linspace(0.0, 20.0, 2001)

if __name__ == "__main__":
    scale = sc.Scale(radius=0.0751 / 2, mass=0.44)
    motion = sc.roll(body, start, t, want="pose")
    second = scale.seconds(motion.t[-1])
    contact, face = (
        motion.phi[-1] / (2 * np.pi),
        (motion.phi[-1] + motion.psi[-1]) / (2 * np.pi),
    )
    print(
        f"In {second:.3f} s the contact point runs round {contact:.2f} times, the face {face:.2f} times."
    )
    print(
        f"It nods between {np.degrees(motion.theta.min()):.2f} and {np.degrees(motion.theta.max()):.2f} degrees."
    )
