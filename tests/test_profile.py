"""Bodies of several circles: how they are made, what they tell of themselves, and what they are refused for."""

import dataclasses
import itertools
import pickle

import mpmath
import numpy as np
import pytest

import spincyl as sc

CUP = sc.Body.frustum(0.7, 1.0, 2.0)
BALLS = sc.Body.balls(radii=(1, 0.8))
BOTTLE = sc.Body.lathe([(1, 0), (1, 3), (0.35, 4.2), (0.35, 5)])
#: theta_k, D, radius of the centre's circle, rate and friction at which the narrow end rises; from another program
KNOWN = [
    (CUP, 1.4219063792, 2.0223748416, 5.719123, 0.3701987166, 0.7838),
    (sc.Body.cone(2.0), 1.1071487178, 2.2360679775, 1.341641, 0.7721947902, 0.8),
    (sc.Body.cone(0.5), 0.4636476090, 1.1180339887, 0.167705, 2.5170470668, 1.0625),
    (sc.Body.frustum(0.9, 1, 0.5), 1.3734007669, 0.5099019514, 4.666352, 0.2563876920, 0.3067),
    (BALLS, 1.6821373411, 1.7888543820, 8.338522, 0.2347141401, 0.4594),
]


def upside_down(body):
    """The body as told from its other end."""
    rows = body.circles[::-1] * [1.0, -1.0, 1.0]
    return sc.Body.profile(rows, body.i1, body.i3)


def moments(outline):
    """I1 and I3 about the centre of mass of a uniform solid, by integrals with 40 digits; R is the largest radius."""
    with mpmath.workdps(40):
        sums = [mpmath.mpf(0)] * 4
        for (r, low), (s, high) in itertools.pairwise(outline):
            r, s, low, high = map(mpmath.mpf, (r, s, low, high))

            def radius(z, r=r, s=s, low=low, high=high):
                return r + (s - r) * (z - low) / (high - low)

            if low == high:
                continue
            of = (
                lambda z, a=radius: a(z) ** 2,
                lambda z, a=radius: a(z) ** 2 * z,
                lambda z, a=radius: a(z) ** 4 / 2,
                lambda z, a=radius: a(z) ** 4 / 4 + a(z) ** 2 * z**2,
            )
            sums = [x + mpmath.quad(f, [low, high]) for x, f in zip(sums, of, strict=True)]
        m, first, axial, across = sums
        unit = max(mpmath.mpf(r) for r, _ in outline) ** 2
        return float((across / m - (first / m) ** 2) / unit), float(axial / m / unit)


@pytest.mark.parametrize(("body", "theta", "span", "radius", "rate", "friction"), KNOWN)
def test_a_body_of_two_circles_lies_and_rolls_round_its_apex_as_is_known_of_it(
    body, theta, span, radius, rate, friction
):
    assert body.borders == pytest.approx([theta], abs=6e-11) and body.theta_end == body.borders[0]
    assert body.spans == pytest.approx([span], abs=6e-11) and not body.smooth.any()
    apex = body.apex()
    assert apex.radius == pytest.approx(radius, abs=6e-7) and apex.rate == pytest.approx(rate, abs=6e-11)
    assert apex.friction == pytest.approx(friction, abs=6e-5)
    assert body.rests() == (0,)


def test_moments_of_outlines_are_those_of_integrals_with_forty_digits():
    rng = np.random.default_rng(5)
    for _ in range(20):
        r, s, height = (rng.uniform(0.2, 2) for _ in range(3))
        wall = rng.uniform(0, min(r, s))
        solid, hollow = [(r, 0), (s, height)], [(r, 0), (s, height), (s - wall, height), (r - wall, 0)]
        for body, outline in (
            (sc.Body.frustum(r, s, height), solid),
            (sc.Body.frustum(r, s, height, wall), hollow),
            (sc.Body.lathe(hollow), hollow),
        ):
            i1, i3 = moments(outline)
            assert body.i1 == pytest.approx(i1, rel=1e-13) and body.i3 == pytest.approx(i3, rel=1e-13)
    i1, i3 = moments([(0, 0), (1, 2)])
    assert sc.Body.cone(2.0).i1 == pytest.approx(i1, rel=1e-15) and i3 == pytest.approx(0.3, rel=1e-15)


def test_circles_are_told_from_the_lower_end_up_with_their_heights_above_the_centre_of_mass():
    assert BALLS.circles[:, 2].tolist() == [1.0, 0.8] and not BALLS.circles[:, 0].any()
    low, high = CUP.circles
    assert low[1] < 0 < high[1] and high[1] - low[1] == pytest.approx(2.0, rel=1e-15)
    assert (CUP.ell, CUP.fillet) == (-low[1], 0.0)
    assert sc.Body.solid(2.5).circles.tolist() == [[1.0, -2.5, 0.0], [1.0, 2.5, 0.0]]
    assert sc.Body.solid(2.5).borders == np.pi / 2 and sc.Body.solid(2.5).rests() == (0,)
    assert sc.Body.ball(0.1, 0.4, 0.4).circles.tolist() == [[0.0, -0.1, 1.0]]
    assert sc.Body.ball(0.1, 0.4, 0.4).borders.size == 0
    straight = sc.Body.solid(2.5).apex()
    assert straight.radius == straight.rate == np.inf
    assert BOTTLE.circles[:, 0].tolist() == [1.0, 1.0, 0.35]
    assert BOTTLE.rests() == (0,) and np.isnan(BOTTLE.apex(1).rate)
    bowl = sc.assembled([sc.parts.cap(diameter=2, height=1, density=1.0)])
    assert bowl.smooth.tolist() == [True] and bowl.rests() == ()
    with pytest.raises(ValueError, match="meet smoothly"):
        bowl.apex()


def test_one_circle_and_two_equal_rims_are_the_bodies_of_their_numbers():
    two = sc.Body.profile([(1, 0), (1, 3)], i1=1.2, i3=0.5, centre=1.5)
    assert two == sc.Body(1.5, 1.2, 0.5, theta_end=np.pi / 2) and two.rims is None
    assert sc.Body.profile([(0, 0, 1)], i1=0.4, i3=0.4, centre=-0.1) == sc.Body(
        0.1 * -1, 0.4, 0.4, fillet=1.0, theta_end=np.pi
    )
    assert sc.Body.balls(radii=(2, 2)) == sc.Body.balls() == sc.Body.balls(radii=(1, 1))
    # a circle within the hull, and the inner edges of a tube, never touch the table
    tube = [(1, 0), (0.8, 0), (0.9, 1), (0.8, 3), (1, 3)]
    assert sc.Body.profile(tube, i1=1.2, i3=0.5, centre=1.5) == two


@pytest.mark.parametrize("body", [CUP, BALLS, BOTTLE, CUP.in_metres("7g", radius="35mm")])
def test_a_body_of_several_circles_is_a_value(body):
    scope = {"Body": sc.Body, "Scale": sc.Scale}
    for same in (eval(repr(body), scope), pickle.loads(pickle.dumps(body)), dataclasses.replace(body)):
        assert same == body and hash(same) == hash(body) and (same.circles == body.circles).all()
        assert (same.borders == body.borders).all()
    other = dataclasses.replace(body, i1=1.01 * body.i1)
    assert other != body and (other.circles == body.circles).all()
    with pytest.raises(ValueError, match="read-only"):
        body.rims[0, 0] = 1.0
    with pytest.raises(ValueError, match=r"^theta_end = 1.0: expected"):
        dataclasses.replace(body, theta_end=1.0)
    plain = sc.Body.solid(2.5)
    assert plain.rims is None and "rims" not in repr(plain) and plain != body


def test_a_size_in_metres_is_that_of_the_widest_circle():
    cup = sc.Body.frustum("25mm", "35mm", "90mm", wall=0.0).in_metres("7g")
    assert cup.scale.radius == 0.035 and cup.circles[0, 0] == pytest.approx(25 / 35, rel=1e-15)
    assert sc.Body.lathe([(0.02, 0), (0.03, 0.1)]).in_metres().scale.radius == 0.03
    assert sc.Body.balls(radii=(3, 4), diameter="12mm").scale.radius == 0.006
    assert sc.Body.balls(radii=("3mm", "4mm")).in_metres().scale.radius == 0.004
    with pytest.raises((TypeError, ValueError), match=r"^circles"):
        sc.Body.profile([("7mm", 0), ("10mm", 2)], 0.5, 0.4)
    parts = sc.assembled(
        [sc.parts.wall(lower_diameter="50mm", upper_diameter="70mm", length="90mm", mass="7g")]
    )
    assert parts.scale.radius == 0.025
    same = dataclasses.replace(cup, scale=None)
    assert parts.borders == pytest.approx(same.borders, abs=1e-15)
    # the same body in two units of length: times are those of gravity
    rates = [body.apex().rate / np.sqrt(body.scale.radius / body.scale.gravity) for body in (parts, cup)]
    assert rates[0] == pytest.approx(rates[1], rel=1e-13)


def test_a_half_full_can_lies_on_two_circles_of_one_radius():
    can = sc.assembled(
        [
            sc.parts.wall(lower_diameter="66mm", upper_diameter="66mm", length="115mm", density=2.0),
            sc.parts.cylinder(outer_diameter="65mm", length="50mm", density=1000, at="0mm"),
        ]
    )
    low, high = can.circles
    assert low[0] == high[0] == 1.0 and -low[1] < high[1]
    assert can.borders[0] == np.pi / 2 and can.rests() == (0,) and can.rims is not None


def test_a_family_of_cups_has_the_numbers_of_each():
    cups = [sc.Body.frustum(0.7, 1.0, height) for height in (0.5, 1.0, 2.0)]
    rims = np.stack([cup.rims for cup in cups])
    family = sc.Body(np.nan, [cup.i1 for cup in cups], [cup.i3 for cup in cups], rims=rims)
    assert family.theta_end.tolist() == [cup.theta_end for cup in cups]
    theta = np.array([0.4, 1.2, 2.0])
    single = [cup.rate(x) for cup, x in zip(cups, theta, strict=True)]
    assert np.array_equal(family.rate(theta), single, equal_nan=True)
    assert family.rate(theta[:, np.newaxis]).shape == (3, 3)
    i1, i3 = ([*x, 0.5] for x in (family.i1, family.i3))
    impossible = np.concatenate([rims, [[[0.7, 2.0, 0.0], [1.0, 1.0, 0.0]]]])
    with_bad = sc.Body(np.nan, i1, i3, rims=impossible)
    assert np.isnan(with_bad.ell).tolist() == [False, False, False, True]
    assert with_bad.region(1.0)[3] == sc.Region.INVALID


@pytest.mark.parametrize(
    ("said", "make"),
    [
        ("circles = 1", lambda: sc.Body.profile([(0, 0, 1), (0, 0.1, 0.5)], 0.5, 0.4)),
        ("circles = ", lambda: sc.Body.profile([(1, 1), (1, 0)], 0.5, 0.4)),
        ("circles", lambda: sc.Body.profile([(1, 1, 0, 0)], 0.5, 0.4)),
        ("circles", lambda: sc.Body.profile([], 0.5, 0.4)),
        ("centre = nan", lambda: sc.Body.profile([(0.7, 0), (1, 2)], 0.5, 0.4, np.nan)),
        ("radii = NaN", lambda: sc.Body.balls(radii=(np.nan, np.nan))),
        ("circles = -1.*radius", lambda: sc.Body.profile([(-1, 0), (1, 1)], 0.5, 0.4)),
        ("circles = -1.*fillet", lambda: sc.Body.profile([(1, 0, -1), (1, 1)], 0.5, 0.4)),
        ("i3 = 1.1, i1 = 0.5", lambda: sc.Body.profile([(0.7, 0), (1, 2)], 0.5, 1.1, 1.0)),
        ("i1 = NaN", lambda: sc.Body.profile([(0.7, 0), (1, 2)], np.nan, 1.1, 1.0)),
        ("bottom = -1", lambda: sc.Body.frustum(-1, 1, 1)),
        ("wall = 2", lambda: sc.Body.frustum(1, 1.5, 1, wall=2)),
        ("height = 0", lambda: sc.Body.cone(0)),
        ("points", lambda: sc.Body.lathe([(1, 1), (1, 0)])),
        ("points", lambda: sc.Body.lathe([])),
        ("radii = 0.0", lambda: sc.Body.balls(radii=(0, 1))),
        ("separation = 0.5", lambda: sc.Body.balls(0.5, radii=(1, 0.5))),
        ("ell = 0.3", lambda: sc.Body(0.3, CUP.i1, CUP.i3, rims=CUP.rims)),
        ("rims", lambda: sc.Body(np.nan, 0.5, 0.4, rims=[1.0, 2.0])),
    ],
)
def test_what_no_body_has_is_refused_by_name(said, make):
    with pytest.raises(ValueError, match=rf"^{said}"):
        make()


def test_a_circle_in_line_with_two_others_is_left_out_with_a_warning():
    with pytest.warns(UserWarning, match="in line"):
        body = sc.Body.profile([(0.7, 0), (0.85, 1), (1, 2)], 0.5, 0.4, 1.0)
    assert len(body.circles) == 2


@pytest.mark.parametrize(
    "call",
    [
        lambda cup: sc.drift(cup, 1.2, sc.loss.ViscousContour(1e-3)),
        lambda cup: sc.pressed(cup, 9.0, 0.8, finger=0.6, table=0.0),
        lambda cup: cup.theta_balance,
        lambda cup: cup.standing_spin(),
    ],
)
def test_a_function_of_one_circle_refuses_a_body_of_several_by_name(call):
    with pytest.raises(ValueError, match=r"^body: expected one circle or two equal rims, not 2 circles"):
        call(CUP)


def bodies():
    double = sc.Body.lathe([(0, -1.2), (1, 0), (0, 0.9)])
    rounded = sc.Body.profile([(0.5, 0, 0.2), (0.8, 1.5, 0.1)], 0.6, 0.4, 0.7)
    return [CUP, BALLS, BOTTLE, double, rounded, sc.Body.cone(1.0)]


def test_a_body_told_from_its_other_end_has_the_same_steady_states():
    rng = np.random.default_rng(2)
    for body in bodies():
        other, theta = upside_down(body), rng.uniform(0.05, np.pi - 0.05, 200)
        for law in ("rate", "stability", "painleve"):
            here, there = getattr(body, law)(theta), getattr(other, law)(np.pi - theta)
            known = ~np.isnan(here)
            assert (known == ~np.isnan(there)).all() and known.sum() > 10
            assert there[known] == pytest.approx(here[known], rel=1e-9, abs=1e-9)
        state, over = body.steady(theta), other.steady(np.pi - theta)
        has = ~np.isnan(body.rate(theta))
        assert (np.isnan(state.w1) == ~has).all() and (np.isnan(state.w3) == ~has).all()
        assert over.w3[has] == pytest.approx(-state.w3[has], rel=1e-9, abs=1e-12)


def test_a_steady_state_of_any_circle_has_no_acceleration_and_stays():
    rng, seen = np.random.default_rng(3), 0
    for body in bodies():
        for theta in rng.uniform(0.1, np.pi - 0.1, 30):
            if np.isnan(body.rate(theta)) or np.abs(body.borders - theta).min() < 0.02:
                continue
            state = body.steady(float(theta))
            size = abs(state.w1) + abs(state.w3)
            assert abs(body.acceleration(state)) < 1e-13 * (1 + size**2)
            if not body.stable(float(theta)):
                continue
            m = sc.roll(body, state, 3.0, contact="rolling")
            assert m.status == sc.Ending.DONE or m.event.ending == sc.Ending.LIFT_OFF
            if m.success:
                seen += 1
                assert m.theta[0] == pytest.approx(theta, abs=1e-10) and m.w[0, 2] == pytest.approx(state.w3)
    assert seen > 20


def test_all_inclinations_of_a_rate_are_found_on_all_circles():
    rng = np.random.default_rng(4)
    for body in bodies():
        theta = np.linspace(1e-3, np.pi - 1e-3, 40_001)
        rate = body.rate(theta)
        for want in np.exp(rng.uniform(-1, 1, 6)) * np.nanmedian(rate):
            off, found = rate - want, body.inclinations(want)
            # a rate that jumps at a border, or grows without bound, has no root there
            cross = (off[:-1] * off[1:] < 0) & (np.abs(np.diff(off)) < 0.1 * want)
            brute = 0.5 * (theta[1:] + theta[:-1])[cross]
            found = found[~np.isnan(found)]
            assert found == pytest.approx(brute, abs=1e-4), (body, want)
            assert body.count(want) == found.size
            assert body.rate(found) == pytest.approx(want, rel=1e-9)
            assert body.states(want).theta[: found.size] == pytest.approx(found)
        folds = body.folds()
        folds = folds[~np.isnan(folds)]
        slope = np.diff(rate)
        turns = (slope[:-1] * slope[1:] < 0) & (np.abs(np.diff(slope)) < 1e-5 * rate[1:-1])
        assert folds == pytest.approx(theta[1:-1][turns], abs=1e-3)


def test_a_steady_state_does_not_depend_on_the_unit_of_length():
    for body in bodies():
        rows = body.circles * [4, 4, 4]
        large = sc.Body.profile(rows, 16 * body.i1, 16 * body.i3)
        theta = np.linspace(0.1, 3.0, 50)
        # Omega sqrt(I3) with lengths in R/4: Omega is half as large, sqrt(I3) four times
        assert large.rate(theta) == pytest.approx(2 * body.rate(theta), rel=1e-10, nan_ok=True)
        assert 4 * large.stability(theta) == pytest.approx(
            body.stability(theta), rel=1e-8, abs=1e-9, nan_ok=True
        )


HELD = {"contact": sc.Coulomb(0.3), "restitution": 0.0}


def test_a_cup_goes_on_over_its_circles_and_keeps_its_energy_and_heat():
    rims, kinds = set(), set()
    for body, start in (
        (CUP, sc.State(1.2, 0.6, -0.8, 0.5, slip=(0.1, 0.2))),
        (CUP, sc.State(2.2, 0.3, 0.4, 0.5)),
        (BALLS, sc.State(1.0, 1.5, -0.5, 2.0)),
        (BOTTLE, sc.State(1.2, 0.3, -0.6, 0.4)),
    ):
        m = sc.roll(body, start, np.linspace(0, 6, 121), want="pose", **HELD)
        whole = m.energy + m.dissipated + m.lost_in_impacts
        assert m.t.size > 20 and np.ptp(whole) < 1e-12 * max(1, whole[0]), body
        assert (m.height >= 0).all()
        rims |= {*m.rim.tolist()}
        kinds |= {phase.kind for phase in m.phases}
    assert rims == {0, 1} and kinds >= {"lying", "rolling on its side", "flying", "slipping", "rolling"}


def test_a_body_told_from_its_other_end_moves_the_same_way():
    for body in (CUP, BALLS):
        other = upside_down(body)
        start = sc.State(1.1, 0.8, -0.7, 0.9, slip=(0.1, -0.2))
        over = sc.State(np.pi - 1.1, 0.8, 0.7, -0.9, slip=(-0.1, 0.2))
        t = np.linspace(0, 4, 41)
        m, n = sc.roll(body, start, t, **HELD), sc.roll(other, over, t, **HELD)
        assert m.t.size == n.t.size and m.status == n.status
        assert n.theta == pytest.approx(np.pi - m.theta, abs=1e-9)
        assert n.w[:, 0] == pytest.approx(m.w[:, 0], abs=1e-8) and n.w[:, 2] == pytest.approx(
            -m.w[:, 2], abs=1e-8
        )
        assert [x.kind for x in m.phases] == [x.kind for x in n.phases]


@pytest.mark.parametrize(
    "more", [{}, HELD, {"contact": sc.Coulomb(0.3)}, HELD | {"losses": sc.loss.Drilling(0.01)}]
)
def test_a_sweep_has_the_bits_of_single_motions_and_its_inputs_repeat_it(more):
    rng = np.random.default_rng(7)
    n = 12
    states = sc.State(rng.uniform(0.5, 1.9, n), *rng.normal(size=(3, n)))
    cups = [sc.Body.frustum(0.7, 1.0, height) for height in np.linspace(0.6, 2, n)]
    rims, i1, i3 = (
        np.stack([np.asarray(getattr(cup, name)) for cup in cups]) for name in ("rims", "i1", "i3")
    )
    for family, alone in ((CUP, [CUP] * n), (sc.Body(np.nan, i1, i3, rims=rims), cups)):
        found = sc.sweep.roll(family, states, 3.0, tol=1e-12, **more)
        for i, body in enumerate(alone):
            start = sc.State(*(getattr(states, name)[i] for name in ("theta", "w1", "w2", "w3")))
            m = sc.roll(body, start, [0.0, 3.0], **more, **({"tol": 1e-12} if more else {}))
            assert int(found["status"][i]) == m.status
            if m.success:
                assert float(found["theta"][i]) == pytest.approx(m.theta[-1], abs=1e-9)
        again = sc.sweep.roll(**sc.sweep.inputs(found))
        for name in found.data_vars:
            assert np.array_equal(found[name], again[name], equal_nan=True), name


def test_a_dropped_cup_falls_from_its_height():
    state = sc.dropped(CUP, 0.5, 2.5, w3=1.0)
    m = sc.roll(CUP, state, np.linspace(0, 0.9, 10), contact=sc.Coulomb(0.3), restitution=0.3)
    assert m.height[0] == pytest.approx(0.5, abs=1e-15)
    assert m.height == pytest.approx(0.5 - m.t**2 / 2, abs=1e-12)


def test_a_swing_is_that_of_the_circle_that_carries_seen_from_either_end():
    other = upside_down(CUP)
    for theta in (1.2, 1.8):
        here = sc.swing(CUP, sc.State(theta, 0.5, 0.1, 0.5))
        there = sc.swing(other, sc.State(np.pi - theta, 0.5, -0.1, -0.5))
        assert there.period == pytest.approx(here.period, rel=1e-12)
        assert there.theta_min == pytest.approx(np.pi - here.theta_max, abs=1e-13)
        assert there.spin_per_period == pytest.approx(-here.spin_per_period, rel=1e-11)
        motion = sc.roll(CUP, sc.State(theta, 0.5, 0.1, 0.5), np.linspace(0, here.period, 400))
        assert here.theta_min - 1e-12 < motion.theta.min() and motion.theta.max() < here.theta_max + 1e-12


def test_a_motion_of_a_cup_is_drawn_told_and_saved():
    m = sc.roll(CUP, sc.State(1.2, 0.5, 0.1, 0.5), np.linspace(0, 1, 20), want=("pose", "force"), **HELD)
    assert "<!DOCTYPE html>" in sc.view(m).html and "circles" in CUP._repr_html_()
    shape = sc.scene(m, scale=sc.Scale(0.03, 0.02)).data["body"]["shape"]
    assert shape["type"] == "circles" and [x["radius"] for x in shape["circles"]] == pytest.approx(
        [0.021, 0.03]
    )
    assert m.to_xarray()["theta"].size == 20
    with pytest.raises(ValueError, match=r"^body: expected a frustum, or a body whose lowest circle"):
        sc.play(upside_down(BOTTLE))
    with pytest.raises(ValueError, match=r"^contact = 'rolling': a page moves a frustum with friction"):
        sc.play(CUP)
    page = sc.play(CUP, state=sc.State(1.0, 0.1, 0.0, 0.3), contact=sc.Coulomb(0.4))
    assert page.body == CUP and page.motion.phases[-1].kind == "rolling round its apex"


def contact_of(m):
    """The point of the circle that is told which is nearest to the table, from the centre and the orientation."""
    x, y, z, w = m.orientation.T
    axis = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], -1)
    assert axis[:, 2] == pytest.approx(np.cos(m.theta), abs=1e-12)
    radius, height, fillet = m.body.circles[m.rim].T[:, :, np.newaxis]
    up = np.array([0.0, 0.0, 1.0])
    down = axis[:, 2:] * axis - up
    return (
        m.centre + height * axis + radius * down / np.linalg.norm(down, axis=1)[:, np.newaxis] - fillet * up
    )


def test_pose_and_centre_of_a_body_of_several_circles_are_those_of_the_circle_that_touches():
    t, seen = np.linspace(0, 6, 301), set()
    for body, start, how in (
        (CUP, sc.State(1.8, 0.5, 0.1, 0.5), {}),
        (CUP, sc.State(2.2, 0.3, 0.4, 0.5), HELD),
        (BALLS, sc.State(1.0, 1.5, -0.5, 2.0), HELD),
        (BOTTLE, sc.State(1.2, 0.3, -0.6, 0.4), HELD),
        (BOTTLE, sc.State(2.2, 0.6, 0.4, -0.5, slip=(0.1, 0.3)), HELD),
    ):
        m = sc.roll(body, start, t, want="pose", **how)
        table = m.contact_point
        point = contact_of(m)
        lift = point[:, 2]
        assert m.t.size > 5 and (lift > -1e-11).all()
        down = np.abs(lift) < 1e-11
        assert point[down, :2] == pytest.approx(table[down], abs=1e-10)
        assert np.abs(np.diff(m.centre, axis=0)).max() < 0.2, "the centre of mass does not jump"
        assert (m.axis_up == np.cos(m.theta)).all()
        seen |= {*m.rim.tolist()}
    assert seen == {0, 1, 2}
