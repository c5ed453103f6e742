"""The size of a block of a lazy sweep."""

import math
import os
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._input.numbers import number, optional_library, reals
from spincyl.sweep import _records

if TYPE_CHECKING:
    import xarray

#: Least share of a sample's time that is ascribed to its motions, rather than to the fixed cost of a block.
OWN = 0.25


def block_size(
    job: "Callable[..., xarray.Dataset]",
    *sample: Any,
    seconds: float = 1.0,
    path: str | os.PathLike[str] | None = None,
) -> int:
    """Compute the number of motions, or of points of a map, for one block of dask, by timing a sample.

    Parameters
    ----------
    job : callable
        Function that takes the arrays of the sweep and returns the result of `roll` or `portrait` for them.
    *sample : array_like
        Arguments for `job`: arrays in memory for a thousand motions or more, from all parts of the sweep.
        Arguments that are numbers are passed on unchanged.
    seconds : float
        Time in seconds, more than 0, that a block should take on a core like this one without other work.
        The CPU time of the sample is measured. The time of a block with a single motion is subtracted from
        it; this motion is the first or the last of the sample, whichever is faster.
    path : path, optional
        Path of the store for `save`. If a sweep has begun there, nothing is measured and the result is the
        size of its blocks. So a script that is run again continues with the same blocks. A path that
        `save` would not accept, such as a folder that is not a sweep, raises the same error here.

    Returns
    -------
    int
        Number of motions or points in a block: 1, 2 or 5 times a power of ten. A block takes at most
        `seconds` if its motions are like those of the sample. The results of a block need at most the memory
        ``dask.config.get("array.chunk-size")``, 128 MiB by default.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid, or `job` does not return a lazy result for lazy arguments; the message
        names the argument.
    OSError
        If the store at `path` cannot be used, as in `save`.

    Notes
    -----
    For each block a scheduler needs a few milliseconds, and writing to a store a few tens of milliseconds.
    If a block takes a tenth of a second, a tenth of the time or more is therefore lost. If a block takes an
    hour and its worker dies, up to an hour of work is lost. See docs/cluster.md.

    Examples
    --------
    >>> import dask.array as da
    >>> import numpy as np
    >>> import spincyl as sc
    >>> def job(ell):
    ...     body = sc.Body.solid(ell)
    ...     return sc.sweep.roll(body, body.steady(1.3).kicked(0.05), 20.0)
    >>> size = sc.sweep.block_size(job, np.linspace(0.9, 3, 2000))
    >>> found = job(da.linspace(0.9, 3, 10**9, chunks=size))
    >>> found.sizes["motion"], found.chunksizes["motion"][0] == size
    (1000000000, True)
    """
    asked = number("seconds", seconds)
    if not 0 < asked < math.inf:
        raise ValueError(f"seconds = {seconds!r}: expected a positive number")
    if path is not None and (begun := _begun(path)) is not None:
        return begun
    if not callable(job):
        raise TypeError(f"job: expected a function, not {type(job).__name__}")
    dask, array = optional_library("dask", "sweep"), optional_library("dask.array", "sweep")
    blocks = [_one_block(x, array) for x in sample]
    found = job(*blocks)
    if not hasattr(found, "chunksizes") or not found.chunksizes:
        raise TypeError(
            "job: expected a function that returns a lazy Dataset of spincyl.sweep for lazy arguments"
        )
    count = math.prod(n for name, n in found.sizes.items() if name != "t")
    if count == 0:
        raise ValueError("sample: expected arrays with at least one motion")
    taken = _cost(found, asked)
    if count > 1:
        # The fixed cost of a block matters in a small sample, but hardly in a large block. It is measured
        # with two blocks of one motion, the first and the last of the sample, since one of them may be slow.
        ends = slice(0, 1), slice(-1, None)
        least = min(_cost(job(*(_part(x, end) for x in blocks)), asked) for end in ends)
        taken = max(taken - least, OWN * taken)
    most = dask.utils.parse_bytes(dask.config.get("array.chunk-size"))
    return _round(count * min(asked / taken, most / found.nbytes))


def _cost(found: Any, enough: float) -> float:
    """Processor time in seconds to compute a Dataset: the least of two to five runs."""
    times: list[float] = []
    while len(times) < 2 or (len(times) < 5 and sum(times) < enough):
        began = time.process_time()
        found.compute(scheduler="synchronous")
        times.append(time.process_time() - began)
    return min(times)


def _part(x: Any, of: slice) -> Any:
    """The part of an array of the sample with the slice `of` along each of its axes."""
    if hasattr(x, "isel"):
        return x.isel({axis: of for axis in x.dims})
    return x[(of,) * np.ndim(x)] if np.ndim(x) else x


def _one_block(x: Any, array: Any) -> Any:
    """A sample as a lazy array of one block, so that the timed work is that of a worker."""
    if hasattr(x, "chunk"):
        return x.chunk()
    kept = reals("sample", x)
    if np.ndim(kept) and not np.size(kept):
        raise ValueError("sample: expected arrays with at least one motion")
    return kept if np.ndim(kept) == 0 else array.from_array(np.asarray(kept), chunks=-1)


def _round(most: float) -> int:
    """The largest of 1, 2, 5, 10, ... that is not above `most`."""
    power: int = 10 ** math.floor(math.log10(max(most, 1.0)))
    return max(n * power for n in (1, 2, 5) if n * power <= max(most, 1.0))


def _begun(path: str | os.PathLike[str]) -> int | None:
    """Motions in the first block of a sweep saved at `path`, or None; an error for an unusable path."""
    store = _records.place(path)
    with _records.naming(store):
        for record in _records.recorded(store):
            return math.prod(int(size) for name, (size, _) in record["chunks"].items() if name != "t")
    return None
