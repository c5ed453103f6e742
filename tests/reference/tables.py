"""How references are made and written: twice, from two formulations, those that are asked for by name or all."""

import json
import sys
import time

import gmpy2
from gmpy2 import mpfr


def decimal(x, least=0.0):
    """A number as it stands in a table; what is less is 0."""
    return f"{0 if abs(x) < least else x:.24e}" if gmpy2.is_finite(x) else "inf"


def renew(path, cases, made, known, written):
    """Makes the cases whose names begin as asked, and writes the file after each, with what was known of the others."""
    cases, names = list(cases), sys.argv[1:]
    for case in cases:
        if not names or any(case.name.startswith(name) for name in names):
            known[case.name] = made(case)
            path.write_text(written([known[c.name] for c in cases if c.name in known]) + "\n")


def renew_json(path, cases, made, key, **head):
    """The same of a file with a head and a list under a key."""
    known = {one["name"]: one for one in json.loads(path.read_text())[key]} if path.exists() else {}

    def written(entries):
        rows = ",\n".join(json.dumps(one).replace(', ["', ',\n  ["') for one in entries)
        return f'{json.dumps(head)[:-1]}, "{key}": [\n{rows}\n]}}'

    renew(path, cases, made, known, written)


def followed(scene, formulations, follow):
    """The record of a scene by each formulation."""
    found = []
    for make in formulations:
        begun = time.time()
        found.append(follow(make(scene)))
        steps, spent = found[-1].steps, time.time() - begun
        print(f"{scene.name}: {make.__name__}, {steps} steps, {spent:.0f} s", flush=True)
    strayed = max(float(out.strayed) for out in found)
    print(f"    constraints and what is carried twice kept to {strayed:.1e}")
    return found


def moved(scene, formulations, follow, names, keys, laws):
    """An entry of a table: these attributes of a scene, its losses by `laws`, and its rows, from both formulations."""
    one, other = followed(scene, formulations, follow)
    agreement = max(compared(one, other, angles=(names.index("phi"), names.index("psi"))))
    rows = [
        [kind, *("nan" if gmpy2.is_nan(x) else decimal(x, 1e-27) for x in row)] for kind, row in other.rows
    ]
    entry = {key: getattr(scene, key) for key in keys.split()}
    entry["losses"] = [scene.losses.get(name, 0.0) for name in laws]
    return entry | {"agreement": float(f"{float(agreement):.1e}"), "rows": rows}


def compared(one, other, angles=()):
    """How far the rows of one record are from those of the other, over 1 or the number if that is more.

    The angles, in the columns so numbered, may differ by whole turns.
    """
    assert [kind for kind, _ in one.rows] == [kind for kind, _ in other.rows], (one.rows, other.rows)
    whole, apart = 2 * gmpy2.const_pi(), []
    for (_, a), (_, b) in zip(one.rows, other.rows, strict=True):
        worst = mpfr(0)
        for i, (x, y) in enumerate(zip(a, b, strict=True)):
            difference = abs(x - y)
            if i in angles:
                difference = abs(difference - whole * gmpy2.rint(difference / whole))
            if not gmpy2.is_nan(difference):
                worst = max(worst, difference / max(1, abs(y)))
        apart.append(worst)
    events = "; ".join(f"{kind} {float(v[0]):.4f}" for kind, v in other.rows if kind != "sample")
    print(f"    {events}\n    agreement {float(max(apart)):.1e}", flush=True)
    return apart
