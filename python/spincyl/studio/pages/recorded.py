"""Data of recorded motions for a page: poses, forces, impacts, and notes on times without a motion."""

from typing import Any

import numpy as np

from spincyl._ending import Ending
from spincyl._motion import Motion
from spincyl._phases import has_friction
from spincyl._scale import Scale
from spincyl.studio.aloft import goes_up, strikes
from spincyl.studio.look import SLOW, Look
from spincyl.studio.pages.few import base64
from spincyl.studio.pages.slip import rubbing
from spincyl.studio.pages.stone import numbers
from spincyl.studio.poses import knots, packed, repeats, seen, span

#: Impacts with less than this share of the largest impulse are not heard.
_FAINT = 1e-3


def shown(m: Motion, slips: bool) -> tuple[dict[str, Any], float]:
    """The data of a motion for the page, and the largest number of turns per unit of time.

    A body whose face lands turns the faster the flatter it lies: the last tenth of its time does not count.
    """
    first, last = sorted(span(m))
    again = repeats(m)
    found = knots(m) if again is None else knots(m, until=first + again.period)
    data: dict[str, Any] = {"first": first, "last": last, "again": None}
    if again is not None:
        # the centre's path is rotated about a pivot, or shifted
        pivot = again.shift / (1 - again.turn) if abs(1 - again.turn) > 1e-9 else None
        data["again"] = {
            "period": again.period,
            "phi": again.phi,
            "psi": again.psi,
            "pivot": pivot and [pivot.real, pivot.imag],
            "shift": [again.shift.real, again.shift.imag],
        }
    data |= numbers(m, found[:, 0]) | _hits(m)
    packets = (packed(found) | (rubbing(m) if slips else {})).items()
    data |= {name: base64(*x) if isinstance(x, tuple) else x for name, x in packets}
    whirrs = m.event is not None and m.event.ending == Ending.FACE
    counts = found[:, 0] <= first + (0.9 if whirrs else 1.0) * (last - first)
    fastest = float(np.abs(found[counts, 6:9]).max())
    if not m._nods or m.body.fillet == 1 or goes_up(m):
        # near a pole phi' and psi' are large and nearly cancel: use the angular velocity instead
        (w,) = seen(m, found[:, 0], "w")
        fastest = float(np.linalg.norm(w, axis=1).max())
    return data, fastest / (2 * np.pi)


def _hits(m: Motion) -> dict[str, Any]:
    """Times and impulses of the impacts that are heard, for the sound of the page."""
    struck = strikes(m) if goes_up(m) else ()
    rows = np.reshape([[x.time, np.linalg.norm(x.impulse)] for x in struck], (-1, 2))
    loud = rows[rows[:, 1] > _FAINT * rows[:, 1].max(initial=0.0)]
    return {"hits": base64(loud, "<f4")} if loud.size else {}


def slips_or_flies(m: Motion) -> bool:
    """Whether the page shows slip and contact forces."""
    return has_friction(m.contact) or goes_up(m)


def turns(look: Look) -> str:
    """Number of turns of the first exposure of a page, as text for the page."""
    many = look.exposure or 0.0
    return "Infinity" if np.isinf(many) else f"{many:g}"


def edges(m: Motion) -> dict[str, Any]:
    """The page's notes at times before and after the motion shown, and at its end."""
    start, last = span(m)
    first, until = sorted((start, last))
    found = {
        "before": {"said": "shown from ", "at": first, "t": first, "event": False},
        "after": {"said": "shown until ", "at": until, "t": until, "event": False},
    }
    if m.event is not None:
        # `at` is the time from which the page shows the note, `t` the time in its text
        beyond = m._asked.beyond and abs(m.event.time - start) < abs(last - start)
        said = ("beyond the model: " if beyond else "ended: ") + m.message.split(" at t =")[0] + ", "
        at = m.event.time if beyond else last
        found["before" if last < start else "after"] = {
            "said": said,
            "at": at,
            "t": m.event.time,
            "event": True,
        }
    return found


def slow_motion(turning: float, scale: Scale | None) -> int:
    """The factor of slow motion with which no body turns much faster than once a second."""
    second = 1.0 if scale is None else float(scale.seconds(1.0))
    return next((x for x in SLOW if turning / second <= 1.5 * x), SLOW[-1])
