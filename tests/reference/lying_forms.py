"""Two formulations of a body that lies on two circles, for lying.py and rims.py, beside those of one in slip_forms.py.

vectors   three-dimensional, in the laboratory frame, with both contact points. The angular acceleration,
          the rates of the slip at both and the accelerations of the heights of both are linear in the
          forces; what a circle that slips, or sticks, or is held by dry friction demands is a system of up to
          six linear equations.
reduced   w1, w3, the slip along the lean and across, and quadratures; normal forces in closed form.

Here two circles touch: theta is that of their border, and w2 = 0. The first one is that from which the state is
told. The first numbers of a state are the slips of both, the heat, the work of the losses, and the time.
Kinds of phases:

    LL    both slip                          SL, LS   the told one sticks and the other slips, or the reverse:
    SS    both stick: it rolls straight,              the body pivots
          or round its apex                  onset0, onset1: as LL, with the slip of one by its size and direction

Turn and spin are the rates of the body about the vertical and against the lean, w.z and -w.h.

A landing without restitution is Moreau's: both circles, or the one that lands alone, have normal impulses P
and friction impulses Q that oppose the slip after it, Q = -mu P u/|u|, or hold it, |Q| <= mu P.
"""

import gmpy2
from borders import Profile
from gmpy2 import mpfr
from phases import Phase
from series import Node

LAWS = ("dry", "viscous", "rolling", "drilling", "air", "air2")
ONE, ZERO = mpfr(1), mpfr(0)


def solved(rows, known):
    """The solution of linear equations of numbers or series, by elimination in their order."""
    rows, n = [[*row, right] for row, right in zip(rows, known, strict=True)], len(rows)

    def none(x):
        return not isinstance(x, Node) and x == 0

    for k in range(n):
        for j in range(k + 1, n):
            if not none(rows[j][k]):
                factor = rows[j][k] / rows[k][k]
                for i in range(k + 1, n + 1):
                    if not none(rows[k][i]):
                        rows[j][i] = rows[j][i] - factor * rows[k][i]
    found = [None] * n
    for k in reversed(range(n)):
        left = rows[k][n]
        for i in range(k + 1, n):
            if not none(rows[k][i]):
                left = left - rows[k][i] * found[i]
        found[k] = left / rows[k][k]
    return found


class Lying(Profile):
    """What both formulations have in common."""

    def prepare(self, scene):
        self.losses = {name: mpfr(scene.losses.get(name, 0.0)) for name in LAWS}
        self.dry = self.losses["drilling"] > 0, self.losses["dry"] + self.losses["rolling"] > 0
        self.both, self.work = {}, ZERO
        self.prepare_profile(scene.circles, scene.circle, scene.other)

    def beginning(self):
        """The six numbers of the start; at a border they are exact, as the table cannot be."""
        theta, w1, w2, w3, *slip = map(mpfr, self.scene.start)
        if self.scene.lies:
            s, c = self.border.s, self.border.c
            theta = gmpy2.atan2(s, c)
            if self.scene.apex is not None:
                w1, w3 = c * mpfr(self.scene.apex), -s * mpfr(self.scene.apex)
        return theta, w1, w2, w3, *slip

    def two(self, kind, signs):
        key = self.k, self.o, kind, signs
        if key not in self.both:
            self.both[key] = self.lying(kind, signs)
        return self.both[key]

    def there(self, kind, signs, y, order=0):
        """The quantities of a phase at a state."""
        phase = self.two(kind, signs)
        phase.tape.expand(y, order)
        return phase

    def read(self, y, lean=None):
        """The numbers of a row."""
        return self.scene.shown(self, self.told(y))

    def slips(self, tape, kind):
        """Of either circle: its slip, its size and its direction; no size where it sticks, or is smooth."""
        found = []
        for rim in (0, 1):
            first, second = tape.state(), tape.state()
            if kind == f"onset{rim}":
                y, x = tape.sin_cos(second)
                found.append(([first * x, first * y], first, [x, y]))
            elif self.scene.smooth:
                found.append(([first, second], None, None))
            elif kind[rim : rim + 1] == "S":
                found.append(([ZERO, ZERO], None, None))
            else:
                size = tape.sqrt(first * first + second * second)
                found.append(([first, second], size, [first / size, second / size]))
        return found

    def push(self, slip):
        """The horizontal force of a circle that slips, per unit of its normal force."""
        u, _, direction = slip
        if self.scene.law == "viscous":
            return [-(self.mu * x) for x in u]
        return [-(self.mu * x) for x in direction] if self.mu else [ZERO, ZERO]

    def held(self, kind, signs):
        """Whether dry friction holds the turn and the spin."""
        return [
            kind != "SS" and not signs[0] and self.dry[0],
            not signs[1] and self.dry[1],
        ]

    def against(self, place, signs, spin):
        """The couple against the lean of the losses at a circle, per unit of its normal force."""
        law, s, radius = self.losses, self.border.s, place.radius
        dry = -(law["dry"] * radius / s + law["rolling"]) * mpfr(signs[1])
        return dry - (law["viscous"] * (radius / s) ** 2) * spin if law["viscous"] else dry

    def holds(self, tape, forces, free):
        """What dry friction can hold less what it holds, of the squares; None where it holds nothing."""
        law, margins = self.losses, []
        loads = zip(self.places, forces, strict=True)
        most = law["dry"] / self.border.s * sum(p.radius * f[2] for p, f in loads) + law["rolling"]
        for couple, bound in zip(free, (tape.constant(law["drilling"]), most), strict=True):
            margins.append(None if couple is None else bound * bound - couple * couple)
        return margins

    def rates_of(self, tape, kind, slips, slip_rates, forces, power, free, turn, spin, rates):
        """The phase: all rates in its variable, and what decides."""
        zero, one = tape.constant(0), tape.constant(1)
        heat = zero
        for (u, *_), force in zip(slips, forces, strict=True):
            heat = heat - (force[0] * u[0] + force[1] * u[1])
        named = {"normals": [force[2] for force in forces], "forces": forces, "couples": free}
        named |= {"yaw": turn, "spin": spin, "holds": self.holds(tape, forces, free)}
        named |= {"growth": [None, None], "turn": [None, None], "demand": [None, None]}
        named |= {"sizes": [size for _, size, _ in slips], "slip": (), "kind": kind}
        starts = []
        for rim, ((_, size, direction), rate, force) in enumerate(
            zip(slips, slip_rates, forces, strict=True)
        ):
            if kind == f"onset{rim}":
                growth = rate[0] * direction[0] + rate[1] * direction[1]
                turning = rate[1] * direction[0] - rate[0] * direction[1]
                named["growth"][rim], named["turn"][rim] = growth, turning
                named["residual"] = turning - tape.drift(size, tape.states[2 * rim + 1])
                starts += [growth, zero]
            elif kind[rim : rim + 1] == "S" and not self.scene.smooth:
                starts += [zero, zero]
                most = self.static * force[2]
                named["demand"][rim] = most * most - force[0] * force[0] - force[1] * force[1]
            else:
                starts += rate
        tape.rates = [*starts, heat, -power, one, *rates]
        if kind == "LL" and not self.scene.smooth:
            (_, a, _), (_, b, _) = slips
            pace = a * b / (a + b)
            tape.rates = [pace * rate for rate in tape.rates]
            named["pace"] = pace
        return Phase(tape, **named)
