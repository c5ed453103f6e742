"""The size of a body, of whatever kind: tube, ball, stone, or put together."""

import math
from collections.abc import Callable
from functools import cached_property
from typing import Self

from spincyl._input.numbers import number, si, warn
from spincyl._input.units import dubious
from spincyl._scale import Scale


class Sized:
    """Base of bodies that may know their size: `scale` is None, or that of a measured body."""

    scale: Scale | None
    #: The unit of length in metres, as far as it is known; an error names `radius`.
    _radius: Callable[[], float]
    #: What the body is, how long and how wide, and its volume, 0 if it is not known; in natural units.
    _bulk: Callable[[], tuple[str, tuple[float, float], float]]
    _with_scale: Callable[[Scale | None], Self]

    def in_metres(
        self, mass: float | None = None, *, radius: float | None = None, gravity: float | None = None
    ) -> Self:
        """The same body, measured: its motions are asked for in seconds and told in SI.

        Parameters
        ----------
        mass : float, optional
            In kilograms, or a text such as "20g". Default: its own if it is measured, else it is not known,
            and what depends on it is refused.
        radius : float, optional
            The unit of length of its numbers in metres, or a text: the outer radius R of its rim, of an
            `Ellipsoid` the largest semi-axis. Default: its own if it is measured, else that of the lengths
            which `Body.from_metres` or the `Ellipsoid` was given, as metres.
        gravity : float, optional
            In m/s^2. Default: its own, or 9.80665.

        Returns
        -------
        Body or Ellipsoid
            With its `scale`. States, and what is asked of the body itself, stay in natural units, but for
            what has a unit in its name.

        Raises
        ------
        TypeError, ValueError
            Naming the argument; of a body that has no size yet, `radius`.

        Warns
        -----
        UserWarning
            If it is larger than 5 m, smaller than 0.1 mm or, where the volume is known, lighter than foam or
            heavier than osmium, as if millimetres or grams were taken for metres or kilograms.

        Examples
        --------
        >>> import spincyl as sc
        >>> balls = sc.Body.balls(1.2).in_metres("14g", radius="6mm")
        >>> on_the_moon = balls.in_metres(gravity=1.62)
        >>> print(f"{balls.critical_hertz:.2f} Hz, on the Moon {on_the_moon.critical_hertz:.2f} Hz")
        10.17 Hz, on the Moon 4.13 Hz
        """
        own = self.scale or Scale(1.0, math.nan)
        size = self._radius() if radius is None else number("radius", si("radius", radius, "metre"))
        weight = own.mass
        if mass is not None:
            weight = number("mass", si("mass", mass, "kilogram"))
            if math.isnan(weight):
                raise ValueError("mass = nan: expected kilograms, or no mass= if it is not known")
        scale = Scale(size, weight, own.gravity if gravity is None else gravity)
        why = self._doubt_of(scale)
        if why:
            warn(why)
        return self._with_scale(scale)

    @property
    def natural(self) -> Self:
        """The same body in natural units: without its scale."""
        return self if self.scale is None else self._natural

    @cached_property
    def _natural(self) -> Self:
        return self._with_scale(None)

    def _sized(self, what: str) -> Scale:
        """The scale of the body, or AttributeError that says how to give the body one."""
        if self.scale is None:
            how = "sc.measured(...) makes a tube that does, body.in_metres(radius=...) any"
            raise AttributeError(f"{what}: the body does not know its size; {how}")
        return self.scale

    def _doubt_of(self, scale: Scale) -> str:
        """A reason to suspect millimetres or grams in a size; empty if there is none."""
        what, (length, width), volume = self._bulk()
        r = scale.radius
        return dubious(what, (length * r, width * r), volume * r**3, scale.mass)
