"""Without a browser the tests of pages are left out, and said to be; where CI is set they fail."""

import os
import signal
import sys
from collections import Counter
from pathlib import Path

import browser
import pytest
from hypothesis import settings

# a busy machine may take as long as it likes; the cases are the same in every run, but where others are asked for
settings.register_profile("same", deadline=None, derandomize=True)
settings.register_profile("fresh", deadline=None, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))

# what a shell starts in the background is deaf to Ctrl-C, and so are its children; tests of Ctrl-C would wait for ever
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# scenes, and what reads the pages, are read by the tests, too
sys.path += [str(Path(__file__).parents[1] / folder) for folder in ("examples", "docs")]


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    pages = [item for item in items if "chromium" in item.fixturenames]
    # at the end: while the browser runs nothing else can have an event loop
    items[:] = [item for item in items if "chromium" not in item.fixturenames] + pages
    for item in pages:
        item.add_marker(pytest.mark.page)
    if pages and not browser.checking() and not browser.find():
        for item in pages:
            item.add_marker(pytest.mark.skip(reason=browser.MISSING))


def pytest_terminal_summary(terminalreporter):
    skipped = terminalreporter.stats.get("skipped", [])
    left_out = Counter(x.nodeid.split("::")[0] for x in skipped if browser.MISSING in str(x.longrepr))
    for file, count in left_out.items():
        terminalreporter.write_line(f"not run: {count} tests of {file}: {browser.MISSING}", yellow=True)


@pytest.fixture(scope="session")
def chromium():
    """A browser for all tests of pages: to start one takes longer than most of them."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as p:
        running = p.chromium.launch(executable_path=browser.executable(), args=browser.FLAGS)
        yield running
        running.close()


@pytest.fixture(scope="session")
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
        if idle and not script:
            page = idle.pop()
        else:
            page = chromium.new_context(**how).new_page()
            page.add_init_script(script or browser.SELDOM)
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


@pytest.fixture
def opened(shown):
    """Opens a page to play with, at rest unless it is said otherwise."""

    from playing import LAPTOP

    import spincyl as sc

    def show(at="", page=None, **how):
        how = {"viewport": LAPTOP, "reduced_motion": "reduce"} | how
        return shown(sc.play() if page is None else page, at, **how)

    return show
