"""True over claimed error of a sweep of launches, against heyoka in 80-bit arithmetic.

Needs the dependency group `peers`; 10,000 launches take some minutes. They are those of peers/slip.py that
slip once and then roll. An error is the worst of t, theta, w1, w2, w3 and heat where slipping ends. A row is a
tolerance.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(1, str(pathlib.Path(__file__).parents[1] / "peers"))
from scene import launches
from slip import Spincyl, finish, first_states, reference

DEFAULTS, FEW, HONEST = {"count": 10_000, "seed": 0, "show": 3}, "--count 1000", 2.0
TOLERANCES = (1e-7, 1e-9, 1e-11, 1e-13)


def judge(given, tally):
    state, slip, mu = launches(given.count)
    first = first_states(state, slip)
    truth = finish(first, reference(first, mu), mu)
    for tol in TOLERANCES:
        ends, plain, claims = Spincyl(tol)(state, slip, mu)
        errors = np.abs(ends - truth).max(axis=1)
        for i in np.flatnonzero(plain):
            tally.add(f"{tol:.0e}", errors[i], claims[i], f"launch {i}")
