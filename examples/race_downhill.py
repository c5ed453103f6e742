"""A race down a slope: the shape wins, not the size or the mass."""

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

runners = {
    "solid ball": sc.Body.ball(0.0, 2 / 5, 2 / 5),
    "disk": sc.Body.solid(0.0),
    "hollow ball": sc.Body.ball(0.0, 2 / 3, 2 / 3),
    "hoop": sc.Body.tube(0.0, bore=1.0),
}
body = runners["solid ball"]
# all of them as large as a marble
scale = sc.Scale(radius=0.01, mass=0.01)
metre, second = float(scale.metres(1.0)), float(scale.seconds(1.0))
start = sc.State(np.pi / 2, 0.0, 0.0, 0.0)
t = np.linspace(0.0, 3.0 / second, 3001)


def race(name: str, degrees: float, mu: float) -> sc.Motion:
    """The motion of a runner on a slope, with this friction."""
    table = sc.Table(np.radians(degrees), phi0=-np.pi / 2)
    return sc.roll(runners[name], start, t, contact=sc.Coulomb(mu), table=table)


def arrival(motion: sc.Motion, length: float = 1.0) -> float:
    """The time in seconds after which a runner has gone `length` metres."""
    gone = (motion.centre[:, 0] - motion.centre[0, 0]) * metre
    return float(np.interp(length, gone, motion.t * second))


def picture() -> None:
    """Draw distances over time on one slope, and the time for a metre by slope."""
    _, (left, right) = plt.subplots(1, 2)
    slopes = np.linspace(5, 60, 23)
    for name in runners:
        motion = race(name, 10.0, 0.3)
        gone = (motion.centre[:, 0] - motion.centre[0, 0]) * metre
        left.plot(motion.t * second, gone, label=name)
        times = [arrival(race(name, degrees, 0.3)) for degrees in slopes]
        right.plot(slopes, times, label=name)
    left.set(
        xlabel="time (s)",
        ylabel="way (m)",
        title="down 10 degrees",
        xlim=(0, 2),
        ylim=(0, 1.5),
    )
    left.set_xticks((0, 0.5, 1, 1.5, 2))
    left.legend()
    right.set(xlabel="slope (degrees)", ylabel="time for a metre (s)", ylim=(0, None))
    right.set_title("with the friction 0.3")


if __name__ == "__main__":
    for name, body in runners.items():
        motion = race(name, 10.0, 0.3)
        steepest = np.degrees(np.arctan(0.3 * (1 + body.i3) / body.i3))
        print(
            f"{name:11s} a metre down 10 degrees in {arrival(motion):.3f} s;", end=" "
        )
        print(f"slips above {steepest:.1f} degrees")
    for degrees in (30.0, 45.0, 60.0):
        kinds = {name: race(name, degrees, 0.3).phases[0].kind for name in runners}
        print(f"{degrees:g} degrees:", ", ".join(f"{k}: {v}" for k, v in kinds.items()))
