"""Projects of Tracker: .trk files, which are XML, and .trz files, which are zip files that contain one."""

import codecs
import math
import re
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

from spincyl._input.numbers import Floats
from spincyl.lab._columns import Camera, Columns
from spincyl.lab._contents import unpacked
from spincyl.lab._encoding import UTF_16, as_told, found_out, legible

_HOME = "org.opensourcephysics."
_PANEL, _POINT = _HOME + "cabrillo.tracker.TrackerPanel", _HOME + "cabrillo.tracker.PointMass"
_DECLARED = re.compile(rb"""\s*<\?xml[^>]{0,200}?encoding\s*=\s*["']([\w.:-]{1,40})["']""")
_MOST = 1_000_000  #: Largest number of elements of a project.
#: Undecoded bytes, which XML may not contain, and the private-use characters that replace them meanwhile.
_PRIVATE_OF_BYTE = dict(zip(range(0xDC80, 0xDD00), range(0xF780, 0xF800), strict=True))
_BYTE_OF_PRIVATE = {private: bare for bare, private in _PRIVATE_OF_BYTE.items()}


class _Builder(ElementTree.TreeBuilder):
    """Builds the tree of a project; ValueError for a document type, since it may define entities."""

    _count = 0

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        raise ValueError("the file contains <!DOCTYPE, which Tracker does not write")

    def start(self, tag: Any, attrs: Any, /) -> Any:
        self._count += 1
        if self._count > _MOST:
            raise ValueError(f"it has more than {_MOST:,} elements")
        return super().start(tag, attrs)


def project(raw: bytes, name: str, encoding: str | None) -> dict[str, Columns] | None:
    """The tracks of a Tracker project, zipped or not; None if the file is not such a project."""
    if raw[:4] == b"PK\x03\x04":
        packed = unpacked(raw, name, lambda inside: inside.suffix.lower() == ".trk")
        if len(packed) > 1:
            inside = ", ".join(one for one, _ in packed)
            raise ValueError(f"{name}: expected one Tracker project, not {len(packed)} ({inside}); unpack it")
        if not packed:
            return None
        name, raw = f"{name}: {packed[0][0]}", packed[0][1]
    text = _decoded(raw, name, encoding)
    head = text[:10_000].lstrip("\ufeff \t\r\n")
    if not head.startswith("<") or _HOME not in head:
        return None
    try:
        found = _tracks_of_points(_tree(text))
    except ValueError as e:
        raise ValueError(f"{name}: a Tracker project, but {e}") from None
    legible(name, [word for track in found.values() for pair in track.units.items() for word in pair])
    legible(name, found)
    return found


def _decoded(raw: bytes, name: str, encoding: str | None) -> str:
    """The text of a project in the given, marked or declared encoding, or else decoded like any text file."""
    declared = _DECLARED.match(raw[:400])
    if encoding is not None:
        return as_told(raw, name, encoding)
    try:
        if raw[:2] in UTF_16:
            return raw.decode("utf-16")
        if declared and codecs.lookup(declared[1].decode()).name != "utf-8":
            return raw.decode(declared[1].decode())
    except (ValueError, LookupError):  # not so, or a codec that is not for text
        pass
    return found_out(raw)


def _tree(text: str) -> Any:
    """The root of a project; ValueError with the line at which the XML is damaged."""
    parser = ElementTree.XMLParser(target=_Builder())
    try:
        parser.feed(text.translate(_PRIVATE_OF_BYTE))
        return parser.close()
    except ElementTree.ParseError as e:
        raise ValueError(f"line {e.position[0]} is damaged: {str(e).split(':')[0]}") from None


def _properties(of: Any) -> dict[str, Any]:
    """The properties of an XML object of a project, by name."""
    return {} if of is None else {one.get("name", ""): one for one in of if one.tag == "property"}


def _object_of_property(of: Any) -> Any:
    """The XML object in a property; None for a property without an object."""
    return None if of is None else of.find("object")


def _text(of: Any, default: str = "") -> str:
    """The text of an XML property, or `default` if the property is missing or empty."""
    return default if of is None or not of.text else str(of.text).strip().translate(_BYTE_OF_PRIVATE)


def _finite(own: dict[str, Any], name: str, default: float = math.nan) -> float:
    """The property `name` of an object as a number; ValueError if it is missing or not a finite number."""
    said = _text(own.get(name), str(default))
    try:
        found = float(said)
    except ValueError:
        found = math.nan
    if not math.isfinite(found):
        raise ValueError(
            f"it has no number {name!r}" if name not in own else f"{name} = {said[:40]!r} is not a number"
        )
    return found


def _frames(own: dict[str, Any]) -> Iterator[tuple[int, dict[str, Any]]]:
    """Numbers of the frames for which an object has data, and the data of each frame."""
    for name, one in _properties(own.get("framedata")).items():
        data = _object_of_property(one)
        if data is not None and re.fullmatch(r"\[\d{1,9}\]", name):
            yield int(name[1:-1]), _properties(data)


def _tracks_of_points(root: Any) -> dict[str, Columns]:
    """The tracks of the point masses of a project, in the unit of its scale of length and in seconds."""
    kind = root.get("class", root.tag)
    if kind != _PANEL:
        raise ValueError(f"of the kind {kind.rpartition('.')[2]!r}: open it in Tracker and save a single tab")
    own = _properties(root)
    moving = _text(own.get("referenceframe"))
    if moving:
        raise ValueError(f"its axes move with {moving!r}: choose the default reference frame and save it")
    marks, others = _marks(own)
    clip = _properties(_object_of_property(own.get("videoclip")))
    first, step = (int(_finite(clip, key, default)) for key, default in (("startframe", 0), ("stepsize", 1)))
    step = max(step, 1)
    last = first + step * (int(_finite(clip, "stepcount", 1e9)) - 1)
    shown = {
        name: {n: place for n, place in at.items() if first <= n <= last and (n - first) % step == 0}
        for name, at in marks.items()
    }
    frames = [n for at in shown.values() for n in at]
    if not frames:
        there = ", ".join([*(f"PointMass {name!r}" for name in marks), *others]) or "no track"
        outside = sum(map(len, marks.values()))
        told = f"; {outside} marks are outside its clip" if outside else ""
        raise ValueError(f"no point is marked in any frame: it has {there}{told}")
    begin, many = min(frames), (max(frames) - min(frames)) // step + 1
    if many * len(shown) > _MOST:
        raise ValueError(
            f"{len(shown)} tracks over {many} frames are too many; expected at most {_MOST:,} places"
        )
    n = begin + step * np.arange(many, dtype=np.float64)
    timing = _properties(_object_of_property(clip.get("video"))) | _properties(
        _object_of_property(own.get("clipcontrol"))
    )
    milliseconds = _finite(timing, "delta_t")
    if not milliseconds > 0:
        raise ValueError(f"delta_t = {milliseconds!r}: expected a positive duration of a frame")
    t = (_finite(clip, "starttime", 0.0) + (n - first) * milliseconds) / 1e3
    world, unit, camera = _world(own, n)
    found: dict[str, Columns] = {}
    for name, at in shown.items():
        places = np.full(many, complex(math.nan, math.nan))
        places[[(k - begin) // step for k in at]] = list(at.values())
        x, y = world(places)
        columns = [("t (s)", t.copy()), (f"x{unit}", x), (f"y{unit}", y)]
        if at:
            found[name] = Columns(columns)
            found[name].camera = camera
    return found


def _marks(own: dict[str, Any]) -> tuple[dict[str, dict[int, complex]], list[str]]:
    """Positions of the marks of point masses by track and frame, and the names of all other tracks."""
    marks: dict[str, dict[int, complex]] = {}
    others = []
    for one in own.get("tracks", ()):
        track = _object_of_property(one)
        if track is None:
            continue
        mine, kind = _properties(track), track.get("class", "")
        name = _text(mine.get("name"), "track")
        if kind != _POINT:
            others.append(f"{kind.rpartition('.')[2]} {name!r}")
        elif name in marks:
            raise ValueError(f"two tracks are called {name!r}")
        else:
            marks[name] = {n: complex(_finite(at, "x"), _finite(at, "y")) for n, at in _frames(mine)}
    return marks, others


class _World(NamedTuple):
    """Conversion of positions in the picture, in pixels, to the axes and unit of length of a project."""

    map: Callable[[Any], tuple[Floats, Floats]]  #: from positions in the picture, x + iy downward
    unit: str  #: of length, in brackets
    camera: Camera | None  #: the same map; None if the axes move or the scales of x and y differ


def _world(own: dict[str, Any], frames: Floats) -> _World:
    """Make the conversion of positions in the given frames from the axes and scale of a project."""
    keys = ("xorigin", "yorigin", "angle", "xscale", "yscale")
    system = _properties(_object_of_property(own.get("coords")))
    rows = sorted((n, *(_finite(at, key) for key in keys)) for n, at in _frames(system))
    if not rows:
        raise ValueError("it has no axes and no scale of length (coords)")
    n, x, y, angle, across, up = np.array(rows).T
    if not (across * up).all():
        raise ValueError("its scale of length is 0: calibrate it in Tracker")
    # axes keep their position from a frame in which they were moved to the next such frame
    held = np.maximum(np.searchsorted(n, frames, side="right") - 1, 0)
    unit = "px" if (across == 1).all() and (up == 1).all() else _text(own.get("length_unit"))
    unit = unit and f" ({unit})"

    def world(place: Any) -> tuple[Floats, Floats]:
        flat = (place.real - x[held]) / across[held] - 1j * (place.imag - y[held]) / up[held]
        turned = flat * np.exp(-1j * np.radians(angle[held]))
        return np.asarray(turned.real, np.float64), np.asarray(turned.imag, np.float64)

    used = np.unique(held)
    first = used[0]
    still = (
        all(np.ptp(column[used]) == 0 for column in (x, y, angle, across, up)) and across[first] == up[first]
    )
    axes = Camera(*(float(column[first]) for column in (x, y, across, angle)))
    return _World(world, unit, axes if still else None)
