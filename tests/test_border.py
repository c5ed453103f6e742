"""What crosses the border between Python and the core: names and codes, each told once."""

from typing import get_args

import pytest

import spincyl as sc
from spincyl import _contact, _core, _phases, loss

CODES = {name: dict(values) for name, values in _core.codes()}


@pytest.mark.parametrize("kind", [sc.Ending, sc.sweep.Status, sc.Region, sc.sweep.Answer])
def test_an_enumeration_has_the_names_and_codes_of_the_core(kind):
    assert {value.name: int(value) for value in kind} == CODES[kind.__name__]


def test_phases_tables_and_laws_have_the_names_of_the_core_in_its_order():
    assert {name: code for code, name in enumerate(_phases.KINDS)} == CODES["Phase"]
    assert get_args(_phases.Kind) == _phases.KINDS
    assert CODES["Table"] == _contact.TABLES and {*get_args(_contact.Contact)} < {*CODES["Table"]}
    laws = {x.__name__: x for x in loss.Law.__subclasses__()}
    assert sorted(laws) == sorted(CODES["Law"])
    for name, code in CODES["Law"].items():
        law = laws[name](0.25)
        assert law._coefficients == [0.25 if i == code else 0.0 for i in range(len(laws))]
        assert _core.loss_laws()[code] == (law._parameter, law.exponent)


def test_every_enumeration_of_the_core_is_one_of_these():
    assert sorted(CODES) == ["Answer", "Drift", "Ending", "Law", "Phase", "Region", "Status", "Table"]
    assert all(len({*codes.values()}) == len(codes) for codes in CODES.values())
