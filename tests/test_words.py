"""One word for one thing: pages and docstrings of public names use the words of docs/letters.md."""

import ast
import pathlib
import re

import blocks
import pytest

ROOT = pathlib.Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
#: the word that is used, and how its replaced words are found
WORDS = {
    "still symbols": r"\b(?:letters?|O's|X's)\b(?:(?! symbols?\b)[^.,;:])* stands? still\b",
    "inclination": r"\b(?:the|its|a|this) (?:tilt|lean)\b|\btilting\b",
    "estimated error": r"\bclaim(?:s|ed|ing)?\b|\bdoubts?\b",
    "contact": r"\b(?:kinds of tables?|tables? that rubs?|on any table)\b",
}
#: files in which a replaced word may stand: the list of these words, measured tables, pages on other programs
ALLOWED = {
    "still symbols": "letters.md index.md",
    "inclination": "",
    "estimated error": "letters.md custom.md engines.md",
    "contact": "custom.md",
}


def prose(text):
    """Text without blocks of code, code in a line, and addresses of links."""
    return re.sub(r"`[^`]*`|(?<=\])\([^)]*\)", "", blocks.prose(text))


def docstrings(path):
    """Docstrings of the public classes and functions of a file, and of a public module."""
    nodes = [node for node in ast.walk(ast.parse(path.read_text("utf-8"))) if not private(node, path)]
    return "\n\n".join(filter(None, map(ast.get_docstring, nodes)))


def private(node, path):
    named = isinstance(node, ast.FunctionDef | ast.ClassDef)
    return not (named or isinstance(node, ast.Module)) or (node.name if named else path.stem)[:1] == "_"


def replaced(text, path):
    """The replaced words of a text that its file may not have, with the word to use instead."""
    barred = {use: pattern for use, pattern in WORDS.items() if path.name not in ALLOWED[use].split()}
    found = ((use, x[0]) for use, pattern in barred.items() for x in re.finditer(pattern, prose(text), re.I))
    return [f"{path.name}: {' '.join(word.split())!r}: {use}" for use, word in found]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_a_page_uses_one_word_for_one_thing(page):
    assert not (found := replaced(page.read_text("utf-8"), page)), "\n".join(found)


def test_public_docstrings_use_one_word_for_one_thing():
    files = sorted((ROOT / "python/spincyl").rglob("*.py"))
    texts = {path: docstrings(path) for path in files}
    assert sum(map(len, texts.values())) > 100_000
    found = [line for path, text in texts.items() for line in replaced(text, path)]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    "sentence",
    [
        "Six letters that stand still.",
        "The axes follow the tilt of the body.",
        "States are within the\nclaimed error.",
        "A motion on any table.",
    ],
)
def test_a_replaced_word_is_found(sentence):
    assert replaced(sentence, pathlib.Path("page.md"))
    assert not replaced(f"```py\n{sentence}\n```\n\n`{sentence}`\n", pathlib.Path("page.md"))
