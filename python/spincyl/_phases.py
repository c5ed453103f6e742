"""Phases (slipping, rolling, flying, lying) and impacts of a motion with friction or restitution."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias, get_args

import numpy as np

from spincyl import _core
from spincyl._circles import lowest_point_of
from spincyl._contact import AnyContact, Coulomb, Viscous
from spincyl._input.numbers import Floats
from spincyl._restitution import check_restitution
from spincyl._slip import told_of_lowest
from spincyl._state import State, numbers_without_slip, refuse_state_in_air, state_without_checks

if TYPE_CHECKING:
    from spincyl._body import Body

Kind: TypeAlias = Literal[
    "rolling",
    "slipping",
    "flying",
    "lying",
    "pivoting",
    "rolling on its side",
    "rolling round its apex",
    "on its face",
]
#: Kind of phase for each code in `Motion.phase`.
KINDS: tuple[Kind, ...] = get_args(Kind)
Hit: TypeAlias = Literal["slips", "sticks", "slips on", "smooth", "both rims", "creeps", "turns back"]
#: Behaviour of the contact point in an impact, for each code of the core.
HITS: tuple[Hit, ...] = get_args(Hit)


Rim: TypeAlias = Literal["first", "other", "third", "fourth", "fifth", "sixth", "seventh", "eighth"]
#: Name of the rim to which theta refers, for each code in `Motion.rim`.
RIMS: tuple[Rim, ...] = get_args(Rim)


class Phase(NamedTuple):
    """A phase of a motion, such as slipping or rolling: the time, kind and state with which it begins.

    Attributes
    ----------
    time : float
        Time at which the phase begins, in sqrt(R/g), for a measured body in seconds.
    kind : str
        "rolling", "slipping" or "flying". For a body on both rims, or on two circles: "lying" (both slip),
        "pivoting" (one slips), "rolling on its side", or "rolling round its apex" (the point where its axis
        meets the table, if the circles have unequal radii). "on its face": it stands, slides or spins on it.
    state : State or EllipsoidState
        State at that time, with its slip, in natural units; in the air also with its `height` and `lift`.
        A motion that starts from it continues this one.
    rim : str
        Rim to which the state refers: "first" is that of the initial state, "other" the other one. For a
        body of several circles, the circle on which the body stands: "first" is the lowest one of
        `Body.circles`, "other" the next one, then "third" and so on.
    """

    time: float
    kind: Kind
    state: State
    rim: Rim = "first"

    def __repr__(self) -> str:
        return f"({self.time:.12g}, {self.kind!r})"


class Impact(NamedTuple):
    """An impact of a rim, or of a stone, on the table.

    Both states are in natural units. For a measured body, time, impulse and energy are in SI; without a mass,
    impulse and energy stay in natural units.

    Attributes
    ----------
    time : float
        Time in sqrt(R/g) or s.
    rim : str
        Rim that lands: "first" is the rim to which theta of the initial state refers, "other" the other rim.
        For a body of several circles see `Phase.rim`. For a stone always "first".
    kind : str
        What the contact point does during the impact. "slips": it slips to the end. "sticks": it stops.
        "slips on": it stops, then slips again. "smooth": there is no friction. "both rims": the other rim
        lands without a bounce, and both rims touch the table. "creeps": where a contact point would stick,
        a patch of contact that drills slips slowly. "turns back": tangential restitution reverses the slip
        of a ball.
    impulse : tuple of float
        Impulse of the table on the body along e_h, along e2 and upward, in M sqrt(g R) or N s; if both rims
        touch the table, the sum of their impulses. For a stone along x, y and z of the laboratory, as
        `Motion.contact_force`.
    lost : float
        Energy lost in the impact, in M g R or J; with `stays` also that of the bounces that are summed.
        Negative for an impact that has gained energy, as it may under the law `Newton`.
    before : State or EllipsoidState
        State before the impact, with its slip and `lift` < 0. Its theta refers to the rim that lands; for a
        body of several circles always to its lower end.
    after : State or EllipsoidState
        State after the impact.
    stays : bool
        Whether the impact ends a sequence of ever smaller bounces, after which the rim stays on the table.
    couple : float
        Impulse of the couple of a patch of contact about the vertical, in M R sqrt(g R) or N m s; 0 without
        a patch.
    """

    time: float
    rim: Rim
    kind: Hit
    impulse: tuple[float, float, float]
    lost: float
    before: State
    after: State
    stays: bool
    couple: float = 0.0

    @property
    def gained(self) -> float:
        """Energy gained in the impact, in M g R or J: 0 under Stronge's law."""
        return max(-self.lost, 0.0)


#: Columns of the lost energy, of the impulse and of its couple in the rows of impacts.
LOST_COLUMN, IMPULSE_COLUMNS, COUPLE_COLUMN = 4, slice(5, 8), 8


def state_of_phase(
    four: Sequence[float], slip: Sequence[float] | None, aloft: Sequence[float] | None = None
) -> State:
    """The state with theta, w1, w2, w3; if given, with the slip along e_h and e2, and height and lift."""
    height, lift = aloft or (None, None)
    return state_without_checks(four, None if slip is None else (slip[0], slip[1]), height, lift)


def impacts(rows: Floats, state: Callable[..., Any] = state_of_phase) -> tuple[Impact, ...]:
    """Make impacts from the rows of the core, each with the numbers of one impact.

    `state` makes a state from numbers, slip and height. The numbers of both states come last in a row, each
    with the velocity of the lowest point.
    """
    found = []
    for time, other, hit, stays, lost, along, across, up, couple, *numbers in rows.tolist():
        half = len(numbers) // 2
        before, after = (state(at[:-3], at[-3:-1], (0.0, at[-1])) for at in (numbers[:half], numbers[half:]))
        rim, kind, push = RIMS[int(other)], HITS[int(hit)], (along, across, up)
        found.append(Impact(time, rim, kind, push, lost, before, after, bool(stays), couple))
    return tuple(found)


def has_friction(contact: object) -> bool:
    """Whether a contact has a law of friction."""
    return isinstance(contact, Coulomb | Viscous)


def check_contact(state: State, contact: AnyContact, restitution: object, settings: dict[str, Any]) -> None:
    """Raise ValueError for arguments that the contact excludes, such as a slip without friction.

    `settings` are the settings of rolling that were given, by name.
    """
    if restitution is None:
        refuse_state_in_air(state, "give restitution=, the coefficient of restitution of impacts, 0 to 1")
    else:
        check_restitution(restitution)
    if not isinstance(contact, Coulomb | Viscous):
        if state.slip is not None and (restitution is None or state.height is None):
            numbers_without_slip(
                state, f"contact={contact!r} has no law of friction; give contact=sc.Coulomb(mu)"
            )
        if restitution is None:
            return
        for name in filter(settings.__contains__, ("step", "method", "beyond")):
            raise ValueError(
                f"{name} = {settings[name]!r} cannot be combined with restitution=: {_WHY[name]}"
            )
        return
    for name, value in settings.items():
        raise ValueError(f"{name} = {value!r} cannot be combined with contact={contact!r}: {_WHY[name]}")


_WHY = {
    "step": "slipping is integrated with variable steps; give tol= instead",
    "method": "slipping has steps of eighth order, and rolling is exact; leave it out",
    "mu": "give the coefficient to the contact, as in contact=sc.Coulomb(0.3)",
    "beyond": "the solution cannot continue past the end of such a motion",
}


def phases(rows: Floats, state: Callable[..., Any] = state_of_phase) -> tuple[Phase, ...]:
    """Make phases from the rows of the core; `state` makes a state from numbers, slip and height."""
    found = []
    for time, code, rim, along, across, height, lift, *numbers in rows.tolist():
        kind = KINDS[int(code)]
        at = state(numbers, (along, across), (height, lift) if kind == "flying" else None)
        found.append(Phase(time, kind, at, RIMS[int(rim)]))
    return tuple(found)


def told_phases(body: "Body", found: Sequence[Phase]) -> tuple[Phase, ...]:
    """The phases of a body of several circles; a state in the air refers to the lowest circle."""
    told = list(found)
    for i, (time, kind, state, rim) in enumerate(found):
        if kind == "flying":
            state = told_of_lowest(body, state, RIMS.index(rim), True)
            told[i] = Phase(time, kind, state, RIMS[int((body._borders < state.theta).sum())])
    return tuple(told)


def phases_in_words(phases: Sequence[Phase], unit: str = "") -> str:
    """Phases in words, "slipping from t = 0, rolling from t = 28.3"; if many, the first two and the last."""
    words = [f"{phase.kind} from t = {phase.time:.6g}{unit}" for phase in phases]
    if len(words) > 4:
        words[2:-1] = [f"... ({len(words)} phases)"]
    return ", ".join(words)


def methods_in_words(phases: Sequence[Phase], within: float) -> str:
    """The methods that computed the phases, in words, with the tolerance `within` of each step."""
    how = {
        "slipping": f"slipping in steps with tolerance {within:g}",
        "rolling": "rolling by first integrals",
        "flying": "flight in closed form",
        "on its face": f"sliding on its face in steps with tolerance {within:g}",
    }
    kinds = {"slipping" if phase.kind in ("lying", "pivoting") else phase.kind for phase in phases}
    return ", ".join(text for kind, text in how.items() if kind in kinds)


def slipping_time(phases: Sequence[Phase], end: float) -> float:
    """Total duration of the phases of slipping, up to the time `end`."""
    begins = np.array([phase.time for phase in phases] + [end])
    slips = np.array([phase.kind in ("slipping", "lying", "pivoting") for phase in phases], bool)
    return float(np.abs(np.diff(begins))[slips].sum())


def has_two_rims(body: "Body") -> bool:
    """Whether the body has two equal rims."""
    return body.rims is None and bool(_core.two_rims(*body._numbers) == 1)


def lowest_point_height(body: "Body", theta: Floats, rim: Floats, told: Any) -> Floats:
    """(n,) height of the lowest point of a body, from that of one rim; in flight another rim may be lower.

    A height that is negative by rounding is 0; any other negative height is returned unchanged.
    """
    if body.rims is not None:
        lower = lowest_point_of(body, theta, told)
    else:
        lower = _core.lower_rim(theta, *body._numbers)
    found: Floats = rim + lower
    rounded = 16 * np.finfo(float).eps * (1 + np.abs(rim) + np.abs(lower))
    return np.where((found < 0) & (found >= -rounded), 0.0, found)
