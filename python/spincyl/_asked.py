"""The arguments of `roll`: times, settings and optional outputs, with their checks."""

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

import numpy as np

from spincyl._contact import FACES, AnyContact, Coulomb, code_of, table_for_core
from spincyl._input.numbers import (
    Floats,
    Reals,
    flag,
    floats,
    instance_of,
    is_scalar,
    number,
    one_of,
    reals,
    whole,
)
from spincyl._phases import check_contact, has_friction
from spincyl._restitution import Restitution, coefficient_of, law_for_core
from spincyl._state import State

if TYPE_CHECKING:
    from spincyl._loss import Loss
    from spincyl._table import Table

Method: TypeAlias = Literal["exact", "rk4"]
#: Optional outputs of `roll`.
Want: TypeAlias = Literal["pose", "force"]
WANTS: tuple[Want, ...] = ("pose", "force")
NO_OUTPUTS: frozenset[Want] = frozenset()
_DOUBLE = np.dtype(np.float64)


class Asked(NamedTuple):
    """The checked arguments of `roll`, for one motion or for many; for many, coefficients may be arrays."""

    times: Floats
    t0: float = 0.0
    step: float | None = None
    tol: float | None = None
    method: Method | None = None
    contact: AnyContact = "rolling"
    mu: float = math.inf
    beyond: bool = False
    want: frozenset[Want] = NO_OUTPUTS
    restitution: Restitution | None = None
    losses: "Loss | None" = None
    stop_at: Literal["rolling"] | None = None
    max_nfev: int | None = None
    spread: bool = False  # whether many motions return their states at all times
    errors: bool = True  # whether the errors of many motions that are integrated are estimated
    table: "Table | None" = None
    while_slipping: bool = True  # whether rolling resistance acts while the contact point slips

    @property
    def slope(self) -> float:
        """The slope of the table, in radians."""
        return 0.0 if self.table is None else float(self.table.slope)

    @property
    def turning(self) -> float:
        """The rate at which the table turns, in sqrt(g/R)."""
        return 0.0 if self.table is None else self.table.turning


def options_for_core(
    asked: Asked,
    slip: Sequence[float] | None = None,
    aloft: Sequence[float] | None = None,
    circles: Sequence[Sequence[float]] = (),
) -> dict[str, Any]:
    """Return the arguments of `roll`, for one motion or many, as keyword arguments of the compiled core.

    Arguments with default values are left out: passing them can take longer than a short motion.
    """
    options: dict[str, Any] = {"t0": asked.t0} if asked.t0 else {}
    contact, mu = asked.contact, asked.mu
    if contact != "rolling" or mu != math.inf:
        options["table"], options["coefficients"] = table_for_core(contact, mu, own=True)
        if not isinstance(contact, str) and contact._function is not None:
            options["friction"] = contact._function
        if isinstance(contact, Coulomb) and contact.face != "ring":
            options["face"] = FACES[contact.face]
    if asked.step is not None or asked.tol is not None:
        options |= {"step": asked.step, "tol": asked.tol}
    if asked.want:
        options |= {"pose": "pose" in asked.want, "force": "force" in asked.want}
    if asked.beyond:
        options["beyond"] = True
    if slip is not None:
        options["slip"] = slip
    if aloft is not None:
        options["aloft"] = aloft
    if circles:
        options["circles"] = circles
    if asked.table is not None:
        table = asked.table
        slope, turning, heading, *place = map(float, (table.slope, table.turning, table.phi0, *table.place))
        options |= {"slope": slope, "turning": turning, "heading": heading, "place": place}
    if asked.losses is not None:
        laws, own = asked.losses._built_in, asked.losses._function
        if laws is not None:
            options["losses"] = laws._coefficients
        if own is not None and asked.losses._drives:
            options["drive"] = own
        elif own is not None:
            options["couple"] = own
    if not asked.while_slipping:
        options["while_slipping"] = False
    if asked.restitution is not None:
        options["restitution"] = coefficient_of(asked.restitution)
        if (law := law_for_core(asked.restitution)) is not None:
            options["impact_law"] = law
    if asked.stop_at:
        options["stop_at_rolling"] = True
    if asked.max_nfev is not None:
        options["max_nfev"] = asked.max_nfev
    if asked.spread:
        options["spread"] = True
    if not asked.errors:
        options["errors"] = False
    return options


def times_of(t: Reals) -> Floats:
    """Return times as a one-dimensional array; ValueError for an empty array or one of more dimensions."""
    if type(t) is float:
        return np.array([t])
    if type(t) is np.ndarray and t.dtype is _DOUBLE and t.ndim == 1 and t.size:
        return t.copy()
    times = reals("t", t)
    if np.ndim(times) > 1:
        raise ValueError(f"t: expected a number or a one-dimensional array, not shape {np.shape(times)}")
    found = np.array(floats(times)).reshape(-1)  # a copy, so that the caller's array can change
    if found.size == 0:
        raise ValueError("t: expected at least one time, not an empty array")
    return found


def checked_max_nfev(most: int | None) -> int | None:
    """Return the argument `max_nfev` as an int or None, or raise an error that names it."""
    return most if most is None else whole("max_nfev", most, 1, 2**63 - 1)


def outputs_wanted(want: Want | Iterable[Want]) -> frozenset[Want]:
    try:
        given = [want] if isinstance(want, str) else list(want)
    except TypeError:
        raise TypeError(f"want: expected 'pose', 'force' or both, not {type(want).__name__}") from None
    for name in given:
        one_of("want", name, WANTS)
    return frozenset(given)


def union_of_wants(wants: tuple[Want | Iterable[Want], ...]) -> frozenset[Want]:
    """The set of all outputs that are named in any of several arguments `want` of `roll`."""
    return frozenset().union(*map(outputs_wanted, wants))


def ask(
    state: State,
    t: Reals,
    *,
    t0: float | None,
    step: float | None,
    tol: float | None,
    method: Method | None,
    contact: AnyContact,
    mu: float,
    beyond: bool,
    want: Want | Iterable[Want],
    restitution: Restitution | None,
    losses: "Loss | None",
    max_nfev: int | None,
    table: "Table | None" = None,
) -> Asked:
    """Check the arguments of `roll`, and return them in natural units; an error names the wrong argument."""
    times = times_of(t)
    if t0 is not None:
        t0 = number("t0", t0)
    elif type(t) is float or ((type(t) is not np.ndarray or t.ndim == 0) and is_scalar(t)):
        t0 = 0.0
    else:
        first = times.item(0)
        if times.size == 1 and first != 0 and math.isfinite(first):
            raise ValueError("t: an array of one time needs t0=, the time of the initial state, too")
        t0 = first if math.isfinite(first) else 0.0
    beyond = beyond if beyond is False else flag("beyond", beyond)
    word = isinstance(contact, str)
    if word:
        code_of(contact, rubs=True)
    elif not has_friction(contact):
        raise TypeError(
            "contact: expected 'rolling', 'smooth', sc.Coulomb(mu) or sc.Viscous(c),"
            f" not {type(contact).__name__}"
        )
    if method is not None:
        one_of("method", method, ("exact", "rk4"))
    if step is not None and tol is not None:
        raise ValueError(f"step = {step!r} and tol = {tol!r}: give only one of them")
    if step is not None or tol is not None:
        if method == "exact":
            raise ValueError("method = 'exact': leave out step= and tol=, which this method does not use")
        if method == "rk4" and step is None:
            raise ValueError("method = 'rk4': give step=, the fixed step of RK4; tol= is for another method")
        step = None if step is None else number("step", step)
        tol = None if tol is None else number("tol", tol)
    elif method == "rk4":
        raise ValueError("method = 'rk4': give the step, for example step=1e-3")
    mu = mu if type(mu) is float else number("mu", mu)
    plain = word and state.slip is None and state.height is None and restitution is None and losses is None
    if not plain:  # otherwise no combination of the arguments is invalid
        given = {"step": step, "method": method, "mu": None if mu == np.inf else mu, "beyond": beyond or None}
        given = {name: x for name, x in given.items() if x is not None}
        if losses is not None:
            from spincyl import _lossy

            _lossy.check_losses(losses, times, t0, given)
            _lossy.warn_of_long_arm(losses, contact)
            _lossy.check_resistance(losses, contact)
        check_contact(state, contact, restitution, given)
    # the default `want` is an empty tuple: `outputs_wanted` would take longer than this test
    want = NO_OUTPUTS if type(want) is tuple and not want else outputs_wanted(want)
    # by position, since names would take as long as all checks; a test compares the order
    asked = Asked(times, t0, step, tol, method, contact, mu, beyond, want, restitution, losses)
    if losses is not None and not losses._acts_in_slip:
        asked = asked._replace(while_slipping=False)
    if table is not None:
        asked = on_table(asked, table)
    return asked if max_nfev is None else asked._replace(max_nfev=checked_max_nfev(max_nfev))


def on_table(asked: Asked, table: "Table") -> Asked:
    """Add the table to the arguments; on a slope also request the pose, since phi matters."""
    from spincyl._table import Table

    table = instance_of("table", table, Table)
    for name, x in (("slope", table.slope), ("phi0", table.phi0), ("place", table.place[0])):
        number(name, x)
    if table.slope == 0 and table.turning == 0:
        return asked._replace(table=table)
    for name, value in (("step", asked.step), ("method", asked.method)):
        if value is not None:
            raise ValueError(
                f"{name} = {value!r} cannot be combined with a table that is tilted or turns:"
                " motions on it have variable steps; give tol= instead"
            )
    return asked._replace(table=table, want=asked.want | {"pose"})
