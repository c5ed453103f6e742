"""Methods whose function is in a layer above their class: `m.plot()`, `m.sound(path)`, cards in a notebook.

The method, with its arguments and docstring, belongs to the class; the function behind it stands in a layer
that imports the class. Since no module imports from a layer above its own, `spincyl/__init__.py` lists them.
"""

from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

#: Module and name of the function behind each method; the module is loaded at the first call.
HOMES: dict[str, tuple[str, str]] = {}


@cache
def function_of_method(method: str) -> Callable[..., Any]:
    """Return the function behind a method, whose name is a key of `HOMES`, such as "Motion.plot"."""
    module, name = HOMES[method]
    found: Callable[..., Any] = getattr(import_module(module), name)
    return found
