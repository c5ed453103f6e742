"""A motion to view: an HTML page that needs only a browser, or a file for graphics tools."""

import html
import json
from collections.abc import Iterable, Sequence
from os import PathLike
from pathlib import Path
from typing import Any

from spincyl._contact import contact_in_words
from spincyl._input.files import path_of, writing_whole
from spincyl._input.numbers import in_range, one_of
from spincyl._input.progress import Progress, reporting_progress
from spincyl._motion import Motion
from spincyl._scale import Scale, scale_of
from spincyl.studio.aloft import goes_up
from spincyl.studio.glb import glb
from spincyl.studio.look import SLOW, Look, look
from spincyl.studio.pages.joined import colours, filled, frame, line, script, style
from spincyl.studio.pages.recorded import edges, shown, slips_or_flies, slow_motion, turns
from spincyl.studio.pages.stone import turned
from spincyl.studio.shape import Letter, marks

#: The style sheets and scripts of the page, in their order. "rounded" is used if a body has a fillet or is a
#: stone, "stone" and "spin" if there is a stone, "forces" and "slip" if a contact has a law of friction, and
#: these and "aloft" if a body leaves the table or lies on both rims; "circles" for bodies of several circles;
#: "slope" if a table is tilted or turns.
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
        "circles",
        "spin",
        "context",
        "gl",
        "draw",
        "slope",
        "recorded",
        "exposure",
        "eye",
        "sound",
        "heard",
        "hands",
    )
)


_STILLS = (".png", ".svg", ".pdf")


class View:
    """Page that shows one or several motions side by side; returned by `view`. A notebook displays it.

    Attributes
    ----------
    html : str
        The complete page, which loads nothing from elsewhere.
    """

    def __init__(
        self,
        motions: Sequence[Motion],
        labels: Sequence[str],
        *,
        title: str,
        scale: Scale | None,
        slow: int | None,
        upper: Letter,
        look: Look,
    ) -> None:
        self.motions, self.labels, self.title = tuple(motions), tuple(labels), title
        self.scale, self.upper, self.look = scale, upper, look
        found = []
        with reporting_progress(None, "page") as told:
            for m in self.motions:
                found.append(shown(m, self._slips))
                if told:
                    told(len(found) / len(self.motions))
        self.slow = slow or slow_motion(max(turning for _, turning in found), scale)
        self._poses = [poses for poses, _ in found]

    @property
    def html(self) -> str:
        """The page as text."""
        circles = any(m._nods and m.body.rims is not None for m in self.motions)
        rounded = circles or any(not m._nods or m.body.fillet > 0 for m in self.motions)
        there = {"rounded": rounded, "forces": self._slips, "slip": self._slips}
        there |= dict.fromkeys(("stone", "spin"), any(not m._nods for m in self.motions))
        there["aloft"], there["circles"] = any(map(goes_up, self.motions)), circles
        there["slope"] = any(m._asked.slope or m._asked.turning for m in self.motions)
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
        progress: "Progress | bool | None" = None,
        t: float | None = None,
        sound: bool | None = None,
    ) -> Path:
        """Write the page, a film, a picture or an animated scene to a file.

        Parameters
        ----------
        path : path
            Path of the file. The suffix determines the format: page (.html), film (.mp4, .gif), picture
            (.png with pixels; .svg or .pdf as a vector drawing), or animated scene (.glb, glTF 2.0).
        fps : int, optional
            Frames per second of a film. Default: 30, for a GIF 25. A frame of a GIF lasts a whole number of
            hundredths of a second.
        size : (int, int), optional
            Width and height of a film or a picture in pixels. Default: (1280, 720), for a GIF (640, 360).
        seconds : float, optional
            Longest duration of a film in seconds, 0.1 to 600. Default: 10, with a warning if the film would
            be longer.
        progress : callable or bool, optional
            Function that is called after each frame with the finished share of the film, 0 to 1. Default: if
            tqdm is installed, a bar on a terminal or in a notebook for a film that takes more than two
            seconds. True: a bar at once; False: none.
        t : float, optional
            Time of a picture, or first time of a picture with `exposure`; in seconds if the view has a scale,
            else in sqrt(R/g). Default: the first time of the motion.
        sound : bool, optional
            Whether a film has its sound: that of `Motion.sound`, as slow as the pictures, and loudest
            when the contact point passes the camera. Default: true for an .mp4 in which anything is heard.

        Returns
        -------
        Path
            Path of the file.

        Raises
        ------
        ValueError
            If the suffix is none of these, the motion is too long to show, a setting is out of range, or a
            setting does not apply to the format. If `sound` is true and there is nothing to hear.
        ImportError
            If spincyl[film] is needed for the film and not installed. For an MP4 the program ffmpeg on the
            search path is enough; a GIF needs only matplotlib.
        OSError
            If the file cannot be written.

        Warns
        -----
        UserWarning
            If the film is cut at ten seconds, or is larger than 20 MB.

        Notes
        -----
        An existing file is replaced when the new one is complete; after an error it is unchanged.

        A film begins at the first time and runs `slow` times slower than the motion, like the page when it
        opens. One second of the film shows ``1/slow`` seconds of the motion if the view has a scale, else
        ``1/slow`` sqrt(R/g). Films and pictures have the colours of the page in daylight. If the motion ends,
        the last picture stays for a second. With `exposure` each frame of a film is a photograph of the last
        turns; at the beginning the photograph builds up. A vector drawing does not tint the table, and a long
        exposure in it consists of pixels, except for the text.

        An animated scene is in metres and seconds. If the view has no scale, R is one metre and sqrt(R/g) one
        second. The bodies stand side by side, each on its slope.
        """
        path = path_of("path", path)
        suffix = path.suffix.lower()
        if suffix not in (".html", ".glb", ".mp4", ".gif", *_STILLS):
            known = ".html, .mp4, .gif, .png, .svg, .pdf or .glb"
            raise ValueError(f"path = {str(path)!r}: expected a name that ends in {known}")
        if t is not None and suffix not in _STILLS:
            raise ValueError(f"t: only for a picture ({', '.join(_STILLS)}), not for {suffix}")
        if suffix in _STILLS and all(x is None for x in (fps, seconds, progress, sound)):
            from spincyl.studio.film import reel, still

            still(reel(self, [edges(m) for m in self.motions], suffix, None, size, 600.0), path, t)
            return path
        if suffix in (".mp4", ".gif"):
            from spincyl.studio.film import film, reel

            seconds = None if seconds is None else in_range("seconds", seconds, 0.1, 600.0)
            made_of = reel(self, [edges(m) for m in self.motions], suffix, fps, size, seconds)
            film(made_of, path, progress, sound)
            return path
        if any(x is not None for x in (fps, size, seconds, progress, sound)):
            names = "fps, size, seconds, progress, sound"
            raise ValueError(f"{names}: only for a film (.mp4, .gif), not for {suffix}")
        if suffix == ".html":
            made = self.html.encode()
        else:
            made = glb(self.motions, self.labels, self.scale, self.upper)
        with writing_whole(path) as part:
            part.write_bytes(made)
        return path

    def _data(self) -> dict[str, Any]:
        shapes: list[dict[str, Any]] = []
        motions = []
        for m, label, poses in zip(self.motions, self.labels, self._poses, strict=True):
            shape = turned(m.body, self.upper)
            if shape not in shapes:
                shapes.append(shape)
            table = {"slope": m._asked.slope, "turning": m._asked.turning}
            lies = {name: x for name, x in table.items() if x}
            motions.append({"label": label, "shape": shapes.index(shape)} | edges(m) | poses | lies)
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
            | (self._rates() if any(not m._nods for m in self.motions) else {})
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
        return "a" if all(m.body._length == "a" for m in self.motions) else "R"

    @property
    def _colours(self) -> dict[str, tuple[float, float, float]]:
        """The daylight colours of the page, for films."""
        return colours(reversed(_STYLES))

    @property
    def _slips(self) -> bool:
        """Whether the page shows forces, and has a camera that may follow the body."""
        wanted = self.look.follow or "force" in (self.look.drawn or ())
        return bool(wanted) or any(map(slips_or_flies, self.motions))

    def _speeds(self) -> dict[str, Any]:
        """The units in which the page gives the speed of slip, and the height of a flight."""
        high = any(map(goes_up, self.motions))
        if self.scale is None:
            lengths = {"metre": 1.0, "lengths": self._length} if high else {}
            return {"speed": 1.0, "speeds": f"√(g {self._length})"} | lengths
        lengths = {"metre": 1e3 * self.scale.radius, "lengths": "mm"} if high else {}
        return {"speed": 1e3 * self.scale.metres_per_second(1.0), "speeds": "mm/s"} | lengths

    def _rates(self) -> dict[str, Any]:
        """The unit in which the page gives the spin of a stone, and the factor from natural units."""
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
    """Make a page that shows motions of bodies in slow motion, from all sides.

    Parameters
    ----------
    *motions : Motion
        One motion, or several motions, which are shown side by side at the same time. Poses are computed if a
        motion does not contain them.
    labels : sequence of str, optional
        A label for each motion, shown as plain text. Default: none for a single motion, else the kind of
        contact. In labels and in the title, a tab or a new line is shown as a space.
    title : str
        Title of the page.
    scale : Scale, optional
        Size of the bodies, with a radius of 1e-6 to 1e6 m; times are then in seconds. Default: the scale of
        the bodies. Without any scale, sqrt(R/g) is shown as one second.
    slow : int, optional
        Factor of slow motion when the page opens: 1, 2, 5, 10, ... 1000. Default: chosen so that no body
        turns much faster than once a second, except in the last tenth of the time of a face that lands.
    upper : {"O", "X"}
        Symbol on the upper end. This is the symbol that the eye sees on a spinning tube.
    drawn : str or sequence of str, optional
        Additions to the picture, each with a switch on the page. "path" is the path of the contact point on
        the table. "omega", "momentum", "velocity" and "force" are arrows: angular velocity, angular momentum
        about the centre of mass, velocity of the centre of mass, and contact force (normal force N and
        friction F). "axis" is the instantaneous axis and the line P-C-O. Default: the path; on a page also
        the forces if there is a law of friction.
    above : bool
        If true, the camera is above the table, with x to the right.
    follow : bool, optional
        If true, the camera follows the body. Default: true if there is a law of friction and the body moves
        far.
    exposure : float, optional
        Duration of a long exposure from above, in turns of the body about the vertical: at least 0.01, or inf
        for the rest of the motion. The page then opens with this photograph. Default: no exposure.

    Returns
    -------
    View
        A notebook displays the page. ``.save("spin.html")``, ``.save("spin.mp4")``,
        ``.save("spin.svg", t=1.5)`` and ``.save("spin.glb")`` write files.

    Raises
    ------
    ValueError
        If there is no motion, the numbers of labels and motions differ, or a motion has no duration or is too
        long to show. If a title or a label has a control character, half a surrogate pair or a noncharacter,
        which HTML excludes.
    TypeError
        If an argument is of the wrong type; the message names it.

    Notes
    -----
    With a law of friction the path and the line under the slider are red while the body slips. Arrows at the
    contact point show the normal force N and the friction F, and the clock shows the slip.

    If a scale is known, times are in seconds, or in milliseconds on a page of less than a second, heights in
    millimetres, and slips in mm/s.

    If "#t=1.5" is added to the address of the page, the page opens at this time and is paused. A body whose
    motion has ended is grey, and its clock shows the reason and the time. The page contains poses at a few
    times, with cubic polynomials between them. For bodies of usual length they differ from the motion by at
    most 0.003 rad and 0.003 R. ω and L are computed from the drawn pose.

    All motions on a page have the same scale for their arrows. The longest arrow of each kind shows the
    largest value; for forces the scale is set by the usual normal force instead. The line P-C-O goes from the
    contact point P through the centre of mass C to the opposite point O. For a body that is symmetric top to
    bottom, O is the top of the upper rim, where the still symbols are. The instantaneous axis is the line of
    all points whose velocity is zero or along this line. While the body rolls, the axis passes through P; if
    the centre is at rest, it is the line P-C-O.

    For a body that flies (`roll` with a `restitution`), the clock shows the height of the lowest point. While
    the body is in the air, no path and no force are drawn.

    A table with a slope is drawn as it lies: gravity is vertical in the picture, and the clock shows the
    slope. From above, the camera looks along the normal of the table. The lines of a table that turns turn
    with it.

    For a stone the clock also shows the spin, and the time at which the spin reverses. A reversal counts when
    the spin has passed zero and reached a tenth of its first value in the other direction. A stone with an
    edge that can land is drawn as a hull with a needle on its top; any other stone is drawn with a band and a
    dot. `upper` determines the colour of the band, or of the half of the needle that points along the
    positive axis.

    The shape of a body that was made from its moments of inertia is unknown. It is drawn solid, and as long
    above its centre of mass as below. A ball with `theta_end` = pi/2 is drawn as two balls. A ball with
    another `theta_end` is drawn with a stem or a cap that touches the table at this inclination.

    Examples
    --------
    >>> import spincyl as sc
    >>> body = sc.Body.solid(2.5)
    >>> m = sc.roll(body, body.steady(1.3).kicked(0.05), 20.0)
    >>> sc.view(m)
    <View of a motion; .save('spin.html') writes the page>
    """
    if not motions:
        raise ValueError("motions: expected at least one Motion, as in view(m)")
    for m in motions:
        if not isinstance(m, Motion):
            raise TypeError(f"motions: expected Motion objects, not {type(m).__name__}")
    scale = scale_of(scale, *(m.body for m in motions))
    if scale is not None and not (1e-6 <= scale.radius <= 1e6 and 1e-6 <= scale.seconds(1.0) <= 1e6):
        raise ValueError(f"scale: expected R from 1e-6 to 1e6 m, sqrt(R/g) from 1e-6 to 1e6 s, not {scale!r}")
    if slow is not None:
        one_of("slow", slow, SLOW)
    if labels is None:
        labels = [""] if len(motions) == 1 else [contact_in_words(m.contact) for m in motions]
    elif isinstance(labels, str) or not isinstance(labels, Sequence):
        raise TypeError(f"labels: expected a list of texts, not {type(labels).__name__}")
    if len(labels) != len(motions):
        raise ValueError(f"labels: expected {len(motions)} labels, one for each motion, not {len(labels)}")
    title, labels = line("title", title), [line(f"labels[{i}]", label) for i, label in enumerate(labels)]
    for m in motions:
        marks(m.body, upper)  # raises ValueError if `upper` is neither "O" nor "X"
    how = look(drawn, above, follow, exposure)
    return View(
        [m.natural for m in motions], labels, title=title, scale=scale, slow=slow, upper=upper, look=how
    )


def film_of(
    m: Motion, path: str | PathLike[str], seconds: float | None = None, sound: bool | None = None
) -> Path:
    """Write the film of a motion as an .mp4 or .gif file, and return its path."""
    path = path_of("path", path)
    if path.suffix.lower() not in (".mp4", ".gif"):
        raise ValueError(f"path = {str(path)!r}: expected a name that ends in .mp4 or .gif")
    return view(m).save(path, seconds=seconds, sound=sound)
