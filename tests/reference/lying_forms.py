"""Two formulations of a body that lies on both rims, for lying.py, beside those of one rim in slip_forms.py.

vectors   three-dimensional, in the laboratory frame, with both contact points. The angular acceleration,
          the rates of the slip at both rims and the accelerations of the heights of both are linear in the
          forces; what a rim that slips, or sticks, or is held by dry friction demands is a system of up to
          six linear equations.
reduced   w1, w3, the slip along the axis and across, and quadratures; normal forces in closed form.

Here both rims touch: theta = pi/2 and w2 = 0. `low` is the rim from which the state is told, `up` the other
one. The first numbers of a state are the slips of both, the heat, the work of the losses, and the time.
Kinds of phases:

    LL    both rims slip                     SL, LS   low sticks and up slips, or the reverse: the body
pivots SS    both stick: it rolls straight      onset0, onset1: as LL, with the slip of one rim by its size
and direction

A landing without restitution is Moreau's: both rims, or the one that lands alone, have normal impulses P
and friction impulses Q that oppose the slip after it, Q = -mu P u/|u|, or hold it, |Q| <= mu P.
"""

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


class Lying:
    """What both formulations have in common."""

    def prepare(self, scene):
        self.losses = {name: mpfr(scene.losses.get(name, 0.0)) for name in LAWS}
        self.both, self.work = {}, ZERO

    def two(self, kind, signs):
        if (kind, signs) not in self.both:
            self.both[kind, signs] = self.lying(kind, signs)
        return self.both[kind, signs]

    def there(self, kind, signs, y, order=0):
        """The quantities of a phase at a state."""
        phase = self.two(kind, signs)
        phase.tape.expand(y, order)
        return phase

    def slips(self, tape, kind):
        """Of either rim: its slip, its size and its direction; no size where it sticks, or is smooth."""
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
        """The horizontal force of a rim that slips, per unit of its normal force."""
        u, _, direction = slip
        if self.scene.law == "viscous":
            return [-(self.mu * x) for x in u]
        return [-(self.mu * x) for x in direction] if self.mu else [ZERO, ZERO]

    def couples(self, tape, signs, w1, w3):
        """The couples along z and along the axis that are not to be found, and which are."""
        one, three, law = tape.constant(0), tape.constant(0), self.losses
        if law["air"]:
            one, three = one - law["air"] * w1, three - law["air"] * w3
        if law["air2"]:
            size = tape.sqrt(w1 * w1 + w3 * w3)
            one, three = one - law["air2"] * (size * w1), three - law["air2"] * (size * w3)
        if law["viscous"]:
            three = three - law["viscous"] * w3
        one = one + -law["drilling"] * mpfr(signs[0])
        three = three + -(law["dry"] + law["rolling"]) * mpfr(signs[1])
        return one, three

    def rates_of(self, tape, kind, slips, slip_rates, forces, couples, free, w1, w3, rates):
        """The phase: all rates in its variable, and what decides."""
        zero, one = tape.constant(0), tape.constant(1)
        heat = zero
        for (u, *_), force in zip(slips, forces, strict=True):
            heat = heat - (force[0] * u[0] + force[1] * u[1])
        work = zero - (couples[0] * w1 + couples[1] * w3)
        named = {"normals": [force[2] for force in forces], "forces": forces, "couples": free}
        named |= {"w1": w1, "w3": w3, "growth": [None, None], "turn": [None, None], "demand": [None, None]}
        named |= {"sizes": [size for _, size, _ in slips], "slip": (), "kind": kind}
        starts = []
        for rim, ((_, size, direction), rate, force) in enumerate(
            zip(slips, slip_rates, forces, strict=True)
        ):
            if kind == f"onset{rim}":
                growth = rate[0] * direction[0] + rate[1] * direction[1]
                turn = rate[1] * direction[0] - rate[0] * direction[1]
                named["growth"][rim], named["turn"][rim] = growth, turn
                named["residual"] = turn - tape.drift(size, tape.states[2 * rim + 1])
                starts += [growth, zero]
            elif kind[rim : rim + 1] == "S" and not self.scene.smooth:
                starts += [zero, zero]
                most = self.static * force[2]
                named["demand"][rim] = most * most - force[0] * force[0] - force[1] * force[1]
            else:
                starts += rate
        tape.rates = [*starts, heat, work, one, *rates]
        if kind == "LL" and not self.scene.smooth:
            (_, a, _), (_, b, _) = slips
            pace = a * b / (a + b)
            tape.rates = [pace * rate for rate in tape.rates]
            named["pace"] = pace
        return Phase(tape, **named)
