"""The command line: steady states as a table, motions as files, the map and the figures as pictures."""

import argparse
import math
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from spincyl import Body, Motion, Scale, State, StepWarning, __version__, roll, swing
from spincyl._array import extra
from spincyl._body import Contact
from spincyl._files import writer_of

_BODY_HELP = """\
A body is one of
  --ell 2.5                      solid cylinder of aspect ratio l/R = 2.5 (half length over radius)
  --ell 6 --bore 0.8             tube whose inner radius is 0.8 of the outer
  --ell 1.2 --i1 0.7 --i3 0.5    any body of revolution: moments in M R^2 about its centre of mass
  --outer 0.015875 --inner 0.0127 --length 0.09525      a tube measured in metres
Angles are radians, or degrees with the suffix deg: 1.3, 1.3rad, 85deg."""

_STEADY_HELP = f"""\
Steady states of a body that spins on its rim with its centre at rest.

The inclination theta is the angle between the vertical and the axis: 0 stands on its face, 90deg
lies on its side. Given inclinations, it prints the rate that each needs; given rates, every
inclination that has that rate (0 to 3 of them). The reduced rate is Omega sqrt(I3), in natural
units of radius, mass and gravity; 1 is the critical rate. Stability is answered twice: rolling
without slipping, and on a smooth table (the criterion of Jackson et al. 2019).

{_BODY_HELP}
With --radius (or measures in metres) the table is also in SI units, and --hertz can be given."""


_ROLL_HELP = f"""\
How a body rolls, or slides on a smooth table, from a state.

The start is the steady state with its centre at rest at an inclination, kicked if wanted, or any
state if w1, w2, w3 are given. Times are in units of sqrt(R/g). Without --step or --tol the motion
is exact (first integrals). The file has t, theta, w1, w2, w3, energy, the angles phi and psi, the
contact point and the centre, normal force and friction demand, up to where the motion ends.

{_BODY_HELP}
With --radius (or measures in metres) the file has a column of seconds, too."""

_REPORT_HELP = """\
Measure the error of the final state against the time that a trajectory takes, on this machine: RK4
over steps, RK4 within tolerances, the exact solution and, where SciPy is installed, its DOP853. With
a folder, writes report.md, and report.png where matplotlib is installed."""


def angle(text: str) -> float:
    """Radians of '1.3', '1.3rad' or '85deg'."""
    for suffix, unit in (("deg", math.pi / 180), ("rad", 1.0), ("", 1.0)):
        if text.endswith(suffix):
            return float(text.removesuffix(suffix)) * unit
    raise AssertionError("the empty suffix fits")


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    parser = _parser()
    args = parser.parse_args(argv)
    try:
        run: Callable[[argparse.Namespace], None] = args.run
        run(args)
    except (ValueError, TypeError, ImportError, OSError) as e:
        print(f"spincyl {args.command}: {e}", file=sys.stderr)
        return 2
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="spincyl", description="Bodies that spin and roll on their rim.")
    parser.add_argument("--version", action="version", version=f"spincyl {__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def command(name: str, run: Callable[[argparse.Namespace], None], summary: str, text: str) -> Any:
        sub = commands.add_parser(
            name, help=summary, description=text, formatter_class=argparse.RawDescriptionHelpFormatter
        )
        sub.set_defaults(run=run)
        return sub

    steady = command("steady", _steady, "steady states of one body, as a table", _STEADY_HELP)
    _shape_options(steady)
    asked = steady.add_argument_group("what is asked (several of each may be given)")
    asked.add_argument("--theta", type=angle, nargs="+", default=[], metavar="ANGLE", help="inclinations")
    asked.add_argument("--rate", type=float, nargs="+", default=[], help="reduced rates")
    asked.add_argument("--hertz", type=float, nargs="+", default=[], help="turns per second (needs a radius)")
    _scale_options(steady)

    portrait = command(
        "portrait",
        _portrait,
        "the theta-ell map of all tubes of one bore, as a picture",
        "Sweep the map of steady states (inclination against aspect ratio) and draw which are\n"
        "forbidden, unstable, stable only when rolling, or stable. Needs spincyl[all].",
    )
    portrait.add_argument(
        "-o", "--output", required=True, metavar="FILE", help="picture (.png, .pdf, .svg) or data (.nc)"
    )
    portrait.add_argument("--bore", type=float, default=0.0, help="inner over outer radius (default 0)")
    portrait.add_argument("--ell-max", type=float, default=2.0, help="right edge (default 2)")
    portrait.add_argument("--points", type=int, default=1000, help="along each axis (default 1000)")
    portrait.add_argument("--contact", choices=("smooth", "rolling"), help="one criterion (default: both)")
    slides: dict[str, Any] = {"action": "store_true", "help": "16:9, as PNG 1920 x 1080 pixels"}
    portrait.add_argument("--slides", **slides)

    roll = command("roll", _roll, "how a body moves on from a state, as a file", _ROLL_HELP)
    _shape_options(roll)
    start = roll.add_argument_group("the start")
    start.add_argument("--theta", type=angle, required=True, metavar="ANGLE", help="inclination")
    start.add_argument("--kick", type=float, default=0.0, help="theta' given to it (default 0)")
    for name in ("w1", "w2", "w3"):
        start.add_argument(f"--{name}", type=float, help="instead of the steady state (others then 0)")
    how = roll.add_argument_group("the motion")
    how.add_argument("--until", type=float, required=True, metavar="TIME", help="in sqrt(R/g)")
    how.add_argument("--points", type=int, default=2001, help="times from 0 on (default 2001)")
    how.add_argument("--step", type=float, help="by RK4 with this step")
    how.add_argument("--tol", type=float, help="by RK4 within this tolerance")
    how.add_argument("--contact", choices=("rolling", "smooth"), default="rolling")
    how.add_argument("--mu", type=float, default=math.inf, help="friction coefficient (default: never slips)")
    how.add_argument("--beyond", action="store_true", help="go on beyond lift-off, slip or the side")
    roll.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help=".csv, .npz, .nc (xarray), a picture: .png, .pdf, .svg, a page to watch it in: .html, or an"
        " animated scene: .glb",
    )
    _scale_options(roll)

    report = command("report", _report, "speed against error on this machine", _REPORT_HELP)
    report.add_argument(
        "folder", nargs="?", metavar="DIR", help="where a table and a figure go (default: print)"
    )
    report.add_argument("--seconds", type=float, default=60.0, help="time to spend, about (default 60)")
    report.add_argument(
        "--reference", metavar="CSV", help="high-precision motions to measure the exact one by"
    )

    figures = command(
        "figures",
        _figures,
        "the pictures of a lecture, as files",
        "Write the predictions that the paper of Jackson et al. discusses (fig4 to fig8: solid where\n"
        "stable, dashed where not, points A to G marked, each by the paper's criterion and rolling), and\n"
        "ours: tubes, where the two criteria disagree, the energy landscape. Needs spincyl[plot].",
    )
    figures.add_argument("folder", metavar="DIR", help="made if it does not exist")
    figures.add_argument("--suffix", choices=(".png", ".pdf", ".svg"), default=".png", help="default .png")
    figures.add_argument("--slides", **slides)
    return parser


def _shape_options(parser: argparse.ArgumentParser) -> None:
    """Options that make a body."""
    shape = parser.add_argument_group("the body")
    shape.add_argument("--ell", type=float, help="aspect ratio: half length over radius")
    shape.add_argument("--bore", type=float, help="inner over outer radius, 0 to 1 (default 0: solid)")
    shape.add_argument("--i1", type=float, help="transverse moment of inertia, in M R^2")
    shape.add_argument("--i3", type=float, help="axial moment of inertia, in M R^2")
    shape.add_argument("--outer", type=float, metavar="METRES", help="outer diameter")
    shape.add_argument("--inner", type=float, metavar="METRES", help="inner diameter (default 0: solid)")
    shape.add_argument("--length", type=float, metavar="METRES", help="length")


def _scale_options(parser: argparse.ArgumentParser) -> None:
    """Options that make a scale."""
    scale = parser.add_argument_group("SI units")
    scale.add_argument("--radius", type=float, metavar="METRES", help="rim radius")
    scale.add_argument("--mass", type=float, metavar="KG", help="mass, for energies in joules")
    scale.add_argument("--gravity", type=float, metavar="M/S2", help="default 9.80665")


def _body(args: argparse.Namespace) -> tuple[Body, float | None]:
    """The body, and its radius in metres if known."""
    measures = args.outer, args.inner, args.length
    if any(x is not None for x in measures):
        if args.outer is None or args.length is None:
            raise ValueError("a measured tube needs --outer and --length")
        if any(x is not None for x in (args.ell, args.bore, args.i1, args.i3, args.radius)):
            raise ValueError("give either measures in metres or --ell, not both")
        tube = Body.from_metres(
            outer_diameter=args.outer, inner_diameter=args.inner or 0.0, length=args.length
        )
        return tube, args.outer / 2
    if args.ell is None:
        raise ValueError("no body: give --ell, or --outer and --length")
    if (args.i1 is None) != (args.i3 is None):
        raise ValueError("a general body needs both --i1 and --i3")
    if args.i1 is not None:
        if args.bore is not None:
            raise ValueError("give either --bore or --i1 and --i3, not both")
        return Body(args.ell, args.i1, args.i3), args.radius
    return Body.tube(args.ell, args.bore or 0.0), args.radius


def _scale(radius: float, args: argparse.Namespace) -> Scale:
    given = {name: getattr(args, name) for name in ("mass", "gravity")}
    return Scale(radius, **{name: x for name, x in given.items() if x is not None})


def _steady(args: argparse.Namespace) -> None:
    body, radius = _body(args)
    scale = None if radius is None else _scale(radius, args)
    if scale is None and (args.mass is not None or args.gravity is not None):
        raise ValueError("--mass and --gravity need --radius, or a body measured in metres")
    if args.hertz and scale is None:
        raise ValueError("--hertz needs --radius, or a body measured in metres")
    print(f"{body!r}")
    _table(shape_rows(body, scale))
    rates = list(args.rate)
    if scale is not None:
        rates += [hertz / float(scale.hertz(body, 1.0)) for hertz in args.hertz]
    states = [(body.steady(x), f"theta = {math.degrees(x):.6g} deg") for x in args.theta]
    for rate in rates:
        if np.isnan(body.count(rate)):
            raise ValueError(f"rate = {rate!r}: expected 0 <= rate, (i1/i3) rate^2 <= 1e300")
        count, found = int(body.count(rate)), body.states(rate)
        print(f"\nrate {rate:.6g}: {count} steady inclination{'' if count == 1 else 's'}")
        for theta, w1, w3 in zip(found.theta[:count], found.w1[:count], found.w3[:count], strict=True):
            title = f"rate = {rate:.6g}, theta = {math.degrees(theta):.6f} deg"
            states.append((State(float(theta), float(w1), 0.0, float(w3)), title))
    for state, title in states:
        print(f"\n{title}")
        _table(state_rows(body, state, scale, weighed=args.mass is not None))


def shape_rows(body: Body, scale: Scale | None) -> Iterator[tuple[str, str, str]]:
    """Name, natural and SI value of what the shape decides."""
    yield "aspect ratio l/R", f"{body.ell:.9g}", ""
    yield "moments I1, I3", f"{body.i1:.9g}, {body.i3:.9g}", ""
    for name, x in (("theta0 (balanced)", body.theta_balance), ("thetaInf (fast limit)", body.theta_limit)):
        yield name, f"{x:.9g} rad", f"{math.degrees(x):.6f} deg"
    yield "critical rate", "1", "" if scale is None else f"{scale.hertz(body, 1.0):.6g} Hz"
    for name, points in (("folds", body.folds()), ("energy ridge", body.ridge())):
        for x in points[~np.isnan(points)]:
            yield f"{name} at theta", f"{x:.9g} rad", f"{math.degrees(x):.6f} deg"


def state_rows(
    body: Body, state: State, scale: Scale | None, *, weighed: bool = False
) -> Iterator[tuple[str, str, str]]:
    """Name, natural and SI value of a steady state with the centre at rest."""

    def si(value: float, law: Callable[[float], float], unit: str) -> str:
        return "" if scale is None else f"{law(value):.6g} {unit}"

    turns, metres = (scale.turns, scale.metres) if scale else (float, float)
    joules = scale.joules if scale else float
    unit = scale.seconds(1.0) if scale else 1.0
    yield "reduced rate", f"{state.precession * math.sqrt(body.i3):.9g}", ""
    yield "precession phi'", f"{state.precession:.9g}", si(state.precession, turns, "turns/s")
    yield "spin psi'", f"{state.spin:.9g}", si(state.spin, turns, "turns/s")
    yield (
        "angular velocity",
        f"{state.angular_velocity:.9g}",
        f"gamma = {math.degrees(state.gamma):.4f} deg to the axis",
    )
    momentum, beta = body.angular_momentum(state), body.beta(state)
    yield "angular momentum", f"{momentum:.9g}", f"beta = {math.degrees(beta):.4f} deg to the axis"
    yield "contact circle", f"{state.contact_radius:.9g}", si(state.contact_radius, metres, "m radius")
    yield "still symbols", f"{state.contact_radius:.4g} a turn", ""
    yield (
        "speed of O, of X",
        f"{body.speed_o(state):.3g}, {body.speed_x(state):.6g}",
        si(body.speed_x(state), lambda v: metres(v) / unit, "m/s"),
    )
    yield "energy", f"{body.energy(state):.9g}", si(body.energy(state), joules, "J") if weighed else ""
    contacts: tuple[tuple[str, Contact], ...] = (("rolling", "rolling"), ("smooth table", "smooth"))
    for name, contact in contacts:
        kappa = body.stability(state, contact)
        if kappa > 0:
            nutation = body.nutation(state, contact)
            yield name, f"stable, nutation {nutation:.6g}", si(nutation, turns, "turns/s")
        else:
            growth = body.growth_rate(state, contact)
            how = f"unstable, growth {growth:.6g}" if kappa < 0 else "marginal"
            yield name, how, si(growth, lambda x: x / unit, "e-foldings/s") if kappa < 0 else ""


def _table(rows: Iterator[tuple[str, str, str]]) -> None:
    for name, natural, si in rows:
        print(f"  {name:<22} {natural:<34} {si}".rstrip())


def _portrait(args: argparse.Namespace) -> None:
    if not 2 <= args.points <= 100_000:
        raise ValueError(f"--points {args.points}: expected 2 to 100000")
    if not args.ell_max > 0:
        raise ValueError(f"--ell-max {args.ell_max}: expected a positive number")
    Body.tube(args.ell_max, args.bore)
    from spincyl import plot, sweep
    from spincyl.plot._style import saved

    theta = np.linspace(0, np.pi / 2, args.points + 1)[1:]
    ell = np.linspace(0, args.ell_max, args.points)
    if str(args.output).endswith(".nc"):
        sweep.portrait(theta, ell, args.bore).to_netcdf(args.output)
        return
    extra("matplotlib", "plot").use("agg")
    plt: Any = extra("matplotlib.pyplot", "plot")
    figure, ax = plt.subplots(figsize=(9, 6.4), layout="constrained")
    plot.portrait(sweep.portrait(theta, ell, args.bore, want=["region"]), contact=args.contact, ax=ax)
    saved(figure, Path(args.output), slide=args.slides)
    plt.close(figure)
    print(f"{args.points**2:,} points in {args.output}")


def _figures(args: argparse.Namespace) -> None:
    extra("matplotlib", "plot").use("agg")
    from spincyl import plot

    for path in plot.figures(args.folder, suffix=args.suffix, slides=args.slides):
        print(path)


def _start(args: argparse.Namespace, body: Body) -> State:
    speeds = args.w1, args.w2, args.w3
    if all(w is None for w in speeds):
        return body.steady(args.theta).kicked(args.kick)
    w1, w2, w3 = (w or 0.0 for w in speeds)
    return State(args.theta, w1, w2, w3).kicked(args.kick)


def _roll(args: argparse.Namespace) -> None:
    body, radius = _body(args)
    scale = None if radius is None else _scale(radius, args)
    if args.points < 2:
        raise ValueError(f"--points {args.points}: expected at least 2")
    start, t = _start(args, body), np.linspace(0.0, args.until, args.points)
    writer = None if args.output is None else writer_of(Path(args.output))
    how: dict[str, Any] = {"step": args.step, "tol": args.tol, "contact": args.contact, "mu": args.mu}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", StepWarning)
        m = roll(body, start, t, want=("pose", "contact"), beyond=args.beyond, **how)
    for warning in caught:
        print(f"spincyl roll: {warning.message}", file=sys.stderr)
    print(f"{body!r}")
    _table(motion_rows(m, scale))
    if writer is not None:
        writer(m, scale, Path(args.output))
        shown = Path(args.output).suffix.lower() in {".html", ".glb"}
        print(f"{'the motion' if shown else f'{m.t.size} times'} in {args.output}")


def motion_rows(m: Motion, scale: Scale | None) -> Iterator[tuple[str, str, str]]:
    """Name, natural and SI value of what there is to say about a motion."""

    def seconds(t: float) -> str:
        return "" if scale is None else f"{scale.seconds(t):.6g} s"

    found = swing(m.body, m.start, m.contact)
    yield "start", f"theta = {m.start.theta:.9g} rad", f"{math.degrees(m.start.theta):.6f} deg"
    ends = (found.theta_min, found.theta_max)
    yield "turning points", " to ".join(f"{x:.9g}" for x in ends) + " rad", ""
    early = m.event is not None and m.event.time < found.period
    yield "period" + (", if it got so far" if early else ""), f"{found.period:.12g}", seconds(found.period)
    yield "turn in a period", f"phi {found.precession:.9g}, psi {found.spin:.9g} rad", ""
    yield (
        "drift in a period",
        f"{found.drift:.9g}",
        "" if scale is None else f"{scale.metres(found.drift):.6g} m",
    )
    if m.t.size:
        yield "normal force", f"{m.normal.min():.6g} to {m.normal.max():.6g} M g", ""
        yield "friction coefficient", f"{m.friction_coefficient.max():.6g} needed", ""
    if m.event is not None:
        yield m.event.ending.name.lower().replace("_", "-"), f"t = {m.event.time:.12g}", seconds(m.event.time)
    yield "how", m.message, ""


def _report(args: argparse.Namespace) -> None:
    from spincyl import report

    table = report.measure(args.seconds, reference=args.reference)
    text = report.table(table)
    if args.folder is None:
        print(text)
        return
    folder = Path(args.folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "report.md").write_text(text, encoding="utf-8")
    print(folder / "report.md")
    if report.figure(table, folder / "report.png"):
        print(folder / "report.png")
