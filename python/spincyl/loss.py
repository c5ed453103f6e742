"""Laws of loss: what takes the energy of a body that spins, rolls and comes to rest.

Each law is a couple on the body with one positive coefficient; laws are added with `+`. Which of them stops a
coin is a debate of twenty-five years: they are offered, to be fitted and compared, and none is picked.

With s, c the sine and cosine of theta, psi' = w3 - w1 c/s the spin along the rim, w_h = -s psi' the rolling,
w2 the rocking, w_z = s w1 + c w3 the drilling, N the normal force, A the radius of the circle of contact (1
of a sharp rim), h = c e1 - s e3, a law takes the power P. Last its `exponent`, how theta of a thin disk
falls with the time that is left::

    DryContour(eps)           P = eps N A |psi'|                      2/3
    ViscousContour(c)         P = c (A psi')^2                        1/2
    RollingResistance(delta)  P = delta N sqrt(w_h^2 + w2^2)          2
    Drilling(length)          P = length N |w_z|                      none: it never stops
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

from dataclasses import dataclass
from typing import Any, Self, TypeVar

import numpy as np

from spincyl._body import Body
from spincyl._input.numbers import Reals, Result, fitting
from spincyl._loss import Law, Loss, Sum, arm, over, positive, sized, units
from spincyl._scale import Scale
from spincyl._upward import above

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
    return above("loss.typical")()


def __dir__() -> list[str]:
    return [*globals(), "typical"]


_AIR, _DENSITY = 1.8e-5, 1.2  # Pa s, kg/m^3


@dataclass(frozen=True, eq=False, repr=False)
class DryContour(Law):
    """Dry friction along the contour of the rim: ``P = eps N A |psi'|``.

    m = eps N A sgn(psi') h/s. The weight's reaction runs ahead of the contact by eps/s, which has no meaning
    beyond the rim, at theta below eps or so. Le Saux, Leine and Glocker, J. Nonlinear Sci. 15, 27 (2005).

    Parameters
    ----------
    eps : array_like
        Positive, in R. A coin that stops after seconds has about 1e-3, Euler's disk 1e-4.
    """

    eps: Reals

    @classmethod
    def from_si(cls, eps: Reals, *, scale: Scale | Body) -> Self:
        """Of `eps` in metres."""
        return sized(cls(arm("eps", eps, scale)), scale)


@dataclass(frozen=True, eq=False, repr=False)
class ViscousContour(Law):
    """Viscous friction along the contour of the rim: P = c (A psi')^2, m = c A^2 psi' h/s.

    Leine, Arch. Appl. Mech. 79, 1063 (2009); a loss that grows as the square of the rate was seen by McDonald
    and McDonald, arXiv physics/0008227.

    Parameters
    ----------
    c : array_like
        Positive, in M R sqrt(g R).
    """

    c: Reals

    @classmethod
    def from_si(cls, c: Reals, *, scale: Scale | Body) -> Self:
        """Of `c` in N m s; the scale needs the mass."""
        return sized(cls(over(positive("c", c, "newton*metre*second"), _newton_metre_seconds(scale))), scale)


@dataclass(frozen=True, eq=False, repr=False)
class RollingResistance(Law):
    """The classical arm of rolling friction: P = delta N sqrt(w_h^2 + w2^2), w_h along h and w2 along e2.

    m = -delta N (c w_h, w2, -s w_h)/sqrt(w_h^2 + w2^2). It alone takes infinitely many turns to stop a coin,
    in a finite time.

    Parameters
    ----------
    delta : array_like
        Positive, in R.
    """

    delta: Reals

    @classmethod
    def from_si(cls, delta: Reals, *, scale: Scale | Body) -> Self:
        """Of `delta` in metres."""
        return sized(cls(arm("delta", delta, scale)), scale)


@dataclass(frozen=True, eq=False, repr=False)
class Drilling(Law):
    """Friction of the patch of contact, which turns on the table: ``P = length N |w_z|``.

    m = -length N sgn(w_z) z. Contensou (1963); Leine, Arch. Appl. Mech. 79, 1063 (2009). By it alone a thin
    disk never stops, a disk of finite height does.

    Parameters
    ----------
    length : array_like
        Positive, in R: of even pressure two thirds of the coefficient of friction times the radius of the
        patch.
    """

    length: Reals

    @classmethod
    def from_si(cls, length: Reals, *, scale: Scale | Body) -> Self:
        """Of `length` in metres."""
        return sized(cls(arm("length", length, scale)), scale)


@dataclass(frozen=True, eq=False, repr=False)
class AirLinear(Law):
    """Air that resists all turning slowly, as Stokes has it: P = b w.w, m = -b w.

    Parameters
    ----------
    b : array_like
        Positive, in M R sqrt(g R).
    """

    b: Reals

    @classmethod
    def from_si(cls, b: Reals, *, scale: Scale | Body) -> Self:
        """Of `b` in N m s; the scale needs the mass."""
        return sized(cls(over(positive("b", b, "newton*metre*second"), _newton_metre_seconds(scale))), scale)


@dataclass(frozen=True, eq=False, repr=False)
class AirQuadratic(Law):
    """Air that resists all turning fast, Newton's drag: ``P = b2 |w|^3, m = -b2 |w| w``.

    Parameters
    ----------
    b2 : array_like
        Positive, in M R^2. Of a long rod about (Cd/2) (density R^3/M) ell^4.
    """

    b2: Reals

    @classmethod
    def from_si(cls, b2: Reals, *, scale: Scale | Body) -> Self:
        """Of `b2` in N m s^2; the scale needs the mass."""
        _, seconds, joules = units(scale, weighed=True)
        return sized(cls(over(positive("b2", b2, "newton*metre*second**2"), joules * seconds**2)), scale)


@dataclass(frozen=True, eq=False, repr=False)
class AirFilm(Law):
    """A viscous film of air between a flat face and the table: P = (pi/4) viscosity psi'^2/s.

    m = (pi/4) viscosity psi' h/s^2. Moffatt, Nature 404, 833 (2000). The film has to fill the gap,
    theta^(3/4) below nu^(1/2) (R/(4 g))^(1/4)/R with nu the kinematic viscosity of air: 0.005 rad of Euler's
    disk; above that see `BoundaryLayer`. A drift of a measured body that starts above it warns.

    Parameters
    ----------
    viscosity : array_like
        Positive, in M g^(1/2)/R^(3/2); 9.5e-8 of air under Euler's disk. The pi/4 is Moffatt's estimate; with
        no pressure at the rim, lubrication has 1.2811: a `viscosity` larger by 1.63.
    """

    viscosity: Reals

    @classmethod
    def from_si(cls, viscosity: Reals = _AIR, *, scale: Scale | Body) -> Self:
        """Of the viscosity in Pa s (default: air); the scale needs the mass."""
        unit = _newton_metre_seconds(scale)
        with np.errstate(over="ignore"):
            found = positive("viscosity", viscosity, "pascal*second") * units(scale)[0] ** 3 / unit
        return _told(cls, found, "viscosity", scale)


@dataclass(frozen=True, eq=False, repr=False)
class BoundaryLayer(Law):
    """Boundary layers of the air that is pressed out below a face: ``P = k |psi'|^(5/2)``.

    ``m = k |psi'|^(3/2) sgn(psi') h/s``. Bildsten, Phys. Rev. E 66, 056309 (2002): above the angle at which
    the film of `AirFilm` fills the gap.

    Parameters
    ----------
    k : array_like
        Positive, C sqrt(density viscosity) R^(9/4)/(M g^(1/4)).
    """

    k: Reals

    @classmethod
    def from_si(
        cls, C: Reals, *, scale: Scale | Body, density: Reals = _DENSITY, viscosity: Reals = _AIR
    ) -> Self:
        """Of the number `C`, of order 0.1, and the density and viscosity of air in kg/m^3 and Pa s.

        The scale needs the mass.
        """
        metres, seconds, joules = units(scale, weighed=True)
        density = positive("density", density, "kilogram/metre**3")
        viscosity, C = positive("viscosity", viscosity, "pascal*second"), positive("C", C)
        fitting({"C": C, "density": density, "viscosity": viscosity})
        with np.errstate(over="ignore"):
            found = C * np.sqrt(density * viscosity) * metres**4 / (joules * seconds**1.5)
        return _told(cls, found, "C, density, viscosity", scale)


def _told(kind: type[_Kind], coefficient: Reals, names: str, scale: Scale | Body) -> _Kind:
    """A law with this coefficient, or ValueError that names the quantities it was computed from."""
    try:
        return sized(kind(coefficient), scale)
    except ValueError as e:
        raise ValueError(f"{names}: {e}") from None


def film_fills(viscosity: Reals, scale: Scale) -> Result:
    """The inclination below which the film of `AirFilm` fills the gap under a body of this scale and mass.

    The gas is as dense as air. NaN where the mass is not known.
    """
    metres, seconds, joules = units(scale)
    kinematic = np.asarray(viscosity) * (seconds * joules / metres**3) / _DENSITY
    return (np.sqrt(kinematic * seconds / 2) / metres) ** (4 / 3)


def _newton_metre_seconds(scale: Scale | Body) -> float:
    """The unit of a couple over an angular velocity, M R sqrt(g R)."""
    _, seconds, joules = units(scale, weighed=True)
    return seconds * joules
