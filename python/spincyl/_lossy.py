"""Checks of the arguments of motions with losses."""

from typing import Any

import numpy as np

from spincyl import _core
from spincyl._contact import AnyContact, Coulomb
from spincyl._input.numbers import Floats, is_scalar, warn
from spincyl._input.reprs import is_lazy
from spincyl._loss import Loss, checked_law

_WHY = {
    "step": "losses need an integrator of eighth order with variable steps: give tol=",
    "method": "with losses there are no first integrals; an eighth-order integrator is used: give tol=",
}


def check_losses(losses: object, times: Floats, t0: float, settings: dict[str, Any]) -> None:
    """Raise ValueError for arguments that exclude losses; `settings` are the settings given, by name."""
    laws = checked_law(losses)._built_in
    if laws is not None and not is_scalar(*laws._coefficients):
        raise ValueError(
            f"losses = {losses!r}: expected single coefficients, not arrays; sc.drift accepts arrays"
        )
    for name in filter(settings.__contains__, _WHY):
        raise ValueError(
            f"{name} = {settings[name]!r} cannot be combined with losses={losses!r}: {_WHY[name]}"
        )
    if np.any(times < t0):
        raise ValueError(
            f"t = {float(times[times < t0][0])!r}: expected at least t0 = {t0!r};"
            " a motion with losses cannot go backward in time"
        )


def losses_of_stone(losses: object, body: Any) -> Loss:
    """Return a loss law that acts on stones, or an error that names the law."""
    found = checked_law(losses, body)
    if found._function is not None:
        why = "the axes e1, e2, e3 of your own law are those of a body of revolution"
        raise TypeError(f"losses = {losses!r}: {why}, and a stone has no axis")
    if not found._acts_in_slip:
        raise ValueError(f"losses = {losses!r}: while_slipping=False is for bodies of revolution, not stones")
    for law in found.laws:
        if law._parameter not in _core.stone_losses():
            why = "acts along a rim, which a stone lacks; give a law of air, rolling resistance or drilling"
            raise ValueError(f"losses = {law!r}: {why}")
    return found


def check_resistance(losses: Loss, contact: AnyContact) -> None:
    """Raise ValueError for `while_slipping=False` on a table on which the body never rolls."""
    if losses._acts_in_slip:
        return
    patch = contact.patch if isinstance(contact, Coulomb) else 0.0
    never = contact != "rolling" if isinstance(contact, str) else not isinstance(contact, Coulomb)
    if never or (not is_lazy(patch) and np.any(np.asarray(patch) > 0)):
        why = "needs contact=sc.Coulomb(mu) without a patch, or 'rolling': on other tables no body rolls"
        raise ValueError(f"losses = {losses!r}: while_slipping=False {why}")


def warn_of_long_arm(losses: Loss, contact: AnyContact) -> None:
    """Warn if the arm of rolling resistance ends outside the patch of contact, where no pressure acts."""
    laws = losses._built_in
    if not isinstance(contact, Coulomb) or laws is None:
        return
    arms = [law.coefficient for law in laws.laws if law._parameter == "delta"]
    patch = contact.patch
    if any(is_lazy(x) for x in (*arms, patch)):
        return
    if arms and np.any((np.asarray(arms[0]) > patch) & (np.asarray(patch) > 0)):
        warn(
            f"losses: the arm of rolling resistance, {arms[0]!r}, exceeds the radius of the patch, {patch!r};"
            " the normal force would act outside the patch"
        )
