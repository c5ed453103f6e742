"""Motions as labelled arrays of xarray and as tables of pandas."""

from typing import TYPE_CHECKING, Any, TypeAlias

from spincyl._contact import contact_in_words
from spincyl._input.numbers import optional_library
from spincyl._phases import KINDS, phases_in_words
from spincyl._scale import unit_of_output

if TYPE_CHECKING:
    import pandas
    import xarray

    from spincyl._motion import Motion

#: Outputs with several components: axis, labels along the axis, and names of the columns.
Components: TypeAlias = dict[str, tuple[str, list[str], list[str]]]
AXES: Components = {
    "w": ("axis", ["e1", "e2", "e3"], ["w1", "w2", "w3"]),
    "contact_point": ("plan", ["x", "y"], ["contact_x", "contact_y"]),
    "centre": ("space", ["x", "y", "z"], ["centre_x", "centre_y", "centre_z"]),
    "contact_force": ("space", ["x", "y", "z"], ["force_x", "force_y", "force_z"]),
    "contact_force_other": ("space", ["x", "y", "z"], [f"force_other_{axis}" for axis in "xyz"]),
    "orientation": ("quaternion", ["x", "y", "z", "w"], [f"orientation_{axis}" for axis in "xyzw"]),
    "slip": ("direction", ["along the lean", "across"], ["slip_along", "slip_across"]),
    "pressure": ("direction", ["along the lean", "across"], ["pressure_along", "pressure_across"]),
    "slip_other": ("direction", ["along the lean", "across"], ["slip_other_along", "slip_other_across"]),
}


def wanted(m: "Motion") -> dict[str, tuple[Any, str]]:
    """The values and units of all outputs of a motion, without its times, by name."""
    found: dict[str, tuple[Any, str]] = {}
    for name in ("theta", "w", "energy", *m._extra):
        factor, said = unit_of_output(name, m.scale)
        values = getattr(m.natural, name)
        found[name] = values if factor is None else values * factor, said
    return found


def columns(m: "Motion") -> dict[str, tuple[Any, str]]:
    """The values (n,) and units of all outputs of a motion, a column for each component, by name."""
    found: dict[str, tuple[Any, str]] = {}
    axes = m._axes
    for name, (values, said) in wanted(m).items():
        parts = zip(axes[name][2], values.T, strict=True) if name in axes else [(name, values)]
        found |= {part: (x, said) for part, x in parts}
    return found


def frame(m: "Motion") -> "pandas.DataFrame":
    """All computed outputs of a motion as a pandas table indexed by time; `attrs["units"]` has the units."""
    lib: Any = optional_library("pandas", "sweep")
    told_ = columns(m)
    found: pandas.DataFrame = lib.DataFrame(
        {name: x for name, (x, _) in told_.items()}, index=lib.Index(m.t, name="t")
    )
    found.attrs["units"] = {"t": unit_of_output("t", m.scale)[1]} | {
        name: said for name, (_, said) in told_.items()
    }
    return found


def labelled(m: "Motion") -> "xarray.Dataset":
    """All computed outputs of a motion as an xarray Dataset with units."""
    lib: Any = optional_library("xarray", "sweep")
    data: dict[str, Any] = {}
    axes = m._axes
    coords: dict[str, Any] = {"t": ("t", m.t, {"units": unit_of_output("t", m.scale)[1]})}
    for name, (values, said) in wanted(m).items():
        dims = ("t", axes[name][0]) if name in axes else ("t",)
        data[name] = dims, values, {"units": said}
        if name in axes:
            coords[axes[name][0]] = axes[name][1]
    attrs: dict[str, Any] = {
        "status": m.status.name.lower(),
        "message": m.message,
        "contact": contact_in_words(m.contact),
        "method": m.method,
        "error": m.error,
    }
    attrs |= m._about()
    if m.scale is not None:
        attrs |= {"radius": m.scale.radius, "mass": m.scale.mass, "gravity": m.scale.gravity}
    if m.losses is not None:
        attrs["losses"] = repr(m.losses)
    if m._phases is not None:
        attrs["phases"] = phases_in_words(m.phases, "" if m.scale is None else " s")
        words = [kind.replace(" ", "_") for kind in KINDS]
        data["phase"][2].update(flag_values=list(range(len(words))), flag_meanings=" ".join(words))
    found: xarray.Dataset = lib.Dataset(data, coords, attrs)
    return found
