"""The advice of an error works: whoever follows it gets what was asked for, and where nothing helps there is none."""

import re
import warnings

import pytest

import spincyl as sc

COIN = sc.Body.solid(0.1)
MEASURED = sc.measured(outer_diameter="25.75mm", length="2.2mm", mass="8.5g")
STONE = sc.Ellipsoid.rattleback((5.0, 1.0, 0.9), twist=0.09)
SIZED = sc.Ellipsoid.rattleback(("80mm", "16mm", "14mm"), twist=0.09, mass="40g")
OWN = sc.custom.Couple(lambda theta, w, normal: -1e-3 * w)
STRIBECK = sc.custom.Friction(lambda speed: 0.2)
NAMES = (
    *(
        "phi",
        "normal",
        "contact_force",
        "slip",
        "dissipated",
        "phase",
        "phases",
        "drilling",
        "creep",
        "couple",
    ),
    *("height", "lift", "slip_other", "normal_other", "impacts", "lost_in_impacts", "work_lost"),
)
KINDS = [
    {},
    {"step": 1e-3},
    {"method": "rk4", "step": 1e-3, "mu": 1.0},
    {"beyond": True},
    {"contact": "smooth"},
    {"contact": sc.Coulomb(0.3)},
    {"contact": sc.Coulomb(0.3, patch=0.01)},
    {"contact": sc.Viscous(0.3)},
    {"contact": STRIBECK},
    {"losses": sc.loss.RollingResistance(1e-3)},
    {"losses": OWN},
    {"restitution": 0.0},
]


def of_a_body(kind, measured, plain=COIN, sized=MEASURED):
    """The body, its initial state and the kind; laws for a measured body have a unit."""
    kind, found = dict(kind), sized if measured else plain
    if measured and "contact" in kind and getattr(kind["contact"], "patch", 0):
        kind["contact"] = sc.Coulomb.from_si(0.3, patch="0.1mm", scale=found)
    if measured and isinstance(kind.get("contact"), sc.Viscous):
        kind["contact"] = sc.Viscous.from_si(1.0, scale=found)
    if measured and isinstance(kind.get("losses"), sc.loss.RollingResistance):
        kind["losses"] = sc.loss.RollingResistance.from_si("0.01mm", scale=found)
    return found, found.steady(0.5) if plain is COIN else found.spinning(1.0, pitch=0.01), kind


def of_a_stone(kind, measured):
    names = {"step", "method", "restitution"} & kind.keys()
    if names or any(getattr(law, "_function", None) for law in kind.values()):
        pytest.skip("a stone has no such motion")
    return of_a_body(kind, measured, STONE, SIZED)


def rolled(body, state, kind):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return sc.roll(body, state, [0.0, 0.01], **kind)


def has(m, name):
    """Whether a motion has an output; else the error's message."""
    try:
        getattr(m, name)
    except AttributeError as error:
        return str(error)
    return True


@pytest.mark.parametrize("kind", KINDS, ids=str)
@pytest.mark.parametrize("measured", [False, True])
@pytest.mark.parametrize("chosen", [of_a_body, of_a_stone])
def test_what_an_output_needs_is_advised_where_it_helps_and_only_there(chosen, kind, measured):
    body, state, kind = chosen(kind, measured)
    m = rolled(body, state, kind)
    for name in NAMES:
        said = has(m, name)
        if said is True or "only for bodies of revolution" in said:
            continue
        advice = re.search(r"give (\w+=.*?)(?:, or take m.wanting.*)? to roll(?:, without (.*))?", said)
        if advice is None:
            assert "a motion" in said and "has none" in said, said
            with pytest.raises(ValueError, match="restitution|patch"):
                rolled(body, state, kind | {"restitution": 0.0})
            continue
        words = {"sc": sc, "mu": 0.3, "eps": 0.01, "delta": 0.01, "body": body, "function": OWN.function}
        given = eval(f"dict({advice[1]})", words)
        if name.endswith("_other"):  # forces, too
            given["want"] = "force"
        left = {key: value for key, value in kind.items() if f"{key}=" not in (advice[2] or "")}
        assert has(rolled(body, state, left | given), name) is True, said
