"""What `roll` is asked for: times, settings, and what is wanted at each time."""

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

import numpy as np

from spincyl._contact import AnyContact, code
from spincyl._input.numbers import Floats, Reals, flag, floats, is_scalar, number, one_of, reals
from spincyl._phases import check, rubs
from spincyl._state import State

if TYPE_CHECKING:
    from spincyl._loss import Loss

Method: TypeAlias = Literal["exact", "rk4"]
#: What is computed if it is wanted.
Want: TypeAlias = Literal["pose", "force"]
WANTS: tuple[Want, ...] = ("pose", "force")
_DOUBLE = np.dtype(np.float64)


class Asked(NamedTuple):
    """What `roll` was asked for."""

    times: Floats
    t0: float
    step: float | None
    tol: float | None
    method: Method | None
    contact: AnyContact
    mu: float
    beyond: bool
    want: frozenset[Want]
    restitution: float | None
    losses: "Loss | None"


def times_of(t: Reals) -> Floats:
    """Times as an array of one dimension, not empty."""
    if type(t) is float:
        return np.array([t])
    if type(t) is np.ndarray and t.dtype is _DOUBLE and t.ndim == 1 and t.size:
        return t.copy()
    times = reals("t", t)
    if np.ndim(times) > 1:
        raise ValueError(f"t: expected a number or one dimension, not shape {np.shape(times)}")
    found = np.array(floats(times)).reshape(-1)  # a copy, which the caller does not change
    if found.size == 0:
        raise ValueError("t: expected at least one time")
    return found


def choices(want: Want | Iterable[Want]) -> frozenset[Want]:
    if type(want) is tuple and not want:
        return frozenset()
    try:
        given = [want] if isinstance(want, str) else list(want)
    except TypeError:
        raise TypeError(f"want: expected 'pose', 'force' or both, not {type(want).__name__}") from None
    for name in given:
        one_of("want", name, WANTS)
    return frozenset(given)


def chosen(wants: tuple[Want | Iterable[Want], ...]) -> frozenset[Want]:
    """All that several arguments want, each of them as `roll` takes it."""
    return frozenset().union(*map(choices, wants))


def ask(
    state: State,
    t: Reals,
    t0: float | None,
    step: float | None,
    tol: float | None,
    method: Method | None,
    contact: AnyContact,
    mu: float,
    beyond: bool,
    want: Want | Iterable[Want],
    restitution: float | None,
    losses: "Loss | None",
) -> Asked:
    """What `roll` is asked for, in natural units, or an error by name."""
    times = times_of(t)
    if t0 is not None:
        t0 = number("t0", t0)
    elif type(t) is float or ((type(t) is not np.ndarray or t.ndim == 0) and is_scalar(t)):
        t0 = 0.0
    else:
        first = times.item(0)
        if times.size == 1 and first != 0 and math.isfinite(first):
            raise ValueError(
                "t: the only time of an array would be that of the start; give it as a number, or t0=0"
            )
        t0 = first if math.isfinite(first) else 0.0
    beyond = beyond if beyond is False else flag("beyond", beyond)
    if isinstance(contact, str):
        code(contact, rubs=True)
    elif not rubs(contact):
        raise TypeError(
            "contact: expected 'rolling', 'smooth', sc.Coulomb(mu) or sc.Viscous(c),"
            f" not {type(contact).__name__}"
        )
    if method is not None:
        one_of("method", method, ("exact", "rk4"))
    if step is not None and tol is not None:
        raise ValueError(f"step = {step!r} and tol = {tol!r}: give one of them")
    if method == "rk4" and step is None and tol is None:
        raise ValueError("method = 'rk4' needs step= or tol=, as in step=1e-3")
    if method == "exact" and (step is not None or tol is not None):
        raise ValueError("method = 'exact' takes neither step= nor tol=")
    step = None if step is None else number("step", step)
    tol = None if tol is None else number("tol", tol)
    mu = number("mu", mu)
    plain = isinstance(contact, str) and state.slip is None and restitution is None and losses is None
    if not plain:  # of the others there is something to refuse
        given = {"step": step, "method": method, "mu": None if mu == np.inf else mu, "beyond": beyond or None}
        given = {name: x for name, x in given.items() if x is not None}
        if losses is not None:
            from spincyl import _lossy

            _lossy.check(losses, times, t0, given)
        check(state, contact, restitution, given)
    want = choices(want)
    return Asked(times, t0, step, tol, method, contact, mu, beyond, want, restitution, losses)
