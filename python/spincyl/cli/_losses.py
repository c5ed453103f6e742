"""Options for loss laws: dry-contour=5e-3, rolling-resistance=0.2mm, air-film=18uPas."""

import re
from argparse import ArgumentTypeError, Namespace
from functools import partial
from typing import Any, NamedTuple

from spincyl import Scale, loss
from spincyl._input.units import has_unit, quantity
from spincyl._loss import Law, Loss, sized

#: The kind of quantity that each law takes in SI.
_KINDS: dict[type[Law], str] = {
    loss.DryContour: "length",
    loss.ViscousContour: "damping",
    loss.RollingResistance: "length",
    loss.Drilling: "length",
    loss.AirLinear: "damping",
    loss.AirQuadratic: "drag",
    loss.AirFilm: "viscosity",
    loss.BoundaryLayer: "layer",
}
_NAMES = {re.sub(r"\B(?=[A-Z])", "-", law.__name__).lower(): law for law in _KINDS}

TEXT = """\
Loss laws, with coefficients in natural units of M, R and g, or in SI with --radius and --mass:
  dry-contour=5e-3         or 0.2mm     dry friction along the rim
  viscous-contour=1e-3     or 1e-6Nms   the same, proportional to the speed of the contact point
  rolling-resistance=1e-3  or 0.04mm    rolling resistance: distance of the normal force ahead of the contact
  drilling=1e-3            or 0.04mm    friction against rotation about the vertical
  air-linear=1e-4          or 1e-7Nms   air resistance proportional to the angular velocity
  air-quadratic=1e-5       or 1e-9Nms2  air resistance proportional to its square
  air-film=1e-7            or 18uPas    thin film of air under the face: viscosity of the air
  boundary-layer=1e-6      or 0.1C      boundary layer of air under the face; C is a number of order 0.1"""


class Given(NamedTuple):
    """A loss law from the command line."""

    text: str
    law: Any
    value: float
    si: bool


def law(text: str) -> Given:
    """Read a law and its coefficient."""
    name, equals, number = text.partition("=")
    if name not in _NAMES or not equals:
        raise ArgumentTypeError(
            f"{text!r}: expected NAME=VALUE, such as dry-contour=5e-3, NAME one of {', '.join(_NAMES)}"
        )
    found = _NAMES[name]
    return Given(text, found, quantity(_KINDS[found])(number), has_unit(number))


def option(sub: Any, *names: str, required: bool = False) -> None:
    """Add an option for loss laws, which may be repeated."""
    sub.add_argument(
        *names,
        dest="losses",
        type=law,
        action="append",
        required=required,
        metavar="LAW=VALUE",
        help="loss law, such as dry-contour=5e-3; repeat the option to add several",
    )


def losses_of(args: Namespace, scale: Scale | None) -> Loss | None:
    """The losses given by the options; None without any."""
    if args.losses is None:
        return None
    return loss.Sum(_made(given, scale, weighed=args.mass is not None) for given in args.losses)


def _made(given: Given, scale: Scale | None, *, weighed: bool) -> Law:
    """A law in natural units."""
    made: Any = given.law
    if given.si:
        if scale is None:
            raise ValueError(f"{given.text} needs --radius, or --outer and --length in metres")
        if _KINDS[given.law] != "length" and not weighed:
            raise ValueError(f"{given.text} needs --mass, the mass of the body")
        made = partial(given.law.from_si, scale=scale)
    try:
        found: Law = made(given.value)
    except ValueError as e:
        raise ValueError(f"{given.text}: {e}") from None
    # a number without a unit is in natural units, also for a measured body, as the help says
    return sized(found)
