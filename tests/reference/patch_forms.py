"""Two formulations of a body on a round patch of contact, for patches.py: what both share, and the one along the tilt.

vectors   three-dimensional, in the laboratory frame: patch_vectors.py
reduced   theta, w1, w2, w3, the slip along the lean and across; phi, psi and the contact by quadrature, with the normal
          force of the closed form, which the couple leaves as it is: it has no part along e2

Every piece of the patch, of radius eps, rubs with mu times its pressure (Hertz) against its own slip, that of a body
that slips with u and drills with w.z. With k = |u|/(eps |w.z|) the force is -mu N f(k) u/|u| and the couple about the
vertical -mu N eps g(k) sgn(w.z). Each formulation computes f and g in its own way: `reduced` by the closed form and, far
from the patch, by hypergeometric series, `vectors` by sums over the chords of the patch. On a table that turns at om about z the slip
is that over the table, and w.z - om takes the place of w.z. Kinds of phases:

    inside    k < 1: the instantaneous centre lies in the patch, and f and g are polynomials
    outside   k > 1: f and g are analytic in the angle whose sine is q = eps w.z/|u|, and so is the motion in tau,
              dt = cos(angle) dtau, up to k = 1, where its third derivative in t is infinite
    far       k well above 1: f and g are series in q, and w.z may change its sign

The first numbers of a state are the time and the heat, the last one is the angle of `outside`.
"""

import gmpy2
from gmpy2 import mpfr
from phases import Phase
from series import Tape
from torus import Torus

CLOSE = mpfr("1e-18")  # above q = 1 less this, inside and outside differ by less than 1e-44


class Formulation(Torus):
    """A scene, its phases, and the friction of the patch by the law of a formulation."""

    def __init__(self, scene):
        super().__init__(scene.body)
        self.scene, self.mu, self.patch = scene, mpfr(scene.mu), mpfr(scene.patch)
        self.om, self.place = mpfr(scene.turning), [mpfr(x) for x in scene.place]
        self.phases, self.probe = {}, None

    def phase(self, kind, sign):
        if (kind, sign) not in self.phases:
            self.phases[kind, sign] = self.equations(kind, sign)
        return self.phases[kind, sign]

    def enter(self, y):
        """The kind of phase of a state, the sign of w.z, and the state with its angle."""
        size, drilling = self.slip_and_drilling(y)
        width, sign = self.patch * abs(drilling), 1 if drilling > 0 else -1
        if size - width < CLOSE * size:
            return "inside", sign, [*y[:-1], mpfr(0)]
        kind = "outside" if width > size * self.far else "far"
        return kind, sign, [*y[:-1], gmpy2.asin(sign * width / size)]

    def friction(self, tape, kind, sign, square, drilling):
        """Of a slip with this square: the force over N and over the slip, the couple over N, and |u| and q outside."""
        angle = tape.state()
        if kind == "inside":
            width = (self.patch * sign) * drilling
            slope, g = self.inside(square / (width * width))
            tape.events = [("slides", width * width - square)]
            return -(self.mu * (slope / width)), -(self.mu * self.patch * sign) * g, None, None
        size = tape.sqrt(square)
        q = self.patch * (drilling / size)
        if kind == "outside":
            y, x = tape.sin_cos(angle)
            f, g = self.outside(tape, q, angle, y, x)
            tape.events, tape.stretch = [("creeps", x), ("far", q * q - self.far**2)], x
        else:
            f, g = self.series(tape, q)
            tape.events = [("near", self.near**2 - q * q), ("turns", sign * drilling)]
        return -(self.mu * (f / size)), -(self.mu * self.patch) * g, size, q

    def finished(self, tape, kind, rates, friction, slip, slip_rates, drilling_rate, force, couple):
        """The phase, in tau where it is outside."""
        _, _, size, q = friction
        if kind == "outside":
            growth = (slip[0] * slip_rates[0] + slip[1] * slip_rates[1]) / size
            bend = (self.patch * drilling_rate - q * growth) / size
            tape.rates = [*(tape.stretch * rate for rate in rates), bend]
        else:
            tape.rates = [*rates, tape.constant(0)]
        return Phase(tape, events=tape.events, force=force, normal=force[2], couple=couple)

    def pressed(self, y):
        """The horizontal force in the plane of the formulation, the normal force and the couple of a state."""
        if self.probe is None:
            self.probe = type(self)(self.scene)
        kind, sign, y = self.enter(y)
        phase = self.probe.phase(kind, sign)
        phase.tape.expand(y, 0)
        return [x.c[0] for x in (*phase.force, phase.couple)]

    def bent(self, y):
        """How far the angle of `outside`, which is carried beside the slip, is from that of the slip."""
        size, drilling = self.slip_and_drilling(y)
        return abs(gmpy2.sin(y[-1]) - self.patch * drilling / size)

    def strayed(self, y, lean=None):
        """How far what vanishes is from 0."""
        return mpfr(0)


class Reduced(Formulation):
    """The closed system of six numbers, and quadratures; the law in closed form."""

    order, tolerance = 37, mpfr("1e-35")
    far, near, terms = mpfr("0.25"), mpfr("0.35"), 50

    def inside(self, x):
        """f/k and g, with x = k^2."""
        pi = gmpy2.const_pi()
        return 3 * pi / 32 * (4 - x), 3 * pi / 128 * (8 - x * (8 - 3 * x))

    def outside(self, tape, q, angle, y, x):
        """f and g, which has the sign of q."""
        square = 1 / (q * q)
        f = square * (4 - square) * (q * angle) + (square + 2) * x
        g = (8 - square * (8 - 3 * square)) * angle + 3 * ((2 - square) * (x / q))
        return mpfr(3) / 16 * f, mpfr(3) / 64 * g

    def series(self, tape, q):
        """The same by f = 2F1(-1/2, 1/2; 5/2; q^2), g = q 2F1(1/2, 1/2; 7/2; q^2)/5."""
        square = q * q
        return self.hypergeometric(square, -0.5, 2.5), q * self.hypergeometric(square, 0.5, 3.5) / 5

    def hypergeometric(self, z, a, c):
        """2F1(a, 1/2; c; z), cut after some terms, by Horner's scheme."""
        total = mpfr(1)
        for n in reversed(range(self.terms)):
            total = (mpfr(n + a) * mpfr(n + 0.5) / (mpfr(n + c) * (n + 1))) * (z * total) + 1
        return total

    def start(self):
        return [mpfr(0), mpfr(0), *map(mpfr, self.scene.start), mpfr(0), mpfr(0), *self.place, mpfr(0)]

    def slip_and_drilling(self, y):
        theta, w1, _, w3, u_h, u_2 = y[2:8]
        return gmpy2.hypot(u_h, u_2), gmpy2.sin(theta) * w1 + gmpy2.cos(theta) * w3 - self.om

    def equations(self, kind, sign):
        tape = Tape()
        tape.state(), tape.state()
        theta, w1, w2, w3, u_h, u_2, phi, _, x, y = (tape.state() for _ in range(10))
        s, c = tape.sin_cos(theta)
        ell, i1, i3, rho, a = self.ell, self.i1, self.i3, self.fillet, self.rim
        radius, depth = rho * s + a, rho * c + ell
        g0, g1 = ell * s - a * c, ell * c + a * s
        height = g1 + rho
        drilling = s * w1 + c * w3
        over = drilling - self.om
        pull, turn, *_ = friction = self.friction(tape, kind, sign, u_h * u_h + u_2 * u_2, over)

        precession = w1 / s
        gyro = i3 * w3 - i1 * (c * precession)
        square, inertia = w2 * w2, g0 * g0 + i1
        normal = (i1 * (1 - g1 * square) + g0 * (w1 * gyro)) / (inertia + g0 * height * (pull * u_h))
        along, across, couple = normal * (pull * u_h), normal * (pull * u_2), normal * turn
        w1_rate = (depth * across - w2 * gyro + s * couple) / i1
        w2_rate = (w1 * gyro - g0 * normal - height * along) / i1
        w3_rate = (c * couple - radius * across) / i3
        v_h, v_2 = u_h + height * w2, u_2 - depth * w1 + radius * w3
        psi_rate = w3 - c * precession
        out, side = u_h + rho * w2, u_2 + radius * psi_rate
        sin_phi, cos_phi = tape.sin_cos(phi)
        pull_h, pull_2 = tape.constant(0), tape.constant(0)
        if self.om:
            out = out + self.om * (x * sin_phi - y * cos_phi)
            side = side + self.om * (x * cos_phi + y * sin_phi)
            pull_h, pull_2 = self.om * side, -self.om * out
        slip_rates = [
            along + pull_h + precession * v_2 - g0 * square - height * w2_rate,
            across + pull_2 - precession * v_h + depth * w1_rate - radius * w3_rate + rho * (w2 * drilling),
        ]
        drilling_rate = s * w1_rate + c * w3_rate - w2 * (c * w1 - s * w3)

        path = [out * cos_phi - side * sin_phi, out * sin_phi + side * cos_phi]
        heat = -(along * u_h + across * u_2 + couple * over)
        rates = [tape.constant(1), heat, -w2, w1_rate, w2_rate, w3_rate, *slip_rates]
        rates += [precession, psi_rate, *path]
        force = [along, across, normal]
        return self.finished(
            tape, kind, rates, friction, (u_h, u_2), slip_rates, drilling_rate, force, couple
        )

    def read(self, y, lean=None):
        """The numbers of a row but the time."""
        return [*y[2:8], y[1], *y[8:12], *self.pressed(y)]
