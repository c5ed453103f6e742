"""Speeds of two builds of the library, best of many runs: many motions, single ones, maps and drifts.

    python benches/beside.py OLDER NEWER                     ten minutes
    python benches/beside.py --scenes 20000 OLDER NEWER      compare the answers of both; a minute

OLDER and NEWER are folders with one build of `spincyl` each, as `pip install --target OLDER some.whl` makes
them. The builds run in turn, each in a process of its own and on one thread, so that other work on the
machine affects both. Prints the time of each, per motion or point, and their ratio.

With --scenes the builds compute random scenes of tests/scenes.py instead, each motion alone and all at once.
Prints how many motions have the same bits, how many end in another way, and how many differ by more than the
sum of both estimated errors, with their calls. The command fails if there are any of the last two kinds.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
import warnings
from functools import partial
from pathlib import Path

import numpy as np

#: Number of rounds of both builds, and least seconds of a case in each round.
ROUNDS, SECONDS = 5, 0.2
#: Number of motions in each random scene.
FAMILY = 20


def cases():
    """{name: (job, number of its motions or points)}."""
    from drawn_kinds import KINDS, at_once, drawn

    import spincyl as sc  # the build in PYTHONPATH
    from spincyl import loss, sweep

    rng = np.random.default_rng(5)
    count = 512
    ell = rng.uniform(0.05, 3.0, count)
    bodies = sc.Body.solid(ell)
    theta = rng.uniform(0.3, 1.3, count)
    w = rng.normal(0.0, 1.0, (3, count))
    wide = sc.State(theta, w[0], w[1], w[2])
    tube = sc.Body.tube(2.5, 0.9)
    near = sc.State(1.3, 0.7 + 1e-3 * rng.normal(size=count), 0.01 * rng.normal(size=count), 0.6)
    disk = sc.Body.solid(0.05)
    whirl = sc.State(0.15, 1.2 + 0.1 * rng.random(count), np.zeros(count), 0.1 * rng.random(count))
    slips = sc.State(theta, w[0], w[1], w[2], slip=(rng.normal(size=count), rng.normal(size=count)))
    rounded = sc.Body.solid(rng.uniform(0.3, 2.0, count), fillet=0.3)

    def alone(scenes, until):
        for scene in scenes:
            sc.roll(scene.body, scene.state, [0.0, until], tol=1e-8, **scene.how)

    def many(body, y, contact="rolling", **how):
        return lambda: sweep.roll(body, y, 10.0, contact=contact, **how), count

    def one(body, y, **how):
        return lambda: sc.roll(body, y, np.linspace(0.0, 20.0, 100), **how), 1

    cylinders = sc.Body.solid(np.linspace(0.5, 3.0, count))

    def swings(kick, tol, **how):
        """Swings of the width that belongs to a kick, as in docs/benchmarks.md."""
        kicked = cylinders.steady(np.full(count, 1.4)).kicked(kick)
        return lambda: sweep.roll(cylinders, kicked, 20.0, tol=tol, **how), count

    widths = {"narrow": 0.05, "wide": 0.4, "very wide": 0.8}
    told = {"": {"beyond": True}, ", may end": {}}
    all_swings = {
        f"swings: {name}, {tol:g}{may}": swings(kick, tol, **how)
        for name, kick in widths.items()
        for tol in (1e-6, 1e-10, 1e-12)
        for may, how in told.items()
    }

    starts = {
        "narrow": (sc.Body.solid(2.5), sc.State(1.3, 0.7, 0.01, 0.6)),
        "wide": (sc.Body.solid(1.0), sc.State(0.7, 1.1, 0.4, -0.8)),
    }
    stepped = {
        f"one: {name}, {kind} {size:g}": one(body, y, beyond=True, **{kind: size})
        for name, (body, y) in starts.items()
        for kind, sizes in (("tol", (1e-4, 1e-6, 1e-9, 1e-12)), ("step", (1e-2, 1e-3)))
        for size in sizes
    }
    stone = sc.Ellipsoid.rattleback((1.0, 0.15, 0.1), twist=np.radians(2.0))
    stones = sc.Ellipsoid.rattleback((1.0, 0.15, 0.1), twist=np.radians(np.linspace(0.5, 3.0, 64)))

    kinds = {}
    for kind in KINDS:
        scenes = [drawn(kind, k, 5, turn=1)[0] for k in range(32)]  # without losses, e = 0.5
        body, state, how = at_once(scenes)
        until = float(scenes[0].times[-1]) / 6
        kinds[f"{kind}: many"] = (partial(sweep.roll, body, state, until, tol=1e-8, **how), len(scenes))
        kinds[f"{kind}: one"] = (partial(alone, scenes[:8], until), 8)

    grid = np.linspace(0.01, 1.5, 1000)
    ells = np.linspace(0.05, 3.0, 100)
    return {
        **all_swings,
        **stepped,
        **kinds,
        "one: stone": one(stone, stone.spinning(-0.6, pitch=0.02)),
        "many: stones": (lambda: sweep.roll(stones, stones.spinning(-0.6, pitch=0.02), 10.0), 64),
        "many: near a steady state": many(tube, near),
        "many: exact, any": many(bodies, wide),
        "many: exact, beyond ends": many(bodies, wide, beyond=True),
        "many: rounded": many(rounded, wide),
        "many: smooth": many(bodies, wide, "smooth"),
        "many: RK4": many(tube, near, step=1e-2),
        "many: RK4, any": many(bodies, wide, step=1e-2),
        "many: rounded, may slip": many(rounded, wide, mu=0.5),
        "many: least force, any": many(bodies, wide, want="normal_min", beyond=True),
        "many: slips": many(bodies, slips, sc.Coulomb(0.3)),
        "many: air": many(disk, whirl, losses=loss.AirQuadratic(0.01)),
        "many: dry contour": many(disk, whirl, losses=loss.DryContour(0.005)),
        "many: viscous contour": many(disk, whirl, losses=loss.ViscousContour(0.01)),
        "many: rolling resistance": many(disk, whirl, losses=loss.RollingResistance(0.01)),
        "many: slips and loses": many(disk, slips, sc.Coulomb(0.3), losses=loss.AirFilm(0.01)),
        "one: exact": one(tube, sc.State(1.3, 0.7, 0.0, 0.6)),
        "one: poses": one(tube, sc.State(1.3, 0.7, 0.0, 0.6), want="pose"),
        "one: slips": one(tube, sc.State(1.0, 0.5, 0.0, 0.6, slip=(0.5, 0.2)), contact=sc.Coulomb(0.3)),
        "one: loses": one(disk, sc.State(0.15, 1.2, 0.0, 0.0), losses=loss.AirQuadratic(0.01)),
        "map: rates": (lambda: tube.rate(grid), len(grid)),
        "map: all": (lambda: sweep.portrait(grid, ells), len(ells) * len(grid)),
        "map: rounded": (lambda: sweep.portrait(grid, ells, fillet=0.3), len(ells) * len(grid)),
        "survey": (lambda: sweep.survey([0.5, 1.0], ell), count),
        "boundaries": (lambda: sweep.boundaries(ell), count),
        "drift: at rest": (lambda: sc.drift(disk, theta, loss.AirQuadratic(0.01)), count),
        "drift: rolling": (lambda: sc.drift(disk, theta, loss.AirQuadratic(0.01), "rolling"), count),
    }


def measured():
    """Least seconds of each case in this process, per motion or point."""
    best = {}
    for name, (work, count) in cases().items():
        try:
            work()
            times, since = [], time.perf_counter()
            while len(times) < 3 or time.perf_counter() - since < SECONDS:
                began = time.perf_counter()
                work()
                times.append(time.perf_counter() - began)
            best[name] = min(times) / count
        except (TypeError, AttributeError, ValueError) as error:
            print(f"{name}: {error}", file=sys.stderr)
    return best


def answered(count):
    """Status, estimated error, end, states and call of every motion of random scenes, alone and at once."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
    import scenes
    from limit import Late, limit

    warnings.simplefilter("ignore")
    rows, calls = [], []
    for family in range(count // FAMILY):
        scene = scenes.draw(np.random.default_rng([1, family]), FAMILY)
        try:
            with limit(60):
                data = scenes.at_once(scene)
            ends = np.stack([data[x] for x in ("status", "error", "end")], axis=1)
            together = [(*ends[i], *np.atleast_2d(scenes.states_of(data, i))[-1]) for i in range(FAMILY)]
        except Late:
            together = [(-2.0, *[np.nan] * 6)] * FAMILY
        for i, row in enumerate(together):
            try:
                with limit(60):
                    m = scenes.alone(scene, i)
                single = (m.status, m.error, m.end, *m.last)
            except ValueError:
                single = (-1.0, *[np.nan] * 6)
            except Late:
                single = (-2.0, *[np.nan] * 6)
            rows += [row, single]
            calls += [f"at once: {scene.call(i)}", f"alone: {scene.call(i)}"]
    return np.array(rows, float), calls


def compare(folders, count):
    """Compare the answers of two builds; true if they agree."""
    with tempfile.TemporaryDirectory() as made:
        jobs = []
        for k, folder in enumerate(folders):
            words = [sys.executable, __file__, "--work", "--scenes", str(count), f"{made}/{k}.npz"]
            jobs.append(subprocess.Popen(words, env=os.environ | {"PYTHONPATH": folder}))
        if any([job.wait() for job in jobs]):
            raise RuntimeError("a build did not answer")
        older, newer = (np.load(f"{made}/{k}.npz") for k in range(2))
        a, b, calls = older["rows"], newer["rows"], newer["calls"]
    same = np.array([x.tobytes() == y.tobytes() for x, y in zip(a, b, strict=True)])
    ends = a[:, 0] != b[:, 0]
    off = np.nan_to_num(np.abs(a[:, 2:] - b[:, 2:])).max(axis=1)
    beyond = ~ends & (off > np.nan_to_num(a[:, 1] + b[:, 1], nan=np.inf))
    print(f"{len(a)} answers: {same.sum()} with the same bits, {ends.sum()} end in another way, ", end="")
    print(f"{beyond.sum()} differ by more than both claims")
    for i in np.flatnonzero(ends | beyond)[:30]:
        print(
            f"status {a[i, 0]:g} and {b[i, 0]:g}, apart {off[i]:.1e}, {a[i, 1]:.1e} and {b[i, 1]:.1e} claimed"
        )
        print(f"    {calls[i]}")
    return not (ends | beyond).any()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "folders", nargs="*", metavar="FOLDER", help="two folders, each with a build: OLDER NEWER"
    )
    parser.add_argument(
        "--scenes", type=int, default=0, help="compare the answers for this number of random motions"
    )
    parser.add_argument("--work", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.work and given.scenes:
        rows, calls = answered(given.scenes)
        np.savez(given.folders[0], rows=rows, calls=calls)
        return
    if given.scenes:
        sys.exit(not compare(given.folders, given.scenes))
    if given.work:
        print(json.dumps(measured()))
        return
    best = [{} for _ in given.folders]
    for _ in range(ROUNDS):
        for folder, found in zip(given.folders, best, strict=True):
            env = os.environ | {"PYTHONPATH": folder, "RAYON_NUM_THREADS": "1"}
            words = [sys.executable, __file__, "--work"]
            for name, seconds in json.loads(subprocess.check_output(words, env=env)).items():
                found[name] = min(found.get(name, np.inf), seconds)
    for name in best[0]:
        times = [found.get(name, np.nan) for found in best]
        print(f"{name:28}" + "".join(f"{t * 1e6:12.4f} us" for t in times) + f"{times[-1] / times[0]:9.3f}")


if __name__ == "__main__":
    main()
