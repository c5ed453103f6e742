"""The live page as Python writes it: its state, its content, and refusals."""

import json
import lzma
import math
import zlib
from importlib.resources import files

import numpy as np
import pytest
from page_scenes import PIPE, live_page
from pages import near, picture
from playing import ask, settled, state

import spincyl as sc
from spincyl.cli import main
from spincyl.studio.pages.compressed import compressed
from spincyl.studio.pages.joined import script, style
from spincyl.studio.pages.languages import numbered
from spincyl.studio.pages.play import _SCRIPTS, _SCRIPTS_WITHOUT_FRICTION, CORES
from spincyl.studio.pages.words import body_of, losses_of, restitution_of, scenes, state_of, table_of
from spincyl.studio.shape import IVORY

#: The format of a page's content.
RAW = {"id": lzma.FILTER_LZMA1, "dict_size": 1 << 21, "lc": 1, "lp": 0, "pb": 0}


def unpacked(page):
    """The content of a page as the loader unpacks it: style, page and script, and the core."""
    text = page.html.split('id="packed">')[1].split("</script>")[0]
    sevens = [
        x for c in map(ord, text) for x in ((c & 127,) if c < 128 else ((0, 13, 60)[c // 128 - 1], c & 127))
    ]
    bits = np.unpackbits(np.array([sevens], np.uint8).T, axis=1)[:, 1:].ravel()
    data = np.packbits(bits[: bits.size // 8 * 8]).tobytes()
    contents = []
    for _ in range(2):
        length, size, sum_ = (int.from_bytes(data[i : i + 4], "big") for i in (0, 4, 8))
        content = lzma.LZMADecompressor(lzma.FORMAT_RAW, filters=[RAW]).decompress(data[12 : 12 + length])
        assert (len(content), zlib.adler32(content)) == (size, sum_)
        contents, data = [*contents, content], data[12 + length :]
    core, rest = contents
    return *rest.decode().split("\0"), core


@pytest.mark.parametrize("friction", [False, True])
def test_the_page_holds_its_script_and_the_core_that_is_asked_for_in_little_more_than_their_size(friction):
    play = live_page(friction)
    page, (look, shown, text, core) = play.html, unpacked(play)
    code = script(_SCRIPTS if friction else _SCRIPTS_WITHOUT_FRICTION)
    words = json.loads(shown.split('id="words">')[1].split("</script>")[0])["en"][1]
    assert (look, text) == (style(["play.css"]), numbered(code, words)) and '<canvas id="map"' in shown
    assert core == lzma.decompress(
        files("spincyl.studio.pages").joinpath("cores", CORES[friction]).read_bytes()
    )
    assert core[48:52] == b"\0asm"
    # seven bits per byte, and a loader
    small = [compressed(what) for what in (core, (look + shown + text).encode())]
    assert len(page.encode()) < 8 / 7 * sum(map(len, small)) + 10_000
    assert len(page.encode()) < (330_000 if friction else 147_500)
    assert "\r" not in page and "\0" not in page, "a browser would change these"
    assert "http" not in page.replace("http-equiv", "").replace("http://www.w3.org/2000/svg", "")


def test_a_page_without_friction_is_smaller_offers_none_and_refuses_it():
    lean, whole = sc.play(PIPE, friction=False), sc.play(PIPE)
    assert len(lean.html) < 0.75 * len(whole.html)
    assert "flicked too hard" not in unpacked(lean)[1] and "hula hoop" in unpacked(whole)[1]
    for how in (
        {"restitution": 0.5},
        {"contact": sc.Coulomb(0.3)},
        {"contact": sc.Viscous(0.3)},
        {"losses": sc.loss.Drilling(1e-3)},
    ):
        with pytest.raises(ValueError, match="needs? friction=True"):
            sc.play(PIPE, friction=False, **how)
        with pytest.raises(ValueError, match="needs? friction=True"):
            setattr(lean, *next(iter(how.items())))
    assert lean.contact == "rolling" and lean.losses is None


def test_the_page_begins_with_what_is_told():
    def given(page):
        return json.loads(page.html.split('id="given">')[1].split("</script>")[0])

    told = given(sc.play(PIPE, 1.5, kick=0.1, contact="smooth"))
    assert told == {
        "ell": 6.0, "bore": 0.8, "fillet": 0.0, "theta": 1.5, "kick": 0.1, "until": 60.0, "slow": 20.0,
        "contact": "smooth",
    }  # fmt: skip
    rounded = given(sc.play(sc.Body.tube(0.5, 0.2, fillet=0.1), 1.2))
    assert rounded["ell"] == pytest.approx(0.5) and rounded["fillet"] == 0.1, "half the length, as on the map"
    whirr = given(sc.play(sc.Body.solid(0.17), 0.3, losses=sc.loss.DryContour(5e-3), t=400))
    assert (whirr["law"], whirr["loss"], whirr["until"]) == ("dry-contour", 5e-3, 400)
    free = given(sc.play(PIPE, state=sc.State(1.0, 0.1, 0.2, 0.3, slip=(0.4, 0.5)), contact=sc.Coulomb(0.3)))
    assert free["w"] == [0.1, 0.2, 0.3, 0.4, 0.5] and (free["contact"], free["mu"]) == ("coulomb", 0.3)
    german = sc.play(PIPE, 1.5, kick=0.1, contact="smooth", language="de")
    assert given(german) == told | {"language": "de"} and german.address.startswith("#language=de&ell=6.0&")
    balls = given(sc.play(sc.Body.balls(), 1.3))
    assert (balls["i3"], balls["end"]) == (0.4, math.pi / 2)


def test_what_is_told_comes_back_as_what_it_was():
    bodies = [PIPE, sc.Body.solid(0.4, fillet=0.1), sc.Body.balls(1.5), sc.Body.ball(-0.2, 0.5, 0.45)]
    for body in bodies:
        page = sc.play(body, 1.4, kick=0.02)
        assert page.body == body
        assert page.state == body.steady(1.4).kicked(0.02)
    for contact in ("rolling", "smooth", sc.Coulomb(0.3), sc.Coulomb(0.3, patch=0.02), sc.Viscous(0.2)):
        assert sc.play(PIPE, contact=contact).contact == contact
    for law in sc.loss.DryContour(1e-3), sc.loss.AirQuadratic(1e-5), sc.loss.BoundaryLayer(1e-6):
        assert sc.play(PIPE, losses=law).losses == law
    assert sc.play().losses is None
    for bounce in (0.0, 0.5, 1.0, None):
        assert sc.play(PIPE, contact=sc.Coulomb(0.3), restitution=bounce).restitution == bounce


def test_a_restitution_is_a_word_of_the_page_and_none_where_there_is_none():
    assert "restitution" not in sc.play(PIPE, contact=sc.Coulomb(0.3)).address
    flick = sc.flicked(PIPE, w1=3.0, launch=3.0)
    page = sc.play(PIPE, state=flick, contact=sc.Coulomb(0.3), restitution=0.5, t=5.0)
    assert "contact=coulomb&mu=0.3&restitution=0.5" in page.address
    assert page.motion.height.max() > 0.1 and page.motion.impacts
    page.restitution = None
    assert "restitution" not in page.html.split('id="packed"')[0] and page.motion.status == sc.Ending.LIFT_OFF
    page.restitution, page.contact = 0.3, "rolling"
    page.state = PIPE.steady(1.4)
    assert page.restitution == 0.3 and page.motion.status == 0, "bounces are those of a table with friction"


def test_a_patch_is_a_word_of_the_page_and_no_body_bounces_on_one():
    page = sc.play(PIPE, contact=sc.Coulomb(0.3, patch=0.02))
    assert "contact=coulomb&mu=0.3&patch=0.02" in page.address
    with pytest.raises(ValueError, match="restitution = 0.5: expected None, since the contact has a patch"):
        page.restitution = 0.5
    with pytest.raises(ValueError, match="expected None, since the contact has a patch"):
        sc.play(PIPE, contact=sc.Coulomb(0.3, patch=0.02), restitution=0.5)
    page.contact = sc.Coulomb(0.3)
    assert "patch" not in page.address
    page.restitution = 0.5
    with pytest.raises(ValueError, match="expected None, since the contact has a patch"):
        page.contact = sc.Coulomb(0.3, patch=0.02)


def test_the_patch_of_a_measured_body_has_its_unit_on_the_page_as_elsewhere():
    dry = sc.Coulomb.from_si(0.3, patch="0.5mm", scale=SIZED)
    page = sc.play(SIZED, contact=dry)
    assert "patch=0.02" in page.address and page.contact.patch == dry.patch and page.motion.status == 0
    with pytest.raises(ValueError, match="expected SI for a measured body"):
        sc.play(SIZED, contact=sc.Coulomb(0.3, patch=0.02))
    with pytest.raises(ValueError, match="patch = 0.7: expected 0 to 0.5"):
        sc.play(PIPE, contact=sc.Coulomb(0.3, patch=0.7))


SIZED = sc.measured(outer_diameter=0.05, inner_diameter=0.04, length=0.15, mass=0.1)
UNWEIGHED = sc.measured(outer_diameter=0.05, length=0.01, fillet=1e-3, gravity=1.62)


def test_a_measured_body_keeps_its_size_on_the_page():
    page = sc.play(SIZED, 1.4)
    assert page.body == SIZED and page.body.scale == sc.Scale(0.025, 0.1)
    assert "radius=0.025&mass=0.1" in page.address and "gravity" not in page.address
    moon = sc.play(UNWEIGHED, 0.5)
    assert moon.body == UNWEIGHED and np.isnan(moon.body.scale.mass) and "mass" not in moon.address
    assert "gravity=1.62" in moon.address
    moon.body = sc.Body.solid(2.5)
    assert moon.body.scale is None and "radius" not in moon.address, "another body has a size of its own"
    assert "radius" not in sc.play(PIPE).address


def test_the_motion_of_a_measured_body_is_in_seconds():
    m = sc.play(SIZED, 1.4, kick=0.02, t=2.0).motion
    assert m.t[-1] == pytest.approx(2.0) and m.body.scale == SIZED.scale
    expected = sc.roll(SIZED, SIZED.steady(1.4).kicked(0.02), m.t)
    assert np.abs(m.theta - expected.theta).max() < 1e-9
    with pytest.raises(ValueError, match="t = 1000.0: expected 0.0504"):
        sc.play(SIZED, t=1000)


def test_its_state_and_motion_are_those_of_the_library():
    page = sc.play(PIPE, 1.5, kick=0.02, t=10)
    expected = sc.roll(PIPE, PIPE.steady(1.5).kicked(0.02), np.linspace(0, 10, 2001))
    assert np.array_equal(page.motion.theta, expected.theta)
    # in the forbidden band the body is released at rest
    assert sc.play(sc.Body.solid(2.5), 0.7).state == sc.State(0.7, 0.0, 0.0, 0.0)


def test_what_is_set_afterwards_is_shown():
    page = sc.play(PIPE, 1.5)
    page.theta = 1.3
    assert page.theta == 1.3 and page.state == PIPE.steady(1.3) and '"theta":1.3' in page.html
    page.state = sc.State(1.2, 0.1, 0.0, 2.0)
    assert page.state == sc.State(1.2, 0.1, 0.0, 2.0)
    page.theta = 1.25
    assert page.state == PIPE.steady(1.25), "a state belongs to its inclination"
    page.body = sc.Body.balls()
    assert page.body == sc.Body.balls() and page.state == sc.Body.balls().steady(1.25)
    page.contact, page.losses, page.kick = sc.Coulomb(0.2), sc.loss.Drilling(1e-3), 0.1
    assert (page.contact, page.losses, page.kick) == (sc.Coulomb(0.2), sc.loss.Drilling(1e-3), 0.1)
    assert page.motion.phases[0].kind == "rolling"


@pytest.mark.parametrize(
    ("how", "why"),
    [
        ({"theta": 4.0}, "theta = 4.0: expected 0.001 to 3.14159"),
        ({"kick": 5.0}, "kick = 5.0: expected -3 to 3"),
        ({"body": PIPE, "t": 1e5}, "t = 100000.0: expected 1 to 2000"),
        ({"restitution": 1.5}, "restitution = 1.5: expected 0 to 1"),
        ({"slow": 0.1}, "slow = 0.1: expected 1 to 1000"),
        ({"body": sc.Body.solid(np.array([1.0, 2.0]))}, "a single body, not a family"),
        ({"contact": sc.Coulomb(0.3, static=0.5)}, "expected static = mu"),
        ({"contact": "glue"}, "expected 'rolling', 'smooth', sc.Coulomb"),
        ({"losses": sc.loss.DryContour(1e-3) + sc.loss.Drilling(1e-3)}, "expected one loss"),
        ({"language": "nl"}, "language = 'nl': expected 'en', 'de', 'fr', 'es', 'it', 'pt', 'ja' or 'zh'"),
        ({"theta": 1.0, "state": sc.State(1.0, 0.0, 0.0, 0.0)}, "cannot be combined with theta or kick"),
    ],
)
def test_what_the_page_cannot_show_is_refused_by_name(how, why):
    with pytest.raises(ValueError, match=why.replace("(", r"\(")):
        sc.play(**how)


@pytest.mark.parametrize("how", [{"body": 2.5}, {"state": 1.0}, {"losses": 1e-3}, {"title": 3}])
def test_what_is_of_another_kind_is_refused(how):
    with pytest.raises(TypeError, match=next(iter(how))):
        sc.play(**how)


def spun_back(play, told):
    """Whether the rattleback with the state of a page reverses its spin in the page's `motion`."""
    play._heard({"new": told})
    m = play.motion
    with pytest.raises(ValueError, match="rattleback"):
        _ = play.body
    assert "rattleback" in repr(play) and "stone=0.07,0.014,0.012" in play.address
    return m.spin[0] < 0 < m.spin.max()


def test_a_stone_is_refused_by_name_and_another_body_takes_the_place_of_the_rattleback():
    with pytest.raises(TypeError, match=r"^body: expected a Body, not a stone"):
        sc.play(sc.Ellipsoid.egg(0.7, 1.0, 0.1))
    play = sc.play()
    play._heard({"new": play._told | dict(scenes())["a rattleback turns back"]})
    assert play.html.startswith("<!DOCTYPE html>")
    play.body = PIPE
    assert play.body == PIPE


def test_every_scene_is_one_of_the_library():
    offered = dict(scenes())
    assert len(offered) >= 10
    for name, told in offered.items():
        if "stone" in told:
            assert spun_back(sc.play(), told)
            continue
        body, start = body_of(told), state_of(told)
        until = min(5.0, told.get("until", 60))
        how = {"contact": table_of(told), "losses": losses_of(told), "restitution": restitution_of(told)}
        m = sc.roll(body, start, np.linspace(0, until, 11), **how)
        assert m.t.size, name


def test_text_stays_text():
    page = sc.play(title="</title><script>alert(1)</script>{packed}").html
    assert "<script>alert" not in page and "{packed}" in page


def test_the_command_writes_the_page_that_is_asked_for(tmp_path, capsys):
    path = tmp_path / "play.html"
    assert main(["play", "-o", str(path)]) == 0
    assert "kB in" in capsys.readouterr().out
    assert path.read_text("utf-8") == live_page().html
    words = ["--ell", "6", "--bore", "0.8", "--theta", "85deg", "--contact", "coulomb", "--mu", "0.2"]
    assert main(["play", *words, "--loss", "drilling=1e-3", "-o", str(path)]) == 0
    asked = sc.play(PIPE, math.radians(85), contact=sc.Coulomb(0.2), losses=sc.loss.Drilling(1e-3))
    assert path.read_text("utf-8") == asked.html
    assert main(["play", *words, "--restitution", "0.5", "-o", str(path)]) == 0
    asked = sc.play(PIPE, math.radians(85), contact=sc.Coulomb(0.2), restitution=0.5)
    assert path.read_text("utf-8") == asked.html
    assert main(["play", *words, "--patch", "0.02", "-o", str(path)]) == 0
    asked = sc.play(PIPE, math.radians(85), contact=sc.Coulomb(0.2, patch=0.02))
    assert path.read_text("utf-8") == asked.html
    assert main(["play", "--contact", "viscous", "--viscosity", "0.2", "-o", str(path)]) == 0
    assert path.read_text("utf-8") == sc.play(contact=sc.Viscous(0.2)._known()).html
    assert main(["play", "--ell", "2.5", "--slope", "5deg", "-o", str(path)]) == 0
    assert path.read_text("utf-8") == sc.play(sc.Body.solid(2.5), table=sc.Table("5 deg")).html
    assert main(["play", "--language", "de", "-o", str(path)]) == 0
    assert path.read_text("utf-8") == sc.play(language="de").html
    sizes = ["--outer", "50mm", "--inner", "40mm", "--length", "150mm", "--mass", "100g"]
    assert main(["play", *sizes, "--theta", "1.4", "-o", str(path)]) == 0
    assert path.read_text("utf-8") == sc.play(SIZED, 1.4).html
    sizes += ["--contact", "coulomb", "--mu", "0.3", "--patch", "0.5mm"]
    assert main(["play", *sizes, "-o", str(path)]) == 0 and '"patch":0.02' in path.read_text("utf-8")
    wet = ["--contact", "viscous"]
    bounces = (["--restitution", "0.5"], [*words, "--restitution", "2"])
    odd = (["--mu", "0.3"], ["--contact", "coulomb"], ["--theta", "300deg"], wet, [*wet, "--mu", "1"])
    for wrong in (*odd, *bounces):
        assert main(["play", *wrong, "-o", str(path)]) == 2
    with pytest.raises(SystemExit, match="2"):
        main(["play", "--language", "nl", "-o", str(path)])
    assert main(["play", "-o", str(tmp_path / "play.png")]) == 2
    assert "expected a name that ends in .html" in capsys.readouterr().err
    assert not (tmp_path / "play.png").exists()


HIGH, KIND = 16, 14  # places in a row


def at_rest_at(page, t):
    """Moves the page to a time by a press on its tracks."""
    x = page.evaluate(
        """t => {
      const { width, left } = document.getElementById("chart").getBoundingClientRect(), rows = window.spincyl.tracked();
      const em = parseFloat(getComputedStyle(document.getElementById("chart")).fontSize);
      return left + 3.6 * em + (width - 4.2 * em) * t / rows.at(-1)[0];
    }""",
        t,
    )
    box = page.locator("#chart").bounding_box()
    page.mouse.click(x, box["y"] + box["height"] / 2)
    settled(page)


def test_a_flick_too_hard_hops_and_the_body_is_seen_as_high_as_the_library_says(opened):
    page = opened("#ell=2.5&theta=1.3")
    page.locator("#flick").click(modifiers=["Shift"])
    settled(page)
    told, head = state(page), ask(page, "head()")
    assert told["restitution"] == 0.5 and told["contact"] == "coulomb" and head["impacts"] > 3
    assert page.locator("#what").inner_text() == "Set free, it hops"
    page.wait_for_function("() => location.hash.includes('restitution=0.5')")
    w1, w2, w3, *slip = told["w"]
    start = sc.State(told["theta"], w1, w2, w3, slip=tuple(slip))
    rows = np.array(ask(page, "tracked()"), float)
    early = rows[rows[:, 0] < 8.0]
    assert (early[:, KIND] == 2).any()
    m = sc.roll(
        sc.Body.solid(2.5),
        start,
        early[:, 0],
        contact=sc.Coulomb(0.3),
        restitution=0.5,
        want=("pose", "force"),
    )
    assert np.abs(early[:, HIGH] - m.height).max() < 1e-6 and m.height.max() > 0.5
    top = float(early[np.argmax(early[:, HIGH]), 0])
    at_rest_at(page, top)
    now = ask(page, "at()")
    there = sc.roll(
        sc.Body.solid(2.5), start, np.array([0.0, now]), contact=sc.Coulomb(0.3), restitution=0.5, want="pose"
    )
    seen = ask(page, f"pose({now!r})")
    assert seen["centre"] == pytest.approx(there.centre[1].tolist(), abs=1e-6)
    x, y, z, w = there.orientation[1]
    assert seen["matrix"][8:11] == pytest.approx(
        [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], abs=1e-6
    )
    assert "flying" in page.locator(".clock").inner_text() and seen["normal"][2] == 0.0
    assert near(picture(page, "#canvas"), IVORY, 0.05) > 0.01, "the body is in view"
    assert page.complaints == []


def test_where_the_other_rim_is_down_the_body_is_drawn_as_it_is_turned(opened):
    page = opened("#ell=2.5&theta=0.9&w=0.5,0.3,0.2,0.3,-0.1&contact=coulomb&mu=0.2&restitution=0.5&until=20")
    rows = np.array(ask(page, "tracked()"), float)
    start = sc.State(0.9, 0.5, 0.3, 0.2, slip=(0.3, -0.1))
    m = sc.roll(
        sc.Body.solid(2.5),
        start,
        rows[:, 0],
        contact=sc.Coulomb(0.2),
        restitution=0.5,
        want=("pose", "force"),
    )
    assert 0 < rows[:, 17].mean() < 1
    for k in (np.flatnonzero(rows[:, 17] == rim)[5] for rim in (0, 1)):
        pose, (x, y, z, w) = ask(page, f"pose({float(rows[k, 0])!r})"), m.orientation[k]
        assert pose["centre"] == pytest.approx(m.centre[k].tolist(), abs=1e-6)
        first, third = pose["matrix"][:3], pose["matrix"][8:11]
        assert first == pytest.approx(
            [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], abs=1e-6
        )
        assert third == pytest.approx(
            [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], abs=1e-6
        )


def test_a_weak_flick_lies_on_its_side_and_rolls_straight_unless_it_is_told_to_end_there(opened):
    page = opened("#ell=1&theta=1.3")
    page.locator("#flick").click()
    settled(page)
    assert page.locator("#what").inner_text() == "It lies on its side"
    assert "rolls straight on" in page.locator("#because").inner_text()
    rows = np.array(ask(page, "tracked()"), float)
    assert (rows[:, HIGH] == 0).all() and rows[0, KIND] == 3 and rows[-1, KIND] == 5
    at_rest_at(page, 50.0)
    assert "rolls on its side" in page.locator(".clock").inner_text()
    knob, patch = page.locator("#knob-restitution"), page.locator("#knob-patch")
    assert knob.is_visible() and not patch.is_visible()
    knob.evaluate("e => { e.value = -0.05; e.dispatchEvent(new Event('input')); }")
    settled(page)
    assert state(page)["restitution"] is None or math.isnan(state(page)["restitution"])
    assert ask(page, "head()")["ending"] == 2
    patch.evaluate("e => { e.value = -1; e.dispatchEvent(new Event('input')); }")
    settled(page)
    assert state(page)["patch"] == pytest.approx(0.1) and not knob.is_visible(), "nothing bounces on a patch"
    page.select_option("#knob-contact", "rolling")
    settled(page)
    assert not knob.is_visible() and not patch.is_visible()
    page.wait_for_function("() => !location.hash.includes('restitution')")
    assert page.complaints == []


def test_the_slider_of_the_slope_tilts_the_table_and_the_motion_is_that_of_the_library(opened):
    page = opened("#ell=2.5&theta=1.3")
    knob, heading = page.locator("#knob-slope"), page.locator("#knob-phi0")
    level = ask(page, "on()")
    assert (
        knob.is_visible() and not heading.is_visible() and "slope" not in page.locator(".clock").inner_text()
    )
    assert ask(page, "head()")["integrated"] == 0
    for name, value in (("slope", 0.2), ("phi0", -0.7)):
        page.locator(f"#knob-{name}").evaluate(
            "(e, x) => { e.value = x; e.dispatchEvent(new Event('input')); }", value
        )
        settled(page)
    told, rows = state(page), np.array(ask(page, "tracked()"), float)
    assert (
        heading.is_visible() and told["slope"] == pytest.approx(0.2) and told["phi0"] == pytest.approx(-0.7)
    )
    assert (
        ask(page, "head()")["integrated"] == 1 and page.locator("#what").inner_text() == "On a slope of 11.5°"
    )
    assert (
        "slope 11.5°" in page.locator(".clock").inner_text().replace("\xa0", " ")
        and ask(page, "on()") != level
    )
    body = sc.Body.solid(2.5)
    table = sc.Table(told["slope"], phi0=told["phi0"])
    m = sc.roll(body, body.steady(1.3), rows[:, 0], table=table, want=("pose", "force"))
    assert np.abs(rows[:, 1] - m.theta).max() < 1e-6 and np.abs(rows[:, 7:9] - m.contact_point).max() < 1e-6
    assert np.hypot(*(m.contact_point[-1] - m.contact_point[0])) > 5.0
    # between two rows; the force is that of the table alone
    now = float(rows[7, 0] + 0.4 * (rows[8, 0] - rows[7, 0]))
    pose = ask(page, f"pose({now!r})")
    there = sc.roll(body, body.steady(1.3), [0.0, now], table=table, want=("pose", "force"))
    assert pose["centre"] == pytest.approx(there.centre[1].tolist(), abs=1e-6)
    force = [x + y for x, y in zip(pose["normal"], pose["friction"], strict=True)]
    assert force == pytest.approx(there.contact_force[1].tolist(), abs=1e-3)
    page.wait_for_function("() => location.hash.includes('slope=0.2') && location.hash.includes('phi0=-0.7')")
    page.select_option("#knob-contact", "coulomb")
    page.locator("#knob-patch").evaluate("e => { e.value = -1; e.dispatchEvent(new Event('input')); }")
    settled(page)
    assert "not computed" not in page.locator("#because").inner_text()
    knob.evaluate("e => { e.value = 0; e.dispatchEvent(new Event('input')); }")
    page.wait_for_function("() => !location.hash.includes('slope') && !location.hash.includes('phi0')")
    assert not heading.is_visible() and page.complaints == []


def test_a_table_of_the_page_has_a_slope_and_a_heading_and_its_motion_is_that_of_roll():
    body = sc.Body.solid(2.5)
    page = sc.play(body, 1.3, table=sc.Table(0.2, phi0=-0.7), t=5.0)
    assert page.address.endswith("&slope=0.2&phi0=-0.7") and page.table == sc.Table(0.2, phi0=-0.7)
    m = sc.roll(body, body.steady(1.3), page.motion.t, table=page.table, want="pose")
    assert (page.motion.centre == m.centre).all() and np.ptp(m.centre[:, 1]) > 0.1
    page.table = None
    assert "slope" not in page.address and page.table is None and page.motion.method == "exact"
    wrong = [
        sc.Table(1.0),
        sc.Table(-0.1),
        sc.Table(0.1, turning=0.5),
        sc.Table(0.1, place=(1.0, 0.0)),
        sc.Table([0.1, 0.2]),
    ]
    for table in wrong:
        with pytest.raises(ValueError, match="^(slope|table) = "):
            page.table = table
    with pytest.raises(TypeError, match="table: expected a Table, not float"):
        sc.play(body, table=0.1)
    with pytest.raises(ValueError, match="friction = False: a slope needs friction=True"):
        sc.play(body, friction=False, table=sc.Table(0.1))
