"""The class `Body`: a body of revolution, its steady states and their stability."""

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Self, overload

import numpy as np

from spincyl import _core
from spincyl._circles import FIELDS, extent_of, set_rims
from spincyl._circular import circular as _circular
from spincyl._circular import steady_on_circle as _steady_on_circle
from spincyl._input.equality import compared_by_value
from spincyl._input.hints import HintingFamily
from spincyl._input.numbers import (
    Reals,
    Result,
    common_shape,
    elementwise,
    is_scalar,
    keywords,
    lengths_in_metres,
    metres,
    numbered,
    radians,
    read_only_copy,
    reals,
    turns_per_second,
)
from spincyl._input.reprs import is_lazy
from spincyl._laws import Laws
from spincyl._outlines import Outlines
from spincyl._repr import repr_of_body
from spincyl._scale import Scale, moment_as_number
from spincyl._sized import Sized
from spincyl._state import State, state_without_checks
from spincyl._upward import function_of_method

if TYPE_CHECKING:
    from spincyl._motion import Motion

# looked up once: a single rate takes little longer than the two look-ups
_rate_of_one, _float64 = _core.rate_of_one, np.float64


@compared_by_value
@dataclass(frozen=True, eq=False, repr=False)
class Body(Laws, Outlines, Sized, HintingFamily):
    """A rigid body of revolution that touches the table with its lower rim.

    If fields are arrays, the object is a family of bodies; the arrays broadcast, and every method broadcasts
    over the family. An impossible body in a family gives NaN and `Region.INVALID`.

    Parameters
    ----------
    ell : array_like
        Height of the centre of mass above the circle of the lower rim, in R, from 0 to 1e150. For a tube with
        sharp edges this is half the length. For a ball (`fillet=1`) it is the height above the centre of the
        ball, and must exceed -1.
    i1, i3 : array_like
        Transverse and axial moments of inertia about the centre of mass, in M R^2, with 0 < i3 <= 2 i1. With
        a `scale` that has a mass also a text such as "3.2e-6 kg m^2", or a pint quantity.
    bore : array_like, optional
        Ratio of inner to outer radius of a uniform tube; NaN for any other body. `solid`, `tube` and
        `from_metres` set the bore and compute the moments from it.
    fillet : array_like, optional
        Radius of the rounded edge of the rim, in units of the outer radius R: 0 (sharp) to 1 (a ball). The
        centres of the rounding lie on the circle of the rim, of radius 1 - fillet.
    theta_end : array_like, optional
        Inclination in radians, in (0, pi], at which another part lands: a stem, a cap, a shoulder. Default:
        pi/2 if ell > 0, since the other end is assumed to have an equal rim; for a ball, no part lands.
    scale : Scale, optional
        Size, mass and gravity. A body with a scale is a measured body (see `measured`): its motions are in
        SI. Fields, methods and every `State` stay in natural units, except methods named after a unit.
    rims : array_like, optional
        Array (..., n, 3): the `circles` of a body that can stand on several, as `profile` makes it. `ell`,
        `fillet` and `theta_end` are then those of the lowest circle. None for one circle or two equal rims.

    Raises
    ------
    ValueError
        If a single body is impossible; the message names the value and the inequality.
    TypeError
        If an argument is not real-valued; the message names it.

    Examples
    --------
    >>> import spincyl as sc
    >>> pipe = sc.Body.tube(6.0, bore=0.8)
    >>> pipe.steady(1.4).contact_radius.round(3)
    np.float64(5.743)
    """

    ell: Reals
    i1: Reals
    i3: Reals
    bore: Reals = np.nan
    fillet: Reals = 0.0
    theta_end: Reals = np.nan
    scale: Scale | None = field(default=None, kw_only=True)
    rims: Any = field(default=None, kw_only=True)
    _measured: ClassVar[dict[str, float]] = {}  # the arguments of `from_metres`, for `__repr__`
    # of `parts.assembled`: name, form and numbers in R about the centre of mass
    _parts: ClassVar[tuple[tuple[str, int, tuple[float, ...]], ...]] = ()
    _in_files: ClassVar[str] = "body"  # what it is called in files
    _single: ClassVar[bool] = False  # whether every field is a float: one body, not a family

    def __post_init__(self) -> None:
        self._check_scale()
        for name in ("i1", "i3"):
            object.__setattr__(self, name, moment_as_number(name, getattr(self, name), self.scale))
        if self.rims is not None:
            set_rims(self)
            return
        given = [reals(name, getattr(self, name)) for name in FIELDS]
        if is_scalar(*given):
            given = [float(x) + 0.0 for x in given]  # turns -0.0 into 0.0
            moments: tuple[Reals, Reals] = _core.check_body(given)
            object.__setattr__(self, "_single", True)
        else:
            common_shape(dict(zip(FIELDS, given, strict=True)))
            given = [x if is_scalar(x) else x + 0.0 for x in given]
            moments = _core.body_i1(*given), _core.body_i3(*given)
        for name, value, own in zip(("i1", "i3"), given[1:3], moments, strict=True):
            # the moments of a tube follow from its bore and must agree; values of a lazy array are not
            # computed
            if getattr(own, "chunks", None) is None and np.any(np.abs(own - value) > 1e-15 * own):
                raise ValueError(f"{name} = {value!r}: expected {own!r} for a tube of this bore, or no bore")
        for name, value in zip(FIELDS, (given[0], *moments, *given[3:]), strict=True):
            object.__setattr__(self, name, read_only_copy(value))

    @classmethod
    def solid(cls, ell: Reals, fillet: Reals = 0.0) -> Self:
        """Solid cylinder of half length `ell` (0: thin disk), with edges of radius `fillet`, both in R."""
        return cls.tube(ell, bore=0.0, fillet=fillet)

    @classmethod
    @elementwise
    def tube(cls, ell: Reals, bore: Reals, fillet: Reals = 0.0) -> Self:
        """Uniform tube.

        Parameters
        ----------
        ell : array_like
            Half the length, in units of the outer radius. The field `ell` of the body is this minus `fillet`.
        bore : array_like
            Ratio of inner to outer radius, 0 (solid) to 1 (a thin wall).
        fillet : array_like
            Radius of the rounded outer edges, in units of the outer radius: at most half the length, and at
            most the thickness of the wall. A solid tube with fillet 1 is a capsule; if ell = 1, a ball.
        """
        ell, bore, fillet = reals("ell", ell), reals("bore", bore), reals("fillet", fillet)
        if is_scalar(ell, bore, fillet):
            depth, i1, i3, most = _core.check_tube(float(ell), float(bore), float(fillet))
            return cls(depth, i1, i3, float(bore), float(fillet), most)
        depth = ell if is_scalar(fillet) and fillet == 0 else ell - fillet
        theta_end: Reals = np.nan
        if is_lazy(fillet) or np.any(np.asarray(fillet) == 1):
            theta_end = _core.capsule_end(ell, fillet)
        # with a bore given, the core computes the moments of the tube
        return cls(depth, np.nan, np.nan, bore, fillet, theta_end)

    @classmethod
    def from_metres(
        cls, *, outer_diameter: float, length: float, inner_diameter: float = 0.0, fillet: float = 0.0
    ) -> Self:
        """Uniform tube from its diameters, its length and the radius `fillet` of its rounded outer edges.

        Numbers are in metres, or all in one other unit. Texts such as "60 mm" are also valid.
        """
        measures = {"outer_diameter": outer_diameter, "inner_diameter": inner_diameter, "length": length}
        if not (type(fillet) is float and fillet == 0):
            measures["fillet"] = fillet
        measures = metres(lengths_in_metres("", measures)[0])
        try:
            body = cls.tube(*_core.from_metres(**{"fillet": 0.0, **measures}))
        except ValueError as e:
            if str(e).startswith(tuple(measures)):
                raise
            raise ValueError(f"{', '.join(f'{name} = {x!r}' for name, x in measures.items())}: {e}") from None
        object.__setattr__(body, "_measured", measures)
        return body

    @staticmethod
    @elementwise
    def critical_aspect(bore: Reals = 0.0, fillet: Reals = 0.0) -> Result:
        """Ratio of half length to outer radius at which a tube has I1 = I3, and theta_balance = theta_limit.

        With sharp edges the ratio is (sqrt(3)/2) sqrt(1 + bore^2). An impossible bore or fillet raises
        ValueError; in an array it gives NaN. The relative error is below 4 * 2^-53.
        """
        bore, fillet = reals("bore", bore), reals("fillet", fillet)
        if is_scalar(bore, fillet):
            # aspect ratio 1 leaves room for every valid fillet
            _core.check_tube(1.0, float(bore), float(fillet))
        return _core.critical_aspect(bore, fillet)

    @property
    def critical_hertz(self) -> Result:
        """Precession rate at which the reduced rate Omega~ is 1, in turns per second; needs a measured body.

        On its side the body is steady at this rate. Divide a rate in hertz by `critical_hertz` to get Omega~.
        """
        return self._sized("critical_hertz").hertz(self, 1.0)

    @elementwise
    def hertz(self, at: Reals | State) -> Result:
        """Precession rate of a state, in turns per second; needs a measured body.

        Parameters
        ----------
        at : array_like or State
            Inclination in radians, in (0, pi/2], of a steady state with the centre at rest; or any `State`.
            The rate is NaN where there is no steady state.
        """
        scale = self._sized("hertz")
        at = at if isinstance(at, State) else radians("at", at, self._leans)
        return scale.turns(at.precession if isinstance(at, State) else self.angular_rate(self.rate(at)))

    def roll(self, state: State, t: Reals, **how: Any) -> "Motion":
        """Compute the motion of this body from an initial state, with the arguments of `spincyl.roll`."""
        found: Motion = function_of_method("Body.roll")(self, state, t, **how)
        return found

    # Steady states with the centre at rest.

    # the type of the result is that of a single body, also for a family
    @overload
    def rate(self, theta: float, **ufunc: Any) -> np.float64: ...
    @overload
    def rate(self, theta: Reals, **ufunc: Any) -> Result: ...
    def rate(self, theta: Reals, **ufunc: Any) -> Result:
        """Reduced rate Omega~ = Omega sqrt(I3) of the steady state with the centre at rest.

        Parameters
        ----------
        theta : array_like
            Inclination of the state in radians, in (0, pi/2]; with a rounded rim, up to `theta_end`.
        **ufunc
            `out=`, `where=` and the other keywords of NumPy's ufuncs.

        Returns
        -------
        float or array
            Broadcast shape of `theta` and the body. NaN where there is no steady state; `region` gives
            the reason. Relative error at most 2 (1 + kappa_c) 2^-53, where kappa_c is
            ``|dlog rate/dlog theta|``. A rounded rim adds 2^-100 n/m, where n = (1 - fillet) cos - ell sin,
            m = n + (I1/I3 - 1) A cos and A = 1 - fillet + fillet sin, with cos and sin of theta. This is less
            than the first term unless m is below 2^-47 n.

        Notes
        -----
        Jackson et al., Am. J. Phys. 87, 85 (2019), Eq. 15, rearranged to avoid its cancellation.
        """
        if type(theta) is float and self._single and self.rims is None and not ufunc:
            # one angle of one body: separate arguments are faster than unpacking a tuple
            one = _rate_of_one(theta, self.ell, self.i1, self.i3, self.bore, self.fillet, self.theta_end)
            if one == one:
                return _float64(one)
        return self._rates(theta, **ufunc)

    @elementwise
    def _rates(self, theta: Reals, **ufunc: Any) -> Result:
        return _core.rate(*self._at(radians("theta", theta, self._leans)), **keywords(_core.rate, ufunc))

    @elementwise
    def region(self, theta: Reals, **ufunc: Any) -> Result:
        """`Region` code (uint8) at theta (radians): stable, unstable, forbidden, or outside the domain."""
        return _core.region(*self._at(radians("theta", theta, self._leans)), **keywords(_core.region, ufunc))

    @elementwise
    def inclinations(self, of: Reals = None, /, *, rate: Reals = None, hertz: Reals = None) -> Result:
        """All inclinations at which steady states with the centre at rest have a given rate.

        Parameters
        ----------
        of, rate : array_like
            Reduced rate Omega~ >= 0. For a measured body, use the keyword ``rate=``.
        hertz : array_like
            Precession rate in turns per second, in place of `rate`; needs a measured body.

        Returns
        -------
        array
            Angles in radians, ascending, in (0, pi/2), or for rounded rims up to `theta_end`. The last axis
            (xarray: dimension "root") has 3 angles, for rounded rims 5, for bodies of several circles 10 for
            each circle, padded with NaN. The body lying on its side, steady at rate 1, is not included. All
            angles are NaN if the rate is negative or NaN, or if rate^2 times the larger of I1/I3 and ell
            exceeds 1e300. A pandas Series gives an array. Error:
            ``|rate(theta) - rate| <= 8 (1 + kappa_c) 2^-53 rate``, which is 8 ulp at a fold, where kappa_c
            vanishes. Where kappa_c exceeds 2^45, theta is within 3 ulp of the exact root.
        """
        return self._several(_core.inclination, self._reduced(of, rate, hertz))

    @elementwise
    def states(self, of: Reals = None, /, *, rate: Reals = None, hertz: Reals = None) -> State:
        """Steady states with the centre at rest that have a given rate.

        Parameters, order and shape are those of `inclinations`.

        The states are more accurate than `steady(inclinations(rate))` near theta_limit and at the critical
        aspect, where the rate determines the state better than theta does.
        """
        given = self._reduced(of, rate, hertz)
        if self.rims is not None:
            return self.steady(self._several(_core.inclination, given))
        inputs = numbered(self._most, given, *self._numbers)
        theta, w1, w3 = (law(*inputs) for law in (_core.inclination, _core.states_w1, _core.states_w3))
        return State(theta, w1, theta * 0.0, w3)

    @elementwise
    def count(self, of: Reals = None, /, *, rate: Reals = None, hertz: Reals = None) -> Result:
        """Number of steady states with the centre at rest that have a rate; NaN for a rate out of range.

        Parameters are those of `inclinations`; the result is the number of its angles.
        """
        given = self._reduced(of, rate, hertz)
        if self.rims is not None:
            return (~np.isnan(self._several(_core.inclination, given))).sum(-1) + 0.0
        return _core.count(given, *self._numbers)

    @elementwise
    def steady(self, theta: Reals) -> State:
        """Steady state with the centre at rest at an inclination theta in radians, in (0, pi/2].

        Raises
        ------
        ValueError
            If a single inclination has no steady state; the message gives the forbidden band. An array of
            inclinations gives NaN there.
        """
        numbers, plain = self._raw, type(theta) is float and self._single and abs(theta) <= np.pi
        theta = theta if plain else radians("theta", theta, self._leans)
        if self.rims is not None:
            return _steady_on_circle(self, theta)
        if plain or is_scalar(theta, *numbers):
            return state_without_checks(_core.steady_state(float(theta), numbers))
        return State(theta, _core.steady_w1(theta, *numbers), theta * 0.0, _core.steady_w3(theta, *numbers))

    @elementwise
    def circular(
        self, theta: Reals, precession: Reals = None, *, radius: Reals = None, w3: Reals = None
    ) -> State:
        """Steady rolling with the centre on a circle, given by one of `precession`, `radius` and `w3`.

        Parameters
        ----------
        theta : array_like
            Inclination in radians, in (0, pi/2].
        precession : array_like, optional
            phi' in sqrt(g/R), of absolute value 1e-100 to 1e100. If it is `rate / sqrt(i3)`, the centre stays
            at rest.
        radius : array_like, optional
            Radius of the circle of the centre, in R: positive if the body leans inward, as a rolling coin
            does, negative if it leans outward. The resulting precession is counterclockwise.
        w3 : array_like, optional
            Angular velocity about the symmetry axis, in sqrt(g/R). The result has two states along its last
            axis ("root"); the state with the slower precession is first.

        Raises
        ------
        ValueError
            If the arguments are numbers and no such state exists; in arrays it is NaN.
        """
        return _circular(self, theta, precession, radius, w3)

    def __repr__(self) -> str:
        return repr_of_body(self)

    def _repr_html_(self) -> str:
        return str(function_of_method("card")(self))

    def _radius(self) -> float:
        if self.scale is not None:
            return self.scale.radius
        if self._unit == self._unit:
            return self._unit
        if not self._measured:
            raise TypeError("radius: expected the outer radius in metres; the body has no size yet")
        return self._measured["outer_diameter"] / 2

    def _bulk(self) -> tuple[str, tuple[float, float], float]:
        if self.rims is not None and self._single:
            return "body", extent_of(self.rims), 0.0
        if self._single and self.bore == self.bore:
            half, f = self.ell + self.fillet, self.fillet
            cut = 4 * np.pi * ((1 - np.pi / 4) * f**2 * (1 - f) + f**3 / 6)  # by the fillets, from Pappus
            return "tube", (2 * half, 2.0), 2 * np.pi * (1 - self.bore**2) * half - cut
        if not self._single or self.fillet != 1:
            return "body", (2.0, 2.0), 0.0
        if self.theta_end == self.theta_end:  # where the upper one lands
            return "pair of balls", (2 + 2 * self.ell, 2.0), 8 / 3 * np.pi
        return "ball", (2.0, 2.0), 4 / 3 * np.pi

    def _with_scale(self, scale: Scale | None, **moments: float) -> Self:
        found = replace(self, scale=scale, **moments, **({"bore": np.nan} if moments else {}))
        object.__setattr__(found, "_parts", self._parts)
        object.__setattr__(found, "_unit", self._unit)
        if not moments and scale is not None and self._measured.get("outer_diameter") == 2 * scale.radius:
            usual = {"mass": scale._is_weighed, "gravity": scale.gravity != Scale.gravity}
            shown = self._measured | {"mass": scale.mass, "gravity": scale.gravity}
            shown = {name: x for name, x in shown.items() if usual.get(name, True)}
            object.__setattr__(found, "_measured", shown)
        return found

    def _reduced(self, of: Reals, rate: Reals, hertz: Reals) -> Reals:
        """The reduced rate, as given by `of` or `rate`, or converted from turns per second in `hertz`."""
        if sum(x is not None for x in (of, rate, hertz)) != 1:
            raise TypeError("rate, hertz: give exactly one of them; hertz= needs a measured body")
        if hertz is None and (of is None or self.scale is None):
            return reals("rate", rate if of is None else of)
        scale = self._sized("hertz")
        if hertz is None:
            raise TypeError("rate: for a measured body write hertz=... or rate=... (the reduced rate)")
        return reals("hertz", turns_per_second("hertz", hertz)) / scale.hertz(self, 1.0)

    @property
    def _second(self) -> float:
        """The natural unit of time in the unit of the body's motions: seconds if measured, else 1."""
        return 1.0 if self.scale is None else self.scale._units[1]

    @property
    def _leans(self) -> str:
        if self.rims is not None:
            return "0 < theta < pi"
        own = is_lazy(self.fillet) or is_lazy(self.theta_end)
        own = own or bool(np.any(self.fillet == 1) or not np.all(np.isnan(self.theta_end)))
        return f"0 < theta <= {'theta_end of the body' if own else 'pi/2'}"

    @property
    def _is_sharp(self) -> bool:
        """Whether no body of the family has a fillet; False for lazy arrays, which are not computed."""
        return not is_lazy(self.fillet) and not np.any(np.asarray(self.fillet) != 0)

    @property
    def _most(self) -> int:
        """Largest number of steady inclinations at one rate: the length of the axis "root"."""
        return 3 if self._is_sharp else 5
