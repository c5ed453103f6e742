"""What the tests of pages share: a browser, a page opened in it, and ways to look at it."""

import io

import browser
import numpy as np
import pytest
from nutating_cylinder import start as START
from PIL import Image
from playwright.sync_api import sync_playwright

import spincyl as sc

CYLINDER, PIPE, DISK = sc.Body.solid(2.5), sc.Body.tube(6.0, bore=0.8), sc.Body.solid(0.375)
CAN, COIN = sc.Body.solid(1.0), sc.Body.solid(0.0852)
ROUNDED, CAPSULE, BALLS = sc.Body.solid(1.5, fillet=0.3), sc.Body.solid(2.5, fillet=1.0), sc.Body.balls()
TIPPE = sc.Body.ball(-0.3, 0.45, 0.42)


def nutating():
    return sc.roll(CYLINDER, START, 20.0)


@pytest.fixture(scope="module")
def chromium():
    with sync_playwright() as p:
        running = p.chromium.launch(executable_path=browser.executable(), args=browser.FLAGS)
        yield running
        running.close()


@pytest.fixture(scope="module")
def windows(chromium):
    """Empty windows by how they were asked for: to open one takes longer than to load a page in it."""
    return {}


@pytest.fixture
def shown(chromium, windows, tmp_path):
    """Opens a view in a window of its own: the page, with what it asked for and complained of."""
    opened = []

    def show(view, at="", *, script=None, **how):
        how = {"viewport": {"width": 800, "height": 560}} | how
        idle = windows.setdefault(repr(sorted(how.items())), [])
        page = chromium.new_context(**how).new_page() if script or not idle else idle.pop()
        page.requests, page.complaints = [], []
        hears = {
            "request": lambda r: page.requests.append(r.url),
            "console": lambda m: page.complaints.append(m.text),
            "pageerror": lambda e: page.complaints.append(str(e)),
            "dialog": lambda d: (page.complaints.append(d.message), d.dismiss()),
        }
        for event, hear in hears.items():
            page.on(event, hear)
        opened.append((page, hears, None if script else idle, how["viewport"]))
        if script:
            page.add_init_script(script)
        path = view.save(tmp_path / f"{len(opened)}.html")
        page.goto(path.as_uri() + at)
        if not script:
            page.wait_for_selector("html[data-drawn]")
        return page

    yield show
    for page, hears, idle, size in opened:
        if idle is None:
            page.context.close()
            continue
        for event, hear in hears.items():
            page.remove_listener(event, hear)
        page.goto("about:blank")
        page.set_viewport_size(size)
        idle.append(page)


def picture(page):
    page.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    shot = page.locator("canvas").screenshot()
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB"), float) / 255


def near(image, colour, width=0.12):
    """Share of the pixels of about this hue, whatever the light."""
    hue = np.array(colour) / np.linalg.norm(colour)
    size = np.linalg.norm(image, axis=-1)
    return float(((image @ hue > (1 - width**2) * size) & (size > 0.15)).mean())


def at(page):
    return page.evaluate("window.spincyl.at()")


def clock(page, i=0):
    return page.locator(".clock").nth(i).inner_text().replace("\xa0", " ")


def arrow(page, name):
    """Where the head of an arrow is in the picture, from the middle of the body, in pixels, right and up."""
    page.add_style_tag(content=".tip { visibility: hidden }")
    plain = picture(page)
    page.locator(f"#{name}").click()
    changed = np.abs(picture(page) - plain).max(axis=-1) > 0.15
    page.locator(f"#{name}").click()
    rows, columns = np.nonzero(changed)
    centre = np.array(page.evaluate("window.spincyl.on(0, window.spincyl.at())"))
    away = np.column_stack([columns, rows]) - centre
    return away[np.argmax(np.hypot(*away.T))] * [1, -1]
