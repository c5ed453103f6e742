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


class Outputs:
    """Outputs of a motion at each time that are computed if they were asked for."""

    contact_point = Number(
        POSE,
        '(n, 2) position of the contact point on the table, R or m; initially (0, 0). Needs want="pose".',
    )
    centre = Number(POSE, '(n, 3) position of the centre of mass, R or m. Needs want="pose".')
    orientation = Number(
        POSE,
        """(n, 4) rotation from the axes of the body to those of the laboratory. Needs want="pose".

        The third axis of the body is e3. Rotations are unit quaternions (x, y, z, w), as in SciPy's
        `Rotation.from_quat`.
        """,
    )
    normal = Number(FORCE, '(n,) normal force, M g or N. Needs want="force".')
    friction = Number(
        FORCE,
        '(n,) magnitude of the horizontal force of the table, M g or N. Needs want="force".',
    )
    friction_coefficient = Number(
        FORCE,
        '(n,) coefficient of friction needed; infinite if N <= 0, NaN in the air. Needs want="force".',
    )
    contact_force = Number(
        BOTH,
        """(n, 3) force of the table along the axes of the laboratory, M g or N. Needs want=("pose", "force").

        The whole force: on both rims, if both touch the table.
        """,
    )
    contact_force_other = Number(
        ALOFT,
        """(n, 3) part of `contact_force` on the other rim; NaN unless both rims touch the table.

        Needs `restitution=` and want=("pose", "force").
        """,
    )
    slip = Number(
        FRICTION,
        """(n, 2) velocity of the contact point over the table, sqrt(g R) or m/s, along e_h and e2 of `State`.

        Needs a law of friction or `restitution=`.
        """,
    )
    dissipated = Number(
        FRICTION, "(n,) heat of friction since the initial state, M g R or J. Needs a law of friction."
    )
    phase = Number(
        FRICTION,
        """(n,) code of the phase at each time. Needs a law of friction or `restitution=`.

        0 rolling, 1 slipping, 2 flying; on both rims 3 lying and slipping, 4 pivoting, 5 rolling on its side.
        """,
    )
    drilling = Number(
        PATCH, "(n,) angular velocity about the vertical, sqrt(g/R) or rad/s. Needs a patch of contact."
    )
    creep = Number(
        PATCH, "(n,) slip over the product of `drilling` and patch radius; 0 in rolling. Needs a patch."
    )
    couple = Number(
        COUPLE,
        """(n,) couple of the patch about the vertical, M g R or J. Needs a patch and want="force".

        NaN in rolling, where static friction prevents drilling.
        """,
    )
    lift = Number(
        ALOFT, "(n,) upward velocity of the lowest point of the rim, sqrt(g R) or m/s. Needs `restitution=`."
    )
    slip_other = Number(
        ALOFT, "(n, 2) `slip` of the other rim; NaN unless both rims touch the table. Needs `restitution=`."
    )
    normal_other = Number(ALOFT, '(n,) `normal` of the other rim. Needs `restitution=` and want="force".')
    friction_other = Number(ALOFT, '(n,) `friction` of the other rim. Needs `restitution=` and want="force".')
    work_lost = Number(
        LOSSES, "(n,) energy that `losses` have taken since the initial state, M g R or J. Needs `losses=`."
    )
