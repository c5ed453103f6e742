"""Bodies that fly, bounce and lie, as they are shown: knots, films, scenes, photographs, sound and figures."""

import json
import struct
import wave
from functools import cache

import matplotlib as mpl
import numpy as np
import pytest
from pages import between, clock, go, picture

import spincyl as sc
from spincyl.studio.aloft import aloft, goes_up
from spincyl.studio.film import reel
from spincyl.studio.frames import _Stage
from spincyl.studio.pages.recorded import edges
from spincyl.studio.poses import knots, packed, seen, span
from spincyl.studio.shadow import MANY, caster, lamps, shadows
from spincyl.studio.shape import lathe, profiles, rotations
from spincyl.studio.shown import shown as prepared

mpl.use("agg")
import matplotlib.pyplot as plt

TUBE, COIN, CAN = sc.Body.tube(6.0, bore=0.8), sc.Body.solid(0.08), sc.Body.solid(1.5)
ROUNDED, BALLS = sc.Body.solid(1.5, fillet=0.3), sc.Body.balls()
TABLE = sc.Coulomb(0.3)


def dropped(body, until, restitution, contact=TABLE, **how):
    return sc.roll(
        body, sc.dropped(body, **how), np.linspace(0, until, 300), contact=contact, restitution=restitution
    )


SCENES = {
    "hops": lambda: sc.roll(TUBE, sc.flicked(TUBE, w1=3.0, launch=3.0), 40.0, contact=TABLE, restitution=0.5),
    "rings down": lambda: dropped(COIN, 30.0, 0.5, height=2.0, theta=1.2, w3=3.0),
    "lies down": lambda: dropped(TUBE, 12.0, 0.3, height=0.5, theta=1.3, w3=2.0, w2=0.5),
    "on ice": lambda: dropped(TUBE, 12.0, 0.5, "smooth", height=0.5, theta=1.3, w3=2.0),
    "tossed": lambda: dropped(COIN, 12.0, 0.5, height=3.0, theta=1.2, w2=6.0, velocity=(0.0, 0.0, 2.0)),
    "tumbles": lambda: dropped(CAN, 20.0, 0.6, height=2.0, theta=1.2, w2=3.0, w1=1.0, w3=2.0, velocity=(1.0, 0.0, 1.0)),
    "rounded": lambda: dropped(ROUNDED, 20.0, 0.5, height=2.0, theta=1.2, w2=3.0, w1=1.0),
    "two balls": lambda: dropped(BALLS, 20.0, 0.5, height=2.0, theta=1.2, w3=3.0),
}  # fmt: skip


@cache
def motion_of(name):
    return SCENES[name]()


@pytest.fixture(autouse=True)
def closed_figures():
    yield
    plt.close("all")


def turned(theta, phi, psi):
    """The first and the third axis of a body with these angles."""
    (s, c), (sp, cp) = ((np.sin(x), np.cos(x)) for x in (theta, phi))
    e1, e2 = np.stack([c * cp, c * sp, s], -1), np.stack([-sp, cp, 0 * sp], -1)
    first = np.cos(psi)[:, None] * e1 + np.sin(psi)[:, None] * e2
    return first, np.stack([-s * cp, -s * sp, c], -1)


# knots


@pytest.mark.parametrize("name", SCENES)
def test_cubics_between_few_knots_meet_a_motion_through_flights_impacts_and_rests(name):
    m = motion_of(name)
    first, last = span(m)
    found = knots(m)
    assert goes_up(m) and found.shape[1] == 13 and len(found) < 260
    t = np.sort(np.random.default_rng(1).uniform(first, last, 2000))
    edges = aloft(m, first, last).edges
    t = t[~((edges[:, :1] < t) & (t < edges[:, 1:])).any(axis=0)]
    theta, phi, psi, *place = between(found, t).T
    centre, orientation = seen(m, t, "centre", "orientation")
    assert np.abs(np.stack(place, -1) - centre).max() < 3e-3
    matrix = rotations(orientation)
    for axis, drawn in zip((0, 2), turned(theta, phi, psi), strict=True):
        assert np.linalg.norm(matrix[:, :, axis] - drawn, axis=1).max() < 6e-3
    # the slopes keep their digits in the 16 bits that a page has for them
    assert max(packed(found)["most"]) < 10


def test_at_an_impact_the_velocity_of_the_centre_jumps_by_the_impulse():
    m = motion_of("rings down")
    found = knots(m)
    for impact in m.impacts[:5]:
        before, after = (np.searchsorted(found[:, 0], impact.time) + k for k in (-1, 0))
        assert found[after, 0] - found[before, 0] < 1e-7
        jump = (found[after] - found[before])[-3:]
        along, across, up = impact.impulse
        assert jump[2] == pytest.approx(up, abs=2e-3)
        assert np.hypot(*jump[:2]) == pytest.approx(np.hypot(along, across), abs=2e-3)


def test_a_coin_tossed_without_spin_turns_evenly_through_the_vertical():
    m = motion_of("tossed")
    found = knots(m)
    flight = found[found[:, 0] < m.impacts[0].time]
    assert len(flight) < 8 and np.allclose(flight[:, 7], -6.0, atol=1e-6)
    assert np.allclose(flight[:, 1], 1.2 - 6 * flight[:, 0], atol=1e-6), "theta goes on below zero"
    assert np.allclose(flight[:, 8:10], 0, atol=1e-6), "and the coin does not turn about"
    assert len(found) < 20 and np.allclose(found[:, 2:4], 0, atol=1e-6), "on whichever rim it lands"


def test_a_body_that_may_fly_and_stays_on_the_table_is_drawn_as_one_that_may_not():
    start = TUBE.steady(1.3).kicked(0.05)
    may, may_not = (sc.roll(TUBE, start, 20.0, contact=TABLE, **how) for how in ({"restitution": 0.5}, {}))
    assert not goes_up(may)
    assert sc.view(may).html == sc.view(may_not).html and "aloft" not in sc.view(may).html


# the page


def test_a_page_draws_flights_where_they_are_and_no_force_in_the_air(shown):
    names = ("hops", "lies down", "tumbles", "rounded")
    page = shown(sc.view(*map(motion_of, names)), "#t=3", viewport={"width": 160, "height": 120})
    for i, name in enumerate(names):
        m = motion_of(name)
        t = np.linspace(*span(m), 701)[1:]
        told = "([i, t]) => JSON.stringify(t.map(t => window.spincyl.pose(i, t)))"
        found = json.loads(page.evaluate(told, [i, t.tolist()]))
        there = m.wanting("pose", "force", t=t)
        matrix = np.array([pose["matrix"] for pose in found]).reshape(-1, 4, 4).transpose(0, 2, 1)
        assert np.abs(matrix[:, :3, 3] - there.centre).max() < 0.01, name
        assert np.abs(matrix[:, :3, :3] - rotations(there.orientation)).max() < 6e-3, name
        contact = np.array([pose["contact"] for pose in found])
        assert np.abs(contact[:, :2] - there.contact_point).max() < 0.01 and not contact[:, 2].any(), name
        assert np.abs(np.array([pose["theta"] for pose in found]) - there.theta).max() < 3e-3, "the same rim"
        assert np.abs(np.array([pose["height"] for pose in found]) - there.natural.height).max() < 0.01, name
        w = np.linalg.norm([pose["omega"] for pose in found], axis=1)
        assert np.abs(w - np.linalg.norm(there.w, axis=1)).max() < 0.1, name
        flies, lies = there.phase == 2, there.phase == 5
        for force in ("normal", "friction"):
            arrows = np.linalg.norm([pose[force] for pose in found], axis=1)
            assert not arrows[flies].any(), name
            assert np.median(np.abs(arrows - getattr(there, force))) < 0.01, name
        # friction points where it does, on either rim
        off = np.array([pose["friction"][:2] for pose in found]) - there.contact_force[:, :2]
        slips = there.phase == 1
        assert slips.sum() < 20 or np.percentile(np.abs(off)[slips], 80) < 0.02, name
        for rim in ("normal", "normal2"):
            arrows = np.array([pose[rim] for pose in found])[lies][1:]
            assert np.allclose(arrows, [0, 0, 0.5], atol=0.01), "each rim carries half of the weight"
    assert page.complaints == [] and len(page.requests) == 1


def test_the_clock_says_how_high_a_body_flies_and_the_line_has_a_gap(shown):
    scale = sc.Scale(radius=0.02)
    page = shown(sc.view(motion_of("rings down"), scale=scale), "#t=0")
    assert clock(page).endswith("flying 40.0 mm high")
    tips = page.locator(".tip")
    assert not any(tips.nth(k).is_visible() for k in range(tips.count())), "no force in the air"
    line = page.locator(".phases")
    told = line.get_attribute("title").replace("\xa0", " ")
    assert told.startswith("flying, 23 impacts, from t = 0.0000 s, slipping from t = 0.1955 s, rolling from")
    assert line.get_attribute("style").count("transparent") > 2
    go(page, 12.0)
    assert "slipping" in clock(page) and clock(page).endswith("mm/s")
    lying = shown(sc.view(motion_of("lies down")), "#t=8")
    assert clock(lying).endswith("rolling on its side")
    tips = lying.locator(".tip")
    assert [tips.nth(k).inner_text() for k in range(tips.count()) if tips.nth(k).is_visible()] == ["N", "N"]


def test_there_is_no_path_in_the_air(shown):
    page = shown(sc.view(motion_of("tumbles")), "#t=3")
    flown = picture(page)
    page.uncheck("#path")
    assert np.array_equal(picture(page), flown), "after three units of flight"
    page.check("#path")
    go(page, 18.0)
    rolled = picture(page)
    page.uncheck("#path")
    assert np.abs(picture(page) - rolled).max() > 0.1 and page.complaints == []


# films and scenes


@pytest.mark.parametrize("name", ["tumbles", "rounded", "lies down"])
def test_in_a_film_the_lowest_place_of_a_body_is_as_high_as_it_is(name):
    m = motion_of(name)
    times = np.linspace(*span(m), 60)
    panel = prepared(m, times, "O")
    places = np.concatenate([part.vertices for part in map(lathe, profiles(m.body))])
    bottom = [(places @ r.T + c)[:, 2].min() for r, c in zip(panel.rotation, panel.centre, strict=True)]
    assert np.allclose(bottom, m.wanting("pose", t=times).natural.height, atol=2e-3)
    flies = seen(m, panel.along, "phase")[0] == 2
    assert panel.gaps[flies].all() and panel.gaps[~flies].mean() < 0.05, "no path in the air"
    highest = max((places @ r.T + c)[:, 2].max() for r, c in zip(panel.rotation, panel.centre, strict=True))
    assert panel.middle[2] / 0.45 > highest - 0.1, "the camera has room for it"


def test_the_shadow_of_a_higher_body_is_farther_away_and_softer():
    m = motion_of("tossed")
    of, lamp = caster([lathe(profile) for profile in profiles(COIN)]), lamps(MANY)
    panel = prepared(m, np.array([0.0]), "O")
    places = []
    for high in (0.0, 3.0):
        thrown = shadows(of, panel.rotation[0], panel.centre[0] + [0, 0, high], lamp)
        places.append(np.array([np.concatenate(lines)[:, :2].mean(axis=0) for lines in thrown]))
    low, high = places
    assert np.allclose(high - low, 3 * lamp, atol=1e-9)
    assert np.ptp(high, axis=0).min() > 1.5 * np.ptp(low, axis=0).min()


def test_a_still_of_a_flight_has_paper_between_the_body_and_its_shadow(tmp_path):
    view = sc.view(motion_of("rings down"))
    what = reel(view, [edges(m) for m in view.motions], ".mp4", None, (320, 180), 600.0)
    times = np.array([0.5])
    picture = _Stage(what, times).picture(0).astype(int)
    colour = np.ptp(picture, axis=-1)
    column = picture[:, 150:190].sum(axis=-1)
    assert column[:60].min() < 400 and colour.max() > 20, "the coin is in the upper third"


def test_a_scene_falls_on_a_parabola_though_its_frames_are_joined_by_lines(tmp_path):
    m = motion_of("tossed")
    data = sc.view(m).save(tmp_path / "tossed.glb").read_bytes()
    (length,) = struct.unpack("<I", data[12:16])
    tree, binary = json.loads(data[20 : 20 + length]), data[28 + length :]

    def read(index, wide):
        view = tree["bufferViews"][tree["accessors"][index]["bufferView"]]
        begin = view["byteOffset"]
        return np.frombuffer(binary[begin : begin + view["byteLength"]], "<f4").reshape(-1, wide)

    sampler = tree["animations"][0]["samplers"][0]
    t, place = read(sampler["input"], 1)[:, 0], read(sampler["output"], 3)
    fine = np.linspace(0, 12, 2000)
    (centre,) = seen(m, fine, "centre")
    assert np.abs(np.interp(fine, t, place[:, 2]) - centre[:, 2]).max() < 2.5e-3
    assert len(t) < 400


def test_a_photograph_from_far_above_does_not_tell_how_high_a_body_flies():
    falls = (
        sc.roll(TUBE, sc.dropped(TUBE, h, 1.5, w3=2.0), 1.9, contact=TABLE, restitution=0.5)
        for h in (2.0, 9.0)
    )
    low, high = (sc.exposure(m, samples=1e5, size=60) for m in falls)
    assert low.max() > 0.05 and np.allclose(low, high, atol=1e-12)


# sound


def heard(m, path, **how):
    with wave.open(str(m.sound(path / "heard.wav", **how))) as file:
        found = np.frombuffer(file.readframes(file.getnframes()), "<i2") / 32767
        return np.arange(found.size) / file.getframerate(), found


def test_a_flight_is_silent_and_each_impact_is_as_loud_as_its_impulse(tmp_path):
    scale = sc.Scale(radius=0.1)
    m = motion_of("tossed")
    t, sound = heard(m, tmp_path, scale=scale, compression=1)
    loud = []
    for impact in m.impacts[:2]:
        at = scale.seconds(impact.time)
        assert np.abs(sound[(t > at - 0.02) & (t < at - 1e-4)]).max() < 0.02 * np.abs(sound).max()
        loud.append(np.abs(sound[(t >= at) & (t < at + 0.01)]).max())
    strength = [np.linalg.norm(impact.impulse) for impact in m.impacts[:2]]
    assert loud[0] / loud[1] == pytest.approx(strength[0] / strength[1], rel=0.05)
    assert not sound[t < scale.seconds(m.impacts[0].time) - 1e-4].any(), "nothing before the first impact"


def test_a_body_that_rolls_after_its_bounces_is_heard_as_before(tmp_path):
    t, sound = heard(motion_of("rings down"), tmp_path, scale=sc.Scale(radius=0.01), compression=1)
    rolls = np.abs(sound[(t > 0.3) & (t < 0.9)]).max()
    assert 0.05 < rolls < 0.5 < np.abs(sound[t < 0.1]).max()
    # a flight without an impact cannot be heard
    flight = sc.roll(COIN, sc.dropped(COIN, 2.0, 1.2, w3=3.0), 1.0, contact=TABLE, restitution=0.5)
    with pytest.raises(ValueError, match="there is nothing to hear"):
        flight.sound(tmp_path / "silence.wav", scale=sc.Scale(radius=0.1))


# figures


def test_a_figure_has_the_height_the_impacts_and_the_times_in_the_air_and_on_both_rims():
    m = motion_of("lies down")
    tilt, path, force = sc.plot.motion(m)
    (right,) = (ax for ax in tilt.figure.axes if ax not in (tilt, path, force))
    assert right.get_ylabel() == "height of its lowest point ($R$)"
    t, high = right.lines[0].get_data()
    assert np.allclose(high[::20], m.at(t[::20]).natural.height, atol=1e-9) and high.min() == 0
    assert np.allclose(right.lines[1].get_xdata(), [x.time for x in m.impacts])
    words = [text.get_text() for text in tilt.get_legend().get_texts()]
    assert words == ["in the air", "slips", "lies on both rims", "impact"]
    first, last = tilt.patches[0], tilt.patches[-1]
    assert (first.get_x(), first.get_x() + first.get_width()) == pytest.approx((0, m.phases[14].time))
    assert last.get_x() + last.get_width() == pytest.approx(12.0)
    labels = [line.get_label() for line in path.lines]
    assert labels[:4] == ["contact slips", "contact rolls", "centre, from above", "impact"]
    assert [line.get_label() for line in force.lines][:3] == [
        "normal force $N$",
        "friction",
        "$N$, other rim",
    ]
    assert np.nanmax(force.lines[2].get_ydata()[-100:]) == pytest.approx(0.5)


def test_where_another_rim_takes_over_the_curves_have_gaps_and_no_leaps():
    m = motion_of("tumbles")
    tilt, path, _ = sc.plot.motion(m)
    _, drawn = tilt.lines[0].get_data()
    assert np.isnan(drawn).sum() > 3
    assert np.nanmax(np.abs(np.diff(drawn))) < 3, "degrees from point to point"
    for line in path.lines[:2]:
        x, y = line.get_data()
        assert not np.nanmax(np.hypot(np.diff(x), np.diff(y)), initial=0) > 0.5
    measured = sc.measured(outer_diameter="20mm", length="30mm", mass="40g")
    start = sc.dropped(measured, "20mm", 1.2, w2=100.0, w1=30.0)
    tilt, path, _ = sc.plot.motion(sc.roll(measured, start, 0.5, contact=TABLE, restitution=0.5))
    right = tilt.figure.axes[-1]
    assert right.get_ylabel() == "height of its lowest point (mm)"
    assert right.lines[0].get_ydata()[0] == pytest.approx(20)


def test_a_map_of_flicks_hatches_those_that_hop_before():
    tube = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm")
    rates, numbers = [8.0, 17.0, 25.0], [1.3, 2.0, 2.9]
    found = sc.sweep.flicks(tube, 5.7, hertz=rates, launch=numbers, contact=TABLE, restitution=0.5)
    outcome, ends = found["outcome"].values.T, sc.sweep.Outcome
    ax = sc.plot.flicks(found)
    (hatched,) = (mesh for mesh in ax.collections if mesh.get_hatch())
    hops = np.isin(outcome, (ends.HOPS_AND_SETTLES, ends.HOPS_AND_LIES))
    assert 0 < hops.sum() < hops.size and len(hatched.get_paths()) == hops.sum()
    assert ax.get_legend().get_texts()[-1].get_text() == "hops before"
    for kind, words in (
        (ends.HOPS_AND_LIES, ["lies down", "hops before"]),
        (ends.LIFTS_OFF, ["in the air at the end"]),
    ):
        other = sc.plot.flicks(found.assign(outcome=0 * found["outcome"] + int(kind)))
        assert [text.get_text() for text in other.get_legend().get_texts()] == words
