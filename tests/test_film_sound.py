"""The sound of films, and how loud an impact is beside a whirr."""

import subprocess

import numpy as np
import pytest
from page_scenes import COIN, PIPE, motion_of
from test_page_losses import heard

import spincyl as sc

SIZE = sc.Scale(radius=0.0375, mass=0.44)
SMALL = {"size": (96, 64)}


def film_sound(path):
    """The sound of a film as ffmpeg decodes it: samples, and their rate; None without a sound."""
    ffmpeg = pytest.importorskip("imageio_ffmpeg").get_ffmpeg_exe()
    words = [ffmpeg, "-i", str(path), "-vn", "-f", "s16le", "-ac", "1", "-ar", "22050", "-"]
    ran = subprocess.run(words, capture_output=True)
    if b"Audio:" not in ran.stderr:
        return None
    return np.frombuffer(ran.stdout, "<i2") / 32768, 22050


def level(x, rate, seconds=0.03):
    """The root mean square of a sound around each sample."""
    many = int(seconds * rate)
    return np.sqrt(np.convolve(x**2, np.ones(many) / many, "same"))


@pytest.mark.parametrize("slow", [5, 20])
def test_a_film_is_loud_when_its_contact_point_passes_the_camera_however_slow_it_is(tmp_path, slow):
    m = sc.roll(COIN, COIN.steady(0.3), 8.0)
    path = sc.view(m, scale=SIZE, slow=slow).save(tmp_path / "coin.mp4", fps=5, seconds=8, **SMALL)
    x, rate = film_sound(path)
    lasts = min(8.0, 8.0 * SIZE.seconds(1.0) * slow)
    assert x.size / rate == pytest.approx(lasts, abs=0.5), "as long as the pictures"
    t = np.arange(0.2, lasts - 0.2, 0.01)
    there = m.wanting("pose", t=t / slow / SIZE.seconds(1.0))
    off = there.contact_point - there.centre[:, :2]
    azimuth = np.arctan2(off[:, 1], off[:, 0]) + 1.1  # from the camera
    loud = level(x, rate, 0.05)[(t * rate).astype(int)]
    front, back = loud[np.cos(azimuth) > 0.9].mean(), loud[np.cos(azimuth) < -0.9].mean()
    assert front > 6 * back
    # the mean direction of the loudness is the camera's
    assert abs(np.angle((loud * np.exp(1j * azimuth)).sum())) < 0.2


def test_an_impact_of_a_film_is_heard_when_it_is_seen(tmp_path):
    m = fallen()
    hit = SIZE.seconds(m.impacts[0].time)
    assert hit > 0.02
    path = sc.view(m, scale=SIZE, slow=20).save(tmp_path / "fall.mp4", fps=10, seconds=5, **SMALL)
    x, rate = film_sound(path)
    first = np.flatnonzero(np.abs(x) > 0.2 * np.abs(x).max())[0] / rate
    # AAC begins up to a frame of 1024 samples late or early
    assert first == pytest.approx(20 * hit, abs=0.06)
    assert level(x, rate)[: int((20 * hit - 0.1) * rate)].max() < 1e-3, "in the air it is silent"


def fallen():
    """A coin that falls from twice its radius, bounces, and whirrs."""
    start = sc.dropped(COIN, 4.0, 0.4, w1=1.0)
    how = {"contact": sc.Coulomb(0.3), "restitution": 0.4}
    return sc.roll(COIN, start, np.linspace(0.0, 60.0, 601), losses=sc.loss.DryContour(2e-3), **how)


def test_a_whirr_is_heard_beside_a_first_impact_and_a_compression_of_1_gives_the_true_ratio(tmp_path):
    m = fallen()
    true, usual = (heard(m.sound(tmp_path / "x.wav", scale=SIZE, **how)) for how in ({"compression": 1}, {}))
    rate = true[1]
    loudest = max(m.impacts, key=lambda x: np.linalg.norm(x.impulse))
    hit = int(SIZE.seconds(loudest.time) * rate)
    late = slice(int(SIZE.seconds(12.0) * rate), int(SIZE.seconds(30.0) * rate))
    below = [
        20 * np.log10(level(x, rate)[late].max() / np.abs(x[hit : hit + 400]).max()) for x, _ in (true, usual)
    ]
    assert below[0] < -17 and below[1] > below[0] + 5, below


def test_the_whirr_is_compressed_with_the_root_of_its_speed(tmp_path):
    m = motion_of("whirr")
    t = np.array([1.0, 16.6])
    there = m.wanting("pose", t=t)
    s, c = np.sin(there.theta), np.cos(there.theta)
    speed = np.abs(there.w[:, 2] - there.w[:, 0] * c / s)  # psi'
    grows = {}
    for compression in (1.0, 2.0):
        x, rate = heard(m.sound(tmp_path / "x.wav", scale=SIZE, compression=compression))
        slow, fast = (level(x, rate, 0.05)[int(at * rate) - 1000 :][:2000].mean() for at in SIZE.seconds(t))
        grows[compression] = fast / slow
    # the beat is the same in both
    assert grows[1.0] / grows[2.0] == pytest.approx((speed[1] / speed[0]) ** 0.25, rel=0.05)
    assert speed[1] / speed[0] > 2


def test_the_true_ratio_of_two_impacts_is_that_of_their_impulses_and_half_the_decibels_by_default(tmp_path):
    ball = sc.Body.ball(0.0, 0.4, 0.4)
    m = sc.roll(ball, sc.dropped(ball, 2.0, 1.0), 12.0, contact=sc.Coulomb(0.3), restitution=0.5)
    a, b = m.impacts[:2]
    assert SIZE.seconds(b.time - a.time) > 0.1, "the first has ceased to ring"
    ratio = np.linalg.norm(b.impulse) / np.linalg.norm(a.impulse)
    for compression in (1.0, 2.0, 4.0):
        x, rate = heard(m.sound(tmp_path / "x.wav", scale=SIZE, compression=compression))
        first, second = (np.abs(x[round(SIZE.seconds(e.time) * rate) :][:400]).max() for e in (a, b))
        assert second / first == pytest.approx(ratio ** (1 / compression), rel=0.05), compression


def test_a_film_without_sound_and_a_film_of_silence_have_none(tmp_path):
    coin = sc.roll(COIN, COIN.steady(0.3), 1.0)
    still = sc.roll(COIN, sc.State(COIN.theta_balance, 0.0, 0.0, 0.0), 1.0)
    for m, how in ((coin, {"sound": False}), (still, {})):
        path = sc.view(m, slow=1).save(tmp_path / "film.mp4", fps=5, **SMALL, **how)
        assert film_sound(path) is None
    with pytest.raises(ValueError, match="^sound: motion: there is nothing to hear, since the contact point"):
        sc.view(still, slow=1).save(tmp_path / "no.mp4", fps=5, sound=True)
    with pytest.raises(ValueError, match="^sound: a GIF has no sound; write an .mp4"):
        sc.view(coin, slow=1).save(tmp_path / "no.gif", fps=5, sound=True)
    with pytest.raises(TypeError, match="^sound: expected True or False, not int"):
        sc.view(coin, slow=1).save(tmp_path / "no.mp4", sound=2)
    with pytest.raises(ValueError, match="sound: only for a film"):
        coin_page = sc.view(coin)
        coin_page.save(tmp_path / "no.html", sound=True)
    assert not list(tmp_path.glob("no.*"))


def test_of_two_motions_side_by_side_both_are_heard(tmp_path):
    tube = sc.roll(PIPE, PIPE.steady(1.2), 0.5)
    coin = sc.roll(COIN, COIN.steady(0.1), 1.0)
    both = sc.view(tube, coin, slow=2).save(tmp_path / "two.mp4", fps=5, **SMALL)
    one = sc.view(tube, slow=2).save(tmp_path / "one.mp4", fps=5, **SMALL)
    (x, rate), (y, _) = film_sound(both), film_sound(one)
    assert x.size / rate > 1.9 and np.abs(x[int(1.5 * rate) :]).max() > 0.01
    assert y.size / rate < 1.4


def test_a_motion_writes_its_film(tmp_path):
    m = sc.roll(COIN, COIN.steady(0.3), 0.3)
    assert film_sound(m.film(tmp_path / "coin.mp4", 0.2)) is not None
    assert film_sound(m.film(tmp_path / "coin.mp4", 0.2, sound=False)) is None
    with pytest.raises(ValueError, match=r"^path = .*: expected a name that ends in .mp4 or .gif"):
        m.film(tmp_path / "coin.html")


@pytest.mark.parametrize("wrong", [0.5, -1.0, float("nan"), 1e3])
def test_a_compression_has_a_range(tmp_path, wrong):
    with pytest.raises(ValueError, match=f"^compression = {wrong}"):
        sc.roll(COIN, COIN.steady(0.3), 1.0).sound(tmp_path / "x.wav", scale=SIZE, compression=wrong)
