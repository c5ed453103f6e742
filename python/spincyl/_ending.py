"""Endings of a motion."""

from enum import IntEnum
from typing import NamedTuple

from spincyl._state import State


class Ending(IntEnum):
    """How a motion ended: the status of a `Motion`."""

    DONE = 0  #: the last time was reached
    FACE = 1  #: the face landed on the table, theta = 0 or pi
    SIDE = 2  #: the other rim landed, theta = pi/2 (not for a thin disk, ell = 0)
    LIFT_OFF = 3  #: the normal force vanished
    SLIP = 4  #: rolling needed more friction than mu N
    PAINLEVE = 6  #: no contact force, or more than one, obeys the law of friction
    STOPS = 7  #: with losses: the contact point stopped; the body may still spin about the vertical
    LANDING = 9  #: a landing on both rims has no outcome, or more than one, that obeys the law of friction
    BOUNDED = 8  #: given up: slipping and rolling alternate too often, or the motion hardly advances

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
    Ending.STOPS: ("the contact point stops", "rolls no more"),
    Ending.BOUNDED: ("the motion was given up", "goes on"),
    Ending.LANDING: ("no unique landing on both rims", "lands on both rims"),
}


class ErrorWarning(UserWarning):
    """The estimated error of a motion is too large, for a stone from a time before its end on."""


class Event(NamedTuple):
    """The event that ended a motion: its ending, its time, and the state at that time.

    The time is in sqrt(R/g), in seconds for a measured body; the state is in natural units.
    """

    ending: Ending
    time: float
    state: State
