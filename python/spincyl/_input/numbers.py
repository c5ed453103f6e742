"""Checks of arguments: numbers or arrays of real numbers; errors begin with the name of the argument."""

import math
import sys
import warnings
from collections.abc import Callable, Iterable, Sequence
from functools import wraps
from inspect import signature
from numbers import Real
from types import ModuleType
from typing import Any, ParamSpec, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from spincyl._input.hints import install_command, raise_with_proposal, why_no_numbers

#: A number or an array of numbers; NumPy, pandas, xarray and dask arrays keep their kind.
Reals: TypeAlias = Any
#: What an elementwise function returns: a number for numbers, else an array of the inputs' kind.
Result: TypeAlias = Any
Floats = NDArray[np.float64]
_Kind = TypeVar("_Kind")
_Given = ParamSpec("_Given")
_Found = TypeVar("_Found")


def reals(name: str, value: Reals) -> Reals:
    """`value` as numbers that NumPy's ufuncs take, or TypeError naming the argument."""
    if type(value) is float:
        return value
    if type(value) is not np.ndarray and is_quantity(value):
        value = _magnitude(name, value, "radian", "a number in natural units, or an angle")
    if type(value).__module__.startswith("polars."):  # which has dtypes of its own
        value = value.to_numpy()
    array = value if hasattr(value, "__array_ufunc__") else _ndarray(name, value)
    kinds = _dtypes(array)
    if kinds is None:  # pandas.NA supports ufuncs, but is no number
        raise TypeError(f"{name}: expected real numbers, not {type(value).__name__}")
    for dtype in kinds:
        if getattr(dtype, "kind", "O") in "US":
            raise TypeError(f"{name}: expected real numbers, not texts; {why_no_numbers(value)}")
        if getattr(dtype, "kind", "O") not in "biuf" or dtype.itemsize > 8:
            raise TypeError(f"{name}: expected real numbers of at most double precision, not {dtype}")
    if type(array) is np.ndarray and array.ndim > 31:  # NumPy takes 32, and a law may need one for itself
        raise ValueError(f"{name}: expected at most 31 dimensions, not {array.ndim}")
    return float(array) if type(array) is np.ndarray and array.ndim == 0 else array


def radians(name: str, value: Reals, expected: str | None = None, likely: float = math.pi) -> Reals:
    """Return an angle in radians; above pi (probably degrees) ValueError, in an array NaN and a warning.

    Between `likely` and pi there is only a warning. The values of a lazy array are not computed.
    """
    if type(value) is float and abs(value) <= likely:
        return value
    found = _read(name, value, "radian") if isinstance(value, str) else reals(name, value)
    if is_scalar(found):
        one = float(found)
        if math.pi < abs(one) < math.inf:
            if_degrees = f"; {one:g} degrees are np.radians({one:g}) or '{one:g}deg'"
            raise ValueError(
                f"{name} = {one!r}: expected {expected or f'-pi <= {name} <= pi'} (radians){if_degrees}"
            )
        if likely < abs(one) < math.inf:
            _doubted(name, one)
        return found
    if getattr(found, "chunks", None) is not None:
        return found
    numbers = floats(found)
    top = np.fmax.reduce(numbers, axis=None, initial=0.0), np.fmin.reduce(numbers, axis=None, initial=0.0)
    if max(top[0], -top[1]) <= likely:
        return found
    size = np.abs(numbers)
    odd = (size > likely) & (size < math.inf)
    if odd.any():
        _doubted(name, float(numbers[odd].flat[0]))
    beyond = odd & (size > math.pi)
    return found + np.where(beyond, np.nan, 0.0) if beyond.any() else found


def _doubted(name: str, value: float) -> None:
    told = f"{name} = {value:.6g} rad is {math.degrees(value):.4g} degrees"
    warn(f"{told}: are these degrees? np.radians converts degrees to radians")


def warn(why: str, kind: type[Warning] = UserWarning) -> None:
    """Issue a warning that points at the line that called this library."""
    level, frame = 1, sys._getframe()
    # functions of this library run inside xarray when it applies them to plain arrays
    within = "spincyl.", "xarray."
    while frame.f_back and str(frame.f_globals.get("__name__")).startswith(within):
        level, frame = level + 1, frame.f_back
    warnings.warn(why, kind, stacklevel=level)


def _compact_copy(value: Any) -> Any:
    """A copy of an array in which an axis of repeated numbers (stride 0) takes no memory."""
    if not isinstance(value, np.ndarray) or 0 not in value.strides:
        return value.copy()
    once = value[tuple(slice(None if step else 1) for step in value.strides)].copy()
    return np.broadcast_to(once, value.shape)


def read_only_copy(value: Reals) -> Reals:
    """`value` for storage in a field: a copy that the caller cannot change, read-only if possible.

    A lazy array needs no copy, since it cannot be changed.
    """
    if type(value) is float or isinstance(value, np.generic) or not hasattr(value, "copy"):
        return value
    if getattr(value, "chunks", None) is not None:
        return value
    own = _compact_copy(value)
    array = getattr(own, "data", own) if hasattr(own, "dims") else own
    if isinstance(array, np.ndarray):
        array.setflags(write=False)
    return own


def is_quantity(value: object) -> bool:
    """Whether `value` is a quantity of pint, without importing pint."""
    return hasattr(type(value), "m_as")


def si(name: str, value: Reals, unit: str) -> Reals:
    """Convert a number, a text such as "120mm" or a quantity to the SI unit of the name `unit`."""
    if isinstance(value, str):
        return _read(name, value, unit)
    return _magnitude(name, value, unit, f"a number or a quantity in {unit}") if is_quantity(value) else value


def metres(measures: dict[str, Any]) -> dict[str, float]:
    """Convert single lengths, given by name, to a dict of numbers in metres."""
    return {name: number(name, si(name, x, "metre")) for name, x in measures.items()}


def lengths_in_metres(name: str, value: Any) -> tuple[Any, bool]:
    """Return lengths, in metres if one of them is a text with a unit, and whether there is such a text."""
    listed = not isinstance(value, dict) and isinstance(value, Sequence)
    named = {f"{name}[{i}]": x for i, x in enumerate(value)} if listed else value
    if not isinstance(named, dict) or not any(isinstance(x, str) for x in named.values()):
        return value, False
    found = metres(named)
    refuse_mixed_units(named)
    return [*found.values()] if listed else found, True


def vector_in(unit: str, name: str, value: Reals) -> Reals:
    """Return a vector in the SI unit `unit`; each component in a list may be a text or a quantity."""
    if isinstance(value, list | tuple):
        return [vector_in(unit, f"{name}[{i}]", x) for i, x in enumerate(value)]
    return radians_per_second(name, value) if unit == "radian/second" else si(name, value, unit)


def refuse_mixed_units(measures: dict[str, Any]) -> None:
    """Raise ValueError if some lengths are texts with a unit and others bare numbers of unknown unit."""
    bare = [(name, x) for name, x in measures.items() if isinstance(x, Real) and x != 0]
    if bare and any(isinstance(x, str) for x in measures.values()):
        name, x = bare[0]
        raise ValueError(
            f"{name} = {x!r}: expected a text with a unit; give units to all lengths, or to none"
        )


def turns_per_second(name: str, value: Reals) -> Reals:
    """A frequency in hertz; a quantity with an angle per time is converted to turns per second."""
    if isinstance(value, str):
        return _read(name, value, "hertz")
    if not is_quantity(value):
        return value
    unit = "turn/second" if "radian" in dict(value.to_root_units().unit_items()) else "hertz"
    return _magnitude(name, value, unit, "turns per second")


def radians_per_second(name: str, value: Reals) -> Reals:
    """An angular velocity in rad/s; a quantity in hertz is taken as turns per second."""
    if isinstance(value, str):
        return _read(name, value, "radian/second")
    return 2 * np.pi * turns_per_second(name, value) if is_quantity(value) else value


def _read(name: str, text: str, unit: str) -> float:
    """Convert a text such as "120mm" to a number in the SI unit `unit`; an error names the argument."""
    from argparse import ArgumentTypeError

    from spincyl._input import units

    try:
        return units.number_in_si(text, unit)
    except (ArgumentTypeError, TypeError) as e:
        kind = TypeError if isinstance(e, TypeError) else ValueError
        raise kind(f"{name}: {e}") from None


def _magnitude(name: str, value: Any, unit: str, expected: str) -> Reals:
    try:
        return value.m_as(unit)
    except TypeError:  # includes pint's error about dimensions
        raise TypeError(f"{name}: expected {expected}, not {value.units}") from None


def _ndarray(name: str, value: object) -> NDArray[Any]:
    try:
        return np.asarray(value)
    except (ValueError, TypeError) as e:  # a ragged list, or a list of quantities
        raise TypeError(f"{name}: expected real numbers, not {type(value).__name__} ({e})") from None


def _dtypes(array: Any) -> Any:
    """The dtypes of an array or of a table; None if `array` has none."""
    return [array.dtype] if hasattr(array, "dtype") else getattr(array, "dtypes", None)


def keywords(law: np.ufunc, given: dict[str, Any], of: str = "") -> dict[str, Any]:
    """Check the keywords of a ufunc for the method `of`; an unsuitable `out` or `where` raises an error.

    A labelled `where` raises TypeError, since pandas and xarray would ignore its labels.
    """
    for word in given:
        if word not in ("out", "where", "casting", "order", "dtype", "subok", "signature"):
            raise TypeError(f"{of or law.__name__}() got an unexpected keyword argument {word!r}")
    out = given.get("out")
    if isinstance(out, tuple) and len(out) != 1:
        raise TypeError(f"out: expected one array to fill, not {len(out)}")
    for array in out if isinstance(out, tuple) else (out,):
        if array is None:
            continue
        if isinstance(array, np.ndarray) and not array.flags.writeable:
            raise ValueError("out: expected an array to fill, not a read-only array")
        kinds = _dtypes(array) if hasattr(array, "__array_ufunc__") else None
        if kinds is None:
            raise TypeError(f"out: expected an array to fill, not {type(array).__name__}")
        for dtype in kinds:
            own = law.resolve_dtypes((np.dtype(np.float64),) * law.nin + (None,))[-1]
            casting = given.get("casting", "same_kind")
            # NumPy would write numbers into an array of texts, truncated to its width
            fits = (
                dtype.kind not in "SUmM" and np.can_cast(own, dtype, casting)
                if isinstance(dtype, np.dtype)
                else True
            )
            if not fits:
                raise TypeError(f"out: {law.__name__} gives {own}, which {dtype} cannot hold")
    if "where" in given:
        where = given["where"]
        where = _ndarray("where", where) if isinstance(where, list | bool | np.bool_) else where
        plain = isinstance(where, np.ndarray) and not isinstance(where, np.ma.MaskedArray)
        if not (plain or hasattr(where, "dask")) or hasattr(where, "dims") or where.dtype != np.bool_:
            kind = getattr(where, "dtype", "") if plain else ""
            what = f"{type(where).__name__} {kind}".rstrip()
            raise TypeError(f"where: expected True, False or a NumPy array of bool, not {what}")
    return given


def floats(value: Reals) -> Floats:
    """`value` as contiguous, aligned doubles, as compiled functions need it; copied only if necessary.

    An array from a file, a network or another process may be unaligned. Masked values become NaN.
    """
    own = type(value) is np.ndarray and value.dtype == np.float64
    if own and value.flags.c_contiguous and value.flags.aligned:
        return value  # type: ignore[no-any-return]  # NumPy's checks take ten times as long
    value = np.array(value) if type(value) is float else value
    if isinstance(value, np.ma.MaskedArray):
        value = np.ma.filled(value.astype(np.float64), np.nan)
    array: Floats = np.require(value, np.float64, ["C", "A", "E"])
    return array


def in_columns(values: Iterable[Reals], shape: tuple[int, ...]) -> list[Floats]:
    """`values` as columns of one length for compiled functions; single numbers stay columns of length 1."""
    found = [floats(x if np.size(x) == 1 else np.broadcast_to(floats(x), shape)).reshape(-1) for x in values]
    if math.prod(shape) != 1 and all(x.size == 1 for x in found):
        found[0] = np.full(math.prod(shape), found[0][0])
    return found


def is_scalar(*values: Reals) -> bool:
    """Whether all values are single numbers."""
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


def common_shape(named: dict[str, Reals]) -> tuple[int, ...]:
    """The common shape of unlabelled arrays by broadcasting, or ValueError with the names and shapes."""
    shapes = {name: np.shape(x) for name, x in named.items() if not hasattr(x, "dims")}
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        told = ", ".join(f"{name} {shape}" for name, shape in shapes.items() if shape)
        raise ValueError(f"shapes do not fit: {told}") from None


def elementwise(law: Callable[_Given, _Found]) -> Callable[_Given, _Found]:
    """Decorator for functions that broadcast their arguments: an error about shapes names the arguments.

    Overflow gives inf and invalid operations give NaN, without warnings, as in the core.
    """

    @wraps(law)
    def quiet(*args: _Given.args, **named: _Given.kwargs) -> _Found:
        try:
            with np.errstate(all="ignore"):
                return law(*args, **named)
        except ValueError:
            given = signature(law).bind(*args, **named).arguments
            if "self" in given:
                own = given.pop("self")
                given[type(own).__name__] = own
            common_shape({name: with_common_shape(x) for name, x in given.items()})
            raise
        except TypeError as e:
            raise_with_proposal(law, named, e)
            raise

    return quiet


def with_common_shape(*values: Any) -> Reals:
    """An array of zeros in the common shape of numbers, bodies and states; 0 if there is no such shape."""
    fields: list[Any] = []
    for value in values:
        own = next((getattr(value, x) for x in ("_raw", "_numbers", "_coefficients") if hasattr(value, x)), 0)
        fields += own if isinstance(own, tuple | list) else (value,)
    if any(hasattr(x, "dims") for x in fields):
        return 0.0
    try:
        return np.broadcast_to(0.0, np.broadcast_shapes(*map(np.shape, fields)))
    except (ValueError, RuntimeError):  # a ragged list, or too many dimensions: the error to come is clearer
        return 0.0


def refuse_bad_value(name: str, value: Reals, bad: Callable[[Any], Any], expected: str) -> None:
    """Raise ValueError that names the first value for which `bad` is true; lazy arrays are not computed."""
    if getattr(value, "chunks", None) is not None:
        return
    numbers = np.asarray(value, np.float64)
    wrong = np.asarray(bad(numbers))
    if wrong.any():
        first = float(np.broadcast_to(numbers, wrong.shape)[wrong].flat[0])
        raise ValueError(f"{name} = {first!r}: {expected}")


def in_range(name: str, value: object, low: float, high: float, unit: str = "") -> float:
    """Return a number between `low` and `high`, or raise an error that names the argument."""
    found = number(name, si(name, value, "radian") if unit == "radians" else value)
    if not low <= found <= high:
        raise ValueError(f"{name} = {found!r}: expected {low:g} to {high:g}{unit and f' ({unit})'}")
    return found


def instance_of(name: str, value: object, kind: type[_Kind]) -> _Kind:
    """Return `value` if it is an instance of `kind`, else raise TypeError naming the argument."""
    if not isinstance(value, kind):
        like = f"{'an' if kind.__name__[0] in 'AEIO' else 'a'} {kind.__name__}"
        raise TypeError(f"{name}: expected {like}, not {type(value).__name__}")
    return value


def one_of(name: str, value: Any, known: Sequence[object]) -> Any:
    """Return `value` if it is one of `known`, else raise ValueError naming the argument."""
    if not (value is None or isinstance(value, str | int | float | np.integer)) or value not in known:
        *most, last = map(repr, known)
        raise ValueError(f"{name} = {value!r}: expected {', '.join(most)} or {last}")
    return value


def known_words(
    name: str, value: str | Iterable[str], known: Sequence[str], hint: Callable[[str], str] = lambda _: ""
) -> tuple[str, ...]:
    """One or several of the known words, as a tuple, or an error naming the argument, with a `hint`."""
    try:
        found = (value,) if isinstance(value, str) else tuple(value)
    except TypeError:
        raise TypeError(
            f"{name}: expected one of {list(known)} or several, not {type(value).__name__}"
        ) from None
    for word in found:
        if not isinstance(word, str) or word not in known:
            raise ValueError(f"{name} = {word!r}: expected some of {list(known)}{hint(str(word))}")
    return found


def flag(name: str, value: object) -> bool:
    """True or False, or TypeError naming the argument."""
    if not isinstance(value, bool | np.bool_):
        raise TypeError(f"{name}: expected True or False, not {type(value).__name__}")
    return bool(value)


def numbered(most: int, *values: Reals, name: str = "root") -> tuple[Reals, ...]:
    """Return `values` with a new last axis each, and the numbers 0, 1, ... along this axis.

    For laws with up to `most` results. xarray broadcasts by name: there the new axis is called `name`.
    """
    named = next((v for v in values if hasattr(v, "dims")), None)
    if named is not None:
        return *values, type(named)(np.arange(float(most)), dims=name)
    spread = (
        v if is_scalar(v) else (v if hasattr(v, "dask") else np.asanyarray(v))[..., np.newaxis]
        for v in values
    )
    return *spread, np.arange(float(most))


def components(vectors: Reals) -> list[Reals]:
    """The components of vectors (..., n), each an array or a number."""
    return [vectors[..., i] for i in range(vectors.shape[-1])]


def optional_library(module: str, name: str) -> ModuleType:
    """An optional library, or ImportError naming the extra that installs it."""
    from importlib import import_module

    try:
        return import_module(module)
    except ImportError as e:
        how = install_command(f"'spincyl[{name}]'")
        raise ImportError(f"this needs {module.split('.', maxsplit=1)[0]}: {how}") from e


def json_value(value: Any) -> Any:
    """The value as JSON can hold it: lists for arrays and tuples, None for numbers that are not finite."""
    if isinstance(value, dict):
        return {key: json_value(x) for key, x in value.items()}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [json_value(x) for x in value]
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    return value
