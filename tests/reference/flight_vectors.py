"""Flight and impact in the laboratory frame, one of the two formulations of flight_forms.py."""

import gmpy2
import slip_forms
from flight_forms import FINE, ORDER, Air, Below, Bounce, Watched, ended, slid
from gmpy2 import mpfr
from phases import first_event, step_size
from series import Tape, root
from vectors import add, cross, dot, scaled


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
        """The state at the next landing, told from the rim that lands, and whether it is another one."""
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
            rising, worked, *_ = (tape.state() for _ in range(5))
            length = tape.sqrt(slip[0] * slip[0] + slip[1] * slip[1])
            force = [-(self.mu * slip[0]), -(self.mu * slip[1]), length]
            rates = [
                sum((columns[j][i] * force[j] for j in (1, 2)), columns[0][i] * force[0]) for i in range(3)
            ]
            tape.rates = [*rates, rising * length, *force]
            done, end, pressed = slid(tape, slip, e, length, rising, worked, [*u, mpfr(0), *[mpfr(0)] * 3])
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
        """The friction of the one direction in which slip that cannot be held goes on and grows."""

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
    """The first place in (0, h] where a series falls from above 0, also close to 0 if the rim was down."""

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
