"""The version, the date and the citation of the paper agree in all files that contain them."""

import json
import pathlib
import re
import tomllib

import pytest

import spincyl as sc

ROOT = pathlib.Path(__file__).parents[1]
VERSION = tomllib.loads((ROOT / "Cargo.toml").read_text("utf-8"))["package"]["version"]
CITATION = (ROOT / "CITATION.cff").read_text("utf-8")
PAGE = (ROOT / "docs/cite.md").read_text("utf-8")
PAPER = "10.1119/1.5086391"


def test_every_place_has_the_version_of_the_crate():
    assert sc.__version__ == VERSION
    assert re.findall(r"^version: (\S+)$", CITATION, re.M) == [VERSION]
    assert json.loads((ROOT / "codemeta.json").read_text("utf-8"))["version"] == VERSION
    assert re.findall(r"^  version = \{(.*)\},$", PAGE, re.M) == [VERSION]
    assert set(re.findall(r"\b\d+\.\d+\.\d+\b", PAGE)) == {VERSION}


def test_a_version_has_a_date_as_soon_as_it_is_released():
    newest, when = re.search(
        r"^## (\S+) \((.+)\)$", (ROOT / "CHANGELOG.md").read_text("utf-8"), re.M
    ).groups()
    assert newest == VERSION
    dates = [] if when == "unreleased" else [when]
    assert re.findall(r"^date-released: (\S+)$", CITATION, re.M) == dates
    software = re.search(r"@software\{.*?^\}", PAGE, re.M | re.S)[0]
    assert re.findall(r"^  date    = \{(.*)\},$", software, re.M) == dates


@pytest.mark.parametrize("file", ["CITATION.cff", "codemeta.json", "docs/cite.md", "README.md"])
def test_the_paper_has_one_doi(file):
    assert set(re.findall(r"10\.1119/1\.\d+", (ROOT / file).read_text("utf-8"))) == {PAPER}
