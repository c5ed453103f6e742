"""Beside MuJoCo: a cup and a cone that roll round their apex, for the page on contact engines.

    pip install 'spincyl[engine]'
    python benches/cups.py [--docs docs/engines.md]

A cup (R = 35 mm, 25 mm and 90 mm high, 7 g, solid) and a cone (R = 35 mm, 70 mm high) roll once round their apex with
0.8 of the rate at which the narrow end rises. In MuJoCo each is a mesh, the convex hull of 64 or 512 points on each
circle, or the circles of the MJCF file of the scene. The table has the radius of the circle of the centre, fitted to
one turn, the time of the turn, and the spread of the inclination, each beside that of the geometry of the body. The
last column is the least rate, in units of the true one, at which the narrow end is 1 degree above the table within
half a turn: a search with steps of 0.025.
"""

import re
from itertools import count

import mujoco
import numpy as np
import page_table

import spincyl as sc

MARK = "<!-- written by benches/cups.py -->\n\n"
BODIES = {
    "cup": sc.Body.frustum("25mm", "35mm", "90mm").in_metres("7g"),
    "cone": sc.Body.cone(2.0).in_metres("7g", radius="35mm"),
}
FRICTION = 2.0


def scene_of(body, rate):
    """A scene of a body that rolls once round its apex, with this precession in sqrt(g/R)."""
    s, c = np.sin(body.theta_end), np.cos(body.theta_end)
    start = sc.State(body.theta_end, s * rate, 0.0, -s * s / c * rate)
    t = body.scale.seconds(np.linspace(0, 2 * np.pi / rate, 101))
    return sc.scene(sc.roll(body, start, t, contact=sc.Coulomb(FRICTION), restitution=0.0))


def as_mesh(text, body, points):
    """The model with a mesh, of so many points on each circle, in place of the circles."""
    angle = 2 * np.pi * np.arange(points) / points
    metre = body.scale.radius
    rings = [
        np.column_stack([r * np.cos(angle), r * np.sin(angle), z + 0 * angle]) for r, z, _ in body.circles
    ]
    corners = " ".join(f"{x:.9g}" for x in metre * np.concatenate(rings).ravel())
    (touch,) = {
        re.search(r"friction=.*?(?=/>)", x).group() for x in re.findall(r'<geom name="circle.*?/>', text)
    }
    text = re.sub(r'\s*<geom name="circle.*?/>', "", text)
    text = re.sub(r'<geom name="looks".*?/>', f'<geom name="hull" type="mesh" mesh="looks" {touch}/>', text)
    return re.sub(r'vertex=".*?"', f'vertex="{corners}"', text)


def run(model, until):
    """Times, centres and inclinations of a body in MuJoCo, up to this time or until `until` is true."""
    state = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, state, 0)
    rows = []
    for _ in count():
        axis = state.qpos[3:7]
        lean = np.arccos(1 - 2 * (axis[1] ** 2 + axis[2] ** 2))
        rows.append([state.time, *state.qpos[:3], lean])
        if until(rows):
            return np.array(rows)
        mujoco.mj_step(model, state)


def turned(rows):
    """How far the direction of motion of the centre has turned, in radians."""
    x = rows[:, 1:3]
    step = max(1, len(x) // 400)
    way = np.diff(x[::step], axis=0)
    return np.unwrap(np.arctan2(way[:, 1], way[:, 0])), rows[::step, 0][:-1]


def circle_through(x):
    """Radius of the circle fitted to points."""
    found = np.linalg.lstsq(np.column_stack([2 * x, np.ones(len(x))]), (x**2).sum(1), rcond=None)[0]
    return np.sqrt(found[2] + found[0] ** 2 + found[1] ** 2)


def rises_at(body, make):
    """The least rate at which the narrow end rises, as a share of the true one."""
    for share in np.arange(0.6, 1.5, 0.025):
        rate = share * body.apex().rate
        model = mujoco.MjModel.from_xml_string(make(scene_of(body, rate).mjcf))
        half = float(body.scale.seconds(np.pi / rate))
        rows = run(
            model, lambda rows, half=half: rows[-1][0] > half or abs(rows[-1][4] - rows[0][4]) > np.radians(1)
        )
        if abs(rows[-1, 4] - rows[0, 4]) > np.radians(1):
            return f"{share:.3f}"
    return "above 1.5"


def table():
    """Rows of the table."""
    head = [
        "body",
        "shape in MuJoCo (MJCF: the model file that spincyl writes)",
        "radius of the circle in MuJoCo",
        "exact radius",
        "time of a turn in MuJoCo",
        "exact time of a turn",
        "variation of the inclination in MuJoCo (largest minus smallest)",
        "precession at which the narrow end rises in MuJoCo, over its exact value",
    ]
    yield head
    yield ["---"] * len(head)
    for name, body in BODIES.items():
        apex = body.apex()
        rate = 0.8 * apex.rate
        scene = scene_of(body, rate)
        true = float(body.scale.seconds(2 * np.pi / rate)), 1e3 * body.scale.radius * apex.radius
        ways = {
            f"mesh of {n} points for each circle": lambda x, n=n, of=body: as_mesh(x, of, n)
            for n in (64, 512)
        }
        ways["circles of the MJCF file"] = lambda x: x
        for way, make in ways.items():
            model = mujoco.MjModel.from_xml_string(make(scene.mjcf))
            rows = run(model, lambda rows, end=true[0]: rows[-1][0] > end)
            radius = 1e3 * circle_through(rows[:, 1:3])
            angle, t = turned(rows)
            period = 2 * np.pi / abs(np.polyfit(t, angle, 1)[0])
            spread = np.degrees(np.ptp(rows[:, 4]))
            yield [
                name,
                way,
                f"{radius:.1f} mm",
                f"{true[1]:.1f} mm",
                f"{period:.3f} s",
                f"{true[0]:.3f} s",
                f"{spread:.2g} degrees",
                rises_at(body, make),
            ]


if __name__ == "__main__":
    page_table.main(__doc__, MARK, table)
