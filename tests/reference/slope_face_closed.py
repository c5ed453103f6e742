"""The other formulation of slope_face.py: closed means over the face, in units in which the table is level.

With the time sqrt(cos b) t and velocities over sqrt(cos b) the table is a level one of g = 1 that pulls by tan b downhill.
What slides and spins is told by v over the speed s = a |w| of the rim, the logarithm of s, and the integral of
mu dt/(|v| + s); the means over a ring are Bulirsch's integrals. What does not spin, and what tips without slip, have
closed solutions.
"""

import face_closed
import gmpy2
import numpy as np
from face_closed import ONE, ZERO, double_exponential, exp, sqrt
from face_vectors import cos, narrowed, sin, widened
from gauss import legendre
from gmpy2 import mpfr

NEAR = mpfr("1e-10")
EDGE = 1 + mpfr("1e-14")  # below it the part that would not press is lost


def both(q, apart, root=sqrt):
    """(2/pi) int cos^2/D and (2/pi) (1 - q^2) int sin^2/D over a quarter turn, D^2 = 1 - q^2 sin^2; apart = 1 - q."""
    kc2 = apart * (1 + q)
    least = mpfr("1e-28") if root is sqrt else 1e-11
    out = []
    for a, b in ((1, 0), (0, 1)):
        k = root(kc2)
        a, b = k * 0 + a, k * 0 + b
        e, p, m = k, k * 0 + 1, k * 0 + 1
        for _ in range(30):
            f, a = a, a + b / p
            g = e / p
            b, p = 2 * (b + f * g), g + p
            g, m = m, k + m
            if max(np.ravel(abs(g - k) / g)) < least:
                break
            k = 2 * root(e)
            e = k * m
        out.append((b + a * m) / (m * (m + p)))
    return out[0], kc2 * out[1]


class Closed(face_closed.Closed):
    """One scene."""

    def __init__(self, scene):
        super().__init__(scene)
        slope = mpfr(scene.slope)
        self.pull, self.level = gmpy2.tan(slope), gmpy2.cos(slope)
        self.slow = gmpy2.sqrt(self.level)
        self.air = self.air / self.slow
        self.viscous = scene.law == "viscous"
        self.given, self.arcs = None, {}
        if self.viscous:
            self.mu = self.mu * self.slow

    # Means for s = 1 and v = k along x, of which the first one is over k.

    @staticmethod
    def means(k, apart, root=sqrt):
        """f/k, g, c2, a1, m2 of the uniform pressure; apart = |1 - k|."""
        low = k <= 1
        safe = np.where(k == 0, k * 0 + 1, k)
        q = np.where(low, k, 1 / safe)
        b, d = both(q, np.where(low, apart, apart / safe), root)
        p, r, s, t, u = q * b, b + d, (2 * b + d) / 3, (b + 2 * d) / 3, q * (b - d) / 3
        return (
            np.where(low, b, r / safe),
            np.where(low, r, p),
            np.where(low, s, q * s),
            np.where(low, -t, -u),
            np.where(low, -u, -t),
        )

    def closure(self, k):
        """G_x/k, G_y/k and g."""
        if self.given is not None:
            return self.given
        if self.scene.face == "disc":
            return [widened(x) for x in self.of_rings(narrowed(k))]
        if self.part:
            full = self.shared(k, self.lam, 2, *self.means(k, abs(k - 1)))
            for i in np.nonzero((2 * self.lam * k) ** 2 * (full[0] ** 2 + full[1] ** 2) > EDGE)[0]:
                gx, gy, full[2][i] = self.near_arc(k[i], (len(k), i))
                full[0][i], full[1][i] = gx / k[i], gy / k[i]
            return full
        return self.shared(k, self.lam, 2, *self.means(k, abs(k - 1)))

    def near_arc(self, k, key):
        """G and g where a part presses, from the arc and the slopes of the last k of this node."""
        found = self.arcs.get(key)
        if found is not None and abs(k - found[0]) < abs(k - 1) / 4:
            _, middle, half, (ax, ay, bx, by) = found
            det, before = ax * by - bx * ay, ONE
            for _ in range(12):
                gx, gy, g, r = self.arc_means(middle, half, k, ONE)
                rx = r * gmpy2.cos(middle) - self.lam * gx
                ry = r * gmpy2.sin(middle) - self.lam * gy
                left = max(abs(rx), abs(ry))
                if left < mpfr("1e-22"):
                    self.arcs[key] = k, middle, half, found[3]
                    return gx, gy, g
                if left > before / 20:
                    break
                before = left
                middle, half = middle - (rx * by - bx * ry) / det, half - (ax * ry - rx * ay) / det
        gx, gy, g = self.arc(k, ONE)
        (middle, half), d, ways = self.arc_at, mpfr("1e-18"), []
        for dm, dh in ((d, 0), (0, -d)):
            x, y, _, r = self.arc_means(middle + dm, half + dh, k, ONE)
            x, y = (
                r * gmpy2.cos(middle + dm) - self.lam * x,
                r * gmpy2.sin(middle + dm) - self.lam * y,
            )
            ways += [x / (dm + dh), y / (dm + dh)]
        self.arcs[key] = k, middle, half, ways
        return gx, gy, g

    @staticmethod
    def shared(k, lam, factor, f, g, c2, a1, m2):
        gx = f / (1 - (factor * lam) ** 2 * c2 * a1)
        gy = factor * lam * c2 * gx
        return gx, gy, g + factor * lam * k * gy * m2

    def of_rings(self, k):
        """A disc as its rings, with 64 bits: p = 1 + 4 X . x, of which the ring of radius r has the mean 1 and the slope 4 r."""
        nodes, ends, weights = (narrowed(x) for x in double_exponential())
        k = np.maximum(k, np.longdouble("1e-30"))[:, None]
        assert k.max() < 1
        r = np.concatenate([k * nodes, k + (1 - k) * nodes], axis=1)
        gap = np.concatenate([k * ends, (1 - k) * nodes], axis=1)  # |r - k|
        share = 2 * r * np.concatenate([k * weights, (1 - k) * weights], axis=1)
        f, g, c2, a1, m2 = self.means(k / r, gap / r, np.sqrt)

        def total(x):
            return (x * share).sum(axis=1)

        sums = total(f / r), total(r * g), total(r * c2), total(r * a1), total(r * r * m2)
        return self.shared(k[:, 0], narrowed(self.lam), 4, *sums)

    # Motion on the face.

    def flow(self, values):
        kx, ky, small, _x, _y, _psi, _heat, _work, _t = values
        k, s = sqrt(kx * kx + ky * ky), exp(small)
        gx, gy, g = self.closure(k)
        pace, turn = (1 + k) / self.mu, gy * self.sense
        faster = -(self.mu * self.a**2 * g + self.air * s) / self.i3  # of s
        ax, ay = self.pull - self.mu * (gx * kx - turn * ky), -self.mu * (gx * ky + turn * kx)
        w = s / self.a
        return [
            (ax - kx * faster) * pace,
            (ay - ky * faster) * pace,
            faster * pace,
            s * kx * s * pace,
            s * ky * s * pace,
            w * s * pace,
            self.mu * (k * k * gx + g) * s * s * pace,
            self.air * w * w * s * pace,
            s * pace,
        ]

    def margin(self, y):
        """Positive while the whole ring presses."""
        k = np.array([gmpy2.hypot(y[0], y[1])])
        gx, gy, _ = self.shared(k, self.lam, 2, *self.means(k, abs(k - 1)))
        return (1 - 4 * self.lam**2 * k * k * (gx**2 + gy**2))[0]

    def reach(self, y):
        k = gmpy2.hypot(y[0], y[1])
        rates = [x[0] for x in self.flow([np.array([x]) for x in y])]
        if not k:
            return mpfr("0.3")
        turn = (y[0] * rates[0] + y[1] * rates[1]) / k
        far, pace, most = abs(k - 1), abs(turn), mpfr("0.6") * (1 + k) / (gmpy2.hypot(*rates[:2]) + 1)
        if self.part:  # where the whole ring begins to press the law is not smooth
            step = mpfr("1e-15")
            gone = abs(
                self.margin([x + step * f for x, f in zip(y[:2], rates, strict=False)]) - self.margin(y)
            )
            most = min(most, max(mpfr("0.7") * abs(self.margin(y)), NEAR) * step / gone)
        if far < self.jump:
            return min(most, 2 * far / pace)
        return min(most, mpfr("0.75") * far / pace) if pace else most

    def leveled(self, now, back=False):
        """A state in units of the level table, or back."""
        f = 1 / self.slow if not back else self.slow
        rates = {name: getattr(now, name) * f for name in ("w", "w1", "w2", "w3", "u_h", "u_2")}
        return now.at(
            t=now.t / f,
            velocity=[x * f for x in now.velocity],
            heat=now.heat * f * f,
            work=now.work * f * f,
            **rates,
        )

    def slide(self, now, times):
        now = self.leveled(now)
        times_here = [mpfr(t) * self.slow for t in times]
        if self.viscous:
            found = self.film(now, times_here)
        else:
            found = self.spins(now, times_here) if now.w else self.block(now, times_here)
        for name, at in found:
            if name == "sample":
                times.pop(0)
            yield name, self.leveled(at, back=True)

    def spins(self, now, times):
        sense = self.sense = -1 if now.w < 0 else 1
        s = self.a * abs(now.w)
        y = [*(x / s for x in now.velocity), gmpy2.log(s), *now.place, now.psi, now.heat, now.work, now.t]

        def told(y):
            s = gmpy2.exp(y[2])
            return now.at(
                t=y[8],
                velocity=[s * y[0], s * y[1]],
                w=sense * s / self.a,
                place=y[3:5],
                psi=now.psi + sense * (y[5] - now.psi),
                heat=y[6],
                work=y[7],
            )

        def size(y):
            return gmpy2.exp(y[2]) * (1 + gmpy2.hypot(y[0], y[1]))

        least = size(y) * self.fades
        ring = self.scene.face == "ring"
        self.part, self.arc_at = ring and self.margin(y) < 0, None
        while True:
            events = [("sample", lambda y: times[0] - y[8])] if times else []
            if ring:
                side = -1 if self.part else 1
                events.append(("border", lambda y, side=side: side * self.margin(y)))
            events.append(("fades", lambda y: size(y) - least))
            name, y, n = self.col.follow(self.flow, y, self.reach(y), events, self.reach)
            self.steps += n
            if name == "border":
                self.part = not self.part
            elif name == "sample":
                times.pop(0)
            elif name == "fades":
                fast = [x[0] for x in self.flow([np.array([x]) for x in y])]
                k = gmpy2.hypot(y[0], y[1])
                # |v| + s = s (1 + k), whose rate in time is this
                rate = fast[2] * (1 + k) + (y[0] * fast[0] + y[1] * fast[1]) / k
                y[8] -= gmpy2.exp(y[2]) * (1 + k) / (rate / fast[8] * gmpy2.exp(y[2]))
                yield "rests", told(y).at(velocity=[ZERO, ZERO], w=ZERO)
                return
            yield name, told(y)
            if not (times or self.scene.to_rest):
                return

    def fold(self, now):
        """From where a part of the ring presses until no pressure can hold the body down, as it leaves the face.

        The arc is carried along; the pace is that of the integral times the determinant of the equations of its rates.
        """
        now = self.leveled(now)
        sense = self.sense = -1 if now.w < 0 else 1
        s, sign, d = self.a * abs(now.w), [1], mpfr("1e-22")
        self.part = True
        self.arc(gmpy2.hypot(*now.velocity) / s, ONE)
        y = [*(x / s for x in now.velocity), gmpy2.log(s), *now.place, now.psi, now.heat, now.work, now.t]
        y += self.arc_at

        def residual(k, middle, half):
            gx, gy, g, r = self.arc_means(middle, half, k, ONE)
            return r * gmpy2.cos(middle) - self.lam * gx, r * gmpy2.sin(middle) - self.lam * gy, (gx, gy, g)

        def solved(k, middle, half):
            """Means, the determinant, and how the arc changes with k, times that."""
            moves = (d, 0, 0), (0, d, 0), (0, 0, d)
            ways = []
            for dk, dm, dh in moves:
                one, other = (
                    residual(k + dk, middle + dm, half + dh),
                    residual(k - dk, middle - dm, half - dh),
                )
                ways.append([(one[i] - other[i]) / (2 * d) for i in (0, 1)])
            (kx, ky), (ax, ay), (bx, by) = ways
            return (
                *residual(k, middle, half)[2], ax * by - bx * ay, -(by * kx - bx * ky), -(ax * ky - ay * kx),
            )  # fmt: skip

        def rates(values):
            kx, ky = values[:2]
            k = sqrt(kx * kx + ky * ky)
            found = [solved(*x) for x in zip(k, *values[9:], strict=True)]
            gx, gy, g, det, *turn = (np.array(x) for x in zip(*found, strict=True))
            self.given = gx / k, gy / k, g
            each = self.flow(values[:9])
            self.given = None
            k_rate = (kx * each[0] + ky * each[1]) / k
            return [*(x * det * sign[0] for x in each), *(x * k_rate * sign[0] for x in turn)]

        def det(y):
            return solved(gmpy2.hypot(*y[:2]), *y[9:])[3] * sign[0]

        sign[0] = 1 if det(y) > 0 else -1

        def longest(y):
            r = [x[0] for x in rates([np.array([x]) for x in y])]
            k = gmpy2.hypot(*y[:2])
            far, pace = abs(k - 1), abs(y[0] * r[0] + y[1] * r[1]) / k
            step = mpfr("0.2") / max(abs(r[9]), abs(r[10]))
            return min(step, (2 * far if far < self.jump else mpfr("0.75") * far) / pace)

        _, y, n = self.col.follow(rates, y, longest(y), [("fold", det)], longest)
        self.steps += n
        s = gmpy2.exp(y[2])
        there = now.at(
            t=y[8], velocity=[s * y[0], s * y[1]], w=sense * s / self.a, place=y[3:5],
            psi=now.psi + sense * (y[5] - now.psi), heat=y[6], work=y[7],
        )  # fmt: skip
        return self.leveled(there, back=True)

    def block(self, now, times):
        """Without spin: |v| sin chi tan(chi/2)^(-mu/tan b) is constant, chi the angle of v from downhill."""
        vx, vy = now.velocity
        m, p = self.mu / self.pull, self.pull
        first = abs(vy) / (gmpy2.hypot(vx, vy) + vx)  # tan(chi/2)
        sign = -1 if vy < 0 else 1
        c = 2 * gmpy2.hypot(vx, vy) / ((1 + first**2) * first ** (m - 1))

        def since(t, a, b):
            """The integral of t^a + t^b."""
            return sum((first ** (q + 1) - t ** (q + 1)) / (q + 1) for q in (a, b))

        def told(tan):
            x = c * c / (4 * p) * (since(tan, 2 * m - 3, 2 * m - 3) - since(tan, 2 * m + 1, 2 * m + 1)) / 2
            y = c * c / (2 * p) * since(tan, 2 * m - 2, 2 * m)
            v = c * (1 + tan**2) / 2 * tan ** (m - 1)
            chi = 2 * gmpy2.atan(tan)
            begun = (vx * vx + vy * vy) / 2
            return now.at(
                t=now.t + c / (2 * p) * since(tan, m - 2, m),
                place=[now.place[0] + x, now.place[1] + sign * y],
                velocity=[v * gmpy2.cos(chi), sign * v * gmpy2.sin(chi)],
                heat=now.heat + begun + p * x - v * v / 2,
            )

        for t in list(times):
            low, high = ZERO, first
            for _ in range(260):
                tan = (low + high) / 2
                low, high = (low, tan) if told(tan).t < t else (tan, high)
            yield "sample", told((low + high) / 2).at(t=t)
        if self.scene.to_rest:
            yield "rests", told(ZERO).at(velocity=[ZERO, ZERO])

    def film(self, now, times):
        """Viscous friction: a complex velocity, any pressure."""

        def drag(vx, vy, w):
            turn = self.mu * self.z * w
            below = 1 + turn * turn
            return -self.mu * (vx - vy * turn) / below, -self.mu * (vy + vx * turn) / below

        def rates(values):
            _t, _x, _y, vx, vy, w, _psi, _heat = values
            fx, fy = drag(vx, vy, w)
            couple = -self.mu * w * (self.a**2 - self.z**2 * (fx * fx + fy * fy))
            return [
                w * 0 + 1, vx, vy, fx + self.pull, fy, couple / self.i3, w, -(fx * vx + fy * vy) - couple * w,
            ]  # fmt: skip

        y = [now.t, *now.place, *now.velocity, now.w, now.psi, now.heat]
        while times:
            events = [
                ("sample", lambda y: times[0] - y[0]),
                ("topples", lambda y: self.a - self.z * gmpy2.hypot(*drag(*y[3:6]))),
            ]
            name, y, n = self.col.follow(rates, y, mpfr("0.3"), events, lambda y: ONE)
            self.steps += n
            if name == "sample":
                times.pop(0)
            yield name, now.at(t=y[0], place=y[1:3], velocity=y[3:5], w=y[5], psi=y[6], heat=y[7])
            if name == "topples":
                return

    def friction(self, now):
        vx, vy = (x / self.slow for x in now.velocity)
        v, w = gmpy2.hypot(vx, vy), now.w / self.slow
        if self.viscous:
            f = -self.mu * gmpy2.mpc(vx, vy) / gmpy2.mpc(1, -self.mu * self.z * w)
            return self.level * f.real, self.level * f.imag
        if not w:
            return (-self.mu * self.level * vx / v, -self.mu * self.level * vy / v) if v else (ZERO, ZERO)
        s, self.sense = self.a * abs(w), -1 if w < 0 else 1
        gx, gy, _ = (x[0] for x in self.closure(np.array([v / s])))
        push, turn = self.mu * self.level / s, gy * self.sense
        return -push * (gx * vx - turn * vy), -push * (gx * vy + turn * vx)

    # Of one rim in the plane of the slope's fall, over the lower point.

    def tipping(self, now, sticks, times):
        now = self.leveled(now)
        far = times
        times = [mpfr(t) * self.slow for t in times]
        for at in self.still(now, times) if sticks else self.slips(now, times):
            far.pop(0)
            yield "sample", self.leveled(at, back=True)

    def still(self, now, times):
        """An inverted pendulum about a fixed point: its energy, and the time by an integral over the lean."""
        inertia = self.i1 + self.a**2 + self.z**2
        assert self.pull * self.z > self.a

        def fallen(lean):
            """The energy of the turning at this lean: what the centre comes down by, up and along the table."""
            half = gmpy2.sin(lean / 2)
            # a - (a cos - z sin), a sin + z cos - z
            along, up = 2 * self.a * half**2, self.a * gmpy2.sin(lean) - 2 * self.z * half**2
            return self.pull * (along + self.z * gmpy2.sin(lean)) - up

        places, shares = legendre(60)

        def duration(lean):
            # lean = far u^2
            total = ZERO
            for x, share in zip(places, shares, strict=True):
                there = lean * x * x
                total += share * 2 * lean * x / gmpy2.sqrt(2 * fallen(there) / inertia)
            return total

        for t in times:
            lean, after = mpfr("0.1"), t - now.t
            for _ in range(60):
                change = (after - duration(lean)) * gmpy2.sqrt(2 * fallen(lean) / inertia)
                lean = max(lean / 3, lean + change)
                if abs(change) < mpfr("1e-45"):
                    break
            turn = gmpy2.sqrt(2 * fallen(lean) / inertia)
            c, s = gmpy2.cos(lean), gmpy2.sin(lean)
            moved = self.a - (self.a * c - self.z * s)
            yield now.at(
                t=t,
                place=[now.place[0] + moved, now.place[1]],
                velocity=[turn * (self.a * s + self.z * c), ZERO],
                theta=lean,
                w2=-turn,
                u_h=ZERO,
                u_2=ZERO,
                rim=True,
            )

    def slips(self, now, times):
        """The lean does not feel the pull while the rim slips at a constant coefficient."""

        def lever(lean):
            s, c = sin(lean), cos(lean)
            return self.a * c - self.z * s, self.a * s + self.z * c

        def rates(values):
            _t, lean, turn, v, _x, _heat = values
            out, up = lever(lean)
            u = v - up * turn
            drag = self.mu * (u if self.viscous else 1)
            push = drag * up - out
            bend = push * (1 - up * turn**2) / (self.i1 - push * out)
            n = 1 + out * bend - up * turn**2
            return [u * 0 + 1, turn, bend, self.pull - drag * n, v, drag * n * u]

        y = [now.t, ZERO, ZERO, now.velocity[0], now.place[0], now.heat]
        while times:
            _, y, n = self.col.follow(
                rates, y, mpfr("0.05"), [("sample", lambda y: times[0] - y[0])], lambda y: mpfr("0.2")
            )
            self.steps += n
            times.pop(0)
            t, lean, turn, v, x, heat = y
            yield now.at(
                t=t,
                place=[x, now.place[1]],
                velocity=[v, ZERO],
                theta=lean,
                w2=-turn,
                u_h=-(v - lever(lean)[1] * turn),
                u_2=ZERO,
                heat=heat,
                rim=True,
            )

    # As it topples in space: of the level table, with a pull downhill.

    def lagrange(self, values):
        found = super().lagrange(values)
        found[9] = found[9] + self.pull
        return found
