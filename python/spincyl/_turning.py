"""The least spin at which a tippe top turns over."""

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._contact import Coulomb, Viscous, fitting, table
from spincyl._input.numbers import Result, elementwise, is_scalar, number
from spincyl._throw import six


@elementwise
def turning_spin(top: Body, contact: Coulomb | Viscous | None = None, *, lean: float = 0.1) -> Result:
    """Least spin with which a tippe top turns over.

    Without `contact` the spin is an estimate. With `contact` a search computes motions to find it.

    Parameters
    ----------
    top : Body
        Ball whose centre of mass is below its centre: `Body.ball(offset, ...)` with offset < 0. A single
        body; without a contact, also a family.
    contact : Coulomb or Viscous, optional
        Law of friction, with single numbers. Default: the estimate, which needs no law of friction and is not
        exact for any.
    lean : float, optional
        Initial inclination, in radians, from 1e-6 to 1. Used only with a contact.

    Returns
    -------
    float or array
        Initial w3, in sqrt(g/R), with the centre at rest. The result is inf if no spin makes the top stable
        upside down, or if ten times the estimate does not turn the top over with this contact. With a contact
        point (`patch=0`) the top turns over only if the table is very slippery. Error of the estimate: a few
        roundings. Error of a search: 1e-3 of the spin. If friction is large, the boundary is ragged: a larger
        spin may fail where a smaller one succeeds, and the result is one point of the boundary. The search
        begins at half of the estimate and finds no smaller spin.

    Raises
    ------
    ValueError
        If a single body is not a tippe top; the message names the number. If a number of the contact is an
        array.
    TypeError
        If an argument has another type.

    Notes
    -----
    A force at the contact point does not change Jellett's number
    J = I1 w1 sin(theta) + I3 w3 (ell + cos(theta)). A top can turn over if with the same J it spins fast
    enough to be stable upside down (J. H. Jellett 1872; S. Ebenfeld and F. Scheck, Ann. Phys. 243, 195
    (1995)). With l = -ell:

        w3 = (1 + l)^2/(1 - l) sqrt(l/(I3 (1 + l) - I1))

    On a patch of contact the couple of drilling reduces J. A smaller patch does not help: it reduces J more
    slowly, but the top also rises more slowly. A top needs 1.25 times the estimate at mu = 0.1, 1.7 times at
    0.3, 2.1 times at 0.6. In the search a top has turned over if its axis comes within 0.14 rad of the
    vertical.

    Examples
    --------
    >>> import spincyl as sc
    >>> top = sc.Body.ball(-0.2, i1=0.40, i3=0.42)
    >>> round(float(sc.turning_spin(top)), 3)
    2.496
    >>> round(float(sc.turning_spin(top, sc.Coulomb(0.3, patch=0.02))), 1)
    4.1
    """
    if not isinstance(top, Body):
        raise TypeError(f"top: expected a Body, not {type(top).__name__}")
    if contact is None:
        found: Result = _core.jellett_spin(*top._numbers)
        if np.ndim(found) == 0 and np.isnan(found):
            _core.turning_spin(*table(Viscous(1.0), 0.0), 0.1, six(top))  # says why there is none
        return found
    if not isinstance(contact, Coulomb | Viscous):
        raise TypeError(f"contact: expected Coulomb or Viscous, not {contact!r}")
    if not is_scalar(*top._numbers):
        raise ValueError("top: expected a single body with contact=, not a family")
    fitting(contact, top.scale)
    return np.float64(_core.turning_spin(*table(contact, 0.0), float(number("lean", lean)), six(top)))
