"""Many motions at once."""

from collections.abc import Iterable
from enum import IntEnum
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from spincyl import _core
from spincyl._array import (
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
    within,
    words,
)
from spincyl._body import Body
from spincyl._contact import AnyContact, Coulomb, Viscous, code
from spincyl._loss import Loss
from spincyl._state import State, gripping
from spincyl.sweep._common import Progress, callback, is_lazy, signature, thread_count
from spincyl.sweep._labels import Status, applied, flags, labelled
from spincyl.sweep._slip import slide, summaries

if TYPE_CHECKING:
    import xarray


class Answer(IntEnum):
    """Who answered for a motion of a sweep."""

    NONE = 0  #: nobody: see `Status.INVALID`
    LANES = 1  #: the first integrals, eight motions at a time
    SINGLE = 2  #: the first integrals, one at a time
    TOLERANCE = 3  #: RK4 whose steps keep an error, where the first integrals lose their digits
    STEP = 4  #: RK4 with the fixed step asked for


# in the order of the compiled ensemble
_SUMMARIES = (
    "theta_min",
    "theta_max",
    "normal_min",
    "friction_coefficient_max",
    "period",
    "precession_per_period",
    "end",
)
_BODY = ("ell", "i1", "i3", "fillet", "theta_end")
_STATE = ("theta", "w1", "w2", "w3")
_TOLD = ("error", "method", "status")
_UNITS = {
    "theta": "rad",
    "w1": "sqrt(g/R)",
    "w2": "sqrt(g/R)",
    "w3": "sqrt(g/R)",
    "theta_min": "rad",
    "theta_max": "rad",
    "normal_min": "M g",
    "friction_coefficient_max": "1",
    "period": "sqrt(R/g)",
    "precession_per_period": "rad",
    "end": "sqrt(R/g)",
}
_LONG_NAMES = {
    "theta": "inclination",
    "theta_min": "least inclination",
    "theta_max": "greatest inclination",
    "normal_min": "least normal force",
    "friction_coefficient_max": "greatest coefficient of friction needed",
    "period": "period of the nutation",
    "precession_per_period": "precession per period of the nutation",
    "end": "time of the end",
    "error": "estimated error of the states",
    "method": "code of spincyl.sweep.Answer",
    "status": "code of spincyl.sweep.Status",
}


def roll(
    bodies: Body,
    states: State,
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
        Whose fields broadcast against each other: NumPy arrays by NumPy's rule, xarray's by name. If any
        field is backed by dask, so is the result: nothing runs before it is computed (or handed to `save`).
    t : float or array_like, 1-D
        In sqrt(R/g); the start is at 0, and negative is backward. A number: only the final state, at `t`. An
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
    restitution : None or 0.0
        With friction: None ends a motion where the other rim lands; with 0.0 it lands without a bounce, and
        the motion goes on.
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
        What was wanted, and `error` (estimated, of the worst number of the states), `method` (`Answer`) and
        `status` (`Status`). Dimensions: those of the inputs, "motion" for plain arrays (several: "motion_0",
        ...); "t". The same bits for any number of threads, any neighbours, and on AVX2, AVX-512 and NEON
        alike.

    Raises
    ------
    ValueError, TypeError
        Naming the argument, before any work. A body or a state of the family that is out of the range of
        `spincyl.roll` has NaN and `Status.INVALID` instead.
    KeyboardInterrupt
        Within 0.1 s of Ctrl-C.

    Warns
    -----
    RuntimeWarning
        Of how many motions that slip or lose energy were given up: each may take 600,000 steps that hardly
        advance, 10,000 phases, or 8 million evaluations (of times beyond 50: 160,000 for each unit). Such a
        motion has NaN and `Status.BOUNDED`; the others go on.

    Notes
    -----
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
    lib = extra("xarray", "sweep")
    made("bodies", bodies, Body)
    if bodies.scale is not None:
        raise ValueError("bodies: a sweep is in natural units, and these are measured: give bodies.natural")
    made("states", states, State)
    at, several = _times(t)
    beyond, mu = flag("beyond", beyond), number("mu", mu)
    if losses is not None and not isinstance(losses, Loss):
        like = "sc.loss.DryContour(1e-3), or laws added with +"
        raise TypeError(f"losses: expected a law of loss, as {like}, not {type(losses).__name__}")
    rubs = isinstance(contact, Coulomb | Viscous)
    if rubs or losses is not None:
        if at[-1] < 0:
            raise ValueError(
                f"t = {float(at[-1])!r}: expected times from 0 on: what is lost does not come back"
            )
        if step is not None or beyond or (rubs and mu != np.inf):
            raise ValueError(f"step, mu, beyond: not with contact = {contact!r}, losses = {losses!r}")
        if not rubs and (restitution is not None or stop_at is not None):
            raise ValueError("restitution, stop_at: only with contact=sc.Coulomb(...) or sc.Viscous(...)")
        one_of("restitution", restitution, (None, 0.0))
        one_of("stop_at", stop_at, (None, "rolling"))
        if not rubs:
            code(contact)
            gripping(states, f"contact={contact!r} has no law for that")
            if not mu >= 0:
                raise ValueError(f"mu = {mu!r}: expected 0 <= mu")
        return slide(
            bodies,
            states,
            at,
            _wanted(want, several, summaries(contact, losses)),
            contact,
            losses,
            tol=number("tol", tol),
            mu=mu,
            restitution=None if restitution is None else 0.0,
            stop_at=stop_at,
            threads=threads,
            progress=progress,
        )
    if restitution is not None or stop_at is not None:
        raise ValueError("restitution, stop_at: only with contact=sc.Coulomb(...) or sc.Viscous(...)")
    gripping(states, f"contact={contact!r} has no law for that")
    wanted = _wanted(want, several, _SUMMARIES)
    numbers: dict[str, float | None] = {"tol": number("tol", tol), "mu": mu}
    numbers["step"] = None if step is None else number("step", step)
    job = {"contact": code(contact), "beyond": beyond, **numbers}
    numbers_of = bodies.ell, bodies.i1, bodies.i3, bodies.fillet, bodies.theta_end, *states._numbers
    fields = dict(zip((*_BODY, *_STATE), numbers_of, strict=True))
    lazy = is_lazy(*fields.values())
    run = partial(
        _columns,
        times=at,
        wanted=wanted,
        job=job,
        threads=1 if lazy and threads is None else thread_count(threads),
        progress=callback(progress),
    )
    _columns(*(np.empty(0) for _ in fields), times=at, wanted=wanted, job=job, threads=1, progress=None)
    names = _names(wanted)
    spread = "states" in wanted
    wide = [spread and name in _STATE for name in names]
    data = applied(run, labelled(fields), names, [_dtype(name) for name in names], wide, at)
    for name, array in data.items():
        array.attrs = {"units": _UNITS.get(name, "1"), "long_name": _LONG_NAMES.get(name, name)}
    data["status"].attrs |= flags(Status)
    data["method"].attrs |= flags(Answer)
    coords = {"t": ("t", at, {"units": "sqrt(R/g)"})} if spread else {}
    attrs: dict[str, object] = {
        "contact": contact,
        "t": float(at[-1]),
        "tol": numbers["tol"],
        "mu": numbers["mu"],
    }
    if step is not None:
        attrs["step"] = numbers["step"]
    if lazy:
        attrs["spincyl_sweep"] = signature("roll", fields, t=at.tolist(), want=wanted, **job)
    result: xarray.Dataset = lib.Dataset(data, coords, attrs)
    return result


def _times(t: Reals) -> tuple[Floats, bool]:
    """The times, and whether they were given as an array."""
    given = reals("t", t)
    if is_scalar(given):
        # the sum makes 0 of -0
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


def _names(wanted: tuple[str, ...]) -> list[str]:
    """The variables of a result."""
    names = list(_STATE) if "final" in wanted or "states" in wanted else []
    return names + [name for name in wanted if name in _SUMMARIES] + list(_TOLD)


def _dtype(name: str) -> type:
    return np.uint8 if name in ("method", "status") else np.float64


def _columns(
    *fields: Floats,
    times: Floats,
    wanted: tuple[str, ...],
    job: dict[str, Any],
    threads: int,
    progress: Progress | None,
) -> tuple[np.ndarray, ...]:
    """The arrays of one block of motions."""
    shape = np.broadcast_shapes(*(np.shape(x) for x in fields))
    count = int(np.prod(shape))
    columns = [floats(x if np.size(x) == 1 else np.broadcast_to(x, shape)).reshape(-1) for x in fields]
    spread = "states" in wanted
    states = [np.empty(count * times.size) for _ in _STATE] if spread else None
    last = [np.empty(count) for _ in _STATE] if "final" in wanted else None
    sums = {name: np.empty(count) if name in wanted else None for name in _SUMMARIES}
    error = np.empty(count)
    method, status = np.empty(count, np.uint8), np.empty(count, np.uint8)
    if count != 1 and all(x.size == 1 for x in columns):
        columns[0] = np.full(count, columns[0][0])
    _core.ensemble(
        columns[: len(_BODY)],
        columns[len(_BODY) :],
        times,
        job["contact"],
        job["tol"],
        job["step"],
        job["mu"],
        job["beyond"],
        states,
        last,
        list(sums.values()),
        error,
        method,
        status,
        threads,
        progress,
    )
    found = [x.reshape((*shape, times.size)) for x in states or []]
    found += [x.reshape(shape) for x in last or []]
    found += [x.reshape(shape) for x in (*sums.values(), error, method, status) if x is not None]
    return tuple(found)
