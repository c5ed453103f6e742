"""A cup that is rolled on its side goes round in a circle, if it is not too fast."""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import spincyl as sc

Floats = NDArray[np.float64]

# a paper cup without a floor, 9 cm long, 5 cm wide at the bottom and 7 cm at the brim
body = sc.Body.frustum(25.0, 35.0, 90.0, wall=0.0)
scale = sc.Scale(radius=0.035, mass=0.007)
table = sc.Coulomb(0.5)
LOSS = sc.loss.RollingResistance(0.02)
lies = float(body.borders[0])
t = np.linspace(0.0, 400.0, 8001)


def pushed(rate: float) -> sc.State:
    """Initial state: the cup rolls on both rims round the apex, at `rate`."""
    w1 = rate * np.sin(lies)
    return sc.State(lies, w1, 0.0, -w1 * np.tan(lies))


def rate_of(speed: float) -> float:
    """The rate, in sqrt(g/R), at which the centre has a speed given in m/s."""
    circle = scale.metres(body.apex().radius)
    return float(speed / circle * scale.seconds(1.0))


def law(rate: float) -> tuple[float, float]:
    """Time in sqrt(R/g) until the cup rests, and number of rounds of its circle.

    With the moment J about the line of contact, J tan(theta) rate' = -length.
    """
    s, c = np.sin(lies), np.cos(lies)
    radius, height, _ = body.circles[0]
    high = radius * s - height * c
    moment = body.i1 * c**2 + body.i3 * s**2 + high**2
    time = moment * np.tan(lies) * rate / LOSS.coefficient
    return float(time), float(rate * time / 2 / (2 * np.pi))


def contacts(motion: sc.Motion) -> tuple[Floats, Floats]:
    """Contact points of the bottom and of the brim, in cm from the apex."""
    way = np.column_stack([np.cos(motion.phi), np.sin(motion.phi)])
    apex = motion.contact_point[0] + body.circles[0, 0] / np.cos(lies) * way[0]
    bottom = motion.contact_point - apex
    cm = 100 * scale.metres(1.0)
    return cm * bottom, cm * (bottom - body.spans[0] * way)


START = 0.6
start = pushed(rate_of(START))


def picture() -> None:
    """Draw the paths of bottom and brim from above, and the forces that carry both."""
    _, (left, right) = plt.subplots(1, 2, figsize=(9.6, 5.4))
    motion = sc.roll(
        body,
        start,
        t,
        contact=table,
        restitution=0.0,
        losses=LOSS,
        want=("pose", "force"),
    )
    ways = contacts(motion)
    for way, words in zip(ways, ("bottom", "brim"), strict=True):
        left.plot(*way.T, label=words)
    every = np.searchsorted(motion.phi, np.arange(0.0, motion.phi[-1], np.pi / 4))
    for i in every:
        left.plot(*np.array([way[i] for way in ways]).T, "k", lw=1)
    left.plot(0, 0, "k+", ms=12)
    left.annotate("apex", (0, 0), (2, 2))
    left.set(aspect="equal", xlabel="x (cm)", ylabel="y (cm)", title="from above")
    left.legend(loc=(0.33, 0.26))
    seconds = scale.seconds(motion.t)
    mass = 1000 * scale.newtons(1.0)
    right.plot(seconds, mass * motion.normal, label="bottom")
    right.plot(seconds, mass * motion.normal_other, label="brim")
    right.set(xlabel="time (s)", ylabel="normal force (mN)", ylim=(0, None))
    right.set_title("what carries it")


if __name__ == "__main__":
    circle, limit, friction = body.apex()
    print(f"The centre goes round a circle of {100 * scale.metres(circle):.1f} cm.")
    fast = scale.metres(circle * limit) / scale.seconds(1.0)
    print(f"At {fast:.2f} m/s its bottom would rise, which takes mu = {friction:.2f}.")
    for speed in (0.4, START, 0.8, 1.2, 1.4):
        rate = rate_of(speed)
        motion = sc.roll(
            body,
            pushed(rate),
            t,
            contact=table,
            restitution=0.0,
            losses=LOSS,
            want="pose",
        )
        assert motion.event is not None
        time, rounds = law(rate)
        rests = scale.seconds(motion.event.time)
        print(f"Pushed at {speed} m/s, it rests after", end=" ")
        print(f"{motion.phi[-1] / (2 * np.pi):.4f} rounds and {rests:.4f} s", end="")
        if len(motion.phases) == 1:
            print(
                f"\n  (closed form: {rounds:.4f} rounds, {scale.seconds(time):.4f} s)."
            )
            continue
        rises = np.degrees(motion.theta.max() - lies)
        rolls = scale.seconds(motion.phases[-1].time)
        print(f";\n  first it slides for {rolls:.2f} s, and", end=" ")
        print(f"its bottom rises by {rises:.1f} degrees.")
