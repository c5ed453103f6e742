"""A cylinder that is pushed out of its steady state nods about it, and returns after every period."""

import numpy as np

import spincyl as sc

body = sc.Body.solid(2.5)
start = body.steady(1.3).kicked(0.05)
t = np.linspace(0.0, 20.0, 2001)

if __name__ == "__main__":
    motion, swing = sc.roll(body, start, t, want="force"), sc.swing(body, start)
    low, high = np.degrees([motion.theta.min(), motion.theta.max()])
    print(
        f"It nods between {low:.2f} and {high:.2f} degrees, {t[-1] / swing.period:.2f} times in {t[-1]:g} sqrt(R/g)."
    )
    print(
        f"A small nutation has the period {2 * np.pi / body.nutation(1.3):.4f}, this one {swing.period:.4f}."
    )
    print(
        f"The normal force is {motion.normal.min():.3f} to {motion.normal.max():.3f} of the weight."
    )
