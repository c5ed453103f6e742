"""Many motions at once."""

from collections.abc import Iterable
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from spincyl import _core
from spincyl._asked import Asked
from spincyl._body import Body
from spincyl._contact import TABLES, AnyContact, Coulomb, Viscous, code, fitting, law
from spincyl._input.numbers import (
    Floats,
    Reals,
    extra,
    flag,
    floats,
    is_scalar,
    made,
    number,
    one_of,
    reals,
    si,
    within,
    words,
)
from spincyl._input.threads import Progress, is_roomy
from spincyl._loss import Loss, made_law
from spincyl._lossy import narrow
from spincyl._measured import natural_time, speaking
from spincyl._phases import rubs
from spincyl._roll import is_stone
from spincyl._state import State, gripping, landed
from spincyl.sweep._inputs import kept_bodies, kept_contact
from spincyl.sweep._labels import flags, given_up
from spincyl.sweep._swept import Question, swept

if TYPE_CHECKING:
    import xarray

    from spincyl._ellipsoid import Ellipsoid
    from spincyl._ellipsoid_state import EllipsoidState


class Answer(IntEnum):
    """Who answered for a motion of a sweep."""

    NONE = 0  #: nobody: see `Status.INVALID`
    LANES = 1  #: the first integrals, eight motions at a time
    SINGLE = 2  #: the first integrals, one at a time
    TOLERANCE = 3  #: RK4 whose steps keep an error, where the first integrals lose their digits
    STEP = 4  #: RK4 with the fixed step asked for
    FLOW = 5  #: an integrator of eighth order, with friction or losses


_STATE = ("theta", "w1", "w2", "w3")
_SLIP = ("slip_along", "slip_across")
LABELS = {name: (unit, words) for name, unit, words in _core.columns()}


def roll(
    bodies: "Body | Ellipsoid",
    states: "State | EllipsoidState",
    t: Reals,
    *,
    want: str | Iterable[str] | None = None,
    contact: AnyContact = "rolling",
    tol: float = 1e-10,
    step: float | None = None,
    mu: float = np.inf,
    beyond: bool = False,
    restitution: float | None = None,
    stop_at: Literal["rolling"] | None = None,
    losses: Loss | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> "xarray.Dataset":
    """How many bodies move on from as many states.

    Parameters
    ----------
    bodies, states : Body, State
        Or `Ellipsoid` and `EllipsoidState`, see the Notes.
        Whose fields broadcast against each other: NumPy arrays by NumPy's rule, xarray's by name. If any
        field is backed by dask, so is the result: nothing runs before it is computed (or handed to `save`).
    t : float or array_like, 1-D
        In sqrt(R/g), of measured bodies in seconds, as is `step`; the start is at 0, and negative is
        backward. A number: only the final state, at `t`. An
        array: the states at these times, in order, on one side of 0.
    want : str or iterable of str
        "final" (theta, w1, w2, w3 at the last time, or where the motion ended before; the default of a
        number) or "states" (at all times; the default of an array, NaN after an end); "theta_min",
        "theta_max", "normal_min" (per weight), "friction_coefficient_max" (of what rolling needs, infinite
        where nothing presses): from the start to the end; "period", "precession_per_period" (radians); "end"
        (its time). What is not wanted is not computed.
        On a table with friction there are "final" (with `slip_along`, `slip_across`), "states", "end" and
        "slip_time", "dissipated" (M g R), "phases" (how many), "rolling_time", "rolling_theta", "rolling_w1",
        "rolling_w2", "rolling_w3" (where the last rolling begins; NaN if none does). With losses there are
        "final", "states", "end" and "work_lost" (M g R), with friction as well all that there is then.
    contact : {"rolling", "smooth"}, Coulomb or Viscous
        Rolling without slipping, a frictionless table, or friction, whose coefficients may be arrays that
        broadcast with the rest, as may the slip of the states.
    tol : float
        Error that is good enough, 1e-15 to 0.1: more costs more. It is a promise of the first integrals:
        where they cannot keep it in lanes, a single motion is computed as well as it can be, and `error` says
        how well that is.
        With friction or losses it is what a step of the integrator may err by; `error` says what comes of it.
    step : float, optional
        By RK4 with this fixed step instead. `error` then is the difference from the first integrals.
    mu : float
        Coefficient of friction: where rolling needs more, the motion ends (`Status.SLIP`).
    beyond : bool
        Whether to leave out the watch for the ends that the equations of motion can pass: the other rim
        lands, lift-off, slip. Cheaper, and no longer the motion of a body after that.
    restitution : float, optional
        Of impacts, 0 to 1, as of `spincyl.roll`. Default: a motion ends where the body leaves the table or
        its other rim lands. With it there are also "impacts" and "landings" (how many), "air_time",
        "lost_in_impacts" (M g R) and "last_phase" (`Motion.phase`).
    stop_at : {"rolling"}, optional
        With friction: end where the contact point first comes to rest for good and the body rolls. What it
        does then costs nothing.
    losses : Loss, optional
        What takes energy, as of `spincyl.roll`, with any contact: a law of `spincyl.loss`, or laws added with
        ``+``, whose coefficients may be arrays that broadcast with the rest. Motions go on to their last turn
        (`Status.STOPS`, `Status.FACE`). Eight at a time where the contact point rolls or slides freely, each
        as finely as its own error asks for; a slip that loses energy besides is followed alone.
    threads : int, optional
        Default: RAYON_NUM_THREADS, else every core that this process may use. In a dask block: 1.
    progress : callable, optional
        Called with the share that is done, 0 to 1, about fifty times a second.

    Returns
    -------
    xarray.Dataset
        What was wanted, and `error` (estimated, of the worst number of the states, and of "period" and
        "precession_per_period" where they are wanted and there is a period), `method` (`Answer`) and
        `status` (`Status`). Dimensions: those of the inputs, "motion" for plain arrays (several: "motion_0",
        ...), as NumPy broadcasts them; "t". In natural units, of measured bodies in SI: each array has its
        `units`. Coordinates are the bodies, states and laws of each motion (`sweep.inputs`). The same bits
        for any number of threads, any neighbours, and on AVX2, AVX-512 and NEON alike.

    Raises
    ------
    ValueError, TypeError
        Naming the argument, before any work; also an input labelled by a coordinate with the name of a
        result. A body or a state of the family that is out of the range of `spincyl.roll` has NaN and
        `Status.INVALID` instead.
    KeyboardInterrupt
        Within 0.1 s of Ctrl-C.

    Warns
    -----
    RuntimeWarning
        Of how many motions that slip or lose energy were given up: each may take 600,000 steps that hardly
        advance, 20 phases for each unit of time (5,000 to 10,000), or 8 million evaluations (of times beyond
        200: 40,000 for each unit). Such a motion has NaN, `Status.BOUNDED` and the time at which it was
        given up as its "end"; the others go on.
    ErrorWarning
        Of how many stones are not known to the end of their motion: see the Notes.

    Notes
    -----
    Of stones, which have no first integrals, `t` is a number, and there are "spin" (at the end), "reversals"
    (how often the spin has turned back: to a tenth of the first spin at least, in the other direction),
    "first_reversal" (the last zero before), "end", "dissipated", with losses "work_lost", and "final" (n1,
    n2, n3, w1, w2, w3); each is
    followed alone, on threads, twice for its error. `known_until` is the time up to which each motion is
    known, as of `EllipsoidMotion`; if reversals are wanted, they are counted up to there, and the error then
    is also at most the spin that counts. A spin of less than 1e-12 at the start has no direction.

    The solution by first integrals as a series about the start, as many terms as the width of the swing
    takes; the cost does not grow with time. See docs/physics.md and docs/benchmarks.md.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> ell = np.linspace(0.9, 3, 1000)
    >>> body = sc.Body.solid(ell)
    >>> found = sc.sweep.roll(body, body.steady(1.3).kicked(0.05), 20.0, want=("final", "theta_max"))
    >>> found["theta_max"].dims, bool((found["error"] < 1e-10).all())
    (('motion',), True)
    """
    extra("xarray", "sweep")
    if is_stone(bodies):
        from spincyl.sweep import _stones

        if step is not None or beyond or restitution is not None or stop_at is not None:
            raise ValueError("step, beyond, restitution, stop_at: not of stones")
        stones = _stones.question(bodies, states, t, want, contact, tol, mu, losses)
        labels = LABELS | _stones.LABELS
        found = swept(_stones.fill, stones, labels, threads=threads, progress=progress, length="a")
        if losses is not None:
            found.attrs["losses"] = repr(losses)
        return found
    bodies, states = made("bodies", bodies, Body), made("states", states, State)
    scale, seconds, pace = bodies.scale, t, step
    if scale is not None:
        fitting(contact, scale)
        seconds = si("t", t, "second")
        t = natural_time("t", t, scale)
        pace = si("step", step, "second")
        step = None if step is None else natural_time("step", step, scale)
        if losses is not None:
            made_law(losses, bodies)
    with speaking(scale):
        at, several = _times(t)
    asked = Asked(at, step=step, contact=contact, beyond=flag("beyond", beyond), mu=number("mu", mu))
    asked = _checked(asked._replace(restitution=restitution, stop_at=stop_at), losses)
    asked = asked._replace(tol=number("tol", tol))
    if restitution is None:
        landed(states, "give restitution=0.0, or how much of its velocity an impact gives back")
    if not rubs(contact) and (restitution is None or states.height is None):
        gripping(states, f"contact={contact!r} has no law for that")
    of = TABLES[contact] if isinstance(contact, str) else law(contact)
    summaries = _core.summaries(of, losses is not None, restitution is not None)
    wanted = _wanted(want, several, tuple(summaries))
    asked = asked._replace(spread="states" in wanted)
    fields = _fields(bodies, states, contact, losses)
    slips = rubs(contact) or restitution is not None
    names = [*_STATE, *(_SLIP if slips else ())] if {"final", "states"} & {*wanted} else []
    spread = frozenset(names if asked.spread else ())
    names += [name for name in summaries if name in wanted] + ["error", "method", "status"]
    told = kept_bodies(bodies, states, losses) | kept_contact(contact)
    question = Question(fields, names, spread, asked, wanted, scale, seconds, told)
    result = swept(_fill, question, LABELS, threads=threads, progress=progress)
    result["method"].attrs |= flags(Answer)
    if losses is not None:
        result.attrs["losses"] = repr(losses)
    if asked.step is not None:
        result.attrs["step"] = number("step", pace)
    return result


def _checked(asked: Asked, losses: Loss | None) -> Asked:
    """Check the arguments for all motions; an error names the argument."""
    contact, step = asked.contact, asked.step
    if not rubs(contact):
        code(contact, rubs=True)
    if losses is not None:
        made_law(losses)
        narrow(losses, contact)
    if not rubs(contact) and asked.stop_at is not None:
        raise ValueError("stop_at: only with contact=sc.Coulomb(...) or sc.Viscous(...)")
    if asked.restitution is not None:
        within("restitution", number("restitution", asked.restitution), 0.0, 1.0, "or None")
    one_of("stop_at", asked.stop_at, (None, "rolling"))
    if rubs(contact) or losses is not None or asked.restitution is not None:
        if asked.times[-1] < 0:
            raise ValueError(
                f"t = {float(asked.times[-1])!r}: expected times from 0 on: what is lost does not come back"
            )
        if step is not None or asked.beyond or (rubs(contact) and asked.mu != np.inf):
            given = f"contact = {contact!r}, losses = {losses!r}, restitution = {asked.restitution!r}"
            raise ValueError(f"step, mu, beyond: not with {given}")
    return asked._replace(step=None if step is None else number("step", step))


def _fields(bodies: Body, states: State, contact: AnyContact, losses: Loss | None) -> dict[str, Any]:
    """The columns of all motions, by the names that the core uses."""
    fields: dict[str, Any] = {
        name: getattr(bodies, name) for name in ("ell", "i1", "i3", "fillet", "theta_end")
    }
    fields |= zip(_STATE, states._numbers, strict=True)
    if isinstance(contact, Coulomb | Viscous):
        fields |= zip(("coefficient", "static", "patch"), contact._numbers, strict=True)
    if states.slip is not None or isinstance(contact, Coulomb | Viscous):
        fields |= zip(_SLIP, states._slip, strict=True)
    if states.height is not None:
        fields |= {"height": states.height, "lift": states.lift}
    if losses is not None:
        names = (name for name, _ in _core.loss_laws())
        fields |= zip(names, losses._coefficients, strict=True)
    return fields


def _times(t: Reals) -> tuple[Floats, bool]:
    """The times, and whether they were given as an array."""
    given = reals("t", t)
    if is_scalar(given):
        # adding 0.0 turns -0.0 into 0.0
        return np.array([within("t", given, -1e15, 1e15, "sqrt(R/g)") + 0.0]), False
    at = floats(given) + 0.0
    if at.ndim != 1 or at.size == 0:
        like = "a number, for the final state alone, or an array of times, for the states at these"
        raise ValueError(f"t: expected {like}, not shape {at.shape}")
    ordered = any((np.diff(x, prepend=0.0) >= 0).all() for x in (at, -at))
    if not ordered or not np.abs(at).max() <= 1e15:
        raise ValueError("t: expected times in order, on one side of 0, at most 1e15 in size")
    return at, True


def _wanted(want: str | Iterable[str] | None, several: bool, summaries: tuple[str, ...]) -> tuple[str, ...]:
    kinds = ("final", "states", *summaries)
    asked = words("want", ("states" if several else "final") if want is None else want, kinds)
    if "states" in asked and ("final" in asked or not several):
        raise ValueError('want: "states" are those at an array of times t, and "final" is the last of them')
    return tuple(name for name in kinds if name in asked)


def _fill(
    columns: dict[str, Floats],
    times: Floats,
    asked: dict[str, Any],
    out: dict[str, Any],
    threads: int,
    progress: Progress | None,
) -> None:
    """Fill the columns of a block of motions."""
    _core.ensemble(columns, times, asked, out, (threads, is_roomy()), progress)
    given_up(out["status"])
