"""Pages out of their files: style, script and a template with fields."""

import html
import re
from collections.abc import Iterable, Mapping
from importlib.resources import files

#: What cannot stand in HTML: controls but white space, halves of characters, and what is no character.
_UNFIT = re.compile(
    "[\0-\x08\x0b\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufdd0-\ufdef"
    + "".join(chr(plane << 16 | low) for plane in range(17) for low in (0xFFFE, 0xFFFF))
    + "]"
)


def text(name: str) -> str:
    """A file of the folder `js`."""
    return files(__package__).joinpath("js", name).read_text("utf-8")


def line(name: str, value: str) -> str:
    """Text for people to read, in which tabs and new lines are spaces; or what is wrong with it."""
    if not isinstance(value, str):
        raise TypeError(f"{name}: expected text, not {type(value).__name__}")
    if unfit := _UNFIT.search(value):
        code = f"U+{ord(unfit[0]):04X}"
        raise ValueError(f"{name} = {value!r}: expected text without {code}, which cannot stand in a page")
    return re.sub(r"[\t\n\f\r]+", " ", value)


def style(names: Iterable[str]) -> str:
    """Style sheets without their comments and the spaces round their signs."""
    bare = re.sub(r"/\*.*?\*/", "", "".join(map(text, names))).strip()
    return re.sub(r"[ \n]*([{};,])[ \n]*|(?<=:) ", r"\1", bare)


def colours(names: Iterable[str]) -> dict[str, tuple[float, float, float]]:
    """The colours that style sheets have in daylight, by name: red, green and blue from 0 to 1."""
    found = {}
    for name in names:
        for word, code in re.findall(r"--(\w+): #([0-9a-f]{6})", text(name).split("[data-night]")[0]):
            red, green, blue = (int(code[i : i + 2], 16) / 255 for i in (0, 2, 4))
            found[word] = (red, green, blue)
    return found


def script(names: Iterable[str]) -> str:
    """Scripts in one strict function: a page is to be small, the source to be read."""
    joined = re.sub(r"^\s+|(^|\s+)//( .*)?$\n?|^\n", "", "".join(map(text, names)), flags=re.M)
    return f'"use strict";\n(() => {{\n{_tight(joined)}}})();'


def _tight(code: str) -> str:
    """A script without the spaces round its signs; what stands in quotes stays as it is."""
    found, at = [], 0
    while at < len(code):
        end = _quoted(code, at) if code[at] in _QUOTES else _next(code, at, _QUOTES)
        piece = code[at:end]
        found.append(piece if code[at] in _QUOTES else _SPACED.sub("", piece))
        at = end
    return "".join(found)


_QUOTES = "\"'`"
#: A space beside a sign, but for those that keep "a + +b" and "a - -b" apart.
_SPACED = re.compile(
    r"(?<=[][{}(),;=<>?:&|!*/%]) | (?=[][{}(),;=<>?:&|!*/%])|(?<=[+-]) (?![+-])|(?<![+-]) (?=[+-])"
)


def _next(code: str, at: int, signs: str) -> int:
    """Where the next of these signs is, or the end."""
    return min((i for i in (code.find(sign, at) for sign in signs) if i >= 0), default=len(code))


def _quoted(code: str, at: int) -> int:
    """Where what is quoted from here on ends; a template may hold code, with quotes of its own."""
    quote, at, depth = code[at], at + 1, 0
    while code[at] != quote or depth:
        if depth and code[at] in _QUOTES:
            at = _quoted(code, at)
            continue
        if quote == "`" and ((depth and code[at] in "{}") or code.startswith("${", at)):
            depth += -1 if code[at] == "}" else 1
            at += code[at] == "$"
        at += 2 if code[at] == "\\" else 1
    return at + 1


_TELLS = """const b = document.body, tell = () => { const light = b.dataset.jpThemeLight;
light && this.contentWindow?.postMessage({ spincylNight: light === "false" }, "*"); };
tell(); new MutationObserver(tell).observe(b, { attributes: true });"""


_UNTRUSTED = "Here is a page of spincyl. It is shown when this notebook is trusted, or its cell is run."


def frame(page: str, sandbox: str, look: str, name: str = "") -> str:
    """A page in a frame that may do no more than this; a notebook that has a theme tells it there.

    What stands in the frame is seen where a notebook that is not trusted takes the frame away.
    """
    told, called = html.escape(_TELLS.replace("\n", " ")), f' name="{name}"' if name else ""
    return (
        f'<iframe{called} sandbox="{sandbox}" allowfullscreen style="{look}" onload="{told}"'
        f' srcdoc="{html.escape(page)}">{_UNTRUSTED}</iframe>'
    )


def filled(template: str, fields: Mapping[str, str]) -> str:
    """A template with each field once, in its order: what is put in is not looked at again."""
    before, *rest = text(template).split("{")
    return before + "".join(fields[name] + after for name, after in (x.split("}", 1) for x in rest))
