"""Motions in words: how they ended, how they were computed, and how large the errors are."""

from typing import TYPE_CHECKING

import numpy as np

from spincyl._contact import Coulomb
from spincyl._ending import MESSAGES, Ending
from spincyl._phases import has_two_rims, methods_in_words, phases_in_words

if TYPE_CHECKING:
    from spincyl._motion import Motion


def message(m: "Motion") -> str:
    """Text about a motion: how it ended, how it was computed, and its estimated errors."""
    why = MESSAGES[m.status][0]
    if m._limit is not None:
        why += f", since {m._limit[1]}"
    elif m.status == Ending.SIDE and not has_two_rims(m.body):
        why = "another part landed"
    elif m.status == Ending.SIDE and _number_of_phases(m) == 0 and m.event and m.event.state.w2 == 0:
        why = "the other rim does not rise"
    if m.event:
        time = f"{m.event.time:.{_digits(m.event.time, m.error)}g}{_unit_of_times(m)}"
        why += f": the body {end_in_words(m)} at t = {time}"
        if m.status == Ending.SIDE and m.event.time == m._asked.t0 and m._asked.restitution is None:
            why += "; with restitution=0.0 the motion continues"
    pose = "" if np.isnan(m.pose_error) else f", of the pose {m.pose_error:.1e}"
    force = "" if np.isnan(m.force_error) else f", of the forces {m.force_error:.1e}"
    errors = f"error about {m.error:.1e}{pose}{force}"
    if m.t.size < m._asked.times.size > 1:
        errors += f"; {m.t.size} of {m._asked.times.size} times reached: plot against m.t"
    if m._by_steps or m._phases is not None:
        phases = "" if m._phases is None else phases_in_words(m.phases, _unit_of_times(m))
        return "; ".join(
            filter(None, (why, phases, _method_in_words(m), errors, m._doubt, _near_toppling(m)))
        )
    return f"{why}; found {_method_in_words(m)}, {errors}"


def _near_toppling(m: "Motion") -> str:
    """Text that a body on its face topples, or nearly topples, as it slides; empty for other bodies."""
    stands = m._phases is not None and any(phase.kind == "on its face" for phase in m.phases)
    if not stands or not isinstance(m.contact, Coulomb):
        return ""
    theta = next(phase.state.theta for phase in m.phases if phase.kind == "on its face")
    ratio = "radius of the face over height of the centre"
    if m.body.topples(m.contact.mu, theta):
        return f"mu exceeds {ratio}: without its spin the body topples, and a real one may chatter"
    near = m.body.topples(m.contact.mu / 0.9, theta)
    return f"close to toppling: mu exceeds 0.9 times {ratio}" if near else ""


def given_up(m: "Motion") -> str:
    """Text that says at which time and at which limit the computation of a motion stopped."""
    at = f"t = {m.event.time:.6g}{_unit_of_times(m)}" if m.event else "its start"
    name, why = m._limit or ("", "")
    more = "; max_nfev= allows more" if name == "evaluations" else ""
    phases = f" and {_number_of_phases(m)} phases" if _number_of_phases(m) else ""
    return f"given up at {at} after {m.nfev} evaluations{phases}, since {why}{more}; the motion ends there"


def _number_of_phases(m: "Motion") -> int | None:
    """The number of phases; None for a motion that is not divided into phases."""
    return None if m._phases is None else len(m._phases)


def _digits(time: float, error: float) -> int:
    """Number of digits of a time that are within its error, and one more; from 2 to 12."""
    if not 0 < error < np.inf or time == 0:
        return 12
    return int(np.clip(2 + np.floor(np.log10(abs(time) / error)), 2, 12))


def end_in_words(m: "Motion") -> str:
    """The behaviour of the body at the end of the motion, in a word or two, such as "slips"."""
    if m.status == Ending.SIDE and not has_two_rims(m.body):
        return "lands on another part"
    if m.status == Ending.SIDE and m.body.ell < 1:
        return "stands on its edge"
    return MESSAGES[m.status][1]


def _unit_of_times(m: "Motion") -> str:
    """Text to append to a time of the motion: " s" for a measured body, else empty."""
    return "" if m.scale is None else " s"


def _method_in_words(m: "Motion") -> str:
    if m._by_steps:
        return f"found in steps with tolerance {m._setting:g}"
    if m._phases is not None:
        return methods_in_words(m.phases, m._setting)
    how = {
        "exact": "by first integrals",
        "rk4": f"by RK4, step {m._asked.step!r}{_unit_of_times(m)}",
        "dop853": f"in steps of eighth order with tolerance {m._setting:g}",
    }[m.method]
    free = m._asked.step is None and m._asked.tol is None
    if free and m.method != "exact":
        how += ", since the first integrals lose all their digits here"
    return how
