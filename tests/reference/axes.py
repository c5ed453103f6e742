"""Newton's and Euler's equations along the axes (e1, e2, e3) that follow the tilt and the precession.

The axes turn with W = phi' z - theta' e2. In them r = -a e1 - ell e3 - rho z, from the centre to the contact, stands still
where the rim is sharp, rho = 0, and else moves with r' = rho W x z:

    rolling   v = r x w,   F = v' + W x v + z,      L' + W x L = r x F
    smooth    the height h = -r.z obeys h'' = N - 1,   L' + W x L = r x N z

The 3 x 3 system for the rates of w is solved by Cramer's rule at every call. Nothing is taken from the library's
equations, and the numbers may be anything that can be multiplied: floats, mpmath's, heyoka's expressions. The test of
starts compares it with newton_euler.py, which does the same in the laboratory frame.
"""

from vectors import add, cross, scaled, solver


def rates_and_force(contact, body, s, c, w, number):
    """(w1', w2', w3') and the contact force along the axes, of body (ell, i1, i3) or (ell, i1, i3, rho), s and c, and w."""
    ell, i1, i3, *rho = body
    zero, one = number(0.0), number(1.0)
    rim = one - rho[0] if rho else one
    z, r = [s, zero, c], [-rim, zero, -ell]
    if rho:
        r = [-rim - rho[0] * s, zero, -ell - rho[0] * c]
    unit = [[one, zero, zero], [zero, one, zero], [zero, zero, one]]
    turning = add(scaled(w[0] / s, z), [zero, w[1], zero])

    def momentum(a):
        return [i1 * a[0], i1 * a[1], i3 * a[2]]

    gyro = cross(turning, momentum(w))
    if contact == "rolling":
        # F = r x w' + r' x w + W x (r x w) + z
        given = add(cross(turning, cross(r, w)), z)
        if rho:
            given = add(given, scaled(rho[0], cross(cross(turning, z), w)))
        columns = [add(momentum(e), scaled(-one, cross(r, cross(r, e)))) for e in unit]
        rates = solver(columns)(add(cross(r, given), scaled(-one, gyro)))
        return rates, add(cross(r, rates), given)
    # h = ell c + a s + rho, theta' = -w2: h'' = slope theta'' + bend theta'^2
    slope, bend = rim * c - ell * s, -(ell * c + rim * s)
    given = one + bend * w[1] * w[1]
    lever = cross(r, z)
    columns = [add(momentum(e), scaled(slope * e[1], lever)) for e in unit]
    rates = solver(columns)(add(scaled(given, lever), scaled(-one, gyro)))
    return rates, scaled(given - slope * rates[1], z)


def vertical(force, s, c):
    """N of a force along the axes."""
    return force[0] * s + force[2] * c


def horizontal(force, s, c):
    """The two parts of the horizontal force: along the lean, and along e2."""
    return force[0] * c - force[2] * s, force[1]
