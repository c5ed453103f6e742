"""Assembly of pages: style sheets, scripts and templates with fields."""

import html
import re
from collections.abc import Iterable, Mapping
from importlib.resources import files

#: Characters that HTML excludes: controls other than white space, surrogates and noncharacters.
_UNFIT = re.compile(
    "[\0-\x08\x0b\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufdd0-\ufdef"
    + "".join(chr(plane << 16 | low) for plane in range(17) for low in (0xFFFE, 0xFFFF))
    + "]"
)


def text(name: str) -> str:
    """The content of a file in the folder `js`, as text."""
    return files(__package__).joinpath("js", name).read_text("utf-8")


def line(name: str, value: str) -> str:
    """Text with tabs and newlines replaced by spaces; an error if it contains characters unfit for HTML."""
    if not isinstance(value, str):
        raise TypeError(f"{name}: expected text, not {type(value).__name__}")
    if unfit := _UNFIT.search(value):
        code = f"U+{ord(unfit[0]):04X}"
        raise ValueError(f"{name} = {value!r}: expected text without {code}, which HTML excludes")
    return re.sub(r"[\t\n\f\r]+", " ", value)


def style(names: Iterable[str]) -> str:
    """Style sheets without comments and without spaces next to punctuation."""
    bare = re.sub(r"/\*.*?\*/", "", "".join(map(text, names))).strip()
    return re.sub(r"[ \n]*([{};,])[ \n]*|(?<=:) ", r"\1", bare)


def colours(names: Iterable[str]) -> dict[str, tuple[float, float, float]]:
    """The daylight colours of style sheets, by name: red, green and blue from 0 to 1."""
    found = {}
    for name in names:
        for word, code in re.findall(r"--(\w+): #([0-9a-f]{6})", text(name).split("[data-night]")[0]):
            red, green, blue = (int(code[i : i + 2], 16) / 255 for i in (0, 2, 4))
            found[word] = (red, green, blue)
    return found


def script(names: Iterable[str]) -> str:
    """Scripts as one strict function without comments and needless spaces, since a page has to be small."""
    joined = re.sub(r"^\s+|(^|\s+)//( .*)?$\n?|^\n", "", "".join(map(text, names)), flags=re.M)
    return f'"use strict";\n(() => {{\n{_without_spaces(joined)}}})();'


def _without_spaces(code: str) -> str:
    """A script without spaces next to punctuation; strings and templates stay unchanged."""
    found, at = [], 0
    while at < len(code):
        end = _end_of_string(code, at) if code[at] in _QUOTES else _index_of_next(code, at, _QUOTES)
        piece = code[at:end]
        found.append(piece if code[at] in _QUOTES else _SPACED.sub("", piece))
        at = end
    return "".join(found)


_QUOTES = "\"'`"
#: A space next to punctuation, except those that separate "a + +b" and "a - -b".
_SPACED = re.compile(
    r"(?<=[][{}(),;=<>?:&|!*/%]) | (?=[][{}(),;=<>?:&|!*/%])|(?<=[+-]) (?![+-])|(?<![+-]) (?=[+-])"
)


def _index_of_next(code: str, at: int, signs: str) -> int:
    """Index of the first of these characters from `at` on, or the end."""
    return min((i for i in (code.find(sign, at) for sign in signs) if i >= 0), default=len(code))


def _end_of_string(code: str, at: int) -> int:
    """Index after the string that begins at `at`; a template may contain code with strings of its own."""
    quote, at, depth = code[at], at + 1, 0
    while code[at] != quote or depth:
        if depth and code[at] in _QUOTES:
            at = _end_of_string(code, at)
            continue
        if quote == "`" and ((depth and code[at] in "{}") or code.startswith("${", at)):
            depth += -1 if code[at] == "}" else 1
            at += code[at] == "$"
        at += 2 if code[at] == "\\" else 1
    return at + 1


_TELLS = """const b = document.body, tell = () => { const light = b.dataset.jpThemeLight;
light && this.contentWindow?.postMessage({ spincylNight: light === "false" }, "*"); };
tell(); new MutationObserver(tell).observe(b, { attributes: true });"""


_UNTRUSTED = "A page of spincyl: trust this notebook, or run the cell, to see it."


def frame(page: str, sandbox: str, look: str, name: str = "") -> str:
    """A page in a sandboxed frame; a notebook with a theme passes it on to the frame, light or dark.

    A notebook that is not trusted removes the frame and shows the text inside it.
    """
    told, called = html.escape(_TELLS.replace("\n", " ")), f' name="{name}"' if name else ""
    return (
        f'<iframe{called} sandbox="{sandbox}" allowfullscreen style="{look}" onload="{told}"'
        f' srcdoc="{html.escape(page)}">{_UNTRUSTED}</iframe>'
    )


def filled(template: str, fields: Mapping[str, str]) -> str:
    """A template with each field replaced once, in order; the inserted text is not searched for fields."""
    before, *rest = text(template).split("{")
    return before + "".join(fields[name] + after for name, after in (x.split("}", 1) for x in rest))
