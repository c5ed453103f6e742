"""Records in a store, which identify its sweep, and marks of completed blocks in the folder next to it.

A folder without an intact record is not ours, whatever lies next to it: nothing in it is written or deleted.
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

from spincyl._input.files import path_of, replaced
from spincyl.sweep._common import CONTENT

#: Names of the record in each array's folder, where zarr ignores it, and of its copy in the folder of marks.
RECORD, BESIDE = "spincyl.json", "job.json"
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
    """The store at a path, or an error that names the argument."""
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
    """The text of a record's file, with a checksum."""
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
    """The record of this sweep in a store, None in an empty store; ValueError for another sweep's."""
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


def lay_out(store: Store, record: Record, files: dict[str, bytes]) -> None:
    """Write the files whose content differs; records first, so that a kill leaves no folder without one."""
    seal = sealed(record)
    records = {f"{name}/{RECORD}": seal for name in record["variables"]}
    store.folder.mkdir(exist_ok=True)
    for name, raw in (records | files).items():
        file = store.folder / name
        if _bytes(file) != raw:
            file.parent.mkdir(parents=True, exist_ok=True)
            with replaced(file) as part:
                part.write_bytes(raw)


def settle(store: Store, record: Record) -> None:
    """Write the record into the folder of marks if it is missing there."""
    if _bytes(store.marks / BESIDE) != (seal := sealed(record)):
        with replaced(store.marks / BESIDE) as part:
            part.write_bytes(seal)


def damaged(store: Store, record: Record) -> list[str]:
    """The names of files of metadata, coordinates and records whose bytes have changed."""
    seal = zlib.crc32(sealed(record))
    expected = record["layout"] | {f"{name}/{RECORD}": seal for name in record["variables"]}
    return [name for name, sum_ in expected.items() if checksum(store.folder / name) != sum_]


def sweep_up(store: Store) -> None:
    """Remove the unfinished files of writers that were killed."""
    for folder in (store.folder, store.marks):
        for where, _, names in os.walk(folder):
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
    raw = _bytes(file)
    return None if raw is None else zlib.crc32(raw)


def _bytes(file: Path) -> bytes | None:
    with suppress(FileNotFoundError, NotADirectoryError):
        return file.read_bytes()
    return None
