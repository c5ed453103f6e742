"""A small engine that knows of a scene what its JSON says, and nothing else: Newton and Euler, by SciPy's DOP853.

A body has the numbers of `body`, a table those of `table`; the force of the table is the one that keeps the contact
point at rest, or that of the law of friction. No formula of the library stands here.
"""

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

UP = np.array([0.0, 0.0, 1.0])


class Pose(NamedTuple):
    x: np.ndarray
    q: np.ndarray
    v: np.ndarray
    w: np.ndarray


class Engine:
    """The motion of a scene from any of its rows to a later one, through phases that it is told."""

    def __init__(self, data):
        self.data, self.body, self.table = data, data["body"], data["table"]
        self.mass, self.inertia = self.body["mass"], np.array(self.body["inertia"])
        self.gravity, self.shape = -data["gravity"][2], self.body["shape"]
        self.friction = self.table["friction"]
        radius, angle = np.polynomial.legendre.leggauss(24), 2 * np.pi * (np.arange(48) + 0.5) / 48
        # rho = cos(x) of a disk of radius 1, so that the pressure of Hertz is smooth
        x, weight = np.pi / 4 * (radius[0] + 1), np.pi / 4 * radius[1]
        self.spots = np.sin(x)[:, None, None] * np.stack([np.cos(angle), np.sin(angle), 0 * angle], -1)
        self.press = (3 * np.cos(x) ** 2 * np.sin(x) * weight / len(angle))[:, None, None]

    def lowest(self, turn, w):
        """From the centre of mass to the contact point, and how fast that vector changes."""
        if self.shape["type"] == "ellipsoid":
            square, n = np.array(self.shape["semi_axes"]) ** 2, turn.T @ UP
            moves = np.cross(n, turn.T @ w)
            size = np.sqrt(n @ (square * n))
            arm = np.array(self.shape["centre"]) - square * n / size
            runs = -square * moves / size + square * n * (n @ (square * moves)) / size**3
            return turn @ arm, np.cross(w, turn @ arm) + turn @ runs
        a = turn[:, 2]
        moves = np.cross(w, a)
        out = UP - a[2] * a
        s = np.linalg.norm(out)
        out, leans = out / s, -moves[2] * a - a[2] * moves
        leans = (leans - (out @ leans) * out) / s
        found = []
        for circle in self.shape["circles"]:
            z, r = circle["height"], circle["radius"]
            rounded = circle.get(
                "swollen_by", self.shape["swollen_by"]
            )  # each of several circles has its own
            found.append((z * a - r * out - rounded * UP, z * moves - r * leans))
        return min(found, key=lambda pair: pair[0][2])

    def touching(self, a):
        """Radius of the circle of contact of a body with this axis."""
        s = np.linalg.norm(np.cross(UP, a))
        circles = self.shape["circles"]
        rounded = [circle.get("swollen_by", self.shape["swollen_by"]) for circle in circles]
        pairs = list(zip(circles, rounded, strict=True))
        circle, fillet = min(
            pairs, key=lambda pair: pair[0]["height"] * a[2] - pair[0]["radius"] * s - pair[1]
        )
        return circle["radius"] + fillet * s

    def couple(self, turn, w, normal):
        """The losses, from the formulas of the file."""
        a = turn[:, 2]
        c = a[2]
        s = np.linalg.norm(np.cross(UP, a))
        known = {"n": UP, "w": w, "s": s, "N": normal, "R": self.shape["radius"], "pi": np.pi}
        known |= {"sign": np.sign, "abs": abs, "norm": np.linalg.norm, "w_n": w[2], "t": w - w[2] * UP}
        known |= {"h": (c * UP - a) / s, "q": (w @ a - c * w[2]) / s**2}
        known["A"] = self.touching(a) / self.shape["radius"]
        total = np.zeros(3)
        for law in self.table["losses"]:
            if normal is None and law["coefficient"] not in ("b", "b2"):
                continue  # as the file says of the air
            total = total + eval(law["couple"], {}, known | {law["coefficient"]: law["value"]})
        return total

    def rubbed(self, u, w):
        """Friction on the contact point per normal force, and its moment about it."""
        law = self.friction
        if law["law"] == "viscous":
            return -law["c"] * u, np.zeros(3)
        if law.get("patch"):
            spots = law["patch"] * self.spots
            over = u + w[2] * np.cross(UP, spots)
            drag = -law["mu"] * over / np.linalg.norm(over, axis=-1, keepdims=True) * self.press
            return drag.sum((0, 1)), np.cross(spots, drag).sum((0, 1))
        speed = np.linalg.norm(u)
        return (-law["mu"] * u / speed if law["mu"] else 0 * u), np.zeros(3)

    def force(self, pose, kind):
        """Force of the table, and the couple on the body."""
        turn = Rotation.from_quat(pose.q).as_matrix()
        arm, runs = self.lowest(turn, pose.w)
        spun = turn @ np.linalg.inv(self.inertia) @ turn.T
        gyro = -np.cross(pose.w, turn @ self.inertia @ turn.T @ pose.w)
        free = self.couple(turn, pose.w, 0.0) + gyro if self.table["losses"] else gyro
        dry = self.couple(turn, pose.w, 1.0) + gyro - free if self.table["losses"] else np.zeros(3)

        def gains(force, couple):
            """Acceleration of the contact point by a force there and a couple."""
            return force / self.mass + np.cross(spun @ (np.cross(arm, force) + couple), arm)

        if kind == "flying":
            return np.zeros(3), self.couple(turn, pose.w, None) + gyro, arm, spun
        # what the contact point gains without a force of the table
        rest = np.cross(spun @ free, arm) + np.cross(pose.w, runs) - self.gravity * UP
        if kind == "rolling":
            columns = [gains(x, dry if x is UP else 0.0 * UP) for x in (*np.eye(3)[:2], UP)]
            found = np.linalg.solve(np.stack(columns, -1), -rest)
            return found, free + found[2] * dry, arm, spun
        push, twist = self.rubbed((pose.v + np.cross(pose.w, arm)) * [1, 1, 0], pose.w)
        normal = -rest[2] / gains(UP + push, dry + twist)[2]
        return normal * (UP + push), free + normal * (dry + twist), arm, spun

    def slope(self, y, kind):
        pose = Pose(y[:3], y[3:7] / np.linalg.norm(y[3:7]), y[7:10], y[10:])
        force, couple, arm, spun = self.force(pose, kind)
        (x, y, z), q = pose.w, pose.q
        turns = np.array([[0, -z, y, x], [z, 0, -x, y], [-y, x, 0, z], [-x, -y, -z, 0]]) @ q / 2
        return np.concatenate(
            [pose.v, turns, force / self.mass - self.gravity * UP, spun @ (np.cross(arm, force) + couple)]
        )

    def carried(self, pose, times, kind, tol=1e-12):
        """The poses at some times, from that at the first of them; angular velocities in space."""
        y = np.concatenate(pose)
        found = solve_ivp(
            lambda t, y: self.slope(y, kind), (times[0], times[-1]), y, "DOP853", times, rtol=tol, atol=tol
        )
        assert found.success
        return [Pose(y[:3], y[3:7], y[7:10], y[10:]) for y in found.y.T]

    def slip(self, pose):
        """Velocity of the contact point."""
        arm, _ = self.lowest(Rotation.from_quat(pose.q).as_matrix(), pose.w)
        return pose.v + np.cross(pose.w, arm)
