"""Files that are whole: each is made beside its place, and takes it when it is done.

What was there stays until then, whatever fails or is killed. Every file of the package is written so.
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


@contextmanager
def replaced(path: str | os.PathLike[str]) -> Iterator[Path]:
    """An empty file to write to, which takes the place of `path` at the end, or is removed if anything fails.

    Its name is absolute and ends in the suffix of `path` in small letters: what is given to a program or a
    library is nothing but a file. A new file has the permissions that `open` gives it, a later one those and
    the owner of the file before it; links are followed. A device, a pipe, and a file whose folder or owner
    forbids that it be replaced are written to in place when all is made.

    Raises
    ------
    OSError
        Where `open` raises one, and where the writing does; with the path that was given.
    """
    path = Path(path)
    there = _there(path)
    target = _target(path, there)
    folder = Path(gettempdir()) if target is None else target.parent
    part = folder / f".spincyl-{uuid4().hex}.part{path.suffix.lower()}"
    try:
        with open(part, "xb", opener=partial(os.open, mode=0o666 if there is None else 0o600)) as made:
            yield part
            os.fsync(made.fileno())
        if target is None or not _moved(part, target, there):
            with path.open("wb") as sink, part.open("rb") as source:
                shutil.copyfileobj(source, sink)
    except OSError as e:
        raise _of(path, part, e) from None
    finally:
        with suppress(OSError):
            part.unlink()


def _there(path: Path) -> os.stat_result | None:
    """What there is, if it can be written to."""
    try:
        there = path.stat()
    except FileNotFoundError:
        return None
    if not S_ISFIFO(there.st_mode):  # whose reader would take this for all there is
        path.open("ab").close()
    return there


def _target(path: Path, there: os.stat_result | None) -> Path | None:
    """The file that can be replaced, behind all links; None if there is none."""
    target = Path(os.path.realpath(path))
    if there is None:
        return target
    replaceable = S_ISREG(there.st_mode) and os.access(target.parent, os.W_OK | os.X_OK)
    return target if replaceable and not _is_open(path) else None


def _is_open(path: Path) -> bool:
    """Whether it leads to what a process has open, as /dev/stdout does: there a new file would not be it."""
    while path.is_symlink():
        folder = Path(os.path.realpath(path.parent))
        if folder.parts[:2] == ("/", "proc"):
            return True
        path = folder / path.readlink()
    return False


def _moved(part: Path, target: Path, there: os.stat_result | None) -> bool:
    """Whether the part is now the target; where there was a file, with its owner and permissions."""
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


def _of(path: Path, part: Path, error: OSError) -> OSError:
    """An error of the part as one of the path."""
    if error.errno is None:
        return OSError(f"{path}: {str(error).replace(str(part), str(path))}")
    if error.filename not in (None, part, str(part)):
        return error
    return OSError(error.errno, error.strerror, str(path))
