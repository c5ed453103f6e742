"""A body on two circles by the closed equations, one of the two formulations of lying_forms.py."""

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
        theta, w1, w2, w3, *slip = self.beginning()
        return [*slip, ZERO, ZERO, theta, w1, w2, w3, *[ZERO] * 4]

    def axis(self, phase):
        return phase.tape.sin_cos(phase.tape.states[4])

    def gap(self, border, s, c):
        """The sine of the angle to a border."""
        return border.s * c - border.c * s

    def responses(self, held):
        """How the rates of w1 and w3 answer couples along e1 and e3, and what holds turn and spin, per unit of them.

        What is held takes a couple along the vertical, or against the lean.
        """
        s, c = self.border.s, self.border.c
        ways = [way for way, is_held in zip(((s, c), (-c, s)), held, strict=True) if is_held]
        light = [1 / self.i1, 1 / self.i3]
        answer = [[light[0], ZERO], [ZERO, light[1]]]
        holding = [[None, None], [None, None]]
        if len(ways) == 2:
            return [[ZERO, ZERO], [ZERO, ZERO]], [scaled(-1, way) for way in ways]
        for way in ways:
            swung = [x * n for x, n in zip(light, way, strict=True)]
            whole = swung[0] * way[0] + swung[1] * way[1]
            answer = [[answer[i][k] - swung[i] * swung[k] / whole for k in (0, 1)] for i in (0, 1)]
            holding[0 if held[0] else 1] = scaled(-1 / whole, swung)
        return answer, holding

    def lying(self, kind, signs):
        tape = self.tape()
        slips = self.slips(tape, kind)
        for _ in range(3):
            tape.state()
        w1, w3, phi, _, _, _ = (tape.state() for _ in range(6))
        s, c = self.border.s, self.border.c
        i1, i3, zero, places = self.i1, self.i3, tape.constant(0), self.places
        z, g = places[0].height, [place.g for place in places]
        apart = g[0] - g[1]
        turn, spin = s * w1 + c * w3, s * w3 - c * w1
        precession = w1 / s
        gyro = i3 * (w1 * w3) - (i1 * c) * (precession * w1)
        held, stuck = self.held(kind, signs), None
        # the velocity of the centre, and the force along the lean
        if kind == "SS":
            v_h, v_2 = zero, z * spin
            f_h = -(precession * v_2)
        elif kind in ("SL", "LS"):
            stuck = kind.index("S")
            v_h, v_2 = zero, places[stuck].radius * w3 - places[stuck].depth * w1
            f_h = -(precession * v_2)
        else:
            u = slips[0][0]
            v_h, v_2 = u[0], u[1] - places[0].depth * w1 + places[0].radius * w3
            pushes = [self.push(slip) for slip in slips]
            f_h = pushes[0][0] if self.scene.law == "viscous" else zero
        # the normal forces
        if kind[:1] in ("L", "o") and kind != "LS" and self.scene.law != "viscous" and self.mu:
            levers = [z * push[0] + x for push, x in zip(pushes, g, strict=True)]
            normals = [(gyro - levers[1]) / (levers[0] - levers[1])]
            normals.append((levers[0] - gyro) / (levers[0] - levers[1]))
        else:
            moment = gyro - z * f_h
            normals = [(moment - g[1]) / apart, (g[0] - moment) / apart]
        # the couples, along e1 and e3
        down = zero
        for place, normal in zip(places, normals, strict=True):
            down = down + normal * self.against(place, signs, spin)
        up = -self.losses["drilling"] * mpfr(signs[0]) if kind != "SS" else ZERO
        couples = [s * up - c * down, c * up + s * down]
        size = self.losses["air"]
        if self.losses["air2"]:
            size = self.losses["air2"] * tape.sqrt(w1 * w1 + w3 * w3) + size
        if self.losses["air"] or self.losses["air2"]:
            couples = [couples[0] - size * w1, couples[1] - size * w3]
        answer, holding = self.responses(held)
        ways = [[place.depth, -place.radius] for place in places]

        def answered(way, torque):
            """What of a rate across, along a way, a couple gives."""
            return sum(
                (way[i] * answer[i][k]) * torque[k] for i in (0, 1) for k in (0, 1) if answer[i][k] != 0
            )

        # the forces
        free = [None, None]
        if kind == "SS":
            inertia = i1 * c * c + i3 * s * s + z * z
            rolled = zero if held[1] else (c * couples[0] - s * couples[1]) / inertia
            total = -z * rolled
            moment = ((i1 - i3) * s * c) * rolled - s * couples[0] - c * couples[1]
            across = [(moment - g[1] * total) / apart, (g[0] * total - moment) / apart]
            forces = [[f_h / 2, f, n] for f, n in zip(across, normals, strict=True)]
            w1_rate, w3_rate = c * rolled, -s * rolled
            if held[1]:
                free[1] = c * couples[0] - s * couples[1]
            rates = [[zero, zero], [zero, zero]]
        else:
            if stuck is not None:
                moving = 1 - stuck
                sense = mpfr(signs[2]) * gmpy2.sign(g[stuck] - g[moving])
                slides = (self.mu * sense) * normals[moving]
                own = 1 + answered(ways[stuck], ways[stuck])
                more = 1 + answered(ways[stuck], ways[moving])
                grip = -(more * slides + answered(ways[stuck], couples)) / own
                forces = [[f_h, grip, normals[stuck]], [zero, slides, normals[moving]]]
                forces = forces[::-1] if stuck else forces
            else:
                forces = [[n * p[0], n * p[1], n] for n, p in zip(normals, pushes, strict=True)]
            torque = [forces[0][1] * ways[0][i] + forces[1][1] * ways[1][i] + couples[i] for i in (0, 1)]
            w1_rate, w3_rate = (row[0] * torque[0] + row[1] * torque[1] for row in answer)
            for i, row in enumerate(holding):
                if held[i]:
                    free[i] = row[0] * torque[0] + row[1] * torque[1]
            along = forces[0][0] + forces[1][0] + precession * v_2
            across = forces[0][1] + forces[1][1] - precession * v_h
            rates = [[along, across + way[0] * w1_rate + way[1] * w3_rate] for way in ways]
            if stuck is not None:
                rates[1 - stuck][0] = zero
        power = couples[0] * w1 + couples[1] * w3
        sin_phi, cos_phi = tape.sin_cos(phi)
        out, aside = v_h, v_2 + places[0].p * w1  # of the told point on the table
        path = [out * cos_phi - aside * sin_phi, out * sin_phi + aside * cos_phi]
        moved = [w1_rate + 0, w3_rate + 0, precession, w3 - c * precession, *path]
        return self.rates_of(tape, kind, slips, rates, forces, power, free, turn, spin, moved)

    def turn_of(self, w1, w3):
        return self.border.s * w1 + self.border.c * w3

    def lie(self, y):
        u_h, u_2, heat, t, _, w1, _, w3, *pose = y
        one, other = self.places
        return [
            u_h,
            u_2,
            u_h,
            u_2 - (one.g - other.g) * self.turn_of(w1, w3),
            heat,
            self.work,
            t,
            w1,
            w3,
            *pose,
        ]

    def rise(self, y):
        self.work = y[5]
        theta = gmpy2.atan2(self.border.s, self.border.c)
        return [y[0], y[1], y[4], y[6], theta, y[7], ZERO, y[8], *y[9:]]

    def other(self, y):
        """Told from the other circle, which carries from now on."""
        one, other = self.places
        apart = one.g - other.g
        *_, phi, _, a, b = y
        placed = [a - apart * gmpy2.cos(phi), b - apart * gmpy2.sin(phi)]
        self.swap()
        if len(y) == 13:
            return [*y[2:4], *y[0:2], *y[4:-2], *placed]
        return [y[0], y[1] - apart * self.turn_of(y[5], y[7]), *y[2:-2], *placed]

    def at_rest(self, y, what):
        """The state on two circles with the turn or the spin stopped."""
        s, c = self.border.s, self.border.c
        way = (s, c) if what == 0 else (-c, s)
        rate = way[0] * y[7] + way[1] * y[8]
        return [*y[:7], y[7] - rate * way[0], y[8] - rate * way[1], *y[9:]]

    def settled(self, y):
        return [*y[:4], gmpy2.atan2(self.border.s, self.border.c), y[5], ZERO, *y[7:]]

    def falling(self, y):
        return abs(y[6])

    def land(self, y):
        """By cases: which circles stay, and which of them stick."""
        u_h, u_2, heat, t, _, w1, w2, w3, *pose = y
        i1, i3, places = self.i1, self.i3, self.places
        z, (g, g1) = places[0].height, (place.g for place in places)
        outcomes = []
        v_h, v_2 = u_h + z * w2, u_2 - places[0].depth * w1 + places[0].radius * w3

        def after(both, q):
            """Normal impulses, and velocities after, for these impulses along and across at either circle."""
            along, across = q[0][0] + q[1][0], q[0][1] + q[1][1]
            if both:
                normal = [
                    ((g * g1 + i1) * w2 - z * along) / (g - g1),
                    (-(g * g + i1) * w2 + z * along) / (g - g1),
                ]
                new_w2 = ZERO
            else:
                up = -((g - g1) * w2 * i1 + z * g1 * along) / (i1 + g1 * g1)
                normal, new_w2 = [ZERO, up], w2 - (g1 * up + z * along) / i1
            new_w1 = w1 + sum(place.depth * q[r][1] for r, place in enumerate(places)) / i1
            new_w3 = w3 - sum(place.radius * q[r][1] for r, place in enumerate(places)) / i3
            slips = [
                [v_h + along - z * new_w2, v_2 + across + place.depth * new_w1 - place.radius * new_w3]
                for place in places
            ]
            return normal, slips, (new_w1, new_w2, new_w3)

        for both in (True, False):
            for sticks in ((True, True), (True, False), (False, True), (False, False)):
                if not both and sticks[0]:
                    continue
                found = self.case(after, both, sticks, gmpy2.sign(w2))
                if found is not None:
                    outcomes.append((both, *found))
        distinct = []
        for outcome in outcomes:
            if not any(abs(outcome[3][0] - x[3][0]) + abs(outcome[3][2] - x[3][2]) < 1e-30 for x in distinct):
                distinct.append(outcome)
        ((both, q, (_, slips, (n1, n2, n3)), _),) = distinct
        slips = [[ZERO, ZERO] if gmpy2.hypot(*u) < mpfr("1e-40") else u for u in slips]
        a_h, a_2 = v_h + q[0][0] + q[1][0], v_2 + q[0][1] + q[1][1]
        own = (
            v_h**2 - a_h**2 + v_2**2 - a_2**2 + i1 * (w1**2 - n1**2 + w2**2 - n2**2) + i3 * (w3**2 - n3**2)
        ) / 2
        # the vertical velocity of the centre
        lost = own + (g * g * w2**2 - g1 * g1 * n2**2) / 2
        if both:
            return [*slips[0], *slips[1], heat + lost, self.work, t, n1, n3, *pose], "lies"
        theta = gmpy2.atan2(self.border.s, self.border.c)
        new = self.other([*slips[0], heat + lost, t, theta, n1, n2, n3, *pose])
        new[:2] = slips[1]
        return new, "rocks"

    def case(self, after, both, sticks, sense):
        """The impulses where these circles stick or slip, by Newton's steps from several starts; or None."""
        rims = (0, 1) if both else (1,)
        mu, tau = self.mu, 2 * gmpy2.const_pi()
        slipping = [r for r in rims if not sticks[r]]

        def impulses(x):
            """Of unknowns: both parts of a circle that sticks, and the direction of one that slips."""
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
            good = all(normal[r] >= 0 for r in rims) and (both or ws[1] * sense > 0)
            for r in rims:
                if sticks[r]:
                    good = good and gmpy2.hypot(*q[r]) <= mu * normal[r] * (1 + mpfr("1e-40"))
                else:
                    at = x[-len(slipping) :][slipping.index(r)]
                    good = good and slips[r][0] * gmpy2.cos(at) + slips[r][1] * gmpy2.sin(at) > mpfr("1e-30")
            if good:
                return q, made, ws
        return None

    def told(self, y):
        if len(y) == 13:
            w1, w3, *pose = y[7:]
            theta = gmpy2.atan2(self.border.s, self.border.c)
            return [theta, w1, ZERO, w3, *y[:4], y[4], y[5], *pose]
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
