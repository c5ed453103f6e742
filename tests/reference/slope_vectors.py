"""Bodies on a tilted or turning table in three dimensions, one of the two formulations of slope.py.

Everything is told in the axes of the table: z its normal, x downhill, y across. Gravity is (sin b, 0, -cos b).
A contact point at P, with r from the centre of mass to it, slips over the table with u = v + w x r - om z x P,

    u' = F + gravity + w' x r + w x r' - om z x (v + r'),        I w' + w x (I w) = r x F + couples

and so u' is linear in the force F: rolling is u' = 0, slip F = N (z - mu u/|u|) or N (z - c u) with u_z' = 0.
The same for a rim, for both rims at once, and for an ellipsoid; flight and impact are those of
flight_vectors.py, with this gravity.
"""

import flight_vectors
import gmpy2
import lying_vectors
import stone_forms
from flight_forms import Air
from gmpy2 import mpfr
from losses_forms import LAWS, couple
from lying_forms import ONE, ZERO, solved
from series import Tape
from stone_forms import along, rotation, turned_back
from torus import Z
from vectors import add, cross, dot, scaled, solver

UNITS = [[mpfr(i == j) for i in range(3)] for j in range(3)]


def weight(scene):
    """Gravity."""
    slope = mpfr(scene.slope)
    return [gmpy2.sin(slope), mpfr(0), -gmpy2.cos(slope)]


def pressed(kind, aim, known, turned, r, couples):
    """The force, u' and the change of w, for u' and w' as they are without a force and what a couple changes."""
    rate, swing = known

    def answer(force):
        change = turned(add(cross(r, force), [force[2] * x for x in couples]))
        return change, add(force, cross(change, r))

    if kind == "roll":
        force = solver([answer(unit)[1] for unit in UNITS])(scaled(-1, rate))
    else:
        normal = -(rate[2] / answer(aim)[1][2])
        force = [normal * x for x in aim]
    change, more = answer(force)
    return force, add(rate, more), add(swing, change)


class Vectors(flight_vectors.Vectors):
    """A body with a rim, on the table and above it."""

    def __init__(self, scene):
        self.gravity_vector, self.om = weight(scene), mpfr(scene.turning)
        self.losses = {name: mpfr(scene.losses.get(name, 0.0)) for name in LAWS}
        super().__init__(scene)

    def start(self):
        """At its place and heading; the table moves below it."""
        theta, w1, w2, w3, *slip = (mpfr(x) for x in self.scene.start)
        phi, (x, y) = mpfr(self.scene.phi), map(mpfr, self.scene.place)
        begun = self.begin(theta, w1, w2, w3, *slip)
        begun[3:6] = add(begun[3:6], [ZERO, ZERO, mpfr(self.scene.lift)])
        turned = headed(begun, phi)
        turned[:3] = add(turned[:3], [x, y, mpfr(self.scene.height)])
        turned[3:6] = add(turned[3:6], [-self.om * y, self.om * x, ZERO])
        y = [*headed([*slip, ZERO], phi)[:2], ZERO, ZERO, *turned, *self.spent()]
        return Air(y) if self.scene.aloft else y

    def spent(self):
        return [ZERO] if any(self.losses.values()) else []

    def free(self):
        """The flight, with the heights of the rims."""
        tape = Tape()
        tape.state()
        _, v, e3, material, w = ([tape.state() for _ in range(3)] for _ in range(5))
        swing = self.turned(scaled(-1, cross(w, self.spin_of(w, e3))), e3)
        fall = [tape.constant(x) for x in self.gravity_vector]
        tape.rates = [tape.constant(1), *v, *fall, *cross(w, e3), *cross(w, material), *swing]
        middle, up = tape.states[3] - self.fillet, self.ell * e3[2]
        if self.rim:
            middle = middle - self.rim * tape.sqrt(e3[0] * e3[0] + e3[1] * e3[1])
        tape.heights = [middle - up, middle + up][: 1 + self.scene.side]
        return tape

    def in_space(self, vectors, lean=None):
        """The velocity of the lowest point is that over the table."""
        *first, contact, (u, h, e2), vanishing = super().in_space(vectors, lean)
        over = [u[0] + self.om * contact[1], u[1] - self.om * contact[0], u[2]]
        return [*first, contact, (over, h, e2), vanishing]

    def spin_of(self, w, e3):
        """The angular momentum."""
        spin = dot(w, e3)
        return [self.i1 * w[i] + (self.i3 - self.i1) * (spin * e3[i]) for i in range(3)]

    def equations(self, kind):
        tape = self.tape()
        slip = self.slip_states(tape, kind)
        tape.state(), tape.state()
        _, v, e3, material, w = ([tape.state() for _ in range(3)] for _ in range(5))
        axis, zero, s = cross(w, e3), tape.constant(0), None
        r, moving = scaled(-self.ell, e3), scaled(-self.ell, axis)
        fixed, couples = [zero] * 3, [zero] * 3
        if self.rim or self.spent():
            s = tape.sqrt(e3[0] * e3[0] + e3[1] * e3[1])
            h = [-(e3[0] / s), -(e3[1] / s), zero]
            s_rate = -(h[0] * axis[0] + h[1] * axis[1])
            h_rate = [-((axis[i] + s_rate * h[i]) / s) for i in (0, 1)]
            e1 = [e3[2] * h[0], e3[2] * h[1], s]
            e1_rate = [*(axis[2] * h[i] + e3[2] * h_rate[i] for i in (0, 1)), s_rate]
            r, moving = add(r, scaled(-self.rim, e1)), add(moving, scaled(-self.rim, e1_rate))
            if self.spent():
                _, fixed, couples = couple(tape, self.losses, (1, 1), w, h, s, self.fillet * s + self.rim)
        r = [r[0], r[1], r[2] - self.fillet]
        swing = self.turned(add(fixed, scaled(-1, cross(w, self.spin_of(w, e3)))), e3)
        carried = add(v, moving)
        table = [self.om * carried[1], -self.om * carried[0], zero]
        rate = add(self.gravity_vector, cross(swing, r), cross(w, moving), table)
        aim = None if kind == "roll" else self.aim(kind, slip)
        force, slip_rates, acceleration = pressed(
            kind, aim, (rate, swing), lambda torque: self.turned(torque, e3), r, couples
        )
        rates = [*v, *add(force, self.gravity_vector), *axis, *cross(w, material), *acceleration]
        if self.spent():
            tape.state()
            rates.append(-dot(add(fixed, [force[2] * x for x in couples]), w))
        return self.finished(tape, kind, slip, slip_rates[:2], rates, force, up=e3[2], watch_face=s)

    def gravity(self, y):
        return super().gravity(y[:19])

    def read(self, y, lean=None):
        row = super().read(y, lean)
        if self.spent():
            row[9] += y[19]
        return row

    def strayed(self, y, lean=None):
        if isinstance(y, Air):
            return super().strayed(y, lean)
        *_, (u, _, _), vanishing = self.in_space(y[4:], lean)
        return max(abs(x) for x in (*(u[i] - y[i] for i in (0, 1)), *vanishing))


def headed(vectors, phi):
    """Vectors, one after the other, turned about the normal."""
    c, s = gmpy2.cos(phi), gmpy2.sin(phi)
    turned = []
    for x, y, z in zip(*(iter(vectors),) * 3, strict=True):
        turned += [c * x - s * y, s * x + c * y, z]
    return turned


class Lying(lying_vectors.Vectors, Vectors):
    """A body on both rims, or on one."""

    def start(self):
        theta, *rest = self.beginning()
        phi, (x, y) = mpfr(self.scene.phi), map(mpfr, self.scene.place)
        turned = headed(self.begin(theta, *rest), phi)
        turned[:3] = add(turned[:3], [x, y, ZERO])
        return [*headed([*rest[3:], ZERO], phi)[:2], ZERO, ZERO, *turned]

    def lying(self, kind, signs):
        tape = self.tape()
        slips = self.slips(tape, kind)
        for _ in range(3):
            tape.state()
        _, v, e3, material, w = ([tape.state() for _ in range(3)] for _ in range(5))
        axis, zero = cross(w, e3), tape.constant(0)
        level, across = [e3[0], e3[1], e3[2] - self.border.c], cross(e3, Z)
        tips = [(place.p, place.q) for place in self.places]
        arms = [add(scaled(-p, e3), scaled(-q, Z)) for p, q in tips]
        momentum = [self.i1 * w[i] + (self.i3 - self.i1) * (dot(w, e3) * e3[i]) for i in range(3)]
        swing = self.turned(scaled(-1, cross(w, momentum)), e3)
        known = [
            add(self.gravity_vector, cross(swing, arm), cross(w, scaled(-p, axis)))
            for arm, (p, _) in zip(arms, tips, strict=True)
        ]
        units = []
        for rim in (0, 1):
            if kind == "SS":
                units += [(rim, way) for way in (UNITS if rim == 0 else [Z, across, level])]
            elif kind[rim : rim + 1] == "S" and not self.scene.smooth:
                units = [(rim, UNITS[0]), (rim, UNITS[1]), *units, (rim, Z)]
            else:
                units.append((rim, [*self.push(slips[rim]), ONE]))
        effects = [(force, self.turned(cross(arms[rim], force), e3)) for rim, force in units]
        columns = [[add(dv, cross(dw, arm)) for arm in arms] for dv, dw in effects]
        rows, given = [], []
        for rim in (0, 1):
            if (kind == "SS" and rim == 0) or (kind in ("SL", "LS") and kind[rim] == "S"):
                for i in (0, 1):
                    rows.append([c[rim][i] for c in columns])
                    given.append(-known[rim][i])
        for rim in (0, 1):
            rows.append([c[rim][2] for c in columns])
            given.append(-known[rim][2])
        if kind == "SS":  # the other one does not slip across; of the force along the axis either has half
            rows.append([c[1][0] * across[0] + c[1][1] * across[1] for c in columns])
            given.append(-(known[1][0] * across[0] + known[1][1] * across[1]))
            rows.append([dot(force, level) * (1 if rim == 0 else -1) for rim, force in units])
            given.append(ZERO)
        amounts = solved(rows, given)
        forces, dv, dw = [[zero] * 3, [zero] * 3], self.gravity_vector, swing
        for (rim, force), (_, turn), amount in zip(units, effects, amounts, strict=True):
            push = [amount * x for x in force]
            forces[rim], dv = add(forces[rim], push), add(dv, push)
            dw = add(dw, [amount * x for x in turn])
        slip_rates = []
        for rim in (0, 1):
            answers = [[amount * x for x in c[rim]] for amount, c in zip(amounts, columns, strict=True)]
            slip_rates.append(add(known[rim], *answers)[:2])
        rates = [*v, *dv, *axis, *cross(w, material), *dw]
        over = dot(w, level) / self.border.s
        return self.rates_of(tape, kind, slips, slip_rates, forces, zero, [None, None], w[2], over, rates)


class Stone(stone_forms.Table):
    """An ellipsoid: p from its centre to its lowest point follows from the rates of what defines it."""

    def __init__(self, scene):
        super().__init__(scene)
        self.gravity_vector = weight(scene)

    def equations(self, kind):
        tape = self.tape()
        slip = ux, uy, *_ = self.slip_states(tape, kind)
        tape.state(), tape.state()
        place, velocity = ([tape.state() for _ in range(3)] for _ in range(2))
        q = [tape.state() for _ in range(4)]
        momentum, p = ([tape.state() for _ in range(3)] for _ in range(2))
        matrix = rotation(q)
        spread = [along(self.free, row) for row in matrix]
        free = [[dot(spread[i], matrix[j]) for j in range(3)] for i in range(3)]
        w = along(free, momentum)
        centre = along(matrix, self.d)
        r = add(p, scaled(-1, centre))
        stretched = [[a * x for a, x in zip(self.a2, row, strict=True)] for row in matrix]
        h = [w[1], -w[0]]
        ph = p[0] * h[0] + p[1] * h[1]
        lag = [
            (dot(stretched[i], matrix[0]) * h[0] + dot(stretched[i], matrix[1]) * h[1] - ph * p[i]) / p[2]
            for i in range(2)
        ]
        moving = cross(w, p)
        p_rate = [moving[0] - lag[0], moving[1] - lag[1], moving[2]]
        r_rate = add(p_rate, scaled(-1, cross(w, centre)))
        zero = tape.constant(0)
        swing = along(free, scaled(-1, cross(w, momentum)))
        rate = add(self.gravity_vector, cross(swing, r), cross(w, r_rate))
        aim = None if kind == "roll" else self.aim(kind, slip)
        force, slip_rates, _ = pressed(
            kind, aim, (rate, swing), lambda torque: along(free, torque), r, [zero] * 3
        )
        turning = [-dot(w, q[1:]), *add([q[0] * x for x in w], cross(w, q[1:]))]
        rates = [*velocity, *add(force, self.gravity_vector), *scaled(mpfr(0.5), turning)]
        rates += [*cross(r, force), *p_rate]
        seen = {"n": matrix[2]}
        if self.watching:
            body = turned_back(matrix, p)
            surface = [x / a for a, x in zip(self.a2, body, strict=True)]
            u = add(velocity, cross(w, r))
            seen |= {"w": turned_back(matrix, w), "q": q, "contact": add(place, r)[:2]}
            seen["energy"] = [
                (dot(velocity, velocity) + dot(w, momentum)) / 2 - dot(self.gravity_vector, place)
            ]
            length = sum((x * x for x in q[1:]), q[0] * q[0])
            tangent = cross(along(matrix, surface), UNITS[2])[:2]
            seen["vanishing"] = [dot(surface, body) - 1, *tangent, u[0] - ux, u[1] - uy, u[2]]
            seen["vanishing"] += [place[2] + r[2], length - 1]
        return self.named(tape, kind, slip, slip_rates[:2], rates, force, seen)
