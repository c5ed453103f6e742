"""Methods of `Motion` that draw it and write its sound and film; their code is in `spincyl.studio`."""

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from spincyl._input.hints import with_hints
from spincyl._scale import Scale
from spincyl._upward import function_of_method

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes


class Showing:
    """Base of `Motion`: methods that draw a motion, and that write its sound or its film."""

    def plot(self, axes: "Sequence[Axes] | None" = None) -> "list[Axes]":
        """Draw inclination, path and contact force, as `spincyl.plot.motion` does, and return the axes."""
        drawn: list[Axes] = function_of_method("Motion.plot")(self, axes)
        return drawn

    def sound(
        self,
        path: str | PathLike[str],
        seconds: float | None = None,
        *,
        scale: Scale | None = None,
        rate: int = 44_100,
        compression: float = 2.0,
    ) -> Path:
        """Write the sound of the motion as a WAV file: impacts, and a ring that beats with the precession.

        Parameters
        ----------
        path : path-like
            Name of the file, which must end in .wav. The file has one channel of 16 bits.
        seconds : float, optional
            Duration of the sound from the first time on. Default: the whole motion, at most 180 s.
        scale : Scale, optional
            Scale that converts times to seconds. Not needed for a measured body, which has its own.
        rate : int
            Samples per second.
        compression : float
            An impact, or a moment of the whirr, that is L decibels quieter than the loudest of all is written
            L / `compression` quieter; 1 to 100. The true ratio is 1.

        Returns
        -------
        Path
            Path of the file. The beat has the frequency phi'/(2 pi) of the motion; the pitch of the ring is
            arbitrary.

        Raises
        ------
        ValueError
            If there is nothing to hear: the contact point does not move along the body, or the duration is 0.
        OSError
            If the file cannot be written. An existing file stays until the new one is complete.
        """
        written: Path = function_of_method("Motion.sound")(self, path, seconds, scale, rate, compression)
        return written

    @with_hints
    def film(
        self, path: str | PathLike[str], seconds: float | None = None, *, sound: bool | None = None
    ) -> Path:
        """Write a film of the motion with its sound, in slow motion.

        `view` and `View.save` have all options: ``sc.view(m, slow=1).save(path)`` is a film at real speed.

        Parameters
        ----------
        path : path-like
            Name of the file: .mp4, or .gif, which has no sound.
        seconds : float, optional
            Longest duration of the film. Default: 10 s, with a warning if the film would be longer.
        sound : bool, optional
            Whether the film has the sound of the motion, as slow as the pictures. Default: if there is one.

        Returns
        -------
        Path
            Path of the file.

        Raises
        ------
        ValueError
            If the name ends otherwise, a number is out of range, or `sound` is true and nothing is heard.
        ImportError
            If spincyl[film] is needed and not installed.
        """
        written: Path = function_of_method("Motion.film")(self, path, seconds, sound)
        return written
