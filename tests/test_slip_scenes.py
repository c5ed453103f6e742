"""The slipping scenes of examples/ against closed forms, published numbers and conserved quantities."""

import eulers_disk_with_slip
import falling_pencil
import flicked_coin
import flicked_tube
import hula_hoop
import numpy as np
import pytest
import tippe_top_turns

import spincyl as sc


def slid(scene, **how):
    return sc.roll(scene.body, scene.start, scene.t, contact=scene.table, **how)


def kinds(motion):
    return [phase.kind for phase in motion.phases]


@pytest.mark.parametrize(
    "scene", [eulers_disk_with_slip, falling_pencil, flicked_coin, flicked_tube, hula_hoop, tippe_top_turns]
)
def test_what_is_lost_in_slipping_is_heat(scene):
    m = slid(scene)
    total = m.energy + m.dissipated
    assert np.ptp(total) < 1e-13 * total[0] and (np.diff(m.dissipated) > -1e-15).all()
    assert m.dissipated[-1] > 1e-3


# a hula hoop


@pytest.mark.parametrize("mu", [0.1, 0.4, 0.9])
@pytest.mark.parametrize("backspin", [3.0, 6.0, 14.0])
def test_a_hula_hoop_does_as_the_closed_form_says(mu, backspin):
    body, scale = hula_hoop.body, hula_hoop.scale
    expected = hula_hoop.law(2.5, backspin, mu)
    grips = expected.grips / scale.seconds(1.0)
    m = sc.roll(
        body,
        sc.thrown(body, 2.5, backspin, scale=scale),
        np.array([0.0, 0.5 * grips, 2.0 * grips]),
        contact=sc.Coulomb(mu),
        want="pose",
    )
    assert kinds(m) == ["slipping", "rolling"]
    rolls = m.phases[-1]
    assert scale.seconds(rolls.time) == pytest.approx(expected.grips, rel=1e-14)
    speed = scale.metres_per_second(body.centre_velocity(rolls.state)[1])
    assert speed == pytest.approx(expected.velocity, abs=1e-14 * 2.5 * 4)
    away = scale.metres(m.centre[:, 1])
    half = expected.grips / 2
    assert away[1] == pytest.approx(2.5 * half - mu * scale.gravity * half**2 / 2, rel=1e-13)
    assert away[2] == pytest.approx(expected.distance + expected.velocity * expected.grips, rel=1e-12)
    assert scale.joules(m.dissipated[-1]) == pytest.approx(expected.heat, rel=1e-13)


def test_the_hula_hoop_comes_back_to_the_hand():
    expected = hula_hoop.law(hula_hoop.VELOCITY, hula_hoop.BACKSPIN, hula_hoop.table.mu)
    m = slid(hula_hoop, want="pose").at(np.array([0.0, expected.back]) / hula_hoop.scale.seconds(1.0))
    assert m.centre[1] == pytest.approx(m.centre[0], abs=1e-12)
    assert expected.turns_back < expected.grips < expected.back < 2


def test_a_hula_hoop_comes_back_if_its_rim_moves_faster_than_its_centre_over_i3():
    body = hula_hoop.body
    for factor, back in ((1 - 1e-9, False), (1 + 1e-9, True)):
        start = sc.thrown(body, 1.0, factor / body.i3)
        rolls = sc.roll(body, start, 10.0, contact=sc.Coulomb(0.3)).phases[-1]
        assert (body.centre_velocity(rolls.state)[1] < 0) == back


def test_an_upright_hoop_rolls_stably_above_its_least_speed_and_the_one_that_comes_back_does():
    body, scale = hula_hoop.body, hula_hoop.scale
    least = hula_hoop.least_speed() / scale.metres_per_second(1.0)
    for factor, stable in ((1 - 1e-6, False), (1 + 1e-6, True)):
        rolling = sc.State(np.pi / 2, 0.0, 0.0, factor * least)
        assert (body.stability(rolling, "rolling") > 0) == stable
    expected = hula_hoop.law(hula_hoop.VELOCITY, hula_hoop.BACKSPIN, hula_hoop.table.mu)
    assert -expected.velocity > hula_hoop.least_speed()


# the paper's tube


def test_the_centre_of_a_flicked_tube_comes_nearly_to_rest_by_itself():
    m = slid(flicked_tube)
    rolls = m.phases[-1]
    late = m.t >= rolls.time
    speed = flicked_tube.centre_speed(m)
    assert m.success and rolls.kind == "rolling"
    assert 0.8 < flicked_tube.scale.seconds(rolls.time) < 2.3
    assert 6 < speed[0] < 12
    assert speed[late].min() > 0.01 and speed[late].max() < 0.2


def test_a_flicked_tube_shows_six_letters_in_the_end():
    m = slid(flicked_tube, want="pose")
    late = m.t >= m.phases[-1].time
    seen = flicked_tube.still_symbols(m)[late]
    assert (np.round(seen) == 6).all()
    psi, phi = m.psi[late], m.phi[late]
    assert (psi[-1] - psi[0]) / (phi[-1] - phi[0]) == pytest.approx(6, abs=0.02)
    theta = np.degrees(m.theta[late])
    assert theta.min() > 83 and theta.max() < 86


def test_the_end_that_the_finger_pressed_is_the_one_that_rises_and_the_table_bears_the_tube_throughout():
    m = slid(flicked_tube, want="force")
    assert sc.launch_number(flicked_tube.body, flicked_tube.start) == pytest.approx(1.105, abs=0.001)
    assert m.theta[1] < np.pi / 2 and m.normal.min() > 0.5


@pytest.mark.parametrize("mu", [0.15, 0.3])
def test_friction_needs_about_one_and_a_half_times_the_speed_over_mu_to_stop_a_flicked_tube(mu):
    body, start = flicked_tube.body, flicked_tube.start
    m = sc.roll(body, start, flicked_tube.t, contact=sc.Coulomb(mu))
    speed = np.hypot(*body.centre_velocity(start))
    assert 1.35 < m.phases[-1].time * mu / speed < 1.5


def test_a_flicked_tube_rolls_on_for_a_billion_units_as_it_did_after_the_slip():
    m = slid(flicked_tube)
    rolls = m.phases[-1]
    swing = sc.swing(flicked_tube.body, rolls.state)
    later = m.at(np.concatenate([[0.0], 1e9 + np.linspace(0, 2 * swing.period, 400)]))
    early = m.theta[m.t >= rolls.time]
    assert later.success and later.nfev == m.nfev
    for theta in (early, later.theta[1:]):
        assert theta.min() == pytest.approx(swing.theta_min, abs=1e-4)
        assert theta.max() == pytest.approx(swing.theta_max, abs=1e-4)


@pytest.mark.parametrize(
    ("impulse", "angle", "finger", "ends"),
    [
        (6.0, 60.0, 0.3, "stays lying"),
        (8.0, 50.0, 0.3, "stays lying"),
        (9.0, 50.0, 0.3, "lies down again"),
        (8.0, 60.0, 0.6, "lies down again"),
        (8.0, 60.0, 0.3, "settles"),
        (9.0, 60.0, 0.3, "settles"),
        (10.0, 50.0, 0.3, "settles"),
        (9.0, 60.0, 0.6, "slips now and then"),
        (12.0, 60.0, 0.3, "hops"),
        (10.0, 60.0, 0.6, "hops"),
    ],
)
def test_a_weak_flick_stays_lying_a_good_one_settles_and_a_strong_one_hops(impulse, angle, finger, ends):
    body, start = flicked_tube.body, flicked_tube.pushed(impulse, angle, finger)
    m = sc.roll(body, start, flicked_tube.t, contact=flicked_tube.table)
    assert flicked_tube.outcome(m) == ends
    assert (sc.launch_number(body, start) > 1) == (ends != "stays lying")


# a coin


def test_a_coin_flicked_on_edge_slips_rolls_falls_slips_and_rolls_round_nearly_steadily():
    m = slid(flicked_coin)
    assert m.success and kinds(m) == ["slipping", "rolling", "slipping", "rolling"]
    nods = np.degrees(m.theta[m.t >= m.phases[-1].time])
    assert nods.min() > 30 and np.ptp(nods) < 1


def test_friction_lifts_a_flicked_coin_off_its_other_rim_where_it_exceeds_ell():
    # I3 w1 w3 - F_h > ell with w3 = 0, F_h = -mu cos(alpha) and N = 1
    body, start = flicked_coin.body, flicked_coin.start
    along, across = start.slip
    least = body.ell * np.hypot(along, across) / along
    for factor, rises in ((1 - 1e-9, False), (1 + 1e-9, True)):
        m = sc.roll(body, start, [0.0, 1e-3], contact=sc.Coulomb(factor * least))
        assert (m.event is None) == rises
        assert rises or (m.status == sc.Ending.SIDE and m.event.time == 0)


def test_a_coin_that_is_flicked_fast_rocks_on_both_rims_and_the_landings_make_heat_too():
    body, start = flicked_coin.body, flicked_coin.flicked(10.0)
    m = sc.roll(body, start, flicked_coin.t, contact=flicked_coin.table, restitution=0.0)
    ends = sc.roll(body, start, flicked_coin.t, contact=flicked_coin.table)
    assert ends.status == sc.Ending.SIDE and m.success
    before, after = m.at([0.0, ends.event.time]), m.phases
    assert before.phases[0].time == 0 and any(abs(p.time - ends.event.time) < 1e-12 for p in after)
    assert np.ptp(m.energy + m.dissipated + m.lost_in_impacts) < 1e-12


# Euler's disk


def test_the_centre_of_eulers_disk_starts_at_rest_while_its_edge_slides_round_a_circle():
    body, start = eulers_disk_with_slip.body, eulers_disk_with_slip.start
    assert np.hypot(*body.centre_velocity(start)) < 1e-15 and abs(start.spin) < 1e-15
    reach = body.ell * np.sin(start.theta) - (1 - body.fillet) * np.cos(start.theta)
    assert start.slip == pytest.approx((0.0, start.precession * reach), abs=1e-15)


def test_eulers_disk_slips_and_then_nods_for_good():
    m = slid(eulers_disk_with_slip, want="force")
    assert m.success and kinds(m) == ["slipping", "rolling"]
    rolling = m.t >= m.phases[-1].time
    assert m.friction_coefficient[rolling].max() < eulers_disk_with_slip.table.mu
    assert m.friction_coefficient[~rolling] == pytest.approx(eulers_disk_with_slip.table.mu, rel=1e-9)
    swing = sc.swing(eulers_disk_with_slip.body, m.phases[-1].state)
    assert m.theta[rolling].min() == pytest.approx(swing.theta_min, abs=1e-4)
    assert m.theta[rolling].max() == pytest.approx(swing.theta_max, abs=1e-4)
    assert swing.theta_min > 0.8 and swing.theta_max < 1.2


def test_friction_turns_angular_momentum_about_the_axis_into_that_about_the_vertical():
    # for any law of friction A dLz = -g0 d(I3 w3)
    body = eulers_disk_with_slip.body
    m = slid(eulers_disk_with_slip)
    m = m.at(np.linspace(0.0, m.phases[-1].time, 4001))
    sin, cos, rim = np.sin(m.theta), np.cos(m.theta), 1 - body.fillet
    spin = body.i3 * m.w[:, 2]
    vertical = body.i1 * m.w[:, 0] * sin + spin * cos
    ratio = (body.ell * sin - rim * cos) / (rim + body.fillet * sin)
    passed = -((ratio[1:] + ratio[:-1]) / 2 * np.diff(spin)).sum()
    assert vertical[-1] - vertical[0] == pytest.approx(passed, abs=1e-6)
    assert abs(passed) > 0.05


# a tippe top


@pytest.mark.parametrize("table", [tippe_top_turns.wet, tippe_top_turns.dry])
def test_jelletts_constant_knows_no_friction(table):
    m = sc.roll(tippe_top_turns.body, tippe_top_turns.start, tippe_top_turns.t, contact=table)
    assert np.ptp(tippe_top_turns.jellett(m)) < 1e-13


def test_a_tippe_top_on_a_wet_table_turns_over():
    m = sc.roll(tippe_top_turns.body, tippe_top_turns.start, tippe_top_turns.t, contact=tippe_top_turns.wet)
    assert m.success and kinds(m) == ["slipping"]
    assert m.theta[0] < 0.11 and np.degrees(m.theta[-1]) > 178
    # on its head, w3 has the other sign in the axes of the body, and the spin is slower
    assert m.w[-1, 2] < 0 and abs(m.w[-1, 2]) < m.w[0, 2]


def test_a_tippe_top_on_a_dry_table_soon_rolls_and_does_not_turn_over():
    m = sc.roll(
        tippe_top_turns.body,
        tippe_top_turns.start,
        tippe_top_turns.t,
        contact=tippe_top_turns.dry,
        want="force",
    )
    assert m.success and kinds(m) == ["slipping", "rolling"]
    rolls = m.phases[-1]
    assert rolls.time == pytest.approx(0.92, abs=0.005)
    assert tippe_top_turns.scale.seconds(rolls.time) == pytest.approx(0.036, abs=0.0005)
    rolling = m.t >= rolls.time
    assert np.degrees(m.theta[rolling].max()) < 3
    assert m.friction_coefficient[rolling].max() < 0.04 < tippe_top_turns.dry.mu


# a pencil


def test_a_falling_pencil_pivots_as_the_closed_form_says():
    m = sc.roll(falling_pencil.body, falling_pencil.start, falling_pencil.t, want="force")
    lean = m.theta - falling_pencil.body.theta_balance
    normal, friction = falling_pencil.law(lean, 0.01)
    assert m.normal == pytest.approx(normal, abs=1e-12)
    assert m.friction == pytest.approx(np.abs(friction), abs=1e-12)


def test_a_pencil_let_go_upright_needs_a_friction_of_0_37058_at_35_097_degrees():
    m = sc.roll(
        falling_pencil.body, falling_pencil.let_go(1e-4), np.linspace(50, 56, 60001), t0=0, want="force"
    )
    lean = np.degrees(m.theta - falling_pencil.body.theta_balance)
    back = lean < np.degrees(np.arccos(2 / 3))
    most = np.argmax(np.where(back, m.friction_coefficient, 0))
    assert m.friction_coefficient[most] == pytest.approx(0.37058, abs=5e-6)
    assert lean[most] == pytest.approx(35.097, abs=0.01)


def test_the_friction_under_a_falling_pencil_turns_round_where_the_cosine_is_two_thirds():
    lean = np.arccos(2 / 3)
    assert falling_pencil.law(lean)[1] == pytest.approx(0, abs=1e-15)
    assert falling_pencil.law(lean - 1e-3)[1] > 0 > falling_pencil.law(lean + 1e-3)[1]


@pytest.mark.parametrize("mu", [0.1, 0.3, 0.37, 0.371, 0.5, 1.0])
def test_a_pencil_slips_where_the_closed_form_reaches_mu_backwards_on_a_slippery_table(mu):
    m = sc.roll(falling_pencil.body, falling_pencil.start, falling_pencil.t, contact=sc.Coulomb(mu))
    assert kinds(m)[:2] == ["rolling", "slipping"] and m.status == sc.Ending.SIDE
    lean = m.phases[1].state.theta - falling_pencil.body.theta_balance
    normal, friction = falling_pencil.law(lean, 0.01)
    backwards = mu < 0.3706
    assert friction / normal == pytest.approx(mu if backwards else -mu, abs=1e-12)
    assert falling_pencil.way(m) == ("backwards" if backwards else "forwards")
