"""A body with a rim, and how the numbers of its state stand in space, for the formulations of slip.py, losses.py, drifts.py.

Mass 1 and moments I1, I1, I3; it touches the table with a torus of radius a = 1 - rho and fillet rho. Two frames are used:
the laboratory, and (h, e2, z), which precesses and does not tilt: h = c e1 - s e3 is horizontal in the leaning plane.
"""

import math

import gmpy2
from gmpy2 import mpfr
from vectors import add, cross, dot, scaled, solver

Z = [mpfr(0), mpfr(0), mpfr(1)]


class Torus:
    """A body (ell, i1, i3, fillet)."""

    def __init__(self, body):
        self.ell, self.i1, self.i3, self.fillet = (mpfr(x) for x in body)
        self.rim = 1 - self.fillet

    # In the laboratory.

    def arm(self, e1, e3):
        """From the centre to the contact."""
        return add(scaled(-self.rim, e1), scaled(-self.ell, e3), scaled(-self.fillet, Z))

    def begin(self, theta, w1, w2, w3, u_h, u_2):
        """Fifteen numbers: the centre, its velocity, the axis, the material vector and w, with the contact at the origin."""
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        zero = mpfr(0)
        e1, e2, e3 = [c, zero, s], [zero, mpfr(1), zero], [-s, zero, c]
        w = add(scaled(w1, e1), scaled(w2, e2), scaled(w3, e3))
        r = self.arm(e1, e3)
        v = add([u_h, u_2, zero], scaled(-1, cross(w, r)))
        return [*scaled(-1, r), *v, *e3, *e1, *w]

    def leaning(self, e3):
        """The direction of the lean."""
        s = gmpy2.sqrt(e3[0] ** 2 + e3[1] ** 2)
        return [-e3[0] / s, -e3[1] / s, mpfr(0)]

    def in_space(self, vectors, lean=None):
        """Of the fifteen: theta, w1, w2, w3; phi, psi up to whole turns; the contact; v + w x r, h, e2; what should vanish."""
        place, v, e3, material, w = (vectors[3 * i : 3 * i + 3] for i in range(5))
        h = lean or self.leaning(e3)
        s = -dot(h, e3)
        e1 = [e3[2] * h[0], e3[2] * h[1], s]
        e2, r = cross(e3, e1), self.arm(e1, e3)
        u = add(v, cross(w, r))
        state = [gmpy2.atan2(s, e3[2]), dot(w, e1), dot(w, e2), dot(w, e3)]
        pose = [gmpy2.atan2(h[1], h[0]), gmpy2.atan2(dot(material, e2), dot(material, e1))]
        vanishing = [u[2], place[2] + r[2], dot(e3, e3) - 1, dot(material, e3)]
        return state, pose, [place[0] + r[0], place[1] + r[1]], (u, h, e2), vanishing

    def turned(self, torque, e3):
        """The angular acceleration that a torque gives."""
        more = (1 / self.i3 - 1 / self.i1) * dot(torque, e3)
        return [torque[i] / self.i1 + more * e3[i] for i in range(3)]

    # In the frame (h, e2, z).

    def lever(self, s, c):
        """From the centre to the contact."""
        return [self.ell * s - self.rim * c, mpfr(0), -(self.fillet + self.ell * c + self.rim * s)]

    def momentum(self, theta, w, about_contact=True):
        """The angular momentum, about the contact of a body that rolls or about the centre."""
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        e3, r = [-s, mpfr(0), c], self.lever(s, c)
        own = add(scaled(self.i1, w), scaled((self.i3 - self.i1) * dot(w, e3), e3))
        return add(own, cross(r, cross(w, r))) if about_contact else own

    def w_of(self, theta, momentum, about_contact=True):
        """w of a momentum, or the angular acceleration of a torque."""
        units = [[mpfr(i == k) for i in range(3)] for k in range(3)]
        return solver([self.momentum(theta, unit, about_contact) for unit in units])(momentum)

    def components(self, theta, w1, w2, w3):
        """w in the frame."""
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        return [c * w1 - s * w3, w2, s * w1 + c * w3]


def tube(ell, bore, fillet=0.0):
    i3 = (1 + bore * bore) / 2
    return ell, i3 / 2 + ell * ell / 3, i3, fillet


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
