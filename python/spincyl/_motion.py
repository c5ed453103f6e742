"""Motion: how a body rolls, slides or slips on from a state."""

import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spincyl import _core
from spincyl._array import Floats, Reals, number, si
from spincyl._asked import Asked, Method, ask, choices, times_of
from spincyl._body import Body
from spincyl._contact import AnyContact, named, table
from spincyl._ending import Ending, Event
from spincyl._equal import compared
from spincyl._measured import in_si, natural_time, told
from spincyl._phases import EXTRAS, Phase, phases, slipping
from spincyl._scale import Scale
from spincyl._state import State
from spincyl._swing import single, single_slip
from spincyl._told import message

if TYPE_CHECKING:
    import pandas
    import xarray

    from spincyl._ellipsoid import Ellipsoid, EllipsoidState
    from spincyl._loss import Loss


_Six: TypeAlias = tuple[float, float, float, float, float, float]
_Four: TypeAlias = tuple[float, float, float, float]


class StepWarning(UserWarning):
    """A fixed step is so large that it takes a part of the nutation away, or blurs the precession."""


@compared
@dataclass(frozen=True, eq=False, repr=False)
class Motion:
    """Times and states of a body, and how its motion ended; from `roll`.

    Shaped as the result of SciPy's `solve_ivp`; n is the number of times reached. Units are natural, as named
    below; but if the body is `measured`, everything here is in SI: t, and the times of `event`, `phases` and
    `at`, in s, w in rad/s, lengths in m, `slip` in m/s, forces in N, energies in J. A `State` is in natural
    units always: `start`, `states`, and those of `event` and `phases`. `natural` has all of it in these.

    Attributes
    ----------
    t, theta, w, y, energy : ndarray
        Times (n,), inclination (n,), angular velocity along the axes that follow the tilt (n, 3); theta, w1,
        w2, w3 as `solve_ivp` has them (4, n); energy in M g R (n,).
    phi, psi, turns, contact_point, centre, orientation : ndarray
        If want="pose": angles since the start, and as whole turns and rest; places in R; quaternions.
    normal, friction, friction_coefficient : ndarray
        If want="force": per weight; the last is the mu that rolling needs.
    slip, dissipated, phase : ndarray
        With `contact=Coulomb(mu)` or `Viscous(c)`: velocity of the lowest point over the table (n, 2), along
        the lean and across it as `State` has it; heat since the start, M g R; 1 while it slips, 0 while it
        rolls.
    phases : tuple of Phase
        With these contacts: `time`, `kind` ("slipping" or "rolling") and `state` of each begin.
    losses, work_lost : Loss or None, ndarray
        The laws of `losses=`; what they have taken since the start, M g R (n,).
    status : Ending
        How it ended, 0 (`Ending.DONE`) if the last time was reached; `success` is that as a bool.
    event : Event or None
        The first thing that the model does not cover: its `ending`, `time` and `state`.
    message : str
        How it ended, how it was got, and how large the errors are, in words.
    method : str
        "exact", "rk4" (a fixed step), "rk4 within tol" or, with friction or losses, "dop853".
    scale : Scale or None
        That of the body: with one the motion is in SI.
    natural : Motion
        The same motion in natural units.
    error : float
        Estimated absolute error: the largest of theta, w1, w2, w3 at any time, and of the event.
    pose_error : float
        The same of phi and psi (radians) and of the contact point (R); NaN if no pose was wanted.
    force_error : float
        The same of the normal force and of the components of the friction, in their unit, to first order in
        the errors of the state; NaN if no force was wanted.
    step_loss, advice : float
        Of a fixed step: the share of the nutation's amplitude that it takes away, as predicted beforehand;
        and a step that loses less than a thousandth and needs no warning.
    nfev : int
        Evaluations of the equations of motion; 0 of an exact motion.
    coarse : bool
        Whether a fixed step takes more than a thousandth, or turns so far, that it was warned of.
    """

    body: Body
    start: State
    contact: AnyContact
    t: Floats  #: (n,) times
    theta: Floats  #: (n,) inclination, radians
    w: Floats  #: (n, 3) angular velocity along the axes that follow the tilt
    status: Ending  #: how it ended
    event: Event | None  #: where, if it did not reach the last time
    method: str  #: what found it: "exact", "rk4" or "rk4 within tol"
    error: float  #: estimated error of any number of any state
    pose_error: float  #: the same of angles (radians) and contact point (R); NaN if no pose was wanted
    force_error: float  #: the same of the forces, in their unit; NaN if none was wanted
    step_loss: float  #: share of the nutation that a fixed step takes away, as predicted
    advice: float  #: a fixed step that would lose less than a thousandth; infinite unless a step was given
    nfev: int  #: evaluations of the equations of motion
    coarse: bool  #: whether the step was warned of
    _asked: Asked
    _setting: float
    _extra: dict[str, Any]
    _phases: tuple[Phase, ...] | None = None
    _natural: "Motion | None" = None  # what a motion in SI was found as

    @property
    def scale(self) -> Scale | None:
        """The scale of a measured body: the motion is in SI; None: in natural units."""
        return self.body.scale

    @property
    def natural(self) -> "Motion":
        """The same motion in natural units."""
        return self if self._natural is None else self._natural

    @property
    def y(self) -> Floats:
        """(4, n): theta, w1, w2, w3."""
        return np.vstack([self.theta, self.w.T])

    @property
    def states(self) -> State:
        """The states as one `State` of arrays, in natural units."""
        if self._natural is not None:
            return self._natural.states
        slip = self._extra.get("slip")
        pair = None if slip is None else (slip[:, 0], slip[:, 1])
        return State(self.theta, *(self.w[:, i] for i in range(3)), slip=pair)

    @property
    def energy(self) -> Floats:
        """(n,) kinetic and potential energy, in M g R; with `dissipated` and `work_lost` it is constant."""
        energy: Floats = self.body.energy(self.states, self.contact)
        return self._told("energy", energy)

    @property
    def success(self) -> bool:
        """Whether the last time was reached."""
        return self.status == Ending.DONE

    @property
    def message(self) -> str:
        """How it ended and how it was got, in words."""
        return message(self)

    # "pose"

    @property
    def phi(self) -> Floats:
        """(n,) precession angle since the start, radians. Needs want="pose"."""
        return self._angle("phi")

    @property
    def psi(self) -> Floats:
        """(n,) spin angle since the start, radians. Needs want="pose"."""
        return self._angle("psi")

    @property
    def turns(self) -> tuple[Floats, Floats]:
        """(n, 2) each: whole turns and rest (radians) of phi, of psi. Needs want="pose".

        The rest keeps its digits however many turns there were.
        """
        return self._wanted("phi", "pose"), self._wanted("psi", "pose")

    @property
    def contact_point(self) -> Floats:
        """(n, 2) place of the contact on the table, in R; starts at the origin. Needs want="pose"."""
        return self._wanted("contact_point", "pose")

    @property
    def centre(self) -> Floats:
        """(n, 3) place of the centre of mass, in R. Needs want="pose"."""
        return self._wanted("centre", "pose")

    @property
    def orientation(self) -> Floats:
        """(n, 4) rotation from the body's axes (e3 the third) to the laboratory's. Needs want="pose".

        Unit quaternions (x, y, z, w), as `scipy.spatial.transform.Rotation.from_quat` takes them.
        """
        return self._wanted("orientation", "pose")

    # "force"

    @property
    def normal(self) -> Floats:
        """(n,) normal force N per weight. Needs want="force"."""
        return self._wanted("normal", "force")

    @property
    def friction(self) -> Floats:
        """(n,) friction demand: size of the horizontal force per weight. Needs want="force"."""
        return self._wanted("friction", "force")

    @property
    def friction_coefficient(self) -> Floats:
        """(n,) the coefficient of friction that is needed; infinite where N <= 0. Needs want="force"."""
        return self._wanted("friction_coefficient", "force")

    # friction

    @property
    def phases(self) -> tuple[Phase, ...]:
        """When it slips, when it rolls: `Phase(time, kind, state)` of each begin. Needs a law of friction.

        There are none if the motion ends where it starts: a body on its side that stays lying, or leaps.
        """
        if self._phases is None:
            raise AttributeError(_NO_FRICTION.format("phases", named(self.contact)))
        return self._phases

    @property
    def phase(self) -> NDArray[np.uint8]:
        """(n,) 1 while it slips, 0 while it rolls. Needs a law of friction."""
        found: NDArray[np.uint8] = self._rubbed("phase")
        return found

    @property
    def slip(self) -> Floats:
        """(n, 2) velocity of the lowest point over the table, sqrt(g R). Needs a law of friction.

        Along the lean and across it, as in `State`.
        """
        found: Floats = self._rubbed("slip")
        return found

    @property
    def dissipated(self) -> Floats:
        """(n,) heat since the start, in M g R. Needs a law of friction."""
        found: Floats = self._rubbed("dissipated")
        return found

    # losses

    @property
    def losses(self) -> "Loss | None":
        """What takes energy from it, besides friction of a contact that slips; None if nothing does."""
        return self._asked.losses

    @property
    def work_lost(self) -> Floats:
        """(n,) what the losses have taken since the start, in M g R. Needs `losses=`."""
        if "work_lost" not in self._extra:
            raise AttributeError(
                "work_lost is not there: nothing is lost; roll(..., losses=sc.loss.DryContour(eps)) has it"
            )
        return self._told("work_lost", self._extra["work_lost"])

    def to_xarray(self) -> "xarray.Dataset":
        """Everything that was wanted, labelled, with units; needs spincyl[sweep]."""
        from spincyl._labelled import labelled

        return labelled(self)

    def to_dataframe(self) -> "pandas.DataFrame":
        """Everything that was wanted as a table by times, a column for each number; needs spincyl[sweep].

        ``attrs["units"]`` has the unit of each column and of the index.
        """
        from spincyl._labelled import table

        return table(self)

    def wanting(self, *want: str, t: Reals | None = None) -> "Motion":
        """The same motion with more of it, or at other times `t`, computed anew if it has to be."""
        if self._natural is not None:
            seconds = self._asked.times if t is None else times_of(si("t", t, "second"))
            of = self._natural.wanting(*want, t=None if t is None else seconds / self._second)
            return self if of is self._natural else in_si(of, self.body, seconds, self._asked.step)
        have, more = self._asked.want, choices(want)
        if t is None and have >= more:
            return self
        asked = self._asked._replace(want=have | more)
        if t is not None:
            asked = asked._replace(times=times_of(t))
        return _rolled(self.body, self.start, asked)  # what there is to warn of has been said

    def at(self, t: Reals) -> "Motion":
        """The same motion at other times: of the same start, found in the same way, with the same extras.

        Parameters
        ----------
        t : array_like, 1-D, or a number
            Times in sqrt(R/g), of a measured body in seconds, in order, on the clock of this motion, whose
            start keeps its time.

        Returns
        -------
        Motion
            At these times, up to the first event.

        Raises
        ------
        ValueError, TypeError
            As `roll` does, naming `t`.

        Examples
        --------
        >>> import spincyl as sc
        >>> body = sc.Body.solid(2.5)
        >>> m = sc.roll(body, body.steady(1.3).kicked(0.05), 20.0)
        >>> m.at([0.0, 10.0]).theta.round(4).tolist()
        [1.3, 1.3203]
        """
        return self.wanting(t=times_of(t if self._natural is None else si("t", t, "second")))

    def sound(
        self,
        path: str | PathLike[str],
        seconds: float | None = None,
        *,
        scale: Scale | None = None,
        rate: int = 44_100,
    ) -> Path:
        """Write what one hears of it as a WAV file: a ring that beats once for each turn of the contact.

        Parameters
        ----------
        path : path-like
            Ends in .wav: one channel of 16 bits.
        seconds : float, optional
            How long, from the motion's first time on. Default: all of it, at most 180.
        scale : Scale, optional
            Makes seconds of its times; a measured body has one.
        rate : int
            Samples a second.

        Returns
        -------
        Path
            That of the file. The beat, phi'/(2 pi), is that of the motion; the pitch of the ring is made up.

        Raises
        ------
        OSError
            If it cannot be written. A file that is there stays until the new one is complete.
        """
        from spincyl._sound import sound

        return sound(self, path, seconds, scale, rate)

    def _wanted(self, name: str, want: str) -> Floats:
        if name not in self._extra:
            raise AttributeError(f'{name} was not asked for: roll(..., want="{want}")')
        return self._told(name, self._extra[name])

    def _rubbed(self, what: str) -> Any:
        if what not in self._extra:
            raise AttributeError(_NO_FRICTION.format(what, named(self.contact)))
        return self._told(what, self._extra[what])

    @property
    def _second(self) -> float:
        """The natural unit of time in that of the motion."""
        return 1.0 if self.scale is None else self.scale._units[1]

    def _told(self, name: str, values: Floats) -> Floats:
        """Numbers in natural units in those of the motion."""
        found: Floats = values if self._natural is None else told(name, values, self.scale)
        return found

    def _angle(self, name: str) -> Floats:
        turns, rest = self._wanted(name, "pose").T
        angle: Floats = 2 * np.pi * turns + rest
        return angle

    def _repr_html_(self) -> str:
        from spincyl import _html

        return _html.motion(self)

    def __repr__(self) -> str:
        wanted = "".join(f", {name}" for name in self._extra)
        return f"<Motion of {self.body!r}: {self.t.size} times, theta, w{wanted}; {self.message}>"


_NO_FRICTION = "{} is not there: the contact is {!r}; roll(..., contact=sc.Coulomb(mu)) has it"


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
    want: str | Iterable[str] = (),
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
        Time of the start. Default: the first of `t`; 0 if `t` is a number.
    step : float, optional
        By RK4 with this fixed step, of either sign backward in time.
    tol : float, optional
        By RK4, each of whose steps errs by less than this (1e-14 to 0.1). The error at the end is
        said by `Motion.error`. With friction, the same of the steps of slipping, with losses of all
        steps; default 1e-14.
    method : {"exact", "rk4"}, optional
        Default: RK4 if a step or a tolerance is given; else the first integrals, which give the
        state at any time for the same cost. Where these lose all their digits, RK4 within 1e-12
        answers, and `method` and `message` say so.
    contact : {"rolling", "smooth"}, Coulomb or Viscous
        Rolling without slipping, a frictionless table, or a law of friction: then the body slips from the
        `slip` of the state, or rolls if it has none, and passes from one to the other where the law says so.
    mu : float
        Of "rolling": where it needs a larger coefficient of friction, it ends (`Ending.SLIP`). To let it slip
        from there on give `contact=Coulomb(mu)` instead.
    want : str or iterable of str
        "pose" (phi, psi, contact_point, centre, orientation), "force" (normal, friction,
        friction_coefficient). What is not asked for is not computed.
    beyond : bool
        Whether to go on beyond an event, where the model is no longer that of the body. The event is
        reported all the same. Beyond a landing of the face there is nothing.
    restitution : None or 0.0
        With friction: None ends the motion where the other rim lands; with 0.0 it lands without a bounce, and
        the motion goes on. If it then stands on that rim, this counts as the lower one: theta is told from
        there, and phi turns by pi.
    losses : Loss, optional
        What takes energy: a law of `spincyl.loss`, or several, added with `+`. The motion is then found by
        steps, forward in time, and may end where the contact point stops (`Ending.STOPS`).

    Returns
    -------
    Motion
        At the times up to the first event: the face or the other rim lands, lift-off, slip. Of a measured
        body it is in SI.

    Raises
    ------
    ValueError
        Before any work: for a body, state, time, step, tolerance or mu out of range, by name; for a
        step at which fast precession or nutation would come out wrong unnoticed, with one that would do.
        With friction or losses also on the way: where slipping, rolling and the ways of dry losses change
        over 10,000 times, where 600,000 steps hardly advance, since something changes ever faster, and where
        8 million evaluations are not enough (of times beyond 50: 160,000 for each unit).
    TypeError
        Naming an argument that is no real number.
    KeyboardInterrupt
        Within 0.1 s of Ctrl-C.

    Warns
    -----
    StepWarning
        If the step takes more than a thousandth of the nutation away, or turns by more than 0.3 rad.

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
    """
    if type(body) is not Body and hasattr(body, "_roll"):
        given: dict[str, Any] = {
            "t0": t0,
            "step": step,
            "tol": tol,
            "method": method,
            "contact": contact,
            "mu": mu,
        }
        given |= {"want": want, "beyond": beyond, "restitution": restitution, "losses": losses}
        stone: Motion = body._roll(state, t, **given)
        return stone
    start: State = state  # type: ignore[assignment]  # `single` refuses another
    numbers = single(body, start)
    scale, seconds, given_step = body.scale, t, step
    if scale is not None:
        seconds = si("t", t, "second")
        t = natural_time("t", t, scale)
        t0, step = (
            x if x is None else natural_time(name, x, scale) for name, x in (("t0", t0), ("step", step))
        )
    try:
        asked = ask(start, t, t0, step, tol, method, contact, mu, beyond, want, restitution, losses)
        m = _rolled(body if scale is None else body.natural, start, asked, numbers)
    except ValueError as e:
        if scale is None:
            raise
        raise ValueError(f"{e} (natural units: sqrt(R/g) is {scale._units[1]:.6g} s of this body)") from None
    if scale is not None:
        step = None if step is None else number("step", si("step", given_step, "second"))
        m = in_si(m, body, times_of(seconds), step)
    if m.coarse:
        why = f"RK4 takes {100 * m.step_loss:.3g} % of the nutation's amplitude away"
        if m.step_loss <= 1e-3:
            why = "more than 0.3 rad of precession or 0.5 rad of nutation in a step"
        warnings.warn(f"step = {step!r}: {why}; {m.advice:.2e} would do, or tol=", StepWarning, stacklevel=2)
    return m


def _rolled(body: Body, state: State, asked: Asked, numbers: tuple[_Six, _Four] | None = None) -> Motion:
    """The motion that was asked for, without a warning; `numbers` are those of body and state, if known."""
    times, t0, step, tol, _, contact, mu, beyond, want, restitution, losses = asked
    of, start = numbers or single(body, state)
    code, coefficients = table(contact, mu)
    found = _core.roll(
        of,
        start,
        times,
        {
            "t0": t0,
            "slip": single_slip(state),
            "table": code,
            "coefficients": coefficients,
            "losses": None if losses is None else losses._coefficients,
            "step": step,
            "tol": tol,
            "beyond": beyond,
            "restitution": None if restitution is None else 0.0,
            "pose": "pose" in want,
            "force": "force" in want,
        },
    )
    extra = {name: found.pop(name) for name in OUTPUTS if name in found}
    status = ENDINGS[found["status"]]
    event = None
    if "event" in found:
        time, *where = found["event"]
        event = Event(status, time, slipping(*where))
    # the core names what it finds as the fields do: set one by one, frozen fields take longer than a motion
    found |= {
        "body": body,
        "start": state,
        "contact": contact,
        "status": status,
        "event": event,
        "_asked": asked,
        "_extra": extra,
        "_phases": phases(found.pop("phases")) if "phases" in found else None,
    }
    m = object.__new__(Motion)
    object.__setattr__(m, "__dict__", found)
    return m


ENDINGS = {int(ending): ending for ending in Ending}
OUTPUTS = (
    "phi",
    "psi",
    "contact_point",
    "centre",
    "orientation",
    "normal",
    "friction",
    "friction_coefficient",
    *EXTRAS,
    "work_lost",
)
