"""The live page in a browser: it reacts to the user, and its numbers are those of the library."""

import re

import numpy as np
import pytest
from pages import near, picture
from playing import DRIVEN, PHONE, address, ask, settled, state

import spincyl as sc
from spincyl.studio.pages.words import scenes
from spincyl.studio.shape import BLUE, IVORY, ORANGE, marks, profiles

#: Keeps what moves by itself from where it was drawn.
SHIFTS = """window.shifts = [];
new PerformanceObserver(list => { for (const e of list.getEntries()) window.shifts.push(e.value); }).observe({ type: "layout-shift", buffered: true });"""
NO_CORE = "delete window.WebAssembly;"
#: Counts the calls of the core.
COUNTS = """window.calls = 0;
const made = WebAssembly.instantiate.bind(WebAssembly);
const counted = ([name, x]) => [name, typeof x === "function" ? (...numbers) => { window.calls += 1; return x(...numbers); } : x];
WebAssembly.instantiate = async (...given) => {
  const { instance } = await made(...given);
  return { instance: { exports: Object.fromEntries(Object.entries(instance.exports).map(counted)) } };
};"""


def on_map(page, ell, theta):
    """Position of a point of the map on the page."""
    box, map_ = page.locator("#map").bounding_box(), ask(page, "map()")
    return box["x"] + box["width"] * ell / map_["widest"], box["y"] + box["height"] * (
        1 - theta / map_["steep"]
    )


def steady(told):
    """Body and start from the state of a page."""
    body = sc.Body.tube(told["ell"], told["bore"], told["fillet"])
    return body, body.steady(told["theta"]).kicked(told["kick"])


def test_it_asks_for_nothing_complains_of_nothing_and_shows_the_body(opened):
    page = opened("#ell=2.5&theta=1.3")
    image = drawn(page)
    assert near(image, IVORY, 0.05) > 0.03
    assert min(near(image, BLUE, 0.2), near(image, ORANGE, 0.2)) > 1e-3
    assert len(page.requests) == 1 and page.requests[0].startswith("file:")
    assert page.complaints == []


def drawn(page):
    return picture(page, "#canvas")


def test_its_numbers_are_those_of_the_library(opened):
    page = opened()
    for at in (
        "#ell=2.5&theta=1.3&kick=0.05",
        "#ell=6&bore=0.8&theta=1.5",
        "#ell=0.375&theta=1.4&kick=-0.01&contact=smooth",
    ):
        address(page, at)
        told, here, head = state(page), ask(page, "here()"), ask(page, "head()")
        body, start = steady(told)
        assert here["rate"] == pytest.approx(body.rate(told["theta"]), rel=1e-12)
        for contact in ("rolling", "smooth"):
            kappa = body.stability(told["theta"], contact)
            assert here[contact] == pytest.approx(kappa, rel=1e-10)
        rows = np.array(ask(page, "rows()"))
        m = sc.roll(body, start, rows[:, 0], want=("pose", "force"), contact=told["contact"])
        rows = rows[: m.t.size]  # the last row is the end of the motion
        bound = head["error"] + m.error + 1e-13
        assert np.abs(rows[:, 1] - m.theta).max() < bound
        assert np.abs(rows[:, 9] - m.normal).max() < 100 * bound
        assert np.abs(rows[:, 7:9] - m.contact_point).max() < 10 * (head["poseError"] + m.pose_error + 1e-13)


def test_a_point_is_dragged_over_the_map_and_everything_follows(opened):
    page = opened("#ell=2.5&theta=1.3")
    before, text = drawn(page), page.locator("#what").inner_text()
    page.mouse.move(*on_map(page, 2.5, 1.3))
    page.mouse.down()
    page.mouse.move(*on_map(page, 1.5, 1.0), steps=5)
    page.mouse.move(*on_map(page, 0.5, 1.3), steps=5)
    page.mouse.up()
    settled(page)
    told = state(page)
    assert told["ell"] == pytest.approx(0.5, abs=0.01) and told["theta"] == pytest.approx(1.3, abs=0.02)
    assert page.locator("#what").inner_text() != text
    assert np.abs(drawn(page) - before).mean() > 0.003
    # the address follows, and opens the same state
    page.wait_for_function("e => location.hash.startsWith(`#ell=${+e.toPrecision(7)}`)", arg=told["ell"])
    again = opened(page.evaluate("location.hash"))
    assert state(again)["theta"] == pytest.approx(told["theta"], rel=1e-6)
    assert ask(again, "here()")["rate"] == pytest.approx(ask(page, "here()")["rate"], rel=1e-5)


def test_the_finger_snaps_to_lines_and_the_sentence_names_them(opened):
    page = opened("#ell=2.5&theta=1.5")
    body = sc.Body.solid(2.5)
    balance, limit, fold = (float(x) for x in (body.theta_balance, body.theta_limit, body.ridge()[0]))
    for line, name in ((balance, "line: θ₀."), (limit, "line: θ∞."), (fold, "line: ridge.")):
        x, y = on_map(page, 2.5, line)
        page.mouse.click(x, y + 3)
        settled(page)
        assert state(page)["theta"] == pytest.approx(line, abs=5e-3), name
        assert name in page.locator("#what").inner_text()
        assert ask(page, "here()").get("rate", 0) > 0, "on the side where there is a steady state"
    # unless Alt is pressed
    page.keyboard.down("Alt")
    page.mouse.click(x, y + 6)
    page.keyboard.up("Alt")
    settled(page)
    assert abs(state(page)["theta"] - line) > 5e-3


def test_a_click_on_a_ghost_jumps_to_the_other_inclination_of_the_same_rate(opened):
    body = sc.Body.solid(0.75)
    rate = next(r for r in np.linspace(0.9, 2, 200) if body.count(r) > 1)
    theta, *others = [float(x) for x in body.inclinations(rate) if np.isfinite(x)]
    page = opened(f"#ell=0.75&theta={theta!r}")
    assert ask(page, "ghosts()") == pytest.approx(others, abs=1e-9)
    page.mouse.click(*on_map(page, 0.75, others[0]))
    settled(page)
    assert state(page)["theta"] == pytest.approx(others[0], abs=1e-9)
    assert ask(page, "here()")["rate"] == pytest.approx(rate, rel=1e-9)
    # also by the keyboard, and by a button that shows the other inclination
    page.locator("#map").focus()
    page.keyboard.press("g")
    settled(page)
    assert state(page)["theta"] != pytest.approx(others[0])
    page.locator("#others button").first.click()
    settled(page)
    assert ask(page, "here()")["rate"] == pytest.approx(rate, rel=1e-9)


def test_sliders_lists_and_keys_set_what_they_say(opened):
    page = opened("#ell=2.5&theta=1.3")

    def slide(name, value):
        page.locator(f"#knob-{name}").evaluate(
            "(e, x) => { e.value = x; e.dispatchEvent(new Event('input')); }", value
        )
        settled(page)

    slide("bore", 0.5)
    slide("fillet", 0.2)
    slide("kick", 0.1)
    slide("theta", 1.2)
    told = state(page)
    assert (told["bore"], told["fillet"], told["kick"], told["theta"]) == pytest.approx((0.5, 0.2, 0.1, 1.2))
    body = sc.Body.tube(2.5, 0.5, fillet=0.2)
    assert ask(page, "here()")["rate"] == pytest.approx(body.rate(1.2), rel=1e-10)
    slide("rate", 1.2)
    assert state(page)["theta"] in [pytest.approx(x) for x in body.inclinations(1.2) if np.isfinite(x)]
    slide("precession", 0.3)
    assert ask(page, "here()")["circle"] > 0
    page.select_option("#knob-contact", "coulomb")
    slide("mu", 0.2)
    page.select_option("#knob-law", "drilling")
    settled(page)
    told = state(page)
    assert (told["contact"], told["mu"], told["law"]) == ("coulomb", pytest.approx(0.2), "drilling")
    assert ask(page, "head()")["integrated"] == 1 and ask(page, "head()")["lost"] > 0
    for key, contact in (("i", "smooth"), ("r", "rolling"), ("v", "viscous"), ("c", "coulomb")):
        page.locator("#map").focus()
        page.keyboard.press(key)
        settled(page)
        assert state(page)["contact"] == contact
    page.select_option("#knob-law", "none")
    ell, theta = state(page)["ell"], state(page)["theta"]
    page.locator("#map").focus()
    for key in ("ArrowLeft", "ArrowUp"):
        page.keyboard.press(key)
    page.keyboard.press("Shift+ArrowUp")
    settled(page)
    assert state(page)["ell"] == pytest.approx(ell - 0.02)
    assert state(page)["theta"] == pytest.approx(theta + np.radians(1.1))


def test_the_body_is_tilted_by_hand_and_the_view_turned_beside_it(opened):
    page = opened("#ell=2.5&theta=1.3&t=0")
    box, (x, y) = page.locator("#canvas").bounding_box(), ask(page, "on()")
    theta, before = state(page)["theta"], drawn(page)
    page.mouse.move(box["x"] + x, box["y"] + y)
    page.mouse.down()
    page.mouse.move(box["x"] + x, box["y"] + y + 30, steps=4)
    page.mouse.up()
    settled(page)
    assert theta + 0.02 < state(page)["theta"] < theta + 0.3
    theta, before = state(page)["theta"], drawn(page)
    page.mouse.move(box["x"] + 15, box["y"] + 15)
    page.mouse.down()
    page.mouse.move(box["x"] + 120, box["y"] + 30, steps=4)
    page.mouse.up()
    settled(page)
    assert state(page)["theta"] == theta and np.abs(drawn(page) - before).mean() > 0.003


def test_every_scene_moves_and_is_what_it_says(opened):
    page = opened()
    for name, scene in scenes():
        page.select_option("#preset", name)
        settled(page)
        told, head = state(page), ask(page, "head()")
        for word, value in scene.items():
            expected = pytest.approx(value) if word != "w" else pytest.approx(value, rel=1e-12)
            assert told[word] == expected, (name, word)
        assert head["code"] == 0 and head["lasts"] > 0, name
        rows = np.array(ask(page, "rows()"))
        assert len(rows) > 10 and np.isfinite(rows[:, :9]).all(), name
        assert page.complaints == []


def test_a_flick_slips_and_is_told(opened):
    page = opened("#ell=6&bore=0.8&theta=1.5&mu=0.3")
    page.click("#flick")
    settled(page)
    told, head = state(page), ask(page, "head()")
    assert told["contact"] == "coulomb" and told["w"][4] != 0
    assert head["slipTime"] > 0 and "slips for" in page.locator("#details").inner_text().replace("\xa0", " ")


def test_bodies_look_as_they_do_everywhere_else(opened):
    bodies = [
        sc.Body.tube(2.5, 0.8),
        sc.Body.solid(0.1),
        sc.Body.solid(0.0),
        sc.Body.balls(),
        sc.Body.balls(1.5),
    ]
    bodies += [
        sc.Body.tube(1.5, 0.2, fillet=0.3),
        sc.Body.solid(2.5, fillet=1.0),
        sc.Body.ball(-0.2, 0.5, 0.45),
    ]
    bodies += [sc.Body(0.12, 0.26, 0.5, fillet=0.05), sc.Body(0.1, 0.4, 0.4, fillet=1.0, theta_end=2.0)]
    page = opened()
    for body in bodies:
        numbers = {"ell": body.ell, "bore": body.bore, "fillet": body.fillet, "most": body.theta_end}
        told = {k: None if np.isnan(v) else float(v) for k, v in numbers.items()}
        seen = page.evaluate(
            "b => window.spincyl.look(Object.fromEntries(Object.entries(b).map(([k, v]) => [k, v ?? NaN])))",
            told,
        )
        expected = profiles(body)
        assert len(seen["turned"]) == len(expected)
        for mine, theirs in zip(seen["turned"], expected, strict=True):
            assert np.allclose([c[:2] for c in mine["corners"]], theirs.corners, atol=1e-12), body
            if theirs.normals is not None:
                assert np.allclose([c[2:] for c in mine["corners"]], theirs.normals, atol=1e-12)
            assert mine["colour"] == pytest.approx(theirs.colour)
        for mine, theirs in zip(seen["marks"], marks(body), strict=True):
            assert np.allclose(np.reshape(mine["places"], (-1, 3)), theirs.vertices, atol=1e-12), body
            if body.fillet:  # for sharp walls `shape` keeps the order of older pages
                assert np.allclose(np.reshape(mine["normals"], (-1, 3)), theirs.normals, atol=1e-12)
            assert mine["colour"] == pytest.approx(theirs.colour)
            at, normals, which = (np.reshape(mine[k], (-1, 3)) for k in ("places", "normals", "triangles"))
            outward = np.cross(at[which[:, 1]] - at[which[:, 0]], at[which[:, 2]] - at[which[:, 0]])
            assert ((outward * normals[which[:, 0]]).sum(axis=1) > -1e-9).all()


def test_the_clock_never_runs_back_and_never_below_zero(opened):
    page = opened("#ell=2.5&theta=1.3", reduced_motion="no-preference", script=DRIVEN)
    page.wait_for_function("() => window.spincyl?.at", polling=50)
    times = []
    for ms in (9000, 9016, 9050, 9040, 9100, 60000):
        page.evaluate("ms => window.picture(ms)", ms)
        times.append(ask(page, "at()"))
    assert times[0] == 0 and (np.diff(times) >= 0).all() and times[-1] > times[2] > 0
    assert times[3] == times[2], "a picture from before takes no time"


def test_slow_motion_is_slow(opened):
    page = opened("#ell=2.5&theta=1.3&kick=0.1", reduced_motion="no-preference", script=DRIVEN)
    page.wait_for_function("() => window.spincyl?.at", polling=50)
    page.evaluate("window.picture(99000)")  # controls have no effect before the first frame
    passed = {}
    for slow in ("10", "1000"):
        page.select_option("#slow", value=slow)
        page.evaluate("window.picture(100000)")
        before, first = ask(page, "at()"), 100000
        for k in range(1, 11):
            page.evaluate("ms => window.picture(ms)", first + 10 * k)
        passed[slow] = ask(page, "at()") - before
    assert passed["10"] == pytest.approx(100 * passed["1000"], rel=1e-6) and passed["1000"] > 0
    # a tenth of a second for a body of 1 cm; for one of 4 cm the unit of time is twice as long
    assert passed["10"] == pytest.approx(0.1 / 10 / np.sqrt(0.01 / 9.80665), rel=1e-6)
    page.evaluate("window.spincyl.set({ radius: 0.04, slow: 10 })")
    page.evaluate("window.picture(100110)")
    before = ask(page, "at()")
    page.evaluate("window.picture(100200)")
    assert ask(page, "at()") - before == pytest.approx(0.09 / 10 / np.sqrt(0.04 / 9.80665), rel=1e-6)


def test_it_plays_at_once_unless_motion_is_unwelcome(opened):
    moving = opened("", reduced_motion="no-preference")
    moving.wait_for_function("() => window.spincyl.at() > 0")
    resting = opened("")
    resting.wait_for_timeout(300)
    assert ask(resting, "at()") == 0
    resting.keyboard.press("Space")
    resting.wait_for_function("() => window.spincyl.at() > 0")


def test_every_control_is_reached_by_the_tab_key_and_has_a_name(opened):
    page = opened("#ell=2.5&theta=1.3")
    reached = set()
    for _ in range(45):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("document.activeElement.id || document.activeElement.tagName"))
    wanted = {*"map canvas chart preset flick hear png film full SUMMARY play again slow".split()}
    wanted |= {*"omega momentum forces path above shutter knob-ell knob-theta knob-contact".split()}
    assert wanted <= reached, wanted - reached
    named = page.locator("button, select, input, canvas[tabindex]").evaluate_all(
        "all => all.filter(e => !(e.ariaLabel || e.textContent.trim() || e.labels?.[0]?.textContent.trim())).map(e => e.id)"
    )
    assert named == []


def test_on_a_phone_it_fits_keeps_still_and_can_be_hit_by_a_finger(opened):
    page = opened("#ell=2.5&theta=1.3", viewport=PHONE, has_touch=True, is_mobile=True, script=SHIFTS)
    page.wait_for_selector("html[data-drawn]")
    page.wait_for_timeout(500)
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    small = page.locator(
        "button:visible, select:visible, label:visible:has(input[type=checkbox]), summary:visible, input[type=range]:visible"
    ).evaluate_all(
        "all => all.map(e => [e.id || e.textContent, e.getBoundingClientRect()]).filter(([, b]) => b.width < 40 || b.height < 40).map(([n]) => n)"
    )
    assert small == []
    page.evaluate("window.spincyl.set({ theta: 0.7 })")
    page.wait_for_timeout(400)
    page.evaluate("window.spincyl.set({ ell: 0.4, theta: 1.4 })")
    page.wait_for_timeout(400)
    assert sum(page.evaluate("window.shifts")) < 0.01
    # a finger drags the point and does not scroll the page
    x, y = on_map(page, 1.5, 1.2)
    assert page.locator("#map").evaluate("e => getComputedStyle(e).touchAction") == "none"
    page.touchscreen.tap(x, y)
    settled(page)
    assert state(page)["ell"] == pytest.approx(1.5, abs=0.02)


def test_reset_brings_back_everything_that_hands_have_changed(opened):
    page = opened("#ell=2.5&theta=1.3&kick=0.1&mu=0.4")
    before, at = state(page), page.evaluate("location.hash")
    camera = (
        "[...document.querySelectorAll('#drawn input, #slow, #shutter')].map(e => [e.id, e.checked, e.value])"
    )
    view = "window.spincyl.on()"
    boxes, middle = page.evaluate(camera), page.evaluate(view)
    page.locator("#knob-ell").fill("1.2")
    page.locator("#knob-contact").select_option("smooth")
    page.locator("#slow").select_option("100")
    for name in ("omega", "path", "above"):
        page.click(f"#{name}")
    page.click("#hear")
    page.locator("#canvas").focus()
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("+")
    page.keyboard.press(".")
    settled(page)
    assert state(page)["contact"] == "smooth" and state(page)["ell"] != 2.5
    assert page.evaluate(camera) != boxes and page.evaluate(view) != middle
    page.click("#reset")
    settled(page)
    assert state(page) == before and page.evaluate(camera) == boxes
    assert page.evaluate(view) == pytest.approx(middle, abs=1)
    assert ask(page, "at()") == 0 and ask(page, "audio()") is None
    page.wait_for_function("at => location.hash === at", arg=at)
    page.select_option("#preset", "a rattleback turns back")
    settled(page)
    page.click("#reset")
    settled(page)
    assert state(page) == before and page.locator("#map").is_visible() and page.complaints == []


def test_a_low_window_keeps_its_controls_and_a_phone_on_its_side_what_fits(opened):
    low = opened("#ell=2.5&theta=1.3", viewport={"width": 1024, "height": 560})
    side = opened("#ell=2.5&theta=1.3", viewport={"width": 844, "height": 390})
    assert low.locator("#knob-ell").is_visible() and low.locator("#chart").is_visible()
    for name in ("map", "canvas", "tell"):
        box = side.locator(f"#{name}").bounding_box()
        assert box["height"] > 60 and box["y"] + box["height"] <= 390, name
    assert low.evaluate("document.documentElement.scrollWidth") == 1024


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_regions_are_told_by_hatching_and_name_not_by_hue_alone(opened, scheme):
    page = opened("#ell=2.5&theta=1.3", color_scheme=scheme)
    page.wait_for_function("() => window.spincyl.map().names.length")
    named = ask(page, "map()")["names"]
    assert {found["code"] for found in named if found["size"] > 0} >= {7, 5, 1}
    legend = page.locator("#legend").inner_text()
    assert all(
        word in legend for word in ("stable because it rolls", "forbidden", "unstable", "stable on ice only")
    )
    # without colour, the regions differ in how their brightness varies in space
    swatches = page.locator("#legend canvas")
    patterns = []
    for i in range(swatches.count()):
        grey = swatches.nth(i).evaluate(
            "c => Array.from(c.getContext('2d').getImageData(0, 0, c.width, c.height).data).filter((_, i) => i % 4 === 0)"
        )
        image = np.array(grey).reshape(22, 34)
        patterns.append(image != np.bincount(image.ravel()).argmax())
    for i, a in enumerate(patterns):
        for b in patterns[:i]:
            assert (a != b).mean() > 0.05


def test_where_webassembly_is_not_allowed_a_picture_and_a_sentence_stand_in(opened):
    page = opened("", script=NO_CORE)
    page.wait_for_selector("html[data-failed]")
    assert all(word in page.locator("#missing").inner_text() for word in ("WebAssembly", "spincyl.view"))
    assert page.locator("#missing svg").is_visible() and not page.locator("main").is_visible()


def test_a_photograph_of_the_paper_shows_letters_and_can_be_closed(opened):
    page = opened("#ell=6&bore=0.8&theta=1.562", viewport=PHONE)
    page.select_option("#shutter", "1")
    page.wait_for_function("() => document.documentElement.dataset.exposed > 20")
    image = drawn(page)
    assert image.max() > 0.4 and np.median(image) < 0.2, "light in a dark room"
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    page.wait_for_function("() => document.getElementById('shutter').value === '0'")


def test_a_picture_and_a_film_are_saved(opened, chromium):
    page = opened("#ell=2.5&theta=1.3&kick=0.1")
    with page.expect_download() as got:
        page.click("#png")
    assert got.value.suggested_filename == "spincyl.png"
    assert got.value.path().read_bytes().startswith(b"\x89PNG\r\n\x1a\n")
    page.click("#hear")
    page.click("#film")
    page.wait_for_timeout(max(1500, chromium.patience / 40))  # the first frame of a film takes its time
    assert re.fullmatch(r"stop \d+\.\d s", page.locator("#film").inner_text())
    with page.expect_download() as got:
        page.click("#film")
    content, name = got.value.path().read_bytes(), got.value.suggested_filename
    kinds = {"spincyl.mp4": (4, b"ftyp"), "spincyl.webm": (0, b"\x1a\x45\xdf\xa3")}
    if page.evaluate("MediaRecorder.isTypeSupported('video/mp4')"):
        assert name == "spincyl.mp4"
    at, begins = kinds[name]
    assert content[at : at + 4] == begins and len(content) > 2000
    assert any(word in content for word in (b"mp4a", b"Opus", b"A_OPUS")), "with its sound"
    told = page.locator("#because").inner_text()
    assert re.fullmatch(rf"A film of (\d+\.\d) s is saved: {re.escape(name)}", told), told


def test_far_times_cost_no_more_than_near_ones(opened):
    page = opened("#ell=2.5&theta=1.3&kick=0.1", script=COUNTS)
    page.wait_for_selector("html[data-drawn]")
    count = (
        "t => { const { pose } = window.spincyl, before = window.calls;"
        " for (let i = 0; i < 400; i++) pose(t + i); return window.calls - before; }"
    )
    near, far = page.evaluate(count, 1.0), page.evaluate(count, 9e3)
    assert near == far > 0, "as many calls of the core"
    assert ask(page, "head()")["evaluations"] == 0, "and none of them makes steps"
    assert re.match(r"#ell=2\.5&theta=1\.3", page.evaluate("location.hash"))


def test_the_sound_is_switched_by_a_button_and_silent_while_it_rests(opened):
    page = opened("#ell=0.17&theta=0.3&law=dry-contour&loss=0.005&until=100")
    page.click("#hear")
    assert page.locator("#hear").get_attribute("aria-pressed") == "true"
    page.keyboard.press("s")
    assert page.locator("#hear").get_attribute("aria-pressed") == "false"
    assert page.complaints == []


def test_a_page_without_friction_moves_on_rubber_and_ice_and_says_what_it_does_not_know(opened):
    page = opened("#ell=0.375&theta=1.4&kick=-0.01&contact=smooth", page=sc.play(friction=False))
    assert ask(page, "head()")["code"] == 0 and len(ask(page, "rows()")) > 10
    assert page.locator("#knob-contact option").count() == 2 and not page.locator("#flick").is_visible()
    assert page.locator("#knob-mu, #knob-law, #knob-loss").count() == 0
    page.evaluate("window.spincyl.set({ contact: 'coulomb' })")
    settled(page)
    assert "made without friction" in page.locator("#because").inner_text()
    assert page.complaints == []
