"""A coin that stands on its edge and is flicked at one side spins about its diameter, slips, falls, slips again, and ends by rolling round a ring."""

import numpy as np

import spincyl as sc


def flicked(turns: float) -> sc.State:
    """Initial state: upright, spinning about its vertical diameter, `turns` a second, as a finger leaves it.

    The finger strikes across the coin, 0.9 R beside the diameter: I1 w1 = 0.9 v. The velocity v of the
    centre points to where the friction that it meets lifts the coin off the other rim.
    """
    w1 = 2 * np.pi * turns * float(scale.seconds(1.0))
    upright = sc.State(np.pi / 2, w1, 0.0, 0.0)
    return body.with_centre_velocity(upright, float(body.i1) * w1 / 0.9, 0.0)


body = sc.Body.from_metres(outer_diameter=0.02426, length=0.00175)
scale = sc.Scale(radius=0.01213, mass=0.00567)
table = sc.Coulomb(0.2)
start = flicked(3.0)
t = np.linspace(0.0, 100.0, 5001)

if __name__ == "__main__":
    motion = sc.roll(body, start, t, contact=table, want="pose")
    for phase in motion.phases:
        lean = np.degrees(phase.state.theta)
        print(
            f"{phase.kind} from {scale.seconds(phase.time):.4f} s on, at {lean:.2f} degrees"
        )
    late = motion.t >= motion.phases[-1].time
    low, high = np.degrees([motion.theta[late].min(), motion.theta[late].max()])
    print(f"In the end it nods between {low:.2f} and {high:.2f} degrees.")
    fast = sc.roll(body, flicked(10.0), t, contact=table, restitution=0.0)
    ends = f"{scale.seconds(t[-1]):.1f} s later it leans at most {np.degrees(fast.theta[-1000:].max()):.1f} degrees."
    print(
        "Flicked to 10 turns a second it rocks between its two rims, without a bounce,"
    )
    print(f"through {len(fast.phases)} phases; {ends}")
