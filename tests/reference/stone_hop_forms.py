"""Two formulations of stones that fly and strike, for stone_hops.py, beside those of contact in stone_forms.py.

table   in the laboratory: power series of the quaternion under a constant angular momentum and of the height of the
        lowest point, whose first zero is the landing. An impulse P changes the velocity of that point by
        P + (J (r x P)) x r, with the inertia turned to the laboratory; the impact by components
body    in the axes of the body: power series of Euler's equations, the parabola, and the height from the vertical
        in closed form; the landing by halving intervals with a bound from above for the second derivative of the
        height, (1 + 1/sqrt 3) W^2 rho - g, which holds for every point of any rigid body: W the largest |w| that
        angular momentum and energy allow, rho the distance of no point less. The impact by directions

Both ways through an impact are in point_impacts.py.
"""

import gmpy2
import stone_forms
from flight_forms import Air, Bounce, Watched, landing
from flight_vectors import first_fall
from gmpy2 import mpfr
from phases import step_size
from point_impacts import components, directions
from series import Tape
from stone_forms import along, rotation, turned_back
from vectors import add, cross, dot, scaled

SERIES, FLOWN = 40, mpfr("1e-44")


class Hops:
    """What both have in common: the start in the air, the impact, what is told of a state."""

    def __init__(self, scene):
        super().__init__(scene)
        self.lost, self.flight = mpfr(0), self.free_flight()

    def impact(self, y, e):
        matrix, u = self.parts(y)
        law = "coulomb" if self.scene.law == "smooth" else self.scene.law
        static = None if law == "rolling" else self.static
        struck = self.strike(matrix, u, mpfr(e), law, self.mu, static)
        new = self.pushed(y, struck.after[:2], struck.impulse)
        return Bounce(new, struck.after[2], struck.impulse, struck.kind, struck.lost)

    def strayed(self, y, lean=None):
        n, w, u, height, r, matrix, centre = self.seen(y)
        velocity = add(u, scaled(-1, along(matrix, cross(w, r))))
        energy = (dot(velocity, velocity) + dot(w, along(self.inertia, w))) / 2 + self.g * centre + y[2]
        energy += self.lost
        self.first = getattr(self, "first", energy)
        vanishing = [dot(n, n) - 1, *add(n, scaled(-1, matrix[2]))]
        if not isinstance(y, Air):
            vanishing += [height, u[2]]
        return max(abs(x) for x in [*vanishing, (energy - self.first) / max(1, abs(energy))])


class Table(Hops, stone_forms.Table):
    """Flight and impact in the laboratory."""

    strike = staticmethod(components)

    def start(self):
        y = super().start()
        if not self.scene.aloft:
            return y
        y[6] += mpfr(self.scene.height)
        y[9] += mpfr(self.scene.lift)
        return Air(y)

    def free_flight(self):
        tape = Tape()
        tape.state()
        place, velocity = ([tape.state() for _ in range(3)] for _ in range(2))
        q, momentum = [tape.state() for _ in range(4)], [tape.state() for _ in range(3)]
        matrix, zero = rotation(q), tape.constant(0)
        w = along(matrix, along(self.free, turned_back(matrix, momentum)))
        turning = [-dot(w, q[1:]), *add([q[0] * x for x in w], cross(w, q[1:]))]
        tape.rates = [tape.constant(1), *velocity, zero, zero, tape.constant(-self.g)]
        tape.rates += [*scaled(mpfr(0.5), turning), zero, zero, zero]
        size = tape.sqrt(sum((a * (x * x) for a, x in zip(self.a2, matrix[2], strict=True)), zero))
        tape.height = place[2] - size - dot(matrix[2], self.d)
        return tape

    def gravity(self, y):
        """How fast the lowest point falls towards the table, without a force."""
        self.flight.expand(y[3:17], 2)
        return -2 * self.flight.height.c[2]

    def lowered(self, there, heat):
        """The numbers of a state in the air, from the time, the centre, its velocity, the turn, the momentum."""
        matrix = rotation(there[7:11])
        r = along(matrix, self.lowest(matrix[2]))
        spread = along(matrix, along(self.free, turned_back(matrix, there[11:14])))
        u = add(there[4:7], cross(spread, r))
        return Air([*u[:2], heat, *there, *add(r, along(matrix, self.d))])

    def fly(self, y, order, samples, out):
        tape, start, heat, own = self.flight, y[3:17], y[2], order
        while True:
            tape.expand(start, SERIES)
            out.steps += 1
            h = step_size(Watched(tape, tape.height), SERIES, FLOWN)
            down = first_fall(tape.height.c[own:], h, own)
            place = h if down is None else down
            while samples and samples[0] <= start[0] + place:
                when = samples.pop(0)
                there = [node.at(when - start[0]) for node in tape.states]
                out.add("sample" if samples else "end", when, self.lowered(there, heat))
            if not samples:
                return None, None
            start, own = [node.at(place) for node in tape.states], 0
            if down is not None:
                return self.lowered(start, heat), 0

    def parts(self, y):
        matrix = rotation(y[10:14])
        r = along(matrix, self.lowest(matrix[2]))
        columns = []
        for unit in ([mpfr(i == j) for i in range(3)] for j in range(3)):
            columns.append(add(unit, cross(self.turned_by(matrix, cross(r, unit)), r)))
        u = add(y[7:10], cross(self.turned_by(matrix, y[14:17]), r))
        return [list(row) for row in zip(*columns, strict=True)], u

    def turned_by(self, matrix, momentum):
        return along(matrix, along(self.free, turned_back(matrix, momentum)))

    def pushed(self, y, slip, impulse):
        matrix = rotation(y[10:14])
        turn = cross(along(matrix, self.lowest(matrix[2])), impulse)
        return [*slip, *y[2:7], *add(y[7:10], impulse), *y[10:14], *add(y[14:17], turn), *y[17:20]]

    def aloft(self, y, lift):
        return Air(y)

    def seen(self, y):
        matrix = rotation(y[10:14])
        n, spread = matrix[2], self.turned_by(matrix, y[14:17])
        w = turned_back(matrix, spread)
        r = turned_back(matrix, add(y[17:20], scaled(-1, along(matrix, self.d))))
        u = add(y[7:10], cross(spread, along(matrix, r)))
        if not isinstance(y, Air):
            u[:2] = y[:2]
        return n, w, u, y[6] + dot(n, r), r, matrix, y[6]

    def read(self, y, lean=None):
        n, w, u, height, r, matrix, _ = self.seen(y)
        up = [u[2], height] if isinstance(y, Air) else [mpfr(0), mpfr(0)]
        place = add(y[4:7], along(matrix, r))[:2]
        return [*n, *w, *u[:2], *up, y[2], self.lost, *y[10:14], *place]


class Body(Hops, stone_forms.Body):
    """Flight and impact in the axes of the body."""

    strike = staticmethod(directions)

    def start(self):
        y = super().start()
        return Air(y, mpfr(self.scene.lift), mpfr(self.scene.height)) if self.scene.aloft else y

    def free_flight(self):
        tape = Tape()
        n, w = ([tape.state() for _ in range(3)] for _ in range(2))
        q = [tape.state() for _ in range(4)]
        turning = [-dot(w, q[1:]), *add([q[0] * x for x in w], cross(q[1:], w))]
        tape.rates = [*cross(n, w), *along(self.free, cross(along(self.inertia, w), w))]
        tape.rates += scaled(mpfr(0.5), turning)
        # the trace is more than the largest of the moments' inverses
        self.quickest = sum(self.free[i][i] for i in range(3))
        return tape

    def gravity(self, y):
        n, w = y[4:7], y[7:10]
        _, rate = self.falling(n, w)
        swing = along(self.free, cross(along(self.inertia, w), w))
        r = self.lowest(n)
        own = add(cross(swing, r), cross(w, rate), cross(w, cross(w, r)))
        return self.g - dot(own, n)

    def falling(self, n, w):
        """How fast the height of the centre over the lowest point changes, and the rate of the arm."""
        n_rate = cross(n, w)
        dn, dn_rate = ([a * x for a, x in zip(self.a2, v, strict=True)] for v in (n, n_rate))
        size = gmpy2.sqrt(dot(n, dn))
        growth = dot(n, dn_rate) / size
        rate = [growth * a / size**2 - x / size for a, x in zip(dn, dn_rate, strict=True)]
        return growth + dot(n_rate, self.d), rate

    def fly(self, y, order, samples, out):
        air = Flight(self, y, out)
        after = air.lands(order)
        while samples and samples[0] <= y[3] + after:
            when = samples.pop(0)
            out.add("sample" if samples else "end", when, air.at(when - y[3]))
        if not samples:
            return None, None
        return air.at(after), 0

    def parts(self, y):
        """Along the axes x and y of the laboratory, written in the body."""
        matrix = rotation(y[10:14])
        r = self.lowest(y[4:7])
        arms = [cross(r, row) for row in matrix]
        light = [
            [dot(along(self.free, a), b) + (i == j) for j, b in enumerate(arms)] for i, a in enumerate(arms)
        ]
        return light, [y[0], y[1], y.lift]

    def pushed(self, y, slip, impulse):
        push = turned_back(rotation(y[10:14]), impulse)
        w = add(y[7:10], along(self.free, cross(self.lowest(y[4:7]), push)))
        return [*slip, *y[2:7], *w, *y[10:16]]

    def aloft(self, y, lift):
        return Air(y, lift, mpfr(0))

    def seen(self, y):
        n, w, matrix, r = y[4:7], y[7:10], rotation(y[10:14]), self.lowest(y[4:7])
        lift, height = (y.lift, y.height) if isinstance(y, Air) else (mpfr(0), mpfr(0))
        return n, w, [*y[:2], lift], height, r, matrix, height - dot(r, n)

    def read(self, y, lean=None):
        n, w, u, height, *_ = self.seen(y)
        return [*n, *w, *u, height, y[2], self.lost, *y[10:14], *y[14:16]]


class Flight:
    """A flight by pieces of series of the turning, and the parabola of the centre."""

    def __init__(self, model, y, out):
        self.model, self.y, self.out = model, y, out
        n, w, matrix = y[4:7], y[7:10], rotation(y[10:14])
        lift, height = (y.lift, y.height) if isinstance(y, Air) else (mpfr(0), mpfr(0))
        r = model.lowest(n)
        self.velocity = add([*y[:2], lift], scaled(-1, along(matrix, cross(w, r))))
        self.centre = add([*y[14:16], height], scaled(-1, along(matrix, r)))
        # by the vertical, which is not exactly that of the quaternion
        self.velocity[2], self.centre[2] = lift - dot(n, cross(w, r)), height - dot(n, r)
        self.pieces, self.ahead, self.state = [], mpfr(0), y[4:14]

    def turned(self, t):
        """The vertical, the angular velocity and the quaternion."""
        tape = self.model.flight
        while not self.pieces or t > self.ahead:
            tape.expand(self.state, SERIES)
            h = step_size(Watched(tape), SERIES, FLOWN)
            self.out.steps += 1
            self.pieces.append((self.ahead, [node.c[:] for node in tape.states]))
            self.state = [node.at(h) for node in tape.states]
            self.ahead = self.ahead + h
        begin, series = next(piece for piece in reversed(self.pieces) if piece[0] <= t)
        found = []
        for c in series:
            total = mpfr(0)
            for x in reversed(c):
                total = total * (t - begin) + x
            found.append(total)
        return found[:3], found[3:6], found[6:]

    def height(self, t):
        """Of the lowest point, and its rate."""
        m = self.model
        n, w, _ = self.turned(t)
        up = self.centre[2] + self.velocity[2] * t - m.g * t * t / 2
        return up + dot(n, m.lowest(n)), self.velocity[2] - m.g * t - m.falling(n, w)[0]

    def at(self, t):
        m, y = self.model, self.y
        n, w, q = self.turned(t)
        matrix, r = rotation(q), m.lowest(n)
        centre = [self.centre[i] + self.velocity[i] * t for i in (0, 1)]
        velocity = add(self.velocity, [0, 0, -m.g * t])
        u = add(velocity, along(matrix, cross(w, r)))
        arm = along(matrix, r)
        numbers = [*u[:2], y[2], y[3] + t, *n, *w, *q, centre[0] + arm[0], centre[1] + arm[1]]
        height, lift = self.height(t)
        return Air(numbers, lift, height)

    def lands(self, order):
        m = self.model
        w = self.y[7:10]
        momentum = along(m.inertia, w)
        most = m.quickest * min(dot(w, momentum), dot(momentum, momentum) * m.quickest)
        rho = max(gmpy2.sqrt(a) for a in m.a2) + gmpy2.sqrt(dot(m.d, m.d))
        bound = (1 + 1 / gmpy2.sqrt(mpfr(3))) * most * rho - m.g
        end = (self.velocity[2] + gmpy2.sqrt(self.velocity[2] ** 2 + 2 * m.g * self.centre[2])) / m.g
        return landing(self.height, end, bound, order)
