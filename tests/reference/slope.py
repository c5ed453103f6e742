"""Writes slope.json: motions on a table that is tilted, or turns, the reference of their tests.

    python tests/reference/slope.py [name ...]      those whose names begin so; or all

It needs gmpy2.

Every motion is made from two formulations: of slope_vectors.py, in three dimensions, and slope_forms.py, reduced.
They share the laws of friction and loss, the series of series.py, and the order of the phases, which is that of
flights.py, lying.py and phases.py.

The slope is in radians, x points downhill, z is the normal of the table, which turns at `turning` about it; g is
the full gravity. `phi` is the heading of the start and `place` its contact. Rows are those of flights.json
(`kind` of the motion: rim), lying.json and stones.json; `lost` is what impacts and losses took.

A stone begins turned by the smallest rotation from upright, its centre of mass above the origin.

Inputs are exact doubles; results are decimal, to 25 digits. `agreement` is the largest difference of both
formulations in all numbers of a motion, over 1 or the number if that is more.
"""

import math
import pathlib
import time

import flights
import gmpy2
import lying
import phases
import slope_forms
import slope_vectors
import stones
from flights import HALF_PI
from series import precise
from tables import compared, decimal, renew_json
from torus import rounded, tube

HERE = pathlib.Path(__file__).parent
DIGITS = 50
WAYS = {
    "rim": (flights.follow, slope_vectors.Vectors, slope_forms.Reduced, flights.NAMES, (11, 12)),
    "lying": (lying.follow, slope_vectors.Lying, slope_forms.Lying, lying.NAMES, (11, 12)),
    "stone": (phases.follow, slope_vectors.Stone, slope_forms.Stone, stones.COLUMNS[1:], ()),
}

# The scenes.


def tilted(kind, scene, slope, phi=0.0, place=(0.0, 0.0), turning=0.0, losses=None):
    """A scene of flights.py, lying.py or stones.py on such a table."""
    scene.kind, scene.slope, scene.turning, scene.phi = kind, float(slope), float(turning), float(phi)
    scene.place, scene.losses = [float(x) for x in place], losses or {}
    return scene


def rim(name, body, slope, start, end, mu=0.0, e=0.0, beyond=False, law="coulomb", samples=4, **more):
    """A body on one rim, or in the air; `beyond` if its other rim is not there."""
    table = {key: more.pop(key) for key in ("phi", "place", "turning", "losses") if key in more}
    scene = flights.Scene(name, body, mu, e, (*start, 0, 0)[:6], end, law=law, samples=samples, **more)
    scene.side = scene.side and not beyond
    scene.beyond = beyond
    return tilted("rim", scene, slope, **table)


def lies(name, body, slope, mu, rates, velocity, phi, end):
    """A body on both rims, from its w1 and w3 and the velocity of its centre along the lean and across."""
    (w1, w3), (along, across) = rates, velocity
    start = HALF_PI, w1, 0, w3, along, across + body[0] * w1 - w3
    scene = lying.Scene(name, body, mu, start, end, samples=4)
    scene.side = False
    return tilted("lying", scene, slope, phi)


def stone(name, body, slope, law, n, w, end, **more):
    """An ellipsoid."""
    return tilted("stone", stones.Scene(name, body, law, n, w, end, samples=4, **more), slope)


def scenes():
    paper, disk, can, solid = tube(6.0, 0.8), tube(0.1, 0.0), tube(0.5, 0.0), tube(1.0, 0.0)
    ball, low = (0.0, 0.4, 0.4, 1.0), (-0.2, 0.39, 0.4, 1.0)
    rolls = {"law": "rolling"}
    kicked = (1.2, 0.5, 0, 1.5)

    yield rim("disk rolls", disk, 0.2, kicked, 5, phi=0.4, **rolls)
    s, c = math.sin(1.45), math.cos(1.45)
    turn = math.sqrt(math.cos(0.05) * (c - 6 * s) / ((paper[1] * c - 6 * paper[2] * s) * s))
    yield rim("tube spins and rolls", paper, 0.05, (1.45, turn * s, 0.05, 6 * turn * s), 12, phi=0.7, **rolls)
    yield rim("rounded rim rolls", rounded(0.6, 0.2), 0.3, (0.9, 0.8, 0.2, 0.6), 3, phi=-1.1, **rolls)
    top = (0.5, 1, 0.3, 1.5, 0.3, 0.2)
    yield rim("ball with a low centre", low, 0.3, top, 5, 0.3, phi=0.3)
    yield rim("ball thrown across", ball, 0.3, (1.2, 0, 0, 0, 0, 1), 2, 0.25)
    slides = (1.2, 0.4, 0.1, -1, 0.2, 0.3)
    yield rim("disk slips and rolls", disk, 0.25, slides, 3, 0.3, phi=0.9)
    nutates = (0.6, 1.2, 0.4, 0.3, 0.1, -0.2)
    yield rim("can slips again", can, 0.1, nutates, 3, 0.3, phi=0.5)
    yield rim("can with static friction", can, 0.1, nutates, 2.4, 0.3, phi=0.5, static=0.35)
    yield rim("disk on a film", disk, 0.2, slides, 2.4, 0.8, phi=2.0, law="viscous")
    yield rim("disk let go on a steep slope", disk, 0.6, (1.2, 0, 0, 0), 1.5, 0.2, phi=0.8)
    couples = {"rolling": 0.01, "viscous": 0.02}
    yield rim("disk rolls with losses", disk, 0.1, kicked, 4, phi=0.4, losses=couples, **rolls)
    yield rim("top on a smooth table", (0.3, 0.5, 0.4, 0.2), 0.4, (0.4, 1, 0.3, 3, 0.2, 0.1), 4, phi=1.0)
    hops = (1.569, 2.5, 0, 9, 0, 6 - 12.41 * 2.5 / 6)
    yield rim("tube hops", paper, 0.15, hops, 4.6, 0.3, phi=-1.0)
    yield rim("tube hops and bounces", paper, 0.15, hops, 5.2, 0.3, 0.5, phi=-1.0)
    dropped = (0.6, 0.5, -0.3, 0.8, 0.4, -0.3)
    yield rim("cylinder dropped", solid, 0.35, dropped, 4.45, 0.2, 0.6, phi=0.6, height=0.5, lift=0.2)
    yield lies("both rims stop at once", tube(2.0, 0.0), 0.2, 0.3, (0.2, 0.4), (0.5, 1.5), -0.8, 9)
    yield lies("cylinder pivots", tube(1.2, 0.0), 0.45, 0.35, (0.3, 0.2), (0.2, -0.4), 0.7, 4)
    thrown = {"n": (0.1, -0.05, 1), "w": (0.1, 0.2, -0.3)}
    yield stone("stone rolls", stones.ODD, 0.2, "rolling", (0.3, -0.2, 0.9), (0.2, 0.1, 0.5), 6)
    yield stone("stone slips", stones.ODD, 0.2, "coulomb", **thrown, end=1.2, mu=0.3, u=(0.3, -0.1))
    where = {"place": (1.5, 0), "turning": 0.5}
    past = (1.3, 0.4, 0.1, -1.2)
    yield rim("disk past its side on a turntable", disk, 0, past, 5, beyond=True, **where, **rolls)
    yield rim("disk rolls on a turntable", disk, 0, (1.2, 0.5, 0, -2.5), 4, phi=0.3, **where, **rolls)
    tilted_turn = {"place": (1.0, 0.5), "turning": 0.8}
    yield rim(
        "ball on a tilted turntable", ball, 0.1, (1.0, 0.6, 0.2, -0.5), 6, phi=0.7, **tilted_turn, **rolls
    )
    yield rim("disk slips on a turntable", disk, 0.1, slides, 3, 0.3, phi=0.9, **where)
    losing = {"rolling": 0.01, "viscous": 0.02}
    yield rim(
        "disk rolls with losses on a turntable",
        disk,
        0.1,
        (1.2, 0.5, 0, -2.5),
        3,
        phi=0.3,
        losses=losing,
        **where,
        **rolls,
    )
    below = {"place": (0.8, -0.6), "turning": -0.7, "phi": 0.6}
    yield rim("tube hops on a turntable", paper, 0, hops, 3, 0.3, 0.5, **below)
    yield rim(
        "cylinder dropped on a turntable", solid, 0, dropped, 4.2, 0.2, 0.6, height=0.5, lift=0.2, **below
    )
    yield rim(
        "cylinder dropped on a tilted turntable",
        solid,
        0.35,
        dropped,
        3.6,
        0.2,
        0.6,
        height=0.5,
        lift=0.2,
        **below,
    )
    yield rim(
        "ball dropped on a turntable", low, 0, (1.2, 0.5, 0.2, 1, 0.3, 0.1), 4, 0.2, 0.7, height=0.4, **below
    )


# The table.


def made(scene):
    follow, vectors, reduced, _, angles = WAYS[scene.kind]
    found = []
    for make in (vectors, reduced):
        begun, model = time.time(), make(scene)
        flights.SLOWEST.setdefault(make.__name__, flights.SLOWEST["Closed"])
        found.append(follow(model))
        print(f"{scene.name}: {make.__name__}, {found[-1].steps} steps, {time.time() - begun:.0f} s")
    one, other = found
    print(f"    constraints kept to {float(one.strayed):.1e}", flush=True)
    agreement = max(compared(one, other, angles))
    hits = [getattr(out, "impacts", []) for out in found]
    for a, b in zip(*hits, strict=True):
        assert a[1:3] == b[1:3]
        numbers = [(x, y) for x, y in zip(a, b, strict=True) if not isinstance(x, str)]
        agreement = max([agreement, *(abs(x - y) / max(1, abs(y)) for x, y in numbers)])
    rows = [
        [kind, *(None if gmpy2.is_nan(x) else decimal(x, 1e-28) for x in row)] for kind, row in other.rows
    ]
    told = {"name": scene.name, "kind": scene.kind, "slope": scene.slope, "turning": scene.turning}
    told |= {"law": scene.law, "mu": scene.mu, "losses": scene.losses}
    told["static"] = scene.static if math.isfinite(scene.static) else None
    if scene.kind == "stone":
        told |= {name: getattr(scene, name) for name in ("axes", "inertia", "offset", "n", "w", "u")}
    else:
        told |= {name: getattr(scene, name) for name in ("body", "start", "phi", "place")}
    if scene.kind == "rim":
        told |= {"restitution": scene.restitution, "beyond": scene.beyond}
        told["aloft"] = [scene.height, scene.lift] if scene.aloft else None
        told["impacts"] = [[decimal(hit[0]), *hit[1:3]] for hit in hits[1]]
    told["agreement"] = float(f"{float(agreement):.1e}")
    return told | {"rows": rows}


def main():
    precise(DIGITS)
    columns = {kind: ["kind", *way[3]] for kind, way in WAYS.items()}
    renew_json(HERE / "slope.json", scenes(), made, "motions", columns=columns)


if __name__ == "__main__":
    main()
