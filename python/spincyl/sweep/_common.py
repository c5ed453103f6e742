"""What the sweeps share: threads, blocks of dask arrays, targets."""

import math
import os
import threading
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from importlib.metadata import version
from typing import Any, TypeAlias

import numpy as np

from spincyl._scale import Scale, si_of

try:
    import resource
except ImportError:  # not on Windows
    resource = None  # type: ignore[assignment]

Progress: TypeAlias = Callable[[float], object]
_BORN = os.getpid()


def is_roomy() -> bool:
    """Whether the calling thread has a stack of some MiB: the main one, with the usual limit."""
    # the main thread of a forked child was any thread of its parent
    if resource is None or os.getpid() != _BORN or threading.current_thread() is not threading.main_thread():
        return False
    limit: int = resource.getrlimit(resource.RLIMIT_STACK)[0]
    return limit == resource.RLIM_INFINITY or limit >= 4 << 20


def thread_count(threads: int | None) -> int:
    """How many threads: as asked, as RAYON_NUM_THREADS says, or every core this process may use."""
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


def callback(progress: Progress | None) -> Progress | None:
    """`progress` if it can be called, or TypeError."""
    if progress is not None and not callable(progress):
        raise TypeError(f"progress: expected something to call, not {type(progress).__name__}")
    return progress


def is_lazy(*values: object) -> bool:
    """Whether any of these is backed by dask."""
    return any(hasattr(v, "dask") or getattr(v, "chunks", None) is not None for v in values)


@contextmanager
def many_blocks() -> Iterator[None]:
    """A map is to have as many blocks as those of its axes multiplied: dask need not warn of it."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Increasing number of chunks")
        yield


def targets(out: Any, want: Iterable[str]) -> dict[str, Any]:
    """By name what is to be filled, None where that is to be made; or an error by name."""
    if out is None:
        return dict.fromkeys(want)
    if not isinstance(out, Mapping):
        raise TypeError(f"out: expected an earlier result, not {type(out).__name__}")
    for name in want:
        if name not in out:
            raise ValueError(f"out: has no {name!r}, which is wanted; there are {list(out)}")
        if not hasattr(out[name], "__array__"):
            raise TypeError(f"out[{name!r}]: expected an array to fill, not {type(out[name]).__name__}")
    return {name: out[name] for name in want}


def apart(arrays: Mapping[str, np.ndarray], read: Mapping[str, np.ndarray]) -> None:
    """Refuse results that would be written over each other, or over what they are made of."""
    names = list(arrays)
    for i, name in enumerate(names):
        others = {f"out[{other!r}]": arrays[other] for other in names[:i]} | dict(read)
        for other, array in others.items():
            if np.may_share_memory(arrays[name], array):  # both contiguous
                raise ValueError(f"out[{name!r}]: shares its memory with {other}")


def target(name: str, shape: tuple[int, ...], dtype: Any, given: Any) -> np.ndarray:
    """A contiguous array for a result: a fresh one, or the given one if it fits."""
    dtype = np.dtype(dtype)
    if given is None:
        return np.empty(shape, dtype)
    array: np.ndarray = given if isinstance(given, np.ndarray) else given.to_numpy()
    if array.size != math.prod(shape) or array.dtype != dtype or not array.flags.carray:
        lies = "" if array.flags.carray else ", read-only or not contiguous and aligned"
        wanted = f"{math.prod(shape)} contiguous {dtype}"
        raise ValueError(f"out[{name!r}]: expected {wanted}, not {array.shape} {array.dtype}{lies}")
    return array.reshape(shape)


def in_si(found: Any, scale: Scale | None) -> Any:
    """A Dataset in natural units as that of measured bodies: what has a natural unit is in SI."""
    if scale is None:
        return found
    for name, array in found.variables.items():
        natural = array.attrs.get("units", "1")
        factor, said = si_of(natural, scale)
        factor = scale._worst if name == "error" else factor
        if factor is not None:
            attrs = array.attrs | {"units": said}
            found[name] = (array.dims, array.data * factor, attrs)
    found.attrs |= {"radius": scale.radius, "mass": scale.mass, "gravity": scale.gravity}
    return found


def signature(job: str, inputs: dict[str, object], **parameters: object) -> dict[str, str]:
    """What decides the numbers of a lazy result: `save` compares it before it goes on with an earlier one."""
    from dask.base import tokenize

    told = {"spincyl": version("spincyl"), "job": job}
    told |= {name: repr(value) for name, value in parameters.items()}
    return told | {name: f"content {tokenize(value)}" for name, value in inputs.items()}
