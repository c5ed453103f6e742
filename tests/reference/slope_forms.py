"""Bodies on a tilted or turning table by reduced equations, one of the two formulations of slope.py.

phi is the angle of the lean h from downhill, and one of the numbers that are integrated: gravity pulls with
G_h = sin b cos phi and G_2 = -sin b sin phi along the lean and across, and presses with cos b. On a table that
turns at om the contact point P moves with p_h = u_h + rho w2 + U_h, p_2 = u_2 + A psi' + U_2, U = om z x P.

A flight is that on a level table in the time sqrt(cos b) t, and a fall downhill. A stone is told in its own axes,
where n is the vertical of the table and d points downhill.
"""

import flight_closed
import gmpy2
import lying_reduced
import stone_forms
from flight_closed import Flight
from flight_forms import Air
from gmpy2 import mpfr
from losses_forms import LAWS, couple
from lying_forms import ZERO
from stone_forms import along, inverse, rotation, turned_back
from vectors import add, cross, dot, scaled


class Reduced(flight_closed.Closed):
    """A body with a rim, on the table and above it."""

    def __init__(self, scene):
        super().__init__(scene)
        slope = mpfr(scene.slope)
        self.downhill, self.level = gmpy2.sin(slope), gmpy2.cos(slope)
        self.om = mpfr(scene.turning)
        self.losses = {name: mpfr(scene.losses.get(name, 0.0)) for name in LAWS}
        self.loses = any(self.losses.values())

    def start(self):
        y = super().start()
        y[8], y[10:12] = mpfr(self.scene.phi), map(mpfr, self.scene.place)
        if self.loses:
            y.append(ZERO)
        return y

    def pulled(self, tape, phi):
        """Sine and cosine of phi, and the pull along the lean and across."""
        sine, cosine = tape.sin_cos(phi)
        return sine, cosine, self.downhill * cosine, -(self.downhill * sine)

    def equations(self, kind):
        tape = self.tape()
        slip = u_h, u_2, *_ = self.slip_states(tape, kind)
        tape.state(), tape.state()
        theta, w1, w2, w3, phi, _, x, y = (tape.state() for _ in range(8))
        s, c = tape.sin_cos(theta)
        sine, cosine, pull_h, pull_2 = self.pulled(tape, phi)
        ell, i1, i3, rho, a, om = self.ell, self.i1, self.i3, self.fillet, self.rim, self.om
        radius, depth = rho * s + a, rho * c + ell
        g0, g1 = ell * s - a * c, ell * c + a * s
        height = g1 + rho
        precession = w1 / s
        ct_w1, square = c * precession, w2 * w2
        gyro = w1 * (i3 * w3 - i1 * ct_w1)
        spun = w2 * (i1 * ct_w1 - i3 * w3)
        inertia = i1 + g0 * g0
        # the couples of the losses along e1, e2, e3
        zero = tape.constant(0)
        own, per = [zero] * 3, [zero] * 3
        if self.loses:
            w = [c * w1 - s * w3, w2, s * w1 + c * w3]
            _, *both = couple(tape, self.losses, (1, 1), w, [tape.constant(1), zero, zero], s, radius)
            own, per = ([c * m[0] + s * m[2], m[1], c * m[2] - s * m[0]] for m in both)
        psi_rate = w3 - ct_w1
        out, aside = u_h + rho * w2, u_2 + radius * psi_rate
        relative_h, relative_2 = u_h + height * w2, u_2 - depth * w1 + radius * w3
        if om:
            table_h, table_2 = om * (x * sine - y * cosine), om * (x * cosine + y * sine)
            out, aside = out + table_h, aside + table_2
            pull_h, pull_2 = pull_h + om * aside, pull_2 - om * out
        if kind == "roll":
            whole = inertia + height * height
            bare = gyro + height * (precession * relative_2) - self.level * g0 - rho * (g0 * square)
            bare = (bare + height * pull_h + own[1]) / whole
            normal = (self.level + g0 * bare - g1 * square) / (1 - g0 * per[1] / whole)
            w2_rate = bare + normal * per[1] / whole
            force_h = height * w2_rate + g0 * square - precession * relative_2 - pull_h
            torque = [own[i] + normal * per[i] for i in range(3)]
            left = precession * relative_h - rho * (w2 * (s * w1 + c * w3)) - pull_2
            left = left - depth * (spun + torque[0]) / i1 + radius * torque[2] / i3
            force_2 = left / (1 + depth * depth / i1 + radius * radius / i3)
            slip_rates = None
        else:
            aim = self.aim(kind, slip)
            normal = i1 * (self.level - g1 * square) + g0 * (gyro + own[1])
            normal = normal / (inertia + g0 * height * aim[0] - g0 * per[1])
            force_h, force_2 = normal * aim[0], normal * aim[1]
            torque = [own[i] + normal * per[i] for i in range(3)]
            w2_rate = (gyro - g0 * normal - height * force_h + torque[1]) / i1
        w1_rate = (spun + depth * force_2 + torque[0]) / i1
        w3_rate = (torque[2] - radius * force_2) / i3
        if kind != "roll":
            slip_rates = [
                force_h + pull_h + precession * relative_2 - g0 * square - height * w2_rate,
                force_2
                + pull_2
                - precession * relative_h
                + depth * w1_rate
                - radius * w3_rate
                + rho * (w2 * (s * w1 + c * w3)),
            ]
        path = [out * cosine - aside * sine, out * sine + aside * cosine]
        rates = [-w2, w1_rate, w2_rate, w3_rate, precession, psi_rate, *path]
        if self.loses:
            tape.state()
            rates.append(-(torque[0] * w1 + torque[1] * w2 + torque[2] * w3))
        force = [force_h, force_2, normal]
        return self.finished(tape, kind, slip, slip_rates, rates, force, up=c, watch_face=theta)

    def read(self, y, lean=None):
        row = super().read(y, lean)
        if self.loses:
            row[9] += row.pop()
        return row

    def gravity(self, y):
        return super().gravity(y) - 1 + self.level

    def below(self, pose):
        """The velocity of the table below the lowest point, along the lean and across."""
        phi, _, x, y = pose
        s, c = gmpy2.sin(phi), gmpy2.cos(phi)
        return self.om * (x * s - y * c), self.om * (x * c + y * s)

    def other(self, y):
        over = super().other(y)
        over[1] -= self.om * 2 * self.ell * gmpy2.sin(y[4])
        return over

    def fly(self, y, order, samples, out):
        slow = gmpy2.sqrt(self.level)
        u_h, u_2, heat, begun, theta, w1, w2, w3, *pose = y
        lift, above = (y.lift, y.height) if isinstance(y, Air) else (ZERO, ZERO)
        table_h, table_2 = self.below(pose)
        u_h, u_2 = u_h + table_h, u_2 + table_2
        numbers = [u_h / slow, u_2 / slow, heat, ZERO, theta, w1 / slow, w2 / slow, w3 / slow, *pose]
        air = Flight(self, Air(numbers, lift / slow, above))

        def at(t):
            there = air.at(slow * t)
            u_h, u_2, heat, _, theta, w1, w2, w3, phi, psi, x, y = there
            fast = [slow * w for w in (u_h, u_2, w1, w2, w3)]
            fast[0] += self.downhill * t * gmpy2.cos(phi)
            fast[1] -= self.downhill * t * gmpy2.sin(phi)
            pose = [phi, psi, x + self.downhill * t * t / 2, y]
            table_h, table_2 = self.below(pose)
            slip = [fast[0] - table_h, fast[1] - table_2]
            numbers = [*slip, heat, begun + t, theta, *fast[2:], *pose]
            return Air(numbers, slow * there.lift, there.height)

        found = [(air.lands(1, order) / slow, 0)]
        if self.scene.side:
            found.append((air.lands(-1, 0) / slow, 1))
        after, rim = min(found)
        while samples and samples[0] <= begun + after:
            when = samples.pop(0)
            out.add("sample" if samples else "end", when, at(when - begun))
        if not samples:
            return None, None
        return (self.other(at(after)) if rim else at(after)), rim


class Lying(lying_reduced.Reduced, Reduced):
    """A body on both of its equal rims, or on one."""

    def start(self):
        y = super().start()
        y[8], y[10:12] = mpfr(self.scene.phi), map(mpfr, self.scene.place)
        return y

    def lying(self, kind, signs):
        tape = self.tape()
        slips = self.slips(tape, kind)
        for _ in range(3):
            tape.state()
        w1, w3, phi, _, _, _ = (tape.state() for _ in range(6))
        sine, cosine, pull_h, pull_2 = self.pulled(tape, phi)
        i1, i3, zero = self.i1, self.i3, tape.constant(0)
        depth, low = [place.depth for place in self.places], self.level
        apart = depth[0] - depth[1]
        gyro = i3 * (w1 * w3)
        slides = kind[:1] in ("L", "o") and kind != "LS"

        def loads(moment):
            """Normal forces whose sum and moment are known."""
            return [(moment - depth[1] * low) / apart, (depth[0] * low - moment) / apart]

        if kind == "SS":
            v_h, v_2 = zero, w3 + 0
            normals, across = loads(pull_h), -(i3 / (1 + i3)) * pull_2
            shares = [-depth[1] / apart, depth[0] / apart]
            forces = [[-(pull_h / 2), k * across, n] for k, n in zip(shares, normals, strict=True)]
            rates, w1_rate, w3_rate = [[zero, zero], [zero, zero]], zero, pull_2 / (1 + i3)
        elif slides:
            u = slips[0][0]
            v_h, v_2 = u[0] + 0, u[1] - depth[0] * w1 + w3
            pushes = [self.push(slip) for slip in slips]
            a, b = (d + push[0] for d, push in zip(depth, pushes, strict=True))
            normals = [(gyro - b * low) / (a - b), (a * low - gyro) / (a - b)]
            forces = [[n * p[0], n * p[1], n] for n, p in zip(normals, pushes, strict=True)]
        else:
            stuck = kind.index("S")
            moves = 1 - stuck
            v_h, v_2 = zero, w3 - depth[stuck] * w1
            along = -pull_h - w1 * v_2
            normals = loads(gyro - along)
            sense = mpfr(signs[2]) * gmpy2.sign(depth[stuck] - depth[moves])
            drags = (self.mu * sense) * normals[moves]
            own = 1 + depth[stuck] ** 2 / i1 + 1 / i3
            more = 1 + depth[stuck] * depth[moves] / i1 + 1 / i3
            forces = [None, None]
            forces[stuck] = [along, -((more * drags + pull_2) / own), normals[stuck]]
            forces[moves] = [zero, drags, normals[moves]]
        if kind != "SS":
            w1_rate = (depth[0] * forces[0][1] + depth[1] * forces[1][1]) / i1
            w3_rate = -((forces[0][1] + forces[1][1]) / i3)
            along = forces[0][0] + forces[1][0] + pull_h + w1 * v_2
            across = forces[0][1] + forces[1][1] + pull_2 - w1 * v_h
            rates = [[along if slides else zero, across + d * w1_rate - w3_rate] for d in depth]
        out, aside = v_h, v_2 + depth[0] * w1
        path = [out * cosine - aside * sine, out * sine + aside * cosine]
        moved = [w1_rate, w3_rate, w1 + 0, w3 + 0, *path]
        return self.rates_of(tape, kind, slips, rates, forces, zero, [None, None], w1, w3, moved)


class Stone(stone_forms.Body):
    """An ellipsoid in its own axes: gravity is d sin b - n cos b."""

    def __init__(self, scene):
        super().__init__(scene)
        slope = mpfr(scene.slope)
        self.downhill, self.level = gmpy2.sin(slope), gmpy2.cos(slope)

    def equations(self, kind):
        tape = self.tape()
        slip = ux, uy, *_ = self.slip_states(tape, kind)
        tape.state(), tape.state()
        n, w = ([tape.state() for _ in range(3)] for _ in range(2))
        q = [tape.state() for _ in range(4)]
        tape.state(), tape.state()
        zero = tape.constant(0)
        matrix = rotation(q)
        against = add(scaled(self.level, n), scaled(-self.downhill, matrix[0]))
        n_rate = cross(n, w)
        dn, dn_rate = ([a * x for a, x in zip(self.a2, v, strict=True)] for v in (n, n_rate))
        size = tape.sqrt(dot(n, dn))
        growth = dot(n, dn_rate) / size
        at = [x / size for x in dn]
        r = [-x - d for x, d in zip(at, self.d, strict=True)]
        r_rate = [(growth * a - x) / size for a, x in zip(at, dn_rate, strict=True)]
        torque = scaled(-1, cross(w, along(self.inertia, w)))
        spun = cross(w, r)
        if kind == "roll":
            u = [zero] * 3
            carried = add(cross(w, r_rate), cross(w, spun))
            rr = dot(r, r)
            about = [
                [self.inertia[i][j] - r[i] * r[j] + (rr if i == j else 0) for j in range(3)] for i in range(3)
            ]
            w_rate = along(inverse(about), add(torque, scaled(-1, cross(r, carried)), cross(r, against)))
            force = along(matrix, add(cross(r, w_rate), scaled(-1, carried), against))
            slip_rates = [zero, zero]
        else:
            u = turned_back(matrix, [ux, uy, zero])
            f = turned_back(matrix, self.aim(kind, slip))
            v = add(u, scaled(-1, spun))
            bare, more = along(self.free, torque), along(self.free, cross(r, f))
            above = self.level + dot(cross(w, v), n) - dot(cross(bare, r), n) - dot(cross(w, r_rate), n)
            normal = (above - dot(u, n_rate)) / (1 + dot(cross(more, r), n))
            force = [normal * x for x in self.aim(kind, slip)]
            w_rate = add(bare, [normal * x for x in more])
            v_rate = add([normal * x for x in f], scaled(-1, against), cross(v, w))
            u_rate = add(v_rate, cross(w_rate, r), cross(w, r_rate), cross(w, u))
            slip_rates = along(matrix, u_rate)[:2]
        turning = [-dot(w, q[1:]), *add([q[0] * x for x in w], cross(q[1:], w))]
        path = along(matrix, r_rate)
        rates = [*n_rate, *w_rate, *scaled(mpfr(0.5), turning), path[0] + ux, path[1] + uy]
        v = add(u, scaled(-1, spun))
        contact = tape.states[14:16]
        seen = {"n": n, "w": w, "q": q, "contact": contact}
        seen["energy"] = [
            (dot(v, v) + dot(w, along(self.inertia, w))) / 2
            - self.level * dot(r, n)
            - self.downhill * (contact[0] - dot(matrix[0], r))
        ]
        seen["vanishing"] = [a - b for a, b in zip(matrix[2], n, strict=True)]
        return self.named(tape, kind, slip, slip_rates, rates, force, seen)
