"""The number of threads for a computation."""

import os
import threading

import numpy as np

try:
    import resource
except ImportError:  # not on Windows
    resource = None  # type: ignore[assignment]

_FIRST_PROCESS = os.getpid()


def has_large_stack() -> bool:
    """Whether the calling thread has a stack of some MiB: the main one, with the usual limit."""
    # in a forked child the main thread is a copy of any thread of the parent, perhaps one with a small stack
    if (
        resource is None
        or os.getpid() != _FIRST_PROCESS
        or threading.current_thread() is not threading.main_thread()
    ):
        return False
    limit: int = resource.getrlimit(resource.RLIMIT_STACK)[0]
    return limit == resource.RLIM_INFINITY or limit >= 4 << 20


def thread_count(threads: int | None) -> int:
    """The number of threads: as given, else RAYON_NUM_THREADS, else every core this process may use."""
    if threads is None:
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        asked = os.environ.get("RAYON_NUM_THREADS", "") or "0"
        if not (asked.isascii() and asked.isdigit() and int(asked[:9]) <= 4096):
            raise ValueError(f"RAYON_NUM_THREADS = {asked!r}: expected 1 to 4096, or 0 for every core")
        threads = int(asked) or cores
    if isinstance(threads, bool) or not isinstance(threads, int | np.integer):
        raise TypeError(f"threads: expected a whole number, not {type(threads).__name__}")
    if not 1 <= threads <= 4096:
        raise ValueError(f"threads = {threads!r}: expected 1 to 4096")
    return int(threads)
