"""Stones in rows of numbers, as the core gives them: at once, or block by block of arrays of dask."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from spincyl import _core
from spincyl._input.numbers import Floats, Reals, extra
from spincyl._input.reprs import is_lazy

SIX = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))


def six(inertia: Floats) -> list[float]:
    """The six numbers of a symmetric tensor."""
    return [float(inertia[i, j]) for i, j in SIX]


def whole(numbers: Floats) -> Floats:
    """Rows whose numbers 3 to 8 are the six of a symmetric tensor, with all nine of them instead."""
    return numbers[
        ..., [0, 1, 2, *(3 + i for i in (0, 5, 4, 5, 1, 3, 4, 3, 2)), *range(9, numbers.shape[-1])]
    ]


def parts(rows: Reals) -> tuple[Reals, ...]:
    """Axes, tensor, offset and theta_end of such rows, and each number behind them."""
    tensor = rows[..., 3:12].reshape(*rows.shape[:-1], 3, 3)
    return rows[..., :3], tensor, rows[..., 12:15], *(rows[..., i][()] for i in range(15, rows.shape[-1]))


def blockwise(law: Callable[..., Floats], signature: str, size: int, *arrays: Reals) -> Reals:
    """What a law gives of arrays, with a last axis of this size; lazily, by blocks, if one of them is lazy.

    `signature` is that of a generalised ufunc of NumPy.
    """
    if not any(map(is_lazy, arrays)):
        return law(*arrays)
    last = signature.removesuffix(")").rpartition("(")[2]
    return extra("dask.array", "sweep").apply_gufunc(
        law, signature, *arrays, output_dtypes=np.float64, output_sizes={last: size}, allow_rechunk=True
    )


def checked(axes: Floats, inertia: Floats, offset: Floats, theta_end: Floats) -> Floats:
    """Rows of stones, with the unit of each and how far out its mass lies; (..., 18)."""
    each = axes, inertia.reshape(*inertia.shape[:-2], 9), offset, theta_end[..., None]
    shape = np.broadcast_shapes(*(x.shape[:-1] for x in each))
    given = np.concatenate([np.broadcast_to(x, (*shape, x.shape[-1])) for x in each], axis=-1)
    if shape == ():
        one, size, out = _core.check_stone(given.tolist())
        return whole(np.array([*one, size, out]))
    return whole(_core.check_stones(given.reshape(math.prod(shape), 16)).reshape(*shape, 15))


def made_by(
    *arrays: Floats, make: Callable[..., Any], names: tuple[str, ...], wide: dict[str, bool]
) -> Floats:
    """Rows of stones that a constructor of the core makes, with the unit of each; (..., 17).

    The arrays are of the names in `wide`, which says whether their last axis has components; others are None.
    """
    inputs = dict(zip(wide, arrays, strict=True))
    shape = np.broadcast_shapes(*(x.shape[:-1] if wide[name] else x.shape for name, x in inputs.items()))
    for name, x in inputs.items():
        inputs[name] = np.broadcast_to(x, (*shape, *x.shape[-1:]) if wide[name] else shape)
    found = np.full((*shape, 14), np.nan)
    for i in np.ndindex(shape):
        try:
            numbers, unit = make(*(inputs[name][i].tolist() if name in inputs else None for name in names))
        except ValueError:
            if not shape:
                raise
        else:
            found[i] = *numbers, unit
    return whole(found)
