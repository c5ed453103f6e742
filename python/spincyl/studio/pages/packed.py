"""Compressed content of a page: LZMA streams as text; `play.lzma.js` decodes them."""

import zlib

import numpy as np

from spincyl.studio.pages.compressed import expanded

#: Characters that an HTML page would change: NUL, CR and "<".
_UNFIT = 0, 13, 60
#: Length of the header of the format of the pieces, ".lzma".
_HEADER = 13


def packed(*pieces: bytes) -> str:
    """Encode compressed pieces as text for a script element.

    Each becomes the length of its LZMA stream, that of its content, the content's checksum (Adler-32), and
    the stream.
    """
    data = b""
    for piece in pieces:
        stream, content = piece[_HEADER:], expanded(piece)
        for number in (len(stream), len(content), zlib.adler32(content)):
            data += number.to_bytes(4, "big")
        data += stream
    return characters(data)


def characters(data: bytes) -> str:
    """Encode bytes as text, seven bits in each character.

    An unfit character is combined with the next one into a character of 128 or above: two bytes in UTF-8.
    """
    bits = np.unpackbits(np.frombuffer(data, np.uint8))
    sevens = np.append(bits, np.zeros(-bits.size % 7, np.uint8)).reshape(-1, 7)
    values = iter((sevens @ (1 << np.arange(6, -1, -1))).tolist())
    return "".join(
        chr(128 * (1 + _UNFIT.index(x)) + next(values, 0)) if x in _UNFIT else chr(x) for x in values
    )
