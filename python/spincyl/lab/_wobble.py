"""The rate at which the contact point of a whirring body goes round, from the envelope of its ringing.

The body rings at its natural frequencies, some kHz, and louder once per turn of the contact point, with
frequency Omega/(2 pi). This frequency appears in the spectrum of the envelope, not in that of the sound. The
envelope is the magnitude of the analytic signal (Gabor 1946) with frequencies weighted by their excess over
the noise. Dynamic programming (Viterbi 1967) follows its fundamental through a bank of filters of equal
relative width. The phase then refines this track: the envelope, averaged over each turn of the track, turns
within a window of several turns by the error of the track.
"""

from typing import NamedTuple

import numpy as np

from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import Floats, Reals, number, reals, warn

_TURNS_PER_WINDOW = 8  # turns in a window
_PER_OCTAVE = 24  # filters per octave
# least coherence: share of the fundamental that is in phase with the fit; noise has about 0.7
_LEAST_COHERENCE = 0.9
_MAINS = (50.0, 60.0)  # hertz
_HIGHEST_HUM = 2000.0  # hertz: harmonics of the mains up to here are removed, each within `_HUM_WIDTH` hertz
_HUM_WIDTH = 1.0
_LARGEST_JUMP = 0.4  # a larger jump of the logarithm of the rate means another sound
_LEAST_FUNDAMENTAL = 0.2  # least fundamental in any turn of a window, as a share of the window's mean
_KNOCK_SCATTER = 4.0  # a window whose scatter exceeds that of its neighbours by this factor contains a knock
_FEWEST_WINDOWS = 4  # least number of coherent windows in a row
_SYSTEMATIC_ERROR = 1e-3  # relative systematic error of a window without noise
# sound that is left out: its least level, as a share of that of the whirr, and its least duration in seconds
_LOUD, _LASTS = 0.7, 0.2
_NEAR_LIMIT = 1 / 3  # a whirr that ends above this share of the upper limit may go on beyond the limit


@compared_by_value
class Wobble(NamedTuple):
    """Turns per second of a contact point over time; returned by `wobble`.

    Attributes
    ----------
    t : ndarray, (n,)
        Times in seconds. Each is the middle of a window of eight turns; the windows do not overlap.
    turns : ndarray, (n,)
        Turns of the contact point per second, Omega/(2 pi), in each window.
    turns_err : ndarray, (n,)
        Standard errors of `turns`.
    """

    t: Floats
    turns: Floats
    turns_err: Floats

    def __repr__(self) -> str:
        return (
            f"<Wobble: {self.turns[0]:.4g} to {self.turns[-1]:.4g} turns a second"
            f" from {self.t[0]:.4g} to {self.t[-1]:.4g} s; {len(self.t)} times>"
        )


def wobble(t: Reals, sound: Reals, *, between: tuple[float, float] = (2.0, 200.0)) -> Wobble:
    """Find the turns per second of the contact point of a whirring body in a recording of its sound.

    Parameters
    ----------
    t : array_like, 1-D
        Evenly spaced times in seconds, as `read_sound` returns them.
    sound : array_like, 1-D
        The recording, in any unit.
    between : (float, float)
        Least and greatest turns per second that you expect. Only sound of more than twice the greatest
        frequency is used.

    Returns
    -------
    Wobble
        Turns per second while the whirr is audible. Its first and last turn, and windows that contain a
        knock, are left out. For a measured body, pass `t` and ``hertz=turns`` to `fit_losses`.

    Raises
    ------
    ValueError
        If the recording is silent or contains NaN, or the times are not evenly spaced. If the recording or
        the whirr has fewer than 32 turns. If the sampling rate is too low, or no whirr is louder than the
        noise.
    TypeError
        If an argument is not real numbers; the message names it.

    Warns
    -----
    UserWarning
        If the recording is as loud before or after the whirr, for longer than 16 of its turns: one whirr
        is followed, the longest without a jump of its rate, and other sound is left out.

    Notes
    -----
    If a body is louder twice per turn, `turns` is twice the true rate: compare it with a film.
    """
    low, high = _range(between)
    x, begin, hertz = _recording(t, sound, low, high)
    level, pace = _envelope(x, hertz, high)
    begin += 0.5 / pace - 0.5 / hertz  # the middle of the first block
    rest = _relative_envelope(level, pace, low)
    track = _loudest_path(rest, pace, low, high)
    clock = np.arange(rest.size) / pace
    for _ in range(3):
        time, turns, errors, heard = _windows(rest, pace, track)
        heard &= (turns > 0.8 * low) & (turns < 1.2 * high)
        keep = _longest_run(_separate_windows(heard), turns)
        if not keep.any():
            raise ValueError(_why_unheard(heard, float(track.mean() * rest.size / pace), low, high))
        # outside the audible range keep the previous track
        half = 0.5 * _TURNS_PER_WINDOW / turns[keep]
        better = np.exp(_smooth_cubic(clock, time[keep], np.log(turns[keep])))
        within = (clock >= time[keep][0] - half[0]) & (clock <= time[keep][-1] + half[-1])
        track = np.where(within, better, track)
    time, turns, errors = time[keep], turns[keep], errors[keep]
    # errors that remain in sounds without noise: 1e-3, and the cube of the relative change within a window
    quickens = np.abs(np.gradient(np.log(turns)))
    half = 0.5 * _TURNS_PER_WINDOW / turns
    missed = _left_out(level, pace, (time[0] - half[0], time[-1] + half[-1]), 4 * half[[0, -1]])
    if missed:
        parts = " and ".join(f"from {begin + a:.3g} to {begin + b:.3g} s" for a, b in missed)
        found = f"{begin + max(time[0] - half[0], 0.0):.3g} to {begin + time[-1] + half[-1]:.3g} s"
        told = (
            f"sound: there is sound {parts} as well, which is left out: one whirr was followed, from {found};"
        )
        advice = "give the other part alone as t and sound, or other turns per second in between="
        after = missed[-1][0] - (time[-1] + half[-1])
        if -_LASTS < after < _LASTS and turns[-1] > max(_NEAR_LIMIT * high, turns[0]):
            rate = f"{turns[-1]:.3g} turns a second"
            advice = (
                f"it quickens to {rate}, and the sound goes on right after it: if this is the same whirr,"
                f" raise the upper limit of between= (now {high:g} per second)"
            )
        warn(f"{told} {advice}")
    return Wobble(begin + time, turns, np.hypot(errors, turns * (_SYSTEMATIC_ERROR + quickens**3)))


def _left_out(
    level: Floats, pace: float, heard: tuple[float, float], least: Floats
) -> list[tuple[float, float]]:
    """Stretches before and after a whirr, in seconds, that are as loud and last as long as two windows."""
    block = max(int(0.5 * _LASTS * pace), 1)
    row = level[: level.size // block * block].reshape(-1, block)
    loud, at = np.median(row, axis=1), (np.arange(len(row)) + 0.5) * block / pace  # a knock is no sound
    within = (at >= heard[0]) & (at <= heard[1])
    if not within.any():
        return []
    is_loud = loud > _LOUD * np.median(loud[within])
    found = []
    for side, shortest in zip((at < heard[0], at > heard[1]), least, strict=True):
        there = np.flatnonzero(is_loud & side)
        if there.size * block / pace > max(shortest, _LASTS):
            half = 0.5 * block / pace
            found.append((float(at[there[0]] - half), float(at[there[-1]] + half)))
    return found


def _why_unheard(heard: np.ndarray, turns: float, low: float, high: float) -> str:
    """Message that says why no whirr was detected: too few audible turns, or none."""
    needed = _FEWEST_WINDOWS * _TURNS_PER_WINDOW
    if turns < needed and heard.size and heard.mean() > 0.5:
        return f"sound: too short: {int(turns)} turns, at least {needed} needed"
    edges = np.flatnonzero(np.diff(np.r_[0, heard.astype(int), 0])).reshape(-1, 2)
    row = int(np.diff(edges, axis=1).max(initial=0))  # consecutive windows start one turn apart
    if row >= 2 * _TURNS_PER_WINDOW:  # noise has short rows of audible windows
        many = row + _TURNS_PER_WINDOW - 1
        return f"sound: too short: {many} turns in a row are audible, at least {needed + 2} needed"
    return f"sound: no whirr of {low:g} to {high:g} turns a second stands out from the noise"


def _range(between: object) -> tuple[float, float]:
    if not isinstance(between, tuple | list) or len(between) != 2:
        raise TypeError(f"between: expected a pair of turns per second, not {between!r}")
    low, high = (number(f"between[{k}]", x) for k, x in enumerate(between))
    if not 0.01 <= low < high / 1.5 <= 1e5:
        raise ValueError(
            f"between = {between!r}: expected turns per second, the second at least 1.5 times the first"
        )
    return low, high


def _recording(t: Reals, sound: Reals, low: float, high: float) -> tuple[Floats, float, float]:
    """The sound without its mean, its first time, and its sampling rate; errors name the argument."""
    time, x = (np.asarray(reals(name, v), np.float64) for name, v in (("t", t), ("sound", sound)))
    if x.ndim != 1 or time.shape != x.shape:
        raise ValueError(f"t and sound: expected equal shapes (n,), not {time.shape} and {x.shape}")
    for name, values in (("t", time), ("sound", x)):
        if not np.isfinite(values).all():
            bad = np.size(values) - np.isfinite(values).sum()
            raise ValueError(f"{name}: expected finite numbers; {bad} are NaN or infinite")
    least = _FEWEST_WINDOWS * _TURNS_PER_WINDOW / high
    if x.size < 2 or time[-1] - time[0] < least:
        told = (
            f"expected at least {_FEWEST_WINDOWS * _TURNS_PER_WINDOW} turns, which take {least:.2g} s or more"
        )
        raise ValueError(f"sound: too short: {told}")
    step = (time[-1] - time[0]) / (x.size - 1)
    # times written with few digits may be off by some of these
    if not step > 0 or np.abs(time - time[0] - step * np.arange(x.size)).max() > 0.1 / high:
        raise ValueError("t: expected evenly spaced times")
    if step * high > 0.05:
        raise ValueError(
            f"t: {1 / step:.3g} samples a second are too few; expected at least {20 * high:g}, twenty times"
            " the greatest frequency in between="
        )
    loudest = np.abs(x).max()
    x = x - x.mean()
    if not np.abs(x).max() > 1e-9 * loudest:
        raise ValueError("sound: the recording is silent")
    return x / np.abs(x).max(), float(time[0]), 1 / step


def _envelope(x: Floats, hertz: float, high: float) -> tuple[Floats, float]:
    """The envelope of the ringing, averaged over blocks, and the number of blocks per second."""
    frequency: Floats = np.fft.rfftfreq(x.size, 1 / hertz).astype(np.float64)
    spectrum = _without_mains(np.fft.rfft(x), frequency)
    ring = frequency > 2 * high
    wide = max(int(high / frequency[1]), 1)
    total = np.cumsum(np.r_[0.0, np.abs(spectrum) ** 2])
    first, last = (np.clip(np.arange(frequency.size) + k, 0, frequency.size) for k in (-wide, wide + 1))
    power = (total[last] - total[first]) / (last - first)
    weight = np.clip(1 - 2 * np.median(power[ring]) / (power + 1e-300), 0, 1) * ring
    if not weight.any():  # no frequency stands out from the noise
        weight = 1.0 * ring
    analytic = np.zeros(x.size, np.complex128)
    analytic[: spectrum.size] = 2 * weight * spectrum
    level = np.abs(np.fft.ifft(analytic))
    block = max(int(hertz / (8 * high)), 1)
    level = level[: level.size // block * block].reshape(-1, block).mean(axis=1)
    return level, hertz / block


def _without_mains(spectrum: np.ndarray, frequency: Floats) -> np.ndarray:
    """A spectrum without the harmonics of the mains frequency, whose beats are as regular as a whirr."""
    power = np.abs(spectrum) ** 2
    for mains in _MAINS:
        lines = [
            k * mains for k in range(1, int(_HIGHEST_HUM / mains) + 1) if (k + 1) * mains < frequency[-1]
        ]
        on = [np.abs(frequency - line) < _HUM_WIDTH for line in lines]
        beside = [(np.abs(frequency - line) < 15) & ~there for line, there in zip(lines, on, strict=True)]
        loud = [
            bool(some.any()) and power[there].max() > 100 * np.median(power[some]) > 0
            for there, some in zip(on, beside, strict=True)
        ]
        if sum(loud[:8]) >= 4:
            spectrum = np.where(np.any(on, axis=0), 0.0, spectrum)
    return spectrum


def _relative_envelope(level: Floats, pace: float, low: float) -> Floats:
    """The envelope divided by its mean over 1.5 of the slowest turns to either side, minus 1."""
    half = int(1.5 * pace / low) + 1
    total = np.cumsum(np.r_[0.0, level])
    first, last = (np.clip(np.arange(level.size) + k, 0, level.size) for k in (-half, half + 1))
    mean = (total[last] - total[first]) / (last - first)
    levelled: Floats = np.clip(level / (mean + 1e-6 * level.max()) - 1, -1.0, 4.0)
    return levelled


def _loudest_path(rest: Floats, pace: float, low: float, high: float) -> Floats:
    """A first estimate of the fundamental of the envelope: the loudest path through the filters."""
    count = int(_PER_OCTAVE * np.log2(high / low)) + 1
    # up to the third harmonic of the highest fundamental
    bank = low * 2 ** (np.arange(count + int(1.6 * _PER_OCTAVE)) / _PER_OCTAVE)
    spectrum, frequency = np.fft.fft(rest), np.fft.fftfreq(rest.size, 1 / pace)
    frames = np.linspace(0, rest.size - 1, min(rest.size, 2000)).astype(int)
    loud = np.zeros((bank.size, frames.size))
    for k, f in enumerate(bank[bank < 0.45 * pace]):
        width = f / (2 * _TURNS_PER_WINDOW)
        inside = np.abs(frequency - f) < 4 * width
        passed = np.zeros_like(spectrum)
        passed[inside] = spectrum[inside] * np.exp(-(((frequency[inside] - f) / width) ** 2) / 2)
        loud[k] = np.abs(np.fft.ifft(passed))[frames] / np.sqrt(f)
    harmonics = (_PER_OCTAVE, round(_PER_OCTAVE * np.log2(3)))
    score = loud[:count].copy()
    for share, shift in zip((0.5, 0.33), harmonics, strict=True):
        score += share * loud[shift : shift + count]
    score = np.log1p(score / np.median(score))
    reach = np.arange(-3, 4)
    best, came = score[:, 0], np.zeros((frames.size, count), np.int64)
    for k in range(1, frames.size):
        padded = np.pad(best, 3, constant_values=-np.inf)
        ways = np.stack([padded[3 + r : 3 + r + count] - 0.1 * r * r for r in reach])
        chosen = ways.argmax(axis=0)
        came[k] = np.arange(count) + reach[chosen]
        best = ways[chosen, np.arange(count)] + score[:, k]
    path = np.empty(frames.size, np.int64)
    path[-1] = best.argmax()
    for k in range(frames.size - 1, 0, -1):
        path[k - 1] = came[k, path[k]]
    found = np.log(bank[path])
    smooth = 7
    found = np.convolve(
        np.pad(found, smooth, mode="edge"), np.ones(2 * smooth + 1) / (2 * smooth + 1), "valid"
    )
    return np.exp(np.interp(np.arange(rest.size), frames, found))


def _windows(rest: Floats, pace: float, track: Floats) -> tuple[Floats, Floats, Floats, np.ndarray]:
    """Windows that start at every turn: middles, turns per second, errors, and whether they are audible."""
    phase = np.cumsum(track) / pace  # turns
    turn = np.floor(phase - phase[0]).astype(int)
    # the last turn counts if it is complete up to rounding
    many = turn[-1] + int(phase[-1] - phase[0] - turn[-1] + track[-1] / pace > 0.95)
    if many < _TURNS_PER_WINDOW:
        return (np.empty(0),) * 3 + (np.empty(0, bool),)
    turned = rest * np.exp(-2j * np.pi * phase)
    size = np.bincount(turn, minlength=many)[:many]
    z = np.bincount(turn, turned.real, many) + 1j * np.bincount(turn, turned.imag, many)
    z = np.lib.stride_tricks.sliding_window_view(z[:many] / np.maximum(size, 1), _TURNS_PER_WINDOW)
    n = np.arange(_TURNS_PER_WINDOW) - (_TURNS_PER_WINDOW - 1) / 2
    bend = n**2 - np.mean(n**2)
    # search a grid for the error of the track, slope and curvature of its phase; then fit by least squares
    slopes = np.linspace(-1.2, 1.2, 61)
    bends = np.linspace(-0.12, 0.12, 13)
    trial = np.exp(-1j * (slopes[:, None, None] * n + bends[:, None] * bend)).reshape(-1, _TURNS_PER_WINDOW)
    best = np.concatenate(
        [np.abs(some @ trial.T).argmax(axis=1) for some in np.array_split(z, len(z) // 1000 + 1)]
    )
    slope, bent = slopes[best // bends.size], bends[best % bends.size]
    left = z * np.exp(-1j * (slope[:, None] * n + bent[:, None] * bend))
    left = left * np.exp(-1j * np.angle(left.sum(axis=1)))[:, None]
    weight = np.abs(left) + 1e-300
    coherent = np.abs(left.sum(axis=1)) / weight.sum(axis=1)
    # half a window of silence would be coherent, too: every turn has to be audible
    even = left.real.min(axis=1) > _LEAST_FUNDAMENTAL * weight.mean(axis=1)
    angle = np.angle(left)
    weight /= weight.mean(axis=1, keepdims=True)
    table = np.stack([np.ones(_TURNS_PER_WINDOW), n, bend], axis=1)
    covariance = np.linalg.inv(np.einsum("ki,ia,ib->kab", weight, table, table))
    more = np.einsum("kab,ib,ki->ka", covariance, table, weight * angle)
    off = angle - more @ table.T
    scatter = (weight * off**2).sum(axis=1) / (_TURNS_PER_WINDOW - 3)
    # eight phases for three parameters give a poor estimate of the scatter: average it with the neighbours'
    joined = _scatter_of_neighbours(scatter)
    errors = np.sqrt(covariance[:, 1, 1] * joined)
    middle = np.interp(
        np.arange(len(z)) + _TURNS_PER_WINDOW / 2, phase - phase[0], np.arange(phase.size) / pace
    )
    there = np.interp(middle, np.arange(phase.size) / pace, track)
    turns = there * (1 + (slope + more[:, 1]) / (2 * np.pi))
    # a knock makes the scatter of its window exceed that of the neighbours
    return (
        middle,
        turns,
        there * errors / (2 * np.pi),
        (coherent > _LEAST_COHERENCE) & even & (scatter < _KNOCK_SCATTER * joined),
    )


def _scatter_of_neighbours(scatter: Floats) -> Floats:
    """The mean scatter of each window and of neighbours that share no turns with it, limited for outliers."""
    reach = np.arange(-3, 4) * _TURNS_PER_WINDOW
    at = np.arange(scatter.size)[:, None] + reach
    near = np.where((at >= 0) & (at < scatter.size), scatter[np.clip(at, 0, scatter.size - 1)], np.nan)
    held: Floats = np.nanmean(np.minimum(near, 5 * np.nanmedian(near, axis=1, keepdims=True)), axis=1)
    return held


def _smooth_cubic(at: Floats, x: Floats, y: Floats) -> Floats:
    """A smooth cubic through points, with the slopes of parabolas; linear beyond the ends."""
    slope = np.gradient(y, x, edge_order=2)
    k = np.clip(np.searchsorted(x, at) - 1, 0, x.size - 2)
    step = x[k + 1] - x[k]
    u = np.clip((at - x[k]) / step, 0.0, 1.0)
    found = y[k] * (1 + 2 * u) * (1 - u) ** 2 + y[k + 1] * u**2 * (3 - 2 * u)
    found += step * u * (1 - u) * (slope[k] * (1 - u) - slope[k + 1] * u)
    for end, beside, beyond in ((0, 1, np.minimum(at - x[0], 0)), (-1, -2, np.maximum(at - x[-1], 0))):
        chord = (y[beside] - y[end]) / (x[beside] - x[end])
        found += slope[end] * beyond + (chord - slope[end]) / (x[beside] - x[end]) * beyond**2
    return found


def _separate_windows(heard: np.ndarray) -> np.ndarray:
    """Which windows to keep: several in a row without overlap, if they and both neighbours are audible.

    A sound that begins or ends during the recording does so within a turn: windows with that turn are left
    out.
    """
    keep = np.zeros_like(heard)
    inner = heard.copy()
    inner[1:] &= heard[:-1]
    inner[:-1] &= heard[1:]
    begin = 0
    while begin < heard.size:
        row = inner[begin::_TURNS_PER_WINDOW]
        many = row.size if row.all() else int(row.argmin())
        if many >= _FEWEST_WINDOWS:
            keep[begin : begin + many * _TURNS_PER_WINDOW : _TURNS_PER_WINDOW] = True
        begin += max(many * _TURNS_PER_WINDOW, 1) if many >= _FEWEST_WINDOWS else 1
    return keep


def _longest_run(keep: np.ndarray, turns: Floats) -> np.ndarray:
    """The windows of a single whirr: the longest run without a jump of the rate."""
    rows = np.flatnonzero(keep)
    leaps = np.flatnonzero(np.abs(np.diff(np.log(turns[rows]))) > _LARGEST_JUMP) + 1
    longest = max(np.split(rows, leaps), key=len)
    found = np.zeros_like(keep)
    found[longest] = True
    return found
