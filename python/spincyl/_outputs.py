"""Outputs of a motion as properties; the error for a missing output says how to compute it."""

from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from spincyl._contact import named
from spincyl._input.numbers import Floats

if TYPE_CHECKING:
    from spincyl._motion import Motion

# messages about missing outputs: how to get them, by output and contact
_LACKS = "{{}}: not computed; give want={0} to roll, or take m.wanting({0})"
POSE, FORCE, BOTH = (_LACKS.format(want) for want in ('"pose"', '"force"', '("pose", "force")'))
FRICTION = "{}: needs a law of friction, not contact = {!r}; give contact=sc.Coulomb(mu) to roll"
ALOFT = "{}: needs restitution=; this motion ends where it leaves the table. Give restitution=0.0 to roll"
LOSSES = "{}: needs losses=; give losses=sc.loss.DryContour(eps) to roll"
PATCH = "{}: needs a patch of contact, not contact = {!r}; give contact=sc.Coulomb(mu, patch=eps) to roll"
COUPLE = PATCH.replace(" to roll", ' and want="force" to roll')


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
    """Return an output of a motion in its units, or raise AttributeError that says how to compute it."""
    if name not in m._extra:
        raise AttributeError(lacking.format(name, named(m.contact)))
    return m._told(name, m._extra[name])
