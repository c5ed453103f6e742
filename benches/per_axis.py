"""A small contact engine whose friction is a cone, or a box with one limit for each axis, beside known answers.

    python benches/per_axis.py [--docs docs/engines.md]

The engine knows the JSON file of a scene alone. It is of the kind of most engines for games and robots: velocities after each
step such that the lowest point of the rim does not enter the table, with impulses by a few sweeps of Gauss and Seidel. The
cone limits the size of the friction, |F| <= mu N; the box limits each of its components along x and y, |F_x| <= mu N and
|F_y| <= mu N, as engines do in which friction is two constraints of their own.
"""

import numpy as np
import page_table
from scipy.spatial.transform import Rotation

import spincyl as sc

MARK = "<!-- written by benches/per_axis.py -->\n\n"
RATES = 1000, 4000, 16_000, 64_000
SWEEPS = 30
UP = np.array([0.0, 0.0, 1.0])


def scenes():
    """A coin that slips from a push to its rest in rolling, along an axis of the box and across it, and one that rolls."""
    coin = sc.measured(outer_diameter="25.75mm", length="2.2mm", mass=0.0085)
    steady, unit = coin.steady(0.9), coin.scale.seconds(1.0) / coin.scale.radius
    for name, (x, y) in {"along the x axis": (0.5, 0.0), "at 45 degrees to the x axis": (0.35, 0.35)}.items():
        start = coin.with_centre_velocity(steady, x * unit, y * unit)
        m = sc.roll(coin, start, np.linspace(0.0, 0.2, 101), contact=sc.Coulomb(0.2))
        yield f"coin that is pushed {name}", sc.scene(m)
    m = sc.roll(coin, steady.kicked(0.05), np.linspace(0.0, 0.2, 101))
    yield "coin that rolls and nutates", sc.scene(m)


def lowest(body, turned):
    """From the centre of mass to the lowest point of the rims."""
    axis = turned[:, 2]
    across = UP - axis[2] * axis
    down = -across / np.linalg.norm(across)
    points = (x["height"] * axis + x["radius"] * down for x in body["shape"]["circles"])
    return min(points, key=lambda r: r[2])


def crossed(r):
    return np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])


def impulse(k, u, mu, box):
    """The impulse that stops a point with this velocity, as far as friction allows."""
    push = np.zeros(3)
    for _ in range(SWEEPS):
        push[2] = max(0.0, push[2] - (u + k @ push)[2] / k[2, 2])
        most = mu * push[2]
        if box:
            for i in (0, 1):
                push[i] = np.clip(push[i] - (u + k @ push)[i] / k[i, i], -most, most)
        else:
            both = push[:2] - np.linalg.solve(k[:2, :2], (u + k @ push)[:2])
            # a slip ends on the cone, against its direction: with the mean of both elements of K
            if np.hypot(*both) > most:
                both = push[:2] - (u + k @ push)[:2] / (0.5 * (k[0, 0] + k[1, 1]))
                size = np.hypot(*both)
                both *= min(1.0, most / size) if size else 0.0
            push[:2] = both
    return push


def simulated(data, rate, box):
    """Times, places and orientations of the engine at this number of steps a second."""
    body, start = data["body"], data["start"]
    inertia, mass = np.array(body["inertia"]), body["mass"]
    mu, gravity = data["table"]["friction"]["mu"], np.array(data["gravity"])
    x, v, w = (np.array(start[key]) for key in ("position", "velocity", "angular_velocity"))
    turned = Rotation.from_quat(start["orientation"])
    axes = turned.as_matrix()
    spin = axes @ inertia @ axes.T @ w  # angular momentum about the centre of mass
    h, end = 1 / rate, data["expected"]["time"][-1]
    found = [(0.0, x.copy(), turned.as_quat())]
    for step in range(round(end * rate)):
        axes = turned.as_matrix()
        light = axes @ np.linalg.inv(inertia) @ axes.T
        v, r = v + h * gravity, lowest(body, axes)
        lever = crossed(r)
        k = np.eye(3) / mass - lever @ light @ lever
        u = v + np.cross(light @ spin, r)
        u[2] += (x[2] + r[2]) / h * (0.2 if x[2] + r[2] < 0 else 1.0)
        push = impulse(k, u, mu, box)
        v, spin = v + push / mass, spin + np.cross(r, push)
        x = x + h * v
        turned = Rotation.from_rotvec(h * (light @ spin)) * turned
        if (step + 1) % (rate // 500) == 0:
            found.append(((step + 1) * h, x.copy(), turned.as_quat()))
    return tuple(np.array(part) for part in zip(*found, strict=True))


def table():
    yield [
        "scene",
        "limit of the friction",
        *(f"error of the centre with {rate:g} steps per second" for rate in RATES),
    ]
    yield ["---"] * (2 + len(RATES))
    for name, scene in scenes():
        for box in (False, True):
            off = [scene.compare(*simulated(scene.data, rate, box)) for rate in RATES]
            cells = [f"{1e3 * x.position.max():.2g} mm" for x in off]
            yield [
                name,
                "a box: one limit for each axis" if box else "a cone: one limit for the force",
                *cells,
            ]


if __name__ == "__main__":
    page_table.main(__doc__, MARK, table)
