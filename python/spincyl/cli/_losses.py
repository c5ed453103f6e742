"""Options for loss laws, such as dry-contour=5e-3, rolling-resistance=0.2mm, air-film=18uPas."""

from argparse import ArgumentTypeError, Namespace
from functools import partial
from typing import Any, NamedTuple

from spincyl import Scale, loss
from spincyl._input.units import has_unit, quantity
from spincyl._loss import LAWS, Law, Loss, command_line_name, marked_as_si
from spincyl.loss import KINDS

#: The coefficients of the laws by the names of the laws on the command line, in the order of the core.
_NAMES = {command_line_name(law): coefficient for coefficient, law in KINDS.items()}


def _help_line(name: str, coefficient: str) -> str:
    """A line of help on a loss law: its name, an example in natural units, one in SI, and what it is."""
    natural, in_si, words = KINDS[coefficient]._example
    return f"  {name + '=' + natural:<24} or {in_si:<9} {words}"


TEXT = "\n".join(
    [
        "Loss laws, with coefficients in natural units of M, R and g, or in SI with --radius and --mass:",
        *(_help_line(*one) for one in _NAMES.items()),
    ]
)


class Given(NamedTuple):
    """A loss law from the command line."""

    text: str
    coefficient: str
    value: float
    si: bool

    @property
    def measures(self) -> str:
        """The kind of quantity that the unit of the coefficient measures."""
        return LAWS[self.coefficient].measures


def law(text: str) -> Given:
    """Read a loss law and its coefficient from a text such as "dry-contour=5e-3"."""
    name, equals, number = text.partition("=")
    if name not in _NAMES or not equals:
        raise ArgumentTypeError(
            f"{text!r}: expected NAME=VALUE, such as dry-contour=5e-3, NAME one of {', '.join(_NAMES)}"
        )
    found = _NAMES[name]
    return Given(text, found, quantity(LAWS[found].measures)(number), has_unit(number))


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
    """The losses that the options give; None if no option gives a loss."""
    if args.losses is None:
        return None
    return loss.Sum(_law_of_given(given, scale, weighed=args.mass is not None) for given in args.losses)


def _law_of_given(given: Given, scale: Scale | None, *, weighed: bool) -> Law:
    """Make the loss law in natural units; `weighed` is true if the mass is known."""
    made: Any = KINDS[given.coefficient]
    if given.si:
        if scale is None:
            raise ValueError(f"{given.text} needs --radius, or --outer and --length in metres")
        if given.measures != "length" and not weighed:
            raise ValueError(f"{given.text} needs --mass, the mass of the body")
        made = partial(made.from_si, scale=scale)
    try:
        found: Law = made(given.value)
    except ValueError as e:
        raise ValueError(f"{given.text}: {e}") from None
    # a number without a unit is in natural units, also for a measured body, as the help says
    return marked_as_si(found)
