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

A first impact may be more than 20 decibels louder than the whirr that follows, which nobody would hear beside
it. So levels are compressed. Each impact, and the whirr at each time, has an amplitude a, without the beat:

    a -> A (a/A)^(1/k),    A = the largest of these amplitudes,    k = 2

What is L decibels below the loudest is L/k decibels below it in the file, and k = 1 is the true ratio.
"""

import math
import wave
from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from spincyl._circles import circle_of
from spincyl._input.files import path_of, writing_whole
from spincyl._input.numbers import Floats, in_range, number, si, whole
from spincyl._scale import Scale, scale_of
from spincyl.studio.aloft import FLIES, ON_FACE, goes_up, strikes
from spincyl.studio.poses import seen, span

if TYPE_CHECKING:
    from spincyl._motion import Motion

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
#: By how much levels below the loudest are reduced: L decibels become L/2.
COMPRESSION = 2.0
_PIECE = 1 << 18  # samples that are filtered at a time


class Silent(ValueError):
    """The motion makes no sound; the message gives the reason."""


def sound(
    m: "Motion",
    path: str | PathLike[str],
    seconds: float | None,
    scale: Scale | None,
    rate: int,
    compression: float,
) -> Path:
    """Write the sound of a motion as a WAV file."""
    path = path_of("path", path)
    if path.suffix.lower() != ".wav":
        raise ValueError(f"path = {str(path)!r}: expected a name that ends in .wav")
    scale, m = scale_of(scale, m.body), m.natural
    if scale is None:
        raise TypeError("scale: expected a Scale, since sound needs seconds; a measured body has its own")
    rate = whole("rate", rate, 8000, 192_000)
    compression = in_range("compression", compression, 1.0, 100.0)
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
    count = math.ceil((lasting + _RINGING_AFTER) * rate)
    found = pressure([sources(m, first, unit, lasting)], count, rate, compression)
    with writing_whole(path) as part:
        write_wave(part, found, rate)
    return path


def write_wave(path: Path, pressure: Floats, rate: int) -> None:
    """Write a pressure between -1 and 1 into a file, one channel of 16 bits."""
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(rate)
        file.writeframes(np.round(pressure * 32767).astype("<i2").tobytes())


class Sources(NamedTuple):
    """Sources of the sound of a motion; times are in seconds from the beginning of the sound."""

    looks: Floats  #: times at which the contact point is known
    phi: Floats  #: its azimuth there, from that of the listener
    speed: Floats  #: its speed along the body, in sqrt(g R); 0 where it is silent
    hits: Floats  #: times of impacts
    impulses: Floats  #: their sizes, in M sqrt(g R)

    def amplitudes(self, rate: int) -> tuple[Floats, Floats]:
        """Pressures of the ringing: of the noise at each time, without the beat, and after each impact."""
        answer = _answer(rate)
        strike = _STRIKE * math.sqrt(rate) * float(np.abs(answer).max())
        return np.sqrt(self.speed * float(answer @ answer)), strike * self.impulses


def sources(m: "Motion", first: float, unit: float, lasting: float, listener: float = math.pi) -> Sources:
    """The sources of the sound of a motion after the time `first`; `unit` converts times to seconds.

    `listener` is the azimuth at which the contact point is nearest to the listener.

    Raises `Silent` if there is nothing to hear.
    """
    looks = np.linspace(0.0, lasting, max(64, math.ceil(_POSES_PER_SECOND * lasting)))
    begin, end = sorted(span(m))
    until = first + lasting / unit
    struck = [x for x in strikes(m) if first <= x.time <= until] if goes_up(m) else []
    phi, speed = np.zeros((2, looks.size))
    if m._nods:
        times = np.clip(first + looks / unit, begin, end)
        phi, speed = _contact(m, times, bool(struck))
        near = 1e-9 * (end - begin)
        speed[(first + looks / unit < begin - near) | (first + looks / unit > end + near)] = 0.0
    if not (speed.max() > _SPEED_ROUNDING or struck):
        why = "the contact point does not move along the body" if m._nods else "the stone strikes nothing"
        raise Silent(f"motion: there is nothing to hear, since {why}")
    speed = np.minimum(speed, 2 * math.pi * _RESONANCES[0][0] * unit)
    hits = np.array([(x.time - first) * unit for x in struck])
    sizes = np.linalg.norm(np.reshape([x.impulse for x in struck], (-1, 3)), axis=1)
    return Sources(looks, phi + math.pi - listener, speed, hits, sizes)


def pressure(of: Sequence[Sources], count: int, rate: int, compression: float = COMPRESSION) -> Floats:
    """The pressure, between -1 and 1, at samples of the sound of several motions together."""
    levels = [it.amplitudes(rate) for it in of]
    most = max(float(x.max()) for pair in levels for x in pair if x.size)
    ring = np.zeros(count)
    for k, (it, (noise, strokes)) in enumerate(zip(of, levels, strict=True)):
        ring += _whirr(it, _gain(noise, most, compression), count, rate, seed=k)
        if it.hits.size:
            sizes = _gain(strokes, most, compression) * it.impulses
            ring += _ringing(_impulses(it.hits, sizes, count, rate), rate)
    peak = float(np.abs(ring).max())
    return ring * (0.9 / peak) if peak > 0 else ring


def _gain(level: Floats, most: float, compression: float) -> Floats:
    """Factors that compress levels below the loudest; 0 where the level is 0."""
    share = np.divide(level, most, out=np.zeros(level.size), where=level > 0)
    return np.power(share, 1 / compression - 1, out=np.zeros(level.size), where=share > 0)


def _whirr(of: Sources, gain: Floats, count: int, rate: int, seed: int) -> Floats:
    """The ringing of the contact point as it runs along the body."""
    t = np.arange(count) / rate
    scrape = np.random.default_rng(seed).standard_normal(count)
    scrape *= np.interp(t, of.looks, gain * np.sqrt(of.speed)) * (t <= of.looks[-1])
    ring = _ringing(scrape, rate)
    ring *= _loudness(np.interp(t, of.looks, of.phi))
    return ring


def _impulses(times: Floats, sizes: Floats, count: int, rate: int) -> Floats:
    """The impulses of impacts on the resonances, each in the sample nearest to its time."""
    found = np.zeros(count)
    at = np.round(times * rate).astype(int)
    heard = (at >= 0) & (at < count)
    np.add.at(found, at[heard], _STRIKE * math.sqrt(rate) * sizes[heard])
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
        raise Silent("motion: there is nothing to hear, since the body lies on its face")
    nearest = known[np.clip(np.searchsorted(known, np.arange(speed.size), "right") - 1, 0, None)]
    return phi[nearest], speed[nearest]


def _loudness(phi: Floats) -> Floats:
    """Loudness of the ringing for an azimuth of the contact point; the mean where the beat is too fast."""
    step = np.abs(np.gradient(phi)) if phi.size > 1 else np.zeros(phi.size)
    shown = np.clip(2 - step * 2 / math.pi, 0.0, 1.0)  # 0 from two samples per turn on
    mean = math.exp(-_SHARPNESS) * float(np.i0(_SHARPNESS))
    found: Floats = mean + shown * (np.exp(_SHARPNESS * (np.cos(phi) - 1)) - mean)
    return found


def _answer(rate: int) -> Floats:
    """The response of decaying resonances to a single push."""
    t = np.arange(math.ceil(0.25 * rate)) / rate
    found: Floats = np.zeros(t.size)
    for hertz, decay, size in _RESONANCES:
        found += size * np.exp(-t / decay) * np.sin(2 * np.pi * hertz * t)
    return found


def _ringing(force: Floats, rate: int) -> Floats:
    """The response of decaying resonances to a force, a piece after the other."""
    answer = _answer(rate)
    found = np.zeros(force.size + answer.size)
    for begin in range(0, force.size, _PIECE):
        piece = force[begin : begin + _PIECE]
        long = piece.size + answer.size
        size = 2 ** math.ceil(math.log2(long))
        spectrum = np.fft.rfft(piece, size) * np.fft.rfft(answer, size)
        found[begin : begin + long] += np.fft.irfft(spectrum, size)[:long]
    return found[: force.size]
