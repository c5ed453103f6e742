"""The model of slow drifts, for drifts.py and late.py.

It is three-dimensional, in the frame (h, e2, z) of torus.py; nothing is taken from reduced
equations. With the lever r from the centre to the contact, the momentum about the contact is K = I w + r x
(w x r), and without losses

    K' = r x z - P' x v - phi' z x K,       v = -w x r,   P' the velocity of the contact on the table

rest      theta and the rate of the steady state with the centre at rest: w lies along the line from the
          contact to the centre, and phi'^2 (z x I w/phi').e2 = (r x z).e2. With E its energy and P the power
          of the couples at N = 1, t = -integral of E'/P dtheta by Gauss's quadrature in theta^(1/4), or in
          the root of the distance to a balanced end; E' is a central difference.
rolling   (theta, w1, w3) keep w2' = 0 as the couples change w1 and w3 at first order: with G = K'.e2 at
          w2 = 0, f the change of (w1, w3) per theta without losses, a that per time by the couple, I_P^-1 m,
              theta' = -(G_w1 a1 + G_w3 a3)/(G_theta + G_w1 f1 + G_w3 f3),    w' = a + f theta'
          with derivatives that are central differences, and theta (its logarithm) as the variable, by
          Gragg's extrapolated midpoint rule.
"""

import gmpy2
from gmpy2 import mpfr
from losses_forms import LAWS
from torus import Torus, Z
from vectors import add, cross, dot, scaled


class Model(Torus):
    """A body and its losses."""

    def __init__(self, body, losses):
        super().__init__(body)
        self.step = mpfr("1e-20")  # of differences
        self.losses = {name: mpfr(losses.get(name, 0.0)) for name in LAWS}
        self.way = None  # of the drilling, where it is not to turn with w.z

    def reach(self, theta):
        return self.lever(gmpy2.sin(theta), gmpy2.cos(theta))

    def precession(self, theta, w):
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        return (c * w[0] + s * w[2]) / s

    def changes(self, theta, w1, w2, w3):
        """w1', w2', w3' without losses."""
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        w, r = self.components(theta, w1, w2, w3), self.reach(theta)
        turning = self.precession(theta, w)
        v = scaled(-1, cross(w, r))
        contact, drag = add(v, scaled(turning, cross(Z, r))), [mpfr(0)] * 3  # v + r'
        momentum = self.momentum(theta, w)
        if w2:
            step = self.step
            ahead, behind = theta + step, theta - step
            tilted = [p - q for p, q in zip(self.reach(ahead), self.reach(behind), strict=True)]
            swept = [p - q for p, q in zip(self.momentum(ahead, w), self.momentum(behind, w), strict=True)]
            contact = add(contact, scaled(-w2 / (2 * step), tilted))
            drag = scaled(w2 / (2 * step), swept)
        rate = add(cross(r, Z), scaled(-1, cross(contact, v)), scaled(-turning, cross(Z, momentum)))
        p = self.w_of(theta, add(rate, drag))
        return c * p[0] + s * p[2] - w2 * w3, p[1], c * p[2] - s * p[0] + w2 * w1

    def couple(self, theta, w):
        """The couple of the losses at N = 1."""
        s, loss = gmpy2.sin(theta), self.losses
        radius, psi = self.rim + self.fillet * s, -w[0] / s
        size = abs(psi)
        sign = mpfr(gmpy2.sign(psi))
        along = loss["dry"] * radius * sign / s + loss["viscous"] * radius**2 * psi / s
        along += gmpy2.const_pi() / 4 * loss["film"] * psi / s**2
        along += loss["layer"] * size * gmpy2.sqrt(size) * sign / s
        level = gmpy2.sqrt(w[0] ** 2 + w[1] ** 2)
        drag = loss["air"] + loss["air2"] * gmpy2.sqrt(dot(w, w))
        return [
            along - (drag + loss["rolling"] / level) * w[0],
            -(drag + loss["rolling"] / level) * w[1],
            -drag * w[2] - loss["drilling"] * (self.way or gmpy2.sign(w[2])),
        ]

    # The centre at rest.

    def at_rest(self, theta):
        """w for phi' = 1 of the steady state with the centre at rest, and the square of its phi'."""
        r = self.reach(theta)
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        radius, depth = self.rim + self.fillet * s, self.ell + self.fillet * c
        # w lies along the line from the contact to the centre, and its part along e1 is s for phi' = 1
        w = self.components(theta, s, mpfr(0), s * depth / radius)
        return w, cross(r, Z)[1] / cross(Z, self.momentum(theta, w, about_contact=False))[1]

    def energy(self, theta):
        w, square = self.at_rest(theta)
        return square * dot(w, self.momentum(theta, w, about_contact=False)) / 2 - self.reach(theta)[2]

    def slope(self, theta):
        """E'."""
        step = self.step * theta
        return (self.energy(theta + step) - self.energy(theta - step)) / (2 * step)

    def rates(self, theta):
        """w with the centre at rest."""
        w, square = self.at_rest(theta)
        return scaled(gmpy2.sqrt(square), w)

    def power(self, theta):
        w = self.rates(theta)
        return -dot(self.couple(theta, w), w)

    def state(self, theta):
        """w1 and w3 with the centre at rest."""
        w, s, c = self.rates(theta), gmpy2.sin(theta), gmpy2.cos(theta)
        return c * w[0] + s * w[2], c * w[2] - s * w[0]

    # Rolling.

    def lift(self, theta, w1, w3):
        """What tilts it."""
        w, r = self.components(theta, w1, mpfr(0), w3), self.reach(theta)
        v, turning = cross(r, w), self.precession(theta, w)
        contact = add(v, scaled(turning, cross(Z, r)))
        return cross(r, Z)[1] - cross(contact, v)[1] - turning * cross(Z, self.momentum(theta, w))[1]

    def partials(self, theta, w1, w3):
        """G_theta, G_w1, G_w3; f; a."""
        lift, step = self.lift, self.step
        at = (
            (lift(theta + step, w1, w3) - lift(theta - step, w1, w3)) / (2 * step),
            (lift(theta, w1 + step, w3) - lift(theta, w1 - step, w3)) / (2 * step),
            (lift(theta, w1, w3 + step) - lift(theta, w1, w3 - step)) / (2 * step),
        )
        first, _, third = self.changes(theta, w1, mpfr(1), w3)
        w = self.components(theta, w1, mpfr(0), w3)
        p = self.w_of(theta, self.couple(theta, w))
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        return at, (-first, -third), (c * p[0] + s * p[2], c * p[2] - s * p[0])

    def kappa(self, theta, w1, w3):
        """kappa, times the inertia of the tilt: the slope of G along the lines of motion without losses."""
        at, f, _ = self.partials(theta, w1, w3)
        return at[0] + at[1] * f[0] + at[2] * f[1]

    def drift(self, x, y):
        """Rates of (t, w1, w3) per x = ln(theta)."""
        theta = gmpy2.exp(x)
        _, w1, w3 = y
        at, f, a = self.partials(theta, w1, w3)
        clock = -(at[0] + at[1] * f[0] + at[2] * f[1]) / (at[1] * a[0] + at[2] * a[1])  # dt/dtheta
        return [theta * q for q in (clock, a[0] * clock + f[0], a[1] * clock + f[1])]
