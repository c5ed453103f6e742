# ruff: noqa: F811
"""What the tests of the live page share: its browser, a page opened in it, and ways to ask it."""

import browser
import pytest
from pages import shown, windows  # noqa: F401
from playwright.sync_api import sync_playwright

import spincyl as sc

LAPTOP, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}
#: A browser whose pictures come when the test says so, with the times that it says.
DRIVEN = """
const waiting = [];
window.requestAnimationFrame = f => waiting.push(f);
window.picture = at => { for (const f of waiting.splice(0)) f(at); };
"""


@pytest.fixture(scope="module")
def chromium():
    with sync_playwright() as p:
        words = [*browser.FLAGS, "--disable-accelerated-2d-canvas"]
        running = p.chromium.launch(executable_path=browser.executable(), args=words)
        yield running
        running.close()


@pytest.fixture
def opened(shown):
    """Opens a page to play with, at rest unless it is said otherwise."""

    def show(at="", page=None, **how):
        how = {"viewport": LAPTOP, "reduced_motion": "reduce"} | how
        return shown(sc.play() if page is None else page, at, **how)

    return show


def state(page):
    return page.evaluate("window.spincyl.state()")


def ask(page, what):
    return page.evaluate(f"window.spincyl.{what}")


def details(page):
    """The numbers beside the sentence, with plain spaces."""
    return page.locator("#details").inner_text().replace("\u00a0", " ")


def settled(page):
    """After the picture that follows a change."""
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
