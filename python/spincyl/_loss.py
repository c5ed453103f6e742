"""The base of the loss laws, each with one positive coefficient, and sums of laws."""

import re
import warnings
from collections.abc import Hashable
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, NamedTuple, Self, TypeVar

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._input.equality import equality_key
from spincyl._input.hints import Hinting
from spincyl._input.numbers import (
    Reals,
    Result,
    elementwise,
    instance_of,
    is_scalar,
    numbered,
    read_only_copy,
    reals,
    refuse_bad_value,
    si,
)
from spincyl._input.reprs import repr_of_call
from spincyl._scale import Scale, refuse_other_scale, scale_of
from spincyl._state import State, numbers


class LossRow(NamedTuple):
    """What the compiled core knows of a loss law: its coefficient, its units, and where it acts."""

    parameter: str  #: the name of the coefficient
    exponent: float | None  #: n: theta of a thin disk falls as (remaining time)^n
    measures: str  #: what the unit of the coefficient measures, such as a length
    natural: str
    si: str
    printed: str  #: the unit in which the coefficient is printed; a text with it is what `from_si` takes
    exponents: tuple[float, float, float]  #: of metre, second and joule in the unit
    in_air: bool  #: whether the law acts on a body in the air
    couple: str  #: in the file of a scene, with a coefficient in SI; `studio/scene_data.py` has the symbols


#: The loss laws by the names of their coefficients, in the order of the core.
LAWS = {row["parameter"]: LossRow(**row) for row in _core.loss_laws()}
_MOST = 1e6
#: End of the repr of a law that does not act while the contact point slips.
_ONLY_ROLLING = ", while_slipping=False"
_Kind = TypeVar("_Kind", bound="Law")
_EXPECTED = "expected a positive number: a loss takes energy"


class Loss(Hinting):
    """A loss law, or a sum of loss laws: a couple on the body that takes energy from its motion."""

    __array_ufunc__ = None  # so that NumPy does not add the law to each element of an array
    #: The function of a law that a user wrote.
    _function: ClassVar[Any] = None
    _drives: ClassVar[bool] = False  # whether `_function` is that of a `custom.Drive`

    @property
    def laws(self) -> "tuple[Law, ...]":
        """The laws of the sum, each once, in the order in which they were added."""
        raise NotImplementedError

    @property
    def _built_in(self) -> "Loss | None":
        """The sum without a law that the user wrote: the laws of the library; None if there are none."""
        return self

    @property
    def _coefficients(self) -> list[Reals]:
        """The coefficient of each law in the order of the core; 0 for absent laws."""
        own = {law._parameter: law.coefficient for law in self.laws}
        return [own.get(name, 0.0) for name in LAWS]

    @property
    def _acts_in_slip(self) -> bool:
        """Whether all of the laws act while the contact point slips, too."""
        laws = self._built_in
        return laws is None or all(law._acts_in_slip for law in laws.laws)

    def _natural(self, scale: Scale | None) -> "Loss":
        """The law with coefficients in the natural units of a body with this scale."""
        return self

    @elementwise
    def power(self, body: Body, state: State, normal: Reals = 1.0) -> Result:
        """Power that the law takes from a body in a state, in M g R sqrt(g/R).

        With the couple m and the angular velocity w it is P = -m.w >= 0, and the energy falls as dE/dt = -P.

        Parameters
        ----------
        body : Body
            Body or family.
        state : State
            Single state or array of states. The slip has no effect, since sliding friction is not part of the
            loss laws.
        normal : array_like
            Normal force N in M g; dry laws are proportional to it. N is 1 in a steady state, and
            `Motion.normal` in a motion.

        Returns
        -------
        float or array
            Broadcast shape of body, state, normal force and coefficients; NaN where an element of an array is
            an impossible body or coefficient. Error: a few roundings.
        """
        return _core.loss_power(*self._given(body, state, normal))

    @elementwise
    def couple(self, body: Body, state: State, normal: Reals = 1.0) -> Result:
        """Couple m on the body, in M g R, with components along e1, e2, e3 of `State`.

        Parameters, shape and errors are those of `power`. The components are on a further last axis of length
        3 (xarray: dimension "axis"). If a rotation has stopped, dry friction sets only the largest couple
        that can hold it; the couple returned is then 0.
        """
        found = _core.loss_couple(*numbered(3, *self._given(body, state, normal), name="axis"))
        if body.rims is None:
            return found
        sign = body._sign(state.theta)  # of e2 and e3, seen from the end that is nearer to the table
        return found * np.stack([np.ones(np.shape(sign)), sign, sign], axis=-1)

    def _given(self, body: Body, state: State, normal: Reals) -> tuple[Reals, ...]:
        instance_of("body", body, Body)
        return *self._coefficients, reals("normal", normal), *body._at(*numbers(state))

    def __add__(self, other: "Loss") -> "Loss":
        if not isinstance(other, Loss) or other._function is not None:
            return NotImplemented  # `custom.Couple` adds itself
        return _sum_of((*self.laws, *other.laws))

    def __str__(self) -> str:
        return losses_in_words(self) if is_scalar(*self._coefficients) else repr(self)

    def __radd__(self, other: int) -> "Loss":
        return self if type(other) is int and other == 0 else NotImplemented  # sum() starts with 0

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Loss) or other._function is not None:  # `custom.Couple` compares functions
            return NotImplemented
        return self._compared_by == other._compared_by

    def __hash__(self) -> int:
        return hash(self._compared_by)

    @property
    def _compared_by(self) -> tuple[Hashable, bool]:
        return equality_key(self._coefficients), self._acts_in_slip


class Law(Loss):
    """Base class of the loss laws, each of which has one coefficient."""

    #: False for a coefficient in natural units; True, or the scale, if it was given in SI.
    _sized: "Scale | bool" = False
    #: On the command line: a coefficient in natural units, one in SI, and the law in words.
    _example: ClassVar[tuple[str, str, str]]

    def __init__(self, coefficient: Reals) -> None:
        raise TypeError(
            "Law(coefficient) is only a base class: use one of the laws, such as sc.loss.DryContour(1e-3)"
        )

    def __post_init__(self) -> None:
        name, value = self._parameter, self.coefficient
        if isinstance(value, str):
            unit = f"{type(self).__name__}.from_si({value!r}, scale=body)"
            raise TypeError(
                f"{name}: expected real numbers, not {value!r}; for a number with a unit use {unit}"
            )
        found = positive_coefficient(name, value)
        refuse_bad_value(name, found, lambda x: x > _MOST, f"expected at most {_MOST:g}")
        object.__setattr__(self, name, read_only_copy(found))

    @property
    def _parameter(self) -> str:
        """The name of the coefficient, such as "eps"."""
        return fields(self)[0].name  # type: ignore[arg-type]

    @property
    def _acts_in_slip(self) -> bool:
        return True

    def _with(self, coefficient: Reals) -> Self:
        """The same law with another coefficient, in natural units."""
        return replace(self, **{self._parameter: coefficient})  # type: ignore[type-var]

    @property
    def _row(self) -> LossRow:
        return LAWS[self._parameter]

    @property
    def coefficient(self) -> Reals:
        """Coefficient of the law, in natural units; its name and unit are those of the law's parameter."""
        return getattr(self, self._parameter)

    def in_si(self, scale: "Scale | Body") -> Reals:
        """Coefficient in SI, in the unit of `from_si`, for a measured body or its `Scale`."""
        small = 2.0**-40  # no law warns of so small a coefficient
        law = type(self).from_si(small, scale=scale)  # type: ignore[attr-defined]
        return self.coefficient / law.coefficient * small

    def _printed(self, scale: "Scale | bool | None") -> tuple[float, str]:
        """The factor from the coefficient to the printed number, and its unit, which `from_si` reads.

        Natural units if the size is unknown, or if the law needs the mass and it is unknown.
        """
        unit = self._row.printed
        if not isinstance(scale, Scale) or not (unit == "mm" or scale._is_weighed):
            return 1.0, ""
        with warnings.catch_warnings(action="ignore"):  # a mass of 1 kg is as good as any
            return (1e3 if unit == "mm" else 1.0) * self.in_si(scale) / self.coefficient, f" {unit}"

    @property
    def exponent(self) -> float | None:
        """Exponent n: theta of a thin disk falls as (remaining time)^n. None if the disk never stops."""
        return self._row.exponent

    @property
    def laws(self) -> "tuple[Law, ...]":
        """The laws in this object as a tuple: only this law itself; for a sum each of its laws."""
        return (self,)

    def __repr__(self) -> str:
        found = repr_of_call(type(self).__name__, self.coefficient)
        return found if self._acts_in_slip else f"{found[:-1]}{_ONLY_ROLLING})"


@dataclass(frozen=True, eq=False, repr=False, init=False)
class Sum(Loss):
    """Sum of loss laws, the result of `+`: the couples of the laws add, and so do the powers.

    Parameters
    ----------
    laws : iterable of Loss
        One or more laws. If a law is given twice, its coefficients are added.

    Examples
    --------
    >>> from spincyl.loss import AirFilm, DryContour
    >>> DryContour(2e-3) + AirFilm(1e-7)
    DryContour(0.002) + AirFilm(1e-07)
    >>> AirFilm(1e-7) + DryContour(2e-3) == DryContour(2e-3) + AirFilm(1e-7)
    True
    """

    _laws: tuple[Law, ...]

    def __init__(self, laws: Any) -> None:
        found: dict[type[Law], Law] = {}
        try:
            given = list(laws)
        except TypeError:
            raise TypeError(
                f"laws: expected a list of losses from sc.loss, not {type(laws).__name__}"
            ) from None
        for loss in given:
            if not isinstance(loss, Loss):
                raise TypeError(f"laws: expected losses from sc.loss, not {type(loss).__name__} {loss!r}")
            for law in loss.laws:
                kind = type(law)
                before = found.get(kind)
                # two laws of one kind have one coefficient, the sum
                if before is not None:
                    if isinstance(before._sized, Scale):
                        refuse_other_scale(f"laws: {law!r}", law._sized, before._sized)
                    if before._acts_in_slip != law._acts_in_slip:
                        why = "expected the same while_slipping of both, whose coefficients are added"
                        raise ValueError(f"laws: {before!r}, {law!r}: {why}")
                    both = before._sized and law._sized
                    law = law._with(before.coefficient + law.coefficient)
                    law = marked_as_si(law, before._sized) if both else law
                found[kind] = law
        if not found:
            raise ValueError("laws: expected at least one loss, such as sc.loss.DryContour(1e-3)")
        object.__setattr__(self, "_laws", tuple(found.values()))

    @property
    def laws(self) -> tuple[Law, ...]:
        """The laws of the sum, each once, in the order in which they were added."""
        return self._laws

    def __repr__(self) -> str:
        return " + ".join(map(repr, self.laws))


def _sum_of(laws: tuple[Law, ...]) -> Loss:
    """A sum of laws, or the law itself if there is only one kind."""
    found = Sum(laws)
    return found if len(found.laws) > 1 else found.laws[0]


def losses_in_words(losses: Loss, scale: Scale | None = None) -> str:
    """Loss laws as text, with four digits of each coefficient; with a scale, in the units of `from_si`."""
    if losses._function is not None:
        return repr(losses)
    found = []
    for law in losses.laws:
        k, of = law._printed(scale or law._sized)
        when = "" if law._acts_in_slip else _ONLY_ROLLING
        found.append(f"{type(law).__name__}({float(law.coefficient) * k:.4g}{of}{when})")
    return " + ".join(found)


def positive_coefficient(name: str, value: Reals, unit: str = "") -> Reals:
    """Return a positive finite coefficient, converted to `unit` of SI; an error names the coefficient."""
    found = reals(name, si(name, value, unit))
    if is_scalar(found):
        found = float(found)
    refuse_bad_value(name, found, lambda x: ~((x > 0) & np.isfinite(x)), _EXPECTED)
    return found


def command_line_name(kind: type[Law]) -> str:
    """The name of a law on the command line and in the address of a page: "dry-contour" for DryContour."""
    return re.sub(r"\B(?=[A-Z])", "-", kind.__name__).lower()


def divided_by_unit(value: Reals, unit: float) -> Reals:
    """Convert a coefficient to natural units; overflow gives inf without a warning, which the law rejects."""
    with np.errstate(over="ignore"):
        return value / unit


def arm_in_radii(name: str, value: Reals, scale: "Scale | Body") -> Reals:
    """Convert the arm of a loss law from metres to R; warn above R/2: probably millimetres were meant."""
    found = divided_by_unit(positive_coefficient(name, value, "metre"), natural_units_in_si(scale)[0])
    if np.any(np.asarray(found) > 0.5):
        told = f"{name}: the arm exceeds half the radius of the body; give metres, or a text such as '0.1mm'"
        warnings.warn(told, UserWarning, stacklevel=3)
    return found


def marked_as_si(law: _Kind, of: "Scale | Body | bool" = True) -> _Kind:
    """Mark a law as given in SI for the scale `of`; a measured body with another scale refuses the law."""
    object.__setattr__(law, "_sized", of if isinstance(of, bool) else scale_of(of))
    return law


def checked_law(losses: object, body: Body | None = None) -> Loss:
    """Return a loss law, or raise TypeError; ValueError if the body is measured and the law is not in SI."""
    if not isinstance(losses, Loss):
        like = "such as sc.loss.DryContour(1e-3), or a sum of them"
        raise TypeError(f"losses: expected a loss from sc.loss, {like}, not {type(losses).__name__}")
    laws = () if losses._built_in is None else losses._built_in.laws
    bare = [] if body is None or body.scale is None else [law for law in laws if not law._sized]
    if bare:
        made = f"sc.loss.{type(bare[0]).__name__}.from_si(..., scale=body)"
        why = f"expected a coefficient in SI for a measured body: use {made}, or pass body.natural"
        raise ValueError(f"losses = {losses!r}: {why}")
    for law in laws:
        refuse_other_scale(f"losses = {law!r}", law._sized, None if body is None else body.scale)
    return losses


def natural_units_in_si(scale: "Scale | Body", weighed: bool = False) -> tuple[float, float, float]:
    """Natural units of length, time and energy in SI; with `weighed`, ValueError if the mass is unknown."""
    found = scale_of(scale)
    if weighed and found.mass == 1.0 and isinstance(scale, Scale):
        message = f"scale = {found!r}: this loss depends on the mass of the body, taken as 1 kg; give mass="
        warnings.warn(message, UserWarning, stacklevel=4)
    if weighed:
        found._joule("the coefficient of this loss law")  # raises ValueError if the mass is unknown
    metres, seconds, joules, _ = found._units
    return metres, seconds, joules
