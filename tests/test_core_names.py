"""The border between Python and the core: each name, code and option is defined once."""

import ast
import pathlib
from typing import get_args

import pytest

import spincyl as sc
from spincyl import _asked, _contact, _core, _phases, loss

PACKAGE = pathlib.Path(sc.__file__).parent
CODES = {name: dict(values) for name, values in _core.codes()}


@pytest.mark.parametrize("kind", [sc.Ending, sc.sweep.Status, sc.Region, sc.RestsOn, sc.sweep.Answer])
def test_an_enumeration_has_the_names_and_codes_of_the_core(kind):
    assert {value.name: int(value) for value in kind} == CODES[kind.__name__]


def test_phases_tables_and_laws_have_the_names_of_the_core_in_its_order():
    assert {name.replace(" ", ""): code for code, name in enumerate(_phases.KINDS)} == CODES["Phase"]
    assert get_args(_phases.Kind) == _phases.KINDS
    assert CODES["Table"] == _contact.TABLES and {*get_args(_contact.Contact)} < {*CODES["Table"]}
    assert CODES["Face"] == _contact.FACES and {*get_args(_contact.Face)} == {*CODES["Face"]}
    laws = {x.__name__: x for x in loss.Law.__subclasses__()}
    assert sorted(laws) == sorted(CODES["Law"])
    for name, code in CODES["Law"].items():
        law = laws[name](0.25)
        assert law._coefficients == [0.25 if i == code else 0.0 for i in range(len(laws))]
        row = _core.loss_laws()[code]
        assert (row["parameter"], row["exponent"]) == (law._parameter, law.exponent)


def test_every_enumeration_of_the_core_is_one_of_these():
    assert sorted(CODES) == [
        "Answer",
        "Drift",
        "Ending",
        "Face",
        "Law",
        "Phase",
        "Region",
        "RestsOn",
        "Status",
        "Table",
    ]
    assert all(len({*codes.values()}) == len(codes) for codes in CODES.values())


# The options of a motion.


def calls(text):
    """The calls of the core that compute motions, with their arguments."""
    for x in ast.walk(ast.parse(text)):
        if isinstance(x, ast.Call) and ast.unparse(x.func) in {
            f"_core.{n}" for n in ("roll", "stones", "ensemble")
        }:
            yield [ast.unparse(argument) for argument in x.args]


def test_the_options_of_a_motion_cross_to_the_core_in_one_place():
    text = pathlib.Path(_asked.__file__).read_text("utf-8")
    (maker,) = (
        x for x in ast.parse(text).body if isinstance(x, ast.FunctionDef) and x.name == "options_for_core"
    )
    keys = {key.value for x in ast.walk(maker) if isinstance(x, ast.Dict) for key in x.keys}
    keys |= {
        x.slice.value
        for x in ast.walk(maker)
        if isinstance(x, ast.Subscript) and isinstance(x.slice, ast.Constant)
    }
    assert sorted(keys) == sorted(_core.motion_options())


def test_single_motions_and_sweeps_take_their_options_from_there():
    found = [
        (path.name, arguments)
        for path in sorted(PACKAGE.rglob("*.py"))
        for arguments in calls(path.read_text("utf-8"))
    ]
    assert sorted(name for name, _ in found) == [
        "_ellipsoid_motion.py",
        "_labels.py",
        "_motion.py",
        "_roll.py",
        "_stones.py",
    ]
    for name, arguments in found:
        # the options of a sweep come from `swept`, which makes them by `options_for_core`
        asks = any(x.startswith("options_for_core(") for x in arguments) or arguments[2] == "asked"
        assert asks or arguments[3] == "asked | given", name  # the first motion that a sweep refused
    swept = (PACKAGE / "sweep" / "_swept.py").read_text("utf-8")
    assert swept.count("options_for_core(") == 1 and "asked=options" in swept


@pytest.mark.parametrize("name", _core.motion_options())
def test_an_option_that_is_none_is_refused_by_its_name(name):
    body = sc.Body.solid(2.0)
    with pytest.raises(ValueError, match=f"no option of a motion: {name}s"):
        _core.roll(body._numbers, body.steady(1.3)._numbers, _asked.times_of(1.0), {f"{name}s": 1})
