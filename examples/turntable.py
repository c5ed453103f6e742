"""A ball on a turntable: it goes round, at two sevenths of the rate of the table."""

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

body, hollow = sc.Body.ball(0.0, 2 / 5, 2 / 5), sc.Body.ball(0.0, 2 / 3, 2 / 3)
# a ball 2 cm wide on a record player with 33 turns a minute
scale = sc.Scale(radius=0.01, mass=0.004)
metre, second = float(scale.metres(1.0)), float(scale.seconds(1.0))
rate = 2 * np.pi * 100 / 180 * second
start = sc.State(np.pi / 2, 0.0, 0.0, 0.0)
t = np.linspace(0.0, 12.6 / second, 3001)


def rolled(ball: sc.Body, speed: float, slope: float = 0.0) -> sc.Motion:
    """Motion of a ball thrown at `speed` (m/s), 10 cm from the middle of the table."""
    table = sc.Table(slope, turning=rate, phi0=0.0, place=(0.1 / metre, 0.0))
    # over the table, which moves there with 0.35 m/s
    slip = (0.0, speed * second / metre - rate * 0.1 / metre)
    thrown = sc.State(np.pi / 2, 0.0, 0.0, 0.0, slip=slip)
    return sc.roll(ball, thrown, t, contact=sc.Coulomb(0.3), table=table)


def once_round(motion: sc.Motion) -> float:
    """The time in seconds for one circle of the rolling ball."""
    x, y = (motion.centre[:, :2] * metre).T
    way = np.unwrap(np.arctan2(np.gradient(y), np.gradient(x)))
    rolls = motion.t > motion.phases[-1].time + 1.0
    return float(2 * np.pi / np.polyfit(motion.t[rolls] * second, way[rolls], 1)[0])


def picture() -> None:
    """Draw the paths as seen from the room, on a level table and on a tilted one."""
    _, axes = plt.subplots(1, 2)
    for speed in (0.0, 0.2, 0.5):
        x, y = (rolled(body, speed).centre[:, :2] * 100 * metre).T
        axes[0].plot(x, y, label=f"{speed:g} m/s")
    axes[0].set(title="level", xlabel="x (cm)", ylabel="y (cm)", aspect="equal")
    axes[0].legend(loc="center left")
    for degrees in (0.2, 0.5):
        x, y = (rolled(body, 0.2, np.radians(degrees)).centre[:, :2] * 100 * metre).T
        axes[1].plot(x, y, label=f"{degrees:g} degrees")
    axes[1].set(title="tilted down to the right", xlabel="x (cm)", aspect="equal")
    axes[1].set_xticks((-30, -10, 10))
    axes[1].legend(loc="upper left")


if __name__ == "__main__":
    turn = 2 * np.pi * second / rate
    print(f"The table turns once in {turn:.3f} s.")
    for name, ball in (("solid", body), ("hollow", hollow)):
        for speed in (0.2, 0.5):
            motion = rolled(ball, speed)
            slid = motion.phases[-1].time * second
            ratio = once_round(motion) / turn
            print(f"{name} ball, {speed} m/s: slips for {slid:.3f} s,", end=" ")
            print(f"and goes round in {ratio:.4f} turns of it.")
    tilted = rolled(body, 0.2, np.radians(0.5))
    # over one circle, the second half of the time
    _, went, _ = (tilted.centre[-1] - tilted.centre[1500]) * metre
    drift = went / ((t[-1] - t[1500]) * second)
    across = 2.5 * 9.80665 * np.sin(np.radians(0.5)) / (rate / second)
    print(f"Tilted by half a degree: it drifts across with {drift:.4f} m/s", end=" ")
    print(f"(known: {across:.4f}).")
