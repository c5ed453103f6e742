"""The display of bodies, states and motions: text that Python can evaluate, and cards in a notebook."""

import copy
import dataclasses
import html
import pickle
import re
import xml.etree.ElementTree as ET

import dask
import dask.array as da
import numpy as np
import pandas as pd
import pytest
import xarray as xr

import spincyl as sc

PVC = {"outer_diameter": 15.875e-3, "inner_diameter": 12.7e-3, "length": 95.25e-3}
ELL = np.linspace(0.1, 3, 300)
NAMES = {"Body": sc.Body, "State": sc.State, "Scale": sc.Scale, "nan": np.nan}


@pytest.mark.parametrize(
    ("value", "typed"),
    [
        (sc.Body.solid(2.5), "Body.solid(2.5)"),
        (sc.Body.tube(2.5, bore=0.0), "Body.solid(2.5)"),
        (sc.Body.tube(6.0, bore=0.8), "Body.tube(6.0, bore=0.8)"),
        (sc.Body.solid(np.float64(0.1)), "Body.solid(0.1)"),
        (sc.Body(1.2, 0.7, 0.5), "Body(ell=1.2, i1=0.7, i3=0.5)"),
        (sc.Body.from_metres(**PVC), "Body.from_metres(outer_diameter=0.015875, inner_diameter=0.0127, length=0.09525)"),
        (sc.Body.solid([0.5, 2.5]), "Body.solid([0.5, 2.5])"),
        (sc.Body.solid([0.5, np.nan]), "Body.solid([0.5, nan])"),
        (sc.State(np.float64(1.3), np.float32(0.5), 0, 1.5), "State(theta=1.3, w1=0.5, w2=0.0, w3=1.5)"),
        (sc.Scale(np.float64(0.02)), "Scale(radius=0.02, mass=1.0, gravity=9.80665)"),
    ],
)  # fmt: skip
def test_what_was_typed_is_shown_and_gives_the_same_back(value, typed):
    assert repr(value) == typed and eval(typed, NAMES) == value
    for other in (copy.deepcopy(value), pickle.loads(pickle.dumps(value))):
        assert repr(other) == typed and other == value


def test_measures_in_metres_are_shown_and_make_no_other_body():
    body = sc.Body.from_metres(**PVC)
    plain = sc.Body.tube(body.ell, body.bore)
    assert body == plain and hash(body) == hash(plain) and repr(plain).startswith("Body.tube(6.0, bore=0.7")
    assert repr(dataclasses.replace(body)) == repr(plain)
    assert sc.Body.from_metres(outer_diameter=1.0, length=2.5) == sc.Body.solid(2.5)


@pytest.mark.parametrize(
    "family",
    [
        sc.Body.solid(ELL),
        sc.Body.tube(ELL[:, None], np.linspace(0, 1, 20)),
        sc.Body(ELL, ELL**2 + 1, 0.5),
        sc.Body.solid(ELL).steady(1.3),
        sc.Body.solid(pd.Series(ELL)),
        sc.Body.solid(xr.DataArray(ELL, dims="ell")),
        sc.Body.tube(1.0, pd.DataFrame({"a": ELL / 3, "b": ELL / 4})),
        sc.State(1.3, np.broadcast_to(1.3, 2**40), 0.0, 0.0),
    ],
)
def test_a_family_is_shown_by_its_ends_and_its_shape(family):
    shown = repr(family)
    assert len(shown.splitlines()) <= 4 and len(shown) < 500 and ", ..., " in shown
    fields = [value for name, value in vars(family).items() if f"{name}=" in shown or name == "ell"]
    shapes = {np.shape(value) for value in fields} - {()}
    assert shapes and all(f"shape={shape}" in shown for shape in shapes)


def test_the_ends_of_a_family_are_those_numbers():
    assert (
        repr(sc.Body.solid(np.arange(10)))
        == "Body.solid(array([0.0, 1.0, 2.0, ..., 7.0, 8.0, 9.0], shape=(10,)))"
    )
    masked = np.ma.masked_array(ELL, ELL < 0.105)
    assert repr(sc.Body.solid(masked)).startswith("Body.solid(MaskedArray([--, 0.109699, 0.119398, ..., ")


def test_a_family_of_tubes_and_other_bodies_is_not_called_tubes():
    mixed = sc.Body([1.0, 1.0], [0.5, 0.25 + 1 / 3], [0.5, 0.5], [np.nan, 0.0])
    assert repr(mixed).startswith("Body(ell=[1.0, 1.0], i1=[0.5, ") and "bore=[nan, 0.0]" in repr(mixed)


def test_what_is_lazy_stays_so():
    def never(*_, **__):
        raise AssertionError("computed")

    with dask.config.set(scheduler=never):
        lazy = sc.Body.solid(da.from_array(ELL, chunks=100))
        assert repr(lazy) == "Body.solid(<lazy Array, shape=(300,)>)"
        assert "<lazy DataArray" in repr(
            sc.Body.solid(xr.DataArray(ELL, dims="ell").chunk(ell=50)).steady(1.3)
        )


# cards in a notebook

CYLINDER, PIPE = sc.Body.solid(2.5), sc.Body.tube(6.0, bore=0.8)
CAN = sc.Body.solid(1.5, fillet=0.3)
STATE = CYLINDER.steady(1.3)
CARDS = {
    "body": PIPE,
    "state": STATE,
    "motion": sc.roll(CYLINDER, STATE.kicked(0.2), np.linspace(0, 20, 201)),
    "fallen": sc.roll(sc.Body.solid(1.0), sc.State(0.3, 0.0, 0.0, 0.0), 5.0),
    "swing": sc.swing(CYLINDER, STATE.kicked(0.2)),
    "comparison": sc.data.compare(CYLINDER, np.radians([5, 10, 15, 70, 80]), [1.40, 0.88, 0.56, 1.70, 1.19]),
    "scale": sc.Scale(7.9375e-3, mass=0.02),
    "family": sc.Body.solid(ELL),
    "states": sc.Body.solid(ELL).steady(1.3),
    "lazy": sc.Body.solid(da.from_array(ELL)),
    "endless": sc.swing(sc.Body.solid(1.0), sc.State(0.3, 0.0, 0.0, 0.0)),
    "upside down": sc.State(2.0, 0.1, 0.0, 0.1),
    "flat": sc.Body.solid(0.0),
    "needle": sc.Body.solid(1e150),
    "nowhere": sc.State(np.nan, 0.1, 0.0, 0.1),
    "rounded": CAN,
    "rounded tube": sc.Body.tube(3.0, 0.7, fillet=0.15),
    "capsule": sc.Body.solid(2.5, fillet=1.0),
    "Hurricane balls": sc.Body.balls(),
    "balls on a rod": sc.Body.balls(1.5),
    "tippe top": sc.Body.ball(-0.3, 0.45, 0.42),
    "with a stem": sc.Body(-0.2, 0.45, 0.42, fillet=1.0, theta_end=2.0),
    "rounded motion": sc.roll(CAN, CAN.steady(1.3).kicked(0.2), np.linspace(0, 20, 201)),
    "whirl of balls": sc.roll(sc.Body.balls(), sc.Body.balls().steady(1.3).kicked(0.1), np.linspace(0, 9, 91)),
    "rounded family": sc.Body.solid(ELL + 0.1, fillet=0.1),
}  # fmt: skip


def card(value):
    """The card as an XML tree, which shows that its text cannot be anything else."""
    return ET.fromstring(value._repr_html_())


def rows(value):
    return {name.text: told.text for name, told in card(value).iter("tr")}


def outlines(value):
    """Corners of the outlines in the drawing, relative to the contact, in pixels with y upwards."""
    svg = next(card(value).iter("{http://www.w3.org/2000/svg}svg"))
    dot = next(x for x in svg if x.tag.endswith("circle"))
    contact = complex(float(dot.get("cx")), float(dot.get("cy")))
    found = [x.get("d") for x in svg if x.tag.endswith("path") and x.get("d").count("L") >= 4]
    return [
        np.array([complex(*map(float, p.split(","))) - contact for p in d[1:].split(" L")]).conj()
        for d in found
    ]


@pytest.mark.parametrize("value", CARDS.values(), ids=CARDS)
def test_a_card_is_small_plain_and_takes_the_colour_of_its_text(value):
    shown = value._repr_html_()
    assert len(shown) < 4000
    assert not {x.tag for x in card(value).iter()} & {"script", "iframe", "style", "link", "img"}
    assert not [x for x in card(value).iter() for name in x.attrib if name.startswith("on") or name == "href"]
    assert "#" not in shown and "rgb" not in shown
    assert rows(value) and "nan" not in " ".join(rows(value).values())


def test_the_drawing_is_the_silhouette_at_the_inclination():
    theta = float(PIPE.theta_balance)
    (shape,) = outlines(PIPE)
    across, along = shape[1] - shape[0], shape[3] - shape[0]
    assert abs(along) / abs(across) == pytest.approx(6.0, rel=0.02)
    assert np.angle(1j / along) == pytest.approx(theta, abs=0.01)  # from the vertical to the axis, clockwise
    assert np.angle(across / along) == pytest.approx(np.pi / 2, abs=0.02)
    # the plane of a rim is inclined by theta from the table
    (rim,) = outlines(STATE)
    assert np.angle(-1 / rim[1]) == pytest.approx(1.3, abs=0.01)


@pytest.mark.parametrize(
    "name", ["body", "state", "motion", "fallen", "swing", "comparison", "flat", "needle"]
)
def test_what_is_drawn_stands_on_the_table(name):
    for shape in outlines(CARDS[name]):
        assert shape.imag.min() >= -0.11 and np.abs(shape).min() <= 0.11 and np.abs(shape).max() < 200


@pytest.mark.parametrize(
    ("name", "long"), [("rounded", 1.5), ("capsule", 2.5), ("Hurricane balls", 2.0), ("tippe top", 1.0)]
)
def test_the_drawing_of_a_round_body_is_round_and_as_long_as_it_is(name, long):
    (shape,) = outlines(CARDS[name])
    theta = CARDS[name].theta_balance if name == "rounded" else np.radians(60)
    turned = shape / np.exp(1j * (np.pi / 2 - theta))  # with the axis to the right
    size = np.ptp(turned.imag) / 2
    assert np.ptp(turned.real) / 2 / size == pytest.approx(long, rel=0.02)
    # successive edges turn by a few degrees, except where two balls touch or a face begins
    steps = np.diff(np.append(turned, turned[0]))
    steps = steps[np.abs(steps) > 0.5]
    assert np.median(np.abs(np.angle(steps[1:] / steps[:-1]))) < np.radians(13)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("rounded", "cylinder: I₁ > I₃"),
        ("capsule", "capsule; cylinder: I₁ > I₃"),
        ("Hurricane balls", "two balls; cylinder: I₁ > I₃"),
        ("tippe top", "ball; cylinder: I₁ > I₃"),
    ],
)
def test_a_card_says_the_fillet_and_what_the_body_is(name, said):
    body = CARDS[name]
    told = rows(body)
    assert told["shape"] == said and told["fillet"] == f"{body.fillet:.6g} R"
    assert told["centre above the rim circle ℓ"] == f"{body.ell:.6g} R" and "aspect ratio ℓ" not in told
    assert "fillet" in card(body)[0].text and "fillet" in rows(CARDS["rounded motion"])["body"]
    assert "fillet" not in rows(CYLINDER) and rows(CARDS["rounded family"])["fillet"] == "0.1 R"


@pytest.mark.parametrize(
    "name",
    ["rounded", "rounded tube", "capsule", "Hurricane balls", "tippe top", "with a stem", "rounded motion"],
)
def test_a_round_body_is_drawn_rolling_on_its_contact(name):
    for shape in outlines(CARDS[name]):
        assert shape.imag.min() >= -0.11 and np.abs(shape).max() < 200
        # corners lie on the circle: the middle of an edge (1/32 turn) is within 1 - cos(pi/32) of 60 pixels
        ends = np.append(shape, shape[0])
        edge = np.diff(ends)
        edge[edge == 0] = 1e-9
        share = np.clip((-ends[:-1] * edge.conj()).real / np.abs(edge) ** 2, 0, 1)
        assert np.abs(ends[:-1] + share * edge).min() < 60 * (1 - np.cos(np.pi / 32)) + 0.11


def test_a_motion_shows_where_it_starts_and_between_what_it_swings():
    m = CARDS["motion"]
    *reached, start = outlines(m)
    for shape, theta in zip((start, *reached), (m.start.theta, m.theta.min(), m.theta.max()), strict=True):
        assert np.angle(1j / (shape[3] - shape[0])) == pytest.approx(theta, abs=0.01)
    assert "the face landed" in rows(CARDS["fallen"])["ended"]


@pytest.mark.parametrize("name", ["family", "states", "lazy", "nowhere", "scale"])
def test_many_or_nothing_have_no_drawing(name):
    many = CARDS[name] if name != "states" else sc.State(ELL, ELL, 0.0, 1.0)
    assert "<svg" not in many._repr_html_()


def test_a_card_says_the_numbers():
    assert rows(PIPE)[
        "balanced at θ₀"
    ] == "9.462° (0.165149 rad)" and "bore, inner over outer radius" in rows(PIPE)
    assert rows(STATE)["contact circle"] == f"{STATE.contact_radius:.6g} R"
    assert rows(CARDS["family"])["aspect ratio ℓ"] == "0.1 to 3, shape (300,)"
    assert rows(CARDS["states"])["precession φ′"].endswith("shape (300,), 14 without")
    assert rows(CARDS["scale"])["time √(R/g)"] == "0.02845 s"
    assert rows(CARDS["comparison"])["I₁/I₃ that fits"].startswith("4.7")
    assert rows(CARDS["endless"])["precession φ in a period"] == "none"
    assert card(CARDS["lazy"])[0].text == "Body.solid(<lazy Array, shape=(300,)>)"


def test_a_browser_draws_in_the_colour_of_the_page(chromium):
    page = chromium.new_page()
    page.set_default_timeout(chromium.patience)
    page.set_content(f'<div style="color:rgb(1, 2, 3)">{PIPE._repr_html_()}</div>')
    stroke, fill = page.eval_on_selector(
        "svg",
        "s => [s, s.querySelector('text')].map(x => getComputedStyle(x)).map((x, i) => i ? x.fill : x.stroke)",
    )
    assert stroke == fill == "rgb(1, 2, 3)"
    page.close()


def test_the_card_of_a_motion_says_over_which_angles_it_nods_whatever_times_were_asked_for():
    tube = sc.Body.tube(6.0, bore=0.8)
    start = tube.steady(1.4).kicked(0.05)
    one, many = sc.roll(tube, start, 2.0), sc.roll(tube, start, np.linspace(0.0, 2.0, 5))
    found = sc.swing(tube, start)
    nods = f"{np.degrees(found.theta_min):.4g}° to {np.degrees(found.theta_max):.4g}°"
    for m in (one, many):
        told = dict(cells(m))
        assert told["nods between"] == nods
    then = dict(cells(one))["θ at this time"]
    assert then == f"{np.degrees(one.theta[0]):.4g}°"
    assert " to " in dict(cells(many))["θ at these times"]
    assert "nods between" not in dict(cells(sc.roll(tube, tube.steady(1.4), 2.0)))
    slips = sc.roll(tube, sc.State(1.4, 1.0, 0.0, 2.0, slip=(0.0, 1.0)), 2.0, contact=sc.Coulomb(0.3))
    assert "nods between" not in dict(cells(slips))


@pytest.mark.parametrize("theta", [1e-8, 0.3, np.pi / 2 - 1e-9, np.pi / 2, 3.0])
def test_every_motion_has_a_card_however_odd_its_start(theta):
    cards = 0
    for body in (sc.Body.solid(0.0), sc.Body.ball(-0.2, 0.5, 0.45), sc.Body.tube(6.0, bore=0.8)):
        for w in ((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (30.0, 0.0, 0.0), (1e-300, -1e-300, 0.0)):
            for contact in ("rolling", "smooth"):
                try:
                    motion = sc.roll(body, sc.State(theta, *w), [0.0, 1.0], contact=contact)
                except ValueError:  # an invalid body, or a start without a motion
                    continue
                assert cells(motion)
                cards += 1
    assert cards


def cells(thing):
    return re.findall(r"<td[^>]*>([^<]*)</td><td[^>]*>([^<]*)</td>", html.unescape(thing._repr_html_()))
