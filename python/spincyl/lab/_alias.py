"""Aliases in a film: rates that look the same from frame to frame, and which of them are steady.

Between two frames the tube may make any number of whole turns more, in either sense. The frames alone cannot
tell these rates apart, unless the frames are unevenly spaced in time; but each rate has its own steady
inclination, and the film has measured the inclination.
"""

import math
from typing import NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._input.numbers import Floats
from spincyl.lab._report import student

_MOST = 2  # whole turns between two frames
_POSSIBLE_WITHIN = 4.0  # standard errors from a steady inclination up to which a rate is possible
# standard errors from every steady inclination, from which on another rate replaces the slowest
_IMPOSSIBLE_BEYOND = 8.0
# ratio of the scatter of two rates, if the frames are uneven in time, that excludes the larger
_SCATTER_RATIO = 3.0
_FASTEST_END = 10.0  # metres per second: no finger makes the ends of a tube faster
_LEAST_SINE_ERROR = 1e-6  # standard error of the sine of an exact film


class Reading(NamedTuple):
    """A rate of turning that is consistent with the frames of a film."""

    direction: Floats  #: unwrapped direction, in radians
    slope: float  #: angular velocity in rad/s
    slope_err: float
    scatter: float  #: deviation from uniform rotation, in radians
    inclinations: Floats  #: steady inclinations at this rate
    off: float  #: errors between the measured and the nearest steady inclination; infinite if there is none

    @property
    def hertz(self) -> float:
        """The rate in turns per second."""
        return abs(self.slope) / (2 * math.pi)


class Readings(NamedTuple):
    """Rates that agree with the frames of a film: the slowest, the chosen one, and all likely ones."""

    slowest: Reading
    taken: Reading
    possible: list[Reading]
    fps: float  #: frames per second


def uniform(t: Floats, direction: Floats) -> tuple[float, float, float]:
    """Fit a uniform rotation to directions: angular velocity, its standard error, scatter of directions."""
    table = t - t.mean()
    squares = float(table @ table)
    slope = float(table @ direction) / squares
    rest = direction - direction.mean() - slope * table
    spread = float(rest @ rest) / max(t.size - 2, 1)
    # correlated errors of neighbours, as during nutation, carry less information than independent ones
    alike = float(rest[1:] @ rest[:-1]) / float(rest @ rest) if spread > 0 else 0.0
    alike = min(max(alike, 0.0), 0.95)
    return slope, math.sqrt(spread / squares * (1 + alike) / (1 - alike)), math.sqrt(spread)


def read(
    t: Floats, direction: Floats, body: Body, *, one: float, line: float, sine: float, sine_err: float
) -> Readings:
    """Find the rate of a tube from its directions in the frames of a film, and the other possible rates.

    `one` is the unit of reduced rates in turns per second, `line` the distance of the ends of the tube as
    seen from above, in metres, and `sine` that of the inclination. The slowest rate is taken, unless its
    steady inclinations are all far from the measured one and exactly one other rate is possible.
    """
    gaps = np.diff(t)
    frame = np.r_[0.0, np.cumsum(np.maximum(np.round(gaps / np.median(gaps)), 1.0))]
    fps = float(np.polyfit(t - t[0], frame, 1)[0])
    found = []
    for turns in sorted(range(-_MOST, _MOST + 1), key=abs):
        own = direction + 2 * math.pi * turns * frame
        found.append(_reading(t, own, body, one, sine, math.hypot(sine_err, _LEAST_SINE_ERROR)))
    found = [found[0], *(x for x in found[1:] if abs(x.slope) * line / 2 < _FASTEST_END)]
    found[1:] = sorted(found[1:], key=lambda x: x.hertz)
    most = student(_POSSIBLE_WITHIN, t.size - 1)
    least = _SCATTER_RATIO * min(one.scatter for one in found) if _is_uneven(t, frame) else math.inf
    possible = [one for one in found if one.off <= most and one.scatter <= least]
    taken = found[0]
    if len(possible) == 1 and taken.off > student(_IMPOSSIBLE_BEYOND, t.size - 1):
        taken = possible[0]
    return Readings(found[0], taken, possible, fps)


def _reading(t: Floats, direction: Floats, body: Body, one: float, sine: float, sine_err: float) -> Reading:
    slope, slope_err, scatter = uniform(t, direction)
    rates = (abs(slope) + np.array([0.0, slope_err])) / (2 * math.pi * one)
    steady, beside = (_steady(body, float(rate)) for rate in rates)
    off = math.inf
    if steady.size:
        near = np.sin(steady)[np.abs(np.sin(steady) - sine).argmin()]
        moved = float(np.abs(np.sin(beside) - near).min()) if beside.size else 0.0
        off = abs(near - sine) / math.hypot(sine_err, moved)
    return Reading(direction, slope, slope_err, scatter, steady, float(off))


def _steady(body: Body, rate: float) -> Floats:
    found = np.atleast_1d(np.asarray(body.inclinations(rate=rate), np.float64))
    return found[np.isfinite(found)]


def _is_uneven(t: Floats, frame: Floats) -> bool:
    """Whether the frames are uneven in time by more than the rounding of the written times."""
    line = np.polyfit(frame, t, 1)
    off = float(np.abs(t - np.polyval(line, frame)).max())
    digits = next((q for q in 10.0 ** np.arange(0, -8, -1) if _is_multiple(t, q)), 0.0)
    return off > 0.55 * digits + 1e-3 * float(line[0])


def _is_multiple(t: Floats, digit: float) -> bool:
    return bool(np.abs(t / digit - np.round(t / digit)).max() < 1e-4)
