"""The live page: sizes, ms of opening, of a change, of the map and of a picture; and screenshots.

The opening is compared with that of a page with nothing but one triangle in WebGL, which is the browser's own
share. The pages are opened in turn, and the least time counts, because other work on the machine can only add
to it. The time that the page's thread computes until its first picture depends least on other work.

Prints a table; with a folder, writes screenshots of the scenes at three sizes, light and dark. Needs
Chromium.

usage: python benches/play.py [FOLDER] [--scenes WORD ...]
"""

import argparse
import gzip
import json
import lzma
import tempfile
from importlib.resources import files
from pathlib import Path
from statistics import median
from sys import path as search

from playwright.sync_api import sync_playwright

import spincyl as sc
from spincyl.studio.pages.play import CORES
from spincyl.studio.pages.words import scenes

search.append(str(Path(__file__).parents[1] / "tests"))
import browser

SIZES = {"lecture": (1920, 1080), "laptop": (1280, 800), "phone": (390, 844)}
FLAGS = [*browser.FLAGS, "--disable-accelerated-2d-canvas"]
#: A page that makes the same kind of WebGL context and draws one triangle.
TRIANGLE = """<!DOCTYPE html><meta charset="utf-8"><canvas width="680" height="370"></canvas><script>
const how = { antialias: true, stencil: true, alpha: false, preserveDrawingBuffer: true };
const gl = document.querySelector("canvas").getContext("webgl2", how), program = gl.createProgram();
for (const [kind, text] of [
  [gl.VERTEX_SHADER, "in vec2 place; void main() { gl_Position = vec4(place, 0.0, 1.0); }"],
  [gl.FRAGMENT_SHADER, "precision highp float; out vec4 o; void main() { o = vec4(0.2, 0.4, 0.8, 1.0); }"],
]) {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, "#version 300 es\\n" + text);
  gl.compileShader(shader);
  gl.attachShader(program, shader);
}
gl.linkProgram(program);
gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, 0, 1]), gl.STATIC_DRAW);
gl.enableVertexAttribArray(0);
gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
gl.useProgram(program);
requestAnimationFrame(() => {
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  document.documentElement.dataset.drawn = gl.getError() || performance.now();
});
</script>"""
#: The browser's record of its first picture, in JavaScript.
PAINTED = "performance.getEntriesByName('first-contentful-paint')[0]"
#: Marks the beginning and the first picture of a page in a trace, which records the CPU time of its thread.
MARKS = """performance.mark("beginning");
new MutationObserver(() => document.documentElement?.dataset.drawn && performance.mark("first picture"))
  .observe(document, { attributes: true, subtree: true, attributeFilter: ["data-drawn"] });"""
DRAG = """async () => {
  const { set, timing, solve } = window.spincyl, found = { solve: [], change: [], frame: [] };
  for (let i = 0; i < 60; i++) {
    set({ ell: 1 + i / 40, theta: 1.1 + 0.004 * i }, {});
    await new Promise(requestAnimationFrame);
    await new Promise(requestAnimationFrame);
    for (const name in found) found[name].push(timing[name]);
  }
  const maps = [];
  for (let i = 0; i < 12; i++) {
    set({ bore: 0.5 + i / 100 }, {});
    await new Promise(done => setTimeout(done, 400));
    maps.push(timing.map);
  }
  return { ...found, map: maps };
}"""


def opened(chromium, path):
    """A page, and three times in ms: when it has drawn its first picture, when the browser shows it, and the
    CPU time before it."""
    page = chromium.new_page(viewport={"width": 1280, "height": 800})
    page.add_init_script(MARKS)
    chromium.start_tracing(page=page, categories=["blink.user_timing"])
    page.goto(path.as_uri())
    page.wait_for_function(f"() => document.documentElement.dataset.drawn && {PAINTED}")
    drawn = float(page.evaluate("document.documentElement.dataset.drawn"))
    marks = {e["name"]: e for e in json.loads(chromium.stop_tracing())["traceEvents"] if "tts" in e}
    busy = (marks["first picture"]["tts"] - marks["beginning"]["tts"]) / 1000
    return page, drawn, page.evaluate(f"{PAINTED}.startTime"), busy


def openings(chromium, paths, rounds):
    """For each page the least values and the medians of the three times of `opened`."""
    found = {name: [] for name in paths}
    for _ in range(rounds):
        for name, path in paths.items():
            page, *times = opened(chromium, path)
            found[name].append(times)
            page.close()
    columns = {name: list(zip(*times, strict=True)) for name, times in found.items()}
    return {name: [f(x) for f in (min, median) for x in times] for name, times in columns.items()}


def measured(chromium, path):
    """Medians of the times that the page itself measures, in ms."""
    page, *_ = opened(chromium, path)
    found = page.evaluate(DRAG)
    page.close()
    return {k: median(v) for k, v in found.items()}


def shots(chromium, page_path, folder, words):
    """Saves screenshots of the scenes whose names contain one of the words."""
    chosen = [(name, told) for name, told in scenes() if any(word in name for word in words)]
    for size, (width, height) in SIZES.items():
        for scheme in ("light", "dark"):
            for name, told in chosen:
                page = chromium.new_page(viewport={"width": width, "height": height}, color_scheme=scheme)
                page.emulate_media(color_scheme=scheme, reduced_motion="reduce")
                address = {k: ",".join(map(str, v)) if isinstance(v, list) else v for k, v in told.items()}
                hash_ = "&".join(f"{k}={v}" for k, v in address.items())
                page.goto(f"{page_path.as_uri()}#{hash_}&t=3")
                page.wait_for_selector("html[data-drawn]")
                for box in ("omega", "momentum") if "nods" in name else ():
                    page.check(f"#{box}")
                page.wait_for_timeout(1200)
                place = folder / f"{size}-{scheme}-{name.replace(' ', '-').replace(chr(39), '')}.png"
                page.screenshot(path=place)
                print(place)
                page.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("--scenes", nargs="+", default=["nods", "letters", "on ice", "Euler"])
    parser.add_argument("--rounds", type=int, default=15, help="how often each page is opened")
    args = parser.parse_args()
    with sync_playwright() as p, tempfile.TemporaryDirectory() as temporary:
        paths = {"one triangle": Path(temporary) / "triangle.html"}
        paths["one triangle"].write_text(TRIANGLE)
        for friction, name in enumerate(CORES):
            core = files("spincyl.studio.pages").joinpath("cores", name).read_bytes()
            path = sc.play(friction=bool(friction)).save(Path(temporary) / f"play{friction}.html")
            paths["whole page" if friction else "lean page"] = path
            print(
                f"{name:22} {int.from_bytes(lzma.decompress(core)[:4], 'big')} bytes, LZMA {len(core)};",
                end=" ",
            )
            print(f"page {path.stat().st_size} bytes, gzip {len(gzip.compress(path.read_bytes()))}")
        chromium = p.chromium.launch(executable_path=browser.executable(), args=FLAGS)
        if args.folder:
            args.folder.mkdir(exist_ok=True, parents=True)
            shots(chromium, path, args.folder, args.scenes)
        else:
            print("opening, in ms          least: drawn    shown computing  median: drawn    shown computing")
            for name, times in openings(chromium, paths, args.rounds).items():
                print(
                    f"{name:20}" + "".join(f"{ms:{15 if i % 3 == 0 else 9}.1f}" for i, ms in enumerate(times))
                )
            for name, ms in measured(chromium, path).items():
                print(f"{name:14} {ms:8.2f} ms")
        chromium.close()


if __name__ == "__main__":
    main()
