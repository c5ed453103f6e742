"""Save a lazy sweep block by block, so that it can resume after a kill at any moment."""

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
from urllib.parse import quote
from uuid import uuid4

import numpy as np

from spincyl._input.files import writing_whole
from spincyl._input.numbers import optional_library
from spincyl._input.progress import Progress, reporting_progress
from spincyl.sweep import _records
from spincyl.sweep._records import Record, Store, checksum, naming

if TYPE_CHECKING:
    import xarray


def _zarr(folder: str | os.PathLike[str]) -> Any:
    """The store for zarr and xarray, which would interpret a plain path such as `~` or `a::b`."""
    from zarr.storage import LocalStore

    return LocalStore(os.fspath(folder))


def save(
    result: "xarray.Dataset", path: str | os.PathLike[str], *, progress: Progress | bool | None = None
) -> "xarray.Dataset":
    """Compute a lazy sweep and write it to a zarr store, block by block; resume an interrupted save.

    Parameters
    ----------
    result : xarray.Dataset
        Result of `portrait`, `roll` or `flicks` for inputs backed by dask. Each block of dask becomes one
        block on disk. Coordinates are saved, too (see `inputs`); drop the coordinates that you do not need.
    path : path
        Directory for the store: a new one, or one that an earlier call began for the same sweep. A second
        directory, named `path` with ".sweep" at its end, has a mark for each completed block.
    progress : callable or bool, optional
        Function that is called with the finished share of the blocks, 0 to 1, after each pass. Default: if
        tqdm is installed, a bar on a terminal or in a notebook when the work takes more than two seconds.
        True: a bar at once; False: none.

    Returns
    -------
    xarray.Dataset
        The stored result, opened with xarray; its arrays are read from the store when they are used.

    Raises
    ------
    TypeError
        If `result` is not a lazy result of this module. A result in memory needs no `save`:
        ``result.to_zarr(path)`` writes it.
    ValueError
        If the store at `path` or its ".sweep" directory belongs to another sweep, or to another version of
        spincyl; the message names the first difference. If all records in the store are damaged. If `path`
        does not end with a name (for example ".").
    OSError
        If a file cannot be written; the message has the path. Completed blocks stay valid, and a later call
        resumes the save. BlockingIOError if another process or thread is saving to the store at the same
        time; FileExistsError if `path` has files that this function has not written: also an array of that
        name without the record of this sweep, or the metadata of a group of your own.

    Warns
    -----
    UserWarning
        If completed blocks, coordinates or metadata are missing or damaged; there is one warning, and they
        are computed again. The warning names the attributes of this sweep that had another value. If files
        cannot be locked; two processes could then save to one store unnoticed.

    Notes
    -----
    Any scheduler of dask can compute the blocks, also a distributed one. The arrays of a block are written
    first, then its checksum; with the checksum the block is complete. A block that is written again has the
    same bytes. So a kill costs at most the blocks that were being computed. Each array in a store has a
    record that identifies the sweep. A store can be copied, moved and renamed; to resume the save, keep its
    ".sweep" directory with it. This function overwrites only files that it has written; other files in the
    store stay. Arrays and attributes that you add to a store, with xarray or zarr, stay as well.

    Examples
    --------
    >>> import tempfile
    >>> import dask.array as da
    >>> import spincyl as sc
    >>> lazy = sc.sweep.portrait(0.8, da.linspace(0.5, 3, 1000, chunks=250), want="region")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     stored = sc.sweep.save(lazy, folder + "/map.zarr").load()
    >>> stored["region"].dims, stored["region"].size
    (('ell',), 1000)
    """
    xr = optional_library("xarray", "sweep")
    optional_library("dask", "sweep"), optional_library("zarr", "sweep")
    lazy = "expected a lazy Dataset of spincyl.sweep, computed from inputs backed by dask"
    if not isinstance(result, xr.Dataset) or not result.data_vars:
        raise TypeError(f"result: {lazy}")
    if all(variable.chunks is None for variable in result.data_vars.values()):
        back = "; sweep.inputs gives back its arguments" if "start_w3" in result.coords else ""
        raise TypeError(f"result: {lazy}; this one is in memory, so save it with result.to_zarr(path){back}")
    if not isinstance(result.attrs.get("spincyl_sweep"), dict):
        raise TypeError(f"result: {lazy}")
    with reporting_progress(progress, "save") as told:
        store = _stored(result, path, told)
    opened: xarray.Dataset = xr.open_zarr(_zarr(store.folder))
    opened.encoding["source"] = os.fspath(store.folder)
    return opened


def _stored(result: "xarray.Dataset", path: str | os.PathLike[str], progress: Progress | None) -> Any:
    """Compute the blocks that the store at `path` lacks, and return this `Store`."""
    dask = optional_library("dask", "sweep")
    store = _records.place(path)
    record = _record(result)
    blocks = list(_blocks(_chunks(result)))
    with naming(store):
        begun = _records.same(store, record) is not None
        _records.beside(store, record)
        lost = begun and not store.marks.exists()
        store.marks.mkdir(exist_ok=True)
    with _alone(store):
        with naming(store):
            record, wrong = _begin(result, store, record)
            todo = _todo(store, blocks, record, wrong, lost)
        written = _written(result, store, record)
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
    return store


def _pass(ask: Any) -> int:
    """Number of blocks in one request to dask: eight for each thread that computes them."""
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
def _alone(store: Store) -> Iterator[None]:
    """Context in which no other process or thread saves to the store; the lock ends with the process."""
    with naming(store):
        lock = (store.marks / "lock").open("ab")
    with lock as file:
        try:
            _lock(file.fileno(), True)
        except OSError as e:
            if e.errno in (errno.EACCES, errno.EAGAIN, errno.EWOULDBLOCK):
                said = "another process or thread is saving to it"
                raise BlockingIOError(errno.EWOULDBLOCK, said, store.said) from None
            said = f"{store.said}: the store cannot be locked ({e.strerror}); let only one process save to it"
            warnings.warn(said, stacklevel=4)
            yield
            return
        try:
            yield
        finally:
            _lock(file.fileno(), False)  # releases the lock also if a forked child has inherited the file


Block = dict[str, tuple[int, int]]
Chunks = dict[str, tuple[int, int]]


def _chunks(result: "xarray.Dataset") -> Chunks:
    """For each chunked dimension: length of a block (the last may be shorter) and of the dimension."""
    chunks = {}
    for dim, sizes in result.chunksizes.items():
        if len(set(sizes[:-1])) > 1 or (len(sizes) > 1 and sizes[-1] > sizes[0]):
            raise ValueError(
                f"result: expected blocks of one size along {dim}, not {list(sizes)}; use result.chunk"
            )
        chunks[str(dim)] = int(sizes[0]), int(sum(sizes))
    return chunks


def _blocks(chunks: Chunks) -> Iterator[Block]:
    """The begin and end of each block along every chunked dimension."""
    edges = [
        [(a, min(a + size, length)) for a in range(0, max(length, 1), max(size, 1))]
        for size, length in chunks.values()
    ]
    for ends in product(*edges):
        yield dict(zip(chunks, ends, strict=True))


def _written(result: "xarray.Dataset", store: Store, record: Record) -> Any:
    """A lazy array with one number for each block; computing the number writes the block.

    Only this number returns to the caller. All blocks are in one graph of dask, since building a graph for
    each block would take the client longer than a worker needs for the block.
    """
    array = optional_library("dask.array", "sweep")
    chunks, arguments = record["chunks"], list[Any]()
    for dim, (size, length) in chunks.items():
        arguments += [array.arange(max(1, -(-length // max(1, size))), chunks=1), (dim,)]
    for name, dims in record["columns"].items():
        arguments += [array.asarray(result[name].data), dims]
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
        store=store,
        chunks=chunks,
        columns=record["columns"],
        sweep=_records.digest(record),
    )


def _key(written: Any, block: Block, chunks: Chunks) -> tuple[Any, ...]:
    """The key of a block of `_written` in dask's graph."""
    return written.name, *(_number(block, dim, chunks) for dim in chunks)


def _number(block: Block, dim: str, chunks: Chunks) -> int:
    """Index of a block along a dimension; 0 along one that is not chunked."""
    return block[dim][0] // max(1, chunks[dim][0]) if dim in block else 0


def _record(result: "xarray.Dataset") -> Record:
    """The description of a sweep, which is written to disk and compared later."""
    chunks = _chunks(result)
    record = {
        "job": result.attrs["spincyl_sweep"],
        "format": 3,
        "chunks": chunks,
        "variables": {
            str(name): [*map(str, x.dims), *x.shape, str(x.dtype)] for name, x in result.variables.items()
        },
        "columns": {
            str(name): list(map(str, x.dims))
            for name, x in result.variables.items()
            if (name in result.data_vars or x.chunks) and (not chunks or set(chunks) & set(x.dims))
        },
    }
    found: Record = json.loads(json.dumps(record))
    return found


def _begin(result: "xarray.Dataset", store: Store, record: Record) -> tuple[Record, list[str]]:
    """Write the layout of the store, or repair it. Returns the record and what is damaged, in words.

    An existing layout stays, even if another version of zarr would write a different one. But if a damaged
    file cannot be restored byte for byte, the layout is written anew, and the marks of blocks no longer
    count. Attributes and arrays that a user has added are no damage.
    """
    _records.beside(store, record)
    there, said = _records.same(store, record), list[str]()
    wrong = [] if there is None else _records.damaged(store, there)
    if there is None or wrong:
        files = _layout(result, record)
        foreign = _records.in_the_way(store, there or record, files)
        if foreign is not None:
            why = f"{foreign} is not of this sweep, and save overwrites only what it has written"
            raise FileExistsError(errno.EEXIST, f"{why}; use another path, or move it away", store.said)
        sums = {name: zlib.crc32(raw) for name, raw in files.items()}
        known = {} if there is None else there["layout"]
        raws = {name: _records.read(store.folder / name) for name in wrong if name in files}
        wrong = [name for name in wrong if not (name in files and _records.says(raws[name], files[name]))]
        lost = [f"{name} of {at}" for at in raws for name in _records.changed(raws[at], files[at])]
        if there is None or any(known[name] != sums.get(name) for name in wrong if name in known):
            there = record | {"layout": sums}
        else:
            files = {name: raw for name, raw in files.items() if name in wrong}
        if wrong:
            count = len(record["variables"]) + len(there["layout"])
            what = f"{len(wrong)} of {count} files of metadata, coordinates and records"
            said.append(f"{what} are missing or damaged and are made again")
        if lost:
            said.append(f"changed attributes are restored: {', '.join(lost[:3])}{', ...' * (len(lost) > 3)}")
        _records.lay_out(store, there, files)
    _records.settle(store, there)
    return there, said


def _layout(result: "xarray.Dataset", record: Record) -> dict[str, bytes]:
    """The files of a store without its blocks: metadata, and coordinates that are not lazy."""
    import zarr
    from zarr.storage import MemoryStore

    array = optional_library("dask.array", "sweep")
    chunks, columns = record["chunks"], record["columns"]
    layout = result.drop_vars(columns).load()
    for name in columns:
        # one block that is never computed: a graph with the real blocks would take long to build
        x = result[name]
        layout[name] = x.dims, array.zeros(x.shape, dtype=x.dtype, chunks=-1), x.attrs
        layout[name].encoding["chunks"] = tuple(chunks.get(d, (n,))[0] for d, n in x.sizes.items())
    layout = layout.set_coords(list(result.coords))
    layout.attrs = {**result.attrs, "spincyl_sweep": json.dumps(result.attrs["spincyl_sweep"])}
    made: dict[str, Any] = {}
    with warnings.catch_warnings(), zarr.config.set({"array.write_empty_chunks": True}):
        # readers that ignore the consolidated metadata read those of each array
        warnings.filterwarnings("ignore", "Consolidated metadata")
        how: dict[str, Any] = {"consolidated": True, "zarr_format": 3, "safe_chunks": False}
        layout[list(result.variables)].to_zarr(MemoryStore(made), compute=False, **how)
    # the metadata of the whole store come last: a store that has them is completely laid out
    names = sorted(made, key=lambda name: (name == "zarr.json", name))
    return {name: made[name].to_bytes() for name in names}


def _todo(store: Store, blocks: list[Block], record: Record, wrong: list[str], lost: bool) -> list[Block]:
    """The blocks that are not done; warns if some of them were done before, or if files were damaged."""
    _records.sweep_up(store, record)
    sweep = _records.digest(record)
    # A thread of a call that failed may still write its last block: a mark that appears later is no damage.
    marked = [_marker(store, block).exists() for block in blocks]
    done = [_is_done(store, block, record, sweep) for block in blocks]
    todo = [block for block, is_done in zip(blocks, done, strict=True) if not is_done]
    damaged = sum(was and not is_done for was, is_done in zip(marked, done, strict=True))
    said = wrong if damaged or len(todo) < len(blocks) else []
    if damaged:
        said.append(f"{damaged} of {len(blocks)} blocks are missing or damaged and are computed again")
    if lost:
        said.append(f"{store.marks.name} is gone, and all {len(blocks)} blocks are computed again")
    if said:
        warnings.warn(f"{store.said}: {'; '.join(said)}", stacklevel=3)
    return todo


def _marker(store: Store, block: Block) -> Path:
    """The file that marks a block as done, with a name valid for any names of dimensions."""
    return store.marks / ("_".join(f"{quote(dim, safe='')}-{a}" for dim, (a, _) in block.items()) or "all")


def _is_done(store: Store, block: Block, record: Record, sweep: str) -> bool:
    """Whether the block is marked as done and its bytes on disk have the checksums of the mark."""
    try:
        told = _marker(store, block).read_bytes()
        return told == _mark(store, block, record["chunks"], record["columns"], sweep)
    except OSError:
        return False


def _own(columns: dict[str, list[str]], block: Block) -> dict[str, list[str]]:
    """The columns whose chunk this block writes; if several blocks share a chunk, the first one writes it."""
    return {
        name: dims
        for name, dims in columns.items()
        if all(first == 0 or dim in dims for dim, (first, _) in block.items())
    }


def _mark(store: Store, block: Block, chunks: Chunks, columns: dict[str, list[str]], sweep: str) -> bytes:
    """The mark of a completed block: a checksum for each chunk, None where zarr omits fill values."""
    found: dict[str, int | None] = {}
    for name, dims in _own(columns, block).items():
        at = (str(_number(block, dim, chunks)) for dim in dims)
        found[name] = checksum(store.folder.joinpath(name, "c", *at))
    return _records.mark(sweep, found)


def _write(
    *arrays: np.ndarray, store: Store, chunks: Chunks, columns: dict[str, list[str]], sweep: str
) -> np.ndarray:
    """Write a computed block, and then the mark that it is complete.

    The first of `arrays` are the indices of the block, one for each chunked dimension, and then results.
    """
    import zarr

    block: Block = {}
    for number, (dim, (size, length)) in zip(arrays, chunks.items(), strict=False):
        first = int(number.flat[0]) * size
        block[dim] = first, min(first + size, length)
    try:
        computed = dict(zip(columns, arrays[len(chunks) :], strict=True))
        for name, dims in _own(columns, block).items():
            array = zarr.open_array(_zarr(store.folder), path=name, mode="r+", zarr_format=3)
            array[tuple(slice(*block[dim]) if dim in block else slice(None) for dim in dims)] = computed[name]
        with writing_whole(_marker(store, block)) as part:
            part.write_bytes(_mark(store, block, chunks, columns, sweep))
    except OSError as e:
        why = f"{e.strerror or e}; a later call of save resumes from the blocks that are written"
        raise OSError(e.errno, why, store.said) from e
    return np.ones((1,) * len(chunks), np.uint8)
