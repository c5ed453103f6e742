"""The live page in a notebook, both ways; a page of the tests replaces the front end of anywidget."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("anywidget")

import spincyl as sc
from spincyl.studio.pages.widget import _SCRIPT

#: The model that anywidget gives a script: values, and callbacks for their changes.
MODEL = """
const values = %s, calls = {};
window.saved = [];
const model = {
  get: name => values[name],
  set: (name, value) => {
    if (JSON.stringify(values[name]) === JSON.stringify(value)) return;
    values[name] = value;
    calls["change:" + name]?.();
  },
  save_changes: () => { window.saved.push(structuredClone(values.state)); },
  on: (event, call) => { calls[event] = call; },
  off: event => { delete calls[event]; },
};
window.sets = state => model.set("state", state);
"""
SHOWN = "() => window.spincyl?.state?.().theta === "


def shown(page):
    """The widget behind the output of a page in a notebook."""
    page._repr_html_()
    return page._widget


@pytest.fixture
def notebook(chromium, tmp_path):
    """A function that opens a page with outputs and a widget's model, which is created at once or later."""
    opened = []

    def show(widget, *outputs, late=False):
        values = json.dumps({"name": widget.name, "state": widget.state}).replace("<", "\\u003c")
        path = tmp_path / "notebook.html"
        script = _SCRIPT.replace("export default", "const made =")
        begin = "window.begin = () => { window.ends = made.initialize({ model }); };" + "begin();" * (
            not late
        )
        path.write_text(
            f"<meta charset=utf-8><body><script>{MODEL % values}</script><script type=module>{script}\n{begin}</script>"
            + "".join(outputs)
        )
        page = chromium.new_page(viewport={"width": 1280, "height": 1600}, reduced_motion="reduce")
        opened.append(page)
        page.set_default_timeout(chromium.patience)
        page.goto(path.as_uri())
        for i, _ in enumerate(outputs):
            page.frames[i + 1].wait_for_function("() => document.documentElement.dataset.drawn !== undefined")
        return page

    yield show
    for page in opened:
        page.close()


def push(frame, knob, value):
    """Move a slider in a frame."""
    frame.locator(f"#knob-{knob}").evaluate(
        "(e, value) => { e.value = value; e.dispatchEvent(new Event('input')); }", value
    )


def test_what_is_set_in_python_is_the_state_of_the_widget():
    page = sc.play(sc.Body.solid(2.5), 1.3)
    widget = shown(page)
    page.theta = 1.2
    assert widget.state["theta"] == 1.2 and "w" not in widget.state
    page.contact = sc.Coulomb(0.2)
    assert widget.state["contact"] == "coulomb" and widget.state["mu"] == 0.2 and widget.state["theta"] == 1.2
    page.body = sc.Body.balls()
    assert widget.state["i3"] == 0.4 and "bore" not in widget.state
    assert shown(page) is widget, "shown twice, it has one state"


def test_what_a_hand_does_on_the_page_is_seen_in_python():
    page = sc.play(sc.Body.solid(2.5), 1.3)
    told = page._told | {"ell": 1.5, "theta": 1.4, "contact": "smooth", "kick": 0.1, "i1": None, "w": None}
    shown(page).state = told
    assert page.body == sc.Body.solid(1.5) and page.theta == 1.4 and page.contact == "smooth"
    assert page.state == sc.Body.solid(1.5).steady(1.4).kicked(0.1)
    assert np.isfinite(page.motion.theta).all()


def test_a_measured_body_keeps_its_size_when_a_hand_makes_it_longer():
    tube = sc.measured(outer_diameter=0.05, length=0.15, mass=0.1)
    page = sc.play(tube, 1.3)
    widget = shown(page)
    widget.state = page._told | {"ell": 4.0, "gravity": 9.80665}
    assert page.body.scale == tube.scale and page.body.ell == 4.0
    page.body = sc.Body.solid(2.5)
    assert "radius" not in widget.state, "the page forgets it with the body"


def test_the_output_is_the_page_itself_and_no_view_of_a_widget():
    page = sc.play(sc.Body.solid(2.5), 1.3)
    assert f'<iframe name="{shown(page).name}" sandbox=' in page._repr_html_()
    assert not hasattr(page, "_repr_mimebundle_")


def test_what_is_typed_in_a_notebook_is_completed():
    jedi = pytest.importorskip("jedi")
    body = sc.Body.solid(2.5)
    motion = sc.roll(body, body.steady(1.3), 5.0)
    stone = sc.Ellipsoid.rattleback((0.07, 0.014, 0.012), twist=0.03)
    nouns = (
        body,
        motion,
        body.steady(1.3),
        sc.Scale(0.01),
        sc.swing(body, body.steady(1.3).kicked(0.1)),
        stone,
    )
    for noun in (*nouns, sc.play(body, 1.3), sc.view(motion), sc.Coulomb(0.2), sc.loss.DryContour(0.1)):
        found = {name.name for name in jedi.Interpreter("noun.", [{"noun": noun}]).complete()}
        assert found >= {name for name in dir(noun) if name[0] != "_"}, type(noun)


@pytest.mark.parametrize("allowed", [True, False])
def test_where_a_program_runs_the_notebook_there_is_no_widget(monkeypatch, allowed):
    IPython = pytest.importorskip("IPython")
    asked = {"content": {"allow_stdin": allowed}}
    shell = SimpleNamespace(kernel=SimpleNamespace(get_parent=lambda channel: asked))
    monkeypatch.setattr(IPython, "get_ipython", lambda: shell)
    page = sc.play(sc.Body.solid(2.5), 1.3)
    assert ("name=" in page._repr_html_()[:100]) == allowed == (page._widget is not None)


def test_a_page_shows_what_was_set_before_it_opened_and_tells_nothing_of_itself(notebook):
    play = sc.play(sc.Body.solid(2.5), 1.3)
    output, widget = play._repr_html_(), shown(play)
    play.theta = 1.2
    page = notebook(widget, output)
    page.frames[1].wait_for_function(SHOWN + "1.2")
    assert page.evaluate("window.saved") == []


def test_a_model_that_is_made_after_the_page_tells_it_the_state(notebook):
    play = sc.play(sc.Body.solid(2.5), 1.3)
    output, widget = play._repr_html_(), shown(play)
    play.theta = 1.2
    page = notebook(widget, output, late=True)
    page.frames[1].wait_for_function(SHOWN + "1.3")
    page.evaluate("window.begin()")
    page.frames[1].wait_for_function(SHOWN + "1.2")
    assert page.evaluate("window.saved") == []
    page.evaluate("window.ends()")
    push(page.frames[1], "kick", 0.2)
    page.wait_for_timeout(200)
    assert page.evaluate("window.saved") == [], "who is gone hears nothing"


def test_all_pages_follow_python_and_each_other(notebook):
    play = sc.play(sc.Body.solid(2.5), 1.3)
    widget = shown(play)
    page = notebook(widget, play._repr_html_(), play._repr_html_())
    for theta in (1.25, 1.15, 1.1):
        play.theta = theta
        page.evaluate("state => window.sets(state)", dict(widget.state))
    for frame in page.frames[1:]:
        frame.wait_for_function(SHOWN + "1.1")
    page.wait_for_timeout(200)
    assert page.evaluate("window.saved") == [], "what was heard is not told again"
    for k, knob in enumerate(("kick", "theta")):
        push(page.frames[1 + k], knob, (0.2, 1.2)[k])
        page.wait_for_function("n => window.saved.length === n", arg=k + 1)
        widget.state = page.evaluate("window.saved.at(-1)")
        page.frames[2 - k].wait_for_function(
            "want => window.spincyl.state().theta === want[0] && window.spincyl.state().kick === want[1]",
            arg=[play.theta, play.kick],
        )
    assert (play.theta, play.kick) == (1.2, 0.2) and play.state == sc.Body.solid(2.5).steady(1.2).kicked(0.2)
    # a reloaded page starts with this state
    page.frames[1].evaluate("location.reload()")
    page.wait_for_timeout(300)
    page.frames[1].wait_for_function(SHOWN + "1.2")
    assert page.evaluate("window.saved.length") == 2


def test_slow_motion_is_told_and_what_cannot_be_shown_is_told_as_it_is(notebook):
    play = sc.play(sc.Body.solid(2.5), 1.3)
    widget = shown(play)
    page = notebook(widget, play._repr_html_())
    page.frames[1].locator("#slow").select_option("100")
    page.wait_for_function("() => window.saved.at(-1)?.slow === 100")
    page.evaluate("state => window.sets(state)", widget.state | {"theta": 3.0})
    page.wait_for_function("() => window.saved.at(-1).theta === Math.PI / 2")


def test_a_page_of_a_rattleback_is_followed(notebook):
    from spincyl.studio.pages.words import scenes

    play = sc.play(sc.Body.solid(2.5), 1.3)
    page = notebook(shown(play), play._repr_html_(), play._repr_html_())
    page.frames[1].locator("#preset").select_option("a rattleback turns back")
    page.wait_for_function("() => window.saved.at(-1)?.stone")
    play._widget.state = page.evaluate("window.saved.at(-1)")
    assert repr(play).startswith("<Play of a rattleback") and dict(scenes())["a rattleback turns back"]
    page.frames[2].wait_for_function("() => window.spincyl.state().stone")
    play.body = sc.Body.solid(1.5)
    page.evaluate("state => window.sets(state)", dict(play._widget.state))
    for frame in page.frames[1:]:
        frame.wait_for_function("() => !window.spincyl.state().stone && window.spincyl.state().ell === 1.5")


def test_a_notebook_of_another_name_is_not_heard(notebook):
    play, other = sc.play(sc.Body.solid(2.5), 1.3), sc.play(sc.Body.solid(1.5), 1.3)
    page = notebook(shown(play), play._repr_html_(), other._repr_html_())
    push(page.frames[2], "kick", 0.2)
    push(page.frames[1], "kick", 0.1)
    page.wait_for_function("() => window.saved.length > 0")
    assert page.evaluate("window.saved.at(-1)")["kick"] == 0.1
    assert page.frames[2].evaluate("window.spincyl.state()")["ell"] == 1.5


def test_in_the_frame_of_a_notebook_every_control_is_whole_by_day_and_by_night(notebook):
    play = sc.play(sc.Body.solid(2.5), 1.3)
    page = notebook(shown(play), f"<div style='width:828px'>{play._repr_html_()}</div>")
    inner = page.frames[1]
    for width, height in ((828, 680), (1080, 800), (1500, 1080)):
        page.set_viewport_size({"width": 1600, "height": height})
        page.evaluate("width => { document.querySelector('div').style.width = width + 'px'; }", width)
        inner.wait_for_function("width => innerWidth === width", arg=width)
        inner.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
        size, high = inner.evaluate("[document.documentElement.scrollHeight, innerHeight]")
        assert size <= high <= height, (width, height)
        cut = inner.locator("header > *, #bar > *, #knobs > label, #tell").evaluate_all(
            "all => all.filter(e => e.scrollHeight > e.clientHeight + 2 && e.tagName !== 'DETAILS' || e.getBoundingClientRect().right > innerWidth"
            " || e.getBoundingClientRect().bottom > innerHeight).map(e => e.outerHTML.slice(0, 80))"
        )
        assert cut == [], (width, height)
        tops = inner.locator("header > *").evaluate_all(
            "all => all.filter(e => e.offsetHeight).map(e => e.offsetTop + e.offsetHeight / 2)"
        )
        assert max(tops) - min(tops) < 4, "one line"
    # a notebook hides its frames while it changes its theme
    light = inner.evaluate(PAINTED)
    page.evaluate(
        "() => { const frame = document.querySelector('iframe'); document.body.dataset.jpThemeLight = 'false'; frame.style.display = 'none';"
        " setTimeout(() => { frame.style.display = ''; }, 150); }"
    )
    inner.wait_for_function("light => (" + PAINTED + ")().every((sum, i) => sum < 0.7 * light[i])", arg=light)


#: Brightness of the map and the tracks.
PAINTED = """() => ["map", "chart"].map(id => {
  const c = document.getElementById(id), { data } = c.getContext("2d").getImageData(0, 0, c.width, c.height);
  return data.reduce((sum, x, i) => i % 4 < 3 ? sum + x : sum, 0) / data.length;
})"""
