"""The options and help texts of all commands."""

from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from collections.abc import Callable
from typing import Any

from spincyl import __version__
from spincyl._contact import FACES
from spincyl._input.units import angle, part, quantity, time, whole_text
from spincyl.cli import _commands, _drift, _flick, _losses, _play

_BODY = """\
A body is one of
  --ell 2.5                      solid cylinder of aspect ratio l/R = 2.5 (half length over radius)
  --ell 6 --bore 0.8             tube whose inner radius is 0.8 of the outer
  --ell 1.2 --i1 0.7 --i3 0.5    any body of revolution: moments in M R^2 about its centre of mass
  --balls                        two balls, one on the other (Hurricane balls)
  --balls 1.5                    two balls on a light rod, with centres 1.5 diameters apart
  --ball -0.3 --i1 0.4 --i3 0.4  a ball with its centre of mass 0.3 R below its centre, such as a tippe top
  --outer 15.875mm --inner 12.7mm --length 95.25mm      a measured tube; --bore 12.7mm is the same
  --balls --outer 16mm           two balls with diameters of 16 mm
R is the outer radius. --fillet 0.05 rounds the rim with a radius of 0.05 R; for a measured tube also
--fillet 2mm. With a rounded rim --ell is still half the length over R, but with --i1 and --i3 it is the
height of the centre of mass above the circle of the centres of the rounding.
Angles are in radians, or in degrees as in 85deg; lengths in metres, or as in 16mm, 1.6cm, 0.625in."""

_STEADY = f"""\
Print the steady states of a body that spins on its rim with its centre at rest.

The inclination theta is the angle between the vertical and the axis: at 0 the body stands on its
face, at 90deg it lies on its side. For each inclination the table gives the rate; for each rate, all
inclinations with that rate (up to 3, for a rounded rim up to 5). The reduced rate is Omega sqrt(I3),
in natural units of radius, mass and gravity; 1 is the critical rate. Stability is given for rolling
without slipping, and for a smooth table (the criterion of Jackson et al. 2019).

{_BODY}
With --radius, or for a measured tube, the table also has SI units, and --hertz may be given."""

_STEADY_EXAMPLES = """\
spincyl steady --ell 6 --bore 0.8 --radius 8mm --theta 85deg
spincyl steady --outer 75.1mm --length 12.8mm --hertz 3 8
spincyl steady --outer 75.1mm --length 13mm --fillet 2mm --theta 5deg
spincyl steady --balls --outer 16mm --theta 90deg
spincyl steady --ell 2.5 --rate 1.5 --json"""

_PORTRAIT = """\
Draw a map of the steady states, inclination against aspect ratio: where they are forbidden,
unstable, stable only when rolling, or stable. Needs spincyl[all]."""

_PORTRAIT_EXAMPLES = """\
spincyl portrait -o portrait.png
spincyl portrait --bore 0.8 --ell-max 3 --contact rolling -o tubes.svg
spincyl portrait --fillet 0.1 -o rounded.png
spincyl portrait --points 50 -o - > map.csv"""

_ROLL = f"""\
Compute the motion of a body that rolls or slides, from an initial state.

The initial state is the steady state at --theta with the centre at rest, with --kick added to theta';
or any state, given by --w1, --w2 and --w3. With --contact coulomb or viscous the body may slip. Times
are in sqrt(R/g), or in seconds as in 2s or 20ms if the radius is known. Without --step and --tol rolling
and frictionless motion are exact (first integrals). The file contains t, theta, w1, w2, w3, energy, the
angles phi and psi, the contact point and the centre, the normal force and the friction coefficient; with
friction also slip, heat and phase (1 slipping, 0 rolling), with losses the work lost. Its last row is at
the end of the motion or before.

{_BODY}

{_losses.TEXT}
With --radius, or for a measured tube, the file also has a column of seconds."""

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
With --radius, or for a measured tube, the table and the file also have times in seconds."""

_DRIFT = f"""{_drift.TEXT}{_BODY}
With --radius, or for a measured tube, the table and the file also have seconds and turns per second."""

_PLAY = f"{_play.TEXT}{_BODY}"

_FIGURES = """\
Draw the figures of a lecture: the predictions in the paper of Jackson et al. (fig4 to fig8: solid if
stable, dashed if not, points A to G marked; for the paper's criterion and for rolling), and figures
of tubes, of disagreements of the two criteria, and of the energy landscape. Needs spincyl[plot]."""

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
    asked = steady.add_argument_group("the steady states (one or more values for each option)")
    asked.add_argument("--theta", type=angle, nargs="+", default=[], metavar="ANGLE", help="inclinations")
    asked.add_argument("--rate", type=float, nargs="+", default=[], help="reduced rates Omega sqrt(I3)")
    asked.add_argument(
        "--hertz",
        type=quantity("frequency"),
        nargs="+",
        default=[],
        help="precession in turns per second (needs a radius)",
    )
    _scale_options(steady)
    _json_option(steady, "print JSON instead of a table")

    portrait = command(
        "portrait",
        _commands.portrait,
        "map of inclination and aspect ratio for tubes of one bore, as a picture",
        _PORTRAIT,
        _PORTRAIT_EXAMPLES,
    )
    portrait.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="FILE",
        help="picture (.png, .pdf, .svg) or data (.nc); - writes CSV to standard output",
    )
    portrait.add_argument("--bore", type=float, default=0.0, help="inner over outer radius (default 0)")
    portrait.add_argument(
        "--fillet",
        type=float,
        default=0.0,
        help="radius of the rounded rim, in outer radii (default 0: sharp)",
    )
    portrait.add_argument("--ell-max", type=float, default=2.0, help="largest aspect ratio (default 2)")
    portrait.add_argument(
        "--points", type=whole_text, default=1000, help="points along each axis (default 1000)"
    )
    portrait.add_argument(
        "--contact", choices=("smooth", "rolling"), help="criterion of stability (default: both)"
    )
    slides: dict[str, Any] = {"action": "store_true", "help": "draw in 16:9; PNG has 1920 x 1080 pixels"}
    portrait.add_argument("--slides", **slides)
    _json_option(portrait, "with -o -, print JSON instead of CSV")

    roll = command("roll", _commands.roll_, "motion of a body from an initial state", _ROLL, _ROLL_EXAMPLES)
    _shape_options(roll)
    _roll_options(roll)
    _scale_options(roll)
    _json_option(roll, "print JSON instead of a table; with -o -, instead of CSV")

    flick = command(
        "flick", _flick.flick, "motion of a flicked tube: slipping, then rolling", _FLICK, _flick.EXAMPLES
    )
    _shape_options(flick)
    _flick.flick_options(flick)
    _output_option(flick)
    _scale_options(flick)
    _json_option(flick, "print JSON instead of a table; with -o -, instead of CSV")

    drift = command(
        "drift", _drift.drift, "slow spin-down of a body: inclination over time", _DRIFT, _drift.EXAMPLES
    )
    _shape_options(drift)
    _drift.drift_options(drift)
    _scale_options(drift)
    _json_option(drift, "print JSON instead of a table")

    play = command("play", _play.run, "interactive page in one file", _PLAY, _play.EXAMPLES)
    _shape_options(play)
    _play.play_options(play)
    _scale_options(play)

    figures = command(
        "figures", _commands.figures, "figures of a lecture, as files", _FIGURES, _FIGURES_EXAMPLES
    )
    figures.add_argument("folder", metavar="DIR", help="output folder; created if it does not exist")
    figures.add_argument(
        "--suffix", choices=(".png", ".pdf", ".svg"), default=".png", help="format (default .png)"
    )
    figures.add_argument("--slides", **slides)
    return top


def _examples(lines: str) -> str:
    return "examples:\n" + "\n".join(f"  {line}" for line in lines.splitlines())


def _json_option(sub: ArgumentParser, text: str) -> None:
    sub.add_argument("--json", action="store_true", help=f"{text} (numbers that are not finite are null)")


def _shape_options(sub: ArgumentParser) -> None:
    """Add the options that define a body."""
    shape = sub.add_argument_group("the body")
    shape.add_argument("--ell", type=float, help="aspect ratio: half length over outer radius")
    shape.add_argument(
        "--bore",
        type=part,
        help="inner over outer radius, 0 to 1 (default 0: solid), or a diameter as in 12.7mm",
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
        help="two balls; distance of their centres in diameters (default 1: they touch)",
    )
    shape.add_argument(
        "--ball",
        type=float,
        metavar="OFFSET",
        help="a ball; height of its centre of mass above its centre, in R",
    )
    shape.add_argument(
        "--theta-end",
        type=angle,
        metavar="ANGLE",
        help="inclination at which another part, such as a stem or a cap, touches the table",
    )
    shape.add_argument(
        "--outer", type=_length, metavar="LENGTH", help="outer diameter (with --balls: that of one ball)"
    )
    shape.add_argument("--inner", type=_length, metavar="LENGTH", help="inner diameter (default 0: solid)")
    shape.add_argument(
        "--wall", type=_length, metavar="LENGTH", help="thickness of the wall, instead of --inner"
    )
    shape.add_argument("--length", type=_length, metavar="LENGTH", help="length of the tube")


def _roll_options(sub: ArgumentParser) -> None:
    """Add the options that define a motion and its output."""
    start = sub.add_argument_group("the initial state")
    start.add_argument("--theta", type=angle, required=True, metavar="ANGLE", help="initial inclination")
    start.add_argument(
        "--kick", type=float, default=0.0, help="number added to the initial theta' (default 0)"
    )
    for name in ("w1", "w2", "w3"):
        start.add_argument(
            f"--{name}",
            type=float,
            help=f"{name} in sqrt(g/R); replaces the steady state, the others are then 0 by default",
        )
    start.add_argument(
        "--slip",
        type=float,
        nargs=2,
        metavar=("ALONG", "ACROSS"),
        help="slip of the contact point in sqrt(g R): in the vertical plane of the axis, and across it"
        " (coulomb, viscous)",
    )
    how = sub.add_argument_group("the motion")
    how.add_argument(
        "--t", type=time, required=True, metavar="TIME", help="last time, in sqrt(R/g), or as in 2s"
    )
    how.add_argument(
        "--points", type=whole_text, default=2001, help="number of times, from 0 on (default 2001)"
    )
    how.add_argument("--step", type=time, metavar="TIME", help="use RK4 with this step")
    how.add_argument("--tol", type=float, help="use an eighth-order method with this tolerance per step")
    laws = ("rolling", "smooth", "coulomb", "viscous")
    how.add_argument(
        "--contact",
        choices=laws,
        default="rolling",
        help="contact with the table; with the last two the body may slip (default: rolling)",
    )
    how.add_argument(
        "--mu",
        type=float,
        help="coefficient of friction: if rolling needs more, the motion ends, with coulomb the body slips"
        " (default: no limit to rolling)",
    )
    how.add_argument(
        "--static", type=float, metavar="MU", help="coulomb: coefficient of static friction (default: --mu)"
    )
    how.add_argument(
        "--patch",
        type=part,
        metavar="RADIUS",
        help="coulomb: radius of the contact patch, in R or as in 0.3mm",
    )
    how.add_argument(
        "--face",
        choices=tuple(FACES),
        help="coulomb: where a face on which the body stands presses: its rim (default) or all of it",
    )
    how.add_argument(
        "--viscosity", type=float, metavar="C", help="viscous: friction is C times normal force times slip"
    )
    _losses.option(how, "--loss")
    how.add_argument(
        "--beyond", action="store_true", help="continue the solution past lift-off, slip or the side"
    )
    _output_option(sub)


def _output_option(sub: ArgumentParser) -> None:
    sub.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help="output file: table (.csv, .npz, .nc for xarray), picture (.png, .pdf, .svg), page that shows"
        " the motion (.html), animated body (.glb), or scene that tests a contact engine (.json, .xml for"
        " MuJoCo); - writes CSV to standard output",
    )


def _scale_options(sub: ArgumentParser) -> None:
    """Add the options that define a scale."""
    scale = sub.add_argument_group("SI units")
    scale.add_argument("--radius", type=_length, metavar="LENGTH", help="outer radius R")
    scale.add_argument("--mass", type=_mass, help="mass in kg, or as in 20g, for energies in joules")
    scale.add_argument(
        "--gravity", type=quantity("gravity"), help="gravitational acceleration (default 9.80665 m/s2)"
    )
