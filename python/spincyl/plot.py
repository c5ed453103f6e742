"""Pictures: branches of steady states, the theta-ell map, the energy landscape, motions, losses, photographs.

Most functions draw on the axes `ax=`, or on new ones, and return the axes; none calls `show()`.
"""

from spincyl.lab._figures import comparison, losses
from spincyl.lab._filmfigures import film
from spincyl.studio.plot._drift import drift
from spincyl.studio.plot._figures import figures
from spincyl.studio.plot._flicks import flicks
from spincyl.studio.plot._frame import frame
from spincyl.studio.plot._maps import Landmark, branches, energy, landmarks, portrait
from spincyl.studio.plot._motions import exposure, motion

__all__ = [
    "Landmark",
    "branches",
    "comparison",
    "drift",
    "energy",
    "exposure",
    "figures",
    "film",
    "flicks",
    "frame",
    "landmarks",
    "losses",
    "motion",
    "portrait",
]


def __dir__() -> list[str]:
    return [*__all__, *(name for name in globals() if name.startswith("__"))]
