"""glTF 2.0: the bodies as meshes, their poses as an animation, in one binary file.

Source: Khronos Group, glTF 2.0 Specification (2021), sections 3.6 (accessors), 3.11 (animations), 4 (GLB).
"""

import json
import struct
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from spincyl._input.numbers import Floats
from spincyl._motion import Motion
from spincyl._scale import Scale
from spincyl.studio.aloft import goes_up
from spincyl.studio.poses import knots, repeats, seen
from spincyl.studio.shape import Letter, parts
from spincyl.studio.shape import reach as farthest

_FLOAT, _UNSIGNED = 5126, 5125
_MOST = 1_000_000


def glb(motions: Sequence[Motion], labels: Sequence[str], scale: Scale | None, upper: Letter) -> bytes:
    """The bytes of the glTF file; between two frames a body turns by at most a quarter of a radian."""
    metre, second = (1.0, 1.0) if scale is None else (scale.metres(1.0), scale.seconds(1.0))
    views: list[dict[str, Any]] = []
    accessors: list[dict[str, Any]] = []
    chunks: list[bytes] = []

    def accessor(values: Any, kind: str, component: int, target: int | None = None) -> int:
        data = np.ascontiguousarray(values, "<f4" if component == _FLOAT else "<u4")
        views.append({"buffer": 0, "byteOffset": sum(map(len, chunks)), "byteLength": data.nbytes})
        if target is not None:
            views[-1]["target"] = target
        chunks.append(data.tobytes())
        rows = data.reshape(len(data), -1)
        found = {"bufferView": len(views) - 1, "componentType": component, "count": len(data), "type": kind}
        accessors.append(found | {"min": rows.min(0).tolist(), "max": rows.max(0).tolist()})
        return len(accessors) - 1

    # the vertical is y in glTF
    upright = [-np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)]
    nodes: list[dict[str, Any]] = [
        {"name": "table", "rotation": upright, "scale": [metre] * 3, "children": []}
    ]
    meshes: list[dict[str, Any]] = []
    materials: list[dict[str, Any]] = []
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    beside = 0.0
    for m, label in zip(motions, labels, strict=True):
        primitives = []
        for part in parts(m.body, upper):
            colour = [c**2.2 for c in part.colour]  # to linear light
            look = {"baseColorFactor": [*colour, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.6}
            materials.append({"name": part.name, "pbrMetallicRoughness": look})
            primitive: dict[str, Any] = {"material": len(materials) - 1}
            primitive["attributes"] = {
                "POSITION": accessor(part.vertices, "VEC3", _FLOAT, 34962),
                "NORMAL": accessor(part.normals, "VEC3", _FLOAT, 34962),
            }
            primitive["indices"] = accessor(part.triangles.reshape(-1), "SCALAR", _UNSIGNED, 34963)
            primitives.append(primitive)
        meshes.append({"name": label or "body", "primitives": primitives})
        t, centre, orientation = _frames(m)
        reach = np.ptp(centre[:, 0]) / 2 + farthest(m.body)
        slope, aside = m._asked.slope, 0.0
        if len(motions) > 1:
            aside = beside + reach - (centre[:, 0].min() + centre[:, 0].max()) / 2
            centre = centre + np.array([0.0 if slope else aside, 0.0, 0.0])
            beside += 2 * reach + 1
        nodes.append(
            {
                "name": label or "body",
                "mesh": len(meshes) - 1,
                "translation": centre[0].tolist(),
                "rotation": orientation[0].tolist(),
            }
        )
        body = len(nodes) - 1
        if slope:  # the table is turned about y: x points downhill
            turned = [0.0, float(np.sin(slope / 2)), 0.0, float(np.cos(slope / 2))]
            place = [float(aside), 0.0, 0.0]
            nodes.append({"name": "slope", "translation": place, "rotation": turned, "children": [body]})
        nodes[0]["children"].append(len(nodes) - 1)
        seconds = ((t - t[0]) * second).astype("<f4")
        later = np.append(True, np.diff(seconds) > 0)  # in single precision, close times may coincide
        seconds, centre, orientation = seconds[later], centre[later], orientation[later]
        times = accessor(seconds, "SCALAR", _FLOAT)
        for path, kind, values in (("translation", "VEC3", centre), ("rotation", "VEC4", orientation)):
            samplers.append(
                {"input": times, "output": accessor(values, kind, _FLOAT), "interpolation": "LINEAR"}
            )
            channels.append({"sampler": len(samplers) - 1, "target": {"node": body, "path": path}})

    binary = b"".join(chunks)
    tree = {
        "asset": {"version": "2.0", "generator": "spincyl"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary)}],
        "animations": [{"name": "motion", "samplers": samplers, "channels": channels}],
    }
    text = json.dumps(tree, allow_nan=False, separators=(",", ":")).encode()
    # chunks have multiples of four bytes; the binary chunk consists of 4-byte numbers
    text += b" " * (-len(text) % 4)
    total = 12 + 8 + len(text) + 8 + len(binary)
    header = struct.pack("<4sII", b"glTF", 2, total)
    return (
        header
        + struct.pack("<I4s", len(text), b"JSON")
        + text
        + struct.pack("<I4s", len(binary), b"BIN\0")
        + binary
    )


def _frames(m: Motion) -> tuple[Floats, Floats, Floats]:
    """Ascending times, centres and orientations; signs of successive quaternions agree."""
    repeats(m)  # raises an error for motions that are too long
    coarse = knots(m)[:, 0]
    # between knots the motion is smooth, with about the rates at the knots: that of the body, and that of
    # the axis about the vertical, which may be larger
    w, theta = seen(m, coarse, "w", "theta")
    rates = np.linalg.norm(w, axis=1)
    if m._nods:
        rates = np.maximum(rates, np.abs(w[:, 0] / np.sin(theta)))
    count = np.ceil(4 * np.maximum(rates[1:], rates[:-1]) * np.diff(coarse)).astype(int) + 1
    if goes_up(m):  # straight lines between frames are within 0.002 R of the parabola of a fall
        count = np.maximum(count, np.ceil(8 * np.diff(coarse)).astype(int))
    if count.sum() > _MOST:
        raise ValueError(f"motion: {count.sum()} frames, expected at most {_MOST}; use a shorter time")
    pieces = [np.linspace(a, b, n, endpoint=False) for (a, b), n in zip(pairwise(coarse), count, strict=True)]
    t = np.append(np.concatenate(pieces), coarse[-1])
    centre, orientation = seen(m, t, "centre", "orientation")
    turned = np.cumprod(np.where((orientation[1:] * orientation[:-1]).sum(1) < 0, -1.0, 1.0))
    orientation[1:] *= turned[:, np.newaxis]
    return t, centre, orientation
