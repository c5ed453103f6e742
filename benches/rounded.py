"""Errors for rounded rims: steady states and motions against the references of tests/reference, and the
inverse.

    python benches/rounded.py [--bodies 20000]

Each number is the largest of its kind over its bound: 2 (1 + kappa_c) ulp of a rate; 1e-13 of the larger term
and 16 ulp times the conditioning of a kappa; 8 (1 + kappa_c) ulp of the rate of an inclination. For motions
it is the error, divided by t/20 if that is above 1, and the error over the estimated error.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np
from mpmath import mpf, workdps

import spincyl as sc

REFERENCE = Path(__file__).parents[1] / "tests" / "reference"
ULP = 2.0**-53


def rows(name):
    """The rows of a table as dictionaries of words."""
    with (REFERENCE / f"rounded_{name}.csv").open() as file:
        return list(csv.DictReader(file)) if name != "motion" else list(csv.reader(file))[1:]


def number(word):
    """A double, from hexadecimal or decimal digits."""
    return float.fromhex(word) if "x" in word else float(word)


def steady_states():
    """The worst rate, rolling kappa and smooth kappa."""
    worst = dict.fromkeys(("rate", "rolling", "smooth"), 0.0)
    for row in rows("steady"):
        ell, i1, i3, fillet, theta = (number(row[k]) for k in ("ell", "i1", "i3", "fillet", "theta"))
        rate, condition = number(row["rate"]), abs(number(row["kappa_c"]))
        if np.isnan(rate):
            continue
        body = sc.Body(ell, i1, i3, fillet=fillet, theta_end=np.pi)
        # the reference has more digits than a double
        off = abs(float(mpf(float(body.rate(theta))) / mpf(row["rate"]) - 1)) / ULP / (1 + condition)
        worst["rate"] = max(worst["rate"], off / 2)
        s, c, a = np.sin(theta), np.cos(theta), 1 - fillet
        radius, depth, lever = a + fillet * s, ell + fillet * c, ell * s - a * c
        for contact in ("rolling", "smooth"):
            kappa = number(row[contact])
            inertia = i1 + (radius**2 + depth**2 if contact == "rolling" else lever**2)
            size = max(abs(kappa), abs(ell * c + a * s) / inertia, i1 * rate**2 / i3 / inertia)
            allowed = (1e-13 + 16 * ULP * condition) * size
            worst[contact] = max(worst[contact], abs(float(body.stability(theta, contact)) - kappa) / allowed)
    return worst


def motions():
    """The largest error of states and of poses, and the largest ratio of each to the estimated error."""
    worst = dict.fromkeys(("state", "state over claim", "pose", "pose over claim"), 0.0)
    for kind, _, contact, *words in rows("motion"):
        if kind != "state":
            continue
        ell, i1, i3, fillet, *start, t = map(number, words[:9])
        values = np.array([number(word) for word in words[9:]])
        body, long = sc.Body(ell, i1, i3, fillet=fillet), max(1.0, t / 20)
        m = sc.roll(body, sc.State(*start), t, contact=contact, want="pose", beyond=True)
        off = np.abs(m.y[:, 0] - values[:4]).max()
        turned = max(abs(m.phi[0] - values[4]), abs(m.psi[0] - values[5]))
        found = (off / long, off / m.error, turned / long, turned / m.pose_error)
        worst = {name: max(so_far, x) for (name, so_far), x in zip(worst.items(), found, strict=True)}
    return worst


def inverse(count):
    """The largest residual of the inclinations of random bodies and rates, and how many bodies have 0, 1, ...
    of them."""
    rng = np.random.default_rng(1)
    fillet = rng.uniform(0, 1, count)
    half = fillet + rng.uniform(0, 3, count) * rng.choice([1, 0.1], count)
    rate = rng.uniform(0.3, 3, count)
    theta = np.asarray(sc.Body.solid(half, fillet=fillet).inclinations(rate))
    body = sc.Body.solid(half[:, None], fillet=fillet[:, None])
    with np.errstate(invalid="ignore"):
        # h is small enough for rates that become steep within a millionth of theta
        around = [np.log(body.rate(theta * (1 + h))) for h in (1e-9, -1e-9)]
        condition = np.abs(around[0] - around[1]) / 2e-9
        off = np.abs(body.rate(theta) - rate[:, None]) / rate[:, None] / ULP / (1 + condition)
    return np.nanmax(off) / 8, np.bincount(np.isfinite(theta).sum(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bodies", type=float, default=2e4)
    args = parser.parse_args()
    with workdps(40):
        steady = steady_states()
    for what, worst in (("steady states, of what is promised", steady), ("motions", motions())):
        print(what + ": " + ", ".join(f"{name} {x:.2g}" for name, x in worst.items()))
    residual, counts = inverse(int(args.bodies))
    print(f"inclinations, of what is promised: {residual:.2g}; bodies with 0, 1, ... of them: {counts}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
