"""A body on two circles in the laboratory frame, one of the two formulations of lying_forms.py."""

import gmpy2
import slip_forms
from gmpy2 import mpfr
from lying_forms import ONE, ZERO, Lying, solved
from series import Node
from torus import Z
from vectors import add, cross, dot, scaled


class Vectors(Lying, slip_forms.Vectors):
    """Newton's and Euler's equations in the laboratory frame, with one contact or two."""

    exact = False

    def __init__(self, scene):
        super().__init__(scene)
        self.prepare(scene)

    def start(self):
        theta, *rest = self.beginning()
        return [*rest[3:], ZERO, ZERO, *self.begin(theta, *rest)]

    def axis(self, phase):
        e3 = phase.tape.states[10:13]
        return phase.tape.sqrt(e3[0] * e3[0] + e3[1] * e3[1]), e3[2]

    def gap(self, border, s, c):
        """How much lower the lower circle reaches; at a smooth joint, its slope."""
        da, dl, dr = border.apart
        return (dl * s - da * c) * (1 if dr > 0 else -1) if border.smooth else da * s + dl * c + dr

    def lying(self, kind, signs):
        tape = self.tape()
        slips = self.slips(tape, kind)
        for _ in range(3):
            tape.state()
        _, v, e3, material, w = ([tape.state() for _ in range(3)] for _ in range(5))
        axis, spin, places, zero = cross(w, e3), dot(w, e3), self.places, tape.constant(0)
        level = [e3[0], e3[1], e3[2] - self.border.c]  # against the lean, sin(theta) long
        lean = scaled(-1 / self.border.s, level)
        tips = [place.p for place in places]
        arms = [[-(place.p * e3[i]) - place.q * Z[i] for i in range(3)] for place in places]
        swings = [scaled(-p, axis) for p in tips]
        over = -dot(w, lean)
        # the couple of the losses per unit of the normal force of either, and that of the air
        loads = []
        for place in places:
            couple = self.against(place, signs, over)
            load = [ZERO] * 3 if not isinstance(couple, Node) and couple == 0 else [couple * -x for x in lean]
            drill = -self.losses["drilling"] * mpfr(signs[0]) if kind != "SS" else ZERO
            loads.append([load[0], load[1], load[2] + drill])
        drag = self.losses["air"]
        if self.losses["air2"]:
            drag = drag + self.losses["air2"] * tape.sqrt(dot(w, w))
        momentum = [self.i1 * w[i] + (self.i3 - self.i1) * (spin * e3[i]) for i in range(3)]
        torque = scaled(-1, cross(w, momentum))
        if self.losses["air"] or self.losses["air2"]:
            torque = add(torque, [-(drag * x) for x in w])
        free = self.turned(torque, e3)

        def answers(dv, dw):
            """Rates of both slips and accelerations of both heights: their linear parts."""
            turned = [cross(dw, arm) for arm in arms]
            lift = dw[0] * e3[1] - dw[1] * e3[0]
            heights = [dv[2] - p * lift for p in tips]
            return [[dv[i] + swung[i] for i in (0, 1)] for swung in turned], heights

        slip_free, height_free = answers([ZERO, ZERO, -ONE], free)
        carried = cross(w, axis)[2]
        height_free = [height - p * carried for height, p in zip(height_free, tips, strict=True)]
        slip_free = [add(rate, cross(w, swing)[:2]) for rate, swing in zip(slip_free, swings, strict=True)]

        # what is unknown: forces of a circle, by a unit of each, and the couples that hold
        units, across = [], cross(e3, Z)
        for rim in (0, 1):
            if kind == "SS":
                three_ways = [[ONE, ZERO, ZERO], [ZERO, ONE, ZERO], Z] if rim == 0 else [Z, across, level]
                units += [(rim, way) for way in three_ways]
            elif kind[rim : rim + 1] == "S" and not self.scene.smooth:
                units = [(rim, [ONE, ZERO, ZERO]), (rim, [ZERO, ONE, ZERO]), *units, (rim, Z)]
            else:
                units.append((rim, [*self.push(slips[rim]), ONE]))
        held = self.held(kind, signs)
        back = scaled(-1, lean)
        torques = [Z] * held[0] + [back] * held[1]
        effects = []
        for rim, force in units:
            more = [force[2] * x for x in loads[rim]]
            effects.append((force, self.turned(add(cross(arms[rim], force), more), e3)))
        effects += [([ZERO] * 3, self.turned(way, e3)) for way in torques]
        columns = [answers(*effect) for effect in effects]
        rows, known = [], []

        def demand(row, right):
            rows.append(row)
            known.append(-right)

        for rim in (0, 1):
            if (kind == "SS" and rim == 0) or (kind in ("SL", "LS") and kind[rim] == "S"):
                for i in (0, 1):
                    demand([c[0][rim][i] for c in columns], slip_free[rim][i])
        for rim in (0, 1):
            demand([c[1][rim] for c in columns], height_free[rim])
        if kind == "SS":
            rate = [c[0][1] for c in columns]
            along = [u[0] * across[0] + u[1] * across[1] for u in (*rate, slip_free[1])]
            demand(along[:-1], along[-1])
            shares = [dot(force, level) * (1 if rim == 0 else -1) for rim, force in units]
            demand([*shares, *[ZERO] * (len(columns) - 6)], ZERO)
        if held[0]:
            demand([dw[2] for _, dw in effects], free[2])
        if held[1]:
            demand([dot(dw, back) for _, dw in effects], dot(free, back))
        amounts = solved(rows, known)
        forces, dv, dw = [[ZERO] * 3, [ZERO] * 3], [ZERO, ZERO, -ONE], free
        for (rim, force), amount in zip(units, amounts, strict=False):
            forces[rim] = add(forces[rim], [amount * x for x in force])
        for (force, turn), amount in zip(effects, amounts, strict=True):
            dv, dw = add(dv, [amount * x for x in force]), add(dw, [amount * x for x in turn])
        slip_rates = [add(rate, [ZERO, ZERO]) for rate in slip_free]
        for (rates, _), amount in zip(columns, amounts, strict=True):
            slip_rates = [add(a, [amount * x for x in b]) for a, b in zip(slip_rates, rates, strict=True)]
        holding = list(amounts[len(units) :])
        free_couples = [holding.pop(0) if is_held else None for is_held in held]
        rates = [*v, *dv, *axis, *cross(w, material), *dw]
        rates = [x if isinstance(x, Node) else tape.constant(x) for x in rates]
        power = zero
        if self.losses["air"] or self.losses["air2"]:
            power = -(drag * dot(w, w))
        for force, load in zip(forces, loads, strict=True):
            if any(isinstance(x, Node) or x != 0 for x in load):
                power = power + force[2] * dot(load, w)
        return self.rates_of(tape, kind, slips, slip_rates, forces, power, free_couples, w[2], over, rates)

    def pose(self, y):
        return y[7:] if len(y) == 22 else y[4:]

    def lie(self, y):
        """The state on both circles of one on the first."""
        _, v, e3, _, w = (y[4 + 3 * i : 7 + 3 * i] for i in range(5))
        slips = [add(v, cross(w, arm))[:2] for arm in self.arms(e3)]
        return [*slips[0], *slips[1], y[2], self.work, y[3], *y[4:]]

    def arms(self, e3):
        return [add(scaled(-place.p, e3), scaled(-place.q, Z)) for place in self.places]

    def rise(self, y):
        """The state on the told circle of one on both."""
        self.work = y[5]
        return [y[0], y[1], y[4], y[6], *y[7:]]

    def other(self, y):
        """Told from the other circle, which carries from now on."""
        self.swap()
        if len(y) == 22:
            return [y[2], y[3], y[0], y[1], *y[4:]]
        (u, _, _) = self.in_space(y[4:])[3]
        return [u[0], u[1], *y[2:]]

    def at_rest(self, y, what):
        """The state on two circles with the turn or the spin stopped."""
        e3, w = y[13:16], y[19:22]
        level = [e3[0], e3[1], ZERO]
        way = Z if what == 0 else scaled(1 / gmpy2.sqrt(dot(level, level)), level)
        return [*y[:19], *add(w, scaled(-dot(w, way), way))]

    def settled(self, y):
        """The state on one circle that does not turn over any more."""
        return y

    def falling(self, y):
        """The size of w2 at a border."""
        return abs(self.in_space(y[4:])[0][2])

    def land(self, y):
        """What a landing does: the state on both circles, or on the other one, and which of them."""
        _, v, e3, _, w = (y[4 + 3 * i : 7 + 3 * i] for i in range(5))
        arms = self.arms(e3)
        units = [[ONE, ZERO, ZERO], [ZERO, ONE, ZERO], Z]
        # the velocity of either contact point for a unit of impulse at either
        light = [
            [[add(unit, cross(self.turned(cross(a, unit), e3), b)) for unit in units] for b in arms]
            for a in arms
        ]
        u = [add(v, cross(w, arm)) for arm in arms]
        outcomes = []
        for rims in ((0, 1), (1,)):
            found = self.moreau(light, u, rims)
            if found is not None:
                outcomes.append((rims, *found))
        ((rims, impulses, after),) = outcomes
        for rim in rims:
            v = add(v, impulses[rim])
            w = add(w, self.turned(cross(arms[rim], impulses[rim]), e3))
        lost = sum(-dot(add(u[rim], after[rim]), impulses[rim]) / 2 for rim in rims)
        new = [*after[0][:2], y[2] + lost, *y[3:7], *v, *y[10:16], *w]
        if len(rims) == 1:
            new[:2] = after[1][:2]
            self.swap()
            return new, "rocks"
        lying = self.lie(new)
        lying[:4] = [*after[0][:2], *after[1][:2]]
        return lying, "lies"

    def moreau(self, light, u, rims):
        """Impulses at these circles that leave them on the table, with friction against their slip; or None.

        Projections on the cone of friction, then Newton's steps with differences for slopes.
        """
        mu, n = self.mu, 2 * len(rims)

        def moved(q):
            """Normal impulses that stop them, and the velocities after."""
            after = {}
            for b in (0, 1):
                after[b] = list(u[b])
                for k, a in enumerate(rims):
                    for i in (0, 1):
                        after[b] = add(after[b], scaled(q[2 * k + i], light[a][b][i]))
            rows = [[light[a][b][2][2] for a in rims] for b in rims]
            normal = solved(rows, [-after[b][2] for b in rims])
            for b in (0, 1):
                for k, a in enumerate(rims):
                    after[b] = add(after[b], scaled(normal[k], light[a][b][2]))
            return normal, after

        def projected(q, h):
            normal, after = moved(q)
            out = []
            for k, a in enumerate(rims):
                x = [q[2 * k + i] - h * after[a][i] for i in (0, 1)]
                most, size = mu * max(normal[k], ZERO), gmpy2.sqrt(x[0] ** 2 + x[1] ** 2)
                out += [most / size * t for t in x] if size > most else x
            return out

        h = 1 / (4 * max(light[0][0][0][0], light[0][0][1][1], light[1][1][1][1]))
        q = [ZERO] * n
        for _ in range(4000):
            new = projected(q, h)
            change = max(abs(a - b) for a, b in zip(new, q, strict=True))
            q = new
            if change < mpfr("1e-9") * max(map(abs, u[1])):
                break
        step = mpfr("1e-22")
        for _ in range(9):
            left = [a - b for a, b in zip(q, projected(q, h), strict=True)]
            if max(map(abs, left)) < mpfr("1e-46"):
                break
            slopes = []
            for k in range(n):
                near = [x + step * (i == k) for i, x in enumerate(q)]
                there = [a - b for a, b in zip(near, projected(near, h), strict=True)]
                slopes.append([(a - b) / step for a, b in zip(there, left, strict=True)])
            # where both rims stick their axial parts are not told apart: the least addition keeps them
            rows = [[slopes[k][i] + (mpfr("1e-25") if i == k else 0) for k in range(n)] for i in range(n)]
            correction = solved(rows, left)
            q = [a - b for a, b in zip(q, correction, strict=True)]
        else:
            raise ArithmeticError(f"{self.scene.name}: a landing without end")
        normal, after = moved(q)
        impulses = [[ZERO] * 3, [ZERO] * 3]
        for k, a in enumerate(rims):
            if normal[k] < 0:
                return None
            impulses[a] = [q[2 * k], q[2 * k + 1], normal[k]]
            if gmpy2.sqrt(after[a][0] ** 2 + after[a][1] ** 2) < mpfr("1e-40"):
                after[a] = [ZERO, ZERO, ZERO]
        if len(rims) == 1 and after[0][2] <= 0:
            return None
        return impulses, after

    def told(self, y):
        lies = len(y) == 22
        state, pose, contact, (_, h, _), _ = self.in_space(self.pose(y))
        told = [
            [ux * h[0] + uy * h[1], uy * h[0] - ux * h[1]] for ux, uy in zip(y[0:4:2], y[1:4:2], strict=True)
        ]
        other = told[1] if lies else [mpfr("nan")] * 2
        spent = [y[4], y[5]] if lies else [y[2], self.work]
        return [*state, *told[0], *other, *spent, *pose, *contact]

    def strayed(self, y, lean=None):
        if len(y) == 22:
            y = [y[0], y[1], y[4], y[6], *y[7:]]
        return super().strayed(y)
