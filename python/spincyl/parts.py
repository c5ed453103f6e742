"""Parts on one axis, from which `assembled` makes a body: cylinders, cones, balls, thin walls, rings, points.

Diameters, lengths and heights are numbers in metres, or texts such as "18mm". Give each part its `mass` (kg)
or its `density`: in kg/m^3 for a solid part, in kg/m^2 for a thin wall, in kg/m for a ring. For a solid part
it may also be the name of a material, such as "steel"; `measured` lists these names. `at` is the height of
the lowest point of the part. By default the first part is at height 0, and each further part stands on the
part before it; a part that would stand on nothing, such as a hub in the hole of a wheel, needs `at`.

>>> import spincyl as sc
>>> from spincyl import parts
>>> top = sc.assembled([
...     parts.ball(diameter="2mm", density=7800),
...     parts.cylinder(outer_diameter="2mm", length="30mm", at="1mm", density=7800),
...     parts.cylinder(outer_diameter="40mm", inner_diameter="2mm", length="4mm", at="12mm", density=7800),
... ])
>>> print(f"{top.scale.mass * 1e3:.1f} g, lands at {top.theta_end * 180 / 3.14159:.1f} degrees")
39.9 g, lands at 31.3 degrees
"""

import math
import warnings
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from spincyl import _core
from spincyl._body import Body
from spincyl._input.materials import density_in_si
from spincyl._input.numbers import instance_of, number, si
from spincyl._input.units import suspicion_of_units
from spincyl._scale import Scale

__all__ = ["Part", "assembled", "ball", "cap", "cone", "cylinder", "disk", "point", "ring", "shell", "wall"]


def __dir__() -> list[str]:
    return [*__all__, *(name for name in globals() if name.startswith("__"))]


#: Codes of the forms, and the indices of heights among their numbers, from the lowest to the highest point.
_SOLID, _BALL, _WALL, _SHELL, _RING = range(5)
_HEIGHTS = {_SOLID: (4, 5), _BALL: (3, 2, 4), _WALL: (2, 3), _SHELL: (2, 1, 3), _RING: (1,)}
#: Largest relative difference of two radii or heights that count as equal.
_TOUCH = 1e-9


@dataclass(frozen=True)
class Part:
    """A part of a body, as made by the functions of this module.

    Attributes
    ----------
    name : str
        Name of the function that made the part, such as "cylinder".
    form : int
        Code of the geometric form; parts of different names may have the same form.
    numbers : tuple of float
        Radii and heights of the part, in metres; heights are above its lowest point.
    amount : float
        Mass in kg, or density in kg/m^3, kg/m^2 or kg/m.
    dense : bool
        Whether `amount` is a density.
    at : float or None
        Height of the lowest point, in metres. None if the part stands on the part before it.
    """

    name: str
    form: int
    numbers: tuple[float, ...]
    amount: float
    dense: bool
    at: float | None

    def raised(self, by: float) -> "Part":
        """Return the part with all its heights increased by the length `by`, in metres."""
        by = _metres("by", by)
        heights = _HEIGHTS[self.form]
        return replace(self, numbers=tuple(x + by if i in heights else x for i, x in enumerate(self.numbers)))

    @property
    def top(self) -> float:
        """Height of the highest point of the part, in metres."""
        return self.numbers[_HEIGHTS[self.form][-1]]

    def _across(self, z: float) -> tuple[float, float]:
        """Inner and outer radius of the part at the height `z`, which lies within the part."""
        heights = [self.numbers[i] for i in _HEIGHTS[self.form]]
        low, high = heights[0], heights[-1]
        share = (z - low) / (high - low) if high > low else 0.0
        if self.form == _SOLID:
            r, s, b, c, *_ = self.numbers
            return b + share * (c - b), r + share * (s - r)
        if self.form == _WALL:
            r, s = self.numbers[:2]
            along = r + share * (s - r)
            return (along, along) if high > low else (min(r, s), max(r, s))
        if self.form == _RING:
            return self.numbers[0], self.numbers[0]
        r, up = self.numbers[0], z - heights[1]
        hollow = self.numbers[1] if self.form == _BALL else r
        outer, inner = (math.sqrt(max(a * a - up * up, 0.0)) for a in (r, hollow))
        return inner, outer

    def _carries(self, other: "Part") -> bool:
        """Whether this part has matter at the lowest points of another part, and so carries that part."""
        z = other.numbers[_HEIGHTS[other.form][0]]
        near = _TOUCH * (self.top + other.top)
        if not self.numbers[_HEIGHTS[self.form][0]] - near <= z <= self.top + near:
            return False
        (a, b), (c, d) = self._across(min(z, self.top)), other._across(z)
        near = _TOUCH * (b + d)
        return a <= d + near and c <= b + near


def cylinder(
    *,
    outer_diameter: float,
    length: float,
    inner_diameter: float = 0.0,
    fillet: float = 0.0,
    at: float | None = None,
    mass: float | None = None,
    density: float | str | None = None,
) -> Part:
    """Solid or hollow cylinder; its `fillet` rounds the outer edges without a change of mass and moments.

    Lengths are in metres, or texts such as "18mm"; `mass` is in kg, `density` in kg/m^3 or a material.
    """
    r, b = _metres("outer_diameter", outer_diameter) / 2, _metres("inner_diameter", inner_diameter) / 2
    rest = 0.0, _metres("length", length), _metres("fillet", fillet)
    return _part("cylinder", _SOLID, (r, r, b, b, *rest), at, mass, density)


def cone(
    *,
    lower_diameter: float,
    upper_diameter: float,
    length: float,
    at: float | None = None,
    mass: float | None = None,
    density: float | str | None = None,
) -> Part:
    """Solid cone or frustum; one of the two diameters may be 0.

    Lengths are in metres, or texts such as "18mm"; `mass` is in kg, `density` in kg/m^3 or a material.
    """
    r, s = _metres("lower_diameter", lower_diameter) / 2, _metres("upper_diameter", upper_diameter) / 2
    return _part("cone", _SOLID, (r, s, 0.0, 0.0, 0.0, _metres("length", length), 0.0), at, mass, density)


def ball(
    *,
    diameter: float,
    inner_diameter: float = 0.0,
    at: float | None = None,
    mass: float | None = None,
    density: float | str | None = None,
) -> Part:
    """Solid or hollow ball.

    Lengths are in metres, or texts such as "18mm"; `mass` is in kg, `density` in kg/m^3 or a material.
    """
    r, b = _metres("diameter", diameter) / 2, _metres("inner_diameter", inner_diameter) / 2
    return _part("ball", _BALL, (r, b, r, 0.0, 2 * r), at, mass, density)


def cap(
    *,
    diameter: float,
    height: float,
    upper: bool = False,
    at: float | None = None,
    mass: float | None = None,
    density: float | str | None = None,
) -> Part:
    """Solid cap of a ball: its lowest part, of the given `height`; with `upper`, its highest part.

    Lengths are in metres, or texts such as "18mm"; `mass` is in kg, `density` in kg/m^3 or a material.
    """
    r, h = _metres("diameter", diameter) / 2, _metres("height", height)
    return _part("cap", _BALL, (r, 0.0, h - r if upper else r, 0.0, h), at, mass, density)


def wall(
    *,
    lower_diameter: float,
    upper_diameter: float,
    length: float,
    at: float | None = None,
    mass: float | None = None,
    density: float | None = None,
) -> Part:
    """Thin wall, open at both ends, such as a paper cone.

    Lengths are in metres, or texts such as "18mm"; `mass` is in kg, `density` in kg/m^2.
    """
    r, s = _metres("lower_diameter", lower_diameter) / 2, _metres("upper_diameter", upper_diameter) / 2
    return _part("wall", _WALL, (r, s, 0.0, _metres("length", length)), at, mass, density)


def disk(
    *,
    outer_diameter: float,
    inner_diameter: float = 0.0,
    at: float | None = None,
    mass: float | None = None,
    density: float | None = None,
) -> Part:
    """Thin disk, with or without a hole, such as a floor or a lid.

    Lengths are in metres, or texts such as "18mm"; `mass` is in kg, `density` in kg/m^2.
    """
    r, b = _metres("outer_diameter", outer_diameter) / 2, _metres("inner_diameter", inner_diameter) / 2
    return _part("disk", _WALL, (b, r, 0.0, 0.0), at, mass, density)


def shell(
    *,
    diameter: float,
    height: float | None = None,
    upper: bool = False,
    at: float | None = None,
    mass: float | None = None,
    density: float | None = None,
) -> Part:
    """Thin spherical wall. Lengths are in metres, `mass` is in kg, `density` in kg/m^2.

    Default: the whole sphere. With `height`, only its lowest part, of this height; with `upper` as well, only
    its highest part.
    """
    r = _metres("diameter", diameter) / 2
    h = 2 * r if height is None else _metres("height", height)
    return _part("shell", _SHELL, (r, h - r if upper else r, 0.0, h), at, mass, density)


def ring(
    *, diameter: float, at: float | None = None, mass: float | None = None, density: float | None = None
) -> Part:
    """Thin ring, such as a tyre, which can touch the table.

    Lengths are in metres, or texts such as "18mm"; `mass` is in kg, `density` in kg/m.
    """
    return _part("ring", _RING, (_metres("diameter", diameter) / 2, 0.0), at, mass, density)


def point(*, mass: float, at: float | None = None) -> Part:
    """Point mass on the axis, which never touches the table; `mass` in kg, height `at` in metres."""
    return _part("point", _RING, (0.0, 0.0), at, mass, None)


def assembled(parts: Iterable[Part], *, gravity: float = Scale.gravity) -> Body:
    """Make a measured body from parts on one axis.

    Parameters
    ----------
    parts : iterable of Part
        Parts, from the lowest to the highest. Parts with `at` may be in any order.
    gravity : float
        Acceleration of gravity, in m/s^2.

    Returns
    -------
    Body
        Measured body. Its `scale` has the outer radius of its rim and the mass of all parts together;
        `natural` is the same body in natural units. Pictures, films and pages show the parts. The body stands
        on its lowest edge or ball; if several edges are equally low, on the widest. It can land on every
        other circle of its convex hull (`circles`); `theta_end` is the inclination at which the first of them
        touches the table. A body of two circles, equally wide and equally far from the centre of mass, has
        two equal rims. Moments have errors of a few roundings.

    Raises
    ------
    ValueError
        If a number of a part is impossible (the message names it), if the mass is zero, if no part can
        touch the table, or if a part without `at` would stand on nothing, because it fits into the hole of
        the part before it or around this part.
    TypeError
        If an element of `parts` is not a part.

    Notes
    -----
    Parts may overlap; their masses are added. A wheel with a projecting axle stands and rolls on the axle.
    If the axle never touches the table, give it as a `point` at its centre of mass.

    Warns
    -----
    UserWarning
        If the body is larger than 5 m or smaller than 0.1 mm. Probably millimetres were given for metres.

    Examples
    --------
    >>> import spincyl as sc
    >>> balls = sc.assembled([sc.parts.ball(diameter=x, density=7800) for x in ("18mm", "14mm")])
    >>> print(f"{balls.scale.mass * 1e3:.1f} g, lands at {balls.theta_end * 180 / 3.14159:.1f} degrees")
    35.0 g, lands at 97.2 degrees
    """
    try:
        given = list(parts)
    except TypeError:
        raise TypeError(f"parts: expected a list of parts, not {type(parts).__name__}") from None
    if not given:
        raise ValueError("parts: expected at least one part, not an empty list")
    lows = [0.0]
    for i, part in enumerate(given):
        instance_of(f"parts[{i}]", part, Part)
        lows[i] = lows[i] if part.at is None else part.at
        lows.append(lows[i] + part.top)
    # heights are relative to the lowest point, so that they keep their digits
    placed = [part.raised(low - min(lows[:-1])) for part, low in zip(given, lows, strict=False)]
    found = _core.assembled([(part.form, list(part.numbers), part.amount, part.dense) for part in placed])
    numbers, (mass, radius, centre) = found
    for i, part in enumerate(placed[1:], 1):
        solid = part.form != _RING or part.numbers[0] > 0
        if part.at is None and solid and not any(below._carries(part) for below in placed[:i]):
            _refuse_unsupported(i, part, placed[i - 1])
    # the core returns pi/2 for two equal rims, and for a body without another part that lands
    why = suspicion_of_units(
        "body", (max((part.top for part in placed), default=0.0), 2 * radius), math.nan, math.nan
    )
    if why:
        warnings.warn(why, UserWarning, stacklevel=2)
    body = Body._made(numbers, scale=Scale(radius, mass, gravity))
    shape = tuple((part.name, part.form, _scaled(part, centre, radius)) for part in placed)
    object.__setattr__(body, "_parts", shape)
    return body


def _refuse_unsupported(i: int, part: Part, below: Part) -> None:
    (inner, _), (_, outer) = below._across(below.top), part._across(part.numbers[_HEIGHTS[part.form][0]])
    where = "fits into the hole of" if outer < inner else "fits around"
    raise ValueError(
        f"parts[{i}]: the {part.name} {where} the {below.name} before it and would stand on nothing; "
        "give at=, the height of its lowest point"
    )


def _scaled(part: Part, centre: float, radius: float) -> tuple[float, ...]:
    """The numbers of a part in R, with heights relative to the centre of mass."""
    return tuple(x / radius for x in part.raised(-centre).numbers)


def _metres(name: str, value: float) -> float:
    return number(name, si(name, value, "metre"))


def _part(
    name: str,
    form: int,
    numbers: tuple[float, ...],
    at: float | None,
    mass: float | None,
    density: float | str | None,
) -> Part:
    if (mass is None) == (density is None):
        raise TypeError(f"mass, density: give exactly one of them for the {name}")
    if mass is not None:
        amount: Any = number("mass", si("mass", mass, "kilogram"))
    else:
        if isinstance(density, str) and form not in (_SOLID, _BALL):
            told = "in kg/m^2 for a thin wall: the density of its material times its thickness"
            told = "in kg/m for a ring" if form == _RING else told
            raise TypeError(f"density: expected a number {told}, not the text {density!r}")
        amount = number("density", density) if form not in (_SOLID, _BALL) else density_in_si(density)
    low = None if at is None else _metres("at", at)
    if low is not None and not math.isfinite(low):
        raise ValueError(f"at = {low}: expected a finite height, in metres")
    return Part(name, form, numbers, amount, mass is None, low)
