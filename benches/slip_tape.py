"""The tape of tests/reference/series.py, with its series computed by a few lines of C in long doubles (64
bits).

It is ten times as fast, and made for many truths to 16 or 17 digits. It needs a C compiler, `cc`. Slaved
series (`expand_slaved`) are left to the tape of series.py.
"""

import ctypes
import pathlib
import subprocess
import tempfile

import numpy as np
from gmpy2 import mpfr
from series import Node, Tape

SOURCE = """
typedef long double num;
enum {CONSTANT, SHIFT, SUM, SCALE, PRODUCT, QUOTIENT, ROOT, SINE};
num sinl(num), cosl(num), sqrtl(num);

void expand(int count, const int *op, const num *value, int states, const int *rates, const int *places,
            int order, num *c)
{
    int n = order + 1;
    for (int k = 0; k < n; k++) {
        if (k)
            for (int i = 0; i < states; i++)
                c[places[i] * n + k] = c[rates[i] * n + k - 1] / k;
        for (int i = 0; i < count; i++) {
            const int *o = op + 4 * i;
            num *x = c + o[1] * n, *a = c + o[2] * n, *b = c + o[3] * n, sum = 0, other = 0;
            switch (o[0]) {
            case CONSTANT: x[k] = k ? 0 : value[i]; break;
            case SHIFT: x[k] = k ? a[k] : a[0] + value[i]; break;
            case SUM: x[k] = a[k] + b[k]; break;
            case SCALE: x[k] = a[k] * value[i]; break;
            case PRODUCT:
                for (int j = 0; j <= k; j++) sum += a[j] * b[k - j];
                x[k] = sum;
                break;
            case QUOTIENT:
                for (int j = 1; j <= k; j++) sum += b[j] * x[k - j];
                x[k] = (a[k] - sum) / b[0];
                break;
            case ROOT:
                for (int j = 1; j < k; j++) sum += x[j] * x[k - j];
                x[k] = k ? (a[k] - sum) / (2 * x[0]) : sqrtl(a[0]);
                break;
            case SINE: /* and the cosine, at b */
                for (int j = 1; j <= k; j++) sum += j * a[j] * b[k - j], other += j * a[j] * x[k - j];
                x[k] = k ? sum / k : sinl(a[0]);
                b[k] = k ? -other / k : cosl(a[0]);
            }
        }
    }
}
"""
CONSTANT, SHIFT, SUM, SCALE, PRODUCT, QUOTIENT, ROOT, SINE = range(8)


def compiled():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "expand.c").write_text(SOURCE)
        options = ["-O2", "-shared", "-fPIC", "-fno-builtin", "-o", "expand.so", "expand.c", "-lm"]
        subprocess.run(["cc", *options], cwd=folder, check=True)
        return ctypes.CDLL(str(folder / "expand.so")).expand


EXPAND = compiled()


def long(value):
    """A number as a long double."""
    high = float(value)
    return np.longdouble(high) + np.longdouble(float(value - mpfr(high)))


class LongNode(Node):
    """A quantity whose coefficients are converted from those of the tape when they are first used."""

    __slots__ = ("place", "told")

    def __init__(self, tape):
        self.tape, self.place, self.told = tape, tape.size, (None, None)
        tape.size += 1

    @property
    def c(self):
        if self.told[0] is not self.tape.found:
            row = self.tape.found[self.place]
            high = row.astype(np.float64)
            low = (row - high).astype(np.float64)
            told = [mpfr(a) + b for a, b in zip(high.tolist(), low.tolist(), strict=True)]
            self.told = self.tape.found, told
        return self.told[1]


class Dear(ArithmeticError):
    """Too many steps."""


class Few:
    """For equations of tests/reference: a series of 20 terms, whose steps err by 1e-20, and only so many steps."""

    order, tolerance, left = 20, mpfr("1e-20"), 1500

    def phase(self, *of):
        self.left -= 1
        if self.left < 0:
            raise Dear
        return super().phase(*of)


class LongTape(Tape):
    """A tape whose operations are a table for the C code."""

    def __init__(self):
        self.size, self.table, self.values, self.states, self.rates = 0, [], [], [], []
        self.found, self.ready = None, None

    def _put(self, operation, a=None, b=None, value=0):
        node = LongNode(self)
        self.table.append((operation, node.place, a.place if a else 0, b.place if b else 0))
        self.values.append(long(mpfr(value)))
        return node

    def state(self):
        node = LongNode(self)
        self.states.append(node)
        return node

    def constant(self, value):
        return self._put(CONSTANT, value=value)

    def sum(self, a, b):
        return self._put(SUM, a, b) if isinstance(b, Node) else self._put(SHIFT, a, value=b)

    def scaled(self, a, by):
        return self._put(SCALE, a, value=by)

    def product(self, a, b):
        return self._put(PRODUCT, a, b) if isinstance(b, Node) else self.scaled(a, b)

    def quotient(self, a, b):
        return self._put(QUOTIENT, a, b)

    def sqrt(self, a):
        return self._put(ROOT, a)

    def sin_cos(self, a):
        cosine = LongNode(self)
        return self._put(SINE, a, cosine), cosine

    def expand(self, start, order):
        if self.ready is None:
            rates, places = ([node.place for node in nodes] for nodes in (self.rates, self.states))
            table = np.array(self.table, np.int32)
            values = np.array(self.values, np.longdouble)
            self.ready = table, values, np.array(rates, np.int32), np.array(places, np.int32)
        table, values, rates, places = self.ready
        found = np.zeros((self.size, order + 1), np.longdouble)
        found[places, 0] = [long(y) for y in start]
        at = [ctypes.c_void_p(x.ctypes.data) for x in (table, values, rates, places, found)]
        EXPAND(len(table), at[0], at[1], len(places), at[2], at[3], order, at[4])
        self.found = found
