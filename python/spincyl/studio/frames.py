"""The picture of the page for each frame of a film, drawn without a browser.

Bodies, marks, arrows, cameras, light and colours are those of the page. Agg (matplotlib) draws them. Where
there are triangles, it fills them at twice the resolution of the film, which is then averaged. A still can be
a vector drawing as well.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from spincyl._input.numbers import Floats, optional_library
from spincyl._motion import Motion
from spincyl._phases import has_friction
from spincyl.studio.aloft import goes_up
from spincyl.studio.arrows import Tip, drawings
from spincyl.studio.artists import photo_of, surface_of
from spincyl.studio.exposure import Shutter
from spincyl.studio.look import Camera, Look, camera, held, opened, tilts
from spincyl.studio.painted import Painted, Piece, ordered, painted, pieces, turned
from spincyl.studio.poses import span
from spincyl.studio.shadow import LAMPS, MANY, Caster, caster, lamps, layer, outline, shadows
from spincyl.studio.shape import Letter, size
from spincyl.studio.shown import Shown, shown

_MOST = 20_000  # frames
# distance in pixels, or in hundredths of an inch, by which the flat pieces of a surface may lie inside it
_OFF, _OFF_VECTOR = 0.1, 0.25
# samples of a photograph for each of the two marks: of a still, and of a film at least, and for each pixel
_LIGHT, _LEAST, _EACH = 8e6, 2e5, 2.0
_DARK, _CHALK = (0.0, 0.0, 0.0), (0.87, 0.87, 0.87)  # paper and ink of a photograph


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
    look: Look

    @property
    def drawn(self) -> tuple[str, ...]:
        """Names of the lines and vectors that are drawn with the body."""
        return ("path",) if self.look.drawn is None else self.look.drawn

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
            raise ValueError(f"seconds, fps: {count} frames, expected at most {_MOST}; reduce one of them")
        times = np.minimum(first + step * np.arange(count + 1), last)
        if last - times[-2] < 1e-9 * step:
            times = times[:-1]
        ended = not cut and any(edge["after"]["event"] and edge["after"]["at"] >= last for edge in self.edges)
        return np.append(times, np.full(self.fps if ended else 0, last))


def frames(what: Reel, which_of: np.ndarray | None = None) -> Iterator[np.ndarray]:
    """The pictures, (height, width, 3) of 8 bits: all, or those with the given indices."""
    yield from pictures(what, what.times if which_of is None else what.times[which_of])


def pictures(what: Reel, times: Floats, *, still: bool = False) -> Iterator[np.ndarray]:
    """The pictures at these times: frames of a film, or stills."""
    stage = _Stage(what, times, still=still)
    for k in range(times.size):
        yield stage.picture(k)


def vector(what: Reel, t: float, file: Any, kind: str) -> None:
    """Write a still as a vector drawing, "svg" or "pdf"."""
    stage = _Stage(what, np.array([t]), still=True, vector=True)
    for index in range(len(stage.panels)):
        stage.draw(index, 0)
    stage.figure.savefig(file, format=kind)


class _Stage:
    """A matplotlib figure on which each frame is drawn."""

    def __init__(self, what: Reel, times: Floats, *, still: bool = False, vector: bool = False) -> None:
        from matplotlib.figure import Figure

        agg: Any = optional_library("matplotlib.backends.backend_agg", "film")
        self.what, self.times, self.opens, self.vector = what, times, still, vector
        self.panels = panels = [shown(m, times, what.upper, what.drawn) for m in what.motions]
        self.exposes, look = what.look.exposure is not None, what.look
        self.colour = {**what.colours, **({"paper": _DARK, "ink": _CHALK} if self.exposes else {})}
        width, height = what.size
        self.figure = Figure((width / 100, height / 100), dpi=100, facecolor=self.colour["paper"])
        self.canvas = agg.FigureCanvasAgg(self.figure)
        alone = max(size(m.body) for m in what.motions)
        reach = max(p.reach for p in panels)
        far = reach > 2.5 * alone and any(has_friction(m.contact) or goes_up(m) for m in what.motions)
        self.follows = far if look.follow is None else look.follow
        self.lamp = lamps(MANY if any(map(goes_up, what.motions)) else LAMPS)
        half = max(p.half for p in panels)
        if self.follows:
            reach, half = (
                (1.5 if self.exposes else 1.0) * alone,
                max(held(alone, p.middle[2] / 0.45) for p in panels),
            )
        self.half = half
        self.sizes = {name: max(p.sizes[name] for p in panels) for name in panels[0].sizes}
        lies = tilts([m._asked.slope for m in what.motions])
        columns, rows = _columns(len(panels), width / height)
        self.axes: list[Any] = []
        self.moving: list[_Moving] = []
        self.cameras: list[Camera] = []
        self.bodies: list[_Body] = []
        self.letters = letters = max(0.0225 * min(height / rows, 0.75 * width / columns), 9.0) * 72 / 100
        aspect = width / columns / (height / rows)
        self.shape = round(height / rows), round(width / columns)  # pixels of a photograph
        for k, (panel, label) in enumerate(zip(panels, what.labels, strict=True)):
            place = (k % columns / columns, 1 - (k // columns + 1) / rows, 1 / columns, 1 / rows)
            ax: Any = self.figure.add_axes(place)
            ax.set(xlim=(-aspect, aspect), ylim=(-1, 1))
            ax.axis("off")
            seen_by = camera(panel.middle, reach, half, aspect, look.above or self.exposes, lies[k])
            self.cameras.append(seen_by)
            self.bodies.append(self._made(panel.motion.body, seen_by, reach))
            around: dict[str, Any] = {"color": self.colour["ink"], "transform": ax.transAxes, "zorder": 9}
            ax.text(
                0.02, 0.97, label, size=1.2 * letters, weight="bold", va="top", parse_math=False, **around
            )
            clock = ax.text(0.02, 0.03, "", size=1.2 * letters, va="bottom", linespacing=1.4, **around)
            self.axes.append(ax)
            if not self.exposes:
                self._ground(ax, k, reach, aspect)
            self.moving.append(self._moving(ax, clock))
        if what.slow > 1:
            told = f"{what.slow} times slower"
            ink = self.colour["ink"]
            self.figure.text(0.985, 0.03, told, size=letters, color=ink, ha="right", va="bottom")
        whole = what.times
        lasts = float(whole[-1] - whole[0]) * what.unit
        self.brief = what.symbol == "s" and lasts < 1  # milliseconds, as on the page
        self.digits = max(2, 4 - math.floor(math.log10(max(1e-9, lasts))))
        if not still:  # two frames do not show the same time
            self.digits = max(2, min(self.digits, math.ceil(math.log10(what.fps * what.slow))))
        self.shutters = [self._shutter(index) for index in range(len(panels))] if self.exposes else []
        self.gain = [self._gain(index) for index in range(len(panels))] if self.exposes else []
        # draw everything that no frame changes, once
        if not vector:
            self.canvas.draw()
            self.still = self.canvas.copy_from_bbox(self.figure.bbox)

    def picture(self, k: int) -> np.ndarray:
        """The picture of frame number `k`, (height, width, 3) of 8 bits."""
        self.canvas.restore_region(self.still)
        for index in range(len(self.panels)):
            self.draw(index, k)
        for word in self.figure.texts if self.exposes else ():
            self.figure.draw_artist(word)
        return np.array(np.asarray(self.canvas.buffer_rgba())[..., :3])

    def _made(self, body: Any, camera: Camera, reach: float) -> "_Body":
        """The triangles of a body: as few as look the same as its true surface in this picture."""
        near = (camera.far - reach) / camera.far  # the distance of the nearest place, over that of the middle
        off = (_OFF_VECTOR if self.vector else _OFF) * near * 2 * camera.high / self.shape[0]
        surface = turned(body, off)
        return _Body(pieces(body, surface, self.what.upper), caster(surface))

    def _ground(self, ax: Any, index: int, reach: float, aspect: float) -> None:
        """Draw the table: lines 1 R apart, or 5 R, that fade into the distance."""
        from matplotlib.collections import LineCollection

        camera = self.cameras[index]
        cell, far = (5.0 if reach > 12 else 1.0), 4 * reach
        if not self.vector:
            self._tint(ax, camera, far, aspect)
        ax.set(xlim=(-aspect, aspect), ylim=(-1, 1))
        ax.turning = self.panels[index].motion._asked.turning
        ax.moves = self.follows or ax.turning != 0
        ax.grid_lines = LineCollection([], linewidths=0.6, zorder=2, animated=ax.moves)
        ax.add_collection(ax.grid_lines, autolim=False)
        ax.cell, ax.far = cell, far
        self._rule(ax, camera, 0.0)

    def _tint(self, ax: Any, camera: Camera, far: float, aspect: float) -> None:
        """Draw the colour of the table, which fades into that of the paper."""
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

    def _moving(self, ax: Any, clock: Any) -> "_Moving":
        """The artists that each frame changes."""
        from matplotlib.patches import PathPatch
        from matplotlib.path import Path as Outline

        how: dict[str, Any] = {"solid_joinstyle": "round", "lw": 1.4, "animated": True, "zorder": 3}
        colours = (self.colour[name] for name in ("trace", "friction"))
        rolled, slipped = (ax.plot([], [], color=colour, **how)[0] for colour in colours)
        nothing: dict[str, Any] = {"color": "black", "alpha": layer(len(self.lamp)), "lw": 0, "zorder": 4}
        shades = [PathPatch(Outline(np.zeros((1, 2))), animated=True, **nothing) for _ in self.lamp]
        for shade in shades:
            ax.add_patch(shade)
        photo = None
        if self.exposes:
            photo = photo_of(ax, self.vector)
        clock.set_animated(True)
        return _Moving(rolled, slipped, shades, surface_of(ax, self.vector), photo, clock, [])

    def _rule(self, ax: Any, camera: Camera, t: float) -> None:
        """Set the lines of the table that this camera sees; they turn with the table."""
        steps = np.arange(-math.ceil(ax.far / ax.cell), math.ceil(ax.far / ax.cell) + 1)
        pieces = np.linspace(-ax.far, ax.far, 25 if self.vector else 81)
        sets = []
        c, s = math.cos(ax.turning * t), math.sin(ax.turning * t)
        turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        at = turn @ camera.at
        for axis in (0, 1):
            across = ax.cell * (np.round(at[axis] / ax.cell) + steps)
            along = at[1 - axis] + pieces
            places = np.zeros((across.size, along.size, 3))
            places[..., axis], places[..., 1 - axis] = across[:, None], along
            sets.append(np.stack([places[:, :-1], places[:, 1:]], 2).reshape(-1, 2, 3))
        segments = np.concatenate(sets) @ turn
        middle = segments.mean(axis=1) - camera.at
        there = 0.8 * _fades(np.linalg.norm(middle[:, :2], axis=-1) / ax.far)
        ahead = (camera.far - (segments - camera.at) @ camera.rows[2] > 0.05 * camera.far).all(axis=1)
        seen_ = ahead & (there > 0.01)
        ax.grid_lines.set_segments(camera(segments[seen_]))
        ax.grid_lines.set_color([(*self.colour["grid"], a) for a in there[seen_]])

    def draw(self, index: int, k: int) -> None:
        """Draw a motion at frame k."""
        ax, panel, camera, t = self.axes[index], self.panels[index], self.cameras[index], float(self.times[k])
        moving = self.moving[index]
        rolled, slipped, shades, surface, photo, clock, words = moving
        note = self._note(index, t)
        told = f"{note[0]}{self._clock(note[1])}" if note else self._clock(t)
        spin = "" if panel.spin is None else "\n" + self._spin(float(panel.spin[k]))
        slope = panel.motion._asked.slope
        tilted = f"\nslope {math.degrees(slope):.1f}°".replace("-", "\N{MINUS SIGN}") if slope else ""
        clock.set_text(f"{told}\nθ = {math.degrees(panel.theta[k]):.1f}°{tilted}{spin}{self._open}")
        if self.exposes:
            photo.set_data(self._developed(index, t))
            artists = [photo, *ax.texts]
        else:
            if self.follows:
                camera = camera._replace(at=np.array([*panel.centre[k, :2], panel.middle[2]]))
            if ax.moves:
                self._rule(ax, camera, t)
            if "path" in self.what.drawn:
                count = int(np.searchsorted(panel.along, t, "right"))
                way = np.where(panel.gaps[:count, np.newaxis], np.nan, camera(panel.path[:count]))
                slips = panel.slips[:count, np.newaxis]
                rolled.set_data(*np.where(slips, np.nan, way).T)
                slipped.set_data(*np.where(slips, way, np.nan).T)
            thrown = shadows(self.bodies[index].caster, panel.rotation[k], panel.centre[k], self.lamp)
            for shade, lines in zip(shades, thrown, strict=True):
                shade.set_path(outline([camera(line) for line in lines]))
            found, tips = self._besides(panel, k, camera)
            surface.put([*self._body(index, k, camera, note is not None), *found])
            self._named(ax, words, tips)
            artists = [*([ax.grid_lines] if ax.moves else []), rolled, slipped, *shades, surface, clock]
        if not self.vector:
            for artist in (*artists, *words):
                ax.draw_artist(artist)

    def _body(self, index: int, k: int, camera: Camera, over: bool) -> list[Painted]:
        """The triangles of a body at frame k, in the order of drawing."""
        rotation, centre = self.panels[index].rotation[k], self.panels[index].centre[k]
        height = float((camera.eye - centre) @ rotation[:, 2])
        of = ordered(self.bodies[index].pieces, height)
        return [painted(piece, rotation, centre, camera, over=over) for piece in of]

    def _besides(self, panel: Shown, k: int, camera: Camera) -> tuple[list[Painted], list[Tip]]:
        """Arrows and axis at frame k, and the letters at their tips."""
        if panel.vectors is None:
            return [], []
        return drawings(panel.vectors.at(k), self.what.drawn, self.sizes, self.half, camera, self.colour)

    def _named(self, ax: Any, words: list[Any], tips: list[Tip]) -> None:
        """Write each letter next to the tip of its arrow, on alternating sides."""
        from matplotlib.patheffects import withStroke

        around = [withStroke(linewidth=3, foreground=self.colour["paper"])]
        how: dict[str, Any] = {"ha": "center", "va": "center", "path_effects": around, "zorder": 8}
        how |= {"family": "serif", "style": "italic", "weight": "bold", "size": 1.6 * self.letters}
        while len(words) < len(tips):
            words.append(ax.text(0, 0, "", animated=True, **how))
        away = 0.045 * self.letters / 10
        for k, (word, tip) in enumerate(zip(words, tips, strict=False)):
            along = tip.at - tip.root
            long = float(np.hypot(*along))
            side = np.array([along[1], -along[0]]) / long if long > 1e-3 else np.array([1.0, -0.4])
            word.set(text=tip.letter, color=self.colour[tip.name])
            word.set_position(tip.at + away * side * (-1 if long > 1e-3 and k % 2 else 1))
        for word in words[len(tips) :]:
            word.set_text("")

    @property
    def _open(self) -> str:
        """The duration of the exposure, in words."""
        turns = self.what.look.exposure
        if turns is None:
            return ""
        told = "to the end" if math.isinf(turns) else "1 turn" if turns == 1 else f"{turns:g} turns"
        return f"\nexposure: {told}"

    def _shutter(self, index: int) -> Shutter:
        """The shutter of a photograph of both marks."""
        panel, (rows, columns) = self.panels[index], self.shape
        many = _LIGHT if self.opens else max(_LEAST, _EACH * rows * columns)
        ink, pixel = [[part] for part in panel.ink], 2 * self.cameras[index].high / rows
        middle = None if self.follows else panel.middle[:2]
        return Shutter(panel.motion, ink, pixel, self.shape, many, middle)

    def _light(self, index: int, t: float) -> tuple[np.ndarray, Floats] | None:
        """The pixels with light, and the light of each mark there; None before the shutter opens."""
        panel, turns = self.panels[index], self.what.look.exposure
        assert turns is not None
        first, last = opened(t, turns, panel.along, panel.turned, before=not self.opens)
        if not last > first:
            return None
        light = self.shutters[index].light(first, last).reshape(len(panel.ink), -1)
        lit = np.flatnonzero(light.any(axis=0))
        return lit, light[:, lit]

    def _glow(self, index: int) -> Floats:
        """The colours of the marks, (marks, 3), which glow, as on the page."""
        return np.minimum(1.15 * np.array([part.colour for part in self.panels[index].ink]) + 0.12, 1.0)

    def _gain(self, index: int) -> float:
        """The gain with which the brightest places of a whole exposure are nearly white."""
        along = self.panels[index].along
        t = float(self.times[0] if self.opens else min(self.times[-1], along[-1]))
        found = self._light(index, t)
        if found is None:
            raise ValueError(f"t = {t * self.what.unit:.6g}: expected a time before the end, for an exposure")
        most = (found[1].T @ self._glow(index)).max(axis=-1)
        return 2 / float(np.percentile(most, 99.7)) if most.any() else 0.0

    def _developed(self, index: int, t: float) -> np.ndarray:
        """The photograph at the time `t`: a still shows the exposure after `t`, a film the one before `t`."""
        picture = np.zeros((math.prod(self.shape), 3), np.uint8)
        if (found := self._light(index, t)) is not None:
            lit, light = found
            picture[lit] = np.round(-255 * np.expm1(light.T @ (-self.gain[index] * self._glow(index))))
        return picture.reshape(*self.shape, 3)

    def _clock(self, t: float) -> str:
        more = 3 if self.brief else 0
        told = f"{10**more * t * self.what.unit:.{max(0, self.digits - more)}f}"
        told = told.rstrip("0").rstrip(".") if self.opens and "." in told else told
        return f"t = {told} {'ms' if self.brief else self.what.symbol}"

    def _spin(self, spin: float) -> str:
        """The spin of a stone about the vertical, in words."""
        told = f"{spin / self.what.unit:+.3f}".replace("-", "\N{MINUS SIGN}")
        return f"spin {told} {self.what.rates}"

    def _note(self, index: int, t: float) -> tuple[str, float] | None:
        """Before the first time or after the end: a note that says so, and the time to show; else None."""
        before, after = (self.what.edges[index][name] for name in ("before", "after"))
        if t > after["at"] or (after["event"] and t >= after["at"]):
            return after["said"], after["t"]
        if t < before["at"] or (before["event"] and t <= before["at"]):
            return before["said"], before["t"]
        return None


class _Body(NamedTuple):
    """The triangles of a body."""

    pieces: list[Piece]
    caster: Caster  #: what casts its shadow


class _Moving(NamedTuple):
    """The artists that each frame changes, in the order of drawing."""

    rolled: Any  #: path of the contact while it rolls
    slipped: Any  #: path of the contact while it slips
    shades: list[Any]  #: the shadow from each point of the lamp
    surface: Any
    photo: Any  #: a long exposure, or None
    clock: Any
    words: list[Any]  #: letters of arrows


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
