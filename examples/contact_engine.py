"""MuJoCo on scenes with a known answer: how far it deviates, and how far we do.

    pip install 'spincyl[engine]'
    python examples/contact_engine.py [--seconds 1] [--save FOLDER]

For a solid cylinder, the PVC tube of the paper, Euler's disk (75.1 mm by 12.8 mm) with a sharp rim and with a fillet of
2 mm, and Hurricane balls (two of 16 mm), each a little off a steady state. MuJoCo
is run with its defaults (times in units of sqrt(R/g)), and with a stiff contact and as little slip as its solver
bears. The deviation is the largest of the inclination, from the exact solution, whose own error is printed too,
beside that of our RK4 with the same number of steps.
"""

import argparse
import time
from pathlib import Path

import mujoco
import numpy as np

import spincyl as sc


def scenes(seconds: float) -> dict[str, sc.Scene]:
    """The five scenes."""
    cylinder = sc.Body.solid(2.5)
    disk = sc.Body.from_metres(outer_diameter=0.0751, length=0.0128)
    tube_scale, disk_scale = (
        sc.Scale(7.9375e-3, mass=0.02),
        sc.Scale(0.0751 / 2, mass=0.44),
    )
    pipe = sc.Body.tube(6.0, bore=0.8)
    rounded = sc.Body.from_metres(outer_diameter=0.0751, length=0.0128, fillet=0.002)
    balls, balls_scale = sc.Body.balls(), sc.Scale(0.008, mass=0.033)
    return {
        "cylinder, R = 1 m": sc.scene(
            cylinder, cylinder.steady(1.3).kicked(0.02), seconds=seconds
        ),
        "PVC tube": sc.scene(
            pipe,
            pipe.steady(np.radians(85)).kicked(0.02),
            scale=tube_scale,
            seconds=seconds,
        ),
        "Euler's disk": sc.scene(
            disk, disk.steady(0.3).kicked(0.02), scale=disk_scale, seconds=seconds
        ),
        "the same, rounded": sc.scene(
            rounded, rounded.steady(0.3).kicked(0.02), scale=disk_scale, seconds=seconds
        ),
        "Hurricane balls": sc.scene(
            balls,
            balls.steady(np.radians(78)).kicked(0.02),
            scale=balls_scale,
            seconds=seconds,
        ),
    }


def mujoco_run(
    scene: sc.Scene, *, plain: bool
) -> tuple[float, float, float, int, float]:
    """Largest deviations of theta (rad) and energy (relative), processor seconds, steps, seconds reached."""
    model = mujoco.MjModel.from_xml_string(scene.mjcf)
    second = scene.scale.seconds(1.0)
    if plain:
        model.opt.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
        model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
        model.opt.impratio, model.opt.noslip_iterations = 1.0, 0
        # its defaults, for which a scene of about a metre is meant
        for solref, solimp in (
            (model.geom_solref, model.geom_solimp),
            (model.pair_solref, model.pair_solimp),
        ):
            solref[:], solimp[:] = (0.02 * second, 1.0), (0.9, 0.95, 0.001, 0.5, 2.0)
        model.opt.timestep = 0.002 * second
    state = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, state, 0)
    mujoco.mj_forward(model, state)
    until = scene.data["expected"]["time"][-1]
    cosines, energy, times = [state.xmat[1][8]], [state.energy.sum()], [state.time]
    began = time.process_time()
    while state.time < until:
        mujoco.mj_step(model, state)
        if state.time < times[-1]:  # it has given up and begun anew
            break
        times.append(state.time)
        cosines.append(state.xmat[1][8])
        energy.append(state.energy.sum())
    took = time.process_time() - began
    m = scene.motion
    exact = sc.roll(m.body, m.start, np.array(times) / second)
    off = np.abs(np.arccos(np.clip(cosines, -1, 1)) - exact.theta).max()
    drift = np.abs(np.array(energy) / energy[0] - 1).max()
    return float(off), float(drift), took, len(times) - 1, times[-1]


def ours(scene: sc.Scene, steps: int) -> tuple[float, float]:
    """Error of RK4 with so many steps, and processor seconds of it."""
    m = scene.motion
    began = time.process_time()
    rk4 = sc.roll(m.body, m.start, m.t, step=m.t[-1] / steps)
    took = time.process_time() - began
    return float(np.abs(rk4.theta - m.theta).max()), took


def rows(name: str, scene: sc.Scene, seconds: float) -> list[list[str]]:
    """What the solvers make of a scene: name, solver, steps, deviations of theta and energy, time."""
    found = []
    for plain, what in (
        (True, "MuJoCo, its defaults"),
        (False, "MuJoCo, stiff, little slip"),
    ):
        off, drift, took, steps, until = mujoco_run(scene, plain=plain)
        gave_up = f", to {until:.2g} s" if until < seconds else ""
        found.append(
            [
                name,
                what + gave_up,
                f"{steps}",
                f"{off:.2g} rad",
                f"{drift:.1g}",
                f"{1e3 * took:.0f} ms",
            ]
        )
    steps = round(float(scene.motion.t[-1]) / 5e-4)
    off, took = ours(scene, steps)
    error = scene.motion.error
    less = f"{off:.0e} rad" if off > error else f"below {error:.0e} rad"
    found.append([name, "spincyl, RK4", f"{steps}", less, "", f"{1e3 * took:.1f} ms"])
    found.append(
        [name, "spincyl, exact: its own error", "", f"{error:.0e} rad", "", ""]
    )
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=1.0)
    parser.add_argument(
        "--save", metavar="FOLDER", help="write the scenes as JSON and MJCF, too"
    )
    parser.add_argument(
        "--docs",
        metavar="PAGE",
        help="put the table into a page, after the line that says so",
    )
    args = parser.parse_args()
    head = ["scene", "solver", "steps", "inclination off by", "energy off by", "time"]
    table = ["| " + " | ".join(head) + " |", "| --- " * len(head) + "|"]
    for name, scene in scenes(args.seconds).items():
        if args.save:
            folder = Path(args.save)
            folder.mkdir(parents=True, exist_ok=True)
            scene.save(
                folder
                / name.replace(", R = 1 m", "")
                .replace(",", "")
                .replace(" ", "_")
                .replace("'", "")
            )
        table += [
            "| " + " | ".join(row) + " |" for row in rows(name, scene, args.seconds)
        ]
    text = "\n".join(table)
    print(text)
    if args.docs:
        page, mark = (
            Path(args.docs),
            "<!-- written by examples/contact_engine.py -->\n\n",
        )
        before, after = page.read_text(encoding="utf-8").split(mark)
        rest = after[after.index("\n\n") :]
        page.write_text(before + mark + text + rest, encoding="utf-8")


if __name__ == "__main__":
    main()
