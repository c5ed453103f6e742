"""The command `drift`: the slow passage through steady states of a body that loses energy."""

import math
import sys
import warnings
from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import spincyl
from spincyl import Scale
from spincyl._input.numbers import Floats, optional_library
from spincyl._input.units import angle, whole_text
from spincyl.cli._commands import body_of
from spincyl.cli._files import needed, write_csv
from spincyl.cli._losses import TEXT as LAWS
from spincyl.cli._losses import losses_of, option
from spincyl.cli._output import Working, writable
from spincyl.cli._tell import Row, body_numbers, print_json, table

TEXT = f"""\
Compute how a body that loses energy slowly drifts through steady states, and when and where it stops.

There are two kinds of drift. With --centre rest, slip keeps the centre at rest, and the body passes through
the steady states of Jackson et al. 2019, whose centre is at rest. With --centre rolling, the body never
slips, and its centre moves on growing circles; the table gives the coefficient of friction that this needs.

{LAWS}

"""

EXAMPLES = """\
spincyl drift --outer 75mm --length 12.8mm --mass 440g --theta 0.3 --law rolling-resistance=0.02mm
spincyl drift --ell 0.1704 --theta 0.3 --law dry-contour=5e-3 --centre rolling -o whirr.csv
spincyl drift --ell 6 --bore 0.8 --theta 85deg --law dry-contour=1e-3 --law air-quadratic=1e-3 -o fall.png"""

_PRINTED_ROWS = 11


def drift_options(sub: ArgumentParser) -> None:
    """Add the options for the initial state, the losses and the output of a drift."""
    how = sub.add_argument_group("the drift")
    how.add_argument("--theta", type=angle, required=True, metavar="ANGLE", help="initial inclination")
    option(how, "--law", required=True)
    how.add_argument(
        "--centre",
        choices=("rest", "rolling"),
        default="rest",
        help="slip keeps the centre at rest (default), or the body rolls without slip",
    )
    how.add_argument(
        "--points", type=whole_text, help=f"number of rows (default {_PRINTED_ROWS}, in a file 401)"
    )
    how.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help="output file: table (.csv) or picture (.png, .pdf, .svg); - writes CSV to standard output",
    )


def drift(args: Namespace) -> None:
    """Compute a drift; print a summary, and write a file if -o is given."""
    body, scale = body_of(args)
    if args.points is not None and args.points < 2:
        raise ValueError(f"--points {args.points}: expected at least 2")
    suffix = _suffix_of_output(args.output)
    losses: Any = losses_of(args, scale)  # at least one is required
    with warnings.catch_warnings(record=True) as caught, Working("drift"):
        warnings.simplefilter("always", UserWarning)
        found: Any = spincyl.drift(body, args.theta, losses, centre=args.centre)
        columns = _columns(
            found, args.theta, scale, args.points or (_PRINTED_ROWS if suffix is None else 401)
        )
        rows = list(_rows(found, losses, args.centre, scale))
        shown = columns if suffix is None else _columns(found, args.theta, scale, _PRINTED_ROWS)
        if suffix == ".csv":
            write_csv(columns, Path(args.output))
        elif suffix in _PICTURES:
            _draw_drift(
                spincyl.drift(replace(body, scale=scale), args.theta, losses, centre=args.centre), args
            )
    # drop warnings about single times: the user did not choose the rows of the table
    messages = (str(warning.message) for warning in caught if "evaluated there" not in str(warning.message))
    for message in dict.fromkeys(messages):
        print(f"spincyl drift: {message}", file=sys.stderr)
    if args.json:
        told = {"body": body_numbers(body, scale), "losses": repr(losses), "centre": args.centre}
        print_json(told | _numbers(found, scale) | {"columns": columns})
        return
    said = sys.stderr if suffix == "-" else sys.stdout  # only the table goes into a pipe
    print(f"{body!r}", file=said)
    table(iter(rows), said)
    if suffix == "-":
        write_csv(columns, sys.stdout)
        return
    print()
    _print(shown)
    if suffix is not None:
        print(f"{len(columns['theta'])} rows in {args.output}")


_PICTURES = ".png", ".pdf", ".svg"


def _suffix_of_output(output: str | None) -> str | None:
    """The kind of output, by suffix; an error before any work if it is unknown or cannot be written."""
    if output is None or output == "-":
        return output
    suffix = Path(output).suffix.lower()
    if suffix not in (".csv", *_PICTURES):
        raise ValueError(f"-o {output}: expected a name that ends in .csv, {', '.join(_PICTURES)}, or -")
    needed(suffix)
    writable(output)
    return suffix


def _columns(found: Any, theta: float, scale: Scale | None, count: int) -> dict[str, Floats]:
    """Columns of a drift: `count` rows at equal steps of inclination, from the initial state to the end."""
    tilt = np.linspace(theta, float(found.ends_at_theta), count)
    t = np.append(found.time(tilt[:-1]), float(found.stops_at))  # inf if the end is only a limit
    rate = np.asarray(found.precession(t), np.float64)
    rate[-1] = np.inf if float(tilt[-1]) == 0.0 else rate[-1]  # a face that lands, according to this drift
    told = {"theta": tilt, "precession": rate, "t": t}
    if scale is not None:
        told |= {"hertz": scale.turns(told["precession"]), "seconds": scale.seconds(t)}
    return told


def _numbers(found: Any, scale: Scale | None) -> dict[str, Any]:
    """Time and inclination of the end of a drift, as numbers for JSON."""
    told = {name: float(getattr(found, name)) for name in ("stops_at", "ends_at_theta", "stable_until")}
    told["friction_coefficient"] = float(found.friction_coefficient(0.0))
    if scale is not None:
        told["stops_at_seconds"] = float(scale.seconds(told["stops_at"]))
    return {"ended": str(found.ended)} | told


def _rows(found: Any, losses: Any, centre: str, scale: Scale | None) -> Iterator[Row]:
    """Time and inclination of the end of a drift, as rows of a table."""
    n = _numbers(found, scale)
    yield "losses", repr(losses), ""
    yield "centre", {"rest": "kept at rest", "rolling": "on circles: rolling without slip"}[centre], ""
    end = n["ends_at_theta"]
    yield "ends", f"{n['ended']}, theta = {end:.9g} rad", f"{math.degrees(end):.6f} deg"
    if math.isfinite(n["stops_at"]):
        seconds = "" if scale is None else f"{n['stops_at_seconds']:.6g} s"
        yield "stops at", f"t = {n['stops_at']:.12g}", seconds
    else:
        yield "stops at", "never", ""
    if math.isfinite(n["stable_until"]):
        seconds = "" if scale is None else f"{scale.seconds(n['stable_until']):.6g} s"
        yield "stable until", f"t = {n['stable_until']:.12g}", seconds
    if centre == "rolling":
        yield "friction coefficient", f"{n['friction_coefficient']:.6g} needed at the start", ""


def _print(columns: dict[str, Floats]) -> None:
    """Print the table of a drift."""
    heads = {"theta": "theta (rad)", "precession": "Omega", "t": "time", "hertz": "turns/s", "seconds": "s"}
    print("  " + "".join(f"{heads[name]:>16}" for name in columns))
    for row in zip(*columns.values(), strict=True):
        print("  " + "".join(f"{x:>16.9g}" for x in row))


def _draw_drift(found: Any, args: Namespace) -> None:
    """Draw inclination and precession rate against time."""
    optional_library("matplotlib", "plot").use("agg")
    from spincyl.studio.plot._style import saved

    figure: Any = found.plot().figure
    saved(figure, Path(args.output))
