"""What comes in: numbers or arrays of real numbers, refused by name if anything else."""

from types import ModuleType
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

#: A number or an array of numbers; NumPy, pandas, xarray and dask arrays keep their kind.
Reals: TypeAlias = Any
#: What an elementwise function returns: a number for numbers, else an array of the inputs' kind.
Result: TypeAlias = Any
Floats = NDArray[np.float64]


def reals(name: str, value: Reals) -> Reals:
    """`value` as something NumPy's ufuncs take, or TypeError naming the argument."""
    if type(value) is float:
        return value
    array = value if hasattr(value, "__array_ufunc__") else _ndarray(name, value)
    kinds = [array.dtype] if hasattr(array, "dtype") else getattr(array, "dtypes", [])
    for dtype in kinds:
        if getattr(dtype, "kind", "O") not in "biuf" or dtype.itemsize > 8:
            raise TypeError(f"{name}: expected real numbers of at most double precision, not {dtype}")
    return float(array) if type(array) is np.ndarray and array.ndim == 0 else array


def _ndarray(name: str, value: object) -> NDArray[Any]:
    try:
        return np.asarray(value)
    except ValueError as e:  # a ragged list
        raise TypeError(f"{name}: expected real numbers, not {type(value).__name__} ({e})") from None


def is_scalar(*values: Reals) -> bool:
    """Whether all of these are single numbers."""
    return all(type(v) is float or np.ndim(v) == 0 for v in values)


def number(name: str, value: object) -> float:
    """A single real number, or TypeError naming the argument."""
    if type(value) is float:
        return value
    array = reals(name, value)
    if not is_scalar(array):
        raise TypeError(f"{name}: expected a number, not an array of shape {np.shape(array)}")
    return float(array)


def whole(name: str, value: object, low: int, high: int) -> int:
    """A whole number within bounds, or an error naming the argument."""
    found = number(name, value)
    if isinstance(value, bool) or found != np.floor(found) or not low <= found <= high:
        raise ValueError(f"{name} = {value!r}: expected a whole number from {low} to {high}")
    return int(found)


def threes(*values: Reals) -> tuple[Reals, ...]:
    """`values` with a new last axis and, as one more, the numbers 0, 1, 2 along it.

    For laws with up to three answers. xarray broadcasts by name: there the axis is called "root".
    """
    named = next((v for v in values if hasattr(v, "dims")), None)
    if named is not None:
        return *values, type(named)(np.arange(3.0), dims="root")
    spread = (
        v if is_scalar(v) else (v if hasattr(v, "dask") else np.asanyarray(v))[..., np.newaxis]
        for v in values
    )
    return *spread, np.arange(3.0)


def extra(module: str, name: str) -> ModuleType:
    """An optional library, or ImportError naming the extra that installs it."""
    from importlib import import_module

    try:
        return import_module(module)
    except ImportError as e:
        message = f"this needs {module.split('.', maxsplit=1)[0]}: pip install 'spincyl[{name}]'"
        raise ImportError(message) from e
