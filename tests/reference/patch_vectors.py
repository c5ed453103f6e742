"""A body on a round patch of contact in the laboratory frame, one of the two formulations of patch_forms.py.

Axis, one material vector, angular velocity, centre of mass and its velocity. With r from the centre to the lowest point
of the torus, the angular acceleration, the rate of the slip u = v + w x r and with it the acceleration of the lowest
point are linear in the normal force, and so it is found: the lowest point stays on the table.

Force and couple are integrals over the chords of the patch through the instantaneous centre, at an angle b to the slip:

    f = (3/4) k int cos^2 b (1 - k^2 sin^2 b) db,   g = (3/16) int (1 - k^2 sin^2 b)^2 db   over |sin b| <= min(1, 1/k)

Inside, few equidistant angles give them exactly. Outside, the angles are those of Gauss, and far from the patch the
distances v = k sin b of the chords from its centre are.
"""

import gmpy2
from gmpy2 import mpfr
from patch_forms import Formulation
from series import Tape
from vectors import add, cross, dot, scaled

ANGLES = 5  # three would do


def gauss(count):
    """Places and weights of Gauss's rule on [0, 1]: the zeros of Legendre's polynomial, by Newton's method."""
    rule = []
    for k in range(count):
        x = gmpy2.cos(gmpy2.const_pi() * (k + mpfr("0.75")) / (count + mpfr("0.5")))
        for _ in range(9):
            older, p = mpfr(1), x
            for n in range(1, count):
                older, p = p, ((2 * n + 1) * x * p - n * older) / (n + 1)
            slope = count * (x * p - older) / (x * x - 1)
            x -= p / slope
        rule.append(((1 + x) / 2, 1 / ((1 - x * x) * slope * slope)))
    return rule


class Vectors(Formulation):
    """Newton's and Euler's equations in the laboratory frame; the law by chords."""

    order, tolerance = 33, mpfr("1e-34")
    far, near, chords = mpfr("0.3"), mpfr("0.4"), 24

    def __init__(self, scene):
        super().__init__(scene)
        self.rule = gauss(self.chords)

    def inside(self, x):
        """f/k and g, with x = k^2."""
        step = gmpy2.const_pi() / ANGLES
        sines = [gmpy2.sin(j * step) ** 2 for j in range(ANGLES)]
        within = [1 - sine * x for sine in sines]
        slope = sum(((1 - sine) * chord for sine, chord in zip(sines, within, strict=True)), mpfr(0))
        return mpfr(3) / 4 * step * slope, mpfr(3) / 16 * step * sum((y * y for y in within), mpfr(0))

    def outside(self, tape, q, angle, y, x):
        """f and g, which has the sign of q."""
        f, g, square = tape.constant(0), tape.constant(0), 1 / (q * q)
        for place, weight in self.rule:
            sine, cosine = tape.sin_cos(place * angle)
            within = 1 - square * (sine * sine)
            f, g = f + weight * (cosine * cosine * within), g + weight * (within * within)
        return mpfr(3) / 2 * (angle / q * f), mpfr(3) / 8 * (angle * g)

    def series(self, tape, q):
        """The same where the sine of an angle is q v, and v goes from 0 to 1."""
        f, g, square = tape.constant(0), tape.constant(0), q * q
        for place, weight in self.rule:
            within = 1 - place * place
            cosine = tape.sqrt(1 - place * place * square)
            f, g = f + weight * within * cosine, g + weight * within * within / cosine
        return mpfr(3) / 2 * f, mpfr(3) / 8 * (q * g)

    def start(self):
        begun, (x, y) = self.begin(*map(mpfr, self.scene.start)), self.place
        begun[:2] = [begun[0] + x, begun[1] + y]
        begun[3:5] = [begun[3] - self.om * y, begun[4] + self.om * x]
        return [mpfr(0), mpfr(0), *begun, mpfr(0)]

    def in_space(self, vectors, lean=None):
        """The velocity of the lowest point is that over the table."""
        *first, contact, (u, h, e2), vanishing = super().in_space(vectors, lean)
        over = [u[0] + self.om * contact[1], u[1] - self.om * contact[0], u[2]]
        return [*first, contact, (over, h, e2), vanishing]

    def slip_and_drilling(self, y):
        *_, (u, _, _), _ = self.in_space(y[2:17])
        return gmpy2.hypot(u[0], u[1]), y[16] - self.om

    def equations(self, kind, sign):
        tape = Tape()
        tape.state(), tape.state()
        place, v, e3, material, w = ([tape.state() for _ in range(3)] for _ in range(5))
        zero, one = tape.constant(0), tape.constant(1)
        axis = cross(w, e3)
        r, r_rate = scaled(-self.ell, e3), scaled(-self.ell, axis)
        if self.rim:
            up, s = e3[2], tape.sqrt(e3[0] * e3[0] + e3[1] * e3[1])
            h = [-(e3[0] / s), -(e3[1] / s)]
            s_rate = -(h[0] * axis[0] + h[1] * axis[1])
            h_rate = [-((axis[i] + s_rate * h[i]) / s) for i in (0, 1)]
            r = [x - self.rim * y for x, y in zip(r, [up * h[0], up * h[1], s], strict=True)]
            e1_rate = [*(axis[2] * h[i] + up * h_rate[i] for i in (0, 1)), s_rate]
            r_rate = [x - self.rim * y for x, y in zip(r_rate, e1_rate, strict=True)]
        r[2] = r[2] - self.fillet
        u, moves, over = add(v, cross(w, r))[:2], add(v, r_rate), w[2] - self.om
        if self.om:
            u = [u[0] + self.om * (place[1] + r[1]), u[1] - self.om * (place[0] + r[0])]
        pull, turn, *_ = friction = self.friction(tape, kind, sign, u[0] * u[0] + u[1] * u[1], over)

        # what there is without the contact, and what a unit of the normal force adds
        spin = dot(w, e3)
        momentum = [self.i1 * w[i] + (self.i3 - self.i1) * (spin * e3[i]) for i in range(3)]
        free = self.turned(scaled(-1, cross(w, momentum)), e3)
        table = [self.om * moves[1], -self.om * moves[0], -one]
        known = add(cross(free, r), cross(w, r_rate), table)
        aim = [pull * u[0], pull * u[1], one]
        swung = self.turned(add(cross(r, aim), [zero, zero, turn]), e3)
        answer = add(aim, cross(swung, r))
        normal = -(known[2] / answer[2])
        force, couple = [normal * x for x in aim], normal * turn
        acceleration = [free[i] + normal * swung[i] for i in range(3)]
        slip_rates = [known[i] + normal * answer[i] for i in (0, 1)]

        heat = -(force[0] * u[0] + force[1] * u[1] + couple * over)
        rates = [one, heat, *v, force[0], force[1], normal - 1, *axis, *cross(w, material), *acceleration]
        return self.finished(tape, kind, rates, friction, u, slip_rates, acceleration[2], force, couple)

    def read(self, y, lean=None):
        """The numbers of a row but the time; phi and psi up to whole turns."""
        state, pose, contact, (u, h, e2), _ = self.in_space(y[2:17])
        fx, fy, normal, couple = self.pressed(y)
        force = [fx * h[0] + fy * h[1], fx * e2[0] + fy * e2[1]]
        return [*state, dot(u, h), dot(u, e2), y[1], *pose, *contact, *force, normal, couple]

    def strayed(self, y, lean=None):
        """How far the rim is from the table, and the axes from their lengths."""
        return max(abs(x) for x in self.in_space(y[2:17])[-1])
