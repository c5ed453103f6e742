"""Tables of tracks that Tracker exports, with delimiter, decimal sign and encoding found out."""

import csv
import math
from os import PathLike
from pathlib import Path

import numpy as np

from spincyl._array import Floats

#: What Tracker separates columns with; spaces last, since names have them.
_DELIMITERS = ("\t", ";", ",", None)


def read_tracker(path: str | PathLike[str]) -> dict[str, dict[str, Floats]]:
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
        first name of a track, such as t, belong to every one. A track without a name is called "track".

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
    text = _decoded(path)
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip()]
    several = len(lines)
    lines = [(i, line) for i, line in lines if not _is_marker(line)]
    several -= len(lines)
    kinds = [
        (delimiter, comma)
        for delimiter in _DELIMITERS
        if delimiter is None or delimiter in text
        for comma in (False, True)
        if not comma or (delimiter != "," and "," in text)
    ]
    if lines:  # what cannot read the last line fails in the end: it is tried when all else has
        kinds.sort(key=lambda kind: _numbers(lines[-1][1], *kind) is None)
    why = ""
    for kind in kinds:
        first = next((k for k, (_, line) in enumerate(lines) if _numbers(line, *kind) is not None), None)
        if not first:
            continue
        delimiter, _ = kind
        columns = _cells(lines[first - 1][1], delimiter)
        if len(columns) < 2:
            continue
        above = _cells(lines[first - 2][1], delimiter) if first > 1 else []
        if not several and (delimiter is None or (first > 1 and not _over(above, columns))):
            # a name, whatever is in it
            above = [lines[first - 2][1].strip()] if first > 1 else []
        try:
            if several and delimiter is None:
                raise ValueError("several tracks between spaces cannot be told apart")
            return _tracks(above, columns, _table(lines[first:], *kind, len(columns)))
        except ValueError as e:
            why = why or str(e)
    why = why or "no line of column names right above a line of numbers"
    raise ValueError(f"{path}: not a table of Tracker's: {why}")


def _is_marker(line: str) -> bool:
    return ":" in line and line.strip(" #;,\t").lower() == "multi:"


def _over(names: list[str], columns: list[str]) -> bool:
    """Whether names stand above columns: with gaps, since a track has more than one."""
    return len(names) > 1 and "" in names and len(names) <= len(columns)


def _decoded(path: Path) -> str:
    raw = path.read_bytes()
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        try:
            return raw.decode("utf-16")
        except UnicodeDecodeError as e:
            raise ValueError(f"{path}: its UTF-16 is torn at byte {e.start} of {len(raw)}") from None
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace")


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


def _numbers(line: str, delimiter: str | None, comma: bool) -> list[float] | None:
    """The numbers of a line, NaN for an empty cell; None if something else is there, or nothing."""
    if "_" in line:  # which Python allows in numbers
        return None
    try:
        cells = _split(line.replace(",", ".") if comma else line, delimiter)
        found = [float(cell) if cell and not cell.isspace() else math.nan for cell in cells]
    except ValueError:
        return None
    return found if any(cells) and math.inf not in map(abs, found) else None


def _table(lines: list[tuple[int, str]], delimiter: str | None, comma: bool, width: int) -> Floats:
    """(n, width) numbers of lines, NaN where a cell is empty or a line short."""
    plain = _plain([line for _, line in lines], delimiter, comma, width)
    if plain is not None:
        return plain
    table = []
    for i, line in lines:
        numbers = _numbers(line, delimiter, comma)
        if numbers is None:
            raise ValueError(f"line {i} has something that is no number")
        if len(numbers) > width:
            raise ValueError(f"line {i} has {len(numbers)} cells under {width} column names")
        table.append(numbers + [math.nan] * (width - len(numbers)))
    return np.array(table)


def _plain(lines: list[str], delimiter: str | None, comma: bool, width: int) -> Floats | None:
    """The same by NumPy's reader, five times faster; None if it finds anything unusual."""
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


def _tracks(above: list[str], columns: list[str], table: Floats) -> dict[str, dict[str, Floats]]:
    names = [name.lstrip("#").strip() for name in above]
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
        found[name] = {columns[k]: table[:, k] for k in own}
    return found
