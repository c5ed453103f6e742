"""Motions that leave the table or lie on both rims: their kinks, and angles told from one rim throughout.

An impact changes all velocities at once, so that positions and angles have a kink there. Where the other rim
takes over, theta, phi and psi are told from that rim: theta becomes pi - theta, phi grows by pi, psi changes
its sign. Told from the first rim throughout, they are continuous.
"""

from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spincyl._contact import Contact
from spincyl._input.numbers import Floats
from spincyl._phases import Phase
from spincyl._state import State
from spincyl._studio.surface import rotations
from spincyl._swing import swing

if TYPE_CHECKING:
    from spincyl._body import Body
    from spincyl._motion import Motion

#: Shares of the time shown: width of a kink, and the distance below which kinks become one. Bounces that come
#: to an end are as many as one likes in a moment.
_KINK, _NEAR = 1e-9, 1e-6
#: Of phases shorter than this share the rates are not asked for.
_BRIEF = 1e-3
#: Kinds of phases on one rim, and on both.
_ON_RIM, _ON_BOTH = ("rolling", "slipping"), ("lying", "pivoting", "rolling on its side")
#: Codes of phases in which a point of contact slips.
SLIPS = (1, 3, 4)
FLIES = 2


def goes_up(m: "Motion") -> bool:
    """Whether the motion ever leaves the table or lies on both rims."""
    return m._impacts is not None and any(phase.kind not in _ON_RIM for phase in m.phases)


class Aloft(NamedTuple):
    """What a motion that leaves the table has besides its poses."""

    edges: Floats  #: (k, 2) where each kink begins and ends, ascending
    begins: Floats  #: times of phases at which no kink is
    times: Floats  #: times at which another rim takes over
    turns: np.ndarray  #: how often one has taken over until each of these; before them, the first number

    def taken(self, t: Floats) -> Any:
        """How often another rim has taken over until these times; odd numbers tell of the other rim."""
        return self.turns[np.searchsorted(self.times, t, "right")]

    def from_first(self, t: Floats, theta: Floats, phi: Floats, psi: Floats) -> Floats:
        """The three angles as told from the first rim, along a last axis."""
        taken = self.taken(t)
        other = taken % 2 == 1
        found: Floats = np.stack(
            [np.where(other, np.pi - theta, theta), phi - np.pi * taken, np.where(other, -psi, psi)], -1
        )
        return found


def aloft(m: "Motion", first: float, last: float) -> Aloft:
    """Kinks of a motion between its first and its last time, and how often another rim takes over."""
    kinks = {x.time for x in m.natural.impacts}
    kinds = ["", *(phase.kind for phase in m.phases)]
    kinks |= {
        phase.time
        for before, phase in zip(kinds, m.phases, strict=False)
        if not {before, phase.kind} <= {*_ON_RIM}
    }
    inside = [t for t in sorted(kinks) if first < t < last]
    changes, taken = _changes(m, np.array(inside), first, last)
    near, half = _NEAR * (last - first), _KINK / 2 * (last - first)
    edges: list[list[float]] = []
    for t in inside:
        if edges and t - edges[-1][1] < near:
            edges[-1][1] = t + half
        else:
            edges.append([t - half, t + half])
    # a kink at an end of the motion needs no knots of its own
    edges = [edge for edge in edges if first + near < edge[0] and edge[1] < last - near]
    begins = [phase.time for phase in m.phases if first < phase.time < last and phase.time not in kinks]
    return Aloft(np.array(edges).reshape(-1, 2), np.array(begins), changes, taken)


def _changes(m: "Motion", t: Floats, first: float, last: float) -> tuple[Floats, np.ndarray]:
    """The times among these at which another rim takes over, and how often one has done so until each."""
    apart = np.diff(np.concatenate([[first], t, [last]]))
    off = np.minimum(np.minimum(apart[:-1], apart[1:]) / 4, _KINK / 2 * (last - first))
    looks = np.unique(np.concatenate([[first + (off[0] if t.size else 0.0)], t - off, t + off]))
    there = m.wanting("pose", t=looks)
    # steps to other times may end the motion a little earlier
    t = t[t + off <= there.t[-1]] if there.t.size else t[:0]
    off = off[: t.size]
    before, after = (there.phi[np.searchsorted(there.t, x)] for x in (t - off, t + off))
    by = np.round((after - before) / np.pi).astype(int)
    # at first: from which end of the axis the angles are told
    theta, phi = there.theta[:1], there.phi[:1]
    told = np.stack([-np.sin(theta) * np.cos(phi), -np.sin(theta) * np.sin(phi), np.cos(theta)], -1)
    at_first = int((rotations(there.orientation[:1])[:, :, 2] * told).sum() < 0) if theta.size else 0
    turned = np.cumsum([at_first, *by[by != 0]])
    return t[by != 0], turned


def parts(m: "Motion", first: float, last: float) -> list[tuple[float, float, float]]:
    """Begin, end and nutations per unit of time of each phase in these times."""
    times = [*(phase.time for phase in m.phases), last]
    found = []
    for phase, end in zip(m.phases, times[1:], strict=True):
        begin, end = max(phase.time, first), min(end, last)
        if begin < end:
            brief = end - begin < _BRIEF * (last - first)
            found.append((begin, end, 0.0 if brief else _often(m.body, phase)))
    return found


def _often(body: "Body", phase: Phase) -> float:
    """Nutations per unit of time; in the air turns of the axis about the angular momentum, which stays."""
    state: State = replace(phase.state, slip=None, height=None, lift=None)
    if phase.kind == "flying":
        w = np.array([state.w1, state.w2, state.w3 * body.i3 / body.i1])
        return float(np.linalg.norm(w) / (2 * np.pi))
    if phase.kind in _ON_BOTH:
        return 0.0  # the axis only turns about the vertical
    contact: Contact = "rolling" if phase.kind == "rolling" else "smooth"
    with suppress(ValueError):  # where the first integrals lose their digits
        return 1 / swing(body, state, contact).period
    return 0.0


def tops(body: "Body", theta: Floats, z: Floats, far: float) -> Floats:
    """Height of the highest place of a body, as of a cylinder with the largest distance `far` from its centre."""
    half = np.sqrt(max(0.0, far * far - 1))
    found: Floats = z + half * np.abs(np.cos(theta)) + np.sin(theta)
    return found
