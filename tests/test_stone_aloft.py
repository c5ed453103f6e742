"""Stones in the air and their impacts, from Python: states, drops, motions, sweeps, pictures, and what is refused."""

import json
import pickle
import wave

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import spincyl as sc
from spincyl.studio.aloft import aloft, goes_up
from spincyl.studio.poses import knots, packed, seen, span

mpl.use("Agg")

EGG = sc.Ellipsoid.egg(0.75, 1.0, 0.05)
PEBBLE = sc.Ellipsoid(
    (1.0, 0.8, 0.6), [[0.2, 0.01, 0.02], [0.01, 0.3, -0.015], [0.02, -0.015, 0.35]], (0.03, -0.02, -0.1)
)
BALL, BODY = sc.Ellipsoid.uniform((1.0, 1.0, 1.0)), sc.Body.ball(0.0, 0.4, 0.4)
GRIP = sc.Coulomb(0.3)
TILTED = sc.EllipsoidState((0.48, 0.6, 0.64), (0.4, 0.3, 0.9))
ALOFT = {"height": 0.5, "lift": -0.2, "slip": (0.5, 0.2)}
FALLING = sc.EllipsoidState(TILTED.vertical, TILTED.w, **ALOFT)


def lever_of(stone, vertical):
    """The vector from the centre of mass to the lowest point of an ellipsoid."""
    n, squares = np.asarray(vertical), np.asarray(stone.semi_axes) ** 2
    return -squares * n / np.sqrt(np.sum(squares * n * n)) - np.asarray(stone.offset)


def up_of(stone, state):
    """The height of the centre on the table, and the velocity of the lowest point if the centre rests."""
    lever = lever_of(stone, state.vertical)
    return -np.asarray(state.vertical) @ lever, np.cross(state.w, lever)


def laboratory(vertical):
    """The axes x, y, z of the laboratory along those of a stone that is turned from upright by the smallest rotation."""
    x, y, z = np.asarray(vertical, float)
    return Rotation.from_quat([y, -x, 0.0, 1 + z]).as_matrix()


@pytest.fixture(scope="module")
def hops():
    t = np.linspace(0, 4, 161)
    return sc.roll(PEBBLE, FALLING, t, contact=GRIP, restitution=0.5, want=("pose", "force"))


@pytest.fixture(autouse=True)
def closed_figures():
    yield
    plt.close("all")


# states


def test_a_state_in_the_air_is_a_value_whose_missing_half_is_zero():
    only = sc.EllipsoidState((0, 0, 1), (0, 0, 1), height=0.5)
    assert (only.height, only.lift) == (0.5, 0.0)
    assert sc.EllipsoidState((0, 0, 1), (0, 0, 1), lift=0.5).height == 0.0
    assert only == sc.EllipsoidState((0, 0, 1), (0, 0, 1), height=0.5, lift=0.0)
    assert only != sc.EllipsoidState((0, 0, 1), (0, 0, 1)) and only != sc.EllipsoidState(
        (0, 0, 1), (0, 0, 1), height=0.6
    )
    assert (
        hash(only) == hash(pickle.loads(pickle.dumps(only)))
        and pickle.loads(pickle.dumps(FALLING)) == FALLING
    )
    assert TILTED.height is None and TILTED.lift is None
    names = {"EllipsoidState": sc.EllipsoidState, "array": np.array}
    assert eval(repr(FALLING), names) == FALLING and "height" not in repr(TILTED)


def test_heights_of_many_states_broadcast_and_stay_lazy():
    da = pytest.importorskip("dask.array")
    many = sc.EllipsoidState((0, 0, 1), np.zeros((3, 3)), height=np.array([0.1, 0.2, 0.3]), lift=0.1)
    assert many.height.shape == (3,) and many.lift == 0.1
    with pytest.raises(ValueError, match="read-only"):
        many.height[0] = 2.0
    with pytest.raises(ValueError, match="^vertical, w, slip, height, lift: shapes do not fit"):
        sc.EllipsoidState((0, 0, 1), np.zeros((3, 3)), height=np.zeros(2))
    with pytest.raises(TypeError, match="^height"):
        sc.EllipsoidState((0, 0, 1), (0, 0, 0), height="high")
    lazy = sc.EllipsoidState((0, 0, 1), (0, 0, 0), height=da.ones(4, chunks=2))
    assert lazy.height.chunks == ((2, 2),)


@pytest.mark.parametrize("kind", ["stone", "body"])
def test_a_state_in_si_comes_back_with_its_height_and_lift(kind):
    size = sc.Scale(0.02)
    state = (
        FALLING if kind == "stone" else sc.State(1.0, 0.1, 0.2, 0.3, slip=(0.1, 0.2), height=0.5, lift=-0.2)
    )
    given = state.in_si(size)
    assert given["height"] == pytest.approx(0.01) and given["lift"] == pytest.approx(
        -0.2 * size.metres_per_second(1.0)
    )
    same = type(state).from_si(**given, scale=size)
    assert (same.height, same.lift) == pytest.approx((0.5, -0.2), rel=1e-15)
    assert np.allclose(same.slip, state.slip, rtol=1e-14)
    assert type(state).from_si(**given | {"height": "1cm"}, scale=size).height == pytest.approx(0.5)
    assert "height" not in (TILTED if kind == "stone" else sc.State(1.0, 0, 0, 0)).in_si(size)


# drops


@pytest.mark.parametrize("stone", [EGG, PEBBLE, BALL])
def test_a_stone_is_dropped_with_the_velocity_of_its_centre(stone):
    velocity = 0.5, -0.2, 1.0
    state = stone.dropped(TILTED, 0.7, velocity=velocity)
    _, turned = up_of(stone, TILTED)
    *slip, lift = np.array(velocity) + laboratory(TILTED.vertical) @ turned
    assert np.allclose(state.slip, slip, atol=1e-15) and state.lift == pytest.approx(lift, abs=1e-15)
    assert state.height == 0.7 and (state.vertical == TILTED.vertical).all() and (state.w == TILTED.w).all()
    assert stone.dropped(FALLING, 0.7, velocity=velocity) == state, (
        "what the state has of a flight is replaced"
    )


@pytest.mark.parametrize("stone", [EGG, PEBBLE])
def test_the_energy_in_the_air_is_that_of_the_centre_and_of_the_rotation(stone):
    velocity = np.array([0.5, -0.2, 1.0])
    state = stone.dropped(TILTED, 0.7, velocity=tuple(velocity))
    high, _ = up_of(stone, TILTED)
    w = np.asarray(TILTED.w)
    whole = velocity @ velocity / 2 + w @ np.asarray(stone.inertia) @ w / 2 + high + 0.7
    assert stone.energy(state) == pytest.approx(whole, rel=1e-15)
    many = sc.EllipsoidState(TILTED.vertical, TILTED.w, state.slip, height=[0.7, 1.7], lift=state.lift)
    assert np.allclose(stone.energy(many), [whole, whole + 1], rtol=1e-15)


def test_a_measured_stone_is_dropped_from_a_height_in_metres():
    egg = sc.Ellipsoid.egg(0.022, 0.0285).in_metres(0.06)
    start = egg.spinning(0.0, pitch=np.pi / 2)
    for height in (0.01, "10mm"):
        state = egg.dropped(start, height, velocity=(0.3, 0.0, 0.0))
        assert state.height == pytest.approx(0.01 / 0.0285) and state.slip[0] == pytest.approx(
            0.3 / egg.scale.metres_per_second(1.0)
        )
    m = sc.roll(egg, egg.dropped(start, 0.01), np.linspace(0, 0.1, 11), contact=GRIP, restitution=0.4)
    assert m.impacts[0].time == pytest.approx(np.sqrt(2 * 0.01 / 9.80665), rel=1e-12)
    assert m.height[0] == pytest.approx(0.01) and m.lift[1] == pytest.approx(-0.0980665)


def test_families_are_dropped_from_many_heights():
    eggs = sc.Ellipsoid.egg(np.array([0.6, 0.7, 0.8]), 1.0)
    state = eggs.dropped(eggs.spinning(1.0, pitch=0.3), np.array([[0.1], [0.2]]))
    assert np.shape(state.height) == np.shape(state.lift) == (2, 3)
    assert (state.height == [[0.1] * 3, [0.2] * 3]).all()
    with pytest.raises(ValueError, match="shapes do not fit"):
        eggs.dropped(eggs.spinning(1.0), 0.1, velocity=(np.zeros(2), 0.0, 0.0))


@pytest.mark.parametrize(
    ("how", "error", "why"),
    [
        ({"height": -0.1}, ValueError, "^height = -0.1: expected 0 <= height, finite"),
        ({"height": np.inf}, ValueError, "^height = inf"),
        ({"height": None}, TypeError, "^height"),
        ({"velocity": (0.0, 1.0)}, TypeError, "^velocity: expected three components"),
        ({"velocity": (0.0, 1.0, "x")}, TypeError, "^velocity"),
        ({"state": sc.State(1.0, 0, 0, 0)}, TypeError, "^state"),
    ],
)
def test_a_drop_that_makes_no_sense_is_refused_by_name(how, error, why):
    with pytest.raises(error, match=why):
        EGG.dropped(**{"state": TILTED, "height": 0.5} | how)


# motions


def test_in_the_air_the_centre_falls_on_a_parabola(hops):
    first = hops.impacts[0].time
    flight = hops.t < first
    high, turned = up_of(PEBBLE, FALLING)
    v = np.array([*ALOFT["slip"], ALOFT["lift"]]) - laboratory(FALLING.vertical) @ turned
    t = hops.t[flight]
    z = high + 0.5 + v[2] * t - t * t / 2
    assert flight.sum() > 10 and np.abs(hops.centre[flight, 2] - z).max() < 1e-13
    level = hops.centre[flight, :2] - hops.centre[0, :2]
    assert np.abs(level - t[:, np.newaxis] * v[:2]).max() < 1e-13
    momentum = np.einsum(
        "nij,nj->ni", Rotation.from_quat(hops.orientation).as_matrix(), hops.w @ np.asarray(PEBBLE.inertia)
    )
    assert np.ptp(momentum[flight], axis=0).max() < 1e-13
    assert (hops.normal[flight] == 0).all() and (hops.contact_force[flight] == 0).all()
    assert np.isnan(hops.friction_coefficient[flight]).all()


def test_the_height_is_that_of_the_lowest_point_and_the_lift_its_velocity(hops):
    z = np.array([up_of(PEBBLE, sc.EllipsoidState(n, (0, 0, 0)))[0] for n in hops.vertical])
    assert np.abs(hops.centre[:, 2] - z - hops.height).max() < 1e-12
    flies = hops.phase == 2
    assert (hops.height[~flies] == 0).all() and (hops.lift[~flies] == 0).all() and hops.height.min() >= 0
    step = 1e-5
    for t in hops.t[flies][3:12:4]:
        around = hops.at([t - step, t, t + step])
        assert (around.height[2] - around.height[0]) / (2 * step) == pytest.approx(around.lift[1], abs=1e-7)
    assert np.allclose(hops.states.height, hops.height) and np.allclose(hops.states.lift, hops.lift)


@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("contact", [GRIP, sc.Coulomb(0.2, static=0.3), sc.Viscous(0.5), "smooth"], ids=repr)
@pytest.mark.parametrize("stone", [EGG, PEBBLE], ids=["egg", "pebble"])
def test_energy_and_all_that_is_taken_are_constant(stone, contact, e):
    m = sc.roll(stone, FALLING, np.linspace(0, 5, 101), contact=contact, restitution=e)
    whole = m.energy + m.dissipated + m.lost_in_impacts
    assert np.ptp(whole) < 1e-12 + 10 * m.error
    assert m.impacts and all(x.lost > -1e-13 for x in m.impacts)
    assert (np.diff(m.lost_in_impacts) > -1e-13).all()
    if e == 1 and contact == "smooth":
        assert m.lost_in_impacts[-1] < 1e-12


def test_energy_is_constant_in_si_too_and_what_is_weighed_is_in_joules():
    egg = sc.Ellipsoid.egg(0.022, 0.0285).in_metres(0.06)
    start = egg.dropped(egg.spinning(hertz=3.0, pitch=1.2), 0.02)
    m = sc.roll(egg, start, np.linspace(0, 0.4, 101), contact=GRIP, restitution=0.5)
    for of in (m, m.natural):
        whole = of.energy + of.dissipated + of.lost_in_impacts
        assert np.ptp(whole) < 1e-12 * whole[0]
    assert m.impacts[0].lost == pytest.approx(m.natural.impacts[0].lost * m.scale.joules(1.0), rel=1e-12)
    unit = m.scale.joules(1.0) / m.scale.metres_per_second(1.0)
    assert m.impacts[0].impulse == pytest.approx([p * unit for p in m.natural.impacts[0].impulse], rel=1e-12)
    assert m.height.max() == pytest.approx(m.natural.height.max() * m.scale.radius, rel=1e-12)


def test_losses_in_the_air_and_on_the_table_add_up():
    how = {
        "contact": GRIP,
        "restitution": 0.5,
        "losses": sc.loss.AirLinear(0.05) + sc.loss.RollingResistance(1e-3),
    }
    m = sc.roll(EGG, FALLING, np.linspace(0, 4, 81), **how)
    assert np.ptp(m.energy + m.dissipated + m.lost_in_impacts + m.work_lost) < 1e-12 + 10 * m.error
    flight = m.t < m.impacts[0].time
    assert (np.diff(m.work_lost[flight]) > 0).all(), "the air resists the rotation"


def test_an_impact_changes_the_momentum_by_its_impulse_and_the_rotation_by_its_arm(hops):
    inertia = np.asarray(PEBBLE.inertia)
    for impact in hops.impacts[:6]:
        before, after = impact.before, impact.after
        assert isinstance(before, sc.EllipsoidState) and impact.rim == "first"
        assert (
            before.lift < 0
            and before.height == after.height == 0
            and (before.vertical == after.vertical).all()
        )
        assert after.lift > 0 or impact.stays or after.lift == 0
        at = hops.at([impact.time]).wanting("pose")
        turn, (_, b), (_, a) = (
            Rotation.from_quat(at.orientation[0]),
            up_of(PEBBLE, before),
            up_of(PEBBLE, after),
        )
        # slips are along x and y of the state; those of the laboratory are turned about the vertical
        z, w = at.orientation[0, 2:]
        about = Rotation.from_rotvec([0, 0, 2 * np.arctan2(z, w)])
        u0, u1 = (about.apply([*s.slip, s.lift]) for s in (before, after))
        jump = (u1 - turn.apply(a)) - (u0 - turn.apply(b))
        assert np.allclose(jump, impact.impulse, atol=1e-11)
        lever = lever_of(PEBBLE, before.vertical)
        turned = inertia @ (np.asarray(after.w) - np.asarray(before.w))
        assert np.allclose(turned, np.cross(lever, turn.inv().apply(impact.impulse)), atol=1e-11)
        lost = PEBBLE.energy(before) - PEBBLE.energy(after)
        assert impact.lost == pytest.approx(lost, abs=1e-11)
        along, across, up = impact.impulse
        assert np.hypot(along, across) <= GRIP.mu * up * (1 + 1e-12) and up > 0


def test_a_ball_that_is_dropped_comes_to_rest_after_the_sum_of_its_bounces():
    e, height = 0.5, 0.8
    start = BALL.dropped(BALL.spinning(0.0, pitch=1.0), height)
    m = sc.roll(BALL, start, [0.0, 10.0], contact=GRIP, restitution=e)
    assert m.impacts[0].time == pytest.approx(np.sqrt(2 * height), rel=1e-14)
    over = np.sqrt(2 * height) * (1 + 2 * e / (1 - e))
    assert m.phases[-1].kind == "rolling" and m.phases[-1].time == pytest.approx(over, abs=1e-6)
    assert m.impacts[-1].stays and not any(x.stays for x in m.impacts[:-1])
    assert m.lost_in_impacts[-1] == pytest.approx(height, rel=1e-12)


@pytest.mark.parametrize("contact", [GRIP, sc.Viscous(0.5), "smooth"], ids=repr)
def test_a_ball_as_a_stone_and_as_a_body_of_revolution_has_one_motion(contact):
    theta, w = 1.0, (0.3, -0.4, 2.0)
    body = sc.State(theta, *w, slip=(0.5, -0.2), height=0.6, lift=0.11)
    # e_h of the body is x, and e2 is y
    stone = sc.EllipsoidState((np.sin(theta), 0.0, np.cos(theta)), w, (0.5, -0.2), height=0.6, lift=0.11)
    t = np.linspace(0, 6, 61)
    how = {"contact": contact, "restitution": 0.6, "want": "pose"}
    a, b = sc.roll(BODY, body, t, **how), sc.roll(BALL, stone, t, **how)
    # the last of a sum of bounces depends on rounding
    assert a.phases[-1].kind == b.phases[-1].kind and min(len(a.impacts), len(b.impacts)) > 8
    for one, other in zip(a.impacts[:8], b.impacts[:8], strict=True):
        assert (one.kind, one.stays) == (other.kind, other.stays)
        assert one.time == pytest.approx(other.time, abs=1e-10) and one.lost == pytest.approx(
            other.lost, abs=1e-11
        )
        assert one.impulse[2] == pytest.approx(other.impulse[2], abs=1e-11)
    assert np.abs(a.centre - b.centre).max() < 1e-9 and np.abs(a.height - b.height).max() < 1e-10
    assert np.abs(a.energy - b.energy).max() < 1e-11


def test_a_phase_in_the_air_is_a_start_that_continues_the_motion(hops):
    flights = [x for x in hops.phases if x.kind == "flying"]
    assert len(flights) > 2
    for name in ("vertical", "w", "slip", "height", "lift"):
        assert np.allclose(getattr(flights[0].state, name), getattr(FALLING, name), rtol=0, atol=1e-15)
    begun = flights[1]
    assert begun.state.height == 0 and begun.state.lift > 0
    # x and y are those of the state, which has no heading
    t = np.append(begun.time, hops.t[hops.t > begun.time])
    there = sc.roll(PEBBLE, begun.state, t, contact=GRIP, restitution=0.5)
    assert np.abs(there.y[:, 1:] - hops.y[:, -t.size + 1 :]).max() < 1e-8
    assert there.impacts[0].time == pytest.approx(hops.impacts[1].time, abs=1e-11)


def test_a_rolling_that_may_fly_and_stays_on_the_table_is_that_which_may_not():
    start = PEBBLE.spinning(0.3, pitch=0.1)
    t = np.linspace(0, 5, 51)
    may, may_not = (sc.roll(PEBBLE, start, t, contact=GRIP, **how) for how in ({"restitution": 0.5}, {}))
    assert np.abs(may.y - may_not.y).max() < 1e-12 and not may.impacts and not goes_up(may)
    assert (may.height == 0).all() and (may.lift == 0).all() and (may.lost_in_impacts == 0).all()


def test_a_rattleback_with_an_edge_may_turn_over_in_the_air_and_ends_where_its_edge_lands():
    stone = sc.Ellipsoid.rattleback((1.0, 0.3, 0.2), twist=0.05)
    over = sc.EllipsoidState((0.6, 0.0, -0.8), (0.0, 0.0, 0.0), height=0.4)
    m = sc.roll(stone, over, 3.0, contact=GRIP, restitution=0.5)
    assert m.status == sc.Ending.FACE and m.event.time == pytest.approx(np.sqrt(0.8), rel=1e-12)
    assert [x.kind for x in m.phases] == ["flying"] and m.impacts == ()
    level = sc.EllipsoidState((0.1, 0.0, np.sqrt(0.99)), (0.0, 0.0, 0.0), height=0.4)
    assert sc.roll(stone, level, 3.0, contact=GRIP, restitution=0.5).impacts


def test_on_a_rolling_table_every_impact_stops_the_slip():
    m = sc.roll(EGG, EGG.dropped(TILTED, 0.5), np.linspace(0, 3, 31), restitution=0.5)
    assert m.impacts and all(x.kind == "sticks" for x in m.impacts)
    assert max(np.abs(x.after.slip).max() for x in m.impacts) < 1e-14


def test_the_spin_in_the_air_may_turn_back_and_reversals_count_there():
    # a stone that tumbles about its middle axis
    state = sc.EllipsoidState((0.0, 0.6, 0.8), (0.02, 3.0, -2.2), height=30.0)
    t = np.linspace(0, 7.0, 7001)
    m = sc.roll(PEBBLE, state, t, contact=GRIP, restitution=0.0)
    spin = m.spin
    far = np.flatnonzero(np.abs(spin) >= 0.1 * abs(spin[0]))
    signs = np.sign(spin[far])
    many = np.count_nonzero(signs[1:] != signs[:-1])
    assert m.phase[-1] == 2 and many > 0
    found = sc.sweep.roll(PEBBLE, state, 7.0, contact=GRIP, restitution=0.0)
    assert int(found["reversals"]) == many


def test_a_motion_of_a_stone_that_hops_has_its_outputs_in_tables(hops):
    table, data = hops.to_dataframe(), hops.to_xarray()
    assert {"height", "lift", "slip_x", "slip_y", "phase", "n1", "energy"} <= {*table.columns}
    assert not {x for x in table.columns if "other" in x or x == "rim"}
    assert data["lift"].attrs["units"] == data["slip"].attrs["units"] == "sqrt(g R)"
    assert "flying from t = 0" in data.attrs["phases"] and "flying" in hops.message
    assert (hops.rim == 0).all()
    for name in ("slip_other", "contact_force_other", "normal_other"):
        with pytest.raises(AttributeError):
            getattr(hops, name)
    with pytest.raises(AttributeError, match="^height: needs restitution=; this motion ends where it leaves"):
        _ = sc.roll(PEBBLE, PEBBLE.spinning(0.3), 1.0).height
    with pytest.raises(AttributeError, match="^impacts: needs restitution="):
        _ = sc.roll(PEBBLE, PEBBLE.spinning(0.3), 1.0).impacts


def test_a_law_of_your_own_that_is_constant_is_coulombs_in_impacts_too():
    t = np.linspace(0, 3, 31)
    own = sc.custom.Friction(lambda speed: 0.3)
    a, b = (sc.roll(PEBBLE, FALLING, t, contact=c, restitution=0.5) for c in (own, GRIP))
    # the last of a sum of bounces depends on rounding
    assert min(len(a.impacts), len(b.impacts)) > 10 and np.abs(a.y - b.y).max() < 1e-8
    for one, other in zip(a.impacts[:10], b.impacts[:10], strict=True):
        assert one.kind == other.kind and one.time == pytest.approx(other.time, abs=1e-9)


def test_on_a_slope_a_stone_that_is_dropped_falls_downhill():
    table = sc.Table(0.2)
    m = sc.roll(
        EGG, EGG.dropped(TILTED, 0.5), np.linspace(0, 3, 61), contact=GRIP, restitution=0.4, table=table
    )
    flight = m.t < m.impacts[0].time
    t = m.t[flight]
    assert np.allclose(m.centre[flight, 0] - m.centre[0, 0], np.sin(0.2) * t * t / 2, atol=1e-12)
    assert np.allclose(m.centre[flight, 2] - m.centre[0, 2], -np.cos(0.2) * t * t / 2, atol=1e-12)
    assert np.ptp(m.energy + m.dissipated + m.lost_in_impacts) < 1e-11 + 10 * m.error


@pytest.mark.parametrize(
    ("how", "why"),
    [
        ({}, "^state: the body is in the air, height = 0.5: give restitution="),
        ({"restitution": 1.5}, "^restitution = 1.5: expected"),
        ({"restitution": -0.1}, "^restitution = -0.1: expected"),
        ({"restitution": 0.5, "contact": "rolling", "beyond": True}, "^beyond = True cannot be combined with restitution="),
        ({"restitution": 0.5, "step": 0.1}, "^step, method: only for bodies of revolution"),
        ({"restitution": 0.5, "state": sc.EllipsoidState(TILTED.vertical, TILTED.w, height=-0.5)}, "^height = -0.5: expected 0 to 1e6"),
        ({"restitution": 0.5, "contact": "smooth", "state": sc.EllipsoidState(TILTED.vertical, TILTED.w, (1, 0))}, "^state: the stone slips"),
    ],
)  # fmt: skip
def test_a_flight_that_makes_no_sense_is_refused_by_name(how, why):
    with pytest.raises(ValueError, match=why):
        sc.roll(**{"body": PEBBLE, "state": FALLING, "t": 1.0, "contact": GRIP} | how)
    with pytest.raises(TypeError, match="^restitution"):
        sc.roll(PEBBLE, FALLING, 1.0, contact=GRIP, restitution="half")


# sweeps


LAWS = [GRIP, sc.Coulomb(0.2, static=0.4), sc.Coulomb(0.3, patch=0.02), sc.Viscous(0.5), "smooth"]


@pytest.mark.parametrize("contact", LAWS, ids=repr)
@pytest.mark.parametrize("e", [0.0, 0.6])
def test_many_stones_are_those_that_are_followed_one_by_one(contact, e):
    rng, count = np.random.default_rng(7), 12
    axes = rng.uniform(0.5, 1.0, (count, 3))
    stones = sc.Ellipsoid.uniform(axes)
    n = rng.normal(size=(count, 3))
    n /= np.linalg.norm(n, axis=1)[:, np.newaxis]
    state = sc.EllipsoidState(
        n, rng.normal(size=(count, 3)), 0.5 * rng.normal(size=(count, 2)),
        height=rng.uniform(0.0, 1.0, count), lift=0.3 * rng.normal(size=count),
    )  # fmt: skip
    want = ("final", "end", "impacts", "landings", "air_time", "lost_in_impacts", "last_phase", "dissipated")
    how = {"contact": contact, "restitution": e, "tol": 1e-11}
    found = sc.sweep.roll(stones, state, 3.0, want=want, **how)
    for i in range(count):
        one = sc.Ellipsoid.uniform(axes[i])
        start = sc.EllipsoidState(
            n[i], state.w[i], state.slip[i],
            height=float(state.height[i]), lift=float(state.lift[i]),
        )  # fmt: skip
        m, row = sc.roll(one, start, [0.0, 3.0], **how), found.isel(motion=i)
        assert int(row.status) == m.status == sc.Ending.DONE
        doubt = 4 * (m.error + float(row.error)) + 1e-10
        last = [float(row[name]) for name in ("n1", "n2", "n3", "w1", "w2", "w3")]
        assert np.abs(last - m.y[:, -1]).max() < doubt
        if doubt < 1e-5:
            assert len(m.impacts) == int(row.impacts) and m.phase[-1] == int(row.last_phase)
            assert float(row.lost_in_impacts) == pytest.approx(m.lost_in_impacts[-1], abs=10 * doubt)
        times = np.array([p.time for p in m.phases] + [3.0])
        flies = np.array([p.kind == "flying" for p in m.phases])
        assert float(row.air_time) == pytest.approx(np.diff(times)[flies].sum(), abs=100 * doubt)
        assert int(row.landings) == np.count_nonzero(flies[:-1] & ~flies[1:])


def test_a_sweep_of_hops_keeps_its_inputs_and_repeats_its_bits():
    height = np.array([0.1, 0.4])
    state = EGG.dropped(
        EGG.spinning(1.0, pitch=0.4), height[:, np.newaxis], velocity=(0.2, 0.0, np.array([0.0, 0.1, 0.2]))
    )
    want = ("final", "impacts", "air_time")
    found = sc.sweep.roll(EGG, state, 2.0, contact=GRIP, restitution=0.5, want=want)
    assert found["impacts"].shape == (2, 3) and found.attrs["restitution"] == 0.5
    assert found["start_height"].attrs["units"] == "a" and found["start_lift"].attrs["units"] == "sqrt(g a)"
    assert np.allclose(found["start_height"].broadcast_like(found["impacts"]), state.height)
    given = sc.sweep.inputs(found)
    assert given["restitution"] == 0.5 and np.allclose(given["states"].height, state.height)
    again = sc.sweep.roll(**given, want=want)
    for name in ("n1", "w3", "impacts", "air_time"):
        assert (again[name].values == found[name].values).all()
    row = sc.sweep.inputs(found.isel(motion_0=1, motion_1=2))
    assert row["states"].height == pytest.approx(0.4)


def test_a_lazy_sweep_of_hops_is_the_sweep():
    da = pytest.importorskip("dask.array")
    height = np.linspace(0.1, 0.4, 4)
    start, want = EGG.spinning(1.0, pitch=0.4), ("impacts", "lost_in_impacts")
    lazy = sc.EllipsoidState(start.vertical, start.w, height=da.from_array(height, chunks=2))
    plain = sc.EllipsoidState(start.vertical, start.w, height=height)
    a, b = (sc.sweep.roll(EGG, x, 2.0, contact=GRIP, restitution=0.5, want=want) for x in (lazy, plain))
    assert a["impacts"].chunks is not None
    assert all((a[name].values == b[name].values).all() for name in want)


def test_what_a_sweep_of_stones_on_the_table_has_not_is_named():
    with pytest.raises(ValueError, match="this output needs restitution="):
        sc.sweep.roll(EGG, EGG.spinning(1.0), 1.0, want="impacts")
    with pytest.raises(ValueError, match="^state: the body is in the air"):
        sc.sweep.roll(EGG, EGG.dropped(EGG.spinning(1.0), 0.5), 1.0, contact=GRIP)
    with pytest.raises(ValueError, match="^restitution = 2.0: expected"):
        sc.sweep.roll(EGG, EGG.spinning(1.0), 1.0, contact=GRIP, restitution=2.0)


# pictures, pages, scenes and sound


def test_cubics_between_few_knots_meet_a_stone_through_flights_and_impacts(hops):
    first, last = span(hops)
    found = knots(hops)
    assert goes_up(hops) and found.shape[1] == 15
    t = np.sort(np.random.default_rng(1).uniform(first, last, 500))
    edges = aloft(hops, first, last).edges
    t = t[~((edges[:, :1] < t) & (t < edges[:, 1:])).any(axis=0)]
    i = np.clip(np.searchsorted(found[:, 0], t, "right") - 1, 0, len(found) - 2)
    a, b, h = found[i], found[i + 1], (found[i + 1, 0] - found[i, 0])[:, np.newaxis]
    s, y0, y1, d0, d1 = (t[:, np.newaxis] - a[:, :1]) / h, a[:, 1:8], b[:, 1:8], h * a[:, 8:], h * b[:, 8:]
    drawn = y0 + s * (d0 + s * (3 * (y1 - y0) - 2 * d0 - d1 + s * (2 * (y0 - y1) + d0 + d1)))
    centre, orientation = seen(hops, t, "centre", "orientation")
    assert np.abs(drawn[:, [3, 4, 6]] - centre).max() < 3e-3
    q = drawn[:, [0, 1, 2, 5]]
    q /= np.linalg.norm(q, axis=1)[:, np.newaxis]
    assert (1 - np.abs((q * orientation).sum(axis=1))).max() < 1e-5
    assert max(packed(found)["most"]) < 10


def test_a_page_of_a_stone_that_hops_has_its_flights(hops):
    html = sc.view(hops).html
    assert "ofStoneAloft" in html
    data = json.loads(html.split('id="data">')[1].split("</script>")[0]) if 'id="data">' in html else None
    if data is not None:
        (m,) = data["motions"]
        assert m["aloft"] and not m["two"] and m["phases"][0][1] == 2 and len(m["low"]) == 8


def test_a_page_draws_a_stone_where_it_flies_and_no_force_in_the_air(hops, shown):
    page = shown(sc.view(hops), "#t=0.2", viewport={"width": 160, "height": 120})
    t = np.linspace(*span(hops), 301)[1:]
    told = "t => JSON.stringify(t.map(t => window.spincyl.pose(0, t)))"
    poses = json.loads(page.evaluate(told, t.tolist()))
    there = hops.wanting("pose", "force", t=t)
    matrix = np.array([pose["matrix"] for pose in poses]).reshape(-1, 4, 4).transpose(0, 2, 1)
    assert np.abs(matrix[:, :3, 3] - there.centre).max() < 0.01
    assert np.abs(matrix[:, :3, :3] - Rotation.from_quat(there.orientation).as_matrix()).max() < 6e-3
    assert np.abs(np.array([pose["height"] for pose in poses]) - there.height).max() < 0.01
    flies = there.phase == 2
    for force in ("normal", "friction"):
        assert not np.linalg.norm([pose[force] for pose in poses], axis=1)[flies].any()
    assert "high" in page.inner_text("body").replace("\xa0", " ") and page.complaints == []


def test_a_figure_of_a_stone_has_its_height_and_its_impacts(hops):
    tilt, path, force = sc.plot.motion(hops)
    labels = [ax.get_ylabel() for ax in tilt.figure.axes]
    assert any("height of its lowest point" in x for x in labels) and not any("spin" in x for x in labels)
    names = [x.get_text() for x in tilt.get_legend().get_texts()]
    assert "in the air" in names and "impact" in names
    assert len(force.lines) >= 2 and path.get_legend()


def test_a_still_and_a_scene_for_other_programs_are_written(hops, tmp_path):
    for name in ("egg.png", "egg.glb"):
        sc.view(hops).save(tmp_path / name, **({"t": 0.2} if name.endswith("png") else {}))
        assert (tmp_path / name).stat().st_size > 1000


def test_a_scene_has_the_flight_the_impacts_and_the_heights(hops):
    data = sc.scene(hops, scale=sc.Scale(0.03, 0.05)).data
    known = data["expected"]
    z, time = np.array(known["position"])[:, 2], np.array(known["time"])
    v = np.array(known["velocity"])
    first = known["impacts"][0]["time"]
    flight = time < first
    fall = z[0] + v[0, 2] * time - 9.80665 * time**2 / 2
    assert np.abs(z - fall)[flight].max() < 1e-12
    assert np.allclose(v[flight, 2], v[0, 2] - 9.80665 * time[flight], atol=1e-11)
    assert len(known["impacts"]) >= 3 and all(x["normal_impulse"] > 0 for x in known["impacts"])
    assert known["height"][0] == pytest.approx(0.5 * 0.03)
    assert known["phases"][0] == {"time": 0.0, "kind": "flying"}
    assert data["table"]["restitution"] == 0.5 and data["body"]["shape"]["type"] == "ellipsoid"


def test_of_a_stone_only_impacts_are_heard(hops, tmp_path):
    unit = sc.Scale(0.03)
    with wave.open(str(hops.sound(tmp_path / "hops.wav", scale=unit, rate=8000))) as file:
        heard = np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(float)
    first = int(hops.impacts[0].time * unit.seconds(1.0) * 8000)
    assert np.abs(heard[: first - 1]).max() == 0 and np.abs(heard[first : first + 200]).max() > 100
    m = sc.roll(PEBBLE, PEBBLE.spinning(0.3, pitch=0.1), np.linspace(0, 2, 21), contact=GRIP)
    with pytest.raises(
        ValueError, match="^motion: there is nothing to hear, since the stone strikes nothing"
    ):
        m.sound(tmp_path / "still.wav", scale=unit)
