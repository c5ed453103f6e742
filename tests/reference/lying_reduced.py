"""A body on both rims by the closed equations, one of the two formulations of lying_forms.py."""

import gmpy2
import slip_forms
from gmpy2 import mpfr
from lying_forms import ONE, ZERO, Lying, solved
from vectors import scaled


class Reduced(Lying, slip_forms.Reduced):
    """The closed equations."""

    def __init__(self, scene):
        super().__init__(scene)
        self.prepare(scene)

    def start(self):
        y = super().start()
        if self.scene.lies:
            y[4] = gmpy2.const_pi() / 2
        return y

    def lying(self, kind, signs):
        tape = self.tape()
        slips = low, _ = self.slips(tape, kind)
        for _ in range(3):
            tape.state()
        w1, w3, phi, _, _, _ = (tape.state() for _ in range(6))
        l, i1, i3, zero = self.ell, self.i1, self.i3, tape.constant(0)  # noqa: E741
        one, three = self.couples(tape, signs, w1, w3)
        held = [not signs[0] and self.losses["drilling"] > 0 and kind != "SS"]
        held.append(not signs[1] and self.losses["dry"] + self.losses["rolling"] > 0)
        gyro, free = i3 * (w1 * w3), [None, None]
        if kind == "SS":
            pull = zero if held[1] else three / (1 + i3)
            if held[1]:
                free[1] = zero
            forces = [[zero, pull / 2, zero + mpfr(0.5)] for _ in (0, 1)]
            w1_rate, w3_rate = zero, (three - pull) / i3 if not held[1] else zero
            rates = [[zero, zero], [zero, zero]]
            v_2 = w3
            v_h = zero
        elif kind in ("SL", "LS"):
            side = 1 if kind == "SL" else -1
            v_h, v_2 = zero, w3 - side * l * w1
            pull = -(w1 * v_2)  # along the axis, all at the rim that sticks
            sense = mpfr(signs[2])
            normals = [(l + gyro - pull) / (2 * l), (l - gyro + pull) / (2 * l)]
            slides = self.mu * sense * (normals[1] if side > 0 else -normals[0])
            # u_2' = 0 of the rim that sticks: v_2' + side l w1' - w3' = 0
            own, cross_term = 1 + 1 / i3 + l * l / i1, 1 + 1 / i3 - l * l / i1
            if held[1]:
                own, cross_term = own - 1 / i3, cross_term - 1 / i3
                across = -(cross_term * slides + (side * l / i1) * one) / own
                free[1] = across + slides
            else:
                across = -(cross_term * slides + (side * l / i1) * one - three / i3) / own
            stuck, sliding = [pull, across], [zero, slides]
            both = [stuck, sliding] if side > 0 else [sliding, stuck]
            forces = [[*f, n] for f, n in zip(both, normals, strict=True)]
            w1_rate = (l * forces[0][1] - l * forces[1][1] + one) / i1
            w3_rate = zero if held[1] else (three - forces[0][1] - forces[1][1]) / i3
            whole = across + slides
            other = whole - side * l * w1_rate - w3_rate
            rates = [[zero, zero], [zero, other]]
            rates = rates if side > 0 else rates[::-1]
        else:
            u = low[0]
            pushes = [self.push(slip) for slip in slips]
            if self.scene.law == "viscous":
                normals = [(l + gyro + self.mu * u[0]) / (2 * l)]
                normals.append(1 - normals[0])
            elif not self.mu:
                normals = [(l + gyro) / (2 * l), (l - gyro) / (2 * l)]
            else:
                alpha, beta = pushes[0][0] + l, -pushes[1][0] + l
                normals = [(gyro + beta) / (alpha + beta), (alpha - gyro) / (alpha + beta)]
            forces = [[n * p[0], n * p[1], n] for n, p in zip(normals, pushes, strict=True)]
            f_h, f_2 = forces[0][0] + forces[1][0], forces[0][1] + forces[1][1]
            couple = l * (forces[0][1] - forces[1][1])
            if held[0]:
                free[0] = -couple
                w1_rate = zero
            else:
                w1_rate = (couple + one) / i1
            if held[1]:
                free[1] = f_2 + 0
                w3_rate = zero
            else:
                w3_rate = (three - f_2) / i3
            v_h, v_2 = u[0], u[1] - l * w1 + w3
            along, across = f_h + w1 * v_2, f_2 - w1 * v_h
            rates = [[along, across + side * l * w1_rate - w3_rate] for side in (1, -1)]
        sin_phi, cos_phi = tape.sin_cos(phi)
        moved, aside = v_h, v_2 + l * w1  # of the point on the table below the first rim
        path = [moved * cos_phi - aside * sin_phi, moved * sin_phi + aside * cos_phi]
        moving = [w1_rate + 0, w3_rate + 0, w1 + 0, w3 + 0, *path]
        return self.rates_of(tape, kind, slips, rates, forces, (one, three), free, w1, w3, moving)

    def lie(self, y):
        u_h, u_2, heat, t, _, w1, _, w3, *pose = y
        return [u_h, u_2, u_h, u_2 - 2 * self.ell * w1, heat, self.work, t, w1, w3, *pose]

    def rise(self, y):
        self.work = y[5]
        return [y[0], y[1], y[4], y[6], gmpy2.const_pi() / 2, y[7], ZERO, y[8], *y[9:]]

    def other(self, y):
        whole = gmpy2.const_pi()
        if len(y) == 13:
            low, up, rest = y[0:2], y[2:4], y[4:7]
            w1, w3, phi, psi, a, b = y[7:]
            pose = self.placed(phi, psi, a, b)
            return [*scaled(-1, up), *scaled(-1, low), *rest, w1, -w3, *pose]
        u_h, u_2, heat, t, theta, w1, w2, w3, phi, psi, a, b = y
        # at theta = pi/2, where the contact of the other rim is 2 ell further along -h
        slip = [-u_h, 2 * self.ell * w1 - u_2]
        return [*slip, heat, t, whole - theta, w1, -w2, -w3, *self.placed(phi, psi, a, b)]

    def placed(self, phi, psi, a, b):
        apart = 2 * self.ell
        return [phi + gmpy2.const_pi(), -psi, a - apart * gmpy2.cos(phi), b - apart * gmpy2.sin(phi)]

    def at_rest(self, y, what):
        k = 7 if what == "w1" else 8
        return [*y[:k], ZERO, *y[k + 1 :]]

    def unwound(self, change, ratio):
        """phi gains a whole turn in two landings, which is none."""
        return [x - 2 * gmpy2.const_pi() * ratio / (1 - ratio) if k == 8 else x for k, x in enumerate(change)]

    def settled(self, y):
        return [*y[:4], gmpy2.const_pi() / 2, y[5], ZERO, *y[7:]]

    def falling(self, y):
        return y[6]

    def land(self, y):
        """By cases: which rims stay, and which of them stick."""
        u_h, u_2, heat, t, _, w1, w2, w3, *pose = y
        l, i1, i3, fall = self.ell, self.i1, self.i3, -w2  # noqa: E741
        outcomes = []

        def after(both, q):
            """Normal impulses, and velocities after, for these impulses along and across at either rim."""
            along, across = q[0][0] + q[1][0], q[0][1] + q[1][1]
            if both:
                normal = [
                    (l * l * fall - i1 * fall - along) / (2 * l),
                    (l * l * fall + i1 * fall + along) / (2 * l),
                ]
                new_w2 = ZERO
            else:
                up = (2 * l * fall + l * along / i1) / (1 + l * l / i1)
                normal, new_w2 = [ZERO, up], -fall + (l * up - along) / i1
            new_w1 = w1 + l * (q[0][1] - q[1][1]) / i1
            new_w3 = w3 - across / i3
            v_h, v_2 = u_h + w2 + along, u_2 - l * w1 + w3 + across
            slips = [[v_h - new_w2, v_2 + side * l * new_w1 - new_w3] for side in (1, -1)]
            return normal, slips, (new_w1, new_w2, new_w3)

        for both in (True, False):
            for sticks in ((True, True), (True, False), (False, True), (False, False)):
                if not both and sticks[0]:
                    continue
                found = self.case(after, both, sticks)
                if found is not None:
                    outcomes.append((both, *found))
        distinct = []
        for outcome in outcomes:
            if not any(abs(outcome[3][0] - x[3][0]) + abs(outcome[3][2] - x[3][2]) < 1e-30 for x in distinct):
                distinct.append(outcome)
        ((both, q, (_, slips, (n1, n2, n3)), _),) = distinct
        slips = [[ZERO, ZERO] if gmpy2.hypot(*s) < mpfr("1e-40") else s for s in slips]
        v_h, v_2 = u_h + w2, u_2 - l * w1 + w3
        a_h, a_2 = v_h + q[0][0] + q[1][0], v_2 + q[0][1] + q[1][1]
        own = (
            v_h**2 - a_h**2 + v_2**2 - a_2**2 + i1 * (w1**2 - n1**2 + w2**2 - n2**2) + i3 * (w3**2 - n3**2)
        ) / 2
        # the vertical velocity of the centre is ell w2 before, and that or its mirror image after
        lost = own + l * l * (w2**2 - n2**2) / 2
        if both:
            new = [*slips[0], *slips[1], heat + lost, self.work, t, n1, n3, *pose]
            return new, "lies"
        new = [*slips[0], heat + lost, t, gmpy2.const_pi() / 2, n1, n2, n3, *pose]
        # the slip of the old rim is that of its lowest point; of the other one it is told anew
        new = self.other(new)
        new[:2] = scaled(-1, slips[1])
        return new, "rocks"

    def case(self, after, both, sticks):
        """The impulses where these rims stick or slip, by Newton's steps from several starts; or None."""
        rims = (0, 1) if both else (1,)
        mu, tau = self.mu, 2 * gmpy2.const_pi()
        slipping = [r for r in rims if not sticks[r]]

        def impulses(x):
            """Of unknowns: both parts of a rim that sticks, and the direction of one that slips."""
            q, at = [[ZERO, ZERO], [ZERO, ZERO]], 0
            for r in rims:
                if sticks[r]:
                    q[r], at = [x[at], x[at + 1]], at + 2
            if slipping:
                # the normal impulses are linear in the parts along, and these in the normal impulses
                ways = {r: [gmpy2.cos(x[at + k]), gmpy2.sin(x[at + k])] for k, r in enumerate(slipping)}
                zero = after(both, q)[0]
                rows, known = [], []
                for r in slipping:
                    row = []
                    for s in slipping:
                        trial = [list(p) for p in q]
                        trial[s] = scaled(-mu, ways[s])
                        more = after(both, trial)[0][r] - zero[r]
                        row.append((1 if r == s else 0) - more)
                    rows.append(row)
                    known.append(zero[r])
                for r, p in zip(slipping, solved(rows, known), strict=True):
                    q[r] = scaled(-mu * p, ways[r])
            return q

        def left(x):
            slips = after(both, impulses(x))[1]
            out = []
            for r in rims:
                if sticks[r]:
                    out += slips[r]
            at = sum(2 for r in rims if sticks[r])
            for k, r in enumerate(slipping):
                out.append(slips[r][1] * gmpy2.cos(x[at + k]) - slips[r][0] * gmpy2.sin(x[at + k]))
            return out

        n = sum(2 if sticks[r] else 1 for r in rims)
        if n == 4:
            # the axial parts share one condition: equal ones
            def short(x):
                full = left([x[0], x[1], x[0], x[2]])
                return [full[0], full[1], full[3]]

            found = newton(short, [ZERO, ZERO, ZERO])
            candidates = [] if found is None else [[found[0], found[1], found[0], found[2]]]
        else:
            places = [tau * k / 16 for k in range(16)]
            fixed = [ZERO] * (2 * sum(sticks[r] for r in rims))
            if len(slipping) == 0:
                grid = [[]]
            elif len(slipping) == 1:
                grid = [[p] for p in places]
            else:
                grid = [[p, q] for p in places[::2] for q in places[::2]]
            candidates = [newton(left, [*fixed, *g]) for g in grid]
        for x in candidates:
            if x is None:
                continue
            q = impulses(x)
            normal, slips, ws = made = after(both, q)
            good = all(normal[r] >= 0 for r in rims) and (both or ws[1] < 0)
            for r in rims:
                if sticks[r]:
                    good = good and gmpy2.hypot(*q[r]) <= mu * normal[r] * (1 + mpfr("1e-40"))
                else:
                    at = x[-len(slipping) :][slipping.index(r)]
                    good = good and slips[r][0] * gmpy2.cos(at) + slips[r][1] * gmpy2.sin(at) > mpfr("1e-30")
            if good:
                return q, made, ws
        return None

    def read(self, y, lean=None):
        if len(y) == 13:
            w1, w3, *pose = y[7:]
            return [gmpy2.const_pi() / 2, w1, ZERO, w3, *y[:4], y[4], y[5], *pose]
        return [*y[4:8], y[0], y[1], mpfr("nan"), mpfr("nan"), y[2], self.work, *y[8:]]


def newton(f, x):
    """A zero of as many functions as unknowns, by differences; None if the steps do not settle."""
    step, n = mpfr("1e-22"), len(x)
    for _ in range(40):
        left = f(x)
        if max(map(abs, left)) < mpfr("1e-45"):
            return x
        slopes = []
        for k in range(n):
            near = f([v + step * (i == k) for i, v in enumerate(x)])
            slopes.append([(a - b) / step for a, b in zip(near, left, strict=True)])
        correction = solved([[slopes[k][i] for k in range(n)] for i in range(n)], left)
        if not all(gmpy2.is_finite(c) for c in correction):
            return None
        most = max(map(abs, correction))
        x = [a - b / max(ONE, most) for a, b in zip(x, correction, strict=True)]
    return None
