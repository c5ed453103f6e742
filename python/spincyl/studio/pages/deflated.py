"""Compressed content of a page: deflated bytes as text; `play.loader.js` decodes it."""

import zlib

import numpy as np

#: Characters that an HTML page would change: NUL, CR and "<".
_UNFIT = 0, 13, 60


def packed(first: bytes, second: bytes) -> str:
    """Compress two byte strings to text for a script element.

    A header contains the length of the deflated stream, which a browser needs, and of the first string.
    """
    stream = zlib.compress(first + second, 9)
    return characters(len(stream).to_bytes(4, "big") + len(first).to_bytes(4, "big") + stream)


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
