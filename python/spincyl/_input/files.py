"""Writing of whole files: a new file is written next to its target, which it replaces only when complete.

Until then the old file stays, even if the program fails or is killed. The package writes all files this way.
"""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from stat import S_ISFIFO, S_ISREG
from tempfile import gettempdir
from uuid import uuid4


def path_of(name: str, value: str | os.PathLike[str]) -> Path:
    """Return the path of a file, or raise an error that names the argument."""
    try:
        found = Path(value)
    except TypeError:
        raise TypeError(f"{name}: expected the path of a file, not {type(value).__name__}") from None
    try:
        with suppress(OSError):  # opening the file will report this
            os.stat(found)
    except ValueError as e:  # a null character, or half of a surrogate pair
        raise ValueError(f"{name} = {str(found)!r}: no file can have this name ({e})") from None
    return found


@contextmanager
def writing_whole(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Context with an empty file to write to, which replaces `path` at the end, or is removed on failure.

    The name of the file is absolute and ends in the suffix of `path` in small letters, so that other programs
    and libraries accept it. A new file gets the permissions that `open` gives; a file that replaces an older
    one keeps its owner and permissions. Links are followed. A device, a pipe, and a file whose folder or
    owner forbids its replacement are written in place at the end.

    Raises
    ------
    OSError
        If `open` or the writing fails; the error has the given path.
    """
    path = Path(path)
    there = _status_of(path)
    target = _target(path, there)
    folder = Path(gettempdir()) if target is None else target.parent
    part = folder / f".spincyl-{uuid4().hex}.part{path.suffix.lower()}"
    try:
        with open(part, "xb", opener=partial(os.open, mode=0o666 if there is None else 0o600)) as made:
            yield part
            os.fsync(made.fileno())
        if target is None or not _move(part, target, there):
            with path.open("wb") as sink, part.open("rb") as source:
                shutil.copyfileobj(source, sink)
    except OSError as e:
        raise _error_about_path(path, part, e) from None
    finally:
        with suppress(OSError):
            part.unlink()


def _status_of(path: Path) -> os.stat_result | None:
    """The status of an existing file, else None; raises OSError if the file is not writable."""
    try:
        there = path.stat()
    except FileNotFoundError:
        return None
    if not S_ISFIFO(there.st_mode):  # the reader of a pipe would take the closing for the end of the data
        path.open("ab").close()
    return there


def _target(path: Path, there: os.stat_result | None) -> Path | None:
    """The file to replace, with all links resolved; None if `path` has to be written in place."""
    target = Path(os.path.realpath(path))
    if there is None:
        return target
    replaceable = S_ISREG(there.st_mode) and os.access(target.parent, os.W_OK | os.X_OK)
    return target if replaceable and not _is_open(path) else None


def _is_open(path: Path) -> bool:
    """Whether the path links to an open file of a process, as /dev/stdout, which cannot be replaced."""
    while path.is_symlink():
        folder = Path(os.path.realpath(path.parent))
        if folder.parts[:2] == ("/", "proc"):
            return True
        path = folder / path.readlink()
    return False


def _move(part: Path, target: Path, there: os.stat_result | None) -> bool:
    """Move the complete file `part` to `target`, keeping an older file's owner and mode. Returns success."""
    try:
        if there is not None:
            made = part.stat()
            if (made.st_uid, made.st_gid) != (there.st_uid, there.st_gid):
                os.chown(part, there.st_uid, there.st_gid)
            part.chmod(there.st_mode & 0o777)
        part.replace(target)
    except OSError:
        return False
    return True


def _error_about_path(path: Path, part: Path, error: OSError) -> OSError:
    """Rewrite an error about the temporary file `part` as one about `path`, which the caller gave."""
    if error.errno is None:
        return OSError(f"{path}: {str(error).replace(str(part), str(path))}")
    if error.filename not in (None, part, str(part)):
        return error
    return OSError(error.errno, error.strerror, str(path))
