"""Rigid bodies that spin and roll on their rim.

Steady states of cylinders, tubes and disks, their stability, their motion, and dense maps. Natural units:
rim radius R, mass M and gravity g are 1, so lengths are in R, times in sqrt(R/g); `Scale` turns
them into metres and seconds. Angles are in radians.
"""

from importlib import import_module
from types import ModuleType

from spincyl._body import Body, Region
from spincyl._motion import Ending, Event, Motion, StepWarning, Swing, roll, swing
from spincyl._scale import Scale
from spincyl._state import State

__version__ = "0.1.0"
__all__ = [
    "Body",
    "Ending",
    "Event",
    "Motion",
    "Region",
    "Scale",
    "State",
    "StepWarning",
    "Swing",
    "plot",
    "roll",
    "sweep",
    "swing",
]


def __getattr__(name: str) -> ModuleType:
    if name in {"plot", "sweep"}:
        return import_module(f"spincyl.{name}")
    raise AttributeError(f"module 'spincyl' has no attribute {name!r}")
