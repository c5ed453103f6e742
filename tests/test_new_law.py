"""Files that list all loss laws by name: a failure names the law and the file that lacks it.

The table of the core comes first; other lists are derived from it where possible. CONTRIBUTING.md describes
how to add a law.
"""

import re
from pathlib import Path

import pytest

import spincyl as sc
from spincyl import _core, loss
from spincyl._contact import CODES
from spincyl.cli import _losses
from spincyl.sweep import _inputs

ROOT = Path(__file__).parents[1]
PACKAGE = Path(sc.__file__).parent
(PAGE,) = PACKAGE.rglob("play.state.js")
LAWS = [(name, parameter) for name, (parameter, _) in zip(CODES["Law"], _core.loss_laws(), strict=True)]


def typed(name):
    """The name of a law on the command line and in the address of the page."""
    return re.sub(r"\B(?=[A-Z])", "-", name).lower()


#: Each file with patterns that must match for a law with this name and this coefficient.
PLACES = {
    loss.__file__: (
        r"^class {name}\(Law\):$",
        r'^    "{name}",$',
        r"^    {name}\({parameter}\) +P = ",
    ),
    _losses.__file__: (r"^    loss\.{name}: ", r"^  {typed}=\S+ +or "),
    _inputs.__file__: (r"^    loss\.{name}: ",),
    PACKAGE / "studio/scene_data.py": (r'^    "{parameter}": \("',),
    PAGE: (r'^const LAWS = .*\W{typed}"?: "',),
    # a row in each of two tables
    ROOT / "docs/stops.md": (r"(?s)^\| `{name}\({parameter}\)` \| .*^\| `{name}\({parameter}\)` \| ",),
    ROOT / "docs/physics.md": (r"^\| `{name}` \| .* \| .* \| .* \| .* \|$",),
    ROOT / "docs/letters.md": (r"^\| .*`{parameter}`.* \| .*`loss` \|$",),
    ROOT / "docs/api.md": (r"^   loss\.{name}$",),
    ROOT / "tests/test_loss.py": (
        r'^    {name}: "{parameter}",$',
        r"^        {name}: lambda: ",
        r"^        {name}: (?!lambda)",
    ),
    ROOT / "tests/test_roll_losses.py": (r'^    "{name}": loss\.{name}\(|^    "{name}": DRY,$',),
    ROOT / "tests/test_sweep_losses.py": (r'^    "{name}": loss\.{name}\(',),
}


@pytest.mark.parametrize("path", PLACES, ids=lambda path: Path(path).name)
def test_every_law_of_loss_stands_in(path):
    text = Path(path).read_text("utf-8")
    lacking = [
        f"{name}: no line that matches {wanted}"
        for name, parameter in LAWS
        for pattern in PLACES[path]
        if not re.search(
            wanted := pattern.format(name=name, parameter=parameter, typed=typed(name)), text, re.M
        )
    ]
    assert not lacking, f"{path} lacks a loss law (CONTRIBUTING.md, To add a loss law)\n" + "\n".join(lacking)


def test_the_page_has_the_laws_in_the_order_of_the_core():
    (listed,) = re.findall(r"^const LAWS = \{(.*)\};$", PAGE.read_text("utf-8"), re.M)
    names = re.findall(r'([a-z][a-z0-9-]*)"?: "', listed)
    assert names == ["none", *(typed(name) for name, _ in LAWS)], f"{PAGE}: LAWS"
