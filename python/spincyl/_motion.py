"""Motion: how a body rolls, slides or slips on from a state."""

import math
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spincyl import _core
from spincyl._array import Floats, Reals, floats, is_scalar, number, reals
from spincyl._body import Body
from spincyl._contact import AnyContact, Coulomb, Viscous, code, named
from spincyl._ending import MESSAGES, Ending, Event
from spincyl._phases import EXTRAS, Phase, check, how_found, rubs, slid, slipping, told
from spincyl._state import State
from spincyl._swing import single

if TYPE_CHECKING:
    import xarray

Method: TypeAlias = Literal["exact", "rk4"]
_WANTS = ("pose", "force")


class StepWarning(UserWarning):
    """A fixed step is so large that it takes a part of the nutation away, or blurs the precession."""


class Asked(NamedTuple):
    """What `roll` was asked for."""

    times: Floats
    t0: float
    step: float | None
    tol: float | None
    method: Method | None
    contact: AnyContact
    mu: float
    beyond: bool
    want: frozenset[str]
    landing: float | None


@dataclass(frozen=True, eq=False, repr=False)
class Motion:
    """Times and states of a body, and how its motion ended; from `roll`.

    Shaped as the result of SciPy's `solve_ivp`. Natural units; n is the number of times reached.

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
    status : Ending
        How it ended, 0 (`Ending.DONE`) if the last time was reached; `success` is that as a bool.
    event : Event or None
        The first thing that the model does not cover: its `ending`, `time` and `state`.
    message : str
        How it ended, how it was got, and how large the errors are, in words.
    method : str
        "exact", "rk4" (a fixed step), "rk4 within tol" or, with friction, "dop853".
    error : float
        Estimated absolute error: the largest of theta, w1, w2, w3 at any time, and of the event.
    pose_error : float
        The same of phi and psi (radians) and of the contact point (R); NaN if no pose was wanted.
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
    step_loss: float  #: share of the nutation that a fixed step takes away, as predicted
    advice: float  #: a fixed step that would lose less than a thousandth; infinite unless a step was given
    nfev: int  #: evaluations of the equations of motion
    coarse: bool  #: whether the step was warned of
    _asked: Asked
    _setting: float
    _extra: dict[str, Any]
    _phases: tuple[Phase, ...] | None = None

    @property
    def y(self) -> Floats:
        """(4, n): theta, w1, w2, w3."""
        return np.vstack([self.theta, self.w.T])

    @property
    def states(self) -> State:
        """The states as one `State` of arrays."""
        slip = self._extra.get("slip")
        pair = None if slip is None else (slip[:, 0], slip[:, 1])
        return State(self.theta, *(self.w[:, i] for i in range(3)), slip=pair)

    @property
    def energy(self) -> Floats:
        """(n,) kinetic and potential energy, in M g R; with `dissipated` it is constant."""
        energy: Floats = self.body.energy(self.states, self.contact)
        return energy

    @property
    def success(self) -> bool:
        """Whether the last time was reached."""
        return self.status == Ending.DONE

    @property
    def message(self) -> str:
        """How it ended and how it was got, in words."""
        why = MESSAGES[self.status][0]
        if self.event and self._phases == () and self.status == Ending.SIDE and self.event.state.w2 == 0:
            why = "the other rim does not rise"
        if self.event:
            why += f": the body {self._ends} at t = {self.event.time:.12g}"
        pose = "" if np.isnan(self.pose_error) else f", of the pose {self.pose_error:.1e}"
        errors = f"error about {self.error:.1e}{pose}"
        if self._phases is not None:
            return "; ".join(
                filter(None, (why, told(self._phases), how_found(self._phases, self._setting), errors))
            )
        how = {
            "exact": "by first integrals",
            "rk4": f"by RK4, step {self._asked.step!r}",
            "rk4 within tol": f"by RK4, steps within {self._setting:g}",
        }[self.method]
        free = self._asked.step is None and self._asked.tol is None
        if free and self.method != "exact":
            how += ", because the first integrals lose all their digits here"
        return f"{why}; found {how}, {errors}"

    @property
    def _ends(self) -> str:
        """What the body does where the motion ends: "slips"; a body wider than high stands, on its edge."""
        if self.status == Ending.SIDE and self.body.ell < 1:
            return "stands on its edge"
        return MESSAGES[self.status][1]

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

    # "contact"

    @property
    def normal(self) -> Floats:
        """(n,) normal force N per weight. Needs want="contact"."""
        return self._wanted("normal", "contact")

    @property
    def friction(self) -> Floats:
        """(n,) friction demand: size of the horizontal force per weight. Needs want="contact"."""
        return self._wanted("friction", "contact")

    @property
    def friction_coefficient(self) -> Floats:
        """(n,) the coefficient of friction that is needed; infinite where N <= 0. Needs "contact"."""
        return self._wanted("friction_coefficient", "contact")

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

    def to_xarray(self) -> "xarray.Dataset":
        """Everything that was wanted, labelled, with units; needs spincyl[sweep]."""
        from spincyl._labelled import labelled

        return labelled(self)

    def wanting(self, *want: str, t: Reals | None = None) -> "Motion":
        """The same motion with more of it, or at other times `t`, computed anew if it has to be."""
        have = self._asked.want
        if t is None and have >= set(want):
            return self
        asked = self._asked._replace(want=have | _choices(want))
        if t is not None:
            asked = asked._replace(times=_times(t))
        return _rolled(self.body, self.start, asked)  # what there is to warn of has been said

    def at(self, t: Reals) -> "Motion":
        """The same motion at other times: of the same start, found in the same way, with the same extras.

        Parameters
        ----------
        t : array_like, 1-D, or a number
            Times in sqrt(R/g), in order, on the clock of this motion, whose start keeps its time.

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
        return self.wanting(t=_times(t))

    def _wanted(self, name: str, want: str) -> Floats:
        if name not in self._extra:
            raise AttributeError(f'{name} was not asked for: roll(..., want="{want}")')
        found: Floats = self._extra[name]
        return found

    def _rubbed(self, what: str) -> Any:
        if what not in self._extra:
            raise AttributeError(_NO_FRICTION.format(what, named(self.contact)))
        return self._extra[what]

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
    want: str | Iterable[str] = (),
    beyond: bool = False,
    landing: float | None = None,
) -> Motion:
    """How a body moves on from a state.

    Parameters
    ----------
    body : Body
        A single one, ell at most 1e6, moments 1e-6 to 1e12.
    state : State
        Where it starts: theta in [1e-8, pi - 1e-8], speeds up to 1e6 sqrt(g/R).
    t : array_like, 1-D, or a number
        Times, in sqrt(R/g), at which it is wanted, in order; backward in time if they fall.
    t0 : float, optional
        Time of the start. Default: the first of `t`; 0 if `t` is a number.
    step : float, optional
        By RK4 with this fixed step, of either sign backward in time.
    tol : float, optional
        By RK4, each of whose steps errs by less than this (1e-14 to 0.1). The error at the end is
        said by `Motion.error`. With friction, the same of the steps of slipping; default 1e-14.
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
        friction_coefficient; "contact" is an old word for it). What is not asked for is not computed.
    beyond : bool
        Whether to go on beyond an event, where the model is no longer that of the body. The event is
        reported all the same. Beyond a landing of the face there is nothing.
    landing : None or 0.0
        With friction: whether a landing of the other rim ends the motion, or is plastic and it goes on. If it
        then stands on that rim, this counts as the lower one: theta is told from there, and phi turns by pi.

    Returns
    -------
    Motion
        At the times up to the first event: the face or the other rim lands, lift-off, slip.

    Raises
    ------
    ValueError
        Before any work: for a body, state, time, step, tolerance or mu out of range, by name; for a
        step at which fast precession or nutation would come out wrong unnoticed, with one that would do.
        With friction also on the way, where slipping and rolling follow each other over 10,000 times.
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
    single(body, state)
    times = _times(t)
    if t0 is not None:
        t0 = number("t0", t0)
    elif is_scalar(t):
        t0 = 0.0
    else:
        first = times.item(0)
        t0 = first if math.isfinite(first) else 0.0
    if beyond is not False and beyond is not True and not isinstance(beyond, np.bool_):
        raise TypeError(f"beyond: expected True or False, not {type(beyond).__name__}")
    if isinstance(contact, str):
        code(contact)
    elif not rubs(contact):
        raise TypeError(
            f"contact: expected 'rolling', 'smooth', Coulomb or Viscous, not {type(contact).__name__}"
        )
    if method not in (None, "exact", "rk4"):
        raise ValueError(f"method = {method!r}: expected 'exact' or 'rk4'")
    if step is not None and tol is not None:
        raise ValueError(f"step = {step!r} and tol = {tol!r}: give one of them")
    if method == "rk4" and step is None and tol is None:
        raise ValueError("method = 'rk4' needs step= or tol=, as in step=1e-3")
    if method == "exact" and (step is not None or tol is not None):
        raise ValueError("method = 'exact' takes neither step= nor tol=")
    step = None if step is None else number("step", step)
    tol = None if tol is None else number("tol", tol)
    mu = number("mu", mu)
    given = {"step": step, "method": method, "mu": None if mu == np.inf else mu, "beyond": beyond or None}
    check(state, contact, landing, {name: x for name, x in given.items() if x is not None})
    want = _choices(want)
    asked = Asked(times, t0, step, tol, method, contact, mu, bool(beyond), want, landing)
    m = _rolled(body, state, asked)
    if m.coarse:
        why = f"RK4 takes {100 * m.step_loss:.3g} % of the nutation's amplitude away"
        if m.step_loss <= 1e-3:
            why = "more than 0.3 rad of precession or 0.5 rad of nutation in a step"
        warnings.warn(f"step = {step!r}: {why}; {m.advice:.2e} would do, or tol=", StepWarning, stacklevel=2)
    return m


def _times(t: Reals) -> Floats:
    """Times as an array of one dimension, not empty."""
    times = reals("t", t)
    if np.ndim(times) > 1:
        raise ValueError(f"t: expected a number or one dimension, not shape {np.shape(times)}")
    found = floats(times).reshape(-1)
    if found.size == 0:
        raise ValueError("t: expected at least one time")
    return found


def _rolled(body: Body, state: State, asked: Asked) -> Motion:
    """The motion that was asked for, without a warning."""
    times, t0, step, tol, _, contact, mu, beyond, want, landing = asked
    pose, force = (name in want for name in _WANTS)
    if isinstance(contact, Coulomb | Viscous):
        how: dict[str, Any] = {"t0": t0, "times": times, "tol": tol, "landing": landing}
        found = slid(body, state, contact, pose=pose, force=force, **how)
    else:
        numbers = single(body, state)
        found = _core.roll(*numbers, t0, times, step, tol, code(contact), mu, beyond, pose, force)
    status = Ending(found["status"])
    event = None
    if "event" in found:
        time, y = found["event"]
        event = Event(status, time, slipping(y))
    y = found["y"]
    return Motion(
        body=body,
        start=state,
        contact=contact,
        t=found["t"],
        theta=np.ascontiguousarray(y[:, 0]),
        w=np.ascontiguousarray(y[:, 1:]),
        status=status,
        event=event,
        method=found["method"],
        error=found["error"],
        pose_error=found["pose_error"],
        step_loss=found["step_loss"],
        advice=found["advice"],
        nfev=found["nfev"],
        coarse=found["coarse"],
        _asked=asked,
        _setting=found["setting"],
        _extra={name: found[name] for name in (*_EXTRAS, *EXTRAS) if name in found},
        _phases=found.get("phases"),
    )


_EXTRAS = (
    "phi",
    "psi",
    "contact_point",
    "centre",
    "orientation",
    "normal",
    "friction",
    "friction_coefficient",
)


def _choices(want: str | Iterable[str]) -> frozenset[str]:
    if want == ():
        return frozenset()
    if not isinstance(want, Iterable):
        raise TypeError(f"want: expected 'pose', 'force' or both, not {type(want).__name__}")
    given = [want] if isinstance(want, str) else want
    wanted = frozenset("force" if name == "contact" else name for name in given)
    for name in wanted:
        if name not in _WANTS:
            raise ValueError(f"want = {name!r}: expected 'pose' or 'force'")
    return wanted
