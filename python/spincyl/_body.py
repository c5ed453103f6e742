"""The body, its steady states and their stability."""

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Self, overload

import numpy as np

from spincyl import _core
from spincyl._circular import circular as _circular
from spincyl._input.equality import compared
from spincyl._input.hints import Named
from spincyl._input.numbers import (
    Reals,
    Result,
    elementwise,
    fitting,
    is_scalar,
    kept,
    keywords,
    lengths,
    metres,
    number,
    radians,
    reals,
    several,
    turns_per_second,
    within,
)
from spincyl._input.reprs import is_lazy
from spincyl._laws import Laws
from spincyl._repr import FIELDS, body
from spincyl._scale import Scale
from spincyl._sized import Sized
from spincyl._state import State
from spincyl._upward import above

if TYPE_CHECKING:
    from spincyl._motion import Motion

# looked up once: a single rate takes little longer than the two look-ups
_rate_of_one, _float64 = _core.rate_of_one, np.float64


@compared
@dataclass(frozen=True, eq=False, repr=False)
class Body(Laws, Sized, metaclass=Named):
    """A rigid body of revolution that touches the table with its lower rim.

    Fields may be arrays that broadcast: then this is a family of bodies, and every method
    broadcasts over it. In a family, what cannot be a body gives NaN and `Region.INVALID`.

    Parameters
    ----------
    ell : array_like
        Height of the centre of mass above the circle of the lower rim, in R: the aspect ratio of a sharp
        tube; 0 to 1e150. Of a ball (`fillet=1`), above -1: how high the centre of mass lies above that of
        the ball.
    i1, i3 : array_like
        Transverse and axial moment of inertia about the centre of mass, in M R^2. A real body has
        0 < i3 <= 2 i1.
    bore : array_like, optional
        Inner over outer radius of a uniform tube, NaN for a general body. Set by `solid`, `tube`
        and `from_metres`; the moments then follow from it.
    fillet : array_like, optional
        Radius of the fillet of the rim, 0 to 1 in units of the outer radius R, which stays the unit of
        length: the circle of the rim has the radius 1 - fillet. 0 is a sharp rim, 1 a ball.
    theta_end : array_like, optional
        Inclination in (0, pi], radians, at which something else than the rim lands: a stem, a cap, a
        shoulder. NaN: pi/2 of a body with ell > 0, which is taken to be as long on its other side, but of a
        ball, which goes round.
    scale : Scale, optional
        Its size: then it is a measured body, as `measured` makes them, and its motions are in SI. The fields
        above, the methods and every `State` stay in natural units; what is in SI has its unit in the name.

    Raises
    ------
    ValueError
        If a single body is none, naming the value and the inequality.
    TypeError
        Naming the argument that holds no real numbers.

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
    _measured: ClassVar[dict[str, float]] = {}  # the arguments of `from_metres`, for `__repr__`
    # of `parts.assembled`: name, form and numbers in R about the centre of mass
    _parts: ClassVar[tuple[tuple[str, int, tuple[float, ...]], ...]] = ()
    _single: ClassVar[bool] = False  # whether every field is a float: one body, not a family

    def __post_init__(self) -> None:
        if self.scale is not None and not isinstance(self.scale, Scale):
            raise TypeError(f"scale: expected a Scale, not {type(self.scale).__name__}")
        given = [reals(name, getattr(self, name)) for name in FIELDS]
        if is_scalar(*given):
            given = [float(x) + 0.0 for x in given]  # turns -0.0 into 0.0
            moments: tuple[Reals, Reals] = _core.check_body(given)
            object.__setattr__(self, "_single", True)
        else:
            fitting(dict(zip(FIELDS, given, strict=True)))
            given = [x if is_scalar(x) else x + 0.0 for x in given]
            moments = _core.body_i1(*given), _core.body_i3(*given)
        for name, value, own in zip(("i1", "i3"), given[1:3], moments, strict=True):
            # the moments of a tube follow from its bore and must agree; values of a lazy array are not
            # computed
            if getattr(own, "chunks", None) is None and np.any(np.abs(own - value) > 1e-15 * own):
                raise ValueError(f"{name} = {value!r}: a tube of this bore has {own!r}")
        for name, value in zip(FIELDS, (given[0], *moments, *given[3:]), strict=True):
            object.__setattr__(self, name, kept(value))

    @classmethod
    def solid(cls, ell: Reals, fillet: Reals = 0.0) -> Self:
        """Solid cylinder of half length `ell` over its radius; 0 is a disk. `fillet` rounds its edges."""
        return cls.tube(ell, bore=0.0, fillet=fillet)

    @classmethod
    @elementwise
    def tube(cls, ell: Reals, bore: Reals, fillet: Reals = 0.0) -> Self:
        """Uniform tube of half length `ell` over the outer radius.

        Parameters
        ----------
        ell : array_like
            Half the length over the outer radius. The field `ell` of the body is that less the fillet.
        bore : array_like
            Inner over outer radius, 0 (solid) to 1 (a thin wall).
        fillet : array_like
            Radius of the rounded outer edges, in units of the outer radius: at most half the length, and at
            most the wall that the bore leaves. With bore 0, fillet 1 is a capsule, or for ell = 1 a ball.
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
    def balls(
        cls, separation: float = 1.0, *, diameter: float | None = None, mass: float | None = None
    ) -> Self:
        """Two equal solid balls, one on the other: Hurricane balls.

        Parameters
        ----------
        separation : float
            Distance of their centres over their diameter: 1 (touching), or more on a light rod.
        diameter : float, optional
            Of each ball in metres: then they are `measured`, with the `mass` of both in kilograms.

        Notes
        -----
        Jackson, Mertens, Pearson, Am. J. Phys. 83, 959 (2015). The second ball lands at pi/2.
        """
        separation = number("separation", separation)
        i1, theta_end = _core.check_balls(separation)
        return cls(separation, i1, 0.4, fillet=1.0, theta_end=theta_end)._across(diameter, mass)

    @classmethod
    def ball(
        cls, offset: float, i1: float, i3: float, *, diameter: float | None = None, mass: float | None = None
    ) -> Self:
        """A ball whose centre of mass lies `offset` radii above its centre: negative in a tippe top.

        `i1` and `i3` are the moments about the centre of mass, across the line of the two centres and along
        it. The ball goes through both poles, theta = 0 and pi. With a `diameter` (metres) it is `measured`.
        """
        numbers = number("offset", offset), number("i1", i1), number("i3", i3)
        _core.check_ball(*numbers)
        return cls(*numbers, fillet=1.0)._across(diameter, mass)

    @classmethod
    def from_metres(
        cls, *, outer_diameter: float, length: float, inner_diameter: float = 0.0, fillet: float = 0.0
    ) -> Self:
        """Uniform tube from its measures (`fillet` is the radius of its outer edges).

        All are in metres, all in any one unit, or texts like "60 mm"; single numbers.
        """
        measures = {"outer_diameter": outer_diameter, "inner_diameter": inner_diameter, "length": length}
        if not (type(fillet) is float and fillet == 0):
            measures["fillet"] = fillet
        measures = metres(lengths("", measures)[0])
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
        """Half length over outer radius at which theta_balance = theta_limit.

        With sharp edges it is (sqrt(3)/2) sqrt(1 + bore^2).
        A bore or a fillet that no tube can have is a ValueError, in an array NaN. Relative error below 4 ulp
        (2^-53).
        """
        bore, fillet = reals("bore", bore), reals("fillet", fillet)
        if is_scalar(bore, fillet):
            # aspect ratio 1 leaves room for every valid fillet
            _core.check_tube(1.0, float(bore), float(fillet))
        return _core.critical_aspect(bore, fillet)

    @property
    def critical_hertz(self) -> Result:
        """The critical rate in turns per second: where Omega~ = 1, which every body lying on its side has.

        A rate in hertz over it is the reduced rate Omega~. Needs a measured body.
        """
        return self._sized("critical_hertz").hertz(self, 1.0)

    @elementwise
    def hertz(self, at: Reals | State) -> Result:
        """Turns per second of the precession; needs a measured body.

        Parameters
        ----------
        at : array_like or State
            An inclination in (0, pi/2] (radians), meaning the steady state with the centre at rest, NaN where
            there is none; or any state.
        """
        scale = self._sized("hertz")
        at = at if isinstance(at, State) else radians("at", at, self._leans)
        return scale.turns(at.precession if isinstance(at, State) else self.angular_rate(self.rate(at)))

    def roll(self, state: State, t: Reals, **how: Any) -> "Motion":
        """How it moves on from a state: `spincyl.roll` of this body, in seconds if it is measured."""
        found: Motion = above("Body.roll")(self, state, t, **how)
        return found

    # Steady states with the centre at rest.

    # the type of the result is that of a single body, also for a family
    @overload
    def rate(self, theta: float, **ufunc: Any) -> np.float64: ...
    @overload
    def rate(self, theta: Reals, **ufunc: Any) -> Result: ...
    def rate(self, theta: Reals, **ufunc: Any) -> Result:
        """Reduced rotation rate Omega~ = Omega sqrt(I3) of the steady state at an inclination.

        Parameters
        ----------
        theta : array_like
            Inclination in radians, in (0, pi/2]; of a rounded rim up to `theta_end`.
        **ufunc
            `out=`, `where=` and the other keywords of NumPy's ufuncs.

        Returns
        -------
        float or array
            Of the broadcast shape of `theta` and the body. NaN where there is no steady state;
            `region` says why. Error at most 2 (1 + kappa_c) 2^-53 relative, where kappa_c is
            ``|dlog rate/dlog theta|``; of a rounded rim 2^-100 n/m besides, which is less unless a body
            is made so that m = n + (I1/I3 - 1) A cos, A = 1 - fillet + fillet sin, is 2^-47 of
            n = (1 - fillet) cos - ell sin.

        Notes
        -----
        Jackson et al., Am. J. Phys. 87, 85 (2019), Eq. 15, in a form without its cancellation.
        """
        if type(theta) is float and self._single and not ufunc:
            # one angle of one body: separate arguments are faster than unpacking a tuple
            one = _rate_of_one(theta, self.ell, self.i1, self.i3, self.bore, self.fillet, self.theta_end)
            if one == one:
                return _float64(one)
        return self._rates(theta, **ufunc)

    @elementwise
    def _rates(self, theta: Reals, **ufunc: Any) -> Result:
        return _core.rate(radians("theta", theta, self._leans), *self._numbers, **keywords(_core.rate, ufunc))

    @elementwise
    def region(self, theta: Reals, **ufunc: Any) -> Result:
        """Code of the `Region` (uint8) at an inclination: why a rate is NaN, or what is stable."""
        return _core.region(
            radians("theta", theta, self._leans), *self._numbers, **keywords(_core.region, ufunc)
        )

    @elementwise
    def inclinations(self, of: Reals = None, /, *, rate: Reals = None, hertz: Reals = None) -> Result:
        """Every steady inclination of a rate, with the centre at rest.

        Parameters
        ----------
        of, rate : array_like
            Reduced rotation rate Omega~ >= 0. Of a measured body it needs its name, ``rate=``.
        hertz : array_like
            Instead of it, of a measured body: turns per second.

        Returns
        -------
        array
            Broadcast shape and a last axis of 3, of rounded rims 5 (xarray: dimension "root"): angles in
            (0, pi/2), of rounded rims up to `theta_end`, ascending, padded with NaN. Lying on the side,
            which every body does at rate 1, is not among them. All NaN where the question makes no sense
            (`count` is NaN there, too): rate negative or NaN, rate^2 times the larger of I1/I3 and ell above
            1e300. ``|rate(theta) - rate| <= 8 (1 + kappa_c) 2^-53 rate``, so at a fold, where kappa_c
            vanishes, 8 ulp; where kappa_c exceeds 2^45, theta is within 3 ulp of the exact root. A pandas
            Series gives an array.
        """
        return _core.inclination(*several(self._most, self._reduced(of, rate, hertz), *self._numbers))

    @elementwise
    def states(self, of: Reals = None, /, *, rate: Reals = None, hertz: Reals = None) -> State:
        """The steady states of a rate, told as of `inclinations`, in its order and shape.

        Near theta_limit, and at the critical aspect, a rate says more about a state than theta can:
        there prefer these to `steady(inclinations(rate))`.
        """
        inputs = several(self._most, self._reduced(of, rate, hertz), *self._numbers)
        theta, w1, w3 = (law(*inputs) for law in (_core.inclination, _core.states_w1, _core.states_w3))
        return State(theta, w1, theta * 0.0, w3)

    @elementwise
    def count(self, of: Reals = None, /, *, rate: Reals = None, hertz: Reals = None) -> Result:
        """How many `inclinations` a rate has: 0 to 5, NaN for no such question."""
        return _core.count(self._reduced(of, rate, hertz), *self._numbers)

    @elementwise
    def steady(self, theta: Reals) -> State:
        """The steady state with the centre at rest at an inclination in (0, pi/2], radians.

        Raises
        ------
        ValueError
            If a single inclination has none (arrays hold NaN there), naming the forbidden band.
        """
        theta = radians("theta", theta, self._leans)
        numbers = self._numbers
        if is_scalar(theta, *numbers):
            return State(*_core.steady_state(float(theta), numbers))
        return State(theta, _core.steady_w1(theta, *numbers), theta * 0.0, _core.steady_w3(theta, *numbers))

    @elementwise
    def circular(
        self, theta: Reals, precession: Reals = None, *, radius: Reals = None, w3: Reals = None
    ) -> State:
        """The steady state whose centre runs on a circle while it rolls; give one of three numbers.

        Parameters
        ----------
        theta : array_like
            Inclination in (0, pi/2], radians.
        precession : array_like, optional
            phi' in sqrt(g/R), 1e-100 to 1e100 in size. With `rate / sqrt(i3)` the centre rests.
        radius : array_like, optional
            Of the circle of the centre, in R: above 0 of a coin that leans inward, below 0 where the centre
            runs the other way. The state precesses counterclockwise.
        w3 : array_like, optional
            Spin about the axis, sqrt(g/R). Gives both states, the slower first, in a last axis ("root").

        Raises
        ------
        ValueError
            For a single state that is none; arrays hold NaN there, and for a `radius` or `w3` without one.
        """
        return _circular(self, theta, precession, radius, w3)

    def __repr__(self) -> str:
        return body(self)

    def _repr_html_(self) -> str:
        return str(above("card")(self))

    def _radius(self) -> float:
        if self.scale is not None:
            return self.scale.radius
        if not self._measured:
            raise TypeError("radius: the body does not know its size: give its outer radius, in metres")
        return self._measured["outer_diameter"] / 2

    def _across(self, diameter: float | None, mass: float | None) -> Self:
        """A ball, or two, measured if they have a diameter."""
        if diameter is None:
            if mass is not None:
                raise ValueError("mass: of balls that are measured, diameter= in metres")
            return self
        across = within("diameter", metres({"diameter": diameter})["diameter"], 2e-100, 2e100, "metres")
        return self.in_metres(mass, radius=across / 2)

    def _bulk(self) -> tuple[str, tuple[float, float], float]:
        if self._single and self.bore == self.bore:
            half = self.ell + self.fillet
            return "tube", (2 * half, 2.0), 2 * np.pi * (1 - self.bore**2) * half
        if not self._single or self.fillet != 1:
            return "body", (2.0, 2.0), 0.0
        if self.theta_end == self.theta_end:  # where the upper one lands
            return "pair of balls", (2 + 2 * self.ell, 2.0), 8 / 3 * np.pi
        return "ball", (2.0, 2.0), 4 / 3 * np.pi

    def _with_scale(self, scale: Scale | None) -> Self:
        found = replace(self, scale=scale)
        object.__setattr__(found, "_parts", self._parts)
        if scale is not None and self._measured.get("outer_diameter") == 2 * scale.radius:
            usual = {"mass": scale._is_weighed, "gravity": scale.gravity != Scale.gravity}
            shown = self._measured | {"mass": scale.mass, "gravity": scale.gravity}
            shown = {name: x for name, x in shown.items() if usual.get(name, True)}
            object.__setattr__(found, "_measured", shown)
        return found

    def _reduced(self, of: Reals, rate: Reals, hertz: Reals) -> Reals:
        """The reduced rate, given directly or in turns per second."""
        if sum(x is not None for x in (of, rate, hertz)) != 1:
            raise TypeError("rate and hertz: give one of them, hertz= of a measured body")
        if hertz is None and (of is None or self.scale is None):
            return reals("rate", rate if of is None else of)
        scale = self._sized("hertz")
        if hertz is None:
            raise TypeError("rate: of a measured body give hertz=, or rate= for the reduced rate, by name")
        return reals("hertz", turns_per_second("hertz", hertz)) / scale.hertz(self, 1.0)

    @property
    def _second(self) -> float:
        """The natural unit of time in the unit of the body's motions: seconds if measured, else 1."""
        return 1.0 if self.scale is None else self.scale._units[1]

    @property
    def _leans(self) -> str:
        own = is_lazy(self.fillet) or is_lazy(self.theta_end)
        own = own or bool(np.any(self.fillet == 1) or not np.all(np.isnan(self.theta_end)))
        return f"0 < theta <= {'theta_end of the body' if own else 'pi/2'}"

    @property
    def _is_sharp(self) -> bool:
        """Whether no body of the family has a fillet; False if a lazy array would have to be computed."""
        return not is_lazy(self.fillet) and not np.any(np.asarray(self.fillet) != 0)

    @property
    def _most(self) -> int:
        """Largest number of inclinations of one rate: the length of the axis "root"."""
        return 3 if self._is_sharp else 5
