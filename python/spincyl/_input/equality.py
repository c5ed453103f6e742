"""Values that are compared: also those with arrays in them, number by number, NaN equal to NaN."""

from collections.abc import Hashable, Mapping
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

_Kind = TypeVar("_Kind")


def key(value: Any) -> Hashable:
    """What is equal, and has one hash, for equal values: numbers and arrays go by value, not by type."""
    if hasattr(type(value), "_compared"):
        return value  # type: ignore[no-any-return]
    if isinstance(value, Mapping):
        return frozenset((name, key(x)) for name, x in value.items())
    if isinstance(value, tuple | list):
        return tuple(map(key, value))
    if not isinstance(value, int | float) and not hasattr(value, "__array__"):
        return value  # type: ignore[no-any-return]
    array = np.ma.filled(value.astype(np.float64), np.nan) if np.ma.isMA(value) else np.asarray(value)
    if array.dtype.kind not in "biuf":
        return array.shape, tuple(array.ravel().tolist())
    plain = array.astype(np.float64) + 0.0  # no -0.0
    return plain.shape, np.where(np.isnan(plain), np.nan, plain).tobytes()


def compared(kind: type[_Kind]) -> type[_Kind]:
    """A class of named fields whose instances are equal, and have one hash, if all their fields are."""
    named: Any = kind
    names: tuple[str, ...] = getattr(kind, "_fields", ()) or tuple(x.name for x in fields(named))

    def keys(self: Any) -> Hashable:
        return tuple(key(getattr(self, name)) for name in names)

    def equal(self: Any, other: object) -> bool:
        if type(other) is type(self):
            return keys(self) == keys(other)
        # a plain tuple would compare arrays by itself
        return False if isinstance(other, tuple) else NotImplemented

    def unequal(self: Any, other: object) -> bool:
        same = equal(self, other)
        return same if same is NotImplemented else not same

    named.__eq__, named.__ne__, named.__hash__ = equal, unequal, lambda self: hash((kind, keys(self)))
    named.__array_ufunc__ = None  # NumPy's arrays do not compare themselves with it element by element
    named._compared = True
    return kind
