"""Helpers of all sweeps: blocks of dask arrays, arrays to fill, units."""

import math
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from importlib.metadata import version
from typing import Any

import numpy as np

from spincyl._input.numbers import Floats
from spincyl._scale import Scale, si_factor

#: Text before the hash of an array, or of another input, in the record of a sweep.
CONTENT = "content "


def is_lazy(*values: object) -> bool:
    """Whether any of the values is backed by dask."""
    return any(hasattr(v, "dask") or getattr(v, "chunks", None) is not None for v in values)


def in_memory(name: str, law: object, fields: Mapping[str, object]) -> None:
    """Raise TypeError for a law that the user wrote, with arrays that are not in memory."""
    if getattr(law, "_function", None) is not None and is_lazy(*fields.values()):
        why = "for arrays in memory, since nothing shows whether a saved sweep had the same law"
        raise TypeError(f"{name} = {law!r}: a law of your own is only {why}")


@contextmanager
def many_blocks() -> Iterator[None]:
    """Context that silences dask's warning about many blocks, which are usual for maps."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Increasing number of chunks")
        yield


def targets(out: Any, want: Iterable[str]) -> dict[str, Any]:
    """The arrays to fill, by name; None for those to be allocated. An error names a wrong entry."""
    if out is None:
        return dict.fromkeys(want)
    if not isinstance(out, Mapping):
        raise TypeError(f"out: expected an earlier result of this function, not {type(out).__name__}")
    for name in want:
        if name not in out:
            there = f"out has only {list(out)}" if out else "out is empty"
            raise ValueError(f"out: expected an array named {name!r}, which want= contains; {there}")
        if not hasattr(out[name], "__array__"):
            raise TypeError(f"out[{name!r}]: expected an array to fill, not {type(out[name]).__name__}")
    return {name: out[name] for name in want}


def apart(arrays: Mapping[str, np.ndarray], read: Mapping[str, np.ndarray]) -> None:
    """Raise ValueError for results that share memory with each other or with their inputs."""
    names = list(arrays)
    for i, name in enumerate(names):
        others = {f"out[{other!r}]": arrays[other] for other in names[:i]} | dict(read)
        for other, array in others.items():
            if np.may_share_memory(arrays[name], array):  # both contiguous
                raise ValueError(f"out[{name!r}]: shares its memory with {other}")


def target(name: str, shape: tuple[int, ...], dtype: Any, given: Any) -> np.ndarray:
    """A contiguous array for a result: a new one, or the given one if it fits."""
    dtype = np.dtype(dtype)
    if given is None:
        return np.empty(shape, dtype)
    array: np.ndarray = given if isinstance(given, np.ndarray) else given.to_numpy()
    if array.size != math.prod(shape) or array.dtype != dtype or not array.flags.carray:
        lies = "" if array.flags.carray else ", read-only or not contiguous and aligned"
        wanted = f"a contiguous array of {math.prod(shape)} numbers {dtype}"
        raise ValueError(f"out[{name!r}]: expected {wanted}, not {array.shape} {array.dtype}{lies}")
    return array.reshape(shape)


def in_si(found: Any, scale: Scale | None) -> Any:
    """Convert the variables of a Dataset from natural units to the SI of measured bodies."""
    if scale is None:
        return found
    for name, array in found.variables.items():
        factor, attrs = to_si(str(name), array.attrs, scale)
        if factor is not None:
            found[name] = (array.dims, array.data * factor, attrs)
    found.attrs |= sizes(scale)
    return found


def to_si(name: str, attrs: dict[str, Any], scale: Scale | None) -> tuple[float | None, dict[str, Any]]:
    """The factor that converts a variable to SI (None: no conversion), and its attributes afterwards."""
    factor, said = si_factor(attrs.get("units", "1"), scale)
    factor = scale._worst if scale is not None and name == "error" else factor
    return (None, attrs) if factor is None else (factor, attrs | {"units": said})


def sizes(scale: Scale) -> dict[str, float]:
    """The scale of measured bodies as a dict of attributes for a result."""
    return {"radius": scale.radius, "mass": scale.mass, "gravity": scale.gravity}


def signature(job: str, inputs: dict[str, object], **parameters: object) -> dict[str, str]:
    """Inputs that determine the numbers of a lazy result: `save` resumes only a sweep with equal inputs."""
    from dask.base import tokenize

    told = {"spincyl": version("spincyl"), "job": job}
    told |= {name: repr(value) for name, value in parameters.items()}
    return told | {name: f"{CONTENT}{tokenize(value)}" for name, value in inputs.items()}


def cells(axis: Floats) -> Floats:
    """Weight of each point of an axis by the trapezoid rule; 1 for a single point."""
    if axis.size < 2:
        return np.ones(axis.size)
    steps = np.abs(np.diff(axis))
    return np.concatenate([[steps[0] / 2], (steps[1:] + steps[:-1]) / 2, [steps[-1] / 2]])
