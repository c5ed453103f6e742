"""Natural units to metres, kilograms and seconds.

Length R, time sqrt(R/g), speed sqrt(g R), angular velocity sqrt(g/R), force M g, energy M g R.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

from spincyl import _core
from spincyl._input.equality import compared
from spincyl._input.numbers import Reals, Result, elementwise, number, reals, si
from spincyl._upward import above

if TYPE_CHECKING:
    from spincyl._body import Body

_OUTPUTS = {
    "sqrt(R/g)": "t",
    "rad": "theta phi psi",
    "sqrt(g/R)": "w drilling",
    "R": "contact_point centre height",
    "sqrt(g R)": "slip lift slip_other",
    "M g": "normal friction contact_force normal_other friction_other",
    "M g R": "energy dissipated work_lost couple",
}
#: Natural unit of each output of a motion; outputs that are not listed are pure numbers.
UNITS = {name: unit for unit, names in _OUTPUTS.items() for name in names.split()}
_WEIGHED = ("J", "N")


@compared
@dataclass(frozen=True)
class Scale:
    """SI scale of a body.

    Numbers, or quantities of pint's in any unit of their kind.

    Parameters
    ----------
    radius : float
        Rim radius R in metres.
    mass : float
        Mass M in kilograms; forces and energies depend on it, and coefficients of losses
        (`loss.AirFilm.from_si`). NaN: it is not known, and what depends on it is refused.
    gravity : float
        In m/s^2.

    Raises
    ------
    ValueError
        Naming the value that is not between 1e-100 and 1e100.
    TypeError
        Naming the value that is no real number.
    """

    radius: float
    mass: float = 1.0
    gravity: float = 9.80665

    def __post_init__(self) -> None:
        units = {"radius": "metre", "mass": "kilogram", "gravity": "metre/second**2"}
        for name, unit in units.items():
            value = number(name, si(name, getattr(self, name), unit))
            object.__setattr__(self, name, value)
        self._units  # noqa: B018 (refuses what is out of range)

    @elementwise
    def metres(self, length: Reals) -> Result:
        """A length in R as metres."""
        return reals("length", length) * self._units[0]

    @elementwise
    def seconds(self, time: Reals) -> Result:
        """A time in sqrt(R/g) as seconds."""
        return reals("time", time) * self._units[1]

    @elementwise
    def metres_per_second(self, speed: Reals) -> Result:
        """A speed in sqrt(g R), such as that of a slip, as metres per second."""
        return reals("speed", speed) * (self._units[0] / self._units[1])

    @elementwise
    def joules(self, energy: Reals) -> Result:
        """An energy in M g R as joules."""
        return reals("energy", energy) * self._joule("an energy")

    @elementwise
    def newtons(self, force: Reals) -> Result:
        """A force in M g, such as `Motion.normal`, as newtons."""
        return reals("force", force) * (self._joule("a force") / self._units[0])

    @elementwise
    def hertz(self, body: "Body", rate: Reals) -> Result:
        """Turns per second of a reduced rotation rate Omega~ = Omega sqrt(I3) of `body`."""
        if not hasattr(body, "angular_rate"):  # `_body` imports this module, so `Body` is not known here
            raise TypeError(f"body: expected a Body, not {type(body).__name__}")
        return body.angular_rate(rate) * self._units[3]

    @elementwise
    def turns(self, angular_velocity: Reals) -> Result:
        """Turns per second of an angular velocity in sqrt(g/R)."""
        return reals("angular_velocity", angular_velocity) * self._units[3]

    def _repr_html_(self) -> str:
        return str(above("card")(self))

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
        """The largest of the units of states, slips and times, which converts a bound of all their errors."""
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
                "or ask the natural body (.natural) in natural units"
            )
        return self._units[2]


def unit(name: str, scale: Scale | None) -> tuple[float | None, str]:
    """The factor that converts an output of a motion, None without a conversion, and the resulting unit."""
    return si_of(UNITS.get(name, "1"), scale)


def si_of(natural: str, scale: Scale | None) -> tuple[float | None, str]:
    """The factor that converts from a natural unit, None without a conversion, and the resulting unit.

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
    return (None, natural) if said in _WEIGHED and not scale._is_weighed else (factor, said)


def other(told: str, of: Scale | bool, scale: Scale | None) -> None:
    """Refuse a coefficient that was given in SI for a body of another radius, or under another gravity."""
    if not isinstance(of, Scale) or scale is None:
        return
    if not (math.isclose(of.radius, scale.radius) and math.isclose(of.gravity, scale.gravity)):
        made = f"R = {of.radius:g} m and g = {of.gravity:g} m/s^2"
        raise ValueError(f"{told} was made for {made}, which this body has not: from_si(..., scale=body)")


@overload
def scale_of(scale: "Scale | Body", *bodies: "Body") -> Scale: ...
@overload
def scale_of(scale: "Scale | Body | None", *bodies: "Body") -> Scale | None: ...
def scale_of(scale: "Scale | Body | None", *bodies: "Body") -> Scale | None:
    """The given scale, or the common scale of measured bodies; None without any.

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
        more = " that is not measured: body.in_metres(...) is" if hasattr(scale, "scale") else ""
        raise TypeError(f"scale: expected a Scale, not {type(scale).__name__}{more}")
    if scale is None and not bodies:
        raise TypeError("scale: expected a Scale or a measured body, not None")
    for body in bodies:
        own = body.scale
        if own is not None and given is not None and own != given:
            raise ValueError(f"scale = {given!r} is not that of the measured body, {own!r}: leave it out")
    owns = [body.scale for body in bodies]
    if given is None and any(own != owns[0] for own in owns):
        raise ValueError(f"scale: the bodies have different ones, {owns}: give those of one scale, or scale=")
    return given if given is not None or not owns else owns[0]
