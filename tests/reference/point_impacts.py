"""One impact at a point of a body of any inertia, in two ways, for stone_impacts.py and stone_hop_forms.py.

The velocity (u1, u2, u_n) of the point answers an impulse P with M P, M symmetric and positive:

    M = [[A, b], [b, a_n]]       along the impact, p the normal impulse:  u_t' = b - mu A d,  u_n' = a_n - mu b.d

d is the direction of the slip, or c times the slip on a viscous film, with c for mu. The work W of the normal force
is the integral of u_n. Compression ends where u_n rises through 0, with the work W_c; the impact ends where
W = (1 - e^2) W_c, after the last compression. Where u_n falls below 0 again before that, W_c is the lowest work so
far. A slip that has stopped holds if |A^-1 b| <= static, else it goes on along the one direction d with
b - mu A d = lam d, lam > 0. On a rolling table the slip is stopped before the normal impulse begins.

    components   series of the slip's two components in the axes in which M is given, 2 x 2 systems by Cramer's rule,
                 the direction of a slip that goes on by looking through all of them
    directions   axes along which A is diagonal; there the angle and the length of the slip. The way out is the root
                 of |(mu A + lam)^-1 b| = 1, a film has two exponentials, the way to a rest on a rolling table
                 two powers

The slip runs in nu, dp = |u| dnu, in units of the first normal velocity.
"""

import gmpy2
from flight_forms import FINE, ORDER, STOPPED, Below, Watched
from flight_vectors import stuck
from gmpy2 import mpfr
from phases import first_event, step_size
from series import Tape
from vectors import add, dot, scaled


class Struck:
    """The impulse, what the contact does, the velocity after it, the energy lost, and how often it is compressed."""

    def __init__(self, matrix, u, e, impulse, kind, times):
        self.impulse, self.kind, self.times = impulse, kind, times
        after = [a + dot(row, impulse) for a, row in zip(u, matrix, strict=True)]
        if kind == "sticks":
            after[:2] = mpfr(0), mpfr(0)
        if e == 0:
            after[2] = mpfr(0)
        self.after, self.lost = after, -dot(add(u, after), impulse) / 2


class Course:
    """How far an impact is: the work, the lowest work at the end of a compression, how often it was compressed."""

    def __init__(self, e):
        self.e, self.work, self.lowest, self.times, self.falls = mpfr(e), mpfr(0), mpfr(0), 0, True

    def watched(self, lift, work):
        """What may happen next along the series of the normal velocity and of the work."""
        if self.falls:
            return [("pressed", Below(lift))]
        return [("falls", lift), ("ends", Below(work, (1 - self.e**2) * self.lowest))]

    def happened(self, name, work):
        """Whether the impact is over."""
        if name == "pressed":
            self.falls, self.times, self.lowest = False, self.times + 1, min(self.lowest, work)
        if name == "falls":
            self.falls = True
        return name == "ends" or (name == "pressed" and self.e == 0)

    def straight(self, lift, rate):
        """The normal impulse up to the end where the normal velocity grows at this rate."""
        assert rate > 0
        if self.falls:
            self.times, self.lowest = self.times + 1, min(self.lowest, self.work - lift**2 / (2 * rate))
            if self.e == 0:
                return -lift / rate
        left = lift**2 + 2 * rate * ((1 - self.e**2) * self.lowest - self.work)
        return (gmpy2.sqrt(max(left, mpfr(0))) - lift) / rate


def followed(course, tape, start, lift, work, slip=(), size=None):
    """The states at the end of the impact, or of its slip, along the series of the equations; and whether it ends."""
    watched = Watched(tape, *([] if size is None else [size]))
    watched.slip, watched.size = slip, size
    for _ in range(4000):
        tape.expand(start, ORDER)
        h = min(step_size(watched, ORDER, FINE), mpfr(2))
        h = min(h, 8 * (abs(lift.c[0]) + abs(work.c[0]) + mpfr("1e-6")) / max(abs(lift.c[1]), mpfr("1e-60")))
        place, name = first_event(course.watched(lift, work), h)
        h = h if name is None else place
        start = [node.at(h) for node in tape.states]
        course.work = work.at(h)
        if course.happened(name, course.work):
            return start, True
        if size is not None and size.at(h) < STOPPED:
            return start, False
    raise ArithmeticError("an impact without end")


def components(matrix, u, e, law, mu, static=None):
    """The impact by components."""
    course, static = Course(e), mu if static is None else static
    columns = [list(column) for column in zip(*matrix, strict=True)]
    unit, kind, given = abs(u[2]), "sticks", [mpfr(0)] * 3
    first, second, lift = u = [x / unit for x in u]
    hold = stuck(columns, scaled(-1, columns[2]))
    if law == "rolling":
        stop = stuck(columns, [-first, -second])
        given, lift = [*stop, mpfr(0)], lift + stop[0] * matrix[2][0] + stop[1] * matrix[2][1]
        assert lift < 0, "the slip of this landing cannot be stopped"
    elif law == "viscous" or mu == 0:
        tape = Tape()
        *speed, work, _, _, _ = (tape.state() for _ in range(7))
        force = [-(mu * unit * speed[0]), -(mu * unit * speed[1]), tape.constant(1)]
        rates = [dot(row, force) for row in matrix]
        tape.rates = [*rates, speed[2] + 0, *force]
        end, done = followed(course, tape, [*u, *[mpfr(0)] * 4], speed[2], work)
        assert done
        kind = "slips" if mu else "smooth"
        return Struck(matrix, scaled(unit, u), e, scaled(unit, end[4:]), kind, course.times)
    elif first or second:
        tape = Tape()
        slip = [tape.state(), tape.state()]
        rising, work, *_ = (tape.state() for _ in range(5))
        length = tape.sqrt(slip[0] * slip[0] + slip[1] * slip[1])
        force = [-(mu * slip[0]), -(mu * slip[1]), length + 0]
        tape.rates = [*(dot(row, force) for row in matrix), rising * length, *force]
        end, done = followed(course, tape, [*u, *[mpfr(0)] * 4], rising, work, slip, length)
        given, lift = end[4:], end[2]
        if done:
            return Struck(matrix, scaled(unit, u), e, scaled(unit, given), "slips", course.times)
    if law == "coulomb" and gmpy2.sqrt(hold[0] ** 2 + hold[1] ** 2) > static:
        kind, hold = "slips on", way_out(matrix, mu)
    p = course.straight(lift, dot(matrix[2], [*hold, 1]))
    impulse = scaled(unit, add(given, [hold[0] * p, hold[1] * p, p]))
    return Struck(matrix, scaled(unit, u), e, impulse, kind, course.times)


def way_out(matrix, mu):
    """The friction of the one direction in which a slip that cannot be held goes on and grows."""

    def turning(angle):
        x, y = gmpy2.cos(angle), gmpy2.sin(angle)
        rate = [row[2] - mu * (x * row[0] + y * row[1]) for row in matrix[:2]]
        return x * rate[1] - y * rate[0], x * rate[0] + y * rate[1]

    found, places, whole = [], 360, 2 * gmpy2.const_pi()
    for k in range(places):
        low, high = (mpfr("0.0123") + whole * j / places for j in (k, k + 1))
        rises = turning(low)[0] > 0
        if (turning(high)[0] > 0) != rises:
            for _ in range(gmpy2.get_context().precision):
                middle = (low + high) / 2
                low, high = (middle, high) if (turning(middle)[0] > 0) == rises else (low, middle)
            if turning(low)[1] > 0:
                found.append(low)
    (angle,) = found
    return [-mu * gmpy2.cos(angle), -mu * gmpy2.sin(angle)]


def directions(matrix, u, e, law, mu, static=None):
    """The impact by the angle of the slip from the axes of A."""
    (a, c, _), (_, d, _), (b_1, b_2, a_n) = matrix
    angle = gmpy2.atan2(2 * c, a - d) / 2
    cosine, sine = gmpy2.cos(angle), gmpy2.sin(angle)
    middle, half = (a + d) / 2, gmpy2.sqrt(((a - d) / 2) ** 2 + c**2)
    light, b = [middle + half, middle - half], [cosine * b_1 + sine * b_2, cosine * b_2 - sine * b_1]
    slip = [cosine * u[0] + sine * u[1], cosine * u[1] - sine * u[0]]
    course, static = Course(e), mu if static is None else static
    (x, y, p), kind = among_axes(course, light, b, a_n, [*slip, u[2]], law, mu, static)
    return Struck(matrix, u, e, [cosine * x - sine * y, sine * x + cosine * y, p], kind, course.times)


def among_axes(course, light, b, a_n, u, law, mu, static):
    """The impulse along the axes of A, and what the contact does."""
    unit, kind, given = abs(u[2]), "sticks", [mpfr(0)] * 3
    hold = [-x / a for x, a in zip(b, light, strict=True)]
    *slip, lift = (x / unit for x in u)
    if law == "rolling":
        assert highest(light, b, slip, lift) < 0, "the slip of this landing cannot be stopped"
        given = [*(-x / a for x, a in zip(slip, light, strict=True)), mpfr(0)]
        lift = lift + dot([*hold, 0], [*slip, 0])
    elif mu == 0:
        return [mpfr(0), mpfr(0), unit * course.straight(lift, a_n)], "smooth"
    elif law == "viscous":
        return filmed(course, light, b, a_n, [*slip, lift], mu * unit, unit), "slips"
    elif slip[0] or slip[1]:
        tape = Tape()
        angle, length, rising, work, *_ = (tape.state() for _ in range(7))
        s, c = tape.sin_cos(angle)
        turn = b[1] * c - b[0] * s - (mu * (light[1] - light[0])) * (s * c)
        growth = b[0] * c + b[1] * s - mu * (light[0] * (c * c) + light[1] * (s * s))
        rises = a_n - mu * (b[0] * c + b[1] * s)
        force = [-(mu * (length * c)), -(mu * (length * s)), length + 0]
        tape.rates = [turn, length * growth, length * rises, rising * length, *force]
        start = [gmpy2.atan2(slip[1], slip[0]), gmpy2.hypot(*slip), lift, *[mpfr(0)] * 4]
        end, done = followed(course, tape, start, rising, work, [length], length)
        given, lift = end[4:], end[2]
        if done:
            return scaled(unit, given), "slips"
    if law == "coulomb" and gmpy2.hypot(*hold) > static:
        kind, low, high = "slips on", mpfr(0), gmpy2.hypot(*b)
        for _ in range(2 * gmpy2.get_context().precision):
            lam = (low + high) / 2
            way = [x / (mu * a + lam) for x, a in zip(b, light, strict=True)]
            low, high = (lam, high) if gmpy2.hypot(*way) > 1 else (low, lam)
        hold = scaled(-mu, way)
    p = course.straight(lift, a_n + dot([*hold, 0], [*b, 0]))
    return scaled(unit, add(given, [hold[0] * p, hold[1] * p, p])), kind


def highest(light, b, slip, lift):
    """The largest normal velocity while infinite friction stops the slip: along A the slip dies as s, and as a power."""
    first, second = (0, 1) if light[0] <= light[1] else (1, 0)
    power = light[second] / light[first]
    pulls = [b[i] * slip[i] / light[i] for i in (first, second)]

    def at(s):
        return lift - pulls[0] * (1 - s) - pulls[1] * (1 - s**power)

    places = [mpfr(k) / 400 for k in range(401)]
    return max(at(s) for s in places)


def filmed(course, light, b, a_n, u, c, unit):
    """The impulse on a film by elementary functions of the normal impulse."""
    *slip, first = u
    rest = [x / (c * a) for x, a in zip(b, light, strict=True)]
    swing = [x - y for x, y in zip(slip, rest, strict=True)]
    climb = a_n - sum(x * x / a for x, a in zip(b, light, strict=True))
    fades, pulls = [c * a for a in light], [x / a * y for x, a, y in zip(b, light, swing, strict=True)]

    def lift(p):
        gone = (-k * gmpy2.expm1(-f * p) for k, f in zip(pulls, fades, strict=True))
        return first + climb * p - sum(gone)

    def work(p):
        gone = (k * (p + gmpy2.expm1(-f * p) / f) for k, f in zip(pulls, fades, strict=True))
        return first * p + climb * p * p / 2 - sum(gone)

    def rises(f, p, step, until=None):
        """Where f rises through 0 after p; None if `until` falls through 0 before."""
        place = p
        while f(place + step) < 0:
            place += step
            if until is not None and until(place + step) < 0:
                return None, place + step
        low, high = place, place + step
        for _ in range(gmpy2.get_context().precision + 20):
            middle = (low + high) / 2
            low, high = (middle, high) if f(middle) < 0 else (low, middle)
        return high, None

    step, p = 1 / (64 * (a_n + c * (light[0] + light[1]))), mpfr(0)
    while True:
        p, _ = rises(lift, p, step)
        course.happened("pressed", work(p))
        if course.e == 0:
            break
        level = (1 - course.e**2) * course.lowest
        p, fallen = rises(lambda x: work(x) - level, p, step, lift)  # noqa: B023
        if fallen is None:
            break
        p = fallen
    lost = [-gmpy2.expm1(-f * p) for f in fades]
    given = [-(c * (r * p + s * g / f)) for r, s, g, f in zip(rest, swing, lost, fades, strict=True)]
    return scaled(unit, [*given, p])
