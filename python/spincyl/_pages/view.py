"""A motion to view: an HTML page that needs only a browser, or a file for graphics tools."""

import html
import json
from collections.abc import Iterable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from spincyl._contact import named
from spincyl._ellipsoid_motion import EllipsoidMotion
from spincyl._input.files import path_of, replaced
from spincyl._input.numbers import one_of, within
from spincyl._input.threads import Progress, callback
from spincyl._motion import Motion
from spincyl._pages.few import corners, packed_part
from spincyl._pages.joined import colours, filled, frame, line, script, style
from spincyl._pages.recorded import SLOW, edges, shown, slips_or_flies, slow_motion, turns
from spincyl._pages.stone import stone, turned
from spincyl._scale import Scale, scale_of
from spincyl._studio.aloft import goes_up
from spincyl._studio.glb import glb
from spincyl._studio.look import Look, look
from spincyl._studio.shape import Letter, marks, profiles

#: The style sheets and scripts of the page, in their order. "rounded" is used if a body has a fillet or is a
#: stone, "stone" and "spin" if there is a stone, "forces" and "slip" if a contact has a law of friction, and
#: these and "aloft" if a body leaves the table or lies on both rims.
_STYLES = ("page.css", "page.slip.css", "page.aloft.css")
_SCRIPTS = tuple(
    f"page.{x}.js"
    for x in (
        "night",
        "pose",
        "poses",
        "rounded",
        "stone",
        "forces",
        "slip",
        "aloft",
        "spin",
        "context",
        "gl",
        "draw",
        "recorded",
        "exposure",
        "eye",
        "hands",
    )
)


_STILLS = (".png", ".svg", ".pdf")


class View:
    """One or several motions side by side; from `view`. Shows itself in a notebook.

    Attributes
    ----------
    html : str
        The page: complete, and asking for nothing from anywhere.
    """

    def __init__(
        self,
        motions: Sequence[Motion],
        labels: Sequence[str],
        title: str,
        scale: Scale | None,
        slow: int | None,
        upper: Letter,
        look: Look,
    ) -> None:
        self.motions, self.labels, self.title = tuple(motions), tuple(labels), title
        self.scale, self.upper, self.look = scale, upper, look
        found = [shown(m, self._slips) for m in self.motions]
        self.slow = slow or slow_motion(max(turning for _, turning in found), scale)
        self._poses = [poses for poses, _ in found]

    @property
    def html(self) -> str:
        """The page as text."""
        rounded = any(stone(m) or m.body.fillet > 0 for m in self.motions)
        there = {"rounded": rounded, "forces": self._slips, "slip": self._slips}
        there |= dict.fromkeys(("stone", "spin"), any(map(stone, self.motions)))
        there["aloft"] = any(map(goes_up, self.motions))
        useless = [word for word in there if not there[word]]
        styles, scripts = (
            [x for x in names if not any(f".{word}." in x for word in useless)]
            for names in (_STYLES, _SCRIPTS)
        )
        # without "<" no text in the data can end the script
        data = json.dumps(self._data(), allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
        fields = {
            "title": html.escape(self.title),
            "style": style(styles),
            "script": script(scripts),
            "data": data,
        }
        return filled("page.html", fields)

    def save(
        self,
        path: str | PathLike[str],
        *,
        fps: int | None = None,
        size: tuple[int, int] | None = None,
        seconds: float | None = None,
        progress: "Progress | None" = None,
        t: float | None = None,
    ) -> Path:
        """Write a page (.html), a film (.mp4, .gif), a picture or an animated scene (.glb, glTF 2.0).

        A picture is of pixels (.png) or a vector drawing (.svg, .pdf).

        Parameters
        ----------
        path : path
            What is written follows from the suffix.
        fps : int, optional
            Frames a second of a film. Default: 30, of a GIF 25; the frames of a GIF last whole hundredths of
            a second.
        size : (int, int), optional
            Width and height of a film or a picture in pixels. Default: (1280, 720), of a GIF (640, 360).
        seconds : float, optional
            How long a film may be, 0.1 to 600. Default: 10, with a warning where there is more to show.
        progress : callable, optional
            Called with the share of a film that is done, 0 to 1, after each frame.
        t : float, optional
            The time of a picture, in seconds of the scale, or in sqrt(R/g) without one. Default: the first.
            A long exposure begins then.

        Returns
        -------
        Path
            That of the file.

        Raises
        ------
        ValueError
            For any other suffix, a motion too long to show, measures that no film can have or that are given
            for what is none.
        ImportError
            For a film without spincyl[film]; an MP4 also takes the program ffmpeg where that is on the search
            path, a GIF matplotlib alone.
        OSError
            If it cannot be written.

        Warns
        -----
        UserWarning
            If a film is cut at ten seconds, or is larger than 20 MB.

        Notes
        -----
        A file that is there is replaced when the new one is complete; if anything fails, it stays as it is.

        A film begins at the first time and runs `slow` times slower than the motion, as the page does at
        first: a second of it shows ``1/slow`` seconds of the scale, or of sqrt(R/g) without one. Films and
        pictures look like the page in daylight; where a motion has ended, its last picture stays for a
        second. With `exposure` each frame of a film is the photograph of the last turns: it builds up at
        first. A vector drawing has no tint of the table, and of a long exposure only the words are vectors.

        A scene is in metres and seconds of the scale; without one, R is a metre and sqrt(R/g) a second. Its
        bodies stand side by side.
        """
        path = path_of("path", path)
        suffix = path.suffix.lower()
        if suffix not in (".html", ".glb", ".mp4", ".gif", *_STILLS):
            known = ".html, .mp4, .gif, .png, .svg, .pdf or .glb"
            raise ValueError(f"path = {str(path)!r}: expected a name that ends in {known}")
        if t is not None and suffix not in _STILLS:
            raise ValueError(f"t: of a picture, {', '.join(_STILLS)}, and not of {suffix}")
        if suffix in _STILLS and all(x is None for x in (fps, seconds, progress)):
            from spincyl._studio.film import reel, still

            still(reel(self, [edges(m) for m in self.motions], suffix, None, size, 600.0), path, t)
            return path
        if suffix in (".mp4", ".gif"):
            from spincyl._studio.film import film, reel

            seconds = None if seconds is None else within("seconds", seconds, 0.1, 600.0)
            progress = callback(progress)
            made_of = reel(self, [edges(m) for m in self.motions], suffix, fps, size, seconds)
            film(made_of, path, progress)
            return path
        if any(x is not None for x in (fps, size, seconds, progress)):
            raise ValueError(f"fps, size, seconds, progress: of a film, .mp4 or .gif, and not of {suffix}")
        if suffix == ".html":
            made = self.html.encode()
        else:
            made = glb(self.motions, self.labels, self.scale, self.upper)
        with replaced(path) as part:
            part.write_bytes(made)
        return path

    def _data(self) -> dict[str, Any]:
        shapes: list[dict[str, Any]] = []
        motions = []
        for m, label, poses in zip(self.motions, self.labels, self._poses, strict=True):
            shape: dict[str, Any]
            if isinstance(m, EllipsoidMotion):
                shape = turned(m.body, self.upper)
            else:
                shape = {"turned": [{"colour": p.colour, "corners": corners(p)} for p in profiles(m.body)]}
                shape["marks"] = [packed_part(part) for part in marks(m.body, self.upper)]
            if shape not in shapes:
                shapes.append(shape)
            motions.append({"label": label, "shape": shapes.index(shape)} | edges(m) | poses)
        return (
            {
                "unit": 1.0 if self.scale is None else self.scale.seconds(1.0),
                "symbol": self._symbol,
                "slow": self.slow,
                "shapes": shapes,
                "motions": motions,
                "look": {"drawn": self.look.drawn, "above": self.look.above, "exposure": turns(self.look)},
            }
            | (self._speeds() | {"follow": self.look.follow} if self._slips else {})
            | (self._rates() if any(map(stone, self.motions)) else {})
        )

    @property
    def _symbol(self) -> str:
        """The unit of the page's times."""
        return f"√({self._length}/g)" if self.scale is None else "s"

    @property
    def _spun(self) -> str:
        """The unit of the page's angular velocities."""
        return f"√(g/{self._length})" if self.scale is None else "rad/s"

    @property
    def _length(self) -> str:
        """The symbol of the unit of length: the largest semi-axis of stones, else the radius."""
        return "a" if all(map(stone, self.motions)) else "R"

    @property
    def _colours(self) -> dict[str, tuple[float, float, float]]:
        """The daylight colours of the page, for films."""
        return colours(reversed(_STYLES))

    @property
    def _slips(self) -> bool:
        """Whether the page has forces, and a camera that may follow."""
        wanted = self.look.follow or "force" in (self.look.drawn or ())
        return bool(wanted) or any(map(slips_or_flies, self.motions))

    def _speeds(self) -> dict[str, Any]:
        """The units in which the page gives the speed of slip, and the height of a flight."""
        high = any(map(goes_up, self.motions))
        if self.scale is None:
            lengths = {"metre": 1.0, "lengths": self._length} if high else {}
            return {"speed": 1.0, "speeds": f"√(g {self._length})"} | lengths
        lengths = {"metre": self.scale.radius, "lengths": "m"} if high else {}
        return {"speed": self.scale.metres_per_second(1.0), "speeds": "m/s"} | lengths

    def _rates(self) -> dict[str, Any]:
        """The unit in which the page gives the spin of a stone."""
        second = 1.0 if self.scale is None else float(self.scale.seconds(1.0))
        return {"rate": 1 / second, "rates": self._spun}

    def _repr_html_(self) -> str:
        """The page in a frame that may only run its script."""
        return frame(self.html, "allow-scripts", "width:100%;height:480px;border:0")

    def __repr__(self) -> str:
        many = "a motion" if len(self.motions) == 1 else f"{len(self.motions)} motions"
        return f"<View of {many}; .save('spin.html') writes the page>"


def view(
    *motions: Motion,
    labels: Sequence[str] | None = None,
    title: str = "spincyl",
    scale: Scale | None = None,
    slow: int | None = None,
    upper: Letter = "O",
    drawn: str | Iterable[str] | None = None,
    above: bool = False,
    follow: bool | None = None,
    exposure: float | None = None,
) -> View:
    """A page in which motions can be watched from all sides and slowly.

    Parameters
    ----------
    *motions : Motion
        One, or several to run in step side by side. What they lack of the pose is computed.
    labels : sequence of str, optional
        One for each, shown as plain text. Default: the kind of contact where there are several. A tab or a
        new line, here and in the title, is shown as a space.
    title : str
        Of the page.
    scale : Scale, optional
        Time is then in seconds; else the page takes a second for sqrt(R/g). The radius 1e-6 to 1e6 m.
    slow : int, optional
        How many times slower it starts: 1, 2, 5, 10, ... 1000. Default: so that nothing turns much
        faster than once a second.
    upper : {"O", "X"}
        The letter on the upper end: the one that is seen.
    drawn : str or sequence of str, optional
        What is drawn besides the body, with a switch for each on the page: "path" of the contact point;
        arrows of the angular velocity "omega", the angular "momentum" about the centre, the "velocity" of the
        centre and the contact "force" (normal force N and friction F); "axis", the instantaneous axis and the
        line P-C-O. Default: the path, and on a page the forces if there is a law of friction.
    above : bool
        Whether the camera is above the table, with x to the right.
    follow : bool, optional
        Whether the camera follows the body. Default: if there is a law of friction and the body moves far.
    exposure : float, optional
        The long exposure from above: for how many turns about the vertical the shutter is open, 0.01 or more,
        or inf for the rest of the motion. The page opens with it.

    Returns
    -------
    View
        Shows itself in a notebook; `save("spin.html")`, `save("spin.mp4")`, `save("spin.svg", t=1.5)` or
        `save("spin.glb")`.

    Raises
    ------
    ValueError
        For no motion, labels that do not match, a motion with no duration or too long to show; for a title or
        a label with a control character, half a surrogate pair or a noncharacter: none can stand in HTML.
    TypeError
        For anything but motions, text and a scale.

    Notes
    -----
    Where a contact has a law of friction, the path and the line under the slider are red while it slips,
    arrows at the contact show the normal force N and the friction F, and the clock tells how fast it slips.

    With "#t=1.5" after its name the page opens paused at that time. A body whose motion has ended is grey,
    and its clock says why and when. It has poses at few times and draws a cubic between them, which meets the
    motion within 0.003 rad, and R for bodies of usual length. ω and L are computed from the drawn pose.

    An arrow has the same scale in all motions: forces that of the usual normal force, others that of their
    largest value. The line P-C-O goes from the contact point P through the centre of mass C to the point O
    opposite to P: if the body is symmetric top to bottom, the top of its upper rim, where the still symbols
    are. The instantaneous axis is the line of the points whose velocity is along it, or zero; while the body
    rolls it passes through P, and if the centre rests it is the line P-C-O.

    Of a body that flies (`roll` with a `restitution`) the clock tells how high its lowest point is; in the
    air there is neither path nor force.

    Of a stone the clock also tells the spin, and when it turns back: when it has passed zero and comes to a
    tenth of its first value in the other direction. One whose edge lands is drawn as a hull with a needle on
    its top, another one whole with a band and a dot; `upper` is the letter that gives its colour to the band,
    or to the half of the needle that points along the positive axis.

    What is not known of a general body is guessed. It is drawn solid and as long above its centre as below; a
    ball that lands on something at pi/2 as two balls, one that lands elsewhere with a stem or a hat that
    lands there.

    Examples
    --------
    >>> import spincyl as sc
    >>> body = sc.Body.solid(2.5)
    >>> m = sc.roll(body, body.steady(1.3).kicked(0.05), 20.0)
    >>> sc.view(m)
    <View of a motion; .save('spin.html') writes the page>
    """
    if not motions:
        raise ValueError("motions: expected at least one, as in view(m)")
    for m in motions:
        if not isinstance(m, Motion):
            raise TypeError(f"motions: expected Motion, not {type(m).__name__}")
    scale = scale_of(scale, *(m.body for m in motions))
    if scale is not None and not (1e-6 <= scale.radius <= 1e6 and 1e-6 <= scale.seconds(1.0) <= 1e6):
        raise ValueError(f"scale: expected 1e-6 to 1e6 metres and seconds to sqrt(R/g), not {scale!r}")
    if slow is not None:
        one_of("slow", slow, SLOW)
    if labels is None:
        labels = [""] if len(motions) == 1 else [named(m.contact) for m in motions]
    elif isinstance(labels, str) or not isinstance(labels, Sequence):
        raise TypeError(f"labels: expected a list of texts, not {type(labels).__name__}")
    if len(labels) != len(motions):
        raise ValueError(f"labels: expected {len(motions)}, one for each motion, not {len(labels)}")
    title, labels = line("title", title), [line(f"labels[{i}]", label) for i, label in enumerate(labels)]
    for m in motions:
        marks(m.body, upper)  # raises ValueError if `upper` is neither "O" nor "X"
    how = look(drawn, above, follow, exposure)
    return View([m.natural for m in motions], labels, title, scale, slow, upper, how)
