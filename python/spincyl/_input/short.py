"""Arrays that are shorter than requested, whose printed shape gives the reason."""

from typing import Any

import numpy as np

from spincyl._input.numbers import Floats


class _Told(tuple[int, ...]):
    """A shape that is printed with a reason."""

    why = ""

    def __str__(self) -> str:
        return f"{tuple(self)} ({self.why})"


class Short(np.ndarray):
    """An array that is shorter than requested; an attempt to plot it against more times gives the reason.

    Matplotlib's error then prints `shape`.
    """

    why = ""

    def __array_finalize__(self, of: Any) -> None:
        self.why = getattr(of, "why", "")

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        return array[()] if return_scalar else super().__array_wrap__(array, context, return_scalar)

    @property  # type: ignore[misc]
    def shape(self) -> tuple[int, ...]:
        """Shape of the array, printed with the reason."""
        told = _Told(np.ndarray.shape.__get__(self))
        told.why = self.why
        return told

    def __reduce__(self) -> Any:  # a file needs no reason
        return np.asarray(self).__reduce__()


Short.__name__ = "array"  # which is printed


def short(values: Floats, why: str) -> Floats:
    """The same numbers, with the reason why the array is short."""
    found = values.view(Short)
    found.why = why
    return found


def alike(values: Floats, other: Floats) -> Floats:
    """The same numbers, with the reason of another array, if any."""
    return short(values, other.why) if isinstance(other, Short) else values
