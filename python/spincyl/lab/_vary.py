"""Numbers of a motion that a fit can vary, by name, and the motion computed with other values."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from spincyl._contact import Coulomb, Viscous
from spincyl._loss import Loss, marked_as_si
from spincyl._measured import in_si
from spincyl._motion import Motion
from spincyl._restitution import coefficient_of, with_coefficient
from spincyl._scale import si_factor
from spincyl.studio.shape import steepest

_MOST = 1e6  #: Largest coefficient and angular velocity of the model.
#: The range of a share.
_SHARE = 0.0, 1.0


class Number(NamedTuple):
    """A number of a motion that a fit can vary, such as mu, with its bounds, in natural units."""

    value: float
    low: float
    high: float
    size: float  #: a typical value, by which steps of the fit are measured
    factor: float  #: to the unit in which users give and read the number
    unit: str  #: that unit; "" for a pure number


class Placed(NamedTuple):
    """A motion in natural units, and how its path is turned and moved."""

    motion: Motion
    phi0: float
    place: tuple[float, float]


def numbers_of_motion(guess: Motion) -> dict[str, Number]:
    """All numbers that can vary, with their values in the guess."""
    m, scale = guess.natural, guess.scale
    found: dict[str, Number] = {}

    def add(name: str, value: float, low: float, high: float, size: float, natural: str) -> None:
        factor, unit = si_factor(natural, scale)
        found[name] = Number(float(value), low, high, size, factor or 1.0, "" if unit == "1" else unit)

    start = m.start
    add("theta", start.theta, 1e-8, min(steepest(m.body), math.pi - 1e-8), 0.1, "rad")
    for name in ("w1", "w2", "w3"):
        add(name, getattr(start, name), -_MOST, _MOST, 0.3, "sqrt(g/R)")
    if not isinstance(m.contact, str) or m._asked.restitution is not None:
        for name, value in zip(("slip_h", "slip_2"), start._slip, strict=True):
            add(name, float(value), -_MOST, _MOST, 0.3, "sqrt(g R)")
    if start.height is not None and start.lift is not None:
        add("height", float(start.height), 0.0, _MOST, 0.3, "R")
        add("lift", float(start.lift), -_MOST, _MOST, 0.3, "sqrt(g R)")
    if isinstance(m.contact, Coulomb):
        add("mu", float(m.contact.mu), 0.0, 100.0, 0.1, "1")
    if isinstance(m.contact, Viscous):
        factor, unit = si_factor("1", None)
        add("c", float(m.contact.c), 0.0, _MOST, 0.1, "1")
        if scale is not None:
            c = float(Viscous.from_si(1.0, scale=guess.body).c)
            found["c"] = found["c"]._replace(factor=1 / c, unit="s/m")
    if (bounce := m._asked.restitution) is not None:
        add("restitution", coefficient_of(bounce), *_SHARE, 0.1, "1")
    for law in () if m.losses is None else m.losses.laws:
        if law._function is None:
            factor, unit = law._printed(scale)
            value = float(law.coefficient)
            found[type(law).__name__] = Number(value, 1e-12, _MOST, value, factor, unit.strip())
    if not m._asked.slope and not m._asked.turning:
        add("phi0", 0.0, -math.inf, math.inf, 0.1, "rad")
    for name in ("x", "y"):
        add(name, 0.0, -_MOST, _MOST, 0.3, "R")
    add("t0", m._asked.t0, -math.inf, math.inf, 0.1, "sqrt(R/g)")
    return found


def with_numbers(guess: Motion, values: Mapping[str, float], times: "np.ndarray[Any, Any]") -> Placed:
    """The motion at ascending times, in natural units, with other values of some numbers."""
    m = guess.natural
    start, asked = m.start, m._asked
    own: dict[str, Any] = {
        name: values[name] for name in ("theta", "w1", "w2", "w3", "height", "lift") if name in values
    }
    if "slip_h" in values or "slip_2" in values:
        along, across = start._slip
        own["slip"] = (values.get("slip_h", along), values.get("slip_2", across))
    start = replace(start, **own) if own else start
    contact, losses = asked.contact, asked.losses
    if "mu" in values and isinstance(contact, Coulomb):
        apart = contact.static > contact.mu
        static = max(float(contact.static), values["mu"]) if apart else values["mu"]
        contact = replace(contact, mu=values["mu"], static=static)
    if "c" in values and isinstance(contact, Viscous):
        contact = replace(contact, c=values["c"])
    if losses is not None:
        losses = _with_coefficients(losses, values)
    restitution = asked.restitution
    if "restitution" in values and restitution is not None:
        restitution = with_coefficient(restitution, values["restitution"])
    asked = asked._replace(
        times=times,
        contact=contact,
        losses=losses,
        restitution=restitution,
        t0=values.get("t0", asked.t0),
    )
    made = replace(m, start=start, contact=contact)._again(asked)
    return Placed(made, values.get("phi0", 0.0), (values.get("x", 0.0), values.get("y", 0.0)))


def _with_coefficients(losses: Loss, values: Mapping[str, float]) -> Loss:
    total: Any = None
    for law in losses.laws:
        name = type(law).__name__
        one = marked_as_si(law._with(values[name])) if name in values else law
        total = one if total is None else total + one
    found: Loss = total
    return found


def in_units_of(guess: Motion, made: Motion) -> Motion:
    """Convert a motion in natural units to the units of the motion `guess`."""
    if guess.scale is None:
        return made
    return in_si(made, guess.body, made._asked.times * guess.scale._units[1], None)
