"""A hula hoop thrown forwards with backspin slides, turns back and rolls home."""

from typing import NamedTuple

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc


class Law(NamedTuple):
    """The motion of an upright hoop with constant friction, in SI."""

    turns_back: float  # when its centre stops to come back, in seconds
    grips: float  # when it stops slipping, in seconds
    distance: float  # of its centre from the hand then, in metres
    velocity: float  # of its centre from then on, in metres per second
    back: float  # when it is back, in seconds; before the throw if it goes on
    heat: float  # in joules


def law(velocity: float, backspin: float, mu: float) -> Law:
    """The closed form: v' = -mu g, I3 w3' = mu g R, until the rim is at rest."""
    i3, radius, pull = float(body.i3), scale.radius, mu * scale.gravity
    slip = velocity + backspin * radius
    grips = slip / (pull * (1 + 1 / i3))
    distance, last = (
        velocity * grips - pull * grips**2 / 2,
        (velocity - i3 * backspin * radius) / (1 + i3),
    )
    return Law(
        turns_back=velocity / pull,
        grips=grips,
        distance=distance,
        velocity=last,
        back=grips - distance / last,
        heat=scale.mass * i3 * slip**2 / (2 * (1 + i3)),
    )


def least_speed() -> float:
    """Least speed, in m/s, of stable rolling: v^2 = g R I1/(I3 (I3 + 1))."""
    i1, i3 = float(body.i1), float(body.i3)
    return float(np.sqrt(scale.gravity * scale.radius * i1 / (i3 * (i3 + 1))))


body = sc.Body.tube(0.0, bore=0.97)
scale = sc.Scale(radius=0.45, mass=0.3)
table = sc.Coulomb(0.4)
VELOCITY, BACKSPIN = 3.0, 14.0  # metres per second, radians per second
start = sc.thrown(body, VELOCITY, BACKSPIN, scale=scale)
t = np.linspace(0.0, 1.7, 341) / scale.seconds(1.0)


def picture() -> None:
    """Draw the position of the hoop and the slip of its rim over time."""
    expected = law(VELOCITY, BACKSPIN, table.mu)
    motion = sc.roll(body, start, t, contact=table, want="pose")
    seconds = scale.seconds(motion.t)
    _, (left, right) = plt.subplots(1, 2, figsize=(9.6, 5.4))
    left.plot(seconds, scale.metres(motion.centre[:, 1]))
    right.plot(seconds, scale.metres_per_second(np.hypot(*motion.slip.T)))
    for ax, title in (
        (left, "it turns back and rolls home"),
        (right, "friction stops the slip"),
    ):
        ax.axvspan(0, expected.grips, color="#B2182B", alpha=0.12, label="it slips")
        ax.axvline(expected.turns_back, color="0.4", ls="--", label="its centre stops")
        ax.set(xlabel="time (s)", xlim=(0, seconds[-1]), title=title)
    left.set_ylabel("distance from the hand (m)")
    right.set_ylabel("slip of the rim (m/s)")
    right.legend(loc="upper right", frameon=True, framealpha=1)


if __name__ == "__main__":
    expected = law(VELOCITY, BACKSPIN, 0.4)
    motion = sc.roll(body, start, t, contact=table, want="pose")
    away = scale.metres(motion.centre[:, 1]).max()
    rolls = motion.phases[-1]
    backspin = BACKSPIN / (2 * np.pi)
    print(f"Thrown at {VELOCITY:g} m/s with {backspin:.1f} turns a second of backspin,")
    print(f"it turns back after {expected.turns_back:.3f} s, {away:.3f} m away,")
    print(f"and rolls from {scale.seconds(rolls.time):.6f} s on", end=" ")
    print(f"(closed form: {expected.grips:.6f} s)")
    print(f"at {-expected.velocity:.3f} m/s;", end=" ")
    print(f"it is back after {expected.back:.3f} s, and its heat")
    heat = scale.joules(motion.dissipated[-1])
    print(f"is {heat:.4f} J (closed form: {expected.heat:.4f} J).")
    print(f"Upright it rolls stably above {least_speed():.3f} m/s;", end=" ")
    print("below that the least push lets it fall.")
