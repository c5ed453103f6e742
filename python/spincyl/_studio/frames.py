"""The picture of the page for each frame of a film, drawn without a browser.

Bodies, marks, camera, light and colours are those of the page. Agg (matplotlib) fills the triangles at twice
the resolution of the film, which is then averaged. Pieces of a body are drawn in painter's order: along the
axis from far to near, inner surfaces before outer ones, marks last.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from spincyl._ellipsoid import Ellipsoid
from spincyl._input.numbers import Floats, extra
from spincyl._motion import Motion
from spincyl._phases import rubs
from spincyl._studio.aloft import FLIES, SLIPS, aloft, goes_up, tops
from spincyl._studio.poses import seen, span
from spincyl._studio.shadow import LAMPS, MANY, Caster, caster, lamps, layer, outline, shadows
from spincyl._studio.shape import Letter, Part, lathe, marks, profiles, rotations, size
from spincyl._studio.shape import reach as farthest

_MOST = 20_000  # frames
_FINE = 2  # pixels of Agg for one pixel of the film, along each side
_PATH = 6000  # points of the contact's path
_AZIMUTH, _ELEVATION = -1.1, 0.55  # direction of the page's first view
_SPREAD = math.tan(0.3)  # tangent of half the angle of view
_SUN = np.array([-0.45, -0.5, 0.75]) / math.sqrt(0.45**2 + 0.5**2 + 0.75**2)


class Reel(NamedTuple):
    """A film: its motions and settings."""

    motions: Sequence[Motion]
    labels: Sequence[str]
    edges: Sequence[dict[str, Any]]  #: notes of the page before and after each motion
    unit: float  #: seconds in a unit of time; an assumed number without a scale
    symbol: str
    rates: str  #: the unit of angular velocities
    slow: int
    upper: Letter
    fps: int
    size: tuple[int, int]
    seconds: float  #: longest duration of the film
    colours: Mapping[str, tuple[float, float, float]]  #: those of the page in daylight, by name

    @property
    def times(self) -> Floats:
        """Times of the frames in units of time, from the first to the last time of the motions.

        The last frame shows the last state; it stays for a second if a motion has ended there.
        """
        spans = [sorted(span(m)) for m in self.motions]
        first, last = min(a for a, _ in spans), max(b for _, b in spans)
        step = 1 / (self.fps * self.slow * self.unit)
        cut = last > (until := first + step * self.fps * self.seconds)
        last = min(last, until)
        count = math.floor((last - first) / step * (1 + 1e-12)) + 1
        if count > _MOST:
            raise ValueError(f"{count} frames are too many: at most {_MOST}; give fewer seconds= or fps=")
        times = np.minimum(first + step * np.arange(count + 1), last)
        if last - times[-2] < 1e-9 * step:
            times = times[:-1]
        ended = not cut and any(edge["after"]["event"] and edge["after"]["at"] >= last for edge in self.edges)
        return np.append(times, np.full(self.fps if ended else 0, last))


class _Piece(NamedTuple):
    """A part of the surface and its range of heights along the axis."""

    part: Part
    low: float
    high: float
    inside: bool


def _pieces(m: Motion, upper: Letter) -> list[_Piece]:
    """The pieces of the surface, each followed by the marks on it."""
    found = []
    for profile in profiles(m.body):
        part = lathe(profile)
        heights = part.vertices[:, 2]
        outward = profile.name not in ("bore",)
        found.append(_Piece(part, float(heights.min()), float(heights.max()), not outward))
    low, high = min(p.low for p in found), max(p.high for p in found)
    several = any(p.part.name in ("lower ball", "stem") for p in found)
    if not several:
        found = [p._replace(low=low, high=high) for p in found]
    for part in marks(m.body, upper):
        z = part.vertices[:, 2].mean()
        on = next((p for p in found if p.low <= z <= p.high and not p.inside), found[0])
        found.append(_Piece(part, on.low, on.high, False))
    return found


class _Camera(NamedTuple):
    """The page's camera: the middle of its view, its distance, and its three directions."""

    at: Floats
    far: float
    high: float
    rows: Floats  #: right, up, back

    @property
    def eye(self) -> Floats:
        """Position of the camera."""
        found: Floats = self.at + self.far * self.rows[2]
        return found

    def __call__(self, places: Floats) -> Floats:
        """Positions of points (..., 3) in the picture, whose half height is 1."""
        x, y, back = np.moveaxis((places - self.at) @ self.rows.T, -1, 0)
        found: Floats = self.far / self.high * np.stack([x, y], -1) / (self.far - back)[..., np.newaxis]
        return found


def _camera(at: Floats, reach: float, half: float, aspect: float) -> _Camera:
    ce, se = math.cos(_ELEVATION), math.sin(_ELEVATION)
    ca, sa = math.cos(_AZIMUTH), math.sin(_AZIMUTH)
    back, right = np.array([ce * ca, ce * sa, se]), np.array([-sa, ca, 0.0])
    high = max(half, 1.12 * reach / aspect)
    return _Camera(at, high / _SPREAD, high, np.stack([right, np.cross(back, right), back]))


class _Shown(NamedTuple):
    """A motion, evaluated at the times of the frames."""

    centre: Floats  #: (n, 3)
    rotation: Floats  #: (n, 3, 3)
    theta: Floats
    spin: Floats | None  #: of a stone
    path: Floats  #: (k, 3) of the contact point
    along: Floats  #: (k,) times of these
    slips: np.ndarray  #: (k,) whether the contact slips there
    gaps: np.ndarray  #: (k,) whether there is no path: in the air, and where another rim takes over
    pieces: list[_Piece]
    caster: Caster
    middle: Floats
    reach: float
    half: float


def _shown(m: Motion, times: Floats, upper: Letter) -> _Shown:
    first, last = sorted(span(m))
    centre, orientation, theta = seen(m, np.clip(times, first, last), "centre", "orientation", "theta")
    spin = None
    if isinstance(m.body, Ellipsoid):
        (spin,) = seen(m, np.clip(times, first, last), "spin")
    along = np.linspace(first, last, _PATH)
    contact, way = seen(m, along, "contact_point", "centre")
    slips = seen(m, along, "phase")[0] == 1 if rubs(m.contact) else np.zeros(along.size, bool)
    gaps, up = np.zeros(along.size, bool), goes_up(m)
    if up:
        (phase,), other = seen(m, along, "phase"), aloft(m, first, last).on_other(along)
        slips = np.isin(phase, SLIPS)
        gaps = (phase == FLIES) | np.append(False, other[1:] != other[:-1])
    low, high = way[:, :2].min(axis=0), way[:, :2].max(axis=0)
    body = max(size(m.body), farthest(m.body))
    reach, top = math.hypot(*(high - low)) / 2 + body, 2 * float(way[:, 2].max())
    if up:
        top = float(tops(seen(m, along, "theta")[0], way[:, 2], body).max())
    return _Shown(
        centre=centre,
        rotation=rotations(orientation),
        theta=theta,
        spin=spin,
        path=np.column_stack([contact, np.zeros(along.size)]),
        along=along,
        slips=slips,
        gaps=gaps,
        pieces=_pieces(m, upper),
        caster=caster([lathe(profile) for profile in profiles(m.body)]),
        middle=np.array([*((low + high) / 2), 0.45 * top]),
        reach=reach,
        half=_held(reach, top),
    )


def _held(reach: float, top: float) -> float:
    """Half the height that the camera has to show."""
    return 1.06 * max((0.52 + 0.26) * reach + 0.38 * top, 0.44 * reach + 0.57 * top)


def frames(what: Reel, which_of: np.ndarray | None = None) -> Iterator[np.ndarray]:
    """The pictures, (height, width, 3) of 8 bits: all, or those with the given indices."""
    yield from pictures(what, what.times if which_of is None else what.times[which_of])


def pictures(what: Reel, times: Floats) -> Iterator[np.ndarray]:
    """The pictures at these times."""
    panels = [_shown(m, times, what.upper) for m in what.motions]
    stage = _Stage(what, panels, times)
    for k in range(times.size):
        yield stage.picture(k)


class _Stage:
    """A matplotlib figure on which each frame is drawn."""

    def __init__(self, what: Reel, panels: list[_Shown], times: Floats) -> None:
        from matplotlib.figure import Figure

        agg: Any = extra("matplotlib.backends.backend_agg", "film")
        self.what, self.panels, self.times = what, panels, times
        self.colour = what.colours
        width, height = what.size
        self.figure = Figure((width / 100, height / 100), dpi=100 * _FINE, facecolor=self.colour["paper"])
        self.canvas = agg.FigureCanvasAgg(self.figure)
        alone = max(size(m.body) for m in what.motions)
        reach = max(p.reach for p in panels)
        self.follows = reach > 2.5 * alone and any(rubs(m.contact) or goes_up(m) for m in what.motions)
        self.lamp = lamps(MANY if any(map(goes_up, what.motions)) else LAMPS)
        half = max(p.half for p in panels)
        if self.follows:
            reach, half = alone, max(_held(alone, p.middle[2] / 0.45) for p in panels)
        columns, rows = _columns(len(panels), width / height)
        self.axes: list[Any] = []
        self.moving: list[_Moving] = []
        self.cameras: list[_Camera] = []
        letters = max(0.0225 * min(height / rows, 0.75 * width / columns), 9.0) * 72 / 100
        for k, (panel, label) in enumerate(zip(panels, what.labels, strict=True)):
            place = (k % columns / columns, 1 - (k // columns + 1) / rows, 1 / columns, 1 / rows)
            aspect = width / columns / (height / rows)
            ax: Any = self.figure.add_axes(place)
            ax.set(xlim=(-aspect, aspect), ylim=(-1, 1))
            ax.axis("off")
            self.cameras.append(_camera(panel.middle, reach, half, aspect))
            around: dict[str, Any] = {"color": self.colour["ink"], "transform": ax.transAxes, "zorder": 9}
            ax.text(
                0.02, 0.97, label, size=1.2 * letters, weight="bold", va="top", parse_math=False, **around
            )
            clock = ax.text(0.02, 0.03, "", size=1.2 * letters, va="bottom", linespacing=1.4, **around)
            self.axes.append(ax)
            self._ground(ax, k, reach, aspect)
            self.moving.append(self._moving(ax, clock))
        if what.slow > 1:
            told = f"{what.slow} times slower"
            ink = self.colour["ink"]
            self.figure.text(0.985, 0.03, told, size=letters, color=ink, ha="right", va="bottom")
        whole = what.times
        shown = float(whole[-1] - whole[0]) * what.unit
        self.digits = max(2, 4 - math.floor(math.log10(max(1e-9, shown))))
        # draw everything once that no frame changes
        self.canvas.draw()
        self.still = self.canvas.copy_from_bbox(self.figure.bbox)

    def picture(self, k: int) -> np.ndarray:
        """Frame number k."""
        self.canvas.restore_region(self.still)
        for index, panel in enumerate(self.panels):
            self._draw(index, panel, k)
        image = np.asarray(self.canvas.buffer_rgba())[..., :3]
        height, width = image.shape[0] // _FINE * _FINE, image.shape[1] // _FINE * _FINE
        total = np.full((height // _FINE, width // _FINE, 3), _FINE * _FINE // 2, np.uint16)
        for i in range(_FINE):
            for j in range(_FINE):
                total += image[i:height:_FINE, j:width:_FINE]
        return (total // (_FINE * _FINE)).astype(np.uint8)

    def _ground(self, ax: Any, index: int, reach: float, aspect: float) -> None:
        """Draw the table: lines one radius apart, or five, that fade into the distance."""
        from matplotlib.collections import LineCollection

        camera = self.cameras[index]
        cell, far = (5.0 if reach > 12 else 1.0), 4 * reach
        # the point of the table behind each point of the picture
        x, y = np.meshgrid(np.linspace(-aspect, aspect, 160), np.linspace(-1, 1, 90))
        share = camera.high / camera.far
        rays = share * (x[..., None] * camera.rows[0] + y[..., None] * camera.rows[1]) - camera.rows[2]
        behind = camera.eye - rays * (camera.eye[2] / np.minimum(rays[..., 2:], -1e-9))
        there = _fades(np.linalg.norm(behind[..., :2] - camera.at[:2], axis=-1) / far)[..., None]
        paper, ground = (np.array(self.colour[name]) for name in ("paper", "ground"))
        ax.imshow(
            paper + there * (ground - paper),
            extent=(-aspect, aspect, -1, 1),
            origin="lower",
            interpolation="bilinear",
            aspect="auto",
            zorder=0,
        )
        ax.set(xlim=(-aspect, aspect), ylim=(-1, 1))
        ax.grid_lines = LineCollection([], linewidths=0.6, zorder=2, animated=self.follows)
        ax.add_collection(ax.grid_lines, autolim=False)
        ax.cell, ax.far = cell, far
        self._rule(ax, camera)

    def _moving(self, ax: Any, clock: Any) -> "_Moving":
        """The artists that each frame changes."""
        from matplotlib.patches import PathPatch
        from matplotlib.path import Path as Outline

        how: dict[str, Any] = {"solid_joinstyle": "round", "lw": 1.4, "animated": True}
        colours = (self.colour[name] for name in ("trace", "friction"))
        rolled, slipped = (ax.plot([], [], color=colour, **how)[0] for colour in colours)
        nothing: dict[str, Any] = {"color": "black", "alpha": layer(len(self.lamp)), "lw": 0}
        shades = [PathPatch(Outline(np.zeros((1, 2))), animated=True, **nothing) for _ in self.lamp]
        for shade in shades:
            ax.add_patch(shade)
        surface = _surface(ax)
        clock.set_animated(True)
        return _Moving(rolled, slipped, shades, surface, clock)

    def _rule(self, ax: Any, camera: _Camera) -> None:
        """Set the lines of the table that this camera sees."""
        steps = np.arange(-math.ceil(ax.far / ax.cell), math.ceil(ax.far / ax.cell) + 1)
        pieces = np.linspace(-ax.far, ax.far, 81)
        sets = []
        for axis in (0, 1):
            across = ax.cell * (np.round(camera.at[axis] / ax.cell) + steps)
            along = camera.at[1 - axis] + pieces
            places = np.zeros((across.size, along.size, 3))
            places[..., axis], places[..., 1 - axis] = across[:, None], along
            sets.append(np.stack([places[:, :-1], places[:, 1:]], 2).reshape(-1, 2, 3))
        segments = np.concatenate(sets)
        middle = segments.mean(axis=1) - camera.at
        there = 0.8 * _fades(np.linalg.norm(middle[:, :2], axis=-1) / ax.far)
        ahead = (camera.far - (segments - camera.at) @ camera.rows[2] > 0.05 * camera.far).all(axis=1)
        seen_ = ahead & (there > 0.01)
        ax.grid_lines.set_segments(camera(segments[seen_]))
        ax.grid_lines.set_color([(*self.colour["grid"], a) for a in there[seen_]])

    def _draw(self, index: int, panel: _Shown, k: int) -> None:
        """Draw a motion at frame k."""
        ax, camera, t = self.axes[index], self.cameras[index], float(self.times[k])
        if self.follows:
            camera = camera._replace(at=np.array([*panel.centre[k, :2], panel.middle[2]]))
            self._rule(ax, camera)
        count = int(np.searchsorted(panel.along, t, "right"))
        way = np.where(panel.gaps[:count, np.newaxis], np.nan, camera(panel.path[:count]))
        slips = panel.slips[:count, np.newaxis]
        moving = self.moving[index]
        moving.rolled.set_data(*np.where(slips, np.nan, way).T)
        moving.slipped.set_data(*np.where(slips, way, np.nan).T)
        thrown = shadows(panel.caster, panel.rotation[k], panel.centre[k], self.lamp)
        for shade, lines in zip(moving.shades, thrown, strict=True):
            shade.set_path(outline([camera(line) for line in lines]))
        note = self._note(index, t)
        moving.surface.put(*_triangles(panel, k, camera, note is not None))
        told = f"{note[0]}{self._clock(note[1])}" if note else self._clock(t)
        spin = "" if panel.spin is None else "\n" + self._spin(float(panel.spin[k]))
        moving.clock.set_text(f"{told}\nθ = {math.degrees(panel.theta[k]):.1f}°{spin}")
        rolled, slipped, shades, surface, clock = moving
        for artist in (*([ax.grid_lines] if self.follows else []), rolled, slipped, *shades, surface, clock):
            ax.draw_artist(artist)

    def _clock(self, t: float) -> str:
        return f"t = {t * self.what.unit:.{self.digits}f} {self.what.symbol}"

    def _spin(self, spin: float) -> str:
        """The spin of a stone about the vertical, in words."""
        told = f"{spin / self.what.unit:+.3f}".replace("-", "\N{MINUS SIGN}")
        return f"spin {told} {self.what.rates}"

    def _note(self, index: int, t: float) -> tuple[str, float] | None:
        """The note about a motion before its first time, at its end or later; and the time to show."""
        before, after = (self.what.edges[index][name] for name in ("before", "after"))
        if t > after["at"] or (after["event"] and t >= after["at"]):
            return after["said"], after["t"]
        if t < before["at"] or (before["event"] and t <= before["at"]):
            return before["said"], before["t"]
        return None


class _Moving(NamedTuple):
    """The artists that each frame changes, in the order of drawing."""

    rolled: Any  #: path of the contact while it rolls
    slipped: Any  #: path of the contact while it slips
    shades: list[Any]  #: the shadow from each point of the lamp
    surface: Any
    clock: Any


def _triangles(panel: _Shown, k: int, camera: _Camera, over: bool) -> tuple[Floats, Floats]:
    """Corners (n, 3, 2) in the picture and colours (n, 3, 4) of triangles, in the order of drawing."""
    rotation, centre = panel.rotation[k], panel.centre[k]
    eye = (camera.eye - centre) @ rotation  # position of the eye in the axes of the body
    height = float(eye[2])
    # painter's order: pieces beyond a plane across the axis come before those on the eye's side
    away = [max(p.low - height, height - p.high, 0.0) for p in panel.pieces]
    order = sorted(range(len(away)), key=lambda i: (-away[i], not panel.pieces[i].inside, i))
    places, colours = [], []
    for i in order:
        part = panel.pieces[i].part
        corners, normals = part.vertices[part.triangles], part.normals[part.triangles]
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        facing = ((eye - corners[:, 0]) * flat).sum(axis=-1) > 0
        turned = normals[facing] @ rotation.T
        light = 0.52 + 0.16 * turned[..., 2] + 0.36 * np.maximum(turned @ _SUN, 0.0)
        colour = np.array(part.colour)
        if over:  # after the end of a motion the colour loses most of its hue
            colour = 0.06 * colour + 0.94 * (0.42 + 0.3 * colour @ [0.3, 0.59, 0.11])
        lit = np.clip(light[..., np.newaxis] * colour, 0.0, 1.0)
        places.append(camera(corners[facing] @ rotation.T + centre))
        colours.append(np.concatenate([lit, np.ones((*lit.shape[:2], 1))], -1))
    return np.concatenate(places), np.concatenate(colours)


def _fades(share: Floats) -> Floats:
    """1 near the middle, 0 far away: the page's blend from the table to the background."""
    u = np.clip((1.0 - share) / 0.5, 0.0, 1.0)
    found: Floats = u * u * (3 - 2 * u)
    return found


def _columns(count: int, aspect: float) -> tuple[int, int]:
    """Columns and rows that leave few panels empty and give the others a good shape."""

    def cost(columns: int) -> float:
        rows = math.ceil(count / columns)
        return 0.7 * (rows * columns - count) + abs(math.log(aspect * rows / columns / 1.3))

    best = min(range(1, count + 1), key=cost)
    return best, math.ceil(count / best)


def _surface(ax: Any) -> Any:
    """An artist in the axes that draws triangles in their order, each corner with its colour."""
    from matplotlib.artist import Artist

    class Surface(Artist):
        """Gouraud triangles for Agg."""

        def put(self, corners: Floats, colours: Floats) -> None:
            self.corners, self.colours = corners, np.ascontiguousarray(colours)

        def draw(self, renderer: Any) -> None:
            graphics = renderer.new_gc()
            renderer.draw_gouraud_triangles(graphics, self.corners, self.colours, ax.transData.frozen())
            graphics.restore()

    surface = Surface()
    surface.set_animated(True)
    ax.add_artist(surface)
    return surface
