"""Numbers as people write them, on the command line and in Python: 85deg, 85 deg, 85°, 16mm, 60s, 1e6."""

import math
import re
from argparse import ArgumentTypeError
from collections.abc import Callable, Sequence
from decimal import Decimal

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.I)
#: A decimal comma; the group matches if the comma may separate thousands.
_COMMA = re.compile(r",(?=\d)(\d{3}(?!\d)|\d+[.,])?")
_PLAIN_NEGATIVE = re.compile(r"-\d+|-\d*\.\d+")
# factors to SI by quantity and unit; the first unit is that of a number without one
_UNITS = {
    "length": {
        "m": "1",
        "cm": "1e-2",
        "mm": "1e-3",
        "um": "1e-6",
        "µm": "1e-6",
        "μm": "1e-6",
        "in": "0.0254",
    },
    "mass": {"kg": "1", "g": "1e-3", "mg": "1e-6"},
    "density": {
        "kg/m3": "1",
        "kg/m^3": "1",
        "kg/m³": "1",
        "g/cm3": "1e3",
        "g/cm^3": "1e3",
        "g/cm³": "1e3",
    },
    "moment of inertia": {
        "kgm2": "1",
        "kgm^2": "1",
        "kgm²": "1",
        "gcm2": "1e-7",
        "gcm^2": "1e-7",
        "gcm²": "1e-7",
        "gmm2": "1e-9",
        "gmm^2": "1e-9",
        "gmm²": "1e-9",
        "kgmm2": "1e-6",
        "kgmm^2": "1e-6",
        "kgmm²": "1e-6",
    },
    "gravity": {"m/s2": "1", "m/s^2": "1", "m/s²": "1"},
    "damping": {"Nms": "1"},
    "drag": {"Nms2": "1", "Nms^2": "1", "Nms²": "1"},
    "viscosity": {"Pas": "1", "mPas": "1e-3", "uPas": "1e-6"},
    "layer": {"C": "1"},
    "friction over speed": {"s/m": "1"},
    "impulse": {"Ns": "1", "mNs": "1e-3"},
    "speed": {"m/s": "1", "cm/s": "1e-2", "mm/s": "1e-3"},
    "frequency": {
        "Hz": "1",
        "turns/s": "1",
        "rad/s": "0.159154943091895335769",
        "rpm": "0.0166666666666666666667",
    },
    "angular velocity": {
        "rad/s": "1",
        "Hz": "6.28318530717958647693",
        "turns/s": "6.28318530717958647693",
        "rpm": "0.104719755119659774615",
    },
    "duration": {"s": "1", "ms": "1e-3", "us": "1e-6", "µs": "1e-6", "μs": "1e-6", "min": "60"},
}
_DEGREES = ("deg", "°", "degrees", "degree")
_NAMES = {unit for units in _UNITS.values() for unit in units} | {*_DEGREES, "rad"}


class Seconds(float):
    """A time given in seconds, not in sqrt(R/g)."""


class Metres(float):
    """A length given in metres, not in outer radii."""


class NewtonSeconds(float):
    """An impulse given in newton seconds, not in M sqrt(g R)."""


class MetresPerSecond(float):
    """A speed given in metres per second, not in sqrt(g R)."""


def join_units(argv: Sequence[str]) -> list[str]:
    """Join units to their numbers, and negative numbers that argparse does not recognise to their options."""
    words: list[str] = []
    for word in argv:
        last = words[-1] if words else ""
        unknown = word.startswith("-") and _is_quantity(word) and not _PLAIN_NEGATIVE.fullmatch(word)
        if word in _NAMES and _NUMBER.fullmatch(last):
            words[-1] += word
        elif unknown and last.startswith("--") and "=" not in last:
            words[-1] += f"={word}"
        else:
            words.append(word)
    return words


def _is_quantity(word: str) -> bool:
    found = _NUMBER.match(word)
    return found is not None and word[found.end() :].strip() in {"", *_NAMES}


def _parts(text: str) -> tuple[str, str]:
    """Split a text such as "85 deg" into the texts of its number and its unit, which may be empty."""
    found = _NUMBER.match(text.strip())
    if found is None:
        raise ArgumentTypeError(f"{text!r}: expected a number")
    unit = text.strip()[found.end() :].strip()
    comma = _COMMA.match(unit)
    if comma:
        like = "" if comma[1] else f": {text.replace(',', '.')!r}"
        raise ArgumentTypeError(f"{text!r}: write a decimal point, not a comma{like}")
    return found.group(), unit


def has_unit(text: str) -> bool:
    """Whether a text has a unit after its number."""
    return _parts(text)[1] != ""


def angle(text: str) -> float:
    """Convert the text of an angle, such as '1.3', '1.3rad', '85deg' or '85°', to radians."""
    number, unit = _parts(text)
    value = float(number)
    if unit in _DEGREES:
        return value * (math.pi / 180)
    if unit not in ("", "rad"):
        raise ArgumentTypeError(f"{text!r}: expected an angle, as in 1.3, 1.3rad or 85deg")
    if not unit and abs(value) > math.pi:
        raise ArgumentTypeError(f"{text!r}: expected radians; for degrees write {number}deg")
    return value


def _one(kind: str) -> str:
    return f"{'an' if kind[0] in 'ai' else 'a'} {kind}"


def quantity(kind: str) -> Callable[[str], float]:
    """Make a function that reads a quantity of one kind, such as a length, with or without a unit."""
    units = _UNITS[kind]

    def number_in_si(text: str) -> float:
        number, unit = _parts(text)
        unit = re.sub("[ *·]", "", unit)  # "N m s" and "N*m*s" as well as "Nms"
        if unit not in {"", *units}:
            known = ", ".join(filter(str.isascii, units))
            raise ArgumentTypeError(f"{text!r}: expected {_one(kind)}, without unit or in {known}")
        factor = units[unit] if unit else "1"
        try:
            # decimal arithmetic, so that 15.875mm equals 0.015875
            found = float(Decimal(number) * Decimal(factor))
        except ArithmeticError:  # an exponent beyond those of Decimal: infinite, or 0
            found = float(number)
        if math.isinf(found):
            raise ArgumentTypeError(
                f"{text!r}: expected {_one(kind)} of less than 1e308 in {next(iter(units))}"
            )
        return found

    return number_in_si


#: Sizes in metres and densities in kg/m^3, from foam to osmium, beyond which units are in doubt.
_LENGTHS, _DENSITIES = (1e-4, 5.0), (12.0, 23e3)
#: Kind of quantity by pint's name for its unit of SI.
_KINDS = {
    "metre": "length",
    "kilogram": "mass",
    "kilogram/metre**3": "density",
    "kilogram*metre**2": "moment of inertia",
    "second": "duration",
    "hertz": "frequency",
    "radian/second": "angular velocity",
    "metre/second": "speed",
    "second/metre": "friction over speed",
    "metre/second**2": "gravity",
    "newton*second": "impulse",
    "newton*metre*second": "damping",
    "newton*metre*second**2": "drag",
    "pascal*second": "viscosity",
    "": "layer",
}


#: An example of a text with a unit for each unit in `_KINDS`.
_EXAMPLES = {
    "metre": "16mm",
    "kilogram": "30g",
    "kilogram/metre**3": "7.85g/cm3",
    "kilogram*metre**2": "3.2e-6 kg m^2",
    "second": "2s",
    "radian": "85deg",
    "hertz": "9Hz",
    "radian/second": "14rad/s",
    "metre/second": "0.5m/s",
    "second/metre": "1s/m",
    "metre/second**2": "9.81m/s2",
    "newton*second": "2mNs",
    "newton*metre*second": "1e-6Nms",
    "newton*metre*second**2": "1e-6Nms2",
    "pascal*second": "18uPas",
    "": "25C",
}


def number_in_si(text: str, unit: str) -> float:
    """Convert a number with a unit to the unit `unit` of SI; TypeError if number or unit is missing."""
    known = unit in _KINDS or unit == "radian"
    if not known or _NUMBER.match(text.strip()) is None or not has_unit(text):
        like = f", or a text with a unit, as {_EXAMPLES[unit]!r}" if known else ""
        raise TypeError(f"expected real numbers{like}, not {text!r}")
    return angle(text) if unit == "radian" else quantity(_KINDS[unit])(text)


def _natural_or(kind: str, si: type[float]) -> Callable[[str], float]:
    """A function that reads a number in natural units or, if a unit is given, a quantity of this kind."""

    def number_in_si(text: str) -> float:
        number, unit = _parts(text)
        return si(quantity(kind)(text)) if unit else float(number)

    return number_in_si


#: A time in sqrt(R/g), or Seconds if it has a unit.
time = _natural_or("duration", Seconds)
#: A length of a part of the body in outer radii, or Metres if it has a unit.
part = _natural_or("length", Metres)
#: An impulse in M sqrt(g R), or NewtonSeconds if it has a unit.
impulse = _natural_or("impulse", NewtonSeconds)
#: A speed in sqrt(g R), or MetresPerSecond if it has a unit.
speed = _natural_or("speed", MetresPerSecond)


def whole_text(text: str) -> int:
    """Convert the text of a whole number, such as 1000000 or 1e6, to an int."""
    try:
        return int(text)
    except ValueError:
        number, unit = _parts(text)
        try:
            value = Decimal(number)
            found = value.copy_abs() <= 10**15 and value == value.to_integral_value()
        except ArithmeticError:  # an exponent beyond those of Decimal
            found = False
        if unit or not found:
            raise ArgumentTypeError(f"{text!r}: expected a whole number") from None
        return int(value)


def suspicion_of_units(what: str, sides: tuple[float, float], volume: float, mass: float) -> str:
    """Why a size (length, width) or a density seems to be in millimetres or grams; "" if neither does."""
    why = ""
    if max(sides) > _LENGTHS[1]:
        why = f"{sides[0]:.4g} m long and {sides[1]:.4g} m wide; 1 mm is 1e-3"
    elif sides[1] < _LENGTHS[0]:
        why = f"{sides[1]:.4g} m wide"
    elif volume > 0 and (mass < _DENSITIES[0] * volume or mass > _DENSITIES[1] * volume):
        why = f"as dense as {mass / volume:.3g} kg/m^3, where water has 1000; 1 g is 1e-3"
    return why and f"the {what} is {why}: are these metres and kilograms?"
