"""Random bodies of parts, films and spin-downs for random_scenes.py, with answers known from how they were made.

Every function gets a generator, the number of the scene and a `Found`, and calls `found.wrong("answer", ...)` for an
answer that is wrong without a warning.
"""

import math
import warnings

import numpy as np
from drawn_motions import LAWS, contact, tilted, times
from draws import log_uniform
from invariants import judged, reach

import spincyl as sc
from spincyl import parts

#: Standard errors beyond which a measured number is wrong; of 5,000 honest ones none is.
SURE = 6.0
NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)
FINE = np.linspace(0.0, 1.0, 4001)
#: Another part is below the table if it is lower than this, in R; the sampled curves err by less.
DEEP = 1e-6


def turned(low, high, radius, thin=False):
    """Mass, height of the centre, and moments about it (across, along) of a solid or a thin shell of revolution.

    `radius` gives the outer and the inner radius at a height; for a shell, the radius and the length of its profile
    for each unit of height. The density is 1.
    """
    z = low + (high - low) * (NODES + 1) / 2
    a, b = radius(z)
    if thin:
        ring = 2 * np.pi * a * b
        square = a**2
    else:
        ring, square = np.pi * (a**2 - b**2), (a**2 + b**2) / 2
    m = WEIGHTS * ring * (high - low) / 2
    mass = m.sum()
    centre = (m @ z) / mass
    return mass, centre, m @ (square / 2 + (z - centre) ** 2), m @ square


def profile(kind, rng, size):
    """A part and the same from first principles: (Part without `at`, profile (r, z), mass, centre, moments)."""
    r, s, h = size * rng.uniform(0.3, 1.0, 3)
    steps, z = FINE, None
    if rng.random() < 0.3:
        s = r
    if kind == "cylinder":
        b = 0.0 if rng.random() < 0.5 else r * rng.uniform(0.1, 0.95)
        part = parts.cylinder(outer_diameter=2 * r, inner_diameter=2 * b, length=h, density=1.0)
        outline, of = [(b, 0), (r, 0), (r, h), (b, h)], turned(0, h, lambda z: (r + 0 * z, b + 0 * z))
    elif kind == "cone":
        s = 0.0 if rng.random() < 0.3 else s
        part = parts.cone(lower_diameter=2 * r, upper_diameter=2 * s, length=h, density=1.0)
        outline, of = [(0, 0), (r, 0), (s, h), (0, h)], turned(0, h, lambda z: (r + (s - r) * z / h, 0 * z))
    elif kind == "wall":
        part = parts.wall(lower_diameter=2 * r, upper_diameter=2 * s, length=h, density=1.0)
        outline = [(r, 0), (s, h)]
        of = turned(0, h, lambda z: (r + (s - r) * z / h, math.hypot(s - r, h) / h + 0 * z), thin=True)
    elif kind == "disk":
        part = parts.disk(outer_diameter=2 * r, density=1.0)
        mass = np.pi * r**2
        outline, of = [(0, 0), (r, 0)], (mass, 0.0, mass * r**2 / 4, mass * r**2 / 2)
    elif kind == "ring":
        part, mass = parts.ring(diameter=2 * r, density=1.0), 2 * np.pi * r
        outline, of = [(r, 0)], (mass, 0.0, mass * r**2 / 2, mass * r**2)
    else:  # of a ball
        whole, upper = kind == "ball" or rng.random() < 0.2, bool(rng.integers(2))
        h = 2 * r if whole else 2 * r * rng.uniform(0.1, 0.9)
        up = {"upper": upper} if upper and not whole else {}
        middle = h - r if up else r
        low, high = max(-1.0, -middle / r), min(1.0, (h - middle) / r)
        angle = np.arcsin(low) + (np.arcsin(high) - np.arcsin(low)) * steps
        z = middle + r * np.sin(angle)
        outline = np.stack([r * np.cos(angle), z], 1)
        round_ = lambda z: np.sqrt(np.maximum(r**2 - (z - middle) ** 2, 0.0))  # noqa: E731
        if kind in ("ball", "cap"):
            make = parts.ball if kind == "ball" else parts.cap
            tall = {} if kind == "ball" else {"height": h}
            part = make(diameter=2 * r, **tall, **(up if kind == "cap" else {}), density=1.0)
            of = turned(0, h, lambda z: (round_(z), 0 * z))
        else:
            part = parts.shell(diameter=2 * r, **({} if whole else {"height": h}), **up, density=1.0)
            # of a sphere, slices of the same height have the same area
            of = turned(0, h, lambda z: (round_(z), r / np.maximum(round_(z), 1e-300)), thin=True)
    return part, np.asarray(outline, float), of


def placed(part, low):
    """The part with its lowest point at this height."""
    return part if low is None else part.__class__(**{**part.__dict__, "at": float(low)})


def stacked(rng):
    """Parts on each other or inside each other, and what they are together, from first principles."""
    chosen, outlines, masses, top = [], [], [], 0.0
    for k in range(int(rng.integers(1, 5))):
        kind = str(rng.choice(["cylinder", "cone", "ball", "cap", "wall", "disk", "shell", "ring"]))
        part, outline, of = profile(kind, rng, float(rng.choice([0.02, 0.05])))
        # whether the part below has a hole, into which this one may fit
        hollow = k and np.min(chosen[-1][1][:, 0]) > 1e-9
        low = None if (k and rng.random() < 0.5 and not hollow) else float(rng.uniform(0, 0.05)) if k else 0.0
        at = top if low is None else low
        chosen.append((placed(part, low), outline))
        outlines.append(outline + np.array([0.0, at]))
        masses.append((of[0], of[1] + at, *of[2:]))
        top = at + float(outline[:, 1].max() - min(0.0, outline[:, 1].min()))
    mass = sum(x[0] for x in masses)
    centre = sum(x[0] * x[1] for x in masses) / mass
    across = sum(x[2] + x[0] * (x[1] - centre) ** 2 for x in masses)
    along = sum(x[3] for x in masses)
    return [x for x, _ in chosen], np.concatenate(outlines) - [0.0, centre], (mass, across, along)


def depth(outline, body, theta):
    """How far the lowest point of a profile (in R, from the centre of mass) is below the rim of the body."""
    s, c, f = np.sin(theta), np.cos(theta), float(body.fillet)
    points = outline[:, :1] * s - outline[:, 1:] * c  # (points, thetas)
    return points.max(axis=0) - (float(body.ell) * c + (1 - f) * s + f)


def assembled(rng, index, found):
    """A body of random parts: mass and moments, where it stands, and which part lands when; and how it moves."""
    made, outline, (mass, across, along) = stacked(rng)
    body = sc.assembled(made)
    size = body.scale.radius
    for name, mine, theirs in (
        ("mass", mass, body.scale.mass),
        ("i1", across / (mass * size**2), float(body.i1)),
        ("i3", along / (mass * size**2), float(body.i3)),
    ):
        if abs(mine - theirs) > 1e-8 * mine:
            found.wrong("answer", f"{name} = {theirs:.9g}, by quadrature {mine:.9g}: {made}")
    end, outline = reach(body), outline / size
    grid = np.linspace(1e-3, end - 1e-3, 200)
    for theta, deep in zip(grid, depth(outline, body, grid), strict=True):
        if deep > DEEP:
            found.wrong("answer", f"{deep:.2e} R below the table at theta = {theta:.4f} < {end:.4f}: {made}")
            break
        if deep < -DEEP:
            found.wrong("answer", f"stands on nothing at theta = {theta:.4f}, by {-deep:.2e} R: {made}")
            break
    after = np.linspace(end, min(end + 0.02, np.pi), 9)[1:]
    if end < np.pi - 0.02 and not (np.abs(depth(outline, body, after)) > 1e-9).any():
        found.wrong("answer", f"theta_end = {end:.6f}, but it stands as before beyond it: {made}")
    how = {"contact": contact(rng)}
    slip = None if isinstance(how["contact"], str) else tuple(map(float, rng.normal(size=2)))
    state = sc.State(tilted(rng, body.natural), *map(float, rng.normal(size=3)), slip=slip)
    judged(body.natural, state, times(5.0), how, found, sweeps=index % 4 == 0)


def film(rng, _, found):
    """A film from above of a steady tube, with noise, jittered times and lost frames, also of aliasing rates."""
    wide = float(rng.uniform(0.008, 0.04))
    long = wide * float(rng.uniform(2.0, 8.0))
    tube = sc.measured(outer_diameter=wide, length=long, wall=wide * float(rng.uniform(0.03, 0.3)))
    hertz = math.nan
    while not hertz > 0:
        theta = float(rng.uniform(0.3, 1.52))
        hertz = float(tube.hertz(theta))
    fps = float(rng.choice([30.0, 30.0, 24.0, 60.0, 120.0, 240.0]))
    t = np.arange(int(rng.integers(20, 200))) / fps + float(rng.choice([0.0, 100.0]))
    real = t + (rng.uniform(-0.1, 0.1, t.size) / fps if rng.random() < 0.3 else 0.0)
    kept = rng.random(t.size) > (rng.uniform(0.0, 0.3) if rng.random() < 0.4 else 0.0)
    noise, sense = float(rng.uniform(5e-5, 5e-4)), rng.choice([-1, 1])
    phi, arm = 2 * np.pi * hertz * real * sense + rng.uniform(0, 6), long / 2 * np.sin(theta)
    ends = {}
    for name, sign in (("O", 1), ("X", -1)):
        x, y = sign * arm * np.cos(phi), sign * arm * np.sin(phi)
        ends[name] = {"t": t[kept], "x": (x + noise * rng.normal(size=t.size))[kept]}
        ends[name]["y"] = (y + noise * rng.normal(size=t.size))[kept]
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        seen = sc.data.from_above(ends, tube)
    found.note("warned" if said else "silent")
    if said:
        return
    where = f"true {hertz:.5g} Hz at {np.degrees(theta):.2f} degrees, {fps:g} frames a second: {seen!r}"
    if abs(seen.hertz - hertz) > SURE * seen.hertz_err + 1e-9:
        found.wrong("answer", f"hertz {where}")
    elif abs(seen.theta - theta) > SURE * seen.theta_err + 1e-9:
        found.wrong("answer", f"theta {where}")


def spun_down(rng, never=("Drilling",)):
    """A measured disk, a law that slows it down but those named `never`, and the drift."""
    wide = float(rng.uniform(0.02, 0.08))
    disk = sc.measured(outer_diameter=wide, length=wide * float(rng.uniform(0.05, 0.3)), mass=0.05)
    law = LAWS[str(rng.choice([x for x in LAWS if x not in never]))]
    centre = str(rng.choice(["rest", "rolling"]))
    theta = float(rng.uniform(0.15, 0.5))
    return disk, law, centre, sc.drift(disk.natural, theta, law(log_uniform(rng, 1e-5, 1e-3)), centre)


def fit(rng, _, found):
    """A spin-down with noise, fitted by the law that made it."""
    disk, law, centre, drift = spun_down(rng)
    begins = float(drift.theta(0.0))
    until = float(drift.time(begins * float(rng.uniform(0.2, 0.7))))
    t = np.sort(rng.uniform(0.0, until, int(rng.integers(10, 150))))
    t[0] = 0.0
    noise = log_uniform(rng, 1e-4, 0.02)
    theta = drift.theta(t) * (1 + noise * rng.normal(size=t.size))
    given = {"theta_err": noise * drift.theta(t)} if rng.random() < 0.5 else {}
    origin = float(rng.choice([0.0, 0.0, -5.0, 3.0, 1e3]))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        fitted = sc.data.fit_losses(t + origin, theta, body=disk.natural, laws=[law], centre=centre, **given)
    best = fitted.best
    found.note("warned" if said else "silent")
    true, error = float(drift.losses.coefficient), best.coefficient_err
    if abs(best.coefficient - true) > SURE * error + 1e-7 * true:
        off = (best.coefficient - true) / error if error > 0 else math.inf
        made = f"{law.__name__}, {t.size} points, noise {noise:.1e}, origin {origin:g}"
        found.wrong("answer", f"{made}: {off:.1f} errors off")


def stop(rng, _, found):
    """A coin stopped by a watch, fitted by the law that made it."""
    disk, law, centre, drift = spun_down(rng, ("Drilling", "AirLinear", "AirQuadratic"))
    ends = float(disk.scale.seconds(drift.stops_at))
    error = ends * log_uniform(rng, 1e-3, 0.1)
    seconds = np.abs(ends + error * rng.normal(size=int(rng.integers(2, 9))))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fitted = sc.data.fit_stop(disk, law, float(drift.theta(0.0)), seconds, error=error, centre=centre)
    best = fitted.of(centre)
    true = float(drift.losses.coefficient)
    # of first order in the error of the mean
    share = error / ends / math.sqrt(seconds.size)
    if abs(best.coefficient - true) > SURE * best.coefficient_err * (1 + SURE * share):
        found.wrong("answer", f"{law.__name__}: {best!r}, true {true:.6g}")


ANSWERS = {"parts": assembled, "films": film, "fits": fit, "stopwatch": stop}
