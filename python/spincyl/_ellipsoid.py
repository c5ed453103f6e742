"""Stones: ellipsoids with any inertia, such as a rattleback or an egg, their state and their motion."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, ClassVar, Self

import numpy as np

from spincyl import _core
from spincyl._contact import AnyContact, Coulomb, Viscous, code_of
from spincyl._ellipsoid_rows import SIX, by_blocks, checked_rows, row_parts, rows_by, six_of_tensor
from spincyl._ellipsoid_starts import StoneStarts, tilt_of_stone
from spincyl._ellipsoid_state import EllipsoidState, Rocking, as_doubles, as_vectors
from spincyl._input.equality import compared_by_value
from spincyl._input.hints import with_hints
from spincyl._input.numbers import (
    Floats,
    Reals,
    Result,
    common_shape,
    components,
    instance_of,
    lengths_in_metres,
    read_only_copy,
    reals,
    refuse_bad_value,
    warn,
)
from spincyl._input.reprs import is_lazy
from spincyl._scale import Scale
from spincyl._slip import rise_of_stone
from spincyl._weights import weighted

#: Smallest ratio of the moments of a stone without an edge to those of a uniform ellipsoid. For lead in foam
#: of a hundredth of its density the ratio is at least a quarter.
_LEAST = 0.05


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Ellipsoid(StoneStarts):
    """An ellipsoid with any inertia on a table, called a stone: a rattleback, an egg, a pebble.

    In natural units the mass M, gravity g and the largest semi-axis a are 1. Lengths may be given in any one
    unit. Arrays, which broadcast over their leading axes, make a family of stones; all fields get the shape
    of the family. An impossible stone of a family is NaN, and `Status.INVALID` in a sweep. Dask arrays make a
    lazy family. A sweep of it is lazy; all other methods compute it at once.

    Parameters
    ----------
    semi_axes : array_like, (..., 3)
        Semi-axes of the ellipsoid, in any unit of length. A stone that is only the lower half of an ellipsoid
        has its whole depth as third semi-axis. Each semi-axis is at least a millionth of the largest.
    inertia : array_like, (..., 3, 3) or (..., 3)
        Tensor of inertia about the centre of mass, along the axes of the ellipsoid, divided by the mass; its
        unit is the unit of the semi-axes squared. Three numbers are the diagonal of the tensor. An array of
        shape (3, 3) is one tensor. Each principal moment is at most the sum of the two others. The sum of the
        moments of a stone without an edge (`theta_end`) is at least a twentieth of that of a uniform
        ellipsoid; moments in kg m^2 have to be divided by the mass.
    offset : array_like, (..., 3), optional
        Vector from the centre of the ellipsoid to the centre of mass, which lies inside, in the unit of the
        semi-axes. Default: zero.
    theta_end : array_like, optional
        Inclination of axis 3 at which an edge of the stone lands, in radians, in (0, pi]. NaN (the default):
        there is no edge.
    scale : Scale, optional
        Size, mass and gravity; the radius is the largest semi-axis. Motions are then in SI. See `in_metres`.

    Raises
    ------
    ValueError
        If a single stone is impossible; the message names the number or gives the principal moments.
    TypeError
        If an argument is not real-valued; the message names it.

    Warns
    -----
    UserWarning
        If the moments of inertia are so large that part of the mass must lie outside the ellipsoid. If some
        of a family are too small for an ellipsoid of any materials.

    Notes
    -----
    Equations of rolling: Kane and Levinson, Int. J. Non-Linear Mech. 17, 175 (1982); docs/stones.md.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> inertia = [[0.02, -0.012, 0], [-0.012, 0.2, 0], [0, 0, 0.21]]
    >>> stone = sc.Ellipsoid((1.0, 0.3, 0.2), inertia, offset=(0, 0, -0.07))
    >>> stone.growth_rates([-0.6, 0.6]).max(axis=1).round(4).tolist()  # one way it turns back much sooner
    [0.4064, 0.1355]
    >>> m = sc.roll(stone, stone.spinning(-0.6, pitch=0.02), np.linspace(0, 20, 201))
    >>> bool(m.spin[0] < 0 < m.spin[-1])
    True
    """

    semi_axes: Reals
    inertia: Reals
    offset: Reals = (0.0, 0.0, 0.0)
    theta_end: Reals = math.nan
    scale: Scale | None = field(default=None, kw_only=True)
    # largest semi-axis in the unit of the lengths that the constructor was given; a copy keeps it
    _unit: Any = field(default=1.0, kw_only=True, repr=False, compare=False)
    # whether a warning about the moments has been issued
    _doubted: bool = field(default=False, kw_only=True, repr=False, compare=False)
    _length: ClassVar[str] = "a"
    _in_files: ClassVar[str] = "stone"  # what it is called in files

    def __post_init__(self) -> None:
        self._check_scale()
        axes = as_vectors("semi_axes", self.semi_axes, 3)
        inertia = as_doubles(reals("inertia", self.inertia))
        if inertia.shape[-2:] != (3, 3) or inertia.ndim < 2:
            inertia = as_vectors("inertia", inertia, 3)[..., None] * np.eye(3)
        offset = as_vectors("offset", self.offset, 3)
        theta_end = as_doubles(reals("theta_end", self.theta_end)).reshape(np.shape(self.theta_end))
        lead = {"semi_axes": axes[..., 0], "inertia": inertia[..., 0, 0], "offset": offset[..., 0]}
        common_shape(lead | {"theta_end": theta_end})
        rows = by_blocks(checked_rows, "(i),(j,k),(l),()->(m)", 18, axes, inertia, offset, theta_end)
        *fields, unit, reach = row_parts(rows)
        if not self._doubted and not is_lazy(reach) and np.any(reach > 1 + 1e-9):
            object.__setattr__(self, "_doubted", True)
            most = f"{float(np.nanmax(reach)):.3g} times the largest inertia of a mass inside the ellipsoid"
            warn(f"inertia: {most}; expected inertia per mass, in the unit of the semi-axes squared")
        self._refuse_small(*fields)
        for name, value in zip(("semi_axes", "inertia", "offset", "theta_end"), fields, strict=True):
            object.__setattr__(self, name, read_only_copy(value))
        object.__setattr__(self, "_unit", self._unit * unit)

    def _refuse_small(self, axes: Any, inertia: Any, offset: Any, theta_end: Any) -> None:
        """Raise ValueError for moments that no whole ellipsoid has; a family gets a warning.

        A stone with an edge may be a small part of its ellipsoid.
        """
        if self._doubted or any(map(is_lazy, (axes, inertia, theta_end))):
            return
        uniform = 0.4 * np.sum(np.square(axes), axis=-1)
        share = np.where(np.isnan(theta_end), np.trace(inertia, axis1=-2, axis2=-1) / uniform, np.nan)
        if np.any(share < _LEAST):
            least = f"{float(np.nanmin(share)):.2g} of the moments of a uniform ellipsoid"
            why = f"inertia: {least}; expected at least {_LEAST:g} of them (per mass, in the unit of the"
            why += " semi-axes squared, not in kg m^2: divide by the mass in kg)"
            if not share.ndim:
                raise ValueError(why)
            object.__setattr__(self, "_doubted", True)
            warn(why)

    @classmethod
    def _of(cls, make: Callable[..., Any], **given: Any) -> Self:
        """Make a stone, or a family, with a constructor of the core from single numbers or arrays."""
        there = {name: (x, wide) for name, (x, wide) in given.items() if x is not None}
        common_shape({name: x[..., 0] if wide else x for name, (x, wide) in there.items()})
        each = partial(rows_by, make=make, names=tuple(given), wide={name: x[1] for name, x in there.items()})
        inputs = ",".join(f"({name})" if wide else "()" for name, (_, wide) in there.items())
        rows = by_blocks(each, f"{inputs}->(number)", 17, *(x for x, _ in there.values()))
        *numbers, unit = row_parts(rows)
        return cls(*numbers, _unit=unit)

    @classmethod
    def uniform(cls, semi_axes: Reals, *, mass: float | None = None) -> Self:
        """Uniform ellipsoid with these semi-axes, (..., 3): half its length, its width and its height.

        A `mass` in kilograms, or lengths such as "8cm", make a measured stone. Raises the same errors as
        `Ellipsoid`.
        """
        semi_axes, told = lengths_in_metres("semi_axes", semi_axes)
        vectors = as_vectors("semi_axes", semi_axes, 3)
        return cls._of(_core.uniform_stone, semi_axes=(vectors, True))._measured(told, mass)

    @classmethod
    @with_hints
    def rattleback(
        cls,
        semi_axes: Reals,
        *,
        twist: Reals,
        moments: Reals | None = None,
        offset: Reals | None = None,
        mass: float | None = None,
    ) -> Self:
        """Rattleback: an ellipsoid whose principal axes of inertia are rotated against the axes of its shape.

        Parameters
        ----------
        semi_axes : array_like, (..., 3)
            Semi-axes of the whole ellipsoid: half its length, half its width, half its height. The stone
            stands on the end of the third. A stone that is the lower half of an ellipsoid, 16 cm long, 3.2 cm
            wide and 1.4 cm deep, has the semi-axes (0.08, 0.016, 0.014): its depth is the third. Texts such
            as ("8cm", "16mm", "14mm") make a measured stone.
        twist : array_like
            Angle about axis 3 from the axes of the shape to the axes of inertia, in radians, counterclockwise
            as seen from above.
        moments : array_like, (..., 3), optional
            Principal moments of inertia about the centre of mass, divided by the mass. Default: the stone is
            the lower half of a uniform ellipsoid, and its edge lands at an inclination of pi/2.
        offset : array_like, (..., 3), optional
            Vector from the centre of the ellipsoid to the centre of mass. Default: zero with `moments`;
            without them the offset of the lower half, downward by 3/8 of the third semi-axis.
        mass : float, optional
            Mass in kilograms; makes a measured stone, with `semi_axes` in metres. See also `in_metres`.

        Raises
        ------
        ValueError, TypeError
            As for `Ellipsoid`.

        Examples
        --------
        >>> import numpy as np
        >>> import spincyl as sc
        >>> half = {"semi_axes": (0.20, 0.03, 0.02)}  # a stone 40 cm long, 6 cm wide and 2 cm deep
        >>> stone = sc.Ellipsoid.rattleback(**half, twist=np.radians(3)).in_metres(mass=0.3)
        >>> print(f"{stone.growth_rates(-1.0).max() / stone.scale.seconds(1.0):.1f} per second")
        15.4 per second
        """
        semi_axes, told = lengths_in_metres("semi_axes", semi_axes)
        wide = [
            None if x is None else as_vectors(name, x, 3)
            for name, x in (("moments", moments), ("offset", offset))
        ]
        if wide[0] is not None:
            refuse_bad_value("moments", wide[0], lambda x: ~np.isfinite(x), "expected finite numbers")
        found = cls._of(
            _core.rattleback,
            semi_axes=(as_vectors("semi_axes", semi_axes, 3), True),
            moments=(wide[0], wide[0] is not None),
            twist=(tilt_of_stone("twist", twist), False),
            offset=(wide[1], wide[1] is not None),
        )
        return found._measured(told, mass)

    @classmethod
    def egg(
        cls, radius: Reals, half_length: Reals, offset: Reals = 0.0, *, mass: float | None = None
    ) -> Self:
        """Egg: a spheroid about axis 3 with its centre of mass `offset` above its geometric centre.

        The moments of inertia are those of a uniform spheroid; `half_length` is its semi-axis along axis 3.
        Lengths are in any one unit. A `mass` in kilograms, or lengths such as "22mm", make a measured stone.
        Raises the same errors as `Ellipsoid`.
        """
        given = {"radius": radius, "half_length": half_length, "offset": offset}
        given, told = lengths_in_metres("", given)
        found = cls._of(_core.egg, **{name: (as_doubles(reals(name, x)), False) for name, x in given.items()})
        return found._measured(told, mass)

    def with_weights(self, weights: Iterable[Any]) -> Self:
        """Fix point masses to a single stone, such as clay to a rattleback.

        Raises ValueError for a family, and for a measured stone of unknown mass. Warns with UserWarning if a
        weight is outside the ellipsoid.

        Parameters
        ----------
        weights : list of (mass, (x, y, z))
            Mass of each weight, in units of the mass of the stone. Position of the weight from the centre of
            the ellipsoid, along its axes, in units of the largest semi-axis. For a measured stone: kilograms
            and metres, or texts such as "5g" and "12mm".

        Examples
        --------
        >>> import spincyl as sc
        >>> disk = sc.Ellipsoid.uniform((1.0, 1.0, 0.05)).with_weights([(0.2, (1.0, 0.0, 0.0))])
        >>> disk.offset.round(4).tolist()  # from the axis of the disk to its centre of mass
        [0.1667, 0.0, 0.0]
        """
        return weighted(self, weights)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the family; () for a single stone."""
        a, i, d, end = (np.shape(x) for x in (self.semi_axes, self.inertia, self.offset, self.theta_end))
        return np.broadcast_shapes(a[:-1], i[:-2], d[:-1], end)

    @property
    def moments(self) -> Floats:
        """Principal moments of inertia about the centre of mass, (..., 3), in M a^2, ascending."""
        return self._each(lambda x: _core.stone_moments(x), 3)

    def rocking(self, spin: Reals | None = None, *, hertz: Reals | None = None) -> Rocking:
        """Rocking modes of the stone as it spins upright with its contact point at rest.

        Parameters
        ----------
        spin : array_like
            Angular velocity about the vertical in sqrt(g/a), up to 1e6; broadcasts with a family.
        hertz : array_like
            Turns per second about the vertical, in place of `spin`; needs a measured stone.

        Returns
        -------
        Rocking
            Growth rates and frequencies of both modes, and the four eigenvalues, with errors below 1e-13 of
            the largest eigenvalue. NaN for a stone of a family that cannot spin upright.

        Raises
        ------
        ValueError
            If axis 3 of a single stone is not a principal axis, or does not pass through its centre of mass.
        """
        rates = np.asarray(self._spin(spin, hertz), np.float64)
        found = self._each(_core.rocking, 12, rates)
        eigenvalues = found[..., 4::2] + 1j * found[..., 5::2]
        return Rocking(found[..., :2], found[..., 2:4], eigenvalues)

    def growth_rates(self, spin: Reals | None = None, *, hertz: Reals | None = None) -> Floats:
        """Growth rates of both rocking modes, (..., 2), the slow one first, in sqrt(g/a).

        Parameters are those of `rocking`.
        """
        return self.rocking(spin, hertz=hertz).growth

    def stable(self, spin: Reals | None = None, *, hertz: Reals | None = None) -> Any:
        """Whether a stone that spins upright is stable: neither rocking mode grows.

        Parameters are those of `rocking`; the result is a bool for each spin.
        """
        return np.all(self.rocking(spin, hertz=hertz).growth <= 0, axis=-1)

    def _measured(self, told: bool, mass: float | None) -> Self:
        """Return a measured stone if lengths had units (`told`) or a mass is given, else the stone itself."""
        return self.in_metres(mass) if told or mass is not None else self

    def _radius(self) -> float:
        if self.scale is not None:
            return self.scale.radius
        units = np.unique(np.asarray(self._unit))
        units = units[~np.isnan(units)]
        if units.size != 1:
            raise ValueError(
                f"radius: expected stones of one size, not of {units.size} sizes, since a family has one"
                " scale; convert each stone separately"
            )
        return float(units[0])

    def _bulk(self) -> tuple[str, tuple[float, float], float]:
        volume = float(np.max(4 / 3 * math.pi * np.prod(np.asarray(self.semi_axes), axis=-1)))
        cut = not bool(np.isnan(np.asarray(self.theta_end)).all())
        wide = float(np.max(np.median(np.asarray(self.semi_axes), axis=-1)))
        return "stone", (2.0, 2 * wide), volume / 2 if cut else volume  # about half of the ellipsoid

    def _with_scale(self, scale: Scale | None) -> Self:
        return replace(self, scale=scale)

    def spin_limits(self) -> Floats:
        """(k,) spins, in sqrt(g/a), at which a single stone that spins upright becomes stable or unstable."""
        return np.array(_core.spin_limits(self._numbers))

    def energy(self, state: EllipsoidState, contact: AnyContact = "rolling") -> Result:
        """Kinetic plus potential energy of a single stone, in M g a; heights are above the table.

        The velocity of the centre of mass follows from the slip and the lift of the state.
        """
        instance_of("state", state, EllipsoidState)
        smooth = not isinstance(contact, Coulomb | Viscous) and code_of(contact) == code_of("smooth")
        n, w, u = (np.asarray(x) for x in (state.vertical, state.w, state._pair))
        shape = np.broadcast_shapes(n.shape[:-1], w.shape[:-1], u.shape[:-1])
        rows = np.concatenate([np.broadcast_to(x, (*shape, x.shape[-1])) for x in (n, w, u)], axis=-1)
        found = _core.stone_energies(self._numbers, rows.reshape(-1, 8).tolist(), smooth)
        energy = np.array(found).reshape(shape)[()]
        if state.height is None:
            return energy
        rise, lift = rise_of_stone(self, n, w), np.asarray(state.lift)
        return (energy + np.asarray(state.height) + lift * (rise + 0.5 * lift))[()]

    def __repr__(self) -> str:
        if self.shape:
            return f"<Ellipsoid, a family of shape {self.shape}>"
        more: dict[str, Any] = {}
        if np.any(np.asarray(self.offset) != 0):
            more["offset"] = self.offset
        if not np.isnan(np.asarray(self.theta_end)).all():
            more["theta_end"] = self.theta_end
        if self.scale is not None:
            more["scale"] = self.scale
        words = [f"{name}={np.asarray(x).tolist() if name != 'scale' else x!r}" for name, x in more.items()]
        inertia = np.asarray(self.inertia)
        moments = np.diagonal(inertia) if (inertia == np.diag(np.diagonal(inertia))).all() else inertia
        numbers = str(np.asarray(self.semi_axes).tolist()), str(moments.tolist())
        return f"Ellipsoid({', '.join([*numbers, *words])})"

    @property
    def _numbers(self) -> list[float]:
        """The 13 numbers of a single stone for the core: semi-axes, six of the inertia, offset, theta_end."""
        if self.shape:
            raise ValueError(f"body: expected a single stone, not a family of shape {self.shape}")
        inertia = np.asarray(self.inertia)
        return [
            *np.asarray(self.semi_axes).tolist(),
            *six_of_tensor(inertia),
            *np.asarray(self.offset).tolist(),
            float(self.theta_end),
        ]

    def _columns(self) -> list[Floats]:
        """The numbers of `_numbers` for a family of stones, each an array or, if common to all, a number."""
        inertia: Any = self.inertia
        moments = (inertia[..., i, j] for i, j in SIX)
        return [*components(self.semi_axes), *moments, *components(self.offset), self.theta_end]

    def _each(self, law: Callable[..., Any], width: int, *given: Floats) -> Floats:
        """Apply a function of the core to each stone; where it fails, NaN, or the error of a single stone."""
        if not self.shape and all(x.ndim == 0 for x in given):
            return np.array(law(self._numbers, *(float(x) for x in given)))
        common_shape({"body": np.broadcast_to(0.0, self.shape), **dict(zip(("spin",), given, strict=False))})
        columns = np.broadcast_arrays(*map(np.asarray, self._columns()), *map(np.asarray, given))
        shape = columns[0].shape
        found = np.full((*shape, width), np.nan)
        for i in np.ndindex(shape):
            x = [float(column[i]) for column in columns]
            try:
                found[i] = law(x[:13], *x[13:])
            except ValueError:
                if not self.shape:
                    raise
        return found
