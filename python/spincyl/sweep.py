"""Dense maps of the steady states, on all cores."""

import math
import os
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from spincyl import _core
from spincyl._array import Reals, extra, reals

if TYPE_CHECKING:
    import xarray

_LONG_NAMES = {
    "rate": "reduced rotation rate",
    "kappa_rolling": "squared nutation frequency, rolling",
    "kappa_smooth": "squared nutation frequency, smooth table",
    "region": "code of spincyl.Region",
}
_UNITS = {"rate": "1", "kappa_rolling": "g/R", "kappa_smooth": "g/R", "region": "1"}


def portrait(
    theta: Reals,
    ell: Reals,
    bore: Reals = 0.0,
    *,
    want: Iterable[str] = ("rate", "kappa_rolling", "kappa_smooth", "region"),
    out: "xarray.Dataset | None" = None,
    threads: int | None = None,
) -> "xarray.Dataset":
    """Map the steady states with the centre at rest: every inclination against every tube.

    Parameters
    ----------
    theta : array_like, 1-D
        Inclinations in radians.
    ell, bore : array_like, 1-D or a number
        Aspect ratios and bores of uniform tubes. A number makes no dimension.
    want : iterable of str
        Which of "rate", "kappa_rolling", "kappa_smooth" (see `Body.rate`, `Body.stability`) and
        "region" (see `Region`) to compute. What is not asked for costs nothing.
    out : xarray.Dataset, optional
        An earlier result on axes of the same lengths: its arrays are filled again, which saves the
        memory and the time of fresh ones.
    threads : int, optional
        Default: RAYON_NUM_THREADS, else every core.

    Returns
    -------
    xarray.Dataset
        Dimensions theta, ell and bore (as far as they are arrays), `units` in the attributes. NaN
        and `Region.INVALID` where theta or the tube is out of range. The values are those of the
        methods of `Body`, bit by bit, whatever the number of threads.

    Raises
    ------
    TypeError, ValueError
        Naming the argument. KeyboardInterrupt is honoured within a tenth of a second.
    """
    lib = extra("xarray", "sweep")
    axes = {name: _axis(name, x) for name, x in (("theta", theta), ("ell", ell), ("bore", bore))}
    want = tuple(want)
    if unknown := set(want) - set(_UNITS):
        raise ValueError(f"want: no such quantity {sorted(unknown)}; there are {sorted(_UNITS)}")
    shape = tuple(x.size for x in axes.values())
    arrays = {name: _target(name, shape, out) for name in want}
    ells, bores = (
        np.ascontiguousarray(x).ravel() for x in np.meshgrid(axes["ell"], axes["bore"], indexing="ij")
    )
    _core.portrait(
        axes["theta"].ravel(),
        ells,
        bores,
        rate=arrays.get("rate"),
        kappa_rolling=arrays.get("kappa_rolling"),
        kappa_smooth=arrays.get("kappa_smooth"),
        region=arrays.get("region"),
        threads=_threads(threads),
    )
    dims = [name for name, x in axes.items() if x.ndim]
    inner = tuple(x.size for x in axes.values() if x.ndim)
    units = {"theta": "rad", "ell": "R", "bore": "1"}
    data: xarray.Dataset = lib.Dataset(
        {
            name: (dims, array.reshape(inner), {"units": _UNITS[name], "long_name": _LONG_NAMES[name]})
            for name, array in arrays.items()
        },
        coords={name: (_dims(name, x), x, {"units": units[name]}) for name, x in axes.items()},
    )
    return data


def _dims(name: str, axis: np.ndarray) -> tuple[str, ...]:
    """The dimension of an axis: none for a number."""
    return (name,) if axis.ndim else ()


def _target(name: str, shape: tuple[int, ...], out: "xarray.Dataset | None") -> np.ndarray:
    """A flat array for a quantity, fresh or from an earlier result."""
    dtype = np.dtype(np.uint8 if name == "region" else np.float64)
    if out is None:
        return np.empty(math.prod(shape), dtype)
    array = out[name].to_numpy()
    if array.size != math.prod(shape) or array.dtype != dtype or not array.flags.c_contiguous:
        raise ValueError(
            f"out[{name!r}]: expected {math.prod(shape)} contiguous {dtype}, not {array.shape} {array.dtype}"
        )
    return array.reshape(-1)


def _axis(name: str, value: Reals) -> np.ndarray:
    axis = np.ascontiguousarray(reals(name, value), dtype=np.float64)
    axis = axis.reshape(np.shape(value))
    if axis.ndim > 1:
        raise ValueError(f"{name}: expected a number or one dimension, not shape {axis.shape}")
    return axis


def _threads(threads: int | None) -> int:
    if threads is None:
        threads = int(os.environ.get("RAYON_NUM_THREADS", "0")) or os.cpu_count() or 1
    if not 1 <= threads <= 4096:
        raise ValueError(f"threads = {threads!r}: expected 1 to 4096")
    return threads
