"""Slip of the contact point over the table, and the corresponding velocity of the centre."""

from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl import _core
from spincyl._circles import lowest_point_of
from spincyl._input.numbers import Floats, Reals, Result, components, numbered
from spincyl._state import State, numbers

if TYPE_CHECKING:
    from spincyl._ellipsoid import Ellipsoid
    from spincyl._laws import Laws


def _numbers_of_rim(body: "Laws") -> tuple[Reals, ...]:
    """Six numbers of a body with the same rim; moments and bore are fixed, since velocities need neither."""
    return body.ell, 1.0, 1.0, np.nan, body.fillet, np.nan


def _centre_moves(body: "Laws", state: State, slip: tuple[Reals, Reals]) -> tuple[Result, Result]:
    """Horizontal velocity of the centre, along e_h and e2, of a state with the given slip."""
    given = *numbers(state), *slip
    if body.rims is None:
        given = *given, *_numbers_of_rim(body)
        return _core.centre_along(*given), _core.centre_across(*given)
    sign, given = body._sign(state.theta), body._at(*given)
    return sign * _core.centre_along(*given), sign * _core.centre_across(*given)


def slip_of(body: "Laws", state: State, along: Reals, across: Reals) -> tuple[Result, Result]:
    """Slip, along e_h and e2, for a given horizontal velocity of the centre along the same vectors."""
    moves = _centre_moves(body, state, (0.0, 0.0))
    return along - moves[0], across - moves[1]


def velocity_of(body: "Laws", state: State) -> tuple[Result, Result]:
    """Horizontal velocity of the centre, along e_h and e2, of a state with its own slip, if any."""
    return _centre_moves(body, state, state._slip)


def told_of_lowest(body: "Laws", state: State, rim: Any, flies: Any) -> State:
    """Convert states that refer to the circles `rim`, so that states in the air refer to the lowest circle.

    The inclination alone determines the lowest circle, so a `State` needs no index of a circle.
    """
    four, level = numbers(state), (0.0, 0.0)
    sign, theta = body._sign(state.theta), np.asarray(state.theta)
    before, now = body._at(*four, *state._slip, rim=rim), body._at(*four, *level)
    slip = tuple(sign * (law(*before) - law(*now)) for law in (_core.centre_along, _core.centre_across))
    rise = _core.centre_up(*body._at(*four, *level, rim=rim)) - _core.centre_up(*now)
    lower = lowest_point_of(body, theta, rim)
    given = (*state._slip, state.height, state.lift)
    other = (*slip, state.height + lower, state.lift + rise)
    along, across, height, lift = (np.where(flies, y, x)[()] for x, y in zip(given, other, strict=True))
    return State(*four, slip=(along, across), height=height, lift=lift)


def lever_of_stone(stone: "Ellipsoid", vertical: Floats) -> Floats:
    """Vector from the centre of mass of a stone to its lowest point, along the stone's axes; (..., 3)."""
    found: Floats = _core.stone_lever(*numbered(3, *stone._columns(), *components(vertical)))
    return found


def slip_of_stone(stone: "Ellipsoid", vertical: Floats, w: Floats, x: Reals, y: Reals) -> Floats:
    """The slip for a given velocity of the centre along x and y of `EllipsoidState.slip`; (..., 2)."""
    at_rest = _core.stone_slip(*numbered(2, *stone._columns(), *components(vertical), *components(w)))
    slip: Floats = at_rest + np.stack(np.broadcast_arrays(x, y, at_rest[..., 0])[:2], axis=-1)
    return slip


def rise_of_stone(stone: "Ellipsoid", vertical: Floats, w: Floats) -> Floats:
    """The upward velocity of the centre of mass of a stone whose lowest point does not rise; (...)."""
    (a, b, c), (w1, w2, w3) = components(lever_of_stone(stone, vertical)), components(w)
    n1, n2, n3 = components(vertical)
    rise: Floats = n1 * (w3 * b - w2 * c) + n2 * (w1 * c - w3 * a) + n3 * (w2 * a - w1 * b)
    return rise
