"""The text of a file in UTF-8, in UTF-16 with a mark, or in an encoding that is given.

A short text does not reveal its encoding: the bytes of a Czech, Russian or Chinese name are also letters of
Western Europe. So no encoding is guessed. Bytes that are not UTF-8 remain undecoded, which does no harm in a
comment; in a name they raise an error.
"""

import zipfile
from collections.abc import Iterable
from io import BytesIO

UTF_16 = (b"\xff\xfe", b"\xfe\xff")


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
    """Raise ValueError for a name with undecoded bytes."""
    for one in names:
        if any("\udc80" <= letter <= "\udcff" for letter in one):
            shown = one.encode("utf-8", "surrogateescape").decode("utf-8", "replace")
            how = "give encoding=, as in encoding='cp1252' or encoding='gbk', or save it as UTF-8"
            raise ValueError(f"{name}: unknown encoding: {shown!r} is not UTF-8; {how}")


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
    """Text decoded as UTF-8, with other bytes as surrogates."""
    return raw.decode("utf-8", "surrogateescape")
