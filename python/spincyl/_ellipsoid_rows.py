"""Stones as rows of numbers from the core: computed at once, or block by block for arrays of dask."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from spincyl import _core
from spincyl._input.numbers import Floats, Reals, optional_library
from spincyl._input.reprs import is_lazy

SIX = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))


def six_of_tensor(inertia: Floats) -> list[float]:
    """The six independent numbers of a symmetric tensor, in the order of `SIX`."""
    return [float(inertia[i, j]) for i, j in SIX]


def with_whole_tensor(numbers: Floats) -> Floats:
    """In each row replace the numbers 3 to 8, the independent components of a tensor, by all nine."""
    return numbers[
        ..., [0, 1, 2, *(3 + i for i in (0, 5, 4, 5, 1, 3, 4, 3, 2)), *range(9, numbers.shape[-1])]
    ]


def row_parts(rows: Reals) -> tuple[Reals, ...]:
    """Split rows from `with_whole_tensor` into axes, tensor, offset, theta_end and each further number."""
    tensor = rows[..., 3:12].reshape(*rows.shape[:-1], 3, 3)
    return rows[..., :3], tensor, rows[..., 12:15], *(rows[..., i][()] for i in range(15, rows.shape[-1]))


def by_blocks(law: Callable[..., Floats], signature: str, size: int, *arrays: Reals) -> Reals:
    """Apply `law` to arrays, lazily if one of them is lazy; the last axis of its result has length `size`.

    `signature` is that of a generalised ufunc of NumPy.
    """
    if not any(map(is_lazy, arrays)):
        return law(*arrays)
    last = signature.removesuffix(")").rpartition("(")[2]
    return optional_library("dask.array", "sweep").apply_gufunc(
        law, signature, *arrays, output_dtypes=np.float64, output_sizes={last: size}, allow_rechunk=True
    )


@contextmanager
def _named_as_in_python() -> Iterator[None]:
    """Context in which errors of the core about semi-axes begin with `semi_axes`, their name in Python."""
    try:
        yield
    except ValueError as e:
        raise ValueError(f"semi_{e}" if str(e).startswith("axes") else str(e)) from None


def checked_rows(axes: Floats, inertia: Floats, offset: Floats, theta_end: Floats) -> Floats:
    """Check stones; return rows (..., 18) of their numbers, then the largest semi-axis, then the `reach`."""
    each = axes, inertia.reshape(*inertia.shape[:-2], 9), offset, theta_end[..., None]
    shape = np.broadcast_shapes(*(x.shape[:-1] for x in each))
    given = np.concatenate([np.broadcast_to(x, (*shape, x.shape[-1])) for x in each], axis=-1)
    if shape == ():
        with _named_as_in_python():
            one, size, out = _core.check_stone(given.tolist())
        return with_whole_tensor(np.array([*one, size, out]))
    return with_whole_tensor(_core.check_stones(given.reshape(math.prod(shape), 16)).reshape(*shape, 15))


def rows_by(
    *arrays: Floats, make: Callable[..., Any], names: tuple[str, ...], wide: dict[str, bool]
) -> Floats:
    """Rows (..., 17) of stones that the constructor `make` makes; the last number is the largest semi-axis.

    `wide` names the arguments that `arrays` contains, and tells whether the last axis of each has components.
    `make` gets the arguments in the order of `names`, with None for names that are not in `wide`.
    """
    inputs = dict(zip(wide, arrays, strict=True))
    shape = np.broadcast_shapes(*(x.shape[:-1] if wide[name] else x.shape for name, x in inputs.items()))
    for name, x in inputs.items():
        inputs[name] = np.broadcast_to(x, (*shape, *x.shape[-1:]) if wide[name] else shape)
    found = np.full((*shape, 14), np.nan)
    for i in np.ndindex(shape):
        try:
            with _named_as_in_python():
                numbers, unit = make(
                    *(inputs[name][i].tolist() if name in inputs else None for name in names)
                )
        except ValueError:
            if not shape:
                raise
        else:
            found[i] = *numbers, unit
    return with_whole_tensor(found)
