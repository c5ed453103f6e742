"""The help of every public class of results and codes names each of its fields and members."""

import dataclasses
import enum
import inspect
import re

import pytest

import spincyl as sc

#: A result whose attributes are those of another class.
AS = {"EllipsoidMotion": "Motion"}


def parts(kind):
    """The public fields of a class, or the members of an enumeration."""
    if issubclass(kind, enum.Enum):
        return list(kind.__members__)
    fields = getattr(kind, "_fields", None) or [x.name for x in dataclasses.fields(kind)]
    return [name for name in fields if not name.startswith("_")]


CLASSES = [
    kind
    for module in (sc, sc.data, sc.sweep, sc.parts)
    for kind in (getattr(module, name) for name in module.__all__)
    if inspect.isclass(kind) and (dataclasses.is_dataclass(kind) or issubclass(kind, enum.Enum | tuple))
]


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_the_help_of_a_class_explains_each_of_its_parts(kind):
    text = inspect.getdoc(getattr(sc, AS.get(kind.__name__, ""), kind))
    told = dict(re.findall(r"^(\w[\w, ]*?)(?: : .*)?\n    (\S.*)", text, re.M))
    named = {name: words for names, words in told.items() for name in names.split(", ")}
    assert parts(kind) and not [name for name in parts(kind) if not named.get(name)]
