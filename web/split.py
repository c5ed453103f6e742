"""Splits a core into streams of like numbers, which compress better; `play.join.js` joins them."""

#: The streams, in their order; "head" and "tail" are what is before and after the code.
STREAMS = ("head", "forms", "codes", "constants", "offsets", "gets", "sets", "floats", "tail")
#: Instructions with one number: branches, calls, globals, the size of the memory and integers of 64 bits.
PLAIN = 12, 13, 16, 35, 36, 63, 64, 66
#: The section of a module that contains its code.
CODE = 10


class Split:
    """The streams of a core."""

    def __init__(self, core):
        self.core, self.at = core, 8
        self.streams = {name: bytearray() for name in STREAMS}
        while self.byte("head") != CODE:
            self.bytes("head", self.number("head"))
        end = self.number("head") + self.at
        for _ in range(self.number("forms")):
            self._function()
        if self.at != end:
            raise ValueError("the code of the core has instructions that web/split.py does not know")
        self.streams["tail"] += core[end:]
        self.streams["head"][:0] = core[:8]

    def data(self):
        """The length of the core, those of the streams, and the streams."""
        lengths = [len(self.core), *map(len, self.streams.values())]
        return b"".join([*(n.to_bytes(4, "big") for n in lengths), *self.streams.values()])

    def bytes(self, name, count):
        """Moves some bytes to a stream."""
        self.streams[name] += self.core[self.at : self.at + count]
        self.at += count

    def byte(self, name):
        """Moves one byte to a stream, and returns it."""
        self.bytes(name, 1)
        return self.core[self.at - 1]

    def number(self, *names):
        """Moves a number of any length (LEB128) to each of some streams; returns the last one."""
        for name in names:
            found = shift = 0
            while (byte := self.byte(name)) > 127:
                found |= (byte & 127) << shift
                shift += 7
            found |= byte << shift
        return found

    def _function(self):
        """Splits one function; its length follows from its end, but is written in the fewest bytes only."""
        begin, forms = self.at, len(self.streams["forms"])
        length = self.number("forms")
        del self.streams["forms"][forms:]
        if self.at - begin != max(1, -(-length.bit_length() // 7)):
            raise ValueError("a length in the core is not written in the fewest bytes")
        end = self.at + length
        for _ in range(self.number("forms")):
            self.number("forms", "forms")
        depth = 1
        while depth:
            depth += self._instruction(self.byte("codes"))
        if self.at != end:
            raise ValueError("a function of the core has instructions that web/split.py does not know")

    def _instruction(self, code):
        """Moves the operands of one instruction; returns by how much deeper the next one is nested."""
        if code == 11:
            return -1
        if 2 <= code <= 4:
            self.number("codes")
            return 1
        if code in PLAIN:
            self.number("codes")
        elif code == 14:
            for _ in range(self.number("codes") + 1):
                self.number("codes")
        elif code == 17:
            self.number("codes", "codes")
        elif code == 32:
            self.number("gets")
        elif code in (33, 34):
            self.number("sets")
        elif 40 <= code <= 62:
            self.number("codes", "offsets")
        elif code == 65:
            self.number("constants")
        elif code in (67, 68):
            self.bytes("floats", 4 if code == 67 else 8)
        elif code == 252:
            for _ in range({8: 2, 9: 1, 10: 2, 11: 1}.get(self.number("codes"), 0)):
                self.number("codes")
        elif code == 253:
            self._simd(self.number("codes"))
        return 0

    def _simd(self, code):
        """Moves the operands of one instruction on vectors."""
        if code in (12, 13):
            self.bytes("floats", 16)
        elif code < 12 or 84 <= code <= 93:
            self.number("codes", "offsets")
        if 21 <= code <= 34 or 84 <= code <= 91:
            self.number("codes")
