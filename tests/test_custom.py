"""Laws of a user's own: the library's motions, SI, and what they are refused for."""

import ctypes
import ctypes.util
import math
import os
import signal
import sys

import numpy as np
import pytest

import spincyl as sc

COIN = sc.Body.solid(0.1)
START, T = COIN.steady(0.5), np.linspace(0, 5, 11)
CUBIC = sc.custom.Couple(lambda theta, w, normal: -0.01 * (w @ w) * w)
FALLING = sc.custom.Friction(lambda u: 0.1 + 0.2 / (1 + u * u))


def test_a_drag_written_as_a_function_moves_a_coin_as_the_librarys_does():
    own = sc.custom.Couple(lambda theta, w, normal: -0.01 * w)
    ours = sc.roll(COIN, START, T, losses=sc.loss.AirLinear(0.01), want=("pose", "force"))
    for tol, most in ((None, 1e-9), (1e-13, 2e-12)):
        m = sc.roll(COIN, START, T, losses=own, tol=tol, want=("pose", "force"))
        assert abs(m.w - ours.w).max() < m.error + ours.error < most
        assert abs(m.work_lost - ours.work_lost).max() < 10 * most
        assert abs(m.centre - ours.centre).max() < m.pose_error + ours.pose_error
        assert abs(m.normal - ours.normal).max() < m.force_error + ours.force_error


def test_what_a_law_loses_is_the_integral_of_its_power():
    t = np.linspace(0, 5, 2001)
    m = sc.roll(COIN, START, t, losses=CUBIC)
    power = 0.01 * (m.w**2).sum(axis=1) ** 2
    lost = np.concatenate([[0], np.cumsum((power[1:] + power[:-1]) / 2 * np.diff(t))])
    assert abs(m.work_lost - lost).max() < 1e-7
    assert np.ptp(COIN.energy(m.states) + m.work_lost) < 1e-9
    assert CUBIC.power(COIN, START) == pytest.approx(power[0], rel=1e-12)


def test_arms_of_rolling_and_of_rocking_that_agree_are_rolling_resistance():
    def arms(theta, w, normal, rolling, rocking, e):
        s, c = np.sin(theta), np.cos(theta)
        w_h = c * w[0] - s * w[2]
        size = np.hypot(rolling * w_h, rocking * w[1]) + rocking * e
        m_h, m_2 = -normal * rolling**2 * w_h / size, -normal * rocking**2 * w[1] / size
        return c * m_h, m_2, -s * m_h

    start = START.kicked(0.1)
    ours = sc.roll(COIN, start, 5.0, losses=sc.loss.RollingResistance(2e-3))
    off = []
    for e in (1e-3, 1e-4):
        law = sc.custom.Couple(lambda *at, e=e: arms(*at, 2e-3, 2e-3, e))
        off.append(abs(sc.roll(COIN, start, 5.0, losses=law).w - ours.w).max())
    assert off[0] < 2e-5
    assert off[1] == pytest.approx(off[0] / 10, rel=0.1)  # of first order in the rounding


def test_a_measured_body_gives_its_law_si():
    tube = sc.measured(outer_diameter="22mm", length="50mm", mass="10g")
    seen = []

    def drag(theta, w, normal):
        seen.append((np.linalg.norm(w), normal))
        return -1e-8 * w  # N m s

    start, t = tube.steady(1.2), np.linspace(0, 1, 5)
    m = sc.roll(tube, start, t, losses=sc.custom.Couple(drag))
    ours = sc.roll(tube, start, t, losses=sc.loss.AirLinear.from_si(1e-8, scale=tube))
    assert abs(m.w - ours.w).max() < 1e-9 * abs(m.w).max()
    assert m.work_lost[-1] == pytest.approx(ours.work_lost[-1], rel=1e-8)
    fastest, normal = seen[-1]
    assert fastest == pytest.approx(np.linalg.norm(m.w[-1]), rel=0.05)
    assert normal == pytest.approx(0.01 * 9.80665, rel=0.05)


def test_the_friction_of_a_measured_body_gets_metres_per_second():
    ball = sc.Body.ball(0.0, i1=0.4, i3=0.4, diameter="57mm", mass="170g")
    struck = sc.State(np.pi / 2, 0.0, 0.0, 0.0, slip=(0.0, 3.0))
    falls = 0.05  # m/s
    own = sc.custom.Friction(lambda v: 0.1 + 0.2 / (1 + (v / falls) ** 2))
    of = ball.scale.metres_per_second(1.0)
    natural = sc.custom.Friction(lambda u: 0.1 + 0.2 / (1 + (u * of / falls) ** 2))
    ends = sc.roll(ball, struck, 2.0, contact=own).phases[1].time
    other = sc.roll(ball.natural, struck, 40.0, contact=natural).phases[1].time
    assert ends == pytest.approx(ball.scale.seconds(other), rel=1e-9)


def test_a_billiard_ball_rolls_when_the_law_says():
    ball = sc.Body.ball(0.0, i1=0.4, i3=0.4)
    struck = sc.State(np.pi / 2, 0.0, 0.0, 0.0, slip=(0.0, 3.0))
    m = sc.roll(ball, struck, 20.0, contact=FALLING)
    u = (np.arange(20000) + 0.5) * 3 / 20000
    lasts = (3 / 20000 / (3.5 * (0.1 + 0.2 / (1 + u * u)))).sum()
    assert m.phases[1].kind == "rolling"
    assert m.phases[1].time == pytest.approx(lasts, rel=1e-8)


@pytest.mark.parametrize(
    ("law", "error", "words"),
    [
        (lambda theta, w, normal: 0.1 * w, ValueError, "takes energy"),
        (lambda theta, w, normal: -0.1 * np.sign(w), ValueError, "tanh"),
        (lambda theta, w, normal: w * np.nan, ValueError, "finite"),
        (lambda theta, w, normal: -w[:2], TypeError, "three numbers"),
        (lambda theta, w, normal: None, TypeError, "three numbers, along e1, e2, e3, not None"),
        (lambda theta, w, normal: -w / (w @ w - w @ w), ValueError, "finite"),
        (lambda theta: 0, TypeError, "positional argument"),
    ],
)
@pytest.mark.filterwarnings("ignore:divide by zero", "ignore:invalid value")
def test_a_couple_that_is_no_loss_is_refused(law, error, words):
    with pytest.raises(error, match=words):
        sc.roll(COIN, START, T, losses=sc.custom.Couple(law))


def test_what_is_no_friction_is_refused():
    for law, words in ((lambda u: 0.1 - u, "0 or more"), (lambda u: 0.3 if u < 1 else 0.1, "step")):
        with pytest.raises(ValueError, match=words):
            sc.roll(COIN, START, T, contact=sc.custom.Friction(law))
    with pytest.raises(ValueError, match="static"):
        sc.custom.Friction(lambda u: 0.3, static=0.1)
    with pytest.raises(TypeError, match=r"function\(0.0\)"):
        sc.custom.Friction(lambda u: np.array([1, 2]))


def test_an_error_within_a_law_is_that_of_the_motion():
    with pytest.raises(ZeroDivisionError):
        sc.roll(COIN, START, T, losses=sc.custom.Couple(lambda theta, w, normal: 1 / 0))


#: The check before a motion calls a couple about 7,100 times.
CHECKED = 7300


@pytest.mark.parametrize("fails_at", [1, 100, CHECKED, CHECKED + 5000])
def test_the_first_exception_of_a_law_is_its_last_call(fails_at):
    calls = []

    def law(theta, w, normal):
        calls.append(theta)
        if len(calls) >= fails_at:
            raise ZeroDivisionError("mine")
        return -0.01 * w

    with pytest.raises(ZeroDivisionError, match="mine"):
        sc.roll(COIN, START, np.linspace(0, 500, 11), losses=sc.custom.Couple(law))
    assert len(calls) == fails_at
    calls.clear()

    def friction(u):
        calls.append(u)
        if len(calls) >= fails_at:
            raise ZeroDivisionError("mine")
        return 0.1 + 0.2 / (1 + u * u)

    with pytest.raises(ZeroDivisionError, match="mine"):
        slips = sc.State(0.5, 0.1, 0.0, 3.0, slip=(1.0, 2.0))
        both = sc.custom.Couple(lambda theta, w, normal: -0.01 * w)
        contact = sc.custom.Friction(friction)
        sc.roll(COIN, slips, np.linspace(0, 500, 11), contact=contact, losses=both)
    assert len(calls) == fails_at


def test_ctrl_c_in_a_law_is_heard_in_that_call():
    calls = []

    def law(theta, w, normal):
        calls.append(theta)
        if len(calls) == CHECKED + 2000:
            os.kill(os.getpid(), signal.SIGINT)
        return -0.01 * w

    with pytest.raises(KeyboardInterrupt):
        sc.roll(COIN, START, np.linspace(0, 500, 11), losses=sc.custom.Couple(law))
    assert len(calls) <= CHECKED + 2001


def test_a_law_that_is_nan_on_the_way_is_named_with_the_state():
    window = sc.custom.Couple(
        lambda theta, w, normal: -0.01 * w * (np.nan if 0.4799 < theta < 0.4801 else 1.0)
    )
    with pytest.raises(ValueError, match=r"^couple: power = NaN at theta = 0\.4[78].*w = \[.*N = .*finite"):
        sc.roll(COIN, START, 5.0, losses=window)
    adds = sc.custom.Couple(lambda theta, w, normal: -0.01 * w * (1 - (w @ w) / 144.0))
    body = sc.Body.solid(2.5)
    with pytest.raises(ValueError, match=r"^couple: power = -.*takes energy"):
        sc.roll(body, sc.State(1.3, 0.1, 0.0, 25.0), 5.0, losses=adds)
    tube = sc.measured(outer_diameter="22mm", length="50mm", mass="10g")
    with pytest.raises(ValueError, match=r"^couple: power = NaN .*natural units"):
        limit = 12.0 / float(tube.scale.seconds(1.0))
        nan = sc.custom.Couple(lambda theta, w, normal: -1e-8 * w * (np.nan if w @ w > limit**2 else 1.0))
        sc.roll(tube, sc.State(1.3, 0.1, 0.0, 25.0), 5.0, losses=nan)


def test_a_stiff_law_is_named_where_its_motion_is_given_up():
    def drilling(theta, w, normal):
        s, c = math.sin(theta), math.cos(theta)
        couple = -1e7 * (s * float(w[0]) + c * float(w[2]))
        return couple * s, 0.0, couple * c

    with pytest.warns(RuntimeWarning, match="given up at .* since the law is stiff"):
        m = sc.roll(COIN, START, 5.0, losses=sc.custom.Couple(drilling), max_nfev=20_000)
    assert m.status == sc.Ending.BOUNDED and "the law is stiff" in m.message


@pytest.mark.parametrize(
    "call",
    [
        lambda: CUBIC + CUBIC,
        lambda: CUBIC + sc.loss.AirLinear(1e-3) + CUBIC,
        lambda: sc.loss.Sum([CUBIC]),
        lambda: sc.drift(COIN, 0.5, CUBIC + sc.loss.AirLinear(1e-3)),
        lambda: sc.scene(sc.roll(COIN, START, T, losses=CUBIC + sc.loss.AirLinear(1e-3))),
        lambda: sc.drift(COIN, 0.5, CUBIC),
        lambda: sc.sweep.roll(
            sc.Ellipsoid.egg(1.0, 1.5), sc.Ellipsoid.egg(1.0, 1.5).spinning(1.0), 1.0, losses=CUBIC
        ),
        lambda: sc.turning_spin(sc.Body.ball(0.2, i1=0.4, i3=0.4), FALLING),
        lambda: sc.scene(sc.roll(COIN, START, T, contact=FALLING)),
        lambda: sc.scene(sc.roll(COIN, START, T, losses=CUBIC)),
        lambda: sc.play(COIN, state=START, contact=FALLING),
        lambda: sc.play(COIN, state=START, losses=CUBIC),
    ],
)
def test_what_cannot_follow_a_law_of_your_own_refuses_it(call):
    with pytest.raises(TypeError, match="of your own|user-defined|expected built-in laws"):
        call()


SWEPT = "final", "end", "slip_time", "dissipated", "work_lost", "phases", "rolling_time", "rolling_w3"


@pytest.mark.parametrize("of", ["python", "c"])
@pytest.mark.parametrize("scaled", [False, True])
def test_a_sweep_under_laws_of_your_own_has_the_bits_of_single_motions(of, scaled):
    ell, w3, t = np.array([[0.1], [1.0]]), np.array([2.0, -3.0]), 0.5 if scaled else 1.5
    couple = sc.custom.Couple(drag if of == "c" else lambda theta, w, normal: -0.01 * normal * w)
    contact = sc.custom.Friction(ERFC if of == "c" else math.erfc)

    def body(ell):
        found = sc.Body.solid(ell)
        return found.in_metres(1000.0, radius=1.0) if scaled else found

    def state(w3):
        return sc.State(1.2, 0.2, 0.1, w3, slip=(0.3, 0.1))

    found = sc.sweep.roll(body(ell), state(w3), t, contact=contact, losses=couple, want=SWEPT, threads=2)
    assert (found["method"] == sc.sweep.Answer.FLOW).all()
    assert (found["status"] == sc.sweep.Status.DONE).any()
    for i, j in np.ndindex(2, 2):
        row = found.isel(motion_0=i, motion_1=j)
        m = sc.roll(body(float(ell[i, 0])), state(w3[j]), t, contact=contact, losses=couple)
        last = m.states if m.event is None else m.event.state
        assert row["status"] == m.status
        assert row["error"] == m.error
        assert row["phases"] == len(m.phases)
        assert row["end"] == (t if m.event is None else m.event.time)
        if scaled:
            continue
        assert [row[x].item() for x in ("theta", "w1", "w2", "w3")] == [
            np.ravel(getattr(last, x))[-1] for x in ("theta", "w1", "w2", "w3")
        ]
        if m.event is None:
            assert (row["dissipated"], row["work_lost"]) == (m.dissipated[-1], m.work_lost[-1])
        rolling = [x for x in m.phases if x.kind == "rolling"]
        assert row["rolling_time"].item() == (
            pytest.approx(rolling[-1].time) if rolling else pytest.approx(np.nan, nan_ok=True)
        )
    once = sc.sweep.roll(
        body(ell), state(w3), t, contact=contact, losses=couple, want=SWEPT, errors=False, threads=1
    )
    assert once["error"].isnull().all()
    assert all(once[name].equals(found[name]) for name in ("theta", "w3", "end", "status", "work_lost"))


def test_a_sweep_has_the_states_of_your_law_at_all_times():
    found = sc.sweep.roll(COIN, COIN.steady(np.array([0.4, 0.5])), T, losses=CUBIC)
    m = sc.roll(COIN, START, T, losses=CUBIC)
    assert (found["w3"].values[1] == m.w[:, 2]).all()
    assert "custom.Couple" in found.attrs["losses"]


def test_what_a_law_does_wrong_is_the_error_of_its_sweep():
    starts, calls = COIN.steady(np.array([0.3, 0.5])), []

    def law(theta, w, normal):
        calls.append(theta)
        if len(calls) >= CHECKED + 5000:
            raise ZeroDivisionError("mine")
        return -0.01 * w

    with pytest.raises(ZeroDivisionError, match="mine"):
        sc.sweep.roll(COIN, starts, 500.0, losses=sc.custom.Couple(law))
    assert len(calls) == CHECKED + 5000
    with pytest.raises(ValueError, match="takes energy"):
        sc.sweep.roll(COIN, starts, 5.0, losses=sc.custom.Couple(lambda theta, w, normal: 0.1 * w))
    window = sc.custom.Couple(
        lambda theta, w, normal: -0.01 * w * (np.nan if 0.4799 < theta < 0.4801 else 1.0)
    )
    with pytest.raises(ValueError, match=r"^couple: power = NaN at theta = 0\.4[78]"):
        sc.sweep.roll(COIN, starts, 5.0, losses=window)
    calls.clear()
    bad = sc.State(np.array([0.5, np.nan]), 0.0, 0.0, 3.0)
    status = sc.sweep.roll(COIN, bad, 1.0, losses=CUBIC)["status"].values
    assert status.tolist() == [sc.sweep.Status.DONE, sc.sweep.Status.INVALID]


def test_ctrl_c_in_a_law_ends_its_sweep():
    calls = []

    def law(theta, w, normal):
        calls.append(theta)
        if len(calls) == CHECKED + 2000:
            os.kill(os.getpid(), signal.SIGINT)
        return -0.01 * w

    with pytest.raises(KeyboardInterrupt):
        sc.sweep.roll(COIN, COIN.steady(np.full(9, 0.5)), 500.0, losses=sc.custom.Couple(law))
    assert len(calls) <= CHECKED + 2001


def test_a_result_does_not_contain_a_law_of_your_own():
    pytest.importorskip("dask")
    found = sc.sweep.roll(COIN, START, 1.0, losses=CUBIC)
    with pytest.raises(
        ValueError, match="rows: a saved result cannot contain a law of your own: losses = custom.Couple"
    ):
        sc.sweep.inputs(found)
    slides = sc.State(0.5, 0.0, 0.0, 3.0, slip=(0.1, 0.0))
    with pytest.raises(ValueError, match="contact = custom.Friction"):
        sc.sweep.inputs(sc.sweep.roll(COIN, slides, 1.0, contact=FALLING))
    import dask.array as da

    lazy = COIN.steady(da.full(4, 0.5, chunks=2))
    with pytest.raises(TypeError, match="only for arrays in memory"):
        sc.sweep.roll(COIN, lazy, 1.0, losses=CUBIC)


def test_a_sweep_under_a_law_of_your_own_stops_where_rolling_begins():
    tube = sc.Body.tube(6.0, bore=0.8)
    slides = tube.with_centre_velocity(tube.steady([1.4, 1.5]), 0.0, 0.05)
    want = ("rolling_time", "rolling_w3", "phases")
    own = sc.custom.Friction(lambda u: 0.3)
    found, known = (
        sc.sweep.roll(tube, slides, 20.0, contact=law, stop_at="rolling", want=want)
        for law in (own, sc.Coulomb(0.3))
    )
    assert (found["phases"].to_numpy() == 2).all() and (found["rolling_time"].to_numpy() > 0.01).all()
    for name in want:
        assert abs(found[name].to_numpy() - known[name].to_numpy()).max() < 1e-7


def test_flicks_slip_under_a_law_of_your_own():
    tube, how = sc.Body.tube(6.0, bore=0.8), {"w1": [1.0, 2.0], "launch": 1.2}
    own = sc.custom.Friction(lambda u: 0.3)
    found, known = (sc.sweep.flicks(tube, 5.0, **how, contact=law) for law in (own, sc.Coulomb(0.3)))
    assert found["outcome"].to_numpy().tolist() == known["outcome"].to_numpy().tolist()
    assert abs(found["end"].to_numpy() - known["end"].to_numpy()).max() < 1e-7


def test_a_custom_motion_is_shown_and_plotted():
    import matplotlib.pyplot as plt

    m = sc.roll(COIN, START, T, losses=CUBIC)
    assert "custom.Couple" in repr(m.losses)
    m.plot()
    assert any("custom.Couple" in text for text in (ax.get_title() for ax in plt.gcf().axes))
    plt.close("all")


@pytest.mark.parametrize("contact", [sc.Viscous(0.5), sc.custom.Friction(lambda u: 0.3 * math.tanh(u / 0.3))])
def test_a_body_without_a_slip_begins_to_slip_on_a_film_under_a_law_of_your_own(contact):
    own = sc.custom.Couple(lambda theta, w, normal: -0.01 * w)
    m = sc.roll(COIN, START, T, contact=contact, losses=own)
    assert m.status == sc.Ending.DONE and np.hypot(*m.slip[-1]) > 0.0
    sums = m.energy + m.dissipated + m.work_lost
    assert np.ptp(sums) < 1e-9 + 10 * m.error
    if isinstance(contact, sc.Viscous):
        ours = sc.roll(COIN, START, T, contact=contact, losses=sc.loss.AirLinear(0.01))
        assert abs(m.w - ours.w).max() < m.error + ours.error


def test_a_couple_of_ones_own_differs_from_every_other_law_and_is_printed_by_its_name():
    couple, other = sc.custom.Couple(np.negative), sc.loss.RollingResistance(1e-3)
    assert couple != other and other != couple and couple in [other, couple]
    assert str(couple) == repr(couple) == "custom.Couple(negative)"


def test_laws_of_your_own_are_equal_if_their_functions_are():
    def falling(speed):
        return 0.3 / (1 + speed)

    class Tribometer:
        def law(self, speed):
            return 0.3

        def couple(self, theta, w, normal):
            return -0.01 * w

    one, other = sc.custom.Friction(lambda u: 0.3), sc.custom.Friction(falling)
    assert one != other and {one: "mine"}.get(other) is None and sc.Coulomb(0.3) != one != sc.Coulomb(0.3)
    assert sc.custom.Friction(falling) == other and hash(sc.custom.Friction(falling)) == hash(other)
    assert sc.custom.Friction(falling, static=0.4) != other
    of = Tribometer()
    assert sc.custom.Friction(of.law) == sc.custom.Friction(of.law) != sc.custom.Friction(Tribometer().law)
    assert sc.custom.Couple(of.couple) == sc.custom.Couple(of.couple) != sc.custom.Couple(Tribometer().couple)
    with pytest.raises(TypeError, match=r"^custom.Friction.from_si: not needed; .* in m/s"):
        sc.custom.Friction.from_si(0.3, patch=0.0, scale=sc.Scale(0.01))


ARGUMENTS = ctypes.CFUNCTYPE(None, *[ctypes.POINTER(ctypes.c_double)] * 2)
SPEED = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double)
ERFC = ctypes.CDLL(ctypes.util.find_library("m")).erfc
ERFC.restype, ERFC.argtypes = ctypes.c_double, [ctypes.c_double]


@ARGUMENTS
def drag(args, couple):
    for k in range(3):
        couple[k] = -0.01 * args[1 + k] * args[4]


def test_a_c_function_moves_a_coin_as_the_same_function_of_python_does():
    plain = sc.custom.Couple(lambda theta, w, normal: -0.01 * w * normal)
    for coin, t in ((COIN, T), (COIN.in_metres(0.005, radius=0.012), 0.03 * T)):
        ours = sc.roll(coin, START, t, losses=plain, want=("pose", "force"))
        m = sc.roll(coin, START, t, losses=sc.custom.Couple(drag), want=("pose", "force"))
        assert (m.w == ours.w).all()
        assert (m.work_lost == ours.work_lost).all()
        assert (m.nfev, m.error, m.message) == (ours.nfev, ours.error, ours.message)
    state = sc.State(1.0, 0.1, 0.2, 0.3)
    assert sc.custom.Couple(drag).couple(COIN, state, 2.0).tolist() == plain.couple(COIN, state, 2.0).tolist()
    assert sc.custom.Couple(drag).power(COIN, state, 2.0) == plain.power(COIN, state, 2.0)


def test_a_coefficient_in_c_is_that_of_python_and_calls_nothing_of_python():
    hoop, thrown = sc.Body.tube(0.0, bore=1.0), sc.State(np.pi / 2, 0.0, 0.0, -3.0, slip=(0.0, 1.0))
    for body, t in ((hoop, 40.0), (hoop.in_metres(0.1, radius=0.3), 8.0)):
        plain, law = sc.custom.Friction(math.erfc), sc.custom.Friction(ERFC)
        ours, m = (sc.roll(body, thrown, t, contact=contact) for contact in (plain, law))
        assert law.mu == 1.0
        assert [x.kind for x in m.phases] == ["slipping", "rolling"]
        assert m.phases[1].time == pytest.approx(ours.phases[1].time, abs=2 * m.error + 2 * ours.error)
        called = []
        sys.setprofile(lambda _, event, of, to=called: to.append(of) if event == "c_call" else None)
        try:
            sc.roll(body, thrown, t, contact=law)
        finally:
            sys.setprofile(None)
        assert ERFC not in called
        assert len(called) < 200 < m.nfev


def test_scipys_low_level_callable_is_a_c_function():
    scipy = pytest.importorskip("scipy")
    law = sc.custom.Friction(scipy.LowLevelCallable(ERFC))
    assert law.static == 1.0
    assert law._function == sc.custom.Friction(ERFC)._function
    data = scipy.LowLevelCallable(ERFC, ctypes.c_void_p(1))
    with pytest.raises(TypeError, match="takes no user_data"):
        sc.custom.Friction(data)


def capsule(signature):
    make = ctypes.pythonapi.PyCapsule_New
    make.restype, make.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
    return make(ctypes.cast(drag, ctypes.c_void_p), signature, None)


SIGNED = b"void (double *, const double *)", b"void(double *,double *, int)", b"double (double)", b""


def test_a_capsule_has_its_signature_as_its_name():
    law = sc.custom.Couple(capsule(SIGNED[0]))
    assert law._function == sc.custom.Couple(drag)._function
    for signature in SIGNED[1:]:
        with pytest.raises(TypeError, match=r"^function: expected a C function void \(const double"):
            sc.custom.Couple(capsule(signature))


@pytest.mark.parametrize(
    "other",
    [
        SPEED(lambda u: u),
        ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_double)(lambda a, b: None),
        ctypes.CFUNCTYPE(ctypes.c_double, *ARGUMENTS._argtypes_)(lambda a, b: 0.0),
        ctypes.CFUNCTYPE(None, *[ctypes.POINTER(ctypes.c_float)] * 2)(lambda a, b: None),
        ctypes.PYFUNCTYPE(None, *ARGUMENTS._argtypes_)(lambda a, b: None),
        ctypes.CDLL(None).abs,
        ARGUMENTS(),
    ],
    ids=["one speed", "two numbers", "with a result", "floats", "with the GIL", "untyped", "null"],
)
def test_a_c_function_of_another_signature_is_refused_before_it_is_called(other):
    with pytest.raises(TypeError, match=r"^function: expected a C function void \(const double \*args"):
        sc.custom.Couple(other)
    with pytest.raises(TypeError, match=r"^function: expected a C function double \(double speed\)"):
        sc.custom.Friction(other if other.argtypes != SPEED._argtypes_ else drag)


def test_a_c_function_that_is_no_loss_is_refused_and_an_error_on_the_way_is_named():
    @ARGUMENTS
    def pushes(args, couple):
        for k in range(3):
            couple[k] = 0.01 * args[1 + k]

    @ARGUMENTS
    def forgets(args, couple):
        couple[0] = -0.01 * args[1]

    for law, words in ((pushes, "takes energy"), (forgets, "finite")):
        with pytest.raises(ValueError, match=f"^couple = .*{words}"):
            sc.roll(COIN, START, T, losses=sc.custom.Couple(law))


def test_a_law_is_called_a_few_thousand_times_and_mostly_by_the_motion():
    counts = {}
    for name in ("couple", "friction"):
        calls = [0]

        def couple(theta, w, normal, calls=calls):
            calls[0] += 1
            return -1e-3 * w

        def coefficient(u, calls=calls):
            calls[0] += 1
            return 0.2 + 0.2 * math.exp(-((u / 0.1) ** 2))

        if name == "couple":
            body = sc.Body.solid(2.0)
            state, how = body.steady(1.3).kicked(0.1), {"losses": sc.custom.Couple(couple)}
        else:
            body = sc.Body.tube(0.0, bore=1.0)
            state = sc.State(np.pi / 2, 0.0, 0.0, -3.0, slip=(0.0, 5.0))
            how = {"contact": sc.custom.Friction(coefficient)}
        of = []
        for t in (1e-9, 20.0):
            calls[0] = 0
            of.append((sc.roll(body, state, t, tol=1e-10, **how).nfev, calls[0]))
        counts[name] = of
    (_, check), (nfev, whole) = counts["couple"]
    assert check < 3200  # 7,086 if each line is halved down to rounding
    assert whole - check < 6 * nfev
    (_, check), (nfev, whole) = counts["friction"]
    assert check < 2000
    assert whole - check < 4 * nfev


def test_a_body_that_slips_where_no_unique_force_exists_raises_under_a_law_of_your_own_too():
    body = sc.Body(0.48950128204831594, i1=0.014081517489595553, i3=0.01478685120782547)
    start = sc.State(np.pi / 2, 0.0, 0.0, 0.0, slip=(1.13, 0.77))
    for contact, losses in (
        (sc.Coulomb(0.66), None),
        (sc.custom.Friction(lambda u: 0.66), None),
        (sc.Coulomb(0.66), sc.custom.Couple(lambda theta, w, normal: -0.004 * w)),
    ):
        with pytest.raises(ValueError, match="no unique contact force"):
            sc.roll(body, start, 1.0, contact=contact, losses=losses)


def test_a_fast_coin_that_is_let_go_slips_as_long_under_your_own_law_as_under_the_librarys():
    body = sc.Body.solid(0.3402622960016425)
    mu, static = 0.6556868629319276, 0.8111064716672821
    start = sc.State(0.00909255162267215, 0.00048418925295448017, 0.021660185503455425, 0.0)
    laws = sc.Coulomb(mu, static=static), sc.custom.Friction(lambda u: mu, static=static)
    library, own = (sc.roll(body, start, [0.0, 0.4], contact=law, tol=1e-12) for law in laws)
    # It rolls, slips as the static friction lets it go, and rolls again.
    assert [phase.kind for phase in own.phases[1:4]] == ["rolling", "slipping", "rolling"]
    off = max(abs(library.theta[-1] - own.theta[-1]), *abs(library.w[-1] - own.w[-1]))
    assert off <= library.error + own.error < 2e-9
