"""Motions in the air, on both rims or on a face: their kinks, and angles that refer to one rim throughout.

An impact changes all velocities at once, so that positions and angles have a kink. Where the other rim
becomes the lower one, theta, phi and psi refer to that rim: theta becomes pi - theta, phi grows by pi, psi
changes its sign. Angles that refer to the first rim throughout are continuous, except where a body stands on
its face: then only the sum of phi and psi has a meaning, and phi jumps to the point over which the body
topples. A stone has neither rims nor these angles: only its kinks are used.
"""

from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spincyl._contact import Contact
from spincyl._input.numbers import Floats
from spincyl._phases import KINDS, RIMS, Impact, Phase
from spincyl._state import State
from spincyl._swing import swing_on
from spincyl.studio.shape import rotations

if TYPE_CHECKING:
    from spincyl._motion import Motion

#: Shares of the time shown: width of a kink, and the distance below which kinks become one. Bounces that die
#: out are arbitrarily many in a short time.
_KINK, _NEAR = 1e-9, 1e-6
#: The nutations of phases shorter than this share are not counted.
_BRIEF = 1e-3
# per rocking of a stone, with steps within 1e-14; fewer with a larger tolerance, as its -1/10 power
_EVALUATIONS = 900
#: A body tumbles in a vertical plane if its other rates are below this share; impacts leave rounding errors.
_PLANAR = 1e-12
#: Kinds of phases on one rim, and on both.
_ON_RIM, _ON_BOTH = ("rolling", "slipping"), KINDS[3:]
#: Codes of phases in which a point of contact slips, in the air, and on the face.
SLIPS = (1, 3, 4, 7)
FLIES, ON_FACE = 2, 7


def goes_up(m: "Motion") -> bool:
    """Whether the motion at any time leaves the table, lies on both rims, stands on its face or rocks."""
    rocks = m._impacts is not None and len(m._impacts) > 0
    return rocks or (m._phases is not None and any(phase.kind not in _ON_RIM for phase in m.phases))


def strikes(m: "Motion") -> "tuple[Impact, ...]":
    """The impacts of a motion; an empty tuple if the motion ends where the body leaves the table."""
    return () if m._impacts is None else m.impacts


def force_beside(m: "Motion") -> Floats:
    """(n, 3) force on the rim to which theta does not refer, along laboratory axes; 0 if it is in the air."""
    found: Floats = np.nan_to_num(m._extra.get("contact_force_other", np.zeros((m.t.size, 3))))
    return found


def pressed(centre: Floats, force: Floats) -> Floats:
    """(n, 3) centre of pressure on a face; friction shifts it from the point below the centre of mass."""
    with np.errstate(divide="ignore", invalid="ignore"):
        off = np.nan_to_num(centre[:, 2:] * force[:, :2] / force[:, 2:])
    return np.column_stack([centre[:, :2] - off, np.zeros(len(centre))])


class Aloft(NamedTuple):
    """Kinks of a motion that leaves the table, and the changes of the rim to which its angles refer."""

    edges: Floats  #: (k, 2) begin and end of each kink, ascending
    begins: Floats  #: begins of phases that have no kink
    times: Floats  #: times at which the reference of the angles changes
    #: (k + 1, 5) until each of these times: how often the rim has changed; half turns by which phi, and psi
    #: with respect to the first rim, have jumped; whole turns and sign with which theta is counted
    told: np.ndarray

    def on_other(self, t: Floats) -> Any:
        """Whether the angles of the motion at these times refer to the rim that was not the first."""
        return self.told[np.searchsorted(self.times, t, "right"), 0] % 2 == 1

    def from_first(self, t: Floats, theta: Floats, phi: Floats, psi: Floats) -> Floats:
        """The three angles with respect to the first rim, continuous, along a last axis.

        A body that only tumbles in a vertical plane passes the poles; its theta continues beyond them.
        """
        told = self.told[np.searchsorted(self.times, t, "right")]
        rims, across, about, turns, sign = np.moveaxis(told, -1, 0)
        other = rims % 2 == 1
        lean, spin = np.where(other, np.pi - theta, theta), np.where(other, -psi, psi)
        phi, spin = phi - np.pi * across, spin - np.pi * about
        # with a vertical axis only the sum of both has a meaning, or their difference
        flat, up = (lean == 0) | (lean == np.pi), np.where(lean < np.pi / 2, 1.0, -1.0)
        phi, spin = np.where(flat, 0.0, phi), np.where(flat, spin + up * phi, spin)
        found: Floats = np.stack([2 * np.pi * turns + sign * lean, phi, spin], -1)
        return found


def aloft(m: "Motion", first: float, last: float) -> Aloft:
    """Kinks of a motion between two times, and the changes of the rim to which its angles refer."""
    kinks = {x.time for x in strikes(m.natural)}
    kinds = ["", *(phase.kind for phase in m.phases)]
    kinks |= {
        phase.time
        for before, phase in zip(kinds, m.phases, strict=False)
        if not {before, phase.kind} <= {*_ON_RIM}
    }
    begins = [phase.time for phase in m.phases if first < phase.time < last and phase.time not in kinks]
    inside = np.array(sorted(t for t in kinks if first < t < last))
    near, half = _NEAR * (last - first), _KINK / 2 * (last - first)
    # a kink at an end of the motion needs no knots of its own
    edges = np.array([[a - half, b + half] for a, b in _groups(inside, near)]).reshape(-1, 2)
    edges = edges[(first + near < edges[:, 0]) & (edges[:, 1] < last - near)]
    if not m._nods:
        return Aloft(edges, np.array(begins), np.empty(0), np.array([(0, 0, 0, 0, 1)]))
    found = Aloft(edges, np.array(begins), *_changes(m, inside, _poles(m, first, last), first, last))
    return _without_turns(m, found) if len(edges) else found


def _without_turns(m: "Motion", up: Aloft) -> Aloft:
    """Remove whole turns of phi and psi from kinks that merge several impacts."""
    there = m.wanting("pose", t=up.edges.ravel())
    many = there.t.size // 2
    angles = up.from_first(there.t, there.theta, there.phi, there.psi)[: 2 * many].reshape(many, 2, 3)
    whole = np.round((angles[:, 1] - angles[:, 0]) / (2 * np.pi)).astype(int)[:, 1:]
    told = up.told.copy()
    for (begin, _), turns in zip(up.edges, whole, strict=False):
        told[1:][up.times > begin, 1:3] += 2 * turns
    return up._replace(told=told)


def _groups(t: Floats, near: float) -> list[tuple[float, float]]:
    """First and last time of each group of ascending times that are near each other."""
    ends = np.flatnonzero(np.diff(t) > near)
    return list(zip(t[[0, *(ends + 1)]], t[[*ends, -1]], strict=True)) if t.size else []


def _poles(m: "Motion", first: float, last: float) -> Floats:
    """The times at which a body that tumbles in a vertical plane passes a pole, where phi and psi jump."""
    found: list[float] = []
    for begin, end, often, phase in parts_of_flight(m, first, last):
        w1, w2, w3 = phase.state.w1, phase.state.w2, phase.state.w3
        if phase.kind != "flying" or not abs(w1) + abs(w3) < _PLANAR * abs(w2) or not often:
            continue
        t = np.linspace(begin, end, 16 + int(16 * (end - begin) * often))[1:-1]
        phi = m.wanting("pose", t=t).phi
        jumps = np.flatnonzero(np.abs(np.diff(phi)) > 1)
        low, high, before = t[jumps], t[jumps + 1], phi[jumps]
        for _ in range(60 if jumps.size else 0):
            middle = (low + high) / 2
            later = np.abs(m.wanting("pose", t=middle).phi - before) > 1
            low, high = np.where(later, low, middle), np.where(later, middle, high)
        found.extend(high.tolist())
    return np.array(found)


def _changes(m: "Motion", t: Floats, poles: Floats, first: float, last: float) -> tuple[Floats, np.ndarray]:
    """Times of `t` at which the rim to which the angles refer changes, and the changes as in `Aloft`."""
    groups = np.array(_groups(np.union1d(t, poles), 1e-12 * (last - first))).reshape(-1, 2)
    # both sides of each group, closer to it than to the next one
    gaps = np.concatenate([groups[:1, 0] - first, groups[1:, 0] - groups[:-1, 1], last - groups[-1:, 1]])
    off = np.minimum(np.minimum(gaps[:-1], gaps[1:]) / 4, _KINK / 2 * (last - first))[:, np.newaxis]
    sides = groups + off * [-1, 1] if len(groups) else groups
    start = first + (float(off[0, 0]) / 4 if len(groups) else 0.0)
    there = m.wanting("pose", t=np.unique(np.append(sides, start)))
    # with steps to other times the motion may end a little earlier
    sides = sides[sides[:, 1] <= there.t[-1]]
    place = np.searchsorted(there.t, sides)
    by_phi, by_psi = (np.round(np.diff(x[place])[:, 0] / np.pi).astype(int) for x in (there.phi, there.psi))
    # a face topples over any point of its rim: phi jumps there, but the rim is the same
    other_rim = np.diff(there.rim[place].astype(int))[:, 0] % 2 if m.body.rims is None else 0 * by_phi
    same = ~_has_pole(sides, poles) & (by_phi % 2 != other_rim)
    by_phi[same] = by_psi[same] = 0
    # at first: the end of the axis to which the angles refer
    theta, phi = there.theta[:1], there.phi[:1]
    axis = np.stack([-np.sin(theta) * np.cos(phi), -np.sin(theta) * np.sin(phi), np.cos(theta)], -1)
    at_first = int((rotations(there.orientation[:1])[:, :, 2] * axis).sum() < 0)
    told = [(at_first, at_first, 0, 0, 1)]
    for (before, after), across, about, k in zip(sides, by_phi, by_psi, place[:, 0], strict=True):
        rims, halves, spins, turns, sign = told[-1]
        if _has_pole(np.array([[before, after]]), poles)[0]:
            other = rims % 2 == 1
            below = (there.theta[k] > np.pi / 2) != other  # the pole at pi, with respect to the first rim
            spins += -about if other else about
            told.append((rims, halves + across, spins, turns + sign * below, -sign))
        else:
            told.append((rims + across, halves + across, spins, turns, sign))
    return sides.mean(axis=1), np.array(told)


def _has_pole(sides: Floats, poles: Floats) -> np.ndarray:
    """Whether the time of one of the poles lies between the two times of each row of `sides`."""
    found = (sides[:, :1] < poles) & (poles < sides[:, 1:])
    return np.asarray(found.any(axis=1))


def parts_of_flight(m: "Motion", first: float, last: float) -> list[tuple[float, float, float, Phase]]:
    """For each phase between two times: its begin, its end, its nutations per unit of time, and the phase."""
    times = [*(phase.time for phase in m.phases), last]
    found = []
    for phase, end in zip(m.phases, times[1:], strict=True):
        begin, end = max(phase.time, first), min(end, last)
        if begin < end:
            brief = end - begin < _BRIEF * (last - first)
            found.append((begin, end, 0.0 if brief else _often(m, phase), phase))
    return found


def pace_of_stone(m: "Motion") -> float:
    """The mean duration of the rockings of a stone, roughly, from the number of evaluations."""
    end = float(m._asked.times[-1]) if m.event is None or m._asked.beyond else m.event.time
    many = m.nfev / _EVALUATIONS * (m._setting / 1e-14) ** 0.1
    return float(abs(end - m._asked.t0) / max(many, 1e-3))


def _often(m: "Motion", phase: Phase) -> float:
    """Nutations per unit of time; in the air, turns of the axis about the constant angular momentum.

    For a stone its rockings, and in the air its turns.
    """
    if not m._nods:
        turns = float(np.linalg.norm(phase.state.w)) / (2 * np.pi)  # type: ignore[attr-defined]
        return turns if phase.kind == "flying" else 1 / pace_of_stone(m)
    body = m.body
    state: State = replace(phase.state, slip=None, height=None, lift=None)
    if phase.kind == "flying":
        w = np.array([state.w1, state.w2, state.w3 * body.i3 / body.i1])
        return float(np.linalg.norm(w) / (2 * np.pi))
    if phase.kind in _ON_BOTH:
        return 0.0  # the axis only turns about the vertical
    contact: Contact = "rolling" if phase.kind == "rolling" else "smooth"
    with suppress(ValueError):  # where the first integrals lose their digits
        return 1 / swing_on(body, state, contact, RIMS.index(phase.rim)).period
    return 0.0


def tops(theta: Floats, z: Floats, far: float) -> Floats:
    """Height of the highest point of a cylinder whose largest distance from its centre is `far`."""
    half = max(0.0, far * far - 1) ** 0.5
    found: Floats = z + half * np.abs(np.cos(theta)) + np.sin(theta)
    return found
