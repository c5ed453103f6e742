"""Newton's and Euler's equations with sums over the face, one of the two formulations of slope_face.py.

All is told in the axes of the table with the full gravity (sin b, 0, -cos b), in time: the friction of a place of the
face is -mu p u/|u| or -c p u, the pressure p is linear and cut at zero, carries cos b, and has no moment with friction
about the centre of mass. Where a part of a ring presses, both numbers of its arc are found by Newton's method from sums
over the arc, with 64 bits.
"""

import face_vectors
import gmpy2
import numpy as np
from face_vectors import ZERO, cos, narrowed, sin, widened
from gauss import legendre
from gmpy2 import mpfr

PANELS = 12
NEAR = mpfr("1e-10")
EDGE = 1 + mpfr("1e-14")  # below it the part that would not press is lost


class Vectors(face_vectors.Vectors):
    """One scene."""

    def __init__(self, scene):
        super().__init__(scene)
        slope = mpfr(scene.slope)
        self.downhill, self.level = gmpy2.sin(slope), gmpy2.cos(slope)
        self.viscous = scene.law == "viscous"
        self.arcs = self.kept = None

    # On the face.

    def rates(self, values):
        _t, _x, _y, vx, vy, w, _psi, _heat, _work = values
        fx, fy, couple, warm, *_ = self.pressed(vx, vy, w)
        if not self.sense:  # without what is left by rounding
            couple = couple * 0
        lost = self.air * w
        return [
            w * 0 + 1,
            vx,
            vy,
            self.level * fx + self.downhill,
            self.level * fy,
            (self.level * couple - lost) / self.i3,
            w,
            self.level * warm,
            lost * w,
        ]

    def pressed(self, vx, vy, w):
        return self.parts(vx, vy, w) if self.part else super().pressed(vx, vy, w)

    def parts(self, vx, vy, w):
        """Of states of which some press with a part of the ring."""
        full = self.whole(vx, vy, w)
        some = full[5] ** 2 + full[6] ** 2 > EDGE
        if not some.any():
            return full[:4]
        found = self.arc_of(*(x[some] for x in (vx, vy, w, *full[5:])))
        for x, y in zip(full, found, strict=False):
            x[some] = y
        return full[:4]

    def arc_of(self, vx, vy, w, px, py):
        """Where a part of the ring presses: the angle of the middle of the arc from v, and half of the arc."""
        turned = np.array([-1 if x < 0 else 1 for x in w])
        v = face_vectors.sqrt(vx * vx + vy * vy)
        s = self.a * abs(w)
        ex, ey = vx / v, vy / v
        k = v / s
        ahead, k, near = narrowed(k - 1), narrowed(k), narrowed(np.array([abs(gmpy2.log(x)) for x in k]))
        lam = narrowed(self.mu * self.z / self.a)
        if self.arcs is None:
            full = narrowed(px[:1]), narrowed(py[:1])
            size = max(np.hypot(*full)[0] / 2, np.longdouble("0.51"))
            along = full[0] * narrowed(ex[:1]) + full[1] * narrowed(ey[:1])
            across = (full[1] * narrowed(ex[:1]) - full[0] * narrowed(ey[:1])) * turned[0]
            low, high = 0.01, 3.1415
            for _ in range(40):
                half = (low + high) / 2
                inside = (half - np.sin(half) * np.cos(half)) / (2 * (np.sin(half) - half * np.cos(half)))
                low, high = (half, high) if inside > size else (low, half)
            self.arcs = np.arctan2(across, along)[0], np.longdouble(half)
        if self.kept is not None and len(self.kept[0]) == len(k) > 1:  # of the same step, mostly
            middle, half = self.kept
        else:
            middle, half = (np.full(len(k), x) for x in self.arcs)
        quarter = np.arctan2(np.longdouble(1), np.longdouble(0))
        for turn in range(40):
            means, slopes, _ = self.arc_sums(k, ahead, near, middle, half)
            r = [means[i] - lam * means[i + 2] for i in (0, 1)]
            (a, b), (c, d) = ([of[i] - lam * of[i + 2] for of in slopes] for i in (0, 1))
            det = a * d - b * c
            moved = (d * r[0] - b * r[1]) / det, (a * r[1] - c * r[0]) / det
            left = max(np.abs(r[0]).max(), np.abs(r[1]).max())
            if left < 4e-19 or (turn > 10 and left < 4e-18):
                break
            most = np.maximum(np.abs(moved[0]), np.abs(moved[1]))
            slow = np.minimum(1, np.longdouble("0.2") / (most + np.longdouble("1e-30")))
            # what does not press grows as the root of what is to be balanced
            lifted = 2 * quarter - half
            lifted = lifted * np.maximum(lifted + 2 * slow * moved[1], lifted / 16)
            middle, half = middle - slow * moved[0], 2 * quarter - np.sqrt(lifted)
        assert left < 1e-16, left
        if len(k) > 1:
            self.arcs, self.kept = (middle[-1], half[-1]), (middle, half)
        gx, gy, g = map(widened, means[2:])
        force = [-self.mu * (gx * ex - turned * gy * ey), -self.mu * (gx * ey + turned * gy * ex)]
        heat = self.mu * (gx * v + g * s)
        return [*force, -self.mu * self.a * g * turned, heat]

    @staticmethod
    def arc_sums(k, ahead, near, middle, half):
        """Means over an arc of n, the direction of u and the couple, for s = 1 and v = k along x.

        And what they change by with the middle, the half and k; ahead = k - 1, near = |log k|.
        """
        nodes, weights = (narrowed(x) for x in legendre(32))
        quarter = np.arctan2(np.longdouble(1), np.longdouble(0))
        kk, aa, dd = k[:, None, None], ahead[:, None, None], near[:, None, None]
        ends = np.arcsinh((middle - half - quarter) / near), np.arcsinh((middle + half - quarter) / near)
        piece = (ends[1] - ends[0]) / PANELS
        z = ends[0][:, None, None] + piece[:, None, None] * (np.arange(PANELS)[None, :, None] + nodes)
        # from the place of the least slip
        off = dd * np.sinh(z)
        weight = piece[:, None, None] * weights * dd * np.cosh(z)
        lag = 2 * np.sin(off / 2) ** 2
        nx, ny = -np.sin(off), np.cos(off)
        ux, uy = aa + lag, nx
        size = np.sqrt(aa * aa + 2 * kk * lag)
        dx, dy = ux / size, uy / size
        c, d = np.cos(middle)[:, None, None], np.sin(middle)[:, None, None]
        along = nx * c + ny * d
        ps = [
            along - np.cos(half)[:, None, None],
            ny * c - nx * d,
            np.broadcast_to(np.sin(half)[:, None, None], along.shape),
        ]
        found = [
            [(weight * p * q).sum(axis=(1, 2)) for q in (1, nx, ny, dx, dy, nx * dy - ny * dx)] for p in ps
        ]
        total = found[0][0]
        means = [x / total for x in found[0][1:]]
        slopes = [[(x - m * of[0]) / total for x, m in zip(of[1:], means, strict=True)] for of in found[1:]]
        p, cubed = weight * ps[0] / total[:, None, None], size**3
        by_k = [(p * q).sum(axis=(1, 2)) for q in (uy * uy / cubed, -ux * uy / cubed)]
        return means, slopes, by_k

    def fold(self, now):
        """From where a part of the ring presses until no pressure can hold the body down, as it leaves the face.

        The arc is carried along, and dt = det d sigma with the determinant of the equations of its rates, which vanishes.
        From |v| > a |w|, since where these are equal the rates of the arc have a logarithm.
        """
        sense = 1 if now.w > 0 else -1
        lam, sign = narrowed(self.mu * self.z / self.a), []

        def both(values):
            _t, _x, _y, vx, vy, w, _psi, _heat, _work, middle, half = values
            v, s = face_vectors.sqrt(vx * vx + vy * vy), self.a * abs(w)
            k = v / s
            near = np.array([abs(gmpy2.log(x)) for x in k])
            means, slopes, by_k = self.arc_sums(*(narrowed(x) for x in (k, k - 1, near, middle, half)))
            (a, b), (c, d) = ([of[i] - lam * of[i + 2] for of in slopes] for i in (0, 1))
            det = a * d - b * c
            r = [-lam * x for x in by_k]
            turn = -(d * r[0] - b * r[1]), -(a * r[1] - c * r[0])
            return [widened(x) for x in (*means[2:], det, *turn)], v, s

        def rates(values):
            (gx, gy, g, det, *turn), v, s = both(values)
            vx, vy, w = values[3:6]
            det = det * sign[0]
            ex, ey = vx / v, vy / v
            push, f = self.level * self.mu, sense * gy
            ax = self.downhill - push * (gx * ex - f * ey)
            ay = -push * (gx * ey + f * ex)
            slow = (push * self.a * g * sense + self.air * w) / self.i3
            k_rate = (ex * ax + ey * ay + v / s * self.a * slow * sense) / s
            warm, lost = push * (gx * v + g * s), self.air * w * w
            each = [w * 0 + 1, vx, vy, ax, ay, -slow, w, warm, lost]
            return [*(x * det for x in each), *(x * k_rate * sign[0] for x in turn)]

        self.part, self.kept = True, None
        self.pressed(*(np.array([x, x]) for x in (*now.velocity, now.w)))
        arc = [widened(np.array([x]))[0] for x in self.arcs]
        y = [now.t, *now.place, *now.velocity, now.w, now.psi, now.heat, now.work, *arc]

        def det(y):
            return both([np.array([x]) for x in y])[0][3][0] * sign[0]

        sign.append(1)
        sign[0] = 1 if det(y) > 0 else -1

        def longest(y):
            r = [x[0] for x in rates([np.array([x]) for x in y])]
            v, s = gmpy2.hypot(y[3], y[4]), self.a * abs(y[5])
            pace = abs((y[3] * r[3] + y[4] * r[4]) / v - self.a * r[5] * sense)
            far = abs(v - s)
            step = mpfr("0.2") / max(abs(r[9]), abs(r[10]))
            return min(step, (2 * far if far < self.jump * (v + s) else mpfr("0.75") * far) / pace)

        _, y, n = self.col.follow(rates, y, longest(y), [("fold", det)], longest)
        self.steps += n
        return now.at(t=y[0], place=y[1:3], velocity=y[3:5], w=y[5], psi=y[6], heat=y[7], work=y[8])

    def longest(self, y):
        if self.viscous:
            return mpfr(1)
        rates = [x[0] for x in self.rates([np.array([x]) for x in y])[3:6]]
        v, s = gmpy2.hypot(y[3], y[4]), self.a * abs(y[5])
        left = mpfr("0.6") * (v + s) / (gmpy2.hypot(*rates[:2]) + self.a * abs(rates[2]))
        if not s:
            return left
        turns = (y[3] * rates[0] + y[4] * rates[1]) / v if v else gmpy2.hypot(*rates[:2])
        if self.part:  # where the whole ring begins to press the law is not smooth
            step = mpfr("1e-15")
            there = [*y[:3], *(x + step * f for x, f in zip(y[3:6], rates, strict=True))]
            gone = abs(self.margin(there) - self.margin(y)) / step
            left = min(left, max(mpfr("0.7") * abs(self.margin(y)), NEAR) / gone)
        far, pace = abs(v - s), abs(turns - self.a * rates[2] * self.sense)
        if far < self.jump * (v + s):
            return min(left, 2 * far / pace)
        return min(left, mpfr("0.75") * far / pace) if pace else left

    def slide(self, now, times):
        """Goes on along the face: what happens and where."""
        y = [now.t, *now.place, *now.velocity, now.w, now.psi, now.heat, now.work]
        self.sense = (1 if now.w > 0 else -1) if now.w else 0
        begin = self.size(y)
        ring = self.scene.face == "ring" and not self.viscous and self.sense
        self.part = bool(ring and self.margin(y) < 0)
        while True:
            events = [("sample", lambda y: times[0] - y[0])] if times else []
            if ring:
                side = -1 if self.part else 1
                events.append(("border", lambda y, side=side: side * self.margin(y)))
            if self.viscous:
                events.append(("topples", lambda y: self.a - self.z * self.dragged(y)))
            else:
                events.append(("fades", lambda y: self.size(y) - begin * self.fades))
            first = min(self.longest(y), mpfr("0.3"))
            name, y, n = self.col.follow(self.rates, y, first, events, self.longest, scale=self.size)
            self.steps += n
            if name == "border":
                self.part = not self.part
            elif name == "sample":
                times.pop(0)
            elif name == "fades":
                rates = [x[0] for x in self.rates([np.array([x]) for x in y])[3:6]]
                v, s = gmpy2.hypot(y[3], y[4]), self.a * abs(y[5])
                faster = (y[3] * rates[0] + y[4] * rates[1]) / v + self.a * rates[2] * self.sense
                y[0] -= (v + s) / faster
                y[3:6] = [ZERO] * 3
                name = "rests"
            yield (
                name,
                now.at(t=y[0], place=y[1:3], velocity=y[3:5], w=y[5], psi=y[6], heat=y[7], work=y[8]),
            )
            if name in ("rests", "topples") or not (times or self.scene.to_rest):
                return

    def dragged(self, y):
        found = self.whole(*(np.array([x]) for x in y[3:6]))
        return gmpy2.hypot(found[0][0], found[1][0])

    def friction(self, now):
        """The force of the table at a state on the face, told in a scene's units."""
        vx, vy = now.velocity
        if not (vx or vy or now.w):
            return ZERO, ZERO
        self.sense = (1 if now.w > 0 else -1) if now.w else 0
        found = self.pressed(*(np.array([x]) for x in (vx, vy, now.w)))
        return self.level * found[0][0], self.level * found[1][0]

    # Of one rim in the plane of the slope's fall, over the lower point.

    def tipping(self, now, sticks, times):
        """x of the centre, the lean towards downhill, and their rates; the height follows."""

        def corner(lean):
            c, s = cos(lean), sin(lean)
            return self.a * c - self.z * s, -self.a * s - self.z * c

        def rates(values):
            _t, _x, lean, vx, _vz, turn, _heat = values
            rx, rz = corner(lean)
            u = vx + turn * rz
            # vx' = F + downhill, vz' = N - level, i1 turn' = rz F - rx N; the contact does not move up, or at all
            own, up = self.downhill - turn**2 * rx, -self.level - turn**2 * rz
            i1 = self.i1
            if sticks:
                # vx' + turn' rz = turn^2 rx, vz' - turn' rx = turn^2 rz
                a, b, d = 1 + rz * rz / i1, -rx * rz / i1, 1 + rx * rx / i1
                det = a * d - b * b
                f, n = (-own * d + up * b) / det, (-up * a + own * b) / det
            else:
                drag = self.mu * (u if self.viscous else 1)
                n = -up / (1 + rx * (rx + drag * rz) / i1)
                f = -drag * n
            bend = (rz * f - rx * n) / i1
            return [u * 0 + 1, vx, turn, f + self.downhill, n - self.level, bend, -f * u * (not sticks)]

        y = [now.t, now.place[0], ZERO, now.velocity[0], ZERO, ZERO, now.heat]
        while times:
            _, y, n = self.col.follow(
                rates, y, mpfr("0.05"), [("sample", lambda y: times[0] - y[0])], lambda y: mpfr("0.2")
            )
            self.steps += n
            times.pop(0)
            t, x, lean, vx, vz, turn, heat = y
            rx, rz = corner(lean)
            self.strayed = max(getattr(self, "strayed", 0), abs(vz - turn * rx))
            yield (
                "sample",
                now.at(
                    t=t,
                    place=[x, now.place[1]],
                    velocity=[vx, ZERO],
                    theta=lean,
                    w2=-turn,
                    u_h=ZERO if sticks else -(vx + turn * rz),
                    u_2=ZERO,
                    heat=heat,
                    rim=True,
                ),
            )

    # As it topples in space: in the time sqrt(cos b) t, and velocities by it, a level table with a pull downhill.

    def space_rates(self, values):
        found = super().space_rates(values)
        found[4] = found[4] + self.downhill / self.level
        return found
