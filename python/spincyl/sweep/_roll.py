"""`sweep.roll`: many motions at once."""

from collections.abc import Iterable
from enum import IntEnum
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from spincyl import _core
from spincyl._asked import Asked, checked_max_nfev
from spincyl._body import Body
from spincyl._circles import columns_of_circles
from spincyl._contact import (
    TABLES,
    AnyContact,
    Coulomb,
    Viscous,
    check_contact_scale,
    code_of,
    code_of_friction,
)
from spincyl._ending import RestsOn
from spincyl._input.numbers import (
    Floats,
    Reals,
    flag,
    floats,
    in_range,
    instance_of,
    is_scalar,
    known_words,
    number,
    one_of,
    optional_library,
    reals,
    si,
)
from spincyl._input.progress import Progress
from spincyl._input.threads import has_large_stack
from spincyl._loss import LAWS, Loss, checked_law
from spincyl._lossy import check_resistance, warn_of_long_arm
from spincyl._measured import errors_in_seconds, natural_time
from spincyl._phases import has_friction
from spincyl._restitution import Restitution, check_restitution
from spincyl._roll import is_stone
from spincyl._state import State, numbers_without_slip, refuse_state_in_air
from spincyl._table import Table
from spincyl.sweep._common import in_memory
from spincyl.sweep._inputs import checked_table, kept_bodies, kept_contact, kept_table
from spincyl.sweep._labels import flags, given_up, refused, uncertain
from spincyl.sweep._swept import Question, swept

if TYPE_CHECKING:
    import xarray

    from spincyl._ellipsoid import Ellipsoid
    from spincyl._ellipsoid_state import EllipsoidState


class Answer(IntEnum):
    """Method that computed a motion of a sweep.

    Attributes
    ----------
    NONE
        No method: the body, the state or the step is invalid (`Status.INVALID`).
    LANES
        The first integrals, eight motions at a time. With a law of friction or a restitution: the body rolls
        from the start to the end.
    SINGLE
        The first integrals, one motion at a time.
    TOLERANCE
        Steps of eighth order, where rounding errors in the first integrals are too large.
    STEP
        RK4 with the fixed step `step`.
    FLOW
        An integrator of eighth order, with friction or losses. Phases of rolling without losses are computed
        by the first integrals.
    """

    NONE = 0
    LANES = 1
    SINGLE = 2
    TOLERANCE = 3
    STEP = 4
    FLOW = 5


_STATE = ("theta", "w1", "w2", "w3")
_SLIP = ("slip_along", "slip_across")
_RIM = ("rim",)
LABELS = {name: (unit, words) for name, unit, words in _core.columns()}


def roll(
    bodies: "Body | Ellipsoid",
    states: "State | EllipsoidState",
    t: Reals,
    *,
    want: str | Iterable[str] | None = None,
    contact: AnyContact = "rolling",
    tol: float = 1e-10,
    step: float | None = None,
    mu: float = np.inf,
    beyond: bool = False,
    restitution: Restitution | None = None,
    stop_at: Literal["rolling"] | None = None,
    losses: Loss | None = None,
    max_nfev: int | None = None,
    errors: bool = True,
    table: Table | None = None,
    threads: int | None = None,
    progress: Progress | bool | None = None,
) -> "xarray.Dataset":
    """Compute the motions of many bodies from their initial states.

    Parameters
    ----------
    bodies : Body or Ellipsoid
        Bodies, or stones (see the Notes), whose parameters may be arrays. These arrays and those of `states`
        broadcast with each other: NumPy arrays by shape, xarray's by the names of their dimensions. If any
        array is backed by dask, the result is lazy: nothing is computed before a call of `compute` or `save`.
    states : State or EllipsoidState
        Initial states at time 0, in natural units, also for measured bodies. Stones need an `EllipsoidState`.
    t : float or array_like, 1-D
        Time of the final state, or an array of the times at which states are returned. The times are at
        least 0 and ascending; to go backward in time they are at most 0 and descending. The unit is
        sqrt(R/g); for measured bodies `t` and `step` are in seconds.
    want : str or iterable of str, optional
        Outputs to compute. Default: "final" if `t` is a number, "states" if `t` is an array.

        - For every motion: "states" (theta, w1, w2, w3 at all times of an array; NaN after the end of a
          motion), "final" (theta, w1, w2, w3 at the last time, or at the end of a motion that ends before),
          and "end" (time of the end).
        - Without friction, losses and restitution: "period" and "precession_per_period" (radians) of the
          nutation. For the time from 0 to the end: "theta_min", "theta_max", "normal_min" (least normal
          force, in units of the weight) and "friction_coefficient_max" (largest coefficient of friction that
          rolling needs; infinite if the normal force vanishes).
        - With a law of friction or with `restitution`: "slip_time" (total time of slip), "dissipated" (heat
          of the slip, M g R) and "phases" (number of phases). For the time at which the last phase of rolling
          begins: "rolling_time", "rolling_theta", "rolling_w1", "rolling_w2", "rolling_w3" (NaN if the body
          never rolls). "states" and "final" then include `slip_along` and `slip_across`.
        - With a law of friction, losses or `restitution`: "rests_on" (what the body lies or stands on at the
          end, the code of `RestsOn`, also heads or tails) and "axis_up" (cosine of the angle from the
          vertical to the body's axis at the end: 1 on its first face, -1 on the other one).
        - With losses: "work_lost" (energy that the losses have taken, M g R).
        - With `restitution`: "impacts" (number of impacts), "landings" (number of landings), "air_time"
          (total time in the air), "lost_in_impacts" (energy, M g R) and "last_phase" (code of
          `Motion.phase`). "states" and "final" then include `rim`, the rim to which theta, w and the slip
          refer, as in `Motion.rim`: theta alone does not tell which face is up.
    contact : {"rolling", "smooth"}, Coulomb or Viscous
        Rolling without slipping, a frictionless table, or a law of friction. The coefficients of a law, and
        the slips of the states, may be arrays that broadcast with the other arrays. Motions with a
        `custom.Friction` or a `custom.Couple` are computed one at a time, and in one thread if the law is a
        Python function. An error of such a law is raised, whatever the motion.
    tol : float
        Largest allowed error of a motion (absolute, 1e-15 to 0.1); a smaller value needs more time. Eight
        motions are computed at a time; a motion that does not reach `tol` in this way is computed alone, as
        accurately as the first integrals allow. If a motion slips, hops or loses energy, `tol` is the
        tolerance of each step of the integrator. The output `error` contains the estimated errors.
    step : float, optional
        Fixed step of RK4, in sqrt(R/g). RK4 is then used instead of the first integrals, and the output
        `error` is the difference from the motion by the first integrals.
    mu : float
        Largest coefficient of friction that rolling may need. A motion ends with `Status.SLIP` where rolling
        needs more. Only for `contact="rolling"`.
    beyond : bool
        If true, do not search for lift-off, for slip and for a landing of the other rim. This takes less
        time, but after such an event the solution no longer describes the real body.
    restitution : float, optional
        Coefficient of restitution of impacts, 0 to 1, as in `spincyl.roll`. Default: a motion ends where the
        body leaves the table or its other rim lands.
    stop_at : {"rolling"}, optional
        End each motion at the first time at which the slip stops and the body goes on rolling. The rest of
        the motion is not computed. Only with a law of friction.
    losses : Loss, optional
        Law of `spincyl.loss` that takes energy, or a sum of several laws, with any contact. Coefficients
        may be arrays that broadcast with the other arrays. Or a `custom.Couple`. A motion with losses ends
        where the body comes to rest (`Status.STOPS`) or the face lands (`Status.FACE`). Motions that roll or
        slide without friction are computed eight at a time, each with its own steps; motions with friction
        are computed one at a time.
    max_nfev : int, optional
        Largest number of evaluations of the equations of motion for each motion, as in `spincyl.roll`. A
        motion that needs more is given up (`Status.BOUNDED`). Default: 8 million, or 40,000 per unit of time
        if that is more. First integrals need no evaluations.
    errors : bool
        Estimate the errors of motions with friction, losses or restitution. Each of these motions is then
        computed twice. If false, they are computed once, in half to four fifths of the time, with the same
        states, ends and `status`, and their `error` is NaN; only where first integrals solve the whole
        motion (`Answer.LANES`) `error` is known all the same.
    table : Table, optional
        Table with a slope, as in `spincyl.roll`; its `slope` and `phi0` may be arrays that broadcast with the
        other arrays. Motions on a slope are integrated.
    threads : int, optional
        Number of threads. Default: the environment variable RAYON_NUM_THREADS, else every core that this
        process may use; 1 in a block of dask.
    progress : callable or bool, optional
        Function that is called with the finished share, 0 to 1, about fifty times a second. Default: if tqdm
        is installed, a bar on a terminal or in a notebook when the work takes more than two seconds. True: a
        bar at once; False: none.

    Returns
    -------
    xarray.Dataset
        The wanted outputs; `error`, the estimated error of each motion; `method`, with the codes of `Answer`;
        and `status`, with the codes of `Status`. `error` is the largest estimated error of the states, and
        of "period" and "precession_per_period" if these are wanted and exist. The dimensions are those of the
        labelled inputs; plain arrays have the dimension "motion", or "motion_0", "motion_1" and so on if
        they have several. "states" has the additional dimension "t". Numbers are in natural units, for
        measured bodies in SI; each array has its `units`. The body, the initial state and the laws of each
        motion are coordinates (see `sweep.inputs`). The bits of a result depend neither on the number of
        threads nor on the other motions, and are the same on AVX2, AVX-512 and NEON.

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid, or an input has a coordinate with the name of an output. The error is
        raised before any computation, and the message names the argument. An element of an array that is out
        of the range of `spincyl.roll` raises no error: its motion has NaN and `Status.INVALID`.
    KeyboardInterrupt
        Within 0.1 s of Ctrl-C.

    Warns
    -----
    RuntimeWarning
        If the computation of motions is given up; the message gives the number of motions. The limits are
        those of `spincyl.roll`, also for stones. Such a motion has NaN and `Status.BOUNDED`; its "end" is the
        time at which it was given up. Also if motions are invalid although all their numbers are finite; the
        message gives the reason for the first of them.
    ErrorWarning
        If estimated errors exceed 0.1 in natural units, as for `spincyl.roll`; the message gives the number
        of motions and which are the first of them, counted from 0 in the order of the last axis. If those of
        stones become too large before the last time (see the Notes); the message gives the number of stones.

    Notes
    -----
    A rolling or smooth motion without losses has first integrals, which Chaplygin, Appell and Korteweg found;
    docs/physics.md has the equations. Each such motion is computed from a power series about its initial
    state, with as many terms as the width of the swing needs. The cost does not grow with time.
    docs/benchmarks.md has measured times and errors.

    A stone has no first integrals. The motion of each stone is integrated twice, to estimate its error. For
    stones `t` is a number, at least 0, in sqrt(a/g) with the largest semi-axis a; `step`, `beyond`,
    `stop_at` and `errors` are not available. The outputs are "spin" (about the vertical, at the end),
    "reversals" (number of reversals of the spin), "first_reversal" (time of the first one), "end",
    "dissipated", "work_lost" (with losses) and "final" (n1, n2, n3, w1, w2, w3). The default is the first
    three. With `restitution` also "impacts", "landings", "air_time", "lost_in_impacts" and "last_phase". A
    reversal counts if the spin passes zero and then reaches a tenth of the initial spin in the other
    direction, also in the air. The time of the reversal is the time of the last zero of the spin before that.
    An initial spin below 1e-12 has no direction, and reversals are not counted. `known_until` is the time up
    to which the motion is known, as in `EllipsoidMotion`. Reversals are counted only up to this time. If they
    are wanted, the motion counts as known while its error is at most a tenth of the initial spin.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> ell = np.linspace(0.9, 3, 1000)
    >>> body = sc.Body.solid(ell)
    >>> found = sc.sweep.roll(body, body.steady(1.3).kicked(0.05), 20.0, want=("final", "theta_max"))
    >>> found["theta_max"].dims, bool((found["error"] < 1e-10).all())
    (('motion',), True)
    """
    optional_library("xarray", "sweep")
    if is_stone(bodies):
        from spincyl.sweep import _stones

        if step is not None or beyond or stop_at is not None or not errors:
            raise ValueError(
                "step, beyond, stop_at, errors: only for bodies of revolution; leave them out for stones"
            )
        stones = _stones.question(
            bodies,
            states,
            t,
            want=want,
            contact=contact,
            tol=tol,
            mu=mu,
            restitution=restitution,
            losses=losses,
            max_nfev=max_nfev,
            table=checked_table(table),
        )
        labels = LABELS | _stones.LABELS
        found = swept(_stones.fill, stones, labels, threads=threads, progress=progress, length="a")
        if losses is not None:
            found.attrs["losses"] = repr(losses)
        return found
    bodies, states = instance_of("bodies", bodies, Body), instance_of("states", states, State)
    scale, seconds, pace = bodies.scale, t, step
    if scale is not None:
        check_contact_scale(contact, scale)
        seconds = si("t", t, "second")
        t = natural_time("t", t, scale)
        pace = si("step", step, "second")
        step = None if step is None else natural_time("step", step, scale)
        if losses is not None:
            checked_law(losses, bodies)
    with errors_in_seconds(scale):
        at, several = _times(t)
    asked = Asked(at, step=step, contact=contact, beyond=flag("beyond", beyond), mu=number("mu", mu))
    asked = _checked(asked._replace(restitution=restitution, stop_at=stop_at), losses)
    asked = asked._replace(
        tol=number("tol", tol), max_nfev=checked_max_nfev(max_nfev), errors=flag("errors", errors)
    )
    odd = asked.step is not None or asked.beyond or asked.times[-1] < 0
    if checked_table(table) is not None and odd:
        raise ValueError(
            "step, beyond, t < 0: cannot be combined with table=, with which motions are integrated forward"
        )
    if restitution is None:
        refuse_state_in_air(states, "give restitution=, the coefficient of restitution, 0 to 1")
    if not has_friction(contact) and (restitution is None or states.height is None):
        numbers_without_slip(
            states, f"contact={contact!r} has no law of friction; give contact=sc.Coulomb(mu)"
        )
    of = TABLES[contact] if isinstance(contact, str) else code_of_friction(contact)
    walks = losses is not None or table is not None
    summaries = _core.summaries(of, walks, restitution is not None)
    wanted = _wanted_of_motions(want, several, tuple(summaries), (of, walks, restitution is not None))
    asked = asked._replace(spread="states" in wanted)
    fields = _fields(bodies, states, contact, losses)
    if table is not None:
        fields |= {"slope": table.slope, "phi0": table.phi0}
    if losses is not None and losses._function is not None:
        asked = asked._replace(losses=losses._natural(scale))
    if not isinstance(contact, str):
        asked = asked._replace(contact=contact._natural(scale))
    for name, own in (("contact", contact), ("losses", losses)):
        in_memory(name, own, fields)
    slips = has_friction(contact) or restitution is not None
    shown = (*_STATE, *(_SLIP if slips else ()), *(_RIM if restitution is not None else ()))
    names = [*shown] if {"final", "states"} & {*wanted} else []
    spread = frozenset(names if asked.spread else ())
    names += [name for name in summaries if name in wanted] + ["error", "method", "status"]
    told = kept_bodies(bodies, states, losses) | kept_contact(contact) | kept_table(table)
    question = Question(fields, names, spread, asked, wanted, scale, seconds, told)
    result = swept(_fill, question, LABELS, threads=threads, progress=progress)
    result.variables["method"].attrs |= flags(Answer)
    if "rests_on" in result.variables:
        result.variables["rests_on"].attrs |= flags(RestsOn)
    if losses is not None:
        result.attrs["losses"] = repr(losses)
    if asked.step is not None:
        result.attrs["step"] = number("step", pace)
    return result


def _checked(asked: Asked, losses: Loss | None) -> Asked:
    """Check the arguments for all motions; an error names the argument."""
    contact, step = asked.contact, asked.step
    if not has_friction(contact):
        code_of(contact, rubs=True)
    if losses is not None:
        checked_law(losses)
        warn_of_long_arm(losses, contact)
        check_resistance(losses, contact)
        asked = asked._replace(while_slipping=losses._acts_in_slip)
    if not has_friction(contact) and asked.stop_at is not None:
        raise ValueError("stop_at: needs contact=sc.Coulomb(...) or contact=sc.Viscous(...)")
    if asked.restitution is not None:
        check_restitution(asked.restitution)
    one_of("stop_at", asked.stop_at, (None, "rolling"))
    if has_friction(contact) or losses is not None or asked.restitution is not None:
        if asked.times[-1] < 0:
            raise ValueError(
                f"t = {float(asked.times[-1])!r}: expected at least 0; a motion with friction, losses or a"
                " restitution cannot go backward in time"
            )
        if step is not None or asked.beyond or (has_friction(contact) and asked.mu != np.inf):
            given = f"contact={contact!r}, losses={losses!r}, restitution={asked.restitution!r}"
            raise ValueError(f"step, mu, beyond: cannot be combined with {given}; leave them out")
    return asked._replace(step=None if step is None else number("step", step))


def _fields(bodies: Body, states: State, contact: AnyContact, losses: Loss | None) -> dict[str, Any]:
    """The inputs of all motions as columns, by the names that the compiled core uses."""
    fields: dict[str, Any] = {
        name: getattr(bodies, name) for name in ("ell", "i1", "i3", "fillet", "theta_end")
    }
    fields |= columns_of_circles(bodies)
    fields |= zip(_STATE, states._numbers, strict=True)
    if isinstance(contact, Coulomb | Viscous):
        fields |= zip(("coefficient", "static", "patch"), contact._numbers, strict=True)
    if states.slip is not None:
        fields |= zip(_SLIP, states._slip, strict=True)
    if states.height is not None:
        fields |= {"height": states.height, "lift": states.lift}
    if losses is not None and losses._built_in is not None:
        fields |= zip(LAWS, losses._built_in._coefficients, strict=True)
    return fields


def _times(t: Reals) -> tuple[Floats, bool]:
    """The times, and whether they were given as an array."""
    given = reals("t", t)
    if is_scalar(given):
        # adding 0.0 turns -0.0 into 0.0
        return np.array([in_range("t", given, -1e15, 1e15, "sqrt(R/g)") + 0.0]), False
    at = floats(given) + 0.0
    if at.ndim != 1 or at.size == 0:
        like = "a number (time of the final state) or a one-dimensional array of at least one time"
        raise ValueError(f"t: expected {like}, not an array of shape {at.shape}")
    ordered = any((np.diff(x, prepend=0.0) >= 0).all() for x in (at, -at))
    if not ordered or not np.abs(at).max() <= 1e15:
        order = "all >= 0 and ascending, or all <= 0 and descending"
        raise ValueError(f"t: expected times that are {order}, and at most 1e15 in absolute value")
    return at, True


def _wanted_of_motions(
    want: str | Iterable[str] | None,
    several: bool,
    summaries: tuple[str, ...],
    given: tuple[int, bool, bool],
) -> tuple[str, ...]:
    kinds = ("final", "states", *summaries)

    def needs(name: str) -> str:
        contact, losses, hits = given
        others = {
            "losses=": (contact, True, hits),
            "contact=sc.Coulomb(mu)": (TABLES["coulomb"], losses, hits),
            "restitution=": (contact, losses, True),
        }
        for argument, other in others.items():
            if name in _core.summaries(*other):
                return f"; this output needs {argument}"
        return ""

    asked = known_words("want", ("states" if several else "final") if want is None else want, kinds, needs)
    if "states" in asked and ("final" in asked or not several):
        raise ValueError('want: "states" needs an array of times t, and cannot be combined with "final"')
    return tuple(name for name in kinds if name in asked)


def _fill(
    columns: dict[str, Floats],
    times: Floats,
    asked: dict[str, Any],
    out: dict[str, Any],
    threads: int,
    progress: Progress | None,
) -> None:
    """Compute a block of motions from its columns; write the results into the arrays of `out`."""
    _core.ensemble(columns, times, asked, out, (threads, has_large_stack()), progress)
    given_up(out["status"])
    refused(columns, asked, out["status"])
    uncertain(asked, out["error"], out["status"])
