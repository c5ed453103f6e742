"""Slow drift along steady states until the body rests."""

import warnings
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._contact import CODES
from spincyl._input.equality import compared
from spincyl._input.numbers import (
    Floats,
    Reals,
    Result,
    fitting,
    floats,
    in_columns,
    is_scalar,
    made,
    of_its_shape,
    one_of,
    radians,
    reals,
    si,
)
from spincyl._input.threads import thread_count
from spincyl._loss import made_law
from spincyl._state import State, gripping
from spincyl._upward import above
from spincyl.loss import film_fills

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_CENTRES = ("rest", "rolling")
_ROLLS = "expected a state without slip, as dataclasses.replace(state, slip=None)"
_NOBODY = "no drift"


_NO_COUPLE = "dry contour friction has no meaning below theta = eps, and this drift "


class DriftWarning(UserWarning):
    """A drift leaves the range in which its law of loss is valid."""


@compared
@dataclass(frozen=True, eq=False, repr=False)
class Drift:
    """Slow drift of one body, or of many, from the time 0 on; the result of `drift`.

    Times are in sqrt(R/g), angles in radians; for a measured body times are in s, `precession` in rad/s.
    Each `State` is in natural units. Methods broadcast their argument against the shape of the drift: with
    ``t[:, np.newaxis]`` a row of drifts is evaluated at all times. Outside the drift, single values raise
    ValueError, and arrays have NaN.

    Attributes
    ----------
    body : Body
        Body or family.
    losses : loss.Loss
        Laws of loss.
    centre : {"rest", "rolling"}
        Whether the centre is held at rest, or the body rolls.
    start : State
        State at the time 0; NaN in arrays where there is no drift.
    stops_at : float or array
        Time at which the drift ends; inf if it never ends, NaN where there is no drift. Relative error below
        1e-12 with centre="rest", 1e-10 with centre="rolling". States and precessions have the same relative
        error up to 0.99 of that time (w3 relative to the larger of w1 and w3), however small they become.
        Where theta falls as a high power n of the remaining time, rounding the time adds 100 n 2^-52 at 0.99
        of that time.
    ends_at_theta : float or array
        Inclination at the end, or the limit of a drift that never ends.
    ended : str or array of str
        How the drift ended: "face lands", "lies down", "lowest state" (the energy is least along the branch),
        "balanced" (on a point of the rim), "stands upright" (a ball on its pole), "no drift". With
        centre="rolling" also "stability lost" (kappa of `Body.stability` reaches 0), "contact stops"
        (psi' = 0 with dry contour friction or rolling resistance), "drilling stops" (w_z = 0 with drilling
        friction).
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
        """First time at which the inclination is `theta` (radians); relative error as for `stops_at`.

        Raises
        ------
        ValueError
            If a single drift never has this single inclination; arrays have NaN there.
        """
        return self._asked("theta", si("theta", theta, "radian"), 0)[0] * self.body._second

    def theta(self, t: Reals) -> Result:
        """Inclination at a time, in radians; relative error as for `stops_at`.

        Raises
        ------
        ValueError
            If a single time is before 0 or after the end; arrays have NaN there.
        """
        return self._asked("t", t, 1)[0]

    def precession(self, t: Reals) -> Result:
        """Precession phi' at a time, in sqrt(g/R) or rad/s; errors as `theta`.

        With centre="rest" it is the positive rate Omega.
        """
        return self._asked("t", t, 1)[3] / self.body._second

    def state(self, t: Reals) -> State:
        """Steady state at a time, in natural units; errors as `theta`."""
        theta, w1, w3, *_ = self._asked("t", t, 1)
        return State(theta, w1, 0.0 if is_scalar(theta) else np.zeros_like(theta), w3)

    def friction_coefficient(self, t: Reals) -> Result:
        """Coefficient of friction that the steady state at a time needs; errors as `theta`.

        It is 0 with centre="rest", and ``|V|`` Omega with centre="rolling", where V is the velocity of the
        centre.
        """
        return self._asked("t", t, 1)[4]

    @cached_property
    def stable_until(self) -> Result:
        """Time at which rolling becomes unstable, in sqrt(R/g), in seconds for a measured body.

        There kappa of `Body.stability` is 0. inf if the drift stays stable, 0 if it begins unstable. A drift
        with centre="rest" continues after that time; one with centre="rolling" ends there.
        """
        return self._asked("t", np.zeros(self._shape), 2)[0] * self.body._second

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """Draw inclination and precession against time; see `spincyl.plot.drift`."""
        drawn: Axes = above("Drift.plot")(self, ax)
        return drawn

    def __repr__(self) -> str:
        unit = "" if self.body.scale is None else " s"
        what = f"<Drift of {self.body!r}, {self.losses}, centre={self.centre!r}: "
        if self._shape == ():
            return f"{what}{self.ended} at theta = {self.ends_at_theta:.6g}, t = {self.stops_at:.6g}{unit}>"
        return f"{what}shape {self._shape}>"

    def _asked(self, name: str, x: Reals, question: int) -> list[Result]:
        """The five numbers that the core returns for each x: theta (code 0), time (1), or unused (2)."""
        if question == 1 and self.body.scale is not None:
            x = si(name, x, "second")
        x = reals(name, x)
        single = is_scalar(x) and self._shape == ()
        wide = fitting({name: x, "drift": np.broadcast_to(0.0, self._shape)})
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
                told = f"expected an inclination of the drift, from {low:.6g} to {high:.6g}"
                raise ValueError(f"theta = {asked[0]:.10g}: {told}")
            if np.isnan(found[0]) and question == 1:
                raise ValueError(f"t = {x!r}: expected 0 <= t <= stops_at = {self.stops_at!r}")
            return found
        return [np.ascontiguousarray(column).reshape(wide) for column in out.T]


def drift(
    body: Body, theta: Reals | State, losses: Any, centre: str = "rest", *, threads: int | None = None
) -> Drift:
    """Compute the slow drift of a body along its steady states until it rests.

    The drift is the motion to first order in the losses of a body without nutation. With centre="rest" the
    centre of mass stays at rest, kept there by enough slip, and the energy E(theta) of the steady states
    falls: theta' = -P/E'(theta). Above a ridge of the energy the inclination increases. With centre="rolling"
    the body never slips: the losses move its centre from rest onto circles, and the centre does not return.

    Parameters
    ----------
    body : Body
        Single body or family; a measured body drifts in seconds.
    theta : array_like or State
        Inclination in radians of the initial steady state, whose centre rests; or a steady state, with
        centre="rolling" also one whose centre moves on a circle.
    losses : loss.Loss
        Law of `spincyl.loss`, or several added with `+`; their coefficients may be arrays.
    centre : {"rest", "rolling"}
        Whether slip keeps the centre at rest, or the body rolls.
    threads : int, optional
        Largest number of threads; default: every core.

    Returns
    -------
    Drift
        Broadcast shape of bodies, initial states and coefficients; single numbers for single arguments.

    Raises
    ------
    ValueError
        If a single drift is impossible: no steady state at a forbidden inclination, a state that is not
        steady to six digits, with centre="rest" a state whose centre moves, with centre="rolling" an unstable
        state (kappa <= 0). The message names the argument. Arrays have NaN and "no drift" there.

    Warns
    -----
    DriftWarning
        If a drift with dry contour friction starts, or is evaluated before its end, at theta below eps, where
        the couple has no meaning. If a measured body starts at an inclination at which the film of `AirFilm`
        does not fill the gap; without a scale this is not known.

    Notes
    -----
    centre="rest": Jackson et al., Am. J. Phys. 87, 85 (2019), Eq. 15, and t = -int E'/P dtheta by Gaussian
    quadrature. centre="rolling": theta' = -(S_w1 a1 + S_w3 a3)/(J kappa) by steps of eighth order on the
    surface of circular steady states, where S = J w2' for the rolling body, and a1, a3 are the parts of w1'
    and w3' that are due to the couple.

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
    made("body", body, Body)
    one_of("centre", centre, _CENTRES)
    laws = made_law(losses, body)._coefficients
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
    four = gripping(state, _ROLLS)
    values = [*body._numbers, *four, *laws]
    shape = fitting({"body": of_its_shape(body), "theta": of_its_shape(state), "losses": of_its_shape(*laws)})
    columns = dict(zip(_COLUMNS, in_columns(values, shape), strict=True))
    if shape == ():
        numbers = [float(x[0]) for x in columns.values()]
        _core.drift_check(numbers[:6], numbers[6:10], numbers[10:], centre)
    if given and centre == "rest":
        columns = _resting(body, state, columns, shape)
    count = int(np.prod(shape))
    stops, ends, codes = np.empty(count), np.empty(count), np.empty(count, np.uint8)
    out: dict[str, Any] = {"stops_at": stops, "ends_at_theta": ends, "ended": codes}
    _core.drift_stops(columns, centre, out, thread_count(threads))
    if body.scale is not None:
        stops = body.scale.seconds(stops)
    names = np.array([*CODES["Drift"], _NOBODY])
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
                "see loss.BoundaryLayer"
            )
            warnings.warn(message, DriftWarning, stacklevel=2)
    if shape == ():
        return Drift(body, losses, centre, state, float(stops[0]), float(ends[0]), str(known), columns, shape)
    reshaped = stops.reshape(shape), ends.reshape(shape)
    return Drift(body, losses, centre, state, *reshaped, known, columns, shape)


#: The columns of drifts: bodies, states, and the coefficients of the laws of loss.
_COLUMNS: tuple[str, ...] = (
    *("ell", "i1", "i3", "bore", "fillet", "theta_end", "theta", "w1", "w2", "w3"),
    *(name for name, _ in _core.loss_laws()),
)


def _resting(
    body: Body, state: State, columns: dict[str, Floats], shape: tuple[int, ...]
) -> dict[str, Floats]:
    """`columns` with theta = NaN, so no drift, where the state's centre does not rest to six digits."""
    rests = np.broadcast_to(_core.rests(*state._numbers, *body._numbers) == 1, shape)
    if shape == () and not rests:
        own = body.steady(state.theta)
        message = f"state = {state!r}: centre='rest' needs the state whose centre rests, {own!r}"
        raise ValueError(message)
    theta = np.where(rests.reshape(-1), columns["theta"], np.nan)
    return columns | {"theta": np.ascontiguousarray(theta, np.float64)}
