"""The state of a stone: its vertical, its angular velocity and its slip, or arrays of them."""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from spincyl import _core
from spincyl._input.equality import compared
from spincyl._input.numbers import Floats, Reals, Result, components, floats, reals, several, vector_in
from spincyl._input.reprs import call, is_lazy
from spincyl._scale import scale_of


def doubles(value: Reals) -> Reals:
    """Real numbers as an array of doubles without named axes; a lazy array stays lazy."""
    if not is_lazy(value):
        return floats(value)
    lazy = value.data if hasattr(value, "dims") else value
    return lazy.astype(np.float64)


def vectors(name: str, value: Reals, *last: int) -> Reals:
    """A read-only array whose last axes have the lengths `last`; an error names the argument."""
    array = doubles(reals(name, value))
    array = array if is_lazy(array) else np.array(array)
    if array.shape[array.ndim - len(last) :] != last or array.ndim < len(last):
        raise ValueError(
            f"{name}: expected an array of shape (..., {', '.join(map(str, last))}), not {array.shape}"
        )
    if not is_lazy(array):
        array.setflags(write=False)
    return array


class Rocking(NamedTuple):
    """How a stone rocks that spins upright; of its two modes the slower first. In sqrt(g/a)."""

    growth: Floats  #: (..., 2) how fast each mode grows; negative of one that dies
    frequency: Floats  #: (..., 2) angular frequency; 0 of a mode that leaves without rocking
    eigenvalues: NDArray[np.complex128]  #: (..., 4) all of them


@compared
@dataclass(frozen=True, eq=False, repr=False)
class EllipsoidState:
    """The vertical and the angular velocity of a stone, along the axes of the ellipsoid, in natural units.

    Arrays have their components along the last axis, and broadcast; those of dask stay lazy.

    Parameters
    ----------
    vertical : array_like, (..., 3)
        Unit vector that points upward: (0, 0, 1) where axis 3 stands upright.
    w : array_like, (..., 3)
        Angular velocity, sqrt(g/a), where a is the largest semi-axis.
    slip : array_like, (..., 2), optional
        Velocity of the contact point over the table, sqrt(g a): along the axes x and y of the laboratory in
        which the stone has turned from upright by the smallest angle; upside down that is a half turn about
        axis 1. Default: none, the stone rolls.

    Raises
    ------
    TypeError, ValueError
        Naming the field that holds no real numbers, or too few.

    Notes
    -----
    ``State(theta, w1, w2, w3)`` is ``EllipsoidState((sin(theta), 0, cos(theta)), (w1, w2, w3))`` first;
    later `w` differs, since the axes of a `State` follow the tilt, and these the stone.
    """

    vertical: Reals
    w: Reals
    slip: Reals | None = None
    height: ClassVar[None] = None  # a stone does not start in the air

    @classmethod
    def from_si(cls, vertical: Reals, w: Reals, *, slip: Reals | None = None, scale: Any) -> "EllipsoidState":
        """A state with angular velocities in rad/s and a slip in m/s; `scale` may be a measured stone."""
        metre, second, *_ = scale_of(scale)._units
        w, slip = vector_in("radian/second", "w", w), vector_in("metre/second", "slip", slip)
        found = cls(vertical, w, slip)
        with np.errstate(over="ignore"):
            faster = None if found.slip is None else found.slip * (second / metre)
            return cls(found.vertical, found.w * second, faster)

    def in_si(self, scale: Any) -> dict[str, Any]:
        """What `from_si` takes: the vertical, w in rad/s, and the slip in m/s if there is one."""
        metre, second, *_ = scale_of(scale)._units
        slip = {} if self.slip is None else {"slip": self.slip * (metre / second)}
        return {"vertical": self.vertical, "w": self.w / second} | slip

    def __post_init__(self) -> None:
        for name, width in (("vertical", 3), ("w", 3), ("slip", 2)):
            if name != "slip" or self.slip is not None:
                object.__setattr__(self, name, vectors(name, getattr(self, name), width))
        shapes = [np.shape(x)[:-1] for x in (self.vertical, self.w, self._pair)]
        try:
            np.broadcast_shapes(*shapes)
        except ValueError:
            raise ValueError(f"vertical, w, slip: shapes do not fit: {shapes}") from None

    @property
    def spin(self) -> Result:
        """(...) angular velocity about the vertical, in sqrt(g/a)."""
        return _core.stone_spin(*components(self.vertical), *components(self.w))

    @property
    def theta(self) -> Result:
        """(...) inclination of axis 3, in radians."""
        found: Floats = self.inclinations[..., 2]
        return found[()]

    @property
    def inclinations(self) -> Floats:
        """(..., 3) angles from the vertical to the axes of the ellipsoid, in radians."""
        found: Floats = _core.stone_inclinations(*several(3, *components(self.vertical)))
        return found

    def __repr__(self) -> str:
        more = {} if self.slip is None else {"slip": self.slip}
        return call("EllipsoidState", vertical=self.vertical, w=self.w, **more)

    @property
    def _pair(self) -> Reals:
        return np.zeros(2) if self.slip is None else self.slip

    @property
    def _slips(self) -> bool:
        """Whether the state has a slip that is not zero, or that is lazy and may not be."""
        return self.slip is not None and (is_lazy(self.slip) or bool(np.any(self.slip != 0)))
