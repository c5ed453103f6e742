"""The other formulation of face.py: closed means over the face, logarithms of the rates, and reduced equations of a rim.

Every mean over a ring is one of three integrals: of 1/|u|, |u| and |u|^3 over the arc, since |u|^2 = v^2 + s^2 -
2 v s sin chi; those are Legendre's of the modulus m = 4 v s/(v + s)^2. A disc is a sum of rings.
"""

import functools

import gmpy2
import numpy as np
from face_vectors import Vectors, cos, sin, sqrt
from gauss import Collocation
from gmpy2 import mpfr

exp, log = np.frompyfunc(gmpy2.exp, 1, 1), np.frompyfunc(gmpy2.log, 1, 1)
ZERO, ONE = mpfr(0), mpfr(1)


def complete(kc):
    """K and E of arrays, by the arithmetic-geometric mean."""
    a, b = kc * 0 + 1, kc
    total, power = (1 - kc * kc) / 2, mpfr("0.5")
    for _ in range(300):
        a, b, c = (a + b) / 2, sqrt(a * b), (a - b) / 2
        power *= 2
        total = total + power * c * c
        if max(abs(x) for x in np.ravel(c)) < mpfr(10) ** -(gmpy2.get_context().precision // 6):
            break
    a = (a + b) / 2
    k = gmpy2.const_pi() / (2 * a)
    return k, k * (1 - total)


def legendre_both(angle, m):
    """F and E of any angle, by descending Landen transformations."""
    pi = gmpy2.const_pi()
    a, b, c = ONE, gmpy2.sqrt(1 - m), gmpy2.sqrt(m)
    phi, total, extra, power = angle, m / 2, ZERO, ONE
    while abs(c) > mpfr("1e-45"):  # its square is lost
        turns = gmpy2.rint(phi / pi)
        rest = phi - pi * turns
        phi = phi + pi * turns + gmpy2.atan2(b / a * gmpy2.sin(rest), gmpy2.cos(rest))
        a, b, c = (a + b) / 2, gmpy2.sqrt(a * b), (a - b) / 2
        power *= 2
        total += power * c * c / 2
        extra += c * gmpy2.sin(phi)
    f = phi / (power * a)
    return f, f * (1 - total) + extra


@functools.cache
def double_exponential():
    """Nodes and weights on 0 to 1, for what has a logarithm at an end; the nodes also from the end."""
    h, nodes, weights, ends = mpfr("0.04"), [], [], []
    half = gmpy2.const_pi() / 2
    for k in range(-105, 106):
        t = k * h
        w = half * gmpy2.sinh(t)
        x = 1 / (1 + gmpy2.exp(-2 * w))
        nodes.append(x)
        ends.append(1 / (1 + gmpy2.exp(2 * w)))
        weights.append(h * half * gmpy2.cosh(t) / (2 * gmpy2.cosh(w) ** 2))
    return np.array(nodes), np.array(ends), np.array(weights)


class Closed(Vectors):
    """One scene; from the other formulation it has only the body and the order of events."""

    count = 20

    def __init__(self, scene):
        super().__init__(scene)
        self.lam = self.mu * self.z / self.a
        self.arc_at = None

    # Means for v along x, and a counterclockwise turn.

    def ring_means(self, v, s):
        """f, g, c2, a1, m2 of the uniform pressure; arrays."""
        k, e = complete(abs(v - s) / (v + s))
        m = 4 * v * s / (v + s) ** 2
        pi = gmpy2.const_pi()
        inverse = 2 * k / (pi * (v + s))
        first = 2 * e * (v + s) / pi
        third = 2 * (v + s) ** 3 / pi * ((4 - 2 * m) * e - (1 - m) * k) / 3
        return self.five(v, s, inverse, first, third)

    @staticmethod
    def five(v, s, inverse, first, third):
        q, both = v * v + s * s, 2 * v * s
        one = (q * inverse - first) / both  # of sin/|u|
        two = (q * q * inverse - 2 * q * first + third) / both**2  # of sin^2/|u|
        return (
            v * inverse - s * one,
            s * inverse - v * one,
            s * (inverse - two),
            v * one - s * two,
            s * one - v * two,
        )

    def linear(self, f, g, c2, a1, m2, factor=2):
        gx = f / (1 - factor**2 * self.lam**2 * c2 * a1)
        gy = factor * self.lam * c2 * gx
        return gx, gy, g + factor * self.lam * gy * m2

    def arc_means(self, middle, half, v, s):
        """G and g of the pressure max(0, cos(chi - middle) - cos(half)), and r: the centre of that pressure."""
        pi = gmpy2.const_pi()
        c0 = -gmpy2.cos(half)
        cx, cy = gmpy2.cos(middle), gmpy2.sin(middle)
        norm = 2 * (gmpy2.sin(half) - half * gmpy2.cos(half))
        m, q, both = 4 * v * s / (v + s) ** 2, v * v + s * s, 2 * v * s

        def upto(chi):
            angle = (chi + pi / 2) / 2
            f, e = legendre_both(angle, m)
            sn, cn = gmpy2.sin(angle), gmpy2.cos(angle)
            d = gmpy2.sqrt(1 - m * sn * sn)
            inverse, first = 2 * f / (v + s), 2 * (v + s) * e
            third = 2 * (v + s) ** 3 * ((4 - 2 * m) * e - (1 - m) * f + m * sn * cn * d) / 3
            u = (v + s) * d
            # of cos/|u| and cos |u|
            return np.array([inverse, first, third, -2 * u / both, -2 * u**3 / (3 * both)])

        inverse, first, third, k0, k1 = upto(middle + half) - upto(middle - half)
        one = (q * inverse - first) / both
        two = (q * q * inverse - 2 * q * first + third) / both**2
        mixed = (q * k0 - k1) / both  # of cos sin/|u|
        w0, w1 = c0 * inverse + cx * k0 + cy * one, c0 * one + cx * mixed + cy * two  # of p/|u|, p sin/|u|
        wc = c0 * k0 + cx * (inverse - two) + cy * mixed
        centre = (half - gmpy2.sin(half) * gmpy2.cos(half)) / norm
        return (v * w0 - s * w1) / norm, s * wc / norm, (s * w0 - v * w1) / norm, centre

    def arc(self, v, s):
        """G and g where a part presses: the centre of the pressure is lam G."""
        at = self.arc_at

        def residual(middle, half):
            gx, gy, g, r = self.arc_means(middle, half, v, s)
            return r * gmpy2.cos(middle) - self.lam * gx, r * gmpy2.sin(middle) - self.lam * gy, (gx, gy, g)

        if at is None:
            one = [np.array([x]) for x in (v, s)]
            gx, gy, _ = (x[0] for x in self.linear(*self.ring_means(*one)))
            r = min(mpfr("0.9"), max(mpfr("0.52"), self.lam * gmpy2.hypot(gx, gy)))
            low, high = mpfr("0.01"), gmpy2.const_pi()
            for _ in range(20):
                half = (low + high) / 2
                inside = (half - gmpy2.sin(half) * gmpy2.cos(half)) / (
                    2 * (gmpy2.sin(half) - half * gmpy2.cos(half))
                )
                low, high = (half, high) if inside > r else (low, half)
            at = gmpy2.atan2(gy, gx), half
        middle, half = at
        for _ in range(60):
            rx, ry, _means = residual(middle, half)
            d = mpfr("1e-22")
            ax, ay, _ = residual(middle + d, half)
            bx, by, _ = residual(middle, half - d)
            ax, ay, bx, by = (ax - rx) / d, (ay - ry) / d, (rx - bx) / d, (ry - by) / d
            det = ax * by - bx * ay
            dm, dh = -(rx * by - bx * ry) / det, -(ax * ry - rx * ay) / det
            if max(abs(dm), abs(dh)) > mpfr("0.3"):
                scale = mpfr("0.3") / max(abs(dm), abs(dh))
                dm, dh = dm * scale, dh * scale
            middle, half = middle + dm, half + dh
            if max(abs(dm), abs(dh)) < mpfr("1e-20"):
                break
            if half >= gmpy2.const_pi():
                half = gmpy2.const_pi() - mpfr("1e-3")
        self.arc_at = middle, half
        return self.arc_means(middle, half, v, s)[:3]

    def closure(self, v, s):
        """G_x, G_y and g of arrays of both rates."""
        if self.scene.face == "disc":
            return self.disc_means(v, s)
        if not self.part:
            return self.linear(*self.ring_means(v, s))
        full = self.linear(*self.ring_means(v, s))
        out = []
        for i, (one, other) in enumerate(zip(v, s, strict=True)):
            if 4 * self.lam**2 * (full[0][i] ** 2 + full[1][i] ** 2) <= 1:
                out.append([x[i] for x in full])
            else:
                out.append(self.arc(one, other))
        return [np.array(x) for x in zip(*out, strict=False)]

    def disc_means(self, v, s):
        """A disc as its rings: p = 1 + 4 X . x, of which the ring of radius r has the mean 1 and the slope 4 r."""
        nodes, ends, weights = double_exponential()
        k = (v / s)[:, None]
        assert max(k.ravel()) < 1
        inner, outer = k * nodes, k + (1 - k) * nodes
        r = np.concatenate([inner, outer], axis=1)
        gap = np.concatenate([k * ends, (1 - k) * nodes], axis=1)  # |r - k|
        share = 2 * r * np.concatenate([k * weights, (1 - k) * weights], axis=1)
        v, s = v[:, None], s[:, None] * r
        kept = complete(gap / (k + r))
        m = 4 * k * r / (k + r) ** 2
        pi = gmpy2.const_pi()
        inverse, first = 2 * kept[0] / (pi * (v + s)), 2 * kept[1] * (v + s) / pi
        third = 2 * (v + s) ** 3 / pi * ((4 - 2 * m) * kept[1] - (1 - m) * kept[0]) / 3
        f, g, c2, a1, m2 = self.five(v, s, inverse, first, third)

        def total(x):
            return (x * share).sum(axis=1)

        return self.linear(total(f), total(r * g), total(r * c2), total(r * a1), total(r * r * m2), 4)

    # Motion on the face.

    def flow(self, values):
        """Rates by tau, where dt = (|v| + s)/mu dtau."""
        big, turn, small, _x, _y, _psi, _heat, _work, _t = values
        v, s = exp(big), exp(small)
        gx, gy, g = self.closure(v, s)
        pace = (v + s) / self.mu
        moves = 0 if self.frozen else 1
        w = s / self.a
        slow = (self.mu * self.a**2 * g + self.air * s * moves) / self.i3
        return [
            -self.mu * gx / v * pace,
            -self.mu * gy / v * pace,
            -slow / s * pace,
            v * cos(turn) * pace * moves,
            v * sin(turn) * pace * moves,
            w * pace * moves,
            self.mu * (v * gx + s * g) * pace,
            self.air * w * w * pace * moves,
            pace,
        ]

    def by_turning(self, values):
        """Rates by the loss of s, with drilling."""
        v, turn, s, _x, _y, _psi, _heat, _work, _t = values
        gx, gy, g = self.closure(v, s)
        slow = (self.mu * self.a**2 * g + self.drilling * self.a + self.air * s) / self.i3
        w = s / self.a
        return [
            -self.mu * gx / slow,
            -self.mu * gy / v / slow,
            s * 0 - 1,
            v * cos(turn) / slow,
            v * sin(turn) / slow,
            w / slow,
            self.mu * (v * gx + s * g) / slow,
            (self.drilling * w + self.air * w * w) / slow,
            1 / slow,
        ]

    def inside(self, y):
        """Positive while the whole ring presses."""
        v, s = (np.array([x]) for x in self.speeds(y))
        gx, gy, _ = self.linear(*self.ring_means(v, s))
        return (1 - 4 * self.lam**2 * (gx**2 + gy**2))[0]

    def speeds(self, y):
        return (gmpy2.exp(y[0]), gmpy2.exp(y[2])) if not self.drilling else (y[0], y[2])

    def reach(self, y):
        _v, _s = self.speeds(y)
        if self.drilling:
            return mpfr("0.2")
        far, fast = abs(y[0] - y[2]), self.flow([np.array([x]) for x in y])
        pace = abs(fast[0][0] - fast[2][0])
        if far < self.jump:
            return 2 * far / pace
        return min(mpfr("0.8"), mpfr("0.7") * far / pace) if pace else mpfr("0.8")

    def slide(self, now, times=(), impulse=None):
        v, w = gmpy2.hypot(*now.velocity), now.w
        self.frozen, self.sense = impulse is not None, -1 if w < 0 else 1
        times = [mpfr(t) for t in times] if impulse is None else [now.t + impulse]
        if self.scene.law == "viscous":
            yield from self.film(now, times)
            return
        if not v or not w:
            yield from self.plain(now, times)
            return
        s = self.a * abs(w)
        way = [x / v for x in now.velocity]
        sense = self.sense

        def told(y):
            big, small = self.speeds(y)
            turn, x, z = sense * y[1], y[3], sense * y[4]
            c, d = gmpy2.cos(turn) * big, gmpy2.sin(turn) * big
            return now.at(
                t=now.t if self.frozen else y[8],
                velocity=[way[0] * c - way[1] * d, way[1] * c + way[0] * d],
                w=sense * small / self.a,
                place=[now.place[0] + way[0] * x - way[1] * z, now.place[1] + way[1] * x + way[0] * z],
                psi=now.psi + sense * y[5],
                heat=now.heat + y[6],
                work=now.work + y[7],
            )

        rates = self.by_turning if self.drilling else self.flow
        y = [
            v if self.drilling else gmpy2.log(v),
            ZERO,
            s if self.drilling else gmpy2.log(s),
            *[ZERO] * 5,
            now.t,
        ]
        ring = self.scene.face != "disc"
        self.part, self.arc_at = ring and self.inside(y) < 0, None
        least = (v + s) * self.fades
        while True:
            events = [("sample", lambda y: times[0] - y[8])] if times else []
            if ring:
                side = -1 if self.part else 1
                events.append(("border", lambda y, side=side: side * self.inside(y)))
            if self.drilling:
                events.append(("straight", lambda y: y[2]))
            else:
                events.append(("fades", lambda y: sum(self.speeds(y)) - least))
            name, y, n = self.col.follow(rates, y, self.reach(y), events, self.reach)
            self.steps += n
            if name == "border":
                self.part = not self.part
                continue
            if name == "sample":
                times.pop(0)
                yield ("pushed" if self.frozen else name), told(y)
                if self.frozen or (not times and not self.scene.to_rest):
                    return
            elif name == "straight":
                y[2] = ZERO
                now = told(y).at(w=ZERO)
                self.drilling = ZERO
                yield name, now
                yield from self.plain(now, times)
                return
            else:
                name = "rests"
                fast = self.flow([np.array([x]) for x in y])
                v, s = self.speeds(y)
                y[8] += (v + s) * (v + s) / self.mu / -(fast[0][0] * v + fast[2][0] * s)
                yield name, told(y).at(velocity=[ZERO, ZERO], w=ZERO)
                return

    def plain(self, now, times):
        """Only slides, or only spins: uniformly slower."""
        v, w = gmpy2.hypot(*now.velocity), now.w
        if not v and not w:
            for t in times:
                yield "sample", now.at(t=t)
            yield "rests", now
            return
        if v:
            duration, _inertia = v / self.mu, ONE
        else:
            couple = self.mu * self.a * (ONE if self.scene.face != "disc" else mpfr(2) / 3)
            duration = self.i3 * abs(w) / (couple + self.drilling)
        energy = (v * v + self.i3 * w * w) / 2
        shared = ONE if v else couple / (couple + self.drilling)

        def at(t):
            left = 1 - t / duration
            way = ZERO if self.frozen else t - t * t / (2 * duration)
            gone = energy * (1 - left * left)
            return now.at(
                t=now.t if self.frozen else now.t + t,
                velocity=[x * left for x in now.velocity],
                w=w * left,
                place=[p + x * way for p, x in zip(now.place, now.velocity, strict=False)],
                psi=now.psi + w * way,
                heat=now.heat + gone * shared,
                work=now.work + gone * (1 - shared),
            )

        while times and times[0] - now.t < duration:
            yield ("pushed" if self.frozen else "sample"), at(times.pop(0) - now.t)
            if not times and (self.frozen or not self.scene.to_rest):
                return
        yield "rests", at(duration).at(velocity=[ZERO, ZERO], w=ZERO)

    def film(self, now, times):
        """Viscous friction: a complex velocity, any pressure."""

        def rates(values):
            _t, _x, _y, vx, vy, w, _psi, _heat, _ = values
            below = 1 + (self.mu * self.z * w) ** 2
            turn = self.mu * self.z * w
            fx, fy = -self.mu * (vx - vy * turn) / below, -self.mu * (vy + vx * turn) / below
            couple = -self.mu * w * (self.a**2 - self.z**2 * (fx * fx + fy * fy))
            return [w * 0 + 1, vx, vy, fx, fy, couple / self.i3, w, -(fx * vx + fy * vy) - couple * w, w * 0]

        y = [now.t, *now.place, *now.velocity, now.w, now.psi, now.heat, now.work]
        while times:
            _, y, n = self.col.follow(
                rates, y, mpfr("0.5"), [("sample", lambda y: times[0] - y[0])], lambda y: ONE
            )
            self.steps += n
            times.pop(0)
            yield "sample", now.at(t=y[0], place=y[1:3], velocity=y[3:5], w=y[5], psi=y[6], heat=y[7])

    def friction(self, now):
        v, s = gmpy2.hypot(*now.velocity), self.a * abs(now.w)
        if self.scene.law == "viscous":
            z = gmpy2.mpc(*now.velocity)
            f = -self.mu * z / gmpy2.mpc(1, -self.mu * self.z * now.w)
            return f.real, f.imag
        if not v:
            return ZERO, ZERO
        way = [x / v for x in now.velocity]
        if not s:
            return -self.mu * way[0], -self.mu * way[1]
        gx, gy, _ = (x[0] for x in self.closure(np.array([v]), np.array([s])))
        gy = -gy if now.w < 0 else gy
        return -self.mu * (gx * way[0] - gy * way[1]), -self.mu * (gx * way[1] + gy * way[0])

    # A planar motion on one rim: theta, its rate, and the impulse of the weight.

    def lever(self, theta):
        """How far the centre is from the contact, along the lean and up."""
        s, c = sin(theta), cos(theta)
        return self.a * c - self.z * s, self.a * s + self.z * c

    def reduced(self, way):
        def rates(values):
            t, theta, turn, _run = values
            out, up = self.lever(theta)
            j = self.i1 + out * out
            if way == 0:
                bend = -out / (j + up * up)
            else:
                # N = 1 + up'', up'' = out bend - up turn^2; i1 bend = -out N + up F with F = -mu way N
                push = -(out + self.mu * way * up)
                bend = push * (1 - up * turn**2) / (self.i1 - push * out)
            return [t * 0 + 1, turn, bend, -up * turn]

        return rates

    def reduced_force(self, y):
        out, up = self.lever(y[1])
        bend = -out / (self.i1 + out * out + up * up)
        return -up * bend - out * y[2] ** 2, 1 + out * bend - up * y[2] ** 2

    def rim(self, now, times):
        """The same as of the other formulation; u_h and the heat by conservation."""
        y = [now.t, now.theta, -now.w2, ZERO]
        slip, place, heat = now.u_h, now.place[0], now.heat
        times = [mpfr(t) for t in times]
        h = 1 if now.phi == 0 else -1
        way = (1 if slip > 0 else -1) if slip else self.sticks(y)
        start = list(y)

        def energy(y, u):
            out, up = self.lever(y[1])
            return up + ((u - up * y[2]) ** 2 + (out * y[2]) ** 2 + self.i1 * y[2] ** 2) / 2

        def slip_at(y):
            """By the impulse of the table: the weight's, and that of the centre's rate of rise."""
            if way == 0:
                return ZERO
            (out0, up0), (out, up) = self.lever(start[1]), self.lever(y[1])
            fallen = y[0] - start[0] + out * y[2] - out0 * start[2]
            return slip - up0 * start[2] - self.mu * way * fallen + up * y[2]

        def told(y, u):
            out0, _ = self.lever(start[1])
            out, up = self.lever(y[1])
            if way == 0:
                moved = out - out0
            else:
                # twice integrated: v_h = v_0 - mu way (t + z')
                v0 = slip - self.lever(start[1])[1] * start[2]
                t, out_s, up_s = y[0] - start[0], self.lever(start[1])[0], self.lever(start[1])[1]
                moved = v0 * t - self.mu * way * (t * t / 2 + (up - up_s) - out_s * start[2] * t)
            return now.at(
                t=y[0],
                theta=y[1],
                w2=-y[2],
                u_h=u,
                place=[place + h * moved, now.place[1]],
                heat=heat + energy(start, slip) - energy(y, u),
                velocity=[h * (u - up * y[2]), ZERO],
            )

        while True:
            events = [("lands", lambda y: y[1])]
            if times:
                events.append(("sample", lambda y: times[0] - y[0]))
            if way:
                events.append(("slip ends", lambda y, way=way: way * slip_at(y)))
            else:

                def spare(y):
                    f, n = self.reduced_force(y)
                    return self.mu * n - abs(f)

                events.append(("slips", spare))
            name, y, n = self.col.follow(
                self.reduced(way), y, self.first_step(now), events, lambda y: mpfr("0.3")
            )
            self.steps += n
            if name == "lands":
                y[1] = ZERO
            u = ZERO if name == "slip ends" else slip_at(y)
            out = told(y, u)
            if name in ("slip ends", "slips"):
                start, slip, place, heat = list(y), u, out.place[0], out.heat
                if name == "slips":
                    way = -1 if self.reduced_force(y)[0] > 0 else 1
                else:
                    way = self.sticks(y)
                    name = "passes" if way else "rolls"
            yield name, out
            if name == "lands":
                return
            if name == "sample":
                times.pop(0)
                if not times and not self.scene.to_rest:
                    return

    def sticks(self, y):
        f, n = self.reduced_force(y)
        return 0 if abs(f) <= self.mu * n else (-1 if f > 0 else 1)

    def land(self, now):
        """The planar landing in closed form: v is the centre's velocity towards the new point, W the rate."""
        a, z, i1, mu = self.a, self.z, self.i1, self.mu
        rate = now.w2
        n = 1 if now.phi == 0 else -1
        v = now.u_h + z * rate  # the old slip is u = v - Z W, along the lean, which is towards the new point
        before = v * v + (a * a + i1) * rate**2
        found = []
        weight = a * rate
        for q, way in ((-v, 0), (-mu * weight, 1), (mu * weight, -1)):
            new = (weight + (i1 * rate - z * q) / a) / 2
            if weight - new < 0 or new < 0 or (abs(q) > mu * weight if way == 0 else (v + q) * way <= 0):
                continue
            found.append(("stands", v + q, ZERO, ZERO))
        j = i1 + z * z + a * a
        grip = (rate * (j - 2 * a * a) + z * (v - z * rate)) / j
        # grips: angular momentum about the new point; u = v - Z W is the slip of the old point
        q, p = z * grip - v, a * (rate + grip)
        if grip > 0 and abs(q) <= mu * p:
            found.append(("rocks", v + q, grip, ZERO))
        for way in (1, -1):
            p = 2 * a * rate / (1 + a * a / i1 - mu * way * a * z / i1)
            turn, q = p / a - rate, -mu * way * p
            slip = v + q - z * turn
            if turn > 0 and slip * way > 0:
                found.append(("rocks", v + q, turn, slip))
        assert len(found) == 1, found
        what, v1, turn, slip = found[0]
        inertia = i1 + (a * a if what == "rocks" else 0)
        heat = now.heat + (before - v1 * v1 - inertia * turn**2) / 2
        if what == "stands":
            return what, now.at(theta=ZERO, w2=ZERO, velocity=[n * v1, ZERO], heat=heat, u_h=ZERO, w=ZERO)
        phi = gmpy2.const_pi() if n > 0 else ZERO
        return what, now.at(
            w2=-turn, u_h=-slip, phi=phi, psi=now.psi + now.phi - phi, heat=heat, velocity=[n * v1, ZERO]
        )

    # One rim in space, as it topples: Lagrange's equations.

    def topple(self, now, times):
        vx, vy = now.velocity
        v = gmpy2.hypot(vx, vy)
        edge = gmpy2.mpc(vx, vy) / v * gmpy2.exp(gmpy2.mpc(0, gmpy2.asin(self.a * now.w / v)))
        phi = gmpy2.atan2(edge.imag, edge.real) + gmpy2.const_pi()
        lam, mu = self.lam, self.mu
        normal = 1 / (1 - (lam - 1) * self.a**2 / self.i1)
        c = (lam - 1) * self.a * normal / self.i1
        nu = now.w * (self.i3 / self.i1) * (lam - 1) / (3 * lam - 2)
        psi = now.psi + now.phi - phi
        p = self.i3 * now.w
        yield "topples", self.space_told(None, now, [edge.real, edge.imag])
        # t, theta, theta', phi, p_phi - p_psi cos theta, p_psi, psi, x, y, vx, vy, heat
        y = [now.t, ZERO, ZERO, phi, ZERO, p, psi, *now.place, vx, vy, now.heat]
        few = Collocation(12)
        h = mpfr("0.015")
        t = few.nodes * h
        theta = c * t * t / 2
        away = self.a * now.w
        guess = [
            now.t + t,
            theta,
            c * t,
            phi + nu * t,
            self.i1 * theta**2 * nu,
            p + t * 0,
            psi + (now.w - nu) * t,
            now.place[0] + vx * t,
            now.place[1] + vy * t,
            vx - mu * normal * edge.real * t,
            vy - mu * normal * edge.imag * t,
            now.heat + mu * normal * gmpy2.sqrt(v * v - away * away) * t,
        ]
        y = few.implicit(self.lagrange, y, h, np.array(guess))
        times = [mpfr(x) for x in times]
        while times:
            name, y, k = self.col.follow(
                self.lagrange, y, y[0] / 5, [("sample", lambda y: times[0] - y[0])], lambda y: y[0] / 5
            )
            self.steps += k
            times.pop(0)
            u_h, u_2, w1 = self.slipping(y)
            yield (
                name,
                now.at(
                    t=y[0],
                    place=y[7:9],
                    velocity=y[9:11],
                    theta=y[1],
                    w1=w1,
                    w2=-y[2],
                    w3=y[5] / self.i3,
                    u_h=u_h,
                    u_2=u_2,
                    phi=y[3],
                    psi=y[6],
                    heat=y[11],
                    rim=True,
                ),
            )

    def slipping(self, y):
        _, theta, turn, phi, about, p, _psi, _, _, vx, vy, _ = y
        s, _c = sin(theta), cos(theta)
        w1, w3 = about / (self.i1 * s), p / self.i3
        _, up = self.lever(theta)
        along, across = vx * cos(phi) + vy * sin(phi), vy * cos(phi) - vx * sin(phi)
        return along + up * turn, across + self.z * w1 - self.a * w3, w1

    def lagrange(self, values):
        t, theta, turn, phi, about, p, _psi, _x, _y, vx, vy, _heat = values
        s, c = sin(theta), cos(theta)
        out, up = self.lever(theta)
        u_h, u_2, _w1 = self.slipping(values)
        size = sqrt(u_h * u_h + u_2 * u_2)
        dx, dy = u_h / size, u_2 / size
        precession = about / (self.i1 * s * s)
        free = precession * (self.i1 * precession * c - p) * s
        push = -(out + self.mu * dx * up)
        bend = (free + push * (1 - up * turn**2)) / (self.i1 - push * out)
        normal = 1 + out * bend - up * turn**2
        f, g = -self.mu * normal * dx, -self.mu * normal * dy
        fx, fy = f * cos(phi) - g * sin(phi), f * sin(phi) + g * cos(phi)
        return [
            t * 0 + 1,
            turn,
            bend,
            precession,
            self.z * s * g + p * s * turn,
            -self.a * g,
            p / self.i3 - precession * c,
            vx,
            vy,
            fx,
            fy,
            self.mu * normal * size,
        ]
