"""Heads or tails: the rim from which a body is seen, and what it rests on."""

import numpy as np
import pytest

import spincyl as sc
from spincyl import RestsOn

COIN = sc.Body.solid(0.25)
CAN = sc.Body.solid(1.5)
GRIP = sc.Coulomb(0.4)
LOSSES = sc.loss.DryContour(0.05) + sc.loss.RollingResistance(0.01)
BOUNCES = {"contact": sc.Coulomb(0.3), "restitution": 0.5}


def axis(orientation):
    """Vertical component of axis 3 of the body, from quaternions (x, y, z, w)."""
    x, y = orientation[..., 0], orientation[..., 1]
    return 1 - 2 * (x * x + y * y)


def tosses(count, seed):
    rng = np.random.default_rng(seed)
    lean, w = np.arccos(rng.uniform(-1, 1, count)), rng.normal(0, 2.0, (3, count))
    return lean, w


def test_tossed_coins_fall_heads_and_tails_as_their_orientation_shows():
    (lean, w), n = tosses(40, 7), 40
    table = {"contact": GRIP, "restitution": 0.0, "losses": LOSSES, "tol": 1e-8}
    start = sc.dropped(COIN, 5.0, lean, w1=w[0], w2=w[1], w3=w[2])
    found = sc.sweep.roll(COIN, start, 300.0, want=("final", "end", "rests_on", "axis_up"), **table)
    up, ends = np.full(n, np.nan), found["end"].values
    for k in range(n):
        one = sc.dropped(COIN, 5.0, lean[k], w1=w[0, k], w2=w[1, k], w3=w[2, k])
        m = sc.roll(COIN, one, [0.0, ends[k] * (1 - 1e-4)], want="pose", **table)
        up[k] = axis(m.orientation[-1])
        assert found["axis_up"].values[k] == pytest.approx(up[k], abs=1e-3)
        assert m.axis_up[-1] == pytest.approx(up[k], abs=1e-12)
        whole = sc.roll(COIN, one, 300.0, **table)
        assert found["rests_on"].values[k] == whole.rests_on
    on, told = found["rests_on"].values, found["axis_up"].values
    face = np.isin(on, (RestsOn.FACE, RestsOn.OTHER_FACE))
    assert np.array_equal(on[face] == RestsOn.FACE, up[face] > 0)
    assert (told > 0.9).sum() > 5 and (told < -0.9).sum() > 5
    # theta alone does not tell: it refers to the rim that carries the body
    assert ((found["theta"].values < 1) & (up < -0.9)).sum() > 5
    cosine = np.cos(found["theta"].values) * np.where(found["rim"].values == 1, -1, 1)
    assert cosine == pytest.approx(found["axis_up"].values, abs=1e-15)
    assert found["rests_on"].attrs["flag_meanings"] == "none face other_face side edge"


def test_the_rim_and_theta_tell_the_axis_as_the_orientation_does_at_every_time():
    (lean, w), t = tosses(30, 3), np.linspace(0, 12, 241)
    start = sc.dropped(CAN, 1.0, lean, w1=w[0], w2=w[1], w3=w[2])
    many = sc.sweep.roll(CAN, start, t, **BOUNCES)
    seen = set()
    for k in range(30):
        one = sc.dropped(CAN, 1.0, lean[k], w1=w[0, k], w2=w[1, k], w3=w[2, k])
        m = sc.roll(CAN, one, t, want="pose", tol=1e-10, **BOUNCES)
        assert m.axis_up == pytest.approx(axis(m.orientation), abs=1e-12)
        seen |= {*m.rim.tolist()}
        kept = many["rim"].values[k][: m.t.size]
        assert np.array_equal(kept, m.rim) and np.isnan(many["rim"].values[k][m.t.size :]).all()
        for phase in m.phases:
            # state and rim of a phase are those of the output at that time
            i = np.searchsorted(t, phase.time)
            if i < m.t.size and t[i] == phase.time:
                assert phase.rim == ("first", "other")[m.rim[i]]
    assert seen == {0, 1}
    plain = sc.roll(CAN, CAN.steady(1.0), t)
    assert (plain.rim == 0).all() and plain.axis_up == pytest.approx(np.cos(1.0), abs=1e-12)


@pytest.mark.parametrize(
    ("body", "start", "how", "on"),
    [
        (COIN, sc.dropped(COIN, 1.0, 0.4), {"restitution": 0.0, "contact": GRIP}, RestsOn.FACE),
        (COIN, sc.dropped(COIN, 1.0, np.pi - 0.4), {"restitution": 0.0, "contact": GRIP}, RestsOn.OTHER_FACE),
        (CAN, sc.State(np.pi / 2, 0.0, 0.0, 0.0), {"restitution": 0.0, "contact": GRIP}, RestsOn.SIDE),
        (
            CAN,
            sc.State(np.pi / 2, 0.0, 0.0, 1.0),
            {"restitution": 0.0, "contact": GRIP, "losses": sc.loss.RollingResistance(0.01)},
            RestsOn.SIDE,
        ),
        (CAN, sc.State(np.pi / 2, 0.0, 0.0, 1.0), {"restitution": 0.0, "contact": GRIP}, RestsOn.NONE),
        (COIN, COIN.steady(0.5), {"losses": sc.loss.DryContour(0.02)}, RestsOn.FACE),
        (sc.Body.solid(0.0), sc.State(2.5, 0.0, 0.0, 0.0), {}, RestsOn.OTHER_FACE),
        (
            sc.Body.solid(0.0),
            sc.State(np.pi / 2, 0.5, 0.0, 0.0),
            {"contact": GRIP, "losses": sc.loss.RollingResistance(0.01) + sc.loss.Drilling(0.01)},
            RestsOn.EDGE,
        ),
        (CAN, CAN.steady(1.0), {}, RestsOn.NONE),
        (CAN, sc.dropped(CAN, 1.0, 1.0), {"restitution": 0.0, "contact": GRIP, "t": 0.1}, RestsOn.NONE),
    ],
)
def test_a_body_rests_on_what_touches_the_table_when_nothing_moves(body, start, how, on):
    how = {"t": 400.0} | how
    assert sc.roll(body, start, how.pop("t"), **how).rests_on == on


def test_the_force_on_both_rims_is_what_moves_the_centre():
    tube, t = sc.Body.tube(3.0, bore=0.8), 0.05 + np.array([-1e-4, 0.0, 1e-4])
    start = sc.State(np.pi / 2, 0.3, 0.0, 0.2, slip=(0.5, 0.2))
    table = {"contact": sc.Coulomb(0.3), "restitution": 0.0, "want": ("pose", "force")}
    m = sc.roll(tube, start, t, t0=0.0, **table)
    moved = (m.centre[2] - 2 * m.centre[1] + m.centre[0]) / 1e-8
    assert m.phase.tolist() == [3, 3, 3]
    assert m.contact_force[1] == pytest.approx(moved + np.array([0, 0, 1]), abs=1e-6)
    other = m.contact_force_other
    assert other[:, 2] == pytest.approx(m.normal_other, abs=1e-14)
    assert np.hypot(*other[:, :2].T) == pytest.approx(m.friction_other, abs=1e-14)
    own = m.contact_force - other
    assert np.hypot(*own[:, :2].T) == pytest.approx(m.friction, abs=1e-14)
    assert own[:, 2] == pytest.approx(m.normal, abs=1e-14)
    # a body on one rim has no other force
    one = sc.roll(tube, sc.dropped(tube, 0.1, 1.0), 0.1, **table)
    assert np.isnan(one.contact_force_other).all()


def test_a_motion_taken_up_at_the_beginning_of_any_phase_goes_on_as_it_did():
    coin = sc.Body.solid(0.08)
    m = sc.roll(coin, sc.dropped(coin, 0.5, 1.2, w3=3.0), [0.0, 1.0, 2.0], **BOUNCES)
    first = m.phases[0]
    assert (first.state.height, first.state.lift) == (0.5, 0.0)
    tried = {}
    (lean, w), t = tosses(25, 11), np.linspace(0, 3, 4)
    for k in range(25):
        start = sc.dropped(CAN, 0.3, lean[k], w1=w[0, k], w2=w[1, k], w3=w[2, k])
        m = sc.roll(CAN, start, t, **BOUNCES)
        for phase in m.phases[1:4]:
            again = sc.roll(CAN, phase.state, [phase.time, 3.0], t0=phase.time, **BOUNCES)
            near = phase.time + min(0.05, 3.0 - phase.time)
            far, there = (
                sc.roll(CAN, s, near, t0=at, **BOUNCES) for s, at in ((start, 0.0), (phase.state, phase.time))
            )
            if far.t.size and there.t.size and again.t.size:
                assert there.theta[-1] == pytest.approx(far.theta[-1], abs=1e-9), (k, phase)
                assert there.height[-1] == pytest.approx(far.height[-1], abs=1e-9), (k, phase)
                tried[phase.kind] = tried.get(phase.kind, 0) + 1
    assert tried.get("flying", 0) > 20, tried
