"""Slip of the lowest point over the table, and the velocity of the centre that goes with it.

    A = a + rho sin,  L = ell + rho cos,  Z = ell cos + a sin + rho        a = 1 - rho
    u_h = v_h - Z w2,      u_2 = v_2 + L w1 - A w3

u is the velocity of the lowest point and v that of the centre of mass; h is the horizontal direction of the
lean, cos(theta) e1 - sin(theta) e3, and 2 the one across it, e2. rho is the fillet of the rim. Of a stone

    u = v + w x r,   r = -D n/sqrt(n D n) - d        D = diag(a_i^2), d the offset, n the vertical
"""

from typing import TYPE_CHECKING

import numpy as np

from spincyl._input.numbers import Floats, Reals, Result
from spincyl._state import State, numbers

if TYPE_CHECKING:
    from spincyl._ellipsoid import Ellipsoid
    from spincyl._laws import Laws


def _carried(body: "Laws", state: State) -> tuple[Result, Result]:
    """Velocity of the centre if the lowest point were at rest, v - u: along the lean and across it."""
    theta, w1, w2, w3 = numbers(state)
    sin, cos, rim = np.sin(theta), np.cos(theta), 1.0 - body.fillet
    height = body.ell * cos + rim * sin + body.fillet
    radius, depth = rim + body.fillet * sin, body.ell + body.fillet * cos
    return height * w2, radius * w3 - depth * w1


def slip_of(body: "Laws", state: State, along: Reals, across: Reals) -> tuple[Result, Result]:
    """The slip that a velocity of the centre means."""
    along_rolling, across_rolling = _carried(body, state)
    return along - along_rolling, across - across_rolling


def velocity_of(body: "Laws", state: State) -> tuple[Result, Result]:
    """The velocity of the centre, along the lean and across it."""
    (along, across), (u_h, u_2) = _carried(body, state), state._slip
    return along + u_h, across + u_2


def lever(stone: "Ellipsoid", vertical: Floats) -> Floats:
    """From the centre of mass of a stone to its lowest point, along its axes; (..., 3)."""
    across = np.asarray(stone.axes) ** 2 * vertical
    size = np.sqrt((across * vertical).sum(axis=-1, keepdims=True))
    found: Floats = -across / size - stone.offset
    return found


def slip_of_stone(stone: "Ellipsoid", vertical: Floats, w: Floats, x: Reals, y: Reals) -> Floats:
    """The slip that a velocity of the centre means, along the laboratory's x and y; (..., 2).

    The stone has turned from upright by the smallest angle, upside down by half a turn about axis 1.
    """
    u, axis, up = np.cross(w, lever(stone, vertical)), np.cross(vertical, [0.0, 0.0, 1.0]), vertical[..., 2:]
    aside = (axis * axis).sum(axis=-1, keepdims=True)
    # 1 + up, which would lose its digits next to upside down
    sum_ = np.where(up > 0, 1 + up, aside / (1 - np.minimum(up, 0.0)))
    with np.errstate(invalid="ignore", divide="ignore"):
        turned = u + np.cross(axis, u) + np.cross(axis, np.cross(axis, u)) / sum_
    found = np.where(sum_ > 0, turned, u * [1.0, -1.0, -1.0])
    centre = np.stack(np.broadcast_arrays(x, y, found[..., 0])[:2], axis=-1)
    slip: Floats = found[..., :2] + centre
    return slip
