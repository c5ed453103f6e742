"""Dense maps of the steady states."""

import math
from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._input.numbers import (
    Floats,
    Reals,
    common_shape,
    floats,
    in_columns,
    is_scalar,
    known_words,
    optional_library,
    radians,
    reals,
)
from spincyl._input.progress import Progress, reporting_progress
from spincyl._input.threads import thread_count
from spincyl._laws import Region
from spincyl.sweep._common import apart, cells, in_si, is_lazy, many_blocks, signature, target, targets

if TYPE_CHECKING:
    import xarray

DType: TypeAlias = Literal["float64", "float32"]

_LONG_NAMES = {
    "rate": "reduced rotation rate",
    "kappa_rolling": "squared nutation frequency, rolling",
    "kappa_smooth": "squared nutation frequency, smooth table",
    "energy": "energy",
    "region": "code of spincyl.Region",
}
# in the order of the compiled function
_UNITS = {"rate": "1", "kappa_rolling": "g/R", "kappa_smooth": "g/R", "energy": "M g R", "region": "1"}
_AXES = {"theta": "rad", "ell": "R", "bore": "1", "fillet": "R"}
_DEFAULT = ("rate", "kappa_rolling", "kappa_smooth", "region")


def portrait(
    theta: Reals,
    ell: Reals | Body,
    bore: Reals = 0.0,
    fillet: Reals = 0.0,
    *,
    want: str | Iterable[str] = _DEFAULT,
    out: "xarray.Dataset | None" = None,
    dtype: DType = "float64",
    threads: int | None = None,
    progress: Progress | bool | None = None,
) -> "xarray.Dataset":
    """Compute the steady states with the centre at rest, for every inclination and every tube.

    Parameters
    ----------
    theta : float or array_like, 1-D
        Inclinations, in radians.
    ell, bore, fillet : float or array_like, 1-D
        Uniform tubes, as in `Body.tube`: half length, inner radius and fillet, each over the outer radius.
        `ell` may also be a `Body`: one tube, or tubes that differ in one of the three parameters. The map of
        measured tubes is in SI, with lengths in metres. If an axis is backed by dask, the result is lazy:
        nothing is computed before a call of `compute` or `save`.
    want : str or iterable of str
        Quantities to compute: "rate" (see `Body.rate`), "kappa_rolling" and "kappa_smooth" (see
        `Body.stability`), "energy" (see `Body.energy`) and "region" (see `Region`).
    out : xarray.Dataset, optional
        Earlier result on axes of the same lengths, whose arrays are filled again. This makes repeated maps
        faster, since the allocation of new memory takes several times as long as the computation of rates.
    dtype : {"float64", "float32"}
        Type of the numbers. In float32 the rate for a sharp rim has a relative error of at most
        1.51 * 2^-24, and a map of the rate alone takes about 0.6 of the time. Other numbers are computed in
        float64 and then rounded; regions are the same.
    threads : int, optional
        Number of threads. Default: the environment variable RAYON_NUM_THREADS, else every core that this
        process may use; 1 in a block of dask.
    progress : callable or bool, optional
        Function that is called with the finished share, 0 to 1, about fifty times a second. Default: if tqdm
        is installed, a bar on a terminal or in a notebook when the work takes more than two seconds. True: a
        bar at once; False: none.

    Returns
    -------
    xarray.Dataset
        One array per quantity, with its `units`. Each of theta, ell, bore and fillet that was given as an
        array is a dimension. "rate" is the reduced rate; for measured tubes there is also "hertz". Where
        theta or the tube is out of range, numbers are NaN and the region is `Region.INVALID`. In float64 the
        numbers equal those of the methods of `Body` bit by bit, for any number of threads; only the energy
        may differ, by 32 (1 + kappa_c) 2^-53.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid; the message names it.
    KeyboardInterrupt
        Within 0.1 s of Ctrl-C.

    Notes
    -----
    docs/physics.md has the equations, and `Body` the error bound of each quantity.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> found = sc.sweep.portrait(np.linspace(0.1, 1.5, 400), np.linspace(0.5, 3, 300), want="rate")
    >>> found["rate"].dims, found["rate"].shape
    (('theta', 'ell'), (400, 300))
    """
    lib = optional_library("xarray", "sweep")
    body = ell if isinstance(ell, Body) else None
    if body is not None:
        ell, bore, fillet = _tube(body, bore, fillet)
    lazy = is_lazy(theta, ell, bore, fillet)
    axes = {name: _axis_of_map(name, x) for name, x in zip(_AXES, (theta, ell, bore, fillet), strict=True)}
    want = _wanted_of_map(want)
    cell = _cell(dtype)
    kinds: dict[str, Any] = {"want": want, "cell": cell}
    dims = [name for name, x in axes.items() if x.ndim]
    if lazy:
        if out is not None:
            raise ValueError("out: expected None for dask-backed inputs; a lazy result has no arrays to fill")
        labelled = [lib.DataArray(x, dims=_dims(name, x)) for name, x in axes.items()]
        cores = 1 if threads is None else thread_count(threads)
        with many_blocks(), reporting_progress(progress, "map", by_default=False) as told:
            found = lib.apply_ufunc(
                partial(_block_of_map, threads=cores, progress=told, **kinds),
                *labelled,
                output_core_dims=[[]] * len(want),
                dask="parallelized",
                output_dtypes=[np.uint8 if name == "region" else cell for name in want],
            )
        arrays = dict(zip(want, [found] if len(want) == 1 else found, strict=True))
        data = {name: array.transpose(*dims) for name, array in arrays.items()}
    else:
        shape = tuple(x.size for x in axes.values())
        given = targets(out, want)
        kinds |= {"threads": thread_count(threads), "shape": shape, "given": given}
        with reporting_progress(progress, "map") as told:
            filled = _grid(*axes.values(), progress=told, **kinds)
        inner = tuple(x.size for x in axes.values() if x.ndim)
        data = {name: (dims, x.reshape(inner)) for name, x in zip(want, filled, strict=True)}
    result: xarray.Dataset = lib.Dataset(
        data, coords={name: (_dims(name, x), x, {"units": _AXES[name]}) for name, x in axes.items()}
    )
    for name in want:
        result[name].attrs = {"units": _UNITS[name], "long_name": _LONG_NAMES[name]}
    if lazy:
        result.attrs["spincyl_sweep"] = signature("portrait", dict(axes), want=want, dtype=dtype)
    if body is None or body.scale is None:
        return result
    if "rate" in want:
        critical = np.asarray(body.critical_hertz)
        along = [name for name in dims if np.ndim(critical) and name != "theta"]
        result["hertz"] = result["rate"] * lib.DataArray(critical, dims=along)
        result["hertz"].attrs = {"units": "Hz", "long_name": "turns per second"}
    measured: xarray.Dataset = in_si(result, body.scale)
    return measured


def points(
    theta: Reals,
    ell: Reals,
    bore: Reals = 0.0,
    fillet: Reals = 0.0,
    *,
    want: str | Iterable[str] = ("rate",),
    out: dict[str, np.ndarray] | None = None,
    dtype: DType = "float64",
    threads: int | None = None,
    progress: Progress | bool | None = None,
) -> dict[str, np.ndarray]:
    """Compute the quantities of `portrait` at single points: for each point one inclination and one tube.

    Parameters
    ----------
    theta, ell, bore, fillet : float or array_like
        Inclinations and tubes as in `portrait`; their shapes have to broadcast. Numbers, and contiguous
        arrays of float64 that have the same shape, are not copied.
    want, dtype, threads, progress
        As in `portrait`.
    out : dict of str to ndarray, optional
        Contiguous arrays to fill; this is much faster than new arrays (see `portrait`).

    Returns
    -------
    dict of str to ndarray
        An array of the broadcast shape for each quantity. The numbers equal those of `portrait` bit by bit.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid; the message names it.
    KeyboardInterrupt
        Within 0.1 s of Ctrl-C.

    Examples
    --------
    >>> import spincyl as sc
    >>> sc.sweep.points([0.4, 1.0, 0.4], [1.0, 1.0, 2.0])["rate"].round(4)
    array([1.4116, 1.302 , 0.4133])
    """
    want = _wanted_of_map(want)
    cell = _cell(dtype)
    given = [floats(reals(name, x)) for name, x in zip(_AXES, (theta, ell, bore, fillet), strict=True)]
    common_shape(dict(zip(_AXES, given, strict=True)))
    many = given[0].reshape(-1)
    radians("theta", many[:: max(1, many.size // 10_000)] if given[0].ndim else theta)
    shape = np.broadcast_shapes(*(x.shape for x in given))
    into = targets(out, want)
    arrays = {name: target(name, shape, np.uint8 if name == "region" else cell, into[name]) for name in want}
    flat = dict(zip(_AXES, in_columns(given, shape), strict=True))
    apart(arrays, flat)
    with reporting_progress(progress, "map") as told:
        _core.portrait(flat, _flat(arrays), True, thread_count(threads), told)
    return arrays


def survey(
    theta: Reals,
    ell: Reals,
    bore: Reals = 0.0,
    fillet: Reals = 0.0,
    *,
    want: str | Iterable[str] = ("region",),
    threads: int | None = None,
    progress: Progress | bool | None = None,
) -> dict[str, Any]:
    """Compute counts, areas and extrema of a `portrait` on these axes without storing the map.

    Parameters
    ----------
    theta, ell, bore, fillet : float or array_like, 1-D
        As in `portrait`, but not a `Body`; theta ascending.
    want : str or iterable of str
        "region" gives the number of points and the share of the area of each `Region`. "rate",
        "kappa_rolling", "kappa_smooth" and "energy" give the least and the greatest value and where they are.
    threads, progress
        As in `portrait`.

    Returns
    -------
    dict
        For "region" two entries: "count", {Region: number of points}, and "area", {Region: share of the area
        of the map}. A point stands for the area of its cell, by the trapezoid rule along axes of two or more
        points. For each other quantity {"min": (value, {axis: place}), "max": (value, {axis: place})}, or
        None if no point has a steady state.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid; the message names it.
    KeyboardInterrupt
        Within 0.1 s of Ctrl-C.

    Notes
    -----
    Regions change only at theta0, thetaInf and the zeros of both kappas. Only points near these inclinations
    are evaluated; they are found by bisection for sharp tubes, and computed for rounded tubes. Extrema need
    no memory for the map. If only the rate is wanted, groups of sixteen inclinations that cannot contain an
    extremum are skipped.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> found = sc.sweep.survey(np.linspace(0.01, 1.57, 2000), np.linspace(0.1, 3, 1000))
    >>> round(found["area"][sc.Region.FORBIDDEN], 3)
    0.251
    """
    axes = {name: _axis_of_map(name, x) for name, x in zip(_AXES, (theta, ell, bore, fillet), strict=True)}
    asked = _wanted_of_map(want)
    if not (np.diff(axes["theta"].ravel()) >= 0).all():
        raise ValueError("theta: expected ascending inclinations")
    columns = _grid_of_tubes(axes["theta"], axes["ell"], axes["bore"], axes["fillet"])
    found: dict[str, Any] = {}
    cores = thread_count(threads)
    if "region" in asked:
        weights = cells(columns["theta"])
        each = _core.areas(columns | {"weights": weights}, cores).reshape(-1, 2, 8)
        shares = [cells(axes[name].ravel()) for name in ("ell", "bore", "fillet")]
        across = np.multiply.outer(np.multiply.outer(shares[0], shares[1]), shares[2]).ravel()
        with np.errstate(invalid="ignore"):  # axes that are not finite have no area: NaN without a warning
            counts, areas = each[:, 0].sum(0), across @ each[:, 1]
        total = areas.sum()
        found["count"] = {region: int(counts[region]) for region in Region}
        found["area"] = {region: float(areas[region] / total) if total else math.nan for region in Region}
    names = list(_UNITS)[:4]
    wanted = [name in asked for name in names]
    if any(wanted):
        with reporting_progress(progress, "survey") as told:
            ends = _core.extrema(columns, wanted, cores, told)
        for name, end in zip(names, ends, strict=True):
            if name in asked:
                found[name] = None if end is None else _ends(name, end, axes)
    return found


def boundaries(ell: Reals, bore: Reals = 0.0, fillet: Reals = 0.0) -> "xarray.Dataset":
    """Compute the curves that separate the regions of the map: inclinations for each tube.

    Parameters
    ----------
    ell, bore, fillet : float or array_like, 1-D
        As in `portrait`, but not a `Body`.

    Returns
    -------
    xarray.Dataset
        Inclinations in radians: "theta_balance" (theta0), "theta_limit" (thetaInf), "rolling" and "smooth"
        (zeros of kappa: changes of stability), "fold" and "ridge" (extrema of rate and energy). The last four
        have a dimension "root" of length 3 (5 for rounded rims); entries after the last root are NaN.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid; the message names it.

    Examples
    --------
    >>> import spincyl as sc
    >>> found = sc.sweep.boundaries([0.5, 1.0, 2.0])
    >>> found["theta_balance"].values.round(4)
    array([1.1071, 0.7854, 0.4636])
    """
    lib = optional_library("xarray", "sweep")
    axes = {name: _axis_of_map(name, x) for name, x in (("ell", ell), ("bore", bore), ("fillet", fillet))}
    named = [lib.DataArray(x, dims=_dims(name, x)) for name, x in axes.items()]
    body = Body.tube(*named) if any(x.ndim for x in axes.values()) else Body.tube(*map(float, axes.values()))
    laws = {"theta_balance": _core.theta_balance, "theta_limit": _core.theta_limit}
    threes = {
        "rolling": _core.boundary_rolling,
        "smooth": _core.boundary_smooth,
        "fold": _core.fold,
        "ridge": _core.ridge,
    }
    root = lib.DataArray(np.arange(float(body._most)), dims="root")
    data = {name: law(*body._numbers) for name, law in laws.items()}
    data |= {name: law(*body._numbers, root) for name, law in threes.items()}
    coords = {name: (_dims(name, x), x, {"units": _AXES[name]}) for name, x in axes.items()}
    result: xarray.Dataset = lib.Dataset(data, coords=coords)
    for name in data:
        result[name].attrs["units"] = "rad"
    return result


def _grid(
    theta: Floats,
    ell: Floats,
    bore: Floats,
    fillet: Floats,
    *,
    want: tuple[str, ...],
    cell: np.dtype[Any],
    threads: int,
    progress: Progress | None,
    shape: tuple[int, ...],
    given: dict[str, Any],
) -> list[np.ndarray]:
    """Compute the wanted arrays of a map, of this shape. Each axis varies along at most one dimension."""
    arrays = {name: target(name, shape, np.uint8 if name == "region" else cell, given[name]) for name in want}
    columns = _grid_of_tubes(theta, np.ravel(ell), np.ravel(bore), np.ravel(fillet))
    apart(arrays, columns)
    _core.portrait(columns, _flat(arrays), False, threads, progress)
    return list(arrays.values())


def _block_of_map(*axes: Floats, want: tuple[str, ...], **kinds: Any) -> Any:
    """Compute one block of a lazy map; dask calls this function."""
    shape = np.broadcast_shapes(*(np.shape(x) for x in axes))
    found = _grid(*axes, want=want, shape=shape, given=dict.fromkeys(want), **kinds)
    return found[0] if len(found) == 1 else tuple(found)


def _flat(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The arrays of a map, flattened, since the compiled function fills flat arrays."""
    return {name: array.reshape(-1) for name, array in arrays.items()}


def _grid_of_tubes(theta: Floats, ell: Floats, bore: Floats, fillet: Floats) -> dict[str, Floats]:
    """The inclinations of a map and the flattened grid of its tubes, by name of the axis."""
    tubes = np.meshgrid(ell, bore, fillet, indexing="ij")
    return dict(zip(_AXES, (floats(x).reshape(-1) for x in (theta, *tubes)), strict=True))


def _ends(name: str, ends: list[tuple[float, int, int]], axes: dict[str, Floats]) -> dict[str, Any]:
    """The least and the greatest value of a map, and the coordinates of each."""
    told = {}
    for end, (value, row, body) in zip(("min", "max"), ends, strict=True):
        ell, rest = divmod(body, axes["bore"].size * axes["fillet"].size)
        bore, fillet = divmod(rest, axes["fillet"].size)
        place = {"theta": row, "ell": ell, "bore": bore, "fillet": fillet}
        where = {axis: float(x.ravel()[place[axis]]) for axis, x in axes.items()}
        if name == "rate":
            value = float(Body.tube(where["ell"], where["bore"], where["fillet"]).rate(where["theta"]))
        told[end] = (value, where)
    return told


def _tube(body: Body, bore: Reals, fillet: Reals) -> tuple[Reals, Reals, Reals]:
    """Half length, bore and fillet of tubes; an error if bore or fillet is given as well."""
    if not (is_scalar(bore, fillet) and bore == 0.0 == fillet):
        raise TypeError("bore, fillet: leave them out if ell is a Body, which has its own")
    found = body.ell + body.fillet if np.any(body.fillet != 0) else body.ell, body.bore, body.fillet
    if np.isnan(body.bore).any():
        raise ValueError("ell: expected a tube from sc.measured or Body.tube; a general body has no bore")
    if sum(not is_scalar(x) for x in found) > 1:
        raise ValueError("ell: expected tubes that differ in only one of ell, bore and fillet")
    return found


def _wanted_of_map(want: str | Iterable[str]) -> tuple[str, ...]:
    return known_words("want", want, tuple(_UNITS))


def _cell(dtype: Any) -> np.dtype[Any]:
    try:
        kind: np.dtype[Any] = np.dtype(dtype)
    except (TypeError, ValueError):
        kind = np.dtype(object)
    if kind not in (np.dtype(np.float64), np.dtype(np.float32)):
        raise ValueError(f"dtype = {dtype!r}: expected 'float64' or 'float32'")
    return kind


def _dims(name: str, axis: Any) -> tuple[str, ...]:
    """The dimension of an axis; none if the axis is a number."""
    return (name,) if axis.ndim else ()


def _axis_of_map(name: str, value: Reals) -> Any:
    kept = reals(name, value)
    if name == "theta":
        radians(name, kept)
    if is_lazy(kept):
        data: Any = getattr(kept, "data", kept)
        axis = (data if hasattr(data, "dask") else kept).astype(np.float64)
    else:
        axis = floats(kept)
    if axis.ndim > 1:
        raise ValueError(f"{name}: expected a number or a one-dimensional array, not shape {axis.shape}")
    return axis
