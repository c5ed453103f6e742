"""Motions as files: tables, arrays, pictures and pages; the suffix determines the format."""

from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from spincyl._contact import contact_in_words
from spincyl._input.files import writing_whole
from spincyl._input.hints import install_command
from spincyl._input.numbers import optional_library
from spincyl._labelled import columns as labelled_columns
from spincyl._loss import losses_in_words
from spincyl._motion import Motion
from spincyl._scale import Scale


def columns(m: Motion, scale: Scale | None) -> dict[str, np.ndarray]:
    """All outputs of a motion by name, (n,) each; with a scale also its times in seconds."""
    told = {"t": m.t}
    if scale is not None:
        told["seconds"] = scale.seconds(m.t)
    return told | {name: x for name, (x, _) in labelled_columns(m).items()}


_PICTURES = (".png", ".pdf", ".svg")


def writer_of(path: Path) -> Callable[[Motion, Scale | None, Path], None]:
    """The function that writes a motion to a file with this suffix; ImportError if a library is missing."""
    writers = {".csv": _write_csv, ".npz": _write_npz, ".nc": _write_nc}
    writers |= dict.fromkeys(_PICTURES, _write_picture)
    writers |= dict.fromkeys((".html", ".glb"), _write_view)
    writers |= dict.fromkeys((".json", ".xml"), _write_scene)
    suffix = path.suffix.lower()
    if suffix not in writers:
        raise ValueError(f"-o {path}: expected a name that ends in {', '.join(writers)}")
    needed(suffix)
    return writers[suffix]


def needed(suffix: str) -> None:
    """Import the libraries that a file of this suffix needs, or raise ImportError naming one."""
    if suffix in _PICTURES:
        optional_library("matplotlib", "plot")
    if suffix == ".nc":
        optional_library("xarray", "sweep")
        if not any(find_spec(name) for name in ("netCDF4", "h5netcdf", "scipy")):
            raise ImportError(
                f"a .nc file needs netCDF4, h5netcdf or scipy; install one: {install_command('scipy')}"
            )


def _write_csv(m: Motion, scale: Scale | None, path: Path) -> None:
    write_csv(columns(m, scale), path)


def write_csv(told: dict[str, Any], file: Path | TextIO) -> None:
    """Write columns with seventeen digits, so that reading them back gives the same numbers."""
    table = np.column_stack([np.ravel(x) for x in told.values()])
    how: dict[str, Any] = {"fmt": "%.17g", "delimiter": ",", "header": ",".join(told), "comments": ""}
    if not isinstance(file, Path):
        np.savetxt(file, table, **how)
        return
    with writing_whole(file) as part:
        np.savetxt(part, table, **how)


def _write_npz(m: Motion, scale: Scale | None, path: Path) -> None:
    about: dict[str, Any] = {
        "status": int(m.status),
        "message": m.message,
        "error": m.error,
        "contact": contact_in_words(m.contact),
    }
    if m.losses is not None:
        about["losses"] = repr(m.losses)
    about["body"] = np.array([m.body.ell, m.body.i1, m.body.i3])
    with writing_whole(path) as part:
        np.savez_compressed(part, **about | columns(m, scale))


def _write_nc(m: Motion, scale: Scale | None, path: Path) -> None:
    data = m.to_xarray()
    if scale is not None:
        data = data.assign_coords(seconds=("t", scale.seconds(m.t), {"units": "s"}))
    with writing_whole(path) as part:
        data.to_netcdf(part)


def _write_picture(m: Motion, scale: Scale | None, path: Path) -> None:
    optional_library("matplotlib", "plot").use("agg")
    from spincyl import plot
    from spincyl.studio.plot._style import saved

    figure: Any = plot.motion(m)[0].figure
    saved(figure, path)


def _write_view(m: Motion, scale: Scale | None, path: Path) -> None:
    from spincyl import view

    about = f"{m.body!r}, {contact_in_words(m.contact)}" + (
        "" if m.losses is None else f", {losses_in_words(m.losses, m.scale)}"
    )
    view(m, labels=[about], title=about, scale=scale).save(path)


def _write_scene(m: Motion, scale: Scale | None, path: Path) -> None:
    from spincyl import scene

    scene(m, scale=scale).save(path)
