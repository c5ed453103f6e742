"""Writes slip_motion.csv: motions with friction at the rim, from slip to roll and back, the reference of its tests.

    python tests/reference/slip.py [name ...]        those whose names begin so, in the place of their old rows; or all

It needs gmpy2, and fifteen minutes for all of them on one core.

Every motion is made from two formulations that share nothing but the series of series.py, the law of friction and
the order of the phases:

    vectors   three-dimensional, in the laboratory frame: axis, one material vector, angular velocity, centre of mass
              and its velocity. r points from the centre to the lowest point of the rim, a torus of radius a = 1 - rho
              and fillet rho. The angular acceleration, the rate of the slip u = v + w x r and that of the height of
              the lowest point are linear in the force, and so the force is found:
                  slip     F = N (z - mu u/|u|) or N (z - c u), and the lowest point stays on the table
                  rolling  u' = 0, and the lowest point stays on the table
    reduced   theta, w1, w2, w3, the slip along the lean and across; phi, psi and the contact by quadrature, with the
              normal force of the closed form

Slip runs in the variable tau, dt = |u| dtau: the end of slip is at infinity there, and nothing is singular on the way
to it; from |u| = 1e-30 one linear step is left. Slip that begins with u' != 0 begins at |u| = 1e-30. Slip that begins
where the demand of rolling grows past mu N, and static friction is no higher, begins with u' = 0: |u| grows as t^2,
and the direction is found as a series in t, order by order. That series is cut at another time in either formulation.

A row is a checkpoint of a motion: a time, what is there, the state, the heat so far, the pose and the contact, which
start at 0. What is there:

    sample    nothing
    rolls     slip ends in rolling; the slip is 0
    passes    slip goes through 0 and on, in another direction
    slips     rolling ends in slip
    lift-off  slip ends with no normal force         (these three end the motion)
    side      the axis is horizontal: the other rim lands
    face      the axis is vertical: the face lands
    end       the last time

Inputs are exact doubles, written as hexadecimal; results are decimal, to 25 digits. `agreement` is the largest
difference of both formulations in the numbers of the row, over 1 or the number if that is more.
"""

import math
import pathlib
import sys
import time

import gmpy2
from gmpy2 import mpfr
from series import Tape, precise, root

HERE = pathlib.Path(__file__).parent
DIGITS = 40
TINY = mpfr("1e-30")
LONGEST = 2.0  # step, in the variable of a phase


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def add(*vectors):
    return [x[0] + x[1] if len(x) == 2 else x[0] + x[1] + x[2] for x in zip(*vectors, strict=True)]


def scaled(k, a):
    return [k * x for x in a]


class Phase:
    """The equations of a phase: the tape, and the quantities that decide."""

    def __init__(self, tape, **named):
        self.tape = tape
        self.__dict__.update(named)


class Formulation:
    """What both have in common: a scene, its phases, and how slip is written.

    The first numbers of a state are the slip, the heat and the time; `kind` is one of

        slip   |u| by its components, in tau       steep  the same in t, for viscous friction or none
        onset  |u| and its direction, in t         roll   in t
    """

    def __init__(self, scene):
        self.scene = scene
        self.ell, self.i1, self.i3, self.fillet = (mpfr(x) for x in scene.body)
        self.rim = 1 - self.fillet
        self.mu, self.static = mpfr(scene.mu), mpfr(scene.static)
        self.phases = {}

    def phase(self, kind):
        if kind not in self.phases:
            self.phases[kind] = self.equations(kind)
        return self.phases[kind]

    def slip_states(self, tape, kind):
        """Slip x, slip y, |u|, the direction's x and y, and what else is to be known."""
        if kind == "roll":
            first, second = tape.state(), tape.state()
            return first, second, None, None, None
        if kind == "onset":
            size, angle = tape.state(), tape.state()
            y, x = tape.sin_cos(angle)
            return size * x, size * y, size, x, y
        first, second = tape.state(), tape.state()
        if kind == "steep":
            return first, second, None, None, None
        size = tape.sqrt(first * first + second * second)
        return first, second, size, first / size, second / size

    def finished(self, tape, kind, named, slip_rates, rates, heat, rest):
        """The rates of all states in the variable of this phase, and the quantities that decide."""
        size, x, y = named["size"], named["x"], named["y"]
        zero = tape.constant(0)
        one = tape.constant(1)
        if kind == "roll":
            tape.rates = [zero, zero, zero, one, *rates]
        elif kind == "steep":
            tape.rates = [*slip_rates, heat, one, *rates]
        else:
            growth = slip_rates[0] * x + slip_rates[1] * y
            turn = slip_rates[1] * x - slip_rates[0] * y
            named |= {"growth": growth, "turn": turn}
            if kind == "onset":
                named["residual"] = turn - tape.drift(size, tape.states[1])
                tape.rates = [growth, zero, heat, one, *rates]
            else:
                tape.rates = [size * rate for rate in [*slip_rates, heat, one, *rates]]
        return Phase(tape, **named, **rest)

    def at(self, kind, y):
        """The quantities of a phase at a state, at once."""
        phase = self.phase(kind)
        phase.tape.expand(y, 0)
        return phase

    def directed(self, y, angle, size):
        """A state with the slip in a direction of the phase's plane."""
        return [size * gmpy2.cos(angle), size * gmpy2.sin(angle), *y[2:]]

    def turning(self, y, angle):
        """f and lambda of a state at u = 0, for one direction."""
        phase = self.at("onset", [mpfr(0), angle, *y[2:]])
        return phase.turn.c[0], phase.growth.c[0], phase.normal.c[0]


class Vectors(Formulation):
    """Newton's and Euler's equations in the laboratory frame."""

    order, tolerance, cut, last = 33, mpfr("1e-34"), 0.9, 38

    def start(self):
        theta, w1, w2, w3, u_h, u_2 = (mpfr(x) for x in self.scene.start)
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        zero, one = mpfr(0), mpfr(1)
        e1, e2, e3 = [c, zero, s], [zero, one, zero], [-s, zero, c]
        w = add(scaled(w1, e1), scaled(w2, e2), scaled(w3, e3))
        r = add(scaled(-self.rim, e1), scaled(-self.ell, e3), [zero, zero, -self.fillet])
        v = add([u_h, u_2, zero], scaled(mpfr(-1), cross(w, r)))
        # the lowest point moves round the rim and stays on the table, as the point of the body there does
        return [u_h, u_2, zero, zero, *scaled(mpfr(-1), r), *v, *e3, *e1, *w]

    def equations(self, kind):
        tape = Tape()
        ux, uy, size, x, y = self.slip_states(tape, kind)
        tape.state(), tape.state()
        _, v, e3, material, w = ([tape.state() for _ in range(3)] for _ in range(5))
        up = e3[2]
        axis = cross(w, e3)
        if self.rim:
            s = tape.sqrt(e3[0] * e3[0] + e3[1] * e3[1])
            s1 = -(up * axis[2]) / s
            e1 = [-(up * e3[0]) / s, -(up * e3[1]) / s, s]
            e1_rate = [-(axis[2] * e3[i] + up * axis[i] + s1 * e1[i]) / s for i in (0, 1)]
            arm = [-(self.rim * e1[i]) - self.ell * e3[i] for i in range(3)]
            moving = [-(self.rim * (e1_rate[i] if i < 2 else s1)) - self.ell * axis[i] for i in range(3)]
        else:
            s = None
            arm, moving = scaled(-self.ell, e3), scaled(-self.ell, axis)
        r = [arm[0], arm[1], arm[2] - self.fillet]
        spin = dot(w, e3)

        def turned(torque):
            """The inverse of the inertia: the angular acceleration."""
            along = dot(torque, e3)
            more = (1 / self.i3 - 1 / self.i1) * along
            return [torque[i] / self.i1 + more * e3[i] for i in range(3)]

        def lifting(acceleration):
            """Of the second rate of e3 . z and of the sine, what is linear in it."""
            change = acceleration[0] * e3[1] - acceleration[1] * e3[0]
            return -(self.ell * change) + (self.rim * (up * change) / s if s is not None else 0)

        # without force: u' and the acceleration of the lowest point
        momentum = [self.i1 * w[i] + (self.i3 - self.i1) * (spin * e3[i]) for i in range(3)]
        free = turned(scaled(mpfr(-1), cross(w, momentum)))
        carried = cross(w, axis)[2]
        lift = lifting(free) - self.ell * carried - 1
        if s is not None:
            lift = lift + self.rim * (axis[2] * axis[2] + up * carried + s1 * s1) / s
        free_slip = add(cross(free, r), cross(w, moving))[:2]

        def response(force):
            """Angular acceleration, u' and the acceleration of the lowest point that a force gives."""
            acceleration = turned(cross(r, force))
            slip = cross(acceleration, r)
            return acceleration, [force[0] + slip[0], force[1] + slip[1]], force[2] + lifting(acceleration)

        zero, one = tape.constant(0), tape.constant(1)
        if kind == "roll":
            units = [[one, zero, zero], [zero, one, zero], [zero, zero, one]]
            columns = [[*slip, height] for _, slip, height in map(response, units)]
            known = [-free_slip[0], -free_slip[1], -lift]
            minors = (
                cross(columns[1], columns[2]),
                cross(columns[2], columns[0]),
                cross(columns[0], columns[1]),
            )
            volume = dot(columns[0], minors[0])
            force = [dot(known, m) / volume for m in minors]
            normal = force[2]
            pushed = response(force)[0]
            slip_rates, heat = [zero, zero], zero
        else:
            if kind == "steep":
                c = self.mu if self.scene.law == "viscous" else mpfr(0)
                aim = [-(c * ux), -(c * uy), one]
            else:
                aim = [-(self.mu * x), -(self.mu * y), one]
            pushed, slip, height = response(aim)
            normal = -(lift / height)
            force = [normal * a for a in aim]
            pushed = [normal * a for a in pushed]
            slip_rates = [free_slip[i] + normal * slip[i] for i in (0, 1)]
            heat = -(force[0] * ux + force[1] * uy)
        acceleration = add(free, pushed)
        rates = [*v, force[0], force[1], normal - 1, *axis, *cross(w, material), *acceleration]
        demand = self.static * self.static * (normal * normal) - force[0] * force[0] - force[1] * force[1]
        named = {"size": size, "x": x, "y": y}
        rest = {"normal": normal, "force": force, "demand": demand, "up": up, "s": s, "watch_face": s}
        return self.finished(tape, kind, named, slip_rates, rates, heat, rest)

    def bearing(self, y, angle):
        """The direction of the slip from the lean, of an angle of the laboratory."""
        lean = self.lean(y)
        return angle - gmpy2.atan2(lean[1], lean[0])

    def lean(self, y):
        """The direction of the lean; that of the step before where the axis is vertical, as a planar fall ends."""
        e3 = y[10:13]
        s = gmpy2.sqrt(e3[0] ** 2 + e3[1] ** 2)
        return [-e3[0] / s, -e3[1] / s]

    def taken_apart(self, y, lean):
        """Slip, sine, lean, axes, w, r, and the rest of a state."""
        ux, uy, heat, _, *rest = y
        place, v, e3, material, w = (rest[3 * i : 3 * i + 3] for i in range(5))
        h = lean or self.lean(y)
        s = -(h[0] * e3[0] + h[1] * e3[1])
        e1 = [e3[2] * h[0], e3[2] * h[1], s]
        r = add(scaled(-self.rim, e1), scaled(-self.ell, e3), [0, 0, -self.fillet])
        return ux, uy, heat, place, v, e3, material, w, h, s, e1, r

    def read(self, y, lean=None):
        """(theta, w1, w2, w3, u_h, u_2), heat, (phi, psi), contact; phi and psi up to whole turns."""
        ux, uy, heat, place, _, e3, material, w, h, s, e1, r = self.taken_apart(y, lean)
        e2 = cross(e3, e1)
        slip = [ux * h[0] + uy * h[1], uy * h[0] - ux * h[1]]
        state = [gmpy2.atan2(s, e3[2]), dot(w, e1), dot(w, e2), dot(w, e3), *slip]
        pose = [gmpy2.atan2(h[1], h[0]), gmpy2.atan2(dot(material, e2), dot(material, e1))]
        return state, heat, pose, [place[0] + r[0], place[1] + r[1]]

    def strayed(self, y, lean=None):
        """How far the integrated slip is from v + w x r, the rim from the table, and the axes from their lengths."""
        ux, uy, _, place, v, e3, material, w, _, _, _, r = self.taken_apart(y, lean)
        slip = add(v, cross(w, r))
        parts = [slip[0] - ux, slip[1] - uy, slip[2], place[2] + r[2], dot(e3, e3) - 1, dot(material, e3)]
        return max(abs(p) for p in parts)


class Reduced(Formulation):
    """The closed system of six numbers, and quadratures."""

    order, tolerance, cut, last = 37, mpfr("1e-35"), 0.6, 44

    def start(self):
        theta, w1, w2, w3, u_h, u_2 = (mpfr(x) for x in self.scene.start)
        return [u_h, u_2, mpfr(0), mpfr(0), theta, w1, w2, w3, *[mpfr(0)] * 4]

    def equations(self, kind):
        tape = Tape()
        u_h, u_2, size, x, y = self.slip_states(tape, kind)
        tape.state(), tape.state()
        theta, w1, w2, w3, phi, _, _, _ = (tape.state() for _ in range(8))
        s, c = tape.sin_cos(theta)
        ell, i1, i3, rho, a = self.ell, self.i1, self.i3, self.fillet, self.rim
        radius, depth = rho * s + a, rho * c + ell
        g0, g1 = ell * s - a * c, ell * c + a * s
        height = g1 + rho
        precession = w1 / s
        ct_w1 = c * precession
        couple = w1 * (i3 * w3 - i1 * ct_w1)
        square = w2 * w2
        v_h, v_2 = u_h + height * w2, u_2 - depth * w1 + radius * w3
        inertia = g0 * g0 + i1
        bare = (i1 * (1 - g1 * square) + g0 * couple) / inertia
        round_fillet = rho * w2 * (s * w1 + c * w3)
        zero = tape.constant(0)
        if kind == "roll":
            tilt = (couple - g0 * (1 - g1 * square)) / inertia  # w2' without F_h
            along = (-(precession * v_2) + g0 * square + height * tilt) / (1 + height * height / inertia)
            spun = (w2 * (i1 * ct_w1 - i3 * w3)) / i1
            across = (precession * v_h - depth * spun - round_fillet) / (
                1 + depth * depth / i1 + radius * radius / i3
            )
            normal = bare - g0 * height * along / inertia
            heat = zero
        elif kind == "steep":
            drag = self.mu if self.scene.law == "viscous" else mpfr(0)
            normal = bare / (1 - drag * (g0 * height * u_h) / inertia)
            along, across = -(drag * (normal * u_h)), -(drag * (normal * u_2))
        else:
            normal = bare / (1 - self.mu * (g0 * height * x) / inertia)
            along, across = -(self.mu * (normal * x)), -(self.mu * (normal * y))
        heat = -(along * u_h + across * u_2) if kind != "roll" else zero
        w1_rate = (w2 * (i1 * ct_w1 - i3 * w3) + depth * across) / i1
        w3_rate = -(radius * across) / i3
        w2_rate = (couple - g0 * normal - height * along) / i1
        slip_rates = [
            along + precession * v_2 - g0 * square - height * w2_rate,
            across - precession * v_h + depth * w1_rate - radius * w3_rate + round_fillet,
        ]
        psi_rate = w3 - ct_w1
        out, side = u_h + rho * w2, u_2 + radius * psi_rate
        sin_phi, cos_phi = tape.sin_cos(phi)
        path = [out * cos_phi - side * sin_phi, out * sin_phi + side * cos_phi]
        rates = [-w2, w1_rate, w2_rate, w3_rate, precession, psi_rate, *path]
        demand = self.static * self.static * (normal * normal) - along * along - across * across
        named = {"size": size, "x": x, "y": y}
        rest = {
            "normal": normal,
            "force": [along, across, normal],
            "demand": demand,
            "up": c,
            "s": s,
            "watch_face": theta,
        }
        return self.finished(tape, kind, named, slip_rates, rates, heat, rest)

    def bearing(self, y, angle):
        return angle

    def lean(self, y):
        return None

    def read(self, y, lean=None):
        u_h, u_2, heat, _, theta, w1, w2, w3, phi, psi, *contact = y
        return [theta, w1, w2, w3, u_h, u_2], heat, [phi, psi], contact

    def strayed(self, y, lean=None):
        return mpfr(0)


# What happens next.


def departure(model, y):
    """The one direction in which slip can begin at u = 0: f = 0 and lambda > 0, with the contact pressed."""
    places = 180
    step = 2 * gmpy2.const_pi() / places
    first = mpfr("0.0123")
    values = [model.turning(y, first + k * step)[0] for k in range(places)]
    found = []
    for k in range(places):
        if (values[k] > 0) != (values[(k + 1) % places] > 0):
            low, high, f_low, f_high = (
                first + k * step,
                first + (k + 1) * step,
                values[k],
                values[(k + 1) % places],
            )
            for _ in range(7):  # then secants
                middle = (low + high) / 2
                f = model.turning(y, middle)[0]
                low, f_low, high, f_high = (
                    (middle, f, high, f_high) if (f > 0) == (f_low > 0) else (low, f_low, middle, f)
                )
            for _ in range(12):
                if f_high == f_low or high == low:
                    break
                low, f_low, high = high, f_high, (low * f_high - high * f_low) / (f_high - f_low)
                f_high = model.turning(y, high)[0]
            _, growth, normal = model.turning(y, high)
            if growth > 0 and normal > 0:
                found.append(high)
    assert len(found) == 1, (model.scene.name, [float(x) for x in found])
    return found[0]


def slipping(model, y, out):
    """The phase that follows at u = 0, with its state: rolling, or slip in the only direction there is."""
    y = [mpfr(0), mpfr(0), *y[2:]]
    rolling = model.at("roll", y)
    if rolling.normal.c[0] > 0 and rolling.demand.c[0] >= 0:
        return "roll", y
    angle = departure(model, y)
    out.note("leaves u = 0 at", model.bearing(y, angle))
    return "slip", model.directed(y, angle, TINY)


def onset(model, y, out):
    """Slip that begins as |F| = mu N is passed: a state a little later, by the series in t, and its time.

    The series is asymptotic. The step is where its last numbers are smallest compared with the first.
    """
    rolling = model.at("roll", y)
    force = [x.c[0] for x in rolling.force]
    angle = gmpy2.atan2(-force[1], -force[0])
    phase = model.phase("onset")
    begin = [mpfr(0), angle, *y[2:]]
    phase.tape.expand(begin, 0)
    out.note("onset with lambda, f", phase.growth.c[0], phase.turn.c[0])
    phase.tape.expand_slaved(begin, model.last, phase.tape.states[1], phase.residual)
    size = phase.tape.states[0]
    assert size.c[2] > 0
    h = mpfr(1)
    for node in phase.tape.states:
        for k in range(model.last - 8, model.last + 1):
            scale = size.c[2] if node is size else mpfr(1)
            power = k - 2 if node is size else k
            if node.c[k]:
                h = min(h, (mpfr("1e-34") * scale / abs(node.c[k])) ** (mpfr(1) / power))
    h = h * mpfr(model.cut)
    out.note("series to", h)
    size, angle, *rest = (node.at(h) for node in phase.tape.states)
    return [size * gmpy2.cos(angle), size * gmpy2.sin(angle), *rest]


class Record:
    """The checkpoints of one formulation of a motion."""

    def __init__(self, model, loud):
        self.model, self.loud, self.rows, self.steps, self.strayed = model, loud, [], 0, mpfr(0)

    def note(self, *words):
        if self.loud:
            print(
                "   ",
                type(self.model).__name__,
                *(w if isinstance(w, str) else f"{float(w):.6g}" for w in words),
            )

    def add(self, kind, t, y, lean=None):
        state, heat, pose, contact = self.model.read(y, lean)
        self.rows.append((kind, [t, *state, heat, *pose, *contact]))
        self.strayed = max(self.strayed, self.model.strayed(y, lean))
        self.note(kind, *self.rows[-1][1])


def step_size(phase, order, tolerance):
    """Where the last two orders of every state fall below the tolerance."""
    h = mpfr(LONGEST)
    slip = None if phase.size is None else phase.size.c[0]
    for i, node in enumerate(phase.tape.states):
        scale = slip if i < 2 and slip is not None else max(mpfr(1), abs(node.c[0]))
        for k in (order - 1, order):
            if node.c[k]:
                h = min(h, (tolerance * scale / abs(node.c[k])) ** (mpfr(1) / k))
    return h


def follow(model, loud=False):
    """The checkpoints of a scene."""
    scene, out = model.scene, Record(model, loud)
    samples = [mpfr(t) for t in scene.samples]
    end = mpfr(scene.end)
    smooth = scene.law == "viscous" or scene.mu == 0
    y = model.start()
    if smooth:
        kind = "steep"
    elif y[0] == 0 and y[1] == 0:
        kind, y = slipping(model, y, out)
    else:
        kind = "slip"
    while True:
        phase = model.phase(kind)
        tape = phase.tape
        lean = model.lean(y)
        tape.expand(y, model.order)
        out.steps += 1
        h = step_size(phase, model.order, model.tolerance)
        t = tape.states[3]

        events = [("lift-off", phase.normal)] if kind != "roll" else [("slips", phase.demand)]
        if scene.side:
            events.append(("side", phase.up))
        if model.rim:
            events.append(("face", phase.watch_face))
        first = None
        places = [h * k / 12 for k in range(13)]
        for name, node in events:
            values = [node.at(p) for p in places]
            for k in range(12):
                if values[k] > 0 >= values[k + 1]:
                    if first is None or places[k] <= first[0]:
                        x = root(node, places[k], places[k + 1])
                        if first is None or x < first[0]:
                            first = (x, name)
                    break
        h_end = first[0] if first else h
        while samples and samples[0] <= t.at(h_end):
            when = samples[0]
            if when < t.c[0]:
                raise ArithmeticError(
                    f"{scene.name}: the sample {float(when)} was passed by the series of an onset"
                )
            place = time_root(t, when, h_end) if kind == "slip" else when - t.c[0]
            out.add("end" if when == end else "sample", when, [node.at(place) for node in tape.states])
            samples.pop(0)
            if when == end:
                return out
        y = [node.at(h_end) for node in tape.states]
        if first:
            name = first[1]
            if name == "slips":
                y = [mpfr(0), mpfr(0), *y[2:]]
            out.add(name, y[3], y, lean if name == "face" else None)
            if name != "slips":
                return out
            if model.static == model.mu:
                y = onset(model, y, out)
            else:
                y = model.directed(y, departure(model, y), TINY)
            kind = "slip"
        elif kind == "slip":
            size = gmpy2.sqrt(y[0] ** 2 + y[1] ** 2)
            if size < TINY and size < phase.size.c[0]:
                there = model.at("slip", y)
                growth = there.growth.c[0]
                out.note("u vanishes with lambda, normal", growth, there.normal.c[0])
                assert growth < 0
                y[3] += size / -growth
                kind, y = slipping(model, y, out)
                out.add("rolls" if kind == "roll" else "passes", y[3], [mpfr(0), mpfr(0), *y[2:]])


def time_root(t, when, high):
    """Where the time t, which only grows, is a given one."""
    low, place = mpfr(0), high / 2
    f = None
    for _ in range(200):
        f = t.at(place) - when
        if f > 0:
            high = place
        else:
            low = place
        slope = mpfr(0)
        for k in range(len(t.c) - 1, 0, -1):
            slope = slope * place + k * t.c[k]
        following = place - f / slope
        if not low <= following <= high:
            following = (low + high) / 2
        if abs(following - place) <= abs(place) * mpfr("1e-39"):
            return following
        place = following
    return place


# The scenes.


class Scene:
    """A body (ell, i1, i3, fillet), a law of friction, a start (theta, w1, w2, w3, u_h, u_2) and times."""

    def __init__(self, name, body, mu, start, end, law="coulomb", static=None, samples=8, theta_end=None):
        self.name, self.law, self.theta_end = name, law, theta_end
        self.body = [float(x) for x in body]
        self.mu = float(mu)
        self.static = self.mu if static is None else float(static)
        self.start = [float(x) for x in start]
        self.end = float(end)
        self.samples = sorted({float(end * k / samples) for k in range(1, samples + 1)})
        self.side = self.body[0] > 0 and self.body[3] < 1


def tube(ell, bore, fillet=0.0):
    i3 = (1 + bore * bore) / 2
    return ell, i3 / 2 + ell * ell / 3, i3, fillet


def moved(body, start, along, across):
    """A start whose centre has this velocity."""
    ell, _, _, rho = body
    theta, w1, w2, w3 = start
    s, c = math.sin(theta), math.cos(theta)
    height = rho + ell * c + (1 - rho) * s
    return theta, w1, w2, w3, along - height * w2, across + (ell + rho * c) * w1 - (1 - rho + rho * s) * w3


HALF_PI = math.pi / 2


def scenes():
    paper = tube(6.0, 0.8)
    hoop, disk = tube(0.0, 1.0), tube(0.05, 0.0)

    def launched(w1, x, v_2=None):
        """Of the paper's tube, at pi/2: launch number x; full reaction of the table if v_2 is not given."""
        w3 = x * 6.0 / (paper[2] * w1)
        return moved(paper, (HALF_PI, w1, 0.0, w3), 0.0, -paper[1] / 6 * w1 if v_2 is None else v_2)

    pencil = tube(10.0, 0.0)
    standing = math.atan2(1.0, 10.0)
    can = tube(0.5, 0.0)
    nutating = (0.6, 1.2, 0.4, 0.3, 0.1, -0.2)
    coin = (0.12, 0.2575, 0.4917, 0.05)
    top = (-0.2, 0.39, 0.40, 1.0)

    yield Scene("hoop that comes back", hoop, 0.3, (HALF_PI, 0, 0, -3, 0, 5), 12)
    yield Scene("disk thrown to its side", disk, 0.2, (1.2, 0.4, 0.1, -1, 0.5, 2), 5)
    yield Scene("disk from slip to roll", tube(0.02, 0.0), 0.8, (0.9, 1.1, -0.2, 0.5, -1, 1.5), 6)
    yield Scene("pencil falls", pencil, 0.25, (standing + 0.02, 0, 0, 0, 0, 0), 30)
    yield Scene(
        "pencil with static friction falls", pencil, 0.25, (standing + 0.02, 0, 0, 0, 0, 0), 30, static=0.3
    )
    yield Scene("pencil turning as it falls", pencil, 0.25, (standing + 0.02, 0.05, 0, 0.1, 0, 0), 30)
    yield Scene("rod dragged back", pencil, 0.35, (0.6, 0, -0.3, 0, 0.4, 0), 4)
    yield Scene("cylinder falls on its face", tube(1.0, 0.0), 0.3, (0.5, 0, 0, 0, 0.2, 0), 4)
    yield Scene("cylinder slides rolls and slides", tube(1.0, 0.0), 0.25, (0.5, 1, 0.3, 0.5, 0.1, -0.2), 4)
    yield Scene(
        "cylinder with static friction", tube(1.0, 0.0), 0.25, (0.5, 1, 0.3, 0.5, 0.1, -0.2), 4, static=0.35
    )
    yield Scene("can that rolls twice", can, 0.3, nutating, 4)
    yield Scene("can that slips again and again", can, 0.25, nutating, 10)
    yield Scene("Euler's disk with slip", coin, 0.2, (0.5, 1.2, 0, 0.3, 0.1, -0.6), 8)
    yield Scene("coin on a smooth table", coin, 0, (0.5, 1.2, 0, 0.3, 0.1, -0.6), 10)
    yield Scene("tube rises and lies down", paper, 0.3, launched(1.5, 1.2), 25)
    yield Scene("tube hops", paper, 0.3, launched(3.0, 3.0), 10)
    yield Scene("tube with its centre at rest", paper, 0.3, launched(3.0, 1.3, 0.0), 25)
    yield Scene("tube flicked at 0.3", paper, 0.3, launched(3.0, 1.3), 50)
    yield Scene("tube flicked at 0.15", paper, 0.15, launched(4.0, 1.1), 90)
    yield Scene("tippe top locks into rolling", top, 0.3, moved(top, (0.3, 0.3, 0.1, 3), 0, 0), 4)
    yield Scene("ball that rolls twice", (0.3, 0.5, 0.4, 1.0), 0.2, (1.2, 1, 0.1, 2, 0.3, 1), 6)
    held, rounded, long = (1.8, 1.34, 0.5, 0.0), (1.45, 0.63, 0.21, 0.69), (4.57, 7.23, 0.52, 0.0)
    yield Scene("cylinder slips at a high mu", held, 1.89, (1.21, -0.64, -0.17, -0.02, 0, 0), 2)
    yield Scene("rounded body slips at last", rounded, 1.43, (0.87, 0.002, -0.15, 0.32, 0, 0), 3)
    yield Scene("tube leaps as it slips", long, 1.01, (1.567, 0, 0.97, 0, 0, 0), 1, static=1.28, samples=128)
    yield Scene("tippe top turns over", top, 0.3, moved(top, (0.2, 0.5, 0, 12), 0, 0), 10, law="viscous")


# The table.

HEAD = (
    "name,law,ell,i1,i3,fillet,mu,static,theta0,w10,w20,w30,u_h0,u_20,"
    "kind,t,theta,w1,w2,w3,u_h,u_2,heat,phi,psi,x,y,agreement"
)


def compared(one, other):
    """The rows of the second with the turns of its angles, and how far the first is from it."""
    assert [kind for kind, _ in one.rows] == [kind for kind, _ in other.rows], (one.rows, other.rows)
    whole = 2 * gmpy2.const_pi()
    for (kind, a), (_, b) in zip(one.rows, other.rows, strict=True):
        differences = []
        for i, (x, y) in enumerate(zip(a, b, strict=True)):
            difference = abs(x - y)
            if i in (8, 9):
                difference = abs(difference - whole * gmpy2.rint(difference / whole))
            differences.append(difference / max(1, abs(y)))
        yield kind, b, max(differences)


def rows_of(scene):
    inputs = [*scene.body, scene.mu, scene.static, *scene.start]
    begin = ",".join([scene.name, scene.law, *(x.hex() for x in inputs)])
    found = []
    for make in (Vectors, Reduced):
        begun = time.time()
        found.append(follow(make(scene)))
        out = found[-1]
        print(f"{scene.name}: {make.__name__}, {out.steps} steps, {time.time() - begun:.0f} s", flush=True)
    print(f"    slip, height and axes of the vectors kept to {float(found[0].strayed):.0e}")
    lines, worst = [], 0
    for kind, values, agreement in compared(*found):
        worst = max(worst, agreement)
        numbers = [f"{0 if abs(x) < 1e-35 else x:.24e}" for x in values]
        lines.append(",".join([begin, kind, *numbers, f"{float(agreement):.1e}"]))
    events = "; ".join(f"{k} {float(v[0]):.4f}" for k, v in found[1].rows if k != "sample")
    print(f"    {events}\n    agreement {float(worst):.1e}", flush=True)
    return lines


def main():
    precise(DIGITS)
    path = HERE / "slip_motion.csv"
    names = sys.argv[1:]
    old = path.read_text().splitlines()[1:] if names and path.exists() else []
    table = {}
    for line in old:
        table.setdefault(line.split(",", 1)[0], []).append(line)
    known = {}
    for scene in scenes():
        if not names or any(scene.name.startswith(name) for name in names):
            known[scene.name] = rows_of(scene)
        elif scene.name in table:
            known[scene.name] = table[scene.name]
        path.write_text("\n".join([HEAD, *(line for rows in known.values() for line in rows)]) + "\n")


if __name__ == "__main__":
    main()
