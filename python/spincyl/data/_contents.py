"""What a file holds: its bytes, and not more of them than a limit."""

from os import PathLike
from typing import IO

from spincyl._input.numbers import path_of

#: How many bytes a file may hold, and all that a zip file unpacks to, together: more of them are refused.
MOST_BYTES = 100_000_000
_PIECE = 1 << 20


def contents(path: str | PathLike[str]) -> bytes:
    """The bytes of a file."""
    found = path_of("path", path)
    with found.open("rb") as file:
        return limited(file, str(found), MOST_BYTES)


def limited(file: IO[bytes], name: str, most: int) -> bytes:
    """All that a file holds, whatever is said of its size, or ValueError if it is more than `most`."""
    pieces, left = [], most
    while piece := file.read(_PIECE):
        pieces.append(piece)
        left -= len(piece)
        if left < 0:
            raise ValueError(f"{name}: holds more than {MOST_BYTES:,} bytes; cut it into parts")
    return b"".join(pieces)
