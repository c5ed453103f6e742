"""Pages out of their files: style, script and a template with fields."""

import re
from collections.abc import Iterable, Mapping
from importlib.resources import files


def text(name: str) -> str:
    """A file of this folder."""
    return files(__package__).joinpath(name).read_text("utf-8")


def style(names: Iterable[str]) -> str:
    """Style sheets without their comments."""
    return re.sub(r"/\*.*?\*/\n", "", "".join(map(text, names))).strip()


def script(names: Iterable[str]) -> str:
    """Scripts in one strict function: a page is to be small, the source to be read."""
    joined = re.sub(r"^\s+|(^|\s+)//( .*)?$\n?|^\n", "", "".join(map(text, names)), flags=re.M)
    return f'"use strict";\n(() => {{\n{joined}}})();'


def filled(template: str, fields: Mapping[str, str]) -> str:
    """A template with each field once, in its order: what is put in is not looked at again."""
    before, *rest = text(template).split("{")
    return before + "".join(fields[name] + after for name, after in (x.split("}", 1) for x in rest))
