"""Rigid bodies that spin and roll on their rim.

Steady states of cylinders, tubes and disks, their stability, their motion, and dense maps. In natural units
the rim radius R, the mass M and gravity g are 1: lengths are in R, times in sqrt(R/g). `Scale` converts them
to metres and seconds, and the motions of `measured` bodies are in SI. Angles are in radians.
"""

# The layers from below, one a line. A module imports from its own layer and from those before it, wherever an
# import stands; only for types may it know any other. `tests/test_package.py` reads this table.
#
# _input         numbers, units, words, threads, whole files: no physics, and nothing else of spincyl
# .              the thin wrapper of `_core`: bodies, states, motions, laws of friction and loss
# sweep          maps of steady states, and many motions at once
# studio         an application: shapes, drawings, films, scenes and sound of bodies and motions
# studio.plot    its figures
# studio.pages   its pages for a browser: recorded motions, and live ones that the core computes in the page
# lab            an application: measurements, what is fitted to them, and figures of both
# __init__       this front door, and the doors `plot` and `data`: public names, and `_upward` for methods
# cli            the command line, and `__main__`

from importlib import import_module
from typing import TYPE_CHECKING, Any

from spincyl._body import Body
from spincyl._circles import Apex
from spincyl._contact import Coulomb, Viscous
from spincyl._ending import Ending, ErrorWarning, Event, Held, RestsOn
from spincyl._input.hints import proposal as _instead
from spincyl._laws import Region
from spincyl._measured import measured
from spincyl._motion import Motion
from spincyl._phases import Impact, Phase
from spincyl._restitution import GainWarning, Newton, Poisson, Walton
from spincyl._roll import StepWarning, roll
from spincyl._scale import Scale
from spincyl._stand import spun, tripped
from spincyl._state import State
from spincyl._swing import Swing, swing
from spincyl._table import Table
from spincyl._throw import dropped, flicked, launch_number, pressed, thrown
from spincyl._turning import turning_spin
from spincyl._upward import HOMES

if TYPE_CHECKING:
    from spincyl import data, loss, parts, plot, sweep
    from spincyl._drift import Drift, DriftWarning, drift
    from spincyl._ellipsoid import Ellipsoid
    from spincyl._ellipsoid_motion import EllipsoidMotion
    from spincyl._ellipsoid_state import EllipsoidState, Rocking
    from spincyl._rising import rising_spin
    from spincyl._sideways import slope_drift
    from spincyl.parts import assembled
    from spincyl.studio.exposure import exposure
    from spincyl.studio.pages.play import Play, play
    from spincyl.studio.pages.view import View, view
    from spincyl.studio.scene import Deviation, Scene, scene

__version__ = "0.1.0"
__all__ = [
    "Apex",
    "Body",
    "Coulomb",
    "Deviation",
    "Drift",
    "DriftWarning",
    "Ellipsoid",
    "EllipsoidMotion",
    "EllipsoidState",
    "Ending",
    "ErrorWarning",
    "Event",
    "GainWarning",
    "Held",
    "Impact",
    "Motion",
    "Newton",
    "Phase",
    "Play",
    "Poisson",
    "Region",
    "RestsOn",
    "Rocking",
    "Scale",
    "Scene",
    "State",
    "StepWarning",
    "Swing",
    "Table",
    "View",
    "Viscous",
    "Walton",
    "assembled",
    "custom",
    "data",
    "drift",
    "dropped",
    "exposure",
    "flicked",
    "launch_number",
    "loss",
    "measured",
    "parts",
    "play",
    "plot",
    "pressed",
    "rising_spin",
    "roll",
    "scene",
    "slope_drift",
    "spun",
    "sweep",
    "swing",
    "thrown",
    "tripped",
    "turning_spin",
    "view",
]


# modules and names that most scenes do not need are loaded at first use
_LATER: dict[str, str | None] = {
    **dict.fromkeys(("custom", "data", "loss", "parts", "plot", "sweep")),
    **dict.fromkeys(("drift", "Drift", "DriftWarning"), "_drift"),
    "Ellipsoid": "_ellipsoid",
    "EllipsoidMotion": "_ellipsoid_motion",
    **dict.fromkeys(("EllipsoidState", "Rocking"), "_ellipsoid_state"),
    "assembled": "parts",
    "exposure": "studio.exposure",
    **dict.fromkeys(("play", "Play"), "studio.pages.play"),
    "rising_spin": "_rising",
    "slope_drift": "_sideways",
    **dict.fromkeys(("Deviation", "scene", "Scene"), "studio.scene"),
    **dict.fromkeys(("view", "View"), "studio.pages.view"),
}


# methods whose functions stand in a layer above the class: those are loaded at first use, too
HOMES.update(
    {
        "Body.roll": ("spincyl._roll", "roll"),
        "Comparison.plot": ("spincyl.lab._figures", "comparison"),
        "FilmComparison.plot": ("spincyl.lab._filmfigures", "film"),
        "Filmed.over": ("spincyl.lab._over", "over"),
        "Filmed.plot": ("spincyl.lab._filmfigures", "film"),
        "Drift.plot": ("spincyl.studio.plot._drift", "drift"),
        "LossFit.plot": ("spincyl.lab._figures", "losses"),
        "Motion.plot": ("spincyl.studio.plot._motions", "motion"),
        "Motion.sound": ("spincyl.studio.sound", "sound"),
        "Scene.compare": ("spincyl.lab._trajectory", "trajectory"),
        "Motion.film": ("spincyl.studio.pages.view", "film_of"),
        "loss.typical": ("spincyl.lab._typical", "typical"),
        "card": ("spincyl.studio.cards", "card"),
    }
)


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        more = "" if name.startswith("_") else _instead(name, __all__)
        raise AttributeError(f"module 'spincyl' has no attribute {name!r}{more}")
    room = _LATER[name]
    if room is None:
        return import_module(f"spincyl.{name}")
    found = getattr(import_module(f"spincyl.{room}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})
