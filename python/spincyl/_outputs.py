"""Outputs of a motion as properties; the error for a missing output says how to compute it."""

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from spincyl._body import Body
from spincyl._contact import contact_in_words
from spincyl._ending import Held, held
from spincyl._input.hints import Hinting
from spincyl._input.numbers import Floats

if TYPE_CHECKING:
    from spincyl._motion import Motion

# what an output that was not computed needs; `missing_output` says how to get it
POSE, FORCE, BOTH = '"pose"', '"force"', '("pose", "force")'
FRICTION, PATCH, COUPLE, ALOFT, LOSSES = "friction", "patch", "couple", "restitution", "losses"
FACE = "face"
#: Settings of `roll` that cannot be combined with what each kind of output needs.
_EXCLUDES = {
    FRICTION: ("step", "method", "mu", "beyond"),
    PATCH: ("step", "method", "mu", "beyond"),
    ALOFT: ("step", "method", "beyond"),
    LOSSES: ("step", "method"),
}


class Number(property):
    """Descriptor of an output at each time, in the units of the motion; AttributeError if not computed."""

    def __init__(self, needs: str, said: str) -> None:
        super().__init__(lambda m: output_in_units(m, self._name, needs))
        self.__doc__ = said

    def __set_name__(self, _: type, name: str) -> None:
        self._name = name

    if TYPE_CHECKING:

        def __get__(self, m: Any, kind: type | None = None) -> NDArray[Any]: ...  # type: ignore[override]


def output_in_units(m: "Motion", name: str, needs: str) -> Floats:
    """Return an output of a motion in its units, or raise AttributeError that says how to compute it."""
    if name not in m._extra:
        if name.endswith("_other") and not isinstance(m.body, Body):
            raise AttributeError(f"{name}: only for bodies of revolution; a stone has no other rim")
        raise missing_output(m, name, needs)
    return m._told(name, m._extra[name])


def missing_output(m: "Motion", name: str, needs: str) -> AttributeError:
    """The error that says why an output is missing, and which arguments compute it, if there are any."""
    return AttributeError(f"{name}: {_how_to_get(m, needs)}")


def _how_to_get(m: "Motion", needs: str) -> str:
    if needs in (POSE, FORCE, BOTH):
        return f"not computed; give want={needs} to roll, or call m.wanting({needs})"
    own = [law for law in (m.contact, m.losses) if getattr(law, "_function", None) is not None]
    measured, stone, more = m.scale is not None, not isinstance(m.body, Body), ""
    if needs == ALOFT:
        why, how = "restitution=; this motion ends where it leaves the table", "restitution=0.0"
    elif needs == LOSSES:
        law, amount = ("RollingResistance", "delta") if stone else ("DryContour", "eps")
        made = f'{law}.from_si("0.05mm", scale=body)' if measured else f"{law}({amount})"
        made = "custom.Couple(function)" if own else f"loss.{made}"
        why, how = "losses=", f"losses=sc.{made}"
    elif needs == FACE:
        return 'needs a phase on the face: give roll a state of sc.spun, a law of friction and want="force"'
    elif needs == FRICTION:
        why, how = (
            f"a law of friction, not contact = {contact_in_words(m.contact)!r}",
            "contact=sc.Coulomb(mu)",
        )
    else:
        patch = '.from_si(mu, patch="0.3mm", scale=body)' if measured else "(mu, patch=eps)"
        why, how = (
            f"a patch of contact, not contact = {contact_in_words(m.contact)!r}",
            f"contact=sc.Coulomb{patch}",
        )
        more = ', want="force"' if needs == COUPLE else ""
    off = [f"{x}=" for x in _EXCLUDES[PATCH if needs == COUPLE else needs] if _given(m, x)]
    without = f", without {' and '.join(off)}" if off else ""
    return f"needs {why}; give {how}{more} to roll{without}"


def _given(m: "Motion", setting: str) -> bool:
    """Whether a setting of `roll` was given for a motion."""
    value = getattr(m._asked, setting)
    return not (value is None or value is False or value == math.inf)


class Outputs(Hinting):
    """Base class of motions: the outputs at each time that `want=` asks for, such as poses and forces."""

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
        FORCE, '(n,) magnitude of the horizontal force of the table, M g or N. Needs want="force".'
    )
    friction_coefficient = Number(
        FORCE, '(n,) `friction` over `normal`; infinite if N <= 0, NaN in the air. Needs want="force".'
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
        FRICTION,
        "(n,) heat of friction since the start, without impacts, M g R or J. Needs a law of friction.",
    )
    phase = Number(
        FRICTION,
        """(n,) code of the phase at each time. Needs a law of friction or `restitution=`.

        0 rolling, 1 slipping, 2 flying. On both rims or two circles: 3 lying, both slip; 4 pivoting, one
        slips; 5 rolling on its side; 6 rolling round its apex. 7 on its face.
        """,
    )
    drilling = Number(
        PATCH,
        "(n,) angular velocity about the vertical over the table, sqrt(g/R) or rad/s. Needs a patch.",
    )
    creep = Number(
        PATCH, "(n,) creep, slip/(`drilling` times the radius of the patch); 0 in rolling. Needs a patch."
    )
    couple = Number(
        COUPLE,
        """(n,) couple of the table about the vertical, M g R or J. Needs want="force", and a patch or a face.

        With a patch it is NaN in rolling, where static friction prevents the rotation about the vertical.
        Without a patch it is NaN unless the body is on its face; it is then the couple about the body's axis.
        """,
    )
    pressure = Number(
        FACE,
        """(n, 2) centre of the pressure on the face, in units of the radius of the face; NaN off the face.

        The components are along e_h and e2 of `State`: -Z F/(a N), with the height Z of the centre of mass,
        the friction F, the normal force N and the radius a of the face. At the distance 1 from the axis the
        body topples. Needs want="force", and a motion with a phase "on its face".
        """,
    )
    lift = Number(
        ALOFT, "(n,) upward velocity of the lowest point of the rim, sqrt(g R) or m/s. Needs `restitution=`."
    )
    slip_other = Number(
        ALOFT, "(n, 2) `slip` of the other rim; NaN unless both rims touch the table. Needs `restitution=`."
    )
    normal_other = Number(
        ALOFT, '(n,) normal force on the other rim, M g or N. Needs `restitution=` and want="force".'
    )
    friction_other = Number(
        ALOFT,
        """(n,) horizontal force on the other rim, M g or N. Needs `restitution=` and want="force".

        While a body rolls round its apex, only the sum of the frictions of both circles is determined; it is
        divided in the ratio of the normal forces.
        """,
    )
    work_lost = Number(
        LOSSES, "(n,) energy that `losses` have taken since the initial state, M g R or J. Needs `losses=`."
    )

    @property
    def work_table(self: Any) -> Floats:
        """(n,) work that a turning table has done on the body since the first time, M g R or J."""
        found: Floats = self.energy - self.energy[0]
        for name in ("dissipated", "work_lost"):
            found = found + (getattr(self, name) if name in self._extra else 0.0)
        return found if self.natural._impacts is None else found + self.lost_in_impacts

    @cached_property
    def held(self) -> Held | None:
        """Share of the largest dry friction that holds the body at rest; None unless it is at rest.

        The body is at rest if the motion ends with `Ending.STOPS`. The share is 0 on a level table, unless
        dry losses hold the body on its edge at another inclination than `theta_balance`. It is None for a
        stone, for a law of your own, and on a table that turns.
        """
        found: Held | None = held(self.natural)  # type: ignore[attr-defined]
        return found
