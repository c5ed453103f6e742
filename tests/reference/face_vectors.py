"""Newton's and Euler's equations in the laboratory, with the pressure as a sum over the face: one formulation of face.py.

On the face the pressure is linear and cut at zero, p = max(0, c . (1, n)), such that it carries the weight and that its
forces p (z - mu u/|u|) have no horizontal moment about the centre of mass. On a rim the accelerations of the contact
are linear in the force. An impulse is found among all contacts that may carry it.
"""

import functools
import itertools

import gmpy2
import numpy as np
from gauss import Collocation, legendre, solved
from gmpy2 import mpfr

sqrt = np.frompyfunc(gmpy2.sqrt, 1, 1)
sin, cos = np.frompyfunc(gmpy2.sin, 1, 1), np.frompyfunc(gmpy2.cos, 1, 1)
ZERO, ONE = mpfr(0), mpfr(1)
WHOLE = 68  # exp(-68) is what a sum round the ring may leave out


@functools.cache
def circle(n):
    """Cosines and sines of so many equal parts of a turn."""
    angle = [2 * gmpy2.const_pi() * k / n for k in range(n)]
    return np.array([gmpy2.cos(x) for x in angle]), np.array([gmpy2.sin(x) for x in angle])


def over(x):
    """Adds over the nodes of the face."""
    return x.sum(axis=-1)


class Vectors:
    """One scene."""

    count = 24

    def __init__(self, scene):
        self.scene = scene
        self.a, self.z, self.i1, self.i3 = map(mpfr, scene.carried)
        self.rho = mpfr(scene.body[3])
        self.mu = mpfr(scene.mu)
        self.drilling, self.air = mpfr(scene.losses.get("drilling", 0)), mpfr(scene.losses.get("air", 0))
        self.part, self.planes = False, {}
        self.frozen, self.sense, self.pure, self.fixed = False, 0, False, None
        self.steps = 0
        self.col = Collocation(self.count)

    # On the face.

    def places(self, vx, vy, w, r):
        """Directions n of the ring by the angle of a map of the circle that spreads the place of the least slip."""
        v = sqrt(vx * vx + vy * vy)
        sign = np.array([1 if x >= 0 else -1 for x in np.atleast_1d(w)]).reshape(w.shape)
        safe = np.where(v == 0, ONE, v)
        ex, ey = np.where(v == 0, ONE, vx / safe), vy / safe
        return -sign * ey, sign * ex

    def ratio(self, vx, vy, w):
        """Radius to which the singular place of the ring goes by that map."""
        v, s = sqrt(vx * vx + vy * vy), self.a * abs(w)
        if self.scene.law == "viscous":  # nothing is singular
            return v * 0
        q = np.where(v < s, v, s) / np.where(v < s, s, v)
        return q / (1 + sqrt(1 - q * q))

    def ring(self, vx, vy, w, cosine, sine, r):
        """n and the weight of the nodes, from cosines and sines of the mapped angle."""
        below = 1 + r * r + 2 * r * cosine
        c, s = (cosine * (1 + r * r) + 2 * r) / below, (1 - r * r) * sine / below
        dx, dy = self.places(vx, vy, w, r)
        return c * dx - s * dy, c * dy + s * dx, (1 - r * r) / below

    def slip_at(self, vx, vy, w, nx, ny):
        ux, uy = vx - self.a * w * ny, vy + self.a * w * nx
        return ux, uy, sqrt(ux * ux + uy * uy)

    def summed(self, vx, vy, w, nx, ny, weight):
        """Force, couple, heat and the pressure's plane with all these nodes."""
        ux, uy, size = self.slip_at(vx, vy, w, nx, ny)
        safe = np.where(size == 0, ONE, size)
        x, y, dx, dy = nx, ny, ux / safe, uy / safe
        lam = self.mu * self.z / self.a
        rows = [weight, weight * (x - lam * dx), weight * (y - lam * dy)]
        matrix = [[over(row), over(row * x), over(row * y)] for row in rows]
        plane = cramer(matrix)
        p = weight * (plane[0] + plane[1] * x + plane[2] * y)
        force = -self.mu * over(p * dx), -self.mu * over(p * dy)
        couple = -self.mu * self.a * over(p * (x * dy - y * dx))
        heat = self.mu * over(p * (dx * ux + dy * uy))
        return (*force, couple, heat, *plane)

    def whole(self, vx, vy, w):
        """Everything of a ring that presses all round, which is the mirror image of itself but for the sense of the turn.

        The direction n of a node is cos b across V and sin b along it, and that of its slip has the parts f and h so told.
        """
        r = self.ratio(vx, vy, w)
        most = max(np.atleast_1d(r))
        viscous = self.scene.law == "viscous"
        n = 32 if viscous or most == 0 else max(32, int(WHOLE / -gmpy2.log(most)) // 16 * 16 + 16)
        cosine, sine = (x[None, : n // 2 + 1] for x in circle(n))
        share = np.array([ONE, *[2 * ONE] * (n // 2 - 1), ONE]) / n
        v, s = sqrt(vx * vx + vy * vy), self.a * abs(w)
        at, v, s = r[..., None], v[..., None], s[..., None]
        below = 1 + at * at + 2 * at * cosine
        c, d = (cosine * (1 + at * at) + 2 * at) / below, (1 - at * at) * sine / below
        weight = share * (1 - at * at) / below
        f, h = v - s * c, s * d
        if not viscous:
            if self.pure:
                weight = weight / (s if self.sense else v)
                f, h = (-s * c, h) if self.sense else (v + 0 * c, 0 * h)
            else:
                weight = weight / sqrt(f * f + h * h)
        f, h = weight * f, weight * h
        fc, hd = c * f, d * h
        turn = hd - fc
        mean_f, mean_fc, mean_hd, mean_turn, mean_tc = over(f), over(fc), over(hd), over(turn), over(c * turn)
        # p = 1 + 2 X . n: the pressure's centre X is lam times the mean of the direction of the slip
        lam = self.mu * self.z / self.a
        along = mean_f / (1 - 4 * lam * lam * mean_hd * mean_fc)
        across = 2 * lam * mean_hd * along
        couple = mean_turn + 2 * lam * across * mean_tc
        sign = self.sense if self.pure and self.sense else np.array([-1 if x < 0 else 1 for x in w])
        ex, ey = self.fixed if self.pure and self.fixed else self.ahead(vx, vy)
        gx, gy = along * ex - sign * across * ey, along * ey + sign * across * ex
        force = -self.mu * gx, -self.mu * gy
        moment = -self.mu * self.a * couple * sign
        return (
            *force,
            moment,
            -(force[0] * vx + force[1] * vy + moment * w),
            w * 0 + 1,
            2 * lam * gx,
            2 * lam * gy,
        )

    @staticmethod
    def ahead(vx, vy):
        v = sqrt(vx * vx + vy * vy)
        safe = np.where(v == 0, ONE, v)
        return np.where(v == 0, ONE, vx / safe), vy / safe

    def partly(self, vx, vy, w, key=None):
        """The same of one state, of which a part presses."""
        one = np.array([vx]), np.array([vy]), np.array([w])
        full = self.whole(*one)
        plane = np.array([x[0] for x in full[4:]])
        if plane[0] ** 2 >= plane[1] ** 2 + plane[2] ** 2:
            return [x[0] for x in full]
        r = self.ratio(*one)[0]
        dx, dy = (x[0] for x in self.places(*one, r))
        old = self.planes.get(key, self.planes.get("last"))
        if old is not None:  # the last one, told from the direction of the least slip
            plane = np.array([old[0], old[1] * dx - old[2] * dy, old[1] * dy + old[2] * dx])
        for _ in range(60):
            size = gmpy2.hypot(plane[1], plane[2])
            middle = gmpy2.atan2(plane[2] * dx - plane[1] * dy, plane[1] * dx + plane[2] * dy)
            half = gmpy2.acos(max(-ONE, min(ONE, -plane[0] / size)))
            cosine, sine, share = self.arc(middle - half, middle + half, r)
            nx, ny, weight = self.ring(*one, cosine, sine, r)
            found = self.summed(*one, nx, ny, weight * share)
            new = np.array(found[4:])
            change = max(abs(x) for x in new - plane)
            plane = new
            if change < 1e-21:  # the next one would be less than its square
                break
        kept = plane[0], plane[1] * dx + plane[2] * dy, plane[2] * dx - plane[1] * dy
        self.planes[key] = self.planes["last"] = kept
        return list(found)

    def arc(self, low, high, r):
        """Cosines, sines and weights of nodes of an arc, in panels that are finer where the slip is least."""

        def mapped(angle):
            turns = gmpy2.rint(angle / (2 * gmpy2.const_pi()))
            rest = angle - 2 * gmpy2.const_pi() * turns
            return (
                2 * gmpy2.atan2((1 + r) * gmpy2.sin(rest / 2), (1 - r) * gmpy2.cos(rest / 2))
                + 2 * gmpy2.const_pi() * turns
            )

        low, high = mapped(low), mapped(high)
        pi, width = gmpy2.const_pi(), -gmpy2.log(r)
        edges, x = {ZERO}, pi
        while True:
            edges |= {x, -x, pi - x, x - pi}  # the map has poles on the other side
            if x < width:
                break
            x /= 5
        every = sorted(e + 2 * pi * k for e in edges for k in (-1, 0, 1))
        inner = [e for e in every if low < e < high]
        ends = [low, *inner, high]
        nodes, weights = legendre(44)
        angle = np.concatenate([a + (b - a) * nodes for a, b in itertools.pairwise(ends)])
        share = np.concatenate([(b - a) * weights for a, b in itertools.pairwise(ends)]) / (2 * pi)
        return cos(angle), sin(angle), share

    def disc(self, vx, vy, w):
        """Everything of a disc, in polar coordinates about the point of the face that does not move, which is in it."""
        v, s = sqrt(vx * vx + vy * vy), self.a * abs(w)
        k = max(v / s)
        assert k < mpfr("0.99")
        width = gmpy2.acosh(1 / k) if k else mpfr(5)
        n = max(32, int(WHOLE / width) // 16 * 16 + 16)
        cosine, sine = (x[None, :] for x in circle(n))
        vx, vy, w = (x[:, None] for x in (vx, vy, w))
        px, py = -vy / (self.a * w), vx / (self.a * w)  # in units of a
        along, beside = px * cosine + py * sine, px * sine - py * cosine
        reach = -along + sqrt(1 - beside * beside)
        sign = self.sense if self.pure else np.where(w > 0, ONE, -ONE)
        dx, dy = -sign * sine, sign * cosine
        # powers of the radius over the face, of which the area is pi
        m1, m2, m3, _m4 = (2 * reach ** (j + 1) / (j + 1) / n for j in (1, 2, 3, 4))
        one = [m1, px * m1 + cosine * m2, py * m1 + sine * m2]  # of (1, x, y)
        xs = [
            one[1],
            px * px * m1 + 2 * px * cosine * m2 + cosine**2 * m3,
            px * py * m1 + (px * sine + py * cosine) * m2 + sine * cosine * m3,
        ]
        ys = [one[2], xs[2], py * py * m1 + 2 * py * sine * m2 + sine**2 * m3]
        lam = self.mu * self.z / self.a
        matrix = [
            [over(x) for x in one],
            [over(x - lam * dx * o) for x, o in zip(xs, one, strict=False)],
            [over(y - lam * dy * o) for y, o in zip(ys, one, strict=False)],
        ]
        plane = cramer(matrix)
        assert all(
            4 * abs(p) < abs(q) * 4
            for p, q in zip(sqrt(plane[1] ** 2 + plane[2] ** 2), plane[0], strict=False)
        )
        p = sum(c[:, None] * x for c, x in zip(plane, one, strict=False))
        px_, py_ = (sum(c[:, None] * x for c, x in zip(plane, z, strict=False)) for z in (xs, ys))
        force = -self.mu * over(p * dx), -self.mu * over(p * dy)
        couple = -self.mu * self.a * over(px_ * dy - py_ * dx)
        # the slip is w times the radius from the point that does not move
        radius = [m2, px * m2 + cosine * m3, py * m2 + sine * m3]
        heat = (
            self.mu
            * self.a
            * abs(w[:, 0])
            * over(sum(c[:, None] * x for c, x in zip(plane, radius, strict=False)))
        )
        return (*force, couple, heat, *plane)

    def pressed(self, vx, vy, w):
        """Force, couple, heat and plane of the present way to press."""
        if self.scene.face == "disc":
            return self.disc(vx, vy, w)
        if not self.part:
            return self.whole(vx, vy, w)
        rows = [
            self.partly(*at, key=k if len(w) > 1 else None)
            for k, at in enumerate(zip(vx, vy, w, strict=True))
        ]
        return [np.array(x) for x in zip(*rows, strict=False)]

    def rates(self, values):
        _t, _x, _y, vx, vy, w, _psi, _heat, _work = values
        one = w * 0 + 1
        fx, fy, couple, warm, *_ = self.pressed(vx, vy, w)
        if self.pure:  # without what is left by rounding
            couple, (fx, fy) = couple * abs(self.sense), (x * (1 - abs(self.sense)) for x in (fx, fy))
        moves = 0 if self.frozen else 1
        lost = (self.drilling * self.sense + self.air * w) * moves
        return [one, vx * moves, vy * moves, fx, fy, (couple - lost) / self.i3, w * moves, warm, lost * w]

    def margin(self, y):
        """Positive while the whole ring presses."""
        found = self.whole(*(np.array([x]) for x in y[3:6]))
        return ((found[4] ** 2 - found[5] ** 2 - found[6] ** 2) / found[4] ** 2)[0]

    def size(self, y):
        return gmpy2.hypot(y[3], y[4]) + self.a * abs(y[5])

    def longest(self, y):
        if self.scene.law == "viscous":
            return mpfr(1)
        if self.pure:
            return 3 * self.size(y) / self.mu
        left = mpfr("0.6") * self.size(y) / -self.shrinks(y)
        v, s = gmpy2.hypot(y[3], y[4]), self.a * abs(y[5])
        far = abs(v - s)
        pace = abs(self.pace(y))
        if far < 1e-11 * (v + s):
            return min(left, 2 * far / pace)
        return min(left, mpfr("0.75") * far / pace) if pace else left

    def pace(self, y):
        """The rate of |v| - a |w|."""
        f = self.rates([np.array([x]) for x in y])
        v = gmpy2.hypot(y[3], y[4])
        return (y[3] * f[3][0] + y[4] * f[4][0]) / v - self.a * f[5][0] * self.sense

    def slide(self, now, times=(), impulse=None):
        """Goes on along the face: rows at these times, then what happens and where."""
        y = [now.t, *now.place, *now.velocity, now.w, now.psi, now.heat, now.work]
        self.frozen, self.sense = impulse is not None, (1 if y[5] > 0 else -1) if y[5] else 0
        begin, self.pure = self.size(y), not (y[5] and (y[3] or y[4]))
        t0 = y[0]
        self.aim(y)
        if not (y[3] or y[4] or y[5]):
            for t in times:
                yield "sample", now.at(t=mpfr(t))
            yield "rests", now
            return
        self.planes = {}
        ring = self.scene.law != "viscous" and self.scene.face != "disc"
        self.part = ring and self.margin(y) < 0
        times = [mpfr(t) for t in times]
        if impulse is not None:
            times = [t0 + impulse]
        while True:
            events = []
            if times:
                events.append(("sample", lambda y: times[0] - y[0]))
            if ring and not self.pure:
                side = -1 if self.part else 1
                events.append(("border", lambda y: side * self.margin(y)))  # noqa: B023
            if self.sense == 0:
                v0 = y[3], y[4]
                events.append(("rests", lambda y: y[3] * v0[0] + y[4] * v0[1]))  # noqa: B023
            elif self.pure or self.drilling:
                name = "rests" if self.pure else "straight"
                events.append((name, lambda y: y[5] * self.sense))
            else:
                events.append(("rests", lambda y: self.size(y) - begin * mpfr("1e-27")))
            name, y, n = self.col.follow(
                self.rates, y, self.longest(y), events, self.longest, scale=self.size
            )
            self.steps += n
            if name == "border":
                self.part = not self.part
                continue
            if name == "sample":
                times.pop(0)
            if name == "rests":
                if not self.pure:
                    y[0] += self.size(y) / -self.shrinks(y)
                y[3:6] = [ZERO] * 3
            if name == "straight":
                y[5], self.sense, self.pure = ZERO, 0, True
                self.aim(y)
                self.drilling = ZERO
            out = now.at(
                t=t0 if self.frozen else y[0],
                place=y[1:3],
                velocity=y[3:5],
                w=y[5],
                psi=y[6],
                heat=y[7],
                work=y[8],
            )
            yield ("pushed" if self.frozen and name == "sample" else name), out
            if name == "rests" or (not times and self.frozen):
                return
            if not times and name == "sample" and not self.scene.to_rest:
                return
            if name == "rests":
                return

    def aim(self, y):
        v = gmpy2.hypot(*y[3:5])
        self.fixed = [x / v for x in y[3:5]] if v else None

    def shrinks(self, y):
        f = self.rates([np.array([x]) for x in y])
        return self.pace(y) + 2 * self.a * f[5][0] * self.sense

    def friction(self, now):
        """The force of the table at a state on the face."""
        if not (now.velocity[0] or now.velocity[1] or now.w):
            return ZERO, ZERO
        kept = self.frozen, self.sense, self.pure, self.fixed
        self.frozen, self.sense = False, 0
        self.pure = not now.w or not (now.velocity[0] or now.velocity[1])
        if self.pure:
            self.sense = (1 if now.w > 0 else -1) if now.w else 0
            self.aim([0, 0, 0, *now.velocity])
        force = tuple(x[0] for x in self.pressed(*(np.array([x]) for x in (*now.velocity, now.w)))[:2])
        self.frozen, self.sense, self.pure, self.fixed = kept
        return force

    # A planar motion on one rim: x, z, the lean counterclockwise and their rates.

    def corner(self, side, lean):
        """From the centre to a contact, and its rate by the lean."""
        c, s = cos(lean), sin(lean)
        rx, rz = side * self.a * c + self.z * s, side * self.a * s - self.z * c
        return rx, rz

    def planar_force(self, side, way, values):
        """Friction, normal force, and the acceleration of the lean; way 0 sticks."""
        _, _, _, lean, _, _, turn, _ = values
        rx, rz = self.corner(side, lean)
        # heights and slips of the contact: z'' + lean'' rx - lean'^2 rz = 0, x'' - lean'' rz - lean'^2 rx (= 0 if it sticks)
        i = self.i1
        if way == 0:
            # unknown F, N: lean'' = (rx N - rz F)/i
            a11, a12, b1 = -rz * rx / i, 1 + rx * rx / i, 1 + turn**2 * rz
            a21, a22, b2 = 1 + rz * rz / i, -rz * rx / i, turn**2 * rx
            det = a11 * a22 - a12 * a21
            f, n = (b1 * a22 - a12 * b2) / det, (a11 * b2 - a21 * b1) / det
        else:
            n = (1 + turn**2 * rz) / (1 + rx * (rx + self.mu * way * rz) / i)
            f = -self.mu * way * n
        return f, n, (rx * n - rz * f) / i

    def planar_rates(self, side, way):
        def rates(values):
            _, _, _, lean, vx, vz, turn, _ = values
            f, n, twist = self.planar_force(side, way, values)
            _, rz = self.corner(side, lean)
            slip = vx - turn * rz
            return [lean * 0 + 1, vx, vz, turn, f, n - 1, twist, -f * slip if way else lean * 0]

        return rates

    def planar_start(self, now):
        """x, z, lean and rates from what is told: the lean is counterclockwise where phi = 0."""
        side = -1 if now.phi == 0 else 1
        lean, turn = -side * now.theta, -side * -now.w2
        rx, rz = self.corner(side, lean)
        slip = now.u_h * -side
        return side, [now.t, now.place[0], -rz, lean, slip + turn * rz, -turn * rx, turn, now.heat]

    def planar_told(self, side, y, now, slip):
        return now.at(
            t=y[0],
            place=[y[1], now.place[1]],
            theta=abs(y[3]),
            w2=side * y[6],
            u_h=-side * slip,
            phi=ZERO if side < 0 else gmpy2.const_pi(),
            heat=y[7],
            velocity=[y[4], ZERO],
            psi=now.psi + (now.phi - (ZERO if side < 0 else gmpy2.const_pi())),
        )

    def planar_slip(self, side, y):
        return y[4] - y[6] * self.corner(side, y[3])[1]

    def planar_begin(self, side, y):
        """Whether a contact without slip sticks (0) or begins to slip, and which way."""
        f, n, _ = self.planar_force(side, 0, y)
        if abs(f) <= self.mu * n:
            return 0
        return -1 if f > 0 else 1

    def rim(self, now, times):
        """Follows one rim: what happens, the state and the way it slips then."""
        side, y = self.planar_start(now)
        slip = self.planar_slip(side, y) if now.u_h else ZERO
        way = (1 if slip > 0 else -1) if slip else self.planar_begin(side, y)
        times = [mpfr(t) for t in times]
        while True:
            events = [("lands", lambda y: -side * y[3])]
            if times:
                events.append(("sample", lambda y: times[0] - y[0]))
            if way:
                events.append(("slip ends", lambda y: way * self.planar_slip(side, y)))  # noqa: B023
            else:

                def spare(y):
                    f, n, _ = self.planar_force(side, 0, y)
                    return self.mu * n - abs(f)

                events.append(("slips", spare))

            def longest(y):
                return mpfr("0.3")

            name, y, n = self.col.follow(
                self.planar_rates(side, way), y, self.first_step(now), events, longest
            )
            self.steps += n
            slip = self.planar_slip(side, y) if way and name != "slip ends" else ZERO
            if name == "slip ends":
                way = self.planar_begin(side, y)
                name = "passes" if way else "rolls"
            elif name == "slips":
                way = self.planar_begin_of(side, y)
            elif name == "lands":
                y[3] = ZERO
            yield name, self.planar_told(side, y, now, slip)
            if name == "lands":
                return
            if name == "sample":
                times.pop(0)
                if not times and not self.scene.to_rest:
                    return

    @staticmethod
    def first_step(now):
        """Less than the duration of a hop."""
        return min(abs(now.w2), mpfr("0.1")) if now.w2 else mpfr("0.1")

    def planar_begin_of(self, side, y):
        f, _, _ = self.planar_force(side, 0, y)
        return -1 if f > 0 else 1

    def land(self, now):
        """The outcome of a planar landing, among the contacts that may carry its impulse: both or the new one."""
        side = -1 if now.phi == 0 else 1
        _, y = self.planar_start(now)
        vx, vz, turn = y[4:7]
        found = []
        for sides in ((1, -1), (-side,)):
            for way in (0, 1, -1):
                # the unknowns: vx, vz, turn afterwards, the impulses P of these corners, and Q
                m = 4 + len(sides)
                rows, right = [], []

                def row(value, **of):
                    r = [ZERO] * m  # noqa: B023
                    for k, x in of.items():
                        r["vx vz turn q p0 p1".split().index(k)] = x
                    rows.append(r)  # noqa: B023
                    right.append(value)  # noqa: B023

                names = [f"p{k}" for k in range(len(sides))]
                row(vx, vx=ONE, q=-ONE)
                row(vz, vz=ONE, **{p: -ONE for p in names})
                # lean' changes by (rx P - rz Q)/i1 with rz = -Z
                row(
                    self.i1 * turn,
                    turn=self.i1,
                    q=-self.z,
                    **{p: -s * self.a for p, s in zip(names, sides, strict=False)},
                )
                for s in sides:
                    row(ZERO, vz=ONE, turn=s * self.a)
                if way == 0:
                    row(ZERO, vx=ONE, turn=self.z)
                else:
                    row(ZERO, q=ONE, **{p: self.mu * way for p in names})
                after = solved(np.array(rows), right)
                vx1, vz1, turn1, q, *p = after
                slip = vx1 + turn1 * self.z
                other = vz1 + turn1 * side * self.a  # the corner that was down rises
                if min(p) < -1e-40 or (len(sides) == 1 and other <= 1e-60):
                    continue
                if abs(q) > self.mu * sum(p) * (1 + mpfr("1e-40")) if way == 0 else slip * way <= 0:
                    continue
                before = vx**2 + vz**2 + self.i1 * turn**2
                lost = (before - vx1**2 - vz1**2 - self.i1 * turn1**2) / 2
                found.append((len(sides), vx1, turn1, ZERO if way == 0 else slip, lost))
        assert len(found) == 1, (found, float(turn), float(vx), float(now.u_h))
        count, vx1, turn1, slip, lost = found[0]
        heat = now.heat + lost
        if count == 2:
            return "stands", now.at(theta=ZERO, w2=ZERO, velocity=[vx1, ZERO], heat=heat, u_h=ZERO, w=ZERO)
        phi = gmpy2.const_pi() if side < 0 else ZERO
        psi = now.psi + now.phi - phi
        return "rocks", now.at(
            w2=-side * turn1, u_h=side * slip, phi=phi, psi=psi, heat=heat, velocity=[vx1, ZERO]
        )

    # One rim in space, as it topples.

    def topple(self, now, times):
        """From the face, which it leaves at once: time, centre, its velocity, the axis, a material vector, w, the heat."""
        vx, vy = now.velocity
        v, s = gmpy2.hypot(vx, vy), self.a * abs(now.w)
        # the edge is where the slip points outward: n . (V + w z x a n) is greatest, and u is along n
        cosine = gmpy2.sqrt(1 - (self.a * now.w / v) ** 2)
        sine = self.a * now.w / v
        n = [(vx * cosine - vy * sine) / v, (vy * cosine + vx * sine) / v]
        lam, mu = self.mu * self.z / self.a, self.mu
        # leading order: a couple (lam - 1) a N about the horizontal line across n, at a height that N carries
        normal = 1 / (1 - (lam - 1) * self.a**2 / self.i1)
        c = (lam - 1) * self.a * normal / self.i1
        nu = now.w * (self.i3 / self.i1) * (lam - 1) / (3 * lam - 2)
        mark = now.phi + now.psi  # the direction of a vector in the body
        y = [
            now.t,
            *now.place,
            self.z,
            vx,
            vy,
            ZERO,
            ZERO,
            ZERO,
            ONE,
            gmpy2.cos(mark),
            gmpy2.sin(mark),
            ZERO,
            ZERO,
            ZERO,
            now.w,
            now.heat,
        ]
        h = mpfr("0.02")
        t = self.col.nodes * h
        theta, turned = c * t * t / 2, nu * t
        mx, my = n[0] * cos(turned) - n[1] * sin(turned), n[1] * cos(turned) + n[0] * sin(turned)
        tx, ty = mx * sin(theta), my * sin(theta)
        dx, dy = mx * c * t - my * theta * nu, my * c * t + mx * theta * nu
        spin = mark + now.w * t
        guess = [
            now.t + t,
            now.place[0] + vx * t,
            now.place[1] + vy * t,
            self.z + self.a * theta,
            vx - mu * normal * n[0] * t,
            vy - mu * normal * n[1] * t,
            self.a * c * t,
            tx,
            ty,
            cos(theta),
            cos(spin),
            sin(spin),
            t * 0,
            -dy + now.w * tx,
            dx + now.w * ty,
            now.w + t * 0,
            now.heat + mu * normal * sqrt(v * v - s * s + t * 0) * t,
        ]
        y = self.small().implicit(self.space_rates, y, h, self.thinned(guess))
        times = [mpfr(x) for x in times]
        yield "topples", self.space_told(None, now, n)
        while times:
            name, y, k = self.col.follow(
                self.space_rates, y, y[0] / 4, [("sample", lambda y: times[0] - y[0])], lambda y: y[0] / 4
            )
            self.steps += k
            times.pop(0)
            yield name, self.space_told(y, now, None)

    def small(self):
        self.few = Collocation(12)
        return self.few

    def thinned(self, guess):
        """The guess at fewer nodes: it is a function of t, read again."""
        rows = []
        for g in guess:
            coefficients = self.col.series.dot(g)
            x = 2 * self.few.nodes - 1
            p = [x * 0 + 1, x]
            for k in range(1, self.count):
                p.append(((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1))
            rows.append(sum(c * q for c, q in zip(coefficients, p, strict=False)))
        return np.array(rows)

    def space_rates(self, values):
        _, _, _, _, vx, vy, vz, *rest = values
        e, m, w = rest[0:3], rest[3:6], rest[6:9]
        axis = crossed(w, e)
        s = sqrt(e[0] ** 2 + e[1] ** 2)
        h = [e[0] / s, e[1] / s]  # towards the contact
        # the contact: a (h cos - z sin) - Z e, with cos = e_z and sin = s
        r = [
            self.a * e[2] * h[0] - self.z * e[0],
            self.a * e[2] * h[1] - self.z * e[1],
            -self.a * s - self.z * e[2],
        ]
        s1 = h[0] * axis[0] + h[1] * axis[1]
        # height of the contact: z - a s - Z e_z; its acceleration without and with force
        spin = dotted(w, e)
        momentum = [self.i1 * w[i] + (self.i3 - self.i1) * spin * e[i] for i in range(3)]
        free = self.turned([-x for x in crossed(w, momentum)], e)
        wheel = crossed(w, axis)
        square = axis[0] ** 2 + axis[1] ** 2

        def lifts(bend):
            """What a second rate of the axis gives to the height."""
            return -self.a * (h[0] * bend[0] + h[1] * bend[1]) - self.z * bend[2]

        at_rest = (
            lifts([x + y for x, y in zip(crossed(free, e), wheel, strict=False)])
            - self.a * (square - s1**2) / s
            - 1
        )
        u = [vx + w[1] * r[2] - w[2] * r[1], vy + w[2] * r[0] - w[0] * r[2]]
        size = sqrt(u[0] ** 2 + u[1] ** 2)
        aim = [-self.mu * u[0] / size, -self.mu * u[1] / size, size * 0 + 1]
        push = self.turned(crossed(r, aim), e)
        normal = -at_rest / (1 + lifts(crossed(push, e)))
        force = [normal * x for x in aim]
        twist = [x + normal * y for x, y in zip(free, push, strict=False)]
        heat = self.mu * normal * size
        return [
            size * 0 + 1,
            vx,
            vy,
            vz,
            force[0],
            force[1],
            force[2] - 1,
            *axis,
            *crossed(w, m),
            *twist,
            heat,
        ]

    def turned(self, torque, e):
        more = (1 / self.i3 - 1 / self.i1) * dotted(torque, e)
        return [torque[i] / self.i1 + more * e[i] for i in range(3)]

    def space_told(self, y, now, n):
        if y is None:
            phi = gmpy2.atan2(n[1], n[0]) + gmpy2.const_pi()
            h = [-n[0], -n[1]]
            along = now.velocity[0] * h[0] + now.velocity[1] * h[1]
            return now.at(
                phi=phi,
                psi=now.psi + now.phi - phi,
                theta=ZERO,
                w1=ZERO,
                w2=ZERO,
                w3=now.w,
                u_h=along,
                u_2=ZERO,
                rim=True,
            )
        t, px, py, pz, vx, vy, vz, *rest = y[:16]
        e, m, w = rest[0:3], rest[3:6], rest[6:9]
        s = gmpy2.hypot(e[0], e[1])
        h = [-e[0] / s, -e[1] / s, ZERO]
        e2 = [-h[1], h[0], ZERO]
        e1 = [e[2] * h[0], e[2] * h[1], s]
        r = [-self.a * e1[i] - self.z * e[i] for i in range(3)]
        u = [x + y for x, y in zip([vx, vy, vz], crossed(w, r), strict=False)]
        self.strayed = max(abs(u[2]), abs(pz + r[2]), abs(dotted(e, e) - 1), abs(dotted(m, e)))
        return now.at(
            t=t,
            place=[px, py],
            velocity=[vx, vy],
            theta=gmpy2.atan2(s, e[2]),
            w1=dotted(w, e1),
            w2=dotted(w, e2),
            w3=dotted(w, e),
            u_h=dotted(u, h),
            u_2=dotted(u, e2),
            phi=gmpy2.atan2(h[1], h[0]),
            psi=gmpy2.atan2(dotted(m, e2), dotted(m, e1)),
            heat=y[16],
            rim=True,
        )


def crossed(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dotted(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cramer(m):
    """The solution of m c = (1, 0, 0)."""
    c0 = m[1][1] * m[2][2] - m[1][2] * m[2][1]
    c1 = m[1][2] * m[2][0] - m[1][0] * m[2][2]
    c2 = m[1][0] * m[2][1] - m[1][1] * m[2][0]
    det = m[0][0] * c0 + m[0][1] * c1 + m[0][2] * c2
    return [c0 / det, c1 / det, c2 / det]
