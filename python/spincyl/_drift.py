"""Slow drift along steady states until the body rests."""

import warnings
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._contact import CODES
from spincyl._input.equality import compared_by_value
from spincyl._input.hints import Hinting
from spincyl._input.numbers import (
    Floats,
    Reals,
    Result,
    common_shape,
    floats,
    in_columns,
    instance_of,
    is_scalar,
    one_of,
    radians,
    reals,
    si,
    with_common_shape,
)
from spincyl._input.threads import thread_count
from spincyl._loss import LAWS, checked_law
from spincyl._state import State, numbers_without_slip
from spincyl._upward import function_of_method
from spincyl.loss import film_fills

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CENTRES = ("rest", "rolling")
_ROLLS = "expected a state without slip, as dataclasses.replace(state, slip=None)"
_NO_DRIFT = "no drift"


_NO_COUPLE = "the law of dry contour friction is not valid below theta = eps, and this drift "


class DriftWarning(UserWarning):
    """A drift leaves the range in which its loss law is valid."""


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Drift(Hinting):
    """Slow drift of one body or of many, which starts at the time 0; the result of `drift`.

    Angles are in radians. Times are in sqrt(R/g), for a measured body in seconds; `precession` is then in
    rad/s. Each `State` is in natural units. Methods broadcast their argument against the shape of the drift:
    ``t[:, np.newaxis]`` evaluates each drift of a row at all times. A single value outside the drift raises
    ValueError; an array gives NaN there.

    Attributes
    ----------
    body : Body
        Body or family.
    losses : loss.Loss
        Loss law, or sum of loss laws.
    centre : {"rest", "rolling"}
        Whether slip keeps the centre at rest, or the body rolls.
    start : State
        State at the time 0; NaN in arrays where there is no drift.
    stops_at : float or array
        Time at which the drift ends; inf if it never ends, NaN where there is no drift. The relative error is
        below 1e-12 with centre="rest", and below 1e-10 with centre="rolling". Up to 0.99 of that time, states
        and precessions have the same relative error, however small they become; the error of w3 is relative
        to the larger of w1 and w3. Where theta falls as a high power n of the remaining time, rounding the
        time adds an error of 100 n 2^-52 at 0.99 of that time.
    ends_at_theta : float or array
        Inclination at the end, or the limit of the inclination if the drift never ends.
    ended : str or array of str
        How the drift ended:

        - "face lands": the face has landed, at theta = 0.
        - "lies down": the body lies on its side, at theta = pi/2.
        - "lowest state": no steady state nearby has less energy.
        - "balanced": the body is balanced on a point of its rim, at theta0.
        - "stands upright": a ball stands on its pole.
        - "no drift": there is no drift from this state, as in arrays with an impossible value.
        - "stability lost": kappa of `Body.stability` has reached 0. Only with centre="rolling".
        - "contact stops": psi' has reached 0, under dry contour friction or rolling resistance. Only with
          centre="rolling".
        - "drilling stops": the angular velocity about the vertical has reached 0, under drilling friction.
          Only with centre="rolling".
    """

    body: Body
    losses: Any
    centre: str
    start: State
    stops_at: Result
    ends_at_theta: Result
    ended: Any
    _columns: dict[str, Floats]
    _shape: tuple[int, ...]

    def time(self, theta: Reals) -> Result:
        """First time at which the inclination is `theta` (radians), in the unit of `stops_at`.

        Raises
        ------
        ValueError
            If a single drift never has this single inclination; an array gives NaN there.
        """
        return self._asked("theta", si("theta", theta, "radian"), 0)[0] * self.body._second

    def theta(self, t: Reals) -> Result:
        """Inclination at the time `t`, in radians; `t` is in the unit of `stops_at`.

        Raises
        ------
        ValueError
            If a single time is before 0 or after the end; an array gives NaN there.
        """
        return self._asked("t", t, 1)[0]

    def precession(self, t: Reals) -> Result:
        """Precession phi' at the time `t`, in sqrt(g/R), for a measured body in rad/s.

        With centre="rest" the precession is positive.
        """
        return self._asked("t", t, 1)[3] / self.body._second

    def state(self, t: Reals) -> State:
        """Steady state at the time `t`, in natural units; `t` is in the unit of `stops_at`."""
        theta, w1, w3, *_ = self._asked("t", t, 1)
        return State(theta, w1, 0.0 if is_scalar(theta) else np.zeros_like(theta), w3)

    def friction_coefficient(self, t: Reals) -> Result:
        """Coefficient of friction that the steady state at the time `t` needs.

        The coefficient is 0 with centre="rest". With centre="rolling" it is ``|V|`` Omega, where V is the
        velocity of the centre and Omega the precession.
        """
        return self._asked("t", t, 1)[4]

    @cached_property
    def stable_until(self) -> Result:
        """Time at which rolling becomes unstable, in sqrt(R/g), for a measured body in seconds.

        At this time kappa of `Body.stability` reaches 0. The time is inf if the drift stays stable, and 0 if
        it begins unstable. A drift with centre="rest" continues; a drift with centre="rolling" ends.
        """
        return self._asked("t", np.zeros(self._shape), 2)[0] * self.body._second

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """Draw inclination and precession against time, as `spincyl.plot.drift` does, and return the axes."""
        drawn: Axes = function_of_method("Drift.plot")(self, ax)
        return drawn

    def __repr__(self) -> str:
        unit = "" if self.body.scale is None else " s"
        what = f"<Drift of {self.body!r}, {self.losses}, centre={self.centre!r}: "
        if self._shape == ():
            return f"{what}{self.ended} at theta = {self.ends_at_theta:.6g}, t = {self.stops_at:.6g}{unit}>"
        return f"{what}shape {self._shape}>"

    def _asked(self, name: str, x: Reals, question: int) -> list[Result]:
        """Five numbers of the core for each `x`: an inclination (`question` 0), a time (1), or unused (2)."""
        if question == 1 and self.body.scale is not None:
            x = si(name, x, "second")
        if hasattr(x, "dims") or hasattr(x, "dask"):
            kind = type(x).__name__
            raise TypeError(
                f"{name}: expected numbers or a NumPy array, not {kind}; give its values, x.to_numpy()"
            )
        x = reals(name, x)
        single = is_scalar(x) and self._shape == ()
        wide = common_shape({name: x, "drift": np.broadcast_to(0.0, self._shape)})
        which = np.arange(int(np.prod(self._shape)), dtype=np.uint64).reshape(self._shape)
        of = np.ascontiguousarray(np.broadcast_to(which, wide)).reshape(-1)
        asked = np.ascontiguousarray(np.broadcast_to(floats(x), wide)).reshape(-1)
        asked = asked / self.body._second if question == 1 else asked
        order = np.argsort(of, kind="stable")
        out = np.empty((asked.size, 5))
        threads = thread_count(None)
        found_at = _core.drift_ask(self._columns, self.centre, question, of[order], asked[order], threads)
        out[order] = found_at.reshape(-1, 5)
        seen, eps = (asked if question == 0 else out[:, 0]), self._columns["eps"]
        eps = eps[0] if eps.size == 1 else eps[of]
        with np.errstate(invalid="ignore"):
            if question != 2 and np.any((seen < eps) & (seen > 0.0) & ~np.isnan(out[:, 0])):
                warnings.warn(_NO_COUPLE + "is evaluated there", DriftWarning, stacklevel=3)
        if single:
            found = [float(value) for value in out[0]]
            if np.isnan(found[0]) and name == "theta":
                low, high = sorted((float(np.asarray(self.start.theta)), self.ends_at_theta))
                told = f"expected {low:.6g} to {high:.6g}, the inclinations of this body with these losses"
                raise ValueError(f"theta = {asked[0]:.10g}: {told}")
            if np.isnan(found[0]) and question == 1:
                raise ValueError(f"t = {x!r}: expected 0 <= t <= stops_at = {self.stops_at!r}")
            return found
        return [np.ascontiguousarray(column).reshape(wide) for column in out.T]


def drift(
    body: Body, theta: Reals | State, losses: Any, centre: str = "rest", *, threads: int | None = None
) -> Drift:
    """Compute the slow drift of a body along its steady states until it rests.

    The drift is the motion of a body without nutation, to first order in the losses. With centre="rest" there
    is enough slip to keep the centre of mass at rest. The losses, of power P, lower the energy E(theta) of
    the steady state: theta' = -P/E'(theta). The inclination increases where E' < 0, beyond `Body.ridge`. With
    centre="rolling" the body never slips: its losses set the centre in motion on a circle, and the centre
    does not come to rest again.

    Parameters
    ----------
    body : Body
        Single body or family; a measured body drifts in seconds.
    theta : array_like or State
        Inclination, in radians, of an initial steady state with the centre at rest; or the initial steady
        state itself. With centre="rolling" the centre of this state may move on a circle.
    losses : loss.Loss
        Loss law of `spincyl.loss`, or several added with `+`. Coefficients may be arrays.
    centre : {"rest", "rolling"}
        Whether slip keeps the centre at rest, or the body rolls.
    threads : int, optional
        Largest number of threads; default: every core.

    Returns
    -------
    Drift
        Its shape is the broadcast shape of bodies, initial states and coefficients. Single arguments give
        single numbers.

    Raises
    ------
    ValueError
        If a single drift is impossible; the message names the argument. The inclination may be forbidden, or
        the state not steady to six digits. With centre="rest" the centre of the state must be at rest. With
        centre="rolling" the state must be stable (kappa > 0). Arrays have NaN and "no drift" there.

    Warns
    -----
    DriftWarning
        If a drift with dry contour friction starts at theta below eps, or is evaluated there before its end:
        the couple has no meaning below eps. If a measured body starts at an inclination at which the film of
        `AirFilm` does not fill the gap. A body without a scale gives no such warning.

    Notes
    -----
    With centre="rest" the steady states are those of Jackson et al., Am. J. Phys. 87, 85 (2019), Eq. 15. The
    time is t = -int E'/P dtheta, by Gaussian quadrature. With centre="rolling" the equation
    theta' = -(S_w1 a1 + S_w3 a3)/(J kappa) is integrated by steps of eighth order on the surface of circular
    steady states. Here S = J w2' for the rolling body, S_w1 and S_w3 are its derivatives, J is the inertia
    for changes of theta, and a1, a3 are the parts of w1' and w3' that are due to the couple.

    Examples
    --------
    >>> import spincyl as sc
    >>> coin = sc.Body.solid(0.085)
    >>> whirr = sc.drift(coin, 0.3, sc.loss.ViscousContour(1e-3))
    >>> whirr.ended, round(whirr.stops_at, 6)
    ('face lands', 17.70755)
    >>> sc.drift(coin, 0.3, sc.loss.ViscousContour(1e-3), centre="rolling").stops_at > whirr.stops_at
    True
    """
    instance_of("body", body, Body)
    one_of("centre", centre, _CENTRES)
    laws = checked_law(losses, body)._coefficients
    given = isinstance(theta, State)
    state = theta if isinstance(theta, State) else None
    if state is None:
        inclination = radians("theta", theta, body._leans)
        single = is_scalar(inclination, *body._numbers, *laws)
        if centre == "rolling" or single:
            state = body.steady(inclination)
        else:
            nothing = np.nan
            state = State(inclination, nothing, nothing, nothing)
    four = numbers_without_slip(state, _ROLLS)
    values = [*body._numbers, *four, *laws]
    shape = common_shape(
        {
            "body": with_common_shape(body),
            "theta": with_common_shape(state),
            "losses": with_common_shape(*laws),
        }
    )
    columns = dict(zip(_COLUMNS, in_columns(values, shape), strict=True))
    if shape == ():
        numbers = [float(x[0]) for x in columns.values()]
        _core.drift_check(numbers[:6], numbers[6:10], numbers[10:], centre)
    if given and centre == "rest":
        columns = _nan_unless_at_rest(body, state, columns, shape)
    count = int(np.prod(shape))
    stops, ends, codes = np.empty(count), np.empty(count), np.empty(count, np.uint8)
    out: dict[str, Any] = {"stops_at": stops, "ends_at_theta": ends, "ended": codes}
    _core.drift_stops(columns, centre, out, thread_count(threads))
    if body.scale is not None:
        stops = body.scale.seconds(stops)
    names = np.array([*CODES["Drift"], _NO_DRIFT])
    known = names[np.minimum(codes, len(names) - 1)].reshape(shape)
    if not given and centre == "rest" and shape != ():
        state = body.steady(inclination)
    if np.any((columns["eps"] > 0) & (columns["theta"] < columns["eps"])):
        warnings.warn(_NO_COUPLE + "starts there", DriftWarning, stacklevel=2)
    if body.scale is not None:
        fills = film_fills(columns["viscosity"], body.scale)
        if np.any((columns["viscosity"] > 0) & (columns["theta"] > fills)):
            below = f"below theta = {np.max(fills):.2g}"
            message = (
                f"the film of AirFilm fills the gap {below} only, and this drift starts above that: "
                "use loss.BoundaryLayer there"
            )
            warnings.warn(message, DriftWarning, stacklevel=2)
    if shape == ():
        return Drift(body, losses, centre, state, float(stops[0]), float(ends[0]), str(known), columns, shape)
    reshaped = stops.reshape(shape), ends.reshape(shape)
    return Drift(body, losses, centre, state, *reshaped, known, columns, shape)


#: The columns of drifts: bodies, states, and the coefficients of the loss laws.
_COLUMNS: tuple[str, ...] = (
    *("ell", "i1", "i3", "bore", "fillet", "theta_end", "theta", "w1", "w2", "w3"),
    *LAWS,
)


def _nan_unless_at_rest(
    body: Body, state: State, columns: dict[str, Floats], shape: tuple[int, ...]
) -> dict[str, Floats]:
    """Return `columns` with theta = NaN (no drift) where the state's centre is not at rest to six digits."""
    rests = np.broadcast_to(_core.rests(*state._numbers, *body._numbers) == 1, shape)
    if shape == () and not rests:
        own = body.steady(state.theta)
        message = f"state = {state!r}: expected {own!r}, whose centre is at rest, or give centre='rolling'"
        raise ValueError(message)
    theta = np.where(rests.reshape(-1), columns["theta"], np.nan)
    return columns | {"theta": np.ascontiguousarray(theta, np.float64)}
