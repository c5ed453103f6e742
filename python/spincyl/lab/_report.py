"""Reports in the style of lmfit: sections with titles in brackets, and variables with their errors."""

import math
import textwrap
from collections.abc import Sequence

WIDE = 88  # columns


def section(title: str, rows: Sequence[tuple[str, str]], joint: str = " = ") -> list[str]:
    """Lines of a section: its title, and rows of name and text, which are wrapped."""
    wide = max((len(name) for name, _ in rows), default=0)
    lines = [f"[[{title}]]"]
    for name, said in rows:
        head = f"    {name.ljust(wide)}{joint}"
        lines += textwrap.wrap(
            said,
            WIDE,
            initial_indent=head,
            subsequent_indent=" " * len(head),
            break_long_words=False,
            break_on_hyphens=False,
        ) or [head.rstrip()]
    return lines


def variables(rows: Sequence[tuple[str, float, float, str]]) -> list[str]:
    """Lines of the section "Variables": name, value, standard error and note."""
    told = []
    for name, value, error, note in rows:
        said = with_error(value, error, "+/-") if error > 0 and math.isfinite(error) else written(value)
        if value and "+/-" in said:
            said += f" ({100 * abs(error / value):.2g}%)"
        told.append((f"{name}:", f"{said} {note}" if note else said))
    return section("Variables", told, "  ")


def with_error(value: float, error: float, joint: str = "+-") -> str:
    """A number with as many decimals as its standard error, and the error with two digits."""
    if not (error > 0 and math.isfinite(error)):
        return f"{value:.6g} {joint} {error:.2g}"
    digits = max(0, 1 - math.floor(math.log10(error)))
    plain = 1e-4 <= abs(value) < 1e6 and digits <= 12
    return f"{f'{value:.{digits}f}' if plain else f'{value:.6g}'} {joint} {error:#.2g}".rstrip(".")


def written(value: float) -> str:
    """A number as text with six digits."""
    return f"{value:.6g}"


def counted(many: int) -> str:
    """A count as text: a word if it is small, else digits."""
    words = ("none", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
    return words[many] if many < len(words) else str(many)


def student(errors: float, freedom: int) -> float:
    """Student's t: number of estimated standard errors that is as unlikely as `errors` true ones.

    Computed from the normal deviate, after Wallace (1959), Ann. Math. Statist. 30, 1121.
    """
    normal = errors * (8 * freedom + 3) / (8 * freedom + 1)
    return math.sqrt(freedom * math.expm1(min(normal**2 / freedom, 50.0)))
