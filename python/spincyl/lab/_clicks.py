"""Times of clicks in a recording: where the sound suddenly becomes louder than just before."""

import numpy as np

from spincyl._input.numbers import Floats, Reals, reals

_BLOCK = 1e-3  #: Seconds over which the envelope takes its largest value.
_BEFORE = 8  #: Blocks before a click with whose loudest but two it is compared.
_RISE, _ABOVE = 3.0, 6.0  #: Least ratio to these blocks, and to the median of the recording.
_DEAD = 0.02  #: Seconds after a click in which no other one is heard: its ringing.
_START = 0.3  #: A click begins where it reaches this share of its first peak.


def clicks(t: Reals, sound: Reals) -> Floats:
    """Times of the clicks of a recording, in seconds; errors name the argument at fault."""
    time, x = (np.asarray(reals(name, v), np.float64) for name, v in (("t", t), ("sound", sound)))
    if x.ndim != 1 or time.shape != x.shape:
        raise ValueError(f"t and sound: expected equal shapes (n,), not {time.shape} and {x.shape}")
    for name, values in (("t", time), ("sound", x)):
        if not np.isfinite(values).all():
            raise ValueError(f"{name}: expected finite numbers, not NaN or infinity")
    step = (time[-1] - time[0]) / (x.size - 1) if x.size > 1 else 0.0
    if not 0 < step <= _BLOCK / 2 or np.abs(np.diff(time) - step).max() > 0.1 * _BLOCK:
        raise ValueError("t: expected evenly spaced times, at least 2000 a second")
    # the difference of samples weakens hum and other low frequencies
    loud = np.abs(np.diff(x, prepend=x[0]))
    block = max(round(_BLOCK / step), 1)
    level = loud[: loud.size // block * block].reshape(-1, block).max(axis=1)
    if level.size < 2 * _BEFORE or not level.max() > 0:
        raise ValueError("sound: the recording is silent, or shorter than 16 ms")
    padded = np.concatenate([np.full(_BEFORE, np.median(level)), level[:-1]])
    # without the two loudest of the blocks before: a click may begin within the last one
    before = np.sort(np.lib.stride_tricks.sliding_window_view(padded, _BEFORE), axis=1)[:, -3]
    rises = (level > _RISE * before) & (level > _ABOVE * np.median(level))
    found: list[float] = []
    for k in np.flatnonzero(rises).tolist():
        first = max(k - 1, 0) * block
        wave = loud[first : (k + 3) * block]
        at = time[first + int(np.argmax(wave >= _START * wave.max()))]
        if not found or at - found[-1] > _DEAD:
            found.append(float(at))
    return np.array(found)
