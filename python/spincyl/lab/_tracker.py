"""Tables of numbers as exported by Tracker and others; delimiter and decimal sign are detected."""

import math
import re
from itertools import pairwise
from os import PathLike

import numpy as np

from spincyl._input.numbers import Floats
from spincyl.lab._cells import is_number, missing_in, numbers_in, split, without_texts
from spincyl.lab._columns import UNITS, Columns
from spincyl.lab._contents import MOST_BYTES, contents
from spincyl.lab._encoding import decoded, legible
from spincyl.lab._project import project

#: Delimiters of columns in the order of trial; spaces come last, since names contain them.
_DELIMITERS = ("\t", ";", ",", None)
#: Names and the first row of numbers have to be within this many lines that are not empty.
_LINES_SEARCHED = 10_000


def read_table(path: str | PathLike[str], *, encoding: str | None = None) -> Columns:
    """Read the columns of a text file: one line of names, and numbers below it.

    Parameters
    ----------
    path : path
        Text file. The separators (tabs, semicolons, commas or spaces) and the decimal signs (points or
        commas) are detected. Up to 10,000 lines above the names are skipped.
    encoding : str, optional
        Encoding of the text, such as "cp1252" (Windows in Western Europe) or "gbk". Default: UTF-8, or UTF-16
        with a byte order mark.

    Returns
    -------
    Columns
        Dict of the columns by name. They are arrays of equal length, with NaN for a cell that is empty or
        contains "NA", "-" or the like. Columns "t (s)", "t [s]" and "# t" have the name "t"; `units` has the
        unit. Columns of text, such as the names of students, are in `texts`.

    Raises
    ------
    ValueError
        If the file is not such a table, or has more than `MOST_BYTES` bytes; the message names the file and
        the line. If numbers are ambiguous: a quote is not closed, some numbers have decimal points and others
        decimal commas, or all quoted numbers are like "1,234", where the comma may separate thousands. If a
        name is not UTF-8; the message asks for `encoding`.
    OSError
        If the file cannot be read.
    TypeError
        If `path` is not a path.

    Notes
    -----
    Nothing is guessed. Infinite numbers, and cells without a name of their column, raise an error.

    Examples
    --------
    >>> import spincyl as sc
    >>> list(sc.data.read_table(sc.data.example("flicks")))
    ['degrees', 'hertz']
    """
    return table(contents(path), str(path), encoding)


def table(raw: bytes, name: str, encoding: str | None = None) -> Columns:
    """The single table in a file; ValueError for several."""
    tracks = _tracks_of_file(raw, name, encoding, "a table", 1)
    if len(tracks) > 1:
        legible(name, tracks)
        raise ValueError(
            f"{name}: expected one table, not {len(tracks)} tracks ({', '.join(tracks)}); use read_tracker"
        )
    (found,) = tracks.values()
    return found


def read_tracker(path: str | PathLike[str], *, encoding: str | None = None) -> dict[str, Columns]:
    """Read the tracks of a Tracker project, or of a text file exported by Tracker (File > Export > Data).

    Parameters
    ----------
    path : path
        Project (.trk, .trz) or text file. A text file has one track (its name, a line of column names,
        numbers), or several (a line "#multi:", and the names of the tracks above their columns). Separators
        and decimal signs are detected, as in `read_table`.
    encoding : str, optional
        Encoding of the text, as in `read_table`. For a project: encoding to use instead of the declared one.

    Returns
    -------
    dict
        Tracks by name. Each track is a dict of its columns by name: arrays of equal length, with NaN where a
        cell is empty. Columns to the left of the first track's name, such as t, belong to all tracks. A track
        without a name gets the name "track". A column "x (cm)" gets the name "x", and its unit "cm" is
        in the attribute `units` of the track. For a project, the columns are t, x and y of each point mass,
        from the first to the last frame in which a point was marked. The unit of length is the one of the
        project's scale, or "px" if none was set.

    Raises
    ------
    ValueError
        If the file is not such a table or project; the message names the file and the line, as in
        `read_table`, or the byte at which UTF-16 is damaged.
    OSError
        If the file cannot be read.
    TypeError
        If `path` is not a path.

    Notes
    -----
    Tracker is the video analysis tool of Open Source Physics. Angles are in the unit that was chosen there.
    A project contains the positions of the marks in the picture, the axes and the scale; x and y follow from
    these as in Tracker. It also contains the average duration of a frame. If the frames of a film are uneven,
    times therefore differ from those that Tracker shows and exports. Tracks that Tracker computes, such as
    those of a model, are not in a project.
    """
    raw, name = contents(path), str(path)
    found = project(raw, name, encoding)
    if found is None:
        found = _tracks_of_file(raw, name, encoding, "a table exported by Tracker", 2)
        legible(name, found)
    return found


def _tracks_of_file(raw: bytes, name: str, encoding: str | None, kind: str, least: int) -> dict[str, Columns]:
    """The tracks of a file; an error names the file and the reason."""
    text = decoded(raw, name, encoding)
    try:
        found = _read_tracks(text, least)
    except ValueError as e:
        raise ValueError(f"{name}: not {kind}: {e}") from None
    legible(name, (text for track in found.values() for pair in track.units.items() for text in pair))
    return found


def _read_tracks(text: str, least: int) -> dict[str, Columns]:
    """The tracks of a text, each with at least `least` columns."""
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip()]
    several = len(lines)
    lines = [(i, line) for i, line in lines if not _is_marker(line)]
    several -= len(lines)
    lines = [(i, line) for i, line in lines if not re.match(r"\ufeff?sep=.\s*$", line)]  # written by Excel
    try:
        return _tracks_of_lines(lines, text, bool(several), least)
    except ValueError:
        found = None if several or least > 1 else _table_beside_texts(lines, text)
        if found is None:
            raise
    return found


def _table_beside_texts(lines: list[tuple[int, str]], text: str) -> dict[str, Columns] | None:
    """The table of the columns of numbers, with its columns of text; None without a column of text."""
    for delimiter in _DELIMITERS[:-1]:
        parts = without_texts(lines, delimiter, UNITS) if delimiter in text else None
        if parts is None:
            continue
        below = "\n".join(line for _, line in parts.lines)
        ((name, table),) = _tracks_of_lines(parts.lines, below, False, 1).items()
        if len(next(iter(table.values()))) == len(parts.texts[0][1]):
            units = [(f"{key} ({unit})" if unit else key) for key, unit in table.units.items()]
            return {name: Columns(zip(units, table.values(), strict=True), parts.texts)}
    return None


def _tracks_of_lines(
    lines: list[tuple[int, str]], text: str, several: bool, least: int
) -> dict[str, Columns]:
    """The tracks of numbered lines; `text` tells which separators may occur."""
    kinds = [
        (delimiter, comma)
        for delimiter in _DELIMITERS
        if delimiter is None or delimiter in text
        for comma in (False, True)
        if not comma or ("," in text and (delimiter != "," or '"' in text))
    ]
    none = "no line of column names right above a line of numbers"
    none += f" of at least {least} columns" if least > 1 else ""
    if not lines:
        raise ValueError(f"it is empty: {none}")
    # formats in which the last line is not a row of numbers come last: they would fail there
    kinds.sort(key=lambda kind: numbers_in(lines[-1][1], *kind) is None)
    why = ""
    for kind in kinds:
        first = next(
            (k for k, (_, x) in enumerate(lines[:_LINES_SEARCHED]) if numbers_in(x, *kind) is not None), None
        )
        if not first:
            continue
        try:
            found = _tracks_in_format(lines, first, kind, several, least)
        except _Garbled as e:
            why = str(e)
            break
        except ValueError as e:
            why = why or str(e)
            continue
        if found is not None:
            return found
    (first, _), (last, line) = lines[0], lines[-1]
    why = why or _column_of_texts(lines, [delimiter for delimiter, comma in kinds if delimiter and not comma])
    raise ValueError(why or f"{none} from line {first} to line {last}; the last line is {_shortened(line)}")


def _column_of_texts(lines: list[tuple[int, str]], delimiters: list[str]) -> str:
    """Message about a column of text in a table that otherwise has numbers; "" if there is none."""
    for delimiter in delimiters:
        try:
            rows = [
                (at, [cell.strip() for cell in split(line, delimiter)])
                for at, line in lines[:_LINES_SEARCHED]
            ]
        except ValueError:
            continue
        for (_, names), (at, cells) in pairwise(rows):
            numbers = [is_number(cell) for cell in cells]
            if len(names) != len(cells) or any(map(is_number, names)) or not any(numbers) or all(numbers):
                continue
            name, cell = next(
                (n, c) for n, c, is_one in zip(names, cells, numbers, strict=True) if not is_one
            )
            told = f"line {at} has the text {_shortened(cell)} in the column {_shortened(name)}"
            return f"{told}: expected only numbers"
    return ""


class _Garbled(ValueError):
    """Error: a line cannot be the line of column names in any format; the message gives the reason."""


def _tracks_in_format(
    lines: list[tuple[int, str]], first: int, kind: tuple[str | None, bool], several: bool, least: int
) -> dict[str, Columns] | None:
    """The tracks of lines in one format; line `first` has the first numbers. None if names are missing."""
    delimiter, comma = kind
    at, line = lines[first - 1]
    columns, units = _names(at, line, delimiter), []
    if first > 1 and all(name.strip("()[]").lower() in UNITS for name in columns):
        first -= 1  # a line of units below the names
        at, line = lines[first - 1]
        columns, units = _names(at, line, delimiter), columns
    if units and len(units) == len(columns):
        columns = [f"{name} ({unit.strip('()[]')})" for name, unit in zip(columns, units, strict=True)]
    numbers = [is_number(name) for name in columns]
    if len(columns) < least:
        return None
    if all(numbers):
        below = lines[first][0]
        raise ValueError(f"line {at} has numbers in another format than line {below}: {_shortened(line)}")
    if any(numbers):  # a row of numbers with a cell that is not a number
        raise _Garbled(f"line {at} has a cell that is not a number: {_shortened(line)}")
    alone = delimiter is None or len(columns) == 1
    if not any(columns) or (
        alone and set(_BRACKETS.sub("", columns[0] if len(columns) == 1 else line)) & set(",;")
    ):
        raise ValueError(
            f"line {at} has no names separated in the same way as the numbers: {_shortened(line)}"
        )
    above = _track_names(lines[first - 2][1], delimiter, columns, several) if first > 1 else []
    if several and delimiter is None:
        raise ValueError("several tracks cannot be told apart if columns are separated by spaces")
    rows = [(i, line) for i, line in lines[first + bool(units) :] if line.lstrip()[0] not in "#%"]
    numbers_ = _table(rows, delimiter, comma, len(columns))
    try:
        return _tracks_of_columns(above, columns, numbers_)
    except ValueError as e:
        raise ValueError(f"line {at}: {e}") from None


#: A unit in brackets, which may contain a comma.
_BRACKETS = re.compile(r"[(\[][^()\[\]]*[)\]]")


def _is_marker(line: str) -> bool:
    return ":" in line and line.strip(" #;,\t").lower() == "multi:"


def _shortened(line: str) -> str:
    """A line for a message, shortened."""
    line = line.strip()
    return repr(line if len(line) <= 60 else line[:60] + "...")


def _track_names(line: str, delimiter: str | None, columns: list[str], several: bool) -> list[str]:
    """Track name above each column, "" beside the first of a track; or the line as a single name."""
    try:
        names = [cell.strip() for cell in split(line, delimiter)]
    except ValueError:
        names = []
    over = delimiter is not None and len(names) > 1 and "" in names and len(names) <= len(columns)
    return names if several or over else [line.strip()]


def _names(at: int, line: str, delimiter: str | None) -> list[str]:
    """Names of columns in a line; if separated by spaces, without comment marks and joined to their units."""
    if delimiter is None:
        names: list[str] = []
        for word in line.lstrip("#%\ufeff \t").split():
            if names and word[0] in "([":
                names[-1] += f" {word}"
            else:
                names.append(word)
        return names
    try:
        return [cell.strip() for cell in split(line, delimiter)]
    except ValueError as e:
        raise ValueError(f"line {at} has {e}: {_shortened(line)}") from None


def _table(lines: list[tuple[int, str]], delimiter: str | None, comma: bool, width: int) -> Floats:
    """The (n, width) numbers of lines, NaN where a cell is empty or missing at the end of a line."""
    # no complete table of a file has more cells than the file may have bytes
    if len(lines) * width > MOST_BYTES:
        raise ValueError(f"{width} column names above {len(lines)} lines are too many cells")
    if delimiter is not None:  # cells at the end may be missing in some lines, but not in all
        widest = max(line.count(delimiter) for _, line in lines) + 1
        if widest < width:
            raise ValueError(
                f"line {lines[0][0]} has {widest} number{'s' * (widest != 1)} under {width} column names"
            )
    if comma and delimiter == ",":
        _refuse_thousands(lines)
    plain = _table_by_numpy([line for _, line in lines], delimiter, comma, width)
    if plain is not None:
        return plain
    table: list[list[float]] = []
    for i, line in lines:
        numbers = numbers_in(line, delimiter, comma)
        if numbers is None:
            numbers = missing_in(line, delimiter)
        if numbers is None:
            raise ValueError(f"line {i} has {_why_no_row(line, delimiter, comma)}: {_shortened(line)}")
        if len(numbers) > width:
            raise ValueError(f"line {i} has {len(numbers)} cells under {width} column names")
        table.append(numbers + [math.nan] * (width - len(numbers)))
    widest = max(map(len, map(str.split, (line for _, line in lines)))) if delimiter is None else width
    if widest < width:  # if separated by spaces, no cell can be empty
        raise ValueError(
            f"line {lines[0][0]} has {widest} number{'s' * (widest != 1)} under {width} column names"
        )
    return np.array(table)


def _why_no_row(line: str, delimiter: str | None, comma: bool) -> str:
    """The reason why a line is not a row of numbers."""
    try:
        split(line, delimiter)
    except ValueError as e:
        return str(e)
    if comma and numbers_in(line.replace(".", ""), delimiter, True) is not None:
        return "a decimal point among decimal commas"
    return "a cell that is not a number"


def _refuse_thousands(lines: list[tuple[int, str]]) -> None:
    """ValueError if all quoted commas could be thousands separators as well as decimal commas: "1,234"."""
    found = [(i, cell) for i, line in lines for cell in _cells_with_quotes(line) if "," in cell]
    if found and all(_THOUSANDS.fullmatch(cell) for _, cell in found):
        i, cell = found[0]
        readings = f"{cell.replace(',', '.')} or {cell.replace(',', '')}"
        raise ValueError(f"line {i}: {cell!r} may mean {readings}; write it as one of these")


#: A number that reads as an integer with thousands separators, or as one with three decimals.
_THOUSANDS = re.compile(r"\s*[+-]?[1-9][0-9]{0,2}(,[0-9]{3})+\s*")


def _cells_with_quotes(line: str) -> list[str]:
    """The cells of a comma-separated line that has quotes; empty for an unclosed quote."""
    try:
        return split(line, ",") if '"' in line else []
    except ValueError:
        return []


def _table_by_numpy(lines: list[str], delimiter: str | None, comma: bool, width: int) -> Floats | None:
    """The result of `_table` by NumPy's reader, five times faster; None if lines have anything unusual."""
    if any('"' in line or (comma and "." in line) for line in lines):
        return None
    if comma:
        lines = [line.replace(",", ".") for line in lines]
    if delimiter is not None:  # fill empty and missing cells with nan, which NumPy's reader needs
        d, filled = delimiter, f"{delimiter}nan{delimiter}"
        lines = [line.rstrip(d + " ") for line in lines]
        if "" in lines:
            return None
        lines = [line + (width - 1 - line.count(d)) * d for line in lines]
        lines = [line.replace(d + d, filled).replace(d + d, filled) for line in lines]
        lines = [("nan" if line[0] == d else "") + line + ("nan" if line[-1] == d else "") for line in lines]
    try:
        table = np.loadtxt(lines, delimiter=delimiter, comments=None, ndmin=2)
    except ValueError:
        return None
    return table if table.shape == (len(lines), width) and not np.isinf(table).any() else None


def _tracks_of_columns(above: list[str], columns: list[str], table: Floats) -> dict[str, Columns]:
    names = [name.lstrip("#\ufeff \t").strip() for name in above]
    # a single name above the columns is that of the only track
    starts = [(k if len(names) > 1 else 0, name) for k, name in enumerate(names) if name] or [(0, "track")]
    shared = range(starts[0][0])
    found = {}
    for (start, name), (stop, _) in zip(starts, [*starts[1:], (len(columns), "")], strict=True):
        own = [*shared, *range(start, stop)]
        if name in found:
            raise ValueError(f"two tracks are called {name!r}")
        if len({columns[k] for k in own}) < len(own):
            raise ValueError(f"two columns of {name!r} have the same name")
        found[name] = Columns((columns[k], table[:, k]) for k in own)
    return found
