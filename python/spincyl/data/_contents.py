"""What a file holds: its bytes, not more of them than a limit, and its text, whose encoding is found out."""

from os import PathLike
from typing import IO

from spincyl._array import path_of

#: How many bytes a file may hold, and all that a zip file unpacks to, together: more of them are refused.
MOST_BYTES = 100_000_000
_PIECE = 1 << 20
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")


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


def decoded(raw: bytes, name: str) -> str:
    """The text of a file: UTF-16 or UTF-8 with its mark or without, else Windows-1252."""
    if raw[:4] == b"PK\x03\x04":
        raise ValueError(f"{name}: a workbook or a zip file, not text; export it as CSV")
    if raw[:2] in _UTF_16:
        try:
            text = raw.decode("utf-16")
        except UnicodeDecodeError as e:
            raise ValueError(f"{name}: its UTF-16 is torn at byte {e.start} of {len(raw)}") from None
    else:
        try:
            text = raw.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = raw.decode("cp1252", errors="replace")
    if "\0" in text:
        raise ValueError(f"{name}: not text; export it as CSV")
    return text.replace("\u2212", "-")  # the minus sign of typesetters
