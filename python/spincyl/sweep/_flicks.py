"""Many flicks of a tube: which settle on one rim, which lie down again, and which hop before."""

from enum import IntEnum
from inspect import signature
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._body import Body
from spincyl._contact import AnyContact, Coulomb, Viscous
from spincyl._input.numbers import Reals, extra, floats, is_scalar, made, reals
from spincyl._phases import KINDS
from spincyl._single import one_body
from spincyl._throw import flicked
from spincyl.sweep._labels import Status, flags
from spincyl.sweep._roll import roll

if TYPE_CHECKING:
    import xarray


class Outcome(IntEnum):
    """What a flick comes to.

    `SETTLES`: at the last time it goes round on one rim. `LIES_DOWN`: its other rim lands, or does not rise;
    with a `restitution` it then lies on its side. `LIFTS_OFF`: the normal force vanishes, and it hops; with a
    `restitution` the hop is followed, and the outcome says what it comes to. `NONE` of these: `status` says
    what.
    """

    NONE = 0  #: none of these: `status` says what
    SETTLES = 1  #: it goes on to the last time asked for
    LIES_DOWN = 2  #: its other rim lands, or does not rise
    LIFTS_OFF = 3  #: the normal force vanishes: it hops, and at the last time it is still in the air
    HOPS_AND_SETTLES = 4  #: it hops, and then goes round on one rim
    HOPS_AND_LIES = 5  #: it hops, and then lies on its side


_OUTCOMES = np.zeros(len(Status), np.uint8)
_OUTCOMES[[Status.DONE, Status.SIDE, Status.LIFT_OFF]] = (
    Outcome.SETTLES,
    Outcome.LIES_DOWN,
    Outcome.LIFTS_OFF,
)
#: Outcome of a motion that goes on, by its last phase, without an impact and with one.
_ON_RIM, _ON_SIDE = KINDS[:2], KINDS[3:]
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
    """What motions with a restitution come to."""
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
    """How flicks of a tube end: every rate against every launch number, or every spin about the axis.

    Parameters
    ----------
    body : Body
        A single one, as of `spincyl.flicked`; of a measured one everything is in SI.
    t : float
        How long each is followed, in sqrt(R/g), of a measured body in seconds. 200 sqrt(R/g), which is 5.7 s
        of the tube below, is enough to lie down, to lift off, or to roll for the first time.
    hertz, w1, launch, spin_hertz, centre : array_like, 1-D, or numbers
        As of `spincyl.flicked`, which takes one of the first two and one of the next two; arrays are axes of
        the result: "hertz", or "precession" of `w1`, "launch" or "spin_hertz", and "centre".
    contact : Coulomb or Viscous
        Of numbers, or labelled arrays of them.
    **how
        `want=` (default "end" and "rolling_time") and the others of `roll`. With ``restitution=`` every flick
        is followed through its hops, and lying down, to the last time.

    Returns
    -------
    xarray.Dataset
        What `roll` gives, and "outcome" (`Outcome`). `plot.flicks` draws it. A tube that settles may slip for
        a moment in every nod, and its "rolling_time" is the last of many; with ``stop_at="rolling"`` it is
        the first time at which the tube rolls.

    Raises
    ------
    ValueError, TypeError
        Naming the argument.

    Examples
    --------
    >>> import spincyl as sc
    >>> tube = sc.measured(outer_diameter="15.875mm", inner_diameter="12.7mm", length="95.25mm")
    >>> found = sc.sweep.flicks(tube, 5.7, hertz=[10, 20], launch=[1.2, 1.3, 3.0], contact=sc.Coulomb(0.3))
    >>> found["outcome"].dims, found["outcome"].values.tolist()
    (('hertz', 'launch'), [[2, 2, 3], [1, 1, 3]])
    """
    lib = extra("xarray", "sweep")
    body = one_body(body)
    if not isinstance(contact, Coulomb | Viscous):
        made("contact", contact, Coulomb)
    given = {"w1": w1, "hertz": hertz, "launch": launch, "spin_hertz": spin_hertz, "centre": centre}
    axes = {name: x for name, x in given.items() if x is not None}
    start = flicked(body, **{name: _axis(lib, name, x) for name, x in axes.items()})
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
    found["outcome"].attrs = {"long_name": "what it comes to", **flags(Outcome)}
    return found


def _axis(lib: Any, name: str, value: Reals) -> Any:
    """A number, or an array with a dimension of this name."""
    given = reals(name, value)
    given = float(given) if is_scalar(given) else given
    if is_scalar(given) or hasattr(given, "dims"):
        return given
    if np.ndim(given) != 1:
        raise ValueError(f"{name}: expected a number or one dimension, not shape {np.shape(given)}")
    axis = "precession" if name == "w1" else name  # for a body on its side, w1 is the precession
    return lib.DataArray(floats(given), dims=axis, coords={axis: floats(given)})
