"""The live page: a single HTML file that contains the core as WebAssembly and loads nothing."""

import html
import json
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import replace
from functools import cache
from importlib.resources import files
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._body import Body
from spincyl._contact import AnyContact, contact_in_words
from spincyl._ellipsoid import Ellipsoid
from spincyl._ellipsoid_motion import EllipsoidMotion
from spincyl._input.files import path_of, writing_whole
from spincyl._input.numbers import flag, in_range, instance_of, one_of, si
from spincyl._loss import Loss, command_line_name
from spincyl._motion import Motion
from spincyl._roll import roll
from spincyl._scale import Scale
from spincyl._state import State
from spincyl._table import Table
from spincyl.loss import KINDS
from spincyl.studio.cards import drawing
from spincyl.studio.pages.compressed import compressed
from spincyl.studio.pages.fits import check_bounces, check_circles, check_contents, check_table
from spincyl.studio.pages.joined import filled, frame, line, script, style, text
from spincyl.studio.pages.languages import LANGUAGES, numbered, table, words_of
from spincyl.studio.pages.packed import packed
from spincyl.studio.pages.words import (
    body_of,
    losses_of,
    paper_tube,
    restitution_of,
    scenes,
    slope_of,
    state_of,
    table_of,
    words_of_body,
    words_of_loss,
    words_of_restitution,
    words_of_slope,
    words_of_state,
    words_of_table,
)

if TYPE_CHECKING:
    #: Not defined at run time: completion by jedi fails for classes with a property of a Literal type.
    from spincyl._contact import AnyContact as Contact

#: The scripts in their order; the renderer is shared with the recorded page.
_SCRIPTS = (
    "play.core.js",
    "play.words.js",
    "play.state.js",
    "play.stage.js",
    "page.pose.js",
    "play.shape.js",
    "page.rounded.js",
    "page.forces.js",
    "page.context.js",
    "page.gl.js",
    "page.draw.js",
    "page.slope.js",
    "page.exposure.js",
    "page.eye.js",
    "play.map.js",
    "play.chart.js",
    "play.said.js",
    "play.run.js",
    "page.sound.js",
    "play.sound.js",
    "play.film.js",
    "page.stone.js",
    "play.stone.js",
    "play.hands.js",
)
#: The scripts of a page without friction, which has no stones.
_SCRIPTS_WITHOUT_FRICTION = tuple(name for name in _SCRIPTS if "stone" not in name)
_BODY = (
    "parts",
    "bottom",
    "top",
    "height",
    "ell",
    "bore",
    "fillet",
    "i1",
    "i3",
    "end",
    "radius",
    "mass",
    "gravity",
)
#: The core without friction and losses, and the one with them.
CORES = "core.lzma", "core.friction.lzma"
#: Permissions and style of the frame in a notebook.
SANDBOX = "allow-scripts allow-downloads"
FRAME = "width:100%;height:clamp(600px,100vh - 130px,900px);border:0"


class Play:
    """Interactive page; returned by `play`. A notebook displays it.

    With the extra `widget` (anywidget) the page in a notebook and this object stay synchronised. If you set
    an attribute, the page shows the new motion; if you change something on the page, the attributes change.
    Without the extra, a page that is shown no longer depends on this object.

    Attributes
    ----------
    html : str
        The complete page, which loads nothing from elsewhere.
    friction : bool
        True if the page includes friction and losses.
    """

    def __init__(
        self, told: dict[str, Any], title: str, friction: bool, body: Body, spoken: dict[str, str]
    ) -> None:
        self.title, self.friction, self._told, self._body = title, friction, told, body
        self._spoken = spoken
        self._widget: Any = None

    @property
    def body(self) -> Body:
        """The body; can be set. The page then starts with its steady state at the same inclination."""
        self._of_revolution()
        found, own = body_of(self._told), self._body
        # the same one knows its parts, and its circles, of which a page has the lowest one
        same = own if own.rims is None or found.rims is not None else replace(own, rims=None)
        return own if found == same else found

    @body.setter
    def body(self, body: Body) -> None:
        told = words_of_body(body)
        check_circles(told, self.contact)
        self._set(told, gone=(*_BODY, "w", "precession", "stone"))
        self._body = body

    @property
    def theta(self) -> float:
        """Inclination of the initial state, in radians; can be set."""
        return float(self._told["theta"])

    @theta.setter
    def theta(self, theta: float) -> None:
        self._set({"theta": in_range("theta", theta, 1e-3, np.pi, "radians")}, gone=("w", "precession"))

    @property
    def kick(self) -> float:
        """Rate of change theta' that is added to the initial state, in sqrt(g/R), -3 to 3; can be set."""
        return float(self._told.get("kick", 0.0))

    @kick.setter
    def kick(self, kick: float) -> None:
        self._set({"kick": in_range("kick", kick, -3, 3)})

    @property
    def state(self) -> State:
        """Initial state of the motion; can be set."""
        self._of_revolution()
        return state_of(self._told)

    @state.setter
    def state(self, state: State) -> None:
        self._set(words_of_state(state) | {"kick": 0.0}, gone=("precession",))

    @property
    def contact(self) -> "Contact":
        """Contact with the table, as in `roll`; can be set."""
        return table_of(self._told)

    @contact.setter
    def contact(self, contact: AnyContact) -> None:
        check_contents(self.friction, contact, None, None if self._told.get("stone") else self.body)
        check_bounces(self.friction, contact, self.restitution)
        check_circles(self._told, contact)
        self._set(words_of_table(contact), gone=("patch",))

    @property
    def restitution(self) -> float | None:
        """Coefficient of restitution, or None. It is used only with a law of friction. It can be set."""
        found: float | None = self._told.get("restitution")
        return found

    @restitution.setter
    def restitution(self, restitution: float | None) -> None:
        check_bounces(self.friction, self.contact, restitution)
        self._set(words_of_restitution(restitution), gone=("restitution",))

    @property
    def table(self) -> Table | None:
        """Table with a slope of up to 45 degrees, as in `roll`, or None for a level one; can be set."""
        return slope_of(self._told)

    @table.setter
    def table(self, table: Table | None) -> None:
        check_table(self.friction, table)
        self._set(words_of_slope(table), gone=("slope", "phi0"))

    @property
    def losses(self) -> Loss | None:
        """Loss of energy on the page, as in `roll`, or None; can be set to one law of `spincyl.loss`."""
        return losses_of(self._told)

    @losses.setter
    def losses(self, losses: Loss | None) -> None:
        check_contents(self.friction, "rolling", losses, None if self._told.get("stone") else self.body)
        self._set(words_of_loss(losses) or {"law": "none"})

    @property
    def motion(self) -> Motion:
        """The motion that the page shows, as `roll` returns it, up to the last time that the page computes.

        For a measured body the motion is in SI. If the page shows the rattleback, the motion lasts 20 s.
        """
        if self._told.get("stone"):
            return _rattleback_motion(self._told)
        body = self.body
        t = np.linspace(0.0, float(self._told["until"]) * body._second, 2001)
        how: dict[str, Any] = {"contact": self.contact, "losses": self.losses, "table": self.table}
        bounce = restitution_of(self._told)
        return roll(body, self.state, t, want=("pose", "force"), restitution=bounce, **how)

    def _of_revolution(self) -> None:
        """Raise ValueError if the page shows a stone."""
        if self._told.get("stone"):
            raise ValueError(
                "the page shows a rattleback, which is not a body of revolution; use the attribute `motion`"
            )

    def _set(self, words: dict[str, Any], gone: Iterable[str] = ()) -> None:
        """Change settings of this object and of the page; the settings in `gone` are removed."""
        self._told = {k: v for k, v in self._told.items() if k not in gone or k in words} | words
        if self._widget is not None:
            self._widget.state = self._told

    def _heard(self, change: Any) -> None:
        """Take over a change that the user has made on the page."""
        self._told = {k: v for k, v in change["new"].items() if v is not None}

    @property
    def html(self) -> str:
        """The page as text."""
        picture = drawing(body_of(self._told), self.theta, "θ")
        fields = {
            "title": html.escape(self.title),
            "style": style(["play.first.css"]),
            "picture": picture,
            "given": _json(self._told | self._spoken),
            "packed": _packed_page(self.friction),
            "loader": script(["page.night.js", "play.lzma.js", "play.join.js", "play.loader.js"]),
        }
        return filled("play.html", fields)

    @property
    def address(self) -> str:
        """End of the page's address, such as "#ell=2.5&theta=1.3", which contains all settings."""
        told = self._spoken | self._told
        words = {k: ",".join(map(repr, v)) if isinstance(v, list) else v for k, v in told.items()}
        words.pop("parts", None)  # an address has no room for surfaces
        return "#" + "&".join(f"{name}={word}" for name, word in words.items())

    def save(self, path: str | PathLike[str]) -> Path:
        """Write the page (.html) and return its path; an existing file is replaced when the page is complete.

        Raises
        ------
        ValueError
            If the suffix is not .html.
        OSError
            If the file cannot be written.
        """
        path = path_of("path", path)
        if path.suffix.lower() != ".html":
            raise ValueError(f"path = {str(path)!r}: expected a name that ends in .html")
        made = self.html.encode()
        with writing_whole(path) as part:
            part.write_bytes(made)
        return path

    def _repr_html_(self) -> str:
        """The page in a frame that may only run its script and save files; named if it follows the object."""
        return frame(self.html, SANDBOX, FRAME, self._followed())

    def _followed(self) -> str:
        """The name of the frames that follow this object; empty if no widget can pass changes to them."""
        if self._widget is None:
            with suppress(ImportError):
                from spincyl.studio.pages.widget import watched, widget

                if watched():
                    self._widget = widget(self._told, self._heard)
        return "" if self._widget is None else str(self._widget.name)

    def __repr__(self) -> str:
        if self._told.get("stone"):
            return "<Play of a rattleback, rolling; .save('play.html') writes the page>"
        return (
            f"<Play of {self.body!r}, {contact_in_words(self.contact)}; .save('play.html') writes the page>"
        )


def play(
    body: Body | None = None,
    theta: float | None = None,
    *,
    state: State | None = None,
    kick: float = 0.0,
    contact: AnyContact = "rolling",
    restitution: float | None = None,
    losses: Loss | None = None,
    table: Table | None = None,
    t: float | None = None,
    slow: float = 20.0,
    friction: bool = True,
    title: str = "spincyl: a page to play with",
    language: str | None = None,
) -> Play:
    """Make an interactive page that computes motions itself: drag a point on a map, and see the exact motion.

    Parameters
    ----------
    body : Body, optional
        Single body. A solid frustum (`Body.frustum`, `Body.cone`) moves on both circles, with friction; any
        other body of several circles moves on the lowest one. Default: the measured tube of the paper. For a
        measured body the page also gives times in seconds and rates in hertz.
    theta : float, optional
        Inclination of the initial steady state, in radians. If there is no steady state at this inclination,
        the body starts at rest. Default: 1.3; for the tube of the paper 89.5 degrees.
    state : State, optional
        Initial state, instead of the steady state at `theta`.
    kick : float
        Rate of change theta' that is added to the steady state, in sqrt(g/R), -3 to 3.
    contact : {"rolling", "smooth"}, Coulomb or Viscous
        Contact with the table. For Coulomb friction on this page, the coefficients of static and sliding
        friction have to be equal. A contact patch may have a radius of up to 0.5 R; a patch excludes
        `restitution`.
    restitution : float, optional
        Coefficient of restitution, 0 to 1. It is used only with a law of friction: a body that leaves the
        table then comes down again, and may lie on its side. Default: the motion ends when the body leaves
        the table or its other rim lands.
    losses : Loss, optional
        One law of `spincyl.loss`, which takes energy from the body.
    table : Table, optional
        Table with a slope from 0 to 45 degrees, and `phi0`, the direction to which the axis leans at first.
        The motion starts at the place (0, 0). Default: a level table.
    t : float
        Last time of a motion with friction or losses, or on a slope: 1 to 2000 sqrt(R/g), for a measured
        body in seconds. Default: 60 sqrt(R/g). Such motions are integrated by steps.
    slow : float
        Factor of slow motion, 1 to 1000. A body without a size is shown as if R = 1 cm.
    friction : bool
        If false, the page has no friction and no losses, and the file is smaller. The body then only rolls
        (on "rubber") or slides without friction (on "ice").
    title : str
        Title of the page. A tab or a new line is shown as a space.
    language : {"en", "de", "fr", "es", "it", "pt", "ja", "zh"}, optional
        Language of the page. Its address and its list can choose another. Default: that of the browser.

    Returns
    -------
    Play
        A notebook displays the page; ``.save("play.html")`` writes one file, which works offline.

    Raises
    ------
    ValueError
        If `body` is a family, a number is out of range, the language is unknown, or there are several losses.
        If `state` is given with `theta` or `kick`. If a law of friction or losses are given but `friction`
        is False. If the title has a control character, half a surrogate pair or a noncharacter.
    TypeError
        If an argument is of the wrong type; the message names it.

    Notes
    -----
    The page needs WebAssembly with SIMD, and WebGL 2 (Chrome 91, Firefox 89, Safari 16.4, or later). Other
    browsers show a picture and the reason. The address of the page contains all settings, as in
    "#ell=2.5&theta=1.3".

    Examples
    --------
    >>> import spincyl as sc
    >>> sc.play(sc.Body.tube(6.0, bore=0.8), 1.5)
    <Play of Body.tube(6.0, bore=0.8), rolling; .save('play.html') writes the page>
    """
    friction = flag("friction", friction)
    steep = 1.3
    if body is None:
        body, steep = paper_tube(), float(np.radians(89.5))
    told = words_of_body(body)
    if state is not None:
        if theta is not None or not (type(kick) in (int, float) and kick == 0):
            raise ValueError("state: cannot be combined with theta or kick; give one or the other")
        told |= words_of_state(state)
    else:
        theta = in_range("theta", steep if theta is None else theta, 1e-3, np.pi, "radians")
        told |= {"theta": theta, "kick": in_range("kick", kick, -3, 3)}
    if t is None:
        told |= {"until": 60.0}
    else:
        unit = body._second
        told |= {"until": in_range("t", si("t", t, "second"), unit, 2000 * unit) / unit}
    told |= {"slow": in_range("slow", slow, 1, 1000)}
    told |= words_of_table(contact) | words_of_restitution(restitution) | words_of_loss(losses)
    told |= words_of_slope(table)
    check_circles(told, contact)
    check_contents(friction, contact, losses, body)
    check_bounces(friction, contact, restitution)
    check_table(friction, table)
    spoken = {} if language is None else {"language": one_of("language", language, ("en", *LANGUAGES))}
    return Play(told, line("title", title), friction, body, spoken)


def _rattleback_motion(words: dict[str, Any]) -> EllipsoidMotion:
    """The motion of the rattleback described by `words`, for the time that the page computes."""
    stone = Ellipsoid.rattleback(words["stone"], twist=words["twist"]).in_metres(
        gravity=words.get("gravity") or Scale.gravity
    )
    push, unit = np.radians(0.02), instance_of("scale", stone.scale, Scale).seconds(1.0)
    start = stone.spinning(words["spin"] * unit, pitch=push, roll=push)
    return roll(stone, start, np.linspace(0.0, 20.0, 2401), want="pose")


def _json(what: Any) -> str:
    """JSON that cannot end the script element around it."""
    return json.dumps(what, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


def _body_and_script(friction: bool) -> tuple[str, str]:
    """The elements of the page with its words, loss laws and scenes, and the script."""
    code, told = script(_SCRIPTS if friction else _SCRIPTS_WITHOUT_FRICTION), [*scenes(friction)]
    words = words_of(text("play.body.html"), code, [name for name, _ in told])
    presets = [{"name": name, "word": words.index(name), "state": state} for name, state in told]
    laws = _json([*map(command_line_name, KINDS.values())])
    fields = {"words": table(words), "laws": laws, "presets": _json(presets)}
    return filled("play.body.html", fields), numbered(code, words)


@cache
def _packed_page(friction: bool) -> str:
    """The core and all text of the page, in the format that the loader unpacks."""
    core = files("spincyl.studio.pages").joinpath("cores", CORES[friction]).read_bytes()
    rest = "\0".join([style(["play.css"]), *_body_and_script(friction)])
    return packed(core, compressed(rest.encode()))
