"""Motions with losses in Taylor series of long doubles: 16 to 17 digits, a hundred times as fast as with 40
digits.

    rows = losses_truth.exact(body, losses, start, times, contact="rolling", mu=0.0)

A module that other benches import. The equations are those of tests/reference/losses_forms.py, for the
angular momentum about the contact (for slip: about the centre), which share nothing with the library;
slip_tape.py computes the series. A row is its kind ("sample", "end", "stops", "slips", ...) and the numbers
t, theta, w1, w2, w3, u_h, u_2, work, heat, phi, psi, x, y. It needs gmpy2 and a C compiler.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests" / "reference"))
import losses as reference
from losses_forms import Momenta
from series import precise
from slip_tape import Few, LongTape

DIGITS = 28


class Quick(Few, Momenta):
    tape = LongTape


def exact(body, losses, start, times, *, contact="rolling", mu=0.0, beyond=False, most=4000):
    """The rows as pairs of a name and an array of doubles; `times` without 0."""
    precise(DIGITS)
    named = {name: value for name, value in zip(reference.LAWS, losses, strict=True) if value}
    scene = reference.Scene("", body, named, start, times[-1], contact=contact, mu=mu, beyond=beyond)
    scene.samples = [float(t) for t in times]
    equations = Quick(scene)
    equations.left = most
    found = reference.follow(equations).rows
    return [(kind, np.array([float(x) for x in row])) for kind, row in found]
