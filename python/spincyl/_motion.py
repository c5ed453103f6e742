"""The motion of a body from an initial state."""

from bisect import bisect_left
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spincyl import _core
from spincyl._asked import NO_OUTPUTS, Asked, Want, options_for_core, times_of, union_of_wants
from spincyl._body import Body
from spincyl._circles import circles_at
from spincyl._contact import AnyContact, Coulomb
from spincyl._ending import LARGE_ERROR, Ending, Event, FixedStep, RestsOn
from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import Floats, Reals, si
from spincyl._labelled import AXES, Components, frame, labelled
from spincyl._measured import errors_in_seconds, in_si, natural_time, output_in_si
from spincyl._outputs import ALOFT, FRICTION, POSE, Outputs, missing_output, output_in_units
from spincyl._phases import (
    KINDS,
    LOST_COLUMN,
    RIMS,
    Impact,
    Phase,
    impacts,
    lowest_point_height,
    phases,
    state_of_phase,
    told_phases,
)
from spincyl._scale import Scale
from spincyl._showing import Showing
from spincyl._slip import told_of_lowest
from spincyl._state import State
from spincyl._swing import numbers_of_one, single_aloft, single_slip
from spincyl._told import message
from spincyl._upward import function_of_method

if TYPE_CHECKING:
    import pandas
    import xarray

    from spincyl._loss import Loss


_Six: TypeAlias = tuple[float, float, float, float, float, float]
_Four: TypeAlias = tuple[float, float, float, float]


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Motion(Outputs, Showing):
    """Motion of a body: times, states, and how the motion ended; the result of `roll`.

    The object is similar to the result of SciPy's `solve_ivp`. Arrays have a row for each of the n times that
    the motion reached. Outputs are in natural units; for a measured body they are in SI: times in s, w in
    rad/s, lengths in m, `slip` in m/s, forces in N, energies in J. "R or m" below names the natural unit and
    the unit for a measured body. Each `State` is always in natural units: `start`, `states`, and the states
    of `event` and `phases`. `natural` is the whole motion in natural units.

    An optional output that was not computed raises AttributeError; the message says how to get it.

    Attributes
    ----------
    body, start, contact : Body, State, str or Coulomb or Viscous
        Arguments of `roll`; `start` is its argument `state`, the initial state.
    t, theta, w : ndarray
        Times, (n,), in sqrt(R/g) or s. Inclination, (n,), in radians. Angular velocity along e1, e2, e3 of
        `State`, (n, 3), in sqrt(g/R) or rad/s.
    status : Ending
        How the motion ended: 0 (`Ending.DONE`) if the motion reached the last time; see also `success`.
    event : Event or None
        The event that ended the motion: its `ending`, `time` and `state`.
    method : str
        "exact", "rk4" (a fixed step) or "dop853" (steps of eighth order within a tolerance; always used with
        friction or losses).
    error : float
        Estimated absolute error: the largest error of theta, w1, w2 and w3 at any time, and of the time of
        the event. For a measured body this number bounds the errors in rad, in rad/s and in s.
    pose_error : float
        Estimated error of phi and psi (radians) and of the contact point (R or m); NaN without want="pose".
    force_error : float
        Estimated error of the normal force and of the two components of the friction along e_h and e2 (M g or
        N), to first order in the errors of the state; NaN without want="force". The directions of e_h and e2
        in the laboratory have the error `pose_error`.
    rk4 : FixedStep or None
        What a fixed step does: the fraction of the nutation's amplitude that it damps (`loss`), a recommended
        step (`advice`), and whether `StepWarning` was issued (`coarse`). None unless `step` was given.
    nfev : int
        Number of evaluations of the equations of motion; 0 for an exact motion.
    """

    body: Body
    start: State
    contact: AnyContact
    t: Floats
    theta: Floats
    w: Floats
    status: Ending
    event: Event | None
    method: str
    error: float
    pose_error: float
    force_error: float
    rk4: FixedStep | None
    nfev: int
    _asked: Asked
    _setting: float
    _extra: dict[str, Any]
    _rests: int = 0
    _phases: Floats | None = None  # a row for each phase and each impact
    _impacts: Floats | None = None
    _natural: "Motion | None" = None  # for a motion in SI: the same in natural units
    _limit: tuple[str, str] | None = None  # name and reason of the limit at which the computation stopped
    _axes: ClassVar[Components] = AXES
    _nods: ClassVar[bool] = True  # whether first integrals give a nutation, as for a body of revolution
    _turning: ClassVar[str] = "phi"  # the output that tells how the body turns about the vertical
    _begun: ClassVar[Callable[..., Any]] = staticmethod(state_of_phase)  # makes the state of a phase

    @property
    def scale(self) -> Scale | None:
        """Scale of a measured body, whose motion is in SI; None if the motion is in natural units."""
        return self.body.scale

    @property
    def natural(self) -> "Motion":
        """The same motion in natural units."""
        return self if self._natural is None else self._natural

    @property
    def y(self) -> Floats:
        """(4, n) array with the rows theta, w1, w2, w3."""
        return np.vstack([self.theta, self.w.T])

    @property
    def states(self) -> State:
        """All states as one `State` of arrays, in natural units."""
        if self._natural is not None:
            return self._natural.states
        found = self._seen
        if found.lift is None or getattr(self.body, "rims", None) is None:
            return found
        return told_of_lowest(self.body, found, self.rim, self.phase == KINDS.index("flying"))

    @property
    def _seen(self) -> State:
        """`states`, but in the air with slip, height and lift of the circle that `rim` names."""
        if self._natural is not None:
            return self._natural._seen
        slip = self._extra.get("slip")
        pair = None if slip is None else (slip[:, 0], slip[:, 1])
        aloft = {name: self._extra.get(name) for name in ("height", "lift")}
        return State(self.theta, *(self.w[:, i] for i in range(3)), slip=pair, **aloft)

    @property
    def energy(self) -> Floats:
        """(n,) kinetic plus potential energy, M g R or J.

        The sum of `energy`, `dissipated`, `lost_in_impacts` and `work_lost` is constant.
        """
        free = self.contact == "smooth" and self._phases is not None
        contact = Coulomb(0.0) if free else self.contact
        one = getattr(self.body, "rims", None) is None
        told = (self.states, contact) if one else (self._seen, contact, self.rim)
        found = (self.body.energy if one else self.body._energy)(*told)
        return self._told("energy", found + self._extra.get("beside", 0.0))

    @property
    def height(self) -> Floats:
        """(n,) height of the lowest point of the body above the table, R or m. Needs `restitution=`."""
        rim = output_in_units(self.natural, "height", ALOFT)
        return self._told("height", lowest_point_height(self.body, self.theta, rim, self.rim))

    @property
    def rim(self) -> NDArray[np.uint8]:
        """(n,) code of the rim to which theta and w refer at each time: 0 the first rim, 1 the other one.

        For a body of several circles it is the number of the circle in `Body.circles` that carries the body
        or did so before a flight; on two circles the lower one. Theta, w, phi, psi then do not depend on it.

        The first rim is that of the initial state. Theta, w, phi, psi, the contact point, `slip`, `normal`
        and `friction` refer to this rim; `centre` and `orientation` do not depend on it. Always 0 without
        `restitution=`, and while both rims touch the table.
        """
        found = self._extra.get("rim")
        return circles_at(self.body, self.theta) if found is None else found

    @property
    def axis_up(self) -> Floats:
        """(n,) cosine of the angle from the vertical to the body's axis, which points out of its first rim.

        1 if the body lies on its first face (heads), -1 if it lies on the other one (tails), 0 on its side.
        The first face of a body of several circles is that at its lower end, so that this is cos theta.
        """
        up: Floats = _core.axis_up(self.theta, self.rim if self.body.rims is None else 0)
        return up

    @property
    def rests_on(self) -> RestsOn:
        """Part on which the body rests at the end of the motion; `RestsOn.NONE` if it is not at rest."""
        return RestsOn(self._rests)

    @property
    def success(self) -> bool:
        """Whether the motion reached the last time."""
        return self.status == Ending.DONE

    @property
    def message(self) -> str:
        """Text about the motion: how it ended, how it was computed, and its estimated errors."""
        return message(self)

    @property
    def known_until(self) -> float:
        """Time until which the motion is known, in the unit of `t`.

        Up to this time the estimated error is at most 0.1 in natural units; a larger one gives an
        `ErrorWarning`. Impacts multiply errors. The time is the end of the motion if `error` is at most 0.1,
        and NaN if `error` is NaN. Otherwise it is computed from a dozen shorter motions, to 1 % of the time
        since the initial state.
        """
        if self._natural is not None and self.scale is not None:
            return float(self.scale.seconds(self._natural.known_until))
        t0, end = self._asked.t0, float(self._asked.times[-1] if self.event is None else self.event.time)
        if not self.error > LARGE_ERROR:
            return end if self.error <= LARGE_ERROR else np.nan
        marks = t0 + (end - t0) * np.r_[0.0, np.geomspace(1e-9, 1.0, 2048)]

        def unknown(count: int) -> bool:
            asked = self._asked._replace(times=marks[:count], want=NO_OUTPUTS)
            return not self._again(asked).error <= LARGE_ERROR

        return float(marks[bisect_left(range(2, marks.size), True, key=unknown)])

    @property
    def phi(self) -> Floats:
        """(n,) precession angle phi, in radians, 0 in the initial state. Needs want="pose"."""
        return self._angle("phi")

    @property
    def psi(self) -> Floats:
        """(n,) spin angle psi, in radians, 0 in the initial state. Needs want="pose"."""
        return self._angle("psi")

    @property
    def turns(self) -> tuple[Floats, Floats]:
        """Phi and psi, each as an array (n, 2) of whole turns and remaining angle. Needs want="pose".

        The remaining angle is in radians, and keeps its digits after any number of turns.
        """
        return output_in_units(self, "phi", POSE), output_in_units(self, "psi", POSE)

    @cached_property
    def impacts(self) -> tuple[Impact, ...]:
        """All impacts on the table. Needs `restitution=`.

        An infinite sequence of bounces that is summed counts as one impact.
        """
        if self._impacts is None:
            raise missing_output(self, "impacts", ALOFT)
        return impacts(self._impacts, self._begun)

    @property
    def lost_in_impacts(self) -> Floats:
        """(n,) energy lost in impacts and their friction since the start, M g R or J. Needs restitution."""
        of = self.natural._impacts
        if of is None:
            raise missing_output(self, "impacts", ALOFT)
        lost = np.cumsum([0.0, *of[:, LOST_COLUMN]])
        return self._told("energy", lost[np.searchsorted(of[:, 0], self.natural.t)])

    @cached_property
    def phases(self) -> tuple[Phase, ...]:
        """Phases of the motion, each with the time, kind and state with which it begins.

        Needs a law of friction or `restitution=`. The tuple is empty if the motion ends at its
        initial state: if a body on its side stays lying, or lifts off.
        """
        if self._phases is None:
            raise missing_output(self, "phases", FRICTION)
        found = phases(self._phases, self._begun)
        return found if getattr(self.body, "rims", None) is None else told_phases(self.body, found)

    @property
    def losses(self) -> "Loss | None":
        """The `losses` given to `roll`, or None. Sliding friction is not one of these loss laws."""
        return self._asked.losses

    def to_xarray(self) -> "xarray.Dataset":
        """All computed outputs as a labelled dataset with units; needs spincyl[sweep]."""
        return labelled(self)

    def to_dataframe(self) -> "pandas.DataFrame":
        """All computed outputs as a table indexed by time; needs spincyl[sweep].

        Each component of a vector has its own column. ``attrs["units"]`` has the unit of each column and of
        the index.
        """
        return frame(self)

    def wanting(self, *want: Want | Iterable[Want], t: Reals | None = None) -> "Motion":
        """The same motion with further outputs, or at other times `t`; computed again if necessary.

        Each argument `want` is "pose", "force", or a list of both, as in `roll`. Outputs that this motion
        already has are kept.
        """
        more = union_of_wants(want)
        if self._natural is not None:
            scale: Any = self.body.scale
            seconds = self._asked.times if t is None else times_of(si("t", t, "second"))
            with errors_in_seconds(scale, self.body._length):
                of = self._natural.wanting(more, t=None if t is None else natural_time("t", seconds, scale))
            return self if of is self._natural else in_si(of, self.body, seconds, self._asked.step)
        have = self._asked.want
        if t is None and have >= more:
            return self
        asked = self._asked._replace(want=have | more)
        if t is not None:
            asked = asked._replace(times=times_of(t))
        return self._again(asked)  # warnings were issued for the first computation

    def at(self, t: Reals) -> "Motion":
        """The same motion at other times, with the same initial state, method and optional outputs.

        Parameters
        ----------
        t : array_like, 1-D, or a number
            Times as in `roll`, in sqrt(R/g), or in seconds for a measured body. The time of the initial state
            does not change.

        Returns
        -------
        Motion
            States at these times, up to the first event.

        Raises
        ------
        ValueError, TypeError
            If `t` is invalid, as in `roll`.

        Examples
        --------
        >>> import spincyl as sc
        >>> body = sc.Body.solid(2.5)
        >>> m = sc.roll(body, body.steady(1.3).kicked(0.05), 20.0)
        >>> m.at([0.0, 10.0]).theta.round(4).tolist()
        [1.3, 1.3203]
        """
        return self.wanting(t=times_of(t if self._natural is None else si("t", t, "second")))

    def _told(self, name: str, values: Floats) -> Floats:
        """Convert an output from natural units to those of the motion."""
        found: Floats = values if self._natural is None else output_in_si(name, values, self.scale)
        return found

    def _angle(self, name: str) -> Floats:
        turns, rest = output_in_units(self, name, POSE).T
        angle: Floats = 2 * np.pi * turns + rest
        return angle

    # Motions of other kinds of bodies override these.

    def _again(self, asked: Asked) -> "Motion":
        """Compute the motion of the same body from the same initial state with other arguments."""
        return rolled(self.body, self.start, asked)

    @property
    def _by_steps(self) -> bool:
        """Whether the whole motion was integrated with steps within a tolerance."""
        return self.losses is not None or "beside" in self._extra

    @property
    def _doubt(self) -> str:
        """Text such as "known to 1 % up to t = 5"; empty if the motion is known up to its end."""
        return ""

    def _about(self) -> dict[str, Any]:
        """The fields ell, i1, i3 of the body, as attributes of a labelled result."""
        return {name: getattr(self.body, name) for name in ("ell", "i1", "i3")}

    def _repr_html_(self) -> str:
        return str(function_of_method("card")(self))

    def __repr__(self) -> str:
        wanted = "".join(f", {name}" for name in self._extra)
        return f"<Motion of {self.body!r}: {self.t.size} times, theta, w{wanted}; {self.message}>"


def rolled(body: Body, state: State, asked: Asked, numbers: tuple[_Six, _Four] | None = None) -> Motion:
    """Compute a motion without warnings; `numbers` are those of body and state, if already known."""
    of, start = numbers or numbers_of_one(body, state, several=True)
    slip, aloft = None if state.slip is None else single_slip(state), single_aloft(state)
    found = _core.roll(of, start, asked.times, options_for_core(asked, slip, aloft, body._rows))
    status = ENDINGS[found["status"]]
    event = None
    if "event" in found:
        time, four, slipped, rim = found["event"]
        event = Event(status, time, state_of_phase(four, slipped), RIMS[rim])
    # the core's names are those of the fields: setting frozen fields one by one takes longer than a motion
    found |= {
        "body": body,
        "start": state,
        "contact": asked.contact,
        "status": status,
        "event": event,
        "rk4": fixed_step(found),
        "_asked": asked,
        "_impacts": found.get("_impacts") if asked.restitution is not None else None,
    }
    m = object.__new__(Motion)
    object.__setattr__(m, "__dict__", found)
    return m


def fixed_step(found: dict[str, Any]) -> FixedStep | None:
    """The `Motion.rk4` of a motion, from the results of the core; None for a motion without a fixed step."""
    numbers = FixedStep(found.pop("step_loss"), found.pop("advice"), found.pop("coarse"))
    return numbers if found["method"] == "rk4" else None


ENDINGS = {int(ending): ending for ending in Ending}
