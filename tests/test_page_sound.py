"""The sound of pages: silent until asked for, louder where the contact point passes the eye, and impacts at their times."""

import numpy as np
import pytest
from page_scenes import COIN, PIPE
from playing import ask
from test_film_sound import fallen

import spincyl as sc

SIZE = sc.Scale(radius=0.0375)
#: Counts contexts, and notes when impacts sound: the time of the sound, and its loudness.
NOTES = """
window.contexts = 0; window.struck = [];
const Real = AudioContext;
window.AudioContext = class extends Real { constructor() { super(); window.contexts++; } };
const start = AudioBufferSourceNode.prototype.start;
AudioBufferSourceNode.prototype.start = function (...at) {
  if (at.length) window.struck.push(at[0]);
  return start.apply(this, at);
};
"""
#: The loudest sample of the sound in some tenths of a second.
LOUD = """async tenths => {
  const a = window.spincyl.audio(), n = new AnalyserNode(a, { fftSize: 8192 }), x = new Float32Array(8192), found = [];
  a.out.connect(n);
  for (let i = 0; i < tenths; i++) {
    await new Promise(done => setTimeout(done, 100));
    n.getFloatTimeDomainData(x);
    found.push(x.reduce((most, y) => Math.max(most, Math.abs(y)), 0));
  }
  return found;
}"""


@pytest.fixture(scope="module")
def coin():
    return sc.view(sc.roll(COIN, COIN.steady(0.2), 200.0), scale=SIZE, slow=5)


def test_nothing_sounds_until_the_button_is_pressed_and_nothing_while_the_page_rests(shown, coin):
    page = shown(coin, "#t=0.5", script=NOTES)
    page.wait_for_selector("html[data-drawn]")
    page.keyboard.press("Space")
    page.wait_for_timeout(300)
    assert page.evaluate("window.contexts") == 0
    page.click("#hear")
    assert page.locator("#hear").get_attribute("aria-pressed") == "true"
    assert max(page.evaluate(LOUD, 15)) > 0.02
    page.click("#play")
    page.wait_for_timeout(600)
    assert max(page.evaluate(LOUD, 4)) < 1e-3, "at rest"
    page.keyboard.press("s")
    assert page.locator("#hear").get_attribute("aria-pressed") == "false"
    assert page.evaluate("window.contexts") == 1 and page.complaints == [] and len(page.requests) == 1


@pytest.mark.parametrize("motion", ["coin", "bounces"])
def test_what_is_heard_at_a_time_is_the_contact_point_of_the_motion(shown, coin, motion):
    m = coin.motions[0] if motion == "coin" else fallen()
    page = shown(coin if motion == "coin" else sc.view(m, scale=SIZE), "#t=0")
    t = np.linspace(0.1, 50.0, 40)
    there = m.wanting("pose", t=t)
    s, c = np.sin(there.theta), np.cos(there.theta)
    speed = np.abs(there.w[:, 2] - there.w[:, 0] * c / s)
    on = np.ones(t.size, bool) if motion == "coin" else there.phase < 2
    off = there.contact_point - there.centre[:, :2]
    azimuth = np.arctan2(off[:, 1], off[:, 0])
    seen = page.evaluate("all => all.map(t => window.spincyl.heardAt(t)[0])", t.tolist())
    for k, (angle, fast) in enumerate(seen):
        if not on[k]:
            assert fast == 0 or there.phase[k] not in (2, 7)
            continue
        assert fast == pytest.approx(speed[k], rel=0.02, abs=0.02)
        assert np.cos(angle - azimuth[k]) > 0.999
    assert on.sum() > 20


def test_the_recorded_page_strikes_at_the_impacts_of_the_motion(shown):
    m = fallen()
    page = shown(sc.view(m, scale=SIZE), "#t=0")
    told = np.array(page.evaluate("window.spincyl.hits()"))
    sizes = np.array([np.linalg.norm(x.impulse) for x in m.impacts])
    loud = sizes > 1e-3 * sizes.max()
    assert told[:, 0] == pytest.approx(
        [x.time for x in m.impacts if np.linalg.norm(x.impulse) > 1e-3 * sizes.max()], rel=1e-5
    )
    assert told[:, 1] == pytest.approx(sizes[loud], rel=1e-5)


def test_an_impact_sounds_when_it_is_seen(shown):
    m = fallen()
    page = shown(sc.view(m, scale=SIZE, slow=20), "#t=0", script=NOTES)
    page.wait_for_selector("html[data-drawn]")
    page.click("#hear")
    page.click("#play")
    hit = SIZE.seconds(m.impacts[0].time)
    page.wait_for_function("() => window.struck.length > 0")
    now, at, clock = page.evaluate(
        "[window.spincyl.at(), window.struck[0], window.spincyl.audio().currentTime]"
    )
    assert now - (clock - at) / 20 == pytest.approx(hit, abs=0.02)
    assert page.complaints == []


def test_a_page_of_silence_has_no_button(shown):
    still = sc.roll(COIN, sc.State(COIN.theta_balance, 0.0, 0.0, 0.0), 1.0)
    page = shown(sc.view(still), "#t=0")
    assert not page.locator("#hear").is_visible()
    page.keyboard.press("s")
    assert page.evaluate("window.spincyl.audio()") is None and page.complaints == []


def test_the_live_page_strikes_where_the_motion_of_the_library_lands(opened):
    flick = sc.pressed(PIPE, 14.0, np.radians(80), finger=0.3)
    told = sc.play(PIPE, state=flick, contact=sc.Coulomb(0.3), restitution=0.5, t=20)
    page = opened(told.address)
    m = told.motion
    seen = np.array(ask(page, "hits()"))
    assert len(seen) > 3
    first = [x for x in m.impacts if x.time < 10]
    for t, size in seen[:3]:
        near = min(first, key=lambda x: abs(x.time - t))
        assert near.time == pytest.approx(t, abs=1e-3)
        assert np.linalg.norm(near.impulse) == pytest.approx(size, rel=0.1)


def test_the_live_page_hears_the_contact_point_of_the_library(opened):
    told = sc.play(COIN, 0.3, losses=sc.loss.DryContour(5e-3), t=100)
    page = opened(told.address)
    t = np.array([1.0, 5.0, 9.0])
    there = told.motion.wanting("pose", t=t)
    s, c = np.sin(there.theta), np.cos(there.theta)
    off = there.contact_point - there.centre[:, :2]
    for k, time in enumerate(t):
        angle, fast = page.evaluate("t => window.spincyl.heardAt(t)[0]", time)
        assert fast == pytest.approx(abs(there.w[k, 2] - there.w[k, 0] * c[k] / s[k]), rel=1e-3)
        assert np.cos(angle - np.arctan2(off[k, 1], off[k, 0])) > 0.9999
    page.click("#hear")
    page.click("#play")
    assert max(page.evaluate(LOUD, 15)) > 0.02 and page.complaints == []
