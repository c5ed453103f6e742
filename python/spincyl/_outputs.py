"""Outputs of a motion as properties, which say how to get one that was not asked for."""

from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from spincyl._contact import named
from spincyl._input.numbers import Floats

if TYPE_CHECKING:
    from spincyl._motion import Motion

# messages about missing outputs: how to get them, by output and contact
_LACKS = "{{}} was not asked for: roll(..., want={}), or m.wanting of the same"
POSE, FORCE, BOTH = (_LACKS.format(want) for want in ('"pose"', '"force"', '("pose", "force")'))
FRICTION = "{} is not there: the contact is {!r}; roll(..., contact=sc.Coulomb(mu)) has it"
ALOFT = "{} is not there: the motion ends where it leaves the table; roll(..., restitution=0.0) goes on"
LOSSES = "{} is not there: nothing is lost; roll(..., losses=sc.loss.DryContour(eps)) has it"
PATCH = "{} is not there: the contact is {!r}; roll(..., contact=sc.Coulomb(mu, patch=eps)) has it"
COUPLE = PATCH.replace("eps))", 'eps), want="force")')


class Number(property):
    """An output at each time, in the units of the motion; AttributeError if it was not computed."""

    def __init__(self, lacking: str, said: str) -> None:
        super().__init__(lambda m: output(m, self._name, lacking))
        self.__doc__ = said

    def __set_name__(self, _: type, name: str) -> None:
        self._name = name

    if TYPE_CHECKING:

        def __get__(self, m: Any, kind: type | None = None) -> NDArray[Any]: ...  # type: ignore[override]


def output(m: "Motion", name: str, lacking: str) -> Floats:
    """Return an output of a motion in its units, or raise AttributeError that says how to get it."""
    if name not in m._extra:
        raise AttributeError(lacking.format(name, named(m.contact)))
    return m._told(name, m._extra[name])
