"""Data about friction for the page: phases, and slip and contact forces at equally spaced times."""

from typing import Any

import numpy as np

from spincyl._input.numbers import Floats
from spincyl._motion import Motion
from spincyl._phases import KINDS
from spincyl.studio.aloft import aloft, force_beside, goes_up
from spincyl.studio.pages.aloft import beside, flying
from spincyl.studio.poses import pace, span

_IN_A_NUTATION, _FEWEST, _MOST = 48, 480, 6000


def rubbing(m: Motion) -> dict[str, Any]:
    """`forces` at equally spaced times, as 16-bit integers between bounds, and phases as (time, code)."""
    first, last = span(m)
    count = _IN_A_NUTATION * (last - first) / pace(m)
    times = np.linspace(first, last, int(np.clip(count, _FEWEST, _MOST)))
    found = forces(m, times)
    low, high = found.min(axis=0), found.max(axis=0)
    whole = np.round((found - low) / np.where(high > low, high - low, 1.0) * 0xFFFF)
    told: dict[str, Any] = {"lows": low.tolist(), "highs": high.tolist(), "forces": (whole, "<u2")}
    if m._phases is not None:
        told["phases"] = [[phase.time, KINDS.index(phase.kind)] for phase in m.phases]
    return told | flying(m) | beside(m, times) if goes_up(m) else told


def forces(m: Motion, t: Floats) -> Floats:
    """Slip, friction and normal force at ascending times: u_h, u_2, F_h, F_2, N along a last axis.

    Without a law of friction the slip is zero. For a stone, slip and friction have components along x and y
    of the laboratory.
    """
    there = m.wanting("pose", "force", t=t)
    force = there.contact_force
    if goes_up(m):  # that on the other rim is drawn apart
        force = force - force_beside(there)
    push = force[:, :2] @ [1, 1j]
    slip = np.zeros(push.shape, complex) if m._phases is None else there.slip @ [1, 1j]
    if not there._nods:
        # the axes of a state's slip are rotated by this angle about the vertical
        z, w = there.orientation[:, 2:].T
        slip = slip * np.exp(2j * np.arctan2(z, w))
    elif goes_up(m):
        # on the page theta and phi refer to the first rim
        lean = aloft(m, *span(m)).from_first(there.t, there.theta, there.phi, there.psi)[:, 1]
        turn = np.exp(1j * (there.phi - lean))
        slip, push = slip * turn, push * np.exp(-1j * lean)
    else:
        push = push * np.exp(-1j * there.phi)
    found: Floats = np.column_stack([slip.real, slip.imag, push.real, push.imag, there.normal])
    return found
