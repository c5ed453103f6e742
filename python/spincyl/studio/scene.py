"""Scenes for checks of contact engines: body, table, initial state, and the known answer."""

import json
import math
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from spincyl._input.equality import compared_by_value
from spincyl._input.files import path_of, writing_whole
from spincyl._input.numbers import (
    Floats,
    Reals,
    flag,
    instance_of,
    json_value,
    number,
    si,
    warn,
)
from spincyl._motion import Motion
from spincyl._scale import Scale, scale_of
from spincyl._state import State
from spincyl._upward import function_of_method
from spincyl.studio.mjcf import mjcf
from spincyl.studio.scene_again import motion_of
from spincyl.studio.scene_data import VERSION, bounds, checked_array, inclination, scene_data
from spincyl.studio.shape import rotations
from spincyl.studio.urdf import urdf

#: An answer may differ from itself by this much where its error is below rounding, in R or radians.
_ROUNDING = 1e-13
#: Turn from the initial orientation, radians, above which there is a warning.
_DOUBTED = 0.1
#: Ratio of the last time to the end of the scene, and of the first deviation to the distance of the centre
#: from the origin, above which there is a warning.
_LONG, _FARTHEST = 10.0, 30.0
#: Coefficients of the losses that act in the air.
_IN_AIR = "b", "b2"


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Deviation:
    """Deviation of a contact engine from the known motion; returned by `Scene.compare`. All in SI.

    Attributes
    ----------
    time : ndarray, (n,)
        Times that were compared, up to the end of the known motion, in seconds.
    position : ndarray, (n,)
        Distance between the engine's centre of mass and the known one at each time, in metres.
    angle : ndarray, (n,)
        Angle of the rotation from the known orientation to the engine's orientation, in radians, 0 to pi.
    theta : ndarray, (n,)
        Inclination of the body's axis 3 in the engine minus the known inclination, in radians.
    position_error : float
        Estimated error of the known positions, in metres. A `position` below it is no deviation of the
        engine.
    angle_error : float
        Estimated error of the known orientations, in radians.
    """

    time: Floats
    position: Floats
    angle: Floats
    theta: Floats
    position_error: float
    angle_error: float

    def __repr__(self) -> str:
        most = [np.abs(x).max() for x in (self.position, self.angle, self.theta)]
        return (
            f"<Deviation up to {self.time[-1]:.6g} s: centre {most[0]:.2g} m"
            f" (answer {self.position_error:.1g}), turned {most[1]:.2g} rad"
            f" (answer {self.angle_error:.1g}), theta {most[2]:.2g} rad>"
        )


class Scene:
    """A body on a table, its initial state and its known motion; returned by `scene`.

    Attributes
    ----------
    motion : Motion
        The known motion (the "answer"), in natural units.
    scale : Scale
        Scale that converts the known motion to SI.
    data : dict
        Content of the JSON file: body, table, initial state and known motion, in SI. docs/engines.md lists
        its keys.
    mjcf : str
        The scene in the format of MuJoCo (MJCF), with the initial state as the keyframe "start". A comment at
        its top names the laws that MuJoCo does not have.
    urdf : str
        The body in the format URDF; ValueError if URDF has no such shape.
    """

    def __init__(self, motion: Motion, scale: Scale) -> None:
        self.motion, self.scale = motion, scale

    @cached_property
    def data(self) -> dict[str, Any]:
        """Body, table, initial state and known motion, as for JSON; None replaces NaN and infinity."""
        found: dict[str, Any] = json_value(scene_data(self.motion, self.scale, self._began))
        return found

    @property
    def mjcf(self) -> str:
        """The scene as MJCF, with contacts as stiff and friction as steady as MuJoCo's solver allows."""
        return mjcf(self.data)

    @property
    def urdf(self) -> str:
        """The body as URDF: mass, inertia, and what touches the table.

        URDF has no friction, no initial state and no table: an engine takes these from the JSON file. A
        ValueError says that URDF does not have the shape of the body, such as one with a fillet.
        """
        return urdf(self.data)

    @classmethod
    def read(cls, path: str | PathLike[str]) -> "Scene":
        """Read the JSON file of a scene, written in Python or by the Rust crate.

        Parameters
        ----------
        path : path-like
            Path of the file.

        Returns
        -------
        Scene
            The scene; its motion is computed again from the key ``natural`` of the file.

        Raises
        ------
        OSError
            If the file cannot be read.
        ValueError
            If the file is not that of a scene, or if the known motion in the file differs from the motion
            computed again by more than the errors of both.

        Examples
        --------
        >>> import tempfile
        >>> import spincyl as sc
        >>> body = sc.Body.solid(2.5)
        >>> scene = sc.scene(sc.roll(body, body.steady(1.3), [0.0, 1.0, 2.0]))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     (path,) = scene.save(f"{folder}/nutation.json")
        ...     sc.Scene.read(path).data == scene.data
        True
        """
        try:
            data = json.loads(path_of("path", path).read_text(encoding="utf-8"))
        except ValueError as error:
            raise ValueError(f"path = {str(path)!r}: expected the JSON file of a scene: {error}") from None
        if not isinstance(data, dict) or data.get("spincyl-scene") != VERSION:
            raise ValueError(f"path = {str(path)!r}: expected the JSON file of a scene of version {VERSION}")
        motion, units = motion_of(data)
        found = cls(motion, units)
        found.__dict__["data"] = data
        told = data["expected"]
        if len(told["time"]) != motion.t.size:
            told = f"the motion, computed again, ends earlier or later than in the file: {motion.message}"
            raise ValueError(f"path = {str(path)!r}: {told}")
        apart = found.compare(told["time"], told["position"], told["orientation"])
        most = data["error"]["position"] + apart.position_error, data["error"]["angle"] + apart.angle_error
        allowed = most[0] + _ROUNDING * units.radius, most[1] + _ROUNDING
        if apart.position.max() > allowed[0] or apart.angle.max() > allowed[1]:
            why = f"its motion is not that of its body, start and table when computed again: {apart}"
            raise ValueError(f"path = {str(path)!r}: {why}")
        return found

    def _body(self) -> str:
        return self.urdf

    def save(self, path: str | PathLike[str]) -> list[Path]:
        """Write the scene as JSON, as MJCF or both, or its body as URDF, and return the paths.

        Parameters
        ----------
        path : path-like
            Path that ends with .json, .xml (MJCF) or .urdf; this file is written. For a path without such an
            ending the first two are written, and these endings are added to their names.

        Returns
        -------
        list of Path
            Paths of the files.

        Raises
        ------
        OSError
            If a file cannot be written. Existing files stay until all new ones are complete.
        ValueError
            If the path has another ending, or URDF does not have the shape of the body.
        """
        path = path_of("path", path)
        if not path.name:
            raise ValueError(f"path = {str(path)!r}: expected the name of a file")
        known = {".json": self._json, ".xml": self._model, ".urdf": self._body}
        only = path.suffix.lower() in known
        if not only and path.suffix[1:].isalpha():
            told = f"path = {str(path)!r}: expected a name without ending, or with the ending"
            raise ValueError(f"{told} {', '.join(known)}")
        paths = [path] if only else [path.with_name(path.name + suffix) for suffix in (".json", ".xml")]
        texts = [known[x.suffix.lower()]() for x in paths]
        with ExitStack() as all_:  # both files are written, or neither
            for part, text in zip(map(all_.enter_context, map(writing_whole, paths)), texts, strict=True):
                part.write_text(text, encoding="utf-8")
        return paths

    def compare(
        self,
        time: Reals,
        position: Reals = None,
        orientation: Reals = None,
        *,
        scalar_first: bool = False,
    ) -> Deviation:
        """Compare the trajectory of a contact engine with the known motion at the times of the engine.

        Parameters
        ----------
        time : array_like, (n,), or table
            Times of the engine since the initial state, in seconds, in ascending order. The known motion is
            computed at these times, also after the last time of the scene. Times after an event that ends the
            motion, such as the landing of the face, are left out.

            Or, without `position` and `orientation`, a table of the trajectory: the path of a text file, as
            for `data.read_table`; a DataFrame, a dict or a structured array of NumPy. It has the columns t;
            x, y, z; and qx, qy, qz, qw, in any order, beside others. They may also be called "time";
            "pos_x", "position_x", "centre_x", "com_x"; "quat_x", "orientation_x" and so on, whatever the
            capitals and the signs between the words. Units in brackets are converted, as in "x (mm)" and
            "t (ms)". A dict or an array may also have "position" (n, 3) and "orientation" (n, 4).
        position : array_like, (n, 3), optional
            Positions of the centre of mass in the engine, in metres.
        orientation : array_like, (n, 4), optional
            Unit quaternions x, y, z, w in the engine. They rotate vectors from the axes of the body to the
            axes of the laboratory; their sign does not matter.
        scalar_first : bool
            If true, the quaternions are w, x, y, z, as in MuJoCo and Drake. Not for a table with a column for
            each component.

        Returns
        -------
        Deviation
            Distances and angles at the times up to the end of the known motion.

        Raises
        ------
        ValueError, TypeError
            If an argument is invalid; the message names it. If a column is missing; the message lists those
            of the table.
        OSError
            If the file of a table cannot be read.

        Warns
        -----
        UserWarning
            If the orientation at time 0 is not the initial one; the numbers of the quaternions may be in the
            wrong order. If the last time is more than ten times that of the scene; the times may be in
            milliseconds. If the first position is more than 30 times as far from the known position as that
            is from the origin; the positions may be in millimetres.
        """
        if position is None and orientation is None:
            time, position, orientation, named = function_of_method("Scene.compare")(time)
            if named and flag("scalar_first", scalar_first):
                raise ValueError("scalar_first: leave it out, since the names of the columns show the order")
        elif position is None or orientation is None:
            raise TypeError("position, orientation: give both of them, or neither beside a table")
        t = checked_array("time", si("time", time, "second"), ())
        x = checked_array("position", position, (t.size, 3))
        q = checked_array("orientation", orientation, (t.size, 4), scalar_first)
        if t[0] < 0 or (np.diff(t) < 0).any():
            raise ValueError("time: expected seconds since the initial state, in ascending order")
        last = self.scale.seconds(float(self.motion.t[-1]) - self._began)
        if t[-1] > _LONG * last:
            told = f"time: goes up to {t[-1]:.4g} s, but the scene ends at {last:.4g} s"
            warn(f"{told}; are the times in milliseconds?")
        m = self.motion.at(self._began + t / self.scale.seconds(1.0))
        n = m.t.size
        if not n:
            raise ValueError(
                f"time = {t[0]!r}: the known motion ends before this time: {m.message.split(';')[0]}"
            )
        apart = [np.linalg.norm(q[:n] + sign * m.orientation, axis=1) for sign in (-1, 1)]
        angle = 4 * np.arcsin(np.minimum(np.minimum(*apart) / 2, 1.0))
        if t[0] == 0 and angle[0] > _DOUBTED:
            why = "expected quaternions x, y, z, w, or w, x, y, z with scalar_first=True"
            warn(f"orientation: at time 0 it differs by {angle[0]:.2g} rad from the initial one; {why}")
        metre, found = self.scale.radius, bounds(m)
        off, turned = found["position"], found["orientation"]
        away = np.linalg.norm(x[:n] - metre * m.centre, axis=1)
        reach = metre * float(np.linalg.norm(m.centre[0]))
        if away[0] > _FARTHEST * reach:
            told = f"position: {away[0]:.2g} m from the known place at t = {t[0]:.4g} s, itself {reach:.2g} m"
            warn(f"{told} from the origin; are the positions in millimetres?")
        theta = inclination(q[:n]) - inclination(m.orientation)
        return Deviation(t[:n], away, angle, theta, off * metre, turned)

    def couple(
        self,
        orientation: Reals,
        angular_velocity: Reals,
        normal_force: float,
        *,
        scalar_first: bool = False,
        slips: bool = False,
    ) -> Floats:
        """Compute the couple with which the losses act on the body, for an engine without these losses.

        Parameters
        ----------
        orientation : array_like, (4,)
            Unit quaternion of the body, as in `compare`; the axis of the body must not be vertical.
        angular_velocity : array_like, (3,)
            Angular velocity along the axes of the laboratory, in rad/s.
        normal_force : float
            Normal force of the table, in newtons. In the air it is 0, and only the resistance of the air
            acts.
        scalar_first : bool
            If true, the quaternion is w, x, y, z.
        slips : bool
            Whether the contact point slips. Then a rolling resistance with ``while_slipping=False`` is
            absent.

        Returns
        -------
        ndarray, (3,)
            Components of the couple along the axes of the laboratory, in N m; zero without losses. They are
            exact to a few rounding errors.

        Raises
        ------
        ValueError, TypeError
            If an argument is invalid; the message names it.
        """
        q = checked_array("orientation", orientation, (4,), scalar_first)
        w = checked_array("angular_velocity", angular_velocity, (3,)) * self.scale.seconds(1.0)
        pressed = number("normal_force", normal_force) / self.scale.newtons(1.0)
        laws = () if self.motion.losses is None else self.motion.losses.laws
        slips = flag("slips", slips)
        acts = [law for law in laws if law._acts_in_slip or not slips]
        couples = [law.couple for law in acts if pressed > 0 or law._parameter in _IN_AIR]
        axis = rotations(q)[:, 2]
        across = np.array([0.0, 0.0, 1.0]) - axis[2] * axis
        first = across / np.linalg.norm(across)
        frame = np.stack([first, np.cross(axis, first), axis])
        state = State(float(inclination(q[np.newaxis])[0]), *(frame @ w).tolist())
        total = sum((couple(self.motion.body, state, pressed) for couple in couples), np.zeros(3))
        found: Floats = float(self.scale.joules(1.0)) * (total @ frame)
        return found

    @property
    def _began(self) -> float:
        return self.motion._asked.t0

    def _model(self) -> str:
        return self.mjcf

    def _json(self) -> str:
        return _lines(self.data) + "\n"

    def __repr__(self) -> str:
        last = self.scale.seconds(self.motion.t[-1] - self._began)
        return f"<Scene of {self.motion.body!r}, {last:.6g} s; .save('scene') writes it>"


def scene(motion: Motion, *, scale: Scale | None = None) -> Scene:
    """Make a scene with a known motion, to check an engine that simulates contacts.

    Parameters
    ----------
    motion : Motion
        Motion of a body or a stone with any contact, from `roll`. The engine should reproduce it at the times
        of the motion. Poses and forces are computed if the motion does not contain them.
    scale : Scale, optional
        Scale that converts a motion in natural units to SI; a measured body has its own. Default: R (for a
        stone, the largest semi-axis) is 1 m, the mass is 1 kg, and g is 9.80665 m/s^2.

    Returns
    -------
    Scene
        ``.save("scene")`` writes scene.json and scene.xml (MJCF, for MuJoCo). `Scene.compare` computes the
        deviations of an engine.

    Raises
    ------
    ValueError
        If the motion has no time after its initial state, goes backward in time, continues beyond an event or
        is not known up to its last time; or if a measured body has no mass.
    TypeError
        If `motion` is not a Motion, or obeys a law of `spincyl.custom`.

    Notes
    -----
    The scene contains the estimated errors of the motion. If the motion ends, for example because the face
    lands, the scene ends at the same time and names the ending. For a body on both rims the scene contains
    only the sum of the normal forces.

    Examples
    --------
    >>> import spincyl as sc
    >>> body = sc.Body.solid(2.5)
    >>> scene = sc.scene(sc.roll(body, body.steady(1.3), [0.0, 1.0, 2.0]))
    >>> [round(x, 6) for x in scene.data["start"]["position"]]
    [-2.141397, 0.0, 1.632305]
    """
    instance_of("motion", motion, Motion)
    given = scale_of(scale, motion.body) or Scale(1.0)
    given.newtons(1.0)  # raises an error for an unknown mass
    m = motion.natural
    t0, t = m._asked.t0, m.t
    if not t.size or t[0] != t0:
        t = np.concatenate([[t0], t])
    for law in (m.contact, m.losses):
        if getattr(law, "_function", None) is not None:
            raise TypeError(f"motion: a scene cannot contain a law of your own, such as {law!r}")
    if not (np.diff(t) > 0).all():
        raise ValueError("motion: expected ascending times, since an engine starts at the first of them")
    if m.event is not None and m._asked.beyond:
        why = "expected a motion that ends at its event; leave out beyond=True"
        raise ValueError(f"motion: continues beyond an event: {m.message}; {why}")
    if t.size < 2:
        raise ValueError(f"motion: expected a time after the initial state: {motion.message}")
    if m._doubt or not math.isfinite(m.error):
        raise ValueError(f"motion: expected a motion known up to its last time: {motion.message}")
    m = m.wanting("pose", "force", t=None if t is m.t else t)
    return Scene(m, given)


def _lines(value: Any, begin: str = "\n ") -> str:
    """Strict JSON with one line for each entry of an object."""
    if not isinstance(value, dict):
        return json.dumps(value, allow_nan=False)
    entries = (f"{begin}{json.dumps(key)}: {_lines(x, begin + ' ')}" for key, x in value.items())
    return "{" + ",".join(entries) + begin[:-1] + "}"
