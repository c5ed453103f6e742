"""Writes losses.json: motions that losses slow down, the reference of their tests.

    python tests/reference/losses.py [name ...]      those whose names begin so; or all

It needs gmpy2, and five minutes for all of them on one core.

Every motion is made from two formulations that share the series of series.py, the laws of the losses as
vectors, and the order of the phases:

    vectors   three-dimensional, in the laboratory frame: axis, one material vector, angular velocity w,
              centre of mass and its velocity v. With r from the centre to the contact, the force is found
              from linear equations: d/dt (v + w x r) = 0 in rolling, of slip only its vertical part.
    momenta   in the frame (h, e2, z) that precesses and does not tilt: in rolling the angular momentum about
              the contact, which moves, so that no contact force appears; in slip that about the centre. The
              normal force follows from the height of the centre.

h = c e1 - s e3 is horizontal in the leaning plane. With psi' = -w.h/s, the radius A of the circle of contact
and the normal force N, the couple on the body is the sum of

    dry         eps N A sgn(psi') h/s             drilling    -mu_p N sgn(w.z) z
    viscous     c A^2 psi' h/s                    air         -b w
    rolling     -delta N w_horizontal/|...|       air2        -b2 |w| w
    film        (pi/4) mu psi' h/s^2              layer       k |psi'|^(3/2) sgn(psi') h/s

A row is a checkpoint: what is there, the time, the state (theta, w1, w2, w3), the slip along the lean and
across, the work lost to the couples, the heat of the slip, and (phi, psi, x, y), which start at 0. What is
there:

    sample    nothing                             crosses   psi' = 0, and psi' goes on with the other sign
    rolls     slip ends in rolling                stops     psi' = 0, and dry friction holds it there
    slips     |F| = mu N in rolling               holds     w.z = 0, and drilling friction holds it there
    end       the last time                       goes on   what was held is let go
    side      the axis is horizontal              face      the axis is vertical: the face lands

What holds psi' or w.z at 0 is a couple along h or z, found with the acceleration, of at most the size
above. A motion goes on beyond "stops" if `beyond`, else it ends there, and in any case with its last row.
The viscous laws make psi' die so fast at the face that the equations are stiff there: the face is reached
by extrapolation in theta from a few inclinations below 1e-3.

Slip runs in the variable tau, dt = |u| dtau, down to |u| = 1e-14, from where one linear step is left.

Inputs are exact doubles; results are decimal, to 25 digits. `agreement` is the largest difference of both
formulations in all numbers of a motion, over 1 or the number if that is more.
"""

import json
import math
import pathlib
import sys
import time
from itertools import pairwise

import gmpy2
from gmpy2 import mpfr
from series import Tape, precise, root
from slip import cross, dot, scaled, time_root, tube

HERE = pathlib.Path(__file__).parent
DIGITS = 40
LEAST = mpfr("1e-14")
LONGEST = 2.0
LAWS = ("dry", "viscous", "rolling", "drilling", "air", "air2", "film", "layer")
NAMES = ("t", "theta", "w1", "w2", "w3", "u_h", "u_2", "work", "heat", "phi", "psi", "x", "y")


def couple(tape, losses, signs, w, h, s, radius):
    """The couple without the normal force, and that per unit of it; z is the third axis of either frame."""
    psi = -(w[0] * h[0] + w[1] * h[1]) / s
    without, along, per_normal, along_per_normal = [], [], [], []
    sign = mpfr(signs[0])
    if losses["dry"]:
        along_per_normal.append(losses["dry"] * sign * (radius / s))
    if losses["viscous"]:
        along.append(losses["viscous"] * (radius * radius * psi / s))
    if losses["film"]:
        along.append((gmpy2.const_pi() / 4 * losses["film"]) * (psi / (s * s)))
    if losses["layer"]:
        size = psi * sign
        along.append((losses["layer"] * sign) * (size * tape.sqrt(size) / s))
    if losses["air"]:
        without.append(scaled(-losses["air"], w))
    if losses["air2"]:
        size = tape.sqrt(dot(w, w))
        without.append([-losses["air2"] * (size * x) for x in w])
    if losses["rolling"]:
        size = tape.sqrt(w[0] * w[0] + w[1] * w[1])
        per_normal.append([-losses["rolling"] * (w[i] / size) for i in (0, 1)] + [tape.constant(0)])
    if losses["drilling"]:
        vertical = tape.constant(-losses["drilling"] * mpfr(signs[1]))
        per_normal.append([tape.constant(0), tape.constant(0), vertical])
    zero = [tape.constant(0)] * 3
    pairs = ((without, along), (per_normal, along_per_normal))
    return psi, *(
        add(zero, zero, *vectors, *([q * x for x in h] for q in amounts)) for vectors, amounts in pairs
    )


def add(*vectors):
    """The sum of any number of vectors."""
    total = vectors[0]
    for other in vectors[1:]:
        total = [x + y for x, y in zip(total, other, strict=True)]
    return total


class Phase:
    """The equations of a phase: the tape, and the quantities that decide."""

    def __init__(self, tape, rates, size, **named):
        self.tape, self.size = tape, size
        tape.rates = rates if size is None else [size * rate for rate in rates]
        self.__dict__.update(named)


class Formulation:
    """A scene and its phases; the first numbers of a state are the time, the work lost and the heat."""

    def __init__(self, scene):
        self.scene = scene
        self.ell, self.i1, self.i3, self.fillet = (mpfr(x) for x in scene.body)
        self.rim = 1 - self.fillet
        self.mu = mpfr(scene.mu)
        self.losses = {name: mpfr(scene.losses.get(name, 0.0)) for name in LAWS}
        self.phases = {}

    def phase(self, kind, signs):
        if (kind, signs) not in self.phases:
            self.phases[kind, signs] = self.equations(kind, signs)
        return self.phases[kind, signs]

    def at(self, kind, signs, y):
        """The quantities of a phase at a state, with their first rates."""
        phase = self.phase(kind, signs)
        phase.tape.expand(y, 1)
        return phase

    def rolls(self, kind):
        return kind not in ("smooth", "slip")

    def hold(self, kind, push, normal, s):
        """What dry friction could hold less what it holds, of the squares; None where it holds nothing."""
        if push is None:
            return None
        most = self.losses["dry"] * normal * (self.fillet * s + self.rim) / s
        most = most if kind == "held rim" else self.losses["drilling"] * normal
        return most * most - push * push

    def friction(self, tape, kind, u):
        """|u| of a slip with friction, and the direction of the force per unit of N."""
        if kind == "smooth":
            return None, [tape.constant(0), tape.constant(0), tape.constant(1)]
        size = tape.sqrt(u[0] * u[0] + u[1] * u[1])
        return size, [-(self.mu * (u[0] / size)), -(self.mu * (u[1] / size)), tape.constant(1)]


class Vectors(Formulation):
    """Newton's and Euler's equations in the laboratory frame."""

    order, tolerance = 33, mpfr("1e-34")
    faces = [mpfr(4 + j) / 100000 for j in range(10, -1, -1)]

    def start(self):
        theta, w1, w2, w3, u_h, u_2 = (mpfr(x) for x in self.scene.start)
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        zero, one = mpfr(0), mpfr(1)
        e1, e2, e3 = [c, zero, s], [zero, one, zero], [-s, zero, c]
        w = add(scaled(w1, e1), scaled(w2, e2), scaled(w3, e3))
        r = add(scaled(-self.rim, e1), scaled(-self.ell, e3), [zero, zero, -self.fillet])
        v = add([u_h, u_2, zero], scaled(mpfr(-1), cross(w, r)))
        return [zero, zero, zero, *scaled(mpfr(-1), r), *v, *e3, *e1, *w]

    def equations(self, kind, signs):
        tape = Tape()
        for _ in range(6):
            tape.state()
        v, e3, material, w = ([tape.state() for _ in range(3)] for _ in range(4))
        zero, one = tape.constant(0), tape.constant(1)
        c = e3[2]
        s = tape.sqrt(e3[0] * e3[0] + e3[1] * e3[1])
        h = [-(e3[0] / s), -(e3[1] / s), zero]
        axis = cross(w, e3)  # the rate of e3
        s_rate = -(h[0] * axis[0] + h[1] * axis[1])
        # the lever from the centre to the contact, and its rate
        e1 = [c * h[0], c * h[1], s]
        h_rate = [-((axis[i] + s_rate * h[i]) / s) for i in (0, 1)]
        e1_rate = [*(axis[2] * h[i] + c * h_rate[i] for i in (0, 1)), s_rate]
        r = [-(self.rim * e1[i]) - self.ell * e3[i] for i in range(3)]
        r[2] = r[2] - self.fillet
        r_rate = [-(self.rim * e1_rate[i]) - self.ell * axis[i] for i in range(3)]
        u = add(v, cross(w, r))

        psi, fixed, per_normal = couple(tape, self.losses, signs, w, h, s, self.fillet * s + self.rim)
        spin = dot(w, e3)

        def turned(torque):
            """The inverse of the inertia: the angular acceleration."""
            more = (1 / self.i3 - 1 / self.i1) * dot(torque, e3)
            return [torque[i] / self.i1 + more * e3[i] for i in range(3)]

        def response(force):
            """Angular acceleration, and d/dt (v + w x r), that a force and its losses give."""
            acceleration = turned(add(cross(r, force), [force[2] * x for x in per_normal]))
            return acceleration, add(force, cross(acceleration, r))

        momentum = [self.i1 * w[i] + (self.i3 - self.i1) * (spin * e3[i]) for i in range(3)]
        free = turned(add(fixed, scaled(mpfr(-1), cross(w, momentum))))
        known = add(cross(free, r), cross(w, r_rate), [zero, zero, -one])
        size, heat, push = None, zero, None
        if self.rolls(kind):
            units = [[one, zero, zero], [zero, one, zero], [zero, zero, one]]
            columns = [response(unit)[1] for unit in units]
            minors = [cross(columns[(i + 1) % 3], columns[(i + 2) % 3]) for i in range(3)]
            volume = dot(columns[0], minors[0])

            def balancing(acceleration):
                return [-(dot(acceleration, m) / volume) for m in minors]

            force = balancing(known)
            if kind != "roll":
                held, turn = (h, [*h_rate, zero]) if kind == "held rim" else (units[2], [zero] * 3)
                bare = turned(held)
                more = balancing(cross(bare, r))
                gained = dot(add(bare, response(more)[0]), held)
                push = -((dot(add(free, response(force)[0]), held) + dot(w, turn)) / gained)
                force = add(force, [push * x for x in more])
                free = add(free, [push * x for x in bare])
        else:
            size, aim = self.friction(tape, kind, u)
            normal = -(known[2] / response(aim)[1][2])
            force = [normal * x for x in aim]
            heat = -(force[0] * u[0] + force[1] * u[1])
        normal = force[2]
        acceleration = add(free, response(force)[0])
        lost = -dot(add(fixed, [normal * x for x in per_normal]), w)
        rates = [
            one,
            lost,
            heat,
            *v,
            force[0],
            force[1],
            normal - 1,
            *axis,
            *cross(w, material),
            *acceleration,
        ]
        demand = self.mu * self.mu * (normal * normal) - force[0] * force[0] - force[1] * force[1]
        decide = {"demand": demand, "hold": self.hold(kind, push, normal, s), "push": push}
        return Phase(tape, rates, size, normal=normal, psi=psi, drill=w[2], up=c, lean=s, **decide)

    def turn(self, y, _):
        return y

    def read(self, y):
        """The numbers of a row; phi and psi up to whole turns."""
        t, work, heat, *rest = y
        place, v, e3, material, w = (rest[3 * i : 3 * i + 3] for i in range(5))
        s = gmpy2.sqrt(e3[0] ** 2 + e3[1] ** 2)
        h = [-e3[0] / s, -e3[1] / s, mpfr(0)]
        e1 = [e3[2] * h[0], e3[2] * h[1], s]
        e2 = cross(e3, e1)
        r = add(scaled(-self.rim, e1), scaled(-self.ell, e3), [0, 0, -self.fillet])
        u = add(v, cross(w, r))
        self.strayed = max(abs(u[2]), abs(place[2] + r[2]), abs(dot(e3, e3) - 1), abs(dot(material, e3)))
        state = [gmpy2.atan2(s, e3[2]), dot(w, e1), dot(w, e2), dot(w, e3)]
        slip = [dot(u, h), dot(u, e2)]
        pose = [gmpy2.atan2(h[1], h[0]), gmpy2.atan2(dot(material, e2), dot(material, e1))]
        return [t, *state, *slip, work, heat, *pose, place[0] + r[0], place[1] + r[1]]


class Momenta(Formulation):
    """Angular momentum about the contact (rolling) or the centre (slip), in the frame (h, e2, z)."""

    order, tolerance = 37, mpfr("1e-35")
    faces = [mpfr(3 + j) / 100000 for j in range(11, -1, -1)]

    def start(self):
        theta, w1, w2, w3, u_h, u_2 = (mpfr(x) for x in self.scene.start)
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        w = [c * w1 - s * w3, w2, s * w1 + c * w3]
        zero = mpfr(0)
        if self.scene.contact == "rolling":
            return [zero, zero, zero, theta, *[zero] * 4, *self.momentum(theta, w, about_contact=True)]
        r = self.lever(s, c)
        v = add([u_h, u_2, zero], scaled(mpfr(-1), cross(w, r)))
        return [zero, zero, zero, theta, *[zero] * 4, *self.momentum(theta, w), v[0], v[1]]

    def lever(self, s, c):
        return [self.ell * s - self.rim * c, mpfr(0), -(self.fillet + self.ell * c + self.rim * s)]

    def momentum(self, theta, w, about_contact=False):
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        e3, r = [-s, mpfr(0), c], self.lever(s, c)
        own = add(scaled(self.i1, w), scaled((self.i3 - self.i1) * dot(w, e3), e3))
        return add(own, cross(r, cross(w, r))) if about_contact else own

    def turning(self, theta, momentum, about_contact):
        """w of a momentum."""
        columns = [self.momentum(theta, [mpfr(i == k) for i in range(3)], about_contact) for k in range(3)]
        minors = [cross(columns[(i + 1) % 3], columns[(i + 2) % 3]) for i in range(3)]
        volume = dot(columns[0], minors[0])
        return [dot(momentum, m) / volume for m in minors]

    def equations(self, kind, signs):
        tape = Tape()
        for _ in range(3):
            tape.state()
        theta, phi, _, _, _ = (tape.state() for _ in range(5))
        momentum = [tape.state() for _ in range(3)]
        zero, one = tape.constant(0), tape.constant(1)
        s, c = tape.sin_cos(theta)
        g, g1 = self.ell * s - self.rim * c, self.ell * c + self.rim * s
        height = g1 + self.fillet
        more = self.i3 - self.i1
        rolling, push = self.rolls(kind), None
        if rolling:
            hh, zz = height * height + self.i1 + more * (s * s), g * g + self.i1 + more * (c * c)
            hz = g * height - more * (s * c)
            inertia = g * g + height * height + self.i1
        else:
            hh, zz, hz = self.i1 + more * (s * s), self.i1 + more * (c * c), -(more * (s * c))
            inertia = tape.constant(self.i1)
        det = hh * zz - hz * hz
        w_h = (zz * momentum[0] - hz * momentum[2]) / det
        w_z = (hh * momentum[2] - hz * momentum[0]) / det
        w2 = momentum[1] / inertia
        w, e2_only = [w_h, w2, w_z], [one, zero, zero]
        precession = (c * w_h + s * w_z) / s
        r = [g, zero, -height]
        if rolling:
            u = [zero, zero, zero]
            v = scaled(mpfr(-1), cross(w, r))
        else:
            v = [tape.state(), tape.state(), g * w2]
            u = add(v, cross(w, r))
        psi, fixed, per_normal = couple(tape, self.losses, signs, w, e2_only, s, self.fillet * s + self.rim)
        # the velocity of the contact on the table: that of the centre and the change of the lever
        moved = [v[0] - g1 * w2, v[1] + precession * g, zero]
        carried = [precession * momentum[1], -(precession * momentum[0]), zero]  # of the rates in this frame
        # N = 1 + height'', (height)'' = g w2' - g' w2^2, and the e2 part of the momentum is inertia w2
        size, heat = None, zero
        if rolling:
            weight = cross(r, [zero, zero, one])  # r x z = -(C - P) x z
            swept = cross(moved, v)
            known = [fixed[i] + weight[i] - swept[i] + carried[i] for i in range(3)]
            inertia_rate = -2 * (g * (g1 - height)) * w2
            per = list(per_normal)
            bare = known[1] - inertia_rate * w2
        else:
            size, aim = self.friction(tape, kind, u)
            known = [fixed[i] + carried[i] for i in range(3)]
            per = add(cross(r, aim), per_normal)
            bare = known[1]
        normal = (1 - g1 * (w2 * w2) + g * bare / inertia) / (1 - g * per[1] / inertia)
        rates = [known[i] + normal * per[i] for i in range(3)]
        demand = one
        if rolling:
            # the rates of w from those of the momenta, and so the horizontal force
            hh_rate = 2 * (g * height - more * (s * c)) * w2
            zz_rate = -2 * (g * g1 - more * (s * c)) * w2
            hz_rate = -(g1 * height - g * g - more * (c * c - s * s)) * w2
            left_h = rates[0] - hh_rate * w_h - hz_rate * w_z
            left_z = rates[2] - hz_rate * w_h - zz_rate * w_z
            w_h_rate, w_z_rate = (zz * left_h - hz * left_z) / det, (hh * left_z - hz * left_h) / det
            if kind == "held rim":
                push = -(w_h_rate * det / zz)
                rates[0] = rates[0] + push
                w_h_rate, w_z_rate = zero, w_z_rate - hz * push / det
            elif kind == "held drill":
                push = -(w_z_rate * det / hh)
                rates[2] = rates[2] + push
                w_h_rate, w_z_rate = w_h_rate - hz * push / det, zero
            w2_rate = (rates[1] - inertia_rate * w2) / inertia
            v_h_rate = height * w2_rate + g * (w2 * w2)
            v_2_rate = -(g * w_z_rate) - height * w_h_rate + g1 * w2 * w_z - g * w2 * w_h
            force = [v_h_rate - precession * v[1], v_2_rate + precession * v[0]]
            demand = self.mu * self.mu * (normal * normal) - force[0] * force[0] - force[1] * force[1]
        else:
            force = [normal * aim[0], normal * aim[1]]
            heat = -(force[0] * u[0] + force[1] * u[1])
            rates += [force[0] + precession * v[1], force[1] - precession * v[0]]
        lost = -dot(add(fixed, [normal * x for x in per_normal]), w)
        sin_phi, cos_phi = tape.sin_cos(phi)
        path = [moved[0] * cos_phi - moved[1] * sin_phi, moved[0] * sin_phi + moved[1] * cos_phi]
        rates = [one, lost, heat, -w2, precession, psi, *path, *rates]
        decide = {"demand": demand, "hold": self.hold(kind, push, normal, s), "push": push}
        return Phase(tape, rates, size, normal=normal, psi=psi, drill=w_z, up=c, lean=s, **decide)

    def turn(self, y, kind):
        """The state of slip as that of rolling."""
        if kind != "roll" or len(y) == 11:
            return y
        w = self.turning(y[3], y[8:11], about_contact=False)
        return [*y[:8], *self.momentum(y[3], w, about_contact=True)]

    def read(self, y):
        t, work, heat, theta, phi, psi, a, b, *rest = y
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        w = self.turning(theta, rest[:3], about_contact=len(rest) == 3)
        u = add([*rest[3:], mpfr(0)], cross(w, self.lever(s, c))) if len(rest) > 3 else [mpfr(0), mpfr(0)]
        state = [theta, c * w[0] + s * w[2], w[1], c * w[2] - s * w[0]]
        self.strayed = mpfr(0)
        return [t, *state, *u[:2], work, heat, phi, psi, a, b]


# What happens next.


def step_size(phase, order, tolerance):
    """Where the last two orders of every state fall below the tolerance."""
    h = mpfr(LONGEST)
    for node in phase.tape.states:
        scale = max(mpfr(1), abs(node.c[0]))
        for k in (order - 1, order):
            if node.c[k]:
                h = min(h, (tolerance * scale / abs(node.c[k])) ** (mpfr(1) / k))
    return h


def first_event(events, h):
    """The first change from above 0 within a step, and its name; they are looked for at 13 places."""
    places = [h * k / 12 for k in range(13)]
    first = None
    for name, node in events:
        values = [node.at(p) for p in places]
        for k in range(12):
            if values[k] > 0 >= values[k + 1]:
                if first is None or places[k] <= first[0]:
                    x = root(node, places[k], places[k + 1])
                    first = (x, name) if first is None or x < first[0] else first
                break
    return first


def at_the_face(rows):
    """The numbers of a row at theta = 0, by Neville's polynomial through those near it."""
    found = []
    for i in range(len(NAMES)):
        column, where = [row[i] for row in rows], [row[1] for row in rows]
        for step in range(1, len(rows)):
            column = [
                (where[j] * column[j + 1] - where[j + step] * column[j]) / (where[j] - where[j + step])
                for j in range(len(rows) - step)
            ]
        found.append(column[0])
    return found


def unwound(rows):
    """Angles without jumps, from row to row near the face."""
    whole = 2 * gmpy2.const_pi()
    for one, other in pairwise(rows):
        for i in (9, 10):
            other[i] += whole * gmpy2.rint((one[i] - other[i]) / whole)
    return rows


def follow(model):
    """The checkpoints of a scene: pairs of what is there and the numbers; and the steps taken."""
    scene, rows, near_face, steps = model.scene, [], [], 0
    samples = [mpfr(t) for t in scene.samples]
    end = mpfr(scene.end)
    y = model.start()
    kind = {"rolling": "roll", "smooth": "smooth", "coulomb": "slip"}[scene.contact]
    signs = (1, 1)
    there = model.at(kind, signs, y)
    signs = tuple(1 if node.c[0] > 0 else -1 for node in (there.psi, there.drill))
    faces = list(model.faces)
    worst = mpfr(0)

    def note(name, y):
        nonlocal worst
        rows.append((name, model.read(y)))
        worst = max(worst, model.strayed)

    while True:
        phase = model.phase(kind, signs)
        tape = phase.tape
        tape.expand(y, model.order)
        steps += 1
        h = step_size(phase, model.order, model.tolerance)
        assert phase.normal.c[0] > 0 and steps < 5000, scene.name
        events = []
        if signs[0] and (model.losses["dry"] or model.losses["layer"]):
            events.append(("psi", Signed(phase.psi, signs[0])))
        if signs[1] and model.losses["drilling"]:
            events.append(("drill", Signed(phase.drill, signs[1])))
        if model.rolls(kind) and model.mu:
            events.append(("slips", phase.demand))
        if phase.hold is not None:
            events.append(("hold", phase.hold))
        if scene.body[0] > 0:
            events.append(("side", phase.up))
        if scene.face:
            events.append(("near", Above(phase.lean, gmpy2.sin(faces[0]))))
        first = first_event(events, h)
        h_end = first[0] if first else h
        t = tape.states[0]
        while samples and samples[0] <= t.at(h_end):
            when = samples.pop(0)
            place = time_root(t, when, h_end) if phase.size is not None else when - t.c[0]
            note("end" if when == end else "sample", [node.at(place) for node in tape.states])
            if when == end:
                return rows, steps, worst
        y = [node.at(h_end) for node in tape.states]
        if first:
            name = first[1]
            if name == "near":
                near_face.append(model.read(y))
                faces.pop(0)
                if not faces:
                    rows.append(("face", at_the_face(unwound(near_face))))
                    return rows, steps, worst
            elif name == "hold":
                way = 1 if phase.push.at(h_end) > 0 else -1
                signs = (way, signs[1]) if kind == "held rim" else (signs[0], -way)
                kind = "roll"
                note("goes on", y)
            elif name in ("psi", "drill"):
                which = ("psi", "drill").index(name)
                other, rest = (
                    tuple(k * sign if i == which else sign for i, sign in enumerate(signs)) for k in (-1, 0)
                )
                goes_on = getattr(model.at(kind, other, y), name).c[1] * other[which] > 0
                note("crosses" if goes_on else ("stops", "holds")[which], y)
                if goes_on:
                    signs = other
                elif which or scene.beyond:
                    kind, signs = ("held rim", "held drill")[which], rest
                else:
                    return rows, steps, worst
            else:
                note(name, y)
                return rows, steps, worst
        elif kind == "slip":
            there = model.at(kind, signs, y)
            size, growth = there.size.c[0], there.size.c[1]
            if size < LEAST:
                assert growth < 0, scene.name
                tape = there.tape
                y = [node.c[0] - node.c[1] * (size / growth) for node in tape.states]
                kind, y = "roll", model.turn(y, "roll")
                note("rolls", y)
                there = model.at(kind, signs, y)
                assert there.demand.c[0] > 0, scene.name


class Signed:
    """A series times a sign."""

    def __init__(self, node, sign):
        self.node, self.sign = node, sign

    def at(self, h):
        return self.sign * self.node.at(h)


class Above:
    """A series less a number."""

    def __init__(self, node, level):
        self.node, self.level = node, level

    def at(self, h):
        return self.node.at(h) - self.level


# The scenes.


class Scene:
    """A body (ell, i1, i3, fillet), losses, a contact, a start (theta, w1, w2, w3, u_h, u_2) and times."""

    def __init__(
        self, name, body, losses, start, end, contact="rolling", mu=0.0, samples=6, face=False, beyond=False
    ):
        self.name, self.losses, self.contact = name, losses, contact
        self.face, self.beyond = face, beyond
        self.body = [float(x) for x in body]
        self.mu = float(mu)
        self.start = [float(x) for x in (*start, 0.0, 0.0)[:6]]
        self.end = float(end)
        self.samples = sorted({float(end * k / samples) for k in range(1, samples + 1)})


def rounded(half, fillet):
    """A uniform solid disk whose edges are rounded."""
    ell, a, r, pi = half - fillet, 1 - fillet, fillet, math.pi
    p2 = a**2 * r + a * pi * r**2 / 2 + 2 * r**3 / 3
    p4 = a**4 * r + a**3 * pi * r**2 + 4 * a**2 * r**3 + 0.75 * a * pi * r**4 + 8 * r**5 / 15
    q1 = a**2 * r**2 / 2 + 2 * a * r**3 / 3 + r**4 / 4
    q2 = a**2 * r**3 / 3 + a * pi * r**4 / 8 + 2 * r**5 / 15
    m = 2 * (ell + p2)
    i3 = (ell + p4) / m
    return ell, i3 / 2 + 2 * (ell**3 / 3 + ell**2 * p2 + 2 * ell * q1 + q2) / m, i3, fillet


def steady(body, theta, w1=0.0, w2=0.0, w3=0.0):
    """The steady state with the centre at rest, and what is added to it."""
    ell, i1, i3, fillet = body
    s, c = math.sin(theta), math.cos(theta)
    radius, depth = 1 - fillet + fillet * s, ell + fillet * c
    n = (1 - fillet) * c - ell * s
    spin = s * math.sqrt(n * radius / (s * (i3 * n + (i1 - i3) * c * radius)))
    return theta, spin + w1, w2, depth / radius * spin + w3


def scenes():
    coin, paper, solid = tube(0.0, 0.0), tube(6.0, 0.8), tube(2.5, 0.0)
    disk = tube(0.0128 / 0.0751, 0.0)  # Euler's disk with a sharp rim
    low, edge = rounded(0.0128 / 0.0751, 0.05), tube(0.3, 0.0)

    yield Scene("coin, viscous contour", coin, {"viscous": 2e-3}, steady(coin, 0.3, w2=0.1), 6)
    yield Scene(
        "tube on its side, rolling resistance", paper, {"rolling": 0.01}, steady(paper, 1.35, w2=0.1), 12
    )
    yield Scene("cylinder on its side, drilling", solid, {"drilling": 0.02}, steady(solid, 1.2, w2=-0.1), 10)
    yield Scene("tube on its side, linear air", paper, {"air": 0.05}, steady(paper, 1.3, w2=0.05, w3=0.1), 12)
    yield Scene("cylinder on its end, quadratic air", solid, {"air2": 0.02}, steady(solid, 0.15, w2=0.2), 10)
    yield Scene("Euler's disk, air film", disk, {"film": 1e-4}, steady(disk, 0.2, w2=0.05), 8)
    yield Scene("Euler's disk, boundary layer", disk, {"layer": 5e-4}, steady(disk, 0.3, w2=0.1), 8)
    yield Scene("Euler's disk whirrs until it stops", disk, {"dry": 5e-3}, steady(disk, 0.3), 40, samples=20)
    yield Scene("coin at a thousandth stops", coin, {"dry": 1e-4}, steady(coin, 1e-3), 1, samples=32)
    low_start = steady(coin, 1.5e-3)
    yield Scene("coin at a thousandth, viscous", coin, {"viscous": 1e-6}, low_start, 0.4, samples=8)
    yield Scene("coin near the table, layer", coin, {"layer": 1e-6}, steady(coin, 4e-3), 0.4, samples=8)
    added = {"dry": 2e-3, "rolling": 1e-3}
    yield Scene("cylinder goes down through the ridge", solid, added, steady(solid, 0.3), 16)
    start = steady(edge, 0.5, w1=0.05, w2=0.1)
    yield Scene("disk on a smooth table", edge, {"dry": 0.01, "air": 5e-3}, start, 8, contact="smooth")
    smooth = {"rolling": 5e-3, "drilling": 5e-3}
    start = steady(solid, 1.2, w1=0.1, w2=-0.1)
    yield Scene("cylinder on a smooth table", solid, smooth, start, 8, contact="smooth")
    slipping = (*steady(paper, 1.3, w1=0.05), 0.4, -0.5)
    yield Scene(
        "tube from slip to roll", paper, {"dry": 2e-3, "air": 1e-3}, slipping, 6, contact="coulomb", mu=0.3
    )
    slipping = (*steady(disk, 0.6, w2=0.1), -0.3, 0.8)
    every = {"rolling": 5e-3, "drilling": 2e-3, "film": 2e-3}
    yield Scene("Euler's disk from slip to roll", disk, every, slipping, 5, contact="coulomb", mu=0.4)
    start = steady(low, 0.3, w2=0.1)
    yield Scene("rounded disk, dry and viscous", low, {"dry": 2e-3, "viscous": 2e-3}, start, 10)
    start = steady(low, 0.2, w2=0.02)
    yield Scene("rounded disk stops", low, {"dry": 0.01, "film": 1e-4}, start, 40, samples=20)
    yield Scene(
        "disk whirrs to its face", disk, {"viscous": 5e-3}, steady(disk, 0.2), 40, samples=40, face=True
    )
    yield Scene("Euler's disk slips at last", disk, {"dry": 0.02}, steady(disk, 0.3), 40, mu=0.35, samples=20)
    both = {"drilling": 0.01, "air2": 5e-3}
    yield Scene("cylinder lies down", solid, both, steady(solid, 1.3, w2=-0.6), 1, samples=8)
    every = dict(zip(LAWS, (2e-3, 1e-3, 1.5e-3, 1e-3, 2e-3, 1e-3, 5e-4, 3e-3), strict=True))
    yield Scene("cylinder with every loss", solid, every, steady(solid, 1.25, w2=-0.1), 8)
    wide = {"dry": 0.05}
    yield Scene(
        "disk stops and falls flat", disk, wide, steady(disk, 0.3), 9, samples=64, face=True, beyond=True
    )
    start = (1.2, -0.41, -0.2, -0.05)
    yield Scene("contact stops and goes on", disk, {"dry": 0.1}, start, 3.5, samples=7, beyond=True)
    start = (0.45, 0.3, 0.3, -0.5)
    yield Scene("drilling is held and goes on", tube(1.0, 0.0), {"drilling": 0.1}, start, 3.25)
    nodding = (0.7, 0.3, 0.3, 1.0)
    yield Scene("contact that turns back twice", tube(1.0, 0.0), {"dry": 5e-3, "viscous": 2e-3}, nodding, 3)


# The table.


def compared(one, other):
    """The rows of the second with the turns of its angles, and how far the first is from it."""
    assert [kind for kind, _ in one] == [kind for kind, _ in other], (one, other)
    whole = 2 * gmpy2.const_pi()
    worst = mpfr(0)
    for (_, a), (_, b) in zip(one, other, strict=True):
        for i, (x, y) in enumerate(zip(a, b, strict=True)):
            difference = abs(x - y)
            if i in (9, 10):
                difference = abs(difference - whole * gmpy2.rint(difference / whole))
            worst = max(worst, difference / max(1, abs(y)))
    return worst


def written(scene):
    """A motion as it stands in the file."""
    found = []
    for make in (Vectors, Momenta):
        begun = time.time()
        rows, steps, strayed = follow(make(scene))
        found.append(rows)
        told = f", constraints kept to {float(strayed):.0e}" if strayed else ""
        print(f"{scene.name}: {make.__name__}, {steps} steps, {time.time() - begun:.0f} s{told}", flush=True)
    agreement = float(compared(*found))
    events = "; ".join(f"{k} at {float(v[0]):.4f}, {float(v[1]):.4g}" for k, v in found[1] if k != "sample")
    print(f"    {events}; work {float(found[1][-1][1][7]):.3g}\n    agreement {agreement:.1e}", flush=True)
    return {
        "name": scene.name,
        "body": scene.body,
        "losses": [scene.losses.get(name, 0.0) for name in LAWS],
        "contact": scene.contact,
        "mu": scene.mu or None,
        "beyond": scene.beyond,
        "start": scene.start,
        "agreement": agreement,
        "rows": [[kind, *(f"{0 if abs(x) < 1e-35 else x:.24e}" for x in row)] for kind, row in found[1]],
    }


def main():
    precise(DIGITS)
    path = HERE / "losses.json"
    names = sys.argv[1:]
    old = {m["name"]: m for m in json.loads(path.read_text())["motions"]} if names and path.exists() else {}
    known = {}
    for scene in scenes():
        if not names or any(scene.name.startswith(name) for name in names):
            known[scene.name] = written(scene)
        elif scene.name in old:
            known[scene.name] = old[scene.name]
        head = json.dumps({"laws": LAWS, "columns": ["kind", *NAMES]})[:-1]
        motions = ",\n".join(json.dumps(m).replace(', ["', ',\n  ["') for m in known.values())
        path.write_text(f'{head}, "motions": [\n{motions}\n]}}\n')


if __name__ == "__main__":
    main()
