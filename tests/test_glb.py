"""The animated scene as glTF 2.0: another library loads it, and its frames are poses of the motion."""

import near_steady_tube
import numpy as np
import nutating_cylinder
import pytest

import spincyl as sc

CYLINDER, PIPE, CAN = sc.Body.solid(2.5), sc.Body.tube(6.0, bore=0.8), sc.Body.solid(1.0)
STRANGE = "</script> \u2028 {name}"


def test_another_library_loads_the_scene_and_finds_the_body(tmp_path):
    import trimesh

    m = sc.roll(PIPE, near_steady_tube.start, 20.0)
    path = sc.view(m, scale=sc.Scale(radius=0.5)).save(tmp_path / "spin.glb")
    scene = trimesh.load_scene(path)
    letters = ("O", "X")
    surface = trimesh.util.concatenate(
        [g for g in scene.geometry.values() if g.visual.material.name not in letters]
    )
    surface.merge_vertices(merge_norm=True, merge_tex=True)
    assert surface.is_watertight and surface.is_winding_consistent
    assert surface.volume == pytest.approx(np.pi * (1 - 0.64) * 12, rel=1e-3)
    # in metres, y upwards, standing on the table
    low, high = scene.bounds
    assert low[1] == pytest.approx(0.0, abs=5e-3)
    assert high[1] == pytest.approx(float(2 * m.wanting("pose", t=0.0).centre[0, 2]) * 0.5, abs=0.01)


@pytest.mark.parametrize(
    ("body", "volume"),
    [
        (sc.Body.solid(2.5, fillet=1.0), np.pi * (3 + 4 / 3)),
        (sc.Body.balls(), np.pi * 8 / 3),
        # half of its volume: the straight part, and a fillet of 1/2 round a rim of 1/2, a^2 rho + a pi
        # rho^2/2 + 2 rho^3/3
        (sc.Body.solid(1.5, fillet=0.5), 2 * np.pi * (1 + 1 / 8 + np.pi / 16 + 1 / 12)),
    ],
    ids=["capsule", "two balls", "rounded can"],
)
def test_a_round_body_is_round_there_too_and_stands_on_the_table(tmp_path, body, volume):
    import trimesh

    m = sc.roll(body, body.steady(1.3).kicked(0.02), 5.0)
    scene = trimesh.load_scene(sc.view(m).save(tmp_path / "round.glb"))
    surface = trimesh.util.concatenate(
        [g for g in scene.geometry.values() if g.visual.material.name not in ("O", "X")]
    )
    surface.merge_vertices(merge_norm=True, merge_tex=True)
    assert surface.is_watertight and surface.is_winding_consistent
    assert surface.volume == pytest.approx(volume, rel=1.3e-3)
    assert scene.bounds[0][1] == pytest.approx(0.0, abs=7e-4)
    # normals of a smooth body: at one point they agree on all facets
    (ball, *_) = scene.geometry.values()
    places, same = np.unique(np.round(ball.vertices, 5), axis=0, return_inverse=True)
    mean = np.stack([np.bincount(same, ball.vertex_normals[:, i]) for i in range(3)], -1)
    size = np.linalg.norm(mean, axis=1) / np.bincount(same)
    assert len(places) > 4000 and size[np.hypot(*places[:, :2].T) > 1e-3].min() > 1 - 1e-5


def test_on_a_slope_the_scene_is_turned_so_that_x_leads_down(tmp_path):
    import trimesh

    ball, beta = sc.Body.ball(0.0, 0.4, 0.4), 0.3
    m, level = (
        sc.roll(ball, sc.State(1.0, 0.0, 0.0, 0.0), 5.0, table=sc.Table(slope, place=(2.0, 0.5)))
        for slope in (beta, 0.0)
    )
    scene = trimesh.load_scene(sc.view(m).save(tmp_path / "slope.glb"))
    sine, cosine = np.sin(beta), np.cos(beta)
    at = [2 * cosine + sine, cosine - 2 * sine, -0.5]  # y upwards
    assert np.mean(scene.bounds, axis=0) == pytest.approx(at, abs=2e-3)
    both = trimesh.load_scene(sc.view(level, m).save(tmp_path / "both.glb"))
    low, high = both.bounds
    assert high[0] - low[0] > 4.0 and low[1] == pytest.approx(min(0.0, at[1] - 1), abs=2e-3)


def test_its_frames_are_poses_of_the_motion_in_seconds(tmp_path):
    from pygltflib import GLTF2

    scale = sc.Scale(radius=0.02)
    m = sc.roll(CYLINDER, nutating_cylinder.start, 20.0)
    other = sc.roll(CAN, sc.State(0.3, 1e-6, 0.0, 0.0), 5.0)  # through a passage of microseconds fine
    coin = sc.roll(sc.Body.solid(0.02), sc.Body.solid(0.02).steady(0.1), 10.0)
    tree = GLTF2().load(
        sc.view(m, other, coin, labels=["a", STRANGE, "coin"], scale=scale).save(tmp_path / "spin.glb")
    )

    def values(i):
        a = tree.accessors[i]
        view = tree.bufferViews[a.bufferView]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[a.type]
        raw = tree.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]
        found = np.frombuffer(raw, "<f4").reshape(a.count, width)
        assert np.allclose(found.min(0), a.min) and np.allclose(found.max(0), a.max)
        return found.astype(float)

    assert [node.name for node in tree.nodes] == ["table", "a", STRANGE, "coin"]
    animation = tree.animations[0]
    for node, motion in ((1, m), (2, other), (3, coin)):
        paths = {
            c.target.path: animation.samplers[c.sampler] for c in animation.channels if c.target.node == node
        }
        t = values(paths["rotation"].input)[:, 0]
        assert t[0] == 0 and t[-1] == pytest.approx(motion.t[-1] * scale.seconds(1.0), rel=1e-6)
        assert (np.diff(t) > 0).all()
        there = motion.wanting("pose", t=t / scale.seconds(1.0))
        q = values(paths["rotation"].output)
        same = np.abs((q * there.orientation).sum(1))
        assert same.min() > 1 - 1e-5
        # half way between frames a player interpolates along the shorter turn, which must be the true one
        middle = motion.wanting("pose", t=(t[1:] + t[:-1]) / 2 / scale.seconds(1.0))
        half_way = q[1:] + q[:-1]
        half_way /= np.linalg.norm(half_way, axis=1)[:, None]
        assert np.abs((half_way * middle.orientation).sum(1)).min() > np.cos(0.02)
        # the body turns by a quarter of a radian at most between frames
        assert (q[1:] * q[:-1]).sum(1).min() > np.cos(0.3 / 2)
        shifted = values(paths["translation"].output) - there.centre
        assert np.ptp(shifted, axis=0).max() < 1e-4
