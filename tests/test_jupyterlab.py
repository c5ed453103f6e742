"""The live page in JupyterLab: both directions, twice, reloaded, without a kernel, by day and by night."""

import importlib.util
import json
import os
import subprocess
import sys
import time
import urllib.request
from contextlib import suppress

import browser
import pytest

NEEDED = ("anywidget", "jupyterlab", "nbconvert")
MISSING = [name for name in NEEDED if not importlib.util.find_spec(name)]
pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(bool(MISSING), reason=f"no {', no '.join(MISSING)}: `pip install --group jupyter`"),
]

FIRST = "import spincyl as sc\nbody = sc.Body.solid(2.5)\np = sc.play(body, 1.3)\np"
SHOWN = "want => { const { theta, kick } = window.spincyl?.state?.() ?? {}; return theta === want[0] && kick === want[1]; }"
NIGHT = "() => document.documentElement.hasAttribute('data-night')"


def write(path, *cells, **output):
    """A notebook with these cells."""
    made = [
        {"cell_type": "code", "id": f"c{i}", "source": source, "metadata": {}, "outputs": [], "execution_count": None}
        for i, source in enumerate(cells)
    ]  # fmt: skip
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    path.write_text(
        json.dumps(
            {"cells": made, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5} | output
        )
    )


def environment(root):
    """Environment variables that keep all files of Jupyter in a folder."""
    kept = {
        "JUPYTER_CONFIG_DIR": "config",
        "JUPYTER_DATA_DIR": "data",
        "JUPYTER_RUNTIME_DIR": "runtime",
        "JUPYTERLAB_SETTINGS_DIR": "settings",
        "JUPYTERLAB_WORKSPACES_DIR": "workspaces",
        "IPYTHONDIR": "ipython",
    }
    return os.environ | {name: str(root / ".kept" / folder) for name, folder in kept.items()}


@pytest.fixture(scope="module")
def lab(tmp_path_factory):
    """The address of a running JupyterLab, and the folder that it serves."""
    root = tmp_path_factory.mktemp("lab")
    settings = root / ".kept/settings/@jupyterlab/apputils-extension"
    settings.mkdir(parents=True)
    (settings / "notification.jupyterlab-settings").write_text('{"fetchNews": "false"}')
    how = [
        "--no-browser", "--allow-root", "--port=0", "--ServerApp.ip=127.0.0.1", "--IdentityProvider.token=", "--ServerApp.disable_check_xsrf=True",
        f"--ServerApp.root_dir={root}", "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate",
    ]  # fmt: skip
    with (root / "said").open("w") as said:
        server = subprocess.Popen(
            [sys.executable, "-m", "jupyterlab", *how], env=environment(root), stdout=said, stderr=said
        )
        try:
            yield served(root, server), root
        finally:
            server.terminate()
            server.wait(60)


def served(root, server):
    """The address of the server, as soon as it answers."""
    for _ in range(600):
        assert server.poll() is None, (root / "said").read_text()
        for found in (root / ".kept/runtime").glob("jpserver-*.json"):
            with suppress(OSError, ValueError):
                address = json.loads(found.read_text())["url"]
                urllib.request.urlopen(address + "api", timeout=10)
                return address
        time.sleep(0.1)
    raise AssertionError((root / "said").read_text())


@pytest.fixture
def notebook(chromium, lab):
    """A function that opens notebooks in JupyterLab, without access to other hosts."""
    address, _ = lab
    contexts = []

    def show(name):
        context = chromium.new_context(viewport={"width": 1280, "height": 3400}, reduced_motion="reduce")
        context.set_default_timeout(browser.PATIENCE)
        contexts.append(context)
        page = context.new_page()
        page.asked = []
        page.on("request", lambda r: page.asked.append(r.url))
        page.goto(f"{address}doc/tree/{name}")
        ready(page)
        return page

    yield show
    for context in contexts:
        asked = [
            url for page in context.pages for url in page.asked
            if not url.startswith((address, "blob:", "data:", "about:"))
        ]  # fmt: skip
        context.close()
        assert asked == []
    kernels = json.loads(urllib.request.urlopen(address + "api/kernels", timeout=30).read())
    for kernel in kernels:
        gone = urllib.request.Request(f"{address}api/kernels/{kernel['id']}", method="DELETE")
        urllib.request.urlopen(gone, timeout=60)


def ready(page):
    """Wait until the kernel is idle."""
    page.wait_for_selector(".jp-Notebook .jp-Cell", timeout=120_000)
    page.wait_for_selector(".jp-Notebook-ExecutionIndicator[data-status=idle]", timeout=120_000)


def run(page, i):
    """Run a cell and return its output."""
    cell = page.locator(".jp-Notebook .jp-Cell").nth(i)
    before = cell.locator(".jp-InputPrompt").inner_text()
    cell.locator(".cm-content").click()
    page.keyboard.press("Control+Enter")
    page.wait_for_function(
        "([i, before]) => { const now = document.querySelectorAll('.jp-Notebook .jp-Cell')[i].querySelector('.jp-InputPrompt').innerText;"
        " return /\\d/.test(now) && now !== before; }",
        arg=[i, before],
    )
    page.wait_for_selector(".jp-Notebook-ExecutionIndicator[data-status=idle]")
    said = cell.locator(".jp-OutputArea-output pre")
    return said.last.inner_text().strip() if said.count() else ""


def frames(page, n):
    """The pages in the outputs, as soon as there are n."""
    page.wait_for_function("n => document.querySelectorAll('.jp-OutputArea iframe').length === n", arg=n)
    found = [handle.content_frame() for handle in page.query_selector_all(".jp-OutputArea iframe")]
    for frame in found:
        frame.wait_for_selector("html[data-drawn]", timeout=60_000)
    return found


def push(frame, knob, value):
    """Move a slider of the page."""
    frame.locator(f"#knob-{knob}").evaluate(
        "(e, value) => { e.value = value; e.dispatchEvent(new Event('input')); }", value
    )


def follow(found, *want):
    for frame in found:
        frame.wait_for_function(SHOWN, arg=list(want))


def save(page):
    page.keyboard.press("Escape")
    page.keyboard.press("Control+s")
    page.wait_for_selector(".jp-mod-dirty", state="detached")


def test_all_renderings_follow_one_state_both_ways_and_after_a_reload(notebook, lab):
    write(
        lab[1] / "both.ipynb",
        FIRST,
        "p.theta = 1.22\np",
        "q = sc.play(body, 1.3); display(q); q.theta = 1.2",
        "print(p.theta, p.kick, q.theta)",
        "p.theta = 1.25",
    )
    page = notebook("both.ipynb")
    run(page, 0)
    follow(frames(page, 1), 1.3, 0)
    run(page, 1)
    follow(frames(page, 2), 1.22, 0)
    run(page, 2)
    *both, alone = frames(page, 3)
    follow([alone], 1.2, 0)
    push(both[1], "kick", 0.2)
    follow(both, 1.22, 0.2)
    assert run(page, 3) == "1.22 0.2 1.2"
    save(page)
    page.reload()
    ready(page)
    *both, alone = frames(page, 3)
    follow(both, 1.22, 0.2)
    follow([alone], 1.2, 0)
    push(both[0], "kick", 0.1)
    follow(both, 1.22, 0.1)
    run(page, 4)
    follow(both, 1.25, 0.1)
    assert run(page, 3).startswith("1.25 0.1")
    # a second window of the browser on the same kernel
    save(page)
    other = notebook("both.ipynb")
    follow(frames(other, 3)[:2], 1.25, 0.1)
    push(frames(other, 3)[0], "kick", 0.3)
    follow(both, 1.25, 0.3)


def test_a_saved_notebook_without_its_kernel_shows_the_page(notebook, lab):
    address, root = lab
    write(root / "saved.ipynb", FIRST)
    page = notebook("saved.ipynb")
    run(page, 0)
    follow(frames(page, 1), 1.3, 0)
    save(page)
    kept = json.loads((root / "saved.ipynb").read_text())
    (output,) = kept["cells"][0]["outputs"]
    assert set(output["data"]) == {"text/plain", "text/html"} and "widgets" not in kept["metadata"]
    page.close()
    for kernel in json.loads(urllib.request.urlopen(address + "api/kernels", timeout=30).read()):
        urllib.request.urlopen(
            urllib.request.Request(f"{address}api/kernels/{kernel['id']}", method="DELETE"), timeout=60
        )
    page = notebook("saved.ipynb")
    (frame,) = frames(page, 1)
    push(frame, "kick", 0.2)
    follow([frame], 1.3, 0.2)
    assert "model not found" not in page.locator(".jp-Notebook").inner_text()
    page.close()
    # a notebook from someone else, which is not trusted
    output["data"]["text/html"] = "".join(output["data"]["text/html"]).replace("allowfullscreen ", "", 1)
    (root / "theirs.ipynb").write_text(json.dumps(kept))
    page = notebook("theirs.ipynb")
    page.get_by_text("It is shown when this notebook is trusted").wait_for()


def test_pages_follow_the_theme_of_jupyterlab(notebook, lab):
    write(lab[1] / "night.ipynb", FIRST, "sc.view(sc.roll(body, body.steady(1.3).kicked(0.05), 20.0))")
    page = notebook("night.ipynb")
    run(page, 0)
    run(page, 1)
    found = frames(page, 2)
    for theme, night in (("JupyterLab Dark", True), ("JupyterLab Light", False)):
        page.get_by_role("menuitem", name="Settings", exact=True).click()
        page.get_by_text("Theme", exact=True).hover()
        page.get_by_text(theme, exact=True).click()
        for frame in found:
            frame.wait_for_function(NIGHT if night else NIGHT.replace("=> ", "=> !"))


def test_a_notebook_that_nbconvert_runs_shows_the_page_and_asks_for_no_more_than_any(chromium, tmp_path):
    asked = {}
    for name, source in (("plain", "1 + 1"), ("played", FIRST)):
        write(tmp_path / f"{name}.ipynb", source)
        how = ["-m", "nbconvert", "--execute", "--to", "html", f"{name}.ipynb"]
        done = subprocess.run(
            [sys.executable, *how], cwd=tmp_path, env=environment(tmp_path), capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        context = chromium.new_context(viewport={"width": 1280, "height": 800}, reduced_motion="reduce")
        context.set_default_timeout(browser.PATIENCE)
        page = context.new_page()
        asked[name] = set()
        page.on("request", lambda r, name=name: asked[name].add(r.url.split(".ipynb")[0]))
        page.route("http**", lambda route: route.abort())
        page.goto((tmp_path / f"{name}.html").as_uri())
        if name == "played":
            page.frame_locator("iframe").locator("html[data-drawn]").wait_for()
            frame = page.query_selector("iframe").content_frame()
            push(frame, "kick", 0.2)
            follow([frame], 1.3, 0.2)
        context.close()
    abroad = {name: {url for url in urls if url.startswith("http")} for name, urls in asked.items()}
    assert abroad["played"] == abroad["plain"], "the page of nbconvert asks for its own scripts"
