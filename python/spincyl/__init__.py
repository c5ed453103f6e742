"""Rigid bodies that spin and roll on their rim.

Steady states of cylinders, tubes and disks, their stability, their motion, and dense maps. Natural units:
rim radius R, mass M and gravity g are 1, so lengths are in R, times in sqrt(R/g); `Scale` turns
them into metres and seconds, and the motions of a body that is `measured` are in SI. Angles are in radians.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from spincyl._body import Body
from spincyl._contact import Coulomb, Viscous
from spincyl._ending import Ending, ErrorWarning, Event
from spincyl._laws import Region
from spincyl._measured import measured
from spincyl._motion import Motion
from spincyl._phases import Phase
from spincyl._roll import StepWarning, roll
from spincyl._scale import Scale
from spincyl._state import State
from spincyl._swing import Swing, swing
from spincyl._throw import flicked, launch_number, pressed, thrown

if TYPE_CHECKING:
    from spincyl import data, loss, plot, sweep
    from spincyl._drift import Drift, DriftWarning, drift
    from spincyl._ellipsoid import Ellipsoid, Rocking
    from spincyl._ellipsoid_motion import EllipsoidMotion
    from spincyl._ellipsoid_state import EllipsoidState
    from spincyl._pages.play import Play, play
    from spincyl._pages.view import View, view
    from spincyl._studio.exposure import exposure
    from spincyl._studio.scene import Scene, scene

__version__ = "0.1.0"
__all__ = [
    "Body",
    "Coulomb",
    "Drift",
    "DriftWarning",
    "Ellipsoid",
    "EllipsoidMotion",
    "EllipsoidState",
    "Ending",
    "ErrorWarning",
    "Event",
    "Motion",
    "Phase",
    "Play",
    "Region",
    "Rocking",
    "Scale",
    "Scene",
    "State",
    "StepWarning",
    "Swing",
    "View",
    "Viscous",
    "data",
    "drift",
    "exposure",
    "flicked",
    "launch_number",
    "loss",
    "measured",
    "play",
    "plot",
    "pressed",
    "roll",
    "scene",
    "sweep",
    "swing",
    "thrown",
    "view",
]


# what most scenes do not need is loaded when it is used
_LATER = {
    "data": None,
    "loss": None,
    "plot": None,
    "sweep": None,
    "drift": "_drift",
    "Drift": "_drift",
    "DriftWarning": "_drift",
    "Ellipsoid": "_ellipsoid",
    "EllipsoidMotion": "_ellipsoid_motion",
    "EllipsoidState": "_ellipsoid_state",
    "Rocking": "_ellipsoid",
    "exposure": "_studio.exposure",
    "play": "_pages.play",
    "Play": "_pages.play",
    "scene": "_studio.scene",
    "Scene": "_studio.scene",
    "view": "_pages.view",
    "View": "_pages.view",
}


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module 'spincyl' has no attribute {name!r}")
    room = _LATER[name]
    if room is None:
        return import_module(f"spincyl.{name}")
    found = getattr(import_module(f"spincyl.{room}"), name)
    globals()[name] = found
    return found


def _card(self: Any) -> str:
    """What a notebook shows of a noun; `_studio.cards` knows all nouns, and none of them knows it."""
    return str(import_module("spincyl._studio.cards").card(self))


for _noun in (Body, Motion, Scale, State, Swing):
    setattr(_noun, "_repr_html_", _card)  # noqa: B010 (mypy knows no such attribute)


def __dir__() -> list[str]:
    return sorted({*globals(), *_LATER})
