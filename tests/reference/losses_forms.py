"""Two formulations of a body that losses slow down, for losses.py, with the laws of the losses as vectors.

    vectors   three-dimensional, in the laboratory frame: axis, one material vector, angular velocity w,
              centre of mass and its velocity v. With r from the centre to the contact, the force is found
              from linear equations: d/dt (v + w x r) = 0 in rolling, of slip only its vertical part.
    momenta   in the frame (h, e2, z) that precesses and does not tilt: in rolling the angular momentum about
              the contact, which moves, so that no contact force appears; in slip that about the centre. The
              normal force follows from the height of the centre.

h = c e1 - s e3 is horizontal in the leaning plane. With psi' = -w.h/s, the radius A of the circle of contact
and the normal force N, the couple on the body is the sum of

    dry         eps N A sgn(psi') h/s             drilling    -mu_p N sgn(w.z) z
    viscous     c A^2 psi' h/s                    air         -b w
    rolling     -delta N w_horizontal/|...|       air2        -b2 |w| w
    film        (pi/4) mu psi' h/s^2              layer       k |psi'|^(3/2) sgn(psi') h/s

What holds psi' or w.z at 0 is a couple along h or z, found with the acceleration, of at most the size
above.
"""

import gmpy2
from gmpy2 import mpfr
from phases import Phase
from series import Tape
from torus import Torus
from vectors import add, cross, dot, scaled, solver

LAWS = ("dry", "viscous", "rolling", "drilling", "air", "air2", "film", "layer")


def couple(tape, losses, signs, w, h, s, radius):
    """The couple without the normal force, and that per unit of it; z is the third axis of either frame."""
    psi = -(w[0] * h[0] + w[1] * h[1]) / s
    without, along, per_normal, along_per_normal = [], [], [], []
    sign = mpfr(signs[0])
    if losses["dry"]:
        along_per_normal.append(losses["dry"] * sign * (radius / s))
    if losses["viscous"]:
        along.append(losses["viscous"] * (radius * radius * psi / s))
    if losses["film"]:
        along.append((gmpy2.const_pi() / 4 * losses["film"]) * (psi / (s * s)))
    if losses["layer"]:
        size = psi * sign
        along.append((losses["layer"] * sign) * (size * tape.sqrt(size) / s))
    if losses["air"]:
        without.append(scaled(-losses["air"], w))
    if losses["air2"]:
        size = tape.sqrt(dot(w, w))
        without.append([-losses["air2"] * (size * x) for x in w])
    if losses["rolling"]:
        size = tape.sqrt(w[0] * w[0] + w[1] * w[1])
        per_normal.append([-losses["rolling"] * (w[i] / size) for i in (0, 1)] + [tape.constant(0)])
    if losses["drilling"]:
        vertical = tape.constant(-losses["drilling"] * mpfr(signs[1]))
        per_normal.append([tape.constant(0), tape.constant(0), vertical])
    zero = [tape.constant(0)] * 3
    pairs = ((without, along), (per_normal, along_per_normal))
    return psi, *(
        add(zero, zero, *vectors, *([q * x for x in h] for q in amounts)) for vectors, amounts in pairs
    )


class Formulation(Torus):
    """A scene and its phases; the first numbers of a state are the time, the work lost and the heat."""

    tape = Tape

    def __init__(self, scene):
        super().__init__(scene.body)
        self.scene, self.mu = scene, mpfr(scene.mu)
        self.losses = {name: mpfr(scene.losses.get(name, 0.0)) for name in LAWS}
        self.phases = {}

    def phase(self, kind, signs):
        if (kind, signs) not in self.phases:
            self.phases[kind, signs] = self.equations(kind, signs)
        return self.phases[kind, signs]

    def at(self, kind, signs, y):
        """The quantities of a phase at a state, with their first rates."""
        phase = self.phase(kind, signs)
        phase.tape.expand(y, 1)
        return phase

    def finished(self, tape, rates, size, **decide):
        """The phase, in tau where there is a size of the slip."""
        tape.rates = rates if size is None else [size * rate for rate in rates]
        return Phase(tape, size=size, **decide)

    def turn(self, y, kind):
        """The state of slip as that of a phase that follows."""
        return y

    def strayed(self, y, lean=None):
        """How far what vanishes is from 0."""
        return mpfr(0)

    def rolls(self, kind):
        return kind not in ("smooth", "slip")

    def hold(self, kind, push, normal, s):
        """What dry friction could hold less what it holds, of the squares; None where it holds nothing."""
        if push is None:
            return None
        most = self.losses["dry"] * normal * (self.fillet * s + self.rim) / s
        most = most if kind == "held rim" else self.losses["drilling"] * normal
        return most * most - push * push

    def friction(self, tape, kind, u):
        """|u| of a slip with friction, and the direction of the force per unit of N."""
        if kind == "smooth":
            return None, [tape.constant(0), tape.constant(0), tape.constant(1)]
        size = tape.sqrt(u[0] * u[0] + u[1] * u[1])
        return size, [-(self.mu * (u[0] / size)), -(self.mu * (u[1] / size)), tape.constant(1)]


class Vectors(Formulation):
    """Newton's and Euler's equations in the laboratory frame."""

    order, tolerance = 33, mpfr("1e-34")
    faces = [mpfr(4 + j) / 100000 for j in range(10, -1, -1)]

    def start(self):
        return [*[mpfr(0)] * 3, *self.begin(*map(mpfr, self.scene.start))]

    def equations(self, kind, signs):
        tape = self.tape()
        for _ in range(6):
            tape.state()
        v, e3, material, w = ([tape.state() for _ in range(3)] for _ in range(4))
        zero, one = tape.constant(0), tape.constant(1)
        c = e3[2]
        s = tape.sqrt(e3[0] * e3[0] + e3[1] * e3[1])
        h = [-(e3[0] / s), -(e3[1] / s), zero]
        axis = cross(w, e3)  # the rate of e3
        s_rate = -(h[0] * axis[0] + h[1] * axis[1])
        # the lever from the centre to the contact, and its rate
        e1 = [c * h[0], c * h[1], s]
        h_rate = [-((axis[i] + s_rate * h[i]) / s) for i in (0, 1)]
        e1_rate = [*(axis[2] * h[i] + c * h_rate[i] for i in (0, 1)), s_rate]
        r = [-(self.rim * e1[i]) - self.ell * e3[i] for i in range(3)]
        r[2] = r[2] - self.fillet
        r_rate = [-(self.rim * e1_rate[i]) - self.ell * axis[i] for i in range(3)]
        u = add(v, cross(w, r))

        psi, fixed, per_normal = couple(tape, self.losses, signs, w, h, s, self.fillet * s + self.rim)
        spin = dot(w, e3)

        def response(force):
            """Angular acceleration, and d/dt (v + w x r), that a force and its losses give."""
            acceleration = self.turned(add(cross(r, force), [force[2] * x for x in per_normal]), e3)
            return acceleration, add(force, cross(acceleration, r))

        momentum = [self.i1 * w[i] + (self.i3 - self.i1) * (spin * e3[i]) for i in range(3)]
        free = self.turned(add(fixed, scaled(-1, cross(w, momentum))), e3)
        known = add(cross(free, r), cross(w, r_rate), [zero, zero, -one])
        size, heat, push = None, zero, None
        if self.rolls(kind):
            units = [[one, zero, zero], [zero, one, zero], [zero, zero, one]]
            solved = solver([response(unit)[1] for unit in units])

            def balancing(acceleration):
                return solved(scaled(-1, acceleration))

            force = balancing(known)
            if kind != "roll":
                held, turn = (h, [*h_rate, zero]) if kind == "held rim" else (units[2], [zero] * 3)
                bare = self.turned(held, e3)
                more = balancing(cross(bare, r))
                gained = dot(add(bare, response(more)[0]), held)
                push = -((dot(add(free, response(force)[0]), held) + dot(w, turn)) / gained)
                force = add(force, [push * x for x in more])
                free = add(free, [push * x for x in bare])
        else:
            size, aim = self.friction(tape, kind, u)
            normal = -(known[2] / response(aim)[1][2])
            force = [normal * x for x in aim]
            heat = -(force[0] * u[0] + force[1] * u[1])
        normal = force[2]
        acceleration = add(free, response(force)[0])
        lost = -dot(add(fixed, [normal * x for x in per_normal]), w)
        moving = [*v, force[0], force[1], normal - 1, *axis, *cross(w, material), *acceleration]
        demand = self.mu * self.mu * (normal * normal) - force[0] * force[0] - force[1] * force[1]
        decide = {"demand": demand, "hold": self.hold(kind, push, normal, s), "push": push}
        decide |= {"normal": normal, "psi": psi, "drill": w[2], "up": c, "lean": s}
        return self.finished(tape, [one, lost, heat, *moving], size, **decide)

    def read(self, y, lean=None):
        """The numbers of a row but the time; phi and psi up to whole turns."""
        state, pose, contact, (u, h, e2), _ = self.in_space(y[3:])
        return [*state, dot(u, h), dot(u, e2), y[1], y[2], *pose, *contact]

    def strayed(self, y, lean=None):
        return max(abs(x) for x in self.in_space(y[3:])[-1])


class Momenta(Formulation):
    """Angular momentum about the contact (rolling) or the centre (slip), in the frame (h, e2, z)."""

    order, tolerance = 37, mpfr("1e-35")
    faces = [mpfr(3 + j) / 100000 for j in range(11, -1, -1)]

    def start(self):
        theta, w1, w2, w3, u_h, u_2 = (mpfr(x) for x in self.scene.start)
        w, rolls = self.components(theta, w1, w2, w3), self.scene.contact == "rolling"
        v = add([u_h, u_2], scaled(-1, cross(w, self.lever(gmpy2.sin(theta), gmpy2.cos(theta)))[:2]))
        momentum = self.momentum(theta, w, about_contact=rolls)
        return [*[mpfr(0)] * 3, theta, *[mpfr(0)] * 4, *momentum, *([] if rolls else v)]

    def equations(self, kind, signs):
        tape = self.tape()
        for _ in range(3):
            tape.state()
        theta, phi, _, _, _ = (tape.state() for _ in range(5))
        momentum = [tape.state() for _ in range(3)]
        zero, one = tape.constant(0), tape.constant(1)
        s, c = tape.sin_cos(theta)
        g, g1 = self.ell * s - self.rim * c, self.ell * c + self.rim * s
        height = g1 + self.fillet
        more = self.i3 - self.i1
        rolling, push = self.rolls(kind), None
        if rolling:
            hh, zz = height * height + self.i1 + more * (s * s), g * g + self.i1 + more * (c * c)
            hz = g * height - more * (s * c)
            inertia = g * g + height * height + self.i1
        else:
            hh, zz, hz = self.i1 + more * (s * s), self.i1 + more * (c * c), -(more * (s * c))
            inertia = tape.constant(self.i1)
        det = hh * zz - hz * hz
        w_h = (zz * momentum[0] - hz * momentum[2]) / det
        w_z = (hh * momentum[2] - hz * momentum[0]) / det
        w2 = momentum[1] / inertia
        w, e2_only = [w_h, w2, w_z], [one, zero, zero]
        precession = (c * w_h + s * w_z) / s
        r = [g, zero, -height]
        if rolling:
            u = [zero, zero, zero]
            v = scaled(-1, cross(w, r))
        else:
            v = [tape.state(), tape.state(), g * w2]
            u = add(v, cross(w, r))
        psi, fixed, per_normal = couple(tape, self.losses, signs, w, e2_only, s, self.fillet * s + self.rim)
        # the velocity of the contact on the table: that of the centre and the change of the lever
        moved = [v[0] - g1 * w2, v[1] + precession * g, zero]
        carried = [precession * momentum[1], -(precession * momentum[0]), zero]  # of the rates in this frame
        # N = 1 + height'', (height)'' = g w2' - g' w2^2, and the e2 part of the momentum is inertia w2
        size, heat = None, zero
        if rolling:
            weight = cross(r, [zero, zero, one])  # r x z = -(C - P) x z
            swept = cross(moved, v)
            known = [fixed[i] + weight[i] - swept[i] + carried[i] for i in range(3)]
            inertia_rate = -2 * (g * (g1 - height)) * w2
            per = list(per_normal)
            bare = known[1] - inertia_rate * w2
        else:
            size, aim = self.friction(tape, kind, u)
            known = [fixed[i] + carried[i] for i in range(3)]
            per = add(cross(r, aim), per_normal)
            bare = known[1]
        normal = (1 - g1 * (w2 * w2) + g * bare / inertia) / (1 - g * per[1] / inertia)
        rates = [known[i] + normal * per[i] for i in range(3)]
        demand = one
        if rolling:
            # the rates of w from those of the momenta, and so the horizontal force
            hh_rate = 2 * (g * height - more * (s * c)) * w2
            zz_rate = -2 * (g * g1 - more * (s * c)) * w2
            hz_rate = -(g1 * height - g * g - more * (c * c - s * s)) * w2
            left_h = rates[0] - hh_rate * w_h - hz_rate * w_z
            left_z = rates[2] - hz_rate * w_h - zz_rate * w_z
            w_h_rate, w_z_rate = (zz * left_h - hz * left_z) / det, (hh * left_z - hz * left_h) / det
            if kind == "held rim":
                push = -(w_h_rate * det / zz)
                rates[0] = rates[0] + push
                w_h_rate, w_z_rate = zero, w_z_rate - hz * push / det
            elif kind == "held drill":
                push = -(w_z_rate * det / hh)
                rates[2] = rates[2] + push
                w_h_rate, w_z_rate = w_h_rate - hz * push / det, zero
            w2_rate = (rates[1] - inertia_rate * w2) / inertia
            v_h_rate = height * w2_rate + g * (w2 * w2)
            v_2_rate = -(g * w_z_rate) - height * w_h_rate + g1 * w2 * w_z - g * w2 * w_h
            force = [v_h_rate - precession * v[1], v_2_rate + precession * v[0]]
            demand = self.mu * self.mu * (normal * normal) - force[0] * force[0] - force[1] * force[1]
        else:
            force = [normal * aim[0], normal * aim[1]]
            heat = -(force[0] * u[0] + force[1] * u[1])
            rates += [force[0] + precession * v[1], force[1] - precession * v[0]]
        lost = -dot(add(fixed, [normal * x for x in per_normal]), w)
        sin_phi, cos_phi = tape.sin_cos(phi)
        path = [moved[0] * cos_phi - moved[1] * sin_phi, moved[0] * sin_phi + moved[1] * cos_phi]
        rates = [one, lost, heat, -w2, precession, psi, *path, *rates]
        decide = {"demand": demand, "hold": self.hold(kind, push, normal, s), "push": push}
        decide |= {"normal": normal, "psi": psi, "drill": w_z, "up": c, "lean": s}
        return self.finished(tape, rates, size, **decide)

    def turn(self, y, kind):
        """The state of slip as that of rolling."""
        if kind != "roll" or len(y) == 11:
            return y
        w = self.w_of(y[3], y[8:11], about_contact=False)
        return [*y[:8], *self.momentum(y[3], w, about_contact=True)]

    def read(self, y, lean=None):
        _, work, heat, theta, phi, psi, a, b, *rest = y
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        w = self.w_of(theta, rest[:3], about_contact=len(rest) == 3)
        u = add([*rest[3:], mpfr(0)], cross(w, self.lever(s, c))) if len(rest) > 3 else [mpfr(0), mpfr(0)]
        state = [theta, c * w[0] + s * w[2], w[1], c * w[2] - s * w[0]]
        return [*state, *u[:2], work, heat, phi, psi, a, b]
