"""Published coefficients of friction, rolling, losses, restitution and air, by materials."""

import csv
import textwrap
from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from itertools import islice
from typing import Any, NamedTuple

from spincyl.lab._report import WIDE

_FAR = 10.0  #: A coefficient beyond the typical ones by this factor causes a warning.


class Typical(NamedTuple):
    """A row of `loss.typical`: a published coefficient, or a range of published coefficients."""

    of: str  #: name of the law and of its coefficient, or "restitution"
    pair: str  #: the two materials
    low: float  #: the coefficient, or the lower end of its range
    high: float  #: upper end of the range; equal to `low` for a single figure
    unit: str  #: unit of `from_si`; "" for a pure number
    sure: (
        str  #: "handbook", "measured", "rule", "standard", or "order" if only the order of magnitude is known
    )
    source: str


class Table(tuple[Typical, ...]):
    """All rows of published coefficients; it prints as a table with the sources."""

    __slots__ = ()

    def of(self, law: Any) -> "Table":
        """Return the rows of one law, given by its class (``sc.loss.DryContour``) or name ("restitution")."""
        name = law if isinstance(law, str) else getattr(law, "__name__", "")
        found = Table(row for row in self if name and name in (row.of, row.of.split()[0]))
        if not found:
            known = ", ".join(dict.fromkeys(row.of.split()[0] for row in typical()))
            raise ValueError(f"law = {law!r}: not in the table; expected one of {known}")
        return found

    def __repr__(self) -> str:
        cells = [(row.of, _ends_in_words(row), row.pair, row.source.split(": ")[0]) for row in self]
        wide = [max(map(len, column)) for column in zip(*cells, strict=True)]
        lines = ["  ".join(x.ljust(w) for x, w in zip(row, wide, strict=True)).rstrip() for row in cells]
        told = {row.source for row in self}
        if any(row.sure == "order" for row in self):
            lines.append("~: only an order of magnitude")
        for source in sorted(told):
            lines += textwrap.wrap(source, WIDE, subsequent_indent="  ")
        return "\n".join(lines)


def _ends_in_words(row: Typical) -> str:
    ends = dict.fromkeys(f"{x:.4g}" for x in (row.low, row.high))
    return f"{'~' * (row.sure == 'order')}{' to '.join(ends)} {row.unit}".rstrip()


def _rows(name: str) -> Iterator[list[str]]:
    """The rows of a file of this package, without its head."""
    text = files(__package__).joinpath(name).read_text("utf-8")
    return islice(csv.reader(text.splitlines(), delimiter=";"), 1, None)


@cache
def typical() -> Table:
    """The table of all published coefficients, read from the files of the package."""
    sources = {key: f"{key}: {source}" for key, source in _rows("sources.csv")}
    return Table(
        Typical(of, pair, float(low), float(high), unit, sure, sources[key])
        for of, pair, low, high, unit, sure, key in _rows("typical.csv")
    )


def far_from_typical(losses: Any, scale: Any) -> str | None:
    """Text that says which coefficients of a fitted law or sum are probably in another unit.

    Empty if one of them is within a factor of 10 of the typical ones; None if no typical ones are known.
    """
    said = []
    for law in losses.laws:
        factor, unit = law._printed(scale)
        name, value = type(law).__name__, factor * law.coefficient
        rows = [row for row in typical() if row.of.split()[0] == name]
        if not unit or not rows:
            continue
        low, high = min(row.low for row in rows), max(row.high for row in rows)
        if low / _FAR <= value <= high * _FAR:
            return ""
        known = " to ".join(dict.fromkeys(f"{x:.2g}" for x in (low, high)))
        told = f"{law._parameter} = {value:.2g}{unit} is far from the typical {known}{unit} of {name}"
        said.append(f"{told} (sc.loss.typical): are the times in seconds, or does another law hold?")
    return said[0] if said else None
