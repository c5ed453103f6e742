"""Computation of a sweep: a Dataset from columns of inputs, at once or in blocks for arrays of dask."""

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spincyl._asked import Asked, options_for_core
from spincyl._contact import Coulomb, contact_in_words, without_coefficient
from spincyl._input.numbers import Floats, Reals, floats, in_columns, optional_library
from spincyl._input.progress import Progress, reporting_progress
from spincyl._input.threads import thread_count
from spincyl._measured import errors_in_seconds
from spincyl._phases import has_friction
from spincyl._restitution import restitution_as_words
from spincyl._scale import Scale
from spincyl.sweep._common import in_si, is_lazy, signature, sizes, to_si
from spincyl.sweep._inputs import plain_inputs, with_inputs
from spincyl.sweep._labels import Status, applied, broadcast, dataset, flags, free, in_order, labelled

if TYPE_CHECKING:
    import xarray

#: Columns of codes; the core writes some of them as numbers.
CODES = ("method", "status", "rests_on")
WRITTEN = ("rests_on",)


class Question(NamedTuple):
    """The arguments of a sweep of motions, in natural units."""

    fields: dict[str, Reals]  # inputs, by the names that the core uses
    names: list[str]  # outputs
    spread: frozenset[str]  # outputs with a dimension of times
    asked: Asked
    want: tuple[str, ...]  # the outputs that the caller wants
    scale: Scale | None
    seconds: Reals  # the times as the caller gave them
    kept: dict[str, Reals]  # inputs that become coordinates of the result


def swept(
    law: Callable[..., None],
    question: Question,
    labels: Mapping[str, tuple[str, str]],
    *,
    threads: int | None,
    progress: Progress | bool | None,
    length: str = "R",
) -> "xarray.Dataset":
    """The Dataset of many motions. `law` fills columns of a block; `labels` has their units and meanings."""
    lib: Any = optional_library("xarray", "sweep")
    fields, names, spread, asked, want, scale, seconds, kept = question
    lazy, at = is_lazy(*fields.values()), asked.times
    options = options_for_core(asked._replace(contact=without_coefficient(asked.contact)))
    share = 1 if lazy and threads is None else thread_count(threads)
    fill = partial(
        _block_of_motions, law=law, given=tuple(fields), names=names, spread=spread, times=at, asked=options
    )
    attrs: dict[str, object] = {
        "contact": contact_in_words(asked.contact),
        "t": float(at[-1]),
        "tol": asked.tol,
    }
    if not has_friction(asked.contact):
        attrs["mu"] = asked.mu
    if isinstance(asked.contact, Coulomb) and asked.contact.face != "ring":
        attrs["face"] = asked.contact.face
    attrs |= {"beyond": 1} if asked.beyond else {}  # numbers, since netCDF has no booleans
    attrs |= {} if asked.errors else {"errors": 0}
    attrs |= {} if asked.while_slipping else {"while_slipping": 0}
    attrs |= restitution_as_words(asked.restitution)
    more = {"stop_at": asked.stop_at, "max_nfev": asked.max_nfev}
    attrs |= {name: x for name, x in more.items() if x is not None}
    told, unit = at, f"sqrt({length}/g)"
    if scale is not None:  # the times as the caller gave them
        told, unit = floats(seconds).reshape(-1), "s"
        attrs["t"] = float(told[-1])
    coords = {"t": lib.Variable(("t",), told, {"units": unit}, fastpath=True)} if spread else {}
    if not any(hasattr(x, "dims") or is_lazy(x) for x in (*fields.values(), *kept.values())):
        shape, dims = broadcast(fields)
        with (
            errors_in_seconds(scale, length),
            reporting_progress(progress, "sweep", by_default=True) as tells,
        ):
            arrays = fill(*fields.values(), threads=share, progress=tells)
        columns: dict[str, Any] = {}
        for name, array in zip(names, arrays, strict=True):
            factor, about = to_si(name, _about(name, labels), scale)
            along = (*dims, "t") if name in spread else dims
            if factor is not None:
                array *= factor
            # the fast path does not look for arrays of dask, which it would import first
            columns[name] = lib.Variable(along, array, about, fastpath=True)
        attrs |= {} if scale is None else sizes(scale)
        plain: xarray.Dataset = dataset(columns, coords | plain_inputs(kept, shape, dims, length), attrs)
        return plain
    # an empty block, run first, raises errors about the arguments before any work
    with errors_in_seconds(scale, length):
        fill(*(np.empty(0) for _ in fields), threads=1, progress=None)
    given, dims = labelled(fields, kept)
    free(given, names, spread)
    wanted = given[: len(fields)], names, [*map(_dtype, names)], [name in spread for name in names], at
    with reporting_progress(progress, "sweep", by_default=not lazy) as tells:
        data = applied(partial(fill, threads=share, progress=tells), *wanted)
    data = {name: in_order(array, dims) for name, array in data.items()}
    for name, array in data.items():
        array.attrs = _about(name, labels)
    if lazy:
        own = {} if scale is None else {"scale": scale}
        attrs["spincyl_sweep"] = signature("roll", fields, t=at.tolist(), want=want, **options, **own)
    result: xarray.Dataset = in_si(lib.Dataset(data, coords, attrs), scale)
    return with_inputs(result, dict(zip(kept, given[len(fields) :], strict=True)), length)


def _about(name: str, labels: Mapping[str, tuple[str, str]]) -> dict[str, Any]:
    """The attributes of an output of a sweep: its natural unit and its meaning."""
    unit, meaning = labels[name]
    return {"units": unit, "long_name": meaning} | (flags(Status) if name == "status" else {})


def _block_of_motions(
    *fields: Floats,
    law: Callable[..., None],
    given: tuple[str, ...],
    names: list[str],
    spread: frozenset[str],
    times: Floats,
    asked: dict[str, Any],
    threads: int,
    progress: Progress | None,
) -> tuple[np.ndarray, ...]:
    """Compute one block of motions; dask calls this function for each block of lazy inputs."""
    shape = np.broadcast_shapes(*(np.shape(x) for x in fields))
    shapes = {name: (*shape, times.size) if name in spread else shape for name in names}
    types = {name: np.float64 if name in WRITTEN else _dtype(name) for name in names}
    out = {name: np.empty(math.prod(wide), types[name]) for name, wide in shapes.items()}
    law(dict(zip(given, in_columns(fields, shape), strict=True)), times, asked, out, threads, progress)
    # what no motion has told yet is NaN, and its code 0
    codes: dict[str, np.ndarray] = {
        name: np.nan_to_num(out[name]).astype(_dtype(name)) for name in names if name in WRITTEN
    }
    return tuple((out | codes)[name].reshape(wide) for name, wide in shapes.items())


def _dtype(name: str) -> type:
    return np.uint8 if name in CODES else np.float64
