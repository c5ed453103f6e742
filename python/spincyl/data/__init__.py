"""Measured data: read tables and sound, and compare steady states and spin-downs with those of a body."""

from spincyl.data._above import Filmed, from_above
from spincyl.data._columns import Columns
from spincyl.data._compare import Comparison, compare
from spincyl.data._contents import MOST_BYTES as MOST_BYTES
from spincyl.data._examples import example
from spincyl.data._line import Line
from spincyl.data._losses import fit_losses
from spincyl.data._lossfit import FittedLoss, LossFit
from spincyl.data._sound import read_phyphox, read_sound
from spincyl.data._stop import FittedStop, StopFit, fit_stop
from spincyl.data._tracker import read_table, read_tracker
from spincyl.data._wobble import Wobble, wobble

__all__ = [
    "Columns",
    "Comparison",
    "Filmed",
    "FittedLoss",
    "FittedStop",
    "Line",
    "LossFit",
    "StopFit",
    "Wobble",
    "compare",
    "example",
    "fit_losses",
    "fit_stop",
    "from_above",
    "read_phyphox",
    "read_sound",
    "read_table",
    "read_tracker",
    "wobble",
]
