"""Reading of files up to a limit of size."""

import zipfile
from collections.abc import Callable
from io import BytesIO
from os import PathLike
from pathlib import PurePosixPath
from typing import IO

from spincyl._input.files import path_of

#: Largest size of a file, and of all the contents of a zip file together; more is refused.
MOST_BYTES = 100_000_000
_PIECE = 1 << 20


def contents(path: str | PathLike[str]) -> bytes:
    """The bytes of a file."""
    found = path_of("path", path)
    with found.open("rb") as file:
        return limited(file, str(found), MOST_BYTES)


def limited(file: IO[bytes], name: str, most: int) -> bytes:
    """The bytes of a file, whatever size its directory gives; ValueError for more than `most`."""
    pieces, left = [], most
    while piece := file.read(_PIECE):
        pieces.append(piece)
        left -= len(piece)
        if left < 0:
            raise ValueError(f"{name}: holds more than {MOST_BYTES:,} bytes; cut it into parts")
    return b"".join(pieces)


def unpacked(raw: bytes, name: str, wanted: Callable[[PurePosixPath], bool]) -> list[tuple[str, bytes]]:
    """Names and contents of the files in a zip file that are wanted, without those of macOS."""
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
        raise ValueError(str(e) if name in str(e) else f"{name}: a torn zip file: {e}") from None
    except (
        Exception
    ) as e:  # a damaged or encrypted file raises errors of many kinds; nothing is read from disk here
        raise ValueError(f"{name}: a torn zip file, or one that needs a password: {e!r}") from None
    return found
