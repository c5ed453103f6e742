"""The page of a body that slips: contact forces, the path in two colours, phases, a camera that follows."""

import re

import numpy as np
import pytest
from page_scenes import PIPE, motion_of, page_of
from pages import clock, go, near, picture
from playing import settled

import spincyl as sc
from spincyl.studio.pages.slip import forces

RED, GREY = (0.75, 0.12, 0.18), (0.43, 0.45, 0.50)
STICKS = 29.922072959


def seen_on(page, t):
    return page.evaluate(
        "t => { const p = window.spincyl.pose(0, t); return [...p.normal, ...p.friction, p.speed]; }", t
    )


def test_the_page_knows_slip_and_forces_at_every_time(shown):
    m = motion_of("flick")
    page = shown(page_of("flick"), "#t=3", keep=True)
    t = np.array([0.4, 3.0, 11.7, 28.3, 31.0, 47.0])
    there = m.wanting("pose", "force", t=t)
    for k, time in enumerate(t):
        *normal, fx, fy, fz, speed = seen_on(page, time)
        assert normal == pytest.approx([0, 0, there.normal[k]], abs=0.01) and fz == 0
        assert np.hypot(fx, fy) == pytest.approx(there.friction[k], abs=0.01)
        assert speed == pytest.approx(np.hypot(*there.slip[k]), abs=0.1)
        if there.phase[k]:  # friction opposes the slip
            turn = np.exp(1j * there.phi[k]) * complex(*there.slip[k])
            assert abs(complex(fx, fy) / abs(complex(fx, fy)) + turn / abs(turn)) < 0.05
    assert page.complaints == [] and len(page.requests) == 1


def test_friction_on_the_page_is_that_of_the_law():
    m = motion_of("flick")
    t = np.linspace(0.5, 59.5, 60)
    found = forces(m, t)
    there = m.wanting("force", t=t)
    assert np.allclose(np.hypot(found[:, 2], found[:, 3]), there.friction, atol=1e-6)
    assert np.allclose(found[:, 4], there.normal) and np.allclose(found[:, :2], there.slip)


def test_the_clock_says_what_the_body_does_and_the_line_when(shown):
    page = shown(page_of("flick"), "#t=3", keep=True)
    assert re.fullmatch(r"t = 3\.000 √\(R/g\)\nθ = \d+\.\d°\nslipping \d+\.\d+ √\(g R\)", clock(page))
    go(page, 40)
    assert clock(page).endswith("\nrolling")
    line = page.locator(".phases")
    told = line.get_attribute("title").replace("\xa0", " ")
    assert told == "slipping from t = 0.000 √(R/g), rolling from t = 29.922 √(R/g)"
    # the line, below the knob of the slider, is red until then
    box, strip = line.bounding_box(), page.locator("#time").bounding_box()
    assert box["y"] >= strip["y"] + strip["height"] - 1 and box["width"] == pytest.approx(
        strip["width"] - 16, abs=1
    )
    style = line.get_attribute("style")
    share = [float(x) for x in re.findall(r"([\d.]+)%", style)]
    assert share[1] == share[2] == pytest.approx(100 * STICKS / 60, abs=1e-3)
    scaled = shown(page_of("flick", scale=sc.Scale(radius=7.9375e-3)), "#t=0.1")
    assert re.search(r"\nslipping \d+(\.\d+)? mm/s$", clock(scaled))


def test_the_path_is_red_where_it_slips_and_grey_where_it_rolls(shown):
    page = shown(page_of("flick"), "#t=25")
    page.uncheck("#forces")
    page.uncheck("#follow")
    assert near(picture(page), RED) > 3e-4
    # seen from above, the last circle of a long roll is grey
    page.check("#above")
    page.check("#follow")
    assert near(picture(page), RED) > 1e-3
    go(page, 60)
    late = picture(page)
    hue = np.abs(late - np.array(GREY)).max(axis=-1) < 0.06
    assert hue.mean() > 0.01
    page.uncheck("#path")
    assert near(picture(page), RED) == 0


def test_forces_can_be_switched_and_friction_is_smaller_than_the_weight(shown):
    page = shown(page_of("hoop"), "#t=2")
    page.uncheck("#path")
    with_ = picture(page)
    tips = page.locator(".tip")
    shown_tips = [tips.nth(k).inner_text() for k in range(tips.count()) if tips.nth(k).is_visible()]
    assert shown_tips == ["N", "F"]
    page.uncheck("#forces")
    without = picture(page)
    assert np.abs(with_ - without).max() > 0.3
    assert not any(tips.nth(k).is_visible() for k in range(tips.count()))
    *normal, fx, fy, _, _ = seen_on(page, 2.0)
    assert np.hypot(fx, fy) == pytest.approx(0.25 * normal[2], abs=1e-3) and fy < 0, "against the throw"


def test_the_camera_follows_what_goes_far_and_rests_where_it_is_told(shown):
    page = shown(page_of("flick"), "#t=0")
    assert page.is_checked("#follow")
    at = [page.evaluate("t => window.spincyl.on(0, t)", 0)]
    go(page, 40)
    at.append(page.evaluate("t => window.spincyl.on(0, t)", 40))
    assert at[0] == pytest.approx(at[1], abs=20), "the body stays in the middle"
    page.uncheck("#follow")
    settled(page)
    places = [page.evaluate("t => window.spincyl.on(0, t)", t) for t in (0, 40)]
    assert np.hypot(*np.subtract(*places)) > 50
    # a body that stays in place is not followed
    spinning = sc.roll(PIPE, PIPE.steady(1.5), 20.0, contact=sc.Coulomb(0.3))
    assert not shown(sc.view(spinning)).is_checked("#follow")


def test_a_body_that_slips_and_one_that_does_not_are_side_by_side(shown):
    page = shown(page_of("hoop", "wet hoop", "nutating"), "#t=13")
    assert clock(page, 0).endswith("rolling") and re.search(r"slipping 0\.\d+ √", clock(page, 1))
    assert clock(page, 2).count("\n") == 1
    assert page.locator(".phases").count() == 2 and page.complaints == []
    labels = [page.locator(".panel b").nth(k).inner_text() for k in range(3)]
    assert labels == ["Coulomb(0.25)", "Viscous(0.3)", "rolling"]


def test_a_page_without_slip_has_nothing_of_it():
    page = page_of("nutating").html
    assert "friction" not in page and "slip" not in page and "follow" not in page
    assert "friction" in page_of("hoop").html and len(page_of("flick").html.encode()) < 66_000
