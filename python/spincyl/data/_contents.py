"""Reading of files up to a limit of size."""

from os import PathLike
from typing import IO

from spincyl._input.numbers import path_of

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
