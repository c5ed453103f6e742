"""Dense sweeps: maps of the steady states, and many motions at once, on all cores.

Labelled results need xarray (``pip install 'spincyl[sweep]'``). Inputs that are dask-backed stay lazy and run
block by block on whatever scheduler dask has; `save` writes such a result to zarr and can be resumed.
"""

from spincyl.sweep._labels import Status
from spincyl.sweep._map import boundaries, points, portrait, survey
from spincyl.sweep._roll import Answer, roll
from spincyl.sweep._save import save

__all__ = ["Answer", "Status", "boundaries", "points", "portrait", "roll", "save", "survey"]
