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


def find():
    """Where it is, or None; SPINCYL_BROWSER says so if its name is unusual."""
    return os.environ.get("SPINCYL_BROWSER") or next(filter(None, map(shutil.which, NAMES)), None)


def executable():
    """Where it is."""
    found = find()
    assert found, "these tests need Chromium: install it, or name it in SPINCYL_BROWSER"
    return found


if __name__ == "__main__":
    raise SystemExit(0 if find() else 1)
