"""Output: paths are checked before the work begins, and long work shows its progress."""

import os
import sys
import tempfile
import threading
import time
from pathlib import Path
from types import TracebackType
from typing import Self

from spincyl._input.progress import without_bars


def writable(path: str | Path) -> Path:
    """Return the path if the file can be written, or raise OSError naming it; nothing is created."""
    path = Path(path)
    if path.exists():
        if path.is_dir() or not os.access(path, os.W_OK):
            path.open("ab").close()  # raises the error
        return path
    _try_to_write(Path(os.path.realpath(path)).parent, path)  # the target of a link
    return path


def folder(path: str | Path) -> Path:
    """Return a writable folder, creating it if necessary, or raise OSError naming it."""
    path = Path(path)
    path.mkdir(parents=True, exist_ok=True)
    _try_to_write(path, path)
    return path


def _try_to_write(place: Path, asked: Path) -> None:
    try:
        tempfile.TemporaryFile(dir=place).close()
    except OSError as e:
        raise OSError(e.errno, e.strerror, str(asked)) from None


class Working:
    """A line on a terminal with the time since the beginning and, if known, the share that is done.

    Call the object with the share. Nothing is shown in the first second, or if stderr is not a terminal.
    """

    def __init__(self, what: str) -> None:
        self.what = what
        self.share = 0.0
        self._done = threading.Event()
        self._thread: threading.Thread | None = None
        self._alone = without_bars()

    def __call__(self, share: float) -> None:
        self.share = share

    def __enter__(self) -> Self:
        self._alone.__enter__()
        if sys.stderr is not None and sys.stderr.isatty():
            self._thread = threading.Thread(target=self._show, daemon=True)
            self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._alone.__exit__(kind, error, trace)
        self._done.set()
        if self._thread is not None:
            self._thread.join()

    def _show(self) -> None:
        begun, line = time.monotonic(), ""
        while not self._done.wait(0.25 if line else 1.0):
            share = f"{self.share:.0%}, " if self.share else ""
            line = f"spincyl {self.what}: {share}{time.monotonic() - begun:.0f} s"
            print(f"\r{line}", end="", file=sys.stderr, flush=True)
        if line:
            print(f"\r{' ' * len(line)}\r", end="", file=sys.stderr, flush=True)
