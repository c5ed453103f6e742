"""Writes the references of bodies with a rounded rim: rounded_moments.csv, rounded_steady.csv, rounded_motion.csv.

    python tests/reference/rounded.py [moments] [steady] [motion]        all three if none is named

Such a body touches the table with a torus: a circle of radius a = 1 - rho in the plane at ell below the centre of
mass, fattened by the fillet rho. The three-dimensional models of newton_euler.py and motion.py are told so, and
nothing is taken from the reduced equations of the library.

    moments   of a tube of half length H, bored with radius q, its outer edges rounded: integrals over its height
    steady    the centre at rest: w along r. Then w2' is linear in Omega^2, and two of its values give Omega^2
    motion    vectors, at 40 digits, by the integrator of motion.py

Inputs are exact doubles, written as hexadecimal; results are decimal, to 25 digits, those of motions to 28. The rows
of rounded_motion.csv are

    period    t = one nutation; theta at both turning points; phi and psi in one nutation
    state     theta, w1, w2, w3, phi, psi, contact x, y, normal force, friction, at t; without x and y at t = 1000
    pole      the same of a ball whose axis passes through the vertical: phi is known up to whole turns, phi + psi is
              continuous; theta stays positive, and w1 and w2 change their signs as phi jumps by pi
"""

import math
import pathlib
import sys

import numpy as np
from motion import Scene, Walk, unwrapped
from mpmath import mp, mpf
from newton_euler import derivative, kappa
from vectors import add, cross, dot, scaled

HERE = pathlib.Path(__file__).parent
HALF_PI = math.pi / 2


def decimal(x, digits=25):
    return mp.nstr(x, digits)


# The moments of a rounded tube.


def moments(half_length, bore, fillet):
    """I1 and I3 of a uniform tube whose outer edges are rounded, by integrals over its height z."""
    top, q, rho = mpf(half_length), mpf(bore), mpf(fillet)
    ell = top - rho

    def over_height(straight, curved):
        """Both halves: the straight wall, and the fillet at z = ell + rho sin(u), radius 1 - rho + rho cos(u)."""

        def rounded(u):
            return curved(ell + rho * mp.sin(u), 1 - rho + rho * mp.cos(u)) * rho * mp.cos(u)

        return 2 * (mp.quad(straight, [0, ell]) + mp.quad(rounded, [0, mp.pi / 2]))

    def area(_, radius=1):
        return radius**2 - q**2

    def axial(_, radius=1):
        return (radius**4 - q**4) / 2

    def along(z, radius=1):
        return z**2 * (radius**2 - q**2)

    mass, i3, square = (over_height(f, f) for f in (area, axial, along))
    return i3 / (2 * mass) + square / mass, i3 / mass


def tubes():
    """Half length, bore and fillet."""
    disk = 37.55
    yield from ((1.0, 0.0, 1.0), (6.5 / disk, 0.0, 2 / disk), (0.75, 0.0, 0.75), (0.05, 0.0, 0.05))
    yield from ((length, 0.0, 1.0) for length in (1.25, 2.0, 3.0, 10.0))  # capsules
    yield from ((length, 0.0, 0.0) for length in (0.1, 1.0, math.sqrt(0.75)))
    for fillet, critical in ((0.1, 0.8680), (0.2, 0.8734), (0.5, 0.9058)):
        for offset in (0.0, 1e-4, -1e-2):  # I1 and I3 nearly agree
            yield critical + offset, 0.0, fillet
    for fillet in (1e-12, 1e-6, 1e-3, 0.01, 0.25, 0.5):
        for length in (0.6, 1.0, 2.5):
            yield length, 0.0, fillet
    for bore in (0.125, 0.5, 0.75, 0.9375):
        for length in (1.0, 6.0):
            yield length, bore, 0.0
            yield length, bore, 1 - bore
            yield length, bore, (1 - bore) / 4
    yield from ((0.25, 0.75, 0.25), (0.5, 0.5, 0.5), (1e3, 0.3, 0.1), (20.0, 0.999, 0.0005))


def moments_table():
    mp.dps = 40
    yield "half_length,bore,fillet,i1,i3,excess"
    for tube in tubes():
        i1, i3 = moments(*tube)
        yield ",".join([*(x.hex() for x in tube), decimal(i1), decimal(i3), decimal(i1 / i3 - 1)])


# Steady states with the centre at rest.


def at_rest(body, theta, rate):
    """The state with the centre at rest, w along r, that precesses with this rate: w1 = rate sin(theta)."""
    ell, _, _, fillet = body
    s, c = mp.sin(theta), mp.cos(theta)
    e1, e3, z = [c, mpf(0), s], [-s, mpf(0), c], [mpf(0), mpf(0), mpf(1)]
    r = add(scaled(fillet - 1, e1), scaled(-ell, e3), scaled(-fillet, z))
    w1 = rate * s
    return [theta, w1, mpf(0), w1 * dot(r, e3) / dot(r, e1)]


def square_of_rate(body, theta):
    """Omega^2 at which the tilt stays: w2' = f0 + (f1 - f0) Omega^2 vanishes; negative where nothing is steady."""
    f0, f1 = (derivative(body, at_rest(body, theta, mpf(rate)), "rolling")[2] for rate in (0, 1))
    return -f0 / (f1 - f0)


def limit(ell, i1, i3, fillet):
    """Where the rate grows without bound: only a choice of points, near which the rate is then looked at."""
    low, high = mpf(10) ** -30, mp.pi / 2 - mpf(10) ** -30

    def denominator(x):
        return i1 * (1 - mpf(fillet)) / mp.sin(x) - i3 * ell / mp.cos(x) + (i1 - i3) * mpf(fillet)

    return float(mp.findroot(denominator, (low, high), solver="anderson", tol=1e-30, verify=False))


def points():
    """Kind, ell, i1, i3, fillet, theta; some without a steady state."""
    rng = np.random.default_rng(20190102)
    fillets = (1e-12, 1e-6, 0.01, 0.1, 0.3, 0.75, 0.99)
    solids = [(float(h), *map(float, moments(h, q, f)), f) for h, q, f in tubes() if 0 < f < 1]
    solids = [(h - f, i1, i3, f) for h, i1, i3, f in solids if h <= 6]

    def general(fillet):
        i1 = rng.uniform(0.1, 2)
        return rng.uniform(0.01, 3), i1, rng.uniform(0.05, 2) * i1, fillet

    def ball():
        ell, i1 = rng.uniform(-0.9, 2), rng.uniform(0.2, 2)
        return ell, i1, rng.uniform(0.05, 2) * i1, 1.0

    for body in solids:
        yield "solid", *body, rng.uniform(0.01, HALF_PI)
        yield "solid", *body, rng.uniform(0.01, HALF_PI)
    for k in range(98):
        yield "general", *general(fillets[k % 7]), rng.uniform(1e-3, HALF_PI)
    for k in range(28):
        ell, i1, _, fillet = general(fillets[k % 7])
        near = i1 * (1 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-15, -3))
        yield "nearly equal moments", ell, i1, near, fillet, rng.uniform(0.05, 1.5)
    for k in range(28):
        yield "flat", *general(fillets[k % 7]), 10.0 ** rng.uniform(-8, -2)
    for k in range(70):
        body = general(fillets[k % 7])
        edge = math.atan2(1 - body[3], body[0]) if k % 2 else limit(*body)
        yield "edge", *body, edge * (1 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-9, -3))
    for k in range(28):  # theta_balance and theta_limit nearly agree, and the inclination with both
        ell, i1, _, fillet = general(fillets[k % 7])
        near = i1 * (1 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-12, -3))
        both = math.atan2(1 - fillet, ell) * (1 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-9, -3))
        yield "nearly critical", ell, i1, near, fillet, both
    for k in range(42):
        yield "torus", 0.0, *general(fillets[k % 7])[1:], rng.uniform(0.01, math.pi - 0.01)
    for _ in range(40):
        yield "ball", *ball(), rng.uniform(0.01, math.pi - 0.01)
    for k in range(12):
        ell, i1, _, _ = ball()
        near = i1 * (1 + rng.choice([-1, 1]) * 10.0 ** rng.uniform(-15, -3)) if k else i1
        yield "ball, nearly equal moments", ell, i1, near, 1.0, rng.uniform(0.01, math.pi - 0.01)
    for _ in range(12):
        theta = 10.0 ** rng.uniform(-8, -2)
        yield "ball, near a pole", *ball(), theta if rng.random() < 0.5 else math.pi - theta
    for theta in (1.1593, 1.16, 1.2, 1.3, 1.4, 1.5, 1.57, HALF_PI, 1.8, 2.2, 2.6, 3.0):
        yield "Hurricane balls", 1.0, 1.4, 0.4, 1.0, theta
    for separation in (0.5, 0.8, 1.5, 3.0):
        yield "balls on a rod", separation, 0.4 + separation**2, 0.4, 1.0, rng.uniform(1.3, 1.57)


def steady_table():
    mp.dps = 40  # of the moments
    yield "kind,ell,i1,i3,fillet,theta,rate,kappa_c,rolling,smooth"
    for kind, *numbers in list(points()):
        numbers = [float(x) for x in numbers]
        mp.dps = 120
        *body, theta = map(mpf, numbers)
        square = square_of_rate(body, theta)
        values = [mpf("nan")] * 4
        if square > 0:
            log_slope = theta * mp.diff(
                lambda x, b=body: square_of_rate(b, x), theta, h=theta * mpf(10) ** -40
            )
            state = at_rest(body, theta, mp.sqrt(square))
            values = [
                mp.sqrt(body[2] * square),
                abs(log_slope / square) / 2,
                *(kappa(body, state, contact) for contact in ("rolling", "smooth")),
            ]
        yield ",".join([kind.replace(",", ""), *(x.hex() for x in numbers), *(decimal(x) for x in values)])


# Motions.


class Ball(Scene):
    """A ball whose axis passes through the vertical, theta = 0, where phi and psi alone are not defined."""

    def turning(self, e3, w, s, moving):
        """Rate of phi + psi, which is continuous, and nothing."""
        return dot(w, e3) + (e3[0] * moving[1] - e3[1] * moving[0]) / (1 + e3[2]), mpf(0)

    def pose(self, y):
        e3, _, _, e1, _, _, _ = self.geometry(y)
        phi = mp.atan2(-e3[1], -e3[0])
        psi = mp.atan2(dot(y[3:6], cross(e3, e1)), dot(y[3:6], e1))
        return [phi, unwrapped(phi + psi, y[11]) - phi, y[9], y[10]]


def steady(body, theta, kick=0.0):
    """Doubles of the steady state with the centre at rest, kicked: any doubles would do."""
    exact = [mpf(x) for x in body]
    theta, w1, _, w3 = at_rest(exact, mpf(theta), mp.sqrt(square_of_rate(exact, mpf(theta))))
    return float(theta), float(w1), -kick, float(w3)


def solid(half_length, fillet):
    return half_length - fillet, *map(float, moments(half_length, 0.0, fillet)), fillet


def scenes():
    disk = solid(6.5 / 37.55, 2 / 37.55)  # Euler's disk, 75.1 mm wide, 13 mm thick, with fillets of 2 mm
    can, capsule, hurricane = solid(1.0, 0.1), solid(2.0, 1.0), (1.0, 1.4, 0.4, 1.0)
    torus = (0.0, 0.5 * 0.6**2 + 0.625 * 0.4**2, 0.6**2 + 0.75 * 0.4**2, 0.4)
    top, drop, odd = (-0.2, 0.39, 0.40, 1.0), (-0.2, 0.3, 0.4, 1.0), (0.6, 0.3, 0.5, 0.3)
    for contact in ("rolling", "smooth"):
        yield "Euler's disk", contact, disk, steady(disk, 0.38, 0.36), (3, 20, 1000)
        yield "Hurricane balls, near-steady", contact, hurricane, steady(hurricane, 1.3, 0.01), (3, 20)
        yield "tippe top", contact, top, (1.2, 0.1, -1.3, 0.6), (3, 20)
    yield "nutating can", "rolling", can, steady(can, 0.5, 0.3), (3, 20, 1000)
    yield "nutating can", "smooth", can, (0.5, 1.6, -0.3, 3.0), (3, 20, 1000)
    yield "coin", "rolling", solid(0.08, 0.05), (0.16, 0.9, 0.0, -0.3), (3, 20)
    for exponent in (3, 5):
        w1 = 4 * 10.0**-exponent
        yield f"rocking Euler's disk 1e-{exponent}", "rolling", disk, (0.3, w1, 0.0, 0.0), (1, 4)
    yield "rocking can 1e-5", "rolling", can, (0.3, 1e-5, 0.0, 0.0), (2,)
    yield "fat disk", "rolling", solid(0.75, 0.75), (0.9, 0.5, -0.4, 1.3), (3, 20)
    yield "solid torus through the vertical", "rolling", torus, (1.5, 1.2, -0.3, 0.2), (3, 20, 1000)
    yield "Hurricane balls, nutating", "rolling", hurricane, steady(hurricane, 1.4, 0.4), (3, 20, 1000)
    yield "capsule", "rolling", capsule, steady(capsule, 1.4, 0.2), (3, 20)
    yield "spinning upright", "rolling", hurricane, (0.05, 0.1, 0.02, 3.0), (3, 20)
    yield "odd body", "rolling", odd, (0.7, 1.0, 0.3, 2.0), (3, 20)
    yield "tiny fillet", "rolling", (1.0, 0.58, 0.5, 1e-9), (0.5, 1.1, -0.3, 1.0), (3, 20)
    yield "rocking ball", "rolling", drop, (1.0, 6e-5, 0.0, 6e-5), (3, 20)


def through_the_pole():
    """Two of them: released at rest, and with a spin that leads it past the pole by less than a double can tell."""
    body = (-0.2, 0.3, 0.4, 1.0)
    yield "ball through the pole", "rolling", body, (1.2, 0.0, 0.0, 0.0), (3, 20)
    yield "ball through the pole", "smooth", body, (1.2, 0.0, 0.0, 0.0), (3, 20)
    theta, spin = mpf(1), mpf(0.75)
    ell, i1, i3, fillet = (mpf(x) for x in body)
    s, c = mp.sin(theta), mp.cos(theta)
    root = mp.sqrt((i1 * i3 + i1 * s**2 + i3 * (ell + c) ** 2) / (i1 * i3 + i3 * (ell + 1) ** 2))
    # Jellett and Routh: only a choice of the start
    w1 = i3 * spin * ((ell + fillet) * root - (ell + fillet * c)) / (i1 * fillet * s)
    yield "spinning ball past the pole", "rolling", body, (1.0, float(w1), 0.0, float(spin)), (1, 3, 20)


def row(kind, scene, t, values):
    numbers = [*scene.numbers[:3], float(scene.fillet), *scene.numbers[3:], float(t)]
    name = scene.name.replace(",", "")
    # a period is no double
    numbers = [x.hex() for x in numbers[:-1]] + [numbers[-1].hex() if kind != "period" else decimal(t, 28)]
    return ",".join([kind, name, scene.contact, *numbers, *(decimal(x, 28) for x in values)])


def nutation(scene):
    """The period, theta at its turning points, phi and psi in it."""
    walk, turns = Walk(scene), []
    if scene.numbers[5] == 0:  # a start at a turning point is one
        turns.append((mpf(0), scene.start))
    while len(turns) < 3:
        walk.until(lambda y: scene.reduced(y)[2])
        turns.append((walk.t, walk.y))
    theta = sorted(scene.reduced(y)[0] for _, y in turns[:2])
    first, last = scene.pose(turns[0][1]), scene.pose(turns[2][1])
    return turns[2][0] - turns[0][0], [*theta, last[0] - first[0], last[1] - first[1]]


def motion(name, contact, body, start, times, ball=False):
    scene = (Ball if ball else Scene)(name, contact, *body[:3], *start, body[3])
    rounds = dict.fromkeys(times, 0)
    if not ball:
        period, per = nutation(scene)
        yield row("period", scene, period, per)
        rounds = {t: mp.floor(mpf(t) / period) if t > 30 else 0 for t in times}
    walk = Walk(scene)
    for t in sorted(times, key=lambda t: t - rounds[t] * period if rounds[t] else t):
        y = walk.to(mpf(t) - rounds[t] * period if rounds[t] else mpf(t))
        pose = scene.pose(y)
        if rounds[t]:
            pose = [pose[0] + rounds[t] * per[2], pose[1] + rounds[t] * per[3], mpf("nan"), mpf("nan")]
        values = [*scene.reduced(y), *pose, *scene.contact_force(y)]
        yield row("pole" if ball else "state", scene, t, values)


def motion_table():
    mp.dps = 40
    yield "kind,scene,contact,ell,i1,i3,fillet,theta,w1,w2,w3,t,values"
    for scene in scenes():
        yield from motion(*scene)
    for scene in through_the_pole():
        yield from motion(*scene, ball=True)


def main():
    tables = {"moments": moments_table, "steady": steady_table, "motion": motion_table}
    for name in sys.argv[1:] or tables:
        lines = list(tables[name]())
        path = HERE / f"rounded_{name}.csv"
        path.write_text("\n".join(lines) + "\n")
        print(f"{len(lines) - 1} rows in {path.name}")


if __name__ == "__main__":
    main()
