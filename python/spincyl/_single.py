"""Check for a single body."""

from spincyl._body import Body
from spincyl._input.numbers import instance_of


def one_body(body: object) -> Body:
    """Return `body` if it is a single body, else raise TypeError or ValueError."""
    found = instance_of("body", body, Body)
    if not found._single:
        raise ValueError("body: expected a single body, not a family")
    return found
