"""The rows of the references of motions that fly and lie, beside a motion of the library."""

import json
import math
import pathlib
import types

import numpy as np
from mpmath import mp, mpf

REFERENCE = pathlib.Path(__file__).with_name("reference")


def sampled(case):
    return [row for row in case.rows if row.kind in ("sample", "end")]


def named(cases, name):
    """The motion of this name, and the first of its rows of each kind."""
    (case,) = (case for case in cases if case.name == name)
    return case, {row.kind: row for row in reversed(case.rows)}


def stood(case):
    """Radius of the face on which a body stands, height of the centre over it, and the moments."""
    ell, i1, i3, rho = map(mpf, case.body)
    return 1 - rho, ell + rho, i1, i3


def whole(poses, rows):
    """The poses with the turns of the reference, which adds half a turn at each change of the rim, there and back. A face
    that topples is told from another point, in whichever direction."""
    true = np.array([[float(row.phi), float(row.psi)] for row in rows])
    turns = np.round((true - poses[:, :2]) / math.tau)
    return poses + math.tau * np.column_stack([turns, 0 * turns])


def off(found, rows, names):
    """The errors, over the size of the number if that is above 1."""
    true = np.array([[float(getattr(row, name)) for name in names] for row in rows])
    return np.abs(np.asarray(found) - true) / np.maximum(1, np.abs(true))


def table(file):
    """The motions of a table of tests/reference, with rows of exact numbers."""
    with (REFERENCE / file).open() as opened, mp.workdps(40):
        data = json.load(opened)
        cases = []
        for case in data["motions"]:
            rows = [dict(zip(data["columns"], row, strict=True)) for row in case["rows"]]
            rows = [{k: v if k == "kind" else mpf(v) for k, v in row.items()} for row in rows]
            named = {k: v for k, v in zip(data["laws"], case["losses"], strict=True) if v}
            rows = [types.SimpleNamespace(**row) for row in rows]
            cases.append(types.SimpleNamespace(**{**case, "rows": rows, "losses": named}))
        return cases
