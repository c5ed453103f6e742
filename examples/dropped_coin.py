"""A coin that is dropped bounces, comes to stand on its rim, and whirrs to rest."""

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

# two euros
body = sc.Body.from_metres(outer_diameter=0.02575, length=0.0022)
scale = sc.Scale(radius=0.02575 / 2, mass=0.0085)
table, losses = sc.Coulomb(0.3), sc.loss.DryContour(0.02)
# from 5 cm, and it turns 13 times a second
start = sc.dropped(body, 0.05, np.radians(80.0), w1=80.0, scale=scale)
t = np.linspace(0.0, 120.0, 2401)


def rest(restitution: float) -> sc.Motion:
    """Motion of the dropped coin with this restitution, until it rests."""
    return sc.roll(
        body, start, t, contact=table, restitution=restitution, losses=losses
    )


def picture() -> None:
    """Draw the height of the coin and its inclination."""
    motion = rest(0.5)
    assert motion.event is not None
    end = motion.event.time
    # a denser grid of times while the coin bounces
    many = np.union1d(np.linspace(0.0, 12.0, 3001), np.linspace(0.0, end, 3001))
    now = motion.at(many)
    _, (above, below) = plt.subplots(2, 1, figsize=(9.6, 5.4))
    above.plot(scale.seconds(many), 1000 * scale.metres(now.height))
    above.set(ylabel="lowest point (mm)", xlim=(0, scale.seconds(12.0)))
    above.set_title("it bounces for a third of a second")
    # the lower one of both rims
    lean = np.minimum(now.theta, np.pi - now.theta)
    below.plot(scale.seconds(many), np.degrees(lean), color="#D55E00")
    below.set(xlabel="time (s)", ylabel="inclination (degrees)")
    below.set(xlim=(0, scale.seconds(end)), ylim=(0, 92))
    below.set_title("and whirrs for three")


if __name__ == "__main__":
    for bounces in (0.0, 0.3, 0.5, 0.7):
        motion = rest(bounces)
        end = motion.event
        assert end is not None
        first = motion.impacts[0]
        after = next(
            p for p in motion.phases if p.kind != "flying" and p.time > first.time
        )
        print(f"Restitution {bounces:g}: {len(motion.impacts)} impacts,", end=" ")
        print(f"on the table after {scale.seconds(after.time):.3f} s;")
        lost = scale.joules(sum(impact.lost for impact in motion.impacts))
        print(f"  {1000 * lost:.2f} mJ lost in impacts;", end=" ")
        lean = np.degrees(min(end.state.theta, np.pi - end.state.theta))
        print(f"at rest after {scale.seconds(end.time):.2f} s,", end=" ")
        print(f"inclined by {lean:.1f} degrees.")
