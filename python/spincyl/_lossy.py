"""Checks of the arguments of motions with losses."""

from typing import Any

import numpy as np

from spincyl._input.numbers import Floats, is_scalar
from spincyl._loss import made_law

_WHY = {
    "step": "the motion has steps of its own, tol= is their error",
    "method": "there are no first integrals, the motion is found by steps, tol= is their error",
}


def check(losses: object, times: Floats, t0: float, settings: dict[str, Any]) -> None:
    """Refuse arguments that exclude losses; `settings` are those that were given, by name."""
    if not is_scalar(*made_law(losses)._coefficients):
        raise ValueError(
            f"losses = {losses!r}: expected single numbers, not arrays of them; sc.drift takes these"
        )
    for name in filter(settings.__contains__, _WHY):
        raise ValueError(f"{name} = {settings[name]!r} does not go with losses={losses!r}: {_WHY[name]}")
    if np.any(times < t0):
        raise ValueError(
            f"t = {float(times[times < t0][0])!r}: expected times from the start on, t0 = {t0!r};"
            " what is lost does not come back"
        )
