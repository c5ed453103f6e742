"""Two formulations of flight and impact, for flights.py, beside those of contact in slip_forms.py.

vectors   three-dimensional, in the laboratory frame. The flight is a power series in time of centre, axis, material
          vector and angular velocity, and so are the heights of both rims, whose first zero is the landing. In an impact the
          velocity of the contact point answers an impulse P with P + (I^-1 (r x P)) x r, whatever that matrix may be.
closed    the parabola, the precession about the angular momentum, and phi and psi by Napier's analogies; landings by
          halving intervals, with a bound from above for the second derivative of the height. Impacts in the frame of the
          lean, where the inverse inertia is a_h, a_2, a_n and b: the direction of a slip by the angle from the lean, and all
          that follows the first stop in closed form.

Both share the laws: friction along an impact is that of the contact, with the normal impulse for time (Routh, Dynamics of
a System of Rigid Bodies, 1905; Keller, J. Appl. Mech. 53, 1 (1986)), and restitution is energetic (Stronge, Proc. R. Soc. A
431, 169 (1990)): compression ends at u_n = 0 with the work W_c, the impact where the work is (1 - e^2) W_c. On a rolling
table the slip is stopped before the normal impulse begins. The first slip runs in nu, dp = |u| dnu.
"""

import gmpy2
import slip_forms
from gmpy2 import mpfr
from phases import first_event, step_size
from series import Tape, root
from torus import Z
from vectors import add, cross, dot, scaled

# of series in an impact: relative to the normal velocity
FINE, ORDER, STOPPED = mpfr("1e-42"), 36, mpfr("1e-44")


class Air(list):
    """The numbers of a state in the air: those of a contact, and those of the height where they are told apart."""

    def __init__(self, y, lift=None, height=None):
        super().__init__(y)
        self.lift, self.height = lift, height


class Bounce:
    """An impact: the state after it, the impulse along h, e2 and z, what the contact did, and the energy lost."""

    def __init__(self, y, lift, impulse, kind, lost):
        self.y, self.lift, self.impulse, self.kind, self.lost = y, lift, impulse, kind, lost


class Below:
    """Less a series: its changes of sign are events as it grows through a level."""

    def __init__(self, node, level=0):
        self.node, self.level = node, level

    def at(self, h):
        return self.level - self.node.at(h)


class Watched:
    """What `step_size` asks of a phase."""

    slip = ()

    def __init__(self, tape, *more):
        self.tape = type("", (), {"states": [*tape.states, *more]})


def ended(lift, work, pressed, most, rate, e):
    """How far a straight piece of an impact goes: the normal impulse, velocity and work, and whether the impact ends.

    The normal velocity grows at this rate, for at most this impulse; `pressed` is the work of the compression, if that has ended.
    """
    if pressed is None and rate > 0 and -lift / rate <= most:
        pressed = work - lift * lift / (2 * rate)
    far, done = most, False
    if pressed is not None:
        if lift < 0 or e > 0:
            left = lift * lift + 2 * rate * ((1 - e * e) * pressed - work)
            far = (-lift + gmpy2.sqrt(max(left, mpfr(0)))) / rate
        else:
            far = mpfr(0)
        done = far <= most
        far = min(far, most)
    return far, lift + rate * far, work + lift * far + rate * far * far / 2, pressed, done


class Struck:
    """Coulomb friction along an impact of velocity u, whose rate for a unit of normal impulse `push(direction)` gives."""

    def slide(self, tape, stop, e, size, lift, work, impulse, at):
        """Follows the first slip: True if the impact ends on the way, and the velocities and impulses there."""
        start, pressed = at, None
        for _ in range(400):
            tape.expand(start, ORDER)
            watched = Watched(tape, size)
            watched.slip, watched.size = stop, size
            h = step_size(watched, ORDER, FINE)
            h = min(h, 8 * (abs(lift.c[0]) + abs(work.c[0]) + mpfr("1e-6")) / abs(lift.c[1]))
            events = (
                [("pressed", Below(lift))]
                if pressed is None
                else [("ends", Below(work, (1 - e * e) * pressed))]
            )
            place, name = first_event(events, h)
            h = h if name is None else place
            start = [node.at(h) for node in tape.states]
            if name == "pressed":
                pressed = work.at(h)
                if e == 0:
                    return True, start, pressed
            elif name:
                return True, start, pressed
            if size.at(h) < STOPPED:
                return False, start, pressed
        raise ArithmeticError("an impact without end")


# In the laboratory.


class Vectors(slip_forms.Vectors):
    """Newton's and Euler's equations, and impulses, in the laboratory frame."""

    def __init__(self, scene):
        super().__init__(scene)
        self.lost, self.flight = mpfr(0), self.free()

    def start(self):
        y = super().start()
        y[6] += mpfr(self.scene.height)
        y[9] += mpfr(self.scene.lift)
        return Air(y) if self.scene.aloft else y

    def free(self):
        """The flight, with the heights of the rims."""
        tape = Tape()
        tape.state()
        _, v, e3, material, w = ([tape.state() for _ in range(3)] for _ in range(5))
        axis, zero = cross(w, e3), tape.constant(0)
        momentum = [self.i1 * w[i] + (self.i3 - self.i1) * (dot(w, e3) * e3[i]) for i in range(3)]
        swing = self.turned(scaled(-1, cross(w, momentum)), e3)
        tape.rates = [tape.constant(1), *v, zero, zero, tape.constant(-1), *axis, *cross(w, material), *swing]
        middle, up = tape.states[3] - self.fillet, self.ell * e3[2]
        if self.rim:
            middle = middle - self.rim * tape.sqrt(e3[0] * e3[0] + e3[1] * e3[1])
        tape.heights = [middle - up, middle + up][: 1 + self.scene.side]
        return tape

    def gravity(self, y):
        """How fast the lowest point falls towards the table, without a force: a_n N0."""
        self.flight.expand(y[3:], 2)
        return -2 * self.flight.heights[0].c[2]

    def fly(self, y, order, samples, out):
        """The state at the next landing, told from the rim that lands, and which it is; the samples on the way."""
        tape, start, heat, own = self.flight, y[3:], y[2], order
        while True:
            tape.expand(start, 40)
            out.steps += 1
            h = step_size(Watched(tape, *tape.heights), 40, mpfr("1e-44"))
            found = []
            for rim, node in enumerate(tape.heights):
                place = first_fall(node.c[own if rim == 0 else 0 :], h, rim == 0 and own)
                if place is not None:
                    found.append((place, rim))
            place, rim = min(found, default=(h, None))
            while samples and samples[0] <= start[0] + place:
                when = samples.pop(0)
                there = [node.at(when - start[0]) for node in tape.states]
                out.add("sample" if samples else "end", when, Air([mpfr(0), mpfr(0), heat, *there]))
            if not samples:
                return None, None
            start, own = [node.at(place) for node in tape.states], 0
            if rim is not None:
                y = Air([mpfr(0), mpfr(0), heat, *start])
                return (self.other(y) if rim else y), rim

    def other(self, y):
        """Told from the other rim."""
        return Air([*y[:10], *scaled(-1, y[10:13]), *y[13:]])

    def parts(self, y):
        """The arm, the velocity of the lowest point, and how it answers unit impulses."""
        *_, (u, h, e2), _ = self.in_space(y[4:])
        e3 = y[10:13]
        e1 = [e3[2] * h[0], e3[2] * h[1], -dot(h, e3)]
        arm = self.arm(e1, e3)
        columns = []
        for unit in ([mpfr(i == j) for i in range(3)] for j in range(3)):
            columns.append(add(unit, cross(self.turned(cross(arm, unit), e3), arm)))
        return arm, u, h, e2, columns

    def impact(self, y, e):
        arm, u, h, e2, columns = self.parts(y)
        given, kind = self.struck(u, columns, e)
        after = add(u, *(scaled(given[j], columns[j]) for j in range(3)))
        lost = -dot(add(u, after), given) / 2
        turn = self.turned(cross(arm, given), y[10:13])
        slip = [mpfr(0), mpfr(0)] if kind == "sticks" else after[:2]
        new = [*slip, *y[2:7], *add(y[7:10], given), *y[10:16], *add(y[16:19], turn)]
        return Bounce(new, after[2] if e else mpfr(0), [dot(given, h), dot(given, e2), given[2]], kind, lost)

    def struck(self, u, columns, e):
        """The impulse of an impact and what the contact does."""
        e = mpfr(e)
        if self.scene.law == "rolling":
            stop = stuck(columns, [-u[0], -u[1]])
            lift = dot([row[2] for row in columns], [*stop, mpfr(0)]) + u[2]
            assert lift < 0, "the slip of this landing cannot be stopped"
            hold = stuck(columns, [-columns[2][0], -columns[2][1]])
            rate = columns[2][2] + hold[0] * columns[0][2] + hold[1] * columns[1][2]
            p = -(1 + e) * lift / rate
            return [stop[0] + p * hold[0], stop[1] + p * hold[1], p], "sticks"
        if self.scene.law == "viscous" or self.mu == 0:
            return self.filmed(u, columns, e), "slips" if self.mu else "smooth"
        unit = abs(u[2])
        u = [x / unit for x in u]
        size, work, pressed, given = gmpy2.sqrt(u[0] ** 2 + u[1] ** 2), mpfr(0), None, [mpfr(0)] * 3
        lift = u[2]
        if size > 0:
            tape = Tape()
            slip = [tape.state(), tape.state()]
            rising, worked, *pushed = (tape.state() for _ in range(5))
            length = tape.sqrt(slip[0] * slip[0] + slip[1] * slip[1])
            force = [-(self.mu * slip[0]), -(self.mu * slip[1]), length]
            rates = [
                sum((columns[j][i] * force[j] for j in (1, 2)), columns[0][i] * force[0]) for i in range(3)
            ]
            tape.rates = [*rates, rising * length, *force]
            done, end, pressed = Struck().slide(
                tape, slip, e, length, rising, worked, pushed, [*u, mpfr(0), *[mpfr(0)] * 3]
            )
            given = end[4:]
            if done:
                return scaled(unit, given), "slips"
            lift, work = end[2:4]
        hold = stuck(columns, [-columns[2][0], -columns[2][1]])
        kind = "sticks" if gmpy2.sqrt(hold[0] ** 2 + hold[1] ** 2) <= self.static else "slips on"
        if kind == "slips on":
            hold = self.leaves(columns)
        rate = columns[2][2] + hold[0] * columns[0][2] + hold[1] * columns[1][2]
        far, *_, done = ended(lift, work, pressed, mpfr("inf"), rate, e)
        assert done
        return scaled(unit, add(given, [far * hold[0], far * hold[1], far])), kind

    def leaves(self, columns):
        """The friction of the one direction in which slip that cannot be held goes on: it turns no more, and grows."""

        def turning(angle):
            x, y = gmpy2.cos(angle), gmpy2.sin(angle)
            rate = [columns[2][i] - self.mu * (x * columns[0][i] + y * columns[1][i]) for i in (0, 1)]
            return x * rate[1] - y * rate[0], x * rate[0] + y * rate[1]

        found, places, whole = [], 180, 2 * gmpy2.const_pi()
        for k in range(places):
            low, high = (mpfr("0.0123") + whole * j / places for j in (k, k + 1))
            if (turning(low)[0] > 0) != (turning(high)[0] > 0):
                for _ in range(gmpy2.get_context().precision):
                    middle = (low + high) / 2
                    if (turning(middle)[0] > 0) == (turning(low)[0] > 0):
                        low = middle
                    else:
                        high = middle
                if turning(low)[1] > 0:
                    found.append(low)
        (angle,) = found
        return [-self.mu * gmpy2.cos(angle), -self.mu * gmpy2.sin(angle)]

    def filmed(self, u, columns, e):
        """The impulse of a film, which is linear, or of a smooth table: a series in the normal impulse."""
        unit = abs(u[2])
        tape = Tape()
        *speed, worked, _, _ = (tape.state() for _ in range(6))
        # velocities are told in units of the normal one, and so is the impulse
        force = [-(self.mu * unit * speed[0]), -(self.mu * unit * speed[1]), tape.constant(1)]
        rates = [sum((columns[j][i] * force[j] for j in (1, 2)), columns[0][i] * force[0]) for i in range(3)]
        tape.rates = [*rates, speed[2] + 0, force[0], force[1]]
        at, pressed, p = [*(x / unit for x in u), *[mpfr(0)] * 3], None, mpfr(0)
        for _ in range(400):
            tape.expand(at, ORDER)
            h = min(step_size(Watched(tape), ORDER, FINE), mpfr(2))
            events = [("pressed", Below(speed[2]))]
            if pressed is not None:
                events = [("ends", Below(worked, (1 - e * e) * pressed))]
            place, name = first_event(events, h)
            h = h if name is None else place
            at, p = [node.at(h) for node in tape.states], p + h
            if name == "pressed":
                pressed = worked.at(h)
            if name == "ends" or (pressed is not None and e == 0):
                return scaled(unit, [at[4], at[5], p])
        raise ArithmeticError("an impact without end")

    def aloft(self, y, lift):
        """The state in the air after an impact."""
        return Air(y)

    def read(self, y, lean=None):
        state, pose, contact, (u, h, e2), vanishing = self.in_space(y[4:], lean)
        up = [u[2], vanishing[1]] if isinstance(y, Air) else [mpfr(0), mpfr(0)]
        slip = (
            [dot(u, h), dot(u, e2)]
            if isinstance(y, Air)
            else [y[0] * h[0] + y[1] * h[1], y[1] * h[0] - y[0] * h[1]]
        )
        return [*state, *slip, *up, y[2], self.lost, *pose, *contact]

    def strayed(self, y, lean=None):
        if isinstance(y, Air):
            return max(abs(x) for x in self.in_space(y[4:], lean)[-1][2:])
        return super().strayed(y, lean)


def stuck(columns, wanted):
    """The two horizontal impulses that change the horizontal velocity as wanted."""
    (a, c), (b, d) = columns[0][:2], columns[1][:2]
    det = a * d - b * c
    return [(d * wanted[0] - b * wanted[1]) / det, (a * wanted[1] - c * wanted[0]) / det]


def first_fall(c, h, own):
    """The first place in (0, h] where a series falls from above 0; close to 0, too, if it begins at the own rim."""

    def at(x):
        total = mpfr(0)
        for k in reversed(c):
            total = total * x + k
        return total

    places = [h * mpfr(2) ** -k for k in range(130 if own else 0, 6, -1)]
    places = [mpfr(0), *places, *(h * k / 64 for k in range(1, 65))]
    values = [at(x) for x in places]
    for k in range(len(places) - 1):
        if values[k] > 0 >= values[k + 1]:
            node = type("", (), {"at": staticmethod(at)})
            return root(node, places[k], places[k + 1])
        if own and k == 0 and values[0] <= 0:
            raise ArithmeticError("a flight that does not rise")
    return None


# In closed form.


class Closed(slip_forms.Reduced):
    """Flight and impact by the formulas of the axis of revolution."""

    def __init__(self, scene):
        super().__init__(scene)
        self.lost = mpfr(0)

    def start(self):
        y = super().start()
        return Air(y, mpfr(self.scene.lift), mpfr(self.scene.height)) if self.scene.aloft else y

    def shape(self, theta):
        """Sine and cosine; radius, depth, lever and height of the contact."""
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        lever = self.ell * s - self.rim * c
        return (
            s,
            c,
            self.rim + self.fillet * s,
            self.ell + self.fillet * c,
            lever,
            self.ell * c + self.rim * s + self.fillet,
        )

    def light(self, theta):
        """a_h, a_2, a_n, b."""
        _, _, radius, depth, lever, height = self.shape(theta)
        across = 1 + depth**2 / self.i1 + radius**2 / self.i3
        return 1 + height**2 / self.i1, across, 1 + lever**2 / self.i1, height * lever / self.i1

    def gravity(self, y):
        theta, w1, w2, w3 = y[4:8]
        s, c, _, _, lever, height = self.shape(theta)
        couple = w1 * (self.i3 * w3 - self.i1 * w1 * c / s)
        return 1 - (height - self.fillet) * w2 * w2 + lever * couple / self.i1

    def fly(self, y, order, samples, out):
        air = Flight(self, y)
        found = [(air.lands(1, order), 0)]
        if self.scene.side:
            found.append((air.lands(-1, 0), 1))
        after, rim = min(found)
        while samples and samples[0] <= y[3] + after:
            when = samples.pop(0)
            out.add("sample" if samples else "end", when, air.at(when - y[3]))
        if not samples:
            return None, None
        y = air.at(after)
        y[3] = y[3] + mpfr(0)
        return (self.other(y) if rim else y), rim

    def other(self, y):
        """Told from the other rim."""
        u_h, u_2, heat, t, theta, w1, w2, w3, phi, psi, a, b = y
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        apart, whole = 2 * self.ell, gmpy2.const_pi()
        rest = [whole - theta, w1, -w2, -w3, phi + whole, -psi]
        place = [a - apart * s * gmpy2.cos(phi), b - apart * s * gmpy2.sin(phi)]
        slip = [-u_h - apart * c * w2, apart * w1 - u_2]
        return Air([*slip, heat, t, *rest, *place], y.lift + apart * s * w2, y.height + apart * c)

    def impact(self, y, e):
        theta = y[4]
        _, _, radius, depth, lever, height = self.shape(theta)
        light = a_h, a_2, a_n, b = self.light(theta)
        given, kind = self.struck([y[0], y[1], y.lift], light, mpfr(e))
        along, across, normal = given
        change = [a_h * along + b * normal, a_2 * across, a_n * normal + b * along]
        before = [y[0], y[1], y.lift]
        after = add(before, change)
        lost = -dot(add(before, after), given) / 2
        slip = [mpfr(0), mpfr(0)] if kind == "sticks" else after[:2]
        w1 = y[5] + depth * across / self.i1
        w2 = y[6] - (height * along + lever * normal) / self.i1
        w3 = y[7] - radius * across / self.i3
        new = [*slip, y[2], y[3], theta, w1, w2, w3, *y[8:]]
        return Bounce(new, after[2] if e else mpfr(0), given, kind, lost)

    def struck(self, u, light, e):
        a_h, a_2, a_n, b = light
        mu, lift, work, pressed, given = self.mu, u[2], mpfr(0), None, [mpfr(0)] * 3
        if self.scene.law == "rolling":
            bare = lift - b * u[0] / a_h
            normal = -(1 + e) * bare / (a_n - b * b / a_h)
            return [-(u[0] + b * normal) / a_h, -u[1] / a_2, normal], "sticks"
        if mu == 0:
            return [mpfr(0), mpfr(0), -(1 + e) * lift / a_n], "smooth"
        if self.scene.law == "viscous":
            return self.filmed(u, light, e), "slips"
        unit, kind = abs(lift), "sticks"
        u_h, u_2, lift = (x / unit for x in u)
        size = gmpy2.sqrt(u_h**2 + u_2**2)
        if size > 0 and u_2 == 0:
            x = 1 if u_h > 0 else -1
            rate, growth = a_n - mu * b * x, b * x - mu * a_h
            most = size / -growth if growth < 0 else mpfr("inf")
            far, lift, work, pressed, done = ended(lift, work, pressed, most, rate, e)
            given = [-mu * x * far, mpfr(0), far]
            if done:
                return scaled(unit, given), "slips"
        elif size > 0:
            tape = Tape()
            angle, length, rising, worked, *pushed = (tape.state() for _ in range(7))
            s, c = tape.sin_cos(angle)
            more = mu * (a_2 - a_h)
            force = [-(mu * (length * c)), -(mu * (length * s)), length + 0]
            growth = b * c - mu * (a_h * (c * c) + a_2 * (s * s))
            tape.rates = [
                -(s * (more * c + b)),
                length * growth,
                length * (a_n - (mu * b) * c),
                rising * length,
                *force,
            ]
            begin = gmpy2.atan2(u_2, u_h)
            done, end, pressed = Struck().slide(
                tape,
                [length],
                e,
                length,
                rising,
                worked,
                pushed,
                [begin, size, lift, mpfr(0), *[mpfr(0)] * 3],
            )
            self.checked(light, begin, size, end)
            given, lift, work = end[4:], end[2], end[3]
            if done:
                return scaled(unit, given), "slips"
        hold = -b / a_h
        if abs(b) > self.static * a_h:
            kind, hold = "slips on", -mu if b > 0 else mu
        far, *_, done = ended(lift, work, pressed, mpfr("inf"), a_n + hold * b, e)
        assert done
        return scaled(unit, add(given, [far * hold, mpfr(0), far])), kind

    def checked(self, light, begin, size, end):
        """The first slip is that of its closed form, t = tan(alpha/2), u_2 = u_20 exp(-mu a_2 nu)."""
        _, a_2, _, b = light
        more = self.mu * (a_2 - light[0])
        outer, inner = more + b, more - b
        first, last = gmpy2.tan(begin / 2), gmpy2.tan(end[0] / 2)
        if abs(first) > 1e12 or abs(last) < 1e-20 or abs(last) > 1e12:
            return  # within rounding of a straight direction
        turned = gmpy2.log((outer - inner * last**2) / (outer - inner * first**2))
        nu = -(gmpy2.log(last / first) / outer - more / (more * more - b * b) * turned)
        slip = size * gmpy2.sin(begin) * gmpy2.exp(-self.mu * a_2 * nu)
        error = abs(slip - end[1] * gmpy2.sin(end[0]))
        self.worst = max(getattr(self, "worst", mpfr(0)), error / size)

    def filmed(self, u, light, e):
        """The impulse of a film in elementary functions of the normal impulse, whose end Newton's steps find."""
        a_h, a_2, a_n, b = light
        c = self.mu
        rest = b / (c * a_h)
        swing, climb = u[0] - rest, a_n - b * b / a_h

        def at(p):
            gone = -gmpy2.expm1(-c * a_h * p)
            lift = u[2] + climb * p - b / a_h * swing * gone
            work = u[2] * p + climb * p * p / 2 - b / a_h * swing * (p - gone / (c * a_h))
            return lift, work, gone

        def solved(f, p, slope):
            close = 0
            for _ in range(200):
                step = f(p) / slope(p)
                p -= step
                close += abs(step) <= abs(p) * mpfr("1e-20")
                if close == 3:
                    return p
            raise ArithmeticError("no end of an impact")

        rate = lambda p: climb - b * c * swing * gmpy2.exp(-c * a_h * p)  # noqa: E731
        p = solved(lambda p: at(p)[0], -u[2] / climb, rate)
        if e:
            level = (1 - e * e) * at(p)[1]
            p = solved(lambda p: at(p)[1] - level, p * (1 + e), lambda p: at(p)[0])
        gone = at(p)[2]
        return [(u[0] + b * p - rest - swing * (1 - gone)) / -a_h, u[1] / a_2 * gmpy2.expm1(-c * a_2 * p), p]

    def aloft(self, y, lift):
        return Air(y, lift, mpfr(0))

    def read(self, y, lean=None):
        up = [y.lift, y.height] if isinstance(y, Air) else [mpfr(0), mpfr(0)]
        return [*y[4:8], y[0], y[1], *up, y[2], self.lost, *y[8:]]


class Flight:
    """A flight in closed form: sides a, b of the spherical triangle (n, z, e3), n along the angular momentum."""

    def __init__(self, model, y):
        self.model, self.y = model, y
        theta, w1, w2, self.w3, phi = *y[4:8], y[8]
        s, c, radius, depth, lever, height = model.shape(theta)
        lift, above = (y.lift, y.height) if isinstance(y, Air) else (mpfr(0), mpfr(0))
        h, e2 = [gmpy2.cos(phi), gmpy2.sin(phi), mpfr(0)], [-gmpy2.sin(phi), gmpy2.cos(phi), mpfr(0)]
        e1, e3 = add(scaled(c, h), scaled(s, Z)), add(scaled(-s, h), scaled(c, Z))
        speed = [y[0] + height * w2, y[1] - depth * w1 + radius * self.w3, lift + lever * w2]
        self.velocity = add(scaled(speed[0], h), scaled(speed[1], e2), scaled(speed[2], Z))
        self.centre = add([y[10], y[11], above], scaled(-lever, h), scaled(height, Z))
        own = add(scaled(model.i1 * w1, e1), scaled(model.i1 * w2, e2), scaled(model.i3 * self.w3, e3))
        size = gmpy2.sqrt(dot(own, own))
        n = scaled(1 / size, own) if size else Z
        self.n, self.rate, self.spin = n, size / model.i1, self.w3 * (1 - model.i3 / model.i1)
        self.own = own
        from_axis = cross(n, e3)
        self.a = gmpy2.atan2(gmpy2.sqrt(n[0] ** 2 + n[1] ** 2), n[2])
        self.b = gmpy2.atan2(gmpy2.sqrt(dot(from_axis, from_axis)), dot(n, e3))
        self.angle = gmpy2.atan2(dot(n, cross(Z, e3)), e3[2] - n[2] * dot(n, e3))
        self.both = gmpy2.sin(self.a) * gmpy2.sin(self.b)
        self.begin = self.napier(mpfr(0))

    def napier(self, t):
        """Half the sum and half the difference of the angles at e3 and z, continuous in time."""
        d = (gmpy2.const_pi() - self.angle - self.rate * t) / 2
        s, c = gmpy2.sin(d), gmpy2.cos(d)

        def wound(top, bottom):
            k = abs(top) / abs(bottom) if bottom else mpfr("1e300")
            turn = d + gmpy2.atan2((k - 1) * s * c, c * c + k * s * s)
            return turn if (top > 0) == (bottom > 0) else -turn

        plus, minus = (self.a + self.b) / 2, (self.a - self.b) / 2
        return wound(gmpy2.cos(minus), gmpy2.cos(plus)), wound(
            gmpy2.sin(minus), gmpy2.sin(plus)
        ) if minus else mpfr(0)

    def lean(self, t):
        """Cosine and sine of theta, and the rate of the cosine."""
        c0 = self.angle + self.rate * t
        less = 2 * gmpy2.sin((self.a - self.b) / 2) ** 2 + 2 * self.both * gmpy2.sin(c0 / 2) ** 2
        more = 2 * gmpy2.cos((self.a + self.b) / 2) ** 2 + 2 * self.both * gmpy2.cos(c0 / 2) ** 2
        return 1 - less, gmpy2.sqrt(less * more), -self.both * self.rate * gmpy2.sin(c0)

    def height(self, t, side):
        """Of the lowest point of a rim, and its rate."""
        m = self.model
        c, s, rate = self.lean(t)
        low = side * m.ell * c + m.rim * s + m.fillet
        fall = side * m.ell * rate - (m.rim * c * rate / s if s > 0 else 0)
        return self.centre[2] + self.velocity[2] * t - t * t / 2 - low, self.velocity[2] - t - fall

    def at(self, t):
        m, y = self.model, self.y
        c, s, rate = self.lean(t)
        theta = gmpy2.atan2(s, c)
        _, _, radius, depth, lever, height = m.shape(theta)
        x, z = self.napier(t)
        phi = y[8] - (x - self.begin[0]) + (z - self.begin[1])
        psi = y[9] + self.spin * t - (x - self.begin[0]) - (z - self.begin[1])
        w1, w2 = (self.own[2] - m.i3 * self.w3 * c) / (m.i1 * s), rate / s
        cosine, sine = gmpy2.cos(phi), gmpy2.sin(phi)
        v_h = self.velocity[0] * cosine + self.velocity[1] * sine
        v_2 = self.velocity[1] * cosine - self.velocity[0] * sine
        place = [self.centre[i] + self.velocity[i] * t for i in (0, 1)]
        slip = [v_h - height * w2, v_2 + depth * w1 - radius * self.w3]
        numbers = [*slip, y[2], y[3] + t, theta, w1, w2, self.w3, phi, psi]
        numbers += [place[0] + lever * cosine, place[1] + lever * sine]
        lift = self.velocity[2] - t - lever * w2
        return Air(numbers, lift, self.height(t, 1)[0])

    def lands(self, side, order):
        """The first time at which this rim is down; `order` is that of its height at the start, where it begins there."""
        m = self.model
        most = self.rate**2 * (abs(m.ell) * self.both + m.rim * gmpy2.sin(self.b)) - 1
        end = self.velocity[2] + gmpy2.sqrt(self.velocity[2] ** 2 + 2 * self.centre[2])
        most = max(most, mpfr("1e-9"))
        t = mpfr(0)
        if order:
            t = end * mpfr("1e-9")
            if order == 1:
                t = min(t, self.height(mpfr(0), side)[1] * mpfr("1e-3"))
            while (
                order > 1 and t < end / 50 and all(self.height(t * k / 8, side)[0] > 0 for k in range(1, 17))
            ):
                t *= 2
        (low, _), todo = self.height(t, side), [end]
        assert low > 0, "a flight that does not rise"
        while todo:
            x = todo[-1]
            high, width = self.height(x, side)[0], x - t
            if high > 0:
                v = (low - high) / (most * width)
                least = min(low, high)
                if abs(v) < width / 2:
                    least = (low + high) / 2 - most * (width * width / 8 + v * v / 2)
                if least > 0:
                    t, low = x, high
                    todo.pop()
                    continue
            elif self.height(t, side)[1] + most * width < 0:
                node = type("", (), {"at": staticmethod(lambda x: self.height(x, side)[0])})
                return root(node, t, x)
            assert width > end * mpfr("1e-20"), "a rim that grazes the table"
            todo.append(t + width / 2)
        return mpfr("inf")
