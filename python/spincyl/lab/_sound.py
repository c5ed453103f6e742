"""Sound and tables recorded by a phone: exports of phyphox, and WAV files.

Python's `wave` does not read floating-point samples, and SciPy's reader fails if a recording breaks off
within a frame; therefore the few fields of a WAV file are read here.
"""

import struct
from collections import Counter
from os import PathLike
from pathlib import Path, PurePosixPath

import numpy as np

from spincyl._input.numbers import Floats
from spincyl.lab._columns import Columns
from spincyl.lab._contents import contents, unpacked
from spincyl.lab._encoding import not_packed_project
from spincyl.lab._tracker import table

_LOUDEST = 2.0**31  # largest sample; floating-point samples are usually below 1


def read_phyphox(path: str | PathLike[str], *, encoding: str | None = None) -> dict[str, Columns]:
    """Read the tables that the app phyphox exported, as a CSV file or a zip file of several.

    Parameters
    ----------
    path : path
        A CSV or zip file. Separators (commas, semicolons or tabs) and decimal signs are detected.
    encoding : str, optional
        Encoding of the text, as in `read_table`; phyphox writes UTF-8.

    Returns
    -------
    dict
        Tables by the names of their files without the suffix. Each table is a dict of columns, as in
        ``{"Raw Data": {"Time": ..., "Recording": ...}}``. A column is an array, with NaN where a cell is
        empty. The full name of a column, such as "Time (s)", is a key as well. Information on the phone, in
        the folder meta of a zip file, is left out. Tables of a zip file whose names differ only in folder or
        suffix keep their full names, such as "first/Raw Data.csv".

    Raises
    ------
    ValueError
        If a file is not a table; the message names the file and the line, as in `read_table`. Also if a zip
        file is damaged, needs a password, has two tables of the same name, or unpacks to more than
        `MOST_BYTES` bytes in all.
    OSError
        If the file cannot be read.
    TypeError
        If `path` is not a path.

    Notes
    -----
    `units` of a table gives the units of its columns: some versions of the Audio Scope write milliseconds.
    """
    raw, name = contents(path), str(path)
    if raw[:4] not in (b"PK\x03\x04", b"PK\x05\x06"):
        return {Path(path).stem: table(raw, name, encoding)}
    found = unpacked(raw, name, _is_table)
    if not found:
        not_packed_project(raw, name)
        raise ValueError(f"{name}: this zip file contains no CSV; export from phyphox as CSV")
    paths = [PurePosixPath(inside) for inside, _ in found]
    stems = Counter(inside.stem for inside in paths)
    # tables in two folders may have the same name
    names = [inside.stem if stems[inside.stem] == 1 else str(inside) for inside in paths]
    twice = next((n for n, many in Counter(names).items() if many > 1), None)
    if twice is not None:
        raise ValueError(f"{name}: two tables in this zip file are called {twice!r}")
    return {
        n: table(held, f"{name}: {inside}", encoding) for n, (inside, held) in zip(names, found, strict=True)
    }


def _is_table(inside: PurePosixPath) -> bool:
    """Whether a file in a zip file is a table, not information on the phone."""
    return inside.suffix.lower() in (".csv", ".txt") and "meta" not in inside.parts


def read_sound(path: str | PathLike[str]) -> tuple[Floats, Floats]:
    """Read the sound in a WAV file.

    Parameters
    ----------
    path : path
        An uncompressed WAV file with samples of 8, 16, 24 or 32 bits, or floating-point samples.

    Returns
    -------
    t : ndarray, (n,)
        Times in seconds, from 0.
    sound : ndarray, (n,)
        Mean of the channels at these times, from -1 to 1.

    Raises
    ------
    ValueError
        If the file is not an uncompressed WAV file, its header contradicts itself, a sample is infinite or
        NaN, or the file has more than `MOST_BYTES` bytes. The message names the file.
    OSError
        If the file cannot be read.
    TypeError
        If `path` is not a path.
    """
    raw = contents(path)
    if raw[:4] != b"RIFF" or raw[8:12] != b"WAVE":
        raise ValueError(f"{path}: not a WAV file; convert the sound to WAV")
    form: bytes = b""
    place = 12
    while place + 8 <= len(raw):
        kind, size = struct.unpack_from("<4sI", raw, place)
        begin, place = place + 8, place + 8 + size + size % 2
        if kind == b"fmt ":
            form = raw[begin : begin + size]
        if kind == b"data":
            # a recording that broke off has sizes that are too large, or zero
            finished = size or struct.unpack_from("<I", raw, 4)[0] + 8 == len(raw)
            return _samples(raw[begin : begin + size] if finished else raw[begin:], form, str(path))
    raise ValueError(f"{path}: this WAV file has no samples")


def _samples(raw: bytes, form: bytes, name: str) -> tuple[Floats, Floats]:
    if len(form) < 16:
        raise ValueError(f"{name}: this WAV file does not give the format of its samples")
    code, channels, hertz, pace, frame, bits = struct.unpack_from("<HHIIHH", form)
    if code == 0xFFFE and len(form) >= 26:  # extensible format: the code is the first field of the sub-format
        (code,) = struct.unpack_from("<H", form, 24)
    kinds = {(1, 8): "u1", (1, 16): "<i2", (1, 24): "u1", (1, 32): "<i4", (3, 32): "<f4", (3, 64): "<f8"}
    kind = kinds.get((code, bits))
    if kind is None or channels < 1 or hertz < 1:
        raise ValueError(f"{name}: WAV format {code} with {bits} bits: expected uncompressed samples")
    if frame != channels * bits // 8 or pace != hertz * frame:
        told = (
            f"{channels} x {bits} bits are not {frame} bytes, or {hertz} times this not {pace} bytes a second"
        )
        raise ValueError(f"{name}: the header of this WAV file contradicts itself: {told}; convert it again")
    raw = raw[: len(raw) // frame * frame]
    if not raw:
        raise ValueError(f"{name}: this WAV file has no samples")
    if bits == 24:  # shift to the upper bytes of 32 bits
        wide = np.zeros((len(raw) // 3, 4), np.uint8)
        wide[:, 1:] = np.frombuffer(raw, np.uint8).reshape(-1, 3)
        values = wide.view("<i4")[:, 0] / 2.0**31
    else:
        with np.errstate(invalid="ignore"):  # converting a signalling NaN would warn
            values = np.frombuffer(raw, kind).astype(np.float64)
        if not (np.abs(values) <= _LOUDEST).all():
            at = int(np.argmin(np.abs(values) <= _LOUDEST))
            raise ValueError(
                f"{name}: sample {at // channels} of this WAV file is {values[at]}: the file is damaged"
            )
        if code == 1:
            values = values / 128 - 1 if bits == 8 else values / 2.0 ** (bits - 1)
    sound: Floats = values.reshape(-1, channels).mean(axis=1)
    return np.arange(sound.size) / hertz, sound
