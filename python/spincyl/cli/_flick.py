"""The command `flick`: a tube on its side that is pressed or launched, and slips until it rolls."""

from argparse import ArgumentParser, Namespace
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from spincyl import Body, Scale, State, flicked, launch_number, pressed, roll
from spincyl._input.units import (
    MetresPerSecond,
    NewtonSeconds,
    Seconds,
    angle,
    impulse,
    part,
    quantity,
    speed,
    time,
    whole_text,
)
from spincyl._measured import errors_in_seconds
from spincyl.cli._commands import body_of, coulomb, delivered, natural, recipient
from spincyl.cli._losses import TEXT as LAWS
from spincyl.cli._losses import losses_of, option
from spincyl.cli._output import Working
from spincyl.cli._tell import Row

TEXT = f"""\
Compute the motion of a tube that lies on its side and is flicked: it slips, and may then roll on one rim.

The launch is one of
  --precession 17Hz --launch-number 1.3   turns per second about the vertical, and launch number
                                          I3 w1 w3/(M g l); above 1 the end that was pressed rises
  --precession 17Hz --spin 18Hz           turns per second about the vertical and about the axis
  --w1 3 --launch-number 1.3              angular velocity in sqrt(g/R), if no radius is known
  --impulse 60mNs --angle 75deg           push of a finger that presses one end down and slides off:
                                          impulse, and angle from the top of the rim
By default the centre moves across the axis with -I1 w1/l, the velocity that a finger gives it; --centre
sets another velocity. Positive spin is backspin relative to this motion. With --loss the tube also loses
energy while it rolls, and sinks back to its side.

{LAWS}

"""

EXAMPLES = """\
spincyl flick --outer 15.875mm --bore 12.7mm --length 95.25mm --mu 0.3 --precession 17Hz --spin 18Hz
spincyl flick --ell 6 --bore 0.8 --radius 8mm --mu 0.3 --precession 17Hz --launch-number 1.3 -o flick.html
spincyl flick --ell 6 --bore 0.8 --radius 8mm --mass 20g --mu 0.3 --impulse 60mNs --angle 75deg
spincyl flick --ell 6 --bore 0.8 --mu 0.15 --w1 4 --launch-number 1.1 --t 200 --json
spincyl flick --ell 6 --bore 0.8 --mu 0.3 --w1 3 --launch-number 1.3 --loss rolling-resistance=1e-3"""


def flick_options(sub: ArgumentParser) -> None:
    """Add the options for the launch of a tube and the output of its motion."""
    launch = sub.add_argument_group("the launch")
    hertz: dict[str, Any] = {"type": quantity("frequency"), "metavar": "HERTZ"}
    launch.add_argument("--precession", **hertz, help="turns per second about the vertical")
    launch.add_argument("--w1", type=float, help="angular velocity about the vertical, in sqrt(g/R)")
    launch.add_argument("--spin", **hertz, help="turns per second about the axis; positive is backspin")
    launch.add_argument(
        "--launch-number", type=float, metavar="X", help="I3 w1 w3/(M g l), instead of --spin"
    )
    launch.add_argument(
        "--centre",
        type=speed,
        metavar="SPEED",
        help="velocity of the centre of mass across the axis, in sqrt(g R), or as in 1.5m/s (default:"
        " -I1 w1/l, as after a press by a finger)",
    )
    push = sub.add_argument_group("the push, instead of the launch")
    push.add_argument(
        "--impulse", type=impulse, help="impulse of the finger in M sqrt(g R), or as in 40mNs with a mass"
    )
    push.add_argument(
        "--angle", type=angle, metavar="ANGLE", help="angle of the finger from the top of the rim"
    )
    push.add_argument(
        "--finger", type=float, metavar="MU", help="coefficient of friction of the finger (default 0.6)"
    )
    push.add_argument(
        "--table",
        type=float,
        metavar="MU",
        help="coefficient of friction of the table under the pressed end (default: --mu)",
    )
    how = sub.add_argument_group("the motion")
    how.add_argument("--mu", type=float, required=True, help="coefficient of friction of the table")
    how.add_argument(
        "--static", type=float, metavar="MU", help="coefficient of static friction (default: --mu)"
    )
    how.add_argument(
        "--patch", type=part, metavar="RADIUS", help="radius of the contact patch, in R or as in 0.3mm"
    )
    lasting = how.add_mutually_exclusive_group()
    lasting.add_argument(
        "--seconds",
        type=quantity("duration"),
        help="last time in seconds (default 3; without a radius: --t 100)",
    )
    lasting.add_argument("--t", type=time, metavar="TIME", help="last time in sqrt(R/g), or as in 2s")
    how.add_argument(
        "--points", type=whole_text, default=2001, help="number of times, from 0 on (default 2001)"
    )
    how.add_argument("--tol", type=float, help="tolerance of each step while the body slips (default 1e-14)")
    how.add_argument(
        "--restitution",
        type=float,
        metavar="BOUNCE",
        help="coefficient of restitution, 0 to 1: the motion continues after lift-off and after a landing of"
        " the other rim (default: the motion ends there)",
    )
    option(how, "--loss")


def flick(args: Namespace) -> None:
    """Compute a flick; print its launch and phases, and write a file."""
    body, scale = body_of(args)
    if args.points < 2:
        raise ValueError(f"--points {args.points}: expected at least 2")
    if not body.ell > 0:
        raise ValueError(f"ell = {body.ell:g}: expected ell > 0, since a flick needs a body with two rims")
    seconds = None if args.seconds is None else Seconds(args.seconds)
    lasting = args.t if seconds is None else seconds
    if lasting is None:
        lasting = 100.0 if scale is None else Seconds(3.0)
    last = natural("--seconds" if args.t is None else "--t", lasting, scale)
    contact = coulomb(args, scale)
    losses = losses_of(args, scale)
    start = _pushed(args, body, scale) if args.impulse is not None else _launched(args, body, scale)
    writer = recipient(args)
    with Working("flick"):
        t = np.linspace(0.0, last or 0.0, args.points)
        how: dict[str, Any] = {"tol": args.tol, "restitution": args.restitution, "losses": losses}
        with errors_in_seconds(scale if isinstance(lasting, Seconds) else None):
            m = roll(body, start, t, want=("pose", "force"), contact=contact, **how)
        if args.output is not None and m.event is not None and m.event.time == 0:
            number = launch_numbers(body, start)["number"]
            raise ValueError(
                f"launch number {number:.6g}: the motion ends at once and is not written; {m.message}"
            )
        if writer is not None:
            writer(m, scale, Path(args.output))
    delivered(args, m, scale, launch_rows(body, start, scale), {"launch": launch_numbers(body, start)})


def _launched(args: Namespace, body: Body, scale: Scale | None) -> State:
    """The initial state from the rates of rotation in the options of the launch."""
    for name in ("angle", "finger", "table"):
        if getattr(args, name) is not None:
            raise ValueError(f"--{name} needs --impulse; it has no effect on a launch given by speeds")
    if (args.w1 is None) == (args.precession is None):
        raise ValueError("give exactly one of --precession and --w1; or give --impulse and --angle instead")
    if (args.launch_number is None) == (args.spin is None):
        raise ValueError("give exactly one of --launch-number and --spin")
    if scale is None and not (args.precession is None and args.spin is None):
        name = "--spin" if args.precession is None else "--precession"
        raise ValueError(f"{name} needs --radius, or --outer and --length in metres; without them give --w1")
    if args.spin is None and 0 in (args.precession, args.w1):
        raise ValueError("--launch-number needs a precession other than zero; for zero give --spin instead")
    centre = args.centre
    if isinstance(centre, MetresPerSecond) and scale is None:
        raise ValueError("--centre in m/s needs --radius, or --outer and --length in metres")
    if centre is not None and scale is not None and not isinstance(centre, MetresPerSecond):
        centre = scale.metres_per_second(centre)
    told = {"hertz": args.precession, "w1": args.w1, "launch": args.launch_number, "spin_hertz": args.spin}
    return flicked(body, **told, centre=centre, scale=scale)


def _pushed(args: Namespace, body: Body, scale: Scale | None) -> State:
    """The initial state from the impulse and the angle of a finger."""
    for name in ("precession", "w1", "spin", "launch_number", "centre"):
        if getattr(args, name) is not None:
            raise ValueError(
                f"--{name.replace('_', '-')} cannot be combined with --impulse, which gives the whole launch"
            )
    if args.angle is None:
        raise ValueError(
            "--impulse needs --angle, the angle of the finger from the top of the rim, such as 45deg"
        )
    finger = 0.6 if args.finger is None else args.finger
    table = args.mu if args.table is None else args.table
    impulse = args.impulse
    if isinstance(impulse, NewtonSeconds):
        if scale is None or args.mass is None:
            raise ValueError("--impulse in newton seconds needs --mass and --radius (or --outer, --length)")
        impulse = float(impulse) / (scale.mass * scale.metres_per_second(1.0))
    return pressed(body, impulse, args.angle, finger=finger, table=table)


def launch_numbers(body: Body, state: State) -> dict[str, Any]:
    """Properties of the state just after a launch, as numbers for JSON."""
    number = float(launch_number(body, state))
    return {"number": number, "rises": number > 1, "centre": float(body.centre_velocity(state)[1])}


def launch_rows(body: Body, state: State, scale: Scale | None) -> Iterator[Row]:
    """Properties of the state just after a launch, as rows of a table."""
    n = launch_numbers(body, state)
    turns = "" if scale is None else f"{scale.turns(state.w1):.6g}, {scale.turns(state.w3):.6g} turns/s"
    yield "launch w1, w3", f"{state.w1:.9g}, {state.w3:.9g}", turns
    yield "launch number", f"{n['number']:.6g}", "" if n["rises"] else "at most 1: the end does not rise"
