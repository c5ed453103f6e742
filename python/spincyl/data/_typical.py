"""Coefficients of friction, rolling, losses, restitution and air that others have published, by materials."""

import csv
import textwrap
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple

from spincyl.data._report import WIDE

#: Where a figure is from, by the name in the table.
_SOURCES = {
    "Alciatore": "D. G. Alciatore, billiards.colostate.edu, Physical properties: rolling resistance of 0.005"
    " to 0.015 of the radius, a spin that loses 5 to 15 rad/s in a second",
    "Beer": "Beer and Johnston, Vector Mechanics for Engineers: Statics, Wheel friction",
    "Bildsten": "the estimate of this library for the law of Bildsten, Phys. Rev. E 66, 056309 (2002)",
    "Cross": "R. Cross, Am. J. Phys. 84, 221 (2016): 1e-4 of the radius and more on hard surfaces",
    "ITF": "ITF Rules of Tennis: a ball that falls by 100 inches rebounds by 53 to 58",
    "ITTF": "ITTF Laws of Table Tennis 2.1.3: a ball that falls by 30 cm rebounds by 23",
    "Kilty": "K. T. Kilty, kilty.com/euler.htm (2000): a coin stops within a few seconds; fit_stop of 3 and"
    " 5 s from 30 and 60 degrees",
    "Marks": "Marks' Standard Handbook for Mechanical Engineers, Friction: clean and dry",
    "Moffatt": "H. K. Moffatt, Nature 404, 833 (2000): about 100 s; fit_stop of that from 20 to 60 degrees",
    "Newton": "I. Newton, Principia, Laws of motion, scholium: 15 to 16",
    "USBC": "USBC, Equipment specifications: the most that is allowed",
    "USSA": "U.S. Standard Atmosphere 1976, at sea level",
}


class Typical(NamedTuple):
    """A published coefficient, or its range."""

    of: str  #: a law of loss or a contact with the name of its coefficient, or "restitution"
    pair: str  #: of what on what
    low: float
    high: float  #: the same as `low` where there is one figure
    unit: str  #: that `from_si` reads; "" of a pure number
    sure: str  #: "handbook", "measured", "rule", "standard", or "order": of magnitude only
    source: str


class Table(tuple[Typical, ...]):
    """All rows; printed as a table with its sources."""

    __slots__ = ()

    def of(self, law: Any) -> "Table":
        """The rows of a law or contact, by class or name, as ``sc.loss.DryContour``, or of "restitution"."""
        name = law if isinstance(law, str) else getattr(law, "__name__", "")
        found = Table(row for row in self if name and name in (row.of, row.of.split()[0]))
        if not found:
            known = ", ".join(dict.fromkeys(row.of.split()[0] for row in typical()))
            raise ValueError(f"law = {law!r}: nothing is known of it; there is {known}")
        return found

    def __repr__(self) -> str:
        keys = dict(zip(_SOURCES.values(), _SOURCES, strict=True))
        cells = [(row.of, _number(row), row.pair, keys[row.source]) for row in self]
        wide = [max(map(len, column)) for column in zip(*cells, strict=True)]
        lines = ["  ".join(x.ljust(w) for x, w in zip(row, wide, strict=True)).rstrip() for row in cells]
        told = {keys[row.source]: row.source for row in self}
        if any(row.sure == "order" for row in self):
            told = {"~": "an order of magnitude, to begin with"} | told
        for key, source in sorted(told.items(), key=lambda pair: pair[0].lstrip("~")):
            lines += textwrap.wrap(f"{key}: {source}", WIDE, subsequent_indent="  ")
        return "\n".join(lines)


def _number(row: Typical) -> str:
    ends = dict.fromkeys(f"{x:.4g}" for x in (row.low, row.high))
    return f"{'~' * (row.sure == 'order')}{' to '.join(ends)} {row.unit}".rstrip()


@cache
def typical() -> Table:
    """The table, from its file."""
    text = files(__package__).joinpath("typical.csv").read_text("utf-8")
    rows = csv.DictReader(text.splitlines(), delimiter=";")
    return Table(
        Typical(
            row["of"],
            row["pair"],
            float(row["low"]),
            float(row["high"]),
            row["unit"],
            row["sure"],
            _SOURCES[row["source"]],
        )
        for row in rows
    )
