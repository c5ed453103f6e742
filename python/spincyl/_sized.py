"""The size of a body of any kind: tube, ball, stone, or assembled."""

import math
from collections.abc import Callable
from functools import cached_property
from typing import Any, ClassVar, Self

from spincyl._input.hints import with_hints
from spincyl._input.materials import density_in_si
from spincyl._input.numbers import in_range, number, si, warn
from spincyl._input.units import suspicion_of_units
from spincyl._scale import Scale, moment_in_natural


class Sized:
    """Base class of bodies that may be measured: `scale` is None if the size is unknown."""

    scale: Scale | None
    #: The letter of the unit of length: R of a rim, or a, the largest semi-axis of a stone.
    _length: ClassVar[str] = "R"
    #: The unit of length in metres, as far as it is known; an error names `radius`.
    _radius: Callable[[], float]
    #: Kind, length and width, and volume (0 if unknown) of the body, in natural units.
    _bulk: Callable[[], tuple[str, tuple[float, float], float]]
    _with_scale: Callable[..., Self]

    @with_hints
    def in_metres(
        self,
        mass: float | None = None,
        *,
        radius: float | None = None,
        gravity: float | None = None,
        density: float | str | None = None,
        i1: float | None = None,
        i3: float | None = None,
    ) -> Self:
        """Return this body as a measured body, whose motions are in SI.

        Parameters
        ----------
        mass : float, optional
            Mass in kilograms, or a text such as "20g". Default: the mass that the body already has. If it
            has none, the mass is unknown, and results that depend on the mass raise an error.
        radius : float, optional
            Outer radius R of the rim, or largest semi-axis of an `Ellipsoid`, in metres, or a text. Default:
            the radius that the body already has. For a body made from lengths without a unit, by
            `Body.from_metres` or as an `Ellipsoid`, the default takes these lengths as metres.
        gravity : float, optional
            Acceleration of gravity, in m/s^2. Default: the gravity that the body already has, else 9.80665.
        density : float or str, optional
            Mean density in kg/m^3, in place of `mass`, or the name of a material as for `measured`. Only
            for a body of known volume: a ball, an egg or another whole ellipsoid, a tube, or a cylinder.
        i1, i3 : float, optional
            Measured transverse and axial moments of inertia about the centre of mass, in kg m^2, or texts
            such as "320 g mm^2": from a swing or from CAD, for a body of revolution whose mass is known. They
            replace the moments of the body, and a tube loses its `bore`.

        Returns
        -------
        Body or Ellipsoid
            The body with a `scale`. States and methods of the body stay in natural units, except methods
            named after a unit.

        Raises
        ------
        TypeError, ValueError
            If an argument is invalid, or if the body has no size and `radius` is missing; the message names
            the argument. If no body has these moments, as with i3 > 2 i1.

        Warns
        -----
        UserWarning
            If the body is larger than 5 m or smaller than 0.1 mm, or, where the volume is known, its density
            is below that of foam or above that of osmium. Probably millimetres or grams were given for metres
            or kilograms. If a moment is more than 10,000 M R^2; it was probably not in kg m^2.

        Examples
        --------
        >>> import spincyl as sc
        >>> balls = sc.Body.balls(1.2).in_metres("14g", radius="6mm")
        >>> on_the_moon = balls.in_metres(gravity=1.62)
        >>> print(f"{balls.critical_hertz:.2f} Hz, on the Moon {on_the_moon.critical_hertz:.2f} Hz")
        10.17 Hz, on the Moon 4.13 Hz
        >>> can = sc.Body.solid(1.8).in_metres("384g", radius="33mm", i1="5.3e-4 kg m^2", i3="3.4e-5 kg m^2")
        >>> round(can.i1, 4), round(can.i3, 4)  # of a full can, whose water does not turn with it
        (1.2674, 0.0813)
        """
        given = {name: x for name, x in (("i1", i1), ("i3", i3)) if x is not None}
        if given and self._length != "R":
            raise TypeError("i1, i3: only for bodies of revolution; make a stone with inertia=, per mass")
        own = self.scale or Scale(1.0, math.nan)
        size = self._radius() if radius is None else number("radius", si("radius", radius, "metre"))
        weight = own.mass
        if mass is not None:
            weight = number("mass", si("mass", mass, "kilogram"))
            if math.isnan(weight):
                raise ValueError("mass = nan: expected kilograms, or no mass= if the mass is unknown")
        if density is not None:
            if mass is not None:
                raise TypeError("mass, density: give only one of them")
            dense = in_range("density", density_in_si(density), 1e-100, 1e100, "kg/m^3")
            weight = dense * self._volume() * size**3
        scale = Scale(size, weight, own.gravity if gravity is None else gravity)
        why = self._doubt_of(scale)
        if why:
            warn(why)
        moments = {name: moment_in_natural(name, x, scale) for name, x in given.items()}
        try:
            return self._with_scale(scale, **moments)
        except ValueError as e:
            one = f"; M R^2 is {scale.mass * scale.radius**2:.4g} kg m^2 for this body" if moments else ""
            raise ValueError(f"{e}{one}") from None

    def _volume(self) -> float:
        """Volume in natural units; ValueError if it is not known exactly."""
        what, _, volume = self._bulk()
        family = getattr(self, "shape", ()) != ()
        if family or not volume or (what == "stone" and not math.isnan(getattr(self, "theta_end", math.nan))):
            raise ValueError(
                "density: expected a single body whose volume is known; for any other give mass="
            )
        return volume

    @property
    def natural(self) -> Self:
        """The same body without its scale, in natural units."""
        return self if self.scale is None else self._natural

    @cached_property
    def _natural(self) -> Self:
        return self._with_scale(None)

    def _sized(self, what: str) -> Scale:
        """The scale of the body; AttributeError says how to give the body one."""
        if self.scale is None:
            how = "as sc.measured(...) makes for a tube, body.in_metres(radius=...) for any other"
            raise AttributeError(f"{what}: needs a measured body, {how}")
        return self.scale

    def _check_scale(self) -> None:
        """Raise TypeError if the field `scale` is neither a `Scale` nor None."""
        given: Any = self.scale
        if given is not None and not isinstance(given, Scale):
            raise TypeError(f"scale: expected a Scale, not {type(given).__name__}")

    def _doubt_of(self, scale: Scale) -> str:
        """Why millimetres or grams are suspected in a size; empty if they are not."""
        what, (length, width), volume = self._bulk()
        r = scale.radius
        return suspicion_of_units(what, (length * r, width * r), volume * r**3, scale.mass)
