"""The rows of the references of motions that fly and lie, beside a motion of the library."""

import math

import numpy as np


def sampled(case):
    return [row for row in case.rows if row.kind in ("sample", "end")]


def whole(poses, rows):
    """The poses with the turns of the reference, which adds half a turn at each change of the rim, there and back."""
    turns = np.round([(float(row.phi) - phi) / math.tau for row, phi in zip(rows, poses[:, 0], strict=True)])
    return poses + math.tau * np.column_stack([turns, *3 * [0 * turns]])


def off(found, rows, names):
    """The errors, over the size of the number if that is above 1."""
    true = np.array([[float(getattr(row, name)) for name in names] for row in rows])
    return np.abs(np.asarray(found) - true) / np.maximum(1, np.abs(true))
