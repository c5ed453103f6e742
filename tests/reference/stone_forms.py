"""Two formulations of an ellipsoid of any inertia that rolls and slips, for stones.py.

They share the series of series.py, and of slip_forms.py the law of friction and how slip and its rates are written. Mass 1,
semi-axes a, the centre of mass at d from the ellipsoid's centre, inertia I about the centre of mass. n is the vertical
in the axes of the body, w the angular velocity there.

    table   in the laboratory: quaternion, centre of mass X and its velocity V, angular momentum L, and p from the
            ellipsoid's centre to its lowest point. With A = R D R^T, D = diag(a^2), the quadric is p.A^-1 p = 1 and its
            gradient is vertical; p follows from the rates of both conditions,
                p' = w x p - (A h - (p.h) p)/p_z,   h = w x z
            so that its closed form is needed at the start only. With r = p - R d and J the inertia in the laboratory,
            the rate of the slip u = V + w x r is linear in the force, the multiplier of the contact:
                u' = W F + k,   W = 1 - [r] J^-1 [r],   k = -(J^-1 (w x L)) x r + w x r' - g z
            rolling u' = 0; slip F = N (z - mu u/|u|) or N (z - c u) with u_z' = 0; then V' = F - g z, L' = r x F
    body    in the axes of the body, w and n, with r = -D n/S - d, S^2 = n.D n, and the acceleration from the
            angular momentum about the contact (rolling) or from the normal force in closed form (slip)

Losses are a couple m0 + N mN, and the energy that they take is the last number of a state:

    air   -b w      air2  -b2 |w| w      rolling  -delta N w_h/|w_h|, w_h horizontal      drilling  -l N sgn(w.z) z

The sign of w.z is that of the start; where it is held at 0 the couple has one more part along z, found with the rates.

n of a start is divided by its length. The body begins with the smallest rotation that turns n to the vertical z, the
quaternion (1 + n3, n2, -n1, 0) over its length, and for n = -e3 half a turn about the first axis, (0, 1, 0, 0).
Quaternions are (scalar, x, y, z) and turn body into laboratory. The centre of mass begins above the origin.
"""

import gmpy2
from gmpy2 import mpfr
from slip_forms import Formulation
from vectors import add, cross, dot, scaled


def along(matrix, v):
    return [dot(row, v) for row in matrix]


def turned_back(matrix, v):
    return along(list(zip(*matrix, strict=True)), v)


def inverse(m):
    """The inverse of a 3 x 3 matrix of numbers or series."""
    minors = [cross(m[(i + 1) % 3], m[(i + 2) % 3]) for i in range(3)]
    volume = dot(m[0], minors[0])
    return [[minors[j][i] / volume for j in range(3)] for i in range(3)]


def rotation(q):
    w, x, y, z = q
    xx, yy, zz, xy, xz, yz = x * x, y * y, z * z, x * y, x * z, y * z
    wx, wy, wz = w * x, w * y, w * z
    return [
        [1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy)],
        [2 * (xy + wz), 1 - 2 * (xx + zz), 2 * (yz - wx)],
        [2 * (xz - wy), 2 * (yz + wx), 1 - 2 * (xx + yy)],
    ]


def held(matrix, z):
    """The change of w by a couple, with one more couple along z that keeps w.z; and that couple."""
    gives = along(matrix, z)
    most = dot(gives, z)

    def turned(couple):
        kept = -(dot(gives, couple) / most)
        return add(along(matrix, couple), [kept * x for x in gives]), kept

    return turned


class Stone(Formulation):
    """What both have in common: a scene, its start, and how slip and force are written."""

    def __init__(self, scene):
        super().__init__(scene)
        self.other, self.watching = None, False
        self.a2 = [mpfr(x) ** 2 for x in scene.axes]
        self.inertia = [[mpfr(x) for x in row] for row in scene.inertia]
        self.free = inverse(self.inertia)
        self.d, self.g = [mpfr(x) for x in scene.offset], mpfr(scene.g)
        self.losses = {name: mpfr(x) for name, x in scene.losses.items()}
        self.edge = None if scene.theta_end is None else gmpy2.cos(mpfr(scene.theta_end))

    def begin(self, n, w):
        """The unit vector n, w and the quaternion."""
        n, w = [mpfr(x) for x in n], [mpfr(x) for x in w]
        n = scaled(1 / gmpy2.sqrt(dot(n, n)), n)
        q = [1 + n[2], n[1], -n[0], mpfr(0)] if n[2] != -1 else [mpfr(x) for x in (0, 1, 0, 0)]
        size = gmpy2.sqrt(sum(x * x for x in q))
        return n, w, [x / size for x in q]

    def lowest(self, n):
        """From the centre of mass to the lowest point, in the body: a start."""
        size = gmpy2.sqrt(dot(n, [a * x for a, x in zip(self.a2, n, strict=True)]))
        return [-(a * x / size) - d for a, x, d in zip(self.a2, n, self.d, strict=True)]

    def resisted(self, tape, w, z):
        """The couple of the losses without the normal force, and that per unit of it."""
        none = [tape.constant(0)] * 3
        without, pressed = [none, none], [none, none]
        drilling = dot(w, z)
        for name, size in self.losses.items():
            if name == "air":
                without.append(scaled(-size, w))
            elif name == "air2":
                speed = tape.sqrt(dot(w, w))
                without.append([-size * (speed * x) for x in w])
            elif name == "rolling":
                level = [a - drilling * b for a, b in zip(w, z, strict=True)]
                speed = tape.sqrt(dot(level, level))
                pressed.append([-size * (x / speed) for x in level])
            elif name == "drilling" and not self.scene.held:
                pressed.append([-size * self.scene.sign * x for x in z])
        return add(*without), add(*pressed)

    def spin(self, matrix, z):
        """The change of w by a couple and the couple that holds w.z, from the inverse of an inertia."""
        if self.scene.held:
            return held(matrix, z)
        return lambda couple: (along(matrix, couple), mpfr(0))

    def started(self, y):
        """A start, with room for the energy that is lost."""
        return [*y, mpfr(0)] if self.losses else y

    def named(self, tape, kind, slip, slip_rates, rates, force, seen):
        """The phase: `seen` has n, w, q, contact, energy and what should vanish."""
        watch = seen["n"][2] - self.edge if self.edge is not None else None
        return self.finished(tape, kind, slip, slip_rates, rates, force, watch_face=watch, seen=seen)

    def events(self, phase, kind):
        """What may end a phase."""
        slips = kind == "roll" and self.scene.law != "rolling"
        yield ("slips" if slips else "lift-off"), phase.demand if kind == "roll" else phase.normal
        if phase.watch_face is not None:
            yield "face", phase.watch_face

    def probe(self, y):
        """The quantities at a state, by tapes of their own."""
        if self.other is None:
            self.other = type(self)(self.scene)
            self.other.watching = True
        smooth = self.scene.law in ("viscous", "smooth")
        kind = "steep" if smooth else "roll" if y[0] == 0 and y[1] == 0 else "slip"
        phase = self.other.at(kind, y)
        return phase, {name: [x.c[0] for x in nodes] for name, nodes in phase.seen.items()}

    def read(self, y, lean=None):
        phase, seen = self.probe(y)
        force = [x.c[0] for x in phase.force]
        if phase.demand.c[0] < mpfr("-1e-25") and y[0] == 0 and self.scene.law == "coulomb":
            force = [mpfr("nan")] * 3
        lost = [y[-1]] if self.losses else []
        return [*seen["n"], *seen["w"], *y[:3], *seen["q"], *seen["contact"], *force, *lost]

    def strayed(self, y, lean=None):
        _, seen = self.probe(y)
        energy = seen["energy"][0] + y[2] + (y[-1] if self.losses else 0)
        self.first = getattr(self, "first", energy)
        return max(abs(x) for x in [*seen["vanishing"], (energy - self.first) / max(1, abs(energy))])


class Table(Stone):
    """Newton's and Euler's equations in the laboratory, with multipliers."""

    order, tolerance, cut, last = 32, mpfr("1e-32"), 0.9, 38

    def start(self, n=None, w=None):
        n, w, q = self.begin(n or self.scene.n, w or self.scene.w)
        ux, uy = (mpfr(x) for x in self.scene.u)
        matrix, zero = rotation(q), mpfr(0)
        r = along(matrix, self.lowest(n))
        v = add([ux, uy, zero], cross(r, along(matrix, w)))
        momentum = along(matrix, along(self.inertia, w))
        p = add(r, along(matrix, self.d))
        return self.started([ux, uy, zero, zero, zero, zero, -r[2], *v, *q, *momentum, *p])

    def equations(self, kind):
        tape = self.tape()
        slip = ux, uy, *_ = self.slip_states(tape, kind)
        tape.state(), tape.state()
        place, velocity = ([tape.state() for _ in range(3)] for _ in range(2))
        q = [tape.state() for _ in range(4)]
        momentum, p = ([tape.state() for _ in range(3)] for _ in range(2))
        matrix = rotation(q)
        spread = [along(self.free, row) for row in matrix]
        half = {(i, j): dot(spread[i], matrix[j]) for i in range(3) for j in range(i, 3)}
        free = [[half[min(i, j), max(i, j)] for j in range(3)] for i in range(3)]
        w = along(free, momentum)
        centre = along(matrix, self.d)
        r = add(p, scaled(-1, centre))

        stretched = [[a * x for a, x in zip(self.a2, row, strict=True)] for row in matrix]
        shape = [[dot(stretched[i], matrix[j]) for j in range(2)] for i in range(2)]
        h = [w[1], -w[0]]
        ph = p[0] * h[0] + p[1] * h[1]
        lag = [(shape[i][0] * h[0] + shape[i][1] * h[1] - ph * p[i]) / p[2] for i in range(2)]
        moving = cross(w, p)
        p_rate = [moving[0] - lag[0], moving[1] - lag[1], moving[2]]
        r_rate = add(p_rate, scaled(-1, cross(w, centre)))

        zero = tape.constant(0)
        units = [[mpfr(i == j) for i in range(3)] for j in range(3)]
        without, pressed = self.resisted(tape, w, units[2])
        turned = self.spin(free, units[2])
        bare = add(without, scaled(-1, cross(w, momentum)))
        known = add(cross(turned(bare)[0], r), cross(w, r_rate))
        known[2] = known[2] - self.g

        def response(force):
            return add(force, cross(turned(add(cross(r, force), [force[2] * x for x in pressed]))[0], r))

        if kind == "roll":
            force = scaled(-1, along(inverse(list(zip(*map(response, units), strict=True))), known))
            slip_rates = [zero, zero]
        else:
            aim = self.aim(kind, slip)
            answer = response(aim)
            normal = -(known[2] / answer[2])
            force = [normal * x for x in aim]
            slip_rates = [known[i] + normal * answer[i] for i in (0, 1)]
        turning = [
            -(w[0] * q[1] + w[1] * q[2] + w[2] * q[3]),
            *add([q[0] * x for x in w], cross(w, q[1:])),
        ]
        rates = [*velocity, force[0], force[1], force[2] - self.g, *scaled(mpfr(0.5), turning)]
        couple = add(without, [force[2] * x for x in pressed])
        twist = turned(add(cross(r, force), couple, scaled(-1, cross(w, momentum))))[1]
        rates += [*add(cross(r, force), couple, [twist * x for x in units[2]]), *p_rate]
        if self.losses:
            tape.state()
            rates.append(-dot(couple, w))

        seen = {"n": matrix[2]}
        if not self.watching:
            return self.named(tape, kind, slip, slip_rates, rates, force, seen)
        body = turned_back(matrix, p)
        surface = [x / a for a, x in zip(self.a2, body, strict=True)]
        u = add(velocity, cross(w, r))
        level = cross(along(matrix, surface), units[2])[:2]
        seen |= {"w": turned_back(matrix, w), "q": q}
        seen["contact"] = [place[i] + r[i] for i in range(2)]
        seen["energy"] = [(dot(velocity, velocity) + dot(w, momentum)) / 2 + self.g * place[2]]
        length = sum((x * x for x in q[1:]), q[0] * q[0])
        seen["vanishing"] = [
            dot(surface, body) - 1,
            *level,
            u[0] - ux,
            u[1] - uy,
            u[2],
            place[2] + r[2],
            length - 1,
        ]
        return self.named(tape, kind, slip, slip_rates, rates, force, seen)


class Body(Stone):
    """The axes of the body, with the closed form of the contact and of the normal force."""

    order, tolerance, cut, last = 35, mpfr("1e-33"), 0.6, 44

    def start(self, n=None, w=None):
        n, w, q = self.begin(n or self.scene.n, w or self.scene.w)
        r = along(rotation(q), self.lowest(n))
        return self.started([*(mpfr(x) for x in self.scene.u), mpfr(0), mpfr(0), *n, *w, *q, r[0], r[1]])

    def equations(self, kind):
        tape = self.tape()
        slip = ux, uy, *_ = self.slip_states(tape, kind)
        tape.state(), tape.state()
        n, w = ([tape.state() for _ in range(3)] for _ in range(2))
        q = [tape.state() for _ in range(4)]
        tape.state(), tape.state()
        zero = tape.constant(0)
        matrix = rotation(q)
        n_rate = cross(n, w)
        dn, dn_rate = ([a * x for a, x in zip(self.a2, v, strict=True)] for v in (n, n_rate))
        size = tape.sqrt(dot(n, dn))
        growth = dot(n, dn_rate) / size
        at = [x / size for x in dn]
        r = [-x - d for x, d in zip(at, self.d, strict=True)]
        r_rate = [(growth * a - x) / size for a, x in zip(at, dn_rate, strict=True)]
        gyroscopic = scaled(-1, cross(w, along(self.inertia, w)))
        spun = cross(w, r)
        without, pressed = self.resisted(tape, w, n)
        torque = add(gyroscopic, without)
        if kind == "roll":
            u = [zero] * 3
            carried = add(cross(w, r_rate), cross(w, spun))
            rr = dot(r, r)
            about = [
                [self.inertia[i][j] - r[i] * r[j] + (rr if i == j else 0) for j in range(3)] for i in range(3)
            ]
            torque = add(torque, scaled(-1, cross(r, carried)), scaled(self.g, cross(r, n)))
            turned = self.spin(inverse(about), n)
            w_rate, pushed = turned(torque)[0], turned(pressed)[0]
            resting = self.g - dot(carried, n) + dot(cross(r, w_rate), n)
            normal = resting / (1 - dot(cross(r, pushed), n))
            w_rate = add(w_rate, [normal * x for x in pushed])
            push = add(cross(r, w_rate), scaled(-1, carried), scaled(self.g, n))
            force = along(matrix, push)
            slip_rates = [zero, zero]
        else:
            u = turned_back(matrix, [ux, uy, zero])
            aim = self.aim(kind, slip)
            f = turned_back(matrix, aim)
            v = add(u, scaled(-1, spun))
            turned = self.spin(self.free, n)
            bare, more = turned(torque)[0], turned(add(cross(r, f), pressed))[0]
            above = (
                self.g
                + dot(cross(w, v), n)
                - dot(cross(bare, r), n)
                - dot(cross(w, r_rate), n)
                - dot(u, n_rate)
            )
            normal = above / (1 + dot(cross(more, r), n))
            force = [normal * x for x in aim]
            w_rate = add(bare, [normal * x for x in more])
            v_rate = add([normal * x for x in f], scaled(-self.g, n), cross(v, w))
            u_rate = add(v_rate, cross(w_rate, r), cross(w, r_rate), cross(w, u))
            slip_rates = along(matrix, u_rate)[:2]
        turning = [
            -(w[0] * q[1] + w[1] * q[2] + w[2] * q[3]),
            *add([q[0] * x for x in w], cross(q[1:], w)),
        ]
        path = along(matrix, r_rate)
        rates = [*n_rate, *w_rate, *scaled(mpfr(0.5), turning), path[0] + ux, path[1] + uy]
        if self.losses:
            tape.state()
            rates.append(-dot(add(without, [force[2] * x for x in pressed]), w))
        v = add(u, scaled(-1, spun))
        seen = {"n": n, "w": w, "q": q, "contact": tape.states[14:16]}
        seen["energy"] = [(dot(v, v) + dot(w, along(self.inertia, w))) / 2 - self.g * dot(r, n)]
        seen["vanishing"] = [a - b for a, b in zip(matrix[2], n, strict=True)]
        return self.named(tape, kind, slip, slip_rates, rates, force, seen)
