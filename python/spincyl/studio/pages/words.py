"""The words in which the live page describes bodies, initial states, contacts and losses, and its scenes."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from spincyl._body import Body
from spincyl._contact import AnyContact, Coulomb, Viscous, code_of, table_for_core
from spincyl._ellipsoid import Ellipsoid
from spincyl._input.numbers import in_range, instance_of, is_scalar
from spincyl._loss import Loss, command_line_name, marked_as_si
from spincyl._measured import measured
from spincyl._scale import Scale
from spincyl._state import State
from spincyl._table import Table
from spincyl._throw import pressed, thrown
from spincyl.loss import KINDS
from spincyl.studio import parts_shape
from spincyl.studio.surface import SHADE

#: The greatest slope of a table on the page.
STEEP = np.pi / 4
#: Least and greatest height of a frustum on the page, in units of its larger radius.
TALL = 0.05, 20.0


def words_of_body(body: Body) -> dict[str, Any]:
    """Keywords that describe a body in a page's address: the dimensions of a tube, or numbers of a body."""
    if isinstance(body, Ellipsoid):
        raise TypeError("body: expected a Body, not a stone; for the motion of a stone use sc.view")
    instance_of("body", body, Body)
    numbers = body.ell, body.i1, body.i3, body.fillet, body.theta_end, body.bore
    if not is_scalar(*numbers):
        raise ValueError("body: expected a single body, not a family")
    ell, i1, i3, fillet, most, bore = map(float, numbers)
    size = _words_of_scale(body.scale)
    frustum = _words_of_frustum(body)
    if frustum:
        return frustum | size
    if body.rims is not None and body.rims[0, 0] + fillet != 1:
        why = "expected a frustum, or a body whose lowest circle has the outer radius R"
        raise ValueError(f"body: {why}")
    if not np.isnan(bore):
        return {"ell": ell + fillet, "bore": bore, "fillet": fillet} | size
    told = {"ell": ell, "i1": i1, "i3": i3, "fillet": fillet} | size | _words_of_parts(body)
    return told if np.isnan(most) else told | {"end": most}


def _words_of_frustum(body: Body) -> dict[str, Any]:
    """Keywords for a solid frustum or cone: radii of both ends, and height; {} for another body."""
    if body.rims is None or len(body.rims) != 2:
        return {}
    (bottom, low, _), (top, high, _) = body.rims.tolist()
    if max(bottom, top) != 1 or body.rims[:, 2].any() or not TALL[0] <= high - low <= TALL[1]:
        return {}
    told = {"bottom": bottom, "top": top, "height": high - low}
    same = _natural_of(told)
    moments = [body.i1, body.i3], [same.i1, same.i3]
    near = same.rims is not None and np.allclose(*moments, rtol=1e-12, atol=0)
    return told if near and np.allclose(body.rims, same.rims, rtol=0, atol=1e-12) else {}


def _words_of_parts(body: Body) -> dict[str, Any]:
    """Keywords for the surfaces of a body made from parts: shade, stripes, and corners with normals."""
    if not body._parts and body.rims is None:
        return {}
    surfaces = parts_shape.profiles_of_parts(body)
    wide = list(map(id, parts_shape.striped(surfaces)))
    told = []
    for part in surfaces:
        pairs = zip(part.corners, part.normals, strict=True) if part.normals else zip(part.corners)
        corners = [[round(x, 6) for point in pair for x in point] for pair in pairs]
        told.append([int(part.colour == SHADE), int(id(part) in wide), corners])
    return {"parts": told}


def _words_of_scale(scale: Scale | None) -> dict[str, float]:
    """Keywords for a scale: radius in metres, mass if it is known, and gravity unless it is standard."""
    if scale is None:
        return {}
    told = {"radius": scale.radius, "mass": scale.mass, "gravity": scale.gravity}
    return {name: x for name, x in told.items() if x == x and not (name == "gravity" and x == Scale.gravity)}


def words_of_state(state: State) -> dict[str, Any]:
    """Keywords of a state in a page's address: the inclination, w1, w2, w3, and the slip."""
    instance_of("state", state, State)
    numbers = state.theta, state.w1, state.w2, state.w3
    if not is_scalar(*numbers):
        raise ValueError("state: expected a single state, not a family")
    slip = (0.0, 0.0) if state.slip is None else state.slip
    return {"theta": float(state.theta), "w": [float(x) for x in (*numbers[1:], *slip)]}


def words_of_table(contact: AnyContact) -> dict[str, Any]:
    """Keywords that describe a contact in a page's address: its name and its coefficient."""
    if not isinstance(contact, str) and isinstance(contact, Coulomb | Viscous):
        table_for_core(contact, 0.0)  # raises an error for a custom law
    if isinstance(contact, Coulomb | Viscous) and not is_scalar(*contact._numbers):
        raise ValueError(f"contact = {contact!r}: expected single numbers, not arrays")
    if isinstance(contact, Coulomb):
        if contact.static != contact.mu:
            raise ValueError(
                f"contact = {contact!r}: expected static = mu, since a page has no separate static friction"
            )
        patch = {"patch": in_range("patch", contact.patch, 0, 0.5)} if contact.patch else {}
        return {"contact": "coulomb", "mu": float(contact.mu)} | patch
    if isinstance(contact, Viscous):
        return {"contact": "viscous", "c": float(contact.c)}
    code_of(contact, rubs=True)
    return {"contact": contact}


def words_of_restitution(restitution: float | None) -> dict[str, Any]:
    """Keyword for a coefficient of restitution in a page's address; {} if the motion ends at lift-off."""
    return {} if restitution is None else {"restitution": in_range("restitution", restitution, 0, 1)}


def words_of_slope(table: Table | None) -> dict[str, Any]:
    """Keywords for a slope and the direction of the first lean in a page's address; {} for a level table."""
    if table is None:
        return {}
    instance_of("table", table, Table)
    if not is_scalar(table.slope, table.phi0, *table.place):
        raise ValueError(f"table = {table!r}: expected single numbers, not arrays")
    if table.turning != 0 or any(x != 0 for x in table.place):
        raise ValueError(f"table = {table!r}: expected turning = 0 and place = (0, 0), as on the page")
    slope = in_range("slope", float(table.slope), 0, STEEP, "radians")
    phi0 = in_range("phi0", float(table.phi0), -np.pi, np.pi, "radians")
    return {"slope": slope, "phi0": phi0} if slope else {}


def words_of_loss(losses: Loss | None) -> dict[str, Any]:
    """Keywords that describe a loss law in a page's address: its name and its coefficient."""
    if losses is None:
        return {}
    if not isinstance(losses, Loss):
        raise TypeError(f"losses: expected a loss from sc.loss, not {type(losses).__name__}")
    if len(losses.laws) != 1 or not is_scalar(losses.laws[0].coefficient):
        raise ValueError(
            f"losses = {losses!r}: expected one loss with a single coefficient, since a page has only one"
        )
    (law,) = losses.laws
    if not law._acts_in_slip:
        raise ValueError(f"losses = {losses!r}: expected while_slipping=True, as on the page")
    return {"law": command_line_name(type(law)), "loss": float(law.coefficient)}


def body_of(words: Mapping[str, Any]) -> Body:
    """The body that these keywords describe, with its size if a radius is given."""
    natural, radius = _natural_of(words), words.get("radius")
    if radius is None:
        return natural
    mass = words.get("mass")
    scale = Scale(radius, np.nan if mass is None else mass, words.get("gravity") or Scale.gravity)
    return replace(natural, scale=scale)


def _natural_of(words: Mapping[str, Any]) -> Body:
    if words.get("height") is not None:
        return Body.frustum(words["bottom"], words["top"], words["height"])
    if words.get("i1") is None:
        return Body.tube(words["ell"], words.get("bore", 0.0), words.get("fillet", 0.0))
    end = words.get("end")
    numbers = words["ell"], words["i1"], words["i3"]
    return Body(*numbers, fillet=words.get("fillet", 0.0), theta_end=np.nan if end is None else end)


def state_of(words: Mapping[str, Any]) -> State:
    """The state of these keywords; without w1, w2, w3 a steady state, or else rest; plus the kick."""
    theta, given, turning = words["theta"], words.get("w"), words.get("precession")
    if given:
        start = State(theta, *given[:3], slip=tuple(given[3:]) if any(given[3:]) else None)
    else:
        try:
            body = body_of(words)
            start = body.steady(theta) if turning is None else body.circular(theta, turning)
        except ValueError:
            start = State(theta, 0.0, 0.0, 0.0)
    return start.kicked(words.get("kick", 0.0))


def table_of(words: Mapping[str, Any]) -> AnyContact:
    """The law of contact with the table that these keywords of a page describe."""
    found: Any = words.get("contact", "rolling")
    # the unit was checked when it was set
    if found == "viscous":
        return Viscous(words["c"])._known()
    if found == "coulomb":
        return Coulomb(words["mu"], patch=words.get("patch", 0.0))._known()
    plain: AnyContact = found
    return plain


def restitution_of(words: Mapping[str, Any]) -> float | None:
    """The restitution that these keywords describe; None without friction, where the page has no bounces."""
    found: float | None = words.get("restitution")
    if found is None and words.get("height") is not None:
        return 0.0  # a page follows a frustum on both of its circles
    return found if words.get("contact") in ("coulomb", "viscous") else None


def slope_of(words: Mapping[str, Any]) -> Table | None:
    """The table that these keywords describe; None for a level table."""
    slope = words.get("slope")
    return Table(slope, phi0=words.get("phi0") or 0.0) if slope else None


def losses_of(words: Mapping[str, Any]) -> Loss | None:
    """The loss law that these keywords describe; None without losses."""
    name = words.get("law", "none")
    if name == "none" or not words.get("loss"):
        return None
    (kind,) = (kind for kind in KINDS.values() if command_line_name(kind) == name)
    return marked_as_si(kind(words["loss"]))  # its unit was checked when it was set


def scenes(friction: bool = True) -> Iterator[tuple[str, dict[str, Any]]]:
    """Name and keywords of each scene of the page; if `friction` is false, only scenes without friction."""
    for name, told in _all():
        if friction or not (
            "stone" in told or told.get("contact") in ("coulomb", "viscous") or "law" in told
        ):
            yield name, told


def paper_tube() -> Body:
    """The tube of the paper: a PVC tube, six diameters long, with an O on one end and an X on the other."""
    return measured(outer_diameter=15.875e-3, inner_diameter=12.7e-3, length=95.25e-3)


def _all() -> Iterator[tuple[str, dict[str, Any]]]:
    tube = paper_tube()
    disk = measured(outer_diameter=0.0751, length=0.0128, fillet=0.002)

    def steady(body: Body, theta: float, **more: Any) -> dict[str, Any]:
        return words_of_body(body) | {"theta": float(np.radians(theta))} | more

    def free(body: Body, state: State, contact: AnyContact, **more: Any) -> dict[str, Any]:
        return words_of_body(body) | words_of_state(state) | words_of_table(contact) | more

    yield "the paper's tube: six still symbols", steady(tube, 89.5, slow=20)
    flicked = pressed(tube.natural, 7.0, np.radians(80), finger=0.3)
    yield "the tube, flicked", free(tube, flicked, Coulomb(0.3), until=150, slow=10)
    hard = free(
        tube, pressed(tube.natural, 14.0, np.radians(80), finger=0.3), Coulomb(0.3), until=60, slow=20
    )
    yield "the tube, flicked too hard: it hops", hard | words_of_restitution(0.5)
    weak = free(tube, pressed(tube.natural, 5.0, np.radians(80), finger=0.3), Coulomb(0.3), until=60, slow=20)
    yield "the tube, flicked too gently: it stays down", weak | words_of_restitution(0.5)
    yield "a cylinder that nods", steady(Body.solid(2.5), np.degrees(1.3), kick=0.15)
    yield "a cylinder in the forbidden band", steady(Body.solid(2.5), 40.0, slow=10)
    yield "a disk on edge, on rubber", steady(Body.solid(0.375), 80.0, kick=-0.01)
    yield "the same disk on ice", steady(Body.solid(0.375), 80.0, kick=-0.01, contact="smooth")
    whirr = {"law": "dry-contour", "loss": 5e-3, "until": 400, "slow": 5}
    yield "Euler's disk comes to rest", steady(disk, 30.0, **whirr)
    yield "a coin whirrs", steady(Body.solid(0.05), np.degrees(0.25), kick=0.15, slow=20)
    yield "a can rocks", free(Body.solid(1.0), State(0.3, 1e-3, 0.0, 0.0), "rolling", slow=20)
    yield "Hurricane balls", steady(Body.balls(), 78.0, kick=0.02, slow=10)
    cup = Body.frustum(0.7, 1.0, 2.0)
    theta = float(cup.borders[0])
    push = 0.3 * np.sin(theta)  # it turns about its line of contact
    rolled = free(cup, State(theta, push, 0.0, -push * np.tan(theta)), Coulomb(0.6), until=60, slow=10)
    yield "a cup is rolled in a circle", rolled | words_of_restitution(0.0)
    # the top of Leine and Glocker, Eur. J. Mech. A 22, 193 (2003): 15 mm, 6 g, 180 rad/s
    top = Body.ball(-0.2, 8e-7 / (0.006 * 0.015**2), 7e-7 / (0.006 * 0.015**2))
    top = replace(top, scale=Scale(0.015, 0.006, 9.81))
    spun = top.with_centre_velocity(State(0.1, 0.0, 0.0, 180 * np.sqrt(0.015 / 9.81)), 0.0, 0.0)
    yield "a tippe top turns over on a wet table", free(top, spun, Viscous(0.3), until=200, slow=5)
    dry = Coulomb(0.3, patch=0.02)  # 0.3 mm
    yield "a tippe top turns over on a dry table, on a patch", free(top, spun, dry, until=150, slow=5)
    hoop = thrown(Body.tube(0.0, bore=1.0), velocity=2.0, backspin=3.0)
    yield "a hula hoop comes back", free(Body.tube(0.0, bore=1.0), hoop, Coulomb(0.25), until=40, slow=10)
    rattleback = {"stone": [0.07, 0.014, 0.012], "twist": float(np.radians(2.0)), "spin": -5.0, "slow": 1}
    yield "a rattleback turns back", rattleback
