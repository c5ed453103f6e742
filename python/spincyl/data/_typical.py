"""Published coefficients of friction, rolling, losses, restitution and air, by materials."""

import csv
import textwrap
from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from itertools import islice
from typing import Any, NamedTuple

from spincyl.data._report import WIDE


class Typical(NamedTuple):
    """A published coefficient, or its range."""

    of: str  #: a law of loss or a contact with the name of its coefficient, or "restitution"
    pair: str  #: the two materials
    low: float  #: the coefficient, or the lower end of its range
    high: float  #: upper end of the range; equal to `low` for a single figure
    unit: str  #: unit of `from_si`; "" for a pure number
    sure: str  #: "handbook", "measured", "rule", "standard", or "order" for an order of magnitude
    source: str


class Table(tuple[Typical, ...]):
    """All rows; printed as a table with its sources."""

    __slots__ = ()

    def of(self, law: Any) -> "Table":
        """Return the rows of a law or contact, by class (``sc.loss.DryContour``) or name ("restitution")."""
        name = law if isinstance(law, str) else getattr(law, "__name__", "")
        found = Table(row for row in self if name and name in (row.of, row.of.split()[0]))
        if not found:
            known = ", ".join(dict.fromkeys(row.of.split()[0] for row in typical()))
            raise ValueError(f"law = {law!r}: not in the table; expected one of {known}")
        return found

    def __repr__(self) -> str:
        cells = [(row.of, _number(row), row.pair, row.source.split(": ")[0]) for row in self]
        wide = [max(map(len, column)) for column in zip(*cells, strict=True)]
        lines = ["  ".join(x.ljust(w) for x, w in zip(row, wide, strict=True)).rstrip() for row in cells]
        told = {row.source for row in self}
        if any(row.sure == "order" for row in self):
            lines.append("~: only an order of magnitude")
        for source in sorted(told):
            lines += textwrap.wrap(source, WIDE, subsequent_indent="  ")
        return "\n".join(lines)


def _number(row: Typical) -> str:
    ends = dict.fromkeys(f"{x:.4g}" for x in (row.low, row.high))
    return f"{'~' * (row.sure == 'order')}{' to '.join(ends)} {row.unit}".rstrip()


def _read(name: str) -> Iterator[list[str]]:
    """The rows of a file of this package, without its head."""
    text = files(__package__).joinpath(name).read_text("utf-8")
    return islice(csv.reader(text.splitlines(), delimiter=";"), 1, None)


@cache
def typical() -> Table:
    """The table, from its files."""
    sources = {key: f"{key}: {source}" for key, source in _read("sources.csv")}
    return Table(
        Typical(of, pair, float(low), float(high), unit, sure, sources[key])
        for of, pair, low, high, unit, sure, key in _read("typical.csv")
    )
