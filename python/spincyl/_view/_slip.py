"""What a page shows of friction: phases, and at even times the slip and the forces on the contact."""

from typing import Any

import numpy as np

from spincyl._array import Floats
from spincyl._ellipsoid_motion import EllipsoidMotion
from spincyl._motion import Motion
from spincyl._phases import KINDS
from spincyl._poses import pace, span
from spincyl._slip import lever
from spincyl._surface import rotations

_IN_A_NUTATION, _FEWEST, _MOST = 48, 480, 6000


def rubbing(m: Motion) -> dict[str, Any]:
    """Phases as (time, code), and what `forces` finds at even times, in sixteen bits between bounds."""
    first, last = span(m)
    count = _IN_A_NUTATION * (last - first) / pace(m)
    found = forces(m, np.linspace(first, last, int(np.clip(count, _FEWEST, _MOST))))
    low, high = found.min(axis=0), found.max(axis=0)
    whole = np.round((found - low) / np.where(high > low, high - low, 1.0) * 0xFFFF)
    phases = [[phase.time, KINDS.index(phase.kind)] for phase in m.phases]
    return {"phases": phases, "lows": low.tolist(), "highs": high.tolist(), "forces": (whole, "<u2")}


def forces(m: Motion, t: Floats) -> Floats:
    """Slip, friction and normal force at ascending times: u_h, u_2, F_h, F_2, N along a last axis.

    Friction is what accelerates the centre, F = v', by differences of its velocity: the same for all phases.
    Of a stone, slip and friction stand along the axes x and y of the laboratory.
    """
    h = 1e-5 * min(1.0, float(t[-1] - t[0]))
    around = np.clip(np.stack([t - h, t, t + h], -1), t[0], t[-1])
    there = m.wanting("pose", "force", t=np.unique(around))
    row = np.minimum(np.searchsorted(there.t, around), there.t.size - 1)
    slip, velocity, turn = _carried(there)
    v = (velocity * turn)[row]
    push = (v[:, 2] - v[:, 0]) / (there.t[row[:, 2]] - there.t[row[:, 0]]) * np.conj(turn[row[:, 1]])
    middle = row[:, 1]
    found: Floats = np.column_stack([slip[middle], push.real, push.imag, there.normal[middle]])
    return found


def _carried(there: Motion) -> tuple[Floats, Any, Any]:
    """Slip along two axes, along these the velocity of the centre as a complex number, and their own turn."""
    if not isinstance(there, EllipsoidMotion):
        along, across = there.body.centre_velocity(there.states)
        return there.slip, np.stack([along, across], -1) @ [1, 1j], np.exp(1j * there.phi)
    turned = rotations(there.orientation)
    z, w = there.orientation[:, 2:].T
    # what the slip of a state is told along has been turned by this about the vertical
    slip = (there.slip @ [1, 1j]) * np.exp(2j * np.arctan2(z, w))
    around = np.cross(there.w, lever(there.body, there.vertical))
    carried = np.einsum("nij,nj->ni", turned, around)[:, :2] @ [1, 1j]
    return np.column_stack([slip.real, slip.imag]), slip - carried, np.ones(slip.shape)
