"""A real browser without a window, for the tests of pages."""

import os
import shutil

FLAGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
]
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


def executable():
    """Where it is; SPINCYL_BROWSER says so if its name is unusual."""
    named = os.environ.get("SPINCYL_BROWSER")
    found = named or next(filter(None, map(shutil.which, NAMES)), None)
    assert found, "these tests need Chromium: install it, or name it in SPINCYL_BROWSER"
    return found
