"""Films: frames show the motion at their times, like the page; missing programs are named."""

import os
import re
import stat
import subprocess
import sys
import warnings
from functools import cache

import numpy as np
import pages
import pytest
from few import few
from page_scenes import CYLINDER, PIPE, motion_of, page_of

import spincyl as sc
from spincyl.studio.film import reel
from spincyl.studio.frames import _Stage, frames
from spincyl.studio.pages.recorded import edges
from spincyl.studio.painted import turned
from spincyl.studio.shadow import LAMPS, caster, lamps, shadows
from spincyl.studio.shape import lathe, marks, parts, profiles, rotations

SCALE = sc.Scale(radius=7.9375e-3)
FALLING = sc.State(1.3, 0.0, 0.0, 0.0)


def taken(*motions, suffix=".mp4", fps=None, size=(320, 180), seconds=600.0, **how):
    view = sc.view(*motions, **how)
    return reel(view, [edges(m) for m in view.motions], suffix, fps, size, seconds)


def stage(what, times):
    return _Stage(what, times)


# the times of frames


def test_a_film_runs_as_many_times_slower_as_it_says():
    m = sc.roll(PIPE, PIPE.steady(1.3), 0.5 / SCALE.seconds(1.0))
    for fps, slow in ((30, 50), (24, 10), (60, 1)):
        what = taken(m, fps=fps, scale=SCALE, slow=slow)
        seconds = SCALE.seconds(what.times)
        assert np.allclose(seconds, np.minimum(np.arange(seconds.size) / (fps * slow), 0.5), atol=1e-12)
        assert seconds[-1] == pytest.approx(0.5) and seconds.size == round(0.5 * fps * slow) + 1
    plain = taken(motion_of("nutating"), slow=2)
    assert np.allclose(np.diff(plain.times), 1 / 60) and plain.times[-1] == 20.0


def test_the_last_picture_of_what_has_ended_stays_for_a_second():
    m = sc.roll(CYLINDER, FALLING, 20.0)
    what = taken(m, fps=25)
    end = m.event.time
    assert np.allclose(what.times[-25:], end, rtol=1e-6) and what.times[-27] < end - 1e-3
    (before,), (after,) = (list(frames(what, np.array([k]))) for k in (-27, -1))
    # after the end of a motion its body is grey
    assert spread(before).max() > 120 and spread(after).max() < 60


def spread(picture):
    return np.ptp(picture.astype(int), axis=-1)


def test_a_film_too_long_is_refused_before_anything_is_written(tmp_path):
    m = sc.roll(CYLINDER, CYLINDER.steady(1.3), 1000.0)
    for name in ("long.mp4", "long.gif"):
        with pytest.raises(ValueError, match=r"^seconds, fps: \d+ frames, expected at most 20000"):
            sc.view(m, slow=100).save(tmp_path / name, fps=50, seconds=600)
    assert not list(tmp_path.iterdir())


# the content of frames


@pytest.mark.parametrize(
    "scene",
    few(
        ["tube", "rounded", "Hurricane balls", "cup", "goblet", "nutating", "capsule", "tippe top, at first"],
        5,
    ),
)
def test_each_place_shows_what_is_nearest_to_the_camera_in_its_light(scene):
    m = motion_of(scene)
    what = taken(m, size=(240, 180), slow=1)
    numbers = np.linspace(0, what.times.size - 1, 3).astype(int)[1:]
    times = what.times[numbers]
    camera = stage(what, times).cameras[0]
    there = m.wanting("pose", t=times)
    turned = rotations(there.orientation)
    rng = np.random.default_rng(1)
    for k, picture in enumerate(frames(what, numbers)):
        found = nearest(m, turned[k], there.centre[k], camera, picture.shape, rng)
        # pixels along an edge mix two colours
        around = np.lib.stride_tricks.sliding_window_view(found, (3, 3), axis=(0, 1))
        inside = np.ptp(around, axis=(-2, -1)).max(axis=-1) < 0.1
        inside[140:, :140] = False  # the clock is here
        assert inside.sum() > 200
        off = np.abs(picture - 255 * found).max(axis=-1)[1:-1, 1:-1]
        assert (off[inside] < 12).mean() > 0.96 and np.median(off[inside]) < 3, (scene, k)


def nearest(m, rotation, centre, camera, shape, rng):
    """Colours (height, width, 3) of the nearest of many surface points in each pixel; NaN without any."""
    height, width, _ = shape
    picture, depth = np.full((height * width, 3), np.nan), np.full(height * width, np.inf)
    sun = np.array([-0.45, -0.5, 0.75])
    for part in parts(m.body):
        corners, normals = part.vertices[part.triangles], part.normals[part.triangles]
        area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=-1)
        which = rng.choice(len(area), 60_000, p=area / area.sum())
        root, v = np.sqrt(rng.random(which.size)), rng.random(which.size)
        share = np.stack([1 - root, root * (1 - v), root * v], -1)[..., None]
        place = (corners[which] * share).sum(1) @ rotation.T + centre
        normal = (normals[which] * share).sum(1) @ rotation.T
        place, normal = (x[((camera.eye - place) * normal).sum(1) > 0] for x in (place, normal))
        light = 0.52 + 0.16 * normal[:, 2] + 0.36 * np.maximum(normal @ sun / np.linalg.norm(sun), 0)
        x, y = camera(place).T
        pixel = np.floor((1 - y) * height / 2).astype(int) * width + np.floor(
            x * height / 2 + width / 2
        ).astype(int)
        far = np.linalg.norm(place - camera.eye, axis=-1)
        order = np.argsort(-far)
        pixel, far, colour = pixel[order], far[order], (light[:, None] * part.colour)[order]
        first = np.full(height * width, np.inf)
        first[pixel] = far
        ours = first < depth
        mine = np.full((height * width, 3), np.nan)
        mine[pixel] = colour
        picture[ours], depth[ours] = mine[ours], first[ours]
    return np.clip(picture, 0, 1).reshape(height, width, 3)


def test_the_mark_is_where_the_motion_has_it_at_the_time_of_each_frame():
    m = sc.roll(CYLINDER, CYLINDER.steady(0.15), 20.0)
    what = taken(m, size=(640, 360), slow=5)
    numbers = np.arange(0, what.times.size, what.times.size // 8)
    camera = stage(what, what.times[numbers]).cameras[0]
    there = m.wanting("pose", t=what.times[numbers])
    turned, seen = rotations(there.orientation), 0
    mark = marks(m.body)[0]
    corners = mark.vertices[mark.triangles]
    for k, picture in enumerate(frames(what, numbers)):
        red, _, blue = np.moveaxis(picture.astype(int), -1, 0)
        rows, columns = np.nonzero(blue - red > 60)
        place = corners @ turned[k].T + there.centre[k]
        flat = np.cross(place[:, 1] - place[:, 0], place[:, 2] - place[:, 0])
        facing = ((camera.eye - place[:, 0]) * flat).sum(-1) > 0
        if facing.mean() < 1 or rows.size < 100:
            continue
        xy = camera(place)
        (ax, ay), (bx, by) = np.moveaxis(xy[:, 1:] - xy[:, :1], 0, -1).transpose(1, 0, 2)
        middle = np.average(xy.mean(axis=1), axis=0, weights=np.abs(ax * by - ay * bx))
        expected = 320 + 180 * middle[0], 180 - 180 * middle[1]
        assert np.hypot(columns.mean() + 0.5 - expected[0], rows.mean() + 0.5 - expected[1]) < 1.5
        seen += 1
    assert seen >= 2


def test_the_camera_is_that_of_the_page(shown):
    for m, view in ((motion_of(scene), page_of(scene)) for scene in ("nutating", "tube")):
        page = shown(view, "#t=3")
        width, height = page.evaluate(
            "[document.querySelector('#stage').clientWidth, document.querySelector('#stage').clientHeight]"
        )
        what = taken(m, size=(2 * (width // 2), 2 * (height // 2)))
        camera = stage(what, what.times[:1]).cameras[0]
        for t in (0.0, 3.0, 7.5):
            x, y = camera(m.wanting("pose", t=[t]).centre[0])
            left, top = page.evaluate("t => window.spincyl.on(0, t)", t)
            assert np.hypot(left - width / 2 - x * height / 2, top - height / 2 + y * height / 2) < 2.5


# tables that are tilted or turn

WHEEL = sc.Body.solid(0.1)


def rolling_down(slope, phi0=-np.pi / 2, t=6.0):
    """A wheel that rolls straight down a slope from rest."""
    how = {"contact": sc.Coulomb(1.5), "restitution": 0.0, "want": "pose"}
    table = sc.Table(slope, phi0=phi0) if slope else None
    return sc.roll(WHEEL, sc.State(np.pi / 2, 0.0, 0.0, 0.0), np.linspace(0.0, t, 61), table=table, **how)


@pytest.mark.parametrize("slope", [0.3, 0.75, -0.9])
def test_on_a_slope_the_picture_is_that_of_a_level_table_whose_scene_is_turned_about_y(slope):
    m = rolling_down(slope, np.copysign(np.pi / 2, -slope))
    camera = stage(taken(m, follow=False), np.array([0.0])).cameras[0]
    # the axes of the table as seen from the room: x points downhill
    to_room = np.array(
        [[np.cos(slope), 0.0, -np.sin(slope)], [0.0, 1.0, 0.0], [np.sin(slope), 0.0, np.cos(slope)]]
    )
    places = np.random.default_rng(3).normal(size=(50, 3))
    room = camera._replace(at=camera.at @ to_room, rows=camera.rows @ to_room)
    assert np.allclose(camera(places), room(places @ to_room), rtol=0, atol=1e-12)
    # there the camera is upright: what hangs down is vertical in the middle of the picture, and y is horizontal ...
    assert np.allclose(room.rows[0, 2], 0.0, atol=1e-15) and room.rows[1, 2] > 0.5
    x, y = np.transpose(room(room.at + np.outer([-1.0, 0.0, 1.0], [0.0, 0.0, 1.0])))
    assert np.allclose(x, 0.0, atol=1e-12) and (np.diff(y) > 0.05).all()
    # ... the camera is above the table, and the path leads down in the picture
    assert camera.rows[2, 2] > 0.02
    low, high = np.sort(camera(m.centre[[0, -1]])[:, 1])
    assert high == pytest.approx(camera(m.centre[0])[1]) and high - low > 0.1
    assert np.abs(camera(m.centre) * [180 / 320, 1]).max() < 0.95


def test_a_wheel_that_rolls_down_stands_on_the_table_that_is_drawn_and_not_as_on_a_level_one():
    m, times = rolling_down("20 deg"), np.array([0.0, 3.0])
    (tilted,), (level,) = (
        list(frames(taken(x, follow=False), np.array([90]))) for x in (m, rolling_down(0.0))
    )
    assert (np.abs(tilted.astype(int) - level).max(axis=-1) > 20).mean() > 0.05
    what = stage(taken(m, follow=False), times)
    what.picture(1)
    path, camera, panel = what.moving[0].rolled.get_xydata(), what.cameras[0], what.panels[0]
    path = path[~np.isnan(path).any(axis=1)]
    there = m.wanting("pose", t=[3.0])
    contact = np.append(there.contact_point[0], 0.0)
    assert np.allclose(path[-1], camera(contact), atol=2e-3)
    # the lowest point of the wheel, along the normal of the table, is there
    rim = WHEEL.ell * np.array([0, 0, 1]) + np.array(
        [[np.cos(a), np.sin(a), 0] for a in np.linspace(0, 2 * np.pi, 3601)]
    )
    rims = (
        np.concatenate([rim, rim - 2 * WHEEL.ell * np.array([0, 0, 1])]) @ panel.rotation[1].T
        + panel.centre[1]
    )
    lowest = rims[np.argsort(rims[:, 2])[:2]]
    assert np.abs(lowest[:, 2]).max() < 1e-5 and np.abs(camera(lowest) - camera(contact)).max() < 0.2
    # the lines of the table pass through whole numbers of R in the table
    lines = what.axes[0].grid_lines.get_segments()
    crossing = camera(np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 0.0]]))
    ends = np.array([end for line in lines for end in line])
    assert all(distance_to_lines(point, lines) < 1e-6 for point in crossing) and len(ends) > 100
    assert "slope 20.0°" in what.moving[0].clock.get_text()


def distance_to_lines(point, lines):
    """The least distance of a point from straight pieces of lines."""
    a, b = np.array([[line[0], line[-1]] for line in lines]).transpose(1, 0, 2)
    along = b - a
    share = np.clip(((point - a) * along).sum(1) / (along**2).sum(1), 0.0, 1.0)
    return np.hypot(*(a + share[:, None] * along - point).T).min()


def test_the_lines_of_a_table_that_turns_turn_with_it_about_its_middle():
    ball, om = sc.Body.ball(0.0, 0.4, 0.4), 0.5
    m = sc.roll(ball, sc.State(1.0, 0.3, 0.0, 0.0), 20.0, table=sc.Table("5 deg", turning=om), want="pose")
    times = np.array([0.0, 1.3, 7.0])
    what = stage(taken(m), times)
    for k, t in enumerate(times):
        what.picture(k)
        lines = what.axes[0].grid_lines.get_segments()
        c, s = np.cos(om * t), np.sin(om * t)
        marked = np.array([[c, s, 0.0], [2 * c - s, 2 * s + c, 0.0]])  # (1, 0) and (2, 1) of the table
        assert all(distance_to_lines(point, lines) < 1e-6 for point in what.cameras[0](marked))
        beside = what.cameras[0](np.array([0.5 * c - 0.5 * s, 0.5 * s + 0.5 * c, 0.0]))
        assert distance_to_lines(beside, lines) > 0.02


def test_on_a_slope_the_page_shows_what_the_film_shows(shown):
    ball, start, tables = sc.Body.ball(0.0, 0.4, 0.4), sc.State(1.1, 0.5, 0.0, 1.5), ("25 deg", "-50 deg")
    for motion in (
        sc.roll(ball, start, np.array([0.0, 8.0]), table=sc.Table(x), want="pose") for x in tables
    ):
        page = shown(sc.view(motion), "#t=3")
        width, height = page.evaluate("[stage.clientWidth, stage.clientHeight]")
        camera = stage(taken(motion, size=(2 * (width // 2), 2 * (height // 2))), np.array([0.0])).cameras[0]
        for t in np.linspace(0.0, motion.t[-1], 4):
            x, y = camera(motion.wanting("pose", t=[t]).centre[0])
            left, top = page.evaluate("t => window.spincyl.on(0, t)", t)
            assert np.hypot(left - width / 2 - x * height / 2, top - height / 2 + y * height / 2) < 2.5
    assert "slope \u221250.0°" in page.locator(".clock").inner_text().replace("\xa0", " ")
    assert page.complaints == []


def test_on_the_page_too_the_lines_of_a_table_that_turns_turn_with_it(shown):
    ball, om = sc.Body.ball(0.0, 0.4, 0.4), 0.5
    table = sc.Table("5 deg", turning=om, place=(6.0, 0.0))
    m = sc.roll(ball, sc.State(np.pi / 2, 0.0, 0.0, -6.0 * om), 9.0, table=table, want="pose")
    page = shown(sc.view(m), "#t=0")
    width, height = page.evaluate("[stage.clientWidth, stage.clientHeight]")
    camera = stage(taken(m, size=(2 * (width // 2), 2 * (height // 2))), np.array([0.0])).cameras[0]
    for t in (0.0, 1.3, 7.0):
        pages.go(page, t)
        light = pages.picture(page).mean(axis=-1)
        c, s = np.cos(om * t), np.sin(om * t)
        middle = np.round([[c, s], [-s, c]] @ camera.at[:2])  # in the table
        seen = {}
        for aside in (2.0, 2.5, -2.0, -2.5):  # on a line of the table, and between two
            x, y = middle[0] + np.linspace(-3.0, 3.0, 601), middle[1] + aside
            right, up = camera(np.column_stack([c * x - s * y, s * x + c * y, 0 * x])).T
            places = [width / 2 + right * height / 2, height / 2 - up * height / 2]
            columns, rows = np.round(places).astype(int)
            there = (columns > 150) & (columns < width - 2) & (rows > 1) & (rows < height - 2)
            assert there.sum() > 80
            near = [light[rows[there] + i, columns[there] + k] for i in (-1, 0, 1) for k in (-1, 0, 1)]
            seen[aside] = np.median(np.min(near, axis=0))
        assert seen[2.0] < seen[2.5] - 0.01 and seen[-2.0] < seen[-2.5] - 0.01, (t, seen)
    assert page.complaints == []


def test_several_motions_stand_side_by_side_and_the_shadow_darkens_once():
    m = motion_of("nutating")
    (one,) = frames(taken(m), np.array([0]))
    (two,) = frames(
        taken(m, sc.roll(CYLINDER, m.start, 20.0, contact="smooth"), size=(640, 180)), np.array([0])
    )
    blue = [(x[..., 2].astype(int) - x[..., 0] > 60) for x in (one, two[:, :320], two[:, 320:])]
    assert all(b.sum() > 20 for b in blue) and blue[1].sum() == pytest.approx(blue[2].sum(), rel=0.05)
    # the darkest colour outside the body: the ground under one layer of shadow
    ground = np.array([0xE9, 0xE5, 0xDB])
    shade = np.abs(one.astype(int) - np.round(0.76 * ground)).max(axis=-1) <= 3
    assert shade.sum() > 300


@pytest.mark.parametrize("ell", [0.0, 0.5, 2.0])
@pytest.mark.parametrize("theta", [0.4, 1.2])
def test_the_shadows_of_a_cylinder_are_as_large_as_its_faces_and_its_side_seen_from_the_lamp(ell, theta):
    of = caster([lathe(profile) for profile in profiles(sc.Body.solid(ell))])
    c, s = np.cos(theta), np.sin(theta)
    rotation = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    points = lamps(LAMPS)
    for lamp, lines in zip(points, shadows(of, rotation, np.array([0.3, -1.0, 3.0]), points), strict=True):
        light = np.array([*lamp, -1.0])
        along = light @ rotation[:, 2]
        across = np.sqrt(light @ light - along**2)
        area = sum(
            0.5 * (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()
            for x, y in (line[:, :2].T for line in lines)
        )
        assert area == pytest.approx(np.pi * abs(along) + 4 * ell * across, rel=2e-3)


@pytest.mark.parametrize("body", [sc.Body.solid(1.0, fillet=0.4), sc.Body.balls(), sc.Body.tube(6.0, 0.8)])
@pytest.mark.parametrize("off", [1e-2, 5e-4])
def test_a_drawn_surface_has_few_triangles_which_are_as_close_to_the_true_one_as_they_have_to_be(body, off):
    for profile, part in zip(profiles(body), turned(body, off), strict=True):
        whole = lathe(profile)
        assert len(part.triangles) <= len(whole.triangles)
        # the middles of edges are farthest inside; places and normals of the whole surface are known on its rings
        edges = (
            part.vertices[part.triangles][:, [0, 1, 2], :] + part.vertices[part.triangles][:, [1, 2, 0], :]
        )
        middle = (
            np.column_stack([np.hypot(edges[:, :, 0], edges[:, :, 1]).ravel(), edges[:, :, 2].ravel()]) / 2
        )
        line = np.array(profile.corners)
        begin, along = line[:-1], np.diff(line, axis=0)
        share = ((middle[:, None] - begin) * along).sum(-1) / np.maximum((along**2).sum(-1), 1e-300)
        near = begin + np.clip(share, 0, 1)[..., None] * along
        away = np.linalg.norm(middle[:, None] - near, axis=-1).min(axis=1)
        assert away.max() <= 2 * off + 4e-4
    count = [
        sum(len(part.triangles) for part in surface) for surface in (turned(body, off), parts(body)[:-2])
    ]
    assert count[0] < (0.3 if off > 1e-3 else 1.0) * count[1] + 1


def test_a_shadow_has_one_outline_for_each_closed_piece_of_surface():
    for body, most in (
        (sc.Body.solid(1.0, fillet=0.4), 3),
        (sc.Body.ball(0.0, 0.4, 0.4), 1),
        (sc.Body.solid(1.0), 4),
    ):
        of = caster(turned(body, 2e-3))
        for lines in shadows(of, np.eye(3), np.array([0.0, 0.0, 2.0]), lamps(LAMPS)):
            assert 1 <= len(lines) <= most and sum(map(len, lines)) > 30


def test_only_where_there_are_triangles_is_the_picture_drawn_finely(monkeypatch):
    from matplotlib.backends import backend_agg

    made, agg = [], backend_agg.RendererAgg

    def renderer(width, height, dpi):
        made.append((width, height, dpi))
        return agg(width, height, dpi)

    monkeypatch.setattr(backend_agg, "RendererAgg", renderer)
    next(frames(taken(motion_of("nutating"), size=(640, 360)), np.array([0])))
    coarse = [x for x in made if x[2] == 100]
    fine = [x for x in made if x[2] == 200]
    assert {x[:2] for x in coarse} == {(640, 360)} and len(fine) == 1
    assert 0 < fine[0][0] * fine[0][1] < 0.35 * 4 * 640 * 360


def test_a_shadow_is_hard_at_the_contact_and_soft_far_from_the_body():
    (picture,) = frames(taken(sc.roll(CYLINDER, CYLINDER.steady(1.2), 1.0), size=(640, 360)), np.array([0]))
    ground, full = np.array([0xE9, 0xE5, 0xDB]), 0.76 * np.array([0xE9, 0xE5, 0xDB])
    share = ((ground - picture.astype(int)) / (ground - full)).mean(axis=-1)
    even = np.ptp((ground - picture.astype(int)) / (ground - full), axis=-1) < 0.15
    assert (even & (share > 0.4) & (share < 0.6)).sum() > 600, "no half shadow"


# files


@cache
def turning():
    """A tube for a tenth of a second, as a page, and the pictures of its film."""
    view = sc.view(sc.roll(PIPE, PIPE.steady(1.2), 0.1 / SCALE.seconds(1.0)), scale=SCALE, slow=10)
    return view, list(frames(reel(view, [edges(m) for m in view.motions], ".mp4", 20, (320, 180))))


@pytest.mark.parametrize("kind", [".mp4", ".gif"])
def test_a_file_holds_the_frames_with_their_rate_and_size(tmp_path, kind):
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    view, true = turning()
    path = view.save(tmp_path / f"film{kind}", fps=20, size=(320, 180))
    assert [x.name for x in tmp_path.iterdir()] == [path.name]
    words = [ffmpeg.get_ffmpeg_exe(), "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    ran = subprocess.run(words, capture_output=True, check=True)
    assert b"320x180" in ran.stderr and b" 20 fps" in ran.stderr
    seen = np.frombuffer(ran.stdout, np.uint8).reshape(-1, 180, 320, 3).astype(int)
    assert len(true) == 21 == len(seen)
    # uniform areas such as the paper keep their colour
    assert np.abs(seen[0][:10, 150:] - true[0][:10, 150:]).max() <= 3
    for k, picture in enumerate(seen):
        off = [np.abs(picture - x).mean() for x in true]
        assert int(np.argmin(off)) == k and off[k] < 4


def test_a_label_is_no_formula():
    for label in (r"$\foo$", "5$ for 2$", "a_b^c"):
        what = taken(motion_of("nutating"), labels=[label])
        (ours,), (none,) = (list(frames(x, np.array([0]))) for x in (what, what._replace(labels=[""])))
        assert (ours[:20] != none[:20]).any() and not (ours[30:] != none[30:]).any()


def test_a_gif_needs_no_program_and_keeps_its_time(tmp_path, monkeypatch):
    from PIL import Image

    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    monkeypatch.setenv("PATH", str(tmp_path))
    path = sc.view(sc.roll(CYLINDER, CYLINDER.steady(1.3), 0.4), slow=1).save(
        tmp_path / "film.GIF", size=(200, 101)
    )
    with Image.open(path) as film:
        assert film.n_frames == 11 and film.size == (200, 101) and film.info["loop"] == 0
        durations = []
        for k in range(film.n_frames):
            film.seek(k)
            durations.append(film.info["duration"])
    assert set(durations) == {40}


def program(folder, text):
    path = folder / "ffmpeg"
    path.write_text(f"#!{sys.executable}\nimport sys\n{text}")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)


def test_a_picture_is_the_frame_of_a_film_at_its_time(tmp_path):
    image = pytest.importorskip("PIL.Image")
    m = sc.roll(PIPE, PIPE.steady(1.2), 0.1 / SCALE.seconds(1.0))
    view = sc.view(m, scale=SCALE, slow=1)
    path = view.save(tmp_path / "picture.PNG", t=0.04, size=(321, 181))
    (frame,) = frames(taken(m, scale=SCALE, slow=1, fps=50, size=(321, 181), suffix=".gif"), np.array([2]))
    with image.open(path) as picture:
        assert np.abs(np.asarray(picture).astype(int) - frame).max() <= 1
    with image.open(view.save(tmp_path / "first.png")) as picture:
        assert picture.size == (1280, 720)
    for wrong, said in ((0.2, "t = 0.2: expected 0 to 0.1"), (float("nan"), "t = nan")):
        with pytest.raises(ValueError, match=said):
            view.save(tmp_path / "no.png", t=wrong)
    with pytest.raises(ValueError, match="t: only for a picture"):
        view.save(tmp_path / "no.gif", t=0.0)
    with pytest.raises(ValueError, match="only for a film"):
        view.save(tmp_path / "no.png", fps=10)
    assert not list(tmp_path.glob("no.*"))


def test_the_program_on_the_search_path_is_given_the_frames(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    program(
        tmp_path,
        "open(sys.argv[-1], 'wb').write(' '.join(sys.argv).encode() + b'\\n' + sys.stdin.buffer.read())",
    )
    monkeypatch.setenv("PATH", str(tmp_path))
    m = sc.roll(CYLINDER, CYLINDER.steady(1.3), 0.3)
    path = sc.view(m, slow=1).save(tmp_path / "film.mp4", size=(96, 64))
    words, raw = path.read_bytes().split(b"\n", 1)
    assert b"-s 96x64 -r 30 " in words and b"yuv420p" in words
    true = b"".join(x.tobytes() for x in frames(taken(m, size=(96, 64), slow=1)))
    assert len(raw) == 10 * 96 * 64 * 3 and raw == true


def test_what_ffmpeg_complains_of_is_told_and_leaves_no_file(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    bin_ = tmp_path / "bin"
    bin_.mkdir()
    program(bin_, "sys.stderr.write('Unknown encoder libx264'); sys.exit(1)")
    monkeypatch.setenv("PATH", str(bin_))
    old = tmp_path / "film.mp4"
    old.write_bytes(b"an older film")
    with pytest.raises(OSError) as told:
        page_of("nutating").save(old, size=(96, 64), seconds=1)
    assert str(told.value) == f"{old}: ffmpeg: Unknown encoder libx264"
    assert old.read_bytes() == b"an older film" and sorted(os.listdir(tmp_path)) == ["bin", "film.mp4"]


@pytest.mark.parametrize(
    ("name", "missing", "said"),
    [
        (
            "film.mp4",
            "imageio_ffmpeg",
            r"needs ffmpeg: .*python.* -m pip install 'spincyl\[film\]', or the program ffmpeg",
        ),
        ("film.mp4", "matplotlib", r"needs matplotlib: .*python.* -m pip install 'spincyl\[film\]'"),
        ("film.gif", "matplotlib", r"needs matplotlib: .*python.* -m pip install 'spincyl\[film\]'"),
    ],
)
def test_what_is_missing_for_a_film_is_named_with_what_installs_it(
    tmp_path, monkeypatch, name, missing, said
):
    monkeypatch.setitem(sys.modules, missing, None)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ImportError, match=said):
        page_of("nutating").save(tmp_path / name, seconds=1)
    assert not list(tmp_path.iterdir())


def test_films_that_no_file_can_hold_are_refused_with_what_would_be_right(tmp_path):
    view = page_of("nutating")
    for name, how, said in (
        ("film.avi", {}, r"ends in .html, .mp4, .gif, .png, .svg, .pdf or .glb"),
        ("film.gif", {"fps": 30}, "fps = 30: expected a divisor of 100 for a GIF, such as 50, 25, 20 or 10"),
        ("film.mp4", {"size": (321, 180)}, "even numbers"),
        ("film.mp4", {"size": (32, 18)}, "width = 32: expected a whole number from 64"),
        ("film.mp4", {"fps": 0}, "fps = 0: expected a whole number from 1 to 240"),
        ("page.html", {"fps": 30}, "fps, size, seconds, progress, sound: only for a film"),
        ("scene.glb", {"size": (640, 360)}, "fps, size, seconds, progress, sound: only for a film"),
    ):
        with pytest.raises(ValueError, match=said):
            view.save(tmp_path / name, **how)
    with pytest.raises(TypeError, match="size"):
        view.save(tmp_path / "film.mp4", size=640)
    with pytest.raises(FileNotFoundError):
        view.save(tmp_path / "nowhere" / "film.gif", size=(64, 64), seconds=1)
    assert not list(tmp_path.iterdir())


def test_a_film_that_is_cut_names_the_slow_motion_with_which_all_of_it_fits(tmp_path):
    m = motion_of("nutating").at(np.linspace(0, 5, 101))
    view = sc.view(m, slow=20)
    with pytest.warns(UserWarning, match=r"give seconds= for more, or slow=\d+ for all of it$") as caught:
        view.save(tmp_path / "film.gif", fps=1, size=(64, 64))
    slow = int(re.search(r"slow=(\d+)", str(caught[0].message))[1])
    lasts = float(re.search(r"of ([\d.]+) seconds", str(caught[0].message))[1])
    assert lasts / 20 * slow <= 10 and slow < 20
    with warnings.catch_warnings(action="error"):
        sc.view(m, slow=slow).save(tmp_path / "film.gif", fps=1, size=(64, 64))


def test_a_long_film_is_cut_and_says_so_and_how_much_of_it_is_done(tmp_path):
    from PIL import Image

    view, shares = sc.view(motion_of("nutating"), slow=2), []
    with pytest.warns(
        UserWarning, match="^the film shows the first 10 of 40 seconds; give seconds= for more$"
    ):
        view.save(tmp_path / "film.gif", fps=1, size=(64, 64), progress=shares.append)
    with Image.open(tmp_path / "film.gif") as film:
        assert film.n_frames == 11
    assert shares == sorted(shares) and len(shares) == 11 and shares[-1] == 1.0
    view.save(tmp_path / "film.gif", fps=1, size=(64, 64), seconds=40)
    with Image.open(tmp_path / "film.gif") as film:
        assert film.n_frames == 41
    for how, said in (
        ({"seconds": 0}, "^seconds = 0"),
        ({"seconds": 1e9}, "^seconds = 1000000000.0: expected"),
    ):
        with pytest.raises(ValueError, match=said):
            view.save(tmp_path / "film.gif", **how)
    with pytest.raises(TypeError, match="^progress: expected a function"):
        view.save(tmp_path / "film.gif", progress=3, seconds=1)


def test_a_large_film_is_warned_of(tmp_path, monkeypatch):
    monkeypatch.setattr("spincyl.studio.film._LARGE_FILE", 1e3)
    with pytest.warns(UserWarning, match=r"film.gif: 0 MB; reduce size=, fps= or seconds=; an .mp4"):
        page_of("nutating").save(tmp_path / "film.gif", fps=5, size=(64, 64), seconds=1)
