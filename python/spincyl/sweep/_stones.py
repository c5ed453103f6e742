"""Many stones at once: how they end, and which of them turn back."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl import _core
from spincyl._contact import AnyContact, Coulomb, Viscous, code, fitting, named, table
from spincyl._ellipsoid import Ellipsoid
from spincyl._ellipsoid_state import EllipsoidState
from spincyl._ending import ErrorWarning
from spincyl._input.numbers import Reals, extra, floats, made, number, warn, within, words
from spincyl._input.threads import Progress, callback, thread_count
from spincyl._measured import natural_time
from spincyl.sweep._common import in_si
from spincyl.sweep._labels import Status, flags, given_up

if TYPE_CHECKING:
    import xarray

#: The names of the state at the end, and what else there is: unit and meaning.
_FINAL = {
    **{f"n{i}": ("1", f"vertical along axis {i} at the end") for i in (1, 2, 3)},
    **{f"w{i}": ("sqrt(g/a)", f"angular velocity along axis {i} at the end") for i in (1, 2, 3)},
}
_TOLD = {
    "spin": ("sqrt(g/a)", "angular velocity about the vertical at the end"),
    "reversals": ("1", "how often the spin has turned back"),
    "first_reversal": ("sqrt(a/g)", "time at which the spin first turned back"),
    "end": ("sqrt(a/g)", "time of the end"),
    "dissipated": ("M g a", "heat of friction"),
    "error": ("1", "estimated error of the worst number of the state"),
    "known_until": ("sqrt(a/g)", "time up to which the motion is known"),
}


def roll(
    stones: Ellipsoid,
    states: Any,
    t: Reals,
    *,
    want: str | Iterable[str] | None,
    contact: AnyContact,
    tol: float,
    mu: float,
    threads: int | None,
    progress: Progress | None,
) -> "xarray.Dataset":
    """What `spincyl.sweep.roll` does with stones."""
    lib: Any = extra("xarray", "sweep")
    states = made("states", states, EllipsoidState)
    scale = stones.scale
    if scale is not None:
        fitting(contact, scale)
        t = natural_time("t", t, scale)
    end = within("t", number("t", t), 0.0, 1e15, "sqrt(a/g), from 0 on")
    wanted = words(
        "want", ("spin", "reversals", "first_reversal") if want is None else want, ("final", *_TOLD)
    )
    rubs = isinstance(contact, Coulomb | Viscous)
    if not rubs:
        code(contact, rubs=True)
    if not rubs and states._slips:
        raise ValueError(f"states: slip, and contact={contact!r} has no law for that: contact=sc.Coulomb(mu)")
    own: dict[str, Any] = {}
    if isinstance(contact, Coulomb | Viscous):
        own = dict(zip(("coefficient", "static"), (floats(x) for x in contact._numbers), strict=True))
        kind = type(contact)(0.0)
    n, w, slip = (np.moveaxis(np.asarray(x), -1, 0) for x in (states.vertical, states.w, states._pair))
    names = (*_core.stone_names(), "n1", "n2", "n3", "w1", "w2", "w3", "slip_x", "slip_y", *own)
    fields = [np.asarray(x, np.float64) for x in (*stones._columns(), *n, *w, *slip, *own.values())]
    try:
        shape = np.broadcast_shapes(*(x.shape for x in fields))
    except ValueError:
        raise ValueError(
            f"bodies, states: shapes do not fit: {stones.shape} and {n.shape[1:]}, {w.shape[1:]}"
        ) from None
    columns = {
        name: np.ascontiguousarray(x if x.size == 1 else np.broadcast_to(x, shape)).reshape(-1)
        for name, x in zip(names, fields, strict=True)
    }
    place, coefficients = table(kind if rubs else contact, number("mu", mu))
    asked = {
        "t0": 0.0,
        "slip": (0.0, 0.0),
        "table": place,
        "coefficients": coefficients,
        "losses": None,
        "step": None,
        "tol": number("tol", tol),
        "beyond": False,
        "restitution": None,
        "pose": False,
        "force": False,
    }
    always = "error", "known_until"
    labels = {name: of for name, of in (_FINAL | _TOLD).items() if name in wanted or name in always}
    # which motions are known to their end depends on that
    more = [] if "end" in labels else ["end"]
    if "final" in wanted:
        labels |= _FINAL
    out: dict[str, np.ndarray] = {name: np.full(shape, np.nan) for name in (*labels, *more)}
    status = np.full(shape, Status.INVALID, np.uint8)
    flat = {name: x.reshape(-1) for name, x in out.items()} | {"status": status.reshape(-1)}
    _core.stones(columns, np.array([end]), asked, flat, thread_count(threads), callback(progress))
    given_up(status)
    lost = int(np.count_nonzero((out["known_until"] < out["end"]) | np.isinf(out["error"])))
    if lost:
        why = "beyond, their estimated errors are too large, and no reversal is counted"
        warn(f"{lost} of {status.size} motions are known only up to known_until: {why}", ErrorWarning)
    dims = ["motion"] if len(shape) == 1 else [f"motion_{i}" for i in range(len(shape))]
    data: dict[str, Any] = {
        name: (dims, x, {"units": labels[name][0], "long_name": labels[name][1]})
        for name, x in out.items()
        if name in labels
    }
    data["status"] = (dims, status, flags(Status))
    attrs = {"contact": named(contact), "t": end if scale is None else float(scale.seconds(end)), "tol": tol}
    if not rubs:
        attrs["mu"] = float(mu)
    result: xarray.Dataset = in_si(lib.Dataset(data, attrs=attrs), scale)
    return result
