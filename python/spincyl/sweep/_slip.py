"""Many motions with friction or losses at once."""

import warnings
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl import _core
from spincyl._array import Floats, extra, floats
from spincyl._body import Body
from spincyl._contact import AnyContact, Coulomb, Viscous, code, law
from spincyl._loss import Loss
from spincyl._state import State
from spincyl.sweep._common import Progress, callback, is_lazy, signature, thread_count
from spincyl.sweep._labels import Status, applied, flags, labelled

if TYPE_CHECKING:
    import xarray

# in the order of the compiled ensemble
SUMMARIES = (
    "end",
    "slip_time",
    "dissipated",
    "work_lost",
    "phases",
    "rolling_time",
    "rolling_theta",
    "rolling_w1",
    "rolling_w2",
    "rolling_w3",
)
# what there is of a motion that only rolls or slides freely
_ROLLING = ("end", "work_lost")
_STATE = ("theta", "w1", "w2", "w3", "slip_along", "slip_across")
_COLUMNS = ("ell", "i1", "i3", "fillet", "theta_end", *_STATE)
# of these and the two of a table; then come the losses
_TABLES = len(_COLUMNS) + 2
_SPEED = "sqrt(g/R)"
_UNITS = {name: _SPEED for name in ("w1", "w2", "w3", "rolling_w1", "rolling_w2", "rolling_w3")}
_UNITS |= {"theta": "rad", "rolling_theta": "rad", "slip_along": "sqrt(g R)", "slip_across": "sqrt(g R)"}
_UNITS |= {"end": "sqrt(R/g)", "slip_time": "sqrt(R/g)", "rolling_time": "sqrt(R/g)", "dissipated": "M g R"}
_UNITS["work_lost"] = "M g R"
_LONG_NAMES = {
    "theta": "inclination",
    "slip_along": "slip along the lean",
    "slip_across": "slip across the lean",
    "end": "time of the end",
    "slip_time": "time of slipping",
    "dissipated": "heat made by friction",
    "work_lost": "energy that the losses took",
    "phases": "number of phases",
    "rolling_time": "time at which the last rolling begins",
    "rolling_theta": "inclination at which the last rolling begins",
    "error": "estimated error of the states",
    "status": "code of spincyl.sweep.Status",
}


def summaries(contact: AnyContact, losses: Loss | None) -> tuple[str, ...]:
    """What can be wanted of motions besides their states."""
    if not isinstance(contact, Coulomb | Viscous):
        return _ROLLING
    return tuple(name for name in SUMMARIES if losses is not None or name != "work_lost")


def slide(
    bodies: Body,
    states: State,
    at: Floats,
    wanted: tuple[str, ...],
    contact: AnyContact,
    losses: Loss | None,
    *,
    tol: float,
    mu: float,
    restitution: float | None,
    stop_at: str | None,
    threads: int | None,
    progress: Progress | None,
) -> "xarray.Dataset":
    """The motions that `spincyl.sweep.roll` was asked for, with friction or losses."""
    numbers = bodies.ell, bodies.i1, bodies.i3, bodies.fillet, bodies.theta_end
    names_of, table, kind = _table(contact, mu)
    values = (*numbers, *states._numbers, *states._slip, *table)
    fields = dict(zip((*_COLUMNS, *names_of), values, strict=True))
    if losses is not None:
        fields |= {f"loss_{place}": x for place, x in enumerate(losses._coefficients)}
    lazy = is_lazy(*fields.values())
    job: dict[str, Any] = {"table": kind, "tol": tol, "restitution": restitution, "stop_at": stop_at}
    share = 1 if lazy and threads is None else thread_count(threads)
    slips = isinstance(contact, Coulomb | Viscous)
    fill = partial(_filled, times=at, wanted=wanted, job=job, slips=slips)
    run = partial(fill, threads=share, progress=callback(progress))
    fill(
        *(np.empty(0) for _ in fields), threads=1, progress=None
    )  # what is asked wrongly is said before any work
    spread = "states" in wanted
    names = list(_STATE if slips else _STATE[:4]) if "final" in wanted or spread else []
    names += [name for name in SUMMARIES if name in wanted] + ["error", "status"]
    dtypes = [np.uint8 if name == "status" else np.float64 for name in names]
    wide = [spread and name in _STATE for name in names]
    data = applied(run, labelled(fields), names, dtypes, wide, at)
    for name, array in data.items():
        array.attrs = {"units": _UNITS.get(name, "1"), "long_name": _LONG_NAMES.get(name, name)}
    data["status"].attrs |= flags(Status)
    attrs: dict[str, object] = {
        "contact": contact
        if isinstance(contact, str)
        else type(contact).__name__.replace("Viscous", "viscous"),
        "t": float(at[-1]),
        "tol": tol,
    }
    if losses is not None:
        attrs["losses"] = repr(losses)
    if not slips:
        attrs["mu"] = mu
    if lazy:
        attrs["spincyl_sweep"] = signature("slide", fields, t=at.tolist(), want=wanted, **job)
    coords = {"t": ("t", at, {"units": "sqrt(R/g)"})} if spread else {}
    found: xarray.Dataset = extra("xarray", "sweep").Dataset(data, coords, attrs)
    return found


# by the codes of the tables
_LAWS = ("rolling", "smooth", "Coulomb", "viscous")


def _table(contact: AnyContact, mu: float) -> tuple[tuple[str, str], tuple[Any, Any], int]:
    """Names and numbers of a table, and its code."""
    if isinstance(contact, str):
        return ("mu", "unused"), (mu, 0.0), code(contact)
    return (
        ("mu", "static") if isinstance(contact, Coulomb) else ("c", "unused"),
        contact._numbers,
        law(contact),
    )


def _filled(
    *fields: Floats,
    times: Floats,
    wanted: tuple[str, ...],
    job: dict[str, Any],
    slips: bool,
    threads: int,
    progress: Progress | None,
) -> tuple[np.ndarray, ...]:
    """The wanted arrays of one block of motions."""
    shape = np.broadcast_shapes(*(np.shape(x) for x in fields))
    count = int(np.prod(shape))
    columns = [floats(x if np.size(x) == 1 else np.broadcast_to(x, shape)).reshape(-1) for x in fields]
    if count != 1 and all(x.size == 1 for x in columns):
        columns[0] = np.full(count, columns[0][0])
    spread = "states" in wanted
    states = [np.empty(count * times.size) for _ in _STATE] if spread else None
    last = [np.empty(count) for _ in _STATE] if "final" in wanted else None
    sums = [np.empty(count) if name in wanted else None for name in SUMMARIES]
    error, status = np.empty(count), np.empty(count, np.uint8)
    _core.slides(
        columns[:_TABLES],
        columns[_TABLES:] or None,
        job["table"],
        times,
        job["tol"],
        job["restitution"],
        job["stop_at"] == "rolling",
        states,
        last,
        sums,
        error,
        status,
        threads,
        progress,
    )
    given_up = int(np.count_nonzero(status == Status.BOUNDED))
    if given_up:
        told = f"{given_up} of {count} motions hardly advance and were given up: NaN, Status.BOUNDED"
        warnings.warn(told, RuntimeWarning, stacklevel=2)
    shown = len(_STATE) if slips else 4
    found = [x.reshape((*shape, times.size)) for x in (states or [])[:shown]]
    found += [x.reshape(shape) for x in (last or [])[:shown]]
    found += [x.reshape(shape) for x in (*sums, error, status) if x is not None]
    return tuple(found)
