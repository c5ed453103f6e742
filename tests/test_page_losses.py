"""A body that comes to rest: the page, the photograph, the sound."""

import wave

import numpy as np
import pytest
from page_scenes import COIN as DISK  # Euler's disk
from page_scenes import PIPE, motion_of, page_of
from pages import clock, go, near, picture

import spincyl as sc
from spincyl.studio.poses import knots, pace, span

SIZE = sc.Scale(radius=0.0375, mass=0.44)
BLUE = (0.0, 0.33, 0.63)


def test_the_page_follows_a_whirr_to_its_last_turn(shown):
    m = motion_of("whirr")
    page = shown(page_of("whirr", scale=SIZE), "#t=0.5")
    end = m.event.time
    t = np.array([0.0, 3.0, 10.0, 16.0, 17.0, 17.2, end - 1e-3])
    there = m.wanting("pose", t=t)
    for k, time in enumerate(t):
        seen = page.evaluate(
            "t => { const p = window.spincyl.pose(0, t); return [p.theta, p.phi, ...p.centre]; }", time
        )
        assert seen[0] == pytest.approx(there.theta[k], abs=3e-3)
        assert seen[1] == pytest.approx(there.phi[k], abs=3e-3)
        assert seen[2:] == pytest.approx(there.centre[k], abs=3e-3)
    assert clock(page).startswith("t = 0.5000 s") and near(picture(page), BLUE) > 0.005
    go(page, end)
    assert "ended: the face landed on the table: the body lies flat, t = 1.0682 s" in clock(page)
    assert near(picture(page), BLUE) < 0.001, "what has ended is grey"
    assert page.complaints == [] and len(page.requests) == 1


@pytest.mark.parametrize("contact", ["rolling", "smooth", sc.Coulomb(0.2), sc.Viscous(0.3)], ids=repr)
def test_a_cubic_between_few_knots_meets_a_motion_with_losses(contact):
    m = sc.roll(
        DISK, DISK.steady(0.3).kicked(0.05), 12.0, losses=sc.loss.RollingResistance(3e-3), contact=contact
    )
    found = knots(m)
    assert len(found) < 600 and found[0, 0] == 0 and found[-1, 0] == pytest.approx(span(m)[1])
    html = sc.view(m).html
    assert ("F the friction" in html) == (not isinstance(contact, str)), (
        "forces are shown where there is a law"
    )


def test_nutations_become_shorter_as_a_disk_falls():
    m = motion_of("whirr")
    first, last = (sc.swing(DISK, DISK.steady(theta).kicked(1e-3)).period for theta in (0.3, 0.02))
    assert last < 0.3 * first and last < pace(m) < 0.75 * first


def test_a_photograph_of_a_tube_that_hardly_loses_is_that_of_one_that_does_not():
    start = PIPE.steady(np.radians(89.5))
    turn = 2 * np.pi / start.precession
    plain = sc.exposure(sc.roll(PIPE, start, turn), samples=1e5, size=100)
    losing = sc.exposure(sc.roll(PIPE, start, turn, losses=sc.loss.AirLinear(1e-12)), samples=1e5, size=100)
    assert np.abs(losing - plain).sum() < 1e-3 * plain.sum()
    slows = sc.exposure(sc.roll(PIPE, start, turn, losses=sc.loss.AirLinear(0.5)), samples=1e5, size=100)
    assert np.abs(slows - plain).sum() > 0.5 * plain.sum(), "what slows down is another picture"


# The sound.


def heard(path):
    with wave.open(str(path)) as file:
        assert (file.getnchannels(), file.getsampwidth()) == (1, 2)
        rate = file.getframerate()
        return np.frombuffer(file.readframes(file.getnframes()), "<i2") / 32768, rate


def beat(x, rate):
    """The strongest frequency in the loudness."""
    loud = np.abs(x)[: x.size // 512 * 512].reshape(-1, 64).mean(axis=1)
    spectrum = np.abs(np.fft.rfft((loud - loud.mean()) * np.hanning(loud.size), 16 * loud.size))
    found = np.fft.rfftfreq(16 * loud.size, 64 / rate)
    return found[spectrum.argmax()]


@pytest.mark.parametrize("theta", [0.05, 0.2, 0.6])
def test_the_ring_beats_once_a_turn_of_the_contact(theta, tmp_path):
    start = DISK.steady(theta)
    m = sc.roll(DISK, start, 40.0, losses=sc.loss.AirLinear(1e-9))
    x, rate = heard(m.sound(tmp_path / "ring.wav", 2.0, scale=SIZE))
    assert rate == 44_100 and x.size == pytest.approx(2.25 * rate, abs=2)
    assert beat(x[: 2 * rate], rate) == pytest.approx(SIZE.turns(start.precession), rel=0.01)
    assert 0.85 < np.abs(x).max() < 0.95


def test_a_whirr_beats_faster_to_its_end_and_then_is_still(tmp_path):
    m = motion_of("whirr")
    x, rate = heard(m.sound(tmp_path / "whirr.wav", scale=SIZE, rate=22_050))
    assert rate == 22_050
    end = SIZE.seconds(m.event.time)
    pieces = [(0.0, 0.3), (0.4, 0.7), (0.8, 1.0)]
    for first, last in pieces:
        middle = np.array([first, last]) / SIZE.seconds(1.0)
        turns = np.diff(m.wanting("pose", t=middle).phi)[0] / (2 * np.pi) / (last - first)
        assert beat(x[int(first * rate) : int(last * rate)], rate) == pytest.approx(turns, rel=0.12)
    assert np.abs(x[int((end + 0.2) * rate) :]).max() < 0.01, "the ring has decayed"
    again, _ = heard(m.sound(tmp_path / "again.wav", scale=SIZE, rate=22_050))
    assert np.array_equal(x, again)


def test_an_exact_motion_sounds_too(tmp_path):
    x, _ = heard(sc.roll(DISK, DISK.steady(0.2), 20.0).sound(tmp_path / "x.wav", scale=SIZE))
    assert np.abs(x).max() > 0.85


@pytest.mark.parametrize(
    ("ask", "error", "match"),
    [
        (lambda m, d: m.sound(d / "x.mp3", scale=SIZE), ValueError, "^path = .* ends in .wav"),
        (lambda m, d: m.sound(d / "x.wav", scale=1.0), TypeError, "^scale: expected a Scale, not float"),
        (lambda m, d: m.sound(d / "x.wav"), TypeError, "scale"),
        (
            lambda m, d: m.sound(d / "x.wav", 5.0, scale=SIZE),
            ValueError,
            "^seconds = 5.0: .* at most 1.06822",
        ),
        (lambda m, d: m.sound(d / "x.wav", -1.0, scale=SIZE), ValueError, "^seconds = -1.0"),
        (lambda m, d: m.sound(d / "x.wav", scale=SIZE, rate=100), ValueError, "^rate = 100"),
        (
            lambda m, d: m.sound(d / "x.wav", scale=sc.Scale(1e6)),
            ValueError,
            "motion: .* s, expected at most 180; give seconds=",
        ),
        (lambda m, d: m.sound(d / "no" / "x.wav", scale=SIZE), OSError, "No such file"),
    ],
)
def test_what_makes_no_sound_is_refused(ask, error, match, tmp_path):
    with pytest.raises(error, match=match):
        ask(motion_of("whirr"), tmp_path)


def test_backward_in_time_there_is_nothing_to_hear(tmp_path):
    with pytest.raises(ValueError, match="^motion: expected ascending times for a sound"):
        sc.roll(DISK, DISK.steady(0.2), [0.0, -5.0]).sound(tmp_path / "x.wav", scale=SIZE)


COIN = sc.measured(outer_diameter=25.75e-3, length=2.2e-3, mass=8.5e-3, fillet=0.4e-3)
TOP = sc.Body.ball(-0.2, 0.4, 0.42)
LAID = sc.loss.RollingResistance.from_si(5e-4, scale=COIN)


@pytest.mark.parametrize(
    "motion",
    [
        lambda: sc.roll(
            COIN, COIN.steady(0.35), np.linspace(0, 30, 301), losses=LAID, contact=sc.Coulomb(0.3)
        ),
        lambda: sc.roll(COIN, COIN.steady(0.35), 30.0, losses=LAID),
        lambda: sc.roll(COIN, COIN.steady(1e-7), 0.3),
        lambda: sc.roll(COIN, COIN.steady(0.35), 1e-6),
        lambda: sc.roll(COIN, sc.State(0.3, 2.0, 0.0, 0.1), 0.5, contact="smooth"),
        lambda: sc.roll(TOP, sc.State(0.5, 0.0, 0.5, 0.0), 20.0),
    ],
    ids=[
        "slips to its face",
        "rolls to its face",
        "beyond hearing",
        "one sample",
        "no friction",
        "over a pole",
    ],
)
def test_a_motion_is_heard_whatever_its_end(motion, tmp_path):
    m = motion()  # warnings of NumPy are errors here
    x, rate = heard(m.sound(tmp_path / "x.wav", scale=None if m.scale else SIZE))
    first = x[: max(x.size - rate // 4, 100) // 2]
    assert 0.85 < np.abs(x).max() < 0.95
    assert np.sqrt(np.mean(first**2)) > 0.01, "it is heard before its last moments, too"


def test_what_comes_round_faster_than_samples_show_is_heard_as_its_mean():
    from spincyl.studio.sound import _loudness

    slow, fast = (_loudness(step * np.arange(1000.0)) for step in (0.01, 50.0))
    assert slow.max() == pytest.approx(1.0) and slow.min() == pytest.approx(np.exp(-4.0), rel=1e-3)
    angle = 2 * np.pi * (np.arange(64) + 0.5) / 64
    assert fast == pytest.approx(np.exp(2 * (np.cos(angle) - 1)).mean(), rel=1e-9)


def test_a_body_at_rest_makes_no_sound(tmp_path):
    coin = sc.Body.solid(0.1)
    still = sc.roll(coin, sc.State(coin.theta_balance, 0.0, 0.0, 0.0), 1.0)
    with pytest.raises(
        ValueError,
        match="^motion: there is nothing to hear, since the contact point does not move along the body",
    ):
        still.sound(tmp_path / "x.wav", scale=SIZE)
    assert not (tmp_path / "x.wav").exists()
