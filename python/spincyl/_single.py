"""Check for a single body."""

from spincyl._body import Body
from spincyl._input.numbers import instance_of, is_scalar


def one_body(body: object) -> Body:
    """Return `body` if it is a single body, else raise TypeError or ValueError."""
    found = instance_of("body", body, Body)
    if not is_scalar(*found._numbers):
        raise ValueError("body: expected a single body, not a family")
    return found
