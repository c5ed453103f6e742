"""Writes lingering.csv: motions that linger at an unstable steady state, to 240 bits, for tests/laws/exact.rs.

    python tests/reference/lingering.py > tests/reference/lingering.csv        needs the dependency group `peers`

The starts are those that benches/kinds/saddles.py draws with seed 5, three of each kind. A row: kind; ell, i1, i3; theta, w1, w2,
w3 at time 0; t; theta, w1, w2, w3 at t; noise, the largest that half an ulp of each of the seven inputs, summed, moves any of
the four by. All numbers but the kind as C's %a.
"""

import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent.parent / "benches")]
import truth  # noqa: E402
from kinds import saddles  # noqa: E402


def main():
    rng = np.random.default_rng(5)
    print("kind,ell,i1,i3,theta,w1,w2,w3,t,theta_t,w1_t,w2_t,w3_t,noise")
    for i in range(15):
        kind = saddles.KINDS[i % len(saddles.KINDS)]
        start, last = saddles.draw(rng, kind)
        times = saddles.eighths(last)
        true = truth.path(start, times, bits=240, beyond=True)
        noisy = saddles.noise(start, times, truth.path(start, times, pose=True, beyond=True))
        for j in (0, 2, 4, 7):
            if j < len(true.rows):
                x = [*start[:7], times[j], *true.rows[j][:4], noisy[j, :4].max()]
                print(kind, *(float(v).hex() for v in x), sep=",")


if __name__ == "__main__":
    main()
