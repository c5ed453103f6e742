"""Loss laws, which take energy from a body as it spins and rolls, until it comes to rest.

Each law is a couple on the body, with one positive coefficient. Laws are added with `+`. Which law stops a
coin has been debated for twenty-five years. The library prefers none: fit the laws and compare them.

Symbols: w is the angular velocity of the body, with the components w1, w2, w3 along e1, e2, e3 of `State`.
The letters s and c are the sine and cosine of theta, z is the vertical, and h = c e1 - s e3 is horizontal.
The spin is psi' = w3 - w1 c/s. The component of w along h is the rolling, w_h = -s psi'; along e2, the
rocking, w2; along z, the drilling, w_z = s w1 + c w3. N is the normal force. A is the radius of the circle of
the body along which it touches the table (1 for a sharp rim). The table gives the power P that each law
takes, and its `exponent` n: theta of a thin disk falls as (remaining time)^n::

    DryContour(eps)           P = eps N A |psi'|                      2/3
    ViscousContour(c)         P = c (A psi')^2                        1/2
    RollingResistance(delta)  P = delta N sqrt(w_h^2 + w2^2)          2
    Drilling(length)          P = length N |w_z|                      none: the disk never stops
    AirLinear(b)              P = b w.w                               none
    AirQuadratic(b2)          P = b2 |w|^3                            none
    AirFilm(viscosity)        P = (pi/4) viscosity psi'^2/s           1/3
    BoundaryLayer(k)          P = k |psi'|^(5/2)                      4/9

>>> import spincyl as sc
>>> disk = sc.Body.solid(0.1704)  # Euler's disk
>>> losses = sc.loss.DryContour(5e-3) + sc.loss.AirFilm(1e-7)
>>> float(losses.power(disk, disk.steady(0.1)).round(6))
0.030647
"""

from dataclasses import dataclass, field
from typing import Any, Self, TypeVar

import numpy as np

from spincyl._body import Body
from spincyl._contact import CODES
from spincyl._input.numbers import Reals, Result, common_shape, flag
from spincyl._loss import (
    LAWS,
    Law,
    Loss,
    Sum,
    arm_in_radii,
    divided_by_unit,
    marked_as_si,
    natural_units_in_si,
    positive_coefficient,
)
from spincyl._scale import Scale
from spincyl._upward import function_of_method

__all__ = [
    "AirFilm",
    "AirLinear",
    "AirQuadratic",
    "BoundaryLayer",
    "Drilling",
    "DryContour",
    "Law",
    "Loss",
    "RollingResistance",
    "Sum",
    "ViscousContour",
]

_Kind = TypeVar("_Kind", bound=Law)


def __getattr__(name: str) -> Any:
    if name != "typical":
        raise AttributeError(f"module 'spincyl.loss' has no attribute {name!r}")
    return function_of_method("loss.typical")()


def __dir__() -> list[str]:
    return [*__all__, "typical", *(name for name in globals() if name.startswith("__"))]


_AIR_VISCOSITY, _AIR_DENSITY = 1.8e-5, 1.2  # Pa s, kg/m^3


@dataclass(frozen=True, eq=False, repr=False)
class DryContour(Law):
    """Dry friction along the contour of the rim: ``P = eps N A |psi'|``.

    P is the power that the law takes, N the normal force, psi' the spin and A psi' the speed of the contact
    point along the rim; A is the distance of the contact point from the axis, 1 for a sharp rim and
    1 - fillet + fillet sin(theta) for a rounded one. The couple is m = eps N A sgn(psi') h/sin(theta), with
    the horizontal unit vector h in the vertical plane through the axis (e_h of `State`): as if the normal
    force acted ahead of the contact point by eps A/sin(theta).
    At theta below about eps it would act outside the rim, which is impossible. Source: Le Saux, Leine and
    Glocker, J. Nonlinear Sci. 15, 27 (2005).

    Parameters
    ----------
    eps : array_like
        Coefficient in R, positive: about 1e-3 for a coin that stops after seconds, 1e-4 for Euler's disk.
    """

    eps: Reals
    _example = "5e-3", "0.2mm", "dry friction along the rim"

    @classmethod
    def from_si(cls, eps: Reals, *, scale: Scale | Body) -> Self:
        """Make the law from `eps` in metres, or a text like "0.1mm", for a measured body or its `Scale`."""
        return marked_as_si(cls(arm_in_radii("eps", eps, scale)), scale)


@dataclass(frozen=True, eq=False, repr=False)
class ViscousContour(Law):
    """Viscous friction along the contour of the rim: P = c (A psi')^2.

    P is the power that the law takes, psi' the spin and A psi' the speed of the contact point along the rim,
    as for `DryContour`. The couple is m = c A^2 psi' h/s, with s = sin(theta) and the horizontal vector h,
    which is e_h of `State`. Source: Leine, Arch. Appl. Mech. 79, 1063 (2009). McDonald and McDonald, arXiv
    physics/0008227, observed a power that grows as the square of the rate.

    Parameters
    ----------
    c : array_like
        Coefficient in M R sqrt(g R), positive.
    """

    c: Reals
    _example = "1e-3", "1e-6Nms", "friction along the rim, proportional to the speed of the contact point"

    @classmethod
    def from_si(cls, c: Reals, *, scale: Scale | Body) -> Self:
        """Make the law from `c` in N m s, for a measured body with a known mass, or its `Scale`."""
        return marked_as_si(
            cls(
                divided_by_unit(
                    positive_coefficient("c", c, "newton*metre*second"), _newton_metre_seconds(scale)
                )
            ),
            scale,
        )


@dataclass(frozen=True, eq=False, repr=False)
class RollingResistance(Law):
    """Rolling resistance with the classical arm delta: P = delta N sqrt(w_h^2 + w2^2).

    P is the power that the law takes, N the normal force. The angular velocity has the horizontal components
    w_h along e_h of `State` and w2 along e2; the rest of it, about the vertical, is not resisted. The normal
    force acts ahead of the contact point by the arm delta. The couple along e1, e2, e3 is
    m = -delta N (cos(theta) w_h, w2, -sin(theta) w_h)/sqrt(w_h^2 + w2^2). It acts whether the contact point
    slips or not, unless `while_slipping` is false. This law alone stops a coin in a finite time, but after
    infinitely many turns.

    Parameters
    ----------
    delta : array_like
        Arm of the normal force, in R, positive.
    while_slipping : bool
        If false, the law acts only while the contact point does not slip, as in most programs for billiards.
        Such a motion needs ``contact=sc.Coulomb(mu)`` without a patch, or "rolling", and is that of a body of
        revolution, not of a stone. The motion ends where the body lies on two rims (`Ending.SIDE`), and where
        friction cannot hold the contact point of the rolling body, and could without the law
        (`Ending.PAINLEVE`); a start in such a state is an error. `power`, `couple` and a drift are those of
        a body that rolls.
    """

    delta: Reals
    while_slipping: bool = field(default=True, kw_only=True)
    _example = "1e-3", "0.04mm", "rolling resistance: distance of the normal force ahead of the contact"

    def __post_init__(self) -> None:
        super().__post_init__()
        flag("while_slipping", self.while_slipping)

    @classmethod
    def from_si(cls, delta: Reals, *, scale: Scale | Body, while_slipping: bool = True) -> Self:
        """Make the law from `delta` in metres, or a text like "0.1mm", for a measured body or `Scale`."""
        arm = arm_in_radii("delta", delta, scale)
        return marked_as_si(cls(arm, while_slipping=while_slipping), scale)

    @property
    def _acts_in_slip(self) -> bool:
        return self.while_slipping


@dataclass(frozen=True, eq=False, repr=False)
class Drilling(Law):
    """Friction of the patch of contact as it rotates on the table: ``P = length N |w_z|``.

    P is the power that the law takes, N the normal force, and w_z the angular velocity about the vertical z.
    The couple is m = -length N sgn(w_z) z. This law alone never stops a thin disk; it does stop a disk of
    finite height. Source: Contensou (1963); Leine, Arch. Appl. Mech. 79, 1063 (2009).

    Parameters
    ----------
    length : array_like
        Coefficient in R, positive. If the pressure is uniform, this is two thirds of the product of the
        coefficient of friction and the radius of the patch.
    """

    length: Reals
    _example = "1e-3", "0.04mm", "friction against rotation about the vertical"

    @classmethod
    def from_si(cls, length: Reals, *, scale: Scale | Body) -> Self:
        """Make the law from `length` in metres, or a text like "0.1mm", for a measured body or `Scale`."""
        return marked_as_si(cls(arm_in_radii("length", length, scale)), scale)


@dataclass(frozen=True, eq=False, repr=False)
class AirLinear(Law):
    """Air drag linear in the angular velocity (Stokes): P = b w.w.

    P is the power that the law takes, w the vector of the angular velocity. The couple is m = -b w.

    Parameters
    ----------
    b : array_like
        Coefficient in M R sqrt(g R), positive.
    """

    b: Reals
    _example = "1e-4", "1e-7Nms", "air resistance proportional to the angular velocity"

    @classmethod
    def from_si(cls, b: Reals, *, scale: Scale | Body) -> Self:
        """Make the law from `b` in N m s, for a measured body with a known mass, or its `Scale`."""
        return marked_as_si(
            cls(
                divided_by_unit(
                    positive_coefficient("b", b, "newton*metre*second"), _newton_metre_seconds(scale)
                )
            ),
            scale,
        )


@dataclass(frozen=True, eq=False, repr=False)
class AirQuadratic(Law):
    """Air drag quadratic in the angular velocity (Newton): ``P = b2 |w|^3``.

    P is the power that the law takes, w the vector of the angular velocity. The couple is ``m = -b2 |w| w``.

    Parameters
    ----------
    b2 : array_like
        Coefficient in M R^2, positive. For a long rod in air it is about (Cd/2) (density R^3/M) ell^4, with
        the drag coefficient Cd.
    """

    b2: Reals
    _example = "1e-5", "1e-9Nms2", "air resistance proportional to the square of the angular velocity"

    @classmethod
    def from_si(cls, b2: Reals, *, scale: Scale | Body) -> Self:
        """Make the law from `b2` in N m s^2, for a measured body with a known mass, or its `Scale`."""
        _, seconds, joules = natural_units_in_si(scale, weighed=True)
        return marked_as_si(
            cls(
                divided_by_unit(positive_coefficient("b2", b2, "newton*metre*second**2"), joules * seconds**2)
            ),
            scale,
        )


@dataclass(frozen=True, eq=False, repr=False)
class AirFilm(Law):
    """A viscous film of air between a flat face and the table: P = (pi/4) viscosity psi'^2/sin(theta).

    P is the power that the law takes, psi' the rate of the spin about the axis. The couple is m = (pi/4)
    viscosity psi' h/sin(theta)^2, along the horizontal vector h, which is e_h of `State`. Source: Moffatt,
    Nature 404, 833 (2000). The film fills the gap only where theta^(3/4) is below nu^(1/2) (R/(4 g))^(1/4)/R,
    with the kinematic viscosity nu of air; for Euler's disk, below 0.005 rad. At larger inclinations use
    `BoundaryLayer`. The drift of a measured body that starts at a larger inclination issues a warning.

    Parameters
    ----------
    viscosity : array_like
        Viscosity of the air, in M g^(1/2)/R^(3/2), positive: 9.5e-8 for air under Euler's disk. The factor
        pi/4 of the power P is Moffatt's estimate. Lubrication theory without pressure at the rim gives the
        factor 1.2811; to use it, multiply `viscosity` by 1.63.
    """

    viscosity: Reals
    _example = "1e-7", "18uPas", "thin film of air under the face: viscosity of the air"

    @classmethod
    def from_si(cls, viscosity: Reals = _AIR_VISCOSITY, *, scale: Scale | Body) -> Self:
        """Make the law from `viscosity` in Pa s (default: air), for a body with a mass, or its `Scale`."""
        unit = _newton_metre_seconds(scale)
        with np.errstate(over="ignore"):
            found = (
                positive_coefficient("viscosity", viscosity, "pascal*second")
                * natural_units_in_si(scale)[0] ** 3
                / unit
            )
        return _law_of_quantities(cls, found, "viscosity", scale)


@dataclass(frozen=True, eq=False, repr=False)
class BoundaryLayer(Law):
    """Boundary layers of the air that a flat face presses out below it: ``P = k |psi'|^(5/2)``.

    P is the power that the law takes, psi' the rate of the spin about the axis. The couple is
    ``m = k |psi'|^(3/2) sgn(psi') h/s``, with s = sin(theta) and the horizontal vector h, which is e_h of
    `State`. Source: Bildsten, Phys. Rev. E 66, 056309 (2002). The law holds at inclinations so large that the
    film of `AirFilm` does not fill the gap.

    Parameters
    ----------
    k : array_like
        Coefficient in M g^(1/4) R^(7/4), positive. It is C sqrt(density viscosity) R^(9/4)/(M g^(1/4)), with
        density and viscosity of the air, and a number C of order 0.1.
    """

    k: Reals
    _example = "1e-6", "0.1C", "boundary layer of air under the face; C is a number of order 0.1"

    @classmethod
    def from_si(
        cls,
        C: Reals,
        *,
        scale: Scale | Body,
        density: Reals = _AIR_DENSITY,
        viscosity: Reals = _AIR_VISCOSITY,
    ) -> Self:
        """Make the law from the number `C`, of order 0.1, and density (kg/m^3) and viscosity (Pa s) of air.

        `scale` is a measured body with a known mass, or a `Scale`.
        """
        metres, seconds, joules = natural_units_in_si(scale, weighed=True)
        density = positive_coefficient("density", density, "kilogram/metre**3")
        viscosity, C = (
            positive_coefficient("viscosity", viscosity, "pascal*second"),
            positive_coefficient("C", C),
        )
        common_shape({"C": C, "density": density, "viscosity": viscosity})
        with np.errstate(over="ignore"):
            found = C * np.sqrt(density * viscosity) * metres**4 / (joules * seconds**1.5)
        return _law_of_quantities(cls, found, "C, density, viscosity", scale)


def _law_of_quantities(kind: type[_Kind], coefficient: Reals, names: str, scale: Scale | Body) -> _Kind:
    """A law with this coefficient; a ValueError names the quantities from which it was computed."""
    try:
        return marked_as_si(kind(coefficient), scale)
    except ValueError as e:
        raise ValueError(f"{names}: {e}") from None


#: The laws by the names of their coefficients, in the order of the core.
KINDS: dict[str, type[Law]] = dict(zip(LAWS, map(globals().__getitem__, CODES["Law"]), strict=True))


def film_fills(viscosity: Reals, scale: Scale) -> Result:
    """Inclination, in radians, below which the film of `AirFilm` fills the gap, for a body of this scale.

    The gas has the density of air. NaN if the mass is unknown.
    """
    metres, seconds, joules = natural_units_in_si(scale)
    kinematic = np.asarray(viscosity) * (seconds * joules / metres**3) / _AIR_DENSITY
    return (np.sqrt(kinematic * seconds / 2) / metres) ** (4 / 3)


def _newton_metre_seconds(scale: Scale | Body) -> float:
    """The unit of a couple over an angular velocity, M R sqrt(g R), in N m s."""
    _, seconds, joules = natural_units_in_si(scale, weighed=True)
    return seconds * joules
