"""The advice of an error works: whoever follows it gets what was asked for, and where nothing helps there is none."""

import re
import warnings

import numpy as np
import pytest

import spincyl as sc
from spincyl import parts
from spincyl._input import units

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
        assert advice is not None, said
        words = {"sc": sc, "mu": 0.3, "eps": 0.01, "delta": 0.01, "body": body, "function": OWN.function}
        given = eval(f"dict({advice[1]})", words)
        if name.endswith("_other"):  # forces, too
            given["want"] = "force"
        left = {key: value for key, value in kind.items() if f"{key}=" not in (advice[2] or "")}
        assert has(rolled(body, state, left | given), name) is True, said


@pytest.mark.parametrize("unit", [*units._KINDS, "radian"])
def test_the_example_of_a_missing_unit_is_of_the_same_quantity(unit):
    with pytest.raises(TypeError, match=r"or a text with a unit, as '[^']+', not '3'$") as caught:
        units.number_in_si("3", unit)
    assert units.number_in_si(re.search(r"as '([^']+)'", str(caught.value))[1], unit) > 0


RIM = parts.cylinder(outer_diameter="300mm", length="20mm", mass="0.5kg", at="90mm")
STEM = sc.Body(0.8, 0.5, 0.45, theta_end=0.55)
DRIFT = sc.drift(COIN, 0.3, sc.loss.ViscousContour(1e-3))


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (
            lambda: sc.measured(outer_diameter="22mm", length="66mm", mass="30"),
            "mass: .* as '30g', not '30'$",
        ),
        (lambda: sc.roll(MEASURED, MEASURED.steady(0.5), "2"), "t: .* as '2s', not '2'$"),
        (
            lambda: sc.data.fit_stop(MEASURED, sc.loss.DryContour, "20deg", ["7,2", "7,1"]),
            "seconds: .* a decimal point, not a comma, and no quotes: 7.2$",
        ),
        (lambda: parts.ball(diameter="2cm", density="stel"), "density = 'stel': expected 'steel'"),
        (lambda: sc.assembled([]), "parts: expected at least one part, not an empty list$"),
        (
            lambda: sc.data.fit_losses(np.arange(8) / 10, np.full(8, 0.35), body=MEASURED),
            "theta: expected values that change with t; all are 0.35$",
        ),
        (
            lambda: STEM.circular(np.radians(75), radius=3.0),
            "theta = 1.3.*: expected at most theta_end = 0.55.*, where another part lands$",
        ),
        (
            lambda: DRIFT.theta(Labelled()),
            "t: expected numbers or a NumPy array, not Labelled; give its values",
        ),
        (lambda: RIM.raised("1 s"), "by: '1 s': expected a length"),
        (
            lambda: sc.view(sc.roll(COIN, COIN.steady(0.5), 1.0), exposure=np.ones(3)),
            "exposure: expected a number",
        ),
        (
            lambda: sc.scene(sc.roll(COIN, COIN.steady(0.5), 1.0)).save(""),
            "path = .*: expected the name of a file$",
        ),
        (lambda: COIN.steady(np.ones((1,) * 40)), "theta: expected at most 31 dimensions, not 40$"),
    ],
)
def test_a_message_names_the_argument_and_what_would_be_right(call, said):
    with pytest.raises((TypeError, ValueError), match=f"^{said}"):
        call()


class Labelled:
    dims = ("x",)


def test_a_column_of_names_is_named(tmp_path):
    (tmp_path / "class.csv").write_text("student;angle (deg);time (s)\nS1;10;0,38\nS2;20;0,85\nS3;30;1,84\n")
    table = sc.data.read_table(tmp_path / "class.csv")
    assert list(table) == ["angle", "time"] and table["time"].tolist() == [0.38, 0.85, 1.84]
    assert table.texts == {"student": ("S1", "S2", "S3")} and table.units["angle"] == "deg"
    with pytest.raises(
        KeyError, match="'student': a column of text, not of numbers; its cells are in .texts"
    ):
        table["student"]
    (tmp_path / "class.csv").write_text("student;angle (deg);time (s)\nS1;10;0,38\nS2;late;0,85\n")
    with pytest.raises(
        ValueError, match="line 3 has the text 'late' in the column 'angle .deg.': expected only"
    ):
        sc.data.read_table(tmp_path / "class.csv")
