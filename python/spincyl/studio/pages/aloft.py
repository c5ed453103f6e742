"""Data about a body that leaves the table or lies on both rims: phases, their description, and forces."""

from typing import Any

import numpy as np

from spincyl._input.numbers import Floats
from spincyl._motion import Motion
from spincyl._phases import KINDS, has_two_rims
from spincyl.studio.aloft import FLIES, ON_FACE, aloft, force_beside, strikes
from spincyl.studio.poses import span

#: In the description, phases shorter than this share of the time shown belong to the bounces around them.
_BRIEF = 2e-3


def flying(m: Motion) -> dict[str, Any]:
    """Phases as (time, code, whether the second rim is the lower one), and for text as (time, code, impacts).

    For a stone, which has no rims, the third number is 0.
    """
    first, last = span(m)
    begins = np.array([phase.time for phase in m.phases])
    ends = np.append(begins[1:], last)
    codes = [KINDS.index(phase.kind) for phase in m.phases]
    rims = aloft(m, first, last).on_other((begins + np.maximum(begins, ends)) / 2)
    phases = [list(x) for x in zip(begins.tolist(), codes, rims.astype(int).tolist(), strict=True)]
    return {
        "aloft": True,
        "two": m._nods and has_two_rims(m.body),
        "phases": phases,
        "told": _told(m, begins, ends, codes),
    }


def _told(m: Motion, begins: Floats, ends: Floats, codes: list[int]) -> list[list[float]]:
    """Phases with successive bounces, and brief phases between them, joined to one flight with impacts."""
    first, last = span(m)
    brief = ends - begins < _BRIEF * (last - first)
    found: list[list[float]] = []
    k = 0
    while k < len(codes):
        until = k
        while until < len(codes) and (codes[until] == FLIES or brief[until]):
            until += 1
        if FLIES not in codes[k:until]:
            until = k + 1
        flies = FLIES in codes[k:until]
        end = ends[until - 1]
        many = sum(bool(begins[k] < x.time <= end) for x in strikes(m)) if flies else 0
        told = FLIES if flies else codes[k]
        if found and found[-1][1] == told:
            found[-1][2] += many
        else:
            found.append([float(begins[k]), told, many])
        k = until
    return found


def beside(m: Motion, t: Floats) -> dict[str, Any]:
    """Force on the rim to which theta does not refer, as 16-bit integers between bounds: F_h, F_2, N."""
    there = m.wanting("pose", "force", t=t)
    on_both = (there.phase > FLIES) & (there.phase != ON_FACE)
    if not on_both.any():
        return {}
    up = aloft(m, *span(m))
    told = np.where(up.on_other(there.t), -1.0, 1.0)  # sign by the rim to which theta refers
    force = np.where(on_both[:, np.newaxis], force_beside(there), 0.0)
    push = told * (force[:, :2] @ [1, 1j]) * np.exp(-1j * there.phi)
    found = np.zeros((t.size, 3))  # no force after the end, which may come a little earlier
    found[: there.t.size] = np.column_stack([push.real, push.imag, force[:, 2]])
    low, high = found.min(axis=0), found.max(axis=0)
    whole = np.round((found - low) / np.where(high > low, high - low, 1.0) * 0xFFFF)
    return {"least": low.tolist(), "largest": high.tolist(), "others": (whole, "<u2")}
