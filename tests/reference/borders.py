"""The circles with which a body of revolution touches the table, and the borders between them, for lying.py and rims.py.

A circle is (a, l, rho): its radius, how far it is below the centre of mass along the axis, and its fillet; they
stand in the order in which they carry as theta grows from 0 to pi. Between two neighbours is a border, where both
are down at once; or, where a fillet goes on in the next one, a smooth joint, where only one place is.

theta, e3, phi and psi are told from the body, never from the circle that carries, so nothing is ever mirrored.
"""

import gmpy2
from gmpy2 import mpfr

ZERO = mpfr(0)


class Border:
    """Sine and cosine of theta where the circles b and b + 1 are both down, and the length between the contacts."""

    def __init__(self, circles, b):
        self.circles, self.b = circles, b
        (a, l, rho), (a1, l1, rho1) = circles[b : b + 2]  # noqa: E741
        self.apart = da, dl, dr = a - a1, l - l1, rho - rho1
        square = da * da + dl * dl
        self.smooth = abs(square - dr * dr) < mpfr("1e-12") * square
        m = gmpy2.sqrt(square)
        share = mpfr(gmpy2.sign(-dr)) if self.smooth else -dr / m
        across = ZERO if self.smooth else gmpy2.sqrt(1 - share * share)
        self.s, self.c = (da * share + dl * across) / m, (dl * share - da * across) / m

    def found(self):
        """The same by Newton's steps, from the heights of both or, at a smooth joint, their slopes."""
        da, dl, dr = self.apart
        theta = mpfr(float(gmpy2.atan2(self.s, self.c)))
        for _ in range(8):
            s, c = gmpy2.sin(theta), gmpy2.cos(theta)
            height, slope = dl * c + da * s + dr, dl * s - da * c
            theta += slope / (dr - height) if self.smooth else height / slope
        self.s, self.c = gmpy2.sin(theta), gmpy2.cos(theta)
        return self


class Place:
    """A circle at a border: A, L and g of rims.md, its arm -p e3 - q z from the centre, and the common height Z."""

    def __init__(self, circle, border):
        s, c = border.s, border.c
        a, l, rho = circle  # noqa: E741
        self.radius, self.depth = a + rho * s, l + rho * c
        self.g, self.height = l * s - a * c, l * c + a * s + rho
        self.p, self.q = self.g / s, a / s + rho


class Profile:
    """What both formulations know of the circles of a body: `k` carries, and `o` with it while two are down."""

    exact = True  # borders by their closed form

    def prepare_profile(self, circles, k, o):
        self.circles = [tuple(map(mpfr, circle)) for circle in circles]
        self.borders = [Border(self.circles, b) for b in range(len(circles) - 1)]
        if not self.exact:
            self.borders = [border.found() for border in self.borders]
        self.o, self.changes, self.known = o, 0, {}
        self.carry(k)

    def carry(self, k):
        """From now on this circle carries, or is the one that is told."""
        self.k = k
        self.rim, self.ell, self.fillet = self.circles[k]
        self.phases = self.known.setdefault(k, {})

    def swap(self):
        """The other one of two carries, or is told."""
        k, self.o = self.o, self.k
        self.carry(k)
        self.changes += 1

    @property
    def border(self):
        return self.borders[min(self.k, self.o)]

    @property
    def places(self):
        """The told circle and the other one, at their border."""
        return Place(self.circles[self.k], self.border), Place(self.circles[self.o], self.border)

    def neighbours(self):
        """The circles that may land, with their borders."""
        if self.k > 0:
            yield self.k - 1, self.borders[self.k - 1]
        if self.k < len(self.circles) - 1:
            yield self.k + 1, self.borders[self.k]

    def equations(self, kind):
        """A phase on one circle, with how far it is from its borders: above 0 within them."""
        phase = super().equations(kind)
        s, c = self.axis(phase)
        phase.sine = s
        phase.gaps = {
            o: self.gap(border, s, c) * (1 if o > self.k else -1) for o, border in self.neighbours()
        }
        return phase

    def events(self, phase, kind):
        """What may end a phase on one circle but the borders."""
        yield ("lift-off", phase.normal) if kind != "roll" else ("slips", phase.demand)
        if self.rim:
            yield "face", phase.sine
