"""Reading of the trajectory of a contact engine from a table, whose columns are found by their names."""

import os
import re
from typing import Any, NamedTuple

import numpy as np

from spincyl._input.numbers import Floats
from spincyl.lab._columns import METRES, SECONDS, Columns, columns_of, picked
from spincyl.lab._tracker import read_table

_TIMES = ("t", "time", "seconds", "simulation_time")


class _Vector(NamedTuple):
    """Names that a vector and its components may have in a table, and the units of its components."""

    words: tuple[str, ...]  #: names before the axis; "" is the axis alone
    axes: str  #: a letter for each component
    units: dict[str, float]


_PLACE = _Vector(("", "p", "pos", "position", "centre", "center", "com", "pose_position"), "xyz", METRES)
_TURN = _Vector(
    ("q", "quat", "quaternion", "orientation", "rotation", "pose_orientation"), "xyzw", {"": 1.0, "1": 1.0}
)


class Trajectory(NamedTuple):
    """Times in seconds, positions in metres, and quaternions in the order of the table."""

    time: Floats  #: (n,)
    position: Floats  #: (n, 3)
    orientation: Floats  #: (n, 4); x, y, z, w if each component has a column
    named: bool  #: whether each component of the quaternions has a column


def trajectory(table: Any) -> Trajectory:
    """The trajectory in a table: a path, a DataFrame, a structured array, or a dict of columns."""
    is_path = isinstance(table, str | os.PathLike)
    try:
        columns = read_table(table) if is_path else columns_of("time", table)
    except TypeError as e:
        raise TypeError(f"{e}; beside an array of times give position= and orientation=") from None
    told = f"time: the table {os.fspath(table)!r}" if is_path else "time: the table"
    alike: dict[str, str] = {}
    for name in columns:
        if (other := alike.setdefault(_plain(name), name)) != name:
            raise ValueError(f"{told}: {other!r} and {name!r} are names of the same column")
    time = picked(told, columns, _there(alike, _TIMES), SECONDS)
    place, _ = _components(told, columns, alike, _PLACE)
    turn, named = _components(told, columns, alike, _TURN)
    if not len(time.values) == len(place) == len(turn):
        lengths = f"{len(time.values)} times, {len(place)} positions and {len(turn)} quaternions"
        raise ValueError(f"{told}: expected columns of equal length, not {lengths}")
    return Trajectory(time.in_si, place, turn, named)


def _components(told: str, columns: Columns, alike: dict[str, str], of: _Vector) -> tuple[Floats, bool]:
    """Components of a vector, (n, k), and whether each has its own column, not all a common one."""
    words, axes, units = of
    whole = [alike[_plain(word)] for word in words if _plain(word) in alike and word]
    wide = [name for name in whole if np.ndim(columns[name]) == 2]
    if wide:
        return picked(told, columns, wide[:1], units, wide=True).in_si, False
    parts = (_there(alike, [f"{word}_{axis}" for word in words]) for axis in axes)
    found = [picked(told, columns, names, units) for names in parts]
    odd = next((one for one in found if one.values.shape != found[0].values.shape), None)
    if odd is not None:
        raise ValueError(f"{told}: expected columns of equal length; {odd.key} has {odd.values.shape}")
    return np.column_stack([one.in_si for one in found]), True


def _plain(name: str) -> str:
    """A name in small letters, without points, underscores, spaces and brackets."""
    return re.sub(r"[\W_]", "", name.lower())


def _there(alike: dict[str, str], names: Any) -> list[str]:
    """The column of a table that has one of `names`, as a list; else `names`, for a message about them."""
    found = [alike[_plain(name)] for name in names if _plain(name) in alike]
    short = [name.removeprefix("_").replace("q_", "q") for name in names]
    return found[:1] or short
