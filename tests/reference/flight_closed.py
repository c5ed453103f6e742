"""Flight and impact in closed form, one of the two formulations of flight_forms.py."""

import gmpy2
import slip_forms
from flight_forms import Air, Bounce, ended, landing, slid
from gmpy2 import mpfr
from series import Tape
from torus import Z
from vectors import add, cross, dot, scaled


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
            angle, length, rising, worked, *_ = (tape.state() for _ in range(7))
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
            done, end, pressed = slid(
                tape, [length], e, length, rising, worked, [begin, size, lift, mpfr(0), *[mpfr(0)] * 3]
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
        """The impulse of a film by elementary functions of the normal impulse, whose end Newton finds."""
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
    """A flight in closed form: a spherical triangle (n, z, e3), n along the angular momentum."""

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
        """The first time at which this rim is down; `order` is that of its height if it starts there."""
        m = self.model
        most = self.rate**2 * (abs(m.ell) * self.both + m.rim * gmpy2.sin(self.b)) - 1
        end = self.velocity[2] + gmpy2.sqrt(self.velocity[2] ** 2 + 2 * self.centre[2])
        return landing(lambda t: self.height(t, side), end, most, order)
