"""Scenes for contact engines: what their files say, what is refused, and how an engine is compared."""

import json
import math
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
from engine_scenes import (
    ALOFT,
    COIN,
    EGG,
    EURO,
    LOST,
    PIPE,
    PRESSED,
    RATTLE,
    RUBBED,
    SCENES,
    THROWN,
    TUBE,
    rolled,
    scene_of,
)
from page_scenes import CYLINDER
from scipy.spatial.transform import Rotation

import spincyl as sc


def test_the_files_hold_strict_json_with_a_version_and_a_line_for_each_entry(tmp_path):
    for name in ("tube", "egg", "hops", "dry contour"):
        (path,) = scene_of(name).save(tmp_path / f"{name}.json")
        text = path.read_text()
        data = json.loads(text, parse_constant=lambda word: pytest.fail(word))
        assert (
            data == scene_of(name).data and next(iter(data)) == "spincyl-scene" and data["spincyl-scene"] == 1
        )
        assert max(map(len, text.splitlines())) > 1000 and len(text.splitlines()) < 140
        lengths = {
            len(x)
            for k, x in data["expected"].items()
            if isinstance(x, list) and k not in ("phases", "impacts")
        }
        assert lengths == {len(data["expected"]["time"])}


def test_the_suffix_says_which_file_is_written(tmp_path):
    scene = scene_of("tube")
    names = {p.name for name in ("mu0.3", "a.json", "b.xml", "c.XML") for p in scene.save(tmp_path / name)}
    assert (
        names
        == {"mu0.3.json", "mu0.3.xml", "a.json", "b.xml", "c.XML"}
        == {p.name for p in tmp_path.iterdir()}
    )
    assert (tmp_path / "b.xml").read_text() == (tmp_path / "c.XML").read_text() == scene.mjcf
    with pytest.raises(OSError, match="nowhere"):
        scene.save(tmp_path / "nowhere" / "x")
    for name in ("d.urdf", "e.URDF"):
        (path,) = scene.save(tmp_path / name)
        assert path.name == name and path.read_text("utf-8") == scene.urdf
    for name in ("x.sdf", "x.usd", "x.mjcf"):
        with pytest.raises(ValueError, match=r"^path = .*: expected a name without ending, or .*\.urdf"):
            scene.save(tmp_path / name)
    assert not [*tmp_path.glob("x.*")]


def test_a_body_is_told_as_what_it_touches_with():
    told = {name: scene_of(name).data["body"]["shape"] for name in SCENES}
    kinds = {
        "tube": "cylinder", "rounded can": "cylinder", "capsule": "capsule", "Hurricane balls": "balls",
        "balls on a rod": "balls", "tippe top": "ball", "disk": "rim", "torus": "rim", "glass": "circles",
        "spool": "cylinder", "top": "circles", "egg": "ellipsoid",
    }  # fmt: skip
    assert {name: told[name]["type"] for name in kinds} == kinds
    tube, can, top = (told[name] for name in ("tube", "rounded can", "tippe top"))
    assert (tube["radius"], tube["inner_radius"], tube["half_length"]) == pytest.approx(
        (7.9375e-3, 6.35e-3, 47.625e-3)
    )
    assert [x["height"] for x in tube["circles"]] == pytest.approx([-47.625e-3, 47.625e-3])
    assert can["circles"] == [{"height": -1.2, "radius": 0.7}, {"height": 1.2, "radius": 0.7}]
    assert (can["swollen_by"], can["half_length"], can["lands_at"]) == pytest.approx((0.3, 1.5, math.pi / 2))
    assert (top["circles"], top["swollen_by"]) == ([{"height": 0.3, "radius": 0.0}], 1.0)
    glass, body = told["glass"], scene_of("glass").motion.body
    assert glass["lands_at"] == pytest.approx(body.theta_end) and len(glass["circles"]) == 2
    assert glass["circles"][0]["height"] == pytest.approx(-0.03 * body.ell)
    stone = scene_of("rattleback").data["body"]
    assert stone["shape"]["semi_axes"] == pytest.approx([0.08, 0.016, 0.014])
    assert stone["shape"]["centre"] == pytest.approx([0.0, 0.0, 3 / 8 * 0.014])
    turned, inertia = np.array(stone["principal_axes"]), np.array(stone["inertia"])
    assert np.allclose(turned @ inertia @ turned.T, np.diag(stone["principal_moments"]), atol=1e-15)
    assert np.linalg.det(turned) == pytest.approx(1.0) and stone["mass"] == 0.05
    assert stone["principal_moments"] == pytest.approx(0.05 * 0.08**2 * RATTLE.moments)


def test_natural_units_are_a_metre_and_a_kilogram_unless_a_scale_says_more():
    m = sc.roll(COIN, COIN.steady(0.4), [0.0, 1.0, 2.0])
    plain, small = sc.scene(m).data, sc.scene(m, scale=EURO).data
    assert plain["scale"] == {"R": 1.0, "M": 1.0, "g": 9.80665, "second": math.sqrt(1 / 9.80665)}
    assert (small["body"]["mass"], small["body"]["shape"]["radius"]) == (0.0085, 0.012875)
    assert small["expected"]["time"][-1] == pytest.approx(2 * math.sqrt(0.012875 / 9.80665), rel=1e-15)
    moment = small["body"]["inertia"][2][2]
    assert moment == pytest.approx(0.0085 * 0.012875**2 / 2, rel=1e-14)
    own = sc.scene(sc.roll(TUBE, TUBE.steady(1.4), [0.0, 0.1])).data
    assert own["expected"]["time"] == [0.0, 0.1] and own["body"]["mass"] == 0.02


def test_the_friction_of_a_scene_is_that_of_its_motion():
    told = {
        name: scene_of(name).data["table"]["friction"]
        for name in (*RUBBED, "tube", "on ice", "dropped on rubber")
    }
    assert {k: told["from slip to roll"][k] for k in ("law", "mu", "static", "patch")} == {
        "law": "coulomb", "mu": 0.5, "static": 0.6, "patch": 0.0,
    }  # fmt: skip
    assert (
        told["viscous film"]["c"] == pytest.approx(1.0, rel=1e-14) and told["viscous film"]["unit"] == "s/m"
    )
    assert told["patch"]["patch"] == 0.05 and told["on ice"]["mu"] == 0.0
    assert 0 < told["tube"]["needed"] < told["tube"]["mu"] == 1.0
    assert told["dropped on rubber"]["needed"] is None and told["dropped on rubber"]["mu"] == 1000.0
    # it holds with what it has, and not with less than it needs
    needs = scene_of("cylinder")
    needed, body = needs.data["table"]["friction"]["needed"], needs.motion.body
    until = needs.motion.t[-1]
    ends = [sc.roll(body, needs.motion.start, until, mu=x * needed).status for x in (0.99, 1.01)]
    assert ends == [sc.Ending.SLIP, sc.Ending.DONE]
    assert rolled(CYLINDER, CYLINDER.steady(1.3), mu=0.7).data["table"]["friction"]["mu"] == 0.7
    steep = rolled(CYLINDER, sc.State(0.3, 2.0, 0.0, 0.0), 0.1).data["table"]["friction"]
    assert steep["mu"] == pytest.approx(max(1.0, 1.5 * steep["needed"]))
    grips = sc.roll(COIN, THROWN, [0.0, 0.5], contact=sc.Coulomb(0.3, static=np.inf))
    assert sc.scene(grips).data["table"]["friction"]["static"] is None


def test_events_and_the_end_have_their_times():
    fall = rolled(sc.Body.solid(1.0), sc.State(0.3, 0.0, 0.0, 0.0), 2.0)
    end = fall.data["expected"]["ending"]
    assert end["kind"] == "FACE" and end["why"].startswith("the face landed")
    assert end["time"] == pytest.approx(fall.scale.seconds(fall.motion.event.time))
    assert fall.data["expected"]["time"][-1] <= end["time"]
    mixed = scene_of("from slip to roll")
    phases = mixed.data["expected"]["phases"]
    assert [x["kind"] for x in phases][:2] == ["slipping", "rolling"]
    assert [x["time"] for x in phases] == pytest.approx(
        [mixed.scale.seconds(p.time) for p in mixed.motion.phases]
    )
    assert scene_of("on ice").data["expected"]["phases"] == [{"time": 0.0, "kind": "slipping"}]
    for name in ALOFT:
        scene = scene_of(name)
        told, known = scene.data["expected"]["impacts"], scene.motion.impacts
        assert [x["kind"] for x in told] == [x.kind for x in known]
        assert [x["time"] for x in told] == pytest.approx([scene.scale.seconds(x.time) for x in known])


def test_a_clock_that_begins_late_and_a_single_time_make_the_same_scene():
    start = COIN.steady(0.4).kicked(0.05)
    t = np.linspace(0, 2, 5)
    first = sc.scene(sc.roll(COIN, start, t)).data
    late = sc.scene(sc.roll(COIN, start, t + 7.0, t0=7.0)).data
    late_only = sc.scene(sc.roll(COIN, start, [8.0, 9.0], t0=7.0)).data["expected"]
    for key in ("time", "position", "orientation", "velocity"):
        assert np.allclose(late["expected"][key], first["expected"][key], atol=1e-13)
        assert np.allclose(late_only[key], np.array(first["expected"][key])[[0, 2, 4]], atol=1e-13)
    one = sc.scene(sc.roll(COIN, start, 2.0)).data["expected"]
    assert np.allclose(one["position"], np.array(first["expected"]["position"])[[0, 4]], atol=1e-13)
    law = sc.Coulomb(0.3)
    slides = sc.scene(sc.roll(COIN, THROWN, t + 7.0, contact=law)).data["expected"]
    assert slides["phases"] == sc.scene(sc.roll(COIN, THROWN, t, contact=law)).data["expected"]["phases"]


def test_what_has_no_answer_is_refused_and_says_why():
    can, weightless = sc.Body.solid(1.0), sc.measured(outer_diameter=0.02, length=0.1)
    upright = sc.roll(COIN, COIN.steady(0.4), [0.0, 1.0])
    for motion, how, said in (
        (sc.roll(CYLINDER, CYLINDER.steady(1.3), [1.0, 0.0]), {}, "^motion: expected ascending times"),
        (sc.roll(CYLINDER, CYLINDER.steady(1.3), [0.0, 0.0]), {}, "^motion: expected ascending times"),
        (
            sc.roll(CYLINDER, CYLINDER.steady(1.3), 0.0),
            {},
            "^motion: expected a time after the initial state",
        ),
        (sc.roll(can, sc.State(0.3, 0.0, 0.0, 0.0), 5.0), {}, "^motion: expected a time .*the face landed"),
        (
            sc.roll(can, sc.State(0.3, 0.9, 0.0, 0.0), 9.0, mu=0.01, beyond=True),
            {},
            "^motion: continues beyond",
        ),
        (sc.roll(weightless, weightless.steady(1.4), 1.0), {}, "^a force in SI needs the mass"),
        (
            sc.roll(TUBE, TUBE.steady(1.4), 1.0),
            {"scale": EURO},
            "^scale = .*: the measured body has another",
        ),
    ):
        with pytest.raises(ValueError, match=said):
            sc.scene(motion, **how)
    for wrong in (COIN, None, upright.states, [upright]):
        with pytest.raises(TypeError, match="^motion: expected a Motion"):
            sc.scene(wrong)
    with pytest.raises(TypeError, match="scale"):
        sc.scene(upright, scale=1.0)


def test_a_stone_that_is_not_known_to_its_end_has_no_scene():
    stone = sc.Ellipsoid.rattleback((0.06, 0.012, 0.01), twist=np.radians(3)).in_metres(0.02)
    start = stone.spinning(-8.0 * stone.scale.seconds(1.0), pitch=0.01, roll=0.01)
    with pytest.warns(sc.ErrorWarning):
        m = sc.roll(stone, start, np.linspace(0, 40, 41))
    with pytest.raises(
        ValueError, match="^motion: expected a motion known up to its last time: .*known to 1 % up to t = 2"
    ):
        sc.scene(m)
    known = sc.scene(m.at(np.linspace(0, 0.5 * m.known_until, 11)))
    assert known.data["error"]["angle"] < 1


def answer(scene, t):
    """The answer as an engine would give it: SI, at these seconds."""
    m = scene.motion.at(np.array(t) / scene.scale.seconds(1.0))
    return scene.scale.metres(m.centre), m.orientation


@pytest.mark.parametrize("name", ["tube", "rattleback slips", "hops", "lies", "dry contour", "dropped coin"])
def test_an_engine_that_is_right_has_no_deviation_and_one_that_is_wrong_has_its_own(name):
    scene = scene_of(name)
    t = np.linspace(0, scene.data["expected"]["time"][-1], 7)
    x, q = answer(scene, t)
    same = scene.compare(t, x, -q)
    assert same.position.max() == 0 == np.abs(same.theta).max() and same.angle.max() < 1e-15
    assert (same.position_error, same.angle_error) == pytest.approx(
        [scene.data["error"][k] for k in ("position", "angle")], rel=0.9
    )
    aside = Rotation.from_rotvec([0.0, 0.0, 0.01])
    off = scene.compare(t, x + np.array([0.0, 3e-4, 4e-4]), (aside * Rotation.from_quat(q)).as_quat())
    assert np.allclose(off.position, 5e-4, rtol=1e-9) and np.allclose(off.angle, 0.01, rtol=1e-9)
    assert np.abs(off.theta).max() < 1e-14, "an azimuth is no inclination"
    swapped = scene.compare(t, x, np.roll(q, 1, axis=1), scalar_first=True)
    assert (swapped.position == 0).all() and (swapped.angle == same.angle).all()
    assert (swapped.time == t).all() and "centre 0 m" in repr(swapped)


def test_what_lies_beyond_the_end_of_the_answer_is_left_out_and_what_is_no_trajectory_refused():
    fall = rolled(sc.Body.solid(1.0), sc.State(0.3, 0.0, 0.0, 0.0), 2.0)
    end = fall.data["expected"]["ending"]["time"]
    t = np.linspace(0, 2 * end, 11)
    x, q = answer(fall, t)
    rows = len(x)
    assert rows < 11
    found = fall.compare(t, np.resize(x, (11, 3)), np.resize(q, (11, 4)))
    assert found.time.size == rows and found.position.max() == 0
    # a motion without an end is known at any time, also beyond those of the file
    tube = scene_of("tube")
    far = [0.0, 3 * tube.data["expected"]["time"][-1]]
    assert tube.compare(far, *answer(tube, far)).position.max() == 0
    x, q = answer(tube, [0.0, 0.01])
    for wrong, said in (
        (([0.01, 0.0], x, q), "^time: .*ascending"),
        (([-0.1, 0.0], x, q), "^time: .*since the initial state"),
        (([], x, q), "^time: expected at least one number"),
        (([0.0, np.nan], x, q), "^time: value 1 is NaN; expected finite numbers"),
        (([0.0, 0.01], x[:, :2], q), r"^position: expected finite numbers of shape \(2, 3\), not \(2, 2\)"),
        (([0.0, 0.01], x + np.inf, q), "^position: row 0 has an infinite number; expected finite numbers"),
        (
            ([0.0, 0.01], x + np.array([[0.0], [np.nan]]), q),
            "^position: row 1 has NaN; expected finite numbers",
        ),
        (([0.0, 0.01], x, q[:1]), "^orientation"),
        (([0.0, 0.01], x, 1.1 * q), "^orientation: expected unit quaternions"),
    ):
        with pytest.raises(ValueError, match=said):
            tube.compare(*wrong)
    with pytest.raises(ValueError, match="^time = .*the known motion ends before this time: the face landed"):
        fall.compare([3 * end], x[:1], q[:1])
    with pytest.raises(TypeError, match="^scalar_first"):
        tube.compare([0.0, 0.01], x, q, scalar_first=1)
    with pytest.warns(UserWarning, match="at time 0 it differs by .* scalar_first=True"):
        tube.compare([0.0, 0.01], x, np.roll(q, 1, axis=1))
    with pytest.raises(ValueError, match="^orientation"):
        tube.couple([0, 0, 0, 2.0], [0, 0, 1.0], 1.0)


def columns(t, x, q, names="t x y z qx qy qz qw", lengths=1.0):
    """A trajectory as a dict of columns."""
    return dict(zip(names.split(), (t, *(x * lengths).T, *q.T), strict=True))


def test_a_table_has_the_deviation_of_its_columns_in_any_order_and_by_any_usual_names(tmp_path):
    scene = scene_of("tube")
    t = np.linspace(0, scene.data["expected"]["time"][-1], 7)
    x, q = answer(scene, t)
    x = x + np.array([0.0, 3e-4, 4e-4])
    known = scene.compare(t, x, q)
    wide = np.zeros(7, [("time", "f8"), ("Position", "f8", 3), ("orientation", "f8", 4), ("slip", "f8", 2)])
    wide["time"], wide["Position"], wide["orientation"] = t, x, q
    narrow = np.array([*zip(t, *x.T, *q.T, strict=True)], [(name, "f8") for name in columns(t, x, q)])
    ros = "Time pose.position.x pose.position.y pose.position.z" + "".join(
        f" pose.orientation.{w}" for w in "xyzw"
    )
    frame = pd.DataFrame(columns(t, x, q)).set_index("t")
    for table in (
        columns(t, x, q),
        dict(reversed(columns(t, x, q).items())) | {"w1": t, "contact_x": t, "body": ["a"] * 7},
        columns(t, x, q, ros),
        {"Time": t, "com": x, "quat": q},
        wide,
        narrow,
        frame,
        frame.reset_index().sample(frac=1, axis=1, random_state=1),
    ):
        found = scene.compare(table)
        assert (found.position == known.position).all() and (found.angle == known.angle).all()
    turned = scene.compare({"t": t, "position": x, "quaternion": np.roll(q, 1, axis=1)}, scalar_first=True)
    assert (turned.angle == known.angle).all()
    pipe = sc.measured(outer_diameter="16mm", length="95mm", mass="20g")
    own = sc.roll(pipe, pipe.steady(1.4), t, want="pose")
    assert sc.scene(own).compare(own.to_dataframe()).position.max() == 0


def test_a_text_file_in_milliseconds_and_millimetres_says_so_in_its_names(tmp_path):
    scene = scene_of("tube")
    t = np.linspace(0, scene.data["expected"]["time"][-1], 7)
    x, q = answer(scene, t)
    head = "Time [ms];X (mm);Y (mm);Z (mm);quat_x;quat_y;quat_z;quat_w;energy (J)"
    rows = np.column_stack([1e3 * t, 1e3 * x, q, t])
    lines = [";".join(repr(float(cell)).replace(".", ",") for cell in row) for row in rows]
    path = tmp_path / "engine.csv"
    path.write_text("\n".join([head, *lines]))
    for given in (path, str(path)):
        found = scene.compare(given)
        assert found.time == pytest.approx(t, rel=1e-14) and found.position.max() < 1e-15 * 1e3
        assert found.angle.max() < 1e-14
    path.write_text("\n".join([head.replace("quat_w", "q_real"), *lines]))
    with pytest.raises(
        ValueError, match=r"^time: the table '.*engine.csv': expected a column 'qw' .*'q_real'"
    ):
        scene.compare(path)


def test_a_table_that_is_no_trajectory_is_refused_with_the_columns_that_it_has():
    scene = scene_of("tube")
    t = np.array([0.0, 0.01])
    x, q = answer(scene, t)
    table = columns(t, x, q)
    for wrong, error, said in (
        (
            {k: v for k, v in table.items() if k != "z"},
            ValueError,
            "^time: .* 'z' .or 'p_z', .*; the table has 't', 'x', 'y', 'qx'",
        ),
        ({"T": t} | table, ValueError, "^time: the table: 'T' and 't' are names of the same column"),
        (table | {"qw": q[:1, 3]}, ValueError, "^time: .* equal length; qw has"),
        (table | {"t": t[:1]}, ValueError, "^time: .* equal length, not 1 times, 2 positions"),
        (
            {"t (h)": t} | columns(t, x, q, "a x y z qx qy qz qw"),
            ValueError,
            "^time: .* unit 'h' of the column t: expected one of s",
        ),
        (table | {"x": [0.0, np.nan]}, ValueError, "^position: row 1 has NaN"),
        (table | {"qx": q[:, 0] + 2}, ValueError, "^orientation: expected unit quaternions"),
        (t, TypeError, "^time: expected a dict of columns, not ndarray; .* give position= and orientation="),
        (3.0, TypeError, "^time: expected a dict of columns, not float"),
    ):
        with pytest.raises(error, match=said):
            scene.compare(wrong)
    with pytest.raises(ValueError, match="^scalar_first: leave it out, since the names of the columns"):
        scene.compare(table, scalar_first=True)
    with pytest.raises(TypeError, match="^position, orientation: give both"):
        scene.compare(t, x)


def test_an_engine_in_milliseconds_or_millimetres_is_doubted_and_one_that_falls_is_not():
    coin = scene_of("dropped coin")
    t = np.linspace(0, coin.data["expected"]["time"][-1], 5)[1:]  # an engine may tell its first step first
    x, q = answer(coin, t)
    with pytest.warns(
        UserWarning, match=r"^position: .* at t = .* from the origin; .* in millimetres\?"
    ) as said:
        coin.compare(t, 1e3 * x, q)
    assert len(said) == 1 and said[0].filename == __file__
    tube = scene_of("tube")
    t = np.linspace(0, tube.data["expected"]["time"][-1], 5)
    x, q = answer(tube, t)
    with pytest.warns(
        UserWarning, match=r"^time: goes up to .* s, but the scene ends at .* in milliseconds\?"
    ):
        found = tube.compare(1e3 * t, x, q)
    assert found.time[-1] == 1e3 * t[-1]
    x[2:, 2] -= 1e4  # through the table, and in metres
    assert tube.compare(t, x, q).position.max() > 9e3


def test_energy_and_force_are_as_good_as_they_say():
    for name in ("cylinder", "tube", "round on ice"):
        scene = scene_of(name)
        m, data = scene.motion, scene.data
        # another method with steps ten times smaller
        other = sc.roll(m.body, m.start, m.t, tol=1e-13, contact=m.contact, want=("pose", "force"))
        spare, joule, newton = 1 + other.error / m.error, scene.scale.joules(1.0), scene.scale.newtons(1.0)
        for key, mine in (
            ("energy", joule * other.energy),
            ("normal_force", newton * other.normal),
            ("contact_force", newton * other.contact_force),
            ("position", scene.scale.metres(other.centre)),
        ):
            off = np.abs(np.array(data["expected"][key]) - mine).max()
            assert off < data["error"][key] * spare * 10 + 1e-13 * np.abs(mine).max()
            assert data["error"][key] < 1e-6 * np.abs(mine).max()


def test_the_command_line_writes_scenes_by_their_suffix(tmp_path):
    def run(*words):
        return subprocess.run(
            [sys.executable, "-m", "spincyl", *words], capture_output=True, text=True, cwd=tmp_path
        )

    roll = "roll --outer 24mm --length 2mm --mass 8g --theta 20deg --t 0.5s --points 11".split()
    told = run(
        *roll, "--contact", "coulomb", "--mu", "0.4", "--loss", "dry-contour=0.05mm", "-o", "coin.json"
    )
    assert told.returncode == 0 and "the scene in coin.json" in told.stdout
    data = json.loads((tmp_path / "coin.json").read_text())
    assert data["table"]["losses"][0]["value"] == pytest.approx(5e-5) and data["body"]["mass"] == 0.008
    coin = sc.measured(outer_diameter=0.024, length=0.002, mass=0.008)
    how = {"contact": sc.Coulomb(0.4), "losses": sc.loss.DryContour.from_si(5e-5, scale=coin)}
    mine = sc.scene(sc.roll(coin, coin.steady(np.radians(20)), np.linspace(0, 0.5, 11), **how))
    assert np.allclose(data["expected"]["position"], mine.data["expected"]["position"], atol=1e-13)
    flick = "flick --outer 15.875mm --inner 12.7mm --length 95.25mm --mu 0.3 --precession 17Hz --launch-number 1.3"
    assert run(*flick.split(), "--restitution", "0", "--seconds", "0.2", "-o", "flick.xml").returncode == 0
    assert "<mujoco" in (tmp_path / "flick.xml").read_text()


def test_every_kind_of_motion_has_a_scene():
    kinds = {x["kind"] for name in SCENES for x in scene_of(name).data["expected"]["phases"]}
    assert kinds >= {"rolling", "slipping", "flying", "lying"}
    laws = {x["law"] for name in LOST for x in scene_of(name).data["table"]["losses"]}
    assert laws == {x for x in sc.loss.__all__ if x not in ("Law", "Loss", "Sum")}
    assert {scene_of(name).data["table"]["friction"]["law"] for name in SCENES} == {
        "rolling",
        "smooth",
        "coulomb",
        "viscous",
    }
    assert PIPE is scene_of("lies").motion.body and EGG.natural == scene_of("egg").motion.body and PRESSED


def shifted(m, e, p, rng):
    """A copy of a motion of a body on one rim whose states are off by `e`, and whose poses by `p`, in any direction."""

    def off(by, x):
        return x + by * rng.choice([-1.0, 1.0], np.shape(x))

    def arm(theta, phi):
        """From the contact point to the centre, of a sharp rim."""
        c, s = np.cos(theta), np.sin(theta)
        along = m.body.ell * -s + c
        return np.column_stack([along * np.cos(phi), along * np.sin(phi), m.body.ell * c + s])

    theta, w, phi, psi = off(e, m.theta), off(e, m.w), off(p, m.phi), off(p, m.psi)
    point = off(p / np.sqrt(2), m.contact_point)
    assert np.allclose(arm(m.theta, m.phi)[:, :2] + m.contact_point, m.centre[:, :2], atol=1e-11)
    turned = Rotation.from_euler("ZYZ", np.column_stack([phi, -theta, psi])).as_quat()
    astray = Rotation.from_quat(turned).inv() * Rotation.from_quat(m.orientation)
    assert astray.magnitude().max() < 1.01 * e + 2.01 * p, "the angles are those of the orientation"
    extra = m._extra | {
        "phi": np.column_stack([0 * phi, phi]), "contact_point": point, "orientation": turned,
        "centre": arm(theta, phi) + np.pad(point, ((0, 0), (0, 1))), "slip": off(e, m.slip),
    }  # fmt: skip
    other = object.__new__(type(m))
    new = {"theta": theta, "w": w, "error": e, "pose_error": p, "_extra": extra}
    object.__setattr__(other, "__dict__", m.__dict__ | new)
    return other


@pytest.mark.parametrize(("e", "p"), [(1e-7, 0.0), (0.0, 1e-7), (1e-7, 1e-7)])
def test_the_errors_of_what_is_told_are_bounds_and_not_far_above_what_the_motion_claims(e, p):
    rng, most = np.random.default_rng(1), {}
    for body in (COIN, PIPE):
        start = body.with_centre_velocity(sc.State(1.2, 0.4, 0.1, -1.0), 0.5, 2.0)
        right = sc.scene(sc.roll(body, start, np.linspace(0, 1, 401), contact=sc.Coulomb(0.3)), scale=EURO)
        wrong = sc.Scene(shifted(right.motion, e, p, rng), EURO).data
        known, told = right.data["expected"], wrong["expected"]
        for name in ("position", "velocity", "angular_velocity", "theta", "energy"):
            off = np.array(told[name]) - known[name]
            off = np.linalg.norm(off, axis=1).max() if off.ndim == 2 else np.abs(off).max()
            assert off <= wrong["error"][name] * (1 + 1e-6) + 1e-14, name
            most[name] = max(most.get(name, 0.0), off / max(wrong["error"][name], 1e-14))
        q = Rotation.from_quat(told["orientation"]).inv() * Rotation.from_quat(known["orientation"])
        assert q.magnitude().max() <= wrong["error"]["angle"] * (1 + 1e-6) + 1e-14
        most["angle"] = max(most.get("angle", 0.0), q.magnitude().max() / wrong["error"]["angle"])
    assert all(share > 0.1 for name, share in most.items() if p == 0 or name not in ("theta", "energy")), most
