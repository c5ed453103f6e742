"""Steady states whose centre runs on a circle."""

from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl import _core
from spincyl._input.numbers import Reals, is_scalar, radians, reals
from spincyl._state import State

if TYPE_CHECKING:
    from spincyl._body import Body


def circular(body: "Body", theta: Reals, precession: Reals, radius: Reals, w3: Reals) -> State:
    """The state with one of three numbers."""
    given = {"precession": precession, "radius": radius, "w3": w3}
    chosen = [name for name, x in given.items() if x is not None]
    if len(chosen) != 1:
        raise TypeError("precession, radius, w3: give one of them")
    (name,) = chosen
    theta, number, numbers = radians("theta", theta, body._leans), reals(name, given[name]), body._numbers
    single = is_scalar(theta, number, *numbers)
    asked = float(number) if single else number
    if name == "radius":
        number = _core.precession_of_radius(theta, number, *numbers)
    elif name == "w3":
        both = [_core.precession_of_spin(theta, number, which, *numbers) for which in (0.0, 1.0)]
        number, theta = (
            np.stack(both, axis=-1),
            np.stack([np.broadcast_to(theta, np.shape(both[0]))] * 2, axis=-1),
        )
        spread: Any = tuple(x if is_scalar(x) else np.expand_dims(x, -1) for x in numbers)
        numbers = spread
        single = False
    if single:
        if np.isnan(asked):
            raise ValueError(f"{name} = nan: expected a number")
        if np.isnan(number):
            raise ValueError(f"{name} = {given[name]!r}: no such circle is steady at theta = {theta!r}")
        return State(*_core.circular_state(float(theta), float(number), numbers))
    w1, w3 = (f(theta, number, *numbers) for f in (_core.circular_w1, _core.circular_w3))
    return State(theta, w1, w1 * 0.0, w3)
