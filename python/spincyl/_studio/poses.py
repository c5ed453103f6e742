"""Poses of a motion for a machine that only interpolates: few knots, and a cubic between them.

Angles and places run smoothly even when a body whirls, so that a steady spin needs two knots and a nutation
four to eight. Every interval is halved until its cubic meets the motion within the tolerance. An exact motion
is the same period after period, but for a turn about the vertical and one about the axis: one tells all.

A stone has no axis from which such angles could be told: in their place are the four numbers of a quaternion,
each a cubic between knots, of which the length is made 1 afterwards.
"""

from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spincyl._contact import Contact, Coulomb, Viscous
from spincyl._ellipsoid import Ellipsoid
from spincyl._input.numbers import Floats
from spincyl._phases import rubs
from spincyl._slip import lever
from spincyl._state import State
from spincyl._studio.surface import rotations
from spincyl._swing import swing

if TYPE_CHECKING:
    from spincyl._motion import Motion

_MOST, _LONGEST, _LOOKS = 200_000, 3000, 65
_EVALUATIONS = 900  # to a rocking of a stone for steps within 1e-14; fewer as the tenth root of that bound
_TURN, _PLACE = [0, 1, 2, 5], [3, 4]  # the numbers of a stone's pose; its place is where a body has it


def span(m: "Motion") -> tuple[float, float]:
    """First and last time that there is to show, in the motion's own direction.

    Raises
    ------
    ValueError
        If there is none between them.
    """
    times, start = m._asked.times, m._asked.t0
    first = start if times.size == 1 else float(times[0])
    last = float(times[-1])
    if m.event is not None and not m._asked.beyond:
        # just before the event, where the state is still one of the model
        last = m.event.time - 1e-9 * (m.event.time - start)
    elif m.t.size < times.size:  # beyond the landing of a face there is nothing
        last = float(m.t[-1]) if m.t.size else first
    if not (last - first) * (times[-1] - start) > 0:
        raise ValueError(f"the motion has no duration to show from t = {first:.6g} on: {m.message}")
    return first, last


def seen(m: "Motion", t: Floats, *names: str) -> list[Floats]:
    """Attributes of the motion, such as "phi" or "centre", at times in any order; pose included.

    Found step by step anew, a motion may end a little earlier: its last state then stands for the rest.
    """
    times, back = np.unique(t, return_inverse=True)
    backward = -1 if m._asked.times[-1] < m._asked.t0 else 1
    there = m.wanting("pose", t=times[::backward])
    if there.t.size == 0:
        raise ValueError(f"there is nothing to show at t = {times[::backward][0]:.6g}: {there.message}")
    rows = np.minimum(np.arange(times.size), there.t.size - 1)[::backward]
    return [getattr(there, name)[rows][back.reshape(np.shape(t))] for name in names]


def pace(m: "Motion") -> float:
    """How long a nutation takes: the exact period, or with friction the shortest of those of its phases.

    With losses the mean of those on the way, which become shorter as a disk falls. Of a stone the mean of its
    rockings, about, as the steps tell it in which they were found.
    """
    if isinstance(m.body, Ellipsoid):
        many = m.nfev / _EVALUATIONS * (m._setting / 1e-14) ** 0.1
        return float(abs(_end(m) - m._asked.t0) / max(many, 1e-3))
    if m.losses is not None:
        return _mean_pace(m)
    if not isinstance(m.contact, Coulomb | Viscous):
        return swing(m.body, m.start, m.contact).period
    found = [np.inf]
    for phase in m.phases:
        contact: Contact = "rolling" if phase.kind == "rolling" else "smooth"
        with suppress(ValueError):  # where the first integrals have no digits
            found.append(swing(m.body, replace(phase.state, slip=None), contact).period)
    return min(found)


def _mean_pace(m: "Motion") -> float:
    """The time that is shown over the number of nutations in it."""
    first, last = span(m)
    t = np.linspace(first, last, _LOOKS)
    theta, w = seen(m, t, "theta", "w")
    rolls = np.full(t.shape, m.contact != "smooth")
    if rubs(m.contact):
        rolls = seen(m, t, "phase")[0] == 0
    found = np.zeros(t.shape)
    for k, (tilt, turning, rolling) in enumerate(zip(theta, w, rolls, strict=True)):
        with suppress(ValueError):
            found[k] = 1 / swing(m.body, State(tilt, *turning), "rolling" if rolling else "smooth").period
    many = float(np.mean(found))
    return 1 / many if many > 0 else np.inf


def _end(m: "Motion") -> float:
    """Up to where it was found."""
    return float(m._asked.times[-1]) if m.event is None or m._asked.beyond else m.event.time


class Repeat(NamedTuple):
    """How an exact motion goes on after a period."""

    period: float
    phi: float  #: what it grows by
    psi: float  #: what it grows by
    turn: complex  #: the centre's path z goes on as turn z + shift
    shift: complex


def repeats(m: "Motion") -> Repeat | None:
    """How it goes on if it is exact and shown for longer than a period; ValueError if for 3000 of them."""
    first, last = sorted(span(m))
    period = pace(m)
    if last - first > _LONGEST * period:
        many = (last - first) / period
        raise ValueError(f"{many:.0f} nutations are too many to show: roll over a shorter time")
    if m.method != "exact" or not period < last - first:
        return None
    phi, psi, centre = seen(m, np.array([first, first + period]), "phi", "psi", "centre")
    turn = complex(np.exp(1j * (phi[1] - phi[0])))
    before, after = (complex(*place[:2]) for place in centre)
    return Repeat(period, float(phi[1] - phi[0]), float(psi[1] - psi[0]), turn, after - turn * before)


def knots(m: "Motion", tolerance: float = 2e-3, until: float | None = None) -> Floats:
    """Times, places and slopes from which a page draws the motion.

    Parameters
    ----------
    m : Motion
    tolerance : float
        Largest error of an angle (radians) or of the centre (R) at the places looked at.
    until : float, optional
        Where to stop. Default: where the motion does.

    Returns
    -------
    ndarray, shape (n, 11)
        t; theta, phi, psi, x and y of the centre; the slopes of these five. Ascending times. Of a stone
        (n, 13): x, y, z of its quaternion in place of the angles, and w after the centre.

    Raises
    ------
    ValueError
        If the motion is too long to show: more than 3000 nutations, or 200,000 knots.
    """
    first, last = sorted(span(m))
    last = last if until is None else until
    period = pace(m)
    count = 4 if not np.isfinite(period) else 3 * (last - first) / period
    share = np.linspace(0, 1, max(4, int(count)) + 1)
    if m.losses is not None:
        share = 1 - (1 - share) ** 3  # what comes to rest is fastest at its end
    t = first + (last - first) * share
    open_ = np.ones(len(t) - 1, bool)
    smallest = 1e-8 * (last - first)
    while True:
        found = _poses(m, t)
        left, right = found[:-1][open_], found[1:][open_]
        missed = (_missed(m, left, right) > tolerance) & (right[:, 0] - left[:, 0] > smallest)
        if not missed.any():
            break
        if len(t) + missed.sum() > _MOST:
            raise ValueError(f"more than {_MOST} poses are needed: roll over a shorter time")
        at = np.flatnonzero(open_)[missed] + 1
        t = np.insert(t, at, ((left[:, 0] + right[:, 0]) / 2)[missed])
        still = np.zeros(len(open_), bool)
        still[at - 1] = True
        open_ = np.insert(still, at, True)
    # and coarser where more than one interval makes a cubic
    while len(found) > 2:
        dropped = np.arange(1, len(found) - 1, 2)
        left, right = found[dropped - 1], found[dropped + 1]
        kept = found[dropped]
        ends = _apart(m, _cubic(left, right, kept[:, 0]), kept[:, 1 : _wide(found)])
        fits = np.maximum(ends, _missed(m, left, right)) < tolerance / 2
        if not fits.any():
            break
        found = np.delete(found, dropped[fits], axis=0)
    return found


def _missed(m: "Motion", left: Floats, right: Floats) -> Floats:
    """How far the cubics between these knots are off, at places that no symmetry of a motion favours."""
    worst = np.zeros(len(left))
    for share in (0.19, 0.46, 0.77):
        t = left[:, 0] + share * (right[:, 0] - left[:, 0])
        worst = np.maximum(worst, _apart(m, _cubic(left, right, t), _places(m, t)))
    return worst


def _apart(m: "Motion", drawn: Floats, true: Floats) -> Floats:
    """How far numbers of poses are from those of the motion: the largest of angles and of places.

    Of a stone that of the contact, too: where it is flat, a small angle is a long way of the contact.
    """
    if not isinstance(m.body, Ellipsoid):
        apart: Floats = np.abs(drawn - true).max(axis=1)
        return apart
    (q, *at), (p, *there) = _stood(m.body, drawn), _stood(m.body, true)
    places = [np.abs(a - b).max(axis=1) for a, b in zip(at, there, strict=True)]
    found: Floats = np.maximum(2 * np.linalg.norm(q - p, axis=1), np.maximum(*places))
    return found


def _stood(stone: Ellipsoid, numbers: Floats) -> tuple[Floats, Floats, Floats]:
    """The quaternion, the centre and the contact point of a stone's poses."""
    q, place = numbers[:, _TURN], numbers[:, _PLACE]
    q = q / np.linalg.norm(q, axis=1, keepdims=True)
    turned = rotations(q)
    arm = np.einsum("nij,nj->ni", turned, lever(stone, turned[:, 2]))
    return q, place, place + arm[:, :2]


def _places(m: "Motion", t: Floats) -> Floats:
    """The numbers of poses along a last axis, in the order of `knots`."""
    if isinstance(m.body, Ellipsoid):
        turn, centre = seen(m, t, "orientation", "centre")
        return np.concatenate([turn[..., :3], centre[..., :2], turn[..., 3:]], -1)
    theta, phi, psi, centre = seen(m, t, "theta", "phi", "psi", "centre")
    found: Floats = np.stack([theta, phi, psi, centre[..., 0], centre[..., 1]], -1)
    return found


def _poses(m: "Motion", t: Floats) -> Floats:
    """Rows of `knots` at ascending times, the slopes by differences a thousand times finer than these."""
    gaps = np.diff(t)
    h = 1e-3 * np.minimum(np.append(gaps, gaps[-1]), np.append(gaps[0], gaps))
    around = np.clip(np.stack([t - h, t, t + h], -1), t[0], t[-1])
    y = _places(m, around)
    slopes = (y[:, 2] - y[:, 0]) / (around[:, 2] - around[:, 0])[:, np.newaxis]
    return np.column_stack([t, y[:, 1], slopes])


def _wide(found: Floats) -> int:
    """How many numbers of a knot are no slopes: its time, and those of its pose."""
    return int(found.shape[1] + 1) // 2


def _cubic(left: Floats, right: Floats, t: Floats) -> Floats:
    """The numbers of a pose at t between two knots: the page's interpolation."""
    wide = _wide(left)
    h = (right[:, 0] - left[:, 0])[:, np.newaxis]
    s = (t[:, np.newaxis] - left[:, :1]) / h
    y0, y1, d0, d1 = left[:, 1:wide], right[:, 1:wide], h * left[:, wide:], h * right[:, wide:]
    cubic: Floats = y0 + s * (d0 + s * (3 * (y1 - y0) - 2 * d0 - d1 + s * (2 * (y0 - y1) + d0 + d1)))
    return cubic


def packed(found: Floats) -> dict[str, Any]:
    """Knots in few bytes: whole numbers between bounds, and slopes by what they differ from a guess.

    The guess is the slope at a knot of the parabola through it and its neighbours; the difference is
    weighed by the longer of the intervals beside it, where its error shows most.
    """
    wide = _wide(found)
    low, high = found[:, :wide].min(axis=0), found[:, :wide].max(axis=0)
    # what the page will read: slopes are to fit that
    whole = np.round((found[:, :wide] - low) / np.where(high > low, high - low, 1.0) * 0xFFFFFFFF)
    read = low + (high - low) * (whole / 0xFFFFFFFF)
    gaps = np.diff(read[:, 0])
    secants = np.diff(read[:, 1:], axis=0) / gaps[:, np.newaxis]
    before, after = np.append(gaps[0], gaps), np.append(gaps, gaps[-1])
    rising, falling = np.vstack([secants[:1], secants]), np.vstack([secants, secants[-1:]])
    guess = (rising * after[:, np.newaxis] + falling * before[:, np.newaxis]) / (before + after)[
        :, np.newaxis
    ]
    off = (found[:, wide:] - guess) * np.maximum(before, after)[:, np.newaxis]
    most = np.maximum(np.abs(off).max(axis=0), 1e-12)
    return {
        "low": low.tolist(),
        "high": high.tolist(),
        "knots": (whole, "<u4"),
        "most": most.tolist(),
        "slopes": (np.round(off / most * 32767), "<i2"),
    }
