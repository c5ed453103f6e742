"""docs/thresholds.md names the constants of the source as they are, and what measures it sees what changes."""

import math
import re

import pytest
import thresholds
from thresholds import Result, change

PAGE = thresholds.PAGE.read_text("utf-8")
ROWS = thresholds.thresholds(PAGE)
LEFT_OUT = thresholds.left_out()


def source(file):
    return (thresholds.ROOT / file).read_text("utf-8")


SOURCES = {
    path.relative_to(thresholds.ROOT).as_posix(): path.read_text("utf-8")
    for path in (thresholds.ROOT / "src").rglob("*.rs")
}


def test_every_threshold_of_the_page_has_its_value_in_its_file():
    assert len(ROWS) > 40
    wrong = [row[:3] for row in ROWS if thresholds.constants(source(row.file)).get(row.name) != row.value]
    assert not wrong


def test_every_constant_of_these_files_is_on_the_page_or_left_out_for_a_reason():
    listed = [(row.file, row.name) for row in ROWS] + LEFT_OUT
    assert len(set(listed)) == len(listed)
    files = {row.file for row in ROWS}
    there = {(file, name) for file in files for name in thresholds.constants(source(file))}
    assert there == set(listed)


def test_every_row_has_been_measured():
    cell = re.compile(r"no motion changes|1 motion changes(; [^;]+)*|\d+ motions change(; [^;]+)*")
    for row in ROWS:
        halved, doubled, *far = row.told
        assert cell.fullmatch(halved), row
        assert cell.fullmatch(doubled), row
        assert len(far) == 2 and all(re.fullmatch(r"\d+|fails|too long", x) for x in far), row


def test_a_threshold_becomes_a_call_wherever_it_is_used():
    after = thresholds.changed(SOURCES, ROWS)
    for k, row in enumerate(ROWS):
        assert f"fn {row.name}() -> " in after[row.file]
        assert sum(text.count(f"crate::changed({k}, ") for text in after.values()) == 1
        assert sum(text.count(f"{row.name}()") for text in after.values()) > 1, row
    # comments and imports stay as they are, and so does a constant of the same name elsewhere
    assert "use crate::laws::contact::{Contact, FLAT};" in after["src/motions/rk4/steps.rs"]
    assert "const SLACK: f64" in after["src/motions/drift/mod.rs"]
    assert "SLACK()" not in after["src/motions/drift/course.rs"]


def end(ending="Done", time=3.0, phases=2, error=1e-12, numbers=(1.0, 0.5)):
    return Result(ending, time, phases, error, numbers)


def test_what_changes_is_seen():
    base = end()
    same = change(base, end())
    assert not same.moves
    moved = change(base, end(numbers=(1.0, 0.5 + 1e-12)))
    assert moved.moves
    assert moved.off == pytest.approx(1e-12, rel=1e-3)
    assert moved.ratio == pytest.approx(0.5, rel=1e-3)
    assert not (moved.otherwise or moved.phases or moved.lost)
    assert change(base, end(numbers=(1.0, 0.6))).ratio > 1e10
    assert change(base, end("Face", 2.0)).otherwise
    # what ends at the last time asked for may just miss it
    assert not change(base, end("Face", 3.0 - 1e-13)).otherwise
    assert change(base, end(phases=3)).phases
    lost = change(base, end(error=math.inf, numbers=(7.0, 7.0)))
    assert lost.lost
    assert lost.ratio == 0.0
    assert thresholds.said([same]) == "no motion changes"


def test_a_cell_says_what_was_seen_and_what_is_allowed():
    base = end()
    seen = [
        change(base, x)
        for x in (base, end(numbers=(1.0, 0.6)), end("Face", 2.0), end(phases=3), end(error=math.inf))
    ]
    cell = thresholds.said(seen)
    assert (
        cell
        == "4 motions change; 1 by more than the estimated errors, at most by 1e-01; 1 has another number of phases; "
        "1 has another ending; 1 has no estimated error any more"
    )
    assert thresholds.allowed(cell) == [1, 1, 1]
    assert thresholds.allowed("no motion changes") == [0, 0, 0]


def test_the_page_is_written_where_it_was_read():
    row = ROWS[0]
    page = thresholds.written(PAGE, {(row.name, row.file): ["no motion changes", "3 motions change", "1, 2"]})
    assert thresholds.thresholds(page)[0] == row._replace(
        told=("no motion changes", "3 motions change", "1, 2")
    )
    assert thresholds.thresholds(page)[1:] == ROWS[1:]
    assert thresholds.written(PAGE, {}) == PAGE
