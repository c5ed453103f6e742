"""The state of a body: four numbers, six with a slip, or arrays of them."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from spincyl import _core
from spincyl._input.equality import compared_by_value
from spincyl._input.hints import HintingFamily
from spincyl._input.numbers import (
    Reals,
    Result,
    common_shape,
    elementwise,
    instance_of,
    is_scalar,
    radians,
    radians_per_second,
    read_only_copy,
    reals,
    si,
)
from spincyl._input.reprs import is_lazy, repr_of_call, repr_of_numbers
from spincyl._scale import Scale, scale_of
from spincyl._upward import function_of_method

if TYPE_CHECKING:
    from spincyl._body import Body


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class State(HintingFamily):
    """Inclination and angular velocity of a body, in natural units, also for a measured body.

    Components are along axes that follow the inclination and the precession, but not the spin. e3 is the
    symmetry axis, e2 is horizontal, and the vertical is z = sin(theta) e1 + cos(theta) e3. Fields may be
    arrays, which broadcast. Source: Jackson et al., Am. J. Phys. 87, 85 (2019), Sec. II.

    Parameters
    ----------
    theta : array_like
        Inclination in radians: angle from the vertical to the symmetry axis.
    w1, w2, w3 : array_like
        Angular velocity along e1, e2, e3, in sqrt(g/R): w1 = phi' sin(theta), w2 = -theta',
        w3 = phi' cos(theta) + psi', with the precession phi' and the spin psi'.
    slip : pair of array_like, optional
        Velocity of the contact point over the table, in sqrt(g R). Its first component is along the
        horizontal vector e_h = cos(theta) e1 - sin(theta) e3, the second along e2. Default: no slip, the body
        rolls. `Body.with_centre_velocity` computes the slip from the velocity of the centre.
    height, lift : array_like, optional
        For a body in the air: height of the lowest point of its rim above the table, in R, and the upward
        velocity of that point, in sqrt(g R). If you give only one, the other is 0. `dropped` computes both.

    Raises
    ------
    TypeError
        If a field is not real-valued, or the slip is not a pair; the message names the field.
    """

    _of_motion: ClassVar[str] = "m.at(t) has theta, w and all else of a motion m at the time t"

    theta: Reals
    w1: Reals
    w2: Reals
    w3: Reals
    slip: tuple[Reals, Reals] | None = field(default=None, kw_only=True)
    height: Reals | None = field(default=None, kw_only=True)
    lift: Reals | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "theta", read_only_copy(radians("theta", self.theta, "0 < theta <= pi")))
        for name in ("w1", "w2", "w3"):
            object.__setattr__(self, name, read_only_copy(reals(name, getattr(self, name))))
        if not is_scalar(*self._numbers):
            common_shape(dict(zip(("theta", "w1", "w2", "w3"), self._numbers, strict=True)))
        if self.height is not None or self.lift is not None:
            for name in ("height", "lift"):
                value = getattr(self, name)
                object.__setattr__(self, name, read_only_copy(reals(name, 0.0 if value is None else value)))
        if self.slip is None:
            return
        pair = isinstance(self.slip, tuple | list) or (isinstance(self.slip, np.ndarray) and self.slip.ndim)
        if not pair or len(self.slip) != 2:
            what = type(self.slip).__name__
            raise TypeError(f"slip: expected a pair (along e_h, along e2), not {what} {self.slip!r}")
        along, across = self.slip
        object.__setattr__(
            self, "slip", (read_only_copy(reals("slip[0]", along)), read_only_copy(reals("slip[1]", across)))
        )
        fields = dict(zip(("theta", "w1", "w2", "w3"), self._numbers, strict=True))
        if not is_scalar(*self._slip):
            common_shape(fields | dict(zip(("slip[0]", "slip[1]"), self._slip, strict=True)))

    @classmethod
    @elementwise
    def from_si(
        cls,
        theta: Reals,
        w1: Reals,
        w2: Reals,
        w3: Reals,
        *,
        slip: tuple[Reals, Reals] | None = None,
        height: Reals | None = None,
        lift: Reals | None = None,
        scale: "Scale | Body",
    ) -> "State":
        """State from w1, w2, w3 in rad/s, `slip` and `lift` in m/s, and `height` in m.

        `scale` is a measured body, or its `Scale`.
        """
        metre, second, *_ = scale_of(scale)._units
        given = (("w1", w1), ("w2", w2), ("w3", w3))
        w = (reals(name, radians_per_second(name, x)) * second for name, x in given)
        if isinstance(slip, tuple | list):
            slip = tuple(si("slip", x, "metre/second") for x in slip)
        height, lift = si("height", height, "metre"), si("lift", lift, "metre/second")
        found = cls(theta, *w, slip=slip, height=height, lift=lift)
        if found.height is not None and found.lift is not None:
            found = replace(found, height=found.height / metre, lift=found.lift * (second / metre))
        along, across = (x * (second / metre) for x in found._slip)
        return found if slip is None else replace(found, slip=(along, across))

    @elementwise
    def in_si(self, scale: "Scale | Body") -> dict[str, Any]:
        """Return the arguments of `from_si` as a dict: theta, w1, w2, w3; also slip, height, lift."""
        metre, second, *_ = scale_of(scale)._units
        found = {name: getattr(self, name) / second for name in ("w1", "w2", "w3")}
        slip = None if self.slip is None else tuple(x * (metre / second) for x in self.slip)
        if self.height is not None and self.lift is not None:
            found |= {"height": self.height * metre, "lift": self.lift * (metre / second)}
        return {"theta": self.theta} | found | ({} if slip is None else {"slip": slip})

    @elementwise
    def kicked(self, thetadot: Reals) -> "State":
        """Return the state with `thetadot`, in sqrt(g/R), added to theta'; the slip does not change."""
        w2 = self.w2 - reals("thetadot", thetadot)
        if type(w2) is not float:
            return replace(self, w2=w2)
        # the other fields have been checked, and a number fits all of them
        return state_without_checks((self.theta, self.w1, w2, self.w3), self.slip, self.height, self.lift)

    @property
    def precession(self) -> Result:
        """Precession phi': rate of rotation about the vertical, in sqrt(g/R)."""
        return _core.precession(*self._numbers)

    @property
    def spin(self) -> Result:
        """Spin psi': rate of rotation about the body's own axis, in sqrt(g/R)."""
        return _core.spin(*self._numbers)

    @property
    def angular_velocity(self) -> Result:
        """Magnitude of the angular velocity, in sqrt(g/R)."""
        return _core.angular_velocity(*self._numbers)

    @property
    def gamma(self) -> Result:
        """Angle from the symmetry axis to the angular velocity, in radians."""
        return _core.gamma(*self._numbers)

    @property
    def contact_radius(self) -> Result:
        """Radius of the contact point's circle on the table, over the radius of its circle on the body.

        On a body with a sharp rim the circle on the body has the radius R. If the centre is at rest, the
        ratio is also the number of times that the symbol on the rim is seen standing still in one turn.
        """
        return _core.contact_radius(*self._numbers)

    def __repr__(self) -> str:
        four = {"theta": self.theta, "w1": self.w1, "w2": self.w2, "w3": self.w3}
        more = {name: getattr(self, name) for name in ("slip", "height", "lift")}
        return repr_of_call("State", **four, **{name: x for name, x in more.items() if x is not None})

    def _repr_html_(self) -> str:
        return str(function_of_method("card")(self))

    @property
    def _numbers(self) -> tuple[Reals, Reals, Reals, Reals]:
        return self.theta, self.w1, self.w2, self.w3

    @property
    def _slip(self) -> tuple[Reals, Reals]:
        return (0.0, 0.0) if self.slip is None else self.slip

    @property
    def _slips(self) -> bool:
        """Whether the state has a slip that is not zero, or that is lazy and may not be."""
        return self.slip is not None and any(is_lazy(x) or bool(np.any(x != 0)) for x in self.slip)


def state_without_checks(
    four: Iterable[Reals],
    slip: tuple[Reals, Reals] | None = None,
    height: Reals | None = None,
    lift: Reals | None = None,
) -> State:
    """Make a state from numbers known to be valid; checks would take longer than computing a short motion."""
    found = object.__new__(State)
    theta, w1, w2, w3 = four
    found.__dict__.update(theta=theta, w1=w1, w2=w2, w3=w3, slip=slip, height=height, lift=lift)
    return found


def numbers(state: object) -> tuple[Reals, Reals, Reals, Reals]:
    """The inclination, w1, w2, w3 of a state, without its slip; TypeError for anything else."""
    return instance_of("state", state, State)._numbers


def refuse_state_in_air(state: Any, remedy: str) -> None:
    """Raise ValueError for a state in the air; the message ends with `remedy`, which says what to do."""
    if state.height is not None:
        raise ValueError(f"state: the body is in the air, height = {repr_of_numbers(state.height)}: {remedy}")


def numbers_without_slip(state: object, why: str) -> tuple[Reals, Reals, Reals, Reals]:
    """theta, w1, w2, w3 of a state on the table; for a state with slip a ValueError that ends with `why`."""
    found = numbers(state)
    if isinstance(state, State) and state._slips:
        raise ValueError(f"state: the body slips, slip = {repr_of_numbers(state._slip)}: {why}")
    if isinstance(state, State):
        refuse_state_in_air(state, "expected a body on the table")
    return found
