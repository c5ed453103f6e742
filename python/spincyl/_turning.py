"""The least spin at which a tippe top turns over."""

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._contact import Coulomb, Viscous, fitting, table
from spincyl._input.numbers import Result, elementwise, is_scalar, number
from spincyl._throw import six


@elementwise
def turning_spin(top: Body, contact: Coulomb | Viscous | None = None, *, lean: float = 0.1) -> Result:
    """Least spin at which a tippe top turns over: by an estimate, or by a search with a contact.

    Parameters
    ----------
    top : Body
        Ball with its centre of mass below its centre, `Body.ball(offset, ...)` with offset < 0. A single
        body, or without a contact a family.
    contact : Coulomb or Viscous, optional
        Law of friction, with single numbers. Default: the estimate, which is exact for no law of friction.
    lean : float, optional
        Initial inclination, in radians, from 1e-6 to 1. Used only with a contact.

    Returns
    -------
    float or array
        Initial w3, in sqrt(g/R), with the centre at rest. inf if no spin makes the top stable upside down, or
        if ten times the estimate does not turn it over with this contact, as with a contact point unless the
        table is very slippery. Error: a few roundings for the estimate, else 1e-3 of the spin. With large
        friction the boundary is ragged (a larger spin may fail where a smaller one does not), and the result
        is one point of it. Never less than half of the estimate.

    Raises
    ------
    ValueError
        If a single body is not a tippe top (the message names the number), or a number of the contact is an
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

    On a patch the couple of drilling reduces J. The reduction is the same on the smallest patch, since there
    the rise is as slow as the loss. A top needs 1.25 times the estimate at mu = 0.1, 1.7 times at 0.3, 2.1
    times at 0.6. The search computes motions. A top has turned over if its axis comes within 0.14 rad of the
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
