"""Conversion of natural units to metres, kilograms and seconds.

Natural units: length R, time sqrt(R/g), speed sqrt(g R), angular velocity sqrt(g/R), force M g, energy M g R.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

from spincyl import _core
from spincyl._input.equality import compared_by_value
from spincyl._input.hints import Hinting
from spincyl._input.numbers import Reals, Result, elementwise, is_quantity, number, reals, si, warn
from spincyl._upward import function_of_method

if TYPE_CHECKING:
    from spincyl._body import Body

_OUTPUTS = {
    "sqrt(R/g)": "t",
    "rad": "theta phi psi",
    "sqrt(g/R)": "w drilling",
    "R": "contact_point centre height",
    "sqrt(g R)": "slip lift slip_other",
    "M g": "normal friction contact_force contact_force_other normal_other friction_other",
    "M g R": "energy dissipated work_lost couple",
}
#: Natural unit of each output of a motion; outputs that are not listed are pure numbers.
UNITS = {name: unit for unit, names in _OUTPUTS.items() for name in names.split()}
_UNITS_WITH_MASS = ("J", "N")
#: A moment of inertia beyond this, in M R^2, was probably not in kg m^2: a rod has it at a length of 350 R.
_LARGE_MOMENT = 1e4


@compared_by_value
@dataclass(frozen=True)
class Scale(Hinting):
    """Size, mass and gravity of a body in SI; methods convert results from natural units to SI.

    Each argument is a number, a text such as "12mm", or a pint quantity in any suitable unit.

    Parameters
    ----------
    radius : float
        Outer radius R of the rim, in metres; for a stone, the largest semi-axis.
    mass : float
        Mass M in kilograms. Forces, energies, and the coefficients of some loss laws depend on it. NaN means
        that the mass is unknown; results that depend on it then raise an error.
    gravity : float
        Acceleration of gravity g, in m/s^2.

    Raises
    ------
    ValueError
        If a value is not between 1e-100 and 1e100; the message names it.
    TypeError
        If a value is not a real number; the message names it.
    """

    radius: float
    mass: float = 1.0
    gravity: float = 9.80665

    def __post_init__(self) -> None:
        units = {"radius": "metre", "mass": "kilogram", "gravity": "metre/second**2"}
        for name, unit in units.items():
            value = number(name, si(name, getattr(self, name), unit))
            object.__setattr__(self, name, value)
        self._units  # noqa: B018 (raises ValueError if a value is out of range)

    @elementwise
    def metres(self, length: Reals) -> Result:
        """Convert a length in R to metres."""
        return reals("length", length) * self._units[0]

    @elementwise
    def seconds(self, time: Reals) -> Result:
        """Convert a time in sqrt(R/g) to seconds."""
        return reals("time", time) * self._units[1]

    @elementwise
    def metres_per_second(self, speed: Reals) -> Result:
        """Convert a speed in sqrt(g R), such as a slip, to metres per second."""
        return reals("speed", speed) * (self._units[0] / self._units[1])

    @elementwise
    def joules(self, energy: Reals) -> Result:
        """Convert an energy in M g R to joules."""
        return reals("energy", energy) * self._joule("an energy")

    @elementwise
    def newtons(self, force: Reals) -> Result:
        """Convert a force in M g, such as `Motion.normal`, to newtons."""
        return reals("force", force) * (self._joule("a force") / self._units[0])

    @elementwise
    def hertz(self, body: "Body", rate: Reals) -> Result:
        """Convert a reduced rate Omega~ = Omega sqrt(I3) of `body` to a precession in turns per second."""
        if not hasattr(body, "angular_rate"):  # `_body` imports this module, so `Body` is not known here
            raise TypeError(f"body: expected a Body, not {type(body).__name__}")
        return body.angular_rate(rate) * self._units[3]

    @elementwise
    def turns(self, angular_velocity: Reals) -> Result:
        """Convert an angular velocity in sqrt(g/R) to turns per second."""
        return reals("angular_velocity", angular_velocity) * self._units[3]

    def _repr_html_(self) -> str:
        return str(function_of_method("card")(self))

    def __reduce__(self) -> tuple[Any, ...]:
        return Scale, (self.radius, self.mass, self.gravity)

    @property
    def _units(self) -> tuple[float, float, float, float]:
        """The natural units in SI: metres, seconds, joules (NaN if the mass is unknown), turns per second."""
        metres, seconds, joules, turns = _core.units(
            self.radius, self.mass if self._is_weighed else 1.0, self.gravity
        )
        return metres, seconds, joules if self._is_weighed else math.nan, turns

    @property
    def _is_weighed(self) -> bool:
        return self.mass == self.mass

    @property
    def _worst(self) -> float:
        """Largest factor to SI of angles, rates, times and slips; it converts a bound on all their errors."""
        metre, second, *_ = self._units
        return max(1.0, 1 / second, second, metre / second)

    def _newton_seconds(self) -> float:
        """The unit of impulse in newton seconds, or ValueError if the mass is unknown."""
        return self._joule("an impulse") * self._units[1] / self._units[0]

    def _joule(self, what: str) -> float:
        """The unit of energy in joules, or ValueError if the mass is unknown."""
        if not self._is_weighed:
            raise ValueError(
                f"{what} in SI needs the mass of the body: give mass=, in kilograms, "
                "or use the body in natural units (.natural)"
            )
        return self._units[2]


def unit_of_output(name: str, scale: Scale | None) -> tuple[float | None, str]:
    """The factor that converts an output to SI (None: no conversion), and the unit after the conversion."""
    return si_factor(UNITS.get(name, "1"), scale)


def si_factor(natural: str, scale: Scale | None) -> tuple[float | None, str]:
    """The factor that converts a natural unit to SI (None: no conversion), and the unit after the conversion.

    Without a mass, forces and energies stay in natural units.
    """
    if scale is None:
        return None, natural
    metre, second, joule, _ = scale._units
    known = {
        "sqrt(R/g)": (second, "s"),
        "R": (metre, "m"),
        "sqrt(g R)": (metre / second, "m/s"),
        "sqrt(g/R)": (1 / second, "rad/s"),
        "g/R": (1 / second**2, "1/s^2"),
        "M g": (joule / metre, "N"),
        "M g R": (joule, "J"),
    }
    factor, said = known.get(natural.replace("a", "R") if natural != "rad" else natural, (None, natural))
    return (None, natural) if said in _UNITS_WITH_MASS and not scale._is_weighed else (factor, said)


def moment_in_natural(name: str, value: Reals, scale: Scale | None) -> float:
    """A moment of inertia in M R^2, from kg m^2, a text with a unit or a quantity."""
    if scale is None or not scale._is_weighed:
        need = "radius and mass: in_metres(mass, radius=, i1=, i3=), or scale=sc.Scale(radius, mass)"
        raise TypeError(f"{name} = {value!r}: a moment in kg m^2 needs {need}")
    found = number(name, si(name, value, "kilogram*metre**2")) / scale.mass / scale.radius**2
    if _LARGE_MOMENT < found < math.inf:
        warn(f"{name}: {found:.3g} M R^2, as of a mass at {math.sqrt(found):.3g} R: is the moment in kg m^2?")
    return found


def moment_as_number(name: str, value: Reals, scale: Scale | None) -> Reals:
    """A moment of inertia in M R^2; only a text with a unit or a quantity is converted."""
    return moment_in_natural(name, value, scale) if isinstance(value, str) or is_quantity(value) else value


def refuse_other_scale(told: str, of: Scale | bool, scale: Scale | None) -> None:
    """Raise ValueError for a coefficient given in SI for a body of another radius or another gravity."""
    if not isinstance(of, Scale) or scale is None:
        return
    if not (math.isclose(of.radius, scale.radius) and math.isclose(of.gravity, scale.gravity)):
        made = f"R = {of.radius:g} m and g = {of.gravity:g} m/s^2"
        raise ValueError(f"{told}: made for another scale, {made}; use from_si(..., scale=body)")


@overload
def scale_of(scale: "Scale | Body", *bodies: "Body") -> Scale: ...
@overload
def scale_of(scale: "Scale | Body | None", *bodies: "Body") -> Scale | None: ...
def scale_of(scale: "Scale | Body | None", *bodies: "Body") -> Scale | None:
    """The given scale, or the common scale of measured bodies; None if there is no scale.

    A measured body may be given in place of a scale.

    Raises
    ------
    ValueError
        If a body has another scale than the given one, or the bodies have different scales.
    TypeError
        If `scale` is no scale, or neither a scale nor a body is given.
    """
    given = scale if scale is None or isinstance(scale, Scale) else getattr(scale, "scale", None)
    if scale is not None and not isinstance(given, Scale):
        more = " without a scale; body.in_metres(...) has one" if hasattr(scale, "scale") else ""
        raise TypeError(f"scale: expected a Scale, not {type(scale).__name__}{more}")
    if scale is None and not bodies:
        raise TypeError("scale: expected a Scale or a measured body, not None")
    for body in bodies:
        own = body.scale
        if own is not None and given is not None and own != given:
            raise ValueError(
                f"scale = {given!r}: the measured body has another scale, {own!r}; leave out scale="
            )
    owns = [body.scale for body in bodies]
    if given is None and any(own != owns[0] for own in owns):
        raise ValueError(
            f"scale: the bodies have different scales, {owns}; give bodies of one scale, or scale="
        )
    return given if given is not None or not owns else owns[0]
