"""The blocks of the pages: lines of code fit beside the menu, text is what code prints, formulas are set."""

import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).parents[1]
STORIES = sorted(path for path in (ROOT / "docs").glob("*.md") if path.name != "api.md")
WIDEST = 88  # letters of code in the column of a page
SHOWN = {"bibtex", "console", "python", "rust", "sh", "text", "{live}", "{plot}"}


def blocks(page):
    """(number of the first line, kind, lines, the last line of prose before it, kind of the block before it)."""
    kind, before, prose, first, lines = None, None, "", 0, []
    for number, line in enumerate(page.read_text("utf-8").splitlines(), 1):
        if kind is None and (found := re.match(r"```(\S*)", line)):
            kind, first, lines = found[1], number + 1, []
        elif kind is not None and line == "```":
            yield first, kind, lines, prose, before
            kind, before, prose = None, kind, ""
        elif kind is not None:
            lines.append(line)
        elif line.strip():
            prose = line


@pytest.mark.parametrize("page", STORIES, ids=lambda page: page.name)
def test_no_line_of_code_is_cut_off(page):
    wide = [
        f"{page.name}:{first + k}: {len(line)} letters"
        for first, kind, lines, *_ in blocks(page)
        if kind in SHOWN
        for k, line in enumerate(lines)
        if len(line) > WIDEST
    ]
    assert not wide, "\n".join(wide)


def test_no_line_of_a_file_that_a_page_shows_is_cut_off():
    shown = re.findall(r"^```\{source\} (\S+)$", "".join(page.read_text("utf-8") for page in STORIES), re.M)
    assert len(shown) >= 10
    for name in shown:
        lines = (ROOT / name).read_text("utf-8").splitlines()
        wide = [number for number, line in enumerate(lines, 1) if len(line) > WIDEST]
        assert not wide, f"{name}: lines {wide}"


def test_every_text_is_what_the_code_before_it_prints():
    found = 0
    for page in STORIES:
        for first, kind, _, prose, before in blocks(page):
            if kind == "text":
                found += 1
                printed = (before == "python" and not prose) or re.fullmatch(r"`python .+` prints", prose)
                assert printed, f"{page.name}:{first}: equations are formulas, in ```math"
    assert found > 60


def test_every_formula_names_a_module_that_opens_with_it():
    named = [
        module
        for page in ("physics", "slip")
        for module in re.findall(r"module\s+`([\w:]+)`", (ROOT / f"docs/{page}.md").read_text("utf-8"))
    ]
    assert len(set(named)) == len(named) >= 20, "each stands on one page only"
    for module in named:
        place = ROOT / "src" / module.replace("::", "/")
        path = place.with_suffix(".rs") if place.with_suffix(".rs").exists() else place / "mod.rs"
        head = path.read_text("utf-8").split("\n\n")[0]
        assert re.search(r"^//! ```text\n(//! .+\n)+//! ```$", head, flags=re.M), module
