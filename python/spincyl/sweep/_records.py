"""Records in a store, which identify its sweep, and marks of completed blocks in the folder next to it.

A folder without an intact record is not ours, whatever lies next to it: nothing in it is written or deleted.
In a store, an array is ours only by the record in its own folder; arrays and attributes of a user stay.
"""

import errno
import json
import os
import re
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from hashlib import blake2b
from pathlib import Path
from typing import Any, NamedTuple

from spincyl._input.files import path_of, writing_whole
from spincyl.sweep._common import CONTENT

#: Names of the record in each array's folder, where zarr ignores it, and of its copy in the folder of marks.
RECORD, BESIDE = "spincyl.json", "job.json"
#: Name of zarr's metadata of a group or an array, and of the objects in them to which users may add names.
META, _OPEN = "zarr.json", ("attributes", "metadata")
# files that killed writers leave behind: those of this package, and those of zarr
_LEFT = re.compile(r"\.spincyl-[0-9a-f]{32}\.part.*|.+\.[0-9a-f]{32}\.partial", re.DOTALL)
_MARK = re.compile(rb'\{"sweep": "[0-9a-f]{16}", "chunks": \{[^{}]*\}\}')

Record = dict[str, Any]


class Store(NamedTuple):
    """A folder for a sweep: its path as given, and with all links resolved."""

    said: str
    folder: Path

    @property
    def marks(self) -> Path:
        """The folder next to the store, with a file for each completed block."""
        return self.folder.with_name(f"{self.folder.name}.sweep")


def place(path: str | os.PathLike[str]) -> Store:
    """The folder of a saved sweep at a path, or an error that names the argument."""
    found = path_of("path", path)
    if found.name in ("", ".."):
        raise ValueError(f"path = {os.fspath(path)!r}: expected a folder by its own name, as in 'sweep.zarr'")
    return Store(os.fspath(found), Path(os.path.realpath(found)))


@contextmanager
def naming(store: Store) -> Iterator[None]:
    """Context in which an OSError names the path as given."""
    try:
        yield
    except OSError as e:
        if store.said in str(e):
            raise
        within = f" ({e.filename})" if e.filename else ""
        raise OSError(e.errno, f"{e.strerror or e}{within}", store.said) from e


def sealed(record: Record) -> bytes:
    """Content of the file of a record: the record as text, with a checksum."""
    text = json.dumps(record)
    return json.dumps(record | {"checksum": zlib.crc32(text.encode())}, indent=1).encode()


def _whole(file: Path) -> Record | None:
    """The record in a file; None if there is no file or any byte of it has changed."""
    try:
        raw = file.read_bytes()
        found = json.loads(raw)
        del found["checksum"]
        return found if isinstance(found["job"], dict) and sealed(found) == raw else None
    except (FileNotFoundError, ValueError, TypeError, KeyError, RecursionError):
        return None


def recorded(store: Store) -> list[Record]:
    """The intact records in a store; empty if there is no folder or it is empty.

    Raises
    ------
    FileExistsError
        If the folder has files but no records, or the path is not a folder.
    ValueError
        If all records are damaged.
    """
    if not store.folder.exists():
        return []
    no_sweep = FileExistsError(errno.EEXIST, "exists, but is not a sweep that save began", store.said)
    if not store.folder.is_dir():
        raise no_sweep
    files = sorted(store.folder.glob(f"*/{RECORD}"))
    found = [record for record in map(_whole, files) if record is not None]
    if not found and files:
        torn = ", ".join(str(file.relative_to(store.folder)) for file in files)
        why = f"its records ({torn}) are damaged, and nothing else identifies the sweep"
        raise ValueError(f"{store.said}: {why}; save to another path, or remove this store")
    if not found and any(not _LEFT.fullmatch(name) for *_, names in os.walk(store.folder) for name in names):
        raise no_sweep
    return found


def same(store: Store, record: Record) -> Record | None:
    """The record of this sweep in a store; None for an empty store, ValueError if it has another sweep."""
    found = recorded(store)
    for there in found:
        if _differs(there, record) is None:
            return there
    if found:
        other = f"this store holds another sweep ({_differs(found[0], record)})"
        raise ValueError(f"{store.said}: {other}; use another path, or delete the store")
    return None


def beside(store: Store, record: Record) -> None:
    """Raise an error if the folder of marks is neither empty nor that of this sweep.

    Raises
    ------
    FileExistsError
        If the folder holds anything else.
    ValueError
        If its record belongs to another sweep.
    """
    there = _whole(store.marks / BESIDE)
    if there is not None:
        if (other := _differs(there, record)) is not None:
            holds = f"this folder has the marks of another sweep ({other})"
            raise ValueError(f"{store.marks}: {holds}; use another path, or delete the folder")
        return
    try:
        entries = sorted(os.scandir(store.marks), key=lambda entry: entry.name)
    except FileNotFoundError:
        return
    left = [e for e in entries if not _LEFT.fullmatch(e.name) and not (e.name == "lock" and not _size(e))]
    if left and not any(_is_mark(Path(entry)) for entry in left):
        why = "exists, but holds no records of a sweep; save to another path, or remove this folder"
        raise FileExistsError(errno.EEXIST, why, os.fspath(store.marks))


def _size(entry: "os.DirEntry[str]") -> int:
    return entry.stat().st_size if entry.is_file() else 1


def _is_mark(file: Path) -> bool:
    try:
        return _MARK.fullmatch(file.read_bytes()) is not None
    except OSError:
        return False


def _differs(there: Record, here: Record) -> str | None:
    """The first difference between two records, in words."""
    pairs = [
        (name, there["job"].get(name), here["job"].get(name)) for name in {**here["job"], **there["job"]}
    ]
    pairs += [(name, there.get(name), here[name]) for name in here if name != "job"]
    for name, old, new in pairs:
        if old != new:  # of arrays there are only hashes
            hashes = all(str(x).startswith(CONTENT) for x in (old, new))
            return f"{name} differs" if hashes else f"{name} is {old} there, {new} here"
    return None


def in_the_way(store: Store, record: Record, files: dict[str, bytes]) -> str | None:
    """The name of the first file of another origin that `lay_out` or a block would overwrite.

    A file whose bytes are those that `lay_out` writes may lack its record: overwriting it loses nothing.
    """
    known = record.get("layout", {})
    ours = [name for name in record["variables"] if _is_of(store.folder / name / RECORD, record)]
    for name in record["variables"]:
        if name in ours:
            continue
        laid = _is_laid(store, f"{name}/{META}", files, known)
        for where, _, names in sorted(os.walk(store.folder / name)):
            for file in sorted(names):
                at = Path(where, file).relative_to(store.folder).as_posix()
                if at == f"{name}/{RECORD}" and _whole(store.folder / at) is None:  # damaged
                    continue
                block = laid and name in record["columns"] and at.startswith(f"{name}/c")
                if not (_LEFT.fullmatch(file) or block or _is_laid(store, at, files, known)):
                    return at
    old = next(
        (name for name in (".zgroup", ".zattrs", ".zmetadata") if (store.folder / name).exists()), None
    )
    there = _node(read(store.folder / META))
    if there is None:  # missing or damaged
        return old
    mine = _is_laid(store, META, files, known) or len(ours) == len(record["variables"])
    mine = mine or _is_of(store.marks / BESIDE, record)
    attributes, own = (node.get("attributes") or {} for node in (there, json.loads(files[META])))
    return None if mine or attributes.get("spincyl_sweep") == own.get("spincyl_sweep") else META


def _is_of(file: Path, record: Record) -> bool:
    """Whether a file is an intact record of this sweep."""
    there = _whole(file)
    return there is not None and _differs(there, record) is None


def _is_laid(store: Store, name: str, files: dict[str, bytes], known: dict[str, int]) -> bool:
    """Whether a file has the bytes that `lay_out` writes or once wrote, or these with a user's attributes."""
    raw = read(store.folder / name)
    if raw is None or name not in files:
        return False
    return zlib.crc32(raw) in (known.get(name), zlib.crc32(files[name])) or says(raw, files[name])


def _node(raw: bytes | None) -> dict[str, Any] | None:
    """The metadata of an array or a group; None if they are missing or damaged."""
    try:
        found = json.loads(raw or b"")
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) and found.get("node_type") in ("array", "group") else None


def with_added(there: bytes | None, ours: bytes) -> bytes:
    """Metadata of this sweep, with the attributes and arrays that a user has added to the store."""
    old, new = _node(there), json.loads(ours)
    found = new if old is None else _joined(old, new, open_=False)
    return ours if found == new else json.dumps(found, indent=2).encode()


def says(there: bytes | None, ours: bytes) -> bool:
    """Whether metadata in the store equal this sweep's, apart from a user's own attributes and arrays."""
    old = _node(there)
    return old is not None and _node(ours) is not None and _joined(old, json.loads(ours), open_=False) == old


def changed(there: bytes | None, ours: bytes) -> list[str]:
    """The names of this sweep's attributes whose values in the store are different."""
    old, new = ((_node(raw) or {}).get("attributes") or {} for raw in (there, ours))
    return [name for name, value in new.items() if name in old and old[name] != value]


def _joined(old: Any, new: Any, *, open_: bool) -> Any:
    """`new` with the names that only `old` has, in the objects to which users may add names."""
    if not (isinstance(old, dict) and isinstance(new, dict)):
        return new
    found = {
        name: _joined(old[name], value, open_=name in _OPEN) if name in old else value
        for name, value in new.items()
    }
    return found | {name: value for name, value in old.items() if open_ and name not in new}


def lay_out(store: Store, record: Record, files: dict[str, bytes]) -> None:
    """Write the files whose content differs, records first: a kill then leaves no folder without a record."""
    seal = sealed(record)
    records = {f"{name}/{RECORD}": seal for name in record["variables"]}
    store.folder.mkdir(exist_ok=True)
    for name, raw in (records | files).items():
        file = store.folder / name
        there = read(file)
        raw = with_added(there, raw) if file.name == META else raw
        if there != raw:
            file.parent.mkdir(parents=True, exist_ok=True)
            with writing_whole(file) as part:
                part.write_bytes(raw)


def settle(store: Store, record: Record) -> None:
    """Write the record into the folder of marks if it is missing there."""
    if read(store.marks / BESIDE) != (seal := sealed(record)):
        with writing_whole(store.marks / BESIDE) as part:
            part.write_bytes(seal)


def damaged(store: Store, record: Record) -> list[str]:
    """The names of files of metadata, coordinates and records whose bytes have changed."""
    seal = zlib.crc32(sealed(record))
    expected = record["layout"] | {f"{name}/{RECORD}": seal for name in record["variables"]}
    return [name for name, sum_ in expected.items() if checksum(store.folder / name) != sum_]


def sweep_up(store: Store, record: Record) -> None:
    """Remove the unfinished files of writers that were killed, but none of a user's own arrays."""
    arrays = [store.folder / name for name in record["variables"]]
    whole = [(where, names) for folder in (store.marks, *arrays) for where, _, names in os.walk(folder)]
    for where, names in [*whole, (store.folder, os.listdir(store.folder))]:
        for name in names:
            if _LEFT.fullmatch(name):
                Path(where, name).unlink(missing_ok=True)


def digest(record: Record) -> str:
    """Hash of a sweep and its layout; every mark has it, so that marks of other sweeps do not count."""
    return blake2b(sealed(record), digest_size=8).hexdigest()


def mark(of: str, chunks: dict[str, int | None]) -> bytes:
    """Content of the mark of a completed block: the hash of the sweep, and the checksums of its files."""
    return json.dumps({"sweep": of, "chunks": chunks}).encode()


def checksum(file: Path) -> int | None:
    """The checksum of a file; None if the file is missing."""
    raw = read(file)
    return None if raw is None else zlib.crc32(raw)


def read(file: Path) -> bytes | None:
    """The bytes of a file; None if the file is missing."""
    with suppress(FileNotFoundError, NotADirectoryError):
        return file.read_bytes()
    return None
