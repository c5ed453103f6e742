"""A body on its face, from Python: starts, forces, pressure and couple, what topples, and pictures of it."""

import numpy as np
import pytest

import spincyl as sc

TUBE, CAN = sc.Body.tube(0.75, bore=0.8), sc.Body.solid(2.0)
TABLE = sc.Coulomb(0.25)


def slide(t, table=TABLE, body=TUBE, w=1.0, velocity=(1.5, 0.0)):
    return sc.roll(body, sc.spun(body, w, velocity), t, contact=table, want=("pose", "force"))


def test_a_start_on_the_face_has_the_velocity_that_was_given():
    for body, theta in (
        (TUBE, 0.0),
        (sc.Body.frustum(0.7, 1.0, 2.0), 0.0),
        (sc.Body.frustum(0.7, 1.0, 2.0), np.pi),
    ):
        state = sc.spun(body, 2.0, (0.3, -0.1), theta=theta)
        np.testing.assert_allclose(body.centre_velocity(state), (0.3, -0.1), atol=1e-15)
        assert state.w3 * np.cos(theta) == 2.0 and state.w1 == state.w2 == 0.0
    measured = sc.measured(outer_diameter="80mm", inner_diameter="64mm", length="60mm", mass=0.2)
    metre, second = measured.scale.metres(1.0), measured.scale.seconds(1.0)
    state = sc.spun(measured, 2.0 / second, (0.3 * metre / second, 0.0))
    np.testing.assert_allclose([state.w3, *state.slip], [2.0, 0.3, -2.0], rtol=1e-14)


def test_a_start_that_makes_no_sense_is_refused_by_name():
    for given, name in (
        ({"theta": 1.0}, "theta"),
        ({"velocity": 1.0}, "velocity"),
        ({"w": "fast"}, "w"),
    ):
        with pytest.raises((TypeError, ValueError), match=f"^{name}"):
            sc.spun(TUBE, **{"w": 1.0, **given})
    with pytest.raises(ValueError, match="^velocity = -1"):
        sc.tripped(CAN, -1.0)
    with pytest.raises(ValueError, match="^body: expected a body with a face"):
        sc.Body.ball(0.0, 0.4, 0.4).topples(0.3)
    with pytest.raises(ValueError, match="^face = 'square'"):
        sc.Coulomb(0.3, face="square")


def test_the_force_on_a_face_is_that_of_its_momentum_and_the_couple_that_of_its_spin():
    h = 1e-4
    m = slide(2.0 + h * np.array([-1.0, 0.0, 1.0]))
    moves = np.diff(m.centre, axis=0) / h
    np.testing.assert_allclose(
        m.contact_force[1, :2], np.diff(moves, axis=0)[0, :2] / h, rtol=1e-5, atol=1e-6
    )
    assert m.couple[1] == pytest.approx(TUBE.i3 * (m.w[2, 2] - m.w[0, 2]) / (2 * h), rel=1e-7)
    # no horizontal moment about the centre of mass, 0.75 above the table
    np.testing.assert_allclose(m.pressure, -0.75 * m.contact_force[:, :2], rtol=1e-13)
    assert (m.pressure[:, 0] > 0).all() and (m.contact_force[:, 1] < 0).all(), "it veers to its right"


def test_a_slide_without_a_spin_is_that_of_a_point():
    m = slide([0.0, 3.0], w=0.0)
    assert m.centre[1, 0] - m.centre[0, 0] == pytest.approx(1.5 * 3 - 0.25 * 9 / 2, rel=1e-14)
    assert slide(10.0, w=0.0).event.time == pytest.approx(6.0, rel=1e-13)


def test_a_mirror_image_veers_to_the_other_side():
    right, left = slide([0.0, 3.0]), slide([0.0, 3.0], w=-1.0)
    np.testing.assert_allclose(right.centre, left.centre * [1, -1, 1], atol=1e-13)


def test_slide_and_spin_of_a_disk_end_with_the_published_ratio():
    coaster, felt = sc.Body.solid(1e-6), sc.Coulomb(0.2, face="disc")
    for v in (0.3, 3.0):
        end = slide(100.0, felt, coaster, velocity=(v, 0.0)).event.time
        m = slide([0.0, end * (1 - 1e-10)], felt, coaster, velocity=(v, 0.0))
        ratio = np.hypot(*coaster.centre_velocity(m.states))[1] / m.w[1, 2]
        assert ratio == pytest.approx(
            0.653002, abs=2e-4
        )  # Farkas and others, Phys. Rev. Lett. 90, 248302 (2003)


@pytest.mark.parametrize("mu", [0.45, 0.55])
def test_a_body_topples_where_it_is_said_to(mu):
    m = sc.roll(CAN, sc.spun(CAN, 0.0, (1.0, 0.0)), 0.2, contact=sc.Coulomb(mu))
    assert (m.phases[0].kind == "slipping") == bool(CAN.topples(mu)) == (mu > 0.5)


def test_a_body_that_is_close_to_toppling_is_told_so():
    near = sc.roll(CAN, sc.spun(CAN, 0.0, (1.0, 0.0)), 0.2, contact=sc.Coulomb(0.48))
    assert "close to toppling" in near.message
    assert "toppling" not in slide(1.0).message


def test_a_kerb_topples_a_body_that_is_fast_enough():
    z, j = 2.0, CAN.i1 + 5.0
    limit = np.sqrt(2 * j * (np.sqrt(5.0) - z)) / z
    for share, rests in ((0.999, "FACE"), (1.001, "SIDE")):
        m = sc.roll(CAN, sc.tripped(CAN, share * limit), 60.0, contact=sc.Coulomb(1.0), restitution=0.0)
        assert m.rests_on.name == rests


def test_a_rolling_motion_with_a_loss_says_nothing_of_faces():
    coin = sc.Body.solid(0.1)
    m = sc.roll(coin, coin.steady(0.5), 1.0, losses=sc.loss.DryContour(0.01))
    assert "reached" in m.message and "topple" not in m.message


def test_a_sweep_keeps_how_the_table_presses():
    pytest.importorskip("xarray")
    felt, rim = sc.Coulomb(0.25, face="disc"), sc.Coulomb(0.25)
    want, spins = ("end", "rests_on", "final"), [1.0, 2.0]
    found = sc.sweep.roll(TUBE, sc.spun(TUBE, spins, (1.5, 0.0)), 20.0, contact=felt, want=want)
    assert sc.sweep.inputs(found)["contact"] == felt
    ends = found["end"].values
    for i, w in enumerate(spins):
        one = slide(20.0, felt, w=w)
        # the claims are of velocities: in time they are divided by the deceleration, about mu/2 at the end
        claims = found["error"].values[i] + one.error
        assert abs(ends[i] - one.event.time) <= claims / (0.25 / 2)
        assert abs(ends[i] - slide(20.0, rim, w=w).event.time) > 1e-3, "the ring ends at another time"


def test_pages_and_plots_show_a_body_on_its_face():
    pytest.importorskip("matplotlib").use("agg")
    t = np.linspace(0.0, 8.0, 100)
    pillar = sc.roll(CAN, sc.State(0.1, 0, 0, 0), t, contact=sc.Coulomb(1.0), restitution=0.0)
    fall = sc.dropped(TUBE, 0.5, 0.0, w3=1.0, velocity=(1.5, 0.0, 0.0))
    for m in (slide(t), pillar, sc.roll(TUBE, fall, t, contact=TABLE, restitution=0.5)):
        assert len(sc.view(m).html) > 1000 and len(sc.plot.motion(m)) == 3
