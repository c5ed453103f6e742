"""Measured bodies, and the conversion of their motions from SI to natural units and back.

The motion of a measured body takes times in seconds, is computed in natural units like any other motion, and
is returned in SI. `Motion.natural` is the motion in natural units, from which plots, pages and files start.
"""

import re
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._body import Body
from spincyl._input.hints import with_hints
from spincyl._input.materials import density_in_si
from spincyl._input.numbers import Floats, Reals, in_range, metres, reals, refuse_bad_value, si
from spincyl._phases import COUPLE_COLUMN, IMPULSE_COLUMNS, LOST_COLUMN
from spincyl._scale import Scale, scale_of, unit_of_output

if TYPE_CHECKING:
    from spincyl._motion import Motion


@with_hints
def measured(
    *,
    outer_diameter: float,
    length: float,
    inner_diameter: float = 0.0,
    wall: float | None = None,
    mass: float | None = None,
    density: float | str | None = None,
    fillet: float = 0.0,
    gravity: float = Scale.gravity,
) -> Body:
    """Make a measured body: a uniform tube with dimensions in metres, whose motions are in SI.

    Each argument is a single number, a text such as "120mm", or a pint quantity in any suitable unit.

    Parameters
    ----------
    outer_diameter, length : float
        Outer diameter and length of the tube, in metres.
    inner_diameter : float
        Inner diameter in metres; 0 for a solid cylinder.
    wall : float, optional
        Thickness of the wall in metres, in place of `inner_diameter`.
    mass : float, optional
        Mass in kilograms. Rates, times and lengths do not need the mass. Without a mass, forces and energies
        raise an error.
    density : float or str, optional
        Density in kg/m^3, in place of `mass`, or the name of a material: "steel", "stainless steel", "cast
        iron", "aluminium", "brass", "copper", "glass", "acrylic", "polypropylene", "polystyrene", "PET",
        "PVC", "PTFE", "polycarbonate", "ABS", "PLA", "beech", "birch", "maple", "oak", "ash", "fir" or
        "pine". The mass is then that of the tube with its fillets.
    fillet : float
        Radius of the rounded outer edges, in metres.
    gravity : float
        Acceleration of gravity, in m/s^2.

    Returns
    -------
    Body
        Body with a `scale`. For this body `roll`, `swing`, `drift` and sweeps return SI units: s, m, J, N and
        rad/s. `thrown`, `pressed` and `dropped` take SI units. Methods of the body and every `State` stay in
        natural units. Exceptions have a unit in the name: `critical_hertz`, `hertz(theta)`,
        `inclinations(hertz=7.3)`. The property `natural` is the same body without its scale.

    Raises
    ------
    ValueError
        If such a tube is impossible; the message names the value and the inequality.
    TypeError
        If an argument is not a single real number, or its unit has a wrong dimension; the message names it.

    Warns
    -----
    UserWarning
        If the tube is larger than 5 m or smaller than 0.1 mm, or its density is below that of foam or above
        that of osmium. Probably millimetres were given for metres.

    Notes
    -----
    Densities of materials: Callister, Rethwisch, Fundamentals of Materials Science and Engineering, 3rd ed.
    (Wiley, 2008), Table B.1, and for woods the Wood Handbook (FPL-GTR-190, 2010), Table 5-3a, at 12 %
    moisture; docs/api.md lists them. Those of alloys and plastics vary by some percent, those of wood by ten.

    See Also
    --------
    Body.in_metres : makes any other body a measured body.

    Examples
    --------
    >>> import spincyl as sc
    >>> tube = sc.measured(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3, mass=20e-3)
    >>> print(f"{tube.critical_hertz:.2f} Hz")
    6.18 Hz
    >>> rod = sc.measured(outer_diameter="1cm", length="5cm", density="brass")
    >>> print(f"{1e3 * rod.scale.mass:.1f} g")
    33.4 g
    >>> m = sc.roll(tube, tube.steady(1.4).kicked(0.05), 2.0, want="force")  # of two seconds
    >>> print(f"{m.t[-1]} s, {m.normal[-1]:.3f} N")
    2.0 s, 0.178 N
    """
    given = metres({"outer_diameter": outer_diameter, "inner_diameter": inner_diameter})
    given |= metres({"length": length, "fillet": fillet})
    if wall is not None:
        outer = given["outer_diameter"]
        refuse_bad_value(
            "outer_diameter", outer, lambda x: ~(x > 0) | np.isinf(x), "expected outer_diameter > 0"
        )
        thick = in_range("wall", si("wall", wall, "metre"), 0.0, outer / 2, "metres")
        if given["inner_diameter"]:
            raise TypeError("inner_diameter, wall: give only one of them")
        given["inner_diameter"] = outer - 2 * thick
    body = Body.from_metres(**given)
    in_range("outer_diameter", given["outer_diameter"], 2e-100, 2e100, "metres")
    if density is not None:
        if mass is not None:
            raise TypeError("mass, density: give only one of them")
        dense = in_range("density", density_in_si(density), 1e-100, 1e100, "kg/m^3")
        mass = dense * body._bulk()[2] * (given["outer_diameter"] / 2) ** 3
    return body.in_metres(mass, gravity=gravity)


def sized_body(name: str, body: Any, scale: Scale | None) -> tuple[Body, Scale]:
    """A single body and its scale: the given scale, or that of the body or of its dimensions."""
    if not isinstance(body, Body):
        raise TypeError(f"{name}: expected a Body, not {type(body).__name__}")
    if not body._single:
        raise ValueError(f"{name}: expected a single body, not a family")
    found = scale_of(scale, body)
    if found is None and body._measured:
        found = Scale(radius=float(body._measured["outer_diameter"]) / 2)
    if found is None:
        more = ", or give scale=" if name == "tube" else ""
        raise ValueError(f"{name}: the size of the body is unknown; make the body with sc.measured{more}")
    return body, found


def natural_time(name: str, time: Reals, scale: Scale) -> Reals:
    """Convert a time or times from seconds to sqrt(R/g)."""
    with np.errstate(over="ignore"):  # an infinite time is refused by name later
        return reals(name, si(name, time, "second")) / scale._units[1]


# numbers out of range stay in natural units in a message; times on the way are converted to seconds
_OUT_OF_RANGE = re.compile(
    "(t|t0|step|w[123]|slip|error|spin|couple: power) = .*: (expected|whether) |mu = .* at the speed "
)
_TIME = re.compile(r"(\bt = |\bt0 = |\bstep = |\ba step of )([-+]?[0-9.]+(?:e[-+]?[0-9]+)?)")


def errors_in_seconds(scale: Scale | None, length: str = "R") -> AbstractContextManager[None]:
    """Context in which errors of the core give times in seconds, for a measured body.

    Ranges of valid numbers stay in natural units, and the message says so.
    """
    return _UNCHANGED if scale is None else _in_seconds(scale, length)


_UNCHANGED = nullcontext()


@contextmanager
def _in_seconds(scale: Scale, length: str) -> Iterator[None]:
    try:
        yield
    except ValueError as e:
        second, said = scale._units[1], str(e)
        told = _TIME.sub(lambda found: f"{found[1]}{_seconds(found[1], found[2], second)} s", said)
        if _OUT_OF_RANGE.match(said):
            told, which = (told, "limits in natural units") if told != said else (said, "natural units")
            told = f"{told} ({which}: sqrt({length}/g) is {second:.6g} s for this body)"
        if told == said:
            raise
        raise ValueError(told) from None


def _seconds(before: str, number: str, second: float) -> str:
    """Text of a time in seconds, from a text in natural units; a step that is proposed is rounded down."""
    told = float(number) * second
    return f"{0.99 * told:.3g}" if before == "a step of " else f"{told:.12g}"


def in_si(m: "Motion", body: Body, seconds: Floats, step: float | None) -> "Motion":
    """Convert a motion to SI for a measured body; `seconds` and `step` are the times and the step as given.

    `Motion._told` converts the outputs that are computed on access.
    """
    scale = body.scale
    assert scale is not None
    second, asked = scale._units[1], m._asked
    event = m.event and m.event._replace(time=m.event.time * second)
    made = ("phases", "impacts", "reversals")  # in natural units, if they have been looked at
    found: dict[str, Any] = {name: x for name, x in m.__dict__.items() if name not in made} | {
        "body": body,
        "t": seconds[: m.t.size].copy(),
        "w": output_in_si("w", m.w, scale),
        "error": m.error * scale._worst,
        "pose_error": m.pose_error * max(1.0, scale.radius),
        "force_error": m.force_error * (unit_of_output("normal", scale)[0] or 1.0),
        "rk4": m.rk4 and m.rk4._replace(advice=m.rk4.advice * second),
        "event": event,
        "_asked": asked._replace(times=seconds, t0=asked.t0 * second, step=step),
        "_phases": _rows_in_si(m._phases, scale),
        "_impacts": _rows_in_si(m._impacts, scale, impacts=True),
        "_natural": m,
    }
    same: Motion = object.__new__(type(m))
    object.__setattr__(same, "__dict__", found)
    return same


def _rows_in_si(rows: Floats | None, scale: Scale, *, impacts: bool = False) -> Floats | None:
    """Rows of phases or impacts in SI; without a mass, impulses and energies stay in natural units."""
    if rows is None:
        return None
    metre, second, joule, _ = scale._units
    found = rows.copy()
    found[:, 0] *= second
    if impacts and scale._is_weighed:
        found[:, IMPULSE_COLUMNS] *= joule * second / metre
        found[:, LOST_COLUMN] *= joule
        found[:, COUPLE_COLUMN] *= joule * second
    return found


def output_in_si(name: str, values: Any, scale: Scale | None) -> Any:
    """Convert an output of a motion to the motion's units; AttributeError if it needs an unknown mass."""
    factor, said = unit_of_output(name, scale)
    if factor is None and scale is not None and said in ("M g", "M g R"):
        in_si = {"M g": "N", "M g R": "J"}[said]
        why = f"in {in_si} needs the mass of the body, as in body.in_metres(mass=0.02), in kilograms"
        raise AttributeError(f"{name} {why}; natural.{name} of the motion is in {said}")
    return values if factor is None else values * factor
