"""What a page carries packed: bytes by deflate, and those as text; play.loader.js is the inverse."""

import zlib

import numpy as np

#: What does not survive in a page: NUL, CR, and what a tag begins with.
_UNFIT = 0, 13, 60


def packed(first: bytes, second: bytes) -> str:
    """Two pieces as text that can stand in a script element.

    A head has how long the deflated stream is, which a browser does not guess, and the first piece.
    """
    stream = zlib.compress(first + second, 9)
    return characters(len(stream).to_bytes(4, "big") + len(first).to_bytes(4, "big") + stream)


def characters(data: bytes) -> str:
    """Bytes as text, seven bits in each character.

    A character that is unfit is told beside the next one, by one of 128 or above: two bytes in UTF-8 for two.
    """
    bits = np.unpackbits(np.frombuffer(data, np.uint8))
    sevens = np.append(bits, np.zeros(-bits.size % 7, np.uint8)).reshape(-1, 7)
    values = iter((sevens @ (1 << np.arange(6, -1, -1))).tolist())
    return "".join(
        chr(128 * (1 + _UNFIT.index(x)) + next(values, 0)) if x in _UNFIT else chr(x) for x in values
    )
