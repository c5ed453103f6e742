"""Files that list all loss laws by name: a failure names the law and the file that lacks it.

The table of the core comes first; other lists are derived from it where possible. CONTRIBUTING.md describes
how to add a law.
"""

import json
import re
from pathlib import Path

import pytest

from spincyl import loss
from spincyl.cli import _losses
from spincyl.studio.pages import play

ROOT = Path(__file__).parents[1]
LAWS = [(law.__name__, parameter) for parameter, law in loss.KINDS.items()]

#: Each file with patterns that must match for a law with this name and this coefficient.
PLACES = {
    loss.__file__: (
        r"^class {name}\(Law\):$",
        r'^    "{name}",$',
        r"^    {name}\({parameter}\) +P = ",
    ),
    # a row in each of two tables
    ROOT / "docs/stops.md": (r"(?s)^\| `{name}\({parameter}\)` \| .*^\| `{name}\({parameter}\)` \| ",),
    ROOT / "docs/physics.md": (r"^\| `{name}` \| .* \| .* \| .* \| .* \|$",),
    ROOT / "docs/letters.md": (r"^\| .*`{parameter}`.* \| .*`loss` \|$",),
    ROOT / "docs/api.md": (r"^   loss\.{name}$",),
    ROOT / "tests/loss_rows.py": (
        r"^    loss\.{name}: LossRow\($|^    loss\.{name}: LossRow\(\"{parameter}\", ",
    ),
}


@pytest.mark.parametrize("path", PLACES, ids=lambda path: Path(path).name)
def test_every_law_of_loss_stands_in(path):
    text = Path(path).read_text("utf-8")
    lacking = [
        f"{name}: no line that matches {wanted}"
        for name, parameter in LAWS
        for pattern in PLACES[path]
        if not re.search(wanted := pattern.format(name=name, parameter=parameter), text, re.M)
    ]
    assert not lacking, f"{path} lacks a loss law (CONTRIBUTING.md, To add a loss law)\n" + "\n".join(lacking)


#: Files of the core that a new law touches: its own, the table, and the test with its power in SI.
CORE = ("src/laws/loss/mod.rs", "tests/laws/common/loss_power.rs")


def test_a_new_law_touches_few_files():
    # fourteen of these lists and five more of the core and of the tests, before the core told its table
    assert len(PLACES) + len(CORE) + 1 <= 9


def named(text):
    """The number of laws that a text names."""
    return sum(bool(re.search(rf"\b{name}\b", text)) for name, _ in LAWS)


def test_nothing_else_of_the_library_lists_the_laws():
    listed = {
        path.relative_to(ROOT).as_posix()
        for folder in ("src", "python", "web")
        for kind in ("*.rs", "*.py", "*.pyi", "*.js", "*.html")
        for path in (ROOT / folder).rglob(kind)
        if named(path.read_text("utf-8")) > len(LAWS) / 2
    }
    assert listed == {"src/laws/loss/mod.rs", "python/spincyl/loss.py"}


def test_the_command_line_and_the_page_have_the_laws_in_the_order_of_the_core():
    typed = ["dry-contour", "viscous-contour", "rolling-resistance", "drilling"]
    typed += ["air-linear", "air-quadratic", "air-film", "boundary-layer"]
    assert [*_losses._NAMES] == typed and [*_losses._NAMES.values()] == [parameter for _, parameter in LAWS]
    told = re.search(r"\[[^]]*boundary-layer[^]]*\]", "".join(play._body_and_script(True)))
    assert told and json.loads(told[0]) == typed
