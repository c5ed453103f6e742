"""Views of stones: the drawn stone stands on the table and turns as in the motion, with correct text."""

import gzip
import json
import re
from functools import cache
from itertools import pairwise

import numpy as np
import pages
import pytest
from few import few
from page_scenes import ACROSS, ACROSS_START, EGG, SMALL, STONES, TOY, motion_of, page_of
from pages import SENT, arrow, between, clock, go, near, picture, sent
from scipy.spatial.transform import Rotation

import spincyl as sc
from spincyl.studio.pages.slip import forces
from spincyl.studio.pages.stone import turns_back
from spincyl.studio.poses import knots, seen
from spincyl.studio.shape import BLUE, IVORY, ORANGE, lathe, marks, parts, profiles
from spincyl.studio.stone_shape import height

RED = (0.75, 0.12, 0.18)


def drawn(found, t):
    """What the page draws at ascending times between knots: rotation and centre."""
    numbers = between(found, t)
    return Rotation.from_quat(numbers[:, [0, 1, 2, 5]]), numbers[:, 3:5]


def random_stone(rng):
    axes = rng.uniform(0.15, 1.0, 3)
    whole = sc.Ellipsoid.uniform(axes / axes.max())
    turn = Rotation.from_rotvec([0.0, 0.0, rng.uniform(-0.3, 0.3)]).as_matrix()
    inertia = turn @ np.diag(np.diagonal(whole.inertia)) @ turn.T
    return sc.Ellipsoid(whole.semi_axes, inertia, offset=0.3 * rng.uniform(-1, 1, 3) * whole.semi_axes)


def test_random_motions_are_met_between_their_knots():
    rng = np.random.default_rng(5)
    met = []
    for k in range(60):
        n = rng.normal(size=3)
        state = sc.EllipsoidState(n / np.linalg.norm(n), rng.normal(0, 10 ** rng.uniform(-2, 0.4), 3))
        contact = ("rolling", "smooth", sc.Coulomb(10 ** rng.uniform(-1.5, 0)))[k % 3]
        m = sc.roll(random_stone(rng), state, 10.0, contact=contact, tol=1e-9 if k % 4 == 0 else None)
        if m.event is not None and m.event.time < 1e-3:
            continue
        found = knots(m)
        t = np.sort(rng.uniform(*found[[0, -1], 0], 1000))
        q, centre = seen(m, t, "orientation", "centre")
        turn, place = drawn(found, t)
        turned = (turn * Rotation.from_quat(q).inv()).magnitude().max()
        met.append(max(turned, np.abs(place - centre[:, :2]).max()))
        assert len(found) < 1500
    assert len(met) > 40 and max(met) < 3e-3, max(met)


@pytest.mark.parametrize("upper", ["O", "X"])
@pytest.mark.parametrize("stone", [SMALL, TOY, EGG, ACROSS], ids=["small", "toy", "egg", "across"])
def test_its_surface_is_closed_and_its_marks_lie_on_it(stone, upper):
    import trimesh

    whole = parts(stone, upper)
    surface = trimesh.util.concatenate(
        [trimesh.Trimesh(p.vertices, p.triangles, process=False) for p in whole if p.name not in ("O", "X")]
    )
    surface.merge_vertices(merge_norm=True, merge_tex=True)
    assert surface.is_watertight and surface.is_winding_consistent
    cut = height(stone)
    volume = np.pi * np.prod(stone.semi_axes) * (cut - cut**3 / 3 + 2 / 3)
    assert surface.volume == pytest.approx(volume, rel=2e-3)
    # the offset gives the centre of the ellipsoid
    beyond = (surface.vertices + stone.offset) / stone.semi_axes
    assert np.linalg.norm(beyond, axis=1).max() == pytest.approx(1.0, abs=1e-9)
    first, second = marks(stone, upper)
    assert (first.name, second.name) == ((upper, "X") if upper == "O" else ("X", "O"))
    for part in (first, second):
        out = np.linalg.norm((part.vertices + stone.offset) / stone.semi_axes, axis=1)
        on_top = part.vertices[:, 2] > (cut - 1e-9) * stone.semi_axes[2] - stone.offset[2]
        assert np.allclose(out[~on_top], 1.004) and out.max() < 1.01
        above = (cut + 0.004) * stone.semi_axes[2] - stone.offset[2]
        assert part.vertices[on_top & (cut < 1), 2] == pytest.approx(above)
        corners = part.vertices[part.triangles]
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert ((flat[:, None] * part.normals[part.triangles]).sum(-1) > 0).all(), "seen from outside"


@pytest.mark.parametrize("end", [0.4, 1.2, np.pi / 2, 2.0, 2.9])
def test_a_stone_is_cut_where_its_edge_lands(end):
    for axes in ((1.0, 1.0, 0.4), (1.0, 0.3, 0.2)):
        stone = sc.Ellipsoid(axes, (0.02, 0.2, 0.21), theta_end=end)
        heights = []
        for phi in np.linspace(0.0, 2 * np.pi, 9):
            n = np.array([np.sin(end) * np.cos(phi), np.sin(end) * np.sin(phi), np.cos(end)])
            contact = -np.square(axes) * n / np.sqrt((n * n) @ np.square(axes))
            heights.append(contact[2] / axes[2])
        assert height(stone) == pytest.approx(max(heights))
    assert height(sc.Ellipsoid((1.0, 0.3, 0.2), (0.02, 0.2, 0.21))) == 1.0


def test_friction_of_a_stone_is_that_of_the_law_and_against_its_slip():
    m = motion_of("rises")
    t = np.linspace(0.5, 49.5, 99)
    found, there = forces(m, t), m.wanting("force", t=t)
    assert np.allclose(np.hypot(found[:, 2], found[:, 3]), there.friction, atol=1e-6)
    assert np.allclose(found[:, 4], there.normal)
    slips = there.phase == 1
    slips[[0, -1]] = False  # finite differences there are one-sided
    u, f = (x[slips] @ [1, 1j] for x in (found[:, :2], found[:, 2:4]))
    assert slips.sum() > 20 and np.abs(u / np.abs(u) + f / np.abs(f)).max() < 1e-6
    # the slip is that of the contact point: it agrees with the centre's velocity and the rotation
    h = 1e-5
    around = m.wanting("pose", t=np.column_stack([t - h, t, t + h]).ravel())
    v = ((around.centre[2::3] - around.centre[::3]) / (2 * h))[:, :2] @ [1, 1j]
    turn = Rotation.from_quat(around.orientation[1::3])
    arm = np.column_stack([around.contact_point[1::3], 0 * t]) - around.centre[1::3]
    carried = np.cross(turn.apply(around.w[1::3]), arm)[:, :2] @ [1, 1j]
    assert np.abs(v + carried - found[:, :2] @ [1, 1j]).max() < 1e-6


def test_the_spin_turns_back_when_it_has_come_to_a_tenth_in_the_other_direction():
    m = motion_of("turns back")
    found = turns_back(m, knots(m)[:, 0])
    t = np.linspace(0.0, 60.0, 200_001)
    spin = m.at(t).spin
    direction, last, expected = np.sign(spin[0]), 0.0, []
    for k in np.flatnonzero(np.abs(np.diff(np.sign(spin))) + (np.abs(spin[1:]) >= 0.06)):
        if np.sign(spin[k]) != np.sign(spin[k + 1]):
            last = t[k]
        if abs(spin[k + 1]) >= 0.06 and np.sign(spin[k + 1]) != direction:
            direction = -direction
            expected.append(last)
    assert len(found) == len(expected) > 0
    assert found == pytest.approx(expected, abs=0.02)
    there = m.at(found[0] + np.array([-1.0, 1.0])).spin
    assert there[0] < 0 < there[1]
    still = sc.roll(SMALL, sc.EllipsoidState([0.1, 0.0, np.sqrt(0.99)], [0.0, 0.0, 0.0]), 5.0)
    assert turns_back(still, knots(still)[:, 0]) == []


# in a browser

SQUARE = {"width": 330, "height": 330}


@cache
def natural():
    """All of them side by side, in units of each."""
    return sc.view(*(motion_of(kind).natural for kind in STONES), labels=list(STONES))


def test_the_drawn_pose_is_that_of_the_motion(shown):
    motions = {kind: motion_of(kind).natural for kind in STONES}
    page = shown(natural(), "#t=0", viewport=pages.SMALL, keep=True)
    assert page.complaints == []
    for i, (kind, m) in enumerate(motions.items()):
        t = np.linspace(0.0, m.event.time - 1e-6 if m.event else m.t[-1], 1001)
        told = "([i, t]) => JSON.stringify(t.map(t => window.spincyl.pose(i, t)))"
        poses = json.loads(page.evaluate(told, [i, t.tolist()]))
        there = m.wanting("pose", t=t)
        matrix = np.array([pose["matrix"] for pose in poses]).reshape(-1, 4, 4).transpose(0, 2, 1)
        turn = Rotation.from_quat(there.orientation).as_matrix()
        assert np.abs(matrix[:, :3, :3] - turn).max() < 3e-3, kind
        assert np.abs(matrix[:, :3, 3] - there.centre).max() < 3e-3, kind
        contact = np.array([pose["contact"] for pose in poses])
        assert np.abs(contact[:, :2] - there.contact_point).max() < 4e-3 and (contact[:, 2] == 0).all(), kind
        assert [pose["theta"] for pose in poses] == pytest.approx(there.theta, abs=3e-3)
        # the drawn angular velocity agrees with the drawn rotation
        size = np.linalg.norm(there.w, axis=1).max()
        omega = np.einsum("nij,nj->ni", turn, there.w)
        momentum = np.einsum("nij,nj->ni", turn, there.w @ np.asarray(m.body.inertia))
        assert np.abs(np.array([pose["omega"] for pose in poses]) - omega).max() < 0.03 * size, kind
        missed = np.abs(np.array([pose["momentum"] for pose in poses]) - momentum).max()
        assert missed < 0.03 * size * m.body.moments.max(), kind


def test_it_stands_on_the_table_where_it_touches_it(shown):
    # of the drawn pose, with the drawn geometry: at any time, not only at knots
    page = shown(natural(), "#t=0", viewport=pages.SMALL, keep=True)
    for i, kind in enumerate(("turns back", "measured", "rises", "lands")):
        m = motion_of(kind).natural
        places = np.concatenate([part.vertices for part in map(lathe, profiles(m.body))])
        last = m.event.time - 1e-6 if m.event else float(m.t[-1])
        times = np.linspace(0, last, 60).tolist()
        for pose in page.evaluate("([i, t]) => t.map(t => window.spincyl.pose(i, t))", [i, times]):
            matrix = np.array(pose["matrix"]).reshape(4, 4).T
            there = places @ matrix[:3, :3].T + matrix[:3, 3]
            assert there[:, 2].min() == pytest.approx(0.0, abs=1e-3)
            # the contact point is on the surface, where the surface is level
            touched = (np.array(pose["contact"]) - matrix[:3, 3]) @ matrix[:3, :3] + m.body.offset
            assert np.linalg.norm(touched / m.body.semi_axes) == pytest.approx(1.0, abs=1e-6)
            level = touched / np.square(m.body.semi_axes)
            assert matrix[2, :3] @ level == pytest.approx(-np.linalg.norm(level), rel=1e-6)
            # a vertex of the mesh is close to it
            assert np.linalg.norm(there - pose["contact"], axis=1).min() < 0.06


def test_it_is_drawn_with_its_marks_and_asks_for_nothing(shown):
    for view, at in ((page_of("turns back"), "#t=20"), (page_of("measured"), "#t=1")):
        page = shown(view, at)
        image = picture(page)
        assert near(image, BLUE, 0.2) > 1e-3 and near(image, ORANGE, 0.25) > 5e-4
        assert near(image, IVORY, 0.05) > 0.01
        assert len(page.requests) == 1 and page.complaints == []
    # the other sense of rotation
    page.check("#above")
    ahead = picture(page)
    page = shown(page_of("measured", upper="X"), "#t=1")
    page.check("#above")
    other = picture(page)
    blue, orange = (np.abs(ahead - colour).max(-1) < 0.08 for colour in (BLUE, ORANGE))
    assert min(blue.sum(), orange.sum()) > 300
    assert np.abs(other[blue] - ORANGE).max() < 0.3 and np.abs(other[orange] - BLUE).max() < 0.3


def test_the_needle_points_along_the_longer_axis(shown):
    for kind, long in (("measured", 0), ("lands", 1)):
        m = motion_of(kind).natural
        page = shown(sc.view(m), "#t=1")
        page.check("#above")
        page.uncheck("#path")
        image = picture(page)
        masks = (np.abs(image - colour).max(-1) < 0.1 for colour in (BLUE, ORANGE))
        blue, orange = (np.argwhere(mask)[:, ::-1].mean(axis=0) for mask in masks)
        pointed = (blue - orange) * [1, -1]
        turn = Rotation.from_quat(m.wanting("pose", t=[0.0, 1.0]).orientation[1]).as_matrix()
        along = turn[:2, long]
        assert pointed @ along > 0.995 * np.hypot(*pointed) * np.hypot(*along)


def test_arrows_point_along_angular_velocity_and_momentum_seen_from_above(shown):
    m = motion_of("lands")
    page = shown(page_of("lands"), "#t=2")
    page.check("#above")
    state = m.wanting("pose", t=[0.0, 2.0])
    turn = Rotation.from_quat(state.orientation[1])
    for name, v in (("omega", state.w[1]), ("momentum", np.asarray(ACROSS.inertia) @ state.w[1])):
        flat = turn.apply(v)[:2]
        pixels = arrow(page, name)
        assert pixels @ flat > 0.99 * np.hypot(*pixels) * np.hypot(*flat), name


def test_the_clock_tells_the_spin_and_when_it_turns_back(shown):
    page = shown(page_of("turns back"), "#t=3")
    spin = motion_of("turns back").at([0.0, 3.0, 30.0]).spin
    back = turns_back(motion_of("turns back"), knots(motion_of("turns back"))[:, 0])
    told = re.fullmatch(
        r"t = 3\.000 √\(a/g\)\nθ = \d+\.\d°\nspin (.\d\.\d+) √\(g/a\)\nturns back at t = (\d+\.\d+) √\(a/g\)",
        clock(page),
    )
    assert told and told[1][0] == "\N{MINUS SIGN}"
    assert float(told[1][1:]) == pytest.approx(-spin[1], abs=0.01)
    assert float(told[2]) == pytest.approx(back[0], abs=1e-3)
    go(page, 30)
    assert f"spin {'+' if spin[2] > 0 else chr(0x2212)}{abs(spin[2]):.3f}" in clock(page)
    assert f"turned back at t = {max(x for x in back if x < 30):.3f}" in clock(page)
    assert "inclination of its axis 3" in page.locator("details p").text_content()
    # of a measured one in SI
    m = motion_of("measured")
    told = clock(shown(page_of("measured"), "#t=2"))
    assert re.match(r"t = 2\.0+ s\n", told) and "rad/s" in told
    assert f"{abs(m.at([0.0, 2.0]).spin[1]):.1f}" in told


def test_where_it_slips_its_path_is_red_and_forces_have_arrows(shown):
    m = motion_of("rises")
    page = shown(page_of("rises"), "#t=20")
    assert re.search(r"\nspin \+\d\.\d\d √\(g/a\)\nslipping \d\.\d+ √\(g a\)$", clock(page))
    tips = page.locator(".tip")
    assert [tips.nth(k).inner_text() for k in range(tips.count()) if tips.nth(k).is_visible()] == ["N", "F"]
    page.uncheck("#forces")
    assert near(picture(page), RED) > 3e-4
    assert "slipping from t = 0.00" in page.locator(".phases").get_attribute("title").replace("\xa0", " ")
    for t in (10.0, 20.0, 45.0):
        normal, friction = page.evaluate(
            "t => { const p = window.spincyl.pose(0, t); return [p.normal, p.friction]; }", t
        )
        there = forces(m, np.array([t - 1.0, t]))[1]
        assert normal == pytest.approx([0, 0, there[4]], abs=0.02)
        assert friction == pytest.approx([*there[2:4], 0], abs=0.02)
    assert page.complaints == []


@pytest.mark.parametrize("stone", few([SMALL, ACROSS, EGG], 2), ids=["small", "across", "egg"])
def test_the_page_stretches_a_ball_as_python_does(shown, stone):
    page = shown(sc.view(sc.roll(stone, ACROSS_START, 1.0)), "#t=0", script=SENT)
    page.wait_for_selector("html[data-drawn]")
    rows = [x.reshape(-1, 3) for x in sent(page) if len(x) % 3 == 0]
    for part in parts(stone):
        # Buffers come in pairs, positions and normals. Each vertex of the coarser mesh is close to one of the
        # page.
        some = slice(None, None, max(1, len(part.vertices) // 60))
        found = []
        for places, normals in pairwise(rows):
            box = np.abs(np.ptp(places, axis=0) - np.ptp(part.vertices, axis=0)).max()
            if places.shape != normals.shape or box > 1e-3:
                continue
            apart = np.linalg.norm(part.vertices[some, None] - places, axis=-1)
            turned = normals[apart.argmin(axis=1)]
            turned /= np.linalg.norm(turned, axis=1, keepdims=True)
            found.append((apart.min(axis=1).max(), np.median((turned * part.normals[some]).sum(1))))
        missed, same = min(found)
        assert missed < 1e-3 and same > 0.999, part.name


def photograph(page, turns):
    page.select_option("#shutter", turns)
    page.wait_for_selector("html[data-exposed='720']")
    return picture(page)


def test_a_photograph_of_a_stone_is_open_for_its_turns(shown):
    # the marks glow, and the shutter closes after one turn about the vertical
    turn = 2 * np.pi / 4
    longer, once = (sc.roll(EGG, EGG.spinning(4.0), k * turn) for k in (1.2, 1.0))
    page, alone = (shown(sc.view(m), "#t=0", viewport=SQUARE) for m in (longer, once))
    one, expected = photograph(page, "1"), photograph(alone, "Infinity")
    assert near(one, BLUE, 0.2) > 1e-3
    assert np.abs(one - expected).mean() < 1e-4  # 4e-4 if the shutter stayed open to the end
    assert page.complaints == []


def test_a_stone_and_a_body_of_revolution_are_side_by_side(shown):
    page = shown(page_of("turns back", "nutating", "rises", labels=("stone", "can", "egg")), "#t=10")
    assert "spin" in clock(page, 0) and clock(page, 1).count("\n") == 1 and "slipping" in clock(page, 2)
    assert "√(R/g)" in clock(page, 0) and page.complaints == []
    alone = shown(page_of("nutating"), "#t=10")
    there = "window.spincyl.pose({}, 10).matrix"
    assert page.evaluate(there.format(1)) == alone.evaluate(there.format(0))


# size of the page


def test_a_page_without_a_stone_has_nothing_of_it_and_one_with_it_is_little_longer():
    body, stone = (page_of(kind).html for kind in ("nutating", "turns back"))
    assert not re.search("inertia|unstretched|unspun|turned back", body)
    assert stone.count("unspun=doing") == stone.count("unstretched=lathe") == 1
    packed = [len(gzip.compress(page.encode(), 9)) for page in (body, stone)]
    assert packed[1] - packed[0] < 15_000
    # the difference is in the scripts and the shape; the motion is excluded
    bare = [re.sub(r'"(knots|slopes)":"[^"]*"', "", page) for page in (body, stone)]
    assert len(bare[1]) - len(bare[0]) < 10_000


def test_another_library_loads_the_scene_with_poses_of_the_motion(tmp_path):
    import trimesh
    from pygltflib import GLTF2

    m = motion_of("rises")
    path = page_of("rises").save(tmp_path / "egg.glb")
    scene = trimesh.load_scene(path)
    surface = trimesh.util.concatenate(
        [g for g in scene.geometry.values() if g.visual.material.name not in ("O", "X")]
    )
    assert surface.volume == pytest.approx(4 / 3 * np.pi * 0.49, rel=2e-3)
    assert scene.bounds[0][1] == pytest.approx(0.0, abs=5e-3), "y is up"
    tree = GLTF2().load(path)

    def values(i, width):
        view = tree.bufferViews[tree.accessors[i].bufferView]
        raw = tree.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]
        return np.frombuffer(raw, "<f4").reshape(-1, width).astype(float)

    found = {c.target.path: tree.animations[0].samplers[c.sampler] for c in tree.animations[0].channels}
    t, q = values(found["rotation"].input, 1)[:, 0], values(found["rotation"].output, 4)
    assert t[0] == 0 and t[-1] == pytest.approx(50.0) and (q[1:] * q[:-1]).sum(1).min() > np.cos(0.15)
    there = m.wanting("pose", t=t)
    assert np.abs((q * there.orientation).sum(1)).min() > 1 - 1e-5
    assert np.abs(values(found["translation"].output, 3) - there.centre).max() < 1e-4


def test_a_film_and_a_photograph_show_its_marks(tmp_path):
    from PIL import Image

    m = sc.roll(TOY, TOY.spinning(-0.5, pitch=0.1), 0.4)
    path = sc.view(m, slow=1).save(tmp_path / "toy.gif", size=(320, 240), fps=5)
    with Image.open(path) as film:
        assert film.n_frames >= 3
        film.seek(1)
        image = np.asarray(film.convert("RGB"), float) / 255
    assert near(image, BLUE, 0.2) > 1e-3 and near(image, ORANGE, 0.25) > 1e-3
    photograph = sc.exposure(m, size=60, samples=1e5)
    assert photograph.shape == (60, 60) and 0.2 < photograph.max() < 1.5


def test_the_card_of_a_motion_tells_the_spin():
    m = sc.roll(SMALL, SMALL.spinning(-0.6, pitch=0.02), np.linspace(0.0, 20.0, 201))
    told = m._repr_html_()
    assert f"{m.spin.min():.4g} to {m.spin.max():.4g}, at last {m.spin[-1]:.4g} √(g/a)" in told
    assert "from 0 to 20 √(a/g)" in told and "Ellipsoid(" in told and "the last time was reached" in told
    assert "rad/s" in motion_of("measured")._repr_html_() and m.spin[-1] > 0


@pytest.mark.filterwarnings("ignore::spincyl.ErrorWarning")
def test_what_makes_no_sense_of_a_stone_is_refused_by_name(tmp_path):
    with pytest.raises(ValueError, match="upper"):
        sc.view(motion_of("turns back"), upper="Y")
    with pytest.raises(ValueError, match="no duration"):
        sc.view(sc.roll(SMALL, SMALL.spinning(1.0), 0.0))
    with pytest.raises(ValueError, match="at most 3000 nutations"):
        sc.view(sc.roll(SMALL, SMALL.spinning(-0.6, pitch=0.02), 20_000.0, tol=1e-6))
