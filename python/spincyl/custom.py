"""Custom laws: a couple that takes energy, and a coefficient of friction that depends on the speed.

Each law is a Python function, or a C function (``numba.cfunc``, ctypes, ``scipy.LowLevelCallable``), which is
called without Python in about a hundredth of the time; a motion calls a law thousands of times.
`sc.roll` and `sc.sweep.roll` check the law before a motion begins: its values must be finite and without
jumps, and a couple must not add energy. A dry law contains the sign of a speed, which jumps. Smooth it:
``tanh(x/e)`` in place of ``sign(x)``.

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

__all__ = ["Couple", "Friction"]


def __dir__() -> list[str]:
    return [*__all__, *(name for name in globals() if name.startswith("__"))]


#: A couple from theta, w along e1, e2, e3 (an array of 3), and the normal force.
CoupleFunction = Callable[[float, Floats, float], Sequence[float] | Floats]


def _called(name: str, function: object, arguments: str) -> None:
    if not callable(function):
        raise TypeError(f"{name}: expected a function of {arguments}, not {type(function).__name__}")


@dataclass(frozen=True, eq=False, repr=False)
class Couple(Loss):
    """Loss law given by a function of inclination, angular velocity and normal force.

    Parameters
    ----------
    function : callable
        ``function(theta, w, normal)`` returns the couple on the body, in M g R: its three components along
        e1, e2, e3 of `State`. The arguments of the function are the inclination `theta` in radians, the
        angular velocity `w` in sqrt(g/R) (an array of its components along the same axes), and the normal
        force `normal` in M g, 0 or more; in the air it is 0, and a body with two rims is seen from the
        lower one. For a measured body the units are N m, rad/s and N. The power that the couple takes,
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
    _others: ClassVar[Loss | None] = None  # the laws of the library in a sum

    def __post_init__(self) -> None:
        object.__setattr__(self, "_pointer", pointer(self.function, COUPLE))
        if self._pointer is None:
            _called("function", self.function, "theta, w and the normal force")

    @property
    def _function(self) -> Any:
        return self.function if self._pointer is None else (self._pointer.address, self._units)

    @property
    def laws(self) -> tuple[Law, ...]:
        """Raises TypeError, since a law that is a function has no coefficients to list."""
        raise TypeError(f"losses = {self!r}: {WHERE_OWN_LAWS_WORK}, for bodies of revolution")

    @property
    def _built_in(self) -> Loss | None:
        return self._others

    def __add__(self, other: Loss) -> Loss:
        if getattr(other, "_function", None) is not None:
            raise TypeError(f"losses = {self!r} + {other!r}: expected a couple of your own of one function")
        return self._beside(other if self._others is None else self._others + other)

    def __radd__(self, other: Any) -> Loss:
        return self + other if isinstance(other, Loss) else super().__radd__(other)

    def _beside(self, others: Loss | None) -> "Couple":
        found = type(self)(self.function)
        object.__setattr__(found, "_others", others)
        return found

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
        """Couple in a single state, along e1, e2, e3, and of the laws added to it."""
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

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Couple) and (other.function, other._others) == (self.function, self._others)

    def __hash__(self) -> int:
        return hash(self.function)

    def __repr__(self) -> str:
        more = "" if self._others is None else f" + {self._others!r}"
        return f"custom.Couple({_named(self.function)}){more}"

    __str__ = __repr__  # without coefficients there is no unit to print


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
    Along the impact of a rim the coefficient is that of the current speed. Where both rims land at once, it
    is that of each rim's slip after the impact.

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
        how = "for a measured body custom.Friction(function, static) gets the speed of the slip in m/s"
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
