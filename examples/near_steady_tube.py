"""A tube that spins almost on its side shows about six letters that stand still, although it is pushed a little."""

import numpy as np

import spincyl as sc

body = sc.Body.tube(6.0, bore=0.8)
start = body.steady(np.radians(85)).kicked(0.05)
t = np.linspace(0.0, 20.0, 2001)

if __name__ == "__main__":
    motion = sc.roll(body, start, t, want="pose")
    shown = abs(motion.psi[-1] / motion.phi[-1])
    low, high = np.degrees([motion.theta.min(), motion.theta.max()])
    print(f"In {motion.phi[-1] / (2 * np.pi):.2f} turns it nods between {low:.2f} and {high:.2f} degrees.")
    print(
        f"A letter comes by {shown:.3f} times a turn; in the steady state {start.contact_radius:.3f} times."
    )
