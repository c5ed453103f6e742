"""Pictures: branches of steady states, the theta-ell map, the energy landscape, motions, photographs.

Every function takes `ax=`, draws on it and returns it; none calls `show()`.
"""

from spincyl.plot._figures import figures
from spincyl.plot._frame import frame
from spincyl.plot._maps import Landmark, branches, energy, landmarks, portrait
from spincyl.plot._motions import comparison, exposure, motion

__all__ = [
    "Landmark",
    "branches",
    "comparison",
    "energy",
    "exposure",
    "figures",
    "frame",
    "landmarks",
    "motion",
    "portrait",
]
