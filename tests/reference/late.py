"""Writes late.json: how drifts of rolling go on to their ends, the reference of their late states.

    python tests/reference/late.py [name ...]    those whose names begin so; or all

It needs gmpy2 and mpmath, and ten minutes on one core.

The model is that of drift_model.py, in three dimensions. Here (ln tan(theta/2), w1, w3, t) go along the way x in the
logarithm and in w over |w|, in which theta may turn and come as near to 0 or pi as it likes, by Gragg's
extrapolated midpoint rule, to 1e-20 of each: a small w1 has as many digits as a large one. In 100 digits with differences over
1e-33 of the sine and of w. The end is where kappa or the distance to the side vanishes, or, where a face lands or a
ball stands, so far down that what is left of the time is below 1e-17 of it.

Inputs are exact doubles, results decimal, to 20 digits. `agreement` is between two sequences of extrapolation with
other steps, relative. A row is (t, theta, w1, w3), at 0.5, 0.8, 0.9, 0.95 and 0.99 of the time to the end.
"""

import bisect
import json
import pathlib
import time
from typing import NamedTuple

import extrapolation
import gmpy2
from drift_model import Model
from gmpy2 import mpfr
from losses_forms import LAWS
from series import precise
from tables import renew

HERE = pathlib.Path(__file__).parent
DIGITS = 100
DIFFERENCE = "1e-33"
SHARES = (0.5, 0.8, 0.9, 0.95, 0.99)


class Case(NamedTuple):
    """A body (ell, I1, I3, fillet), losses, and a steady state of it: theta, w1, w3."""

    name: str
    body: tuple
    losses: dict
    state: tuple


CASES = (
    Case(
        "fat cylinder, rolling resistance and drilling",
        (0.19999999999999996, 0.4617805045804505, 0.42903570716799116, 0.8367166170672904),
        {"rolling": 0.025589515752754158, "drilling": 0.001045119453473256},
        (0.6, 0.5433468039861454, 0.7611566706161002),
    ),
    Case(
        "top-heavy ball to its other pole, rolling resistance",
        (1.8125257872993776, 0.4519579092621223, 0.3614753877295005, 1.0),
        {"rolling": 0.00011258624343037596},
        (0.4, 0.6932979098881062, 4.866719915500279),
    ),
    Case(
        "Euler's disk, rolling resistance",
        (0.17, 0.2596333333333333, 0.5, 0.0),
        {"rolling": 0.001},
        (0.2, 0.8895726320000975, 0.1512273474400166),
    ),
    Case(
        "Euler's disk on a circle, rolling resistance and viscous",
        (0.17, 0.2596333333333333, 0.5, 0.0),
        {"rolling": 0.001, "viscous": 0.0001},
        (0.3, 1.3144682589138332, 0.3712808183500283),
    ),
    Case(
        "thin disk, rolling resistance",
        (0.0, 0.25, 0.5, 0.0),
        {"rolling": 0.001},
        (0.4, 1.2480678544192225, 0.0),
    ),
    Case(
        "rounded coin, rolling resistance and air",
        (0.1, 0.2580411594076662, 0.49020899577129795, 0.1),
        {"rolling": 0.002, "air": 0.001},
        (0.25, 0.9669457137791013, 0.20587739384676076),
    ),
    Case(
        "fat cylinder on a circle, rolling resistance and dry",
        (0.40000000000000013, 0.5354449046316798, 0.4498650185026549, 0.7),
        {"rolling": 0.003, "dry": 0.001},
        (0.4, 0.46810184087944545, 0.8317741914135389),
    ),
    Case(
        "bottom-heavy ball, rolling resistance and air",
        (-0.3, 0.4, 0.38, 1.0),
        {"rolling": 0.001, "air": 0.001},
        (1.0, 1.3046137767421753, 0.37256388452901684),
    ),
    Case(
        "displaced ball on a circle, rolling resistance",
        (0.5, 0.5, 0.4, 1.0),
        {"rolling": 0.001},
        (1.9, 1.527055763871134, 0.23261635376979536),
    ),
    Case(
        "cylinder through the ridge, rolling resistance",
        (2.5, 2.3333333333333335, 0.5, 0.0),
        {"rolling": 0.002},
        (0.3, 0.18549621215476428, 0.4637405303869107),
    ),
    Case(
        "cylinder on its side, rolling resistance",
        (2.5, 2.3333333333333335, 0.5, 0.0),
        {"rolling": 0.002},
        (1.2, 2.395704510462751, 5.989261276156878),
    ),
    Case(
        "tube on its side, rolling resistance and quadratic air",
        (6.0, 12.25, 0.5, 0.0),
        {"rolling": 0.001, "air2": 0.001},
        (1.4, 2.544240977477051, 15.265445864862308),
    ),
    Case(
        "nearly critical disk above the band, rolling resistance",
        (0.9, 0.52, 0.5, 0.0),
        {"rolling": 0.001},
        (1.0, 1.367140685303631, 1.2304266167732678),
    ),
    Case(
        "bottom-heavy ball on a circle, rolling resistance",
        (-0.3900307698590073, 0.5648077958528102, 0.6299385539087273, 1.0),
        {"rolling": 0.00024276716725663887},
        (1.870005868109354, 1.0283941410968012, -0.7813018174618233),
    ),
)


class Rolling(Model):
    """A body that rolls, whatever the size of its sine."""

    def settled(self, theta, w1, w3):
        """w3 next to that of a double for which nothing tilts it: to its pole a ball comes by nothing else."""
        for _ in range(8):
            ends = [self.lift(theta, w1, w3 + way * mpfr(DIFFERENCE)) for way in (1, -1)]
            w3 -= self.lift(theta, w1, w3) * 2 * mpfr(DIFFERENCE) / (ends[0] - ends[1])
        return w3

    def along(self, y):
        """The rates per x, and J kappa; theta."""
        theta = inclination(y[0])
        _, w1, w3, _ = y
        s, c = gmpy2.sin(theta), gmpy2.cos(theta)
        size = gmpy2.sqrt(w1 * w1 + w3 * w3)

        def slope(step, *way):
            ends = [self.lift(theta + k * way[0], w1 + k * way[1], w3 + k * way[2]) for k in (step, -step)]
            return (ends[0] - ends[1]) / (2 * step)

        near, small = mpfr(DIFFERENCE) * s, mpfr(DIFFERENCE) * size
        by = slope(near, 1, 0, 0), slope(small, 0, 1, 0), slope(small, 0, 0, 1)
        self.step = near
        first, _, third = self.changes(theta, w1, mpfr(1), w3)
        p = self.w_of(theta, self.couple(theta, self.components(theta, w1, mpfr(0), w3)))
        a, f = (c * p[0] + s * p[2], c * p[2] - s * p[0]), (-first, -third)
        stiff = by[0] + by[1] * f[0] + by[2] * f[1]
        force = by[1] * a[0] + by[2] * a[1]
        rates = [-force / s, a[0] * stiff - f[0] * force, a[1] * stiff - f[1] * force, stiff]
        length = gmpy2.sqrt(rates[0] ** 2 + (rates[1] ** 2 + rates[2] ** 2) / size**2)
        # the lift is minus the tilting or plus it: kappa is positive at the start
        self.sign = self.sign or gmpy2.sign(stiff)
        return [self.sign * rate / length for rate in rates], self.sign * stiff, theta


def inclination(x):
    near = 2 * gmpy2.atan(gmpy2.exp(-abs(x)))
    return near if x < 0 else gmpy2.const_pi() - near


def step(model, y, h, counts, close):
    """One step, by extrapolation; and after how many columns. None where it is too long."""
    for j, (best, before) in enumerate(extrapolation.steps(lambda _, y: model.along(y)[0], y, h, counts), 1):
        sizes = [1, abs(y[1]), max(abs(y[2]), abs(y[1]) / 1000), max(abs(y[3]), abs(best[3] - y[3]))]
        off = max(abs(p - q) / size for p, q, size in zip(best, before, sizes, strict=True))
        if off < close:
            return best, j
        if not gmpy2.is_finite(off):
            break
    return None, 0


def whole(case, counts, close):
    """The places on the way with the steps from them, the time of the end, and what it is."""
    model = Rolling(case.body, case.losses)
    theta, w1, w3 = (mpfr(x) for x in case.state)
    w3 = model.settled(theta, w1, w3)
    model.sign, model.way = None, gmpy2.sign(model.components(theta, w1, mpfr(0), w3)[2])
    y, h, places = [gmpy2.log(gmpy2.tan(theta / 2)), w1, w3, mpfr(0)], mpfr("0.02"), []
    side = gmpy2.const_pi() / 2 if case.body[0] > 0 and case.body[3] < 1 else mpfr(4)

    def margin(y):
        _, stiff, theta = model.along(y)
        return min(stiff, side - theta), "lies down" if side - theta < stiff else "stability lost"

    while True:
        made, column = step(model, y, h, counts, close)
        if made is None:
            h /= mpfr("2.5")
            continue
        if margin(made)[0] < 0:
            low, high = mpfr(0), h
            for _ in range(70):
                middle = (low + high) / 2
                part = step(model, y, middle, counts, close)[0]
                low, high = (middle, high) if margin(part)[0] > 0 else (low, middle)
            places.append((y, low))
            return model, places, part[3], margin(step(model, y, high, counts, close)[0])[1]
        places.append((y, h))
        before, y = y, made
        if abs(y[0]) > 7 and abs(y[0]) > abs(before[0]):
            ends = [model.along(place)[0] for place in (before, y)]
            slow = [abs(rate[3] / rate[0]) for rate in ends]
            power = gmpy2.log(slow[0] / slow[1]) / abs(y[0] - before[0])
            if power > 0 and slow[1] / power < mpfr("1e-17") * y[3]:
                return model, places, y[3] + slow[1] / power, "lands"
        h *= 2 if column < 8 else mpfr("1.3") if column < 10 else 1


def state_at(found, t, counts, close):
    """theta, w1 and w3 at a time, by Newton's method between bounds."""
    model, places, *_ = found
    y, h = places[bisect.bisect_right([place[0][3] for place in places], t) - 1]
    low, high, x = mpfr(0), h, h / 2
    while True:
        here = step(model, y, x, counts, close)[0]
        low, high = (x, high) if here[3] < t else (low, x)
        after = x - (here[3] - t) / model.along(here)[0][3]
        after = after if low <= after <= high else (low + high) / 2
        if abs(after - x) < mpfr("1e-17") * h:
            return inclination(here[0]), here[1], here[2]
        x = after


WAYS = ((range(2, 29, 2), "1e-20"), ((2, 4, 6, 8, 12, 14, 18, 20, 24, 28, 30), "1e-17"))


def written(case):
    begun, rows, times = time.time(), [], None
    for counts, close in WAYS:
        counts, close = tuple(counts), mpfr(close)
        found = whole(case, counts, close)
        times = times or [float(share * found[2]) for share in SHARES]
        rows.append([(mpfr(t), *state_at(found, mpfr(t), counts, close)) for t in times])
        rows[-1].append((found[2], mpfr(1), mpfr(1), mpfr(1)))
    pairs = [pair for one, other in zip(*rows, strict=True) for pair in zip(one, other, strict=True)]
    agreement = max(float(abs(a / b - 1)) for a, b in pairs)
    print(
        f"{case.name}: {found[3]} at {float(found[2]):.6g}, {agreement:.0e}, {time.time() - begun:.0f} s",
        flush=True,
    )
    decimal = [[f"{x:.19e}" for x in row] for row in rows[0]]
    return {
        "name": case.name,
        "body": case.body,
        "losses": [case.losses.get(name, 0.0) for name in LAWS],
        "state": case.state,
        "ended": found[3],
        "stops": decimal[-1][0],
        "agreement": agreement,
        "rows": decimal[:-1],
    }


def main():
    precise(DIGITS)
    path = HERE / "late.json"
    known = {one["name"]: one for one in json.loads(path.read_text())} if path.exists() else {}

    def text(found):
        rows = ",\n".join(json.dumps(one).replace(', ["', ',\n  ["') for one in found)
        return f"[\n{rows}\n]"

    renew(path, CASES, written, known, text)


if __name__ == "__main__":
    main()
