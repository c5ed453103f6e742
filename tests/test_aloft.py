"""Motions that hop and lie, in Python: one and many, measured bodies, what they hold, and what is refused."""

import itertools

import numpy as np
import pytest

import spincyl as sc

TUBE = sc.Body.tube(6.0, bore=0.8)
COIN = sc.Body.solid(0.08)
GRIP = sc.Coulomb(0.3)


def starts(count, seed):
    """Bodies and states at random: on the table with a slip, and in the air."""
    rng = np.random.default_rng(seed)
    ell = rng.uniform(0.05, 3.0, count)
    body = sc.Body.solid(ell)
    theta, aloft = rng.uniform(0.2, 1.4, count), rng.random(count) < 0.5
    w, slip = rng.normal(size=(3, count)), rng.normal(size=(2, count))
    height = np.where(aloft, rng.uniform(0.0, 1.0, count), 0.0)
    lift = np.where(aloft, rng.normal(size=count), 0.0)
    return body, sc.State(theta, *w, slip=(slip[0], slip[1]), height=height, lift=lift)


@pytest.mark.parametrize("contact", [GRIP, sc.Viscous(0.5), "smooth"])
@pytest.mark.parametrize("e", [0.0, 0.6])
def test_many_motions_are_those_that_are_followed_one_by_one(contact, e):
    body, state = starts(60, 5)
    want = ("final", "end", "impacts", "landings", "air_time", "lost_in_impacts", "last_phase", "dissipated")
    found = sc.sweep.roll(body, state, 6.0, contact=contact, restitution=e, tol=1e-11, want=want)
    for i in range(60):
        one = sc.Body.solid(float(body.ell[i]))
        four = [float(x[i]) for x in (state.theta, state.w1, state.w2, state.w3)]
        slip = tuple(float(x[i]) for x in state.slip)
        start = sc.State(*four, slip=slip, height=float(state.height[i]), lift=float(state.lift[i]))
        m = sc.roll(one, start, [0.0, 6.0], contact=contact, restitution=e, tol=1e-11)
        row = found.isel(motion=i)
        assert int(row.status) == m.status
        if not m.success:
            continue
        doubt = 4 * (m.error + float(row.error)) + 1e-10
        last = [float(row[name]) for name in ("theta", "w1", "w2", "w3")]
        assert np.abs(last - m.y[:, -1]).max() < doubt
        if doubt < 1e-5:
            assert len(m.impacts) == int(row.impacts)
            assert float(row.lost_in_impacts) == pytest.approx(m.lost_in_impacts[-1], abs=10 * doubt)
            assert m.phase[-1] == int(row.last_phase)
        times = np.array([p.time for p in m.phases] + [6.0])
        flies = np.array([p.kind == "flying" for p in m.phases])
        assert float(row.air_time) == pytest.approx(np.diff(times)[flies].sum(), abs=100 * doubt)


def test_energy_and_all_that_is_taken_are_constant_in_natural_units_and_in_si():
    tube = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm", mass="20g")
    t = np.linspace(0, 2, 201)
    m = sc.roll(tube, sc.flicked(tube, hertz=20, launch=2.5), t, contact=GRIP, restitution=0.5)
    for of in (m, m.natural):
        whole = of.energy + of.dissipated + of.lost_in_impacts
        assert np.ptp(whole) < 1e-12 * whole[0]
    assert m.impacts[0].lost == pytest.approx(m.natural.impacts[0].lost * m.scale.joules(1.0), rel=1e-12)
    push, own = m.impacts[0].impulse, m.natural.impacts[0].impulse
    newton_seconds = m.scale.joules(1.0) / m.scale.metres_per_second(1.0)
    assert push == pytest.approx([p * newton_seconds for p in own], rel=1e-12)
    assert m.height.max() == pytest.approx(m.natural.height.max() * m.scale.radius, rel=1e-12)


def test_a_ball_that_is_dropped_comes_to_rest_after_the_sum_of_its_bounces():
    ball, e, height = sc.Body.ball(0.0, 0.4, 0.4), 0.5, 0.8
    m = sc.roll(ball, sc.dropped(ball, height, 1.0), [0.0, 10.0], contact=GRIP, restitution=e)
    over = np.sqrt(2 * height) * (1 + 2 * e / (1 - e))
    assert m.phases[-1].kind == "rolling" and m.phases[-1].time == pytest.approx(over, abs=1e-6)
    assert m.impacts[-1].stays and not any(x.stays for x in m.impacts[:-1])
    assert m.lost_in_impacts[-1] == pytest.approx(height, rel=1e-12)


def test_a_body_is_dropped_with_the_velocity_of_its_centre():
    can = sc.Body.solid(1.5)
    state = sc.dropped(can, 0.7, 1.1, w1=0.3, w2=-0.4, w3=2.0, velocity=(0.5, -0.2, 1.0))
    assert can.centre_velocity(state) == pytest.approx((0.5, -0.2), abs=1e-15)
    m = sc.roll(can, state, np.linspace(0, 1.5, 16), contact=GRIP, restitution=0.3, want="pose")
    rises = m.centre[:, 2] - m.centre[0, 2]
    assert rises == pytest.approx(m.t - m.t**2 / 2, abs=1e-14)
    size = sc.Scale(radius=0.03)
    same = (
        sc.dropped(can, 0.7 * 0.03, 1.1, w3=size.radians_per_second(2.0), scale=size)
        if hasattr(size, "radians_per_second")
        else sc.dropped(can, 0.021, 1.1, w3=2.0 / size.seconds(1.0), scale=size)
    )
    assert same.height == pytest.approx(0.7, rel=1e-14) and same.w3 == pytest.approx(2.0, rel=1e-14)


def test_a_coin_that_is_dropped_without_spin_on_its_edge_stands_there_bounces_and_rolls():
    m = sc.roll(COIN, sc.thrown(COIN, 1.0, -1.0), 50.0, contact=GRIP, restitution=0.0)
    assert [p.kind for p in m.phases] == ["rolling on its side"]
    assert m.w[-1, 2] == pytest.approx(1.0, abs=1e-14)


def test_what_is_dropped_flat_lands_on_its_face_and_what_tumbles_from_upright_passes_the_vertical():
    can = sc.measured(outer_diameter="10cm", length="20cm", mass=1.2, gravity=9.81)
    flat = sc.dropped(can, 0.4, np.array([0.0, np.pi]), w3=3.0)
    for theta in (0.0, np.pi):
        m = sc.roll(can, sc.dropped(can, 0.4, theta, w3=3.0), [0.0, 3.0], contact=GRIP, restitution=0.3)
        # friction stops its spin in the first bounce, and all bounces last 2 e/(1 - e) times the fall
        assert m.status == sc.Ending.STOPS
        assert abs(m.event.time - np.sqrt(2 * 0.4 / 9.81) * (1 + 0.6 / 0.7)) < 1e-13
    many = sc.sweep.roll(can, flat, [0.0, 3.0], contact=GRIP, restitution=0.3, want="end")
    assert (many.status == sc.sweep.Status.STOPS).all()
    assert np.abs(many.end - m.event.time).max() < 1e-13
    ends = []
    for theta in (0.0, 1e-7):
        start = sc.dropped(can, 0.4, theta, w2=-0.1, velocity=(0.0, 1.0, 0.0))
        ends.append(sc.roll(can, start, [0.0, 3.0], contact=GRIP, restitution=0.0).phases[-1])
    assert ends[0].kind == ends[1].kind == "rolling on its side"
    assert 0 < abs(ends[0].time - ends[1].time) < 1e-6


@pytest.mark.parametrize(
    ("body", "start", "why"),
    [
        (
            sc.Body.ball(-0.2, 0.4, 0.4),
            sc.State(0.0, 0.0, 0.0, 1.0),
            "on its pole .*start it at theta = 1e-6",
        ),
        (COIN, sc.State(0.0, 1.0, 0.0, 1.0, height=1.0), "w1 = 1.0: expected 0 at theta = 0 or pi"),
        (
            sc.Body.tube(2.0, 0.0, 1.0),
            sc.State(0.0, 0.0, 0.0, 1.0, height=1.0),
            "theta = 0.0: expected an inclination of at least 1e-8",
        ),
    ],
)
def test_an_upright_start_without_a_motion_is_refused_with_what_to_do(body, start, why):
    with pytest.raises(ValueError, match=why):
        sc.roll(body, start, 3.0, contact=GRIP, restitution=0.5)


def test_a_capsule_and_a_ball_that_hardly_lean_fall_without_an_error():
    for body in (sc.Body.tube(2.0, 0.0, 1.0), sc.Body.ball(0.3, 0.4, 0.4), sc.Body.ball(-0.3, 0.4, 0.4)):
        for w, more in itertools.product(
            [(0, 0, 0), (0, 0.3, 0), (0, 0, 3.0), (1e-9, 0.3, 2e-9)], [{}, {"restitution": 0.0}]
        ):
            m = sc.roll(body, sc.State(1e-8, *w), np.linspace(0, 40, 81), contact=GRIP, **more)
            assert m.status in (sc.Ending.DONE, sc.Ending.SIDE)
            struck = [sum(hit.lost for hit in m.impacts if hit.time < t) for t in m.t] if more else 0.0
            assert np.ptp(m.energy + m.dissipated + struck) < 1e-9


def test_forces_are_zero_in_the_air_and_those_of_both_rims_hold_the_weight():
    t = np.linspace(0, 40, 401)
    m = sc.roll(TUBE, sc.flicked(TUBE, w1=3.0, launch=0.9), t, contact=GRIP, restitution=0.0, want="force")
    lies = np.isin(m.phase, (3, 4, 5))
    assert lies.any() and not lies.all()
    assert m.normal[lies] + m.normal_other[lies] == pytest.approx(1.0, abs=1e-13)
    assert np.isnan(m.normal_other[~lies]).all() and np.isnan(m.slip_other[~lies]).all()
    hops = sc.roll(TUBE, sc.flicked(TUBE, w1=3.0, launch=3.0), t, contact=GRIP, restitution=0.5, want="force")
    flies = hops.phase == 2
    assert flies.any() and (hops.normal[flies] == 0).all() and (hops.friction[flies] == 0).all()
    assert (hops.height[flies] > 0).mean() > 0.9 and (hops.height[~flies] == 0).all()


def test_the_outcome_of_a_flick_that_goes_on_is_what_the_motion_says():
    rates, launches = [6.0, 12.0, 25.0], [0.6, 1.2, 2.0, 3.5]
    tube = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm")
    found = sc.sweep.flicks(tube, 8.0, hertz=rates, launch=launches, contact=GRIP, restitution=0.0)
    for i, hertz in enumerate(rates):
        for k, launch in enumerate(launches):
            m = sc.roll(
                tube, sc.flicked(tube, hertz=hertz, launch=launch), 8.0, contact=GRIP, restitution=0.0
            )
            flies = any(phase.kind == "flying" for phase in m.phases)
            rim, hopped = m.phases[-1].kind in ("rolling", "slipping"), flies
            told = sc.sweep.Outcome(int(found["outcome"][i, k]))
            settles = "HOPS_AND_SETTLES" if hopped else "SETTLES"
            assert told.name == (settles if rim else "HOPS_AND_LIES" if hopped else "LIES_DOWN"), (
                hertz,
                launch,
            )


@pytest.mark.parametrize(
    ("how", "why"),
    [
        ({"restitution": None}, "^state: the body is in the air, height = 0.5: give restitution"),
        ({"restitution": -0.1}, "^restitution = -0.1: expected None, or 0 <= restitution <= 1"),
        ({"restitution": np.nan}, "^restitution = NaN: expected None, or"),
        (
            {"restitution": 0.5, "contact": "rolling", "step": 1e-3},
            "^step = 0.001 cannot be combined with restitution=",
        ),
        ({"restitution": 0.5, "t": [0.0, -1.0]}, "^t = -1.0: expected times after t0"),
        (
            {"restitution": 0.5, "state": sc.State(2.5, 0, 0, 0, height=0.5)},
            "^height = -0.5: expected all rims",
        ),
        (
            {"restitution": 0.5, "state": sc.State(1.0, 0, 0, 0, height=-0.5)},
            "^height = -0.5: expected 0 to 1e6 R",
        ),
        (
            {"restitution": 0.5, "body": sc.Body(1.0, 0.5, 0.5, theta_end=1.2)},
            "^theta_end = 1.2: expected a body that lands on its rims",
        ),
    ],
)
def test_a_start_in_the_air_that_makes_no_sense_is_refused_by_name(how, why):
    call = {
        "body": sc.Body.solid(1.0),
        "state": sc.State(1.0, 0, 0, 0, height=0.5),
        "t": 1.0,
        "contact": GRIP,
    }
    with pytest.raises(ValueError, match=why):
        sc.roll(**(call | how))


def test_numbers_of_a_body_on_the_table_refuse_a_state_in_the_air():
    state = sc.dropped(COIN, 1.0, 1.2)
    with pytest.raises(
        ValueError, match="^state: the body is in the air, height = 1.0: expected a body on the table"
    ):
        COIN.acceleration(state)
    assert COIN.energy(state) == pytest.approx(COIN.energy(sc.State(1.2, 0, 0, 0)) + 1.0, abs=1e-15)
    m = sc.roll(COIN, COIN.steady(1.3), 1.0)
    with pytest.raises(
        AttributeError, match="^height: needs restitution=; this motion ends where it leaves the table"
    ):
        _ = m.height
    with pytest.raises(AttributeError, match="^impacts: needs restitution="):
        _ = m.impacts


ODD = {
    "can": sc.Body.solid(1.0),
    "disk": sc.Body.solid(0.0),
    "rounded": sc.Body.solid(1.0, fillet=0.3),
    "balls": sc.Body.balls(),
}


# with restitution 1 a hop of 1e-300 is followed by others without end
@pytest.mark.filterwarnings("ignore:given up")
@pytest.mark.parametrize("name", ODD)
@pytest.mark.parametrize("contact", [GRIP, sc.Viscous(0.3)], ids=repr)
def test_from_the_oddest_starts_nothing_is_lost_but_what_is_told(name, contact):
    places = (
        {},
        *({"height": h, "lift": v} for h, v in ((0.0, 0.0), (1e-300, 0.0), (0.0, 1e-300), (1.0, -1.0))),
    )
    rates = ((0.0, 0.0, 0.0), (1e-300, 0.0, 0.0), (0.0, -0.1, 0.0), (1.0, 0.0, 0.5))
    seen = 0
    for restitution, place, theta, w in itertools.product(
        (0.0, 0.5, 1.0), places, (np.pi / 2, 1.2, 0.1), rates
    ):
        start = sc.State(theta, *w, slip=(1e-300, 0.0), **place)
        try:
            m = sc.roll(ODD[name], start, [0.0, 0.5, 2.0], contact=contact, restitution=restitution)
        except ValueError:
            continue
        seen += 1
        assert m.event is not None or m.t.tolist() == [0.0, 0.5, 2.0]
        if m.t.size:
            assert np.isfinite(m.y).all() and m.w[0] == pytest.approx(w, abs=1e-12)
            whole = m.energy + m.dissipated + m.lost_in_impacts
            assert np.ptp(whole) <= 1e-11 + m.error, (start, restitution, m)
    assert seen > 100


def test_a_flight_gives_its_last_output_however_the_times_round():
    body, contact = sc.Body(0.6, 0.53, 0.82), sc.Viscous(0.3)
    start = sc.State(2.005, 0.976, -0.465, 1.803, slip=(0.267, 1.433), height=0.8138257234955739, lift=0.001)
    for t in (1.813825723495574, *np.random.default_rng(51).uniform(0.9, 1.9, 300)):
        assert sc.roll(body, start, [0.0, 0.5, t], contact=contact, restitution=0.95).t[-1] == t


def test_rims_that_land_in_turn_at_one_time_come_to_rest_on_the_table():
    # So light a body that each landing throws the other rim down; after 40 of them no time passes between two.
    body = sc.Body(1.6915, i1=0.1063, i3=0.1369)
    state = sc.State(1.43742765, -0.03156374, -2.05214869, -0.2437243, slip=(-0.46120243, 0.44447428))
    m = sc.roll(body, state, [0.0, 50.0], contact=sc.Coulomb(0.36484823), restitution=0.3)
    times = np.array([x.time for x in m.impacts])
    assert m.success and (np.diff(times) == 0).sum() > 5
    whole = m.energy + m.dissipated + m.lost_in_impacts
    assert np.ptp(whole) < 1e-12


def test_a_slip_that_jams_is_told_with_its_state_and_without_a_force():
    rod = sc.Body.solid(12.0)
    state = sc.State(0.5465, 0.0, 0.0, 0.0, slip=(1.0, 0.0))
    m = sc.roll(rod, state, [0.0, 0.05], contact=sc.Coulomb(1.5), restitution=0.5, want=("force", "pose"))
    assert m.slip[0].tolist() == [1.0, 0.0] and np.isnan(m.normal[0]) and m.normal[1] == 0
    assert m.impacts[0].time == 0 and m.impacts[0].kind == "sticks"
    whole = m.energy + m.dissipated + m.lost_in_impacts
    assert np.ptp(whole) < 1e-13 and m.phases[0].kind == "flying"


def test_the_height_is_that_of_the_lowest_point_whichever_rim_it_is_on():
    tube = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm", mass="20g")
    radius = tube.scale.radius
    t = np.linspace(0, 0.5, 101)
    for theta in (np.radians(60), np.radians(120)):
        state = sc.dropped(tube, 0.1, theta)
        m = sc.roll(tube, state, t, contact=GRIP, restitution=0.5, want=("pose", "force"))
        reach = radius * (6 * np.abs(np.cos(m.theta)) + np.sin(m.theta))
        assert m.height[0] == pytest.approx(0.1, rel=1e-14)
        assert np.abs(m.height - (m.centre[:, 2] - reach)).max() < 1e-12
        assert np.isnan(m.friction_coefficient[m.phase == 2]).all()
    for height in (-0.1, np.nan, np.inf, [0.1, -1.0]):
        with pytest.raises(ValueError, match="height = .*expected 0 <= height, finite"):
            sc.dropped(tube, height, 1.0)


@pytest.mark.parametrize("e", [0.0, 0.5])
def test_a_body_that_turns_as_it_starts_on_both_rims_loses_what_it_has_in_a_sweep_too(e):
    body = sc.Body.solid(1.0)
    level = np.pi / 2
    for w2, lift in ((2.0, -2.0), (-0.7, -0.3), (1.0, -2.5)):
        start = sc.State(level, 0.3, w2, -0.4, slip=(0.1, 0.2), height=0.0, lift=lift)
        m = sc.roll(body, start, np.linspace(0, 5, 51), contact=GRIP, restitution=e)
        whole = m.energy + m.dissipated + m.lost_in_impacts
        assert np.ptp(whole) < 1e-12
        hit = m.impacts[0]
        assert min(abs(hit.before.lift - x) for x in (lift, lift + 2 * w2)) < 1e-15
        found = sc.sweep.roll(
            body, start, 5.0, contact=GRIP, restitution=e, tol=1e-11, want=("final", "lost_in_impacts")
        )
        doubt = 10 * (m.error + float(found.error)) + 1e-10
        assert float(found.lost_in_impacts) == pytest.approx(m.lost_in_impacts[-1], abs=doubt)


def test_a_can_dropped_exactly_on_its_side_bounces_level_over_its_spot():
    can = sc.measured(outer_diameter="12cm", length="12cm", mass=1.357)
    t = np.linspace(0, 2, 401)
    for e in (0.0, 0.5, 1.0):
        m = sc.roll(
            can, sc.dropped(can, 0.24, np.pi / 2), t, contact=sc.Coulomb(0.5), restitution=e, want="pose"
        )
        assert np.ptp(m.centre[:, :2], axis=0) == pytest.approx(0, abs=1e-15)
        assert (m.theta == np.pi / 2).all()
        again = m.t > m.impacts[0].time
        assert m.height[again].max() == pytest.approx(0.24 * e * e, abs=2e-4)
        assert m.height.min() >= 0


@pytest.mark.parametrize("e", [0.0, 0.5])
def test_no_force_is_told_where_a_motion_begins_with_an_impact_that_lifts_a_rim(e):
    can = sc.Body.tube(2.0, bore=0.75)
    start = sc.State(np.pi / 2, 0.0, -1.35, 0.0)
    m = sc.roll(can, start, np.linspace(0, 1.5, 16), contact=GRIP, restitution=e, want=("pose", "force"))
    assert m.impacts[0].time == 0.0
    assert m.theta[0] == np.pi / 2 and np.array_equal(m.w[0], [0.0, -1.35, 0.0])
    for force in (m.normal, m.friction, m.contact_force[:, 2]):
        assert np.isnan(force[0])
        assert (force[1:] >= 0).all()


@pytest.mark.parametrize(
    "body, state, e",
    [
        (TUBE, sc.State(np.pi / 2, 0.0, 0.0, 0.0, slip=(0.3, 0.0)), 0.0),
        (TUBE, sc.State(np.pi / 2, 0.1, 0.0, 0.4, slip=(0.2, 0.3)), 0.0),
        (sc.Body.solid(0.5), sc.State(0.5, 0.3, 0.1, 0.4, slip=(0.3, 0.2)), None),
    ],
)
def test_at_the_time_at_which_a_slip_vanishes_the_forces_are_those_of_the_phase_that_follows(body, state, e):
    how = {"contact": GRIP, "restitution": e, "want": "force"}
    time = sc.roll(body, state, 10.0, **how).phases[1].time
    times = [np.nextafter(time, 0), time, np.nextafter(time, 9), time + 1e-9]
    m = sc.roll(body, state, times, t0=0.0, **how)
    forces = [m.normal] if e is None else [m.normal, m.normal_other]
    for force in forces:
        assert np.isfinite(force).all()
        assert np.ptp(force[1:]) < 1e-6
    assert m.phase[0] != m.phase[1] == m.phase[2]
    assert (m.slip[1] == 0).all()


@pytest.mark.parametrize("e", [0.0, 0.2])
@pytest.mark.parametrize("w3", [0.0, 0.7])
def test_a_film_that_presses_one_of_both_rims_into_the_table_makes_it_strike(e, w3):
    # One rim alone would have to carry the body, and its film is so strong that this force would pull it down.
    tube, film = sc.Body.tube(2.3, bore=0.39), sc.Viscous(3.0)
    start = sc.State(np.pi / 2, 0.0, 0.0, w3, slip=(-1.3, -2.0))
    m = sc.roll(tube, start, np.linspace(0, 10, 101), contact=film, restitution=e)
    assert m.status.name == "DONE"
    assert m.impacts[0].time == 0.0 and m.impacts[0].impulse[2] > 0
    whole = m.energy + m.dissipated + m.lost_in_impacts
    assert np.abs(whole - whole[0]).max() < 1e-8


def test_no_force_is_told_where_a_rim_that_rolls_would_have_to_be_pulled_down_before_it_strikes():
    can = sc.Body.solid(0.79315421049904)
    start = sc.State(np.pi / 2, 0.0, -0.9328432526946044, -0.30656294280436863)
    for losses in (None, sc.loss.DryContour(0.0154)):
        m = sc.roll(can, start, [0.0, 1.0], contact=GRIP, restitution=0.9, losses=losses, want="force")
        assert np.isnan(m.normal[0])


def test_the_last_impacts_on_both_rims_give_no_energy_to_a_body_that_rolls_on_one_of_them():
    body, air = sc.Body.solid(0.8433562064003812, fillet=0.3862261533615549), 0.003404214098082521
    start = sc.State(0.7822888573776334, 0.3967129516846794, -0.4044220644955893, -0.8513402372512513)
    how = {"contact": sc.Coulomb(0.9971057892449586), "restitution": 0.5}
    m = sc.roll(body, start, np.linspace(0, 20, 101), losses=sc.loss.AirQuadratic(air), **how)
    assert np.diff(m.dissipated).min() > -1e-9


@pytest.mark.parametrize("losses", [sc.loss.Drilling(0.0027), sc.loss.AirLinear(1e-9), None])
def test_a_ball_that_passes_its_pole_nearer_than_any_time_resolves_goes_on_on_the_other_side(losses):
    # As the ball in the plane through its axis, where the pole is no special place.
    ball = sc.Body(ell=0.4, i1=0.46672793091561615, i3=0.4073817586443443, fillet=1.0)
    how = {"contact": sc.Coulomb(0.7), "losses": losses, "want": "pose"}
    t = np.linspace(0, 8, 101)
    plane = sc.roll(ball, sc.State(0.5, 0.0, 0.0, 0.0), t, **how)
    for near in (1e-8, 1e-12, 1e-14, 1e-17):
        m = sc.roll(ball, sc.State(0.5, 0.7 * near, 0.0, 0.5 * near), t, **how)
        assert m.status.name == "DONE"
        assert m.theta == pytest.approx(plane.theta, abs=1e-7)
        assert m.centre == pytest.approx(plane.centre, abs=1e-6)
        assert m.error < 1e-9
