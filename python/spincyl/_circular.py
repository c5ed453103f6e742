"""Steady states whose centre runs on a circle, and those of a body of several circles."""

from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl import _core
from spincyl._input.numbers import Reals, is_scalar, numbered, radians, reals
from spincyl._state import State, state_without_checks

if TYPE_CHECKING:
    from spincyl._body import Body


def circular(body: "Body", theta: Reals, precession: Reals, radius: Reals, w3: Reals) -> State:
    """The steady state whose centre runs on a circle, from one of three arguments; see `Body.circular`."""
    given = {"precession": precession, "radius": radius, "w3": w3}
    chosen = [name for name, x in given.items() if x is not None]
    if len(chosen) != 1:
        raise TypeError("precession, radius, w3: give exactly one of them")
    (name,) = chosen
    theta, number = radians("theta", theta, body._leans), reals(name, given[name])
    if body.rims is None:
        return _on_a_circle(body, theta, body._raw, name, number)
    seen, *numbers = body._at(theta)
    found = _on_a_circle(body, seen, numbers, name, body._sign(theta) * number if name == "w3" else number)
    told = np.asarray(theta)[..., np.newaxis] if name == "w3" else theta
    return State(told + 0.0 * found.w1, found.w1, found.w2, body._sign(told) * found.w3)


def _on_a_circle(body: "Body", theta: Reals, numbers: Any, name: str, number: Reals) -> State:
    given, single = number, is_scalar(theta, number, *numbers)
    asked = float(number) if single else number
    if name == "radius":
        number = _core.precession_of_radius(theta, number, *numbers)
    elif name == "w3":
        theta, number, *numbers, root = numbered(2, theta, number, *numbers)
        number, single = _core.precession_of_spin(theta, number, *numbers, root), False
        theta = theta + 0.0 * number
    if single:
        if np.isnan(asked):
            raise ValueError(f"{name} = nan: expected a number")
        if np.isnan(number) and body.rims is None and theta > body.theta_end:
            lands = f"expected at most theta_end = {body.theta_end!r}, where another part lands"
            raise ValueError(f"theta = {theta!r}: {lands}")
        if np.isnan(number):
            raise ValueError(f"{name} = {given!r}: no steady state at theta = {theta!r} has this value")
        return state_without_checks(_core.circular_state(float(theta), float(number), numbers))
    w1, w3 = (f(theta, number, *numbers) for f in (_core.circular_w1, _core.circular_w3))
    return State(theta, w1, w1 * 0.0, w3)


def steady_on_circle(body: "Body", theta: Reals) -> State:
    """The steady state with the centre at rest of a body of several circles."""
    seen, *numbers = body._at(theta)
    if is_scalar(theta, *numbers):
        _, w1, _, w3 = _core.steady_state(float(seen), numbers)
        return State(theta, w1, 0.0, body._sign(theta) * w3)
    w1, w3 = (law(seen, *numbers) for law in (_core.steady_w1, _core.steady_w3))
    return State(theta + 0.0 * w1, w1, w1 * 0.0, body._sign(theta) * w3)
