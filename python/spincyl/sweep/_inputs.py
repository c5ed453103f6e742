"""The inputs of a sweep as coordinates of its result, and bodies, states and laws made of them again."""

from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl import _core
from spincyl._body import Body
from spincyl._circles import CIRCLE_COLUMNS, FIELDS, columns_of_circles
from spincyl._contact import AnyContact, Coulomb, Viscous
from spincyl._input.numbers import Floats, Reals, components, floats, instance_of, optional_library
from spincyl._loss import LAWS, Loss, Sum, marked_as_si
from spincyl._restitution import restitution_from_words
from spincyl._scale import Scale
from spincyl._state import State
from spincyl._table import Table
from spincyl.loss import KINDS

if TYPE_CHECKING:
    import xarray

    from spincyl._ellipsoid import Ellipsoid
    from spincyl._ellipsoid_state import EllipsoidState

_W = ("w1", "w2", "w3")
_MOMENTS = ("i1", "i3")
_AXES = _core.stone_names()  # of a stone: semi-axes, inertia, offset, theta_end
_NORMAL = ("n1", "n2", "n3")
#: The coordinates of all inputs, with their units; in the units of a stone, a replaces R.
_UNITS = (
    dict(zip((f"body_{name}" for name in FIELDS), ("R", "M R^2", "M R^2", "1", "R", "rad"), strict=True))
    | dict.fromkeys((f"body_{name}" for names in CIRCLE_COLUMNS for name in names), "R")
    | dict(zip((f"body_{name}" for name in _AXES[:-1]), ["R"] * 3 + ["M R^2"] * 6 + ["R"] * 3, strict=True))
    | {f"start_{name}": "sqrt(g/R)" for name in _W}
    | {f"start_{name}": "1" for name in _NORMAL}
    | {f"start_slip_{way}": "sqrt(g R)" for way in ("along", "across", "x", "y")}
    | {"start_theta": "rad", "start_height": "R", "start_lift": "sqrt(g R)"}
    | {"contact_mu": "1", "contact_static": "1", "contact_patch": "R", "contact_c": "1/sqrt(g R)"}
    | {"table_slope": "rad", "table_phi0": "rad"}
    | {f"loss_{name}": row.natural for name, row in LAWS.items()}
)


def kept_bodies(bodies: Body, states: State, losses: Loss | None) -> dict[str, Reals]:
    """The fields of bodies, states and losses, by the names of the coordinates that a result has for them.

    The moments of a tube follow from its bore and are left out, unless the bores are lazy and may be NaN.
    """
    tube = not hasattr(bodies.bore, "chunks") or bodies.bore.chunks is None
    tube = tube and not np.isnan(np.asarray(bodies.bore)).any()
    found = {f"body_{name}": getattr(bodies, name) for name in FIELDS if not (tube and name in _MOMENTS)}
    found |= {f"body_{name}": x for name, x in columns_of_circles(bodies).items()}
    found |= {f"start_{name}": getattr(states, name) for name in ("theta", *_W)}
    if states.slip is not None:
        found |= zip(("start_slip_along", "start_slip_across"), states.slip, strict=True)
    if states.height is not None:
        found |= {"start_height": states.height, "start_lift": states.lift}
    if losses is not None and losses._function is None:
        found |= {f"loss_{law._parameter}": law.coefficient for law in losses.laws}
    return found


def kept_stones(stones: "Ellipsoid", states: "EllipsoidState") -> dict[str, Reals]:
    """The numbers of stones and their states, by the names of the coordinates that a result has for them."""
    found = dict(zip((f"body_{name}" for name in _AXES), stones._columns(), strict=True))
    found |= zip((f"start_{name}" for name in _NORMAL), components(states.vertical), strict=True)
    found |= zip((f"start_{name}" for name in _W), components(states.w), strict=True)
    if states.slip is not None:
        found |= zip(("start_slip_x", "start_slip_y"), components(states.slip), strict=True)
    if states.height is not None:
        found |= zip(("start_height", "start_lift"), states._aloft, strict=True)
    return found


def kept_contact(contact: AnyContact) -> dict[str, Reals]:
    """The coefficients of friction, by the names of the coordinates that a result has for them."""
    if isinstance(contact, Viscous):
        return {"contact_c": contact.c}
    if not isinstance(contact, Coulomb) or contact._function is not None:
        return {}
    own = {} if contact.static is contact.mu else {"contact_static": contact.static}
    return {"contact_mu": contact.mu, **own, "contact_patch": contact.patch}


def checked_table(table: Table | None) -> Table | None:
    """Return a table on which many motions can be computed, or an error that names it."""
    if table is not None and instance_of("table", table, Table).turning != 0:
        raise ValueError(f"table = {table!r}: only sc.roll takes a table that turns")
    return table


def kept_table(table: Table | None) -> dict[str, Reals]:
    """`slope` and `phi0` of a table, by the names of the coordinates that a result has for them."""
    return {} if table is None else {"table_slope": table.slope, "table_phi0": table.phi0}


def with_inputs(result: "xarray.Dataset", named: dict[str, Any], length: str) -> "xarray.Dataset":
    """The result with these inputs as coordinates, each along the dimensions along which it varies.

    Single numbers that are NaN are left out. A lazy input gets the blocks of the result.
    """
    cut = result.chunksizes
    coords: dict[str, Any] = {}
    for name, given in named.items():
        if given.chunks is None:
            dims, data = _varying(given.dims, floats(given.data))
        else:
            dims, data = given.dims, given.data.astype(np.float64).rechunk([cut[d] for d in given.dims])
        if dims or data == data:
            coords[name] = dims, data, {"units": _UNITS[name].replace("R", length)}
    # inputs taken from an earlier sweep bring its coordinates with them
    brought = [name for name in result.coords if name in _UNITS]
    return (result.drop_vars(brought) if brought else result).assign_coords(coords)


def plain_inputs(
    named: dict[str, Reals], shape: tuple[int, ...], dims: list[str], length: str
) -> dict[str, Any]:
    """The coordinates of `with_inputs` for arrays without names, which broadcast to `shape`."""
    lib: Any = optional_library("xarray", "sweep")
    found: dict[str, Any] = {}
    for name, given in named.items():
        data = floats(given)
        first = len(shape) - data.ndim
        once = tuple(i for i in range(data.ndim) if data.shape[i] == 1 < shape[first + i])
        along = tuple(dims[first + i] for i in range(data.ndim) if i not in once)
        along, data = _varying(along, data.squeeze(once))
        if along or data == data:
            units = {"units": _UNITS[name].replace("R", length)}
            found[name] = lib.Variable(along, np.asarray(data), units, fastpath=True)
    return found


def _varying(dims: tuple[Any, ...], data: Floats) -> tuple[tuple[Any, ...], Floats]:
    """Dimensions and numbers without those dimensions along which all numbers have the same bits."""
    for dim in dims:
        bits = (np.moveaxis(data, dims.index(dim), 0) if data.ndim > 1 else data).view(np.int64)
        if len(bits) > 1 and (bits[0] == bits[-1]).all() and (bits == bits[:1]).all():
            dims, data = tuple(d for d in dims if d != dim), np.take(data, 0, dims.index(dim))
    return dims, data


def inputs(rows: "xarray.Dataset") -> dict[str, Any]:
    """Rebuild the arguments of a sweep from its result, or from some rows of the result.

    Parameters
    ----------
    rows : xarray.Dataset
        Result of `roll` or `flicks`, in memory or opened from a store; or some of its rows, selected for
        example by ``isel``.

    Returns
    -------
    dict
        Keyword arguments of `roll`: "bodies", "states", "t", "contact" and "tol"; also "losses",
        "restitution", "mu", "step", "beyond", "stop_at", "max_nfev", "errors" and "table" if they were given.
        A call of `roll` with these arguments repeats the results bit by bit. Lazy coordinates give lazy
        bodies and states; call ``rows.load()`` first to get bodies and states in memory.

    Raises
    ------
    TypeError, ValueError
        If `rows` is not a Dataset, or lacks the coordinates or attributes of a sweep, or is the result of a
        law of your own, which it does not contain. If `rows` is a single row whose body is invalid; the
        message names the number. (A state with NaN is returned with NaN.)

    Notes
    -----
    The arguments are stored in the coordinates ``body_*``, ``start_*``, ``contact_*`` and ``loss_*``. The
    names end with the names of the fields of `Body`, `State`, `Coulomb`, `Viscous` and the laws of
    `spincyl.loss`; for an `Ellipsoid` they end with a1 (semi-axis), i11 and i23 (inertia),
    d1 (offset) and so on. These coordinates are in
    natural units, also for measured bodies.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> body = sc.Body.solid(np.linspace(0.9, 3, 1000))
    >>> found = sc.sweep.roll(body, body.steady(1.3).kicked(0.05), 20.0, want=("final", "end"))
    >>> row = found.isel(motion=999)
    >>> given = sc.sweep.inputs(row)
    >>> given["bodies"]
    Body.solid(3.0)
    >>> bool(sc.sweep.roll(**given)["w3"] == row["w3"])
    True
    """
    instance_of("rows", rows, optional_library("xarray", "sweep").Dataset)
    at, stones = rows.attrs, "body_a1" in rows.coords
    missing = [name for name in ("start_w3", "body_a1" if stones else "body_ell") if name not in rows.coords]
    missing += [name for name in ("contact", "t", "tol") if name not in at]
    if missing:
        raise ValueError(f"rows: expected a result of sweep.roll, but {missing[0]!r} is missing")
    for name in ("contact", "losses"):
        if str(at.get(name, "")).startswith("custom."):
            raise ValueError(f"rows: a saved result cannot contain a law of your own: {name} = {at[name]}")
    given: dict[str, Any] = {name: _input(rows[name]) for name in _UNITS if name in rows.coords}
    scale = Scale(*(at[name] for name in ("radius", "mass", "gravity"))) if "radius" in at else None
    known: Any = True if scale is None else scale
    found = _stones(given, scale) if stones else _body_and_start(given, scale)
    found |= {"t": rows["t"].to_numpy() if "t" in rows.coords else at["t"], "tol": at["tol"]}
    found |= {name: at[name] for name in ("mu", "step", "stop_at", "max_nfev") if name in at}
    found |= {"restitution": restitution_from_words(at)} if "restitution" in at else {}
    found |= {name: bool(at[name]) for name in ("beyond", "errors") if name in at}
    if "contact_c" in given:
        found["contact"] = Viscous(given["contact_c"])._known(known)
    elif "contact_mu" in given:
        mu, static, patch = (given.get(f"contact_{name}") for name in ("mu", "static", "patch"))
        found["contact"] = Coulomb(mu, static, patch, at.get("face", "ring"))._known(known)
    else:
        found["contact"] = at["contact"]
    if "table_slope" in given:
        found["table"] = Table(given["table_slope"], phi0=given["table_phi0"])
    options: Any = {"delta": {"while_slipping": bool(at.get("while_slipping", True))}}
    laws = [
        marked_as_si(law(given[f"loss_{name}"], **options.get(name, {})), known)
        for name, law in KINDS.items()
        if f"loss_{name}" in given
    ]
    return found | ({"losses": Sum(laws) if len(laws) > 1 else laws[0]} if laws else {})


def _input(array: Any) -> Any:
    """Return an array without dimensions as a number, any other with no coordinates but its dimensions."""
    return float(array) if array.ndim == 0 else array.reset_coords(drop=True)


def _body_and_start(given: dict[str, Any], scale: Scale | None) -> dict[str, Any]:
    several = [[f"body_{name}" for name in names] for names in CIRCLE_COLUMNS if f"body_{names[0]}" in given]
    if several:
        columns = np.broadcast_arrays(*(np.asarray(given[name]) for names in several for name in names))
        rims = np.stack(columns, -1).reshape(*columns[0].shape, len(several), 3)
        body = Body(np.nan, *(np.asarray(given[f"body_{name}"]) for name in _MOMENTS), scale=scale, rims=rims)
    else:
        body = Body(*(given.get(f"body_{name}", np.nan) for name in FIELDS), scale=scale)
    slip = tuple(given[f"start_slip_{way}"] for way in ("along", "across") if f"start_slip_{way}" in given)
    more = {name: given.get(f"start_{name}") for name in ("height", "lift")}
    state = State(*(given[f"start_{name}"] for name in ("theta", *_W)), slip=slip or None, **more)
    return {"bodies": body, "states": state}


def _stones(given: dict[str, Any], scale: Scale | None) -> dict[str, Any]:
    from spincyl._ellipsoid import Ellipsoid
    from spincyl._ellipsoid_rows import SIX
    from spincyl._ellipsoid_state import EllipsoidState

    # broadcast by name, since stones and their states have no named dimensions
    names = [f"body_{name}" for name in _AXES] + [f"start_{name}" for name in (*_NORMAL, *_W)]
    more = [("start_slip_x", "start_slip_y"), ("start_height", "start_lift")]
    slips, flies = (of[0] in given for of in more)
    names += [name for of, there in zip(more, (slips, flies), strict=True) if there for name in of]
    lib: Any = optional_library("xarray", "sweep")
    arrays = lib.broadcast(*(lib.DataArray(given.get(name, np.nan)) for name in names))
    columns: list[Floats] = [array.data for array in arrays]
    inertia: list[Any] = [[None] * 3 for _ in range(3)]
    for (i, j), x in zip(SIX, columns[3:9], strict=True):
        inertia[i][j] = inertia[j][i] = x
    tensor = np.stack([np.stack(row, axis=-1) for row in inertia], axis=-2)
    axes, offset, n, w = (np.stack(columns[i : i + 3], axis=-1) for i in (0, 9, 13, 16))
    slip = np.stack(columns[19:21], axis=-1) if slips else None
    height, lift = columns[-2:] if flies else (None, None)
    stone = Ellipsoid(axes, tensor, offset, columns[12], scale=scale, _doubted=True)
    return {"bodies": stone, "states": EllipsoidState(n, w, slip, height=height, lift=lift)}
