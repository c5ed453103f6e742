"""The rattleback of the live page: it turns back as in the library; the rest of the page is the same."""

import numpy as np
import pytest
from few import few
from page_scenes import live_page
from pages import near, picture
from playing import DRIVEN, LAPTOP, PHONE, ask, details, settled, state
from scipy.spatial.transform import Rotation

import spincyl as sc
from spincyl.studio.pages.words import scenes
from spincyl.studio.shape import BLUE, ORANGE, marks, profiles

NAME = "a rattleback turns back"
AT = "#stone=0.07,0.014,0.012&twist=0.0349066&spin=-5&slow=1"


def motion(twist, spin, t):
    """The motion of the page's rattleback by the library, in SI."""
    stone = sc.Ellipsoid.rattleback((0.07, 0.014, 0.012), twist=twist).in_metres()
    push = np.radians(0.02)
    start = stone.spinning(spin * stone.scale.seconds(1.0), pitch=push, roll=push)
    return sc.roll(stone, start, t, t0=0.0, want="pose")


def turns_back(m):
    """The last zero of the spin before it reaches a tenth of the first spin in the other sense."""
    way = m.spin * np.sign(m.spin[0])
    if not (way < -0.1 * way[0]).any():
        return None
    end = int(np.argmax(way < -0.1 * way[0]))
    return float(m.t[np.flatnonzero(way[:end] > 0)[-1]])


def shown_map(page):
    """The visible parts of the page."""
    return {
        x: page.locator(f"#{x}").is_visible() for x in ("map", "knobs", "flick", "hear", "twirl", "chart")
    }


def what(page):
    return page.locator("#what").inner_text()


def test_the_scene_opens_with_its_slider_its_buttons_and_no_map(opened):
    page = opened()
    before = shown_map(page)
    assert before == {"map": True, "knobs": True, "flick": True, "hear": True, "twirl": False, "chart": True}
    page.select_option("#preset", NAME)
    settled(page)
    after = shown_map(page)
    assert after == {
        "map": False,
        "knobs": False,
        "flick": False,
        "hear": False,
        "twirl": True,
        "chart": True,
    }
    told = dict(scenes())[NAME]
    assert {name: state(page)[name] for name in told} == told
    assert what(page) == "It turns back after 2.4 s"
    assert "end to end grows at a rate of 2.8 per second" in page.locator("#because").inner_text()
    assert "end to end 9.94 Hz, growth 2.81 per second" in details(page)
    assert page.locator("#clockwise").get_attribute("aria-pressed") == "true"
    assert page.complaints == []


@pytest.mark.parametrize(("twist", "spin"), few([(2.0, -5.0), (-3.0, 5.0), (2.0, 5.0), (0.0, -5.0)], 2))
def test_what_it_shows_is_the_motion_of_the_library(opened, twist, spin):
    page = opened(f"#stone=0.07,0.014,0.012&twist={float(np.radians(twist))!r}&spin={spin}")
    rows, head = np.array(ask(page, "rows()")), ask(page, "head()")
    unit = (0.07 / 9.80665) ** 0.5
    m = motion(np.radians(twist), spin, rows[:, 0] * unit)
    off = head["error"] + m.error + m.pose_error
    assert np.abs(rows[:, 13] - m.spin * unit).max() < 2 * off
    expected = turns_back(m)
    if expected is None:
        assert head["back"] == [] and not what(page).startswith("It turns back after")
    else:
        assert head["back"][0] * unit == pytest.approx(expected, abs=0.02)
        assert what(page) == f"It turns back after {head['back'][0] * unit:.1f} s"
    # also between two rows
    for t in (0.777, 3.21, 12.345):
        pose, here = ask(page, f"pose({t / unit!r})"), motion(np.radians(twist), spin, [t])
        turn = np.reshape(pose["matrix"], (4, 4))[:3, :3].T
        assert np.abs(turn - Rotation.from_quat(here.orientation[0]).as_matrix()).max() < 2e-3 + 4 * off
        assert np.abs(np.array(pose["centre"]) - here.centre[0] / 0.07).max() < 2e-3 + 4 * off


def test_the_slider_twists_it_and_at_a_twist_of_0_nothing_turns_back(opened):
    page = opened(AT)
    twist = page.locator("#twist")
    twist.focus()
    page.keyboard.press("ArrowRight")
    settled(page)
    assert state(page)["twist"] == pytest.approx(np.radians(2.1), abs=1e-9)
    assert page.locator("#twirl output").inner_text() == "2.1°"
    faster = ask(page, "head().back")[0]
    for value, said in (
        ("0", "Nothing turns back"),
        ("-2", "It turns back after 11.2 s"),
        ("6", "It turns back after 0.9 s"),
    ):
        twist.evaluate("(e, v) => { e.value = v; e.dispatchEvent(new Event('input')); }", value)
        settled(page)
        assert what(page) == said
    assert ask(page, "head().back")[0] < faster
    assert twist.get_attribute("aria-valuetext") == "6.0°"


def test_both_buttons_spin_it_and_the_address_keeps_it(opened):
    page = opened(AT)
    page.click("#counterclockwise")
    settled(page)
    assert state(page)["spin"] == 5 and ask(page, "rows()")[0][13] > 0
    assert (
        what(page) == "It turns back after 11.3 s"
        and "side to side grows" in page.locator("#because").inner_text()
    )
    assert page.locator("#play").get_attribute("aria-label") == "pause", "what is spun moves"
    page.wait_for_function("location.hash.includes('spin=5')")
    kept = page.evaluate("location.hash")
    assert kept.startswith("#") and "ell" not in kept and "stone=0.07,0.014,0.012" in kept
    again = opened(kept)
    assert str(state(again)) == str(state(page))
    page.click("#clockwise")
    settled(page)
    assert state(page)["spin"] == -5 and what(page) == "It turns back after 2.4 s"


def test_the_clock_tells_the_spin_and_when_it_has_turned_back(opened):
    early, late = opened(AT + "&t=5"), opened(AT + "&t=80")
    clock = [page.locator(".clock").inner_text() for page in (early, late)]
    assert "spin −5.0 rad/s" in clock[0] and "turned" not in clock[0]
    assert "spin +5.0 rad/s" in clock[1] and "turned back at 2.4" in clock[1]


def test_a_body_of_revolution_after_it_is_as_it_was(opened):
    page, other = opened(AT), opened("#ell=2.5&theta=1.3&kick=0.05")
    page.evaluate("location.hash = '#ell=2.5&theta=1.3&kick=0.05'")
    page.wait_for_function("document.getElementById('map').clientWidth > 0")
    for each in (page, other):  # the path with more points
        each.wait_for_function("() => window.spincyl.rows().length === 1500")
    for of in ("head()", "here()", "body()", "ghosts()", "rows()", "tracks()", "pose(3)"):
        assert ask(page, of) == ask(other, of), of
    assert what(page) == what(other)
    assert {x for x, seen in shown_map(page).items() if seen} == {"map", "knobs", "flick", "hear", "chart"}


@pytest.mark.parametrize(("at", "stone"), [("#ell=2.5&theta=1.3", [0.07, 0.014, 0.012]), (AT, None)])
def test_what_follows_a_change_by_a_moment_may_come_before_the_next_picture(opened, at, stone):
    page = opened(at, script=DRIVEN)
    page.wait_for_selector("main", state="attached")
    page.evaluate("window.picture(0)")
    page.evaluate("stone => { window.spincyl.solve({}); window.spincyl.set({ stone }); }", stone)
    # time for the address, the fine map and the fine path
    page.evaluate("() => new Promise(done => setTimeout(done, 400))")
    page.evaluate("window.picture(16)")
    assert page.complaints == [] and len(ask(page, "rows()")) > 10


@pytest.mark.parametrize("at", ["0.07,0.014,0.012", "0.02,0.05,0.012"])
def test_it_looks_as_it_does_everywhere_else(opened, at):
    page = opened(f"#stone={at}&twist=0.03&spin=3")
    stone = sc.Ellipsoid.rattleback([float(x) for x in at.split(",")], twist=0.03)
    seen = page.evaluate("window.spincyl.stone()")
    expected = profiles(stone)
    for mine, theirs in zip(seen["turned"], expected, strict=True):
        assert np.allclose([c[:2] for c in mine["corners"]["corners"]], theirs.corners, atol=1e-12)
        assert np.allclose(mine["corners"]["axes"], theirs.stretch.axes)
        assert np.allclose(mine["corners"]["centre"], theirs.stretch.centre)
    for mine, theirs in zip(seen["marks"], marks(stone, "O"), strict=True):
        places = np.reshape(mine["places"], (-1, 3))
        middles = places[np.reshape(mine["triangles"], (-1, 3))].mean(axis=1)
        others = theirs.vertices[theirs.triangles].mean(axis=1)
        apart = np.linalg.norm(middles[:, None] - others, axis=-1)
        assert (
            apart.shape[0] == apart.shape[1]
            and np.maximum(apart.min(axis=0), apart.min(axis=1)).max() < 1e-12
        )
        assert mine["colour"] == pytest.approx(theirs.colour)


@pytest.mark.parametrize("size", [LAPTOP, PHONE])
def test_everything_of_it_is_on_the_screen_and_its_marks_are_seen(opened, size):
    page = opened(AT + "&t=20", viewport=size)
    image = picture(page, "#canvas")
    assert near(image, BLUE, 0.2) > 1e-3 and near(image, ORANGE, 0.2) > 1e-3
    for x in ("stage", "chart", "twist", "clockwise", "counterclockwise"):
        box = page.locator(f"#{x}").bounding_box()
        assert box["x"] >= 0 and box["x"] + box["width"] <= size["width"], x
        assert box["height"] > 15 and (size is PHONE or box["y"] + box["height"] <= size["height"]), x


def test_a_page_without_friction_has_no_stones(opened):
    page = opened(AT, live_page(False))
    assert "stone=0.07" in details(page) and page.locator("#twirl").count() == 0
    assert NAME not in page.locator("#preset").inner_text() and page.complaints == []


def test_where_it_is_thrown_about_it_is_followed_until_it_lifts_off(opened):
    page = opened("#stone=0.07,0.014,0.012&twist=0.1&spin=-40")
    head = ask(page, "head()")
    assert head["code"] == 0
    if head["ending"]:
        assert "lifts off" in page.locator("#because").inner_text()
    assert np.array(ask(page, "rows()"))[:, 16].min() > 0
