"""Laws of restitution of an impact, for comparison with programs that use another law than Stronge's."""

from dataclasses import dataclass, fields, replace
from typing import Any, TypeAlias

from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import in_range, number
from spincyl._input.reprs import repr_of_call


class GainWarning(UserWarning):
    """An impact has gained energy, by a law of restitution that allows it."""


class _ImpactLaw:
    """Base class of the laws of restitution: checks that each coefficient is a number from 0 to 1."""

    e: float

    def __post_init__(self) -> None:
        for name in (x.name for x in fields(self)):  # type: ignore[arg-type]
            object.__setattr__(self, name, in_range(name, getattr(self, name), 0.0, 1.0))

    def __repr__(self) -> str:
        first, *more = (x.name for x in fields(self))  # type: ignore[arg-type]
        named = {name: getattr(self, name) for name in more}
        return repr_of_call(type(self).__name__, getattr(self, first), **named)


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Newton(_ImpactLaw):
    """Newton's law, for `restitution=`: the normal velocity after an impact is -e times that before.

    Programs that compute impacts often have this law. Where friction turns or stops the slip it may give
    energy to the body [1]_; such an impact has `Impact.gained` > 0, and `roll` warns once. A motion under
    this law ends where a second circle or a face lands.

    Parameters
    ----------
    e : float
        Coefficient of restitution, 0 to 1.

    References
    ----------
    .. [1] T. R. Kane and D. A. Levinson, *Dynamics: Theory and Applications* (McGraw-Hill, 1985); W. J.
       Stronge, Proc. R. Soc. A 431, 169 (1990).

    Examples
    --------
    >>> import spincyl as sc
    >>> can = sc.Body.solid(1.0)
    >>> start = sc.dropped(can, 1.0, 1.0)
    >>> law, contact = sc.Newton(0.5), sc.Coulomb(0.3)
    >>> hit = sc.roll(can, start, 1.5, contact=contact, restitution=law).impacts[0]
    >>> round(-hit.after.lift / hit.before.lift, 12)
    0.5
    """

    e: float


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Poisson(_ImpactLaw):
    """Poisson's law, for `restitution=`: expansion returns e times the normal impulse of compression.

    Compression ends where the normal velocity is zero; if friction presses the contact point down
    once more, at the last such time. A motion under this law ends where a second circle or a face lands.

    Parameters
    ----------
    e : float
        Coefficient of restitution, 0 to 1.

    Examples
    --------
    >>> import spincyl as sc
    >>> sc.Poisson(0.5)
    Poisson(0.5)
    """

    e: float


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Walton(_ImpactLaw):
    """Walton's law of a superball, for `restitution=`: an impact reverses the slip of the ball as well.

    The normal velocity after an impact is -e times that before. The slip becomes -`tangential` times that
    before, if the friction that this takes is at most mu times the normal impulse; otherwise the ball slips
    throughout [1]_ [2]_ [3]_. The ball has equal moments of inertia, and the contact is Coulomb friction at a
    point.

    Parameters
    ----------
    e : float
        Coefficient of restitution, 0 to 1.
    tangential : float
        Coefficient of tangential restitution, 0 (the slip stops, as without this law) to 1 (a perfect
        superball).

    References
    ----------
    .. [1] R. L. Garwin, Am. J. Phys. 37, 88 (1969).
    .. [2] O. R. Walton and R. L. Braun, J. Rheol. 30, 949 (1986).
    .. [3] R. Cross, Am. J. Phys. 70, 1093 (2002).

    Examples
    --------
    A superball that is thrown without spin leaves with a slip that is turned back:

    >>> import spincyl as sc
    >>> ball = sc.Body.ball(0.0, 0.4, 0.4)
    >>> start = sc.State(1.0, 0.0, 0.0, 0.0, slip=(0.5, 0.0), height=2.0, lift=0.0)
    >>> m = sc.roll(ball, start, 2.5, contact=sc.Coulomb(1.0), restitution=sc.Walton(1.0, tangential=1.0))
    >>> hit = m.impacts[0]
    >>> hit.kind, round(hit.after.slip[0], 12), abs(hit.lost) < 1e-14
    ('turns back', -0.5, True)
    """

    e: float
    tangential: float


#: What `restitution=` takes: the coefficient of Stronge's law, or another law.
Restitution: TypeAlias = float | Newton | Poisson | Walton


def check_restitution(restitution: object) -> None:
    """Raise TypeError for a restitution that is neither a number nor a law; the core checks the range."""
    if isinstance(restitution, str):
        known = (
            "a number (Stronge's law), sc.Newton(e), sc.Poisson(e) or, for a ball, sc.Walton(e, tangential)"
        )
        raise TypeError(f"restitution: expected {known}, not {restitution!r}")
    if not isinstance(restitution, _ImpactLaw):
        number("restitution", restitution)


def coefficient_of(restitution: Any) -> float:
    """The coefficient of normal restitution of a law, or of a number, which is the coefficient itself."""
    return float(restitution.e if isinstance(restitution, _ImpactLaw) else restitution)


def with_coefficient(restitution: Restitution, e: float) -> Restitution:
    """The same law with another coefficient of normal restitution."""
    return replace(restitution, e=e) if isinstance(restitution, _ImpactLaw) else e


def law_for_core(restitution: Any) -> tuple[str, float] | None:
    """Name and tangential coefficient of a law of restitution; None if the restitution is a number."""
    if not isinstance(restitution, _ImpactLaw):
        return None
    return type(restitution).__name__, getattr(restitution, "tangential", 0.0)


def restitution_as_words(restitution: Any) -> dict[str, float | str]:
    """The law of restitution as plain numbers and words, by name, for an attribute of a file."""
    if not isinstance(restitution, _ImpactLaw):
        return {} if restitution is None else {"restitution": restitution}
    words: dict[str, float | str] = {"restitution": restitution.e, "impact_law": type(restitution).__name__}
    return words | ({"tangential": restitution.tangential} if isinstance(restitution, Walton) else {})


def restitution_from_words(words: Any) -> Restitution:
    """The law of restitution from the plain numbers and words of a file's attribute."""
    laws: dict[str, Any] = {law.__name__: law for law in (Newton, Poisson, Walton)}
    more = {"tangential": words["tangential"]} if "tangential" in words else {}
    law = laws.get(words.get("impact_law", ""))
    return words["restitution"] if law is None else law(words["restitution"], **more)  # type: ignore[no-any-return]
