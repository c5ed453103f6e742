"""Writes fading.json: drifts of bodies that are nearly balls, whose inclination vanishes long before their spin.

    python tests/reference/fading.py        it needs gmpy2 and mpmath, and a minute on one core

The model is that of late.py, in three dimensions, to 100 digits, down to theta = 1e-34. From there on the rates of w3 and
of the time no longer depend on theta: they are taken at 1e-34 and, as a check, at 1e-44, with w1 next to w3 times k for which
nothing tilts the body, and the time is their integral over ln w3 by Gauss and Legendre.

A row is (t, w3), at 0.2, 0.5, 0.8, 0.9 and 0.99 of the time to the end. `agreement` is that of the rates at both
inclinations, and of the integrals by two numbers of nodes, relative.
"""

import json
import pathlib

import gmpy2
import late
from gmpy2 import mpfr
from losses_forms import LAWS
from mpmath import mp
from series import precise
from torus import rounded

HERE = pathlib.Path(__file__).parent
DEEP = (-34, -44)
SHARES = (0.2, 0.5, 0.8, 0.9, 0.99)


def solid(fillet):
    """ell, I1, I3 and fillet of a uniform solid body whose half thickness is its fillet, as doubles."""
    return tuple(float(x) for x in rounded(fillet, fillet))


CASES = (
    ("fillet 0.97, rolling resistance", solid(0.97), {"rolling": 0.07}, 0.1),
    ("fillet 0.9972, rolling resistance and air", solid(0.9972), {"rolling": 0.007, "air": 0.008}, 0.1),
    (
        "fillet 0.99, all of them",
        solid(0.99),
        {"rolling": 0.01, "drilling": 0.003, "air": 0.002, "air2": 0.004},
        0.1,
    ),
)


def centre_at_rest(body, theta):
    """w1 and w3 of the steady state with the centre at rest, as doubles."""
    ell, i1, i3, rho = body
    s, c = float(gmpy2.sin(mpfr(theta))), float(gmpy2.cos(mpfr(theta)))
    a = 1 - rho
    radius, depth, n = a + rho * s, ell + rho * c, a * c - ell * s
    rate = (n * radius / (i3 * s * (n + (i1 / i3 - 1) * c * radius))) ** 0.5
    return rate * s, rate * s * depth / radius


def rates(model, power, w1, w3):
    """dt/dln w3 and dln theta/dln w3 at this spin, where theta is 10^power."""
    theta = mpfr(10) ** power
    for _ in range(60):  # w1 for which nothing tilts it, by Newton's method
        step = mpfr(late.DIFFERENCE) * abs(w1)
        lift, slope = (
            model.lift(theta, w1, w3),
            (model.lift(theta, w1 + step, w3) - model.lift(theta, w1 - step, w3)) / (2 * step),
        )
        w1 -= lift / slope
        if abs(lift / slope) < mpfr("1e-60") * abs(w1):
            break
    along, _, _ = model.along([gmpy2.log(gmpy2.tan(theta / 2)), w1, w3, mpfr(0)])
    return w3 * along[3] / along[2], w3 * along[0] / along[2], w1


def faded(name, body, losses, theta):
    """The rows of a case."""
    model = late.Rolling(body, losses)
    start = (theta, *centre_at_rest(body, theta))
    theta, w1, w3 = (mpfr(x) for x in start)
    w3 = model.settled(theta, w1, w3)
    model.sign, model.way = None, gmpy2.sign(model.components(theta, w1, mpfr(0), w3)[2])
    y, h = [gmpy2.log(gmpy2.tan(theta / 2)), w1, w3, mpfr(0)], mpfr("0.02")
    counts, close = tuple(late.WAYS[0][0]), mpfr(late.WAYS[0][1])
    bottom = DEEP[0] * gmpy2.log(mpfr(10)) - gmpy2.log(mpfr(2))
    while y[0] > bottom:
        after, column = late.step(model, y, h, counts, close)
        if after is None:
            h /= mpfr("2.5")
            continue
        y = after
        h *= 2 if column < 8 else mpfr("1.3") if column < 10 else 1
    _, w1, w3, t = y
    agreement = 0.0

    def slow(z, power=DEEP[0]):
        """dt/dz at w3 exp(-z)."""
        left = gmpy2.exp(-mpfr(z))
        return -rates(model, power, w1 * left, w3 * left)[0]

    def integral(end, nodes):
        """The time to w3 exp(-end), in pieces of two."""
        x, weights = mp_nodes(nodes)
        total, pieces = mpfr(0), max(1, int(end / 2 + 1))
        for k in range(pieces):
            low, half = end * k / pieces, end / pieces / 2
            total += sum(half * w * slow(low + half * (1 + p)) for p, w in zip(x, weights, strict=True))
        return total

    for z in (0, 3, 20):
        agreement = max(agreement, abs(float(slow(z, DEEP[1]) / slow(z) - 1)))
    # in the end the spin falls evenly
    last = mpfr(46)
    rest = integral(last, 14) + slow(last)
    agreement = max(agreement, abs(float((integral(last, 10) + slow(last)) / rest - 1)))
    stops, rows = t + rest, []
    for share in SHARES:
        goal = mpfr(share) * stops
        if goal < t:
            continue
        z = mpfr(0)
        for _ in range(40):
            step = (goal - t - integral(z, 14)) / slow(z)
            z += max(min(step, mpfr(2)), -z / 2)
            if abs(step) < mpfr("1e-18"):
                break
        rows.append([f"{goal:.25e}", f"{w3 * gmpy2.exp(-z):.25e}"])
    print(name, float(stops), agreement, flush=True)
    return {
        "name": name,
        "body": body,
        "losses": [losses.get(law, 0.0) for law in LAWS],
        "state": start,
        "stops": f"{stops:.25e}",
        "rows": rows,
        "agreement": agreement,
    }


def mp_nodes(count):
    """Nodes and weights of Gauss and Legendre, to 60 digits."""
    with mp.workdps(60):
        x = sorted(
            mp.polyroots(
                mp.taylor(lambda u: mp.legendre(count, u), 0, count)[::-1], maxsteps=200, extraprec=400
            )
        )
        weights = [2 / ((1 - u**2) * mp.diff(lambda v: mp.legendre(count, v), u) ** 2) for u in x]
    return [mpfr(mp.nstr(u.real, 50)) for u in x], [mpfr(mp.nstr(w.real, 50)) for w in weights]


def main():
    precise(late.DIGITS)
    found = [faded(*case) for case in CASES]
    rows = ",\n".join(json.dumps(one).replace(', ["', ',\n  ["') for one in found)
    (HERE / "fading.json").write_text(f"[\n{rows}\n]\n")


if __name__ == "__main__":
    main()
