"""Bodies put together from parts, in Python: what a user types, what is drawn, what is refused."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

import spincyl as sc
from spincyl import parts
from spincyl.studio import shape

STEEL = 7800.0
TOP = (
    parts.ball(diameter="2mm", density=STEEL),
    parts.cylinder(outer_diameter="2mm", length="30mm", at="1mm", density=STEEL),
    parts.cylinder(outer_diameter="40mm", inner_diameter="2mm", length="4mm", at="12mm", density=STEEL),
)
BODIES = {
    "top": TOP,
    "two balls": [parts.ball(diameter=x, density=STEEL) for x in ("18mm", "14mm")],
    "cup": [
        parts.disk(outer_diameter="50mm", density=1.0),
        parts.wall(lower_diameter="50mm", upper_diameter="80mm", length="95mm", at=0.0, density=1.0),
    ],
    "paper cone": [parts.wall(lower_diameter=0.1, upper_diameter=0.0, length=0.09, density=0.08)],
    "half full": [
        parts.wall(lower_diameter=0.066, upper_diameter=0.066, length=0.115, mass="13g"),
        parts.cylinder(outer_diameter=0.0658, length=0.057, at=0.0, density=1000),
    ],
    "coin": [
        parts.cylinder(outer_diameter="25.75mm", length="2.2mm", fillet="0.2mm", mass="8.5g"),
        parts.ring(diameter="25mm", at="1.1mm", mass="0.5g"),
    ],
    "bowl": [parts.cap(diameter=0.2, height=0.1, density=700)],
    "dome on a stick": [
        parts.cone(lower_diameter=0.001, upper_diameter=0.004, length=0.03, density=700),
        parts.shell(diameter=0.06, height=0.02, upper=True, density=1.0, at=0.03),
        parts.point(mass=0.01, at=0.02),
    ],
}


def test_a_measured_tube_is_a_body_of_one_part():
    tube = sc.measured(outer_diameter=0.05, inner_diameter=0.04, length=0.15, mass=0.1)
    made = sc.assembled([parts.cylinder(outer_diameter=0.05, inner_diameter=0.04, length=0.15, mass=0.1)])
    assert made.scale == tube.scale and made.theta_end == np.pi / 2
    for name in ("ell", "i1", "i3", "fillet"):
        np.testing.assert_allclose(getattr(made, name), getattr(tube, name), rtol=1e-14)
    assert abs(made.critical_hertz - tube.critical_hertz) < 1e-13
    t = np.linspace(0, 1, 11)
    a, b = (sc.roll(x, x.steady(1.4).kicked(0.05), t) for x in (made, tube))
    assert np.abs(a.theta - b.theta).max() < 1e-11


def test_parts_stand_on_each_other_unless_they_say_where_they_are():
    stacked = sc.assembled(
        [parts.cylinder(outer_diameter=0.02, length=0.01, density=STEEL) for _ in range(3)]
    )
    whole = sc.assembled([parts.cylinder(outer_diameter=0.02, length=0.03, density=STEEL)])
    np.testing.assert_allclose(
        [stacked.ell, stacked.i1, stacked.i3], [whole.ell, whole.i1, whole.i3], rtol=1e-14
    )
    balls = sc.assembled(BODIES["two balls"])
    assert abs(np.cos(balls.theta_end) + 1 / 8) < 1e-15 and abs(balls.scale.mass - 0.035025) < 1e-6
    low = parts.cylinder(outer_diameter=0.02, length=0.01, at=0.05, density=STEEL)
    moved = sc.assembled([low, parts.ring(diameter=0.02, mass=1e-3, at=0.055)])
    assert abs(moved.ell - 0.5) < 1e-15, "where the origin is does not matter"


@pytest.mark.parametrize("make", [parts.cap, parts.shell])
def test_what_stands_on_a_low_cap_stands_on_its_upper_end(make):
    foot = make(diameter="40mm", height="8mm", mass=0.02)
    stem = {"outer_diameter": "40mm" if make is parts.shell else "6mm", "length": "30mm", "mass": 0.005}
    stands = sc.assembled([foot, parts.cylinder(**stem)])
    assert foot.top == 0.008 and stands == sc.assembled([foot, parts.cylinder(**stem, at="8mm")])


def test_a_part_that_would_stand_on_nothing_is_refused_with_what_to_do():
    rim = parts.cylinder(outer_diameter="60cm", inner_diameter="54cm", length="3cm", mass=1)
    hub = {"outer_diameter": "6cm", "length": "3cm", "mass": 1}
    told = r"^parts\[1\]: the cylinder fits into the hole of the cylinder before it .*give at="
    with pytest.raises(ValueError, match=told):
        sc.assembled([rim, parts.cylinder(**hub)])
    assert sc.assembled([rim, parts.cylinder(**hub, at=0)]).ell == pytest.approx(0.05, abs=1e-15)
    sleeve = parts.cylinder(outer_diameter="8cm", inner_diameter="7cm", length="2cm", mass=1)
    with pytest.raises(ValueError, match=r"^parts\[1\]: the cylinder fits around the cylinder before it"):
        sc.assembled([parts.cylinder(**hub), sleeve])
    with pytest.raises(ValueError, match=r"^parts\[1\]: the ball fits into the hole"):
        sc.assembled([rim, parts.ball(diameter="56cm", mass=1)])
    # on the hub, or on the rim beside it, a third part stands; so does what just fits, or is a point
    wheel = [rim, parts.cylinder(**hub, at=0)]
    for third in (
        parts.ball(diameter="3cm", mass=1),
        parts.ring(diameter="57cm", mass=1),
        parts.point(mass=1),
    ):
        assert sc.assembled([*wheel, third]) == sc.assembled([*wheel, replace(third, at=0.03)])
    assert sc.assembled([rim, parts.disk(outer_diameter="54cm", mass=1)]).ell > 0


def test_a_straight_cap_can_be_thrown_on_its_side_but_not_pressed_like_a_tube():
    floor = parts.disk(outer_diameter="16mm", density=1.0)
    wall = parts.wall(lower_diameter="16mm", upper_diameter="16mm", length="60mm", density=1.0)
    cap = sc.assembled([floor, wall])
    assert cap.theta_end == pytest.approx(np.pi / 2, abs=1e-15) and len(cap.circles) == 2
    with pytest.raises(
        ValueError, match="^theta_end = 1.57.*: expected pi/2, for a body that can lie on two rims"
    ):
        sc.pressed(cap, 0.005, np.radians(60), finger=0.3)
    state = sc.thrown(cap, 0.5, 0.0)
    assert state.theta == np.pi / 2 and state.slip[0] == 0
    assert state.slip[1] == pytest.approx(0.5 / np.sqrt(9.80665 * 0.008), rel=1e-14)
    lid = parts.disk(outer_diameter="16mm", density=1.0)
    assert sc.assembled([floor, wall, lid]).theta_end == np.pi / 2


@pytest.mark.parametrize("make", [parts.cap, parts.shell])
def test_a_dome_stands_on_its_edge_until_its_sphere_touches_there(make):
    for share in np.random.default_rng(3).uniform(0.01, 0.99, 300):
        dome = make(diameter=0.1, height=0.1 * share, upper=True, mass=0.1)
        assert abs(sc.assembled([dome]).theta_end - np.arccos(2 * share - 1)) < 1e-14


def test_a_ball_on_a_thin_disk_stands_on_the_disk():
    ball = parts.ball(diameter="35mm", mass=0.02)
    for foot in (parts.disk(outer_diameter="18mm", mass=0.01), parts.ring(diameter="18mm", mass=0.01, at=0)):
        body = sc.assembled([foot, replace(ball, at=0)])
        assert (body.fillet, body.scale.radius) == (0.0, 0.009)
        assert abs(body.theta_end - 2 * np.arctan(9 / 17.5)) < 1e-15


def test_the_halves_of_a_ball_are_a_ball():
    lower = parts.cap(diameter="40mm", height="20mm", density=7800)
    upper = parts.cap(diameter="40mm", height="20mm", upper=True, density=700)
    toy = sc.assembled([lower, upper])
    assert (toy.fillet, toy.theta_end, toy.scale.radius) == (1.0, np.pi, 0.02) and toy.ell < 0


@pytest.mark.parametrize("name", BODIES)
def test_a_body_of_parts_moves_and_is_drawn_as_what_it_is(name):
    body = sc.assembled(BODIES[name])
    theta = 0.5 * float(body.theta_end)
    try:
        start = body.steady(theta)
    except ValueError:
        start = sc.State(theta, 0.3, 0.0, 0.2)
    m = sc.roll(body, start, np.linspace(0.0, 0.05, 6), want="pose")
    assert m.t.size > 1
    drawn = shape.parts(body)
    assert len(drawn) >= 3 and {part.name for part in drawn} >= {"O", "X"}
    for part in drawn:
        assert (
            np.isfinite(part.vertices).all() and np.abs(np.linalg.norm(part.normals, axis=1) - 1).max() < 1e-9
        )
        corners = part.vertices[part.triangles]
        facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert (np.einsum("ij,ij->i", facing, part.normals[part.triangles[:, 0]]) > 0).mean() > 0.95, (
            part.name
        )
    # nothing is drawn below the rim at any inclination up to the landing
    outline = np.concatenate([p.vertices for p in drawn if p.name not in "OX"])
    across, up = np.hypot(outline[:, 0], outline[:, 1]), outline[:, 2]
    for lean in np.linspace(0.0, float(body.theta_end), 20):
        rim = (1 - body.fillet) * np.sin(lean) + body.ell * np.cos(lean) + body.fillet
        assert (across * np.sin(lean) - up * np.cos(lean)).max() <= rim + 1e-9
    assert "<!DOCTYPE html>" in sc.view(m).html
    again = pickle.loads(pickle.dumps(body))
    assert again == body and again._parts == body._parts
    assert body.natural._parts == body._parts and body.natural.scale is None


def test_the_mass_is_that_of_the_drawn_volume():
    body = sc.assembled(TOP)
    volume = np.pi * (4 / 3 * 1e-9 + 1e-6 * 0.030 + (4e-4 - 1e-6) * 0.004)
    np.testing.assert_allclose(body.scale.mass, STEEL * volume, rtol=1e-14)


def test_it_says_what_lands():
    m = sc.roll(sc.assembled(TOP), sc.State(0.3, 0.0, 0.1, 0.0), 1.0)
    assert m.status == sc.Ending.SIDE and "another part landed: the body lands on another part" in m.message


@pytest.mark.parametrize("body", [sc.Body.ball(-0.27, i1=0.57, i3=0.58), sc.Body(0.5, i1=0.5, i3=0.5)])
def test_a_stem_that_lands_is_another_part_and_no_rim_also_without_assembled_parts(body):
    body = replace(body, theta_end=np.radians(100.0 if body.fillet else 80.0))
    m = sc.roll(body, sc.State(1.2, 0.0, -0.9, 0.0), 10.0)
    assert m.status == sc.Ending.SIDE and "the body lands on another part" in m.message
    assert "rim" not in m.message and "edge" not in m.message


@pytest.mark.parametrize(
    ("why", "make"),
    [
        ("mass, density: give exactly one of them", lambda: parts.ball(diameter=0.01)),
        ("density: .* in kg/m\\^2 for a thin wall", lambda: parts.disk(outer_diameter=0.1, density="steel")),
        ("density: .* in kg/m for a ring", lambda: parts.ring(diameter=0.1, density="steel")),
        ("mass, density: give exactly one of them", lambda: parts.ball(diameter=0.01, mass=1, density=1)),
        ("expected a Part", lambda: sc.assembled([3])),
        ("diameter", lambda: parts.ball(diameter=[1, 2], mass=1)),
    ],
)
def test_a_part_of_the_wrong_kind_is_refused(why, make):
    with pytest.raises(TypeError, match=why):
        make()


@pytest.mark.parametrize(
    ("why", "given"),
    [
        ("parts", []),
        ("parts", [parts.point(mass=1.0)]),
        ("bores", [parts.cylinder(outer_diameter=0.01, inner_diameter=0.02, length=0.01, density=1)]),
        ("radii", [parts.cylinder(outer_diameter=-0.01, length=0.01, density=1)]),
        ("radius", [parts.ball(diameter=np.nan, density=1)]),
        ("density", [parts.ball(diameter=1.0, density=-1)]),
        ("mass", [parts.ball(diameter=1.0, mass=np.nan)]),
        ("ends", [parts.cap(diameter=0.02, height=0.03, density=1)]),
    ],
)
def test_a_part_that_none_can_be_is_refused_by_name(why, given):
    with pytest.raises(ValueError, match=f"^{why}"):
        sc.assembled(given)


def test_balls_and_stones_take_their_sizes_as_tubes_do():
    i = 0.4
    ball = sc.Body.ball(-0.2, i, i, diameter="30mm", mass="6g")
    assert ball.scale == sc.Scale(0.015, 0.006) and ball.natural == sc.Body.ball(-0.2, i, i)
    with pytest.raises(ValueError, match="mass = .*: give the diameter of the balls"):
        sc.Body.ball(-0.2, i, i, mass=1.0)
    with pytest.warns(UserWarning, match="ball"):
        sc.Body.ball(-0.2, i, i, diameter=30)
    stone = sc.Ellipsoid.rattleback(("8cm", "16mm", "14mm"), twist=0.03, mass="40g")
    other = sc.Ellipsoid.rattleback((0.08, 0.016, 0.014), twist=0.03).in_metres(0.04)
    assert stone == other and stone.scale == other.scale
    assert sc.Ellipsoid.rattleback(("8cm", "16mm", "14mm"), twist=0.03).scale.radius == 0.08
    with pytest.raises(ValueError, match=r"^semi_axes\[1\] = 16: expected a text with a unit"):
        sc.Ellipsoid.rattleback(("8cm", 16, 14), twist=0.03)


def test_a_state_of_a_stone_is_told_in_si():
    stone = sc.Ellipsoid.rattleback((0.08, 0.016, 0.014), twist=0.03, mass=0.04)
    second = stone.scale.seconds(1.0)
    state = sc.EllipsoidState.from_si((0, 0, 1), (0, 0, 5.0), slip=(0.1, 0.0), scale=stone)
    np.testing.assert_allclose(state.w[2], 5.0 * second, rtol=1e-15)
    np.testing.assert_allclose(state.slip[0], 0.1 * second / 0.08, rtol=1e-15)
    m = sc.roll(stone, sc.EllipsoidState.from_si((0, 0, 1), (0, 0, 5.0), scale=stone), 0.01)
    np.testing.assert_allclose(m.spin, 5.0, rtol=1e-9)
    with pytest.raises(TypeError, match="scale"):
        sc.EllipsoidState.from_si((0, 0, 1), (0, 0, 5.0), scale=3)


def test_the_command_line_takes_the_thickness_of_a_wall(capsys):
    from spincyl.cli import main

    words = ["steady", "--outer", "50mm", "--length", "150mm", "--theta", "85deg"]
    assert main([*words, "--wall", "5mm"]) == 0
    thick = capsys.readouterr().out
    assert main([*words, "--inner", "40mm"]) == 0
    assert capsys.readouterr().out == thick
    assert main([*words, "--inner", "40mm", "--wall", "5mm"]) == 2
    assert "give only one of --inner, --bore and --wall" in capsys.readouterr().err
    assert main([*words, "--wall", "30mm"]) == 2
    assert "--wall 0.03: expected 0 to 0.025 (metres)" in capsys.readouterr().err
