"""Natural units to metres, kilograms and seconds."""

from dataclasses import dataclass

from spincyl import _core
from spincyl._array import Reals, Result, number, reals
from spincyl._body import Body


@dataclass(frozen=True)
class Scale:
    """SI scale of a body.

    Parameters
    ----------
    radius : float
        Rim radius R in metres.
    mass : float
        Mass M in kilograms; only energies depend on it.
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
        for name in ("radius", "mass", "gravity"):
            object.__setattr__(self, name, number(name, getattr(self, name)))
        _core.units(self.radius, self.mass, self.gravity)

    def metres(self, length: Reals) -> Result:
        """A length in R as metres."""
        return reals("length", length) * self._units[0]

    def seconds(self, time: Reals) -> Result:
        """A time in sqrt(R/g) as seconds."""
        return reals("time", time) * self._units[1]

    def metres_per_second(self, speed: Reals) -> Result:
        """A speed in sqrt(g R), such as that of a slip, as metres per second."""
        return reals("speed", speed) * (self._units[0] / self._units[1])

    def joules(self, energy: Reals) -> Result:
        """An energy in M g R as joules."""
        return reals("energy", energy) * self._units[2]

    def hertz(self, body: Body, rate: Reals) -> Result:
        """Turns per second of a reduced rotation rate Omega~ = Omega sqrt(I3) of `body`."""
        if not isinstance(body, Body):
            raise TypeError(f"body: expected a Body, not {type(body).__name__}")
        return body.angular_rate(rate) * self._units[3]

    def turns(self, angular_velocity: Reals) -> Result:
        """Turns per second of an angular velocity in sqrt(g/R)."""
        return reals("angular_velocity", angular_velocity) * self._units[3]

    def _repr_html_(self) -> str:
        from spincyl import _html

        return _html.scale(self)

    @property
    def _units(self) -> tuple[float, float, float, float]:
        return _core.units(self.radius, self.mass, self.gravity)
