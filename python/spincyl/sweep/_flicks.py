"""Many flicks of a tube: which settle on one rim, which lie down again, and which hop first."""

from enum import IntEnum
from inspect import signature
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._body import Body
from spincyl._contact import AnyContact, Coulomb, Viscous
from spincyl._input.numbers import Reals, floats, instance_of, is_scalar, optional_library, reals
from spincyl._phases import KINDS
from spincyl._single import one_body
from spincyl._throw import flicked
from spincyl.sweep._labels import Status, flags
from spincyl.sweep._roll import roll

if TYPE_CHECKING:
    import xarray


class Outcome(IntEnum):
    """Outcome of a flick of a tube.

    Without ``restitution=`` the motion ends where the other rim lands (`LIES_DOWN`) or where the tube leaves
    the table (`LIFTS_OFF`). With ``restitution=`` the motion continues to the last time, and the outcome says
    how the tube moves at that time.

    Attributes
    ----------
    NONE
        None of the outcomes below; the `status` of the motion gives the reason.
    SETTLES
        At the last time the tube stands on one rim and precesses.
    LIES_DOWN
        The rim that rose has landed again, or no rim rose.
    LIFTS_OFF
        The normal force vanishes. With ``restitution=``: the tube is in the air at the last time.
    HOPS_AND_SETTLES
        The tube hops. At the last time the tube stands on one rim and precesses.
    HOPS_AND_LIES
        The tube hops. At the last time the tube lies on its side.
    """

    NONE = 0
    SETTLES = 1
    LIES_DOWN = 2
    LIFTS_OFF = 3
    HOPS_AND_SETTLES = 4
    HOPS_AND_LIES = 5


_OUTCOMES = np.zeros(len(Status), np.uint8)
_OUTCOMES[[Status.DONE, Status.SIDE, Status.LIFT_OFF]] = (
    Outcome.SETTLES,
    Outcome.LIES_DOWN,
    Outcome.LIFTS_OFF,
)
#: Kinds of the last phase that count as on one rim, and those that count as on the side.
_ON_RIM, _ON_SIDE = KINDS[:2], KINDS[3:]
#: Outcome of a motion with a restitution, by its last phase, without and with a time in the air.
_GOES_ON = np.array(
    [
        [
            Outcome.SETTLES
            if kind in _ON_RIM
            else Outcome.LIES_DOWN
            if kind in _ON_SIDE
            else Outcome.LIFTS_OFF,
            Outcome.HOPS_AND_SETTLES
            if kind in _ON_RIM
            else Outcome.HOPS_AND_LIES
            if kind in _ON_SIDE
            else Outcome.LIFTS_OFF,
        ]
        for kind in KINDS
    ],
    np.uint8,
)


def _outcome(status: Any, last: Any, air_time: Any) -> Any:
    """Outcome of motions with a restitution, by their status, last phase and time in the air."""
    known = np.isfinite(last) & np.isin(status, (Status.DONE, Status.STOPS))
    found = _GOES_ON[np.where(known, last, 0).astype(int), (air_time > 0).astype(int)]
    return np.where(known, found, Outcome.NONE).astype(np.uint8)


def flicks(
    body: Body,
    t: Reals,
    *,
    hertz: Reals = None,
    w1: Reals = None,
    launch: Reals = None,
    spin_hertz: Reals = None,
    centre: Reals = None,
    contact: AnyContact,
    **how: Any,
) -> "xarray.Dataset":
    """Compute the outcomes of many flicks of a tube that lies on its side.

    A flick is a push on one end of the tube. The result contains every combination of the given rates with
    the given launch numbers or spins.

    Parameters
    ----------
    body : Body
        Single body with two rims, as for `spincyl.flicked`. For a measured body all numbers are in SI.
    t : float
        Time at which the motions end, in sqrt(R/g); for a measured body in seconds. In 200 sqrt(R/g), which
        is 5.7 s for the tube below, a tube has lain down, lifted off, or rolled for the first time.
    hertz, w1, launch, spin_hertz, centre : array_like, 1-D, or float
        Arguments of `spincyl.flicked`. Give `hertz` or `w1`, and `launch` or `spin_hertz`; `centre` is
        optional. Each array becomes a dimension of the result with the name of the argument; the dimension
        of `w1` is named "precession".
    contact : Coulomb or Viscous
        Law of friction. Its coefficients are numbers or labelled arrays (of xarray).
    **how
        Other keyword arguments of `roll`. The default of `want` is ("end", "rolling_time") here. With
        ``restitution=`` each motion continues to `t`, also while the tube hops or lies on both rims.

    Returns
    -------
    xarray.Dataset
        The result of `roll`, and "outcome" with the codes of `Outcome`, which `plot.flicks` draws. A tube
        that settles may slip for a moment in every nod. "rolling_time" is then the time at which the last
        phase of rolling begins; with ``stop_at="rolling"`` it is the time at which the first one begins.

    Raises
    ------
    ValueError, TypeError
        If an argument is invalid; the message names it.

    Examples
    --------
    >>> import spincyl as sc
    >>> tube = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm")
    >>> found = sc.sweep.flicks(tube, 5.7, hertz=[10, 20], launch=[1.2, 1.3, 3.0], contact=sc.Coulomb(0.3))
    >>> found["outcome"].dims, found["outcome"].values.tolist()
    (('hertz', 'launch'), [[2, 2, 3], [1, 1, 3]])
    """
    lib = optional_library("xarray", "sweep")
    body = one_body(body)
    if not isinstance(contact, Coulomb | Viscous):
        instance_of("contact", contact, Coulomb)
    given = {"w1": w1, "hertz": hertz, "launch": launch, "spin_hertz": spin_hertz, "centre": centre}
    axes = {name: x for name, x in given.items() if x is not None}
    start = flicked(body, **{name: _axis_of_flicks(lib, name, x) for name, x in axes.items()})
    for word in how.keys() - signature(roll).parameters.keys():
        raise TypeError(f"flicks() got an unexpected keyword argument {word!r}")
    how = {"want": ("end", "rolling_time")} | how
    on = how.get("restitution") is not None
    if on:
        named = [how["want"]] if isinstance(how["want"], str) else list(how["want"])
        how["want"] = tuple(dict.fromkeys((*named, "last_phase", "air_time")))
    found: xarray.Dataset = roll(body, start, t, contact=contact, **how)
    for name, unit in (("precession", "sqrt(g/R)"), ("hertz", "Hz"), ("launch", "1"), ("spin_hertz", "Hz")):
        if name in found.coords:
            found[name].attrs["units"] = unit
    of = [found[name] for name in (("status", "last_phase", "air_time") if on else ("status",))]
    told = _outcome if on else _OUTCOMES.__getitem__
    found["outcome"] = lib.apply_ufunc(told, *of, dask="parallelized", output_dtypes=[np.uint8])
    found["outcome"].attrs = {"long_name": "outcome", **flags(Outcome)}
    return found


def _axis_of_flicks(lib: Any, name: str, value: Reals) -> Any:
    """Return a number as it is, and an array as a DataArray of xarray with a dimension `name`."""
    given = reals(name, value)
    given = float(given) if is_scalar(given) else given
    if is_scalar(given) or hasattr(given, "dims"):
        return given
    if np.ndim(given) != 1:
        raise ValueError(f"{name}: expected a number or a one-dimensional array, not shape {np.shape(given)}")
    axis = "precession" if name == "w1" else name  # for a body on its side, w1 is the precession
    return lib.DataArray(floats(given), dims=axis, coords={axis: floats(given)})
