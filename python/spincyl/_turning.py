"""The spin from which a tippe top turns over."""

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._contact import Coulomb, Viscous, fitting, table
from spincyl._input.numbers import Result, elementwise, is_scalar, number
from spincyl._throw import six


@elementwise
def turning_spin(top: Body, contact: Coulomb | Viscous | None = None, *, lean: float = 0.1) -> Result:
    """Least spin with which a tippe top turns over: an estimate without a table, else a search.

    Parameters
    ----------
    top : Body
        A ball with its centre of mass below its middle, `Body.ball(offset, ...)` with offset < 0. One, or
        a family if no table is given.
    contact : Coulomb or Viscous, optional
        The table, with single numbers. Default: the estimate, which holds for no table exactly.
    lean : float, optional
        Inclination of the axis at the start, in radians; from 1e-6 to 1. Only with a table.

    Returns
    -------
    float or array
        The spin w3 about the axis at the start, in sqrt(g/R), with the centre at rest. inf for a top that
        no spin makes stable upside down, and on a table where ten times the estimate does not turn it over,
        as at a point of a table that is not very slippery. Error: a few roundings without a table, else 1e-3
        of the spin. On rough tables the border is ragged (a little more spin may fail where less does not),
        and the result is one point of it. Never less than half of the estimate.

    Raises
    ------
    ValueError
        If a single body is no top, naming the number; if a number of the table is an array.
    TypeError
        If an argument holds no real numbers.

    Notes
    -----
    A force at a point does not change Jellett's number J = I1 w1 sin(theta) + I3 w3 (ell + cos(theta)). A
    top can turn over if upside down, with the same J, it spins fast enough to be stable there (J. H. Jellett
    1872; S. Ebenfeld and F. Scheck, Ann. Phys. 243, 195 (1995)). With l = -ell:

        w3 = (1 + l)^2/(1 - l) sqrt(l/(I3 (1 + l) - I1))

    On a patch the couple of drilling takes some of J, as much on the smallest patch, for there the rise is as
    slow as that loss: a top needs 1.25 times the estimate at mu = 0.1, 1.7 times at 0.3, 2.1 times at 0.6.
    The search follows motions; each has turned over if its axis comes within 0.14 rad of the vertical.

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
        raise ValueError("top: expected one body where a table is given, not a family")
    fitting(contact, top.scale)
    return np.float64(_core.turning_spin(*table(contact, 0.0), float(number("lean", lean)), six(top)))
