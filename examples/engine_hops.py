"""MuJoCo on bodies that are dropped, hop and lie, beside the motion of two rigid bodies.

    pip install 'spincyl[engine]'
    python examples/engine_hops.py [--docs docs/engines.md]

Five scenes of half a second, in which the body slips, flies, strikes and lies. MuJoCo has a stiff contact whose damping
belongs to the coefficient of restitution, with three lengths of its step. Deviations are those of the centre of mass, up
to the first blow and in all, and of the inclination.
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
    pipe, size = sc.Body.tube(6.0, bore=0.8), sc.Scale(7.9375e-3, mass=0.0095)
    coin, money = sc.Body.solid(0.0854), sc.Scale(0.012875, mass=0.0085)
    can, tin = sc.Body.solid(1.7), sc.Scale(0.033, mass=0.35)
    angle = np.radians(60)

    def flick(impulse: float, restitution: float) -> sc.Scene:
        start = sc.pressed(pipe, impulse, angle, finger=0.3)
        return sc.scene(
            pipe, start, scale=size, seconds=0.5, mu=MU, restitution=restitution
        )

    fall = sc.dropped(coin, 2.0, np.radians(80), w1=2.9)
    tilt = sc.dropped(can, 1.0, np.radians(50), w3=1.0)
    return {
        "tube, flicked, lies and rolls": flick(5.0, 0.0),
        "tube, flicked, hops": flick(12.0, 0.0),
        "tube, flicked, hops and bounces": flick(12.0, 0.5),
        "coin, dropped on its edge": sc.scene(
            coin, fall, scale=money, seconds=0.5, mu=MU, restitution=0.5
        ),
        "can, dropped, falls on its side": sc.scene(
            can, tilt, scale=tin, seconds=0.5, mu=MU, restitution=0.0
        ),
    }


def run(
    scene: sc.Scene, steps: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Times and centres in SI units, cosines of the inclination, and processor seconds of MuJoCo."""
    model = mujoco.MjModel.from_xml_string(scene.mjcf)
    model.opt.timestep = float(scene.scale.seconds(1.0)) / steps
    state = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, state, 0)
    mujoco.mj_forward(model, state)
    until, found = scene.data["expected"]["time"][-1], []
    began = time.process_time()
    while state.time < until:
        found.append((state.time, *state.xpos[1], state.xmat[1][8]))
        mujoco.mj_step(model, state)
        if state.time < found[-1][0]:  # it has given up and begun anew
            break
    took = time.process_time() - began
    all_ = np.array(found)
    return all_[:, 0], all_[:, 1:4], all_[:, 4], took


def rows(name: str, scene: sc.Scene) -> list[list[str]]:
    """The table's rows of one scene."""
    m, scale, found = scene.motion, scene.scale, []
    first = float(scale.seconds(m.impacts[0].time)) if m.impacts else np.inf

    for steps in STEPS:
        t, centre, cosine, took = run(scene, steps)
        some = np.unique(np.linspace(0, t.size - 1, 2001).astype(int))
        t, centre, cosine = t[some], centre[some], cosine[some]
        began = time.process_time()
        motion = sc.roll(
            m.body,
            m.start,
            t / scale.seconds(1.0),
            contact=m.contact,
            restitution=scene.restitution,
            want="pose",
        )
        ours = time.process_time() - began
        off = 1000 * np.linalg.norm(centre - scale.metres(motion.centre), axis=1)
        # the angle between the axes and the vertical, whichever rim is lower
        lean = np.abs(
            np.arccos(np.abs(cosine).clip(0, 1))
            - np.arccos(np.abs(np.cos(motion.theta)).clip(0, 1))
        )
        before = t < first
        found.append(
            [
                name,
                f"MuJoCo, {steps} steps",
                f"{off[before].max():.2g}" if first < np.inf else "",
                f"{off.max():.2g}",
                f"{np.degrees(lean.max()):.2g}",
                f"{1e3 * took:.0f} ms",
            ]
        )
    found.append(
        [
            name,
            f"spincyl, {len(m.impacts)} blows, claims {motion.error:.0e}",
            "",
            "",
            "",
            f"{1e3 * ours:.1f} ms",
        ]
    )
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--docs", metavar="PAGE", help="put the table into a page")
    args = parser.parse_args()
    head = [
        "scene",
        "solver, per unit of time",
        "centre off by, before the first blow (mm)",
    ]
    head += ["in all (mm)", "inclination off by (degrees)", "time"]
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
