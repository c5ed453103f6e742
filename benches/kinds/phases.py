"""The phases of random starts with friction, of sc.roll against an independent model in plain doubles.

10,000 starts take about 10 minutes on one core. The model is slip_model.py. A start is refused or followed to t = 3, and the kinds of the phases and the end
are compared.

    agreed     the same phases, at the same times within 1e-4, and the same end
    refused    refused by both, by name: no unique contact force, or a body on its side that stays lying
    wrong      another phase, another end, another time, or a result where there is none      (goal 0)
    silent     a NaN, or an error that does not name the cause                                (goal 0)
    left out   the model is so near a decision (within 1e-3) that its rounding and tolerance could change it;
               or it disagrees with the library, and with itself at a tenth of its tolerances

Other starts are built to be undefined: at a slip where 1 - eps cos(alpha) < 0, and at u = 0 where the list of
forces has none or more than one. All of these must be refused.
"""

import math

import numpy as np
from judge import blocks
from slip_model import END, Doubtful, Model, predicted

import spincyl as sc

DEFAULTS, FEW = {"count": 10_000, "seed": 13, "show": 5}, "--count 1000 --painleve 100"
ENDINGS = {
    "lift-off": sc.Ending.LIFT_OFF,
    "side": sc.Ending.SIDE,
    "face": sc.Ending.FACE,
    "end": sc.Ending.DONE,
    "undefined": sc.Ending.PAINLEVE,
}

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
    """A start without a unique contact force, and why; at u = 0 only light bodies that turn fast."""
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
                u = (float(size * math.cos(angle)), float(size * math.sin(angle)))
                return "a slip", body, float(mu), (*y, *u)
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


def differs(one, other):
    """Largest difference of the times of two (phases, end, time); infinite where phases or ends differ."""
    (phases, ending, when), (found, ended, at) = one, other
    if ended != ending or [kind for _, kind in phases] != [kind for _, kind in found]:
        return math.inf
    times = zip([*(t for t, _ in phases), when], [*(t for t, _ in found), at], strict=True)
    return max(abs(a - b) for a, b in times)


def verdict(prediction, answer):
    """One of agreed, refused, wrong, silent; and the largest difference of times."""
    phases, ending, when = prediction
    found, status, at = answer
    if found is None:
        if "Painlev" in status and "mu = " in status and "theta = " in status:
            return ("refused" if ending == "undefined" and not phases else "wrong"), 0.0
        return ("refused" if ending == "lies" and "theta" in status else "silent"), 0.0
    if ending == "lies":
        return ("refused" if status == sc.Ending.SIDE and at == 0.0 else "wrong"), 0.0
    if not phases:
        return ("agreed" if status == ENDINGS[ending] and at == 0.0 else "wrong"), 0.0
    apart = differs((phases, ENDINGS[ending], when), answer)
    return ("agreed" if apart < 1e-4 * max(1, when) else "wrong"), apart


def sensitive(prediction, start):
    """Whether the model predicts something else at a tenth of its tolerances."""
    try:
        return differs(prediction, predicted(*start, fine=0.1)) > 3e-5
    except (Doubtful, OverflowError):
        return True


def judged(start, tally, ask=True):
    """The verdict on the library's result for one start, and the largest difference of times if it agrees."""
    try:
        prediction = predicted(*start)
    except (Doubtful, OverflowError, ZeroDivisionError, ValueError) as e:  # where SciPy's events give up, too
        tally.count("left out", type(e).__name__)
        return "left out", 0.0
    phases, ending, _ = prediction
    tally.count("phases", " ".join([*(kind[0] for _, kind in phases), ending]))
    if not ask:
        return None, 0.0
    answer = asked(*start)
    word, apart = verdict(prediction, answer)
    if word == "wrong" and sensitive(prediction, start):
        tally.count("left out", "sensitive")
        return "left out", 0.0
    told = f"(body, mu, static, start) = {start}, predicted {prediction}, found {answer}"
    tally.count("starts", word, told if word in ("wrong", "silent") else None)
    return word, apart if word == "agreed" else 0.0


def refused(built, tally):
    """Whether a start that is built to be undefined is refused by name."""
    why, body, mu, start = built
    found, status, _ = asked(body, mu, mu, start)
    named = found is None and "Painlev" in status and "mu = " in status and "theta = " in status
    text = None if named else f"body {body}, mu {mu!r}, start {start}: {found} {status}"
    tally.count(f"built to be undefined at {why}", "refused" if named else "not refused", text)
    return named


def options(add):
    add("--painleve", type=int, default=1000, help="how many starts that are built to be undefined")
    add("--predict", action="store_true", help="only what the model says")


def judge(given, tally):
    rng, late = np.random.default_rng(given.seed), 0.0
    for _ in blocks(given):
        late = max(late, judged(drawn(rng), tally, not given.predict)[1])
    for _ in range(given.painleve):
        built = undefined(rng)
        if not given.predict:
            refused(built, tally)
    tally.note(f"to t = {END:g}; s slipping, r rolling; times of what agreed to {late:.1e}")
    tally.note("wrong, silent and not refused: 0 if they are not listed")
