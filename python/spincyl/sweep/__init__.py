"""Dense sweeps: maps of the steady states, and many motions at once, on all cores.

Labelled results need xarray (``pip install 'spincyl[sweep]'``). If an input is backed by dask, the result is
lazy and is computed block by block by the scheduler of dask. `block_size` computes how large a block should
be, and `save` writes a lazy result to zarr; an interrupted save can be resumed.
"""

from spincyl.sweep._blocks import block_size
from spincyl.sweep._flicks import Outcome, flicks
from spincyl.sweep._inputs import inputs
from spincyl.sweep._labels import Status
from spincyl.sweep._map import boundaries, points, portrait, survey
from spincyl.sweep._roll import Answer, roll
from spincyl.sweep._save import save

__all__ = [
    "Answer",
    "Outcome",
    "Status",
    "block_size",
    "boundaries",
    "flicks",
    "inputs",
    "points",
    "portrait",
    "roll",
    "save",
    "survey",
]


def __dir__() -> list[str]:
    return [*__all__, *(name for name in globals() if name.startswith("__"))]
