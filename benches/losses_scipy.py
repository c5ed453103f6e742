"""Motions with losses by SciPy: the right-hand side of the equations in plain Python, for its DOP853.

    lost = losses_scipy.Lossy(body, coefficients, contact="rolling", mu=0.0)
    found = lost.solve(start, times, rtol=1e-12)

A module that other benches import. The equations are those of rolling, of a smooth table and of Coulomb
friction for rounded rims, with the couples of all eight laws; `losses` are their coefficients in the order
of the tables of tests/reference/losses.json. The numbers of a motion are (theta, w1, w2, w3, u_h, u_2, work
lost). With `compiled` the right-hand side is compiled by numba, if that is installed.

Within a piece of the motion dry friction and drilling friction keep the sign that psi' or w_z has at its
start. They also keep it past the change of sign, so that the equations are smooth while the integrator
locates it.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

try:
    import numba
except ImportError:
    numba = None

DRY, VISCOUS, ROLLING, DRILLING, AIR, AIR2, FILM, LAYER = range(8)
CONTACTS = ("rolling", "smooth", "coulomb")
ROLLS, SLIDES, RUBS = range(3)
LEAST = 1e-11  # the speed of a slip below which its end is found by a straight line


class Dear(ArithmeticError):
    """Too many evaluations."""


class Found:
    """A solution: the numbers at the times, the end (None: at the last time), and the number of
    evaluations."""

    def __init__(self, times, y, end, evaluations):
        self.times, self.y, self.end, self.evaluations = times, y, end, evaluations


def force(y, signs, body, losses, contact, mu):
    """The rates and the contact force: (rates, N, along the lean, across)."""
    ell, i1, i3, rho = body
    dry, viscous, rolling, drilling, air, air2, film, layer = losses
    theta, w1, w2, w3, u_h, u_2 = y[0], y[1], y[2], y[3], y[4], y[5]
    s, c = math.sin(theta), math.cos(theta)
    radius, depth = 1 - rho + rho * s, ell + rho * c
    g, slope = ell * s - (1 - rho) * c, ell * c + (1 - rho) * s
    height, turn = slope + rho, w1 / s
    psi = w3 - c * turn
    # the couple is f + N p; x, the part of the laws of the contour, is along (ct, 0, -1)
    x = viscous * radius * radius * psi + film * (math.pi / 4) * psi / s
    if layer:
        x += layer * math.copysign(abs(psi) ** 1.5, psi)
    f1, f2, f3 = x * c / s, 0.0, -x
    p1, p2, p3 = (dry * signs[0] * radius * c / s, 0.0, -dry * signs[0] * radius) if dry else (0.0, 0.0, 0.0)
    if rolling:
        over = rolling / math.hypot(s * psi, w2)
        p1, p2, p3 = p1 + over * c * s * psi, p2 - over * w2, p3 - over * s * s * psi
    if drilling:
        p1, p3 = p1 - drilling * signs[1] * s, p3 - drilling * signs[1] * c
    if air or air2:
        drag = air + air2 * math.sqrt(w1 * w1 + w2 * w2 + w3 * w3)
        f1, f2, f3 = f1 - drag * w1, f2 - drag * w2, f3 - drag * w3
    if contact == ROLLS:
        inertia = i1 + radius * radius + depth * depth
        det = i1 * i3 + i1 * radius * radius + i3 * depth * depth
        v = radius * w3 - depth * w1
        free = (-i1 * c / s * w1 * w1 + i3 * w1 * w3 + height / s * w1 * v - g - rho * g * w2 * w2) / inertia
        normal = (1 + g * (free + f2 / inertia) - slope * w2 * w2) / (1 - g * p2 / inertia)
        m1, m2, m3 = f1 + normal * p1, f2 + normal * p2, f3 + normal * p3
        d2 = free + m2 / inertia
        rim = 1 - rho
        d1 = w2 * (
            (c / s + i3 * rim * depth / det) * w1 - i3 / det * (i3 + radius * radius + rho * c * depth) * w3
        )
        d3 = -w2 * radius / det * (i1 * rim * w1 + (i3 * depth - i1 * rho * c) * w3)
        d1 += ((i3 + radius * radius) * m1 + radius * depth * m3) / det
        d3 += (radius * depth * m1 + (i1 + depth * depth) * m3) / det
        lost = -(m1 * w1 + m2 * w2 + m3 * w3)
        along = height * d2 + g * w2 * w2 - w1 * v / s
        across = (m3 - i3 * d3) / radius
        return (-w2, d1, d2, d3, 0.0, 0.0, lost), normal, along, across
    pull = i3 * w1 * w3 - i1 * c * turn * w1
    k_h = k_2 = 0.0
    if contact == RUBS:
        speed = math.hypot(u_h, u_2)
        k_h, k_2 = -mu * u_h / speed, -mu * u_2 / speed
    normal = (i1 * (1 - slope * w2 * w2) + g * (pull + f2)) / (i1 + g * g + g * height * k_h - g * p2)
    m1, m2, m3 = f1 + normal * p1, f2 + normal * p2, f3 + normal * p3
    along, across = normal * k_h, normal * k_2
    d1 = (w2 * (i1 * c * turn - i3 * w3) + depth * across + m1) / i1
    d2, d3 = (pull - g * normal - height * along + m2) / i1, (m3 - radius * across) / i3
    v_h, v_2 = u_h + height * w2, u_2 - depth * w1 + radius * w3
    d_h = along + turn * v_2 - g * w2 * w2 - height * d2
    d_2 = across - turn * v_h + depth * d1 - radius * d3 + rho * w2 * (s * w1 + c * w3)
    return (-w2, d1, d2, d3, d_h, d_2, -(m1 * w1 + m2 * w2 + m3 * w3)), normal, along, across


class Lossy:
    """A body (ell, i1, i3, fillet) with losses on a table: "rolling", "smooth" or "coulomb"."""

    def __init__(self, body, losses, contact="rolling", mu=0.0, most=100_000, compiled=False):
        self.body, self.losses = tuple(map(float, body)), tuple(map(float, losses))
        self.contact, self.mu, self.most = contact, float(mu or 0.0), most
        self.forced = numba.njit(force) if compiled else force

    def force(self, y, signs):
        """The rates and the contact force: (rates, N, along the lean, across)."""
        return self.forced(y, signs, self.body, self.losses, CONTACTS.index(self.contact), self.mu)

    def signs(self, y):
        s, c = math.sin(y[0]), math.cos(y[0])
        return math.copysign(1.0, y[3] - c / s * y[1]), math.copysign(1.0, s * y[1] + c * y[3])

    def events(self, signs):
        """Functions that are zero at the end of a piece, by name."""

        def crossing(name, way):
            def of(_, y, *_signs):
                s, c = math.sin(y[0]), math.cos(y[0])
                return y[3] - c / s * y[1] if name == "stops" else s * y[1] + c * y[3]

            of.direction = -way
            return of

        def slips(_, y, *_signs):
            _, normal, along, across = self.force(y, signs)
            return self.mu * normal - math.hypot(along, across)

        found = {"side": lambda _, y, *_signs: math.pi / 2 - y[0]}
        if self.losses[DRY]:
            found["stops"] = crossing("stops", signs[0])
        if self.losses[DRILLING]:
            found["holds"] = crossing("holds", signs[1])
        if self.contact == "rolling" and self.mu:
            found["slips"] = slips
        if self.contact == "coulomb":
            found["rolls"] = lambda _, y, *_signs: math.hypot(y[4], y[5]) - LEAST
        for of in found.values():
            of.terminal = True
        return found

    def rates(self, _, y, signs):
        self.left -= 1
        if self.left < 0:
            raise Dear(f"more than {self.most} evaluations")
        return self.force(y, signs)[0]

    def solve(self, start, times, rtol, atol=None, crosses=0, until=None):
        """The motion to its first end; the end is searched for up to `until`, which may be after the last of the times.

        The first `crosses` changes of the sign of psi' do not end the motion.
        """
        y = np.array([*start, *[0.0] * (7 - len(start))])
        t, left, rows, evaluations = 0.0, np.asarray(times, float), [], 0
        self.left, signs = self.most, None
        until = left[-1] if until is None else until
        while True:
            # a new piece begins with psi' = 0, which then has the other sign
            signs = self.signs(y) if signs is None else (-signs[0], signs[1])
            events = self.events(signs)
            found = solve_ivp(
                self.rates,
                (t, until),
                y,
                "DOP853",
                args=(signs,),
                t_eval=left,
                events=list(events.values()),
                rtol=rtol,
                atol=rtol if atol is None else atol,
            )
            if found.status < 0:
                raise ArithmeticError(found.message)
            evaluations += found.nfev
            ended = [name for name, at in zip(events, found.t_events, strict=True) if at.size]
            if len(found.t):
                rows.append(np.asarray(found.y))
            if not ended:
                return Found(times, np.hstack([np.empty((7, 0)), *rows]), None, evaluations)
            (where,) = (i for i, name in enumerate(events) if name == ended[0])
            t, y = found.t_events[where][0], found.y_events[where][0]
            left = left[len(found.t) :]
            if ended[0] == "stops" and crosses:
                crosses -= 1
                continue
            if ended[0] == "rolls":
                change = self.force(y, signs)[0]
                rest = -(y[4] ** 2 + y[5] ** 2) / (y[4] * change[4] + y[5] * change[5])
                t, y = t + rest, y + rest * np.array(change)
            return Found(times, np.hstack([np.empty((7, 0)), *rows]), (ended[0], t, y), evaluations)
