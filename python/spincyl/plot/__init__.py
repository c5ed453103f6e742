"""Pictures: branches of steady states, the theta-ell map, the energy landscape, motions, losses, photographs.

Most functions draw on the axes `ax=`, or on new ones, and return the axes; none calls `show()`.
"""

from spincyl.plot._drift import drift
from spincyl.plot._figures import figures
from spincyl.plot._flicks import flicks
from spincyl.plot._frame import frame
from spincyl.plot._losses import losses
from spincyl.plot._maps import Landmark, branches, energy, landmarks, portrait
from spincyl.plot._motions import comparison, exposure, motion

__all__ = [
    "Landmark",
    "branches",
    "comparison",
    "drift",
    "energy",
    "exposure",
    "figures",
    "flicks",
    "frame",
    "landmarks",
    "losses",
    "motion",
    "portrait",
]
