"""Tables of numbers as Tracker and others export them; delimiter, decimal sign and encoding are found out."""

import csv
import math
import re
from os import PathLike
from pathlib import Path

import numpy as np

from spincyl._array import Floats
from spincyl.data._columns import UNITS, Columns, decoded

#: What Tracker separates columns with; spaces last, since names have them.
_DELIMITERS = ("\t", ";", ",", None)
#: What people write where there is no number, in small letters; "nan" is one to Python.
_MISSING = frozenset(
    (
        "",
        "na",
        "n/a",
        "#n/a",
        "n.a.",
        "n. a.",
        "k.a.",
        "k. a.",
        "-",
        "--",
        "---",
        "?",
        "none",
        "null",
        "missing",
    )
)


def read_table(path: str | PathLike[str]) -> Columns:
    """The columns of a text file: one line of names, and numbers below it.

    Parameters
    ----------
    path : path
        Separated by tabs, semicolons, commas or spaces, decimal point or comma, in any usual encoding: found
        out. Lines above the names are skipped.

    Returns
    -------
    Columns
        A dict by name of arrays of one length, NaN where a cell is empty or says "NA", "-" or the like. "t
        (s)", "t [s]" and "# t" are called "t"; `units` has the unit.

    Raises
    ------
    ValueError
        If it is no such table, naming the file and the line.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> import spincyl as sc
    >>> list(sc.data.read_table(sc.data.example("flicks")))
    ['degrees', 'hertz']
    """
    path = Path(path)
    try:
        tracks = _read(decoded(path.read_bytes(), str(path)), 1)
    except _Unreadable as e:
        raise ValueError(f"{path}: not a table: {e}") from None
    if len(tracks) > 1:
        raise ValueError(f"{path}: {len(tracks)} tracks: {', '.join(tracks)}; read_tracker reads them")
    (found,) = tracks.values()
    return found


def read_tracker(path: str | PathLike[str]) -> dict[str, Columns]:
    """The tracks of a text file that Tracker exported (File > Export > Data).

    Parameters
    ----------
    path : path
        One track (its name, a line of column names, numbers) or several ("#multi:", names above their
        columns). Separated by tabs, semicolons, commas or spaces, decimal point or comma: found out.

    Returns
    -------
    dict
        By track, by column: arrays of numbers of one length, NaN where a cell is empty. Columns before the
        first name of a track, such as t, belong to every one. A track without a name is called "track". A
        column "x (cm)" is called "x", and the `units` of its track say "cm".

    Raises
    ------
    ValueError
        If it is no such table, naming the file and the line; if its UTF-16 is torn, the byte.
    OSError
        If it cannot be read.

    Notes
    -----
    Tracker is the video analysis tool of Open Source Physics. Angles are in the unit that was chosen there.
    """
    path = Path(path)
    try:
        return _read(decoded(path.read_bytes(), str(path)), 2)
    except _Unreadable as e:
        raise ValueError(f"{path}: not a table of Tracker's: {e}") from None


class _Unreadable(ValueError):
    """Why a text is no table."""


def _read(text: str, least: int) -> dict[str, Columns]:
    """The tracks of a text, each of at least so many columns."""
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip()]
    several = len(lines)
    lines = [(i, line) for i, line in lines if not _is_marker(line)]
    several -= len(lines)
    lines = [(i, line) for i, line in lines if not re.match(r"\ufeff?sep=.\s*$", line)]  # Excel's
    kinds = [
        (delimiter, comma)
        for delimiter in _DELIMITERS
        if delimiter is None or delimiter in text
        for comma in (False, True)
        if not comma or ("," in text and (delimiter != "," or '"' in text))
    ]
    if lines:  # what cannot read the last line fails in the end: it is tried when all else has
        kinds.sort(key=lambda kind: _numbers(lines[-1][1], *kind) is None)
    why = ""
    for kind in kinds:
        first = next((k for k, (_, line) in enumerate(lines) if _numbers(line, *kind) is not None), None)
        if not first:
            continue
        delimiter, _ = kind
        units = []
        if first > 1 and all(
            x.strip("()[]").lower() in UNITS for x in _names(lines[first - 1][1], delimiter)
        ):
            units = _names(lines[first - 1][1], delimiter)
            first -= 1  # a line of units below the names
        columns = _names(lines[first - 1][1], delimiter)
        if units and len(units) == len(columns):
            columns = [f"{name} ({unit.strip('()[]')})" for name, unit in zip(columns, units, strict=True)]
        numbers = [_number(name) for name in columns]
        if len(columns) < least or all(numbers):
            continue
        if any(numbers):  # a line of numbers, of which one is none
            i, line = lines[first - 1]
            why = f"line {i} has something that is no number: {_shown(line)}"
            break
        above = _cells(lines[first - 2][1], delimiter) if first > 1 else []
        if not several and (delimiter is None or (first > 1 and not _over(above, columns))):
            # a name, whatever is in it
            above = [lines[first - 2][1].strip()] if first > 1 else []
        try:
            if several and delimiter is None:
                raise ValueError("several tracks between spaces cannot be told apart")
            rows = [(i, line) for i, line in lines[first + bool(units) :] if line.lstrip()[0] not in "#%"]
            return _tracks(above, columns, _table(rows, *kind, len(columns)))
        except ValueError as e:
            why = why or str(e)
    least_said = "" if least < 2 else f" of at least {least} columns"
    none = f"no line of column names right above a line of numbers{least_said}"
    if not lines:
        raise _Unreadable(f"it is empty: {none}")
    raise _Unreadable(why or f"{none}; the last line is {_shown(lines[-1][1])}")


def _is_marker(line: str) -> bool:
    return ":" in line and line.strip(" #;,\t").lower() == "multi:"


def _shown(line: str) -> str:
    """A line as a message has it."""
    line = line.strip()
    return repr(line if len(line) <= 60 else line[:60] + "...")


def _over(names: list[str], columns: list[str]) -> bool:
    """Whether names stand above columns: with gaps, since a track has more than one."""
    return len(names) > 1 and "" in names and len(names) <= len(columns)


def _split(line: str, delimiter: str | None) -> list[str]:
    """The cells of a line, those at its end not empty."""
    if delimiter is None:
        return line.split()
    if '"' not in line:
        return line.rstrip(delimiter + " ").split(delimiter)
    try:
        cells = next(csv.reader([line], delimiter=delimiter))
    except csv.Error:  # a cell of more than 131,072 characters keeps its quotes
        cells = line.split(delimiter)
    while cells and not cells[-1].strip():
        cells.pop()
    return cells


def _cells(line: str, delimiter: str | None) -> list[str]:
    return [cell.strip() for cell in _split(line, delimiter)]


def _names(line: str, delimiter: str | None) -> list[str]:
    """Names of columns; between spaces without the sign of a comment, and with their units."""
    if delimiter is None:
        line = re.sub(r"\s+(?=[(\[])", "\xa0", line.lstrip("#%\ufeff \t"))
        return [cell.replace("\xa0", " ") for cell in re.split(r"[ \t]+", line.strip())]
    return _cells(line, delimiter)


def _numbers(line: str, delimiter: str | None, comma: bool) -> list[float] | None:
    """The numbers of a line, NaN for an empty cell; None if something else is there, or nothing."""
    if "_" in line:  # which Python allows in numbers
        return None
    if comma and delimiter == ",":  # in quotes
        cells = [cell.replace(",", ".") for cell in _split(line, delimiter)]
    else:
        cells = _split(line.replace(",", ".") if comma else line, delimiter)
    try:
        found = [float(cell) if cell and not cell.isspace() else math.nan for cell in cells]
    except ValueError:
        try:
            known = [cell.strip().lower() for cell in cells]
            found = [math.nan if cell in _MISSING else float(cell) for cell in known]
        except ValueError:
            return None
        if all(cell in _MISSING for cell in known):
            return None
    return found if any(cells) and math.inf not in map(abs, found) else None


def _number(cell: str) -> bool:
    """Whether this is a number, with a point or a comma."""
    return _numbers(cell, None, True) is not None


def _missing(line: str, delimiter: str | None) -> list[float] | None:
    """A line that says of every column that there is no number."""
    cells = _split(line, delimiter)
    return [math.nan] * len(cells) if all(cell.strip().lower() in _MISSING for cell in cells) else None


def _table(lines: list[tuple[int, str]], delimiter: str | None, comma: bool, width: int) -> Floats:
    """(n, width) numbers of lines, NaN where a cell is empty or a line short."""
    plain = _plain([line for _, line in lines], delimiter, comma, width)
    if plain is not None:
        return plain
    table: list[list[float]] = []
    widest = 0
    for i, line in lines:
        numbers = _numbers(line, delimiter, comma)
        if numbers is None:
            numbers = _missing(line, delimiter)
        if numbers is None:
            raise ValueError(f"line {i} has something that is no number: {_shown(line)}")
        if len(numbers) > width:
            raise ValueError(f"line {i} has {len(numbers)} cells under {width} column names")
        table.append(numbers + [math.nan] * (width - len(numbers)))
        widest = max(widest, len(numbers))
    if delimiter is None and widest < width:  # between spaces no cell can be empty
        raise ValueError(f"{width} column names stand above {widest} numbers in line {lines[0][0]}")
    return np.array(table)


def _plain(lines: list[str], delimiter: str | None, comma: bool, width: int) -> Floats | None:
    """The same by NumPy's reader, five times faster; None if it finds anything unusual."""
    if comma and delimiter == ",":
        return None
    if comma:
        lines = [line.replace(",", ".") for line in lines]
    if delimiter is not None:  # every row of one width and every cell filled: NumPy knows no empty ones
        d, filled = delimiter, f"{delimiter}nan{delimiter}"
        lines = [line.rstrip(d + " ") for line in lines]
        if "" in lines:
            return None
        lines = [line + (width - 1 - line.count(d)) * d for line in lines]
        lines = [line.replace(d + d, filled).replace(d + d, filled) for line in lines]
        lines = [("nan" if line[0] == d else "") + line + ("nan" if line[-1] == d else "") for line in lines]
    quote = None if delimiter is None else '"'
    try:
        table = np.loadtxt(lines, delimiter=delimiter, quotechar=quote, comments=None, ndmin=2)
    except ValueError:
        return None
    return table if table.shape == (len(lines), width) and not np.isinf(table).any() else None


def _tracks(above: list[str], columns: list[str], table: Floats) -> dict[str, Columns]:
    names = [name.lstrip("#\ufeff \t").strip() for name in above]
    # a name alone is that of the only track
    starts = [(k if len(names) > 1 else 0, name) for k, name in enumerate(names) if name] or [(0, "track")]
    shared = range(starts[0][0])
    found = {}
    for (start, name), (stop, _) in zip(starts, [*starts[1:], (len(columns), "")], strict=True):
        own = [*shared, *range(start, stop)]
        if name in found:
            raise ValueError(f"two tracks are called {name!r}")
        if len({columns[k] for k in own}) < len(own):
            raise ValueError(f"two columns of {name!r} have one name")
        found[name] = Columns((columns[k], table[:, k]) for k in own)
    return found
