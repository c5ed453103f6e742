"""Blocks of the pages: code fits beside the menu, text blocks are the output of code, formulas are set."""

import pathlib
import re
import sys

import pytest

ROOT = pathlib.Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs"))
import blocks  # noqa: E402

STORIES = sorted(path for path in (ROOT / "docs").glob("*.md") if path.name != "api.md")
WIDEST = 88  # characters of code that fit the column of a page
SHOWN = {"bibtex", "console", "python", "rust", "sh", "text", "{live}", "{plot}"}


def shown(page):
    """The blocks of a page that show code or its output."""
    return [block for block in blocks.blocks(page.read_text("utf-8")) if block.kind in SHOWN]


@pytest.mark.parametrize("page", STORIES, ids=lambda page: page.name)
def test_no_line_of_code_is_cut_off(page):
    wide = [line for block in shown(page) for line in block.text.splitlines() if len(line) > WIDEST]
    assert not wide, "\n".join(wide)


def test_no_line_of_a_file_that_a_page_shows_is_cut_off():
    files = [block.words for page in STORIES for block in blocks.of_kind(page.read_text("utf-8"), "{source}")]
    assert len(files) >= 10
    for name in files:
        lines = (ROOT / name).read_text("utf-8").splitlines()
        wide = [number for number, line in enumerate(lines, 1) if len(line) > WIDEST]
        assert not wide, f"{name}: lines {wide}"


def test_every_text_is_what_the_code_before_it_prints():
    found = 0
    for page in STORIES:
        all_blocks = blocks.blocks(page.read_text("utf-8"))
        for i, block in enumerate(all_blocks):
            if block.kind == "text":
                found += 1
                code, said = all_blocks[i - 2].kind, all_blocks[i - 1].text.strip()
                printed = (
                    re.fullmatch(r"`python .+` prints", said.splitlines()[-1]) if said else code == "python"
                )
                assert printed, f"{page.name}: equations are formulas, in ```math:\n{block.text}"
    assert found > 60


def test_every_formula_names_a_module_that_opens_with_it():
    named = [
        module
        for page in ("physics", "slip")
        for module in re.findall(r"module\s+`([\w:]+)`", (ROOT / f"docs/{page}.md").read_text("utf-8"))
    ]
    assert len(set(named)) == len(named) >= 20, "each stands on one page only"
    for module in named:
        # pages name modules without their layer
        place, layers = f"*/{module.replace('::', '/')}", ROOT / "src"
        found = [*layers.glob(f"{place}.rs"), *layers.glob(f"{place}/mod.rs")]
        (path,) = [path for path in found if path.parent != layers / "python"]
        head = path.read_text("utf-8").split("\n\n")[0]
        assert re.search(r"^//! ```text\n(//! .+\n)+//! ```$", head, flags=re.M), module
