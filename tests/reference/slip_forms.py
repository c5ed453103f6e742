"""Two formulations of a body that slips and rolls, for slip.py; and how slip is written, for stone_forms.py, too.

vectors   three-dimensional, in the laboratory frame: axis, one material vector, angular velocity, centre of mass
          and its velocity. r points from the centre to the lowest point of the rim, a torus of radius a = 1 - rho
          and fillet rho. The angular acceleration, the rate of the slip u = v + w x r and that of the height of
          the lowest point are linear in the force, and so the force is found:
              slip     F = N (z - mu u/|u|) or N (z - c u), and the lowest point stays on the table
              rolling  u' = 0, and the lowest point stays on the table
reduced   theta, w1, w2, w3, the slip along the lean and across; phi, psi and the contact by quadrature, with the
          normal force of the closed form
"""

import gmpy2
from gmpy2 import mpfr
from phases import Phase
from series import Tape
from torus import Torus
from vectors import add, cross, dot, scaled, solver


class Formulation:
    """What all have in common: a scene, its phases, and how slip is written.

    The first numbers of a state are the slip, the heat and the time; `kind` is one of

        slip   |u| by its components, in tau       steep  the same in t, for viscous friction or none
        onset  |u| and its direction, in t         roll   in t
    """

    tiny = mpfr("1e-30")
    tape = Tape

    def __init__(self, scene):
        self.scene, self.phases = scene, {}
        self.mu, self.static = mpfr(scene.mu), mpfr(scene.static)

    def phase(self, kind):
        if kind not in self.phases:
            self.phases[kind] = self.equations(kind)
        return self.phases[kind]

    def slip_states(self, tape, kind):
        """Slip x, slip y, |u|, the direction's x and y, and what else is to be known."""
        if kind == "roll":
            first, second = tape.state(), tape.state()
            return first, second, None, None, None
        if kind == "onset":
            size, angle = tape.state(), tape.state()
            y, x = tape.sin_cos(angle)
            return size * x, size * y, size, x, y
        first, second = tape.state(), tape.state()
        if kind == "steep":
            return first, second, None, None, None
        size = tape.sqrt(first * first + second * second)
        return first, second, size, first / size, second / size

    def aim(self, kind, slip):
        """Force per unit of the normal force; where the slip is steep mu is that of a viscous film, or 0."""
        x, y = slip[:2] if kind == "steep" else slip[3:]
        return [-(self.mu * x), -(self.mu * y), mpfr(1)]

    def finished(self, tape, kind, slip, slip_rates, rates, force, **rest):
        """The rates of all states in the variable of this phase, and the quantities that decide."""
        ux, uy, size, x, y = slip
        zero, one, normal = tape.constant(0), tape.constant(1), force[2]
        demand = normal  # a contact that rolls whatever it takes ends at N = 0
        if gmpy2.is_finite(self.static):
            demand = self.static * self.static * (normal * normal) - force[0] * force[0] - force[1] * force[1]
        heat = zero if kind == "roll" else -(force[0] * ux + force[1] * uy)
        named = {"size": size, "slip": tape.states[:2], "force": force, "normal": normal, "demand": demand}
        if kind == "roll":
            tape.rates, named["slip"] = [zero, zero, zero, one, *rates], ()
        elif kind == "steep":
            tape.rates, named["slip"] = [*slip_rates, heat, one, *rates], ()
        else:
            growth = slip_rates[0] * x + slip_rates[1] * y
            turn = slip_rates[1] * x - slip_rates[0] * y
            named |= {"growth": growth, "turn": turn}
            if kind == "onset":
                named["residual"] = turn - tape.drift(size, tape.states[1])
                tape.rates = [growth, zero, heat, one, *rates]
            else:
                tape.rates = [size * rate for rate in [*slip_rates, heat, one, *rates]]
        return Phase(tape, **named, **rest)

    def at(self, kind, y):
        """The quantities of a phase at a state, at once."""
        phase = self.phase(kind)
        phase.tape.expand(y, 0)
        return phase

    def directed(self, y, angle, size):
        """A state with the slip in a direction of the phase's plane."""
        return [size * gmpy2.cos(angle), size * gmpy2.sin(angle), *y[2:]]

    def turning(self, y, angle):
        """f and lambda of a state at u = 0, for one direction."""
        phase = self.at("onset", [mpfr(0), angle, *y[2:]])
        return phase.turn.c[0], phase.growth.c[0], phase.normal.c[0]

    def begun(self, y):
        """The state after the series by which a slip begins."""
        return y

    def bearing(self, y, angle):
        """The direction of the slip from the lean."""
        return angle

    def lean(self, y):
        """What is to be known of a state before one where the axis is vertical."""
        return None

    def strayed(self, y, lean=None):
        """How far what vanishes is from 0."""
        return mpfr(0)


class Rim(Formulation, Torus):
    """A body with a rim."""

    def __init__(self, scene):
        Formulation.__init__(self, scene)
        Torus.__init__(self, scene.body)

    def events(self, phase, kind):
        """What may end a phase."""
        yield ("lift-off", phase.normal) if kind != "roll" else ("slips", phase.demand)
        if self.scene.side:
            yield "side", phase.up
        if self.rim:
            yield "face", phase.watch_face


class Vectors(Rim):
    """Newton's and Euler's equations in the laboratory frame."""

    order, tolerance, cut, last = 33, mpfr("1e-34"), 0.9, 38

    def start(self):
        start = [mpfr(x) for x in self.scene.start]
        return [*start[4:], mpfr(0), mpfr(0), *self.begin(*start)]

    def equations(self, kind):
        tape = self.tape()
        slip = self.slip_states(tape, kind)
        tape.state(), tape.state()
        _, v, e3, material, w = ([tape.state() for _ in range(3)] for _ in range(5))
        up = e3[2]
        axis = cross(w, e3)
        if self.rim:
            s = tape.sqrt(e3[0] * e3[0] + e3[1] * e3[1])
            s1 = -(up * axis[2]) / s
            e1 = [-(up * e3[0]) / s, -(up * e3[1]) / s, s]
            e1_rate = [-(axis[2] * e3[i] + up * axis[i] + s1 * e1[i]) / s for i in (0, 1)]
            arm = [-(self.rim * e1[i]) - self.ell * e3[i] for i in range(3)]
            moving = [-(self.rim * (e1_rate[i] if i < 2 else s1)) - self.ell * axis[i] for i in range(3)]
        else:
            s = None
            arm, moving = scaled(-self.ell, e3), scaled(-self.ell, axis)
        r = [arm[0], arm[1], arm[2] - self.fillet]
        spin = dot(w, e3)

        def lifting(acceleration):
            """Of the second rate of e3 . z and of the sine, what is linear in it."""
            change = acceleration[0] * e3[1] - acceleration[1] * e3[0]
            return -(self.ell * change) + (self.rim * (up * change) / s if s is not None else 0)

        # without force: u' and the acceleration of the lowest point
        momentum = [self.i1 * w[i] + (self.i3 - self.i1) * (spin * e3[i]) for i in range(3)]
        free = self.turned(scaled(-1, cross(w, momentum)), e3)
        carried = cross(w, axis)[2]
        lift = lifting(free) - self.ell * carried - 1
        if s is not None:
            lift = lift + self.rim * (axis[2] * axis[2] + up * carried + s1 * s1) / s
        free_slip = add(cross(free, r), cross(w, moving))[:2]

        def response(force):
            """Angular acceleration, u' and the acceleration of the lowest point that a force gives."""
            acceleration = self.turned(cross(r, force), e3)
            swung = cross(acceleration, r)
            return acceleration, [force[0] + swung[0], force[1] + swung[1]], force[2] + lifting(acceleration)

        if kind == "roll":
            units = [[mpfr(i == j) for i in range(3)] for j in range(3)]
            columns = [[*u_rate, height] for _, u_rate, height in map(response, units)]
            force = solver(columns)([-free_slip[0], -free_slip[1], -lift])
            pushed, slip_rates = response(force)[0], None
        else:
            pushed, u_rate, height = response(self.aim(kind, slip))
            normal = -(lift / height)
            force = [normal * x for x in self.aim(kind, slip)]
            pushed = [normal * x for x in pushed]
            slip_rates = [free_slip[i] + normal * u_rate[i] for i in (0, 1)]
        acceleration = add(free, pushed)
        rates = [*v, force[0], force[1], force[2] - 1, *axis, *cross(w, material), *acceleration]
        return self.finished(tape, kind, slip, slip_rates, rates, force, up=up, watch_face=s)

    def bearing(self, y, angle):
        lean = self.lean(y)
        return angle - gmpy2.atan2(lean[1], lean[0])

    def lean(self, y):
        """The direction of the lean; that of the step before where the axis is vertical, as a planar fall ends."""
        return self.leaning(y[10:13])

    def read(self, y, lean=None):
        ux, uy, heat, _, *rest = y
        state, pose, contact, (_, h, _), _ = self.in_space(rest, lean)
        return [*state, ux * h[0] + uy * h[1], uy * h[0] - ux * h[1], heat, *pose, *contact]

    def strayed(self, y, lean=None):
        """How far the integrated slip is from v + w x r, the rim from the table, and the axes from their lengths."""
        *_, (u, _, _), vanishing = self.in_space(y[4:], lean)
        return max(abs(x) for x in (u[0] - y[0], u[1] - y[1], *vanishing))


class Reduced(Rim):
    """The closed system of six numbers, and quadratures."""

    order, tolerance, cut, last = 37, mpfr("1e-35"), 0.6, 44

    def start(self):
        theta, w1, w2, w3, u_h, u_2 = (mpfr(x) for x in self.scene.start)
        return [u_h, u_2, mpfr(0), mpfr(0), theta, w1, w2, w3, *[mpfr(0)] * 4]

    def equations(self, kind):
        tape = self.tape()
        slip = u_h, u_2, *_ = self.slip_states(tape, kind)
        tape.state(), tape.state()
        theta, w1, w2, w3, phi, _, _, _ = (tape.state() for _ in range(8))
        s, c = tape.sin_cos(theta)
        ell, i1, i3, rho, a = self.ell, self.i1, self.i3, self.fillet, self.rim
        radius, depth = rho * s + a, rho * c + ell
        g0, g1 = ell * s - a * c, ell * c + a * s
        height = g1 + rho
        precession = w1 / s
        ct_w1 = c * precession
        couple = w1 * (i3 * w3 - i1 * ct_w1)
        square = w2 * w2
        v_h, v_2 = u_h + height * w2, u_2 - depth * w1 + radius * w3
        inertia = g0 * g0 + i1
        bare = (i1 * (1 - g1 * square) + g0 * couple) / inertia
        round_fillet = rho * w2 * (s * w1 + c * w3)
        if kind == "roll":
            tilt = (couple - g0 * (1 - g1 * square)) / inertia  # w2' without F_h
            along = (-(precession * v_2) + g0 * square + height * tilt) / (1 + height * height / inertia)
            spun = (w2 * (i1 * ct_w1 - i3 * w3)) / i1
            across = (precession * v_h - depth * spun - round_fillet) / (
                1 + depth * depth / i1 + radius * radius / i3
            )
            normal = bare - g0 * height * along / inertia
        else:
            aim = self.aim(kind, slip)
            normal = bare / (1 + aim[0] * (g0 * height) / inertia)
            along, across = normal * aim[0], normal * aim[1]
        w1_rate = (w2 * (i1 * ct_w1 - i3 * w3) + depth * across) / i1
        w3_rate = -(radius * across) / i3
        w2_rate = (couple - g0 * normal - height * along) / i1
        slip_rates = [
            along + precession * v_2 - g0 * square - height * w2_rate,
            across - precession * v_h + depth * w1_rate - radius * w3_rate + round_fillet,
        ]
        psi_rate = w3 - ct_w1
        out, side = u_h + rho * w2, u_2 + radius * psi_rate
        sin_phi, cos_phi = tape.sin_cos(phi)
        path = [out * cos_phi - side * sin_phi, out * sin_phi + side * cos_phi]
        rates = [-w2, w1_rate, w2_rate, w3_rate, precession, psi_rate, *path]
        force = [along, across, normal]
        return self.finished(tape, kind, slip, slip_rates, rates, force, up=c, watch_face=theta)

    def read(self, y, lean=None):
        """The numbers of a row."""
        return [*y[4:8], y[0], y[1], y[2], *y[8:]]
