"""A hard-boiled egg that is dropped bounces, tumbles, slips, and rolls to rest."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Ellipse
from numpy.typing import NDArray

import spincyl as sc

Floats = NDArray[np.float64]

# 57 mm long, 44 mm wide, 60 g
body = sc.Ellipsoid.egg(0.022, 0.0285).in_metres(0.06)
scale = sc.Scale(radius=0.0285, mass=0.06)
table = sc.Coulomb(0.1)
losses = sc.loss.RollingResistance.from_si(0.5e-3, scale=scale)
RESTITUTION = 0.6
# from 10 cm, its axis 35 degrees from the vertical, at 0.8 m/s
leaning = body.spinning(0.0, pitch=np.radians(35.0))
start = body.dropped(leaning, 0.10, velocity=(0.8, 0.0, 0.0))
t = np.linspace(0.0, 12.0, 12001)
#: by the number of the phase in `Motion.phase`
COLOURS = {0: "#009E73", 1: "#D55E00", 2: "#0072B2"}


def fallen(restitution: float) -> sc.EllipsoidMotion:
    """Motion of the dropped egg with this restitution, until it is at rest."""
    return sc.roll(
        body,
        start,
        t,
        contact=table,
        restitution=restitution,
        losses=losses,
        want="pose",
    )


def stays(motion: sc.EllipsoidMotion) -> float:
    """The time after which the egg no longer leaves the table."""
    last = max(i for i, p in enumerate(motion.phases) if p.kind == "flying")
    return float(motion.phases[last + 1].time)


def shares(motion: sc.EllipsoidMotion) -> dict[str, Floats]:
    """The energy that the egg loses, and where it has gone, in per cent."""
    per_cent = 100.0 / (motion.energy[0] - motion.energy[-1])
    return {
        "taken by impacts": per_cent * motion.lost_in_impacts,
        "by sliding": per_cent * motion.dissipated,
        "by rolling resistance": per_cent * motion.work_lost,
        "still in the egg": per_cent * (motion.energy - motion.energy[-1]),
    }


def picture() -> None:
    """Draw the egg as a stroboscope shows it, and where its energy goes."""
    motion = fallen(RESTITUTION)
    _, (above, below) = plt.subplots(2, 1, figsize=(9.6, 5.4), height_ratios=(1.15, 1))
    # it turns in the plane x, z, by this angle
    turned = np.degrees(np.arctan2(-motion.vertical[:, 0], motion.vertical[:, 2]))
    x, _, z = 100 * motion.centre.T
    wide, _, long = 200 * scale.metres(body.semi_axes)
    for i in np.flatnonzero(x < 56.0)[::40]:
        colour = COLOURS[int(motion.phase[i])]
        at = {"angle": -turned[i], "zorder": 2 + i / len(t)}
        egg = Ellipse((x[i], z[i]), wide, long, fc=(1, 1, 1, 0.6), ec=colour, **at)
        above.add_patch(egg)
    above.plot(x, z, color="0.6", lw=1, zorder=4)
    above.axhline(0, color="k", lw=1)
    above.plot([], [], color=COLOURS[2], label="in the air")
    above.plot([], [], color=COLOURS[0], label="on the table")
    above.legend(loc="upper right", ncols=2)
    above.set(aspect="equal", xlim=(-4, 60), ylim=(0, 19), xlabel="cm", ylabel="cm")
    above.set_title("a flash every 40 ms")
    colours = "#0072B2", "#D55E00", "#009E73", "0.85"
    below.stackplot(motion.t, *shares(motion).values(), colors=colours, lw=0)
    line = {"arrowstyle": "-", "color": "w"}
    how = {"color": "w", "size": "small", "ha": "center", "va": "center"}
    for time, high, words, ink in (
        (2.3, 36, "taken by impacts", "w"),
        (3.85, 90, "by rolling resistance", "w"),
        (1.3, 91, "still in the egg", "k"),
    ):
        below.text(time, high, words, **{**how, "color": ink})
    below.annotate("by sliding", (3.7, 77), (3.7, 50), arrowprops=line, **how)
    below.set(xlim=(0, motion.t[-1]), ylim=(0, 100))
    below.set(xlabel="time (s)", ylabel="energy (%)")


if __name__ == "__main__":
    for bounces in (0.0, 0.3, RESTITUTION):
        motion = fallen(bounces)
        assert motion.event is not None
        print(f"Restitution {bounces:g}: {len(motion.impacts)} impacts,", end=" ")
        print(f"on the table after {stays(motion):.3f} s,")
        way = 100 * motion.centre[-1, 0]
        print(f"  at rest after {motion.event.time:.2f} s and {way:.0f} cm;", end=" ")
        taken = [share[-1] for share in shares(motion).values()]
        print("impacts, sliding and rolling", end=" ")
        print("took {:.0f}, {:.0f} and {:.0f} %.".format(*taken))
