"""The motion of a stone."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from spincyl import _core
from spincyl._asked import Asked, options_for_core
from spincyl._contact import AnyContact
from spincyl._ellipsoid import Ellipsoid
from spincyl._ellipsoid_state import EllipsoidState
from spincyl._ending import Event
from spincyl._input.numbers import Floats, components, instance_of
from spincyl._motion import ENDINGS, Motion, fixed_step
from spincyl._outputs import ALOFT, FRICTION, Number, output_in_units
from spincyl._phases import has_friction
from spincyl._reversals import reversal_times


class EllipsoidMotion(Motion):
    """Motion of a stone: times, states, and how the motion ended; the result of `roll` for an `Ellipsoid`.

    Attributes, optional outputs and units are the same as for `Motion`, with the largest semi-axis a in place
    of R. Differences: `theta` is the inclination of axis 3, and `w`, (n, 3), has components along the axes of
    the ellipsoid. There are no angles phi and psi; `orientation` gives the rotation of the stone. A stone
    touches the table at one point, so that there are no outputs of another rim, and `rim` is always 0. The
    impulses of `impacts` are along x, y and z of the laboratory. With `tol` above 1e-7 the error may be twice
    the estimated error. The errors of a stone that rattles grow fast; see `known_until`.
    """

    _axes = Motion._axes | {
        "vertical": ("axis", ["1", "2", "3"], ["n1", "n2", "n3"]),
        "w": ("axis", ["1", "2", "3"], ["w1", "w2", "w3"]),
        "slip": ("plan", ["x", "y"], ["slip_x", "slip_y"]),
    }
    _nods = False
    _turning = "spin"
    body: Ellipsoid  # type: ignore[assignment]
    start: EllipsoidState  # type: ignore[assignment]
    slip = Number(
        FRICTION,
        """(n, 2) velocity of the contact point over the table, sqrt(g a) or m/s.

        The components are along x and y of the laboratory, as described in `EllipsoidState`. In the air it is
        the horizontal velocity of the lowest point. Needs a law of friction or `restitution=`.
        """,
    )
    lift = Number(ALOFT, "(n,) upward velocity of the lowest point, sqrt(g a) or m/s. Needs `restitution=`.")

    @staticmethod
    def _begun(
        six: Sequence[float], slip: Sequence[float] | None, aloft: Sequence[float] | None = None
    ) -> EllipsoidState:
        height, lift = aloft or (None, None)
        return EllipsoidState(six[:3], six[3:], slip, height=height, lift=lift)

    @property
    def height(self) -> Floats:
        """(n,) height of the lowest point of the stone above the table, a or m. Needs `restitution=`."""
        return output_in_units(self, "height", ALOFT)

    @property
    def rim(self) -> NDArray[np.uint8]:
        """(n,) zeros: a stone has no rims."""
        return np.zeros(self.t.size, np.uint8)

    @property
    def vertical(self) -> Floats:
        """(n, 3) unit vector that points upward, along the axes of the ellipsoid."""
        found: Floats = self._extra["vertical"]
        return found

    @property
    def spin(self) -> Floats:
        """(n,) angular velocity about the vertical, sqrt(g/a) or rad/s; a rattleback reverses it."""
        found: Floats = _core.stone_spin(*components(self.vertical), *components(self.w))
        return found

    @cached_property
    def reversals(self) -> Floats:
        """Times at which the spin reverses, in sqrt(a/g) or s, up to `known_until`.

        A reversal counts if the spin passes zero and then reaches a tenth of the initial spin in the other
        direction, as in `sweep.roll`; its time is that of the last zero before, which does not depend on the
        times `t` of the motion. A spin that begins at zero has no reversals.
        """
        found = reversal_times(self.natural)  # type: ignore[arg-type]
        return found if self.scale is None else found * self.scale._units[1]

    @property
    def inclinations(self) -> Floats:
        """(n, 3) angles from the vertical to the axes of the ellipsoid, in radians."""
        return self.states.inclinations

    @property
    def known_until(self) -> float:
        """Time until which the motion is known, in the unit of `t`.

        This is the end of the motion, unless the estimated error becomes too large before: more than 1 % of
        the largest angular velocity, or more than 0.01 in natural units if the motion is slow. The motion is
        also unknown from the time at which the stone passes so close to an event that the error decides
        whether the event occurs; `error` is then infinite.
        """
        until: float | None = self.natural._known_until  # type: ignore[attr-defined]
        if until is None:
            return float(self._asked.times[-1]) if self.event is None else self.event.time
        return until if self.scale is None else float(self.scale.seconds(until))

    # set by the core if the motion is not known up to its end
    _known_until: float | None = None

    @property
    def _by_steps(self) -> bool:
        return True

    def _about(self) -> dict[str, Any]:
        return {"body": repr(self.body)}

    @property
    def _doubt(self) -> str:
        """Text such as "known to 1 % up to t = 5"; empty if the motion is known up to its end."""
        if self.natural._known_until is None:  # type: ignore[attr-defined]
            return ""
        second = "" if self.scale is None else " s"
        return f"known to 1 % up to t = {self.known_until:.6g}{second}"

    @property
    def states(self) -> EllipsoidState:  # type: ignore[override]
        """All states as one `EllipsoidState` of arrays, in natural units."""
        if self._natural is not None:
            return self._natural.states  # type: ignore[return-value]
        aloft = {name: self._extra.get(name) for name in ("height", "lift")}
        return EllipsoidState(self.vertical, self.w, self._extra.get("slip"), **aloft)

    @property
    def y(self) -> Floats:
        """(6, n) array with the rows n1, n2, n3 (`vertical`) and w1, w2, w3."""
        return np.vstack([self.vertical.T, self.w.T])

    def _again(self, asked: Asked) -> "EllipsoidMotion":
        return rolled_stone(self.body, self.start, asked)

    def _angle(self, name: str) -> Floats:
        raise AttributeError(f"{name}: only for bodies of revolution; for a stone use orientation")


def start_of_stone(state: Any, contact: AnyContact, step: object, method: object, restitution: object) -> Any:
    """Return the initial state of a stone, without its `slip` if the contact has no law of friction.

    Raises an error for `step` and `method`, which only bodies of revolution have.
    """
    instance_of("state", state, EllipsoidState)
    slides = has_friction(contact) or (restitution is not None and state.height is not None)
    if not slides and state._slips:
        why = f"contact={contact!r} has no law of friction; give contact=sc.Coulomb(mu)"
        raise ValueError(f"state: the stone slips, slip = {state.slip!r}; {why}")
    if step is not None or method is not None:
        raise ValueError(
            "step, method: only for bodies of revolution; for a stone leave them out, or give tol="
        )
    return state if slides else replace(state, slip=None)


def rolled_stone(body: Ellipsoid, state: EllipsoidState, asked: Asked) -> EllipsoidMotion:
    """Compute the motion of a stone in natural units from checked arguments."""
    n, w, slip, high = (np.asarray(x) for x in (state.vertical, state.w, state._pair, sum(state._aloft)))
    if not n.ndim == w.ndim == slip.ndim == high.ndim + 1 == 1:
        raise ValueError("state: expected a single state; use spincyl.sweep.roll for a family")
    start, own = [*n.tolist(), *w.tolist()], None if state.slip is None else slip.tolist()
    aloft = None if state.height is None else [float(x) for x in state._aloft]
    numbers, times = body._numbers, asked.times
    found: dict[str, Any] = _core.roll(numbers, start, times, options_for_core(asked, own, aloft))
    status = ENDINGS[found["status"]]
    event = None
    if "event" in found:
        time, six, pair, _ = found["event"]
        event = Event(status, time, EllipsoidMotion._begun(six, pair))  # type: ignore[arg-type]
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
    m = object.__new__(EllipsoidMotion)
    object.__setattr__(m, "__dict__", found)
    return m
