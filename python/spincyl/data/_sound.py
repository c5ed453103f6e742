"""Sound and other tables as a phone records them: exports of phyphox, and WAV files.

Python's `wave` knows no floating-point samples, and SciPy's reader no recording that was cut off within a
frame: so the few fields of a WAV file are read here.
"""

import csv
import struct
import zipfile
from io import BytesIO
from os import PathLike
from pathlib import Path, PurePosixPath

import numpy as np

from spincyl._array import Floats
from spincyl.data._columns import Columns, decoded

_DELIMITERS = "\t;,"


def read_phyphox(path: str | PathLike[str]) -> dict[str, Columns]:
    """The tables that the app phyphox exported, as CSV or as a zip file of CSV.

    Parameters
    ----------
    path : path
        With commas, semicolons or tabs between columns, decimal point or comma: found out.

    Returns
    -------
    dict
        By table (the name of its file without the suffix), by column, such as
        ``{"Raw Data": {"Time": ..., "Recording": ...}}``: arrays, NaN where a cell is empty. The name in the
        file, such as "Time (s)", is understood, too. What a zip file says of the phone, in its folder meta,
        is left out.

    Raises
    ------
    ValueError
        If it is no such table, naming the file and the line.
    OSError
        If it cannot be read.

    Notes
    -----
    The unit of a column is in the `units` of its table; the Audio Scope counts milliseconds in some versions.
    """
    path = Path(path)
    raw = path.read_bytes()
    if not zipfile.is_zipfile(BytesIO(raw)):
        return {path.stem: _table(raw, str(path))}
    try:
        with zipfile.ZipFile(BytesIO(raw)) as inside:
            names = [PurePosixPath(name) for name in inside.namelist()]
            names = [n for n in names if n.suffix.lower() in (".csv", ".txt") and "meta" not in n.parts]
            found = {name.stem: _table(inside.read(str(name)), f"{path}: {name}") for name in names}
    except (zipfile.BadZipFile, RuntimeError, NotImplementedError) as e:  # torn, or with a password
        raise ValueError(f"{path}: {e}") from None
    if not found:
        raise ValueError(f"{path}: no CSV in this zip file; export from phyphox as CSV")
    return found


def _table(raw: bytes, name: str) -> Columns:
    """The columns of one file of CSV."""
    text = decoded(raw, name)
    lines = [(k, line) for k, line in enumerate(text.splitlines(), 1) if line.strip()]
    if len(lines) < 2:
        raise ValueError(f"{name}: expected a line of column names and lines of numbers")
    head, rows = lines[0][1], lines[1:]
    # what separates is not inside the quotes of a name
    bare = "".join(head.split('"')[::2]) if '"' in head else head
    delimiter = next((d for d in _DELIMITERS if d in bare), "\t")
    columns = [cell.strip() for cell in next(csv.reader([head], delimiter=delimiter))]
    if len(set(columns)) < len(columns) or all(_number(column) is not None for column in columns):
        raise ValueError(f"{name}: expected different column names in line {lines[0][0]}, not {head[:80]!r}")
    comma = delimiter != ","
    table = np.full((len(rows), len(columns)), np.nan)
    for row, (k, line) in enumerate(rows):
        cells = line.replace('"', "").replace(",", "." if comma else ",").split(delimiter)
        numbers = [np.nan if not cell.strip() else _number(cell) for cell in cells]
        if None in numbers or len(numbers) > len(columns):
            raise ValueError(f"{name}: line {k} has not {len(columns)} numbers: {line[:80]!r}")
        table[row, : len(numbers)] = numbers
    return Columns(zip(columns, np.ascontiguousarray(table.T), strict=True))


def _number(cell: str) -> float | None:
    try:
        return None if "_" in cell else float(cell)
    except ValueError:
        return None


def read_sound(path: str | PathLike[str]) -> tuple[Floats, Floats]:
    """Times in seconds and the sound of a WAV file, -1 to 1, the mean of its channels.

    Parameters
    ----------
    path : path
        Of 8, 16, 24 or 32 bits, or of floating-point numbers, not compressed.

    Returns
    -------
    t, sound : array
        Both (n,).

    Raises
    ------
    ValueError
        If it is none, or compressed, naming the file.
    OSError
        If it cannot be read.
    """
    path = Path(path)
    raw = path.read_bytes()
    if raw[:4] != b"RIFF" or raw[8:12] != b"WAVE":
        raise ValueError(f"{path}: not a WAV file; convert it to one")
    form: tuple[int, int, int, int] | None = None
    place = 12
    while place + 8 <= len(raw):
        kind, size = struct.unpack_from("<4sI", raw, place)
        begin, place = place + 8, place + 8 + size + size % 2
        if kind == b"fmt " and size >= 16:
            code, channels, hertz, _, _, bits = struct.unpack_from("<HHIIHH", raw, begin)
            if code == 0xFFFE and size >= 26:  # extensible: the code is the first of the sub-format
                (code,) = struct.unpack_from("<H", raw, begin + 24)
            form = code, channels, hertz, bits
        if kind == b"data":
            # a recorder that was cut off leaves a size that is too large, or zero
            return _samples(raw[begin : begin + size] if size else raw[begin:], form, path)
    raise ValueError(f"{path}: this WAV file has no samples")


def _samples(raw: bytes, form: tuple[int, int, int, int] | None, path: Path) -> tuple[Floats, Floats]:
    code, channels, hertz, bits = form or (0, 0, 0, 0)
    kinds = {(1, 8): "u1", (1, 16): "<i2", (1, 24): "u1", (1, 32): "<i4", (3, 32): "<f4", (3, 64): "<f8"}
    kind = kinds.get((code, bits))
    if kind is None or channels < 1 or hertz < 1:
        raise ValueError(f"{path}: WAV of kind {code} with {bits} bits: expected plain samples")
    frame = channels * bits // 8
    raw = raw[: len(raw) // frame * frame]
    if not raw:
        raise ValueError(f"{path}: this WAV file has no samples")
    if bits == 24:  # in the upper bytes of 32 bits
        wide = np.zeros((len(raw) // 3, 4), np.uint8)
        wide[:, 1:] = np.frombuffer(raw, np.uint8).reshape(-1, 3)
        values = wide.view("<i4")[:, 0] / 2.0**31
    else:
        values = np.frombuffer(raw, kind).astype(np.float64)
        if code == 1:
            values = values / 128 - 1 if bits == 8 else values / 2.0 ** (bits - 1)
    sound: Floats = values.reshape(-1, channels).mean(axis=1)
    return np.arange(sound.size) / hertz, sound
