"""A motion as it is drawn: at the times of frames, with its path and its extent."""

import math
from typing import NamedTuple

import numpy as np

from spincyl._input.numbers import Floats
from spincyl._motion import Motion
from spincyl._phases import has_friction
from spincyl.studio.aloft import FLIES, ON_FACE, SLIPS, aloft, goes_up, tops
from spincyl.studio.arrows import Vectors, usual, vectors
from spincyl.studio.look import held
from spincyl.studio.poses import seen, span
from spincyl.studio.shape import Letter, Part, marks, rotations, size
from spincyl.studio.shape import reach as farthest

_PATH_POINTS = 6000  # points of the contact's path


class Shown(NamedTuple):
    """A motion, evaluated at the times of the frames."""

    motion: Motion
    centre: Floats  #: (n, 3)
    rotation: Floats  #: (n, 3, 3)
    theta: Floats
    spin: Floats | None  #: of a stone
    path: Floats  #: (k, 3) of the contact point
    along: Floats  #: (k,) times of these
    slips: np.ndarray  #: (k,) whether the contact slips there
    gaps: np.ndarray  #: (k,) whether there is no path: in the air, and where the other rim takes over
    turned: Floats  #: (k,) turns about the vertical at `along`
    vectors: Vectors | None  #: None without arrows and axis
    sizes: dict[str, float]  #: magnitudes of the vectors that get an arrow of usual length
    ink: list[Part]
    middle: Floats
    reach: float
    half: float


def shown(m: Motion, times: Floats, upper: Letter, drawn: tuple[str, ...] = ()) -> Shown:
    """The motion at the times of frames, with its lines and vectors."""
    first, last = sorted(span(m))
    arrows = bool({*drawn} - {"path"})
    centre, orientation, theta = seen(m, np.clip(times, first, last), "centre", "orientation", "theta")
    spin = None
    if m._turning == "spin":
        (spin,) = seen(m, np.clip(times, first, last), "spin")
    along = np.linspace(first, last, _PATH_POINTS)
    contact, way = seen(m, along, "contact_point", "centre")
    turned = _turns(m, along)
    slips = seen(m, along, "phase")[0] == 1 if has_friction(m.contact) else np.zeros(along.size, bool)
    gaps, up = np.zeros(along.size, bool), goes_up(m)
    if up:
        (phase,), other = seen(m, along, "phase"), aloft(m, first, last).on_other(along)
        slips = np.isin(phase, SLIPS)
        stands = phase == ON_FACE
        jumps = (other[1:] != other[:-1]) | (stands[1:] != stands[:-1])
        gaps = (phase == FLIES) | np.append(False, jumps)
        contact = np.where(stands[:, np.newaxis], way[:, :2], contact)
    low, high = way[:, :2].min(axis=0), way[:, :2].max(axis=0)
    body = max(size(m.body), farthest(m.body))
    reach, top = math.hypot(*(high - low)) / 2 + body, 2 * float(way[:, 2].max())
    if up:
        peaks = tops(seen(m, along, "theta")[0], way[:, 2], body) if m._nods else way[:, 2] + body
        top = float(peaks.max())
    return Shown(
        motion=m,
        centre=centre,
        rotation=rotations(orientation),
        theta=theta,
        spin=spin,
        path=np.column_stack([contact, np.zeros(along.size)]),
        along=along,
        slips=slips,
        gaps=gaps,
        turned=turned,
        vectors=vectors(m, times, drawn) if arrows else None,
        sizes=usual(m, drawn) if arrows else {},
        ink=marks(m.body, upper),
        middle=np.array([*((low + high) / 2), 0.45 * top]),
        reach=reach,
        half=held(reach, top),
    )


def _turns(m: Motion, along: Floats) -> Floats:
    """Turns about the vertical at ascending times; for a stone the integral of its spin."""
    (turned,) = seen(m, along, m._turning)
    if m._turning == "spin":
        turned = np.append(0.0, np.cumsum(np.diff(along) * (turned[1:] + turned[:-1]) / 2))
    found: Floats = turned / (2 * np.pi)
    return found
