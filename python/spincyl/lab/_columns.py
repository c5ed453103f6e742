"""Columns of a table, whose names in the file contain their units."""

import cmath
import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from spincyl._input.equality import equality_key
from spincyl._input.numbers import Floats, reals

#: Words that are units when they stand alone.
UNITS = frozenset(
    (
        "s",
        "ms",
        "min",
        "m",
        "cm",
        "mm",
        "in",
        "px",
        "°",
        "deg",
        "degrees",
        "rad",
        "radians",
        "hz",
        "1/s",
        "rad/s",
    )
)

#: Units of lengths and of times in the names of columns; a column without one is in metres or seconds.
METRES = {"": 1.0, "m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "inch": 0.0254, "ft": 0.3048}
SECONDS = {"": 1.0, "s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "min": 60.0}


def cleaned(name: str) -> tuple[str, str]:
    """Return the name of a column without comment marks and quotes, and its unit ("" if it has none).

    "# degrees" is "degrees"; "t (s)", "t [s]" and "t / s" are "t" in "s".
    """
    bare = name.strip(" \t\ufeff\xa0#%\"'") or name.strip()
    # a unit in brackets at the end; brackets that begin with a digit hold no unit
    begin = max(bare.rfind("("), bare.rfind("["))
    plain, unit = bare[: max(begin, 0)].rstrip(), bare[begin + 1 : -1]
    if plain and bare[-1] in ")]" and unit and not unit[0].isdecimal() and not set(unit) & set(")]"):
        return plain, unit.strip()
    name, stroke, unit = bare.rpartition(" / ")
    return (name.strip(), unit.strip()) if stroke and unit.strip().lower() in UNITS else (bare, "")


class Camera(NamedTuple):
    """Axes and scale of a film: they convert a place on the table to a pixel of the picture."""

    x: float  #: pixel at the origin, to the right from the upper left corner
    y: float  #: the same, down
    scale: float  #: pixels per unit of length
    degrees: float  #: angle of the x axis, counterclockwise

    def pixels(self, place: Any) -> Any:
        """Convert places x + iy on the table to pixels x + iy of the picture, whose y points downward."""
        flat = self.scale * place * cmath.exp(1j * math.radians(self.degrees))
        return complex(self.x, self.y) + np.conj(flat)


class Columns(dict[str, Floats]):
    """Dict of columns of numbers; each has two keys, its name without the unit and its full name in the file.

    Attributes
    ----------
    units : dict
        Unit of each column, by its name, as the file gives it in brackets; "" if there is none. The numbers
        are not converted.
    texts : dict
        Columns of text, such as the names of students: tuples of str, as long as the columns of numbers.
    camera : Camera or None
        For a track of a Tracker project with fixed axes: the pixel at the origin (x to the right and y
        down from the upper left corner), the pixels per unit of length, and the angle of the x axis in
        degrees, counterclockwise.
    """

    camera: "Camera | None" = None

    def __init__(
        self,
        columns: Iterable[tuple[str, Floats]] = (),
        texts: Iterable[tuple[str, tuple[str, ...]]] = (),
    ) -> None:
        try:
            pairs = [(name, values) for name, values in columns]
        except (TypeError, ValueError):
            what = type(columns).__name__
            raise TypeError(f"columns: expected pairs (name, array), not {what}") from None
        for name, _ in pairs:
            if not isinstance(name, str):
                raise TypeError(f"columns: expected names of type str, not {type(name).__name__}")
        bare = [cleaned(name) for name, _ in pairs]
        self.units: dict[str, str] = {}
        self._written: dict[str, str] = {}
        names, given = Counter(name for name, _ in bare), {name for name, _ in pairs}
        for (written, values), (name, unit) in zip(pairs, bare, strict=True):
            if written in self._written:
                raise ValueError(f"columns: two columns are called {written!r}")
            # keep the written name if two columns differ only in unit, or if the bare name is another
            # column's
            if names[name] > 1 or not name or (name != written and name in given):
                name = written
            self[name] = values
            self.units[name] = unit
            self._written[written] = name
        self.texts: dict[str, tuple[str, ...]] = {cleaned(name)[0]: cells for name, cells in texts}

    def __missing__(self, name: object) -> Floats:
        if name in self._written:
            return self[self._written[str(name)]]
        if name in self.texts:
            raise KeyError(f"{name!r}: a column of text, not of numbers; its cells are in .texts[{name!r}]")
        raise KeyError(f"{name!r}: no such column; expected one of {', '.join(map(repr, self))}")

    def __contains__(self, name: object) -> bool:
        return super().__contains__(name) or name in self._written

    def get(self, name: str, default: Any = None) -> Any:
        """Return the column of this name, or `default`."""
        try:
            return self[name]
        except KeyError:
            return default

    def __eq__(self, other: object) -> bool:
        """Whether names (in any order), numbers (NaN equal to NaN), units and texts are the same."""
        if not isinstance(other, Mapping):
            return NotImplemented
        same = dict(self).keys() == dict(other).keys() and equality_key(dict(self)) == equality_key(
            dict(other)
        )
        own = (self.units, self.texts)
        return same and (not isinstance(other, Columns) or own == (other.units, other.texts))

    def __ne__(self, other: object) -> bool:
        return not self == other

    __hash__ = None  # unhashable, like a dict


def columns_of(name: str, table: Any) -> Columns:
    """The columns of a table: a dict, a DataFrame with its named index, or a structured array of NumPy.

    An error names the argument `name`.
    """
    if isinstance(table, Columns):
        return table
    if getattr(getattr(table, "index", None), "name", None) is not None and hasattr(table, "reset_index"):
        table = table.reset_index()  # a named index of pandas is a column
    fields = getattr(getattr(table, "dtype", None), "names", None)
    listed = table.keys() if hasattr(table, "keys") else fields or getattr(table, "columns", None)
    if listed is None:
        raise TypeError(f"{name}: expected a dict of columns, not {type(table).__name__}")
    units = getattr(table, "attrs", {}).get("units", {})  # as `Motion.to_dataframe` has them
    bare = None, "", "1"
    given = {key: str(key) if units.get(key) in bare else f"{key} ({units[key]})" for key in list(listed)}
    return Columns((written, table[key]) for key, written in given.items())


class Picked(NamedTuple):
    """A column picked from a table: its name, its numbers, and the factor that converts them to SI."""

    key: str  #: its name
    values: Floats  #: numbers in the unit of the table
    factor: float  #: the unit in SI

    @property
    def in_si(self) -> Floats:
        """The numbers of the column, converted to SI."""
        return self.values * self.factor


def picked(
    told: str, columns: Columns, names: Sequence[str], units: Mapping[str, float], *, wide: bool = False
) -> Picked:
    """The first of the columns `names` that a table has, of the shape (n,), or (n, k) if `wide`.

    An error begins with `told`, and lists the columns if the table has none of these.
    """
    key = next((k for k in names if k in columns), None)
    if key is None:
        others = f" (or {', '.join(map(repr, names[1:]))})" if len(names) > 1 else ""
        there = ", ".join(map(repr, columns)) or "none"
        raise ValueError(f"{told}: expected a column {names[0]!r}{others}; the table has {there}")
    unit = columns.units[key]
    if unit not in units:
        known = ", ".join(u for u in units if u)
        raise ValueError(f"{told}: unit {unit!r} of the column {key}: expected one of {known}")
    values = np.asarray(reals(f"{told}[{key!r}]", columns[key]), np.float64)
    if values.ndim != 1 + wide:
        raise ValueError(f"{told}: expected columns of equal length; {key} has {values.shape}")
    return Picked(key, values, units[unit])
