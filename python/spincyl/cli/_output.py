"""Where results go: refused before the work if they cannot; and how far long work is."""

import os
import sys
import tempfile
import threading
import time
from pathlib import Path
from types import TracebackType
from typing import Self


def writable(path: str | Path) -> Path:
    """The path of a file that can be written, or OSError naming it; nothing is left behind."""
    path = Path(path)
    if path.exists():
        if path.is_dir() or not os.access(path, os.W_OK):
            path.open("ab").close()  # says why
        return path
    _try(Path(os.path.realpath(path)).parent, path)  # where a link leads
    return path


def folder(path: str | Path) -> Path:
    """A folder, made if need be, in which files can be written, or OSError naming it."""
    path = Path(path)
    path.mkdir(parents=True, exist_ok=True)
    _try(path, path)
    return path


def _try(place: Path, asked: Path) -> None:
    try:
        tempfile.TemporaryFile(dir=place).close()
    except OSError as e:
        raise OSError(e.errno, e.strerror, str(asked)) from None


class Working:
    """A line on a terminal that says how long work has taken and, where it is known, how much is done.

    Called with the share that is done. Nothing is shown in the first second, nor where stderr is no terminal.
    """

    def __init__(self, what: str) -> None:
        self.what = what
        self.share = 0.0
        self._done = threading.Event()
        self._thread: threading.Thread | None = None

    def __call__(self, share: float) -> None:
        self.share = share

    def __enter__(self) -> Self:
        if sys.stderr is not None and sys.stderr.isatty():
            self._thread = threading.Thread(target=self._show, daemon=True)
            self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
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
