"""A scene as a model of MuJoCo (MJCF), from the numbers of the scene's JSON file.

The initial state is the keyframe "start". Contacts are as stiff and friction as steady as the solver of
MuJoCo allows. A comment at the top of the model names the laws that MuJoCo does not have, and the couple to
apply instead.

A cylinder with a fillet is modelled by a smaller cylinder with a margin: contact begins when plane and
cylinder are two fillets apart, and MuJoCo puts the contact point half way between them. Therefore the plane
is one fillet below the table. The shape is exact, without facets. A single circle is modelled by a cylinder
whose half thickness is a millionth of the radius.

Of a body of several circles only these touch the table: each is such a cylinder, or a ball, and a tip is a
tiny ball. Where a ball passes into an edge at a smooth joint, the whole ball would be the lowest: there the
mesh for display touches.
"""

import math
from itertools import pairwise
from typing import Any

import numpy as np

from spincyl._input.numbers import Floats

_SEEN = 'contype="0" conaffinity="0"'
_UNSEEN = f'{_SEEN} group="3"'
#: Half the thickness of a circle, over the radius.
_THIN = 1e-6
#: Of a mesh for display: number of points round the axis.
_AROUND = 48
#: Torsional friction of an evenly turning patch under the pressure of Hertz, over mu times its radius.
_TURNS = 3 * math.pi / 16


def mjcf(data: dict[str, Any]) -> str:
    """The model of a scene; the convex hull of its outline shows a body that MuJoCo has no shape for."""
    looks = _hull_points(data["body"]["shape"].get("outline", []))
    body, start, metre = data["body"], data["start"], data["scale"]["R"]
    second = data["scale"]["second"]
    grip, notes = _laws(data["table"])
    table, shape, mesh, pair, more = _geometry(data, grip, looks)
    x, y, z, real = start["orientation"]
    places = [*start["position"], real, x, y, z]
    speeds = [*start["velocity"], *start["angular_velocity_in_body_axes"]]
    (a, d, e), (_, b, f), (_, _, c) = body["inertia"]
    said = "\n  ".join(
        [
            f"{body['name']}; qpos x, y, z is the centre of mass, then a quaternion w, x, y, z.",
            f"The answer is known for {data['expected']['time'][-1]!r} s: see the JSON file.",
            *notes,
            *more,
            "With a step n times shorter, let solref have n^2 the stiffness and n the damping: MuJoCo lets a"
            " contact that rolls creep, at its acceleration over the damping.",
        ]
    )
    return f"""\
<!--
  {said.replace("--", "- -")}
-->
<mujoco model="spincyl">
  <option gravity="{_words(data["gravity"])}" timestep="{5e-4 * second:.6g}" integrator="implicitfast"
          cone="elliptic" impratio="1000" solver="Newton" iterations="100" tolerance="0"
          noslip_iterations="30" noslip_tolerance="0">
    <flag energy="enable"/>
  </option>
  <visual><global offwidth="1280" offheight="720"/></visual>
{mesh}  <worldbody>
    <light pos="0 0 {10 * metre!r}" dir="0 0 -1" directional="true"/>
{table}
    <body name="body">
      <freejoint/>
      <inertial pos="0 0 0" mass="{body["mass"]!r}" fullinertia="{_words([a, b, c, d, e, f])}"/>
{shape}
    </body>
  </worldbody>
{pair}  <keyframe>
    <key name="start" qpos="{_words(places)}" qvel="{_words(speeds)}"/>
  </keyframe>
</mujoco>
"""


def _hull_points(outline: list[list[float]]) -> Floats:
    """Points (n, 3) on the body whose profile has these radii and heights."""
    angle = np.linspace(0, 2 * np.pi, _AROUND, endpoint=False)[:, np.newaxis]
    r, z = np.array(outline, np.float64).reshape(-1, 2).T
    return np.stack([r * np.cos(angle), r * np.sin(angle), z + 0 * angle], -1).reshape(-1, 3)


def _laws(table: dict[str, Any]) -> tuple[tuple[float, float], list[str]]:
    """Coefficients of sliding and torsional friction for MuJoCo, and notes on the laws for the comment."""
    friction, torsion = table["friction"], 0.0
    mu, notes = friction.get("mu", 0.0), []
    if friction["law"] == "viscous":
        notes.append(f"NOT IN THIS FILE: friction {friction['force']}, c = {friction['c']!r} s/m.")
    if friction["law"] == "rolling":
        notes.append(f"The answer rolls without slip. That needs a friction of {friction['needed']!r}.")
    if friction["law"] == "coulomb" and friction["static"] != mu:
        notes.append(f"NOT IN THIS FILE: static friction {friction['static']!r}. Here it is held up to mu N.")
    if friction.get("patch"):
        torsion = _TURNS * mu * friction["patch"]
        said = f"a patch of {friction['patch']!r} m. Here slip and drilling share an ellipse instead."
        notes.append(f"NEARLY: {said}")
    if table["restitution"] is not None:
        notes.append(f"NEARLY: restitution {table['restitution']!r}. Here it is the damping of a spring.")
    for law in table["losses"]:
        value = f"{law['coefficient']} = {law['value']!r} {law['unit']}"
        notes.append(f"NOT IN THIS FILE: {law['law']}, the couple {law['couple']}, {value}.")
    if table["losses"]:
        notes += ["Apply a couple at each step, as xfrc_applied[1, 3:].", table["symbols"]]
    return (mu, torsion), notes


def _geometry(
    data: dict[str, Any], grip: tuple[float, float], looks: Floats
) -> tuple[str, str, str, str, list[str]]:
    """The geoms of table and body, the mesh for display, the contact of their pair, and notes on them."""
    shape, metre, second = data["body"]["shape"], data["scale"]["R"], data["scale"]["second"]
    mu, torsion = grip
    bounce = data["table"]["restitution"]
    damping = 1e3 / second * (1.0 if bounce is None else 2.0 * _damped(bounce))
    stiff = f'solref="{-1e6 / second**2:.6g} {-damping:.6g}" solimp="0.9999 0.9999 0.001 0.5 2"'
    dim = f'condim="{4 if torsion else 3}"'
    touch = f'friction="{_words([mu, torsion, 0.0])}" {dim} {stiff}'
    size = f'size="{_words([20 * metre, 20 * metre, metre])}"'
    table = f'    <geom name="table" type="plane" {size} {touch}/>'
    pair, more, heights = "", [], [x["height"] for x in shape.get("circles", [])]
    fillet, rim = shape.get("swollen_by", 0.0), heights and shape["circles"][0]["radius"]
    if shape["type"] == "circles":
        if _is_smooth(shape["circles"]):
            geoms = [f'name="rim" type="mesh" mesh="looks" {touch}']
            more.append("NEARLY: a smooth joint. Here the body is a mesh with facets.")
        else:
            geoms, planes, pair = _geoms_of_circles(
                shape["circles"], metre, (mu, torsion), f"{dim} {{}} {stiff}"
            )
            geoms = [f"{geom} {touch}" if _UNSEEN not in geom else geom for geom in geoms]
            table = "\n".join([table, *(f"{plane} {size} {_UNSEEN}/>" for plane in planes)])
            more.append("Each circle that can touch the table is a geom of its own.")
    elif shape["type"] == "ellipsoid":
        of = f'size="{_words(shape["semi_axes"])}" pos="{_words(shape["centre"])}"'
        geoms = [f'name="rim" type="ellipsoid" {of} {touch}']
    elif shape["type"] == "capsule":
        of = f'size="{_words([fillet, heights[1]])}"'
        geoms = [f'name="rim" type="capsule" {of} {touch}']
    elif rim == 0:
        of = f'type="sphere" size="{fillet!r}"'
        pairs = zip(("rim", "other"), heights, strict=False)
        geoms = [f'name="{name}" {of} pos="0 0 {z!r}" {touch}' for name, z in pairs]
    else:
        half, middle = (heights[-1] - heights[0]) / 2 or _THIN * metre, (heights[0] + heights[-1]) / 2
        of = f'name="rim" type="cylinder" pos="0 0 {middle!r}" size="{_words([rim, half])}"'
        if len(heights) == 1:
            more.append(f"The rim is a cylinder of {2 * half:.3g} m instead of a circle.")
        geoms = [f"{of} {touch}"]
        if fillet > 0:
            geoms = [f"{of} {_UNSEEN}"]
            deep = f'    <geom name="table" type="plane" pos="0 0 {-fillet!r}" {size} {_UNSEEN}/>'
            table = f'    <geom name="top of the table" type="plane" {size} {_SEEN}/>\n{deep}'
            held = f'friction="{_words([mu, mu, torsion, 0.0, 0.0])}" {dim} margin="{2 * fillet!r}"'
            pair = f'  <contact><pair geom1="table" geom2="rim" {held} gap="0" {stiff}/></contact>\n'
    mesh = ""
    if looks.size:
        geoms.append(f'name="looks" type="mesh" mesh="looks" mass="0" {_SEEN}')
        places = " ".join(f"{x:.6g}" for x in looks.ravel())
        mesh = f'  <asset><mesh name="looks" inertia="shell" vertex="{places}"/></asset>\n'
    return table, "\n".join(f"      <geom {geom}/>" for geom in geoms), mesh, pair, more


def _is_smooth(circles: list[dict[str, float]]) -> bool:
    """Whether any two neighbouring circles touch at a smooth joint."""
    for below, above in pairwise(circles):
        apart = math.hypot(above["height"] - below["height"], above["radius"] - below["radius"])
        if apart <= abs(above["swollen_by"] - below["swollen_by"]) * (1 + 1e-9):
            return True
    return False


def _geoms_of_circles(
    circles: list[dict[str, float]], metre: float, grip: tuple[float, float], how: str
) -> tuple[list[str], list[str], str]:
    """The geoms of several circles, planes below the table for those with a fillet, and their contacts."""
    geoms, planes, pairs = [], [], []
    mu, torsion = grip
    for k, circle in enumerate(circles):
        radius, fillet, name = circle["radius"], circle["swollen_by"], f"circle {k}"
        place = f'name="{name}" pos="0 0 {circle["height"]!r}"'
        if radius == 0:
            geoms.append(f'{place} type="sphere" size="{fillet or _THIN * metre!r}"')
            continue
        geom = f'{place} type="cylinder" size="{_words([radius, _THIN * metre])}"'
        if fillet == 0:
            geoms.append(geom)
            continue
        geoms.append(f"{geom} {_UNSEEN}")
        plane = f"table below circle {k}"
        planes.append(f'    <geom name="{plane}" type="plane" pos="0 0 {-fillet!r}"')
        held = f'friction="{_words([mu, mu, torsion, 0.0, 0.0])}"'
        touch = how.format(f'margin="{2 * fillet!r}" gap="0"')
        pairs.append(f'    <pair geom1="{plane}" geom2="{name}" {held} {touch}/>\n')
    contact = "  <contact>\n" + "".join(pairs) + "  </contact>\n" if pairs else ""
    return geoms, planes, contact


def _damped(restitution: float) -> float:
    """Damping ratio of a linear spring on which a body bounces with this coefficient of restitution."""
    # MuJoCo does not accept a damping of zero here
    decrement = -math.log(min(max(restitution, 1e-3), 1 - 1e-9))
    return decrement / math.hypot(math.pi, decrement) if restitution > 0 else 1.0


def _words(numbers: Any) -> str:
    return " ".join(repr(float(x)) for x in np.asarray(numbers))
