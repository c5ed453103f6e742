"""Compare MuJoCo with spincyl on bodies that are dropped, hop, and lie on their side.

    pip install 'spincyl[engine]'
    python examples/engine_hops.py [--docs docs/engines.md]

In five scenes of half a second the body slips, flies, strikes the table and lies on its side. MuJoCo has a stiff contact,
whose damping follows from the coefficient of restitution, and three lengths of the step. The table has the largest
deviations of the centre of mass, before the first impact and in all, and of the inclination.
"""

import argparse
import time
from pathlib import Path

import mujoco
import numpy as np

import spincyl as sc

MU = 0.3
#: steps per unit of time sqrt(R/g)
STEPS = (500, 2000, 8000)


def scenes() -> dict[str, sc.Scene]:
    """The five scenes, of half a second."""
    tube = {"outer_diameter": 0.015875, "inner_diameter": 0.0127, "length": 0.09525}
    pipe = sc.measured(**tube, mass=0.0095)
    coin = sc.measured(outer_diameter=0.02575, length=0.0022, mass=0.0085)
    can = sc.measured(outer_diameter=0.066, length=0.1122, mass=0.35)
    angle, t = np.radians(60), np.linspace(0.0, 0.5, 101)

    def made(body: sc.Body, start: sc.State, restitution: float) -> sc.Scene:
        law = sc.Coulomb(MU)
        m = sc.roll(body, start, t, contact=law, restitution=restitution)
        return sc.scene(m)

    def flick(impulse: float) -> sc.State:
        return sc.pressed(pipe.natural, impulse, angle, finger=0.3)

    fall = sc.dropped(coin.natural, 2.0, np.radians(80), w1=2.9)
    tilt = sc.dropped(can.natural, 1.0, np.radians(50), w3=1.0)
    return {
        "tube that is flicked, lies down and rolls": made(pipe, flick(5.0), 0.0),
        "tube that is flicked and hops, with 3 impacts": made(pipe, flick(12.0), 0.0),
        "tube that is flicked, hops and bounces, with 62 impacts": made(
            pipe, flick(12.0), 0.5
        ),
        "coin that is dropped on its edge, with 25 impacts": made(coin, fall, 0.5),
        "can that is dropped and falls on its side, with 2 impacts": made(
            can, tilt, 0.0
        ),
    }


def run(scene: sc.Scene, steps: int) -> tuple[sc.Deviation, float]:
    """Run a scene in MuJoCo with this many steps: its deviation, and processor seconds."""
    model = mujoco.MjModel.from_xml_string(scene.mjcf)
    model.opt.timestep = scene.data["scale"]["second"] / steps
    state = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, state, 0)
    until = scene.data["expected"]["time"][-1]
    clock: list[float] = []
    x, q = [], []
    began = time.process_time()
    # MuJoCo resets an unstable simulation to time 0
    while state.time < until and (not clock or state.time > clock[-1]):
        clock.append(state.time)
        x.append(state.qpos[:3].copy())
        q.append(state.qpos[3:7].copy())
        mujoco.mj_step(model, state)
    took = time.process_time() - began
    some = np.unique(np.linspace(0, len(clock) - 1, 2001).astype(int))
    few = (np.array(column)[some] for column in (clock, x, q))
    return scene.compare(*few, scalar_first=True), took


def rows(name: str, scene: sc.Scene) -> list[list[str]]:
    """Rows for one scene: name, solver, deviations of the centre and of the inclination, time."""
    m, found = scene.motion, []
    blows = scene.data["expected"]["impacts"]
    first = blows[0]["time"] if blows else np.inf
    for steps in STEPS:
        off, took = run(scene, steps)
        centre, before = 1000 * off.position, off.time < first
        found.append(
            [
                name,
                f"MuJoCo, {steps} steps",
                f"{centre[before].max():.2g}" if first < np.inf else "",
                f"{centre.max():.2g}",
                f"{np.degrees(np.abs(off.theta).max()):.2g}",
                f"{1e3 * took:.0f} ms",
            ]
        )
    began = time.process_time()
    m.at(np.linspace(m.t[0], m.t[-1], 2001))
    took = time.process_time() - began
    found.append([name, "spincyl", "", "", "", f"{1e3 * took:.1f} ms"])
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--docs", metavar="PAGE", help="write the table into a page")
    args = parser.parse_args()
    head = [
        "scene",
        "solver, and its time steps per sqrt(R/g)",
        "largest error of the centre before the first impact (mm)",
    ]
    head += [
        "largest error of the centre (mm)",
        "largest error of the inclination (degrees)",
        "processor time",
    ]
    table = ["| " + " | ".join(head) + " |", "| --- " * len(head) + "|"]
    for name, scene in scenes().items():
        table += ["| " + " | ".join(row) + " |" for row in rows(name, scene)]
    text = "\n".join(table)
    print(text)
    if args.docs:
        page = Path(args.docs)
        mark = "<!-- written by examples/engine_hops.py -->\n\n"
        before, after = page.read_text(encoding="utf-8").split(mark)
        rest = after[after.index("\n\n") :]
        page.write_text(before + mark + text + rest, encoding="utf-8")


if __name__ == "__main__":
    main()
