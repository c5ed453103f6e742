"""Stones with weights fixed to them."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from spincyl._input.numbers import Floats, number, si, warn

_Stone = TypeVar("_Stone", bound=Any)


def weighted(stone: _Stone, weights: Iterable[Any]) -> _Stone:
    """Add point masses to a stone; see `Ellipsoid.with_weights`."""
    if np.ndim(stone.semi_axes) != 1:
        raise ValueError("with_weights: expected a single stone, not a family")
    scale = stone.scale
    if scale is not None and math.isnan(scale.mass):
        raise ValueError("with_weights: the mass of the stone is unknown; give it by in_metres(mass=)")
    size, kilograms = (1.0, 1.0) if scale is None else (scale.radius, scale.mass)
    found = [_mass_and_place(i, each, scale is not None) for i, each in enumerate(_as_list(weights))]
    if not found:
        return stone
    axes, offset = np.asarray(stone.semi_axes), np.asarray(stone.offset)
    bodies = [(1.0, offset, np.asarray(stone.inertia))]
    for i, (mass, place) in enumerate(found):
        place = place / size
        if np.sum((place / axes) ** 2) > 1 + 1e-9:
            warn(f"weights[{i}]: the weight is outside the ellipsoid, and may strike the table")
        bodies.append((mass / kilograms, place, np.zeros((3, 3))))
    whole = math.fsum(mass for mass, *_ in bodies)
    centre = sum(mass * place for mass, place, _ in bodies) / whole
    inertia = sum(mass * (own + _moments_about_centre(place - centre)) for mass, place, own in bodies) / whole
    scale = None if scale is None else replace(scale, mass=whole * kilograms)
    # the constructor's warning about mass outside the ellipsoid is only for moments given by the user
    return replace(stone, inertia=inertia, offset=centre, scale=scale, _doubted=True)


def _moments_about_centre(r: Floats) -> Floats:
    """Tensor of inertia about the origin of a unit point mass at the vector `r`."""
    return np.asarray(r @ r * np.eye(3) - np.outer(r, r))


def _as_list(weights: Iterable[Any]) -> list[Any]:
    try:
        return list(weights)
    except TypeError:
        kind = type(weights).__name__
        raise TypeError(f"weights: expected a list of (mass, (x, y, z)), not {kind}") from None


def _mass_and_place(i: int, given: Any, measured: bool) -> tuple[float, Floats]:
    """Check the element `i` of the list `weights`; return its mass and its position."""
    name = f"weights[{i}]"
    if not isinstance(given, Sequence) or isinstance(given, str) or len(given) != 2:
        raise TypeError(f"{name}: expected (mass, (x, y, z)), not {given!r}")
    mass, place = given
    if isinstance(place, str) or not np.iterable(place) or len(list(place)) != 3:
        raise TypeError(f"{name}: expected a position (x, y, z), not {place!r}")
    if measured:
        mass = si(f"{name} mass", mass, "kilogram")
        place = [si(f"{name} place", x, "metre") for x in place]
    mass = number(f"{name} mass", mass)
    at = np.array([number(f"{name} place", x) for x in place])
    if not (0 < mass < math.inf):
        raise ValueError(f"{name} mass = {mass!r}: expected a positive number")
    if not np.isfinite(at).all():
        raise ValueError(f"{name} place = {at!r}: expected finite numbers")
    return mass, at
