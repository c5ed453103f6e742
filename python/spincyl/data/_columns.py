"""Tables as people write them: their encoding is found out, and the names of columns are told from units."""

import re
from collections.abc import Iterable
from typing import Any

from spincyl._array import Floats

#: A name, and a unit in brackets at its end: "t (s)", "x [cm]". What begins with a digit is no unit.
_UNIT = re.compile(r"^(?P<name>.*\S)\s*[(\[](?P<unit>[^()\[\]\d][^()\[\]]*)[)\]]$")
#: What is a unit where it stands alone.
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
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")


def decoded(raw: bytes, name: str) -> str:
    """The text of a file: UTF-16 or UTF-8 with its mark or without, else Windows-1252."""
    if raw[:2] in _UTF_16:
        try:
            return raw.decode("utf-16")
        except UnicodeDecodeError as e:
            raise ValueError(f"{name}: its UTF-16 is torn at byte {e.start} of {len(raw)}") from None
    if raw[:4] == b"PK\x03\x04":
        raise ValueError(f"{name}: a workbook or a zip file, not text; export it as CSV")
    if b"\0" in raw[:1000]:
        raise ValueError(f"{name}: not text; export it as CSV")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("cp1252", errors="replace")
    return text.replace("\u2212", "-")  # the minus sign of typesetters


def cleaned(name: str) -> tuple[str, str]:
    """The name of a column without marks of a comment, quotes and unit; and the unit, or nothing.

    "# degrees" is "degrees"; "t (s)", "t [s]" and "t / s" are "t" in "s".
    """
    bare = name.strip(" \t\ufeff\xa0#%\"'") or name.strip()
    found = _UNIT.match(bare)
    if found:
        return found["name"], found["unit"].strip()
    name, stroke, unit = bare.rpartition(" / ")
    return (name.strip(), unit.strip()) if stroke and unit.strip().lower() in UNITS else (bare, "")


class Columns(dict[str, Floats]):
    """Columns of numbers by their names without units; a name as the file has it is understood, too.

    Attributes
    ----------
    units : dict
        By name, the unit that the file gives in brackets: "" where there is none. No number is converted.
    """

    def __init__(self, columns: Iterable[tuple[str, Floats]] = ()) -> None:
        columns = list(columns)
        bare = [cleaned(name) for name, _ in columns]
        self.units: dict[str, str] = {}
        self._written: dict[str, str] = {}
        names = [name for name, _ in bare]
        for (written, values), (name, unit) in zip(columns, bare, strict=True):
            if names.count(name) > 1 or not name:  # "x (cm)" beside "x (m)"
                name = written
            self[name] = values
            self.units[name] = unit
            self._written[written] = name

    def __missing__(self, name: object) -> Floats:
        if name in self._written:
            return self[self._written[str(name)]]
        raise KeyError(f"{name!r}: expected one of {', '.join(map(repr, self))}")

    def __contains__(self, name: object) -> bool:
        return super().__contains__(name) or name in self._written

    def get(self, name: str, default: Any = None) -> Any:
        """The column of this name, or `default`."""
        try:
            return self[name]
        except KeyError:
            return default
