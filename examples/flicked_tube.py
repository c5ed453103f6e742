"""A pressed tube shoots out, slips until its centre is nearly at rest, and rolls on."""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import spincyl as sc

Floats = NDArray[np.float64]


def pushed(impulse: float, angle: float = 80.0, finger: float = 0.3) -> sc.State:
    """The tube after a finger has pressed its rim, `angle` degrees from the top."""
    return sc.pressed(body, impulse, np.radians(angle), finger=finger)


def outcome(motion: sc.Motion) -> str:
    """Outcome of a flick: a tube settles if it rolls for the last half of the time."""
    if motion.event:
        words = {sc.Ending.SIDE: "lies down again", sc.Ending.LIFT_OFF: "hops"}
        return (
            "stays lying"
            if motion.event.time == 0
            else words.get(motion.status, motion.message)
        )
    last = motion.phases[-1]
    return (
        "settles"
        if last.kind == "rolling" and 2 * last.time < motion.t[-1]
        else "slips now and then"
    )


def centre_speed(motion: sc.Motion) -> Floats:
    """Speed of the centre along the table, in sqrt(g R)."""
    speed: Floats = np.hypot(*body.centre_velocity(motion.states))
    return speed


def still_symbols(motion: sc.Motion) -> Floats:
    """Number of still symbols a turn, of each state."""
    number: Floats = np.asarray(motion.states.contact_radius)
    return number


body = sc.Body.from_metres(
    outer_diameter=0.015875, inner_diameter=0.0127, length=0.09525
)
scale = sc.Scale(radius=0.015875 / 2, mass=0.0095)
table = sc.Coulomb(0.3)
# in M sqrt(g R): the launch number is 1.1, and the tube nods by 2 degrees in the end
IMPULSE = 7.0
start = pushed(IMPULSE)
t = np.linspace(0.0, 200.0, 4001)


def picture() -> None:
    """Draw the path of the contact point and the speed of the centre."""
    motion = sc.roll(
        body, start, np.linspace(0.0, 60.0, 6001), contact=table, want="pose"
    )
    slips, seconds = motion.t < motion.phases[-1].time, scale.seconds(motion.t)
    x, y = 100 * scale.metres(motion.contact_point.T)
    _, (above, below) = plt.subplots(2, 1, figsize=(9.6, 5.4), height_ratios=(1, 1.8))
    speed = scale.metres_per_second(centre_speed(motion))
    for ax, across, up in ((above, -y, x), (below, seconds, speed)):
        for when, colour, label in (
            (slips, "#B2182B", "it slips"),
            (~slips, "#0072B2", "it rolls"),
        ):
            ax.plot(across[when], up[when], color=colour, label=label)
    above.set(
        xlabel="along its way (cm)",
        ylabel="across (cm)",
        title="the way of its contact point, from above",
        aspect="equal",
    )
    below.set(
        xlabel="time (s)", ylabel="speed (m/s)", title="its centre comes nearly to rest"
    )
    below.set_yticks([0.0, 0.5, 1.0, 1.5])
    below.legend()


if __name__ == "__main__":
    motion = sc.roll(body, start, t, contact=table, want="pose")
    rolls = motion.phases[-1]
    late = motion.t >= rolls.time
    speed = scale.metres_per_second(centre_speed(motion))
    print(f"Launch number {sc.launch_number(body, start):.2f}: the pressed end rises.")
    print(f"It slips for {scale.seconds(rolls.time):.2f} s and then rolls.")
    print(f"Its centre leaves the finger at {speed[0]:.2f} m/s, and in the end moves")
    print(f"at {speed[late].min() * 1e3:.0f} to {speed[late].max() * 1e3:.0f} mm/s.")
    seen = still_symbols(motion)[late]
    low, high = seen.min(), seen.max()
    print(f"Each turn shows {low:.2f} to {high:.2f} still symbols,", end=" ")
    print(f"{seen.mean():.1f} on average.")
    print(f"{scale.joules(motion.dissipated[-1]) * 1e3:.1f} mJ became heat.")
    for impulse in (6.0, 7.0, 8.0, 10.0, 12.0):
        for angle, finger in ((50.0, 0.3), (80.0, 0.3), (60.0, 0.6)):
            state = pushed(impulse, angle, finger)
            ends = outcome(sc.roll(body, state, t, contact=table))
            number = sc.launch_number(body, state)
            print(
                f"impulse {impulse:g} at {angle:g} degrees, finger {finger:g}:", end=" "
            )
            print(f"launch {number:.2f}, {ends}")
