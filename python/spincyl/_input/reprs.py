"""Numbers as text: single numbers with all digits, arrays abridged as in NumPy."""

from typing import Any

import numpy as np

from spincyl._input.numbers import Reals, is_scalar

_FEW = 6


def repr_of_call(name: str, *plain: Reals, **named: Reals | str) -> str:
    """The text of a call of a constructor, which Python can evaluate unless an array was abridged."""
    words = [repr_of_numbers(x) for x in plain]
    words += [f"{key}={repr(x) if isinstance(x, str) else repr_of_numbers(x)}" for key, x in named.items()]
    line = f"{name}({', '.join(words)})"
    return line if len(line) <= 110 else f"{name}({(',' + chr(10) + ' ' * (len(name) + 1)).join(words)})"


def repr_of_numbers(value: Reals) -> str:
    """The text of a number with all digits, of a short array as a list, of a long one by ends and shape."""
    if isinstance(value, tuple):
        return f"({', '.join(map(repr_of_numbers, value))})"
    if is_scalar(value):
        return repr(float(value))
    kind = "array" if type(value) is np.ndarray else type(value).__name__
    if is_lazy(value):
        return f"<lazy {kind}, shape={tuple(value.shape)}>"
    values = value if isinstance(value, np.ndarray) else np.asarray(value)
    if values.size <= _FEW:
        listed = repr(values.astype(np.float64).tolist())
        return listed if kind == "array" else f"{kind}({listed})"
    first, last = (", ".join(map(_short_repr, ends)) for ends in (values.flat[:3], values.flat[-3:]))
    return f"{kind}([{first}, ..., {last}], shape={values.shape})"


def is_lazy(value: Any) -> bool:
    """Whether reading the numbers would start a computation, as for arrays of dask."""
    return getattr(value, "chunks", None) is not None


def _short_repr(x: Any) -> str:
    return "--" if x is np.ma.masked else repr(float(f"{x:.6g}"))
