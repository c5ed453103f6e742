"""The words of the live page in its languages: each is one file, in the folder `languages`.

In the scripts a word is `W("rate {0}", 5)`, and `N("rate")` is one that W takes later. Texts, titles and
labels of the page are words as they stand. A page has numbers in place of its words, and a table for each
language.
"""

import json
import re
from collections.abc import Iterable, Mapping
from functools import cache
from html.parser import HTMLParser
from importlib.resources import files

#: Languages in the order in which the page offers them, after English.
LANGUAGES = ("de", "fr", "es", "it", "pt", "ja", "zh")
_LITERAL = r'("(?:[^"\\]|\\.)*")'
_ASKED, _NAMED = re.compile(rf"\bW\({_LITERAL}"), re.compile(rf"\bN\({_LITERAL}\)")
#: Letters of quantities, fields of the template, and names that are the same in every language.
_SAME = re.compile(r"[^A-Za-z]*|[NFLv]|PNG|\{\w+\}")


class _Words(HTMLParser):
    """Texts, titles and labels of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.found: dict[str, None] = {}

    def handle_data(self, data: str) -> None:
        text = " ".join(data.split())
        if not _SAME.fullmatch(text):
            self.found[text] = None

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, text in attrs:
            if name in ("title", "aria-label") and text:
                self.handle_data(text)


def words_of(page: str, script: str, more: Iterable[str]) -> list[str]:
    """The English texts that a page and its script show, and those in `more`, each once."""
    reader = _Words()
    reader.feed(page)
    asked = [json.loads(word) for of in (_ASKED, _NAMED) for word in of.findall(script)]
    return [*dict.fromkeys([*reader.found, *asked, *more])]


def numbered(script: str, words: list[str]) -> str:
    """A script in which each text to be translated is replaced by its number in `words`."""
    number = {word: str(k) for k, word in enumerate(words)}
    script = _NAMED.sub(lambda found: number[json.loads(found[1])], script)
    return _ASKED.sub(lambda found: "W(" + number[json.loads(found[1])], script)


@cache
def language(code: str) -> tuple[str, Mapping[str, str]]:
    """The name of a language in that language, and its translations of English texts."""
    told = json.loads(files(__package__).joinpath("languages", f"{code}.json").read_text("utf-8"))
    return told["name"], told["words"]


def table(words: list[str]) -> str:
    """JSON with the name and the texts of each language; a text without translation stays English."""
    found: dict[str, tuple[str, list[str]]] = {"en": ("English", words)}
    for code in LANGUAGES:
        name, told = language(code)
        found[code] = (name, [told.get(word, word) for word in words])
    return json.dumps(found, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")
