"""Comparison of a film with a motion: inclination, precession and centre in each frame.

The film knows neither the axes of the motion nor the side from which it was seen. The path of the motion is
therefore turned by phi0 and moved to a place, both by least squares, and reflected if the film turns in the
other sense:

```text
direction = phi + phi0 (+ pi for the other end),    (x, y) = place + path turned by phi0
```
"""

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from spincyl._input.equality import compared_by_value
from spincyl._input.numbers import Floats
from spincyl._motion import Motion
from spincyl._upward import function_of_method
from spincyl.lab._filmed import Filmed
from spincyl.lab._report import section
from spincyl.lab._slopes import slope, slopes
from spincyl.lab._vary import in_units_of, with_numbers

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

_LEAST = 6  # frames from which on the scatter of the marks gives an error
_OUTPUTS = ("theta", "precession", "x", "y")


@compared_by_value
class FilmComparison(NamedTuple):
    """A film compared with a motion, frame by frame; returned by `compare`.

    Methods: ``report()`` and ``plot()``.

    Attributes
    ----------
    motion : Motion
        The motion at the times of the frames, up to its end.
    film : Filmed
        The film.
    computed : dict of ndarray, (n,)
        Outputs of the motion in each frame, as the film would show them: theta in radians, precession in
        rad/s, x and y of the centre in metres, and phi in radians; NaN before the start of the motion and
        after its end. The precession is the slope of phi over the same frames and with the same weights as in
        the film.
    residual : dict of ndarray, (n,)
        Measured minus computed values, in the same units.
    away : dict of ndarray, (n,)
        Residuals in units of their standard errors. The residuals of theta are computed from sin(theta), that
        is, from the length of the line in the film, also in frames in which it is longer than the tube.
    chi2 : dict of float
        Mean of the squares of `away` for "theta", "precession" and "centre"; about 1 if film and motion
        agree. That of the centre is per degree of freedom, since its place is fitted.
    phi0 : float
        Angle about the vertical by which the computed motion is turned to fit the film, in radians.
    place : tuple of float
        The point of the film to which the origin of the motion is moved: x and y in metres.
    mirrored : bool
        Whether the motion is reflected (y to -y, before it is turned), since the tube in the film turns in
        the other sense.
    """

    motion: Motion
    film: Filmed
    computed: dict[str, Floats]
    residual: dict[str, Floats]
    away: dict[str, Floats]
    chi2: dict[str, float]
    phi0: float
    place: tuple[float, float]
    mirrored: bool

    def report(self) -> str:
        """Return chi2, the mean residual and the largest residual of each output, in lmfit's style."""
        count = int(np.isfinite(self.computed["theta"]).sum())
        rows = [
            ("body", repr(self.motion.body)),
            ("# frames", f"{count} of {self.film.t.size}"),
            ("path", f"turned by {math.degrees(self.phi0):.4g} degrees" + ", mirrored" * self.mirrored),
        ]
        units = {"theta": ("inclination", "degrees"), "precession": ("precession", "rad/s")}
        units |= {"x": ("x of the centre", "mm"), "y": ("y of the centre", "mm")}
        factor = {"degrees": math.degrees(1.0), "rad/s": 1.0, "mm": 1e3}
        told = []
        for name, (words, unit) in units.items():
            off = self.residual[name][np.isfinite(self.residual[name])] * factor[unit]
            if off.size:
                # the place is fitted, so that the mean of x and y is 0
                mean = "" if name in ("x", "y") else f"mean {float(off.mean()):+.2g}, "
                rms = math.sqrt(float(np.mean(off**2)))
                far = float(np.nanmax(np.abs(self.away[name])))
                told.append((words, f"{mean}rms {rms:.2g} {unit}, at most {far:.1f} errors"))
        lines = section("Film beside a motion", rows) + section("Measured minus computed", told)
        return "\n".join(lines + section("Chi-square", [(n, f"{x:.3g}") for n, x in self.chi2.items()]))

    def plot(self, axes: "Sequence[Axes] | None" = None) -> "list[Axes]":
        """Draw inclination, precession and centre against time, measured and computed, on three axes."""
        drawn: list[Axes] = function_of_method("FilmComparison.plot")(self, axes)
        return drawn

    def __repr__(self) -> str:
        told = ", ".join(f"{name} {x:.3g}" for name, x in self.chi2.items())
        return f"<FilmComparison: {self.film.t.size} frames; chi2 of {told}>"


def beside(motion: Motion, film: Filmed) -> FilmComparison:
    """Compare a motion with a film, for `compare`, which calls these arguments `body` and `theta`."""
    if type(motion) is not Motion or getattr(motion.body, "rims", None) is not None:
        raise TypeError("body: expected the motion of a body of revolution with a circular rim")
    if motion._asked.slope or motion._asked.turning:
        raise ValueError("body: expected a motion on a level table at rest, since a fit turns its path")
    errors = film.errors
    if film.t.size < _LEAST or not all((e[np.isfinite(e)] > 0).any() for e in errors.values()):
        raise ValueError(
            f"theta: the errors of the marks cannot be estimated from {film.t.size} frames;"
            " give their error with from_above(mark_err=)"
        )
    if film.t[-1] < begin_of(motion, film):
        raise ValueError(f"theta: the film ends at {film.t[-1]:.4g} s, before the motion begins")
    m, theta, phi, path = motion_at(motion, film, film.t)
    seen = np.flatnonzero(np.isfinite(theta))
    if seen.size < 3:
        raise ValueError(
            f"body: the motion ends ({m.status}) after {seen.size} of the {film.t.size} frames;"
            " expected at least three of them"
        )
    turned = float(np.sum(np.diff(phi[seen]))) * float(film.direction[seen[-1]] - film.direction[seen[0]])
    mirrored = turned < 0
    if mirrored:
        phi, path = -phi, path.conj()
    phi0, place = _placed(film, phi, path, errors["x"])
    path = place + path * np.exp(1j * phi0)
    slope_rows, weights = slopes(film.t, film.window)
    computed = {
        "theta": theta,
        "precession": slope(phi, slope_rows, weights),
        "x": path.real.copy(),
        "y": path.imag.copy(),
        "phi": phi + phi0,
    }
    frames = film.frames
    residual = {name: frames[name] - computed[name] for name in _OUTPUTS}
    away = {name: residual[name] / errors[name] for name in _OUTPUTS}
    share, share_err = film._share
    away["theta"] = (share - np.sin(theta)) / share_err
    both = np.r_[away["x"], away["y"]]
    chi2 = {name: float(np.nanmean(away[name] ** 2)) for name in ("theta", "precession")}
    free = max(int(np.isfinite(both).sum()) - 2, 1)
    chi2["centre"] = float(np.nansum(both**2)) / free
    point = float(place.real), float(place.imag)
    made = in_units_of(motion, m)
    return FilmComparison(made, film, computed, residual, away, chi2, phi0, point, mirrored)


class At(NamedTuple):
    """Values of a motion at times of a film; NaN before the motion starts and after it ends."""

    motion: Motion  #: in natural units
    theta: Floats
    phi: Floats
    path: Any  #: of the centre, x + iy in metres


def begin_of(motion: Motion, film: Filmed) -> float:
    """Time in the film at which a motion begins, in seconds."""
    scale = motion.scale or film.scale
    return float(scale.seconds(motion.natural._asked.t0))


def motion_at(motion: Motion, film: Filmed, seconds: Floats) -> At:
    """Compute a motion at ascending times of a film, in seconds, in the coordinates of the motion."""
    scale = motion.scale or film.scale
    source = motion if "pose" in motion.natural._asked.want else motion.wanting("pose")
    natural, begin = seconds / float(scale.seconds(1.0)), source.natural._asked.t0
    inside = natural >= begin
    times = np.unique(np.r_[begin, natural[inside]])
    m = with_numbers(source, {}, times).motion
    rows = np.searchsorted(times, natural[inside])
    rows, seen = rows[rows < m.t.size], np.flatnonzero(inside)[rows < m.t.size]
    phi, theta = (np.full(seconds.size, np.nan) for _ in range(2))
    path = np.full(seconds.size, complex(np.nan, np.nan))
    phi[seen], theta[seen] = m.phi[rows], m.theta[rows]
    path[seen] = scale.metres(1.0) * (m.centre[rows, 0] + 1j * m.centre[rows, 1])
    return At(m, theta, phi, path)


def in_film(found: FilmComparison, seconds: Floats) -> At:
    """Compute the motion of a comparison at any times, in seconds, in the coordinates of the film."""
    at = motion_at(found.motion, found.film, seconds)
    if found.mirrored:
        at = at._replace(phi=-at.phi, path=at.path.conj())
    path = complex(*found.place) + at.path * np.exp(1j * found.phi0)
    return at._replace(phi=at.phi + found.phi0, path=path)


def _placed(film: Filmed, phi: Floats, path: Any, error: Floats) -> tuple[float, complex]:
    """Angle and place (x + iy) by which a computed path is turned and moved to fit that in a film.

    The direction leaves open which end of the tube is the upper one. Of the two angles, the one that brings
    the path of the centre nearer to that of the film is taken.
    """
    seen = np.isfinite(path)
    off = (film.direction - phi)[seen]
    weight = film.line[seen] ** 2
    phi0 = math.remainder(float(np.sum(weight * off) / np.sum(weight)), 2 * math.pi)
    where = film.marks.mean(axis=1)[seen] @ np.array([1.0, 1j])
    weight = 1 / error[seen] ** 2
    found = []
    for angle in (phi0, math.remainder(phi0 + math.pi, 2 * math.pi)):
        rest = where - path[seen] * np.exp(1j * angle)
        place = complex(np.sum(weight * rest) / np.sum(weight))
        found.append((float(np.sum(weight * np.abs(rest - place) ** 2)), angle, place))
    _, angle, place = min(found, key=lambda one: one[0])
    return angle, place
