"""Compare MuJoCo, and RK4 of spincyl, with the known answers of eight scenes.

    pip install 'spincyl[engine]'
    python examples/contact_engine.py [--seconds 1] [--save FOLDER]

Six bodies roll: a solid cylinder, the PVC tube of the paper, Euler's disk (75.1 mm by 12.8 mm) with a sharp rim and
with a fillet of 2 mm, Hurricane balls (two of 16 mm), each near a steady state, and a rattleback. A coin loses energy
by dry friction along its rim; MuJoCo does not have this law, so that its couple is applied by hand. Another coin
slips. MuJoCo runs with its defaults (times in units of sqrt(R/g)), and with the stiff contact of the MJCF file at two
lengths of the step. The table has the largest deviations of the inclination and of the centre, and the deviation of RK4 for bodies of revolution that roll without loss.
"""

import argparse
import time
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

import spincyl as sc


def scenes(seconds: float) -> dict[str, sc.Scene]:
    """The eight scenes by name, each with its known motion of this many seconds."""

    def made(
        body: Any,
        state: Any,
        scale: sc.Scale | None = None,
        **how: Any,
    ) -> sc.Scene:
        unit = 1.0 if body.scale is not None else (scale or sc.Scale(1.0)).seconds(1.0)
        t = np.linspace(0.0, seconds / unit, 101)
        return sc.scene(sc.roll(body, state, t, **how), scale=scale)

    size = {"outer_diameter": 0.0751, "length": 0.0128, "mass": 0.44}
    cylinder, pipe, balls = (
        sc.Body.solid(2.5),
        sc.Body.tube(6.0, bore=0.8),
        sc.Body.balls(),
    )
    disk, rounded = sc.measured(**size), sc.measured(**size, fillet=0.002)
    stone = sc.Ellipsoid.rattleback((0.08, 0.016, 0.014), twist=0.05).in_metres(0.05)
    coin = sc.measured(outer_diameter=0.02575, length=0.0022, mass=0.0085)
    leaning = coin.steady(np.radians(40))
    whirr = sc.loss.DryContour.from_si(1e-4, scale=coin)
    return {
        "rolling cylinder of radius 1 m": made(
            cylinder, cylinder.steady(1.3).kicked(0.02)
        ),
        "rolling PVC tube": made(
            pipe,
            pipe.steady(np.radians(85)).kicked(0.02),
            scale=sc.Scale(7.9375e-3, mass=0.02),
        ),
        "rolling Euler's disk, sharp rim": made(disk, disk.steady(0.3).kicked(0.02)),
        "rolling Euler's disk, rounded rim": made(
            rounded, rounded.steady(0.3).kicked(0.02)
        ),
        "rolling Hurricane balls": made(
            balls,
            balls.steady(np.radians(78)).kicked(0.02),
            scale=sc.Scale(0.008, mass=0.033),
        ),
        "rolling rattleback": made(stone, stone.spinning(hertz=-1.0, pitch=0.02)),
        "rolling coin that loses energy": made(
            coin, leaning.kicked(0.05), losses=whirr
        ),
        "coin that slips": made(
            coin,
            coin.with_centre_velocity(leaning, 0.0, 1.0),
            contact=sc.Coulomb(0.3, static=0.3),
        ),
    }


def with_defaults(model: mujoco.MjModel, second: float) -> None:
    """Give a model MuJoCo's defaults, which are meant for a scene of about a metre."""
    model.opt.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_EULER
    model.opt.impratio, model.opt.noslip_iterations = 1.0, 0
    for solref, solimp in (
        (model.geom_solref, model.geom_solimp),
        (model.pair_solref, model.pair_solimp),
    ):
        solref[:], solimp[:] = (0.02 * second, 1.0), (0.9, 0.95, 0.001, 0.5, 2.0)
    model.opt.timestep = 0.002 * second


def finer(model: mujoco.MjModel, times: int) -> None:
    """Shorten the step of a model; its contact becomes as stiff as the shorter step allows."""
    model.opt.timestep /= times
    for solref in (model.geom_solref, model.pair_solref):
        solref *= (times**2, times)


def mujoco_run(scene: sc.Scene, times: int) -> tuple[sc.Deviation, float, int, float]:
    """Run MuJoCo: deviation, processor seconds, steps, time reached; with its defaults if `times` is 0."""
    model = mujoco.MjModel.from_xml_string(scene.mjcf)
    if times:
        finer(model, times)
    else:
        with_defaults(model, scene.data["scale"]["second"])
    state = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, state, 0)
    until, lossy = scene.data["expected"]["time"][-1], scene.motion.losses is not None
    clock: list[float] = []
    x, q, force = [], [], np.zeros(6)
    began = time.process_time()
    while state.time < until and (not clock or state.time > clock[-1]):
        clock.append(state.time)
        x.append(state.qpos[:3].copy())
        q.append(state.qpos[3:7].copy())
        if lossy:  # MuJoCo does not have this law
            normal = 0.0
            for i in range(state.ncon):
                mujoco.mj_contactForce(model, state, i, force)
                normal += force[0]
            w = state.xmat[1].reshape(3, 3) @ state.qvel[3:6]
            couple = scene.couple(q[-1], w, normal, scalar_first=True)
            state.xfrc_applied[1, 3:] = couple
        mujoco.mj_step(model, state)
    took = time.process_time() - began
    return scene.compare(clock, x, q, scalar_first=True), took, len(clock), clock[-1]


def ours(scene: sc.Scene, steps: int) -> tuple[float, float]:
    """Error of RK4 with this number of steps, and its processor seconds."""
    m = scene.motion
    began = time.process_time()
    rk4 = sc.roll(m.body, m.start, m.t, step=m.t[-1] / steps)
    took = time.process_time() - began
    return float(np.abs(rk4.theta - m.theta).max()), took


def rows(name: str, scene: sc.Scene, seconds: float) -> list[list[str]]:
    """Rows for one scene: name, solver, steps, deviations of the inclination and of the centre, time."""
    found = []
    solvers = {
        "its default step and contact": 0,
        "the step and contact of the MJCF file": 1,
        "a quarter of the step of the MJCF file": 4,
    }
    for what, times in solvers.items():
        off, took, steps, until = mujoco_run(scene, times)
        gave_up = f", to {until:.2g} s" if until < 0.99 * seconds else ""
        found.append(
            [
                name,
                f"MuJoCo with {what}{gave_up}",
                f"{steps}",
                f"{np.abs(off.theta).max():.2g} rad",
                f"{float(f'{1000 * off.position.max():.2g}'):g} mm",
                f"{1e3 * took:.0f} ms",
            ]
        )
    m = scene.motion
    if m.contact == "rolling" and m.losses is None and isinstance(m.body, sc.Body):
        steps = round(float(m.t[-1]) / 5e-4)
        wrong, took = ours(scene, steps)
        less = f"{wrong:.0e} rad" if wrong > m.error else f"below {m.error:.0e} rad"
        found.append(
            [
                name,
                "RK4 of spincyl, fixed step",
                f"{steps}",
                less,
                "",
                f"{1e3 * took:.1f} ms",
            ]
        )
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--seconds", type=float, default=1.0, help="duration of each scene (default: 1)"
    )
    parser.add_argument(
        "--save", metavar="FOLDER", help="also write the scenes as JSON and MJCF"
    )
    parser.add_argument(
        "--docs",
        metavar="PAGE",
        help="write the table into a page, below the comment that names this script",
    )
    args = parser.parse_args()
    head = [
        "scene",
        "solver",
        "number of time steps in the scene",
        "largest error of the inclination",
        "largest error of the position of the centre",
        "processor time",
    ]
    table = ["| " + " | ".join(head) + " |", "| --- " * len(head) + "|"]
    made = scenes(args.seconds)
    for name, scene in made.items():
        if args.save:
            folder = Path(args.save)
            folder.mkdir(parents=True, exist_ok=True)
            plain = name.replace(",", "")
            scene.save(folder / plain.replace(" ", "_").replace("'", ""))
        table += [
            "| " + " | ".join(row) + " |" for row in rows(name, scene, args.seconds)
        ]
    text = "\n".join(table)
    print(text)
    errors = [scene.data["error"] for scene in made.values()]
    theta, place = (max(x[key] for x in errors) for key in ("theta", "position"))
    print(
        f"estimated errors of the exact solution: {theta:.0e} rad, {1000 * place:.0e} mm"
    )
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
