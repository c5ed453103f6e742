"""Splits a core into streams of like numbers, which compress better; `play.join.js` joins them."""

#: The streams, in their order; "head" and "tail" are what is before and after the code.
STREAMS = ("head", "forms", "codes", "short", "middle", "long", "offsets", "gets", "sets", "floats", "tail")
#: Instructions with one number: branches, calls, globals, the size of the memory and integers of 64 bits.
PLAIN = 12, 13, 16, 35, 36, 63, 64, 66
#: log2 of the bytes that a load or store moves, in the order of their codes: their alignment, but for few.
ALIGNED, FIRST_ALIGNED = "23230011001122232301012", 40
#: Added to the code of a load or store that is aligned otherwise: no instruction has such a code.
OTHERWISE = 185
#: Codes of an integer constant by its length: of one byte, two, and more.
CONSTANT = {1: (65, "short"), 2: (249, "middle")}
LONG = 250, "long"
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
            if self.core[self.at] == int(ALIGNED[code - FIRST_ALIGNED]):
                self.at += 1
            else:
                self.streams["codes"][-1] += OTHERWISE
                self.number("codes")
            self.number("offsets")
        elif code == 65:
            length = next(n for n in range(1, 6) if self.core[self.at + n - 1] < 128)
            self.streams["codes"][-1], stream = CONSTANT.get(length, LONG)
            self.bytes(stream, length)
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
