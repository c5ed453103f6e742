"""Run Bullet and Drake on scenes that are read from their JSON files; spincyl is not imported here.

    pip install pybullet drake
    python examples/contact_engine.py --seconds 0.5 --save scenes
    python benches/engines.py scenes [--docs docs/engines.md]

The contact is as stiff as each engine allows, with three lengths of the step. Drake has two solvers for dry friction:
"sap", which solves a convex problem, and "lagged", which does not. The table has the largest deviations at the times
of the file.
"""

import argparse
import json
from pathlib import Path

import numpy as np

#: steps between two times of the file
STEPS = (20, 80, 320)
SCENES = ("rolling_cylinder_of_radius_1_m", "coin_that_slips", "rolling_rattleback")


def off(data, poses):
    """Largest deviations of the centre and of the inclination, from positions and rotation matrices."""
    known = data["expected"]
    centre = max(np.linalg.norm(x - y) for (x, _), y in zip(poses, known["position"], strict=True))
    axes = (turn[:, 2] for _, turn in poses)
    theta = [np.arctan2(np.hypot(a[0], a[1]), a[2]) for a in axes]
    return centre, np.abs(np.array(theta) - known["theta"]).max()


def bullet(data, steps):
    """Poses at the times of the file; None if Bullet does not have the shape."""
    import pybullet as p

    body, start, shape = data["body"], data["start"], data["body"]["shape"]
    if shape["type"] != "cylinder" or shape["swollen_by"]:
        return None
    p.connect(p.DIRECT)
    p.setGravity(*data["gravity"])
    table = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    form = p.createCollisionShape(p.GEOM_CYLINDER, radius=shape["radius"], height=2 * shape["half_length"])
    it = p.createMultiBody(
        body["mass"], form, basePosition=start["position"], baseOrientation=start["orientation"]
    )
    # Bullet multiplies the coefficients of the two bodies
    mu = float(np.sqrt(data["table"]["friction"]["mu"]))
    still = {"rollingFriction": 0, "spinningFriction": 0, "linearDamping": 0, "angularDamping": 0}
    sharp = {"collisionMargin": 0, "contactProcessingThreshold": 0}
    for each in (table, it):
        p.changeDynamics(each, -1, lateralFriction=mu, restitution=0, **still, **sharp)
    moments = np.diag(body["inertia"]).tolist()
    p.changeDynamics(it, -1, localInertiaDiagonal=moments, maxJointVelocity=1e6)
    p.resetBaseVelocity(it, start["velocity"], start["angular_velocity"])
    t = data["expected"]["time"]
    solver = {"numSolverIterations": 200, "solverResidualThreshold": 0, "enableConeFriction": 1}
    p.setPhysicsEngineParameter(fixedTimeStep=(t[1] - t[0]) / steps, **solver)
    found = []
    for i in range(len(t)):
        for _ in range(steps if i else 0):
            p.stepSimulation()
        x, q = p.getBasePositionAndOrientation(it)
        found.append((np.array(x), np.reshape(p.getMatrixFromQuaternion(q), (3, 3))))
    p.disconnect()
    return found


def drake(data, steps, solver):
    """Poses at the times of the file."""
    import pydrake.all as d

    body, start, shape, t = data["body"], data["start"], data["body"]["shape"], data["expected"]["time"]
    builder = d.DiagramBuilder()
    how = d.MultibodyPlantConfig(
        time_step=(t[1] - t[0]) / steps, discrete_contact_approximation=solver, contact_model="point"
    )
    plant, _ = d.AddMultibodyPlant(how, builder)
    per = np.array(body["inertia"]) / body["mass"]
    unit = d.UnitInertia(*(per[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))))
    it = plant.AddRigidBody("body", d.SpatialInertia(body["mass"], np.zeros(3), unit))
    mu, weight = data["table"]["friction"]["mu"], body["mass"] * -data["gravity"][2]
    touch = d.ProximityProperties()
    d.AddContactMaterial(
        dissipation=50.0,
        point_stiffness=1e6 * weight / shape["radius"],
        friction=d.CoulombFriction(mu, mu),
        properties=touch,
    )
    if shape["type"] == "ellipsoid":
        form, place = d.Ellipsoid(*shape["semi_axes"]), shape["centre"]
    else:
        form, place = d.Cylinder(shape["radius"], 2 * shape["half_length"]), np.zeros(3)
    plant.RegisterCollisionGeometry(it, d.RigidTransform(place), form, "body", touch)
    plant.RegisterCollisionGeometry(plant.world_body(), d.RigidTransform(), d.HalfSpace(), "table", touch)
    plant.mutable_gravity_field().set_gravity_vector(data["gravity"])
    plant.Finalize()
    simulator = d.Simulator(builder.Build())
    context = plant.GetMyContextFromRoot(simulator.get_mutable_context())
    q = np.roll(start["orientation"], 1)
    pose = d.RigidTransform(d.Quaternion(q / np.linalg.norm(q)), start["position"])
    plant.SetFreeBodyPose(context, it, pose)
    speed = d.SpatialVelocity(start["angular_velocity"], start["velocity"])
    plant.SetFreeBodySpatialVelocity(it, speed, context)
    found = []
    for at in t:
        simulator.AdvanceTo(at)
        pose = plant.EvalBodyPoseInWorld(context, it)
        found.append((pose.translation(), pose.rotation().matrix()))
    return found


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="folder with the JSON files of the scenes")
    parser.add_argument("--docs", metavar="PAGE", type=Path, help="write the table into a page")
    args = parser.parse_args()
    head = [
        "scene",
        "engine (lagged, sap: contact solvers of Drake)",
        "time step",
        "largest error of the position of the centre",
        "largest error of the inclination",
    ]
    table = ["| " + " | ".join(head) + " |", "| --- " * len(head) + "|"]
    solvers = {
        "Bullet": bullet,
        "Drake, lagged": lambda data, steps: drake(data, steps, "lagged"),
        "Drake, sap": lambda data, steps: drake(data, steps, "sap"),
    }
    for scene in SCENES:
        data = json.loads((args.folder / f"{scene}.json").read_text())
        t = data["expected"]["time"]
        for name, solve in solvers.items():
            for steps in STEPS:
                poses = solve(data, steps)
                if poses is None:
                    break
                centre, theta = off(data, poses)
                cells = [
                    f"{1e6 * (t[1] - t[0]) / steps:.3g} µs",
                    f"{1000 * centre:.2g} mm",
                    f"{theta:.2g} rad",
                ]
                table.append("| " + " | ".join([scene.replace("_", " "), name, *cells]) + " |")
                print(table[-1], flush=True)
    if args.docs:
        mark = "<!-- written by benches/engines.py -->\n\n"
        before, after = args.docs.read_text(encoding="utf-8").split(mark)
        rest = after[after.index("\n\n") :]
        args.docs.write_text(before + mark + "\n".join(table) + rest, encoding="utf-8")


if __name__ == "__main__":
    main()
