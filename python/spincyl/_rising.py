"""The spin from which an egg that lies rises."""

import numpy as np

from spincyl import _core
from spincyl._contact import Coulomb, Viscous, fitting, table
from spincyl._ellipsoid import Ellipsoid
from spincyl._input.numbers import Result, number


def rising_spin(egg: Ellipsoid, contact: Coulomb | Viscous | None = None, *, lean: float = 0.1) -> Result:
    """Least spin with which an egg that lies rises to an end: an estimate without a table, else a search.

    Parameters
    ----------
    egg : Ellipsoid
        One spheroid with a long third semi-axis and a mass that is symmetric about it, as `Ellipsoid.egg`
        makes it.
    contact : Coulomb or Viscous, optional
        The table, with single numbers. Default: the estimate, which holds for no table exactly.
    lean : float, optional
        How far its axis is raised from where it lies, in radians; from 1e-6 to 1. Only with a table.

    Returns
    -------
    float
        The spin about the vertical at the start, in sqrt(g/a), with the centre at rest. inf for an egg that
        no spin makes stable on an end, and on a table where ten times the estimate does not raise it. Error:
        a few roundings without a table, else 1e-3 of the spin. Never less than half of the estimate.

    Raises
    ------
    ValueError
        For a stone that is no egg, or that stands on an end without any spin, naming the number; for a
        family; if a number of the table is an array.
    TypeError
        If an argument is of another kind.

    Notes
    -----
    A force at a point does not change Jellett's number J. Of an egg that lies it is the spin about the
    vertical times the moment of inertia about it times the height of the centre of mass (H. K. Moffatt and
    Y. Shimomura, Nature 416, 385 (2002)). On an end at the distance h from the centre of mass, with the
    radius of curvature rho, the least energy with this J has a minimum for

        J^2 > I3^2 h^4 (h - rho)/(rho (I3 h - I1 rho)).

    The search follows motions; each has risen if its axis comes within 0.2 rad of the vertical.

    Examples
    --------
    >>> import spincyl as sc
    >>> egg = sc.Ellipsoid.egg(22.0, 30.8)
    >>> round(float(sc.rising_spin(egg)), 3)
    4.146
    >>> round(float(sc.rising_spin(egg, sc.Coulomb(0.3, patch=0.2 / 30.8))), 1)
    4.8
    """
    if not isinstance(egg, Ellipsoid):
        raise TypeError(f"egg: expected an Ellipsoid, not {type(egg).__name__}")
    if contact is None:
        return np.float64(_core.rising_spin(None, (0.0, 0.0, 0.0), 0.1, egg._numbers))
    if not isinstance(contact, Coulomb | Viscous):
        raise TypeError(f"contact: expected Coulomb or Viscous, not {contact!r}")
    fitting(contact, egg.scale)
    return np.float64(_core.rising_spin(*table(contact, 0.0), float(number("lean", lean)), egg._numbers))
