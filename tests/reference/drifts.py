"""Writes drifts.json: slow drifts of steady motions by losses, the reference of their tests.

    python tests/reference/drifts.py [name ...]    those whose names begin so; or all

It needs gmpy2 and mpmath, and five minutes on one core.

The model is that of drift_model.py, in three dimensions.

All in 80 digits with differences over 1e-20, so that these are right to 38. What ends at theta = 0 in
`rolling` is extrapolated in theta^(1/4). Inputs are exact doubles, results decimal, to 25 digits.
`agreement`, relative: of `rest` between the whole and two parts, 1e-31 at least, the digits of the
quadrature; of `rolling` between two sequences of extrapolation with other steps.

A case ends as the library names it: face lands, lies down, lowest state, balanced, stands upright, stability lost,
and drilling stops, where w.z = 0 and drilling friction, which alone is there, takes nothing any more; `ends`
is where and `stops` when, inf where the time is infinite. `stable` is when kappa of rolling vanishes on
the way of `rest`, if it does, and 0 where it is negative from the start. A row is
(theta, t, w1, w3).
"""

import pathlib
import time
from itertools import pairwise

import extrapolation
import gmpy2
import newton_euler
from drift_model import Model
from gmpy2 import mpfr
from losses_forms import LAWS
from mpmath import mp
from series import precise
from tables import decimal, renew_json
from torus import rounded, tube

HERE = pathlib.Path(__file__).parent
DIGITS = 80


# The centre at rest.


def exactly(x):
    """An mpmath number as one of gmpy2."""
    sign, man, exp, _ = x._mpf_
    number = mpfr(-int(man) if sign else int(man))
    return gmpy2.mul_2exp(number, exp) if exp >= 0 else gmpy2.div_2exp(number, -exp)


def to_mp(x):
    man, exp = x.as_mantissa_exp()
    return mp.ldexp(mp.mpf(int(man)), int(exp))


def resting_time(model, start, end, balanced=None):
    """The time from start to end, and how far that of two parts is from it."""
    sign = 1 if balanced is None or balanced > start else -1

    def integrand(x):
        x = exactly(x)
        theta, factor = (x**4, 4 * x**3) if balanced is None else (balanced - sign * x * x, -2 * sign * x)
        return to_mp(-model.slope(theta) / model.power(theta) * factor)

    def variable(theta):
        return mp.root(to_mp(theta), 4) if balanced is None else mp.sqrt(abs(to_mp(balanced - theta)))

    with mp.workdps(32):
        low, high = variable(start), variable(end)
        middle = low + (high - low) * 3 / 7
        whole = mp.quad(integrand, [low, high], method="gauss-legendre")
        parts = mp.quad(integrand, [low, middle, high], method="gauss-legendre")
        off = float(abs(parts / whole - 1))
    return exactly(whole), max(off, 1e-31)


def zero(f, low, high, close):
    """Where f vanishes between two places: the false position, kept moving (Illinois)."""
    f_low, f_high, side, last = f(low), f(high), 0, None
    assert (f_low > 0) != (f_high > 0)
    for _ in range(100):
        x = (low * f_high - high * f_low) / (f_high - f_low)
        if last is not None and abs(x - last) < close:
            return x
        last, value = x, f(x)
        if value == 0:
            return x
        if (value > 0) == (f_low > 0):
            low, f_low = x, value
            f_high, side = (f_high / 2 if side == 1 else f_high), 1
        else:
            high, f_high = x, value
            f_low, side = (f_low / 2 if side == -1 else f_low), -1
    raise ArithmeticError("no zero was found")


def fractions(start, end):
    return [mpfr(float(start + (end - start) * mpfr(k) / 16)) for k in (1, 4, 8, 12, 15)]


def rest(case):
    """A drift with the centre at rest."""
    model, start = case.model, mpfr(case.theta)
    down = model.slope(start) > 0
    half_pi = gmpy2.const_pi() / 2
    balance = gmpy2.atan2(model.rim, model.ell)
    end, ended = (mpfr(0), "face lands") if down else (half_pi, "lies down")
    if down and not model.rim:
        ended = "stands upright"
    elif down == (start > balance):
        end, ended = balance, "balanced"
    # the lowest state, looked for between the start and that end
    places = [start + (end - start) * mpfr(k) / 200 for k in range(1, 200)]
    for a, b in pairwise(places):
        if (model.slope(a) > 0) != (model.slope(b) > 0):
            end, ended = zero(model.slope, a, b, mpfr("1e-36")), "lowest state"
            break
    rows, worst = [], 0.0
    for theta in fractions(start, end):
        t, off = resting_time(model, start, theta)
        worst = max(worst, off)
        rows.append((theta, t, *model.state(theta)))
    stops = mpfr("inf")
    if not case.never:
        stops, off = resting_time(model, start, end, balance if ended == "balanced" else None)
        worst = max(worst, off)
    stable = None

    def bend(theta):
        return model.kappa(theta, *model.state(theta))

    if bend(start) <= 0:
        stable = mpfr(0)
    places = [start, *places]
    for a, b in pairwise(places):
        if (a > end if down else a < end) and bend(a) > 0 >= bend(b):
            stable = resting_time(model, start, zero(bend, a, b, mpfr("1e-36")))[0]
            break
    return rows, end, ended, stops, stable, worst


# Rolling.


def extrapolated(model, x, y, h, counts):
    """One step, by extrapolation until it is exact; and what its last column changed."""
    for best, before in extrapolation.steps(lambda part, y: model.drift(x + part, y), y, h, counts):
        off = max(abs(p - q) / max(mpfr("1e-3"), abs(p)) for p, q in zip(best, before, strict=True))
        if off < mpfr("1e-27"):
            break
    return best, off


def carried(model, x, y, to, longest, counts):
    """The state at another x."""
    while x != to:
        h = to - x
        h = h if abs(h) <= longest else longest * gmpy2.sign(h)
        while True:
            found, off = extrapolated(model, x, y, h, counts)
            if off < mpfr("1e-26"):
                break
            h /= 2
        y = found
        x = to if h == to - x else x + h
    return y


SEQUENCES = ((mpfr("0.5"), range(2, 29, 2)), (mpfr("0.37"), (2, 4, 6, 8, 12, 14, 18, 20, 24, 28, 30, 34)))
FLAT = [mpfr(k) / 1000 for k in range(66, 26, -2)]  # theta^(1/4) near the end


def rolling(case):
    """A drift of rolling."""
    model, start = case.model, mpfr(case.theta)
    y = [mpfr(0), *model.state(start)]
    x, model.way = gmpy2.log(start), gmpy2.sign(model.components(start, y[1], mpfr(0), y[2])[2])
    direction = gmpy2.sign(model.drift(x, y)[0])
    assert model.kappa(start, *y[1:]) > 0, case.name
    top = gmpy2.log(gmpy2.const_pi() / 2)
    # a rough pass, to find what ends it
    ends = [("stability lost", model.kappa)]
    if case.losses.get("drilling"):
        ends.append(("drilling stops", lambda theta, w1, w3: model.components(theta, w1, mpfr(0), w3)[2]))
    rough, at, ended = y, x, "face lands" if direction < 0 else "lies down"
    while ended in ("face lands", "lies down"):
        h = direction * mpfr("0.05")
        if direction > 0:
            h = min(h, top - at)
        elif at < gmpy2.log(mpfr("0.01")):
            break
        following = extrapolated(model, at, rough, h, (2, 4, 6))[0]
        for name, margin in ends:
            if margin(gmpy2.exp(at + h), *following[1:]) < 0:
                ended, last_margin = name, margin
        if ended == "lies down" and at + h == top:
            break
        if ended in ("face lands", "lies down"):
            assert following[0] > rough[0], (case.name, float(gmpy2.exp(at)), [float(v) for v in following])
            rough, at = following, at + h
    answers = []
    for longest, counts in SEQUENCES:

        def upto(x, y, to, longest=longest, counts=counts):
            return carried(model, x, y, to, longest, counts)

        last = None
        if ended in ("stability lost", "drilling stops"):
            base = upto(x, y, at)
            margin = lambda q, b=base: last_margin(gmpy2.exp(q), *upto(at, b, q)[1:])  # noqa: E731
            place = zero(margin, at, at + h, mpfr("1e-26"))
            last, end = upto(at, base, place), gmpy2.exp(place)
        else:
            end = mpfr(0) if ended == "face lands" else gmpy2.const_pi() / 2
        rows, here, now = [], x, y
        for theta in fractions(start, end):
            now, here = upto(here, now, gmpy2.log(theta)), gmpy2.log(theta)
            rows.append((theta, *now))
        if ended == "lies down":
            last = upto(here, now, top)
        stops = last[0] if last else None
        if ended == "face lands" and case.never:
            stops = mpfr("inf")
        elif ended == "face lands":
            times = []
            for u in FLAT:
                now, here = upto(here, now, 4 * gmpy2.log(u)), 4 * gmpy2.log(u)
                times.append(now[0])
            stops = extrapolation.to_zero(FLAT, times)
        answers.append((rows, end, stops))
    (rows, end, stops), (others, other_end, other_stops) = answers
    differences = [
        abs(a - b) / max(abs(a), mpfr("1e-3"))
        for p, q in zip(rows, others, strict=True)
        for a, b in zip(p, q, strict=True)
    ]
    differences += [abs(end - other_end)]
    if gmpy2.is_finite(stops):
        differences.append(abs(stops / other_stops - 1))
    return rows, end, ended, stops, None, float(max(differences))


# The cases.


class Case:
    """A body (ell, i1, i3, fillet), losses, and theta of the start, where the centre rests."""

    def __init__(self, name, centre, body, losses, theta, never=False):
        self.name, self.centre, self.losses, self.never = name, centre, losses, never
        self.body, self.theta = [float(x) for x in body], float(theta)
        self.model = Model(self.body, losses)


def cases():
    coin, paper, solid = tube(0.0, 0.0), tube(6.0, 0.8), tube(2.5, 0.0)
    disk, low = tube(0.0128 / 0.0751, 0.0), rounded(0.0128 / 0.0751, 0.002 / 0.03755)
    edge, nearly = tube(0.5, 0.0), tube(0.875, 0.0)
    each = list(zip(LAWS, (2e-3, 1e-3, 3e-3, 2e-3, 1e-3, 5e-4, 1e-4, 3e-4), strict=True))
    endless = ("air", "air2")
    for law, k in each:
        yield Case(f"coin, {law}", "rest", coin, {law: k}, 0.3, never=law in (*endless, "drilling"))
        yield Case(f"Euler's disk, {law}", "rest", disk, {law: k}, 0.4, never=law in endless)
        yield Case(f"tube on its side, {law}", "rest", paper, {law: k}, 1.3)
    both = {"dry": 1e-3, "film": 1e-4}
    yield Case("Euler's disk, dry and film", "rest", disk, both, 0.5)
    yield Case("rounded disk, dry and film", "rest", low, both, 0.5)
    yield Case("rounded disk, layer", "rest", low, {"layer": 3e-4}, 0.3)
    yield Case("rounded disk, viscous from a thousandth", "rest", low, {"viscous": 1e-3}, 1e-3)
    yield Case("coin, dry from a thousandth", "rest", coin, {"dry": 1e-4}, 1e-3)
    yield Case("cylinder below the ridge, dry", "rest", solid, {"dry": 2e-3}, 0.24)
    yield Case("cylinder above the ridge, dry", "rest", solid, {"dry": 2e-3}, 0.30, never=True)
    yield Case("cylinder above the ridge, drilling", "rest", solid, {"drilling": 2e-3}, 0.30)
    yield Case("cylinder lies down, rolling and air2", "rest", solid, {"rolling": 3e-3, "air2": 1e-3}, 1.2)
    top = (-0.2, 0.39, 0.40, 1.0)
    yield Case("tippe top falls back, dry and layer", "rest", top, {"dry": 1e-3, "layer": 1e-3}, 1.0)
    yield Case("tippe top falls back, drilling", "rest", top, {"drilling": 1e-3}, 1.0)
    yield Case("disk on edge falls, viscous", "rest", edge, {"viscous": 1e-3}, 1.15, never=True)
    yield Case("disk on edge falls, drilling", "rest", edge, {"drilling": 1e-3}, 1.15)
    yield Case("disk on edge lies down, dry", "rest", edge, {"dry": 1e-3}, 1.5)
    yield Case("nearly critical from above, dry", "rest", nearly, {"dry": 1e-3}, 1.45)
    yield Case("nearly critical from below, air", "rest", nearly, {"air": 1e-3}, 0.9)

    for law, k in each:
        yield Case(f"Euler's disk rolls, {law}", "rolling", disk, {law: k}, 0.2, never=law in endless)
    yield Case("rounded disk rolls, dry and film", "rolling", low, both, 0.3)
    yield Case("coin rolls, viscous and rolling", "rolling", coin, {"viscous": 1e-3, "rolling": 1e-3}, 0.3)
    yield Case("cylinder rolls through the ridge, dry", "rolling", solid, {"dry": 2e-3}, 0.30)
    yield Case("cylinder rolls on its side, dry", "rolling", solid, {"dry": 2e-3}, 1.2)
    yield Case("cylinder rolls on its side, drilling", "rolling", solid, {"drilling": 2e-3}, 1.2)
    yield Case("cylinder rolls on its side, air", "rolling", solid, {"air": 2e-3}, 1.2)
    yield Case("cylinder rolls above the edge, dry", "rolling", solid, {"dry": 2e-3}, 0.33)
    yield Case("disk on edge rolls, rolling resistance", "rolling", edge, {"rolling": 1e-3}, 1.175)
    yield Case("disk on edge rolls, air and drilling", "rolling", edge, {"air": 1e-3, "drilling": 1e-3}, 1.17)
    yield Case("tube rolls, rolling resistance", "rolling", paper, {"rolling": 2e-3}, 1.3)


def written(case):
    begun = time.time()
    rows, end, ended, stops, stable, agreement = (rest if case.centre == "rest" else rolling)(case)
    stable = None if stable is None else decimal(stable)
    times = f"t = {float(stops):.6g}, stable until {stable}"
    spent = f"agreement {agreement:.0e}, {time.time() - begun:.0f} s"
    print(f"{case.name}: {case.centre}, {ended} at {float(end):.6g}, {times}, {spent}", flush=True)
    return {
        "name": case.name,
        "centre": case.centre,
        "body": case.body,
        "losses": [case.losses.get(name, 0.0) for name in LAWS],
        "theta": case.theta,
        "ended": ended,
        "ends": decimal(end),
        "stops": decimal(stops),
        "stable": stable,
        "agreement": agreement,
        "rows": [[decimal(x) for x in row] for row in rows],
    }


def checked():
    """The rates without losses are those of newton_euler.py, which finds the contact force."""
    body, state = (2.5, 2.3, 0.5, 0.1), (0.3, 0.2, 0.7, 0.5)
    with mp.workdps(50):
        other = newton_euler.derivative([mp.mpf(x) for x in body], [mp.mpf(x) for x in state], "rolling")[1:]
        for one, rate in zip(Model(body, {}).changes(*(mpfr(x) for x in state)), other, strict=True):
            assert abs(to_mp(one) - rate) < 1e-36


def main():
    precise(DIGITS)
    checked()
    columns = ["theta", "t", "w1", "w3"]
    renew_json(HERE / "drifts.json", cases(), written, "drifts", laws=LAWS, columns=columns)


if __name__ == "__main__":
    main()
