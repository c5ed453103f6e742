"""Content of the JSON file of a scene: body, table, initial state, and the known answer with errors, in SI.

Vectors are along the axes of the table, z along its normal; on a slope x points downhill, and gravity is
turned. The origin of a body is its centre of mass; its axes are those of `Motion.orientation`, for a stone
those of its ellipsoid. docs/engines.md has the keys.
"""

import math
from functools import singledispatch
from typing import Any

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._contact import Coulomb, Viscous
from spincyl._ellipsoid import Ellipsoid
from spincyl._ellipsoid_motion import EllipsoidMotion
from spincyl._input.numbers import Floats, Reals, flag, floats, reals
from spincyl._loss import LAWS
from spincyl._motion import Motion
from spincyl._phases import KINDS, has_two_rims
from spincyl._restitution import coefficient_of, law_for_core
from spincyl._scale import Scale
from spincyl.studio.scene_again import natural_data
from spincyl.studio.shape import kind, landing, profiles, reach, rotations, skin, tensor

VERSION = 1
_UNIT = 1e-3  # tolerance of unit quaternions
_SYMBOLS = (
    "n: up. a: axis 3 of the body. w: angular velocity; w_n = w.n; t = w - w_n n. s = |n x a|."
    " h = ((a.n) n - a)/s. q = (w.a - (a.n) w_n)/s^2. N: normal force, of both rims together."
    " A = (radius of the circle + swollen_by s)/R. R: body.shape.radius."
    " A couple acts on the body and takes the power -couple.w; in the air there are only"
    f" {' and '.join(row.parameter for row in LAWS.values() if row.in_air)}."
    " sign(0), and t/norm(t) of t = 0, is what keeps it 0, of at most the size 1."
)
_SLIPS = "-mu N u/|u| at the contact point, where u is its velocity over the table"
_RESTITUTION_IS = {
    "Stronge": "its square is the share of the work of compression that the normal force gives back"
    " (Stronge); null: nothing strikes the table",
    "Newton": "the normal velocity after an impact is minus this times that before (Newton)",
    "Poisson": "the normal impulse after compression is this times that of compression (Poisson)",
    "Walton": "the normal velocity of the ball after an impact is minus this times that before, its slip"
    " minus {!r} times that before if that takes at most mu times the normal impulse (Walton)",
}
_ROLLS = "what keeps the contact point at rest; any coefficient from `needed` on does"
_PATCH = (
    "-mu p(r) (u + (w.n) n x r)/|u + (w.n) n x r| per area of a disk of radius `patch`, and its moment"
    " about n: p = 3 N/(2 pi patch^2) sqrt(1 - r^2/patch^2)"
)
#: Least error of the times of phases and impacts and of lost energies, in natural units.
_LEAST = 1e-11
#: Friction of a scene of rolling whose motion has no `mu`: least value, ratio to the needed value, largest.
_MU = 1.0, 1.5, 1e3
#: Of an outline for display: number of pieces of a profile that become one.
_PIECES = 4


def scene_data(m: Motion, scale: Scale, t0: float) -> dict[str, Any]:
    """The scene of a motion in natural units with poses and forces, whose initial state is at time `t0`."""
    if m._asked.turning:
        raise ValueError("motion: a scene needs a table that does not turn")
    metre, second, joule = (float(x) for x in (scale.metres(1.0), scale.seconds(1.0), scale.joules(1.0)))
    w, v = moving(m)
    known = _known_answer(m, metre, second, joule, w=w, v=v, t0=t0)
    return {
        "spincyl-scene": VERSION,
        "units": "SI: metres, kilograms, seconds, radians, newtons, joules",
        "axes": "of the table, z its normal; quaternions are x, y, z, w and turn the body's axes into these",
        "scale": {"R": scale.radius, "M": scale.mass, "g": scale.gravity, "second": second},
        "gravity": [scale.gravity * math.sin(m._asked.slope), 0.0, -scale.gravity * math.cos(m._asked.slope)],
        "body": _body(m.body, scale, metre),
        "table": _table(m, metre, second, joule, t0),
        "start": {
            **{name: known[name][0] for name in ("position", "orientation", "velocity", "angular_velocity")},
            "angular_velocity_in_body_axes": (w[0] @ rotations(m.orientation[0]) / second).tolist(),
        },
        "expected": known,
        "error": _errors(m, metre, second, joule, w, v),
        "natural": natural_data(m),
    }


def moving(m: Motion) -> tuple[Floats, Floats]:
    """(n, 3) each: angular velocity, and velocity of the centre of mass, along the laboratory's axes."""
    slip = m._extra.get("slip", np.zeros((m.t.size, 2)))
    lift = m._extra.get("lift", np.zeros(m.t.size))
    w, u = _turning(m, slip, lift)
    height = m._extra.get("height", np.zeros(m.t.size))
    v = u + np.cross(w, m.centre - np.column_stack([m.contact_point, height]))
    if m.contact == "smooth" and "slip" not in m._extra:
        v[:, 0], v[:, 1] = math.sin(m._asked.slope) * (m.t - m._asked.t0), 0.0  # the centre falls along x
    return w, v


@singledispatch
def _turning(m: Motion, slip: Floats, lift: Floats) -> tuple[Floats, Floats]:
    """Angular velocity and velocity of the contact point, along laboratory axes, from its slip and lift."""
    phi = m.turns[0][:, 1]
    zero, up = np.zeros(phi.size), np.array([0.0, 0.0, 1.0])
    along = np.column_stack([np.cos(phi), np.sin(phi), zero])
    across = np.column_stack([-np.sin(phi), np.cos(phi), zero])
    c, s = np.cos(m.theta)[:, None], np.sin(m.theta)[:, None]
    w1, w2, w3 = m.w.T[..., None]
    w = w1 * (c * along + s * up) + w2 * across + w3 * (c * up - s * along)
    return w, slip[:, :1] * along + slip[:, 1:] * across + lift[:, None] * up


@_turning.register
def _(m: EllipsoidMotion, slip: Floats, lift: Floats) -> tuple[Floats, Floats]:
    turned = rotations(m.orientation)
    # slip is along the x and y from which the smallest rotation gives the stone this vertical
    x, y, z = m.vertical.T
    least = np.column_stack([y, -x, np.zeros(x.size), 1 + z])
    least[z == -1] = [1.0, 0.0, 0.0, 0.0]
    least /= np.linalg.norm(least, axis=1)[:, np.newaxis]
    u = np.einsum("nij,nkj,nk->ni", turned, rotations(least), np.column_stack([slip, lift]))
    return np.einsum("nij,nj->ni", turned, m.w), u


def inclination(orientation: Floats) -> Floats:
    """(n,) angles from the vertical to axis 3 of these orientations."""
    x, y, z = rotations(orientation)[:, :, 2].T
    found: Floats = np.arctan2(np.hypot(x, y), z)
    return found


def bounds(m: Motion, w: Floats | float = 0.0, v: Floats | float = 0.0) -> dict[str, float]:
    """Bounds of the errors of a motion by name, in natural units, from its angular velocities and velocities.

    If velocities are left out, only the bounds of state, position and orientation are right.
    """
    force = m.contact_force if "contact_force" in m._extra else 0.0
    most = [float(np.linalg.norm(np.atleast_2d(x), axis=1).max(initial=0.0)) for x in (w, v, force)]
    size = (reach(m.body), float(np.linalg.norm(tensor(m.body), 2)))
    return _core.bounds((m.error, m.pose_error, m.force_error), size, (most[0], most[1], most[2]))


def _body(body: Body | Ellipsoid, scale: Scale, metre: float) -> dict[str, Any]:
    inertia = tensor(body) * scale.mass * metre**2
    moments, axes = np.linalg.eigh(inertia)
    return {
        "name": repr(body),
        "mass": scale.mass,
        "inertia": inertia.tolist(),
        "inertia_is": "about the centre of mass, along the body's axes; the origin is the centre of mass",
        "principal_moments": moments.tolist(),
        "principal_axes": (axes * np.sign(np.linalg.det(axes)) + 0.0).T.tolist(),
        "shape": _touching_parts(body, metre),
    }


@singledispatch
def _touching_parts(body: Any, metre: float) -> dict[str, Any]:
    """The shapes of a body of revolution that can touch the table: circles, swollen by a fillet."""
    if body.rims is not None:
        return _several_circles(body, metre)
    middle, wall, fillet, rim, bore = (x * metre for x in skin(body))
    both = has_two_rims(body)
    heights = [-wall, wall] if both else [middle if kind(body) == "ball" else -float(body.ell) * metre]
    return {
        "type": kind(body) if both or kind(body) == "ball" else "rim",
        "radius": metre,
        "inner_radius": bore if body.bore == body.bore else None,
        "circles": [{"height": z, "radius": rim} for z in heights],
        "swollen_by": fillet,
        "half_length": wall + fillet if both else None,
        "lands_at": landing(body),
        "is": "all within swollen_by of the convex hull of the circles, which are about axis 3, at these"
        " heights over the centre of mass; at the inclination lands_at something else touches the table",
        "outline": _outline(body, metre) if 0 < body.fillet < 1 or body._parts else [],
    }


def _outline(body: Body, metre: float) -> list[list[float]]:
    """Radius and height of points of a profile whose convex hull shows a body."""
    every = ((skin.corners, _PIECES if skin.normals else 1) for skin in profiles(body))
    return [[metre * r, metre * z] for found, step in every for r, z in (*found[::step], found[-1])]


def _several_circles(body: Body, metre: float) -> dict[str, Any]:
    """The circles of a body that has neither one nor two equal rims, each swollen by its own fillet."""
    rows = (body.circles * metre).tolist()
    return {
        "type": "circles",
        "radius": metre,
        "inner_radius": None,
        "circles": [{"height": z, "radius": rim, "swollen_by": fillet} for rim, z, fillet in rows],
        "swollen_by": None,
        "half_length": None,
        "lands_at": landing(body),
        "is": "the convex hull of the circles, each with all within its swollen_by, about axis 3 at these"
        " heights over the centre of mass; at the inclination lands_at the second one touches the table",
        "outline": _outline(body, metre),
    }


@_touching_parts.register
def _(stone: Ellipsoid, metre: float) -> dict[str, Any]:
    end = float(stone.theta_end)
    return {
        "type": "ellipsoid",
        "radius": metre,
        "semi_axes": (np.asarray(stone.semi_axes) * metre).tolist(),
        "centre": (-np.asarray(stone.offset) * metre).tolist(),
        "lands_at": None if math.isnan(end) else end,
    }


def _table(m: Motion, metre: float, second: float, joule: float, t0: float) -> dict[str, Any]:
    contact, laws = m.contact, [] if m.losses is None else m.losses.laws
    friction: dict[str, Any]
    if isinstance(contact, Coulomb):
        patch = float(contact.patch) * metre
        friction = {"law": "coulomb", "mu": contact.mu, "static": contact.static, "patch": patch}
        friction["force"] = _PATCH if patch else _SLIPS + "; while it is at rest, at most static N"
    elif isinstance(contact, Viscous):
        friction = {"law": "viscous", "c": float(contact.c) * second / metre, "unit": "s/m"}
        friction["force"] = "-c N u at the contact point, where u is its velocity over the table"
    elif contact == "smooth":
        friction = {"law": "smooth", "mu": 0.0, "force": "none"}
    else:
        needed = math.inf if m._asked.restitution is not None else friction_needed(m, t0)
        least, over, most = _MU
        # what is unknown needs as much as can be
        enough = most if math.isnan(needed) else min(max(least, over * needed), most)
        mu = m._asked.mu if m._asked.mu < math.inf else enough
        friction = {"law": "rolling", "mu": mu, "needed": needed, "force": _ROLLS}
    bounce = m._asked.restitution
    kind, tangential = law_for_core(bounce) or ("Stronge", 0.0)
    losses = []
    for law in laws:
        value = float(np.asarray(law.coefficient))
        for x, power in zip((metre, second, joule), law._row.exponents, strict=True):
            value *= x**power
        told = {"law": type(law).__name__, "coefficient": law._parameter, "value": value}
        couple = law._row.couple if law._acts_in_slip else f"{law._row.couple}, 0 while the body slips"
        losses.append(told | {"unit": law._row.si, "couple": couple})
    return {
        "point": [0.0, 0.0, 0.0],
        "normal": [0.0, 0.0, 1.0],
        "friction": friction,
        "restitution": None if bounce is None else coefficient_of(bounce),
        "restitution_is": _RESTITUTION_IS[kind].format(tangential),
        "losses": losses,
        "symbols": _SYMBOLS,
    }


def friction_needed(m: Motion, t0: float) -> float:
    """The largest coefficient of friction that rolling needs, of 4001 sampled times."""
    t = np.linspace(t0, float(m.t[-1]), 4001)
    return float(m.wanting("force", t=t).friction_coefficient.max(initial=0.0))


def _known_answer(
    m: Motion, metre: float, second: float, joule: float, *, w: Floats, v: Floats, t0: float
) -> dict[str, Any]:
    """The known motion in SI, as for JSON; NaN where the contact has no single point or force."""
    weight, extra = joule / metre, m._extra
    phase = extra.get("phase", np.zeros(m.t.size, int))
    stands = phase == KINDS.index("on its face")
    both = (phase >= KINDS.index("lying")) & ~stands
    normal = m.normal + np.where(both, extra.get("normal_other", 0.0), 0.0)
    # where N < 0 the body leaves the table at once, and there is no force
    leaves = normal < 0
    force = np.where(both[:, None], np.nan, np.where(leaves[:, None], 0.0, m.contact_force))
    point = np.column_stack([m.contact_point, np.zeros(m.t.size)])
    point[both | stands | (phase == KINDS.index("flying"))] = np.nan
    found = {
        "time": (m.t - t0) * second,
        "position": m.centre * metre,
        "orientation": m.orientation,
        "velocity": v * (metre / second),
        "angular_velocity": w / second,
        "theta": inclination(m.orientation),
        "energy": m.energy * joule,
        "normal_force": np.where(leaves, 0.0, normal) * weight,
        "contact_force": force * weight,
        "contact_point": point * metre,
    }
    for name, key in (("heat_of_slip", "dissipated"), ("lost_by_losses", "work_lost")):
        if key in extra:
            found[name] = extra[key] * joule
    told: dict[str, Any] = {name: x.tolist() for name, x in found.items()}
    told["theta_is"] = "angle from the vertical to axis 3 of the body"
    told["contact_is"] = (
        "force of the table on the body, and where; null on both rims, and no place in the air or on a face"
    )
    if m._asked.restitution is not None:
        told["height"] = (m.height * metre).tolist()
        told["height_is"] = "of the lowest point of the body"
        told["lost_in_impacts"] = (m.lost_in_impacts * joule).tolist()
        told["impacts"] = [
            {
                "time": (x.time - t0) * second,
                "kind": x.kind,
                "normal_impulse": x.impulse[2] * joule * second / metre,
                "energy_lost": x.lost * joule,
            }
            for x in m.impacts
        ]
    first = "slipping" if m.contact == "smooth" else "rolling"
    begun = [(t0, first)] if m._phases is None else [(x.time, x.kind) for x in m.phases]
    told["phases"] = [{"time": (t - t0) * second, "kind": name} for t, name in begun]
    last = float(m.t[-1]) if m.event is None else m.event.time
    why = m.message.split(";")[0]
    told["ending"] = {"kind": m.status.name, "time": (last - t0) * second, "why": why}
    return told


def _errors(m: Motion, metre: float, second: float, joule: float, w: Floats, v: Floats) -> dict[str, Any]:
    """Bounds of the errors at any time, from the estimated errors of states, poses and forces."""
    found, spent = bounds(m, w, v), max(_LEAST, m.error)
    return {
        "position": found["position"] * metre,
        "angle": found["orientation"],
        "theta": found["state"],
        "angular_velocity": found["angular_velocity"] / second,
        "velocity": found["velocity"] * (metre / second),
        "energy": found["energy"] * joule,
        "normal_force": 2 * m.force_error * joule / metre,
        "contact_force": found["force"] * joule / metre,
        "contact_point": m.pose_error * metre,
        "times_of_phases_and_impacts": spent * second,
        "heat_and_losses": spent * joule,
        "is": "the largest at any time; angle is that between orientations",
    }


def checked_array(
    name: str, value: Reals, shape: tuple[int, ...], scalar_first: bool | None = None
) -> Floats:
    """Finite numbers of a shape, where () is any (n,); with `scalar_first`, unit quaternions x, y, z, w."""
    found = floats(reals(name, value))
    fits = found.shape == shape if shape else found.ndim == 1
    if not fits:
        raise ValueError(f"{name}: expected finite numbers of shape {shape or '(n,)'}, not {found.shape}")
    if not found.size:
        raise ValueError(f"{name}: expected at least one number, not an empty array")
    bad = np.argwhere(~np.isfinite(found))
    if bad.size:
        place = f"value {bad[0, 0]} is" if found.ndim == 1 else f"row {bad[0, 0]} has"
        what = "NaN" if np.isnan(found[tuple(bad[0])]) else "an infinite number"
        raise ValueError(f"{name}: {place} {what}; expected finite numbers")
    if scalar_first is None:
        return found
    if (np.abs(np.linalg.norm(found, axis=-1) - 1) > _UNIT).any():
        raise ValueError(f"{name}: expected unit quaternions")
    return np.roll(found, -1, axis=-1) if flag("scalar_first", scalar_first) else found
