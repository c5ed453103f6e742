"""The sound of a whirr: a ring that is loudest each time the contact point comes round.

    x = r(t) exp(b (cos(phi) - 1)),    r = what a few resonances make of noise, |psi' A|^(1/2) strong

phi turns the contact about the vertical, as heard by somebody who stands beside the table: one beat a turn,
at phi'/(2 pi). The resonances are those of a steel disk or so; their pitch means nothing.
"""

import math
import wave
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from spincyl._array import Floats, number, path_of, si, whole
from spincyl._poses import seen, span
from spincyl._scale import Scale, scale_of
from spincyl._written import replaced

if TYPE_CHECKING:
    from spincyl._motion import Motion

#: Hertz, decay time in seconds, strength.
_RESONANCES = ((1150.0, 0.030, 1.0), (2710.0, 0.020, 0.6), (4890.0, 0.012, 0.35))
_SHARPNESS = 2.0
_LOOKS = 2000  # a second, at which the pose is asked for
_AFTER, _LONGEST = 0.25, 180.0  # seconds


def sound(
    m: "Motion", path: str | PathLike[str], seconds: float | None, scale: Scale | None, rate: int
) -> Path:
    """Write the sound of a motion as a WAV file."""
    path = path_of("path", path)
    if path.suffix.lower() != ".wav":
        raise ValueError(f"path = {str(path)!r}: expected a name that ends in .wav")
    if "vertical" in m._extra:
        raise TypeError("body: expected a Body, whose contact runs round a rim, not an Ellipsoid")
    scale, m = scale_of(scale, m.body), m.natural
    if scale is None:
        raise TypeError("scale: expected a Scale, which a measured body has, to make seconds of the times")
    rate = whole("rate", rate, 8000, 192_000)
    first, last = span(m)
    if last < first:
        raise ValueError("the motion runs backward in time: there is nothing to hear")
    unit = float(scale.seconds(1.0))
    lasting = (last - first) * unit
    if seconds is not None:
        wanted = number("seconds", si("seconds", seconds, "second"))
        if not 0 < wanted <= lasting * (1 + 1e-9):
            raise ValueError(
                f"seconds = {wanted!r}: expected more than 0 and at most {lasting:.6g}, the motion's"
            )
        lasting = wanted
    if lasting > _LONGEST:
        raise ValueError(f"{lasting:.6g} s are too long to hear: give seconds=, at most {_LONGEST:g}")
    found = _heard(m, first, unit, lasting, rate)
    with replaced(path) as part, wave.open(str(part), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(rate)
        file.writeframes(np.round(found * 32767).astype("<i2").tobytes())
    return path


def _heard(m: "Motion", first: float, unit: float, lasting: float, rate: int) -> Floats:
    """The pressure at each sample, between -1 and 1, and a while of ringing after the end."""
    looks = np.linspace(0.0, lasting, max(64, math.ceil(_LOOKS * lasting)))
    phi, theta, w = seen(m, first + looks / unit, "phi", "theta", "w")
    radius = 1 - m.body.fillet + m.body.fillet * np.sin(theta)
    speed = np.abs(w[:, 2] - w[:, 0] * np.cos(theta) / np.sin(theta)) * radius
    t = np.arange(math.ceil((lasting + _AFTER) * rate)) / rate
    scrape = np.random.default_rng(0).standard_normal(t.size)
    scrape *= np.sqrt(np.interp(t, looks, speed)) * (t <= lasting)
    ring: Floats = _through(scrape, rate)
    ring *= np.exp(_SHARPNESS * (np.cos(np.interp(t, looks, phi)) - 1))
    most = float(np.abs(ring).max())
    return ring * (0.9 / most) if most > 0 else ring


def _through(scrape: Floats, rate: int) -> Floats:
    """What resonances that decay make of a force."""
    t = np.arange(math.ceil(0.25 * rate)) / rate
    answer = sum(
        size * np.exp(-t / decay) * np.sin(2 * np.pi * hertz * t) for hertz, decay, size in _RESONANCES
    )
    whole_ = 2 ** math.ceil(math.log2(scrape.size + t.size))
    spectrum = np.fft.rfft(scrape, whole_) * np.fft.rfft(answer, whole_)
    found: Floats = np.fft.irfft(spectrum, whole_)[: scrape.size]
    return found
