"""The body of a scene in the format URDF, from the numbers of the scene's JSON file.

URDF has cylinders and spheres, and neither fillets nor ellipsoids. A single circle, and each of several, is a
cylinder whose half thickness is a millionth of the radius, as in the model for MuJoCo.
"""

from typing import Any

#: Half the thickness of a circle, over the radius.
_THIN = 1e-6
_NO_SHAPE = "urdf: expected a body with sharp rims, a ball, balls or a capsule; URDF has no other shape"


def urdf(data: dict[str, Any]) -> str:
    """The URDF model of the body of a scene."""
    body = data["body"]
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = ((repr(x) for x in row) for row in body["inertia"])
    touch = "\n".join(
        f'    <{kind}><origin xyz="0.0 0.0 {z!r}" rpy="0 0 0"/><geometry>{geometry}</geometry></{kind}>'
        for z, geometry in _parts(body["shape"])
        for kind in ("visual", "collision")
    )
    name = body["name"].replace("--", "- -")
    return f"""\
<?xml version="1.0"?>
<!-- {name}; the origin is the centre of mass. Start, table and answer: see the JSON file. -->
<robot name="spincyl">
  <link name="body">
    <inertial>
      <origin xyz="0 0 0" rpy="0 0 0"/>
      <mass value="{body["mass"]!r}"/>
      <inertia ixx="{xx}" ixy="{xy}" ixz="{xz}" iyy="{yy}" iyz="{yz}" izz="{zz}"/>
    </inertial>
{touch}
  </link>
</robot>
"""


def _parts(shape: dict[str, Any]) -> list[tuple[float, str]]:
    """Height and XML of each shape that touches the table; ValueError if URDF has no such shape."""
    circles = shape.get("circles")
    if circles is None:
        raise ValueError(_NO_SHAPE)
    first, last = circles[0], circles[-1]
    if shape["type"] == "cylinder" and not shape["swollen_by"]:
        return [_cylinder(first, last, first["radius"])]
    found = []
    for circle in circles:
        radius, fillet = circle["radius"], circle.get("swollen_by", shape["swollen_by"])
        if radius and fillet:
            raise ValueError(_NO_SHAPE)
        if radius:
            long = 2.0 * _THIN * shape["radius"]
            found.append((circle["height"], f'<cylinder radius="{radius!r}" length="{long!r}"/>'))
        else:
            found.append((circle["height"], f'<sphere radius="{fillet or _THIN * shape["radius"]!r}"/>'))
    if shape["type"] == "capsule":
        found.append(_cylinder(first, last, shape["swollen_by"]))
    return found


def _cylinder(low: dict[str, float], high: dict[str, float], radius: float) -> tuple[float, str]:
    """The cylinder between two heights."""
    long = high["height"] - low["height"]
    return 0.5 * (low["height"] + high["height"]), f'<cylinder radius="{radius!r}" length="{long!r}"/>'
