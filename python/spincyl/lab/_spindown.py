"""A measured spin-down: its columns and errors, and checks before anything is fitted."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from spincyl._body import Body
from spincyl._contact import CODES
from spincyl._input.numbers import Floats, Reals, is_scalar, number, one_of, radians_per_second, reals, si
from spincyl.lab._curve import branches, goes_down
from spincyl.studio.shape import steepest

LAWS = tuple(CODES["Law"])
CENTRES = ("rest", "rolling")
_FIRST_ERROR = 0.01  # first guess of the relative error of values


class Several(ValueError):
    """Error about a measured spin-down that may start from several inclinations."""


class SpinDown(NamedTuple):
    """Measured columns and errors in natural units, and the range of inclinations of the drift."""

    t: Floats  #: (n,)
    t_err: Floats  #: (n,) all zero if times are exact
    names: tuple[str, ...]  #: the measured ones of "theta" and "precession"
    values: Floats  #: (rows, n); NaN where nothing was measured
    errors: Floats  #: (rows, n)
    estimated: tuple[str, ...]  #: names of rows whose errors are estimated from the scatter
    near: Floats  #: (n,) approximate inclinations; from the precession where theta was not measured
    ends: tuple[float, float]  #: least and greatest first inclination
    down: bool  #: whether the drift goes to smaller inclinations

    @property
    def clock(self) -> Floats:
        """Times since the first time.

        They are rounded to 1e-12 of the duration, so that the rounding of times far from the origin, which
        some fits amplify, does not matter.
        """
        after: Floats = self.t - self.t[0]
        digit = 2.0 ** (math.floor(math.log2(float(after[-1]))) - 40)
        clock: Floats = np.round(after / digit) * digit
        return clock

    @property
    def numbers(self) -> int:
        """Number of measured values, without times."""
        return int(np.isfinite(self.values).sum())

    def off_by(self, body: Body) -> float:
        """Median ratio of measured to steady precession at the same inclinations; 1 if either is unknown."""
        both = np.isfinite(self.values).all(axis=0)
        if len(self.names) < 2 or not both.any():
            return 1.0
        theta, precession = self.values[:, both]
        return float(np.median(precession / np.asarray(body.steady(np.clip(theta, *self.ends)).precession)))

    def weighed(self, shown: Floats, parameters: int) -> "SpinDown":
        """The spin-down with errors estimated from the scatter about a fitted drift."""
        errors = self.errors.copy()
        for row, name in enumerate(self.names):
            if name in self.estimated:
                off = (self.values[row] / shown[row] - 1)[np.isfinite(self.values[row])]
                freedom = max(off.size - parameters / len(self.names), 1.0)
                # exact points also need an error
                share = max(float(np.sqrt(off @ off / freedom)), 1e-12)
                errors[row] = share * np.abs(shown[row])
        return self._replace(errors=errors)


def centres(centre: str | None) -> tuple[str, ...]:
    """The kinds of drift to fit: the given one, or both "rest" and "rolling"."""
    return CENTRES if centre is None else (one_of("centre", centre, CENTRES),)


def known_laws() -> list[Any]:
    """All classes of loss laws."""
    from spincyl import loss

    return [getattr(loss, name) for name in LAWS]


def known_law(name: str, law: Any) -> Any:
    """Return `law` if it is a class of loss laws, else raise a TypeError about the argument `name`."""
    if not any(law is one for one in known_laws()):
        raise TypeError(f"{name}: expected a class of sc.loss such as sc.loss.DryContour, not {law!r}")
    return law


def asked(laws: Sequence[Any] | None) -> list[tuple[Any, ...]]:
    """The laws to fit, each as a tuple of one class, or of two classes whose laws are added."""
    known = known_laws()
    if laws is None:
        return [(law,) for law in known]
    if isinstance(laws, str | type) or not isinstance(laws, Sequence):
        raise TypeError(f"laws: expected a list of laws such as [sc.loss.DryContour], not {laws!r}")
    found = [tuple(law) if isinstance(law, tuple | list) else (law,) for law in laws]
    for law in found:
        for one in law:
            known_law("laws", one)
        if not 1 <= len(law) <= 2 or len(set(law)) < len(law):
            names = ", ".join(one.__name__ for one in law)
            raise ValueError(f"laws: expected one law, or a sum of two different ones, not ({names})")
    if not found or len({frozenset(law) for law in found}) < len(found):
        raise ValueError("laws: expected at least one law, and each law only once")
    return found


def measured(
    body: object,
    t: Reals,
    theta: Reals | None,
    precession: Reals | None,
    *,
    t_err: Reals | None,
    theta_err: Reals | None,
    precession_err: Reals | None,
    centre: str,
    start: float | None,
    laws: int,
) -> SpinDown:
    """The measured spin-down without missing points; errors name the argument at fault."""
    if not isinstance(body, Body):
        raise TypeError(f"body: expected a Body, not {type(body).__name__}")
    if not is_scalar(*body._numbers):
        raise ValueError("body: expected a single body, not a family")
    if body.scale is not None:
        t, t_err = si("t", t, "second"), None if t_err is None else si("t_err", t_err, "second")
        precession = None if precession is None else radians_per_second("precession", precession)
        precession_err = (
            None if precession_err is None else radians_per_second("precession_err", precession_err)
        )
    given = {"theta": (theta, theta_err), "precession": (precession, precession_err)}
    for name, (values, errors) in given.items():
        if values is None and errors is not None:
            raise ValueError(f"{name}_err: give {name} as well")
    names = tuple(name for name, (values, _) in given.items() if values is not None)
    if not names:
        raise ValueError("theta, precession: give at least one of them")
    time = np.asarray(reals("t", t), np.float64)
    if time.ndim != 1:
        raise ValueError(f"t: expected shape (n,), not {time.shape}")
    rows, errs = [], []
    for name in names:
        row = np.asarray(reals(name, given[name][0]), np.float64)
        if row.shape != time.shape:
            raise ValueError(f"{name}: expected the shape of t, {time.shape}, not {row.shape}")
        bad = np.flatnonzero(np.isinf(row) | (row <= 0))
        if bad.size:
            told = (
                f"{name}[{bad[0]}] = {row[bad[0]]:.6g}: expected a positive number, or NaN if it is missing"
            )
            late = bad[0] >= row.size / 2 and -np.inf < row[bad[0]] <= 0
            hint = "; noise near the end? Leave out the last points, or set them to NaN" if late else ""
            raise ValueError(told + hint)
        rows.append(row)
        errs.append(_errors(f"{name}_err", given[name][1], time, _FIRST_ERROR * row))
    values, errors = np.stack(rows), np.stack(errs)
    times = _errors("t_err", t_err, time, np.zeros_like(time))
    if theta is not None:
        leaning("theta", rows[0], body)
    if np.isinf(time).any():
        raise ValueError("t: expected finite times, or NaN for missing ones")
    seen = np.isfinite(time) & np.isfinite(values).any(axis=0)
    time, times, values, errors = time[seen], times[seen], values[:, seen], errors[:, seen]
    least = 4 + laws
    different = len(np.unique(time))
    if different < least:
        raise ValueError(f"t: expected at least {least} points at different times, not {different}")
    if (np.diff(time) < 0).any():
        at = float(time[1:][np.diff(time) < 0][0])
        raise ValueError(
            f"t: expected times in ascending order; they fall to {at:.6g}: sort the points with np.argsort(t)"
        )
    errors = np.where(np.isfinite(values), errors, 1.0)
    if body.scale is not None:
        second = body.scale.seconds(1.0)
        turning = [name == "precession" for name in names]
        time, times = time / second, times / second
        values[turning], errors[turning] = values[turning] * second, errors[turning] * second
    estimated = tuple(name for name in names if given[name][1] is None)
    rises = {name: _rises(name, time, row) for name, row in zip(names, values, strict=True)}
    columns = dict(zip(names, values, strict=True))
    near, ends, down = _first_inclinations(body, columns, rises, centre, start)
    return SpinDown(time, times, names, values, errors, estimated, near, ends, down)


def leaning(name: str, theta: Floats, body: Body) -> None:
    """Raise ValueError for inclinations outside the body's range, such as degrees; NaN is allowed."""
    known = theta[np.isfinite(theta)]
    if not ((known > 0) & (known <= steepest(body))).all():
        degrees = (known > 0).all() and known.max() <= math.degrees(steepest(body))
        hint = "; these look like degrees: give np.radians(theta)" if degrees else ""
        raise ValueError(f"{name}: expected inclinations in {_range_in_words(body)}, in radians{hint}")


def _range_in_words(body: Body) -> str:
    """The range of inclinations of a body's steady states, in words."""
    named = {math.pi / 2: "pi/2", math.pi: "pi"}
    most = steepest(body)
    return f"(0, {named.get(most, f'{most:.6g}')}]"


def _errors(name: str, given: Reals | None, t: Floats, default: Floats) -> Floats:
    if given is None:
        return default
    found = np.asarray(reals(name, given), np.float64)
    if found.shape not in ((), t.shape):
        raise ValueError(f"{name}: expected a number or shape {t.shape}, not {found.shape}")
    if not ((found > 0) & np.isfinite(found)).all():
        raise ValueError(f"{name}: expected positive numbers")
    return np.array(np.broadcast_to(found, t.shape))


def _rises(name: str, t: Floats, values: Floats) -> bool:
    """Whether values rise, by rank correlation; ValueError if they neither rise nor fall."""
    seen = np.isfinite(values)
    if np.ptp(values[seen]) == 0:
        raise ValueError(f"{name}: expected values that change with t; all are {values[seen][0]:.6g}")
    correlation = float(np.corrcoef(_ranks(t[seen]), _ranks(values[seen]))[0, 1])
    if not abs(correlation) > 0.5:
        raise ValueError(
            f"{name}: expected values that rise or fall with t; their rank correlation with t,"
            f" {correlation:.2f}, is between -0.5 and 0.5"
        )
    return correlation > 0


def _ranks(values: Floats) -> Floats:
    """The rank of each value, from 1; equal values have the mean of their ranks."""
    _, places, counts = np.unique(values, return_inverse=True, return_counts=True)
    found: Floats = (np.cumsum(counts) - (counts - 1) / 2.0)[places]
    return found


def _first_inclinations(
    body: Body, columns: dict[str, Floats], rises: dict[str, bool], centre: str, start: float | None
) -> tuple[Floats, tuple[float, float], bool]:
    """Approximate inclinations, the ends of their range of steady states, and whether they decrease."""
    pieces = branches(body, centre)
    if start is not None and not 0 < number("start", start) <= steepest(body):
        raise ValueError(f"start = {start!r}: expected an inclination in {_range_in_words(body)}, in radians")
    theta = columns.get("theta")
    if theta is not None:
        known = theta[np.isfinite(theta)]
        forbidden = known[~np.isfinite(np.asarray(body.rate(known)))]
        if forbidden.size:
            raise ValueError(
                f"theta: {forbidden[0]:.4g} rad lies in the forbidden band, which has no steady states"
            )
        inside = [int(((known >= p[0]) & (known <= p[-1])).sum()) for p in pieces]
        if not pieces or max(inside) < known.size / 2:
            middle = float(np.median(known))
            raise ValueError(f"theta: no drift with centre = {centre!r} passes {middle:.4g} rad")
        piece = pieces[int(np.argmax(inside))]
        down = goes_down(body, centre, float(np.clip(known[0], piece[1], piece[-2])))
        if rises["theta"] == down:
            way = ("rises", "smaller") if down else ("falls", "larger")
            raise ValueError(
                f"theta: {way[0]}, but with centre = {centre!r} a body that loses energy drifts to {way[1]}"
                " inclinations"
            )
        near = theta
        if "precession" in columns and not np.isfinite(theta).all():
            precession = columns["precession"]
            order = np.argsort(np.asarray(body.steady(piece).precession))
            from_precession = np.interp(
                precession, np.asarray(body.steady(piece).precession)[order], piece[order]
            )
            near = np.where(np.isfinite(theta), theta, from_precession)
    else:
        near, piece, down = _from_precession(
            body, columns["precession"], rises["precession"], pieces, centre, start
        )
    least, greatest = float(piece[0]), float(piece[-1])
    known = near[np.isfinite(near)]
    if centre == "rest":  # one drift serves all first inclinations: begin it beyond all of them
        beyond = 1.3 * float(known.max()) if down else 0.7 * float(known.min())
        least, greatest = (least, min(greatest, beyond)) if down else (max(least, beyond), greatest)
    return np.clip(near, least, greatest), (least, greatest), down


def _from_precession(
    body: Body, precession: Floats, rises: bool, pieces: list[Floats], centre: str, start: float | None
) -> tuple[Floats, Floats, bool]:
    """Inclinations that have this precession, on a branch where the loss changes it in the measured sense."""
    found = []
    for piece in pieces:
        steady = np.asarray(body.steady(piece).precession)
        way = np.sign(np.diff(steady))
        for stretch in np.split(np.arange(way.size), np.flatnonzero(np.diff(way)) + 1):
            if stretch.size < 4:
                continue
            part = np.r_[stretch, stretch[-1] + 1]
            order = part[np.argsort(steady[part])]
            inside = (precession >= steady[order[0]]) & (precession <= steady[order[-1]])
            if np.nanmean(inside) < 0.8:
                continue
            near = np.interp(precession, steady[order], piece[order])
            down = goes_down(body, centre, float(np.clip(near[np.isfinite(near)][0], piece[1], piece[-2])))
            if (way[stretch[0]] > 0) != (down == rises):
                found.append((near, piece, down))
    if not found:
        unit = "sqrt(g/R)" if body.scale is None else "rad/s"
        raise ValueError(f"precession: no drift of this body has these values; is precession in {unit}?")
    if start is not None:
        return min(found, key=lambda f: abs(float(f[0][0]) - start))
    if len(found) > 1:
        several = " or ".join(f"{float(f[0][0]):.3g}" for f in found)
        raise Several(
            f"precession: the drift may start at {several} rad; give theta=, or the right one as start="
        )
    return found[0]
