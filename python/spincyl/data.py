"""Measured data: tables that Tracker exports, and how far a body's steady states are from them."""

import csv
import math
import warnings
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from spincyl import _core
from spincyl._array import Floats, Reals, extra, is_scalar, reals
from spincyl._body import Body
from spincyl._state import State

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: What Tracker separates columns with; spaces last, since names have them.
_DELIMITERS = ("\t", ";", ",", None)


def read_tracker(path: str | PathLike[str]) -> dict[str, dict[str, Floats]]:
    """The tracks of a text file that Tracker exported (File > Export > Data).

    Parameters
    ----------
    path : path
        One track (its name, a line of column names, numbers) or several ("#multi:", names above their
        columns). Separated by tabs, semicolons, commas or spaces, decimal point or comma: found out.

    Returns
    -------
    dict
        By track, by column: arrays of numbers of one length, NaN where a cell is empty. Columns before the
        first name of a track, such as t, belong to every one. A track without a name is called "track".

    Raises
    ------
    ValueError
        If it is no such table, naming the file and the line.
    OSError
        If it cannot be read.

    Notes
    -----
    Tracker is the video analysis tool of Open Source Physics. Angles are in the unit that was chosen there.
    """
    path = Path(path)
    text = _decoded(path.read_bytes())
    lines = [(i, line) for i, line in enumerate(text.splitlines(), 1) if line.strip()]
    several = [line for _, line in lines if _is_marker(line)]
    lines = [(i, line) for i, line in lines if not _is_marker(line)]
    why = ""
    for delimiter in _DELIMITERS:
        for comma in (False, True):
            if comma and delimiter == ",":
                continue
            rows = [(i, _cells(line, delimiter, comma)) for i, line in lines]
            first = next((k for k, (_, cells) in enumerate(rows) if _numbers(cells) is not None), None)
            if not first or len(rows[first - 1][1]) < 2:
                continue
            above = rows[first - 2][1] if first > 1 else []
            if not several and (delimiter is None or (first > 1 and not _over(above, rows[first - 1][1]))):
                # a name, whatever is in it
                above = [lines[first - 2][1].strip()] if first > 1 else []
            try:
                if several and delimiter is None:
                    raise ValueError("several tracks between spaces cannot be told apart")
                return _tracks(above, rows[first - 1][1], rows[first:])
            except ValueError as e:
                why = why or str(e)
    why = why or "no line of column names right above a line of numbers"
    raise ValueError(f"{path}: not a table of Tracker's: {why}")


def _is_marker(line: str) -> bool:
    return line.strip(" #;,\t").lower() == "multi:"


def _over(names: list[str], columns: list[str]) -> bool:
    """Whether names stand above columns: with gaps, since a track has more than one."""
    return len(names) > 1 and "" in names and len(names) <= len(columns)


def _decoded(raw: bytes) -> str:
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return raw.decode("utf-16")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace")


def _cells(line: str, delimiter: str | None, comma: bool) -> list[str]:
    """The cells of a line, decimal commas made points, without empty ones at the end."""
    split = line.split() if delimiter is None else next(csv.reader([line], delimiter=delimiter))
    cells = [cell.strip() for cell in split]
    while cells and not cells[-1]:
        cells.pop()
    if comma:
        cells = [cell.replace(",", ".") if cell.count(",") == 1 else cell for cell in cells]
    return cells


def _numbers(cells: list[str]) -> list[float] | None:
    """The numbers of a row, NaN for an empty cell; None if something else is there."""
    try:
        found = [float(cell) if cell else math.nan for cell in cells]
    except ValueError:
        return None
    wrong = any("_" in cell for cell in cells) or any(map(math.isinf, found))
    return found if any(cells) and not wrong else None


def _tracks(
    above: list[str], columns: list[str], rows: list[tuple[int, list[str]]]
) -> dict[str, dict[str, Floats]]:
    table = np.full((len(rows), len(columns)), math.nan)
    for k, (i, cells) in enumerate(rows):
        numbers = _numbers(cells)
        if numbers is None:
            raise ValueError(f"line {i} has something that is no number")
        if len(numbers) > len(columns):
            raise ValueError(f"line {i} has {len(numbers)} cells under {len(columns)} column names")
        table[k, : len(numbers)] = numbers
    names = [name.lstrip("#").strip() for name in above]
    # a name alone is that of the only track
    starts = [(k if len(names) > 1 else 0, name) for k, name in enumerate(names) if name] or [(0, "track")]
    shared = range(starts[0][0])
    found = {}
    for (start, name), (stop, _) in zip(starts, [*starts[1:], (len(columns), "")], strict=True):
        own = [*shared, *range(start, stop)]
        if name in found:
            raise ValueError(f"two tracks are called {name!r}")
        if len({columns[k] for k in own}) < len(own):
            raise ValueError(f"two columns of {name!r} have one name")
        found[name] = {columns[k]: table[:, k] for k in own}
    return found


class Comparison(NamedTuple):
    """Measured inclinations and rates beside a body's steady states; from `compare`."""

    body: Body
    theta: Floats  #: (n,) measured, radians, without what was not measured
    rate: Floats  #: (n,) measured reduced rates
    theta_err: Floats  #: (n,) standard errors
    rate_err: Floats
    residual: Floats  #: (n,) measured rate less that of the body; NaN where it is forbidden
    ratio: float  #: the inertia ratio I1/I3 that fits best
    ratio_err: float  #: its standard error
    expected: float  #: the body's own
    chi2: float  #: sum of squares over the errors, per degree of freedom

    def __repr__(self) -> str:
        return (
            f"<Comparison: I1/I3 = {self.ratio:.6g} +- {self.ratio_err:.2g}, built {self.expected:.6g};"
            f" {len(self.theta)} points, chi2 {self.chi2:.3g}>"
        )

    @property
    def fitted(self) -> Body:
        """The body with the fitted ratio, at least the 1/2 of a real one, its axial moment kept."""
        return Body(self.body.ell, max(self.ratio, 0.5) * self.body.i3, self.body.i3)

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """Draw the measurement with its error bars, the body's branches and the fitted ones."""
        from spincyl.plot import comparison

        return comparison(self, ax)


def compare(
    body: Body,
    theta: Reals,
    rate: Reals,
    *,
    theta_err: Reals | None = None,
    rate_err: Reals | None = None,
) -> Comparison:
    """How well a body's steady states explain a measurement, and which inertia ratio explains it best.

    Parameters
    ----------
    body : Body
        What is believed: aspect ratio and moments. A single one.
    theta : array_like, 1-D
        Inclinations in radians.
    rate : array_like, 1-D
        Reduced rates: turns per second over `scale.hertz(body, 1.0)`.
    theta_err, rate_err : array_like, optional
        Standard errors, both or none. Without, points are weighed by a degree and two per cent, and their
        scatter gives the error of the ratio.

    Returns
    -------
    Comparison

    Raises
    ------
    ValueError
        For fewer than three different points, shapes that differ, rates and errors that are not positive, a
        fit that fails, and points that say nothing of the ratio.
    TypeError
        For anything but a body and real numbers.
    ImportError
        Without spincyl[lab].

    Warns
    -----
    UserWarning
        If chi2 exceeds 10.

    Notes
    -----
    Orthogonal distance regression (Boggs and Donaldson 1989) by odrpack: both errors count, and the curve is
    the implicit one on which theta'' vanishes, so that forbidden bands and folds do no harm. Points with an
    empty theta or rate are left out.

    Examples
    --------
    >>> import numpy as np
    >>> import spincyl as sc
    >>> body = sc.Body.solid(2.5)
    >>> theta = np.radians([5.0, 10.0, 15.0, 70.0, 80.0])
    >>> found = sc.data.compare(body, theta, body.rate(theta))
    >>> round(found.ratio, 6), round(body.i1 / body.i3, 6)
    (4.666667, 4.666667)
    """
    if not isinstance(body, Body):
        raise TypeError(f"body: expected a Body, not {type(body).__name__}")
    if not is_scalar(body.ell, body.i1, body.i3):
        raise ValueError("body: expected a single one, not an array of them")
    odrpack = extra("odrpack", "lab")
    x = {name: np.asarray(reals(name, v), np.float64) for name, v in (("theta", theta), ("rate", rate))}
    if x["theta"].ndim != 1 or x["rate"].shape != x["theta"].shape:
        shapes = f"{x['theta'].shape} and {x['rate'].shape}"
        raise ValueError(f"theta and rate: expected one shape (n,), not {shapes}")
    measured = np.isfinite(x["theta"]) & np.isfinite(x["rate"])
    known = theta_err is not None
    if known != (rate_err is not None):
        raise ValueError("theta_err and rate_err: give both or none")
    default = {"theta_err": np.radians(1.0), "rate_err": 0.02 * x["rate"]}
    for name, given in (("theta_err", theta_err), ("rate_err", rate_err)):
        errors = np.asarray(default[name] if given is None else reals(name, given), np.float64)
        if errors.shape not in ((), x["theta"].shape):
            raise ValueError(f"{name}: expected a number or shape {x['theta'].shape}, not {errors.shape}")
        x[name] = np.broadcast_to(errors, x["theta"].shape)
    x = {name: values[measured] for name, values in x.items()}
    if not ((x["theta"] > 0) & (x["theta"] <= np.pi / 2)).all():
        raise ValueError("theta: expected inclinations in (0, pi/2], in radians")
    if not ((x["rate"] >= 1e-6) & (x["rate"] <= 1e6)).all():
        raise ValueError("rate: expected reduced rates from 1e-6 to 1e6")
    for name, of in (("theta_err", 1.0), ("rate_err", x["rate"])):
        if not ((x[name] >= 1e-12 * of) & (x[name] <= 1e3 * of)).all():
            raise ValueError(f"{name}: expected positive numbers, 1e-12 to 1e3 of a radian or of the rate")
    if len(np.unique(np.stack([x["theta"], x["rate"]]), axis=1).T) < 3:
        raise ValueError("theta and rate: expected at least three different points")
    ell, i3 = float(body.ell), float(body.i3)

    sigma = np.stack([x["theta_err"], x["rate_err"]])
    places = np.stack([x["theta"], x["rate"]]) / sigma

    bodies = [Body(ell, ratio * i3, i3) for ratio in (1.0, 2.0)]

    def off(place: Floats, ratio: Floats) -> Floats:
        """Torque left where the centre rests, at places in units of their errors: zero on the curve."""
        inclination, rate = place * sigma
        w1 = rate / np.sqrt(i3) * np.sin(inclination)
        state = State(inclination, w1, 0.0 * w1, ell * w1)
        # theta'' times the inertia of tilting; linear in the ratio, also beyond those of real bodies
        one, two = (trial.acceleration(state) * _core.body_j(*trial._numbers) for trial in bodies)
        found: Floats = one + (ratio[0] - 1) * (two - one)
        return found

    own = np.array([float(body.i1) / i3])
    # how much an error of theta and of the rate change it: odrpack enforces the curve by a penalty, and
    # converges where both are of one size
    sides = (off(places + d, own) - off(places - d, own) for d in np.eye(2)[..., np.newaxis])
    size = np.hypot(*sides) / 2 + 1e-300
    step = 1e-4 * own
    told = (off(places, own + step) - off(places, own - step)) / (2 * step * size)
    if not np.linalg.norm(told) * own > 1:
        raise ValueError("theta and rate: these points say nothing of I1/I3, as near 90 degrees")
    found = odrpack.odr_fit(
        lambda place, ratio: off(place, ratio) / size,
        places,
        np.zeros_like(size),
        own,
        task="implicit-ODR",
        diff_scheme="central",
        maxit=200,
    )
    freedom = len(x["theta"]) - 1
    chi2 = float(found.sum_square_delta) / freedom
    ratio = float(found.beta[0])
    error = math.sqrt(float(found.cov_beta[0, 0]) * (1.0 if known else chi2))
    # of a real body, I3 is at most 2 I1; errors may make it look like a little more
    if not found.success or not ratio + 5 * error >= 0.5:
        raise ValueError(f"no real body fits: I1/I3 = {ratio:.3g}; is rate in units of scale.hertz(body, 1)?")
    if chi2 > 10:
        warnings.warn(
            f"chi2 = {chi2:.3g}: no inertia ratio explains these points within their errors;"
            " is rate in units of scale.hertz(body, 1)?",
            UserWarning,
            stacklevel=2,
        )
    return Comparison(
        body=body,
        theta=x["theta"],
        rate=x["rate"],
        theta_err=x["theta_err"],
        rate_err=x["rate_err"],
        residual=x["rate"] - body.rate(x["theta"]),
        ratio=ratio,
        ratio_err=error,
        expected=float(own[0]),
        chi2=chi2,
    )
