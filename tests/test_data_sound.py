"""Sound: recordings of phones are read, and the wobble is measured from synthetic ringing."""

import struct
import wave
import zipfile

import numpy as np
import pytest
from few import few

import spincyl as sc

HERTZ = 44_100


def whirr(slow, stop, seconds, *, noise=0.5, depth=0.6, tone=3000.0, seed=1, hertz=HERTZ):
    """A ring of one tone, louder once per turn, of a disk under dry friction: rate ~ tau^(-1/3)."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(seconds * hertz)) / hertz
    turn = 1.5 * slow * stop * (1 - (1 - t / stop) ** (2 / 3))
    sound = (1 + depth * np.cos(2 * np.pi * turn)) ** 2 * np.sin(2 * np.pi * tone * t)
    return t, sound + noise * rng.normal(size=t.size), lambda at: slow * (1 - at / stop) ** (-1 / 3)


# wobble


@pytest.mark.parametrize("noise", [0.0, 0.5, 3.0], ids=["no noise", "noise", "noise louder than the ring"])
def test_the_wobble_is_found_to_a_hundredth_through_noise(noise):
    t, sound, true = whirr(20.0, 8.5, 8.2, noise=noise)
    found = sc.data.wobble(t, sound)
    assert np.abs(found.turns / true(found.t) - 1).max() < 0.01
    assert found.t[0] < 0.5 and found.t[-1] > 7.9 and len(found.t) >= 24


def test_the_errors_of_the_wobble_are_those_of_many_recordings():
    pulls = []
    for seed in range(6):
        t, sound, true = whirr(20.0, 6.5, 6.0, noise=2.0, seed=seed)
        found = sc.data.wobble(t, sound)
        pulls.append((found.turns - true(found.t)) / found.turns_err)
    # about 100 windows of eight turns
    assert 0.7 < np.std(np.concatenate(pulls)) < 1.3


def test_a_body_that_is_struck_once_a_turn_and_rings_down_is_heard_at_its_turns():
    rng = np.random.default_rng(3)
    t = np.arange(4 * HERTZ) / HERTZ
    turn = 1.5 * 15.0 * 4.5 * (1 - (1 - t / 4.5) ** (2 / 3))
    struck = np.diff(np.floor(turn), prepend=0.0)
    ring = np.exp(-t[:4000] / 0.01) * (
        np.sin(2 * np.pi * 3000 * t[:4000]) + np.sin(2 * np.pi * 7100 * t[:4000])
    )
    sound = np.convolve(struck, ring)[: t.size] + 0.05 * rng.normal(size=t.size)
    found = sc.data.wobble(t, sound)
    assert np.abs(found.turns / (15.0 * (1 - found.t / 4.5) ** (-1 / 3)) - 1).max() < 0.01


def test_a_hum_and_a_silent_beginning_do_no_harm():
    _, sound, true = whirr(20.0, 5.5, 5.0)
    rng = np.random.default_rng(2)
    before = 0.5 * rng.normal(size=2 * HERTZ)
    sound = np.r_[before, sound]
    time = np.arange(sound.size) / HERTZ
    sound += 2 * np.sin(2 * np.pi * 50 * time)
    found = sc.data.wobble(time, sound)
    heard = found.t > 2.2
    assert heard.sum() > 12 and np.abs(found.turns / true(found.t - 2.0) - 1)[heard].max() < 0.01


def test_a_second_whirr_is_left_out_and_a_warning_says_from_when_to_when():
    _, spins, _ = whirr(9.0, 60.0, 6.0, tone=2500.0)
    _, falls, _ = whirr(40.0, 2.5, 2.3, seed=2, tone=2500.0)
    rng = np.random.default_rng(4)
    quiet = 0.5 * rng.normal(size=2 * HERTZ)
    sound = np.r_[quiet, spins, falls, quiet]
    time = np.arange(sound.size) / HERTZ
    said = r"there is sound from (2|1\.9\d*) to 8[.01]\d* s as well, .* left out: .* from 8\.\d+ to 10"
    with pytest.warns(UserWarning, match=said):
        found = sc.data.wobble(time, sound)
    assert found.t[0] > 8 and found.turns.min() > 30
    # the other part alone is heard without a warning
    part = time < 8.0
    assert sc.data.wobble(time[part], sound[part]).turns.max() < 12


def test_a_whirr_that_goes_on_above_the_upper_limit_is_told_with_the_limit():
    _, rings, _ = whirr(15.0, 9.0, 8.991, noise=0.0)  # to 150 turns a second
    sound = np.r_[np.zeros(int(2.3 * HERTZ)), rings]
    sound += 0.05 * np.random.default_rng(2).normal(size=sound.size)
    said = r"goes on right after it.* raise the upper limit of between= \(now 30 per second\)"
    with pytest.warns(UserWarning, match=said):
        found = sc.data.wobble(np.arange(sound.size) / HERTZ, sound, between=(2.0, 30.0))
    assert 15 < found.turns[-1] < 36 and found.t[0] > 2.3


def test_a_wobble_that_slows_down_is_followed_too():
    t, sound, true = whirr(20.0, 8.5, 8.0)
    found = sc.data.wobble(t, sound[::-1])
    assert np.abs(found.turns / true(t[-1] - found.t) - 1).max() < 0.01
    assert found.turns[0] > found.turns[-1]


def test_the_clock_of_the_recording_is_kept():
    t, sound, _ = whirr(20.0, 5.5, 5.0)
    early, late = sc.data.wobble(t, sound), sc.data.wobble(t + 100.0, 7 * sound)
    assert np.allclose(late.t - early.t, 100.0) and np.allclose(late.turns, early.turns, rtol=2e-4)
    assert repr(early).startswith("<Wobble: 20.")


@pytest.mark.parametrize("seed", few(range(5), 2))
def test_no_wobble_is_heard_in_noise_or_in_an_even_tone(seed):
    t = np.arange(4 * HERTZ) / HERTZ
    noise = np.random.default_rng(seed).normal(size=t.size)
    for sound in (noise, np.sin(2 * np.pi * 3000 * t) + 0.1 * noise):
        with pytest.raises(ValueError, match="no whirr of 2 to 200 turns"):
            sc.data.wobble(t, sound)


def test_what_is_no_recording_is_refused_by_name():
    t, sound, _ = whirr(20.0, 5.5, 5.0)
    torn = sound.copy()
    torn[7:9] = np.nan
    uneven = t.copy()
    uneven[t > 2] += 1.0
    for wrong, said in (
        ((t, 0 * sound), "sound: the recording is silent"),
        ((t, 0 * sound + 0.3), "sound: the recording is silent"),
        ((t[:2000], sound[:2000]), "sound: too short"),
        ((t[:1], sound[:1]), "sound: too short"),
        ((t, torn), "sound: expected finite numbers; 2 are NaN"),
        ((torn, sound), "t: expected finite numbers; 2 are NaN"),
        ((uneven, sound), "t: expected evenly spaced"),
        ((t, sound[:-1]), "t and sound: expected equal shapes"),
        ((t[::20], sound[::20]), "t: 2.2e\\+03 samples a second"),
    ):
        with pytest.raises(ValueError, match=said):
            sc.data.wobble(*wrong)
    with pytest.raises(TypeError, match="sound"):
        sc.data.wobble(t, "loud")
    with pytest.raises(TypeError, match="between"):
        sc.data.wobble(t, sound, between=3.0)
    for between in ((0.0, 10.0), (10.0, 5.0), (10.0, 11.0), (1.0, np.nan)):
        with pytest.raises(ValueError, match="between"):
            sc.data.wobble(t, sound, between=between)


# WAV


def written(tmp_path, samples, width, channels=1):
    path = tmp_path / "whirr.wav"
    with wave.open(str(path), "wb") as file:
        file.setnchannels(channels)
        file.setsampwidth(width)
        file.setframerate(8000)
        file.writeframes(samples)
    return path


@pytest.mark.parametrize("width", [1, 2, 3, 4])
def test_a_wav_file_of_any_width_is_read(tmp_path, width):
    true = np.array([0.0, 0.5, -0.5, 0.25, -1.0])
    if width == 1:
        raw = (128 + 128 * true).astype(np.uint8).tobytes()
    else:
        whole = (true * 2.0 ** (8 * width - 1)).astype(np.int64)
        raw = b"".join(int(x).to_bytes(width, "little", signed=True) for x in whole)
    t, sound = sc.data.read_sound(written(tmp_path, raw, width))
    assert np.array_equal(sound, true) and np.array_equal(t, np.arange(5) / 8000)


@pytest.mark.parametrize("kind", ["<f4", "<f8"])
def test_a_wav_file_of_floats_with_other_chunks_is_read(tmp_path, kind):
    true = np.array([0.5, -0.25, 0.125])
    body = true.astype(kind).tobytes()
    size = np.dtype(kind).itemsize
    form = struct.pack("<HHIIHH", 3, 1, 48_000, 48_000 * size, size, 8 * size)
    chunks = b"LIST" + struct.pack("<I", 3) + b"abc\0" + b"fmt " + struct.pack("<I", 16) + form
    raw = chunks + b"data" + struct.pack("<I", len(body)) + body
    path = tmp_path / "whirr.wav"
    path.write_bytes(b"RIFF" + struct.pack("<I", 4 + len(raw)) + b"WAVE" + raw)
    t, sound = sc.data.read_sound(path)
    assert np.array_equal(sound, true) and t[1] == 1 / 48_000


def test_channels_are_averaged_and_half_a_frame_is_left_out(tmp_path):
    raw = np.array([[100, 300], [-200, 0]], "<i2").tobytes() + b"\1\2"
    path = written(tmp_path, raw[:8], 2, channels=2)
    torn = path.read_bytes() + b"\1\2"
    torn = torn.replace(b"data" + struct.pack("<I", 8), b"data" + struct.pack("<I", 10))
    path.write_bytes(torn)
    _, sound = sc.data.read_sound(path)
    assert np.array_equal(sound, np.array([200, -100]) / 2**15)


def test_what_is_no_plain_wav_file_is_refused_with_its_name(tmp_path):
    good = written(tmp_path, bytes(8), 2).read_bytes()
    for raw, said in (
        (b"ID3 and more", "not a WAV file"),
        (b"", "not a WAV file"),
        (good[:36], "no samples"),
        (good[:44], "no samples"),
        (good.replace(struct.pack("<HH", 1, 1), struct.pack("<HH", 6, 1)), "format 6"),
    ):
        path = tmp_path / "other.wav"
        path.write_bytes(raw)
        with pytest.raises(ValueError, match=said) as caught:
            sc.data.read_sound(path)
        assert "other.wav" in str(caught.value)
    with pytest.raises(OSError, match="nowhere"):
        sc.data.read_sound(tmp_path / "nowhere.wav")


# phyphox

NAMES = ("Time (s)", "Recording (a.u.)")
ROWS = ((0.0, -1.25e-2), (2.2675737e-5, float("nan")), (4.5351474e-5, 0.5))


def exported(delimiter=",", comma=False, quote='"'):
    lines = [delimiter.join(f"{quote}{name}{quote}" for name in NAMES)]
    for row in ROWS:
        cells = (f"{x:.9E}".replace("NAN", "NaN").replace(".", "," if comma else ".") for x in row)
        lines.append(delimiter.join(cells))
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    ("delimiter", "comma"), [(",", False), (";", False), (";", True), ("\t", False), ("\t", True)]
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_a_table_of_phyphox_is_read_with_any_delimiter_and_decimal_sign(tmp_path, delimiter, comma, encoding):
    path = tmp_path / "Raw Data.csv"
    path.write_bytes(exported(delimiter, comma).encode(encoding))
    found = sc.data.read_phyphox(path)
    assert list(found) == ["Raw Data"] and tuple(found["Raw Data"]) == ("Time", "Recording")
    assert found["Raw Data"].units == {"Time": "s", "Recording": "a.u."}
    assert all(found["Raw Data"][name] is found["Raw Data"][name.split(" (")[0]] for name in NAMES)
    for column, true in zip(found["Raw Data"].values(), zip(*ROWS, strict=True), strict=True):
        assert np.allclose(column, true, rtol=1e-9, equal_nan=True)


def test_a_zip_file_of_phyphox_gives_its_tables_and_not_what_it_says_of_the_phone(tmp_path):
    path = tmp_path / "Audio Scope 2026-11-22.zip"
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("Raw Data.csv", exported())
        file.writestr("Amplitude.csv", '"Time (s)","Sound pressure level (dB)"\n0.1,-40\n0.2,\n')
        file.writestr("meta/device.csv", '"property","value"\n"version","1.1.16"\n')
    found = sc.data.read_phyphox(path)
    assert list(found) == ["Raw Data", "Amplitude"]
    level = found["Amplitude"]["Sound pressure level (dB)"]
    assert level[0] == -40 and np.isnan(level[1])


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        (b"", "column names"),
        (b'"Time (s)"\n', "column names"),
        (b"0.1,0.2\n0.3,0.4\n", "line 1"),
        (b'"a","a"\n1,2\n', "line 1"),
        (b'"Time (s)","Recording (a.u.)"\n0,1\n1,loud\n', "line 3"),
        (b'"Time (s)","Recording (a.u.)"\n0,1,2\n', "line 2"),
        (b"\xd0\xcf\x11\xe0\0\0\0\0", "as CSV"),
    ],
)
def test_what_is_no_table_of_phyphox_is_refused_with_file_and_line(tmp_path, raw, said):
    path = tmp_path / "export.csv"
    path.write_bytes(raw)
    with pytest.raises(ValueError, match=said) as caught:
        sc.data.read_phyphox(path)
    assert "export.csv" in str(caught.value)


def test_a_zip_file_without_tables_and_a_torn_one_are_refused(tmp_path):
    path = tmp_path / "export.zip"
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("meta/device.csv", "a,b\n1,2\n")
    with pytest.raises(ValueError, match="export.zip: this zip file contains no CSV"):
        sc.data.read_phyphox(path)
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("Raw Data.csv", exported())
    raw = bytearray(path.read_bytes())
    raw[raw.index(b"Recording")] ^= 1
    path.write_bytes(raw)
    with pytest.raises(ValueError, match="export.zip: .*CRC"):
        sc.data.read_phyphox(path)
    with pytest.raises(OSError, match="nowhere"):
        sc.data.read_phyphox(tmp_path / "nowhere.csv")


def test_a_recording_of_phyphox_is_heard(tmp_path):
    t, sound, true = whirr(40.0, 2.2, 2.0)
    path = tmp_path / "Raw Data.csv"
    np.savetxt(
        path, np.column_stack([t, sound]), "%.9E", ",", header='"Time (s)","Recording (a.u.)"', comments=""
    )
    found = sc.data.wobble(*sc.data.read_phyphox(path)["Raw Data"].values())
    assert np.abs(found.turns / true(found.t) - 1).max() < 0.01
