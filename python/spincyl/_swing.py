"""The nutation of a motion: its turning points and its period."""

from typing import Any, NamedTuple, TypeAlias

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._contact import Contact, code_of
from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import instance_of, is_scalar
from spincyl._scale import Scale
from spincyl._state import State, numbers, numbers_without_slip
from spincyl._upward import function_of_method


@compared_by_value
class Swing(NamedTuple):
    """The nutation of a motion, computed as if no event ended the motion; the result of `swing`.

    Numbers are in natural units. For a measured body they are in SI: times in s, lengths in m.

    Attributes
    ----------
    period : float
        Period of the nutation, in sqrt(R/g) or s; infinite if the face lands.
    theta_min : float
        Least inclination, in radians; 0 if the face lands.
    theta_max : float
        Greatest inclination, in radians.
    precession_per_period : float
        Increase of phi in one period, in radians; NaN if the period is infinite.
    spin_per_period : float
        Increase of psi in one period, in radians; NaN if the period is infinite.
    drift : float
        Displacement of the contact point in one period, in R or m.
    drift_radius : float
        Radius of the circle on which the contact point lies after each whole period, in R or m.
    error : float
        Estimated error of the period, in sqrt(R/g) or s; NaN if the period is infinite.
    scale : Scale or None
        Scale of a measured body.
    nutation : float
        Angular frequency of the nutation, in sqrt(g/R) or rad/s.
    """

    period: float
    theta_min: float
    theta_max: float
    precession_per_period: float
    spin_per_period: float
    drift: float
    drift_radius: float
    error: float
    scale: Scale | None = None

    @property
    def nutation(self) -> float:
        """Angular frequency of the nutation, 2 pi over the period, in sqrt(g/R) or rad/s."""
        return 2 * np.pi / self.period

    def _repr_html_(self) -> str:
        return str(function_of_method("card")(self))


def swing(body: Body, state: State, contact: Contact = "rolling") -> Swing:
    """Compute the nutation of a motion: period, turning points, and rotation and drift per period.

    Events are ignored. In the real motion the other rim may land before the period is over (if theta_max
    exceeds pi/2), or the body may lift off; `roll` finds such events. A body of several circles swings on the
    circle on which it stands, also beyond the `borders` of that circle.

    Parameters
    ----------
    body : Body
        Single body, with numbers in the range of `roll`.
    state : State
        Any single state of the motion, with numbers in the range of `roll`.
    contact : {"rolling", "smooth"}
        Rolling without slipping, or a frictionless table.

    Returns
    -------
    Swing
        Named numbers, for a measured body in SI. Their relative error is 1e-14 times the condition number of
        the motion. `Swing.error` estimates the error of the period.

    Raises
    ------
    ValueError
        If the body or the state is out of range, or if rounding errors leave no correct digit.
    """
    return swing_on(body, state, contact)


def swing_on(body: Body, state: State, contact: Contact, rim: int | None = None) -> Swing:
    """The nutation of a body on its circle `rim`; default: the circle that touches the table."""
    of, start = numbers_of_one(body, state, several=True)
    numbers_without_slip(
        state, f"contact={contact!r} has no law of friction; take roll with contact=sc.Coulomb(mu)"
    )
    if body.rims is not None:
        seen: Any = body._at(*start, rim=rim)
        start, of = seen[:4], seen[4:]
    eight: list[float] = _core.swing(of, start, code_of(contact))
    found = Swing._make([*eight, None])
    if body.rims is not None and body._sign(state.theta) < 0:
        low, high, spins = np.pi - found.theta_max, np.pi - found.theta_min, -found.spin_per_period
        found = found._replace(theta_min=low, theta_max=high, spin_per_period=spins)
    if body.scale is None:
        return found
    metre, second, *_ = body.scale._units
    return found._replace(
        period=found.period * second,
        drift=found.drift * metre,
        drift_radius=found.drift_radius * metre,
        error=found.error * second,
        scale=body.scale,
    )


_Four: TypeAlias = tuple[float, float, float, float]
_Six: TypeAlias = tuple[float, float, float, float, float, float]


def numbers_of_one(body: Body, state: State, *, several: bool = False) -> tuple[_Six, _Four]:
    """The numbers of a single body and of a single state; the body may have several circles if `several`."""
    one = instance_of("body", body, Body)
    of, at = one._raw if several else one._numbers, numbers(state)
    (ell, i1, i3, bore, fillet, most), (theta, w1, w2, w3) = of, at
    if body._single and type(theta) is type(w1) is type(w2) is type(w3) is float:
        return of, at
    for name, values in (("body", of), ("state", at)):
        if not is_scalar(*values):
            raise ValueError(f"{name}: expected a single {name}, not an array")
    return (
        (float(ell), float(i1), float(i3), float(bore), float(fillet), float(most)),
        (float(theta), float(w1), float(w2), float(w3)),
    )


def single_slip(state: State) -> tuple[float, float]:
    """The slip of a single state along e_h and e2; zeros for a state without a slip."""
    if state.slip is None:
        return 0.0, 0.0
    along, across = state._slip
    if not is_scalar(along, across):
        raise ValueError("state: expected a single state, not an array")
    return float(along), float(across)


def single_aloft(state: State) -> tuple[float, float] | None:
    """Height and lift of a single state in the air; None for a state on the table."""
    if state.height is None:
        return None
    if not is_scalar(state.height, state.lift):
        raise ValueError("state: expected a single state, not an array")
    return float(state.height), float(state.lift)  # type: ignore[arg-type]  # both are set together
