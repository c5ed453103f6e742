"""The live page in a notebook, both ways; the front end of anywidget is played by a page of our own."""

import numpy as np
import pytest

pytest.importorskip("anywidget")


import spincyl as sc
from spincyl._widget import _SCRIPT

#: What anywidget gives a script: a model with values, and what is called when one changes.
MODEL = """
const values = %s, calls = {};
window.model = {
  get: name => values[name],
  set: (name, value) => { values[name] = value; },
  save_changes: () => { window.saved = structuredClone(values.told); },
  on: (event, call) => { calls[event] = call; },
  off: event => { delete calls[event]; },
};
window.wanted = value => { values.wanted = value; calls["change:wanted"]?.(); };
"""


def shown(page):
    """The widget that a notebook would show."""
    page._repr_mimebundle_()
    return page._widget


def test_what_is_set_in_python_is_wanted_of_the_page():
    page = sc.play(sc.Body.solid(2.5), 1.3)
    widget = shown(page)
    page.theta = 1.2
    assert widget.wanted["theta"] == 1.2 and widget.wanted["w"] is None
    page.contact = sc.Coulomb(0.2)
    assert widget.wanted == {"contact": "coulomb", "mu": 0.2}
    page.body = sc.Body.balls()
    assert widget.wanted["i3"] == 0.4 and widget.wanted["bore"] is None
    assert page._repr_mimebundle_() and page._widget is widget, "shown twice, it is one"


def test_what_a_hand_does_on_the_page_is_seen_in_python():
    page = sc.play(sc.Body.solid(2.5), 1.3)
    told = page._told | {"ell": 1.5, "theta": 1.4, "contact": "smooth", "kick": 0.1, "i1": None, "w": None}
    shown(page).told = told
    assert page.body == sc.Body.solid(1.5) and page.theta == 1.4 and page.contact == "smooth"
    assert page.state == sc.Body.solid(1.5).steady(1.4).kicked(0.1)
    assert np.isfinite(page.motion.theta).all()


def test_a_measured_body_keeps_its_size_when_a_hand_makes_it_longer():
    tube = sc.measured(outer_diameter=0.05, length=0.15, mass=0.1)
    page = sc.play(tube, 1.3)
    widget = shown(page)
    widget.told = page._told | {"ell": 4.0, "gravity": 9.80665}
    assert page.body.scale == tube.scale and page.body.ell == 4.0
    page.body = sc.Body.solid(2.5)
    assert widget.wanted["radius"] is None, "the page forgets it with the body"


def test_the_page_in_its_frame_does_what_is_wanted_and_tells_what_is_done(chromium, tmp_path):
    import json

    play = sc.play(sc.Body.solid(2.5), 1.3)
    widget = shown(play)
    values = {name: getattr(widget, name) for name in ("page", "look", "sandbox", "wanted", "told")}
    told = json.dumps(values).replace("<", "\\u003c")
    path = tmp_path / "notebook.html"
    path.write_text(
        f"<meta charset=utf-8><body><script>{MODEL % told}</script><script type=module>"
        f"{_SCRIPT.replace('export default', 'const made =')}\nmade.render({{ model, el: document.body }});</script>"
    )
    page = chromium.new_page(viewport={"width": 1280, "height": 800}, reduced_motion="reduce")
    page.goto(path.as_uri())
    page.wait_for_function("() => window.saved?.theta === 1.3")
    play.theta = 1.1
    page.evaluate("words => window.wanted(words)", dict(widget.wanted))
    page.wait_for_function("() => window.saved.theta === 1.1")
    # a hand on the slider in the frame
    frame = page.frames[1]
    frame.locator("#knob-kick").evaluate("e => { e.value = 0.2; e.dispatchEvent(new Event('input')); }")
    page.wait_for_function("() => window.saved.kick === 0.2")
    widget.told = page.evaluate("window.saved")
    assert (play.theta, play.kick) == (1.1, 0.2) and play.state == sc.Body.solid(2.5).steady(1.1).kicked(0.2)
    page.close()
