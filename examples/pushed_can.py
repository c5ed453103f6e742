"""A can that is pushed: it slides, or it tips, and a spin keeps it on its face."""

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

# an empty can without lids, 16 cm high and 8 cm wide
body = sc.Body.from_metres(outer_diameter=0.08, length=0.16, inner_diameter=0.076)
scale = sc.Scale(radius=0.04, mass=0.05)
metre, second = float(scale.metres(1.0)), float(scale.seconds(1.0))
table = sc.Coulomb(0.55)
t = np.linspace(0.0, 1.6 / second, 3201)


def pushed(speed: float, turns: float = 0.0, contact: sc.Coulomb = table) -> sc.Motion:
    """Motion of the can after a push: speed in m/s, spin in turns per second."""
    start = sc.spun(body, 2 * np.pi * turns * second, (speed * second / metre, 0.0))
    return sc.roll(body, start, t, contact=contact, restitution=0.0, want="pose")


def picture() -> None:
    """Draw the inclination of the can after pushes without a spin, and with one."""
    _, axes = plt.subplots(1, 2, sharey=True)
    cases = [(0.6, 0.0), (1.0, 0.0), (1.4, 0.0)], [(1.0, 0.0), (1.0, 2.0), (1.0, 5.0)]
    for ax, pushes in zip(axes, cases, strict=True):
        for speed, turns in pushes:
            motion = pushed(speed, turns)
            # at rest from the end on
            times = np.append(motion.t, t[-1])
            lean = np.degrees(np.append(motion.theta, motion.theta[-1]))
            words = f"{speed:g} m/s" if ax is axes[0] else f"{turns:g} turns/s"
            ax.plot(scale.seconds(times), lean, label=words)
        ax.set(xlabel="time (s)", xlim=(0, 1.6))
        ax.legend()
    axes[0].set(ylabel="inclination (degrees)", title="pushed without a spin")
    axes[1].set_title("pushed at 1 m/s with a spin")


if __name__ == "__main__":
    print(f"It topples if mu is larger than {1 / body.ell:.2f}.")
    for mu, speed, turns in (
        (0.45, 1.0, 0.0),
        (0.55, 0.6, 0.0),
        (0.55, 1.0, 0.0),
        (0.55, 1.0, 2.0),
        (0.55, 1.0, 5.0),
    ):
        motion = pushed(speed, turns, sc.Coulomb(mu))
        most = np.degrees(motion.theta.max())
        print(f"mu = {mu}, {speed:g} m/s, {turns:g} turns/s:", end=" ")
        print(f"tips up to {most:.1f} degrees" if most else "stays on its face", end="")
        end = motion.event
        print(f", at rest after {scale.seconds(end.time):.3f} s." if end else ".")
