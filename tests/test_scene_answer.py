"""The known answers of scenes, by an engine that reads their JSON and nothing else, and by the laws of conservation."""

import json
from itertools import pairwise

import numpy as np
import pytest
from engine_scenes import ALOFT, LOSSES, LOST, RUBBED, SCENES, scene_of
from newton import Engine, Pose
from scipy.spatial.transform import Rotation

import spincyl as sc

COLUMNS = dict(zip(Pose._fields, ("position", "orientation", "velocity", "angular_velocity"), strict=True))
ERRORS = dict(zip(Pose._fields, ("position", "angle", "velocity", "angular_velocity"), strict=True))
KINDS = "rolling", "slipping", "flying"


def read(scene):
    """The data as a program reads them, with arrays for columns."""
    data = json.loads(json.dumps(scene.data, allow_nan=False))
    known = data["expected"]
    columns = {
        k: np.array(x, float)
        for k, x in known.items()
        if isinstance(x, list) and k not in ("phases", "impacts")
    }
    return data, known | columns


def poses(known):
    return [Pose(*rows) for rows in zip(*(known[name] for name in COLUMNS.values()), strict=True)]


def pieces(data, known):
    """Kind, and numbers of the rows, of each part of the answer in which the velocities do not jump."""
    t, phases = known["time"], data["expected"]["phases"]
    least = data["error"]["times_of_phases_and_impacts"]
    jumps = [x["time"] for x in data["expected"].get("impacts", [])]
    ends = [x["time"] for x in phases[1:]] + [np.inf]
    for phase, end in zip(phases, ends, strict=True):
        cuts = [phase["time"], *(x for x in jumps if phase["time"] < x < end), end]
        for a, b in pairwise(cuts):
            first = t[0] if a <= t[0] else a + least
            rows = np.flatnonzero((t >= first) & (t <= b - least))
            if rows.size > 1:
                yield phase["kind"], rows


def apart(a, b):
    """How far two poses are from each other, number by number; of orientations the angle."""
    found = {name: np.linalg.norm(x - y) for name, x, y in zip(Pose._fields, a, b, strict=True)}
    return found | {"q": 2 * min(np.linalg.norm(a.q - b.q), np.linalg.norm(a.q + b.q))}


@pytest.mark.parametrize("name", SCENES)
def test_newton_and_euler_carry_every_row_to_the_next_and_ask_for_the_same_force(name):
    data, known = read(scene_of(name))
    engine, rows, seen = Engine(data), poses(known), 0
    for kind, at in pieces(data, known):
        if kind not in KINDS:
            continue
        seen += 1
        fine, rough = (engine.carried(rows[at[0]], known["time"][at], kind, tol) for tol in (1e-13, 1e-11))
        for i, pose, other in zip(at, fine, rough, strict=True):
            off, spare = apart(pose, rows[i]), apart(pose, other)
            for number, error in ERRORS.items():
                size = np.linalg.norm(rows[i][Pose._fields.index(number)])
                assert off[number] <= 2 * data["error"][error] + spare[number] + 1e-13 * size, (number, kind)
            force, *_ = engine.force(rows[i], kind)
            weight = data["body"]["mass"] * engine.gravity
            claim = data["error"]["contact_force"] + 1e-11 * (weight + np.linalg.norm(force))
            assert np.linalg.norm(force - known["contact_force"][i]) <= claim
            assert abs(force[2] - known["normal_force"][i]) <= claim
            slip, friction = np.linalg.norm(engine.slip(rows[i])), data["table"]["friction"]
            if kind == "rolling":
                assert slip <= 2 * data["error"]["velocity"]
                most = friction.get("static", friction.get("mu"))
                assert most is None or np.linalg.norm(force[:2]) <= most * force[2] * (1 + 1e-9) + claim
            if kind != "flying":
                assert force[2] > 0
                arm, _ = engine.lowest(Rotation.from_quat(rows[i].q).as_matrix(), rows[i].w)
                assert abs((rows[i].x + arm)[2]) <= data["error"]["position"]
                assert np.allclose(
                    (rows[i].x + arm), known["contact_point"][i], atol=2 * data["error"]["position"]
                )
    assert seen or name == "lies"


def test_the_engine_sees_a_wrong_sign_a_wrong_mass_and_a_wrong_coefficient():
    for name, where, key in (
        ("tube", ("body", "inertia"), 0),
        ("slipping coin", ("table", "friction"), "mu"),
        ("dry contour", ("table", "losses"), 0),
        ("rattleback slips", ("body", "shape", "semi_axes"), 1),
        ("patch", ("table", "friction"), "patch"),
        ("viscous film", ("table", "friction"), "c"),
    ):
        data, known = read(scene_of(name))
        place = data
        for word in where:
            place = place[word]
        if isinstance(place[key], dict):
            place[key]["value"] *= 1.001
        else:
            place[key] = (1.001 * np.array(place[key])).tolist()
        kind, at = next(pieces(data, known))
        end = Engine(data).carried(poses(known)[at[0]], known["time"][at], kind)[-1]
        off = apart(end, poses(known)[at[-1]])
        assert max(off[k] / data["error"][ERRORS[k]] for k in off) > 1e3, name


@pytest.mark.parametrize("name", SCENES)
def test_its_energy_is_that_of_a_rigid_body_and_what_it_loses_is_told(name):
    data, known = read(scene_of(name))
    mass, inertia, g = data["body"]["mass"], np.array(data["body"]["inertia"]), -data["gravity"][2]
    turned = Rotation.from_quat(known["orientation"])
    w = turned.inv().apply(known["angular_velocity"])
    kinetic = mass * (known["velocity"] ** 2).sum(1) / 2 + np.einsum("ni,ij,nj->n", w, inertia, w) / 2
    energy = kinetic + mass * g * known["position"][:, 2]
    scale = np.abs(energy).max()
    assert np.allclose(energy, known["energy"], rtol=0, atol=data["error"]["energy"] + 1e-13 * scale)
    lost = sum(known.get(x, 0.0) for x in ("heat_of_slip", "lost_by_losses", "lost_in_impacts"))
    claim = 2 * data["error"]["energy"] + 2 * data["error"]["heat_and_losses"] + 1e-13 * scale
    assert np.abs(energy + lost - energy[0]).max() <= claim
    if name in RUBBED or name in LOST or name in ("hops", "lies"):
        assert (np.diff(lost) >= -data["error"]["heat_and_losses"]).all() and lost[-1] > 1e-6 * scale
    assert np.allclose(w[0], data["start"]["angular_velocity_in_body_axes"], rtol=1e-13, atol=1e-13)
    assert all((known[name][0] == data["start"][name]).all() for name in COLUMNS.values())
    # what the table does to energy is what friction and losses take
    assert known["theta"] == pytest.approx(np.arccos(turned.as_matrix()[:, 2, 2].clip(-1, 1)), abs=1e-7)


@pytest.mark.parametrize("name", ["lies", "hops", "egg", "viscous", "dropped on ice"])
def test_velocities_are_the_derivatives_of_the_poses(name):
    scene = scene_of(name)
    m, second = scene.motion, scene.data["scale"]["second"]
    middle = np.array([0.31, 0.52, 0.83]) * m.t[-1]
    h = 2e-4
    there = m.at(np.unique(np.concatenate([[m.t[0]], middle - h, middle, middle + h])))
    dense = sc.scene(there, scale=scene.scale)
    data, known = read(dense)
    assert {x["kind"] for x in data["expected"]["phases"]} >= ({"lying"} if name == "lies" else set())
    h *= second
    for i in (1, 4, 7):
        before, here, after = (poses(known)[i + k] for k in range(3))
        speed = np.linalg.norm(here.w) + np.linalg.norm(here.v)
        assert np.allclose((after.x - before.x) / (2 * h), here.v, atol=1e-5 * speed)
        turned = (Rotation.from_quat(after.q) * Rotation.from_quat(before.q).inv()).as_rotvec() / (2 * h)
        assert np.allclose(turned, here.w, atol=1e-5 * speed)


@pytest.mark.parametrize("name", ALOFT)
def test_flights_are_parabolas_and_impacts_push_upwards_as_hard_as_they_say(name):
    data, known = read(scene_of(name))
    mass, g, e = data["body"]["mass"], -data["gravity"][2], data["table"]["restitution"]
    impacts, t = data["expected"]["impacts"], known["time"]
    begins = np.array([x["time"] for x in data["expected"]["phases"]])
    kinds = [x["kind"] for x in data["expected"]["phases"]]
    flies = np.array([kinds[max(0, np.searchsorted(begins, x, "right") - 1)] == "flying" for x in t])
    times = np.array([x["time"] for x in impacts])
    checked = 0
    for i in range(t.size - 1):
        inside = np.flatnonzero((times > t[i]) & (times < t[i + 1]))
        only = all(k == "flying" for b, k in zip(begins, kinds, strict=True) if t[i] < b < t[i + 1])
        if not (flies[i] and flies[i + 1] and only):
            continue
        pushed = sum(impacts[k]["normal_impulse"] for k in inside)
        gained = mass * (known["velocity"][i + 1, 2] - known["velocity"][i, 2] + g * (t[i + 1] - t[i]))
        assert gained == pytest.approx(pushed, abs=mass * (1e-11 + 4 * data["error"]["velocity"]))
        checked += 1
    assert checked > 10 or name == "lies"
    assert 0 <= e <= 1 and all(x["normal_impulse"] >= 0 and x["energy_lost"] >= -1e-15 for x in impacts)
    lost = np.array([0.0, *np.cumsum([x["energy_lost"] for x in impacts])])
    assert np.allclose(known["lost_in_impacts"], lost[np.searchsorted(times, t)], atol=1e-15)
    assert (known["height"] >= 0).all() and (known["height"][flies] > 0).any() == flies.any()
    assert np.isnan(known["contact_point"][flies]).all() and (known["contact_force"][flies] == 0).all()


def test_a_tube_that_lies_touches_with_both_rims_which_bear_its_weight():
    data, known = read(scene_of("lies"))
    assert (
        {"lying"}
        <= {x["kind"] for x in data["expected"]["phases"]}
        <= {"lying", "pivoting", "rolling on its side"}
    )
    weight, axis = (
        data["body"]["mass"] * -data["gravity"][2],
        Rotation.from_quat(known["orientation"]).as_matrix()[:, :, 2],
    )
    assert np.abs(axis[:, 2]).max() < 1e-11
    assert np.allclose(known["position"][:, 2], data["body"]["shape"]["radius"], rtol=1e-11)
    assert np.allclose(known["normal_force"], weight, rtol=1e-10)
    assert np.isnan(known["contact_force"]).all() and np.isnan(known["contact_point"]).all()


@pytest.mark.parametrize("name", LOSSES)
def test_a_couple_for_an_engine_is_that_of_the_formula_and_of_the_unit(name):
    scene, law = scene_of(name), LOSSES[name]
    data, known = read(scene)
    engine, told = Engine(data), data["table"]["losses"][0]
    for i in (0, 5, 12):
        pose = poses(known)[i]
        turn = Rotation.from_quat(pose.q).as_matrix()
        for normal in (0.05, 1.3):
            mine = scene.couple(pose.q, pose.w, normal)
            assert np.allclose(
                mine, engine.couple(turn, pose.w, normal), rtol=1e-12, atol=1e-15 * np.abs(mine).max()
            )
            assert mine @ pose.w < 0
    first = scene.couple(np.roll(pose.q, 1), pose.w, 1.3, scalar_first=True)
    assert (first == mine).all()
    in_air = scene.couple(pose.q, pose.w, 0.0)
    assert (np.abs(in_air).max() > 0) == (name in ("linear air", "quadratic air"))
    # from_si takes the coefficient of the file; that of the boundary layer is made of three of its numbers
    if name != "boundary layer":
        assert told["value"] == pytest.approx(law.in_si(scene.scale), rel=1e-12)
    else:
        made = law.in_si(scene.scale) * np.sqrt(1.2 * 1.8e-5) * scene.scale.radius**4
        assert told["value"] == pytest.approx(made, rel=1e-12)
    assert scene_of("tube").couple(pose.q, pose.w, 1.0).tolist() == [0, 0, 0]
