"""Writes impulses.csv: presses, landings and bodies that lie on their side, the reference of the tests of throwing.

    python tests/reference/impulses.py

The model is the rigid body of Newton and Euler in three dimensions: impulses and forces act at points, velocities
and angular velocities are vectors in the laboratory frame, and what the contacts do is solved for numerically. The
axis of the body is horizontal, along -x; both rims touch the table, the lower one (which carries the body where
the inclination is below pi/2) at +ell x from the centre, the upper one at -ell x. mpmath at 40 digits. Inputs are
exact doubles, written as hexadecimal.

    impulse   M dv = sum J,   I dw = sum r x J                   J = P z + Q at each contact, |Q| <= mu P
    landing   the rims that stay do not move vertically; where one has no impulse it moves upwards
    friction  a rim sticks (no slip afterwards) or Q = -mu P u/|u| with the slip u that is left afterwards
    lying     M a = sum F - z,   I w' + w x I w = sum r x F,   both ends stay: a . z = 0, (e3 . z)'' = 0

Every combination of touching, sticking and slipping is tried, and exactly one has to be consistent.
"""

import itertools
import pathlib
import random

import numpy as np
from mpmath import mp, mpf
from vectors import add, cross, dot, scaled

mp.dps = 40
TINY = mpf(10) ** -25
X, Y, Z = ([int(i == j) for j in range(3)] for i in range(3))
AXIS = scaled(-1, X)  # e3; e1 = z, e2 = y


class Body:
    """A body on its side: its moments and the points of its rims."""

    def __init__(self, ell, i1, i3, fillet=0.0, kind=mpf):
        self.numbers = [float(x) for x in (ell, i1, i3, fillet)]
        self.ell, self.i1, self.i3, self.fillet = (kind(x) for x in self.numbers)
        bottom = add(scaled(self.fillet - 1, Z), scaled(-self.fillet, Z))
        self.rims = [add(scaled(self.ell, X), bottom), add(scaled(-self.ell, X), bottom)]

    def inertia(self, w):
        return [self.i3 * w[0], self.i1 * w[1], self.i1 * w[2]]

    def turned_by(self, torque):
        return [torque[0] / self.i3, torque[1] / self.i1, torque[2] / self.i1]

    def energy(self, v, w):
        return (dot(v, v) + dot(w, self.inertia(w))) / 2


def vectors(w1, w2, w3):
    """The angular velocity in the laboratory frame."""
    return add(scaled(w1, Z), scaled(w2, Y), scaled(w3, AXIS))


def struck(body, v, w, impulses):
    """Velocities after impulses (point, impulse)."""
    v = add(v, *(J for _, J in impulses))
    return v, add(w, body.turned_by(add(*(cross(r, J) for r, J in impulses))))


def at(r, v, w):
    """Velocity of the body's point at r."""
    return add(v, cross(w, r))


def solved(f, guess):
    """A root of f in doubles, or None."""
    x = np.array([float(g) for g in guess])
    for _ in range(30):
        y, h = np.array(f(*x)), 1e-7 * (1e-3 + np.abs(x))
        if not np.isfinite(y).all():
            return None
        slopes = np.array([(np.array(f(*(x + d))) - y) / h[i] for i, d in enumerate(np.diag(h))]).T
        step = np.linalg.lstsq(slopes, -y, rcond=1e-13)[0]
        x = x + step
        if np.abs(step).max() < 1e-11 * (1e-3 + np.abs(x).max()):
            return list(x)
    return None


class Attempt:
    """Which rims touch and which of these stick; the unknowns are P of each, then Qx, then Qy.

    Where both rims stick only the sum of their Qx is known: each has half of it.
    """

    def __init__(self, touching, sticks, mu):
        self.touching, self.sticks, self.mu = touching, sticks, mu
        self.shared = len(touching) == 2 and all(sticks)

    def after(self, body, v, w, x):
        """The impulses, and the velocities after them."""
        n = len(self.touching)
        vertical, rest = x[:n], list(x[n:])
        along = [rest[0]] * 2 if self.shared else rest[:n]
        across = rest[-n:]
        pushes = [(body.rims[k], [along[i], across[i], vertical[i]]) for i, k in enumerate(self.touching)]
        return pushes, *struck(body, v, w, pushes)

    def equations(self, body, v, w, x):
        """What has to vanish."""
        pushes, v1, w1 = self.after(body, v, w, x)
        out = []
        for (p, J), stick in zip(pushes, self.sticks, strict=True):
            u = at(p, v1, w1)
            out.append(u[2])
            if stick:
                out += u[:2]
            else:
                speed = (u[0] ** 2 + u[1] ** 2) ** 0.5
                out += [J[i] * speed + self.mu * J[2] * u[i] for i in range(2)]
        if self.shared:
            del out[4]  # the rims have the same slip along the axis
        return out

    def consistent(self, body, v, w, x, tiny=TINY):
        """The velocities afterwards, or None if a contact does what it cannot do."""
        pushes, v1, w1 = self.after(body, v, w, x)
        good = all(J[2] >= -tiny for _, J in pushes)
        for (p, J), stick in zip(pushes, self.sticks, strict=True):
            u = at(p, v1, w1)
            good &= stick or J[0] * u[0] + J[1] * u[1] <= tiny
            good &= self.shared or (J[0] ** 2 + J[1] ** 2) ** 0.5 <= self.mu * J[2] * (1 + tiny) + tiny
        if self.shared:
            # the share along the axis is free: there has to be room for the sum
            room = [max(0, (self.mu * J[2]) ** 2 - J[1] ** 2) ** 0.5 for _, J in pushes]
            good &= all(abs(J[1]) <= self.mu * J[2] + tiny for _, J in pushes)
            good &= 2 * abs(pushes[0][1][0]) <= sum(room) + tiny
        if len(self.touching) == 1:
            good &= at(body.rims[0], v1, w1)[2] >= -tiny
        return (v1, w1) if good else None


def landings(body, v, w, mu, seed=0):
    """Every consistent outcome of the plastic landing of the upper rim: (rims that stay, v, w).

    Roots are looked for from many places in doubles and refined to 40 digits.
    """
    found, r = [], random.Random(seed)
    rough, v0, w0 = Body(*body.numbers, kind=float), [float(x) for x in v], [float(x) for x in w]
    for touching in ((0, 1), (1,)):
        for sticks in itertools.product((False, True), repeat=len(touching)):
            attempt = Attempt(touching, sticks, mu)
            coarse = Attempt(touching, sticks, float(mu))
            n, tried = len(touching), []
            for _ in range(1 if all(sticks) else 15):
                size = abs(w0[1]) * rough.ell
                guess = [size * r.uniform(0.05, 1) for _ in touching]
                guess += [float(mu) * size * r.uniform(-1, 1) for _ in range(2 * n - attempt.shared)]
                x = solved(lambda *x, c=coarse: c.equations(rough, v0, w0, x), guess)
                if x is None or coarse.consistent(rough, v0, w0, x, 1e-7) is None:
                    continue
                if any(np.allclose(x, other, rtol=1e-8, atol=1e-9 * size) for other in tried):
                    continue
                tried.append(x)
                try:
                    x = mp.findroot(lambda *x, a=attempt: a.equations(body, v, w, x), [mpf(y) for y in x])
                except (ValueError, ZeroDivisionError):
                    continue
                good = attempt.consistent(body, v, w, list(x))
                if good is None:
                    continue
                key = [*good[0], *good[1]]
                if all(max(abs(a - b) for a, b in zip(key, k, strict=True)) > TINY for _, _, _, k in found):
                    found.append((touching, *good, key))
    return [(touching, v1, w1) for touching, v1, w1, _ in found]


def start(body, w1, w2, w3, u_h, u_2):
    """Velocities of the centre and of turning of a state at pi/2 that touches with its lower rim."""
    w = vectors(w1, w2, w3)
    turning = cross(w, body.rims[0])
    return [u_h - turning[0], u_2 - turning[1], -turning[2]], w


def read(body, v, w, other):
    """w1, w2, w3 and slip, of the rim that carries the body; of the other one seen from there."""
    u = at(body.rims[1 if other else 0], v, w)
    sign = -1 if other else 1
    return [w[2], sign * w[1], -sign * w[0], sign * u[0], sign * u[1]]


def carried(body, w1, w3, u_h, u_2, mu):
    """The normal forces of both rims of a body that lies and slips: the linear equations of both ends."""
    v, w = start(body, w1, 0, w3, u_h, u_2)
    slips = [at(r, v, w) for r in body.rims]
    pushes = []
    for r, u in zip(body.rims, slips, strict=True):
        speed = mp.hypot(u[0], u[1])
        pushes.append((r, add(Z, scaled(-mu / speed, [u[0], u[1], mpf(0)]) if speed else [mpf(0)] * 3)))
    gyro = cross(w, body.inertia(w))

    def rates(force):
        total = add(*(scaled(n, F) for n, (_, F) in zip(force, pushes, strict=True)), scaled(-1, Z))
        torque = add(
            *(scaled(n, cross(r, F)) for n, (r, F) in zip(force, pushes, strict=True)), scaled(-1, gyro)
        )
        return total, body.turned_by(torque)

    def off(force):
        a, alpha = rates(force)
        return a[2], dot(add(cross(alpha, AXIS), cross(w, cross(w, AXIS))), Z)

    zero, unit = off([mpf(0), mpf(0)]), [off([mpf(1), mpf(0)]), off([mpf(0), mpf(1)])]
    matrix = mp.matrix([[unit[j][i] - zero[i] for j in range(2)] for i in range(2)])
    both = list(mp.lu_solve(matrix, mp.matrix([-zero[0], -zero[1]])))
    # on the lower rim alone: N from its point staying on the table, then which way the axis turns
    n = mp.findroot(lambda n: vertical(body, rates([n, mpf(0)]), w), mpf(1))
    tilt = dot(add(cross(rates([n, mpf(0)])[1], AXIS), cross(w, cross(w, AXIS))), Z)
    return both, tilt > 0


def vertical(body, rates, w):
    """How fast the lowest point of the lower rim leaves the table: height = z - ell cos - sin, cos = e3 . z."""
    a, alpha = rates
    rising = dot(add(cross(alpha, AXIS), cross(w, cross(w, AXIS))), Z)
    return a[2] - body.ell * rising


def pressed(body, impulse, angle, finger, table):
    """State after a finger's push on the upper rim: the table holds that end, and drags it as far as it can."""
    s, c = mp.sin(angle), mp.cos(angle)
    out, along = add(scaled(c, Z), scaled(s, Y)), add(scaled(c, Y), scaled(-s, Z))
    push = (add(scaled(-body.ell, X), out), add(scaled(-impulse, out), scaled(finger * impulse, along)))
    rest = [mpf(0)] * 3

    def after(low, high, drag):
        points = [push, (body.rims[0], scaled(low, Z)), (body.rims[1], add(scaled(high, Z), scaled(drag, Y)))]
        return struck(body, rest, rest, points)

    def held(drag):
        # both ends stay on the table
        def off(low, high):
            v, w = after(low, high, drag)
            return [at(r, v, w)[2] for r in body.rims]

        low, high = mp.findroot(off, (mpf(0), mpf(1)))
        assert abs(low) < TINY * (1 + impulse) and high >= 0
        return low, high, *after(low, high, drag)

    def slip(drag):
        _, high, v, w = held(drag)
        return at(body.rims[1], v, w)[1], high

    most = table * slip(mpf(0))[1]
    drag = mp.findroot(lambda q: slip(q)[0], (mpf(0), mpf(1)), solver="secant")
    if abs(drag) > most:
        drag = mp.sign(drag) * most
        assert slip(drag)[0] * drag <= 0
    _, _, v, w = held(drag)
    assert abs(w[1]) < TINY and abs(v[0]) < TINY
    return read(body, v, w, False)


TUBE = (6.0, 12.41, 0.82)
SHORT = (0.8, 0.8 * 0.8 / 3 + 0.25, 0.5)
COIN = (0.05, 0.05 * 0.05 / 3 + 0.25, 0.5)
CAN = (1.5, 1.5 * 1.5 / 3 + 0.25, 0.5)
HOOP = (0.3, 0.3 * 0.3 / 3 + 0.5, 1.0)
CRITICAL = (0.6, 0.37, 0.5)
BODIES = (TUBE, SHORT, COIN, CAN, HOOP, CRITICAL, (1.0, 1.4, 0.4, 1.0), (0.9, 0.5, 0.45, 0.3))


def rows():
    r = random.Random(13)
    for k in range(60):
        numbers = BODIES[k % len(BODIES)]
        body, mu = Body(*numbers), r.choice([0.1, 0.3, 0.6])
        w1, w3 = r.uniform(-4, 4), r.uniform(-6, 6)
        u_h, u_2 = r.uniform(-3, 3), r.uniform(-3, 3)
        both, rises = carried(body, *(mpf(x) for x in (w1, w3, u_h, u_2, mu)))
        yield ["lying", *body.numbers, w1, 0.0, w3, u_h, u_2, mu], [*both, mpf(int(rises))]
    for k in range(120):
        numbers = BODIES[k % len(BODIES)]
        body, mu = Body(*numbers), r.choice([0.0, 0.05, 0.15, 0.3, 0.6])
        w1, w2, w3 = r.uniform(-3, 3), -r.choice([0.05, 0.5, 2.0]) * r.random(), r.uniform(-4, 4)
        u_h, u_2 = r.choice([0.1, 2.0]) * r.uniform(-1, 1), r.choice([0.1, 3.0]) * r.uniform(-1, 1)
        if k % 3 == 0:
            u_h = u_2 = 0.0  # it rolled
        if k % 12 == 0:
            w1 = 0.0
        v, w = start(body, *(mpf(x) for x in (w1, w2, w3, u_h, u_2)))
        found = landings(body, v, w, mpf(mu), k)
        assert len(found) == 1, (k, numbers, mu, found)
        touching, v1, w_after = found[0]
        other = touching == (1,)
        lost = body.energy(v, w) - body.energy(v1, w_after)
        assert lost >= 0
        yield (
            ["lands", *body.numbers, w1, w2, w3, u_h, u_2, mu],
            [mpf(int(other)), *read(body, v1, w_after, other), lost],
        )
    for k in range(60):
        numbers = BODIES[k % len(BODIES)]
        body = Body(*numbers)
        impulse, angle = r.uniform(0.1, 20), r.uniform(0.05, 1.57)
        finger, table = r.choice([0.0, 0.3, 0.6, 1.0]), r.choice([0.0, 0.15, 0.3, 0.8])
        w1, w2, w3, u_h, u_2 = pressed(body, *(mpf(x) for x in (impulse, angle, finger, table)))
        yield ["pressed", *body.numbers, impulse, angle, finger, table], [w1, w3, u_2]


def main():
    here = pathlib.Path(__file__).parent
    lines = ["kind,ell,i1,i3,fillet,inputs and answers"]
    for given, answers in rows():
        words = [given[0]] + [float(x).hex() for x in given[1:]] + [float(x).hex() for x in answers]
        lines.append(",".join(words))
    (here / "impulses.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
