"""The independent model: three-dimensional Newton-Euler equations with the contact solved numerically.

Nothing here is taken from the reduced equations of the library. Vectors live in the laboratory frame; the
unknowns are the angular acceleration and the contact force, found from a linear system at every call:

    rolling   I a + w x (I w) = r x F,   d/dt (r x w) = F - z                 (centre of mass: v = r x w)
    smooth    I a + w x (I w) = r x N z, d/dt (r x w) . z = N - 1             (no horizontal force)

r points from the centre to the contact, r = -a e1 - ell e3 - rho z with a = 1 - rho: to the circle of radius a,
whose points move with the axes that follow the tilt, and from there straight down by the fillet rho.
"""

from mpmath import mp, mpf
from vectors import add, cross, dot, scaled


def derivative(body, y, contact):
    """Time derivative of (theta, w1, w2, w3); body = (ell, i1, i3), or (ell, i1, i3, fillet)."""
    return _solved(body, y, contact)[0]


def force(body, y, contact):
    """The contact force: N, along e2, and across it, towards the side to which e1 leans."""
    return _solved(body, y, contact)[1]


def _solved(body, y, contact):
    ell, i1, i3, *rounding = body
    theta, w1, w2, w3 = y
    s, c = mp.sin(theta), mp.cos(theta)
    zero, one = mpf(0), mpf(1)
    fillet = mpf(rounding[0]) if rounding else zero
    z = [zero, zero, one]
    # phi = 0: e2 = y, e1 leans toward +x
    e1, e2, e3 = [c, zero, s], [zero, one, zero], [-s, zero, c]
    axes, moments = (e1, e2, e3), (i1, i1, i3)
    w = add(scaled(w1, e1), scaled(w2, e2), scaled(w3, e3))
    turning = add(scaled(w1 / s, z), scaled(w2, e2))  # the axes precess about z and tilt about e2

    def inertia(a):
        return add(*(scaled(m * dot(a, e), e) for m, e in zip(moments, axes, strict=True)))

    circle = add(scaled(fillet - one, e1), scaled(-ell, e3))
    r = add(circle, scaled(-fillet, z))
    fixed = cross(cross(turning, circle), w)  # of d/dt (r x w), what does not need the acceleration
    gyro = cross(w, inertia(w))
    unit = [[one if i == j else zero for j in range(3)] for i in range(3)]
    if contact == "rolling":
        # F = fixed + r x a + z
        known = add(cross(r, add(fixed, z)), scaled(-one, gyro))
        columns = [add(inertia(e), scaled(-one, cross(r, cross(r, e)))) for e in unit]
    else:
        # N = fixed . z + (r x a) . z + 1
        known = add(scaled(dot(fixed, z) + 1, cross(r, z)), scaled(-one, gyro))
        columns = [add(inertia(e), scaled(-dot(cross(r, e), z), cross(r, z))) for e in unit]
    matrix = mp.matrix([[columns[j][i] for j in range(3)] for i in range(3)])
    a = list(mp.lu_solve(matrix, mp.matrix(known)))
    rates = [dot(a, e) + dot(w, cross(turning, e)) for e in axes]
    push = add(fixed, cross(r, a), z)
    if contact == "smooth":
        push = scaled(push[2], z)
    return [-w2, *rates], [push[2], push[1], push[0]]


def energy(body, x):
    """Kinetic and potential energy of a row that has a slip."""
    ell, i1, i3, rho = body
    s, c = mp.sin(x.theta), mp.cos(x.theta)
    g0, height = ell * s - (1 - rho) * c, rho + ell * c + (1 - rho) * s
    v_h = x.u_h + height * x.w2
    v_2 = x.u_2 - (ell + rho * c) * x.w1 + (1 - rho + rho * s) * x.w3
    moving = v_h**2 + v_2**2 + (g0 * x.w2) ** 2 + i1 * (x.w1**2 + x.w2**2) + i3 * x.w3**2
    return moving / 2 + height


def kappa(body, y, contact):
    """Squared nutation frequency at a steady state: two eigenvalues vanish, the others are +-sqrt(-kappa)."""
    h = mpf(10) ** (-mp.dps // 3)
    jacobian = mp.matrix(4, 4)
    for j in range(4):
        step = h * max(1, abs(y[j]))
        up, down = list(y), list(y)
        up[j] += step
        down[j] -= step
        f, g = derivative(body, up, contact), derivative(body, down, contact)
        for i in range(4):
            jacobian[i, j] = (f[i] - g[i]) / (2 * step)
    square = jacobian * jacobian
    return -sum(square[i, i] for i in range(4)) / 2
