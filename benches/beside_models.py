"""Random motions beside the models of tests/reference, for random_scenes.py --reference.

The models integrate Newton's and Euler's equations by Taylor series with 40 and 50 digits, and share no formula with the
library. Here the series are shorter than in the references, with 24 orders within 1e-24. A scene is in the domain of its
model (sharp rims and balls, Coulomb's friction), takes seconds, and is left out if the model does not follow it. A ratio is the true error of a state over the estimated error, of which the least is 1e-14.
"""

import math
import pathlib
import sys
import time

import numpy as np
from drawn_motions import DRY, LAWS, law
from draws import log_uniform
from gmpy2 import mpfr
from invariants import told
from limit import Late, limit

import spincyl as sc

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests" / "reference"))
import flights
import losses
import lying
import patches
import phases
import slip_forms
from series import precise
from slip import Scene as Slips
from torus import tube

#: The least estimated error, a few roundings of a fast motion.
LEAST = 1e-14
MOST = 90.0  # seconds of the processor for one scene
#: Names of the losses in the models of one rim and of both.
NAMES = {
    "DryContour": "dry", "ViscousContour": "viscous", "RollingResistance": "rolling", "Drilling": "drilling",
    "AirLinear": "air", "AirQuadratic": "air2", "AirFilm": "film", "BoundaryLayer": "layer",
}  # fmt: skip


def cylinder(rng):
    return tube(float(rng.uniform(0.2, 3.0)), float(rng.choice([0.0, rng.uniform(0, 0.9)])))


def start(rng, theta=None):
    theta = float(rng.uniform(0.3, 1.4)) if theta is None else theta
    return (theta, *map(float, rng.normal(size=3) * (1, 0.7, 1)), *map(float, rng.normal(size=2)))


def hops(rng):
    scene = flights.Scene(
        "hops", cylinder(rng), float(rng.uniform(0.1, 0.8)), float(rng.choice([0.0, 0.3, 0.5, 0.8])), start(rng), 3.0,
        height=float(rng.uniform(0.0, 1.0)) if rng.random() < 0.6 else None, rows=0,
    )  # fmt: skip
    aloft = {"height": scene.height, "lift": scene.lift} if scene.aloft else {}
    how = {"contact": sc.Coulomb(scene.mu), "restitution": scene.restitution}
    return scene, flights.Closed, flights.follow, aloft, how


def lies(rng):
    theta, w1, _, w3, *slip = start(rng, math.pi / 2)
    used = [str(x) for x in rng.choice(list(DRY), int(rng.integers(0, 3)), replace=False)]
    taken = {name: law(rng, name, 5e-3, 0.1) for name in used}
    scene = lying.Scene(
        "lies", cylinder(rng), float(rng.uniform(0.1, 0.6)), (theta, w1, 0.0, w3, *slip), 4.0,
        losses={NAMES[name]: x.coefficient for name, x in taken.items()},
    )  # fmt: skip
    how = {"contact": sc.Coulomb(scene.mu), "restitution": 0.0} | summed(taken)
    return scene, lying.Reduced, lying.follow, {}, how


def summed(taken):
    laws = list(taken.values())
    return {"losses": sum(laws[1:], start=laws[0])} if laws else {}


def creeps(rng):
    body = cylinder(rng) if rng.random() < 0.5 else (float(rng.uniform(-0.3, 0.3)), 0.45, 0.4, 1.0)
    scene = patches.Scene(
        "patch", body, float(rng.uniform(0.1, 0.5)), log_uniform(rng, 0.01, 0.1), start(rng), 1.0
    )
    return scene, patches.Reduced, patches.follow, {}, {"contact": sc.Coulomb(scene.mu, patch=scene.patch)}


def loses(rng):
    used = [str(x) for x in rng.choice(list(LAWS), int(rng.integers(1, 4)), replace=False)]
    taken = {name: law(rng, name, 1e-3, 0.05) for name in used}
    contact = str(rng.choice(["rolling", "smooth", "coulomb"]))
    scene = losses.Scene(
        "loses", cylinder(rng), {NAMES[name]: x.coefficient for name, x in taken.items()},
        start(rng)[: 6 if contact == "coulomb" else 4], 3.0, contact=contact,
        mu=float(rng.uniform(0.1, 0.8)) if contact == "coulomb" else 0.0,
    )  # fmt: skip
    how = {"contact": sc.Coulomb(scene.mu) if contact == "coulomb" else contact} | summed(taken)
    return scene, losses.Momenta, losses.follow, {}, how


def slips(rng):
    scene = Slips("slips", cylinder(rng), float(rng.uniform(0.05, 0.8)), start(rng), 5.0)
    return scene, slip_forms.Reduced, phases.follow, {}, {"contact": sc.Coulomb(scene.mu)}


MODELS = {
    "hops": (hops, flights.DIGITS),
    "lies on both rims": (lies, lying.DIGITS),
    "patch": (creeps, patches.DIGITS),
    "losses": (loses, losses.DIGITS),
    "slip and roll": (slips, 40),
}


def ratio(scene, make, follow, aloft, how):
    """The largest true error of the states over the estimated error, and the estimated error; None without a state."""
    shorter = type(make.__name__, (make,), {"order": 24, "tolerance": mpfr("1e-24")})
    record = follow(shorter(scene))
    rows = [
        (float(row[0]), np.array(row[1:5], float)) for kind, row in record.rows if kind in ("sample", "end")
    ]
    ell, i1, i3, fillet = scene.body
    body = sc.Body(ell, i1, i3, fillet=fillet)
    theta, w1, w2, w3, *u = scene.start
    moves = None if how["contact"] in ("rolling", "smooth") else tuple(u)
    m = sc.roll(body, sc.State(theta, w1, w2, w3, slip=moves, **aloft), [t for t, _ in rows], t0=0.0, **how)
    if len(m.t) < len(rows):  # the model goes on beyond an ending, or ends otherwise
        rows = rows[: len(m.t)]
    if not rows or not np.isfinite(m.error):
        return None
    off = [
        np.abs(told(body, m.theta[k], m.w[k]) - told(body, y[0], y[1:])).max()
        for k, (_, y) in enumerate(rows)
    ]
    return max(off) / max(m.error, LEAST), m.error


def compared(seed, count):
    """Print the ratios of every model; the number of motions that are wrong."""
    wrong = 0
    print(
        "| model | scenes | followed | median | worst | above 2 | s each |\n| --- | --- | --- | --- | --- | --- | --- |"
    )
    shown = []
    for number, (name, (draw, digits)) in enumerate(MODELS.items()):
        precise(digits)
        found, since = [], time.process_time()
        for index in range(count):
            drawn = draw(np.random.default_rng([seed, number, index]))
            try:
                with limit(MOST):
                    one = ratio(*drawn)
            except (AssertionError, Late, ValueError, ZeroDivisionError, KeyError) as why:
                shown.append(f"{name}:{index} is left out: {type(why).__name__} {str(why)[:80]}")
                continue
            if one is not None:
                found.append((*one, index, drawn))
        each = (time.process_time() - since) / count
        if not found:
            print(f"| {name} | {count} | 0 | | | | {each:.1f} |", flush=True)
            continue
        ratios = np.array([x[0] for x in found])
        above = [x for x in found if x[0] > 2]
        wrong += len(above)
        print(
            f"| {name} | {count} | {len(found)} | {np.median(ratios):.2g} | {ratios.max():.2g} | {len(above)} | {each:.1f} |",
            flush=True,
        )
        shown += [
            f"{name}:{index} {x:.2g} times the claim {claim:.1e}: body {d[0].body}, start {d[0].start}, {d[3]} {d[4]}"
            for x, claim, index, d in above
        ]
    print("\n".join(shown))
    return wrong
