"""Endings of a motion."""

from enum import IntEnum
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from spincyl import _core
from spincyl._contact import table_for_core
from spincyl._phases import Rim
from spincyl._state import State

if TYPE_CHECKING:
    from spincyl._motion import Motion


class Ending(IntEnum):
    """Code of the way in which a motion ended: the status of a `Motion`.

    Attributes
    ----------
    DONE
        The motion reached the last time.
    FACE
        The face landed on the table, at theta = 0 or pi. With a law of friction and ``restitution=0.0`` the
        motion continues on the face. A motion that starts on the face always does.
    SIDE
        The other rim landed at theta = pi/2, another circle at one of `Body.borders`, or another part at
        `theta_end`. A thin disk (ell = 0) has no other rim.
    LIFT_OFF
        The normal force vanished.
    SLIP
        Rolling needed more friction than mu N.
    PAINLEVE
        The law of friction allows no contact force, or more than one.
    STOPS
        The body has come to rest, on its face or in a motion with losses, and dry friction holds it there.
        `Motion.held` is the share of the largest dry friction that this takes.
    LANDING
        The law of friction allows no outcome of a landing on both rims, or more than one.
    BOUNDED
        The computation gave up at a limit of its work or of its precision; `Motion.message` says which.
    """

    DONE = 0
    FACE = 1
    SIDE = 2
    LIFT_OFF = 3
    SLIP = 4
    PAINLEVE = 6
    STOPS = 7
    LANDING = 9
    BOUNDED = 8

    def __str__(self) -> str:
        return self.name


class RestsOn(IntEnum):
    """Part on which a body of revolution lies or stands at the end of a motion: heads, tails, side or edge.

    Attributes
    ----------
    NONE
        The body is not at rest, or the motion ended before the body came to rest.
    FACE
        The first face, at the rim to which the initial state refers, or at the lower end of a body of
        several circles; `Motion.axis_up` is then 1. The code is the same if the motion ended with
        `Ending.FACE`, after which the body still spins or bounces on that face.
    OTHER_FACE
        The face at the other end of the body; `Motion.axis_up` is then -1.
    SIDE
        The side: both rims, any two circles, or a rim and another part of the body.
    EDGE
        A rim, at rest: the body is balanced, or held by dry losses. A ball rests at any inclination.
    """

    NONE = 0
    FACE = 1
    OTHER_FACE = 2
    SIDE = 3
    EDGE = 4

    def __str__(self) -> str:
        return self.name


#: The reason of each ending, and what the body does then.
MESSAGES = {
    Ending.DONE: ("the last time was reached", ""),
    Ending.FACE: ("the face landed on the table", "lies flat"),
    Ending.SIDE: ("the other rim landed", "lies on its side"),
    Ending.LIFT_OFF: ("the normal force vanished", "lifts off"),
    Ending.SLIP: ("rolling needs more friction than mu N", "slips"),
    Ending.PAINLEVE: ("no unique contact force (Painleve)", "jams"),
    Ending.STOPS: ("dry friction holds the whole body", "comes to rest"),
    Ending.BOUNDED: ("the motion was given up", "still moves"),
    Ending.LANDING: ("no unique landing on both rims", "lands on both rims"),
}


#: Estimated error, in natural units, above which `ErrorWarning` is issued.
LARGE_ERROR = 0.1


class ErrorWarning(UserWarning):
    """The estimated error of a motion is too large.

    For a stone, the message gives the time at which the estimated error becomes too large. A body that hops
    multiplies its errors in each impact; a motion to an earlier time has a smaller error.
    `Motion.known_until` is the latest time up to which the error is small enough.
    """


class FixedStep(NamedTuple):
    """Effect of a fixed step of RK4 on a motion, and a step that would suffice.

    Attributes
    ----------
    loss : float
        Predicted fraction of the nutation's amplitude that the step damps.
    advice : float
        Recommended step in sqrt(R/g), for a measured body in seconds. It damps less than a thousandth of the
        amplitude and gives no `StepWarning`.
    coarse : bool
        Whether the step is so large that `StepWarning` was issued.
    """

    loss: float
    advice: float
    coarse: bool


class Event(NamedTuple):
    """The event that ended a motion: its kind, its time, and the state at that time.

    Attributes
    ----------
    ending : Ending
        Kind of the event, which is also the status of the motion.
    time : float
        Time of the event in sqrt(R/g), for a measured body in seconds.
    state : State or EllipsoidState
        State at that time, in natural units.
    rim : str
        Rim to which the state refers: "first" is that of the initial state, "other" the other one. For a
        body of several circles see `Phase.rim`.
    """

    ending: Ending
    time: float
    state: State
    rim: Rim = "first"


class Held(NamedTuple):
    """Share of the largest possible dry friction that holds a body at rest, from 0 to 1.

    Attributes
    ----------
    share : float
        The largest of three ratios, from 0 (nothing has to hold the body) to 1 (it is about to move): for a
        slip tan(slope) over the tangent of `Body.slip_slope`, for tipping tan(slope) over the tangent of
        `Body.tip_slope`, and for rolling the needed couple over the largest couple of the dry losses.
    lets_go : {"slips", "rolls", "tips"}
        What the body does if `share` exceeds 1: the motion that has the largest of the three ratios.
    """

    share: float
    lets_go: Literal["slips", "rolls", "tips"]


#: How a body at rest can begin to move, in the order of the core; and the core's code for each resting part.
_WAYS_OUT: tuple[Literal["slips", "rolls", "tips"], ...] = ("slips", "rolls", "tips")
_POSTURE_OF = {RestsOn.FACE: 0, RestsOn.OTHER_FACE: 0, RestsOn.SIDE: 2, RestsOn.EDGE: 3}


def held(m: "Motion") -> Held | None:
    """The result of `Motion.held`: share of the dry friction that holds a body; None if it is not at rest."""
    own = [law for law in (m.contact, m.losses) if getattr(law, "_function", None) is not None]
    if m.status != Ending.STOPS or m.event is None or m.rests_on == RestsOn.NONE or own or m._asked.turning:
        return None
    slope, phi, laws = m._asked.slope, 0.0, None if m.losses is None else m.losses._built_in
    if slope != 0:
        same = m.t.size > 0 and m.t[-1] == m.event.time
        phi = float((m if same else m.at([m.event.time])).phi[-1])
    body = [float(x) for x in m.body._raw], m.body._rows
    losses = None if laws is None else [float(x) for x in laws._coefficients]
    table = table_for_core(m.contact, m._asked.mu)
    posture, theta = _POSTURE_OF[m.rests_on], m.event.state.theta
    shares = _core.shares_on_slope(body, theta, table, losses, posture, (slope, phi))
    return Held(max(shares), _WAYS_OUT[int(np.argmax(shares))])
