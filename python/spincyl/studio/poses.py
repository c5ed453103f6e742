"""Poses of a motion at a few times, called knots, with cubics between, for programs that interpolate.

Angles and positions are smooth even when a body whirls: a steady spin needs two knots, a nutation four to
eight. Every interval is halved until its cubic agrees with the motion within the tolerance. An exact motion
repeats itself after a period, apart from a rotation about the vertical and one about the axis, so the knots
of one period suffice.

A stone has no axis of symmetry for such angles: its knots hold the four components of a quaternion, which
is normalised after interpolation.

For a body or a stone that leaves the table, the knots also hold the height of the centre, and each kink has
two knots, an instant apart, with the slopes before and after it. Angles refer to the first rim.
"""

from contextlib import suppress
from dataclasses import replace
from functools import singledispatch
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spincyl._asked import Want
from spincyl._contact import Contact, Coulomb, Viscous
from spincyl._ellipsoid import Ellipsoid
from spincyl._input.numbers import Floats
from spincyl._phases import RIMS, has_friction
from spincyl._slip import lever_of_stone
from spincyl._state import State
from spincyl._swing import swing_on
from spincyl.studio.aloft import Aloft, aloft, goes_up, pace_of_stone, parts_of_flight
from spincyl.studio.surface import rotations

if TYPE_CHECKING:
    from spincyl._motion import Motion

_MOST, _LONGEST, _SAMPLES = 200_000, 3000, 65
# largest difference between a slope and its prediction that leaves 2e-4 to the others: see `packed`
_STEEPEST = 8.0
# columns of a stone's quaternion, and of x and y of its centre, which are the same as for a body
_TURN, _PLACE = [0, 1, 2, 5], [3, 4]
#: the column of the height of its centre, if it leaves the table
_HIGH = 6


def span(m: "Motion") -> tuple[float, float]:
    """First and last time of a motion to show, in the direction of the motion.

    Raises
    ------
    ValueError
        If the motion has no duration.
    """
    times, start = m._asked.times, m._asked.t0
    first = start if times.size == 1 else float(times[0])
    last = float(times[-1])
    if m.event is not None and not m._asked.beyond:
        # just before the event, where the model still holds
        last = m.event.time - 1e-9 * (m.event.time - start)
    elif m.t.size < times.size:  # after the landing of a face there are no states
        last = float(m.t[-1]) if m.t.size else first
    if not (last - first) * (times[-1] - start) > 0:
        raise ValueError(
            f"motion: has no duration from t = {first:.6g} on, so there is nothing to show: {m.message}"
        )
    return first, last


def seen(m: "Motion", t: Floats, *names: str) -> list[Floats]:
    """Attributes of the motion, such as "phi" or "contact_force", at times in any order.

    Steps to other times may end the motion a little earlier: its last state then fills the rest.
    """
    times, back = np.unique(t, return_inverse=True)
    backward = -1 if m._asked.times[-1] < m._asked.t0 else 1
    want: tuple[Want, ...] = ("pose", "force") if "contact_force" in names else ("pose",)
    there = m.wanting(*want, t=times[::backward])
    if there.t.size == 0:
        raise ValueError(f"motion: no state to show at t = {times[::backward][0]:.6g}: {there.message}")
    rows = np.minimum(np.arange(times.size), there.t.size - 1)[::backward]
    return [getattr(there, name)[rows][back.reshape(np.shape(t))] for name in names]


def pace(m: "Motion") -> float:
    """Duration of a nutation: the exact period, or with friction the shortest period of any phase.

    With losses, and for a body that leaves the table, it is the mean over the motion, since nutations become
    shorter as a disk falls. For a stone it is roughly the mean duration of its rockings, from the number of
    evaluations.
    """
    if not m._nods:
        return pace_of_stone(m)
    if goes_up(m):
        first, last = span(m)
        many = sum((end - begin) * often for begin, end, often, _ in parts_of_flight(m, first, last))
        return (last - first) / many if many > 0 else np.inf
    if m.losses is not None:
        return _mean_pace(m)
    if not isinstance(m.contact, Coulomb | Viscous):
        return swing_on(m.body, m.start, m.contact).period
    found = [np.inf]
    for phase in m.phases:
        contact: Contact = "rolling" if phase.kind == "rolling" else "smooth"
        with suppress(ValueError):  # where the first integrals lose their digits
            start, rim = replace(phase.state, slip=None), RIMS.index(phase.rim)
            found.append(swing_on(m.body, start, contact, rim).period)
    return min(found)


def _mean_pace(m: "Motion") -> float:
    """The shown time divided by the number of nutations in it."""
    first, last = span(m)
    t = np.linspace(first, last, _SAMPLES)
    theta, w, rims = seen(m, t, "theta", "w", "rim")
    rolls = np.full(t.shape, m.contact != "smooth")
    if has_friction(m.contact):
        rolls = seen(m, t, "phase")[0] == 0
    found = np.zeros(t.shape)
    for k, (tilt, turning, rolling) in enumerate(zip(theta, w, rolls, strict=True)):
        with suppress(ValueError):
            contact: Contact = "rolling" if rolling else "smooth"
            found[k] = 1 / swing_on(m.body, State(tilt, *turning), contact, int(rims[k])).period
    many = float(np.mean(found))
    return 1 / many if many > 0 else np.inf


class Repeat(NamedTuple):
    """How an exact motion repeats after one period: its path is turned and shifted."""

    period: float
    phi: float  #: increase per period
    psi: float  #: increase per period
    turn: complex  #: the centre's path z becomes turn z + shift
    shift: complex


def repeats(m: "Motion") -> Repeat | None:
    """How an exact motion repeats, if it lasts for over a period; ValueError beyond 3000 periods."""
    first, last = sorted(span(m))
    period = pace(m)
    if last - first > _LONGEST * period:
        many = (last - first) / period
        raise ValueError(f"motion: expected at most {_LONGEST} nutations, not {many:.0f}; use a shorter time")
    if m.method != "exact" or not period < last - first:
        return None
    phi, psi, centre = seen(m, np.array([first, first + period]), "phi", "psi", "centre")
    turn = complex(np.exp(1j * (phi[1] - phi[0])))
    before, after = (complex(*place[:2]) for place in centre)
    return Repeat(period, float(phi[1] - phi[0]), float(psi[1] - psi[0]), turn, after - turn * before)


def knots(m: "Motion", tolerance: float = 2e-3, until: float | None = None) -> Floats:
    """Times, poses and slopes from which a page draws the motion.

    Parameters
    ----------
    m : Motion
        The motion, in natural units.
    tolerance : float
        Largest error of an angle (radians) or of the centre (R), tested at three points of each interval.
    until : float, optional
        Last time. Default: the end of the motion.

    Returns
    -------
    ndarray, shape (n, 11)
        Rows with ascending times t: t, theta, phi, psi, and x and y of the centre; then the derivatives of
        these five with respect to t. For a stone (n, 13): t, the quaternion's x, y, z, the centre's x and y,
        the quaternion's w; then the derivatives of these six. For a motion that leaves the table the
        centre's z is the last of these numbers: (n, 13), and (n, 15) for a stone.

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
        share = 1 - (1 - share) ** 3  # a body that comes to rest is fastest at the end
    t = first + (last - first) * share
    up = aloft(m, first, last) if goes_up(m) else None
    t = t if up is None else _first_knots(m, up, first, last)
    open_ = ~_kinks(t, up)
    smallest = 1e-8 * (last - first)
    while True:
        found = _poses(m, t, up)
        left, right = found[:-1][open_], found[1:][open_]
        missed = (_largest_error(m, left, right, up) > tolerance) & (right[:, 0] - left[:, 0] > smallest)
        if not missed.any():
            break
        if len(t) + missed.sum() > _MOST:
            raise ValueError(f"motion: needs more than {_MOST} poses to show; use a shorter time")
        at = np.flatnonzero(open_)[missed] + 1
        t = np.insert(t, at, ((left[:, 0] + right[:, 0]) / 2)[missed])
        still = np.zeros(len(open_), bool)
        still[at - 1] = True
        open_ = np.insert(still, at, True)
    # merge pairs of intervals where one cubic suffices
    while len(found) > 2:
        dropped = np.arange(1, len(found) - 1, 2)
        kinks = _kinks(found[:, 0], up)
        dropped = dropped[~(kinks[dropped - 1] | kinks[dropped])]
        if not dropped.size:
            break
        left, right = found[dropped - 1], found[dropped + 1]
        kept = found[dropped]
        ends = _distance_of_poses(
            m.body, _cubic(left, right, kept[:, 0]), kept[:, 1 : _columns_of_knot(found)]
        )
        fits = np.maximum(ends, _largest_error(m, left, right, up)) < tolerance / 2
        if not fits.any():
            break
        found = np.delete(found, dropped[fits], axis=0)
    return found if up is None else _with_graded_intervals(m, found, up)


def _with_graded_intervals(m: "Motion", found: Floats, up: Aloft) -> Floats:
    """Add knots so that no long interval is next to a very short one in which the body turns, as near a pole.

    Slopes there would be far from the prediction of `packed`, and all other slopes would lose digits.
    """
    for _ in range(50):
        far = np.abs(_slopes(found)[1]).max(axis=1) > _STEEPEST
        if not far.any():
            break
        t = found[:, 0]
        gaps = np.diff(t)
        before, after = np.append(0.0, gaps), np.append(gaps, 0.0)
        split = np.flatnonzero(far) - (before > after)[far]
        split = np.unique(split[~_kinks(t, up)[split]])
        found = _poses(m, np.insert(t, split + 1, t[split] + gaps[split] / 2), up)
    return found


def _first_knots(m: "Motion", up: Aloft, first: float, last: float) -> Floats:
    """First times for knots of a motion with kinks: both sides of kinks, begins of phases, times between."""
    times = [np.array([first, last]), up.edges.ravel(), up.begins]
    for begin, end, often, _ in parts_of_flight(m, first, last):
        count = 4 + int(3 * (end - begin) * often)
        times.append(begin + (end - begin) * np.arange(1, count) / count)
    t: Floats = np.unique(np.concatenate(times))
    inside = (up.edges[:, :1] < t) & (t < up.edges[:, 1:])
    close = np.append(False, np.diff(t) < 1e-7 * (last - first)) & ~np.isin(t, up.edges)
    found: Floats = t[~(inside.any(axis=0) | close)]
    return found


def _kinks(t: Floats, up: Aloft | None) -> np.ndarray:
    """Whether the interval from each of these times to the next one is a kink."""
    return np.zeros(len(t) - 1, bool) if up is None else np.isin(t[:-1], up.edges[:, 0])


def _largest_error(m: "Motion", left: Floats, right: Floats, up: Aloft | None) -> Floats:
    """Largest error of the cubics between these knots, at points that no symmetry of a motion favours."""
    worst = np.zeros(len(left))
    for share in (0.19, 0.46, 0.77):
        t = left[:, 0] + share * (right[:, 0] - left[:, 0])
        worst = np.maximum(worst, _distance_of_poses(m.body, _cubic(left, right, t), _places(m, t, up)))
    return worst


@singledispatch
def _distance_of_poses(body: Any, drawn: Floats, true: Floats) -> Floats:
    """Distance between numbers of drawn and true poses: the largest difference of an angle or a position.

    For a stone also of its contact point, which moves far under a small rotation where the surface is flat.
    """
    apart: Floats = np.abs(drawn - true).max(axis=1)
    return apart


@_distance_of_poses.register
def _(stone: Ellipsoid, drawn: Floats, true: Floats) -> Floats:
    (q, *at), (p, *there) = _stone_of_numbers(stone, drawn), _stone_of_numbers(stone, true)
    places = [np.abs(a - b).max(axis=1) for a, b in zip(at, there, strict=True)]
    places.append(np.abs(drawn[:, _HIGH:] - true[:, _HIGH:]).max(axis=1, initial=0.0))
    found: Floats = np.maximum(2 * np.linalg.norm(q - p, axis=1), np.max(places, axis=0))
    return found


def _stone_of_numbers(stone: Ellipsoid, numbers: Floats) -> tuple[Floats, Floats, Floats]:
    """The quaternion, the centre and the contact point of a stone for the numbers of its poses."""
    q, place = numbers[:, _TURN], numbers[:, _PLACE]
    q = q / np.linalg.norm(q, axis=1, keepdims=True)
    turned = rotations(q)
    arm = np.einsum("nij,nj->ni", turned, lever_of_stone(stone, turned[:, 2]))
    return q, place, place + arm[:, :2]


def _places(m: "Motion", t: Floats, up: Aloft | None) -> Floats:
    """The numbers of poses along a last axis, in the order of `knots`."""
    if not m._nods:
        turn, centre = seen(m, t, "orientation", "centre")
        high = centre[..., 2:] if up is not None else centre[..., :0]
        return np.concatenate([turn[..., :3], centre[..., :2], turn[..., 3:], high], -1)
    theta, phi, psi, centre = seen(m, t, "theta", "phi", "psi", "centre")
    if up is not None:
        return np.concatenate([up.from_first(t, theta, phi, psi), centre], -1)
    found: Floats = np.stack([theta, phi, psi, centre[..., 0], centre[..., 1]], -1)
    return found


def _poses(m: "Motion", t: Floats, up: Aloft | None) -> Floats:
    """Rows of `knots` at ascending times; slopes are differences over a thousandth of the interval."""
    kinks = _kinks(t, up)
    gaps = np.where(kinks, np.inf, np.diff(t))
    h = 1e-3 * np.minimum(np.append(gaps, gaps[-1]), np.append(gaps[0], gaps))
    around = np.clip(np.stack([t - h, t, t + h], -1), t[0], t[-1])
    # next to a kink only on the knot's own side
    around[1:, 0][kinks], around[:-1, 2][kinks] = t[1:][kinks], t[:-1][kinks]
    y = _places(m, around, up)
    slopes = (y[:, 2] - y[:, 0]) / (around[:, 2] - around[:, 0])[:, np.newaxis]
    return np.column_stack([t, y[:, 1], slopes])


def _columns_of_knot(found: Floats) -> int:
    """Number of columns of a knot before the slopes: its time, and the numbers of its pose."""
    return int(found.shape[1] + 1) // 2


def _cubic(left: Floats, right: Floats, t: Floats) -> Floats:
    """The numbers of a pose at t between two knots, interpolated as on the page."""
    wide = _columns_of_knot(left)
    h = (right[:, 0] - left[:, 0])[:, np.newaxis]
    s = (t[:, np.newaxis] - left[:, :1]) / h
    y0, y1, d0, d1 = left[:, 1:wide], right[:, 1:wide], h * left[:, wide:], h * right[:, wide:]
    cubic: Floats = y0 + s * (d0 + s * (3 * (y1 - y0) - 2 * d0 - d1 + s * (2 * (y0 - y1) + d0 + d1)))
    return cubic


def packed(found: Floats) -> dict[str, Any]:
    """Knots in few bytes: values as integers between bounds, slopes as differences from a prediction.

    The prediction is the slope of the parabola through a knot and its neighbours. The difference is
    multiplied by the longer of the adjacent intervals, in which its error has the largest effect.
    """
    (low, high, whole), off = _slopes(found)
    most = np.maximum(np.abs(off).max(axis=0), 1e-12)
    return {
        "low": low.tolist(),
        "high": high.tolist(),
        "knots": (whole, "<u4"),
        "most": most.tolist(),
        "slopes": (np.round(off / most * 32767), "<i2"),
    }


def _slopes(found: Floats) -> tuple[tuple[Floats, Floats, Floats], Floats]:
    """Bounds and integers of the values of knots, and the scaled differences of their slopes."""
    wide = _columns_of_knot(found)
    low, high = found[:, :wide].min(axis=0), found[:, :wide].max(axis=0)
    # the values that the page will read, to which the slopes have to fit
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
    return (low, high, whole), off
