"""The least spin at which an egg on its side rises."""

import numpy as np

from spincyl import _core
from spincyl._contact import Coulomb, Viscous, check_contact_scale, table_for_core
from spincyl._ellipsoid import Ellipsoid
from spincyl._input.numbers import Result, instance_of, number
from spincyl._measured import errors_in_seconds
from spincyl._turning import within_time


def rising_spin(
    egg: Ellipsoid, contact: Coulomb | Viscous | None = None, *, lean: float = 0.1, t: float | None = None
) -> Result:
    """Least spin with which an egg on its side rises to stand on an end.

    Without `contact` the spin is an estimate. With `contact` a search computes motions to find it.

    Parameters
    ----------
    egg : Ellipsoid
        Single spheroid whose third semi-axis is the longest, with its mass symmetric about this axis, as made
        by `Ellipsoid.egg`.
    contact : Coulomb or Viscous, optional
        Law of friction, with single numbers. Default: no law; the result is then the estimate, which is not
        exact for any law of friction.
    lean : float, optional
        Initial angle between the axis and its position when the egg rests on its side, in radians, from 1e-6
        to 1. Used only with a contact.
    t : float, optional
        Time within which the egg has to rise, in sqrt(a/g), at most 1e6; for an egg in metres in seconds, or
        a pint quantity. Default: 400 sqrt(a/g), or 1/(mu patch) if that is longer, the time in which drilling
        takes the spin. The less the friction, the longer an egg needs. Used only with a contact.

    Returns
    -------
    float
        Initial spin about the vertical, in sqrt(g/a), with the centre at rest. The estimate is inf if no spin
        makes the egg stable on an end, or if at every spin the egg is stable at an inclination between its
        side and the end. The result of a search is inf if ten times the estimate does not raise the egg
        within `t` with this contact. Error of the estimate: a few roundings. Error of a search: 1e-3 of the
        least spin within `t`; each motion is computed with smaller tolerances until its estimated error is
        small enough to decide. An egg that leaves the table comes down again, without a bounce, and rises on.
        The search begins at half of the estimate and finds no smaller spin.

    Raises
    ------
    ValueError
        If the stone is not an egg, or stands on an end without spin; the message names the number. If `egg`
        is a family, or a number of the contact is an array. If the error of a motion of the search is too
        large to tell whether the egg rises.
    TypeError
        If an argument has another type.

    Notes
    -----
    A force at the contact point does not change Jellett's number J. For an egg on its side, J is the product
    of the spin about the vertical, the moment of inertia about the vertical and the height of the centre of
    mass (H. K. Moffatt and Y. Shimomura, Nature 416, 385 (2002)). Let h be the distance from the centre of
    mass to an end, and rho the radius of curvature there. Among all motions with this J, standing on that end
    has the least energy nearby if

        J^2 > I3^2 h^4 (h - rho)/(rho (I3 h - I1 rho)).

    In the search an egg has risen if its axis comes within 0.2 rad of the vertical. An egg that touches a
    rough table at a point may hop on the way.

    Examples
    --------
    >>> import spincyl as sc
    >>> egg = sc.Ellipsoid.egg(22.0, 30.8)
    >>> round(float(sc.rising_spin(egg)), 3)
    4.146
    >>> round(float(sc.rising_spin(egg, sc.Coulomb(0.3, patch=0.2 / 30.8))), 1)
    4.8
    """
    instance_of("egg", egg, Ellipsoid)
    if contact is None:
        return np.float64(_core.rising_spin(None, (0.0, 0.0, 0.0), 0.1, None, egg._numbers))
    if not isinstance(contact, Coulomb | Viscous):
        raise TypeError(f"contact: expected Coulomb or Viscous, not {contact!r}")
    check_contact_scale(contact, egg.scale)
    time, leans = within_time(t, egg.scale), float(number("lean", lean))
    with errors_in_seconds(egg.scale, "a"):
        return np.float64(_core.rising_spin(*table_for_core(contact, 0.0), leans, time, egg._numbers))
