"""How a motion of phases is followed through the series of its equations: what slip.py, stones.py and losses.py share.

Slip runs in the variable tau, dt = |u| dtau: the end of slip is at infinity there, and nothing is singular on the way
to it; from |u| = 1e-30 one linear step is left. Slip that begins with u' != 0 begins at |u| = 1e-30. Slip that begins
where the demand of rolling grows past mu N, and static friction is no higher, begins with u' = 0: |u| grows as t^2,
and the direction is found as a series in t, order by order. That series is cut at another time in either formulation.
"""

import gmpy2
from gmpy2 import mpfr
from series import root

LONGEST = 2.0  # step, in the variable of a phase


class Phase:
    """The equations of a phase: the tape, and the quantities that decide."""

    slip = ()  # states whose errors count over the size of the slip

    def __init__(self, tape, **named):
        self.tape = tape
        self.__dict__.update(named)


class Record:
    """The checkpoints of one formulation of a motion: pairs of what is there and the numbers."""

    def __init__(self, model, loud=False):
        self.model, self.loud, self.rows, self.steps, self.strayed = model, loud, [], 0, mpfr(0)

    def note(self, *words):
        if self.loud:
            told = (w if isinstance(w, str) else f"{float(w):.6g}" for w in words)
            print("   ", type(self.model).__name__, *told)

    def add(self, kind, t, y, lean=None):
        self.rows.append((kind, [t, *self.model.read(y, lean)]))
        self.strayed = max(self.strayed, self.model.strayed(y, lean))
        self.note(kind, *self.rows[-1][1])


def step_size(phase, order, tolerance):
    """Where the last two orders of every state fall below the tolerance."""
    h = mpfr(LONGEST)
    for node in phase.tape.states:
        scale = phase.size.c[0] if node in phase.slip else max(mpfr(1), abs(node.c[0]))
        for k in (order - 1, order):
            if node.c[k]:
                h = min(h, (tolerance * scale / abs(node.c[k])) ** (mpfr(1) / k))
    return h


def first_event(events, h):
    """The first change from above 0 within a step, and its name; they are looked for at 13 places."""
    found, places = [], [h * k / 12 for k in range(13)]
    for name, node in events:
        values = [node.at(p) for p in places]
        for k in range(12):
            if values[k] > 0 >= values[k + 1]:
                found.append((root(node, places[k], places[k + 1]), name))
                break
    return min(found, default=(None, None))


def time_root(t, when, high):
    """Where the time t, which only grows, is a given one."""
    low, place = mpfr(0), high / 2
    for _ in range(200):
        f = t.at(place) - when
        if f > 0:
            high = place
        else:
            low = place
        slope = mpfr(0)
        for k in range(len(t.c) - 1, 0, -1):
            slope = slope * place + k * t.c[k]
        following = place - f / slope
        if not low <= following <= high:
            following = (low + high) / 2
        if abs(following - place) <= abs(place) * mpfr("1e-39"):
            return following
        place = following
    return place


def sampled(out, samples, t, h, stretched):
    """Enters the samples within a step, the last one as the end."""
    while samples and samples[0] <= t.at(h):
        when = samples.pop(0)
        if when < t.c[0]:
            raise ArithmeticError(
                f"{out.model.scene.name}: {float(when)} was passed by the series of an onset"
            )
        place = time_root(t, when, h) if stretched else when - t.c[0]
        out.add("sample" if samples else "end", when, [node.at(place) for node in t.tape.states])


def departure(model, y):
    """The one direction in which slip can begin at u = 0: f = 0 and lambda > 0, with the contact pressed."""
    places = 180
    step = 2 * gmpy2.const_pi() / places
    first = mpfr("0.0123")
    values = [model.turning(y, first + k * step)[0] for k in range(places)]
    found = []
    for k in range(places):
        if (values[k] > 0) != (values[(k + 1) % places] > 0):
            low, high = first + k * step, first + (k + 1) * step
            f_low, f_high = values[k], values[(k + 1) % places]
            for _ in range(7):  # then secants
                middle = (low + high) / 2
                f = model.turning(y, middle)[0]
                low, f_low, high, f_high = (
                    (middle, f, high, f_high) if (f > 0) == (f_low > 0) else (low, f_low, middle, f)
                )
            for _ in range(12):
                if f_high == f_low or high == low:
                    break
                low, f_low, high = high, f_high, (low * f_high - high * f_low) / (f_high - f_low)
                f_high = model.turning(y, high)[0]
            _, growth, normal = model.turning(y, high)
            if growth > 0 and normal > 0:
                found.append(high)
    assert len(found) == 1, (model.scene.name, [float(x) for x in found])
    return found[0]


def slipping(model, y, out):
    """The phase that follows at u = 0, with its state: rolling, or slip in the only direction there is."""
    y = [mpfr(0), mpfr(0), *y[2:]]
    rolling = model.at("roll", y)
    if rolling.normal.c[0] > 0 and rolling.demand.c[0] >= 0:
        return "roll", y
    angle = departure(model, y)
    out.note("leaves u = 0 at", model.bearing(y, angle))
    return "slip", model.directed(y, angle, model.tiny)


def onset(model, y, out):
    """Slip that begins as |F| = mu N is passed: a state a little later, by the series in t, and its time.

    The series is asymptotic. The step is where its last numbers are smallest compared with the first.
    """
    rolling = model.at("roll", y)
    force = [x.c[0] for x in rolling.force]
    angle = gmpy2.atan2(-force[1], -force[0])
    phase = model.phase("onset")
    begin = [mpfr(0), angle, *y[2:]]
    phase.tape.expand(begin, 0)
    out.note("onset with lambda, f", phase.growth.c[0], phase.turn.c[0])
    phase.tape.expand_slaved(begin, model.last, phase.tape.states[1], phase.residual)
    size = phase.tape.states[0]
    assert size.c[2] > 0
    h = mpfr(1)
    for node in phase.tape.states:
        for k in range(model.last - 8, model.last + 1):
            scale = size.c[2] if node is size else mpfr(1)
            power = k - 2 if node is size else k
            if node.c[k]:
                h = min(h, (mpfr("1e-34") * scale / abs(node.c[k])) ** (mpfr(1) / power))
    h = h * mpfr(model.cut)
    out.note("series to", h)
    size, angle, *rest = (node.at(h) for node in phase.tape.states)
    return model.begun([size * gmpy2.cos(angle), size * gmpy2.sin(angle), *rest])


def follow(model, loud=False):
    """The checkpoints of a scene of slip and rolling."""
    scene, out = model.scene, Record(model, loud)
    samples = [mpfr(t) for t in scene.samples]
    y, kind = model.start(), "steep"
    if not scene.smooth:
        kind, y = slipping(model, y, out) if y[0] == 0 and y[1] == 0 else ("slip", y)
    while True:
        phase = model.phase(kind)
        tape, lean = phase.tape, model.lean(y)
        tape.expand(y, model.order)
        out.steps += 1
        h = step_size(phase, model.order, model.tolerance)
        place, name = first_event(model.events(phase, kind), h)
        h = h if name is None else place
        sampled(out, samples, tape.states[3], h, kind == "slip")
        if not samples:
            return out
        y = [node.at(h) for node in tape.states]
        if name == "slips":
            y = [mpfr(0), mpfr(0), *y[2:]]
            out.add(name, y[3], y)
            rises = model.static == model.mu
            y = onset(model, y, out) if rises else model.directed(y, departure(model, y), model.tiny)
            kind = "slip"
        elif name:
            out.add(name, y[3], y, lean if name == "face" else None)
            return out
        elif kind == "slip":
            size = gmpy2.sqrt(y[0] ** 2 + y[1] ** 2)
            if size < model.tiny and size < phase.size.c[0]:
                there = model.at("slip", y)
                growth = there.growth.c[0]
                out.note("u vanishes with lambda, normal", growth, there.normal.c[0])
                assert growth < 0
                y[3] += size / -growth
                kind, y = slipping(model, y, out)
                out.add("rolls" if kind == "roll" else "passes", y[3], [mpfr(0), mpfr(0), *y[2:]])
