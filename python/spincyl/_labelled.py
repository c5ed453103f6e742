"""A motion as a labelled table of xarray's."""

from typing import TYPE_CHECKING, Any

from spincyl._array import extra
from spincyl._contact import named
from spincyl._motion import Motion
from spincyl._phases import told

if TYPE_CHECKING:
    import xarray


def labelled(m: Motion) -> "xarray.Dataset":
    """Everything that was wanted of a motion, with units."""
    lib: Any = extra("xarray", "sweep")
    units = {"theta": "rad", "w": "sqrt(g/R)", "energy": "M g R", "phi": "rad", "psi": "rad"}
    units |= {"contact_point": "R", "centre": "R", "normal": "M g", "friction": "M g"}
    units |= {"slip": "sqrt(g R)", "dissipated": "M g R"}
    axes = {
        "w": ("axis", ["e1", "e2", "e3"]),
        "contact_point": ("plan", ["x", "y"]),
        "centre": ("space", ["x", "y", "z"]),
        "orientation": ("quaternion", ["x", "y", "z", "w"]),
        "slip": ("direction", ["along the lean", "across"]),
    }
    names = ["theta", "w", "energy", *m._extra]
    data: dict[str, Any] = {}
    for name in names:
        dims = ("t", axes[name][0]) if name in axes else ("t",)
        data[name] = (dims, getattr(m, name), {"units": units.get(name, "1")})
    coords: dict[str, Any] = {"t": ("t", m.t, {"units": "sqrt(R/g)"})}
    coords |= {axes[name][0]: axes[name][1] for name in names if name in axes}
    attrs = {
        "status": m.status.name.lower(),
        "message": m.message,
        "contact": named(m.contact),
        "method": m.method,
        "error": m.error,
        "ell": m.body.ell,
        "i1": m.body.i1,
        "i3": m.body.i3,
    }
    if m._phases is not None:
        attrs["phases"] = told(m._phases)
        data["phase"][2].update(flag_values=[0, 1], flag_meanings="rolling slipping")
    found: xarray.Dataset = lib.Dataset(data, coords, attrs)
    return found
