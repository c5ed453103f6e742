"""Initial states of bodies that are thrown, dropped, pressed or flicked."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._input.numbers import (
    Reals,
    Result,
    elementwise,
    instance_of,
    is_scalar,
    radians,
    radians_per_second,
    reals,
    refuse_bad_value,
    si,
    turns_per_second,
)
from spincyl._scale import Scale, scale_of
from spincyl._state import State, numbers


@elementwise
def thrown(body: Body, velocity: Reals, backspin: Reals, *, scale: Scale | None = None) -> State:
    """Initial state of a body thrown on edge: a hoop, a coin, or a can on its side.

    The axis is horizontal, and the centre moves at right angles to the axis.

    Parameters
    ----------
    body : Body
        Single body or family that can touch the table with its rim at theta = pi/2, also a single body of
        several circles, such as a bottle. A can, a coin or a bottle touches the table with two rims; `roll`
        then needs ``restitution=0.0`` to continue until the body rolls on its side.
    velocity : array_like
        Velocity of the centre, in sqrt(g R); for a measured body, or with `scale`, in m/s.
    backspin : array_like
        Angular velocity about the axis, in sqrt(g/R), positive if the top of the body moves backward relative
        to the centre; for a measured body, or with `scale`, in rad/s.
    scale : Scale, optional
        Scale, if arguments are in SI and the body is not a measured body.

    Returns
    -------
    State
        State with w1 = w2 = 0, w3 = -backspin and slip = (0, velocity + backspin), in natural units. It has
        the broadcast shape of the arguments, and is NaN where a body of a family cannot stand on edge. Exact
        to a rounding.

    Raises
    ------
    ValueError
        If a single throw is impossible; the message names the value and the range.
    TypeError
        If an argument is not real-valued; the message names it.

    Examples
    --------
    A hula hoop comes back if its backspin times R exceeds its velocity:

    >>> import spincyl as sc
    >>> hoop, size = sc.Body.tube(0.0, bore=0.97), sc.Scale(radius=0.4)
    >>> state = sc.thrown(hoop, 3.0, 12.0, scale=size)
    >>> v = state.slip[1] + state.w3  # of the centre; friction leaves v + I3 w3
    >>> bool(v + hoop.i3 * state.w3 < 0)
    True
    """
    scale = scale_of_body(body, scale)
    if scale is not None:
        velocity = si("velocity", velocity, "metre/second")
        backspin = radians_per_second("backspin", backspin)
    velocity, backspin = reals("velocity", velocity), reals("backspin", backspin)
    if scale is not None:
        metres, seconds, *_ = scale._units
        velocity, backspin = velocity * (seconds / metres), backspin * seconds
    if body._single and body.theta_end < np.nextafter(np.pi / 2, 0):
        why = "since the body must stand on edge; a cup, which rolls in a circle, needs a State"
        raise ValueError(f"theta_end = {body.theta_end!r}: expected at least pi/2, {why}")
    if body.rims is not None and body._single:
        return body.with_centre_velocity(
            State(np.pi / 2 + 0.0 * backspin, 0.0, 0.0, -backspin), 0.0, velocity
        )
    given = velocity, backspin, *body._numbers
    if is_scalar(*given):
        state, slip = _core.thrown(float(velocity), float(backspin), six_numbers(body))
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
    """Initial state of a body in the air, from which it falls; `roll` then needs a `restitution`.

    Parameters
    ----------
    body : Body
        Single body or family.
    height : array_like
        Height of the lowest point of the body above the table, 0 or more, in R; for a measured body, or with
        `scale`, in metres.
    theta : array_like
        Inclination in radians, from 0 to pi. At 0 and pi, where the axis is vertical, `w1` must be 0. If w2
        is 0, too, the body lands flat on its face: it bounces, slides and spins there.
    w1, w2, w3 : array_like, optional
        Components of the angular velocity, as in `State`, in sqrt(g/R); for a measured body, or with `scale`,
        in rad/s.
    velocity : three of array_like, optional
        Velocity of the centre of mass in sqrt(g R), for a measured body, or with `scale`, in m/s. The three
        components are along e_h and e2 of `State`, and upward.
    scale : Scale, optional
        Scale, if arguments are in SI and the body is not a measured body.

    Returns
    -------
    State
        State with `slip`, `height` and `lift`, in natural units. It has the broadcast shape of the arguments.
        Error: 4 * 2^-53 of the largest term.

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid; the message names it.

    Examples
    --------
    >>> import spincyl as sc
    >>> coin = sc.Body.solid(0.08)
    >>> m = sc.roll(coin, sc.dropped(coin, 2.0, 1.2, w3=3.0), 5.0, contact=sc.Coulomb(0.3), restitution=0.5)
    >>> m.phases[0].kind, round(m.impacts[0].time, 12)
    ('flying', 2.0)
    """
    scale = scale_of_body(body, scale)
    if not isinstance(velocity, tuple | list) or len(velocity) != 3:
        raise TypeError(f"velocity: expected three components (e_h, e2, upward), not {velocity!r}")
    metre, second = (1.0, 1.0) if scale is None else scale._units[:2]
    height = reals("height", height if scale is None else si("height", height, "metre"))
    refuse_bad_value("height", height, lambda x: ~((x >= 0) & (x < np.inf)), "expected 0 <= height, finite")
    given = (("w1", w1), ("w2", w2), ("w3", w3))
    w = (reals(name, x if scale is None else radians_per_second(name, x)) * second for name, x in given)
    moves = (reals("velocity", x if scale is None else si("velocity", x, "metre/second")) for x in velocity)
    along, across, upwards = (x * (second / metre) for x in moves)
    state = State(theta, *w)
    rise = upwards - _core.centre_up(*body._at(*numbers(state), 0.0, 0.0))
    found = body.with_centre_velocity(state, along, across)
    # beyond pi/2 the other rim is lower than the rim to which theta refers
    over = 0.0 if body.rims is not None else _core.lower_rim(state.theta, *body._numbers)
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
    """Initial state of a body on its side, after a finger has pressed on one end until the body shot out.

    The body lies on both rims, theta = pi/2, and the finger presses on its upper rim. This end rises if
    `launch_number` exceeds 1. The slip of the state is the slip of the lower rim.

    Parameters
    ----------
    body : Body
        Single body or family with two equal rims, sharp or rounded: ell > 0 and theta_end = pi/2.
    impulse : array_like
        Impulse of the finger toward the axis, 0 or more, in M sqrt(g R); for a measured body, or with
        `scale`, in N s.
    angle : array_like
        Angle along the rim from its top to the point that the finger presses, in radians, in (0, pi/2].
    finger : array_like, optional
        Coefficient of friction of the finger, which drags the surface downward as it slips off.
    table : array_like, optional
        Coefficient of friction of the table under the pressed end. With 0 that end slips freely.
    scale : Scale, optional
        Scale, if the impulse is in SI and the body is not a measured body.

    Returns
    -------
    State
        State at theta = pi/2, in natural units, with w2 = 0 and the slip (0, u_2) of the lower rim. The
        velocity of the centre is always -(I1/ell) w1; the centre does not start at rest. The state has the
        broadcast shape of the arguments, and is NaN where they are impossible. Error: 8 * 2^-53 of the
        largest term.

    Raises
    ------
    ValueError
        If a single press is impossible; the message names the value and the range.
    TypeError
        If an argument is not real-valued; the message names it.

    Notes
    -----
    This is the launch of Jackson et al., Am. J. Phys. 87, 85 (2019), as an impulse J. Let v_2 be the velocity
    of the centre along e2, f the coefficient `finger`, mu the coefficient `table`, and cos and sin the cosine
    and sine of `angle`. Then v_2 = J (f cos - sin) + Q, I1 w1 = -ell v_2 and I3 w3 = f J - Q. Q is the
    impulse of the friction of the table: mu J (cos + f sin), or less if the pressed end then rolls.

    Examples
    --------
    >>> import spincyl as sc
    >>> pipe = sc.Body.tube(6.0, bore=0.8)
    >>> state = sc.pressed(pipe, 9.0, 0.8)
    >>> bool(sc.launch_number(pipe, state) > 1)
    True
    """
    scale = scale_of_body(body, scale)
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
        state, slip = _core.pressed(one[0], one[1], one[2], one[3], six_numbers(body))
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
    """Initial state of a body that a finger has launched on its side, from the rates of its rotation.

    Give `hertz` or `w1`, and `launch` or `spin_hertz`. To give the impulse of the finger, see `pressed`.
    This is for tubes, which a press on one end launches. A coin that is flicked on its edge turns about the
    vertical, with its centre almost at rest: its `State` is in docs/slip.md.

    Parameters
    ----------
    body : Body
        Single body or family with two rims: ell > 0.
    hertz : array_like
        Turns per second about the vertical; needs a measured body or `scale`.
    w1 : array_like
        Angular velocity about the vertical, in sqrt(g/R).
    launch : array_like
        The `launch_number` of the state. If it exceeds 1, the end that was pressed rises.
    spin_hertz : array_like
        Turns per second about the axis, positive for backspin relative to the direction in which the body
        leaves; needs a measured body or `scale`.
    centre : array_like, optional
        Velocity of the centre at right angles to the axis, in sqrt(g R); for a measured body, or with
        `scale`, in m/s. Default: -(I1/ell) w1, as after a press by a finger.
    scale : Scale, optional
        Scale, if arguments are in SI and the body is not a measured body.

    Returns
    -------
    State
        State at theta = pi/2 with its slip, in natural units. It has the broadcast shape of the arguments,
        and is NaN where they are NaN. If w1 is 0 in an array and `launch` is given, w3 is not finite.

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid; the message names it.

    Examples
    --------
    >>> import spincyl as sc
    >>> tube = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm")
    >>> m = sc.roll(tube, sc.flicked(tube, hertz=17, launch=1.3), 3.0, contact=sc.Coulomb(0.3))
    >>> m.phases
    ((0, 'slipping'), (0.830076293024, 'rolling'))
    """
    scale = scale_of_body(body, scale)
    if (hertz is None) == (w1 is None) or (launch is None) == (spin_hertz is None):
        why = "give exactly one of hertz and w1, and exactly one of launch and spin_hertz"
        raise TypeError(f"hertz, w1, launch, spin_hertz: {why}")
    if scale is None and not (hertz is None and spin_hertz is None):
        raise ValueError(f"{'spin_' * (hertz is None)}hertz: needs a measured body or scale=; w1= does not")
    refuse_bad_value("ell", body.ell, lambda x: x <= 0, "expected a body with two rims, ell > 0")

    def turns(name: str, value: Reals) -> Reals:
        return reals(name, turns_per_second(name, value)) / (scale.turns(1.0) if scale else 1.0)

    w1 = reals("w1", w1) if hertz is None else turns("hertz", hertz)
    with np.errstate(divide="ignore", invalid="ignore"):
        if spin_hertz is None:
            if is_scalar(w1) and w1 == 0:
                raise ValueError("launch: needs a w1 or hertz other than 0; for 0 give spin_hertz=")
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
    """Launch number I3 w1 w3 / ell of a body on its side, at theta = pi/2 with w2 = 0.

    If the number exceeds 1, the body rises on the rim to which theta refers; below -1, on the other rim. In
    between the body stays lying, as long as no friction acts along its axis. In an array the number is NaN
    where the body is not on its side. It is infinite or NaN if ell = 0.

    Raises
    ------
    ValueError
        If a single state does not have theta = pi/2 and w2 = 0.
    """
    instance_of("body", body, Body)
    found = _core.launch_number(*numbers(state), *body._numbers)
    if is_scalar(found) and np.isnan(found) and body.ell != 0:
        raise ValueError(f"state = {state!r}: expected a body on its side, theta = pi/2 with w2 = 0")
    return found


def _on_its_side(w1: Reals, w3: Reals, across: Reals) -> State:
    level = w1 * 0.0
    return State(level + np.pi / 2, w1, level, w3, slip=(level, across))


def scale_of_body(body: object, scale: Scale | None) -> Scale | None:
    """The given scale, or else the scale of a measured body; None if neither is known."""
    return scale_of(scale, instance_of("body", body, Body))


def six_numbers(body: Body) -> tuple[float, float, float, float, float, float]:
    ell, i1, i3, bore, fillet, most = (float(x) for x in body._numbers)
    return ell, i1, i3, bore, fillet, most
