"""Output of bodies, states and motions on the command line: numbers for JSON, and rows of a table."""

import json
import math
import sys
from collections.abc import Iterator
from typing import Any, TextIO, TypeAlias

import numpy as np

from spincyl import Body, Motion, Scale, State, swing
from spincyl._contact import Contact, Coulomb, Viscous, contact_in_words
from spincyl._input.numbers import json_value
from spincyl._phases import Phase, has_friction, slipping_time

Row: TypeAlias = tuple[str, str, str]  # name, natural value, SI value
Numbers: TypeAlias = dict[str, Any]


def table(rows: Iterator[Row], file: TextIO | None = None) -> None:
    """Print rows in three columns: a name, a value in natural units, and the value in SI or degrees."""
    for name, natural, si in rows:
        print(f"  {name:<22} {natural:<34} {si}".rstrip(), file=file)


def print_json(value: Any, file: TextIO | None = None) -> None:
    """Print strict JSON, with null for numbers that are not finite."""
    wide = isinstance(value, dict) and "columns" in value
    json.dump(json_value(value), file or sys.stdout, indent=None if wide else 2, allow_nan=False)
    print(file=file)


def body_numbers(body: Body, scale: Scale | None) -> Numbers:
    """Properties of a body's shape, by name; with a scale, also the critical rate in hertz."""
    found: Numbers = {"call": repr(body), "ell": body.ell, "i1": body.i1, "i3": body.i3, "bore": body.bore}
    found |= {"fillet": body.fillet, "theta_end": body.theta_end}
    found |= {"theta_balance": body.theta_balance, "theta_limit": body.theta_limit}
    for name, points in (("folds", body.folds()), ("ridge", body.ridge())):
        found[name] = points[~np.isnan(points)]
    return found if scale is None else found | {"critical_hertz": scale.hertz(body, 1.0)}


def body_rows(body: Body, scale: Scale | None) -> Iterator[Row]:
    """Properties of a body's shape, as rows of a table."""
    n = body_numbers(body, scale)
    if n["fillet"] == 0:
        yield "aspect ratio l/R", f"{n['ell']:.9g}", ""
    else:
        yield "fillet", f"{n['fillet']:.9g}", ""
        yield "centre above the rim", f"{n['ell']:.9g}", ""
    yield "moments I1, I3", f"{n['i1']:.9g}, {n['i3']:.9g}", ""
    for name, x in (("theta0 (balanced)", n["theta_balance"]), ("thetaInf (fast limit)", n["theta_limit"])):
        if math.isnan(x):
            yield name, "none", ""
            continue
        yield name, f"{x:.9g} rad", f"{math.degrees(x):.6f} deg"
    yield "critical rate", "1", "" if scale is None else f"{n['critical_hertz']:.6g} Hz"
    for name, points in (("folds", n["folds"]), ("energy ridge", n["ridge"])):
        for x in points:
            yield f"{name} at theta", f"{x:.9g} rad", f"{math.degrees(x):.6f} deg"


def state_numbers(body: Body, state: State, scale: Scale | None, *, weighed: bool = False) -> Numbers:
    """Properties of a steady state with the centre at rest; with a scale, also in SI units.

    The energy is in joules only if the mass is known.
    """
    found: Numbers = {name: getattr(state, name) for name in ("theta", "w1", "w2", "w3")}
    found["rate"] = state.precession * math.sqrt(body.i3)
    names = "precession", "spin", "angular_velocity", "gamma", "contact_radius"
    found |= {name: getattr(state, name) for name in names}
    # `State` does not know the fillet: the circle of contact of a rounded rim is smaller than its outer
    # radius
    found["still_symbols"] = found["contact_radius"]
    found["contact_radius"] *= 1 - body.fillet + body.fillet * math.sin(state.theta)
    names = "angular_momentum", "beta", "speed_o", "speed_x", "energy"
    found |= {name: getattr(body, name)(state) for name in names}
    contacts: tuple[Contact, Contact] = ("rolling", "smooth")
    found |= {f"kappa_{contact}": body.stability(state, contact) for contact in contacts}
    if scale is not None:
        found |= {f"{name}_hertz": scale.turns(found[name]) for name in ("precession", "spin")}
        found["contact_radius_metres"] = scale.metres(found["contact_radius"])
        found["speed_x_metres_per_second"] = scale.metres_per_second(found["speed_x"])
        if weighed:
            found["energy_joules"] = scale.joules(found["energy"])
    return found


def state_rows(body: Body, state: State, scale: Scale | None, *, weighed: bool = False) -> Iterator[Row]:
    """Properties of a steady state, as rows of a table."""
    n = state_numbers(body, state, scale, weighed=weighed)

    def si(name: str, unit: str) -> str:
        return "" if scale is None else f"{n[name]:.6g} {unit}"

    def tilt(name: str) -> str:
        """Text with the angle between a vector and the axis; "" if the vector has no direction."""
        return f"{name} = {math.degrees(n[name]):.4f} deg to the axis" if n["angular_velocity"] else ""

    yield "reduced rate", f"{n['rate']:.9g}", ""
    yield "precession phi'", f"{n['precession']:.9g}", si("precession_hertz", "turns/s")
    yield "spin psi'", f"{n['spin']:.9g}", si("spin_hertz", "turns/s")
    yield "angular velocity", f"{n['angular_velocity']:.9g}", tilt("gamma")
    yield "angular momentum", f"{n['angular_momentum']:.9g}", tilt("beta")
    if math.isnan(n["contact_radius"]):
        yield "contact circle", "none: the body does not turn", ""
    else:
        yield "contact circle", f"{n['contact_radius']:.9g}", si("contact_radius_metres", "m radius")
        yield "still symbols", f"{n['still_symbols']:.4g} a turn", ""
    speeds = f"{n['speed_o']:.3g}, {n['speed_x']:.6g}"
    yield "speed of O, of X", speeds, si("speed_x_metres_per_second", "m/s")
    yield "energy", f"{n['energy']:.9g}", si("energy_joules", "J") if weighed else ""
    contacts: tuple[tuple[str, Contact], ...] = (("rolling", "rolling"), ("smooth table", "smooth"))
    for name, contact in contacts:
        yield name, *_stability_in_words(body, state, contact, n[f"kappa_{contact}"], scale)


def _stability_in_words(
    body: Body, state: State, contact: Contact, kappa: float, scale: Scale | None
) -> tuple[str, str]:
    """Text whether a state is stable, with its nutation or growth rate; and a text of this rate in SI."""
    if kappa > 0:
        nutation = body.nutation(state, contact)
        turns = "" if scale is None else f"{scale.turns(nutation):.6g} turns/s"
        return f"stable, nutation {nutation:.6g}", turns
    if kappa < 0:
        growth = body.growth_rate(state, contact)
        folds = "" if scale is None else f"{growth / scale.seconds(1.0):.6g} e-foldings/s"
        return f"unstable, growth {growth:.6g}", folds
    return "marginal", ""


def motion_numbers(m: Motion, scale: Scale | None) -> Numbers:
    """Properties of a motion: initial state, nutation and end."""
    found: Numbers = {"body": body_numbers(m.body, scale), "contact": contact_in_words(m.contact)}
    found["start"] = {name: getattr(m.start, name) for name in ("theta", "w1", "w2", "w3")}
    found |= {"status": m.status.name, "message": m.message, "method": m.method, "error": m.error}
    found["event"] = None if m.event is None else {"ending": m.event.ending.name, "time": m.event.time}
    end = _at_its_end(m)
    if isinstance(m.contact, Coulomb | Viscous):
        found["start"]["slip"] = list(m.start._slip)
        found["phases"] = [_phase_numbers(m.body, phase, scale) for phase in m.phases]
        found["slipping"] = slipping_time(m.phases, _end(m))
        if m.t.size:
            found |= {"dissipated": end.dissipated[-1]}
        if m.natural._impacts is not None:
            lost = [impact.lost for impact in m.natural.impacts]
            found |= {"impacts": len(lost), "lost_in_impacts": sum(lost)}
    elif m.losses is None:
        found["swing"] = swing(m.body, m.start, m.contact)._asdict()
    if m.losses is not None:
        found["losses"] = repr(m.losses)
        if m.t.size:
            found["work_lost"] = end.work_lost[-1]
    if m.t.size:
        found |= {"normal_min": m.normal.min(), "normal_max": m.normal.max()}
        found["friction_coefficient_max"] = _most_friction(m)
    return found if scale is None else found | {"time_unit_seconds": scale.seconds(1.0)}


def motion_rows(m: Motion, scale: Scale | None, *, weighed: bool = False) -> Iterator[Row]:
    """Properties of a motion, as rows; heat is in joules only if `weighed`."""

    def seconds(t: float) -> str:
        return "" if scale is None else f"{scale.seconds(t):.6g} s"

    end = _at_its_end(m)
    yield "start", f"theta = {m.start.theta:.9g} rad", f"{math.degrees(m.start.theta):.6f} deg"
    if isinstance(m.contact, Coulomb | Viscous):
        yield from _phase_rows(m, scale)
        if m.t.size:
            yield "heat of slipping", *_energy(m, float(end.dissipated[-1]), scale if weighed else None)
        if m.natural._impacts is not None and len(m.natural._impacts):
            lost = [impact.lost for impact in m.natural.impacts]
            yield f"lost in {len(lost)} impacts", *_energy(m, sum(lost), scale if weighed else None)
    elif m.losses is None:
        yield from _swing_rows(m, m.contact, scale)
    if m.losses is not None:
        yield "losses", repr(m.losses), ""
        if m.t.size:
            yield "energy lost", *_energy(m, float(end.work_lost[-1]), scale if weighed else None)
    if m.t.size:
        yield "normal force", f"{m.normal.min():.6g} to {m.normal.max():.6g} M g", ""
        words = "needed" if isinstance(m.contact, str) else "used at most"
        yield "friction coefficient", f"{_most_friction(m):.6g} {words}", ""
    if m.event is not None:
        yield m.event.ending.name.lower().replace("_", "-"), f"t = {m.event.time:.12g}", seconds(m.event.time)
    yield "how", m.message, ""


def _swing_rows(m: Motion, contact: Contact, scale: Scale | None) -> Iterator[Row]:
    """Turning points, period, and turn and drift per period of a motion without phases, as rows."""
    found = swing(m.body, m.start, contact)
    ends = (found.theta_min, found.theta_max)
    yield "turning points", " to ".join(f"{x:.9g}" for x in ends) + " rad", ""
    early = m.event is not None and m.event.time < found.period
    if math.isfinite(found.period):
        yield (
            "period" + (", not completed" if early else ""),
            f"{found.period:.12g}",
            "" if scale is None else f"{scale.seconds(found.period):.6g} s",
        )
        yield (
            "turn in a period",
            f"phi {found.precession_per_period:.9g}, psi {found.spin_per_period:.9g} rad",
            "",
        )
        metres = "" if scale is None else f"{scale.metres(found.drift):.6g} m"
        yield "drift in a period", f"{found.drift:.9g}", metres
    else:
        yield "period", "none", ""


def _energy(m: Motion, lost: float, scale: Scale | None) -> tuple[str, str]:
    """Text of the energy that a motion has lost, in M g R; and text of its share, with joules if known."""
    first = float(m.energy[0])
    first += float(m.dissipated[0]) if has_friction(m.contact) else 0.0
    first += 0.0 if m.losses is None else float(m.work_lost[0])
    joules = "" if scale is None else f"{scale.joules(lost):.6g} J, "
    return f"{lost:.9g} M g R", f"{joules}{lost / first:.1%} of the energy"


def _end(m: Motion) -> float:
    """The time of a motion's event, or the last requested time."""
    return float(m._asked.times[-1]) if m.event is None else m.event.time


def _at_its_end(m: Motion) -> Motion:
    """The motion with its end as last time, if it loses energy and ends between two requested times."""
    loses = has_friction(m.contact) or m.losses is not None
    if not loses or m.event is None or not m.t.size or m.t[-1] >= m.event.time:
        return m
    # a motion is integrated to 1e-12 before a face lands
    end = m.at([m.event.time * (1 - 1e-9), m.event.time])
    return end if end.t.size else m


def _phase_numbers(body: Body, phase: Phase, scale: Scale | None) -> Numbers:
    """A phase and its first state; with a scale, also in SI units."""
    state = phase.state
    found: Numbers = {"time": phase.time, "kind": phase.kind}
    found |= {name: getattr(state, name) for name in ("theta", "w1", "w2", "w3")}
    found |= {"slip": list(state._slip), "slip_speed": math.hypot(*state._slip)}
    found |= {"centre_speed": math.hypot(*body.centre_velocity(state))}
    found |= {"precession": state.precession, "spin": state.spin}
    found["rate"] = state.precession * math.sqrt(body.i3)
    if scale is None:
        return found
    found["seconds"] = scale.seconds(phase.time)
    fast = "slip_speed", "centre_speed"
    found |= {f"{x}_metres_per_second": scale.metres_per_second(found[x]) for x in fast}
    return found | {f"{x}_hertz": scale.turns(found[x]) for x in ("precession", "spin")}


_MOST_PHASES = 6


def _most_friction(m: Motion) -> float:
    """The largest coefficient of friction of a motion, apart from the times when the body is in the air."""
    needs = m.friction_coefficient
    return float((needs if m.natural._impacts is None else needs[m.normal > 0]).max(initial=0.0))


def _phase_rows(m: Motion, scale: Scale | None) -> Iterator[Row]:
    """The phases of a motion with friction and their first states, as rows."""

    def si(text: str) -> str:
        return "" if scale is None else text

    told = len(m.phases) if len(m.phases) <= _MOST_PHASES else _MOST_PHASES - 1
    for k, phase in enumerate(m.phases):
        if told <= k < len(m.phases) - 1:
            if k == told:
                yield f"... {len(m.phases) - told - 1} more phases", "", ""
            continue
        n = _phase_numbers(m.body, phase, scale)
        yield phase.kind, f"from t = {phase.time:.9g}", si(f"{n.get('seconds', 0.0):.6g} s")
        yield "  inclination", f"{phase.state.theta:.9g} rad", f"{math.degrees(phase.state.theta):.6f} deg"
        if phase.kind == "slipping":
            fast = f"{n.get('slip_speed_metres_per_second', 0.0):.6g} m/s"
            yield "  slip", f"{n['slip_speed']:.6g} sqrt(g R)", si(fast)
        fast = f"{n.get('centre_speed_metres_per_second', 0.0):.6g} m/s"
        yield "  speed of the centre", f"{n['centre_speed']:.6g} sqrt(g R)", si(fast)
        for name in ("precession", "spin"):
            yield f"  {name}", f"{n[name]:.6g}", si(f"{n.get(f'{name}_hertz', 0.0):.6g} turns/s")
        if phase.kind == "rolling" and not math.isnan(phase.state.contact_radius):
            yield "  still symbols", f"{phase.state.contact_radius:.4g} a turn", ""
    lasted = slipping_time(m.phases, _end(m))
    yield "slipping lasted", f"{lasted:.9g}", "" if scale is None else f"{scale.seconds(lasted):.6g} s"
