"""The text of the live page: sentences, numbers, tracks and address agree with the library."""

import re

import numpy as np
import pytest
from few import few
from page_scenes import PIPE
from playing import LAPTOP, PHONE, address, ask, details, settled, state

import spincyl as sc
from spincyl.studio.pages.words import body_of, scenes, state_of

#: What a name of an address may be that is no number of the page's, and no key of a keyboard.
OF_EVERY_OBJECT = ("__proto__", "constructor", "toString", "hasOwnProperty", "__defineGetter__", "valueOf")

SENTENCES = {
    "#ell=2.5&theta=0.7": ("Forbidden: no rate holds it here", "Let go at rest, it falls"),
    "#ell=2.5&theta=1.3": ("Stable", "it nods"),
    "#ell=0.375&theta=1.4": ("Stable because it rolls: on ice it falls", "friction"),
    "#ell=0.375&theta=1.4&contact=smooth": ("Stable because it rolls: on ice it falls", "now it is on ice"),
    "#ell=2.5&theta=1.3&kick=0.1&contact=viscous&c=0.3": ("Stable", "it slips as it nods, and loses energy"),
    "#ell=0.375&theta=1.4&contact=viscous": (
        "Stable because it rolls: on ice it falls",
        "a wet table is between",
    ),
    "#ell=2.5&theta=1.3&precession=2.5": ("A circle of radius", "its centre goes round it"),
}


def test_a_sentence_says_what_is_seen_and_why(opened):
    page = opened()
    for at, (what, why) in SENTENCES.items():
        page.evaluate("at => { location.hash = at; }", at)
        page.wait_for_function("what => document.getElementById('said').textContent.includes(what)", arg=what)
        assert page.locator("#what").inner_text().startswith(what), at
        assert why.lower() in page.locator("#because").inner_text().lower(), at


def test_what_only_the_least_push_decides_is_not_told_to_the_last_digit(opened):
    page = opened("#ell=0.375&theta=1.4&contact=viscous")
    told = page.locator("#because").inner_text()
    assert "this push is too much" not in told, "nobody pushed it"
    assert re.search(
        r"least push grows until it decides\. Here, at about t = \d+\.\d, the other rim lands", told
    ), told
    page.evaluate("window.spincyl.set({ until: 41 })")
    settled(page)
    told = page.locator("#because").inner_text()
    assert told.endswith(
        "The least push grows until it decides: the last part shows one of many possible motions."
    ), told
    page.evaluate("window.spincyl.set({ until: 20 })")
    settled(page)
    assert "decides" not in page.locator("#because").inner_text(), "so early nothing has grown"


def test_what_an_address_says_beyond_reason_is_told_and_what_is_shown_is_what_was_computed(opened):
    page = opened("#ell=2.5&theta=85&contact=butter&foo=3")
    told = details(page)
    assert "not understood" in told and all(
        word in told for word in ("theta=85", "rad)", "contact=butter", "foo=3")
    )
    assert state(page)["theta"] == np.pi / 2 and page.locator("#what").inner_text() == "On its side"
    page.evaluate("window.spincyl.set({ theta: 1.2 })")
    settled(page)
    assert "not understood" not in details(page)


def test_the_friction_that_is_told_is_that_of_the_whole_motion(opened):
    page = opened("#ell=0.1704394&theta=0.5235988&law=dry-contour&loss=0.005&until=40")
    body = sc.Body.solid(0.1704394)
    losses = sc.loss.DryContour(0.005)
    m = sc.roll(body, body.steady(0.5235988), np.linspace(0, 40, 601), want="force", losses=losses)
    told = float(re.search(r"μ ≥ ([\d.]+)", details(page)).group(1))
    assert told == pytest.approx(m.friction_coefficient.max(), abs=0.006) and told > 0.05


def test_a_motion_that_ends_before_its_first_nod_is_over_does_not_nod(opened):
    page = opened("#ell=0.375&theta=1.396263&kick=-0.01&contact=smooth")
    assert "the other rim lands" in page.locator("#because").inner_text()
    assert "nods between" not in details(page)


def test_a_body_that_slips_to_its_end_is_not_said_to_roll(opened):
    page = opened("#ell=6&bore=0.8&theta=1.4&contact=coulomb&mu=0.3&w=0,0,3,1,0&until=40")
    assert "something else comes first" in page.locator("#because").inner_text()


def test_the_sentence_tells_the_region_that_the_library_finds(opened):
    words = {
        sc.Region.FORBIDDEN: "Forbidden", sc.Region.UNSTABLE: "Unstable", sc.Region.STABLE: "Stable",
        sc.Region.STABLE_ROLLING: "Stable because", sc.Region.STABLE_SMOOTH: "Stable on ice only",
    }  # fmt: skip
    page, found = opened("#ell=2.5&theta=1.3"), set()
    for ell in (0.2, 0.6, 0.75, 1.2, 2.5):
        for theta in np.linspace(0.15, 1.5, 7):
            page.evaluate("([ell, theta]) => window.spincyl.set({ ell, theta })", [ell, float(theta)])
            settled(page)
            region = sc.Region(int(sc.Body.solid(ell).region(float(theta))))
            assert page.locator("#what").inner_text().startswith(words[region]), (ell, theta)
            found.add(region)
    assert len(found) >= 4


def test_an_address_with_nonsense_is_taken_as_far_as_it_makes_sense(opened):
    page = opened("#ell=1e9&theta=x&bore=-3&contact=glue&w=1,2&colour=red&kick=0.1")
    told = state(page)
    assert (told["ell"], told["theta"], told["bore"], told["contact"], told["w"], told["kick"]) == (
        8,
        1.3,
        0,
        "rolling",
        None,
        0.1,
    )
    assert page.complaints == []
    # the page follows an address that is changed by hand
    page.evaluate("location.hash = '#ell=0.5&theta=0.3&contact=smooth'")
    page.wait_for_function("() => window.spincyl.state().ell === 0.5")
    assert state(page)["contact"] == "smooth" and state(page)["kick"] == 0


@pytest.mark.parametrize("name", few(OF_EVERY_OBJECT, 2))
def test_an_address_may_name_what_every_object_of_javascript_has(opened, name):
    page = opened(f"#ell=1.5&{name}=1&theta=1.1&contact={name}&law={name}")
    told = state(page)
    assert (told["ell"], told["theta"], told["contact"], told["law"]) == (1.5, 1.1, "rolling", "none")
    assert page.complaints == [] and f"{name}=1" in page.locator("body").inner_text()
    page.evaluate("name => { location.hash = `#ell=0.5&${name}=2,3`; }", name)
    page.wait_for_function("() => window.spincyl.state().ell === 0.5")
    # keys and calls from outside have no effect either
    page.evaluate("name => window.dispatchEvent(new KeyboardEvent('keydown', { key: name }))", name)
    page.evaluate("name => window.spincyl.set({ [name]: 1, ell: 0.7 })", name)
    page.wait_for_function("() => window.spincyl.state().ell === 0.7")
    assert page.complaints == []


def test_the_page_of_a_measured_body_tells_hertz_seconds_and_joules(opened):
    tube = sc.measured(outer_diameter=0.05, inner_diameter=0.04, length=0.15, mass=0.1)
    law = sc.loss.DryContour.from_si("8um", scale=tube)
    page = opened(page=sc.play(tube, 1.4, kick=0.1, losses=law, t=3.0))
    turns = float(tube.hertz(1.4))
    assert f"It turns {turns:.2f} times a second." in page.locator("#because").inner_text()
    rate = f"rate {tube.rate(1.4):.3f} ({turns:.2f} Hz)"
    assert rate in details(page) and "R = 25.0 mm" in details(page)
    assert f"{turns:.2f} Hz" in page.locator("#knob-rate + output, label:has(#knob-rate) output").inner_text()
    m = sc.roll(tube, tube.steady(1.4).kicked(0.1), 3.0, losses=law)
    lost = float(re.search(r"([\d.e-]+) J", details(page).replace("\u2011", "-")).group(1))
    assert lost == pytest.approx(m.work_lost[-1], rel=5e-3)
    page.evaluate("window.spincyl.set({ law: 'none' })")
    settled(page)
    period = float(re.search(r"once in ([\d.]+) ms", details(page)).group(1))
    assert period / 1e3 == pytest.approx(sc.swing(tube, tube.steady(1.4).kicked(0.1)).period, abs=6e-4)
    page.evaluate("window.spincyl.set({ precession: 2.0 })")
    settled(page)
    assert f"goes round {tube.scale.turns(2.0):.2f} times a second" in details(page)
    # a copy of the address opens the same state, and a body without a size says so
    page.wait_for_function("() => location.hash.includes('radius=0.025&mass=0.1')")
    unknown = opened("#ell=3&theta=1.4")
    assert "R = 1 cm" in details(unknown) and "Hz" not in details(unknown)


def test_an_address_that_names_a_body_opens_the_same_on_every_page(opened):
    page = opened("#ell=2.5&theta=1.2", page=sc.play(PIPE, 1.4, kick=0.2, contact="smooth"))
    told = state(page)
    assert (told["bore"], told["kick"], told["contact"]) == (0, 0, "rolling")
    page = opened("#theta=1.2", page=sc.play(PIPE, 1.4, kick=0.2))
    assert state(page)["bore"] == 0.8 and state(page)["theta"] == 1.2


@pytest.mark.parametrize("shows", ["body", "map", "chart"])
def test_a_figure_shows_its_part_of_the_page_whole_and_keeps_it_when_an_address_sets_it(opened, shows):
    parts = {"body": {"canvas"}, "map": {"canvas", "map"}, "chart": {"canvas", "chart"}}
    page = opened(f"#figure={shows}&ell=2.5&theta=1.3", viewport={"width": 736, "height": 464})
    page.evaluate("location.hash = '#ell=0.375&theta=1.4&contact=smooth'")
    page.wait_for_function("() => window.spincyl.state().contact === 'smooth'")
    page.wait_for_function("f => location.hash.startsWith(`#figure=${f}&ell=0.375`)", arg=shows)
    for size in ((736, 464), (358, 528)):
        page.set_viewport_size({"width": size[0], "height": size[1]})
        settled(page)
        for name in ("canvas", "map", "chart"):
            box = page.locator(f"#{name}").bounding_box() if name in parts[shows] else None
            assert page.locator(f"#{name}").is_visible() == (name in parts[shows])
            if box:
                assert box["width"] > 200 and box["height"] > 120 and box["y"] + box["height"] < size[1]
        assert not page.locator("header").is_visible() and not page.locator("#knobs").is_visible()
        assert page.evaluate("document.documentElement.scrollHeight <= innerHeight")
    assert page.complaints == []


def test_an_address_opens_the_shutter_or_pauses_at_a_time(opened):
    page = opened("#ell=6&bore=0.8&theta=1.562&expose=1", viewport=PHONE)
    assert page.locator("#shutter").input_value() == "1"
    page.evaluate("location.hash = '#ell=2.5&theta=1.3&kick=0.1&t=3'")
    page.wait_for_function("() => Math.abs(window.spincyl.at() - 3) < 1e-9")
    assert page.locator("#shutter").input_value() == "0"
    page.wait_for_function("() => location.hash === '#ell=2.5&theta=1.3&kick=0.1'")


def test_on_a_wet_table_a_tippe_top_turns_over_as_the_library_says_and_on_a_dry_one_it_stays_down(opened):
    page = opened()
    page.select_option("#preset", "a tippe top turns over on a wet table")
    settled(page)
    told = dict(scenes())["a tippe top turns over on a wet table"]
    t = np.linspace(0, 150, 31)
    for contact in (sc.Viscous(told["c"]), sc.Coulomb(0.3)):
        head = ask(page, "head()")
        seen = [page.evaluate("t => window.spincyl.pose(t).theta", float(x)) for x in t]
        m = sc.roll(body_of(told).natural, state_of(told), t, contact=contact)
        assert np.abs(seen - m.theta).max() <= head["error"] + m.error < 1e-5
        assert (m.theta.max() > 2) == isinstance(contact, sc.Viscous)
        page.locator("#map").focus()
        page.keyboard.press("c")
        settled(page)
    page.keyboard.press("v")
    settled(page)
    assert page.locator("#knob-c").is_visible() and not page.locator("#knob-mu").is_visible()
    page.locator("#knob-c").evaluate("e => { e.value = 0.5; e.dispatchEvent(new Event('input')); }")
    settled(page)
    assert state(page)["c"] == 0.5 and "never rolls" in page.locator("#because").inner_text()
    page.wait_for_function("() => location.hash.includes('contact=viscous&c=0.5')")


def axes(page):
    """The upper end of each track's axis that begins at 0, whether curves are cut, and the largest value."""
    settled(page)
    page.wait_for_timeout(400)
    rows = np.array(page.evaluate("() => window.spincyl.tracked()"))
    found = {x["name"]: (x["most"], x["cut"]) for x in ask(page, "tracks()")}
    return {name: (*found[name], np.nanmax(rows[:, k])) for name, k in (("N", 9), ("μ", 10))}


def test_the_axes_hold_the_friction_of_a_slip_and_the_peaks_on_ice_and_tell_what_they_cut(opened):
    page = opened()
    page.select_option("#preset", "a tippe top turns over on a wet table")
    page.locator("#map").focus()
    page.keyboard.press("c")
    most, cut, greatest = axes(page)["μ"]
    assert greatest == pytest.approx(0.3, abs=1e-6) and 0.294 < most <= 0.5 and not cut
    address(page, "#ell=0.375&theta=1.396263&kick=-0.01&contact=smooth")
    most, cut, greatest = axes(page)["N"]
    assert greatest > 3 and 0.98 * greatest <= most < 2 * greatest and not cut
    address(page, "#ell=1&theta=0.3&w=0.001,0,0,0,0")
    most, cut, greatest = axes(page)["N"]
    assert greatest > 30 and most < 10 and cut
    address(page, "#ell=2.5&theta=1.3")
    assert axes(page)["N"][:2] == (1, False)


def test_the_axes_stand_still_while_a_hand_drags_and_fit_when_it_rests(opened):
    page = opened("#ell=2.5&theta=1.3&kick=0.2")
    drag = """([from, to]) => Array.from({ length: 40 }, (_, k) => {
      const slider = document.getElementById("knob-kick");
      slider.value = from + (to - from) * k / 39;
      slider.dispatchEvent(new Event("input"));
      window.spincyl.solve();
      return window.spincyl.tracks().map(track => track.most);
    })"""
    seen = page.evaluate(drag, [0.2, 0.01])
    for limits in np.transpose(seen):
        changes = np.count_nonzero(np.diff(limits))
        assert changes <= 3 and (np.diff(limits) <= 0).all(), limits
    for most, cut, greatest in axes(page).values():
        assert not cut and 0.98 * greatest <= most and (most < 2 * greatest or most == 0.05)


def test_in_a_notebook_it_runs_in_its_frame_and_asks_and_hears_and_tells(chromium, tmp_path):
    path = tmp_path / "notebook.html"
    path.write_text(
        "<meta charset=utf-8><body><script>window.told = [];"
        "addEventListener('message', e => window.told.push(e.data.spincyl));</script>"
        + sc.play()._repr_html_()
    )
    page = chromium.new_page(reduced_motion="reduce", viewport=LAPTOP)
    page.set_default_timeout(chromium.patience)
    page.goto(path.as_uri())
    page.wait_for_function("() => window.told.length === 1 && window.told[0] === null")
    page.evaluate(
        "document.querySelector('iframe').contentWindow.postMessage({ spincyl: { ell: 2.5, theta: 1.1, kick: 0.2 } }, '*')"
    )
    inner = page.frames[1]
    inner.wait_for_function(
        "() => window.spincyl.state().theta === 1.1 && window.spincyl.state().kick === 0.2"
    )
    assert ask(inner, "state()")["bore"] == 0, "what is not said is as it is where nothing is set"
    inner.evaluate("window.spincyl.set({ kick: 0.3 })")
    page.wait_for_function("() => window.told.length === 2 && window.told[1].kick === 0.3")
    page.close()
