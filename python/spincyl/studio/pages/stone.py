"""Data about a stone for the page: its numbers, its surfaces, and the times at which the spin reverses."""

from functools import singledispatch
from itertools import pairwise
from typing import Any

import numpy as np

from spincyl._ellipsoid import Ellipsoid
from spincyl._ellipsoid_motion import EllipsoidMotion
from spincyl._input.numbers import Floats
from spincyl._motion import Motion
from spincyl.studio.pages.few import corners, packed_part
from spincyl.studio.poses import seen
from spincyl.studio.shape import Letter, Profile, marks, profiles, reach
from spincyl.studio.stone_shape import turned_marks

_REVERSAL_SHARE = 0.1  # a reversed spin counts from this share of the first spin on
_SAMPLES_PER_KNOT = 8  # samples between two knots


@singledispatch
def numbers(m: Motion, t: Floats) -> dict[str, Any]:
    """Numbers of a body for the page; for a stone, reversal times and `ell` of a cylinder of its size."""
    found = {"ell": m.body.ell, "i1": m.body.i1, "i3": m.body.i3}
    if m.body.rims is not None:
        rows = {"circles": m.body.circles.tolist(), "borders": m.body.borders.tolist()}
        return found | rows | {"ell": max(0.0, reach(m.body) ** 2 - 1) ** 0.5}
    return found | ({"fillet": m.body.fillet, "far": reach(m.body)} if m.body.fillet > 0 else {})


@numbers.register
def _(m: EllipsoidMotion, t: Floats) -> dict[str, Any]:
    far = reach(m.body)
    return {
        "ell": max(0.0, far * far - 1) ** 0.5,
        "axes": np.asarray(m.body.semi_axes).tolist(),
        "offset": np.asarray(m.body.offset).tolist(),
        "inertia": np.asarray(m.body.inertia).tolist(),
        "back": turns_back(m, t),
    }


@singledispatch
def turned(body: Any, upper: Letter) -> dict[str, Any]:
    """The surface of a body, and its marks."""
    return {
        "turned": [{"colour": p.colour, "corners": corners(p)} for p in profiles(body)],
        "marks": [packed_part(part) for part in marks(body, upper)],
    }


@turned.register
def _(body: Ellipsoid, upper: Letter) -> dict[str, Any]:
    flat = turned_marks(body, upper)
    return {
        "turned": [*map(_stretched, profiles(body)), *(_stretched(p, mark=True) for p in flat)],
        "marks": [] if flat else [packed_part(part) for part in marks(body, upper)],
    }


def _stretched(profile: Profile, **more: bool) -> dict[str, Any]:
    """A surface of revolution with the factors that stretch it."""
    assert profile.stretch is not None
    how = {"corners": corners(profile)} | profile.stretch._asdict() | more
    return {"colour": profile.colour, "corners": how}


def turns_back(m: EllipsoidMotion, t: Floats) -> list[float]:
    """Times of zero spin after which the spin reaches a tenth of its first value in the other direction.

    The spin is sampled between ascending times, of which there have to be a few per rocking.
    """
    share = np.arange(_SAMPLES_PER_KNOT) / _SAMPLES_PER_KNOT
    t = np.append((t[:-1, np.newaxis] + np.diff(t)[:, np.newaxis] * share).ravel(), t[-1])
    (spin,) = seen(m, t, "spin")
    far = np.flatnonzero(np.abs(spin) >= _REVERSAL_SHARE * abs(spin[0])) if spin[0] else np.empty(0, int)
    found = []
    for before, after in pairwise(far):
        if spin[before] * spin[after] < 0:
            zeros = np.flatnonzero(np.sign(spin[before:after]) != np.sign(spin[before + 1 : after + 1]))
            k = before + zeros[-1]
            found.append(float(t[k] - spin[k] * (t[k + 1] - t[k]) / (spin[k + 1] - spin[k])))
    return found
