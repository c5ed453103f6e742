"""Scenes with a known solution: consistent in themselves, and read by a real contact engine."""

import json
import pathlib
import re
import subprocess
import sys

import eulers_disk
import mujoco
import numpy as np
import nutating_cylinder
import pytest
from page_scenes import BALLS, CAPSULE, CYLINDER, PIPE, ROUNDED, TIPPE
from scipy.spatial.transform import Rotation

import spincyl as sc

ROOT = pathlib.Path(__file__).parents[1]
APART = sc.Body.balls(1.5)
EULER = sc.Body.from_metres(outer_diameter=0.0751, length=0.0128)
SCENES = {
    "cylinder": lambda: sc.scene(CYLINDER, nutating_cylinder.start),
    "tube": lambda: sc.scene(
        PIPE, PIPE.steady(np.radians(85)), scale=sc.Scale(7.9375e-3, mass=0.02, gravity=9.81), seconds=0.2
    ),
    "Euler's disk": lambda: sc.scene(
        EULER, EULER.steady(0.3).kicked(0.1), scale=sc.Scale(0.03755, mass=0.44)
    ),
    "rolling coin": lambda: sc.scene(EULER, EULER.circular(1.2, 0.3)),
    "NumPy's numbers": lambda: sc.scene(
        sc.Body.tube(np.float64(2.0), np.float64(0.5)),
        sc.Body.tube(2.0, 0.5).steady(np.float64(1.3)),
        scale=sc.Scale(np.float64(0.5)),
        seconds=np.float64(0.5),
        mu=np.float32(0.5),
    ),
    "rounded can": lambda: sc.scene(ROUNDED, ROUNDED.steady(1.3).kicked(0.05)),
    "rounded coin": lambda: sc.scene(
        eulers_disk.body, eulers_disk.start, scale=sc.Scale(0.03755, mass=0.44), seconds=0.2
    ),
    "capsule": lambda: sc.scene(CAPSULE, CAPSULE.steady(1.35).kicked(0.05)),
    "Hurricane balls": lambda: sc.scene(
        BALLS, BALLS.steady(np.radians(78)), scale=sc.Scale(0.008, mass=0.033)
    ),
    "balls on a rod": lambda: sc.scene(APART, APART.steady(np.radians(85)).kicked(0.02)),
    "tippe top": lambda: sc.scene(TIPPE, sc.State(0.6, 1.0, 0.0, 2.0), mu=5.0),
    "round on ice": lambda: sc.scene(ROUNDED, ROUNDED.steady(1.3).kicked(0.05), contact="smooth"),
    "on ice": lambda: sc.scene(CYLINDER, nutating_cylinder.start, contact="smooth"),
}


@pytest.fixture(params=list(SCENES))
def scene(request):
    return SCENES[request.param]()


def test_a_rigid_body_with_these_numbers_touches_the_table_with_a_resting_point(scene):
    data = json.loads(json.dumps(scene.data))
    body, start = data["body"], data["start"]
    axes = Rotation.from_quat(start["orientation"])
    axis = axes.as_matrix()[:, 2]
    arm = lowest_place(body, axis)
    lowest = np.array(start["position"]) + arm
    assert lowest[2] == pytest.approx(0.0, abs=1e-12 * body["radius"])
    velocity = np.array(start["velocity"]) + np.cross(start["angular_velocity"], arm)
    speed = np.linalg.norm(start["angular_velocity"]) * body["radius"]
    assert velocity[2] == pytest.approx(0.0, abs=1e-12 * speed)
    if data["table"]["friction"] > 0:
        assert np.abs(velocity).max() < 1e-12 * speed
    else:
        assert start["velocity"][:2] == [0.0, 0.0]
    local = axes.inv().apply(start["angular_velocity"])
    assert np.allclose(local, start["angular_velocity_in_body_axes"], rtol=1e-13, atol=1e-13 * speed)


def lowest_place(body, axis):
    """Vector from the centre of mass to the lowest point of the body, from its measures."""
    down = np.array([0, 0, -1.0])
    rim = down - (down @ axis) * axis
    rim /= np.linalg.norm(rim)
    if "core" not in body:
        return -body["half_length"] * axis + body["radius"] * rim
    core = body["core"]
    places = [end[2] * axis + core["radius"] * rim + core["swollen_by"] * down for end in core["ends"]]
    return min(places, key=lambda place: place[2])


def test_its_energy_is_that_of_a_rigid_body_and_does_not_change(scene):
    data = scene.data
    body, start, expected = data["body"], data["start"], data["expected"]
    w = np.array(start["angular_velocity_in_body_axes"])
    kinetic = 0.5 * body["mass"] * np.dot(start["velocity"], start["velocity"]) + 0.5 * np.dot(
        body["inertia"], w * w
    )
    height = start["position"][2]
    energy = kinetic - body["mass"] * data["gravity"][2] * height
    assert np.allclose(expected["energy"], energy, rtol=1e-12)


def test_its_poses_agree_with_its_inclinations_and_its_force_carries_the_body(scene):
    m = scene.motion
    close = sc.scene(
        m.body,
        m.start,
        scale=scene.scale,
        seconds=0.02 * float(scene.scale.seconds(m.t[-1])),
        points=1001,
        contact=m.contact,
    )
    data = close.data
    expected = {k: np.array(v) for k, v in data["expected"].items() if isinstance(v, list)}
    axis = Rotation.from_quat(expected["orientation"]).as_matrix()[:, :, 2]
    assert np.allclose(np.arccos(axis[:, 2]), expected["theta"], atol=1e-12)
    # M z'' = N - M g, by finite differences of the heights
    z, t = expected["position"][:, 2], expected["time"]
    lift = np.gradient(np.gradient(z, t, edge_order=2), t, edge_order=2)[3:-3]
    force = expected["normal_force"][3:-3] / data["body"]["mass"] + data["gravity"][2]
    assert np.abs(lift - force).max() < 0.02 * np.abs(force).max() + 1e-6 * abs(data["gravity"][2])
    assert 0 < data["error"]["theta"] < 1e-9
    # velocities are derivatives of the poses
    position, start = expected["position"], data["start"]
    h = expected["time"][1]
    velocity = (-1.5 * position[0] + 2 * position[1] - 0.5 * position[2]) / h
    speed = np.linalg.norm(start["angular_velocity"]) * data["body"]["radius"]
    assert np.allclose(velocity, start["velocity"], atol=1e-4 * speed)
    turned = Rotation.from_quat(expected["orientation"])
    first, second = ((turned[k] * turned[0].inv()).as_rotvec() for k in (1, 2))
    w = (2 * first - 0.5 * second) / h
    assert np.allclose(w, start["angular_velocity"], atol=1e-4 * np.linalg.norm(w))


def test_mujoco_reads_it_and_starts_where_we_do(scene):
    model = mujoco.MjModel.from_xml_string(scene.mjcf)
    state = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, state, 0)
    mujoco.mj_forward(model, state)
    data = scene.data
    assert model.body_mass[1] == data["body"]["mass"]
    assert np.allclose(np.sort(model.body_inertia[1]), np.sort(data["body"]["inertia"]), rtol=1e-12)
    assert model.opt.gravity[2] == data["gravity"][2]
    assert np.allclose(state.qpos[:3], data["start"]["position"])
    assert np.arccos(state.xmat[1][8]) == pytest.approx(data["expected"]["theta"][0], abs=1e-9)
    assert state.energy.sum() == pytest.approx(data["expected"]["energy"][0], rel=1e-12)
    gaps = [c.dist - c.includemargin for c in state.contact]
    assert abs(min(gaps, default=0.0)) < 1e-9 * data["body"]["radius"]
    # pushed slightly into the table, the engine finds this depth, at the contact point of the solution
    deep = 1e-6 * data["body"]["radius"]
    state.qpos[2] -= deep
    mujoco.mj_forward(model, state)
    felt = min(state.contact, key=lambda c: c.dist - c.includemargin)
    assert felt.dist - felt.includemargin == pytest.approx(-deep, rel=1e-3)
    assert np.abs(felt.pos).max() < 2 * deep


def deviation(scene, seconds, spin=1.0):
    model = mujoco.MjModel.from_xml_string(scene.mjcf)
    state = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, state, 0)
    state.qvel[3] *= spin
    off = 0.0
    expected = scene.data["expected"]
    while state.time < seconds:
        mujoco.mj_step(model, state)
        theta = np.arccos(state.xmat[1][8])
        off = max(off, abs(theta - np.interp(state.time, expected["time"], expected["theta"])))
    return off


@pytest.mark.parametrize("name", ["cylinder", "rounded can", "capsule", "balls on a rod"])
def test_mujoco_follows_it_for_a_while_and_not_with_a_wrong_sign(name):
    scene = SCENES[name]()
    assert deviation(scene, 0.6) < 0.02 < 0.2 < deviation(scene, 0.6, spin=-1.0)


def test_it_is_written_as_json_and_mjcf(tmp_path, scene):
    paths = scene.save(tmp_path / "a scene")
    assert [p.name for p in paths] == ["a scene.json", "a scene.xml"]
    assert json.loads(paths[0].read_text()) == scene.data
    mujoco.MjModel.from_xml_path(str(paths[1]))
    with pytest.raises(OSError, match="nowhere"):
        scene.save(tmp_path / "nowhere" / "x")


def test_a_disk_without_thickness_has_a_scene_but_not_for_mujoco(tmp_path):
    coin = sc.Body.solid(0.0)
    scene = sc.scene(coin, coin.steady(0.5))
    assert [p.suffix for p in scene.save(tmp_path / "coin")] == [".json"]
    with pytest.raises(ValueError, match="ell = 0"):
        scene.mjcf


def test_a_body_with_a_fillet_is_a_core_swollen_by_it():
    made = {name: SCENES[name]().data["body"] for name in SCENES if "ice" not in name}
    shapes = {name: (x["shape"], x["core"]["type"]) for name, x in made.items() if "core" in x}
    assert shapes == {
        "rounded can": ("cylinder with rounded edges on its lower rim", "cylinder"),
        "rounded coin": ("cylinder with rounded edges on its lower rim", "cylinder"),
        "capsule": ("capsule", "segment"),
        "Hurricane balls": ("two balls", "points"),
        "balls on a rod": ("two balls", "points"),
        "tippe top": ("ball", "points"),
    }
    for x in made.values():
        if "core" in x:
            core = x["core"]
            assert core["radius"] + core["swollen_by"] == pytest.approx(x["radius"])
            half = (core["ends"][-1][2] - core["ends"][0][2]) / 2 + core["swollen_by"]
            assert half == pytest.approx(x["half_length"])
    can = made["rounded can"]
    assert (can["half_length"], can["fillet"], can["height_over_rim"]) == pytest.approx((1.5, 0.3, 1.2))
    assert made["tippe top"]["core"]["ends"] == [[0.0, 0.0, 0.3]]


def test_what_mujoco_draws_of_a_rounded_body_is_the_hull_of_its_surface():
    scene = SCENES["rounded can"]()
    model = mujoco.MjModel.from_xml_string(scene.mjcf)
    start, n = model.mesh_vertadr[0], model.mesh_vertnum[0]
    places = Rotation.from_quat(np.roll(model.mesh_quat[0], -1)).apply(model.mesh_vert[start : start + n])
    places = places + model.mesh_pos[0]
    assert np.abs(places).max(axis=0) == pytest.approx([1.0, 1.0, 1.5], abs=1e-5)
    geom = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_GEOM, "looks")
    assert model.geom_contype[geom] == model.geom_conaffinity[geom] == 0, "it is only looked at"
    assert np.allclose(np.sort(model.body_inertia[1]), np.sort(scene.data["body"]["inertia"]), rtol=1e-12)


def test_a_torus_of_fillets_without_a_wall_has_a_scene_but_not_for_mujoco(tmp_path):
    torus = sc.Body(0.0, 0.6, 0.8, fillet=0.4)
    scene = sc.scene(torus, torus.circular(1.0, 0.8), seconds=0.1)
    assert [p.suffix for p in scene.save(tmp_path / "torus")] == [".json"]
    with pytest.raises(ValueError, match=r"fillet = 0\.4"):
        scene.mjcf


def test_a_scene_that_is_not_all_rolling_is_refused_and_told_how_it_ends():
    can = sc.Body.solid(1.0)
    for start, how, said in (
        (sc.State(0.3, 0.0, 0.0, 0.0), {}, "face landed"),
        (nutating_cylinder.start, {"mu": 0.01}, "mu = 0.0[0-9]+ would do"),
        (CYLINDER.steady(1.3), {"seconds": 0.0}, "seconds"),
        (CYLINDER.steady(1.3), {"points": 1}, "points"),
        (CYLINDER.steady(1.3), {"mu": np.inf}, "mu"),
        (CYLINDER.steady(1.3), {"contact": "icy"}, "contact"),
    ):
        with pytest.raises(ValueError, match=said):
            sc.scene(can if start.w1 == 0 else CYLINDER, start, **how)
    with pytest.raises(TypeError, match="scale"):
        sc.scene(CYLINDER, CYLINDER.steady(1.3), scale=1.0)
    # with the friction that the message proposes there is a scene, however few its times
    for points in (2, 3, 101):
        with pytest.raises(ValueError, match="would do") as caught:
            sc.scene(CYLINDER, nutating_cylinder.start, mu=0.01, seconds=2.0, points=points)
        enough = float(str(caught.value).split("mu = ")[1].split()[0])
        scene = sc.scene(CYLINDER, nutating_cylinder.start, mu=enough, seconds=2.0, points=points)
        assert 0.95 * enough < scene.data["expected"]["friction_coefficient_needed"] < enough


def test_energy_and_force_are_as_good_as_it_says(scene):
    m = scene.motion
    data = sc.scene(
        m.body, m.start, scale=scene.scale, seconds=float(scene.scale.seconds(m.t[-1])), contact=m.contact
    ).data
    # another method with steps ten times smaller
    other = sc.roll(m.body, m.start, m.t, tol=1e-13, contact=m.contact, want=("pose", "force"))
    weight = scene.scale.mass * scene.scale.gravity
    for name, mine, unit in (
        ("energy", other.energy, scene.scale.joules(1.0)),
        ("normal_force", other.normal, weight),
        ("contact_force", other.contact_force, weight),
    ):
        off = np.abs(np.array(data["expected"][name]) - mine * unit).max()
        spare = other.error / m.error
        assert off < data["error"][name] * (1 + spare) + 1e-13 * np.abs(mine * unit).max()
        assert data["error"][name] < 1e-6 * np.abs(mine * unit).max()


def test_a_name_with_a_point_stays_whole(tmp_path):
    scene = SCENES["cylinder"]()
    names = {p.name for name in ("mu0.3", "mu0.5.json") for p in scene.save(tmp_path / name)}
    assert names == {"mu0.3.json", "mu0.3.xml", "mu0.5.json", "mu0.5.xml"}


def test_the_script_prints_how_far_mujoco_and_we_deviate(tmp_path):
    words = [
        sys.executable,
        str(ROOT / "examples" / "contact_engine.py"),
        "--seconds",
        "0.02",
        "--save",
        "scenes",
    ]
    ran = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path, check=True)
    rows = ran.stdout.splitlines()
    assert len(rows) == 2 + 5 * 4 and sum("MuJoCo" in row for row in rows) == 10
    assert len(list((tmp_path / "scenes").iterdir())) == 10


@pytest.mark.parametrize("seed", range(4))
def test_the_friction_that_is_advised_would_do(seed):
    rng, advised = np.random.default_rng(seed), 0
    for _ in range(40):
        body = sc.Body.solid(rng.uniform(0.05, 3))
        state = sc.State(rng.uniform(0.1, 1.5), *rng.uniform((-3, -1, -6), (3, 1, 6)))
        try:
            sc.scene(body, state, seconds=0.3, mu=rng.uniform(0, 0.5))
        except ValueError as e:
            if found := re.search(r"mu = (\S+) would do$", str(e)):
                assert sc.scene(body, state, seconds=0.3, mu=float(found[1])).mu == float(found[1])
                advised += 1
            elif str(e).endswith("no mu would do"):
                with pytest.raises(ValueError, match="before 0.3 s are over"):
                    sc.scene(body, state, seconds=0.3, mu=1e12)
    assert advised > 2


def test_what_slips_and_a_stone_have_no_scene_and_what_is_advised_instead_works():
    body = sc.measured(outer_diameter=0.1, length=1.0, mass=1.0)
    slips = body.with_centre_velocity(sc.State(0.2, 0.3, 0.0, 2.0), 0.0, 0.0)
    of = "a scene is of a body that rolls, or slides on a smooth table"
    with pytest.raises(ValueError, match=rf"^state: slips, .*{of}.*restitution= makes one"):
        sc.scene(body, slips)
    assert sc.roll(body, slips, 0.1, contact=sc.Coulomb(0.2)).phases[0].kind == "slipping"
    for law in (sc.Coulomb(0.2), sc.Viscous(0.2)):
        for state in (slips, body.steady(1.5)):
            with pytest.raises(
                ValueError, match=rf"^contact = .*: expected 'rolling' or 'smooth': {of}.*mu= is"
            ):
                sc.scene(body, state, contact=law)
    stone = sc.Ellipsoid.rattleback((0.12, 0.06, 0.03), twist=0.35).in_metres(0.5)
    with pytest.raises(TypeError, match="^body: expected a Body, not Ellipsoid"):
        sc.scene(stone, stone.spinning(hertz=-1.0, pitch=0.01))
    with pytest.raises(TypeError, match="^state: expected a State, not EllipsoidState"):
        sc.scene(body, stone.spinning(hertz=-1.0, pitch=0.01))


def test_a_scene_goes_on_in_the_air_with_the_energy_of_its_start_and_the_impacts_of_the_motion():
    pipe, coin = sc.Body.tube(6.0, bore=0.8), sc.Body.solid(0.1)
    hops = sc.pressed(pipe, 12.0, np.radians(60), finger=0.3)
    falls = sc.dropped(coin, 2.0, 1.2, w1=1.0, w2=-0.4, w3=0.5, velocity=(0.3, 0.2, 0.1))
    scale = sc.Scale(0.01, mass=0.02)
    for body, start, restitution in ((pipe, hops, 0.5), (coin, falls, 0.3)):
        scene = sc.scene(body, start, scale=scale, mu=0.3, restitution=restitution, seconds=0.3)
        data, m = json.loads(json.dumps(scene.data, allow_nan=False)), scene.motion
        begins, expected = data["start"], data["expected"]
        v, w = (np.array(begins[x]) for x in ("velocity", "angular_velocity_in_body_axes"))
        moments = np.array(data["body"]["inertia"])
        energy = 0.02 * (v @ v / 2 + scale.gravity * begins["position"][2]) + moments @ w**2 / 2
        assert energy == pytest.approx(expected["energy"][0], rel=1e-13)
        assert len(expected["impacts"]) == len(m.impacts) > 10
        lost = sum(blow["energy_lost"] for blow in expected["impacts"])
        heat = scale.joules(m.dissipated[-1])
        assert energy - lost - heat == pytest.approx(expected["energy"][-1], rel=1e-12)
        assert data["table"]["restitution"] == restitution
        assert expected["height"][0] == pytest.approx(scale.metres(m.height[0]))
        assert "solref" in scene.mjcf
    # a softer blow needs more damping
    damping = [
        float(
            re.search(r'solref="\S+ -(\S+)"', sc.scene(pipe, hops, mu=0.3, restitution=e, seconds=0.1).mjcf)[
                1
            ]
        )
        for e in (0.0, 0.5, 1.0)
    ]
    assert damping[0] > damping[1] > 1e6 * damping[2] > 0
