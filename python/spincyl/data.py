"""Measured data: read tables and sound, and compare steady states and spin-downs with those of a body."""

from spincyl.lab._above import from_above
from spincyl.lab._beside import FilmComparison
from spincyl.lab._bounces import Bounces, fit_bounces
from spincyl.lab._columns import Columns
from spincyl.lab._compare import Comparison, compare
from spincyl.lab._contents import MOST_BYTES as MOST_BYTES
from spincyl.lab._examples import example
from spincyl.lab._filmed import Filmed
from spincyl.lab._line import Line
from spincyl.lab._losses import fit_losses
from spincyl.lab._lossfit import FittedLoss, LossFit
from spincyl.lab._motionfit import MotionFit, fit_motion
from spincyl.lab._sound import read_phyphox, read_sound
from spincyl.lab._stop import FittedStop, StopFit, fit_stop
from spincyl.lab._tracker import read_table, read_tracker
from spincyl.lab._wobble import Wobble, wobble

__all__ = [
    "Bounces",
    "Columns",
    "Comparison",
    "FilmComparison",
    "Filmed",
    "FittedLoss",
    "FittedStop",
    "Line",
    "LossFit",
    "MotionFit",
    "StopFit",
    "Wobble",
    "compare",
    "example",
    "fit_bounces",
    "fit_losses",
    "fit_motion",
    "fit_stop",
    "from_above",
    "read_phyphox",
    "read_sound",
    "read_table",
    "read_tracker",
    "wobble",
]


def __dir__() -> list[str]:
    return [*__all__, "MOST_BYTES", *(name for name in globals() if name.startswith("__"))]
