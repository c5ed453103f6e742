"""Named dimensions for the inputs and outputs of many motions."""

from collections.abc import Callable, Sequence
from enum import IntEnum
from typing import Any

import numpy as np

from spincyl import _core
from spincyl._circles import CIRCLE_COLUMNS
from spincyl._ending import LARGE_ERROR, ErrorWarning
from spincyl._input.numbers import Floats, Reals, optional_library, warn
from spincyl._loss import LAWS
from spincyl.sweep._common import many_blocks

_BODY = ("ell", "i1", "i3", "bore", "fillet", "theta_end")
_START = ("theta", "w1", "w2", "w3")
_SHOWN = 5  # numbers of motions in a warning
_OF_CIRCLES = {name for names in CIRCLE_COLUMNS for name in names}


class Status(IntEnum):
    """Code of the way in which a motion of a sweep ended.

    Attributes
    ----------
    DONE
        The last time was reached.
    FACE
        The face landed on the table.
    SIDE
        The other rim landed.
    LIFT_OFF
        The normal force vanished.
    SLIP
        Rolling needed more friction than mu N, where N is the normal force.
    INVALID
        The body, the state or a coefficient is invalid, or the step is too long; the results are NaN.
    PAINLEVE
        No contact force, or more than one, obeys the law of friction.
    STOPS
        The body has come to rest, and dry friction holds it.
    LANDING
        For a landing on both rims no impulse, or more than one, obeys the law of friction.
    BOUNDED
        The computation was given up at a limit of its work or of its precision; the results are NaN.
    """

    DONE = 0
    FACE = 1
    SIDE = 2
    LIFT_OFF = 3
    SLIP = 4
    INVALID = 5
    PAINLEVE = 6
    STOPS = 7
    LANDING = 9
    BOUNDED = 8


def flags(codes: type[IntEnum]) -> dict[str, object]:
    """Attributes of a result that list the codes in an array and the meaning of each code."""
    return {
        "flag_values": [int(c) for c in codes],
        "flag_meanings": " ".join(c.name.lower() for c in codes),
    }


def given_up(status: np.ndarray) -> None:
    """Warn of motions whose computation was given up at a limit (`Status.BOUNDED`)."""
    count = int(np.count_nonzero(status == Status.BOUNDED))
    if count:
        told = f"{count} of {status.size} motions were given up (Status.BOUNDED) and are NaN"
        why = "they reached a limit of evaluations (max_nfev=), of phases, of impacts or of rounding"
        warn(f"{told}: {why}", RuntimeWarning)


def refused(columns: dict[str, Floats], asked: dict[str, Any], status: np.ndarray) -> None:
    """Warn if motions are invalid although their inputs are numbers, with the reason for the first one."""
    missing: Any = False
    for name, x in columns.items():
        known = name == "theta_end" or name in _OF_CIRCLES  # NaN where the body says it, or has fewer circles
        missing = missing | (np.isnan(x) & (not known))
    rows = np.flatnonzero((status == Status.INVALID) & ~missing)
    if not rows.size:
        return
    row = {name: float(np.broadcast_to(x, status.shape)[rows[0]]) for name, x in columns.items()}
    row["bore"] = np.nan  # the moments tell it
    body, start = (tuple(row[name] for name in of) for of in (_BODY, _START))
    own: dict[str, tuple[str, ...]] = {
        "coefficients": ("coefficient", "static", "patch"),
        "slip": ("slip_along", "slip_across"),
        "aloft": ("height", "lift"),
        "losses": tuple(LAWS),
    }
    given: dict[str, Any] = {name: [row[x] for x in of] for name, of in own.items() if of[0] in row}
    given |= {"circles": [[row[name] for name in of] for of in CIRCLE_COLUMNS if of[0] in row]}
    try:
        _core.roll(body, start, np.zeros(1), asked | given)
    except ValueError as error:
        told = f"{rows.size} of {status.size} motions are invalid (Status.INVALID) and are NaN"
        warn(f"{told}; motion {rows[0]}, in natural units: {error}", RuntimeWarning)


def uncertain(asked: dict[str, Any], error: np.ndarray, status: np.ndarray) -> None:
    """Warn of large estimated errors, as `spincyl.roll` does."""
    if asked.get("step") is not None or not asked.get("errors", True):
        return
    known = ~np.isin(status, [Status.INVALID, Status.PAINLEVE, Status.LANDING, Status.BOUNDED])
    rows = np.flatnonzero(known & ~(error <= LARGE_ERROR))
    if rows.size:
        told = f"{rows.size} of {status.size} motions have estimated errors above {LARGE_ERROR}"
        first = ", ".join(map(str, rows[:_SHOWN])) + (", ..." if rows.size > _SHOWN else "")
        which = f"motion{'s' * (rows.size > 1)} {first}; `error` of the result has all errors"
        why = ". Impacts multiply errors: at an earlier t they are smaller" if "restitution" in asked else ""
        warn(f"{told}, in natural units, up to {error[rows].max():.2g}: {which}{why}", ErrorWarning)


def broadcast(fields: dict[str, Reals]) -> tuple[tuple[int, ...], list[str]]:
    """Common shape of the fields without named dimensions, and the names given to these dimensions."""
    try:
        shape = np.broadcast_shapes(*(np.shape(x) for x in fields.values() if not hasattr(x, "dims")))
    except ValueError:
        shapes = ", ".join(f"{name} {np.shape(x)}" for name, x in fields.items() if np.shape(x))
        raise ValueError(f"bodies, states: shapes do not fit: {shapes}") from None
    return shape, ["motion"] if len(shape) == 1 else [f"motion_{i}" for i in range(len(shape))]


def labelled(fields: dict[str, Reals], more: dict[str, Reals]) -> tuple[list[Any], list[str]]:
    """Fields, and then `more`, with named dimensions; and the names of the dimensions of plain fields.

    Plain fields are arrays without names: their broadcast dimensions are "motion", or "motion_0" and so on.
    """
    lib: Any = optional_library("xarray", "sweep")
    shape, dims = broadcast(fields)
    rank = len(shape)

    def label(x: Reals) -> Any:
        if hasattr(x, "dims"):
            return x
        return lib.Variable(dims[rank - np.ndim(x) :], x)  # lighter than a DataArray

    # xarray does not broadcast lengths of one by name: drop them where another field is longer
    named = [label(x) for x in (*fields.values(), *more.values())]
    long = {d for x in named for d in x.dims if x.sizes[d] > 1}
    short = [[d for d in x.dims if x.sizes[d] == 1 and d in long] for x in named]
    return [x.squeeze(out) if out else x for x, out in zip(named, short, strict=True)], dims


def free(named: list[Any], names: list[str], spread: frozenset[str]) -> None:
    """Raise ValueError for inputs whose coordinate, or only dimension, has the name of an output."""
    coords = {c for x in named for c in getattr(x, "coords", ())}
    dims = {d for x in named for d in x.dims}
    for name in names:
        if name in coords or (dims == {name} and name not in spread):
            why = f"bodies, states: {name!r} is a coordinate of the inputs and also a result of the sweep"
            raise ValueError(f"{why}; rename it, for example with .rename({name}='{name}_start')")


def in_order(array: Any, dims: list[str]) -> Any:
    """The array with its dimensions in the order of `dims`, as NumPy needs it for broadcasting."""
    own = iter([d for d in dims if d in array.dims])
    return array.transpose(*(next(own) if d in dims else d for d in array.dims))


def applied(
    run: Callable[..., tuple[np.ndarray, ...]],
    fields: list[Any],
    names: list[str],
    dtypes: Sequence[type],
    spread: list[bool],
    times: Floats,
) -> dict[str, Any]:
    """The output arrays of `run`, by name; the outputs in `spread` have a dimension of times."""
    lib: Any = optional_library("xarray", "sweep")
    with many_blocks():
        found = lib.apply_ufunc(
            run,
            *fields,
            output_core_dims=[["t"] if wide else [] for wide in spread],
            dask="parallelized",
            output_dtypes=dtypes,
            dask_gufunc_kwargs={"output_sizes": {"t": times.size}} if any(spread) else None,
            keep_attrs=False,
        )
    return dict(zip(names, found, strict=True))


def dataset(data: dict[str, Any], coords: dict[str, Any], attrs: dict[str, object]) -> Any:
    """A Dataset of variables and coordinates along common dimensions of the right lengths.

    The public constructor of xarray compares and copies all arrays, which takes longer than a small sweep.
    A private constructor avoids this; it is used if xarray has it.
    """
    lib: Any = optional_library("xarray", "sweep")
    axes = [name for name, x in coords.items() if x.dims == (name,)]
    # an index of pandas is not searched for an array of dask, which xarray would import first
    frames: Any = optional_library("pandas", "sweep")
    indexes = {name: lib.indexes.PandasIndex(frames.Index(coords[name].data), name) for name in axes}
    variables = data | coords
    for name, axis in indexes.items():
        variables |= axis.create_variables({name: coords[name]})
    try:
        return lib.Dataset._construct_direct(variables, set(coords), attrs=attrs, indexes=indexes)
    except (AttributeError, TypeError):
        return lib.Dataset(data, coords, attrs)
