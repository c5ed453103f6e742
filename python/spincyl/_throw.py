"""Throwing: the state in which a body leaves the hand."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._input.numbers import (
    Reals,
    Result,
    elementwise,
    is_scalar,
    made,
    radians,
    radians_per_second,
    reals,
    refuse,
    si,
    turns_per_second,
)
from spincyl._scale import Scale, scale_of
from spincyl._state import State, numbers


@elementwise
def thrown(body: Body, velocity: Reals, backspin: Reals, *, scale: Scale | None = None) -> State:
    """The state of a body thrown on edge: a hoop, a coin, or a can on its side.

    Its axis is horizontal, and its centre moves across that.

    Parameters
    ----------
    body : Body
        One, or a family. Its rim touches the table at theta = pi/2. A can or a coin touches it with both of
        its rims: `roll` follows it with ``restitution=0.0``, to where it rolls on its side.
    velocity : array_like
        Of the centre, in sqrt(g R); with `scale` in m/s.
    backspin : array_like
        How fast it spins, in sqrt(g/R), positive where the top moves backwards; with `scale` in rad/s.
    scale : Scale, optional
        That velocity and backspin are in SI; a measured body has it. What is returned is in natural units.

    Returns
    -------
    State
        With w1 = w2 = 0, w3 = -backspin and slip = (0, velocity + backspin). Broadcast shape; NaN where a
        family has no such body. Exact to a rounding.

    Raises
    ------
    ValueError
        For a single throw that is none, naming the value and the range.
    TypeError
        Naming the argument that holds no real numbers.

    Examples
    --------
    A hula-hoop comes back if its backspin, times R, exceeds its velocity.

    >>> import spincyl as sc
    >>> hoop, size = sc.Body.tube(0.0, bore=0.97), sc.Scale(radius=0.4)
    >>> state = sc.thrown(hoop, 3.0, 12.0, scale=size)
    >>> v = state.slip[1] + state.w3  # of the centre; friction leaves v + I3 w3
    >>> bool(v + hoop.i3 * state.w3 < 0)
    True
    """
    scale = _known(body, scale)
    if scale is not None:
        velocity = si("velocity", velocity, "metre/second")
        backspin = radians_per_second("backspin", backspin)
    velocity, backspin = reals("velocity", velocity), reals("backspin", backspin)
    if scale is not None:
        metres, seconds, *_ = scale._units
        velocity, backspin = velocity * (seconds / metres), backspin * seconds
    given = velocity, backspin, *body._numbers
    if is_scalar(*given):
        if body.theta_end < np.pi / 2:
            why = "a body that can stand on edge; on two rims, as of a cup, it runs in a circle: start it"
            raise ValueError(f"theta_end = {body.theta_end!r}: expected at least pi/2: {why} by sc.State")
        state, slip = _core.thrown(float(velocity), float(backspin), six(body))
        return State(*state, slip=(slip[0], slip[1]))
    w3, across = _core.thrown_w3(*given), _core.thrown_slip(*given)
    return _on_its_side(w3 * 0.0, w3, across)


@elementwise
def dropped(
    body: Body,
    height: Reals,
    theta: Reals,
    *,
    w1: Reals = 0.0,
    w2: Reals = 0.0,
    w3: Reals = 0.0,
    velocity: tuple[Reals, Reals, Reals] = (0.0, 0.0, 0.0),
    scale: Scale | None = None,
) -> State:
    """The state of a body in the air, from which it falls; `roll` then needs a `restitution`.

    Parameters
    ----------
    body : Body
        One, or a family.
    height : array_like
        Of its lowest point over the table, in R; of a measured body, or with `scale`, in metres. 0 or more.
    theta : array_like
        Inclination in radians.
    w1, w2, w3 : array_like, optional
        Angular velocity, as in `State`; of a measured body, or with `scale`, in rad/s.
    velocity : three of array_like, optional
        Of the centre of mass: along the lean, across it, upwards, in sqrt(g R); measured, in m/s.
    scale : Scale, optional
        A measured body has it. What is returned is in natural units.

    Returns
    -------
    State
        With its `slip`, `height` and `lift`. Broadcast shape. Error 4 ulp (2^-53) of the largest term.

    Raises
    ------
    ValueError, TypeError
        Naming the argument.

    Examples
    --------
    >>> import spincyl as sc
    >>> coin = sc.Body.solid(0.08)
    >>> m = sc.roll(coin, sc.dropped(coin, 2.0, 1.2, w3=3.0), 5.0, contact=sc.Coulomb(0.3), restitution=0.5)
    >>> m.phases[0].kind, round(m.impacts[0].time, 12)
    ('flying', 2.0)
    """
    scale = _known(body, scale)
    if not isinstance(velocity, tuple | list) or len(velocity) != 3:
        raise TypeError(f"velocity: expected three, along the lean, across, upwards, not {velocity!r}")
    metre, second = (1.0, 1.0) if scale is None else scale._units[:2]
    height = reals("height", height if scale is None else si("height", height, "metre"))
    refuse("height", height, lambda x: ~((x >= 0) & (x < np.inf)), "expected 0 <= height, finite")
    given = (("w1", w1), ("w2", w2), ("w3", w3))
    w = (reals(name, x if scale is None else radians_per_second(name, x)) * second for name, x in given)
    moves = (reals("velocity", x if scale is None else si("velocity", x, "metre/second")) for x in velocity)
    along, across, upwards = (x * (second / metre) for x in moves)
    state = State(theta, *w)
    rise = upwards - _core.centre_up(*numbers(state), 0.0, 0.0, *body._numbers)
    found = body.with_centre_velocity(state, along, across)
    # a body that leans over has its other rim below that of which theta tells
    over = _core.lower_rim(state.theta, *body._numbers)
    return replace(found, height=height / metre - over + 0.0 * rise, lift=rise + 0.0 * height)


@elementwise
def pressed(
    body: Body,
    impulse: Reals,
    angle: Reals,
    *,
    finger: Reals = 0.6,
    table: Reals = 0.0,
    scale: Scale | None = None,
) -> State:
    """The state of a body on its side that a finger presses at one end until it shoots out.

    The finger acts on the rim at that end, the upper one, which is the end that rises if
    `launch_number` exceeds 1. The carrying end is the other one; its slip is given.

    Parameters
    ----------
    body : Body
        One, or a family, with two equal rims, sharp or rounded: ell > 0 and theta_end = pi/2.
    impulse : array_like
        Of the finger, towards the axis, in M sqrt(g R), not negative; with `scale` in N s.
    angle : array_like
        In (0, pi/2], radians: where the finger presses, from the top of the rim.
    finger : array_like, optional
        Coefficient of friction of the finger, which drags the surface downwards as it slips off.
    table : array_like, optional
        Coefficient of friction of the table under the end that is pressed; 0: that end slips freely.
    scale : Scale, optional
        That the impulse is in SI; a measured body has it. What is returned is in natural units.

    Returns
    -------
    State
        At theta = pi/2, w2 = 0, and the slip of the other end, (0, u_2). The centre moves with
        -(I1/ell) w1 whatever the finger does: it does not start at rest. Broadcast shape; NaN where an
        element is no press. Error 8 ulp (2^-53) of the largest term.

    Raises
    ------
    ValueError
        For a single press that is none, naming the value and the range.
    TypeError
        Naming the argument that holds no real numbers.

    Notes
    -----
    The launch of Jackson et al., Am. J. Phys. 87, 85 (2019), as an impulse: with v_2 that of the centre,
    v_2 = J (f cos - sin) + Q, I1 w1 = -ell v_2, I3 w3 = f J - Q, where the table drags with Q, at most
    mu J (cos + f sin), and less if that end then rolls.

    Examples
    --------
    >>> import spincyl as sc
    >>> pipe = sc.Body.tube(6.0, bore=0.8)
    >>> state = sc.pressed(pipe, 9.0, 0.8)
    >>> bool(sc.launch_number(pipe, state) > 1)
    True
    """
    scale = _known(body, scale)
    if scale is not None:
        impulse = si("impulse", impulse, "newton*second")
    impulse, angle = reals("impulse", impulse), radians("angle", angle, "0 < angle <= pi/2")
    finger, table = reals("finger", finger), reals("table", table)
    if scale is not None:
        impulse = impulse / scale._newton_seconds()
    push = impulse, angle, finger, table
    given = *push, *body._numbers
    if is_scalar(*given):
        one = [float(x) for x in push]
        state, slip = _core.pressed(one[0], one[1], one[2], one[3], six(body))
        return State(*state, slip=(slip[0], slip[1]))
    laws: tuple[Callable[..., Result], ...] = (_core.pressed_w1, _core.pressed_w3, _core.pressed_slip)
    w1, w3, across = (law(*given) for law in laws)
    return _on_its_side(w1, w3, across)


@elementwise
def flicked(
    body: Body,
    *,
    hertz: Reals = None,
    w1: Reals = None,
    launch: Reals = None,
    spin_hertz: Reals = None,
    centre: Reals = None,
    scale: Scale | None = None,
) -> State:
    """The state of a body on its side that leaves a finger at a rate; `pressed` takes the finger's impulse.

    Parameters
    ----------
    body : Body
        One, or a family, with two rims: ell > 0.
    hertz : array_like
        Turns per second about the vertical, of a measured body or with `scale`.
    w1 : array_like
        Or the same as an angular velocity in sqrt(g/R).
    launch : array_like
        The `launch_number`: above 1 the end that was pressed rises.
    spin_hertz : array_like
        Or turns per second about the axis; positive is backspin against the way in which it leaves.
    centre : array_like, optional
        Velocity of the centre across the axis in sqrt(g R); of a measured body, or with `scale`, in m/s.
        Default: as a finger leaves it, -(I1/ell) w1.
    scale : Scale, optional
        A measured body has it.

    Returns
    -------
    State
        At theta = pi/2, in natural units, with its slip. Broadcast shape; where w1 = 0 no w3 has a launch
        number, and w3 is not finite. NaN where a number given is NaN.

    Raises
    ------
    ValueError, TypeError
        Naming the argument.

    Examples
    --------
    >>> import spincyl as sc
    >>> tube = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm")
    >>> m = sc.roll(tube, sc.flicked(tube, hertz=17, launch=1.3), 3.0, contact=sc.Coulomb(0.3))
    >>> m.phases
    ((0, 'slipping'), (0.830076293024, 'rolling'))
    """
    scale = _known(body, scale)
    if (hertz is None) == (w1 is None) or (launch is None) == (spin_hertz is None):
        raise TypeError("hertz, w1, launch, spin_hertz: give one of the first two and one of the last two")
    if scale is None and not (hertz is None and spin_hertz is None):
        raise ValueError(f"{'spin_' * (hertz is None)}hertz: needs a measured body, or scale=; w1= does not")
    refuse("ell", body.ell, lambda x: x <= 0, "a flick needs a body with two rims, ell > 0")

    def turns(name: str, value: Reals) -> Reals:
        return reals(name, turns_per_second(name, value)) / (scale.turns(1.0) if scale else 1.0)

    w1 = reals("w1", w1) if hertz is None else turns("hertz", hertz)
    with np.errstate(divide="ignore", invalid="ignore"):
        if spin_hertz is None:
            if is_scalar(w1) and w1 == 0:
                raise ValueError("launch: needs a rate that is not zero")
            w3 = _core.launch_spin(w1, reals("launch", launch), *body._numbers)
        else:
            w3 = turns("spin_hertz", spin_hertz)
        if centre is None:
            across = _core.recoil(w1, *body._numbers)
        else:
            across = reals("centre", centre if scale is None else si("centre", centre, "metre/second"))
            across = across if scale is None else across / scale.metres_per_second(1.0)
        level = w1 * 0.0
        return body.with_centre_velocity(State(level + np.pi / 2, w1, level, w3), 0.0, across)


@elementwise
def launch_number(body: Body, state: State) -> Result:
    """I3 w1 w3 / ell of a body on its side, at theta = pi/2 with w2 = 0.

    Where it exceeds 1 the body rises on the rim that carries it, below -1 on the other one; in between it
    stays lying, as long as friction does not act along its axis. An array for arrays, NaN where the body is
    not on its side; infinite or NaN where ell = 0.

    Raises
    ------
    ValueError
        For a single state that is not on its side.
    """
    made("body", body, Body)
    found = _core.launch_number(*numbers(state), *body._numbers)
    if is_scalar(found) and np.isnan(found) and body.ell != 0:
        raise ValueError(f"state = {state!r}: a launch number is that of theta = pi/2 with w2 = 0")
    return found


def _on_its_side(w1: Reals, w3: Reals, across: Reals) -> State:
    level = w1 * 0.0
    return State(level + np.pi / 2, w1, level, w3, slip=(level, across))


def _known(body: object, scale: Scale | None) -> Scale | None:
    """The given scale, or that of a measured body."""
    return scale_of(scale, made("body", body, Body))


def six(body: Body) -> tuple[float, float, float, float, float, float]:
    ell, i1, i3, bore, fillet, most = (float(x) for x in body._numbers)
    return ell, i1, i3, bore, fillet, most
