"""A tippe top that rolls without slipping never turns over: only slipping lets its fast spin lift the centre of mass."""

import numpy as np

import spincyl as sc

body = sc.Body.ball(-0.3, 0.45, 0.42)
start = sc.State(0.1, 0.0, 0.0, 8.0)
t = np.linspace(0.0, 40.0, 4001)

if __name__ == "__main__":
    motion = sc.roll(body, start, t, want="force")
    low, high = np.degrees([motion.theta.min(), motion.theta.max()])
    print(
        f"With {start.w3:g} sqrt(g/R) of spin it leans between {low:.3f} and {high:.3f} degrees, and no more."
    )
    print(
        f"Rolling needs a friction coefficient of {motion.friction_coefficient.max():.3f}."
    )
