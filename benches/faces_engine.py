"""Beside MuJoCo: a can that is set down, pushed, tipped and topples, and a puck, for the page on contact engines.

    pip install 'spincyl[engine]'
    python benches/faces_engine.py [--docs docs/engines.md]

A full can (R = 33 mm, 112 mm high) and a puck (R = 38.1 mm, 25.4 mm high). In MuJoCo each is a cylinder, which touches
a plane at up to four points, or has 64 small spheres on its rim (of the puck all over its face). Elliptic cones, and
contacts whose time constant is two steps. The table has how far the centre, the angle of its turn or tilt, and the
time at which all is at rest are from those of spincyl.
"""

import time

import mujoco
import numpy as np
import page_table

import spincyl as sc

MARK = "<!-- written by benches/faces_engine.py -->\n\n"
STEPS = (2e-3, 5e-4, 1.25e-4)
GRAVITY = 9.80665
#: speed of the rim, in m/s, below which a body counts as at rest
STILL = 5e-3
POINTS, TINY = 64, 5e-5


class Case:
    """A body in SI, with its friction, and a start: height, tilt, velocity of the centre, and spin."""

    def __init__(
        self, name, radius, height, mu, until, face="ring", drop=0.0, tilt=0.0, velocity=0.0, spin=0.0
    ):
        self.name, self.radius, self.half, self.mu, self.until = name, radius, height / 2, mu, until
        self.face, self.drop, self.tilt, self.velocity, self.spin = face, drop, tilt, velocity, spin
        self.body = sc.Body.solid(self.half / radius)
        self.second, self.metre = np.sqrt(radius / GRAVITY), radius

    def known(self, t):
        """Centre, turn and tilt at these times, and when it rests, of spincyl."""
        speed, rate = self.velocity * self.second / self.metre, self.spin * self.second
        body = self.body
        if self.drop:
            start = sc.dropped(body, self.drop / self.metre, 0.0, w3=rate, velocity=(speed, 0.0, 0.0))
        elif self.tilt:
            start = sc.State(self.tilt, 0.0, 0.0, 0.0, slip=(0.0, 0.0))
        else:
            start = sc.spun(body, rate, velocity=(speed, 0.0))
        law = sc.Coulomb(self.mu, face=self.face)
        begun = time.process_time()
        m = sc.roll(body, start, t / self.second, contact=law, restitution=0.0, want=("pose",))
        spent = time.process_time() - begun
        count = len(m.t)
        centre, turn = self.metre * np.asarray(m.centre)[:, :2], np.asarray(m.phi) + np.asarray(m.psi)
        last = [count - 1] * (len(t) - count)
        rows = [*range(count), *last]
        rests = self.second * m.event.time if m.event else np.inf
        return (centre[rows] - centre[0], (turn - turn[0])[rows], np.asarray(m.theta)[rows]), rests, spent

    def mjcf(self, step, points):
        r, h = self.radius, self.half
        if not points:
            shape = f'<geom name="it" type="cylinder" size="{r} {h}" mass="1"/>'
        else:
            angle, out = 2 * np.pi * np.arange(POINTS) / POINTS, np.ones(POINTS)
            if self.face == "disc":  # of equal areas
                angle, out = (
                    np.pi * (3 - np.sqrt(5)) * np.arange(POINTS),
                    np.sqrt((np.arange(POINTS) + 0.5) / POINTS),
                )
            at = np.column_stack([r * out * np.cos(angle), r * out * np.sin(angle), 0 * angle - h + TINY])
            balls = "".join(
                f'<geom type="sphere" size="{TINY}" pos="{x} {y} {z}" mass="0"/>' for x, y, z in at
            )
            shape = f'<geom type="cylinder" size="{r} {h}" mass="1" contype="0" conaffinity="0"/>{balls}'
        return f"""<mujoco><option timestep="{step}" cone="elliptic" gravity="0 0 -{GRAVITY}" iterations="200"/>
        <default><geom friction="{self.mu} 0 0" condim="3" solref="{2 * step} 1"/></default>
        <worldbody><geom name="table" type="plane" size="9 9 1"/>
        <body name="body"><freejoint/>{shape}</body></worldbody></mujoco>"""

    def run(self, step, points):
        """The same of MuJoCo, at every step."""
        model = mujoco.MjModel.from_xml_string(self.mjcf(step, points))
        data = mujoco.MjData(model)
        s, c = np.sin(self.tilt), np.cos(self.tilt)
        # as spincyl tilts it: about the edge at -x, with the axis towards -x
        data.qpos[:] = [
            0,
            0,
            self.half * c + self.radius * s + self.drop,
            np.cos(self.tilt / 2),
            0,
            -np.sin(self.tilt / 2),
            0,
        ]
        data.qvel[:] = [self.velocity, 0, 0, 0, 0, self.spin]
        rows, rests = [], np.inf
        begun = time.process_time()
        for _ in range(round(self.until / step)):
            axis = np.array(
                [
                    2 * (data.qpos[4] * data.qpos[6] + data.qpos[3] * data.qpos[5]),
                    2 * (data.qpos[5] * data.qpos[6] - data.qpos[3] * data.qpos[4]),
                    1 - 2 * (data.qpos[4] ** 2 + data.qpos[5] ** 2),
                ]
            )
            turn = 2 * np.arctan2(data.qpos[6], data.qpos[3])
            rows.append([data.time, data.qpos[0], data.qpos[1], turn, np.arccos(np.clip(axis[2], -1, 1))])
            speed = np.hypot(*data.qvel[:2]) + self.radius * np.abs(data.qvel[3:]).max()
            rests = rests if speed < STILL and np.isfinite(rests) else data.time if speed < STILL else np.inf
            mujoco.mj_step(model, data)
        return np.array(rows), rests, time.process_time() - begun


def cases():
    can = {"radius": 0.033, "height": 0.112}
    yield Case("can that is set down", **can, mu=0.3, until=0.4, drop=0.003, velocity=0.2, spin=3.0)
    yield Case("can that is pushed", **can, mu=0.3, until=0.7, velocity=1.0, spin=10.0)
    yield Case("can that is tipped by 6 degrees", **can, mu=0.6, until=1.2, tilt=np.radians(6))
    yield Case("can that is pushed and topples", **can, mu=0.7, until=0.2, velocity=2.0)
    yield Case(
        "sliding puck", radius=0.0381, height=0.0254, mu=0.1, until=1.6, face="disc", velocity=1.0, spin=20.0
    )


def table():
    """Rows of the table."""
    yield [
        "scene",
        "shape in MuJoCo, or spincyl",
        "time step of MuJoCo",
        "largest error of the centre",
        "largest error of the rotation about the vertical",
        "largest error of the inclination",
        "time at which it comes to rest in MuJoCo",
        "time at which it comes to rest in spincyl",
        "processor time",
    ]
    yield ["---"] * 9
    for case in cases():
        for points in (False, True):
            for step in STEPS:
                rows, rests, spent = case.run(step, points)
                (centre, turn, tilt), true, own = case.known(rows[:, 0])
                off = np.hypot(*(rows[:, 1:3] - rows[0, 1:3] - centre).T).max()
                turned = np.unwrap(rows[:, 3]) - rows[0, 3] - turn
                steep = np.abs(rows[:, 4] - tilt).max()
                moves = [f"{x:.3f} s" if np.isfinite(x) else "" for x in (rests, true)]
                shape = (
                    ("64 points of its face" if case.face == "disc" else "64 points of its rim")
                    if points
                    else "a cylinder"
                )
                yield [
                    case.name,
                    shape,
                    f"{1e6 * step:g} µs",
                    f"{1e3 * off:.2g} mm",
                    f"{float(f'{np.degrees(np.abs(turned).max()):.2g}'):g} degrees" if case.spin else "",
                    f"{np.degrees(steep):.2g} degrees",
                    *moves,
                    f"{1e3 * spent:.0f} ms",
                ]
        yield [case.name, "spincyl", "", "", "", "", "", "", f"{1e3 * own:.1f} ms"]


if __name__ == "__main__":
    page_table.main(__doc__, MARK, table)
