"""Compares many motions at once, `sc.sweep.roll`, with each of them alone, `sc.roll`, on random scenes.

    --seed N --family N                 one family again
    --grazing --count 5000 --seed 5     starts that only just meet an end or just miss it

100,000 motions take an hour and a half on one core. The scenes are those of tests/scenes.py: every contact,
law, rim, end and kind of start. Kinds of ends must be equal, and times, states and periods must agree within
the sum of both claims. Motions that violate this are printed with their calls. Rows are of contacts and of
laws: a motion with three laws counts in three of them.

Grazing starts: the straight line between two random starts of one body is halved until a place is found where
the kind of the end changes. The starts lie on both sides of this place, at 1e-7 to 1e-2 of the length of the
line, but never as near as the sum of both claims, within which either end is right. Half the bodies have a
theta_end of their own.
"""

import itertools
import math
import time

import numpy as np
import scenes
from judge import blocks
from limit import Late, limit

import spincyl as sc

DEFAULTS, FEW, HONEST = {"count": 2000, "show": 30}, "--count 1000", 2.0
LONGEST = 60  # CPU seconds after which a family counts as hanging
FAMILY, GRAZING = 20, 40
#: for every contact: each law alone, none, and several
LAWS = ([], *([k] for k in range(8)), [0, 3], [2, 4], [0, 1, 2, 3, 4, 5])
NAMES = [law.__name__ for law in scenes.LAWS]


def told(scene, starts):
    """The status of the motions of a scene from these starts."""
    body, state, how = scene._replace(starts=starts).asked(slice(None))
    t = float(scene.times[-1])
    return sc.sweep.roll(body, state, t, want="end", tol=scene.tol, threads=1, **how)["status"].to_numpy()


def grazing(rng, contact, laws, count):
    """A scene of starts that graze an end, the names of the ends on both sides, and the distances from the
    change; perhaps fewer than `count`."""
    many = 2 * count
    scene = scenes.draw(rng, many, contact, laws)
    ends = np.where(rng.random(many) < 0.5, np.pi / 2, rng.uniform(0.3, 1.5, many))
    ends = np.where(scene.bodies[:, 3] == 1.0, np.pi, ends)
    ends = np.where((scene.bodies[:, 0] == 0.0) & (ends == np.pi / 2), np.pi, ends)
    near = ends - scenes.log_uniform(rng, 1e-5, 0.3, many)
    scene = scene._replace(theta_end=ends, times=np.array([scenes.log_uniform(rng, 0.3, 10)]))
    if contact == "coulomb" and rng.random() < 0.5:
        scene = scene._replace(table=scene.table[:, :1] * np.array([1.0, 1.3]))
    both = []
    for _ in range(2):
        starts = scenes.draw_starts(rng, scene.bodies)
        theta = np.where(rng.random(many) < 0.5, near, starts[:, 0])
        starts[:, 0] = np.where(ends < 3, np.minimum(theta, near), theta)
        both.append(starts)
    way = both[1] - both[0]
    low, high = np.zeros(many), np.ones(many)
    first, last = told(scene, both[0]), told(scene, both[1])
    for _ in range(40):
        middle = (low + high) / 2
        found = told(scene, both[0] + middle[:, None] * way)
        low, high = np.where(found == first, middle, low), np.where(found == first, high, middle)
        last = np.where(found == first, last, found)
    some = np.flatnonzero((first != last) & (first != 5) & (last != 5))[: count // 2]
    far = scenes.log_uniform(rng, max(1e-7, 1e3 * scene.tol), 1e-2, some.size)
    sides = np.clip(np.concatenate([low[some] - far, high[some] + far]), 0, 1)
    twice = np.concatenate([some, some])
    scene = scene._replace(
        bodies=scene.bodies[twice],
        starts=both[0][twice] + sides[:, None] * way[twice],
        table=scene.table[twice],
        losses={k: x[twice] for k, x in scene.losses.items()},
        theta_end=ends[twice],
    )
    kinds = [
        f"{sc.sweep.Status(a).name} or {sc.sweep.Status(b).name}" for a, b in zip(first, last, strict=True)
    ]
    return scene, [kinds[i] for i in twice], np.concatenate([far, far]) * np.abs(way[twice]).max(axis=1)


def random(rng, family, contact):
    """A random scene, without the names of its ends; None if it has another contact."""
    scene = scenes.draw(rng, FAMILY)
    none = itertools.repeat(""), itertools.repeat(np.inf)
    return (scene, *none) if contact in (None, scene.contact) else None


def grazes(rng, family, contact):
    """A scene of starts that graze an end."""
    each = [(c, laws) for c in scenes.CONTACTS if contact in (None, c) for laws in LAWS]
    return grazing(rng, *each[family % len(each)], GRAZING)


def enter(tally, of, apart, doubt, line):
    """Adds a motion to the rows `of`."""
    refused, status = apart.status[1] < 0, apart.status[0]
    counts = {
        "motions": True,
        "differ": apart.kind and not doubt < 100 * sum(apart.claims),
        "vague, sweep": not apart.claims[0] <= 1e-6 and status not in (5, 6, 8),
        "vague, roll": not apart.claims[1] <= 1e-6 and not refused,
        "bounded": status == 8,
        "refused": refused and status not in (5, 6),
        "invalid": status in (5, 6),
    }
    for row in of:
        for word, n in counts.items():
            tally.count(row, word, n=n)
        tally.add(f"{row}{'' if row == 'all' else ', aside'}", apart.ratio, 1.0, line)
    if counts["differ"]:
        tally.tell("differ", line)


def options(add):
    add("--family", type=int, default=None, help="only this one")
    add("--contact", default=None, help="only this one")
    add("--grazing", action="store_true", help="starts that graze an end")


def judge(given, tally):
    draw, size = (grazes, GRAZING) if given.grazing else (random, FAMILY)
    for family, _ in blocks(given, size):
        if given.family in (None, family):
            compare(draw, family, given, tally)


def compare(draw, family, given, tally):
    """Adds one family to the tally."""
    since = time.process_time()
    try:
        with limit(LONGEST):
            drawn = draw(np.random.default_rng([given.seed, family]), family, given.contact)
            if drawn is None:
                return
            scene, kinds, doubts = drawn
            of = ["all", scene.contact, *([NAMES[k] for k in scene.losses] or ["no law"])]
            for i, (apart, kind, doubt) in enumerate(zip(scenes.compare(scene), kinds, doubts, strict=False)):
                tally.count("ends", kind, n=given.grazing)
                claims = "{:.1e} + {:.1e}".format(*apart.claims)
                says = f"status {apart.status}, {claims} claimed, tol={scene.tol:g} {kind}"
                enter(tally, of, apart, doubt, f"family {family}, motion {i}: {says}\n    {apart.call}")
            for i, (ratio, call) in enumerate(() if given.grazing else scenes.compare_periods(scene)):
                nothing = math.isnan(ratio)
                tally.add(
                    "periods", math.inf if nothing else ratio, 1.0, f"family {family}, period {i}\n    {call}"
                )
    except Late:
        tally.count("all", "late", f"family {family} takes more than {LONGEST} s")
    tally.took(time.process_time() - since, f"family {family}")
