"""Phases of a motion with friction: slipping, then rolling, and perhaps slipping again."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np

from spincyl._contact import AnyContact, Coulomb, Viscous
from spincyl._input.numbers import number
from spincyl._state import State, gripping

Kind: TypeAlias = Literal["rolling", "slipping"]
#: Kind of phase for each code in `Motion.phase`.
KINDS: tuple[Kind, ...] = ("rolling", "slipping")


class Phase(NamedTuple):
    """A part of a motion in which the body does one thing, told by its begin."""

    time: float  #: when it begins
    kind: Kind  #: "slipping" or "rolling"
    state: State  #: where it begins, with the slip

    def __repr__(self) -> str:
        return f"({self.time:.12g}, {self.kind!r})"


def rubs(contact: object) -> bool:
    """Whether a contact has a law of friction."""
    return isinstance(contact, Coulomb | Viscous)


def check(state: State, contact: AnyContact, restitution: object, settings: dict[str, Any]) -> None:
    """Refuse arguments that the contact excludes: a slip without friction, settings of other methods.

    `settings` are the settings of rolling that were given, by name.
    """
    if not isinstance(contact, Coulomb | Viscous):
        gripping(state, f"contact={contact!r} has no law for that; give contact=sc.Coulomb(mu)")
        if restitution is not None:
            raise ValueError(f"restitution = {restitution!r}: goes with contact=sc.Coulomb(mu) alone")
        return
    for name, value in settings.items():
        raise ValueError(f"{name} = {value!r} does not go with contact={contact!r}: {_WHY[name]}")
    if restitution is not None and number("restitution", restitution) != 0:
        raise ValueError(
            f"restitution = {restitution!r}: expected None (the motion ends where the other rim lands)"
            " or 0.0 (it lands without a bounce)"
        )


_WHY = {
    "step": "slipping has steps of its own, tol= is their error",
    "method": "slipping has one of its own, and phases that roll are exact",
    "mu": "the contact has the coefficient, as in contact=sc.Coulomb(0.3)",
    "beyond": "there is nothing beyond an end",
}


def slipping(four: Sequence[float], slip: Sequence[float] | None) -> State:
    """The state of theta, w1, w2, w3 and of the slip along and across the lean; None: without a slip."""
    return State(*four, slip=None if slip is None else (slip[0], slip[1]))


def phases(
    found: Iterable[tuple[float, int, Sequence[float], Sequence[float]]], state: Callable[..., Any] = slipping
) -> tuple[Phase, ...]:
    """Phases from the numbers of the core; `state` makes a state of numbers and slip."""
    return tuple(Phase(time, KINDS[kind], state(numbers, slip)) for time, kind, numbers, slip in found)


def told(phases: Sequence[Phase], unit: str = "") -> str:
    """Phases in words, "slipping from t = 0, rolling from t = 28.3"; of many, the first two and the last."""
    words = [f"{phase.kind} from t = {phase.time:.6g}{unit}" for phase in phases]
    if len(words) > 4:
        words[2:-1] = [f"... ({len(words)} phases)"]
    return ", ".join(words)


def how_found(phases: Sequence[Phase], within: float) -> str:
    """The methods that computed the phases, in words."""
    how = {"slipping": f"slip found by steps within {within:g}", "rolling": "rolling by first integrals"}
    kinds = {phase.kind for phase in phases}
    return ", ".join(text for kind, text in how.items() if kind in kinds)


def duration(phases: Sequence[Phase], end: float) -> float:
    """Total time of slipping up to the time `end`."""
    begins = np.array([phase.time for phase in phases] + [end])
    slips = np.array([phase.kind == "slipping" for phase in phases], bool)
    return float(np.abs(np.diff(begins))[slips].sum())
