"""The pages in Firefox, if playwright has it: pictures are drawn, and the core gives the same numbers."""

import os

import browser
import pytest
from page_scenes import page_of
from playing import LAPTOP, ask, settled, state

import spincyl as sc

pytestmark = pytest.mark.long
MISSING = "no Firefox: `playwright install firefox` gets the one that playwright drives"


@pytest.fixture(scope="module")
def firefox():
    """A browser that is closed before that of the other page tests starts."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as p:
        if not os.path.exists(p.firefox.executable_path):
            pytest.skip(MISSING)
        running = p.firefox.launch(firefox_user_prefs={"webgl.force-enabled": True})
        yield running
        running.close()


@pytest.fixture
def seen(firefox, tmp_path):
    """A function that opens a page; it fails if the page complains."""
    context = firefox.new_context(viewport=LAPTOP, reduced_motion="reduce")
    complaints = []

    def show(what, at=""):
        page = context.new_page()
        page.set_default_timeout(browser.PATIENCE)
        page.on("pageerror", lambda e: complaints.append(str(e)))
        page.goto(what.save(tmp_path / "page.html").as_uri() + at)
        page.wait_for_selector("html[data-drawn]")
        return page

    yield show
    context.close()
    assert complaints == []


def test_the_live_page_computes_in_firefox_what_the_library_does(seen):
    page = seen(sc.play(sc.Body.solid(2.5), 1.3))
    assert ask(page, "here()")["rate"] == pytest.approx(sc.Body.solid(2.5).rate(1.3), rel=1e-12)
    page.locator("#knob-kick").evaluate("e => { e.value = 0.2; e.dispatchEvent(new Event('input')); }")
    settled(page)
    start = sc.Body.solid(2.5).steady(1.3).kicked(0.2)
    period = sc.swing(sc.Body.solid(2.5), start).period
    assert state(page)["kick"] == 0.2 and ask(page, "head()")["period"] == pytest.approx(period, rel=1e-9)
    page.select_option("#preset", "a rattleback turns back")
    settled(page)
    assert state(page)["stone"]


def test_the_recorded_page_is_drawn_in_firefox(seen):
    page = seen(page_of("nutating"), "#t=1.5")
    assert page.locator("#unlit").is_hidden()
    page.keyboard.press("0")
    settled(page)
    assert ask(page, "at()") == 0
