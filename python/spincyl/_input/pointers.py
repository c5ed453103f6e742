"""C functions as arguments, from numba, ctypes or SciPy: their signatures and addresses."""

import re
from collections.abc import Callable
from typing import Any, NamedTuple

#: Signatures of C functions: of a couple, from theta, w1, w2, w3, normal, and of a coefficient of friction.
COUPLE, FRICTION = "void (const double *args, double *couple)", "double (double speed)"


class Pointer(NamedTuple):
    """A C function: its address, and a function of ctypes that calls it from Python."""

    address: int
    call: Callable[..., Any]


def pointer(function: object, told: str) -> Pointer | None:
    """C function of a numba, ctypes or SciPy object, or None; TypeError if the signature is not `told`."""
    import ctypes

    void, number, several = None, ctypes.c_double, ctypes.POINTER(ctypes.c_double)
    result, arguments = (void, (several, several)) if told == COUPLE else (number, (number,))
    kinds: Any = ctypes
    given: Any = function
    if hasattr(given, "user_data"):  # scipy.LowLevelCallable
        if given.user_data is not None:
            raise TypeError(f"function: expected a C function {told}, which takes no user_data")
        given = given.function
    given = getattr(given, "ctypes", given)  # of numba.cfunc
    if type(given).__name__ == "PyCapsule":
        name = kinds.pythonapi.PyCapsule_GetName
        name.restype, name.argtypes = ctypes.c_char_p, [ctypes.py_object]
        at = kinds.pythonapi.PyCapsule_GetPointer
        at.restype, at.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
        said = name(given) or b""
        if _types(said.decode()) != _types(told):
            raise TypeError(f"function: expected a C function {told}, not {said.decode()!r}")
        address = at(given, said)
    elif isinstance(given, kinds._CFuncPtr):
        own = given.restype, tuple(given.argtypes or ())
        if own != (result, arguments) or given._flags_ & kinds._FUNCFLAG_PYTHONAPI:
            names = [getattr(kind, "__name__", "None") for kind in (own[0], *own[1])]
            seen = f"restype {names[0]} and argtypes ({', '.join(names[1:])})"
            raise TypeError(f"function: expected a C function {told}, not one with {seen}")
        address = ctypes.cast(given, ctypes.c_void_p).value
    else:
        return None
    if not address:
        raise TypeError(f"function: expected a C function {told}, not a null pointer")
    return Pointer(address, ctypes.CFUNCTYPE(result, *arguments)(address))


def _types(told: str) -> str:
    """The types in a C signature: the text without names of arguments, spaces and `const`."""
    return re.sub(r"const|\s|(?<=[*e ])(?:args|couple|speed)\b", "", told)
