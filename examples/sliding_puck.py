"""A puck that slides and spins: on its rim or on its whole face, both end together."""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import spincyl as sc

Floats = NDArray[np.float64]

# for ice hockey: three inches wide, one inch high, six ounces
body = sc.Body.from_metres(outer_diameter=0.0762, length=0.0254)
scale = sc.Scale(radius=0.0381, mass=0.17)
TABLES = {
    "on its rim": sc.Coulomb(0.2),
    "on its whole face": sc.Coulomb(0.2, face="disc"),
}
metre, second = float(scale.metres(1.0)), float(scale.seconds(1.0))
SPEED = 1.0  # m/s
SPINS = (0.0, 2.0, 5.0, 10.0)  # turns per second


def pushed(turns: float, table: sc.Coulomb) -> sc.Motion:
    """Motion of the puck until it rests; the spin is in turns a second."""
    spin = 2 * np.pi * turns * second
    start = sc.spun(body, spin, (SPEED * second / metre, 0.0))
    end = sc.roll(body, start, 1e3, contact=table).event
    assert end is not None
    # denser and denser times, since velocity and spin turn ever faster at the end
    t = end.time * (1 - np.geomspace(1, 1e-7, 800))
    return sc.roll(body, start, t, contact=table, t0=0.0, want="pose")


def cm(motion: sc.Motion) -> Floats:
    """Path of the centre, x and y in cm from the start."""
    way: Floats = 100 * metre * (motion.centre[:, :2] - motion.centre[0, :2])
    return way


def picture() -> None:
    """Draw the path of the centre, and its speed against the speed of the rim."""
    _, (paths, above, below) = plt.subplots(1, 3, width_ratios=(1.3, 1, 1))
    for table, (words, contact) in enumerate(TABLES.items()):
        ax = (above, below)[table]
        for i, turns in enumerate(SPINS):
            motion = pushed(turns, contact)
            x, y = cm(motion).T
            style = {"color": f"C{i}", "ls": ("-", "--")[table]}
            label = f"{turns:g} turns/s" if not table else None
            paths.plot(-y, x, label=label, **style)
            slide = np.hypot(*body.centre_velocity(motion.states))
            ax.plot(motion.w[:, 2] * metre / second, slide * metre / second, **style)
        fastest = 2 * np.pi * SPINS[-1] * metre
        ax.set(
            xlim=(0, 1.05 * fastest), ylim=(0, 1.05), xlabel="rim (m/s)", title=words
        )
    above.set_ylabel("centre (m/s)")
    paths.set(xlabel="to the right (cm)", ylabel="ahead (cm)", title="from above")
    paths.legend(loc="lower right")


if __name__ == "__main__":
    for words, table in TABLES.items():
        print(f"A push of {SPEED:g} m/s, {words}:")
        for turns in SPINS:
            motion = pushed(turns, table)
            x, y = cm(motion)[-1]
            rests = scale.seconds(motion.t[-1])
            print(f"  {turns:4.1f} turns/s: {rests:.3f} s,", end=" ")
            print(f"{x:.1f} cm ahead, {abs(y):.1f} cm to the right")
        slide = np.hypot(*body.centre_velocity(motion.states))
        ratio = (slide / motion.w[:, 2])[[0, 400, 600, -1]]
        print("  centre to rim:", *(f"{x:.3f}" for x in ratio))
