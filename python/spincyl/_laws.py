"""Properties of a body, its stability, and quantities of its states: each calls one function of the core."""

import warnings
from dataclasses import replace
from enum import IntEnum
from typing import Any, Literal, TypeAlias, get_args

import numpy as np

from spincyl import _core
from spincyl._circles import Circles
from spincyl._contact import AnyContact, Contact, Coulomb, Viscous, is_rolling
from spincyl._input.numbers import (
    Reals,
    Result,
    elementwise,
    is_scalar,
    keywords,
    one_of,
    radians,
    reals,
    refuse_bad_value,
)
from spincyl._input.reprs import is_lazy
from spincyl._slip import slip_of, velocity_of
from spincyl._state import State, numbers, numbers_without_slip

_ROLLS = "expected a state without slip, as dataclasses.replace(state, slip=None)"


#: Posture of a body on a slope: standing on its face, rolling, or lying without rolling.
Posture: TypeAlias = Literal["standing", "rolling", "lying"]
POSTURES: tuple[str, ...] = get_args(Posture)


class Region(IntEnum):
    """Code for the existence and stability of a steady state with the centre at rest.

    Attributes
    ----------
    INVALID
        Outside the domain: theta outside (0, pi/2], or an impossible body.
    FORBIDDEN
        No steady state: theta is between `Body.theta_balance`, where the body balances at rest, and
        `Body.theta_limit`, where the rate becomes infinite.
    UNDETERMINED
        Theta is too close to theta_balance or theta_limit to decide in double precision if a state exists.
    UNSTABLE
        Unstable on a smooth table and in rolling.
    STABLE_ROLLING
        Unstable on a smooth table, stable in rolling.
    STABLE_SMOOTH
        Stable on a smooth table, unstable in rolling.
    STABLE
        Stable on a smooth table and in rolling.
    """

    INVALID = 0
    FORBIDDEN = 1
    UNDETERMINED = 2
    UNSTABLE = 4
    STABLE_ROLLING = 5
    STABLE_SMOOTH = 6
    STABLE = 7


def _warn_if_not_steady(body: "Laws", state: State, kappa: Result) -> None:
    """Warn of states that are not steady because the body stands on more than one point; skip lazy arrays."""
    theta = state.theta
    if body.rims is not None or any(is_lazy(x) or hasattr(x, "dims") for x in (kappa, theta, *body._numbers)):
        return
    two = _core.two_rims(*body._numbers) == 1
    for place, standing, more in (
        ("pi/2", two & (theta == np.pi / 2), ". launch_number(body, state) says whether one rim rises"),
        ("0", (body.fillet < 1) & (theta == 0), ""),
    ):
        if np.any(np.isnan(kappa) & standing):
            on = "both its rims" if more else "its whole face"
            why = "stable() is False, as for a body on one point of its rim, where this state is not steady"
            warnings.warn(f"at: theta = {place}, where the body stands on {on}; {why}{more}", stacklevel=4)


class Laws(Circles):
    """Base class of `Body`, with its methods that each evaluate one formula of the core."""

    @property
    def _leans(self) -> str:
        """Text for the valid range of theta, such as "0 < theta <= pi/2", for messages."""
        raise NotImplementedError

    # Quantities of the shape alone.

    @property
    def theta_balance(self) -> Result:
        """Inclination theta0 in radians at which the body balances at rest on its rim; NaN for a ball."""
        return _core.theta_balance(*self._numbers)

    @property
    def theta_limit(self) -> Result:
        """Inclination thetaInf in radians at which the rate of the steady state tends to infinity."""
        return _core.theta_limit(*self._numbers)

    @property
    def excess(self) -> Result:
        """Inertia excess I1/I3 - 1: positive for a long cylinder, 0 at the critical aspect, else negative."""
        return _core.excess(*self._raw)

    @elementwise
    def angular_rate(self, rate: Reals) -> Result:
        """Convert a reduced rate to a precession rate: Omega = Omega~ / sqrt(I3), in sqrt(g/R)."""
        return reals("rate", rate) / np.sqrt(self.i3)

    # Stability, on a smooth table or in rolling.

    @elementwise
    def stability(self, at: Reals | State, contact: Contact = "rolling", **ufunc: Any) -> Result:
        """Stability kappa: squared angular frequency of the nutation, in g/R; negative if unstable.

        Parameters
        ----------
        at : array_like or State
            Inclination in radians, in (0, pi/2], of a steady state with the centre at rest; or any steady
            `State`. A state from `circular` is steady in rolling. It is not steady on a smooth table, where
            no friction keeps the centre on its circle.
        contact : {"rolling", "smooth"}
            "rolling": stability of the linearised motion without slipping. "smooth": the energy criterion of
            Jackson et al. (Appendix), which is exact on a frictionless table. The two disagree on about an
            eighth of the steady states of cylinders and disks (11.8 % for ell up to 3).
        **ufunc
            `out=`, `where=` and the other keywords of NumPy's ufuncs.

        Returns
        -------
        float or array
            NaN where there is no steady state, or where a `State` is not steady to six digits. For an
            inclination the error is at most 16 (1 + cond) 2^-53 of the larger term of kappa, with
            ``cond = cos/|n| + (a cos + ell sin)/|m|``, a = 1 - fillet, and n and m as for `rate`. For a
            `State` with theta above 1e-100 it is at most 64 * 2^-53 of the largest term.
        """
        rolling = is_rolling(contact)
        if isinstance(at, State):
            law = _core.state_kappa_rolling if rolling else _core.state_kappa_smooth
            return law(*self._at(*numbers_without_slip(at, _ROLLS)), **keywords(law, ufunc, "stability"))
        law = _core.kappa_rolling if rolling else _core.kappa_smooth
        return law(*self._at(radians("at", at, self._leans)), **keywords(law, ufunc, "stability"))

    @elementwise
    def stable(self, at: Reals | State, contact: Contact = "rolling") -> Result:
        """Whether a small disturbance stays small (kappa > 0); False where the state is not steady.

        Parameters are those of `stability`. The result holds for a body that stands on one point of one rim.
        At theta = pi/2 a body with two rims stands on both, and at theta = 0 a body stands on its whole face.
        For such a `State` the result may be False, because the body would not be steady on one point alone.

        Warns
        -----
        UserWarning
            If the body stands on two rims or on its face. `launch_number` says whether one rim rises.
        """
        kappa = self.stability(at, contact)
        if isinstance(at, State):
            _warn_if_not_steady(self, at, kappa)
        return kappa > 0

    @elementwise
    def nutation(self, at: Reals | State, contact: Contact = "rolling") -> Result:
        """Angular frequency of a small nutation, sqrt(g/R); 0 for unstable states, NaN for unsteady ones.

        Parameters are those of `stability`.
        """
        return _core.nutation(self.stability(at, contact))

    @elementwise
    def growth_rate(self, at: Reals | State, contact: Contact = "rolling") -> Result:
        """Growth rate of a small disturbance, sqrt(g/R); 0 for stable states, NaN for unsteady ones.

        Parameters are those of `stability`.
        """
        return _core.growth_rate(self.stability(at, contact))

    def standing_spin(self, contact: Contact = "rolling") -> Result:
        """Least w3, in sqrt(g/R), with which a ball stands stably on its pole, like a sleeping top.

        The result is 0 for a ball that is stable at rest, and NaN for other bodies. Its relative error is at
        most 4 * 2^-53. `contact` is "rolling" or "smooth".
        """
        law = _core.standing_rolling if is_rolling(contact) else _core.standing_smooth
        return law(*self._numbers)

    @elementwise
    def painleve(self, theta: Reals) -> Result:
        """Painleve limit mu_P: least coefficient of friction at which the contact force may not be unique.

        With a larger coefficient the law of friction may allow no contact force, or more than one. The limit
        is for a slip along e_h of `State` that moves the contact point away from below the centre, as when
        chalk is pushed over a blackboard. `theta` is in radians. The limit is infinite at theta_balance, and
        at least sqrt(5)/2 = 1.118 for uniform tubes.
        """
        return _core.painleve(*self._at(radians("theta", theta, self._leans)))

    @elementwise
    def topples(self, mu: Reals, theta: Reals = 0.0) -> Result:
        """Whether the body topples as it slides straight on its face.

        The body topples if mu Z > a, with the height Z of the centre of mass and the radius a of the face. A
        body that also spins may stay up.

        Parameters
        ----------
        mu : array_like
            Coefficient of friction, 0 or more.
        theta : array_like, optional
            0 for the first face, pi for the one at the other end of a body of several circles.

        Returns
        -------
        bool or array
            False for impossible numbers in an array.

        Raises
        ------
        ValueError
            If the body is a single ball, which has no face, or if a single `mu` is negative or not finite.
        """
        given = reals("mu", mu)
        found = _core.topples(given, *self._at(radians("theta", theta, "0 or pi"))[1:])
        if is_scalar(found) and np.isnan(found):
            refuse_bad_value("mu", given, lambda x: ~((x >= 0) & (x < np.inf)), "expected 0 <= mu, finite")
            raise ValueError("body: expected a body with a face; a ball has none")
        return found > 0

    @elementwise
    def slip_slope(
        self, mu: Reals, posture: Posture = "rolling", *, phi: Reals = -np.pi / 2, theta: Reals = None
    ) -> Result:
        """Slope of the table, in radians, beyond which a body that rolls or rests on it slips.

        Parameters
        ----------
        mu : array_like
            Coefficient of static friction, 0 or more.
        posture : {"rolling", "lying", "standing"}
            "rolling": on its side, or upright on one rim, and free to roll. "lying": the same, but rolling
            resistance or a chock prevents rolling. "standing": on its face.
        phi : array_like, optional
            Direction to which the axis leans, in radians from downhill. Default: the axis lies across the
            slope, so that the body rolls straight down. With 0 the axis of a body on its side points
            downhill.
        theta : array_like, optional
            Inclination of a body of several circles: one of `borders`, 0 or pi. Default: the first of
            `borders` at which the body `rests` on two circles; 0 for "standing".

        Returns
        -------
        float or array
            Broadcast shape of arguments and body; NaN for impossible ones in an array. Absolute error 1e-14.

        Raises
        ------
        ValueError
            If a single body has no such posture, or an argument is out of range; the message names it.

        Notes
        -----
        A body that rolls straight down slips if tan(slope) > mu (I3 + A^2)/I3, where A is the radius of the
        circles on which it rolls. A body that lies without rolling, or stands, slips if tan(slope) > mu. A
        body on its side at another phi slips earlier: its upper circle carries less load but must share the
        friction. Such a body may tip first: see `tip_slope`.

        Examples
        --------
        >>> import spincyl as sc
        >>> can = sc.Body.solid(2.0)
        >>> np.tan([can.slip_slope(0.2), can.slip_slope(0.2, "lying"), can.slip_slope(0.2, "standing")])
        array([0.6, 0.2, 0.2])
        """
        return self._limit_of_slope(0, posture, reals("mu", mu), phi, theta)

    @elementwise
    def tip_slope(self, posture: Posture = "standing", *, phi: Reals = 0.0, theta: Reals = None) -> Result:
        """Slope of the table, in radians, beyond which the body at rest on it tips over; pi/2 if never.

        A body that stands on its face tips over the edge if tan(slope) > a/Z, with the radius a of the face
        and the height Z of the centre of mass. A body on its side with phi = 0 tips over its lower circle.
        The body slips before it tips if `slip_slope` is less than `tip_slope`. Arguments, shapes and errors
        are those of `slip_slope`.

        Examples
        --------
        >>> import spincyl as sc
        >>> can = sc.Body.solid(2.0)
        >>> np.tan([can.tip_slope(), can.tip_slope("lying")])
        array([0.5, 2. ])
        """
        return self._limit_of_slope(1, posture, 0.0, phi, theta)

    def _limit_of_slope(self, which: int, posture: Posture, mu: Reals, phi: Reals, theta: Reals) -> Result:
        code, phi = POSTURES.index(one_of("posture", posture, POSTURES)), radians("phi", phi)
        rests = () if code == 0 or self.rims is None or theta is not None else self.rests()
        theta = (self.borders[rests[0]] if rests else 0.0) if theta is None else theta
        theta = radians("theta", theta, "0, pi or one of body.borders")
        if self.rims is None or code == 0:
            given = code, phi, *self._at(theta)[1:]
            found = _core.tip_slope(*given) if which else _core.slip_slope(mu, *given)
        else:
            self._told()
            body = [float(x) for x in self._raw], self._rows

            def of_circles(*given: Reals) -> float:
                return _core.slopes_of_circles(body, *given)[which]

            found = np.vectorize(of_circles, otypes=[float])(theta, mu, code, phi)[()]
        if is_scalar(found) and np.isnan(found):
            refuse_bad_value("mu", mu, lambda x: ~((x >= 0) & (x < np.inf)), "expected 0 <= mu, finite")
            needs = "a posture of this body; on one rim only a disk or a ball rolls, with its axis level"
            raise ValueError(f"posture = {posture!r}: expected {needs}")
        return found

    def boundaries(self, contact: Contact = "rolling") -> Result:
        """Inclinations, in radians, at which the stability of the steady states changes (kappa = 0).

        Order, shape and errors are those of `folds`. `contact` is "rolling" or "smooth", as for `stability`.
        """
        law = _core.boundary_rolling if is_rolling(contact) else _core.boundary_smooth
        return self._several(law)

    def folds(self) -> Result:
        """Inclinations at which the rate of the steady state is an extremum, so that two states merge.

        The inclinations are in radians, ascending, along a last axis of length 3 or 5 ("root"; see
        `inclinations`), padded with NaN. All are NaN for ell above 1e30 or I1/I3 above 1e60. The error is
        16 * 2^-53 times the condition number. The same holds for `ridge` and `boundaries`.
        """
        return self._several(_core.fold)

    def ridge(self) -> Result:
        """Inclinations, in radians, at which the energy of the steady state is an extremum.

        Order, shape and errors are those of `folds`.
        """
        return self._several(_core.ridge)

    # Quantities of a state.

    @elementwise
    def energy(self, state: State, contact: AnyContact = "rolling") -> Result:
        """Kinetic plus potential energy of a body in a state, in M g R; heights are above the table.

        The velocity of the centre follows from rolling and the slip of the state. With `contact="smooth"` the
        centre moves only up and down; a state with a slip then raises ValueError.
        """
        return self._energy(state, contact)

    def _energy(self, state: State, contact: AnyContact, rim: Any = None) -> Result:
        """Energy of a state that refers to the circle `rim`; default: the circle that touches the table."""
        if not isinstance(contact, Coulomb | Viscous) and not is_rolling(contact):
            why = "on a smooth table the centre moves only up and down; contact=sc.Coulomb(0.0) lets it slide"
            return _core.energy_smooth(*self._at(*numbers_without_slip(state, why), rim=rim))
        four = numbers(state)
        if state.slip is None:
            energy = _core.energy(*self._at(*four, rim=rim))
        else:
            energy = _core.energy_slip(*self._at(*four, *state._slip, rim=rim))
        if state.height is None:
            return energy
        rise = _core.centre_up(*self._at(*four, 0.0, 0.0, rim=rim))
        lift: Any = state.lift
        return energy + state.height + lift * (rise + 0.5 * lift)

    @elementwise
    def centre_velocity(self, state: State) -> tuple[Result, Result]:
        """Horizontal components of the velocity of the centre, along e_h and e2 of `State`, in sqrt(g R).

        A state without `slip` is taken as rolling.
        """
        numbers(state)
        return velocity_of(self, state)

    @elementwise
    def with_centre_velocity(self, state: State, along: Reals, across: Reals) -> State:
        """Return the state with the slip that a given velocity of the centre of mass implies.

        Parameters
        ----------
        state : State
            State whose slip, if it has one, is replaced.
        along, across : array_like
            Horizontal components of the velocity of the centre of mass, in sqrt(g R): along the vector
            e_h = cos(theta) e1 - sin(theta) e3, and along e2.

        Examples
        --------
        >>> import spincyl as sc
        >>> pipe = sc.Body.tube(6.0, bore=0.8)
        >>> spun = pipe.with_centre_velocity(sc.State(1.2, 3.0, 0.0, 4.0), 0.0, 0.0)
        >>> spun.slip
        (0.0, 14.0)
        """
        numbers(state)
        slip = slip_of(self, state, reals("along", along), reals("across", across))
        return replace(state, slip=slip)

    @elementwise
    def acceleration(self, state: State, contact: Contact = "rolling") -> Result:
        """Angular acceleration theta'' of the body in a state, in g/R; 0 if the state is steady.

        The state has no slip; `contact` is "rolling" or "smooth".
        """
        law = _core.acceleration if is_rolling(contact) else _core.acceleration_smooth
        found = law(*self._at(*numbers_without_slip(state, _ROLLS)))
        return found if self.rims is None else self._sign(state.theta) * found

    @elementwise
    def angular_momentum(self, state: State) -> Result:
        """Magnitude of the angular momentum of a state about the centre of mass, in M R^2 sqrt(g/R)."""
        return _core.angular_momentum(*self._at(*numbers(state)))

    @elementwise
    def beta(self, state: State) -> Result:
        """Angle from the symmetry axis to the angular momentum of a state, in radians."""
        return _core.beta(*numbers(state), *self._raw)

    @elementwise
    def speed_o(self, state: State) -> Result:
        """Speed of the point O, opposite to the contact point, in sqrt(g R).

        O is the mirror image of the contact point in the centre of mass; for a tube with sharp rims, the
        uppermost point of the upper rim. Its speed is 0 if the centre is at rest.
        """
        return _core.speed_o(*self._at(*numbers_without_slip(state, _ROLLS)))

    @elementwise
    def speed_x(self, state: State) -> Result:
        """Speed of the point X, the highest point of the circle of contact, in sqrt(g R).

        X is the highest point of the circle of the body along which it touches the table. With a sharp rim
        and the centre at rest its speed is 2 ell w1.
        """
        return _core.speed_x(*self._at(*numbers_without_slip(state, _ROLLS)))

    @elementwise
    def centre_radius(self, state: State) -> Result:
        """Radius of the circle on which the centre moves in a state, in R; infinite for a straight line."""
        return _core.centre_radius(*self._at(*numbers_without_slip(state, _ROLLS)))
