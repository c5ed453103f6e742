"""Too much work: one ending for bodies and stones, the motion so far, and a message that says what was reached."""

import warnings

import numpy as np
import pytest

import spincyl as sc
from spincyl.sweep import Status

BALL, STONE = sc.Body.ball(-0.1, i1=0.41, i3=0.4), sc.Ellipsoid.uniform((1.0, 1.0, 1.0))
SPUN = sc.State(1.0, 0.0, 0.0, 2e3)
AIR = {"contact": "smooth", "losses": sc.loss.AirLinear(1e-12)}
TIMES = np.linspace(0.0, 150.0, 100_001)
JOBS = {
    "ball": lambda **more: sc.roll(BALL, SPUN, TIMES, **AIR, **more),
    "stone": lambda **more: sc.roll(STONE, STONE.spinning(2e3), TIMES, **more),
}


@pytest.mark.parametrize("name", JOBS)
def test_a_body_and_a_stone_end_where_their_evaluations_are_spent(name):
    with pytest.warns(RuntimeWarning) as told:
        m = JOBS[name](max_nfev=5_000)
    said = [str(x.message) for x in told if x.category is RuntimeWarning]
    assert len(said) == 1
    assert said[0].startswith(f"given up at t = {m.event.time:.6g} after {m.nfev} evaluations")
    assert "the number of evaluations is the largest allowed; max_nfev= allows more" in said[0]
    assert m.status == m.event.ending == sc.Ending.BOUNDED
    assert 5_000 <= m.nfev < 5_040
    assert 2 < m.t.size < TIMES.size and m.t[-1] <= m.event.time < TIMES[m.t.size]
    assert "the number of evaluations is the largest allowed" in m.message
    with pytest.warns(RuntimeWarning):
        more = JOBS[name](max_nfev=10_000)
    assert more.event.time > m.event.time
    assert (more.w[: m.t.size] == m.w).all()


def test_a_motion_that_needs_less_is_not_changed():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for roll in (
            lambda **more: sc.roll(BALL, BALL.steady(0.5), 5.0, losses=sc.loss.AirLinear(0.1), **more),
            lambda **more: sc.roll(STONE, STONE.spinning(1.0), 5.0, contact=sc.Coulomb(0.1), **more),
            lambda **more: sc.roll(BALL, BALL.steady(0.5), 5.0, **more),
        ):
            m = roll()
            same = roll(max_nfev=max(m.nfev, 1))
            assert (m.w == same.w).all() and m.nfev == same.nfev and m.error == same.error


@pytest.mark.parametrize("name", JOBS)
@pytest.mark.parametrize("most", [0, -1, 1.5, "5", 2**70, True])
def test_what_is_no_number_of_evaluations_is_refused_by_name(name, most):
    with pytest.raises((ValueError, TypeError), match="^max_nfev"):
        JOBS[name](max_nfev=most)


def test_a_sweep_gives_up_bodies_and_stones_with_the_time():
    bodies = lambda most: sc.sweep.roll(  # noqa: E731
        BALL, sc.State(1.0, 0.0, 0.0, np.array([3e2, 1.0])), 0.5, want="end", max_nfev=most, **AIR
    )
    states = STONE.spinning(np.array([3e2, 1.0]))
    stones = lambda most: sc.sweep.roll(STONE, states, 0.5, want=("end", "spin"), max_nfev=most)  # noqa: E731
    for sweep in (bodies, stones):
        with pytest.warns(RuntimeWarning, match=r"1 of 2 motions were given up.*max_nfev="):
            found = sweep(500)
        assert found["status"].values.tolist() == [Status.BOUNDED, Status.DONE]
        assert 0 < found["end"][0] < 0.5 == found["end"][1]
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            assert (sweep(None)["status"] == Status.DONE).all()


def test_the_time_in_the_message_of_a_measured_stone_is_in_seconds():
    stone = sc.Ellipsoid.rattleback((0.12, 0.06, 0.03), twist=0.35).in_metres(0.5)
    with pytest.warns(RuntimeWarning, match=r"given up at t = \S+ s after"):
        m = sc.roll(stone, stone.spinning(-0.6, pitch=0.02), 500.0, max_nfev=5_000)
    assert 0 < m.event.time < 500


def test_a_motion_computed_again_keeps_its_limit():
    with pytest.warns(RuntimeWarning):
        m = JOBS["stone"](max_nfev=5_000)
    posed = m.wanting("pose")
    assert posed.status == sc.Ending.BOUNDED and posed.nfev < 5_040
