"""`roll`: reads the arguments, computes the motion, and converts it to the units of the body."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, TypeGuard, overload

import numpy as np

from spincyl._asked import Method, Want, ask, times_of
from spincyl._body import Body
from spincyl._contact import AnyContact, check_contact_scale
from spincyl._ending import LARGE_ERROR, Ending, ErrorWarning
from spincyl._input.hints import with_hints
from spincyl._input.numbers import Reals, number, si, warn
from spincyl._measured import errors_in_seconds, in_si, natural_time
from spincyl._motion import Motion, rolled
from spincyl._restitution import GainWarning, Newton, Poisson
from spincyl._state import State
from spincyl._swing import numbers_of_one
from spincyl._told import given_up

if TYPE_CHECKING:
    from spincyl._ellipsoid import Ellipsoid
    from spincyl._ellipsoid_motion import EllipsoidMotion
    from spincyl._ellipsoid_state import EllipsoidState
    from spincyl._loss import Loss
    from spincyl._restitution import Restitution
    from spincyl._table import Table


#: Rounding errors add less energy than this in an impact, in M g R or J.
_GAINED = 1e-12


class StepWarning(UserWarning):
    """The fixed step of RK4 is so long that RK4 damps the nutation or computes a wrong precession."""


def is_stone(body: object) -> TypeGuard["Ellipsoid"]:
    """Whether the body is a stone; the module of stones is imported only if `body` is no `Body`."""
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
    restitution: "Restitution | None" = None,
    losses: "Loss | None" = None,
    max_nfev: int | None = None,
    table: "Table | None" = None,
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
    restitution: "Restitution | None" = None,
    losses: "Loss | None" = None,
    max_nfev: int | None = None,
    table: "Table | None" = None,
) -> Motion: ...
@with_hints
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
    restitution: "Restitution | None" = None,
    losses: "Loss | None" = None,
    max_nfev: int | None = None,
    table: "Table | None" = None,
) -> Motion:
    """Compute the motion of a body from an initial state.

    Parameters
    ----------
    body : Body or Ellipsoid
        Single body with ell at most 1e6 and moments of inertia from 1e-6 to 1e12, or a single stone.
    state : State or EllipsoidState
        Initial state, in natural units, also for a measured body. theta is in [1e-8, pi - 1e-8], or 0 or pi
        for a body on its face (`spun`), with w1 = 0. Angular velocities are at most 1e6 sqrt(g/R). A stone
        needs an `EllipsoidState`.
    t : array_like, 1-D, or a number
        Times at which the motion is returned, in sqrt(R/g), in ascending order, or descending to go backward
        in time. For a measured body `t`, `t0` and `step` are in seconds, or are pint quantities.
    t0 : float, optional
        Time of the initial state. Default: `t[0]` if `t` is an array of two or more times, else 0. An array
        of one time other than 0 needs `t0`.
    step : float, optional
        Fixed step of RK4, in sqrt(R/g). Backward in time it may have either sign.
    tol : float, optional
        Absolute tolerance of each step of an eighth-order method, 1e-14 to 0.1. `Motion.error` estimates the
        error of the result. In a motion with friction only the slipping is integrated with such steps, in a
        motion with losses everything; the default is then 1e-14.
    method : {"exact", "rk4"}, optional
        Default: RK4 if `step` is given, steps of eighth order if `tol` is given, else "exact". The exact
        method uses the first integrals, and a late time costs no more than an early one. Where rounding
        leaves the first integrals no correct digit, steps of eighth order with a tolerance of 1e-12 replace
        them; `Motion.method` is then "dop853".
    contact : {"rolling", "smooth"}, Coulomb or Viscous
        Rolling without slipping, a frictionless table, or a law of friction. With a law of friction the body
        starts with the `slip` of the state; without a slip it starts rolling. The law decides when slipping
        turns into rolling and back.
    mu : float
        Largest coefficient of friction that rolling may need. The motion ends with `Ending.SLIP` where
        rolling needs more. Only for `contact="rolling"`; with `contact=Coulomb(mu)` the body slips instead.
    want : str or iterable of str
        Optional outputs to compute: "pose" (phi, psi, contact_point, centre, orientation), "force" (normal,
        friction, friction_coefficient), or both, which also gives contact_force.
    beyond : bool
        If true, continue the solution past the event, although it no longer describes the real body.
        `Motion.event` is still set. The solution cannot continue past a landing of the face.
    restitution : float or Newton or Poisson or Walton, optional
        Coefficient of restitution of impacts, 0 to 1. Its square is the fraction of the work of
        compression that an impact returns (Stronge); `Newton`, `Poisson` and `Walton` are other laws.
        Default: the motion ends where the body leaves the table or its other rim or its face lands. With
        a restitution the motion continues: the body may fly, bounce, lie on both rims, stand on its face
        and rise again. An initial state in the air (`dropped`, and for a stone `Ellipsoid.dropped`) needs
        a restitution. A stone flies, bounces, slips and rolls, until its edge lands (`theta_end`). While the
        other rim carries the body, theta refers to that rim, and phi is turned by pi: `Motion.rim` gives the
        rim, and `Motion.axis_up` and `Motion.rests_on` distinguish heads from tails. With
        `contact="rolling"` a landing on both rims ends the motion (`Ending.SIDE`), unless the body only rocks
        from rim to rim. The motion also ends where friction would lift the body (`Ending.SLIP`): on a real
        table the contact would slip first.
    losses : Loss, optional
        Loss law of `spincyl.loss`, or several added with `+`. The motion is then integrated with steps of
        eighth order, forward in time only. It may end where the body comes to rest (`Ending.STOPS`).
    max_nfev : int, optional
        Largest number of evaluations of the equations of motion (`Motion.nfev`). A motion that needs more
        ends where it is (`Ending.BOUNDED`). Default: 8 million, or 40,000 per unit of time if that is more;
        no limit for RK4. A larger number also allows more steps that hardly advance the time. The exact
        method needs no evaluations.
    table : Table, optional
        Table with a slope, and with the place and the heading of the body at the start. Default: a level
        table, on which the body starts at x = y = phi = 0. On a slope the motion is integrated, forward in
        time, and has its pose; its energy includes the height of the centre above the place x = 0.

    Returns
    -------
    Motion
        States at the times `t` up to the event that ends the motion: a landing of the face or of the other
        rim, lift-off, or slip. With a restitution a motion ends only where a body on its face has come to
        rest, where a face lands while the body bounces and tumbles, or if the laws of impact and friction do
        not determine how the motion continues. The arrays of a motion that ends early are then shorter than
        `t`; plot them against the motion's own `t` (matplotlib rejects x and y of different lengths). If `t`
        is a number and the motion ends before `t`, the arrays are empty; `status`, `event` and `message` give
        the reason. For a measured body the motion is in SI.

    Raises
    ------
    ValueError
        If the body, the state, a time, the step, the tolerance or `mu` is out of range; the message names it.
        Also if the step is so large that fast precession or nutation would come out wrong without notice; the
        message proposes a step.
    TypeError
        If an argument has a wrong type; the message names it.
    KeyboardInterrupt
        Within 0.1 s after Ctrl-C.

    Warns
    -----
    RuntimeWarning
        If the computation gives up (`Ending.BOUNDED`); the motion is returned up to that time, for a body
        and for a stone, and the message says which limit it has reached: `max_nfev` evaluations, 600,000
        steps that hardly advance the time, slipping, rolling and sticking that alternate more than 20 times
        per unit of time (the limit is at least 5,000 and at most 10,000 times in all), 30,000 impacts, or
        rounding errors that outweigh the motion.
    StepWarning
        If RK4 damps the nutation by more than a thousandth of its amplitude, or if the precession advances by
        more than 0.3 rad or the nutation by more than 0.5 rad in a step.
    ErrorWarning
        If the estimated error of a motion without `step` exceeds 0.1 in natural units; impacts multiply
        errors, and a body that hops often reaches this. `Motion.known_until` is the time until which the
        motion is known. For a stone, if the error becomes too large before the motion ends; the message
        gives this time (`EllipsoidMotion.known_until`).

    Notes
    -----
    Chaplygin, Appell and Korteweg found the first integrals; docs/physics.md has the equations. The error of
    an exact motion is 1e-14 times the condition number of the motion. `Motion.error` estimates the error of
    each motion; in the tests the estimate is never below a tenth of the true error.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> body = sc.Body.solid(2.5)
    >>> m = sc.roll(body, body.steady(1.3).kicked(0.05), np.linspace(0, 20, 2001))
    >>> float(m.theta.max().round(4)), m.status.name
    (1.3389, 'DONE')

    A hoop thrown with backspin slips until it rolls:

    >>> hoop, thrown = sc.Body.tube(0.0, bore=1.0), sc.State(np.pi / 2, 0.0, 0.0, -3.0, slip=(0.0, 5.0))
    >>> sc.roll(hoop, thrown, 20.0, contact=sc.Coulomb(0.25)).phases
    ((0, 'slipping'), (10, 'rolling'))

    A dropped ball bounces lower and lower. It begins to roll when the bounces have ended:

    >>> ball = sc.Body.ball(0.0, i1=0.4, i3=0.4)
    >>> m = sc.roll(ball, sc.dropped(ball, 0.5, 1.0), 10.0, contact=sc.Coulomb(0.3), restitution=0.5)
    >>> len(m.impacts), m.phases[-1].kind, round(m.phases[-1].time, 5)
    (23, 'rolling', 3.0)

    A tube slides and spins on its face. Both end at the same moment:

    >>> tube = sc.Body.tube(0.75, bore=0.8)
    >>> m = sc.roll(tube, sc.spun(tube, 1.0, (1.5, 0.0)), 10.0, contact=sc.Coulomb(0.25))
    >>> m.status.name, round(m.event.time, 9)
    ('STOPS', 7.498824259)
    """
    one: Any = body
    given: Any = state
    stone = type(body) is not Body and is_stone(body)
    if stone:
        from spincyl import _ellipsoid_motion as stones

        start = stones.start_of_stone(given, contact, step, method, restitution)
        if losses is not None:
            from spincyl._lossy import losses_of_stone

            losses_of_stone(losses, body)
    else:
        numbers, start = numbers_of_one(one, given, several=True), given
    scale, seconds, given_step = body.scale, t, step
    if scale is not None:
        if losses is not None:
            from spincyl._loss import checked_law

            losses = checked_law(losses, one)._natural(scale)
        check_contact_scale(contact, scale)
        contact = contact if isinstance(contact, str) else contact._natural(scale)
        seconds = si("t", t, "second")
        t = natural_time("t", t, scale)
        t0, step = (
            x if x is None else natural_time(name, x, scale) for name, x in (("t0", t0), ("step", step))
        )
    with errors_in_seconds(scale, body._length):
        asked = ask(
            start,
            t,
            t0=t0,
            step=step,
            tol=tol,
            method=method,
            contact=contact,
            mu=mu,
            beyond=beyond,
            want=want,
            restitution=restitution,
            losses=losses,
            max_nfev=max_nfev,
            table=table,
        )
        of = one if scale is None else one.natural
        m: Motion = stones.rolled_stone(of, given, asked) if stone else rolled(of, start, asked, numbers)
    hops = restitution is not None
    given_up_too = hops and m.status == Ending.BOUNDED  # which has a warning of its own
    if not stone and step is None and not given_up_too and not m.error <= LARGE_ERROR:
        why = f"{'impacts multiply errors, and ' if hops else ''}its last states are not known"
        told = f"the estimated error of the motion is {m.error:.2g}, in natural units: {why}"
        warn(f"{told}; Motion.known_until is the time up to which states are known", ErrorWarning)
    if scale is not None:
        step = None if step is None else number("step", si("step", given_step, "second"))
        m = in_si(m, one, times_of(seconds), step)
    if stone and m._doubt:
        why = f"after this time its estimated error reaches {m.error:.2g}"
        warn(f"the motion is {m._doubt} (known_until); {why}", ErrorWarning)
    gained = sum(hit.gained for hit in m.impacts) if isinstance(restitution, Newton | Poisson) else 0.0
    if gained > _GAINED:
        told = f"impacts have added {gained:.2g} {'M g R' if m.scale is None else 'J'} of energy to the body"
        warn(f"{restitution!r}: {told}, as this law allows; see Impact.gained", GainWarning)
    if m.status == Ending.BOUNDED:
        warn(f"{given_up(m)} (Ending.BOUNDED)", RuntimeWarning)
    if m.rk4 is not None and m.rk4.coarse:
        why = f"RK4 damps the nutation by {100 * m.rk4.loss:.3g} % of its amplitude"
        if m.rk4.loss <= 1e-3:
            why = "the precession advances by more than 0.3 rad, or the nutation by 0.5 rad, in a step"
        warn(f"step = {step!r}: {why}; give step={m.rk4.advice:.2e}, or tol=", StepWarning)
    return m
