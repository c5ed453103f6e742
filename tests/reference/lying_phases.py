"""How a body on two circles goes on, for lying.py and rims.py: which phase follows, and where it ends."""

import gmpy2
from gmpy2 import mpfr
from lying_forms import ZERO
from phases import first_event, sampled

TINY = mpfr("1e-30")

TOLD = ("lies", "held", "crosses", "goes on")
RATES = ("turn", "spin")


class Margin:
    """A series times a sign."""

    def __init__(self, node, sign):
        self.node, self.sign = node, sign

    def at(self, h):
        return self.sign * self.node.at(h)


def on_rim(y, rim, first, second):
    """The state with this slip of a circle."""
    return [*y[: 2 * rim], first, second, *y[2 * rim + 2 :]]


def sign(x):
    return (x > 0) - (x < 0)


class Both:
    """What a body on two circles does next: a kind of phase, the signs of its rates, and the state."""

    def __init__(self, model, out):
        self.model, self.out, self.sense = model, out, None

    def signs(self, y, kind="LL"):
        """The signs of turn and spin, and that of the turn for a pivot; 0 where dry friction holds them."""
        there = self.model.there("SS", (0, 1, 1), y)
        yaw, spin = there.yaw.c[0], there.spin.c[0]
        found = [sign(yaw), sign(spin), sign(yaw)]
        if kind == "SS":
            found[0] = 0
        if abs(yaw) < TINY:
            found[0] = 0
        if abs(spin) < TINY:
            found[1] = 0
        if self.sense is not None:  # what has just passed through 0
            found[self.sense[0]] = self.sense[1]
        return tuple(found)

    def enter(self, y):
        """The phase of a state on both circles; or "one" and that which carries on alone."""
        m = self.model
        if m.scene.smooth:
            return "LL", self.signs(y), y
        sizes = [gmpy2.hypot(*y[2 * r : 2 * r + 2]) for r in (0, 1)]
        rest = [size < TINY for size in sizes]
        if all(rest):
            y, signs = [ZERO] * 4 + y[4:], self.signs(y, "SS")
            there = m.there("SS", signs, y)
            normals = [n.c[0] for n in there.normals]
            if min(normals) < 0:
                return "one", 0 if normals[1] < 0 else 1, y
            pull = [there.forces[0][i].c[0] + there.forces[1][i].c[0] for i in (0, 1)]
            size = gmpy2.hypot(*pull)
            if size > m.static:  # both slip off against it
                return "LL", self.signs(y), [-TINY * x / size for x in (*pull, *pull)] + y[4:]
            return "SS", signs, y
        if not any(rest):
            signs = self.signs(y)
            there = m.there("LL", signs, y)
            normals = [n.c[0] for n in there.normals]
            if min(normals) < 0:
                return "one", 0 if normals[1] < 0 else 1, y
            return "LL", signs, y
        rim = rest.index(True)
        y = on_rim(y, rim, ZERO, ZERO)
        pivot = ("SL", "LS")[rim]
        signs = self.signs(y)
        there = m.there(pivot, signs, y)
        normals, demand = [n.c[0] for n in there.normals], there.demand[rim].c[0]
        if min(normals) > 0 and demand >= 0:
            return pivot, signs, y
        if normals[1 - rim] <= 0 and demand >= 0:
            return "one", rim, y
        return "LL", signs, self.departs(y, rim, signs)

    def departs(self, y, rim, signs):
        """The slip of a circle that cannot stick: the one direction in which it grows and does not turn."""
        m, kind = self.model, f"onset{rim}"

        def turning(angle):
            there = m.there(kind, signs, on_rim(y, rim, ZERO, angle))
            return there.turn[rim].c[0], there.growth[rim].c[0], min(n.c[0] for n in there.normals)

        found, places, whole = [], 180, 2 * gmpy2.const_pi()
        angles = [mpfr("0.0123") + whole * k / places for k in range(places + 1)]
        values = [turning(angle)[0] for angle in angles]
        for k in range(places):
            if (values[k] > 0) != (values[k + 1] > 0):
                low, high, f_low = angles[k], angles[k + 1], values[k]
                for _ in range(12):
                    middle = (low + high) / 2
                    f = turning(middle)[0]
                    low, high, f_low = (middle, high, f) if (f > 0) == (f_low > 0) else (low, middle, f_low)
                f_high = turning(high)[0]
                for _ in range(14):
                    if f_high == f_low or high == low:
                        break
                    low, f_low, high = high, f_high, (low * f_high - high * f_low) / (f_high - f_low)
                    f_high = turning(high)[0]
                _, growth, normal = turning(high)
                if growth > 0 and normal > 0:
                    found.append(high)
        (angle,) = found
        return on_rim(y, rim, TINY * gmpy2.cos(angle), TINY * gmpy2.sin(angle))

    def lets_go(self, y, rim, signs):
        """A state a little after a pivot lets go with u' = 0, by the series of phases.onset."""
        m = self.model
        force = [x.c[0] if hasattr(x, "c") else x for x in m.there(("SL", "LS")[rim], signs, y).forces[rim]]
        phase = m.two(f"onset{rim}", signs)
        size, slaved = phase.tape.states[2 * rim : 2 * rim + 2]
        begin = on_rim(y, rim, ZERO, gmpy2.atan2(-force[1], -force[0]))
        phase.tape.expand_slaved(begin, m.last, slaved, phase.residual)
        assert size.c[2] > 0
        h = mpfr(1)
        for node in phase.tape.states:
            for k in range(m.last - 8, m.last + 1):
                scale = size.c[2] if node is size else mpfr(1)
                power = k - 2 if node is size else k
                if node.c[k]:
                    h = min(h, (mpfr("1e-34") * scale / abs(node.c[k])) ** (mpfr(1) / power))
        y = [node.at(h * mpfr(m.cut)) for node in phase.tape.states]
        size, angle = y[2 * rim : 2 * rim + 2]
        return on_rim(y, rim, size * gmpy2.cos(angle), size * gmpy2.sin(angle))

    def follow(self, kind, signs, y, samples):
        """Until the phase ends, or the samples do: what is there, and the state."""
        m, out = self.model, self.out
        phase = m.two(kind, signs)
        tape, smooth = phase.tape, m.scene.smooth
        sliding = kind == "LL" and not smooth
        while True:
            tape.expand(y, m.order)
            out.steps += 1
            h = mpfr(2)
            for index, node in enumerate(tape.states):
                scale = max(mpfr(1), abs(node.c[0]))
                if sliding and index < 4:
                    scale = phase.sizes[index // 2].c[0]
                for k in (m.order - 1, m.order):
                    if node.c[k]:
                        h = min(h, (m.tolerance * scale / abs(node.c[k])) ** (mpfr(1) / k))
            events = []
            if kind != "SS":
                events += [("rises", phase.normals[1]), ("sinks", phase.normals[0])]
            for rim in (0, 1):
                if phase.demand[rim] is not None and kind != "SS":
                    events.append(("lets go", phase.demand[rim]))
            if kind in ("SL", "LS"):
                events.append(("turned", Margin(phase.yaw, signs[2])))
            elif signs[0] and m.dry[0] and kind != "SS":
                events.append(("turn", Margin(phase.yaw, signs[0])))
            if signs[1] and m.dry[1]:
                events.append(("spin", Margin(phase.spin, signs[1])))
            for which, margin in enumerate(phase.holds):
                if margin is not None and kind != "SS":
                    events.append((which, margin))
            place, name = first_event(events, h)
            h = h if name is None else place
            if name in (0, 1):  # dry friction lets go against what it has held with
                self.sense = name, -1 if phase.couples[name].at(h) > 0 else 1
            sampled(out, samples, tape.states[6], h, sliding)
            if not samples:
                return None, y
            y = [node.at(h) for node in tape.states]
            if name is not None:
                return name, y
            if sliding:
                sizes = [gmpy2.hypot(*y[2 * r : 2 * r + 2]) for r in (0, 1)]
                rim = 0 if sizes[0] < sizes[1] else 1
                if sizes[rim] < TINY and sizes[rim] < phase.sizes[rim].c[0]:
                    # one linear step is left, in time
                    there = m.there(kind, signs, y, 1)
                    pace = there.pace.c[0]
                    growth = there.sizes[rim].c[1] / pace
                    assert growth < 0
                    left = sizes[rim] / -growth
                    both = sizes[1 - rim] < 1000 * TINY
                    y = [node.c[0] + left / pace * node.c[1] for node in there.tape.states]
                    y = on_rim(y, rim, ZERO, ZERO)
                    return "stops", [ZERO] * 4 + y[4:] if both else y
