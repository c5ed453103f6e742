"""Bodies of several circles, from their circles or from the outline of a uniform solid."""

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from spincyl import _core
from spincyl._circles import rows_of
from spincyl._input.numbers import (
    Reals,
    elementwise,
    in_range,
    is_scalar,
    lengths_in_metres,
    metres,
    number,
    reals,
)
from spincyl._scale import Scale, moment_as_number


class Outlines:
    """Base of `Body`: its constructors of bodies with several circles."""

    _unit: ClassVar[float] = np.nan  # R in the unit of the lengths from which the body was made
    in_metres: Callable[..., Self]

    def __init_subclass__(cls) -> None:
        # an error about arguments names the class that users know
        for name, made in vars(Outlines).items():
            if isinstance(made, classmethod):
                for call in (made.__func__, getattr(made.__func__, "__wrapped__", made.__func__)):
                    call.__qualname__ = f"{cls.__name__}.{name}"

    if TYPE_CHECKING:

        def __init__(self, *numbers: Reals, **more: Any) -> None: ...

    @classmethod
    def profile(cls, circles: Iterable[Sequence[float]], i1: float, i3: float, centre: float = 0.0) -> Self:
        """Any body of revolution, from the circles on which it can stand: a cup, a cone, a bottle, a wheel.

        Parameters
        ----------
        circles : rows of float
            Radius and height of each circle, and optionally the radius of its fillet, in R, from the lower
            end of the body up. A tip is a circle of radius 0, a ball one of radius 0 with a fillet. A circle
            inside the convex hull of the others never touches the table and is left out.
        i1, i3 : float
            Transverse and axial moments of inertia about the centre of mass, in M R^2.
        centre : float
            Height of the centre of mass; heights are measured from any point of the axis.

        Raises
        ------
        ValueError
            If one circle lies inside another, the circles are not in order, or no body has these numbers.

        Warns
        -----
        UserWarning
            If a circle lies in line with two others, so that all three would touch the table together.

        Notes
        -----
        The unit of length R is any length, such as the largest radius. One circle of outer radius 1, and two
        such circles that mirror each other, are the body that `Body(...)` makes.

        Examples
        --------
        >>> import spincyl as sc
        >>> cup = sc.Body.profile([(0.7, 0.0), (1.0, 2.0)], i1=0.51, i3=0.38, centre=1.1)
        >>> cup.borders.round(4)
        array([1.4219])
        """
        middle = in_range("centre", centre, -1e100, 1e100, "R")
        rows = rows_of("circles", circles, 2, 3)
        rims = [[radius, height - middle, *(fillet or [0.0])] for radius, height, *fillet in rows]
        return cls(np.nan, number("i1", i1), number("i3", i3), rims=rims)

    @classmethod
    def frustum(cls, bottom: float, top: float, height: float, wall: float | None = None) -> Self:
        """Uniform frustum of a cone, solid or hollow, such as a cup without a floor.

        Parameters
        ----------
        bottom, top, height : float
            Radii of the lower and the upper end, and height, all in one unit or as texts such as "35mm". The
            body is in units of the larger radius R; `in_metres` takes numbers without a unit as metres.
        wall : float, optional
            Thickness of the wall of a hollow frustum, measured perpendicular to the axis; 0 is a thin wall.

        Examples
        --------
        >>> import spincyl as sc
        >>> cup = sc.Body.frustum("25mm", "35mm", "90mm", wall=0.0).in_metres("7g")
        >>> cup.apex().rate.round(4), round(cup.scale.radius, 4)
        (np.float64(0.3127), 0.035)
        """
        named = {"bottom": bottom, "top": top, "height": height} | ({} if wall is None else {"wall": wall})
        lower, upper, tall, *thick = metres(lengths_in_metres("", named)[0]).values()
        return cls._made(_core.frustum(lower, upper, tall, thick[0] if thick else None), max(lower, upper))

    @classmethod
    def cone(cls, height: float) -> Self:
        """Uniform solid cone that stands on its tip; `height` is in units of the radius R of its base."""
        return cls._made(_core.frustum(0.0, 1.0, number("height", height), None))

    @classmethod
    def lathe(cls, points: Iterable[Sequence[float]]) -> Self:
        """Uniform solid of revolution, from the corners of its outline of straight lines.

        Parameters
        ----------
        points : rows of float
            Radius and height of each corner of the outline, from the lower end of the body to its upper end,
            all in one unit or as texts such as "35mm"; the body is in units of its largest radius R. The
            outline may go down into the body, as inside a cup, but must not cross itself.

        Examples
        --------
        >>> import spincyl as sc
        >>> cup = sc.Body.lathe([(0.7, 0), (1, 2), (0.95, 2), (0.66, 0.05), (0, 0.05)])
        >>> cup.circles.shape
        (2, 3)
        """
        rows = rows_of("points", points, 2, metre="metre")
        return cls._made(_core.lathe(rows), max(radius for radius, _ in rows))

    @classmethod
    def balls(
        cls,
        separation: float = 1.0,
        *,
        radii: tuple[float, float] | None = None,
        diameter: float | None = None,
        mass: float | None = None,
    ) -> Self:
        """Two solid balls of one density that are fixed to each other: Hurricane balls.

        Parameters
        ----------
        separation : float
            Distance between the centres over the sum of the radii: 1 if the balls touch, more if a light rod
            joins them.
        radii : two of float, optional
            Radii of the lower and the upper ball, of one density. R is the larger one. Default: equal balls.
        diameter, mass : float, optional
            Diameter of the larger ball in metres and mass of both in kilograms; a diameter makes a measured
            body.

        Notes
        -----
        Jackson, Mertens, Pearson, Am. J. Phys. 83, 959 (2015). The upper one of equal balls lands at
        theta = pi/2.
        """
        pair = [1.0, 1.0] if radii is None else rows_of("radii", [radii], 2, metre="metre")[0]
        if pair[0] != pair[1]:
            body = cls._made(_core.unequal_balls(pair, number("separation", separation)), max(pair))
            return body._across(diameter, mass)
        i1, theta_end = _core.check_balls(separation := number("separation", separation))
        return cls(separation, i1, 0.4, fillet=1.0, theta_end=theta_end)._across(diameter, mass)

    @classmethod
    @elementwise
    def ball(
        cls, offset: Reals, i1: Reals, i3: Reals, *, diameter: float | None = None, mass: float | None = None
    ) -> Self:
        """Ball whose centre of mass lies `offset` radii above its centre; negative for a tippe top.

        `i1`, `i3`: transverse and axial moments of inertia about the centre of mass, in M R^2. The axis may
        pass through the vertical. A `diameter` in metres makes a measured body; its `mass` is in kilograms.
        With both, a moment may also be a text such as "3.2e-6 kg m^2".
        """
        scale = None if diameter is None or mass is None else Scale(_half(diameter), mass)
        moments = [moment_as_number(name, x, scale) for name, x in (("i1", i1), ("i3", i3))]
        given = [reals(name, x) for name, x in zip(("offset", "i1", "i3"), (offset, *moments), strict=True)]
        if is_scalar(*given):
            _core.check_ball(*map(float, given))
        return cls(*given, fillet=1.0)._across(diameter, mass)

    @classmethod
    def _made(cls, numbers: Any, unit: float = np.nan, scale: Scale | None = None) -> Self:
        """Make a body from the result of the core; `unit` is R in the unit in which lengths were given."""
        (*six, fillet, theta_end), rims = numbers
        more = {"rims": rims} if rims else {"fillet": fillet, "theta_end": theta_end}
        body = cls(*six[: 3 if rims else 4], **more, scale=scale)
        object.__setattr__(body, "_unit", unit)
        return body

    def _across(self, diameter: float | None, mass: float | None) -> Self:
        """Return this body of one ball or two, as a measured body if a diameter is given."""
        if diameter is None:
            if mass is not None:
                raise ValueError(f"mass = {mass!r}: give the diameter of the balls as well, in metres")
            return self
        return self.in_metres(mass, radius=_half(diameter))


def _half(diameter: float) -> float:
    """Half of a diameter, in metres; the diameter is a number in metres or a text with a unit."""
    return in_range("diameter", metres({"diameter": diameter})["diameter"], 2e-100, 2e100, "metres") / 2
