"""`roll`: reads the arguments, computes the motion, and converts it to the units of the body."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, TypeGuard, overload

import numpy as np

from spincyl._asked import Method, Want, ask, times_of
from spincyl._body import Body
from spincyl._contact import AnyContact, fitting
from spincyl._ending import Ending, ErrorWarning
from spincyl._input.hints import helpful
from spincyl._input.numbers import Reals, number, si, warn
from spincyl._measured import in_si, natural_time, speaking
from spincyl._motion import Motion, rolled
from spincyl._state import State
from spincyl._swing import single
from spincyl._told import shortened

if TYPE_CHECKING:
    from spincyl._ellipsoid import Ellipsoid
    from spincyl._ellipsoid_motion import EllipsoidMotion
    from spincyl._ellipsoid_state import EllipsoidState
    from spincyl._loss import Loss


class StepWarning(UserWarning):
    """A fixed step is so large that it takes a part of the nutation away, or blurs the precession."""


def is_stone(body: object) -> TypeGuard["Ellipsoid"]:
    """Whether the body is a stone. The module of stones is imported only if it may be one."""
    if type(body) is Body:
        return False
    from spincyl._ellipsoid import Ellipsoid

    return isinstance(body, Ellipsoid)


@overload
def roll(
    body: "Ellipsoid",
    state: "EllipsoidState",
    t: Reals,
    *,
    t0: float | None = None,
    tol: float | None = None,
    contact: AnyContact = "rolling",
    mu: float = np.inf,
    want: Want | Iterable[Want] = (),
    beyond: bool = False,
) -> "EllipsoidMotion": ...
@overload
def roll(
    body: Body,
    state: State,
    t: Reals,
    *,
    t0: float | None = None,
    step: float | None = None,
    tol: float | None = None,
    method: Method | None = None,
    contact: AnyContact = "rolling",
    mu: float = np.inf,
    want: Want | Iterable[Want] = (),
    beyond: bool = False,
    restitution: float | None = None,
    losses: "Loss | None" = None,
) -> Motion: ...
@helpful
def roll(
    body: "Body | Ellipsoid",
    state: "State | EllipsoidState",
    t: Reals,
    *,
    t0: float | None = None,
    step: float | None = None,
    tol: float | None = None,
    method: Method | None = None,
    contact: AnyContact = "rolling",
    mu: float = np.inf,
    want: Want | Iterable[Want] = (),
    beyond: bool = False,
    restitution: float | None = None,
    losses: "Loss | None" = None,
) -> Motion:
    """How a body moves on from a state.

    Parameters
    ----------
    body : Body or Ellipsoid
        A single one, ell at most 1e6, moments 1e-6 to 1e12; or a stone, with an `EllipsoidState`.
    state : State or EllipsoidState
        Where it starts, in natural units: theta in [1e-8, pi - 1e-8], speeds up to 1e6 sqrt(g/R).
    t : array_like, 1-D, or a number
        Times, in sqrt(R/g), at which it is wanted, in order; backward in time if they fall. Of a measured
        body in seconds, as are `t0` and `step`, or quantities of pint's; the state is in natural units.
    t0 : float, optional
        Time of the start. Default: the first of `t` (an only one has to be 0); 0 if `t` is a number.
    step : float, optional
        By RK4 with this fixed step, of either sign backward in time.
    tol : float, optional
        Tolerance of each step of an eighth-order method (absolute, 1e-14 to 0.1); `Motion.error` estimates
        the error of the result. With friction only slipping is integrated, with losses the whole motion;
        there the default is 1e-14.
    method : {"exact", "rk4"}, optional
        Default: RK4 if `step` is given; else the first integrals, which give the state at any time for the
        same cost, unless `tol` is given. Where the first integrals lose all their digits, steps within
        1e-12 replace them, and `method` and `message` say so.
    contact : {"rolling", "smooth"}, Coulomb or Viscous
        Rolling without slipping, a frictionless table, or a law of friction: then the body slips from the
        `slip` of the state, or rolls if it has none, and passes from one to the other where the law says so.
    mu : float
        Of "rolling": where it needs a larger coefficient of friction, it ends (`Ending.SLIP`). To let it slip
        from there on give `contact=Coulomb(mu)` instead.
    want : str or iterable of str
        "pose" (phi, psi, contact_point, centre, orientation), "force" (normal, friction,
        friction_coefficient), both (contact_force). What is not asked for is not computed.
    beyond : bool
        Whether to go on beyond an event, where the model is no longer that of the body. The event is
        reported all the same. Beyond a landing of the face there is nothing.
    restitution : float, optional
        Of impacts, 0 to 1: the share of the work of compression that comes back is its square (Stronge).
        Default: the motion ends where the body leaves the table or its other rim lands. With a restitution it
        goes on there: it flies, bounces, lies on both rims, rises again. Needed by a start in the air
        (`dropped`). Where the other rim carries the body, theta is told from that rim, and phi turns by pi.
        With "rolling" a body that lands on both rims ends there (`Ending.SIDE`) unless it only rocks.
    losses : Loss, optional
        What takes energy: a law of `spincyl.loss`, or several, added with `+`. The motion is then found by
        steps, forward in time, and may end where the contact point stops (`Ending.STOPS`).

    Returns
    -------
    Motion
        At the times up to the first event: the face or the other rim lands, lift-off, slip (with a
        restitution: the face lands, or what comes next is not determined). If `t` is one
        time and the motion ends before, there is none: `status`, `event` and `message` tell why. Of a
        measured body it is in SI.

    Raises
    ------
    ValueError
        Before any work: for a body, state, time, step, tolerance or mu out of range, by name; for a
        step at which fast precession or nutation would come out wrong unnoticed, with one that would do.
    TypeError
        Naming an argument that is no real number.
    KeyboardInterrupt
        Within 0.1 s of Ctrl-C.

    Warns
    -----
    RuntimeWarning
        For a motion that is given up on the way (`Ending.BOUNDED`) and returned up to there: with friction
        or losses, where slipping, rolling and the ways of dry losses change over 20 times in each unit of
        time (at least 5,000, at most 10,000 times), where 600,000 steps hardly advance, since something
        changes ever faster, and where 8 million evaluations are not enough (of times beyond 200: 40,000 for
        each unit).
    StepWarning
        If the step takes more than a thousandth of the nutation away, or turns by more than 0.3 rad.
    ErrorWarning
        If a stone is not known to the end of its motion, with the time up to which it is:
        `EllipsoidMotion.known_until`.

    Notes
    -----
    Chaplygin, Appell and Korteweg found the integrals; docs/physics.md has the equations. Error of the
    exact motion: 1e-14 times its conditioning, estimated for this motion by `Motion.error`, which in the
    tests is never below a tenth of the true error.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> body = sc.Body.solid(2.5)
    >>> m = sc.roll(body, body.steady(1.3).kicked(0.05), np.linspace(0, 20, 2001))
    >>> float(m.theta.max().round(4)), m.status.name
    (1.3389, 'DONE')

    A hoop that is thrown with backspin slides until it rolls:

    >>> hoop, thrown = sc.Body.tube(0.0, bore=1.0), sc.State(np.pi / 2, 0.0, 0.0, -3.0, slip=(0.0, 5.0))
    >>> sc.roll(hoop, thrown, 20.0, contact=sc.Coulomb(0.25)).phases
    ((0, 'slipping'), (10, 'rolling'))

    A ball that falls bounces until the sum of its bounces is over:

    >>> ball = sc.Body.ball(0.0, i1=0.4, i3=0.4)
    >>> m = sc.roll(ball, sc.dropped(ball, 0.5, 1.0), 10.0, contact=sc.Coulomb(0.3), restitution=0.5)
    >>> len(m.impacts), m.phases[-1].kind, round(m.phases[-1].time, 5)
    (23, 'rolling', 3.0)
    """
    if is_stone(body):
        from spincyl import _ellipsoid_motion as stones

        given: dict[str, Any] = {
            "t0": t0,
            "step": step,
            "tol": tol,
            "method": method,
            "contact": contact,
            "mu": mu,
        }
        given |= {"want": want, "beyond": beyond, "restitution": restitution, "losses": losses}
        found = stones.roll(body, state, t, **given)  # type: ignore[arg-type]  # it refuses another state
        if found._doubt:
            why = f"beyond, its estimated error comes to {found.error:.2g}"
            warn(f"the motion is {found._doubt} (known_until): {why}", ErrorWarning)
        return found
    # `single` raises for other types
    one: Body = body  # type: ignore[assignment]
    start: State = state  # type: ignore[assignment]
    numbers = single(one, start)
    scale, seconds, given_step = one.scale, t, step
    if losses is not None and scale is not None:
        from spincyl._loss import made_law

        made_law(losses, one)
        losses = losses._natural(scale)
    if scale is not None:
        fitting(contact, scale)
        contact = contact if isinstance(contact, str) else contact._natural(scale)
        seconds = si("t", t, "second")
        t = natural_time("t", t, scale)
        t0, step = (
            x if x is None else natural_time(name, x, scale) for name, x in (("t0", t0), ("step", step))
        )
    with speaking(scale):
        asked = ask(start, t, t0, step, tol, method, contact, mu, beyond, want, restitution, losses)
        m = rolled(one if scale is None else one.natural, start, asked, numbers)
    if scale is not None:
        step = None if step is None else number("step", si("step", given_step, "second"))
        m = in_si(m, one, times_of(seconds), step)
    if m.status == Ending.BOUNDED:
        at = f"t = {m.event.time:.6g}" + (" s" if scale is not None else "") if m.event else "its start"
        told = f"given up at {at}: the motion slips and rolls by turns too often, or hardly advances"
        warn(f"{told}; the result ends there (Ending.BOUNDED)", RuntimeWarning)
    if m.coarse:
        why = f"RK4 takes {100 * m.step_loss:.3g} % of the nutation's amplitude away"
        if m.step_loss <= 1e-3:
            why = "more than 0.3 rad of precession or 0.5 rad of nutation in a step"
        warn(f"step = {step!r}: {why}; {m.advice:.2e} would do, or tol=", StepWarning)
    return shortened(m)
