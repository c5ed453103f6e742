"""Splitting of a line of a table into cells, and reading of the numbers in the cells."""

import math
from typing import NamedTuple

#: Cells without a number, in lower case; float() accepts "nan" by itself.
MISSING = frozenset(
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


def split(line: str, delimiter: str | None) -> list[str]:
    """The cells of a line, without empty ones at the end; ValueError for an unclosed quote."""
    if delimiter is None:
        return line.split()
    if '"' not in line:
        return line.rstrip(delimiter + " ").split(delimiter)
    cells: list[str] = []
    begun: list[str] = []
    many = 0
    for piece in line.split(delimiter):
        if not begun and not piece.lstrip().startswith('"'):
            cells.append(piece)
            continue
        begun.append(piece)
        many += piece.count('"')
        if many % 2 == 0:  # the delimiters so far were inside quotes
            cell = delimiter.join(begun).strip()
            bare = cell[1:-1].replace('""', "")
            if '"' in bare or not cell.endswith('"'):
                break
            cells.append(cell[1:-1].replace('""', '"'))
            begun, many = [], 0
    if begun:
        raise ValueError("a quote that is not closed")
    while cells and not cells[-1].strip():
        cells.pop()
    return cells


def numbers_in(line: str, delimiter: str | None, comma: bool) -> list[float] | None:
    """The numbers of a line, NaN for an empty cell; None if a cell is not a number or all are empty."""
    if "_" in line:  # which float() would accept
        return None
    try:
        cells = split(line, delimiter)
    except ValueError:
        return None
    if comma:
        if "." in line and any("." in cell and cell.strip().lower() not in MISSING for cell in cells):
            return None  # a point among decimal commas is a thousands separator or an error
        cells = [cell.replace(",", ".") for cell in cells]
    try:
        found = [float(cell) if cell and not cell.isspace() else math.nan for cell in cells]
    except ValueError:
        try:
            known = [cell.strip().lower() for cell in cells]
            found = [math.nan if cell in MISSING else float(cell) for cell in known]
        except ValueError:
            return None
        if all(cell in MISSING for cell in known):
            return None
    return found if any(cells) and math.inf not in map(abs, found) else None


def is_number(cell: str) -> bool:
    """Whether a cell is a number, with a point or a comma, even if it has lost one of its quotes."""
    bare = cell.strip(" \t\"'")
    return any(numbers_in(bare, None, comma) is not None for comma in (False, True))


def missing_in(line: str, delimiter: str | None) -> list[float] | None:
    """A list with NaN for each cell if all cells of the line are marked as missing; else None."""
    try:
        cells = split(line, delimiter)
    except ValueError:
        return None
    return [math.nan] * len(cells) if all(cell.strip().lower() in MISSING for cell in cells) else None


class Split(NamedTuple):
    """A table after the removal of its columns of text."""

    lines: list[tuple[int, str]]  #: numbered lines of the columns of numbers
    texts: list[tuple[str, tuple[str, ...]]]  #: columns of text: names and cells


def without_texts(lines: list[tuple[int, str]], delimiter: str, units: frozenset[str]) -> Split | None:
    """Separate columns of text, such as names, from columns of numbers; None if all are of one kind.

    The line of names is the first line with as many cells as the table has columns. ValueError if a column
    has numbers and texts.
    """
    try:
        rows = [(at, [cell.strip() for cell in split(line, delimiter)]) for at, line in lines]
    except ValueError:
        return None
    wide = max((len(cells) for _, cells in rows), default=0)
    top = next((k for k, (_, cells) in enumerate(rows) if len(cells) == wide), 0)
    names = rows[top][1] if rows else []
    if wide < 2 or not all(names) or any(map(is_number, names)):
        return None
    below = top + 1
    while below < len(rows) and all(x.strip("()[]").lower() in units for x in rows[below][1] if x):
        below += 1  # a line of units
    body = [(at, cells) for at, cells in rows[below:] if cells and cells[0][:1] not in ("#", "%")]
    text = [
        all(not _reads_as_number(x) for x in column) and any(x.lower() not in MISSING for x in column)
        for column in ([cells[k] if k < len(cells) else "" for _, cells in body] for k in range(wide))
    ]
    if all(text) or not any(text):
        return None
    numbers = [k for k, is_text in enumerate(text) if not is_text]
    for at, cells in body:
        for name, cell, is_text in zip(names, cells, text, strict=False):
            if not (is_text or cell.lower() in MISSING or _reads_as_number(cell)):
                raise ValueError(
                    f"line {at} has the text {cell!r} in the column {name!r}: expected only numbers"
                )

    def joined(cells: list[str]) -> str:
        kept = [(cells[k] if k < len(cells) else "") or "NA" for k in numbers]
        line = delimiter.join(f'"{x}"' if delimiter in x else x for x in kept)
        return line + delimiter if len(kept) == 1 else line  # a space within the name separates no columns

    found = [(at, joined(cells)) for at, cells in [*rows[top:below], *body]]
    texts = [
        (names[k], tuple(cells[k] if k < len(cells) else "" for _, cells in body))
        for k, is_text in enumerate(text)
        if is_text
    ]
    return Split(found, texts)


def _reads_as_number(cell: str) -> bool:
    """Whether a cell looks like a number, even one that tables must not have, such as inf or 1e."""
    bare = cell.strip(" \t\"'")
    if bare.lower() in MISSING:
        return False
    try:
        float(bare)
    except ValueError:
        return is_number(bare) or bare.lstrip("+-")[:1].isdecimal()
    return True
