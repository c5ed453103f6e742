"""Writes motion.csv: high-precision motions, the reference of the tests of rolling and sliding.

    python tests/reference/motion.py

The model is the three-dimensional rigid body of Newton and Euler in the laboratory frame: axis, one material
vector, angular velocity and centre of mass are integrated as vectors, and the contact is solved for numerically
at every call. Nothing is taken from the reduced equations of the library, and no angle is integrated. mpmath at
40 digits, Gragg-Bulirsch-Stoer extrapolation to 1e-30 a step. Inputs are exact doubles, written as hexadecimal.

    rolling   v = r x w,  I w' + w x I w = r x F,  F = v' + z
    smooth    F = N z, the height of the contact held at zero, the centre's plan view at rest

r = -a e1 - ell e3 - rho z, where the rim is rounded with the fillet rho, which is 0 in all rows of motion.csv, and
a = 1 - rho.
"""

import math
import multiprocessing
import pathlib

import extrapolation
from mpmath import mp, mpf
from vectors import add, cross, dot, scaled, solver

mp.dps = 40
TOL = mpf(10) ** -30
Z = [mpf(0), mpf(0), mpf(1)]


class Scene:
    """A body, a contact and a start."""

    def __init__(self, name, contact, ell, i1, i3, theta, w1, w2, w3, fillet=0.0):
        self.name, self.contact = name, contact
        self.numbers = [float(x) for x in (ell, i1, i3, theta, w1, w2, w3)]
        self.ell, self.i1, self.i3 = (mpf(x) for x in self.numbers[:3])
        self.fillet = mpf(float(fillet))
        self.rim = 1 - self.fillet
        theta, w1, w2, w3 = (mpf(x) for x in self.numbers[3:])
        s, c = mp.sin(theta), mp.cos(theta)
        e1, e2, e3 = [c, mpf(0), s], [mpf(0), mpf(1), mpf(0)], [-s, mpf(0), c]
        w = add(scaled(w1, e1), scaled(w2, e2), scaled(w3, e3))
        self.start = e3 + e1 + w + [mpf(0)] * 5  # axis, material vector, w, contact x and y, turns so far

    def geometry(self, y):
        e3, w = y[:3], y[6:9]
        up = e3[2]
        s = mp.sqrt(e3[0] ** 2 + e3[1] ** 2)
        e1 = [(Z[i] - up * e3[i]) / s for i in range(3)]
        moving = cross(w, e3)
        s_rate = -up * moving[2] / s
        e1_rate = [(-moving[2] * e3[i] - up * moving[i]) / s - e1[i] * s_rate / s for i in range(3)]
        r = add(scaled(-self.ell, e3), scaled(-self.rim, e1), scaled(-self.fillet, Z))
        r_rate = add(scaled(-self.ell, moving), scaled(-self.rim, e1_rate))
        return e3, w, s, e1, moving, r, r_rate

    def inertia(self, e3, a):
        return add(scaled(self.i1, a), scaled((self.i3 - self.i1) * dot(e3, a), e3))

    def force(self, y):
        """Angular acceleration and contact force."""
        e3, w, _, _, _, r, r_rate = self.geometry(y)
        gyro = cross(w, self.inertia(e3, w))
        fixed = cross(r_rate, w)
        unit = [[mpf(i == j) for j in range(3)] for i in range(3)]
        if self.contact == "rolling":
            known = add(cross(r, add(fixed, Z)), scaled(mpf(-1), gyro))
            columns = [add(self.inertia(e3, e), scaled(mpf(-1), cross(r, cross(r, e)))) for e in unit]
            a = solver(columns)(known)
            return a, add(fixed, cross(r, a), Z)
        lever = cross(r, Z)
        known = add(scaled(fixed[2] + 1, lever), scaled(mpf(-1), gyro))
        columns = [add(self.inertia(e3, e), scaled(-cross(r, e)[2], lever)) for e in unit]
        a = solver(columns)(known)
        return a, [mpf(0), mpf(0), 1 + fixed[2] + cross(r, a)[2]]

    def derivative(self, y):
        e3, w, s, _, moving, r, r_rate = self.geometry(y)
        a, _ = self.force(y)
        if self.contact == "rolling":
            v = cross(r, w)  # of the centre; the contact point moves by r' more
            path = [v[0] + r_rate[0], v[1] + r_rate[1]]
        else:
            path = [r_rate[0], r_rate[1]]
        return moving + cross(w, y[3:6]) + a + path + [*self.turning(e3, w, s, moving), mpf(0)]

    def turning(self, e3, w, s, moving):
        """Rates of phi and psi."""
        precession = (e3[0] * moving[1] - e3[1] * moving[0]) / s**2
        return precession, dot(w, e3) - precession * e3[2]

    def reduced(self, y):
        """theta, w1, w2, w3."""
        e3, w, s, e1, _, _, _ = self.geometry(y)
        return [mp.atan2(s, e3[2]), dot(w, e1), dot(w, cross(e3, e1)), dot(w, e3)]

    def pose(self, y):
        """phi, psi (as angles of vectors, unwrapped by their integrals), contact x, y."""
        e3, _, _, e1, _, _, _ = self.geometry(y)
        phi = mp.atan2(-e3[1], -e3[0])
        e2 = cross(e3, e1)
        psi = mp.atan2(dot(y[3:6], e2), dot(y[3:6], e1))
        return [unwrapped(phi, y[11]), unwrapped(psi, y[12]), y[9], y[10]]

    def contact_force(self, y):
        _, f = self.force(y)
        return [f[2], mp.sqrt(f[0] ** 2 + f[1] ** 2)]


def unwrapped(angle, near):
    return angle + 2 * mp.pi * mp.nint((near - angle) / (2 * mp.pi))


COLUMNS = 13
LONG = mpf(1000)


def extrapolated(f, y, h):
    """One step of Gragg's midpoint rule, extrapolated; the result and an estimate of its error."""
    counts = [2 * (k + 1) for k in range(COLUMNS)]
    for best, before in extrapolation.steps(lambda part, y: f(y), y, h, counts):
        off = max(abs(a - b) for a, b in zip(best, before, strict=True))
        if off < TOL:
            return best, mpf(0)
    return best, off


class Walk:
    """A trajectory that goes forward, remembering where it is."""

    def __init__(self, scene):
        self.scene, self.t, self.y, self.h = scene, mpf(0), scene.start, mpf("0.1")

    def step(self, limit):
        """One accepted step, at most up to `limit`."""
        while True:
            h = min(self.h, limit - self.t)
            y, error = extrapolated(self.scene.derivative, self.y, h)
            if error < TOL:
                self.h = max(self.h, h) * mpf("1.5") if h == self.h else self.h
                return self.t + h, y
            self.h = h / 2

    def ahead(self, h):
        return extrapolated(self.scene.derivative, self.y, h)[0]

    def to(self, t):
        while self.t < t:
            self.t, self.y = self.step(t)
        return self.y

    def until(self, g, limit=LONG):
        """To the next zero of g, found by the secant rule on the length of the last step."""
        before = g(self.y)
        while self.t < limit:
            t, y = self.step(limit)
            after = g(y)
            if abs(before) > mpf(10) ** -25 and before * after <= 0:  # else it starts at a zero
                step = mp.findroot(
                    lambda h: g(self.ahead(h)),
                    (mpf(0), t - self.t),
                    solver="anderson",
                    tol=1e-50,
                    verify=False,
                )
                self.y, self.t, self.h = self.ahead(step), self.t + step, mpf("0.02")
                return True
            self.t, self.y, before = t, y, after
        return False


def shape(ell, bore=0.0):
    i3 = (1 + bore**2) / 2
    return ell, i3 / 2 + ell**2 / 3, i3


def steady(body, theta, kick=0.0):
    """Doubles of the steady state with the centre at rest (Eq. 15), kicked: any doubles would do."""
    ell, i1, i3 = body
    s, c = math.sin(theta), math.cos(theta)
    w1 = math.sqrt((c - ell * s) / ((i1 * c - i3 * ell * s) * s)) * s
    return theta, w1, -kick, ell * w1


def scenes():
    tube, half, disk = shape(6.0, 0.8), shape(1.0), shape(0.17043941411451397)
    critical = shape(math.sqrt(0.75))
    theta0 = math.atan2(1, math.sqrt(0.75))
    rate = 1.5 * math.sin(theta0) / math.sqrt(0.5)
    coin, hoop = shape(0.0), shape(0.0, 1.0)
    for contact in ("rolling", "smooth"):
        yield "near-steady tube", contact, tube, steady(tube, math.radians(85), 0.05), (20, 1e4)
        yield "nutating cylinder", contact, half, steady(half, 0.5, 0.3), (20, 1e4, 1e6, 1e9)
        yield "Euler's disk", contact, disk, steady(disk, 0.2, 0.02), (20, 1e4)
        yield "critical aspect", contact, critical, (theta0, rate, -0.05, critical[0] * rate), (20, 1e4)
        yield "slow saddle", contact, half, (math.pi / 4 - 1e-3, 0.02, 0.0, 0.0), (2, 8)
        yield "tiny kick", contact, shape(2.5), steady(shape(2.5), 1.3, 1e-9), (20,)
        yield "coin through the vertical", contact, coin, (1.5, 1.2, -0.3, 0.2), (20, 1e4)
        yield "hoop", contact, hoop, (1.0, 1.1, 0.1, 2.0), (20,)
    yield "rolling on edge", "rolling", coin, (1.45, 0.1, 0.0, -3.0), (20,)
    yield "wide swing", "rolling", half, (0.45, 0.7, -1.0, 1.5), (20, 1e4)
    yield "circling", "rolling", shape(0.5), (0.9, 1.0, 0.2, 2.0), (20,)
    yield "bottle", "rolling", (1.2, 0.7, 0.5), (0.4, 1.0, 0.3, 2.0), (20,)
    for exponent in (3, 5, 7):
        yield f"rocking can 1e-{exponent}", "rolling", half, (0.3, 1.3 * 10.0**-exponent, 0.0, 0.0), (2,)
    for ell in (0.0, 0.05, 0.5, 1.0):
        for exponent in (3, 4, 5):
            yield f"D6 {ell} 1e-{exponent}", "rolling", shape(ell), (0.3, 10.0**-exponent, 0.0, 0.0), ()
    yield "rocking can smooth", "smooth", half, (0.3, 1e-3, 0.0, 0.0), (2,)


def events():
    """Motions that end, and the function that vanishes there."""
    half = shape(1.0)
    for contact in ("rolling", "smooth"):
        yield "side", contact, shape(2.5), (1.4, 0.3, -0.1, 0.5), lambda s, y: y[2]
        yield (
            "lift-off",
            contact,
            shape(2.5),
            steady(shape(2.5), 1.3, -0.6),
            lambda s, y: s.contact_force(y)[0],
        )
        yield "lift-off", contact, half, (0.3, 2.2, 1.5, -1.0), lambda s, y: s.contact_force(y)[0]
    for body, start in ((shape(2.5), steady(shape(2.5), 1.3, 0.25)), (half, (0.5, 0.2, 0.0, 0.1))):
        yield "slip", "rolling", body, start, lambda s, y: slip_margin(s, y, 0.3)


def slip_margin(scene, y, mu):
    normal, friction = scene.contact_force(y)
    return friction - mpf(mu) * normal


def row(kind, scene, t, values):
    numbers = [*scene.numbers, float(t), *values]
    return ",".join([kind, scene.name, scene.contact, *(float(x).hex() for x in numbers)])


def motion(arguments):
    name, contact, body, start, times = arguments
    scene = Scene(name, contact, *body, *start)
    walk, turns = Walk(scene), []
    while len(turns) < 3:
        walk.until(lambda y: scene.reduced(y)[2])
        turns.append((walk.t, walk.y))
    if start[2] == 0:  # a start at a turning point is one
        turns = [(mpf(0), scene.start), *turns]
    period = turns[2][0] - turns[0][0]
    poses = [scene.pose(y) for _, y in turns]
    theta = sorted(scene.reduced(y)[0] for _, y in turns[:2])
    per = [poses[2][i] - poses[0][i] for i in (0, 1)]
    lines = [row("period", scene, period, [*theta, *per])]
    for t in times:
        whole = mp.floor(mpf(t) / period)
        if t <= 30:
            whole = 0
        y = Walk(scene).to(mpf(t) - whole * period)
        pose = scene.pose(y)
        if whole:
            pose = [pose[0] + whole * per[0], pose[1] + whole * per[1], mpf("nan"), mpf("nan")]
        lines.append(row("state", scene, t, [*scene.reduced(y), *pose, *scene.contact_force(y)]))
    return lines


def ending(arguments):
    index, (name, contact, body, start, _) = arguments
    g = list(events())[index][4]
    scene = Scene(name, contact, *body, *start)
    walk = Walk(scene)
    if not walk.until(lambda y: g(scene, y), mpf(30)):
        raise ValueError(f"{name} does not happen: {scene.numbers}")
    return [row("event", scene, walk.t, scene.reduced(walk.y))]


def main():
    path = pathlib.Path(__file__).with_name("motion.csv")
    ends = [(i, (*e[:4], None)) for i, e in enumerate(events())]
    with multiprocessing.Pool() as pool:
        lines = pool.map(ending, ends, 1) + pool.map(motion, list(scenes()), 1)
    header = "kind,scene,contact,ell,i1,i3,theta,w1,w2,w3,t,values"
    path.write_text("\n".join([header, *(line for group in lines for line in group)]) + "\n")
    print(f"{sum(map(len, lines))} rows in {path.name}")


if __name__ == "__main__":
    main()
