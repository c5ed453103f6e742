"""The command line: steady states as a table, the map and the figures as pictures."""

import argparse
import math
import sys
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from spincyl import Body, Scale, State, __version__
from spincyl._array import extra
from spincyl._body import Contact

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
    shape = steady.add_argument_group("the body")
    shape.add_argument("--ell", type=float, help="aspect ratio: half length over radius")
    shape.add_argument("--bore", type=float, help="inner over outer radius, 0 to 1 (default 0: solid)")
    shape.add_argument("--i1", type=float, help="transverse moment of inertia, in M R^2")
    shape.add_argument("--i3", type=float, help="axial moment of inertia, in M R^2")
    shape.add_argument("--outer", type=float, metavar="METRES", help="outer diameter")
    shape.add_argument("--inner", type=float, metavar="METRES", help="inner diameter (default 0: solid)")
    shape.add_argument("--length", type=float, metavar="METRES", help="length")
    asked = steady.add_argument_group("what is asked (several of each may be given)")
    asked.add_argument("--theta", type=angle, nargs="+", default=[], metavar="ANGLE", help="inclinations")
    asked.add_argument("--rate", type=float, nargs="+", default=[], help="reduced rates")
    asked.add_argument("--hertz", type=float, nargs="+", default=[], help="turns per second (needs a radius)")
    scale = steady.add_argument_group("SI units")
    scale.add_argument("--radius", type=float, metavar="METRES", help="rim radius")
    scale.add_argument("--mass", type=float, metavar="KG", help="mass, for energies in joules")
    scale.add_argument("--gravity", type=float, metavar="M/S2", help="default 9.80665")

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

    figures = command(
        "figures",
        _figures,
        "the pictures of a lecture, as PNG files",
        "Write the predictions that the paper of Jackson et al. discusses (fig4 to fig8: solid where\n"
        "stable, dashed where not, points A to G marked, each by the paper's criterion and rolling), and\n"
        "ours: tubes, where the two criteria disagree, the energy landscape. Needs spincyl[plot].",
    )
    figures.add_argument("folder", metavar="DIR", help="made if it does not exist")
    return parser


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
            yield name, f"unstable, growth {growth:.6g}", si(growth, lambda x: x / unit, "e-foldings/s")


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

    theta = np.linspace(0, np.pi / 2, args.points + 1)[1:]
    ell = np.linspace(0, args.ell_max, args.points)
    if str(args.output).endswith(".nc"):
        sweep.portrait(theta, ell, args.bore).to_netcdf(args.output)
        return
    extra("matplotlib", "plot").use("agg")
    plt: Any = extra("matplotlib.pyplot", "plot")
    figure, ax = plt.subplots(figsize=(9, 6.4), layout="constrained")
    plot.portrait(sweep.portrait(theta, ell, args.bore, want=["region"]), contact=args.contact, ax=ax)
    figure.savefig(args.output, dpi=150)
    plt.close(figure)
    print(f"{args.points**2:,} points in {args.output}")


def _figures(args: argparse.Namespace) -> None:
    extra("matplotlib", "plot").use("agg")
    from spincyl import plot

    for path in plot.figures(args.folder):
        print(path)
