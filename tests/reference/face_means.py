"""Writes face_means.csv: the means of friction over the pressed part of a face, the reference of the tests of a face.

    python tests/reference/face_means.py

A ring or a disc slides along x with the speed v = k and spins counterclockwise with s = 1. Its pressure is linear in the
place along the direction at the angle c from v, and zero where that is negative; `width` = sin^2(b/2) with cos b the
place of the cut. The means are those of the direction u/|u| of the slip u along this direction and across it, and of
x cross u/|u|; `centre` is the centre of the pressure. mpmath at 30 digits, with the definitions and no formula for X:

    ring    sums along the arc, in pieces that shrink towards the place where the slip is least
    disc    strips across the direction, whose integrals are elementary (the slip is a turn about one point), and
            a sum over them, in pieces that shrink towards this point

A width of 1.5 or more stands for a pressure 1 + x.X that presses everywhere: the ring with |X| = 2 centre, the disc with
4 centre; the centre is then 1/(2 width) or 1/(4 (width - 0.5)). Inputs are exact doubles, written as hexadecimal.
"""

import itertools
import pathlib
import random

from mpmath import mp, mpf

mp.dps = DIGITS = 34


NODES = 40


def rule():
    """Gauss's rule on [-1, 1]: places and weights."""
    for i in range(NODES):
        x = mp.cos(mp.pi * (i + mpf("0.75")) / (NODES + mpf("0.5")))
        for _ in range(8):
            before, here = mpf(1), x
            for n in range(1, NODES):
                before, here = here, ((2 * n + 1) * x * here - n * before) / (n + 1)
            slope = NODES * (x * here - before) / (x * x - 1)
            x -= here / slope
        yield x, 2 / ((1 - x * x) * slope * slope)


RULE = list(rule())


def total(sums, left, right, near):
    """Integrals of the five sums, in pieces that shrink towards places (place, least length)."""
    ends = {left, right}
    for place, least in near:
        steps = [mpf(0)]
        while not steps[-1] > 8:
            steps.append(max(least, 3 * steps[-1]))
        ends |= {end for step in steps for end in (place - step, place + step) if left < end < right}
    ends, found = sorted(ends), [mpf(0)] * 5
    for a, b in itertools.pairwise(ends):
        for x, weight in RULE:
            terms = sums((a + b) / 2 + (b - a) / 2 * x)
            found = [sum_ + weight * (b - a) / 2 * term for sum_, term in zip(found, terms, strict=True)]
    return found


def slope_and_cut(form, width):
    """The pressure base + slope x along the direction, and the least x."""
    if width < mpf("1.5"):
        cut = 1 - 2 * width
        return -cut, mpf(1), cut
    centre = 1 / (2 * width) if form == "ring" else 1 / (4 * (width - mpf("0.5")))
    return mpf(1), (2 if form == "ring" else 4) * centre, mpf(-1)


def ring(k, width, angle):
    base, slope, cut = slope_and_cut("ring", width)
    b = mp.acos(cut)
    near, least = mp.pi / 2 - angle, abs(mp.log(k)) if k != 1 else mpf(1)

    def sums(t):
        chi = t + angle
        ux, uy = k - mp.sin(chi), mp.cos(chi)
        # without loss where both are small
        size = mp.sqrt((k - 1) ** 2 + 4 * k * mp.sin((chi - mp.pi / 2) / 2) ** 2)
        p = base + slope * mp.cos(t)
        along, across = ux * mp.cos(angle) + uy * mp.sin(angle), uy * mp.cos(angle) - ux * mp.sin(angle)
        return [
            p,
            p * mp.cos(t),
            p * along / size,
            p * across / size,
            p * (mp.cos(chi) * uy - mp.sin(chi) * ux) / size,
        ]

    return total(sums, -b, b, [(near, least), (near - 2 * mp.pi, least)])


def disc(k, width, angle):
    base, slope, cut = slope_and_cut("disc", width)
    # the point that rests, along the direction and across it
    pole = k * mp.sin(angle), k * mp.cos(angle)

    def strip(x):
        """Integrals across at the place x along, of 1, u/|u| and x cross u/|u|."""
        # far from the point that rests the ends of a strip nearly cancel
        mp.dps = DIGITS + 3 * int(mp.log10(max(k, 1)))
        half, off = mp.sqrt((1 - x) * (1 + x)), x - pole[0]
        out = []
        for y in (half - pole[1], -half - pole[1]):
            size = mp.sqrt(off * off + y * y)
            turn = mp.asinh(y / abs(off)) if off else mpf(0)
            out.append(
                [-size, off * turn, x * off * turn + (y * size - off * off * turn) / 2 + pole[1] * size]
            )
        found = [2 * half] + [a - b for a, b in zip(*out, strict=True)]
        mp.dps = DIGITS
        return found

    def sums(turn):
        x = mp.cos(turn)
        p, (area, along, across, couple) = (base + slope * x) * mp.sin(turn), strip(x)
        return [p * area, p * x * area, p * along, p * across, p * couple]

    least = mpf("1e-18")
    near = [(mp.pi / 2 - angle, max(abs(k - 1), least))]
    if abs(pole[0]) < 1:
        near.append((mp.acos(pole[0]), least))
    return total(sums, mpf(0), mp.acos(cut), near)


def row(form, k, width, angle):
    whole, centre, *means = {"ring": ring, "disc": disc}[form](mpf(k), mpf(width), mpf(angle))
    numbers = [mp.nstr(x / whole, 22) for x in (centre, *means)]
    return ",".join([form, *(float(x).hex() for x in (k, width, angle)), *numbers])


def cases():
    draw = random.Random(68).uniform
    ratios = [
        1e-8,
        1e-3,
        0.1,
        0.5,
        0.9,
        0.99,
        1 - 1e-6,
        1 - 2**-52,
        1.0,
        1 + 1e-9,
        1.001,
        1.05,
        1.3,
        2.0,
        10.0,
        1e4,
        1e8,
    ]
    for form in ("ring", "disc"):
        for k in ratios:
            for width in (1.5, draw(1.6, 9), draw(0.5, 1), 10 ** draw(-3, -0.3)):
                yield form, k, width, draw(0, 1.57)
            yield form, k, draw(0.05, 1), 1.5707
        for _ in range(25):
            yield form, 10 ** draw(-0.5, 0.5), draw(0, 1), draw(0, 1.5)


if __name__ == "__main__":
    lines = ["form,k,width,angle,centre,along,across,couple", *(row(*case) for case in cases())]
    pathlib.Path(__file__).with_suffix(".csv").write_text("\n".join(lines) + "\n")
