"""How a motion ends."""

from enum import IntEnum
from typing import NamedTuple

from spincyl._state import State


class Ending(IntEnum):
    """How a motion ended: the status of a `Motion`."""

    DONE = 0  #: it reached the last time asked for
    FACE = 1  #: the face landed on the table, theta = 0 or pi
    SIDE = 2  #: the other rim landed, theta = pi/2 (not of a coin, ell = 0)
    LIFT_OFF = 3  #: the normal force vanished
    SLIP = 4  #: rolling needed more friction than mu N
    PAINLEVE = 6  #: no contact force, or more than one, obeys the law of friction
    STOPS = 7  #: with losses: the contact point stops; the body may still spin about the vertical
    LANDING = 9  #: a landing on both rims has no outcome, or more than one, that obeys the law of friction
    BOUNDED = 8  #: given up: it slips and rolls by turns too often, or hardly advances; the result ends there

    def __str__(self) -> str:
        return self.name


#: Why the motion ended, and what the body does then.
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
    """A motion is known only up to a time before its end: then its estimated error is too large."""


class Event(NamedTuple):
    """Where a motion left what the model covers."""

    ending: Ending
    time: float
    state: State
