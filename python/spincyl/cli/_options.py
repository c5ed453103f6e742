"""The options and help texts of all commands."""

from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from collections.abc import Callable
from typing import Any

from spincyl import __version__
from spincyl._input.units import angle, part, quantity, time, whole
from spincyl.cli import _commands, _drift, _flick, _losses, _play

_BODY = """\
A body is one of
  --ell 2.5                      solid cylinder of aspect ratio l/R = 2.5 (half length over radius)
  --ell 6 --bore 0.8             tube whose inner radius is 0.8 of the outer
  --ell 1.2 --i1 0.7 --i3 0.5    any body of revolution: moments in M R^2 about its centre of mass
  --balls                        two balls, one on the other (Hurricane balls)
  --balls 1.5                    the same on a light rod, their centres 1.5 diameters apart
  --ball -0.3 --i1 0.4 --i3 0.4  a ball whose centre of mass lies 0.3 R below its middle, such as a tippe top
  --outer 15.875mm --inner 12.7mm --length 95.25mm      a measured tube; --bore 12.7mm is the same
  --balls --outer 16mm           the same two balls, each of which measures 16 mm
R is the outer radius. --fillet 0.05 rounds the rim with a radius of 0.05 R, --fillet 2mm that of a
measured tube. Then --ell is half the length over R all the same, but beside --i1 and --i3 it is the
height of the centre of mass above the circle about which the rim is rounded.
Angles are radians, or degrees as in 85deg, lengths metres, or as in 16mm, 1.6cm, 0.625in."""

_STEADY = f"""\
Steady states of a body that spins on its rim with its centre at rest.

The inclination theta is the angle between the vertical and the axis: 0 stands on its face, 90deg
lies on its side. Given inclinations, it prints the rate that each needs; given rates, every
inclination that has that rate (0 to 3 of them, of a rounded rim up to 5). The reduced rate is
Omega sqrt(I3), in natural units of radius, mass and gravity; 1 is the critical rate. Stability is
answered twice: rolling without slipping, and on a smooth table (the criterion of Jackson et al. 2019).

{_BODY}
With --radius (or a measured tube) the table is also in SI units, and --hertz can be given."""

_STEADY_EXAMPLES = """\
spincyl steady --ell 6 --bore 0.8 --radius 8mm --theta 85deg
spincyl steady --outer 75.1mm --length 12.8mm --hertz 3 8
spincyl steady --outer 75.1mm --length 13mm --fillet 2mm --theta 5deg
spincyl steady --balls --outer 16mm --theta 90deg
spincyl steady --ell 2.5 --rate 1.5 --json"""

_PORTRAIT = """\
Sweep the map of steady states (inclination against aspect ratio) and draw which are
forbidden, unstable, stable only when rolling, or stable. Needs spincyl[all]."""

_PORTRAIT_EXAMPLES = """\
spincyl portrait -o portrait.png
spincyl portrait --bore 0.8 --ell-max 3 --contact rolling -o tubes.svg
spincyl portrait --fillet 0.1 -o rounded.png
spincyl portrait --points 50 -o - > map.csv"""

_ROLL = f"""\
How a body rolls, or slides on a smooth table, from a state.

The start is the steady state with its centre at rest at an inclination, kicked if wanted, or any
state if w1, w2, w3 are given; with --contact coulomb or viscous it may slip. Times are in units of
sqrt(R/g), or in seconds as in 2s or 20ms if the radius is known. Without --step or --tol the motion is
exact (first integrals), with friction where it rolls. The file has t, theta, w1, w2, w3, energy, the
angles phi and psi, the contact point and the centre, normal force and friction demand, with friction the
slip, the heat and the phase (1 slips, 0 rolls), with losses the work lost, up to where the motion ends.

{_BODY}

{_losses.TEXT}
With --radius (or a measured tube) the file has a column of seconds, too."""

_ROLL_EXAMPLES = """\
spincyl roll --ell 2.5 --theta 1.3 --kick 0.05 --t 20 -o roll.csv
spincyl roll --ell 6 --bore 0.8 --radius 8mm --theta 85deg --t 2s -o spin.html
spincyl roll --ell 1 --theta 0.3 --w1 0 --t 5 --json
spincyl roll --balls --outer 16mm --theta 80deg --kick 0.05 --t 0.5s -o balls.csv
spincyl roll --ball -0.3 --i1 0.4 --i3 0.4 --theta 0.1 --w3 3 --t 20 -o top.csv
spincyl roll --ell 0 --bore 1 --theta 90deg --w3 -3 --slip 0 5 --contact coulomb --mu 0.25 --t 20
spincyl roll --ell 0.1704 --theta 0.3 --t 200 --loss dry-contour=5e-3 -o whirr.html
spincyl roll --ell 2.5 --theta 1.3 --kick 0.02 --radius 20mm --mass 0.1 --t 1s -o scene.xml
spincyl roll --ell 2.5 --theta 1.3 --t 20 -o - | head"""

_FLICK = f"""{_flick.TEXT}{_BODY}
With --radius (or a measured tube) the table and the file are in seconds, too."""

_DRIFT = f"""{_drift.TEXT}{_BODY}
With --radius (or a measured tube) the table and the file are in seconds and turns a second, too."""

_PLAY = f"{_play.TEXT}{_BODY}"

_REPORT = """\
Measure the error of the final state against the time that a trajectory takes, on this machine: RK4
over steps, steps of eighth order within tolerances, the exact solution and, where SciPy is
installed, its DOP853. With a folder, writes report.md, and report.png where matplotlib is installed."""

_REPORT_EXAMPLES = """\
spincyl report
spincyl report DIR --seconds 5min"""

_FIGURES = """\
Write the predictions that the paper of Jackson et al. discusses (fig4 to fig8: solid where
stable, dashed where not, points A to G marked, each by the paper's criterion and rolling), and
ours: tubes, where the two criteria disagree, the energy landscape. Needs spincyl[plot]."""

_FIGURES_EXAMPLES = "spincyl figures DIR"

_length, _mass, _duration = quantity("length"), quantity("mass"), quantity("duration")


def parser() -> ArgumentParser:
    """The parser of the whole command line."""
    top = ArgumentParser(
        prog="spincyl",
        description="Bodies that spin and roll on their rim.",
        epilog=_examples("spincyl steady --ell 2.5 --theta 85deg\nspincyl roll --help"),
        formatter_class=RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action="version", version=f"spincyl {__version__}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")

    def command(
        name: str, run: Callable[[Namespace], None], summary: str, text: str, examples: str
    ) -> ArgumentParser:
        sub = commands.add_parser(
            name,
            help=summary,
            description=text,
            epilog=_examples(examples),
            formatter_class=RawDescriptionHelpFormatter,
        )
        sub.set_defaults(run=run)
        return sub

    steady = command(
        "steady", _commands.steady, "steady states of one body, as a table", _STEADY, _STEADY_EXAMPLES
    )
    _shape_options(steady)
    asked = steady.add_argument_group("what is asked (several of each may be given)")
    asked.add_argument("--theta", type=angle, nargs="+", default=[], metavar="ANGLE", help="inclinations")
    asked.add_argument("--rate", type=float, nargs="+", default=[], help="reduced rates")
    asked.add_argument(
        "--hertz",
        type=quantity("frequency"),
        nargs="+",
        default=[],
        help="turns per second (needs a radius)",
    )
    _scale_options(steady)
    _json_option(steady, "numbers instead of a table")

    portrait = command(
        "portrait",
        _commands.portrait,
        "the theta-ell map of all tubes of one bore, as a picture",
        _PORTRAIT,
        _PORTRAIT_EXAMPLES,
    )
    portrait.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="FILE",
        help="a picture: .png, .pdf, .svg, data: .nc, or - for CSV on standard output",
    )
    portrait.add_argument("--bore", type=float, default=0.0, help="inner over outer radius (default 0)")
    portrait.add_argument(
        "--fillet", type=float, default=0.0, help="of the rim, in outer radii (default 0: sharp)"
    )
    portrait.add_argument("--ell-max", type=float, default=2.0, help="right edge (default 2)")
    portrait.add_argument("--points", type=whole, default=1000, help="along each axis (default 1000)")
    portrait.add_argument("--contact", choices=("smooth", "rolling"), help="one criterion (default: both)")
    slides: dict[str, Any] = {"action": "store_true", "help": "16:9, as PNG 1920 x 1080 pixels"}
    portrait.add_argument("--slides", **slides)
    _json_option(portrait, "with -o -: JSON instead of CSV")

    roll = command(
        "roll", _commands.roll_, "how a body moves on from a state, as a file", _ROLL, _ROLL_EXAMPLES
    )
    _shape_options(roll)
    _roll_options(roll)
    _scale_options(roll)
    _json_option(roll, "numbers instead of words; with -o -: JSON instead of CSV")

    flick = command(
        "flick", _flick.flick, "a tube that is flicked: slipping, then rolling", _FLICK, _flick.EXAMPLES
    )
    _shape_options(flick)
    _flick.options(flick)
    _output_option(flick)
    _scale_options(flick)
    _json_option(flick, "numbers instead of words; with -o -: JSON instead of CSV")

    drift = command(
        "drift", _drift.drift, "how it comes to rest: inclination over time", _DRIFT, _drift.EXAMPLES
    )
    _shape_options(drift)
    _drift.options(drift)
    _scale_options(drift)
    _json_option(drift, "numbers instead of words")

    play = command("play", _play.run, "a page to play with, in one file", _PLAY, _play.EXAMPLES)
    _shape_options(play)
    _play.options(play)
    _scale_options(play)

    report = command(
        "report", _commands.report, "speed against error on this machine", _REPORT, _REPORT_EXAMPLES
    )
    report.add_argument(
        "folder", nargs="?", metavar="DIR", help="where a table and a figure go (default: print)"
    )
    report.add_argument("--seconds", type=_duration, default=60.0, help="time to spend, about (default 60)")
    report.add_argument(
        "--reference", metavar="CSV", help="high-precision motions to measure the exact one by"
    )

    figures = command(
        "figures", _commands.figures, "the pictures of a lecture, as files", _FIGURES, _FIGURES_EXAMPLES
    )
    figures.add_argument("folder", metavar="DIR", help="made if it does not exist")
    figures.add_argument("--suffix", choices=(".png", ".pdf", ".svg"), default=".png", help="default .png")
    figures.add_argument("--slides", **slides)
    return top


def _examples(lines: str) -> str:
    return "examples:\n" + "\n".join(f"  {line}" for line in lines.splitlines())


def _json_option(sub: ArgumentParser, text: str) -> None:
    sub.add_argument("--json", action="store_true", help=f"{text} (what is not finite is null)")


def _shape_options(sub: ArgumentParser) -> None:
    """Add the options that define a body."""
    shape = sub.add_argument_group("the body")
    shape.add_argument("--ell", type=float, help="aspect ratio: half length over outer radius")
    shape.add_argument(
        "--bore", type=part, help="inner over outer radius, 0 to 1 (default 0: solid), or as in 12.7mm"
    )
    shape.add_argument("--i1", type=float, help="transverse moment of inertia, in M R^2")
    shape.add_argument("--i3", type=float, help="axial moment of inertia, in M R^2")
    shape.add_argument(
        "--fillet",
        type=part,
        metavar="LENGTH",
        help="radius of the rounded rim, in R (default 0: sharp), or as in 2mm",
    )
    shape.add_argument(
        "--balls",
        type=float,
        nargs="?",
        const=1.0,
        metavar="SEPARATION",
        help="two balls, their centres so many diameters apart (default 1: they touch)",
    )
    shape.add_argument(
        "--ball", type=float, metavar="OFFSET", help="a ball: its centre of mass above its middle, in R"
    )
    shape.add_argument(
        "--theta-end",
        type=angle,
        metavar="ANGLE",
        help="inclination at which something else lands: a stem, a cap",
    )
    shape.add_argument("--outer", type=_length, metavar="LENGTH", help="outer diameter (of one ball)")
    shape.add_argument("--inner", type=_length, metavar="LENGTH", help="inner diameter (default 0: solid)")
    shape.add_argument("--wall", type=_length, metavar="LENGTH", help="or how thick the wall is")
    shape.add_argument("--length", type=_length, metavar="LENGTH", help="length")


def _roll_options(sub: ArgumentParser) -> None:
    """Add the options that define a motion and its output."""
    start = sub.add_argument_group("the start")
    start.add_argument("--theta", type=angle, required=True, metavar="ANGLE", help="inclination")
    start.add_argument("--kick", type=float, default=0.0, help="theta' given to it (default 0)")
    for name in ("w1", "w2", "w3"):
        start.add_argument(f"--{name}", type=float, help="instead of the steady state (others then 0)")
    start.add_argument(
        "--slip",
        type=float,
        nargs=2,
        metavar=("ALONG", "ACROSS"),
        help="velocity of the lowest point, in sqrt(g R): along the lean and across it (coulomb, viscous)",
    )
    how = sub.add_argument_group("the motion")
    how.add_argument("--t", type=time, required=True, metavar="TIME", help="in sqrt(R/g), or as in 2s")
    how.add_argument("--points", type=whole, default=2001, help="times from 0 on (default 2001)")
    how.add_argument("--step", type=time, metavar="TIME", help="by RK4 with this step")
    how.add_argument("--tol", type=float, help="by steps of eighth order within this tolerance")
    laws = ("rolling", "smooth", "coulomb", "viscous")
    how.add_argument(
        "--contact", choices=laws, default="rolling", help="the last two slip (default: rolling)"
    )
    how.add_argument(
        "--mu",
        type=float,
        help="friction coefficient: where rolling needs more it ends (default: never), coulomb slips",
    )
    how.add_argument("--static", type=float, metavar="MU", help="of coulomb: up to which it is held (--mu)")
    how.add_argument(
        "--patch", type=part, metavar="RADIUS", help="of coulomb: that of a patch, or as in 0.3mm"
    )
    how.add_argument("--viscosity", type=float, metavar="C", help="of viscous: friction C N times the slip")
    _losses.option(how, "--loss")
    how.add_argument("--beyond", action="store_true", help="go on beyond lift-off, slip or the side")
    _output_option(sub)


def _output_option(sub: ArgumentParser) -> None:
    sub.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help=".csv, .npz, .nc (xarray), a picture: .png, .pdf, .svg, a page to watch it in: .html, an"
        " animated body: .glb, a scene to check a contact engine with: .json, .xml (MuJoCo), or - for CSV"
        " on standard output",
    )


def _scale_options(sub: ArgumentParser) -> None:
    """Add the options that define a scale."""
    scale = sub.add_argument_group("SI units")
    scale.add_argument("--radius", type=_length, metavar="LENGTH", help="outer radius R")
    scale.add_argument("--mass", type=_mass, help="in kg or as in 20g, for energies in joules")
    scale.add_argument("--gravity", type=quantity("gravity"), help="default 9.80665 m/s2")
