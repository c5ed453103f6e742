"""Euler's disk stops under three loss laws at once, and whirrs differently."""

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

body = sc.Body.from_metres(outer_diameter=0.0751, length=0.0128, fillet=0.002)
start = body.steady(0.3)
t = np.linspace(0.0, 2000.0, 2001)
scale = sc.Scale(radius=0.0751 / 2, mass=0.44)
LAWS = {
    sc.loss.DryContour: "dry friction of the rim",
    sc.loss.ViscousContour: "viscous friction of the rim",
    sc.loss.BoundaryLayer: "boundary layer of the air",
}


def lasting(law: type[sc.loss.Law], time: float) -> sc.loss.Law:
    """The loss law by which the disk, with its centre at rest, stops at `time`."""
    # a drift of half the loss takes twice as long
    return law(1e-3 * float(sc.drift(body, start.theta, law(1e-3)).stops_at) / time)


def picture() -> None:
    """Draw inclination and rate under the three laws over the time until the stop."""
    _, (left, right) = plt.subplots(1, 2, figsize=(9.6, 5.4))
    for law, words in LAWS.items():
        slow = sc.drift(body, start.theta, lasting(law, 1500.0))
        remaining = np.geomspace(1e-3, 0.999, 300) * slow.stops_at
        theta, rate = (
            slow.theta(slow.stops_at - remaining),
            slow.precession(slow.stops_at - remaining),
        )
        left.plot(scale.seconds(remaining), np.degrees(theta), label=words)
        right.plot(scale.seconds(remaining), scale.turns(rate))
    left.set(
        ylabel="inclination (degrees)",
        ylim=(0, 18),
        title="three laws stop it together",
    )
    left.legend(loc="lower left")
    right.set(
        ylabel="turns a second",
        xscale="log",
        yscale="log",
        title="its whirr tells them apart",
    )
    right.xaxis.set_major_formatter("{x:g}")
    right.set_yticks([10, 20, 50, 100], ["10", "20", "50", "100"])
    right.minorticks_off()
    for ax in (left, right):
        ax.set_xlabel("seconds to the end")
        ax.invert_xaxis()


if __name__ == "__main__":
    for law in LAWS:
        losses = lasting(law, 1500.0)
        slow = sc.drift(body, start.theta, losses)
        halfway = np.degrees(slow.theta(0.5 * slow.stops_at))
        last = scale.turns(slow.precession(slow.stops_at - 1.0 / scale.seconds(1.0)))
        motion = sc.roll(body, start, t, losses=losses)
        print(f"{law.__name__}, coefficient {losses.coefficient:.4g}:")
        stops = scale.seconds(slow.stops_at)
        print(f"  With the centre at rest it stops after {stops:.1f} s;")
        print(f"  halfway it is inclined by {halfway:.2f} degrees,", end=" ")
        print("and one second before the end")
        print(f"  its contact point goes round {last:.1f} times a second.")
        end = motion.event
        assert end is not None
        left = np.degrees(end.state.theta)
        print(f"  Rolling without slip it takes {scale.seconds(end.time):.1f} s;")
        print(f"  {motion.message.split(':')[0]} at {left:.4f} degrees.")
