"""Writes patch_impacts.csv: single impacts on a round patch, where the drilling changes together with the slip.

    python tests/reference/patch_impacts.py

It needs gmpy2, and minutes. A row has

    name                       of the body and of what it does
    e, mu, patch               restitution, coefficient of friction, radius eps of the patch
    m11 m12 m22 m13 m23 m33    the velocity of the point that an impulse gives, along two horizontal axes and upwards
    m14 m24 m34 m44            the same of an impulse of a couple about the vertical, and the drilling that it gives
    u1 u2 u3, w                velocity of the point and drilling before the impact
    kind                       how it ends: slips (|u| > eps |w|), creeps (less), sticks (both have stopped and friction
                               holds them), slips on (it does not), smooth
    times                      how often the point is pressed in
    p1 p2 p3, c                the impulse and that of the couple
    v1 v2 v3, x                velocity and drilling after the impact
    lost                       the energy lost
    agreement                  the largest difference of two ways, over 1 or the number if that is more

Along the impact, p the normal impulse so far and k = |u|/(eps |w|),

    (P_1, P_2, C)' = -mu (f(k) u/|u|, eps g(k) sgn w),    (u, w)' = B + G (P_1, P_2, C)',    W' = u_n

and W decides where the impact ends, as point_impacts.py says. Both ways follow series in tau, dp = |(u, eps w)| dtau;
kinds of phases are those of patch_forms.py. Where slip and drilling have stopped, friction holds them if the push that
it takes lies inside (mu f(k), mu eps g(k)); else they go on along the one direction y with B + G F(y) = lam y, lam > 0.

    components   along the axes in which the matrix is given, with f and g in closed form
    directions   along the axes of the horizontal part of the matrix, with f and g by chords

Inputs are exact doubles, written as hexadecimal; results are decimal, to 25 digits.
"""

import pathlib

import gmpy2
import patch_forms
import patch_vectors
from flight_forms import FINE, ORDER, STOPPED, Watched
from gmpy2 import mpfr
from phases import first_event, step_size
from point_impacts import Course
from series import Tape, precise
from stone_hops import BALL, SKEW
from stone_impacts import LIGHT, answers
from stones import SMALL
from tables import decimal
from torus import rounded, tube
from vectors import add, cross, dot, scaled, solver

HERE = pathlib.Path(__file__).parent
DIGITS = 50
PLACES = [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2), (0, 3), (1, 3), (2, 3), (3, 3)]
HEAD = (
    "name,e,mu,patch,m11,m12,m22,m13,m23,m33,m14,m24,m34,m44,u1,u2,u3,w,"
    "kind,times,p1,p2,p3,c,v1,v2,v3,x,lost,agreement"
)


class Impact:
    """One impact with the friction of a formulation; the last number of a state is the angle of `outside`."""

    def __init__(self, matrix, mu, patch):
        self.matrix, self.mu, self.patch = matrix, mu, patch
        self.phases, self.series_order = {}, self.impact_order

    def slip_and_drilling(self, y):
        return gmpy2.hypot(y[0], y[1]), y[3]

    def equations(self, kind, sign):
        tape = Tape()
        u, v, lift, drilling = (tape.state() for _ in range(4))
        work, *_ = (tape.state() for _ in range(5))
        square = u * u + v * v
        pull, turn, size, q = self.friction(tape, kind, sign, square, drilling)
        push = [pull * u, pull * v, tape.constant(1), turn]
        rates = [dot4(row, push) for row in self.matrix]
        wide = self.patch * drilling
        pace = tape.sqrt(square + wide * wide)
        bend = tape.constant(0)
        if kind == "outside":
            growth = (u * rates[0] + v * rates[1]) / size
            bend = pace * ((self.patch * rates[3] - q * growth) / size)
            stretched = pace * tape.stretch
        else:
            stretched = pace
        tape.rates = [stretched * x for x in (*rates, lift + 0, *push)] + [bend]
        tape.named = {"slip": [u, v, drilling], "size": pace, "lift": lift, "work": work, "push": push}
        return tape

    def at(self, y):
        """What friction and the normal force push per unit of the normal impulse."""
        kind, sign, y = self.enter([*y, *[mpfr(0)] * 6])
        tape = self.phase(kind, sign)
        tape.expand(y, 0)
        return [x.c[0] for x in tape.named["push"]]

    def run(self, u, e):
        """The impulse (P, C), what the contact does, and how often it is pressed in, in units of the normal velocity."""
        course, y, kind = Course(e), [*u, *[mpfr(0)] * 6], None
        moves = bool(u[0] or u[1] or u[3]) and self.mu > 0
        while moves:
            if kind is None:
                kind, sign, y = self.enter(y)
            tape = self.phase(kind, sign)
            tape.expand(y, self.series_order)
            watched = Watched(tape)
            watched.slip, watched.size = tape.named["slip"], tape.named["size"]
            lift, work = tape.named["lift"], tape.named["work"]
            h = min(step_size(watched, self.series_order, FINE), mpfr(4))
            h = min(
                h, 8 * (abs(lift.c[0]) + abs(work.c[0]) + mpfr("1e-6")) / max(abs(lift.c[1]), mpfr("1e-60"))
            )
            place, name = first_event([*course.watched(lift, work), *tape.events], h)
            y = [node.at(h if name is None else place) for node in tape.states]
            course.work = y[4]
            if course.happened(name, y[4]):
                size, drilling = self.slip_and_drilling(y)
                creeps = size < self.patch * abs(drilling)
                return y[5:9], "creeps" if creeps else "slips", course.times
            if name == "slides":
                kind, y = "outside", [*y[:-1], sign * gmpy2.const_pi() / 2]
            elif name == "creeps":
                kind = "inside"
            elif name == "turns":
                sign = -sign
            elif name in ("far", "near"):
                kind, sign, y = self.enter(y)
                kind = {"near": "outside"}.get(name, name)
            moves = gmpy2.hypot(gmpy2.hypot(y[0], y[1]), self.patch * y[3]) > STOPPED
        push, does = self.stopped()
        p = course.straight(y[2], dot4(self.matrix[2], push))
        return [a + p * b for a, b in zip(y[5:9], push, strict=True)], does, course.times

    def stopped(self):
        """What is pushed once slip and drilling have stopped, and what the contact does."""
        if self.mu == 0:
            return [mpfr(x) for x in (0, 0, 1, 0)], "smooth"
        own = [0, 1, 3]
        solve = solver([[self.matrix[i][j] for i in own] for j in own])
        wanted = [self.matrix[i][2] for i in own]
        held = solve(scaled(-1, wanted))
        pull, turn = gmpy2.hypot(held[0], held[1]) / self.mu, abs(held[2]) / (self.mu * self.patch)
        if pull < 1 and turn < self.most(pull):
            return [*held[:2], mpfr(1), held[2]], "sticks"
        return self.leaves(own, wanted), "slips on"

    def most(self, pull):
        """The couple g(k) at the k whose force is f(k)."""

        def law(k):
            pushed = self.at([self.patch * k, mpfr(0), mpfr(0), mpfr(1)])
            return -pushed[0] / self.mu, -pushed[3] / (self.mu * self.patch)

        low, high = mpfr(0), mpfr(1)
        while law(high)[0] < pull:
            low, high = high, 2 * high
        for _ in range(gmpy2.get_context().precision):
            k = (low + high) / 2
            low, high = (k, high) if law(k)[0] < pull else (low, k)
        return law(low)[1]

    def leaves(self, own, wanted):
        """The push along the one way out: the motion from near 0 tends to it, and Newton's method finds it."""

        def rates(y):
            pushed = self.at([y[0], y[1], mpfr(0), y[2]])
            return add(wanted, *([self.matrix[i][j] * pushed[j] for i in own] for j in own))

        y = scaled(mpfr("1e-3"), wanted)
        for k in range(400):
            step = mpfr("2e-4") * mpfr("1.03") ** k
            half = add(y, scaled(step / 2, rates(y)))
            y = add(y, scaled(step, rates(half)))
        y = rates(y)
        for _ in range(12):
            off = add(y, scaled(-1, rates(y)))
            columns = []
            for j in range(3):
                moved, d = list(y), mpfr("1e-25") * (abs(y[j]) + mpfr("1e-3"))
                moved[j] += d
                other = add(moved, scaled(-1, rates(moved)))
                columns.append(scaled(1 / d, add(other, scaled(-1, off))))
            y = add(y, scaled(-1, solver(columns)(off)))
        assert max(abs(x) for x in add(y, scaled(-1, rates(y)))) < 1e-40
        return self.at([y[0], y[1], mpfr(0), y[2]])


def dot4(a, b):
    return dot(a, b) + a[3] * b[3]


class Closed(Impact, patch_forms.Reduced):
    """The law in closed form."""

    impact_order = ORDER


class Chords(Impact, patch_vectors.Vectors):
    """The law by chords."""

    impact_order = ORDER - 3

    def __init__(self, matrix, mu, patch):
        super().__init__(matrix, mu, patch)
        self.rule = patch_vectors.gauss(self.chords)


def components(matrix, y, e, mu, patch):
    unit = abs(y[2])
    given, kind, times = Closed(matrix, mu, patch).run([x / unit for x in y], e)
    return scaled(unit, given), kind, times


def directions(matrix, y, e, mu, patch):
    angle = gmpy2.atan2(2 * matrix[0][1], matrix[0][0] - matrix[1][1]) / 2
    cosine, sine = gmpy2.cos(angle), gmpy2.sin(angle)

    def turned(v, sine):
        return [cosine * v[0] + sine * v[1], cosine * v[1] - sine * v[0], *v[2:]]

    rows = [turned(row, sine) for row in matrix]
    whole = list(zip(*(turned(column, sine) for column in zip(*rows, strict=True)), strict=True))
    unit = abs(y[2])
    given, kind, times = Chords(whole, mu, patch).run(turned([x / unit for x in y], sine), e)
    return scaled(unit, turned(given, -sine)), kind, times


# The impacts.


def rim(body, theta):
    """Of a body of revolution: along the lean, across, upwards, and about the vertical, in doubles."""
    ell, i1, i3, fillet = (mpfr(x) for x in body)
    s, c = gmpy2.sin(mpfr(theta)), gmpy2.cos(mpfr(theta))
    zero, one = mpfr(0), mpfr(1)
    h, z, e1, e3 = [one, zero, zero], [zero, zero, one], [c, zero, s], [-s, zero, c]
    r = add(scaled(-(1 - fillet), e1), scaled(-ell, e3), scaled(-fillet, z))

    def turned(couple):
        across = [zero, couple[1] / i1, zero]
        return add(scaled(dot(couple, e1) / i1, e1), across, scaled(dot(couple, e3) / i3, e3))

    turns = [cross(r, h), cross(r, [zero, one, zero]), cross(r, z), z]
    light = [[dot(turned(a), b) + (i == j < 3) for j, b in enumerate(turns)] for i, a in enumerate(turns)]
    return [[float(x) if abs(x) > 1e-40 else 0.0 for x in row] for row in light]


def cases():
    """Name, matrix, (u1, u2, u3, w), restitution, mu and the radius of the patch."""
    skew, side = answers(SKEW, (0.36, 0.48, 0.8)), answers(SMALL, (0.7, -1.3, -0.5))
    ball, light = answers(BALL, (0, 0, 1)), answers(LIGHT, (-0.16, 0.84, 0.52))
    can, coin, round_rim = (
        rim(tube(0.5, 0.0), 0.5),
        rim(tube(0.0854, 0.0), 0.3),
        rim(rounded(0.17, 0.05), 0.6),
    )
    top = rim((-0.2, 0.4, 0.42, 1.0), 0.4)
    yield "skew stone slips", skew, (0.5, -0.3, -1, 3), 0.6, 0.2, 0.05
    yield "skew stone slips on a small patch", skew, (0.5, -0.3, -1, 3), 0.6, 0.2, 0.001
    yield "skew stone comes to creep", skew, (0.5, -0.3, -1, 3), 0.6, 0.6, 0.05
    yield "skew stone comes to creep on a wide patch", skew, (0.5, -0.3, -1, -3), 0.6, 0.6, 0.4
    yield "skew stone lands without drilling", skew, (0.5, -0.3, -1, 0), 0.6, 0.3, 0.05
    yield "skew stone lands without slip", skew, (0, 0, -1, 3), 0.6, 0.4, 0.05
    yield "skew stone whose drilling turns round", skew, (0.5, -0.3, -1, -0.3), 0.8, 0.4, 0.05
    yield "skew stone begins to slip", skew, (0.02, 0.01, -1, 0.8), 0.6, 0.2, 0.05
    yield "skew stone slips elastically", skew, (0.5, -0.3, -0.2, 2), 1, 0.3, 0.1
    yield "skew stone slips without restitution", skew, (0.5, -0.3, -1, 2), 0, 0.3, 0.1
    yield "skew stone stops", skew, (0.05, -0.03, -1, 0.1), 0.5, 0.8, 0.3
    yield "skew stone lands at rest and slips on", skew, (0, 0, -1, 0), 0.6, 0.25, 0.05
    yield "skew stone lands at rest and sticks", skew, (0, 0, -1, 0), 0.6, 0.8, 0.3
    yield "rattleback turns round and slips", side, (-0.3, -0.06, -1, -0.1), 0.3, 0.7, 0.02
    yield "light stone is pressed in by its friction", light, (3, -0.6, -1, 4), 0.5, 0.88, 0.05
    yield "ball slips and creeps", ball, (0.3, -0.1, -1, 4), 0.8, 0.2, 0.1
    yield "ball slips", ball, (3, -1, -1, 4), 0.8, 0.2, 0.1
    yield "ball with pure spin", ball, (0, 0, -1, 2), 0.7, 0.3, 0.05
    yield "ball near pure spin", ball, (1e-9, 2e-9, -1, 2), 0.7, 0.3, 0.05
    yield "ball stops", ball, (0.1, -0.05, -1, 0.3), 0.8, 0.6, 0.3
    yield "ball on a smooth table", ball, (0.1, -0.05, -1, 0.3), 0.8, 0, 0.3
    yield "can lands", can, (0.3, -0.4, -1, 3), 0.5, 0.3, 0.05
    yield "can lands and creeps", can, (0.1, 0.02, -1, 6), 0.5, 0.3, 0.1
    yield "coin lands near its face", coin, (0.1, -0.05, -0.5, 4), 0.3, 0.2, 0.0155
    yield "rounded rim lands", round_rim, (0.3, 0.5, -1, -2), 0.6, 0.3, 0.05
    yield "top lands near pure spin", top, (1e-3, -2e-3, -1, 12), 0.6, 0.3, 0.05


def row(name, matrix, y, e, mu, patch):
    exact, state = [[mpfr(x) for x in line] for line in matrix], [mpfr(x) for x in y]
    told = []
    for way in (components, directions):
        given, kind, times = way(exact, state, mpfr(e), mpfr(mu), mpfr(patch))
        after = [a + dot4(line, given) for a, line in zip(state, exact, strict=True)]
        if kind == "sticks":
            after = [mpfr(0), mpfr(0), after[2], mpfr(0)]
        if e == 0:
            after[2] = mpfr(0)
        told.append((kind, times, [*given, *after, -dot4(add(state, after), given) / 2]))
    (_, _, one), (kind, times, other) = told
    assert told[0][:2] == told[1][:2], (name, told)
    apart = max(abs(x - y) / max(1, abs(y)) for x, y in zip(one, other, strict=True))
    print(f"{name}: {kind}, {times}, {float(apart):.1e}", flush=True)
    given = [float(x).hex() for x in (e, mu, patch, *(matrix[i][j] for i, j in PLACES), *y)]
    return ",".join(
        [name, *given, kind, str(times), *(decimal(x, 1e-35) for x in other), f"{float(apart):.1e}"]
    )


def main():
    precise(DIGITS)
    (HERE / "patch_impacts.csv").write_text("\n".join([HEAD, *(row(*case) for case in cases())]) + "\n")


if __name__ == "__main__":
    main()
