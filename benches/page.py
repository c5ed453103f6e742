"""Pages and exposures: their sizes, first frames, requests, letters and seconds.

Prints a table; with an argument, saves a picture of a page. Needs Chromium.
usage: python benches/page.py [PICTURE.png]
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from playwright.sync_api import sync_playwright

import spincyl as sc

sys.path += [str(Path(__file__).parents[1] / folder) for folder in ("tests", "examples")]
import browser
import near_steady_tube
import nutating_cylinder
from letters import letters


def main():
    pipe, scale = near_steady_tube.body, sc.Scale(radius=7.9375e-3)
    disk = sc.Body.solid(0.375)
    kicked = near_steady_tube.start
    views = {
        "cylinder, t = 20": sc.view(sc.roll(nutating_cylinder.body, nutating_cylinder.start, 20.0)),
        "PVC tube, 20 s": sc.view(sc.roll(pipe, kicked, 20.0 / scale.seconds(1.0)), scale=scale),
        "disk, rolling beside smooth": sc.view(
            *(sc.roll(disk, disk.steady(1.4).kicked(0.01), 30.0, contact=c) for c in ("rolling", "smooth"))
        ),
    }
    print(f"{'page':30} {'bytes':>7} {'first frame':>12} {'requests':>9} {'made in':>9}")
    requests = []
    with sync_playwright() as p, tempfile.TemporaryDirectory() as folder:
        chromium = p.chromium.launch(executable_path=browser.executable(), args=browser.FLAGS)
        for name, view in views.items():
            began = time.perf_counter()
            path = view.save(Path(folder) / "page.html")
            made = time.perf_counter() - began
            frames = []
            requests.clear()
            for _ in range(5):
                context = chromium.new_context(offline=True)
                page = context.new_page()
                page.on("request", lambda r: requests.append(r.url))
                page.goto(path.as_uri())
                page.wait_for_selector("html[data-drawn]")
                frames.append(float(page.evaluate("document.documentElement.dataset.drawn")))
                context.close()
            asked = len([r for r in requests if r != path.as_uri()])
            size = path.stat().st_size
            print(f"{name:30} {size:7} {min(frames):9.0f} ms {asked:9} {made * 1e3:6.1f} ms")
        if len(sys.argv) > 1:
            standing = disk.steady(np.radians(80)).kicked(-0.01)
            held = [sc.roll(disk, standing, 30.0, contact=c) for c in ("rolling", "smooth")]
            beside = sc.view(*held, labels=["a disk on rubber", "the same on ice"])
            page = chromium.new_page(viewport={"width": 1200, "height": 560})
            page.goto(beside.save(Path(folder) / "beside.html").as_uri() + "#t=5")
            page.check("#momentum")
            page.check("#omega")
            page.wait_for_timeout(300)
            page.screenshot(path=sys.argv[1])
        chromium.close()
    state = pipe.steady(np.radians(89.5))
    turn = sc.roll(pipe, state, 2 * np.pi / state.precession)
    for upper in ("O", "X"):
        os, xs = letters(sc.exposure(turn, upper=upper))
        print(f"exposure, upper end {upper}: {os} O, {xs} X")
    for samples in (1e6, 4e6, 1e8):
        spent = []
        for _ in range(3):
            began = time.perf_counter()
            sc.exposure(turn, samples=samples)
            spent.append(time.perf_counter() - began)
        print(f"exposure of {samples:.0e} samples: {min(spent):.3f} s")


if __name__ == "__main__":
    main()
