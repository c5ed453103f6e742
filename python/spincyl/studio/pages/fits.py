"""Checks that the live page can show the given contact, losses, restitution and slope."""

from typing import Any

from spincyl._body import Body
from spincyl._contact import AnyContact, check_contact_scale, has_patch
from spincyl._loss import Loss, checked_law
from spincyl._table import Table


def check_contents(
    friction: bool, contact: AnyContact, losses: Loss | None, body: Body | None = None
) -> None:
    """Check that the page includes friction and losses if needed, and that SI coefficients suit the body."""
    if losses is not None:
        checked_law(losses, body)
    if body is not None:
        check_contact_scale(contact, body.scale)
    if not friction and (losses is not None or not isinstance(contact, str)):
        raise ValueError("friction = False: a law of friction or losses need friction=True")


def check_bounces(friction: bool, contact: AnyContact, restitution: float | None) -> None:
    """Raise ValueError for a restitution on a page without friction, or with a contact patch."""
    if not friction and restitution is not None:
        raise ValueError("friction = False: a restitution needs friction=True")
    if restitution is not None and has_patch(contact):
        raise ValueError(
            f"restitution = {restitution}: expected None, since the contact has a patch, {contact!r}"
        )


def check_circles(told: dict[str, Any], contact: AnyContact) -> None:
    """Raise ValueError for a frustum whose contact has no law of friction, or has a patch."""
    if "height" in told and (isinstance(contact, str) or has_patch(contact)):
        why = "a page moves a frustum with friction at a point: give sc.Coulomb(mu) or sc.Viscous(c)"
        raise ValueError(f"contact = {contact!r}: {why}")


def check_table(friction: bool, table: Table | None) -> None:
    """Raise ValueError for a slope on a page without friction."""
    if not friction and table is not None and table.slope != 0:
        raise ValueError("friction = False: a slope needs friction=True")
