"""Named dimensions for the inputs and outputs of many motions."""

from collections.abc import Callable, Sequence
from enum import IntEnum
from typing import Any

import numpy as np

from spincyl._input.numbers import Floats, Reals, extra, warn
from spincyl.sweep._common import many_blocks


class Status(IntEnum):
    """How a motion of a sweep ended."""

    DONE = 0  #: it reached the last time asked for
    FACE = 1  #: the face landed on the table
    SIDE = 2  #: the other rim landed
    LIFT_OFF = 3  #: the normal force vanished
    SLIP = 4  #: rolling needed more friction than mu N
    INVALID = 5  #: no such body, state or table, or a step too large for it: NaN
    PAINLEVE = 6  #: no contact force, or more than one, obeys the law of friction
    STOPS = 7  #: with losses: the contact point stops, the body rolls no more
    LANDING = 9  #: a landing on both rims has no outcome, or more than one, that obeys the law of friction
    BOUNDED = 8  #: given up, NaN: 600,000 steps that hardly advance, many phases, or 8 million evaluations


def flags(codes: type[IntEnum]) -> dict[str, object]:
    """Attributes that list the codes in an array and their meanings."""
    return {
        "flag_values": [int(c) for c in codes],
        "flag_meanings": " ".join(c.name.lower() for c in codes),
    }


def given_up(status: np.ndarray) -> None:
    """Warn of motions that the core has given up."""
    count = int(np.count_nonzero(status == Status.BOUNDED))
    if count:
        told = f"{count} of {status.size} motions hardly advance and were given up: NaN, Status.BOUNDED"
        warn(told, RuntimeWarning)


def labelled(fields: dict[str, Reals]) -> list[Any]:
    """Every field with named dimensions: its own, or "motion" names for the broadcast plain fields."""
    lib: Any = extra("xarray", "sweep")
    plain = [np.shape(x) for x in fields.values() if not hasattr(x, "dims")]
    try:
        rank = len(np.broadcast_shapes(*plain))
    except ValueError:
        shapes = ", ".join(f"{name} {np.shape(x)}" for name, x in fields.items() if np.shape(x))
        raise ValueError(f"bodies, states: shapes do not fit: {shapes}") from None
    dims = ["motion"] if rank == 1 else [f"motion_{i}" for i in range(rank)]

    def label(x: Reals) -> Any:
        if hasattr(x, "dims"):
            return x
        return lib.DataArray(x, dims=dims[rank - np.ndim(x) :])

    # xarray does not broadcast lengths of one by name: drop them where another field is longer
    named = [label(x) for x in fields.values()]
    return [x.squeeze([d for d in x.dims if x.sizes[d] == 1]) if _longer(x, named) else x for x in named]


def _longer(x: Any, others: list[Any]) -> bool:
    """Whether `x` has a dimension of length one that is longer in one of the others."""
    return any(x.sizes[d] == 1 and any(o.sizes.get(d, 1) > 1 for o in others) for d in x.dims)


def applied(
    run: Callable[..., tuple[np.ndarray, ...]],
    fields: list[Any],
    names: list[str],
    dtypes: Sequence[type],
    spread: list[bool],
    times: Floats,
) -> dict[str, Any]:
    """The output arrays of `run`, by name; those that are `spread` have a dimension of times."""
    lib: Any = extra("xarray", "sweep")
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
