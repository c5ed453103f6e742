"""Without a browser the tests of pages are skipped with a message; if CI is set, they fail."""

import gc
import os
import signal
import sys
from collections import Counter
from pathlib import Path

import browser
import pytest
from hypothesis import settings
from still import (  # noqa: F401  # a test that stands still fails
    pytest_configure,
    pytest_runtest_call,
    pytest_runtest_setup,
    pytest_runtest_teardown,
    pytest_unconfigure,
)

# no deadline, since the machine may be busy; the same cases in every run unless the profile "fresh" is chosen
settings.register_profile("same", deadline=None, derandomize=True)
settings.register_profile("fresh", deadline=None, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))

# a background process of a shell ignores Ctrl-C, and so do its children: tests of Ctrl-C would hang
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# tests import the scenes, and the reader of pages
sys.path += [str(Path(__file__).parents[1] / folder) for folder in ("examples", "docs")]


def pytest_collection_finish():
    """Keeps the collector of garbage from looking through a million objects that stay: 8 % of the time."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 50)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    pages = [item for item in items if "chromium" in item.fixturenames]
    # last: while the browser runs, no other event loop is possible
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
    """A browser for all tests of pages, since starting one takes longer than most of them."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as p:
        running, running.patience = browser.started(p.chromium)
        yield running
        running.close()


@pytest.fixture(scope="session")
def windows(chromium):
    """Empty windows by their settings, since opening a window takes longer than loading a page."""
    return {}


@pytest.fixture(scope="session")
def kept():
    """Recorded pages that stay open, by page and window: to load one takes a second of the processor."""
    return {}


@pytest.fixture(scope="session")
def written(tmp_path_factory):
    """Writes a page into a file, each page once."""
    folder, paths = tmp_path_factory.mktemp("pages"), {}

    def write(view):
        if view not in paths:
            paths[view] = view.save(folder / f"{len(paths)}.html")
        return paths[view]

    return write


@pytest.fixture
def shown(chromium, windows, written, kept):
    """Opens a view in a window of its own: the page, with what it asked for and complained of.

    `keep` is for tests that leave a recorded page as they find it, but for its time: the next one has the same page.
    """
    from pages import go

    opened = []

    def show(view, at="", *, script=None, keep=False, **how):
        how = {"viewport": {"width": 800, "height": 560}} | how
        same = (view, repr(sorted(how.items())))
        if keep and same in kept:
            go(kept[same], at.removeprefix("#t="))
            return kept[same]
        idle = windows.setdefault(repr(sorted(how.items())), [])
        if idle and not script:
            page = idle.pop()
        else:
            page = chromium.new_context(**how).new_page()
            page.set_default_timeout(chromium.patience)
            page.add_init_script(script or browser.SELDOM)
        page.requests, page.complaints = [], []
        hears = {
            "request": lambda r: page.requests.append(r.url),
            "console": lambda m: browser.OF_ITSELF in m.text or page.complaints.append(m.text),
            "pageerror": lambda e: page.complaints.append(str(e)),
            "dialog": lambda d: (page.complaints.append(d.message), d.dismiss()),
        }
        for event, hear in hears.items():
            page.on(event, hear)
        if keep:
            kept[same] = page
        else:
            opened.append((page, hears, None if script else idle, how["viewport"]))
        page.goto(written(view).as_uri() + at)
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
    """A function that opens a live page, at rest unless told otherwise."""

    from page_scenes import live_page
    from playing import LAPTOP

    def show(at="", page=None, **how):
        how = {"viewport": LAPTOP, "reduced_motion": "reduce"} | how
        return shown(live_page() if page is None else page, at, **how)

    return show
