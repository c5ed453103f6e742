"""The cells of a line of a table, and the numbers in them."""

import math

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
    """NaN for each cell if all cells of the line are marked as missing; else None."""
    try:
        cells = split(line, delimiter)
    except ValueError:
        return None
    return [math.nan] * len(cells) if all(cell.strip().lower() in MISSING for cell in cells) else None
