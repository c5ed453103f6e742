"""A motion drawn on a frame of a film: the outline and the paths of the ends of a tube, beside the marks.

```text
end = centre + (length of the tube / 2) sin theta (cos phi, sin phi)
side = centre of a rim + R (-sin phi, cos phi)
```
The camera is far above the table, as in `from_above`.
"""

import math
import subprocess
from collections.abc import Sequence
from io import BytesIO
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from spincyl._input.files import path_of
from spincyl._input.numbers import Floats, number, optional_library, reals, whole
from spincyl._motion import Motion
from spincyl.lab._beside import At, beside, in_film
from spincyl.lab._columns import Camera
from spincyl.lab._filmed import Filmed
from spincyl.studio.film import program_of_ffmpeg
from spincyl.studio.plot._style import BLUE, ORANGE, new_axes, sized

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_PICTURES = {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp"}
_PATH = 200  # points of a path
_MARGIN = 0.1  # of an empty frame, as a share of the size of the tracks


@sized
def over(
    film: Filmed,
    motion: Motion,
    frames: "np.ndarray[Any, Any] | str | PathLike[str] | None" = None,
    *,
    t: float | None = None,
    first: int = 0,
    fps: float | None = None,
    camera: Sequence[float] | None = None,
    ax: "Axes | None" = None,
) -> "Axes":
    """Draw a motion on a frame of a film; see `Filmed.over`."""
    if not isinstance(motion, Motion):
        raise TypeError(f"motion: expected a motion, not {type(motion).__name__}")
    axes = _camera_of(film, camera)
    row = 0 if t is None else _nearest(film, number("t", t))
    first = whole("first", first, -1_000_000_000, 1_000_000_000)
    fps = 1 / float(np.median(np.diff(film.t))) if fps is None else number("fps", fps)
    if not 0 < fps < math.inf:
        raise ValueError(f"fps = {fps!r}: expected a positive number")
    found = beside(motion, film)
    picture = None if frames is None else _picture(frames, first + round(fps * float(film.t[row])))
    ax = new_axes(ax)
    # the marks and the path of one turn, half of it before this frame
    begin, end = (float(film.t[row]) + side / (2 * film.hertz) for side in (-1, 1))
    near = (film.t >= begin) & (film.t <= end)
    marks = axes.pixels(film.marks @ np.array([1.0, 1j]))
    now = in_film(found, film.t[row : row + 1])
    path = in_film(found, np.linspace(max(begin, film.t[0]), min(end, film.t[-1]), _PATH))
    ends, here = (axes.pixels(ends_of_tube(film, at)) for at in (path, now))
    if picture is None:
        _empty_frame(ax, np.concatenate([marks.ravel(), ends[np.isfinite(ends)]]))
    else:
        high, wide = picture.shape[:2]
        white = 1.0 if picture.dtype.kind == "f" else np.iinfo(picture.dtype).max
        ax.imshow(picture, extent=(0, wide, high, 0), cmap="gray", vmin=0, vmax=white)
    for k, one in enumerate(ends.T):
        ax.plot(*_xy(one), color=BLUE, lw=1, alpha=0.7, label=None if k else "ends, computed")
    for line in outline_of_tube(film, now):
        ax.plot(*_xy(axes.pixels(line)), color=BLUE, lw=2)
    ax.plot(*_xy(here.ravel()), "x", color=BLUE, ms=9, mew=2, label="ends in this frame")
    ax.plot(*_xy(marks[near].ravel()), "o", mfc="none", color=ORANGE, ms=4, alpha=0.5, label="marks")
    ax.plot(*_xy(marks[row]), "o", color=ORANGE, ms=6, label="marks in this frame")
    ax.set(xlabel="x (pixels)", ylabel="y (pixels)", title=f"$t$ = {film.t[row]:.4g} s")
    ax.legend(fontsize="x-small", loc="upper right")
    return ax


def ends_of_tube(film: Filmed, at: At) -> Any:
    """Computed positions x + iy of both ends of the tube, (n, 2), metres; NaN before and after the motion."""
    half = float(film.scale.metres(film.body.ell + film.body.fillet))
    reach = half * np.sin(at.theta) * np.exp(1j * at.phi)
    return np.column_stack([at.path + reach, at.path - reach])


def outline_of_tube(film: Filmed, at: At) -> list[Any]:
    """Lines x + iy, in metres, of the two rims and the two sides of the tube at a single time."""
    theta, along = float(at.theta[0]), np.exp(1j * at.phi[0])
    radius, half = (float(film.scale.metres(x)) for x in (1.0, film.body.ell))
    turn = np.exp(1j * np.linspace(0.0, 2 * math.pi, 73))
    # a rim is foreshortened along the axis, by the cosine of the inclination
    rim = radius * along * (math.cos(theta) * turn.real + 1j * turn.imag)
    middles = at.path[0] + half * math.sin(theta) * along * np.array([1, -1])
    sides = [middles + side * radius * 1j * along for side in (1, -1)]
    return [*(middle + rim for middle in middles), *sides]


def _camera_of(film: Filmed, camera: Sequence[float] | None) -> Camera:
    """The given axes and scale of the film, or those of its Tracker project."""
    if camera is None:
        if film.camera is None:
            raise ValueError(
                "camera: expected (x, y, pixels per metre, degrees), since only a Tracker project with fixed"
                " axes contains them"
            )
        return film.camera
    numbers = np.asarray(reals("camera", camera), np.float64)
    if numbers.shape != (4,) or not np.isfinite(numbers).all() or not numbers[2] > 0:
        raise ValueError(f"camera = {camera!r}: expected (x, y, pixels per metre, degrees)")
    return Camera(*numbers.tolist())


def _nearest(film: Filmed, t: float) -> int:
    """Row in the film of the frame that is nearest to the time `t`, in seconds."""
    low, high = float(film.t[0]), float(film.t[-1])
    if not low <= t <= high:
        raise ValueError(f"t = {t!r}: expected a time of the film, from {low:.6g} to {high:.6g} s")
    return int(np.abs(film.t - t).argmin())


def _picture(frames: Any, index: int) -> Any:
    """The picture of a frame: a given array, the picture in a file, or frame `index` of a film."""
    if isinstance(frames, str | PathLike):
        path = path_of("frames", frames)
        pictures: Any = optional_library("matplotlib.image", "film")
        if path.suffix.lower() in _PICTURES:
            try:
                return pictures.imread(path)
            except OSError:
                raise
            except Exception as e:  # Pillow raises errors of many kinds for a damaged file
                raise ValueError(f"frames: {path} is not a picture: {e}") from None
        return pictures.imread(BytesIO(_frame_of_film(path, index)))
    picture = np.asarray(reals("frames", frames)) if not isinstance(frames, np.ndarray) else frames
    if picture.dtype.kind not in "uif" or not picture.size:
        raise TypeError(f"frames: expected an array of a picture, or a path, not {type(frames).__name__}")
    if picture.ndim not in (2, 3) or (picture.ndim == 3 and picture.shape[2] not in (3, 4)):
        raise ValueError(f"frames: expected (height, width) or (height, width, 3 or 4), not {picture.shape}")
    return picture


def _frame_of_film(path: Any, index: int) -> bytes:
    """Frame `index` of a film as the bytes of a PNG picture, extracted by ffmpeg."""
    if not path.is_file():
        raise FileNotFoundError(f"frames: there is no file {path}")
    if index < 0:
        raise ValueError(
            f"first: the frame at t would have the number {index} in the file; expected 0 or more"
        )
    words = [program_of_ffmpeg(), "-loglevel", "error", "-nostdin", "-i", str(path)]
    words += ["-vf", rf"select=eq(n\,{index})", "-frames:v", "1", "-f", "image2pipe", "-c:v", "png", "-"]
    ran = subprocess.run(words, capture_output=True, check=False)
    if ran.returncode:
        raise OSError(f"frames: {path}: ffmpeg: {ran.stderr.decode(errors='replace').strip()}")
    if not ran.stdout:
        raise ValueError(f"frames: {path} has no frame {index}; are first= and fps= right?")
    return ran.stdout


def _empty_frame(ax: "Axes", places: Any) -> None:
    """Set the limits of axes without a picture, in pixels, with y downward."""
    x, y = places.real, places.imag
    margin = _MARGIN * float(max(np.ptp(x), np.ptp(y)))
    ax.set(xlim=(x.min() - margin, x.max() + margin), ylim=(y.max() + margin, y.min() - margin))
    ax.set_aspect("equal")


def _xy(places: Any) -> tuple[Floats, Floats]:
    return places.real, places.imag
