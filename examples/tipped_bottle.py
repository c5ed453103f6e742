"""A bottle tips over its edge, rocks on its side, rolls round, and comes to rest."""

import matplotlib.pyplot as plt
import numpy as np

import spincyl as sc

# turned from wood, 18.4 cm high: radius and height of each corner, in mm
body = sc.Body.lathe([(40, 0), (24, 120), (12, 152), (12, 184)])
scale = sc.Scale(radius=0.04, mass=0.3)
table, losses = sc.Coulomb(0.4), sc.loss.RollingResistance(0.02)
RESTITUTION = 0.5
# let go on its edge, beyond its balance, while it turns about its axis
start = sc.State(np.radians(38.0), 0.0, 0.0, 1.5)
t = np.linspace(0.0, 120.0, 24001)


def tipped(bounces: float = RESTITUTION) -> sc.Motion:
    """Motion of the bottle until it rests, with this coefficient of restitution."""
    return sc.roll(
        body,
        start,
        t,
        contact=table,
        restitution=bounces,
        losses=losses,
        want=("pose", "force"),
    )


def picture() -> None:
    """Draw the inclination as the bottle tips and rocks, and its path from above."""
    motion = tipped()
    seconds, border = scale.seconds(motion.t), np.degrees(body.borders[0])
    lean = np.degrees(motion.theta)
    lies, cm = motion.phase > 2, 100 * scale.metres(1.0)
    _, axes = plt.subplot_mosaic(
        [["tips", "path"], ["rocks", "path"]], figsize=(9.6, 5.4), width_ratios=(1, 1.2)
    )
    axes["tips"].plot(seconds, lean)
    axes["tips"].axhline(border, color="0.5", lw=1, ls=":")
    axes["tips"].set(xlim=(0, 0.7), ylabel="inclination (°)", title="it tips")
    axes["rocks"].plot(seconds, lean - border)
    axes["rocks"].set(xlim=(0.36, 0.7), ylim=(-5, 1), ylabel="beyond lying (°)")
    axes["rocks"].set(xlabel="time (s)", xticks=(0.4, 0.5, 0.6, 0.7))
    axes["rocks"].set_title("and rocks to rest on its side")
    edge = motion.rim == 0
    for words, here in (("tips and rocks", edge & ~lies), ("rolls round", lies)):
        x, y = cm * np.where(here[:, np.newaxis], motion.contact_point, np.nan).T
        axes["path"].plot(x, y, label=f"its edge: {words}")
    axes["path"].plot(*cm * motion.centre[:, :2].T, "0.5", lw=1, label="its centre")
    axes["path"].set(aspect="equal", xlabel="x (cm)", ylabel="y (cm)")
    axes["path"].set_title("from above")
    axes["path"].legend(loc="center")


if __name__ == "__main__":
    circle = 100 * scale.metres(body.apex().radius)
    print(f"It lies at {np.degrees(body.borders[0]):.2f} degrees", end=" ")
    print(f"and rolls round a circle of {circle:.1f} cm.")
    for bounces in (0.0, RESTITUTION, 0.8):
        motion = tipped(bounces)
        assert motion.event is not None
        last = motion.phases[-1]
        lands, rolls, rests = scale.seconds(
            np.array([motion.impacts[0].time, last.time, motion.event.time])
        )
        print(f"Restitution {bounces:g}: its side lands after {lands:.3f} s;")
        print(f"  {last.kind} from {rolls:.3f} s on,", end=" ")
        rounds = np.ptp(motion.phi[motion.t > last.time]) / (2 * np.pi)
        print(f"{rounds:.2f} rounds, and rests after {rests:.2f} s;")
        lost = 1000 * scale.joules(motion.lost_in_impacts[-1])
        print(f"  {lost:.1f} mJ were lost in impacts.")
