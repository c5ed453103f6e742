"""Which bodies, tables, losses and impacts go together: every combination is tried with a short motion.

    python tests/combinations.py            count the combinations that are followed and refused, and why
    python tests/combinations.py --write    the same, and write the tables of docs/combinations.md

A refusal has to have one of the `REASONS`.
"""

import argparse
import collections
import itertools
import re
import warnings
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from loss_rows import USUAL

import spincyl as sc

PAGE = Path(__file__).parents[1] / "docs" / "combinations.md"
BEGINS, ENDS = "<!-- tables: python tests/combinations.py --write -->\n", "<!-- end of the tables -->\n"
#: The last time; before it every body that starts in the air has struck the table.
TIME = 0.1
#: The height and the velocity from which bodies fall.
ALOFT = 0.002, -0.1
#: Two starts of each body: their factor of the angular velocity.
STARTS = 0.6, 0.4


def bodies():
    """A body of every kind, and the inclination at which it starts."""
    parts = sc.parts
    cup = parts.cone(lower_diameter=2.0, upper_diameter=1.4, length=1.5, mass=1.0)
    wheel = parts.cylinder(outer_diameter=2.0, length=1.6, mass=1.0)
    axle = parts.cylinder(outer_diameter=0.8, length=0.3, mass=0.1)
    return {
        "equal rims": sc.Body.solid(1.5),
        "unequal rims": sc.assembled([cup]).natural,
        "one rim": sc.Body(0.8, 0.5, 0.45, theta_end=np.pi),
        "ball end": sc.Body.solid(2.0, fillet=1.0),
        "ball": sc.Body.ball(-0.2, 0.4, 0.4),
        "assembled parts": sc.assembled([wheel, axle]).natural,
        "stone": sc.Ellipsoid.uniform((1.0, 0.8, 0.6)),
    }


TABLES = {
    "rolling": "rolling",
    "smooth": "smooth",
    "Coulomb": sc.Coulomb(0.3),
    "static": sc.Coulomb(0.3, static=0.4),
    "viscous": sc.Viscous(0.5),
    "patch": sc.Coulomb(0.3, patch=0.05),
    "your own": sc.custom.Friction(lambda speed: 0.2 + 0.1 / (1.0 + speed * speed)),
}
LOSSES = {
    "none": None,
    **{f"`{name}`": law for name, law in USUAL.items()},
    "a sum": sc.loss.RollingResistance(1e-3) + sc.loss.AirLinear(1e-3),
    "your own": sc.custom.Couple(lambda theta, w, normal: -1e-3 * w),
}
RESTITUTIONS = {"none": None, "0": 0.0, "0.5": 0.5}
WAYS = "one", "many"


class Reason(NamedTuple):
    """Why a combination is refused: a letter, the message, whether physics excludes it, and a sentence."""

    letter: str
    message: str
    physics: bool
    sentence: str


REASONS = [
    Reason("A", r"a flat face above the table", True,
           "The loss law is that of air below a flat face, and a ball has no face."),
    Reason("B", r"acts along a rim, which a stone", True,
           "The loss law acts along a rim, and a stone has no rim."),
    Reason("C", r"together with drilling friction, which gives the same couple", True,
           "The friction of a patch already resists drilling; the loss law `Drilling` would count it twice."),
    Reason("D", r"are those of a body of revolution, and a stone has no axis", True,
           "A couple of your own is a function of the inclination of an axis, and a stone has no axis."),
]  # fmt: skip
#: The refusal of a body in the air whose outline is not known.
SHAPE = r"^theta_end = .* its shape is unknown"
#: Combinations that are refused for one motion and not for many, or the other way: none.
EXCEPT: set[tuple[str, str, str, str]] = set()


def start(body: Any, rubs: bool, falls: bool, factor: Any) -> Any:
    """The start of one body, or of several if the factor of the angular velocity is an array."""
    height = {"height": ALOFT[0], "lift": ALOFT[1]} if falls else {}
    slip = (0.2, 0.1) if rubs or falls else None
    if isinstance(body, sc.Ellipsoid):
        w, n = np.multiply.outer(factor, (0.2, 0.3, 2.0)), np.array((0.3, 0.4, 0.75**0.5))
        return sc.EllipsoidState(n, w, slip=slip, **height)
    return sc.State(0.4, 0.3 * factor, 0.1 * factor, 1.5 * factor, slip=slip, **height)


def one(body: Any, contact: Any, losses: Any, restitution: Any, falls: bool, factor: float) -> Any:
    """One motion: its last state, and what the energy of each time and its losses sum up to."""
    state = start(body, not isinstance(contact, str), falls, factor)
    how = {"contact": contact, "losses": losses, "restitution": restitution}
    m = sc.roll(body, state, np.array([0.0, TIME / 2, TIME]), t0=0.0, **how)
    sums = m.energy
    for name, there in (
        ("dissipated", not isinstance(contact, str) or restitution is not None),
        ("work_lost", losses is not None),
        ("lost_in_impacts", restitution is not None),
    ):
        if there:
            sums = sums + getattr(m, name)
    last = m.y[:, -1] if isinstance(body, sc.Ellipsoid) else np.array([m.theta[-1], *m.w[-1]])
    return m, last, sums


def many(body: Any, contact: Any, losses: Any, restitution: Any, falls: bool) -> Any:
    """The last states of a sweep with both starts."""
    state = start(body, not isinstance(contact, str), falls, np.array(STARTS))
    how = {"contact": contact, "losses": losses, "restitution": restitution, "want": "final"}
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".* motions are invalid")
        found = sc.sweep.roll(body, state, TIME, **how, threads=1)
    names = (*(("n1", "n2", "n3") if isinstance(body, sc.Ellipsoid) else ("theta",)), "w1", "w2", "w3")
    return found["status"].values, np.array([found[name].values for name in names])


class Cell(NamedTuple):
    """What became of a combination: a refusal in words, or a motion and what is wrong with it.

    `lands` is false if there is a restitution and no motion of this body may begin in the air.
    """

    refusal: str
    faults: tuple[str, ...] = ()
    lands: bool = True


def cells() -> dict[tuple[str, str, str, str, str], Cell]:
    """Every combination, tried: body, table, losses, restitution, and one motion or many."""
    found: dict[tuple[str, str, str, str, str], Cell] = {}
    axes = bodies().items(), TABLES.items(), LOSSES.items(), RESTITUTIONS.items()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for (a, body), (b, contact), (c, losses), (d, e) in itertools.product(*axes):
            single, several = tried(body, contact, losses, e, e is not None)
            if re.search(SHAPE, single.refusal):
                single, several = (
                    cell._replace(lands=False) for cell in tried(body, contact, losses, e, False)
                )
            found[a, b, c, d, "one"], found[a, b, c, d, "many"] = single, several
    return found


def tried(*combination: Any) -> tuple[Cell, Cell]:
    """One combination, as single motions and as a sweep of the same motions."""
    lasts, faults, single = [], [], None
    try:
        for factor in STARTS:
            m, last, sums = one(*combination, factor)
            lasts.append(last)
            if not (np.isfinite(last).all() and np.isfinite(sums).all() and np.isfinite(m.error)):
                faults.append("a number is not finite")
            if not (np.ptp(sums) <= 1e-9 + 10 * m.error):
                faults.append(f"the energy changes by {np.ptp(sums):.1e}")
            if m.status != sc.Ending.DONE:
                faults.append(f"the motion ends: {m.status.name}")
            if combination[-1] and not m.impacts:
                faults.append("the body does not strike the table")
    except (ValueError, TypeError) as error:
        single = Cell(str(error))
    try:
        status, states = many(*combination)
        if (status == sc.sweep.Status.INVALID).all():  # the single motion says why
            several = Cell(single.refusal if single else "INVALID")
        else:
            off = [] if single else [abs(states - np.transpose(lasts)).max()]
            several = Cell("", tuple(f"differs from one motion by {x:.1e}" for x in off if not x < 1e-7))
    except (ValueError, TypeError) as error:
        several = Cell(str(error))
    return single or Cell("", tuple(faults)), several


def reason(refusal: str) -> Reason:
    """The reason of a refusal; LookupError if the table of reasons has none or several."""
    fits = [reason for reason in REASONS if re.search(reason.message, refusal)]
    if len(fits) != 1:
        raise LookupError(f"{len(fits)} reasons for the refusal: {refusal}")
    return fits[0]


def letters(found: dict[tuple[str, str, str, str, str], Cell]) -> dict[tuple[str, ...], str]:
    """The letter of each cell's reason; empty if the combination is followed, "*" if only on the table.

    A message names one of several reasons. If one of them is that of physics, the letter is that one: it is the reason
    without a restitution, on this table or on one with friction at a point.
    """
    of = {
        key: reason(cell.refusal).letter if cell.refusal else "" if cell.lands else "*"
        for key, cell in found.items()
    }
    excluded = {x.letter for x in REASONS if x.physics}
    for (body, table, law, e, way), letter in of.items():
        plain = of[body, "Coulomb", law, "none", way], of[body, table, law, "none", way]
        more = [x for x in plain if x in excluded]
        of[body, table, law, e, way] = more[0] if letter not in ("", "*") and more else letter
    return of


def count(found: dict[tuple[str, str, str, str, str], Cell]) -> str:
    """The reasons as a table, with the numbers of their combinations."""
    of = letters(found)
    lines = [
        "Each row is a reason to refuse a combination, with the number of combinations that are refused for it:",
        "",
        "| letter of the reason | reason | number of combinations refused for one motion (`roll`) | number of combinations refused for many motions (`sweep.roll`) |",
        "| --- | --- | --- | --- |",
    ]
    for physics in (True, False):
        for x in (x for x in REASONS if x.physics is physics):
            counts = [sum(of[k] == x.letter for k in of if k[-1] == way) for way in WAYS]
            lines.append(f"| {x.letter} | {x.sentence} | {counts[0]} | {counts[1]} |")
    by_physics = {x.letter for x in REASONS if x.physics}
    refused = [letter for letter in of.values() if letter not in ("", "*")]
    excluded = sum(letter in by_physics for letter in refused)
    total = (
        f"Of {len(of):,} combinations {len(of) - len(refused):,} are computed and {len(refused):,} refused"
    )
    if excluded == len(refused):
        total += ", because physics does not\ndefine them."
    else:
        total += (
            f": {excluded:,} because physics does not define them,\n{len(refused) - excluded:,} because two parts of"
            " the library do not know each other yet."
        )
    return "\n".join([total, "", *lines, ""])


#: the sentence before each table
_KEY = (
    "Each row is a loss law, and each column a law of friction of the contact. A cell says whether motions with both are"
    ' computed: "yes", "on the\ntable" (only as long as the body touches the table), or "no" with the letter of the reason:'
    " A, a ball has no face; B, a stone\nhas no rim; C, a patch resists drilling already; D, a stone has no axis."
)
#: heads of the columns
_HEADS = {
    "rolling": "rolling without slip",
    "smooth": "no friction",
    "Coulomb": "Coulomb friction",
    "static": "Coulomb friction with larger static friction",
    "viscous": "viscous friction",
    "patch": "Coulomb friction on a patch",
    "your own": "friction law of your own",
}
#: restitutions in words
_WITH = {
    ("none",): "without impacts",
    ("0", "0.5"): "with impacts",
    ("none", "0", "0.5"): "with impacts or without",
}
#: loss laws in words
_ROWS = {
    "none": "no losses",
    "a sum": "rolling resistance and linear air resistance",
    "your own": "loss law of your own",
}


def grid(of: dict[tuple[str, ...], str], body: str, e: str) -> str:
    """Losses by tables for a body and a restitution, where one motion and many agree."""
    head = "| loss law | " + " | ".join(_HEADS[x] for x in TABLES) + " |"
    lines = [head, "| --- |" + " --- |" * len(TABLES)]
    for law in LOSSES:
        both = [{of[body, table, law, e, way] for way in WAYS} for table in TABLES]
        row = [
            " or ".join(sorted({"": "yes", "*": "on the table"}.get(x, f"no ({x})") for x in some))
            for some in both
        ]
        lines.append(f"| {_ROWS.get(law, law)} | " + " | ".join(row) + " |")
    return "\n".join([*lines, ""])


def tables(found: dict[tuple[str, str, str, str, str], Cell]) -> str:
    """The generated part of the page; equal grids stand once."""
    of, grids = letters(found), collections.defaultdict(list)
    for body, e in itertools.product(bodies(), RESTITUTIONS):
        grids[grid(of, body, e)].append((body, e))
    text = ["\n" + count(found)]
    for table, keys in grids.items():
        alike = collections.defaultdict(list)
        for e in dict.fromkeys(e for _, e in keys):
            alike[tuple(body for body, other in keys if other == e)].append(e)
        heads = [f"{', '.join(names)}, {_WITH[tuple(es)]}" for names, es in alike.items()]
        heads[0] = heads[0][0].upper() + heads[0][1:]
        text.append(f"## {'; '.join(heads)}\n\n{_KEY}\n\n{table}")
    return "\n".join(text)


def written(page: str, found: dict[tuple[str, str, str, str, str], Cell]) -> str:
    """The page with the tables of these cells."""
    before, rest = page.split(BEGINS)
    return before + BEGINS + tables(found) + "\n" + ENDS + rest.split(ENDS)[1]


def main() -> None:
    """Count the combinations, or write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="write the tables of the page")
    given, found = parser.parse_args(), cells()
    print(count(found))
    for key, cell in found.items():
        for fault in cell.faults:
            print(*key, fault, sep=" | ")
    if given.write:
        PAGE.write_text(written(PAGE.read_text("utf-8"), found), "utf-8")


if __name__ == "__main__":
    main()
