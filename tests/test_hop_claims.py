"""Estimated errors of motions with flights and impacts: neither too small nor too large.

The references are Euler's equations of a body in the air, integrated by SciPy, and the same motion with the least tolerance, to
which motions with other tolerances converge; tests/test_flight_reference.py compares with 50 digits.
"""

import warnings

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import spincyl as sc

LEAST = 1e-14
BALLS = (
    (
        sc.Body.ball(0.11635391562016284, 0.34035972807235404, 0.350015974109944),
        (0.478599147099004, -1.786271492917627, 0.36268773972615526, -3.469968951552902),
        {"slip": (-0.4001463103498339, -0.19536116127309477), "height": 0.0341, "lift": -0.0194},
        (0.4795722481692363, 0.3),
    ),
    (
        sc.Body.ball(0.12096615720097503, 0.2755446684246539, 0.23390013732442824),
        (1.6294055325829722, 2.615236583324879, -0.13883941179402967, -1.97117637180645),
        {"slip": (0.1378556412362386, 2.130957724489268), "height": 0.0407, "lift": 0.0168},
        (0.5706149151158393, 0.7),
    ),
    (
        sc.Body.solid(0.06241370582535537),
        (1.338199495457519, 2.9429654380815253, 0.35710451605449695, 0.2883354761615923),
        {"slip": (-0.35262563166087996, -0.10465409705498388), "height": 0.2978, "lift": 0.0606},
        (0.8948150976353969, 0.3),
    ),
)


def told(m):
    """The numbers of the last state."""
    return np.r_[m.theta[-1], m.w[-1]]


@pytest.mark.parametrize("ball, state, more, law", BALLS)
def test_the_error_of_bounces_that_are_summed_is_part_of_the_estimated_error(ball, state, more, law):
    how = {"contact": sc.Coulomb(law[0]), "restitution": law[1]}
    true = sc.roll(ball, sc.State(*state, **more), [0.0, 3.0], tol=LEAST, **how)
    for tol in (1e-6, 1e-8, 1e-10, 1e-11):
        found = sc.roll(ball, sc.State(*state, **more), [0.0, 3.0], tol=tol, **how)
        off = np.abs(told(found) - told(true)).max()
        assert off <= found.error + true.error
        assert found.error <= 1e3 * max(off, tol * 1e-2)
    swept = sc.sweep.roll(ball, sc.State(*(np.array([x]) for x in state), **more), 3.0, **how)
    last = [float(swept[name][0]) for name in ("theta", "w1", "w2", "w3")]
    assert np.abs(last - told(true)).max() <= float(swept.error[0]) + true.error


def test_what_slips_and_impacts_take_does_not_depend_on_where_the_bounces_are_summed():
    coin = sc.Body.solid(0.0019168855321314959)
    start = sc.State(0.0966, 0.0, 0.0, -8.59, slip=(0.0, 8.59), height=0.1, lift=0.0)
    how = {"contact": sc.Coulomb(0.3), "restitution": 0.5}
    runs = [sc.roll(coin, start, [0.0, 5.0], tol=tol, **how) for tol in (LEAST, 1e-12, 1e-10)]
    heat, lost = (
        np.array([getattr(m, name)[-1] for m in runs]) for name in ("dissipated", "lost_in_impacts")
    )
    assert len({len(m.impacts) for m in runs}) > 1
    most = [10 * m.error + 1e-10 for m in runs]
    assert (np.abs(heat - heat[0]) <= most).all() and (np.abs(lost - lost[0]) <= most).all()
    swept = sc.sweep.roll(coin, start, 5.0, want=["dissipated", "lost_in_impacts"], **how)
    assert abs(float(swept.dissipated) - heat[0]) <= 10 * float(swept.error)
    assert abs(float(swept.lost_in_impacts) - lost[0]) <= 10 * float(swept.error)


def flown(body, w, strength, t):
    """theta and w of a body that turns in the air against a couple -strength |w| w, by Euler's equations."""
    i1, i3 = float(body.i1), float(body.i3)

    def rates(_, y):
        theta, w1, w2, w3 = y
        turn = w1 / np.tan(theta)  # of the axes that follow the inclination, about the axis of the body
        m1, m2, m3 = -strength * np.sqrt(w1 * w1 + w2 * w2 + w3 * w3) * np.array([w1, w2, w3])
        return [-w2, (m1 - (i3 * w3 - turn * i1) * w2) / i1, (m2 - (turn * i1 - i3 * w3) * w1) / i1, m3 / i3]

    return solve_ivp(rates, (0, t), [1.36, *w], method="DOP853", rtol=1e-13, atol=1e-15).y[:, -1]


@pytest.mark.parametrize("strength", [2e-5, 1e-3, 1e-2, 0.1])
@pytest.mark.parametrize("w", [(1.7, 0.0, 0.37), (6.0, 2.0, -5.0)])
def test_the_estimated_error_of_a_flight_in_air_covers_the_error_of_its_steps(strength, w):
    body = sc.Body(0.4979540110852846, 0.37545631148850267, 0.5345886280900015, fillet=0.07397700554264229)
    true = flown(body, w, strength, 1.5)
    for tol in (1e-3, 1e-6, 1e-9):
        start = sc.State(1.36, *w, height=3.0, lift=0.0)
        losses = sc.loss.AirQuadratic(strength)
        m = sc.roll(body, start, [0.0, 1.5], contact="rolling", losses=losses, restitution=0.8, tol=tol)
        assert not m.impacts
        assert np.abs(told(m) - true).max() <= m.error + 1e-10


def test_a_drop_whose_runs_agree_claims_hardly_more_than_their_difference():
    can = sc.measured(outer_diameter="10cm", length="20cm", mass=0.1, gravity=9.81)
    start = sc.dropped(can, 0.4, 1e-6, w2=-0.1, velocity=(0.0, 1.0, 0.0))
    how = {"contact": sc.Coulomb(0.3), "restitution": 0.6, "want": "pose"}
    t = np.linspace(0, 10, 101)
    true = sc.roll(can, start, t, tol=LEAST, **how)
    for tol in (LEAST, 1e-13, 1e-12, 1e-11):
        m = sc.roll(can, start, t, tol=tol, **how)
        apart = max(np.abs(m.w - true.w).max(), np.abs(m.theta - true.theta).max())
        assert apart <= m.error < 1e-6
        assert np.abs(m.centre - true.centre).max() <= m.pose_error < 1e-6


def test_the_estimated_error_follows_bounces_that_multiply_errors():
    # With a restitution of 1 the body hops two thousand times in disorder, so that any error grows until nothing is known.
    body = sc.Body.solid(0.30199516086885325, fillet=0.3)
    start = sc.State(1.3497549372207078, -0.4548569140616314, 0.0, 0.0, slip=(0.0, -1.9946161662512367))
    how = {"contact": sc.Viscous(1.0151752192928623), "restitution": 1.0}
    how["losses"] = sc.loss.Drilling(7.029796253370088e-05)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        runs = [sc.roll(body, start, 20.0, tol=tol, **how) for tol in (LEAST, 1e-13, 1e-12, 1e-10)]
        for m in runs[1:]:
            assert np.abs(m.y - runs[0].y).max() <= 2 * (m.error + runs[0].error)
        # While the bounces are still known, the estimated error is not vague.
        early = sc.roll(body, start, 9.0, **how)
        assert early.error < 1e-7


def test_a_motion_that_never_hops_claims_with_a_restitution_what_it_claims_without():
    body = sc.Body.solid(0.044048104518139015)
    start = sc.State(
        0.21119104833208474,
        1.340993769164863,
        -0.08754343298544283,
        -0.8940964032841376,
        slip=(-1.2784852614934814, 0.44965284078759776),
    )
    how = {"contact": sc.Coulomb(0.966171804691438), "losses": sc.loss.AirQuadratic(0.00010457838052103413)}
    t = np.linspace(0, 20, 101)
    true = sc.roll(body, start, t, **how)
    for tol in (1e-10, 1e-9):
        m, alone = (sc.roll(body, start, t, tol=tol, restitution=e, **how) for e in (0.8, None))
        assert not m.impacts
        assert np.abs(m.y - true.y).max() <= m.error
        assert m.error == pytest.approx(alone.error, rel=0.3)


def test_steps_of_a_smooth_motion_claim_a_share_of_the_sum_of_their_errors():
    tube = sc.Body.tube(5.6076680660088964, bore=0.5600633311566589)
    start = sc.State(0.11530395187387268, -0.08824418602137107, 0.0, -0.7619233224905091, slip=(0.0, 0.0))
    how = {"contact": sc.Coulomb(0.8381179756079996), "losses": sc.loss.Drilling(0.0019191455479805344)}
    t = np.linspace(0, 8, 101)
    true = sc.roll(tube, start, t, **how)
    for tol in (1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7):
        m = sc.roll(tube, start, t, tol=tol, **how)
        assert np.abs(m.y - true.y).max() <= 2 * m.error
