"""What goes together: every body, table, loss law and restitution, in one motion and in many, as docs/combinations.md says."""

import combinations as tried
import pytest


@pytest.fixture(scope="module")
def cells():
    pytest.importorskip("xarray")
    return tried.cells()


def test_each_combination_is_followed_or_refused_as_the_page_says(cells):
    page = tried.PAGE.read_text("utf-8")
    assert tried.written(page, cells) == page, "python tests/combinations.py --write writes the tables again"


def test_each_refusal_has_one_reason_and_each_reason_a_refusal(cells):
    refusals = {cell.refusal for cell in cells.values() if cell.refusal}
    assert {tried.reason(refusal) for refusal in refusals} == {*tried.REASONS}
    with pytest.raises(LookupError, match="0 reasons"):
        tried.reason("INVALID")


def test_one_motion_and_many_are_refused_for_the_same_reasons(cells):
    of = tried.letters(cells)
    assert {key[:-1] for key in of if of[*key[:-1], "one"] != of[*key[:-1], "many"]} == tried.EXCEPT


def test_what_is_followed_keeps_its_energy_and_is_the_same_in_a_sweep(cells):
    faults = {key: cell.faults for key, cell in cells.items() if cell.faults}
    assert not faults
    followed = [key for key, cell in cells.items() if not cell.refusal]
    assert len(followed) > len(cells) / 2
    assert any(key[3] == "0.5" and cells[key].lands for key in followed)
