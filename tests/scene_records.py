"""Scenes as Python writes them, for the tests of both languages: of every kind, and random ones.

    python tests/scene_records.py        writes tests/laws/scenes.json anew

A record has the file of a scene at a few times, and the sums by which the tests know its models for MuJoCo and URDF: the
hash of Fowler, Noll and Vo (FNV-1a, 64 bits) of the text.
"""

import json
import sys
import warnings
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
for name in ("tests", "benches", "examples"):
    sys.path.append(str(ROOT / name))

import spincyl as sc  # noqa: E402

PATH = ROOT / "tests" / "laws" / "scenes.json"
#: Scenes of tests/engine_scenes.py, one for each way in which a file can differ.
NAMED = (
    "cylinder", "tube", "rounded can", "capsule", "Hurricane balls", "tippe top", "disk", "torus",
    "cup on its upper rim", "ball on its smaller one", "rattleback", "on ice", "stone on ice",
    "from slip to roll", "viscous film", "patch", "egg", "rounded cup slips", "slip and losses", "air film",
    "boundary layer", "hops in air", "dropped coin", "dropped on ice", "dropped bottle", "lies",
)  # fmt: skip
#: The number of random scenes of each kind of benches/random_scenes.py, and the number of times of each scene.
RANDOM, TIMES = 1, 3


def hashed(text):
    """The hash FNV-1a of a text, as hexadecimal digits."""
    found = 0xCBF29CE484222325
    for byte in text.encode():
        found = (found ^ byte) * 0x100000001B3 % 2**64
    return f"{found:016x}"


def slopes():
    """Bodies and a stone on a slope, two of them elsewhere and in another direction, and a puck on its face."""
    can, down = sc.Body.solid(1.5), sc.Table(0.1, phi0=0.7, place=(2.0, -1.0))
    table = sc.Table(0.0, phi0=-2.0, place=(0.5, 0.3))
    start = sc.State(0.8, 0.3, 0.1, 0.4)
    stone = sc.Ellipsoid.rattleback((1.0, 0.2, 0.17), twist=0.05)
    puck, law = sc.Body.solid(0.4), sc.Coulomb(0.2, face="disc")
    times = np.linspace(0.0, 1.0, TIMES)
    yield "on a slope", sc.roll(can, start, times, table=down)
    yield "on a slope of ice", sc.roll(can, start, times, table=down, contact="smooth")
    yield "elsewhere", sc.roll(can, start, times, table=table, contact=sc.Coulomb(0.1), restitution=0.4)
    yield "stone on a slope", sc.roll(stone, stone.spinning(0.5, pitch=0.2), times, table=down)
    yield "puck", sc.roll(puck, sc.State(0.0, 0.0, 0.0, 2.0), times, contact=law, restitution=0.0)


def scenes():
    """Names and scenes."""
    import engine_scenes
    from drawn_motions import MOTIONS
    from random_scenes import generator

    for name in NAMED:
        known = engine_scenes.scene_of(name)
        t = np.linspace(0.0, known.motion.t[-1], TIMES)
        yield name, sc.scene(known.motion.at(t), scale=known.scale)
    for name, m in slopes():
        yield name, sc.scene(m)
    for kind, draw in MOTIONS.items():
        made, index = 0, 0
        while made < RANDOM:
            body, state, times, how = draw(generator(71, kind, index), index)
            index += 1
            try:
                m = sc.roll(body, state, np.linspace(0.0, times[-1] / 4, TIMES), **how)
                known = sc.scene(m)
            except ValueError:
                continue
            # a motion whose places are unknown holds nothing to each other
            if known.data["error"]["position"] < 1e-6:
                yield f"{kind}:{index - 1}", known
                made += 1


def record(scene):
    """The file of a scene, and the hashes of its models."""
    try:
        urdf = hashed(scene.urdf)
    except ValueError:
        urdf = None
    return {"file": scene.data, "mjcf": hashed(scene.mjcf), "urdf": urdf}


def main():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = {name: record(scene) for name, scene in scenes()}
    lines = (f"{json.dumps(name)}: {json.dumps(x, allow_nan=False)}" for name, x in found.items())
    PATH.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    print(f"{len(found)} scenes, {PATH.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
