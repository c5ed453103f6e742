"""The words for what a table does, and their codes in the core."""

from typing import Literal, TypeAlias

Contact: TypeAlias = Literal["rolling", "smooth"]

#: The code of each, as in the core's `Contact`.
CODES = {"rolling": 0, "smooth": 1}


def code(contact: object) -> int:
    """The code of a contact, or ValueError."""
    if not isinstance(contact, str) or contact not in CODES:
        raise ValueError(f"contact = {contact!r}: expected 'rolling' or 'smooth'")
    return CODES[contact]


def rolls(contact: object) -> bool:
    """Whether the contact rolls rather than slides, or ValueError."""
    return code(contact) == CODES["rolling"]
