"""Test scenes for engines that simulate contacts, with their exact solution.

A scene has a body on a table, its initial velocities in SI units, and the expected inclination, pose,
energy, contact point and contact force with the error of each.

A body with a fillet is a smaller core enlarged by the radius of the fillet: all points within that distance
of a smaller cylinder, of a line (capsule), of two points or of one (balls). On a table they are equivalent.
"""

import json
import math
from contextlib import ExitStack
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from spincyl._body import Body
from spincyl._contact import Contact, Coulomb, Viscous, rolls
from spincyl._ending import Ending
from spincyl._input.files import replaced
from spincyl._input.numbers import Floats, made, number, path_of, si, whole
from spincyl._measured import speaking
from spincyl._motion import Motion
from spincyl._roll import roll
from spincyl._scale import Scale, scale_of
from spincyl._state import State, gripping
from spincyl._studio.shape import kind, landing, profiles, rotations, skin

#: Number of pieces of a profile that become one in a mesh for display.
_PIECES = 4


class Scene:
    """A body on a table and what becomes of it; from `scene`.

    Attributes
    ----------
    motion : Motion
        The expected one, in natural units.
    data : dict
        What the JSON file has: body, table, start and expected values in SI units.
    mjcf : str
        The scene for MuJoCo, with its start as the keyframe "start".
    """

    def __init__(self, motion: Motion, scale: Scale, mu: float, restitution: float | None = None) -> None:
        self.motion, self.scale, self.mu, self.restitution = motion, scale, mu, restitution

    @property
    def data(self) -> dict[str, Any]:
        """Body, table, start and expected values: numbers, lists and text."""
        m, scale, body = self.motion, self.scale, self.motion.body
        metre, second, joule = scale.metres(1.0), scale.seconds(1.0), scale.joules(1.0)
        weight = scale.mass * scale.gravity
        moment = scale.mass * metre**2
        position, velocity, w, turned = self._start()
        if m.contact == "rolling":
            needed = friction_needed(body, m.start, float(m.t[-1]))
        else:
            needed = self.mu if self._flies else 0.0
        bounces, struck = self._bounces()
        bore = None if np.isnan(body.bore) else body.bore * metre
        return {
            "format": "spincyl scene 1",
            "units": "metres, kilograms, seconds, radians; z up; quaternions x, y, z, w",
            "body": {
                "shape": "cylinder on its lower rim",
                "radius": metre,
                "half_length": skin(body).half * metre,
                "inner_radius": bore,
                **self._round(),
                "mass": scale.mass,
                "inertia": [body.i1 * moment, body.i1 * moment, body.i3 * moment],
                "axes": "principal, the third is that of symmetry; origin at the centre of mass",
            },
            "gravity": [0.0, 0.0, -scale.gravity],
            "table": {"point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0], "friction": self.mu, **bounces},
            "start": {
                "position": (position * metre).tolist(),
                "orientation": turned.tolist(),
                "velocity": (velocity * metre / second).tolist(),
                "angular_velocity": (rotations(turned) @ w / second).tolist(),
                "angular_velocity_in_body_axes": (w / second).tolist(),
            },
            "expected": {
                "time": (m.t * second).tolist(),
                "theta": m.theta.tolist(),
                "energy": (m.energy * joule).tolist(),
                "normal_force": (m.normal * weight).tolist(),
                "contact_force": (m.contact_force * weight).tolist(),
                "contact_point": (np.pad(m.contact_point, ((0, 0), (0, 1))) * metre).tolist(),
                "position": (m.centre * metre).tolist(),
                "orientation": m.orientation.tolist(),
                "theta_is": "angle from the vertical to the axis of symmetry",
                "energy_is": "kinetic and potential, from the table up",
                "contact_force_is": "what the table exerts on the body, at the contact point",
                **struck,
                "contact": m.contact if isinstance(m.contact, str) else "friction",
                "friction_coefficient_needed": needed,
                "found": m.message,
                "found_is": "how, with errors in natural units",
            },
            "error": {
                "energy": self._energy_error() * joule,
                "normal_force": m.force_error * weight,
                "contact_force": (m.force_error + m.pose_error * float(m.friction.max())) * weight,
                "theta": m.error,
                "position": max(m.pose_error, m.error) * metre,
                "contact_point": max(m.pose_error, m.error) * metre,
                "angles": m.pose_error,
                "error_is": "the largest of all times; angles are those of the orientation",
            },
        }

    @property
    def _flies(self) -> bool:
        """Whether the motion goes on where the body leaves the table."""
        return self.restitution is not None

    def _bounces(self) -> tuple[dict[str, Any], dict[str, Any]]:
        """What the data of a motion with impacts has besides: of the table, and expected."""
        if not self._flies:
            return {}, {}
        scale, m = self.scale, self.motion
        metre, second = scale.metres(1.0), scale.seconds(1.0)
        blows = [
            {
                "time": blow.time * second,
                "normal_impulse": blow.impulse[2] * scale.mass * metre / second,
                "energy_lost": scale.joules(blow.lost),
            }
            for blow in m.impacts
        ]
        phases = [{"time": phase.time * second, "kind": phase.kind} for phase in m.phases]
        heights = {"height": (m.height * metre).tolist(), "height_is": "of the lowest point"}
        law = "energy given back by the normal force in an impact, over that taken: its square (Stronge)"
        return (
            {"restitution": self.restitution, "restitution_is": law},
            {"impacts": blows, "phases": phases, **heights},
        )

    @property
    def mjcf(self) -> str:
        """The scene for MuJoCo. Contacts as stiff and friction as steady as its solver bears."""
        body, scale = self.motion.body, self.scale
        _, wall, fillet, rim, _ = skin(body)
        if wall == 0 and rim > 0:
            what = f", nor one to be swollen by fillet = {fillet!r}" if fillet else ""
            raise ValueError(f"ell = {wall:g}: MuJoCo has no cylinder without thickness{what}")
        second, metre = scale.seconds(1.0), scale.metres(1.0)
        position, velocity, w, (x, y, z, real) = self._start()
        moments = [scale.mass * metre**2 * x for x in (body.i1, body.i1, body.i3)]
        table, shape, looks, pair = self._geometry()
        places = [*(position * metre), real, x, y, z]
        speeds = [*(velocity * metre / second), *(w / second)]
        return f"""\
<mujoco model="spincyl">
  <option gravity="0 0 {-scale.gravity!r}" timestep="{5e-4 * second:.6g}" integrator="implicitfast"
          cone="elliptic" impratio="1000" solver="Newton" iterations="100" tolerance="0"
          noslip_iterations="30" noslip_tolerance="0">
    <flag energy="enable"/>
  </option>
  <visual><global offwidth="1280" offheight="720"/></visual>
{looks}  <worldbody>
    <light pos="0 0 {10 * metre!r}" dir="0 0 -1" directional="true"/>
{table}
    <body name="body">
      <freejoint/>
      <inertial pos="0 0 0" mass="{scale.mass!r}" diaginertia="{_words(moments)}"/>
{shape}
    </body>
  </worldbody>
{pair}  <keyframe>
    <key name="start" qpos="{_words(places)}" qvel="{_words(speeds)}"/>
  </keyframe>
</mujoco>
"""

    def _round(self) -> dict[str, Any]:
        """The data of a body with a fillet, which replace those of a sharp one."""
        body, metre = self.motion.body, float(self.scale.metres(1.0))
        if not body.fillet > 0:
            return {}
        middle, wall, fillet, rim, _ = (x * metre for x in skin(body))
        ends = [[0.0, 0.0, middle - wall], [0.0, 0.0, middle + wall]]
        shape, core = {
            "cylinder": ("cylinder with rounded edges on its lower rim", "cylinder"),
            "capsule": ("capsule", "segment"),
            "balls": ("two balls", "points"),
            "ball": ("ball", "points"),
        }[kind(body)]
        return {
            "shape": shape,
            "fillet": fillet,
            "height_over_rim": body.ell * metre,
            "lands_at": landing(body),
            "core": {"type": core, "radius": rim, "ends": ends[: 2 if wall else 1], "swollen_by": fillet},
            "core_is": "the body is all that is within swollen_by of its core, without its bore, rod or stem",
        }

    def _geometry(self) -> tuple[str, str, str, str]:
        """The geoms of table and body for MuJoCo, the mesh for display, and the pair's contact.

        A cylinder with a fillet is a smaller one with a margin: contact begins when plane and cylinder are
        two fillets apart, and MuJoCo puts the contact point half way between them. So the plane lies one
        fillet below the table. The shape is exact, without facets.
        """
        body, metre, second = self.motion.body, float(self.scale.metres(1.0)), self.scale.seconds(1.0)
        damping = 1e3 / second * (1.0 if self.restitution is None else 2.0 * _damped(self.restitution))
        stiff = f'solref="{-1e6 / second**2:.6g} {-damping:.6g}" solimp="0.9999 0.9999 0.001 0.5 2"'
        touch = f'friction="{self.mu!r} 0 0" condim="3" {stiff}'
        size = f'size="{20 * metre!r} {20 * metre!r} {metre!r}"'
        table, margin, round_ = f'    <geom name="table" type="plane" {size} {touch}/>', "", ""
        middle, wall, fillet, rim, _ = (x * metre for x in skin(body))
        if fillet == 0:
            geoms = [f'name="rim" type="cylinder" size="{_words([metre, body.ell * metre])}" {touch}']
        elif rim == 0:
            ends = [middle - wall, middle + wall] if kind(body) == "balls" else [middle]
            capsule = kind(body) == "capsule"
            size = _words([fillet, wall] if capsule else [fillet])
            of = f'type="{"capsule" if capsule else "sphere"}" size="{size}"'
            geoms = [
                f'name="{name}" {of} pos="0 0 {z!r}" {touch}'
                for name, z in zip(("rim", "other"), ends, strict=False)
            ]
        else:
            seen, unseen = 'contype="0" conaffinity="0"', 'contype="0" conaffinity="0" group="3"'
            deep = f'    <geom name="table" type="plane" pos="0 0 {-fillet!r}" {size} {unseen}/>'
            table = f'    <geom name="top of the table" type="plane" {size} {seen}/>\n{deep}'
            geoms = [
                f'name="rim" type="cylinder" size="{_words([rim, wall])}" {unseen}',
                f'name="looks" type="mesh" mesh="looks" mass="0" {seen}',
            ]
            places = " ".join(f"{x:.6g}" for x in (metre * _outside(body)).ravel())
            round_ = f'  <asset><mesh name="looks" inertia="shell" vertex="{places}"/></asset>\n'
            grip = f'friction="{self.mu!r} {self.mu!r} 0 0 0" condim="3" margin="{2 * fillet!r}" gap="0"'
            margin = f'  <contact><pair geom1="table" geom2="rim" {grip} {stiff}/></contact>\n'
        return table, "\n".join(f"      <geom {geom}/>" for geom in geoms), round_, margin

    def save(self, path: str | PathLike[str]) -> list[Path]:
        """Write `path`.json and, unless the body has no wall, `path`.xml (MJCF); returns their paths.

        Files that are there stay until both new ones are complete.

        Raises
        ------
        OSError
            If a file cannot be written.
        """
        path = path_of("path", path)
        stem = path.stem if path.suffix in {".json", ".xml"} else path.name
        texts = {f"{stem}.json": json.dumps(self.data, indent=1, allow_nan=False) + "\n"}
        if skin(self.motion.body).wall or self.motion.body.fillet == 1:
            texts[f"{stem}.xml"] = self.mjcf
        paths = [path.parent / name for name in texts]
        with ExitStack() as all_:  # both files are written, or neither
            for part, text in zip(map(all_.enter_context, map(replaced, paths)), texts.values(), strict=True):
                part.write_text(text, encoding="utf-8")
        return paths

    def _energy_error(self) -> float:
        """A bound of the error of the energy that follows from the error of the states, in natural units.

        Each term of the energy has at most two angular velocities, and moments below `inertia`.
        """
        m = self.motion
        inertia = 1 + (abs(m.body.ell) + m.body.fillet) ** 2 + m.body.i1 + m.body.i3
        return float(m.error * inertia * (1 + 3 * np.abs(m.w).max()))

    def _start(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Position, velocity, angular velocity along the body's axes, and orientation, in natural units."""
        m = self.motion
        turned = m.orientation[0]
        # at the start, psi = 0: e1, e2, e3 are the body's axes
        w = m.w[0]
        arm = m.centre[0] - np.append(
            m.contact_point[0], m.natural._extra["height"][0] if self._flies else 0.0
        )
        velocity = np.cross(rotations(turned) @ w, arm)
        if m.contact == "smooth":
            velocity[:2] = 0.0
        elif self._flies:  # the contact point is not at rest, and phi = 0
            velocity += [*m.slip[0], m.lift[0]]
        return m.centre[0], velocity, w, turned

    def __repr__(self) -> str:
        last = self.scale.seconds(self.motion.t[-1])
        return f"<Scene of {self.motion.body!r}, {last:.6g} s; .save('scene') writes it>"


def scene(
    body: Body,
    state: State,
    *,
    scale: Scale | None = None,
    seconds: float = 1.0,
    points: int = 101,
    mu: float = 1.0,
    contact: Contact = "rolling",
    restitution: float | None = None,
) -> Scene:
    """A validation scene for contact engines: the start, and what must come of it.

    Parameters
    ----------
    body : Body
    state : State
        Single ones, in the range of `roll`.
    scale : Scale, optional
        Default: that of a measured body; else a radius of one metre, a mass of one kilogram.
    seconds : float
        How long the motion is known for.
    points : int
        Times from 0 on at which it is known, at least 2.
    mu : float
        Coefficient of friction of the scene; of a smooth one 0, whatever is given.
    contact : {"rolling", "smooth"}
    restitution : float, optional
        0 to 1: the table has dry friction `mu`, and the body may slip, fly, strike and lie, as in `roll`.

    Returns
    -------
    Scene
        `data`, `mjcf`, `save("scene")`.

    Raises
    ------
    ValueError
        If the motion ends within the time, saying how: an engine then shows something else. Without
        `restitution`, for a state that slips, and for a law of friction. There is no scene of a stone.

    Notes
    -----
    examples/contact_engine.py runs MuJoCo on five such scenes and prints how far it deviates. A body with a
    fillet is told as its core (`data["body"]["core"]`), which the fillet swells to the true shape.

    Examples
    --------
    >>> import spincyl as sc
    >>> body = sc.Body.solid(2.5)
    >>> start = sc.scene(body, body.steady(1.3)).data["start"]
    >>> [round(x, 6) for x in start["position"]]
    [-2.141397, 0.0, 1.632305]
    """
    made("body", body, Body)
    of = "a scene is of a body that rolls, or slides on a smooth table without friction"
    if isinstance(contact, Coulomb | Viscous):
        why = f"expected 'rolling' or 'smooth': {of}; mu= is what rolling may need"
        raise ValueError(f"contact = {contact!r}: {why}")
    rolling = rolls(contact)
    if restitution is None:
        gripping(state, f"{of}; restitution= makes one of a body that slips, hops and lies")
    scale, body = scale_of(scale, body) or Scale(1.0), body.natural
    scale.newtons(1.0)  # refuses an unknown mass
    seconds, mu = number("seconds", si("seconds", seconds, "second")), number("mu", mu)
    if not 0 < seconds < np.inf:
        raise ValueError(f"seconds = {seconds!r}: expected a positive number")
    points = whole("points", points, 2, 1_000_000)
    if not 0 <= mu < np.inf:
        raise ValueError(f"mu = {mu!r}: expected 0 or more, and finite")
    until = seconds / float(scale.seconds(1.0))
    if not until <= 1e9:
        raise ValueError(
            f"seconds = {seconds!r}: at most {1e9 * float(scale.seconds(1.0)):.3g} with this scale"
        )
    t = np.linspace(0.0, until, points)
    if restitution is None:
        how: dict[str, Any] = {"contact": contact, "mu": mu if rolling else np.inf}
    else:
        how = {"contact": Coulomb(mu), "restitution": restitution}
    with speaking(scale):
        m = roll(body, state, t, want=("pose", "force"), **how)
    if m.event is not None:
        why = m.message.split(";")[0]
        more = ""
        if m.status == Ending.SLIP and restitution is None:
            mu = enough(body, state, until, friction_needed(body, state, until))
            more = "; no mu would do" if math.isinf(mu) else f"; mu = {mu:g} would do"
        raise ValueError(f"{why} ({scale.seconds(m.event.time):.6g} s), before {seconds:g} s are over{more}")
    return Scene(m, scale, mu if rolling else 0.0, restitution)


def friction_needed(body: Body, state: State, until: float) -> float:
    """The coefficient of friction that rolling needs up to a time, at 4001 sampled times."""
    m = roll(body, state, np.linspace(0.0, until, 4001), want="force")
    return float(m.friction_coefficient.max(initial=0.0))


def enough(body: Body, state: State, until: float, mu: float) -> float:
    """A rounded coefficient of friction above `mu` with which the body rolls until then; inf without one.

    The need may have peaks between the sampled times, and with more friction the motion may end otherwise.
    """
    mu = 1.01 * mu
    while mu < 1e12:
        rounded = float(f"{mu:.3g}") if mu > 1 else math.ceil(1000 * mu) / 1000
        end = roll(body, state, until, mu=rounded).status
        if end != Ending.SLIP:
            return rounded if end == Ending.DONE else math.inf
        mu *= 2
    return math.inf


def _damped(restitution: float) -> float:
    """Damping of a linear spring, over its critical one, with which a body bounces so."""
    # an engine takes no damping of zero for one of springs
    decrement = -math.log(min(max(restitution, 1e-3), 1 - 1e-9))
    return decrement / math.hypot(math.pi, decrement) if restitution > 0 else 1.0


def _outside(body: Body) -> Floats:
    """Points on the surface of a body, which is their convex hull; (n, 3)."""
    wall = profiles(body)[0]
    corners = np.array([*wall.corners[::_PIECES], wall.corners[-1]])
    angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)[:, np.newaxis]
    r, z = corners.T
    places: Floats = np.stack([r * np.cos(angle), r * np.sin(angle), z + 0 * angle], -1).reshape(-1, 3)
    return places


def _words(numbers: Any) -> str:
    return " ".join(repr(float(x)) for x in numbers)
