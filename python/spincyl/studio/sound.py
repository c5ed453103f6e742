"""The sound of a whirr: a ringing that is loudest each time the contact point passes the listener.

    x = r(t) exp(b (cos(phi) - 1)),    r = noise of strength v^(1/2), filtered by a few resonances

v is the speed of the contact point along the body: psi' A round the rim, rho theta' over a fillet. phi is the
azimuth of the contact point: a listener beside the table hears one beat per turn, phi'/(2 pi). The resonances
are roughly those of a steel disk; their pitch has no meaning. Towards the end of a whirr psi' grows without
bound: a contact point faster than the ringing makes it no louder, and beats faster than the samples resolve
are replaced by their mean.

A body in the air or on its face is silent. An impact excites the same resonances, with a loudness
proportional to its impulse, and equally loud on all sides. Of a stone only impacts are heard, since its
contact point runs round no rim.
"""

import math
import wave
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from spincyl._circles import circle_of
from spincyl._input.files import path_of, writing_whole
from spincyl._input.numbers import Floats, number, si, whole
from spincyl._scale import Scale, scale_of
from spincyl.studio.aloft import FLIES, ON_FACE, goes_up, strikes
from spincyl.studio.poses import seen, span

if TYPE_CHECKING:
    from spincyl._motion import Motion
    from spincyl._phases import Impact

#: Hertz, decay time in seconds, strength.
_RESONANCES = ((1150.0, 0.030, 1.0), (2710.0, 0.020, 0.6), (4890.0, 0.012, 0.35))
_SHARPNESS = 2.0
# in sqrt(g R): a contact point slower than this along the body is at rest up to rounding
_SPEED_ROUNDING = 1e-9
_POSES_PER_SECOND = 2000  # samples of the pose per second
_RINGING_AFTER, _LONGEST = 0.25, 180.0  # seconds
#: Loudness of an impact with the impulse M sqrt(g R), that of a fall from R/2 without a bounce, as a share of
#: the noise of a contact point that moves with sqrt(g R) for a second.
_STRIKE = 0.4


def sound(
    m: "Motion", path: str | PathLike[str], seconds: float | None, scale: Scale | None, rate: int
) -> Path:
    """Write the sound of a motion as a WAV file."""
    path = path_of("path", path)
    if path.suffix.lower() != ".wav":
        raise ValueError(f"path = {str(path)!r}: expected a name that ends in .wav")
    scale, m = scale_of(scale, m.body), m.natural
    if scale is None:
        raise TypeError("scale: expected a Scale, since sound needs seconds; a measured body has its own")
    rate = whole("rate", rate, 8000, 192_000)
    first, last = span(m)
    if last < first:
        raise ValueError("motion: expected ascending times for a sound, not a motion backward in time")
    unit = float(scale.seconds(1.0))
    lasting = (last - first) * unit
    if seconds is not None:
        wanted = number("seconds", si("seconds", seconds, "second"))
        if not 0 < wanted <= lasting * (1 + 1e-9):
            raise ValueError(
                f"seconds = {wanted!r}: expected more than 0 and at most {lasting:.6g}, as the motion lasts"
            )
        lasting = wanted
    if lasting > _LONGEST:
        raise ValueError(f"motion: {lasting:.6g} s, expected at most {_LONGEST:g}; give seconds=")
    found = _pressure(m, first, unit, lasting, rate)
    with writing_whole(path) as part, wave.open(str(part), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(rate)
        file.writeframes(np.round(found * 32767).astype("<i2").tobytes())
    return path


def _pressure(m: "Motion", first: float, unit: float, lasting: float, rate: int) -> Floats:
    """The pressure at each sample, between -1 and 1, with some ringing after the end."""
    looks = np.linspace(0.0, lasting, max(64, math.ceil(_POSES_PER_SECOND * lasting)))
    heard = [x for x in strikes(m) if x.time <= first + lasting / unit] if goes_up(m) else []
    if m._nods:
        phi, speed = _contact(m, first + looks / unit, bool(heard))
    else:
        phi, speed = np.zeros((2, looks.size))
    if not (speed.max() > _SPEED_ROUNDING or heard):
        why = "the contact point does not move along the body" if m._nods else "the stone strikes nothing"
        raise ValueError(f"motion: there is nothing to hear, since {why}")
    speed = np.minimum(speed, 2 * math.pi * _RESONANCES[0][0] * unit)
    t = np.arange(math.ceil((lasting + _RINGING_AFTER) * rate)) / rate
    scrape = np.random.default_rng(0).standard_normal(t.size)
    scrape *= np.sqrt(np.interp(t, looks, speed)) * (t <= lasting)
    ring: Floats = _ringing(scrape, rate)
    ring *= _loudness(np.interp(t, looks, phi))
    if heard:
        ring += _ringing(_impulses(heard, first, unit, t.size, rate), rate)
    most = float(np.abs(ring).max())
    return ring * (0.9 / most) if most > 0 else ring


def _impulses(hits: "list[Impact]", first: float, unit: float, count: int, rate: int) -> Floats:
    """The impulses of impacts on the resonances, each in the sample nearest to its time."""
    found = np.zeros(count)
    at = np.array([round((x.time - first) * unit * rate) for x in hits])
    size = np.linalg.norm([x.impulse for x in hits], axis=1)
    heard = (at >= 0) & (at < count)
    np.add.at(found, at[heard], _STRIKE * math.sqrt(rate) * size[heard])
    return found


def _contact(m: "Motion", times: Floats, any_hit: bool = False) -> tuple[Floats, Floats]:
    """The azimuth of the contact point and its speed along the body at times; the speed is 0 in the air."""
    phi, theta, w, rim = seen(m, times, "phi", "theta", "w", "rim")
    s, c, (radius, fillet) = np.sin(theta), np.cos(theta), circle_of(m.body, rim)
    # finite at the poles of a ball; after a face has landed it is undefined, and the last one is repeated
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        round_the_rim = np.where(radius > 0, radius * (w[:, 2] - w[:, 0] * c / s), 0.0)
        speed = np.hypot(round_the_rim + fillet * (s * w[:, 2] - c * w[:, 0]), fillet * w[:, 1])
    silent = np.zeros(times.size, bool)
    if goes_up(m):  # on its face no point of contact runs round the rim
        silent = np.isin(seen(m, times, "phase")[0], (FLIES, ON_FACE))
        speed[silent] = 0.0
    known = np.flatnonzero(np.isfinite(speed) & np.isfinite(phi) & ((s > 0) | (radius == 0) | silent))
    if known.size == 0:
        if any_hit:
            return np.zeros(times.size), np.zeros(times.size)
        raise ValueError("motion: there is nothing to hear, since the body lies on its face")
    nearest = known[np.clip(np.searchsorted(known, np.arange(speed.size), "right") - 1, 0, None)]
    return phi[nearest], speed[nearest]


def _loudness(phi: Floats) -> Floats:
    """Loudness of the ringing for an azimuth of the contact point; the mean where the beat is too fast."""
    step = np.abs(np.gradient(phi)) if phi.size > 1 else np.zeros(phi.size)
    shown = np.clip(2 - step * 2 / math.pi, 0.0, 1.0)  # 0 from two samples per turn on
    mean = math.exp(-_SHARPNESS) * float(np.i0(_SHARPNESS))
    found: Floats = mean + shown * (np.exp(_SHARPNESS * (np.cos(phi) - 1)) - mean)
    return found


def _ringing(scrape: Floats, rate: int) -> Floats:
    """The response of decaying resonances to a force."""
    t = np.arange(math.ceil(0.25 * rate)) / rate
    answer = sum(
        size * np.exp(-t / decay) * np.sin(2 * np.pi * hertz * t) for hertz, decay, size in _RESONANCES
    )
    whole_ = 2 ** math.ceil(math.log2(scrape.size + t.size))
    spectrum = np.fft.rfft(scrape, whole_) * np.fft.rfft(answer, whole_)
    found: Floats = np.fft.irfft(spectrum, whole_)[: scrape.size]
    return found
