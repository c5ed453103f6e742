"""Bounces that are heard: the coefficient of restitution and the height of a drop, with errors that hold."""

import math
import warnings

import numpy as np
import pytest

import spincyl as sc

G = 9.80665
#: Intervals of one golf ball from 110 cm, two table tennis balls from 30 cm, a rubber ball from 45 cm, and a
#: tennis ball from 25 cm, in seconds, by the acoustic stopwatch of phyphox: students' measurements (github.com/giiulia/
#: LabI-Dynamics-Thermodynamics, Coefficient_of_restitution/Method2/data.py, columns of pallina 4, 1, 2 and 3).
MEASURED = {
    "golf": (1.1, [0.838125, 0.750917, 0.672938, 0.606708, 0.546563, 0.492375, 0.438042, 0.388479]),
    "golf again": (1.1, [0.845188, 0.752771, 0.675458, 0.609083, 0.549146, 0.492646, 0.441208, 0.395563]),
    "table tennis": (0.3, [0.462354, 0.424521, 0.393896, 0.364625, 0.343646, 0.322542, 0.298938, 0.285729]),
    "rubber": (0.45, [0.531729, 0.465854, 0.411563, 0.364646, 0.325479, 0.291729, 0.255646, 0.222208]),
    "tennis": (0.25, [0.349583, 0.266708, 0.202625, 0.152771]),
}


def heard(e, height, many, begin=0.5, jitter=0.0, each=0.0, rng=None):
    """Times of the impacts of a ball that falls from a height, each with its own restitution."""
    rng = rng or np.random.default_rng(0)
    fall = math.sqrt(2 * height / G)
    lasts = 2 * fall * np.cumprod(e * (1 + each * rng.normal(size=many - 1)))
    return begin + fall + np.r_[0, np.cumsum(lasts)] + jitter * rng.normal(size=many)


@pytest.mark.parametrize("name", MEASURED)
def test_the_drop_of_published_measurements_is_found_within_four_per_cent(name):
    height, intervals = MEASURED[name]
    found = sc.data.fit_bounces(np.r_[0, np.cumsum(intervals)])
    assert abs(found.height - height) < 0.045 * height
    assert found.height_err < 0.05 * height and found.bounce.tolist() == list(range(len(intervals) + 1))
    # the height that the app gives after the first impact
    assert found.rebound == pytest.approx(9.81 / 8 * intervals[0] ** 2, rel=0.02)


@pytest.mark.parametrize("e", [0.3, 0.6, 0.9, 0.99])
def test_exact_times_give_the_restitution_and_the_height(e):
    t = heard(e, 0.8, 6)
    found = sc.data.fit_bounces(t[::-1], released=0.5, error=1e-6)
    assert found.restitution == pytest.approx(e, rel=1e-5) and found.height == pytest.approx(0.8, rel=1e-4)
    assert found.rebound == pytest.approx(0.8 * e**2, rel=1e-4)
    assert found.fall == pytest.approx(0.8, rel=1e-9) and found.first == pytest.approx(e, rel=1e-4)


def test_the_impacts_of_a_dropped_disk_give_its_restitution():
    ball = sc.measured(outer_diameter="40mm", length="5mm")
    m = sc.roll(ball, sc.dropped(ball, "0.5m", 0.0), 3.0, restitution=0.8, contact=sc.Coulomb(0.3))
    times = [hit.time for hit in m.impacts][:8]
    found = sc.data.fit_bounces(times, released=0.0, error=1e-6)
    assert found.restitution == pytest.approx(0.8, abs=1e-5) and found.fall == pytest.approx(0.5, rel=1e-6)


@pytest.mark.parametrize(("jitter", "each"), [(0.0, 0.01), (5e-4, 0.01), (2e-4, 0.005)])
def test_the_errors_cover_the_truth_two_times_of_three(jitter, each):
    inside = []
    for seed in range(120):
        t = heard(0.88, 0.8, 8, jitter=jitter, each=each, rng=np.random.default_rng(seed))
        with warnings.catch_warnings(action="ignore"):
            found = sc.data.fit_bounces(t)
        inside.append(
            [
                abs(found.restitution - 0.88) < found.restitution_err,
                abs(found.height - 0.8) < found.height_err,
            ]
        )
    assert ((np.mean(inside, axis=0) > 0.56) & (np.mean(inside, axis=0) < 0.85)).all()  # 0.68 +- 0.04


@pytest.mark.parametrize("many", [6, 9, 12])
@pytest.mark.parametrize(("jitter", "each"), [(3e-4, 0.0), (1e-3, 0.0), (1e-4, 0.01)])
def test_errors_of_known_times_are_as_large_as_the_deviations(many, jitter, each):
    off = []
    for seed in range(40):
        rng = np.random.default_rng(seed)
        e, height = rng.uniform(0.75, 0.92), rng.uniform(0.3, 1.2)
        with warnings.catch_warnings(action="ignore"):
            found = sc.data.fit_bounces(heard(e, height, many, 0.5, jitter, each, rng), error=jitter)
        off.append(
            [(found.restitution - e) / found.restitution_err, (found.height - height) / found.height_err]
        )
    rms = np.sqrt(np.mean(np.square(off), axis=0))
    assert ((rms > 0.6) & (rms < 1.4)).all(), rms


def test_a_missed_click_is_counted_and_echoes_and_knocks_are_left_out():
    for seed in range(40):
        rng = np.random.default_rng(seed)
        t = heard(0.88, 0.8, 11, jitter=3e-4, each=0.004, rng=rng)
        lost = int(rng.integers(2, 8))
        knock, echo = float(rng.uniform(0.2, 0.4)), t[int(rng.integers(0, 6))] + 0.06
        rough = np.r_[knock, np.delete(t, lost), echo, t[-1] + 1.7, np.nan]
        with warnings.catch_warnings(action="ignore"):
            found = sc.data.fit_bounces(rng.permutation(rough))
        assert lost not in found.bounce and found.bounce[-1] == 10 and found.t.size == 10, seed
        assert found.missed == pytest.approx([t[lost]], abs=0.03) and found.extra.size == 3
        assert abs(found.restitution - 0.88) < 4 * found.restitution_err
        assert abs(found.height / 0.8 - 1) < 0.08
    assert "1 missed, 3 no bounces" in repr(found) and "no bounces = " in found.report()


def recorded(t, rng, rate=22_050, ring=0.01):
    """The sound of clicks at these times, each softer, in noise and hum, after silence."""
    seconds = np.arange(int((t[-1] + 1) * rate)) / rate
    sound = rng.normal(0, 0.003, seconds.size) + 0.02 * np.sin(2 * np.pi * 50 * seconds)
    for k, at in enumerate(t):
        after = np.clip(seconds - at, 0, None)
        sound += (seconds >= at) * 0.6 * 0.85**k * np.exp(-after / ring) * np.sin(2 * np.pi * 2000 * after)
    return seconds, sound


def test_a_recording_gives_the_times_of_its_clicks_to_a_fraction_of_a_millisecond():
    for seed in range(5):
        rng = np.random.default_rng(seed)
        t = heard(0.85, 0.7, 9, each=0.003, rng=rng)
        found = sc.data.fit_bounces(*recorded(t, rng))
        assert found.t.size == 9 and np.abs(found.t - t - (found.t - t).mean()).max() < 4e-4
        alone = sc.data.fit_bounces(t)
        assert found.restitution == pytest.approx(alone.restitution, abs=0.5 * found.restitution_err)


def test_the_example_is_a_drop_from_sixty_centimetres_with_a_knock_and_a_missed_bounce():
    found = sc.data.fit_bounces(*sc.data.read_sound(sc.data.example("bounces")))
    assert (
        abs(found.height - 0.6) < 2 * found.height_err
        and abs(found.restitution - 0.88) < 3 * found.restitution_err
    )
    assert 4 not in found.bounce and found.extra == pytest.approx([0.31], abs=2e-3)


def test_a_ball_that_the_air_slows_is_warned_of_and_its_drop_follows_the_trend():
    e = np.linspace(0.84, 0.93, 10)
    fall = math.sqrt(2 * 0.5 / G)
    t = np.r_[0, np.cumsum(2 * fall * np.cumprod(e))] + 1e-4 * np.random.default_rng(1).normal(size=11)
    with pytest.warns(
        UserWarning, match="the ratio of the intervals changes, from 0.8.* the air slows the ball"
    ):
        found = sc.data.fit_bounces(t)
    assert found.trend == pytest.approx(0.01, rel=0.2) and found.height == pytest.approx(0.5, rel=0.02)


def test_the_fall_itself_gives_the_height_where_the_first_impact_differs():
    t = heard(0.9, 0.5, 7)
    t = np.r_[t[0], t[0] + (t[1:] - t[0]) * 0.7]  # the first impact takes more than the others
    found = sc.data.fit_bounces(t, released=0.5, error=2e-4)
    assert found.fall == pytest.approx(0.5, rel=1e-6) and found.first == pytest.approx(0.63, rel=1e-3)
    assert found.height == pytest.approx(0.245, rel=1e-2) and "(from the fall)" in found.report()


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"t": [1.0, 2.0]}, "^t: expected 4 to 1000 clicks, not 2"),
        ({"t": [0.0, 1.0, 2.0, 3.0, 4.0]}, "^t: no 4 of the 5 clicks have intervals that shrink"),
        ({"t": [0.0, 1.0, 2.1, 3.4, 4.9]}, "^t: no 4 of the 5 clicks have intervals that shrink"),
        ({"t": np.ones((2, 3))}, "^t: expected a list of times"),
        ({"t": [0.0, math.inf, 1.0, 2.0, 3.0]}, "^t: expected finite"),
        ({"t": [0.0, 1.0, 1.9, 2.7, 3.42], "error": -1.0}, "^error = -1.0: expected a positive time"),
        ({"t": [0.0, 1.0, 1.9, 2.7, 3.42], "gravity": 0.0}, "^gravity = 0.0: expected a positive"),
        (
            {"t": [0.0, 1.0, 1.9, 2.7, 3.42], "released": 1.0},
            "^released = 1.0: expected a time up to 100 s before",
        ),
        ({"t": np.arange(4000) / 8000, "sound": np.zeros(4000)}, "^sound: the recording is silent"),
        ({"t": np.arange(400) / 800, "sound": np.ones(400)}, "^t: expected evenly spaced times"),
        ({"t": np.arange(400) / 8000, "sound": np.ones(40)}, "^t and sound: expected equal shapes"),
        ({"t": np.arange(4000) / 8000, "sound": np.full(4000, np.nan)}, "^sound: expected finite"),
    ],
)
def test_what_is_no_row_of_bounces_is_refused(given, told):
    with pytest.raises(ValueError, match=told):
        sc.data.fit_bounces(**given)


def test_noise_has_no_bounces():
    rng = np.random.default_rng(2)
    with pytest.raises(ValueError, match="clicks in the recording|have intervals that shrink"):
        sc.data.fit_bounces(np.arange(16000) / 8000, rng.normal(size=16000))


def test_times_in_milliseconds_are_warned_of():
    t = 0.5 + np.cumsum([0.0, *0.6 * 0.85 ** np.arange(7)])
    t += np.random.default_rng(3).normal(0, 2e-4, t.size)
    assert 0.4 < sc.data.fit_bounces(t).height < 0.8
    with pytest.warns(UserWarning, match=r"^t: such bounces follow a drop from .* m; .* milliseconds\?$"):
        sc.data.fit_bounces(1e3 * t)
