"""Initial states of bodies on their face: standing, spinning and sliding, or stopped by a kerb."""

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._input.numbers import (
    Reals,
    elementwise,
    is_scalar,
    radians,
    radians_per_second,
    reals,
    refuse_bad_value,
    si,
)
from spincyl._scale import Scale
from spincyl._state import State
from spincyl._throw import scale_of_body

_ENDS = "0 (on the first face) or pi (on the other one)"


@elementwise
def spun(
    body: Body,
    w: Reals,
    velocity: tuple[Reals, Reals] = (0.0, 0.0),
    *,
    theta: Reals = 0.0,
    scale: Scale | None = None,
) -> State:
    """Initial state of a body on its face that spins about its vertical axis and slides.

    Parameters
    ----------
    body : Body
        Single body or family.
    w : array_like
        Angular velocity about the vertical axis, in sqrt(g/R), counterclockwise as seen from above; for a
        measured body, or with `scale`, in rad/s.
    velocity : pair of array_like, optional
        Horizontal velocity of the centre, in sqrt(g R); for a measured body, or with `scale`, in m/s. The
        components are along x and y of the laboratory; phi of the state is 0.
    theta : array_like, optional
        0 if the body stands on its first face, pi if it stands on the other one.
    scale : Scale, optional
        Scale, if arguments are in SI and the body is not a measured body.

    Returns
    -------
    State
        State at theta = 0 or pi with w1 = w2 = 0 and w3 = w (at pi, w3 = -w), in natural units. Its slip is
        that of the point of the rim that theta refers to. `State.kicked` tips the body.

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid; the message names it.

    Examples
    --------
    A puck that slides and spins stops sliding and spinning at the same moment:

    >>> import spincyl as sc
    >>> puck = sc.Body.solid(0.1)
    >>> state = sc.spun(puck, 2.0, velocity=(1.0, 0.0))
    >>> state
    State(theta=0.0, w1=0.0, w2=0.0, w3=2.0, slip=(1.0, -2.0))
    """
    scale = scale_of_body(body, scale)
    if not isinstance(velocity, tuple | list) or len(velocity) != 2:
        raise TypeError(f"velocity: expected two horizontal components, not {velocity!r}")
    metre, second = (1.0, 1.0) if scale is None else scale._units[:2]
    spin = reals("w", w if scale is None else radians_per_second("w", w)) * second
    moves = (reals("velocity", x if scale is None else si("velocity", x, "metre/second")) for x in velocity)
    along, across = (x * (second / metre) for x in moves)
    theta = radians("theta", theta, _ENDS)
    refuse_bad_value("theta", theta, lambda x: ~((x == 0) | (x == np.pi)), f"expected {_ENDS}")
    up = 1.0 - theta * (2 / np.pi)  # 1 or -1: e3 points up or down
    level = 0.0 * (up * spin) + 0.0
    return body.with_centre_velocity(State(theta + level, level, level, up * spin), along, across)


@elementwise
def tripped(body: Body, velocity: Reals, *, scale: Scale | None = None) -> State:
    """Initial state of a body that slid on its face until a kerb stopped the leading edge of the face.

    The body then turns about the point of its rim at the kerb. It falls over if it is fast enough, and else
    falls back. The kerb is low, and the impact at the edge is plastic.

    Parameters
    ----------
    body : Body
        Single body or family with a face.
    velocity : array_like
        Velocity of the centre before the impact, 0 or more, in sqrt(g R); for a measured body, or with
        `scale`, in m/s.
    scale : Scale, optional
        Scale, if arguments are in SI and the body is not a measured body.

    Returns
    -------
    State
        State at theta = 0 with w1 = w3 = 0 and w2 = -v Z/(I1 + Z^2 + a^2), without slip, in natural units. a
        is the radius of the face, Z the height of the centre. The body moves in the direction of -e_h, along
        which its point of contact lies. Relative error: 4 * 2^-53.

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid; the message names it.

    Examples
    --------
    >>> import spincyl as sc
    >>> can = sc.Body.solid(2.0)
    >>> round(sc.tripped(can, 1.0).w2, 6)
    -0.303797
    """
    scale = scale_of_body(body, scale)
    speed = reals("velocity", velocity if scale is None else si("velocity", velocity, "metre/second"))
    if scale is not None:
        speed = speed / scale.metres_per_second(1.0)
    refuse_bad_value(
        "velocity", speed, lambda x: ~((x >= 0) & (x < np.inf)), "expected 0 <= velocity, finite"
    )
    w2 = _core.tripped_w2(speed, *body._at(0.0)[1:])
    if is_scalar(w2) and np.isnan(w2):
        raise ValueError("body: expected a body with a face; a ball has none")
    level = 0.0 * w2 + 0.0
    return State(level, level, w2, level)
