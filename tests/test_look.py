"""What views show besides the body, and from where: arrows, axis, cameras, long exposures, vector drawings."""

from xml.etree import ElementTree

import numpy as np
import pytest
from letters import letters
from page_scenes import CUP, CYLINDER, DISK, EGG, PIPE, TIPPE, flicked, motion_of
from pages import arrow, near, picture
from PIL import Image
from playing import settled
from test_film import stage, taken

import spincyl as sc
from spincyl.studio.arrows import _rods, drawings, vectors
from spincyl.studio.frames import frames
from spincyl.studio.look import opened
from spincyl.studio.poses import seen, span
from spincyl.studio.shape import rotations

ALL = ("omega", "momentum", "velocity", "force")


def turning(ell, turns=1.0):
    """A tube almost on its side that shows `ell` still symbols a turn."""
    body = sc.Body.tube(ell, bore=0.8)
    state = body.steady(np.radians(89.5))
    return sc.roll(body, state, turns * 2 * np.pi / state.precession)


# vectors


@pytest.mark.parametrize(
    "m",
    [
        motion_of("nutating"),
        motion_of("rounded"),
        motion_of("cup"),
        sc.roll(TIPPE, sc.State(0.6, 1.0, 0.0, 6.0), 2.0),
        sc.roll(DISK, DISK.circular(1.2, 0.8).kicked(0.3), 3.0),
    ],
    ids=["cylinder", "rounded", "cup", "tippe top", "disk on a circle"],
)
def test_the_arrows_are_the_vectors_of_newton_and_euler_and_the_axis_passes_through_the_contact(m):
    t = np.linspace(*span(m), 9)[1:-1]
    there = m.wanting("pose", "force", t=t)
    of = vectors(m, t, ALL).of
    # e1, e2, e3 by the angles, without the quaternion
    s, c, sp, cp = np.sin(there.theta), np.cos(there.theta), np.sin(there.phi), np.cos(there.phi)
    e1, e2 = np.stack([c * cp, c * sp, s], -1), np.stack([-sp, cp, 0 * s], -1)
    w1, w2, w3 = there.w.T[..., np.newaxis]
    e3 = np.cross(e1, e2)
    omega, momentum = w1 * e1 + w2 * e2 + w3 * e3, m.body.i1 * (w1 * e1 + w2 * e2) + m.body.i3 * w3 * e3
    fast = 1 + np.abs(omega).max()
    assert np.abs(of["omega"] - omega).max() < 1e-6 * fast
    assert np.abs(of["momentum"] - momentum).max() < 1e-6 * fast * max(m.body.i1, m.body.i3)
    # the contact point is at rest
    arm = there.centre - np.column_stack([there.contact_point, np.zeros(t.size)])
    assert np.abs(of["velocity"] - np.cross(omega, arm)).max() < 1e-6 * fast * np.abs(arm).max()
    assert np.abs(of["normal"] + of["friction"] - there.contact_force).max() < 1e-9
    # the body's own axis of its drawing agrees with e3
    assert np.abs(rotations(there.orientation)[..., 2] - e3).max() < 1e-12
    for k in range(t.size):
        *_, (_, name, root, way, _, _) = _rods(vectors(m, t, ()).at(k), 1.0)
        off = there.centre[k] - arm[k] - root
        assert name == "omega" and np.linalg.norm(np.cross(off, way)) < 1e-5 * np.linalg.norm(arm[k])
    # at the ends by one-sided differences
    ends = np.array(span(m))
    (w,) = seen(m, ends, "w")
    assert np.allclose(
        np.linalg.norm(vectors(m, ends, ()).of["omega"], axis=1), np.linalg.norm(w, axis=1), rtol=1e-4
    )


def test_where_the_centre_rests_the_axis_is_the_line_from_the_contact_through_the_centre_to_o():
    what = taken(turning(6.0), drawn=["axis"], size=(640, 360), slow=1)
    ready = stage(what, what.times[[20]])
    now = ready.panels[0].vectors.at(0)
    line = now.centre - now.contact
    assert np.linalg.norm(np.cross(now.of["omega"], line)) < 1e-8 * np.linalg.norm(line)
    _, tips = drawings(now, ("axis",), ready.sizes, ready.half, ready.cameras[0], ready.colour)
    assert [tip.letter for tip in tips] == ["P", "C", "O"]
    # O is where the body has the top of its upper rim
    rotation = ready.panels[0].rotation[0]
    e1 = line - rotation[:, 2] * (line @ rotation[:, 2])
    top = now.centre + e1 / np.linalg.norm(e1) + PIPE.ell * rotation[:, 2]
    assert np.abs(tips[2].at - ready.cameras[0](top)).max() < 1e-6


def test_an_arrow_of_a_stone_is_its_angular_velocity_in_the_laboratory():
    m = sc.roll(EGG, sc.EllipsoidState([0.8, 0.0, 0.6], [0.0, 1.7, 0.2]), 2.0)
    t = np.linspace(*span(m), 7)[1:-1]
    w, orientation = seen(m, t, "w", "orientation")
    turned = rotations(orientation)
    of = vectors(m, t, ()).of
    assert np.abs(of["omega"] - np.einsum("nij,nj->ni", turned, w)).max() < 1e-6
    inertia = np.einsum("nij,jk,nk->ni", turned, np.asarray(EGG.inertia), w)
    assert np.abs(of["momentum"] - inertia).max() < 1e-6


# cameras


def test_from_above_the_camera_is_that_of_the_page(shown):
    m = motion_of("flick")
    page = shown(sc.view(m, above=True, follow=False), "#t=3")
    assert page.locator("#above").is_checked() and not page.locator("#follow").is_checked()
    width, height = page.evaluate("[stage.clientWidth, stage.clientHeight]")
    what = taken(m, size=(2 * (width // 2), 2 * (height // 2)), above=True, follow=False)
    camera = stage(what, np.array([0.0])).cameras[0]
    for t in (0.0, 3.0, 57.5):
        centre = m.wanting("pose", t=[t]).centre[0]
        x, y = camera(centre)
        left, top = page.evaluate("t => window.spincyl.on(0, t)", t)
        assert np.hypot(left - width / 2 - x * height / 2, top - height / 2 + y * height / 2) < 2.5
        # without perspective, and x to the right
        assert np.allclose(camera(centre + np.array([1, 0, 5])) - (x, y), [1 / camera.high, 0], atol=1e-5)


@pytest.mark.parametrize("above", [False, True])
def test_a_camera_that_follows_has_the_centre_of_the_body_in_the_middle(above):
    # a ball that is at another place at each time: only its middle is everywhere the same
    ball = sc.Body.ball(0.0, 0.4, 0.4)
    m = sc.roll(ball, sc.State(1.0, 0.0, 0.0, -1.0), 60.0)
    what = taken(m, follow=True, above=above, drawn=(), size=(320, 320), slow=1)
    ready = stage(what, what.times[[0, 400, 1500]])
    for k in range(3):
        whole = ready.picture(k).astype(int)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(ready.moving[0].surface, "draw", lambda _: None)
            rows, columns = np.nonzero(np.abs(whole - ready.picture(k)).max(-1) > 8)
        # the view is of a place somewhat below the middle of the ball
        assert (columns.min() + columns.max()) / 2 == pytest.approx(160, abs=2)
        assert (rows.min() + rows.max()) / 2 == pytest.approx(160, abs=2 if above else 16)
        assert columns.max() - columns.min() > 100
    assert np.ptp(seen(m, what.times, "centre")[0][:, :2], axis=0).max() > 10
    away = stage(taken(m, follow=False, slow=1, above=above), what.times[[300]])
    assert ready.cameras[0].high < 0.5 * away.cameras[0].high


def test_a_page_has_the_look_that_its_view_was_given(shown):
    m = motion_of("nutating")
    page = shown(sc.view(m, drawn=["velocity", "force", "axis"], follow=True), "#t=1")
    on = [
        x
        for x in ("omega", "momentum", "velocity", "forces", "path", "axis", "above", "follow")
        if page.is_checked(f"#{x}")
    ]
    assert on == ["velocity", "forces", "axis", "follow"]
    tips = page.locator(".tip:visible")
    assert {tips.nth(k).inner_text() for k in range(tips.count())} == {"v", "N", "F", "P", "C", "O"}
    # the centre stays in the middle
    places = [page.evaluate("t => window.spincyl.on(0, t)", t) for t in (1.0,)]
    middle = page.evaluate("[stage.clientWidth / 2, stage.clientHeight / 2]")
    assert abs(places[0][0] - middle[0]) < 2
    plain = shown(sc.view(m), "#t=1")
    assert (
        plain.is_checked("#path") and not plain.is_checked("#axis") and plain.locator("#follow").count() == 0
    )


def test_on_a_page_the_velocity_of_the_centre_points_where_it_moves(shown):
    m = sc.roll(DISK, DISK.circular(1.2, 0.8), 9.0)
    page = shown(sc.view(m), "#t=2", keep=True)
    tip = arrow(page, "velocity")
    before, after = (np.array(page.evaluate("t => window.spincyl.on(0, t)", t)) for t in (1.95, 2.05))
    way = (after - before) * [1, -1]
    assert tip @ way > 0.995 * np.hypot(*tip) * np.hypot(*way)
    page.check("#axis")
    settled(page)
    tips = page.locator(".tip:visible")
    assert sorted(tips.nth(k).inner_text() for k in range(tips.count())) == ["C", "O", "P"]
    page.uncheck("#axis")
    settled(page)


# long exposures


def still(view, path, **how):
    with Image.open(view.save(path, **how)) as image:
        return np.asarray(image.convert("RGB"), float)


@pytest.mark.parametrize("count", [3, 6])
def test_a_still_with_an_open_shutter_has_as_many_os_as_symbols_stand_still_and_no_x(tmp_path, count):
    image = still(sc.view(turning(count, 2.0), exposure=1), tmp_path / "spin.png", size=(640, 640))
    # blue over red, in which the grey words do not count
    light = np.clip(image[..., 2] - image[..., 0], 0, None)
    assert letters(light, 0.5) == (count, 0)
    other = still(sc.view(turning(count, 2.0), exposure=1, upper="X"), tmp_path / "spin.png", size=(640, 640))
    light = np.clip(other[..., 0] - other[..., 2], 0, None)
    assert letters(light, 0.5) == (0, count)


def test_in_a_film_the_symbols_come_one_after_another_and_stay(tmp_path):
    m = turning(6.0, 2.5)
    what = taken(m, exposure=1, size=(360, 360), slow=1, fps=10)
    counts, first = [], None
    for k in (0.25, 0.5, 1.0, 1.5, 2.4):
        number = int(np.argmin(np.abs(what.times - k * m._asked.times[-1] / 2.5)))
        (image,) = frames(what, np.array([number]))
        light = np.clip(image[..., 2].astype(float) - image[..., 0], 0, None)
        counts.append(letters(light, 0.6)[0])
        if k == 1.5:
            first = image.astype(float).mean()
    assert counts[0] <= 2 and counts[1] <= 4 and counts[2:] == [6, 6, 6], counts
    assert image.astype(float).mean() == pytest.approx(first, rel=0.02)


def test_a_shutter_is_open_for_its_turns_or_to_the_end():
    along = np.linspace(0, 10, 101)
    turned = 0.05 * along**2
    for before in (False, True):
        for t, turns in ((4.9, 1.0), (4.03, 0.5), (6.0, 0.01), (7.77, 1.5)):
            first, last = opened(t, turns, along, turned, before=before)
            assert (last if before else first) == t
            assert 0.05 * (last**2 - first**2) == pytest.approx(turns, abs=5e-4)
        # the other way round it is as long
        assert opened(3.0, 0.7, along, -turned, before=before) == opened(
            3.0, 0.7, along, turned, before=before
        )
    assert opened(9.0, 5.0, along, turned, before=False) == (9.0, 10.0)
    assert opened(9.0, 5.0, along, turned, before=True) == (0.0, 9.0)
    assert opened(3.0, np.inf, along, turned, before=False) == (3.0, 10.0)


def test_a_page_opens_its_shutter(shown):
    page = shown(sc.view(turning(3.0), exposure=1), "#t=0", viewport={"width": 560, "height": 480})
    page.wait_for_selector("html[data-exposed='720']")
    image = picture(page)
    assert letters(np.clip(image[..., 2] - image[..., 0], 0, None), 0.55) == (3, 0)
    page.click("#stop")
    settled(page)
    assert picture(page).mean() > 0.5


# vector drawings


@pytest.mark.parametrize("name", ["spin.svg", "spin.PDF"])
def test_a_vector_drawing_has_no_pixels_and_shows_what_the_picture_shows(tmp_path, name):
    m = turning(6.0)
    path = sc.view(m, labels=["a <tube>"], drawn=["path", "omega", "axis"]).save(
        tmp_path / name, t=1.0, size=(640, 360)
    )
    text = path.read_bytes()
    if name.endswith("PDF"):
        assert text.startswith(b"%PDF") and b"/Image" not in text.replace(b"/ImageB", b"").replace(
            b"/ImageC", b""
        ).replace(b"/ImageI", b"")
        return
    root = ElementTree.fromstring(text)
    kinds = [x.tag.split("}")[1] for x in root.iter()]
    assert "image" not in kinds and kinds.count("path") > 300
    assert root.get("viewBox") == "0 0 460.8 259.2"
    colours = {x.get("style", "").partition("fill: ")[2][:7] for x in root.iter()} - {""}
    blue = [c for c in colours if c.startswith("#") and int(c[5:7], 16) - int(c[1:3], 16) > 60]
    assert len(blue) > 2, "no O"
    assert path.stat().st_size < 1e6
    exposed = sc.view(m, exposure=1).save(tmp_path / "exposed.svg", size=(200, 200))
    kinds = [x.tag.split("}")[1] for x in ElementTree.parse(exposed).iter()]
    assert kinds.count("image") == 1


@pytest.mark.parametrize(
    ("how", "kind", "said"),
    [
        ({"drawn": "shadow"}, ValueError, "drawn = 'shadow': expected some of"),
        ({"drawn": ["omega", "O"]}, ValueError, "drawn = 'O': expected some of"),
        ({"drawn": 3}, TypeError, "drawn: expected"),
        ({"above": 1}, TypeError, "above: expected True or False"),
        ({"follow": "body"}, TypeError, "follow: expected True or False"),
        ({"exposure": 0}, ValueError, "exposure = 0.0: expected at least 0.01 turns"),
        ({"exposure": float("nan")}, ValueError, "exposure = nan"),
        ({"exposure": "1"}, TypeError, "exposure"),
    ],
)
def test_a_look_that_no_view_has_is_refused_by_name(how, kind, said):
    with pytest.raises(kind, match=f"^({said})"):
        sc.view(motion_of("steady"), **how)


def test_an_exposure_that_begins_at_the_end_is_refused_and_leaves_no_file(tmp_path):
    m = turning(3.0)
    with pytest.raises(ValueError, match="^t = .*: expected a time before the end, for an exposure"):
        sc.view(m, exposure=1).save(tmp_path / "late.png", t=float(m.t[-1]))
    assert not list(tmp_path.iterdir())


def test_a_cup_is_drawn_as_a_cup(tmp_path):
    # from above an upright cup shows its floor, in the shade of the inside, inside its wall
    m = CUP.roll(CUP.natural.steady(0.01), 0.1)
    image = still(sc.view(m, above=True, drawn=()), tmp_path / "cup.png", size=(400, 400))
    middle, paper = image[195:205, 195:205].mean((0, 1)), image[5, 5]
    assert np.abs(middle - paper).max() > 15
    assert near(image / 255, (0.0, 0.36, 0.65)) > 0.002, "the stripe inside"


def test_times_of_a_film_have_the_digits_that_its_frames_need():
    tube = sc.roll(CYLINDER, CYLINDER.steady(1.3), 0.3)
    told = {}
    for slow, fps in ((1, 30), (10, 30), (1000, 50)):
        what = taken(tube, slow=slow, fps=fps)
        ready = stage(what, what.times[:2])
        said = [ready._clock(t) for t in what.times[:40]]
        assert len({*said}) == len(said)
        told[slow] = said[1]
    assert told[1] == "t = 0.03 √(R/g)" and told[10] == "t = 0.003 √(R/g)"


def test_a_flick_may_be_exposed(tmp_path):
    m = sc.roll(PIPE, flicked(), 20.0, contact=sc.Coulomb(0.3))
    image = still(sc.view(m, exposure=0.5), tmp_path / "flick.png", t=10.0, size=(200, 200))
    assert (image.max(-1) > 60).mean() > 0.005


def test_a_vector_drawing_that_fails_leaves_what_was_there(monkeypatch, tmp_path):
    view = sc.view(motion_of("steady"))
    old = tmp_path / "old.svg"
    old.write_text("old")
    monkeypatch.setattr("spincyl.studio.frames._Stage.draw", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        view.save(old)
    assert old.read_text() == "old" and len([*tmp_path.iterdir()]) == 1
