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

sys.path.append(str(Path(__file__).parents[1] / "examples"))  # its scenes are read by the tests, too


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    pages = [item for item in items if "chromium" in item.fixturenames]
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
