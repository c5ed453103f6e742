"""Of parameters that catch the same errors the first few are tried in `make test`, and all in `make long`."""

import pytest


def few(values, first):
    """The values, of which all but the first ones are marked as long."""
    given = [value if isinstance(value, tuple) else (value,) for value in values]
    return [pytest.param(*value, marks=[pytest.mark.long] * (k >= first)) for k, value in enumerate(given)]
