"""Equality of objects whose fields may be arrays: number by number, NaN equal to NaN."""

from collections.abc import Hashable, Mapping
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

_Kind = TypeVar("_Kind")


def equality_key(value: Any) -> Hashable:
    """A hashable key that is the same for equal values; numbers and arrays compare by value, not by type."""
    if hasattr(type(value), "_compared"):
        return value  # type: ignore[no-any-return]
    if isinstance(value, Mapping):
        return frozenset((name, equality_key(x)) for name, x in value.items())
    if isinstance(value, tuple | list):
        return tuple(map(equality_key, value))
    if not isinstance(value, int | float) and not hasattr(value, "__array__"):
        return value  # type: ignore[no-any-return]
    array = np.ma.filled(value.astype(np.float64), np.nan) if np.ma.isMA(value) else np.asarray(value)
    if array.dtype.kind not in "biuf":
        return array.shape, tuple(array.ravel().tolist())
    plain = array.astype(np.float64) + 0.0  # turns -0.0 into 0.0
    return plain.shape, np.where(np.isnan(plain), np.nan, plain).tobytes()


def compared_by_value(kind: type[_Kind]) -> type[_Kind]:
    """Class decorator: instances are equal, and have the same hash, if all their named fields are equal."""
    named: Any = kind
    names: tuple[str, ...] = getattr(kind, "_fields", ()) or tuple(x.name for x in fields(named))

    def keys(self: Any) -> Hashable:
        return tuple(equality_key(getattr(self, name)) for name in names)

    def equal(self: Any, other: object) -> bool:
        if type(other) is type(self):
            return keys(self) == keys(other)
        # else the == of a tuple would compare arrays
        return False if isinstance(other, tuple) else NotImplemented

    def unequal(self: Any, other: object) -> bool:
        same = equal(self, other)
        return same if same is NotImplemented else not same

    named.__eq__, named.__ne__, named.__hash__ = equal, unequal, lambda self: hash((kind, keys(self)))
    named.__array_ufunc__ = None  # without this, an array of NumPy would compare its elements with the object
    named._compared = True
    return kind
