"""What a noun does by a layer above its own: `m.plot()`, `m.sound(path)`, its card in a notebook.

The method, with its arguments and its docstring, belongs to the noun; the function behind it belongs to a
layer that knows the noun. No module imports from a layer above its own: the front door says where each is.
"""

from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

#: By method: the module that has the function, which is loaded at the first call, and the function's name.
HOMES: dict[str, tuple[str, str]] = {}


@cache
def above(method: str) -> Callable[..., Any]:
    """The function behind a method."""
    module, name = HOMES[method]
    found: Callable[..., Any] = getattr(import_module(module), name)
    return found
