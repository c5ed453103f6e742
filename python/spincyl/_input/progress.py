"""Progress of long computations: a tqdm bar on a terminal or in a notebook, or a function of the caller."""

import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeAlias

Progress: TypeAlias = Callable[[float], object]

_SECONDS_BEFORE_BAR = 2.0  # seconds before a bar is shown
_FORMAT = "{desc}: {percentage:3.0f}%|{bar}| {elapsed}<{remaining}"
_shows_bars = True  # False while something else tells how far the work is


class _Bar:
    """A progress bar that appears on standard error when the work takes longer than a few seconds."""

    def __init__(self, what: str, patience: float) -> None:
        self._what, self._patience, self._begun = what, patience, time.monotonic()
        self._bar: Any = None

    def __call__(self, share: float) -> None:
        lasts = time.monotonic() - self._begun
        if self._bar is None and share < 1 and lasts >= self._patience:
            with warnings.catch_warnings():  # in a notebook without ipywidgets tqdm warns, and writes text
                warnings.simplefilter("ignore")
                from tqdm.auto import tqdm

            how: dict[str, Any] = {"desc": f"spincyl {self._what}", "bar_format": _FORMAT, "leave": False}
            # not drawn before it knows since when
            self._bar = tqdm(total=1.0, file=sys.stderr, miniters=0, delay=1e-9, **how)
            self._bar.start_t -= lasts
            self._bar.n = share
            self._bar.refresh()
        elif self._bar is not None:
            self._bar.update(share - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()


@contextmanager
def reporting_progress(
    progress: Progress | bool | None, what: str, *, by_default: bool = True
) -> Iterator[Progress | None]:
    """Context with the function that a computation calls with its finished share, 0 to 1, or with None.

    `progress` is a function, or True for a bar at once, or False for none. By default a bar is shown after
    two seconds if somebody can see it.
    """
    global _shows_bars
    if progress is not None and not isinstance(progress, bool):
        if not callable(progress):
            kind = type(progress).__name__
            raise TypeError(f"progress: expected a function, True or False, not {kind}")
        yield progress
        return
    if (
        not (progress or (progress is None and by_default and _shows_bars and _has_spectator()))
        or not _has_tqdm()
    ):
        yield None
        return
    bar = _Bar(what, 0.0 if progress else _SECONDS_BEFORE_BAR)
    with without_bars():
        try:
            yield bar
        finally:
            bar.close()


@contextmanager
def without_bars() -> Iterator[None]:
    """Context in which a computation shows no progress bar unless `progress` is true."""
    global _shows_bars
    before, _shows_bars = _shows_bars, False
    try:
        yield
    finally:
        _shows_bars = before


def _has_spectator() -> bool:
    """Whether this thread writes to a terminal or into a notebook."""
    if threading.current_thread() is not threading.main_thread():
        return False
    if sys.stderr is not None and not sys.stderr.closed and sys.stderr.isatty():
        return True
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return getattr(shell, "kernel", None) is not None


def _has_tqdm() -> bool:
    from importlib.util import find_spec

    return find_spec("tqdm") is not None
