"""One way to a size, for every kind of body."""

import math
import warnings

import numpy as np
import pytest

import spincyl as sc

PVC = {"outer_diameter": 15.875e-3, "inner_diameter": 12.7e-3, "length": 95.25e-3}
TUBE = sc.measured(**PVC, mass=20e-3)
STEEL = sc.parts.cylinder(outer_diameter="40mm", length="5mm", density=7800)
KINDS = {
    "tube": lambda: sc.Body.from_metres(**PVC).in_metres("20g"),
    "measured tube": lambda: sc.measured(**PVC, mass="20g", gravity=9.80665),
    "ball": lambda: sc.Body.ball(-0.3, 0.4, 0.38).in_metres("20g", radius="15mm"),
    "balls": lambda: sc.Body.balls(diameter="12mm", mass="14g"),
    "body of moments": lambda: sc.Body(1.2, 0.9, 0.7).in_metres(0.014, radius=6e-3),
    "parts": lambda: sc.assembled([STEEL]),
    "rattleback": lambda: sc.Ellipsoid.rattleback(("8cm", "16mm", "14mm"), twist=0.1, mass="30g"),
    "egg": lambda: sc.Ellipsoid.egg("22mm", "28.5mm", mass="60g"),
    "pebble": lambda: sc.Ellipsoid.uniform((0.03, 0.02, 0.01)).in_metres("15g"),
}


def spun(body):
    """A state of a body of either kind, which slips and rocks."""
    if isinstance(body, sc.Ellipsoid):
        return body.with_centre_velocity(body.spinning(-1.0, pitch=0.1), 0.02, 0.01)
    return sc.State(1.2, 0.5, 0.1, 3.0, slip=(0.02, 0.01))


@pytest.mark.parametrize("kind", KINDS)
def test_bodies_of_every_kind_are_asked_and_told_in_si_by_the_same_names(kind):
    body = KINDS[kind]()
    scale, state = body.scale, spun(body)
    second, newton = scale.seconds(1.0), scale.newtons(1.0)
    assert body.natural.scale is None and body.natural.natural is body.natural and body.in_metres() == body
    told = state.in_si(body)
    again = type(state).from_si(**told, scale=body)
    assert all(np.allclose(again.in_si(body)[name], told[name], rtol=1e-14, atol=0) for name in told)
    assert np.allclose(again.slip, state.slip, rtol=1e-14, atol=0)
    turning = state.spin if isinstance(body, sc.Ellipsoid) else state.precession
    assert body.hertz(state) == pytest.approx(turning / second / (2 * math.pi))
    table = sc.Coulomb(0.3)
    m = sc.roll(body, state, 50e-3, contact=table, want="force")
    plain = sc.roll(body.natural, state, 50e-3 / second, contact=table, want="force")
    assert m.normal[-1] == pytest.approx(plain.normal[-1] * newton) and m.natural.scale is None
    assert m.to_dataframe().attrs["units"]["energy"] == "J"
    found = sc.sweep.roll(body, state, "50ms", contact=table, want="dissipated")
    assert found["dissipated"].attrs["units"] == "J" and found.attrs["mass"] == scale.mass


@pytest.mark.parametrize("kind", KINDS)
def test_a_body_that_is_measured_anew_keeps_what_is_not_given(kind):
    body = KINDS[kind]()
    moon = body.in_metres(gravity=1.62)
    assert moon.scale == sc.Scale(body.scale.radius, body.scale.mass, 1.62)
    heavy = moon.in_metres(2 * body.scale.mass)
    assert heavy.scale == sc.Scale(body.scale.radius, 2 * body.scale.mass, 1.62)
    large = body.in_metres(radius=1.1 * body.scale.radius)
    assert large.scale == sc.Scale(1.1 * body.scale.radius, body.scale.mass)
    assert large.natural == body.natural and getattr(large, "_parts", ()) == getattr(body, "_parts", ())
    with pytest.warns(UserWarning, match=" wide; 1 mm is 1e-3: are these metres"):
        body.in_metres(radius=15.0)
    for name, wrong in (("mass", math.nan), ("mass", 0.0), ("radius", -1.0), ("gravity", 0.0)):
        with pytest.raises(ValueError, match=f"^{name} = "):
            body.in_metres(**{name: wrong})
    with pytest.raises(TypeError, match="^radius: expected real numbers, or a text with a unit"):
        body.in_metres(radius="15")


def test_a_size_that_nobody_gave_is_asked_for():
    for body in (sc.Body.balls(), TUBE.natural, sc.Body.solid([1.0, 2.0])):
        with pytest.raises(TypeError, match="^radius: expected the outer radius in metres"):
            body.in_metres("20g")
    assert sc.Body.from_metres(**PVC).in_metres("20g") == sc.measured(**PVC, mass="20g")
    assert repr(sc.Body.from_metres(**PVC).in_metres("20g")) == repr(TUBE)
    for mass, doubted in (("20g", False), ("2mg", True), ("2kg", True)):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            sc.Body.ball(0.0, 0.4, 0.4, diameter="30mm", mass=mass)
        assert [str(w.message)[:8] for w in caught] == ["the ball"] * doubted


def test_the_lengths_of_a_stone_may_be_texts_and_all_of_them_are():
    assert sc.Ellipsoid.egg("22mm", "28.5mm").scale.radius == 0.0285
    assert sc.Ellipsoid.uniform(("3cm", "2cm", "1cm"), mass="15g").scale == sc.Scale(0.03, 0.015)
    with pytest.raises(ValueError, match=r"^half_length = 28.5: expected a text with a unit"):
        sc.Ellipsoid.egg("22mm", 28.5)
    with pytest.raises(TypeError, match=r"^semi_axes\[1\]: expected real numbers"):
        sc.Ellipsoid.uniform(("3cm", "wide", "1cm"))
    stone = sc.Ellipsoid.egg("22mm", "28.5mm")
    texts = sc.EllipsoidState.from_si((0, 0, 1), ("1rad/s", 0, "3rad/s"), slip=("1cm/s", 0.0), scale=stone)
    assert texts == sc.EllipsoidState.from_si((0, 0, 1), (1, 0, 3), slip=(0.01, 0.0), scale=stone)


def test_an_unknown_keyword_names_the_function_that_has_it_not():
    coulomb = sc.Coulomb(0.3)
    for function, call in {
        "measured": lambda: sc.measured(**PVC, diameter=1.0),
        "Body.ball": lambda: sc.Body.ball(0.0, 0.4, 0.4, radius=0.015),
        "Body.balls": lambda: sc.Body.balls(separation=1.0, radius=1.0),
        "Sized.in_metres": lambda: TUBE.in_metres(diameter=1.0),
        "Ellipsoid.egg": lambda: sc.Ellipsoid.egg(1.0, 2.0, weight=1.0),
        "assembled": lambda: sc.assembled([STEEL], mass=1.0),
        "stability": lambda: TUBE.stability(1.3, nonsense=1),
        "rate": lambda: TUBE.rate(1.3, nonsense=1),
        "flicks": lambda: sc.sweep.flicks(TUBE, 1.0, hertz=9, launch=1.2, contact=coulomb, nonsense=1),
        "energy": lambda: sc.plot.energy(nonsense=1),
    }.items():
        with pytest.raises(TypeError, match=rf"^{function}\(\) got an unexpected keyword argument "):
            call()
