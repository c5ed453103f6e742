"""Results on disk: block by block, so that a sweep killed at any moment goes on where it was."""

import errno
import json
import os
import sys
import warnings
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import numpy as np

from spincyl._array import extra
from spincyl._written import replaced
from spincyl.sweep._common import Progress, callback

if TYPE_CHECKING:
    import xarray


def records(path: str | os.PathLike[str]) -> Path:
    """What the sweep is, and which of its blocks are done: a directory beside the store."""
    store = Path(path)
    return store.with_name(f"{store.name}.sweep")


def _folder(store: Path) -> Any:
    """The store for zarr and xarray, to whom a name like `~` is another folder, and `a::b` an address."""
    from zarr.storage import LocalStore

    return LocalStore(os.path.realpath(store))


def save(
    result: "xarray.Dataset", path: str | os.PathLike[str], *, progress: Progress | None = None
) -> "xarray.Dataset":
    """Compute a lazy sweep and write it to zarr, block by block; or go on where a call was interrupted.

    Parameters
    ----------
    result : xarray.Dataset
        What `portrait` or `roll` returned for dask-backed inputs; one block of dask is one block on disk.
    path : path
        A directory: of a new store, or of one that this function began for the same sweep.
    progress : callable, optional
        Called with the share of blocks done, 0 to 1, after each pass.

    Returns
    -------
    xarray.Dataset
        The stored result, opened.

    Raises
    ------
    ValueError
        If the store at `path` is of another sweep or another version: the message names the first difference.
    OSError
        If it cannot be written, with the path; what has been written stays good, and a later call goes on.
        A BlockingIOError if another process or thread is saving to it now.

    Warns
    -----
    UserWarning
        Once, if blocks that were done are missing or damaged: they are computed again. Where files cannot be
        locked, so that nobody would notice two processes that save to one store.

    Notes
    -----
    Blocks are written by xarray as they are computed by whatever scheduler dask has, a distributed one
    included. A block counts as done when its checksum has been recorded, after its arrays are on disk;
    writing a block again gives the same bytes. So a kill costs at most the blocks that were being computed.
    """
    xr, dask = extra("xarray", "sweep"), extra("dask", "sweep")
    extra("zarr", "sweep")
    if not isinstance(result, xr.Dataset) or "spincyl_sweep" not in result.attrs:
        raise TypeError("result: expected a lazy Dataset of spincyl.sweep, made of dask-backed inputs")
    callback(progress)
    store = Path(path)
    blocks = list(_blocks(result))
    record = {
        "format": 1,
        "job": result.attrs["spincyl_sweep"],
        "blocks": len(blocks),
        "chunks": _chunks(result),
    }
    if store.exists() and not records(store).exists():
        raise FileExistsError(errno.EEXIST, "exists, and is no sweep that could go on", os.fspath(store))
    records(store).mkdir(exist_ok=True)
    with _alone(store):
        _begin(result, store, record)
        todo = _todo(store, blocks)
        written = _written(result, store)
        ask, first = dask.base.get_scheduler(collections=[written]), 0
        while first < len(todo):
            last = first + _pass(ask)
            if progress:
                progress(1 - (len(todo) - first) / len(blocks))
            keys = [_key(written, block, record["chunks"]) for block in todo[first:last]]
            ask(written.__dask_optimize__(written.__dask_graph__(), keys), keys)
            first = last
    if progress:
        progress(1.0)
    opened: xarray.Dataset = xr.open_zarr(_folder(store))
    opened.encoding["source"] = os.path.realpath(store)
    return opened


def _pass(ask: Any) -> int:
    """How many blocks are asked for at once: eight for each thread that computes them."""
    client: Any = getattr(ask, "__self__", None)
    threads = sum(client.nthreads().values()) if hasattr(client, "nthreads") else os.cpu_count() or 1
    return 8 * max(1, threads)


if sys.platform == "win32":
    import msvcrt

    def _lock(file: int, on: bool) -> None:
        msvcrt.locking(file, msvcrt.LK_NBLCK if on else msvcrt.LK_UNLCK, 1)
else:
    import fcntl

    def _lock(file: int, on: bool) -> None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB if on else fcntl.LOCK_UN)


@contextmanager
def _alone(store: Path) -> Iterator[None]:
    """Nobody else saves to the store until the end of this, or the death of this process."""
    with (records(store) / "lock").open("ab") as file:
        try:
            _lock(file.fileno(), True)
        except OSError as e:
            if e.errno in (errno.EACCES, errno.EAGAIN, errno.EWOULDBLOCK):
                said = "another process or thread is saving to it"
                raise BlockingIOError(errno.EWOULDBLOCK, said, os.fspath(store)) from None
            said = f"{store}: it cannot be locked ({e.strerror}): see that nobody else saves to it"
            warnings.warn(said, stacklevel=4)
            yield
            return
        try:
            yield
        finally:
            _lock(file.fileno(), False)  # of a forked child's copy, too


Block = dict[str, tuple[int, int]]


def _chunks(result: "xarray.Dataset") -> dict[str, list[int]]:
    return {str(dim): [int(n) for n in sizes] for dim, sizes in result.chunksizes.items()}


def _blocks(result: "xarray.Dataset") -> Iterator[Block]:
    """Where each block begins and ends, along every chunked dimension."""
    edges = {}
    for dim, sizes in _chunks(result).items():
        if len(set(sizes[:-1])) > 1 or (len(sizes) > 1 and sizes[-1] > sizes[0]):
            raise ValueError(f"result: blocks of one size along {dim}, not {sizes}: rechunk it")
        starts = [sum(sizes[:i]) for i in range(len(sizes))]
        edges[dim] = [(a, a + n) for a, n in zip(starts, sizes, strict=True)]
    for ends in product(*edges.values()):
        yield dict(zip(edges, ends, strict=True))


def _written(result: "xarray.Dataset", store: Path) -> Any:
    """A lazy array with one number for each block, which is there when the block is written.

    Nothing but that number goes back to who asked. All blocks are one plan of dask's: making one for each
    takes the client longer than a worker needs for a block.
    """
    array = extra("dask.array", "sweep")
    chunks = _chunks(result)
    arguments: list[Any] = []
    for dim, sizes in chunks.items():
        arguments += [array.arange(len(sizes), chunks=1), (dim,)]
    for variable in result.data_vars.values():
        arguments += [array.asarray(variable.data), variable.dims]
    return array.blockwise(
        _write,
        tuple(chunks),
        *arguments,
        name=f"save-{uuid4().hex}",
        adjust_chunks=dict.fromkeys(chunks, 1),
        align_arrays=False,
        concatenate=True,
        dtype=np.uint8,
        meta=np.empty((0,) * len(chunks), np.uint8),
        path=os.fspath(store),
        sizes={dim: (sizes[0], sum(sizes)) for dim, sizes in chunks.items()},
        variables=[(name, variable.dims) for name, variable in result.data_vars.items()],
    )


def _key(written: Any, block: Block, chunks: dict[str, list[int]]) -> tuple[Any, ...]:
    """The name that dask has for a block of `_written`."""
    return written.name, *(block[dim][0] // max(1, sizes[0]) for dim, sizes in chunks.items())


def _begin(result: "xarray.Dataset", store: Path, record: dict[str, Any]) -> None:
    """Lays out the store; or checks that the one there is of this sweep."""
    told = records(store) / "job.json"
    if told.exists():
        _compare(json.loads(told.read_text()), record, store)
        if _is_laid_out(result, store):
            return
    chunked = {name: [c[0] for c in array.chunks] for name, array in result.data_vars.items() if array.chunks}
    encoding = {name: {"chunks": tuple(sizes)} for name, sizes in chunked.items()}
    layout = result.copy()
    layout.attrs = {**result.attrs, "spincyl_sweep": json.dumps(result.attrs["spincyl_sweep"])}
    with warnings.catch_warnings():
        # that other readers may pass over the consolidated metadata: they then read those of each array
        warnings.filterwarnings("ignore", "Consolidated metadata")
        layout.to_zarr(_folder(store), mode="w", compute=False, encoding=encoding, consolidated=True)
    # the record comes last: without it the layout is made anew
    with replaced(told) as part:
        part.write_text(json.dumps(record, indent=1))


def _is_laid_out(result: "xarray.Dataset", store: Path) -> bool:
    """Whether every array of the result has its place in the store."""
    import zarr

    try:
        group = zarr.open_group(_folder(store), mode="r", use_consolidated=False)
        there = {name: array.shape for name, array in group.arrays()}
        return there == {name: array.shape for name, array in result.variables.items()}
    except (OSError, ValueError, KeyError):
        return False


def _todo(store: Path, blocks: list[Block]) -> list[Block]:
    """The blocks that are not done; a warning if some of them were."""
    for torn in store.rglob("*.partial"):  # zarr's, of a writer that was killed
        torn.unlink(missing_ok=True)
    todo = [block for block in blocks if not _is_done(store, block)]
    if damaged := [block for block in todo if _marker(store, block).exists()]:
        warnings.warn(
            f"{store}: {len(damaged)} of {len(blocks)} blocks are missing or damaged and are computed again",
            stacklevel=3,
        )
        for block in damaged:
            _marker(store, block).unlink()
    return todo


def _compare(there: dict[str, Any], here: dict[str, Any], store: Path) -> None:
    """ValueError naming the first thing in which two records differ."""
    there, here = json.loads(json.dumps(there)), json.loads(json.dumps(here))
    pairs = [
        (name, there["job"].get(name), here["job"].get(name)) for name in {**here["job"], **there["job"]}
    ]
    pairs += [(name, there.get(name), here[name]) for name in ("format", "chunks", "blocks")]
    for name, old, new in pairs:
        if old != new:
            raise ValueError(f"{store} is of another sweep: {name} is {old} there, {new} here")


def _marker(store: Path, block: Block) -> Path:
    return records(store) / ("_".join(f"{dim}-{a}" for dim, (a, _) in block.items()) or "all")


def _is_done(store: Path, block: Block) -> bool:
    """Whether the block is recorded and its bytes on disk are those."""
    try:
        return bool(json.loads(_marker(store, block).read_text()) == _checksums(store, block))
    except (OSError, ValueError):
        return False


def _checksums(store: Path, block: Block) -> dict[str, int | None]:
    """The checksum of every chunk file of a block; None where zarr leaves out a chunk of fill values."""
    import zarr

    group = zarr.open_group(_folder(store), mode="r")
    found: dict[str, int | None] = {}
    for name, array in group.arrays():
        dims = getattr(array.metadata, "dimension_names", None) or ()
        if not set(block) & set(dims) or name in dims:
            continue
        # a dimension that is not chunked is one chunk
        place = [block[d][0] // size if d in block else 0 for d, size in zip(dims, array.chunks, strict=True)]
        key = array.metadata.encode_chunk_key(tuple(place))
        file = store / name / key
        found[name] = zlib.crc32(file.read_bytes()) if file.exists() else None
    return found


def _write(
    *arrays: np.ndarray,
    path: str,
    sizes: dict[str, tuple[int, int]],
    variables: list[tuple[str, tuple[str, ...]]],
) -> np.ndarray:
    """A computed block to its place, and then the word that it is there.

    The first arrays say which block it is, one along each dimension.
    """
    import xarray

    store, block = Path(path), {}
    for number, (dim, (size, length)) in zip(arrays, sizes.items(), strict=False):
        first = int(number.flat[0]) * size
        block[dim] = first, min(first + size, length)
    found = arrays[len(sizes) :]
    data = xarray.Dataset({name: (dims, x) for (name, dims), x in zip(variables, found, strict=True)})
    try:
        if block:
            data.to_zarr(_folder(store), region=_slices(block), consolidated=False, safe_chunks=False)
        else:
            data.to_zarr(_folder(store), mode="r+", consolidated=False)
        with replaced(_marker(store, block)) as part:
            part.write_text(json.dumps(_checksums(store, block)))
    except OSError as e:
        raise OSError(e.errno, f"{e.strerror or e}; the sweep can go on from what is written", path) from e
    return np.ones((1,) * len(sizes), np.uint8)


def _slices(block: Block) -> dict[str, slice]:
    return {dim: slice(*ends) for dim, ends in block.items()}
