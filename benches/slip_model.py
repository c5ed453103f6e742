"""An independent model of a body that slips and rolls, in plain doubles, which predicts the phases.

It integrates ln|u| and the direction of the slip in tau, dt = |u| dtau, with SciPy's LSODA, so that u = 0 is
never stepped over; rolling with DOP853; and it lists the contact forces that are possible at u = 0 by brute
force, over all directions. Where its rounding and its tolerance could change a decision, it raises Doubtful.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

END = 3.0
NEAR = 1e-3
AT_REST = -25.0  # ln|u| from which the slip counts as ended, once its direction has settled


class Doubtful(Exception):
    """The model is too near a decision to predict it."""


class Model:
    """A body and its friction: forces and rates, of slip.md section 1."""

    def __init__(self, body, mu, static, fine=1.0):
        self.ell, self.i1, self.i3, self.rho = body
        self.mu, self.static, self.fine = mu, static, fine
        self.rim = 1 - self.rho

    def parts(self, y):
        """Everything that does not depend on the force, for (theta, w1, w2, w3)."""
        theta, w1, w2, w3 = y
        s, c = math.sin(theta), math.cos(theta)
        a, ell, rho, i1, i3 = self.rim, self.ell, self.rho, self.i1, self.i3
        g0, g1 = ell * s - a * c, ell * c + a * s
        om = w1 / s
        couple = w1 * (i3 * w3 - i1 * c * om)
        inertia = i1 + g0 * g0
        z = g1 + rho
        bare = (i1 * (1 - g1 * w2 * w2) + g0 * couple) / inertia
        return s, c, a + rho * s, ell + rho * c, g0, g1, z, om, couple, inertia, bare

    def moved(self, y, p, n, f_h, f_2, u_h, u_2):
        """Rates of w1, w2, w3, u_h, u_2 under a force."""
        _, w1, w2, w3 = y
        s, c, radius, depth, g0, _, z, om, couple, _, _ = p
        w1_rate = (w2 * (self.i1 * c * om - self.i3 * w3) + depth * f_2) / self.i1
        w3_rate = -radius * f_2 / self.i3
        w2_rate = (couple - g0 * n - z * f_h) / self.i1
        v_h, v_2 = u_h + z * w2, u_2 - depth * w1 + radius * w3
        u_h_rate = f_h + om * v_2 - g0 * w2 * w2 - z * w2_rate
        u_2_rate = f_2 - om * v_h + depth * w1_rate - radius * w3_rate + self.rho * w2 * (s * w1 + c * w3)
        return w1_rate, w2_rate, w3_rate, u_h_rate, u_2_rate

    def slip(self, y, size, x, z):
        """Slip of this size in the direction (x, z): rates of w, lambda, f, N, and 1 - eps cos(alpha)."""
        p = self.parts(y)
        room = 1 - self.mu * p[4] * p[6] / p[9] * x
        n = p[10] / (room or 1e-300)
        w1, w2, w3, h, e = self.moved(y, p, n, -self.mu * n * x, -self.mu * n * z, size * x, size * z)
        return w1, w2, w3, h * x + e * z, e * x - h * z, n, room

    def rolling(self, y):
        """Rolling: rates of w, N and the friction along and across, by u' = 0, which is linear in the force."""
        p = self.parts(y)
        g0, z, inertia = p[4], p[6], p[9]

        def slip_rates(f_h, f_2):
            n = p[10] - g0 * z * f_h / inertia
            return self.moved(y, p, n, f_h, f_2, 0.0, 0.0), n

        (*_, h0, e0), _ = slip_rates(0.0, 0.0)
        (*_, h1, _), _ = slip_rates(1.0, 0.0)
        (*_, e1), _ = slip_rates(0.0, 1.0)
        f_h, f_2 = -h0 / (h1 - h0), -e0 / (e1 - e0)
        (w1, w2, w3, _, _), n = slip_rates(f_h, f_2)
        return w1, w2, w3, n, f_h, f_2

    def forces(self, y):
        """The possible forces at u = 0: N without friction, the coefficient that rolling needs, and every
        direction of slip; and how far the nearest decision is."""
        p = self.parts(y)
        alpha = np.linspace(0, 2 * np.pi, 1441)[:-1] + 1e-3
        x, z = np.cos(alpha), np.sin(alpha)
        room = 1 - self.mu * p[4] * p[6] / p[9] * x
        n = p[10] / room
        _, _, _, h, e = self.moved(y, p, n, -self.mu * n * x, -self.mu * n * z, 0.0, 0.0)
        f = e * x - h * z
        found, clear = [], min(1.0, abs(p[10]))
        for k in np.flatnonzero((f > 0) != (np.roll(f, -1) > 0)):
            low, high = alpha[k], alpha[k] + 2 * np.pi / 1440
            at_low = f[k]
            for _ in range(50):
                middle = (low + high) / 2
                value = self.slip(y, 0.0, math.cos(middle), math.sin(middle))[4]
                low, high = (middle, high) if (value > 0) == (at_low > 0) else (low, middle)
            _, _, _, growth, left, normal, space = self.slip(y, 0.0, math.cos(low), math.sin(low))
            if abs(left) > 1e-3 * (1 + abs(growth)):
                continue  # f jumps here from one infinity to the other
            if growth > 0 and normal > 0:
                found.append((low, growth, space))
            clear = min(clear, abs(growth), abs(space))
        # two zeros of f that have only just appeared, or are about to, between the angles
        bent = np.abs(f)
        low_points = (bent < np.roll(bent, 1)) & (bent < np.roll(bent, -1))
        same = (f > 0) == (np.roll(f, -1) > 0)
        if np.any(low_points & same & np.roll(same, 1) & (bent < 1e-3)):
            clear = 0.0
        rolling = self.rolling(y)
        excess = math.hypot(rolling[4], rolling[5]) / rolling[3] if rolling[3] > 0 else math.inf
        return p[10], excess, found, clear

    def settled(self, y):
        """The phase after u = 0: "lift-off", "rolling", "undefined", or for a slip ln|u| and its
        direction."""
        bare, excess, found, clear = self.forces(y)
        if clear < NEAR or min(abs(excess / self.static - 1), abs(excess / self.mu - 1)) < NEAR:
            raise Doubtful
        if bare <= 0:
            return "undefined" if found or excess <= self.mu else "lift-off"
        if excess <= self.mu:
            return "undefined" if found else "rolling"
        if excess <= self.static:
            return "rolling"
        return (AT_REST, found[0][0]) if len(found) == 1 else "undefined"


def crossings(model, rates, slip):
    """The events of a phase: names, and functions for SciPy."""
    named = []
    if slip:
        named.append(("lift-off", lambda t, q: model.parts(q[:4])[10]))
        named.append(
            ("undefined", lambda t, q: model.slip(q[:4], 0.0, math.cos(q[5]), math.sin(q[5]))[6] - 1e-6)
        )
    else:

        def spare(t, q):
            _, _, _, n, f_h, f_2 = model.rolling(q[:4])
            return model.static * n - math.hypot(f_h, f_2)

        named.append(("slips", spare))
    if model.rim:
        if model.ell > 0:
            named.append(("side", lambda t, q: math.cos(q[0])))
        else:
            named.append(("face", lambda t, q: math.pi - 1e-9 - q[0]))
        named.append(("face", lambda t, q: q[0] - 1e-9))
    for _, event in named:
        event.terminal, event.direction = True, -1.0
    return [name for name, _ in named], [event for _, event in named]


def grazed(model, solution, names, events, fired):
    """Whether an event that did not happen nearly did, or two happened nearly at once."""
    for name, event in zip(names, events, strict=True):
        if name in ("face", "side", "rests", "end") or name == fired:
            continue
        values = np.array([event(0.0, q) for q in solution.y.T[1:]])
        inner = values[1:-1]
        if len(inner) and np.any((inner < np.minimum(values[:-2], values[2:])) & (inner < 3 * NEAR)):
            return True
        if fired and len(values) and values[-1] < NEAR:
            return True
    return False


def predicted(body, mu, static, start, end=END, fine=1.0):
    """Phases [(time, kind)], the kind of the end and its time; tolerances are the usual ones times `fine`."""
    model = Model(body, mu, static, fine)
    *y, u_h, u_2 = start
    t, phases = 0.0, []
    size, bare = math.hypot(u_h, u_2), 1.0
    if size:
        where = (math.log(size), math.atan2(u_2, u_h))
        _, w2, *_, room = model.slip(y, size, u_h / size, u_2 / size)
        bare = model.parts(y)[10]
        if min(abs(room), abs(bare)) < NEAR:
            raise Doubtful
        if room < 0:
            return [], "undefined", 0.0
    else:
        where = model.settled(y)
        if where in ("undefined", "lift-off"):
            return [], where, 0.0
        w2 = model.rolling(y)[1]
        if where != "rolling":
            w2 = model.slip(y, 0.0, math.cos(where[1]), math.sin(where[1]))[1]
    if model.rim and model.ell > 0 and math.cos(y[0]) < 1e-15 and y[2] == 0:  # it lies on its side
        if abs(w2) < NEAR:
            raise Doubtful
        if w2 < 0:
            return [], "lies", 0.0
    if bare < 0:
        return [], "lift-off", 0.0
    began = None
    for _ in range(60):
        if began is None:
            began = t
        phases.append((began, "rolling" if where == "rolling" else "slipping"))
        began = None
        fired, t, y = rolled(model, t, y, end) if where == "rolling" else slid(model, t, y, where, end)
        if fired == "slips":
            began = t
            y, where, t = begun(model, t, y)
            if where is None:
                return phases, "undefined", began
        elif fired != "rests":
            return phases, fired, t
        else:
            where = model.settled(y)
            if where in ("undefined", "lift-off"):
                return phases, where, t
    raise Doubtful


def integrated(model, rates, span, q, method, names, events, longest):
    """The event that ended a phase, or None, and the numbers then; Doubtful if another event nearly did."""
    within = {"rtol": 1e-9 * model.fine, "atol": 1e-11 * model.fine, "max_step": longest}
    solution = solve_ivp(rates, span, q, method, events=events, **within)
    if solution.status < 0:
        raise Doubtful
    fired = next((names[k] for k, at in enumerate(solution.t_events) if len(at)), None)
    if grazed(model, solution, names, events, fired):
        raise Doubtful
    return fired, solution.y_events[names.index(fired)][-1] if fired else solution.y[:, -1]


def slid(model, t, y, where, end):
    """Integrates a slip to its end, in tau: the event, the time and the state."""

    def rates(_, q):
        size = math.exp(q[4])
        w1, w2, w3, growth, turn, _, _ = model.slip(q[:4], size, math.cos(q[5]), math.sin(q[5]))
        return [-size * q[2], size * w1, size * w2, size * w3, growth, turn, size]

    names, events = crossings(model, rates, True)

    def rests(_, q):
        if q[4] > AT_REST - 1:
            return q[4] - (AT_REST - 1)
        turn = model.slip(q[:4], 0.0, math.cos(q[5]), math.sin(q[5]))[4]
        return 1.0 if abs(turn) > 1e-4 and q[4] > -200 else -1.0

    def late(_, q):
        return end - q[6]

    for event in (rests, late):
        event.terminal, event.direction = True, -1.0
    names, events = [*names, "rests", "end"], [*events, rests, late]
    fired, q = integrated(model, rates, (0.0, 1e9), [*y, *where, t], "LSODA", names, events, math.inf)
    if fired is None:
        raise Doubtful
    if fired == "face" and (q[1] or q[3]):
        raise Doubtful  # the body comes to rest flat, in ever faster turns
    if fired == "undefined" and q[4] < AT_REST:
        raise Doubtful  # its direction has not settled though |u| is 1e-11
    if fired == "rests" and model.slip(q[:4], 0.0, math.cos(q[5]), math.sin(q[5]))[3] > -NEAR:
        raise Doubtful
    return fired, q[6], list(q[:4])


def rolled(model, t, y, end):
    """Integrates rolling to its end."""

    def rates(_, q):
        w1, w2, w3, *_ = model.rolling(q[:4])
        return [-q[2], w1, w2, w3, 1.0]

    names, events = crossings(model, rates, False)
    if t >= end:
        return "end", t, y
    fired, q = integrated(model, rates, (t, end), [*y, t], "DOP853", names, events, 0.02)
    return fired or "end", q[4], list(q[:4])


def begun(model, t, y):
    """State, slip and time shortly after rolling has given way, in the direction with f = 0; the slip is None
    if undefined."""
    short = 1e-4 * model.fine if model.static == model.mu else 0.0
    if short:
        w1, w2, w3, _, f_h, f_2 = model.rolling(y)
        along = math.atan2(-f_2, -f_h)
        for angle, growth, _ in model.forces(y)[2]:
            apart = abs((angle - along + math.pi) % (2 * math.pi) - math.pi)
            if growth > NEAR or apart > 0.01:
                return y, None, t  # another slip is possible, which begins with u' != 0
        y = [y[0] - short * y[2], y[1] + short * w1, y[2] + short * w2, y[3] + short * w3]
    _, _, found, _ = model.forces(y)
    if not found:
        raise Doubtful
    if len(found) > 1:
        return y, None, t
    angle, growth, _ = found[0]
    return y, (math.log(growth * short / 2) if short else AT_REST, angle), t + short
