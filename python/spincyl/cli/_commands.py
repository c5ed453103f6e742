"""The commands: each is a function of its parsed options."""

import math
import re
import sys
import warnings
from argparse import Namespace
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from spincyl import Body, Motion, Scale, State, StepWarning, roll
from spincyl._contact import AnyContact, Coulomb, Viscous
from spincyl._input.files import writing_whole
from spincyl._input.numbers import in_range, optional_library
from spincyl._input.units import Metres, Seconds
from spincyl._measured import errors_in_seconds
from spincyl.cli._files import columns, needed, write_csv, writer_of
from spincyl.cli._losses import losses_of
from spincyl.cli._output import Working, folder, writable
from spincyl.cli._tell import (
    Row,
    body_numbers,
    body_rows,
    motion_numbers,
    motion_rows,
    print_json,
    state_numbers,
    state_rows,
    table,
)

_TUBE = "ell", "bore", "i1", "i3", "inner", "length", "fillet"


def _refuse_options(args: Namespace, kind: str, names: Sequence[str], why: str) -> None:
    """Raise ValueError if an option of `names` is given, which the options of this `kind` of body exclude."""
    for name in names:
        if getattr(args, name) is not None:
            raise ValueError(f"--{name} cannot be combined with {kind}: {why}")


def _ball_of(args: Namespace) -> Body:
    """Make the body that --ball or --balls describes."""
    if args.balls is not None:
        _refuse_options(
            args, "--balls", (*_TUBE, "ball"), "two balls are given by the distance of their centres"
        )
        with _errors_name_option("separation", "--balls"):
            return Body.balls(args.balls)
    _refuse_options(
        args,
        "--ball",
        [x for x in _TUBE if x not in ("i1", "i3")],
        "a ball is given by its offset and moments of inertia",
    )
    if args.i1 is None or args.i3 is None:
        raise ValueError("--ball needs both --i1 and --i3, the moments of inertia of the ball")
    with _errors_name_option("offset", "--ball"), _errors_name_option("ell", "--ball"):
        return Body.ball(args.ball, args.i1, args.i3)


@contextmanager
def _errors_name_option(name: str, option: str) -> Iterator[None]:
    """Context in which errors about an argument of the library name the option that gave it."""
    try:
        yield
    except ValueError as e:
        raise ValueError(re.sub(rf"^{name} = ", f"{option} ", str(e))) from None


def _measured(args: Namespace) -> Body:
    """Make the tube that --outer, --length and the other lengths in metres describe."""
    if args.outer is None or args.length is None:
        raise ValueError("a tube measured in metres needs both --outer and --length")
    bore = args.bore if isinstance(args.bore, Metres) else None
    told = args.ell, None if bore is not None else args.bore, args.i1, args.i3, args.radius
    if any(x is not None for x in told):
        raise ValueError(
            "with --outer and --length leave out --ell, --radius, --i1, --i3, and --bore without a unit"
        )
    if sum(x is not None for x in (bore, args.inner, args.wall)) > 1:
        raise ValueError("give only one of --inner, --bore and --wall")
    inner = args.inner if bore is None else float(bore)
    if args.wall is not None:
        with _errors_name_option("wall", "--wall"):
            inner = args.outer - 2 * in_range("wall", args.wall, 0.0, args.outer / 2, "metres")
    more = {} if inner is None else {"inner_diameter": inner}
    if args.fillet is not None:
        more["fillet"] = (
            float(args.fillet) if isinstance(args.fillet, Metres) else args.fillet * args.outer / 2
        )
    with _errors_name_option("fillet", "--fillet"):
        body = Body.from_metres(outer_diameter=args.outer, length=args.length, **more)
    why = body._doubt_of(Scale(args.outer / 2, math.nan))
    if why:
        print(f"spincyl: {why}", file=sys.stderr)
    return body


def _body_from_numbers(args: Namespace) -> Body:
    """Make the body that --ell and the other numbers in natural units describe."""
    if args.ell is None:
        raise ValueError("no body: give --ell, or --balls, or --ball, or --outer and --length")
    fillet = 0.0 if args.fillet is None else args.fillet
    if isinstance(fillet, Metres):
        raise ValueError(
            f"--fillet {fillet:g}m needs --outer and --length; with --ell give fillet / outer radius"
        )
    if isinstance(args.bore, Metres):
        raise ValueError(
            f"--bore {args.bore:g}m needs --outer and --length; with --ell give inner / outer radius"
        )
    if (args.i1 is None) != (args.i3 is None):
        raise ValueError("give both --i1 and --i3, or neither")
    if args.i1 is not None and args.bore is not None:
        raise ValueError("give either --bore or --i1 and --i3, not both")
    with _errors_name_option("fillet", "--fillet"):
        if args.i1 is None:
            return Body.tube(args.ell, args.bore or 0.0, fillet)
        return Body(args.ell, args.i1, args.i3, fillet=fillet)


def body_of(args: Namespace) -> tuple[Body, Scale | None]:
    """The body that the options describe, and its scale if the radius is known, else None."""
    radius = args.radius
    if args.outer is not None:
        if radius is not None and args.ell is None:
            raise ValueError("give either --outer or --radius, not both")
        radius = args.outer / 2
    if args.balls is not None or args.ball is not None:
        body = _ball_of(args)
    elif any(x is not None for x in (args.outer, args.inner, args.wall, args.length)):
        body = _measured(args)
    else:
        body = _body_from_numbers(args)
    if args.theta_end is not None:
        with _errors_name_option("theta_end", "--theta-end"):
            body = replace(body, theta_end=args.theta_end)
    given = {name: getattr(args, name) for name in ("mass", "gravity")}
    given = {name: x for name, x in given.items() if x is not None}
    if radius is None and given:
        raise ValueError("--mass and --gravity need --radius, or --outer and --length in metres")
    return body, None if radius is None else Scale(radius, **given)


def steady(args: Namespace) -> None:
    """Print the steady states that the options ask for, as a table or as JSON."""
    body, scale = body_of(args)
    if args.hertz and scale is None:
        raise ValueError("--hertz needs --radius, or --outer and --length in metres")
    rates = list(args.rate)
    if scale is not None:
        rates += [hertz / float(scale.hertz(body, 1.0)) for hertz in args.hertz]
    for rate in rates:
        if np.isnan(body.count(rate)):
            raise ValueError(f"rate = {rate!r}: expected 0 <= rate, (i1/i3) rate^2 <= 1e300")
    states = [(body.steady(x), f"theta = {math.degrees(x):.6g} deg") for x in args.theta]
    counts = [(rate, int(body.count(rate))) for rate in rates]
    for rate, count in counts:
        found = body.states(rate)
        for theta, w1, w3 in zip(found.theta[:count], found.w1[:count], found.w3[:count], strict=True):
            title = f"rate = {rate:.6g}, theta = {math.degrees(theta):.6f} deg"
            states.append((State(float(theta), float(w1), 0.0, float(w3)), title))
    weighed = args.mass is not None
    if args.json:
        told = [state_numbers(body, state, scale, weighed=weighed) for state, _ in states]
        asked = [{"rate": rate, "inclinations": count} for rate, count in counts]
        print_json({"body": body_numbers(body, scale), "rates": asked, "states": told})
        return
    print(f"{body!r}")
    table(body_rows(body, scale))
    for rate, count in counts:
        print(f"\nrate {rate:.6g}: {count} steady inclination{'' if count == 1 else 's'}")
    for state, title in states:
        print(f"\n{title}")
        table(state_rows(body, state, scale, weighed=weighed))


def portrait(args: Namespace) -> None:
    """Write the map of steady states with the centre at rest, as a picture or as data."""
    if not 2 <= args.points <= 100_000:
        raise ValueError(f"--points {args.points}: expected 2 to 100000")
    if not args.ell_max > 0:
        raise ValueError(f"--ell-max {args.ell_max}: expected a positive number")
    with _errors_name_option("fillet", "--fillet"):
        Body.tube(args.ell_max, args.bore, args.fillet)
    suffixes = (".png", ".pdf", ".svg", ".nc", "-")
    suffix = args.output if args.output == "-" else Path(args.output).suffix.lower()
    if suffix not in suffixes:
        raise ValueError(f"-o {args.output}: expected a name that ends in {', '.join(suffixes[:-1])}, or -")
    needed(suffix)
    if suffix != "-":
        writable(args.output)
    from spincyl import sweep

    theta = np.linspace(0, np.pi / 2, args.points + 1)[1:]
    ell = np.linspace(args.fillet, args.ell_max, args.points)
    want = ("region",) if suffix in suffixes[:3] else ("rate", "kappa_rolling", "kappa_smooth", "region")
    with Working("portrait") as working:
        data = sweep.portrait(theta, ell, args.bore, args.fillet, want=want, progress=working)
        if suffix == ".nc":
            with writing_whole(args.output) as part:
                data.to_netcdf(part)
        elif suffix != "-":
            _draw_map(data, args)
    if suffix != "-":
        print(f"{args.points**2:,} points in {args.output}")
    elif args.json:
        arrays = {name: data[name].values for name in ("theta", "ell", *want)}
        print_json({"bore": args.bore, "fillet": args.fillet, "columns": arrays})
    else:
        axes = np.meshgrid(theta, ell, indexing="ij")
        told = dict(zip(("theta", "ell"), axes, strict=True))
        write_csv(told | {name: data[name].values for name in want}, sys.stdout)


def _draw_map(data: Any, args: Namespace) -> None:
    from spincyl import plot
    from spincyl.studio.plot._style import saved

    optional_library("matplotlib", "plot").use("agg")
    plt: Any = optional_library("matplotlib.pyplot", "plot")
    figure, ax = plt.subplots(figsize=(9, 6.4), layout="constrained")
    plot.portrait(data, contact=args.contact, ax=ax)
    saved(figure, Path(args.output), slide=args.slides)
    plt.close(figure)


def figures(args: Namespace) -> None:
    """Draw the figures of a lecture as files in a folder, and print their paths."""
    optional_library("matplotlib", "plot").use("agg")
    from spincyl import plot

    place = folder(args.folder)
    with Working("figures") as working:
        paths = plot.figures(place, suffix=args.suffix, slides=args.slides, progress=working)
    for path in paths:
        print(path)


def _start(args: Namespace, body: Body) -> State:
    speeds = args.w1, args.w2, args.w3
    if all(w is None for w in speeds):
        start = body.steady(args.theta)
    else:
        start = State(args.theta, *(w or 0.0 for w in speeds))
    return replace(start.kicked(args.kick), slip=args.slip)


def coulomb(args: Namespace, scale: Scale | None) -> Coulomb:
    """Coulomb friction from --mu, --static, --patch and --face, in natural units."""
    patch = 0.0 if args.patch is None else args.patch
    if isinstance(patch, Metres):
        if scale is None:
            raise ValueError(f"--patch {float(patch):g}m needs --radius, or --outer and --length in metres")
        patch = float(patch) / scale.metres(1.0)
    with _errors_name_option("patch", "--patch"):
        face: Any = getattr(args, "face", None) or "ring"
        return Coulomb(args.mu, args.static, patch, face)._known()  # in natural units here


def contact_of(args: Namespace, scale: Scale | None) -> AnyContact:
    """The contact given by the options, with its coefficients."""
    for name, law in (
        ("static", "coulomb"),
        ("patch", "coulomb"),
        ("face", "coulomb"),
        ("viscosity", "viscous"),
    ):
        if getattr(args, name, None) is not None and args.contact != law:
            raise ValueError(f"--{name} needs --contact {law}")
    if args.contact == "coulomb":
        if args.mu is None:
            raise ValueError("--contact coulomb needs --mu, the coefficient of friction")
        return coulomb(args, scale)
    if args.contact == "viscous":
        if args.viscosity is None:
            raise ValueError("--contact viscous needs --viscosity, the coefficient of viscous friction")
        with _errors_name_option("c", "--viscosity"):
            return Viscous(args.viscosity)._known()  # in natural units here
    found: AnyContact = args.contact
    return found


def natural(name: str, time: float | None, scale: Scale | None) -> float | None:
    """Convert a time to units of sqrt(R/g) if it was given in seconds."""
    if not isinstance(time, Seconds):
        return time
    if scale is None:
        raise ValueError(f"{name} {float(time):g}s needs --radius, or --outer and --length in metres")
    return float(time) / float(scale.seconds(1.0))


def roll_(args: Namespace) -> None:
    """Compute a motion from an initial state; print a summary, and write a file if -o is given."""
    body, scale = body_of(args)
    if args.points < 2:
        raise ValueError(f"--points {args.points}: expected at least 2")
    last, step = natural("--t", args.t, scale), natural("--step", args.step, scale)
    start, t = _start(args, body), np.linspace(0.0, last or 0.0, args.points)
    writer = recipient(args)
    contact = contact_of(args, scale)
    mu = np.inf if args.mu is None or args.contact == "coulomb" else args.mu
    how: dict[str, Any] = {"step": step, "tol": args.tol, "contact": contact, "mu": mu}
    how["losses"] = losses_of(args, scale)
    with warnings.catch_warnings(record=True) as caught, Working("roll"):
        warnings.simplefilter("always", StepWarning)
        with errors_in_seconds(scale if isinstance(args.t, Seconds) else None):
            m = roll(body, start, t, want=("pose", "force"), beyond=args.beyond, **how)
        if writer is not None:
            writer(m, scale, Path(args.output))
    for warning in caught:
        print(f"spincyl roll: {warning.message}", file=sys.stderr)
    delivered(args, m, scale)


def recipient(args: Namespace) -> Callable[[Motion, Scale | None, Path], None] | None:
    """Check the path, and return the function that writes a file there; None if no file is requested."""
    if args.output is None or args.output == "-":
        return None
    writer = writer_of(Path(args.output))
    writable(args.output)
    return writer


def delivered(
    args: Namespace,
    m: Motion,
    scale: Scale | None,
    rows: Iterable[Row] = (),
    numbers: dict[str, Any] | None = None,
) -> None:
    """Print a motion below the `rows` of the command, or as JSON with `numbers`; with `-o -` also as CSV."""
    piped = args.output == "-"
    if args.json:
        told = motion_numbers(m, scale) | (numbers or {})
        print_json(told | ({"columns": columns(m, scale)} if piped else {}))
        return
    said = sys.stderr if piped else sys.stdout  # only the table goes into a pipe
    print(f"{m.body!r}", file=said)
    table(chain(rows, motion_rows(m, scale, weighed=args.mass is not None)), said)
    if piped:
        write_csv(columns(m, scale), sys.stdout)
    elif args.output is not None:
        suffix = Path(args.output).suffix.lower()
        shown = {".html": "the motion", ".glb": "the motion", ".json": "the scene", ".xml": "the scene"}
        print(f"{shown.get(suffix, f'{m.t.size} times')} in {args.output}")
