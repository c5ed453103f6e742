"""Properties of a body, its stability, and quantities of its states: each is one function of the core."""

import warnings
from dataclasses import replace
from enum import IntEnum
from typing import Any

import numpy as np

from spincyl import _core
from spincyl._contact import AnyContact, Contact, Coulomb, Viscous, rolls
from spincyl._input.numbers import Reals, Result, elementwise, keywords, radians, reals, several
from spincyl._input.reprs import is_lazy
from spincyl._slip import slip_of, velocity_of
from spincyl._state import State, gripping, numbers

_ROLLS = "this is asked of a body whose lowest point is at rest; dataclasses.replace(state, slip=None) is one"


class Region(IntEnum):
    """What is known about a steady state with the centre at rest (a code on grids)."""

    INVALID = 0  #: no question: theta outside (0, pi/2], or no such body
    FORBIDDEN = 1  #: no steady state, between theta_balance and theta_limit
    UNDETERMINED = 2  #: too close to either for double precision to decide
    UNSTABLE = 4  #: unstable on a smooth table and rolling
    STABLE_ROLLING = 5  #: unstable on a smooth table, stable when rolling
    STABLE_SMOOTH = 6  #: stable on a smooth table, unstable when rolling
    STABLE = 7  #: stable by both


def _say_why(body: "Laws", state: State, kappa: Result) -> None:
    """Warn of states that are not steady because the body stands on more than one point; skip lazy arrays."""
    theta = state.theta
    if any(is_lazy(x) or hasattr(x, "dims") for x in (kappa, theta, *body._numbers)):
        return
    two = _core.two_rims(*body._numbers) == 1
    for place, standing, more in (
        ("pi/2", two & (theta == np.pi / 2), ": launch_number(body, state) says whether one of them rises"),
        ("0", (body.fillet < 1) & (theta == 0), ""),
    ):
        if np.any(np.isnan(kappa) & standing):
            on = "both its rims" if more else "its whole face"
            why = "is False, since stability is that of a body on one point, and this is not steady there"
            warnings.warn(
                f"at: at theta = {place} the body stands on {on}, and stable {why}{more}", stacklevel=4
            )


class Laws:
    """Base of `Body`: the methods that evaluate one law each."""

    ell: Reals
    i1: Reals
    i3: Reals
    bore: Reals
    fillet: Reals
    theta_end: Reals

    @property
    def _numbers(self) -> tuple[Reals, Reals, Reals, Reals, Reals, Reals]:
        return self.ell, self.i1, self.i3, self.bore, self.fillet, self.theta_end

    @property
    def _most(self) -> int:
        raise NotImplementedError

    @property
    def _leans(self) -> str:
        """The range of theta, in the words of the core, for messages of errors."""
        raise NotImplementedError

    # Quantities of the shape alone.

    @property
    def theta_balance(self) -> Result:
        """theta0, radians: balanced on a point of the rim, at rest; NaN of a ball."""
        return _core.theta_balance(*self._numbers)

    @property
    def theta_limit(self) -> Result:
        """thetaInf, radians: where the steady rate grows without bound."""
        return _core.theta_limit(*self._numbers)

    @property
    def excess(self) -> Result:
        """I1/I3 - 1: positive for a cylinder, negative for a disk, zero at the critical aspect."""
        return _core.excess(*self._numbers)

    @elementwise
    def angular_rate(self, rate: Reals) -> Result:
        """Omega = Omega~ / sqrt(I3): precession rate in sqrt(g/R) of a reduced rate."""
        return reals("rate", rate) / np.sqrt(self.i3)

    # Stability, on a smooth table or in rolling.

    @elementwise
    def stability(self, at: Reals | State, contact: Contact = "rolling", **ufunc: Any) -> Result:
        """kappa: squared angular frequency of the nutation, in g/R; negative where unstable.

        Parameters
        ----------
        at : array_like or State
            An inclination in (0, pi/2] (radians), meaning the steady state with the centre at
            rest; or any steady state. What `circular` gives is steady when rolling; on a smooth
            table, which has no friction to keep a centre circling, it is not.
        contact : {"rolling", "smooth"}
            "rolling": the linearised motion without slipping. "smooth": the energy criterion of
            Jackson et al. (Appendix), exact on a frictionless table. They disagree on about an
            eighth of the steady states of cylinders and disks (11.8 % of those with ell up to 3).
        **ufunc
            `out=`, `where=` and the other keywords of NumPy's ufuncs.

        Returns
        -------
        float or array
            NaN where there is no steady state, or a given one is not steady to six digits. Error at
            rest 16 (1 + cond) ulp (2^-53) of its larger term, ``cond = cos/|n| + (a cos + ell sin)/|m|``;
            of a state 64 ulp of its largest term, for theta above 1e-100.
        """
        rolling = rolls(contact)
        if isinstance(at, State):
            law = _core.state_kappa_rolling if rolling else _core.state_kappa_smooth
            return law(*gripping(at, _ROLLS), *self._numbers, **keywords(law, ufunc, "stability"))
        law = _core.kappa_rolling if rolling else _core.kappa_smooth
        return law(radians("at", at, self._leans), *self._numbers, **keywords(law, ufunc, "stability"))

    @elementwise
    def stable(self, at: Reals | State, contact: Contact = "rolling") -> Result:
        """Whether a small disturbance stays small; False where the state is not steady.

        It is that of a body on one point of one rim. At theta = pi/2 a body with two rims stands on both, and
        at theta = 0 on its whole face: a `State` there that is not steady on one point is False as well,
        which says nothing of what two rims or a face hold.

        Warns
        -----
        UserWarning
            Of such states: why they are False. `launch_number` says whether one of two rims rises.
        """
        kappa = self.stability(at, contact)
        if isinstance(at, State):
            _say_why(self, at, kappa)
        return kappa > 0

    @elementwise
    def nutation(self, at: Reals | State, contact: Contact = "rolling") -> Result:
        """Angular frequency of the nutation in sqrt(g/R): 0 where unstable, NaN where not steady."""
        return _core.nutation(self.stability(at, contact))

    @elementwise
    def growth_rate(self, at: Reals | State, contact: Contact = "rolling") -> Result:
        """Rate at which a small disturbance grows, in sqrt(g/R): 0 where stable, NaN where not steady."""
        return _core.growth_rate(self.stability(at, contact))

    def standing_spin(self, contact: Contact = "rolling") -> Result:
        """The least spin w3, in sqrt(g/R), with which a ball stands upright on its pole, as a top sleeps.

        0 where it stands at rest, NaN of a body that is no ball. Error 4 ulp (2^-53).
        """
        law = _core.standing_rolling if rolls(contact) else _core.standing_smooth
        return law(*self._numbers)

    @elementwise
    def painleve(self, theta: Reals) -> Result:
        """mu_P: coefficient of friction from which on a slip may have no contact force, or more than one.

        That of a slip along the lean which carries the contact away from under the centre, as of chalk that
        is pushed; infinite where the body is balanced. Uniform tubes are safe below sqrt(5)/2 = 1.118.
        """
        return _core.painleve(radians("theta", theta, self._leans), *self._numbers)

    def boundaries(self, contact: Contact = "rolling") -> Result:
        """Inclinations where the stability changes: shape and limits as `folds`."""
        law = _core.boundary_rolling if rolls(contact) else _core.boundary_smooth
        return law(*several(self._most, *self._numbers))

    def folds(self) -> Result:
        """Inclinations where the rate turns along the branch: there two states of a rate meet.

        Radians, last axis 3 or 5 ("root"; see `inclinations`), ascending, NaN-padded. Not computed, and NaN,
        for ell above 1e30 or I1/I3 above 1e60. Error 16 ulp (2^-53) times the conditioning; so for `ridge`
        and `boundaries`.
        """
        return _core.fold(*several(self._most, *self._numbers))

    def ridge(self) -> Result:
        """Inclinations where the energy is stationary along the branch: shape and limits as `folds`."""
        return _core.ridge(*several(self._most, *self._numbers))

    # Quantities of a state.

    @elementwise
    def energy(self, state: State, contact: AnyContact = "rolling") -> Result:
        """Kinetic and potential energy, in M g R, from the table up.

        That of the slip is counted. On a smooth table (`contact="smooth"`) the centre moves up and down only,
        so that a state with a slip is refused.
        """
        if not isinstance(contact, Coulomb | Viscous) and not rolls(contact):
            why = "on a smooth table the centre is at rest; contact=sc.Coulomb(0.0) lets it slide"
            return _core.energy_smooth(*gripping(state, why), *self._numbers)
        four = numbers(state)
        if state.slip is None:
            energy = _core.energy(*four, *self._numbers)
        else:
            energy = _core.energy_slip(*four, *state._slip, *self._numbers)
        if state.height is None:
            return energy
        rise = _core.centre_up(*four, 0.0, 0.0, *self._numbers)
        lift: Any = state.lift
        return energy + state.height + lift * (rise + 0.5 * lift)

    @elementwise
    def centre_velocity(self, state: State) -> tuple[Result, Result]:
        """Horizontal velocity of the centre of mass, sqrt(g R): along the lean, and across it (see `State`).

        Of a state without a slip it is that of rolling.
        """
        numbers(state)
        return velocity_of(self, state)

    @elementwise
    def with_centre_velocity(self, state: State, along: Reals, across: Reals) -> State:
        """The state whose slip is the one that this horizontal velocity of the centre means.

        Parameters
        ----------
        state : State
            Its slip, if it has one, is replaced.
        along, across : array_like
            Velocity of the centre of mass in sqrt(g R): in the horizontal direction of the lean,
            cos(theta) e1 - sin(theta) e3, and across it, along e2.

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
        """Theta'' in g/R: how the tilting of any state changes. 0 where it is steady."""
        law = _core.acceleration if rolls(contact) else _core.acceleration_smooth
        return law(*gripping(state, _ROLLS), *self._numbers)

    @elementwise
    def angular_momentum(self, state: State) -> Result:
        """Magnitude of the angular momentum about the centre, in M R^2 sqrt(g/R)."""
        return _core.angular_momentum(*numbers(state), *self._numbers)

    @elementwise
    def beta(self, state: State) -> Result:
        """Angle from the symmetry axis to the angular momentum, in radians."""
        return _core.beta(*numbers(state), *self._numbers)

    @elementwise
    def speed_o(self, state: State) -> Result:
        """Speed of O, opposite to the contact beyond the centre, in sqrt(g R): 0 if the centre rests.

        Of a tube with sharp rims it is the uppermost point of the upper one.
        """
        return _core.speed_o(*gripping(state, _ROLLS), *self._numbers)

    @elementwise
    def speed_x(self, state: State) -> Result:
        """Speed of X, the top of the circle of contact, in sqrt(g R); sharp, 2 ell w1 if the centre rests."""
        return _core.speed_x(*gripping(state, _ROLLS), *self._numbers)

    @elementwise
    def centre_radius(self, state: State) -> Result:
        """Radius of the circle that the centre runs along, in R; 0 at rest, infinite along a line."""
        return _core.centre_radius(*gripping(state, _ROLLS), *self._numbers)
