"""Parts common to both pages: the WebGL context, the theme, and three sizes of screens."""

import numpy as np
import pytest
from page_scenes import live_page, page_of
from pages import near, picture
from playing import LAPTOP, PHONE, ask, settled, state

import spincyl as sc
from spincyl.studio.pages.joined import _without_spaces
from spincyl.studio.shape import BLUE, ORANGE

NO_WEBGL = """{ const plain = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...how) { return kind === "webgl2" ? null : plain.call(this, kind, ...how); }; }"""
NIGHT = "() => document.documentElement.hasAttribute('data-night')"
#: Starts without a steady state, or motions that end at their start: whether the body stands still or moves.
STILL = {
    "End on the slider": "#ell=2.5&theta=1.570796",
    "a flick": "#ell=1.198797&theta=1.570796&contact=coulomb&w=2.20633,0,0.8631339,0,0.4400477",
    "wet, at rest": "#ell=2.5&theta=1.570796&w=0,0,0,0,0&contact=viscous",
    "balls that touch with both ends": "#ell=1&i1=0.4&i3=0.4&fillet=1&end=1.570796&theta=1.570796",
    "a kick too great": "#ell=2.5&theta=1.3&kick=3",
}
MOVING = {
    "on its face": "#ell=2.5&theta=0.001",
    "at rest": "#ell=2.5&theta=0.9&w=0,0,0,0,0",
    "a coin on edge": "#ell=0&theta=1.570796",
    "the longest": "#ell=8&bore=1&theta=1",
    "a stone without spin": "#stone=0.07,0.014,0.012&spin=0",
}


@pytest.mark.parametrize("at", STILL.values(), ids=STILL)
def test_a_motion_of_no_length_is_a_body_that_stands_still(opened, at):
    page = opened(at, viewport={"width": 800, "height": 560})
    assert ask(page, "head()")["lasts"] == 0 and len(ask(page, "rows()")) == 1
    assert "the body stands still" in page.locator("#because").inner_text()
    assert np.ptp(picture_of(page), axis=(0, 1)).max() > 0.4, "a body on a table"
    for key in ("Space", "0", ".", ","):
        page.keyboard.press(key)
    page.check("#omega")
    page.select_option("#shutter", "1")
    page.wait_for_function("() => document.documentElement.dataset.exposed > 0")
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    settled(page)
    assert page.complaints == []


def picture_of(page):
    return picture(page, "#canvas")


def test_every_other_edge_of_the_sliders_moves_and_complains_of_nothing(opened):
    page = opened("", viewport={"width": 800, "height": 560})
    for name, at in MOVING.items():
        page.evaluate("at => { location.hash = at; }", at)
        settled(page)
        assert ask(page, "head()")["lasts"] > 0 and len(ask(page, "rows()")) > 100, name
        assert page.complaints == [], name
    # by keyboard, to the end of theta and back
    page.evaluate("location.hash = '#ell=2.5&theta=1.3'")
    settled(page)
    page.locator("#knob-theta").press("End")
    settled(page)
    assert state(page)["theta"] == pytest.approx(np.pi / 2) and len(ask(page, "rows()")) == 1
    page.locator("#knob-theta").press("Home")
    settled(page)
    assert len(ask(page, "rows()")) > 100 and page.complaints == []


def test_no_angle_is_missing_in_a_sentence_about_balls(opened):
    page = opened("", page=sc.play(sc.Body.balls(1.5), 0.5))
    for theta in (0.1, 0.5, 1.0, 1.4):
        page.evaluate("theta => window.spincyl.set({ theta })", theta)
        settled(page)
        assert "–°" not in page.locator("#tell").inner_text()


def test_it_opens_on_the_tube_of_the_paper_with_both_letters_and_its_shutter_a_tap_away(opened):
    page = opened("")
    assert state(page)["ell"] == pytest.approx(6) and state(page)["radius"] == pytest.approx(7.9375e-3)
    image = picture_of(page)
    assert near(image, BLUE, 0.2) > 4e-4 and near(image, ORANGE, 0.2) > 4e-4
    page.get_by_role("button", name="see the still symbols").click()
    page.wait_for_function("() => document.documentElement.dataset.exposed > 4")


def test_the_first_picture_of_a_recorded_tube_shows_both_letters(shown):
    image = picture(shown(page_of("still symbols"), "#t=0"))
    assert near(image, BLUE, 0.2) > 5e-4 and near(image, ORANGE, 0.2) > 5e-4


def test_without_webgl_all_but_the_body_works(opened):
    page = opened("#ell=2.5&theta=1.3", script=NO_WEBGL)
    page.wait_for_selector("html[data-drawn]")
    assert "WebGL 2" in page.locator("#unlit").inner_text() and not page.locator("#relight").is_visible()
    assert page.locator("#shutter").is_disabled() and page.locator("#omega").is_disabled()
    page.locator("#map").focus()
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Space")
    page.wait_for_function("() => window.spincyl.at() > 0")
    assert state(page)["theta"] == pytest.approx(1.3 + np.radians(1))
    assert page.locator("#what").inner_text() == "Stable" and "t = " in page.locator(".clock").inner_text()
    assert page.complaints == []


@pytest.mark.parametrize("make", [lambda: page_of("nutating"), live_page], ids=["recorded", "live"])
def test_a_context_that_the_browser_takes_is_said_to_be_gone_and_drawn_again(shown, make):
    page = shown(make(), "#t=1", viewport=LAPTOP, reduced_motion="reduce")
    before = picture_of(page)
    page.evaluate(
        "document.getElementById('canvas').getContext('webgl2').getExtension('WEBGL_lose_context').loseContext()"
    )
    page.wait_for_selector("#relight")
    assert "taken this picture back" in page.locator("#unlit").inner_text()
    page.click("#relight")
    assert np.abs(picture_of(page) - before).mean() < 0.01 and not page.locator("#unlit").is_visible()
    page.focus("#canvas")  # event handlers have moved to the new canvas
    page.mouse.move(*(page.locator("#canvas").bounding_box()[x] + 15 for x in "xy"))
    page.mouse.down()
    page.mouse.move(*(page.locator("#canvas").bounding_box()[x] + 95 for x in "xy"), steps=3)
    page.mouse.up()
    assert np.abs(picture_of(page) - before).mean() > 0.002
    assert not [x for x in page.complaints if "CONTEXT_LOST" not in x]


def test_of_twenty_views_in_a_notebook_all_that_are_seen_are_drawn(chromium, tmp_path):
    frame = page_of("nutating")._repr_html_()
    path = tmp_path / "notebook.html"
    path.write_text("<meta charset=utf-8><body data-jp-theme-light=false>" + f"<div>{frame}</div>" * 20)
    page = chromium.new_page(viewport=LAPTOP, reduced_motion="reduce")
    page.set_default_timeout(chromium.patience)
    page.goto(path.as_uri())
    drawn = page.locator("iframe").first.content_frame.locator("html[data-drawn]")
    drawn.wait_for()
    # the notebook's theme reaches the frame, and changes of it, too
    inner = page.frames[1]
    inner.wait_for_function(NIGHT)
    page.evaluate("document.body.dataset.jpThemeLight = 'true'")
    inner.wait_for_function(NIGHT.replace("=> ", "=> !"))
    for i in (19, 0):
        page.locator("iframe").nth(i).scroll_into_view_if_needed()
        there = page.locator("iframe").nth(i).content_frame
        there.locator("html[data-drawn]").wait_for()
        live = "() => !document.getElementById('canvas').getContext('webgl2').isContextLost() && document.getElementById('unlit').hidden"
        page.frames[i + 1].wait_for_function(live)
    # a frame out of view draws nothing, so it cannot be asked for a picture
    gone = "() => document.getElementById('canvas').getContext('webgl2').isContextLost()"
    page.frames[20].wait_for_function(gone, polling=100)
    page.close()


@pytest.mark.parametrize("touch", [False, True], ids=["fine", "coarse"])
@pytest.mark.parametrize("make", [lambda: page_of("nutating"), live_page], ids=["recorded", "live"])
def test_every_control_is_whole_on_a_phone_a_laptop_and_a_wall(shown, make, touch):
    page = shown(make(), "#t=1", viewport=LAPTOP, has_touch=touch, reduced_motion="reduce")
    assert page.evaluate("matchMedia('(pointer: coarse)').matches") == touch
    for size in (PHONE, LAPTOP, {"width": 1920, "height": 1080}):
        page.set_viewport_size(size)
        settled(page)
        controls = page.locator("#controls > *, #bar > *, #drawn > *, #knobs > label").evaluate_all(
            "all => all.map(e => [e.textContent.slice(0, 20), e.getBoundingClientRect()]).filter(([, b]) => b.width)"
        )
        assert len(controls) > 5
        for name, box in controls:
            assert box["left"] >= 0 and box["right"] <= size["width"] + 1, (name, size)
            assert box["bottom"] <= size["height"] + 1 or size is PHONE, (name, size)
        cut = page.locator("#knobs > label").evaluate_all(
            "all => all.filter(e => e.scrollHeight > e.clientHeight + 1).map(e => e.textContent)"
        )
        assert cut == []
        if size is not PHONE:  # no single control in a second line
            tops = page.locator("#controls > *").evaluate_all(
                "all => all.map(e => e.offsetTop + e.offsetHeight / 2)"
            )
            assert not tops or max(tops) - min(tops) < 12


def test_a_script_without_its_spaces_says_the_same():
    code = 'const a = b + +c - -d, t = ` ${ f ? ` = ${ "}" } ` : "" } = `, s = " , ";\n'
    assert _without_spaces(code) == 'const a=b+ +c- -d,t=` ${ f ? ` = ${ "}" } ` : "" } = `,s=" , ";\n'
