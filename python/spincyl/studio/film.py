"""Films of pages, as MP4 with sound by ffmpeg or as GIF by Pillow; `frames` draws them.

The sound is that of the slow motion: it is loudest when the contact point passes the camera,
and its pitch is that of `sound`.
"""

import math
import subprocess
import warnings
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory, TemporaryFile
from typing import Any

import numpy as np

from spincyl._input.files import writing_whole
from spincyl._input.hints import install_command
from spincyl._input.numbers import Floats, flag, in_range, optional_library, whole
from spincyl._input.progress import Progress, reporting_progress
from spincyl.studio.frames import Reel, frames, pictures, vector
from spincyl.studio.look import AZIMUTH, SLOW
from spincyl.studio.poses import span
from spincyl.studio.sound import Silent, pressure, sources, write_wave

_DEFAULT_SECONDS = 10.0  # seconds, the default length of a film
_LARGE_FILE = 20e6  # bytes; a larger file causes a warning
_RATE = 44_100  # samples of the sound per second
#: Players assume BT.709 for a file without a mark, but ffmpeg converts by BT.601 unless told otherwise.
_H264 = [
    *("-vf", "scale=out_color_matrix=bt709:out_range=tv", "-c:v", "libx264", "-crf", "18"),
    *("-pix_fmt", "yuv420p", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"),
    *("-movflags", "+faststart", "-f", "mp4"),
]


def reel(
    view: Any,
    edges: Sequence[dict[str, Any]],
    suffix: str,
    fps: int | None,
    size: tuple[int, int] | None,
    seconds: float | None = None,
) -> Reel:
    """The settings of a view's film, for a file with this suffix; errors name the argument at fault."""
    gif = suffix == ".gif"
    fps = (25 if gif else 30) if fps is None else whole("fps", fps, 1, 240)
    if gif and 100 % fps:
        raise ValueError(f"fps = {fps}: expected a divisor of 100 for a GIF, such as 50, 25, 20 or 10")
    size = ((640, 360) if gif else (1280, 720)) if size is None else size
    if not isinstance(size, tuple | list) or len(size) != 2:
        raise TypeError(f"size: expected width and height, not {size!r}")
    sides = zip(("size: width", "size: height"), size, strict=True)
    width, height = (whole(name, x, 64, 8192) for name, x in sides)
    if suffix == ".mp4" and (width % 2 or height % 2):
        raise ValueError(f"size = {size!r}: expected even numbers, which MP4 needs")
    unit = 1.0 if view.scale is None else float(view.scale.seconds(1.0))
    how = (unit, view._symbol, view._spun, view.slow, view.upper, fps, (width, height))
    if seconds is None:
        spans = [sorted(span(m)) for m in view.motions]
        lasts = (max(b for _, b in spans) - min(a for a, _ in spans)) * view.slow * unit
        if lasts > _DEFAULT_SECONDS * (1 + 1e-9):
            first = f"{_DEFAULT_SECONDS:g} of {lasts:.3g} seconds"
            told = f"the film shows the first {first}; give seconds= for more{_faster(view.slow, lasts)}"
            warnings.warn(told, UserWarning, stacklevel=3)
    return Reel(
        view.motions,
        view.labels,
        edges,
        *how,
        _DEFAULT_SECONDS if seconds is None else seconds,
        view._colours,
        view.look,
    )


def _faster(slow: float, lasts: float) -> str:
    """Text that proposes a `slow` at which all of a motion fits into the default length of a film."""
    fits = [x for x in SLOW if x * lasts <= slow * _DEFAULT_SECONDS * (1 + 1e-9)]
    return f", or slow={max(fits)} for all of it" if fits else ""


def film(what: Reel, path: Path, progress: Progress | bool | None = None, sound: bool | None = None) -> None:
    """Write the film, and report the finished share; if `sound` is None, with sound if possible."""
    write = _gif if path.suffix.lower() == ".gif" else _mp4
    sound = sound if sound is None else flag("sound", sound)
    if sound and write is _gif:
        raise ValueError("sound: a GIF has no sound; write an .mp4")
    optional_library("matplotlib", "film")
    program = program_of_ffmpeg() if write is _mp4 else ""
    count = what.times.size  # too long a film is refused before anything is written
    heard = None if sound is False or write is _gif else _heard(what, sound is True)

    def shown() -> Iterator[np.ndarray]:
        for k, picture in enumerate(frames(what), 1):
            yield picture
            if told:
                told(k / count)

    with reporting_progress(progress, "film") as told, writing_whole(path) as part:
        if write is _gif:
            _gif(what, shown(), part)
        else:
            _mp4(what, shown(), part, program, heard)
    large = path.stat().st_size
    if large > _LARGE_FILE:
        how = "reduce size=, fps= or seconds="
        how += "; an .mp4 is much smaller" if write is _gif else ""
        warnings.warn(f"{path}: {large / 1e6:.0f} MB; {how}", UserWarning, stacklevel=3)


def still(what: Reel, path: Path, t: float | None) -> None:
    """Write the picture of a view at the time `t`, in the page's unit of time."""
    optional_library("matplotlib", "film")
    from PIL import Image

    spans = [sorted(span(m)) for m in what.motions]
    first, last = (of(x) * what.unit for of, x in zip((min, max), zip(*spans, strict=True), strict=True))
    t = first if t is None else in_range("t", t, first, last)
    what, kind = what._replace(slow=1), path.suffix.lower()[1:]
    if kind == "png":
        (picture,) = pictures(what, np.array([t / what.unit]), still=True)
    with writing_whole(path) as part:
        if kind == "png":
            Image.fromarray(picture).save(part, "PNG")
        else:
            vector(what, t / what.unit, part, kind)


def program_of_ffmpeg() -> str:
    """The path of the program ffmpeg, from imageio-ffmpeg or on the search path."""
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        return str(get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        found = which("ffmpeg")
    if found is None:
        how = install_command("'spincyl[film]'")
        raise ImportError(f"a film in MP4 needs ffmpeg: {how}, or the program ffmpeg on the search path")
    return found


def _heard(what: Reel, needed: bool) -> Floats | None:
    """The sound of a film, as long as its pictures; None if nothing is heard and no sound is needed."""
    unit, found = what.unit * what.slow, []
    first = min(min(span(m)) for m in what.motions)
    lasting = float(what.times[-1] - first) * unit
    for m in what.motions:
        try:
            found.append(sources(m, first, unit, lasting, -math.pi / 2 if what.look.above else AZIMUTH))
        except Silent as reason:
            if needed and len(what.motions) == 1:
                raise ValueError(f"sound: {reason}") from None
    if needed and not found:
        raise ValueError("sound: there is nothing to hear in any of the motions")
    return pressure(found, round(what.times.size / what.fps * _RATE), _RATE) if found else None


def _mp4(what: Reel, pictures: Iterator[np.ndarray], path: Path, program: str, heard: Floats | None) -> None:
    """Write H.264 by ffmpeg, in colours that every player reads, with the sound as AAC."""
    width, height = what.size
    words = [program, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
    words += ["-s", f"{width}x{height}", "-r", str(what.fps), "-i", "-"]
    with TemporaryDirectory() as folder:
        if heard is not None:
            write_wave(Path(folder) / "sound.wav", heard, _RATE)
            words += ["-i", str(Path(folder) / "sound.wav"), "-c:a", "aac", "-b:a", "160k"]
        _run([*words, *_H264, str(path)], pictures)


def _run(words: list[str], pictures: Iterator[np.ndarray]) -> None:
    """Run ffmpeg, and pass it the pictures; an OSError quotes the message of ffmpeg."""
    with TemporaryFile() as said:
        process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=said)
        assert process.stdin is not None
        try:
            with suppress(BrokenPipeError):  # ffmpeg has ended early; its message follows
                for picture in pictures:
                    process.stdin.write(picture.tobytes())
        except BaseException:
            process.kill()
            raise
        finally:
            with suppress(BrokenPipeError):
                process.stdin.close()
            code = process.wait()
        if code:
            said.seek(0)
            told = said.read().decode(errors="replace").strip()
            raise OSError(f"ffmpeg: {told or f'ended with code {code}'}")


def _gif(what: Reel, pictures: Iterator[np.ndarray], path: Path) -> None:
    """Write a GIF by Pillow, which comes with matplotlib; one palette for all frames avoids flicker."""
    from PIL import Image

    count = what.times.size
    some = what._replace(size=(what.size[0] // 2, what.size[1] // 2))
    looks = np.concatenate(list(frames(some, np.unique(np.linspace(0, count - 1, 6).astype(int)))))
    palette = Image.fromarray(looks).quantize(255, Image.Quantize.MEDIANCUT)
    inked = (Image.fromarray(x).quantize(palette=palette, dither=Image.Dither.NONE) for x in pictures)
    first = next(inked)
    first.save(
        path, "GIF", save_all=True, append_images=inked, duration=1000 // what.fps, loop=0, optimize=False
    )
