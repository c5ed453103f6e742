"""The command `play`: an interactive page that computes motions, as one file."""

import math
import sys
import webbrowser
from argparse import ArgumentParser, Namespace
from dataclasses import replace
from pathlib import Path

from spincyl import Table, play
from spincyl._contact import AnyContact
from spincyl._input.units import angle, part
from spincyl._scale import Scale
from spincyl.cli._commands import body_of, contact_of
from spincyl.cli._losses import losses_of, option
from spincyl.cli._output import writable
from spincyl.studio.pages.languages import LANGUAGES
from spincyl.studio.pages.words import paper_tube

TEXT = """\
Write an interactive page: a single file that computes motions itself, also offline. Drag a point on
the map of inclination and aspect ratio, take the body by hand, or move a slider, and the page
computes the exact motion. The options set the body and the motion with which the page begins. The
default body is the tube of the paper at 89.5 degrees.

"""

EXAMPLES = """\
spincyl play -o play.html
spincyl play --ell 6 --bore 0.8 --theta 89.5deg -o tube.html
spincyl play --ell 0.375 --theta 80deg --kick -0.01 --contact smooth -o ice.html
spincyl play --ell 0.17 --theta 0.3 --loss dry-contour=5e-3 --t 400 -o whirr.html
spincyl play --ell 0.5 --theta 1.2 --contact coulomb --mu 0.3 --restitution 0.5 -o hops.html
spincyl play --ell 2.5 --slope 5deg --language de -o slope.html
spincyl play --theta 80deg --contact coulomb --mu 0.3 --patch 0.01 -o dry.html
spincyl play --balls --theta 78deg --open -o balls.html"""


def play_options(sub: ArgumentParser) -> None:
    """Add the options for the initial state and the output of the page."""
    how = sub.add_argument_group("the motion with which the page begins")
    how.add_argument(
        "--theta", type=angle, metavar="ANGLE", help="inclination (default 1.3, for the default tube 89.5deg)"
    )
    how.add_argument("--kick", type=float, default=0.0, help="number added to the initial theta' (default 0)")
    tables = ("rolling", "smooth", "coulomb", "viscous")
    how.add_argument(
        "--contact", choices=tables, default="rolling", help="contact with the table (default: rolling)"
    )
    how.add_argument("--mu", type=float, help="coulomb: coefficient of friction")
    how.add_argument(
        "--patch",
        type=part,
        metavar="RADIUS",
        help="coulomb: radius of the contact patch, in R or as in 0.3mm",
    )
    how.add_argument(
        "--viscosity", type=float, metavar="C", help="viscous: friction is C times normal force times slip"
    )
    bounce = "coefficient of restitution, 0 to 1, with friction (default: the motion ends at lift-off)"
    how.add_argument("--restitution", type=float, metavar="BOUNCE", help=bounce)
    option(how, "--loss")
    how.add_argument(
        "--slope", type=angle, metavar="ANGLE", help="slope of the table, 0 to 45deg (default: level)"
    )
    how.add_argument(
        "--t",
        type=float,
        default=60.0,
        help="last time of motions with friction or losses, in sqrt(R/g) (default 60)",
    )
    how.add_argument(
        "--slow",
        type=float,
        default=20.0,
        help="factor of slow motion (default 20; a body without a size has R = 1 cm)",
    )
    sub.add_argument("-o", "--output", required=True, metavar="FILE", help="output file (.html)")
    sub.add_argument(
        "--lean",
        action="store_true",
        help="smaller page without friction and losses: rolling or a smooth table",
    )
    sub.add_argument(
        "--language", choices=("en", *LANGUAGES), help="language of the page (default: that of the browser)"
    )
    sub.add_argument("--open", action="store_true", help="open the page in the browser")


def run(args: Namespace) -> None:
    """Write the interactive page to a file, and open it in the browser if --open is given."""
    told = args.ell, args.balls, args.ball, args.outer, args.inner, args.length, args.bore, args.fillet
    body, scale = (None, None) if all(x is None for x in told) else body_of(args)
    if body is not None and scale is not None:
        size = replace(scale, mass=math.nan if args.mass is None else args.mass)
        body = replace(body, scale=size)
        args.t *= float(size.seconds(1.0))
    if body is None:
        args.t *= paper_tube()._second
    if args.restitution is not None and args.contact not in ("coulomb", "viscous"):
        raise ValueError("--restitution needs --contact coulomb or --contact viscous")
    path = writable(args.output)
    made = play(
        body,
        args.theta,
        kick=args.kick,
        contact=_table(args, scale),
        losses=losses_of(args, scale),
        restitution=args.restitution,
        table=None if args.slope is None else Table(args.slope),
        t=args.t,
        slow=args.slow,
        language=args.language,
        friction=not args.lean,
    ).save(path)
    print(f"{made.stat().st_size / 1000:.0f} kB in {made}")
    if args.open and not webbrowser.open(Path(made).resolve().as_uri()):
        print("spincyl play: no browser was found to open the page", file=sys.stderr)


def _table(args: Namespace, scale: Scale | None) -> AnyContact:
    """The contact given by the options, with its coefficient; the page has no static friction."""
    if args.mu is not None and args.contact != "coulomb":
        raise ValueError("--mu needs --contact coulomb")
    args.static = None
    return contact_of(args, scale)
