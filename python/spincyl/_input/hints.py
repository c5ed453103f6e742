"""Errors about unknown arguments and attributes that propose similar known names."""

import difflib
import re
import shlex
import sys
from collections.abc import Callable, Iterable
from dataclasses import fields
from functools import wraps
from inspect import signature
from typing import TYPE_CHECKING, Any, ClassVar, ParamSpec, TypeVar

import numpy as np

_Given = ParamSpec("_Given")
_Found = TypeVar("_Found")
_MOST_LISTED = 24  #: More names than these are not listed.
_TABLE = "roll takes table=sc.Table(slope)"
_STILL = dict.fromkeys(
    ("still", "still_symbols", "symbols"),
    "contact_radius of a state is the number of still symbols in one turn, if the centre rests",
)
_SIZE = "scale of a measured body has its radius in m and its mass in kg; it is None for any other body"
#: Proposals for attributes of objects, by the class of the object.
_ATTRIBUTES: dict[str, dict[str, str]] = {
    "Body": {
        **_STILL,
        **dict.fromkeys(("mass", "radius", "diameter", "gravity"), _SIZE),
        **dict.fromkeys(("aspect", "half_length", "length"), "ell is the height of the centre of mass, in R"),
        **dict.fromkeys(("inertia", "moments", "I1", "I3"), "i1 and i3 are the moments, in M R^2"),
        **dict.fromkeys(("kappa", "frequency"), "stability(theta) is kappa, nutation(theta) sqrt(kappa)"),
    },
    "State": {
        **_STILL,
        **dict.fromkeys(("w", "omega"), "w1, w2, w3 are the angular velocity along e1, e2, e3"),
        **dict.fromkeys(("velocity", "v", "speed"), "body.centre_velocity(state) is that of the centre"),
        **dict.fromkeys(("phi", "psi"), "a state has only the rates precession (phi') and spin (psi')"),
    },
    "Motion": {
        **_STILL,
        **dict.fromkeys(
            ("omega", "w1", "w2", "w3", "angular_velocity"), "w has w1, w2, w3 in its columns, as m.w[:, 0]"
        ),
        **dict.fromkeys(("velocity", "v", "speed"), "body.centre_velocity(m.states) is that of the centre"),
        **dict.fromkeys(
            ("position", "positions", "x", "path", "trajectory", "centre_of_mass", "center", "pose"),
            'centre, contact_point and orientation need want="pose" in roll',
        ),
        **dict.fromkeys(("quaternion", "quaternions", "rotation", "attitude"), "orientation is a quaternion"),
        **dict.fromkeys(("angle", "tilt", "alpha", "inclination"), "theta is the inclination"),
        **dict.fromkeys(("time", "times", "ts"), "t has the times"),
        **dict.fromkeys(("precession", "gamma"), "states has it: m.states.precession"),
        "spin": "states has it: m.states.spin; psi is the angle of the spin",
        **dict.fromkeys(("events", "end", "ending", "stops_at"), "event has the time and state of the end"),
        **dict.fromkeys(
            ("heat", "lost", "energy_lost"), "dissipated, work_lost and lost_in_impacts are the lost energies"
        ),
        **dict.fromkeys(("force", "forces", "normal_force"), 'normal and friction need want="force" in roll'),
        **dict.fromkeys(("animate", "animation", "video", "movie", "gif"), "sc.view(m).save('film.mp4')"),
        **dict.fromkeys(("view", "show", "display", "page", "html"), "sc.view(m) shows it"),
        **dict.fromkeys(("save", "to_csv", "csv"), "to_dataframe().to_csv(path), or sc.view(m).save(path)"),
        **dict.fromkeys(("df", "dataframe", "to_pandas", "table"), "to_dataframe() is a table"),
        **dict.fromkeys(("bounces", "hits", "collisions"), "impacts has them, if roll gets restitution="),
        **dict.fromkeys(("steps", "step"), "nfev counts evaluations; rk4 is about a fixed step"),
    },
    "EllipsoidMotion": {
        **dict.fromkeys(
            ("velocity", "v", "speed"),
            'slip is that of the contact point; centre needs want="pose"',
        ),
        **dict.fromkeys(("precession", "phi", "psi"), "spin is the angular velocity about the vertical"),
    },
    "Ellipsoid": {
        **dict.fromkeys(("mass", "radius", "gravity"), _SIZE),
        **dict.fromkeys(
            ("axes", "length", "width", "a", "ell"), "semi_axes are half of length, width and height"
        ),
        **dict.fromkeys(("i1", "i3"), "moments are the principal moments, in M a^2"),
        **dict.fromkeys(("rate", "steady", "states"), "only for bodies of revolution; see rocking(spin)"),
        "roll": "sc.roll(stone, state, t) computes a motion",
    },
    "EllipsoidState": {
        **dict.fromkeys(("w1", "w2", "w3", "omega"), "w has the components along the axes of the ellipsoid"),
        "precession": "spin is the angular velocity about the vertical",
    },
}
#: Proposals for names that the library does not have.
_INSTEAD = {
    **_STILL,
    **dict.fromkeys(("slope", "incline", "tilt", "turntable"), _TABLE),
    **dict.fromkeys(("bowl", "concave"), "only a flat table is modelled"),
    "height": "give length= for the height of a body; sc.dropped(body, height, theta) starts in the air",
    **dict.fromkeys(("thickness", "width"), "give length= for the thickness of a disk"),
    **dict.fromkeys(("radius", "diameter"), "outer_diameter= is the size of a tube, in metres"),
    **dict.fromkeys(("friction", "mu_s"), "give contact=sc.Coulomb(mu, static) for friction"),
    "material": "give density= the name of a material, as density='steel'",
    "cone": "sc.assembled([sc.parts.cone(...)]) makes a body of parts",
    **dict.fromkeys(
        ("cylinder", "disk", "disc", "coin"), "sc.Body.solid(ell), or sc.measured(...) in metres"
    ),
    **dict.fromkeys(("ring", "hoop"), "sc.Body.tube(ell, bore), or sc.measured(...) in metres"),
    "slow": "sc.view(m, slow=1).save('film.mp4') shows a motion at its own speed, slow=10 ten times slower",
    **dict.fromkeys(("Stronge", "stronge"), "restitution= takes the number of Stronge's law, as in 0.5"),
    **dict.fromkeys(("Garwin", "garwin", "superball"), "sc.Walton(e, tangential) also reverses the slip"),
    "sphere": "sc.Body.ball(...), or sc.parts.ball in sc.assembled([...])",
    **dict.fromkeys(("ellipsoid", "stone", "egg", "rattleback"), "sc.Ellipsoid is a class of its own"),
    **dict.fromkeys(
        ("cube", "box", "top"), "only bodies of revolution and ellipsoids are modelled; see sc.parts"
    ),
}


def proposal(name: str, known: Iterable[str]) -> str:
    """Text that proposes known names similar to a wrong one, after a colon; empty without a proposal."""
    names = [x for x in known if not x.startswith("_")]
    if "semi_axes" in names and name in ("axes", "length", "lengths", "size", "width", "dimensions"):
        told = ": semi_axes= are half of length, width and height of the whole ellipsoid"
        return f"{told}; a stone that is its lower half has half its length, half its width, its whole depth"
    if name in _INSTEAD:
        return f": {_INSTEAD[name]}"
    near = difflib.get_close_matches(name, names, 3, 0.7)
    told = f"did you mean {' or '.join(near)}?" if near else f"expected {', '.join(names)}"
    return f": {told}" if near or 0 < len(names) <= _MOST_LISTED else ""


def install_command(what: str) -> str:
    """The command that installs a package for the running Python, by its path in a virtual environment."""
    python = shlex.quote(sys.executable) if sys.prefix != sys.base_prefix and sys.executable else "python"
    return f"{python} -m pip install {what}"


def with_hints(call: Callable[_Given, _Found]) -> Callable[_Given, _Found]:
    """Decorator: the error about an unknown argument of a function proposes similar known arguments."""

    @wraps(call)
    def helped(*args: _Given.args, **named: _Given.kwargs) -> _Found:
        try:
            return call(*args, **named)
        except TypeError as e:
            raise_with_proposal(call, named, e)
            raise

    return helped


def raise_with_proposal(call: Callable[..., Any], named: dict[str, Any], error: TypeError) -> None:
    """If the error is about an unknown argument, raise a TypeError that proposes known arguments."""
    known = signature(call).parameters
    odd = next((x for x in named if x not in known), None)
    if odd is not None and f"unexpected keyword argument {odd!r}" in str(error):
        named_ = [x for x, of in known.items() if of.kind != of.VAR_KEYWORD and x not in ("self", "cls")]
        raise TypeError(f"{error}{proposal(odd, named_)}") from None


def why_no_numbers(value: Any) -> str:
    """The reason why texts are not numbers: a decimal comma, or a unit that is not allowed."""
    if isinstance(value, str):
        return "a text with a unit is one number in SI, and this argument is in natural units or a list"
    first = next(iter(np.asarray(value).flat), "")
    if re.fullmatch(r"\s*[+-]?\d+,\d+\s*", str(first)):
        return f"write a decimal point, not a comma, and no quotes: {str(first).strip().replace(',', '.')}"
    return f"in a list write numbers without unit and quotes, not {str(first)[:40]!r}"


class Hinting:
    """Base of public objects: the error about a missing attribute proposes similar attributes."""

    if not TYPE_CHECKING:  # type checkers know that there is none

        def __getattr__(self, name: str) -> Any:
            kind = type(self)
            if any(
                name in vars(base) for base in kind.__mro__
            ):  # a property with an AttributeError of its own
                return object.__getattribute__(self, name)
            told = f"{kind.__name__!r} object has no attribute {name!r}"
            more = "" if name.startswith("_") else _instead_of_attribute(self, name)
            raise AttributeError(f"{told}{more}", name=name, obj=self)


def _instead_of_attribute(thing: object, name: str) -> str:
    """Text that proposes attributes similar to a missing one, or else lists all attributes of the object."""
    for base in type(thing).__mro__:
        if name in _ATTRIBUTES.get(base.__name__, {}):
            return f": {_ATTRIBUTES[base.__name__][name]}"
    names = [x for x in dir(thing) if not x.startswith("_")]
    near = difflib.get_close_matches(name, names, 3, 0.7)
    return f": did you mean {' or '.join(near)}?" if near else f": it has {', '.join(names)}"


class HintingFamily(Hinting):
    """Base of bodies and states: the error about an index says how to take one element of a family."""

    _of_motion: ClassVar[str] = ""  # what gives the states of a motion at one time

    if not TYPE_CHECKING:  # type checkers know that there is no index

        def __getitem__(self, index: Any) -> Any:
            kind, at = type(self).__name__, index if isinstance(index, int) else "i"
            own, parts = kind.lower(), []
            for name, value in ((x.name, getattr(self, x.name)) for x in fields(self)):
                if isinstance(value, tuple) and any(getattr(one, "ndim", 0) for one in value):
                    pair = ", ".join(f"{own}.{name}[{k}][{at}]" for k in range(len(value)))
                    parts.append(f"{name}=({pair})")
                elif getattr(value, "ndim", 0):
                    parts.append(f"{name}={own}.{name}[{at}]")
            how = f"dataclasses.replace({own}, {', '.join(parts)})"
            more = f": index its fields, as in {how}" if parts else ""
            if parts and self._of_motion:
                more = f": {self._of_motion}; of any others index the fields, as in {how}"
            raise TypeError(f"{kind!r} object is not subscriptable{more}")
