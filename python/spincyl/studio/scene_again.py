"""Body, start and options of a scene, from which its motion is computed, as the Rust crate writes them.

They are in natural units, with the names and forms of the crate's `Body`, `Ellipsoid`, `Start` and `Ask` in a
file, so that Python and Rust compute the motion of each other's files at any time.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from spincyl._body import Body
from spincyl._contact import AnyContact, Coulomb, Viscous
from spincyl._ellipsoid import Ellipsoid
from spincyl._ellipsoid_state import EllipsoidState
from spincyl._loss import LAWS, Law
from spincyl._motion import Motion
from spincyl._phases import has_friction
from spincyl._restitution import Restitution, coefficient_of, law_for_core, restitution_from_words
from spincyl._roll import roll
from spincyl._scale import Scale
from spincyl._state import State
from spincyl._table import Table

_NAMES = {"ring": "Ring", "disc": "Disc"}
#: The ratio of a time after the end of a motion to that end.
_AFTER = 1.001


def natural_data(m: Motion) -> dict[str, Any]:
    """Body, start and options of a motion in natural units, whose time begins at 0."""
    asked, kind = m._asked, m.body._in_files
    start: dict[str, Any] = {"state": _state_data(m.start), "slip": _slip(m), "time": 0.0, "aloft": None}
    if m.start.height is not None:
        start["aloft"] = [float(np.asarray(x)) for x in (m.start.height, m.start.lift)]
    ask: dict[str, Any] = {
        "table": _table_data(m.contact, asked.mu),
        "losses": {type(law).__name__: float(law.coefficient) for law in m.losses.laws} if m.losses else {},
        "method": "Exact",
        "restitution": None if asked.restitution is None else coefficient_of(asked.restitution),
        "slope": asked.slope,
    }
    if not asked.while_slipping:
        ask["resistance"] = "WhileRolling"
    if asked.step is not None or asked.tol is not None:
        ask["method"] = {"Tolerance": asked.tol} if asked.step is None else {"Step": asked.step}
    if (law := law_for_core(asked.restitution)) is not None:
        ask["impact_law"] = {law[0]: {"tangential": law[1]}} if law[0] == "Walton" else law[0]
    if isinstance(m.contact, Coulomb):
        ask["face"] = _NAMES[m.contact.face]
    if asked.table is not None:
        start["heading"], start["place"] = float(asked.table.phi0), [float(x) for x in asked.table.place]
    return {kind: _WRITERS[kind](m.body), "start": start, "ask": ask}


def _stone_data(stone: Any) -> dict[str, Any]:
    end = float(stone.theta_end)
    parts = {"axes": stone.semi_axes, "inertia": stone.inertia, "offset": stone.offset}
    numbers = {name: np.asarray(part).tolist() for name, part in parts.items()}
    return numbers | {"theta_end": math.pi if math.isnan(end) else end, "unit": 1.0}


def _body_data(body: Any) -> dict[str, Any]:
    numbers = {name: float(getattr(body, name)) for name in ("ell", "i1", "i3", "fillet")}
    if body.rims is not None:
        circles = [{"radius": r, "depth": -z, "fillet": f} for r, z, f in body.circles.tolist()]
        first = circles[0]
        return numbers | {"ell": first["depth"], "fillet": first["fillet"], "circles": circles}
    return numbers if math.isnan(body.theta_end) else numbers | {"theta_end": float(body.theta_end)}


_WRITERS = {"body": _body_data, "stone": _stone_data}


def _state_data(state: Any) -> dict[str, Any]:
    names = ("vertical", "w") if hasattr(state, "vertical") else ("theta", "w1", "w2", "w3")
    return {name: np.asarray(getattr(state, name), float).tolist() for name in names}


def _slip(m: Motion) -> list[float]:
    """The initial slip; of a body on its face by default the slip that leaves its centre at rest."""
    slip = m.start.slip
    if slip is None and m.body._in_files == "body" and "slip" in m._extra and m.theta[0] in (0, np.pi):
        slip = m._extra["slip"][0]
    return [0.0, 0.0] if slip is None else [float(x) for x in slip]


def _table_data(contact: AnyContact, mu: float) -> Any:
    if isinstance(contact, Coulomb):
        numbers = {
            "mu": float(contact.mu),
            "fixed": _finite_or_word(contact.static),
            "patch": float(contact.patch),
        }
        return {"Rubs": {"Coulomb": numbers}}
    if isinstance(contact, Viscous):
        return {"Rubs": {"Viscous": {"c": float(contact.c)}}}
    return "Smooth" if contact == "smooth" else {"Rolling": {"mu": _finite_or_word(mu)}}


def _finite_or_word(x: Any) -> float | str:
    """A finite number as it is, and infinity as the text "inf", since JSON has no infinity."""
    return float(x) if math.isfinite(x) else "inf"


def motion_of(data: dict[str, Any]) -> tuple[Motion, Scale]:
    """The motion of a scene at its times, with poses and forces, and its scale."""
    if "natural" not in data:
        raise ValueError(
            "path: expected a file with the key 'natural', from which the motion is computed again"
        )
    units, natural = data["scale"], data["natural"]
    scale = Scale(units["R"], mass=units["M"], gravity=units["g"])
    start, ask = natural["start"], natural["ask"]
    contact, mu = _natural_contact(ask)
    table = Table(
        ask.get("slope", 0.0), phi0=start.get("heading", 0.0), place=tuple(start.get("place", (0.0, 0.0)))
    )
    method = ask.get("method", "Exact")
    by = {} if method == "Exact" else {"Tolerance": "tol", "Step": "step"}
    how = {by[name]: value for name, value in method.items()} if by else {}
    resists = ask.get("resistance", "Always") == "Always"
    laws = [_law(name, value, resists) for name, value in ask.get("losses", {}).items()]
    body, known = _natural_body(natural), data["expected"]
    times, ending = known["time"], known["ending"]
    if ending["kind"] != "DONE":  # a time after the end, which the motion does not reach
        times = [*times, _AFTER * max(ending["time"], times[-1])]
    m = roll(
        body,
        _state(start, body, contact),
        np.array(times) / scale.seconds(1.0),
        t0=0.0,
        contact=contact,
        mu=mu,
        restitution=_restitution(ask),
        losses=sum(laws[1:], start=laws[0]) if laws else None,
        table=None if table == Table() else table,
        want=("pose", "force"),
        **how,
    )
    return m, scale


def _restitution(ask: dict[str, Any]) -> Restitution | None:
    e, law = ask.get("restitution"), ask.get("impact_law", "Stronge")
    if e is None or law == "Stronge":
        return e
    name, more = (law, {}) if isinstance(law, str) else next(iter(law.items()))
    return restitution_from_words({"restitution": e, "impact_law": name} | more)


def _natural_contact(ask: dict[str, Any]) -> tuple[AnyContact, float]:
    table = ask.get("table", {"Rolling": {"mu": "inf"}})
    if table == "Smooth":
        return "smooth", math.inf
    ((kind, numbers),) = table.items()
    if kind == "Rolling":
        return "rolling", float(numbers["mu"])
    ((law, own),) = numbers.items()
    if law == "Viscous":
        return Viscous(own["c"]), math.inf
    faces = {name: face for face, name in _NAMES.items()}
    face: Any = faces[ask.get("face", "Ring")]
    return Coulomb(own["mu"], static=float(own["fixed"]), patch=own["patch"], face=face), math.inf


def _law(name: str, coefficient: float, while_slipping: bool) -> Law:
    import spincyl.loss

    options = {} if while_slipping or name != "RollingResistance" else {"while_slipping": False}
    law: Law = getattr(spincyl.loss, name)(coefficient, **options)
    assert law._parameter in LAWS
    return law


def _natural_body(natural: dict[str, Any]) -> Body | Ellipsoid:
    if "stone" in natural:
        stone = natural["stone"]
        end = stone["theta_end"]
        ends = {} if end == math.pi else {"theta_end": end}
        return Ellipsoid(tuple(stone["axes"]), stone["inertia"], tuple(stone["offset"]), **ends)
    body = natural["body"]
    i1, i3 = body["i1"], body["i3"]
    if body.get("circles"):
        rows = [(x["radius"], -x["depth"], x["fillet"]) for x in body["circles"]]
        return Body.profile(rows, i1, i3, 0.0)
    end = body.get("theta_end")
    end = math.nan if end is None else end
    return Body(body["ell"], i1, i3, fillet=body.get("fillet", 0.0), theta_end=end)


def _state(start: dict[str, Any], body: Body | Ellipsoid, contact: AnyContact) -> Any:
    state = start["state"]
    aloft = start.get("aloft")
    height, lift = (None, None) if aloft is None else aloft
    slips = has_friction(contact) or aloft is not None
    slip = tuple(start.get("slip", (0.0, 0.0))) if slips else None
    if "vertical" in state:
        own = EllipsoidState(tuple(state["vertical"]), tuple(state["w"]), slip)
        return own if aloft is None else replace(own, height=height, lift=lift)
    return State(state["theta"], state["w1"], state["w2"], state["w3"], slip=slip, height=height, lift=lift)
