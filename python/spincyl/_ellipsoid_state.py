"""The state of a stone: its vertical, its angular velocity, its slip and its height, or arrays of them."""

from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spincyl import _core
from spincyl._input.equality import compared_by_value
from spincyl._input.hints import Hinting
from spincyl._input.numbers import (
    Floats,
    Reals,
    Result,
    components,
    floats,
    is_scalar,
    numbered,
    read_only_copy,
    reals,
    si,
    vector_in,
)
from spincyl._input.reprs import is_lazy, repr_of_call
from spincyl._scale import scale_of


def as_doubles(value: Reals) -> Reals:
    """Real numbers as an array of doubles without named axes; a lazy array stays lazy."""
    if not is_lazy(value):
        return floats(value)
    lazy = value.data if hasattr(value, "dims") else value
    return lazy.astype(np.float64)


def as_vectors(name: str, value: Reals, *last: int) -> Reals:
    """A read-only array whose last axes have the lengths `last`; errors name the argument."""
    array = as_doubles(reals(name, value))
    array = array if is_lazy(array) else np.array(array)
    if array.shape[array.ndim - len(last) :] != last or array.ndim < len(last):
        raise ValueError(
            f"{name}: expected an array of shape (..., {', '.join(map(str, last))}), not {array.shape}"
        )
    if not is_lazy(array):
        array.setflags(write=False)
    return array


class Rocking(NamedTuple):
    """The two rocking modes of a stone that spins upright, in sqrt(g/a); the slower mode is first.

    Attributes
    ----------
    growth : ndarray, (..., 2)
        Growth rate of each mode; negative if the mode decays.
    frequency : ndarray, (..., 2)
        Angular frequency of each mode; 0 if the stone does not oscillate in this mode.
    eigenvalues : ndarray of complex, (..., 4)
        The four eigenvalues of the linearised motion.
    """

    growth: Floats
    frequency: Floats
    eigenvalues: NDArray[np.complex128]


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class EllipsoidState(Hinting):
    """State of a stone, in natural units: vertical and angular velocity along the axes of the ellipsoid.

    The last axis of an array holds the components of a vector; the other axes broadcast. Dask arrays stay
    lazy.

    Parameters
    ----------
    vertical : array_like, (..., 3)
        Unit vector that points upward, along the axes of the ellipsoid; (0, 0, 1) if axis 3 is upright.
    w : array_like, (..., 3)
        Angular velocity along the axes of the ellipsoid, in sqrt(g/a), where a is the largest semi-axis.
    slip : array_like, (..., 2), optional
        Velocity of the contact point over the table, in sqrt(g a), along the axes x and y of the laboratory.
        These are axes 1 and 2 of the stone after the smallest rotation that makes axis 3 upright (for a stone
        that is upside down: half a turn about axis 1). Default: no slip, the stone rolls. In the air it is
        the horizontal velocity of the lowest point of the stone.
    height, lift : array_like, optional
        For a stone in the air: height of its lowest point above the table, in a, and the upward velocity of
        that point, in sqrt(g a). If you give only one, the other is 0. `Ellipsoid.dropped` computes both.

    Raises
    ------
    TypeError, ValueError
        If a field is not real-valued or has the wrong shape; the message names it.

    Notes
    -----
    As an initial state ``State(theta, w1, w2, w3)`` equals
    ``EllipsoidState((sin(theta), 0, cos(theta)), (w1, w2, w3))``. Later `w` differs: the axes of the
    ellipsoid turn with the stone, and the axes e1, e2, e3 of a `State` do not follow the spin.

    Examples
    --------
    >>> import spincyl as sc
    >>> state = sc.EllipsoidState((0.6, 0.0, 0.8), (0.0, 0.0, 5.0))
    >>> float(state.spin), float(state.theta.round(4))
    (4.0, 0.6435)
    """

    vertical: Reals
    w: Reals
    slip: Reals | None = None
    height: Reals | None = field(default=None, kw_only=True)
    lift: Reals | None = field(default=None, kw_only=True)

    @classmethod
    def from_si(
        cls,
        vertical: Reals,
        w: Reals,
        *,
        slip: Reals | None = None,
        height: Reals | None = None,
        lift: Reals | None = None,
        scale: Any,
    ) -> "EllipsoidState":
        """State in SI: `w` in rad/s, the velocities `slip` and `lift` in m/s, and `height` in m.

        `scale` is a measured stone, or its `Scale`.
        """
        metre, second, *_ = scale_of(scale)._units
        w, slip = vector_in("radian/second", "w", w), vector_in("metre/second", "slip", slip)
        height, lift = si("height", height, "metre"), si("lift", lift, "metre/second")
        found = cls(vertical, w, slip, height=height, lift=lift)
        units = {"w": second, "slip": second / metre, "height": 1 / metre, "lift": second / metre}
        with np.errstate(over="ignore"):
            given = ((name, getattr(found, name), unit) for name, unit in units.items())
            return replace(found, **{name: x * unit for name, x, unit in given if x is not None})

    def in_si(self, scale: Any) -> dict[str, Any]:
        """Return the arguments of `from_si` as a dict: vertical, w (rad/s); also slip, height, lift."""
        metre, second, *_ = scale_of(scale)._units
        units = {"slip": metre / second, "height": metre, "lift": metre / second}
        given = ((name, getattr(self, name), unit) for name, unit in units.items())
        more = {name: x * unit for name, x, unit in given if x is not None}
        return {"vertical": self.vertical, "w": self.w / second} | more

    def __post_init__(self) -> None:
        for name, width in (("vertical", 3), ("w", 3), ("slip", 2)):
            if name != "slip" or self.slip is not None:
                object.__setattr__(self, name, as_vectors(name, getattr(self, name), width))
        shapes = {
            "vertical": np.shape(self.vertical)[:-1],
            "w": np.shape(self.w)[:-1],
            "slip": np.shape(self._pair)[:-1],
        }
        if self.height is not None or self.lift is not None:
            for name in ("height", "lift"):
                given = getattr(self, name)
                value = reals(name, 0.0 if given is None else given)
                value = read_only_copy(value if is_scalar(value) else as_doubles(value))
                object.__setattr__(self, name, value)
                shapes[name] = np.shape(value)
        try:
            np.broadcast_shapes(*shapes.values())
        except ValueError:
            told = [*shapes.values()]
            raise ValueError(f"{', '.join(shapes)}: shapes do not fit: {told}") from None

    @property
    def spin(self) -> Result:
        """Spin: the angular velocity about the vertical, in sqrt(g/a)."""
        return _core.stone_spin(*components(self.vertical), *components(self.w))

    @property
    def theta(self) -> Result:
        """Inclination: the angle from the vertical to axis 3, in radians."""
        found: Floats = self.inclinations[..., 2]
        return found[()]

    @property
    def inclinations(self) -> Floats:
        """Angles from the vertical to the three axes of the ellipsoid, (..., 3), in radians."""
        found: Floats = _core.stone_inclinations(*numbered(3, *components(self.vertical)))
        return found

    def __repr__(self) -> str:
        more = {name: getattr(self, name) for name in ("slip", "height", "lift")}
        there = {name: x for name, x in more.items() if x is not None}
        return repr_of_call("EllipsoidState", vertical=self.vertical, w=self.w, **there)

    @property
    def _pair(self) -> Reals:
        return np.zeros(2) if self.slip is None else self.slip

    @property
    def _aloft(self) -> tuple[Reals, Reals]:
        """`height` and `lift` as a pair; both are 0 for a stone on the table."""
        return (0.0, 0.0) if self.height is None else (self.height, self.lift)

    @property
    def _slips(self) -> bool:
        """Whether the state has a slip that is not zero, or that is lazy and may not be."""
        return self.slip is not None and (is_lazy(self.slip) or bool(np.any(self.slip != 0)))
