"""Reading of files up to a limited size."""

import zipfile
from collections.abc import Callable
from io import BytesIO
from os import PathLike
from pathlib import PurePosixPath
from typing import IO

from spincyl._input.files import path_of

#: Largest size in bytes of a file, and of all the contents of a zip file together.
MOST_BYTES = 100_000_000
_BYTES_PER_READ = 1 << 20


def contents(path: str | PathLike[str]) -> bytes:
    """Read the bytes of a file; ValueError for more than `MOST_BYTES`."""
    found = path_of("path", path)
    with found.open("rb") as file:
        return limited(file, str(found), MOST_BYTES)


def limited(file: IO[bytes], name: str, most: int) -> bytes:
    """Read an open file, whatever size it states in a zip file; ValueError for more than `most` bytes."""
    pieces, left = [], most
    while piece := file.read(_BYTES_PER_READ):
        pieces.append(piece)
        left -= len(piece)
        if left < 0:
            raise ValueError(f"{name}: more than {MOST_BYTES:,} bytes; cut the file into parts")
    return b"".join(pieces)


def unpacked(raw: bytes, name: str, wanted: Callable[[PurePosixPath], bool]) -> list[tuple[str, bytes]]:
    """Names and contents of the wanted files in a zip file, without those that macOS adds."""
    found: list[tuple[str, bytes]] = []
    left = MOST_BYTES
    try:
        with zipfile.ZipFile(BytesIO(raw)) as file:
            for entry in file.infolist():
                inside = PurePosixPath(entry.filename)
                if "__MACOSX" in inside.parts or not wanted(inside):
                    continue
                with file.open(entry) as packed:
                    held = limited(packed, name, left)
                left -= len(held)
                found.append((entry.filename, held))
    except MemoryError:
        raise
    except ValueError as e:
        raise ValueError(str(e) if name in str(e) else f"{name}: the zip file is damaged: {e}") from None
    except (
        Exception
    ) as e:  # a damaged or encrypted file raises errors of many kinds; nothing is read from disk here
        raise ValueError(f"{name}: the zip file is damaged or needs a password: {e!r}") from None
    return found
