"""Measured outputs of a motion: their columns and units, and the same outputs of a computed motion."""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from spincyl._input.numbers import Floats, reals, si
from spincyl._motion import Motion
from spincyl._scale import si_factor
from spincyl.lab._slopes import Sloped, slopes_at
from spincyl.lab._vary import Placed

#: Unit of each output that can be measured, and pint's name for the unit of its columns.
OUTPUTS = {
    "theta": ("rad", "radian"),
    "phi": ("rad", "radian"),
    "psi": ("rad", "radian"),
    "w": ("sqrt(g/R)", "radian/second"),
    "precession": ("sqrt(g/R)", "radian/second"),
    "spin": ("sqrt(g/R)", "radian/second"),
    "hertz": ("sqrt(g/R)", "hertz"),
    "height": ("R", "metre"),
    "contact_point": ("R", "metre"),
    "centre": ("R", "metre"),
    "x": ("R", "metre"),
    "y": ("R", "metre"),
    "z": ("R", "metre"),
}
_POSE = {"phi", "psi", "contact_point", "centre", "x", "y", "z"}
_WIDE = {"w": (3,), "contact_point": (2,), "centre": (2, 3)}
_TURNS = {"phi", "psi"}  #: a measured angle has no whole turns
_FASTEST = 2.0  #: Radians from row to row up to which turns are counted.


class Measured(NamedTuple):
    """A measured motion in natural units, with one column for each component of an output."""

    t: Floats  #: (n,) ascending
    order: Any  #: order of the rows of the table by time
    values: dict[str, Floats]  #: (n, components), NaN where missing
    errors: dict[str, Floats]  #: the same shapes
    estimated: tuple[str, ...]
    factor: dict[str, float]  #: from natural units to those of the user
    followed: frozenset[
        str
    ]  #: angles of turning that change so little from row to row that turns are counted
    sloped: Sloped | None = None  #: how the precession is a slope of phi over frames, if it is one

    @property
    def wants(self) -> frozenset[Any]:
        """The optional outputs of `roll` that are needed to compute the measured outputs."""
        return frozenset({"pose"} if _POSE & set(self.values) or self.sloped else ())

    @property
    def times(self) -> Floats:
        """All times at which a motion is needed: the times of the rows, then of the frames of slopes."""
        return self.t if self.sloped is None else np.r_[self.t, self.sloped.t]

    def correlation(self) -> Floats | None:
        """Correlation of the errors of the values, in the order of the residuals; None without slopes."""
        if self.sloped is None:
            return None
        seen = {name: np.isfinite(x) for name, x in self.values.items()}
        found = np.eye(sum(int(x.sum()) for x in seen.values()))
        first = 0
        for name, x in seen.items():
            many = int(x.sum())
            if name == "precession":
                found[first : first + many, first : first + many] = self.sloped.correlation(x[:, 0])
            first += many
        return found


def measured_motion(guess: Motion, table: Any, errors: Mapping[str, Any] | None) -> Measured:
    """Check a table of measured outputs and their errors, and convert them to natural units."""
    if not hasattr(table, "keys"):
        raise TypeError(f"measured: expected a table or a dict with columns, not {type(table).__name__}")
    units: dict[str, str] = getattr(table, "units", {})
    names = [name for name in table.keys() if name != "t"]  # noqa: SIM118
    if "t" not in table:
        raise ValueError("measured: expected a column 't' of times")
    for name in names:
        if name not in OUTPUTS:
            raise ValueError(
                f"measured: {name!r} is not an output of a motion; expected {', '.join(OUTPUTS)}"
            )
    if not names:
        raise ValueError(f"measured: expected a column besides 't', one of {', '.join(OUTPUTS)}")
    if "hertz" in names and guess.scale is None:
        raise ValueError("measured: 'hertz' needs a measured body; for any other body give 'precession'")
    second, _ = si_factor("sqrt(R/g)", guess.scale)
    t = _column("t", table["t"], units.get("t", ""), "second") / (second or 1.0)
    if t.ndim != 1 or not np.isfinite(t).all() or not t.size:
        raise ValueError("measured: 't' has to be a list of finite times")
    order = np.argsort(t, kind="stable")
    values, factors = {}, {}
    for name in names:
        natural, unit = OUTPUTS[name]
        factor = (si_factor(natural, guess.scale)[0] or 1.0) / (2 * math.pi if name == "hertz" else 1.0)
        column = _column(name, table[name], units.get(name, ""), unit) / factor
        wide = column.reshape(t.size, -1) if column.shape[:1] == t.shape else column
        if column.shape[:1] != t.shape or wide.shape[1] not in _WIDE.get(name, (1,)) or column.ndim > 2:
            raise ValueError(f"measured: {name!r} has shape {column.shape}; expected {t.size} rows, as 't'")
        if np.isinf(wide).any():
            raise ValueError(f"measured: {name!r} has an infinite value")
        values[name], factors[name] = wide[order], factor
    followed = frozenset(name for name in _TURNS & set(values) if _count_turns(values[name][:, 0]))
    if errors is not None and not isinstance(errors, Mapping):
        raise TypeError(f"errors: expected a dict with errors by name, not {type(errors).__name__}")
    given = {} if errors is None else dict(errors)
    found = {}
    for name in given:
        if name not in names:
            raise ValueError(f"errors: {name!r} is not among the measured outputs, {', '.join(names)}")
    for name, column in values.items():
        if name in given:
            one = np.asarray(
                reals(f"errors[{name!r}]", si(f"errors[{name!r}]", given[name], OUTPUTS[name][1]))
            )
            one = one[order, np.newaxis] if one.shape == t.shape else one[order] if one.ndim else one
            fit = (one > 0) & (one < np.inf) | ~np.isfinite(column)  # a missing value needs no error
            if not fit.all():
                raise ValueError(f"errors[{name!r}]: expected positive numbers")
            found[name] = np.broadcast_to(one / factors[name], column.shape)
        else:
            spread = float(np.nanstd(column)) if np.isfinite(column).any() else 0.0
            found[name] = np.full(column.shape, 0.1 * spread or 1.0)
    left = tuple(name for name in values if name not in given)
    sloped = slopes_at(table["precession"], t[order], second or 1.0) if "precession" in names else None
    if sloped is not None:  # a slope beside a gap is none, whatever number stands there
        values["precession"][np.isnan(sloped.weights).any(axis=1)] = np.nan
    return Measured(t[order], order, values, found, left, factors, followed, sloped)


def _count_turns(angle: Floats) -> bool:
    """Add whole turns to an angle, in place, if it changes by less than 2 rad from row to row."""
    seen = np.isfinite(angle)
    whole = np.unwrap(angle[seen])
    if np.abs(np.diff(whole)).max(initial=0.0) > _FASTEST:
        return False
    angle[seen] = whole
    return True


def _column(name: str, values: Any, written: str, unit: str) -> Floats:
    """A column in SI; `written` is the unit in the head of a table."""
    factor = 1.0
    if written:
        text = "1" + {"1/s": "Hz", "hz": "Hz"}.get(written.lower(), written)
        if unit == "radian/second" and text == "1Hz":
            raise ValueError(f"measured: {name!r} is in {written}; call turns per second 'hertz'")
        factor = float(si(f"measured: {name!r}", text, unit))
    return factor * np.asarray(reals(f"measured: {name!r}", values), np.float64)


def outputs_at(placed: Placed, data: Measured, at: Any) -> dict[str, Floats]:
    """The outputs of a computed motion at the measured times; after its end they keep their last values.

    `at` has the rows of the motion at all times of `data.times`.
    """
    m = placed.motion
    every = np.minimum(at, m.t.size - 1)
    rows = every[: data.t.size]
    cos, sin = math.cos(placed.phi0), math.sin(placed.phi0)
    found = {}
    for name in data.values:
        if name == "precession" and data.sloped is not None:
            # before its start and after its end the motion has its first and last precession
            rate, late = m.states.precession, data.sloped.t - m.t[every[data.t.size :]]
            phi = m.phi[every[data.t.size :]] + rate[every[data.t.size :]] * late
            found[name] = data.sloped.of(phi)[:, np.newaxis]
            continue
        if name in ("precession", "spin", "hertz"):
            column = getattr(m.states, "spin" if name == "spin" else "precession")
        elif name in ("x", "y", "z", "centre", "contact_point"):
            path = m.contact_point if name == "contact_point" else m.centre
            flat = path[:, :2] @ np.array([[cos, sin], [-sin, cos]]) + placed.place
            path = np.column_stack([flat, path[:, 2:]])
            column = path[:, "xyz".index(name)] if len(name) == 1 else path[:, : data.values[name].shape[1]]
        else:
            column = getattr(m, name) + (placed.phi0 if name == "phi" else 0.0)
        found[name] = np.asarray(column, np.float64).reshape(m.t.size, -1)[rows]
    return found


def off_by(data: Measured, shown: dict[str, Floats]) -> dict[str, Floats]:
    """Measured minus computed outputs; whole turns are removed from the differences of angles of rotation."""
    found = {}
    for name, column in data.values.items():
        off = column - shown[name]
        if name in data.followed:
            first = off[np.isfinite(off)][:3]  # where the turns have not yet added up
            off = off - 2 * math.pi * np.round(np.median(first) / (2 * math.pi)) if first.size else off
        elif name in _TURNS:
            off = (off + math.pi) % (2 * math.pi) - math.pi
        found[name] = off
    return found
