"""Writes periods.csv: periods and precessions of nutations, to 113 bits, for tests/test_periods.py.

    python tests/reference/periods.py > tests/reference/periods.csv        needs the dependency group `peers`; a minute

The starts are those that benches/kinds/periods.py draws, ten of each kind, and a ball that spins all but upright. A row: kind;
contact; ell, i1, i3, fillet; theta, w1, w2, w3; the period and phi after it. All numbers are C's %a.
"""

import math
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).parent
sys.path[:0] = [str(HERE.parent.parent / "benches")]
from kinds import periods  # noqa: E402

BALL = (-0.1091342966683389, 0.7491982311998557, 0.45654036042742985, 1.0)
NODDING = (1.0939993594418556e-07, -1.9056977547865172e-07, 0.0, -1.948119043062726)


def main():
    rng = np.random.default_rng(7)
    print("kind,contact,ell,i1,i3,fillet,theta,w1,w2,w3,period,phi")
    left = dict.fromkeys(periods.KINDS, 10)
    given = iter([("upright", BALL, NODDING, "rolling")])
    while any(left.values()):
        kind, body, start, contact = next(given, None) or periods.draw(rng)
        if not left[kind]:
            continue
        true = periods.truth(body, start, contact)
        if true is None or not math.isfinite(float(true[0])):
            continue
        left[kind] -= 1
        print(kind, contact, *(float(x).hex() for x in (*body, *start, *true)), sep=",", flush=True)


if __name__ == "__main__":
    main()
