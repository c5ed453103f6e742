"""The text of a file in UTF-8, in UTF-16 with a mark, in an encoding that is given, or in Windows-1252.

A short text does not reveal its encoding: the bytes of a Czech, Russian or Chinese name are also letters of
Western Europe. So a file that is not UTF-8 is read as Windows-1252 only if every other usual encoding would
give the same or nonsense: symbols in units, and a few accented letters inside words. All other bytes remain
undecoded, which does no harm in a comment; in a name they raise an error.
"""

import codecs
import re
import unicodedata
import zipfile
from collections.abc import Iterable
from io import BytesIO
from itertools import pairwise

UTF_16 = (b"\xff\xfe", b"\xfe\xff")
#: Encodings that are tried to suggest readings of an undecoded name.
_USUAL = ("utf-8", "gbk", "big5", "cp932", "cp949", "cp1250", "cp1251", "cp1252", "cp1253")
_SHOWN = 8  # largest number of readings in a message
#: A cell with characters beyond ASCII. No separator can be the second byte of a two-byte character.
_CELL = re.compile(r"[^\t\n\r;,\"]*[^\x00-\x7f][^\t\n\r;,\"]*")
_NONE, _END = r"(?<![^\x00-\x7f])", r"(?![@-~]|[^\x00-\x7f])"
#: Characters that are certainly Windows-1252. A letter that might be a Greek symbol or a Russian word has to
#: be inside a word; no letter may begin or end a two-byte character of a Chinese name.
_CERTAIN = re.compile(
    "|".join(
        (
            rf"{_NONE}\xa0?°(?=[CF]?{_END})",
            rf"(?<![A-Za-z]){_NONE}µ(?=(?:m|s|g|l|L|N|T|V|A|W|J|Hz|Pa|rad)?{_END})",
            rf"(?<=[(\[/ ·*])(?:[mck]?m|m?s|rad|px|in|ft)²{_END}",
            rf"(?<=[(\[/ ·*])[mck]?m³{_END}",
            rf"(?<=[Nms])·(?=(?:m|s|rad){_END})",
            rf"{_NONE}(?:±(?= ?[0-9])|[\u2013\u2014\xa0]{_END})",
            r"(?<![^\x00-\x7fé])(?:é|É(?=[A-Za-z])|(?<=[A-Z])É)(?![^\x00-\x7fé])",
            rf"(?<=[A-Za-z])[üß](?:(?=[a-z])|{_END})",
            r"(?<=[A-Za-z])[äöüó]ß?(?=[a-z])",
            r"(?<=[A-Z])[ÄÖÜÓ](?=[A-Z])",
        )
    )
)
#: Characters that are valid UTF-8, but more probably two-byte characters of Chinese or Korean: letters of
#: rare alphabets, accents without a letter, and symbols that are not units.
_ODD = re.compile(
    r"[\x80-\x9f\u0180-\u019f\u01a2-\u01ae\u01b1-\u0258\u025a-\u02ff\u0370-\u0385\u03cf-\u0400\u0460-\u048f]"
    r"|[\u0492-\u05cf\u05eb-\u0620\u0653-\u065f\u0700-\u07ff]|(?<![A-Za-z])[\u0300-\u036f]|[\u030d-\u0326\u0329-\u036f]"
    r"|[\xa1-\xac\xaf\xb4\xb6\xb8\xb9\xbb\xbc\xbe\xbf]|\xb7(?![A-Za-z0-9])"
)
_LETTERS = re.compile(r"[^\W\d_]+")


def decoded(raw: bytes, name: str, encoding: str | None = None) -> str:
    """The text of a file; undecoded bytes are lone surrogates, which `legible` rejects in names."""
    if raw[:4] == b"PK\x03\x04":
        not_packed_project(raw, name)
        raise ValueError(f"{name}: expected text, not a workbook or zip file; export it as CSV")
    if encoding is not None:
        text = as_told(raw, name, encoding)
    elif raw[:2] in UTF_16:
        try:
            text = raw.decode("utf-16")
        except UnicodeDecodeError as e:
            raise ValueError(f"{name}: invalid UTF-16 at byte {e.start} of {len(raw)}") from None
    else:
        text = found_out(raw)
    text = text.removeprefix("\ufeff")
    if "\0" in text:
        raise ValueError(f"{name}: expected text; export it as CSV")
    top = text[:10_000].lstrip()
    if top.startswith("<") and "org.opensourcephysics" in top:
        raise ValueError(f"{name}: {_PROJECT}")
    if top.startswith("<") and "<phyphox" in top:
        raise ValueError(f"{name}: a phyphox experiment without its data; export the data as CSV")
    return text.replace("\u2212", "-")  # the typographic minus sign


_PROJECT = "a Tracker project, not a table; read it with data.read_tracker"


def legible(name: str, names: Iterable[str]) -> None:
    """Raise ValueError for names with undecoded bytes, and suggest readings."""
    for one in names:
        if one.isascii() or not any("\udc80" <= letter <= "\udcff" for letter in one):
            continue
        readings = _readings(one.encode("utf-8", "surrogateescape"))
        told = " or ".join(f"{text!r} ({', '.join(of)})" for text, of in list(readings.items())[:_SHOWN])
        told = f"a name may be {told}" if told else "a name is invalid in all usual encodings"
        like = next(iter(readings.values()), ["gbk"])[0]
        how = f"give encoding=, as in encoding={like!r}, or save it as UTF-8"
        raise ValueError(f"{name}: unknown encoding; {told}; {how}")


def _readings(raw: bytes) -> dict[str, list[str]]:
    """Readings of a name with their encodings; those with words of mixed alphabets come last."""
    found: dict[str, list[str]] = {}
    for encoding in _USUAL:
        try:
            text = raw.decode(encoding)
        except UnicodeDecodeError:
            continue
        if text.isprintable():
            found.setdefault(text, []).append(encoding)
    return {text: found[text] for text in sorted(found, key=_mixed)}


def _mixed(text: str) -> bool:
    """Whether a letter of another alphabet stands inside a word."""
    kinds = [unicodedata.name(c, "?").split()[0] if c.isalpha() else "" for c in text]
    alphabets = {"LATIN", "CYRILLIC"}  # a single Greek letter may be a symbol
    beside = {frozenset(pair) for pair in pairwise(kinds)}
    between = any(
        a == c == "LATIN" and b and b != a for a, b, c in zip(kinds, kinds[1:], kinds[2:], strict=False)
    )
    return between or any(len(pair & alphabets) > 1 for pair in beside)


def not_packed_project(raw: bytes, name: str) -> None:
    """Raise ValueError for a zip file that contains a Tracker project."""
    try:
        with zipfile.ZipFile(BytesIO(raw)) as file:
            names = file.namelist()
    except Exception:  # a damaged file raises errors of many kinds
        return
    if any(inside.endswith(".trk") for inside in names):
        raise ValueError(f"{name}: {_PROJECT}")


def as_told(raw: bytes, name: str, encoding: str) -> str:
    if not isinstance(encoding, str):
        raise TypeError(f"encoding: expected a name such as 'gbk', not {type(encoding).__name__}")
    try:
        return raw.decode(encoding)
    except UnicodeDecodeError as e:
        told = f"byte {e.start} of {len(raw)} is invalid"
    # includes codecs that are not for text, and names with a null character
    except (LookupError, ValueError):
        raise ValueError(
            f"encoding = {encoding!r}: expected the name of an encoding, such as 'gbk'"
        ) from None
    raise ValueError(f"{name}: cannot be decoded with encoding = {encoding!r}: {told}")


def found_out(raw: bytes) -> str:
    """Text decoded as UTF-8 or, if certain, Windows-1252; otherwise ASCII with surrogates."""
    if raw.isascii():
        return raw.decode("ascii")
    try:
        text = raw.decode("utf-8")
        if raw.startswith(codecs.BOM_UTF8) or not _doubtful(text):
            return text
    except UnicodeDecodeError:
        try:
            text = raw.decode("cp1252")
        except UnicodeDecodeError:
            text = ""
        if text and all(map(_western, set(_CELL.findall(text)))):
            return text
    return raw.decode("ascii", "surrogateescape")


def _doubtful(text: str) -> bool:
    """Whether valid UTF-8 could equally be a few two-byte characters of another encoding."""
    cells = _CELL.findall(text)
    letters = "".join({word for cell in cells for word in re.findall(r"[^\x00-\x7f]+", cell)})
    if len(letters) > 3 or max(letters) >= "\u0800":
        return False
    if not letters.replace("\xa0", "").isprintable() or any(map(_ODD.search, cells)):
        return True
    # expect Eastern European letters among others, Cyrillic ones not among Latin ones, few letters alone
    words = [word for cell in cells for word in _LETTERS.findall(cell) if not word.isascii()]
    return any(
        (len(letters) == len(word) == 1 and not re.match("[\u0386-\u03ceéàñåÅøØ]", word))
        or ("\u0100" <= max(word) < "\u0250" and sum(map(str.isascii, word)) < 2)
        or ("\u0400" <= max(word) < "\u0530" and min(word).isascii())
        for word in words
    )


def _western(cell: str) -> bool:
    """Whether a cell is certainly in Windows-1252."""
    if not _CERTAIN.sub("", cell).isascii():
        return False
    for word in _LETTERS.findall(cell):
        # require Latin letters in addition to an accented one, but not the pattern of Greek "dφdt"
        plain = sum(map(str.isascii, word))
        if re.search("[äöóÄÖÓüß]", word) and plain < (2 if re.search("[üß]", word) else 3):
            return False
        if re.match("d[äöó]d", word):
            return False
    if "é" in cell.lower():
        return sum(map(str.isascii, "".join(_LETTERS.findall(re.sub(r"[(\[].*", "", cell))))) > 2
    return re.search("[A-Za-z0-9]", cell) is not None or cell.strip(" ()[]") == "°"
