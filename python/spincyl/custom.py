"""Custom laws: a couple that takes energy, friction that depends on the speed, a force that drives a body.

Each law is a Python function, or a C function (``numba.cfunc``, ctypes, ``scipy.LowLevelCallable``), which is
called without Python in about a hundredth of the time; a motion calls a law thousands of times.
`sc.roll` and `sc.sweep.roll` check the law before a motion begins: its values must be finite and without
jumps, and a couple must not add energy, unless it is a `Drive`, such as a motor or a wind. A dry law
contains the sign of a speed, which jumps. Smooth it: ``tanh(x/e)`` in place of ``sign(x)``.

>>> import numpy as np
>>> import spincyl as sc
>>> cubic = sc.custom.Couple(lambda theta, w, normal: -0.01 * (w @ w) * w)
>>> coin = sc.Body.solid(0.1)
>>> m = sc.roll(coin, coin.steady(0.5), np.linspace(0, 5, 11), losses=cubic)
>>> float(m.work_lost[-1].round(4))
0.1411
"""

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from spincyl._body import Body
from spincyl._contact import WHERE_OWN_LAWS_WORK, Coulomb
from spincyl._input.equality import equality_key
from spincyl._input.numbers import Floats, Reals, Result, number
from spincyl._input.pointers import COUPLE, FRICTION, Pointer, pointer
from spincyl._loss import Law, Loss
from spincyl._scale import Scale
from spincyl._state import State

__all__ = ["Couple", "Drive", "Friction", "Moment"]


def __dir__() -> list[str]:
    return [*__all__, *(name for name in globals() if name.startswith("__"))]


#: A couple from theta, w along e1, e2, e3 (an array of 3), and the normal force.
CoupleFunction = Callable[[float, Floats, float], Sequence[float] | Floats]


def _called(name: str, function: object, arguments: str) -> None:
    if not callable(function):
        raise TypeError(f"{name}: expected a function of {arguments}, not {type(function).__name__}")


@dataclass(frozen=True, eq=False, repr=False)
class _Own(Loss):
    """Base of loss laws that are functions, which can be added to laws of the library."""

    function: Callable[..., Any]
    _others: ClassVar[Loss | None] = None  # the laws of the library in a sum

    @property
    def laws(self) -> tuple[Law, ...]:
        """Raises TypeError, since a law that is a function has no coefficients to list."""
        raise TypeError(f"losses = {self!r}: {WHERE_OWN_LAWS_WORK}, for bodies of revolution")

    @property
    def _built_in(self) -> Loss | None:
        return self._others

    def __add__(self, other: Loss) -> Loss:
        if getattr(other, "_function", None) is not None:
            raise TypeError(f"losses = {self!r} + {other!r}: expected at most one law of your own in a sum")
        return self._beside(other if self._others is None else self._others + other)

    def __radd__(self, other: Any) -> Loss:
        return self + other if isinstance(other, Loss) else super().__radd__(other)

    def _beside(self, others: Loss | None) -> Self:
        found = type(self)(self.function)
        object.__setattr__(found, "_others", others)
        return found

    def __eq__(self, other: object) -> bool:
        same = type(other) is type(self)
        return same and (other.function, other._others) == (self.function, self._others)  # type: ignore[attr-defined]

    def __hash__(self) -> int:
        return hash(self.function)

    def __repr__(self) -> str:
        more = "" if self._others is None else f" + {self._others!r}"
        return f"custom.{type(self).__name__}({_named(self.function)}){more}"

    __str__ = __repr__  # without coefficients there is no unit to print


@dataclass(frozen=True, eq=False, repr=False)
class Couple(_Own):
    """Loss law given by a function of inclination, angular velocity and normal force.

    Parameters
    ----------
    function : callable
        ``function(theta, w, normal)`` returns the couple on the body, in M g R: its three components along
        e1, e2, e3 of `State`. The arguments of the function are the inclination `theta` in radians, the
        angular velocity `w` in sqrt(g/R) (an array of its components along the same axes), and the normal
        force `normal` in M g, 0 or more; in the air it is 0, and for a body with two rims all of them refer
        to the lower rim. For a measured body the units are N m, rad/s and N. The power that the couple takes,
        ``-couple @ w``, must not be negative.

    Raises
    ------
    TypeError
        If `function` is not callable, or is a C function of another signature. Also if the law is used for
        a drift, for a stone, or for lazy arrays.
    ValueError
        In `sc.roll` and `sc.sweep.roll`, if the couple adds energy, is not finite, or jumps; the message
        gives a value.

    Notes
    -----
    The couples of a sum of this law and laws of `sc.loss` add. The motion is integrated with the tolerance
    `tol` of `sc.roll`, by default 1e-10 for each step. `Motion.error` is estimated from a second run with
    a larger tolerance.
    """

    function: CoupleFunction
    _units: ClassVar[tuple[float, float, float]] = (1.0, 1.0, 1.0)  # of the numbers of a C function
    _pointer: ClassVar[Pointer | None] = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "_pointer", pointer(self.function, COUPLE))
        if self._pointer is None:
            _called("function", self.function, "theta, w and the normal force")

    @property
    def _function(self) -> Any:
        return self.function if self._pointer is None else (self._pointer.address, self._units)

    def _natural(self, scale: Scale | None) -> Loss:
        if scale is None:
            return self
        joules, rate = scale._joule("a couple"), 1.0 / scale._units[1]
        newtons = joules / scale._units[0]
        if self._pointer is not None:
            found = self._beside(self._others)
            object.__setattr__(found, "_units", (rate, newtons, joules))
            return found

        def natural(theta: float, w: Floats, normal: float) -> Floats:
            return np.asarray(self.function(theta, rate * w, newtons * normal)) / joules

        return type(self)(natural)._beside(self._others)

    def couple(self, body: Body, state: State, normal: Reals = 1.0) -> Result:
        """Couple of this law and of the laws added to it in a single state, along e1, e2, e3, in M g R."""
        w = np.array([state.w1, state.w2, state.w3], dtype=float)
        others = 0.0 if self._others is None else self._others.couple(body, state, normal)
        if self._pointer is None:
            return others + np.asarray(self.function(float(state.theta), w, float(normal)), dtype=float)
        from ctypes import c_double

        found = (c_double * 3)()
        self._pointer.call((c_double * 5)(state.theta, *w, normal), found)
        return others + np.array(found)

    def power(self, body: Body, state: State, normal: Reals = 1.0) -> Result:
        """Power that the law takes in a single state, ``-couple @ w``."""
        return -float(self.couple(body, state, normal) @ np.array([state.w1, state.w2, state.w3]))


@dataclass(frozen=True)
class Moment:
    """Position and velocity of a driven body at a time: the argument of the function of a `Drive`.

    Attributes
    ----------
    time : float
        Time, in sqrt(R/g), or in s for a measured body.
    theta : float
        Inclination of the axis, in radians; for a body with two rims, that of the lower rim.
    w : ndarray
        Angular velocity along e1, e2, e3 of `State`, in sqrt(g/R), or in rad/s.
    slip : ndarray
        Slip along e_h and e2 of `State`, in sqrt(g R), or in m/s; zeros where the body rolls. In the air:
        the velocity of the lowest point over the table.
    phi, psi : float
        Heading of e_h over the table and turn about the axis, in radians, as `Motion.phi` and `Motion.psi`.
    contact_point : ndarray
        Place of the contact point on the table, or below the lowest point in the air, in R, or in m.
    height : float
        Height of the lowest point, in R, or in m; 0 on the table.
    velocity : ndarray
        Velocity of the centre of mass along x and y of the table, in sqrt(g R), or in m/s.
    axes : ndarray
        Axes e1, e2, e3 as the columns of a 3 x 3 array, along x, y and the upward z: ``axes @ m`` turns a
        couple along e1, e2, e3 into one along x, y, z, and ``axes.T @ m`` turns it back. e1 and e2 follow
        the inclination, not the turn `psi` of the body about its axis.
    """

    time: float
    theta: float
    w: Floats
    slip: Floats
    phi: float
    psi: float
    contact_point: Floats
    height: float
    velocity: Floats
    axes: Floats


@dataclass(frozen=True, eq=False, repr=False)
class Drive(_Own):
    """Force and couple that drive a body, such as a motor, a wind or a finger. They may add energy.

    Parameters
    ----------
    function : callable
        ``function(now)`` gets a `Moment` and returns two vectors: the horizontal force on the centre of
        mass along x and y of the table, in M g, and the couple along e1, e2, e3 of `State`, in M g R. For a
        measured body all units are SI. A force at another point is this force with its couple about the
        centre.

    Raises
    ------
    TypeError
        If `function` is not a Python function, or for a stone, a drift or lazy arrays.
    ValueError
        In `sc.roll` and `sc.sweep.roll`, if a value is not finite; and for a smooth table, a table that
        turns, a patch of contact, a body on its face, and beside losses that hold a body at rest: dry
        friction along the rim, drilling friction and rolling resistance.

    Notes
    -----
    The drive is given as ``losses=``, alone or in a sum with laws of `sc.loss`: `Motion.work_lost` is the
    energy that these laws take minus the work of the drive. The sum of the energy, the heat of friction and
    `work_lost` is then constant. The motion ends where a face or a second rim lands and, without a
    restitution, where the body leaves the table. A value that jumps, such as a motor that is switched on,
    costs short steps. A pulse that is shorter than a hundredth of sqrt(R/g) while the body is at rest may be
    missed: begin a new motion at the pulse.

    Examples
    --------
    A shaken table is a table at rest with a force: a ball rolls with 5/7 of its acceleration.

    >>> import numpy as np
    >>> import spincyl as sc
    >>> shakes = sc.custom.Drive(lambda now: ((0.2 * np.sin(now.time), 0.0), (0.0, 0.0, 0.0)))
    >>> ball = sc.Body.ball(0.0, i1=0.4, i3=0.4)
    >>> at_rest = sc.State(np.pi / 2, 0.0, 0.0, 0.0)
    >>> m = sc.roll(ball, at_rest, [0.0, 2.0], losses=shakes, contact=sc.Coulomb(0.5), want="pose")
    >>> float(m.contact_point[1, 0].round(9)), float((0.2 * 5 / 7 * (2.0 - np.sin(2.0))).__round__(9))
    (0.155814653, 0.155814653)
    """

    function: Callable[[Moment], tuple[Any, Any]]
    _units: ClassVar[tuple[float, ...]] = (1.0, 1.0, 1.0, 1.0)  # of length, time, force and couple
    _drives: ClassVar[bool] = True

    def __post_init__(self) -> None:
        _called("function", self.function, "a Moment")
        if pointer(self.function, COUPLE) is not None:
            raise TypeError("function: expected a Python function of a Moment, not a C function")

    @property
    def _function(self) -> Any:
        length, time, force, couple = self._units
        speed = length / time

        def push(now: Floats) -> Floats:
            moment = Moment(
                time=time * float(now[0]),
                theta=float(now[1]),
                w=now[2:5] / time,
                slip=speed * now[5:7],
                phi=float(now[7]),
                psi=float(now[8]),
                contact_point=length * now[9:11],
                height=length * float(now[11]),
                velocity=speed * now[12:14],
                axes=now[14:].reshape(3, 3),
            )
            found = self.function(moment)
            try:
                (x, y), (m1, m2, m3) = found
                return np.array([x, y, m1, m2, m3], dtype=float) / ([force] * 2 + [couple] * 3)
            except (TypeError, ValueError):
                expected = "a force along x and y, and a couple along e1, e2, e3"
                raise TypeError(f"drive: its function has to return {expected}, not {found!r}") from None

        return push

    def _natural(self, scale: Scale | None) -> Loss:
        if scale is None:
            return self
        joules, (length, time) = scale._joule("a drive"), scale._units[:2]
        found = self._beside(self._others)
        object.__setattr__(found, "_units", (length, time, joules / length, joules))
        return found

    def couple(self, body: Body, state: State, normal: Reals = 1.0) -> Result:
        """Raises TypeError, since a drive depends on more than a state."""
        raise TypeError(f"losses = {self!r}: a drive needs time and place; call its function with a Moment")

    def power(self, body: Body, state: State, normal: Reals = 1.0) -> Result:
        """Raises TypeError, since a drive depends on more than a state."""
        return self.couple(body, state, normal)


class Friction(Coulomb):
    """Dry friction whose coefficient depends on the speed of the slip, such as Stribeck friction.

    Parameters
    ----------
    function : callable
        ``function(speed)`` returns the coefficient of friction, 0 or more. `speed` is the magnitude of the
        slip, in sqrt(g R), or in m/s for a measured body. Or a C function ``double (double speed)``, as for
        `Couple`.
    static : float, optional
        Coefficient of static friction, at least ``function(0.0)``. Default: ``function(0.0)``.

    Raises
    ------
    TypeError
        If `function` is not callable, or is a C function of another signature. Also if the law is used for
        lazy arrays, or on a page.
    ValueError
        In `sc.roll` and `sc.sweep.roll`, if the coefficient is negative, is not finite, or jumps.

    Notes
    -----
    During the impact of a rim the coefficient follows the slip as it changes. Where both rims land at once,
    each rim has the coefficient for its slip after the impact.

    Examples
    --------
    A hoop thrown with backspin begins with a slip of 5. It slips until friction, u' = -2 mu(u), has stopped
    the slip:

    >>> import numpy as np
    >>> import spincyl as sc
    >>> stribeck = sc.custom.Friction(lambda u: 0.2 + 0.2 * np.exp(-((u / 0.1) ** 2)))
    >>> hoop, thrown = sc.Body.tube(0.0, bore=1.0), sc.State(np.pi / 2, 0.0, 0.0, -3.0, slip=(0.0, 5.0))
    >>> sc.roll(hoop, thrown, 20.0, contact=stribeck).phases
    ((0, 'slipping'), (12.3659806337, 'rolling'))
    """

    def __init__(self, function: Callable[[float], float], static: float | None = None) -> None:
        found = pointer(function, FRICTION)
        if found is None:
            _called("function", function, "the speed of the slip")
        mu = number("function(0.0)", (function if found is None else found.call)(0.0))
        super().__init__(mu, mu if static is None else static)
        object.__setattr__(self, "function", function)
        object.__setattr__(self, "_pointer", found)
        object.__setattr__(self, "_speed", 1.0)

    @property
    def _function(self) -> Any:
        given: Any = self
        if given._pointer is None:
            return given.function
        return given._pointer.address, (given._speed, 1.0, 1.0)

    def _natural(self, scale: Scale | None) -> Self:
        if scale is None:
            return self
        speed = scale._units[0] / scale._units[1]
        given: Any = self
        if given._pointer is None:
            return type(self)(lambda u: given.function(speed * u), self.static)
        found = type(self)(given.function, self.static)
        object.__setattr__(found, "_speed", speed)
        return found

    @classmethod
    def from_si(cls, *_: object, **__: object) -> Self:
        """Raises TypeError: for a measured body the function gets the speed in m/s, without a conversion."""
        how = "use custom.Friction(function, static); for a measured body function gets the slip in m/s"
        raise TypeError(f"custom.Friction.from_si: not needed; {how}")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Friction) and other._compares == self._compares

    def __ne__(self, other: object) -> bool:
        return not self == other

    def __hash__(self) -> int:
        return hash(self._compares)

    @property
    def _compares(self) -> Hashable:
        return self.function, equality_key(self.static)  # type: ignore[attr-defined]

    def __repr__(self) -> str:
        return f"custom.Friction({_named(self.function)})"  # type: ignore[attr-defined]


def _named(function: Any) -> str:
    return getattr(function, "__name__", type(function).__name__)
