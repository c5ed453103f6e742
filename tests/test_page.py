"""The recorded page in use: the clock, controls, sizes, colours, ends, the exposure."""

import numpy as np
import pytest
from few import few
from letters import letters
from page_scenes import DISK, ENDS, PIPE, STANDING, motion_of, page_of
from pages import arrow, at, clock, go, picture
from playing import DRIVEN, settled
from scipy import ndimage

import spincyl as sc
from spincyl.studio.shape import BLUE, ORANGE


def test_the_clock_of_a_busy_machine_starts_at_the_start_and_never_runs_back(shown):
    page = shown(page_of("nutating", slow=1), script=DRIVEN + "window.performance.now = () => 10000;")
    times = []
    # play is pressed at 10 s; the next frame has an earlier time
    for ms in (9000, 9016, 9116, 9100, 9150, 60000):
        page.evaluate("ms => window.picture(ms)", ms)
        times.append(at(page))
    assert times == pytest.approx([0.0, 0.016, 0.116, 0.116, 0.166, 0.416])
    # after a pause it continues from the same time
    for _ in range(2):
        page.click("#play", no_wait_after=True)
    page.evaluate("window.picture(59000)")
    page.evaluate("window.picture(59100)")
    assert at(page) == pytest.approx(0.516)


def test_time_is_kept_by_play_pause_scrub_and_slow_motion(shown):
    page = shown(page_of("nutating"), "#t=3")
    assert at(page) == 3.0 and clock(page) == "t = 3.000 √(R/g)\nθ = 73.1°"
    start = picture(page)
    go(page, 7.5)
    assert at(page) == pytest.approx(7.5) and np.abs(picture(page) - start).mean() > 0.01
    passed = {}
    for speed in ("1", "0.001"):
        page.select_option("#speed", speed)
        before = at(page)
        page.click("#play")
        page.wait_for_timeout(700)
        page.click("#play")
        passed[speed] = at(page) - before
        still = at(page)
        page.wait_for_timeout(200)
        assert at(page) == still
    assert passed["1"] > 0.05
    assert 1e-5 < passed["0.001"] < passed["1"] / 100
    # the motion stops at its end, and play starts it anew
    page.select_option("#speed", "2")
    go(page, 19.9)
    page.click("#play")
    page.wait_for_selector("#play[aria-label=play]")
    assert at(page) == 20.0
    page.click("#play")
    page.wait_for_timeout(100)
    assert at(page) < 19.0


def test_it_plays_at_once_unless_motion_is_unwelcome(shown):
    playing = shown(page_of("nutating"))
    playing.wait_for_function("() => window.spincyl.at() > 0")
    resting = shown(page_of("nutating"), reduced_motion="reduce")
    resting.wait_for_timeout(300)
    assert at(resting) == 0


def test_a_body_is_round_on_a_large_screen(shown):
    coin = sc.roll(DISK, sc.State(1e-4, 0.0, 0.0, 1.0), 1.0, contact="smooth")
    page = shown(sc.view(coin), "#t=0", viewport={"width": 1920, "height": 1080}, color_scheme="dark")
    page.check("#above")
    page.uncheck("#path")
    light = picture(page).mean(axis=-1)
    x, y = page.evaluate("window.spincyl.on(0, 0)")
    angle = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    radius = np.arange(300.0, 530.0, 0.1)
    ray = ndimage.map_coordinates(
        light, [y - np.outer(np.sin(angle), radius) - 0.5, x + np.outer(np.cos(angle), radius) - 0.5], order=1
    )
    # the edge consists of whole pixels; a mean over six neighbours smooths it
    rim = radius[(ray > 0.4).cumsum(axis=1).argmax(axis=1)].reshape(-1, 6).mean(axis=1)
    # with forty sides the middle of a side would lie 1.2 pixels inside its corners
    assert rim.min() > 350 and np.ptp(np.percentile(rim, [2, 98])) < 0.7, np.percentile(
        rim, [0, 2, 50, 98, 100]
    )


def test_vectors_path_and_view_from_above_can_be_switched(shown):
    page = shown(page_of("nutating"), "#t=6")
    last = picture(page)
    for name in ("omega", "momentum", "path", "above"):
        page.locator(f"#{name}").click()
        now = picture(page)
        assert np.abs(now - last).max() > 0.1, name
        last = now


def test_it_is_turned_and_zoomed_by_mouse_wheel_fingers_and_keys(shown):
    page = shown(page_of("nutating"), "#t=6", has_touch=True)
    last = picture(page)

    def changed():
        nonlocal last
        before = last
        for _ in range(20):  # an input event may arrive after the next frame
            last = picture(page)
            if np.abs(last - before).mean() > 0.003:
                return True
        return False

    page.mouse.move(300, 200)
    page.mouse.down()
    page.mouse.move(400, 230, steps=4)
    page.mouse.up()
    assert changed()
    page.mouse.wheel(0, 300)
    assert changed()
    page.locator("canvas").evaluate(
        """c => { const send = (kind, id, x) => c.dispatchEvent(new PointerEvent(kind, { pointerId: id, clientX: x, clientY: 200 }));
        c.setPointerCapture = () => {}; send("pointerdown", 11, 300); send("pointerdown", 12, 350);
        send("pointermove", 12, 450); send("pointerup", 11, 300); send("pointerup", 12, 450); }"""
    )
    assert changed()
    page.locator("canvas").focus()
    for key in ("ArrowLeft", "ArrowUp", "+"):
        page.keyboard.press(key)
        assert changed(), key
    page.keyboard.press(".")
    assert at(page) == pytest.approx(6 + 1 / 60)
    page.keyboard.press("0")
    assert at(page) == 0
    page.keyboard.press("Space")
    page.wait_for_function("() => window.spincyl.at() > 0")


def test_every_control_is_reached_by_the_tab_key(shown):
    page = shown(page_of("nutating"), "#t=1")
    reached = []
    for _ in range(15):
        page.keyboard.press("Tab")
        reached.append(page.evaluate("document.activeElement.id || document.activeElement.tagName"))
    controls = ["canvas", "play", "time", "speed", "omega", "momentum", "velocity", "path", "axis", "above"]
    controls += ["shutter", "hear", "full", "SUMMARY"]
    assert reached[: len(controls)] == controls


def test_on_a_phone_and_on_a_wall_nothing_sticks_out_and_text_is_read_from_afar(shown):
    page = shown(page_of("nutating", labels=("word " * 30,)), "#t=1")
    screens = [(360, 640), (390, 844), (844, 390), (800, 480), (1280, 720), (1920, 1080), (3840, 2160)]
    for width, height in screens:
        page.set_viewport_size({"width": width, "height": height})
        settled(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        boxes = page.locator("#controls > *").evaluate_all("all => all.map(e => e.getBoundingClientRect())")
        for box in boxes:
            assert box["left"] >= 0 and box["right"] <= width and box["bottom"] <= height
        assert page.locator("canvas").bounding_box()["height"] > 0.5 * height
        size = {
            what: page.locator(what).first.evaluate("e => parseFloat(getComputedStyle(e).fontSize)")
            for what in ("#speed", ".clock", ".panel b")
        }
        assert min(size.values()) >= max(15, 0.017 * height) and size[".clock"] >= max(18, 0.02 * height)


def test_every_control_of_the_recorded_page_can_be_hit_by_a_finger(shown):
    how = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}
    for scene in ("nutating", "hoop"):
        page = shown(page_of(scene), "#t=1", **how)
        small = page.locator(
            "#controls :is(button, select, label:has(input[type=checkbox]), summary, #time):visible"
        ).evaluate_all(
            "all => all.map(e => [e.id || e.textContent, e.getBoundingClientRect()]).filter(([, b]) => b.width < 40 || b.height < 40).map(([n, b]) => [n, b.width, b.height])"
        )
        assert small == []
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_the_clock_tells_milliseconds_where_the_page_shows_less_than_a_second(shown):
    size = sc.Scale(radius=7.9375e-3)
    for seconds, said in ((0.4, "t = 200.00 ms"), (4.0, "t = 2.0000 s")):
        m = sc.roll(PIPE, PIPE.steady(1.3), seconds / size.seconds(1.0))
        view = sc.view(m, scale=size, slow=10)
        assert clock(shown(view, f"#t={seconds / 2}")).startswith(said + "\n")
    assert clock(shown(sc.view(m), "#t=7")).startswith("t = 7.00 √(R/g)")


def test_light_and_dark_have_their_own_ground(shown):
    light, dark = (
        picture(shown(page_of("nutating"), "#t=1", color_scheme=c, keep=True))[5, 5]
        for c in ("light", "dark")
    )
    assert light.min() > 0.85 and dark.max() < 0.2


def test_motions_run_in_step_and_one_that_ended_says_how(shown):
    rolling, sliding = sc.roll(DISK, STANDING, 30.0), motion_of("side")
    page = shown(sc.view(rolling, sliding), "#t=29")
    said = page.locator(".panel").all_inner_texts()
    assert "rolling" in said[0] and "smooth" in said[1]
    assert clock(page).startswith("t = 29.000") and "ended" not in said[0]
    words = sliding.message.split(" at t =")[0]
    assert clock(page, 1) == f"ended: {words}, t = {sliding.event.time:.3f} √(R/g)\nθ = 90.0°"
    boxes = [page.locator(".panel").nth(i).bounding_box() for i in range(2)]
    assert boxes[0]["x"] + boxes[0]["width"] <= boxes[1]["x"] + 1


def warm(page):
    """Share of the picture with the colours of the body, in the dark."""
    image = picture(page)
    most, least = image.max(axis=-1), image.min(axis=-1)
    return float(((image[..., 0] > image[..., 2]) & (most - least > 0.05 * most) & (most > 0.25)).mean())


@pytest.mark.parametrize("kind", few(ENDS, 3))
def test_a_body_is_grey_from_its_end_on_and_the_clock_says_why_and_when(shown, kind):
    m = motion_of(kind)
    page = shown(page_of(kind), f"#t={0.97 * m.event.time}", color_scheme="dark")
    assert warm(page) > 0.02 and clock(page).startswith("t = ")
    go(page, m.event.time)
    words, told = m.message.split(" at t =")[0], clock(page)
    assert warm(page) < 5e-3 and told.startswith(f"ended: {words}, t = ")
    assert float(told.split("t = ")[1].split()[0]) == pytest.approx(m.event.time, abs=5e-3)
    go(page, 0)
    assert warm(page) > 0.02 and clock(page).startswith("t = ")


def test_beyond_an_end_and_beyond_what_was_asked_for_the_page_says_so(shown):
    beyond = sc.roll(DISK, STANDING, 10.0, contact="smooth", beyond=True)
    brief = sc.roll(DISK, STANDING, [5.0, 7.0], t0=0.0)
    page = shown(sc.view(beyond, brief), "#t=3")
    assert clock(page).startswith("t = 3.000") and clock(page, 1).startswith("shown from t = 5.000")
    go(page, 6.0)
    assert clock(page).startswith("beyond the model: the other rim landed")
    assert f"t = {beyond.event.time:.3f} " in clock(page) and clock(page, 1).startswith("t = 6.000")
    go(page, 9.0)
    assert clock(page, 1).startswith("shown until t = 7.000")


def test_who_listens_is_told_of_an_end_and_of_an_exposure(shown):
    page = shown(page_of("face", labels=("can",)), "#t=1.4")
    page.click("#play")
    page.wait_for_selector("#play[aria-label=play]")
    said = page.get_by_role("status").first.inner_text().replace("\xa0", " ")
    assert said.startswith(
        "can: ended: the face landed on the table: the body lies flat, t = 1.4700 √(R/g), θ = 0.0°"
    )
    assert page.locator("#drawn").get_attribute("title") == ""
    page.select_option("#shutter", "1")
    page.wait_for_selector("html[data-exposed]")
    assert "stay as they are until the photograph is closed" in page.locator("#drawn").get_attribute("title")
    assert page.get_by_role("progressbar").is_visible()


def luminance(colour):
    light = [x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in colour]
    return float(np.dot(light, [0.2126, 0.7152, 0.0722]))


def contrast(a, b):
    dark, light = sorted(luminance(x) for x in (a, b))
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_arrows_are_told_apart_without_hue_and_from_the_marks_by_it(shown, scheme):
    page = shown(page_of("nutating"), "#t=1", color_scheme=scheme, keep=True)
    style = "n => getComputedStyle(document.documentElement).getPropertyValue('--' + n).trim()"
    omega, momentum, ground, paper = (
        np.array([int(text[i : i + 2], 16) for i in (1, 3, 5)]) / 255
        for text in (page.evaluate(style, n) for n in ("omega", "momentum", "ground", "paper"))
    )
    assert contrast(omega, momentum) > 2
    for ground_ in (ground, paper):
        assert contrast(omega, ground_) > 3 and contrast(momentum, ground_) > 3

    def hue(colour):
        off = np.subtract(colour, np.mean(colour))
        return off / np.linalg.norm(off)

    for mark in (BLUE, ORANGE):
        assert hue(omega) @ hue(mark) < 0.6 and hue(momentum) @ hue(mark) < 0.6


@pytest.mark.parametrize("moment", few([4.0, 1.0, 11.0], 1))
def test_each_arrow_has_its_letter_beside_its_tip(shown, moment):
    page = shown(page_of("nutating"), f"#t={moment}", keep=True)
    assert page.locator(".tip:visible").count() == 0
    tips, places = {}, {}
    for name in ("omega", "momentum"):
        tips[name] = arrow(page, name)
    for name in ("omega", "momentum"):
        page.check(f"#{name}")
    settled(page)
    centre = np.array(page.evaluate("window.spincyl.on(0, window.spincyl.at())"))
    for name, letter in (("omega", "ω"), ("momentum", "L")):
        tip = page.locator(f".tip.{name}")
        box = tip.bounding_box()
        places[name] = ([box["x"] + box["width"] / 2, box["y"] + box["height"] / 2] - centre) * [1, -1]
        em = tip.evaluate("e => parseFloat(getComputedStyle(e).fontSize)")
        assert tip.inner_text() == letter
        # close to its own tip, but not on it, and not to the other tip
        assert 0.4 * em < np.hypot(*(places[name] - tips[name])) < 1.3 * em
        assert 0 < box["x"] < 800 - em and 0 < box["y"] < 560 - em
    assert np.hypot(*(places["omega"] - places["momentum"])) > 1.2 * em
    for name, other in (("omega", "momentum"), ("momentum", "omega")):
        # on the side of its arrow away from the other arrow
        sides = [np.linalg.det([tips[name], x]) for x in (places[name] - tips[name], tips[other])]
        assert sides[0] * sides[1] < 0
    page.uncheck("#omega")
    settled(page)
    assert [page.locator(f".tip.{name}").is_visible() for name in ("omega", "momentum")] == [False, True]
    page.uncheck("#momentum")
    settled(page)


def test_f_and_a_button_fill_the_screen_and_leave_it(shown):
    page = shown(page_of("nutating"), "#t=1")
    for act in (lambda: page.keyboard.press("f"), lambda: page.click("#full")):
        for full in ("true", "false"):
            act()
            page.wait_for_function("full => !!document.fullscreenElement === (full === 'true')", arg=full)
            page.wait_for_selector(f"#full[aria-pressed={full}]")
    barred = shown(
        page_of("nutating"),
        "#t=1",
        script="Object.defineProperty(document, 'fullscreenEnabled', { get: () => false });",
    )
    barred.wait_for_selector("html[data-drawn]")
    assert not barred.locator("#full").is_visible()


@pytest.mark.parametrize(
    ("upper", "count"), [("O", (6, 0)), pytest.param("X", (0, 6), marks=pytest.mark.long)]
)
def test_its_long_exposure_shows_what_the_photograph_shows(shown, upper, count):
    page = shown(page_of("still symbols", upper=upper), "#t=0", viewport={"width": 560, "height": 480})
    page.select_option("#shutter", "1")
    page.wait_for_selector("html[data-exposed='720']")
    image = picture(page)
    # red minus blue or the reverse, so that neither text nor the body counts
    seen, other = (0, 2)[:: 1 if upper == "X" else -1]
    assert letters(np.clip(image[..., seen] - image[..., other], 0, None), 0.55) == count
    page.select_option("#shutter", "0")
    assert picture(page).mean() > 0.5


def test_an_exposure_is_seen_as_it_comes_says_what_rests_meanwhile_and_can_be_stopped(shown):
    page = shown(page_of("still symbols"), "#t=0", viewport={"width": 390, "height": 844})
    assert not page.locator("#shot").is_visible()
    page.select_option("#shutter", "1")
    # read and stopped within one frame, since on a fast machine the shutter may otherwise close meanwhile
    found = page.wait_for_function(
        """() => {
          const of = (name) => document.getElementById(name);
          if (!(document.documentElement.dataset.exposed > 40)) return null;
          const found = {
            said: of("why").innerText,
            whole: of("why").scrollHeight <= of("why").clientHeight,
            off: ["omega", "momentum", "path", "above"].map((name) => of(name).matches(":disabled")),
            part: of("developed").value,
          };
          of("stop").click();
          return found;
        }"""
    ).json_value()
    assert (
        "of 720 pictures" in found["said"]
        and "stay as they are until the photograph is closed" in found["said"]
    )
    assert found["whole"], "all of it is read on a phone"
    assert found["off"] == [True] * 4 and 0 < found["part"] < 1
    # after the stop the picture stays
    page.wait_for_function("() => document.getElementById('stop').textContent === 'close'")
    assert page.locator("#why").inner_text().startswith("Stopped")
    count, image = page.evaluate("document.documentElement.dataset.exposed"), picture(page)
    page.wait_for_timeout(500)
    assert page.evaluate("document.documentElement.dataset.exposed") == count and int(count) < 720
    assert np.array_equal(picture(page), image) and image.max() > 0.4
    # when the keyboard closes it, everything is as before
    page.keyboard.press("Escape")
    page.wait_for_selector("#shot", state="hidden")
    assert not page.locator("#omega").is_disabled() and picture(page).mean() > 0.5
