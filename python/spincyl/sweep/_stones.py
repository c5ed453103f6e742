"""Many stones at once: their endings, their hops, and the reversals of their spin."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from spincyl import _core
from spincyl._asked import Asked, checked_max_nfev
from spincyl._contact import AnyContact, Coulomb, Viscous, check_contact_scale, code_of
from spincyl._ellipsoid import Ellipsoid
from spincyl._ellipsoid_state import EllipsoidState
from spincyl._ending import ErrorWarning
from spincyl._input.numbers import (
    Floats,
    Reals,
    components,
    in_range,
    instance_of,
    known_words,
    number,
    si,
    warn,
)
from spincyl._input.progress import Progress
from spincyl._loss import LAWS, Loss
from spincyl._lossy import losses_of_stone, warn_of_long_arm
from spincyl._measured import natural_time
from spincyl._restitution import Restitution, check_restitution
from spincyl._state import refuse_state_in_air
from spincyl._table import Table
from spincyl.sweep._common import in_memory
from spincyl.sweep._inputs import kept_contact, kept_stones, kept_table
from spincyl.sweep._labels import given_up
from spincyl.sweep._swept import Question

#: Units and meanings of the columns of a motion; the state at its end comes first.
LABELS = {name: (unit, meaning) for name, unit, meaning in _core.stone_columns()}
_FINAL = ("n1", "n2", "n3", "w1", "w2", "w3")
_TOLD = tuple(name for name in LABELS if name not in _FINAL)
#: The columns of a stone that may leave the table.
_HOPS = ("impacts", "landings", "air_time", "lost_in_impacts", "last_phase")


def question(
    stones: Ellipsoid,
    states: object,
    t: Reals,
    *,
    want: str | Iterable[str] | None,
    contact: AnyContact,
    tol: float,
    mu: float,
    restitution: Restitution | None,
    losses: Loss | None,
    max_nfev: int | None,
    table: Table | None,
) -> Question:
    """The arguments of `spincyl.sweep.roll` for stones, checked; an error names the argument."""
    states, scale, seconds = instance_of("states", states, EllipsoidState), stones.scale, t
    if scale is not None:
        check_contact_scale(contact, scale)
        seconds = si("t", t, "second")
        t = natural_time("t", t, scale)
    end = in_range("t", number("t", t), 0.0, 1e15, "sqrt(a/g), from 0 on")
    default = ("spin", "reversals", "first_reversal")
    known = [name for name in _TOLD if restitution is not None or name not in _HOPS]
    needs = dict.fromkeys(_HOPS, "; this output needs restitution=")
    given = default if want is None else want
    wanted = known_words("want", given, ("final", *known), lambda name: needs.get(name, ""))
    if restitution is None:
        refuse_state_in_air(states, "give restitution=, the coefficient of restitution, 0 to 1")
    else:
        check_restitution(restitution)
    if not isinstance(contact, Coulomb | Viscous):
        code_of(contact, rubs=True)
        if states._slips and states.height is None:
            why = f"contact={contact!r} has no law of friction; give contact=sc.Coulomb(mu)"
            raise ValueError(f"states: the stones slip, and {why}")
    names = [name for name in _TOLD if name in (*wanted, "error", "known_until")]
    names += [*(_FINAL if "final" in wanted else ()), "status"]
    slip = ("slip_x", "slip_y")
    fields = dict(zip(_core.stone_names(), stones._columns(), strict=True))
    parts = states.vertical, states.w, states._pair
    fields |= zip((*_FINAL, *slip), (x for part in parts for x in components(part)), strict=True)
    if states.height is not None:
        fields |= zip(("height", "lift"), states._aloft, strict=True)
    if isinstance(contact, Coulomb | Viscous):
        fields |= zip(("coefficient", "static", "patch"), contact._numbers, strict=True)
        contact = contact._natural(scale)
    if losses is not None:
        warn_of_long_arm(losses_of_stone(losses, stones), contact)
        fields |= zip(LAWS, losses._coefficients, strict=True)
    if table is not None:
        fields |= {"slope": table.slope, "phi0": table.phi0}
    asked = Asked(np.array([end]), tol=number("tol", tol), contact=contact, mu=number("mu", mu))
    asked = asked._replace(restitution=restitution, max_nfev=checked_max_nfev(max_nfev))
    told = kept_stones(stones, states) | kept_contact(contact) | kept_table(table)
    in_memory("contact", contact, fields)
    return Question(fields, names, frozenset(), asked, wanted, scale, seconds, told)


def fill(
    columns: dict[str, Floats],
    times: Floats,
    asked: dict[str, Any],
    out: dict[str, Any],
    threads: int,
    progress: Progress | None,
) -> None:
    """Compute the motions of a block of stones; write the results into the arrays of `out`."""
    # the core computes `known_until` only together with `end`
    all_of = {"end": np.empty(out["status"].size)} | out
    _core.stones(columns, times, asked, all_of, threads, progress)
    given_up(out["status"])
    lost = np.count_nonzero((out["known_until"] < all_of["end"]) | np.isinf(out["error"]))
    if lost:
        why = "after this time their errors are too large, and no reversals are counted; give a smaller tol="
        warn(f"{lost} of {out['status'].size} motions are known only up to known_until: {why}", ErrorWarning)
