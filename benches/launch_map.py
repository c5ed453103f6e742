"""Time of a map of launches: 200 x 200 flicks of the paper's tube, until they first roll and to t = 200.

    python benches/launch_map.py [--side 200]        a minute

Rates from 0.5 to 6, launch numbers from 1 to 3, mu = 0.3. Prints wall times, the least of two runs, on all
processors and on one thread, and the shares of the outcomes.
"""

import argparse
import time

import numpy as np

import spincyl as sc

TUBE = sc.Body.tube(6.0, bore=0.8)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--side", type=int, default=200)
    side = parser.parse_args().side
    axes = {"w1": np.linspace(0.5, 6, side), "launch": np.linspace(1, 3, side)}
    print("until | threads | s | settle | lie down | lift off")
    for until, how in (("rolling", {"stop_at": "rolling"}), ("t = 200", {})):
        for threads in (None, 1):
            least = np.inf
            for _ in range(2):
                began = time.perf_counter()
                found = sc.sweep.flicks(TUBE, 200.0, **axes, contact=sc.Coulomb(0.3), threads=threads, **how)
                least = min(least, time.perf_counter() - began)
            shares = [f"{(found.outcome.values == x).mean():.1%}" for x in sc.sweep.Outcome if x]
            print(until, threads or "all", f"{least:.2f}", *shares, sep=" | ", flush=True)


if __name__ == "__main__":
    main()
