"""The edge of Euler's disk, tilted and turned about the vertical by hand, slides round a circle, and the disk rolls after a quarter of a second."""

import numpy as np

import spincyl as sc


def turned(theta: float, rate: float) -> sc.State:
    """Initial state: inclined by theta, turning about the vertical at `rate` (sqrt(g/R)), centre at rest."""
    held = sc.State(theta, rate * np.sin(theta), 0.0, rate * np.cos(theta))
    return body.with_centre_velocity(held, 0.0, 0.0)


body = sc.Body.from_metres(outer_diameter=0.0751, length=0.0128, fillet=0.002)
scale = sc.Scale(radius=0.0751 / 2, mass=0.44)
table = sc.Coulomb(0.2)
start = turned(1.2, 2.0)
t = np.linspace(0.0, 60.0, 3001)

if __name__ == "__main__":
    motion = sc.roll(body, start, t, contact=table, want=("pose", "force"))
    rolls = motion.phases[-1]
    slips = motion.t < rolls.time
    print(
        f"Turned {scale.turns(2.0):.2f} times a second, it slips for {scale.seconds(rolls.time):.4f} s."
    )
    for name, when in (("slipping", slips), ("rolling", ~slips)):
        low, high = np.degrees([motion.theta[when].min(), motion.theta[when].max()])
        print(f"While {name} it leans between {low:.2f} and {high:.2f} degrees.")
    print(f"Slipping made {scale.joules(motion.dissipated[-1]) * 1e3:.1f} mJ of heat.")
    print(f"The table bears at least {motion.normal.min():.3f} of its weight.")
    print(
        f"Rolling needs a friction of at most {motion.friction_coefficient[~slips].max():.3f}."
    )
