"""Contact laws: rolling, a smooth table, or a law of friction."""

from dataclasses import dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, TypeAlias

import numpy as np

from spincyl import _core
from spincyl._input.equality import compared_by_value
from spincyl._input.hints import Hinting
from spincyl._input.numbers import Reals, is_scalar, one_of, read_only_copy, reals, refuse_bad_value, si
from spincyl._input.reprs import is_lazy, repr_of_call
from spincyl._scale import Scale, refuse_other_scale, scale_of

if TYPE_CHECKING:
    from spincyl._body import Body

#: Contacts without a law of friction: rolling without slip, or no friction.
Contact: TypeAlias = Literal["rolling", "smooth"]

#: How the table presses on a face.
Face: TypeAlias = Literal["ring", "disc"]

#: Code of each name in each enumeration of the compiled core.
CODES = {name: dict(values) for name, values in _core.codes()}
#: Code of each kind of contact, including the laws of friction.
TABLES = CODES["Table"]
#: Code of each value of `Face`.
FACES = CODES["Face"]


class _Law(Hinting):
    """Base class of the laws of friction, whose coefficients are numbers or arrays."""

    #: False for numbers in natural units; True, or the scale, if they were given in SI.
    _sized: ClassVar[Scale | bool] = False
    #: The function of a law that a user wrote.
    _function: ClassVar[Any] = None

    def _known(self, of: Scale | bool = True) -> Self:
        """Mark the coefficients as given in SI for the scale `of`; other scales are then refused."""
        object.__setattr__(self, "_sized", of)
        return self

    def _natural(self, scale: Scale | None) -> Self:
        """The law with coefficients in the natural units of a body with this scale."""
        return self

    @property
    def _numbers(self) -> tuple[Reals, Reals, Reals]:
        raise NotImplementedError


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Coulomb(_Law):
    """Dry friction at the contact point, a law of friction for `contact=`.

    While the contact point slips, the force of friction is mu N, opposite to the slip; N is the normal force.
    The body rolls as long as rolling needs a friction force of at most `static` times N.

    Parameters
    ----------
    mu : array_like
        Coefficient of kinetic friction, 0 (a smooth table) or more.
    static : array_like, optional
        Coefficient of static friction, at least `mu`. With an infinite value a rolling body never slips.
        Default: `mu`.
    patch : array_like, optional
        Radius of the round patch on which the body touches the table, in R, below 1. Default: 0, a contact
        point. The pressure in the patch is that of a Hertz contact. Slip and drilling (the rotation about the
        vertical) share the friction of the patch (Contensou), so the contact does not stick while the body
        drills. For a measured body, make the law with `from_si`.
    face : {"ring", "disc"}
        How the table presses on a face on which the body stands, slides or spins. "ring": on its rim, as
        under a tube, a can or a coin. "disc": on the whole face, as under a puck. The patch of contact does
        not act on a face.

    Raises
    ------
    ValueError
        If a coefficient is negative or NaN, `mu` is infinite, `static` is less than `mu`, `patch` is 1 or
        more, or `face` is neither "ring" nor "disc".
    TypeError
        If a coefficient is not real-valued; the message names it.

    Examples
    --------
    >>> import spincyl as sc
    >>> sc.Coulomb(0.3), sc.Coulomb(0.3, static=0.35)
    (Coulomb(0.3), Coulomb(0.3, static=0.35))
    """

    mu: Reals
    static: Reals = None
    patch: Reals = 0.0
    face: Face = "ring"

    @classmethod
    def from_si(
        cls, mu: Reals, static: Reals = None, *, patch: Reals, face: Face = "ring", scale: "Scale | Body"
    ) -> Self:
        """Coulomb friction for a measured body: `patch` is in metres, or a text such as "0.3mm".

        `scale` is the measured body, or its `Scale`.
        """
        of = scale_of(scale)
        radius = reals("patch", si("patch", patch, "metre")) / of._units[0]
        return cls(mu, static, radius, face)._known(of)

    def __post_init__(self) -> None:
        mu = _coefficient("mu", self.mu)
        refuse_bad_value("mu", mu, np.isinf, "expected a finite number")
        static = mu if self.static is None else _coefficient("static", self.static)
        if static is not mu and not is_lazy(mu):
            refuse_bad_value("static", static, lambda x: x < np.asarray(mu), f"expected at least mu = {mu!r}")
        patch = _coefficient("patch", self.patch)
        refuse_bad_value("patch", patch, lambda x: ~(x < 1), "expected 0 <= patch < 1, in R")
        object.__setattr__(self, "mu", mu)
        object.__setattr__(self, "static", static)
        object.__setattr__(self, "patch", patch)
        one_of("face", self.face, tuple(FACES))

    @property
    def _numbers(self) -> tuple[Reals, Reals, Reals]:
        return self.mu, self.static, self.patch

    def __repr__(self) -> str:
        lazy = is_lazy(self.static) or is_lazy(self.mu)
        same = self.static is self.mu or (not lazy and np.array_equal(self.static, self.mu))
        more = {} if same else {"static": self.static}
        point = is_scalar(self.patch) and self.patch == 0
        more |= ({} if point else {"patch": self.patch}) | (
            {} if self.face == "ring" else {"face": self.face}
        )
        return repr_of_call("Coulomb", self.mu, **more)


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Viscous(_Law):
    """Viscous friction, c N u, proportional to the slip u: a wet table, or the peg of a tippe top.

    N is the normal force. The contact never sticks: the slip decays, but never becomes zero.

    Parameters
    ----------
    c : array_like
        Coefficient of friction per unit of slip, in 1/sqrt(g R): 0 (a smooth table) or more. For a measured
        body, make the law with `from_si`.

    Raises
    ------
    ValueError
        If the coefficient is negative, NaN or infinite.
    TypeError
        If the coefficient is not a real number.

    Examples
    --------
    >>> import spincyl as sc
    >>> coin = sc.measured(outer_diameter="24mm", length="2mm")
    >>> sc.Viscous.from_si(1.0, scale=coin)  # mu = 0.1 where it slips at 0.1 m/s
    Viscous(0.34304489502104535)
    """

    c: Reals

    @classmethod
    def from_si(cls, c: Reals, *, scale: "Scale | Body") -> Self:
        """Viscous friction for a measured body: `c` is in s/m, `scale` is the body or its `Scale`."""
        of = scale_of(scale)
        speed = of.metres_per_second(1.0)
        return cls(_coefficient("c", si("c", c, "second/metre")) * speed)._known(of)

    def __post_init__(self) -> None:
        c = _coefficient("c", self.c)
        refuse_bad_value("c", c, np.isinf, "expected a finite number")
        object.__setattr__(self, "c", c)

    @property
    def _numbers(self) -> tuple[Reals, Reals, Reals]:
        return self.c, 0.0, 0.0

    def __repr__(self) -> str:
        return repr_of_call("Viscous", self.c)


#: A law of friction.
Friction: TypeAlias = Coulomb | Viscous
#: End of the message that refuses a law that the user wrote.
WHERE_OWN_LAWS_WORK = "a law of your own works only in sc.roll and sc.sweep.roll"
#: Every kind of contact.
AnyContact: TypeAlias = Contact | Friction


def _coefficient(name: str, value: Reals) -> Reals:
    """Return a coefficient of friction that is not negative, or raise an error that names it."""
    found = reals(name, value)
    if is_scalar(found):
        found = float(found) + 0.0  # turns -0.0 into 0.0
    refuse_bad_value(name, found, lambda x: ~(x >= 0), f"expected 0 <= {name}")
    return read_only_copy(found)


#: Words that a user may write for each contact; the laws of friction only where they are possible.
_MEANT = {
    "'smooth'": ("smooth", "ice", "icy", "slippery", "slick", "frictionless", "free", "none", "no friction"),
    "'rolling'": ("rolling", "roll", "rough", "grip", "stick", "sticking", "static", "no slip", "no-slip"),
    "sc.Coulomb(mu)": ("coulomb", "dry", "friction", "slip", "slipping", "slide", "sliding", "kinetic"),
    "sc.Viscous(c)": ("viscous", "wet", "water", "fluid", "linear"),
}


def _meant(contact: str, rubs: bool) -> str:
    """Text such as "; did you mean 'smooth'?" for another word, such as "ice"; empty for an unknown word."""
    known = {word: means for means, words in _MEANT.items() if rubs or means[0] == "'" for word in words}
    near = get_close_matches(contact.strip().lower(), known, 1, 0.75)
    return f"; did you mean {known[near[0]]}?" if near else ""


def code_of(contact: object, rubs: bool = False) -> int:
    """Code of the contact "rolling" or "smooth"; with `rubs` the error also proposes laws of friction."""
    if not isinstance(contact, str) or contact not in ("rolling", "smooth"):
        last, instead = " or 'smooth'", _meant(contact, rubs) if isinstance(contact, str) else ""
        if rubs:
            last = ", 'smooth', sc.Coulomb(mu) or sc.Viscous(c)"
            if isinstance(contact, int | float):
                instead = f"; did you mean sc.Coulomb({contact!r})?"
            elif callable(contact) and not isinstance(contact, type):
                instead = "; did you mean sc.custom.Friction(function)?"
        raise ValueError(f"contact = {contact!r}: expected 'rolling'{last}{instead}")
    return TABLES[contact]


def is_rolling(contact: object) -> bool:
    """Whether the contact is "rolling" and not "smooth"; ValueError for any other."""
    return code_of(contact) == TABLES["rolling"]


def table_for_core(
    contact: AnyContact, mu: float, own: bool = False
) -> tuple[int, tuple[float, float, float]]:
    """Code and coefficients of a contact for the core; ValueError if the coefficients are arrays.

    A law that the user wrote raises TypeError, unless `own` is true.
    """
    if isinstance(contact, str):
        return TABLES[contact], (mu, 0.0, 0.0)
    if not own:
        refuse_own_law(contact)
    if not is_scalar(*contact._numbers):
        raise ValueError(f"contact = {contact!r}: expected single coefficients, not arrays")
    first, second, patch = map(float, contact._numbers)
    return code_of_friction(contact), (first, second, patch)


def refuse_own_law(contact: AnyContact) -> None:
    """Raise TypeError for a law that the user wrote."""
    if getattr(contact, "_function", None) is not None:
        raise TypeError(f"contact = {contact!r}: {WHERE_OWN_LAWS_WORK}")


def without_coefficient(contact: AnyContact) -> AnyContact:
    """The same contact with coefficient 0: the coefficients of many motions are passed as columns.

    A law that the user wrote stays the same.
    """
    if isinstance(contact, str) or contact._function is not None:
        return contact
    return Coulomb(0.0, face=contact.face) if isinstance(contact, Coulomb) else Viscous(0.0)


def check_contact_scale(contact: AnyContact, scale: Scale | None) -> None:
    """Raise an error for a measured body if `c` or `patch` was not given in SI for the body's scale."""
    if not isinstance(contact, _Law):
        code_of(contact, rubs=True)
    if scale is not None and isinstance(contact, Viscous) and not contact._sized:
        why = "expected SI for a measured body: use sc.Viscous.from_si(..., scale=body)"
        raise ValueError(f"contact = {contact!r}: {why}, or pass body.natural")
    if scale is not None and has_patch(contact) and not contact._sized:  # type: ignore[union-attr]
        why = 'expected SI for a measured body: use sc.Coulomb.from_si(mu, patch="0.3mm", scale=body)'
        raise ValueError(f"contact = {contact!r}: {why}, or pass body.natural")
    if isinstance(contact, Viscous) or has_patch(contact):
        refuse_other_scale(f"contact = {contact!r}", contact._sized, scale)  # type: ignore[union-attr]


def has_patch(contact: object) -> bool:
    """Whether a contact has a patch of positive radius; of many contacts, whether one has, or may have."""
    if not isinstance(contact, Coulomb):
        return False
    patch = contact.patch
    return is_lazy(patch) or (patch != 0 if isinstance(patch, float) else bool(np.any(patch)))


def code_of_friction(contact: Friction) -> int:
    """Code by which the compiled core knows the kind of a law of friction."""
    return TABLES["coulomb" if isinstance(contact, Coulomb) else "viscous"]


def contact_in_words(contact: AnyContact) -> str:
    """The word for a contact, or the repr of a law of friction with its numbers."""
    return contact if isinstance(contact, str) else repr(contact)
