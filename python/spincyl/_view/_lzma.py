"""What a page carries packed: bytes by LZMA, and those as text.

play.lzma.js and play.loader.js are the inverse.
"""

import lzma

import numpy as np

#: The raw stream with an end marker, as play.lzma.js knows it.
_FILTERS = [
    {"id": lzma.FILTER_LZMA1, "preset": 9 | lzma.PRESET_EXTREME, "lc": 3, "lp": 0, "pb": 0, "nice_len": 273}
]
#: What does not survive in a page: NUL, CR, and what a tag begins with.
_UNFIT = 0, 13, 60


def packed(first: bytes, second: bytes) -> str:
    """Two pieces as text that can stand in a script element: their sizes, four bytes each, and their LZMA."""
    sizes = len(first).to_bytes(4, "big") + len(second).to_bytes(4, "big")
    return characters(sizes + lzma.compress(first + second, lzma.FORMAT_RAW, filters=_FILTERS))


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
