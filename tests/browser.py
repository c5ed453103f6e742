"""A headless browser for the tests of pages: an installed one, or one that is downloaded.

python tests/browser.py: downloads one if none is installed. If that fails, tests of pages are skipped with a
message; if CI is set, it is an error.
"""

import functools
import os
import shutil
import subprocess
import sys
import time

FLAGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--webgl-antialiasing-mode=none",
    "--disable-accelerated-2d-canvas",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
]
#: A graphics card that is a program draws the bodies alone: to compose pages as well would take it twice as long.
BODIES_ONLY = "--disable-gpu-compositing"
#: A script that limits pages to ten frames a second: without a graphics card more would keep a core busy.
SELDOM = """
const next = window.requestAnimationFrame.bind(window);
window.requestAnimationFrame = draw => setTimeout(() => next(draw), 80);
"""
#: What this browser says of its own way to bring a picture to the screen; no page can help it.
OF_ITSELF = "GPU stall due to ReadPixels"
#: How many milliseconds a page may take at least, on a machine with other work.
PATIENCE = 120_000.0
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
MISSING = "no Chromium: `apt-get install chromium` or `playwright install chromium` gets one, SPINCYL_BROWSER names one"


def checking():
    """Whether this machine runs checks only: then a skipped test is a failure."""
    return os.environ.get("CI", "").lower() not in ("", "0", "false", "no")


def starts(path):
    """Whether the file runs as a browser; placeholders of missing packages fail."""
    try:
        return subprocess.run([path, "--version"], capture_output=True, timeout=60).returncode == 0
    except (OSError, subprocess.TimeoutExpired):
        return False


OWN = "from playwright.sync_api import sync_playwright as s\nwith s() as p: print(p.chromium.executable_path)"


@functools.cache
def find():
    """The path of a browser, or None; SPINCYL_BROWSER sets it if its name is unusual."""
    named = os.environ.get("SPINCYL_BROWSER")
    if named:
        assert starts(named), f"SPINCYL_BROWSER = {named!r}: it does not start"
        return named
    for found in filter(None, map(shutil.which, NAMES)):
        if starts(found):
            return found
    # in a process of its own, because playwright may be running here already
    own = subprocess.run([sys.executable, "-c", OWN], capture_output=True, text=True).stdout.strip()
    return own if own and starts(own) else None


def executable():
    """The path of a browser; fails without one."""
    found = find()
    assert found, MISSING
    return found


def started(driver):
    """A running browser, and how many milliseconds a test waits for a page.

    A machine that takes long for a first page takes long for others: a test waits two hundred times as long, and at least
    `PATIENCE`, since other work may begin later.
    """
    began = time.perf_counter()
    running = driver.launch(executable_path=executable(), args=[*FLAGS, BODIES_ONLY])
    first = running.new_page()
    first.goto("data:text/html,<canvas>")
    first.close()
    return running, max(PATIENCE, 200_000 * (time.perf_counter() - began))


def run(*words, **environment):
    """Run a command; print it, and print its errors."""
    print(" ".join(words), flush=True)
    try:
        done = subprocess.run(
            words, capture_output=True, text=True, timeout=1200, env={**os.environ, **environment}
        )
    except (OSError, subprocess.TimeoutExpired) as e:
        print(f"  {e}", flush=True)
    else:
        if done.returncode:
            said = (done.stdout + done.stderr).strip().splitlines() or ["it fails"]
            print("  " + next((line for line in said if "rror" in line), said[-1]).strip(), flush=True)
    find.cache_clear()


def fetch():
    """Install a browser by apt if permitted; else download playwright's own."""
    if shutil.which("apt-get") and os.geteuid() == 0:
        quiet = {"DEBIAN_FRONTEND": "noninteractive"}
        run("apt-get", "update", "-qq")
        run("apt-get", "install", "-y", "-qq", "chromium", **quiet)
    if not find():
        # do not wait long on a machine without a network
        run(
            sys.executable, "-m", "playwright", "install", "chromium",
            PLAYWRIGHT_DOWNLOAD_CONNECTION_TIMEOUT="10000",
        )  # fmt: skip


if __name__ == "__main__":
    if not find():
        print("no Chromium, so one is fetched for the tests of pages:")
        fetch()
    if not find():
        print(f"the tests of pages {'fail' if checking() else 'are not run'}: {MISSING}")
        raise SystemExit(checking())
