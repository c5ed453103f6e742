"""Motions of high precision by Taylor series: the coefficients of every quantity of a model, order by order.

A model writes its equations once with the nodes of a `Tape`; `Tape.expand` then finds the power series of all of
them at a state. The numbers are those of MPFR, by gmpy2. It knows no physics.
"""

from itertools import islice
from operator import mul

import gmpy2
from gmpy2 import mpfr


def precise(digits):
    """Sets the digits of all that follows."""
    gmpy2.get_context().precision = int(digits * 3.3219280948873626) + 8


class Node:
    """A quantity: its number on the tape, and its coefficients."""

    __slots__ = ("c", "tape")

    def __init__(self, tape):
        self.tape, self.c = tape, []

    def __add__(self, other):
        return self.tape.sum(self, other)

    __radd__ = __add__

    def __neg__(self):
        return self.tape.scaled(self, mpfr(-1))

    def __sub__(self, other):
        return self + (-other)

    def __rsub__(self, other):
        return (-self) + other

    def __mul__(self, other):
        return self.tape.product(self, other)

    __rmul__ = __mul__

    def __truediv__(self, other):
        if not isinstance(other, Node):
            return self.tape.scaled(self, 1 / mpfr(other))
        return self.tape.quotient(self, other)

    def __rtruediv__(self, other):
        return self.tape.quotient(self.tape.constant(other), self)

    def at(self, h):
        """Its value at h from the point of expansion."""
        total = mpfr(0)
        for x in reversed(self.c):
            total = total * h + x
        return total


class Tape:
    """The equations of a model: states, what follows from them, and the rates of the states."""

    def __init__(self):
        self.rules, self.nodes, self.states, self.rates = [], [], [], []

    def _new(self, rule):
        node = Node(self)
        self.nodes.append(node)
        self.rules.append(lambda k, node=node, c=node.c: c.append(rule(k, c)))
        return node

    def state(self):
        """A quantity that is integrated."""
        node = Node(self)
        self.states.append(node)
        self.nodes.append(node)
        return node

    def constant(self, value):
        value = mpfr(value)
        return self._new(lambda k, c: mpfr(0) if k else value)

    def sum(self, a, b):
        a = a.c
        if not isinstance(b, Node):
            b = mpfr(b)
            return self._new(lambda k, c: a[k] if k else a[0] + b)
        b = b.c
        return self._new(lambda k, c: a[k] + b[k])

    def scaled(self, a, by):
        a = a.c
        return self._new(lambda k, c: a[k] * by)

    def product(self, a, b):
        if not isinstance(b, Node):
            return self.scaled(a, mpfr(b))
        a, b = a.c, b.c
        return self._new(lambda k, c: sum(map(mul, a, reversed(b))))

    def quotient(self, a, b):
        a, b = a.c, b.c

        def rule(k, c):
            if not k:
                return a[0] / b[0]
            return (a[k] - sum(map(mul, islice(b, 1, None), reversed(c)))) / b[0]

        return self._new(rule)

    def sqrt(self, a):
        a = a.c

        def rule(k, c):
            if not k:
                return gmpy2.sqrt(a[0])
            known = a[k] - sum(map(mul, islice(c, 1, None), islice(reversed(c), k - 1))) if k > 1 else a[k]
            return known / (2 * c[0])

        return self._new(rule)

    def sin_cos(self, a):
        """Sine and cosine, by s' = c a', c' = -s a'."""
        a = a.c
        sine, cosine = Node(self), Node(self)
        s, c = sine.c, cosine.c
        slope = []

        def rule(k):
            if not k:
                s.append(gmpy2.sin(a[0]))
                c.append(gmpy2.cos(a[0]))
                return
            del slope[k - 1 :]
            slope.append(k * a[k])
            more = sum(map(mul, slope, reversed(c))) / k, sum(map(mul, slope, reversed(s))) / k
            s.append(more[0])
            c.append(-more[1])

        self.nodes += [sine, cosine]
        self.rules.append(rule)
        return sine, cosine

    def expand(self, start, order):
        """Fills the series of every quantity about a state, up to this order."""
        for node in self.nodes:
            node.c.clear()
        for node, value in zip(self.states, start, strict=True):
            node.c.append(value)
        for k in range(order + 1):
            if k:
                for node, rate in zip(self.states, self.rates, strict=True):
                    node.c.append(rate.c[k - 1] / k)
            for rule in self.rules:
                rule(k)

    def drift(self, r, a):
        """r a', for a series r that begins with its second power: so it knows nothing of the newest of a."""
        r, a = r.c, a.c
        return self._new(
            lambda k, c: sum((r[j] * ((k - j + 1) * a[k - j + 1]) for j in range(2, k + 1)), mpfr(0))
        )

    def expand_slaved(self, start, order, slaved, residual):
        """The same where one state has no rate: it makes `residual` vanish, which is linear in its newest number."""
        slope = None

        def fill(k, newest):
            for node, rate in zip(self.states, self.rates, strict=True):
                node.c.append(newest if node is slaved else rate.c[k - 1] / k)
            for rule in self.rules:
                rule(k)
            return residual.c[k]

        self.expand(start, 0)
        for k in range(1, order + 1):
            left = fill(k, mpfr(0))
            if slope is None:
                self._forget()
                slope = fill(k, mpfr(1)) - left
            self._forget()
            fill(k, -left / slope)

    def _forget(self):
        """Takes back the newest order."""
        for node in self.nodes:
            node.c.pop()


def root(node, low, high):
    """Where a series changes its sign between two places: the false position, kept moving (Illinois)."""
    f_low, f_high = node.at(low), node.at(high)
    if not (f_low > 0) != (f_high > 0):
        raise ArithmeticError("no change of sign")
    smallest = abs(high) * mpfr(2) ** (4 - gmpy2.get_context().precision)
    side = 0
    for _ in range(300):
        x = (low * f_high - high * f_low) / (f_high - f_low)
        f = node.at(x)
        if f == 0 or abs(high - low) <= smallest:
            return x
        if (f > 0) == (f_low > 0):
            if abs(x - low) <= smallest:
                return x
            low, f_low = x, f
            if side == 1:
                f_high /= 2
            side = 1
        else:
            if abs(x - high) <= smallest:
                return x
            high, f_high = x, f
            if side == -1:
                f_low /= 2
            side = -1
    return x
