"""Compression of what a page contains; web/build.py reads this file alone."""


def compressed(data: bytes) -> bytes:
    """Bytes in the format ".lzma", with the parameters that `play.lzma.js` expects."""
    import lzma  # here, since some builds of Python lack it

    # lp and pb are 0, since neither a core nor a text consists of words of equal length
    how = {"preset": 9 | lzma.PRESET_EXTREME, "dict_size": 1 << 21, "lc": 1, "lp": 0, "pb": 0}
    return lzma.compress(data, lzma.FORMAT_ALONE, filters=[{"id": lzma.FILTER_LZMA1, **how}])


def expanded(data: bytes) -> bytes:
    """The bytes that were compressed."""
    import lzma

    return lzma.decompress(data, lzma.FORMAT_ALONE)
