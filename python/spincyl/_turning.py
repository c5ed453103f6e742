"""The least spin at which a tippe top turns over."""

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._contact import Coulomb, Viscous, check_contact_scale, table_for_core
from spincyl._input.numbers import Result, elementwise, is_scalar, number
from spincyl._measured import errors_in_seconds, natural_time
from spincyl._scale import Scale
from spincyl._throw import six_numbers


@elementwise
def turning_spin(
    top: Body, contact: Coulomb | Viscous | None = None, *, lean: float = 0.1, t: float | None = None
) -> Result:
    """Least spin with which a tippe top turns over.

    Without `contact` the spin is an estimate. With `contact` a search computes motions to find it.

    Parameters
    ----------
    top : Body
        Ball whose centre of mass is below its centre: `Body.ball(offset, ...)` with offset < 0. A single
        body; without a contact, also a family.
    contact : Coulomb or Viscous, optional
        Law of friction, with single numbers. Default: no law; the result is then the estimate, which is not
        exact for any law of friction.
    lean : float, optional
        Initial inclination, in radians, from 1e-6 to 1. Used only with a contact.
    t : float, optional
        Time within which the top has to turn over, in sqrt(R/g), at most 1e6; for a measured body in seconds,
        or a pint quantity. Default: 400 sqrt(R/g), or 1/(mu patch) if that is longer, the time in which
        drilling takes the spin. The less the friction, the longer a top needs. Used only with a contact.

    Returns
    -------
    float or array
        Initial w3, in sqrt(g/R), with the centre at rest. The estimate is inf if with every spin the top is
        unstable upside down or stable upright, that is, unless 1 - l < I1/I3 < 1 + l (see the Notes). The
        result of a search is inf if ten times the estimate does not turn the top over within `t` with this
        contact. With a contact point (`patch=0`) the top turns over only if the table is very slippery. Error
        of the estimate: a few roundings. Error of a search: 1e-3 of the least spin within `t`; each motion is
        computed with smaller tolerances until its estimated error lets it decide. A top that leaves the table
        comes down again, without a bounce, and may turn over later. If friction is large, the boundary is
        ragged: within a few hundredths above the least spin a larger spin may fail where a smaller one
        succeeds, and the result is one point of the boundary. The search begins at half of the spin that
        keeps the top upside down, and finds no smaller spin.

    Raises
    ------
    ValueError
        If a single body is not a tippe top; the message names the number. If a number of the contact is an
        array. If the error of a motion of the search is too large to tell whether the top turns over.
    TypeError
        If an argument has another type.

    Notes
    -----
    A force at the contact point does not change Jellett's number
    J = I1 w1 sin(theta) + I3 w3 (ell + cos(theta)). A top can turn over if two conditions hold (J. H.
    Jellett 1872; S. Ebenfeld and F. Scheck, Ann. Phys. 243, 195 (1995)). First, with the same J it spins fast
    enough to be stable upside down. With l = -ell this needs at least

        w3 = (1 + l)^2/(1 - l) sqrt(l/(I3 (1 + l) - I1))

    Second, it is unstable upright, which needs at least w3 = (1 - l) sqrt(l/(I1 - I3 (1 - l))). The estimate
    is the larger of the two.

    On a patch of contact the couple of drilling reduces J. A smaller patch does not help: it reduces J more
    slowly, but the top also rises more slowly. A top needs 1.25 times the estimate at mu = 0.1, 1.7 times at
    0.3, 2.1 times at 0.6. A top that spins much faster still hops while it turns over. In
    the search a top has turned over if its axis comes within 0.14 rad of the vertical.

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
            _core.turning_spin(
                *table_for_core(Viscous(1.0), 0.0), 0.1, None, six_numbers(top)
            )  # says why there is none
        return found
    if not isinstance(contact, Coulomb | Viscous):
        raise TypeError(f"contact: expected Coulomb or Viscous, not {contact!r}")
    if not is_scalar(*top._numbers):
        raise ValueError("top: expected a single body with contact=, not a family")
    check_contact_scale(contact, top.scale)
    time, leans = within_time(t, top.scale), float(number("lean", lean))
    with errors_in_seconds(top.scale):
        return np.float64(_core.turning_spin(*table_for_core(contact, 0.0), leans, time, six_numbers(top)))


def within_time(t: float | None, scale: Scale | None) -> float | None:
    """Convert the duration of a search to natural units; None stays None."""
    if t is None:
        return None
    return float(number("t", t if scale is None else natural_time("t", t, scale)))
