"""Rolling resistance that acts only where the body rolls, in Python: motions, sweeps, scenes, fits and refusals."""

import json

import numpy as np
import pytest

import spincyl as sc
from spincyl.lab._vary import with_numbers
from spincyl.loss import AirLinear, Drilling, RollingResistance

ONLY = RollingResistance(0.01, while_slipping=False)
BALL = sc.Body.ball(0.0, 0.4, 0.4)
STRUCK = sc.thrown(BALL, 3.0, 0.0)
CLOTH = sc.Coulomb(0.2)


def test_a_law_says_when_it_acts():
    assert repr(ONLY) == "RollingResistance(0.01, while_slipping=False)"
    assert eval(repr(ONLY)) == ONLY != RollingResistance(0.01)
    assert hash(ONLY) != hash(RollingResistance(0.01))
    assert repr(ONLY + AirLinear(0.1)) == f"{ONLY!r} + AirLinear(0.1)"
    assert ONLY + AirLinear(0.1) != RollingResistance(0.01) + AirLinear(0.1)
    assert RollingResistance(0.02, while_slipping=False) == ONLY + ONLY
    assert str(ONLY) == "RollingResistance(0.01, while_slipping=False)"
    cue = sc.Scale(0.028)
    in_si = RollingResistance.from_si("0.28mm", scale=cue, while_slipping=False)
    assert in_si.while_slipping is False and in_si.delta == pytest.approx(0.01, rel=1e-14)


def test_two_laws_that_act_at_unlike_times_are_not_added():
    with pytest.raises(ValueError, match=r"^laws: .*expected the same while_slipping of both"):
        ONLY + RollingResistance(0.01)
    with pytest.raises(TypeError, match="^while_slipping: expected True or False"):
        RollingResistance(0.01, while_slipping=0)  # type: ignore[arg-type]


def test_a_struck_ball_rolls_when_it_would_without_resistance_and_stops_by_closed_form():
    v, mu, delta = 3.0, CLOTH.mu, 0.01
    m = sc.roll(BALL, STRUCK, 500.0, contact=CLOTH, losses=ONLY, want="pose")
    rolls, stops = 2 * v / (7 * mu), 2 * v / (7 * mu) + v / delta
    assert m.phases[1].time == pytest.approx(rolls, rel=1e-12)
    assert m.event.ending == sc.Ending.STOPS and m.event.time == pytest.approx(stops, rel=1e-12)
    at = sc.roll(BALL, STRUCK, [0.0, 0.9 * rolls, 0.999 * stops], contact=CLOTH, losses=ONLY, want="pose")
    whole = 12 * v**2 / (49 * mu) + 5 * v**2 / (14 * delta)
    left = 5 / 14 * delta * (1e-3 * stops) ** 2
    assert np.linalg.norm(at.contact_point[-1]) == pytest.approx(whole - left, rel=1e-12)
    assert at.work_lost[1] == 0 < at.work_lost[2]
    total = at.energy + at.work_lost + at.dissipated
    assert np.ptp(total) < 1e-11 * total[0]


def test_a_sweep_is_the_single_motions_and_repeats_itself():
    speed = np.array([0.5, 1.0, 3.0])
    arm = RollingResistance(np.array([0.01, 0.02, 0.03]), while_slipping=False) + Drilling(0.01)
    starts = sc.State(1.2, 0.2, 0.1, -0.3, slip=(0.4 * speed, speed))
    found = sc.sweep.roll(
        BALL, starts, 12.0, want=("final", "rolling_time", "work_lost"), contact=CLOTH, losses=arm
    )
    for i in range(3):
        state = sc.State(1.2, 0.2, 0.1, -0.3, slip=(float(0.4 * speed[i]), float(speed[i])))
        law = RollingResistance(float(arm.laws[0].delta[i]), while_slipping=False) + Drilling(0.01)
        one = sc.roll(BALL, state, 12.0, contact=CLOTH, losses=law)
        np.testing.assert_allclose(found["rolling_time"][i], one.phases[-1].time, rtol=1e-8)
        np.testing.assert_allclose(found["w3"][i], one.w[-1, 2], atol=1e-8)
        np.testing.assert_allclose(found["work_lost"][i], one.work_lost[-1], atol=1e-8)
    again = sc.sweep.inputs(found)
    assert not again["losses"].laws[0].while_slipping
    assert sc.sweep.roll(want=("final",), **again)["w3"].equals(found["w3"])
    always = RollingResistance(arm.laws[0].delta) + Drilling(0.01)
    later = sc.sweep.roll(BALL, starts, 12.0, want="rolling_time", contact=CLOTH, losses=always)
    assert (abs(later["rolling_time"] - found["rolling_time"]) > 1e-4).all()


def test_a_scene_keeps_the_law_and_its_couple_ends_in_a_slip(tmp_path):
    m = sc.roll(BALL, STRUCK, np.linspace(0.0, 12.0, 30), contact=CLOTH, losses=ONLY, want=("pose", "force"))
    scene = sc.scene(m, scale=sc.Scale(0.028, mass=0.17))
    (told,) = scene.data["table"]["losses"]
    assert told["couple"].endswith(", 0 while the body slips")
    assert scene.data["natural"]["ask"]["resistance"] == "WhileRolling"
    json.dumps(scene.data["natural"])
    pose = m.orientation[1].as_quat() if hasattr(m.orientation[1], "as_quat") else m.orientation[1]
    given = pose, [0.0, 3.0, 0.0], 1.6
    assert np.linalg.norm(scene.couple(*given)) > 1e-4
    assert scene.couple(*given, slips=True).tolist() == [0, 0, 0]


def test_other_numbers_in_a_fit_keep_the_law():
    m = sc.roll(BALL, STRUCK, np.linspace(0.0, 12.0, 5), contact=CLOTH, losses=ONLY)
    made = with_numbers(m, {"RollingResistance": 0.02, "mu": 0.25}, m.t).motion
    assert made.losses == RollingResistance(0.02, while_slipping=False)
    assert made.phases[1].time == pytest.approx(2 * 3.0 / (7 * 0.25), rel=1e-12)


def test_a_couple_of_the_users_own_acts_in_the_slip_beside_the_law():
    own = sc.custom.Couple(lambda theta, w, normal: -1e-3 * w)
    both = sc.roll(BALL, STRUCK, 30.0, contact=CLOTH, losses=own + ONLY)
    same = sc.roll(BALL, STRUCK, 30.0, contact=CLOTH, losses=AirLinear(1e-3) + ONLY)
    assert both.phases[1].time == pytest.approx(same.phases[1].time, abs=1e-8)
    assert both.w[-1, 2] == pytest.approx(same.w[-1, 2], abs=1e-8)


@pytest.mark.parametrize("contact", ["smooth", sc.Viscous(0.1), sc.Coulomb(0.2, patch=0.05)])
def test_a_table_on_which_no_body_rolls_is_refused(contact):
    for run in (sc.roll, sc.sweep.roll):
        with pytest.raises(ValueError, match=r"^losses = .*while_slipping=False needs contact=sc.Coulomb"):
            run(BALL, sc.State(1.0, 0.1, 0.1, 0.1), 1.0, contact=contact, losses=ONLY)


def test_stones_and_pages_to_play_with_refuse_it():
    stone = sc.Ellipsoid.uniform((1.0, 0.6, 0.5))
    start = sc.EllipsoidState((0.0, 0.0, 1.0), (0.1, 0.1, 1.0))
    with pytest.raises(ValueError, match="^losses = .*bodies of revolution, not stones"):
        sc.roll(stone, start, 1.0, contact=CLOTH, losses=ONLY)
    with pytest.raises(ValueError, match="^losses = .*expected while_slipping=True"):
        sc.play(sc.Body.solid(0.3), contact=CLOTH, losses=ONLY)


def test_a_resistance_that_friction_cannot_balance_is_refused():
    much = RollingResistance(0.1, while_slipping=False)
    with pytest.raises(ValueError, match=r"^delta = 0\.1: expected a smaller arm"):
        sc.roll(BALL, sc.State(np.pi / 2, 0.0, 0.0, 1.0), 1.0, contact=sc.Coulomb(0.05), losses=much)


def test_a_can_on_its_side_ends_where_its_second_rim_lands():
    can = sc.Body.solid(1.0)
    m = sc.roll(
        can, sc.State(1.4, 0.0, -0.2, 1.0), 20.0, contact=sc.Coulomb(0.3), restitution=0.0, losses=ONLY
    )
    assert m.event.ending == sc.Ending.SIDE
