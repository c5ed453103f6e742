"""Time of a map of launches: 200 x 200 flicks of the paper's tube, until they first roll and to t = 200.

    python benches/launch_map.py [--side 200]        four minutes

Rates from 0.5 to 6, launch numbers from 1 to 3, mu = 0.3; each without restitution, where a motion ends as the body
leaves the table or lies down, and with two coefficients, through all impacts. Prints wall times, the least of two runs
(with restitution and on one thread, of one), on all processors and on one thread, impacts of each flick, the median of
the estimated errors, and the shares of the outcomes.
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
    names = " | ".join(x.name.lower().replace("_", " ") for x in sc.sweep.Outcome if x)
    print(f"| restitution | until | threads | s | impacts | estimated error | {names} |")
    print("| --- |" + " --- |" * (5 + len(sc.sweep.Outcome) - 1))
    for e in (None, 0.0, 0.5):
        more = {} if e is None else {"want": ("end", "impacts")}
        for until, how in (("rolling", {"stop_at": "rolling"}), ("t = 200", {})):
            for threads in (None, 1):
                least = np.inf
                for _ in range(1 if e is not None and threads else 2):
                    began = time.perf_counter()
                    law = {"contact": sc.Coulomb(0.3), "restitution": e, "threads": threads}
                    found = sc.sweep.flicks(TUBE, 200.0, **axes, **law, **how, **more)
                    least = min(least, time.perf_counter() - began)
                shares = [f"{(found.outcome.values == x).mean():.1%}" for x in sc.sweep.Outcome if x]
                hits = "" if e is None else f"{found.impacts.values.mean():.1f}"
                row = until, threads or "all", f"{least:.2f}", hits, f"{np.nanmedian(found.error.values):.0e}"
                print("|", " | ".join(map(str, ("none" if e is None else e, *row, *shares))), "|", flush=True)


if __name__ == "__main__":
    main()
