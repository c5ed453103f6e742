"""Figure 3 of slipping: the phases of random starts, of sc.roll against an independent model in plain doubles.

    python benches/slip_starts.py --count 10000 --painleve 1000        about 10 minutes, on one core

The model integrates ln|u| and the direction of the slip in tau, dt = |u| dtau, with SciPy's LSODA, so that u = 0 is
never stepped over; rolling with DOP853; and it lists the contact forces that are possible at u = 0 by brute force, over
all directions. A start is refused or followed to t = 3, and the kinds of the phases and the end are compared.

    agreed     the same phases, at the same times within 1e-4, and the same end
    refused    refused by both, by name: no unique contact force, or a body on its side that stays lying
    wrong      another phase, another end, another time, or an answer where there is none     (goal 0)
    silent     a number that is not one, or an error that does not name what is wrong        (goal 0)
    left out   the model comes so near a decision (within 1e-3) that its rounding and its tolerance could change it;
               and, where the library disagrees, the model does so with itself once it is ten times as fine

Of the starts that are built to be undefined, at a slip where 1 - eps cos(alpha) < 0 and at u = 0 where the list of
forces has none or more than one, all are to be refused.
"""

import argparse
import collections
import math
import time
import warnings

import numpy as np
from scipy.integrate import solve_ivp

import spincyl as sc

END = 3.0
NEAR = 1e-3
AT_REST = -25.0  # ln|u| from which the slip counts as ended, once its direction has settled
ENDINGS = {
    "lift-off": sc.Ending.LIFT_OFF,
    "side": sc.Ending.SIDE,
    "face": sc.Ending.FACE,
    "end": sc.Ending.DONE,
    "undefined": sc.Ending.PAINLEVE,
}


class Doubtful(Exception):
    """The model is too near a decision."""


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
        """What the contact can do at u = 0: the lift-off, rolling, and every direction of slip; and how clear it is."""
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
        """What follows at u = 0: "lift-off", "rolling", "undefined", or the direction of slip."""
        bare, excess, found, clear = self.forces(y)
        if clear < NEAR or min(abs(excess / self.static - 1), abs(excess / self.mu - 1)) < NEAR:
            raise Doubtful
        if bare <= 0:
            return "undefined" if found or excess <= self.mu else "lift-off"
        if excess <= self.mu:
            return "undefined" if found else "rolling"
        if excess <= self.static:
            return "rolling"
        return found[0][0] if len(found) == 1 else "undefined"


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
        if name in ("face", "side") or name == fired:
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
    size = math.hypot(u_h, u_2)
    lying = model.rim and model.ell > 0 and math.cos(y[0]) < 1e-15 and y[2] == 0
    if size:
        x, z = u_h / size, u_2 / size
        p = model.parts(y)
        _, w2, _, _, _, _, room = model.slip(y, size, x, z)
        if abs(room) < NEAR or abs(p[10]) < NEAR or (lying and abs(w2) < NEAR):
            raise Doubtful
        if room < 0:
            return [], "undefined", 0.0
        if lying and w2 < 0:
            return [], "lies", 0.0
        if p[10] < 0:
            return [], "lift-off", 0.0
        where = (math.log(size), math.atan2(u_2, u_h))
    else:
        choice = model.settled(y)
        if choice == "undefined" or choice == "lift-off":
            return [], choice, 0.0
        if lying:
            w2 = (
                model.rolling(y)[1]
                if choice == "rolling"
                else model.slip(y, 0, math.cos(choice), math.sin(choice))[1]
            )
            if abs(w2) < NEAR:
                raise Doubtful
            if w2 < 0:
                return [], "lies", 0.0
        where = None if choice == "rolling" else (AT_REST, choice)
    began = None
    for _ in range(60):
        if began is None:
            began = t
        phases.append((began, "slipping" if where else "rolling"))
        began = None
        if where:
            fired, t, y, where = slid(model, t, y, where, end)
        else:
            fired, t, y = rolled(model, t, y, end)
        if fired == "slips":
            began = t
            y, where, t = begun(model, t, y)
            if where is None:
                return phases, "undefined", began
        elif fired != "rests":
            return phases, fired, t
        else:
            choice = model.settled(y)
            if choice in ("undefined", "lift-off"):
                return phases, choice, t
            where = None if choice == "rolling" else (AT_REST, choice)
    raise Doubtful


def slid(model, t, y, where, end):
    """Slip to its end, in tau: what ended it, when, where."""

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
    q = [*y, *where, t]
    solution = solve_ivp(
        rates,
        (0.0, 1e9),
        q,
        "LSODA",
        events=events,
        rtol=1e-9 * model.fine,
        atol=1e-11 * model.fine,
        max_step=math.inf,
    )
    if solution.status != 1:
        raise Doubtful
    (fired,) = (k for k, x in enumerate(solution.t_events) if len(x))
    q = solution.y_events[fired][-1]
    fired = names[fired]
    if grazed(model, solution, names[:-2], events[:-2], fired):
        raise Doubtful
    if fired == "face" and (q[1] or q[3]):
        raise Doubtful  # it comes to rest flat, in ever faster turns
    if fired == "undefined" and q[4] < AT_REST:
        raise Doubtful  # its direction has not settled though |u| is 1e-11
    if fired == "rests" and model.slip(q[:4], 0.0, math.cos(q[5]), math.sin(q[5]))[3] > -NEAR:
        raise Doubtful
    return fired, q[6], list(q[:4]), None


def rolled(model, t, y, end):
    """Rolling to its end."""

    def rates(_, q):
        w1, w2, w3, *_ = model.rolling(q)
        return [-q[2], w1, w2, w3]

    names, events = crossings(model, rates, False)
    if t >= end:
        return "end", t, y
    solution = solve_ivp(
        rates,
        (t, end),
        y,
        "DOP853",
        events=events,
        rtol=1e-9 * model.fine,
        atol=1e-11 * model.fine,
        max_step=0.02,
    )
    if solution.status < 0:
        raise Doubtful
    fired = next((names[k] for k, x in enumerate(solution.t_events) if len(x)), "end")
    if grazed(model, solution, names, events, fired):
        raise Doubtful
    return fired, solution.t[-1], list(solution.y[:, -1])


def begun(model, t, y):
    """A state shortly after rolling has given way, a short time on, in the direction with f = 0; none if undefined."""
    short = 1e-4 * model.fine if model.static == model.mu else 0.0
    if short:
        w1, w2, w3, _, f_h, f_2 = model.rolling(y)
        along = math.atan2(-f_2, -f_h)
        for angle, growth, _ in model.forces(y)[2]:
            apart = abs((angle - along + math.pi) % (2 * math.pi) - math.pi)
            if growth > NEAR or apart > 0.01:
                return y, None, t  # a slip that begins with u' != 0, beside the one that rolling goes over to
        y = [y[0] - short * y[2], y[1] + short * w1, y[2] + short * w2, y[3] + short * w3]
    _, _, found, _ = model.forces(y)
    if not found:
        raise Doubtful
    if len(found) > 1:
        return y, None, t
    angle, growth, _ = found[0]
    return y, (math.log(growth * short / 2) if short else AT_REST, angle), t + short


# The draws.


def drawn_body(rng):
    kind = rng.choice(["tube", "disk", "rod", "rounded", "ball", "light"])
    if kind in ("tube", "disk", "rod"):
        ell = {"tube": rng.uniform(0.3, 6), "disk": rng.uniform(0, 0.3), "rod": 10 ** rng.uniform(0.5, 1.3)}[
            kind
        ]
        bore = 0.0 if rng.random() < 0.4 else rng.uniform(0, 1)
        i3 = (1 + bore * bore) / 2
        return kind, (float(ell), i3 / 2 + ell * ell / 3, i3, 0.0)
    i1 = rng.uniform(0.2, 1.5)
    i3 = rng.uniform(0.2, 1.6) * i1
    if kind == "rounded":
        return kind, (rng.uniform(0, 2), i1, i3, rng.uniform(0.02, 0.9))
    if kind == "ball":
        return kind, (rng.uniform(-0.6, 0.6), i1, i3, 1.0)
    i1 = 10 ** rng.uniform(-2, -0.5)
    return kind, (rng.uniform(0.2, 2), i1, rng.uniform(0.2, 1.9) * i1, 0.0)


def drawn(rng):
    """A body, a law and a start."""
    kind, body = drawn_body(rng)
    mu = 10 ** rng.uniform(math.log10(0.05), math.log10(2))
    static = mu * rng.uniform(1.02, 1.5) if rng.random() < 0.3 else mu
    theta = rng.uniform(0.05, math.pi / 2 - 0.02)
    r = rng.random()
    if r < 0.05:
        theta = 10 ** rng.uniform(-3, -1.3)
    elif r < 0.1:
        theta = math.pi / 2 - 10 ** rng.uniform(-4, -1)
    elif r < 0.15 and body[0] > 0:
        theta = math.pi / 2
    elif r < 0.2 and kind != "light":
        theta = math.atan2(1 - body[3], body[0]) % math.pi + 10 ** rng.uniform(-3, -1)
        theta = min(max(theta, 0.02), math.pi / 2 - 0.01)
    w1, w2, w3 = rng.normal(size=3) * 10 ** rng.uniform(-1, 0.3)
    if theta == math.pi / 2:
        w2 = 0.0
        w1, w3 = abs(w1), abs(w3) * (1 + body[0])
    elif theta < 0.05:
        w1 *= theta
    if rng.random() < 0.1 and theta != math.pi / 2:
        w1 = w3 = 0.0  # planar
    r = rng.random()
    if r < 0.3:
        u = (0.0, 0.0)
    elif r < 0.4:
        size, angle = 10 ** rng.uniform(-12, -4), rng.uniform(0, 2 * math.pi)
        u = (size * math.cos(angle), size * math.sin(angle))
    else:
        u = tuple(rng.normal(size=2) * 10 ** rng.uniform(-1.5, 0.5))
    if w1 == w3 == 0:
        u = (u[0], 0.0)
    return body, float(mu), float(static), tuple(float(x) for x in (theta, w1, w2, w3, *u))


def undefined(rng):
    """A start without exactly one contact force, and why: of light bodies, and fast, where u = 0."""
    at_slip = rng.random() < 0.9
    while True:
        kind, body = drawn_body(rng)
        if not at_slip and kind != "light":
            continue
        theta = rng.uniform(0.05, math.pi / 2 - 0.05)
        w1, w2, w3 = rng.normal(size=3) * 10 ** rng.uniform(-1, 0.3 if at_slip else 1)
        y = tuple(map(float, (theta, w1, w2, w3)))
        p = Model(body, 1.0, 1.0).parts(y)
        least = p[9] / abs(p[4] * p[6]) if p[4] * p[6] else math.inf
        if at_slip:
            angle = rng.uniform(-1.2, 1.2) + (math.pi if p[4] * p[6] < 0 else 0.0)
            mu = least / abs(math.cos(angle)) * rng.uniform(1.01, 2.0)
            size = 10 ** rng.uniform(-8, 1)
            if mu < 20:
                return (
                    "a slip",
                    body,
                    float(mu),
                    (*y, float(size * math.cos(angle)), float(size * math.sin(angle))),
                )
        elif (mu := least * rng.uniform(0.97, 1.5)) < 20:
            model = Model(body, mu, mu)
            try:
                if model.settled(y) == "undefined":
                    return "u = 0", body, float(mu), (*y, 0.0, 0.0)
            except Doubtful:
                pass


# The comparison.


def asked(body, mu, static, start, end=END):
    """The phases of sc.roll, the kind of its end and its time; or the message of a refusal."""
    ell, i1, i3, rho = body
    theta, w1, w2, w3, u_h, u_2 = start
    state = sc.State(theta, w1, w2, w3, slip=(u_h, u_2))
    try:
        m = sc.roll(sc.Body(ell, i1, i3, fillet=rho), state, end, contact=sc.Coulomb(mu, static=static))
    except ValueError as e:
        return None, str(e), 0.0
    numbers = [*m.theta, *m.w.ravel(), *m.slip.ravel(), m.error]
    if np.isnan(np.array(numbers, dtype=float)).any():
        return None, "NaN", 0.0
    return [(p.time, p.kind) for p in m.phases], m.status, m.event.time if m.event else end


def verdict(prediction, answer):
    """One of agreed, refused, wrong, silent; and the largest difference of times."""
    phases, ending, when = prediction
    found, status, at = answer
    if found is None:
        if "Painlev" in status and "mu = " in status and "theta = " in status:
            return ("refused" if ending == "undefined" and not phases else "wrong"), 0.0
        if ending == "lies" and "theta" in status:
            return "refused", 0.0
        return "silent", 0.0
    if ending == "lies":
        return ("refused" if status == sc.Ending.SIDE and at == 0.0 else "wrong"), 0.0
    if status != ENDINGS[ending]:
        return "wrong", 0.0
    if not phases:
        return ("agreed" if at == 0.0 else "wrong"), 0.0
    if [kind for _, kind in phases] != [kind for _, kind in found]:
        return "wrong", 0.0
    times = zip([*(t for t, _ in phases), when], [*(t for t, _ in found), at], strict=True)
    apart = max(abs(a - b) for a, b in times)
    return ("agreed" if apart < 1e-4 * max(1, when) else "wrong"), apart


def sensitive(prediction, start):
    """Whether the model says something else once it is ten times as fine."""
    try:
        finer = predicted(*start, fine=0.1)
    except (Doubtful, OverflowError):
        return True
    phases, ending, when = prediction
    kinds = [kind for _, kind in phases]
    if [kind for _, kind in finer[0]] != kinds or finer[1] != ending:
        return True
    times = zip([t for t, _ in phases] + [when], [t for t, _ in finer[0]] + [finer[2]], strict=True)
    return any(abs(a - b) > 3e-5 for a, b in times)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=10000)
    parser.add_argument("--painleve", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=13)
    parser.add_argument("--show", type=int, default=5, help="of each fault")
    parser.add_argument("--predict", action="store_true", help="only what the model says")
    args = parser.parse_args()
    warnings.simplefilter("ignore")
    rng = np.random.default_rng(args.seed)
    tally, kinds, shown = collections.Counter(), collections.Counter(), collections.Counter()
    late, begun_at = 0.0, time.time()
    for k in range(args.count):
        body, mu, static, start = drawn(rng)
        try:
            prediction = predicted(body, mu, static, start)
        except (
            Doubtful,
            OverflowError,
            ZeroDivisionError,
            ValueError,
        ) as e:  # where SciPy's events give up, too
            tally["left out"] += 1
            kinds[type(e).__name__] += 1
            continue
        phases, ending, _ = prediction
        kinds[" ".join([*(kind[0] for _, kind in phases), ending])] += 1
        if args.predict:
            continue
        answer = asked(body, mu, static, start)
        word, apart = verdict(prediction, answer)
        if word == "wrong" and sensitive(prediction, (body, mu, static, start)):
            word = "left out"
            kinds["sensitive"] += 1
        tally[word] += 1
        late = max(late, apart if word == "agreed" else 0.0)
        if word in ("wrong", "silent") and shown[word] < args.show:
            shown[word] += 1
            print(f"{word}: start {k}, body {body}, mu {mu!r}, static {static!r}, start {start}")
            print(f"    predicted {prediction}\n    found {answer}")
    missed, reasons = 0, collections.Counter()
    for k in range(args.painleve):
        why, body, mu, start = undefined(rng)
        reasons[why] += 1
        if args.predict:
            continue
        found, status, _ = asked(body, mu, mu, start)
        if found is not None or "Painlev" not in status:
            missed += 1
            if missed <= args.show:
                print(f"not refused: {k} ({why}), body {body}, mu {mu!r}, start {start}: {found} {status}")
    print(f"{args.count} starts in {time.time() - begun_at:.0f} s, to t = {END:g}; s slipping, r rolling:")
    for word, count in kinds.most_common(30):
        print(f"    {count:6d}  {word}")
    print(f"phases as predicted    {tally['agreed']}, times to {late:.1e}")
    print(f"refused, as predicted  {tally['refused']}")
    print(f"wrong                  {tally['wrong']}")
    print(f"silent                 {tally['silent']}")
    print(f"left out               {tally['left out']}")
    listed = ", ".join(f"{count} at {why}" for why, count in reasons.items())
    print(f"built to be undefined  {args.painleve} ({listed}): {missed} not refused")


if __name__ == "__main__":
    main()
