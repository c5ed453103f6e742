"""The circles on which a body of revolution can stand, and the numbers of the one that touches the table."""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from typing import Any, ClassVar, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from spincyl import _core
from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import (
    Floats,
    Reals,
    common_shape,
    floats,
    number,
    numbered,
    read_only_copy,
    reals,
    si,
    warn,
    whole,
)

_Six: TypeAlias = tuple[Reals, Reals, Reals, Reals, Reals, Reals]
#: The fields of a body as numbers, in the order in which the compiled core takes them.
FIELDS = ("ell", "i1", "i3", "bore", "fillet", "theta_end")
_MOMENTS = ("i1", "i3")
_MOST_ROOTS = 5  # of a law on one circle
#: The columns of radius, height and fillet of each circle in a sweep.
CIRCLE_COLUMNS = [[f"{name}{k}" for name in ("radius", "height", "fillet")] for k in range(8)]


@compared_by_value
class Apex(NamedTuple):
    """Rolling of a body on two circles round its apex, the point where its axis meets the table.

    Attributes
    ----------
    radius : float
        Radius of the circle of the centre of mass about the apex, in R; infinite for two equal circles, on
        which the body rolls straight on.
    rate : float
        Precession rate at which the narrow end rises, in sqrt(g/R): infinite for two equal circles, NaN if
        the body does not rest on both.
    friction : float
        Ratio of friction to normal force at this rate. With a smaller coefficient of friction the body slips
        outward before the narrow end rises.
    """

    radius: float
    rate: float
    friction: float


class Circles:
    """Base of `Laws`: properties and methods about the circles on which a body can stand."""

    ell: Reals
    i1: Reals
    i3: Reals
    bore: Reals
    fillet: Reals
    theta_end: Reals
    rims: Any
    _borders: ClassVar[Any] = None  # of bodies with `rims`: where the next circle lands

    @property
    def circles(self) -> Floats:
        """(n, 3) the circles on which a single body can stand, from its lower end up.

        Each row has the radius of the circle, its height above the centre of mass (negative below it), and
        its fillet, in R. A tip is a circle of radius 0, a ball one of radius 0 with a fillet.
        """
        return self._told()[0]

    @property
    def borders(self) -> Floats:
        """(n - 1,) inclinations, in radians, at which the body passes from each circle to the next one."""
        return self._told()[1][:, 0].copy()

    @property
    def spans(self) -> Floats:
        """(n - 1,) distances, in R, between neighbouring circles where both touch the table, at `borders`.

        A distance of 0 is a smooth joint, as between a ball and the edge at which it is cut: the
        contact passes on without an impact.
        """
        return self._told()[1][:, 1].copy()

    @property
    def smooth(self) -> NDArray[np.bool_]:
        """(n - 1,) whether the body passes from each circle to the next without an impact: `spans` is 0."""
        found: NDArray[np.bool_] = self.spans == 0
        return found

    def apex(self, k: int = 0) -> Apex:
        """Rolling of the body round its apex, the point where its axis meets the table, on two circles.

        Parameters
        ----------
        k : int
            Index of the first of the two circles in `circles`, from 0; the second one is k + 1.

        Raises
        ------
        ValueError
            If there are no such circles, or if `smooth` is true for them.

        Examples
        --------
        >>> import spincyl as sc
        >>> sc.Body.cone(2.0).apex().radius.round(6)
        np.float64(1.341641)
        """
        told = self._told()[1]
        if not len(told):
            raise ValueError(f"k = {k!r}: the body has a single circle; an apex needs two, k and k + 1")
        row = told[whole("k", k, 0, len(told) - 1)]
        if row[1] == 0:
            raise ValueError(f"k = {k}: circles {k} and {k + 1} meet smoothly; no body can lie on both")
        return Apex(*row[2:5])

    def rests(self) -> tuple[int, ...]:
        """All indices k for which the body can lie at rest on the circles k and k + 1 of `circles`."""
        return tuple(np.flatnonzero(self._told()[1][:, 5]).tolist())

    def _told(self) -> tuple[Floats, Floats]:
        """`circles` of a single body, (n, 3); border, span, the three of `Apex` and `rests`, (n - 1, 6)."""
        numbers = self._raw
        if np.ndim(self.rims) > 2 or any(np.ndim(x) for x in numbers):
            raise ValueError("body: expected a single body, not a family; `rims` has the circles of a family")
        rows, borders = _core.body_circles([float(x) for x in numbers], self._rows)
        return np.array(rows), np.array(borders).reshape(-1, 6)

    @property
    def _raw(self) -> _Six:
        """The six numbers of `FIELDS`; for several circles those of the lowest, with bore = -(its radius)."""
        bore = self.bore if self.rims is None else -self.rims[..., 0, 0]
        return self.ell, self.i1, self.i3, bore, self.fillet, self.theta_end

    @property
    def _rows(self) -> list[list[float]]:
        """The circles of a single body as a list of rows for the core; empty if the body has no `rims`."""
        return [] if self.rims is None else self.rims.tolist()

    @property
    def _numbers(self) -> _Six:
        """The six numbers of `FIELDS`; for several circles those of the lowest, until the next circle lands.

        If the outer radius of the lowest circle is not 1, ValueError is raised.
        """
        if self.rims is None:
            return self._raw
        if np.any(self.rims[..., 0, 0] + self.rims[..., 0, 2] != 1):
            several = f"not {self.rims.shape[-2]} circles (body.circles)"
            raise ValueError(f"body: expected one circle or two equal rims, {several}")
        # pi/2 itself stands for two equal rims
        end: Any = np.where(floats(self.theta_end) == np.pi / 2, np.nextafter(np.pi / 2, 0), self.theta_end)
        return self.ell, self.i1, self.i3, np.nan, self.fillet, end[()]

    def _at(self, theta: Reals, *w: Reals, rim: Any = None) -> tuple[Any, ...]:
        """Return theta, `w` (w1, w2, w3 and slip, if given), and the six numbers of the circle on the table.

        All refer to the end of the body that is nearer to the table. `rim` is the index of the circle;
        default: the circle that touches the table at theta.
        """
        if self.rims is None:
            return theta, *w, *self._raw
        at = floats(theta)
        shape = np.broadcast_shapes(at.shape, np.shape(self.i1), np.shape(self.i3), self.rims.shape[:-2])
        borders = np.broadcast_to(self._borders, (*shape, self._borders.shape[-1]))
        k = (borders < np.broadcast_to(at, shape)[..., np.newaxis]).sum(-1) if rim is None else rim
        k = np.broadcast_to(np.asarray(k, np.int64), shape)[..., np.newaxis]
        rows = np.broadcast_to(self.rims, (*shape, *self.rims.shape[-2:]))
        radius, height, fillet = np.moveaxis(
            np.take_along_axis(rows, k[..., np.newaxis], -2)[..., 0, :], -1, 0
        )
        edges = np.concatenate([np.zeros((*shape, 1)), borders, np.full((*shape, 1), np.nan)], -1)
        low, high = (np.take_along_axis(edges, k + i, -1)[..., 0] for i in (0, 1))
        over = at > np.pi / 2
        sign = np.where(over, -1.0, 1.0)
        seen = np.where(over, np.pi - at, at)
        end = np.where(over, np.pi - low, np.where(np.isnan(high), np.pi, high))
        turned = (x if i == 0 else sign * x for i, x in enumerate(w))
        numbers = -sign * height, self.i1, self.i3, -radius, fillet, end
        return tuple(np.asarray(x)[()] for x in (seen, *turned, *numbers))

    def _several(self, law: Any, *inputs: Reals) -> Any:
        """Inclinations that `law` finds on all circles, ascending; NaN where a circle is off the table."""
        if self.rims is None:
            return law(*numbered(self._most, *inputs, *self._raw))
        found: list[Floats] = []
        for k in range(self.rims.shape[-2]):
            low = self._borders[..., k - 1 : k] if k else 0.0
            high = self._borders[..., k : k + 1] if k + 1 < self.rims.shape[-2] else np.nan
            for end in (0.0, np.pi):  # the circle as seen from either end of the body
                seen = law(*numbered(_MOST_ROOTS, *inputs, *self._at(end, rim=k)[1:]))
                near = seen <= np.pi / 2 if end == 0 else seen < np.pi / 2
                told = np.abs(end - seen)
                inside = near & (told > low) & ~(told > high)
                found.append(np.where(inside, told, np.nan))
        return np.sort(np.concatenate(np.broadcast_arrays(*found), -1), -1)

    @property
    def _most(self) -> int:
        raise NotImplementedError

    def _sign(self, theta: Reals) -> Any:
        """Sign that `_at` gives to components along e_h, e2, e3: -1 beyond pi/2 if `rims` is set, else 1."""
        return 1.0 if self.rims is None else np.where(floats(theta) > np.pi / 2, -1.0, 1.0)


def rows_of(name: str, given: Iterable[Sequence[float]], *widths: int, metre: str = "") -> list[list[float]]:
    """Return rows of numbers, each of a length in `widths`; texts such as "2cm" are converted to `metre`."""
    try:
        rows = [list(row) for row in given]
    except TypeError:
        raise TypeError(f"{name}: expected rows of numbers, not {type(given).__name__}") from None
    if not rows or any(len(row) not in widths for row in rows):
        raise ValueError(f"{name}: expected rows of {' or '.join(map(str, widths))} numbers")
    return [[number(name, si(name, x, metre) if metre else x) for x in row] for row in rows]


def set_rims(body: Any) -> None:
    """Check the field `rims` of a new body, and set all its fields; `rims` becomes None if it is not needed.

    The circles of a single body may turn out to be one circle or two equal rims.
    """
    given, moments = floats(reals("rims", body.rims)), [reals(name, getattr(body, name)) for name in _MOMENTS]
    if given.ndim < 2 or given.shape[-1] != 3 or not given.shape[-2]:
        raise ValueError("rims: expected rows of radius, height and fillet, an array (..., n, 3)")
    six: Any
    rims: Any
    borders: Any
    shape = common_shape(dict(zip((*_MOMENTS, "rims"), (*moments, given[..., 0, 0]), strict=True)))
    if shape:
        six, rims, borders = _family(given, [floats(x) for x in moments], shape)
    else:
        (six, rows), in_line = _core.check_profile(given.tolist(), *map(float, moments))
        rims, borders = (np.array(rows), borders_of(six, rows)) if rows else (None, None)
        if in_line:
            warn(
                "circles: a circle in line with two others is left out; its share of the load is undetermined"
            )
    for name, of_circle in zip(FIELDS, six, strict=True):
        own = np.nan if name == "bore" and rims is not None else of_circle
        value, unsaid = np.asarray(getattr(body, name)), 0.0 if name == "fillet" else np.nan
        if np.any((value != own) & ~np.isnan(value) & ~np.isnan(own) & (value != unsaid)):
            why = "that of the lowest circle in `rims`; to change it, change `rims` or give rims=None"
            raise ValueError(f"{name} = {getattr(body, name)!r}: expected {own!r}, {why}")
        object.__setattr__(body, name, read_only_copy(own if shape else float(own)))
    for name, value in (("rims", rims), ("_borders", borders)):
        object.__setattr__(body, name, None if value is None else read_only_copy(value))
    object.__setattr__(body, "_single", not shape)


def borders_of(six: list[float], rows: list[list[float]]) -> Floats:
    """Inclinations, in radians, at which a body passes from each of its circles to the next one."""
    return np.array([row[0] for row in _core.body_circles(six, rows)[1]])


def _family(given: Floats, moments: list[Floats], shape: tuple[int, ...]) -> Any:
    """Fields, circles and borders of a family of bodies, as arrays; NaN for impossible bodies."""
    most = given.shape[-2]
    found, rims = np.full((*shape, len(FIELDS)), np.nan), np.full((*shape, most, 3), np.nan)
    borders, given = np.full((*shape, most - 1), np.nan), np.broadcast_to(given, rims.shape)
    i1, i3 = (np.broadcast_to(x, shape) for x in moments)
    for at in np.ndindex(shape):
        with suppress(ValueError):
            (six, rows), _ = _core.check_profile(given[at].tolist(), float(i1[at]), float(i3[at]))
            ends = borders_of(six, rows)
            rows = rows or _core.body_circles(six, [])[0]
            found[at], rims[at][: len(rows)], borders[at][: len(ends)] = six, rows, ends
    found[..., FIELDS.index("bore")] = np.nan
    return list(np.moveaxis(found, -1, 0)), rims, borders


def columns_of_circles(bodies: Any) -> dict[str, Reals]:
    """Circles of bodies with `rims`, as a dict of columns radius0, height0, fillet0, radius1 and so on."""
    if bodies.rims is None:
        return {}
    rows = np.moveaxis(bodies.rims, (-2, -1), (0, 1))
    names = CIRCLE_COLUMNS[: len(rows)]
    return {
        name: x
        for row, columns in zip(rows, names, strict=True)
        for name, x in zip(columns, row, strict=True)
    }


def extent_of(rims: Floats) -> tuple[float, float]:
    """Length and width, in R, of a single body with these circles (rows of radius, height and fillet)."""
    radius, height, fillet = rims.T
    return float((height + fillet).max() - (height - fillet).min()), float(2 * (radius + fillet).max())


def circle_of(body: Circles, rim: Any) -> tuple[Any, Any]:
    """Radius and fillet, in R, of those circles of a single body whose indices are in `rim`."""
    if body.rims is None:
        return 1.0 - floats(body.fillet), body.fillet
    radius, _, fillet = np.moveaxis(body.rims[rim], -1, 0)
    return radius, fillet


def circles_at(body: Any, theta: Floats) -> NDArray[np.uint8]:
    """Index of the circle on which a single body stands at each inclination; 0 if the body has no `rims`."""
    found = np.zeros(theta.size, np.uint8)
    if getattr(body, "rims", None) is not None:
        found += (body._borders < theta[:, np.newaxis]).sum(-1).astype(np.uint8)
    return found


def lowest_point_of(body: Circles, theta: Floats, rim: Any) -> Any:
    """Height, in R, of a body's lowest point above the lowest point of its circle `rim`; 0 or less."""

    def centre(circles: Any) -> Any:
        return _core.circle_height(theta, *np.moveaxis(body.rims[circles], -1, 0))

    return centre(rim) - centre((body._borders < theta[..., np.newaxis]).sum(-1))
