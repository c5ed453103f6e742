"""Dense sweeps: maps of the steady states, and many motions at once, on all cores.

Labelled results need xarray (``pip install 'spincyl[sweep]'``). Inputs that are dask-backed stay lazy and run
block by block on whatever scheduler dask has; `block_size` says how large a block should be, and `save`
writes such a result to zarr and can be resumed.
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
