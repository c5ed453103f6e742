"""Motions as files: tables, arrays, pictures, pages; what a file becomes follows from its suffix."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from spincyl._array import extra
from spincyl._motion import Motion
from spincyl._scale import Scale


def _columns(m: Motion, scale: Scale | None) -> dict[str, np.ndarray]:
    columns = {"t": m.t}
    if scale is not None:
        columns["seconds"] = scale.seconds(m.t)
    columns |= {"theta": m.theta, "w1": m.w[:, 0], "w2": m.w[:, 1], "w3": m.w[:, 2], "energy": m.energy}
    columns |= {
        "phi": m.phi,
        "psi": m.psi,
        "contact_x": m.contact_point[:, 0],
        "contact_y": m.contact_point[:, 1],
    }
    columns |= {f"centre_{axis}": m.centre[:, i] for i, axis in enumerate("xyz")}
    columns |= {f"orientation_{axis}": m.orientation[:, i] for i, axis in enumerate("xyzw")}
    return columns | {
        "normal": m.normal,
        "friction": m.friction,
        "friction_coefficient": m.friction_coefficient,
    }


def writer_of(path: Path) -> Callable[[Motion, Scale | None, Path], None]:
    """What writes a motion into a file of this suffix."""
    writers = {".csv": _write_csv, ".npz": _write_npz, ".nc": _write_nc}
    writers |= dict.fromkeys((".png", ".pdf", ".svg"), _write_picture)
    writers |= dict.fromkeys((".html", ".glb"), _write_view)
    try:
        return writers[path.suffix.lower()]
    except KeyError:
        raise ValueError(f"-o {path}: expected a name that ends in {', '.join(writers)}") from None


def _write_csv(m: Motion, scale: Scale | None, path: Path) -> None:
    columns = _columns(m, scale)
    # seventeen digits: what is read back is what was written
    table = np.column_stack(list(columns.values()))
    np.savetxt(path, table, fmt="%.17g", delimiter=",", header=",".join(columns), comments="")


def _write_npz(m: Motion, scale: Scale | None, path: Path) -> None:
    about: dict[str, Any] = {
        "status": int(m.status),
        "message": m.message,
        "error": m.error,
        "contact": m.contact,
    }
    about["body"] = np.array([m.body.ell, m.body.i1, m.body.i3])
    np.savez_compressed(path, **about | _columns(m, scale))


def _write_nc(m: Motion, scale: Scale | None, path: Path) -> None:
    data = m.to_xarray()
    if scale is not None:
        data = data.assign_coords(seconds=("t", scale.seconds(m.t), {"units": "s"}))
    data.to_netcdf(path)


def _write_picture(m: Motion, scale: Scale | None, path: Path) -> None:
    extra("matplotlib", "plot").use("agg")
    from spincyl import plot

    figure: Any = plot.motion(m)[0].figure
    figure.savefig(path, dpi=150)


def _write_view(m: Motion, scale: Scale | None, path: Path) -> None:
    from spincyl import view

    about = f"{m.body!r}, {m.contact}"
    view(m, labels=[about], title=about, scale=scale).save(path)
