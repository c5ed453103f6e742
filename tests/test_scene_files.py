"""Files of scenes that are read again, and the records by which both languages are held to each other."""

import copy
import json
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from scene_records import PATH, hashed

import spincyl as sc
from spincyl.studio.mjcf import mjcf
from spincyl.studio.urdf import urdf

RECORDS = json.loads(PATH.read_text(encoding="utf-8"))
FEW = (
    "tube",
    "cup on its upper rim",
    "egg",
    "hops in air",
    "dropped bottle",
    "on a slope",
    "elsewhere",
    "puck",
)


def written(tmp_path, data):
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(data), encoding="utf-8")
    return path


@pytest.mark.filterwarnings("ignore:inertia")
def test_the_records_are_what_python_writes(tmp_path):
    for name, record in RECORDS.items():
        known = sc.Scene.read(written(tmp_path, record["file"]))
        assert known.data == record["file"], name
        assert hashed(mjcf(known.data)) == record["mjcf"], name
        if record["urdf"] is None:
            with pytest.raises(ValueError, match="urdf: expected a body"):
                urdf(known.data)
        else:
            assert hashed(known.urdf) == record["urdf"], name


@pytest.mark.parametrize("name", FEW)
def test_a_scene_that_is_read_is_the_scene_that_was_written(name, tmp_path):
    told = RECORDS[name]["file"]
    known = sc.Scene.read(written(tmp_path, told))
    anew = sc.scene(known.motion, scale=known.scale).data
    metre, second = known.scale.radius, known.scale.seconds(1.0)
    for key, unit in (("position", metre), ("velocity", metre / second), ("angular_velocity", 1 / second)):
        off = np.abs(np.array(told["expected"][key]) - anew["expected"][key]).max()
        assert off <= 2 * told["error"][key] + 1e-12 * unit, (name, key)
    assert anew["natural"] == told["natural"]
    for key in ("phases", "impacts"):
        kinds = [[x["kind"] for x in data["expected"].get(key, [])] for data in (told, anew)]
        assert kinds[0] == kinds[1]


def test_what_is_wrong_with_a_file_is_said(tmp_path):
    told = RECORDS["hops in air"]["file"]

    def refused(change):
        other = copy.deepcopy(told)
        change(other)
        with pytest.raises(ValueError) as caught:
            sc.Scene.read(written(tmp_path, other))
        assert str(caught.value).startswith("path")
        return str(caught.value)

    assert "version 1" in refused(lambda x: x.update({"spincyl-scene": 2}))
    assert "natural" in refused(lambda x: x.pop("natural"))
    assert "its motion is not" in refused(lambda x: x["natural"]["ask"].update(restitution=0.4))
    assert "its motion is not" in refused(lambda x: x["expected"]["position"][0].__setitem__(2, 7.0))
    path = tmp_path / "no.json"
    path.write_text("{", encoding="utf-8")
    with pytest.raises(ValueError, match="path = .*no.json.*: expected the JSON file of a scene"):
        sc.Scene.read(path)
    with pytest.raises(OSError, match="nowhere"):
        sc.Scene.read(tmp_path / "nowhere.json")


def test_a_file_of_the_crate_is_read(tmp_path):
    """The file is that of `cargo run --features scene --example scene`, thinned to ten of its times."""
    told = json.loads((PATH.parent / "thrown.json").read_text(encoding="utf-8"))
    known = sc.Scene.read(written(tmp_path, told))
    assert known.scale.radius == 15.875e-3 / 2 and known.motion.body.theta_end == np.pi / 2
    assert known.data["table"]["restitution"] == known.motion._asked.restitution == 0.5
    own = sc.measured(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3, mass=20e-3)
    start = sc.dropped(
        own, 5e-3, np.radians(80), w1=20 * np.sin(np.radians(80)), w3=30 + 20 * np.cos(np.radians(80))
    )
    assert start.theta == pytest.approx(known.motion.start.theta, abs=1e-15)
    off = known.compare(
        told["expected"]["time"], told["expected"]["position"], told["expected"]["orientation"]
    )
    assert off.position.max() < 1e-9


def test_a_urdf_has_the_mass_the_moments_and_what_touches_the_table():
    tube = ET.fromstring(known_tube().urdf)
    link = tube.find("link")
    mass, inertia = link.find("inertial/mass"), link.find("inertial/inertia")
    data = known_tube().data
    assert float(mass.get("value")) == data["body"]["mass"]
    assert [float(inertia.get(x)) for x in ("ixx", "iyy", "izz")] == np.diag(data["body"]["inertia"]).tolist()
    cylinder = link.find("collision/geometry/cylinder")
    shape = data["body"]["shape"]
    assert float(cylinder.get("radius")) == shape["radius"]
    assert float(cylinder.get("length")) == pytest.approx(2 * shape["half_length"], rel=1e-15)
    balls = sc.scene(sc.roll(sc.Body.balls(1.0), sc.Body.balls(1.0).steady(1.36), [0.0, 0.1]))
    heights = [
        float(x.get("xyz").split()[2]) for x in ET.fromstring(balls.urdf).findall("link/collision/origin")
    ]
    assert heights == [-1.0, 1.0]
    capsule = sc.scene(sc.roll(sc.Body.solid(2.0, fillet=1.0), sc.State(1.3, 1.0, 0.0, 0.5), [0.0, 0.1]))
    found = [x[0].tag for x in ET.fromstring(capsule.urdf).findall("link/collision/geometry")]
    assert found == ["sphere", "sphere", "cylinder"]


def known_tube():
    tube = sc.measured(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3, mass=20e-3)
    return sc.scene(sc.roll(tube, tube.steady(1.4), [0.0, 0.01]))
